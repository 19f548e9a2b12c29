"""Mean velocities in bins of time, for a run and for a noisy record."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from stiction.analysis.record import Record
from stiction.analysis.signals.robust import trimmed_mean
from stiction.arrays import Floats

GROWTH = 0.125  # least width of a bin as a share of the time to slip


class Bins(NamedTuple):
    """Velocity (m/s), its standard error, mean force (N), begin and end (s to slip) of bins."""

    velocity: Floats
    error: Floats
    force: Floats
    begin: Floats
    end: Floats


def bin_edges(least: float, longest: float) -> Floats:
    """Return edges (s to slip) from 0 to `longest`: `least` apart, then multiples of it."""
    edges = [0]
    while edges[-1] * least < longest:
        edges.append(edges[-1] + max(1, round(GROWTH * edges[-1])))
    return least * np.array(edges[:-1] if len(edges) > 2 else edges, dtype=np.float64)


def between_rests(
    record: Record, position: Floats, rests: Floats, times: Floats, slip: float
) -> Bins:
    """Average between `times` (s, descending), each shifted to a rest if one is near.

    Otherwise the position at the bin's ends is averaged over the oscillation.
    """
    if len(times) < 2:
        return Bins(*np.zeros((5, 0)))
    edges, reach = times, 0.5 * (times[0] - times[1])
    at_rest = np.zeros(len(times), bool)
    if len(rests):
        after = np.searchsorted(rests, times).clip(0, len(rests) - 1)
        pair = np.stack([rests[np.maximum(after - 1, 0)], rests[after]])
        closest = pair[np.argmin(np.abs(pair - times), axis=0), np.arange(len(times))]
        at_rest = np.abs(closest - times) < 0.5 * reach
        edges = np.where(at_rest, closest, times)
    # only samples near the phase; otherwise the time grows with the square of the record's length
    first, last = np.searchsorted(record.time, [times[-1] - 2 * reach, times[0] + 2 * reach])
    near = slice(max(0, first - 1), last + 1)
    time, position = record.time[near], position[near]
    ends = np.clip(np.stack([edges - reach, edges + reach]), time[0], time[-1])
    ends[:, at_rest | (edges > slip - reach)] = np.nan
    average = np.diff(_integral(time, position, ends), axis=0)[0] / np.diff(ends, axis=0)[0]
    place = np.where(np.isnan(average), np.interp(edges, time, position), average)
    passed = np.diff(edges)
    force = np.diff(_integral(time, record.force[near], edges)) / passed
    unknown = np.full(len(passed), np.nan)
    return Bins(np.diff(place) / passed, unknown, force, slip - edges[1:], slip - edges[:-1])


def _integral(time: Floats, values: Floats, at: Floats) -> Floats:
    """Return the integral (trapezoids) from the first sample to each time `at`."""
    steps = 0.5 * np.diff(time) * (values[1:] + values[:-1])
    which = np.searchsorted(time, at, side="right").clip(1, len(time) - 1) - 1
    part = at - time[which]
    slope = (values[which + 1] - values[which]) / (time[which + 1] - time[which])
    whole = np.concatenate([[0.0], np.cumsum(steps)])[which]
    return np.asarray(whole + part * (values[which] + 0.5 * slope * part))


def between_halves(record: Record, position: Floats, times: Floats, slip: float) -> Bins:
    """Average between `times` (s, descending) by the trimmed means of both halves of each bin."""
    count = max(len(times) - 1, 0)
    velocity, error, force = np.full((3, count), np.nan)
    at = np.searchsorted(record.time, times)
    for i in range(count):
        first, last = at[i + 1], at[i]
        middle = (first + last) // 2
        if middle - first < 2:
            continue
        early, late = slice(first, middle), slice(middle, last)
        passed = float(record.time[late].mean() - record.time[early].mean())
        (place, off), (place_2, off_2) = (trimmed_mean(position[half]) for half in (early, late))
        velocity[i] = (place_2 - place) / passed
        error[i] = np.hypot(off, off_2) / passed
        force[i] = trimmed_mean(record.force[first:last])[0]
    return Bins(velocity, error, force, slip - times[1:], slip - times[:-1])
