"""Warnings about a record whose numbers contradict each other."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import inf, log10, pi

import numpy as np

from stiction.analysis.motion.course import QUIET, change_of_period
from stiction.analysis.motion.drift import Drift, find_drift
from stiction.analysis.motion.friction import Friction
from stiction.analysis.motion.metadata import FEW, LOADING_RATE, SWING, StatedQuantity
from stiction.analysis.motion.regime.kinds import HARMONIC, STEADY, STICK_SLIP, TRANSITIONAL
from stiction.analysis.record import Record
from stiction.analysis.signals.even_grid import even_grid, why_not
from stiction.analysis.signals.hum import Line, of_mains
from stiction.analysis.signals.robust import largest_magnitude
from stiction.arrays import xr
from stiction.text.quantity_text import percent
from stiction.text.units import in_words
from stiction.trajectory import Trajectory

LARGEST_MU = 3.0
LEAST_MU = 0.01  # of dry friction: superlubricity aside
UNITS = (("mN", "milli", 1e-3), ("uN", "micro", 1e-6), ("kN", "kilo", 1e3))  # size, N
TINY_MU = 1e-3  # no friction is so small, but of a film of fluid
THOUSAND = 0.2  # a ratio within a factor of 5 of a thousand, or its square, is a wrong unit
ABOUT_ZERO = 0.05  # of half the drop: so far from zero the middle of a swing may lie
AT_REST = 0.02  # of the largest force
FLAT = 4  # times as many samples at the largest value as at any other, and so many at least
ENOUGH_VALUES = 16  # that are all repeated as often
TIMES = 3  # that a force stays at its least value: at rest it does so once
QUIET_SHARE = 0.15  # of the record
# A cycle in which the drive may have paused: over the median period, and over the span of periods,
# a tenth left out at each end; of measured stick-slip without a pause it comes to 1.4 spans
PAUSED, BEYOND, FEWEST_CYCLES = 3.0, 5.0, 10
VARIES = 0.05  # of the mean of a measured load: less is not worth a sentence
IMPOSED = {"drive": ("drive_X", "drive_Y"), "load": ("normal_load",)}  # columns of a run
# By which power of 1000 the rate of a force is off in another unit: quantity, unit, remedy
CAUSES = {
    -2: (("time", "microseconds", "time_unit='us'"),),
    -1: (
        ("time", "milliseconds", "time_unit='ms'"),
        ("force", "kilonewtons", "force_unit='kN'"),
    ),
    1: (("force", "millinewtons", "force_unit='mN'"),),
    2: (("force", "micronewtons", "force_unit='uN'"),),
}
FEW_OFF = 0.05  # of the samples: interpolated, they hardly weaken an oscillation
STIRS = 0.01  # of the drive's largest speed: more backwards is a motion to and fro
NOISE = 5.0  # standard deviations
# Periods of the cut-off in a fall of the force: with more, creep before a slip comes out to a tenth
# or two, drops to 0.3 %; with one, drops to 7 % and slip speeds to a third (Butterworth, order 4)
SHARP = 5.0


def warnings(
    record: Record,
    kind: str,
    cycles: xr.Dataset,
    friction: Friction,
    stated: Sequence[StatedQuantity],
) -> tuple[str, ...]:
    """Return warnings as sentences, the most important first; `stated` is what was compared."""
    wrong = {each.quantity: each for each in stated if each.agrees is False}
    found = [
        *_doubt_load(record),
        *_implausible_friction(record, friction, cycles),
        *_doubt_clipping(record),
        *_doubt_mean_period(cycles),
        *_doubt_longest_cycle(cycles),
        *_doubt_quiet(record, friction, cycles),
        *_loading_too_fast(wrong.get(LOADING_RATE)),
        *_mass(wrong.get(SWING), kind),
        *_mains(kind, cycles),
        *_coarse(record, cycles),
        *_smear(record, cycles),
        *_drift(record, kind, cycles),
        *_zero(record, friction, cycles),
        *_doubt_times(record),
        *_doubt_repeats(record),
    ]
    return tuple(found)


def subtracted_lines(lines: tuple[Line, ...]) -> tuple[str, ...]:
    """Return a sentence for each line that was subtracted from the force."""
    found = []
    for line in lines:
        hum = ", probably mains hum," if of_mains(line.frequency) else ""
        found.append(
            f"A line at {in_words(line.frequency, 'Hz')} with an amplitude of "
            f"{in_words(0.5 * line.height, 'N')}{hum} was subtracted from the force before the "
            "search for cycles."
        )
    return tuple(found)


def _doubt_load(record: Record) -> Iterator[str]:
    """Say that a measured load varies, and which analysis suits it."""
    varies = record.load_variation()
    if varies > VARIES:
        yield (
            f"The normal load varies by {percent(varies)} of its mean. Coefficients of "
            "friction are force over load at the same instant; kind of motion, cycles and forces "
            "are those of a steady test, which this is not; st.analysis.load_dependence suits such "
            "a test."
        )


def unsteady(run: Trajectory) -> tuple[str, ...]:
    """Return a sentence if the drive or the load of a run varies, and which analysis suits it."""
    varies = [name for name, of in IMPOSED.items() if _varies(run, of)]
    if not varies:
        return ()
    remedy = "st.analysis.velocity_steps, healing or hysteresis suit such a test"
    if varies == ["load"]:
        remedy = "st.analysis.load_dependence suits such a test"
    if turns_round(run):
        remedy = "st.analysis.hysteresis gives the loops of force over travel"
    return (
        f"The {' and the '.join(varies)} {'varies' if len(varies) == 1 else 'vary'}: kind of "
        f"motion, cycles and friction are those of a steady test, which this is not; {remedy}.",
    )


def turns_round(run: Trajectory) -> bool:
    """Return whether the drive of a run goes both ways; a stage at rest may stir a little."""
    along = run.samples["drive_X"]
    least = STIRS * float(np.abs(along).max(initial=0.0))
    return bool(along.min() < -least and along.max() > least)


def _varies(run: Trajectory, columns: tuple[str, ...]) -> bool:
    return any(bool(np.ptp(run.samples[name]) > 0.0) for name in columns)


def _doubt_times(record: Record) -> Iterator[str]:
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
            "The samples stand at random times: for spectra, and to find hum, the force is "
            f"interpolated by straight lines at even times, {in_words(grid.step, 's')} apart. An "
            f"oscillation of more than {in_words(0.25 / grid.step, 'Hz')} may not be seen."
        )
        return
    filled = "For spectra, and to find hum, straight lines lead over them"
    missing, off = int(np.count_nonzero(grid.missing)), int(np.count_nonzero(grid.off_grid))
    if missing:
        longest = in_words(float(np.diff(record.time).max()), "s")
        gaps = (
            f"in {grid.gaps} gaps of up to {longest}" if grid.gaps > 1 else f"in one of {longest}"
        )
        yield f"{missing} of {grid.size} samples are missing, {gaps}. {filled}."
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


def _doubt_repeats(record: Record) -> Iterator[str]:
    """Doubt a sample rate of which each value is recorded several times."""
    lasts = np.diff(np.flatnonzero(np.diff(record.force, prepend=np.nan) != 0.0))[1:]
    if len(lasts) < ENOUGH_VALUES or lasts.max() < 2 or np.ptp(lasts) > 1 or lasts.min() < 2:
        return
    times = int(np.median(lasts))
    yield (
        f"Each value is recorded {times} times: the sensor gives {record.sample_rate / times:.3g} "
        f"values a second, fewer than the record has. Analyse time[::{times}] and force[::{times}]."
    )


def _samples(count: int) -> str:
    return f"{count} samples have" if count > 1 else "One sample has"


def _mains(kind: str, cycles: xr.Dataset) -> Iterator[str]:
    """Doubt a vibration at the mains frequency: nothing distinguishes it from hum."""
    if kind != HARMONIC:
        return
    lasts = float(cycles["trough_time"][-1] - cycles["start"][0])
    frequency = cycles.sizes["cycle"] / lasts
    if of_mains(frequency):
        yield (
            f"The force swings at {in_words(frequency, 'Hz')}, as the mains do. Record it with the "
            "drive at rest: if it swings then, that is hum, and the mass slides steadily."
        )


def _doubt_clipping(record: Record) -> Iterator[str]:
    """Doubt a force that stays at exactly its largest or least value for longer than elsewhere."""
    way = 1.0 if record.force.max(initial=0.0) >= -record.force.min(initial=0.0) else -1.0
    force = way * record.force
    if not len(force):
        return
    begins = np.flatnonzero(np.diff(force, prepend=force[0] - 1.0))
    lasts, values = np.diff(begins, append=len(force)), force[begins]
    top, bottom = values == force.max(), values == force.min()
    if (top | bottom).all():
        return
    flat = lasts >= max(FLAT, FLAT * int(lasts[~top & ~bottom].max()) + 1)
    cut = {
        "largest": (top, 1, "peaks are cut off, static coefficients and drops are too small, and "
        "what seems to creep there may rest"),
        "least": (bottom, TIMES, "troughs are cut off, drops are too small and kinetic "
        "coefficients too large"),
    }  # fmt: skip
    for name, (end, least, then) in cut.items():
        if np.count_nonzero(flat & end) < least:
            continue
        value, longest = way * float(values[end][0]), int(lasts[end].max())
        yield (
            f"The force stays at exactly {in_words(value, 'N')} for up to {longest} samples, its "
            f"{name} value: if that is the end of the load cell's range, {then}."
        )


def _doubt_mean_period(cycles: xr.Dataset) -> Iterator[str]:
    """Doubt one mean over cycles of which the later have another period than the earlier."""
    period = cycles["period"].values
    k = change_of_period(period)
    if k is None:
        return
    at = in_words(float(cycles["start"].values[k]), "s")
    first, second = (in_words(float(np.median(part)), "s") for part in (period[:k], period[k:]))
    yield (
        f"From {at} on the cycles take {second}, before {first}: if the drive or the load changed "
        "there, analyse the two parts by themselves; means over both mean little."
    )


def _doubt_longest_cycle(cycles: xr.Dataset) -> Iterator[str]:
    """Doubt means over cycles of which one takes far longer than the others, as in a pause."""
    period = cycles["period"].values
    if len(period) < FEWEST_CYCLES:
        return
    low, middle, high = np.percentile(period, (10.0, 50.0, 90.0))
    longest = float(period.max())
    if longest < PAUSED * middle or longest - middle < BEYOND * (high - low):
        return
    at = in_words(float(cycles["start"].values[period.argmax()]), "s")
    yield (
        f"The cycle from {at} on takes {in_words(longest, 's')}, {longest / middle:.2g} times the "
        f"median, {in_words(float(middle), 's')}: if the drive paused, analyse the parts before "
        "and after by themselves; means over all cycles, such as of period and creep, mean little."
    )


def _doubt_quiet(record: Record, friction: Friction, cycles: xr.Dataset) -> Iterator[str]:
    """Name long parts of a record without cycles, before the first or after the last of them."""
    if not cycles.sizes["cycle"]:
        return
    least = max(QUIET * float(cycles["period"].max()), QUIET_SHARE * record.duration)
    first, last = float(cycles["start"][0]), float(cycles["trough_time"][-1])
    parts = {}
    if first - record.time[0] > least and friction.break_away is None:
        parts[f"Before {in_words(first, 's')}"] = record.time <= first
    if record.time[-1] - last > least:
        parts[f"After {in_words(last, 's')}"] = record.time >= last
    for when, inside in parts.items():
        lasts = in_words(float(np.ptp(record.time[inside])), "s")
        yield (
            f"{when} the force has no such cycles, for {lasts}: the report is of the cycles. "
            "Analyse that part by itself."
        )


def _implausible_friction(record: Record, friction: Friction, cycles: xr.Dataset) -> Iterator[str]:
    known = [each for each in friction[:3] if each is not None]
    mu = max((abs(each.coefficient) for each in known), default=np.nan)
    if TINY_MU <= mu <= LARGEST_MU or not np.isfinite(mu):
        return
    if mu < TINY_MU and _is_about_zero(friction, cycles):
        return
    load = in_words(record.normal_load or 0.0, "N")
    its = next(
        (
            f"is the force in {prefix}newtons? Give force_unit='{unit}'; or "
            for unit, prefix, size in UNITS
            if LEAST_MU < mu * size < LARGEST_MU
        ),
        "",
    )
    yield f"A friction coefficient of {mu:.3g} is implausible: {its}check the normal load, {load}."


def _loading_too_fast(its: StatedQuantity | None) -> Iterator[str]:
    if its is None:
        return
    yield (
        f"The force rises at {in_words(its.found, 'N/s')}, {its.ratio:.3g} times stiffness times "
        f"drive velocity as stated, {in_words(its.stated, 'N/s')}: {_remedy(its.ratio)}."
    )


def _remedy(ratio: float) -> str:
    """Return the likely cause of a rate that is `ratio` times as large as stated."""
    power = log10(ratio) / 3.0 if ratio > 0.0 else 0.0
    causes = CAUSES.get(round(power)) if abs(power - round(power)) < 0.1 else None
    if causes is None:
        return "check stiffness and drive velocity, or the gain of the load cell"
    asked = "; ".join(f"is the {what} in {name}? Give {how}" for what, name, how in causes)
    wrong = f"{1000 ** abs(round(power))} times too {'large' if power < 0.0 else 'small'}"
    return f"{asked}; or stiffness or drive velocity is stated {wrong}"


def _mass(its: StatedQuantity | None, kind: str) -> Iterator[str]:
    """Doubt k/m if the period of a swing, or the duration of a slip, contradicts it."""
    if its is None:
        return
    lasts = 2.0 if kind == HARMONIC else 1.0
    yield (
        f"By the {its.how} ({in_words(lasts * pi / its.found**0.5, 's')}), "
        f"stiffness over mass is {its.ratio:.2g} times {its.stated:.3g} 1/s², as stated: "
        f"{_remedy_of_mass(its.ratio)}."
    )


def _remedy_of_mass(ratio: float) -> str:
    """Return the likely cause of a k/m that is `ratio` times as large as stated."""
    if THOUSAND * 1e-6 < ratio < 1e-6 / THOUSAND:
        return "is the time in milliseconds? Give time_unit='ms'; or check mass and stiffness"
    return "check mass and stiffness"


def _usual_fall(cycles: xr.Dataset) -> float:
    """Return how long a fall of the force takes, s; infinite without cycles."""
    falls = cycles["trough_time"].values - cycles["peak_time"].values
    return float(np.median(falls)) if len(falls) else inf


def _coarse(record: Record, cycles: xr.Dataset) -> Iterator[str]:
    fall = _usual_fall(cycles)
    samples = fall * record.sample_rate
    if samples < FEW:
        yield (
            f"A fall of the force takes {samples:.1f} samples: peaks and troughs are cut off. "
            f"Sample at {in_words(10.0 / max(fall, 1.0 / record.sample_rate), 'Hz')} or more."
        )


def _smear(record: Record, cycles: xr.Dataset) -> Iterator[str]:
    sensor, fall = (record.sensors or {}).get("force"), _usual_fall(cycles)
    if sensor is not None and fall * sensor.cut_off < SHARP:
        yield (
            f"A fall of the force takes {in_words(fall, 's')}, and its sensor passes what is "
            f"slower than {in_words(sensor.cut_off, 'Hz')}: drops, slip speeds and the creep just "
            "before a slip are those of the smeared force. "
            f"Filter at {in_words(2.0 * SHARP / fall, 'Hz')} or more."
        )


def _drift(record: Record, kind: str, cycles: xr.Dataset) -> Iterator[str]:
    if kind not in (STICK_SLIP, TRANSITIONAL, HARMONIC, STEADY):
        return
    drift: Drift = find_drift(record, cycles)
    if drift.stands_out:
        late = drift.start > float(record.time[0])
        where = f"from {in_words(drift.start, 's')} on" if late else "in all"
        yield (
            f"The force drifts by {in_words(drift.rate, 'N/s')}, {in_words(drift.change, 'N')} "
            f"{where}, and friction coefficients with it. If it is the load cell, analyse "
            "st.analysis.detrend(record)."
        )


def _is_about_zero(friction: Friction, cycles: xr.Dataset) -> bool:
    """Return whether the mean friction is nearly nothing beside the swings, or the scatter."""
    mean = friction.kinetic
    if mean is None:
        return False
    swing = 0.5 * float(cycles["drop"].median()) if cycles.sizes["cycle"] else mean.spread
    return abs(mean.force) < ABOUT_ZERO * swing


def _zero(record: Record, friction: Friction, cycles: xr.Dataset) -> Iterator[str]:
    """Doubt the zero if a record begins unloaded, or reaches impossible values."""
    largest = largest_magnitude(record.force)
    if friction.kinetic is not None and _is_about_zero(friction, cycles):
        yield (
            f"The mean friction is about zero, {in_words(friction.kinetic.force, 'N')}: the zero "
            "of the force is off, as behind an amplifier that lets no constant force through; "
            "give zero=, the reading without load."
        )
        return
    if friction.kinetic is not None and friction.kinetic.force < 0.0:
        yield (
            f"The mean friction is {in_words(friction.kinetic.force, 'N')}, against the drive: the "
            "zero of the force is off, or its sign; give zero=, the reading without load."
        )
        return
    if friction.break_away is None or record.zero is not None:
        return
    some = record.force[: max(8, len(record) // 400)]
    noise = float(np.std(np.diff(some))) / 2.0**0.5
    first = float(some[0])
    plateau = float(np.ptp(some)) < max(NOISE * noise, 1e-9 * largest) * 2.0
    read = float(np.median(some)) if plateau else first
    if abs(read) > max(AT_REST * largest, NOISE * noise):
        turned = "; just after a turn of the drive it is not" if read < 0.0 else ""
        yield (
            f"The record begins before the first loading, at {in_words(read, 'N')}: if the spring "
            f"was unloaded, give zero='{read:.4g} N'{turned}."
        )
