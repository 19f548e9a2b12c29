"""Friction's direction on an ellipse: tensors and vectors, against NumPy's."""

import numpy as np
import pytest
from tests.entry import plain
from tests.systems import MOTIONS, Printed, motion_of, problem_of

from stiction.solver import surface
from stiction.solver.problem import Isotropic


@pytest.mark.parametrize("name", ["steady", "ellipse"])
@pytest.mark.parametrize("drawn", MOTIONS)
def test_the_tensor_and_the_flow_in_the_axes_of_a_step(name, drawn):
    """(M12) and (M16); on an isotropic surface N is 1, and friction is along the slip."""
    problem, motion = problem_of(name), motion_of(*drawn)
    printed = Printed(problem, motion)
    tensor = plain(surface.turned_into)(problem, motion.e_x, motion.e_y)
    assert tensor == pytest.approx([printed.N[0, 0], printed.N[0, 1], printed.N[1, 1]], abs=1e-14)
    for w in (-0.7, 0.0, 0.4):
        direction, step = plain(surface.friction_direction)(problem, tensor, w), 1e-5
        assert (direction.n_1, direction.tau) == pytest.approx(
            printed.friction_direction(w), abs=1e-13
        )
        change = np.subtract(
            printed.friction_direction(w + step), printed.friction_direction(w - step)
        ) / (2 * step)
        assert (direction.dn_1, direction.dtau) == pytest.approx(change, abs=1e-8)


@pytest.mark.parametrize("name", ["steady", "ellipse"])
@pytest.mark.parametrize("drawn", MOTIONS)
def test_products_with_the_tensor(name, drawn):
    """(M4): friction N e/sqrt(e.N e) fulfils a.N^-1 a = 1."""
    problem, motion = problem_of(name), motion_of(*drawn)
    n, e = problem.surface, np.array([motion.e_x, motion.e_y])
    N = np.array([[n.xx, n.xy], [n.xy, n.yy]])
    along = plain(surface.friction_along)(problem, *e)
    assert along == pytest.approx(N @ e / np.sqrt(e @ N @ e), rel=1e-13)
    assert plain(surface.held_product)(problem, along, along) == pytest.approx(1.0, rel=1e-13)
    other = (0.3, -0.8)
    wanted = along @ np.linalg.solve(N, other)
    assert plain(surface.held_product)(problem, along, other) == pytest.approx(wanted, rel=1e-12)


@pytest.mark.parametrize("beyond", [0.0, 1e-9, 1e-3, 0.1, 3.0])
@pytest.mark.parametrize("angle", [-2.0, 0.1, 1.3])
def test_where_a_slip_takes_off(beyond, angle):
    """(M18): the point of the ellipse nearest to a has e as its normal, and the rest is along e."""
    problem, f = problem_of("ellipse"), 8.0
    n = problem.surface
    N = np.array([[n.xx, n.xy], [n.xy, n.yy]])
    normal = np.array([np.cos(angle), np.sin(angle)])
    point = f * N @ normal / np.sqrt(normal @ N @ normal)
    y = plain(surface.takeoff)(problem, tuple(point + beyond * f * normal), f)
    assert y / np.hypot(*y) == pytest.approx(normal, abs=1e-9)
    assert plain(surface.takeoff)(problem_of("steady"), (9.0, 3.0), f) == (9.0, 3.0)


def test_the_tensor_of_an_isotropic_surface_is_one():
    assert Isotropic() == (1.0, 0.0, 1.0)
