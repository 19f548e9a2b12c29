"""Which column is which channel, in which unit: by the user's word, by its name, by its unit."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from stiction.errors import Faults, ResultError, echo
from stiction.formats.channels import CHANNELS, LENGTH, OWN, RATIO, plain
from stiction.formats.table import FileColumn, FileTable
from stiction.formats.units import is_electric, is_ratio, size_of, split_unit
from stiction.recording.guess.remedies import (
    UnclearColumns,
    refuse_ambiguous,
    refuse_column,
    refuse_lack,
    refuse_unit,
    say_ratio,
    say_time,
)
from stiction.text.suggestion import Suggestion


class Chosen(NamedTuple):
    """A column for a channel: the size of its unit in SI, the unit as read, and a note.

    The unit of a `ratio` is the normal load.
    """

    column: FileColumn
    size: float
    unit: str
    note: str = ""
    ratio: bool = False


class Choice(NamedTuple):
    """The columns of all channels, and sentences on assumptions."""

    channels: dict[str, Chosen]
    notes: tuple[str, ...]


class _Wish(NamedTuple):
    column: FileColumn | None
    unit: str


def choose_columns(path: object, table: FileTable, said: dict[str, str], *, timed: bool) -> Choice:
    """Return the columns of channels.

    Parameters
    ----------
    path : object
        Of the file, for messages.
    table : FileTable
        The columns of the file.
    said : dict
        From a channel to a column, a unit, or both, as the user gives them.
    timed : bool
        Whether the times of samples are known without a column.

    Raises
    ------
    UnclearColumns
        If no column, or more than one, can be the time or the force; with the choices, for all
        channels at once.
    """
    faults, wishes = Faults(), {}
    for name, text in said.items():
        with faults.of_part():
            wishes[name] = _read_wish(path, table, name, text)
    unknown = said.keys() - wishes.keys()
    taken = [wish.column for wish in wishes.values() if wish.column is not None]
    found: dict[str, Chosen] = {}
    notes: list[str] = []
    for name in ("load", "force_across", "force", "position", "drive_position", "slip_speed"):
        if name in unknown:
            continue
        with faults.of_part():
            wish = wishes.get(name, _Wish(None, ""))
            column = wish.column or _by_name(path, table, name, wish, taken, said)
            if column is None and (name == "force" or name in said):
                column = _by_unit(path, table, name, wish, taken)
            if column is not None:
                taken.append(column)
                found[name] = _with_size(path, table, name, column, wish.unit)
            elif name in said:
                refuse_lack(
                    path, table, name, say_ratio(_ratios(table, taken)) if name == "force" else ""
                )
            elif name == "force":
                found[name] = _ratio(path, table, taken)
                taken.append(found[name].column)
    force = found.get("force")
    timed = timed or (force is not None and force.column.clock is not None)
    if "time" not in unknown and (not timed or "time" in said):
        with faults.of_part():
            wish = wishes.get("time", _Wish(None, ""))
            column = wish.column or _times(path, table, force, wish, taken)
            taken.append(column)
            found["time"] = _with_size(path, table, "time", column, wish.unit)
    try:
        faults.refuse()
    except ResultError as error:
        unclear = (each for each in faults.found if isinstance(each, UnclearColumns))
        lacking = (name for each in unclear for name in each.lacking)
        raise UnclearColumns(str(error), *lacking) from None
    notes += [x.note for x in found.values() if x.note]
    for column in table.columns:
        if column not in taken and may_be_displacement(column.name):
            notes.append(
                f"column {column} is not used: is it the displacement of the mass "
                f"({Suggestion('position', column.number)}) or of the drive "
                f"({Suggestion('drive_position', column.number)})?"
            )
    return Choice(found, tuple(notes))


def may_be_displacement(name: str) -> bool:
    """Return whether a column by this name may be a displacement, though no channel is sure."""
    return LENGTH.fullmatch(plain(name)) is not None


def _read_wish(path: object, table: FileTable, name: str, text: str) -> _Wish:
    """Return column and unit of ``Fx``, ``mN``, ``Fx=mN`` or ``3=mN``."""
    head, equals, unit = text.rpartition("=")
    if equals:
        column = _find(path, table, name, head.strip()) if head.strip() else None
        if head.strip() and column is None:
            refuse_column(path, table, name, f"no column is called {echo(head.strip())}, for")
        return _Wish(column, unit.strip())
    column = _find(path, table, name, text.strip())
    is_unit = size_of(text, CHANNELS[name].unit) is not None
    if column is not None and is_unit and not text.strip().isdigit():
        raise ResultError(
            f"{path}: {echo(text)} is a column and a unit; say {Suggestion(name, f'{text}=')} for "
            f"the column, or '={text}' for the unit"
        )
    if column is not None:
        return _Wish(column, "")
    if not is_unit:
        example = CHANNELS[name].example
        refuse_column(
            path, table, name, f"{echo(text)} is neither a column nor a unit such as {example} of"
        )
    return _Wish(None, text.strip())


def _find(path: object, table: FileTable, name: str, text: str) -> FileColumn | None:
    """Return the column of a name, a heading as the file or a message has it, or a number."""
    columns, small, split = table.columns, text.lower(), split_unit(text)
    for matches in (
        [x for x in columns if text in (x.name, x.heading)],
        [x for x in columns if small in (x.name.lower(), x.heading.lower())],
        [x for x in columns if split[1] and split == (x.name, x.unit)],
        [x for x in columns if text == str(x.number)],
    ):
        if len(matches) > 1:
            refuse_ambiguous(path, name, matches)
        if matches:
            return matches[0]
    return None


def _fits(column: FileColumn, name: str) -> bool:
    """Return whether a column's unit allows that it is a channel."""
    unit = column.unit
    return not unit or is_electric(unit) or size_of(unit, CHANNELS[name].unit) is not None


