"""One task: the runs of one block, done and written."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from stiction.errors import DescriptionError, Status
from stiction.study.layout import Index, places, size_of
from stiction.study.measures import MEASURES
from stiction.study.observed import observe
from stiction.study.plan import Study
from stiction.study.store import COMPLETED, ERROR, REFUSED, Block, Store


class Unwanted(Exception):
    """Raised inside a run that is no longer wanted."""


class Came(NamedTuple):
    """What came of a task: how many runs, and how many of them failed."""

    runs: int
    failed: int


class Outcome(NamedTuple):
    """What came of a run: how it ended, why, and its measures."""

    status: int
    message: str
    values: tuple[float, ...]


def done(study: Study, store: Store, task: int, unwanted: Callable[[], bool]) -> Came:
    """Do the runs of a block and write it, or nothing if it is no longer wanted."""
    region = store.layout.region(task)
    size = size_of(region)
    status = np.full(size, COMPLETED, np.int8)
    message = np.full(size, "", object)
    measures = {name: np.full(size, np.nan) for name in study.measures}
    try:
        for place, index in zip(np.ndindex(size), places(region), strict=True):
            status[place], message[place], values = outcome(study, index, unwanted)
            for name, value in zip(study.measures, values, strict=False):
                measures[name][place] = value
    except Unwanted:
        return Came(0, 0)
    store.write(region, Block(measures, status, message))
    return Came(status.size, int(np.count_nonzero(status != COMPLETED)))


def outcome(study: Study, index: Index, unwanted: Callable[[], bool]) -> Outcome:
    """Do one run. Whatever goes wrong in it is what came of it."""

    def report(_: float) -> None:
        if unwanted():
            raise Unwanted

    report(0.0)
    try:
        seen = observe(study.description(index), report)
        ended = list(Status)[seen.solution.code]
        if not ended.ok:
            return Outcome(seen.solution.code, ended.value, ())
        return Outcome(COMPLETED, "", tuple(MEASURES[name].of(seen) for name in study.measures))
    except Unwanted:
        raise
    except DescriptionError as error:
        return Outcome(REFUSED, "; ".join(map(str, error.faults)), ())
    except (ArithmeticError, ValueError, LookupError, RuntimeError) as error:
        return Outcome(ERROR, f"{type(error).__name__}: {error}", ())
