"""The kind of motion in a record, with its confidence and evidence."""

from __future__ import annotations

from collections.abc import Callable
from math import hypot, log, pi, sqrt
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from stiction.analysis.motion.band import EIGHTHS, SUSPECTED, WIDE, highest_hump, remaining
from stiction.analysis.motion.course import (
    MANY,
    ORDERED,
    PARTS,
    UNLOADED,
    change_of_period,
    course,
    lone_fall,
    order,
    strokes,
)
from stiction.analysis.motion.cycles import Swings, swings, swings_without
from stiction.analysis.motion.disturbance import RESIDUE
from stiction.analysis.motion.rest import (
    STICKING,
    TOUCHES,
    comes_to_rest,
    rest_share,
    rise_share,
    stick_shares,
    still_shares,
)
from stiction.analysis.record import Record, as_record
from stiction.analysis.signals.hum import narrow_lines, of_mains, samples_per_period
from stiction.analysis.signals.turning_points import CLEAR
from stiction.text.quantity_text import percent
from stiction.text.units import in_words
from stiction.trajectory import Trajectory

if TYPE_CHECKING:
    import xarray as xr

Floats = NDArray[np.float64]

STICK_SLIP = "stick-slip"
TRANSITIONAL = "transitional oscillation"
HARMONIC = "harmonic vibration"
TRANSVERSE = "transverse oscillation"
IRREGULAR = "irregular vibration"
SETTLING = "settling"
STEADY = "steady sliding"
STUCK = "stuck"
UNDETERMINED = "undetermined"

# Bounds of the share of a cycle for which the mass rests, or creeps, by the cycle's shape
SHAPES = ((STICKING, STICK_SLIP), (0.5, TRANSITIONAL), (0.0, HARMONIC))
# Share of a cycle for which the mass rests or creeps, in one piece, where its slip speed is known:
# from there on it sticks and slips, whatever the shape says
RESTS = 0.5
SLOW_SHARES = ("rest_share", "still_share")  # evidence of rest or creep, by the shape and the slip
ROUNDING = 1e-9  # of a period: stick intervals are that accurate, and more
BACKWARD = 0.4  # share of the rise, below which the force falls slowly and rises fast
# A vibration is irregular beyond either: the standard deviation of the periods over their mean,
# which noise through a wide filter brings to 0.37 and more; and the span of the drops over their
# median, a tenth left out at each end. Noise through any filter has 1.4 of it, as amplitudes of
# Rayleigh's distribution have, 0.7 to 1.5 where records are short; a measured vibration of one size
# has 0.57.
REGULAR, EVEN = 0.25, 0.75
SPREAD_ERROR = 1.8  # over the root of the number of swings: relative error of either
# That span of irregular vibrations, and of harmonic ones, measured among them, whose swings differ
# by noise or slowly: the typical one, and the standard deviation of its logarithm
IRREGULAR_SPREAD, HARMONIC_SPREAD = (1.05, 0.1), (0.17, 0.8)
ONE_WAY = 0.8  # of all ups and downs is change: a drift or a load, no wandering
SETTLED = 0.1  # of the force's span is passed in the last quarter; of an even load it is 0.25
LOADING = 0.5  # of the early rate, or of stiffness times drive velocity: it still sticks
# Times the scatter about it, and share of the mean force: by more a force wanders that slides, or
# the mass sticks and slips more slowly than the record shows. Measured steady sliding: 3.7
SMOOTH, VARIES = 5.0, 0.05
LONE_FALL = ("falls_at", "falls_by")  # evidence
SLOW = 0.1  # of stiffness times drive velocity: the mass goes at 9/10 of the drive's speed or more
MANY_SAMPLES = 64.0  # a cycle: no quicker line has been folded back to it
FEWEST, ENOUGH = 3.5, 8.0  # samples a cycle: below the first it is not known, nor what it is
# Samples that a quick fall seems to take at most, and that a fall takes which may be quick: a sine
# of four samples falls for two
QUICK, SLOWEST = 1.6, 3.0
RIPPLE = 1e-3  # of the force's span: a vibration that is less is no motion of its own
CERTAIN = 0.995  # a confidence that is written as 1.00: it leaves no room for another kind
# Of the period of the mass on the spring along x alone: a vibration of a lesser one has the
# transverse spring swing as well, as friction that turns couples them. On one spring friction only
# prolongs it
COUPLED = 0.9
# Of a swing from trough to peak, to each end, and share of time that is spent there: of a sine 0.2,
# of a force between two levels nearly half
NEAR, PLATEAU = 0.1, 0.35
# The same of a mass that swings on its spring and rests for less than half of its cycle: 0.16 and
# more; of a force that rises and falls evenly 0.1. Noise of less than this share of a drop
# does not change them much
STRAIGHT, QUIET = 0.13, 0.05
OWN = 1.2  # times that period: up to there a vibration is that of the mass on its spring
MAY_BE_HUM = (TRANSITIONAL, HARMONIC, IRREGULAR, UNDETERMINED)
SAME = 0.01  # of a period: by so much that of a line and that of the cycles differ
GROWN = 0.1  # of a force drop: less is not worth a word
NO_MORE = 1e-6  # a ratio that is less is nothing, up to rounding
NOISE_SHOWS = 1e-3  # of a force drop; what is less is no noise of a load cell


