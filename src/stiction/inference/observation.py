"""Observation of a record for a fit: whole cycles, thinned out, and their conditions."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from math import floor, hypot, log10
from pathlib import Path
from typing import NamedTuple, Self

import numpy as np

from stiction.analysis.measurement.reading import read_source
from stiction.analysis.measurement.run_record import as_record
from stiction.analysis.motion.cycles import OWN_HARMONICS, Swings
from stiction.analysis.motion.load_cell.free_swings import RingingCell
from stiction.analysis.motion.regime.classify import classify_record
from stiction.analysis.record import Record
from stiction.analysis.signals.correlated_noise import ERRORS_95
from stiction.analysis.signals.even_grid import MOST_MISSING, EvenGrid, even_grid
from stiction.analysis.signals.hum import Band, lines_like, without_bands
from stiction.analysis.signals.robust import block_means
from stiction.arrays import Floats
from stiction.drive import ConstantVelocity
from stiction.drive.program import nominal_velocity
from stiction.errors import ResultError
from stiction.inference.cycles import Cycles, slip_cycles
from stiction.inference.features import USED, FeatureScale, features
from stiction.inference.priors import JITTER, Uniform, jitter_of
from stiction.inference.suitability import (
    changes_within,
    dispute,
    refuse_far,
    refuse_few_cycles,
    refuse_hidden,
    refuse_no_mean,
    refuse_other_motion,
    refuse_other_sign,
)
from stiction.recording.coloured_noise import coloured_noise
from stiction.recording.noise import ROUNDING_SPREAD, lattice, resolved_noise
from stiction.recording.part import begin_and_end
from stiction.recording.sensor import LowPass
from stiction.system.slider import Slider
from stiction.text.quantity.wording import percent
from stiction.trajectory import Trajectory

Source = Record | Trajectory | str | Path  # of a record: a run is taken as if measured

PER_CYCLE = 200  # samples: more are averaged
MOST_PLACES = 8  # at which a motion is simulated between two samples: more change no mean
MOST_READINGS = 256  # of which a simulated sample is the mean, where each of them is rounded
# numbers of cycles, so that a library serves many records
LADDER = (6, 7, 8, 10, 12, 14, 17, 20, 24, 28, 34, 40)
MANTISSAS = (1.0, 1.2, 1.5, 1.8, 2.2, 2.7, 3.3, 4.0, 5.0, 6.0, 7.5, 9.0, 10.0)
# shares of a loading from which noise is told: between the swing after a slip and the quick creep
# before the next; and the percentile of loadings that are too short, so that the rest have as many
# samples
LOADED, LATEST, SHORTEST = (0.2, 0.6), 0.8, 10.0
DIGITS = 4  # of sampling interval and quantisation: those of many records differ by rounding
TREND = 0.01  # p-value of a trend below which cycles do not stay the same
DITHER = 0.5  # of a step: noise that hides it, so that rounding is noise too
VELOCITY = "drive.velocity"  # its path, where it is uncertain
SAME = 0.02  # of the drive velocity: a record's differs by less if a cell lies 10 deg askew


class Noise(NamedTuple):
    """The errors that a sensor adds to a channel's samples.

    Parameters
    ----------
    level : float
        Standard deviation of their white noise.
    gain, zero : float
        Uncertainty of its gain and of its zero.
    filters : tuple
        Its bandwidth and its anti-alias filter, as `LowPass`.
    drift : float
        Uncertainty of its zero's drift, in its unit over s.
    quantisation : float
        Step between its readings, where noise does not hide it; 0 where that is part of the noise.
    stop_bands : tuple
        Of `Band`: left out of record and simulations alike, because a line of the record, as of
        the mains, lay there.
    lasting, lasts : float
        Standard deviation of noise that lasts, beside the white, and the time (s) within which its
        correlation falls by a factor of e.
    cell : tuple, optional
        The load cell, where it rings: the force to which it answered is restored, which smooths it
        and amplifies the noise.
    """

    level: float
    gain: float = 0.0
    zero: float = 0.0
    filters: tuple[LowPass, ...] = ()
    drift: float = 0.0
    quantisation: float = 0.0
    stop_bands: tuple[Band, ...] = ()
    lasting: float = 0.0
    lasts: float = 0.0
    cell: RingingCell | None = None

    @property
    def error(self) -> float:
        """Standard deviation of a sample from noise and rounding."""
        return hypot(self.level, self.lasting, ROUNDING_SPREAD * self.quantisation)


class Conditions(NamedTuple):
    """The conditions of a record, which its simulations repeat.

    Parameters
    ----------
    velocity, normal_load, yaw : float
        Of the drive (m/s), normal load (N), and by how much the rig was turned (rad).
    step : float
        Between samples, s.
    cycles : int
        Number of whole cycles.
    cycle : float
        Their mean length, s.
    noise : dict of str to Noise
        Of each channel.
    lead : float
        Time from the start of the record to its first whole cycle, s, where a zero drifts.
    block : int
        Readings of which a simulated sample is the mean, each of them rounded.
    jitter : Uniform
        Prior of how friction differs from cycle to cycle.
    """

    velocity: float
    normal_load: float
    yaw: float
    step: float
    cycles: int
    cycle: float
    noise: dict[str, Noise]
    lead: float = 0.0
    block: int = 1
    jitter: Uniform = JITTER

    def slider_of(self, slider: Slider) -> Slider:
        """Return a slider under these conditions."""
        drive = ConstantVelocity._make([self.velocity])
        its = {"drive": drive, "normal_load": self.normal_load, "phi": slider.phi + self.yaw}
        return slider.model_copy(update=its)

    def truth_for(self, slider: Slider, middle: Slider) -> Self:
        """Return the true conditions for a slider drawn from its priors.

        Drive and load are off from what is stated by the factors by which the slider's are off from
        those in the `middle` of the priors: one lead screw and one dead weight serve all records.
        """
        faster = nominal_velocity(slider.motion) / nominal_velocity(middle.motion)
        heavier = slider.normal_load / middle.normal_load
        return self._replace(
            velocity=faster * self.velocity, normal_load=heavier * self.normal_load
        )

    def scale(self, slider: Slider) -> FeatureScale:
        """Return the scales of the features."""
        rig = self.slider_of(slider)
        return FeatureScale(
            rig.F_0, rig.k_x * abs(self.velocity), 1.0 / rig.natural_frequencies[0],
            abs(self.velocity), self.noise["force"].drift if self.noise else 0.0,
        )  # fmt: skip


class Trend(NamedTuple):
    """p-values of a trend from cycle to cycle.

    Of the peaks of a force, and of its drops, which the zero of a load cell leaves as they are.
    """

    peaks: float
    drops: float


class Observation(NamedTuple):
    """A record's cycles, as a fit uses them: conditions, features, thinned force and its cycles.

    `changes` are sentences on how cycles differ within the record, as an analysis finds it;
    `averaged` the number of its samples of which each thinned one is the mean; `disputed` says
    where an analysis counts other cycles, and is empty where it does not.
    """

    conditions: Conditions
    features: Floats
    force: Floats
    cycles: Cycles
    changes: tuple[str, ...] = ()
    averaged: int = 1
    disputed: str = ""

    @property
    def trend(self) -> Trend:
        """p-values of a trend of the cycles beyond the stated drift of the zero."""
        drift = self.conditions.noise["force"].drift * self.conditions.step
        return trend(self.force, self.cycles, ERRORS_95 * drift)


def trend(force: Floats, cycles: Cycles, drift: float = 0.0) -> Trend:
    """Return the p-values of a trend of peaks and of drops.

    By Kendall's rank correlation with the number of the cycle (M. G. Kendall, Biometrika 30, 81
    (1938)). From the peaks a line is subtracted first: that of P. K. Sen (J. Am. Stat. Assoc. 63,
    1379 (1968)), but no steeper than `drift`, the change of the zero from sample to sample that is
    expected at most.

    Examples
    --------
    >>> saw = np.concatenate([np.r_[0.0:1.0:9j, 0.5] + 0.05 * n for n in range(12)])
    >>> cycles = slip_cycles(saw)
    >>> trend(saw, cycles).peaks < 1e-3, trend(saw, cycles, drift=0.01).peaks > 0.01
    (True, True)
    """
    from scipy.stats import kendalltau, theilslopes

    peaks, drops = force[cycles.peak], force[cycles.peak] - force[cycles.after]
    if drift:
        slope = float(theilslopes(peaks, cycles.peak).slope)
        peaks = peaks - min(max(slope, -drift), drift) * cycles.peak
    found = (float(kendalltau(np.arange(len(x)), x).pvalue) for x in (peaks, drops))
    return Trend(*(its if np.isfinite(its) else 1.0 for its in found))  # all the same


def trend_of(seen: Sequence[Observation]) -> Trend:
    """Return the p-values of a trend in several records together.

    By R. A. Fisher (Statistical Methods for Research Workers, Edinburgh 1932): six cycles that all
    grow have p = 0.003, and the least p-value of four such records times their number would never
    be below 0.01, although each of them grows.
    """
    from scipy.stats import combine_pvalues

    pairs = zip(*(each.trend for each in seen), strict=True)
    return Trend(*(float(combine_pvalues(its).pvalue) for its in pairs))


def steadiness(probabilities: Iterable[float]) -> float:
    """Return the p-value of several tests together: the least one times their number (Bonferroni).

    >>> steadiness([0.25, 0.5]), steadiness([0.75, 1.0])
    (0.5, 1.0)
    """
    each = [*probabilities]
    return min(1.0, min(each, default=1.0) * len(each))


def observe(record: Record, slider: Slider, name: str = "the record") -> Observation:
    """Return the cycles of a record, under the conditions that the record or else the rig states.

    Raises
    ------
    ResultError
        If it has too few cycles, or its samples leave too large gaps; or where its force goes back
        and forth.
    """
    grid = grid_of(record, name)
    refuse_far(record, slider, name)
    record, seen, regime = classify_record(record)
    refuse_other_motion(record, regime, name)
    refuse_few_cycles(name, len(seen.lasting))  # what the analysis does not call cycles is noise
    step, lineless = float(f"{grid.step:.{DIGITS}g}"), without_lines(record, grid, seen)
    noise = {each: noise_of(record, each, *its) for each, its in lineless.items()}
    found = slip_cycles(
        lineless["force"].values, amplification(noise["force"], step) * noise["force"].error
    )
    refuse_hidden(name, len(found.peak), len(seen.lasting))
    refuse_other_sign(name, lineless["force"].values, found)
    refuse_no_mean(name, lineless["force"].values, found)
    lasts = float(np.mean(found.after - found.before)) * step
    if seen.cell is not None:  # before means are taken, amplified noise makes cycles, too
        lasts = seen.lasting.median("period")
    cycle = near(lasts)
    block = max(round(cycle / step / PER_CYCLE), 1)
    thin, thin_noise, found = thin_out(lineless, noise, step, block)
    refuse_hidden(name, len(found.peak), len(seen.lasting))  # noise had made some
    number = max(each for each in LADDER if each <= len(found.peak))
    found = Cycles(*(each[:number] for each in found))
    drifts = any(each.drift for each in noise.values())
    conditions = Conditions(
        drive_velocity(record, slider), float(record.normal_load or slider.normal_load),
        float(record.turned or 0.0), step * block, number, cycle, thin_noise,
        lead=near(step * block * int(found.before[0])) if drifts else 0.0,
        block=readings_to_simulate(block, thin_noise),
        jitter=jitter_of(thin["force"][found.peak]),
    )  # fmt: skip
    its = features(step * block, thin, conditions.scale(slider), found)
    troughs = float(record.time[0]) + step * block * np.array([found.before[0], *found.after])
    changes = changes_within(seen, regime, float(troughs[-1]) + step * block)
    disputed = dispute(seen, troughs, name)
    return Observation(conditions, its, thin["force"], found, changes, block, disputed)


def grid_of(record: Record, name: str) -> EvenGrid:
    """Return the even grid of a record's times."""
    grid = even_grid(record.time)
    if grid is None or not grid.serves:
        raise ResultError(
            f"{name} has samples too far apart, or too close together, for a fit, which takes an "
            f"uneven clock and gaps in {percent(MOST_MISSING)} of the time; fit a part without "
            f"gaps ({begin_and_end()})"
        )
    return grid


