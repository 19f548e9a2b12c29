"""The equations of one axis, corrections of the slip coordinate, and first guesses."""

from math import hypot, inf

import numpy as np
import pytest
from tests.drawn import inside
from tests.entry import plain
from tests.systems import problem_of
from tests.unit.solver.smooth.systems import (
    EXACT,
    LAWS,
    MOTION,
    Equations,
    at_stages,
    begun,
    derivative,
)

from stiction.solver.smooth import elimination, newton, right_hand_side
from stiction.solver.smooth.coordinate import coordinate, damped_rise, slip_at
from stiction.solver.smooth.newton import SMOOTH_ITERATIONS
from stiction.solver.smooth.right_hand_side import SmoothOutset
from stiction.solver.smooth.workspace import START
from stiction.solver.stepping.block_algebra import solve_blocks
from stiction.solver.stepping.radau import A, C, D

A, C, D = np.array(A), np.array(C), np.array(D)
NODES = np.array([0.0, *C])
ROWS = [np.array(each) for each in inside(3, *[(-1.0, 1.0)] * 12)]


@pytest.mark.parametrize("row", ROWS)
def test_the_residuals_along_an_axis(row):
    """(M66): without slip a acts; springs and damper take from it what has slipped."""
    h, k, c, start = 0.3, 7.0, 1.3, row[0]
    s, a, f = row[1:4], row[4:7], row[7:10]
    part = plain(newton.linear)(h, k, c, start, tuple(a))
    wanted = D @ (s - start) - h * (a - k * h * (A @ s) - c * s - f)
    found = plain(newton.residual)(part, h, tuple(s), start, tuple(f))
    assert found == pytest.approx(wanted, abs=1e-13)
    by, slope = row[1:4], row[7:10]
    block = np.array(plain(newton.block)(part.by_slip, tuple(by), h, tuple(slope)))
    wanted = (D + h * h * k * A + h * c * np.eye(3)) @ np.diag(by) + h * np.diag(slope)
    assert block == pytest.approx(wanted, abs=1e-13)


def test_corrections_of_the_slip_velocity():
    """Without a logarithm: as they are, relative to the slip speed and what is resolved."""
    start = SmoothOutset(0.0, 0.0, 0.0, inf, 1e-6, 1.0)
    found = plain(newton.correct)(start, 0.5, 1e-3, 3e-3, 4e-3, 3e-4, -4e-4)
    assert (found.q_x, found.q_y) == pytest.approx((2.7e-3, 4.4e-3))
    assert found.size == pytest.approx(5e-4 / (1e-3 + 5e-3))
    assert found.turn == pytest.approx(5e-4 / (1e-6 + 5e-3))


@pytest.mark.parametrize("share", [0.3, 1.0])
def test_corrections_of_its_logarithm(share):
    """A rise of more than 0.1 is damped by (M69), and the direction stays."""
    start = SmoothOutset(0.0, 0.0, 0.0, 1e-9, 0.2, 1.0)
    for d, damped in (((-3.0, -4.0), True), ((0.3, 0.4), False), ((-0.03, -0.04), False)):
        found = plain(newton.correct)(start, share, 1e-3, 3.0, 4.0, *d)
        plainly = 3.0 - d[0], 4.0 - d[1]
        size = hypot(*d) / 1.0
        assert found.size == found.turn == pytest.approx(size)
        if damped:
            to = plain(damped_rise)(5.0, hypot(*plainly) - 5.0, share)
            assert hypot(found.q_x, found.q_y) == pytest.approx(to)
            assert found.q_x / found.q_y == pytest.approx(plainly[0] / plainly[1])
            assert to < hypot(*plainly)
        else:
            assert (found.q_x, found.q_y) == pytest.approx(plainly)
    near = plain(newton.correct)(start, share, 1e-3, 0.03, 0.04, 0.01, 0.0)
    assert near.size == pytest.approx(0.01 / (0.2 + 0.05))