def _whole(value: float) -> str:
    return f"{value:.0f}"


def _three_digits(value: float) -> str:
    return f"{float(f'{value:.3g}'):g}" if abs(value) > NO_MORE else "0"


def _force(value: float) -> str:
    return in_words(value, "N")


def _seconds(value: float) -> str:
    return in_words(value, "s")


def _frequency(value: float) -> str:
    return in_words(value, "Hz")


WORDS: dict[str, tuple[str, Callable[[float], str]]] = {
    "cycles": ("complete cycles: {}", _whole),
    "rise_share": ("the force rises for {} of a cycle (a sine: 50 %, a sawtooth: 100 %)", percent),
    "rest_share": ("by this shape the mass rests or creeps for {} of it", percent),
    "backward": (
        "it falls slowly and rises fast, in {} of the cycles: is its sign right?",
        percent,
    ),
    "still_share": (
        "the slip speed stays below a tenth of the drive velocity for {} of it",
        percent,
    ),
    "stick_share": ("the mass sticks for {} of it", percent),
    "cycles_alike": ("{} of the cycles, each by itself, have this shape", percent),
    "period_spread": ("periods differ by {} of their mean", percent),
    "drop_spread": ("four fifths of the force drops differ by up to {} of their median", percent),
    "natural_period": ("a period is {} times the mass's own on its spring", _three_digits),
    "drop_over_noise": ("force drops are {} times as high as noise reaches", _three_digits),
    "line_taken_off": ("a line at {} was subtracted from the force", _frequency),
    "plateaus": (
        "it stays near its largest or its smallest value for {} of the time, as no vibration does: "
        "the drive goes back and forth, or the load changes in steps",
        percent,
    ),
    "straight": (
        "it rises and falls evenly, and turns at once, as no vibration does: it is within a tenth "
        "of its swing from either end for {} of the time (a sine: 41 %)",
        percent,
    ),
    "changed_at": ("at {} the cycles change", _seconds),
    "mains": ("it swings at {} as the mains do: it may be hum over another motion", _frequency),
    "swings": ("{} swings, each smaller than the last but for noise", _whole),
    "last_over_first": ("the last force drop is {} times the first", _three_digits),
    "turns": ("{} peaks and troughs make no complete cycle", _whole),
    "change": ("the force changes by {} from beginning to end", _force),
    "span": ("it spans {}, averaged over a 32nd of the time", _force),
    "scatter": ("it scatters by {} about that", _force),
    "wanders": (
        "it wanders by {}, too smoothly for noise: either friction changes, or cycles are longer "
        "than the record shows",
        _force,
    ),
    "falls_at": ("it falls quickly once, at {}", _seconds),
    "falls_by": ("by {}", _force),
    "late_share": ("in the last quarter of the time it spans {} of this", percent),
    "one_way": ("{} of all its ups and downs is this change", percent),
    "rate_kept": ("at the end it changes at {} of the rate of the beginning", percent),
    "rate_over_drive": (
        "at the end its rate is {} of stiffness times drive velocity",
        percent,
    ),
    "hump": ("it vibrates at about {}, in swings of every size", _frequency),
    "hump_height": ("in the spectrum they stand {} times above the threshold", _three_digits),
    "fading": ("it vibrates at about {}, less and less", _frequency),
    "fades_to": ("at the end {} or less of that is left", percent),
    "few_periods": (
        "it may vibrate at about {}, or scatter: for so slow a vibration the record is too short",
        _frequency,
    ),
    "samples_per_cycle": ("a cycle has {} samples, too few to show it", _three_digits),
    "rate_needed": ("sample at {} or more", _frequency),
    "samples": ("number of samples: {}, too few", _whole),
    "unchanging": ("all samples are exactly {}", _force),
    "forth": ("one way the force is about {}", _force),
    "back": ("the other way {}", _force),
}


