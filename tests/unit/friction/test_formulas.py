"""Each law's coefficient, force and rates of change, as its docstring and its source print them."""

from math import asinh, exp, hypot, inf, log, log10, nan

import numpy as np
import pytest

import stiction as st
from stiction.errors import DescriptionError
from stiction.friction import states
from stiction.friction.equivalent import CHANGED, Traits, like, traits
from stiction.friction.law import static_coefficient
from stiction.friction.laws.lugre import bending, bending_gradient
from stiction.friction.laws.lugre_hyperbolic import LuGreHyperbolic
from stiction.friction.laws.rate_and_state import common as rs

SPEEDS = [0.0, 1e-4, 3e-3, 0.02, 0.5]
RATE = {"a": 0.01, "b": 0.015, "D_c": 1e-5, "mu_star": 0.6, "V_star": 1e-6}
LUGRE = st.laws.LuGre(mu_c=0.15, mu_s=0.2, v_s=0.01, sigma_0=1e5, sigma_1=300.0, sigma_2=2.0)


@pytest.mark.parametrize("v", SPEEDS)
def test_set_valued_laws(v):
    exponential = st.ExponentialWeakening(0.2, 0.15, 0.01).coefficient(v)
    assert exponential == pytest.approx(0.15 + 0.05 * exp(-v / 0.01))
    assert st.laws.HyperbolicWeakening(0.2, 0.01).coefficient(v) == pytest.approx(
        0.2 / (1 + v / 0.01)
    )
    stribeck = st.laws.Stribeck(0.2, 0.15, 0.01, 1.7, 0.3)
    fallen = exp(-((v / 0.01) ** 1.7))
    assert stribeck.coefficient(v) == pytest.approx(0.15 + 0.05 * fallen + 0.3 * v)
    fall = -0.05 * 1.7 / 0.01 * (v / 0.01) ** 0.7 * fallen
    assert stribeck.slope(v) == pytest.approx(fall + 0.3)
    assert st.Coulomb(0.2).coefficient(v) == 0.2
    assert st.Coulomb(0.2).slope(v) == 0.0
    assert st.laws.Stribeck(0.2, 0.15, 1e-9, 9.0).coefficient(1e300) == 0.15  # no overflow
    assert st.laws.Stribeck(0.2, 0.15, 1e-9, 9.0).slope(1e300) == 0.0


@pytest.mark.parametrize("v", SPEEDS)
def test_laws_of_rosin(v):
    """As printed in the sources that `stiction presets` names, v in m/s."""
    two = st.laws.TwoExponentials(0.35, 0.4, 0.01, 0.45, 0.1)
    assert two.coefficient(v) == pytest.approx(0.4 * exp(-v / 0.01) + 0.45 * exp(-v / 0.1) + 0.35)
    power = st.laws.PowerLawWeakening(0.2 * 0.011**-0.4, 0.011, 0.4)
    assert power.coefficient(v) == pytest.approx(0.2 * (v + 0.011) ** -0.4)
    hyperbola = st.laws.HyperbolicWeakening(0.8, 0.2, mu_inf=0.4)
    assert hyperbola.coefficient(v) == pytest.approx(0.4 + 0.08 / (v + 0.2))
    for law in (two, power, hyperbola):
        h = 1e-6 * (v + 1e-3)
        change = (law.coefficient(v + h) - law.coefficient(max(v - h, 0.0))) / (h + min(h, v))
        assert law.slope(v) == pytest.approx(change, rel=1e-3 if v == 0.0 else 1e-7)


@pytest.mark.parametrize("slip", [0.0, 1e-7, 3e-6])
@pytest.mark.parametrize("log_theta", [-2.0, 0.3, 4.0])
def test_the_law_of_perrin_rice_and_zheng(slip, log_theta):
    """theta' = 1 - (V theta/2D)^2, with log_theta = ln(V* theta/2D)."""
    law = st.laws.RateStatePerrin(**RATE)
    theta = 2 * law.D_c / law.V_star * exp(log_theta)
    wanted = (1 - (slip * theta / (2 * law.D_c)) ** 2) / theta
    assert law.change((slip, 0.0), 1.0, (log_theta,)) == pytest.approx((wanted,), rel=1e-13)


