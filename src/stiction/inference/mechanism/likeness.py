"""How like a record is to simulations of a mechanism: by all its features, and by its loading.

Both are compared with the nearest simulations of the mechanism. How far a simulation lies from its
own nearest ones, itself left out, says how far a record may.
"""

from __future__ import annotations

from typing import NamedTuple, Self

import numpy as np

from stiction.arrays import Floats
from stiction.inference.learning.summary import apart_around, squares
from stiction.inference.predictive import departures

NEIGHBOURS = 150  # simulations from which a distance is measured
SHRINKAGE = 0.1  # of correlations between features, which so few simulations do not show well
CURVES = 60  # simulations with whose loading that of the record is compared
LEAST = 1e-12


class Likeness(NamedTuple):
    """How like a record is to simulations of a mechanism.

    Parameters
    ----------
    farther : float
        Share of the mechanism's simulations that lie farther from their nearest ones.
    bends : ndarray
        (m, s), departure of the loading from a straight line over its rise, of the nearest
        simulations, in each part of the loading.
    larger : float
        Share of these whose loading departs more from their mean: a posterior predictive p-value.
    """

    farther: float
    bends: Floats
    larger: float


class Reference(NamedTuple):
    """Simulations of a mechanism, with which records are compared.

    Parameters
    ----------
    members : ndarray
        (n, f), features in units in which they are comparable.
    bends : ndarray
        (n, s), departure of the loading from a straight line in each of its parts.
    apart, own : ndarray
        (n,), distance of each from its nearest others; and over that of the ones around it.
    """

    members: Floats
    bends: Floats
    apart: Floats
    own: Floats

    @classmethod
    def of(cls, members: Floats, bends: Floats) -> Self:
        """Return the reference of simulations with these features."""
        apart = distances(members, members)
        return cls(members, bends, apart, apart / apart_around(squares(members, members), apart))

    def likeness(self, record: Floats, bend: Floats) -> Likeness:
        """Return how like a record with features (f,) and bend (s,) is to the simulations."""
        around = apart_around(squares(record[None], self.members), self.apart)
        (its,) = distances(record[None], self.members) / around
        near = np.argsort(((self.members - record) ** 2).sum(axis=1))[:CURVES]
        apart, others = departures(bend, self.bends[near])
        larger = (1.0 + float((others >= apart).sum())) / (1.0 + len(others))
        return Likeness(float((self.own > its).mean()), self.bends[near], larger)


def distances(some: Floats, members: Floats) -> Floats:
    """Return how far records (m, f) lie from the members nearest to each, by Mahalanobis' distance.

    Squared, over the number of features; a record that is itself a member does not count.
    """
    count = min(NEIGHBOURS, len(members) // 2)
    found = np.empty(len(some))
    for i, one in enumerate(some):
        apart = members - one
        square = (apart * apart).sum(axis=1)
        square[square < LEAST] = np.inf  # itself
        near = members[np.argpartition(square, count - 1)[:count]]
        off = one - near.mean(axis=0)
        spread = np.cov(near.T)
        variance = np.diag(spread) + LEAST
        spread = (1.0 - SHRINKAGE) * spread + SHRINKAGE * np.diag(variance)
        found[i] = off @ np.linalg.solve(spread, off) / len(off)
    return found
