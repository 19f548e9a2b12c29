"""The contract of friction laws: registered laws keep it, and broken laws are found."""

import re
from math import e, exp, hypot
from pathlib import Path
from typing import NamedTuple

import pytest
import xarray as xr
from tests.drawn import inside

import stiction as st
from stiction.friction import LAWS, Internal, has_state, laws
from stiction.friction.law import static_coefficient
from stiction.testing import LawContract, check_law, checks_of

MEASURED = {"v": ["0 m/s", "5 mm/s", "20 mm/s", "0.1 m/s"], "mu": [0.2, 0.17, 0.16, 0.18]}

# each registered law, and others whose parameters change what it does
LAWS_TO_CHECK = [
    *(kind.like(0.2, 0.15, 0.01) for kind in LAWS.values()),
    st.ExponentialWeakening(mu_0=0.15, mu_inf=0.2, v_f=1e-4, mu_static=0.3),
    st.laws.Stribeck(mu_s=0.2, mu_c=0.15, v_s=0.01, c=0.5),
    st.laws.Stribeck(mu_s=0.2, mu_c=0.15, v_s=1e-5, d=1.0),
    st.laws.Stribeck(mu_s=0.2, mu_c=0.15, v_s=0.01, d=1.5, mu_static=0.22),
    st.laws.Table(**MEASURED),
    st.laws.Table(v=[0.001, 0.01], mu=[0.2, 0.1], mu_static=0.3),
]


@pytest.mark.parametrize("law", LAWS_TO_CHECK, ids=lambda law: type(law).__name__)
def test_a_registered_law_keeps_the_contract(law):
    check_law(law)


def test_a_law_is_registered_by_the_line_that_imports_it():
    folder = Path(laws.__file__).parent
    named = {
        name
        for path in folder.rglob("*.py")
        for name in re.findall(r'^@register\("([^"]+)"\)', path.read_text(), re.MULTILINE)
    }
    assert named == set(LAWS)


SET_VALUED = {name for name, kind in LAWS.items() if not has_state(kind.like(0.2, 0.15, 0.01))}


@pytest.mark.parametrize("name", sorted(SET_VALUED - {"power-law-weakening"}))
def test_a_comparable_law_has_the_friction_at_rest_and_in_fast_slip(name):
    """But for the one without a plateau."""
    for static, kinetic, speed in inside(20, (0.3, 0.9), (0.05, 0.25), (1e-4, 1.0)):
        law = LAWS[name].like(static, kinetic, speed)
        assert static_coefficient(law) == pytest.approx(static, rel=1e-12)
        assert law.coefficient(1e9 * speed) == pytest.approx(kinetic, rel=1e-8)


def test_hyperbolic_weakening_has_changed_at_the_speed_in_between():
    law = st.laws.HyperbolicWeakening.like(0.4, 0.3, 0.01)
    assert law.coefficient(0.01) == pytest.approx(0.3 + 0.1 / e, rel=1e-14)


# --- what each law says --------------------------------------------------------------------------


def test_a_table_goes_through_its_points_and_stays():
    law = st.laws.Table(**MEASURED)
    for v, mu in zip(law.v, law.mu, strict=True):
        assert law.coefficient(v) == pytest.approx(mu, rel=1e-15)
    assert law.coefficient(1e3) == law.coefficient(0.1) == 0.18
    assert law.slope(1e3) == law.slope(0.1) == 0.0
    between = [law.coefficient(0.005 + 0.00015 * i) for i in range(101)]
    assert between == sorted(between, reverse=True)  # monotone, no overshoot
    late = st.laws.Table(v=[0.001, 0.01], mu=[0.2, 0.1], mu_static=0.3)
    assert late.coefficient(0.0) == late.coefficient(0.001) == 0.2
    assert late.slope(0.0005) == 0.0


def test_stribeck_with_exponent_one_is_exponential_weakening(slider):
    exponential = st.ExponentialWeakening(mu_0=0.2, mu_inf=0.15, v_f=0.01)
    stribeck = st.laws.Stribeck(mu_s=0.2, mu_c=0.15, v_s=0.01, d=1)
    one, other = (
        st.simulate(slider.replace(friction=law), 0.05) for law in (exponential, stribeck)
    )
    # pow(x, 1) is x to the last bit; sums may be contracted otherwise, which stick-slip amplifies
    assert other.stick_intervals == pytest.approx(one.stick_intervals, rel=1e-9)


