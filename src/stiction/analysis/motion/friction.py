"""Friction from a force: at the break-away, static and kinetic."""

from __future__ import annotations

from math import hypot, isfinite
from typing import NamedTuple

import numpy as np

from stiction.analysis.motion.changes.sliding import Sliding, sliding
from stiction.analysis.motion.course import BEGINS_UNLOADED, COURSE_PARTS
from stiction.analysis.motion.cycle_columns import CycleTable
from stiction.analysis.motion.regime.evidence import Regime
from stiction.analysis.motion.regime.kinds import (
    HARMONIC,
    IRREGULAR,
    SETTLING,
    STEADY,
    STICK_SLIP,
    STUCK,
    TRANSITIONAL,
    TRANSVERSE,
    UNDETERMINED,
)
from stiction.analysis.motion.rest import comes_to_rest
from stiction.analysis.record import Record
from stiction.analysis.signals.correlated_noise import mean_and_spread, statistics
from stiction.analysis.signals.digitised import resolution
from stiction.analysis.signals.robust import MEANS_OF_RECORD, part_means, part_starts
from stiction.analysis.signals.turning_points import without_spikes
from stiction.arrays import TINY, Floats
from stiction.recording.noise import rounding_error, white_noise
from stiction.text.quantity.wording import percent, with_error

LOADING_MEANS = 16  # at least, before the first cycle: a shorter loading is not resolved
FEWEST_SAMPLES = COURSE_PARTS  # with fewer the kind of motion is not known, either
STANDS_OUT = 4.0  # standard deviations of the noise of a mean
PEAK = 0.02  # of the rise: the fall after a maximum that makes it a peak
# A level before the peak: its least share of the rise, how far the force goes above it, and means
LOW, HIGHER, FEWEST_MEANS = 0.1, 1.2, 4
# Standard deviations of white noise: by so much, and no more, the mean of peaks is too high where
# each peak is sought among some samples; 0.4 in the median of random records
ABOVE = 0.5
FIRST_FALL = 1.0 / 3.0  # of the median fall, at least, is the first one
FALLS = 10.0  # standard deviations of noise, whose range over a million means is that
SHARP = 2e-3  # of the range of force: noise that is averaged away at the peak
# Kinds of motion whose kinetic friction is the mean of peaks and troughs
SWINGING = (STICK_SLIP, TRANSITIONAL, HARMONIC, TRANSVERSE, IRREGULAR)
BACKWARD = 0.5  # of the cycles fall slowly and rise fast: the force has the other sign
BLOCKS = 20  # means, whose scatter gives the standard error for correlated samples


class Measured(NamedTuple):
    """A force (N), its standard error, and its spread (a standard deviation); NaN if not known.

    So for the friction coefficient: the force over the load at the same instant.
    """

    force: float
    error: float
    spread: float
    coefficient: float = np.nan
    coefficient_error: float = np.nan
    coefficient_spread: float = np.nan

    def __repr__(self) -> str:
        """Return force and coefficient with their errors."""
        return f"<Measured: {self.in_words()}>"

    def in_words(self) -> str:
        """Return force and coefficient with their errors, in words."""
        force = with_error(self.force, self.error, "N")
        if not isfinite(self.coefficient):
            return force
        return f"{force}, coefficient {with_error(self.coefficient, self.coefficient_error, '1')}"

    def with_error(self, further: float) -> Measured:
        """Return the same with a `further` error of the force, N."""
        error = float(np.hypot(self.error, further))
        of_coefficient = further * abs(self.coefficient / self.force) if self.force else np.nan
        its = float(np.hypot(self.coefficient_error, of_coefficient))
        return self._replace(error=error, coefficient_error=its)

    def with_load_error(self, relative: float) -> Measured:
        """Return the same with a `relative` error of the load."""
        its = float(np.hypot(self.coefficient_error, relative * abs(self.coefficient)))
        return self._replace(coefficient_error=its)


