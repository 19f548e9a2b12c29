"""Friction laws: the friction force as a function of the slip velocity.

A law is a NamedTuple of floats with two methods, ``coefficient(law, v)`` and
``slope(law, v)``, in plain Python with `math`; the solver compiles them. A new law
is one file in `laws` and one line in `LAWS`; functions that its methods call go into `FUNCTIONS`.
A law whose friction depends on more than the slip velocity has internal states, see `StateLaw`.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from stiction.friction.law import FrictionLaw, Internal, Law, StateLaw, has_state, states
from stiction.friction.laws.anisotropic import Anisotropic, anisotropy_table, read_anisotropy
from stiction.friction.laws.coulomb import Coulomb
from stiction.friction.laws.exponential_weakening import ExponentialWeakening
from stiction.friction.laws.hyperbolic_weakening import HyperbolicWeakening
from stiction.friction.laws.lugre import LuGre, bending, bending_gradient
from stiction.friction.laws.rate_and_state import FUNCTIONS as _RATE_AND_STATE
from stiction.friction.laws.rate_and_state_one import RateStateAgeing, RateStateSlip
from stiction.friction.laws.rate_and_state_two import RateStateAgeing2, RateStateSlip2
from stiction.friction.laws.stribeck import Stribeck
from stiction.friction.laws.table import Table
from stiction.friction.user.loading import Find, is_own, named, own_table, read_own
from stiction.text.toml import choose

# plain functions that laws call, compiled with them
FUNCTIONS = (*_RATE_AND_STATE, bending, bending_gradient)

LAWS: dict[str, type[Any]] = {
    "coulomb": Coulomb,
    "exponential-weakening": ExponentialWeakening,
    "hyperbolic-weakening": HyperbolicWeakening,
    "stribeck": Stribeck,
    "table": Table,
    "lugre": LuGre,
    "rate-and-state-ageing": RateStateAgeing,
    "rate-and-state-ageing-2": RateStateAgeing2,
    "rate-and-state-slip": RateStateSlip,
    "rate-and-state-slip-2": RateStateSlip2,
}


def read_law(table: dict[str, Any], find: Find | None = None) -> Law:
    """Read the table [friction] of a description, including [friction.anisotropy].

    `find` locates a user's law.
    """
    surface, own = table.pop("anisotropy", None), is_own(table)
    law: Law = read_own(table, find or named(Path())) if own else choose(table, "law", LAWS)
    return law if surface is None else read_anisotropy(law, surface)


def law_table(law: Any) -> dict[str, Any]:
    """Return a law as a table [friction] of numbers and lists, which `read_law` reads."""
    if isinstance(law, Anisotropic):
        return {**law_table(law.law), "anisotropy": anisotropy_table(law)}
    name = registered_name(law)
    values = {  # NumPy numbers become Python numbers, for JSON
        key: value.tolist() if hasattr(value, "tolist") else value
        for key, value in law._asdict().items()
    }
    return {**(own_table(law) if name is None else {"law": name}), **values}


def name_of(law: Any) -> str:
    """Return a law's registered name, or the name of a user's class."""
    if isinstance(law, Anisotropic):
        return f"anisotropic {name_of(law.law)}"
    return registered_name(law) or type(law).__name__


def registered_name(law: Any) -> str | None:
    """Return the name in `LAWS`, None for a user's law."""
    return next((name for name, kind in LAWS.items() if kind is type(law)), None)


def parameters(law: Any) -> dict[str, Any]:
    """Return a law's parameters; for an anisotropic one, including those of its inner law."""
    values: dict[str, Any] = law._asdict()
    if isinstance(law, Anisotropic):
        return parameters(values.pop("law")) | values
    return values


__all__ = [
    "FUNCTIONS",
    "LAWS",
    "Anisotropic",
    "Coulomb",
    "ExponentialWeakening",
    "FrictionLaw",
    "HyperbolicWeakening",
    "Internal",
    "Law",
    "LuGre",
    "RateStateAgeing",
    "RateStateAgeing2",
    "RateStateSlip",
    "RateStateSlip2",
    "StateLaw",
    "Stribeck",
    "Table",
    "has_state",
    "law_table",
    "name_of",
    "parameters",
    "read_law",
    "states",
]
