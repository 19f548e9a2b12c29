"""A force that is cut off at an end of its range, and what only looks like it."""

import numpy as np
import pytest

from stiction.analysis.signals.clipping import flat_ends

COUNT = np.arange(5000)
SAW = np.tile(np.linspace(0.0, 1.0, 40, endpoint=False), 20)


@pytest.mark.parametrize(
    "force",
    [
        np.rint(20.0 * np.sin(0.05 * COUNT)),  # steps of a converter
        np.tile([0.0, 1.0, 2.0, 3.0, 4.0, 5.0], 12),  # tops of one sample each
        np.zeros(100),
        np.array([]),
    ],
    ids=["a sine in steps", "pointed tops", "a level", "nothing"],
)
def test_what_is_not_cut_off(force):
    assert flat_ends(force) == []


@pytest.mark.parametrize("end", [0.8, 0.7, 0.4])
def test_peaks_that_are_cut_off(end):
    ((name, value, longest, _),) = flat_ends(np.minimum(SAW, end))
    assert (name, value) == ("largest", end)
    assert longest == np.count_nonzero(SAW[:40] >= end - 1e-12)
    ((name, value, _, _),) = flat_ends(-np.minimum(SAW, end))  # largest in magnitude
    assert (name, value) == ("largest", -end)
