"""The multiscale mode beside the solver in steps, over short and long runs.

The paper's case at a bound of the error of k_x u_x: of either the fastest row that keeps it. With
samples the other force has a bound too, and they are timed, but not their labels.
"""

from __future__ import annotations

from functools import partial
from math import inf
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from rich.progress import Progress

import stiction as st
from benchmarks.harness.contestant import rows
from benchmarks.harness.rounds import round_robin
from benchmarks.harness.row import Errors, Row, fastest
from benchmarks.harness.worker import time_contestant
from benchmarks.precision.case import PHI, spring_force
from benchmarks.precision.peers.ours import MULTISCALE, SOLVER, slider, solve
from benchmarks.precision.reference import largest
from benchmarks.section import Cell, Section, Table
from stiction.simulation import solve as solve_description

DURATIONS = (5.0, 10.0, 20.0, 50.0)  # s
BOUND = Errors(1e-3, inf)  # N
RTOL = (1e-2, 4e-3, 3e-3, 1e-3, 3e-4, 1e-4)
SAMPLED = ((5.0, 1e3), (5.0, 10e3), (50.0, 1e3))  # s and Hz
BOTH = Errors(1e-3, 1e-2)  # N
FINER = (3e-5, 1e-5, 3e-6, 1e-6)
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
    f"With samples: within {BOTH.x:g} N in k_x u_x and {BOTH.y:g} N in k_y u_y, at rtol down to"
    f" {FINER[-1]:g}. Runs are timed with their samples, without labels.",
)


class Pair(NamedTuple):
    """The fastest rows within the bound over `duration` (s), None where there is none."""

    duration: float
    full: Row | None
    multiscale: Row | None


def run(progress: Progress, quick: bool) -> Section:
    """Compare the two; the quick version only over the two shortest runs."""
    durations, sampled = (DURATIONS[:2], SAMPLED[:2]) if quick else (DURATIONS, SAMPLED)
    task = progress.add_task("multiscale", total=len(durations) + len(sampled))
    plain, lines = [], []
    for duration in durations:
        plain.append(line(compare_rows(duration)))
        progress.advance(task)
    for duration, rate in sampled:
        lines.append((duration, rate, *line(compare_rows(duration, rate))[1:]))
        progress.advance(task)
    headings = (HEADINGS[0], "samples (Hz)", *HEADINGS[1:])
    return Section(
        "Multiscale mode",
        [
            Table("On the paper's case, beside every cycle in steps", HEADINGS, plain),
            Table("The same with samples, at equal accuracy of both forces", headings, lines),
        ],
        NOTES,
    )


def compare_rows(duration: float, rate: float = 0.0) -> Pair:
    """Time all rows in rounds and return the fastest two, with samples if there is a rate (Hz)."""
    tolerances, bound, of = (*RTOL, *FINER), BOTH, samples
    if rate == 0.0:
        tolerances, bound, of = RTOL, BOUND, solve
    contestants = [
        *rows(SOLVER, of, [{"rtol": rtol} for rtol in tolerances]),
        *rows(MULTISCALE, of, [{"rtol": rtol, "multiscale": True} for rtol in tolerances]),
    ]
    grid, ends = np.linspace(0.0, duration, round(1e3 * duration) + 1), np.array([0.0, duration])
    known = spring_force(solve(grid, rtol=REFERENCE))
    errors = [largest(spring_force(each.solve(grid)), known) for each in contestants]
    when = ends if rate == 0.0 else np.linspace(0.0, duration, round(rate * duration) + 1)
    measures = [partial(time_contestant, each, when, None) for each in contestants]
    times = round_robin(measures, repeats=ROUNDS, budget=inf)
    found = [
        Row(each.solver, each.settings, own, error)
        for each, own, error in zip(contestants, times, errors, strict=True)
    ]
    full, many = ([row for row in found if row.solver == name] for name in (SOLVER, MULTISCALE))
    return Pair(duration, fastest(full, bound), fastest(many, bound))


def samples(
    times: NDArray[np.float64], *, multiscale: bool = False, **settings: Any
) -> NDArray[np.float64]:
    """Return the elongations (m) at some times, without labels; in steps unless asked."""
    run = st.Settings(duration=float(times[-1]), sample_rate=0.0, multiscale=multiscale, **settings)
    description = st.Description(slider(PHI), st.Initial(), run)
    return solve_description(description, times).samples[:, :2]


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
