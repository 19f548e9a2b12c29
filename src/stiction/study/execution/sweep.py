"""The sweep of a study: compute its missing blocks on an engine."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from math import prod
from pathlib import Path
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np

from stiction.errors import STATUSES, DescriptionError, one_line
from stiction.own_code.source import raised_in_law
from stiction.progress.audience import with_progress
from stiction.progress.report import Progress
from stiction.solver.integrate import Room
from stiction.storage.files import folder_lock
from stiction.study.execution.cores import Cores
from stiction.study.execution.engines import Engine, refuse_other
from stiction.study.plan.layout import Index, Layout, places, runs_of, size_of
from stiction.study.plan.study import Study, study_of
from stiction.study.store.creation import create
from stiction.study.store.kept import Kept, stored_variables
from stiction.study.store.store import (
    COMPLETED,
    ENDS,
    ERROR,
    REFUSED,
    BlockResults,
    Store,
    StoreAddress,
    open_store,
)
from stiction.study.variables.observed_run import ObservedRun, observe_run
from stiction.study.variables.own import MeasureError
from stiction.study.view.summary import Summary, summary

TOO_FEW = "its motion is too fast for so long a run, a million samples do not show it; shorten it"


class Unwanted(Exception):
    """Raised in a run that is no longer wanted."""


class SharedRoom:
    """Memory for the samples of one run after another.

    New memory, page by page from the system, takes a fifteenth of a run's time.
    """

    def __init__(self) -> None:
        """Begin with none."""
        self._kept = np.empty(0)

    def __call__(self, shape: tuple[int, int]) -> np.ndarray:
        """Return an array of this shape, in place of the one before."""
        size = prod(shape)
        if size > len(self._kept):
            self._kept = np.empty(size)
        return self._kept[:size].reshape(shape)


class Came(NamedTuple):
    """The outcome of a task: the number of runs, and of failed ones."""

    runs: int
    failed: int


class StoredOutcome(NamedTuple):
    """The outcome of a run: its status, its message, and the kept values."""

    status: int
    message: str
    values: tuple[Any, ...]


def do_block(
    study: Study, address: StoreAddress, task: int, unwanted: Callable[[], bool]
) -> Came | None:
    """Do the runs of a block as `finish_block` does; None if another sweep is doing them."""
    with address.store().claim(task) as mine:
        return finish_block(study, address, task, unwanted) if mine else None


def finish_block(
    study: Study, address: StoreAddress, task: int, unwanted: Callable[[], bool]
) -> Came:
    """Do the runs of a block and write it, unless it is no longer wanted.

    A worker that outlived its client may have written it meanwhile; then it stays as it is.
    """
    study, store = study_of(study), address.store()
    region = store.layout.region(task)
    size = size_of(region)
    if store.has(region):
        return Came(runs_of(region), 0)
    status = np.full(size, COMPLETED, np.int8)
    message = np.full(size, "", object)
    wanted, room = stored_variables(study), SharedRoom()
    arrays = [np.full((*size, *each.shape), each.unknown, each.dtype) for each in wanted]
    try:
        for place, index in zip(np.ndindex(size), places(region), strict=True):
            outcome = run_one(study, wanted, index, unwanted, room)
            status[place], message[place], values = outcome
            for array, value in zip(arrays, values, strict=False):  # a failed run has no values
                array[place] = value
    except Unwanted:
        return Came(0, 0)
    if not store.has(region):
        store.write(region, BlockResults([*zip(wanted, arrays, strict=True)], status, message))
    return Came(status.size, int(np.count_nonzero(status != COMPLETED)))


def run_one(
    study: Study,
    wanted: Sequence[Kept],
    index: Index,
    unwanted: Callable[[], bool],
    room: Room = np.empty,
) -> StoredOutcome:
    """Do one run; an error in it becomes its outcome."""

    def report(_: float) -> None:
        if unwanted():
            raise Unwanted

    report(0.0)
    try:
        seen = observe_run(study.description(index), report, room)
        ended = STATUSES[seen.solution.code]
        if not ended.ok:
            return StoredOutcome(ENDS.index(ended.name.lower()), ended.value, ())
        why = "" if seen.resolved else TOO_FEW
        return values_of(wanted, seen, why)
    except (Unwanted, OSError, MemoryError):
        raise
    except DescriptionError as error:
        return StoredOutcome(REFUSED, "; ".join(map(str, error.faults)), ())
    except Exception as error:  # a user's law may raise anything
        return StoredOutcome(ERROR, raised_in_law(error) or one_line(error), ())


def values_of(wanted: Sequence[Kept], seen: ObservedRun, why: str) -> StoredOutcome:
    """Return the values to keep of a run; what a user's measure raises leaves the others."""
    values, raised = [], []
    for each in wanted:
        try:
            values.append(each.of(seen))
        except MeasureError as error:
            values.append(each.unknown)
            raised.append(str(error))
    if raised:
        return StoredOutcome(ERROR, "; ".join(raised), tuple(values))
    return StoredOutcome(COMPLETED, why, tuple(values))


