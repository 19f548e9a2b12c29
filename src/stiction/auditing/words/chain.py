"""Springs in series in the report of an audit."""

from __future__ import annotations

from math import degrees, inf, isinf
from typing import TYPE_CHECKING

from stiction.auditing.chain import SMALL, Chain, Part, Replacement
from stiction.auditing.prediction import Prediction
from stiction.auditing.simulated_test import SimulatedTest
from stiction.auditing.words.numbers import apparent_stiffness, largest
from stiction.auditing.words.verdict import final_motion, motion_and_travel
from stiction.errors import echo
from stiction.system.slider import Slider
from stiction.text.quantity.wording import in_words, percent
from stiction.text.sections import Section, Table

if TYPE_CHECKING:
    from stiction.auditing.report import Audit

HEADINGS = ("spring", "k_x", "k_y", "compliance along x", "along y")
CHANGES = (
    *("spring", "stiffness", "A", "ζ", "f_y", "apparent static friction"),
    "simulated from rest",
)


def chain_sections(found: Audit) -> list[Section]:
    """Return the sections on springs in series; none for a single spring."""
    chain, seen = found.chain, found.observation
    if chain is None:
        return []
    lines = [*softest(chain), *axes(found.slider), *masses(chain)]
    now = _row("all as they are", found.slider, found.prediction, seen)
    changed = Table(CHANGES, [now, *map(_change, chain.replacements)])
    return [
        Section("Springs in series", lines, Table(HEADINGS, [*map(_describe_part, chain.parts)])),
        Section("One spring replaced", outcomes(seen, chain), changed),
    ]


def softest(chain: Chain) -> list[str]:
    """Return the softest part along x, which is mostly the drive's direction, and along y."""
    x = max(chain.parts, key=lambda part: part.along_x)
    y = max(chain.parts, key=lambda part: part.along_y)
    of_x, of_y = percent(x.along_x), percent(y.along_y)
    if x is y:
        return [
            f"The softest is: {x.spring.name}, with {of_x} of the compliance along x and {of_y} "
            "along y."
        ]
    return [
        f"The softest along x is: {x.spring.name}, with {of_x} of the compliance; along y: "
        f"{y.spring.name}, with {of_y}."
    ]


def axes(slider: Slider) -> list[str]:
    """Return the directions of the whole's axes, if parts have axes of their own."""
    if not slider.turn:
        return []
    return [
        f"The springs' axes differ. Together they have the axis x at {degrees(slider.turn):.4g} "
        f"deg to the line that angles count from, so that their misalignment to the drive is "
        f"{degrees(slider.misalignment):.4g} deg where phi is {degrees(slider.phi):.4g} deg."
    ]


def masses(chain: Chain) -> list[str]:
    """Return a sentence for each part's mass, which the model leaves out."""
    return [_mass(part, number) for number, part in enumerate(chain.parts) if part.spring.mass]


def _mass(part: Part, number: int) -> str:
    mass, name = in_words(part.spring.mass or 0.0, "kg"), part.spring.name
    start = f"The mass of {mass} that moves with {echo(name)} is left out"
    if part.more < SMALL:
        more = percent(part.more)
        return f"{start}: with it the springs would yield at most {more} more, which is little."
    remedy = " It moves with the slider: add it to its mass." if number == 0 else ""
    if isinf(part.more):
        return (
            f"{start}, which is wrong: on the springs beyond it, it resonates below a natural "
            f"frequency of the slider.{remedy}"
        )
    return (
        f"{start}: with it the springs would yield up to {percent(part.more)} more at a natural "
        f"frequency of the slider, which would be lower by about {percent(0.5 * part.more)}."
        f"{remedy}"
    )


def outcomes(seen: SimulatedTest, chain: Chain) -> list[str]:
    """Return the effects of the replacements on a test from rest, in sentences."""
    now = final_motion(seen)
    by = "Stiffness, A, ζ and f_y are by theory, friction and motion simulated from rest."
    other = [(each, final_motion(each.tried)) for each in chain.replacements if each.tried]
    differing = [f"{_name(each)}: {then}" for each, then in other if then != now]
    if not other:
        return []
    if not differing:
        return [f"No replacement changes the motion from rest: it is {now} with each. {by}"]
    return [
        f"As it is, it comes to {now} from rest. That changes with {'; '.join(differing)}. {by}"
    ]


def _describe_part(part: Part) -> tuple[str, ...]:
    spring = part.spring
    k_x, k_y = (in_words(1.0 / c, "N/m") if c > 0.0 else "rigid" for c in spring.compliances)
    angle = f" at {degrees(spring.angle):.3g} deg" if spring.angle else ""
    return f"{spring.name}{angle}", k_x, k_y, percent(part.along_x), percent(part.along_y)


def _change(each: Replacement) -> tuple[str, ...]:
    if each.slider is None or each.prediction is None:
        reason = "not possible: the others are rigid along some axis"
        return (_name(each), *[""] * (len(CHANGES) - 2), reason)
    return _row(_name(each), each.slider, each.prediction, each.tried)


def _row(name: str, slider: Slider, p: Prediction, seen: SimulatedTest | None) -> tuple[str, ...]:
    motion = "not tried"
    if seen is not None:
        status = seen.run.status
        motion = motion_and_travel(seen) if status.ok else f"not known: {status.value}"
    return (
        name,
        in_words(apparent_stiffness(slider), "N/m"),
        in_words(p.A, ""),
        in_words(p.zeta, ""),
        in_words(p.f_y, "Hz"),
        "" if seen is None else largest(seen),
        motion,
    )


def _name(each: Replacement) -> str:
    how = {2.0: "twice as stiff", inf: "rigid"}.get(each.factor, f"{each.factor:g} times as stiff")
    return f"{each.spring.name} {how}"
