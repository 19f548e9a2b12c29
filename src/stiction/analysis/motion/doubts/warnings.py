"""Warnings about a record whose numbers contradict each other."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import log10, pi

import numpy as np

from stiction.analysis.measurement.run_record import across_force
from stiction.analysis.motion.changes.initial_rest import InitialRest
from stiction.analysis.motion.changes.mean_load import FollowedLoad
from stiction.analysis.motion.changes.ringing import Ringing
from stiction.analysis.motion.cycle_columns import CycleTable
from stiction.analysis.motion.doubts.clipping import doubt_clipping
from stiction.analysis.motion.doubts.cycles import (
    doubt_cycles_apart,
    doubt_drops_in_noise,
    doubt_loading,
    doubt_mean_period,
    doubt_quiet,
)
from stiction.analysis.motion.doubts.load_cell import doubt_ringing
from stiction.analysis.motion.doubts.sampling import (
    doubt_few_samples,
    doubt_filter,
    doubt_repeats,
    doubt_slips_between_samples,
    doubt_times,
)
from stiction.analysis.motion.doubts.units import (
    LARGEST_MU,
    NEAR_RATE,
    TINY_MU,
    Numbers,
    ask_units,
    likely_changes,
    numbers_of,
)
from stiction.analysis.motion.doubts.zero import doubt_zero, is_about_zero, shift_of_zero
from stiction.analysis.motion.drift import WORTH, Drift, is_shown, shift_of_drift
from stiction.analysis.motion.friction import Friction
from stiction.analysis.motion.load_cell.free_swings import RingingCell
from stiction.analysis.motion.load_cell.swings import CellSwings
from stiction.analysis.motion.metadata.loading_rate import LOADING_RATE
from stiction.analysis.motion.metadata.quantity import StatedQuantity
from stiction.analysis.motion.metadata.stiffness_over_mass import SWING
from stiction.analysis.motion.regime.kinds import (
    HARMONIC,
    SETTLING,
    STEADY,
    STICK_SLIP,
    TRANSITIONAL,
)
from stiction.analysis.record import Record
from stiction.analysis.signals.clipping import FlatEnd
from stiction.analysis.signals.correlated_noise import ERRORS_95, standard_error
from stiction.analysis.signals.hum import Line, of_mains
from stiction.analysis.signals.robust import largest_magnitude
from stiction.system.load_cell import ACROSS
from stiction.text.quantity.wording import in_words, percent, times
from stiction.text.suggestion import Suggestion
from stiction.trajectory import Trajectory

NEAR_MASS = log10(5.0) / 6.0  # k/m within a factor of 5 of a million is that of another unit
VARIES = 0.05  # of the mean of a measured load: less is not worth a sentence
IMPOSED = {"drive": ("drive_X", "drive_Y"), "load": ("normal_load",)}  # columns of a run
STIRS = 0.01  # of the drive's largest speed: more backwards is a motion to and fro
QUICKER = 2.0  # times k/m: so quick a vibration may be that of both springs


def warnings(
    record: Record,
    kind: str,
    cycles: CycleTable,
    friction: Friction,
    stated: Sequence[StatedQuantity],
    drift: Drift,
    ends: Sequence[FlatEnd],
    rings: CellSwings | None,
    zero: InitialRest | None,
    load: FollowedLoad | None,
) -> tuple[str, ...]:
    """Return warnings as sentences, the most important first.

    These are of numbers that cannot be true, then those that shift friction, then those of cycles
    and samples. `stated` is what was compared, `drift` that of the force, sure or not, `ends` where
    it is cut off, `rings` the swings of the load cell, `zero` the one that the record shows,
    `load` the one that the force follows.
    """
    seen = numbers_of(_largest_mu(friction, cycles), stated)
    wrong = {each.quantity: each for each in stated if each.agrees is False}
    found = [
        *_doubt_load(record, load),
        *_implausible_friction(record, seen),
        *doubt_clipping(ends),
        *doubt_mean_period(cycles),
        *(doubt_loading(cycles) if kind in (STICK_SLIP, TRANSITIONAL) else ()),
        *_loading(record, [x for x in stated if x.quantity == LOADING_RATE], seen),
        *_mass(record, wrong.get(SWING), kind, seen),
        *_mains(kind, cycles),
        *_shifts(record, kind, cycles, friction, drift, rings, zero),
        *doubt_cycles_apart(cycles),
        *doubt_quiet(record, friction, cycles),
        *doubt_few_samples(record, cycles),
        *doubt_filter(record, cycles),
        *doubt_drops_in_noise(record, kind, cycles),
        *doubt_times(record),
        *doubt_repeats(record),
    ]
    return tuple(found)


def _shifts(
    record: Record,
    kind: str,
    cycles: CycleTable,
    friction: Friction,
    drift: Drift,
    rings: CellSwings | None,
    zero: InitialRest | None,
) -> list[str]:
    """Return the doubts about a force that is shifted, the one by most first."""
    found = [
        (
            shift_of_zero(record, friction, cycles, zero),
            doubt_zero(record, friction, cycles, zero),
        ),
        (shift_of_drift(drift, record.duration), _drift(record, drift, kind, cycles)),
        (0.0 if rings is None else rings.shift, doubt_ringing(rings)),
    ]
    return [each for _, said in sorted(found, key=lambda its: -its[0]) for each in said]


def subtracted_lines(
    lines: tuple[Line, ...], ringing: Ringing | None, cell: RingingCell | None = None
) -> tuple[str, ...]:
    """Return a sentence for each line, ringing, and load cell taken out of the force."""
    found = []
    if cell is not None:
        found.append(
            f"After each slip the force swings at {in_words(cell.frequency, 'Hz')} and fades, with "
            f"a quality factor of {cell.quality:.2g}, as where the load cell rings: cycles, "
            "friction and creep are those of the force to which such a cell answers."
        )
    if ringing is not None:
        lasts = in_words(ringing.end - ringing.begin, "s")
        found.append(
            f"From {in_words(ringing.begin, 's')} on, for {lasts}, the force rings by up to "
            f"{in_words(ringing.height, 'N')}, less and less, as after a knock, or where cycles "
            "end: there a straight line replaced it before the search for cycles."
        )
    for line in lines:
        hum = ", probably mains hum," if of_mains(line.frequency) else ""
        found.append(
            f"A line at {in_words(line.frequency, 'Hz')} with an amplitude of "
            f"{in_words(0.5 * line.height, 'N')}{hum} was subtracted from the force: cycles "
            "are sought in the rest."
        )
    return tuple(found)


def _doubt_load(record: Record, load: FollowedLoad | None) -> Iterator[str]:
    """Say that a measured load varies, and which analysis suits it."""
    varies = record.load_variation()
    if load is not None:
        yield (
            f"The normal load varies by {percent(varies)} of its mean, and the force follows it, "
            f"by {load.slope:.3g} of it: kind of motion, cycles and their forces are those under "
            "the mean load. Coefficients of friction are force over load at the same instant."
        )
    elif varies > VARIES:
        yield (
            f"The normal load varies by {percent(varies)} of its mean. Coefficients of "
            "friction are force over load at the same instant; kind of motion, cycles and forces "
            "are those of a steady test, which this is not; st.analysis.load_dependence suits such "
            "a test."
        )


def warnings_of_run(
    run: Trajectory, record: Record, kind: str, cycles: CycleTable
) -> tuple[str, ...]:
    """Return warnings about the samples of a run; its parameters are exact."""
    return (
        *_ended_early(run),
        *([f"The load cell {ACROSS}."] if across_force(run, record) else []),
        *say_unsteady(run, kind),
        *doubt_few_samples(record, cycles),
        *doubt_slips_between_samples(record, cycles),
    )


def _ended_early(run: Trajectory) -> tuple[str, ...]:
    """Return a sentence if a run did not reach its duration, and why."""
    if run.status.ok:
        return ()
    end, whole = float(run.final.time), run.description.run.duration
    return (
        f"The run ended early, at {in_words(end, 's')} of {in_words(whole, 's')}: "
        f"{run.status.value}.",
    )


def say_unsteady(run: Trajectory, kind: str) -> tuple[str, ...]:
    """Return a sentence if the drive or the load of a run varies, and which analysis suits it.

    It is needless where that analysis found its test.
    """
    varies = variations(run)
    if not varies:
        return ()
    remedy = "st.analysis.velocity_steps, healing or hysteresis suit such a test"
    if varies == ["load"]:
        remedy = "st.analysis.load_dependence suits such a test"
    if turns_round(run):
        remedy = "st.analysis.hysteresis gives the loops of force over travel"
    elif kind == STICK_SLIP and "drive" in varies:  # whose parts show no steady friction, either
        remedy = "the table of cycles has each by itself"
    return (
        f"The {' and the '.join(varies)} {'varies' if len(varies) == 1 else 'vary'}: kind of "
        f"motion, cycles and friction are those of a steady test, which this is not; {remedy}.",
    )


def variations(run: Trajectory) -> list[str]:
    """Return the varying quantities of a run, drive or load or both, in words."""
    return [name for name, of in IMPOSED.items() if any(np.ptp(run.samples[x]) > 0.0 for x in of)]


def turns_round(run: Trajectory) -> bool:
    """Return whether the drive of a run goes both ways; a stage at rest may stir a little."""
    along = run.samples["drive_X"]
    least = STIRS * float(np.abs(along).max(initial=0.0))
    return bool(along.min() < -least and along.max() > least)


def _mains(kind: str, cycles: CycleTable) -> Iterator[str]:
    """Doubt a vibration at the mains frequency: nothing distinguishes it from hum."""
    if kind != HARMONIC or not len(cycles):  # the spectrum alone may show a vibration
        return
    lasts = float(cycles["trough_time"][-1] - cycles["start"][0])
    frequency = len(cycles) / lasts
    if of_mains(frequency):
        yield (
            f"The force swings at {in_words(frequency, 'Hz')}, as the mains do. Record it with the "
            "drive at rest: if it swings then, that is hum, and the mass slides steadily."
        )


def _largest_mu(friction: Friction, cycles: CycleTable) -> float:
    """Return the largest friction coefficient; NaN if none is known, or the force is about zero."""
    known = [each for each in friction[:3] if each is not None]
    mu = max((abs(each.coefficient) for each in known), default=np.nan)
    return np.nan if mu < TINY_MU and is_about_zero(friction, cycles) else mu


def _implausible_friction(record: Record, seen: Numbers) -> Iterator[str]:
    mu = seen.mu
    if TINY_MU <= mu <= LARGEST_MU or not np.isfinite(mu):
        return
    load = in_words(record.normal_load or 0.0, "N")
    asked = ask_units(record, likely_changes(seen), lambda change: "force" in change)
    its = "".join(f"{each}; or " for each in asked)
    yield f"A friction coefficient of {mu:.3g} is implausible: {its}check the normal load, {load}."


def _loading(record: Record, its: Sequence[StatedQuantity], seen: Numbers) -> Iterator[str]:
    """Doubt the rate of loading as stated, by the whole record or by the parts of a change."""
    good = [each for each in its if each.agrees]
    if good:
        others = [each for each in its if each.agrees is None and each.part]
        found = [
            f"{each.part} at {in_words(each.found, 'N/s')}, "
            f"{times(each.found / good[0].stated, 3)} that"
            for each in others
        ]
        if found:
            when = " and ".join(each.part for each in good).capitalize()
            latter = "the latter by itself" if len(found) == 1 else "each other part by itself"
            yield (
                f"{when} the force rises with stiffness times drive velocity as stated, "
                f"{in_words(good[0].stated, 'N/s')}; {', '.join(found)}: "
                "what needs the velocity is given of the former only. Analyse "
                f"{latter}, with its own velocity."
            )
        return
    for each in its:
        if each.agrees is False:
            yield (
                f"{f'{each.part} the'.strip().capitalize()} force rises at "
                f"{in_words(each.found, 'N/s')}, {times(each.ratio, 3)} stiffness times "
                f"drive velocity as stated, {in_words(each.stated, 'N/s')}: "
                f"{_remedy(record, seen._replace(rate=each.ratio))}."
            )


def _remedy(record: Record, seen: Numbers) -> str:
    """Return the likely causes of a rate that is so many times as large as stated."""
    power = round(log10(seen.rate) / 3.0) if seen.rate > 0.0 else 0
    if power == 0 or abs(log10(seen.rate) - 3.0 * power) > NEAR_RATE:
        return "check stiffness and drive velocity, or the gain of the load cell"
    wrong = f"{1000 ** abs(power)} times too {'large' if power < 0 else 'small'}"
    stated = f"stiffness or drive velocity is stated {wrong}"
    asked = ask_units(record, likely_changes(seen))
    return f"{'; '.join(asked)}; or {stated}" if asked else stated


def _mass(record: Record, its: StatedQuantity | None, kind: str, seen: Numbers) -> Iterator[str]:
    """Doubt k/m if the period of a swing, or the duration of a slip, contradicts it."""
    if its is None:
        return
    lasts = 2.0 if kind == HARMONIC else 1.0
    yield (
        f"By the {its.how} ({in_words(lasts * pi / its.found**0.5, 's')}), "
        f"stiffness over mass is {times(its.ratio)} {in_words(its.stated, '1/s²', 3)}, as stated: "
        f"{_remedy_of_mass(record, its.ratio, kind, seen)}."
    )


def _remedy_of_mass(record: Record, ratio: float, kind: str, seen: Numbers) -> str:
    """Return the likely cause of a k/m that is `ratio` times as large as stated."""
    changes = likely_changes(seen._replace(swing=ratio))
    asked = ask_units(record, changes, lambda change: "time" in change)
    power = float(log10(ratio) / 6.0)
    nearest = round(power)
    if asked and nearest and abs(power - nearest) < NEAR_MASS:
        return f"{'; '.join(asked)}; or check mass and stiffness"
    if kind == HARMONIC and ratio > QUICKER:
        return (
            "check mass and stiffness; or the transverse spring swings as well, as friction that "
            "turns makes it"
        )
    if ratio > 1.0:
        motion = "swing" if kind == HARMONIC else "slip"
        return (
            f"check mass and stiffness; or a {motion} strains the transverse spring as well, as at "
            "a misalignment of some degrees"
        )
    if kind == HARMONIC:
        return "check mass and stiffness"
    return (
        "check mass and stiffness; or a low-pass filter, as of an amplifier, draws slips out and "
        "smears peaks and troughs: give its cut-off (sensors); or friction that weakens slowly "
        "makes slips last"
    )


def _settling(record: Record, drift: Drift, kind: str) -> Iterator[str]:
    """Warn that a zero may settle while a mass slides, which the force alone cannot show."""
    if kind in (STEADY, SETTLING) and drift.shared > WORTH * largest_magnitude(record.force):
        yield (
            f"While the mass slides, the force settles by {in_words(drift.shared, 'N', 2)}. The "
            "errors of friction allow for a zero of the load cell that does so. A record without "
            "contact would show it."
        )


def _drift(record: Record, drift: Drift, kind: str, cycles: CycleTable) -> Iterator[str]:
    """Doubt the load cell where the force drifts, unless it follows a load that varies."""
    if record.load_variation() > VARIES:
        return
    if drift.stands_out and is_shown(drift, kind):
        late = drift.start > float(record.time[0])
        rate, begin = in_words(drift.rate, "N/s"), in_words(drift.start, "s")
        where = f"from {begin} to {in_words(drift.end, 's')}" if late else "in all"
        remedy = (
            f"analyse the parts before and after {begin} by themselves "
            f"({Suggestion('end', of='')}, {Suggestion('begin')})"
            if late
            else f'state zero_drift = "{rate}" under [sensors.force] in the file beside the record'
        )
        yield (
            f"The force drifts by {rate}, {in_words(drift.change, 'N')} {where}, and friction "
            f"coefficients with it. If it is the load cell, {remedy}; in Python, analyse "
            "st.analysis.detrend(record)."
        )
    elif not len(cycles):
        yield from _settling(record, drift, kind)
    elif not drift.stands_out:
        yield from _shared_change(drift, cycles, float(record.time[-1] - record.time[0]))


def _shared_change(drift: Drift, cycles: CycleTable, lasts: float) -> Iterator[str]:
    """Say that peaks and troughs, of cycles that last so long (s), may change with the zero."""
    worth = WORTH * abs(float(cycles["peak"].mean()))
    if abs(drift.likely) * lasts > worth:
        yield (
            f"Peaks and troughs change alike, by {in_words(drift.likely, 'N/s', 2)}: "
            f"{len(cycles)} cycles cannot tell whether by chance. The errors of friction allow for "
            "a zero of the load cell that drifts so; a record without contact would show it."
        )
    elif drift.shared > max(0.5 * worth, ERRORS_95 * standard_error(cycles["peak"])):
        yield (
            "Peaks and troughs change alike, but not steadily. The errors of friction allow for a "
            "zero of the load cell that does so, as where it settles. Then forces are off by about "
            f"{in_words(drift.shared, 'N', 2)} on average. A record without contact would show it."
        )
