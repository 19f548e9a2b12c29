"""Refined eigenvalues of a small real matrix, with bounds from errors of its entries."""

from __future__ import annotations

from math import sqrt
from typing import Any, NamedTuple

import numpy as np

from stiction.arrays import Complex, Floats, Indices
from stiction.linear_stability.characteristic import roots_of
from stiction.linear_stability.derivatives import EPSILON

EXTENDED = float(np.finfo(np.longdouble).eps)
REFINEMENTS = 3  # Newton steps; each gains about ten digits of a simple eigenvalue
REFINED = 4.0  # roundings of a residual, which end the steps
CLEAR = 1e-6  # of the largest eigenvalue: what is larger has its digits
WIDE = 1e-10  # of the largest eigenvalue: down to that, graded, each has six digits or more
ROUNDED = 1e-10  # of the largest eigenvalue: growth rates that are nearer may change places
CONVERGED = 1e-12  # relative error of the matrix; Newton's method leaves far less, or far more


class Modes(NamedTuple):
    """Eigenvalues of a matrix, one of each conjugate pair, (m,), and their vectors (columns).

    `adjoints` are the vectors of the transposed matrix for the conjugate eigenvalues, `gaps` the
    distances to the nearest other eigenvalue. Values and vectors are exact for a matrix each of
    whose entries differs by `off` of its size.
    """

    values: Complex
    vectors: Complex
    adjoints: Complex
    gaps: Floats
    off: Floats


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

    The matrix is balanced and graded first, because its unknowns differ in units, and by many
    orders of magnitude. Newton's method, with residuals in extended precision, then refines each
    eigenvalue and its vector, so that small eigenvalues have as many correct digits as large ones.
    Where it does not converge, it starts again from the roots of the characteristic polynomial.

    References
    ----------
    J. J. Dongarra, C. B. Moler & J. H. Wilkinson, SIAM J. Numer. Anal. 20 (1983), 23.
    """
    graded, scale, order = grade(matrix)
    modes = modes_of(graded)
    doubt = scale_errors(error, scale, order) + EPSILON * np.abs(graded)
    bounds = np.array([bound(graded, doubt, modes, k) for k in range(len(modes.values))])
    shapes = np.zeros_like(modes.vectors)
    shapes[order] = modes.vectors * scale[:, None]
    shapes /= np.linalg.norm(shapes, axis=0)
    pairs = np.flatnonzero(modes.values.imag > 0.0)  # those of the conjugate are the conjugates
    values = np.concatenate([modes.values, modes.values[pairs].conj()])
    shapes = np.concatenate([shapes, shapes[:, pairs].conj()], axis=1)
    uncertainty, growth = np.concatenate([bounds, bounds[pairs]]).T
    first = np.lexsort((-values.imag, -values.real))
    return Eigenvalues(values[first], shapes[:, first], uncertainty[first], growth[first])


def grade(matrix: Floats) -> tuple[Floats, Floats, Indices]:
    """Return a balanced matrix with its large rows first, and the scale and order of its unknowns.

    For such a matrix the QR algorithm mostly finds small eigenvalues to their own digits (Stewart,
    Numer. Math. 90 (2001), 349).
    """
    from scipy.linalg import matrix_balance

    balanced, (scale, _) = matrix_balance(matrix, permute=False, separate=True)
    order = np.argsort(-np.abs(balanced).max(axis=1), kind="stable")
    return balanced[np.ix_(order, order)], scale[order], order


def scale_errors(error: Floats, scale: Floats, order: Indices) -> Floats:
    """Return the errors of a graded matrix, from those of the matrix."""
    return error[np.ix_(order, order)] * scale[None, :] / scale[:, None]


def modes_of(matrix: Floats) -> Modes:
    """Return the modes of a graded matrix."""
    from scipy.linalg import eig

    modes = refine(matrix, *eig(matrix, left=True, right=True))
    if modes.off.max() < CONVERGED:
        return modes
    again = refine(matrix, *exact_modes(matrix))
    return modes if modes.off.max() <= again.off.max() else again


def exact_modes(matrix: Floats) -> tuple[Complex, Complex, Complex]:
    """Return eigenvalues from the characteristic polynomial, left and right vectors."""
    values = roots_of(matrix)
    partner = np.argmin(np.abs(values[:, None].conj() - values), axis=1)
    itself = np.arange(len(values))
    paired = (partner != itself) & (partner[partner] == itself)
    values = np.where(paired, values, values.real)  # the others are real but for rounding
    left = [null_vector(matrix.T, value.conjugate()) for value in values]
    right = [null_vector(matrix, value) for value in values]
    return values, np.array(left).T, np.array(right).T


def null_vector(matrix: Floats, value: complex) -> Complex:
    """Return the eigenvector of a known eigenvalue, by inverse iteration."""
    shifted = matrix - value * (1.0 + 4.0 * EPSILON) * np.eye(len(matrix))
    vector = np.ones(len(matrix), dtype=np.complex128)
    for _ in range(2):
        vector = solve(shifted, vector)
        vector = vector / np.abs(vector).max()
    return vector


def refine(matrix: Floats, values: Complex, left: Complex, right: Complex) -> Modes:
    """Return the modes that Newton's method finds from nearby eigenvalues and vectors."""
    apart = np.abs(values[:, None] - values) + np.diag(np.full(len(values), np.inf))
    one = values.imag >= 0.0  # of each pair
    gaps = apart.min(axis=1)[one]
    found, vectors, off = newton(matrix, values[one], right[:, one], gaps)
    _, adjoints, adjoint_off = newton(matrix.T, values[one].conj(), left[:, one], gaps)
    return Modes(found, vectors, adjoints, gaps, np.maximum(off, adjoint_off))


