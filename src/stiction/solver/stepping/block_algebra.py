"""Linear algebra of two unknowns at three stages: 3 by 3 blocks, written out.

Triples are tuples, so that the compiler keeps them in registers.
"""

from __future__ import annotations

from typing import NamedTuple

from stiction.solver.compilation.jit import inlined

Triple = tuple[float, float, float]
Matrix = tuple[Triple, Triple, Triple]


@inlined
def dot(a: Triple, b: Triple) -> float:
    """Return the scalar product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@inlined
def times(m: Matrix, x: Triple) -> Triple:
    """Return a matrix times a column."""
    return dot(m[0], x), dot(m[1], x), dot(m[2], x)


@inlined
def product(a: Matrix, b: Matrix) -> Matrix:
    """Return a matrix times a matrix."""
    c0 = times(a, (b[0][0], b[1][0], b[2][0]))
    c1 = times(a, (b[0][1], b[1][1], b[2][1]))
    c2 = times(a, (b[0][2], b[1][2], b[2][2]))
    return (c0[0], c1[0], c2[0]), (c0[1], c1[1], c2[1]), (c0[2], c1[2], c2[2])


@inlined
def less(a: Triple, b: Triple) -> Triple:
    """Return a - b."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


@inlined
def inverse(m: Matrix) -> Matrix:
    """Return the inverse by cofactors: no pivoting, one division."""
    (a, b, c), (d, e, f), (g, h, i) = m
    c0, c1, c2 = e * i - f * h, f * g - d * i, d * h - e * g
    q = 1.0 / (a * c0 + b * c1 + c * c2)
    return (
        (c0 * q, (c * h - b * i) * q, (b * f - c * e) * q),
        (c1 * q, (a * i - c * g) * q, (c * d - a * f) * q),
        (c2 * q, (b * g - a * h) * q, (a * e - b * d) * q),
    )


class Factors(NamedTuple):
    """Factors of a 6 by 6 system in p and w, eliminated block by block: w first, then p."""

    inverse_ww: Matrix
    w_by_p: Matrix
    p_by_w: Matrix
    inverse_pp: Matrix


@inlined
def eliminate(pp: Matrix, pw: Matrix, wp: Matrix, ww: Matrix) -> Factors:
    """Return the factors of the matrix of the four blocks."""
    inverse_ww = inverse(ww)
    w_by_p = product(inverse_ww, wp)
    feedback = product(pw, w_by_p)
    inverse_pp = inverse(
        (less(pp[0], feedback[0]), less(pp[1], feedback[1]), less(pp[2], feedback[2]))
    )
    return Factors(inverse_ww, w_by_p, pw, inverse_pp)


@inlined
def solve_blocks(m: Factors, right_p: Triple, right_w: Triple) -> tuple[Triple, Triple]:
    """Return (p, w) for the given right-hand side."""
    w = times(m.inverse_ww, right_w)
    p = times(m.inverse_pp, less(right_p, times(m.p_by_w, w)))
    return p, less(w, times(m.w_by_p, p))
