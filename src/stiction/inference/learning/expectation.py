"""The expected features of a record, given the parameters estimated from it.

One regression estimates the parameters from the features, another one the features from these
estimates. How far a record's features are from it tells a record of another kind, also one that
lies between the library's records.
"""

from __future__ import annotations

from typing import NamedTuple, Self

import numpy as np

from stiction.arrays import Floats
from stiction.inference.learning.summary import (
    UNKNOWN,
    Regression,
    decompose,
    kernel,
    regression,
    single_threaded_algebra,
)

NARROW = 0.6  # width of the kernel by which estimates say what features are: these are more bent


class Expectation(NamedTuple):
    """Regressions of parameters over features, and of features over those estimates."""

    scores: Floats  # (n, f), standardised features of the library
    shown: Floats  # (p,), whether features say something of a parameter, 0 or 1
    estimates: Regression  # of the parameters
    # of the features, over the estimates of those that are shown, in their standard deviations
    expected: Regression

    @classmethod
    def of(cls, scores: Floats, parameters: Floats, estimates: Regression) -> Self:
        """Learn from a library's standardised features (n, f), parameters (n, p) and estimates."""
        errors = ((estimates.library - parameters) ** 2).mean(axis=0) / parameters.var(axis=0)
        shown = (errors <= max(UNKNOWN, errors.min())).astype(np.float64)
        places = in_deviations(estimates.library, estimates, shown)
        with single_threaded_algebra():
            part = NARROW, *decompose(kernel(places, places, NARROW))
            return cls(scores, shown, estimates, regression([part], scores, places.shape[1]))

    @property
    def places(self) -> Floats:
        """Leave-one-out estimates of the library's records (n, q)."""
        return in_deviations(self.estimates.library, self.estimates, self.shown)

    @property
    def library(self) -> tuple[Floats, Floats]:
        """Leave-one-out estimates (n, q), and departures from the expected features (n, f)."""
        return self.places, self.scores - self.expected.library

    def __call__(self, new: Floats) -> tuple[Floats, Floats]:
        """Return estimates (m, q) and departures (m, f) for new standardised features (m, f)."""
        places = in_deviations(self.estimates.predict(new, self.scores), self.estimates, self.shown)
        return places, new - self.expected.predict(places, self.places)


def in_deviations(values: Floats, estimates: Regression, shown: Floats) -> Floats:
    """Return the estimates (m, q) of identified parameters, in standard deviations."""
    found: Floats = (values / estimates.library.std(axis=0))[:, shown > 0.0]
    return found
