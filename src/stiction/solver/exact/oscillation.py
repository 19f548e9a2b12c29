"""The oscillation along the slip in closed form, on which a step superposes its cubic.

While the slip turns at a steady rate w', the slip p along its first direction obeys a linear
equation (M21),

    p'' + 2 beta (p' - G) + k (p - P - G t) = 0,   k = k_11, 2 beta = c_11 + F'/m,
    k P = (K v_d)_1 - 2 beta G,   k G = f w'^2 - k_12 r w',

and its solution with the right p(0), p'(0) also has the right p''(0), unless the load changes or
unequal dampers couple the turn. A step can be a large part of the oscillation's period if its
collocation polynomial approximates only the remainder, p minus this solution (mixed collocation,
e.g. Coleman & Duxbury 2000, doi:10.1016/S0377-0427(99)00340-4). Where nothing swings, the slip
follows the level P + G t, and a step may be longer than a period.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

from stiction.solver.accuracy import Accuracy
from stiction.solver.compilation.jit import inlined, switch
from stiction.solver.exact.slip_frame import Frame, Outset
from stiction.solver.stepping.block_algebra import Triple, dot
from stiction.solver.stepping.radau import DERIVATIVE, INTEGRAL, INTERIOR, VALUE, A, C, D

FIFTH, APART = 0.2, sqrt(6.0) / 10.0  # the stages are 2/5 -+ sqrt(6)/10 and 1
# Of k h^2: below, a cubic is as good; above, it replaces the swing
LEAST_SQUARE, MOST_SQUARE = 1e-3, 6.25
JUST_BELOW = 0.99  # of MOST_SQUARE: a step that is cut to it is superposed still
# Of k h^2 over a drifting level: near MOST_SQUARE, the defect misses what is left of cos
CALM = 3.0
UNEXPLAINED = 0.5  # of the slip's change: a drift that leaves more of it is none
STRONGEST = 0.2  # of |beta|/sqrt(k): with stronger damping it dies out within one swing


class Oscillator(NamedTuple):
    """Its k (1/s^2) and beta (1/s), its level P (m/s) and the drift G of that (m/s^2).

    At the start: x, the slip p above the level (m/s), and v, its rate p' above the drift (m/s^2).
    """

    k: float
    per_k: float
    beta: float
    level: float
    drift: float
    x: float
    v: float


class Swing(NamedTuple):
    """The terms of the oscillation in the equations of a step; see `collocation`.

    p, dp : p and h p' at the stages. rest, slid : its difference from its cubic, in h p' and in the
    distance over h, with their derivatives by the step size; the same at the interior point.
    """

    p: Triple
    dp: Triple
    rest: Triple
    slid: Triple
    rest_by_h: Triple
    slid_by_h: Triple
    p_in: float
    rest_in: float
    slid_in: float


@inlined
def oscillator(frame: Frame, start: Outset) -> Oscillator:
    """Return the oscillator that matches the slip at the step's start."""
    per_k = 1.0 / frame.k_11
    beta = 0.5 * (frame.c_11 + start.gradient)
    drift = drift_of_level(frame, start, beta)
    level = (start.da_1 - 2.0 * beta * drift) * per_k
    v = start.a_1 - start.f
    return Oscillator(frame.k_11, per_k, beta, level, drift, frame.r - level, v - drift)


@inlined
def drift_of_level(frame: Frame, start: Outset, beta: float) -> float:
    """Return the drift of the oscillation's level as the slip turns (m/s^2).

    It counts where it explains the change of the slip, which then does not swing. At take-off the
    slip is too small for its turn to matter; and where an oscillation grows, however small, the
    slip does not follow its level for long.
    """
    if frame.r == 0.0:
        return 0.0
    across, change = start.a_2 - start.turn, start.a_1 - start.f
    turn = across / frame.r
    drift = (start.f * turn * turn - frame.k_12 * across) / frame.k_11
    damping = 2.0 * beta * frame.k_11 + (frame.c_22 + start.f / frame.r) * frame.k_22
    return drift if damping > 0.0 and abs(change - drift) <= UNEXPLAINED * abs(change) else 0.0


@inlined
def swings(o: Oscillator, h: float) -> bool:
    """Return whether a step of size `h` is superposed on the oscillation."""
    square = o.k * h * h
    return LEAST_SQUARE < square < MOST_SQUARE and weakly_damped(o)


@inlined
def weakly_damped(o: Oscillator) -> bool:
    """Return whether the oscillation is weakly damped."""
    return o.beta * o.beta < STRONGEST * STRONGEST * o.k


@inlined
def within_reach(o: Oscillator, h: float, accuracy: Accuracy, motion: float) -> float:
    """Return the step size `h`, limited to the part of a swing that one step can cover.

    `motion` is that about steady sliding, m/s.
    """
    most = JUST_BELOW * MOST_SQUARE if o.drift == 0.0 else CALM
    if o.k * h * h < most or not weakly_damped(o):
        return h
    size = accuracy.tolerance * min(accuracy.speed + o.level + o.x, motion)
    if o.x * o.x + o.v * o.v * o.per_k < size * size:  # no oscillation
        return h
    return sqrt(most * o.per_k)