def test_a_dense_table_of_a_law_is_that_law(slider):
    """PCHIP through points h apart is off by some h^2 of the curvature where it bends most."""
    exponential = st.ExponentialWeakening(mu_0=0.2, mu_inf=0.15, v_f=0.01)
    speeds = [i * 2e-5 for i in range(5001)]
    table = st.laws.Table(v=speeds, mu=[exponential.coefficient(v) for v in speeds])
    one, other = (st.simulate(slider.replace(friction=law), 0.05) for law in (exponential, table))
    assert other.stick_intervals[0] == pytest.approx(one.stick_intervals[0], rel=1e-12)
    assert other.stick_intervals[:10] == pytest.approx(one.stick_intervals[:10], rel=1e-6)


@pytest.mark.parametrize(
    ("kind", "parameters", "path", "words"),
    [
        ("Table", {"v": [0, 1], "mu": [0.2]}, "mu", "a value for each v: 1 and 2"),
        ("Table", {"v": [0], "mu": [0.2]}, "v", "for a constant use 'coulomb'"),
        ("Table", {"v": [0, 2, 1], "mu": [0.2] * 3}, "v", "1 m/s follows 2 m/s; sort the points"),
        ("Table", {"v": "1 m/s", "mu": [0.2]}, "v", "write them in brackets"),
        ("Table", {"v": [0, "1 mm"], "mu": [0.2] * 2}, "v.2", "not a unit of a velocity"),
        ("Table", {"v": [0, 1], "mu": [0.2, -1]}, "mu.2", "must not be below 0, is -1"),
        ("Stribeck", {"mu_s": 0.2, "mu_c": 0.1, "v_s": 1, "d": 0.5}, "d", "between 1 and 10"),
        ("Stribeck", {"mu_s": 0.2, "mu_c": 0.1, "v_s": 1, "c": -1}, "c", "not be below 0"),
        ("HyperbolicWeakening", {"mu_0": 0.2, "v_h": 0}, "v_h", "greater than 0"),
        (
            "HyperbolicWeakening",
            {"mu_0": 0.2, "v_h": 1, "mu_static": 0.1},
            "mu_static",
            "must not be below the coefficient at vanishing slip speed, 0.2, is 0.1",
        ),
    ],
)
def test_a_law_refuses_what_makes_no_sense(kind, parameters, path, words):
    with pytest.raises(st.DescriptionError) as error:
        getattr(st.laws, kind)(**parameters)
    (fault,) = error.value.faults
    assert fault.path == f"{kind}.{path}"
    assert words in fault.message


def test_hyperbolic_weakening_cannot_be_like_what_strengthens():
    with pytest.raises(st.DescriptionError, match="compare it at a kinetic coefficient below"):
        st.laws.HyperbolicWeakening.like(0.15, 0.2, 0.01)


# --- the contract itself ------------------------------------------------------------------------


class Creeping(NamedTuple):
    """A law of one's own, as in a user's test."""

    mu: float

    def coefficient(law, v):
        return law.mu * (1.0 + 0.1 * exp(-v))

    def slope(law, v):
        return -0.1 * law.mu * exp(-v)


class TestCreeping(LawContract):
    law = Creeping(mu=0.2)


def test_a_contract_has_a_test_for_each_check():
    names = {name for name in dir(TestCreeping) if name.startswith("test_")}
    assert names == {f"test_{name}" for name in checks_of(TestCreeping.law)}


def test_a_broken_law_fails_the_test_of_its_kind():
    class Broken(LawContract):
        law = WrongSlope(0.2)

    with pytest.raises(AssertionError, match=r"let it return d\(coefficient\)/dv"):
        Broken().test_slope()
    Broken().test_finite()


class WrongSlope(Creeping):
    def slope(law, v):
        return -0.1001 * law.mu * exp(-v)


class WrongSlopeAtRest(Creeping):
    def slope(law, v):
        return -0.1 * law.mu * exp(-v) if v > 0.0 else 0.0


class NotANumber(Creeping):
    def coefficient(law, v):
        return law.mu * v / v if v > 0.0 else float("nan")


class Raising(Creeping):
    def coefficient(law, v):
        return law.mu / v


class Driving(Creeping):
    def coefficient(law, v):
        return law.mu - v

    def slope(law, v):
        return -1.0


class Uncompiled(Creeping):
    def coefficient(law, v):
        return helper(law, v)


def helper(law, v):
    return Creeping.coefficient(law, v)


class Dear(Creeping):
    def __reduce__(self):
        raise TypeError("not to be pickled")


