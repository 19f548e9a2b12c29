"""The contract of friction laws: what is registered keeps it, what is broken does not."""

from math import exp, hypot
from typing import NamedTuple

import pytest

import stiction as st
from stiction.friction import LAWS, Internal
from stiction.testing import LawContract, check_law, checks_of

MEASURED = {"v": ["0 m/s", "5 mm/s", "20 mm/s", "0.1 m/s"], "mu": [0.2, 0.17, 0.16, 0.18]}

# a line for each registered law, with other lines for what its parameters can change
LAWS_TO_CHECK = [
    st.Coulomb(mu_0=0.2, mu_static=0.25),
    st.ExponentialWeakening(mu_0=0.2, mu_inf=0.15, v_f=0.01),
    st.ExponentialWeakening(mu_0=0.15, mu_inf=0.2, v_f=1e-4, mu_static=0.3),
    st.HyperbolicWeakening(mu_0=0.2, v_h=0.05),
    st.Stribeck(mu_s=0.2, mu_c=0.15, v_s=0.01, c=0.5),
    st.Stribeck(mu_s=0.2, mu_c=0.15, v_s=1e-5, d=1.0),
    st.Stribeck(mu_s=0.2, mu_c=0.15, v_s=0.01, d=1.5, mu_static=0.22),
    st.Table(**MEASURED),
    st.Table(v=[0.001, 0.01], mu=[0.2, 0.1], mu_static=0.3),
]


@pytest.mark.parametrize("law", LAWS_TO_CHECK, ids=lambda law: type(law).__name__)
def test_a_registered_law_keeps_the_contract(law):
    check_law(law)


def test_every_registered_law_is_checked():
    assert {type(law) for law in LAWS_TO_CHECK} == set(LAWS.values())


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
        (WrongSlope, "slope", "is -0.02002 s/m, but the coefficient changes by -0.02 s/m"),
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
        st.check_law(Raising(0.2))
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
