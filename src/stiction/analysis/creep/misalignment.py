"""The misalignment implied by a creep curve."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from stiction.analysis.creep.least_squares import fitted, used_bins

if TYPE_CHECKING:
    import xarray as xr

Floats = NDArray[np.float64]


SURE = 2.0  # standard errors by which an angle must differ from zero


class Misalignment(NamedTuple):
    """The misalignment implied by creep (rad), F_0 (N), and their standard errors.

    `stiffness` (N/m) is the fitted one, if any; `misfit` is the typical relative deviation of the
    creep from Eq. (7) beyond two standard errors.
    """

    phi: float
    phi_error: float
    F_0: float
    F_0_error: float
    stiffness: float = np.nan
    misfit: float = np.nan

    @property
    def interval(self) -> tuple[float, float]:
        """The 95 % interval of phi (rad): two standard errors to each side."""
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
    X' = V sin(phi) cos(theta - phi)/sin(theta), F = F_0 cos(theta). Least squares determine both
    phi and F_0: near slip the force is so close to F_0 that an error of a per mille in F_0 shows.

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
    """
    peak = float(np.fmax.reduce(curve["force"].values, initial=0.0))
    loading_time = peak / stiffness / drive_velocity
    used = used_bins(curve, stretch[0] * loading_time, stretch[1] * loading_time)
    _, _, velocity, error, force = used
    largest = float(force.max())

    def creep(force: Floats, phi: float, excess: float) -> Floats:
        theta = np.arccos(np.clip(force / (largest + excess), -1.0, 1.0))
        speed = drive_velocity * np.sin(phi) * np.cos(theta - phi) / np.sin(theta)
        return np.asarray(speed)

    start = (0.02, max(1.02 * peak - largest, 1e-3 * peak))
    bounds = ((-1.5, 1e-6 * peak), (1.5, 10.0 * peak))
    (phi, excess), (phi_error, F_0_error) = fitted(creep, force, velocity, error, start, bounds)
    theory = creep(force, phi, excess)
    missed = np.maximum(np.abs(velocity - theory) - SURE * error, 0.0)
    size = np.maximum(np.maximum(np.abs(velocity), np.abs(theory)), 1e-300)
    misfit = float(np.median(missed / size))
    return Misalignment(phi, phi_error, largest + excess, F_0_error, misfit=misfit)