@pytest.mark.parametrize(
    ("kind", "check", "words"),
    [
        (WrongSlope, "slope", r"is -0.02002 s/m, but the coefficient changes by -0.02\d* s/m"),
        (WrongSlopeAtRest, "slope", r"slope\(0\) is 0 s/m"),
        (NotANumber, "finite", r"coefficient\(0\) is nan"),
        (Raising, "finite", r"coefficient\(0\) raises ZeroDivisionError"),
        (Driving, "dissipative", r"coefficient\(0.316228\) must not be negative"),
        (Uncompiled, "compiled", r"numba\.njit"),
        (Dear, "kept", "not to be pickled"),
    ],
)
def test_the_contract_finds_what_is_broken(kind, check, words):
    law = kind(0.2)
    with pytest.raises(AssertionError, match=words):
        raise AssertionError("\n".join(checks_of(law)[check](law, speeds)))


speeds = LawContract.speeds


def test_every_fault_of_a_law_at_once():
    with pytest.raises(st.DescriptionError) as error:
        st.testing.check_law(Raising(0.2))
    assert {fault.path.split(".")[1] for fault in error.value.faults} >= {"finite", "simulated"}


# --- laws with state ----------------------------------------------------------------------------


class Bristle(NamedTuple):
    """Dahl (1968): friction is a spring of stiffness k per load that slips at mu."""

    mu: float
    k: float

    @staticmethod
    def states():
        return (Internal("z_x", "m", "bristle"), Internal("z_y", "m", "bristle"))

    def coefficient(law, v):
        return law.mu

    def settled(law, speed):
        return (0.0, 0.0)

    def force(law, slip, load, state):
        return (law.k * load * state[0], law.k * load * state[1])

    def change(law, slip, load, state):
        rate = hypot(slip[0], slip[1]) * law.k / law.mu
        return (slip[0] - rate * state[0], slip[1] - rate * state[1])


class Pushing(Bristle):
    def force(law, slip, load, state):
        return (-law.k * load * state[0], -law.k * load * state[1])


class Contradictory(Bristle):
    def coefficient(law, v):
        return 1.01 * law.mu


class Short(Bristle):
    def change(law, slip, load, state):
        return (slip[0],)


class Unsettled(Bristle):
    def settled(law, speed):
        return (1.0 / speed, 0.0)


STATE_CHECKS = ("finite", "dissipative", "compiled", "kept")  # what needs no solver


def test_a_law_with_state_keeps_the_contract():
    law = Bristle(0.2, 1e4)
    assert [f for name in STATE_CHECKS for f in checks_of(law)[name](law, speeds)] == []


@pytest.mark.parametrize(
    ("kind", "check", "words"),
    [
        (Pushing, "dissipative", "friction drives"),
        (Contradictory, "dissipative", "but coefficient says 0.202"),
        (Short, "finite", "has 1 components, must have 2"),
        (Unsettled, "finite", "settled(0) raises ZeroDivisionError"),
    ],
)
def test_the_contract_finds_a_broken_law_with_state(kind, check, words):
    law = kind(0.2, 1e4)
    assert words in "\n".join(checks_of(law)[check](law, speeds))


def test_laws_of_different_classes_differ():
    """They were equal, and had one hash, where their numbers are; so were their sliders."""
    ageing = st.laws.RateStateAgeing(0.01, 0.015, "1 um", 0.6, "1 um/s")
    slip = st.laws.RateStateSlip(*ageing)
    assert ageing != slip
    assert len({ageing, slip, ageing[:], st.laws.RateStateAgeing(*ageing)}) == 3
    assert st.Coulomb(0.2) != (0.2, 0.0)
    assert st.Coulomb(0.2) == st.Coulomb(0.2)
    assert st.laws.Anisotropic(Own(0.2), 1.5) != st.laws.Anisotropic(Other(0.2), 1.5)
    paper = st.presets.nakano_popov_2020()
    assert paper.replace(friction=Own(0.2)) != paper.replace(friction=Other(0.2))
    programs = [
        st.protocols.DriveProgram(velocity="1 mm/s", program=[kind("1 s")])
        for kind in (st.protocols.Hold, st.protocols.Reversal)
    ]
    assert programs[0] != programs[1]


class Own(NamedTuple):
    """A law that is not validated."""

    mu: float

    def coefficient(law, v):
        return law.mu

    def slope(law, v):
        return 0.0


class Other(NamedTuple):
    """Another one, with the same numbers."""

    mu: float

    def coefficient(law, v):
        return 0.5 * law.mu

    def slope(law, v):
        return 0.0


def test_a_table_and_an_axis_take_arrays_with_units():
    speeds = xr.DataArray([0.0, 5.0], dims="v", attrs={"units": "mm/s"})
    assert st.laws.Table(v=speeds, mu=[0.2, 0.1]) == st.laws.Table(v=[0.0, 5e-3], mu=[0.2, 0.1])
    assert st.Values(speeds).values == ("0.0 mm/s", "5.0 mm/s")
