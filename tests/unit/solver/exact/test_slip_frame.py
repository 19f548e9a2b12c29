"""The axes of a step, forces in them, and the transformation back."""

import numpy as np
import pytest
from tests.entry import plain
from tests.systems import MOTIONS, SLIDERS, Printed, motion_of, problem_of

from stiction.solver import surface
from stiction.solver.exact import slip_frame
from stiction.solver.rig import General

ALL = pytest.mark.parametrize(
    ("name", "drawn"), [(name, drawn) for name in SLIDERS for drawn in MOTIONS]
)


def frames_of(name, drawn):
    """Return a problem, the step's axes, and the same by NumPy."""
    problem, motion = problem_of(name), motion_of(*drawn)
    return problem, plain(slip_frame.frame_of)(problem, motion), Printed(problem, motion)


@ALL
def test_tensors_over_mass(name, drawn):
    problem, frame, printed = frames_of(name, drawn)
    for letter, tensor in (("k", printed.k), ("c", printed.c)):
        found = [getattr(frame, f"{letter}_{ij}") for ij in (11, 12, 22)]
        assert found == pytest.approx(tensor[np.triu_indices(2)], rel=1e-12)
    assert frame.surface == pytest.approx(printed.N[np.triu_indices(2)], abs=1e-14)
    assert (frame.e_x, frame.e_y) == tuple(printed.axes[0])
    for vector in ((1.0, 0.0), (0.3, -2.0)):
        wanted = printed.axes @ printed.turn @ vector
        found = plain(slip_frame.in_frame)(problem, frame, vector)
        assert found == pytest.approx(wanted, rel=1e-13)


@ALL
@pytest.mark.parametrize("dt", [0.0, 3e-4, 2e-3])
def test_what_the_drive_alone_does(name, drawn, dt):
    """(M17) and its rate of change."""
    problem, frame, printed = frames_of(name, drawn)
    *b, db_1, db_2 = plain(slip_frame.pull)(problem, frame, dt)
    assert b == pytest.approx(printed.b(dt), rel=1e-11)
    assert (db_1, db_2) == pytest.approx(printed.db(dt), rel=1e-11)


@ALL
def test_what_acts_at_the_start(name, drawn):
    """a = b - c (r, 0), friction along and across by (M12), the drive's change of a."""
    problem, frame, printed = frames_of(name, drawn)
    start = plain(slip_frame.outset)(problem, frame)
    f, slope = printed.friction(printed.t, printed.r)
    n_1, tau = printed.friction_direction(0.0)
    a = printed.b(0.0) - printed.c @ [printed.r, 0.0]
    wanted = *a, *printed.db(0.0), f * n_1, slope * n_1, f * tau
    assert start == pytest.approx(wanted, rel=1e-11, abs=1e-12)


@ALL
def test_the_elongation_after_a_step(name, drawn):
    """(M30)."""
    problem, frame, printed = frames_of(name, drawn)
    dt, slid = 2e-3, np.array([3e-6, -1e-6])
    wanted = printed.u + printed.drive("travel", printed.t, dt) - slid @ printed.axes
    assert plain(slip_frame.elongation)(problem, frame, dt, *slid) == pytest.approx(wanted)
    w = -0.3
    e = np.array([1.0, w]) @ printed.axes / np.hypot(1.0, w)
    assert plain(slip_frame.turned_direction)(frame, w) == pytest.approx(e, rel=1e-13)


@pytest.mark.parametrize("name", SLIDERS)
def test_a_general_rig_in_the_axes_of_a_step(name):
    """(M71) to (M74): its tensors, the drive through T^-1, and the speed |T r|."""
    T = np.array([[1.1, 0.3], [-0.2, 0.8]])
    rig, drawn = General(*T.ravel(), 0.7, 1.0, 0.4, -0.5, 0.9), MOTIONS[0]
    problem = problem_of(name)._replace(rig=rig)
    motion = motion_of(*drawn)
    frame, printed = plain(slip_frame.frame_of)(problem, motion), Printed(problem, motion)
    printed.turn = np.array([[1.0, -0.5], [0.4, 0.9]])  # what is in X and in Y
    printed.C = printed.C + 0.7 * np.eye(2)[::-1]
    axes = printed.axes
    upper = np.triu_indices(2)
    damping = (axes @ printed.C @ axes.T / printed.m)[upper]
    assert (frame.c_11, frame.c_12, frame.c_22) == pytest.approx(damping, rel=1e-12)
    assert frame.metric == pytest.approx((axes @ T.T @ T @ axes.T)[upper], rel=1e-12)
    found = plain(slip_frame.in_frame)(problem, frame, (0.3, -2.0))
    assert found == pytest.approx(axes @ printed.turn @ [0.3, -2.0], rel=1e-12)
    *b, db_1, db_2 = plain(slip_frame.pull)(problem, frame, 2e-3)
    assert b == pytest.approx(printed.b(2e-3), rel=1e-11)
    assert (db_1, db_2) == pytest.approx(printed.db(2e-3), rel=1e-11)
    w = -0.4
    ratio = plain(surface.speed_ratio)(problem, frame.metric, w)
    assert ratio == pytest.approx(np.hypot(*T @ axes.T @ [1.0, w]), rel=1e-12)


@pytest.mark.parametrize("name", SLIDERS)
def test_friction_goes_on_in_a_line_below_zero(name):
    problem, _, printed = frames_of(name, MOTIONS[0])
    f, slope = printed.friction(0.4, 2e-3)
    assert plain(slip_frame.friction)(problem, 0.4, 2e-3) == pytest.approx((f, slope), rel=1e-14)
    f, slope = printed.friction(0.4, 0.0)
    found = plain(slip_frame.friction)(problem, 0.4, -1e-3)
    assert found == pytest.approx((f - 1e-3 * slope, slope), rel=1e-13)
