"""Calls of compiled functions."""

import numpy as np

from stiction.solver.compilation import jit


def double(x):
    """Return a number that is compiled quickly."""
    return 2.0 * x


def test_a_function_called_directly_is_compiled_once_for_each_kind(monkeypatch):
    """Then numba, which would look at the types of all arguments, is asked no more."""
    monkeypatch.setattr(jit, "_entries", {})
    twice = jit.compiled_for(double, None)
    for kind, value in ((float, 1.5), (int, 3)):
        assert jit.call_directly(twice, (kind,), value) == 2 * value
    entries = dict(jit._entries)
    assert len(entries) == len({id(each) for each in entries.values()}) == 2
    monkeypatch.setattr(jit, "call_compiled", None)
    assert [jit.call_directly(twice, (float,), x) for x in (0.25, -2.0)] == [0.5, -4.0]
    assert jit.call_directly(twice, (int,), np.int64(4)) == 8
    assert jit._entries == entries
