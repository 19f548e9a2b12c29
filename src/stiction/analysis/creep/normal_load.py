"""The normal load in stick phases: creep at another load, and loads that change too fast."""

from __future__ import annotations

import numpy as np

from stiction.analysis.record import Record
from stiction.arrays import Floats, xr
from stiction.errors import ResultError
from stiction.text.quantity_text import percent

PARTS = 16  # of a stick phase, over each of which the load is averaged: their changes are its own
# Largest change of the load in a stick phase, as a share of it: for the exponent of the divergence,
# and a misalignment by the force alone; for one by creep; and that times (k_x/k_y)/tan^2(phi), as a
# softer spring across turns the slip with friction. Found on random rigs under ramps and
# oscillations: with twice as much, one in ten values is more than three errors off
CHANGED, FOLLOWED, TURNED = 0.25, 0.4, 0.2


def at_one_load(curves: xr.Dataset, record: Record) -> xr.Dataset:
    """Return creep curves whose force is that at the load `normal_load` instead of a measured one.

    Friction is proportional to the load, and the slip follows the direction of friction: by Eq. (7)
    the velocity depends on the force over the load.
    """
    time = curves["slip_time"] - 0.5 * (curves["begin"] + curves["end"])
    load = np.interp(time.values, record.time, record.relative_load())
    return curves.assign(force=curves["force"] / load)


def load_change(record: Record, begin: Floats, end: Floats) -> float:
    """Return how far the load goes up and down, over its mean, in the stick phase of most change.

    `begin` and `end` (s) are those of the phases. Readings without load count as neighbours do; 0
    where the load's noise may be all of its variation.
    """
    time, load = _load_readings(record)
    if len(time) < 2 or not record.load_variation() > 0.0:
        return 0.0
    steps = np.diff(time) * 0.5 * (load[1:] + load[:-1])
    area = np.concatenate([[0.0], np.cumsum(steps)])
    edges = np.linspace(begin, end, PARTS + 1)
    means = np.diff(np.interp(edges, time, area), axis=0) / np.diff(edges, axis=0)
    changes = np.abs(np.diff(means, axis=0)).sum(axis=0) / means.mean(axis=0)
    return float(np.fmax.reduce(changes, initial=0.0))


def typical_load(record: Record, times: Floats) -> float:
    """Return the median of the load over `normal_load` at some times (s).

    Readings without load count as neighbours do.
    """
    return float(np.median(np.interp(times, *_load_readings(record))))


def _load_readings(record: Record) -> tuple[Floats, Floats]:
    """Return the times (s) at which there is a load, and that over `normal_load`."""
    load = record.relative_load()
    its = np.isfinite(load)
    return record.time[its], load[its]


def refuse_change(change: float, most: float, why: str) -> None:
    """Refuse a finding under a load that changes by more than a share `most`.

    Raises
    ------
    ResultError
        With `why` in words.
    """
    if change > most:
        raise ResultError(
            f"not determined: the normal load changes by {percent(change)} in a stick phase, {why}"
        )