@inlined
def propagator(o: Oscillator, t: float) -> tuple[float, float]:
    """Return exp(-beta t) (cos, sin/omega)(omega t), omega^2 = k - beta^2, for short t."""
    y, b = (o.k - o.beta * o.beta) * t * t, -o.beta * t
    cos = 1 - y / 2 * (1 - y / 12 * (1 - y / 30 * (1 - y / 56 * (1 - y / 90 * (1 - y / 132)))))
    sin = 1 - y / 6 * (1 - y / 20 * (1 - y / 42 * (1 - y / 72 * (1 - y / 110 * (1 - y / 156)))))
    decay = 1 + b / 4 * (1 + b / 5 * (1 + b / 6 * (1 + b / 7 * (1 + b / 8))))
    decay = 1 + b * (1 + b / 2 * (1 + b / 3 * decay))
    return decay * cos, decay * sin * t


@inlined
def compose(o: Oscillator, a: tuple[float, float], b: tuple[float, float]) -> tuple[float, float]:
    """Return the propagator over the sum of two times."""
    square = o.k - o.beta * o.beta
    return a[0] * b[0] - square * a[1] * b[1], a[1] * b[0] + a[0] * b[1]


@inlined
def propagate(o: Oscillator, u: tuple[float, float], t: float) -> tuple[float, float, float]:
    """Return p, p' and the distance slipped after `t` (M22), (M23), given its propagator `u`."""
    x = o.x * u[0] + (o.v + o.beta * o.x) * u[1]
    v = o.v * u[0] - (o.beta * o.v + o.k * o.x) * u[1]
    slid = (o.level + 0.5 * o.drift * t) * t + (o.v - v + 2.0 * o.beta * (o.x - x)) * o.per_k
    return o.level + o.drift * t + x, o.drift + v, slid


@inlined
def after(o: Oscillator, t: float) -> tuple[float, float, float]:
    """Return p, p' and the distance slipped after `t`."""
    u = propagator(o, 0.25 * t)
    u = compose(o, u, u)
    return propagate(o, compose(o, u, u), t)


NO_LANDING = switch(False)


@inlined
def still() -> Swing:
    """Return the terms in a step that is not laid over an oscillation."""
    nothing = (0.0, 0.0, 0.0)
    return Swing(nothing, nothing, nothing, nothing, nothing, nothing, 0.0, 0.0, 0.0)


@inlined
def swing(o: Oscillator, h: float, landing: bool) -> Swing:
    """Return the oscillation's terms in the equations of a step of size `h` (M25), (M46)."""
    if not swings(o, h):
        return still()
    fifth = propagator(o, FIFTH * h)
    two = compose(o, fifth, fifth)
    p0, v0, z0 = propagate(o, compose(o, two, propagator(o, -APART * h)), C[0] * h)
    p1, v1, z1 = propagate(o, compose(o, two, propagator(o, APART * h)), C[1] * h)
    p2, v2, z2 = propagate(o, compose(o, compose(o, two, two), fifth), h)
    p_in, v_in, z_in = propagate(o, two, INTERIOR * h)
    p, dp, per_h, r = (p0, p1, p2), (h * v0, h * v1, h * v2), 1.0 / h, o.level + o.x
    above = (p0 - r, p1 - r, p2 - r)
    sums = (dot(A[0], p), dot(A[1], p), dot(A[2], p))
    rest_by_h = slid_by_h = (0.0, 0.0, 0.0)
    if landing:
        by_h = (C[0] * dp[0], C[1] * dp[1], C[2] * dp[2])
        square, twice, gain = o.k * h * h, 2.0 * o.beta * h, h * o.drift
        bend = (  # h^2 p''
            -twice * (dp[0] - gain) - square * (p0 - o.level - gain * C[0]),
            -twice * (dp[1] - gain) - square * (p1 - o.level - gain * C[1]),
            -twice * (dp[2] - gain) - square * (p2 - o.level - gain * C[2]),
        )
        rest_by_h = (
            (dp[0] + C[0] * bend[0] - dot(D[0], by_h)) * per_h,
            (dp[1] + C[1] * bend[1] - dot(D[1], by_h)) * per_h,
            (dp[2] + C[2] * bend[2] - dot(D[2], by_h)) * per_h,
        )
        slid_by_h = (
            C[0] * p0 - sums[0] - dot(A[0], by_h),
            C[1] * p1 - sums[1] - dot(A[1], by_h),
            C[2] * p2 - sums[2] - dot(A[2], by_h),
        )
    return Swing(
        p,
        dp,
        (dp[0] - dot(D[0], above), dp[1] - dot(D[1], above), dp[2] - dot(D[2], above)),
        (z0 * per_h - sums[0], z1 * per_h - sums[1], z2 * per_h - sums[2]),
        rest_by_h,
        slid_by_h,
        p_in - VALUE[0] * r - dot((VALUE[1], VALUE[2], VALUE[3]), p),
        h * v_in - DERIVATIVE[0] * r - dot((DERIVATIVE[1], DERIVATIVE[2], DERIVATIVE[3]), p),
        z_in * per_h - dot(INTEGRAL, p),
    )
