"""The results of the benchmark: on the terminal, as Markdown, as JSON, as figures."""

from __future__ import annotations

import json
from collections.abc import Mapping
from math import isfinite
from pathlib import Path
from typing import Any

from rich import box
from rich import table as rich_table
from rich.console import Console

from benchmarks.machine import machine
from benchmarks.section import Cell, Section, Table

WIDTH = 190  # characters; the tables need them, however narrow the terminal
DPI = 160


def text(cell: Cell) -> str:
    """Return a cell as printed."""
    if cell is None:
        return ""
    if not isinstance(cell, float):
        return str(cell)
    if cell != 0.0 and not 1e-3 < abs(cell) < 1e5:
        return f"{cell:.1e}"
    return f"{cell:.0f}" if abs(cell) >= 1e3 else f"{cell:.3g}"


def show(console: Console, section: Section) -> None:
    """Print a section."""
    console.width = max(console.width, WIDTH)
    console.rule(section.title)
    for table in section.tables:
        printed = rich_table.Table(*table.headings, title=table.title, box=box.SIMPLE)
        for row in table.rows:
            printed.add_row(*map(text, row))
        console.print(printed)
    for note in section.notes:
        console.print(f"- {note}", highlight=False, markup=False)


def markdown(sections: Mapping[str, Section], seconds: float) -> str:
    """Return all sections as Markdown."""
    where = ", ".join(f"{name} {value}" for name, value in machine().items())
    pieces = ["# Benchmark", f"{where}. All of it took {seconds:.0f} s."]
    for section in sections.values():
        pieces.append(f"## {section.title}")
        pieces += [f"![{name}]({name}.png)" for name in section.figures]
        pieces += [f"### {table.title}\n\n{grid(table)}" for table in section.tables]
        pieces.append("\n".join(f"- {note}" for note in section.notes))
    return "\n\n".join(piece for piece in pieces if piece) + "\n"


def grid(table: Table) -> str:
    """Return a table as Markdown."""
    lines = [table.headings, ("---",) * len(table.headings), *(map(text, r) for r in table.rows)]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def content(sections: Mapping[str, Section], seconds: float) -> dict[str, Any]:
    """Return all sections for JSON; numbers stay numbers, those that are none become null."""
    return {
        "machine": machine(),
        "seconds": seconds,
        "sections": {
            name: {
                "title": section.title,
                "tables": [
                    {
                        "title": table.title,
                        "headings": table.headings,
                        "rows": [[plain(cell) for cell in row] for row in table.rows],
                    }
                    for table in section.tables
                ],
                "notes": list(section.notes),
                "figures": [f"{stem}.png" for stem in section.figures],
            }
            for name, section in sections.items()
        },
    }


def plain(cell: Cell) -> Cell:
    """Return a cell as JSON can hold it."""
    return None if isinstance(cell, float) and not isfinite(cell) else cell


def save(directory: Path, sections: Mapping[str, Section], seconds: float) -> None:
    """Write results.md, results.json and the figures into `directory`, making it if need be."""
    directory.mkdir(parents=True, exist_ok=True)
    (directory / "results.md").write_text(markdown(sections, seconds), encoding="utf-8")
    found = json.dumps(content(sections, seconds), indent=1, allow_nan=False)
    (directory / "results.json").write_text(found + "\n", encoding="utf-8")
    for section in sections.values():
        for stem, figure in section.figures.items():
            figure.savefig(directory / f"{stem}.png", dpi=DPI)
