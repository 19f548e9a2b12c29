"""Columns of features: which of a record's features come from some channels, or some part."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np
from numpy.typing import NDArray

from stiction.arrays import Floats
from stiction.inference.cycles import slip_cycles
from stiction.inference.features import BEND, SHAPE, FeatureGroup, parts
from stiction.inference.observation import Conditions
from stiction.system.slider import Slider


def features_from(
    channels: Iterable[str], conditions: Conditions, slider: Slider
) -> NDArray[np.bool_]:
    """Return which features of a record under these conditions come from these channels alone."""
    some = set(channels)
    return which(conditions, slider, lambda part: part.needs <= some)


def bend_features(conditions: Conditions, slider: Slider) -> NDArray[np.bool_]:
    """Return which features of a record under these conditions are those of a bent loading."""
    return which(conditions, slider, lambda part: part.name == BEND)


def shape_features(conditions: Conditions, slider: Slider) -> NDArray[np.bool_]:
    """Return which features of a record tell its shape, not how fast its force rises."""
    return which(conditions, slider, lambda part: part.name in SHAPE)


def which(
    conditions: Conditions, slider: Slider, wanted: Callable[[FeatureGroup], bool]
) -> NDArray[np.bool_]:
    """Return which features of a record under these conditions belong to the wanted parts."""
    blank = dummy(conditions)
    found = parts(conditions.step, blank, conditions.scale(slider), slip_cycles(blank["force"]))
    return np.concatenate([np.full(len(part.values), wanted(part)) for part in found])


def dummy(conditions: Conditions) -> dict[str, Floats]:
    """Return channels of a sawtooth, which has as many features as any record."""
    saw = np.tile(np.concatenate([np.linspace(0.0, 1.0, 40), np.linspace(1.0, 0.0, 5)]), 8)
    return dict.fromkeys(conditions.noise, saw + 0.01)
