"""Sections of sentences and tables in the terminal."""

from __future__ import annotations

from collections.abc import Iterable
from io import StringIO
from textwrap import wrap

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.padding import Padding
from rich.table import Table as Grid
from rich.text import Text

from stiction.errors import visible
from stiction.text.sections import Section, Table, join_units

WIDE = 100  # letters in a line of a file
LONGEST_WORD = 24  # letters of the longest unbroken word


def print_sections(title: str, parts: Iterable[Section], console: Console | None = None) -> None:
    """Print sections below a title."""
    console = console or Console(highlight=False, emoji=False)
    console.print(plain(title, style="bold"))
    for part in parts:
        console.print()
        console.print(plain(part.title, style="bold"))
        for sentence in part.sentences:
            console.print(Padding(in_lines(sentence, console.width - 2), (0, 0, 0, 2)))
        if part.table is not None:
            console.print(table(part.table, console.width))


def as_file(title: str, parts: Iterable[Section]) -> str:
    """Return sections below a title as they stand in a terminal, for a text file."""
    text = StringIO()
    print_sections(title, parts, Console(file=text, width=WIDE, highlight=False, emoji=False))
    return "".join(f"{line.rstrip()}\n" for line in text.getvalue().splitlines())


def plain(text: str, style: str = "") -> Text:
    """Return a text with control characters escaped."""
    return Text(visible(text), style=style)


def in_lines(text: str, width: int | None) -> Text:
    """Return a text in lines that do not part a number from its unit; as it is without a width.

    >>> in_lines("It takes 20 mN s/m and 15 ms.", 19).plain.splitlines()
    ['It takes 20 mN s/m', 'and 15 ms.']
    """
    if width is None:
        return plain(text)
    broken = wrap(join_units(visible(text)), width, break_on_hyphens=False)
    return Text("\n".join(broken).replace("\N{NO-BREAK SPACE}", " "))


def table(found: Table, room: int = 80) -> Grid:
    """Return a table for the terminal, as wide as its text or the available `room`.

    One that is too wide is turned, with a column for each of its rows.
    """
    wide = widths(found, room)
    if None in wide and len(wide) > 2:
        other = transpose(found)
        fits = len(found.rows) > 1 and None not in widths(other, room)
        return table(other, room) if fits else cells_in_lines(found, room)
    shown = Grid(box=SIMPLE_HEAD, header_style="bold", padding=(0, 1, 0, 0), pad_edge=False)
    for heading, side, width in zip(found.headings, found.sides(), wide, strict=True):
        shown.add_column(in_lines(heading, width), justify=side, overflow="fold", width=width)
    for row in found.rows:
        shown.add_row(*map(in_lines, row, wide))
    return shown


def cells_in_lines(found: Table, room: int) -> Grid:
    """Return a table too wide for the terminal with one cell a line, a rule after each row."""
    shown = Grid(box=SIMPLE_HEAD, show_header=False, padding=(0, 1, 0, 0), pad_edge=False)
    shown.add_column(style="bold")
    shown.add_column(overflow="fold")
    beside = room - 5 - max(map(len, found.headings))  # rules, padding and a heading
    for row in found.rows:
        width = beside if narrowest(row) <= beside else None
        for heading, cell in zip(found.headings, row, strict=True):
            shown.add_row(plain(heading), in_lines(cell, width))
        shown.add_section()
    return shown


def transpose(found: Table) -> Table:
    """Return a table whose rows are the columns of another."""
    headings, *rows = zip(found.headings, *found.rows, strict=True)
    return Table(headings, rows)


def widths(found: Table, room: int) -> list[int | None]:
    """Return the widths of a table's columns in letters; None if words must be broken too."""
    columns = list(zip(found.headings, *found.rows, strict=True))
    room -= 1 + 2 * len(columns)  # rules and padding take the rest
    least = [narrowest(cells) for cells in columns]
    wanted = [max(map(len, cells), default=0) for cells in columns]
    if sum(least) > room:
        return [None for _ in columns]  # words must be broken too
    widest = max(wanted, default=0)
    while True:  # the widest columns give way first
        tried = [max(low, min(high, widest)) for low, high in zip(least, wanted, strict=True)]
        if sum(tried) <= room:
            return [*tried]
        widest -= 1


def narrowest(cells: Iterable[str]) -> int:
    """Return the least width at which cells break between words only, if these are not long.

    A number and its unit are one word.
    """
    words = (word for text in cells for word in join_units(text).split(" "))
    return min(max(map(len, words), default=0), LONGEST_WORD)
