"""Examples in docstrings draw without a screen, and what they write goes to a folder of its own."""

import gc
import os
import sys
from pathlib import Path

import pytest
from _pytest.doctest import DoctestItem

# before NumPy is imported: its threads wait busily for each other, and each worker of the tests has
# a core already
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

# a hundred processes import the same thousands of files: where they may not leave bytecode beside
# them, they share it here instead of compiling everything anew
if sys.dont_write_bytecode:
    sys.dont_write_bytecode = False
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
    sys.pycache_prefix = str(Path(__file__).parent / ".pytest_cache" / "bytecode")
    os.environ["PYTHONPYCACHEPREFIX"] = sys.pycache_prefix


@pytest.hookimpl(wrapper=True)
def pytest_collection():
    """Search for no garbage here, where a third of the time would go to it, and seldom later.

    Each figure is thousands of objects that refer to each other: of the tests that draw, an eighth
    of the time would go to looking through them again and again.
    """
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()  # all is old now: else all would be looked through at once
        gc.unfreeze()
        gc.set_threshold(50_000, 20, 20)
        gc.enable()


@pytest.fixture(autouse=True)
def _alone(request):
    if isinstance(request.node, DoctestItem):
        monkeypatch = request.getfixturevalue("monkeypatch")
        monkeypatch.setenv("MPLBACKEND", "Agg")
        monkeypatch.chdir(request.getfixturevalue("tmp_path_factory").mktemp("example"))
