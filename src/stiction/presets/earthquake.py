"""Cycles of earthquakes: Gu et al.'s two states to chaos, and Bolotskaya et al.'s block."""

from __future__ import annotations

from math import exp, sqrt
from typing import TYPE_CHECKING

import numpy as np

from stiction.arrays import Floats
from stiction.drive import ConstantVelocity
from stiction.friction.laws import RateStateAgeing, RateStateSlip2
from stiction.presets.preset import Published, holds, on_a_line, preset
from stiction.presets.samples import crest, upward_crossings
from stiction.system.description import Description, Settings
from stiction.system.initial import Initial

if TYPE_CHECKING:
    from stiction.trajectory import Trajectory

GU = "Gu et al., J. Mech. Phys. Solids 32 (1984); values: Becker (2000)"
GU_DOI = "10.1016/0022-5096(84)90007-3"
A, V, D = 0.01, 1e-6, 10e-6  # direct effect; m/s; m: they only set the units
BETA_1, BETA_2, RHO = 1.0, 0.84, 0.048
INERTIA = 1e-8  # m V^2/(a W D_c)
TRANSIENT, LONGEST_RUN = 1.6e4, 1.9e4  # D_c/V


def critical_stiffness() -> float:
    """Return kappa_cr = k_cr D_c/(a W), at which steady sliding loses its stability."""
    c = BETA_1 - 1.0
    root = sqrt(4.0 * RHO**2 * (c + BETA_2) + (c + RHO**2 * (BETA_2 - 1.0)) ** 2)
    return (c + RHO * (2.0 * BETA_1 + (BETA_2 - 1.0) * (2.0 + RHO)) + root) / (2.0 + 2.0 * RHO)


def two_states(share: float, inertia: float = INERTIA) -> Description:
    """Return Gu's system at a share of the critical stiffness, W = 1 N, from x = y = z = 0.1."""
    law = RateStateSlip2(A, BETA_1 * A, D, BETA_2 * A, D / RHO, 0.6, V)
    k = share * critical_stiffness() * A / D
    slider = on_a_line(mass=inertia * A * D / V**2, k_x=k, friction=law, drive=ConstantVelocity(V))
    x = y = z = 0.1  # ln(v/V), (mu - mu*)/a, (b_2/a) ln(V theta_2/D_2)
    states = {"log_theta_1": (y - x - z) / BETA_1, "log_theta_2": z / BETA_2}
    start = Initial(u_x=(0.6 + A * y) / k, v_x=V * (1.0 - exp(x)), v_y=0.0, states=states)
    T = D / V
    return Description(
        slider, start, Settings(duration=LONGEST_RUN * T, sample_rate=4 / T, rtol=1e-9)
    )


def crossings(run: Trajectory) -> tuple[Floats, Floats]:
    """Return the last 64 times (D_c/V) at which the slip passes V upwards, and the force then."""
    t, s = run.samples["time"] * V / D, run.samples["slip_x"]
    late = t > TRANSIENT
    times = upward_crossings(t[late], np.log(s[late] / V))[-65:]
    from scipy.interpolate import CubicSpline

    return times, CubicSpline(t, run.samples["spring_x"])(times)  # type: ignore[no-untyped-call]


def distinct(values: Floats) -> int:
    """Return how many values differ by more than a thousandth of their range."""
    ordered = np.sort(values)
    return 1 + int((np.diff(ordered) > 1e-3 * max(np.ptp(values), 0.1 * A)).sum())


SHARES = {0.95: (1, 33.28194), 0.90: (1, 36.74687), 0.856: (4, 40.06275), 0.8552: (8, 40.12778)}


def _doubling(run: Trajectory) -> list[float]:
    from stiction.simulation import run as simulate

    times, forces = crossings(run)
    gaps = np.diff(times)
    found = [distinct(forces[-64:]), float(gaps.min()), float(gaps.max())]
    for share in SHARES:
        times, forces = crossings(simulate(two_states(share)))
        found += [distinct(forces[-64:]), float(np.diff(times).mean())]
    return found


