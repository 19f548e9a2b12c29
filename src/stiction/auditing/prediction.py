"""What theory says of an apparatus, from its description alone."""

from __future__ import annotations

from math import cos, hypot, isfinite, nan, pi, sin, sqrt, tan
from typing import Any, NamedTuple

import numpy as np

from stiction import theory
from stiction.friction import Anisotropic, has_state
from stiction.friction.law import static_coefficient
from stiction.system.slider import Slider
from stiction.text.units import in_words

SEEN = 10.0  # samples a transverse period: enough to see its shape, not just its frequency
# of the time until the slip: a first stick that is longer is no short beginning, as in Eq. (7)
SHORT = 0.1
SLOWLY = 10.0  # rad of a free swing: what loads in less is no slow motion
DAMPED = 0.2  # twice the damping ratio of a spring by itself: above, it counts beside friction
QUARTER_TURN = pi / 4.0


class Prediction(NamedTuple):
    """Closed forms and estimates, in SI and rad; not a number where theory has nothing to say.

    Parameters
    ----------
    F_0, F_static : float
        Friction at vanishing slip, and what holds at rest, which is more where the law has a
        separate static coefficient, N.
    f_x, f_y : float
        Natural frequencies along the soft and the stiff axis, Hz.
    A, zeta : float
        Damping number and damping ratio at theta = phi, Eq. (10).
    theta_c : float
        Force angle at which zeta = 1, where slow slip turns fast, rad.
    phi_c : float
        Misalignment from which on steady sliding is stable, for a rigid transverse spring, rad;
        not a number for laws with internal state or a grain: see `stiction.linear_stability`.
    first_stick : float
        How long the mass really rests when the drive starts, s.
    load_up : float
        From the start of the drive to the slip: Eq. (7) until theta_c, s; where zeta stays above
        1, until the spring alone would carry friction.
    creep_at_start, creep_at_slip : float
        Velocity along the drive at both ends of that, Eq. (7), m/s.
    creep_distance : float
        How far it has crept when it slips, m.
    mu_static, mu_kinetic : float
        What would be read as coefficients of friction: largest and mean force over load.
    drop, period : float
        Fall of the force in a slip, N, and time from one slip to the next, s.
    amplitude : float
        Bound of the transverse oscillation, V sin(phi)/omega_y, m.
    sample_rate : float
        What it takes to see the transverse oscillation, Hz.
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
        """Whether Eq. (10) has the slow motion turn fast before friction points along the drive."""
        return isfinite(self.drop)


def predict(slider: Slider) -> Prediction:
    """Return what theory says of a slider under a steady drive.

    The paper's theory is for friction that is set-valued at zero slip; for other laws F_0 is
    taken at the drive's speed. The misalignment counts by its size, not by its sign.
    """
    s, phi = slider, abs(slider.phi)
    V = hypot(*s.motion.rate(0.0))
    F_0, l_x = s.F_0, s.F_0 / s.k_x
    F_static = F_0 if has_state(s.law) else static_coefficient(s.law) * s.normal_load
    omega_x, omega_y = (float(theory.natural_frequency(k, s.mass)) for k in (s.k_x, s.k_y))
    A = float(theory.damping_number(F_0, V, phi, s.mass, s.k_x))
    zeta = float(theory.damping_ratio(A, phi)) if isfinite(A) else 0.0
    theta_c = float(theory.critical_angle(A)) if isfinite(A) else 0.0
    first_stick = float(theory.first_stick_duration(F_static, V, phi, s.k_x, s.k_y))
    turn = theta_c if theta_c > phi else phi
    fast = zeta < 1.0
    creeps = fast and phi > 0.0 and theta_c > phi  # A < 1: underdamped from the start
    load_up = float(theory.creep_time(turn, V, phi, l_x)) if creeps else l_x / V
    creep = theory.creep_velocity(np.array([0.0, load_up]), V, phi, l_x)
    peak = F_0 * cos(turn)
    if phi == 0.0:  # friction does not turn: it rests until the spring carries what holds it
        load_up, peak = first_stick, F_static
    drop, mean = stick_slip(slider, peak) if fast else (nan, peak)
    if not drop > 0.0:  # friction does not fall below what the spring held: it comes to slide
        drop, mean = nan, s.law.coefficient(V) * s.normal_load * cos(phi)
        peak = max(peak, mean) if fast else mean
    return Prediction(
        F_0,
        F_static,
        omega_x / (2.0 * pi),
        omega_y / (2.0 * pi),
        A,
        zeta,
        theta_c,
        critical_misalignment(slider, V),
        first_stick,
        load_up,
        float(creep[0]),
        float(creep[1]),
        crept(V, phi, l_x, load_up),
        peak / s.normal_load,
        mean / s.normal_load,
        drop,
        drop / (s.k_x * V * cos(phi)) + pi / omega_x,
        float(theory.transverse_amplitude_bound(V, phi, omega_y)),
        SEEN * omega_y / (2.0 * pi),
    )


def suppositions(slider: Slider, p: Prediction) -> list[str]:
    """Return what Eqs. (7) and (10) suppose and this apparatus is not, a sentence each."""
    s, phi, V = slider, abs(slider.phi), hypot(*slider.motion.rate(0.0))
    law: Any = s.law
    if has_state(law):
        return [f"friction has no internal state (here F_0 is that at {in_words(V, 'm/s')})"]
    found = []
    if isinstance(law, Anisotropic):
        found.append("the surface has no grain")
    if s.k_y <= s.k_x or phi > QUARTER_TURN:
        found.append("the soft spring is the one along the drive")
    elif phi != 0.0 and p.first_stick > SHORT * p.load_up:
        ratio, share = s.k_y * tan(phi) / s.k_x, p.first_stick / p.load_up
        found.append(
            f"the transverse spring is loaded at once, k_y tan φ ≫ k_x (here {ratio:.3g} k_x: the "
            f"first stick takes {share:.0%} of the time until the slip that they give)"
        )
    if 2.0 * pi * p.f_x * p.load_up < SLOWLY:
        found.append(
            f"loading is slow beside a free swing (here {in_words(p.load_up, 's')} beside "
            f"{in_words(1.0 / p.f_x, 's')})"
        )
    if phi != 0.0 and p.F_static > p.F_0 * (1.0 + 1e-9):
        found.append("no static friction above the kinetic one ends each rest with a jump")
    weakening = -float(law.slope(0.0)) * s.normal_load
    if phi != 0.0 and weakening > 2.0 * sqrt(s.mass * s.k_y):
        found.append(
            "friction weakens gently (here so steeply that each rest ends in a slip of its own)"
        )
    if max(s.c_x / sqrt(s.k_x * s.mass), s.c_y / sqrt(s.k_y * s.mass)) > DAMPED:
        found.append("nothing but friction damps")
    return found


def critical_misalignment(slider: Slider, V: float) -> float:
    """Return phi_c in closed form (rad), see `stiction.theory.critical_misalignment`."""
    law: Any = slider.law
    if has_state(law) or isinstance(law, Anisotropic):
        return nan
    friction = law.coefficient(V), law.slope(V)
    W, c_x = slider.normal_load, slider.c_x
    return float(theory.critical_misalignment(V, *friction, c_x=c_x, W=W))


def crept(V: float, phi: float, l_x: float, t: float) -> float:
    """Return how far the mass has moved along X by Eq. (7) at time `t` (m).

    X = V t - u_x cos(phi) - u_y sin(phi), Eq. (6), with u_y constant from the first stick on.
    """
    return V * t - float(theory.creep_elongation(t, V, phi, l_x)) * cos(phi)


def stick_slip(slider: Slider, peak: float) -> tuple[float, float]:
    """Return by how much the force falls in a slip from `peak`, and its mean in the slip (N).

    An estimate: the slip is half a free swing of the mass on the soft spring, s = v sin(tau),
    about the mean of friction along its way, F = (1/2) integral of F(v sin(tau)) sin(tau); the
    fastest slip v = (peak - F)/sqrt(k_x m) + V follows from it, and it from v. It ends as far
    below the mean as it began above it.
    """
    V = hypot(*slider.motion.rate(0.0))
    tau = (np.arange(64) + 0.5) * (pi / 64)
    mean = 0.5 * peak
    for _ in range(60):  # half of the way each time: friction that weakens steeply would overshoot
        v = max(peak - mean, 0.0) / sqrt(slider.k_x * slider.mass) + V
        force = [slider.law.coefficient(v * sin(at)) * slider.normal_load for at in tau]
        mean = 0.5 * (mean + float(np.mean(force * np.sin(tau)) * pi / 2.0))
    return 2.0 * (peak - mean), mean
