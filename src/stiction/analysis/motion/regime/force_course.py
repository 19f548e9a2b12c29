"""The kind of motion in a force without cycles, from its course."""

from __future__ import annotations

from math import inf

import numpy as np

from stiction.analysis.motion.changes.quick_falls import EVEN_CHANCE, quick_falls
from stiction.analysis.motion.changes.sliding import sliding
from stiction.analysis.motion.course import (
    BEGINS_UNLOADED,
    PER_QUARTER,
    Course,
    course,
    final_fall,
    lone_fall,
)
from stiction.analysis.motion.cycles import Swings
from stiction.analysis.motion.disturbance import RESIDUE
from stiction.analysis.motion.regime.band import (
    EIGHTHS,
    SUSPECTED,
    Hump,
    highest_hump,
    likelihood,
    remaining,
)
from stiction.analysis.motion.regime.evidence import Evidence, Regime
from stiction.analysis.motion.regime.kinds import (
    HARMONIC,
    IRREGULAR,
    SETTLING,
    STEADY,
    STICK_SLIP,
    STUCK,
    UNDETERMINED,
)
from stiction.analysis.motion.rest import stops_with_drive
from stiction.analysis.record import Record
from stiction.analysis.signals.digitised import resolution
from stiction.analysis.signals.even_grid import even_grid
from stiction.analysis.signals.hum import Line, beat_frequency, narrow_lines, of_mains
from stiction.analysis.signals.robust import MEANS_OF_RECORD, largest_magnitude, part_means
from stiction.analysis.signals.turning_points import CLEAR

ONE_WAY = 0.8  # of all ups and downs is change: a drift or a load, no wandering
SETTLED = 0.1  # of the force's span is passed in the last quarter; of an even load it is 0.25
STILL_STICKS = 0.5  # of the early rate, or of stiffness times drive velocity: it still sticks
FASTEST = 1.1  # times stiffness times drive velocity, as both are known: nothing is loaded faster
# Times the scatter about it, and share of the mean force: by more a force wanders that slides, or
# the mass sticks and slips more slowly than the record shows. Measured steady sliding: 3.7
SMOOTH, VARIES = 5.0, 0.05
LONE_FALL: tuple[Evidence, ...] = ("falls_at", "falls_by")
FINAL_FALL: tuple[Evidence, ...] = ("ends_falling_from", "ends_falling_by")
SLOW = 0.1  # of stiffness times drive velocity: the mass goes at 9/10 of the drive's speed or more
# Of the scatter about the course: swings that stand out in the spectrum may be stick-slip if they
# are as high, which is 3 % of the variance
HIDDEN = 0.5
# The clearness of a line at which stick-slip is as likely as noise, of which 1 in 200 records has
# more than 0.48, and one of 1800 more than 0.61. It is sought from there on
EVEN_LINE, FAINT_LINE = 0.6, 0.3
# A median fall over the standard deviation of the force: 3.5 for a sawtooth, 2.3 and more for falls
# that differ by half; 0.8 to 1.9 in parts of measured sliding with slips, which are not all of it
MAKES_UP = 2.1
# Of the power of a hump: a line of so much is one vibration, in noise. In fewer periods an
# irregular vibration has such a line, too
LINE_SHARE, MANY_PERIODS = 0.5, 100.0
RIPPLE = 1e-3  # of the force's span: a vibration that is less is not a motion of its own


def by_course(record: Record, found: Swings) -> Regime:
    """Return the kind of motion without cycles: settling, steady, stuck or vibrating."""
    seen = _without_slips(record, found)
    may_slip = seen.kind in (IRREGULAR, SETTLING, STEADY, UNDETERMINED)
    return _unless_it_slips(record, seen) if may_slip and record.slip_speed is None else seen


