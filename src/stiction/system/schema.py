"""The JSON schema of a description, for completion and checks in an editor.

It is derived from what reads descriptions: the fields of each table, the registry of laws, the
pieces of programs. Types, bounds and keys are in it, and the SI unit as a keyword of its own, which
validators pass over; rules between values are not.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from inspect import cleandoc
from typing import Any, cast

from pydantic.json_schema import GenerateJsonSchema
from pydantic_core.core_schema import BeforeValidatorFunctionSchema

from stiction.drive import DriveProgram, LoadProgram
from stiction.drive.pieces import DRIVE_PIECES, LEVELS, LOAD_PIECES, Modulation
from stiction.friction import LAWS, Anisotropic, has_state
from stiction.system.description import Settings
from stiction.system.initial import Initial
from stiction.system.slider import FROM_SPRINGS, Apparatus, Slider
from stiction.system.springs import COMPLIANCES, STIFFNESSES, Spring
from stiction.text.units import FORCE, VELOCITY, Kind
from stiction.text.validation import Described, fields

NUMBER = r"^\s*[+−-]?(\d+\.?\d*|\.\d+)([eE][+−-]?\d+)?"
WITH_UNIT = NUMBER + r"(?![\d.,eE])\s*[^\s.,]"
# a parameter of a docstring, or several, and what it says of them
MEANING = re.compile(r"^(\w+(?:, \w+)*) : .*\n((?: {4}.*\n?)+)", re.MULTILINE)
# constraints that the library puts beside a choice, where they are none of JSON schema
BOUNDS = {"gt": "exclusiveMinimum", "ge": "minimum", "lt": "exclusiveMaximum", "le": "maximum"}
Schema = dict[str, Any]


def schema() -> Schema:
    """Return the JSON schema (draft 7) of a description.

    >>> sorted(schema()["properties"])
    ['drive', 'friction', 'initial', 'load', 'run', 'slider']
    """
    tables = {
        "slider": slider(),
        "friction": friction(),
        "drive": program(DriveProgram, DRIVE_PIECES, VELOCITY, ("along", "across")),
        "load": program(LoadProgram, LOAD_PIECES, FORCE, ("modulation",)),
        "initial": table(Initial),
        "run": table(Settings) | {"required": []},
    }
    return {
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": "A description of stiction",
        "type": "object",
        "properties": tables,
        "required": ["slider", "friction", "drive"],
        "additionalProperties": False,
        "anyOf": [  # a program may end, and the run with it
            {"required": ["run"], "properties": {"run": {"required": ["duration"]}}},
            *(
                {"required": [name], "properties": {name: {"required": ["program"]}}}
                for name in ("drive", "load")
            ),
        ],
    }


class Generator(GenerateJsonSchema):
    """Writes quantities as numbers or as texts with a unit."""

    def function_before_schema(self, schema: BeforeValidatorFunctionSchema) -> Schema:
        """Return the schema of a field that is read by a function of ours."""
        number = super().function_before_schema(schema)
        keywords = getattr(schema["function"]["function"], "keywords", {})
        kind, words = keywords.get("kind"), keywords.get("words", ())
        return number if kind is None else quantity(number, kind, words)


def quantity(number: Schema, kind: Kind, words: Iterable[str] = ()) -> Schema:
    """Return the schema of a quantity: a number in SI, except for angles, or a text, or a word."""
    text = {"type": "string", "pattern": WITH_UNIT if kind.unit else rf"{NUMBER}\s*$"}
    text |= {"unit": "deg or rad" if kind.unit == "rad" else kind.unit} if kind.unit else {}
    if kind.unit == "rad":
        return text
    return {"anyOf": [number, text, *({"const": word} for word in words)]}


def table(model: type[Described], told: Any = None, without: Iterable[str] = ()) -> Schema:
    """Return the schema of a table, with its docstring's text on each key, which editors show."""
    found = place_bounds(model.model_json_schema(schema_generator=Generator))
    meanings = {
        name: " ".join(text.split())
        for names, text in MEANING.findall(cleandoc(str((told or model).__doc__)) + "\n")
        for name in names.split(", ")
    }
    keys: dict[str, Schema] = {
        name: {**key, "description": meanings.get(name, key.get("title", name))}
        for name, key in found["properties"].items()
        if name not in without
    }
    required = [name for name in found.get("required", ()) if name not in without]
    return {
        "type": "object",
        "properties": keys,
        "required": required,
        "additionalProperties": False,
    }


