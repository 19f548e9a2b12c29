"""Rest of the mass during loading, in simulations of a rotating friction vector.

On a misaligned rig the friction force turns whether the mass creeps or not. Where the force across
grows so slowly that it reaches the friction at rest only when the next slip is due, the mass is
held by static friction, and a claim of rotation in its place would be false. How far the mass
follows the drive across no feature of a record states; its simulations do.
"""

from __future__ import annotations

from typing import NamedTuple, Self

import numpy as np

from stiction.analysis.motion.rest import HELD, share_held
from stiction.arrays import Floats
from stiction.drive.program import nominal_velocity
from stiction.inference.cycles import slip_cycles
from stiction.inference.observation import Conditions
from stiction.inference.simulated.plan import Plan
from stiction.inference.simulated.synthetic import Synthetic, synthesise

ALIKE_SIMULATIONS = 32  # simulations with a record's parameters: enough for their quantiles
FEWEST = 10  # of them with cycles: of fewer a tenth is not one
QUANTILES = 0.1, 0.5, 0.9


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

        They are NaN of fewer than ten.

        >>> Rest.among(np.append(np.full(10, 0.5), np.nan))
        Rest(low=0.5, middle=0.5, high=0.5)
        """
        known = shares[np.isfinite(shares)]
        if len(known) < FEWEST:
            return cls(np.nan, np.nan, np.nan)
        return cls(*np.quantile(known, QUANTILES).tolist())

    @property
    def known(self) -> bool:
        """Whether enough simulations have cycles."""
        return bool(np.isfinite(self.middle))

    @property
    def held(self) -> bool:
        """Whether static friction holds the mass between slips, for sure."""
        return self.low >= HELD


def shares_at_rest(plan: Plan, scores: Floats) -> Floats:
    """Return the share at rest (m,) in simulations with scores (m, p) of their parameters.

    The mean of several records; NaN where one of them has too few cycles.
    """
    found = []
    for number, one in enumerate(scores):
        made = synthesise(plan, one, np.random.default_rng(number))
        each = zip(made, plan.conditions, strict=True)
        found.append(
            np.mean([np.nan if its is None else share_at_rest(its, of) for its, of in each])
        )
    return np.array(found)


def share_at_rest(made: Synthetic, conditions: Conditions) -> float:
    """Return the share of the drive's way across, in all loadings, that the mass does not follow.

    That way stretches the spring across. It is 1 where the mass is held from slip to slip, and 0
    where it follows from the beginning, creeping or by small slips of its own; 1 without any way.
    Loadings are those of the motion: in a record they seem to begin and end later, as a filter has
    it, when the next slip has let the spring across go. NaN where none lasts for three samples.
    """
    motion, wanted = made.motion, conditions.cycles
    elongation, stretch = motion.rows[:, 0], motion.rows[:, 1]
    cycles = slip_cycles(made.slider.k_x * elongation, conditions.noise["force"].error)
    ends = np.stack([cycles.before + 1, cycles.peak - 1])[:, -wanted:]  # no slip, between samples
    ends = ends[:, ends[1] > ends[0]]
    stretched, lasts = (float(np.diff(x[ends], axis=0).sum()) for x in (stretch, motion.time))
    if not lasts:
        return np.nan
    way = nominal_velocity(made.slider.motion) * made.slider.direction[1] * lasts
    return share_held(stretched, way)