class Regime(NamedTuple):
    """A kind of motion, with its confidence and evidence.

    Parameters
    ----------
    kind : str
        "stick-slip" (at rest, or in creep, for three quarters of a cycle or more, by the shape of
        the cycle; or for half of it or more where the slip speed is known; in a run, if it sticks
        in each cycle, however shortly),
        "transitional oscillation" (for half of it or more by the shape), "harmonic vibration" (for
        less or not at all), "transverse oscillation" (of a run, quicker than the mass can swing on
        the spring along x alone), "irregular vibration" (swings of changing period that stand out),
        "settling" (a transient that decays), "steady sliding" (no swings stand apart from the
        noise: what is smaller is not seen), "stuck" (it loads and never slips) or "undetermined".
    confidence : float
        0 to 1. With cycles, the likelihood that another one has the kind's shape, from their
        scatter, or from the number of those with another shape. Thus it is higher for cycles
        that are alike than for different ones, and for thirty than for three.
    evidence : dict
        Numbers behind the decision; ``str(regime)`` puts them into words.
    runner_up : str
        The second most frequent kind among the cycles; empty if there is none.
    """

    kind: str
    confidence: float
    evidence: dict[str, float]
    runner_up: str = ""

    @property
    def loads(self) -> bool:
        """Whether the mass rests, or creeps, for most of the time in which its spring is loaded.

        Then the peaks show static friction, and the loading shows stiffness and creep. A mass that
        sticks only shortly is still slower than the drive, or faster, for most of that time.
        """
        rests = max(self.evidence.get(name, 0.0) for name in SLOW_SHARES)
        return self.kind in (STICK_SLIP, TRANSITIONAL) and rests >= RESTS

    @property
    def rests(self) -> str:
        """How long a mass that sticks and slips rests, in words; empty if it does not stick."""
        if self.kind not in (STICK_SLIP, TRANSITIONAL):
            return ""
        if not self.loads and "stick_share" in self.evidence:
            return f"stuck for {percent(self.evidence['stick_share'])} of a cycle"
        slow = [self.evidence[name] for name in SLOW_SHARES if name in self.evidence]
        return f"at rest or in creep for {percent(max(slow))} of a cycle" if slow else ""

    @property
    def surely(self) -> str:
        """The kind, its confidence, and how long the mass rests, in words."""
        other = f"; else {self.runner_up}" if self.runner_up and self.confidence < CERTAIN else ""
        rests = f", {self.rests}" if self.rests else ""
        return f"{self.kind} (confidence {self.confidence:.2f}{other}){rests}"

    def __str__(self) -> str:
        """Return the kind, its confidence and the evidence in words."""
        # a vibration does not rest: its shape is only an estimate of that
        none = {"rest_share"} if self.kind in (HARMONIC, TRANSVERSE) else set()
        said = ((*WORDS[name], value) for name, value in self.evidence.items() if name not in none)
        reasons = "; ".join(text.format(written(value)) for text, written, value in said)
        return f"{self.surely}: {reasons}"


def classify(source: Trajectory | Record) -> Regime:
    """Classify the motion in a record.

    The shape of the cycles decides (`stiction.analysis.motion.rest`). If there are none, or they
    die out, the course of the force decides: it rises to the end, settles, or stays about constant.

    Parameters
    ----------
    source : Trajectory or Record
        A run or a measurement. With stiffness, drive velocity and mass, the rate of loading and
        the natural period count too; otherwise only the shape.
    """
    record = as_record(source)
    return regime_of(record, swings(record))


