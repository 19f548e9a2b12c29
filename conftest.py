"""Examples in docstrings draw without a screen, and what they write goes to a folder of its own."""

import os

import pytest
from _pytest.doctest import DoctestItem

# before NumPy is imported: its threads wait busily for each other, and each worker of the tests has
# a core already
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")


@pytest.fixture(autouse=True)
def _alone(request, monkeypatch, tmp_path_factory):
    if isinstance(request.node, DoctestItem):
        monkeypatch.setenv("MPLBACKEND", "Agg")
        monkeypatch.chdir(tmp_path_factory.mktemp("example"))
