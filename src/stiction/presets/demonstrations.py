"""Demonstrations of friction in other programs: PathSim and the Modelica Standard Library."""

from __future__ import annotations

from math import asin, pi
from typing import TYPE_CHECKING

from stiction.drive.protocols import ConstantVelocity, DriveProgram, Modulation
from stiction.friction.laws import Coulomb, Stribeck
from stiction.presets.preset import Published, holds, on_a_line, preset
from stiction.system.description import Description, Settings
from stiction.system.initial import Initial

if TYPE_CHECKING:
    from stiction.trajectory import Trajectory

AT_REST = Initial(v_x=0.0, v_y=0.0)


def _conveyor(run: Trajectory) -> list[float]:
    from stiction.simulation import simulate

    pulled = run.slider.replace(driven="spring")  # no inertia of the belt's acceleration
    light = simulate(pulled, 10.0, initial=AT_REST, sample_rate=0)
    return [float(each.stick_intervals[0, 1]) for each in (run, light)]


@preset(
    _conveyor,
    shows="a box on a conveyor that goes back and forth",
    reference="PathSim, example_stickslip_event.py",
    doi="",
    grade="half",
    published=(
        Published("the box leaves the belt at", 4.6007, 5e-5, "s", "closed form"),
        Published("  without inertia, as its test has it", 4.6540, 5e-5, "s"),
    ),
)
def conveyor() -> Description:
    """A box of 20 kg on a belt that moves as 3 m/s sin(2 pi t/50 s), held by spring and damper.

    It leaves the belt when m v_b' + d v_b + k x exceeds mu m g. The program's own test leaves the
    first term out and slips 53 ms later; that is the same box with the spring's end driven.
    """
    slider = on_a_line(
        mass=20.0,
        k_x=70.0,
        c_x=10.0,
        normal_load=20.0 * 9.81,
        friction=Coulomb(1.5),
        drive=DriveProgram(along=Modulation(3.0, 1 / 50)),
    )
    return Description(slider, AT_REST, Settings(duration=100.0, sample_rate=100.0, rtol=1e-9))


FORCE, FREQUENCY = 25.0, 0.25  # N, Hz


@preset(
    lambda run: [float(run.stick_intervals[0, 1])],
    shows="a mass without a spring, pushed back and forth by a force",
    reference="Modelica Standard Library, Translational.Examples.Friction, stop1",
    doi="",
    grade="half",
    published=(
        Published(
            "first slip",
            asin(15 / FORCE) / (2 * pi * FREQUENCY),
            1e-7,
            "s",
            "closed form",
        ),
    ),
    assumed=("no spring: one of 1 nN/m, which changes the force by some 1e-7 N",),
)
def modelica_force() -> Description:
    """A mass of 1 kg under 25 N sin(2 pi t/4 s), with friction 5 + v + 10 exp(-2 v).

    The plate's acceleration acts as the force; positions are relative to the plate.
    """
    speed = FORCE / (2 * pi * FREQUENCY)
    push = Modulation(speed, FREQUENCY, "-90 deg")
    slider = on_a_line(
        k_x=1e-9,
        friction=Stribeck(mu_s=15.0, mu_c=5.0, v_s=0.5, d=1.0, c=1.0),
        drive=DriveProgram(velocity=speed, along=push),
    )
    return Description(slider, AT_REST, Settings(duration=5.0, sample_rate=1e3, rtol=1e-9))


def _stops(run: Trajectory) -> list[float]:
    end = abs(float(run.final["u_x"]))
    return [end <= 0.016, len(run.stick_intervals), float(run.final["sticking"])]


@preset(
    _stops,
    shows="a mass on a spring that friction brings to rest",
    reference="Modelica Standard Library, Translational.Examples.Friction, stop2",
    doi="",
    grade="half",
    published=(
        holds("at rest within 16 mm of the centre", "closed form"),
        Published("sticks: once, for good", 1, 0, "1", "computed"),
        holds("at rest at the end", "computed"),
    ),
    assumed=("the hard stops at 0.9 m, which the mass would hit, are left out",),
)
def modelica_spring() -> Description:
    """A mass of 1 kg on a spring of 500 N/m, started with 5 m/s, with friction 3 + v + 5 exp(-2 v).

    Friction holds up to 8 N, which the spring exceeds beyond 16 mm from its centre.
    """
    slider = on_a_line(
        k_x=500.0,
        friction=Stribeck(mu_s=8.0, mu_c=3.0, v_s=0.5, d=1.0, c=1.0),
        drive=ConstantVelocity(0.0),
    )
    start = Initial(u_x=-0.25, v_x=5.0, v_y=0.0)
    return Description(slider, start, Settings(duration=5.0, sample_rate=1e3, rtol=1e-9))
