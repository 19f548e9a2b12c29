"""Combinations of values that a description refuses, though each is allowed by its own prior.

A static coefficient, say, must not be below the kinetic one. Where priors overlap so, parameters
are drawn from the joint prior under this condition: a draw that is refused is drawn again.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import product
from typing import TypeVar

import numpy as np

from stiction.errors import DescriptionError
from stiction.inference.priors import EDGE, Prior
from stiction.system.parameter import change_parameters, quantity
from stiction.system.slider import Slider

T = TypeVar("T")

ENDS = np.array([EDGE, 1.0 - EDGE])  # shares of a prior, where each value is still one of a draw
FRICTION = "friction."  # prefix of the parameters whose values may contradict each other


def is_allowed(slider: Slider, values: Mapping[str, float]) -> bool:
    """Return whether the description allows these values of the friction law together, in SI.

    >>> import stiction as st
    >>> rig = st.presets.nakano_popov_2020()
    >>> is_allowed(rig, {"friction.mu_static": 0.3}), is_allowed(rig, {"friction.mu_static": 0.1})
    (True, False)
    """
    given = {path: quantity(slider, path, float(its)) for path, its in of_friction(values).items()}
    try:
        change_parameters(slider, given)
    except DescriptionError:
        return False
    return True


def is_restricted(slider: Slider, priors: Mapping[str, Prior]) -> bool:
    """Return whether the description refuses the friction law at some ends of these priors."""
    return not all(is_allowed(slider, corner) for corner in corners(priors))


def is_allowed_somewhere(
    slider: Slider, values: Mapping[str, float], others: Mapping[str, Prior]
) -> bool:
    """Return whether the description allows these values at some ends of the priors of others."""
    if values.keys() != of_friction(values).keys():
        return False
    return any(is_allowed(slider, {**corner, **values}) for corner in corners(others))


def corners(priors: Mapping[str, Prior]) -> Iterator[dict[str, float]]:
    """Yield the friction law's parameters at all combinations of their priors' ends."""
    own = of_friction(priors)
    ends = [prior.quantile(ENDS).tolist() for prior in own.values()]
    for values in product(*ends):
        yield dict(zip(own, values, strict=True))


def of_friction(table: Mapping[str, T]) -> dict[str, T]:
    """Return the items of the friction law's parameters."""
    return {path: its for path, its in table.items() if path.startswith(FRICTION)}
