"""Friction laws: how large the friction force is, given the slip speed.

A law is a NamedTuple of floats with two methods, ``coefficient(law, v)`` and
``slope(law, v)``, in plain Python with `math`; the solver compiles them. A new law
is one file here and one line in `LAWS`; functions that its methods call go into `FUNCTIONS`.
A law whose friction depends on more than the slip velocity has internal states, see `StateLaw`.
"""

from __future__ import annotations

from typing import Any

from stiction.friction.coulomb import Coulomb
from stiction.friction.exponential_weakening import ExponentialWeakening
from stiction.friction.law import FrictionLaw, Internal, Law, StateLaw, has_state, states
from stiction.friction.lugre import LuGre, bending
from stiction.friction.rate_and_state import FUNCTIONS as _RATE_AND_STATE
from stiction.friction.rate_and_state_ageing import RateStateAgeing
from stiction.friction.rate_and_state_ageing_2 import RateStateAgeing2
from stiction.friction.rate_and_state_slip import RateStateSlip
from stiction.friction.rate_and_state_slip_2 import RateStateSlip2
from stiction.tables import choose

# plain functions that laws call, to be compiled with them
FUNCTIONS = (*_RATE_AND_STATE, bending)

LAWS: dict[str, type[Any]] = {
    "coulomb": Coulomb,
    "exponential-weakening": ExponentialWeakening,
    "lugre": LuGre,
    "rate-and-state-ageing": RateStateAgeing,
    "rate-and-state-ageing-2": RateStateAgeing2,
    "rate-and-state-slip": RateStateSlip,
    "rate-and-state-slip-2": RateStateSlip2,
}


def read_law(table: dict[str, Any]) -> Law:
    """Read a description's table [friction]."""
    law: Law = choose(table, "law", LAWS)
    return law


__all__ = [
    "FUNCTIONS",
    "LAWS",
    "Coulomb",
    "ExponentialWeakening",
    "FrictionLaw",
    "Internal",
    "Law",
    "LuGre",
    "RateStateAgeing",
    "RateStateAgeing2",
    "RateStateSlip",
    "RateStateSlip2",
    "StateLaw",
    "has_state",
    "read_law",
    "states",
]