@pytest.mark.parametrize("v", SPEEDS)
def test_bristles_on_hyperbolic_weakening(v):
    """z' = s - sigma_0 |s| z/g, g = W mu_0/(1 + v/v_h); steady friction is g along the slip."""
    law = st.laws.LuGreHyperbolic(0.2, 0.01, 1e5, 300.0, 2.0)
    g = 10.0 * 0.2 / (1 + v / 0.01)
    assert law.change((v, 0.0), 10.0, (1e-6, 2e-6)) == pytest.approx(
        (v - 1e5 * v * 1e-6 / g, -1e5 * v * 2e-6 / g)
    )
    assert law.force((v, 0.0), 10.0, (g / 1e5, 0.0)) == pytest.approx((g + 2.0 * v, 0.0))


def test_the_static_coefficient_is_the_larger_one():
    assert static_coefficient(st.Coulomb(0.2)) == 0.2
    assert static_coefficient(st.Coulomb(0.2, mu_static=0.3)) == 0.3
    assert static_coefficient(st.laws.Anisotropic(st.Coulomb(0.2, mu_static=0.3), 1.5)) == 0.3
    assert static_coefficient(st.laws.Table(v=[0.001, 0.01], mu=[0.2, 0.1])) == 0.2


def test_the_defaults_have_no_static_coefficient_and_no_viscous_friction():
    for law in (
        st.Coulomb(0.2),
        st.ExponentialWeakening(0.2, 0.1, 0.01),
        st.laws.HyperbolicWeakening(0.2, 0.01),
        st.laws.Stribeck(0.2, 0.1, 0.01),
        st.laws.Table(v=[0.0, 1.0], mu=[0.2, 0.1]),
        st.laws.TwoExponentials(0.1, 0.05, 0.01, 0.05, 0.1),
    ):
        assert law.mu_static == 0.0
    bristles = st.laws.LuGreHyperbolic(0.2, 0.01, 1e5, 300.0)
    assert (bristles.sigma_2, bristles.settled(0.5)) == (0.0, (0.0, 0.0))
    assert (st.laws.Stribeck(0.2, 0.1, 0.01).d, st.laws.Stribeck(0.2, 0.1, 0.01).c) == (2.0, 0.0)
    assert LUGRE._replace(sigma_2=0.0) == st.laws.LuGre(*LUGRE[:5])
    assert st.laws.Anisotropic(st.Coulomb(0.2), 1.5).angle == 0.0


def test_the_curve_of_a_table_is_smooth():
    """A slope by differences, of cubics that meet with it, and run into a constant."""
    law = st.laws.Table(v=[0.001, 0.004, 0.01], mu=[0.2, 0.12, 0.1])
    step = 1e-8
    for v in (0.0005, 0.001, 0.0013, 0.003, 0.004, 0.007, 0.01, 0.02, 0.5):
        change = law.coefficient(v + step) - law.coefficient(max(v - step, 0.0))
        assert law.slope(v) == pytest.approx(change / (2 * step), abs=2e-3)
    assert [law.coefficient(v) for v in law.v] == pytest.approx(law.mu)
    at_zero = st.laws.Table(v=[0.0, 0.01], mu=[0.2, 0.1])
    assert at_zero.coefficient(0.0) == 0.2
    assert at_zero.slope(0.002) < 0.0


