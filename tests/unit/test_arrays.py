"""What is computed once of an array, and for how long it is kept."""

import numpy as np
import pytest

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
