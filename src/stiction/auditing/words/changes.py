"""Changes that make an apparatus slide steadily, in words and as a table."""

from __future__ import annotations

from math import isfinite
from typing import TYPE_CHECKING

from stiction.auditing.advice import Remedy, critical_damping, is_compliance
from stiction.auditing.pairs import ANGLES, FACTORS, Pair
from stiction.auditing.simulated_test import (
    CALM,
    MOST_WORK,
    OSCILLATES,
    SimulatedTest,
)
from stiction.auditing.words.stick import ROUGHLY
from stiction.auditing.words.verdict import (
    final_motion,
    settling,
    travel,
    where,
)
from stiction.text.quantity.wording import in_words, percent
from stiction.text.sections import Table

if TYPE_CHECKING:
    from stiction.auditing.report import Audit

ALMOST = 0.1  # of the present force drop: a change that leaves less is nearly a remedy
HEADINGS = "change", "now", "stable", "tried", "settles after", "travel", "from rest"
NAMES = {
    "phi": "misalignment φ",
    "drive.velocity": "drive velocity V",
    "c_x": "damping c_x",
    "k_x": "stiffness k_x",
    "k_y": "transverse stiffness k_y",
}


def changes(found: Audit) -> tuple[list[str], Table | None]:
    """Return changes that make it slide steadily, each with its simulation from rest."""
    if not found.advices:
        return ["Nothing: it slides steadily after the start."], None
    every = found.remedies
    rows = [
        _change(found, each) if isinstance(each, Remedy) else _change_of_two(found, each)
        for each in every
    ]
    goal = "take away the oscillation from rest" if found.bistable else "slide steadily"
    remedies = [
        f"{' with '.join(settings(found, each))} ({travel(each.tried)})"
        for each in every
        if each.works and each.tried
    ]
    undecided = any(each.tried and not each.tried.decided for each in every)
    none = f"None of these {'is seen to make' if undecided else 'makes'} it {goal}"
    what = f"To {goal}: {', or '.join(remedies)}" if remedies else none
    lines = [f"{what}. Each change was simulated from rest; the last columns show the result."]
    if remedies:
        lines.append(
            "The mildest change, by the factor, stands first. The travel is the way of the drive "
            f"until the speed stays within {percent(CALM)} of the drive's: a rig needs that much."
        )
    cut = [name_of(found, each.path) for each in every if each.cut]
    if cut:
        lines.append(
            f"Values farther from the present one were not tried of {', or '.join(cut)}: all "
            f"simulations of an audit together take no more than {MOST_WORK / 1e6:g} million steps "
            "and samples."
        )
    if found.bistable:
        lines.append(
            "Nothing has to be changed for a test that is started from steady sliding, as long as "
            "no disturbance stops the mass."
        )
    return lines, Table(HEADINGS, rows)


def name_of(found: Audit, path: str) -> str:
    """Return a parameter in words."""
    slider = found.slider
    if path == "phi" and slider.turn:
        return "phi in [slider]"
    for each in slider.springs:
        if path.startswith(f"springs.{each.slug}."):
            quantity = "" if is_compliance(path) else "stiffness "
            return f"{quantity}{path.rpartition('.')[2]} of the {each.name}"
    return NAMES[path]


def _change(found: Audit, advice: Remedy) -> tuple[str, ...]:
    name, now = name_of(found, advice.path), in_words(advice.now, advice.unit)
    if advice.tried is None:
        if advice.cut:
            return name, now, "", "none", "", "", "not tried"
        tried = "none"
        if advice.critical:
            tried = " to ".join(in_words(end, advice.unit) for end in advice.critical.between)
        return name, now, "nowhere", tried, "", "", "no value in that range"
    stable = where(advice.critical, True) if advice.critical else "now"
    then = in_words(advice.then, advice.unit)
    return name, now, stable, then, *_result(found, advice.tried, advice.works)


def settings(found: Audit, each: Remedy | Pair) -> list[str]:
    """Return the advised settings in words."""
    return [
        f"{name_of(found, of.path)} of {value_of(found, of.path, of.then, of.unit)}"
        for of in (each.changes if isinstance(each, Pair) else (each,))
    ]


def value_of(found: Audit, path: str, value: float, unit: str) -> str:
    """Return a parameter's value in words; a damper's with its damping ratio."""
    said = in_words(value, unit)
    if path != "c_x":
        return said
    ratio = in_words(value / critical_damping(found.slider), "", ROUGHLY)
    return f"{said}, a damping ratio of {ratio}"


def in_symbols(pair: Pair) -> str:
    """Return the two advised settings by their symbols, for the title of a figure."""
    symbols = (NAMES[each.path].rpartition(" ")[2] for each in pair.changes)
    values = (in_words(each.then, each.unit) for each in pair.changes)
    return ", ".join(f"{symbol} = {its}" for symbol, its in zip(symbols, values, strict=True))


def _change_of_two(found: Audit, pair: Pair) -> tuple[str, ...]:
    symbols = (NAMES[each.path].rpartition(" ")[2] for each in pair.changes)
    name = ", ".join(symbols) if pair.tried else f"φ, {_symbol(found, pair.path)}"
    if pair.tried is None:
        if pair.cut:
            return name, "", "", "none", "", "", "not tried"
        tried = f"to {ANGLES[-1]:g} deg and {FACTORS[-1]:g} times"
        return name, "", "nowhere", tried, "", "", "no values in that range"
    now, then = (
        ", ".join(in_words(value, each.unit) for each, value in zip(pair.changes, its, strict=True))
        for its in zip(*((each.now, each.then) for each in pair.changes), strict=True)
    )
    return name, now, "together", then, *_result(found, pair.tried, pair.works)


def _symbol(found: Audit, path: str) -> str:
    return name_of(found, path).rpartition(" ")[2]


def _result(found: Audit, seen: SimulatedTest, works: bool) -> tuple[str, str, str]:
    """Return time, travel and final motion of the simulation with a change."""
    if works:
        return (*settling(seen), final_motion(seen))
    if not seen.run.status.ok:
        end = in_words(float(seen.record.time[-1]), "s")
        return "", "", f"not known: the simulation was cut at {end}"
    if not seen.decided:
        return "", "", f"not decided: {final_motion(seen)}"
    what, drop = f"no remedy: {final_motion(seen)}", seen.mean("drop")
    if seen.comes_to == OSCILLATES and isfinite(drop):
        if drop < ALMOST * found.observation.mean("drop"):
            what = f"almost: {final_motion(seen)}"
        what += f", force drop {in_words(drop, 'N')}"
    return "", "", what
