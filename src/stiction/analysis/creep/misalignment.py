"""The misalignment implied by a creep curve."""

from __future__ import annotations

from math import inf
from typing import NamedTuple

import numpy as np

from stiction.analysis.creep.curve import Bins
from stiction.analysis.creep.least_squares import THEORY, fit_parameters, used_bins
from stiction.arrays import TINY, Floats, xr
from stiction.errors import ResultError

START = 0.02  # rad, of phi, and of the weakening
WEAKENINGS = (-0.3, 1.0)  # from strengthening to half the friction at the drive's speed
ASSUMED = 0.1  # standard error of the weakening: its order is all that is known before
TURNS = 6  # of the iteration for theta: the weakening is small, so each gains a digit or two
OFF = 0.1  # of the velocity: largest common error of the theory that is tried
NEAR = 1e-3  # of the peak, and of the largest common error: they are varied by at least so much
NEAR_ZERO = 1e-3, 1e-6  # rad, of theta: while it is sought, and as found
REST_SPEED, FEWEST = 1e-6, 5  # of the drive velocity: slower is rest; bins, of creep alone
SURE = 2.0  # standard errors by which an angle, or a creep, must differ from zero


class Misalignment(NamedTuple):
    """The misalignment implied by creep (rad), F_0 (N), and their standard errors.

    Under a measured load that varies F_0 is that at the record's `normal_load`.
    `stiffness` (N/m) is the fitted one, if any; `misfit` is the typical relative deviation of the
    creep from Eq. (7) beyond two standard errors, `scatter` the root mean square of all deviations
    in standard errors; `weakening` is the share of friction lost at the drive's speed.
    """

    phi: float
    phi_error: float
    F_0: float
    F_0_error: float
    stiffness: float = np.nan
    misfit: float = np.nan
    scatter: float = np.nan
    weakening: float = np.nan

    @property
    def interval(self) -> tuple[float, float]:
        """The 95 % interval of phi (rad), two standard errors to each side."""
        return self.phi - SURE * self.phi_error, self.phi + SURE * self.phi_error

    @property
    def stands_out(self) -> bool:
        """Whether phi differs from zero by more than two standard errors."""
        return abs(self.phi) > SURE * self.phi_error


def fit_misalignment(
    curve: xr.Dataset,
    drive_velocity: float,
    stiffness: float,
    stretch: tuple[float, float] = (0.05, 1.0),
    stiffness_across: float = inf,
    mass: float = 0.0,
) -> Misalignment:
    """Fit the misalignment of Eq. (7) to a creep curve.

    By Eq. (7) the velocity depends on the spring force alone, independent of the start of loading:
    X' = V sin(phi) cos(theta - phi)/sin(theta), F = F_0 cos(theta). Least squares determine phi and
    F_0: near slip the force is so close to F_0 that an error of a per mille in F_0 shows. They also
    determine how far friction weakens with the slip speed |s| = V sin(phi)/sin(theta) of the creep,
    as F_0/(1 + weakening |s|/V): taken as constant, it makes angles above 5 deg 1 to 2 % too small.

    Eq. (7) supposes a spring across that is far stiffer, k_x/k_y << tan^2(phi). With
    `stiffness_across` the creep is that of both springs, and bins before its begin, where the mass
    still rests, are left out. It leaves out inertia, too: with `mass` friction carries the force
    less what accelerates the mass.

    Parameters
    ----------
    curve : Dataset
        Over ``bin``, from `mean_creep`, or one phase of `creep_curves`.
    drive_velocity, stiffness : float
        V, m/s, and k_x, N/m.
    stretch : tuple of float
        Range of the time to slip of the bins used, as shares of the loading time l_x/V; nearer
        to slip the inertia matters, which Eq. (7) neglects.
    stiffness_across : float, optional
        k_y, N/m.
    mass : float, optional
        m, kg.

    Returns
    -------
    Misalignment
        Its standard errors combine the curve's with a hundredth of the velocity for the theory:
        in each bin by itself, and in all of them together, which more bins do not average out.

    Raises
    ------
    ResultError
        If fewer than five bins lie in the stretch.

    References
    ----------
    Nakano & Popov, arXiv:2008.01854, Eqs. (6) and (7).

    Examples
    --------
    >>> import numpy as np, stiction as st
    >>> run = st.simulate(st.presets.nakano_popov_2020(), "20 s", sample_rate="2 kHz")
    >>> mean = st.analysis.mean_creep(st.analysis.creep_curves(run, st.analysis.find_cycles(run)))
    >>> found = st.analysis.fit_misalignment(mean, drive_velocity=1e-3, stiffness=1e3)
    >>> round(float(np.degrees(found.phi)), 1)
    1.0
    """
    peak = float(np.fmax.reduce(curve["force"].values, initial=0.0))
    loading_time = peak / stiffness / drive_velocity
    used = used_bins(curve, stretch[0] * loading_time, stretch[1] * loading_time)
    ratio = stiffness / stiffness_across
    if ratio > 0.0:
        used = _after_rest(used, drive_velocity)
    used = used._replace(force=used.force - mass * _acceleration(used))
    begin = max(1.02 * peak, float(used.force.max()) + 1e-3 * peak)
    start = Misalignment(START, 0.0, begin, 0.0, weakening=START)
    found = _fit(used, peak, drive_velocity, 0.0, start)
    if ratio == 0.0:
        return found
    fits = [_fit(used, peak, drive_velocity, ratio, each) for each in (start, found)]
    return min(fits, key=lambda fit: fit.scatter)


