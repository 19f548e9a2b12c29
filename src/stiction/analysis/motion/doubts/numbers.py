"""Doubts about friction, rate of loading and stiffness over mass, which contradict each other."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import log10, pi

import numpy as np

from stiction.analysis.motion.doubts.findings import Findings
from stiction.analysis.motion.doubts.units import (
    LARGEST_MU,
    NEAR_RATE,
    TINY_MU,
    Numbers,
    ask_units,
    likely_changes,
    numbers_of,
)
from stiction.analysis.motion.metadata.loading_rate import LOADING_RATE
from stiction.analysis.motion.metadata.quantity import StatedQuantity
from stiction.analysis.motion.metadata.stiffness_over_mass import SWING
from stiction.analysis.motion.regime.kinds import HARMONIC
from stiction.analysis.motion.zero import is_about_zero
from stiction.analysis.record import Record
from stiction.text.quantity.wording import in_words, times

NEAR_MASS = log10(5.0) / 6.0  # k/m within a factor of 5 of a million is that of another unit
QUICKER = 2.0  # times k/m: so quick a vibration may be that of both springs


def doubt_coefficient(its: Findings) -> Iterator[str]:
    """Doubt a friction coefficient that is too large or too small for dry friction."""
    record, seen = its.record, _numbers(its)
    if TINY_MU <= seen.mu <= LARGEST_MU or not np.isfinite(seen.mu):
        return
    load = in_words(record.normal_load or 0.0, "N")
    asked = ask_units(record, likely_changes(seen), lambda change: "force" in change)
    remedy = "; or ".join([*asked, f"check the normal load, {load}"])
    yield f"A friction coefficient of {seen.mu:.3g} is implausible: {remedy}."


def doubt_rate(its: Findings) -> Iterator[str]:
    """Doubt the rate of loading as stated, by the whole record or by the parts of a change."""
    rates = [each for each in its.stated if each.quantity == LOADING_RATE]
    good = [each for each in rates if each.agrees]
    if good:
        yield from _of_one_part(good, rates)
        return
    seen = _numbers(its)
    for each in rates:
        if each.agrees is False:
            yield (
                f"{f'{each.part} the'.strip().capitalize()} force rises at "
                f"{in_words(each.found, 'N/s')}, {times(each.ratio, 3)} stiffness times "
                f"drive velocity as stated, {in_words(each.stated, 'N/s')}: "
                f"{_remedy(its.record, seen._replace(rate=each.ratio))}."
            )


def _of_one_part(good: Sequence[StatedQuantity], rates: Sequence[StatedQuantity]) -> Iterator[str]:
    """Say that the rate of loading is that stated in one part of a record, and not in others."""
    others = [each for each in rates if each.agrees is None and each.part]
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


def doubt_mass(its: Findings) -> Iterator[str]:
    """Doubt k/m if the period of a swing, or the duration of a slip, contradicts it."""
    wrong = [each for each in its.stated if each.quantity == SWING and each.agrees is False]
    if not wrong:
        return
    known, kind = wrong[-1], its.regime.kind
    lasts = 2.0 if kind == HARMONIC else 1.0
    yield (
        f"By the {known.how} ({in_words(lasts * pi / known.found**0.5, 's')}), "
        f"stiffness over mass is {times(known.ratio)} {in_words(known.stated, '1/s²', 3)}, as "
        f"stated: {_remedy_of_mass(its.record, known.ratio, kind, _numbers(its))}."
    )


def _numbers(its: Findings) -> Numbers:
    """Return the numbers that reveal a wrong unit; no coefficient of a force about zero."""
    known = [abs(each.coefficient) for each in its.friction[:3] if each is not None]
    mu = max(known, default=np.nan)
    if mu < TINY_MU and is_about_zero(its.friction, its.alike):
        mu = np.nan
    return numbers_of(mu, its.stated)


def _remedy(record: Record, seen: Numbers) -> str:
    """Return the likely causes of a rate that is so many times as large as stated."""
    power = round(log10(seen.rate) / 3.0) if seen.rate > 0.0 else 0
    if power == 0 or abs(log10(seen.rate) - 3.0 * power) > NEAR_RATE:
        return "check stiffness and drive velocity, or the gain of the load cell"
    wrong = f"{1000 ** abs(power)} times too {'large' if power < 0 else 'small'}"
    stated = f"stiffness or drive velocity is stated {wrong}"
    asked = ask_units(record, likely_changes(seen))
    return f"{'; '.join(asked)}; or {stated}" if asked else stated


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
