"""Friction laws: how large the friction force is, given the slip speed.

A law is a NamedTuple of floats with two methods, ``coefficient(law, v)`` and
``slope(law, v)``, in plain Python with `math`; the solver compiles them. A new law
is one file here and one line in `LAWS`.
"""

from __future__ import annotations

from typing import Any

from stiction.friction.coulomb import Coulomb
from stiction.friction.exponential_weakening import ExponentialWeakening
from stiction.friction.hyperbolic_weakening import HyperbolicWeakening
from stiction.friction.law import FrictionLaw, Internal, Law, StateLaw, has_state, states
from stiction.friction.stribeck import Stribeck
from stiction.friction.table import Table
from stiction.tables import choose

LAWS: dict[str, type[Any]] = {
    "coulomb": Coulomb,
    "exponential-weakening": ExponentialWeakening,
    "hyperbolic-weakening": HyperbolicWeakening,
    "stribeck": Stribeck,
    "table": Table,
}


def read_law(table: dict[str, Any]) -> Law:
    """Read a description's table [friction]."""
    law: Law = choose(table, "law", LAWS)
    return law


__all__ = [
    "LAWS",
    "Coulomb",
    "ExponentialWeakening",
    "FrictionLaw",
    "HyperbolicWeakening",
    "Internal",
    "Law",
    "StateLaw",
    "Stribeck",
    "Table",
    "has_state",
    "read_law",
    "states",
]
