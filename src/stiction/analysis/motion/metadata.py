"""What a record says by itself, beside what is stated of its apparatus."""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot, inf, isfinite, nan, pi
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from stiction.analysis.motion.changes.cycles import parts_of, steady_change
from stiction.analysis.motion.cycle_columns import CycleTable
from stiction.analysis.motion.drift import Drift
from stiction.analysis.motion.loading import rounding_of_rates
from stiction.analysis.motion.regime.kinds import HARMONIC, STICK_SLIP, TRANSITIONAL
from stiction.analysis.record import Record
from stiction.analysis.signals.clipping import FlatEnd
from stiction.analysis.signals.correlated_noise import (
    ERRORS_95,
    ERRORS_997,
    correlation_time,
    error_of_few,
    standard_error,
)
from stiction.analysis.signals.digitised import resolution
from stiction.analysis.signals.robust import largest_magnitude, trimmed_mean
from stiction.analysis.signals.straight_line import line
from stiction.arrays import TINY, Floats
from stiction.recording.noise import white_noise
from stiction.text.units import in_words

FASTER, SLOWER = 1.1, 0.5  # rate of loading over stiffness times drive velocity
LIGHTER, HEAVIER = 1.4, 0.7  # k/m by the swing over that stated; a slip is slower than a swing
# of k/m as stated: friction that weakens slowly makes a slip last so long in 2 of 100 random rigs,
# and a low-pass filter, of up to 1.2 times the frequency of a swing, in most
SLOW_SLIP = 0.4
# Relative error of the period of a swing: friction that varies in it, and the spring across, make
# k/m 0.77 to 1.32 times the true one in 9 of 10 random rigs that vibrate so
SWINGS = 0.08
FEWEST_SWINGS = 3  # of a vibration
# Quartiles of the durations of slips that noise hides nothing of: their ratio where mass and
# stiffness do not shape them
UNLIKE = 1.5
DRAWN_OUT = 0.4  # of a fall: two thirds of what half a cosine takes from 90 % to 10 %
MOST_HIDDEN = 0.25  # of a fall's height at each end, within noise
REACH = 3.0  # standard deviations of noise: a force that is nearer to a peak may be on it
RESTED = 1.1  # times two falls: rest makes a period longer; less may be another asymmetry
PARTS = 200, 66, 25  # of a record, for the speed of a drive that may turn, or rest within noise
TO_AND_FRO = 0.8  # of its reach: a drive that comes less far on the whole turns
HELD = 0.01  # of a drive's largest speed: in parts that are slower it rests
NOISE = 20.0  # standard deviations, by which means of the displacement do not differ
FEWEST_PER_FALL = 6  # samples: the duration of a fall, or a slope, is not known by fewer
ALIKE = 0.1  # relative: a mean that was measured agrees so far with its stated value
STARTS = 3.0  # times what noise alone may move by: a drive that rests between its motions
SEEN = 0.4  # of the sample rate: a faster oscillation is lost, or seen at another frequency
AT_REST, ROUNDING = 0.02, 1e-12  # of the largest force: a reading at rest, and one of zero
OF_MEDIAN = 1.22  # standard error of a median, over that of the mean without a tenth at each end
LOADING_RATE, SWING = "stiffness times drive velocity", "stiffness over mass"  # quantities
BY_RISE, BY_SLIPS = "rate at which the force rises", "duration of its slips"
BOUNDS = (BY_RISE, BY_SLIPS)  # creep slows a rise; friction that weakens, or a filter, a slip


