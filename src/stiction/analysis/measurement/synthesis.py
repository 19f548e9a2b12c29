"""Synthetic measurements: a run as sensors would have recorded it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from stiction.analysis.measurement.run_record import record_of
from stiction.analysis.record import Record
from stiction.analysis.signals.spectrum import even_rate
from stiction.arguments import end_reading, read_together
from stiction.arrays import Floats
from stiction.errors import ResultError, echo
from stiction.recording.sensor import Sensor
from stiction.system.load_cell import travel_along_cell
from stiction.text.units import Quantity, SampleRate
from stiction.text.validation import Described, read_arguments
from stiction.trajectory import Trajectory


class Sampling(Described):
    """The sample rate of a record, Hz; 0 for the run's."""

    sample_rate: SampleRate = 0.0


@read_together
def measure(
    run: Trajectory,
    sensor: Sensor | Mapping[str, Sensor],
    *,
    sample_rate: Quantity | None = None,
    seed: int = 0,
) -> Record:
    """Return a run as its sensors record it: filtered, sampled, with noise, rounded.

    Parameters
    ----------
    run : Trajectory
        Sampled finely enough for the filters: at least 2.5 times the highest cut-off.
    sensor : Sensor or dict
        Of the force along the load cell; or from a channel to its sensor: ``force``,
        ``force_across``, ``load``, ``position``, ``drive_position``, along the cell, too,
        ``slip_speed``. Other channels are not recorded.
    sample_rate : float or str, optional
        Of the record, Hz; by default that of the run. Between the run's samples, straight lines.
    seed : int, optional
        Of the noise: the same seed gives the same record.

    Raises
    ------
    ResultError
        If the run is too coarse for a filter or for the sample rate, or sampled at uneven times, or
        there is no such channel.

    Examples
    --------
    >>> import stiction as st
    >>> run = st.simulate(st.presets.nakano_popov_2020(), "20 ms", sample_rate="10 kHz")
    >>> record = st.measure(run, st.Sensor(noise="2 mN"), sample_rate="2 kHz")
    >>> len(record), record.sensors["force"].noise
    (41, 0.002)
    """
    if not isinstance(run, Trajectory):
        raise ResultError(f"{echo(run)} is not a run; make one with st.simulate")
    sensors = {"force": sensor} if isinstance(sensor, Sensor) else sensor
    if not isinstance(sensors, Mapping) or not all(
        isinstance(each, Sensor) for each in sensors.values()
    ):
        raise ResultError(
            f"{echo(sensor)} is not a sensor, nor one for each channel; write for example "
            "st.Sensor(noise='2 mN')"
        )
    plain, own = record_of(run), even_rate(run)
    sampling = read_arguments(Sampling, sample_rate=0.0 if sample_rate is None else sample_rate)
    rate = sampling.sample_rate or own
    if rate > own * (1.0 + 1e-9):
        raise ResultError(
            f"the run has {own:g} samples a second, the record is to have {rate:g}; "
            "simulate it with a higher sample_rate"
        )
    values = {"force": plain.force, **_others(run, plain)}
    unknown = [name for name in sensors if name not in values]
    if unknown or "force" not in sensors:
        what = f"{echo(unknown[0])} is not a channel" if unknown else "the force has no sensor"
        raise ResultError(f"{what}; channels of a run: {', '.join(values)}")
    end_reading()
    count = int(np.floor(plain.duration * rate * (1.0 + 1e-12))) + 1
    time = plain.time[0] + np.arange(count) / rate
    streams = np.random.SeedSequence(seed).spawn(len(values))
    found: dict[str, Any] = {}
    for name, stream in zip(values, streams, strict=True):
        if name not in sensors:
            continue
        slow = sensors[name].response(values[name], own)
        found[name] = sensors[name].readings(np.interp(time, plain.time, slow), stream, time)
    known = ["stiffness", "drive_velocity", "mass"]
    if "load" not in found or not np.ptp(values["load"]) > 0.0:  # no number states a varying load
        known.append("normal_load")
    return Record(
        time=time,
        **found,
        **{name: getattr(plain, name) for name in known},
        stiffness_across=run.slider.k_y,
        sensors={name: sensors[name].behind() for name in found},
    )


def _others(run: Trajectory, plain: Record) -> dict[str, Floats]:
    """Return the channels of a run beside the force along the cell, at the record's times."""
    data, cell = run.data.isel(time=slice(0, len(plain))), run.slider.load_cell
    along, across = data["spring_x"].values, data["spring_y"].values
    return {
        "force_across": cell.way * cell.across(along, across),
        "load": data["normal_load"].values,
        "position": plain.position,
        "drive_position": travel_along_cell(run.slider, plain.time),
        "slip_speed": plain.slip_speed,
    }
