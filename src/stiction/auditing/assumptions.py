"""The assumptions of the theory's predictions that an apparatus violates."""

from __future__ import annotations

from collections.abc import Iterator
from math import atan2, degrees, isfinite, pi, sin, sqrt, tan
from typing import Any

import numpy as np

from stiction import theory
from stiction.analysis.creep.first_slip import slips_at_once
from stiction.arrays import Floats
from stiction.auditing.prediction import Prediction, creep_distance, swing_of_slip
from stiction.friction import Anisotropic, has_state
from stiction.system.slider import Slider
from stiction.text.quantity.wording import in_words, percent

# of the time until the slip: Eq. (7) supposes a shorter first stick
SHORT = 0.1
SLOWLY = 10.0  # rad of a free swing: faster loading is not quasistatic
DAMPED = 0.2  # twice the damping ratio of a spring: a larger one matters beside friction
# of the force's fall: friction that has lost so much of it to creep no longer drives a slip as it
# would from F_0
WEAKENED = 0.1
QUARTER_TURN = pi / 4.0
EARLIER = 0.05  # of the creep: a slip that leaves out more of it does not begin where zeta = 1
ANGLES = 2000  # of the friction force, at which creep may turn into slip
# of the creep: what the drive covers in one radian of a free swing. A slip sets in about that
# slowly: a third of it is crept beyond zeta = 1 (measured, from 0.1 to 2 deg and to 8 mm/s)
SET_IN = 0.5
ASKEW = 0.02  # sine of the angle between load cell and spring: 2 % of friction across it is read


def suppositions(slider: Slider, p: Prediction) -> list[str]:
    """Return the assumptions of Eqs. (7) and (10) that the apparatus violates, with its numbers."""
    if has_state(slider.law):
        V = in_words(slider.drive_speed, "m/s")
        return [f"friction has no internal state; here F_0 is that at {V}"]
    return [
        *_of_springs(slider, p),
        *_of_friction(slider, p),
        *_of_masses_and_dampers(slider),
        *_of_load_cell(slider),
    ]


def creep_suppositions(slider: Slider, p: Prediction) -> list[str]:
    """Return the assumptions of Eqs. (7) and (10) on the creep alone that it violates."""
    if has_state(slider.law) or not _creeps(p):
        return []
    covered = slider.drive_speed / (2.0 * pi * p.f_x)
    if covered <= SET_IN * p.creep_distance:
        return []
    return [
        "the slip begins at once where ζ = 1; here it sets in while the drive moves by "
        f"{in_words(covered, 'm')} (V/ω_x), beside {in_words(p.creep_distance, 'm')} of creep"
    ]


def _of_load_cell(s: Slider) -> Iterator[str]:
    """Yield the assumption that the load cell measures k_x u_x, if it measures other forces."""
    cell = s.load_cell
    if abs(cell.y) > ASKEW:
        yield (
            "the load cell lies along the spring's axis x; here it lies at "
            f"{degrees(atan2(cell.y, cell.x)):.4g} deg to it, and reads k_y u_y, too"
        )


def _of_springs(s: Slider, p: Prediction) -> Iterator[str]:
    phi = abs(s.misalignment)
    if s.k_y <= s.k_x or phi > QUARTER_TURN:
        yield "the soft spring is the one along the drive"
    elif phi != 0.0 and p.slips and slips_at_once(s):
        yield (
            "friction turns before the first slip; here k_y tan φ is only "
            f"{s.k_y * tan(phi) / s.k_x:.3g} k_x: both springs load together, and the first stick "
            "ends in a slip"
        )
    elif phi != 0.0 and p.first_stick > SHORT * p.load_up:
        ratio, share = s.k_y * tan(phi) / s.k_x, p.first_stick / p.load_up
        yield (
            f"the transverse spring is loaded at once, k_y tan φ ≫ k_x; here k_y tan φ is only "
            f"{ratio:.3g} k_x, and the first stick takes {percent(share)} of the time until the "
            "predicted slip"
        )
    if 2.0 * pi * p.f_x * p.load_up < SLOWLY:
        yield (
            f"loading takes many natural periods; here it takes {in_words(p.load_up, 's')}, and a "
            f"period {in_words(1.0 / p.f_x, 's')}"
        )


