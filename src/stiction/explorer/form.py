"""The form of a description: a field for each parameter, as the schema and the registries have it.

Nothing is listed here by name: a new law, a new piece of a program or a new parameter appears in
the page by itself.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from stiction.drive import DriveProgram, LoadProgram
from stiction.drive.pieces import DRIVE_PIECES, LEVELS, LOAD_PIECES, Modulation
from stiction.friction import LAWS, Anisotropic
from stiction.system.description import Settings
from stiction.system.initial import Initial
from stiction.system.parameter import LEVEL_UNITS
from stiction.system.schema import schema, table
from stiction.system.slider import Apparatus
from stiction.text.quantity.exact import PREFIXED
from stiction.text.units import hints_of, unit_of
from stiction.text.validation import fields as model_of

Field = dict[str, Any]


def form(own: Mapping[str, Any] = MappingProxyType({})) -> dict[str, Any]:
    """Return the fields of each table, of each law, and of each piece of a program.

    Parameters
    ----------
    own : mapping of str to type, optional
        Laws of the user, by their names.

    Examples
    --------
    >>> found = form()
    >>> found["tables"]["slider"][0]["key"], found["tables"]["slider"][0]["unit"]
    ('mass', 'kg')
    >>> "coulomb" in found["laws"], "ramp" in found["pieces"]["drive"]
    (True, True)
    """
    tables = schema()["properties"]
    laws: dict[str, Any] = {**LAWS, **own}
    parts = {name: table(model_of(kind), kind) for name, kind in own.items()}
    owners = {"slider": Apparatus, "drive": DriveProgram, "load": LoadProgram}
    owners |= {"initial": Initial, "run": Settings}
    return {
        "tables": {
            name: fields(tables[name], owner, LEVEL_UNITS.get(name, ""))
            for name, owner in owners.items()
        },
        "laws": {
            name: {"fields": fields(part, laws[name]), "meaning": first_line(laws[name])}
            for name, part in (choices(tables["friction"], "law") | parts).items()
        },
        "anisotropy": [
            field
            for field in fields(anisotropy(tables["friction"]), Anisotropic)
            if field["key"] != "law"
        ],
        "pieces": {
            name: {
                piece: fields(part, known[piece], LEVEL_UNITS[name])
                for piece, part in choices(
                    tables[name]["properties"]["program"]["items"], "piece"
                ).items()
            }
            for name, known in (("drive", DRIVE_PIECES), ("load", LOAD_PIECES))
        },
    }


def units() -> dict[str, list[tuple[str, float]]]:
    """Return the units in which a page writes values, and the size of each in SI, largest first.

    >>> units()["kg"][:4]
    [('Mt', 1000000000.0), ('kt', 1000000.0), ('t', 1000.0), ('kg', 1.0)]
    """
    return {
        unit: [(name.replace("u", "µ"), float(f"1e{power}")) for name, power in names.items()]
        for unit, names in PREFIXED.items()
    }


def choices(part: Mapping[str, Any], key: str) -> dict[str, Any]:
    """Return the schema of a table for each value of the key that decides about its others."""
    return {each["if"]["properties"][key]["const"]: each["then"] for each in part["allOf"]}


def anisotropy(friction: Mapping[str, Any]) -> Any:
    """Return the schema of the table [friction.anisotropy]."""
    return friction["allOf"][0]["then"]["properties"]["anisotropy"]


def first_line(kind: Any) -> str:
    """Return the first line of a docstring."""
    return str(kind.__doc__ or kind.__name__).strip().splitlines()[0]


def fields(table: Mapping[str, Any], owner: Any, level: str = "") -> list[Field]:
    """Return the fields of a table; `level` is the unit of the quantity that its program varies."""
    hints = hints_of(owner)
    found = []
    for key, part in table["properties"].items():
        if key in ("law", "piece", "anisotropy"):
            continue
        unit = unit_of(hints.get(key)) or (level if key in LEVELS else "")
        field: Field = {
            "key": key,
            "unit": unit,
            "kind": kind_of_field(part, key),
            "required": key in table.get("required", ()),
            "default": part.get("default"),
            "meaning": part.get("description", ""),
            **bounds(part),
        }
        if field["kind"] == "wave":
            field["fields"] = fields(part, Modulation, level)
        if "enum" in part:
            field["options"] = part["enum"]
        found.append(field)
    return found


def kind_of_field(part: Mapping[str, Any], key: str) -> str:
    """Return how a parameter is entered."""
    kinds = {each.get("type") for each in alternatives(part)}
    if "enum" in part:
        return "choice"
    if key == "program":
        return "program"
    if "amplitude" in part.get("properties", {}):
        return "wave"
    if any("properties" in each.get("items", {}) for each in alternatives(part)):
        return "tables"
    for kind in ("boolean", "integer", "array", "object"):
        if kind in kinds:
            return kind
    return "number"


def bounds(part: Mapping[str, Any]) -> dict[str, Any]:
    """Return the bounds of a number, and whether they themselves are excluded."""
    found: dict[str, Any] = {}
    for each in alternatives(part):
        for name, word in (("low", "inimum"), ("high", "aximum")):
            for closed, key in ((True, f"m{word}"), (False, f"exclusiveM{word}")):
                if key in each:
                    found |= {name: each[key], f"{name}_allowed": closed}
    return found


def alternatives(part: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    """Return a schema and all of its alternatives."""
    found = [part]
    for each in part.get("anyOf", ()):
        found += alternatives(each)
    return found
