"""The properties of its own apparatus that a measured record shows, beside the stated ones."""

from __future__ import annotations

from collections.abc import Mapping
from math import isfinite, isnan
from typing import TYPE_CHECKING, Any

from stiction.analysis.motion.metadata.loading_rate import BY_RISE, LOADING_RATE
from stiction.analysis.motion.metadata.quantity import ALIKE_VALUES, StatedQuantity
from stiction.analysis.motion.metadata.stiffness_over_mass import BY_SLIPS, SWING
from stiction.arrays import xr
from stiction.storage.table_files import number
from stiction.text.quantity.wording import at_least, in_words, times, with_error
from stiction.text.sections import Section, Table

if TYPE_CHECKING:
    from stiction.analysis.report import Analysis

ALLOWED = "possible"  # not the same, but the record gives a bound only, or a rough value
DOUBTED = "doubtful"  # so far above a bound that hardly anything explains it
WRONG, AGREES = "contradicts", "agrees"
NUMBERS = ("found", "error", "at_least", "stated", "ratio")
TOLD = (SWING, LOADING_RATE)  # among the warnings
WHY = {  # a value is a lower bound
    BY_SLIPS: (
        "The duration of slips gives a lower bound of stiffness over mass: friction that weakens "
        "with speed makes a slip last longer than half a free swing, and so does a load cell whose "
        "filter smears it."
    ),
    BY_RISE: (
        "The rise of the force gives a lower bound of stiffness times drive velocity: while the "
        "mass creeps, the force rises more slowly."
    ),
}
MEASURED = (
    "No drive velocity is stated: the slope of the drive's displacement, which is even, stands for "
    "it everywhere."
)
SHOWABLE, NOT_SHOWN = "can be shown", "not shown"  # a frequency, by the record's samples
UNSAID = ("", SHOWABLE, NOT_SHOWN)  # verdicts that neither agree nor contradict
HEADINGS = ("quantity", "shown", "stated", "", "by the")


def section(found: Analysis) -> Section | None:
    """Return them as a table, with a sentence on contradictory ones."""
    its: tuple[StatedQuantity, ...] = found.parts["metadata"]
    measured = found.record.drive_velocity is not None and found.record.stated_velocity is None
    if all(each.agrees is None for each in its) and not measured:  # nothing is stated
        return None
    known = {each.name: verdict(each) for each in its if verdict(each) not in UNSAID}
    lines = [_agreement(known)] if known else []
    lines += [_sentence(x) for x in its if x.agrees is False and x.quantity not in TOLD]
    lines += [MEASURED] if measured else []
    bounds = dict.fromkeys(each.how for each in its if _is_shown_as_bound(each) and each.is_shown)
    lines += [WHY[how] for how in bounds]
    rows: list[tuple[str, ...]] = [HEADINGS, *_rows(its)]
    if not any(row[3] for row in rows):  # nothing is stated
        rows = [(row[0], row[1], row[4]) for row in rows]
    return Section("What the record says of its apparatus", lines, Table(rows[0], rows[1:]))


def _is_shown_as_bound(each: StatedQuantity) -> bool:
    """Return whether a value is a lower bound of the true one; not where that stated is below."""
    return each.is_bound and isfinite(each.error) and not each.stated < each.at_least


def _agreement(known: Mapping[str, str]) -> str:
    """Return which quantities contradict the record as they are stated, in a sentence."""
    does = {
        WRONG: WRONG,
        DOUBTED: "casts doubt on",
        ALLOWED: "does not contradict",
        AGREES: "agrees with",
    }
    worst = next(word for word in does if word in known.values())
    its = [name for name, word in known.items() if word == worst or worst in (ALLOWED, AGREES)]
    return f"The record {does[worst]} {' and '.join(its)} as stated."


def verdict(each: StatedQuantity) -> str:
    """Return whether the record agrees with a stated value, allows, doubts or contradicts it."""
    if each.agrees is None:
        return ""
    if _is_limit(each):
        return SHOWABLE if each.agrees else NOT_SHOWN
    if _is_shown_as_bound(each):
        return _verdict_of_bound(each)
    if each.agrees:
        return AGREES if isnan(each.error) or each.is_same else ALLOWED
    return WRONG


def _verdict_of_bound(each: StatedQuantity) -> str:
    """Return the verdict on a lower bound: it agrees only if it is near the stated value."""
    if not each.agrees:
        return DOUBTED
    if not each.is_shown:
        return ""
    return AGREES if each.at_least >= (1.0 - ALIKE_VALUES) * each.stated else ALLOWED


def _is_limit(each: StatedQuantity) -> bool:
    """Return whether it is the highest frequency that a record can show, not a value of it."""
    return isnan(each.error) and each.unit == "Hz"


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
            _value_in_words(each),
            in_words(each.stated, each.unit) if isfinite(each.stated) else "",
            verdict(each),
            each.how,
        )
        for each in its
    ]


def _value_in_words(each: StatedQuantity) -> str:
    if _is_shown_as_bound(each):
        return at_least(each.at_least, each.error, each.unit)
    return "up to " * _is_limit(each) + with_error(each.found, each.error, each.unit)


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
