"""One step: the first guess from the last one, and the size that the error allows."""

from math import asinh, inf

import numpy as np
import pytest
from numpy.polynomial import Polynomial
from tests.drawn import inside
from tests.entry import plain
from tests.unit.solver.smooth.systems import EXACT, LAWS, C, Equations, at_stages, begun

from stiction.solver.smooth import error_estimate, newton, step
from stiction.solver.smooth.workspace import START, workspace
from stiction.solver.stepping.control import ATTEMPTS, RESOLUTION, step_factor

NODES = np.array([0.0, *C])
ROWS = [np.array(each) for each in inside(3, *[(-1.0, 1.0)] * 12)]


@pytest.mark.parametrize("warm", [True, False])
def test_a_first_guess_is_the_last_step_continued(warm):
    """Cubics exactly; at rest where the slip would turn back; else what held at the start."""
    w, x = plain(workspace)(1), 0.6
    along, state = Polynomial([1.0, 0.4, -0.2, 0.1]), Polynomial([3.0, -1.0, 0.5, 0.2])
    w.past[:] = np.transpose([along(NODES), -2.0 * along(NODES), state(NODES)])
    w.values[START] = 0.7, -1.4, 9.0
    q_x, q_y = plain(step.predict)(w, 0.7, -1.4, x, warm)
    if warm:
        there = 1.0 + x * C
        assert q_x == pytest.approx(along(there))
        assert q_y == pytest.approx(-2.0 * along(there))
        assert w.values[1:4, 2] == pytest.approx(state(there))
        back = plain(step.predict)(w, -0.7, 1.4, x, True)
        assert back == ((0.0,) * 3, (-0.0,) * 3)
    else:
        assert (q_x, q_y) == ((0.7,) * 3, (-1.4,) * 3)
        assert w.values[1:4, 2].tolist() == [9.0] * 3


@pytest.mark.parametrize("k", range(3))
@pytest.mark.parametrize("back", [True, False])
@pytest.mark.parametrize("axis", [0, 1])
def test_each_stage_is_at_rest_where_its_own_guess_turns_back(k, back, axis):
    """By the product with the slip at the start of both components, of which one is constant."""
    w, x, start = plain(workspace)(1), 0.6, [0.7, -1.4]
    zeros = Polynomial.fromroots([1.0 + x * c for i, c in enumerate(C) if i != k])
    there, steady = 1.0 + x * C[k], 1.0 / start[1 - axis]
    # at the stage k the product is -+0.1, at the others 1, as one component is zero there
    guess = zeros * ((-0.1 if back else 0.1) - 1.0) / start[axis] / zeros(there)
    w.past[:, axis], w.past[:, 1 - axis], w.past[:, 2] = guess(NODES), steady, 1.0
    w.values[START] = *start, 9.0
    found = plain(step.predict)(w, *start, x, True)
    wanted = [steady] * 3
    wanted[k] = 0.0 if back else steady
    assert found[1 - axis] == pytest.approx(wanted)
    assert found[axis][k] == pytest.approx(0.0 if back else guess(there))


def test_a_smoothed_law_holds_a_slip_of_less_than_twice_its_speed():
    """Of its magnitude; a law with states never does."""
    for states in (0, 1):
        w = plain(workspace)(states)
        w.size[:2] = 1e-6
        for slip, held in (((1.5, 1.3), True), ((1.5, 1.4), False), ((0.0, -1.9), True)):
            q_x, q_y = 1e-6 * np.array(slip)
            assert plain(step.resting)(w, q_x, q_y) == (held and states == 0)


def test_the_last_step_is_remembered_in_the_slip_coordinate():
    w, eps = plain(workspace)(1), 1e-9
    past = np.array([[3e-6, 4e-6, 1.0], [0.0, 0.0, 2.0], [1e-3, 0.0, 3.0], [0.0, -1e-3, 4.0]])
    plain(step.remember)(w, past, eps)
    assert w.past[:, 2].tolist() == [1.0, 2.0, 3.0, 4.0]
    assert w.past[0, :2] == pytest.approx([0.6 * asinh(5e-6 / eps), 0.8 * asinh(5e-6 / eps)])
    assert w.past[1, :2].tolist() == [0.0, 0.0]
    assert w.past[2:, :2] == pytest.approx(asinh(1e-3 / eps) * np.array([[1, 0], [0, -1]]))


def accuracy(tolerance):
    return EXACT._replace(tolerance=tolerance, newton=1e-3 * tolerance)


