"""A measured law: a smooth curve through friction coefficients at given slip speeds."""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache
from math import exp
from typing import NamedTuple

import numpy as np

from stiction.friction.law import static_fault
from stiction.friction.registry import register
from stiction.text.units import Coefficient, Coefficients, Speeds
from stiction.text.validation import validate


@register("table")
@validate
class Table(NamedTuple):
    """F = mu(v) W through measured points, monotone between neighbours.

    Between the points, a piecewise cubic interpolates without overshoot or oscillation (PCHIP:
    Fritsch & Butland, SIAM J. Sci. Stat. Comput. 5 (1984), 300). Beyond the last point, and below
    the first if it is not at v = 0, the coefficient is constant; the curve meets the constant
    without a kink.

    Parameters
    ----------
    v : sequence of float or str
        Slip speeds of the points, ascending, m/s; at least two.
    mu : sequence of float
        Friction coefficient at each.
    mu_static : float, optional
        Separate coefficient of static friction, not below the first of mu; by default none.

    Examples
    --------
    >>> import stiction as st
    >>> law = st.laws.Table(v=["0 m/s", "1 mm/s", "10 mm/s"], mu=[0.3, 0.25, 0.2])
    >>> law.coefficient(1e-3)
    0.25
    """

    v: Speeds
    mu: Coefficients
    mu_static: Coefficient = 0.0

    @classmethod
    def like(cls, static: float, kinetic: float, speed: float) -> Table:
        """Return points of exponential weakening with these coefficients and this speed."""
        fall = [exp(-0.5 * i) for i in range(16)]
        mu = (*(kinetic + (static - kinetic) * x for x in fall), kinetic)
        return cls(tuple(0.5 * speed * i for i in range(17)), mu)

    def faults(law) -> Iterator[tuple[str, str]]:
        """Yield contradictions between the parameters."""
        found = list(_point_faults(law))
        yield from found
        if not found:
            yield from static_fault(law)

    def prepare(law) -> PreparedTable:
        """Return the curve in the form that the solver takes."""
        return _curve(law)

    def coefficient(law, v: float) -> float:
        """Return the friction coefficient at slip speed `v` (m/s)."""
        return float(law.prepare().coefficient(v))

    def slope(law, v: float) -> float:
        """Return d(coefficient)/dv at slip speed `v` (m/s), in s/m."""
        return float(law.prepare().slope(v))


class PreparedTable(NamedTuple):
    """The curve of a `Table`: cubic i in v - starts[i] holds from starts[i] on.

    Parameters
    ----------
    starts : ndarray
        (n,), m/s, ascending from zero; the last cubic is constant and has no end.
    cubics : ndarray
        (n, 4), coefficients of falling powers.
    mu_static : float
        As in `Table`.
    """

    starts: np.ndarray
    cubics: np.ndarray
    mu_static: float

    def coefficient(law, v: float) -> float:
        """Return the friction coefficient at slip speed `v` >= 0 (m/s)."""
        i = np.searchsorted(law.starts, v, side="right") - 1
        x, c = v - law.starts[i], law.cubics
        mu: float = ((c[i, 0] * x + c[i, 1]) * x + c[i, 2]) * x + c[i, 3]
        return max(mu, 0.0)  # rounding

    def slope(law, v: float) -> float:
        """Return d(coefficient)/dv at slip speed `v` >= 0 (m/s), in s/m."""
        i = np.searchsorted(law.starts, v, side="right") - 1
        x, c = v - law.starts[i], law.cubics
        gradient: float = (3.0 * c[i, 0] * x + 2.0 * c[i, 1]) * x + c[i, 2]
        return gradient


def _point_faults(law: Table) -> Iterator[tuple[str, str]]:
    if len(law.v) != len(law.mu):
        yield "mu", f"must have a value for each v: {len(law.mu)} and {len(law.v)}"
    if len(law.v) < 2:
        yield "v", f"must be at least two points, is {len(law.v)}; for a constant use 'coulomb'"
    for before, after in zip(law.v, law.v[1:], strict=False):
        if after <= before:
            yield "v", f"must ascend, but {after:g} m/s follows {before:g} m/s; sort the points"


@lru_cache(maxsize=32)
def _curve(law: Table) -> PreparedTable:
    """Return the piecewise cubic through the points of a table.

    An extra point on each side, as high as its neighbour, gives the curve zero slope where it
    meets the constant; the cubic beyond the last point is that constant.
    """
    from scipy.interpolate import PchipInterpolator  # slow to import

    v, mu = [*law.v, 2.0 * law.v[-1]], [*law.mu, law.mu[-1]]
    if v[0] > 0.0:
        v, mu = [0.0, *v], [mu[0], *mu]
    curve = PchipInterpolator(v, mu)  # type: ignore[no-untyped-call]
    return PreparedTable(curve.x[:-1].copy(), np.ascontiguousarray(curve.c.T), law.mu_static)