class Tally(NamedTuple):
    """Progress of a study.

    Parameters
    ----------
    runs : int
        Number of runs.
    before : int
        Runs done before this sweep.
    now : int
        Runs done by this sweep.
    failed : int
        Runs that failed in this sweep.
    seconds : float
        Time since this sweep began.
    since : tuple of int and float
        Runs and seconds from which the rate is counted: compilation comes once.
    trend : float
        How much longer the latter half of these runs took than the first; NaN if that is unknown.
    pause : float
        The longest time without a run until now, s.
    """

    runs: int
    before: int
    now: int
    failed: int
    seconds: float
    since: tuple[int, float] = (0, 0.0)
    trend: float = 1.0
    pause: float = float("inf")

    @property
    def rate(self) -> float:
        """Runs per second, of late."""
        runs, seconds = self.now - self.since[0], self.seconds - self.since[1]
        return runs / seconds if seconds > 0.0 else 0.0

    @property
    def left(self) -> float:
        """Seconds left at this rate; infinite as long as that cannot be known."""
        return self.left_after(0.0)

    def left_after(self, waited: float) -> float:
        """Return the seconds left where no run has come for some time since, s.

        Runs of one study may differ by orders of magnitude. The time left is known only if it is
        much the same whether the trend goes on or ends; and a pause longer than any before is that
        of a run unlike those before, the end of which is unknown.

        Examples
        --------
        >>> tally = Tally(300, 0, 100, 0, 50.0, pause=2.0)
        >>> tally.left, tally.left_after(3.0), tally.left_after(30.0)
        (100.0, 97.0, inf)
        """
        missing = self.runs - self.before - self.now
        if not missing:
            return 0.0
        if not self.rate > 0.0 or waited > LONGER * self.pause:
            return float("inf")
        longer = growth(self.trend, 2.0 * missing / self.now)
        known = 1.0 / ALIKE_TIMES <= longer <= ALIKE_TIMES
        return max(missing / self.rate - waited, 0.0) if known else float("inf")


def growth(trend: float, halves: float) -> float:
    """Return how much longer runs take if a trend from half to half goes on for so many halves.

    Examples
    --------
    >>> growth(2.0, 2.0)  # of twice and four times as long in place of two
    3.0
    >>> growth(1.0, 5.0), growth(3.0, 1e4)
    (1.0, inf)
    """
    if trend == 1.0:
        return 1.0
    if halves * trend > MOST_GROWTH:
        return float("inf")
    grown: float = trend * (trend**halves - 1.0) / (trend - 1.0) / halves
    return grown


Report = Callable[[Tally], None]
LATER = 1.1  # times the time of the first task: until then others began beside it
FEWEST = 4  # tasks after the first, from which a rate may say how long the others take
ALIKE_TIMES = 2.0  # times as long by the trend as by the rate is still about the same
MOST_GROWTH = 500.0  # trend times halves; more is beyond all floating-point numbers
LONGER = 2.0  # times the longest pause until now is more than chance


class Pace:
    """When runs came, and what that says of those to come.

    The rate is that of the latter half of the time since the first task came: what is quick there
    stays quick. Before that task there is compilation; soon after it come those that began beside
    it.

    Examples
    --------
    >>> pace = Pace()
    >>> [pace.since(done, seconds) for done, seconds in ((1, 5.0), (2, 5.1), (3, 6.0), (9, 7.0))]
    [(0, 0.0), (0, 0.0), (2, 5.1), (3, 6.0)]
    """

    def __init__(self) -> None:
        """Begin without any task."""
        self._runs: list[int] = []
        self._times: list[float] = []
        self.pause = 0.0

    def since(self, done: int, seconds: float) -> tuple[int, float]:
        """Return the runs and seconds where that half begins, and take note of these."""
        runs, times = self._runs, self._times
        if times:
            self.pause = max(self.pause, seconds - times[-1])
        begins = 0, 0.0
        if times and seconds >= LATER * times[0]:
            half = max(bisect_right(times, 0.5 * (times[0] + seconds)) - 1, 0)
            begins = runs[half], times[half]
        runs.append(done)
        times.append(seconds)
        return begins

    @property
    def trend(self) -> float:
        """How much longer the latter half of the runs since the first task took.

        NaN of few tasks, and of one that took longer than all others together.
        """
        runs, times = self._runs, self._times
        if len(times) <= FEWEST or self.pause > 0.5 * (times[-1] - times[0]):
            return float("nan")
        middle = 0.5 * (runs[0] + runs[-1])
        near = slice((after := bisect_right(runs, middle)) - 1, after + 1)  # not all of a million
        half = float(np.interp(middle, runs[near], times[near]))
        return (times[-1] - half) / (half - times[0]) if half > times[0] else float("nan")


