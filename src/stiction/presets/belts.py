"""A block on a belt: Leine's, exact and smoothed in two ways, and Veraszto & Stepan's."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from stiction.drive import ConstantVelocity
from stiction.friction.laws import HyperbolicWeakening, LuGreHyperbolic, Stribeck
from stiction.presets.preset import Published, holds, on_a_line, preset
from stiction.presets.samples import crest, upward_crossings
from stiction.system.description import Description, Settings
from stiction.system.initial import Initial
from stiction.system.slider import Slider

if TYPE_CHECKING:
    from stiction.trajectory import Trajectory

LEINE = "Leine et al., Nonlinear Dynamics 16, 41 (1998)"
PROGRAM = f"{LEINE}; smoothed: Leine's programs for his ENOC 2024 lecture"
LEINE_DOI = "10.1023/A:1008289604683"
BELT = 0.2  # m/s


def _leine(run: Trajectory) -> list[float]:
    starts, ends = run.stick_intervals[1:-1].T  # whole ones, after a first cycle
    whole = slice(*np.searchsorted(run.samples["time"], ends[[0, -1]]))
    return [
        float(np.mean(starts[1:] - ends[:-1])),
        float(np.mean(ends - starts)),
        float(np.mean(np.diff(starts))),
        crest(run.samples["u_x"][whole]),
        -crest(-run.samples["v_x"][whole]),
        len(starts),
    ]


@preset(
    _leine,
    shows="stick-slip on a belt, with exact sticks",
    reference=LEINE,
    doi=LEINE_DOI,
    grade="solid",
    published=(
        Published("length of a slip", 4.296000, 5.1e-7, "s"),
        Published("length of a stick", 7.705032, 5.1e-7, "s"),
        Published("period", 12.001031, 5.1e-7, "s"),
        Published("largest displacement", 1.133945, 5.1e-7, "m"),
        Published("lowest velocity", -0.839902, 5.1e-7, "m/s"),
        Published("whole sticks after the first, in 60 s", 4, 0),
    ),
)
def leine_belt() -> Description:
    """A block of unit mass on a unit spring, on a belt at 0.2 m/s.

    Friction falls hyperbolically, F = 1/(1 + 3 v). The block rides on the belt until the spring
    takes all of the friction, slides back, and lands on the belt again. Friction at zero slip is
    whatever holds, so that slip and stick have lengths with six published digits. Compare
    `leine-arctan` and `leine-lugre`, the same block with smoothed friction.
    """
    slider = on_a_line(friction=_weakening(), drive=ConstantVelocity(BELT))
    return Description(slider, Initial(), Settings(duration=60.0, sample_rate=1e3, rtol=1e-10))


def _weakening() -> HyperbolicWeakening:
    return HyperbolicWeakening(mu_0=1.0, v_h=1 / 3)


def _cycle(run: Trajectory) -> list[float]:
    """Return the period and the largest displacement of the last cycles."""
    late = run.data.isel(time=run.samples["time"] > 0.4 * run.description.run.duration)
    u = late["u_x"].values
    starts = upward_crossings(late["time"].values, u - float(np.mean(u)))
    cycles = slice(*np.searchsorted(late["time"].values, starts[[0, -1]]))
    return [float(np.mean(np.diff(starts))), crest(u[cycles])]


@preset(
    _cycle,
    shows="the block of leine-belt, with the arc tangent in place of the jump",
    reference=PROGRAM,
    doi=LEINE_DOI,
    grade="solid",
    published=(
        Published("period", 11.29815, 1e-4, "s", "computed"),
        Published("largest displacement", 1.06708, 1e-5, "m", "computed"),
    ),
)
def leine_arctan() -> Description:
    """The block of `leine-belt`, with friction F (2/pi) atan(1000 v).

    So smoothed, "stick" is creep along the belt, and the spring never takes all of the friction:
    period and amplitude are 5.9 % too small. The published run covers 11.3 s, about one period,
    from (1.067, 0). The values above agree with it and were found to more digits by two methods.
    """
    slider = on_a_line(friction=_weakening(), drive=ConstantVelocity(BELT))
    start = Initial(u_x=1.067, v_x=0.0, v_y=0.0)
    settings = Settings(
        duration=60.0, sample_rate=1e3, rtol=1e-9, regularisation=1e-3, smoothing="arctan"
    )
    return Description(slider, start, settings)


@preset(
    _cycle,
    shows="the block of leine-belt, on bristles in place of the jump",
    reference=PROGRAM,
    doi=LEINE_DOI,
    grade="solid",
    published=(
        Published("period", 11.01341, 1e-4, "s", "computed"),
        Published("largest displacement", 1.05067, 1e-5, "m", "computed"),
    ),
)
def leine_lugre() -> Description:
    """The block of `leine-belt` with the LuGre model: bristles of 100 N/m and 20 N s/m.

    The published run covers 11.05 s from a point of the cycle. Its function g falls
    hyperbolically with the slip speed.
    """
    law = LuGreHyperbolic(1.0, 1 / 3, 100.0, 20.0)
    slider = on_a_line(friction=law, drive=ConstantVelocity(BELT))
    start = Initial(
        u_x=1.043656607, v_x=0.081148750, v_y=0.0, states={"z_x": -0.007831712, "z_y": 0.0}
    )
    return Description(slider, start, Settings(duration=60.0, sample_rate=1e3, rtol=1e-9))


HOPF, COEXIST = 0.1906160, 0.22  # m/s


def veraszto(V: float) -> Slider:
    """Return Veraszto & Stepan's rig at a belt speed (m/s): F = 2 + 4 exp(-10 v) + 0.2 v, N."""
    return on_a_line(
        mass=0.538,
        k_x=6957.0,
        c_x=5.746,
        friction=Stribeck(mu_s=6.0, mu_c=2.0, v_s=0.1, d=1.0, c=0.2),
        drive=ConstantVelocity(V),
    )


