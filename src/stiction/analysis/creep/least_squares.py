"""Fits of a theory to a mean creep curve by least squares."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import NamedTuple
from warnings import catch_warnings, simplefilter

import numpy as np

from stiction.analysis.creep.curve import CURVES, Bins
from stiction.arrays import Floats, xr
from stiction.errors import ResultError
from stiction.text.quantity.wording import in_words

FEWEST_USED = 5  # bins of a fit, which has two or three unknowns
UNLIKE = "not determined: the creep curve does not have the shape that is fitted"
ACCURACY = 1e-6  # of the sum of squares: then parameters are within a thousandth of their errors
STEP = float(np.finfo(float).eps) ** 0.5  # of a derivative: halves the digits of a difference
THEORY = 0.01  # relative accuracy of Eqs. (7) and (8): they leave out inertia and terms in phi


def used_bins(curve: xr.Dataset, low: float, high: float) -> Bins:
    """Return the bins of a curve in a stretch (s to slip); their errors include the theory's."""
    bins = Bins(*(curve[name].values for name in CURVES))
    inside = (bins.end >= low) & (bins.begin <= high) & np.isfinite(bins.velocity)
    if inside.sum() < FEWEST_USED:
        longest = float(np.fmax.reduce(bins.begin, initial=0.0))
        remedy = "st.analysis.creep_curves in Python makes narrower bins (width)"
        if longest < high:
            remedy = f"the longest stick phase takes {in_words(longest, 's')} only"
        raise ResultError(
            f"not determined: between {in_words(low, 's')} and {in_words(high, 's')} before slip "
            f"the creep curve has {inside.sum()} of the {FEWEST_USED} bins needed; {remedy}"
        )
    error = np.hypot(np.nan_to_num(bins.error), THEORY * np.abs(bins.velocity))
    return bins._replace(error=error).some(inside)


class CreepFit(NamedTuple):
    """Parameters of least squares, their covariance, and the sum of squares.

    The covariance is scaled up by `excess`, the squares of a degree of freedom, if that is above 1.
    """

    values: tuple[float, ...]
    covariance: Floats
    chi_square: float
    excess: float

    @property
    def errors(self) -> tuple[float, ...]:
        """The standard errors of the parameters."""
        return tuple(np.sqrt(np.diag(self.covariance)).tolist())


def best_fit(
    model: Callable[..., Floats],
    values: Floats,
    errors: Floats,
    starts: Iterable[tuple[float, ...]],
    bounds: tuple[tuple[float, ...], tuple[float, ...]],
    sizes: tuple[float, ...],
) -> CreepFit:
    """Return the best of the fits of a model of some parameters from several starts.

    Parameters are varied in units of their `sizes`: the optimiser's steps have no unit.
    """

    def fit_from(start: tuple[float, ...]) -> CreepFit:
        found, covariance = _minimise(model, values, errors, start, bounds, sizes)
        missed = (values - model(*found * sizes)) / errors
        chi_square = float(np.sum(missed**2))
        excess = max(1.0, chi_square / (len(values) - len(found)))
        best = tuple((found * sizes).tolist())
        return CreepFit(best, covariance * excess * np.outer(sizes, sizes), chi_square, excess)

    return min((fit_from(start) for start in starts), key=lambda fit: fit.chi_square)


def _minimise(
    model: Callable[..., Floats],
    values: Floats,
    errors: Floats,
    start: tuple[float, ...],
    bounds: tuple[tuple[float, ...], tuple[float, ...]],
    sizes: tuple[float, ...],
) -> tuple[Floats, Floats]:
    """Return the parameters of the best fit over their sizes, and their covariance."""
    from scipy.optimize import OptimizeWarning, curve_fit

    def modelled(_: Floats, *shares: float) -> Floats:
        return model(*np.multiply(shares, sizes))

    def slopes(_: Floats, *shares: float) -> Floats:
        return forward_differences(lambda at: modelled(values, *at), np.array(shares), highest)

    highest = np.divide(bounds[1], sizes)
    try:
        with catch_warnings():
            simplefilter("ignore", OptimizeWarning)  # then the standard errors are infinite
            found, covariance = curve_fit(  # type: ignore[no-untyped-call]
                modelled,
                values,
                values,
                np.divide(start, sizes),
                sigma=errors,
                absolute_sigma=True,
                bounds=np.divide(bounds, sizes),
                jac=slopes,
                ftol=ACCURACY,
                max_nfev=2000,
            )
    except RuntimeError:
        raise ResultError(UNLIKE) from None
    return found, covariance


def forward_differences(model: Callable[[Floats], Floats], at: Floats, highest: Floats) -> Floats:
    """Return the derivatives of a model (n,) by its parameters `at` (m,), as (n, m).

    SciPy takes the same, but spends longer on types and options than a short model takes. Where a
    step would exceed the `highest` parameter, it is backward.
    """
    here, columns = model(at), []
    for i, step in enumerate(STEP * np.maximum(np.abs(at), 1.0)):
        moved = at.copy()
        moved[i] += step if at[i] + step <= highest[i] else -step
        columns.append((model(moved) - here) / (moved[i] - at[i]))
    return np.transpose(columns)
