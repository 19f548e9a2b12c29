"""What a measured record says of its own apparatus, beside what is stated."""

from __future__ import annotations

from collections.abc import Mapping
from math import isfinite, isnan
from typing import TYPE_CHECKING, Any

from stiction.analysis.motion.metadata import (
    BY_RISE,
    BY_SLIPS,
    LOADING_RATE,
    SWING,
    StatedQuantity,
)
from stiction.analysis.parts.wording import number
from stiction.analysis.signals.correlated_noise import ERRORS_997
from stiction.arrays import xr
from stiction.text.sections import Section, Table
from stiction.text.units import in_words, times, with_error

if TYPE_CHECKING:
    from stiction.analysis.report import Analysis

ALLOWED = "possible"  # not the same, but the record gives a bound only, or a rough value
NUMBERS = ("found", "error", "stated", "ratio")
TOLD = (SWING, LOADING_RATE)  # among the warnings
ROUGH = {  # why a value may be farther from the truth than its error says
    BY_SLIPS: (
        "Stiffness over mass by the motion is rough, its error is that of the scatter alone: "
        "friction that changes with speed makes a slip last longer than half a free swing, and "
        "so does a load cell whose filter smears it."
    ),
    BY_RISE: (
        "The force may rise more slowly than stiffness times drive velocity: the mass creeps. The "
        "error of its rate is that of the scatter alone."
    ),
}
NOT_SHOWN = "not shown"
HEADINGS = ("quantity", "shown", "stated", "", "by the")


def section(found: Analysis) -> Section | None:
    """Return them as a table, with a sentence on those that contradict each other."""
    its: tuple[StatedQuantity, ...] = found.parts["metadata"]
    if all(each.agrees is None for each in its):  # nothing is stated
        return None
    known = {each.name: verdict(each) for each in its if verdict(each) not in ("", NOT_SHOWN)}
    lines = [_agreement(known)] if known else []
    lines += [_sentence(x) for x in its if x.agrees is False and x.quantity not in TOLD]
    rough = [x.how for x in its if _is_rough(x)]
    lines += [ROUGH[how] for how in dict.fromkeys(rough) if how in ROUGH]
    return Section("What the record says of its apparatus", lines, Table(HEADINGS, _rows(its)))


def _is_rough(each: StatedQuantity) -> bool:
    """Return whether a value is, or may be, farther from the truth than its error says."""
    apart = each.stated - each.found
    if each.how == BY_RISE and apart < 0.0:
        return False  # creep does not make the force rise faster
    if verdict(each) in ((ALLOWED,) if each.part else (ALLOWED, "")):
        return True
    return each.how == BY_RISE and each.agrees is True and apart > ERRORS_997 * each.error


def _agreement(known: Mapping[str, str]) -> str:
    """Return which quantities contradict the record as they are stated, in a sentence."""
    wrong = [name for name, word in known.items() if word == "contradicts"]
    names = " and ".join(wrong or known)
    allowed = "does not contradict" if ALLOWED in known.values() else "agrees with"
    return f"The record {'contradicts' if wrong else allowed} {names} as stated."


def verdict(each: StatedQuantity) -> str:
    """Return whether the record agrees with a stated value, only allows it, or contradicts it."""
    limit = isnan(each.error)  # of what the record can show, not a value of it
    if not each.agrees:
        beyond = NOT_SHOWN if limit and each.unit == "Hz" else "contradicts"
        return "" if each.agrees is None else beyond
    return "agrees" if limit or each.is_same else ALLOWED


def _sentence(each: StatedQuantity) -> str:
    """Return a contradiction in words."""
    if each.unit == "Hz":
        return (
            f"The transverse oscillation, at {in_words(each.stated, each.unit)}, is not in this "
            f"record, which shows {in_words(each.found, each.unit)} at most: the stiffness across "
            "cannot be found from it."
        )
    name = f"{each.quantity[0].upper()}{each.quantity[1:]}"
    return f"{name}: by the {each.how} it is {times(each.ratio)} what is stated."


def _rows(its: tuple[StatedQuantity, ...]) -> list[tuple[str, ...]]:
    return [
        (
            each.name,
            with_error(each.found, each.error, each.unit),
            in_words(each.stated, each.unit) if isfinite(each.stated) else "",
            verdict(each),
            each.how,
        )
        for each in its
    ]


def tables(found: Analysis) -> dict[str, xr.Dataset | None]:
    """Return a row for each quantity, in SI."""
    its: tuple[StatedQuantity, ...] = found.parts["metadata"]
    columns = {name: ("quantity", [getattr(each, name) for each in its]) for name in NUMBERS}
    texts = {name: ("quantity", [getattr(each, name) for each in its]) for name in ("unit", "how")}
    rows = {"quantity": ("quantity", [each.name for each in its])}
    return {"metadata": xr.Dataset({**columns, **texts}, rows) if its else None}


def numbers(found: Analysis) -> dict[str, Any]:
    """Return them for JSON."""
    its: tuple[StatedQuantity, ...] = found.parts["metadata"]
    return {
        "metadata": {
            each.name: {name: number(getattr(each, name)) for name in NUMBERS}
            | {"unit": each.unit, "agrees": each.agrees, "by": each.how}
            for each in its
        }
    }
