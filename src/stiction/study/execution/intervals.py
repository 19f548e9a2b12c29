"""Pairs of neighbouring runs between which the kind of motion changes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from stiction.arrays import Floats
from stiction.study.plan.study import Study
from stiction.study.view.view import kinds

if TYPE_CHECKING:
    import xarray as xr


class Intervals(NamedTuple):
    """Pairs of runs with different motion: the axes' values and the kinds of motion.

    Parameters
    ----------
    low, high : mapping of str to ndarray
        (n,) for each axis, in the unit of the study's store.
    below, above : ndarray
        (n,) kinds of motion at both.
    """

    low: Mapping[str, Floats]
    high: Mapping[str, Floats]
    below: np.ndarray
    above: np.ndarray


def changes(study: Study, data: xr.Dataset, along: str, apart: Sequence[str] | None) -> Intervals:
    """Return neighbouring runs of different kind on a study's grid; failed runs are skipped."""
    dims = study.layout.dims
    axis = dims.index(along)
    found = np.moveaxis(kinds(data), axis, -1)
    sides = side(found, apart)
    differ = (sides[..., 1:] != sides[..., :-1]) & (found[..., 1:] != "") & (found[..., :-1] != "")
    places = np.argwhere(differ)

    def end(step: int) -> dict[str, Floats]:
        index = np.insert(places[:, :-1], axis, places[:, -1] + step, axis=1)
        axes = study.coordinates.items()
        return {name: each.values[index[:, dims.index(each.dim)]] for name, each in axes}

    last = found.reshape(-1, found.shape[-1])
    row = np.ravel_multi_index(tuple(places[:, :-1].T), found.shape[:-1]) if found.ndim > 1 else 0
    return Intervals(end(0), end(1), last[row, places[:, -1]], last[row, places[:, -1] + 1])


def side(found: np.ndarray, apart: Sequence[str] | None) -> np.ndarray:
    """Return the kinds as they are compared: themselves, or whether they are in `apart`."""
    return found if apart is None else np.isin(found.astype(str), list(apart))


def half_way(low: Floats, high: Floats) -> Floats:
    """Return the middle of two values, or the value where both are equal."""
    return np.where(low == high, low, 0.5 * (low + high))


def halve(
    found: Intervals, middle: Mapping[str, Floats], at: np.ndarray, apart: Sequence[str] | None
) -> Intervals:
    """Return the half of each interval that contains the change.

    If the middle has a third kind, or its run failed, this is the lower half.
    """
    upper = side(at, apart) == side(found.below, apart)
    at = np.where(at == "", found.above, at)  # no information from a failed run: guess
    return Intervals(
        {name: np.where(upper, middle[name], low) for name, low in found.low.items()},
        {name: np.where(upper, high, middle[name]) for name, high in found.high.items()},
        np.where(upper, at, found.below),
        np.where(upper, found.above, at),
    )


def widest(found: Intervals, along: str) -> float:
    """Return the width of the widest interval."""
    return float(np.max(np.abs(found.high[along] - found.low[along])))
