"""The remaining error after a further test, on rigs that were left out of the learning.

Simulated rigs are measured in each test. A regression over all others says where the parameters of
a left-out one lie. The error below which 68 % of the rigs stay is a standard deviation of the
posterior, if errors are normal. The root mean square is not typical: few rigs whose misalignment is
nearly zero make most of it.

What a regression learns differs with the rigs it learns from, by more than those it is judged by:
two draws of 400 gave 0.27 and 0.48 of an error. So groups of the rigs learn by themselves, and the
scatter of what they find widens the interval (sectioning: S. Asmussen & P. W. Glynn, Stochastic
Simulation, 2007, III.5).
"""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.special import ndtr, stdtrit

from stiction.analysis.signals.correlated_noise import BOUNDS_95
from stiction.arrays import Floats, Indices
from stiction.inference.learning.summary import learn
from stiction.inference.simulated.library import have_cycles
from stiction.inference.simulated.plan import Plan
from stiction.storage.arrays import read_arrays, write_arrays

FEWEST_RIGS = 100  # rigs with cycles in a test, below which nothing is learned
TYPICAL = 0.6827  # share of the rigs whose error is at most the typical one
GROUPS = 4  # of the rigs, each of which learns by itself
RESAMPLED = 1000  # times, for the interval of a ratio
NUMBERS = ("width", "error", "ratio", "low", "high")


class Expected(NamedTuple):
    """The remaining error of each parameter after a test, (p,) each.

    Parameters
    ----------
    test : str
        Its name.
    width : ndarray
        Typical error as normal scores of the prior: 1 if nothing is learned.
    error : ndarray
        Typical error, in SI: that of 68 % of the rigs is at most so large.
    ratio, low, high : ndarray
        The typical error over that of the present test, with its 95 % interval.
    usable : float
        Share of the simulated rigs that show enough cycles in it.
    added : int
        How many channels and records it adds to the present test.
    """

    test: str
    width: Floats
    error: Floats
    ratio: Floats
    low: Floats
    high: Floats
    usable: float
    added: int = 0


def estimates(features: Floats, truth: Floats, fewest: int | None = None) -> Floats:
    """Return leave-one-out estimates of parameters (n, p), as normal scores.

    NaN for rigs without features (n, f), and for all where fewer than `fewest` have some.
    """
    complete = have_cycles(features)
    found = np.full_like(truth, np.nan)
    if complete.sum() >= (FEWEST_RIGS if fewest is None else fewest):
        found[complete] = learn(features[complete], truth[complete]).middle.library
    return found


def left_out_errors(alone: Sequence[Floats], truth: Floats, fewest: int | None = None) -> Floats:
    """Return leave-one-out errors (n, p) of a regression on the estimates of some records.

    The regression over estimates, instead of all features, needs few simulations.
    """
    joint = alone[0] if len(alone) == 1 else estimates(np.hstack(alone), truth, fewest)
    return truth - joint


def expectation(
    trial: Plan, test: str, truth: Floats, errors: Sequence[Floats], *, added: int = 0,
    by_group: Floats | None = None,
) -> Expected:  # fmt: skip
    """Return the remaining error after a test.

    `truth` (n, p) are the parameters as normal scores, `errors` the leave-one-out errors (n, p) of
    the present test, of parts of this test, and of the test itself. A rig with too few cycles in it
    has the error of the present test. If a regression learns less from more features, the error of
    a part of the test counts. `added` is the number of channels and records that the test adds;
    `by_group` (g, p) are the ratios of groups of rigs.
    """
    each = fill_in(errors)
    sizes = np.stack([np.abs(in_si(trial, truth, its)) for its in each])
    drawn = np.random.default_rng(0).integers(len(truth), size=(RESAMPLED, len(truth)))
    resampled = np.stack([resample(its, drawn) for its in sizes])
    bounds = np.quantile(resampled.min(axis=0) / resampled[0], BOUNDS_95, axis=0)
    width, error = (typical(its, axis=1).min(axis=0) for its in (np.abs(each), sizes))
    ratio = error / typical(sizes[0])
    low, high = bounds if by_group is None else bounds_with_learning(ratio, bounds, by_group)
    usable = float(have_cycles(errors[-1]).mean())
    return Expected(test, width, error, ratio, low, high, usable, added)


def fill_in(errors: Sequence[Floats]) -> Floats:
    """Return errors (m, n, p) of tests; NaN of the last test are replaced from the first."""
    usable = have_cycles(errors[-1])[:, None]
    return np.stack([*errors[:-1], np.where(usable, errors[-1], errors[0])])


def ratio_of(trial: Plan, truth: Floats, errors: Sequence[Floats]) -> Floats:
    """Return the typical errors (p,) of the last test over those of the first."""
    before, own = (np.abs(in_si(trial, truth, each)) for each in fill_in(errors)[[0, -1]])
    return np.asarray(typical(own) / typical(before))


def bounds_with_learning(ratio: Floats, bounds: Floats, by_group: Floats) -> Floats:
    """Return bounds (2, p) of ratios, wider by the uncertainty of the learning.

    Given the bounds that the rigs judged by leave, and the ratios (g, p) of groups, of which the
    mean has a standard error, in the logarithm. Both vary independently, at most.
    """
    count = len(by_group)
    learning = stdtrit(count - 1, BOUNDS_95[1]) * np.log(by_group).std(axis=0, ddof=1) / count**0.5
    half = np.hypot(np.log(bounds / ratio), learning)
    return np.asarray(ratio * np.exp([-half[0], half[1]]))


def in_si(trial: Plan, truth: Floats, errors: Floats) -> Floats:
    """Return errors (n, p) in SI, given those in normal scores."""
    priors = trial.priors.values()
    columns = [
        prior.quantile(ndtr(a - b)) - prior.quantile(ndtr(a))
        for prior, a, b in zip(priors, truth.T, errors.T, strict=True)
    ]
    return np.stack(columns, axis=1)


def typical(sizes: Floats, axis: int = 0) -> Floats:
    """Return the typical size: 68 % of the sizes are at most as large."""
    return np.asarray(np.quantile(sizes, TYPICAL, axis=axis, method="inverted_cdf"))


def resample(sizes: Floats, drawn: Indices) -> Floats:
    """Return the typical size (m, p) in each of m resamples of n rigs.

    >>> sizes = np.array([[1.0], [2.0], [3.0], [9.0]])
    >>> resample(sizes, np.array([[0, 1, 2, 3], [3, 3, 3, 3]]))[:, 0], typical(sizes)
    (array([3., 9.]), array([3.]))
    """
    last = ceil(TYPICAL * drawn.shape[1]) - 1
    columns = [np.partition(each[drawn], last, axis=1)[:, last] for each in sizes.T]
    return np.stack(columns, axis=1)


def write(path: Path | None, found: Sequence[Expected]) -> None:
    """Write the remaining errors after tests."""
    columns = {name: np.array([getattr(each, name) for each in found]) for name in Expected._fields}
    write_arrays(path, **columns)


def read(path: Path | None, names: Sequence[str]) -> list[Expected] | None:
    """Return the stored remaining errors after tests of these names; None without them."""
    arrays = read_arrays(path) or {}
    if not arrays.keys() >= {*Expected._fields} or arrays["test"].tolist() != [*names]:
        return None
    columns = [[*arrays[name]] for name in NUMBERS]
    usable, added = arrays["usable"].tolist(), arrays["added"].tolist()
    return [*map(Expected, names, *columns, usable, added)]