class Lineless(NamedTuple):
    """A channel on an even grid, without its spectral lines, and the bands (Hz) of the lines.

    `cell` is the ringing load cell if the values are the restored force, to which it answered.
    """

    values: Floats
    bands: tuple[Band, ...]
    cell: RingingCell | None = None


def without_lines(record: Record, grid: EvenGrid, seen: Swings) -> dict[str, Lineless]:
    """Return the channels of a record without lines such as mains hum; of the force its swings."""
    found, least = {}, OWN_HARMONICS / seen.lasting.median("period")
    for name in USED:
        values, lines = getattr(record, name), list(seen.lines)
        if values is None:
            continue
        if name != "force":
            lines = lines_like(lines, grid, values, least)
        less = seen.force if name == "force" else values - sum(line.values for line in lines)
        bands = tuple(band for line in lines for band in line.bands)
        cell = seen.cell if name == "force" else None
        found[name] = Lineless(grid.on(less), bands, cell)
    return found


class Thinned(NamedTuple):
    """Averages of blocks of samples for each channel, their noise, and their cycles."""

    channels: dict[str, Floats]
    noise: dict[str, Noise]
    cycles: Cycles


def thin_out(
    lineless: Mapping[str, Lineless], noise: Mapping[str, Noise], step: float, block: int
) -> Thinned:
    """Return means of blocks of samples, a step (s) apart, without the bands of lines."""
    its = {each: noise_of_means(own, block, step) for each, own in noise.items()}
    channels = {
        each: without_bands(block_means(values, block), step * block, its[each].stop_bands)
        for each, (values, *_) in lineless.items()
    }
    found = slip_cycles(channels["force"], its["force"].error)
    for each, values in channels.items():
        its[each] = with_lasting_noise(its[each], values, found, step * block, block)
    return Thinned(channels, its, slip_cycles(channels["force"], its["force"].error))


