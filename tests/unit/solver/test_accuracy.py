"""The tolerances of each step, and the scales that they are relative to."""

from math import hypot, inf, pi, sqrt

import numpy as np
import pytest
from tests.systems import ELLIPSE, PROGRAM, STEADY

import stiction as st
from stiction.solver.accuracy import accuracy, scales_of, steepest_weakening, tolerance
from stiction.solver.segments import segments

AT_REST = st.Initial(v_x=STEADY.direction[0] * 2e-3, v_y=STEADY.direction[1] * 2e-3)


def accuracy_of(slider, initial=AT_REST, start=0.0, rtol=1e-6):
    segment = next(segments(slider, start, start + 1.0))
    return accuracy(slider, scales_of(slider, initial), segment, start, rtol)


def weakening(slider):
    """Return -dF/dv of exponential weakening at rest, where it is steepest."""
    law = slider.law
    return (law.mu_0 - law.mu_inf) / law.v_f * slider.normal_load


def test_what_a_step_is_held_to():
    """(M39) to (M42)."""
    found, s = accuracy_of(STEADY), STEADY
    along, across = 2e-3 * np.array(s.direction)
    tol = 0.8 * 1e-6**0.8
    free = [0.2 * 10.0 / sqrt(s.mass * k) for k in (s.k_x, s.k_y)]
    sigma = min(across, *free) / (1 + weakening(s) ** 2 / (s.k_y * s.mass))
    least = 1e-13 * (along + across + sum(free)) / tol
    newton = min(0.2, 100 * sqrt(tol)) * tol
    wanted = tol, newton, sigma, *free, inf, along, s.mass / s.k_x, s.mass / s.k_y
    assert found == pytest.approx((*wanted, tol * sigma, 0.0, least), rel=1e-9)


def test_of_a_law_with_states_no_weakening_is_known():
    """The speed of (M40) is then that of the transverse slip itself."""
    lugre = STEADY.replace(friction=st.laws.LuGre(0.15, 0.2, "10 mm/s", 1e5, 300.0, 2.0))
    assert accuracy_of(lugre).speed == pytest.approx(2e-3 * abs(STEADY.direction[1]), rel=1e-12)


@pytest.mark.parametrize("phi", ["0 deg", "90 deg"])
def test_along_a_principal_axis_the_speed_is_the_drive_s_along_it(phi):
    s = STEADY.replace(phi=phi)
    found = accuracy_of(s, st.Initial())
    k = s.k_y if phi == "90 deg" else s.k_x
    wanted = 2e-3 / (1 + weakening(s) ** 2 / (k * s.mass))
    assert found.speed == pytest.approx(wanted, rel=1e-6)
    assert found.drive == pytest.approx(2e-3)


def test_without_a_drive_or_friction():
    """A millionth of what friction can do; else next to nothing of the speeds at the start."""
    still = STEADY.replace(drive=st.ConstantVelocity(0.0))
    found = accuracy_of(still)
    sigma = 1e-6 * min(found.free_x, found.free_y)
    damped = sigma / (1 + weakening(still) ** 2 / (still.k_x * still.mass))
    assert found.speed == pytest.approx(damped, rel=1e-4)
    assert found.drive == inf
    bare = still.replace(friction=st.Coulomb(0.0))
    begun = st.Initial(u_x=1e-3, u_y=2e-5, v_x=3e-3, v_y=-1e-3)
    elastic = hypot(3e-3, 1e-3, 1e-3 * sqrt(1e3 / 0.25), 2e-5 * sqrt(4e4 / 0.25))
    assert accuracy_of(bare, begun).speed == pytest.approx(1e-15 * elastic)
    assert accuracy_of(bare, st.Initial()).speed == np.finfo(float).tiny
    fast = STEADY.replace(drive=st.ConstantVelocity(1e3), friction=st.Coulomb(0.2))
    assert accuracy_of(fast).speed == pytest.approx(
        min(accuracy_of(fast).free_x, accuracy_of(fast).free_y)
    )


def test_an_ellipse_and_a_program():
    """v_fx takes the root of N_xx, and a step is a quarter of the fastest oscillation at most."""
    plain, found = accuracy_of(STEADY), accuracy_of(ELLIPSE)
    n = next(segments(ELLIPSE, 0.0, 1.0)).problem.surface
    assert found.free_x == pytest.approx(plain.free_x * sqrt(n.xx))
    assert found.free_y == pytest.approx(plain.free_y * sqrt(n.yy))
    assert accuracy_of(PROGRAM).longest == pytest.approx(0.5 * pi / (2 * pi * 70.0))
    assert accuracy_of(PROGRAM).free_x == pytest.approx(plain.free_x * 1.05)  # of the largest load


@pytest.mark.parametrize("rtol", [1e-2, 1e-4, 1e-6, 1e-12])
def test_the_tolerance_of_a_step(rtol):
    """(M39)."""
    assert tolerance(rtol) == pytest.approx(0.8 * rtol**0.8, rel=1e-14)


class Late(st.Coulomb):
    """A law that weakens nowhere but about one speed."""

    __slots__ = ()

    def slope(law, v):
        return -5.0 * np.exp(-((np.log(v / 3.3e-5) / 0.3) ** 2)) if v > 0.0 else 1.0


def test_the_steepest_weakening():
    """Up to ten times the speed, to a thousandth; none of a law that strengthens."""
    law = st.laws.Stribeck(0.2, 0.1, 0.01, 2.0)
    speeds = np.geomspace(1e-6, 1.0, 20_001)
    wanted = max(-law.slope(v) for v in speeds)
    assert steepest_weakening(law, 1.0) == pytest.approx(wanted, rel=2e-3)
    within = max(-law.slope(v) for v in speeds[speeds <= 1e-3])
    assert steepest_weakening(law, 1e-4) == pytest.approx(within, rel=1e-6)
    assert steepest_weakening(st.ExponentialWeakening(0.1, 0.2, 0.01), 1.0) == 0.0
    assert steepest_weakening(st.Coulomb(0.2), 1.0) == 0.0
    assert steepest_weakening(Late(0.2), 1.0) == pytest.approx(5.0, rel=2e-2)
    assert steepest_weakening(Late(0.2), 1e4) == pytest.approx(5.0, rel=2e-2)
    assert steepest_weakening(st.ExponentialWeakening(0.2, 0.1, 1e-30), 1.0) == pytest.approx(1e29)


class Early(st.Coulomb):
    """A law that weakens at all speeds."""

    __slots__ = ()

    def slope(law, v):
        return -1.0


def test_laws_of_different_classes_are_told_apart_inside_another():
    """A run took the tolerances of an equal law that ran before it in the process."""
    for kind, wanted in ((st.Coulomb, 0.0), (Early, 1.0)):
        law = st.laws.Anisotropic(kind(0.31), 1.5, "20 deg")
        assert steepest_weakening(law, 1.0) == wanted
