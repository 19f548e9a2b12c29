"""The boundary of stability as a curve in two parameters, traced from point to point."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from stiction.arrays import Floats
from stiction.errors import DescriptionError, Fault
from stiction.linear_stability.axis import Axis, axis, present_value
from stiction.linear_stability.following import Growth, Point, both_ways, near, orient
from stiction.linear_stability.linear import growth_rate, steady_sliding
from stiction.linear_stability.roots import sign_changes, signed_growth
from stiction.system.slider import Slider
from stiction.text.units import Quantity

if TYPE_CHECKING:
    import xarray as xr

LINES = (0.0, 0.25, 0.5, 0.75, 1.0)  # across both ranges, searched for points of curves
LOOKS = 33  # points on each line


def boundary(
    slider: Slider,
    x: str,
    y: str,
    *,
    x_between: Sequence[Quantity] | None = None,
    y_between: Sequence[Quantity] | None = None,
) -> xr.Dataset:
    """Follow the boundary of stable steady sliding through the plane of two parameters.

    Zeros of the growth rate are found on a few lines across the plane, including those through the
    slider's own parameters. From each zero, the curve is traced in both directions: the next point
    is the change of sign, nearest to straight ahead, on a small circle about the present point. A
    circle meets every curve, so that folds and corners (where another mode takes over) need no
    special treatment. A curve ends at the edge of the plane, or where it closes.

    Parameters
    ----------
    slider : Slider
        The system.
    x, y : str
        The two parameters, see `critical`.
    x_between, y_between : tuple of float or str, optional
        Their ranges, see `critical`; the scale is logarithmic where the ends differ by more than
        a factor of ten.

    Returns
    -------
    Dataset
        Over ``point``: the parameters by their paths (SI), ``frequency`` of the critical mode
        (Hz), and the number ``branch`` of the connected curve. Along each curve, steady sliding
        is unstable on the left, with x to the right and y upwards. The points are accurate to
        1e-9 of the ranges or better. Attributes: ``x``, ``y``, their ranges
        ``x_range``, ``y_range``, ``x_scale``, ``y_scale`` ("log" or "linear"), and the slider's
        own ``x_own``, ``y_own`` (SI) and ``growth_rate`` (1/s).

    Raises
    ------
    DescriptionError
        If there are no such parameters or ranges, or no steady sliding.

    References
    ----------
    Continuation with a spherical constraint: Yamamura, IEEE Trans. Circuits Syst. I 40 (1993), 448.

    Examples
    --------
    >>> import stiction as st
    >>> slider = st.presets.nakano_popov_2020()
    >>> sorted(st.linear_stability.boundary(slider, "phi", "drive.velocity").data_vars)
    ['branch', 'drive.velocity', 'frequency', 'phi']
    """
    across, up = axis(slider, x, x_between), axis(slider, y, y_between)
    if across.path == up.path:
        raise DescriptionError([Fault(x, "spans no plane with itself; name two parameters")])

    def at(point: Point) -> Slider:
        inside = (min(max(each, 0.0), 1.0) for each in point)
        return up.on(across.on(slider, next(inside)), next(inside))

    def growth(point: Point) -> float:
        return growth_rate(at(point))

    branches: list[Floats] = []
    places = (each.fraction(present_value(slider, each.path)) for each in (across, up))
    for seed in seeds(lambda point: signed_growth(at(point)), *places):
        if not any(near(seed, branch) for branch in branches):
            curve = both_ways(growth, seed)
            branches += [orient(growth, curve)] if len(curve) > 1 else []
    return table(slider, across, up, branches, at)


def seeds(growth: Growth, x: float, y: float) -> Iterator[Point]:
    """Yield zeros of the growth rate, on lines across the plane and through (x, y)."""
    for level in (y, *LINES):
        if 0.0 <= level <= 1.0:
            for found in sign_changes(lambda a, b=level: growth((a, b)), LOOKS)[0]:  # type: ignore[misc]
                yield found, level
    for place in (x, *LINES):
        if 0.0 <= place <= 1.0:
            for found in sign_changes(lambda b, a=place: growth((a, b)), LOOKS)[0]:  # type: ignore[misc]
                yield place, found


def table(
    slider: Slider, x: Axis, y: Axis, branches: Sequence[Floats], at: Callable[[Point], Slider]
) -> xr.Dataset:
    """Return the curves as labelled arrays."""
    import xarray as xr

    points = [(float(a), float(b)) for branch in branches for a, b in branch]
    count = [n for n, branch in enumerate(branches) for _ in branch]
    frequency = [steady_sliding(at(point)).frequencies[0] for point in points]
    columns = {
        x.path: ([x.value(a) for a, _ in points], x.unit or "1", x.path),
        y.path: ([y.value(b) for _, b in points], y.unit or "1", y.path),
        "frequency": (frequency, "Hz", "frequency of the critical mode"),
    }
    data = {
        name: ("point", np.array(values, dtype=np.float64), {"units": unit, "long_name": meaning})
        for name, (values, unit, meaning) in columns.items()
    }
    branch = ("point", np.array(count, dtype=np.int64), {"long_name": "connected curve"})
    attributes: dict[str, Any] = {"x": x.path, "y": y.path, "growth_rate": growth_rate(slider)}
    for name, each in (("x", x), ("y", y)):
        attributes[f"{name}_own"] = present_value(slider, each.path)
        attributes[f"{name}_range"] = np.array([each.low, each.high])
        attributes[f"{name}_scale"] = "log" if each.logarithmic else "linear"
    return xr.Dataset({**data, "branch": branch}, attrs=attributes)