def place_bounds(part: Any, bounds: Mapping[str, float] | None = None) -> Any:
    """Return a part of a schema, the bounds of choices put where their numbers are."""
    if isinstance(part, list):
        return [place_bounds(each, bounds) for each in part]
    if not isinstance(part, dict):
        return part
    inner = dict(bounds or {}) | {BOUNDS[key]: part[key] for key in BOUNDS if key in part}
    found = {key: place_bounds(each, inner) for key, each in part.items() if key not in BOUNDS}
    return found | inner if part.get("type") == "number" else found


def schema_by_choice(key: str, kinds: Mapping[str, Schema], other: Schema | None = None) -> Schema:
    """Return the schema of a table whose other keys depend on the value of one."""
    for name, each in kinds.items():
        each["properties"][key] = {"const": name}
    names: list[Schema] = [{"enum": [*kinds]}, *([other] if other else [])]
    return {
        "type": "object",
        "properties": {key: {"anyOf": names}},
        "required": [key],
        "allOf": [
            {"if": {"properties": {key: {"const": name}}, "required": [key]}, "then": each}
            for name, each in kinds.items()
        ],
    }


def slider() -> Schema:
    """Return the schema of the table [slider], with one spring or several in series."""
    found = table(Apparatus, Slider)
    found["properties"]["springs"]["items"] = spring()
    found["required"] = [name for name in found["required"] if name not in FROM_SPRINGS]
    series: Schema = {**dict.fromkeys(FROM_SPRINGS, False), "springs": {"minItems": 1}}
    found["anyOf"] = [
        {"required": [*FROM_SPRINGS], "properties": {"springs": {"maxItems": 0}}},
        {"required": ["springs"], "properties": series},
    ]
    return found


def spring() -> Schema:
    """Return the schema of a spring in series, which has a stiffness or a compliance an axis."""
    found = table(fields(Spring), Spring)
    found["allOf"] = [
        {"oneOf": [{"required": [name]} for name in either]}
        for either in zip(STIFFNESSES, COMPLIANCES, strict=True)
    ]
    return found


def friction() -> Schema:
    """Return the schema of the table [friction]; of a user's law, any parameters."""
    laws = {name: table(fields(cast(Any, kind)), kind) for name, kind in LAWS.items()}
    for name in (each for each, kind in LAWS.items() if not has_state(kind)):
        laws[name]["properties"]["anisotropy"] = table(fields(Anisotropic), Anisotropic, ["law"])
    return schema_by_choice("law", laws, {"type": "string", "pattern": ":"})


def program(
    model: type[Described], pieces: Mapping[str, Any], kind: Kind, waves: Iterable[str]
) -> Schema:
    """Return the schema of a program of drive or load."""
    found = table(model)
    of = {
        name: schema_of_levels(table(fields(piece), piece), kind) for name, piece in pieces.items()
    }
    of["recorded"]["required"] = []  # a file may have them
    of["recorded"]["properties"]["checksum"] = {
        "type": "string",
        "description": "Of the rows, as `to_toml` writes it: others are refused.",
    }
    found["properties"]["program"]["items"] = schema_by_choice("piece", of)
    for wave in waves:
        found["properties"][wave] = schema_of_levels(table(fields(Modulation), Modulation), kind)
    return found


def schema_of_levels(piece: Schema, kind: Kind) -> Schema:
    """Return the schema of a piece whose levels are of a quantity."""
    for name in LEVELS:
        if name in piece["properties"]:
            piece["properties"][name] |= quantity({"type": "number"}, kind)
    return piece
