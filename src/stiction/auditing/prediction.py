"""Theoretical prediction for an apparatus, from its description alone."""

from __future__ import annotations

from math import atan2, cos, hypot, isfinite, nan, pi, sin, sqrt
from typing import Any, NamedTuple

import numpy as np

from stiction import theory
from stiction.analysis.creep.first_slip import along_force, force_direction, slips_at_once
from stiction.friction import Anisotropic, has_state
from stiction.friction.law import static_coefficient
from stiction.system.slider import Slider
from stiction.system.tensors import damping_tensor, stiffness_tensor

SEEN = 10.0  # samples per transverse period, enough for its shape and not only its frequency
HALF = 32  # places along the first half of a slip where its friction is asked


class Prediction(NamedTuple):
    """Closed forms and estimates, in SI and rad; NaN where the theory does not apply.

    Parameters
    ----------
    F_0, F_static : float
        Friction at vanishing slip, and at rest, N; the latter is larger if the law has a
        separate static coefficient.
    f_x, f_y : float
        Natural frequencies along the soft and the stiff axis, Hz.
    A, zeta : float
        Damping number and damping ratio at theta = phi, Eq. (10).
    theta_c : float
        Force angle at which zeta = 1, where slow slip turns fast, rad.
    phi_c : float
        Misalignment above which steady sliding is stable with a rigid transverse spring, rad;
        NaN for laws with internal state or anisotropy: see `stiction.linear_stability`.
    first_stick : float
        Duration of true rest after the drive starts, s.
    load_up : float
        Time from the start of the drive to the slip, s: the first stick where the springs' force
        then points along the drive; else Eq. (7) until theta_c, or, if zeta stays above 1, until
        the spring alone would carry friction.
    creep_at_start, creep_at_slip : float
        Velocity along the drive at both ends of the loading, Eq. (7), m/s; NaN without creep.
    creep_distance : float
        Distance crept before the slip, m.
    mu_static, mu_kinetic : float
        Apparent coefficients of friction: largest and mean force over load; along the drive, or on
        the load cell where the first stick ends in a slip or the mass slides steadily.
    drop, period : float
        Fall of the force in a slip, N, and time from one slip to the next, s.
    amplitude : float
        Bound of the transverse oscillation, V sin(phi)/omega_y, m.
    sample_rate : float
        Sample rate that shows the transverse oscillation, Hz.
    """

    F_0: float
    F_static: float
    f_x: float
    f_y: float
    A: float
    zeta: float
    theta_c: float
    phi_c: float
    first_stick: float
    load_up: float
    creep_at_start: float
    creep_at_slip: float
    creep_distance: float
    mu_static: float
    mu_kinetic: float
    drop: float
    period: float
    amplitude: float
    sample_rate: float

    @property
    def slips(self) -> bool:
        """Whether slow motion turns fast, by Eq. (10), before friction points along the drive."""
        return isfinite(self.drop)


def predict(slider: Slider) -> Prediction:
    """Return the theoretical prediction for a slider under a steady drive.

    The paper's theory supposes friction that is set-valued at zero slip; for other laws F_0 is that
    at the drive's speed. Only the magnitude of the misalignment counts.
    """
    s, phi = slider, abs(slider.misalignment)
    V = s.drive_speed
    F_0, l_x = s.F_0, s.F_0 / s.k_x
    F_static = F_0 if has_state(s.law) else static_coefficient(s.law) * s.normal_load
    f_x, f_y = s.natural_frequency_x, s.natural_frequency_y
    A = theory.damping_number_of(s, V)
    zeta = float(theory.damping_ratio(A, phi)) if isfinite(A) else 0.0
    theta_c = float(theory.critical_angle(A)) if isfinite(A) else 0.0
    first_stick = first_stick_duration(s, F_static)
    turn = theta_c if theta_c > phi else phi
    fast = zeta < 1.0
    creeps = fast and phi > 0.0 and theta_c > phi  # A < 1: underdamped from the start
    load_up = float(theory.creep_time(turn, V, phi, l_x)) if creeps else l_x / V
    creep = theory.creep_velocity(np.array([0.0, load_up]), V, phi, l_x)
    distance = creep_distance(V, phi, l_x, load_up)
    at_once = slips_at_once(s)
    forces = _at_once(s, F_static) if at_once else _forces(s, F_static, turn, fast)
    peak, mean, drop, period = forces
    if at_once and isfinite(drop):
        load_up, distance, creep = first_stick, 0.0, np.full(2, nan if phi > 0.0 else 0.0)
    return Prediction(
        F_0,
        F_static,
        f_x,
        f_y,
        A,
        zeta,
        theta_c,
        critical_misalignment(slider, V),
        first_stick,
        load_up,
        float(creep[0]),
        float(creep[1]),
        distance,
        peak / s.normal_load,
        mean / s.normal_load,
        drop,
        period,
        float(theory.transverse_amplitude_bound(V, phi, 2.0 * pi * f_y)),
        SEEN * f_y,
    )


