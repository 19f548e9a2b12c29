"""What is computed once of an array, and for how long; results are compared by values."""

import copy
import gc
import pickle
from dataclasses import dataclass
from typing import Any, NamedTuple
from weakref import ref

import numpy as np
import pytest
import xarray as xr

import stiction as st
from stiction.arrays import KEPT, Floats, compute_once, median, same_values


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


class Pair(NamedTuple):
    name: str
    values: Any


@dataclass(frozen=True)
class Result:
    parts: Any


def results(x: float, n: float = np.nan) -> list[Any]:
    """Results of every shape, with a number somewhere in each."""
    column = np.array([n, x])
    return [
        column,
        [column, {"a": (column, n)}],
        Pair("a", Pair("b", column)),
        Result({"a": Pair("b", [n, x])}),
        xr.Dataset({"a": ("t", column)}),
        np.array([str(x), "b"]),
    ]


def test_results_are_equal_by_their_values():
    for one, same, other in zip(results(1.0), results(1.0), results(2.0), strict=True):
        assert same_values(one, same)
        assert not same_values(one, other)
    assert not same_values(Pair("a", 1.0), ("a", 1.0, 2.0))
    assert not same_values(Result(1.0), None)
    assert not same_values([1.0, 2.0], [1.0])
    assert not same_values({"a": np.ones(2)}, {"b": np.ones(2)})
    assert not same_values(np.ones(2), None)


def test_a_result_that_was_copied_is_equal(paper_run):
    """Audits were not, of a NaN; sounds, advice and odds raised an error."""
    for found in (st.audit(paper_run.slider), st.listen(paper_run)):
        again = pickle.loads(pickle.dumps(found))
        assert again == found
        assert (again != found) is False  # a tuple has its own
        assert copy.deepcopy(found) == found
    assert st.audit(paper_run.slider.replace(phi="2 deg")) != st.audit(paper_run.slider)
    assert st.listen(paper_run, axis="x") != st.listen(paper_run)


@pytest.mark.parametrize("count", [1, 2, 3, 4, 63, 64, 1001])
def test_the_median_is_that_of_numpy_to_the_last_bit(count):
    random = np.random.default_rng(count)
    for values in (random.standard_normal(count), random.integers(-9, 9, count)):
        before = values.copy()
        assert median(values) == np.median(values)
        assert values.tolist() == before.tolist()
    holed = random.standard_normal(count)
    holed[random.integers(count)] = np.nan
    assert np.isnan(median(holed))
