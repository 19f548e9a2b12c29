"""Friction laws: how large the friction force is, given the slip speed.

A law is a NamedTuple of floats with two methods, ``coefficient(law, v)`` and
``slope(law, v)``, in plain Python with `math`; the solver compiles them. A new law
is one file here and one line in `LAWS`.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from stiction.friction.coulomb import Coulomb
from stiction.friction.exponential_weakening import ExponentialWeakening
from stiction.friction.hyperbolic_weakening import HyperbolicWeakening
from stiction.friction.law import FrictionLaw, Internal, Law, StateLaw, has_state, states
from stiction.friction.own import Find, named, own_table, read_own
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


def read_law(table: dict[str, Any], find: Find | None = None) -> Law:
    """Read a description's table [friction]; `find` finds a law of the user's own."""
    name = table.get("law")
    own = isinstance(name, str) and ":" in name
    law: Law = read_own(table, find or named(Path())) if own else choose(table, "law", LAWS)
    return law


def law_table(law: Law) -> dict[str, Any]:
    """Return a law as a table [friction] that can be read back, of numbers and lists."""
    name = next((name for name, kind in LAWS.items() if kind is type(law)), None)
    values = {  # numbers of NumPy as Python's, which JSON knows
        key: value.tolist() if hasattr(value, "tolist") else value
        for key, value in law._asdict().items()
    }
    return {**(own_table(law) if name is None else {"law": name}), **values}


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
    "law_table",
    "read_law",
    "states",
]