def regime_of(record: Record, found: Swings) -> Regime:
    """Classify the motion in a record with known swings: see `classify`."""
    if len(record) < PARTS:
        return Regime(UNDETERMINED, 0.0, {"samples": len(record)})
    if record.slip_speed is None:
        if np.ptp(record.force) == 0.0:
            return Regime(UNDETERMINED, 0.0, {"unchanging": float(record.force[0])})
        if (pulls := strokes(record.force)) is not None:
            return Regime(UNDETERMINED, 0.0, {"forth": pulls[0], "back": pulls[1]})
    if found.lines:
        record = record.model_copy(update={"force": found.force})
    per_cycle = 2.0 * len(record) / max(found.turns, 1)
    if not found.table.sizes["cycle"] or per_cycle < MANY_SAMPLES:
        per_cycle = min(per_cycle, samples_per_period(record.force))
    if per_cycle < FEWEST:
        needed = ENOUGH / per_cycle * record.sample_rate
        return Regime(UNDETERMINED, 0.0, {"samples_per_cycle": per_cycle, "rate_needed": needed})
    if found.dying or _is_over(record, found):
        drop = found.table["drop"].values
        sure = (len(drop) + 1) / (len(drop) + 3)
        return Regime(SETTLING, sure, {"swings": len(drop), "last_over_first": drop[-1] / drop[0]})
    if found.table.sizes["cycle"]:
        period = float(found.cycles["period"].mean())
        return _or_hum(record, period, SAME, _by_parts(record, found))
    seen = _by_course(record, found)
    frequency = seen.evidence.get("hump")
    return _or_hum(record, 1.0 / frequency, WIDE - 1.0, seen) if frequency else seen


def _is_over(record: Record, found: Swings) -> bool:
    """Return whether swings have ended for good: mass and drive are known to rest."""
    drop = found.table["drop"].values
    ended = record.drive_velocity is None and comes_to_rest(record.slip_speed)
    return ended and len(drop) > 0 and bool(drop[-1] <= drop[0])


def _or_hum(record: Record, period: float, differs: float, seen: Regime) -> Regime:
    """Return a kind of motion, as likely another one if its swings are a line of the mains.

    Nothing distinguishes hum over another motion from a vibration at that frequency, unless the
    slip speed is known, or the mass swings with that period on its spring.
    """
    own = seen.evidence.get("natural_period", 0.0)
    free = seen.kind in MAY_BE_HUM and not COUPLED <= own <= OWN
    if not free or record.slip_speed is not None:
        return seen
    for line in narrow_lines(record.time, record.force):
        if of_mains(line.frequency) and abs(line.frequency * period - 1.0) < differs:
            without, left = swings_without(line, record)
            other = regime_of(without, left)
            kind = STEADY if other.runner_up == STEADY else other.kind
            evidence = {name: seen.evidence[name] for name in seen.evidence if name != "backward"}
            evidence["mains"] = line.frequency
            return Regime(seen.kind, 0.5 * seen.confidence, evidence, kind)
    return seen


def _by_parts(record: Record, found: Swings) -> Regime:
    """Classify cycles whose period may change once: then each part has a kind of its own."""
    seen, at = _by_shape(record, found), change_of_period(found.cycles["period"].values)
    if at is None:
        return seen
    tables = [found.cycles.isel(cycle=part) for part in (slice(at), slice(at, None))]
    early, late = (_by_shape(record, found._replace(table=table)) for table in tables)
    lasts = [float(table["period"].sum()) for table in tables]
    changed = {"changed_at": float(tables[1]["start"][0])}
    if early.kind == late.kind:
        sure = min(early.confidence, late.confidence)
        return Regime(early.kind, sure, seen.evidence | changed, early.runner_up)
    main, other = (early, late) if lasts[0] >= lasts[1] else (late, early)
    share = max(lasts) / sum(lasts)
    return Regime(main.kind, share * main.confidence, main.evidence | changed, other.kind)


