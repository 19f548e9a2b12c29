"""Columns of features: masks of the features that some channels determine, or of one kind."""

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
    """Return a mask of the features that these channels alone determine."""
    some = set(channels)
    return which(conditions, slider, lambda part: part.needs <= some)


def bend_features(conditions: Conditions, slider: Slider) -> NDArray[np.bool_]:
    """Return a mask of the features that describe how a loading bends."""
    return which(conditions, slider, lambda part: part.name == BEND)


def shape_features(conditions: Conditions, slider: Slider) -> NDArray[np.bool_]:
    """Return a mask of the features of a record's shape, without those of its loading rate."""
    return which(conditions, slider, lambda part: part.name in SHAPE)


def which(
    conditions: Conditions, slider: Slider, wanted: Callable[[FeatureGroup], bool]
) -> NDArray[np.bool_]:
    """Return a mask of the features in the wanted groups, for a record under these conditions."""
    blank = dummy(conditions)
    found = parts(conditions.step, blank, conditions.scale(slider), slip_cycles(blank["force"]))
    return np.concatenate([np.full(len(part.values), wanted(part)) for part in found])


def dummy(conditions: Conditions) -> dict[str, Floats]:
    """Return sawtooth channels, which have as many features as any record."""
    saw = np.tile(np.concatenate([np.linspace(0.0, 1.0, 40), np.linspace(1.0, 0.0, 5)]), 8)
    return dict.fromkeys(conditions.noise, saw + 0.01)
