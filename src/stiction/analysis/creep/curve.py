"""Creep curves: the velocity in each stick phase as a function of the time to slip."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from stiction.analysis.creep.binning import Bins, between_halves, between_rests, bin_edges
from stiction.analysis.creep.first_slip import creep_end
from stiction.analysis.record import Record, as_record
from stiction.analysis.signals.robust import trimmed_mean
from stiction.arrays import Floats
from stiction.errors import ResultError, echo
from stiction.trajectory import Trajectory

if TYPE_CHECKING:
    import xarray as xr

FINEST = 100  # bins in a stick phase, if all were as narrow as the last
LAG = 8  # samples, for the noise; successive samples of a load cell are correlated
FEWEST = 4  # samples in a bin of a run
AIM = 0.1  # of the drive velocity: error of the mean curve in its narrowest bins

# name: (unit, long name), as CF attributes
CURVES = {
    "velocity": ("m/s", "mean velocity along the drive direction"),
    "velocity_error": ("m/s", "standard error of the velocity, from the noise of the record"),
    "force": ("N", "mean spring force"),
    "begin": ("s", "time to slip when the bin begins"),
    "end": ("s", "time to slip when the bin ends"),
}


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
        least four samples of a run; in a noisy record wide enough to determine the mean of all
        phases to a tenth of the drive velocity. Two periods of mains hum remove it, because each
        half of a bin then averages over one period.

    Returns
    -------
    Dataset
        Over ``phase`` and ``bin``: ``velocity`` (m/s), ``velocity_error`` (m/s; for samples
        whose noise is independent, in a run for rounding alone), ``force`` (N), ``begin`` and
        ``end`` (s), the time to slip at both ends of the bin; not a number where a phase is
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
    import xarray as xr

    if width is not None and not width > 0.0:
        raise ResultError(
            f"width must be above 0 s, is {echo(width)}; leave it out for one that suits"
        )

    record = as_record(source)
    position = _position(record)
    phases = np.column_stack([cycles["start"].values, cycles["peak_time"].values])
    if isinstance(source, Trajectory):
        phases = np.vstack([[record.time[0], creep_end(source)], phases])
    length = phases[:, 1] - phases[:, 0]
    least = width or _least_width(record, position, length, isinstance(source, Trajectory))
    edges = bin_edges(least, float(length.max(initial=0.0)))
    grain = _grain(record, position)
    table = np.full((len(Bins._fields), len(phases), len(edges) - 1), np.nan)
    for phase, (start, slip) in enumerate(phases):
        times = slip - edges[edges <= slip - start]
        if isinstance(source, Trajectory):
            found = between_rests(record, position, source.stick_intervals[:, 1], times, slip)
        else:
            found = between_halves(record, position, times, slip)
        rounding = grain / (found.begin - found.end)
        table[:, phase, : len(times) - 1] = found._replace(error=np.fmax(found.error, rounding))
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
    import xarray as xr

    seen = np.isfinite(curves["velocity"].values)
    bins = np.flatnonzero(seen.any(axis=0))
    table = np.stack([curves[name].values for name in CURVES])
    columns = [table[:, seen[:, bin], bin] for bin in bins]
    means = np.array([[trimmed_mean(row) for row in column] for column in columns])
    middle, error = means.reshape(len(bins), len(CURVES), 2).T
    count = seen[:, bins].sum(axis=0)
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
            "creep needs the position of the mass, which the record lacks; give its stiffness and "
            "drive velocity, or its position"
        )
    return np.asarray(record.drive_velocity * record.time - record.force / record.stiffness)


def _grain(record: Record, position: Floats) -> float:
    """Return the rounding error of the position (m), mainly that of V t."""
    travelled = (record.drive_velocity or 0.0) * np.abs(record.time).max(initial=0.0)
    return float(4.0 * np.spacing(max(travelled, np.abs(position).max(initial=0.0))))


def _least_width(record: Record, position: Floats, length: Floats, exact: bool) -> float:
    """Return the narrowest width (s) of bins that the noise allows, given the number of phases."""
    fine = float(np.median(length)) / FINEST if len(length) else 1.0
    if exact:  # the motion between two samples is not known
        return max(fine, FEWEST / record.sample_rate) if len(record) > 1 else fine
    if not len(length) or record.drive_velocity is None or len(record) <= 2 * LAG + 1:
        return fine
    bent = position[: -2 * LAG] - 2.0 * position[LAG:-LAG] + position[2 * LAG :]
    noise = trimmed_mean(bent).error * (len(bent) / 6.0) ** 0.5  # standard deviation, if normal
    samples = record.sample_rate * len(length)  # per second, of all phases
    wanted = (4.0 * noise / (AIM * record.drive_velocity) / samples**0.5) ** (2.0 / 3.0)
    return max(fine, float(wanted))
