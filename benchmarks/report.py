"""The table of a benchmark run: on the terminal, as Markdown, as JSON."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

from rich import box
from rich.console import Console
from rich.table import Table

from .accuracy import beside_published
from .ours import REFERENCE_RTOL
from .result import Row, environment, matched

HEADINGS = (
    "solver",
    "settings",
    "median (ms)",
    "min (ms)",
    "runs",
    "k_x u_x (N)",
    "k_y u_y (N)",
    "u_x(5 s)",
    "times as long as stiction",
)
WIDTH = 160  # characters; the table needs them, however narrow the terminal
NOTES = (
    "Times are of whole calls without output samples, unless the row says otherwise.",
    "`k_x u_x` and `k_y u_y`: largest error on a 1 ms grid over 5 s, from a run with the same"
    " settings sampled there; `u_x(5 s)`: relative error at the end.",
    "Last column: the median beside that of the fastest row of stiction that is at least as"
    " accurate in both forces, which is named.",
)


def cells(row: Row, rows: Sequence[Row]) -> tuple[str, ...]:
    """Return a row as text, one cell a heading."""
    if not row.times or row.accuracy is None:
        return (row.solver, row.settings, row.note.partition(":")[0], *[""] * 6)
    ours = matched(row, rows)
    return (
        row.solver,
        row.settings,
        f"{1e3 * row.median:.1f}",
        f"{1e3 * min(row.times):.1f}",
        str(len(row.times)),
        *(f"{error:.1e}" for error in row.accuracy),
        f"{row.median / ours.median:.1f} ({ours.settings})" if ours else "",
    )


def sentences(rows: Sequence[Row], reference) -> list[str]:
    """Return what the table does not say: its terms, the reference's standing, the failures."""
    u_x, u_y = beside_published(reference)
    standing = (
        f"The reference is stiction at rtol={REFERENCE_RTOL:g}; beside the published values it"
        f" deviates by {u_x:.1e} of u_x(5 s) and {u_y:.1e} of u_y(5 s)."
    )
    failures = [
        f"{row.solver} ({row.settings}) {row.note}" for row in rows if row.note.startswith("failed")
    ]
    return [*NOTES, standing, *failures]


def show(console: Console, rows: Sequence[Row], reference) -> None:
    """Print the table and what belongs to it."""
    table = Table(*HEADINGS, box=box.SIMPLE)
    for row in rows:
        table.add_row(*cells(row, rows))
    console.width = max(console.width, WIDTH)
    console.print(table)
    for sentence in sentences(rows, reference):
        console.print(f"- {sentence}", highlight=False)


def markdown(rows: Sequence[Row], reference) -> str:
    """Return the table and what belongs to it as Markdown."""
    lines = [HEADINGS, ("---",) * len(HEADINGS), *(cells(row, rows) for row in rows)]
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
        "rows": [_entry(row, rows) for row in rows],
    }
    text = json.dumps(content, indent=2)
    (directory / "benchmark.json").write_text(text + "\n", encoding="utf-8")


def _entry(row: Row, rows: Sequence[Row]) -> dict[str, object]:
    ours = matched(row, rows)
    return row._asdict() | {
        "accuracy": row.accuracy._asdict() if row.accuracy else None,
        "matched": ours.settings if ours else None,
        "times_as_long": row.median / ours.median if ours else None,
    }
