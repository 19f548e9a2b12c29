"""Growth rates and frequencies of all modes over one parameter."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from stiction.arrays import Complex, xr
from stiction.linear_stability.axis import axis
from stiction.linear_stability.linear import steady_sliding
from stiction.system.slider import Slider
from stiction.text.units import Quantity


def modes_over(
    slider: Slider, path: str, between: Sequence[Quantity] | None = None, *, points: int = 201
) -> xr.Dataset:
    """Return growth rates and frequencies of all modes over a parameter.

    Parameters
    ----------
    slider : Slider
        The system.
    path : str
        The parameter, see `critical`.
    between : tuple of float or str, optional
        Its range, see `critical`.
    points : int, optional
        Number of values.

    Returns
    -------
    Dataset
        Over ``value`` (the parameter, SI) and ``mode``: ``growth_rate`` (1/s) and ``frequency``
        (Hz). Modes are matched from value to value by linear extrapolation.

    Examples
    --------
    >>> import stiction as st
    >>> modes = st.linear_stability.modes_over(st.presets.nakano_popov_2020(), "phi", points=11)
    >>> dict(modes.sizes)
    {'value': 11, 'mode': 4}
    """
    along = axis(slider, path, between)
    fractions = np.linspace(0.0, 1.0, points)
    rows: list[Complex] = []
    for fraction in fractions:
        now = steady_sliding(along.on(slider, float(fraction))).eigenvalues
        rows.append(match_eigenvalues(rows, now))
    values = np.array([along.value(float(fraction)) for fraction in fractions])
    eigenvalues = np.array(rows)
    dims = ("value", "mode")
    return xr.Dataset(
        {
            "growth_rate": (dims, eigenvalues.real, {"units": "1/s", "long_name": "growth rate"}),
            "frequency": (
                dims,
                np.abs(eigenvalues.imag) / (2.0 * np.pi),
                {"units": "Hz", "long_name": "frequency"},
            ),
        },
        {"value": ("value", values, {"units": along.unit or "1", "long_name": along.path})},
        {"scale": "log" if along.logarithmic else "linear"},
    )


def match_eigenvalues(before: Sequence[Complex], now: Complex) -> Complex:
    """Order eigenvalues like the linear extrapolation of those before."""
    from scipy.optimize import linear_sum_assignment

    if not before:
        return now
    expected = before[-1] if len(before) < 2 else 2.0 * before[-1] - before[-2]
    cost = np.abs(expected[:, None] - now[None, :])
    order: Complex = now[linear_sum_assignment(cost)[1]]
    return order
