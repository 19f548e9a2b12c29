"""How far a test is expected to narrow what is known, over the rigs that the priors allow.

Simulated rigs are measured in each test. A regression over all others says where the parameters of
a left-out one lie; how far off it is, on average, is what the test leaves open. The mean square is
the expected variance of the posterior, if the regression is as good as its mean (P. Fearnhead & D.
Prangle, J. R. Stat. Soc. B 74, 419 (2012)).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtr

from stiction.arrays import Floats
from stiction.inference.library import Plan
from stiction.inference.summary import learn

RESAMPLED = 1000  # times, for the interval of a ratio
TAILS = (0.025, 0.975)


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


def whole(rows: Floats) -> NDArray[np.bool_]:
    """Return which rows (n, f) are finite."""
    return np.asarray(np.isfinite(rows).all(axis=1))


def misses(records: Sequence[Floats], truth: Floats) -> Floats:
    """Return how far each rig's parameters lie from what all others say, (n, p).

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
    complete = whole(np.hstack(records))
    found = np.full_like(truth, np.nan)
    if complete.sum() > 2:
        alone = [learn(each[complete], truth[complete]).middle.library for each in records]
        joint = alone[0]
        if len(alone) > 1:
            joint = learn(np.hstack(alone), truth[complete]).middle.library
        found[complete] = truth[complete] - joint
    return found


def expectation(trial: Plan, test: str, truth: Floats, after: Floats, before: Floats) -> Expected:
    """Return what a test leaves open, from misses (n, p) with it and with the present test alone.

    For a rig that shows too few cycles in a test, the present one is all that is known.
    """
    usable = whole(after)
    missed = np.where(usable[:, None], after, before)
    squares, reference = missed**2, before**2
    count = len(before)
    drawn = np.random.default_rng(0).multinomial(count, np.full(count, 1.0 / count), RESAMPLED)
    ratios = np.sqrt((drawn @ squares) / (drawn @ reference))
    low, high = np.quantile(ratios, TAILS, axis=0)
    width = np.sqrt(squares.mean(axis=0))
    ratio = width / np.sqrt(reference.mean(axis=0))
    errors = [
        np.sqrt(np.mean((prior.quantile(ndtr(a - b)) - prior.quantile(ndtr(a))) ** 2))
        for prior, a, b in zip(trial.priors.values(), truth.T, missed.T, strict=True)
    ]
    return Expected(test, width, np.array(errors), ratio, low, high, float(usable.mean()))
