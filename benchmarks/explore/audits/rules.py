"""What must not contradict within an audit."""

from __future__ import annotations

import re
from collections.abc import Callable

import numpy as np

import stiction as st
from stiction.auditing import Audit
from stiction.auditing.simulated_test import OSCILLATES, SLIDES, final_state
from stiction.auditing.words.stick import VIBRATES
from stiction.linear_stability.linear import STABLE, UNSTABLE
from stiction.text.quantity.unit import registry

OFF = 0.5  # of a number that theory states without a doubt, by which the simulation may differ
SWINGS, FINE = 10.0, 200.0  # counted at first, and samples of each
COUNTED = 0.2  # of so many swings: they change, and one may begin before the count
PRINTED = 5e-3  # of a frequency, to three digits
TIMES = ("time until the first slip", "period, mean")
TOLD = re.compile(r"cycles of (.+?) in which the force falls by (.+?)\.(?: |$)")
NO_NUMBER = re.compile(r"\b(nan|inf)\b")


def sentences(found: Audit, title: str) -> str:
    """Return the sentences of a part of the report."""
    part = next(each for each in found.tables() if each.title == title)
    return " ".join(part.sentences)


def numbers(found: Audit) -> list[tuple[str, ...]]:
    """Return the rows of theory beside simulation."""
    table = found.tables()[1].table
    return [] if table is None else list(table.rows)


def verdict_answers_first(found: Audit) -> bool:
    """The verdict begins with whether it sticks; what is no artefact is not called one."""
    if not found.observation.run.status.ok:
        return True
    first = sentences(found, "Verdict").split(". ")[0]
    told = re.search(r"stick|rest|creep|[Vv]ibrates|too fast", first) is not None
    return told and (bool(found.slider.misalignment) or "artefact" not in first)


def verdict_and_margin(found: Audit) -> bool:
    """The stretch of misalignments that holds its own has the verdict of linear theory."""
    of = found.misalignment
    if found.sliding.verdict not in (STABLE, UNSTABLE) or of.neutral:
        return True
    place = sum(float(value) < found.slider.phi for value in of.values)
    return of.stable[place] == found.sliding.stable


def verdict_and_motion(found: Audit) -> bool:
    """Where a test shows other than linear theory says, the words say so."""
    words, slides = sentences(found, "Verdict"), found.sliding_on.comes_to
    if found.sliding.verdict == STABLE and slides == OSCILLATES:
        return "stable only to disturbances far below" in words
    if found.sliding.verdict == UNSTABLE and slides == SLIDES:
        return "does not last" in words or "in the time of the test" in words
    return True


def nothing_to_change(found: Audit) -> bool:
    """Nothing is to be changed only where it comes to slide from rest, and sliding is stable."""
    nothing = sentences(found, "What to change").startswith("Nothing: it slides steadily")
    calm = found.observation.comes_to == SLIDES and found.sliding.stable
    return nothing == (calm and not found.advices)


def numbers_in_words(found: Audit) -> bool:
    """Period and force drop in words are those of the table, within their errors."""
    shown = {row[0]: row[2] for row in numbers(found)}
    verdict = sentences(found, "Verdict").split("Without misalignment, all else as it is")[0]
    told = re.search(TOLD, verdict)
    cells = shown.get("period, mean", ""), shown.get("force drop, mean", "")
    return told is None or all(map(agree, told.groups(), cells))


def agree(words: str, cell: str) -> bool:
    """Return whether a value in words, perhaps with its error, is that of a cell."""
    value, _, error = words.partition(" ± ")
    if not error:
        return words == cell
    within, (_, unit) = registry().Quantity(error), error.split()
    return bool(abs(registry().Quantity(f"{value} {unit}") - registry().Quantity(cell)) <= within)


def vibration_is_no_creep(found: Audit) -> bool:
    """What vibrates about steady sliding does not creep."""
    words = sentences(found, "Is it stick?") + sentences(found, "Transverse oscillation")
    vibrates = found.observation.motion in VIBRATES
    return not (vibrates and ("creeping" in words or "During creep" in words))


def advice_works(found: Audit) -> bool:
    """What is advised slides steadily, by linear theory and from rest; words count it."""
    words = sentences(found, "What to change")
    works = [each for each in found.advices if each.works]
    none = words.startswith("None of these")
    stable = all(each.growth < 0.0 and each.tried.comes_to == SLIDES for each in works)
    return stable and none == bool(found.advices and not any(e.works for e in found.remedies))


def tried_is_a_change(found: Audit) -> bool:
    """What is said to be tried differs from what is."""
    return all(each.then != each.now for each in found.advices if each.tried)


def sliding_has_no_cycles(found: Audit) -> bool:
    """Where it comes to slide steadily, nothing is told of cycles and of slips before that."""
    words = str(found).replace("mean over cycles", "")
    told = any(each in words for each in ("each slip", "of each cycle", "in each cycle"))
    return not (told and found.observation.comes_to == SLIDES)


def dies_out_once(found: Audit) -> bool:
    """A second motion is no small disturbance that dies out: it comes to rest, or falls more."""
    seen = found.observation
    if not found.bistable:
        return True
    longer = st.simulate(
        found.slider, 4.0 * seen.run.samples["time"][-1], sample_rate=seen.record.sample_rate / 4.0
    )
    return final_state(longer, seen.growth) == OSCILLATES


def theory_without_doubt(found: Audit) -> bool:
    """A time that theory states without a mark is about what the simulation shows."""
    for name, theory, shown in numbers(found):
        if name not in TIMES or not theory or theory[0] == "~" or "none" in (theory, shown):
            continue
        expected, seen = (registry().Quantity(text).to("s").magnitude for text in (theory, shown))
        if abs(seen - expected) > OFF * max(seen, expected):
            return False
    return True


def swings_of_the_test(found: Audit) -> bool:
    """The first swings across the drive are those of a finer simulation, counted another way."""
    part = next(each for each in found.tables() if each.title == "Transverse oscillation")
    shown = found.to_dict()["transverse_oscillation"]["first"]
    if part.table is None or not shown:
        return part.table is None or not shown
    told = registry().Quantity(part.table.rows[0][1]).to("Hz").magnitude
    frequency = shown[0]["frequency"]["value"]
    rests = found.observation.run.stick_intervals
    begin = float(rests[np.argmax(np.diff(rests[:10], axis=1)), 1]) if len(rests) else 0.0
    lasts = begin + SWINGS / frequency
    run = st.simulate(found.slider, lasts, sample_rate=FINE * frequency)
    v_y = run.samples["v_y"][run.samples["time"] > begin]
    crossings = np.count_nonzero(np.diff(np.signbit(v_y - v_y.mean())))
    near = abs(0.5 * crossings / SWINGS - 1.0) < COUNTED
    return bool(near and abs(told / frequency - 1.0) < PRINTED)


def reads_well(found: Audit) -> bool:
    """No sentence and no cell holds what is no number."""
    return NO_NUMBER.search(str(found)) is None


RULES: tuple[Callable[[Audit], bool], ...] = (
    verdict_answers_first,
    verdict_and_margin,
    verdict_and_motion,
    nothing_to_change,
    numbers_in_words,
    vibration_is_no_creep,
    advice_works,
    tried_is_a_change,
    sliding_has_no_cycles,
    dies_out_once,
    theory_without_doubt,
    swings_of_the_test,
    reads_well,
)