def sign_seen(conditions: Iterable[Conditions]) -> bool:
    """Return whether records show the sign of a misalignment: by a force across or a turn."""
    return any("force_across" in each.noise or each.yaw for each in conditions)


def drive_velocity(record: Record, slider: Slider, certain: bool = True) -> float:
    """Return the drive velocity that a record shows or states, else the rig's, with its sign.

    Where the record agrees with the rig's, if that is `certain`, it is the rig's, so that many
    records share a library.
    """
    velocity, speed, shown = nominal_velocity(slider.motion), record.stated_velocity, None
    if record.drive_position is not None:
        shown = record.even_drive()
    if shown is not None:
        speed = float(f"{shown.speed:.{DIGITS}g}")
        same = certain and shown.agrees(abs(velocity))
    else:
        same = speed is None or abs(speed / abs(velocity) - 1.0) <= SAME
    return velocity if same or speed is None else float(np.copysign(speed, velocity))


def read_all(records: Source | Sequence[Source], rig_load: float) -> list[Record]:
    """Return one or several records of a rig, under the normal load of its description.

    `rig_load` is NaN if the description's load is uncertain.
    """
    given = [records] if isinstance(records, Source) else [*records]
    if not given:
        raise ResultError("no record is given; name one or several")
    return [record_from(each, rig_load) for each in given]


