"""The axes of a step, forces in them, and the transformation back."""

import numpy as np
import pytest
from tests.entry import plain
from tests.systems import MOTIONS, SLIDERS, Printed, motion_of, problem_of

from stiction.solver.exact import slip_frame

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
    n_1, tau = printed.flow(0.0)
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
def test_friction_goes_on_in_a_line_below_zero(name):
    problem, _, printed = frames_of(name, MOTIONS[0])
    f, slope = printed.friction(0.4, 2e-3)
    assert plain(slip_frame.friction)(problem, 0.4, 2e-3) == pytest.approx((f, slope), rel=1e-14)
    f, slope = printed.friction(0.4, 0.0)
    found = plain(slip_frame.friction)(problem, 0.4, -1e-3)
    assert found == pytest.approx((f - 1e-3 * slope, slope), rel=1e-13)
