"""The odds of rate and state or LuGre against static friction on the misaligned rig.

A misaligned mass that its static friction holds while the spring is loaded, and that breaks away,
is none of the mechanisms that are claimed, and lies amid the records of those whose contacts yield
a little: nothing but the comparison with it tells that. With rotation it is not compared: a static
peak that the motion across breaks early leaves no trace.
"""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple, Self

import numpy as np

from stiction.arrays import Floats
from stiction.inference.mechanism.classifier import Classifier, Simulations, learn_or_read
from stiction.inference.mechanism.rivals import LUGRE, MISALIGNED_STATIC, RATE_AND_STATE
from stiction.progress.report import Progress, silent

ELASTIC = RATE_AND_STATE, LUGRE  # contacts yield before they slip


class StaticCheck(NamedTuple):
    """Discriminants of each mechanism from static friction on the misaligned rig."""

    names: tuple[str, ...]  # of the mechanisms that it tells apart
    classifier: Classifier | None  # None if one of them only has been simulated

    @classmethod
    def of(
        cls, simulations: Simulations, path: Path | None = None, progress: Progress = silent
    ) -> Self:
        """Learn from simulations of all mechanisms, or read the stored discriminants."""
        some = simulations.among((*ELASTIC, MISALIGNED_STATIC))
        if len(some.names) < 2 or MISALIGNED_STATIC not in some.names:
            return cls((), None)
        return cls(some.names, learn_or_read(some, path, progress))

    def probability(self, name: str, features: Floats) -> Floats:
        """Return the probability (m,) of a mechanism for records with features (m, f).

        It is 1 for a mechanism that is not checked.
        """
        if self.classifier is None or name not in self.names:
            return np.ones(len(features))
        return self.classifier.probabilities(features)[:, self.names.index(name)]
