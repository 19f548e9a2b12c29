"""Creep curves: the velocity in each stick phase as a function of the time to slip."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from stiction.analysis.creep.first_slip import creep_end
from stiction.analysis.measurement.run_record import as_record
from stiction.analysis.record import Record, lacking_for_loading
from stiction.analysis.signals.digitised import resolution
from stiction.analysis.signals.peak_refinement import Pieces
from stiction.analysis.signals.robust import trimmed_mean, trimmed_means
from stiction.arrays import Floats, xr
from stiction.errors import ResultError, echo
from stiction.recording.noise import difference_gain, rounding_error
from stiction.trajectory import Trajectory

FINEST = 100  # bins in a stick phase, if all were as narrow as the last
LAG = 8  # samples, for the noise; successive samples of a load cell are correlated
FEWEST_SAMPLES = 4  # samples in a bin of a run
OF_RECORD = 4.5  # intervals: so many hold four samples, two in each half, wherever they begin
AIM = 0.1  # of the drive velocity: error of the mean curve in its narrowest bins

# name: (unit, long name), as CF attributes
CURVES = {
    "velocity": ("m/s", "mean velocity along the drive direction"),
    "velocity_error": ("m/s", "standard error of the velocity, from the noise of the record"),
    "force": ("N", "mean spring force"),
    "begin": ("s", "time to slip when the bin begins"),
    "end": ("s", "time to slip when the bin ends"),
}
GROWTH = 0.125  # least width of a bin as a share of the time to slip
TOGETHER = 16  # stick phases that are averaged at once


def creep_curves(
    source: Trajectory | Record, cycles: xr.Dataset, width: float | None = None
) -> xr.Dataset:
    """Return the velocity X' in every stick phase, averaged over bins of the time to slip.

    A stick phase lasts from a cycle's start to its peak; a run's first loading counts too. Bins are
    multiples of the narrowest one, wider far from slip, where the velocity changes less. They are
    the same in all phases, so that phases can be averaged: see `mean_creep`.

    In a run, the velocity is distance over time, from one rest to another where there are rests;
    this removes the transverse oscillation. A record's position is known, or is V t - F/k; there
    the velocity is the difference between the trimmed means of both halves of a bin over half its
    width, which is robust against a few wild samples. An error of the stiffness or of the drive
    velocity shifts V t - F/k by the same share of V: creep that is negative long before slip
    reveals it, and the ``stiffness`` of `stiction.analysis.find_cycles` shows how large it is.

    Parameters
    ----------
    source : Trajectory or Record
        A run sampled several times each transverse period, or what was measured.
    cycles : Dataset
        With ``start`` and ``peak_time`` (s) over ``cycle``, from `stiction.analysis.find_cycles`.
    width : float, optional
        Width of the narrowest bin, s. By default a hundredth of the median stick phase, and at
        least four samples; in a noisy record wide enough to determine the mean of all
        phases to a tenth of the drive velocity. Two periods of mains hum remove it, because each
        half of a bin then averages over one period.

    Returns
    -------
    Dataset
        Over ``phase`` and ``bin``: ``velocity`` (m/s), ``velocity_error`` (m/s; for samples
        whose noise is independent, in a run for rounding alone), ``force`` (N), ``begin`` and
        ``end`` (s), the time to slip at both ends of the bin; NaN where a phase is
        shorter.
        Over ``phase``: ``slip_time`` (s), when it ends.

    Raises
    ------
    ResultError
        If a record has neither a position nor both stiffness and drive velocity, or `width` is
        not above zero.

    Examples
    --------
    >>> import stiction as st
    >>> run = st.simulate(st.presets.nakano_popov_2020(), "5 s", sample_rate="2 kHz")
    >>> curves = st.analysis.creep_curves(run, st.analysis.find_cycles(run))
    >>> sorted(curves.data_vars)
    ['begin', 'end', 'force', 'velocity', 'velocity_error']
    """
    if width is not None and not width > 0.0:
        raise ResultError(
            f"width must be above 0 s, is {echo(width)}; leave it out for one that suits"
        )

    sticks = source.stick_intervals if isinstance(source, Trajectory) else None
    return curves_of(as_record(source), stick_phases(source, cycles), width, sticks)


def stick_phases(source: Trajectory | Record, cycles: xr.Dataset) -> Floats:
    """Return start and end of each stick phase (s), (n, 2); of a run the first loading among them.

    A record's are those of its cycles; a run's are these after the first loading.
    """
    phases = np.column_stack([cycles["start"].values, cycles["peak_time"].values])
    if isinstance(source, Trajectory):
        phases = np.vstack([[source.samples["time"][0], creep_end(source)], phases])
    return phases


def curves_of(
    record: Record, phases: Floats, width: float | None = None, sticks: Floats | None = None
) -> xr.Dataset:
    """Return the creep curves of stick phases from a start to an end (s), (n, 2).

    `sticks` are the rests of a run, from a start to an end (s), (n, 2), which it knows exactly.
    """
    position = _position(record)
    length = phases[:, 1] - phases[:, 0]
    least = width or _least_width(record, position, length, sticks is not None)
    edges = bin_edges(least, float(length.max(initial=0.0)))
    grain = _grain(record, position)
    table = np.full((len(Bins._fields), len(phases), len(edges) - 1), np.nan)
    if sticks is not None:
        for phase, (start, slip) in enumerate(phases):
            times = slip - edges[edges <= slip - start]
            found = between_rests(record, position, sticks, times, (start, slip))
            table[:, phase, : len(times) - 1] = found
    else:
        for first in range(0, len(phases), TOGETHER):
            some = slice(first, first + TOGETHER)
            table[:, some] = between_halves(record, position, edges, phases[some])
    found = Bins(*table)
    table[1] = np.fmax(found.error, grain / (found.begin - found.end))
    return xr.Dataset(
        {
            name: (("phase", "bin"), values, {"units": unit, "long_name": meaning})
            for (name, (unit, meaning)), values in zip(CURVES.items(), table, strict=True)
        },
        {
            "phase": ("phase", np.arange(1, len(phases) + 1)),
            "slip_time": ("phase", phases[:, 1], {"units": "s", "long_name": "end of the phase"}),
        },
    )


def mean_creep(curves: xr.Dataset) -> xr.Dataset:
    """Return the creep curve of all stick phases together: their trimmed mean, bin by bin.

    Parameters
    ----------
    curves : Dataset
        From `creep_curves`.

    Returns
    -------
    Dataset
        Over ``bin``, without bins that no phase reaches: ``velocity``, ``force``, ``begin``,
        ``end`` as in `creep_curves`; ``velocity_error`` (m/s), the standard error from the
        scatter of the phases, at least that from their own errors; ``phases``, their number.

    Examples
    --------
    >>> import stiction as st
    >>> run = st.simulate(st.presets.nakano_popov_2020(), "5 s", sample_rate="2 kHz")
    >>> mean = st.analysis.mean_creep(st.analysis.creep_curves(run, st.analysis.find_cycles(run)))
    >>> sorted(mean.data_vars)
    ['begin', 'end', 'force', 'phases', 'velocity', 'velocity_error']
    """
    seen = np.isfinite(curves["velocity"].values)
    reached = seen.any(axis=0)
    seen = seen[:, reached]
    count = seen.sum(axis=0)
    starts = np.cumsum(count) - count
    columns = [curves[name].values[:, reached].T[seen.T] for name in CURVES]
    middle, error = np.array([trimmed_means(column, starts) for column in columns]).swapaxes(0, 1)
    velocity_error = np.fmax(error[0], middle[1] / np.sqrt(count))
    values = [middle[0], velocity_error, *middle[2:]]
    found = xr.Dataset(
        {
            name: ("bin", value, curves[name].attrs)
            for name, value in zip(CURVES, values, strict=True)
        }
    )
    found["velocity_error"].attrs["long_name"] = "standard error of the velocity"
    return found.assign(phases=("bin", count, {"long_name": "stick phases"}))


def _position(record: Record) -> Floats:
    if record.position is not None:
        return np.asarray(record.position)
    if record.stiffness is None or record.drive_velocity is None:
        raise ResultError(
            "creep needs the position of the mass, which the record lacks; give its "
            f"{lacking_for_loading(record)}, or its position"
        )
    return np.asarray(record.drive_velocity * record.time - record.force / record.stiffness)


def _grain(record: Record, position: Floats) -> float:
    """Return the rounding error of a distance (m), mainly from V t or from a digitised position."""
    travelled = (record.drive_velocity or 0.0) * np.abs(record.time).max(initial=0.0)
    rounding = 4.0 * np.spacing(max(travelled, np.abs(position).max(initial=0.0)))
    if record.position is None or record.slider is not None:
        return float(rounding)
    # of a place, twice as much in each half of a bin as in the whole
    return float(np.fmax(rounding, 8.0**0.5 * rounding_error(position, resolution(position))))


def _least_width(record: Record, position: Floats, length: Floats, exact: bool) -> float:
    """Return the narrowest width (s) of bins that the noise allows, given the number of phases."""
    fine = float(np.median(length)) / FINEST if len(length) else 1.0
    if len(record) > 1:  # the motion between two samples is not known
        fine = max(fine, (FEWEST_SAMPLES if exact else OF_RECORD) / record.sample_rate)
    if exact:
        return fine
    if not len(length) or record.drive_velocity is None or len(record) <= 2 * LAG + 1:
        return fine
    bent = position[: -2 * LAG] - 2.0 * position[LAG:-LAG] + position[2 * LAG :]
    noise = trimmed_mean(bent).error * (len(bent) / difference_gain(2)) ** 0.5  # if it is normal
    samples = record.sample_rate * len(length)  # per second, of all phases
    wanted = (4.0 * noise / (AIM * record.drive_velocity) / samples**0.5) ** (2.0 / 3.0)
    return max(fine, float(wanted))


class Bins(NamedTuple):
    """Velocity (m/s), its standard error, mean force (N), begin and end (s to slip) of bins."""

    velocity: Floats
    error: Floats
    force: Floats
    begin: Floats
    end: Floats

    def some(self, which: NDArray[np.bool_]) -> Bins:
        """Return a subset."""
        return Bins(*(column[which] for column in self))


def bin_edges(least: float, longest: float) -> Floats:
    """Return edges (s to slip) from 0 to `longest`: `least` apart, then multiples of it."""
    edges = [0]
    while edges[-1] * least < longest:
        edges.append(edges[-1] + max(1, round(GROWTH * edges[-1])))
    return least * np.array(edges[:-1] if len(edges) > 2 else edges, dtype=np.float64)


def between_rests(
    record: Record, position: Floats, sticks: Floats, times: Floats, phase: tuple[float, float]
) -> Bins:
    """Average between `times` (s, descending), each shifted to the end of a stick if one is near.

    There the position is that of the last sample in the stick: the next one may lie in the slip.
    Otherwise the position at the bin's ends is averaged over the oscillation, as far as this is
    inside the phase (s): before it and after it the mass slips.
    """
    if len(times) < 2:
        return Bins(*np.zeros((5, 0)))
    edges, reach, (start, slip) = times, 0.5 * (times[0] - times[1]), phase
    at_rest, rests = np.zeros(len(times), bool), sticks[:, 1]
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
    ends[:, at_rest | (edges < start + reach) | (edges > slip - reach)] = np.nan
    average = np.diff(integral(time, position, ends), axis=0)[0] / np.diff(ends, axis=0)[0]
    place = np.where(np.isnan(average), np.interp(edges, time, position), average)
    if at_rest.any():
        its = sticks[np.searchsorted(rests, edges[at_rest])]
        last = np.searchsorted(time, its[:, 1], side="right").clip(1) - 1
        place[at_rest] = np.where(time[last] >= its[:, 0], position[last], place[at_rest])
    passed = np.diff(edges)
    force = np.diff(integral(time, record.force[near], edges)) / passed
    unknown = np.full(len(passed), np.nan)
    return Bins(np.diff(place) / passed, unknown, force, slip - edges[1:], slip - edges[:-1])


def integral(time: Floats, values: Floats, at: Floats) -> Floats:
    """Return the integral (trapezoids) from the first sample to each time `at`."""
    steps = 0.5 * np.diff(time) * (values[1:] + values[:-1])
    which = np.searchsorted(time, at, side="right").clip(1, len(time) - 1) - 1
    part = at - time[which]
    slope = (values[which + 1] - values[which]) / (time[which + 1] - time[which])
    whole = np.concatenate([[0.0], np.cumsum(steps)])[which]
    return np.asarray(whole + part * (values[which] + 0.5 * slope * part))


def between_halves(record: Record, position: Floats, edges: Floats, phases: Floats) -> Bins:
    """Average between edges (s to slip) by the trimmed means of both halves of each bin.

    Of some stick phases from a start to an end (s), (n, 2), together: (n, bins).
    """
    velocity, error, force = np.full((3, len(phases), len(edges) - 1), np.nan)
    start, slip = phases[:, :1], phases[:, 1:]
    times = np.where(edges <= slip - start, slip - edges, np.nan)
    at = np.searchsorted(record.time, times)
    middle = (at[:, :-1] + at[:, 1:]) // 2
    whole = np.isfinite(times[:, 1:])
    seen = whole & (middle - at[:, 1:] >= 2)
    if seen.any():
        ends = np.column_stack([at[:, 1:][seen], middle[seen], at[:, :-1][seen]])
        samples, piece, starts = Pieces.between(ends[:, :-1].ravel(), ends[:, 1:].ravel() - 1)
        to_slip = record.time[samples] - np.broadcast_to(slip, seen.shape)[seen][piece // 2]
        passed = np.diff(np.add.reduceat(to_slip, starts) / np.diff(ends).ravel())[::2]
        places, off = trimmed_means(position[samples], starts)
        velocity[seen] = np.diff(places)[::2] / passed
        error[seen] = np.hypot(off[::2], off[1::2]) / passed
        force[seen] = trimmed_means(record.force[samples], starts[::2])[0]
    begin, end = (np.where(whole, slip - each, np.nan) for each in (times[:, 1:], times[:, :-1]))
    return Bins(velocity, error, force, begin, end)
