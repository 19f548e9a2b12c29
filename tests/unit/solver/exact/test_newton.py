"""Newton's method for a step: its solution, and its failures."""

from math import inf

import numpy as np
import pytest
from tests.entry import plain
from tests.systems import SLIDERS, problem_of
from tests.unit.solver.exact.test_collocation import begin, residuals

from stiction.solver.accuracy import Accuracy
from stiction.solver.exact import newton, oscillation, slip_frame
from stiction.solver.exact.collocation import SlipStep

SLIDES = [(1e-3, 1e-5, 3e-2, 1e-2), (-1e-3, 2e-5, 1e-2, 4e-2)]
ALL = pytest.mark.parametrize(("name", "drawn"), [(n, d) for n in SLIDERS for d in SLIDES])
SPEED = 1e-4  # m/s, below which corrections are absolute


def held_to(tolerance):
    """Return an accuracy of which only this counts."""
    return Accuracy(1e-6, tolerance, SPEED, 0.0, 0.0, inf, inf, 1.0, 1.0, 0.0, 0.0, 0.0)


def solve_step(name, drawn, tolerance, share=0.3, motion=1.0, guess=1.0):
    """Solve a step from a slip as at its start; return what `solve` does, and the step."""
    problem, frame, o, _, h = begin(name, drawn, "laid over the oscillation")
    h, p = share * h, (guess * frame.r,) * 3
    step = SlipStep(plain(oscillation.swing)(o, h, False), h, p, (0.0, 0.0, 0.0))
    found = plain(newton.solve)(problem, frame, o, step, False, held_to(tolerance), motion)
    return found, (problem, frame, o, h)


@ALL
def test_the_residuals_vanish(name, drawn):
    (converged, (_, h, p, w), count), step = solve_step(name, drawn, 1e-13)
    assert converged
    assert h == step[-1]
    assert 1 < count <= newton.ITERATIONS
    found, terms = (np.abs(residuals(*step, *map(np.array, x))) for x in ((p, w), (p, (0.3,) * 3)))
    assert found.max() < 1e-11 * terms.max()


@ALL
def test_it_stops_where_what_is_left_is_less_than_asked_for(name, drawn):
    """(M33): what is left is less than the tolerance, as far as the next correction tells.

    With a tolerance of ten times the first correction, one iteration is enough.
    """
    (_, (_, _, p, w), most), (_, frame, _, _) = solve_step(name, drawn, 1e-13)
    for tolerance in (1e-3, 1e-6, 1e-9):
        (converged, (_, _, rough, turn), count), _ = solve_step(name, drawn, tolerance)
        assert converged
        off = np.subtract(rough, p) / (SPEED + np.abs(p))
        assert max(np.abs(off).max(), np.abs(np.subtract(turn, w)).max()) < 10 * tolerance
        assert count <= most
    first = np.abs([*(np.array(p) / frame.r - 1.0), *w]).max()
    assert solve_step(name, drawn, 10 * first)[0][-1] == 1
    assert solve_step(name, drawn, 1e-3 * first)[0][-1] > 1
    # held to a motion that is slower than the slip, by as much more
    part = 1e-3 * (SPEED + frame.r)
    assert solve_step(name, drawn, 10 * first, motion=part)[0][-1] > 1


@pytest.mark.parametrize("stage", range(6))
def test_each_correction_is_held_against_the_slip_at_its_own_stage(stage, monkeypatch):
    """(M33): of p relative to |p| + sigma, of w to 1; its square is less than the tolerance."""
    problem, frame, o, _, h = begin("steady", SLIDES[0], "not")
    s = plain(oscillation.swing)(o, h, False)
    p, scale = (1e-2, 1e-3, 1e-1), np.array([1.01e-2, 1.1e-3, 1.001e-1, 1.0, 1.0, 1.0])[stage]
    for part, converged in ((0.999e-3, True), (1.001e-3, False)):
        corrections = iter([part * scale * np.eye(6)[stage], np.zeros(6)])

        def solve_blocks(*_, corrections=corrections):
            off = next(corrections)
            return tuple(off[:3]), tuple(off[3:])

        solve = plain(newton.solve)
        monkeypatch.setitem(solve.__globals__, "solve_blocks", solve_blocks)
        before = tuple(np.add(p, part * scale * np.eye(6)[stage][:3]))
        step = SlipStep(s, h, before, (0.0,) * 3)
        found = solve(problem, frame, o, step, False, held_to(1e-6), 1.0)
        assert (found[0], found[-1] == 1) == (True, converged)


