"""The user's statements about a file: arguments first, then the small TOML beside it."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal, NamedTuple, TypeVar

from pydantic import BeforeValidator, Field, ValidatorFunctionWrapHandler, WrapValidator

from stiction.errors import DescriptionError, Fault, echo
from stiction.formats.channels import CHANNELS
from stiction.recording.sensor import Sensor
from stiction.storage.files import without_compression
from stiction.text.toml import read_toml
from stiction.text.units import (
    LENGTH,
    Angle,
    Duration,
    Force,
    Mass,
    PositiveSpeed,
    Read,
    Stiffness,
    Whole,
    fault,
    hints_of,
    reader,
    split_uncertain,
    to_si,
    unit_of,
)
from stiction.text.validation import Described, unknown_name

T = TypeVar("T", bound=Described)
SECTIONS = ("columns", "reading", "record", "sensors")
MARKS = {"tab": "\t", "comma": ",", "semicolon": ";", "space": " ", "bar": "|"}
SIGNS = {"point": ".", "comma": ","}
WHOLE = "none"  # a displacement that does not start again
Instant = Annotated[Read[float], reader("a time", "s", "2 s")]
SignedForce = Annotated[Read[float], reader("a force", "N", "3 mN")]


def _wrap(value: object) -> object:
    """Return a length, or 0 where a displacement does not start again."""
    if value is None or value == WHOLE:
        return 0.0 if value == WHOLE else None
    length = to_si(value, LENGTH)
    if length <= 0.0:
        raise fault(f"must be greater than 0, is {echo(value)}; or write {WHOLE!r}")
    return length


class KnownApparatus(Described):
    """The known apparatus; its fields are a record's."""

    normal_load: Force | None = None
    stiffness: Stiffness | None = None
    stiffness_across: Stiffness | None = None
    drive_velocity: PositiveSpeed | None = None
    mass: Mass | None = None
    zero: SignedForce | None = None
    turned: Angle | None = None


# its fields and their units
KNOWN = {name: unit_of(hints_of(KnownApparatus)[name]) for name in KnownApparatus.model_fields}


def _column(value: object) -> str:
    """Return the statement on a column as text: its number may be an integer."""
    if isinstance(value, bool) or not isinstance(value, int | str):
        raise fault(f"{echo(value)} is not a column; write its name, its number, or its unit: 'mN'")
    return str(value)


Column = Annotated[Read[str], BeforeValidator(_column)]


def _or_all(value: Any, whole: ValidatorFunctionWrapHandler) -> Any:
    """Return "all", or a whole number."""
    return value if value == "all" else whole(value)


class AskedPart(NamedTuple):
    """The part of a record that is asked for: between two times, s, and of that a stroke."""

    begin: float | None = None
    end: float | None = None
    stroke: int | str | None = None


class ReadingOptions(Described):
    """How to read a file, as far as the user says so.

    Parameters
    ----------
    time, force, force_across, load, position, drive_position, slip_speed : str or int, optional
        The column of a channel by name or number, its unit, or both: ``"Fx"``, 3, ``"mN"``,
        ``"Fx=mN"``, ``"3=mN"``.
        A number multiplies the unit: ``"-1 N"`` turns the sign, ``"CH1=2.5 N/V"`` scales volts.
    interval : float or str, optional
        Between two samples, s, for a file without times.
    times : {"clock", "intervals"}, optional
        Whether the time column holds times, or the interval before each sample.
    decimal : {"point", "comma"}, optional
        Decimal sign of a text file.
    separator : {"tab", "comma", "semicolon", "space", "bar"}, optional
        Between the columns of a text file.
    wrap : float or str, optional
        The length after which a displacement starts again, m, or ``"none"``.
    block : int, optional
        Which of several blocks, counted from 1: a block begins where the times begin again.
    stroke : int, optional
        Which stroke of a drive that goes to and fro, counted from 1, or ``"all"``, a record each.
    begin, end : float or str, optional
        Of the part that is read, s, in the times of the file; by default all.
    """

    time: Column | None = None
    force: Column | None = None
    force_across: Column | None = None
    load: Column | None = None
    position: Column | None = None
    drive_position: Column | None = None
    slip_speed: Column | None = None
    interval: Duration | None = None
    times: Literal["clock", "intervals"] | None = None
    decimal: Literal["point", "comma"] | None = None
    separator: Literal["tab", "comma", "semicolon", "space", "bar"] | None = None
    wrap: Annotated[Read[float] | None, BeforeValidator(_wrap)] = None
    block: Annotated[Whole, Field(ge=1)] | None = None
    stroke: Annotated[Whole, Field(ge=1), WrapValidator(_or_all)] | None = None
    begin: Instant | None = None
    end: Instant | None = None

    @property
    def part(self) -> AskedPart:
        """The statements on the part of the record."""
        return AskedPart(self.begin, self.end, self.stroke)

    @property
    def columns(self) -> dict[str, str]:
        """The statements on each channel."""
        said = {name: getattr(self, name) for name in CHANNELS}
        return {name: text for name, text in said.items() if text is not None}


