"""Time per run of an ensemble on all cores, for our solver and its peers."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack

import numpy as np
from numpy.typing import NDArray
from rich.progress import Progress

from benchmarks.ensembles.many import CORES, PHI, in_threads
from benchmarks.harness.contest import contest
from benchmarks.harness.library import Library
from benchmarks.harness.row import Errors, Match, Row, failures, fastest, matches, verdict
from benchmarks.precision.case import GRID, spring_force
from benchmarks.precision.peers.ours import solve
from benchmarks.section import Cell, Section, Table

PEERS = ("ours", "numbalsoda", "heyoka", "diffrax")
REFERENCE_RTOL = 1e-11
HEADINGS = (
    "solver",
    "settings",
    "per run (ms)",
    "worst k_x u_x (N)",
    "worst k_y u_y (N)",
    "typical k_x u_x (N)",
    "typical k_y u_y (N)",
    "times as long as stiction, worst",
    "with",
    "times as long as stiction, typical",
    "with",
)
TERMS = (
    f"{len(PHI)} runs of 5 s over phi from 0.5 to 10 deg, evenly in its logarithm, on {CORES}"
    " cores. Errors as in the work-precision diagram, from stiction at"
    f" rtol={REFERENCE_RTOL:g}: of the worst of the runs, and the median over them.",
    "Times as long as stiction: beside its fastest row that is at least as accurate in both"
    " forces, in the worst run or typically.",
)


def run(progress: Progress, quick: bool) -> Section:
    """Compare everyone; the quick version gives an ensemble 15 s at most."""
    limit = 15.0 if quick else 60.0
    task = progress.add_task("reference", total=1)
    reference = spring_force(in_threads(solve)(GRID, rtol=REFERENCE_RTOL))
    progress.advance(task)
    typical: list[Errors] = []  # of the rows that have errors, in their order

    def compare(found: NDArray[np.float64]) -> Errors:
        each = np.abs(spring_force(found) - reference).max(axis=1)
        typical.append(Errors(*map(float, np.median(each, axis=0))))
        return Errors(*map(float, each.max(axis=0)))

    with ExitStack() as stack:
        libraries = []
        for module in PEERS:
            library = Library(f"{__package__}.peers.{module}", module, limit=limit)
            stack.callback(library.end)
            libraries.append(library)
        rows = contest(
            libraries,
            compare,
            progress,
            times=GRID,
            repeats=2 if quick else 3,
            budget=2.0 if quick else 4.0,
            seconds=40.0 if quick else 140.0,
        )
    pending = iter(typical)
    usual = [row if row.errors is None else row._replace(errors=next(pending)) for row in rows]
    return Section(
        "Ensembles",
        [Table("Time per run", HEADINGS, lines(rows, usual))],
        [
            "At the accuracy of the worst run:",
            *verdict(rows),
            "At typical accuracy:",
            *verdict(usual),
            *loosest(usual),
            *TERMS,
            f"The largest spring force in any of the runs is {np.abs(reference).max():.3g} N.",
            *failures(rows),
        ],
    )


def lines(worst: Sequence[Row], usual: Sequence[Row]) -> list[tuple[Cell, ...]]:
    """Return the rows as cells; both sequences hold the same, with their two kinds of errors."""
    beside = [{id(match.peer): match for match in matches(rows)} for rows in (worst, usual)]
    table: list[tuple[Cell, ...]] = []
    for pair in zip(worst, usual, strict=True):
        row, same = pair
        if row.errors is None or same.errors is None:
            note = row.note.partition(":")[0]
            table.append((row.solver, row.settings, note, *[None] * (len(HEADINGS) - 3)))
            continue
        compared = [cell for i in (0, 1) for cell in ratio(beside[i].get(id(pair[i])))]
        each = 1e3 * row.seconds / len(PHI)
        table.append((row.solver, row.settings, each, *row.errors, *same.errors, *compared))
    return table


def ratio(match: Match | None) -> tuple[Cell, Cell]:
    """Return how a peer's row compares, and with which of ours."""
    if match is None:
        return None, None
    return match.ratio, match.ours.settings if match.ours else "none"


def loosest(rows: Sequence[Row]) -> list[str]:
    """Say how the fastest row of each peer, however inaccurate, compares with our fastest."""
    anything = Errors(float("inf"), float("inf"))
    ours = fastest([row for row in rows if row.is_ours], anything)
    said = []
    for solver in dict.fromkeys(row.solver for row in rows if row.errors and not row.is_ours):
        best = fastest([row for row in rows if row.solver == solver], anything)
        if ours and best and best.errors and ours.errors:
            said.append(
                f"The fastest row of {solver} takes {best.seconds / ours.seconds:.3g} times as"
                f" long as that of stiction; typical errors {best.errors.x:.1e} N and"
                f" {best.errors.y:.1e} N against {ours.errors.x:.1e} N and {ours.errors.y:.1e} N."
            )
    return said