@pytest.mark.parametrize("V", [1e-30, 1e-9, 1e-6, 1.0])
@pytest.mark.parametrize("kind", [st.laws.RateStateAgeing, st.laws.RateStateSlip])
def test_rate_and_state(kind, V):
    """mu = a asinh[(V/2V*) exp(psi/a)]; theta' = 1 - x or -x ln x with x = V theta/D_c."""
    law, zeta, load = kind(**RATE), 1.3, 10.0
    psi = 0.6 + 0.015 * zeta
    x = log(V / 2e-6) + psi / 0.01
    mu = 0.01 * (asinh(exp(x)) if x < 300.0 else x + log(2.0))
    assert hypot(*law.force((0.6 * V, -0.8 * V), load, (zeta,))) == pytest.approx(mu * load)
    force = law.force((0.6 * V, -0.8 * V), load, (zeta,))
    assert force == pytest.approx((0.6 * mu * load, -0.8 * mu * load))
    assert law.grain((zeta,)) == pytest.approx(2e-6 * exp(-psi / 0.01))
    theta = 1e-5 / 1e-6 * exp(zeta)
    x = V * theta / 1e-5
    rate = (1 - x if kind is st.laws.RateStateAgeing else -x * log(x)) / theta
    assert law.change((0.0, V), load, (zeta,)) == pytest.approx((rate,), rel=1e-12)
    assert law.change((0.0, 0.0), load, (zeta,)) == (
        pytest.approx((1 / theta,)) if kind is st.laws.RateStateAgeing else (0.0,)
    )
    assert law.force((0.0, 0.0), load, (zeta,)) == (0.0, 0.0)


@pytest.mark.parametrize("kind", [st.laws.RateStateAgeing2, st.laws.RateStateSlip2])
def test_two_states_are_two_times_one(kind):
    """psi is their sum; each evolves over its own distance as if it were alone."""
    law, zeta, slip = kind(0.01, 0.012, 1e-5, 0.005, 1e-4, 0.6, 1e-6), (1.3, -0.4), (3e-6, 4e-6)
    psi = 0.6 + 0.012 * 1.3 - 0.005 * 0.4
    mu = 0.01 * asinh(5e-6 / 2e-6 * exp(psi / 0.01))
    assert law.force(slip, 10.0, zeta) == pytest.approx((6.0 * mu, 8.0 * mu))
    assert law.grain(zeta) == pytest.approx(2e-6 * exp(-psi / 0.01))
    one = st.laws.RateStateAgeing if kind is st.laws.RateStateAgeing2 else st.laws.RateStateSlip
    rates = [
        one(**RATE | {"D_c": D}).change(slip, 10.0, (z,))[0]
        for D, z in zip((1e-5, 1e-4), zeta, strict=True)
    ]
    assert law.change(slip, 10.0, zeta) == pytest.approx(rates)
    assert law.settled(3e-6) == pytest.approx((log(1 / 3),) * 2)
    steady = law.force((3e-6, 0.0), 10.0, law.settled(3e-6))[0] / 10.0
    assert law.coefficient(3e-6) == pytest.approx(steady)


@pytest.mark.parametrize("kind", [st.laws.RateStateAgeing, st.laws.RateStateSlip])
def test_steady_sliding_changes_no_state(kind):
    """V theta = D_c; at rest, sliding at 1e-12 m/s stands for it, and the state is that at V*."""
    law = kind(**RATE)
    for V in (1e-9, 3e-6, 1e-2):
        state = law.settled(V)
        assert state == pytest.approx((log(1e-6 / V),))
        assert law.change((V, 0.0), 10.0, state) == pytest.approx((0.0,), abs=1e-12 * V / 1e-5)
        assert law.coefficient(V) == pytest.approx(law.force((V, 0.0), 10.0, state)[0] / 10.0)
        assert law.coefficient(V) == pytest.approx(0.6 + (0.01 - 0.015) * log(V / 1e-6), abs=1e-6)
    assert law.settled(0.0) == (0.0,)
    assert law.coefficient(0.0) == law.coefficient(1e-12) != law.coefficient(2e-12)
    assert rs.SLOWEST == 1e-12


def test_the_hyperbolic_sine_of_large_arguments():
    for x in (-50.0, 0.0, 29.9, 30.0, 30.1, 300.0):
        assert rs.asinh_of_exp(x) == pytest.approx(asinh(exp(x)), rel=1e-15)
    assert rs.asinh_of_exp(1e4) == pytest.approx(1e4 + log(2.0))


