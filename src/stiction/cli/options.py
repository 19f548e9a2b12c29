"""Options that several commands share: output, trust, and changed parameters."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Annotated, Any

from cyclopts import Parameter

from stiction.errors import StictionError

Output = Annotated[Path, Parameter(name=("--output", "-o"))]
MaybeOutput = Annotated[Path | None, Parameter(name=("--output", "-o"))]
Trust = Annotated[
    bool,
    Parameter(
        negative=(),
        help=(
            "Trust and run a user's friction law: the text in a result or a store, or a file "
            "outside the folder of CONFIG."
        ),
    ),
]
Changes = Annotated[
    list[str] | None,
    Parameter(
        name="--set",
        negative=(),
        help=(
            "Change a parameter of CONFIG, NAME=VALUE: --set phi=3deg "
            '--set "V = 2 mm/s" --set friction.mu_0=0.3 --set duration=10s; repeat it for more.'
        ),
    ),
]


def parse_assignment(text: str, option: str) -> tuple[str, str]:
    """Return name and value of an option's ``NAME=VALUE``."""
    name, equals, value = text.partition("=")
    if not equals or not name.strip():
        raise StictionError(f"{option} {text!r} is not NAME=VALUE; write for example 'phi = 1 deg'")
    return name.strip(), value.strip()


def changes(given: list[str] | None) -> dict[str, Any]:
    """Return the values of ``--set``: numbers, truth values and lists as in TOML."""
    pairs = (parse_assignment(text, "--set") for text in given or ())
    return {name: value(text) for name, text in pairs}


def value(text: str) -> Any:
    """Return a TOML value, or the text itself, such as a number with its unit."""
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except (ValueError, RecursionError):
        return text
