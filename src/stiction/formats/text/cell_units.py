"""Units that stand behind each number of a text file: 0.01 s;1.2 N."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from functools import lru_cache
from itertools import islice
from math import isclose
from typing import NamedTuple

from stiction.errors import ResultError
from stiction.formats.text.dialect import MISSING, SAMPLE, Dialect
from stiction.formats.units import is_electric, is_unit, size_of, spell
from stiction.text.quantity.unit import UnitError, factor

NUMBER = r"[+−-]?(?:\d+(?:[.,]\d*)?|[.,]\d+)(?:[eE][+-]?\d+)?"
# powers have a sign, ^ or small digits: 1.5D-3 is a number
NAME = r"(?:°?[^\W\d_]+|°)(?:\^[+-]?\d|⁻?[¹²³⁴])?"
UNIT = rf"(?:%|(?:1/)?{NAME}(?:[/*·⋅]{NAME})*)"
CELL = re.compile(rf'(^|(?<=[\t;,|]))(\s*"?{NUMBER})\s*({UNIT})("?\s*)(?=$|[\t;,|])')
MARK = re.compile(r"[\t;,|]")  # between cells
OFTEN = 0.5  # of the lines that begin with a number, or of the numbers of a column
KINDS = ("s", "N", "m", "m/s")  # of which a column has one unit


class CellUnit(NamedTuple):
    """The unit behind the numbers of a column, and the first line that has it."""

    name: str
    line: int


def without_units(lines: Sequence[str]) -> Sequence[str]:
    """Return lines without the units behind their numbers; as they are if few have any.

    Examples
    --------
    >>> without_units(["time;force", "0.01 s;1.2 N", "0.02 s;1.3 N", "12:01 PM;1.2"])
    ['time;force', '0.01;1.2', '0.02;1.3', '12:01 PM;1.2']
    >>> without_units(["time;force;state", "12:00:01;1.2 N;run", "12:00:02;OVERLOAD;5 boxes"])
    ['time;force;state', '12:00:01;1.2 N;run', '12:00:02;OVERLOAD;5 boxes']
    >>> without_units(["12:00:01;1.2 N/m^2;run;45 %"])
    ['12:00:01;1.2;run;45']
    """
    some = [*islice((x for x in lines if x.strip(' \t"+−-.,')[:1].isdigit()), SAMPLE)]
    if sum(_bare(line) != line for line in some) <= OFTEN * len(some):
        return lines
    return [_bare(line) for line in lines]


def _bare(line: str) -> str:
    """Return a line that begins with a number, or a missing one, without units behind numbers."""
    bare = CELL.sub(lambda x: x[1] + x[2] + x[4] if _is_unit(x[3]) else x[0], line)
    if bare == line or line.strip(' \t"+−-.,')[:1].isdigit():
        return bare
    first = MARK.split(line, maxsplit=1)[0]
    return bare if first.strip(' "').lower() in MISSING else line


@lru_cache(maxsize=1024)
def _is_unit(text: str) -> bool:
    return is_unit(text)


def units_of(path: object, lines: Sequence[str], dialect: Dialect) -> dict[int, CellUnit]:
    """Return the unit behind the numbers of each column, where they have one, by its place.

    Raises
    ------
    ResultError
        If a column has several: a load cell that changes its range, say; or most numbers of a
        column have none.
    """
    found: dict[int, dict[str, CellUnit]] = {}
    more: Counter[int] = Counter()  # numbers with a unit than without
    for line, text in enumerate(lines, 1):
        if _bare(text) != text:
            for at, cell in enumerate(dialect.cells(text)):
                if (unit := CELL.fullmatch(cell)) and _is_unit(unit[3]):
                    name = spell(unit[3])
                    found.setdefault(at, {}).setdefault(name, CellUnit(name, line))
                    more[at] += 1
                elif dialect.is_number(cell):
                    more[at] -= 1
    for at, units in found.items():
        first, *others = units.values()
        if more[at] < 0:
            raise ResultError(
                f"{path}: line {first.line}, column {at + 1}: has {first.name} behind its number, "
                "most others have none; write it behind all or none"
            )
        if any(conflict(first.name, each.name) for each in others):
            raise ResultError(
                f"{path}: column {at + 1} is in {' and in '.join(units)}; write it in one unit"
            )
    return {at: next(iter(units.values())) for at, units in found.items()}


@lru_cache(maxsize=1024)
def conflict(one: str, other: str) -> bool:
    """Return whether two units of a column differ in size, or in dimension where that matters.

    Examples
    --------
    >>> conflict("N", "mN"), conflict("V", "mV"), conflict("N", "s"), conflict("kPa", "MPa")
    (True, True, True, True)
    >>> conflict("sec", "s"), conflict("g", "gf"), conflict("µm", "um"), conflict("C", "°C")
    (False, False, False, False)
    """
    if spell(one) == spell(other):
        return False
    for kind in KINDS:
        sizes = [size_of(each, kind) for each in (one, other)]
        if sizes[0] and sizes[1]:
            return not isclose(sizes[0].value, sizes[1].value, rel_tol=1e-9)
        if any(sizes):
            return True
    if is_electric(one) and is_electric(other):
        return _ratio(one, other) != 1.0
    return differ_in_size(one, other)


def differ_in_size(one: str, other: str) -> bool:
    """Return whether two units are of one dimension, but not of one size.

    Examples
    --------
    >>> differ_in_size("N", "mN"), differ_in_size("N", "N"), differ_in_size("A", "V")
    (True, False, False)
    """
    return _ratio(one, other) not in (1.0, None)


def _ratio(one: str, other: str) -> float | None:
    """Return how many of one unit another is, None if they are not of one dimension."""
    try:
        size = factor(spell(one), spell(other))
    except UnitError:
        return None
    return size if size is None or not isclose(size, 1.0, rel_tol=1e-9) else 1.0
