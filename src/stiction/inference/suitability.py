"""Suitability of a record for a fit: refusals, and explanations of an unusual record."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import pi

import numpy as np

from stiction.analysis.assessment import imposed_reversal
from stiction.analysis.motion.changes.strokes import strokes
from stiction.analysis.motion.cycles import Swings
from stiction.analysis.motion.doubts.cycles import (
    doubt_cycles_apart,
    doubt_loading,
    doubt_mean_period,
)
from stiction.analysis.motion.doubts.hum import subtracted_lines
from stiction.analysis.motion.doubts.zero import ZERO
from stiction.analysis.motion.regime.evidence import Evidence, Regime
from stiction.analysis.motion.regime.kinds import SETTLING, STEADY, STUCK, UNDETERMINED
from stiction.analysis.motion.zero import ABOUT_ZERO
from stiction.analysis.record import Record
from stiction.analysis.signals.correlated_noise import ERRORS_95
from stiction.arrays import Floats
from stiction.errors import Instruction, ResultError
from stiction.inference.cycles import LEAST_CYCLES, Cycles
from stiction.recording.part import begin_and_end
from stiction.recording.strokes import by_strokes
from stiction.system.slider import Slider
from stiction.text.quantity.wording import in_words
from stiction.text.suggestion import Suggestion

ANALYSE = Instruction("stiction analyse", "st.analyse")
NO_CYCLES = (SETTLING, STEADY, STUCK)  # kinds of motion without stick-slip
# Evidence of swings that noise hides
IN_NOISE: tuple[Evidence, ...] = "hidden", "quick_falls"
OTHERWISE = 4.0 / 3.0  # times as many cycles, and one more that an end may cut, are others
QUICKLY = 0.25  # of a cycle: a force that rises so fast, and falls slowly, has the other sign


def refuse_far(record: Record, slider: Slider, name: str) -> None:
    """Refuse a record of a rig that was turned to 90 deg or more."""
    angle = slider.phi + (record.turned or 0.0)
    if abs(angle) >= 0.5 * pi:
        raise ResultError(
            f"{name} was turned by {in_words(record.turned or 0.0, 'rad')}, to a misalignment of "
            f"{in_words(angle, 'rad')}; it must lie between -90 and 90 deg"
        )


def refuse_other_motion(record: Record, regime: Regime, name: str) -> None:
    """Refuse a record without stick-slip, or with a drive or load that reverses.

    A run is refused too, though its slip speed alone decides its kind of motion.
    """
    turns = imposed_reversal(None, regime)
    if not turns and strokes(record) is not None:
        turns = "the force goes back and forth between both signs"
    if turns:
        raise ResultError(
            f"in {name} {turns}, and a fit takes a steady drive and a constant load; fit "
            f"{by_strokes(record.origin)}"
        )
    if regime.kind in NO_CYCLES:
        raise ResultError(
            f"{name} shows no stick-slip, of which a fit needs {LEAST_CYCLES} cycles: it is "
            f"{regime.kind}; `{ANALYSE}` tells what that says of friction"
        )
    if regime.kind == UNDETERMINED and regime.has(*IN_NOISE):
        raise ResultError(
            f"noise hides the cycles of {name}, of which a fit needs {LEAST_CYCLES}: measure with "
            f"less noise; `{ANALYSE}` tells what is seen of them"
        )


def refuse_few_cycles(name: str, count: int) -> None:
    """Refuse a record with too few cycles."""
    if count < LEAST_CYCLES:
        raise ResultError(
            f"{name} has {count} whole cycles of stick and slip, a fit needs {LEAST_CYCLES}; "
            "record for longer, or drive faster"
        )


def refuse_hidden(name: str, count: int, of: int) -> None:
    """Refuse a record of which too few cycles stand out from the rest of its force."""
    if count < LEAST_CYCLES:
        raise ResultError(
            f"of the {of} cycles of {name} only {count} stand out of what else the force does, as "
            f"where it drifts or has a slower wave; a fit needs {LEAST_CYCLES}: fit a part in "
            f"which the force keeps its level ({begin_and_end()})"
        )


def refuse_no_mean(name: str, force: Floats, cycles: Cycles) -> None:
    """Refuse a force whose mean is zero within the standard error of its cycles' mean.

    The bends of its loadings are those of an amplifier, and a fit would take them for creep.
    """
    peaks, troughs = force[cycles.peak], force[cycles.after]
    error = ERRORS_95 * float(np.std(peaks + troughs)) / 2.0 / len(peaks) ** 0.5
    swing = 0.5 * float(np.median(peaks - troughs))
    mean = float(np.mean(force[cycles.before[0] : cycles.after[-1]]))
    if abs(mean) < ABOUT_ZERO * swing + error:
        raise ResultError(
            f"the mean force of {name} is about zero, as no friction is. Behind an amplifier that "
            "lets no constant force through, loadings bend as if the mass crept, and a fit means "
            f"nothing: measure without it. If only the zero is off, give {ZERO}, the reading "
            "without load"
        )


def refuse_other_sign(name: str, force: Floats, cycles: Cycles) -> None:
    """Refuse a force of the opposite sign: most of its cycles rise within the share QUICKLY."""
    shares = (cycles.peak - cycles.before) / (cycles.after - cycles.before)
    if force.mean() <= 0.0 and np.median(shares) < QUICKLY:
        raise ResultError(
            f"the force of {name} falls slowly and rises fast: it is recorded with the other sign, "
            "in all likelihood; fit it with force=-force, or its file with "
            f"{Suggestion('force', '-1 N')}"
        )


def changes_within(seen: Swings, regime: Regime, until: float) -> tuple[str, ...]:
    """Return an analysis's warnings of cycles that differ until a time, s, as sentences.

    Simulated records have one velocity and one load, so that such a record is like none of them.
    """
    used = seen.lasting.part(seen.lasting["trough_time"] <= until)
    return (
        *subtracted_lines((), seen.ringing),
        *_name_other_motion(regime, until),
        *doubt_mean_period(used),
        *doubt_loading(used),
        *doubt_cycles_apart(used),
    )


def dispute(seen: Swings, troughs: Floats, name: str) -> str:
    """Return the warning that an analysis counts clearly more or fewer cycles than a fit, or ''.

    `troughs` (m + 1,) are the ends of the fit's cycles, s, first that before them. Counted are
    those that end in the time in which both see some.
    """
    theirs = np.append(seen.lasting["start"][:1], seen.lasting["trough_time"])
    begin, end = max(troughs[0], theirs[0]), min(troughs[-1], theirs[-1])
    counts = [int(((each > begin) & (each <= end)).sum()) for each in (theirs, troughs)]
    if max(counts) <= OTHERWISE * (min(counts) + 1):
        return ""
    return (
        f"In {in_words(float(end - begin), 's')} of {name} an analysis counts {counts[0]} cycles, "
        f"and the fit {counts[1]}: slips of different sizes merge, or noise splits them, and "
        f"nothing is concluded; fit a part whose slips are alike ({begin_and_end()})."
    )


def _name_other_motion(regime: Regime, until: float) -> Iterator[str]:
    changed, other = regime.evidence.get("changed_at", until), regime.runner_up
    if other and changed < until:
        at = in_words(changed, "s")
        yield f"The motion changes at {at}: one part is {regime.kind}, the other {other}."


def explain_unlike(changes: Sequence[Sequence[str]]) -> str:
    """Return possible reasons why records are unlike simulated ones, and the remedy; or ''.

    `changes` are the changes within each record, as sentences.

    >>> explain_unlike([(), ("At 3 s the force falls by 2 N.",)])[:63]
    'Cycles differ within the record, which may explain it. Record 2'
    """
    several = len(changes) > 1
    said = [
        f"{f'Record {number}: ' * several}{sentence}"
        for number, its in enumerate(changes, 1)
        for sentence in its
    ]
    if not said:
        return ""
    return (
        f"Cycles differ within the record, which may explain it. {' '.join(said)} Fit a part "
        f"whose cycles are alike by itself ({begin_and_end()})."
    )