@ALL
def test_it_converges_fast(name, drawn):
    """Quadratically at first, by a tenth at least then: 13 digits in less than ten iterations."""
    (converged, *_, count), _ = solve_step(name, drawn, 1e-13)
    assert converged
    assert count < 10


@pytest.mark.parametrize("name", ["steady", "ellipse", "program"])
def test_a_landing_is_a_step_of_unknown_size(name):
    """p = 0 at its end, where the residuals vanish, from a size that is off by a fifth."""
    problem, frame, o, _, _ = begin(name, (1e-3, 1e-5, 3e-4, 1e-4), "not")
    outset = plain(slip_frame.outset)(problem, frame)
    guess = frame.r / (outset.f - outset.a_1)
    assert guess > 0.0
    ends = []
    for part in (0.8, 1.0, 1.2):
        h = part * guess
        p = (0.8 * frame.r, 0.3 * frame.r, 0.0)
        step = SlipStep(plain(oscillation.swing)(o, h, True), h, p, (0.0, 0.0, 0.0))
        converged, (s, h, p, w), _ = plain(newton.solve)(
            problem, frame, o, step, True, held_to(1e-12), 1.0
        )
        assert converged
        assert p[2] == 0.0
        assert s == plain(oscillation.swing)(o, h, True)
        found = np.abs(residuals(problem, frame, o, h, np.array(p), np.array(w)))
        assert found.max() < 1e-10 * h * outset.f
        ends.append(h)
    assert ends == pytest.approx([ends[0]] * 3, rel=1e-9)


@pytest.mark.parametrize("part", [0.8, 1.2])
def test_the_size_of_a_landing_counts_by_itself(part):
    """Where errors of the slip velocity would not matter, its own correction goes on."""
    problem, frame, o, _, _ = begin("steady", (1e-3, 1e-5, 3e-4, 1e-4), "not")
    outset = plain(slip_frame.outset)(problem, frame)
    guess, sizes = frame.r / (outset.f - outset.a_1), []
    for accuracy in (held_to(1e-12), held_to(1e-5)._replace(speed=1e9)):
        h, p = part * guess, (0.8 * frame.r, 0.3 * frame.r, 0.0)
        step = SlipStep(plain(oscillation.swing)(o, h, True), h, p, (0.0,) * 3)
        converged, step, _ = plain(newton.solve)(problem, frame, o, step, True, accuracy, 1e12)
        assert converged
        sizes.append(step.h)
    assert sizes[1] == pytest.approx(sizes[0], rel=1e-4)


def test_it_gives_up():
    """Where corrections grow or are no numbers, or a landing would be before its start."""
    (converged, *_), _ = solve_step("steady", SLIDES[0], 1e-12, guess=np.nan)
    assert not converged
    (converged, *_, count), _ = solve_step(
        "steady", SLIDES[0], 0.0
    )  # no correction is small enough
    assert (converged, count <= newton.ITERATIONS) == (False, True)
    problem, frame, o, _, h = begin("steady", SLIDES[0], "not")
    rising = problem._replace(load=problem_of("steady").load._replace(force=1e-9))
    s, p = plain(oscillation.swing)(o, h, True), (frame.r, frame.r, 0.0)
    pulled = frame._replace(spring_1=1e3)  # it speeds up: there is no landing
    step = SlipStep(s, h, p, (0.0,) * 3)
    converged, step, _ = plain(newton.solve)(rising, pulled, o, step, True, held_to(1e-12), 1.0)
    assert not converged or step.h < 0.0
