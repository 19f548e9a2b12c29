"""Whether the mass rests while the spring is loaded, where friction is said to rotate.

On a misaligned rig the friction force turns whether the mass creeps or not. Where the force across
grows so slowly that it reaches the friction at rest only when the next slip is due, the mass is
held by static friction, and a claim of rotation in its place would be false. How far the mass
follows the drive across no feature of a record states; its simulations do.
"""

from __future__ import annotations

from typing import NamedTuple, Self

import numpy as np

from stiction.arrays import Floats
from stiction.inference.simulated.plan import Plan
from stiction.inference.simulated.synthetic import synthesise

ALIKE = 32  # simulations with a record's parameters: enough for their quantiles
QUANTILES = 0.1, 0.5, 0.9
MOSTLY = 0.8  # of the way of the drive across: a mass that does not follow it so far is held


class Rest(NamedTuple):
    """Share of the drive's way across that the mass does not follow while the spring is loaded.

    Quantiles, 10 %, 50 % and 90 %, in simulations with a record's parameters.
    """

    low: float
    middle: float
    high: float

    @classmethod
    def among(cls, shares: Floats) -> Self:
        """Return the quantiles of some simulations' shares, NaN in those without cycles.

        >>> Rest.among(np.array([0.5, np.nan, 0.5]))
        Rest(low=0.5, middle=0.5, high=0.5)
        """
        known = shares[np.isfinite(shares)]
        if not len(known):
            return cls(np.nan, np.nan, np.nan)
        return cls(*np.quantile(known, QUANTILES).tolist())

    @property
    def held(self) -> bool:
        """Whether static friction holds the mass between slips, for sure."""
        return self.low >= MOSTLY


def shares_at_rest(plan: Plan, scores: Floats) -> Floats:
    """Return this share (m,) in simulations with scores (m, p) of their parameters.

    The mean of several records; NaN where one of them has too few cycles.
    """
    found = []
    for number, one in enumerate(scores):
        made = synthesise(plan, one, np.random.default_rng(number))
        found.append(np.mean([np.nan if its is None else its.rest for its in made]))
    return np.array(found)