def _by_name(
    path: object,
    table: FileTable,
    name: str,
    wish: _Wish,
    taken: Sequence[FileColumn],
    said: dict[str, str],
) -> FileColumn | None:
    """Return the only free column with a usual name of a channel."""
    pattern = CHANNELS[name].names
    free = [each for each in table.columns if not any(each is one for one in taken)]
    matches = [
        x for x in free if pattern.fullmatch(plain(x.name)) and (wish.unit or _fits(x, name))
    ]
    if name == "load" and not said.get("force"):
        # the only force of a testing machine is called its load, too
        doubtful = [x for x in matches if plain(x.name) in ("load", "last", "w")]
        others = [x for x in free if CHANNELS["force"].names.fullmatch(plain(x.name))]
        ratios = [x for x in free if RATIO.fullmatch(plain(x.name))]
        if doubtful and doubtful == matches and not (others or ratios or "load" in said):
            at = doubtful[0].number
            raise ResultError(
                f"{path}: column {doubtful[0]} may be the force along the drive or the normal "
                f"load; say {Suggestion('force', at)} or {Suggestion('load', at)}"
            )
    matches = [x for x in matches if plain(x.name) in OWN] or matches
    if len(matches) > 1:
        refuse_ambiguous(path, name, matches)
    return matches[0] if matches else None


def _by_unit(
    path: object,
    table: FileTable,
    name: str,
    wish: _Wish,
    taken: Sequence[FileColumn],
) -> FileColumn | None:
    """Return the only free column in a unit of a channel, or the only one without any name."""
    free = [each for each in table.columns if not any(each is one for one in taken)]
    unit = CHANNELS[name].unit
    matches = [x for x in free if x.unit and size_of(x.unit, unit) is not None]
    matches = [x for x in matches if not _is_other(x, name)]
    if not matches and wish.unit:
        matches = [x for x in free if not x.unit and not _is_other(x, name)]
        if _has_no_names(table) and len(matches) == len(table.columns):
            matches = matches[1:]  # the first is the time
    if not matches:
        raw = [x for x in free if is_electric(x.unit) and not _is_other(x, name)]
        matches = raw if len(raw) == 1 or wish.unit else []
    if len(matches) > 1:
        refuse_ambiguous(path, name, matches)
    return matches[0] if matches else None


