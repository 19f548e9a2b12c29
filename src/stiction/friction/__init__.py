"""Friction laws: how large the friction force is, given the slip speed.

A law is a NamedTuple of floats with two methods, ``coefficient(law, v)`` and
``slope(law, v)``, in plain Python with `math`; the solver compiles them. A new law
is one file here and one line in `LAWS`.
"""

from __future__ import annotations

from typing import Any, cast

from stiction.errors import DescriptionError, Fault
from stiction.friction.anisotropic import Anisotropic
from stiction.friction.coulomb import Coulomb
from stiction.friction.exponential_weakening import ExponentialWeakening
from stiction.friction.law import FrictionLaw, Internal, Law, StateLaw, has_state, states
from stiction.tables import choose

LAWS: dict[str, type[Any]] = {
    "coulomb": Coulomb,
    "exponential-weakening": ExponentialWeakening,
}


def read_law(table: dict[str, Any]) -> Law:
    """Read a description's table [friction], with its table [friction.anisotropy] if any."""
    surface = table.pop("anisotropy", None)
    law: Law = choose(table, "law", LAWS)
    return law if surface is None else read_anisotropy(law, surface)


def name_of(law: Any) -> str:
    """Return a law's registered name, or that of a user's own class."""
    if isinstance(law, Anisotropic):
        return f"anisotropic {name_of(law.law)}"
    known = (name for name, kind in LAWS.items() if type(law) is kind)
    return next(known, type(law).__name__)


def parameters(law: Any) -> dict[str, Any]:
    """Return a law's parameters, those of an anisotropic one with the law's that it holds."""
    values: dict[str, Any] = law._asdict()
    if isinstance(law, Anisotropic):
        return parameters(values.pop("law")) | values
    return values


def read_anisotropy(law: Law, table: Any) -> Law:
    """Read the table [friction.anisotropy]."""
    if not isinstance(table, dict) or "law" in table:
        message = f"must be a table with ratio and angle, is {table!r}"
        raise DescriptionError([Fault("friction.anisotropy", message)])
    try:
        made: Any = Anisotropic(law, **table)
        return cast(Law, made)
    except DescriptionError as error:
        raise DescriptionError(
            [Fault(f"friction.anisotropy.{f.path.split('.')[-1]}", f.message) for f in error.faults]
        ) from None


__all__ = [
    "LAWS",
    "Anisotropic",
    "Coulomb",
    "ExponentialWeakening",
    "FrictionLaw",
    "Internal",
    "Law",
    "StateLaw",
    "has_state",
    "name_of",
    "parameters",
    "read_law",
    "states",
]
