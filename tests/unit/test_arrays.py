"""What is computed once of an array, and for how long it is kept."""

import gc
from weakref import ref

import numpy as np
import pytest

import stiction as st
from stiction.arrays import KEPT, Floats, compute_once


class Counted:
    """A sum that counts how often it is computed."""

    def __init__(self) -> None:
        self.calls = 0
        self.sum = compute_once(self._sum)

    def _sum(self, values: Floats, factor: float = 1.0) -> float:
        self.calls += 1
        return factor * float(values.sum())


def read_only(*values: float) -> Floats:
    array = np.array(values)
    array.setflags(write=False)
    return array


def test_of_an_array_that_cannot_change_it_is_computed_once_for_each_argument():
    counted, values = Counted(), read_only(1.0, 2.0)
    assert [counted.sum(values), counted.sum(values), counted.sum(values, 2.0)] == [3.0, 3.0, 6.0]
    assert counted.sum(values, factor=2.0) == counted.sum(values, factor=2.0) == 6.0
    assert counted.calls == 3  # by place and by name: two ways to write the same


@pytest.mark.parametrize("view", [False, True])
def test_of_an_array_that_can_change_it_is_computed_anew(view):
    counted, owner = Counted(), np.array([1.0, 2.0])
    values = owner[:] if view else owner
    values.setflags(write=not view)
    assert counted.sum(values) == 3.0
    owner[0] = 5.0
    assert counted.sum(values) == 7.0


def test_nothing_is_kept_of_an_array_that_is_gone():
    counted = Counted()
    for number in range(100):  # the next array may lie where the last one did
        assert counted.sum(read_only(float(number))) == number
    assert counted.calls == 100


def test_of_many_arrays_only_the_last_are_kept():
    counted, arrays = Counted(), [read_only(float(number)) for number in range(KEPT + 1)]
    for _ in range(2):
        assert [counted.sum(each) for each in arrays[1:]] == list(range(1, KEPT + 1))
    assert counted.calls == KEPT
    assert [counted.sum(each) for each in arrays[:2]] == [0.0, 1.0]
    assert counted.calls == KEPT + 2  # the first was never asked for; the second made room for it


def test_nothing_is_kept_of_a_record_that_was_analysed():
    """A result that refers to its array keeps it: 1.6 MB of each record of 40 000 samples."""
    time = np.arange(2000) * 1e-2
    force = 1.0 + time % 0.5 + 1e-3 * np.random.default_rng(1).normal(size=2000)
    found = st.analyse(st.Record(time=time, force=force))
    arrays = [ref(found.record.time), ref(found.record.force)]
    assert found.cycles.sizes["cycle"]
    del found
    gc.collect()
    assert [each() for each in arrays] == [None, None]
