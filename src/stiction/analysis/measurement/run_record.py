"""The record of a run, as its load cell would take it."""

from __future__ import annotations

from typing import Any

import numpy as np

from stiction.analysis.record import OfRun, Record
from stiction.arguments import with_article
from stiction.arrays import Floats
from stiction.drive import ConstantVelocity
from stiction.errors import ResultError
from stiction.formats.frames import is_frame
from stiction.system.load_cell import CellAxis, stiffness_of_cell, travel_along_cell
from stiction.system.slider import Slider
from stiction.system.tensors import ROUND
from stiction.trajectory import Trajectory


def as_record(source: Trajectory | Record) -> Record:
    """Return the record of a run, or a record in which a slow sensor's repeated values stand once.

    A drive velocity that is not stated is that which an even displacement of the drive shows.

    Raises
    ------
    ResultError
        If `source` is neither.
    """
    if isinstance(source, Record):
        return source.each_value_once().with_measured_velocity()
    if isinstance(source, Trajectory):
        return record_of(source)
    what = with_article(type(source).__name__)
    is_rig = isinstance(getattr(source, "slider", source), Slider)
    remedy = "st.simulate(...)" if is_rig else "st.Record(time=..., force=...)"
    if is_frame(source):
        remedy += " or st.read_record(...); a part of a run has window=(1, 2)"
    raise ResultError(f"{what} is neither a run nor a record; make one with {remedy}")


def record_of(run: Trajectory) -> Record:
    """Return a run as its load cell records it, with position, slip speed and stick intervals.

    The force is that along the `load_cell` of the slider: k_x u_x where it has no `cell_angle`. It
    is positive where the spring pulls along the drive. NaN samples at the end of a failed
    run are left out.

    Examples
    --------
    >>> import stiction as st
    >>> run = st.simulate(st.presets.nakano_popov_2020(), "1 s", sample_rate="1 kHz")
    >>> st.analysis.record_of(run).sample_rate
    1000.0
    """
    slider, samples = run.slider, run.samples
    way = slider.load_cell.way
    names = ("time", "spring_x", "spring_y", "X", "slip_speed", "normal_load", "v_x", "v_y")
    columns = np.stack([samples[name] for name in names])
    time, f_x, f_y, X, slip_speed, load, *rates = columns[:, np.isfinite(columns).all(axis=0)]
    if not len(time):
        raise ResultError("no sample of the run is a number; simulate it again")
    record = Record(
        time=time,
        force=way * _along_cell(slider.load_cell, f_x, f_y),
        **apparatus(slider),
        position=way * X,
        slip_speed=slip_speed,
        load=None if slider.load is None else load,
    )
    steady = isinstance(slider.motion, ConstantVelocity)
    travel = None if steady else travel_along_cell(slider, time)
    force_rate = way * slider.load_cell.along(slider.k_x * rates[0], slider.k_y * rates[1])
    record._of_run = OfRun(
        slider, run.stick_intervals, time, rates[slider.stiffer_axis], travel, force_rate,
        run.description.run.rtol,
    )  # fmt: skip
    return record


def _along_cell(cell: CellAxis, f_x: Floats, f_y: Floats) -> Floats:
    """Return the part of a force along a cell: zero where it stands across, but for rounding."""
    force: Floats = cell.along(f_x, f_y)
    whole = max(np.abs(f_x).max(), np.abs(f_y).max())
    return force if np.abs(force).max() > ROUND * whole else np.zeros_like(force)


def apparatus(slider: Slider) -> dict[str, Any]:
    """Return the apparatus of a slider by the fields of a record."""
    return {
        "normal_load": slider.normal_load,
        "stiffness": stiffness_of_cell(slider, slider.k_y),
        "drive_velocity": abs(slider.load_cell.velocity) or None,
        "mass": slider.masses[0],
    }


def across_force(run: Trajectory, record: Record) -> bool:
    """Return whether springs carry a force that the load cell, across it, does not measure."""
    samples = run.samples
    carried = any(np.nanmax(np.abs(samples[name])) > 0.0 for name in ("spring_x", "spring_y"))
    return carried and not record.force.any()
