"""The kind of motion in cycles, from their shape."""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

import numpy as np

from stiction.analysis.motion.changes.cycles import parts_of
from stiction.analysis.motion.course import MANY, ORDERED, order
from stiction.analysis.motion.cycle_columns import CycleTable
from stiction.analysis.motion.cycles import Swings
from stiction.analysis.motion.regime.evidence import Evidence, Regime
from stiction.analysis.motion.regime.kinds import (
    HARMONIC,
    IRREGULAR,
    RESTING_SHARE,
    TRANSITIONAL,
    TRANSVERSE,
    UNDETERMINED,
    bounds,
    couples,
    shape,
    shape_each,
)
from stiction.analysis.motion.rest import TOUCHES, rest_share, stick_shares, still_shares
from stiction.analysis.motion.vibration import COUPLED, LIKELY, drop_spread, irregularity
from stiction.analysis.motion.wave import regular_wave
from stiction.analysis.record import Record
from stiction.analysis.signals.hum import beat_frequency
from stiction.arrays import TINY, Floats, median

ENOUGH = 8.0  # samples a cycle, which show its shape
STICK_ROUNDING = 1e-9  # of a period: stick intervals are that accurate, and more
# Samples that a quick fall seems to take at most, and that a fall takes which may be quick: a sine
# of four samples falls for two
QUICK, SLOWEST = 1.6, 3.0
# Of a swing from trough to peak, to each end, and share of time that is spent there: of a sine 0.2,
# of a force between two levels nearly half
NEAR, PLATEAU = 0.1, 0.35
# The same of a mass that swings on its spring and rests for less than half of its cycle: 0.16 and
# more; of a force that rises and falls evenly 0.1. Noise of less than this share of a drop
# does not change them much
STRAIGHT, QUIET = 0.13, 0.05
GROWN = 0.1  # of a force drop: less is not worth a word
NOISE_SHOWS = 1e-3  # of a force drop; what is less is not the noise of a load cell


class Shapes(NamedTuple):
    """The shapes of cycles."""

    # (n,), shares of each cycle: in which the force rises, in which the mass is known to rest or
    # creep, and in which it is known to stick
    rise: Floats
    still: Floats
    sticks: Floats
    resolution: float  # of the shares of rise: time between samples over period
    other: str  # kind of cycles as likely as `kind`, where they have few samples; else empty

    @property
    def typical(self) -> tuple[float, float, float]:
        """Medians of the three shares."""
        rise, still, sticks = (median(each) for each in self[:3])
        return rise, still, sticks

    @property
    def by_rise(self) -> str:
        """Kind by the share of rise alone."""
        return shape(self.typical[0])

    @property
    def by_speed(self) -> str:
        """Kind by the share of rise and by the slip speed."""
        return shape(*self.typical[:2])

    @property
    def kind(self) -> str:
        """Kind of the cycles."""
        return shape(*self.typical)

    @property
    def kinds(self) -> list[str]:
        """Kind of each cycle."""
        return shape_each(*self[:3])

    @property
    def chance(self) -> float:
        """Likelihood that one more cycle is of the kind, by the shares that decide."""
        if self.kind != self.by_speed:
            return _chance(self.sticks, TOUCHES, np.inf, STICK_ROUNDING)
        if self.by_speed != self.by_rise:
            return _chance(self.still, RESTING_SHARE, np.inf, self.resolution)
        return _chance(self.rise, *bounds(self.kind), self.resolution)


def by_parts(record: Record, found: Swings) -> Regime:
    """Classify cycles whose period may change: then each part has a kind of its own."""
    seen, parts = by_shape(record, found), parts_of(found.lasting["period"])
    if len(parts) < 2:
        return seen
    tables = [found.lasting.part(part) for part in parts]
    each = [by_shape(record, found._replace(table=table)) for table in tables]
    lasts = [float(table["period"].sum()) for table in tables]
    changed: dict[Evidence, float] = {"changed_at": float(tables[1]["start"][0])}
    main = each[int(np.argmax(lasts))]
    others = [
        (long, part) for long, part in zip(lasts, each, strict=True) if part.kind != main.kind
    ]
    if not others:
        sure = min(part.confidence for part in each)
        return Regime(main.kind, sure, seen.evidence | changed, main.runner_up)
    share = 1.0 - sum(long for long, _ in others) / sum(lasts)
    other = max(others, key=lambda pair: pair[0])[1].kind
    return Regime(main.kind, share * main.confidence, main.evidence | changed, other)


