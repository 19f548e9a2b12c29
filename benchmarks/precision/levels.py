"""The levels of accuracy, and the required ratio of speed to LSODA at each."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf
from typing import NamedTuple

from benchmarks.harness.row import Errors, Row, fastest
from benchmarks.precision.peers.ours import MULTISCALE, SOLVER
from benchmarks.section import Cell, Table

LSODA = "LSODA (numbalsoda)"
OURS = (SOLVER, MULTISCALE)


class Level(NamedTuple):
    """Bounds of the errors (N), LSODA's settings for them, and the ratio of times to reach."""

    name: str
    bounds: Errors
    settings: str
    target: float


LEVELS = (
    Level("A", Errors(1e-3, inf), "delta=1e-07, rtol=1e-06, atol=1e-09", 10.0),
    Level("B", Errors(1e-5, inf), "delta=2e-10, rtol=1e-07, atol=1e-10", 15.0),
    Level("C", Errors(1e-5, 1e-3), "delta=1e-12, rtol=1e-07, atol=1e-13", 25.0),
    Level("D", Errors(1e-6, 1e-5), "delta=5e-15, rtol=1e-10, atol=1e-16", 25.0),
)
HEADINGS = (
    "level",
    "k_x u_x within (N)",
    "k_y u_y within (N)",
    "LSODA",
    "LSODA (ms)",
    "its k_x u_x (N)",
    "its k_y u_y (N)",
    "stiction",
    "stiction (ms)",
    "ratio",
    "target",
    "reached",
)


def table(rows: Sequence[Row]) -> Table:
    """Return the levels: LSODA as given and, where another is faster or it fails, the fastest.

    Beside our solver and beside its multiscale mode.
    """
    lines: list[tuple[Cell, ...]] = []
    for level in LEVELS:
        best = fastest([row for row in rows if row.solver == LSODA], level.bounds)
        for row in rows:
            given = (row.solver, row.settings) == (LSODA, level.settings)
            if given or row is best:
                lines += [
                    line(
                        level,
                        row,
                        fastest([own for own in rows if own.solver == solver], level.bounds),
                    )
                    for solver in OURS
                ]
    return Table("Levels: how much faster than LSODA through numbalsoda", HEADINGS, lines)


def line(level: Level, lsoda: Row, ours: Row | None) -> tuple[Cell, ...]:
    """Return one line: a row of LSODA beside our fastest that keeps the level's bounds."""
    y = level.bounds.y if level.bounds.y < inf else "any"
    cells: tuple[Cell, ...] = (level.name, level.bounds.x, y, lsoda.settings)
    if lsoda.errors is None:
        cells += ("failed", None, None)
    else:
        cells += (1e3 * lsoda.seconds, *lsoda.errors)
    if ours is None:
        return (*cells, "none", None, None, level.target, "no")
    cells += (ours.settings, 1e3 * ours.seconds)
    if lsoda.errors is None:
        return (*cells, None, level.target, "")
    ratio = lsoda.seconds / ours.seconds
    return (*cells, ratio, level.target, "yes" if ratio >= level.target else "no")
