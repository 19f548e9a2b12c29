"""Friction tests by name, scaled to a description: the menus of drive and load.

A new test is a function here and a line in `TESTS`; the first of each table is what a description
without a program has.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from stiction.drive import ConstantVelocity, Drive, DriveProgram, LoadProgram
from stiction.drive.pieces import Harmonic, Modulation
from stiction.drive.procedures import (
    end,
    load_ramp,
    reversal_loops,
    slide_hold_slide,
    velocity_steps,
)
from stiction.errors import StictionError, echo
from stiction.system.description import Description
from stiction.text.quantity.wording import in_words

SPEED = 1e-3  # m/s, where the drive stands
LONGEST = 1e3  # durations of the run in which the drive must load its spring
SLIDES = 1.5  # times the loading: by then the mass slides, after its creep too


def protocol(description: Description, table: str, name: str) -> Description:
    """Return a description with another test in its table ``drive`` or ``load``.

    Raises
    ------
    StictionError
        If there is no such test.
    """
    if name not in TESTS.get(table, {}):
        raise StictionError(f"no protocol {echo(name)} of {echo(table)}; known: {names()}")
    slider = description.slider.replace(**{table: TESTS[table][name](description)})
    settings = description.run
    if (lasts := end(slider.drive, slider.load)) is not None and lasts > settings.duration:
        settings = settings.model_copy(update={"duration": lasts})
    return description._replace(slider=slider, run=settings)


def names() -> dict[str, list[str]]:
    """Return the names of the tests of drive and load."""
    return {table: [*tests] for table, tests in TESTS.items()}


def speed(description: Description) -> float:
    """Return the drive's base velocity, m/s."""
    return float(description.slider.motion.velocity) or SPEED


def neat(value: float) -> float:
    """Return a value with three digits, as one would write it."""
    return float(f"{value:.3g}")


def loading(description: Description) -> float:
    """Return how long the drive loads the softer spring until the mass slides, s.

    Raises
    ------
    StictionError
        If that is far longer than the run.
    """
    slider = description.slider
    takes = slider.F_0 / (min(slider.k_x, slider.k_y) * abs(speed(description)))
    if takes > LONGEST * description.run.duration:
        raise StictionError(
            f"the drive takes {in_words(takes, 's')} to load the spring until the mass slides, "
            "too long for this test; raise stiffness or velocity, or let the run last longer"
        )
    return takes


def steps(description: Description) -> DriveProgram:
    """Return a step to ten times the velocity, and back, once the mass slides."""
    V, third = speed(description), description.run.duration / 3
    return velocity_steps([V, 10 * V, V], duration=neat(max(third, SLIDES * loading(description))))


def holds(description: Description) -> DriveProgram:
    """Return sliding, with two holds."""
    part = description.run.duration / 9
    slide = max(2 * part, SLIDES * loading(description))
    return slide_hold_slide(speed(description), [neat(part), neat(2 * part)], slide=neat(slide))


def loops(description: Description) -> DriveProgram:
    """Return two loops to and fro, in which the mass slides both ways."""
    V = abs(speed(description))
    lasts = max(description.run.duration / 4.5, 2.0 * SLIDES * loading(description))
    return reversal_loops(V, neat(V * lasts), loops=2)


def swings(description: Description) -> DriveProgram:
    """Return an oscillation about the velocity, ten times in the run."""
    V = speed(description)
    swing: Any = Harmonic(0.5 * V, 10 / description.run.duration)
    return DriveProgram(velocity=V, program=(swing,))


def vibrates(description: Description) -> DriveProgram:
    """Return a constant velocity with a harmonic across it, of the fast natural frequency."""
    V = speed(description)
    _, fast = description.slider.natural_frequencies
    return DriveProgram(velocity=V, across=Modulation(0.5 * V, 0.1 * fast))


def constant(description: Description) -> Drive:
    """Return the base velocity."""
    return ConstantVelocity(speed(description))


def steady(description: Description) -> None:
    """Return no program: the load is the slider's."""
    return None


def ramp(description: Description) -> LoadProgram:
    """Return a ramp to twice the load, and back."""
    load, half = description.slider.normal_load, description.run.duration / 2
    return load_ramp([2 * load, load], ramp=half)


def breathing(description: Description) -> LoadProgram:
    """Return a load that swings by a fifth, ten times in the run."""
    load = description.slider.normal_load
    swing: Any = Modulation(0.2 * load, 10 / description.run.duration)
    return LoadProgram(modulation=swing)


TESTS: dict[str, dict[str, Callable[[Description], Any]]] = {
    "drive": {
        "constant velocity": constant,
        "velocity steps": steps,
        "slide-hold-slide": holds,
        "reversal loops": loops,
        "harmonic": swings,
        "vibration across": vibrates,
    },
    "load": {"constant load": steady, "load ramp": ramp, "harmonic load": breathing},
}