def by_shape(record: Record, found: Swings) -> Regime:
    """Classify cycles of one kind."""
    table, shapes = found.lasting, _shapes(record, found.lasting)
    evidence, own = _evidence(record, table, shapes), record.own_period
    if own is not None and couples(shapes.by_rise, table.mean("period"), own):
        return _transverse(table, shapes, own, evidence)
    if shapes.kind == UNDETERMINED and table.median("hesitations") >= 1.0:
        # two swings in one, or a ringing
        return Regime(UNDETERMINED, 0.0, {"cycles": len(table), "rise_share": shapes.typical[0]})
    evidence |= _sizes(found)
    return _no_vibration(record, found, shapes) or _weigh(record, table, shapes, evidence)


def _shapes(record: Record, table: CycleTable) -> Shapes:
    step, period = float(np.median(np.diff(record.time))), table.mean("period")
    rise, other = table["rise_share"], ""
    if record.slider is None and period < ENOUGH * step:
        share, as_well = _coarse_shares(table, step)
        rise = np.full(len(table), share)
        other = shape(as_well) if shape(as_well) != shape(share) else ""
    return Shapes(rise, _still(record, table), _sticking(record, table), step / period, other)


def _coarse_shares(table: CycleTable, step: float) -> tuple[float, float]:
    """Return the mean rise share in cycles of few samples, and an alternative value.

    A fall quicker than a sample is seen from the last sample before it to the first after it:
    one sample longer than it is, on average. A fall of some samples may be so or not.
    """
    period = table.mean("period")
    fall = float((table["trough_time"] - table["peak_time"]).mean())
    slow, quick = 1.0 - fall / period, 1.0 - max(fall - step, 0.0) / period
    if fall < QUICK * step:
        return quick, quick
    return slow, quick if fall < SLOWEST * step else slow


def _still(record: Record, table: CycleTable) -> Floats:
    """Return for which share of each cycle the mass is known to rest or creep."""
    if record.slip_speed is None or record.drive_velocity is None:
        return np.zeros(len(table))
    speed = record.slip_speed / record.drive_velocity
    ends = (table[name] for name in ("start", "peak_time", "period"))
    return still_shares(record.time, speed, *ends)


def _sticking(record: Record, table: CycleTable) -> Floats:
    """Return for which share of each cycle the mass is known to stick."""
    if record.sticks is None:
        return np.zeros(len(table))
    ends = (table[name] for name in ("start", "peak_time", "period"))
    return stick_shares(record.sticks, *ends)


def _evidence(record: Record, table: CycleTable, shapes: Shapes) -> dict[Evidence, float]:
    """Return the evidence from the shape of the cycles, and their likeness to each other."""
    count, (rise, still, sticks) = len(table), shapes.typical
    alike = shapes.kinds.count(shapes.kind) / count
    evidence: dict[Evidence, float] = {"cycles": count, "rise_share": rise}
    if shapes.kind == UNDETERMINED:
        evidence["backward"] = alike
    else:
        evidence["rest_share"] = float(rest_share(rise))
    if shapes.by_speed != shapes.by_rise:
        evidence["still_share"] = still
    if shapes.kind != shapes.by_speed:
        evidence["stick_share"] = sticks
    if count > 1:
        evidence["cycles_alike"] = alike
        evidence["period_spread"] = float(table["period"].std() / table["period"].mean())
    if shapes.kind == HARMONIC and count > 1:
        evidence["drop_spread"] = drop_spread(table["drop"])
    if (own := record.stated_period) is not None:
        evidence["natural_period"] = table.median("period") / own
    return evidence


def _transverse(
    table: CycleTable, shapes: Shapes, own: float, evidence: dict[Evidence, float]
) -> Regime:
    """Return the transverse oscillation, as sure as its periods are too short for the spring.

    The sign of a run's force is right, whatever the shape of its cycles.
    """
    quick = table["period"] / own
    evidence.pop("backward", None)
    alike = int((quick < COUPLED).sum())
    if len(quick) > 1:
        evidence |= {"cycles_alike": alike / len(quick)}
    sure = max((alike + 1) / (len(quick) + 3), _chance(quick, 0.0, COUPLED, shapes.resolution))
    other = "" if shapes.kind == UNDETERMINED else shapes.kind
    return Regime(TRANSVERSE, sure, evidence, other)