def first_stick_duration(slider: Slider, F_static: float) -> float:
    """Return the duration of the first stick from unloaded springs, s, with dampers and grain.

    While it rests springs and dampers carry |K v t + C v|, v the drive's velocity, until this is
    the static friction. Along and across a grain each component counts in its own coefficient.
    """
    s, law = slider, slider.law
    v = s.motion.rate(0.0)[0] * np.array(s.direction)
    loading, held = np.array([s.k_x, s.k_y]) * v, damping_tensor(s) @ v
    if isinstance(law, Anisotropic):
        angle = s.misalignment + law.angle
        along, across = np.array([cos(angle), sin(angle)]), np.array([-sin(angle), cos(angle)])
        limit = np.stack([along, across / law.ratio])
        loading, held = limit @ loading, limit @ held
    rate, first = hypot(*loading), hypot(*held)
    if first >= F_static:
        return 0.0
    mean = float(loading @ held) / rate
    # (rate t)^2 + 2 mean (rate t) + first^2 = F_static^2
    return (sqrt(mean**2 + F_static**2 - first**2) - mean) / rate


def _at_once(slider: Slider, F_static: float) -> tuple[float, float, float, float]:
    """Return `_forces` for a mass that slips at the end of the first stick.

    Both springs load together, until they carry the static friction; then the mass swings on both,
    along their force. That it does again and again about a mean that lies along the drive, as all
    friction does on average. The load cell measures the parts of both along its axis. Dampers that
    are critical for that swing let nothing slip.
    """
    (k, m, swing), direction = swing_of_slip(slider), np.array(force_direction(slider))
    drop, mean = stick_slip(slider, F_static, k, m)
    damping = float(direction @ damping_tensor(slider) @ direction)
    if not drop > 0.0 or damping >= 2.0 * sqrt(k * m):
        return _steadily(slider)
    rate = slider.drive_speed * hypot(*(stiffness_tensor(slider) @ slider.direction))
    period = stick_slip_period(slider, drop, k, m, rate)
    along = _on_cell(slider, slider.direction)
    first, later = swing * (mean + 0.5 * drop), along * mean + 0.5 * swing * drop
    return max(first, later), along * mean, swing * drop, period


def swing_of_slip(slider: Slider) -> tuple[float, float, float]:
    """Return stiffness (N/m) and mass (kg) of a slip's swing, and the share on the load cell.

    It is along the force where the first stick ends in a slip, else along the soft spring.
    """
    if not slips_at_once(slider):
        return slider.k_x, slider.masses[0], 1.0
    return *along_force(slider), _on_cell(slider, force_direction(slider))


def _on_cell(slider: Slider, direction: tuple[float, float]) -> float:
    """Return the share of a force in a direction (x, y) that the load cell measures."""
    return float(abs(slider.load_cell.along(*direction)))


