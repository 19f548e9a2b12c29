"""Whether a narrow line in a force is a disturbance, such as mains hum, or the motion itself."""

from __future__ import annotations

import numpy as np

from stiction.analysis.motion.course import BEGINS_UNLOADED
from stiction.analysis.motion.cycle_columns import CycleTable
from stiction.analysis.motion.rest import STICKING, rest_share
from stiction.analysis.motion.vibration import COUPLED, OWN_PERIODS, is_irregular
from stiction.analysis.record import Record
from stiction.analysis.signals.digitised import fall_by_rounding
from stiction.analysis.signals.even_grid import EvenGrid
from stiction.analysis.signals.hum import Line, of_mains
from stiction.analysis.signals.robust import (
    MEANS_OF_RECORD,
    inner_product,
    part_means,
    part_starts,
    uniform_mean,
)
from stiction.analysis.signals.turning_points import turning_points
from stiction.arrays import Floats

# A line beside the motion: swings without it have so many of its periods, and are as high or stick
SLOWER, HIGHER = 2.0, 0.75
# Median cosine of the line's phase from one swing to the next, where it returns to within 11 deg:
# slips twice as long as a line's period, but irregular by 5 %, come to 0.95
WHOLE = 0.98
# Cycles on a slow wave: by so much, and by so many, more than without regard to it; share of them
# that the line's period gives; how far regular ones lie from it; and how much larger the wave's
# own swings are at most if these stick, too
MORE, AND_MORE, NEARLY_ALL, NEAR, NO_LARGER = 1.01, 1, 0.8, 0.2, 1.5
MEANS = 24  # of each period, in which such cycles are first sought
LOADED = 0.5  # of its rise: until then the mass goes at half the drive's speed or less
SLIDES = 0.5  # of the rate of loading: afterwards the force rises more slowly, if at all
PERIODS = 5.0  # of the line while the spring is loaded, and afterwards
ELSEWHERE = 3.0  # times as large as beside the swings
SOME = 0.1  # of all falls are by rounding: from there on others do not count
RESIDUE = 0.05  # of a line's height: so much of it may be left where it was subtracted
AS_LARGE = 0.6  # the smaller amplitude over the larger one, while it is loaded and afterwards


def is_beside(line: Line, table: CycleTable, record: Record) -> bool:
    """Return whether a line is a disturbance of the motion, by the swings without it.

    Then they are slower and larger; or they stick, at any size of the line, because a sticking mass
    does not vibrate. Larger swings that do not stick are a motion beside the line if they are
    regular, as friction that wanders is not, and the line is not the mass's own on its spring. A
    line of the mains needs neither.
    """
    period, drop, rise = (table[name] for name in ("period", "drop", "rise_share"))
    motion = (drop > HIGHER * line.height) | (rest_share(rise) >= STICKING)
    aside = (period * line.frequency > SLOWER) & motion
    if len(aside) < 2 or np.median(aside) < 1.0 or _is_elsewhere(line, table, record):
        return False
    if of_mains(line.frequency) or is_stick_slip(table):
        return True
    return not _is_own(line, record) and not is_irregular(period, drop)


def is_larger(line: Line, slips: CycleTable) -> bool:
    """Return whether all of a few slips without a line are so much larger that it is beside them.

    A mass that is loaded evenly before and after them sticks, and does not vibrate.
    """
    return len(slips) > 0 and bool(slips["drop"].min() > HIGHER * line.height)


def _is_elsewhere(line: Line, table: CycleTable, record: Record) -> bool:
    """Return whether a line is much larger where the swings without it have not begun, or ended.

    Then it is the motion in that part, as after a step of the velocity.
    """
    first, last = np.searchsorted(record.time, [table["start"][0], table["trough_time"][-1]])
    during, other = line.values[first:last], np.delete(line.values, np.s_[first:last])
    least = PERIODS / line.frequency / record.duration * len(record)
    if len(other) < least or len(during) < least:
        return False
    return float(np.std(other)) > ELSEWHERE * float(np.std(during))


def _is_own(line: Line, record: Record) -> bool:
    """Return whether a line is as quick as the mass on its spring, where both are stated."""
    own = record.stated_period
    return own is not None and COUPLED <= 1.0 / (line.frequency * own) <= OWN_PERIODS


def is_subharmonic(line: Line, table: CycleTable) -> bool:
    """Return whether swings are a subharmonic of the line.

    If every second slip is larger, the rest without the line has twice the line's period, or
    another whole multiple of it. Independent swings have no such period.
    """
    period, drop = table["period"], table["drop"]
    whole = float(np.median(np.cos(2.0 * np.pi * line.frequency * period)))
    return whole > WHOLE and float(np.median(drop)) < line.height


def slow_wave(grid: EvenGrid, force: Floats, frequency: float) -> Floats:
    """Return the part of a force (N) slower than `frequency` (Hz).

    It is at the times of the force, which have a grid: the means over a period, and the means of
    the remainder. A wave of five periods is whole to 0.4 %, and nothing is left of a motion with
    that frequency.
    """
    length = max(round(1.0 / (frequency * grid.step)), 1)
    even = grid.on(force)
    slow = _means_over(even, length)
    slow += _means_over(even - slow, length)
    return grid.between(slow)


