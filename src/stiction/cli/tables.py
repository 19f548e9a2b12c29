"""Sections of sentences and tables in the terminal."""

from __future__ import annotations

from collections.abc import Iterable

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.padding import Padding
from rich.table import Table as Grid
from rich.text import Text

from stiction.sections import Section, Table


def printed(title: str, parts: Iterable[Section]) -> None:
    """Print sections below a title."""
    console = Console(highlight=False)
    console.print(Text(title, style="bold"))
    for part in parts:
        console.print()
        console.print(Text(part.title, style="bold"))
        for sentence in part.sentences:
            console.print(Padding(Text(sentence), (0, 0, 0, 2)))
        if part.table is not None:
            console.print(table(part.table))


def table(found: Table) -> Grid:
    """Return a table for the terminal."""
    shown = Grid(box=SIMPLE_HEAD, header_style="bold", padding=(0, 1, 0, 0), pad_edge=False)
    for at, heading in enumerate(found.headings):
        numbers = all(number(row[at]) for row in found.rows)
        shown.add_column(
            heading,
            justify="right" if numbers else "left",
            overflow="fold",
            min_width=max(map(len, heading.split()), default=0),  # headings break between words
        )
    for row in found.rows:
        shown.add_row(*(Text(cell) for cell in row))
    return shown


def number(text: str) -> bool:
    """Return whether a cell is a bare number, or stands for one that is not known."""
    try:
        float(text)
    except ValueError:
        return text == "none"
    return True