class Friction(NamedTuple):
    """The friction of a record; for each None, `missing` gives the reason.

    Parameters
    ----------
    break_away : Measured or None
        The first maximum of a force that is loaded from (nearly) nothing.
    static : Measured or None
        Mean of the peaks before each slip, of stick-slip.
    kinetic : Measured or None
        Mean force while sliding, in its last half after a loading, until the drive turns or stops,
        or the spring is unloaded; for stick-slip and vibration the mean of
        peak and trough, about which a mass swings that slips against constant friction.
    missing : dict
        Reason why each of them is unknown.
    """

    break_away: Measured | None
    static: Measured | None
    kinetic: Measured | None
    missing: dict[str, str]

    def __repr__(self) -> str:
        """Return each force and coefficient with its error."""
        of = ((name.replace("_", "-"), getattr(self, name)) for name in self._fields[:3])
        known = (f"{name} {each.in_words() if each else 'unknown'}" for name, each in of)
        return f"<Friction: {'; '.join(known)}>"

    def without_kinetic(self, reason: str) -> Friction:
        """Return the same without kinetic friction, for a reason."""
        return self._replace(kinetic=None, missing=self.missing | {"kinetic": reason})

    def without_static(self, reason: str) -> Friction:
        """Return the same without static friction, for a reason."""
        return self._replace(static=None, missing=self.missing | {"static": reason})

    def with_errors(self, **further: float) -> Friction:
        """Return the same with a further error (N) of each that is known, by its name."""
        known = {name: getattr(self, name) for name in further}
        return self._replace(
            **{name: each.with_error(further[name]) for name, each in known.items() if each}
        )

    def without_any(self, reason: str) -> Friction:
        """Return none of them, for a reason."""
        return Friction(None, None, None, dict.fromkeys(self._fields[:3], reason))


def friction_of(record: Record, regime: Regime, cycles: CycleTable) -> Friction:
    """Return the friction of a record with a known kind of motion, and known cycles."""
    if len(record) < FEWEST_SAMPLES:
        few = f"of the {FEWEST_SAMPLES} samples that are needed the record has {len(record)}"
        return Friction(None, None, None, {}).without_any(few)
    relative, slides = record.relative_load(), sliding(record)
    end = len(record) if len(cycles) else slides.last  # the fall after it follows no break-away
    load = record.normal_load or np.nan
    loads = load * relative[:end]
    if record.load_variation() == 0.0 and np.isfinite(loads).any():
        loads = np.full(end, np.nanmean(loads))  # of which any part has more noise
    break_away, reason = _find_break_away(record.time[:end], record.force[:end], cycles, loads)
    if break_away is not None:
        break_away = break_away.with_load_error(record.load_noise())
    slid = break_away is not None and not len(cycles)
    if regime.kind == STUCK and not regime.runner_up:
        break_away, reason = None, "the mass does not slip"
    shared = _shared_error(record) if len(cycles) else 0.0
    static, no_static = _static(regime, cycles, load, shared)
    kinetic: Measured | None
    if regime.kind in SWINGING and len(cycles):
        middle = 0.5 * (cycles["peak"] + cycles["trough"])  # about which the mass swings
        kinetic, no_kinetic = _over(middle, cycles["mu_kinetic"], load, shared), ""
    else:
        kinetic, no_kinetic = _kinetic(record, regime, slides, relative, slid)
    reasons = {"break_away": reason, "static": no_static, "kinetic": no_kinetic}
    missing = {name: why for name, why in reasons.items() if why}
    return Friction(break_away, static, kinetic, missing)


def _shared_error(record: Record) -> float:
    """Return the error of a force, N, that all its peaks have alike."""
    rounding = rounding_error(record.force, resolution(record.force))
    return hypot(rounding, ABOVE * white_noise(record.force))


def _static(
    regime: Regime, cycles: CycleTable, load: float, shared: float
) -> tuple[Measured | None, str]:
    """Return the static friction, or None and the reason."""
    if not regime.loads or not len(cycles):
        return None, f"it is the mean of the peaks of stick-slip, and {without_loading(regime)}"
    return _over(cycles["peak"], cycles["mu_static"], load, shared), ""


def _kinetic(
    record: Record, regime: Regime, slides: Sliding, relative: Floats, slid: bool
) -> tuple[Measured | None, str]:
    """Return the kinetic friction of a force without cycles, or None and the reason.

    `slid` says whether a break-away was found.
    """
    kind = regime.kind
    if comes_to_rest(record.slip_speed) and kind != STUCK:
        return None, "the mass comes to rest"
    if regime.has("slips_at"):
        return None, "the mass sticks before its only slip, and after it"
    if regime.has("turns", "loads_on"):
        return None, "it is not determined whether the mass slides"
    if kind in (STEADY, SETTLING, TRANSVERSE) or (kind == UNDETERMINED and slid):
        return _sliding(record, slides, kind, relative), ""
    against = "against" in regime.evidence or regime.evidence.get("backward", 0.0) > BACKWARD
    if against and record.slider is None and float(record.force.mean()) <= 0.0:
        return None, "the force seems to have the other sign"
    return None, f"the mass {'may' if kind == UNDETERMINED else 'does'} not slide"


