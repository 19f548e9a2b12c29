"""What a simulation of an apparatus shows, as its load cell would."""

from __future__ import annotations

from math import pi
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from stiction import theory
from stiction.analysis.cycles import swings
from stiction.analysis.record import Record, record_of
from stiction.analysis.regime import Regime, regime_of
from stiction.auditing.prediction import SEEN, Prediction
from stiction.simulation import simulate
from stiction.slider import Slider
from stiction.trajectory import Trajectory

if TYPE_CHECKING:
    import xarray as xr

CYCLES = 6  # to look at, if it is to stick and slip
LOAD_UPS = 4.0  # to wait for a force that only approaches what friction can do
DECAYS = 8.0  # e-folds of a disturbance to wait for: it is a thousandth then
LONGEST = 2000.0  # swings on the soft spring to wait for that at most
COARSE = 40.0  # samples in each swing on the soft spring
ALMOST = 0.99  # of the drive's speed: it has come to slide
MOST_SAMPLES = 1_000_000
MOST_STEPS = 5_000_000  # some 2 s
MANY = 50_000  # transverse periods, from which on few cycles are to stand for many


class Shares(NamedTuple):
    """What the time is spent on, as shares: at rest, creeping slower than the drive, slipping."""

    rest: float
    creep: float
    slip: float


class Observation(NamedTuple):
    """A simulated test: the run, what its load cell records, what can be read from that."""

    run: Trajectory
    record: Record
    cycles: xr.Dataset
    regime: Regime
    shares: Shares

    @property
    def coarse(self) -> bool:
        """Whether it is sampled too coarsely to see the song."""
        slider = self.run.slider
        song = theory.natural_frequency(slider.k_y, slider.mass) / (2.0 * pi)
        return bool(self.record.sample_rate < 0.9 * SEEN * song)

    def mean(self, name: str) -> float:
        """Return the mean of a quantity over the cycles, not a number if there are none."""
        values = self.cycles[name].values
        return float(values.mean()) if len(values) else float("nan")


def observe(
    slider: Slider, prediction: Prediction, growth: float, *, sample_rate: float
) -> Observation:
    """Simulate a friction test from rest, and read its record.

    Parameters
    ----------
    slider : Slider
        The apparatus.
    prediction : Prediction
        Of the same; it says how long a test takes.
    growth : float
        Growth rate (1/s) of a disturbance of steady sliding; where it is negative the test goes
        on until that has died out.
    sample_rate : float
        Hz; less if there would be too many samples.
    """
    load_up = prediction.load_up
    slips = CYCLES * prediction.period if prediction.slips else 0.0
    wait = DECAYS / abs(growth) if growth != 0.0 else 0.0
    longest = LOAD_UPS * load_up + LONGEST / prediction.f_x
    duration = min(max(LOAD_UPS * load_up, 1.2 * load_up + max(slips, wait)), longest)
    run = simulate(
        slider,
        duration,
        sample_rate=min(sample_rate, MOST_SAMPLES / duration),
        multiscale=duration * prediction.f_y > MANY,
        max_steps=MOST_STEPS,
    )
    record = record_of(run)
    found = swings(record)
    cycles = found.cycles
    return Observation(run, record, cycles, regime_of(record, found), shares(run, cycles))


def coarse_rate(prediction: Prediction) -> float:
    """Return the sample rate (Hz) that shows the slow motion, but not the song."""
    return COARSE * prediction.f_x


def shares(run: Trajectory, cycles: xr.Dataset) -> Shares:
    """Return what the time is spent on in whole cycles, or while it loads up if it has none."""
    times, (drive, _) = run.data["time"].values, run.slider.motion.rate(0.0)
    speed = run.data["V_X"].values / drive
    begin, end = times[0], times[np.argmax(speed > ALMOST)] if speed.max() > ALMOST else times[-1]
    if cycles.sizes["cycle"]:
        begin, end = float(cycles["start"][0]), float(cycles["trough_time"][-1])
    slip = float((speed[(times >= begin) & (times <= end)] > 1.0).mean())
    rest = float(np.diff(np.clip(run.stick_intervals, begin, end), axis=1).sum() / (end - begin))
    return Shares(rest, max(0.0, 1.0 - slip - rest), slip)