def _means_over(force: Floats, length: int) -> Floats:
    """Return the means of a force over `length` samples about each, as if it went on at its ends.

    There its first and last period are repeated, with the drift from one to the next.
    """
    first, second = force[:length], force[length : 2 * length]
    last, before = force[-length:], force[-2 * length : -length]
    early, late = second.mean() - first.mean(), last.mean() - before.mean()
    longer = np.concatenate([first - early, force, last + late])
    return uniform_mean(longer, length)[length:-length]


def may_be_carried(frequency: float, duration: float, left: Floats, seen: CycleTable) -> bool:
    """Return whether a force has about as many swings as periods, which are more than are `seen`.

    The force (N) is what is left without a slow wave. Few means of each period tell, quickly.
    """
    number = frequency * duration
    if of_mains(frequency) or number < MORE * len(seen) + AND_MORE:
        return False
    means = part_means(left, int(MEANS * number))
    return len(turning_points(means).index) > 2 * NEARLY_ALL * number


def is_carried(frequency: float, duration: float, seen: CycleTable, left: CycleTable) -> bool:
    """Return whether the swings that are left without a slow wave are stick-slip which it carries.

    They are nearly as many as the periods that are sought, and stick; and they are more than the
    swings `seen` beside the wave, which are no larger stick-slip themselves. If these stick, only
    cycles among them count: before, while the spring is first loaded, the bends of a wave look like
    some.
    """
    enough = len(left) > NEARLY_ALL * frequency * duration
    if not enough or not is_stick_slip(left):
        return False
    among = left["peak_time"]
    if is_stick_slip(seen):
        among = among[(among > seen["start"][0]) & (among < seen["trough_time"][-1])]
    if len(among) <= MORE * len(seen) + AND_MORE:
        return False
    larger = seen.median("drop") > NO_LARGER * left.median("drop")
    return not (is_stick_slip(seen) and larger)


def have_period(table: CycleTable, period: float) -> bool:
    """Return whether nearly all cycles have about that period, s."""
    return bool(np.mean(np.abs(table["period"] / period - 1.0) < NEAR) > NEARLY_ALL)


def is_stick_slip(table: CycleTable) -> bool:
    """Return whether swings are stick-slip, by their typical shape."""
    shares = table["rise_share"]
    return len(shares) > 0 and bool(rest_share(np.median(shares)) >= STICKING)


def is_residue(line: Line, table: CycleTable) -> bool:
    """Return whether swings are no larger than the possible residue of a subtracted line."""
    drop = table["drop"]
    return len(drop) > 0 and float(np.median(drop)) < RESIDUE * line.height


def is_rounding(table: CycleTable, force: Floats) -> bool:
    """Return whether swings, or some, are no larger than the steps of a digitised force (N).

    A force that changes evenly is a staircase. Without a slow wave, or a line of the staircase
    itself, it is a sawtooth in which each fall is one step, beside the even change. Beside slips of
    few steps there are as many such falls as slow loadings.
    """
    drift = (table["trough"] - table["start_force"]) / table["period"]
    falls = table["drop"] + drift * (table["trough_time"] - table["peak_time"])
    return len(table) > 0 and bool(np.quantile(falls, SOME) < fall_by_rounding(force))


def lasts_through_loading(line: Line, time: Floats, force: Floats) -> bool:
    """Return whether a line is as large while the spring is first loaded as it is afterwards.

    Then it is a disturbance: a mass that sticks does not vibrate. The line is in the force.
    """
    loaded = _end_of_loading(time, force - line.values, line.height)
    if loaded is None:
        return False
    length = line.frequency * (time[-1] - time[0])
    enough = PERIODS / length * len(time)
    if not enough <= loaded <= len(time) - enough:
        return False
    quick = force - uniform_mean(force, round(len(time) / length))
    before, after = (_amplitude(quick[part], line.values[part]) for part in _split(loaded))
    return min(before, after) >= AS_LARGE * max(before, after)


def _split(at: int) -> tuple[slice, slice]:
    return slice(0, at), slice(at, None)


def _amplitude(force: Floats, line: Floats) -> float:
    """Return the root mean square of a line as far as a force has it."""
    size = inner_product(line, line)
    return abs(inner_product(force, line)) / (size * len(line)) ** 0.5 if size > 0.0 else 0.0


def _end_of_loading(time: Floats, force: Floats, least: float) -> int | None:
    """Return up to which sample the spring of a record is loaded; None if there is no loading.

    The force begins near zero, rises by more than `least` (N), and then stays, or rises more slowly
    by half.
    """
    means, times = (part_means(each, MEANS_OF_RECORD) for each in (force, time))
    means = means if means.max() >= -means.min() else -means
    rise = means - means[0]
    if means[0] > BEGINS_UNLOADED * means.max() or not rise.max() > least:
        return None
    at = int(np.argmax(rise > LOADED * rise.max()))
    if at == 0 or at == len(means) - 1 or rise[at:].min() < 0.5 * rise[at]:
        return None
    rate, later = rise[at] / (times[at] - times[0]), rise[-1] - rise[at]
    slides = later < SLIDES * rate * (times[-1] - times[at])
    return int(part_starts(len(force), MEANS_OF_RECORD)[at]) if slides else None
