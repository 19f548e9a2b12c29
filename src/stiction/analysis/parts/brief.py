"""The answer in short, which a report begins with; its grounds follow in the other parts."""

from __future__ import annotations

from math import isfinite
from typing import TYPE_CHECKING, Any

from stiction.analysis.motion.friction import without_loading
from stiction.analysis.motion.regime.kinds import UNDETERMINED
from stiction.analysis.parts import rotation
from stiction.analysis.parts.friction import coefficient_in_words, force_in_words
from stiction.analysis.parts.motion import other_reading
from stiction.analysis.parts.procedure import OF_SPEED, name_of
from stiction.text.quantity.wording import with_error
from stiction.text.sections import Section, first_clause, first_sentence

if TYPE_CHECKING:
    from stiction.analysis.report import Analysis

FRICTIONS = ("static", "kinetic")
OF_LOADING = {  # by their name in `Analysis.missing`
    "creep": "creep before slip",
    "creep_distance": "creep distance",
    "misalignment": "misalignment",
}


def section(found: Analysis) -> Section:
    """Return test, motion, rotation of the force, friction, the first warning, and missing data.

    Where the motion asks for another reading of the file, that follows at once.
    """
    kind, test = found.regime.surely, found.parts["procedure"]
    known = test is None or found.regime.kind != UNDETERMINED
    lines = [
        *([] if test is None else [_test(test)]),
        *([f"{kind[0].upper()}{kind[1:]}."] if known else []),
        first_sentence(found.parts["motion"]),
        *filter(None, [other_reading(found)]),
        *rotation.in_short(found),
        *_friction(found),
        *_misalignment(found),
        *warnings_in_short(found.warnings),
        *_open_questions(found),
    ]
    return Section("In short", lines)


def _test(test: Any) -> str:
    """Return the name of a test, and its answer."""
    return f"A test of {name_of(test).replace('-', ' ')}. {test.answer}"


def _friction(found: Analysis) -> list[str]:
    """Return the coefficients, forces where the load is unknown, or why there are none.

    Where a test has several velocities, it has the friction of each.
    """
    test = found.parts["procedure"]
    if test is not None and name_of(test) in OF_SPEED:
        return []
    return [_coefficients(found)]


def _coefficients(found: Analysis) -> str:
    """Return the coefficients or forces of friction in a sentence."""
    its = found.friction
    known = {name: each for name in FRICTIONS if (each := getattr(its, name)) is not None}
    if not known and its.break_away is not None:
        known = {"first break-away": its.break_away}
    if not known:
        return f"Friction: not determined ({first_clause(its.missing['kinetic'])})."
    coefficients = {name: coefficient_in_words(each) for name, each in known.items()}
    what, shown = "coefficient", coefficients
    if not all(coefficients.values()):
        what, shown = "force", {name: force_in_words(each) for name, each in known.items()}
    numbers = ", ".join(f"{name} {number}" for name, number in shown.items())
    unknown = next((name for name in FRICTIONS if name not in known), None)
    if unknown is None or len(known) > 1:
        return f"Friction {what}: {numbers}."
    why = its.missing[unknown]
    if unknown == "static" and not found.regime.loads:
        why = without_loading(found.regime)
    return f"Friction {what}: {numbers}; {unknown} not determined ({first_clause(why)})."


def _misalignment(found: Analysis) -> list[str]:
    its = found.misalignment
    if its is None:
        return []
    return [f"Misalignment by the creep: {with_error(its.phi, its.phi_error, 'rad')}."]


def warnings_in_short(said: tuple[str, ...]) -> list[str]:
    """Return how many warnings there are, and the first, which is the most important, in short."""
    if not said:
        return []
    first = first_clause(said[0])
    count = "1 warning" if len(said) == 1 else f"{len(said)} warnings, the first"
    return [f"{count}: {first[0].lower()}{first[1:]}."]


def _open_questions(found: Analysis) -> list[str]:
    """Return the questions that the loading of a spring answers elsewhere, but not here."""
    names = [name for key, name in OF_LOADING.items() if key in found.missing]
    names += [
        x.name for x in found.parts["metadata"] if isfinite(x.stated) and not x.is_shown
    ]  # fmt: skip
    if not names or not found.regime.loads:
        return []
    return [f"Not determined, for the reasons below: {', '.join(names)}."]