class StatedQuantity(NamedTuple):
    """A quantity as the record shows it, with its standard error, and as it is stated.

    NaN where it is not known. The error is that of the scatter, and for the duration of slips of
    what samples and noise hide. The true value may be above what rises and slips show by more than
    that: they give a lower bound. `low` and `high` bound the ratio of both where they agree. Where
    the cycles change once, it is
    of some of them, a `part` of the record in words: those that start from `begin` on and before
    `end`, s.
    """

    quantity: str
    unit: str
    found: float
    error: float
    stated: float
    low: float
    high: float
    how: str
    part: str = ""
    begin: float = -inf
    end: float = inf

    @property
    def name(self) -> str:
        """The quantity, and the part of the record."""
        return f"{self.quantity} {self.part}" if self.part else self.quantity

    @property
    def ratio(self) -> float:
        """Found over stated."""
        return self.found / self.stated if self.stated else nan

    @property
    def at_least(self) -> float:
        """The lower bound, two standard errors below what was found; NaN if it is none."""
        return self.found - ERRORS_95 * self.error if self.how in BOUNDS else nan

    @property
    def agrees(self) -> bool | None:
        """Whether both agree; None if one is not known."""
        return self.low <= self.ratio <= self.high if isfinite(self.ratio) else None

    @property
    def is_same(self) -> bool:
        """Whether the value found is the stated one, not only one that it allows."""
        apart = abs(self.found - self.stated)
        return bool(apart <= max(ALIKE * abs(self.stated), ERRORS_997 * self.error))


def compare_metadata(
    record: Record,
    kind: str,
    cycles: CycleTable,
    drift: Drift | None,
    ends: Sequence[FlatEnd],
) -> tuple[StatedQuantity, ...]:
    """Return all that a record shows of its apparatus, beside what is stated.

    Parameters
    ----------
    record : Record
        With what is stated.
    kind : str
        The kind of motion.
    cycles : CycleTable
        The cycles of the record.
    drift : Drift or None
        Of the force, if it shows one.
    ends : sequence of FlatEnd
        At which the force is cut off: there a fall seems to begin too early.
    """
    found = (
        None if ends else _stiffness_over_mass(record, kind, cycles),
        *_loading_rates(record, kind, cycles, drift),
        _drive_velocity(record),
        _normal_load(record),
        _transverse_frequency(record),
        _zero(record),
        _drift(cycles, drift),
    )
    return tuple(each for each in found if each is not None)


def _loading_rates(
    record: Record, kind: str, cycles: CycleTable, drift: Drift | None
) -> list[StatedQuantity]:
    """Compare the rate of loading while the mass sticks with stiffness times drive velocity.

    Where the cycles change, as after a step of the velocity, each part has its own rate. If one of
    them is as stated, nothing is stated of the others. Nor is anything where the rate goes on
    changing and passes the stated one, or a part of it that creep may leave.
    """
    if kind not in (STICK_SLIP, TRANSITIONAL):
        return []
    slopes, starts = cycles["stick_slope"], cycles["start"]
    stated = record.loading_rate or nan
    # a drift of the load cell seems to load the spring; one of friction does not
    off = abs(_rate_of_troughs(cycles) if drift is None else drift.rate)
    alike = rounding_of_rates(
        record.force, float(np.median(cycles["peak"] - cycles["start_force"]))
    )
    whole = _loading_rate(slopes, stated, off, alike)
    places = parts_of(cycles["period"])
    if len(places) < 2:
        if steady_change(slopes) is None:
            return [whole]
        low, high = np.sort(line(starts, slopes).at(record.time[[0, -1]]))
        passes = SLOWER * stated < high and low < FASTER * stated
        return [whole._replace(stated=nan) if passes else whole]
    at = [-inf, *(float(starts[place.start]) for place in places[1:]), inf]
    parts = []
    for place, begin, end in zip(places, at[:-1], at[1:], strict=True):
        its = _loading_rate(slopes[place], stated, off, alike)
        parts.append(its._replace(part=_part_in_words(begin, end), begin=begin, end=end))
    agree = [each for each in parts if each.is_same] or [x for x in parts if x.agrees]
    if not agree:
        return parts
    return [each if each in agree else each._replace(stated=nan) for each in parts]


def _part_in_words(begin: float, end: float) -> str:
    """Return a part of a record in words."""
    if begin == -inf:
        return f"until {in_words(end, 's')}"
    if end == inf:
        return f"from {in_words(begin, 's')} on"
    return f"from {in_words(begin, 's')} to {in_words(end, 's')}"


