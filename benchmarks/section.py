"""The results of a part of the benchmark: tables, figures and sentences."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from matplotlib.figure import Figure

Cell = str | float | int | None


class Table(NamedTuple):
    """Rows of cells under headings; numbers stay numbers until they are printed."""

    title: str
    headings: tuple[str, ...]
    rows: Sequence[tuple[Cell, ...]]


class Section(NamedTuple):
    """A part of the benchmark.

    Attributes
    ----------
    title : str
        Its heading.
    tables : sequence of Table
        What was measured.
    notes : sequence of str
        What the tables do not say: terms, references, failures.
    figures : mapping
        Figures by the stem of the file they are written to.
    """

    title: str
    tables: Sequence[Table]
    notes: Sequence[str] = ()
    figures: Mapping[str, Figure] = {}