def test_what_is_no_number_is_larger():
    larger = plain(newton.larger)
    assert (larger(1.0, 2.0), larger(2.0, 1.0), larger(1.0, 1.0)) == (2.0, 2.0, 1.0)
    assert np.isnan(larger(np.nan, 1.0))


@pytest.mark.parametrize("q", [(0.3, -0.4), (2.0, 1.0)])
def test_the_share_of_inertia(q):
    """(M69): along q, of the diagonal of the equations; all of it where friction weakens."""
    problem, h, a = problem_of("steady"), 0.01, 3.2
    s, f = np.array([[2.0, 0.3], [0.3, 1.5]]), np.array([[40.0, 5.0], [9.0, 70.0]])
    e = np.array(q) / hypot(*q)
    damping = e @ np.diag([3.0, 20.0]) @ e / 0.25
    inertia = a * (e @ s @ e) * (1 + h * damping)
    triples = [(m[0, 0], 0.5 * (m[0, 1] + m[1, 0]), m[1, 1]) for m in (s, f)]
    share = plain(right_hand_side.inertia_share)
    found = share(problem, h, a, q, *triples)
    assert found == pytest.approx(inertia / (inertia + h * (e @ f @ e)))
    weakening = tuple(-each for each in triples[1])
    assert share(problem, h, a, q, triples[0], weakening) == 1.0
    assert share(problem, h, a, (0.0, 0.0), *triples) == 1.0


def test_each_stage_has_its_own_share_of_inertia():
    """The factor of a stage is its entry in the diagonal of D."""
    problem, h = problem_of("steady"), 0.01
    columns = np.array([each[:11] for each in inside(3, *[(0.5, 2.0)] * 11)]).T
    at = right_hand_side.Stages(*map(tuple, columns))
    q_x, q_y = (0.3, -1.0, 2.0), (0.7, 0.5, -0.2)
    found = plain(newton.shares)(problem, h, q_x, q_y, at)
    for i in range(3):
        s = at.s_xx[i], at.s_xy[i], at.s_yy[i]
        f = at.f_xx[i], 0.5 * (at.f_xy[i] + at.f_yx[i]), at.f_yy[i]
        wanted = plain(right_hand_side.inertia_share)(problem, h, D[i, i], (q_x[i], q_y[i]), s, f)
        assert found[i] == pytest.approx(wanted)
    assert len(set(found)) == 3


def test_each_correction_is_damped_by_its_own_share(monkeypatch):
    """(M69), as far as a stage's own correction rises."""
    problem, start, w, _ = begun("ageing")
    q, rise, share = np.array([3.0, 4.0, 5.0]), np.array([2.0, 1.0, 3.0]), (0.2, 0.5, 0.9)
    solve = plain(newton.solve)
    for name, found in (
        ("solve_blocks", (tuple(-rise), (0.0,) * 3)),
        ("shares", share),
        ("residuals_without", ((0.0,) * 3, (0.0,) * 3)),
        ("correct_states", 0.0),
        ("settled", True),
    ):
        monkeypatch.setitem(solve.__globals__, name, lambda *_, found=found: found)
    assert solve(problem, start, 1e-6, tuple(q), (0.0,) * 3, w, EXACT) == (True, 1)
    wanted = [plain(damped_rise)(*each) for each in zip(q, rise, share, strict=True)]
    slips = [plain(slip_at)(start.eps, to, 0.0)[0] for to in wanted]
    assert w.values[1:4, 0] == pytest.approx(slips)


GUESSES = [1.0, 0.9]  # of the slip velocity at the start


def stages_of(name, h, drive="program"):
    """Return a step's start, and values near its start in the rows of the stages."""
    problem, start, w, q = begun(name, drive)
    n = len(w.size)
    for i, part in enumerate((1.01, 0.98, 0.95)):
        w.values[i + 1, 2:n] = part * w.values[START, 2:n]
    q_x, q_y = (tuple(part * each for part in (0.99, 0.97, 1.02)) for each in q)
    pulls = tuple(plain(right_hand_side.pull)(problem, start, c * h) for c in C)
    return problem, start, w, pulls, q_x, q_y