def take_step(name, h, tolerance, t_stop=inf, drive="program"):
    """Take a step from the start, without a step before it."""
    problem, start, w, q = begun(name, drive, accuracy(tolerance))
    found = plain(step.step)(problem, start, *q, t_stop, h, 1.0, False, w, accuracy(tolerance))
    return problem, start, w, found


@pytest.mark.parametrize("name", LAWS)
@pytest.mark.parametrize("tolerance", [1e-2, 1e-6])
@pytest.mark.parametrize("h", [1e-6, 1e-2])
def test_an_accepted_step_keeps_its_tolerance(name, tolerance, h):
    """Its stages solve the equations, and its error is the estimate's, over the tolerance."""
    problem, start, w, (done, size, error, rejected, iterations) = take_step(name, h, tolerance)
    assert done
    assert 0.0 <= error <= 1.0
    assert iterations > rejected
    motion, states = Equations(name).residuals(size, *at_stages(w))
    speed = EXACT.speed + np.abs(w.values[:4, :2]).max()
    assert np.abs(motion).max() < 0.1 * tolerance * speed * max(1.0, size / 1e-3)
    assert np.abs(states / w.size[2:]).max(initial=0.0) < tolerance
    held = accuracy(tolerance)
    again = plain(error_estimate.local_error)(problem, start, size, w, held) / tolerance
    assert error == pytest.approx(again)
    if h == 1e-6:
        assert (size, rejected) == (h, 0)
    else:
        assert rejected > 0
        assert size < h
        # this size itself is accepted at once
        *_, (done, same, error, none, _) = take_step(name, size, tolerance)
        assert (done, same, none) == (True, size, 0)
        assert error <= 1.0


def test_a_refused_step_is_tried_again_as_its_error_says():
    """By (M43), never longer."""
    tolerance, name = 1e-6, "smoothed"
    *_, (done, h, _, rejected, _) = take_step(name, 4e-4, tolerance)
    assert done
    assert rejected >= 1
    problem, start, w, q = begun(name)
    for i in range(1, 4):
        w.values[i] = w.values[START]
    at = tuple((each,) * 3 for each in q)
    assert plain(newton.solve)(problem, start, 4e-4, *at, w, accuracy(tolerance))[0]
    held = accuracy(tolerance)
    error = plain(error_estimate.local_error)(problem, start, 4e-4, w, held) / tolerance
    factor = plain(step_factor)(error, 1.0)
    *_, (_, first, _, more, _) = take_step(name, 4e-4 * factor, tolerance)
    assert more == rejected - 1
    assert first == pytest.approx(h, rel=1e-3)


@pytest.mark.parametrize(("error", "refused"), [(1.0, False), (1.0001, True)])
def test_an_error_as_large_as_the_tolerance_is_accepted(error, refused, monkeypatch):
    errors = iter([error * 2.0**-20, 0.0])
    found = plain(step.step)
    monkeypatch.setitem(found.__globals__, "local_error", lambda *_: next(errors))
    *_, (done, h, last, rejected, _) = take_step("smoothed", 1e-6, 2.0**-20)
    assert (done, rejected) == (True, int(refused))
    if refused:
        assert h == 1e-6 * plain(step_factor)(error, 1.0)
    else:
        assert (h, last) == (1e-6, 1.0)


def test_a_step_to_the_next_float_can_be_refused_too(monkeypatch):
    """A shorter one rounds to the same time, and is nevertheless shorter."""
    _, start, _, _ = take_step("smoothed", 1e-6, 2.0**-20)
    short, errors = np.spacing(start.t), iter([1.5 * 2.0**-20, 0.0])
    monkeypatch.setitem(plain(step.step).__globals__, "local_error", lambda *_: next(errors))
    *_, (done, h, _, rejected, _) = take_step("smoothed", 1e-6, 2.0**-20, start.t + short)
    assert (done, rejected) == (True, 1)
    assert h / short == pytest.approx(plain(step_factor)(1.5, 1.0))


@pytest.mark.parametrize("name", ["smoothed", "ageing"])
def test_a_step_ends_at_the_end_of_the_segment_at_most(name):
    _, start, _, _ = take_step(name, 1e-6, 1e-3)
    for part, wanted in ((0.4, 0.4e-6), (1.0, 1e-6), (1.6, 1e-6)):
        *_, (done, h, _, _, _) = take_step(name, 1e-6, 1e-3, start.t + part * 1e-6)
        assert done
        assert h == pytest.approx(wanted, rel=1e-9)


