"""A classifier of mechanisms: from features of a record to probabilities that hold.

A kernel ridge regression predicts membership of each mechanism; its predictions for each simulated
record, made from all others, become probabilities by a multinomial logistic regression. That has a
few coefficients only, so that the same records may calibrate it. Each mechanism counts the same,
however many of its simulations have cycles: the odds before are even.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import ceil
from pathlib import Path
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize
from scipy.special import log_softmax, softmax

from stiction.arrays import Floats
from stiction.errors import ResultError
from stiction.inference.fit import refuse_few_simulations
from stiction.inference.learning.summary import (
    Regression,
    Standard,
    as_arrays,
    estimate,
    from_arrays,
    read_regressions,
    single_threaded_algebra,
)
from stiction.inference.mechanism.rivals import CLAIMED, Mechanism
from stiction.inference.simulated.library import (
    BLOCK,
    Ensemble,
    telling,
    will_be_too_few,
)
from stiction.inference.simulated.plan import Plan
from stiction.inference.simulated.synthetic import LONGEST_CYCLE
from stiction.progress.report import Progress, part, silent
from stiction.storage.arrays import read_arrays, write_arrays

FEWEST_SIMULATIONS = 40  # simulations with cycles, below which a mechanism is left out
SIMULATION_PARTS = "whole", "even", "odd"  # of the simulations, as they are stored
WEAK = 1e-3  # penalty on the slopes' squares: finite where mechanisms are distinguished for sure


class Simulations(NamedTuple):
    """Simulated records: features (n, f), and the place of each one's mechanism among `names` (n,).

    `absent` are the mechanisms by which hardly any simulated record has cycles of stick and slip
    that are not far longer than the measured ones;
    `parameters` (m, p) are the normal scores of those of each mechanism's records, in their order.
    """

    names: tuple[str, ...]
    features: Floats
    labels: NDArray[np.int64]
    absent: tuple[str, ...] = ()
    parameters: tuple[Floats, ...] = ()

    def among(self, names: Sequence[str]) -> Self:
        """Return the simulations of the mechanisms with these names.

        >>> two = Simulations(("a", "b"), np.array([[1.0], [2.0]]), np.array([0, 1]))
        >>> its = two.among(("b", "c"))
        >>> its.names, its.features, its.labels
        (('b',), array([[2.]]), array([0]))
        """
        places = [place for place, name in enumerate(self.names) if name in names]
        rows = np.isin(self.labels, places)
        return self._replace(
            names=tuple(self.names[place] for place in places),
            features=self.features[rows],
            labels=np.searchsorted(places, self.labels[rows]),
            absent=tuple(name for name in self.absent if name in names),
            parameters=tuple(self.parameters[place] for place in places if self.parameters),
        )


def simulate(
    rivals: Sequence[Mechanism],
    count: int,
    folder: Path | None,
    *,
    seed: int = 0,
    progress: Progress = silent,
) -> Simulations:
    """Simulate `count` records of each mechanism, the same number by each of its plans.

    Raises
    ------
    ResultError
        If by no mechanism enough of them have cycles of stick and slip, or only by one of those
        that are claimed; as soon as the first ones tell that.
    """
    begun = begin(rivals, count, folder, seed, part(progress, 0, 10))
    progress = part(progress, 1, 10, of=9)
    total = sum(len(rival.plans) for rival in rivals)
    done, found, parameters, absent = 0, {}, [], []
    usable = {}
    for rival in rivals:
        parts, drawn = [], []
        for plan in rival.plans:
            wanted = -(-count // len(rival.plans))
            made = begun[plan.key].simulate(wanted, part(progress, done, total))
            library = made.library(wanted)
            parts.append(library.features)
            drawn.append(library.scores)
            done += 1
        features = np.concatenate(parts)
        usable[rival.name] = len(features), count
        if len(features) < FEWEST_SIMULATIONS:
            absent.append(rival.name)
        else:
            found[rival.name] = features
            parameters.append(common_columns(rival.plans, drawn))
    refuse_few_of_all(usable, [*found])
    labels = np.repeat(np.arange(len(found)), [len(each) for each in found.values()])
    features = np.concatenate([*found.values()])
    return Simulations((*found,), features, labels, (*absent,), (*parameters,))


def begin(
    rivals: Sequence[Mechanism], count: int, folder: Path | None, seed: int, progress: Progress
) -> dict[str, Ensemble]:
    """Return the first simulations of each plan, by its key; none of them where all are no more.

    They are refused if they tell that by no mechanism enough of all will have cycles, or only by
    one of those that are claimed.
    """
    plans = [plan for rival in rivals for plan in rival.plans]
    found = {plan.key: Ensemble.within(folder, plan, seed) for plan in plans}
    least = telling(count, FEWEST_SIMULATIONS)
    if count <= least:
        return found
    done, usable = 0, {}
    for rival in rivals:
        # whole blocks by each plan
        some = BLOCK * ceil(least / (BLOCK * len(rival.plans)))
        its = []
        for plan in rival.plans:
            found[plan.key] = found[plan.key].simulate(some, part(progress, done, len(plans)))
            its.append(found[plan.key].library(some))
            done += 1
        usable[rival.name] = sum(len(x.scores) for x in its), sum(x.wanted for x in its)
    few, each = FEWEST_SIMULATIONS, usable.items()
    left = [name for name, its in each if not will_be_too_few(*its, count, few)]
    refuse_few_of_all(usable, left)
    return found


def refuse_few_of_all(usable: Mapping[str, tuple[int, int]], left: Sequence[str]) -> None:
    """Refuse simulations of which enough have cycles by none, or by one of the mechanisms.

    Of each, how many have some, and of how many; `left` are those by which enough may have some.
    """
    compared = [name for name in usable if name in CLAIMED]
    alone = [name for name in left if name in CLAIMED]
    if len(alone) < min(len(compared), 2) and left:
        raise ResultError(
            f"only by {' and '.join(alone or left)} do simulated records have cycles no longer "
            f"than {LONGEST_CYCLE:g} times the measured ones: there is nothing to compare, which "
            "itself speaks for it"
        )
    if left:
        return
    most = max(usable, key=lambda name: usable[name][0] / usable[name][1])
    what = f"simulated records of {most}, and by no mechanism more,"
    refuse_few_simulations(what, *usable[most], FEWEST_SIMULATIONS)


def common_columns(plans: Sequence[Plan], scores: Sequence[Floats]) -> Floats:
    """Return parameters of several plans' simulations in common columns, (n, p).

    A parameter that a plan lacks is 0, the middle of its prior. Of several plans, each has an
    indicator column. Columns without variance are left out: those of a plan without simulations.
    """
    paths = [*dict.fromkeys(path for plan in plans for path in plan.priors)]
    whose = np.eye(len(plans)) if len(plans) > 1 else np.zeros((1, 0))
    found = []
    for plan, some, its in zip(plans, scores, whose, strict=True):
        rows = np.zeros((len(some), len(paths)))
        rows[:, [paths.index(path) for path in plan.priors]] = some
        found.append(np.hstack([rows, np.tile(its, (len(some), 1))]))
    united = np.concatenate(found)
    return united[:, np.ptp(united, axis=0) > 0.0]


class Discriminant(NamedTuple):
    """A discriminant of mechanisms, learned from some simulations."""

    scores: Floats  # (n, f), standardised features of the simulations
    membership: Regression  # of each mechanism, 0 or 1
    slopes: Floats  # (k + 1, k), from its predictions to log odds, the constant last

    @classmethod
    def of(cls, scores: Floats, labels: NDArray[np.int64], progress: Progress = silent) -> Self:
        """Learn from simulations with these scores (n, f) and places of their mechanism (n,)."""
        membership = estimate(scores, np.eye(labels.max() + 1)[labels], progress)
        with single_threaded_algebra():
            return cls(scores, membership, logistic(membership.library, labels))

    def probabilities(self, scores: Floats) -> Floats:
        """Return the probability of each mechanism (m, k) for records with scores (m, f)."""
        return self._calibrate(self.membership.predict(scores, self.scores))

    @property
    def left_out(self) -> Floats:
        """Leave-one-out probabilities (n, k) of the simulations."""
        return self._calibrate(self.membership.library)

    def _calibrate(self, predicted: Floats) -> Floats:
        found: Floats = softmax(with_constant(predicted) @ self.slopes, axis=1)
        return found


class Classifier(NamedTuple):
    """A classifier of mechanisms, and its dependence on the simulations drawn."""

    standard: Standard  # how features are made comparable
    whole: Discriminant  # learned from all simulations
    halves: tuple[Discriminant, ...]  # learned from every second one, and from the others

    def probabilities(self, features: Floats) -> Floats:
        """Return the probability of each mechanism (m, k) for records with features (m, f)."""
        return self.whole.probabilities(self.standard.scores(np.atleast_2d(features)))

    def probabilities_by_halves(self, features: Floats) -> Floats:
        """Return these probabilities by each half of the simulations, (2, m, k)."""
        scores = self.standard.scores(np.atleast_2d(features))
        return np.stack([half.probabilities(scores) for half in self.halves])

    @property
    def left_out_by_halves(self) -> Floats:
        """Leave-one-out probabilities (2, n, k) of the simulations, by each half."""
        own, scores = halve(len(self.whole.scores)), self.whole.scores
        found = np.stack([half.probabilities(scores) for half in self.halves])
        for its, half, rows in zip(found, self.halves, own, strict=True):
            its[rows] = half.left_out
        return found


def halve(count: int) -> tuple[slice, slice]:
    """Return a mask of the simulations that belong to each half."""
    return slice(0, count, 2), slice(1, count, 2)


def learn_or_read(
    simulations: Simulations, path: Path | None = None, progress: Progress = silent
) -> Classifier:
    """Learn to distinguish mechanisms, or read the stored classifier from a file."""
    features, labels = simulations.features, simulations.labels
    stored = read(path, features)
    if stored is not None:
        return stored
    standard = Standard.of(features)
    scores = standard.scores(features)
    whole = Discriminant.of(scores, labels, part(progress, 0, 10, of=8))
    reports = part(progress, 8, 10), part(progress, 9, 10)
    halves = tuple(
        Discriminant.of(scores[rows], labels[rows], report)
        for rows, report in zip(halve(len(scores)), reports, strict=True)
    )
    found = Classifier(standard, whole, halves)
    write(path, found)
    return found


def write(path: Path | None, found: Classifier) -> None:
    """Write a classifier."""
    arrays = as_arrays(standard=found.standard)
    for name, each in zip(SIMULATION_PARTS, (found.whole, *found.halves), strict=True):
        arrays |= as_arrays(**{name: each.membership}) | {f"{name}_slopes": each.slopes}
    write_arrays(path, **arrays)


def read(path: Path | None, features: Floats) -> Classifier | None:
    """Return a stored classifier of simulations with these features (n, f); None without one."""
    arrays = read_arrays(path) or {}
    try:
        standard, (membership,) = read_regressions(arrays, features, SIMULATION_PARTS[0])
        scores, (name, *halves) = standard.scores(features), SIMULATION_PARTS
        whole = Discriminant(scores, membership, arrays[f"{name}_slopes"])
        found = []
        for name, rows in zip(halves, halve(len(scores)), strict=True):
            own = Regression(*from_arrays(name, Regression._fields, arrays))
            found.append(Discriminant(scores[rows], own, arrays[f"{name}_slopes"]))
        return Classifier(standard, whole, (*found,))
    except KeyError:
        return None


def logistic(predictors: Floats, labels: NDArray[np.int64]) -> Floats:
    """Return the slopes (p + 1, k) of a multinomial logistic regression, all labels equally heavy.

    >>> random = np.random.default_rng(1)
    >>> labels = np.repeat([0, 1], 20000)
    >>> x = random.standard_normal(40000) + labels  # log odds are x - 1/2
    >>> slopes = logistic(x[:, None], labels)
    >>> np.diff(slopes)[:, 0].round(1)
    array([ 1. , -0.5])
    """
    columns, count = with_constant(predictors), labels.max() + 1
    members = np.eye(count)[labels]
    weights = 1.0 / (count * np.bincount(labels)[labels])

    def loss(flat: Floats) -> tuple[float, Floats]:
        slopes = flat.reshape(columns.shape[1], count)
        logs = log_softmax(columns @ slopes, axis=1)
        apart = (np.exp(logs) - members) * weights[:, None]
        penalty = WEAK / len(labels) * slopes
        value = 0.5 * float((penalty * slopes).sum()) - weights @ (members * logs).sum(axis=1)
        return float(value), (columns.T @ apart + penalty).ravel()

    start = np.zeros(columns.shape[1] * count)
    found: Any = minimize(  # type: ignore[no-untyped-call]
        loss, start, jac=True, method="L-BFGS-B", options={"maxiter": 2000}
    )
    return np.asarray(found.x.reshape(columns.shape[1], count))


def with_constant(predictors: Floats) -> Floats:
    """Return predictors (n, p) with a column of ones after them."""
    return np.column_stack([predictors, np.ones(len(predictors))])