def _near_ends(record: Record, table: xr.Dataset) -> tuple[float, float]:
    """Return the shares of time for which a force stays near its troughs and near its peaks."""
    start, peak, end = (table[name].values for name in ("start", "peak_time", "trough_time"))
    inside = (record.time >= start[0]) & (record.time <= end[-1])
    time, force = record.time[inside], record.force[inside]
    low = np.interp(
        time, [start[0], *end], [table["start_force"].values[0], *table["trough"].values]
    )
    high = np.interp(time, peak, table["peak"].values)
    place = (force - low) / np.maximum(high - low, 1e-300)
    return float(np.mean(place < NEAR)), float(np.mean(place > 1.0 - NEAR))


def _by_shape(record: Record, found: Swings) -> Regime:
    table, count = found.cycles, found.cycles.sizes["cycle"]
    step = float(np.median(np.diff(record.time)))
    shares = table["rise_share"].values
    other = ""
    if float(table["period"].mean()) < ENOUGH * step:
        share, as_well = _coarse_shares(table, step)
        shares = np.full(count, share)
        other = shape(as_well) if shape(as_well) != shape(share) else ""
    still, sticks = _still(record, table), _sticking(record, table)
    kinds = [shape(*each) for each in zip(shares, still, sticks, strict=True)]
    typical, stands, stuck = (float(np.median(each)) for each in (shares, still, sticks))
    kind, form = shape(typical, stands, stuck), shape(typical, stands)
    alike = kinds.count(kind)
    evidence = {"cycles": count, "rise_share": typical}
    if kind == UNDETERMINED:
        if float(table["hesitations"].median()) >= 1.0:  # it turns back: two swings, or a ringing
            return Regime(UNDETERMINED, 0.0, evidence)
        evidence["backward"] = alike / count
    else:
        evidence["rest_share"] = float(rest_share(typical))
    if form != shape(typical):
        evidence["still_share"] = stands
    if kind != form:
        evidence["stick_share"] = stuck
    period_spread = float(table["period"].std() / table["period"].mean())
    if count > 1:
        evidence |= {"cycles_alike": alike / count, "period_spread": period_spread}
    drop = table["drop"].values
    if kind == HARMONIC and count > 1:
        evidence["drop_spread"] = drop_spread(drop)
    evidence |= _natural_period(record, table)
    own, resolution = record.own_period, step / float(table["period"].mean())
    if own is not None and couples(shape(typical), float(table["period"].mean()), own):
        quick = table["period"].values / own
        alike = int((quick < COUPLED).sum())
        if count > 1:
            evidence["cycles_alike"] = alike / count
        sure = max((alike + 1) / (count + 3), _chance(quick, 0.0, COUPLED, resolution))
        return Regime(TRANSVERSE, sure, evidence, kind)
    if found.noise > NOISE_SHOWS * np.median(drop):
        evidence["drop_over_noise"] = float(np.median(drop)) / found.noise
    grown = float(drop[-1] / drop[0])
    if count >= MANY and abs(order(drop)) >= -ORDERED and abs(grown - 1.0) > GROWN:
        evidence["last_over_first"] = grown
    if found.lines:
        evidence["line_taken_off"] = found.lines[0].frequency
    others = sorted(set(kinds) - {kind, UNDETERMINED}, key=kinds.count)
    counted = (alike + 1) / (count + 3)
    if form in (TRANSITIONAL, HARMONIC):
        stays = _near_ends(record, table)
        if min(stays) > PLATEAU:
            return Regime(UNDETERMINED, 0.0, {"cycles": count, "plateaus": 2.0 * min(stays)})
        unknown = record.slip_speed is None and form == HARMONIC
        if unknown and max(stays) < STRAIGHT and found.noise < QUIET * np.median(drop):
            return Regime(UNDETERMINED, 0.0, {"cycles": count, "straight": sum(stays)})
    decisive = (shares, *_bounds(kind), resolution)
    if form != shape(typical):
        decisive = (still, RESTS, np.inf, resolution)
    if kind != form:
        decisive = (sticks, TOUCHES, np.inf, ROUNDING)
    confidence = max(counted, _chance(*decisive))
    if other:  # as likely
        return Regime(kind, 0.5 * confidence, evidence, other)
    irregular = irregularity(table["period"].values, drop) if kind == HARMONIC else 0.0
    if irregular > 0.5:
        return Regime(IRREGULAR, irregular * confidence, evidence, HARMONIC)
    confidence *= 1.0 - irregular
    if irregular > 1.0 - alike / count:
        return Regime(kind, confidence, evidence, IRREGULAR)
    return Regime(kind, confidence, evidence, others[-1] if others else "")