def _rate_of_troughs(cycles: CycleTable) -> float:
    """Return the rate at which the troughs of a few cycles change, N/s: too few to tell a drift."""
    at, force = (
        np.append(cycles[first], cycles[last][-1:])
        for first, last in (("start", "trough_time"), ("start_force", "trough"))
    )
    return line(at, force).slope


def _loading_rate(slopes: Floats, stated: float, off: float, alike: float) -> StatedQuantity:
    """Return the median rate of loading of some cycles.

    Its errors are that of the scatter, one of `off` (N/s), and a relative one that all have
    `alike`. It contradicts the stated one where it does so by more than two of them.
    """
    found = float(np.median(slopes))
    off = hypot(off, alike * found)
    error = hypot(_median_error(slopes), off)
    # a single cycle tells no error, but by how much drift and steps may change it
    within = ERRORS_95 * (error if isfinite(error) else off) / stated
    low, high = SLOWER - within, FASTER + within
    return StatedQuantity(LOADING_RATE, "N/s", found, error, stated, low, high, BY_RISE)


def other_velocity(stated: Sequence[StatedQuantity], cycles: CycleTable) -> NDArray[np.bool_]:
    """Return which cycles are loaded at another rate than the stated one.

    None are, if no cycles are loaded at the stated rate. All are, if the rate goes on changing.
    """
    rates, start = [each for each in stated if each.quantity == LOADING_RATE], cycles["start"]
    found = np.zeros(len(start), bool)
    if len(rates) == 1:
        changes = steady_change(cycles["stick_slope"]) is not None
        return found | (changes and rates[0].agrees is None)
    if any(each.agrees for each in rates):
        for each in rates:
            if not each.agrees:
                found |= (start >= each.begin) & (start < each.end)
    return found


def _stiffness_over_mass(record: Record, kind: str, cycles: CycleTable) -> StatedQuantity | None:
    """Compare k/m by the period of a swing, or the duration of a slip, with that stated.

    A mass on its spring swings with the period T = 2 pi (m/k)^1/2. One that rests in each cycle has
    a longer period, but its force falls for T/2 (`stiction.analysis.motion.rest.rest_share`). A
    slip under constant friction takes T/2 too, and one under friction that weakens takes longer. A
    slip whose fall begins or ends far more slowly, as under rate-and-state friction or in a
    dashpot, does not last as mass and stiffness have it. Nor does a fall in which the force
    hesitates, and under much noise nothing shows when a slip begins and ends. Slips against
    constant friction last equally long, however far they go: where they do not, friction or the
    drive shapes them. One swing has no shape that tells a vibration from friction that changes.
    """
    if not len(cycles) or kind not in (HARMONIC, STICK_SLIP, TRANSITIONAL):
        return None
    plain = cycles["hesitations"] == 0.0
    if not np.median(plain):
        return None
    cycles = cycles.part(plain)
    falls = cycles["trough_time"] - cycles["peak_time"]
    if float(np.median(falls)) * record.sample_rate < FEWEST_PER_FALL:
        return None
    if kind == HARMONIC:
        return _by_swings(record, cycles, falls) if len(cycles) >= FEWEST_SWINGS else None
    reach = REACH * white_noise(record.force) + resolution(record.force)
    hidden = reach > MOST_HIDDEN * cycles.median("drop")
    if _main_part(record, cycles) < DRAWN_OUT or hidden:
        return None
    longer, shorter = _unseen_ends(reach, cycles)
    few, many = np.quantile(falls, (0.25, 0.75))
    if many > UNLIKE * longer * few:
        return None
    swings = 2.0 * falls
    unseen = max(longer - 1.0, 1.0 - shorter)
    sample = 2.0 / (record.sample_rate * float(np.median(swings)))
    off = 0.5 * float(np.hypot(unseen, sample))
    low, high = SLOW_SLIP * shorter**2, LIGHTER * longer**2
    return _over_mass(record, swings, off, (low, high), BY_SLIPS)


