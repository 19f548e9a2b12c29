"""How a user names a column and its unit: the words of refusals that ask for them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NoReturn

import numpy as np

from stiction.arrays import Floats
from stiction.errors import ResultError, echo
from stiction.formats.channels import CHANNELS
from stiction.formats.table import FileColumn, FileTable
from stiction.formats.units import is_electric, is_ratio, size_of
from stiction.text.quantity.wording import in_words
from stiction.text.suggestion import Suggestion

DAYS = 2e4, 1e5  # since 1900, as spreadsheets number them: 1954 to 2173
SHOWN_COLUMNS = 3  # columns that a message suggests
EVEN_STEPS = 0.01  # of a step: displacements whose steps differ by more have no interval
# of a suggestion: what only the user knows. A number instead would be run as it stands
GAP = "?"
FILL = f"with its number in place of {GAP}"
AN_AREA = f"{GAP} mm^2"  # that turns a stress into a force


class UnclearColumns(ResultError):
    """The error that no column, or several, can be a channel; `lacking` channels have none."""

    def __init__(self, message: str, *lacking: str) -> None:
        """Store the message, and the names of the channels."""
        super().__init__(message)
        self.lacking = lacking


def refuse_ambiguous(path: object, name: str, matches: Sequence[FileColumn]) -> NoReturn:
    """Refuse several columns that may be a channel; the user says which."""
    choices = ", ".join(str(each) for each in matches)
    each_of_them = " or ".join(
        str(Suggestion(name, each.number)) for each in matches[:SHOWN_COLUMNS]
    )
    raise ResultError(
        f"{path}: {len(matches)} columns may be the {CHANNELS[name].meaning}: {choices}; say which "
        f"by its number: {each_of_them}"
    )


def refuse_column(path: object, table: FileTable, name: str, why: str) -> NoReturn:
    """Refuse to find a column, with the reason."""
    raise ResultError(_with_columns(path, table, name, why))


def refuse_lack(path: object, table: FileTable, name: str, remedy: str = "") -> NoReturn:
    """Refuse a table in which no column is a channel."""
    raise UnclearColumns(_with_columns(path, table, name, "no column is", remedy), name)


def refuse_unit(
    path: object, table: FileTable, name: str, column: FileColumn, text: str, asked: bool
) -> NoReturn:
    """Refuse a column without a unit of a channel, whose unit is `text`, which may be `asked`."""
    meaning = _article(CHANNELS[name].meaning)
    if not text or (is_ratio(text) and not asked):
        example = _say_units(name, column)
        raise ResultError(f"{path}: column {column} states no unit of {meaning}; {example}")
    if is_electric(text):
        hints = [
            x
            for x in table.remarks
            if "/V" in x.text or "V/" in x.text or "scale" in x.text.lower()
        ]
        hint = f"; line {hints[0].line} says {hints[0].text.strip()[:60]!r}" if hints else ""
        scale = _scale(CHANNELS[name].unit, text)
        raise ResultError(
            f"{path}: column {column} is in {text}, and its scale is needed; say "
            f"{Suggestion(name, f'{column.number}={scale}')}, {FILL}{hint}"
        )
    raise ResultError(
        f"{path}: column {column} is in {echo(text)}, not a unit of {meaning}; "
        f"{_say_units(name, column)}"
    )


def say_time(table: FileTable, columns: Sequence[FileColumn]) -> str:
    """Return how times are given: by a column, an interval, or the steps of a displacement."""
    for column in columns:
        if size_of(column.unit, "m") is not None and _increases(column.values):
            steps = np.diff(column.values)
            step = float(np.median(steps))
            if np.abs(steps - step).max() <= EVEN_STEPS * step:
                interval = Suggestion("interval", f"{GAP} s")
                return (
                    f"column {column} rises in steps of {step:.4g} {column.unit}: say the time of "
                    f"one, a step over the drive velocity, {interval}, {FILL}"
                )
    by_column = _say(table, "time")
    return f"{by_column}; or give {Suggestion('interval', f'{GAP} ms')}, {FILL}"


def say_ratio(ratios: Sequence[FileColumn]) -> str:
    """Return how the first of friction coefficients is read, where a force was asked for."""
    return "".join(
        f"column {each} is a friction coefficient: leave out {Suggestion('force')}, and say "
        f"{Suggestion('normal_load', f'{GAP} N')}, {FILL}"
        for each in ratios[:1]
    )


def _say_units(name: str, column: FileColumn) -> str:
    """Return the usual units of a channel, and the column's values in each."""
    channel = CHANNELS[name]
    units = dict.fromkeys((channel.unit, channel.example))
    known = column.values[np.isfinite(column.values)]
    values = known if len(known) else np.zeros(1)
    said = []
    for unit in units if len(units) > 1 else (channel.unit, f"k{channel.unit}"):
        size = size_of(unit, channel.unit)
        ends = (size.value if size else 1.0) * np.array([values.min(), values.max()])
        if name == "time":
            lasts = float(np.ptp(ends))
            rate = in_words((len(values) - 1) / lasts, "Hz", 2) if lasts > 0.0 else "any rate"
            means = f"{in_words(lasts, 's', 2)} at {rate}"
        else:
            means = f"{in_words(ends[0], channel.unit, 2)} to {in_words(ends[1], channel.unit, 2)}"
        said.append(f"{Suggestion(name, f'{column.number}={unit}')} makes it {means}")
    return f"say its unit: {', '.join(said)}"


def _article(meaning: str) -> str:
    return "time" if meaning == "time" else f"the {meaning}"


def _with_columns(path: object, table: FileTable, name: str, why: str, remedy: str = "") -> str:
    """Return why a channel has no column, the existing columns, and the remedy."""
    columns = ", ".join(str(each) for each in table.columns) or "none"
    remedy = remedy or _say(table, name)
    return f"{path}: {why} the {CHANNELS[name].meaning}; columns: {columns}; {remedy}"


def _say(table: FileTable, name: str) -> str:
    """Return how to declare a column as a channel, with a gap for the user's knowledge."""
    example = _example(table, name)
    fill = f", {FILL}" if GAP in example else ""
    fill = fill.replace("number", "unit") if example.endswith(GAP) else fill
    stress = "; a stress times the area that it acts on is a force" if AN_AREA in example else ""
    return f"say for example {Suggestion(name, example)}{fill}{stress}"


def _example(table: FileTable, name: str) -> str:
    """Return number and unit of a column that may be a channel; times increase."""
    channel, increasing = CHANNELS[name], name == "time"
    likely = [x for x in table.columns if _increases(x.values) == increasing]
    column = (likely or [*table.columns])[0] if table.columns else None
    number = column.number if column else 2
    if column and is_electric(column.unit):
        return f"{number}={_scale(channel.unit, column.unit)}"
    if column and channel.unit == "N" and size_of(column.unit, "Pa") is not None:
        return f"{number}={AN_AREA}*{column.unit}"
    if column and size_of(column.unit, channel.unit) is not None:
        return str(number)  # its heading has the unit
    if increasing and column and DAYS[0] < float(np.nanmean(column.values)) < DAYS[1]:
        return f"{number}=d"
    return f"{number}={GAP}"


def _scale(unit: str, signal: str) -> str:
    """Return the scale of a raw signal, without its number."""
    return f"{GAP} {unit}/({signal})" if "/" in signal else f"{GAP} {unit}/{signal}"


def _increases(values: Floats) -> bool:
    known = values[np.isfinite(values)]
    return len(known) > 1 and bool((np.diff(known) >= 0.0).all() and known[-1] > known[0])
