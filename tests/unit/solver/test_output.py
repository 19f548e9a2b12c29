"""Room for stick intervals."""

import numpy as np
import pytest

from stiction.errors import DescriptionError
from stiction.solver import output
from stiction.solver.output import STICK, Output


def made(sticks):
    return Output(np.empty(0), np.empty((0, 7)), np.arange(2.0 * sticks).reshape(sticks, 2))


def test_room_is_doubled_when_it_is_filled(monkeypatch):
    """After a look at the memory that so much room takes, for all tables."""
    asked = []
    monkeypatch.setattr(output, "shortage", asked.append)
    out = made(4)
    before = out.sticks.copy()
    out.make_room(3)
    assert out.sticks.tolist() == before.tolist()
    assert asked == []
    out.make_room(4)
    assert out.sticks.shape == (8, 2)
    assert out.sticks[:4].tolist() == before.tolist()
    assert asked == [STICK * 8]
    assert (out.filled, out.used) == (0, 0)


def test_sticks_that_do_not_fit_are_refused(monkeypatch):
    monkeypatch.setattr(output, "shortage", lambda _: "takes 9 GB, of which 1 GB is free")
    with pytest.raises(DescriptionError, match=r"more than 4 sticks.*takes 9 GB.*shorten it"):
        made(4).make_room(4)
