"""The misalignment implied by a creep curve."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from stiction.analysis.creep.divergence import fit_parameters, used_bins
from stiction.arrays import Floats, xr

START = 0.02  # rad, of phi, and of the weakening
WEAKENINGS = (-0.3, 1.0)  # from strengthening to half the friction at the drive's speed
ASSUMED = 0.1  # standard error of the weakening: its order is all that is known before
TURNS = 6  # of the iteration for theta: the weakening is small, so each gains a digit or two
SURE = 2.0  # standard errors by which an angle must differ from zero


class Misalignment(NamedTuple):
    """The misalignment implied by creep (rad), F_0 (N), and their standard errors.

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
) -> Misalignment:
    """Fit the misalignment of Eq. (7) to a creep curve.

    By Eq. (7) the velocity depends on the spring force alone, independent of the start of loading:
    X' = V sin(phi) cos(theta - phi)/sin(theta), F = F_0 cos(theta). Least squares determine phi and
    F_0: near slip the force is so close to F_0 that an error of a per mille in F_0 shows. They also
    determine how far friction weakens with the slip speed |s| = V sin(phi)/sin(theta) of the creep,
    as F_0/(1 + weakening |s|/V): taken as constant, it makes angles above 5 deg 1 to 2 % too small.

    Parameters
    ----------
    curve : Dataset
        Over ``bin``, from `mean_creep`, or one phase of `creep_curves`.
    drive_velocity, stiffness : float
        V, m/s, and k_x, N/m.
    stretch : tuple of float
        Range of the time to slip of the bins used, as shares of the loading time l_x/V; nearer
        to slip the inertia matters, which Eq. (7) neglects.

    Returns
    -------
    Misalignment
        Its standard errors combine the curve's with a hundredth of the velocity for the theory.

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
    _, _, velocity, error, force = used
    largest = float(force.max())

    def creep(force: Floats, phi: float, excess: float, weakening: float) -> Floats:
        return drive_velocity * creep_velocity(force / (largest + excess), phi, weakening)

    start = (START, max(1.02 * peak - largest, 1e-3 * peak), START)
    bounds = ((-1.5, 1e-6 * peak, WEAKENINGS[0]), (1.5, 10.0 * peak, WEAKENINGS[1]))
    found, errors = fit_parameters(
        lambda at, *known: np.append(creep(at, *known), known[2]),
        force,
        np.append(velocity, 0.0),
        np.append(error, ASSUMED),
        start,
        bounds,
    )
    phi, excess, weakening = found
    theory = creep(force, *found)
    off = np.abs(velocity - theory)
    size = np.maximum(np.maximum(np.abs(velocity), np.abs(theory)), 1e-300)
    misfit = float(np.median(np.maximum(off - SURE * error, 0.0) / size))
    return Misalignment(
        phi,
        errors[0],
        largest + excess,
        errors[1],
        misfit=misfit,
        scatter=float(np.sqrt(np.mean((off / error) ** 2))),
        weakening=weakening,
    )


def creep_velocity(share: Floats, phi: float, weakening: float) -> Floats:
    """Return the velocity of Eq. (7) over that of the drive, at shares F/F_0 of the force.

    Friction is F_0/(1 + weakening |s|/V) with |s| = V sin(phi)/sin(theta), as in `creep_distance`;
    near theta = 0, which only a trial of the fit reaches, sines are kept from zero.
    """
    theta = np.arccos(np.clip(share, -1.0, 1.0))
    for _ in range(TURNS):
        slip = np.sin(abs(phi)) / np.maximum(np.sin(theta), 1e-3)
        theta = np.arccos(np.clip(share * (1.0 + weakening * slip), -1.0, 1.0))
    sine = np.maximum(np.sin(theta), 1e-6)
    return np.asarray(np.sin(phi) * np.cos(theta - phi) / sine)
