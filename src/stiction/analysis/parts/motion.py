"""The motion of the mass, in a sentence that needs no theory."""

from __future__ import annotations

from math import inf
from typing import TYPE_CHECKING, Any

import numpy as np

from stiction.analysis.motion.changes.cycles import (
    cycles_apart,
    parts_of,
    sizes_in_turn,
    slip_in_each,
)
from stiction.analysis.motion.cycle_columns import mean_in_words, table_of
from stiction.analysis.motion.doubts.unsteady import turns_round
from stiction.analysis.motion.friction import BACKWARD
from stiction.analysis.motion.regime.evidence import TO_AND_FRO, Evidence
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
from stiction.analysis.motion.rest import comes_to_rest, stuck_share
from stiction.analysis.motion.vibration import COUPLED
from stiction.analysis.oscillation import stands_out
from stiction.analysis.signals.hum import of_mains
from stiction.arrays import xr
from stiction.formats.units import with_other_sign
from stiction.recording.origin import in_unit, use_of
from stiction.recording.strokes import by_strokes
from stiction.result.rest import longer
from stiction.storage.table_files import number
from stiction.text.quantity.wording import advice, in_words, percent, times, to_error, with_error
from stiction.text.sections import Section, first_sentence
from stiction.text.suggestion import Suggestion
from stiction.trajectory import Trajectory

if TYPE_CHECKING:
    from stiction.analysis.report import Analysis


ALIKE_DROPS = 0.1  # standard deviation of the drops over their mean
SLOW_SWING = 2.0  # times the mass's own period on its spring: a slower swing is not its own
IMPOSED: dict[Evidence, str] = {
    "unchanging": "The force is the same in all samples, as no measured force is: the channel is "
    "dead, or at an end of its range.",
    "forth": "The force goes back and forth between both signs, as where the drive does so.",
    "straight": "The force rises and falls evenly, as where a drive goes back and forth and the "
    "mass sticks, or the load changes so. No vibration has such a shape.",
    "driven": "The force rises and falls after jumps of the drive's velocity, as friction does "
    "then without stick-slip.",
    "levels": "The force stays at several levels, one after the other, as where the velocity of "
    "the drive, or the load, changes in steps while the mass slides. At a lower level it may "
    "rest, as where the drive has stopped.",
    "plateaus": "The force goes back and forth between two levels, as where the drive does so, or "
    "the load changes in steps.",
}


def find(found: Analysis) -> str:
    """Describe the motion in a sentence that needs no theory."""
    return (
        _describe_imposed_force(found)
        or _describe_cycles(found)
        or _describe_unclear_force(found)
        or _describe_course(found)
    )


def section(found: Analysis) -> Section:
    """Return the sentences after the plain one of the brief, and the evidence of the kind."""
    said = found.parts["motion"]
    more = said.removeprefix(first_sentence(said)).strip()
    grounds = f"Evidence: {found.regime.grounds}." if found.regime.evidence else ""
    return Section("Motion", [line for line in (more, grounds) if line])


def numbers(found: Analysis) -> dict[str, Any]:
    """Return the kind of motion and its evidence."""
    its = found.regime
    return {
        "regime": {
            "kind": its.kind,
            "confidence": number(its.confidence),
            "runner_up": its.runner_up or None,
            "evidence": {name: number(value) for name, value in its.evidence.items()},
        }
    }


def _describe_imposed_force(found: Analysis) -> str:
    """Describe a force that something other than friction shapes or changes; '' for others."""
    evidence, kind = found.regime.evidence, found.regime.kind
    if _drive_turns_round(found):
        return "The drive goes back and forth, and the force with it."
    if (mains := evidence.get("mains")) is not None:
        return (
            f"The force swings at {in_words(mains, 'Hz')}, as the mains do: either the mass "
            f"swings, or this is hum, and without it the motion is {found.regime.runner_up}."
        )
    if (change := evidence.get("changed_at")) is not None and found.regime.runner_up:
        return (
            f"The motion changes at {in_words(change, 's')}: one part is {kind}, the other "
            f"{found.regime.runner_up}. Analyse each by itself: means over both mean little."
        )
    name = next((name for name in IMPOSED if name in evidence), None)
    if name in TO_AND_FRO:
        loops = "Of a run, or with the position, st.analysis.hysteresis gives the loops."
        return f"{IMPOSED[name]} {other_reading(found)} {loops}"
    return IMPOSED[name] if name else ""


