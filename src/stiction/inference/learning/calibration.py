"""The results learned from a library, and their calibration on the library's own records.

The ranks of the truth in posteriors of records that were left out are uniform where posteriors are
calibrated (S. Talts et al., arXiv:1804.06788).
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np

from stiction.arrays import Floats
from stiction.inference.learning.expectation import Expectation
from stiction.inference.learning.regression_abc import (
    Known,
    Sample,
    marginal,
    posterior,
    rank,
    with_marginals,
)
from stiction.inference.learning.summary import (
    FeatureSummary,
    as_arrays,
    learn,
    read_regressions,
    single_threaded_algebra,
)
from stiction.inference.learning.typicality import Typicality
from stiction.progress.report import Progress, part, silent
from stiction.storage.arrays import read_arrays, write_arrays

RANKED = 500  # records of the library whose ranks are found
REGRESSIONS = "middle", "spread"  # of a summary


class Learned(NamedTuple):
    """Estimators of parameters from features, with their calibration."""

    summary: FeatureSummary  # estimates from features
    truth: Floats  # (n, p), scores of the library
    ranks: Floats  # (m, p), of the truth in the posterior of each of some records, from all others
    typicality: Typicality  # how like the records are to each other

    def posteriors(self, features: Floats) -> Iterator[Sample]:
        """Yield the posteriors of records with these features (m, f)."""
        around, spreads = self.summary.library
        each = [*estimates(self.summary, self.truth)]
        for middle, spread in zip(*self.summary(features), strict=True):
            joint = posterior(around, self.truth, middle, (spreads, spread))
            pairs = zip(each, middle.tolist(), spread.tolist(), strict=True)
            yield with_marginals(joint, [marginal(*arguments) for arguments in pairs])

    def farther(self, features: Floats) -> float:
        """Return the share of the library that is less typical than a record (f,)."""
        (found,) = self.typicality.farther(self.summary.standard.scores(features[None]))
        return float(found)

    def coverage(self, interval: float) -> Floats:
        """Return how often intervals of this probability contain the truth, (p,)."""
        inside = np.abs(self.ranks - 0.5) < 0.5 * interval
        return np.asarray(inside.mean(axis=0))


def estimates(summary: FeatureSummary, truth: Floats) -> Iterator[Known]:
    """Yield the leave-one-out estimate of each parameter, for all simulated records."""
    for middles, spreads, scores in zip(
        *(each.T for each in summary.library), truth.T, strict=True
    ):
        yield Known(middles, spreads, scores)


def ranks(summary: FeatureSummary, truth: Floats) -> Floats:
    """Return the leave-one-out ranks of the truth of the library's last records."""
    last = range(max(len(truth) - RANKED, 0), len(truth))
    columns = []
    for its in estimates(summary, truth):
        left_out = ((i, marginal(its, its.middles[i], its.spreads[i], i)) for i in last)
        columns.append([rank(s.scores[:, 0], s.weights, its.scores[i]) for i, s in left_out])
    return np.array(columns).T


def learn_or_read(
    features: Floats, truth: Floats, path: Path | None = None, progress: Progress = silent
) -> Learned:
    """Learn from features (n, f) and scores (n, p), or read the stored result from a file."""
    summary = learn_or_read_summary(features, truth, path, part(progress, 0, 10, of=8))
    beside = None if path is None else path.with_name(f"{path.stem}-calibration.npz")
    stored = read(beside, summary)
    if stored is None:
        with single_threaded_algebra():
            expectation = Expectation.of(summary.scores, truth, summary.middle)
            progress(0.9)
            stored = ranks(summary, truth), Typicality.of(expectation)
        write_arrays(beside, ranks=stored[0], **stored[1].arrays())
    return Learned(summary, truth, *stored)


def read(path: Path | None, summary: FeatureSummary) -> tuple[Floats, Typicality] | None:
    """Return stored ranks and typicality; None unless they belong to this summary's library."""
    arrays = read_arrays(path) or {}
    try:
        return arrays["ranks"], Typicality.read(arrays, summary.scores, summary.middle)
    except KeyError:
        return None


def learn_or_read_summary(
    features: Floats, truth: Floats, path: Path | None, progress: Progress
) -> FeatureSummary:
    """Learn a summary of features, or read it from a file."""
    stored = read_summary(path, features)
    if stored is not None:
        return stored
    found = learn(features, truth, progress)
    write_arrays(
        path, **as_arrays(standard=found.standard, middle=found.middle, spread=found.spread)
    )
    return found


def read_summary(path: Path | None, features: Floats) -> FeatureSummary | None:
    """Return a stored summary; None unless it was learned from these features."""
    try:
        standard, both = read_regressions(read_arrays(path) or {}, features, *REGRESSIONS)
    except KeyError:
        return None
    return FeatureSummary(standard, standard.scores(features), *both)
