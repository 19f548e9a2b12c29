"""From a file to its measurements: channels in SI, properties of the rig, and the guess."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import isfinite
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from stiction.arrays import Floats
from stiction.errors import Faults, ResultError, echo
from stiction.formats import TextLayout, read_tables
from stiction.formats.channels import CHANNELS, plain
from stiction.formats.table import FileTable, Remark, number_of
from stiction.recording.guess.channel_times import (
    FEWEST_SAMPLES,
    note_uneven,
    notes_on_times,
    own_times,
    times_of_rows,
    values_at,
)
from stiction.recording.guess.choice import Choice, Chosen, choose_columns
from stiction.recording.guess.clock import Block, blocks, rate_of
from stiction.recording.guess.displacement import unwrap
from stiction.recording.guess.remarks import Said, what_is_said
from stiction.recording.guess.remedies import FILL, GAP, UnclearColumns
from stiction.recording.noise import noise_level
from stiction.recording.origin import Origin, Use
from stiction.recording.request import (
    KNOWN,
    MARKS,
    SIGNS,
    AskedPart,
    ReadingOptions,
    Request,
    request,
)
from stiction.recording.sensor import Sensor
from stiction.text.quantity.wording import in_words, percent
from stiction.text.suggestion import Suggestion

T = TypeVar("T")
FORCES = {"force", "force_across"}
DISPLACEMENTS = ("position", "drive_position")
BESIDE = 0.05  # of the rows of the longest table: a shorter one holds results, say
STEPS = ("step", "stroke", "cycle", "block", "segment", "pass", "schritt", "zyklus", "hub")


class Measurement(NamedTuple):
    """The channels of one block in SI, by name, and further statements of the file and user."""

    channels: dict[str, Any]  # of arrays
    known: dict[str, Any]
    sensors: dict[str, Sensor]
    origin: Origin
    asked: AskedPart = AskedPart()  # of it, if not all is wanted


class TableBlock(NamedTuple):
    """A block of a table, the columns chosen for it, and the request for the file."""

    path: Path
    table: FileTable
    asked: Request
    choice: Choice
    part: Block


class MeasuredChannel(NamedTuple):
    """A channel at the times of the force, (n,), in SI, and its sensor."""

    values: Floats
    sensor: Sensor


def read_measurements(
    path: Path,
    given: Mapping[str, Any],
    sidecar: Path | None,
    rig_load: float | None = None,
    tables: Sequence[FileTable] | None = None,
) -> list[Measurement]:
    """Return a measurement for each block of a file, or the one that is asked for.

    Parameters
    ----------
    path : Path
        A file of any known format, or a name for `tables`.
    given : mapping
        What the user says, by the names of `ReadingOptions` and of the apparatus.
    sidecar : Path or None
        In place of the TOML file beside the file.
    rig_load : float or None
        As of `Request`: for a coefficient of friction whose load nothing else states.
    tables : sequence of FileTable, optional
        In place of those of the file.

    Raises
    ------
    ResultError
        If it cannot be read, or what it holds is ambiguous; with the choices.
    DescriptionError
        If what the user says is wrong.
    """
    asked = request(path, given, sidecar)._replace(rig_load=rig_load)
    reading = asked.reading
    layout = TextLayout(SIGNS.get(reading.decimal or ""), MARKS.get(reading.separator or ""))
    found: list[Measurement] = []
    # beside the table of samples there may be one without a force, and a short one of results
    faults, without, short, notes = Faults(), Faults(), Faults(), []
    if tables is None:
        tables = read_tables(path, layout)
    most = max(map(len, tables), default=0)
    for table in tables:
        try:
            found += _measurements(path, table, asked)
        except ResultError as error:
            lacks = isinstance(error, UnclearColumns) and FORCES & {*error.lacking}
            if len(table) < BESIDE * most:
                short.found.append(error)
                rows = number_of(len(table), "row")
                notes.append(f"a table of {rows} left out, the first at {table.line(0)}")
            else:
                (without if lacks else faults).found.append(error)
    faults.refuse()
    if not found:
        without.refuse()
        short.refuse()
    numbered = [
        each._replace(origin=_place_among(each.origin, number, len(found), notes))
        for number, each in enumerate(found, 1)
    ]
    return numbered if reading.block is None else [block_of(path, numbered, reading.block)]


def block_of(path: str | Path, found: Sequence[T], number: int) -> T:
    """Return one of several blocks of a file, counted from 1.

    Raises
    ------
    ResultError
        If there are not so many.
    """
    if not 1 <= number <= len(found):
        raise ResultError(
            f"{path}: has {number_of(len(found), 'block')}; there is no block {echo(number)}. "
            "A block begins where the times of the file begin again; a stroke of a drive that goes "
            f"to and fro is read by {Suggestion('stroke', 2)}"
        )
    return found[number - 1]


def _place_among(origin: Origin, number: int, count: int, notes: Sequence[str]) -> Origin:
    place = {"block": number, "blocks": count, "notes": (*origin.notes, *notes)}
    return Origin(**{**vars(origin), **place})


def _measurements(path: Path, table: FileTable, asked: Request) -> list[Measurement]:
    """Return the measurements of one table."""
    reading = asked.reading
    said = what_is_said(table.remarks)
    interval = reading.interval or said.interval
    by_interval = reading.interval is not None
    if not by_interval and interval is not None:  # a column of times comes first
        by_interval = not _has_times(path, table, reading)
    choice = choose_columns(path, table, reading.columns, timed=by_interval)
    clock, name = times_of_rows(table, choice, interval)
    parts = blocks(path, table, clock, reading.times, name)
    found = []
    before = -1
    for part in parts:
        if len(part.rows) < FEWEST_SAMPLES:
            continue
        its = _remarks(table, before, int(part.rows[0]))
        before = int(part.rows[-1])
        own = what_is_said(its)
        if len(parts) == 1:  # a line below the samples counts, too, but for when they began
            own = said._replace(start=own.start)
        block = TableBlock(path, table, asked, choice, part)
        found.append(_measurement(block, own, by_interval, len(parts)))
    if not found:
        raise ResultError(f"{path}: fewer than {FEWEST_SAMPLES} samples; record it again")
    return found


def _has_times(path: Path, table: FileTable, reading: ReadingOptions) -> bool:
    try:
        return "time" in choose_columns(path, table, reading.columns, timed=False).channels
    except UnclearColumns as error:
        return "time" not in error.lacking


def _remarks(table: FileTable, before: int, first: int) -> Sequence[Remark]:
    """Return the remarks between two rows."""
    if table.lines is None:
        return table.remarks
    low = table.lines[before] if before >= 0 else 0
    return [x for x in table.remarks if low < x.line < table.lines[first] or x.line == 0]


def _measurement(block: TableBlock, said: Said, by_interval: bool, parts: int) -> Measurement:
    """Return the measurement of one block."""
    path, table, asked, choice, part = block
    notes = [*table.notes, *choice.notes, *part.notes]
    notes += notes_on_times(table, part, said, by_interval, parts)
    whole, lost = _with_force(block)
    time = part.time[whole]
    if len(time) < FEWEST_SAMPLES:
        raise ResultError(f"{path}: {len(time)} samples with a force; a record needs two")
    notes += [*lost, *note_uneven(time)]
    found: dict[str, MeasuredChannel] = {}
    for name in choice.channels:
        if name == "time":
            continue
        its, remarks = _channel(block, name, time, whole)
        notes += remarks
        if its is not None:
            found[name] = its
    force, known = choice.channels["force"], dict(asked.known)
    lacks = force.ratio and "load" not in found and "normal_load" not in known
    if lacks and asked.rig_load is not None and isfinite(asked.rig_load):
        known["normal_load"] = asked.rig_load
        notes.append("the normal load is that of the rig's description")
    found, remarks = _weigh(path, force, found, known, asked.rig_load is not None)
    sensors = {name: each.sensor for name, each in found.items()}
    notes += remarks
    notes += [_in_words(name, x) for name, x in sensors.items() if x.noise or x.quantisation]
    notes += _apparatus_in_words(known)
    if isinstance(asked.reading.wrap, float) and not found.keys() & {*DISPLACEMENTS}:
        notes.append("wrap has no effect: there is no displacement")
    channels = {"time": time, **{name: each.values for name, each in found.items()}}
    origin = Origin(
        path.name,
        table.format,
        _uses(table, choice, channels),
        len(time),
        rate_of(time),
        label=table.label or _label(table, part),
        start=said.start or table.start,
        notes=tuple(notes),
    )
    return Measurement(channels, known, sensors, origin, asked.reading.part)


def _apparatus_in_words(known: Mapping[str, Any]) -> list[str]:
    """Return a note on the stated apparatus, if anything is stated."""
    its = [
        f"{name.replace('_', ' ')} {in_words(float(known[name]), unit)}"
        for name, unit in KNOWN.items()
        if known.get(name) is not None
    ]
    return [f"stated: {', '.join(its)}"] if its else []


def _with_force(block: TableBlock) -> tuple[NDArray[np.bool_], list[str]]:
    """Return a mask of the rows of a block that have a force, and a note on the others."""
    rows = block.part.rows
    whole = np.isfinite(block.choice.channels["force"].column.values[rows])
    if whole.all():
        return whole, []
    first = block.table.line(int(rows[np.argmin(whole)]))
    lost = number_of(int(np.count_nonzero(~whole)), "sample")
    return whole, [f"{lost} without a force left out, the first at {first}"]


def _channel(
    block: TableBlock, name: str, time: Floats, whole: NDArray[np.bool_]
) -> tuple[MeasuredChannel | None, list[str]]:
    """Return a channel at the times of the force, None if it has no values there; and notes."""
    chosen, part = block.choice.channels[name], block.part
    values = chosen.column.values[part.rows] * chosen.size
    other = own_times(block.path, block.table, block.choice, name, part)
    its, notes = values_at(values, part.time if other is None else other, time, name, whole)
    if its is None:
        return None, notes
    sensor = block.asked.sensors.get(name)
    if sensor is not None:
        its = sensor.value(its, time)
    if name in DISPLACEMENTS:
        its, wraps = _unwrap(its, time, block.asked.reading.wrap, name)
        notes += wraps
    return MeasuredChannel(its, _with_noise(sensor, its, name)), notes


def _unwrap(
    values: Floats, time: Floats, period: float | None, name: str
) -> tuple[Floats, list[str]]:
    """Return a displacement made continuous, with a note."""
    found, length, count = unwrap(values, time, period)
    if not count:
        return found, []
    return found, [
        f"the {CHANNELS[name].meaning} starts again {number_of(count, 'time')}, every "
        f"{in_words(length, 'm')}, and was made continuous ({Suggestion('wrap', 'none')} "
        "leaves it)"
    ]


def _with_noise(sensor: Sensor | None, values: Floats, name: str) -> Sensor:
    """Return the properties of a sensor, with noise and quantisation estimated if not stated."""
    level = noise_level(values)
    if sensor is None:
        unit = CHANNELS[name].unit
        return Sensor(unit=unit, noise=level.noise, quantisation=level.quantisation)
    its = sensor.behind()
    fields = {each: getattr(its, each) for each in type(its).model_fields}
    for each in ("noise", "quantisation"):
        if each not in sensor.model_fields_set:
            fields[each] = getattr(level, each)
    return Sensor(**fields)


def _in_words(name: str, sensor: Sensor) -> str:
    """Return noise and quantisation of a channel in a sentence."""
    noise, step = (
        in_words(x, sensor.unit) if x else "none seen" for x in (sensor.noise, sensor.quantisation)
    )
    most = "at most " if sensor.noise and not noise.startswith("<") else ""
    return f"{CHANNELS[name].meaning}: noise {most}{noise}, quantisation {step}"


def _weigh(
    path: Path,
    force: Chosen,
    found: Mapping[str, MeasuredChannel],
    known: Mapping[str, Any],
    of_rig: bool,
) -> tuple[dict[str, MeasuredChannel], list[str]]:
    """Turn a negative normal load round, and a coefficient of friction into a force; with notes.

    `of_rig` says that the record is one of a rig that is described.
    """
    channels, notes, load = dict(found), [], None
    if "load" in channels:
        load = channels["load"].values
        if float(np.median(load)) < 0.0:
            load = -load
            channels["load"] = channels["load"]._replace(values=load)
            notes.append(
                "the normal load is negative, as compression is in many cells: its sign was turned"
            )
        if float(load.min()) < 0.0 < float(load.max()):
            share = percent(float(np.mean(load < 0.0)))
            notes.append(f"the normal load changes its sign: {share} of the samples pull")
    if not force.ratio:
        return channels, notes
    if load is None and "normal_load" not in known:
        say = f"say {Suggestion('normal_load', f'{GAP} N')}, {FILL}"
        remedy = f"{say}; if the load is unknown, 1 N: forces are then coefficients"
        if of_rig:
            remedy = f"the rig's description states none for certain: {say}, that of this record"
        raise ResultError(
            f"{path}: column {force.column} is a friction coefficient, and the force is that times "
            f"the normal load; {remedy}"
        )
    its = channels["force"].values * (load if load is not None else known["normal_load"])
    channels["force"] = MeasuredChannel(its, _with_noise(None, its, "force"))
    return channels, notes


def _label(table: FileTable, part: Block) -> str:
    """Return the words that a block has in a column of its own, such as the name of a step."""
    for name, texts in table.labels:
        its = {str(x).strip() for x in texts[part.rows]}
        if len(its) == 1:
            return f"{name} {its.pop()}"
    for column in table.columns:
        values = column.values[part.rows]
        if plain(column.name) in STEPS and np.ptp(values) == 0.0:
            return f"{column.name} {values[0]:g}"
    return ""


def _uses(table: FileTable, choice: Choice, known: Mapping[str, Floats]) -> tuple[Use, ...]:
    """Return the use of each column for the `known` channels."""
    taken = {id(x.column): (name, x) for name, x in choice.channels.items() if name in known}
    found = []
    for column in table.columns:
        name, chosen = taken.get(id(column), ("", None))
        ends = (float(known[name].min()), float(known[name].max())) if name else (0.0, 0.0)
        unit = chosen.unit if chosen is not None else column.unit
        found.append(Use(column.number, column.heading, name, unit, *ends))
    found += [Use(0, name, "", "", 0.0, 0.0) for name, _ in table.labels]
    return tuple(found)
