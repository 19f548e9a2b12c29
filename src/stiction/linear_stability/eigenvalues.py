"""Refined eigenvalues of a small real matrix, with bounds from errors of its entries."""

from __future__ import annotations

from math import sqrt
from typing import Any, NamedTuple

import numpy as np

from stiction.arrays import Complex, Floats
from stiction.linear_stability.derivatives import ROUNDING

EXTENDED = float(np.finfo(np.longdouble).eps)
REFINEMENTS = 3  # Newton steps; each gains about ten digits of a simple eigenvalue


class Eigenvalues(NamedTuple):
    """Eigenvalues, fastest growth first, their vectors (columns), and error bounds.

    `uncertainty` bounds the error of an eigenvalue in the complex plane, `growth_uncertainty` that
    of its real part. The latter may be far smaller: errors of a stiffness shift only frequencies.
    """

    values: Complex
    vectors: Complex
    uncertainty: Floats
    growth_uncertainty: Floats


def eigenvalues(matrix: Floats, error: Floats) -> Eigenvalues:
    """Return the eigenvalues of a matrix whose entries are uncertain by `error`.

    The matrix is balanced first, because its unknowns differ in units, and by many orders of
    magnitude. Newton's method, with residuals in extended precision, then refines each eigenvalue
    and its vector, so that small eigenvalues have as many correct digits as large ones.

    References
    ----------
    J. J. Dongarra, C. B. Moler & J. H. Wilkinson, SIAM J. Numer. Anal. 20 (1983), 23.
    """
    balanced, scale, values, left, right = balanced_modes(matrix)
    doubt = error * scale[None, :] / scale[:, None] + ROUNDING * np.abs(balanced)
    refined, bounds, shapes = [], [], []
    for k in np.flatnonzero(values.imag >= 0.0):
        value = values[k]
        gap = float(np.abs(np.delete(values, k) - value).min())
        found, vector = refine(balanced, value, right[:, k], gap)
        adjoint = refine(balanced.T, value.conjugate(), left[:, k], gap)[1]
        both = bound(balanced, doubt, found, vector, adjoint, gap)
        shape = vector * scale / np.linalg.norm(vector * scale)
        pair = value.imag > 0.0  # that of the conjugate is the conjugate
        refined += [found, found.conjugate()] if pair else [found]
        bounds += [both, both] if pair else [both]
        shapes += [shape, shape.conj()] if pair else [shape]
    values = np.array(refined)
    order = np.lexsort((-values.imag, -values.real))
    uncertainty, growth = np.array(bounds)[order].T
    return Eigenvalues(values[order], np.array(shapes).T[:, order], uncertainty, growth)


def balanced_modes(matrix: Floats) -> tuple[Floats, Floats, Complex, Complex, Complex]:
    """Return a balanced matrix, its scale, and its eigenvalues with left and right vectors."""
    from scipy.linalg import eig, matrix_balance

    balanced, (scale, _) = matrix_balance(matrix, permute=False, separate=True)
    return balanced, scale, *eig(balanced, left=True, right=True)


def leading_growth(matrix: Floats, error: Floats) -> tuple[float, float]:
    """Return the largest real part of the eigenvalues, not refined, and a bound of its error."""
    balanced, scale, values, left, right = balanced_modes(matrix)
    # of a matrix that differs by rounding of the largest entry, everywhere
    rounding = len(values) * ROUNDING * float(np.abs(balanced).max())
    doubt = error * scale[None, :] / scale[:, None] + rounding
    uncertain = np.zeros(len(values))
    for k, value in enumerate(values):
        gap = float(np.abs(np.delete(values, k) - value).min())
        uncertain[k] = bound(balanced, doubt, value, right[:, k], left[:, k], gap)[1]
    return largest_growth(values.real, uncertain)


def largest_growth(rates: Floats, uncertain: Floats) -> tuple[float, float]:
    """Return the largest of some growth rates (1/s), and a bound of its error, from theirs."""
    first = int(np.argmax(rates))
    growth = float(rates[first])
    return growth, float(max(uncertain[first], (rates + uncertain).max() - growth))


def refine(matrix: Floats, value: complex, vector: Complex, gap: float) -> tuple[complex, Complex]:
    """Return an eigenvalue and its vector after a few steps of Newton's method.

    The vector's largest component stays fixed. Steps that lead nearer to another eigenvalue, `gap`
    away, are rejected.
    """
    n, top = len(vector), int(np.argmax(np.abs(vector)))
    exact: Any = matrix.astype(np.longdouble)
    x: Any = (vector / vector[top]).astype(np.clongdouble)
    found: Any = np.clongdouble(value)
    bordered = np.zeros((n + 1, n + 1), dtype=np.complex128)
    bordered[n, top] = 1.0
    for _ in range(REFINEMENTS):
        bordered[:n, :n] = matrix - np.eye(n) * complex(found)
        bordered[:n, n] = -x.astype(np.complex128)
        residual = np.append(found * x - exact @ x, 0.0).astype(np.complex128)
        try:
            step = np.linalg.solve(bordered, residual)
        except np.linalg.LinAlgError:
            break
        if not abs(complex(found) + step[n] - value) < 0.5 * gap:
            break
        x, found = x + step[:n], found + step[n]
    result: Complex = x.astype(np.complex128)
    return complex(found), result


def bound(
    matrix: Floats, doubt: Floats, value: complex, vector: Complex, adjoint: Complex, gap: float
) -> tuple[float, float]:
    """Return error bounds of an eigenvalue and of its real part.

    To first order an error dA of the matrix moves an eigenvalue by w^H dA v/(w^H v) (Horn &
    Johnson, Matrix Analysis, 6.3.12); R takes each entry's error at its largest. The bound is
    2 R: of two eigenvalues d apart that the error drives together, one moves by
    [d - sqrt(d^2 - 4 R d)]/2 <= 2 R, or by sqrt(R d) <= 2 R where they meet, R > d/4. Where they
    are one, w^H v = 0, it is by the root of the error beside the largest entry. The real part's
    is that of first order and, as above, at most 4 R^2/d.
    """
    v, w = np.abs(vector), np.abs(adjoint)
    left = EXTENDED * (np.abs(matrix) + abs(value) * np.eye(len(v)))  # left by Newton's method
    reach, size = float(w @ (doubt + left) @ v), float(np.sqrt((w @ w) * (v @ v)))
    meeting = sqrt(reach / size * float(np.abs(matrix).max()))
    product = adjoint.conj() @ vector
    if not reach < meeting * abs(product):
        return 2.0 * meeting, 2.0 * meeting
    first = float(reach / abs(product))
    along = np.abs((np.outer(adjoint.conj(), vector) / product).real)
    second = min(4.0 * first**2 / gap, first) if gap > 0.0 else first
    growth = float(np.sum(along * doubt) + w @ left @ v / abs(product)) + second
    return 2.0 * first, min(2.0 * growth, 2.0 * first)
