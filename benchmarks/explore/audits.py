"""``python -m benchmarks.explore.audits``: contradictions within audits of random rigs.

Each rig is audited, its page written, and what words, numbers, advice and linear theory say is held
against each other. Deterministic in its seed; exit status 1 if a rule is broken.
"""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from math import pi, sqrt
from time import process_time
from typing import Any, NamedTuple

import stiction as st
from benchmarks.explore.draw import Draw
from benchmarks.explore.systems.set_valued import LAWS as PLAIN
from benchmarks.explore.systems.set_valued import named_law
from stiction.auditing import Audit
from stiction.auditing.page import page
from stiction.auditing.simulated_test import OSCILLATES, SLIDES, final_state
from stiction.auditing.words.stick import VIBRATES
from stiction.linear_stability.linear import STABLE, UNSTABLE
from stiction.text.unit_text import registry

LAWS = (
    "exponential", "stribeck", "coulomb", "hyperbolic", "anisotropic", "table",
    "ageing", "slip", "two states", "lugre",
)  # fmt: skip
OFF = 0.5  # of a number that theory states without a doubt, by which the simulation may differ
TIMES = ("time until the first slip", "period, mean")
TOLD = re.compile(r"cycles of (.+?) in which the force falls by (.+?)\.(?: |$)")
NO_NUMBER = re.compile(r"\b(nan|inf)\b")


class Seen(NamedTuple):
    """What came of one audit: in a line, its time on a core (s), and the rules that it breaks."""

    number: int
    what: str
    seconds: float
    broken: tuple[str, ...]


def rig(seed: int, number: int) -> st.Slider:
    """Return a rig; its slip and its drive are drawn over decades, in units of a free swing."""
    draw = Draw(seed, number)
    mass, k_x, load = draw.decades(1e-2, 20.0), draw.decades(1e2, 1e6), draw.decades(0.5, 2e3)
    k_y, mu = k_x * draw.decades(0.5, 1e4), draw.between(0.1, 0.8)
    # a rig is loaded until the spring carries friction: 0.3 to 3000 swings later
    V = mu * load / sqrt(k_x * mass) / (2.0 * pi * draw.decades(0.3, 3000.0))
    angle = 0.0 if draw.chance(0.1) else draw.decades(0.1, 60.0) * draw.among((-1.0, 1.0, 1.0))
    dampers = [
        draw.decades(1e-3, 0.3) * 2.0 * sqrt(k * mass) if draw.chance(0.3) else 0.0
        for k in (k_x, k_y)
    ]
    return st.Slider(
        mass=mass,
        k_x=k_x,
        k_y=k_y,
        phi=f"{angle!r} deg",
        normal_load=load,
        c_x=dampers[0],
        c_y=dampers[1],
        friction=law(draw, mu, V, load),
        drive=st.ConstantVelocity(V),
    )


def law(draw: Draw, mu: float, V: float, load: float) -> Any:
    """Return a law of friction: weaker or stronger at speed, some with a peak at rest."""
    name = draw.among(LAWS)
    kinetic = mu * (draw.between(1.0, 1.3) if draw.chance(0.1) else draw.between(0.5, 1.0))
    speed = V * draw.decades(0.3, 100.0)
    peak = mu * draw.between(1.01, 1.4) if draw.chance(0.2) else 0.0
    if name in PLAIN:
        return named_law(draw, name, mu, kinetic, speed, peak)
    if name == "table":
        simple = st.ExponentialWeakening(mu, kinetic, speed, mu_static=peak)
        v = [0.0, *(speed * 10.0 ** (at / 4.0) for at in range(-8, 9))]
        return st.laws.Table(v=v, mu=[simple.coefficient(each) for each in v])
    if name == "lugre":
        sigma_0 = mu * load / draw.decades(1e-7, 1e-4)
        return st.laws.LuGre(kinetic, mu, speed, sigma_0, draw.decades(0.01, 1.0) * sqrt(sigma_0))
    a, D = draw.decades(2e-3, 2e-2), draw.decades(1e-6, 1e-4)
    b = a * draw.between(0.3, 2.0)
    if name == "two states":
        return st.laws.RateStateAgeing2(a, 0.5 * b, D, 0.5 * b, 10.0 * D, mu, V)
    kind = st.laws.RateStateAgeing if name == "ageing" else st.laws.RateStateSlip
    return kind(a, b, D, mu, V)


# --- what must not contradict -------------------------------------------------------------------


def sentences(found: Audit, title: str) -> str:
    """Return the sentences of a part of the report."""
    part = next(each for each in found.tables() if each.title == title)
    return " ".join(part.sentences)


def numbers(found: Audit) -> list[tuple[str, ...]]:
    """Return the rows of theory beside simulation."""
    table = found.tables()[1].table
    return [] if table is None else list(table.rows)


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
    told = re.search(TOLD, sentences(found, "Verdict"))
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
    return stable and none == bool(found.advices and not works)


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


def reads_well(found: Audit) -> bool:
    """No sentence and no cell holds what is no number."""
    return NO_NUMBER.search(str(found)) is None


RULES: tuple[Callable[[Audit], bool], ...] = (
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
    reads_well,
)


def look(seed: int, number: int) -> Seen:
    """Audit one rig, write its page, and hold it against the rules."""
    slider, begin = rig(seed, number), process_time()
    name = type(slider.law).__name__
    fractions: list[float] = []
    try:
        found = st.audit(slider, fractions.append)
        page(found, f"rig {number}")
    except Exception as error:
        return Seen(number, name, process_time() - begin, (f"{type(error).__name__}: {error}",))
    broken = [rule.__name__ for rule in RULES if not rule(found)]
    if fractions != sorted(fractions) or fractions[-1:] != [1.0]:
        broken.append("progress ends elsewhere than at 1")
    return Seen(number, f"{name}: {found!r}", process_time() - begin, tuple(broken))


def main() -> int:
    """Look at the rigs asked for; return the exit status."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.explore.audits")
    parser.add_argument("--rigs", type=int, default=40, help="how many")
    parser.add_argument("--seed", type=int, default=1, help="of all that is random")
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--only", type=int, metavar="NUMBER", help="print the audit of one rig")
    options = parser.parse_args()
    if options.only is not None:
        slider = rig(options.seed, options.only)
        print(slider.to_toml())
        print(st.audit(slider))
        return 0
    broken = 0
    with ProcessPoolExecutor(options.processes) as pool:
        for each in pool.map(partial(look, options.seed), range(options.rigs)):
            broken += len(each.broken)
            rules = "; ".join(each.broken)
            print(f"{each.number:4d} {each.seconds:6.1f} s  {each.what}  {rules}", flush=True)
    print(f"{options.rigs} rigs, {broken} rules broken")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
