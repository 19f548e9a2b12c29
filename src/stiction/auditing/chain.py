"""Springs in series: the softest one, the effect of replacing it, and the masses that matter."""

from __future__ import annotations

from collections.abc import Iterator
from math import cos, inf, pi, sin
from typing import NamedTuple

import numpy as np

from stiction.arrays import Floats
from stiction.auditing.prediction import Prediction, predict
from stiction.auditing.simulated_test import LEAST_WORK, SimulatedTest, simulate_coarsely
from stiction.errors import DescriptionError
from stiction.progress.report import Progress, part, silent
from stiction.system.slider import Slider
from stiction.system.springs import COMPLIANCES, STIFFNESSES, Spring, compliance, scale_stiffness

FACTORS = (2.0, inf)  # of the stiffness of a part that is replaced
SMALL = 0.01  # of the compliance: the mass of a part that adds less may be left out, (M77)


class Part(NamedTuple):
    """One of several springs in series."""

    spring: Spring  # the part
    # its shares of the compliance along the principal axes of the whole
    along_x: float
    along_y: float
    # what its own mass adds to the compliance of all, a share of it, at the natural frequency where
    # that is more (M77); infinite above its own resonance; zero without a mass
    more: float


class Replacement(NamedTuple):
    """A part replaced by a stiffer one, and the simulation with it."""

    spring: Spring  # the part as it is
    factor: float  # of its stiffnesses; infinite for a rigid part
    # the apparatus with it; None if all parts together would be rigid along some axis
    slider: Slider | None = None
    prediction: Prediction | None = None  # the theory of it
    # the simulation from rest; None if it was not done, since the work has a limit
    tried: SimulatedTest | None = None


class Chain(NamedTuple):
    """The springs in series of an apparatus, and their replacements."""

    parts: tuple[Part, ...]
    replacements: tuple[Replacement, ...]


def examine(slider: Slider, work: int, progress: Progress = silent) -> Chain:
    """Return a slider's springs in series and their replacements; `work` limits simulations."""
    return Chain(parts(slider), tuple(replace_each(slider, work, progress)))


def parts(slider: Slider) -> tuple[Part, ...]:
    """Return the springs in series of a slider, each as a part of the whole."""
    tensors = [compliance(each) for each in slider.springs]
    total, p = sum(tensors, np.zeros((2, 2))), predict(slider)
    axes = [axis(slider.turn + at) for at in (0.0, 0.5 * pi)]
    found = []
    for number, (spring, own) in enumerate(zip(slider.springs, shares(slider), strict=True)):
        beyond = sum(tensors[number:], np.zeros((2, 2)))
        more = max(
            yield_of_mass(spring.mass or 0.0, 2.0 * pi * f, beyond, e) / float(e @ total @ e)
            for e, f in zip(axes, (p.f_x, p.f_y), strict=True)
        )
        found.append(Part(spring, *own, more))
    return tuple(found)


def shares(slider: Slider) -> list[tuple[float, float]]:
    """Return the share of each spring in the compliance along x, and along y."""
    x, y = axis(slider.turn), axis(slider.turn + 0.5 * pi)
    own = [(float(x @ S @ x), float(y @ S @ y)) for S in map(compliance, slider.springs)]
    along_x, along_y = (sum(each) for each in zip(*own, strict=True))
    return [(a / along_x, b / along_y) for a, b in own]


def axis(angle: float) -> Floats:
    """Return the unit vector at an angle (rad)."""
    return np.array([cos(angle), sin(angle)])


def yield_of_mass(mass: float, omega: float, beyond: Floats, e: Floats) -> float:
    """Return the compliance (m/N) along `e` that a mass on springs adds at a frequency, (M77).

    `beyond` is the compliance tensor of the springs between the mass and the drive. The mass of a
    part counts at its end towards the slider, where it adds the most. Above its resonance along
    `e`, infinity.
    """
    square = mass * omega**2
    if square * float(e @ beyond @ e) >= 1.0:
        return inf
    more = np.linalg.solve(np.eye(2) - square * beyond, beyond) - beyond
    return abs(float(e @ more @ e))


def softest_path(slider: Slider) -> str:
    """Return the path of the stiffness, or the compliance, that contributes most along x."""
    if not slider.springs:
        return "k_x"
    along_x = [share for share, _ in shares(slider)]
    spring = slider.springs[along_x.index(max(along_x))]
    turned = slider.turn - spring.angle
    c_x, c_y = spring.compliances
    across = cos(turned) ** 2 * c_x < sin(turned) ** 2 * c_y
    k, c = STIFFNESSES[across], COMPLIANCES[across]
    return f"springs.{spring.slug}.{c if getattr(spring, k) is None else k}"


def replace_each(slider: Slider, work: int, progress: Progress = silent) -> Iterator[Replacement]:
    """Yield the replacement of each part by one twice as stiff, then by a rigid one."""
    count = len(slider.springs) * len(FACTORS)
    for number in range(count):
        place, which = divmod(number, len(FACTORS))
        report = part(progress, number, count)
        found = replace_one(slider, place, FACTORS[which], work // (count - number), report)
        work -= found.tried.work if found.tried else 0
        report(1.0)
        yield found


def replace_one(
    slider: Slider, place: int, factor: float, work: int, progress: Progress
) -> Replacement:
    """Return the replacement of one part by one `factor` times as stiff, with its simulation."""
    spring = slider.springs[place]
    stiff = scale_stiffness(spring, factor)
    try:
        other = slider.replace(
            springs=[*slider.springs[:place], stiff, *slider.springs[place + 1 :]]
        )
    except DescriptionError:
        return Replacement(spring, factor)
    p = predict(other)
    if work < LEAST_WORK:
        return Replacement(spring, factor, other, p)
    return Replacement(spring, factor, other, p, simulate_coarsely(other, p, work, progress))
