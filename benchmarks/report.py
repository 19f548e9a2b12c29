"""The table of a benchmark run: on the terminal, as Markdown, as JSON."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

from rich import box
from rich.console import Console
from rich.table import Table

from .accuracy import beside_published
from .result import Row, environment, ratios

HEADINGS = (
    "solver",
    "settings",
    "median (ms)",
    "min (ms)",
    "runs",
    "error k_x u_x (N)",
    "error k_y u_y (N)",
    "rel. error u_x(5 s)",
)
NOTES = (
    "Times are of whole calls without output samples, unless the row says otherwise; errors are the"
    " largest on a 1 ms grid over 5 s, from runs of the same settings sampled there.",
    "The reference is stiction at rtol=1e-11.",
)


def cells(row: Row) -> tuple[str, ...]:
    """Return a row as text, one cell a heading."""
    if not row.times or row.accuracy is None:
        return (row.solver, row.settings, row.note, *[""] * 5)
    return (
        row.solver,
        row.settings,
        f"{1e3 * row.median:.1f}",
        f"{1e3 * min(row.times):.1f}",
        str(len(row.times)),
        *(f"{error:.1e}" for error in row.accuracy),
    )


def sentences(rows: Sequence[Row], reference) -> list[str]:
    """Return what the table does not say: its terms, the reference's standing, the ratios."""
    u_x, u_y = beside_published(reference)
    standing = (
        "The reference beside the published values: relative deviation"
        f" {u_x:.1e} of u_x(5 s), {u_y:.1e} of u_y(5 s)."
    )
    compared = [
        f"{item.peer.solver} ({item.peer.settings}) takes {item.ratio:.1f} times as long as"
        f" {item.ours.solver} ({item.ours.settings}), which is at least as accurate in both forces."
        for item in ratios(rows)
    ]
    return [*NOTES, standing, *compared]


def show(console: Console, rows: Sequence[Row], reference) -> None:
    """Print the table and what belongs to it."""
    table = Table(*HEADINGS, box=box.SIMPLE)
    for row in rows:
        table.add_row(*cells(row))
    console.print(table)
    for sentence in sentences(rows, reference):
        console.print(f"- {sentence}", highlight=False)


def markdown(rows: Sequence[Row], reference) -> str:
    """Return the table and what belongs to it as Markdown."""
    lines = [HEADINGS, ("---",) * len(HEADINGS), *map(cells, rows)]
    table = "\n".join(f"| {' | '.join(line)} |" for line in lines)
    points = "\n".join(f"- {sentence}" for sentence in sentences(rows, reference))
    where = ", ".join(f"{name} {value}" for name, value in environment().items())
    return f"{table}\n\n{points}\n- {where}\n"


def save(directory: Path, rows: Sequence[Row], reference) -> None:
    """Write ``benchmark.md`` and ``benchmark.json`` into `directory`, making it if need be."""
    directory.mkdir(parents=True, exist_ok=True)
    (directory / "benchmark.md").write_text(markdown(rows, reference), encoding="utf-8")
    content = {
        "environment": environment(),
        "reference_beside_published": dict(
            zip(("u_x", "u_y"), beside_published(reference), strict=True)
        ),
        "rows": [
            row._asdict() | {"accuracy": row.accuracy._asdict() if row.accuracy else None}
            for row in rows
        ],
        "ratios": [
            {"peer": r.peer[:2], "ours": r.ours[:2], "ratio": r.ratio} for r in ratios(rows)
        ],
    }
    text = json.dumps(content, indent=2)
    (directory / "benchmark.json").write_text(text + "\n", encoding="utf-8")