def _without_slips(record: Record, found: Swings) -> Regime:
    """Return the kind of motion, were there no slips that noise hides."""
    way = course(record.time, record.force)
    drive = record.loading_rate
    evidence: dict[Evidence, float] = {"change": way.change, "span": way.span}
    evidence["scatter"] = way.scatter
    if found.lines:
        evidence["line_taken_off"] = found.lines[0].frequency
    if drive:
        evidence["rate_over_drive"] = way.late_rate / drive
    late = min(max(way.late_span, _toggles(record)) / way.span, 1.0) if way.span > 0.0 else 1.0
    rising = _rises(way) and (record.load is None or _rises(_under_one_load(record)))
    slides = not rising or 0.0 < max(abs(way.early_rate), abs(way.late_rate)) < SLOW * drive
    end = float(record.time[-1])
    if record.slider and stops_with_drive(record.slider.motion, end, record.slip_speed):
        return Regime(SETTLING, 1.0, evidence | {"stops": end})
    if late > SETTLED and found.turns:
        return Regime(UNDETERMINED, 0.0, evidence | {"turns": found.turns})
    # a transient ends, and a load goes on, in the later half; what vibrates then does not end
    begin = 0 if late > SETTLED and slides else len(record) // 2
    hump = highest_hump(record.time[begin:], record.force[begin:])
    least = max([RIPPLE * way.span, *(RESIDUE * line.height for line in found.lines)])
    vibrates = hump.likelihood if hump.rms > least else 0.0
    if vibrates > 0.5:
        return _vibration(record, hump, begin, least, evidence)
    if late <= SETTLED:
        sure = (1.0 - late / (2.0 * SETTLED)) * (1.0 - vibrates)
        settles = Regime(SETTLING, sure, evidence | {"late_share": late})
        return _unless_hidden(record, begin, least, settles)
    if slides:
        # the nearer to cycles it came, the less sure it is that there are none
        sure = (1.0 - 0.5 * found.clearness / CLEAR) * (1.0 - vibrates)
        few = highest_hump(record.time, record.force, SUSPECTED)
        vibrates = few.likelihood if few.rms > least else 0.0
        if vibrates > 0.5:
            return Regime(UNDETERMINED, 0.0, evidence | {"few_periods": few.frequency})
        return _steady(record, found, least, sure * (1.0 - vibrates), evidence)
    if fall := final_fall(record.time, record.force):
        return Regime(UNDETERMINED, 0.0, evidence | dict(zip(FINAL_FALL, fall, strict=True)))
    return _loading(record, way, drive, 1.0 - vibrates, evidence)


def _rises(way: Course) -> bool:
    return way.change > 0.0 and way.one_way >= ONE_WAY


def _under_one_load(record: Record) -> Course:
    """Return the course of a force over its load: friction grows with the load, a spring does not.

    Where the load lifts off, the force is as it is.
    """
    load = record.relative_load()
    return course(record.time, record.force / np.where(np.isfinite(load), load, 1.0))


def _vibration(
    record: Record, hump: Hump, begin: int, least: float, evidence: dict[Evidence, float]
) -> Regime:
    """Return the kind of a force that vibrates without cycles, or whose vibration fades.

    `begin` and `least` are those of a hidden line, see `_hidden_line`.
    """
    left = remaining(record.time, record.force, hump.frequency)
    if left < 1.0:
        sure = (EIGHTHS + 1) / (EIGHTHS + 3)
        return Regime(SETTLING, sure, evidence | {"fading": hump.frequency, "fades_to": left})
    evidence |= {"hump": hump.frequency, "hump_height": hump.height}
    if beat := beat_frequency(record.time, record.force):
        return Regime(HARMONIC, hump.likelihood, evidence | {"beat": beat}, STEADY)
    line = _hidden_line(record, begin, least)
    if line is not None and _is_whole(line, hump, record):
        return Regime(UNDETERMINED, 0.0, evidence | _as_evidence(line))
    return Regime(IRREGULAR, hump.likelihood, evidence, STEADY)


def _loading(
    record: Record, way: Course, drive: float, sure: float, evidence: dict[Evidence, float]
) -> Regime:
    """Return that the mass is stuck if the force goes on rising as fast as a spring is loaded.

    `drive` is stiffness times drive velocity, N/s, or 0; `sure` how likely nothing vibrates.
    """
    kept = way.late_rate / way.early_rate if way.early_rate else inf
    evidence |= {"one_way": way.one_way, "rate_kept": kept}
    loading = way.late_rate / drive if drive else kept
    if loading < STILL_STICKS:
        return Regime(UNDETERMINED, 0.0, evidence)
    sure = way.one_way * min(loading, 1.0) * sure
    explained = drive and loading < FASTEST
    if not explained and abs(record.force[0]) > BEGINS_UNLOADED * largest_magnitude(record.force):
        return Regime(STUCK, 0.5 * sure, evidence, STEADY)  # as likely, it drifts
    return Regime(STUCK, sure, evidence)