def other_reading(found: Analysis) -> str:
    """Return how the file should be analysed instead, where its force asks for that; else ''."""
    if found.regime.has(*TO_AND_FRO) and not _drive_turns_round(found):
        return f"Analyse {by_strokes(found.record.origin)}."
    if _seems_reversed(found):
        return f"Analyse {_with_other_sign(found)}."
    return ""


def _drive_turns_round(found: Analysis) -> bool:
    """Return whether the drive of a run goes back and forth."""
    return isinstance(found.source, Trajectory) and turns_round(found.source)


def _seems_reversed(found: Analysis) -> bool:
    """Return whether a record's force has the other sign, in all likelihood."""
    if isinstance(found.source, Trajectory):
        return False
    backward = found.regime.evidence.get("backward", 0.0) > BACKWARD
    return found.regime.has("against") or (backward and float(found.record.force.mean()) <= 0.0)


def _describe_cycles(found: Analysis) -> str:
    """Describe cycles: how often they come, and by how much the force drops; '' without any."""
    count = found.cycles.sizes["cycle"]
    if not count:
        return ""
    drop, period = (mean_in_words(found.summary, name) for name in ("drop", "period"))
    times = {1: "once", 2: "twice"}.get(count, f"{count} times") + _after_first(found)
    every = f", every {_period(found.cycles, period)}" if count > 1 else ""
    share = _stick_share(found)
    plain = {
        STICK_SLIP: f"The mass sticks and slips {times}{every}{share}",
        TRANSITIONAL: f"The mass slips {times}{every}, between stick-slip and plain vibration",
        HARMONIC: f"The {_swinging(found)} swings {times}{every}{share}",
        TRANSVERSE: f"The mass oscillates across the drive {times}{every}{share}",
        IRREGULAR: f"The mass vibrates irregularly {times}{every}",
    }.get(found.regime.kind)
    if plain is None:
        return ""
    falls = f"the force drops by {drop}{_each_time(found)}."
    more = f"{_why_transverse(found)}{_not_its_own(found)}{_on_a_wave(found)}"
    return f"{plain}; {falls}{_once_more(found)}{more}"


def _after_first(found: Analysis) -> str:
    """Return that cycles are counted from the end of a run's first slip, if it has one before."""
    run = found.source
    if not isinstance(run, Trajectory) or found.regime.kind != STICK_SLIP:
        return ""
    return " after the first slip" if found.friction.break_away is not None else ""


def _period(cycles: xr.Dataset, mean: str) -> str:
    """Return the period in words: its mean, or the range of parts that have their own."""
    period = cycles["period"].values
    own = sorted(float(np.median(period[part])) for part in parts_of(period))
    if len(own) < 2:
        return mean
    return f"{in_words(own[0], 's')} to {in_words(own[-1], 's')}, as the velocity or load changes"


def _describe_unclear_force(found: Analysis) -> str:
    """Describe a motion that noise hides, or whose force may have the other sign; '' for others."""
    evidence = found.regime.evidence
    if found.regime.runner_up == STICK_SLIP and found.regime.has("quick_falls"):
        fall = in_words(evidence["quick_fall"], "N", 2)
        return (
            f"The mass probably sticks and slips, in noise that hides its cycles: the force falls "
            f"quickly {evidence['quick_falls']:.0f} times, by about {fall}, and hardly ever rises "
            "so quickly. Measure with less noise."
        )
    if found.regime.kind == UNDETERMINED and found.regime.has("hidden"):
        swings, by = in_words(evidence["hidden"], "Hz"), in_words(evidence["hidden_height"], "N")
        return (
            f"Noise hides what the mass does. By its spectrum the force swings at {swings}, by "
            f"{by} from crest to trough: average neighbouring samples, or measure with less noise."
        )
    if found.regime.has("late_sticks"):
        return (
            "The mass sticks and slips, too often for so few samples to show it: sample the run at "
            f"{advice(evidence['rate_needed'], 'Hz')} or more."
        )
    against = found.regime.has("against")
    if evidence.get("backward", 0.0) <= BACKWARD and not against:
        return ""
    fast = "The force falls slowly and rises fast"
    if isinstance(found.source, Trajectory):
        return f"{fast}, as where the drive pauses or changes its velocity."
    if _seems_reversed(found):
        its = "The force is against the drive in all cycles" if against else fast
        return (
            f"{its}: it is recorded with the other sign, in all likelihood. {other_reading(found)}"
        )
    return (
        f"{fast}: as where holds interrupt the sliding, or it is recorded with the other sign "
        f"and an untared zero; then analyse {_with_other_sign(found)}, and state the zero "
        f"({Suggestion('zero')})."
    )


