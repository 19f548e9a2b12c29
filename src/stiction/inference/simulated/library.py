"""A library: the features of simulated records, computed once and stored."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import ceil, log, log1p
from pathlib import Path
from threading import Lock
from types import MappingProxyType
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from stiction.arrays import Floats
from stiction.errors import DescriptionError, ResultError
from stiction.inference.columns import dummy
from stiction.inference.cycles import slip_cycles
from stiction.inference.features import features
from stiction.inference.simulated.plan import Plan
from stiction.inference.simulated.synthetic import draw
from stiction.progress.report import Progress, silent
from stiction.storage.arrays import cache_folder, read_arrays, write_arrays
from stiction.storage.files import prepare_folder
from stiction.study.execution.cores import Cores
from stiction.text.suggestion import Suggestion

BLOCK = 32  # simulations that are stored together
# simulations that tell whether all of them will be too few, except once in a thousand
FIRST_SIMULATIONS = 3 * BLOCK
SURE = 0.999
SAFE = 1.2  # times as many simulations as give enough on average: over four deviations of 300


class Library(NamedTuple):
    """Simulated records: normal scores (n, p) of their parameters, and their features (n, f).

    `wanted` is the number of simulations; those without enough cycles are left out.
    """

    plan: Plan
    scores: Floats
    features: Floats
    wanted: int


class Ensemble(NamedTuple):
    """The simulations of a plan, of which more and more are made.

    Number i is the same whatever the number of others: so the first may be judged before the rest.

    Parameters
    ----------
    plan : Plan
        What is simulated.
    folder : Path or None
        Where blocks of them are stored; what it holds already is not simulated again.
    seed : int
        Of the simulations.
    blocks : mapping of int to (scores, features)
        Normal scores (n, p) and features (n, f) of those that are made, by the number of their
        block. Features of a record with too few cycles are NaN.
    """

    plan: Plan
    folder: Path | None
    seed: int
    blocks: Mapping[int, tuple[Floats, Floats]] = MappingProxyType({})

    @classmethod
    def within(cls, place: Path | None, plan: Plan, seed: int) -> Self:
        """Return those that a folder of several plans may store; none of them is made yet."""
        return cls(plan, None if place is None else place / f"{plan.key}-{seed}", seed)

    def simulate(self, count: int, progress: Progress = silent) -> Self:
        """Return the ensemble with at least `count` simulations, in whole blocks."""
        if count < 1:
            raise DescriptionError.of("simulations", f"must be at least 1, is {count}")
        done = {**self.blocks}
        missing = [each for each in range(ceil(count / BLOCK)) if each not in done]
        if self.folder is not None:
            stored = {each: read_block(self.folder, each) for each in missing}
            done |= {each: rows for each, rows in stored.items() if rows is not None}
            missing = [each for each in missing if each not in done]
        ready, lock = dict.fromkeys(missing, 0), Lock()

        def report(block: int, rows: int) -> None:
            """Report the number of simulations, also during the first blocks, which take long."""
            with lock:
                ready[block] = rows
                progress(sum(ready.values()) / (BLOCK * len(missing)))

        work = Simulate(self.plan, self.folder, self.seed, report)
        for block, rows in Cores().results(work.block, missing):
            done[block] = rows
            report(block, BLOCK)
        return self._replace(blocks=done)

    def rows(self, count: int) -> tuple[Floats, Floats]:
        """Return normal scores (n, p) and features (n, f) of the first `count` simulations."""
        its = [self.blocks[each] for each in range(ceil(count / BLOCK))]
        scores, found = (np.concatenate(each)[:count] for each in zip(*its, strict=True))
        return scores, found

    def library(self, count: int) -> Library:
        """Return those of the first `count` simulations that have cycles."""
        scores, found = self.rows(count)
        kept = have_cycles(found)
        return Library(self.plan, scores[kept], found[kept], count)


def build(
    plan: Plan, count: int, folder: Path | None, *, seed: int = 0, progress: Progress = silent
) -> Library:
    """Simulate a library of `count` records, or continue one that is stored in a folder."""
    return Ensemble(plan, folder, seed).simulate(count, progress).library(count)


def have_cycles(rows: Floats) -> NDArray[np.bool_]:
    """Return a mask of the rows of features (n, f) of records with cycles."""
    return np.asarray(np.isfinite(rows).all(axis=1))


def tell_nobody(block: int, rows: int) -> None:
    """Report nothing, for a block in another process, which cannot report its rows."""


class Simulate(NamedTuple):
    """The simulation of blocks, which another process does without a report of its rows."""

    plan: Plan
    folder: Path | None
    seed: int
    report: Callable[[int, int], None] = tell_nobody

    def block(self, block: int, _: Callable[[], bool]) -> tuple[int, tuple[Floats, Floats]]:
        """Simulate a block, store it in the folder, and return its number, scores and features."""
        rows = []
        for i in range(block * BLOCK, (block + 1) * BLOCK):
            rows.append(simulate(self.plan, i, self.seed))
            self.report(block, len(rows))
        found = np.array([row[0] for row in rows]), np.array([row[1] for row in rows])
        if self.folder is not None:
            write_arrays(self.folder / f"{block:05d}.npz", scores=found[0], features=found[1])
        return block, found

    def __reduce__(self) -> tuple[type[Simulate], tuple[Plan, Path | None, int]]:
        """Pickle without the report."""
        return Simulate, (self.plan, self.folder, self.seed)


def simulate(plan: Plan, number: int, seed: int) -> tuple[Floats, Floats]:
    """Return the normal scores and features of one simulation; NaN where it has too few cycles."""
    drawn, records = draw(plan, number, seed)
    found = []
    for conditions, made in zip(plan.conditions, records, strict=True):
        scale = conditions.scale(plan.basis or plan.slider)
        blank = dummy(conditions)
        channels, cycles = made[:2] if made else (blank, slip_cycles(blank["force"]))
        its = features(conditions.step, channels, scale, cycles)
        found.append(its if made else np.full_like(its, np.nan))
    return drawn, np.concatenate(found)


def will_be_too_few(usable: int, tried: int, wanted: int, fewest: int) -> bool:
    """Return whether `fewest` of all simulations cannot have cycles, as the first ones tell.

    Of those, `tried`, so many are `usable`. By the bound of Clopper and Pearson (Biometrika 26, 404
    (1934)) on the share that has some.

    >>> [will_be_too_few(usable, 96, 400, 300) for usable in (20, 60, 96)]
    [True, False, False]
    """
    from scipy.special import betaincinv  # slow to import

    share = float(betaincinv(usable + 1, tried - usable, SURE)) if usable < tried else 1.0
    return share * wanted < fewest


def telling(wanted: int, fewest: int) -> int:
    """Return how many first simulations tell that too few will have cycles, if none of them has.

    >>> [telling(wanted, 40) for wanted in (128, 1000, 2000)]
    [96, 170, 342]
    """
    alone = log(1.0 - SURE) / log1p(-fewest / wanted) if fewest < wanted else 0.0
    return max(FIRST_SIMULATIONS, ceil(alone))


def refuse_too_few(
    what: str, usable: int, simulated: int, fewest: int, which: str = "", check: str = "the priors"
) -> None:
    """Refuse to learn from too few simulations with cycles; state the number needed.

    `which` tells what is asked of the cycles, `check` what decides about them. Where most of
    them are usable, but all would be too few, only their number is at fault; where fewer than a
    tenth of those that are needed are usable, more of them would not help.
    """
    if usable >= fewest:
        return
    enough = SAFE * fewest * simulated / max(usable, 1)
    number = ceil(enough / 100.0) * 100
    more = f"simulate {number} ({Suggestion('simulations', number, of='')})"
    if simulated < fewest and 2 * usable > simulated:
        only, remedy = "", more
    else:
        only, remedy = "only ", f"check {check}{f', or {more}' if 10 * usable > fewest else ''}"
    raise ResultError(
        f"{only}{usable} of {simulated} {what} have cycles of stick and slip{which}, {fewest} are "
        f"needed: {remedy}"
    )


def library_folder(library: str | Path | None) -> Path | None:
    """Return the folder of libraries, created and writable; None if none is named.

    The folder in the user's cache need not be writable: nothing is stored then.

    Raises
    ------
    ResultError
        If another one cannot be made, or be written to.
    """
    if library is None:
        return None
    folder = Path(library)
    return folder if folder == cache_folder() else prepare_folder(folder)


def read_block(folder: Path, block: int) -> tuple[Floats, Floats] | None:
    """Return a stored block; None if it must be simulated again."""
    stored = read_arrays(folder / f"{block:05d}.npz")
    if stored is None or not stored.keys() >= {"scores", "features"}:
        return None
    return stored["scores"], stored["features"]
