"""The header of a table in a text file: names and units, among recipes and comments."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from stiction.formats.channels import CHANNELS, LENGTH, RATIO, plain
from stiction.formats.text.dialect import Dialect
from stiction.formats.units import is_ratio, is_unit, spell, split_unit

DEPTH = 12  # lines above the samples among which a header is sought
COMMENT = re.compile(r"^\s*(#+|%+|//|\*+|!+|;+(?=\s*[A-Za-z]))\s*")
AMOUNT = re.compile(r"[+-]?\d+([.,]\d+)?\s*[^\W\d]*[./%°]?[^\W\d]*")  # 5, 5 N, 10 mm/s


@dataclass(frozen=True)
class Heading:
    """Names and units of columns; `trusted` if some name or unit is one that we know."""

    names: tuple[str, ...]
    units: tuple[str, ...]
    trusted: bool

    def of(self, at: int) -> tuple[str, str]:
        """Return name and unit of a column, counted from 0."""
        name = self.names[at] if at < len(self.names) else ""
        unit = self.units[at] if at < len(self.units) else ""
        own, inside = split_unit(name)
        if unit.strip():
            own, inside = (own if inside else name.strip()), split_unit(f"x [{unit}]")[1] or unit
        return own or f"column {at + 1}", inside


def find_heading(texts: Sequence[str], dialect: Dialect, width: int) -> Heading | None:
    """Return the header in the lines above samples of `width` columns; None if there is none.

    The best line wins by the names that it has and by its number of cells: a recipe line has
    amounts in it, a comment has fewer cells.
    """
    rows = [_cells(text, dialect, width) for text in texts[-DEPTH:]]
    scores = [_score(row, width) for row in rows]
    best = max(range(len(rows)), key=lambda at: (scores[at], at), default=None)
    if best is None:
        return None
    if scores[best] <= 0.0:
        return _unlikely(rows, width)
    units: tuple[str, ...] = ()
    below = rows[best + 1] if best + 1 < len(rows) else []
    if below and _is_units(below):
        units = tuple(below)
    trusted = any(map(_is_known, rows[best])) or bool(units)
    return Heading(tuple(rows[best]), units, trusted)


def _unlikely(rows: Sequence[Sequence[str]], width: int) -> Heading | None:
    """Return the line above samples as names though all are units too: ``a, b`` or ``ch1, ch2``."""
    names = rows[-1]
    fits = len(names) == width and all(names) and not any(map(AMOUNT.fullmatch, names))
    return Heading(tuple(names), (), trusted=False) if fits else None


def repeats(heading: Heading, text: str, dialect: Dialect) -> bool:
    """Return whether a line is the header once more."""
    return tuple(_cells(text, dialect, len(heading.names))) == heading.names


def _cells(text: str, dialect: Dialect, width: int = 0) -> list[str]:
    """Return the cells of a line; a unit belongs to the name before.

    A mark of a comment before them is left out, but where it names a column: that of numbers.
    """
    whole = text.strip().strip("\ufeff")
    cells = _split(COMMENT.sub("", whole), dialect, width)
    marked = _split(whole, dialect, width) if len(cells) == width - 1 else []
    return marked if len(marked) == width and marked[:1] == ["#"] else cells


def _split(bare: str, dialect: Dialect, width: int) -> list[str]:
    """Return the cells of a line without a mark of a comment."""
    if dialect.separator == " ":
        bare = re.sub(r"\s+(?=[\[(][^\s\])]*[\])])", "", bare)
        wide = re.split(r"\s{2,}|\t", bare)
        return wide if len(wide) == width else bare.split()
    cells = dialect.cells(bare)
    while cells and not cells[-1]:
        cells.pop()
    return cells


def _score(cells: Sequence[str], width: int) -> float:
    """Return how well cells serve as the names of columns."""
    filled = [cell for cell in cells if cell]
    if not filled or _is_units(cells) or len(cells) > 2 * width + 2:
        return 0.0
    amounts = sum(bool(AMOUNT.fullmatch(cell)) for cell in filled)
    known = sum(map(_is_known, filled))
    index = len(cells) == width and known  # without a name, as pandas writes it
    if amounts or (width > 1 and len(filled) < 2 and not index):
        return 0.0
    sentence = sum(":" in cell or "=" in cell for cell in filled)
    return known + (1.0 if len(cells) == width else 0.3) - sentence


def _is_known(cell: str) -> bool:
    """Return whether a column's name is a channel's, or has a unit."""
    name, unit = split_unit(cell)
    return bool(unit) or _is_name(name)


def _is_name(name: str) -> bool:
    """Return whether a column's name is a channel's."""
    text = plain(name)
    patterns = (RATIO, LENGTH, *(channel.names for channel in CHANNELS.values()))
    return any(pattern.fullmatch(text) for pattern in patterns)


def _is_units(cells: Sequence[str]) -> bool:
    """Return whether cells are units, as in a second line of a header.

    ``t, F`` are names, and ``t/s, F/N`` names with units, not tonnes a second and farads a newton.
    """
    filled = [cell for cell in cells if cell]
    named = all(_is_name(split_unit(cell)[0]) for cell in filled)
    if not filled or named or not all(map(is_unit, filled)):
        return False
    return not all(is_ratio(spell(cell)) for cell in filled)
