"""Radau IIA collocation with three stages (M24): order 5, L-stable, stiffly accurate.

Hairer & Wanner, Solving Ordinary Differential Equations II, section IV.5. The stage
values with the start value define a cubic, which predicts the next step and gives
values inside this one.
"""

from __future__ import annotations

from math import sqrt

import numpy as np
from numpy.polynomial import Polynomial

from stiction.solver.compilation.jit import inlined, number
from stiction.solver.stepping.block_algebra import Matrix, Triple

_S6 = sqrt(6.0)
FIRST, SECOND, THIRD = map(number, range(3))  # the stages, as indices
C: Triple = ((4 - _S6) / 10, (4 + _S6) / 10, 1.0)
A: Matrix = (
    ((88 - 7 * _S6) / 360, (296 - 169 * _S6) / 1800, (-2 + 3 * _S6) / 225),
    ((296 + 169 * _S6) / 1800, (88 + 7 * _S6) / 360, (-2 - 3 * _S6) / 225),
    ((16 - _S6) / 36, (16 + _S6) / 36, 1 / 9),
)


def _triple(row: np.ndarray) -> Triple:
    return float(row[0]), float(row[1]), float(row[2])


def _inverse(matrix: Matrix) -> Matrix:
    rows = np.linalg.inv(np.array(matrix))
    return _triple(rows[0]), _triple(rows[1]), _triple(rows[2])


def _lagrange(nodes: tuple[float, ...], i: int) -> Polynomial:
    others = [c for j, c in enumerate(nodes) if j != i]
    basis = Polynomial.fromroots(others)
    return basis / basis(nodes[i])


# D = A^-1: derivatives at the stages, times h, from stage values minus the start value
D: Matrix = _inverse(A)

# an interior point at which the defect of the collocation cubic is evaluated. The defect goes as
# (c - c_1)(c - c_2)(c - 1), and the error as the integral of that, which is largest at c_1;
# DEFECT_WEIGHT is the ratio of that error to the defect at the interior point (M36)
INTERIOR = 0.4
_DEFECT = Polynomial.fromroots(C)
DEFECT_WEIGHT = abs(float(_DEFECT.integ()(C[0]) / _DEFECT(INTERIOR)))
# another such point, about where the defect is largest after the second stage
LATER = 0.85
LATER_WEIGHT = abs(float(_DEFECT.integ()(C[0]) / _DEFECT(LATER)))
_NODES = (0.0, *C)
VALUE = tuple(float(_lagrange(_NODES, i)(INTERIOR)) for i in range(4))
DERIVATIVE = tuple(float(_lagrange(_NODES, i).deriv()(INTERIOR)) for i in range(4))
INTEGRAL = _triple(np.array([_lagrange(C, i).integ()(INTERIOR) for i in range(3)]))

# the integrals of the quadratics through the stages from 0 to c, as coefficients of c, c^2, c^3
_INTEGRALS: Matrix = (
    _triple(_lagrange(C, 0).integ().coef[1:]),
    _triple(_lagrange(C, 1).integ().coef[1:]),
    _triple(_lagrange(C, 2).integ().coef[1:]),
)

_W0 = -1 / (C[0] * C[1])
_W1 = 1 / (C[0] * (C[0] - C[1]) * (C[0] - 1))
_W2 = 1 / (C[1] * (C[1] - C[0]) * (C[1] - 1))
_W3 = 1 / ((1 - C[0]) * (1 - C[1]))


@inlined
def cubic(values: tuple[float, float, float, float], c: float) -> float:
    """Return the cubic through `values` at 0 and the three stages, at `c` (1: the step's end)."""
    d1, d2, d3 = c - C[0], c - C[1], c - 1.0
    return _W0 * d1 * d2 * d3 * values[0] + c * (
        _W1 * d2 * d3 * values[1] + _W2 * d1 * d3 * values[2] + _W3 * d1 * d2 * values[3]
    )


@inlined
def cubic_slope(values: tuple[float, float, float, float], c: float) -> float:
    """Return the derivative by `c` of the cubic through `values` at 0 and the three stages."""
    d1, d2, d3 = c - C[0], c - C[1], c - 1.0
    e1, e2, e3 = d2 * d3, d1 * d3, d1 * d2
    return (
        _W0 * (e1 + e2 + e3) * values[0]
        + _W1 * (e1 + c * (d2 + d3)) * values[1]
        + _W2 * (e2 + c * (d1 + d3)) * values[2]
        + _W3 * (e3 + c * (d1 + d2)) * values[3]
    )


@inlined
def leading_factor(values: tuple[float, float, float, float]) -> float:
    """Return the factor of c^3 in the cubic through `values` at 0 and the three stages."""
    return _W0 * values[0] + _W1 * values[1] + _W2 * values[2] + _W3 * values[3]


@inlined
def integral(values: Triple, c: float) -> float:
    """Return the integral from 0 to `c` of the quadratic through `values` at the stages."""
    i, j, k = _INTEGRALS
    return c * (
        values[0] * (i[0] + c * (i[1] + c * i[2]))
        + values[1] * (j[0] + c * (j[1] + c * j[2]))
        + values[2] * (k[0] + c * (k[1] + c * k[2]))
    )
