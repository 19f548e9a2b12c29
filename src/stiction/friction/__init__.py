"""Friction laws: the friction force as a function of the slip velocity.

A law is a NamedTuple of floats with two methods, ``coefficient(law, v)`` and
``slope(law, v)``, in plain Python with `math`; the solver compiles them. A new law
is one file in `friction.laws` and the line there that imports it.
A law whose friction depends on more than the slip velocity has internal states, see `StateLaw`.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from stiction.errors import Faults
from stiction.friction.law import FrictionLaw as FrictionLaw
from stiction.friction.law import Internal as Internal
from stiction.friction.law import Law as Law
from stiction.friction.law import StateLaw as StateLaw
from stiction.friction.law import has_state as has_state
from stiction.friction.law import states as states
from stiction.friction.laws import Anisotropic as Anisotropic
from stiction.friction.laws.anisotropic import anisotropy_table, read_anisotropy
from stiction.friction.laws.anisotropic import ellipse as ellipse
from stiction.friction.registry import FUNCTIONS as FUNCTIONS
from stiction.friction.registry import LAWS as LAWS
from stiction.friction.registry import METHODS as METHODS
from stiction.friction.user.loading import (
    Find,
    finder_for_descriptions,
    is_own,
    own_table,
    read_own,
)
from stiction.text.toml import choose
from stiction.text.units import hints_of, unit_of

STAND_IN: Law = LAWS["coulomb"](mu_0=0.0)  # for one that cannot be read


def read_law(table: dict[str, Any], find: Find | None = None) -> Law:
    """Read the table [friction] of a description, including [friction.anisotropy].

    `find` locates a user's law.
    """
    surface, own = table.pop("anisotropy", None), is_own(table)
    faults, law = Faults(), STAND_IN
    if own and surface is not None:
        read_anisotropy(STAND_IN, surface)  # before the law's file is run
    with faults.of_part():
        law = (
            read_own(table, find or finder_for_descriptions(Path()))
            if own
            else choose(table, "law", LAWS)
        )
    if surface is not None:
        with faults.of_part():
            law = read_anisotropy(law, surface)
    faults.refuse()
    return law


def law_table(law: Any) -> dict[str, Any]:
    """Return a law as a table [friction] of numbers and lists, which `read_law` reads."""
    if isinstance(law, Anisotropic):
        return {**law_table(law.law), "anisotropy": anisotropy_table(law)}
    name, hints = registered_name(law), hints_of(type(law))
    values = {  # NumPy numbers become Python numbers, for JSON
        key: value.tolist() if hasattr(value, "tolist") else value
        for key, value in law._asdict().items()
    }
    angles = [key for key in values if unit_of(hints.get(key)) == "rad"]
    values |= {key: f"{values[key]!r} rad" for key in angles}  # a number is refused
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
