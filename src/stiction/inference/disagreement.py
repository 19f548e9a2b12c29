"""Whether records of a rig contradict each other, or the rate of loading that is stated.

What each record says, apart from the others.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations
from typing import NamedTuple

import numpy as np

from stiction.arrays import Floats
from stiction.inference.columns import shape_features
from stiction.inference.features import DROP, LOADING
from stiction.inference.learning.conflict import Conflict
from stiction.inference.learning.summary import FeatureSummary
from stiction.inference.observation import Observation, steadiness
from stiction.inference.simulated.library import Library
from stiction.inference.simulated.loading_rate import logarithms_of_rate


class Disagreement(NamedTuple):
    """How far several records of a rig disagree about a parameter.

    `p_value` is the share of simulated rigs with records that disagree as far about a parameter.
    """

    name: str
    p_value: float


class Told(NamedTuple):
    """What one record says by itself of each parameter: middles and spreads, (n, p) and (1, p).

    Of the simulated rigs, each from all others, and of the measured one.
    """

    middles: Floats
    spreads: Floats
    middle: Floats
    spread: Floats


def disagreement(
    names: Sequence[str], truth: Floats, alone: Sequence[FeatureSummary], observed: Sequence[Floats]
) -> Disagreement:
    """Return of which parameter several records say most clearly something else.

    Two ways to tell what a record says count: the learned one knows how sure it is; a linear
    regression has errors that records share, as that of a gain, and these cancel.

    Parameters
    ----------
    names : sequence of str
        Of the parameters.
    truth : ndarray
        (n, p), of the simulated rigs.
    alone : sequence of FeatureSummary
        What the features of each record say by themselves, learned from these rigs.
    observed : sequence of ndarray
        (f,), the features of each record.
    """
    both = [*zip(alone, observed, strict=True)]
    learned = [Told(*its.library, *its(own)) for its, own in both]
    linear = [line_of(truth, its, own) for its, own in both]
    found = [_most_apart(names, each) for each in (learned, linear)]
    least = min(found, key=lambda each: each.p_value)
    return least._replace(p_value=steadiness(each.p_value for each in found))


def line_of(truth: Floats, summary: FeatureSummary, observed: Floats) -> Told:
    """Return what a linear regression over its features says of a record."""
    new = summary.standard.scores(observed[None])
    columns, row = (np.column_stack([np.ones(len(x)), x]) for x in (summary.scores, new))
    slopes = np.linalg.lstsq(columns, truth, rcond=None)[0]
    return Told(columns @ slopes, np.ones_like(truth), row @ slopes, np.ones_like(truth[:1]))


def _most_apart(names: Sequence[str], told: Sequence[Told]) -> Disagreement:
    """Return of which parameter records differ most, over how far they usually do."""
    pairs = [*combinations(told, 2)]
    usual = np.stack(
        [(a.middles - b.middles) / np.hypot(a.spreads, b.spreads) for a, b in pairs], axis=1
    )
    its = np.concatenate([(a.middle - b.middle) / np.hypot(a.spread, b.spread) for a, b in pairs])
    scale = np.sqrt((usual * usual).mean(axis=0))  # (pairs, parameters)
    others, own = (np.abs(usual) / scale).max(axis=(1, 2)), np.abs(its) / scale
    share = (np.count_nonzero(others >= own.max()) + 1.0) / (len(others) + 1.0)
    return Disagreement(names[int(np.argmax(own.max(axis=0)))], share)


def stated_rate(library: Library, seen: Sequence[Observation]) -> Conflict:
    """Return how far the rate of loading is from stiffness times drive velocity, as stated.

    Of the logarithm of the mean rate from trough to peak, which creep lowers, and the shape of
    loading and slip says by how much. Of several records, that which contradicts most.
    """
    plan, found = library.plan, []
    stated = logarithms_of_rate(plan, library.scores)
    ends = np.cumsum([len(each.features) for each in seen])[:-1]
    for known, its in zip(np.split(library.features, ends, axis=1), seen, strict=True):
        shape = shape_features(its.conditions, plan.slider)
        rates = known[:, DROP] - known[:, LOADING]
        own = float(its.features[DROP] - its.features[LOADING])
        found.append(Conflict.between(known[:, shape], rates, stated, its.features[shape], own))
    least = min(found, key=lambda each: each.p_value)
    return least._replace(p_value=steadiness(each.p_value for each in found))
