"""The likeness of a record to simulations of a mechanism: by features and by loading curve."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from stiction.arrays import Floats
from stiction.inference.learning.expectation import Expectation
from stiction.inference.learning.summary import Regression, as_arrays, estimate, from_arrays
from stiction.inference.learning.typicality import Typicality
from stiction.inference.mechanism.classifier import Simulations
from stiction.inference.posterior import RARE
from stiction.inference.predictive import departures
from stiction.progress.report import Progress, part, silent
from stiction.storage.arrays import read_arrays, write_arrays

# simulations with whose loading that of the record is compared: the fewest by which one in a
# hundred can be told (`BENT`), as more have other parameters
CURVES = 100
# shares below which a record is unlike simulations by its features, and by its loading's bend, of
# which the features tell too: a mechanism's own records are refused by both together in 5 % of
# cases at most (O. J. Dunn, J. Am. Stat. Assoc. 56, 52 (1961))
UNLIKE, BENT = 0.8 * RARE, 0.2 * RARE


class Likeness(NamedTuple):
    """The likeness of a record to simulations of a mechanism.

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

    @property
    def unlike(self) -> bool:
        """Whether the record is unlike the simulations, by its features or by its loading."""
        return self.farther < UNLIKE or self.larger < BENT

    @property
    def least(self) -> float:
        """The share `larger` of a loading that departs more than that of each simulation."""
        return 1.0 / (1.0 + len(self.bends))

    @property
    def curve_is_tested(self) -> bool:
        """Whether simulations are as many as tell a loading curve that is unlike them."""
        return self.least < BENT


class Reference(NamedTuple):
    """Simulations of a mechanism, with which records are compared.

    Parameters
    ----------
    typicality : Typicality
        Of their features.
    bends : ndarray
        (n, s), departure of the loading from a straight line in each of its parts.
    """

    typicality: Typicality
    bends: Floats

    def likeness(self, record: Floats, bend: Floats) -> Likeness:
        """Return the likeness of a record with features (f,) and bend (s,) to the simulations."""
        (farther,) = self.typicality.farther(record[None])
        bends = self.bends[self.typicality.alike(record, CURVES)]
        apart, others = departures(bend, bends)
        larger = (1.0 + float((others >= apart).sum())) / (1.0 + len(others))
        return Likeness(float(farther), bends, larger)


def learn_or_read(
    simulated: Simulations,
    scores: Floats,
    bends: Floats,
    path: Path | None = None,
    progress: Progress = silent,
) -> tuple[Reference, ...]:
    """Learn the reference of each mechanism, or read the stored ones from a file.

    The `scores` (n, f) are their standardised features, the `bends` (n, s) their loading's
    departure from straight.
    """
    places = [simulated.labels == label for label in range(len(simulated.names))]
    members = [scores[own] for own in places]
    learned = read(path, members)
    if learned is None:
        pairs = zip(members, simulated.parameters, strict=True)
        count = len(members)
        learned = [learn(*each, part(progress, done, count)) for done, each in enumerate(pairs)]
        write(path, learned)
    return tuple(Reference(its, bends[own]) for its, own in zip(learned, places, strict=True))


def learn(scores: Floats, parameters: Floats, progress: Progress = silent) -> Typicality:
    """Learn from simulations of a mechanism: features (n, f) and parameters (n, p)."""
    estimates = estimate(scores, parameters, progress)
    return Typicality.of(Expectation.of(scores, parameters, estimates))


def write(path: Path | None, learned: Sequence[Typicality]) -> None:
    """Write the reference of each mechanism."""
    arrays: dict[str, Floats] = {}
    for number, its in enumerate(learned):
        arrays |= its.arrays(str(number))
        arrays |= as_arrays(**{f"estimates{number}": its.expectation.estimates})
    write_arrays(path, **arrays)


def read(path: Path | None, members: Sequence[Floats]) -> list[Typicality] | None:
    """Return the stored references of simulations with these features; None without such a file."""
    arrays = read_arrays(path) or {}
    found = []
    try:
        for number, scores in enumerate(members):
            own = from_arrays(f"estimates{number}", Regression._fields, arrays)
            found.append(Typicality.read(arrays, scores, Regression(*own), str(number)))
    except KeyError:
        return None
    return found