def _of_friction(s: Slider, p: Prediction) -> Iterator[str]:
    law: Any = s.law
    phi = abs(s.misalignment)
    if isinstance(law, Anisotropic):
        yield "the surface has no grain"
    if phi != 0.0 and p.F_static > p.F_0 * (1.0 + 1e-9):
        yield (
            "static friction does not exceed F_0; here it is larger, and each rest ends with a jump"
        )
    weakening = -float(law.slope(0.0)) * s.normal_load
    if phi != 0.0 and weakening > 2.0 * sqrt(s.masses[1] * s.k_y):
        yield "friction weakens gently; here so steeply that each rest ends in a rapid slip"
    elif _creeps(p):
        yield from _of_creep_end(s, p)
    elif not p.slips:
        yield from _of_sliding(s, p)
    k, m, share = swing_of_slip(s)
    swing = s.drive_speed * sqrt(k * m)
    if p.slips and share * swing > WEAKENED * p.drop > 0.0:
        yield (
            "the mass leaves rest slowly beside its slip; here the drive's velocity alone swings "
            f"the force by {in_words(swing, 'N')} (V √(k m))"
        )
    creeps = phi != 0.0 and isfinite(p.creep_at_slip)
    lost = s.F_0 - float(law.coefficient(p.creep_at_slip)) * s.normal_load if creeps else 0.0
    if p.slips and lost > WEAKENED * p.drop:
        yield (
            f"friction is still F_0 when creep turns into slip; here, at "
            f"{in_words(p.creep_at_slip, 'm/s')}, it has lost {in_words(lost, 'N')}"
        )


def _of_creep_end(s: Slider, p: Prediction) -> Iterator[str]:
    """Yield the assumption of creep until zeta = 1, if friction weakens too steeply for it."""
    phi, V = abs(s.misalignment), s.drive_speed
    theta, l_x = weakening_angle(s, p), s.F_0 / s.k_x
    until = creep_distance(V, phi, l_x, float(theory.creep_time(theta, V, phi, l_x)))
    if until < (1.0 - EARLIER) * p.creep_distance:
        yield (
            f"friction is F_0 until ζ = 1, at θ = {degrees(p.theta_c):.4g} deg; here it weakens so "
            f"steeply that creep turns into slip from {degrees(theta):.4g} deg on: the mass has "
            f"crept {in_words(until, 'm')} there"
        )


def _of_sliding(s: Slider, p: Prediction) -> Iterator[str]:
    """Yield the assumption of sliding by Eq. (10), if friction weakens too steeply for it."""
    phi = abs(s.misalignment)
    theta = weakening_angle(s, p) if phi > 0.0 else 0.0
    if phi < p.phi_c:
        yield (
            "what does not slip by Eq. (10) slides steadily; here friction weakens with speed, and "
            f"steady sliding is unstable up to {degrees(p.phi_c):.4g} deg"
        )
    elif theta > np.fmax(p.theta_c, phi):
        yield (
            "what does not slip by Eq. (10) comes to slide steadily; here friction weakens so "
            f"steeply that creep turns into slip from {degrees(theta):.4g} deg on"
        )


def weakening_angle(s: Slider, p: Prediction) -> float:
    """Return the angle of friction (rad) at which weakening turns creep into slip.

    Eq. (10) takes friction as F_0. Where a law weakens with speed, creep becomes unstable, (E4) of
    docs/explanation/estimates.md, or the mass no longer swings back, (E5). It is theta_c, or phi if
    that is larger, where neither happens before.
    """
    law: Any = s.law
    phi = abs(s.misalignment)
    theta = np.linspace(0.5 * pi, np.fmax(p.theta_c, phi), ANGLES)
    across, along = np.sin(theta) ** 2, np.cos(theta) ** 2
    speed = s.drive_speed * sin(phi) / np.sin(theta)
    slope: Floats = np.array([float(law.slope(v)) for v in speed]) * s.normal_load
    unstable = s.F_0 / speed * across + s.c_x + slope * along < 0.0
    m_x, m_y = s.masses
    critical = 2.0 * np.sqrt((m_x * along + m_y * across) * (s.k_x * along + s.k_y * across))
    runs_away = slope + s.c_x * along + s.c_y * across < -critical
    first = np.flatnonzero(unstable | runs_away)
    return float(theta[first[0]] if len(first) else theta[-1])


def _creeps(p: Prediction) -> bool:
    return p.slips and p.creep_distance > 0.0


def _of_masses_and_dampers(s: Slider) -> Iterator[str]:
    m_x, m_y = s.masses
    if max(s.c_x / sqrt(s.k_x * m_x), s.c_y / sqrt(s.k_y * m_y)) > DAMPED:
        yield "nothing but friction damps"
    if not s.aligned:
        yield (
            "the mass is the same along x and y, and dampers lie along the axes; here they do not"
        )
