"""The multiscale mode beside the solver in steps, over short and long runs.

The paper's case at a bound of the error of k_x u_x: of either the fastest row that keeps it.
"""

from __future__ import annotations

from functools import partial
from math import inf
from typing import NamedTuple

import numpy as np
from rich.progress import Progress

from benchmarks.harness.contestant import rows
from benchmarks.harness.rounds import round_robin
from benchmarks.harness.row import Errors, Row, fastest
from benchmarks.harness.worker import time_contestant
from benchmarks.precision.case import spring_force
from benchmarks.precision.peers.ours import MULTISCALE, SOLVER, solve
from benchmarks.precision.reference import largest
from benchmarks.section import Cell, Section, Table

DURATIONS = (5.0, 10.0, 20.0, 50.0)  # s
BOUND = Errors(1e-3, inf)  # N
RTOL = (1e-2, 4e-3, 3e-3, 1e-3, 3e-4, 1e-4)
REFERENCE = 1e-11  # its rtol
ROUNDS = 5
HEADINGS = (
    "duration (s)",
    "stiction",
    "(ms)",
    "k_x u_x (N)",
    "k_y u_y (N)",
    "multiscale",
    "(ms)",
    "k_x u_x (N)",
    "k_y u_y (N)",
    "ratio",
)
NOTES = (
    f"The fastest row of each within {BOUND.x:g} N in k_x u_x on a 1 ms grid, beside rtol ="
    f" {REFERENCE:g}; rtol is one of {', '.join(f'{rtol:g}' for rtol in RTOL)}.",
)


class Pair(NamedTuple):
    """The fastest rows within the bound over `duration` (s), None where there is none."""

    duration: float
    full: Row | None
    multiscale: Row | None


def run(progress: Progress, quick: bool) -> Section:
    """Compare the two; the quick version only over the two shortest runs."""
    durations = DURATIONS[:2] if quick else DURATIONS
    task = progress.add_task("multiscale", total=len(durations))
    pairs = []
    for duration in durations:
        pairs.append(compare_rows(duration))
        progress.advance(task)
    lines = [line(pair) for pair in pairs]
    return Section(
        "Multiscale mode",
        [Table("On the paper's case, beside every cycle in steps", HEADINGS, lines)],
        NOTES,
    )


def compare_rows(duration: float) -> Pair:
    """Time all rows in rounds and return the fastest two."""
    contestants = [
        *rows(SOLVER, solve, [{"rtol": rtol} for rtol in RTOL]),
        *rows(MULTISCALE, solve, [{"rtol": rtol, "multiscale": True} for rtol in RTOL]),
    ]
    grid, ends = np.linspace(0.0, duration, round(1e3 * duration) + 1), np.array([0.0, duration])
    known = spring_force(solve(grid, rtol=REFERENCE))
    errors = [largest(spring_force(each.solve(grid)), known) for each in contestants]
    measures = [partial(time_contestant, each, ends, None) for each in contestants]
    times = round_robin(measures, repeats=ROUNDS, budget=inf)
    found = [
        Row(each.solver, each.settings, own, error)
        for each, own, error in zip(contestants, times, errors, strict=True)
    ]
    full, many = ([row for row in found if row.solver == name] for name in (SOLVER, MULTISCALE))
    return Pair(duration, fastest(full, BOUND), fastest(many, BOUND))


def line(pair: Pair) -> tuple[Cell, ...]:
    """Return a pair as cells."""
    cells: tuple[Cell, ...] = (pair.duration,)
    for row in (pair.full, pair.multiscale):
        if row is None or row.errors is None:
            cells += ("none", None, None, None)
        else:
            cells += (row.settings, 1e3 * row.seconds, *row.errors)
    if pair.full is None or pair.multiscale is None:
        return (*cells, None)
    return (*cells, pair.full.seconds / pair.multiscale.seconds)
