"""Which further test to make: how far each narrows what is known, in sentences and tables.

Simulated rigs are measured in each test. A regression over all others says where the parameters of
a left-out one lie; how far off it is, on average, is what the test leaves open. The mean square is
the expected variance of the posterior, if the regression is as good as its mean (P. Fearnhead & D.
Prangle, J. R. Stat. Soc. B 74, 419 (2012)).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from scipy.special import ndtr

from stiction.analysis.signals.correlated_noise import BOUNDS_95
from stiction.arrays import Floats, xr
from stiction.inference.learning.summary import learn
from stiction.inference.next_test.further import AGAIN
from stiction.inference.posterior import unit_of
from stiction.inference.simulated.library import have_cycles
from stiction.inference.simulated.plan import Plan
from stiction.names import draw
from stiction.text.paths import last_part
from stiction.text.quantity_text import percent
from stiction.text.sections import Section, Table, as_html
from stiction.text.units import in_words

RESAMPLED = 1000  # times, for the interval of a ratio


class Expected(NamedTuple):
    """What a test leaves open of each parameter, (p,) each.

    Parameters
    ----------
    test : str
        Its name.
    width : ndarray
        Of the posterior over the prior, as normal scores: 1 if nothing is learned.
    error : ndarray
        Root mean square of what the estimate is off by, in SI.
    ratio, low, high : ndarray
        The width over that of the present test, with its 95 % interval.
    usable : float
        Share of the simulated rigs that show enough cycles in it.
    """

    test: str
    width: Floats
    error: Floats
    ratio: Floats
    low: Floats
    high: Floats
    usable: float


def left_out_errors(records: Sequence[Floats], truth: Floats) -> Floats:
    """Return the leave-one-out errors of the parameters (n, p), as normal scores.

    A regression of each record's features first says what it tells alone; where there are several,
    another one joins these. So few simulations do for many features.

    Parameters
    ----------
    records : sequence of ndarray
        (n, f), the features of each record; NaN for rigs that show too few cycles in it, of which
        the result is NaN.
    truth : ndarray
        (n, p), normal scores.
    """
    complete = have_cycles(np.hstack(records))
    found = np.full_like(truth, np.nan)
    if complete.sum() > 2:
        alone = [learn(each[complete], truth[complete]).middle.library for each in records]
        joint = alone[0]
        if len(alone) > 1:
            joint = learn(np.hstack(alone), truth[complete]).middle.library
        found[complete] = truth[complete] - joint
    return found


def expectation(trial: Plan, test: str, truth: Floats, after: Floats, before: Floats) -> Expected:
    """Return what a test leaves open, from leave-one-out errors (n, p) with and without it.

    For a rig that shows too few cycles in a test, the present one is all that is known.
    """
    usable = have_cycles(after)
    missed = np.where(usable[:, None], after, before)
    squares, reference = missed**2, before**2
    count = len(before)
    drawn = np.random.default_rng(0).multinomial(count, np.full(count, 1.0 / count), RESAMPLED)
    ratios = np.sqrt((drawn @ squares) / (drawn @ reference))
    low, high = np.quantile(ratios, BOUNDS_95, axis=0)
    width = np.sqrt(squares.mean(axis=0))
    ratio = width / np.sqrt(reference.mean(axis=0))
    errors = [
        np.sqrt(np.mean((prior.quantile(ndtr(a - b)) - prior.quantile(ndtr(a))) ** 2))
        for prior, a, b in zip(trial.priors.values(), truth.T, missed.T, strict=True)
    ]
    return Expected(test, width, np.array(errors), ratio, low, high, float(usable.mean()))


@dataclass(frozen=True, repr=False)
class Advice:
    """What further tests are expected to tell about the parameters of a rig.

    Parameters
    ----------
    plan : Plan
        Rig, priors, and conditions of all records.
    of : str
        The parameter of interest.
    tests : tuple of Expected
        The present test, then those that may be added to it.
    skipped : tuple of str
        Tests in which the rig, in the middle of its priors, does not stick and slip.
    assumed : tuple of str
        What neither the description nor the user said, as sentences.
    simulations : int
        Number of simulated rigs with cycles in the present test.
    """

    plan: Plan
    of: str
    tests: tuple[Expected, ...]
    skipped: tuple[str, ...]
    assumed: tuple[str, ...]
    simulations: int

    @property
    def index(self) -> int:
        """The place of the parameter of interest among all."""
        return [*self.plan.priors].index(self.of)

    @property
    def present(self) -> Expected:
        """The present test."""
        return self.tests[0]

    @property
    def ranked(self) -> list[Expected]:
        """The further tests, the one that tells most of the parameter first."""
        return sorted(self.tests[1:], key=lambda test: test.ratio[self.index])

    @property
    def best(self) -> Expected | None:
        """The test that tells most of those that clearly tell more than the present one."""
        return next((test for test in self.ranked if test.high[self.index] < 1.0), None)

    @property
    def data(self) -> xr.Dataset:
        """Widths, errors and ratios as a dataset over ``test`` and ``parameter``."""
        dims = ("test", "parameter")
        columns: dict[str, Any] = {
            name: (dims, np.array([getattr(test, name) for test in self.tests]))
            for name in ("width", "error", "ratio", "low", "high")
        }
        columns["usable"] = ("test", np.array([test.usable for test in self.tests]))
        names = {"test": [test.test for test in self.tests], "parameter": [*self.plan.priors]}
        return xr.Dataset(columns, names)

    def __repr__(self) -> str:
        """Return a one-line summary."""
        best = self.best or self.ranked[0]
        return f"Advice: best for {self.of}: {best.test}, {best.ratio[self.index]:.2f} of the width"

    def tables(self) -> list[Section]:
        """Return what is found as sentences and tables."""
        its = "a fraction" if (unit := unit_of(self.plan, self.of)) == "" else unit
        rows = [row(test, self.index, its) for test in (self.present, *self.ranked)]
        headings = ("test", f"error of {self.of}", "over present", "95 %", "usable")
        found = [Section("What to measure next", self.sentences(), Table(headings, rows))]
        names = [*self.plan.priors]
        widths = [
            (test.test, *(percent(each) for each in test.width))
            for test in (self.present, *self.ranked)
        ]
        short = map(last_part, names)
        return [
            *found,
            Section(
                "Width of the posterior over that of the prior",
                ["100 % where a test says nothing of a parameter."],
                Table(("test", *short), widths),
            ),
        ]

    def sentences(self) -> list[str]:
        """Return what to do, and what it rests on."""
        i, best, first = self.index, self.best, self.ranked[0]
        unit = unit_of(self.plan, self.of)
        before = in_words(float(self.present.error[i]), unit, 2)
        found = []
        if best is not None:
            after = in_words(float(best.error[i]), unit, 2)
            found.append(
                f"Most is learned of {self.of} from this: {best.test}. Its typical error falls "
                f"from {before} to {after}; the posterior is {best.ratio[i]:.2f} times as wide as "
                f"from the present test (95 %: {best.low[i]:.2f} to {best.high[i]:.2f})."
            )
            if best is not first:
                found.append(
                    f"Perhaps more from this, but that is not sure: {first.test}, "
                    f"{first.ratio[i]:.2f} times as wide (95 %: {first.low[i]:.2f} to "
                    f"{first.high[i]:.2f})."
                )
        else:
            found.append(
                f"None of these tests clearly tells more of {self.of} than the present one, whose "
                f"typical error is {before}."
            )
        idle = self.not_surely_better()
        if best is not None and best.test in idle:
            found.append(
                f"Whether it tells more than {AGAIN} is not sure: more simulations would say."
            )
        if others := [test for test in idle if best is None or test != best.test]:
            found.append(f"Not surely better than {AGAIN}: {', '.join(others)}.")
        if self.skipped:
            found.append(
                "Left out, as the rig does not stick and slip there in the middle of its priors: "
                f"{', '.join(self.skipped)}."
            )
        found.append(
            "A hold tells nothing: this law has no memory of how long the contact was at rest."
        )
        found += self.assumed
        found.append(
            f"Expected over {self.simulations} rigs drawn from the priors, with cycles now."
        )
        return found

    def not_surely_better(self) -> Sequence[str]:
        """Return the names of tests within the interval of one more test of the present kind."""
        i = self.index
        (again,) = (test for test in self.tests if test.test == AGAIN)
        others = (test for test in self.ranked if test is not again)
        return [test.test for test in others if test.ratio[i] >= again.low[i]]

    def _repr_html_(self) -> str:
        return as_html(self.tables())

    def plot(self, axes: Any = None) -> Any:
        """Draw the expected width from each test; see `stiction.plotting.plot_design`."""
        return draw("plot_design", self, axes)


def row(test: Expected, i: int, unit: str) -> tuple[str, ...]:
    """Return a row of the table."""
    error = in_words(float(test.error[i]), unit, 2)
    between = f"{test.low[i]:.2f} to {test.high[i]:.2f}"
    return (test.test, error, f"{test.ratio[i]:.2f}", between, percent(test.usable))