def _still(record: Record, table: xr.Dataset) -> Floats:
    """Return for which share of each cycle the mass is known to rest or creep."""
    if record.slip_speed is None or record.drive_velocity is None:
        return np.zeros(table.sizes["cycle"])
    speed = record.slip_speed / record.drive_velocity
    ends = (table[name].values for name in ("start", "peak_time", "period"))
    return still_shares(record.time, speed, *ends)


def _sticking(record: Record, table: xr.Dataset) -> Floats:
    """Return for which share of each cycle the mass is known to stick."""
    if record.sticks is None:
        return np.zeros(table.sizes["cycle"])
    ends = (table[name].values for name in ("start", "peak_time", "period"))
    return stick_shares(record.sticks, *ends)


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


def drop_spread(drop: Floats) -> float:
    """Return the span of the drops over their median, a tenth left out at each end."""
    low, middle, high = np.percentile(drop, (10.0, 50.0, 90.0))
    return float((high - low) / middle)


def irregularity(period: Floats, drop: Floats) -> float:
    """Return the likelihood of irregular swings from the spread of their periods and drops.

    By periods: whether more swings would exceed the spread `REGULAR`. By drops: their spread is
    drawn from one of two distributions, of which that of irregular swings narrows with the number
    of swings; where both overlap, `EVEN` decides. Sizes in order grow or shrink; they say nothing.
    """
    from scipy.special import expit, ndtr

    count, likely = len(drop), 0.0
    if count < MANY or abs(order(period)) < -ORDERED:
        spread = float(period.std() / period.mean()) / REGULAR
        likely = float(ndtr(log(max(spread, 1e-9)) * sqrt(count) / SPREAD_ERROR))
    spread = drop_spread(drop)
    if abs(order(drop)) >= -ORDERED or spread == 0.0:  # it grows, or is quite even
        return likely
    error = hypot(SPREAD_ERROR / sqrt(count), IRREGULAR_SPREAD[1])
    drops = float(
        expit(
            _log_density(spread, IRREGULAR_SPREAD[0], error)
            - _log_density(spread, *HARMONIC_SPREAD)
        )
    )
    return max(likely, max(drops, 0.5) if spread > EVEN else min(drops, 0.5))


def _log_density(value: float, typical: float, spread: float) -> float:
    """Return the logarithm of the density of a value's logarithm, normal about a typical one's."""
    return -0.5 * (log(value / typical) / spread) ** 2 - log(spread)


def _bounds(kind: str) -> tuple[float, float]:
    """Return the bounds of the rise share for a kind of cycle."""
    if kind == UNDETERMINED:
        return -np.inf, BACKWARD
    ends = [np.inf, *(float(rise_share(rests)) for rests, _ in SHAPES[:-1]), BACKWARD]
    place = [name for _, name in SHAPES].index(kind)
    return ends[place + 1], ends[place]


def _coarse_shares(table: xr.Dataset, step: float) -> tuple[float, float]:
    """Return the mean rise share in cycles of few samples, and an alternative value.

    A fall quicker than a sample is seen from the last sample before it to the first after it:
    one sample longer than it is, on average. A fall of some samples may be so or not.
    """
    period = float(table["period"].mean())
    fall = float((table["trough_time"] - table["peak_time"]).mean())
    slow, quick = 1.0 - fall / period, 1.0 - max(fall - step, 0.0) / period
    if fall < QUICK * step:
        return quick, quick
    return slow, quick if fall < SLOWEST * step else slow


def shape(rise_share: float, still: float = 0.0, sticks: float = 0.0) -> str:
    """Return the kind of cycles from the shares of rise, and of rest and sticking where known."""
    if still >= RESTS or sticks > TOUCHES:
        return STICK_SLIP
    if rise_share < BACKWARD:
        return UNDETERMINED
    rests = rest_share(rise_share)
    return next(kind for bound, kind in SHAPES if rests >= bound)