def observe_all(records: Sequence[Record], slider: Slider) -> list[Observation]:
    """Observe one or several records of a rig."""
    return [observe(each, slider, f"record {number}") for number, each in enumerate(records, 1)]


def record_from(source: Source, rig_load: float | None = None) -> Record:
    """Return a record: as it is, of a run, or read from a file of either by `read_source`."""
    if isinstance(source, str | Path):
        source = read_source(source, rig_load=rig_load)
    return as_record(source)


def noise_of(
    record: Record,
    channel: str,
    values: Floats,
    bands: tuple[Band, ...] = (),
    cell: RingingCell | None = None,
) -> Noise:
    """Return the noise of a channel, from its sensor's statement or from its samples.

    `values` are its samples on an even grid, between which they are interpolated, less lines in
    some bands: rounding is noise where a line was rounded, too, and behind a `cell` that rings. The
    noise is then that of its readings.
    """
    sensor = (record.sensors or {}).get(channel)
    stated = (0.0, 0.0) if sensor is None else (sensor.noise, sensor.quantisation)
    readings = getattr(record, channel)
    step = stated[1] or lattice(readings)
    level = stated[0] or resolved_noise(values if cell is None else readings, step)
    if bands or cell or level > DITHER * step:
        level, step = hypot(level, ROUNDING_SPREAD * step), 0.0
    if sensor is None:
        return Noise(level, quantisation=step, stop_bands=bands, cell=cell)
    errors = sensor.gain_uncertainty, sensor.zero_uncertainty
    drift = sensor.zero_drift_uncertainty
    return Noise(level, *errors, sensor.filters, drift, step, bands, cell=cell)