@pytest.mark.parametrize("name", LAWS)
@pytest.mark.parametrize("h", [1e-5, 3e-3])
def test_a_correction_is_that_of_the_whole_of_the_equations(name, h):
    """(M66) to (M68): the Jacobian as differences of the printed residuals, by q and z."""
    problem, start, w, pulls, q_x, q_y = stages_of(name, h)
    printed, system, n = Equations(name), problem.system, len(w.size) - 2
    per, s = system.per_mass, w.values[START, :2].copy()
    x, y = (
        plain(newton.linear)(h, k * per, c * per, at, tuple(pull[i] for pull in pulls))
        for i, (k, c, at) in enumerate(
            [(system.k_x, system.c_x, s[0]), (system.k_y, system.c_y, s[1])]
        )
    )
    at = plain(newton.stages_at)(problem, start.eps, pulls, q_x, q_y, w, True)
    m = plain(newton.factors)(h, x, y, at, w)
    r_x = plain(newton.residual)(x, h, at.s_x, s[0], at.f_x)
    r_y = plain(newton.residual)(y, h, at.s_y, s[1], at.f_y)
    if n:
        r_x, r_y = plain(elimination.residuals_without)(h, r_x, r_y, w)
    d_x, d_y = plain(solve_blocks)(m, r_x, r_y)
    before = w.values[1:4, 2:].copy()
    if n:
        plain(elimination.correct_states)(d_x, d_y, w)
    d_z = before - w.values[1:4, 2:]

    def residuals(unknowns):
        rows = unknowns.reshape(3, 2 + n)
        slips = np.array([plain(slip_at)(start.eps, *row[:2]) for row in rows])
        motion, states = printed.residuals(h, slips, rows[:, 2:])
        return np.hstack([motion, states]).ravel()

    unknowns = np.column_stack([q_x, q_y, before]).ravel()
    sizes = 1e-5 * np.tile([*np.abs(unknowns[:2]), *(w.size[2:])], 3)
    jacobian = derivative(residuals, unknowns, sizes)
    wanted = np.linalg.solve(jacobian, residuals(unknowns)).reshape(3, 2 + n)
    found = np.column_stack([d_x, d_y, d_z])
    scale = np.abs(wanted).max(axis=0)
    assert found / scale == pytest.approx(wanted / scale, abs=2e-5)


@pytest.mark.parametrize("name", LAWS)
@pytest.mark.parametrize("drive", ["steady", "program", "spring"])
@pytest.mark.parametrize("h", [3e-5, 1e-3])
@pytest.mark.parametrize("part", GUESSES)
def test_stages_solve_the_equations(name, drive, h, part):
    """(M66) and (M67), from guesses of the slip velocity, in a few iterations."""
    problem, start, w, (q_x, q_y) = begun(name, drive)
    w.values[1:4] = w.values[START]
    guess = (part * q_x,) * 3, (part * q_y,) * 3
    found, iterations = plain(newton.solve)(problem, start, h, *guess, w, EXACT)
    assert found
    assert iterations <= 9
    motion, states = Equations(name, drive).residuals(h, *at_stages(w))
    assert np.abs(motion).max() < 1e-9 * hypot(*MOTION[2:])
    assert (np.abs(states) < 1e-9 * w.size[2:]).all()


