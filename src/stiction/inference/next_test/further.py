"""Possible tests of a rig: the present one, and possible additions to it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, NamedTuple

import numpy as np
from pydantic import AfterValidator, Field

from stiction.drive import ConstantVelocity
from stiction.inference.cycles import LEAST_CYCLES, slip_cycles
from stiction.inference.features import USED
from stiction.inference.observation import PER_CYCLE, Conditions, Noise
from stiction.inference.simulated.jitter import Jitter, move
from stiction.inference.simulated.synthetic import LONGEST_CYCLE
from stiction.system.slider import Slider
from stiction.text.quantity.wording import in_words
from stiction.text.units import Angle, Force, PositiveLength, PositiveSpeed, Whole
from stiction.text.validation import Described

ANGLES = ("2 deg", "5 deg")
SIMULATIONS = 2000  # rigs
FEWEST_SIMULATIONS = 200  # of them: half may slide
CYCLES = 20  # of a test, where no record says how many it has
VELOCITIES, LOADS = (1.0 / 3.0, 3.0), (0.5, 2.0)  # to try, over the present ones
SMALLEST_DROP = 0.02  # of the friction force at rest: less is a vibration beside steady sliding
NOISE = 0.002  # of the friction force at rest: of a load cell, where neither record nor user says
AGAIN = "the same test again"
CHANNEL_NAMES = {"force_across": "the force across", "position": "the displacement"}


def _with_force(channels: tuple[str, ...]) -> tuple[str, ...]:
    """Refuse channels that no test has, or a test without force."""
    if "force" not in channels or not set(channels) <= set(USED):
        raise ValueError(
            f"must be force, and any of {', '.join(USED[1:])}; is {', '.join(channels) or 'none'}"
        )
    return channels


class Wanted(Described):
    """The arguments of `stiction.design`, in SI."""

    channels: Annotated[tuple[str, ...], AfterValidator(_with_force)] = ("force",)
    angles: tuple[Angle, ...] = Field(default=ANGLES, validate_default=True)
    velocities: tuple[PositiveSpeed, ...] | None = None
    loads: tuple[Force, ...] | None = None
    noise: Force | None = None
    position_noise: PositiveLength | None = None
    simulations: Annotated[Whole, Field(ge=FEWEST_SIMULATIONS)] = SIMULATIONS

    @property
    def noises(self) -> dict[str, float | None]:
        """The given noise of a sample of each channel."""
        forces = dict.fromkeys(("force", "force_across"), self.noise)
        return {**forces, "position": self.position_noise}


class Further(NamedTuple):
    """The present test, and its addition.

    Parameters
    ----------
    name : str
        What is added, in words.
    channels : tuple of str
        That are measured.
    record : Conditions or None
        Of a further record; None if the present one is all.
    """

    name: str
    channels: tuple[str, ...]
    record: Conditions | None = None


def usual_conditions(slider: Slider) -> Conditions:
    """Return the conditions of a test without a record yet, except its cycles."""
    motion = slider.motion
    velocity = motion.rate(0.0)[0] if isinstance(motion, ConstantVelocity) else 0.0
    return Conditions(velocity, slider.normal_load, 0.0, 0.0, CYCLES, 0.0, {})


def with_noise(
    conditions: Conditions, slider: Slider, wanted: Wanted, averaged: int = 1
) -> Conditions:
    """Return conditions in which every channel has a noise: given, known, or usual.

    The given noise is that of a sample; the conditions are those of means of `averaged` samples.
    """
    known, root = conditions.noise, averaged**0.5
    level = {n: None if noise is None else noise / root for n, noise in wanted.noises.items()}
    own = known["force"].error if "force" in known else NOISE * slider.F_0
    force = level["force"] or own
    usual = {
        "force": Noise(force),
        "force_across": Noise(force),
        "position": Noise(level["position"] or force / slider.k_x),
    }
    kept = {name: its._replace(level=level[name] or its.level) for name, its in known.items()}
    return conditions._replace(noise={**usual, **kept})


def with_cycle(conditions: Conditions, slider: Slider) -> Conditions | None:
    """Return conditions with the cycle length, found by simulation; None without stick-slip."""
    rig = conditions.slider_of(slider)
    guess = rig.loading_time
    wanted = 2 * LEAST_CYCLES  # the first slips may be too small for cycles, and the last is cut
    times = guess / PER_CYCLE * np.arange(LONGEST_CYCLE * wanted * PER_CYCLE)
    motion = move(
        rig, times, Jitter(0.0, 0.0), np.random.default_rng(0), cycle=guess, cycles=wanted
    )
    force = rig.k_x * motion.rows[:, 0]
    found = slip_cycles(force)
    if len(motion.troughs) < wanted or len(found.peak) < LEAST_CYCLES:
        return None
    if np.mean(force[found.peak] - force[found.after]) < SMALLEST_DROP * rig.F_0:
        return None
    cycle = float(np.mean(found.after - found.before)) * float(times[1])
    return conditions._replace(cycle=cycle, step=cycle / PER_CYCLE)


def further_tests(
    present: Conditions, channels: tuple[str, ...], wanted: Wanted
) -> Iterator[Further]:
    """Yield possible additions: channels, the same test again, and tests under other conditions."""
    absent = [name for name in USED if name not in channels]
    for name in absent:
        yield Further(CHANNEL_NAMES[name], (*channels, name))
    if len(absent) > 1:
        yield Further(" and ".join(CHANNEL_NAMES[name] for name in absent), USED)
    yield Further(AGAIN, channels, present)
    for angle in wanted.angles:
        its = present._replace(yaw=present.yaw + angle)
        yield Further(f"turned by {in_words(angle, 'rad')}", channels, its)
    speeds, loads = (
        [float(f"{factor * value:.2g}") for factor in factors]  # as anybody would set it
        for factors, value in ((VELOCITIES, abs(present.velocity)), (LOADS, present.normal_load))
    )
    for velocity in speeds if wanted.velocities is None else wanted.velocities:
        its = present._replace(velocity=float(np.copysign(velocity, present.velocity)))
        yield Further(f"at {in_words(velocity, 'm/s')}", channels, its)
    for load in loads if wanted.loads is None else wanted.loads:
        yield Further(f"under {in_words(load, 'N')}", channels, present._replace(normal_load=load))