@preset(
    _doubling,
    shows="period doubling of slow slip, with two states",
    reference=GU,
    doi=GU_DOI,
    grade="solid",
    published=(
        Published("kappa/kappa_cr = 0.86: cycles until one repeats", 2, 0),
        Published("  shorter interval", 37.308, 1e-3, "D_c/V", "computed"),
        Published("  longer interval", 42.165, 1e-3, "D_c/V", "computed"),
        *(
            each
            for share, (count, mean) in SHARES.items()
            for each in (
                Published(f"kappa/kappa_cr = {share:g}: cycles until one repeats", count, 0),
                Published("  mean interval", mean, 1e-3, "D_c/V", "computed"),
            )
        ),
    ),
    assumed=(f"a small mass, m V^2 = {INERTIA:g} a W D_c, where the source has none",),
)
def period_doubling() -> Description:
    """A block with two states of the slip law, at 0.86 of its critical stiffness.

    Below the critical stiffness steady sliding gives way to slow stick-slip; softer still, every
    second cycle differs, then every fourth, every eighth, until no cycle repeats, see
    `two-state-chaos`. The published labels count crossings of a section both ways, twice the cycles
    here. In physical units a = 0.01, D_c = 10 um and V = 1 um/s, which only set the scales.
    """
    return two_states(0.86)


def _chaos(run: Trajectory) -> list[float]:
    times, forces = crossings(run)
    return [distinct(forces[-64:]) > 40, float(np.diff(times).mean())]


@preset(
    _chaos,
    shows="chaos of slow slip, with two states",
    reference=GU,
    doi=GU_DOI,
    grade="solid",
    published=(
        holds("no cycle of 64 repeats, but for a few"),
        Published("mean interval", 40.34, 0.1, "D_c/V", "computed"),
    ),
    assumed=(f"a small mass, m V^2 = {INERTIA:g} a W D_c, where the source has none",),
)
def two_state_chaos() -> Description:
    """The block of `period-doubling`, at 0.8525 of its critical stiffness: a strange attractor."""
    return two_states(0.8525)


BLOCK = RateStateAgeing(0.0144, 0.02312, 0.09, 0.64395, 1e-3)
PERIOD = 3778.075539  # s


def _cycle(run: Trajectory) -> list[float]:
    d = run.data
    t, s = d["time"].values, d["slip_speed"].values
    starts = upward_crossings(t, np.log(s / 1e-3))[-2:]
    last = slice(*np.searchsorted(t, starts))
    period = float(np.diff(starts)[0])
    found = [period, period, 1e-3 * period, crest(s[last]), -crest(-s[last])]
    for name in ("friction", "spring_x"):
        force = 1e-6 * d[name].values[last]
        found += [crest(force), -crest(-force)]
    return found


@preset(
    _cycle,
    shows="earthquakes: slip speed over six decades, once an hour",
    reference="Bolotskaya et al., Geophys. J. Int. 240, 1538 (2025)",
    doi="",
    grade="solid",
    published=(
        Published("period", 3777.96, 0.19, "s"),
        Published("  sharper", PERIOD, 1e-5, "s", "computed"),
        Published("slip in a cycle", 3.77801, 1.9e-4, "m"),
        Published("largest slip rate", 0.199254, 2e-4, "m/s"),
        Published("smallest slip rate", 7.4213e-8, 3.7e-10, "m/s"),
        Published("largest friction", 13.98539, 1.4e-4, "MPa"),
        Published("smallest friction", 10.43880, 1e-4, "MPa"),
        Published("largest spring force", 13.98633, 1.4e-4, "MPa"),
        Published("smallest spring force", 10.43681, 1e-4, "MPa"),
    ),
)
def earthquake_cycle() -> Description:
    """A block with inertia on a weakening fault, per square metre: one earthquake in 3778 s.

    Between earthquakes the block slows to 74 nm/s while the plate moves at 1 mm/s; in an
    earthquake it slips 3.8 m at up to 0.2 m/s. Forces are stresses and stiffness is per area. The
    published values are of a run with a relative tolerance of 1e-6; the sharper period is known to
    ten digits. The start is a point of the cycle, 1500 s after an earthquake.
    """
    slider = on_a_line(
        mass=6e7, k_x=1e6, normal_load=2e7, friction=BLOCK, drive=ConstantVelocity(1e-3)
    )
    slip = 2.42350056e-6
    start = Initial(
        u_x=12.6146904241, v_x=1e-3 - slip, v_y=0.0, states={"log_theta": 3.17945976789}
    )
    settings = Settings(duration=3 * 3800.0, sample_rate=20.0, rtol=1e-9)
    return Description(slider, start, settings)
