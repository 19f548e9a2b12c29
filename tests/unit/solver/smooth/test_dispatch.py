"""A law in the smooth solver: friction, the rates of its states, and the derivatives."""

import numpy as np
import pytest
from tests.entry import plain
from tests.unit.solver.smooth.systems import LAWS, STATEFUL, STATELESS, behind, derivative

from stiction.friction.law import states
from stiction.solver.regularised import Smoothed
from stiction.solver.smooth import dispatch
from stiction.solver.smooth.dispatch import FINEST_GRAIN, INCREMENT, PointedSmoothLaw
from stiction.solver.smooth.workspace import SECOND, TRIAL, workspace

LOAD, PER_MASS = 7.0, 4.0
SLIPS = [(3e-3, -2e-3), (-4e-4, 1e-4), (0.0, 5e-2)]


def room(name):
    """Return a law behind its pointers, and a workspace with its states in the second stage."""
    law, z = LAWS[name]
    w = plain(workspace)(len(z))
    w.values[SECOND, 2:] = z
    w.size[:2] = 1e-3
    w.size[2:] = [1.0 if state.unit == "1" else 1e-5 for state in states(law)]
    return behind(law), w


def friction_over_mass(name, slip, z):
    return np.array(LAWS[name][0].force(tuple(slip), LOAD, tuple(z))) * PER_MASS


@pytest.mark.parametrize("name", STATELESS)
@pytest.mark.parametrize("slip", [*SLIPS, (0.0, 0.0)])
def test_a_law_without_states(name, slip):
    """(M60), and its derivatives, by central differences; at zero slip they exist as well."""
    law, w = room(name)
    found = plain(dispatch.friction_and_changes)(law, slip, LOAD, PER_MASS, w, SECOND, True)
    own = LAWS[name][0]
    n, s = np.array([[own.surface.xx, own.surface.xy], [own.surface.xy, own.surface.yy]]), slip
    size = np.sqrt(s @ n @ s + own.delta**2)
    mu = own.law.coefficient(np.hypot(*slip))
    assert found[:2] == pytest.approx(mu * LOAD * PER_MASS * n @ slip / size)
    assert friction_over_mass(name, slip, ()) == pytest.approx(found[:2])
    wanted = derivative(lambda x: friction_over_mass(name, x, ()), slip, [1e-8, 1e-8])
    if slip != (0.0, 0.0):  # where the law itself has a kink
        assert np.reshape(found[2:], (2, 2)) == pytest.approx(wanted, rel=1e-5, abs=1e-3)
    else:
        at_rest = own.law.coefficient(0.0) * LOAD * PER_MASS / own.delta
        assert np.reshape(found[2:], (2, 2)) == pytest.approx(at_rest * n)
    assert own.grain(()) == own.delta
    assert plain(dispatch.grain_of)(law, w.values, SECOND) == own.delta


@pytest.mark.parametrize("name", STATEFUL)
@pytest.mark.parametrize("slip", SLIPS)
def test_a_law_with_states(name, slip):
    """Friction, change, and derivatives: the law's own are exact, others forward differences."""
    law, w = room(name)
    own, z = LAWS[name]
    found = plain(dispatch.friction_and_changes)(law, slip, LOAD, PER_MASS, w, SECOND, True)
    change = own.change(slip, LOAD, z)
    assert found[:2] == pytest.approx(friction_over_mass(name, slip, z), rel=1e-14)
    assert w.changes[SECOND] == pytest.approx([*found[:2], *change], rel=1e-14)

    def both(x):
        friction = friction_over_mass(name, x[:2], x[2:])
        return np.array([*friction, *own.change(tuple(x[:2]), LOAD, tuple(x[2:]))])

    at, sizes = np.array([*slip, *z]), 1e-4 * w.size
    wanted = derivative(both, at, sizes)
    assert found[2:] == tuple(w.jacobian[SECOND, :2, :2].flat)
    scale = np.abs(wanted).max(axis=1, keepdims=True)
    assert w.jacobian[SECOND] / scale == pytest.approx(wanted / scale, abs=1e-4)
    assert not w.jacobian[[0, 1, 3, 4, 5]].any()
    # the values themselves stay, and what is not wanted is not computed
    assert w.values[SECOND].tolist() == [0.0, 0.0, *z]
    before = w.jacobian.copy()
    w.values[SECOND, 2:] *= 1.1
    again = plain(dispatch.friction_and_changes)(law, slip, LOAD, PER_MASS, w, SECOND, False)
    assert again[:2] != found[:2]
    assert (w.jacobian == before).all()


def test_forward_differences():
    """By the printed increment of each column; a linear law's are exact up to rounding."""
    law, w = room("fed")
    slip, (z,) = SLIPS[0], LAWS["fed"][1]
    plain(dispatch.friction_and_changes)(law, slip, LOAD, PER_MASS, w, SECOND, True)
    f, (x, y) = LAWS["fed"][0].mu * LOAD * PER_MASS, slip
    # forward differences of y + x x - z by x are 2 x + step
    step = INCREMENT * (w.size[0] + abs(x))
    wanted = [[f, 0.0, 3 * f], [f * (2 * x + step), f, -f], [1.0, -4.0 * y, -30.0]]
    scale = np.array([[f], [f], [30.0]])
    got = w.jacobian[SECOND] / scale
    assert got == pytest.approx(wanted / scale, abs=1e-6)
    assert w.values[TRIAL].tolist() == [*slip, z]


def test_a_grain_is_no_less_than_the_finest():
    law, w = room("ageing")
    own, z = LAWS["ageing"]
    grain = plain(dispatch.grain_of)
    psi = own.mu_star + own.b * z[0]
    assert grain(law, w.values, SECOND) == pytest.approx(2 * own.V_star * np.exp(-psi / own.a))
    w.values[SECOND, 2] = 1e6
    assert grain(law, w.values, SECOND) == FINEST_GRAIN
    law, w = room("fed")
    assert grain(law, w.values, SECOND) == np.inf


@pytest.mark.parametrize(("name", "unitless"), [("lugre", [False, False]), ("ageing", [True])])
def test_which_columns_have_no_unit(name, unitless):
    law = dispatch.point_to_smooth_law(LAWS[name][0])
    assert isinstance(law, PointedSmoothLaw)
    assert law.unitless.tolist() == [True, True, *unitless]


@pytest.mark.parametrize("name", STATELESS)
def test_far_from_zero_slip_the_set_valued_law_is_left(name):
    """(M60) for |s| >> delta is F = mu W N s/sqrt(s.N s) to (delta/s)^2/2."""
    own, slip = LAWS[name][0], np.array([3.0, -4.0])
    smooth = own.force(tuple(slip), LOAD, ())
    sharp = Smoothed(own.law, own.surface, 0.0).force(tuple(slip), LOAD, ())
    assert np.divide(smooth, sharp) == pytest.approx([1.0, 1.0], abs=own.delta**2)
    assert smooth != sharp