def _with_other_sign(found: Analysis) -> str:
    """Return how the same force is read with the other sign."""
    use = use_of(found.record.origin, "force")
    if use is None:
        return f"it with force=-force, or a file with {Suggestion('force', '-1 N')}"
    return f"the file with {in_unit(use, with_other_sign(use.unit))}"


def _describe_course(found: Analysis) -> str:
    """Describe a motion by the course of its force."""
    slides = found.friction.kinetic
    at = (
        f", at a force of {to_error(slides.force, slides.error, 'N')}" if slides is not None else ""
    )
    plain = {
        STEADY: f"{_slides(found.regime.evidence, at)}{_besides(found)}",
        SETTLING: f"{_settles(found, at)}{_besides(found)}",
        STUCK: _sticks(found),
        TRANSVERSE: f"The slow motion settles{at}; the mass oscillates across the drive.",
        IRREGULAR: "The mass vibrates irregularly.",
    }
    return plain.get(found.regime.kind, _begins_to_slip(found))


def _begins_to_slip(found: Analysis) -> str:
    """Describe a single slip, or a loading that ends in a fall; else say that nothing is known."""
    evidence = found.regime.evidence
    if found.regime.has("slips_at"):
        at = in_words(evidence["slips_at"], "s")
        by = with_error(evidence["slips_by"], evidence["slips_by_error"], "N")
        return (
            f"The mass sticks, slips once, at {at}, and sticks again, unless the drive turns back "
            f"or the zero jumps there: the force drops by {by} within "
            f"{in_words(evidence['slips_within'], 's')}. A single slip makes no cycle."
        )
    begin = evidence.get("ends_falling_from")
    if begin is None:
        return "This record does not show what the mass does."
    fall = in_words(evidence["ends_falling_by"], "N")
    turns = "" if isinstance(found.source, Trajectory) else ", or the drive turns back"
    return (
        f"The force rises until {in_words(begin, 's')}, then falls by {fall} or more until the "
        f"record ends: the mass begins to slip{turns}."
    )


def _sticks(found: Analysis) -> str:
    """Describe a mass that does not slip, as far as its record shows it."""
    if found.regime.has("rests"):
        return "The mass rests from beginning to end: friction holds it."
    if found.regime.runner_up == STEADY:
        return "The force only rises: either the mass sticks, or it slides and the force drifts."
    run, remedy = found.source, ""
    if (
        isinstance(run, Trajectory)
        and run.slider.drive_speed > 0.0
        and run.description.run.duration < run.slider.loading_time
    ):
        remedy = f"; {longer(run.slider)}"
    return f"The mass does not slip, it rests or creeps: the force only rises{remedy}."


def _swinging(found: Analysis) -> str:
    """Return the part that is known to swing: the mass, or only the force, as friction may, too."""
    period = found.regime.evidence.get("natural_period", inf)
    return "mass" if COUPLED <= period <= SLOW_SWING else "force"


def _not_its_own(found: Analysis) -> str:
    """Return other possible sources of a swing at another rate than the mass on its spring."""
    if found.regime.kind != HARMONIC or isinstance(found.source, Trajectory):
        return ""
    period = found.regime.evidence.get("natural_period", 1.0)
    if COUPLED <= period <= SLOW_SWING:
        return ""
    if period < COUPLED:
        return (
            f" The mass on its spring takes {times(1.0 / period, 3)} as long: this is the "
            "transverse oscillation, hum, or the load cell's own vibration, unless mass or "
            "stiffness are not as stated."
        )
    return (
        f" The mass on its spring would do so {times(period, 3)} as quickly: friction, load or "
        "drive change so."
    )


def _on_a_wave(found: Analysis) -> str:
    """Return that a slower wave carries the cycles, if it does so."""
    wave = found.regime.evidence.get("wave")
    if wave is None:
        return ""
    period = found.regime.evidence.get("wave_period")
    every = f", every {in_words(period, 's')}," if period is not None else ","
    return (
        f" It does so on a slower wave of {in_words(wave, 'N')} from crest to trough{every} as of "
        "a disc that turns askew, or a load that varies."
    )


