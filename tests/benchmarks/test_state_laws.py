"""The cases of laws with state: their equations, and runs in pieces. Nothing is timed."""

import numpy as np
import pytest
from benchmarks.state_laws.cases import CASES, in_pieces
from benchmarks.state_laws.equations import MODELS

ONE_OF_EACH = {case.model: case for case in CASES}
STEP = 1e-6  # relative: the error of a central difference is of its square


@pytest.mark.parametrize("model", MODELS)
def test_jacobians_are_those_of_the_equations(model):
    case = ONE_OF_EACH[model]
    derivative, jacobian = (each.py_func for each in MODELS[model])
    p = case.parameters(case.pieces[0][1])
    y = case.start() + 0.3 * np.array([1.0, 0.7, -0.4, 0.2])[: len(case.start())]
    if model == "smoothed":
        y = np.array([1e-3, 1e-7, 1.3 * p[2], 0.7 * p[2]])
    found, out = np.empty((len(y), len(y))), np.empty((2, len(y)))
    jacobian(0.0, y, p, found)
    for k in range(len(y)):
        change = np.zeros(len(y))
        change[k] = STEP * abs(y[k])
        derivative(0.0, y + change, p, out[0])
        derivative(0.0, y - change, p, out[1])
        slope = (out[0] - out[1]) / (2.0 * change[k])
        # rounding of the rates, over the change, beside the error of the difference
        rounding = 1e-15 * np.abs(out[0]) / change[k]
        near = 1e-9 * np.abs(found[:, k]).max() + 10.0 * rounding
        assert np.all(np.abs(found[:, k] - slope) < near)


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_a_run_in_pieces_has_all_samples(case):
    """Unknowns that only count the pieces: each sample is that of the piece in which it lies."""

    def advance(y, t, p):
        return np.stack([y, *[y + 1.0] * (len(t) - 1)])

    times = case.times
    found = in_pieces(case, times, advance)
    assert found.shape == (len(times), 2)
    assert len(in_pieces(case, times[[0, -1]], advance)) == 2
    ends = np.cumsum([duration for duration, _ in case.pieces])[:-1]
    which = np.searchsorted(ends + 1e-9, times[1:], side="left")
    assert np.array_equal(np.diff(np.unique(found[1:, 0])) > 0.0, [True] * len(ends))
    assert np.array_equal(np.unique(found[1:, 0], return_inverse=True)[1], which)
