"""Units that stand behind each number of a text file: 0.01 s;1.2 N."""

from __future__ import annotations

import re
from collections.abc import Sequence
from itertools import islice

from stiction.errors import ResultError
from stiction.formats.text.dialect import SAMPLE, Dialect
from stiction.formats.units import is_unit, size_of, spell

NUMBER = r"[+−-]?(?:\d+(?:[.,]\d*)?|[.,]\d+)(?:[eE][+-]?\d+)?"
UNIT = r"[^\W\d_]+(?:/[^\W\d_]+)?"
CELL = re.compile(rf'(^|(?<=[\t;,|]))(\s*"?{NUMBER})\s*({UNIT})("?\s*)(?=$|[\t;,|])')
PLAIN = re.compile(r'[\d\s.,;|"+−eE-]*')  # what remains of a line of samples
OFTEN = 0.5  # of the lines that begin with a number
KINDS = ("s", "N", "m", "m/s")  # of which a column has one unit


def without_units(lines: Sequence[str]) -> Sequence[str]:
    """Return lines without the units behind their numbers; as they are if few have any.

    Examples
    --------
    >>> without_units(["time;force", "0.01 s;1.2 N", "0.02 s;1.3 N", "12:01 PM;1.2"])
    ['time;force', '0.01;1.2', '0.02;1.3', '12:01 PM;1.2']
    """
    some = [*islice((x for x in lines if x.strip(' \t"+−-.,')[:1].isdigit()), SAMPLE)]
    found = [_bare(line) for line in some]
    if sum(bare != line for bare, line in zip(found, some, strict=True)) <= OFTEN * len(some):
        return lines
    return [_bare(line) for line in lines]


def _bare(line: str) -> str:
    """Return a line of numbers without their units; another line as it is."""
    units = {found[3] for found in CELL.finditer(line)}
    bare = CELL.sub(r"\1\2\4", line) if units and all(map(is_unit, units)) else line
    return bare if PLAIN.fullmatch(bare) else line


def units_of(path: object, lines: Sequence[str], dialect: Dialect) -> dict[int, str]:
    """Return the unit behind the numbers of each column, where they have one, by its place.

    Raises
    ------
    ResultError
        If a column has several: a load cell that changes its range, say.
    """
    found: dict[int, dict[str, None]] = {}
    for line in lines:
        if _bare(line) != line:
            for at, cell in enumerate(dialect.cells(line)):
                if unit := CELL.fullmatch(cell):
                    found.setdefault(at, {})[spell(unit[3])] = None
    for at, units in found.items():
        if len(units) > 1 and any(all(size_of(x, kind) for x in units) for kind in KINDS):
            raise ResultError(
                f"{path}: column {at + 1} is in {' and in '.join(units)}; write it in one unit"
            )
    return {at: next(iter(units)) for at, units in found.items()}
