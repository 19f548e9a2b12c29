"""Doing a study: what is missing in its store, block by block, on an engine."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from time import perf_counter
from typing import NamedTuple

from stiction.storage.files import held
from stiction.study.execution.engines import Engine, Threads
from stiction.study.execution.task import done
from stiction.study.plan.layout import runs_of
from stiction.study.plan.study import Study
from stiction.study.store.creation import create
from stiction.study.store.store import Store, opened
from stiction.study.view.summary import Summary, summary


class Tally(NamedTuple):
    """How far a study is.

    Parameters
    ----------
    runs : int
        Runs in all.
    before : int
        Of them done before this time.
    now : int
        Done this time.
    failed : int
        Failed this time.
    seconds : float
        Since this time began.
    """

    runs: int
    before: int
    now: int
    failed: int
    seconds: float

    @property
    def rate(tally) -> float:
        """Runs per second."""
        return tally.now / tally.seconds if tally.seconds > 0.0 else 0.0

    @property
    def left(tally) -> float:
        """Seconds left at this rate; infinite before the first task is done."""
        missing = tally.runs - tally.before - tally.now
        return missing / tally.rate if tally.rate > 0.0 else float("inf")


Report = Callable[[Tally], None]


def sweep(
    study: Study,
    path: str | Path,
    *,
    engine: Engine | None = None,
    progress: Report | None = None,
) -> Summary:
    """Do all runs of a study that its store has not, and keep them there.

    It may be stopped at any moment, and goes on where it was when it is called again. Several may
    do the same study at once, and share the work.

    Parameters
    ----------
    study : Study
        What to run.
    path : str or Path
        The store: a folder, made if it is not there.
    engine : Engine, optional
        What does the runs: threads of this process when left out.
    progress : callable, optional
        Called with a `Tally` after each task.

    Returns
    -------
    Summary
        How the runs ended, of this time and before.

    Raises
    ------
    ResultError
        If something else is there, or the store cannot be written.
    """
    store = opened(study, path) if Path(path).exists() else create(study, path)
    layout = store.layout
    left = [task for task in range(layout.tasks) if not store.has(layout.region(task))]
    with held(store.path, alone=True) as first:
        # a second one begins at the other end
        do(study, store, left if first else left[::-1], engine, progress)
    return summary(study, store)


def do(
    study: Study,
    store: Store,
    tasks: Sequence[int],
    engine: Engine | None,
    progress: Report | None,
) -> None:
    """Have an engine do blocks of a study."""
    layout, begun = store.layout, perf_counter()
    left = sum(runs_of(layout.region(task)) for task in tasks)
    tally = Tally(layout.runs, layout.runs - left, 0, 0, 0.0)
    for came in (engine or Threads()).results(partial(done, study, store), tasks):
        tally = tally._replace(
            now=tally.now + came.runs,
            failed=tally.failed + came.failed,
            seconds=perf_counter() - begun,
        )
        if progress is not None:
            progress(tally)
