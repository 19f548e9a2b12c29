"""Steady drift of a force."""

from __future__ import annotations

from math import hypot, isfinite
from typing import NamedTuple

import numpy as np

from stiction.analysis.motion.changes.levels import levels
from stiction.analysis.motion.changes.mean_load import under_mean_load
from stiction.analysis.motion.changes.shared import shared_change
from stiction.analysis.motion.changes.sliding import Sliding, sliding
from stiction.analysis.motion.cycle_columns import CycleTable
from stiction.analysis.motion.cycles import swings
from stiction.analysis.motion.friction import Friction
from stiction.analysis.motion.regime.kinds import HARMONIC, STEADY, STICK_SLIP, TRANSITIONAL
from stiction.analysis.record import Record
from stiction.analysis.signals.correlated_noise import ERRORS_997, error_of_few, statistics
from stiction.analysis.signals.robust import part_means
from stiction.analysis.signals.straight_line import line, slope_in_lasting_noise
from stiction.arrays import Floats

SURE, LIKELY = 4.0, ERRORS_997  # standard errors of a drift, in a sentence and in errors alone
WORTH = 0.02  # of the mean force, over the record: smaller drift is not reported
# Number of means of a force without cycles, over the second half of its sliding
MEANS_OF_SLIDING = 40
MOST_MEANS = 1000  # of the middles of cycles: more would take long
FEWEST_CYCLES = 4  # cycles that show a drift
LASTING = 0.5  # of its rate, by which that of each half may differ
SETTLING_MEANS = 64  # of a force while a mass slides
EARLY, LATE = slice(4, 8), slice(32, None)  # of them


class Drift(NamedTuple):
    """A steady change of the force (N/s), its standard error, and the change while it is seen (N).

    start, end : when it is seen, s: without cycles in the second half of the sliding.
    sure : whether there is one; stands_out : whether it is so large that it is worth a sentence.
    likely : the rate at which peaks and troughs, or sliding, change perhaps by chance, N/s; or 0.
    shared : by how much they are off on average if any change that they share is the zero, N; of a
    force without cycles by how much it settles while the mass slides.
    """

    rate: float
    error: float
    change: float
    start: float
    stands_out: bool
    sure: bool = False
    likely: float = 0.0
    shared: float = 0.0
    end: float = np.nan

    @property
    def possible(self) -> float:
        """The rate for which errors must allow, N/s: a sure one or a likely one, or 0."""
        return abs(self.rate) if self.sure else abs(self.likely)


NO_DRIFT = Drift(0.0, np.nan, 0.0, np.nan, stands_out=False)


def find_drift(record: Record, cycles: CycleTable) -> Drift:
    """Fit a line to the middles between peaks and troughs, or to a force without cycles.

    The standard error allows for neighbours that deviate alike. A force that stays at several
    levels changes from one to the next, and shows none; nor does one whose halves change otherwise,
    as where a record ends while the spring is unloaded: the error is NaN.
    """
    shared = 0.0
    if len(cycles) >= FEWEST_CYCLES:
        times = float(record.time[0]), cycles["peak_time"]
        shared = shared_change(*times, cycles["peak"], cycles["trough"])
        at = 0.5 * (cycles["peak_time"] + cycles["trough_time"])
        middle = 0.5 * (cycles["peak"] + cycles["trough"])
        seen = record.time[[0, -1]]
    elif not len(cycles) and (slides := _lasting(record)) and len(levels(record)) < 2:
        late = slice(slides.half, slides.last)
        at, middle = (
            part_means(each[late], MEANS_OF_SLIDING) for each in (record.time, record.force)
        )
        seen = record.time[[late.start, late.stop - 1]]
        shared = _settled_by(record.force[slides.first : slides.last])
    else:
        likely = _likely_rate(cycles)
        return NO_DRIFT._replace(likely=likely)
    at, middle = (part_means(each, MOST_MEANS) for each in (at, middle))
    rate, error = slope_in_lasting_noise(at, middle)
    if not _goes_on(at, middle, rate):
        error = np.nan
    start, end = map(float, seen)
    change = rate * (end - start)
    large = abs(change) > WORTH * abs(float(middle.mean()))
    sure = abs(rate) > SURE * error
    if sure:
        likely = 0.0
    else:
        likely = _likely_rate(cycles) if len(cycles) else rate * (abs(rate) > LIKELY * error)
    return Drift(rate, error, change, start, large and sure, sure, likely, shared, end)


def _lasting(record: Record) -> Sliding | None:
    """Return the sliding; None if its second half, in which it has settled, has too few samples."""
    slides = sliding(record) if len(record) else None
    return slides if slides and slides.last - slides.half >= MEANS_OF_SLIDING else None


