"""Paths of parameters: through a description's tables, or as a short name.

``phi`` and ``slider.phi`` are the same, so are ``V`` and ``drive.velocity``; ``mu_0`` is a number
of the friction law, ``duration`` a setting of the run. Elements of a list count from 1, as in
``drive.program.2.duration``, or are known by their name, as in ``springs.load-cell.k_x``.
``friction.ratio`` and ``friction.anisotropy.ratio`` are the same where friction is anisotropic.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from copy import deepcopy
from typing import Any

from stiction.errors import Fault, echo
from stiction.text.validation import unknown_name

ALIASES = {
    "V": "drive.velocity",
    "velocity": "drive.velocity",
    "W": "normal_load",
    "m": "mass",
}
MECHANICAL = (
    *("mass", "mass_y", "mass_angle", "k_x", "k_y", "c_x", "c_y", "damping_angle"),
    *("phi", "normal_load", "driven", "cell_angle", "springs"),
)
SETTINGS = ("duration", "sample_rate", "rtol", "regularisation", "smoothing", "multiscale")
SURFACE = "friction.anisotropy"  # table whose parameters a law has beside its own
SURFACE_KEYS = ("ratio", "angle")
TABLES = ("slider", "friction", "drive", "load", "initial", "run", "study", "axes")


def canonical(name: str) -> str:
    """Resolve a parameter's short name, and drop a leading ``slider.``.

    >>> canonical("slider.phi"), canonical("V"), canonical("friction.anisotropy.ratio")
    ('phi', 'drive.velocity', 'friction.ratio')
    """
    bare = name.strip().removeprefix("slider.")
    table, _, key = bare.rpartition(".")
    return f"friction.{key}" if table == SURFACE else ALIASES.get(bare, bare)


def canonical_path(path: str) -> str:
    """Return a path, or several joined by commas, with short names resolved."""
    names = [name.strip() for name in path.split(",")]
    if not any(name in ALIASES for name in names):
        return path  # as written: stores are named after it
    return ", ".join(ALIASES.get(name, name) for name in names)


def last_part(path: str) -> str:
    """Return the last part of a path: ``mu_0`` of ``friction.mu_0``."""
    return path.rpartition(".")[2]


def short_names(paths: Iterable[str]) -> dict[str, str]:
    """Return a short name of each path: its last part, or all of it where several share that.

    >>> short_names(["friction.mu_0", "springs.arm.k_x", "springs.cell.k_x"]).values()
    dict_values(['mu_0', 'springs.arm.k_x', 'springs.cell.k_x'])
    """
    lasts = {path: last_part(path) for path in paths}
    often = Counter(lasts.values())
    return {path: path if often[last] > 1 else last for path, last in lasts.items()}


def with_changes(
    raw: Mapping[str, Any], changes: Mapping[str, Any]
) -> tuple[dict[str, Any], list[Fault]]:
    """Return a description's tables with other values of some parameters.

    Beside them stands a fault for every path that does not exist; the other values are changed.
    """
    tables, found = deepcopy(dict(raw)), []
    for name, value in changes.items():
        try:
            put(tables, keys_of(tables, name), value)
        except (KeyError, IndexError, TypeError) as error:
            found.append(Fault(name, str(error.args[0])))
    return tables, found


def keys_of(tables: Mapping[str, Any], name: str) -> list[str]:
    """Return the keys that lead to a parameter in a description, its table first."""
    bare = name.strip()
    keys = ALIASES.get(bare, bare).split(".")
    if len(keys) > 1 and keys[0] in TABLES:
        return of_surface(tables, keys)
    if keys[0] in MECHANICAL:
        return ["slider", *keys]
    if keys[0] in SETTINGS:
        return ["run", *keys]
    law = tables.get("friction")
    if isinstance(law, Mapping) and keys[0] in law:
        return ["friction", *keys]
    raise KeyError(unknown_name("parameter", name, parameter_names(tables)))


def of_surface(tables: Mapping[str, Any], keys: list[str]) -> list[str]:
    """Return the keys through [friction.anisotropy], where a law's own table lacks the parameter.

    >>> of_surface({"friction": {"law": "coulomb", "anisotropy": {}}}, ["friction", "ratio"])
    ['friction', 'anisotropy', 'ratio']
    """
    title, key = keys[0], keys[1]
    law = tables.get(title)
    if title != "friction" or key not in SURFACE_KEYS or not isinstance(law, Mapping):
        return keys
    return ["friction", "anisotropy", *keys[1:]] if "anisotropy" in law and key not in law else keys


def parameter_names(tables: Mapping[str, Any]) -> Iterator[str]:
    """Yield the names of all parameters of a description."""
    yield from (*ALIASES, *MECHANICAL, *SETTINGS)
    for title, table in tables.items():
        if isinstance(table, Mapping):
            yield from (f"{title}.{key}" for key in table)


def put(owner: Any, keys: list[str], value: Any) -> None:
    """Put a value where the keys lead; make missing tables."""
    key, rest = first(owner, keys)
    if rest:
        put(member(owner, key), rest, value)
    elif isinstance(owner, list):
        owner[index_in(owner, key)] = value
    elif isinstance(owner, dict):
        owner[key] = value
    else:
        raise TypeError(f"has no part {echo(key)}: it is {echo(owner)}")


def first(owner: Any, keys: list[str]) -> tuple[str, list[str]]:
    """Return the first key and the rest; an existing key may contain dots."""
    for count in range(len(keys), 1, -1):
        if isinstance(owner, dict) and (joined := ".".join(keys[:count])) in owner:
            return joined, keys[count:]
    return keys[0], keys[1:]


def member(owner: Any, key: str) -> Any:
    """Return a part of a table, made if missing, or an element of a list."""
    if isinstance(owner, list):
        return owner[index_in(owner, key)]
    if not isinstance(owner, dict):
        raise TypeError(f"has no part {echo(key)}: it is {echo(owner)}")
    return owner.setdefault(key, {})


def index_in(owner: list[Any], key: str) -> int:
    """Return the index of an element that is counted from 1, or known by its name."""
    names = [slug(each["name"]) for each in owner if isinstance(each, dict) and "name" in each]
    if key in names:
        return names.index(key)
    if not key.isdigit() or not 1 <= int(key) <= len(owner):
        known = f", known as {', '.join(names)}" if names else ""
        raise IndexError(
            f"{echo(key)} is not an element of a list of {len(owner)}; elements count from 1{known}"
        )
    return int(key) - 1


def slug(name: Any) -> str:
    """Return a name as it stands in a path.

    >>> slug("Load cell (z)")
    'load-cell-z'
    """
    return re.sub(r"[\W_]+", "-", str(name).lower()).strip("-")