def without_loading(regime: Regime) -> str:
    """Return why the loading of a motion shows neither static friction nor stiffness."""
    if regime.kind == STICK_SLIP:
        return "here the mass sticks too shortly, and inertia adds to the peaks"
    if regime.kind == STUCK:
        return "here the mass does not slip"
    if regime.kind == UNDETERMINED:
        return "the kind of motion here is undetermined"
    return "here the force settles" if regime.kind == SETTLING else f"this is {regime.kind}"


def _find_break_away(
    time: Floats, force: Floats, cycles: CycleTable, load: Floats
) -> tuple[Measured | None, str]:
    """Find the break-away, in so much of a force as resolves its first loading; or the reason."""
    end = until = len(force)
    if len(cycles):
        before, first = np.searchsorted(time, [cycles["start"][0], cycles["trough_time"][0]])
        until = max(FEWEST_SAMPLES, int(first) + 1)
        end = min(end, max(until, MEANS_OF_RECORD // LOADING_MEANS * int(before)))
    smooth = without_spikes(force[:end])
    forces = part_means(smooth, MEANS_OF_RECORD)
    typical = float(np.median(np.diff(part_starts(end, MEANS_OF_RECORD), append=end)))
    noise = white_noise(force[:end], order=2) / typical**0.5  # of a mean
    at, reason = _first_peak(forces, -(-min(until, end) * len(forces) // end), noise)
    if at is None:
        return None, reason
    size, first = -(-end // len(forces)), at * end // len(forces)
    rough = noise * size**0.5  # of a sample
    last = first + 3 * size
    if len(cycles):
        last = _first_fall(smooth[:last], cycles, rough, size)
        first = min(first, int(np.argmax(smooth[:last])))
    begin = max(0, first - 2 * size)
    wanted = (rough / max(SHARP * float(np.ptp(forces)), TINY)) ** 2
    width = int(min(max(wanted, 1.0), size))
    return _break_away(smooth, begin, last, width, rough, load), ""


def _first_peak(forces: Floats, until: int, noise: float) -> tuple[int | None, str]:
    """Return the index of the first maximum of a loading; or None and the reason.

    Of the forces, those before `until` belong to the loading and the first cycle: a later load, or
    velocity, may raise the others.
    """
    highest = np.maximum.accumulate(forces)
    rise = highest - forces[0]
    if forces[0] > BEGINS_UNLOADED * highest[-1] or _is_within(forces):
        return None, "the record does not begin with an unloaded spring"
    risen = (rise > 0.5 * rise[until - 1]) & (rise > 2.0 * STANDS_OUT * noise)
    if _dwells(forces, rise, int(np.argmax(risen)), noise):
        return None, (
            "the force stays at a lower level before its first peak, as where the load changes "
            "while the mass slides: analyse the part before that change by itself"
        )
    fall = np.maximum(FALLS * noise, PEAK * rise)
    fallen = np.flatnonzero((highest - forces > fall) & risen)
    if not len(fallen):
        least = f"{percent(PEAK)} of its rise and {FALLS:g} times the noise"
        return None, f"the first loading does not end in a fall of more than {least}"
    return int(np.argmax(forces[: fallen[0] + 1])), ""


def _dwells(forces: Floats, rise: Floats, until: int, noise: float) -> bool:
    """Return whether forces stay at a level, before an index, for longer than they rose to it.

    There a mass may slide, and has broken away before; in a single loading they rise on.
    """
    level = np.arange(until)[
        (rise[:until] > LOW * rise[until]) & (rise[:until] > 2.0 * STANDS_OUT * noise)
    ]
    begin = np.searchsorted(rise, LOW * rise[level], side="right")
    end = np.searchsorted(rise, HIGHER * rise[level], side="right")
    for at in level[end - level > np.maximum(level - begin, FEWEST_MEANS)]:
        stays = forces[at : np.searchsorted(rise, HIGHER * rise[at])] - forces[0]
        if np.median(stays) > 0.5 * rise[at]:
            return True
    return False


def _is_within(forces: Floats) -> bool:
    """Return whether a record that begins against the drive begins as it goes on.

    A spring that is loaded from there, with an untared zero, leaves those forces for good.
    """
    largest = float(np.abs(forces).max())
    if forces[0] >= -BEGINS_UNLOADED * largest:
        return False
    rise = forces - forces[0]
    if rise.max() < BEGINS_UNLOADED * largest:
        return True
    return bool(rise[np.argmax(rise > 0.5 * rise.max()) :].min() <= 0.0)


def _first_fall(force: Floats, cycles: CycleTable, rough: float, size: int) -> int:
    """Return where a force falls for the first time by more than its noise, (n,) if nowhere.

    A cycle may be as short as a mean of `size` samples. So the means are as short as the noise of
    a sample, `rough` (N), allows; no cycle begins before that fall.
    """
    fall = max(cycles.least, FIRST_FALL * cycles.median("drop"))
    width = int(min(max((FALLS * rough / fall) ** 2, 1.0), size))
    count = max(len(force) // width, 1)
    means = part_means(force, count)
    highest = np.maximum.accumulate(means)
    rise = highest - means[0]
    fallen = np.flatnonzero((highest - means > fall) & (rise > 0.5 * rise[-1]))
    return int(part_starts(len(force), count)[fallen[0]]) if len(fallen) else len(force)


def _break_away(
    force: Floats, begin: int, end: int, width: int, rough: float, load: Floats
) -> Measured:
    """Return the largest of a force without spikes from a sample to another, averaged over some.

    `rough` is the noise of a sample, N.
    """
    near = force[begin : end + 2 * width]
    smooth = np.convolve(near, np.full(width, 1.0 / width), "valid")
    top = int(np.argmax(smooth[: max(end - begin - width // 2, 1)]))
    error = float(np.hypot(rough / width**0.5, _peak_excess(smooth, top, width)))
    largest, under = float(smooth[top]), float(load[begin + top + width // 2])
    return Measured(largest, error, np.nan, largest / under, error / under)


def _peak_excess(values: Floats, top: int, step: int) -> float:
    """Return the largest excess of a peak over its value at `top`, from values a step apart.

    A rounded peak of uniform curvature lies below the intersection of the lines that continue its
    sides. A corner bends more than twice as much as its sides; it lies below the rise, continued by
    one step.
    """
    at = np.clip(top + step * np.arange(-2, 3), 0, len(values) - 1)
    before, rise, fall, after = np.diff(values[at]) * (1.0, 1.0, -1.0, -1.0)
    if rise + fall > 2.0 * min(before - rise, after - fall):
        return float(max(rise, before - rise))  # it lies after the largest value, or before
    sides = (rise, after, fall), (fall, before, rise)
    meet = [near * (far - over) / (near + far) for near, far, over in sides if near + far > 0.0]
    return float(max(meet, default=0.0))  # where it is level on both sides, as steps may be


def _over(forces: Floats, coefficients: Floats, load: float, shared: float) -> Measured:
    """Return the mean friction of forces, and of these over the load at the same instant.

    All forces may share an error, N: no mean is better than that.
    """
    force, error, spread = statistics(forces)
    mu, mu_error, mu_spread = statistics(coefficients)
    error, mu_error = np.hypot(error, shared), np.hypot(mu_error, shared / load)
    return Measured(force, float(error), spread, mu, float(mu_error), mu_spread)


def _sliding(record: Record, slides: Sliding, kind: str, relative: Floats) -> Measured:
    """Return the mean force while a mass slides: in the last half, if it may settle first."""
    time, load = record.time, record.normal_load or np.nan
    first, last = slides.first, slides.last
    if first or kind != STEADY:
        first = int(np.searchsorted(time, 0.5 * (time[first] + time[last - 1])))
    force = record.force[first:last]
    over_load = force / relative[first:last] / load
    rounding = rounding_error(force, resolution(record.force))
    blocks = _over(part_means(force, BLOCKS), part_means(over_load, BLOCKS), load, rounding)
    (mean, spread), (mu, mu_spread) = mean_and_spread(force), mean_and_spread(over_load)
    return Measured(mean, blocks.error, spread, mu, blocks.coefficient_error, mu_spread)
