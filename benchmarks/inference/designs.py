"""Designs: does a further test tell as much as it promises?

``python -m benchmarks.inference.designs --rigs granite --library FOLDER``: rigs are drawn from the
priors of those of `benchmarks.inference.fits` and simulated in each further test that a design
tries. The design learns from three quarters of them, and promises by how much the typical error of
phi shrinks. The others are fitted by the present test, and by both: how far off the fits are, and
how far off their posteriors say that they are. Records have the noise, filters and drift of the
rig's; ``--cycles`` changes their length, and ``--per-cycle`` the samples of the present one, as a
record given to a design does; ``--channels`` what is measured at present. FOLDER holds the
simulations.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.special import ndtr

from benchmarks.inference.fits import CYCLES, PER_CYCLE, RIGS, Floats, rig_of
from stiction.inference.columns import features_from
from stiction.inference.features import USED
from stiction.inference.fit import plan_for
from stiction.inference.learning.calibration import learn_or_read
from stiction.inference.learning.regression_abc import quantiles
from stiction.inference.next_test.design import expectations, split
from stiction.inference.next_test.expected import Expected, fill_in, typical
from stiction.inference.next_test.further import Further, Wanted, further_tests
from stiction.inference.observation import Conditions
from stiction.inference.simulated.library import Ensemble, have_cycles
from stiction.inference.simulated.plan import Plan
from stiction.progress.report import silent

LEARNED = 0.75  # share of the rigs from which is learned; the others are fitted
OF = "phi"
DRAWS = 400  # of each posterior
COLUMNS = "{:46s} {:>5s}  {:>8s} {:>13s}  {:>5s} {:>6s}"


class Fitted(NamedTuple):
    """Fits of rigs that were not learned from, of which those without cycles are NaN.

    Parameters
    ----------
    errors : ndarray
        (n, 1), distance of the median of phi from the truth, rad.
    deviations : ndarray
        (n, d), that of draws of the posterior from the median, rad.
    """

    errors: Floats
    deviations: Floats

    def shrinkage(self, before: Fitted) -> tuple[float, float]:
        """Return the typical error over an earlier one, as found and as stated."""
        fitted = have_cycles(before.errors)
        pairs = zip(before, self, strict=True)
        typically = (typical(fill_in(pair)[:, fitted].reshape(2, -1), axis=1) for pair in pairs)
        found, stated = (float(own / first) for first, own in typically)
        return found, stated


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
) -> Iterator[tuple[Expected, int, float, float]]:
    """Yield each further test: what the first rigs (n, p) promise and what the others keep.

    What is expected, how many rigs were fitted, and the ratio of typical errors, found and stated.
    """
    first = int(LEARNED * len(scores))
    predicted = expectations(trial, tests, scores[:first], rows[:first], silent)
    found = (fits(trial, scores, rows, first, columns) for columns in columns_of(trial, tests))
    next(predicted)
    before = next(found)
    for expected, own in zip(predicted, found, strict=True):
        yield expected, int(have_cycles(own.errors).sum()), *own.shrinkage(before)


def columns_of(trial: Plan, tests: Sequence[Further]) -> Iterator[list[int]]:
    """Yield the columns of features that the fit of each test uses."""
    conditions = trial.conditions
    width, place = len(features_from(USED, conditions[0], trial.slider)), 0
    for test in tests:
        which = np.flatnonzero(features_from(test.channels, conditions[0], trial.slider))
        place += test.record is not None
        own = [] if test.record is None else (place * width + which).tolist()
        yield [*which.tolist(), *own]


def fits(trial: Plan, scores: Floats, rows: Floats, first: int, columns: Sequence[int]) -> Fitted:
    """Fit the rigs (n, p) behind the first ones, by some columns of the features of these."""
    features, place = rows[:, columns], [*trial.priors].index(OF)
    usable, prior, random = have_cycles(features), trial.priors[OF], np.random.default_rng(0)
    known = np.flatnonzero(usable[:first])
    learned = learn_or_read(features[known], scores[known])
    truth = prior.quantile(ndtr(scores[first:, place]))
    errors, deviations = (np.full((len(truth), count), np.nan) for count in (1, DRAWS))
    unseen = np.flatnonzero(usable[first:])
    posteriors = learned.posteriors(features[first:][unseen])
    for i, sample in zip(unseen, posteriors, strict=True):
        values = prior.quantile(ndtr(sample.scores[:, place]))
        (median,) = quantiles(values, sample.weights, np.array([0.5]))
        errors[i] = abs(median - truth[i])
        drawn = random.choice(values, DRAWS, p=sample.weights / sample.weights.sum())
        deviations[i] = np.abs(drawn - median)
    return Fitted(errors, deviations)


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
        made = Ensemble.within(options.library, trial, options.seed).simulate(options.drawn)
        scores, rows = made.rows(options.drawn)
        print(name)
        print(COLUMNS.format("test", "rigs", "promised", "", "found", "stated"))
        logs, at = [], [*trial.priors].index(OF)
        for test, fitted, found, stated in compare(trial, tests, scores, rows):
            promised, low, high = (float(each[at]) for each in (test.ratio, test.low, test.high))
            logs.append(np.log(promised / np.array([found, stated])))
            numbers = (f"{each:.2f}" for each in (found, stated))
            interval = f"{low:.2f} to {high:.2f}"
            print(COLUMNS.format(test.test, str(fitted), f"{promised:.2f}", interval, *numbers),
                  flush=True)  # fmt: skip
        means = ", ".join(f"{each:.2f}" for each in np.mean(logs, axis=0))
        print(f"  ln(promised / found), ln(promised / stated): {means} in the mean")


if __name__ == "__main__":
    main()
