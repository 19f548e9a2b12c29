"""Theoretical prediction for an apparatus, from its description alone."""

from __future__ import annotations

from math import atan2, cos, hypot, isfinite, nan, pi, sin, sqrt
from typing import Any, NamedTuple

import numpy as np

from stiction import theory
from stiction.analysis.creep.first_slip import along_force, force_off_drive, slips_at_once
from stiction.friction import Anisotropic, has_state
from stiction.friction.law import static_coefficient
from stiction.system.slider import Slider
from stiction.system.tensors import damping_tensor

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
        Apparent coefficients of friction: largest and mean force over load.
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
    peak, mean, drop = _forces(s, F_static, turn, fast)
    if isfinite(drop) and slips_at_once(s):
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
        stick_slip_period(s, drop),
        float(theory.transverse_amplitude_bound(V, phi, 2.0 * pi * f_y)),
        SEEN * f_y,
    )


def first_stick_duration(slider: Slider, F_static: float) -> float:
    """Return how long the mass rests from unloaded springs on (s), dampers and grain included.

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


def _forces(slider: Slider, F_static: float, turn: float, fast: bool) -> tuple[float, float, float]:
    """Return the peak and the mean of the force, and its fall in a slip, N; NaN without a slip.

    `turn` is the force angle at slip, rad; `fast`, whether slow motion turns fast before friction
    points along the drive.
    """
    s, phi = slider, abs(slider.misalignment)
    if slips_at_once(s):  # both springs load together, until they carry the static friction
        along = cos(force_off_drive(s))
        drop, mean = (along * each for each in stick_slip(s, F_static, *along_force(s)))
        peak = along * F_static
    else:  # without misalignment friction does not turn, and the mass rests until the spring slips
        peak = F_static if phi == 0.0 else s.F_0 * cos(turn)
        drop, mean = stick_slip(s, peak, s.k_x, s.masses[0]) if fast else (nan, peak)
    if drop > 0.0:
        return mean + 0.5 * drop, mean, drop  # it rises until the mass is as fast as the drive
    # friction does not fall below the spring's force: steady sliding follows
    steady = s.law.coefficient(s.drive_speed) * s.normal_load * cos(phi)
    return max(peak, steady) if fast else steady, steady, nan


def critical_misalignment(slider: Slider, V: float) -> float:
    """Return phi_c in closed form (rad), see `stiction.theory.critical_misalignment`."""
    law: Any = slider.law
    if has_state(law) or isinstance(law, Anisotropic):
        return nan
    friction = law.coefficient(V), law.slope(V)
    W, c_x = slider.normal_load, slider.c_x
    return float(theory.critical_misalignment(V, *friction, c_x=c_x, W=W))


def creep_distance(V: float, phi: float, l_x: float, t: float) -> float:
    """Return the distance (m) that the mass has moved along X by Eq. (7) at time `t`.

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


def stick_slip_period(slider: Slider, drop: float) -> float:
    """Return the time from slip to slip (s) if the force falls by `drop` (N) in each; NaN if not.

    By (E3) of docs/explanation/estimates.md.
    """
    V, k = slider.drive_speed, slider.k_x
    by_drive = V * sqrt(k * slider.masses[0])
    over = sqrt(max((0.5 * drop) ** 2 - by_drive**2, 0.0)) if isfinite(drop) else nan
    slip = (0.5 + atan2(by_drive, over) / pi) / slider.natural_frequency_x
    return 2.0 * over / (k * V * cos(slider.misalignment)) + slip
