"""Doubts about the sampling of a record."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import hypot, inf, pi

import numpy as np

from stiction.analysis.motion.cycle_columns import CycleTable
from stiction.analysis.motion.friction import Friction
from stiction.analysis.motion.metadata.quantity import FEWEST_SAMPLES, StatedQuantity
from stiction.analysis.motion.metadata.stiffness_over_mass import BY_SLIPS, MOST_HIDDEN, REACH
from stiction.analysis.record import Record
from stiction.analysis.signals.digitised import resolution
from stiction.analysis.signals.even_grid import even_grid, why_not
from stiction.analysis.signals.peak_refinement import Pieces
from stiction.arrays import Floats
from stiction.recording.noise import white_noise
from stiction.recording.sensor import LowPass, low_pass
from stiction.result.table import mean_speeds
from stiction.text.quantity.wording import advice, in_words, percent

SLOWLY = 1e3  # s between samples
# Samples in a fall as they are seen, about one more than it lasts, and by which share the largest
# rate of half a sine between straight lines is too low that cubics through five samples have; the
# mean over all places of the samples
SEEN_SAMPLES = (2.3, 2.9, 3.4, 3.9, 4.7, 6.0)
TOO_LOW = (0.50, 0.33, 0.20, 0.10, 0.05, 0.02)
STEADY_STEP, MOSTLY = 0.1, 0.9  # change of a step, and share of steps that change by less
FEW_OFF = 0.05  # of the samples: interpolated, they hardly weaken an oscillation
# Periods of the cut-off in a fall of the force: with more, creep before a slip comes out to a tenth
# or two, drops to 0.3 %; with one, drops to 7 % and slip speeds to a third (Butterworth, order 4)
SHARP = 5.0
# Of the rise from sample to sample: so far, on average, peaks are above the last sample before a
# sudden fall. Of a fall of two samples they are by half of that, and so on: it begins slowly
BETWEEN = 0.5
# Periods of the cut-off, after which a filter has forgotten; samples of each; times its cut-off,
# from which on another filter does nothing beside it
MEMORY, FINE_SAMPLES, ALONE = 10.0, 40.0, 30.0
ORDERS = (1, 2, 4)  # of a filter that is supposed: it draws a slip out, or swings after it


def doubt_times(record: Record) -> Iterator[str]:
    """Name gaps, jitter and equal times, and how spectra deal with them."""
    if record.same_time:
        yield (
            f"{_samples(record.same_time)} the same time as the one before: such samples are "
            "spread evenly up to the next time."
        )
    grid = even_grid(record.time)
    if grid is None or grid.exact:
        return
    if not grid.serves:
        yield (
            f"Neither hum nor a fast oscillation can be found: {why_not(grid)}. Cycles with a gap "
            "of a quarter of their period are left out."
        )
        return
    if grid.coarse:
        yield (
            f"{_step_changes(np.diff(record.time))}: for spectra, and to find hum, the force is "
            f"interpolated by straight lines at even times, {in_words(grid.step, 's')} apart. An "
            f"oscillation of more than {in_words(0.25 / grid.step, 'Hz')} may not be seen."
        )
        return
    filled = "For spectra, and to find hum, straight lines lead over them"
    missing, off = int(np.count_nonzero(grid.missing)), int(np.count_nonzero(grid.off_grid))
    if missing:
        longest = in_words(float(np.diff(record.time).max()), "s")
        gaps = f"{grid.gaps} gaps of up to" if grid.gaps > 1 else "a gap of"
        yield f"{missing} of {grid.size} samples are missing, in {gaps} {longest}. {filled}."
    if off:
        some = f"{off} of {len(record)} samples" if off > 1 else "One sample"
        weaker = (
            " An oscillation of a quarter of the sample rate then seems smaller, by up to a fifth, "
            "and a faster one by more."
        )
        yield (
            f"{some} lie{'s' * (off == 1)} more than a tenth of an interval off even times: for "
            "spectra, and to find hum, the force is interpolated there by straight lines."
            f"{weaker if off > FEW_OFF * len(record) else ''}"
        )


def _step_changes(steps: Floats) -> str:
    """Return how the steps between samples (s) differ: from part to part, or at random."""
    steadily = np.abs(np.diff(steps)) < STEADY_STEP * steps[1:]
    if steadily.mean() < MOSTLY:
        return "The samples stand at random times"
    least, most = (in_words(1.0 / float(each), "Hz") for each in (steps.max(), steps.min()))
    return f"The sample rate changes within the record, between {least} and {most}"


def doubt_repeats(record: Record) -> Iterator[str]:
    """Doubt a sample rate at which each value is recorded several times."""
    if record.repeats > 1:
        yield (
            f"Each value is recorded {record.repeats} times: the sensor gives "
            f"{record.sample_rate:.3g} values a second, fewer than the record has. "
            "Each counts once."
        )


def _samples(count: int) -> str:
    return f"{count} samples have" if count > 1 else "One sample has"


def usual_fall(record: Record, cycles: CycleTable) -> float:
    """Return how long a fall of the force takes, s; infinite without cycles.

    Under slow loading the noise makes some sample far from the fall the largest, or the smallest.
    That lengthens it by what is beyond the samples within noise of its ends, between which half a
    cosine is supposed to lie; its first and last part are hidden.
    """
    falls = cycles["trough_time"] - cycles["peak_time"]
    if not len(falls):
        return inf
    if record.exact is not None:  # as samples would show it, it seems to last one more
        return float(np.median(falls)) + 1.0 / record.sample_rate
    reach = 2.0 * REACH * white_noise(record.force) + resolution(record.force)
    shares = np.minimum(reach / cycles["drop"], MOST_HIDDEN)
    first, last = np.searchsorted(record.time, [cycles["peak_time"], cycles["trough_time"]])
    at, piece, begins = its = Pieces.between(
        np.maximum(first - 1, 0), np.minimum(last, len(record) - 1)
    )
    force = record.force[at]
    low, high = (each.reduceat(force, begins) for each in (np.minimum, np.maximum))
    edge = shares * (high - low)
    comes = its.first(force <= (low + edge)[piece])
    leaves = its.last((force >= (high - edge)[piece]) & (at <= comes[piece]))
    hidden = 2.0 * np.arccos(1.0 - 2.0 * shares) / pi
    lasts = 1.0 + (comes - leaves - 1) / (1.0 - hidden)  # a fall seems to last one more
    seem = its.first(force == low[piece]) - its.first(force == high[piece])
    longer = np.where(leaves >= 0, np.maximum(seem - lasts, 0.0), 0.0)  # samples
    return float(np.median(falls - longer / record.sample_rate))


def drawn_out(fall: float, stated: float) -> float:
    """Return by how much a fall (s) is longer, in quadrature, than half a swing with a k/m, s."""
    return float(max(fall**2 - pi**2 / stated, 0.0) ** 0.5)


def doubt_few_samples(record: Record, cycles: CycleTable) -> Iterator[str]:
    """Doubt falls of the force of few samples, and the slip speeds that they give."""
    fall = usual_fall(record, cycles)
    samples = fall * record.sample_rate
    if not samples < FEWEST_SAMPLES:
        return
    interval = 0.1 * max(fall, 1.0 / record.sample_rate)
    slow = interval > SLOWLY  # nobody samples in nanohertz
    rate = f"every {in_words(interval, 's')}" if slow else f"at {advice(1.0 / interval, 'Hz')}"
    yield (
        f"A fall of the force takes {samples:.1f} samples, so that peaks and troughs lie "
        "between them"
        f"{_slow_slips(record, cycles, samples)}. Sample {rate} or more{' often' * slow}."
    )


def doubt_slips_between_samples(record: Record, cycles: CycleTable) -> Iterator[str]:
    """Doubt the samples of a run if slips are faster between them than at them."""
    unseen = int(np.count_nonzero(np.isnan(cycles["peak_slip_speed"])))
    if record.position is None or not unseen:
        return
    least = mean_speeds(record.time, record.position)
    yield (
        f"In {unseen} of {len(cycles)} slips the largest slip speed lies between two "
        f"samples, and is at least {in_words(float(least.max()), 'm/s')}: run a slip by itself, "
        "from initial=run.state(time) at a time before it, with more samples a second."
    )


def _slow_slips(record: Record, cycles: CycleTable, samples: float) -> str:
    """Return by how much slip speeds are too low that come from so many samples a fall."""
    if record.slip_speed is not None or not np.isfinite(cycles["peak_slip_speed"]).any():
        return ""
    if samples < SEEN_SAMPLES[0]:
        return ", and the largest slip speeds are lower bounds: they may be many times as high"
    low = float(np.interp(samples, SEEN_SAMPLES, TOO_LOW))
    return (
        f", and the largest slip speeds are too low by about {percent(low)} if a slip is half a "
        "sine, by more if it is quicker at its end"
    )


def doubt_filter(record: Record, cycles: CycleTable) -> Iterator[str]:
    """Doubt falls of the force that are faster than a stated filter passes."""
    sensor = (record.sensors or {}).get("force")
    if sensor is None:
        return
    fall = usual_fall(record, cycles)
    if fall * sensor.cut_off < SHARP:
        yield (
            f"A fall of the force takes {in_words(fall, 's')}, and its sensor passes what is "
            f"slower than {in_words(sensor.cut_off, 'Hz')}: peaks, troughs, slip speeds and the "
            "creep just before a slip are those of the smeared force. "
            f"Filter at {advice(2.0 * SHARP / fall, 'Hz')} or more."
        )


def with_smear(friction: Friction, record: Record, cycles: CycleTable) -> Friction:
    """Return the friction with the errors of peaks and troughs between samples, or in a filter.

    What lowers peaks raises troughs, but by less or by more: of the middle half of it is an error.
    """
    if not len(cycles):
        return friction
    rate, fall = record.sample_rate, usual_fall(record, cycles)
    lasts = max(fall * rate - 1.0, 1.0)  # samples: a fall seems to last one more
    lower = BETWEEN / lasts * cycles.median("stick_slope") / rate
    between = hypot(lower, _above_samples(record, cycles))
    sensor = (record.sensors or {}).get("force")
    peak, trough = _smear(cycles, fall, sensor.filters if sensor else ())
    static = hypot(peak, between)
    kinetic = hypot(0.5 * max(peak, trough), 0.25 * between)
    return friction.with_errors(break_away=peak, static=static, kinetic=kinetic)


def _above_samples(record: Record, cycles: CycleTable) -> float:
    """Return how far the peaks are above the largest sample of their cycle, N.

    A parabola rises too far above the few samples of a corner.
    """
    ends = np.searchsorted(record.time, [cycles["start"], cycles["trough_time"]])
    largest = np.maximum.reduceat(record.force, np.minimum(ends.T.ravel(), len(record) - 1))[::2]
    return max(float(np.median(cycles["peak"] - largest)), 0.0)


def with_supposed_filter(
    friction: Friction, record: Record, cycles: CycleTable, stated: Sequence[StatedQuantity]
) -> Friction:
    """Return the friction with the errors of a filter that nobody stated, where slips suggest one.

    They last longer than half a swing of mass and spring as stated: friction that weakens may make
    them, or a filter by which such a slip would last as long, of any order.
    """
    its = next((each for each in stated if each.how == BY_SLIPS), None)
    if its is None or not its.ratio < 1.0 or not len(cycles):
        return friction
    sensor = (record.sensors or {}).get("force")
    if sensor is not None and sensor.filters:
        return friction
    fall = usual_fall(record, cycles)
    longer = drawn_out(fall, its.stated)
    if not longer:  # of other slips than those that are too long
        return friction
    smears = [_smear(cycles, fall, (LowPass(1.0 / longer, order),)) for order in ORDERS]
    peak, trough = np.max(smears, axis=0)
    return friction.with_errors(break_away=peak, static=peak, kinetic=0.5 * max(peak, trough))


def _smear(cycles: CycleTable, fall: float, filters: Sequence[LowPass]) -> tuple[float, float]:
    """Return the smoothing of peaks and troughs between straight lines by filters, N.

    Falls of the force take `fall`, s.

    The lines are those of the cycles, but for their falls, which are smeared already: a period of
    the cut-off, in quadrature, is what a sudden one takes.
    """
    if not filters:
        return 0.0, 0.0
    slowest = min(each.cut for each in filters)
    filters = [each for each in filters if each.cut < ALONE * slowest]
    rate = FINE_SAMPLES * max(each.cut for each in filters)
    period, drop = cycles.median("period"), cycles.median("drop")
    fall = max(fall**2 - slowest**-2, rate**-2) ** 0.5
    lasts = np.array([period - fall, fall])
    seen = np.minimum(lasts, MEMORY / slowest)  # of rise and fall
    gains = np.array([drop, -drop]) * seen / lasts
    count = int(np.ceil(MEMORY / slowest / seen.sum()))
    corners, forces = (
        np.cumsum([0.0, *np.tile(each, count), 0.5 * each[0]]) for each in (seen, gains)
    )
    time = np.arange(0.0, corners[-1], 1.0 / rate)
    last = low_pass(np.interp(time, corners, forces), filters, rate)[time >= corners[-4]]
    return float(abs(forces[-3] - last.max())), float(abs(forces[-2] - last.min()))
