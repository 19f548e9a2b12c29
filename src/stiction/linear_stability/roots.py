"""All values of a parameter in a range at which the stability of steady sliding changes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise
from math import pi
from pathlib import Path
from typing import NamedTuple

import numpy as np

from stiction.arrays import Floats
from stiction.linear_stability.axis import axis, steadily_driven
from stiction.linear_stability.eigenvalues import (
    CLEAR,
    leading_growth,
    refined_growth,
)
from stiction.linear_stability.linear import BOUNDARY, disturbance, leading_mode, steady_sliding
from stiction.system.description import Description
from stiction.system.slider import Slider, slider_of
from stiction.text.quantity.wording import in_words
from stiction.text.units import Quantity
from stiction.text.validation import equal

POINTS = 65  # in the first scan of a range
STEEPER = 100.0  # times as steep between two points as around them may a growth rate be


class Critical(NamedTuple):
    """Values of a parameter at which steady sliding changes between stable and unstable.

    Parameters
    ----------
    path, unit : str
        The parameter, and its SI unit.
    between : tuple of float
        The searched range, SI.
    values : ndarray
        (n,), SI, ascending; empty if nothing changes in the range.
    frequencies : ndarray
        (n,), Hz: frequency of the critical mode at each value.
    stable : tuple of bool
        (n + 1,): whether sliding is stable below the first value, between the first and the
        second, ..., above the last.
    neutral : bool
        Whether disturbances neither grow nor decay anywhere, within the uncertainty.

    Examples
    --------
    >>> import stiction as st
    >>> found = st.linear_stability.critical(st.presets.nakano_popov_2020(), "phi")
    >>> found.path, found.stable
    ('phi', (False, True, False))
    """

    path: str
    unit: str
    between: tuple[float, float]
    values: Floats
    frequencies: Floats
    stable: tuple[bool, ...]
    neutral: bool = False

    def __repr__(self) -> str:
        """Return where stability changes, and the kinds of sliding below and above."""
        at = ", ".join(in_words(each, self.unit) for each in self.values) or "no value"
        kinds = ", ".join("stable" if each else "unstable" for each in self.stable)
        return f"<Critical {self.path}: {at}; sliding is {kinds}>"

    def __eq__(self, other: object) -> bool:
        """Compare the fields, of arrays the values."""
        return isinstance(other, Critical) and all(map(equal, self, other))

    def __ne__(self, other: object) -> bool:
        """Return the opposite; a tuple has its own."""
        return not self == other

    @property
    def stretches(self) -> list[tuple[float, float, bool]]:
        """Both ends of each interval of the range, and whether sliding is stable inside."""
        borders = [self.between[0], *map(float, self.values), self.between[1]]
        return list(zip(borders[:-1], borders[1:], self.stable, strict=True))


def critical(
    slider: Slider | Description | str | Path,
    path: str,
    between: Sequence[Quantity] | None = None,
    *,
    points: int = POINTS,
) -> Critical:
    """Find every value of a parameter at which steady sliding becomes unstable, or stable.

    The growth rate (see `growth_rate`) is computed at points over the range and at its extrema
    between them; where its sign changes, Brent's method finds the zero to rounding.

    Parameters
    ----------
    slider : Slider, Description, str or Path
        The system, or the file of its description; its own value of the parameter does not matter.
    path : str
        The parameter, for example ``"phi"``, ``"drive.velocity"``, ``"c_x"``, ``"mass"``,
        ``"friction.mu_inf"``, or several with one value: ``"c_x, c_y"``.
    between : tuple of float or str, optional
        The range; by default 0 to 90 degrees for an angle, -90 to 0 where it is below 0, else
        three decades below and above the parameter's present value. Where springs are turned, that
        of phi holds all misalignments of its sign.
    points : int, optional
        Number of points of the first scan.

    Returns
    -------
    Critical
        The values, with the frequency of the critical mode at each.

    Raises
    ------
    DescriptionError
        If there is no such parameter, no such range, or no steady sliding.

    Examples
    --------
    >>> import numpy as np, stiction as st
    >>> found = st.linear_stability.critical(st.presets.nakano_popov_2020(), "phi")
    >>> np.degrees(found.values).round(4), found.frequencies.round(1), found.stable
    (array([ 8.656 , 76.2634]), array([ 10.2, 988.6]), (False, True, False))
    """
    slider = steadily_driven(slider_of(slider), path)
    along = axis(slider, path, between)

    def growth(fraction: float) -> float:
        return signed_growth(along.on(slider, fraction))

    crossings, stable = sign_changes(growth, points)
    leading = [leading_frequency(along.on(slider, at)) for at in crossings]
    values, frequencies = np.array([along.value(at) for at in crossings]), np.array(leading)
    neutral = not any(growth(fraction) for fraction in (0.0, 0.5, 1.0)) and not any(stable)
    ends = along.low, along.high
    return Critical(
        along.path, along.unit, ends, values, frequencies.astype(float), stable, neutral
    )


def signed_growth(slider: Slider) -> float:
    """Return the growth rate (1/s); exactly zero if its sign is uncertain."""
    matrix, error = disturbance(slider)
    values = np.linalg.eigvals(matrix)
    growth = float(values.real.max())
    # the error of the trace is that of all growth rates together; NaN if not known
    if abs(growth) > CLEAR * float(np.abs(values).max()) and not abs(growth) < error.trace():
        return growth
    if np.isfinite(error).all():
        for find in (leading_growth, refined_growth):
            growth, uncertainty = find(matrix, error)
            if abs(growth) > uncertainty:
                return growth
    linear = steady_sliding(slider)
    return 0.0 if linear.verdict == BOUNDARY else linear.growth_rate


def leading_frequency(slider: Slider) -> float:
    """Return the frequency (Hz) of the fastest-growing mode."""
    return abs(leading_mode(slider).imag) / (2.0 * pi)


def sign_changes(
    function: Callable[[float], float], points: int
) -> tuple[list[float], tuple[bool, ...]]:
    """Return the zeros of a function on 0 to 1 with a change of sign, and where it is negative.

    Over a stretch where the function is zero, it changes sign once or not at all. A function that
    is zero everywhere never changes sign, and does not count as negative.
    """
    from scipy.optimize import brentq

    grid = [float(at) for at in np.linspace(0.0, 1.0, points)]
    known = {at: function(at) for at in grid}
    values = np.array([known[at] for at in grid])
    for i in range(1, points - 1):
        steps = np.abs(np.diff(values[max(i - 2, 0) : i + 3]))
        if abs(values[i]) < STEEPER * steps.max():
            known |= dip(function, grid[i - 1], grid[i], grid[i + 1], known)
    signs = [(at, known[at]) for at in sorted(known) if known[at] != 0.0]
    found = [
        float(brentq(function, a, b, xtol=1e-15, rtol=1e-14))  # type: ignore[no-untyped-call]
        for (a, f_a), (b, f_b) in pairwise(signs)
        if f_a * f_b < 0.0
    ]
    first = bool(signs) and signs[0][1] < 0.0
    return found, tuple(first ^ bool(i % 2) for i in range(len(found) + 1))


def dip(
    function: Callable[[float], float],
    before: float,
    at: float,
    after: float,
    known: dict[float, float],
) -> dict[float, float]:
    """Return the extremum near `at` if the function is nearest to zero there.

    It reveals two changes of sign between neighbouring points.
    """
    from scipy.optimize import minimize_scalar

    value = known[at]
    sign = 1.0 if value > 0.0 else -1.0
    if value == 0.0 or sign * known[before] < sign * value or sign * known[after] < sign * value:
        return {}
    lowest = minimize_scalar(  # type: ignore[no-untyped-call]
        lambda x: sign * function(x), bounds=(before, after), options={"xatol": 1e-6}
    )
    return {float(lowest.x): sign * float(lowest.fun)}