def readings_to_simulate(block: int, noise: Mapping[str, Noise]) -> int:
    """Return how many readings to average for a simulated sample; the record's is `block`."""
    rounded = any(each.quantisation for each in noise.values())
    return min(block, MOST_READINGS if rounded else MOST_PLACES)


def noise_of_means(noise: Noise, block: int, step: float) -> Noise:
    """Return the noise of means of blocks of samples, rounded so that many records share it.

    Not where a force is restored: then noise is large beside a slip, and no other record has it. Of
    bands that means cannot resolve, so little is left that they need not be left out.
    """
    fastest, level = 0.5 / (step * block), noise.level / block**0.5
    if noise.cell is not None:
        level *= noise.cell.amplification(step, block)
    return noise._replace(
        level=round_up(level) if noise.cell is None else float(f"{level:.{DIGITS}g}"),
        quantisation=float(f"{noise.quantisation:.{DIGITS}g}"),
        stop_bands=tuple(to_tenths(band) for band in noise.stop_bands if band.high < fastest),
    )


def amplification(noise: Noise, step: float, block: int = 1) -> float:
    """Return the factor by which restoring a force makes means of blocks noisier."""
    return 1.0 if noise.cell is None else noise.cell.amplification(step, block)


def to_tenths(band: Band) -> Band:
    """Return a band with ends rounded to a tenth of its width, so that many records share it.

    >>> to_tenths(Band(149.43, 150.42)), to_tenths(Band(0.4956, 0.5056))
    (Band(low=149.4, high=150.4), Band(low=0.496, high=0.506))
    """
    digits = 1 - round(log10(band.high - band.low))
    return Band(*(round(end, digits) for end in band))


def with_lasting_noise(
    noise: Noise, values: Floats, cycles: Cycles, step: float, block: int
) -> Noise:
    """Return the noise of means of blocks, a step (s) apart, with its coloured part, if any.

    The noise is the difference between loadings, which have the same course. Where rounding shows,
    it has no coloured part.
    """
    if noise.quantisation:
        return noise
    rise = cycles.peak - cycles.before
    begin = cycles.before + np.rint(LOADED[0] * rise).astype(np.intp)
    size = int((LOADED[1] - LOADED[0]) * np.percentile(rise, SHORTEST)) if len(rise) else 0
    begin = begin[begin + size <= cycles.before + LATEST * rise]
    found = coloured_noise(values[begin[:, None] + np.arange(size)], block)
    if found is None:
        return noise
    level, lasting = round_up(found.white), round_up(found.deviation)
    return noise._replace(level=level, lasting=lasting, lasts=near(found.time * step))


def near(value: float) -> float:
    """Return the nearest value on a scale of few values, so that many records share it.

    >>> near(0.0123), near(9.8), near(0.0)
    (0.012, 10.0, 0.0)
    """
    return on_scale(value, lambda mantissa: min(MANTISSAS, key=lambda x: abs(log10(x / mantissa))))


def round_up(value: float) -> float:
    """Return a positive value rounded up by at most a quarter, so that many records share it.

    >>> round_up(0.0123), round_up(0.0)
    (0.015, 0.0)
    """
    return on_scale(value, lambda mantissa: next(x for x in MANTISSAS if x >= mantissa - 1e-9))


def on_scale(value: float, choose: Callable[[float], float]) -> float:
    """Return a positive value with its mantissa, 1 to 10, replaced by a choice; zero stays zero."""
    if value <= 0.0:
        return 0.0
    power = floor(log10(value))
    return float(f"{choose(value / 10.0**power)}e{power}")
