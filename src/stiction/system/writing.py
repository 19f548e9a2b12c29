"""From a slider to the tables of a description, with readable units."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

from stiction.drive import ConstantVelocity
from stiction.drive.pieces import DRIVE_PIECES, LEVELS, LOAD_PIECES
from stiction.drive.recorded.piece import RECORDS
from stiction.drive.recorded.reading import checksum
from stiction.friction import Anisotropic, law_table
from stiction.text.quantity.exact import quantity_text
from stiction.text.sections import Table
from stiction.text.units import FORCE, VELOCITY, Kind, hints_of, kind_of

if TYPE_CHECKING:
    from stiction.system.slider import Slider

TomlTable = dict[str, Any]
LONGEST_LIST = 100  # numbers of a list that are shown


def slider_tables(slider: Slider) -> dict[str, TomlTable]:
    """Return the tables [slider], [friction], [drive] and [load] of a description."""
    parts = {"friction", "drive", "load"}
    mechanical = [name for name in slider.own_fields() if name not in parts]
    springs = {"springs": [_describe_tuple(each) for each in slider.springs]}
    return {
        "slider": describe(slider, mechanical) | (springs if slider.springs else {}),
        "friction": _law(slider.law),
        "drive": _drive(slider.drive),
        **({} if slider.load is None else {"load": _program(slider.load, LOAD_PIECES, FORCE)}),
    }


def parameter_table(tables: Mapping[str, TomlTable]) -> Table:
    """Return the parameters of all tables of a description as rows of path and text."""
    rows = [
        (f"{name}.{key}", in_plain(value))
        for name, table in tables.items()
        for key, value in table.items()
    ]
    return Table(("parameter", "value"), rows)


def in_plain(value: Any) -> str:
    """Return a value of a description without brackets, and the length of a long list of numbers.

    >>> in_plain([{"piece": "hold", "duration": "1 s"}, {"piece": "free"}])
    'piece = hold, duration = 1 s; piece = free'
    """
    if isinstance(value, Mapping):
        return ", ".join(f"{name} = {in_plain(each)}" for name, each in value.items())
    if not isinstance(value, list | tuple):
        return str(value)
    tables = any(isinstance(each, Mapping) for each in value)
    if len(value) > LONGEST_LIST and not tables:
        return f"{len(value)} values"
    return ("; " if tables else ", ").join(map(in_plain, value))


def describe(value: Any, names: Iterable[str]) -> TomlTable:
    """Return the fields of a description that differ from their defaults, with units."""
    fields, hints = type(value).model_fields, hints_of(type(value))
    return {
        name: _write(getattr(value, name), kind_of(hints[name]))
        for name in names
        if fields[name].is_required() or getattr(value, name) != fields[name].default
    }


def _write(value: Any, kind: Kind | None) -> Any:
    """Return a value with its unit, if it has one."""
    value = value.tolist() if hasattr(value, "tolist") else value  # a number of NumPy
    if kind is not None and kind.unit and isinstance(value, float):
        return quantity_text(value, kind.unit)
    return value


def _describe_tuple(value: Any) -> TomlTable:
    """Return the fields of a NamedTuple that differ from their defaults, with units."""
    hints, defaults = hints_of(type(value)), value._field_defaults
    return {
        name: _write(its, kind_of(hints.get(name)))
        for name, its in value._asdict().items()
        if name not in defaults or its != defaults[name]
    }


def _law(law: Any) -> TomlTable:
    if isinstance(law, Anisotropic):
        surface = {name: each for name, each in _describe_tuple(law).items() if name != "law"}
        return {**_law(law.law), "anisotropy": surface}
    return {"law": law_table(law)["law"], **_describe_tuple(law)}


def _drive(drive: Any) -> TomlTable:
    if isinstance(drive, ConstantVelocity):
        return _describe_tuple(drive)
    return _program(drive, DRIVE_PIECES, VELOCITY)


def _program(program: Any, known: Mapping[str, type[Any]], kind: Kind) -> TomlTable:
    names = {each: name for name, each in known.items()}
    table = describe(program, type(program).model_fields)
    for name, value in table.items():
        if name == "program":
            table[name] = [{"piece": names[type(each)], **_piece(each, kind)} for each in value]
        elif hasattr(value, "_asdict"):
            table[name] = _piece(value, kind)
    return table


def _piece(piece: Any, kind: Kind) -> TomlTable:
    """Return the parameters of a piece, whose levels have the unit of `kind`."""
    return {
        name: _write(value, kind) if name in LEVELS else value
        for name, value in _describe_tuple(piece).items()
    } | ({"checksum": checksum(piece._asdict())} if isinstance(piece, RECORDS) else {})
