"""Every number that the paper states, beside the computed one.

A stated number agrees if the computed one rounds to it: the tolerance is half a unit
of the last printed digit. Where the paper says "almost" or "practically", the entry
names the bound. The last part compares this software with the project's reference
values for the set-valued solution (two independent methods), to the digits given there.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, radians, sin

import numpy as np

from stiction import theory
from stiction.system.slider import Slider
from stiction.trajectory import Trajectory


@dataclass(frozen=True)
class Number:
    """One number: its place in the paper, its meaning, both values, and the tolerance.

    A `finding` is wrong in the paper, as far as is known: it is shown, and must not agree.
    """

    where: str
    what: str
    stated: float
    computed: float
    tolerance: float
    unit: str = "1"
    finding: bool = False

    @property
    def deviation(self) -> float:
        """Computed minus stated value, in `unit`."""
        return self.computed - self.stated

    @property
    def agrees(self) -> bool:
        """Whether the deviation is within the tolerance; NaN does not agree."""
        return abs(self.deviation) <= self.tolerance * (1 + 1e-9)

    @property
    def verdict(self) -> str:
        """``agrees``, ``finding`` or ``WRONG``."""
        if self.finding:
            return "finding" if abs(self.deviation) > self.tolerance else "WRONG"
        return "agrees" if self.agrees else "WRONG"


def numbers(run: Trajectory, constant: Trajectory) -> list[Number]:
    """Return all numbers.

    Parameters
    ----------
    run : Trajectory
        Fig. 3's system over 5 s, sampled at 10 kHz or more.
    constant : Trajectory
        The same with constant friction mu_0, over 10 s.
    """
    return [
        *from_theory(run.slider),
        *from_simulation(run),
        *of_creep(run),
        *reference(run),
        *reference_constant(constant),
    ]


def from_theory(slider: Slider) -> list[Number]:
    """Return the numbers that follow from the parameters alone."""
    s, V = slider, slider.motion.rate(0.0)[0]
    omega_y = float(theory.natural_frequency(s.k_y, s.mass))
    A = float(theory.damping_number(s.F_0, V, s.phi, s.mass, s.k_x))
    zeta = float(theory.damping_ratio(A, s.phi))
    wide = radians(10)
    A_wide = float(theory.damping_number(s.F_0, V, wide, s.mass, s.k_x))
    least = float(theory.damping_ratio(A_wide, wide))
    return [
        Number("Results", "stiffness anisotropy k_y/k_x", 1e4, s.k_y / s.k_x, 0.5),
        Number("Fig. 4", "natural frequency omega_y/2pi", 1.0, omega_y / 2e3 / pi, 0.05, "kHz"),
        Number("Eq. (10)", "zeta = A at theta = 90 deg", 3.6e3, A, 50),
        Number(
            "Eq. (10)",
            "zeta at theta = phi = 1 deg",
            1.9e-2,
            zeta,
            5e-4,
        ),
        Number(
            "Fig. 5",
            "times that zeta crosses 1, phi = 1 deg",
            1,
            int(zeta < 1 < A),
            0,
        ),
        Number("Fig. 5", "times that zeta crosses 1, phi = 10 deg", 0, int(least < 1 < A_wide), 0),
    ]


def from_simulation(run: Trajectory) -> list[Number]:
    """Return the numbers that the paper reads off its simulation."""
    from stiction.analysis.creep.first_slip import first_slip_time

    d, slider = run.data, run.slider
    time, slip = d["time"].values, first_slip_time(run)
    stick = (time > 0.05) & (time < 0.9 * slip)
    first = run.stick_intervals[0, 1]
    outset = (time > first) & (time < first + 1e-3)
    early = (time > 0.05) & (time < 0.1)
    drop = 100 * (1 - d["friction"].values[stick].min() / slider.F_0)
    ridge = _ridge(run, 0.1, 0.3) / 1e3
    late = _ridge(run, slip - 0.15, slip - 0.05) / 1e3
    return [
        Number(
            "Results",
            "psi as sliding starts ('almost 90', to 2)",
            90,
            float(d["psi"].values[outset].max()),
            2,
            "deg",
        ),
        Number(
            "Results",
            "drop of F in stick ('constant', to 2 %)",
            0,
            float(drop),
            2,
            "%",
        ),
        Number(
            "Eq. (9)",
            "mean k_y u_y at the start of creep over F_0",
            1,
            float(d["spring_y"].values[early].mean() / slider.F_0),
            0.005,
        ),
        Number(
            "Results",
            "time at full stop until first slip ('never')",
            0,
            100 * float(_stick_share(run, run.stick_intervals[0, 1], slip)),
            0,
            "%",
            finding=True,
        ),
        Number("Fig. 4", "frequency at the start of the stick phase", 1.0, ridge, 0.05, "kHz"),
        Number("Fig. 4", "lower frequency before slip (1: yes)", 1, late < 0.9 * ridge, 0),
        Number(
            "Results",
            "largest k_x u_x over F_0 ('until', to 1 %)",
            1,
            float(d["spring_x"].values[time < slip + 0.1].max() / slider.F_0),
            0.01,
        ),
    ]


def _stick_share(run: Trajectory, start: float, end: float) -> float:
    """Return the fraction of the time between two times (s) at zero slip."""
    within = np.clip(run.stick_intervals, start, end)
    return float(np.diff(within, axis=1).sum() / (end - start))


def _ridge(run: Trajectory, start: float, end: float) -> float:
    """Return the frequency (Hz) of the strongest transverse oscillation between two times (s)."""
    part = run.data["v_y"].sel(time=slice(start, end)).values
    rate = 1 / float(run.data["time"][1] - run.data["time"][0])
    power = np.abs(np.fft.rfft((part - part.mean()) * np.hamming(len(part)), 1 << 15))
    frequency = np.fft.rfftfreq(1 << 15, 1 / rate)
    band = frequency > 200
    return float(frequency[band][power[band].argmax()])


def of_creep(run: Trajectory) -> list[Number]:
    """Compare Eq. (7) with the simulation, and Eq. (8) with Eq. (7)."""
    from stiction.analysis.creep.first_slip import mean_creep_velocity

    s, V = run.slider, run.slider.motion.rate(0.0)[0]
    l_x = s.F_0 / s.k_x
    mean = mean_creep_velocity(run)
    simulated = float(mean.interp(time=1.0))
    exact = float(theory.creep_velocity(1.0, V, s.phi, l_x))
    return [
        Number(
            "Eq. (7)",
            "creep at 1 s, simulated over Eq. (7), to 1 %",
            1,
            simulated / exact,
            0.01,
        ),
        Number(
            "Eq. (8)",
            "corrected, over Eq. (7) at 1 s, to order phi",
            1,
            float(theory.creep_velocity_approximation(1.0, V, s.phi, l_x)) / exact,
            sin(s.phi),
        ),
        Number(
            "Eq. (8)",
            "as printed, over Eq. (7) at 1 s, to order phi",
            1,
            float(theory.creep_velocity_as_printed(1.0, V, s.phi, l_x)) / exact,
            sin(s.phi),
            finding=True,
        ),
    ]


def reference(run: Trajectory) -> list[Number]:
    """Return the set-valued solution's reference values."""
    d = run.data
    time, force = d["time"].values, d["spring_x"].values
    peak = int(force[time < 2.5].argmax())
    trough = peak + int(force[peak:][time[peak:] < time[peak] + 0.3].argmin())
    next_peak = trough + int(force[trough:][time[trough:] < time[trough] + 1.2].argmax())
    where, stick = "reference", float(run.stick_intervals[0, 1])
    return [
        Number(where, "end of the first stick", 11.4595, 1e3 * stick, 5e-5, "ms"),
        Number(where, "first peak of k_x u_x", 1.9926, float(force[peak]), 5e-5, "N"),
        Number(where, "  at", 2.0321, float(time[peak]), 1e-4, "s"),
        Number(where, "first trough of k_x u_x", 1.1686, float(force[trough]), 5e-5, "N"),
        Number(where, "  at", 2.0905, float(time[trough]), 1e-4, "s"),
        Number(where, "period", 0.9151, float(time[next_peak] - time[peak]), 2e-4, "s"),
        Number(where, "largest X'", 26.284, 1e3 * float(d["V_X"].max()), 5e-4, "mm/s"),
        Number(where, "stick intervals in 5 s", 2959, len(run.stick_intervals), 0),
        Number(where, "time stuck in 5 s", 0.323110, run.statistics.time_stuck, 5e-7, "s"),
        Number(where, "u_x(5 s)", 1.3305693378, 1e3 * float(run.final["u_x"]), 1e-10, "mm"),
        Number(where, "u_y(5 s)", 1.474023e-4, 1e3 * float(run.final["u_y"]), 5e-11, "mm"),
    ]


def reference_constant(run: Trajectory) -> list[Number]:
    """Return the reference values for constant friction."""
    d = run.data
    tail = d["spring_x"].sel(time=slice(9.0, None)).values
    return [
        Number("reference", "constant friction: k_x u_x goes to", 1.9997, tail[-1], 5e-5, "N"),
        Number("reference", "  its swing in the last second", 0.0, float(np.ptp(tail)), 1e-5, "N"),
        Number("reference", "  largest X'", 1.6124, 1e3 * float(d["V_X"].max()), 2e-3, "mm/s"),
    ]