def _fit(
    used: Bins, peak: float, drive_velocity: float, ratio: float, start: Misalignment
) -> Misalignment:
    """Return the best fit that is reached from a first one, with springs of a ratio k_x/k_y."""
    velocity, error, force = used[:3]
    largest = float(force.max())

    def creep(force: Floats, phi: float, excess: float, weakening: float, off: float) -> Floats:
        share = force / (largest + excess)
        return drive_velocity * (1.0 + off) * creep_velocity(share, phi, weakening, ratio)

    # below zero Eq. (7) creeps against the drive; with two springs it has its mirror image above
    low = (-1.5 if ratio == 0.0 else 0.0, 1e-6 * peak, WEAKENINGS[0], -OFF)
    high = (1.5, 10.0 * peak, WEAKENINGS[1], OFF)
    begin = np.clip((start.phi, start.F_0 - largest, start.weakening, 0.0), low, high)
    found, errors = fit_parameters(
        lambda at, *known: np.append(creep(at, *known), known[2:]),
        force,
        np.append(velocity, (0.0, 0.0)),
        np.append(error, (ASSUMED, THEORY)),
        tuple(begin.tolist()),
        (low, high),
        (START, max(begin[1], NEAR * peak), START, NEAR * OFF),
    )
    theory = creep(force, *found)
    off = np.abs(velocity - theory)
    size = np.maximum(np.maximum(np.abs(velocity), np.abs(theory)), TINY)
    return Misalignment(
        found[0],
        errors[0],
        largest + found[1],
        errors[1],
        misfit=float(np.median(np.maximum(off - SURE * error, 0.0) / size)),
        scatter=float(np.sqrt(np.mean((off / error) ** 2))),
        weakening=found[2],
    )


def _acceleration(used: Bins) -> Floats:
    """Return the acceleration in each bin (m/s^2)."""
    return np.asarray(np.gradient(used.velocity, -0.5 * (used.begin + used.end)))


def _after_rest(used: Bins, drive_velocity: float) -> Bins:
    """Return the bins, far from slip to near, of which none rests any more: creep begins in one."""
    begin = used.begin
    rests = begin[np.abs(used.velocity) < REST_SPEED * drive_velocity]
    if not len(rests):
        return used
    later = begin < rests.min()
    later &= begin < begin[later].max(initial=0.0)
    if later.sum() < FEWEST:
        raise ResultError(
            f"not determined: the mass creeps in only {later.sum()} bins of the curve, and rests "
            "before"
        )
    return used.some(later)


def creep_velocity(share: Floats, phi: float, weakening: float, ratio: float = 0.0) -> Floats:
    """Return the velocity of slow creep over that of the drive, at shares F/F_0 of the force.

    The force on both springs is F_0 (cos(theta), sin(theta)), and the slip is along it:

        F_0/k_x theta' = -V sin(theta - phi)/(sin^2(theta) + r cos^2(theta)), r = k_x/k_y,
        |s| = V [cos(theta - phi) - (1 - r) sin(theta - phi) sin(theta) cos(theta)
                 /(sin^2(theta) + r cos^2(theta))], X' = |s| cos(theta - phi).

    With r = 0 this is Eq. (7), |s| = V sin(phi)/sin(theta). Friction is F_0/(1 + weakening |s|/V),
    as in `crept_force`; near theta = 0, which only a trial of the fit reaches, sines are kept
    from zero.
    """
    theta = np.arccos(np.clip(share, -1.0, 1.0))
    for _ in range(TURNS):
        slip = np.abs(_slip_speed(np.maximum(theta, NEAR_ZERO[0]), phi, ratio))
        theta = np.arccos(np.clip(share * (1.0 + weakening * slip), -1.0, 1.0))
    theta = np.maximum(theta, NEAR_ZERO[1])
    return np.asarray(np.cos(theta - phi) * _slip_speed(theta, phi, ratio))


def _slip_speed(theta: Floats, phi: float, ratio: float) -> Floats:
    """Return the slip speed of slow creep over V; below zero against the force."""
    sine, cosine = np.sin(theta), np.cos(theta)
    turned = (1.0 - ratio) * sine * cosine / (sine**2 + ratio * cosine**2)
    return np.asarray(np.cos(theta - phi) - np.sin(theta - phi) * turned)
