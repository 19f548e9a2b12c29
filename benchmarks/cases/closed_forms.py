"""The theory's closed forms at the paper's parameters: no run, no tolerance."""

from __future__ import annotations

from math import degrees, radians

import numpy as np
from scipy.optimize import brentq

from stiction import theory
from stiction.presets import Number

F_0, V, PHI, MASS, K_X, K_Y = 2.0, 1e-3, radians(1.0), 0.25, 1e3, 1e7
L_X = F_0 / K_X

# time (s), force angle (deg) and creep velocity (m/s), to the digits computed by quadrature
CREEP = ((0.5, 75.5575, 4.7987e-6), (1.0, 60.1590, 1.03147e-5), (1.5, 41.9244, 1.97360e-5))


def closed_forms() -> list[Number]:
    """Return each known value beside what `stiction.theory` says, to half a unit of its last."""
    return [*_creep(), *_equation_8(), *_damping(), *_frequencies()]


def _creep() -> list[Number]:
    numbers = []
    for t, angle, velocity in CREEP:
        theta = degrees(theory.creep_force_angle(t, V, PHI, L_X))
        found = float(theory.creep_velocity(t, V, PHI, L_X))
        numbers += [
            Number("Eq. (7)", f"theta({t:g} s)", angle, theta, 5e-5, "deg"),
            Number("Eq. (7)", f"X'({t:g} s)", velocity, found, 5e-11, "m/s"),
        ]
    return numbers


def _equation_8() -> list[Number]:
    corrected = float(theory.creep_velocity_approximation(1.0, V, PHI, L_X))
    printed = float(theory.creep_velocity_as_printed(1.0, V, PHI, L_X))
    return [
        Number("Eq. (8)", "X'(1 s), corrected", 1.0381e-5, corrected, 5e-10, "m/s"),
        Number("Eq. (8)", "X'(1 s), as printed", 5.34e-6, printed, 5e-9, "m/s"),
    ]


def _damping() -> list[Number]:
    A = float(theory.damping_number(F_0, V, PHI, MASS, K_X))

    def excess(phi: float) -> float:
        number = theory.damping_number(F_0, V, phi, MASS, K_X)
        return float(theory.damping_ratio(number, phi)) - 1.0

    zeta, crossing = float(theory.damping_ratio(A, PHI)), degrees(theory.critical_angle(A))
    overdamped = degrees(brentq(excess, radians(5.0), radians(9.0), xtol=1e-14))
    return [
        Number("Eq. (10)", "A", 3623.9, A, 0.05),
        Number("Eq. (10)", "zeta at theta = phi", 1.9e-2, zeta, 5e-4),
        Number("Eq. (10)", "theta where zeta = 1", 3.733, crossing, 5e-4, "deg"),
        Number("Eq. (10)", "phi where zeta(phi) = 1", 7.224, overdamped, 5e-4, "deg"),
    ]


def _frequencies() -> list[Number]:
    omega_y = float(theory.natural_frequency(K_Y, MASS))
    bound = float(theory.transverse_amplitude_bound(V, PHI, omega_y))
    held = 1e3 * float(theory.first_stick_duration(F_0, V, PHI, K_X, K_Y))
    return [
        Number("Eq. (9)", "omega_y/2 pi", 1.0e3, omega_y / (2 * np.pi), 50, "Hz"),
        Number("Eq. (9)", "u_y, mean", 2e-7, float(theory.transverse_deflection(F_0, K_Y)), 0, "m"),
        Number("Eq. (9)", "u_y, amplitude", 3e-9, bound, 5e-10, "m"),
        Number("set-valued", "end of the first stick", 11.4595, held, 5e-5, "ms"),
    ]
