"""Forces at a point, with their derivatives, and the scales of errors."""

import numpy as np
import pytest
from tests.entry import plain
from tests.systems import SLIDERS
from tests.unit.solver.smooth.systems import (
    EXACT,
    LAWS,
    TIME,
    Equations,
    begun,
    derivative,
    smooth_problem,
)

from stiction.solver.rig import General
from stiction.solver.smooth import right_hand_side
from stiction.solver.smooth.coordinate import coordinate, slip_at
from stiction.solver.smooth.right_hand_side import NOTICED, SmoothOutset
from stiction.solver.smooth.workspace import LAST, START, workspace


@pytest.mark.parametrize("drive", SLIDERS)
@pytest.mark.parametrize("dt", [0.0, 3e-3])
def test_what_acts_without_slip(drive, dt):
    """(M17), and the load then."""
    printed = Equations("smoothed", drive)
    start = SmoothOutset(TIME, *printed.u, np.inf, 1e-3, 1.0)
    found = plain(right_hand_side.pull)(smooth_problem("smoothed", drive), start, dt)
    assert found[:2] == pytest.approx(printed.b(dt), rel=1e-12)
    assert found.load == printed.load(dt)


@pytest.mark.parametrize("name", LAWS)
@pytest.mark.parametrize("drawn", [(2e-3, 3e-3), (-4e-4, 0.0)])
def test_a_point_and_its_derivatives(name, drawn):
    """By the slip coordinate, (M64) and (M65), as differences."""
    problem, start, w, _ = begun(name)
    load, per = 6.0, problem.system.per_mass
    q = np.array(plain(coordinate)(start.eps, *drawn))
    w.values[LAST, 2:] = LAWS[name][1]
    found = plain(right_hand_side.evaluate)(problem, start.eps, load, *q, w, LAST, True)
    assert found[:2] == pytest.approx(drawn)

    def slip(q):
        return np.array(plain(slip_at)(start.eps, *q))

    def friction(q):
        return per * np.array(LAWS[name][0].force(tuple(slip(q)), load, LAWS[name][1]))

    assert found[2:4] == pytest.approx(friction(q))
    by_slip = derivative(slip, q, 1e-6 * np.hypot(*q) * np.ones(2))
    by_friction = derivative(friction, q, 1e-6 * np.hypot(*q) * np.ones(2))
    small = 1e-6 * np.abs(by_slip).max()
    s_xx, s_xy, s_yy = found[4:7]
    assert np.array([[s_xx, s_xy], [s_xy, s_yy]]) == pytest.approx(by_slip, rel=1e-5, abs=small)
    small = 1e-5 * np.abs(by_friction).max()
    assert np.reshape(found[7:], (2, 2)) == pytest.approx(by_friction, rel=1e-4, abs=small)
    unwanted = plain(right_hand_side.evaluate)(problem, start.eps, load, *q, w, LAST, False)
    assert unwanted[:7] == found[:7]


def test_the_share_of_inertia_along_the_slip():
    """(M69): of what resists along q, by inertia and damping; all where friction weakens."""
    problem, (c, s) = smooth_problem("smoothed"), (0.6, 0.8)
    share, h, a = plain(right_hand_side.inertia_share), 1e-3, 1.7
    n, system = np.array([c, s]), problem.system
    slope, friction = (2.0, 0.5, 3.0), (5e3, 1e3, 7e3)
    by = {"s": slope, "f": friction}
    along = {k: n @ np.array([[xx, xy], [xy, yy]]) @ n for k, (xx, xy, yy) in by.items()}
    damping = 1.0 + h * (system.c_x * c * c + system.c_y * s * s) / system.mass
    inertia = a * along["s"] * damping
    found = share(problem, h, a, (3.0 * c, 3.0 * s), slope, friction)
    assert found == pytest.approx(inertia / (inertia + h * along["f"]))
    assert share(problem, h, a, (3.0 * c, 3.0 * s), slope, (-1e9, 0.0, -1e9)) == 1.0
    assert share(problem, h, a, (0.0, 0.0), slope, friction) == 1.0