@pytest.mark.parametrize("name", ["smoothed", "lugre", "ageing"])
def test_it_ends_when_corrections_are_negligible(name):
    """By no more than the tolerance asks for; from the solution itself at once."""
    h, counts = 1e-3, []
    for newton_size in (1e-3, 1e-6, 1e-12):
        accuracy = EXACT._replace(newton=newton_size, tolerance=1e300)
        problem, start, w, (q_x, q_y) = begun(name, accuracy=accuracy)
        w.values[1:4] = w.values[START]
        guess = (q_x,) * 3, (q_y,) * 3
        found, iterations = plain(newton.solve)(problem, start, h, *guess, w, accuracy)
        assert found
        counts.append(iterations)
        s, _ = at_stages(w)
        motion, _ = Equations(name).residuals(h, *at_stages(w))
        assert np.abs(motion).max() < 10 * newton_size * (EXACT.speed + np.abs(s).max())
        # again, from there
        q = np.array([plain(coordinate)(start.eps, *row) for row in s]).T
        again = plain(newton.solve)(problem, start, h, tuple(q[0]), tuple(q[1]), w, accuracy)
        assert again == (True, 1)
    assert counts == sorted(counts)
    assert counts[0] < counts[-1]
    # the tolerance asks for a hundredth of itself
    accuracy = EXACT._replace(newton=1.0, tolerance=1e-4)
    problem, start, w, (q_x, q_y) = begun(name, accuracy=accuracy)
    w.values[1:4] = w.values[START]
    _, iterations = plain(newton.solve)(problem, start, h, (q_x,) * 3, (q_y,) * 3, w, accuracy)
    assert counts[0] <= iterations <= counts[1]


@pytest.mark.parametrize(("name", "count"), [("fed", 4), ("ageing", SMOOTH_ITERATIONS)])
def test_corrections_that_grow_are_given_up(name, count, monkeypatch):
    """After three, of the slip velocity itself; its logarithm may have decades to go."""
    solve, sizes = plain(newton.solve), iter(1.1 ** np.arange(20))
    problem, start, w, (q_x, q_y) = begun(name)
    monkeypatch.setitem(
        solve.__globals__, "solve_blocks", lambda *_: ((1e-6 * next(sizes),) * 3, (0.0,) * 3)
    )
    w.values[1:4] = w.values[START]
    found = solve(problem, start, 1e-6, (q_x,) * 3, (q_y,) * 3, w, EXACT)
    assert found == (False, count)


def test_no_numbers_and_no_convergence_are_no_step():
    for name in ("smoothed", "lugre", "ageing"):
        problem, start, w, (q_x, q_y) = begun(name)
        w.values[1:4] = w.values[START]
        nan = (np.nan,) * 3
        assert plain(newton.solve)(problem, start, 1e-3, nan, nan, w, EXACT) == (False, 1)
        never = EXACT._replace(newton=-1.0)
        guess = (q_x,) * 3, (q_y,) * 3
        before = w.values[1:4, :2].copy()
        w.values[1:4, 2:] = w.values[START, 2:]
        # CLOSEST ends it where a correction is rounding
        found, iterations = plain(newton.solve)(problem, start, 1e-3, *guess, w, never)
        assert found
        assert iterations < SMOOTH_ITERATIONS
        assert not np.array_equal(before, w.values[1:4, :2])


@pytest.mark.parametrize("name", ["ageing", "slip"])
@pytest.mark.parametrize("h", [1e-5, 1e-4, 1e-3, 3e-3])
def test_a_breakaway_over_many_decades_takes_few_iterations(name, h):
    """From 1e-15 m/s to millimetres a second, since updates are damped by each stage's share."""
    motion = (3e-3, 1e-6, 1e-15, -2e-16)
    problem, start, w, (q_x, q_y) = begun(name, "steady", motion=motion)
    w.values[1:4] = w.values[START]
    found, iterations = plain(newton.solve)(problem, start, h, (q_x,) * 3, (q_y,) * 3, w, EXACT)
    assert found
    assert iterations <= 8  # 9 to 14, or none, with all of it inertia or the first share for good
    assert w.values[3, 0] > h
    residual, _ = Equations(name, "steady", motion).residuals(h, *at_stages(w))
    assert np.abs(residual).max() < 1e-11 * w.values[3, 0]