def test_a_direct_effect_of_floats():
    """2 V* exp(-psi/a) must be one, for contacts of a hundred days: psi to mu* + 30 b."""
    least = (0.6 + 30 * 0.015) / 680
    assert st.laws.RateStateAgeing(**RATE | {"a": 1.001 * least})
    with pytest.raises(DescriptionError, match="at least"):
        st.laws.RateStateAgeing(**RATE | {"a": 0.999 * least})
    both = {"b_1": 0.01, "D_1": 1e-5, "b_2": 0.005, "D_2": 1e-4, "mu_star": 0.6, "V_star": 1e-6}
    assert st.laws.RateStateSlip2(1.001 * least, **both)
    with pytest.raises(DescriptionError, match="at least"):
        st.laws.RateStateSlip2(0.999 * least, **both)


def test_bristles():
    """F = sigma_0 z + sigma_1 dz/dt + sigma_2 s, dz/dt = s - sigma_0 |s| z/(W g(|s|)) (M63)."""
    (s, z), load = np.array([[3e-3, -4e-3], [1e-6, 2e-6]]), 10.0
    g = 0.15 + 0.05 * exp(-((5e-3 / 0.01) ** 2))
    rate = s - 1e5 * 5e-3 / (load * g) * z
    assert bending(LUGRE, *s, load) == pytest.approx(1e5 * 5e-3 / (load * g))
    assert LUGRE.change(tuple(s), load, tuple(z)) == pytest.approx(rate)
    force = 1e5 * z + 300.0 * rate + 2.0 * s
    assert LUGRE.force(tuple(s), load, tuple(z)) == pytest.approx(force)
    assert LUGRE.coefficient(5e-3) == pytest.approx(g)
    assert LUGRE.settled(1.0) == (0.0, 0.0)


# --- laws that are comparable -------------------------------------------------------------------


def test_laws_of_given_traits():
    """They have the coefficients, and 1 - 1/e of the change at the speed."""
    shared = Traits(0.3, 0.2, 0.02)
    for kind in (st.ExponentialWeakening, st.laws.Stribeck, st.laws.Table, st.laws.LuGre):
        law = like(kind, shared)
        assert law.coefficient(0.0) == pytest.approx(0.3)
        assert law.coefficient(10.0) == pytest.approx(0.2)
        assert law.coefficient(0.02) == pytest.approx(0.3 - 0.1 * CHANGED, rel=1e-3)
    dense = [like(st.laws.Table, shared).coefficient(v) for v in np.linspace(0.0, 0.2, 50)]
    wanted = [0.2 + 0.1 * exp(-v / 0.02) for v in np.linspace(0.0, 0.2, 50)]
    assert dense == pytest.approx(wanted, abs=1e-3)
    hyperbolic = like(st.laws.HyperbolicWeakening, shared)
    assert hyperbolic.coefficient(0.02) == pytest.approx(0.2 + 0.1 * exp(-1.0))
    assert hyperbolic.coefficient(1e9) == pytest.approx(0.2)
    assert hyperbolic.coefficient(0.0) == 0.3
    assert like(st.Coulomb, shared) == st.Coulomb(0.2, 0.3)
    assert like(st.Coulomb, Traits(0.2, 0.3, 0.02)) == st.Coulomb(0.2, 0.2)
    bristles = like(st.laws.LuGre, shared)
    assert (bristles.sigma_0, bristles.sigma_1) == pytest.approx((1e5, 1e5**0.5), rel=1e-3)


def test_of_friction_that_weakens_and_then_strengthens_the_minimum_counts():
    """The greatest change did: viscous friction made laws of 3.2 in slip for 1.3 at rest."""
    law = st.laws.Stribeck(1.3, 0.7, "0.5 mm/s", c="2 s/m")
    least = min(law.coefficient(float(v)) for v in np.geomspace(1e-4, 1.0, 4001))
    found = traits(law, 1.7e-3, 0.9)
    assert found.static == 1.3
    assert found.kinetic == pytest.approx(least, rel=1e-5)
    assert law.coefficient(found.speed) == pytest.approx(1.3 - CHANGED * (1.3 - least), rel=1e-3)
    only = traits(st.laws.Stribeck(0.7, 0.7, "0.5 mm/s", c="2 s/m"), 1.7e-3, 0.9)
    assert only.kinetic == pytest.approx(0.7 + 2.0 * 0.9)


