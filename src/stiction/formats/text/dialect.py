"""Separator and decimal sign of a text file."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from itertools import pairwise, zip_longest
from typing import NamedTuple

import numpy as np

from stiction.arrays import Floats
from stiction.errors import ResultError, echo
from stiction.formats import TextLayout
from stiction.text.suggestion import Suggestion

SAMPLE = 400  # lines by which they are found
SEPARATORS = {"\t": "a tab", ";": "a semicolon", ",": "a comma", "|": "a bar", " ": "spaces"}
DECIMALS = {".": "point", ",": "comma"}
MISSING = {
    *("", "-", "--", "---", "nan", "na", "n/a", "n.a.", "null", "none"),
    *("#n/a", "#div/0!", "#value!", "#ref!", "#num!", "#name?", "1.#qnan", "-1.#ind", "1.#inf"),
    # what instruments write where a signal leaves their range
    *("overload", "overrange", "over range", "overflow", "ovld", "ovrld", "ovl", "ol", "invalid"),
}
NAMED_DAY = r"\d{1,2}[-. ][^\W\d]{3,}[-. ]\d{2,4}"  # 01-Mar-2026
DAY = rf"\d{{1,4}}[-./]\d{{1,2}}[-./]\d{{1,4}}|{NAMED_DAY}"  # before a time of day
MINUTES = r"\d{1,3}:[0-5]\d[.,]\d+"  # and seconds: 12:34.5
CLOCK = re.compile(
    rf"((?P<date>{DAY})[ T])?(?P<clock>\d{{1,2}}:\d{{2}}(:\d{{2}}([.,]\d+)?)?|{MINUTES})"
    r"( ?(?P<half>[AP])M|Z|(?P<offset>[+-]\d{2}:?\d{2}))?",
    re.I,
)
DATE = re.compile(rf"\d{{4}}-\d{{2}}-\d{{2}}|\d{{1,2}}[./]\d{{1,2}}[./]\d{{2,4}}|{NAMED_DAY}")
HALF_A_DAY = 43200.0  # s
NUMBER = {  # exponents as Fortran writes them, too: 1.5D-03
    ".": re.compile(r"[+−-]?(\d+\.?\d*|\.\d+)([ED][+-]?\d+)?|[+-]?inf", re.I),
    ",": re.compile(r"[+−-]?(\d+(,\d+)?|,\d+)([ED][+-]?\d+)?|[+-]?inf", re.I),
}
GROUPS = {  # thousands in groups: 12,345.6 or 12'345.6
    ".": re.compile(r"[+−-]?[1-9]\d{0,2}([,'’ \u00a0\u202f]\d{3})+(\.\d*)?"),
    ",": re.compile(r"[+−-]?[1-9]\d{0,2}([.'’ \u00a0\u202f]\d{3})+(,\d*)?"),
}
FORTRAN = re.compile(r"(?<=[\d.,])D(?=[+-]?\d)", re.I)
GROUPED = re.compile(r"[+-]?[1-9]\d{0,2}[.,]\d{3}")  # one and a half, or fifteen hundred?
THOUSANDTHS, HUNDREDS = 0.1, re.compile(r"[+-]?[1-9]\d\d")  # share of cells below a thousand


class Dialect(NamedTuple):
    """Separator and decimal sign, and whether thousands are grouped."""

    separator: str
    decimal: str
    groups: bool = False

    def __str__(self) -> str:
        """Return them in words."""
        groups = ", thousands in groups" if self.groups else ""
        return (
            f"separated by {SEPARATORS[self.separator]}, decimal {DECIMALS[self.decimal]}{groups}"
        )

    def cells(self, line: str) -> list[str]:
        """Return the cells of a line."""
        if self.separator == " ":
            return line.split()
        if '"' not in line:
            return [cell.strip() for cell in line.split(self.separator)]
        return [cell.strip().strip('"') for cell in _split_quoted(line, self.separator)]

    def is_number(self, cell: str) -> bool:
        """Return whether a cell is a number."""
        return NUMBER[self.decimal].fullmatch(cell) is not None or self._has_groups(cell)

    def has_other_sign(self, cell: str) -> bool:
        """Return whether a cell has a point where the decimal sign is a comma, and no groups."""
        return self.decimal == "," and "." in cell and not self.is_value(cell.strip())

    def _has_groups(self, cell: str) -> bool:
        return self.groups and GROUPS[self.decimal].fullmatch(cell) is not None

    def as_python(self, cell: str) -> str:
        """Return a number as Python writes it; another cell with points for decimal signs."""
        if self._has_groups(cell):
            whole, sign, rest = cell.partition(self.decimal)
            cell = re.sub("[^0-9+−-]", "", whole) + sign + rest
        return FORTRAN.sub("e", cell).replace("−", "-").replace(self.decimal, ".")

    def is_value(self, cell: str) -> bool:
        """Return whether a cell is a number, a time of day, or missing."""
        return (
            self.is_number(cell)
            or cell.lower() in MISSING
            or CLOCK.fullmatch(cell) is not None
            or DATE.fullmatch(cell) is not None
        )

    def has_samples(self, line: str, labels: bool) -> bool:
        """Return whether all cells of a line are values, words beside them allowed if `labels`."""
        cells = self.cells(line)
        if not any(self.is_number(cell) or CLOCK.fullmatch(cell) for cell in cells):
            return False
        return all(self.is_value(cell) or (labels and cell[:1].isalpha()) for cell in cells)


def _split_quoted(line: str, separator: str) -> list[str]:
    return re.split(f'{re.escape(separator)}(?=(?:[^"]*"[^"]*")*[^"]*$)', line)


class UnclearCommas(ResultError):
    """The doubt about commas or points, and the remedy for reading a record."""

    def __init__(self, unclear: str, remedy: str) -> None:
        """Join both into the message."""
        super().__init__(f"{unclear}; {remedy}")
        self.unclear = unclear


def find_dialect(path: object, lines: Sequence[str], layout: TextLayout) -> Dialect:
    """Return separator and decimal sign with which most lines are samples.

    Raises
    ------
    ResultError
        If no line has samples, or two readings differ and are equally good.
    """
    decimal, separator = layout.decimal, layout.separator
    filled = [line for line in lines if line.strip()]
    some = filled[: SAMPLE // 2] + filled[SAMPLE // 2 :][:: max(1, len(filled) // SAMPLE)][-SAMPLE:]
    signs = [decimal] if decimal else list(DECIMALS)
    kinds = [(sign, False) for sign in signs]
    kinds += [(sign, True) for sign in signs if any(GROUPS[sign].search(line) for line in some)]
    choices = [
        Dialect(mark, sign, groups)
        for mark in ([separator] if separator else SEPARATORS)
        for sign, groups in kinds
        if mark != sign
    ]
    for labels in (False, True):
        scores = {each: _score(each, some, labels) for each in choices}
        wide = [each for each, (_, width) in scores.items() if width >= layout.columns] or choices
        best = max((scores[each][0] for each in wide), default=0.0)
        if best > 0.0:
            near = [each for each in wide if scores[each][0] > 0.9 * best]
            return _settle(path, near, scores, some, labels, layout)
    raise ResultError(_no_samples(path, filled))


def _score(dialect: Dialect, lines: Sequence[str], labels: bool) -> tuple[float, int]:
    """Return the share of lines with samples of the usual number of cells, and that number."""
    counts = Counter(
        len(dialect.cells(line.rstrip(" \t,;")))
        for line in lines
        if dialect.has_samples(line, labels)
    )
    width, count = counts.most_common(1)[0] if counts else (0, 0)
    return count / max(len(lines), 1), width


def first_samples(lines: Sequence[str], dialect: Dialect) -> int:
    """Return the number of the first line with samples, counted from 0.

    It has as many cells as most; a line of a word and an amount, as in a recipe, counts only where
    each line of samples begins with a word.
    """
    filled = [line for line in lines if line.strip()]
    some = filled[:: max(1, len(filled) // SAMPLE)]
    plain, worded = (_score(dialect, some, labels) for labels in (False, True))
    labels = plain[0] < 0.5 * worded[0]
    width = worded[1] if labels else plain[1]
    for exact in (True, False):
        for at, line in enumerate(lines):
            if dialect.has_samples(line, labels):
                cells = dialect.cells(line.rstrip(" \t,;"))
                if len(cells) == width or not exact:
                    return at
    return 0


def _settle(
    path: object,
    near: list[Dialect],
    scores: Mapping[Dialect, tuple[float, int]],
    lines: Sequence[str],
    labels: bool,
    layout: TextLayout,
) -> Dialect:
    """Return the one of several good readings that the file supports, or refuse to choose."""
    near = [each for each in near if each.separator != " "] if _has_dates(near, lines) else near
    width = {each: scores[each][1] for each in near}
    widest = [each for each in near if width[each] == max(width.values())]
    # thousands are grouped, if only so most lines are samples
    first = max(widest, key=lambda each: scores[each][0])
    groups = first.groups and scores[first] > scores[first._replace(groups=False)]
    chosen = min(
        (each for each in widest if each.groups == groups), key=lambda each: each.decimal != "."
    )
    headed = _header_width(chosen, lines, labels)
    samples = next(line for line in lines if chosen.has_samples(line, labels)).strip()
    # '0,5' is one number, or two integers: the first line tells how many columns there are
    commas = [each for each in near if each.decimal == "," and width[each] < width[chosen]]
    rows = [chosen.cells(line) for line in lines if chosen.has_samples(line, labels)]
    points = all(any("." in x and chosen.is_number(x) for x in cells) for cells in rows)
    if chosen.separator == "," and layout.decimal is None:
        if commas and headed == width[commas[0]]:
            return commas[0]
        half = not points and layout.columns <= headed and 2 * headed == width[chosen]
        if (commas and headed != width[chosen]) or half:
            raise UnclearCommas(
                f"{path}: in {samples[:60]!r} commas separate {width[chosen]} columns, or are "
                "decimal signs",
                f"if they separate, say {Suggestion('decimal', 'point')}; if not, "
                f"{_remedy(commas)}",
            )
    if layout.decimal is None and not chosen.groups:
        _refuse_thousands(path, chosen, rows)
    return chosen


def _has_dates(near: Sequence[Dialect], lines: Sequence[str]) -> bool:
    """Return whether a cell between other signs than spaces is a date, a space and a clock."""
    cells = (x for each in near if each.separator != " " for y in lines for x in each.cells(y))
    return any(" " in x and CLOCK.fullmatch(x) is not None for x in cells)


def _refuse_thousands(path: object, dialect: Dialect, rows: Sequence[Sequence[str]]) -> None:
    """Refuse numbers whose decimal sign may group thousands: all have three digits after it.

    Of points that is so in a column that has hundreds without any, too, as `998` beside `1.009`,
    and where semicolons separate columns: where commas are decimal signs.
    """
    sign = dialect.decimal
    name, other = ("comma", "point") if sign == "," else ("point", "comma")
    columns = [[*column] for column in zip_longest(*rows, fillvalue="")]
    everywhere = sign == "," or dialect.separator == ";"
    for column in [[cell for cells in columns for cell in cells], *columns]:
        cells = [cell for cell in column if sign in cell]
        hundreds = sum(HUNDREDS.fullmatch(cell) is not None for cell in column)
        bare = not everywhere and hundreds < THOUSANDTHS * len(column)
        everywhere = False
        if cells and not bare and all(GROUPED.fullmatch(cell) for cell in cells):
            raise UnclearCommas(
                f"{path}: in {echo(cells[0])} the {name} is a decimal sign, or groups thousands",
                f"say {Suggestion('decimal', name)} or {Suggestion('decimal', other)}",
            )


def _remedy(commas: list[Dialect]) -> str:
    """Return the remedy for commas as decimal signs."""
    if commas:
        return f"say {Suggestion('decimal', 'comma')}"
    return "write the file with semicolons between columns: here commas do both"


def _header_width(dialect: Dialect, lines: Sequence[str], labels: bool) -> int:
    """Return the number of cells in the line before the first samples; 0 if there is none."""
    for before, line in pairwise(lines):
        if dialect.has_samples(line, labels) and not dialect.has_samples(before, labels):
            return len(dialect.cells(before.rstrip(" \t,;")))
    return 0


def _no_samples(path: object, filled: Sequence[str]) -> str:
    if not filled:
        return f"{path}: has only empty lines; record it again"
    return f"{path}: no line has samples; the first is {filled[0].strip()[:60]!r}"


def is_date_and_clock(date: str, clock: str) -> bool:
    """Return whether two cells are the date and the time of day of one instant.

    >>> is_date_and_clock("12.03.2024", "10:15:00.5"), is_date_and_clock("2.5", "10:15:00.5")
    (True, False)
    """
    return DATE.fullmatch(date) is not None and CLOCK.fullmatch(clock) is not None


def seconds_of(cells: Sequence[object]) -> Floats | None:
    """Return times of day, perhaps with dates, as seconds; NaN where a cell is missing.

    None if some cell is neither. Only differences mean anything. The order of day and month in a
    date does not matter: a change of date counts as midnight.
    """
    found = np.full(len(cells), np.nan)
    days, last, day = 0.0, -np.inf, ""
    for at, cell in enumerate(cells):
        text = str(cell).strip()
        if text.lower() in MISSING:
            continue
        time = CLOCK.fullmatch(text)
        if time is None:
            return None
        date, value = time["date"] or "", _since_midnight(time)
        midnight = date != day if date else value + days < last - HALF_A_DAY
        days += 86400.0 if midnight and last > -np.inf else 0.0
        last = found[at] = value + days
        day = date
    return found if np.isfinite(last) else None


def _since_midnight(time: re.Match[str]) -> float:
    """Return a time of day as seconds, less its offset from universal time."""
    parts = [float(each.replace(",", ".")) for each in time["clock"].split(":")]
    parts = [0.0, *parts] if re.fullmatch(MINUTES, time["clock"]) else parts
    if half := time["half"]:
        parts[0] = parts[0] % 12.0 + (12.0 if half in "Pp" else 0.0)
    offset = (time["offset"] or "+0000").replace(":", "")
    ahead = float(f"{offset[0]}1") * (3600.0 * float(offset[1:3]) + 60.0 * float(offset[3:5]))
    return sum(x * y for x, y in zip(parts, (3600.0, 60.0, 1.0), strict=False)) - ahead
