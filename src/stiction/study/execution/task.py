"""A task: do the runs of one block, and write them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from stiction.errors import STATUSES, DescriptionError
from stiction.study.plan.layout import Index, places, runs_of, size_of
from stiction.study.plan.study import Study
from stiction.study.store.kept import Kept, stored_variables
from stiction.study.store.store import COMPLETED, ERROR, REFUSED, BlockResults, Store
from stiction.study.variables.observed_run import observe_run


class Unwanted(Exception):
    """Raised in a run that is no longer wanted."""


class Came(NamedTuple):
    """The outcome of a task: the number of runs, and of failed ones."""

    runs: int
    failed: int


class StoredOutcome(NamedTuple):
    """The outcome of a run: its status, its message, and the kept values."""

    status: int
    message: str
    values: tuple[Any, ...]


def do_block(study: Study, store: Store, task: int, unwanted: Callable[[], bool]) -> Came:
    """Do the runs of a block and write it, unless it is no longer wanted.

    A worker that outlived its client may have written it meanwhile; then it stays as it is.
    """
    region = store.layout.region(task)
    size = size_of(region)
    if store.has(region):
        return Came(runs_of(region), 0)
    status = np.full(size, COMPLETED, np.int8)
    message = np.full(size, "", object)
    wanted = stored_variables(study)
    arrays = [np.full((*size, *each.shape), each.unknown, each.dtype) for each in wanted]
    try:
        for place, index in zip(np.ndindex(size), places(region), strict=True):
            status[place], message[place], values = outcome(study, wanted, index, unwanted)
            for array, value in zip(arrays, values, strict=False):  # a failed run has no values
                array[place] = value
    except Unwanted:
        return Came(0, 0)
    if not store.has(region):
        store.write(region, BlockResults([*zip(wanted, arrays, strict=True)], status, message))
    return Came(status.size, int(np.count_nonzero(status != COMPLETED)))


def outcome(
    study: Study, wanted: Sequence[Kept], index: Index, unwanted: Callable[[], bool]
) -> StoredOutcome:
    """Do one run; an error in it becomes its outcome."""

    def report(_: float) -> None:
        if unwanted():
            raise Unwanted

    report(0.0)
    try:
        seen = observe_run(study.description(index), report)
        ended = STATUSES[seen.solution.code]
        if not ended.ok:
            return StoredOutcome(seen.solution.code, ended.value, ())
        return StoredOutcome(COMPLETED, "", tuple(each.of(seen) for each in wanted))
    except (Unwanted, OSError, MemoryError):
        raise
    except DescriptionError as error:
        return StoredOutcome(REFUSED, "; ".join(map(str, error.faults)), ())
    except Exception as error:  # a user's law may raise anything
        return StoredOutcome(ERROR, f"{type(error).__name__}: {error}", ())
