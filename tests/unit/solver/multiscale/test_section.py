"""The curve on which sticks end, by one angle."""

import numpy as np
import pytest
from tests.entry import plain
from tests.systems import Printed, motion_of, problem_of

from stiction.solver.multiscale import section
from stiction.solver.stick import margin, stick_duration

ALL = pytest.mark.parametrize(
    ("name", "theta"), [(n, t) for n in ("steady", "ellipse") for t in (-2.5, -0.3, 0.4, 1.9, 3.0)]
)


@ALL
def test_an_angle_and_its_elongation(name, theta):
    """(M52): a = f_s L (cos, sin), L the Cholesky factor of N, and the margin is zero there."""
    problem = problem_of(name)
    u, n = plain(section.elongation_held)(problem, theta), problem.surface
    L = np.linalg.cholesky(np.array([[n.xx, n.xy], [n.xy, n.yy]]))
    f = problem.law.coefficient(0.0) * problem.load.force / problem.system.mass
    a = f * L @ [np.cos(theta), np.sin(theta)]
    assert plain(section.limit_at_angle)(problem, theta) == pytest.approx(a, rel=1e-12)
    assert Printed(problem, motion_of(*u, 1.0, 0.0)).holding(0.0, np.array(u)) == pytest.approx(a)
    excess, _, square = plain(margin)(problem, 0.0, *u)
    assert excess == pytest.approx(0.0, abs=1e-12 * square)
    assert plain(section.angle)(problem, *u) == pytest.approx(theta, rel=1e-9)


@ALL
def test_a_stick_can_be_begun_half_of_the_chord_before_its_end(name, theta):
    """(M54): the margin is least there; none ends where the pull goes inwards."""
    problem, u = problem_of(name), np.array(plain(section.elongation_held)(problem_of(name), theta))
    v = Printed(problem, motion_of(*u, 1.0, 0.0)).drive("rate", 0.0)
    lead = plain(section.lead)(problem, theta)
    _, rises, _ = plain(margin)(problem, 0.0, *u)
    assert (lead > 0.0) == (rises > 0.0)
    if lead > 0.0:
        begun = u - lead * v
        _, change, square = plain(margin)(problem, 0.0, *begun)
        assert change == pytest.approx(0.0, abs=1e-12 * square / lead)
        duration, _ = plain(stick_duration)(problem, 0.0, *begun, np.inf)
        assert duration == pytest.approx(lead, rel=1e-9)
    else:
        assert lead == 0.0


@pytest.mark.parametrize("turns", [-3, 0, 1, 5])
@pytest.mark.parametrize("angle", [-3.1, 0.0, 0.4, 3.1])
def test_a_difference_of_angles(turns, angle):
    assert plain(section.wrap_angle)(angle + 2 * np.pi * turns) == pytest.approx(angle, abs=1e-13)
    assert np.isnan(plain(section.wrap_angle)(np.nan))