def _sizes(found: Swings) -> dict[Evidence, float]:
    """Return the findings on the sizes of the cycles: relative to the noise, and over time."""
    drop = found.lasting["drop"]
    evidence: dict[Evidence, float] = {}
    grown = float(drop[-1] / drop[0])
    if found.noise > NOISE_SHOWS * np.median(drop):
        evidence["drop_over_noise"] = float(np.median(drop)) / found.noise
    if len(drop) >= MANY and abs(order(drop)) >= -ORDERED and abs(grown - 1.0) > GROWN:
        evidence["last_over_first"] = grown
    if found.lines:
        evidence["line_taken_off"] = found.lines[0].frequency
    wave = regular_wave(found.lasting)
    if found.wave or wave is not None:
        evidence["wave"] = found.wave if wave is None else wave.height
    if wave is not None:
        evidence["wave_period"] = wave.period
    return evidence


def _no_vibration(record: Record, found: Swings, shapes: Shapes) -> Regime | None:
    """Return that nothing is determined if the shape is of neither vibration nor stick-slip."""
    if shapes.by_speed not in (TRANSITIONAL, HARMONIC) or _is_driven_evenly(record):
        return None
    stays, count = _near_ends(record, found.lasting), len(found.lasting)
    if min(stays) > PLATEAU:
        return Regime(UNDETERMINED, 0.0, {"cycles": count, "plateaus": 2.0 * min(stays)})
    clear = found.noise < QUIET * np.median(found.lasting["drop"])
    known = record.slip_speed is not None or shapes.by_speed != HARMONIC
    if not known and max(stays) < STRAIGHT and clear:
        return Regime(UNDETERMINED, 0.0, {"cycles": count, "straight": sum(stays)})
    return None


def _is_driven_evenly(record: Record) -> bool:
    """Return whether a record is that of a run under one drive and load."""
    slider = record.slider
    if slider is None or slider.modulation_frequencies:
        return False
    return bool(record.steady_until(float(record.time[0])) >= record.time[-1])


def _near_ends(record: Record, table: CycleTable) -> tuple[float, float]:
    """Return the shares of time for which a force stays near its troughs and near its peaks."""
    start, peak, end = (table[name] for name in ("start", "peak_time", "trough_time"))
    inside = (record.time >= start[0]) & (record.time <= end[-1])
    time, force = record.time[inside], record.force[inside]
    low = np.interp(time, [start[0], *end], [table["start_force"][0], *table["trough"]])
    high = np.interp(time, peak, table["peak"])
    place = (force - low) / np.maximum(high - low, TINY)
    return float(np.mean(place < NEAR)), float(np.mean(place > 1.0 - NEAR))


def _weigh(
    record: Record, table: CycleTable, shapes: Shapes, evidence: dict[Evidence, float]
) -> Regime:
    """Return the kind of the cycles with its confidence: from their number, and their scatter."""
    kinds, kind, count = shapes.kinds, shapes.kind, len(table)
    confidence = max((kinds.count(kind) + 1) / (count + 3), shapes.chance)
    if shapes.other:  # as likely
        return Regime(kind, 0.5 * confidence, evidence, shapes.other)
    irregular = 0.0
    if kind == HARMONIC:
        irregular = irregularity(table["period"], table["drop"])
    if irregular > LIKELY:
        if beat := beat_frequency(record.time, record.force):
            return Regime(kind, confidence, evidence | {"beat": beat})
        return Regime(IRREGULAR, irregular * confidence, evidence, HARMONIC)
    confidence *= 1.0 - irregular
    if irregular > 1.0 - kinds.count(kind) / count:
        return Regime(kind, confidence, evidence, IRREGULAR)
    others = sorted(set(kinds) - {kind, UNDETERMINED}, key=kinds.count)
    return Regime(kind, confidence, evidence, others[-1] if others else "")


def _chance(shares: Floats, low: float, high: float, resolution: float) -> float:
    """Return the likelihood that a share of one more cycle lies within bounds, if all have one.

    Student's distribution of the next of n values, about their median, whose standard deviation
    is seen with n - 1 degrees of freedom and is no less than the resolution.
    """
    from scipy.special import stdtr

    count = len(shares)
    if count < 2:
        return 0.0
    scale = np.hypot(shares.std(ddof=1), resolution) * sqrt(1.0 + 1.0 / count)
    below = stdtr(count - 1, (np.array([low, high]) - np.median(shares)) / scale)
    return float(below[1] - below[0])
