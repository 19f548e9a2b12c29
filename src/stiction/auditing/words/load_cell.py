"""The load cell's reading of friction, and the reasons why it differs."""

from __future__ import annotations

from math import acos, isfinite
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from stiction.auditing.simulated_test import (
    CALM,
    LOADS,
    SLIDES,
    SimulatedTest,
    relative_speed,
)
from stiction.auditing.words.numbers import kinetic, peak
from stiction.friction import Anisotropic
from stiction.friction.law import static_coefficient
from stiction.system.load_cell import ACROSS
from stiction.text.quantity.wording import in_words, percent

if TYPE_CHECKING:
    from stiction.auditing.report import Audit

TITLE = "What the load cell reads"
RIGHT = 0.02  # of friction: a reading that is off by less needs no explanation
LITTLE = 0.01  # of friction: a reading of less tells nothing of it
SAME = 1e-3  # of friction: larger ones in a swing are one value, and the last is before the slip


class FrictionBeside(NamedTuple):
    """The friction force beside the component that a load cell measures."""

    coefficient: float  # friction over the normal load
    share: float  # the part along the axis of the load cell, over friction: the cosine of the angle
    across: float  # the part across that axis, which the springs carry past the load cell, N

    @property
    def angle(self) -> float:
        """The angle between friction and the axis of the load cell, rad."""
        return acos(min(max(self.share, -1.0), 1.0))

    @property
    def read(self) -> float:
        """The friction coefficient as the load cell reads it."""
        return self.coefficient * self.share


def friction_at(seen: SimulatedTest, at: int) -> FrictionBeside:
    """Return the friction at a sample of a run beside the component on its load cell."""
    samples, slider = seen.run.samples, seen.run.slider
    cell, theta = slider.load_cell, np.radians(samples["theta"][at])
    x, y = cell.way * np.cos(theta), cell.way * np.sin(theta)
    force = float(samples["friction"][at])
    across = abs(float(cell.across(x, y))) * force
    return FrictionBeside(force / slider.normal_load, float(cell.along(x, y)), across)


def largest_force(seen: SimulatedTest) -> tuple[FrictionBeside, int, int]:
    """Return the largest friction in the swing before the largest force, and the samples of both.

    A mass that leaves rest or creep gets as fast as the drive, where the force is largest, within
    a quarter of a swing: what it left is the largest friction of the swing before.
    """
    samples, slider = seen.run.samples, seen.run.slider
    time, at = samples["time"], int(np.argmax(seen.record.force))
    swing = 1.0 / min(slider.natural_frequencies)
    first = int(np.searchsorted(time, time[at] - swing))
    friction = samples["friction"][first : at + 1]
    before = first + int(np.flatnonzero(friction >= (1.0 - SAME) * friction.max())[-1])
    coefficient = float(friction.max()) / slider.normal_load
    ends = seen.run.stick_intervals[:, 1]
    if np.any((ends >= time[first]) & (ends <= time[at])) and not isinstance(
        slider.law, Anisotropic
    ):  # between two samples
        coefficient = static_coefficient(slider.law)
    return friction_at(seen, before)._replace(coefficient=coefficient), before, at


def load_cell(found: Audit) -> list[str]:
    """Return the load cell's reading of friction, in sentences."""
    seen = found.observation
    if not len(seen.record) or not np.nanmax(seen.run.samples["friction"]) > 0.0:
        return ["There is no friction to read."]
    if seen.blind:
        return [f"It {ACROSS}."]
    if seen.comes_to == LOADS:
        return [
            "The springs are still being loaded when the test ends: no force of it shows the "
            "friction of the surfaces."
        ]
    return [_readings(seen), *_largest(seen), *_sliding(seen)]


def _readings(seen: SimulatedTest) -> str:
    """Return the definitions of the apparent coefficients."""
    count = len(seen.table)
    if not count:
        return (
            "The apparent static friction is the largest force of the test over the normal load, "
            "the kinetic one the mean force of sliding over it."
        )
    many = f"{count} cycles" if count > 1 else "the only cycle"
    return (
        "The apparent static friction is the largest force of the whole test over the normal load; "
        f"the kinetic one, force drop and period are means over {many}. So the difference of both "
        "coefficients need not be half of the mean force drop."
    )


def _largest(seen: SimulatedTest) -> list[str]:
    """Return the difference between the largest force and friction, with its reason."""
    friction, before, at = largest_force(seen)
    read, true = peak(seen), friction.coefficient
    if not (read > 0.0 and true > 0.0):  # a test that ended before it began
        return []
    shown = f"{_number(read)} of the normal load"
    if abs(read / true - 1.0) <= RIGHT:
        return [
            f"The largest force shows the friction of the surfaces to within {percent(RIGHT)}: it "
            f"is {shown}, and friction in the swing before is {_number(true)} at most."
        ]
    if read > true:
        return [
            f"The largest force is not the friction of the surfaces: it is {shown}, and friction "
            f"in the swing before is {_number(true)} at most. The excess of "
            f"{percent(read / true - 1.0)} is the inertia of the mass, which overshoots."
        ]
    if _slides(seen, before, at):
        return []  # `_sliding` says so of all sliding
    off = (
        f"The largest force is not the friction of the surfaces: the load cell reads {shown}, "
        f"where the true coefficient is {_number(true)}: multiply by {_number(true / read)}."
    )
    if abs(read - friction.read) > RIGHT * read:
        return [
            off,
            f"Friction is largest at {in_words(friction.angle, 'rad')} to the axis of the load "
            "cell, which measures only the part along it; that is largest at another moment of the "
            "slip, in which friction turns and the inertia of the mass takes part.",
        ]
    when = "begins to slide" if seen.comes_to == SLIDES else "slips"
    return [off, f"When the mass {when}, friction stands {_part(seen, friction)}"]


def _part(seen: SimulatedTest, friction: FrictionBeside) -> str:
    """Return the direction of friction, and the component that the load cell measures."""
    share = f", {_number(friction.share)} of friction" if friction.share > LITTLE else ""
    on_x = seen.run.slider.cell_angle is None
    rest = "the spring across carries the rest" if on_x else "the springs carry the rest across it"
    return (
        f"at {in_words(friction.angle, 'rad')} to the axis of the load cell, which measures only "
        f"the part along it{share}; {rest}, {in_words(friction.across, 'N')}."
    )


def _slides(seen: SimulatedTest, first: int, last: int) -> bool:
    """Return whether the mass moves at the drive's speed between two samples."""
    speed = relative_speed(seen.run)[first : last + 1]
    return seen.comes_to == SLIDES and bool(np.abs(speed - 1.0).max() < CALM)


def _sliding(seen: SimulatedTest) -> list[str]:
    """Return the load cell's reading of steady sliding, if it differs from friction."""
    friction = friction_at(seen, len(seen.record) - 1)
    if seen.comes_to != SLIDES or abs(friction.share - 1.0) <= RIGHT:
        return []
    mean = kinetic(seen)
    read = f"{_number(mean if isfinite(mean) else friction.read)} of the normal load"
    _, before, at = largest_force(seen)
    if _slides(seen, before, at):
        read += f" on average and {_number(peak(seen))} at most"
    factor = f": multiply by {_number(1.0 / friction.share)}" if friction.share > LITTLE else ""
    return [
        f"The force of steady sliding is not the friction of the surfaces: the load cell reads "
        f"{read}, where the true coefficient is {_number(friction.coefficient)}{factor}.",
        f"Friction then points along the drive, {_part(seen, friction)}",
    ]


def _number(value: float) -> str:
    return in_words(value, "")
