"""Vibration with constant friction: forced (Den Hartog), free, and across the way of a slider."""

from __future__ import annotations

from math import atan, pi, sqrt, tan
from typing import TYPE_CHECKING

import numpy as np

from stiction.drive.protocols import ConstantVelocity, DriveProgram, Modulation
from stiction.friction.laws import Coulomb
from stiction.presets.preset import Published, on_a_line, preset
from stiction.presets.samples import crest
from stiction.system.description import Description, Settings
from stiction.system.initial import Initial

if TYPE_CHECKING:
    from stiction.trajectory import Trajectory

PERIODS = 100  # until the forced vibration is periodic
SAMPLES, FINE_SAMPLES = 100, 20_000  # a period; to measure


def forced_oscillator(r: float, S: float) -> Description:
    """Return Den Hartog's oscillator, m = k = P_0 = 1, at a frequency ratio and a friction ratio.

    With x = d - u, the slip, Eq. (1) is m x'' + k x = m d'' + k d - F sign(x'): the drive
    d = U cos(r t), U = 1/(1 - r^2), acts as the force cos(r t).
    """
    U = 1.0 / (1.0 - r * r)
    drive = DriveProgram(along=Modulation(-U * r, r / (2 * pi)))
    period = 2 * pi / r
    settings = Settings(duration=PERIODS * period, sample_rate=SAMPLES / period, rtol=1e-10)
    return Description(on_a_line(friction=Coulomb(S), drive=drive), Initial(), settings)


def amplitudes(run: Trajectory) -> tuple[float, float, int]:
    """Return both amplitudes of the slip in the period after such a run, and its stops."""
    from stiction.simulation import simulate

    r, end = 2 * pi * run.slider.modulation_frequencies[0], float(run.final["time"])
    after = simulate(
        run.slider,
        2 * pi / r,
        initial=run.state(end),
        sample_rate=FINE_SAMPLES * r / (2 * pi),
        rtol=run.description.run.rtol,
    )
    x = np.cos(r * after.data["time"].values) / (1.0 - r * r) - after.data["u_x"].values
    return crest(x), crest(-x), len(after.stick_intervals)


def exact_amplitude(r: float, S: float) -> float:
    """Return x_0 k/P_0 = sqrt(U^2 - (S W)^2), U = 1/(1 - r^2), W = tan(pi/2r)/r."""
    return sqrt((1 - r * r) ** -2 - (S * tan(pi / (2 * r)) / r) ** 2)


def _den_hartog(run: Trajectory) -> list[float]:
    one, other, stops = amplitudes(run)
    return [one, other, stops]


@preset(
    _den_hartog,
    shows="forced vibration with constant friction, without stops",
    reference="Den Hartog, Phil. Mag. (7) 9, 801 (1930)",
    doi="",
    grade="solid",
    published=(
        Published("amplitude x_0 k/P_0", exact_amplitude(0.7, 0.2), 1e-8, "1", "closed form"),
        Published("  on the other side", exact_amplitude(0.7, 0.2), 1e-8, "1", "closed form"),
        Published("stops in a period", 0, 0, "1", "closed form"),
    ),
)
def den_hartog() -> Description:
    """A mass on a spring, shaken by a harmonic force of 0.7 of its natural frequency.

    Friction is a fifth of the force. Den Hartog gave the amplitude of such vibration without
    stops in closed form, x_0 k/P_0 = sqrt(U^2 - (S W)^2) with U = 1/(1 - r^2) and
    W = tan(pi/2r)/r, which is 1.9277745 here. The benchmark has two more pairs (r, S). The force is
    that of an accelerated plate; the slip is the mass's displacement in his terms.
    """
    return forced_oscillator(0.7, 0.2)


FIRST_PHASE, RADIUS = atan(6 / 13), sqrt(13**2 + 6**2) - 1  # of the first half circle about -1


def _free(run: Trajectory) -> list[float]:
    u, times = run.samples["u_x"], run.samples["time"]
    turns = [crest((-1) ** n * u[_around(times, FIRST_PHASE + n * pi)]) for n in range(7)]
    start = float(run.stick_intervals[0, 0])
    return [*turns, start, float(run.final["u_x"]), len(run.stick_intervals)]


def _around(times: np.ndarray, t: float) -> slice:
    return slice(int(times.searchsorted(t - 0.1)), int(times.searchsorted(t + 0.1)))


@preset(
    _free,
    shows="free vibration that friction brings to rest off centre",
    reference="Siconos, example FrictionOscillator",
    doi="",
    grade="solid",
    published=(
        *(
            Published(f"turning point {n + 1}", RADIUS - 2 * n, 5e-7, "m", "closed form")
            for n in range(7)
        ),
        Published("at rest from", 22.42356, 5e-6, "s"),
        Published("  at", 0.682179, 5e-7, "m"),
        Published("stops", 1, 0),
    ),
)
def free_vibration() -> Description:
    """A mass released with m = k = F = 1 from x = 12 with velocity 6.

    In the phase plane it moves on half circles about -1 and 1 in turn, each two smaller than the
    last, until it stops where the spring cannot overcome friction: a force that is set-valued at
    zero velocity holds it.
    """
    slider = on_a_line(friction=Coulomb(1.0), drive=ConstantVelocity(0.0))
    start = Initial(u_x=12.0, v_x=6.0, v_y=0.0)
    return Description(slider, start, Settings(duration=30.0, sample_rate=1e3, rtol=1e-9))


def shaken_slider(r: float) -> Description:
    """Return a stiff slider, driven at 1 m/s and shaken across with a velocity amplitude `r`."""
    k = 1e6 * (2 * pi) ** 2  # so stiff that the mass lags by 1e-6 of the travel; critically damped
    slider = on_a_line(
        k_x=k,
        c_x=2 * sqrt(k),
        friction=Coulomb(0.3),
        drive=DriveProgram(velocity=1.0, across=Modulation(r, 1.0)),
    )
    return Description(slider, Initial(), Settings(duration=3.0, sample_rate=2e3, rtol=1e-8))


def mean_friction(run: Trajectory) -> float:
    """Return the mean force along X over mu_0 W in the last period of a `shaken_slider` run."""
    last = run.data.isel(time=slice(-2000, None))  # a whole period: the damper's part is nought
    return float(last["spring_x"].mean()) / (0.3 * run.slider.normal_load)


@preset(
    lambda run: [mean_friction(run)],
    shows="vibration across the way lowers friction along it",
    reference="M. Popov, Front. Mech. Eng. (2020), and the rigid limit in closed form",
    doi="10.3389/fmech.2020.00069",
    grade="half",
    published=(Published("mean friction over mu_0 W", 0.64264, 5e-6, "1", "closed form"),),
    assumed=("contact so stiff that the mass follows the drive to 1e-6 of its travel",),
)
def transverse_vibration() -> Description:
    """A slider driven at 1 m/s and shaken across its way at 2 m/s.

    Friction opposes the velocity, which points along the way only part of the time. In the limit
    of a rigid slider the mean friction along the way is mu_0 W (2/pi) K(-r^2), r = 2 the ratio of
    both velocities and K the complete elliptic integral of the parameter -r^2.
    """
    return shaken_slider(2.0)
