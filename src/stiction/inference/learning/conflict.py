"""Contradictions between a value that a record shows and its stated distribution.

A record is compared with simulated ones by all of its features together; beside forty others one of
them may be far off. A value that follows from stated ones but for a small part, which the shape of
a record shows, is worth a test of its own. That part is learned from simulations, whose parameters
are known, so that no uncertainty of what is stated is needed to tell it.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple, Self

import numpy as np

from stiction.arrays import Floats
from stiction.inference.learning.summary import (
    CENTRAL,
    LEAST_SQUARE,
    WIDTHS,
    Standard,
    decompose,
    kernel,
    regression,
    single_threaded_algebra,
)

MOST_SIMULATIONS = 1000  # simulations to learn from: a second's work, and more teach little
NEAREST = 200  # of them, with which a record is compared
OUTER = 1.0, 99.0  # percentiles, beyond which values are those of cycles that hardly slip


class Departure(NamedTuple):
    """Distance of a value, measured or simulated, from the median of its stated distribution.

    The part that the shape of the record accounts for is subtracted.

    Parameters
    ----------
    own : float
        Of the record.
    others : ndarray
        (n,), of the simulated records.
    unexplained : ndarray
        (n,), of these, less what their parameters say.
    distances : ndarray
        (n,), squared, of their shapes from that of the record.
    """

    own: float
    others: Floats
    unexplained: Floats
    distances: Floats

    @classmethod
    def of(
        cls, shapes: Floats, values: Floats, stated: Floats, shape: Floats, value: float
    ) -> Self:
        """Compare the value of a record with those of simulated ones.

        Parameters
        ----------
        shapes : ndarray
            (n, f), features of simulated records that the value does not enter.
        values, stated : ndarray
            (n,), the value that each shows, and what its parameters say of it; both less the middle
            of what is stated.
        shape, value
            Of the record, (f,).
        """
        shapes, values, stated = (x[:MOST_SIMULATIONS] for x in (shapes, values, stated))
        standard = Standard.of(shapes)
        known, new = standard.scores(shapes), standard.scores(shape[None])
        with single_threaded_algebra():
            parts = [(width, *decompose(kernel(known, known, width))) for width in WIDTHS]
            rest = values - stated
            usual = np.clip(rest, *np.percentile(rest, OUTER))[:, None]
            middle = regression(parts, usual, known.shape[1])
            apart = rest - middle.library[:, 0]
            spread = regression(
                parts, np.log(apart * apart + LEAST_SQUARE)[:, None], known.shape[1]
            )
        own = value - float(middle.predict(new, known)[0, 0])
        places = np.column_stack([known, 0.5 * spread.library])
        place = np.append(new[0], 0.5 * spread.predict(new, known)[0])
        return cls(own, values - middle.library[:, 0], apart, ((places - place) ** 2).sum(axis=1))


class Conflict(NamedTuple):
    """Distance of a value from the median of its stated distribution.

    Parameters
    ----------
    found, error : float
        The difference, less what the shape of the record accounts for, and its standard error. Of
        several records, that which contradicts most.
    p_value : float
        Share of simulated rigs with a record as far off, of those whose shapes are alike (the prior
        predictive check of M. Evans & H. Moshonov, Bayesian Anal. 1, 893 (2006)).
    """

    found: float
    error: float
    p_value: float

    @classmethod
    def between(cls, departures: Sequence[Departure]) -> Self:
        """Compare the values of a rig's records with those of simulated rigs.

        How far off each is, over how far it usually is there. The largest of a rig counts, so that
        several records are one test: a p-value of each, multiplied by their number, could not be
        small, of so few rigs.

        Examples
        --------
        >>> random = np.random.default_rng(0)
        >>> shapes, stated = random.standard_normal((400, 2)), random.standard_normal(400)
        >>> simulated = shapes, stated + shapes[:, 0], stated
        >>> found = Conflict.between([Departure.of(*simulated, np.array([1, 0.0]), 5.0)])
        >>> round(found.found, 1), found.p_value < 0.01
        (4.0, True)
        """
        near = np.argsort(sum(its.distances for its in departures))[:NEAREST]
        usual = [half_width(its.others[near]) for its in departures]
        own = np.array([its.own for its in departures]) / usual
        others = np.stack([its.others[near] for its in departures], axis=1) / usual
        most = int(np.argmax(np.abs(own)))
        as_far = np.abs(others).max(axis=1) >= abs(own[most])
        share = float(np.count_nonzero(as_far) + 1.0) / (len(near) + 1.0)
        its = departures[most]
        return cls(its.own, half_width(its.unexplained[near]), share)


def half_width(values: Floats) -> float:
    """Return half of the width of their central 68 %: their standard deviation, if normal."""
    low, _, high = np.percentile(values, CENTRAL)
    return 0.5 * float(high - low)
