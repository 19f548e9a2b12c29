"""Whether the friction force turns in the plane while the spring is loaded, or grows."""

from __future__ import annotations

from math import isfinite
from typing import TYPE_CHECKING, Any

from stiction.analysis.motion.doubts.unsteady import VARIES
from stiction.analysis.rotation.findings import (
    BOTH,
    GROWING,
    TURNING,
    UNDETERMINED,
    Rotation,
    rotation_of,
)
from stiction.analysis.rotation.loading import SEVERAL
from stiction.analysis.rotation.plane import with_both_forces
from stiction.analysis.signals.correlated_noise import ERRORS_95
from stiction.errors import ResultError
from stiction.storage.table_files import number
from stiction.text.quantity.wording import in_words, with_error
from stiction.text.sections import Section
from stiction.trajectory import Trajectory

if TYPE_CHECKING:
    from stiction.analysis.report import Analysis

TITLE = "Rotation of the force"
CLAUSES = {  # of the friction force
    TURNING: "turns at nearly constant magnitude: this apparent stick is slow creep",
    GROWING: "grows rather than turns at one magnitude: the mass rests, or its contact yields "
    "before it slips",
    BOTH: "grows and turns: the mass rests for a part of the loading and creeps for another, or "
    "friction differs with its direction",
}
STATE_ZERO = (
    'state the zero of the force across with its uncertainty, such as zero = "0 +- 5 mN" under '
    "[sensors.force_across] in a TOML file beside the record"
)
UNKNOWN = "Whether the force turns or grows is not determined."


def find(found: Analysis) -> Rotation | None:
    """Return how the force changes in the loadings of a run, or of a record with both forces."""
    record = with_both_forces(found.source, found.record)
    if record is None or (isinstance(found.source, Trajectory) and not found.regime.loads):
        return None
    if not found.regime.loads:
        raise ResultError("not determined: the record shows no stick-slip")
    if found.friction.static is None:
        raise ResultError(f"not determined: {found.friction.missing['static']}")
    if record.load_variation() > VARIES:
        raise ResultError("not determined: the load varies, and friction with it")
    return rotation_of(record, found.cycles)


def section(found: Analysis) -> Section | None:
    """Return it in words; None without a force across."""
    its: Rotation | None = found.parts["rotation"]
    if its is None:
        why = found.missing.get("rotation")
        return Section(TITLE, [f"{why[0].upper()}{why[1:]}."]) if why else None
    measured = not isinstance(found.source, Trajectory)
    return Section(TITLE, [_course(its, measured=measured), _conclusion(its, measured=measured)])


def in_short(found: Analysis) -> list[str]:
    """Return whether the force turns in one sentence; nothing without a force across.

    Where that is not determined, the remedy follows.
    """
    its: Rotation | None = found.parts["rotation"]
    if its is None:
        return [UNKNOWN] if "rotation" in found.missing else []
    if its.kind not in CLAUSES:
        return [UNKNOWN if its.stated else f"{UNKNOWN[:-1]}; {STATE_ZERO}."]
    if isinstance(found.source, Trajectory):
        return [f"While the spring is loaded, the friction force {CLAUSES[its.kind]}."]
    return [f"By the force across, the friction force {CLAUSES[its.kind]}."]


def _course(its: Rotation, *, measured: bool) -> str:
    """Return the course of both forces, and with a known zero their magnitude and angle."""
    a, b = (in_words(float(each), "N") for each in its.along)
    c, d = (float(each) for each in its.across)
    across = "the force across"
    if isfinite(its.change):
        c, d = its.side * c, its.side * d
        if measured:
            across += f", from its {'stated' if its.stated else 'fitted'} zero,"
    way = "falls" if d < c else "rises"
    said = (
        f"While the force along the drive rises from {a} to {b}, {across} {way} from "
        f"{in_words(c, 'N')} to {in_words(d, 'N')}"
    )
    if not isfinite(its.change):
        return f"{said}. {_means(its)}"
    angles = zip(its.angle, its.angle_error, strict=True)
    start, end = (with_error(float(each), float(error), "rad") for each, error in angles)
    change = with_error(100.0 * its.change, 100.0 * its.change_error, "1")
    turns = "turns" if its.kind in (TURNING, BOTH) else "goes"
    return (
        f"{said}: the force {turns} from ({start}) to ({end}) off the axis of the load cell, and "
        f"its magnitude changes by ({change}) %. {_means(its)}"
    )


def _means(its: Rotation) -> str:
    """Return of how many loadings this is."""
    if its.loadings == 1:
        return "This is of one loading."
    return f"These are means over {its.loadings} loadings."


def _conclusion(its: Rotation, *, measured: bool) -> str:
    """Return the conclusion: the force turns, or it grows."""
    said = [f"It {CLAUSES[its.kind]}." if its.kind in CLAUSES else UNKNOWN]
    if its.kind == UNDETERMINED and its.stated:
        said.append("The errors leave both possible.")
    elif its.kind == UNDETERMINED:
        said.append(
            "Neither an arc that ends at slip nor a straight line describes its path clearly "
            f"better; {STATE_ZERO}."
        )
    if its.kind == GROWING and not its.stated:
        said.append(
            "Its path is straight, not an arc that ends at slip. How far it grows follows if the "
            "zero of the force across is stated, with its uncertainty."
        )
    if its.kind == TURNING:
        said.append(f"Friction near rest is F_0 = {with_error(its.F_0, its.F_0_error, 'N')}.")
        if its.change < -ERRORS_95 * its.change_error:
            said.append("It is weaker towards slip, where the mass creeps faster.")
        if not its.stated:
            zero = with_error(its.zero, its.zero_error, "N")
            said.append(
                f"The zero of the force across, {zero}, is that of the arc which fits, as none is "
                "stated with its uncertainty; that friction is alike in all directions is supposed."
            )
    if isfinite(its.change) and measured:
        said.append(_left_out(its))
    return " ".join(said)


def _left_out(its: Rotation) -> str:
    """Return the effects that the errors do not include."""
    drift = "" if its.loadings >= SEVERAL else ", a drift of the zero beyond a stated one"
    return (
        f"The errors leave out crosstalk of the channels{drift}, and gains or filters in which "
        "they differ by more than is stated."
    )


def numbers(found: Analysis) -> dict[str, Any]:
    """Return the finding as a table."""
    its: Rotation | None = found.parts["rotation"]
    if its is None:
        return {"rotation": None}
    shown = {
        name: [number(one) for one in each] if hasattr(each, "__len__") else number(each)
        for name, each in its._asdict().items()
        if name not in ("kind", "stated", "loadings")
    }
    rest = {"kind": its.kind, "stated": its.stated, "loadings": its.loadings}
    return {"rotation": rest | shown}
