"""A table of named columns, which every reader of a file returns before any interpretation."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from stiction.arrays import Floats, Indices


class Remark(NamedTuple):
    """A line of a file that holds no samples: its number and its text."""

    line: int
    text: str


@dataclass(frozen=True, eq=False)
class FileColumn:
    """One column of a file.

    Parameters
    ----------
    name : str
        As the file has it, without the unit.
    values : ndarray
        (n,), in the file's unit; NaN where a value is missing.
    number : int
        Its place in the file, from 1.
    unit : str
        As the file states it; '' if it states none.
    clock : ndarray or None
        (n,), s: the column's own times, where each channel has its own.
    """

    name: str
    values: Floats
    number: int
    unit: str = ""
    clock: Floats | None = None

    def __str__(self) -> str:
        """Return number, name and unit, for messages."""
        return f"{self.number} {self.heading!r}"

    @property
    def heading(self) -> str:
        """The name with its unit, as in a file's first line."""
        return f"{self.name} [{self.unit}]" if self.unit else self.name


@dataclass(frozen=True, eq=False)
class FileTable:
    """Columns of one length, and the file's statements about them.

    Parameters
    ----------
    columns : tuple of FileColumn
        In the order of the file.
    format : str
        The kind of file, in words.
    label : str
        The name of the group, variable or step.
    remarks : tuple of Remark
        Lines before and among the samples.
    lines : ndarray or None
        (n,), the line of each row.
    notes : tuple of str
        Sentences on what was skipped.
    promised : int or None
        Number of samples that the file states.
    start : str
        Wall-clock time of the first sample, as the file states it.
    labels : tuple
        Columns of words: the name and the texts, (n,), of each.
    """

    columns: tuple[FileColumn, ...]
    format: str
    label: str = ""
    remarks: tuple[Remark, ...] = ()
    lines: Indices | None = None
    notes: tuple[str, ...] = ()
    promised: int | None = None
    start: str = ""
    labels: tuple[tuple[str, NDArray[np.object_]], ...] = ()

    def __len__(self) -> int:
        """Return the number of rows."""
        return len(self.columns[0].values) if self.columns else 0

    def line(self, row: int) -> str:
        """Return the place of a row, for messages."""
        return f"row {row + 1}" if self.lines is None else f"line {int(self.lines[row])}"


def number_of(number: int, name: str) -> str:
    """Return a number of things in words.

    Examples
    --------
    >>> number_of(1, "line"), number_of(3, "line")
    ('1 line', '3 lines')
    """
    return f"{number} {name}" if number == 1 else f"{number} {name}s"


def natural_key(name: str) -> tuple[tuple[int, int, str], ...]:
    """Return a key that sorts names by the numbers in them: step 4 before step 10.

    Examples
    --------
    >>> sorted(["10", "13", "4", "7"], key=natural_key)
    ['4', '7', '10', '13']
    """
    parts = re.findall(r"\d+|\D+", name)
    return tuple((0, int(x), "") if x.isdecimal() else (1, 0, x.lower()) for x in parts)
