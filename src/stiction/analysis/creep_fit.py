"""What a creep curve says: how it diverges towards slip, and which misalignment it implies."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from stiction.errors import ResultError

if TYPE_CHECKING:
    import xarray as xr

Floats = NDArray[np.float64]

THEORY = 0.01  # relative accuracy of Eqs. (7) and (8): they leave out inertia and terms in phi


class Divergence(NamedTuple):
    """Exponent n of the creep's divergence, and its standard error.

    Parameters
    ----------
    exponent, exponent_error : float
        n; 1/2 by Eq. (8).
    amplitude, amplitude_error : float
        a, m/s; V phi by Eq. (8).
    lag, lag_error : float
        By how much the divergence comes later than the slip, s.
    loading_time : float
        l_x/V, s, as it was given.
    """

    exponent: float
    exponent_error: float
    amplitude: float
    amplitude_error: float
    lag: float
    lag_error: float
    loading_time: float

    def velocity(self, to_slip: Floats) -> Floats:
        """Return the fitted velocity (m/s) at times before slip (s); NaN after the divergence."""
        tau = 1.0 - (np.asarray(to_slip) + self.lag) / self.loading_time
        tau = np.where(np.abs(tau) < 1.0, tau, np.nan)
        found: Floats = self.amplitude * tau * ((1.0 - tau) * (1.0 + tau)) ** -self.exponent
        return found


class Misalignment(NamedTuple):
    """The misalignment that a creep curve implies (rad), F_0 (N), and their standard errors."""

    phi: float
    phi_error: float
    F_0: float
    F_0_error: float


def fit_divergence(
    curve: xr.Dataset,
    loading_time: float,
    stretch: tuple[float, float] = (0.05, 0.3),
    lag: float | None = None,
) -> Divergence:
    """Fit how the creep velocity diverges towards slip.

    The model is the singular term of Eq. (8), corrected, with the exponent left free,

        X' = a tau (1 - tau^2)^(-n),   tau = 1 - (t_s - t)/(l_x/V),

    averaged over each bin (its integral is known) and fitted by least squares for a, n and the
    time t_s of the divergence, which comes a little after the slip. A bare power of t_s - t
    is its limit; over a stretch wide enough to be fitted it differs by the factors tau and
    1 + tau, which would turn 1/2 into 0.56.

    At a finite misalignment Eq. (7) has no divergence: its velocity grows to V, and the friction
    force can turn no further than to phi. As theta^2 is about 2 (1 - tau), stay with the stretch
    above phi^2, in rad.

    Parameters
    ----------
    curve : Dataset
        Over ``bin``, from `mean_creep`, or one phase of `creep_curves`.
    loading_time : float
        l_x/V, s: the spring's elongation that carries the whole friction over the drive velocity.
    stretch : tuple of float
        Bins are used whose time to slip is this part of `loading_time`, from and to.
    lag : float, optional
        By how much the divergence comes later than the slip, s; fitted unless it is given.

    Returns
    -------
    Divergence
        Standard errors from the curve's own and a hundredth of the velocity for the theory.

    Raises
    ------
    ResultError
        If fewer than five bins lie in the stretch.

    References
    ----------
    Nakano & Popov, arXiv:2008.01854, Eq. (8); see `stiction.theory`.
    """
    low, high = stretch[0] * loading_time, stretch[1] * loading_time
    begin, end, velocity, error, _ = _used(curve, low, high)

    def mean(_: Floats, amplitude: float, exponent: float, lag: float) -> Floats:
        early, late = (1.0 - (T + lag) / loading_time for T in (begin, end))
        rest = 1.0 - exponent or 1e-12  # at n = 1 the integral is a logarithm, its limit
        powers = [np.maximum((1.0 - tau) * (1.0 + tau), 1e-12) ** rest for tau in (early, late)]
        area = 0.5 * (powers[0] - powers[1]) / rest
        return np.asarray(amplitude * area * loading_time / (begin - end))

    tau = 1.0 - 0.5 * (begin + end) / loading_time
    scale = float(np.median(velocity * np.sqrt((1.0 - tau) * (1.0 + tau)) / tau))
    start, low_n, high_n = (scale, 0.49), (-np.inf, -3.0), (np.inf, 5.0)
    if lag is None:
        bounds = ((*low_n, -0.9 * float(end.min())), (*high_n, loading_time))
        found, errors = _fitted(mean, begin, velocity, error, (*start, 0.0), bounds)
    else:
        found, errors = _fitted(
            lambda at, a, n: mean(at, a, n, lag), begin, velocity, error, start, (low_n, high_n)
        )
        found, errors = [*found, lag], [*errors, 0.0]
    (a, n, late), (a_error, n_error, late_error) = found, errors
    return Divergence(n, n_error, a, a_error, late, late_error, loading_time)


def fit_misalignment(
    curve: xr.Dataset,
    drive_velocity: float,
    stiffness: float,
    stretch: tuple[float, float] = (0.05, 1.0),
) -> Misalignment:
    """Fit the misalignment with which Eq. (7) gives this creep.

    By Eq. (7) the velocity depends on the spring force alone, whatever the loading began with:
    X' = V sin(phi) cos(theta - phi)/sin(theta), F = F_0 cos(theta). Both phi and F_0 are
    fitted, by least squares: near slip the force is so close to F_0 that a per mille in F_0 shows.

    Parameters
    ----------
    curve : Dataset
        Over ``bin``, from `mean_creep`, or one phase of `creep_curves`.
    drive_velocity, stiffness : float
        V, m/s, and k_x, N/m.
    stretch : tuple of float
        Bins are used whose time to slip is this part of the loading time l_x/V, from and to;
        nearer to slip the inertia, which Eq. (7) leaves out, is felt.

    Returns
    -------
    Misalignment
        Standard errors from the curve's own and a hundredth of the velocity for the theory.

    Raises
    ------
    ResultError
        If fewer than five bins lie in the stretch.

    References
    ----------
    Nakano & Popov, arXiv:2008.01854, Eqs. (6) and (7).
    """
    peak = float(np.nanmax(np.append(curve["force"].values, -np.inf)))
    loading_time = peak / stiffness / drive_velocity
    used = _used(curve, stretch[0] * loading_time, stretch[1] * loading_time)
    _, _, velocity, error, force = used
    largest = float(force.max())

    def creep(_: Floats, phi: float, excess: float) -> Floats:
        theta = np.arccos(np.clip(force / (largest + excess), -1.0, 1.0))
        speed = drive_velocity * np.sin(phi) * np.cos(theta - phi) / np.sin(theta)
        return np.asarray(speed)

    start = (0.02, max(1.02 * peak - largest, 1e-3 * peak))
    bounds = ((-1.5, 1e-6 * peak), (1.5, 10.0 * peak))
    (phi, excess), (phi_error, F_0_error) = _fitted(creep, force, velocity, error, start, bounds)
    return Misalignment(phi, phi_error, largest + excess, F_0_error)


def _used(curve: xr.Dataset, low: float, high: float) -> list[Floats]:
    """Return begin, end, velocity, its error and force of the bins inside a stretch (s)."""
    names = ("begin", "end", "velocity", "velocity_error", "force")
    columns = np.stack([curve[name].values for name in names])
    begin, end, velocity, error, _ = columns
    inside = (end >= low) & (begin <= high) & np.isfinite(velocity)
    if inside.sum() < 5:
        raise ResultError(
            f"{inside.sum()} bins of the creep curve lie between {low:g} s and {high:g} s before "
            "slip and 5 are needed; widen the stretch, or make narrower bins (width)"
        )
    columns[3] = np.hypot(np.nan_to_num(error), THEORY * np.abs(velocity))
    return list(columns[:, inside])


def _fitted(
    model: Callable[..., Floats],
    at: Floats,
    values: Floats,
    errors: Floats,
    start: tuple[float, ...],
    bounds: tuple[tuple[float, ...], tuple[float, ...]],
) -> tuple[list[float], list[float]]:
    """Return parameters and standard errors, these scaled up where the model misses by more."""
    from scipy.optimize import curve_fit

    scale = np.maximum(np.abs(start), 1e-3 * np.abs(bounds[1]).clip(max=1.0))
    found, covariance = curve_fit(  # type: ignore[no-untyped-call]
        model,
        at,
        values,
        start,
        sigma=errors,
        absolute_sigma=True,
        bounds=bounds,
        x_scale=scale,
        max_nfev=2000,
    )
    missed = (values - model(at, *found)) / errors
    excess = max(1.0, float(np.sum(missed**2)) / (len(values) - len(found)))
    return found.tolist(), np.sqrt(np.diag(covariance) * excess).tolist()
