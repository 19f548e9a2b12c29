"""What reports are made of, for any page or terminal: sections of sentences and tables."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple


class Table(NamedTuple):
    """Headings and rows of text."""

    headings: tuple[str, ...]
    rows: Sequence[tuple[str, ...]]


class Section(NamedTuple):
    """A part of a report: title, sentences, and a table if there is one."""

    title: str
    sentences: list[str]
    table: Table | None = None
