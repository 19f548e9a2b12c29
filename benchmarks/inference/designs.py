"""Designs: does a further test tell as much as it promises?

``python -m benchmarks.inference.designs --rigs granite --library FOLDER``: rigs are drawn from the
priors of those of `benchmarks.inference.fits` and simulated in each further test that a design
tries. The design learns from three quarters of them. The others are fitted by the present test, and
by both: the ratio of the posterior's standard deviations of ln phi is what the test tells, beside
the interval that the design predicts. Records have the noise, filters and drift of the rig's;
``--cycles`` changes their length, and ``--per-cycle`` the samples of the present one, as a record
given to a design does; ``--channels`` what is measured at present. FOLDER holds the simulations.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from benchmarks.inference.fits import CYCLES, PER_CYCLE, RIGS, Floats, rig_of, spread
from stiction.inference.columns import features_from
from stiction.inference.features import USED
from stiction.inference.fit import plan_for
from stiction.inference.learning.calibration import learn_or_read
from stiction.inference.next_test.design import expectations, split
from stiction.inference.next_test.expected import Expected
from stiction.inference.next_test.further import Further, Wanted, further_tests
from stiction.inference.observation import Conditions
from stiction.inference.progress import silent
from stiction.inference.simulated.library import Library, have_cycles, simulate_all
from stiction.inference.simulated.plan import Plan

LEARNED = 0.75  # share of the rigs from which is learned; the others are fitted
OF = "phi"
COLUMNS = "{:46s} {:>5s}  {:>5s} {:>13s}  {:>5s} {:>7s}"


class Compared(NamedTuple):
    """A test: what a design expects of it, and what fits find.

    Parameters
    ----------
    expected : Expected
        What it leaves open.
    ratios : ndarray
        (n,), of rigs that were not learned from: the standard deviation of ln phi by both tests
        over that by the present one.
    """

    expected: Expected
    ratios: Floats


def plan_of(
    name: str, channels: tuple[str, ...], cycles: int, per_cycle: int
) -> tuple[Plan, list[Further]]:
    """Return the plan of all tests of a rig, and the tests, the present one first."""
    rig, usual = rig_of(name)
    present: Conditions = usual._replace(cycles=cycles, step=usual.cycle / per_cycle)
    tests, _ = split(further_tests(present, channels, Wanted()), rig.slider)
    records = [test.record for test in tests if test.record is not None]
    trial = plan_for(rig, [present, *records], "force_across" in channels)
    return trial, [Further("the present test", channels), *tests]


def compare(
    trial: Plan, tests: Sequence[Further], scores: Floats, rows: Floats
) -> Iterator[Compared]:
    """Yield each further test: what the first rigs (n, p) promise and the others keep."""
    first = int(LEARNED * len(scores))
    known, unseen = (scores[:first], rows[:first]), rows[first:]
    predicted = [*expectations(trial, tests, *known, silent)]
    present, *further = columns_of(trial, tests)
    before = spreads(trial, *known, unseen, present)
    for expected, columns in zip(predicted[1:], further, strict=True):
        ratios = spreads(trial, *known, unseen, columns) / before
        yield Compared(expected, ratios[np.isfinite(ratios)])


def columns_of(trial: Plan, tests: Sequence[Further]) -> Iterator[list[int]]:
    """Yield the columns of features that the fit of each test uses."""
    conditions = trial.conditions
    width, place = len(features_from(USED, conditions[0], trial.slider)), 0
    for test in tests:
        which = np.flatnonzero(features_from(test.channels, conditions[0], trial.slider))
        place += test.record is not None
        own = [] if test.record is None else (place * width + which).tolist()
        yield [*which.tolist(), *own]


def spreads(
    trial: Plan, scores: Floats, known: Floats, unseen: Floats, columns: list[int]
) -> Floats:
    """Return the standard deviations (n,) of ln phi in fits of unseen rigs; NaN without cycles."""
    complete, usable = (have_cycles(each[:, columns]) for each in (known, unseen))
    learned = learn_or_read(known[complete][:, columns], scores[complete])
    library = Library(trial, scores[complete], known[complete], len(scores))
    place = [*trial.priors].index(OF)
    found = np.full(len(unseen), np.nan)
    samples = learned.posteriors(unseen[usable][:, columns])
    found[usable] = [spread(library, OF, sample, place) for sample in samples]
    return found


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rigs", nargs="+", choices=RIGS, default=[*RIGS][:3], metavar="NAME")
    parser.add_argument("--channels", nargs="+", choices=USED, default=[USED[0]])
    parser.add_argument("--drawn", type=int, default=512)
    parser.add_argument("--cycles", type=int, default=CYCLES)
    parser.add_argument("--per-cycle", type=int, default=PER_CYCLE)
    parser.add_argument("--library", type=Path)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    for name in options.rigs:
        wanted = tuple(options.channels), options.cycles, options.per_cycle
        trial, tests = plan_of(name, *wanted)
        place = options.library and options.library / f"{trial.key}-{options.seed}"
        scores, rows = simulate_all(trial, options.drawn, place, seed=options.seed)
        print(name)
        print(COLUMNS.format("test", "rigs", "promised", "", "found", "scatter"))
        logs = []
        for test, ratios in compare(trial, tests, scores, rows):
            at = [*trial.priors].index(OF)
            promised, low, high = (float(each[at]) for each in (test.ratio, test.low, test.high))
            found = float(np.mean(ratios))
            logs.append(np.log(promised / found))
            within = "" if low <= found <= high else "  OUTSIDE"
            numbers = f"{promised:.2f}", f"{low:.2f} to {high:.2f}", f"{found:.2f}"
            scatter = f"{np.exp(np.std(np.log(ratios))):.2f}"
            print(COLUMNS.format(test.test, str(len(ratios)), *numbers, scatter) + within,
                  flush=True)  # fmt: skip
        print(f"  ln(promised / found): {np.mean(logs):.2f} in the mean")


if __name__ == "__main__":
    main()
