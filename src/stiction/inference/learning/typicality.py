"""The typicality of a record: the share of a library that is less like the others.

By its features in two ways: how far they lie from those of the nearest records, and how far from
what is expected with the parameters that the record seems to have. Both over how far those around
it lie: after M. M. Breunig, H.-P. Kriegel, R. T. Ng & J. Sander, SIGMOD 2000, 93
(doi:10.1145/342009.335388). Simulations that hardly slip lie far apart, each from all, and beside
them no record of another rig would be unlike.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple, Self

import numpy as np

from stiction.arrays import Floats, Indices
from stiction.inference.learning.expectation import Expectation
from stiction.inference.learning.summary import (
    Regression,
    as_arrays,
    from_arrays,
    single_threaded_algebra,
)

NEIGHBOURS = 150  # records from which a distance is measured
AROUND = 20  # records around one, with whose distances its own is compared
SHRINKAGE = 0.1  # of correlations between features, which so few records do not show well
ITSELF = 1e-8  # squared distance
LEAST_VARIANCE = 1e-12
CLOUDS, KEPT = ("near", "beside"), ("apart", "own")  # what is stored of which


class Cloud(NamedTuple):
    """Points, each compared with the points whose places are nearest to its own."""

    places: Floats  # (n, q), where they are
    points: Floats  # (n, f), what is compared
    # (n,), distance of each from its nearest others; and over that of the ones around it
    apart: Floats
    own: Floats

    @classmethod
    def of(cls, places: Floats, points: Floats) -> Self:
        """Return points (n, f) at places (n, q)."""
        square = squares(places, places)
        with single_threaded_algebra():
            apart = distances(square, points, points)
        return cls(places, points, apart, apart / apart_around(square, apart))

    def nearer(self, places: Floats, points: Floats) -> Floats:
        """Return, for each new point, the share of the points that lie as near or nearer, (m,)."""
        square = squares(places, self.places)
        its = distances(square, points, self.points) / apart_around(square, self.apart)
        return np.searchsorted(np.sort(self.own), its, side="right") / len(self.own)

    @property
    def ranks(self) -> Floats:
        """The share of the points that lie as near or nearer, for each of the points, (n,)."""
        return np.searchsorted(np.sort(self.own), self.own, side="right") / len(self.own)


class Typicality(NamedTuple):
    """Records of a library, with which new records are compared."""

    expectation: Expectation  # what their parameters let expect
    near: Cloud  # their features, at themselves
    beside: Cloud  # how far these are from what is expected, at the parameters

    @classmethod
    def of(cls, expectation: Expectation) -> Self:
        """Return the typicality of the records from which an expectation was learned."""
        scores = expectation.scores
        return cls(expectation, Cloud.of(scores, scores), Cloud.of(*expectation.library))

    def farther(self, new: Floats) -> Floats:
        """Return the share of the library that is less typical, for new scores (m, f)."""
        nearer = np.maximum(self.near.nearer(new, new), self.beside.nearer(*self.expectation(new)))
        own = np.sort(np.maximum(self.near.ranks, self.beside.ranks))
        return 1.0 - np.searchsorted(own, nearer, side="right") / len(own)

    def alike(self, record: Floats, count: int) -> Indices:
        """Return the library's records with parameters nearest to the estimates of one (f,)."""
        places, _ = self.expectation(record[None])
        return np.argsort(((self.beside.places - places) ** 2).sum(axis=1))[:count]

    def arrays(self, of: str = "") -> dict[str, Floats]:
        """Return the arrays that `read` restores by name, without the estimates."""
        found = as_arrays(**{f"expected{of}": self.expectation.expected})
        for name, cloud in zip(CLOUDS, (self.near, self.beside), strict=True):
            found |= {f"{name}{of}_{part}": getattr(cloud, part) for part in KEPT}
        return found | {f"shown{of}": self.expectation.shown}

    @classmethod
    def read(
        cls, arrays: Mapping[str, Floats], scores: Floats, estimates: Regression, of: str = ""
    ) -> Self:
        """Return a stored typicality of a library with these scores; raise a KeyError if none."""
        expected = Regression(*from_arrays(f"expected{of}", Regression._fields, arrays))
        shown = arrays[f"shown{of}"]
        lengths = {len(arrays[f"{cloud}{of}_{name}"]) for cloud in CLOUDS for name in KEPT}
        same = expected.library.shape == scores.shape and lengths == {len(scores)}
        if not same or shown.shape != estimates.mean.shape or not of_library(expected, scores):
            raise KeyError(of)
        expectation = Expectation(scores, shown, estimates, expected)
        near, beside = (
            Cloud(*each, *(arrays[f"{name}{of}_{part}"] for part in KEPT))
            for name, each in zip(CLOUDS, ((scores, scores), expectation.library), strict=True)
        )
        return cls(expectation, near, beside)


def of_library(expected: Regression, scores: Floats) -> bool:
    """Return whether expected features were learned from a library with these scores (n, f)."""
    return bool(np.allclose(expected.mean, scores.mean(axis=0), rtol=1e-9, atol=1e-12))


def distances(square: Floats, some: Floats, points: Floats) -> Floats:
    """Return Mahalanobis distances of points (m, f) from the points nearest to each.

    Squared, over the number of features; nearest by squared distances of places (m, n), infinite
    for a point itself.
    """
    count = min(NEIGHBOURS, len(points) // 2)
    found = np.empty(len(some))
    for i, one in enumerate(some):
        near = points[np.argpartition(square[i], count - 1)[:count]]
        off = one - near.mean(axis=0)
        spread = np.cov(near.T)
        variance = np.diag(spread) + LEAST_VARIANCE
        spread = (1.0 - SHRINKAGE) * spread + SHRINKAGE * np.diag(variance)
        found[i] = off @ np.linalg.solve(spread, off) / len(off)
    return found


def apart_around(square: Floats, apart: Floats) -> Floats:
    """Return the median distance of the neighbours of each record from their own nearest, (m,)."""
    count = min(AROUND, len(apart) // 2)
    around = np.argpartition(square, count, axis=1)[:, :count]
    return np.asarray(np.median(apart[around], axis=1))


def squares(some: Floats, others: Floats) -> Floats:
    """Return the squared distances (m, n) of places from others, infinite from themselves."""
    square = (some * some).sum(axis=1)[:, None] + (others * others).sum(axis=1)[None, :]
    square -= 2.0 * (some @ others.T)
    square[square < ITSELF] = np.inf
    return np.asarray(square)
