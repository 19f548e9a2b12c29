"""Any parameter of a description by its path, and the description with other values of some.

A path is a field of the slider (``phi``) or one of its drive's, friction law's or load's, of the
initial state or of the run's settings (``drive.velocity``, ``friction.mu_inf``,
``drive.along.amplitude``, ``load.program.1.to``, ``initial.u_x``, ``run.rtol``). Several that
share one value are joined by commas: ``k_x, k_y``.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import lru_cache
from math import radians
from typing import Any, cast, get_args, get_type_hints

from stiction.drive.pieces import LEVELS
from stiction.errors import DescriptionError, Fault
from stiction.friction import Anisotropic
from stiction.system.description import Description
from stiction.system.parameter import names
from stiction.text.units import Kind, to_si, unit_of
from stiction.text.validation import made, unknown

LEVEL_UNITS = {"drive": "m/s", "load": "N"}  # of pieces, which do not know their quantity


def unit(base: Description, path: str) -> str:
    """Return the unit of the numbers that a parameter is given in here: SI, and degrees.

    Raises
    ------
    DescriptionError
        If the description has no such parameter, or joined ones differ in unit.
    """
    found = {name: _unit(base, name) for name in names(path)}
    if len(set(found.values())) > 1:
        listed = ", ".join(f"{name} ({its or 'a number'})" for name, its in found.items())
        raise DescriptionError([Fault("", f"cannot share one value: {listed}")])
    return next(iter(found.values()))


def number(value: Any, unit: str) -> float:
    """Return a number or a string with its unit as a number in `unit`.

    Raises
    ------
    PydanticCustomError
        With the rule, the offending value and the remedy.
    """
    if unit == "deg" and not isinstance(value, str):
        return to_si(value, Kind("an angle", "rad", "1 deg"))  # says what to write instead
    return to_si(value, Kind("such a quantity", unit, f"1 {unit}".rstrip()))


def varied(base: Description, changes: Mapping[str, tuple[float, str]]) -> Description:
    """Return a description with other values of some parameters, all of it validated.

    Parameters
    ----------
    base : Description
        What is varied.
    changes : mapping of str to (float, str)
        For each path the value and its unit, as `unit` returns it.

    Raises
    ------
    DescriptionError
        With every parameter that cannot have its value.
    """
    tree: dict[str, Any] = {"slider": {}, "initial": {}, "run": {}}
    for path, (value, its) in changes.items():
        for name in names(path):
            *rooms, field = _keys(name)
            branch = tree
            for room in rooms:
                branch = branch.setdefault(room, {})
            branch[field] = f"{radians(value)!r} rad" if its == "deg" else value
    made_of = {room: _remade(getattr(base, room), tree[room]) for room in tree if tree[room]}
    return base._replace(**made_of)


def _hints(owner: Any) -> dict[str, Any]:
    return _hints_of(cast(Any, type(owner)))


@lru_cache(maxsize=256)
def _hints_of(kind: Any) -> dict[str, Any]:
    return get_type_hints(kind, include_extras=True)


def _keys(name: str) -> list[str]:
    keys = name.split(".")
    if keys[0] in ("initial", "run"):
        return keys
    return keys if keys[0] == "slider" else ["slider", *keys]


def _unit(base: Description, name: str) -> str:
    owner: Any = base
    *rooms, field = _keys(name)
    for room in rooms:
        owner = _member(owner, room, name)
    value = _member(owner, field, name)
    whole = isinstance(value, bool) or not (value is None or isinstance(value, int | float))
    hint = _hints(_holder(owner, field)).get(field)
    its = next((u for each in (hint, *get_args(hint)) if (u := unit_of(each))), "")
    if whole or (value is None and not its):
        message = f"{name} is not one number, it is {value!r}"
        raise DescriptionError([Fault("", message)])
    if not its and field in LEVELS:
        its = LEVEL_UNITS.get(rooms[1] if len(rooms) > 1 else "", "")
    return "deg" if its == "rad" else its


def _member(owner: Any, key: str, name: str) -> Any:
    """Return a part of a description by its key; a list's elements count from 1."""
    known = list(_fields(owner))
    if key not in known:
        raise DescriptionError([Fault("", unknown("parameter", key, known) + f" (in {name!r})")])
    return _part(_holder(owner, key), key)


def _fields(owner: Any) -> Iterable[str]:
    if isinstance(owner, Anisotropic):
        return [*owner.law._fields, "ratio", "angle"]
    if hasattr(owner, "_fields"):
        return tuple(owner._fields)
    if isinstance(owner, tuple):
        return [str(count) for count in range(1, len(owner) + 1)]
    return tuple(getattr(type(owner), "model_fields", ()))


def _holder(owner: Any, key: str) -> Any:
    """Return what has a field: of an anisotropic law, maybe the law that it holds."""
    return owner.law if isinstance(owner, Anisotropic) and key not in owner._fields else owner


def _remade(owner: Any, changes: Mapping[str, Any]) -> Any:
    """Return a part of a description with changes in it, read and checked anew."""
    if isinstance(owner, Anisotropic):
        inner = {key: value for key, value in changes.items() if key not in owner._fields}
        own = {key: value for key, value in changes.items() if key in owner._fields}
        law = _remade(owner.law, inner) if inner else owner.law
        return Anisotropic(**{**_given(owner), **own, "law": law})
    new = {
        key: _remade(_part(owner, key), value) if isinstance(value, Mapping) else value
        for key, value in changes.items()
    }
    if hasattr(owner, "replace"):
        return owner.replace(**new)
    if isinstance(owner, tuple) and not hasattr(owner, "_fields"):
        return [new.get(str(count), each) for count, each in enumerate(owner, 1)]
    if isinstance(owner, tuple):
        return made(type(owner), {**_given(owner), **new})
    return type(owner)(**{**_given(owner), **new})


def _part(owner: Any, key: str) -> Any:
    return owner[int(key) - 1] if key.isdigit() else getattr(owner, key)


def _given(owner: Any) -> dict[str, Any]:
    """Return what a part of a description was made of, as it is read: angles with their unit."""
    hints = _hints(owner)
    given = getattr(owner, "_fields", None) or owner.model_fields_set
    values = {name: getattr(owner, name) for name in given}
    angles = [name for name in given if unit_of(hints.get(name)) == "rad"]
    return {**values, **{name: f"{values[name]!r} rad" for name in angles}}
