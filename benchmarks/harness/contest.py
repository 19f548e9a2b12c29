"""Compare the rows of several libraries: errors first, then times in rounds."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import inf, isfinite
from time import perf_counter

import numpy as np
from numpy.typing import NDArray
from rich.progress import Progress

from benchmarks.harness.contestant import Failed
from benchmarks.harness.library import Library
from benchmarks.harness.rounds import round_robin
from benchmarks.harness.row import Errors, Row

FIRST = 0.7  # of the time: for errors; the rest is for rounds
LEAST = 5.0  # s; that a run may take, if it is begun
SLOW = 1.5  # s; a run that takes longer is timed once, together with its samples


def contest(
    libraries: Sequence[Library],
    compare: Callable[[NDArray[np.float64]], Errors],
    progress: Progress,
    *,
    times: NDArray[np.float64],
    repeats: int,
    budget: float,
    seconds: float,
    chosen: Callable[[str], bool] = lambda settings: True,
) -> list[Row]:
    """Return the rows of all libraries, with errors and times or with what went wrong.

    Parameters
    ----------
    libraries : sequence of Library
        Started.
    compare : callable
        Returns the errors of elongations (m) at `times`.
    progress : Progress
        Shows what is going on.
    times : ndarray
        Evenly spaced, s; where solutions are compared. Runs are timed without them.
    repeats : int
        Number of rounds.
    budget : float
        A row whose runs have taken this many seconds in all sits out the later rounds.
    seconds : float
        What all of it may take: rows are left out, and rounds, when the time is up.
    chosen : callable, optional
        Whether rows with these settings take part; by default all.
    """
    task = progress.add_task("imports", total=len(libraries))
    started: list[list[tuple[str, str]]] = []
    absent: list[Row] = []
    for library in libraries:
        try:
            started.append(library.rows())
        except Failed as reason:
            started.append([])
            absent.append(Row(library.name, "", note=str(reason)))
        progress.advance(task)
    rows: list[Row] = []
    measures: dict[int, Callable[[], float]] = {}  # of those that are to be timed, by row
    begin = perf_counter()
    ready = begin + FIRST * seconds
    for i, (library, own) in enumerate(zip(libraries, started, strict=True)):
        if not own:
            continue
        task = progress.add_task(f"accuracy: {library.name}", total=len(own))
        # The first is what all are compared with. The others have equal shares of what is left,
        # so that a slow library takes nothing from the next.
        share = (ready - perf_counter()) / (len(libraries) - i if i else 1)
        until = perf_counter() + share
        for number, (solver, settings) in enumerate(own):
            progress.advance(task)
            if not chosen(settings):
                continue
            row = Row(solver, settings, note="left out: the time was up")
            if perf_counter() < until:
                library.limit = min(library.limit, max(LEAST, until - perf_counter()))
                row = first(library, number, Row(solver, settings), times, compare)
            if row.times and row.seconds < SLOW:
                measures[len(rows)] = timer(library, number, times[-1])
            rows.append(row)
    task = progress.add_task("timing, in rounds", total=repeats * len(measures))
    timed = round_robin(
        list(measures.values()),
        repeats=repeats,
        budget=budget,
        until=begin + seconds,
        after_each=lambda: progress.advance(task),
    )
    for number, own_times in zip(measures, timed, strict=True):
        if finite := [value for value in own_times if isfinite(value)]:
            rows[number] = rows[number]._replace(times=finite)
    return [*rows, *absent]


def first(
    library: Library,
    number: int,
    row: Row,
    times: NDArray[np.float64],
    compare: Callable[[NDArray[np.float64]], Errors],
) -> Row:
    """Return a row with its errors and the time of that one run, or with why there is none."""
    try:
        seconds, found = library.solve(number, times[-1], len(times))
    except Failed as reason:
        return row._replace(note=f"failed: {reason}")
    if not np.isfinite(found).all():
        return row._replace(note="failed: not all it returned are numbers")
    return row._replace(times=[seconds], errors=compare(found))


def timer(library: Library, number: int, duration: float) -> Callable[[], float]:
    """Return the function that times a row without samples; infinite if that fails."""

    def measure() -> float:
        try:
            return library.measure(number, duration)
        except Failed:
            return inf

    return measure
