"""The growth of small disturbances of steady sliding, and the longest step that shows it.

Stiffly accurate methods damp what a step is too long to resolve, a growing oscillation as well. A
run that comes to steady sliding within rounding would rest there whatever its modes do. There the
loops ask whether a disturbance grows, and hold their steps to what shows it (M43a).
"""

from __future__ import annotations

from math import inf

import numpy as np

from stiction.arrays import TINY, Complex, Floats
from stiction.solver.compilation.jit import piece
from stiction.solver.compilation.stand_in import called_from_both
from stiction.solver.problem import Problem, cross_damping

LONGER = 64.0  # times what is left: so much later a growth shows
SHOWN_GROWTH = 1e20  # times the disturbance: more than one that does not grow becomes in between
FINER = 0.1  # of a step: the trapezoidal rule then shows most of the growth
DOUBLINGS = 100
DAMPED = 7200.0  # |R(iy)| = 1 - y^6/7200 + ... of Radau IIA
SHARE = 0.1  # of the growth that the method may damp
RESOLVED = 1.0  # h |lambda|, at most
HIDDEN = 1e-8  # of the slowest mode's 1/(1 - h lambda): less is rounding


@called_from_both
def write_rates(problem: Problem, slopes: np.ndarray, rates: np.ndarray) -> None:
    """Write the rates of change of a small disturbance of (u_x, u_y, s_x, s_y, z), from (M2).

    `slopes` (2 + n, 2 + n) are the derivatives of friction over mass and of the rates of the
    internal states, by slip and states, in the solver's axes; `rates` (4 + n, 4 + n) is all zero
    or of an earlier call.
    """
    system, per, c = problem.system, problem.system.per_mass, cross_damping(problem.rig)
    rates[0, 2] = rates[1, 3] = -1.0
    rates[2, 0], rates[3, 1] = system.k_x * per, system.k_y * per
    for j in range(len(slopes)):
        for k in range(len(slopes)):
            rates[2 + j, 2 + k] = -slopes[j, k] if j < 2 else slopes[j, k]
    rates[2, 2] -= system.c_x * per
    rates[3, 3] -= system.c_y * per
    rates[2, 3] -= c * per
    rates[3, 2] -= c * per


@piece
def grows(rates: np.ndarray, room: np.ndarray, h: float, left: float) -> bool:
    """Return whether a small disturbance would grow by about two times in the time left.

    The trapezoidal rule multiplies it by (1 + h J/2)/(1 - h J/2) in a step. That grows exactly if a
    mode does, however long the step is. It is squared until a long time is over. `room` is for
    three matrices like `rates`.
    """
    n = len(rates)
    inverse, power, product = room[0], room[1], room[2]
    h *= FINER
    if not write_inverse(rates, 0.5 * h, power, inverse):
        return True
    for i in range(n):
        for j in range(n):
            power[i, j] = 2.0 * inverse[i, j] - (1.0 if i == j else 0.0)
    over = h
    for _ in range(DOUBLINGS):
        if over > LONGER * left:
            break
        multiply(power, power, product)
        power, product = product, power
        over *= 2.0
        size = largest(power)
        if not size < SHOWN_GROWTH:
            return True
        if size < 1.0 / SHOWN_GROWTH:
            return False
    multiply(inverse, power, product)  # in which fast modes are small
    return not largest(product) < SHOWN_GROWTH


@piece
def write_inverse(rates: np.ndarray, h: float, room: np.ndarray, to: np.ndarray) -> bool:
    """Write the inverse of 1 - h J, by Gauss and Jordan; return whether there is one."""
    n = len(rates)
    for i in range(n):
        widest = 0.0
        for j in range(n):
            room[i, j] = (1.0 if i == j else 0.0) - h * rates[i, j]
            widest = max(widest, abs(room[i, j]))
        if not 0.0 < widest < inf:
            return False
        for j in range(n):
            room[i, j] /= widest
            to[i, j] = 1.0 / widest if i == j else 0.0
    for k in range(n):
        best = k
        for i in range(k + 1, n):
            if abs(room[i, k]) > abs(room[best, k]):
                best = i
        if not abs(room[best, k]) > 0.0:
            return False
        per = 1.0 / room[best, k]
        for j in range(n):
            a, b = room[best, j], to[best, j]
            room[best, j], to[best, j] = room[k, j], to[k, j]
            room[k, j], to[k, j] = a * per, b * per
        for i in range(n):
            factor = room[i, k]
            if i != k:
                for j in range(n):
                    room[i, j] -= factor * room[k, j]
                    to[i, j] -= factor * to[k, j]
    return True


@piece
def multiply(a: np.ndarray, b: np.ndarray, to: np.ndarray) -> None:
    """Write the product of two matrices."""
    n = len(a)
    for i in range(n):
        for j in range(n):
            total = 0.0
            for k in range(n):
                total += a[i, k] * b[k, j]
            to[i, j] = total


@piece
def largest(a: np.ndarray) -> float:
    """Return the largest entry of a matrix, or NaN if one is."""
    found = 0.0
    for i in range(len(a)):
        for j in range(len(a)):
            found = found if abs(a[i, j]) <= found else abs(a[i, j])
    return found


def longest_step(rates: Floats, h: float, left: float) -> float:
    """Return the longest step (s) that shows how small disturbances of steady sliding grow.

    Parameters
    ----------
    rates : ndarray
        (4 + n, 4 + n): see `write_rates`.
    h : float
        s, about the size of the steps that are taken.
    left : float
        s: what grows by less than e times in that time does not count.

    Returns
    -------
    float
        Infinite if nothing grows. See (M43a) in `docs/method.md`.
    """
    modes = slow_modes(rates, h)
    growing = modes[modes.real * left > 1.0]
    if not len(growing):
        return inf
    rate, growth = np.abs(growing), growing.real / np.abs(growing)
    return float(np.min(np.minimum(RESOLVED, (SHARE * DAMPED * growth) ** 0.2) / rate))


def slow_modes(rates: Floats, h: float) -> Complex:
    """Return the eigenvalues (1/s) of a matrix of rates, except those far beyond 1/h.

    They are those of the inverse of 1 - h J, in which the slow modes are large: friction may be so
    stiff that in J itself they are below rounding.
    """
    if not np.isfinite(rates).all():  # without a finite slope there are no modes
        return np.empty(0, dtype=np.complex128)
    implicit = np.eye(len(rates)) - h * rates
    rows = 1.0 / np.maximum(np.abs(implicit).max(axis=1), TINY)
    try:
        found = np.linalg.eigvals(np.linalg.inv(rows[:, None] * implicit) * rows)
    except np.linalg.LinAlgError:  # it is singular: a mode grows at this rate
        return np.array([1.0 / h], dtype=np.complex128)
    large = np.abs(found) > HIDDEN * np.abs(found).max()
    slow: Complex = (1.0 - 1.0 / found[large]) / h
    return slow
