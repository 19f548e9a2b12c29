"""Examples in docstrings draw without a screen, and what they write goes to a folder of its own."""

import pytest
from _pytest.doctest import DoctestItem


@pytest.fixture(autouse=True)
def _alone(request, monkeypatch, tmp_path_factory):
    if isinstance(request.node, DoctestItem):
        monkeypatch.setenv("MPLBACKEND", "Agg")
        monkeypatch.chdir(tmp_path_factory.mktemp("example"))