def _is_other(column: FileColumn, name: str) -> bool:
    """Return whether a column has the usual name of another channel."""
    text = plain(column.name)
    others = [each for key, each in CHANNELS.items() if key != name]
    return any(each.names.fullmatch(text) for each in others) or bool(LENGTH.fullmatch(text))


def _has_no_names(table: FileTable) -> bool:
    return all(x.name == f"column {x.number}" for x in table.columns)


def _ratios(table: FileTable, taken: Sequence[FileColumn]) -> list[FileColumn]:
    """Return the free columns that are friction coefficients."""
    free = [each for each in table.columns if not any(each is one for one in taken)]
    return [x for x in free if RATIO.fullmatch(plain(x.name)) and is_ratio(x.unit or "-")]


def _ratio(path: object, table: FileTable, taken: Sequence[FileColumn]) -> Chosen:
    """Return a friction coefficient in place of the force."""
    matches = _ratios(table, taken)
    if len(matches) > 1:
        refuse_ambiguous(path, "force", matches)
    if not matches:
        refuse_lack(path, table, "force")
    column = matches[0]
    size = 0.01 if column.unit == "%" else 1.0
    note = f"column {column} is a friction coefficient: the force is that times the normal load"
    return Chosen(column, size, "normal load", note, ratio=True)


def _times(
    path: object,
    table: FileTable,
    force: Chosen | None,
    wish: _Wish,
    taken: Sequence[FileColumn],
) -> FileColumn:
    """Return the column of times; of several, the one to the left of the force."""
    free = [each for each in table.columns if not any(each is one for one in taken)]
    pattern = CHANNELS["time"].names
    matches = [
        x for x in free if pattern.fullmatch(plain(x.name)) and (wish.unit or _fits(x, "time"))
    ]
    if not matches:
        matches = [x for x in free if x.unit and size_of(x.unit, "s") is not None]
    if not matches and _has_no_names(table) and wish.unit:
        matches = [x for x in free if x.number == 1]
    if not matches:
        refuse_lack(path, table, "time", say_time(table, free))
    first = matches[0]
    same = all(np.array_equal(x.values, first.values, equal_nan=True) for x in matches)
    alike = same and len({x.unit for x in matches}) == 1
    if force is not None and not alike:
        return own_clock(path, table, force.column, matches)
    return first


def own_clock(
    path: object, table: FileTable, column: FileColumn, times: Sequence[FileColumn]
) -> FileColumn:
    """Return the column of times that belongs to a channel, where each channel has one.

    Raises
    ------
    ResultError
        If times do not stand before the channels that they belong to.
    """
    numbers = [x.number for x in times]
    adjacent = any(number + 1 in numbers for number in numbers)
    before = [x for x in times if x.number < column.number]
    if adjacent or not before or numbers[0] != min(x.number for x in table.columns):
        refuse_ambiguous(path, "time", times)
    return before[-1]


def _with_size(path: object, table: FileTable, name: str, column: FileColumn, unit: str) -> Chosen:
    """Return a column with the size of its unit."""
    channel = CHANNELS[name]
    text = unit or column.unit
    size = size_of(text, channel.unit, column.unit) if text else None
    if size is not None:
        note = f"in column {column} {size.note}" if size.note else ""
        headed = size_of(column.unit, channel.unit) if unit and column.unit else size
        if "/" not in unit and (headed is None or abs(headed.value) != abs(size.value)):
            note = f"column {column} is read in {unit}, as asked, not in what its heading says"
        return Chosen(column, size.value, text, note)
    refuse_unit(path, table, name, column, text, asked=bool(unit))
