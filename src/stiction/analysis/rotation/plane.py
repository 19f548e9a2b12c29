"""Both forces in the plane, along the load cell and across it, of a record or a run."""

from __future__ import annotations

import numpy as np

from stiction.analysis.record import Record
from stiction.recording.sensor import Sensor
from stiction.trajectory import Trajectory

EXACT = 1e-6  # of the largest force: the zero of a run is known, but for rounding


def with_both_forces(source: Trajectory | Record, record: Record) -> Record | None:
    """Return the record of a source with its force across; None where that is not measured.

    The force across of a run is that of its springs, whose zero is known.
    """
    if isinstance(source, Record):
        return record if record.force_across is not None else None
    cell, samples = source.slider.load_cell, source.samples
    columns = np.stack([samples[name] for name in ("time", "spring_x", "spring_y")])
    time, f_x, f_y = columns[:, np.isfinite(columns).all(axis=0)]
    across = np.interp(record.time, time, cell.way * cell.across(f_x, f_y))
    across.setflags(write=False)
    zero = EXACT * float(max(np.abs(record.force).max(), np.abs(across).max()))
    sensors = {"force_across": Sensor(zero_uncertainty=zero)} if zero else None
    return record.model_copy(update={"force_across": across, "sensors": sensors})
