"""Contradictions between the records of a rig, or with the stated rate of loading.

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
from stiction.inference.learning.conflict import Conflict, Departure
from stiction.inference.learning.summary import FeatureSummary
from stiction.inference.observation import Observation
from stiction.inference.simulated.library import Library
from stiction.inference.simulated.loading_rate import logarithms_of_rate

TWO_WAYS = 2.0  # estimates are compared: the least p-value counts as many times (Bonferroni)


class Disagreement(NamedTuple):
    """How far several records of a rig disagree about a parameter.

    `p_value` is the share of simulated rigs with records that disagree as far about a parameter;
    2/(n + 1) where none of n does, so that a contradiction at 1 % needs 200 of them.
    """

    name: str
    p_value: float


class Told(NamedTuple):
    """One record's own estimates of each parameter: middles and spreads, (n, p) and (1, p).

    `middles` and `spreads` are leave-one-out estimates for the simulated rigs, `middle` and
    `spread` the estimate for the measured one.
    """

    middles: Floats
    spreads: Floats
    middle: Floats
    spread: Floats


def disagreement(
    names: Sequence[str], truth: Floats, alone: Sequence[FeatureSummary], observed: Sequence[Floats]
) -> Disagreement:
    """Return the parameter about which several records contradict each other most clearly.

    Two estimates of each record count: the learned one has a spread of its own; the errors of a
    linear regression that records share, such as that of a gain, cancel.

    Parameters
    ----------
    names : sequence of str
        Of the parameters.
    truth : ndarray
        (n, p), of the simulated rigs.
    alone : sequence of FeatureSummary
        The summary of each record's features by themselves, learned from these rigs.
    observed : sequence of ndarray
        (f,), the features of each record.
    """
    both = [*zip(alone, observed, strict=True)]
    learned = [Told(*its.library, *its(own)) for its, own in both]
    linear = [line_of(truth, its, own) for its, own in both]
    found = [_most_apart(names, each) for each in (learned, linear)]
    least = min(found, key=lambda each: each.p_value)
    return least._replace(p_value=min(1.0, TWO_WAYS * least.p_value))


def line_of(truth: Floats, summary: FeatureSummary, observed: Floats) -> Told:
    """Return a record's estimates by a linear regression over its features."""
    new = summary.standard.scores(observed[None])
    columns, row = (np.column_stack([np.ones(len(x)), x]) for x in (summary.scores, new))
    slopes = np.linalg.lstsq(columns, truth, rcond=None)[0]
    return Told(columns @ slopes, np.ones_like(truth), row @ slopes, np.ones_like(truth[:1]))


def _most_apart(names: Sequence[str], told: Sequence[Told]) -> Disagreement:
    """Return the parameter whose estimates differ most, relative to their usual difference."""
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
    """Compare the rate of loading with the stated one, stiffness times drive velocity.

    The logarithms of the mean rates from trough to peak are compared. Creep lowers these rates; the
    shape of loading and slip determines by how much. The record that contradicts most is returned.
    """
    plan, found = library.plan, []
    stated = logarithms_of_rate(plan, library.scores)
    ends = np.cumsum([len(each.features) for each in seen])[:-1]
    for known, its in zip(np.split(library.features, ends, axis=1), seen, strict=True):
        shape = shape_features(its.conditions, plan.slider)
        rates = known[:, DROP] - known[:, LOADING]
        own = float(its.features[DROP] - its.features[LOADING])
        found.append(Departure.of(known[:, shape], rates, stated, its.features[shape], own))
    return Conflict.between(found)
