"""Extremes, crossings and periods from evenly spaced samples."""

from __future__ import annotations

import numpy as np

from stiction.arrays import Floats


def crest(values: Floats) -> float:
    """Return the largest of evenly spaced samples, by the parabola through it and its neighbours.

    It is off by the fourth order of the spacing; the sample itself by the second.
    """
    i = int(np.argmax(values))
    if not 0 < i < len(values) - 1:
        return float(values[i])
    before, top, after = values[i - 1 : i + 2]
    return float(top + (after - before) ** 2 / (8.0 * (2.0 * top - before - after)))


def upward_crossings(times: Floats, values: Floats) -> Floats:
    """Return when samples pass zero upwards, by the cubic through the four samples around."""
    found = []
    for i in np.flatnonzero((values[:-1] < 0.0) & (values[1:] >= 0.0)):
        near = slice(max(i - 1, 0), i + 3)
        cubic = np.polynomial.Polynomial.fit(times[near], values[near], len(times[near]) - 1)
        roots = cubic.roots()
        real = roots[np.isreal(roots)].real
        # rounding may put the root of a curve that is zero at a sample just beyond that sample
        nearest = real[np.argmin(np.abs(real - (times[i] + times[i + 1]) / 2.0))]
        found.append(float(np.clip(nearest, times[i], times[i + 1])))
    return np.array(found)
