"""One step of slip: as long as the tolerance allows, or to a landing."""

from math import inf

import numpy as np
import pytest
from tests.entry import plain
from tests.systems import SLIDERS, motion_of, problem_of
from tests.unit.solver.exact.test_collocation import begin, residuals
from tests.unit.solver.exact.test_newton import SLIDES
from tests.unit.solver.exact.test_predictor import COLD

from stiction.solver.accuracy import Accuracy
from stiction.solver.exact import error_estimate, newton, oscillation, predictor, slip_frame
from stiction.solver.exact.step import step
from stiction.solver.stepping.control import RESOLUTION, step_factor

ALL = pytest.mark.parametrize(("name", "drawn"), [(n, d) for n in SLIDERS for d in SLIDES])


def held_to(tolerance):
    """Return an accuracy with the speeds of these sliders."""
    speed, free = 1e-4, (0.1, 0.02)
    return Accuracy(
        tolerance, 1e-3 * tolerance, speed, *free, inf, 2e-3, 2.5e-4, 6e-6, 0.0, 0.0, 1e-12
    )


def take_step(name, drawn, accuracy, h=1e-3, t_stop=inf):
    """Take a step; return it, and what it starts from."""
    problem, frame, o, _, _ = begin(name, drawn, "not")
    start = plain(slip_frame.outset)(problem, frame)
    found = plain(step)(problem, frame, start, t_stop, COLD._replace(h=h), accuracy)
    return found, (problem, frame, o, start)


@ALL
@pytest.mark.parametrize("tolerance", [1e-3, 1e-8])
def test_an_accepted_step_keeps_its_tolerance(name, drawn, tolerance):
    """Its residuals vanish, and its error is the estimate's, over the tolerance."""
    accuracy = held_to(tolerance)
    found, (problem, frame, o, start) = take_step(name, drawn, accuracy)
    done, landing, taken, error, _, rejected, iterations = found
    s, h, p, w = taken
    assert (done, landing) == (True, False)
    assert iterations > rejected
    motion, _ = plain(error_estimate.moving)(problem, frame, start, accuracy)
    wanted = plain(error_estimate.local_error)(problem, frame, o, taken, accuracy, motion)
    assert error == pytest.approx(wanted / tolerance)
    assert 0.0 < error <= 1.0
    assert s == plain(oscillation.swing)(o, h, False)
    off = residuals(problem, frame, o, h, np.array(p), np.array(w))
    assert np.abs(off).max() < 0.1 * tolerance * frame.r  # Newton's error, times D
    if rejected:  # then the step could not be much longer
        assert error > 0.05
    else:
        assert h == 1e-3


@ALL
def test_a_step_that_is_refused_is_tried_again_shorter(name, drawn):
    """Until it is accepted; the size that was is accepted at once."""
    (_, _, (_, h, _, _), *_, rejected, _), _ = take_step(name, drawn, held_to(1e-9), h=3e-3)
    assert rejected > 0
    assert h < 3e-3
    (_, _, same, *_, again, _), _ = take_step(name, drawn, held_to(1e-9), h=h)
    assert (same.h, again) == (h, 0)


@ALL
def test_a_step_ends_at_the_end_of_the_segment_at_most(name, drawn):
    free, (_, frame, *_) = take_step(name, drawn, held_to(1e-3), h=1e-4)
    for stop, wanted in ((frame.t + 0.4e-4, 0.4e-4), (frame.t + 1.6e-4, free[2].h)):
        found, _ = take_step(name, drawn, held_to(1e-3), h=1e-4, t_stop=stop)
        assert found[0]
        assert found[2].h == pytest.approx(wanted, rel=1e-9)
    longest = held_to(1e-3)._replace(longest=3e-5)
    assert take_step(name, drawn, longest, h=1e-4)[0][2].h == 3e-5


@ALL
def test_a_step_to_the_next_float_can_be_refused_too(name, drawn, monkeypatch):
    """A shorter one rounds to the same time, and is nevertheless shorter."""
    _, (_, frame, *_) = take_step(name, drawn, held_to(1e-3))
    short = np.spacing(frame.t)
    errors = iter([1.5e-3, 0.0])
    monkeypatch.setitem(plain(step).__globals__, "local_error", lambda *_: next(errors))
    (done, _, (_, h, _, _), *_, rejected, _), _ = take_step(
        name, drawn, held_to(1e-3), t_stop=frame.t + short
    )
    assert (done, rejected) == (True, 1)
    assert h / short == pytest.approx(plain(step_factor)(1.5, 1.0))