def _settles(found: Analysis, at: str) -> str:
    """Describe the part that dies down or settles, and the motion of the mass then."""
    evidence = found.regime.evidence
    if comes_to_rest(found.record.slip_speed):
        return "The motion dies down, and the mass comes to rest."
    swings = found.regime.has("swings", "over")
    if found.friction.break_away is not None and not swings:
        return f"The mass breaks away once, and comes to slide steadily{at}."
    if swings or found.regime.has("fading") or evidence.get("change", 0.0) >= 0.0:
        what = "force settles" if found.regime.has("late_share") else "vibration dies down"
        return f"The {what}, and the mass comes to slide steadily{at}."
    if found.record.slip_speed is not None:
        return f"The force settles, and the mass comes to slide steadily{at}."
    return (
        f"The force falls and settles{at}: there the mass slides steadily, or it rests, as where "
        "the drive has stopped."
    )


def _slides(evidence: dict[Evidence, float], at: str) -> str:
    """Describe steady sliding, as far as its record shows it."""
    if (span := evidence.get("wanders")) is not None:
        return (
            f"The force wanders by {in_words(span, 'N')}{at.replace('at', 'about', 1)}: the mass "
            "slides while its friction changes, or it sticks and slips more slowly than this "
            "record shows."
        )
    if (fall := evidence.get("falls_by")) is not None:
        when = in_words(evidence["falls_at"], "s")
        return (
            f"The mass slides steadily{at}; but once, at {when}, the force falls by "
            f"{in_words(fall, 'N')}: a single slip, or a knock."
        )
    return f"The mass slides steadily{at}."


def _besides(found: Analysis) -> str:
    """Return the frequency of a further swing of the force, if its spectrum shows one."""
    evidence, seen = found.regime.evidence, found.oscillation
    if found.regime.has("hidden"):
        swings, height = in_words(evidence["hidden"], "Hz"), evidence["hidden_height"]
        return (
            f" Besides, the force swings at {swings}, by {in_words(height, 'N')} from crest to "
            "trough, which noise hides."
        )
    if isinstance(found.source, Trajectory) or not stands_out(seen):
        return ""
    frequency, share = seen["frequency"].values, np.isfinite(seen["frequency"].values)
    middle, height = float(np.median(frequency[share])), float(np.median(seen["amplitude"][share]))
    if of_mains(middle):
        return ""
    return (
        f" Besides, in {percent(float(share.mean()))} of the time the force swings at about "
        f"{in_words(middle, 'Hz')}, by {in_words(2.0 * height, 'N')} from crest to trough."
    )


def _each_time(found: Analysis) -> str:
    """Return whether the force drops by so much each time, in turn, or between which values."""
    drop = found.cycles["drop"].values
    if len(drop) == 1:
        return ""
    if (sizes := sizes_in_turn(drop)) is not None:
        large, small = (in_words(each, "N") for each in sizes)
        return f" on average, by about {large} and {small} in turn"
    if not isinstance(found.source, Trajectory):
        drop = drop[~cycles_apart(table_of(found.cycles))]
    if drop.std() < ALIKE_DROPS * drop.mean():
        return " each time"
    low, high = (in_words(float(end), "N") for end in (drop.min(), drop.max()))
    return f" on average, at least {low} and at most {high}"


def _once_more(found: Analysis) -> str:
    """Return that the force falls once more in nearly each cycle, as by slips of two sizes."""
    less = slip_in_each(table_of(found.cycles))
    if found.regime.kind != STICK_SLIP or less is None:
        return ""
    return (
        f" Within nearly each cycle it falls once more, by about {in_words(less, 'N', 2)}: large "
        "and small slips alternate, or the mass hesitates, or a load cell swings after each slip."
    )


def _stick_share(found: Analysis) -> str:
    """Return how long a run sticks in its cycles, or '' for a record, and if it creeps too."""
    run, ends = found.source, found.cycles
    if not isinstance(run, Trajectory) or found.regime.loads:
        return ""
    begin, end = float(ends["start"][0]), float(ends["trough_time"][-1])
    share = stuck_share(begin, end, run.stick_intervals)
    return f", and sticks for {percent(share)} of that time" if share else ", without sticking"


def _why_transverse(found: Analysis) -> str:
    """Return why cycles of a run belong to both springs; nothing for other cycles."""
    own = found.record.own_period
    if found.regime.kind != TRANSVERSE or own is None:
        return ""
    return (
        f" That is quicker than the {in_words(own, 's')} in which it swings on the spring along x "
        "alone: the transverse spring takes part."
    )
