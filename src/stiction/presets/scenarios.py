"""Scenarios: apparatus with only qualitative published results; parameters are assumed."""

from __future__ import annotations

from math import cos, pi, sin
from typing import TYPE_CHECKING, Any

import numpy as np

from stiction.drive import ConstantVelocity
from stiction.friction.laws import Coulomb, ExponentialWeakening, RateStateAgeing, Stribeck
from stiction.presets.preset import Published, holds, preset
from stiction.system.description import Description, Settings
from stiction.system.initial import Initial
from stiction.system.slider import Slider

if TYPE_CHECKING:
    from stiction.trajectory import Trajectory


def _late(run: Trajectory) -> tuple[float, float]:
    """Return mean and peak-to-peak value of the force along the drive in the second half, N."""
    d = run.samples
    force = run.slider.along_drive(d["spring_x"], d["spring_y"])[len(d["time"]) // 2 :]
    return float(force.mean()), float(np.ptp(force))


def _change(run: Trajectory, **changes: Any) -> Trajectory:
    """Return the run with some parameters of its slider changed."""
    from stiction.simulation import run as simulate

    description = run.description
    return simulate(description._replace(slider=description.slider.replace(**changes)))


def _brake(run: Trajectory) -> list[float]:
    angles = ("1 deg", "4 deg", "12 deg", "25 deg")
    means, swings = zip(*(_late(_change(run, phi=phi)) for phi in angles), strict=True)
    falling = bool(np.all(np.diff(swings) < 0.0))
    return [falling, swings[-1] < 1e-6 * means[-1], means[-1] >= max(means[:-1])]


@preset(
    _brake,
    shows="a brake pad set askew does not vibrate",
    reference="Kado et al., Tribology International 78, 41 (2014)",
    doi="10.1016/j.triboint.2014.04.033",
    grade="scenario",
    published=(
        holds("vibration falls from 1 deg over 4 and 12 to 25 deg"),
        holds("at 25 deg there is none"),
        holds("  and the mean braking force is not lower there"),
    ),
    assumed=(
        "mass 0.5 kg; stiffness 20 kN/m along the soft direction, 5 MN/m across",
        "normal load 50 N; friction 0.4 at rest, 0.3 in fast slip, over 50 mm/s",
        "rim speed 20 mm/s; misalignment 4 deg",
    ),
)
def yaw_angle_brake() -> Description:
    """A brake pad on leaf springs that yield in one direction, misaligned with the disc's motion.

    Kado et al. report that misalignment supplies positive damping, suppresses vibration and noise,
    and that one range of angles gives low noise and good braking together. In the model the mean
    braking force even rises where the vibration ends; what falls with the angle is the force along
    the leaf springs.
    """
    slider = Slider(
        mass=0.5,
        k_x=20e3,
        k_y=5e6,
        phi="4 deg",
        normal_load=50.0,
        friction=ExponentialWeakening(mu_0=0.4, mu_inf=0.3, v_f=0.05),
        drive=ConstantVelocity(0.02),
    )
    return Description(slider, Initial(), Settings(duration=1.0, sample_rate=10e3))


SPEEDS = (0.01, 0.03, 0.1, 0.3, 1.0)  # m/s


def _wiper(run: Trajectory) -> list[float]:
    def swing(phi: str, V: float) -> float:
        return _late(_change(run, phi=phi, drive=ConstantVelocity(V)))[1]

    load = run.slider.normal_load
    smooth = all(swing("40 deg", V) < 0.02 * load for V in SPEEDS)
    return [smooth, _late(run)[1] > 0.1 * load]


@preset(
    _wiper,
    shows="a wiper blade with a yaw angle moves smoothly",
    reference="Tadokoro et al., Front. Mech. Eng. (2024)",
    doi="10.3389/fmech.2024.1471045",
    grade="scenario",
    published=(
        holds("at 40 deg smooth motion at every drive speed tried, 10 mm/s to 1 m/s"),
        holds("at 2 deg it vibrates at 30 mm/s", "assumed parameters"),
    ),
    assumed=(
        "mass 0.1 kg; stiffness 1 kN/m along, 500 kN/m across; damping 0.5 N s/m",
        "normal load 5 N; friction 1.0 at rest, 0.4 in the trough, falling over 0.1 m/s, rising "
        "by 0.05 s/m",
        "one angle, of blade and base together, 2 deg; normal motion is not in the model",
    ),
)
def wiper_blade() -> Description:
    """A shortened wiper blade on a flexible base, on wet glass: a Stribeck curve.

    Tadokoro et al. report that large yaw angles of blade and base give smooth motion at every
    drive speed that they tried.
    """
    slider = Slider(
        mass=0.1,
        k_x=1e3,
        k_y=5e5,
        phi="2 deg",
        normal_load=5.0,
        c_x=0.5,
        c_y=0.5,
        friction=Stribeck(mu_s=1.0, mu_c=0.4, v_s=0.1, d=1.0, c=0.05),
        drive=ConstantVelocity(0.03),
    )
    return Description(slider, Initial(), Settings(duration=2.0, sample_rate=10e3))


LEVER = (100.0, 1.0)  # N/m: torsion of the lever, buckling along it


def in_series(contact: float) -> tuple[float, float]:
    """Return the stiffness of lever and contact in series, along both axes, N/m."""
    x, y = (1.0 / (1.0 / lever + 1.0 / contact) for lever in LEVER)
    return x, y


def _tip(run: Trajectory) -> list[float]:
    def sideways(contact: float) -> float:
        k_x, k_y = in_series(contact)
        end = _change(run, k_x=k_x, k_y=k_y, drive=ConstantVelocity(1e-4)).final
        return float(abs(end["Y"]) / np.hypot(end["u_x"], end["u_y"]))

    return [1e9 * float(run.final["Y"]), sideways(1e-2) < 0.01]


def _sideways() -> float:
    """Return Y = W mu sin(phi) cos(phi) (1/k_x - 1/k_y) of the sliding tip, nm."""
    k_x, k_y = in_series(1e3)
    return 1e9 * 20e-9 * 0.3 * sin(pi / 6) * cos(pi / 6) * (1.0 / k_x - 1.0 / k_y)


@preset(
    _tip,
    shows="the tip of a friction force microscope leaves its scan line",
    reference="Agmon et al., Scientific Reports (2018)",
    doi="10.1038/s41598-018-22847-z",
    grade="scenario",
    published=(
        Published("the tip leaves its scan line by", _sideways(), 1e-3, "nm", "closed form"),
        holds(
            "with a soft contact, equal in both axes, by less than 1 % of its lag", "closed form"
        ),
    ),
    assumed=(
        "lever 100 N/m in torsion and 1 N/m along it, contact 1 kN/m; effective mass 1e-11 kg",
        "load 20 nN, constant friction 0.3, scan at 1 um/s and 30 deg; no lattice",
    ),
)
def friction_force_microscope() -> Description:
    """The tip of a cantilever, scanned at an angle to it, without the lattice.

    Torsion and buckling of the cantilever have different stiffness, each in series with the
    contact: 1/k = 1/k_lever + 1/k_contact. The tip therefore moves sideways until it slides. Agmon
    et al. report that slip in polar scans follows the anisotropy of the springs.
    """
    k_x, k_y = in_series(1e3)
    slider = Slider(
        mass=1e-11,
        k_x=k_x,
        k_y=k_y,
        phi="30 deg",
        normal_load=20e-9,
        c_x=1e-5,
        c_y=1e-5,
        friction=Coulomb(0.3),
        drive=ConstantVelocity(1e-6),
        driven="spring",
    )
    return Description(slider, Initial(v_x=0.0, v_y=0.0), Settings(duration=0.1, sample_rate=2e4))


def _paper(run: Trajectory) -> list[float]:
    load = run.slider.normal_load
    soft, stiff = (_late(_change(run, k_x=k, k_y=k))[1] for k in (500.0, 5e3))
    return [soft > 1e-3 * load, stiff < 1e-6 * load]


@preset(
    _paper,
    shows="paper on paper: a stiff stage removes stick-slip",
    reference="Heslot et al., Phys. Rev. E 49, 4973 (1994)",
    doi="",
    grade="scenario",
    published=(
        holds("stick-slip on a soft loading stage"),
        holds("a stiff enough loading stage removes it"),
    ),
    assumed=(
        "mass 0.5 kg, load 5 N; loading spring 500 N/m",
        "ageing law with a = 0.01, b = 0.02, D_c = 20 um, 0.35 at 10 um/s; drive at 10 um/s",
    ),
)
def paper_on_paper() -> Description:
    """A slider with paper on its sole, pulled over paper: rate and state.

    Heslot et al. report that a stiff enough loading stage removes stick-slip. The critical
    stiffness of these assumed parameters is (b - a) W/D_c = 2.5 kN/m.
    """
    law = RateStateAgeing(0.01, 0.02, 20e-6, 0.35, 10e-6)
    slider = Slider(
        mass=0.5,
        k_x=500.0,
        k_y=500.0,
        phi="0 deg",
        normal_load=5.0,
        friction=law,
        drive=ConstantVelocity(10e-6),
    )
    return Description(
        slider, Initial(v_x=0.0, v_y=0.0), Settings(duration=1500.0, sample_rate=50.0)
    )
