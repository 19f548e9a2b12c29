"""Advice on the next test: the expected width of each parameter, in sentences and tables."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from stiction.arrays import same_fields, xr
from stiction.inference.next_test.expected import FEWEST_RIGS, NUMBERS, Expected
from stiction.inference.next_test.further import AGAIN
from stiction.inference.posterior import unit_of
from stiction.inference.simulated.plan import Plan
from stiction.names import draw
from stiction.text.paths import short_names
from stiction.text.quantity.wording import in_words, percent
from stiction.text.sections import Report, Section, Table

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@dataclass(frozen=True, eq=False, repr=False)
class Advice(Report):
    """The expected gain of further tests in the parameters of a rig.

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
    rare : tuple of str
        Tests in which hardly any of these rigs has cycles.
    doubt : str
        What speaks against the advice, as a sentence: a record that is not of this rig.
    """

    plan: Plan
    of: str
    tests: tuple[Expected, ...]
    skipped: tuple[str, ...]
    assumed: tuple[str, ...]
    simulations: int
    rare: tuple[str, ...] = ()
    doubt: str = ""

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
        """The further tests, the one that narrows the parameter most first."""
        return sorted(self.tests[1:], key=lambda test: test.ratio[self.index])

    @property
    def best(self) -> Expected | None:
        """The recommended test, the best of those that are clearly better than the present one.

        It is the one that tells most, or a simpler one that may tell as much.
        """
        i = self.index
        clear = [test for test in self.ranked if test.high[i] < 1.0]
        if not clear:
            return None
        as_good = [test for test in clear if test.ratio[i] <= clear[0].high[i]]
        return min(as_good, key=lambda test: (test.added, test.ratio[i]))

    @property
    def data(self) -> xr.Dataset:
        """Widths, errors and ratios as a dataset over ``test`` and ``parameter``."""
        dims = ("test", "parameter")
        columns: dict[str, Any] = {
            name: (dims, np.array([getattr(test, name) for test in self.tests])) for name in NUMBERS
        }
        columns["usable"] = ("test", np.array([test.usable for test in self.tests]))
        names = {"test": [test.test for test in self.tests], "parameter": [*self.plan.priors]}
        return xr.Dataset(columns, names)

    def __eq__(self, other: object) -> bool:
        """Compare the fields, of arrays the values."""
        return same_fields(self, other)

    def __repr__(self) -> str:
        """Return a one-line summary."""
        best = self.best or self.ranked[0]
        return (
            f"<Advice: best for {self.of}: {best.test}, {best.ratio[self.index]:.2f} of the error>"
        )

    def tables(self) -> list[Section]:
        """Return the findings as sentences and tables."""
        unit = unit_of(self.plan, self.of)
        rows = [row(test, self.index, unit) for test in (self.present, *self.ranked)]
        headings = ("test", f"typical error of {self.of}", "over present", "95 %", "usable")
        found = [Section("What to measure next", self.sentences(), Table(headings, rows))]
        names = [*self.plan.priors]
        widths = [
            (test.test, *(percent(each) for each in test.width))
            for test in (self.present, *self.ranked)
        ]
        short = short_names(names).values()
        return [
            *found,
            Section(
                "Width of the posterior over that of the prior",
                ["100 % where a test says nothing of a parameter."],
                Table(("test", *short), widths),
            ),
        ]

    def sentences(self) -> list[str]:
        """Return the recommendation, and the grounds for it."""
        i, best, first = self.index, self.best, self.ranked[0]
        unit = unit_of(self.plan, self.of)
        before = in_words(float(self.present.error[i]), unit, 2)
        found = [self.doubt] if self.doubt else []
        if best is not None:
            after = in_words(float(best.error[i]), unit, 2)
            found.append(
                f"Most is learned about {self.of} from: {best.test}. Its typical error falls "
                f"from {before} to {after}, to {best.ratio[i]:.2f} of that of the present test "
                f"(95 %: {best.low[i]:.2f} to {best.high[i]:.2f})."
            )
            if best is not first:
                found.append(
                    f"Perhaps this test tells more, but that is not certain: {first.test}, to "
                    f"{first.ratio[i]:.2f} of it (95 %: {first.low[i]:.2f} to {first.high[i]:.2f})."
                )
        else:
            found.append(
                f"None of these tests clearly tells more of {self.of} than the present one, whose "
                f"typical error is {before}."
            )
        idle = self.not_surely_better()
        if best is not None and best.test in idle:
            found.append(f"It is not certain that it tells more than {AGAIN}: simulate more.")
        if others := [test for test in idle if best is None or test != best.test]:
            found.append(f"Not certainly better than {AGAIN}: {', '.join(others)}.")
        if self.skipped:
            found.append(
                "Left out, as the rig does not stick and slip there in the middle of its priors: "
                f"{', '.join(self.skipped)}."
            )
        if self.rare:
            found.append(
                f"Left out, as fewer than {FEWEST_RIGS} of the rigs have cycles there: "
                f"{', '.join(self.rare)}."
            )
        found.append(
            "A hold tells nothing: this law has no memory of how long the contact was at rest."
        )
        found += self.assumed
        found.append(
            f"Expected over {self.simulations} rigs drawn from the priors, with cycles now. "
            "For a single rig the error may fall by more or by less: the intervals are those of "
            "the mean."
        )
        return found

    def not_surely_better(self) -> Sequence[str]:
        """Return the names of tests within the interval of one more test of the present kind."""
        i = self.index
        (again,) = (test for test in self.tests if test.test == AGAIN)
        others = (test for test in self.ranked if test is not again)
        return [test.test for test in others if test.ratio[i] >= again.low[i]]

    def plot(self, ax: Any = None) -> Axes:
        """Draw the expected width from each test; see `stiction.plotting.plot_design`."""
        drawn: Axes = draw("plot_design", self, ax)
        return drawn


def row(test: Expected, i: int, unit: str) -> tuple[str, ...]:
    """Return a row of the table."""
    error = in_words(float(test.error[i]), unit, 2)
    between = f"{test.low[i]:.2f} to {test.high[i]:.2f}"
    return (test.test, error, f"{test.ratio[i]:.2f}", between, percent(test.usable))