def _by_swings(record: Record, cycles: CycleTable, falls: Floats) -> StatedQuantity:
    """Compare k/m by the period of a vibration, which may rest in each swing."""
    periods = cycles["period"]
    rests = float(np.median(periods)) > RESTED * 2.0 * float(np.median(falls))
    how = f"period of its swings{' less the rest' if rests else ''}"
    swings = 2.0 * falls if rests else periods
    return _over_mass(record, swings, SWINGS, (HEAVIER, LIGHTER), how)


def _over_mass(
    record: Record, swings: Floats, off: float, bounds: tuple[float, float], how: str
) -> StatedQuantity:
    """Compare k/m by some periods (s), that may all be `off` by a share of them.

    `bounds` are those of the ratio to that stated, which the scatter of the periods widens.
    """
    swing = float(np.median(swings))
    found = (2.0 * pi / swing) ** 2
    stated = (record.stiffness or nan) / (record.mass or nan)
    scatter = _median_error(swings) / swing if len(swings) > 1 else 0.0
    error = 2.0 * found * float(np.hypot(scatter, off))
    within = ERRORS_95 * 2.0 * found * scatter / stated
    low, high = bounds[0] - within, bounds[1] + within
    return StatedQuantity(SWING, "1/s²", found, error, stated, low, high, how)


def _main_part(record: Record, cycles: CycleTable) -> float:
    """Return for which share of its time a fall is from 90 % of its height to 10 %.

    Half a cosine is so for 59 %.
    """
    shares = []
    for begin, end in zip(cycles["peak_time"], cycles["trough_time"], strict=True):
        first, last = np.searchsorted(record.time, [begin, end])
        force = record.force[first : last + 1]
        if len(force) < 2:
            continue
        top, bottom = (float(force.max()), float(force.min()))
        edge = 0.1 * (top - bottom)
        leaves = np.flatnonzero(force >= top - edge)[-1]
        comes = np.flatnonzero(force <= bottom + edge)[0]
        shares.append((comes - leaves) / (len(force) - 1))
    return float(np.median(shares)) if shares else nan


def _unseen_ends(reach: float, cycles: CycleTable) -> tuple[float, float]:
    """Return by which factors slips may last longer, or shorter, than their falls are seen to.

    A force within `reach` (N) of a peak or a trough, by noise or a step of its converter, may have
    left it. Half a cosine begins and ends so, and the spring is loaded as slowly before and after
    it.
    """
    share, falls = reach / cycles.median("drop"), cycles["trough_time"] - cycles["peak_time"]
    hidden = 2.0 * float(np.arccos(1.0 - 2.0 * share)) / pi  # of a slip, at both ends
    rate = max(float(np.median(cycles["stick_slope"])), TINY)
    return 1.0 / (1.0 - hidden), max(1.0 - reach / rate / float(np.median(falls)), 0.0)


def _median_error(values: Floats) -> float:
    """Return the standard error of the median of some values."""
    return error_of_few(OF_MEDIAN * trimmed_mean(values).error, len(values) - 1.0)


def _drive_velocity(record: Record) -> StatedQuantity | None:
    """Compare the slope of the drive's displacement with the stated velocity."""
    if record.drive_position is None or len(record) < FEWEST_PER_FALL:
        return None
    way, stated = line(record.time, record.drive_position), record.drive_velocity or nan
    error = standard_error(way.deviations(record.time, record.drive_position))
    whole = StatedQuantity(
        "drive velocity", "m/s", abs(way.slope), error / float(record.time.std()), stated,
        1 - ALIKE, 1 + ALIKE, "slope of the drive's displacement",
    )  # fmt: skip
    if whole.agrees:  # a drive that jerks, or rings, rests and turns as well
        return whole
    divided = [_speeds_of_parts(record.time, record.drive_position, most) for most in PARTS]
    speeds, net, reach, rests = next((each for each in divided if each[-1]), divided[0])
    turns = net < TO_AND_FRO * reach
    if not rests and not turns and whole.found * record.duration >= TO_AND_FRO * reach:
        return whole
    how = f"median speed of its displacement{', to and fro' if turns else ' in motion'}"
    error = float(speeds.std()) / len(speeds) ** 0.5
    return whole._replace(found=float(np.median(speeds)), error=error, how=how)


