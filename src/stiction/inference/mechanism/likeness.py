"""How like a record is to simulations of a mechanism: by all its features, and by its loading.

By its features in two ways: how far they lie from those of the nearest simulations, and how far
from what is expected of simulations with the parameters that the record seems to have. How far a
simulation lies from the others says how far a record may.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple, Self

import numpy as np

from stiction.arrays import Floats
from stiction.inference.learning.expectation import Expectation
from stiction.inference.learning.summary import (
    Regression,
    apart_around,
    as_arrays,
    from_arrays,
    squares,
)
from stiction.inference.mechanism.classifier import Simulations
from stiction.inference.predictive import departures
from stiction.storage.arrays import read_arrays, write_arrays

NEIGHBOURS = 150  # simulations from which a distance is measured
SHRINKAGE = 0.1  # of correlations between features, which so few simulations do not show well
CURVES = 60  # simulations with whose loading that of the record is compared
LEAST = 1e-12


class Likeness(NamedTuple):
    """How like a record is to simulations of a mechanism.

    Parameters
    ----------
    farther : float
        Share of the mechanism's simulations that are less like the others: farther from the
        nearest ones, or from what is expected of their parameters.
    bends : ndarray
        (m, s), departure of the loading from a straight line over its rise, in each part of the
        loading, of simulations with the parameters that the record seems to have.
    larger : float
        Share of these whose loading departs more from their mean: a posterior predictive p-value.
    """

    farther: float
    bends: Floats
    larger: float


def learn_or_read_references(
    simulated: Simulations, scores: Floats, bends: Floats, path: Path | None = None
) -> tuple[Reference, ...]:
    """Learn the reference of each mechanism, or read from a file what was learned.

    Parameters
    ----------
    simulated : Simulations
        Of all mechanisms.
    scores, bends : ndarray
        (n, f) and (n, s), their standardised features, and their loading's departure from straight.
    path : Path, optional
        Of the file.
    """
    places = [simulated.labels == label for label in range(len(simulated.names))]
    members = [scores[own] for own in places]
    learned = read(path, members)
    if learned is None:
        learned = [
            Expectation.of(*each) for each in zip(members, simulated.parameters, strict=True)
        ]
        if path is not None:
            write(path, learned)
    return tuple(Reference.of(its, bends[own]) for its, own in zip(learned, places, strict=True))


def write(path: Path, learned: Sequence[Expectation]) -> None:
    """Write what was learned of each mechanism."""
    arrays: dict[str, Floats] = {}
    for number, its in enumerate(learned):
        arrays[f"shown{number}"] = its.shown
        for name, part in (("estimates", its.estimates), ("expected", its.expected)):
            arrays |= as_arrays(**{f"{name}{number}": part})
    write_arrays(path, **arrays)


def read(path: Path | None, members: Sequence[Floats]) -> list[Expectation] | None:
    """Return what was learned of simulations with these features; None without such a file."""
    arrays = read_arrays(path)
    if arrays is None:
        return None
    found = []
    try:
        for number, features in enumerate(members):
            estimates, expected = (
                Regression(*from_arrays(f"{name}{number}", Regression._fields, arrays))
                for name in ("estimates", "expected")
            )
            if expected.library.shape != features.shape:
                return None
            found.append(Expectation(features, arrays[f"shown{number}"], estimates, expected))
    except KeyError:
        return None
    return found


class Cloud(NamedTuple):
    """Points, each of which is compared with those whose places are nearest to its own.

    Parameters
    ----------
    places : ndarray
        (n, q), where they are.
    points : ndarray
        (n, f), what is compared.
    apart, own : ndarray
        (n,), distance of each from its nearest others; and over that of the ones around it.
    """

    places: Floats
    points: Floats
    apart: Floats
    own: Floats

    @classmethod
    def of(cls, places: Floats, points: Floats) -> Self:
        """Return points (n, f) at places (n, q)."""
        square = squares(places, places)
        apart = distances(square, points, points)
        return cls(places, points, apart, apart / apart_around(square, apart))

    def nearer(self, place: Floats, point: Floats) -> float:
        """Return the share of the points that lie no farther from their nearest than a new one."""
        square = squares(place[None], self.places)
        its = distances(square, point[None], self.points) / apart_around(square, self.apart)
        return float((self.own <= its).mean())

    @property
    def ranks(self) -> Floats:
        """The same share for each of the points, (n,)."""
        return np.searchsorted(np.sort(self.own), self.own, side="right") / len(self.own)


class Reference(NamedTuple):
    """Simulations of a mechanism, with which records are compared.

    Parameters
    ----------
    expectation : Expectation
        What their parameters let expect.
    clouds : tuple of Cloud
        Their features, in units in which they are comparable, at themselves; and the departures of
        these from what is expected, at the parameters.
    bends : ndarray
        (n, s), departure of the loading from a straight line in each of its parts.
    """

    expectation: Expectation
    clouds: tuple[Cloud, Cloud]
    bends: Floats

    @classmethod
    def of(cls, expectation: Expectation, bends: Floats) -> Self:
        """Return the reference of simulations with what they let expect, and their bends (n, s)."""
        members = expectation.scores
        clouds = Cloud.of(members, members), Cloud.of(*expectation.library)
        return cls(expectation, clouds, bends)

    def likeness(self, record: Floats, bend: Floats) -> Likeness:
        """Return how like a record with features (f,) and bend (s,) is to the simulations."""
        (place,), (rest,) = self.expectation(record[None])
        near, beside = self.clouds
        nearer = max(near.nearer(record, record), beside.nearer(place, rest))
        farther = float((np.maximum(near.ranks, beside.ranks) > nearer).mean())
        around = np.argsort(((beside.places - place) ** 2).sum(axis=1))[:CURVES]
        apart, others = departures(bend, self.bends[around])
        larger = (1.0 + float((others >= apart).sum())) / (1.0 + len(others))
        return Likeness(farther, self.bends[around], larger)


def distances(square: Floats, some: Floats, points: Floats) -> Floats:
    """Return how far some points (m, f) lie from those nearest to each, by Mahalanobis' distance.

    Squared, over the number of features; nearest by squared distances of places (m, n), infinite
    for a point itself.
    """
    count = min(NEIGHBOURS, len(points) // 2)
    found = np.empty(len(some))
    for i, one in enumerate(some):
        near = points[np.argpartition(square[i], count - 1)[:count]]
        off = one - near.mean(axis=0)
        spread = np.cov(near.T)
        variance = np.diag(spread) + LEAST
        spread = (1.0 - SHRINKAGE) * spread + SHRINKAGE * np.diag(variance)
        found[i] = off @ np.linalg.solve(spread, off) / len(off)
    return found
