"""Friction laws in the forms in which they are asked for, for one apparatus."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping, Sequence
from math import sqrt
from pathlib import Path
from typing import Any

import numpy as np

from stiction.errors import DescriptionError, Fault
from stiction.friction import LAWS, Law, has_state, read_law
from stiction.friction.equivalent import Traits, like, traits
from stiction.friction.law import static_coefficient
from stiction.friction.user.loading import named
from stiction.system.description import Description
from stiction.system.initial import Initial
from stiction.text.toml import read_toml
from stiction.text.validation import unknown

BRISTLES = 100.0  # of the stiffness along x, as Canudas de Wit et al. (1995) beside our 1 kN/m
MEMORY = 200.0  # in a slip length, as 10 µm in the 2 mm of Nakano & Popov
EXAMPLE = """'{law = "coulomb", mu_0 = 0.15}'"""


def exchanged(description: Description, law: Law) -> Description:
    """Return the same description with another friction law.

    Internal states at the start belong to the law that they were given for.
    """
    initial = description.initial
    if initial.states is not None and type(law) is not type(description.slider.law):
        initial = Initial(**initial.model_dump(exclude={"states"}, exclude_unset=True))
    slider = description.slider.replace(friction=law)
    return description._replace(slider=slider, initial=initial)


def read_laws(description: Description, laws: Sequence[Any]) -> list[Law]:
    """Return the laws that are meant; `stiction.compare` tells the forms."""
    made: list[Law] = []
    found: list[Fault] = []
    for count, value in enumerate(laws, 1):
        try:
            made.append(exchanged(description, read(description, value)).slider.law)
        except DescriptionError as error:
            where = f"law {value}" if value and isinstance(value, str | Path) else f"law {count}"
            found += [Fault(where, ": ".join(within(fault, str(value)))) for fault in error.faults]
    if found:
        raise DescriptionError(found)
    return made


def within(fault: Fault, text: str) -> Iterator[str]:
    """Yield where inside a law a fault is, unless it is the law or its file as a whole."""
    key = ".".join(fault.path.split(".")[1:])
    if key not in ("", "law", "friction") and fault.path != text:
        yield key
    yield fault.message


def read(description: Description, value: Any) -> Law:
    """Return the law that one entry of the list means."""
    if isinstance(value, Mapping):
        return read_law(dict(value))
    if not isinstance(value, str | Path):
        law: Law = value  # the slider says so if it is not one
        return law
    text = str(value).strip()
    if text.startswith("{"):
        return read_law(inline(text))
    if text.endswith(".toml"):
        return read_law(friction_table(text), named(Path(text).parent))
    if ":" in text:  # not from a file: the user says so
        return read_law({"law": text}, named(Path(), trust=True))
    if text in LAWS:
        return comparable(LAWS[text], description)
    other = f"(or a table {EXAMPLE}, a .toml file, file.py:Class)"
    raise DescriptionError([Fault("law", f"{unknown('law', text, LAWS)} {other}")])


def comparable(kind: Any, description: Description) -> Law:
    """Return the law of this kind that is like the description's own; that itself if it is one.

    What the coefficients do not say is in proportion to the apparatus: bristles are a hundred
    times as stiff as its soft spring, and critically damped; memory lasts for a two hundredth of
    the slip length, or for as long as that of the described law. For the apparatus of Nakano &
    Popov these are the published values of both laws.
    """
    slider = description.slider
    if isinstance(slider.law, kind):
        described: Law = slider.law
        return described
    made: Any = like(kind, shared_traits(description))
    known = slider.law._asdict() if hasattr(slider.law, "_asdict") else {}  # a class of one's own
    sigma_0, memory = BRISTLES * slider.k_x, slider.F_0 / slider.k_x / MEMORY
    own = {"sigma_0": sigma_0, "sigma_1": 2.0 * sqrt(sigma_0 * slider.mass)}
    own |= {"D_c": memory, "D_1": memory, "D_2": 10.0 * memory}
    chosen = {
        name: known.get(name, float(f"{value:.4g}"))
        for name, value in own.items()
        if name in kind._fields
    }
    suited: Law = made._replace(**chosen) if chosen else made
    return suited


def inline(text: str) -> dict[str, Any]:
    """Return the inline TOML table that a text holds."""
    try:
        table: dict[str, Any] = tomllib.loads(f"law = {text}")["law"]
    except (ValueError, RecursionError) as error:
        message = f"is not a TOML table: {error}; write for example {EXAMPLE}"
        raise DescriptionError([Fault("law", message)]) from None
    return table


def friction_table(path: str) -> dict[str, Any]:
    """Return the table [friction] of a file."""
    table = read_toml(path).get("friction")
    if not isinstance(table, dict):
        raise DescriptionError([Fault(path, "has no table [friction]; write one in it")])
    return table


def shared_traits(description: Description) -> Traits:
    """Return the traits of the description's own law, at the speeds of the apparatus.

    The fastest slip is that of the drive and of the mass that flies off its loaded spring.
    """
    slider, start = description.slider, description.initial.time
    times = np.linspace(start, start + description.run.duration, 513)
    drive = max(float(np.hypot(*slider.motion.rate(float(time)))) for time in times)
    law = slider.law
    mu = law.coefficient(drive or 1e-6) if has_state(law) else static_coefficient(law)
    free = mu * slider.normal_load / sqrt(slider.mass * min(slider.k_x, slider.k_y))
    return traits(law, drive, drive + free or 1.0)