def told_by(progress: Progress) -> Report:
    """Return a report of tallies that tells the share of the runs that are done."""
    return lambda tally: progress((tally.before + tally.now) / tally.runs)


@with_progress("simulating", told_by)
def sweep(
    study: Study | str | Path,
    path: str | Path,
    *,
    engine: Engine | None = None,
    progress: Report | None = None,
) -> Summary:
    """Simulate the missing runs of a study, and store their results.

    It may be stopped at any moment; called again, it continues. Several processes may sweep the
    same study at once, and share the work: each does blocks that no other one is doing.

    Parameters
    ----------
    study : Study, str or Path
        The study, or its file.
    path : str or Path
        The store: a folder, made if it does not exist.
    engine : Engine, optional
        The engine for the runs, `Threads`, `Processes` or `Scheduler`; by default all cores of this
        machine: threads, and processes beside them if it takes longer than some seconds.
    progress : callable, optional
        Called with a `Tally` after each task; without it, a terminal or a notebook shows a bar or
        lines.

    Returns
    -------
    Summary
        How all runs ended, including earlier ones.

    Raises
    ------
    DescriptionError
        If `study` cannot be read, or `engine` is none.
    ResultError
        If something else is there, or the store cannot be written.

    Examples
    --------
    >>> import stiction as st
    >>> slider = st.presets.nakano_popov_2020()
    >>> base = st.Description.of(slider, "20 ms")
    >>> axes = {"phi": st.Grid("1 deg", "3 deg", 3)}
    >>> study = st.Study(base=base, axes=axes, measures=["stick_count"])
    >>> print(st.sweep(study, "phi.zarr"))
    phi.zarr
      3 of 3 runs are done.
    """
    study = study_of(study)
    refuse_other(engine)
    store = open_store(study, path) if Path(path).exists() else create(study, path)
    left = missing(store)
    with folder_lock(store.path, alone=True) as first:
        # a second process begins at the other end
        do(study, store, left if first else left[::-1], engine, progress)
    return summary(study, store)


def missing(store: Store) -> list[int]:
    """Return the blocks of a study that its store lacks."""
    layout = store.layout
    return [task for task in range(layout.tasks) if not store.has(layout.region(task))]


def runs_in(layout: Layout, tasks: Sequence[int]) -> int:
    """Return the number of runs in tasks."""
    return sum(runs_of(layout.region(task)) for task in tasks)


def count_done(study: Study, path: str | Path) -> int:
    """Return how many runs of a study its store has; 0 where there is none yet."""
    if not Path(path).exists():
        return 0
    store = open_store(study, path)
    return store.layout.runs - runs_in(store.layout, missing(store))


def do(
    study: Study,
    store: Store,
    tasks: Sequence[int],
    engine: Engine | None,
    progress: Report | None,
) -> None:
    """Do blocks of a study on an engine."""
    layout, begun = store.layout, perf_counter()
    left = runs_in(layout, tasks)
    tally, pace = Tally(layout.runs, layout.runs - left, 0, 0, 0.0), Pace()
    for came in _outcomes(study, store, tasks, engine or Cores()):
        now, seconds = tally.now + came.runs, perf_counter() - begun
        tally = tally._replace(
            now=now,
            failed=tally.failed + came.failed,
            seconds=seconds,
            since=pace.since(now, seconds),
            trend=pace.trend,
            pause=pace.pause,
        )
        if progress is not None:
            progress(tally)


def _outcomes(study: Study, store: Store, tasks: Sequence[int], engine: Engine) -> Iterator[Came]:
    """Yield the outcome of each task; those that other sweeps do are left to the end.

    What they are still doing then is done here too: a sweep that is suspended, or on a machine that
    is lost, keeps its claims.
    """
    for came in engine.results(partial(do_block, study, store.address), tasks):
        if came is not None:
            yield came
    if left := [task for task in tasks if not store.has(store.layout.region(task))]:
        yield from engine.results(partial(finish_block, study, store.address), left)
    store.drop_claims()
