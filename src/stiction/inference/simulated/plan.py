"""The plan of a library: a rig, the priors of its parameters, and conditions of records."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from hashlib import sha256
from typing import NamedTuple

import numpy as np

from stiction.arrays import Floats
from stiction.errors import ResultError
from stiction.inference.observation import Conditions
from stiction.inference.priors import Normal, Prior, Uniform
from stiction.inference.simulated.restriction import is_allowed, is_restricted
from stiction.system.slider import Slider

MOST_DRAWS = 10_000  # of one set of parameters, where the priors are restricted
FORMAT = 11  # of stored simulations and of what is learned from them


class Plan(NamedTuple):
    """The plan of a library's simulations.

    Parameters
    ----------
    slider : Slider
        The rig in the middle of its priors.
    priors : dict of str to Normal or Uniform
        Of its parameters, by path; and of ``jitter``, ``gain`` and ``zero`` (N) of the force, the
        drift of this zero in the first record, ``zero_drift`` (N/s), and ``drift``, the change of
        the coefficients' logarithm over a record, and ``alternation``, its difference between odd
        and even cycles.
    conditions : tuple of Conditions
        Of each record.
    basis : Slider, optional
        What features are relative to, where it is not `slider`: plans with the same basis can be
        compared.
    restricted : bool, optional
        Whether the description refuses some combinations of values of the friction law, each
        within its prior: then those are drawn again.
    """

    slider: Slider
    priors: dict[str, Prior]
    conditions: tuple[Conditions, ...]
    basis: Slider | None = None
    restricted: bool = False

    @property
    def key(self) -> str:
        """A hash of everything that determines the simulations."""
        parts = self.slider, self.priors, self.conditions, self.basis
        text = json.dumps([FORMAT, *map(repr, parts), *["restricted"] * self.restricted])
        return sha256(text.encode()).hexdigest()[:16]

    def parameters(self, scores: Floats) -> dict[str, float]:
        """Return the parameters with these normal scores, (p,)."""
        from scipy.special import ndtr  # slow to import

        shares = ndtr(scores)
        pairs = zip(self.priors.items(), shares, strict=True)
        return {name: float(prior.quantile(share)) for (name, prior), share in pairs}

    def draw(self, random: np.random.Generator) -> Floats:
        """Return normal scores (p,) of parameters drawn from the priors.

        Where these are restricted, from the part that the description takes; they are then not
        normal, nor independent.
        """
        for _ in range(MOST_DRAWS if self.restricted else 1):
            scores = random.standard_normal(len(self.priors))
            if self.takes(scores):
                return scores
        raise ResultError(
            f"of {MOST_DRAWS} draws of the priors the description refuses each: narrow the priors "
            "of the friction law, so that most combinations are possible"
        )

    def takes(self, scores: Floats) -> bool:
        """Return whether the description allows the parameters with these normal scores, (p,)."""
        return not self.restricted or is_allowed(self.slider, self.parameters(scores))


def plan(slider: Slider, priors: Mapping[str, Prior], conditions: Sequence[Conditions]) -> Plan:
    """Return the plan for records under these conditions."""
    force = conditions[0].noise["force"]
    jitters = [each.jitter for each in conditions]
    low, high = min(its.low for its in jitters), max(its.high for its in jitters)
    own: dict[str, Prior] = {"jitter": Uniform(low, high, "log")}
    if force.gain:
        own["gain"] = Normal(1.0, force.gain, low=0.0)
    if force.zero:
        own["zero"] = Normal(0.0, force.zero)
    if force.drift:
        own["zero_drift"] = Normal(0.0, force.drift)
    return Plan(
        slider,
        {**priors, **{k: v for k, v in own.items() if k not in priors}},
        tuple(conditions),
        restricted=is_restricted(slider, priors),
    )