class Request(NamedTuple):
    """All statements about a file: how to read it, numbers of the apparatus, sensors.

    `rig_load` (N) is that of the description of a rig, whose record a file is; NaN if that states
    none, or none for certain.
    """

    reading: ReadingOptions
    known: dict[str, Any]
    sensors: dict[str, Sensor]
    beside: Path | None = None
    rig_load: float | None = None


def request(path: Path, given: Mapping[str, Any], sidecar: Path | None) -> Request:
    """Return the statements of arguments about a file, completed by a TOML file beside it.

    ``data.toml`` belongs to ``data.csv``, unless it describes a rig, with a table [slider].

    Raises
    ------
    DescriptionError
        With every fault of both.
    """
    said = {name: value for name, value in given.items() if value is not None}
    own = _beside(path) if sidecar is None else sidecar
    tables = {} if own is None else _tables(own)
    sensors = tables.get("sensors", {})
    stated = {name: tables.get(name, {}) for name in ("reading", "columns", "record")}
    places = {name: f"{own}: {section}" for section, table in stated.items() for name in table}
    places = {name: f"{place}.{name}" for name, place in places.items()} | {x: x for x in said}
    known = stated["record"] | {name: value for name, value in said.items() if name in KNOWN}
    if (split := split_uncertain(known.get("zero"))) is not None:
        known["zero"], error = split
        sensors = sensors | {"force": {**sensors.get("force", {}), "zero_uncertainty": error}}
    options = {*ReadingOptions.model_fields, *KNOWN}
    wrong = [Fault(name, unknown_name("argument", name, options)) for name in {*said} - options]
    read = {name: value for name, value in said.items() if name in options - {*KNOWN}}
    reading = _read(ReadingOptions, stated["reading"] | stated["columns"] | read, places, wrong)
    apparatus = _read(KnownApparatus, known, places, wrong)
    of_channels = {}
    for name, table in sensors.items():
        at = {key: f"{own}: sensors.{name}.{key}" for key in table}
        if split is not None and name == "force":
            at["zero_uncertainty"] = places["zero"]
        its = {"unit": CHANNELS[name].unit, **table}
        of_channels[name] = _read(Sensor, its, at, wrong)
    if wrong:
        raise DescriptionError(wrong)
    numbers = {name: getattr(apparatus, name) for name in known}
    return Request(reading, numbers, of_channels, own)


def _read(
    kind: type[T], values: Mapping[str, Any], places: Mapping[str, str], wrong: list[Fault]
) -> T:
    """Return the described values, with defaults for wrong ones."""
    try:
        return kind(**values)
    except DescriptionError as error:
        for each in error.at().faults:
            wrong.append(Fault(places.get(each.path, each.path), each.message))
        return kind()


def _beside(path: Path) -> Path | None:
    """Return the TOML file beside a file, if it is one about a record."""
    own = without_compression(path).with_suffix(".toml")
    if own == path or not own.is_file():
        return None
    return None if "slider" in read_toml(own) else own


def _tables(own: Path) -> dict[str, dict[str, Any]]:
    """Return the tables of such a file, all faults of their names at once."""
    if not own.exists() or own.is_dir():  # a pipe is well
        tables = ", ".join(f"[{section}]" for section in SECTIONS)
        what = "is a folder" if own.is_dir() else "no such file"
        message = f"{what}; write a file that says more of the record, with {tables}"
        raise DescriptionError.of(str(own), message)
    raw, wrong = read_toml(own), []
    allowed = {
        "columns": tuple(CHANNELS),
        "reading": tuple(name for name in ReadingOptions.model_fields if name not in CHANNELS),
        "record": tuple(KNOWN),
        "sensors": tuple(name for name in CHANNELS if name != "time"),
    }
    for section, table in raw.items():
        if section not in SECTIONS:
            wrong.append(Fault(f"{own}: {section}", unknown_name("table", section, SECTIONS)))
        elif not isinstance(table, Mapping):
            wrong.append(
                Fault(f"{own}: {section}", f"must be a table [{section}], is {echo(table)}")
            )
        else:
            strange = [name for name in table if name not in allowed[section]]
            wrong += [
                Fault(f"{own}: {section}.{name}", unknown_name("key", name, allowed[section]))
                for name in strange
            ]
            if section == "sensors":
                wrong += [
                    Fault(f"{own}: sensors.{name}", f"must be a table [sensors.{name}]")
                    for name, each in table.items()
                    if not isinstance(each, Mapping)
                ]
    if wrong:
        raise DescriptionError(wrong)
    return raw