def _toggles(record: Record) -> float:
    """Return the step of the readings between which a force goes back and forth at the end, N.

    Its medians there may be alike, though it changes by less than a step.
    """
    end = record.force[-(len(record) // 4) :]
    return resolution(record.force) if np.ptp(end) > 0.0 else 0.0


def _steady(
    record: Record, found: Swings, ripple: float, sure: float, evidence: dict[Evidence, float]
) -> Regime:
    """Return steady sliding, or as likely stick-slip whose cycles are longer than the record.

    Nothing is determined if swings stand out in the spectrum that noise hides.
    """
    if record.slip_speed is not None:
        return Regime(STEADY, sure, evidence)
    wanders = max(SMOOTH * evidence["scatter"], VARIES * abs(float(np.mean(found.force))))
    if evidence["span"] > wanders:
        slow = abs(evidence.get("rate_over_drive", inf)) < SLOW
        if not slow and _loads_on(record, evidence["span"]):
            return Regime(UNDETERMINED, 0.0, evidence | {"loads_on": evidence["span"]})
        return Regime(STEADY, 0.5 * sure, evidence | {"wanders": evidence["span"]}, STICK_SLIP)
    fall = lone_fall(record.time, found.force)
    steady = Regime(STEADY, sure, evidence | dict(zip(LONE_FALL, fall or (), strict=False)))
    return _unless_hidden(record, 0, ripple, steady)


def _loads_on(record: Record, span: float) -> bool:
    """Return whether a force that begins unloaded has settled nowhere.

    So it is in a record of one slip, or of a part of a cycle: the mass may stick for most of it.
    """
    means = part_means(record.force, MEANS_OF_RECORD)
    if abs(means[0]) > BEGINS_UNLOADED * largest_magnitude(means):
        return False
    slides = sliding(record)
    later = record.force[slides.half : slides.last]
    return bool(np.ptp(part_means(later, PER_QUARTER)) > SETTLED * span)


def _unless_hidden(record: Record, begin: int, least: float, seen: Regime) -> Regime:
    """Return a kind of motion, less sure if swings stand out in the spectrum from a sample on.

    Nothing is determined if they are so high that they may be what the mass does.
    """
    line = None if record.slip_speed is not None else _hidden_line(record, begin, least, FAINT_LINE)
    if line is None:
        return seen
    height = line.height / course(record.time[begin:], record.force[begin:]).scatter
    chance = likelihood(line.clearness / EVEN_LINE) * (1.0 if height > HIDDEN else height)
    evidence = seen.evidence | (_as_evidence(line) if line.clearness > EVEN_LINE else {})
    if chance > 0.5:
        return Regime(UNDETERMINED, 0.0, evidence)
    return Regime(seen.kind, seen.confidence * (1.0 - chance), evidence, seen.runner_up)


def _unless_it_slips(record: Record, seen: Regime) -> Regime:
    """Return a kind of motion, less sure if the force falls quickly, and does not rise so.

    That is, if such falls would be most of what it does: then the mass slips, and noise hides its
    cycles. Fewer, or smaller ones, are evidence beside the kind.
    """
    falls = quick_falls(record.time, record.force)
    chance = likelihood(falls.clearness / EVEN_CHANCE)
    if chance > 0.5:
        its: dict[Evidence, float] = {"quick_falls": falls.number, "quick_fall": falls.height}
        seen = seen._replace(evidence=seen.evidence | its)
    if not falls.times > MAKES_UP:
        return seen
    if chance > 0.5:
        return Regime(UNDETERMINED, 0.0, seen.evidence, STICK_SLIP)
    return seen._replace(confidence=seen.confidence * (1.0 - chance))


def _hidden_line(record: Record, begin: int, least: float, clearness: float = 1.0) -> Line | None:
    """Return the lasting line most alone in a force from a sample on, other than the mains'.

    Its root mean square is at least `least` (N), and how clear it is at least `clearness`.
    """
    time, force = record.time[begin:], record.force[begin:]
    for line in narrow_lines(even_grid(time), force, clearness):
        lasts = not of_mains(line.frequency) and line.height > 8.0**0.5 * least
        if lasts and remaining(time, line.values, line.frequency) == 1.0:
            return line
    return None


def _is_whole(line: Line, hump: Hump, record: Record) -> bool:
    """Return whether a line is the whole vibration of a hump, in a record that can show it."""
    known = line.frequency * record.duration > MANY_PERIODS
    return known and line.height**2 > LINE_SHARE * 8.0 * hump.rms**2


def _as_evidence(line: Line) -> dict[Evidence, float]:
    return {"hidden": line.frequency, "hidden_height": line.height}