def newton(
    matrix: Floats, values: Complex, vectors: Complex, gaps: Floats
) -> tuple[Complex, Complex, Floats]:
    """Return eigenvalues, their vectors, and backward errors after a few steps of Newton's method.

    Each vector's largest component stays fixed. Steps that lead nearer to another eigenvalue,
    its gap away, are rejected. The backward error is relative, the same for all entries of the
    matrix: the least that explains the residual (Oettli & Prager, Numer. Math. 6 (1964), 405).
    """
    n, m = vectors.shape
    each, top = np.arange(m), np.argmax(np.abs(vectors), axis=0)
    exact: Any = matrix.astype(np.longdouble)
    x: Any = (vectors / vectors[top, each]).astype(np.clongdouble)
    found: Any = values.astype(np.clongdouble)
    bordered = np.zeros((m, n + 1, n + 1), dtype=np.complex128)
    bordered[each, n, top] = 1.0
    residual = np.zeros((m, n + 1, 1), dtype=np.complex128)
    goes_on = np.ones(m, dtype=bool)
    for turn in range(REFINEMENTS + 1):
        left = found * x - exact @ x
        terms = np.abs(exact) @ np.abs(x) + np.abs(found * x)
        off = np.divide(np.abs(left), terms, out=np.zeros_like(terms), where=terms > 0.0).max(
            axis=0
        )
        if turn == REFINEMENTS or off.max() <= REFINED * EXTENDED:
            break
        bordered[:, :n, :n] = matrix - np.eye(n) * found.astype(np.complex128)[:, None, None]
        bordered[:, :n, n] = -x.T.astype(np.complex128)
        residual[:, :n, 0] = left.T
        step = solve(bordered, residual)[:, :, 0].T
        goes_on &= np.abs((found + step[n]).astype(np.complex128) - values) < 0.5 * gaps
        x, found = x + step[:n] * goes_on, found + step[n] * goes_on
    off = np.maximum(off.astype(np.float64), EXTENDED)
    return found.astype(np.complex128), x.astype(np.complex128), off


def solve(matrices: Complex, right: Complex) -> Complex:
    """Solve linear equations; by least squares if one of the matrices is singular."""
    try:
        found: Any = np.linalg.solve(matrices, right)
    except np.linalg.LinAlgError:
        found = np.linalg.pinv(matrices) @ right
    result: Complex = found
    return result


def leading_eigenvalue(matrix: Floats) -> complex:
    """Return the eigenvalue with the largest real part, refined if rounding may hide it."""
    values = np.linalg.eigvals(matrix)
    leading, largest = complex(values[np.argmax(values.real)]), float(np.abs(values).max())
    if abs(leading) > CLEAR * largest and abs(leading.real) > ROUNDED * largest:
        return leading
    graded = grade(matrix)[0]
    values = np.linalg.eigvals(graded)
    if np.abs(values).min() < WIDE * largest:
        values = modes_of(graded).values
    return complex(values[np.argmax(values.real)])


def leading_growth(matrix: Floats, error: Floats) -> tuple[float, float]:
    """Return the largest real part of the eigenvalues, not refined, and a bound of its error."""
    from scipy.linalg import eig

    graded, scale, order = grade(matrix)
    values, left, right = eig(graded, left=True, right=True)
    n = len(values)
    gaps = (np.abs(values[:, None] - values) + np.diag(np.full(n, np.inf))).min(axis=1)
    modes = Modes(values, right, left, gaps, np.zeros(n))
    # of a matrix that differs by rounding of the largest entry, everywhere
    doubt = scale_errors(error, scale, order) + n * EPSILON * float(np.abs(graded).max())
    uncertain = np.array([bound(graded, doubt, modes, k)[1] for k in range(n)])
    return largest_growth(values.real, uncertain)


def refined_growth(matrix: Floats, error: Floats) -> tuple[float, float]:
    """Return the largest real part of the eigenvalues, and a bound of its error."""
    found = eigenvalues(matrix, error)
    return largest_growth(found.values.real, found.growth_uncertainty)


def largest_growth(rates: Floats, uncertain: Floats) -> tuple[float, float]:
    """Return the largest of some growth rates (1/s), and an error bound from their errors."""
    first = int(np.argmax(rates))
    growth = float(rates[first])
    return growth, float(max(uncertain[first], (rates + uncertain).max() - growth))


def bound(matrix: Floats, doubt: Floats, modes: Modes, k: int) -> tuple[float, float]:
    """Return error bounds of eigenvalue `k` and of its real part.

    To first order an error dA of the matrix moves an eigenvalue by w^H dA v/(w^H v) (Horn &
    Johnson, Matrix Analysis, 6.3.12); R takes each entry's error at its largest. The bound is
    2 R: of two eigenvalues d apart that the error drives together, one moves by
    [d - sqrt(d^2 - 4 R d)]/2 <= 2 R, or by sqrt(R d) <= 2 R where they meet, R > d/4. Where they
    are one, w^H v = 0, it is by the root of the error beside the largest entry. The real part's
    is that of first order and, as above, at most 4 R^2/d.
    """
    vector, adjoint, gap = modes.vectors[:, k], modes.adjoints[:, k], float(modes.gaps[k])
    v, w = np.abs(vector), np.abs(adjoint)
    left = np.abs(matrix) + abs(modes.values[k]) * np.eye(len(v))
    left *= modes.off[k]  # by Newton's method
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