@pytest.mark.parametrize("kind", [st.laws.RateStateAgeing, st.laws.RateStateSlip2])
def test_rate_and_state_laws_of_given_traits(kind):
    """`kinetic` at the speed, `static` at a ten-thousandth of it, b = 2 a."""
    law = like(kind, Traits(0.3, 0.2, 0.02))
    assert law.coefficient(0.02) == pytest.approx(0.2, rel=1e-3)
    assert law.coefficient(2e-6) == pytest.approx(0.3, rel=1e-3)
    b = law.b if kind is st.laws.RateStateAgeing else law.b_1 + law.b_2
    assert b == pytest.approx(2 * law.a)
    if kind is st.laws.RateStateSlip2:
        assert law.b_1 == law.b_2
        assert pytest.approx((1e-5, 1e-4)) == (law.D_1, law.D_2)
    else:
        assert law.D_c == pytest.approx(1e-5)
    strengthening = rs.comparable(0.2, 0.22, 0.02)
    assert strengthening.a == 0.01
    assert strengthening.b == pytest.approx(0.01 - 0.02 / log(1e4))
    assert rs.comparable(0.2, 0.9, 0.02).b == 0.0
    assert rs.comparable(0.2, 0.2, 0.02)[:2] == (0.01, 0.01)


def test_traits_of_a_law():
    found = traits(st.ExponentialWeakening(0.3, 0.2, 0.02), 1e-3, 1.0)
    assert found == pytest.approx((0.3, 0.2, 0.02), rel=1e-3)
    # within reach of slip, it has not fallen as far
    near = traits(st.ExponentialWeakening(0.3, 0.2, 0.02), 1e-3, 0.02)
    assert near.kinetic == pytest.approx(0.3 - 0.1 * CHANGED)
    # a minimum counts, wherever it lies
    dip = st.laws.Stribeck(0.3, 0.1, 0.01, 2.0, 0.5)
    assert traits(dip, 1e-3, 0.2).kinetic == pytest.approx(
        min(dip.coefficient(v) for v in np.geomspace(1e-3, 0.2, 4001)), rel=1e-4
    )
    assert traits(st.Coulomb(0.2), 1e-3, 1.0) == (0.2, 0.2, 1e-3)
    assert traits(st.Coulomb(0.2), 0.0, 1.0) == (0.2, 0.2, 1.0)
    assert traits(st.Coulomb(0.2, mu_static=0.3), 1e-3, 2.0) == pytest.approx((0.3, 0.2, 2e-3))
    ageing = st.laws.RateStateAgeing(**RATE)
    found = traits(ageing, 1e-3, 0.1)
    assert found.static == pytest.approx(ageing.coefficient(1e-6))
    assert found.kinetic == pytest.approx(ageing.coefficient(0.1))
    assert traits(ageing, 0.0, 0.1).static == pytest.approx(ageing.coefficient(1e-4))
    between = (log10(found.speed / 1e-6)) / 5  # linear in the logarithm
    assert between == pytest.approx(CHANGED, abs=1e-3)


class Broken(st.Coulomb):
    """A law whose coefficient is not finite at some speeds."""

    __slots__ = ()

    def coefficient(law, v):
        return nan if 0.01 < v < 0.02 else inf if v > 5.0 else 0.2


def test_traits_of_what_is_not_finite():
    with pytest.raises(DescriptionError, match="not finite between 1e-09 and 1 m/s"):
        traits(Broken(0.2), 1e-3, 1.0)
    assert traits(Broken(0.2), 1e-3, 0.005) == (0.2, 0.2, 1e-3)


def test_states_have_names_and_units():
    assert [(s.name, s.unit) for s in states(LUGRE)] == [("z_x", "m"), ("z_y", "m")]
    assert [s.name for s in states(st.laws.RateStateSlip(**RATE))] == ["log_theta"]
    assert states(st.Coulomb(0.2)) == ()


STATE_LAWS = [
    (st.laws.RateStateAgeing(**RATE), (1.3,)),
    (st.laws.RateStateSlip(**RATE), (1.3,)),
    (st.laws.RateStateAgeing2(0.01, 0.012, 1e-5, 0.005, 1e-4, 0.6, 1e-6), (1.3, -0.4)),
    (st.laws.RateStateSlip2(0.01, 0.012, 1e-5, 0.005, 1e-4, 0.6, 1e-6), (1.3, -0.4)),
    (LUGRE, (1e-6, 2e-6)),
]