def slowing(r, name="steady"):
    """Return a slip along y's normal that friction ends soon, and the time until then."""
    problem = problem_of(name)
    frame = plain(slip_frame.frame_of)(problem, motion_of(5e-4, 1e-5, 0.9 * r, 0.4 * r))
    start = plain(slip_frame.outset)(problem, frame)
    o = plain(oscillation.oscillator)(frame, start)
    return problem, frame, start, o, plain(predictor.time_to_landing)(frame, start, o, 1.0)


@pytest.mark.parametrize("name", SLIDERS)
def test_a_landing_is_the_end_of_a_step(name):
    """Tried where the size to try is more than 1.1 times what is left; p = 0 there."""
    problem, frame, start, _, until = slowing(1e-3, name)
    accuracy = held_to(3e-2)
    for part, lands in ((1.5, True), (1.15, True), (1.0, False), (0.3, False)):
        memory = COLD._replace(h=part * until)
        done, landing, (_, h, p, _), *_, rejected, _ = plain(step)(
            problem, frame, start, inf, memory, accuracy
        )
        assert (done, landing, rejected) == (True, lands, 0)
        if lands:
            assert p[2] == 0.0
            assert min(p[:2]) > 0.0
            assert h == pytest.approx(until, rel=0.2)
        else:  # in two even steps, or its way
            assert h == pytest.approx(0.55 * until if part == 1.0 else part * until)
            assert p[2] > 0.0
    # not beyond the end of the segment
    stop = frame.t + 0.9 * h
    memory = COLD._replace(h=1.5 * until)
    stop = frame.t + 0.8 * until
    done, landing, (_, h, _, _), *_ = plain(step)(problem, frame, start, stop, memory, accuracy)
    assert (done, landing) == (True, False)
    assert h == pytest.approx(0.8 * until, rel=1e-9)


@pytest.mark.parametrize("name", SLIDERS)
@pytest.mark.parametrize("part", [1.15, 1.3])
def test_a_landing_that_was_not_foreseen_is_found_from_the_step_beyond(name, part, monkeypatch):
    """Where p would be negative at the end: from the size at which a line through it is zero."""
    problem, frame, start, _, until = slowing(1e-3, name)
    memory, accuracy = COLD._replace(h=part * until), held_to(3e-2)
    found = plain(step)(problem, frame, start, inf, memory, accuracy)
    blind = plain(step)
    monkeypatch.setitem(blind.__globals__, "time_to_landing", lambda *_: inf)
    done, landing, (_, h, p, _), *_, rejected, iterations = blind(
        problem, frame, start, inf, memory, accuracy
    )
    assert (done, landing, rejected) == (True, True, 0)
    assert h == pytest.approx(found[2].h, rel=1e-3)
    assert p[2] == 0.0
    assert iterations <= found[-1] + newton.ITERATIONS  # of the step beyond
    # not beyond the end of the segment
    stop = frame.t + 0.9 * h
    done, landing, (_, h, _, _), *_ = blind(problem, frame, start, stop, memory, accuracy)
    assert (done, landing) == (True, False)
    assert h == pytest.approx(stop - frame.t, rel=1e-9)


def test_a_landing_beyond_the_end_of_the_segment_is_no_landing(monkeypatch):
    """Found from a guess before that end: then the step ends there, and slips on."""
    problem, frame, start, *_ = slowing(1e-3)
    memory, accuracy = COLD._replace(h=1e-2), held_to(3e-2)
    _, lands, (_, landing, _, _), *_ = plain(step)(problem, frame, start, inf, memory, accuracy)
    early = plain(step)
    monkeypatch.setitem(early.__globals__, "time_to_landing", lambda *_: 0.9 * landing)
    monkeypatch.setitem(early.__globals__, "swung_to_rest", lambda _, until: until)
    for part in (0.95, 1.05):
        stop = frame.t + part * landing
        done, landed, (_, h, p, _), *_ = early(problem, frame, start, stop, memory, accuracy)
        assert (lands, done, landed) == (True, True, part > 1.0)
        assert h == pytest.approx(min(part, 1.0) * landing, rel=1e-6)
        assert (p[2] == 0.0) == landed


def test_no_step_is_found_where_none_converges():
    """Each try is 0.3 times as long, until that is no time at all."""
    never = held_to(1e-3)._replace(newton=0.0)
    (done, landing, *_, error, _, rejected, iterations), _ = take_step("steady", SLIDES[0], never)
    assert (done, landing, error) == (False, False, inf)
    assert 1e-3 * 0.3**rejected <= RESOLUTION * 0.35 < 1e-3 * 0.3 ** (rejected - 1)
    assert iterations >= rejected
