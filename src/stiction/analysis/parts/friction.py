"""Friction at the break-away, at rest and while the mass slides."""

from __future__ import annotations

from math import isfinite
from typing import TYPE_CHECKING, Any

from stiction.analysis.motion.cycle_columns import with_spread
from stiction.analysis.motion.friction import Measured
from stiction.analysis.motion.regime.kinds import UNDETERMINED
from stiction.analysis.motion.zero import ZeroShown, is_hidden, is_stated
from stiction.arrays import xr
from stiction.recording.noise import white_noise
from stiction.storage.table_files import number
from stiction.text.quantity.wording import SLIGHT, in_words, with_error
from stiction.text.sections import Section, Table
from stiction.trajectory import Trajectory

if TYPE_CHECKING:
    from stiction.analysis.report import Analysis

FRICTIONS = {
    "break_away": "first break-away",
    "static": "static, mean of the peaks",
    "kinetic": "kinetic, mean while it slides",
}
# of each of them, with its unit
FRICTION = {
    "force": "N",
    "error": "N",
    "spread": "N",
    "coefficient": "1",
    "coefficient_error": "1",
    "coefficient_spread": "1",
}
# Of the spread of peaks: less white noise is not worth a word, as it spreads peaks by half of its
# standard deviation, by 0 to 1.3 of it in 9 of 10 random records
NOISE_SHOWS = 0.6
MAKES = 0.5  # of an error: a cause of less is not worth a word
OVERSHOOT = 0.01  # of the peaks: a smaller one is not worth a word


def section(found: Analysis) -> Section:
    """Return the friction at the break-away, at rest and while it slides."""
    rows, lines = [], []
    for name, title in FRICTIONS.items():
        each: Measured | None = getattr(found.friction, name)
        if each is None:
            lines.append(
                f"{title[0].upper()}{title[1:]}: not known; {found.friction.missing[name]}."
            )
            continue
        spread = with_spread(each.spread, each.force, "N")
        rows.append((title, coefficient_in_words(each), force_in_words(each), spread))
    if (
        found.friction.break_away is not None
        and found.cycles.sizes["cycle"]
        and not found.regime.loads
        and found.regime.kind != UNDETERMINED
    ):
        lines.append(
            "The first break-away is the first peak of a vibration: the mass moves before it, so "
            "that static friction is less."
        )
    lines += _overshoot(found) + _noise_of_peaks(found)
    if not rows:
        return Section("Friction", lines)
    if not isinstance(found.source, Trajectory) and not is_stated(found.record):
        lines.append(
            f"The zero of the force is assumed: no reading without load is given.{_zero(found)}"
        )
    headings = ("friction", "µ", "force", "spread")
    shown = [at for at in range(4) if at != 1 or any(row[1] for row in rows)]  # no µ without a load
    cells = [tuple(row[at] for at in shown) for row in rows]
    return Section("Friction", lines, Table(tuple(headings[at] for at in shown), cells))


def coefficient_in_words(its: Measured) -> str:
    """Return the coefficient with its error, '' if it is not known."""
    if not isfinite(its.coefficient):
        return ""
    slight = its.coefficient_error <= SLIGHT * abs(its.coefficient)
    return with_error(its.coefficient, 0.0 if slight else its.coefficient_error, "1")


def force_in_words(its: Measured) -> str:
    """Return the force with its error."""
    return with_error(its.force, its.error if its.error > SLIGHT * abs(its.force) else 0.0, "N")


def _zero(found: Analysis) -> str:
    """Return the zero that a record shows at its start, if the errors come from it.

    Where it shows none, return what a zero that is off would change.
    """
    shown: ZeroShown | None = found.parts["zero"]
    if is_hidden(found.record, found.friction, shown):
        force = max(abs(each.force) for each in found.friction[:3] if each is not None)
        return (
            " The record does not show it either, as it begins with a loaded spring: where it is "
            f"off by {in_words(0.01 * force, 'N', 1)}, friction is off by as much, about 1 %, and "
            "the errors do not allow for it."
        )
    errors = [each.error for each in found.friction[:3] if each is not None]
    if shown is None or shown.by != "rest" or not errors:
        return ""
    if abs(shown.reading) < MAKES * min(errors):
        return ""
    read = in_words(shown.reading, "N")
    return f" The errors allow for that which the rest at the start shows, {read}."


def _overshoot(found: Analysis) -> list[str]:
    """Return how much of the peaks may be inertia, if that is worth a word.

    At the end of a stick the mass gains the drive's speed V while the force goes on rising. Against
    constant friction it swings on its spring, and the force rises by V sqrt(k m); against friction
    that falls it gains that speed sooner.
    """
    peak, record = found.friction.static, found.record
    if peak is None or None in (known := (record.mass, record.stiffness, record.drive_velocity)):
        return []
    mass, stiffness, velocity = (each or 0.0 for each in known)
    most = velocity * (mass * stiffness) ** 0.5
    if most < OVERSHOOT * abs(peak.force):
        return []
    return [
        f"Up to {in_words(most, 'N', 2)} of the peaks may be inertia: the force goes on rising "
        "until the mass is as fast as the drive."
    ]


def _noise_of_peaks(found: Analysis) -> list[str]:
    """Return the noise that spreads peaks, if that is worth a word."""
    peak, noise = found.friction.static, white_noise(found.record.force)
    if peak is None or not noise > NOISE_SHOWS * peak.spread:
        return []
    return [
        f"The spread of the peaks contains that of noise, {in_words(noise, 'N', 2)} (standard "
        "deviation of a sample)."
    ]


def tables(found: Analysis) -> dict[str, xr.Dataset | None]:
    """Return the known kinds of friction, a row each."""
    known = {name: each for name in FRICTIONS if (each := getattr(found.friction, name))}
    columns = {
        key: ("friction", [getattr(each, key) for each in known.values()], {"units": unit})
        for key, unit in FRICTION.items()
    }
    rows = {"friction": ("friction", list(known))}
    return {"friction": xr.Dataset(columns, rows) if known else None}


def numbers(found: Analysis) -> dict[str, Any]:
    """Return each friction as a table of force, coefficient, errors and spreads, or the reason."""
    shown: dict[str, Any] = {"missing": found.friction.missing, "units": FRICTION}
    for name in FRICTIONS:
        each = getattr(found.friction, name)
        shown[name] = each and {key: number(getattr(each, key)) for key in FRICTION}
    return {"friction": shown}
