"""A part of a run or of a record, seen as large as the whole."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from stiction.analysis.record import Record
from stiction.arrays import Floats
from stiction.errors import ResultError, Status
from stiction.formats.table import number_of
from stiction.result.table import ColumnTable
from stiction.result.window import ROUNDED, window_between, window_of
from stiction.text.units import Quantity
from stiction.trajectory import Trajectory


def excerpt(run: Trajectory, window: Sequence[Quantity] | None) -> Trajectory:
    """Return a part of a run: its samples and rests in a window of time.

    Parameters
    ----------
    run : Trajectory
        With samples.
    window : tuple of float or str, or None
        Start and end in the run, s; all of it if None.

    Raises
    ------
    ResultError
        If it is not a part of the run, or has fewer than two samples.

    Examples
    --------
    >>> import stiction as st
    >>> run = st.simulate(st.presets.nakano_popov_2020(), "20 ms", sample_rate="10 kHz")
    >>> excerpt(run, ("5 ms", "10 ms")).samples["time"][[0, -1]].tolist()
    [0.005, 0.01]
    """
    if window is None:
        return run
    start, end = window_of(run.description, window)
    times = run.samples["time"]
    within = _within(times, start, end)
    if (count := len(times[within])) < 2:
        raise ResultError(
            f"window: {start:.10g} s to {end:.10g} s has {count} of the run's samples, whose last "
            f"is at {times[-1]:.10g} s; a line needs two: choose another window, or run it with a "
            "higher sample_rate"
        )
    columns = {
        name: each._replace(values=each.values[within]) if "time" in each.dims else each
        for name, each in run.samples.columns.items()
    }
    overlap = (run.stick_intervals[:, 1] > start) & (run.stick_intervals[:, 0] < end)
    return replace(
        run,
        arrays=lambda: ColumnTable(columns, run.samples.attributes),
        stick_intervals=run.stick_intervals[overlap].clip(start, end),
        status=run.status if times[within][-1] == times[-1] else Status.COMPLETED,
    )


def excerpt_of_record(record: Record, window: Sequence[Quantity] | None) -> Record:
    """Return the part of a record in a window of its times, with all that is known of it.

    Raises
    ------
    ResultError
        If it is not a part of the record, or has fewer than two samples.

    Examples
    --------
    >>> import stiction as st
    >>> record = st.Record(time=[0.0, 1.0, 2.0], force=[1.0, 2.0, 3.0], mass="1 kg")
    >>> part = excerpt_of_record(record, ("1 s", "2 s"))
    >>> part.force.tolist(), part.mass
    ([2.0, 3.0], 1.0)
    """
    if window is None or not len(record):
        return record
    start, end = window_between(float(record.time[0]), float(record.time[-1]), window, "record")
    part = record.part(_within(record.time, start, end))
    if len(part) < 2:
        raise ResultError(
            f"window: {start:.10g} s to {end:.10g} s has {number_of(len(part), 'sample')} of the "
            "record; choose another window"
        )
    return part


def _within(times: Floats, start: float, end: float) -> slice:
    """Return the samples in a window, whose ends may be rounded."""
    ends = start - ROUNDED * abs(start), end + ROUNDED * abs(end)
    return slice(*np.searchsorted(times, ends))


def excerpts(
    runs: Mapping[str, Trajectory], window: Sequence[Quantity] | None
) -> dict[str, Trajectory]:
    """Return the `excerpt` of each run; the error names the run that has none."""
    found = {}
    for label, run in runs.items():
        try:
            found[label] = excerpt(run, window)
        except ResultError as error:
            raise ResultError(f"{label}: {error}") from None
    return found