def _speeds_of_parts(
    time: Floats, position: Floats, most: int
) -> tuple[Floats, float, float, bool]:
    """Return the speed in so many equal parts of a record (m/s), and how far they go (m).

    That is from the first to the last, and in all, beyond noise. Parts in which the drive turns are
    the fewest: the median speed is that between the turns. Parts in which it rests, as in a hold,
    are left out; the last value is whether there are any.
    """
    parts = min(most, len(time) // FEWEST_PER_FALL)
    times, positions = (np.array_split(each, parts) for each in (time, position))
    slopes, middles, left = [], [], []
    for t, x in zip(times, positions, strict=True):
        way = line(t, x)
        slopes.append(way.slope)
        middles.append(way.level)
        left.append(way.deviations(t, x))
    rest = np.concatenate(left)
    noise = float(rest.std()) * (correlation_time(rest) * parts / len(rest)) ** 0.5
    reach = float(np.ptp(middles)) - NOISE * noise
    speeds, net = np.abs(slopes), abs(middles[-1] - middles[0])
    still = NOISE * noise * parts / float(time[-1] - time[0])  # six errors of a slope
    moves = speeds > max(still, HELD * float(speeds.max()))
    if moves.all() or not moves.any() or np.median(speeds[moves]) < STARTS * still:
        return speeds, net, reach, False
    return speeds[moves], net, reach, True


def _normal_load(record: Record) -> StatedQuantity | None:
    """Compare the mean of the measured normal load with the stated one, not with itself."""
    if record.load is None or not len(record):
        return None
    found, spread = float(record.load.mean()), float(record.load.std())
    stated = record.stated_load or nan
    how = "mean of its channel, with its spread"
    return StatedQuantity("normal load", "N", found, spread, stated, 1 - ALIKE, 1 + ALIKE, how)


def _transverse_frequency(record: Record) -> StatedQuantity | None:
    """Compare the highest frequency that the record shows with the transverse one.

    That is (k_across/m)^1/2 / 2 pi; near the first slip the oscillation is slower.
    """
    if not record.stiffness_across or not record.mass or len(record) < FEWEST_PER_FALL:
        return None
    frequency = (record.stiffness_across / record.mass) ** 0.5 / (2.0 * pi)
    highest = SEEN * record.sample_rate
    sensor = (record.sensors or {}).get("force")
    how = "0.4 of the sample rate, or the sensor's cut-off"
    shown = highest if sensor is None else min(highest, sensor.cut_off)
    name = "frequencies up to, and the transverse one"
    return StatedQuantity(name, "Hz", shown, nan, frequency, 1.0, float("inf"), how)


def first_reading(record: Record) -> Floats:
    """Return the first readings of a record."""
    force: Floats = record.force[: max(8, len(record) // 400)]
    return force


def _zero(record: Record) -> StatedQuantity | None:
    """Return the reading with which a record begins, where that is constant: a zero perhaps."""
    some = first_reading(record)
    if not len(some) or len(record) < 4 * len(some):
        return None
    largest = largest_magnitude(record.force)
    read, spread = float(np.median(some)), float(np.std(some))
    read = read if abs(read) > ROUNDING * largest else 0.0
    if not abs(read) < AT_REST * largest or spread > AT_REST * largest:
        return None
    stated = 0.0 if record.zero is not None else nan
    return StatedQuantity("zero", "N", read, spread, stated, nan, nan, "reading at its beginning")


def _drift(cycles: CycleTable, drift: Drift | None) -> StatedQuantity | None:
    """Return the steady change of the force."""
    if drift is None:
        return None
    how = "line through the middles of cycles" if len(cycles) else "second half of the sliding"
    return StatedQuantity("drift of the force", "N/s", drift.rate, drift.error, nan, nan, nan, how)