def _likely_rate(cycles: CycleTable) -> float:
    """Return the rate (N/s) at which peaks and troughs seem to change alike; 0 if they do not.

    It is too uncertain to be reported, but not to be an error. Where friction differs from slip to
    slip, peaks or troughs scatter less than their middle; and a few of both tell one common rate.
    """
    if len(cycles) < 2:
        return 0.0
    ends = [(cycles[f"{end}_time"], cycles[end]) for end in ("peak", "trough")]
    away = [(at - at.mean(), force - force.mean()) for at, force in ends]
    rates = [_rate(*each, len(cycles) - 2) for each in away]
    (peaks, peak_error), (troughs, trough_error) = rates
    if abs(peaks - troughs) > LIKELY * np.hypot(peak_error, trough_error):
        return 0.0
    at, force = np.concatenate(away, axis=1)
    rates.append(_rate(at, force, 2 * len(cycles) - 3))
    likely = (rate for rate, error in rates if abs(rate) > LIKELY * error)
    return max(likely, key=abs, default=0.0)


def _rate(at: Floats, force: Floats, freedom: int) -> tuple[float, float]:
    """Return the slope of a line, and its error by so many degrees of freedom; NaN without any."""
    found = line(at, force)
    share = (len(at) - 2) / max(freedom, 1)
    return found.slope, error_of_few(found.slope_error * share**0.5, freedom)


def shift_of_drift(drift: Drift, lasts: float) -> float:
    """Return by how much a drift shifts mean friction, N, in a record that lasts so long (s)."""
    return max(0.5 * drift.possible * lasts, drift.shared)


def is_shown(drift: Drift, kind: str) -> bool:
    """Return whether a motion of some kind shows a steady drift, or none, by its force."""
    known = kind in (STICK_SLIP, TRANSITIONAL, HARMONIC, STEADY)
    return known and bool(np.isfinite(drift.error))


def with_drift(friction: Friction, record: Record, cycles: CycleTable, drift: Drift) -> Friction:
    """Return the friction with the errors that follow if a drift is the zero's.

    The zero is right at the first sample, as `detrend` takes it. Each is off by what it drifts
    until then: peaks and means by that of the middle of their times, where there are no cycles the
    mean by that where it is seen. A drift may be that of friction instead: then they are right,
    at that time. Beyond a stated drift the zero may drift by the uncertainty of that.
    """
    sensor = (record.sensors or {}).get("force")
    rate = hypot(drift.possible, 0.0 if sensor is None else sensor.zero_drift_uncertainty)
    if rate == drift.shared == 0.0:
        return friction
    first = float(record.time[0])
    seen = 0.5 * (drift.start + drift.end)
    middle = peak = seen if isfinite(seen) else 0.5 * float(record.time[0] + record.time[-1])
    if len(cycles):
        peak = float(cycles["peak_time"].mean())
        middle = 0.5 * (peak + float(cycles["trough_time"].mean()))
    broken = peak
    if friction.break_away is not None:
        broken = float(record.time[np.argmax(record.force >= friction.break_away.force)])
    lasts = {"break_away": broken, "static": peak, "kinetic": middle}
    further = {name: rate * (at - first) for name, at in lasts.items()}
    for name in ("static", "kinetic"):
        further[name] = max(further[name], drift.shared)
    return friction.with_errors(**further)


def _settled_by(force: Floats) -> float:
    """Return by how much a force settles while a mass slides, N; 0 if perhaps by chance.

    That is from early in the sliding, but after friction has fallen from a break-away, to its
    second half, of which kinetic friction is the mean after a loading.
    """
    means = part_means(force, SETTLING_MEANS)
    if len(means) < SETTLING_MEANS:
        return 0.0
    (early, error, _), (late, late_error, _) = map(statistics, (means[EARLY], means[LATE]))
    settled = abs(early - late)
    return settled if settled > LIKELY * np.hypot(error, late_error) else 0.0


def _goes_on(at: Floats, middle: Floats, rate: float) -> bool:
    """Return whether each half changes at about this rate: a single loading is not drift."""
    if len(at) < 2 * FEWEST_CYCLES:
        return True
    half = len(at) // 2
    halves = (
        slope_in_lasting_noise(at[part], middle[part]) for part in (slice(half), slice(half, None))
    )
    return all(abs(its - rate) <= SURE * error + LASTING * abs(rate) for its, error in halves)


def detrend(record: Record) -> Record:
    """Return a record without the steady drift of its force.

    The line is zero at the first sample, which is taken as correct. A force without cycles shows
    its drift in the second half of the sliding, and is changed from there on. Friction that
    changes steadily is removed like drift. A force whose halves change otherwise is left as it is.

    Parameters
    ----------
    record : Record
        With at least four cycles, or with steady sliding in its second half.

    Examples
    --------
    >>> import numpy as np, stiction as st
    >>> time = np.arange(0.0, 20.0, 1e-3)
    >>> record = st.Record(time=time, force=1.0 + 0.1 * (time % 2.0) + 0.01 * time)
    >>> cycles = st.analysis.find_cycles(st.analysis.detrend(record))
    >>> bool(np.ptp(cycles["peak"].values) < 0.001)
    True
    """
    drift = find_drift(record, swings(under_mean_load(record)).lasting)
    if not np.isfinite(drift.error):
        return record
    return record.with_force(record.force - drift.rate * np.maximum(record.time - drift.start, 0.0))