def test_no_step_is_found_where_none_converges():
    """Each try is 0.3 times as long, until that is no time at all."""
    problem, start, w, q = begun("smoothed")
    never = EXACT._replace(tolerance=-1.0, newton=-1.0)
    assert 0.3**ATTEMPTS < RESOLUTION
    w.values[START, 0] = np.nan
    done, h, error, rejected, iterations = plain(step.step)(
        problem, start, *q, inf, 1e-3, 1.0, False, w, never
    )
    assert (done, error) == (False, 0.0)
    assert 1e-3 * 0.3**rejected == pytest.approx(h)
    assert h <= RESOLUTION * start.t < h / 0.3
    assert iterations == rejected  # each fails at once


def test_a_step_goes_on_from_the_last_one():
    """A guess from the last step takes fewer iterations than none."""
    h, counts = 1e-4, []
    for warm in (False, True):
        problem, start, w, q = begun("smoothed", "steady", accuracy(1e-6))
        stopped = plain(step.step)(problem, start, *q, inf, h, h, False, w, accuracy(1e-6))
        assert stopped[1] == h
        past = w.values[:4].copy()
        motion = *Equations("smoothed").u, *past[3, :2]
        problem, start, w, q = begun("smoothed", "steady", accuracy(1e-6), motion)
        plain(step.remember)(w, past, start.eps)
        *_, iterations = plain(step.step)(problem, start, *q, inf, h, h, warm, w, accuracy(1e-6))
        counts.append(iterations)
    assert counts[1] < counts[0]


def straight(*polynomials, states=1):
    """Return a workspace with a step's slip along x and y as polynomials."""
    w = plain(workspace)(states)
    w.values[:4, 0], w.values[:4, 1] = (each(NODES) for each in polynomials)
    return w


@pytest.mark.parametrize("there", [0.02, 0.4, 0.99])
@pytest.mark.parametrize("angle", [0.0, 2.0])
def test_a_step_ends_where_slip_turns_back(there, angle):
    """At the zero of the cubic, whatever its direction in the plane."""
    along = Polynomial([1.0, 0.3, -0.1, 0.2]) * 1e-3
    along = along - along(there) if there > 0.0 else along
    w = straight(-np.cos(angle) * along, -np.sin(angle) * along)
    assert plain(step.turn_back)(w, EXACT) == pytest.approx(there, abs=1e-12)
    assert plain(step.turn_back)(straight(-along, 0.0 * along, states=0), EXACT) == 1.0


def test_a_step_over_which_slip_turns_round_or_begins_at_rest_is_whole():
    """The kink is at rest: slip that turns at speed does not meet it, nor one that leaves rest."""
    along, aside = Polynomial([1e-3, -2e-3]), Polynomial([0.0, 2e-3, -2e-3])
    assert plain(step.turn_back)(straight(along, aside), EXACT) == 1.0
    assert plain(step.turn_back)(straight(along, 0.1 * aside), EXACT) == pytest.approx(0.5)
    rest = EXACT.tolerance * (1e-3 + EXACT.speed)
    for slow, whole in ((0.9 * rest, True), (1.2 * rest, False)):
        leaving, coming = Polynomial([slow, -1e-3 - slow]), Polynomial([1e-3, -1e-3 - slow])
        there = slow / (1e-3 + slow)
        found = plain(step.turn_back)(straight(leaving, 0.0 * leaving), EXACT)
        assert found == pytest.approx(1.0 if whole else there, abs=1e-12)
        found = plain(step.turn_back)(straight(coming, 0.0 * coming), EXACT)
        assert found == pytest.approx(1.0 if whole else 1.0 - there, abs=1e-12)


def test_an_error_that_does_not_fall_shortens_the_step_at_once(monkeypatch):
    """A layer far shorter than the step: 30 tries reach 0.2^29 of its size, not 0.9^29."""
    sizes = []

    def local_error(problem, start, h, w, accuracy):
        sizes.append(h)
        return 1.01 * accuracy.tolerance if h > 1e-25 else 0.0

    found = plain(step.step)
    monkeypatch.setitem(found.__globals__, "local_error", local_error)
    problem, start, w, q = begun("ageing")
    done, h, _, rejected, _ = found(problem, start, *q, 1.0, 1e-5, 1e-5, False, w, EXACT)
    assert done
    assert rejected < 40
    assert h == sizes[-1] < 1e-25
    # the first is shortened as its error says
    assert sizes[1] == pytest.approx(0.9 * 1.01**-0.25 * 1e-5)
    assert sizes[3] == pytest.approx(0.2 * sizes[2])
