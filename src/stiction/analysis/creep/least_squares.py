"""Least squares on creep curves."""

from __future__ import annotations

from collections.abc import Callable
from warnings import catch_warnings, simplefilter

import numpy as np

from stiction.arrays import Floats, xr
from stiction.errors import ResultError
from stiction.text.units import in_words

THEORY = 0.01  # relative accuracy of Eqs. (7) and (8): they leave out inertia and terms in phi


def used_bins(curve: xr.Dataset, low: float, high: float) -> list[Floats]:
    """Return begin, end, velocity, velocity error and force of the bins in a stretch (s)."""
    names = ("begin", "end", "velocity", "velocity_error", "force")
    columns = np.stack([curve[name].values for name in names])
    begin, end, velocity, error, _ = columns
    inside = (end >= low) & (begin <= high) & np.isfinite(velocity)
    if inside.sum() < 5:
        raise ResultError(
            f"{inside.sum()} bins of the creep curve lie between {in_words(low, 's')} and "
            f"{in_words(high, 's')} before "
            "slip and 5 are needed; widen the stretch, or make narrower bins (width)"
        )
    columns[3] = np.hypot(np.nan_to_num(error), THEORY * np.abs(velocity))
    return list(columns[:, inside])


def fit_parameters(
    model: Callable[..., Floats],
    at: Floats,
    values: Floats,
    errors: Floats,
    start: tuple[float, ...],
    bounds: tuple[tuple[float, ...], tuple[float, ...]],
) -> tuple[list[float], list[float]]:
    """Return parameters and standard errors, which are scaled up if the misfit exceeds them.

    Raises
    ------
    ResultError
        If the fit does not converge.
    """
    from scipy.optimize import OptimizeWarning, curve_fit

    scale = np.maximum(np.abs(start), 1e-3 * np.abs(bounds[1]).clip(max=1.0))
    try:
        with catch_warnings():
            simplefilter("ignore", OptimizeWarning)  # then the standard errors are infinite
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
    except RuntimeError:
        raise ResultError("the creep curve does not have the shape that is fitted") from None
    missed = (values - model(at, *found)) / errors
    excess = max(1.0, float(np.sum(missed**2)) / (len(values) - len(found)))
    return found.tolist(), np.sqrt(np.diag(covariance) * excess).tolist()
