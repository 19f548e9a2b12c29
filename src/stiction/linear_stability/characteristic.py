"""Roots of the characteristic polynomial, whose coefficients are exact integers."""

from __future__ import annotations

from itertools import pairwise
from math import log2, pi
from typing import Any

import numpy as np

from stiction.arrays import Complex, Floats

ROUNDS = 100  # of Aberth's method, which takes some ten
STEADY = 1e-12  # relative change of a root in the last round


def roots_of(matrix: Floats) -> Complex:
    """Return the eigenvalues of a matrix, simple ones to some twelve digits each.

    However large the others are: nothing cancels in exact coefficients. Aberth's method finds all
    roots at once, from the sizes that the Newton polygon of the coefficients gives them.

    References
    ----------
    D. A. Bini, Numer. Algorithms 13 (1996), 179.
    """
    coefficients, exponent = characteristic(matrix)
    zeros = next(k for k, each in enumerate(coefficients) if each)
    rest = coefficients[zeros:]
    sizes = np.array([log2(abs(each)) if each else -np.inf for each in rest])
    signs = np.array([(each > 0) - (each < 0) for each in rest], dtype=np.float64)
    sizes = sizes + exponent * np.arange(len(rest))  # of powers of the eigenvalue itself
    roots = first_guess(sizes)
    for _ in range(ROUNDS):
        step = aberth(sizes, signs, roots)
        if not np.isfinite(step).all():
            break
        roots = roots * (1.0 - step)
        if np.abs(step).max(initial=0.0) < STEADY:
            break
    return np.concatenate([np.zeros(zeros), roots])


def aberth(sizes: Floats, signs: Floats, roots: Complex) -> Complex:
    """Return the relative corrections of all roots, from log2 of the coefficients and their signs.

    Each polynomial is scaled by its largest term, so that none overflows.
    """
    powers, n = np.arange(len(sizes)), len(roots)
    with np.errstate(divide="ignore", invalid="ignore"):  # of roots that meet
        terms = sizes + np.log2(np.abs(roots))[:, None] * powers
        terms = signs * np.exp2(terms - terms.max(axis=1, keepdims=True))
        terms = terms * (roots / np.abs(roots))[:, None] ** powers
        apart = roots[:, None] - roots + np.diag(np.full(n, np.inf))
        value = terms.sum(axis=1)
        step: Complex = value / (terms @ powers - value * (roots[:, None] / apart).sum(axis=1))
    return step


def characteristic(matrix: Floats) -> tuple[list[int], int]:
    """Return integers c_k and e: the characteristic polynomial is sum c_k (2^e x)^k.

    By the method of Faddeev and LeVerrier, in which every division is exact.
    """
    ratios = [each.as_integer_ratio() for each in matrix.ravel().tolist()]
    exponent = max(below.bit_length() for _, below in ratios) - 1
    whole = [above * (2**exponent // below) for above, below in ratios]
    n = len(matrix)
    exact: Any = np.array(whole, dtype=object).reshape(n, n)
    unit: Any = np.array([[int(i == j) for j in range(n)] for i in range(n)], dtype=object)
    coefficients, power = [1], exact
    for k in range(1, n + 1):
        coefficients.append(-int(np.trace(power)) // k)
        power = exact @ (power + coefficients[-1] * unit)
    return coefficients[::-1], exponent


def first_guess(sizes: Floats) -> Complex:
    """Return numbers of about the magnitudes of a polynomial's roots.

    Between corners j < k of the Newton polygon, the upper hull of log2 |c_k| over k, there are
    k - j roots of the size |c_j/c_k|^(1/(k - j)).
    """
    hull: list[int] = []
    for k in np.flatnonzero(np.isfinite(sizes)).tolist():
        while len(hull) > 1 and slope(sizes, *hull[-2:]) <= slope(sizes, hull[-1], k):
            hull.pop()
        hull.append(k)
    roots = []
    for j, k in pairwise(hull):
        size = np.exp2(-slope(sizes, j, k))
        angles = 2.0 * pi * np.arange(k - j) / (k - j) + 0.7 + k  # none is real, or a conjugate
        roots.append(size * np.exp(1j * angles))
    return np.concatenate(roots) if roots else np.zeros(0, dtype=np.complex128)


def slope(sizes: Floats, j: int, k: int) -> float:
    """Return the slope between two points of the Newton polygon."""
    return float(sizes[k] - sizes[j]) / (k - j)