def _veraszto(run: Trajectory) -> list[float]:
    from scipy.optimize import brentq

    from stiction import linear_stability
    from stiction.simulation import simulate

    def growth(V: float) -> float:
        return linear_stability.growth_rate(veraszto(V))

    hopf = float(brentq(growth, 0.15, 0.25, xtol=1e-12))  # type: ignore[no-untyped-call]
    landed = float(run.stick_intervals[1, 0] - run.stick_intervals[0, 1])
    at = float(np.interp(run.stick_intervals[1, 0], run.data["time"], run.data["u_x"]))
    above = simulate(
        veraszto(0.28), 10.0, initial=_start_before_slip(0.28), rtol=1e-9, sample_rate=0
    )
    last = float(above.stick_intervals[:, 1].max(initial=0.0))
    return [
        hopf,
        float(run.slider.law.coefficient(hopf)) / run.slider.k_x,
        1e3 * landed,
        at,
        growth(COEXIST) < 0.0,
        len(run.stick_intervals) > 15,
        last < 5.0,
    ]


def _start_before_slip(V: float) -> Initial:
    """Return the start just before a stick ends, where k u + c V is the static friction."""
    slider = veraszto(V)
    u = (slider.F_0 - slider.c_x * V) / slider.k_x
    return Initial(u_x=u * (1.0 - 1e-12), v_x=V, v_y=0.0)


@preset(
    _veraszto,
    shows="steady sliding and stick-slip at one speed, above a Hopf point",
    reference="Veraszto & Stepan, Int. J. Non-Linear Mech. (2017)",
    doi="10.1016/j.ijnonlinmec.2017.01.006",
    grade="solid",
    published=(
        Published("belt speed at the Hopf point", HOPF, 1e-7, "m/s", "published formula"),
        Published("  steady displacement there", 3.78428e-4, 5e-10, "m", "closed form"),
        Published("length of a slip at 0.22 m/s", 51.3818, 5e-5, "ms", "computed"),
        Published("  displacement where it ends", -2.1994e-4, 5e-9, "m", "computed"),
        holds("steady sliding is stable at 0.22 m/s"),
        holds("stick-slip persists at 0.22 m/s"),
        holds("stick-slip dies out at 0.28 m/s", "computed"),
    ),
)
def veraszto_stepan() -> Description:
    """The hardware-in-the-loop rig of Veraszto & Stepan, at 0.22 m/s, started at break-away.

    Steady sliding loses its stability where the slope of friction takes all of the damping,
    ln[c_v (C_0 - C)/(b_0 + b_s)]/c_v = 0.190616 m/s. The bifurcation is subcritical: above that
    speed steady sliding is stable, and stick-slip is too, up to 0.27 m/s. Which one is seen
    depends on the start.
    """
    settings = Settings(duration=1.0, sample_rate=100e3, rtol=1e-10)
    return Description(veraszto(COEXIST), _start_before_slip(COEXIST), settings)