@pytest.mark.parametrize(("law", "state"), STATE_LAWS)
@pytest.mark.parametrize("slip", [(3e-3, -4e-3), (-3e-38, 4e-38)])
def test_the_gradient_of_a_law_with_state(law, state, slip):
    """By differences of force and change in slip x, y and each state; also far below eps."""
    unit = hypot(*slip)
    steps = [1e-6 * unit] * 2 + [1e-6 * max(abs(z) for z in state)] * len(state)

    def at(x):
        return np.array(
            [*law.force((x[0], x[1]), 10.0, x[2:]), *law.change((x[0], x[1]), 10.0, x[2:])]
        )

    x, columns = np.array([*slip, *state]), []
    for i, h in enumerate(steps):
        off = h * np.eye(len(x))[i]
        columns.append((at(tuple(x + off)) - at(tuple(x - off))) / (2 * h))
    found, wanted = np.array(law.gradient(slip, 10.0, state)), np.transpose(columns)
    scale = np.abs(at(tuple(x)))[:, None] / np.array(steps) * 1e-9  # rounding
    assert (np.abs(found - wanted) < 1e-7 * np.abs(wanted) + scale + 1e-300).all()


def test_at_zero_slip_friction_is_linear_and_blind_to_the_state():
    """(M61): F = a W s/eps, whatever psi does."""
    stiff = 0.01 * 7.0 / rs.grain_of(0.01, 1e-6, 0.6)
    assert rs.friction_gradient(0.01, 1e-6, 0.6, (0.0, 0.0), 7.0) == (stiff, 0.0, stiff, 0.0, 0.0)
    tiny = 1e-6 * rs.grain_of(0.01, 1e-6, 0.6)
    found = rs.friction_gradient(0.01, 1e-6, 0.6, (0.0, tiny), 7.0)
    assert found == pytest.approx((stiff, 0.0, stiff, 0.0, 0.0), rel=1e-9, abs=1e-5 * 7.0)


def test_derivatives_at_zero_slip():
    """Bristles do not slip yet, and ln V of the slip law has no slope there."""
    law = st.laws.LuGre(0.15, 0.2, 1e-2, 1e5, 300.0, 0.4)
    assert bending_gradient(law, 0.0, 0.0, 10.0) == (0.0, 0.0)
    for D_c in (1e-5, 1e-12):
        slip_law = st.laws.RateStateSlip(0.01, 0.005, D_c, 0.6, 1e-6)
        assert slip_law.evolution_gradient(1.0, (0.0, 0.0), D_c) == (0.0, 0.0, 0.0)
        ageing = st.laws.RateStateAgeing(0.01, 0.005, D_c, 0.6, 1e-6)
        assert ageing.evolution_gradient(1.0, (0.0, 0.0), D_c)[:2] == (0.0, 0.0)


def test_two_exponentials_like_one_lie_about_its_speed():
    """Half of it is lost over a lesser speed, half over one that is as many times larger."""
    law = st.laws.TwoExponentials.like(0.3, 0.2, 0.01)
    assert law.coefficient(0.0) == pytest.approx(0.3)
    assert (law.mu_inf, law.mu_1, law.mu_2) == pytest.approx((0.2, 0.05, 0.05))
    assert law.v_1 < law.v_2
    assert law.v_1 * law.v_2 == pytest.approx(0.01**2)


def test_a_power_law_like_another_weakens_as_fast_at_rest():
    law = st.laws.PowerLawWeakening.like(0.3, 0.2, 0.01)
    assert (law.coefficient(0.0), law.slope(0.0)) == pytest.approx((0.3, -0.1 / 0.01))


def test_bristles_of_a_law_like_another_are_damped_critically_for_a_unit_mass():
    """LuGre's own numbers: sigma_1 = sqrt(sigma_0)."""
    for kind in (LuGreHyperbolic, st.laws.LuGre):
        law = kind.like(0.3, 0.2, 0.01)
        assert law.sigma_1 == pytest.approx(law.sigma_0**0.5)