def _forces(
    slider: Slider, F_static: float, turn: float, fast: bool
) -> tuple[float, float, float, float]:
    """Return peak and mean of the force, its fall in a slip (N), and the period (s).

    The last two are NaN without a slip. `turn` is the force angle at slip, rad; `fast`, whether
    slow motion turns fast before friction points along the drive.
    """
    s, phi = slider, abs(slider.misalignment)
    # without misalignment friction does not turn, and the mass rests until the spring slips
    peak = F_static if phi == 0.0 else s.F_0 * cos(turn)
    k, m = s.k_x, s.masses[0]
    drop, mean = stick_slip(s, peak, k, m) if fast else (nan, peak)
    if drop > 0.0:  # the force rises until the mass is as fast as the drive
        period = stick_slip_period(s, drop, k, m, k * s.drive_speed * cos(s.misalignment))
        return mean + 0.5 * drop, mean, drop, period
    steady = _steadily(s)
    return (max(peak, steady[0]), *steady[1:]) if fast else steady


def _steadily(slider: Slider) -> tuple[float, float, float, float]:
    """Return `_forces` for a mass that reaches steady sliding, with friction along the drive.

    Friction does not fall below the spring's force.
    """
    friction = slider.law.coefficient(slider.drive_speed) * slider.normal_load
    steady = friction * _on_cell(slider, slider.direction)
    return steady, steady, nan, nan


def critical_misalignment(slider: Slider, V: float) -> float:
    """Return phi_c in closed form (rad), see `stiction.theory.critical_misalignment`."""
    law: Any = slider.law
    if has_state(law) or isinstance(law, Anisotropic):
        return nan
    friction = law.coefficient(V), law.slope(V)
    W, c_x = slider.normal_load, slider.c_x
    return float(theory.critical_misalignment(V, *friction, c_x=c_x, W=W))


def creep_distance(V: float, phi: float, l_x: float, t: float) -> float:
    """Return the displacement (m) of the mass along X at time `t`, by Eq. (7).

    X = V t - u_x cos(phi) - u_y sin(phi), Eq. (6), with u_y constant from the first stick on.
    """
    return V * t - float(theory.creep_elongation(t, V, phi, l_x)) * cos(phi)


def stick_slip(slider: Slider, peak: float, stiffness: float, mass: float) -> tuple[float, float]:
    """Return the fall of the force in a slip from `peak`, and its mean in the slip (N).

    A free swing of the mass on a spring about the mean friction, from rest at the force `peak`, by
    (E1) and (E2) of docs/explanation/estimates.md. The fall is below zero where there is none.
    """
    V, scale = slider.drive_speed, sqrt(stiffness * mass)
    coefficient, load = slider.law.coefficient, slider.normal_load
    mean, swing = 0.5 * peak, 0.0
    for _ in range(60):  # damped by one half: steeply weakening friction would overshoot
        over = max(peak - mean, 0.0)
        swing, early = hypot(over, scale * V), atan2(scale * V, over)
        tau = (np.arange(HALF) + 0.5) * ((0.5 * pi + early) / HALF) - early  # its half: both alike
        speed = np.maximum(V + swing / scale * np.sin(tau), 0.0)
        before, share = mean, speed / speed.sum()
        mean = 0.5 * (mean + load * float(np.dot([coefficient(v) for v in speed.tolist()], share)))
        if mean == before:
            break
    return 2.0 * (swing if peak > mean else peak - mean), mean


def stick_slip_period(
    slider: Slider, drop: float, stiffness: float, mass: float, rate: float
) -> float:
    """Return the time between slips (s) in which the force falls by `drop` (N); NaN without.

    By (E3) of docs/explanation/estimates.md; at rest the force rises at `rate` (N/s).
    """
    by_drive = slider.drive_speed * sqrt(stiffness * mass)
    over = sqrt(max((0.5 * drop) ** 2 - by_drive**2, 0.0)) if isfinite(drop) else nan
    slip = (pi + 2.0 * atan2(by_drive, over)) * sqrt(mass / stiffness)
    return 2.0 * over / rate + slip
