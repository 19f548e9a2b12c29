"""Work against precision on the paper's case, for our solver and its peers."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import ExitStack
from multiprocessing import get_context
from statistics import median

from rich.progress import Progress

from benchmarks.harness.contest import contest
from benchmarks.harness.library import Library
from benchmarks.harness.row import Row, failures, matches, verdict
from benchmarks.precision import levels
from benchmarks.precision.case import GRID, spring_force
from benchmarks.precision.figure import figure
from benchmarks.precision.peers import PEERS
from benchmarks.precision.peers.ours import compile_rows
from benchmarks.precision.reference import RTOL, Reference, largest, reference
from benchmarks.section import Cell, Section, Table

HEADINGS = (
    "solver",
    "settings",
    "shortest (ms)",
    "median (ms)",
    "runs",
    "k_x u_x (N)",
    "k_y u_y (N)",
    "times as long as stiction",
    "with",
)
TERMS = (
    "Errors: largest on a 1 ms grid over 5 s. Times: of whole calls without samples, compiled"
    " before, in rounds, in each of which runs are repeated for 20 ms; one that takes longer than"
    " 1.5 s is timed once, with its samples.",
    "Times as long as stiction: the shortest time beside that of the fastest row of stiction that"
    " is at least as accurate in both forces, which is named.",
)


def run(progress: Progress, quick: bool) -> Section:
    """Compare everyone; the quick version gives a run 3 s at most."""
    limit = 3.0 if quick else 45.0
    with ExitStack() as stack:
        libraries = []
        for module, name, interpreter in PEERS:
            library = Library(f"{__package__}.peers.{module}", name, interpreter, limit)
            stack.callback(library.end)
            libraries.append(library)
        task = progress.add_task("reference, and the twin beside it", total=1)
        with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as beside:
            compiling = beside.submit(compile_rows)  # while the twin takes its time on another core
            known = reference()
            compiling.result()
        progress.advance(task)
        rows = contest(
            libraries,
            lambda found: largest(spring_force(found), known.force),
            progress,
            times=GRID,
            repeats=3 if quick else 4,
            budget=1.0 if quick else 1.5,
            seconds=90.0 if quick else 190.0,
        )
    return Section(
        "Work-precision diagram",
        [levels.table(rows), Table("All rows", HEADINGS, lines(rows))],
        [*verdict(rows), *TERMS, *standing(known, rows), *failures(rows)],
        {"work-precision": figure(rows)},
    )


def lines(rows: Sequence[Row]) -> list[tuple[Cell, ...]]:
    """Return the rows as cells."""
    found = {id(match.peer): match for match in matches(rows)}
    table: list[tuple[Cell, ...]] = []
    for row in rows:
        if row.errors is None:
            note = row.note.partition(":")[0]
            table.append((row.solver, row.settings, note, *[None] * (len(HEADINGS) - 3)))
            continue
        match = found.get(id(row))
        times = 1e3 * row.seconds, 1e3 * median(row.times), len(row.times)
        beside = (match.ratio, match.ours.settings if match.ours else "none") if match else ("", "")
        table.append((row.solver, row.settings, *times, *row.errors, *beside))
    return table


def standing(known: Reference, rows: Sequence[Row]) -> list[str]:
    """Say how far the reference can be trusted."""
    peers = [row for row in rows if row.errors is not None and not row.is_ours]
    said = [
        f"The reference is stiction at rtol={RTOL:g}; at ten times that it differs by"
        f" {known.looser.x:.1e} N in k_x u_x and {known.looser.y:.1e} N in k_y u_y, and the"
        f" independent twin, over short windows, by {known.twin.x:.1e} N and {known.twin.y:.1e} N.",
        f"Beside the published values it deviates by {known.published[0]:.1e} of u_x(5 s) and"
        f" {known.published[1]:.1e} of u_y(5 s).",
    ]
    if peers:
        best = min(peers, key=lambda row: row.errors.y if row.errors else 0.0)
        assert best.errors is not None
        said.append(
            f"The peer that comes closest to it over the whole 5 s, {best.solver}"
            f" ({best.settings}), differs by {best.errors.x:.1e} N and {best.errors.y:.1e} N."
        )
    return said
