"""Levels at which a force stays one after the other, as where a sliding mass is driven in steps."""

from __future__ import annotations

from itertools import pairwise
from math import hypot
from typing import NamedTuple

import numpy as np

from stiction.analysis.motion.changes.sliding import NO_LOAD
from stiction.analysis.record import Record
from stiction.analysis.signals.correlated_noise import statistics
from stiction.analysis.signals.digitised import resolution
from stiction.analysis.signals.robust import part_means
from stiction.arrays import Floats, median
from stiction.recording.noise import rounding_error, white_noise

RECORD_MEANS = 200  # means of a record
LONG = 12  # of them, in each level; levels take so much of the record together
SHARE_OF_LEVELS = 0.6
# Standard deviations of a mean: by how much those of a level differ from its median, the standard
# deviation of all of them, and the change to the next level. A random walk is 1.4 in 12 steps and
# comes no farther than its root of their number
WITHIN, EVEN_MEANS, CHANGED = 5.0, 2.0, 12.0
WORTH = 0.02  # of the force: a change that is less is not worth a level
QUICK = 1.0  # of the shorter level: a change takes no longer


class Level(NamedTuple):
    """When a force stays at a level (s), its mean (N), the standard error of that, and of mu."""

    begin: float
    end: float
    force: float
    error: float
    coefficient: float
    coefficient_error: float


def levels(record: Record) -> tuple[Level, ...]:
    """Return the levels of sliding in a force that stays at two levels or more; else none.

    They are sought in the force under one load, if the load is measured. One at which the spring
    is unloaded, as before and after a test, is none of sliding: one may be left.
    """
    if len(record) < 4 * RECORD_MEANS:
        return ()
    raw, times = (part_means(x, RECORD_MEANS) for x in (record.force, record.time))
    means = (
        raw
        if record.load is None
        else part_means(record.force / record.relative_load(), RECORD_MEANS)
    )
    if not np.isfinite(means).all():
        return ()
    noise = white_noise(means, order=1)
    if not np.ptp(means) > CHANGED * noise:
        return ()
    runs = _runs(means, noise)
    if len(runs) < 2 or sum(run.stop - run.start for run in runs) < SHARE_OF_LEVELS * RECORD_MEANS:
        return ()
    if not all(_changes(means, noise, *pair) for pair in pairwise(runs)):
        return ()
    half, load = 0.5 * (times[1] - times[0]), record.normal_load or np.nan
    found, step = [], resolution(record.force)
    for run in runs:
        (force, error, _), (mu, mu_error, _) = map(statistics, (raw[run], means[run] / load))
        ends = float(times[run.start] - half), float(times[run.stop - 1] + half)
        level = record.force[slice(*np.searchsorted(record.time, ends))]
        rounding = rounding_error(level, step)
        error, mu_error = hypot(error, rounding), hypot(mu_error, rounding / load)
        found.append(Level(*ends, force, error, mu, mu_error))
    least = NO_LOAD * max(abs(each.force) for each in found)
    return tuple(each for each in found if abs(each.force) > least)


def _runs(means: Floats, noise: float) -> list[slice]:
    """Return the long runs of means that stay about their median, as independent ones do."""
    windows = np.lib.stride_tricks.sliding_window_view(means, LONG)
    far = np.abs(windows - np.median(windows, axis=1)[:, None]).max(axis=1)
    stays = (far < WITHIN * noise) & (windows.std(axis=1) < EVEN_MEANS * noise)
    runs, end = [], 0
    for first in np.flatnonzero(stays):
        if first < end:
            continue
        end = int(first) + LONG
        while end < len(means) and abs(means[end] - median(means[first:end])) < WITHIN * noise:
            end += 1
        runs.append(slice(int(first), end))
    return runs


def _changes(means: Floats, noise: float, one: slice, two: slice) -> bool:
    """Return whether a level follows another at once, and differs from it."""
    before, after = float(np.median(means[one])), float(np.median(means[two]))
    least = max(CHANGED * noise, WORTH * max(abs(before), abs(after)))
    shorter = min(int(run.stop - run.start) for run in (one, two))
    return abs(after - before) > least and two.start - one.stop <= QUICK * shorter