def couples(kind: str, period: float, own: float) -> bool:
    """Return whether a vibration is too quick for the spring along x, whose period is `own`.

    Then the transverse spring swings as well: friction that turns couples them. Where the mass
    sticks, it does so once in each of these swings.
    """
    return kind in (TRANSITIONAL, HARMONIC) and period < COUPLED * own


def _natural_period(record: Record, table: xr.Dataset) -> dict[str, float]:
    if record.mass is None or record.stiffness is None:
        return {}
    own = 2.0 * pi * sqrt(record.mass / record.stiffness)
    return {"natural_period": float(table["period"].median()) / own}


def _steady(record: Record, found: Swings, sure: float, evidence: dict[str, float]) -> Regime:
    """Return steady sliding, or as likely stick-slip whose cycles are longer than the record."""
    if record.slip_speed is not None:
        return Regime(STEADY, sure, evidence)
    least = max(SMOOTH * evidence["scatter"], VARIES * abs(float(np.mean(found.force))))
    if evidence["span"] > least:
        return Regime(STEADY, 0.5 * sure, evidence | {"wanders": evidence["span"]}, STICK_SLIP)
    fall = lone_fall(record.time, found.force)
    return Regime(STEADY, sure, evidence | dict(zip(LONE_FALL, fall or (), strict=False)))


def _by_course(record: Record, found: Swings) -> Regime:
    way = course(record.time, record.force)
    drive = (record.stiffness or 0.0) * (record.drive_velocity or 0.0)
    evidence = {"change": way.change, "span": way.span, "scatter": way.scatter}
    if found.lines:
        evidence["line_taken_off"] = found.lines[0].frequency
    if drive:
        evidence["rate_over_drive"] = way.late_rate / drive
    late = way.late_span / way.span if way.span > 0.0 else 1.0
    rising = way.change > 0.0 and way.one_way >= ONE_WAY
    slides = not rising or 0.0 < max(abs(way.early_rate), abs(way.late_rate)) < SLOW * drive
    if late > SETTLED and found.turns:
        return Regime(UNDETERMINED, 0.0, evidence | {"turns": found.turns})
    # a transient ends, and a load goes on, in the later half; what vibrates then does not end
    begin = 0 if late > SETTLED and slides else len(record) // 2
    hump = highest_hump(record.time[begin:], record.force[begin:])
    least = max([RIPPLE * way.span, *(RESIDUE * line.height for line in found.lines)])
    vibrates = hump.likelihood if hump.rms > least else 0.0
    if vibrates > 0.5:
        left = remaining(record.time, record.force, hump.frequency)
        if left < 1.0:
            sure = (EIGHTHS + 1) / (EIGHTHS + 3)
            return Regime(SETTLING, sure, evidence | {"fading": hump.frequency, "fades_to": left})
        evidence |= {"hump": hump.frequency, "hump_height": hump.height}
        return Regime(IRREGULAR, vibrates, evidence, STEADY)
    if late <= SETTLED:
        sure = (1.0 - late / (2.0 * SETTLED)) * (1.0 - vibrates)
        return Regime(SETTLING, sure, evidence | {"late_share": late})
    if slides:
        # the nearer to cycles it came, the less sure it is that there are none
        sure = (1.0 - 0.5 * found.clearness / CLEAR) * (1.0 - vibrates)
        few = highest_hump(record.time, record.force, SUSPECTED)
        vibrates = few.likelihood if few.rms > least else 0.0
        if vibrates > 0.5:
            return Regime(UNDETERMINED, 0.0, evidence | {"few_periods": few.frequency})
        return _steady(record, found, sure * (1.0 - vibrates), evidence)
    kept = way.late_rate / way.early_rate
    evidence |= {"one_way": way.one_way, "rate_kept": kept}
    loading = way.late_rate / drive if drive else kept
    if loading >= LOADING:
        sure = way.one_way * min(loading, 1.0) * (1.0 - vibrates)
        if not drive and abs(record.force[0]) > UNLOADED * float(np.abs(record.force).max()):
            return Regime(STUCK, 0.5 * sure, evidence, STEADY)  # as likely, it drifts
        return Regime(STUCK, sure, evidence)
    return Regime(UNDETERMINED, 0.0, evidence)