@pytest.mark.parametrize("drive", SLIDERS)
def test_the_motion_about_steady_sliding(drive):
    """(M42)."""
    problem, start, w, q = begun("lugre", drive)
    printed, none = Equations("lugre", drive), np.zeros(2)
    acceleration, _ = printed.rates(0.0, none, printed.s, printed.z)
    change = printed.printed.drive("rate", TIME) - printed.s
    curve = printed.printed.drive("rate_change", TIME) - acceleration
    wanted = np.sqrt(change @ change + curve**2 @ [EXACT.square_x, EXACT.square_y])
    pull = plain(right_hand_side.pull)(problem, start, 0.0)
    at = plain(right_hand_side.evaluate)(problem, start.eps, pull.load, *q, w, START, True)
    moving = plain(right_hand_side.moving)
    found, apart = moving(problem, TIME, pull, at, EXACT)
    fast = change @ change + curve @ curve * min(EXACT.square_x, EXACT.square_y)
    assert (found, apart) == pytest.approx((wanted, fast), rel=1e-12)
    assert moving(problem, TIME, pull, at, EXACT._replace(least=3 * wanted))[0] == 3 * wanted


@pytest.mark.parametrize("effect", [(3.0, 4.0), (0.0, 0.0), (3e-9, -4e-9)])
def test_what_errors_of_states_are_held_against(effect):
    """What changes the coefficient by 0.01, at most 1 without a unit, and the state itself."""
    load = 6.0
    for name in ("lugre", "ageing"):
        problem, w = smooth_problem(name), plain(workspace)(len(LAWS[name][1]))
        w.values[START, 2:] = -2.0
        w.jacobian[START, 0, 2:], w.jacobian[START, 1, 2:] = effect
        plain(right_hand_side.measure)(problem, load, w)
        size = np.hypot(*effect)
        least = NOTICED * load / problem.system.mass / size if size else 1.0
        if name == "ageing":
            least = min(1.0, least)
        assert w.size == pytest.approx([1.0, 1.0, *[2.0 + least] * (len(w.size) - 2)])


@pytest.mark.parametrize("name", LAWS)
def test_friction_on_a_general_rig_and_its_derivatives(name):
    """(M71) and (M72): the law is asked in x and y; cross damping is added; by differences."""
    problem, _, w, _ = begun(name)
    T, load, per = np.array([[1.1, 0.3], [-0.2, 0.8]]), 6.0, problem.system.per_mass
    problem = problem._replace(rig=General(*T.ravel(), 0.7, 1.0, 0.0, 0.0, 1.0))
    law, states = LAWS[name]
    w.values[LAST, 2:] = states
    s = np.array([2e-3, 3e-3])

    def friction(s):
        x, y = s
        turned = T.T @ np.array(law.force(tuple(T @ s), load, states))
        return per * turned + 0.7 * per * np.array([y, x])

    found = plain(right_hand_side.acting)(problem, tuple(s), load, w, LAST, True)
    assert found[:2] == pytest.approx(friction(s), rel=1e-12)
    assert np.reshape(found[2:], (2, 2)) == pytest.approx(
        derivative(friction, s, [1e-7, 1e-7]), rel=1e-5
    )

    n = 2 + len(states)

    def change(s):
        return np.array(law.change(tuple(T @ s), load, states))

    def by_states(z):
        return per * T.T @ np.array(law.force(tuple(T @ s), load, tuple(z)))

    if states:
        effect = derivative(by_states, np.array(states), 1e-6 * w.size[2:])
        assert w.jacobian[LAST, :2, 2:n] == pytest.approx(effect, rel=1e-5, abs=1e-9)
        by_slip = derivative(change, s, [1e-7, 1e-7])
        assert w.jacobian[LAST, 2:n, :2] == pytest.approx(
            by_slip, rel=1e-5, abs=1e-6 * np.abs(by_slip).max()
        )


@pytest.mark.parametrize("h", [1e-6, 1e-3, 10.0])
def test_the_slip_that_states_notice_in_a_step(h):
    """(M70a): it changes a state by its size, over the step or as long as the state remembers."""
    w = plain(workspace)(2)
    w.size[2:] = 3e-7, 2e-3
    w.jacobian[START, 2, :3] = 0.6, 0.8, -40.0
    w.jacobian[START, 3, :4] = -500.0, 0.0, 0.0, 0.0
    speed = plain(right_hand_side.slowest)(h, w, np.inf)
    each = 3e-7 * (1.0 / h + 40.0), 2e-3 / h / 500.0
    assert speed == pytest.approx(min(each))
    assert plain(right_hand_side.slowest)(h, w, 0.5 * speed) == 0.5 * speed
    assert plain(right_hand_side.slowest)(h, plain(workspace)(0), 7.0) == 7.0
