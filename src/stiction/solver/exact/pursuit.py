"""The end of a slip in closed form: the classical pursuit curve.

Near zero slip the spring acceleration a and the friction deceleration f are constant,
and s' = a - f s/|s|. For |a| < f, zero slip is reached after T = r (f + |a| cos alpha) /
(f^2 - |a|^2), with r the slip speed and alpha its angle to a (Bouguer
1732). The displacement is closed as well: with P = a.s and R = |s|,

    d/dt (f R + P)         = |a|^2 - f^2
    d/dt (f R P + P^2/2)   = (|a|^2 - 2 f^2) P + f |a|^2 R,   d/dt R^2 = 2 P - 2 f R
    d/dt ((2 f R + P) b)   = (|a|^2 - 4 f^2) b,   b the slip across a

integrate from the start to R = 0: (M48), (M49).
"""

from __future__ import annotations

from math import atan2, cos, inf, sin, sqrt, tan

import numpy as np

from stiction.solver.accuracy import Accuracy
from stiction.solver.compilation.jit import inlined
from stiction.solver.exact.record import Sink, keep_landing
from stiction.solver.exact.sampling import fill
from stiction.solver.exact.slip_frame import Frame, Outset, elongation
from stiction.solver.problem import Problem, at, constant, drift, isotropic
from stiction.solver.state import Motion, State, at_takeoff

WITHOUT_FORCE = 1e-8  # of friction: springs that neither shorten nor turn the slip
STRAIGHT = 1e-12  # sine of the angle to their force: it does not turn the slip
UNCHANGED = 0.1  # of the tolerated slip speed: spring and friction stay constant until landing
BISECTIONS = 60  # until the place on the curve is known
INSTANT = 1e-13  # of the time so far, and of a spring's time for a radian


@inlined
def landing_time(r: float, a_along: float, a_squared: float, f: float) -> float:
    """Return the time to zero slip.

    Parameters
    ----------
    r : float
        Slip speed, m/s.
    a_along, a_squared : float
        Spring acceleration along the slip, m/s^2, and its magnitude squared.
    f : float
        Friction force over mass, m/s^2, larger than the magnitude of a.
    """
    return r * (f + a_along) / (f * f - a_squared)


@inlined
def landing_slip(r: float, a1: float, a2: float, f: float) -> tuple[float, float]:
    """Return the distance slipped until zero slip, along and across the initial slip, in m.

    Parameters
    ----------
    r : float
        Slip speed, m/s.
    a1, a2 : float
        Spring acceleration along and across the initial slip, m/s^2.
    f : float
        Friction force over mass, m/s^2, larger than the magnitude of a.
    """
    square = a1 * a1 + a2 * a2
    a = sqrt(square)
    if a < WITHOUT_FORCE * f:
        return 0.5 * r * r / f, 0.0
    along, across = r * a1 / a, -r * a2 / a  # slip in the axes of a
    distance_along = (f * r * along + 0.5 * a * (along * along + r * r)) / (2 * (f * f - square))
    distance_across = across * (2 * f * r + a * along) / (4 * f * f - square)
    return (
        (a1 * distance_along - a2 * distance_across) / a,
        (a2 * distance_along + a1 * distance_across) / a,
    )


@inlined
def slip_before_landing(
    r: float, a1: float, a2: float, f: float, left: float
) -> tuple[float, float, float]:
    """Return slip speed and direction, along and across the initial slip, `left` s before landing.

    On the curve, r sin(alpha)/tan(alpha/2)^(f/|a|) is constant, and alpha falls.
    """
    square = a1 * a1 + a2 * a2
    a = sqrt(square)
    whole = atan2(abs(a2), a1)
    if a < WITHOUT_FORCE * f or sin(whole) < STRAIGHT:
        return left * (f * f - square) / (f + a1), 1.0, 0.0
    low, high, speed = 0.0, whole, r
    for _ in range(BISECTIONS):
        alpha = 0.5 * (low + high)
        speed = r * (tan(0.5 * alpha) / tan(0.5 * whole)) ** (f / a) * sin(whole) / sin(alpha)
        if speed * (f + a * cos(alpha)) > left * (f * f - square):
            high = alpha
        else:
            low = alpha
    turned = whole - high
    return speed, cos(turned), sin(turned) if a2 > 0.0 else -sin(turned)


@inlined
def pursuit(
    problem: Problem, frame: Frame, start: Outset, accuracy: Accuracy
) -> tuple[float, float, float]:
    """Return the time (s) to landing, and the distance slipped until then (m), in closed form.

    The time is infinite unless spring and friction stay constant until landing, to a tenth of the
    tolerance (M50), or landing comes before floats can resolve it in time or in either spring.
    """
    r = frame.r
    a_1, a_2, da_1, da_2, f, gradient, _ = start
    square = a_1 * a_1 + a_2 * a_2
    if not square < f * f or not isotropic(problem.surface):
        return inf, 0.0, 0.0
    T = landing_time(r, a_1, square, f)
    jerk = abs(da_1) + abs(da_2) + (frame.k_11 + frame.k_22) * r
    relaxation = abs(gradient) + frame.c_11 + frame.c_22
    if not constant(problem.load):
        jerk += abs(drift(problem.load, frame.t)) * f / at(problem.load, frame.t)
    change = T * (T * jerk + relaxation * r)
    square = min(accuracy.square_x, accuracy.square_y)
    resolved = INSTANT * abs(frame.t) < T and INSTANT * INSTANT * square < T * T
    if resolved and change > UNCHANGED * accuracy.tolerance * accuracy.speed:
        return inf, 0.0, 0.0
    slid_1, slid_2 = landing_slip(r, a_1, a_2, f)
    return T, slid_1, slid_2


@inlined
def land(
    problem: Problem,
    frame: Frame,
    start: Outset,
    state: State,
    closed: tuple[float, float, float],
    sink: Sink,
    k: int,
) -> tuple[State, int]:
    """End the slip by the pursuit curve."""
    motion, memory, counts = state
    t, a_1, a_2 = motion.t, start.a_1, start.a_2
    (T, slid_1, slid_2), times = closed, sink.times
    while k < len(times) and times[k] < t + T:
        left, gone = t + T - times[k], times[k] - t
        k = write_landing(problem, frame, a_1, a_2, start.f, closed, left, gone, sink.samples, k)
    keep_landing(sink.record, frame, T, a_1, a_2, start.f)
    u_x, u_y = elongation(problem, frame, T, slid_1, slid_2)
    landed = Motion(t + T, u_x, u_y, 0.0, frame.e_x, frame.e_y)
    return State(landed, at_takeoff(memory), counts), k


@inlined
def write_landing(
    problem: Problem,
    frame: Frame | Motion,
    a_1: float,
    a_2: float,
    f: float,
    closed: tuple[float, float, float],
    left: float,
    gone: float,
    samples: np.ndarray,
    k: int,
) -> int:
    """Write the sample `left` s before the landing, `gone` s after `frame`; return the next row."""
    _, slid_1, slid_2 = closed
    speed, n_1, n_2 = slip_before_landing(frame.r, a_1, a_2, f, left)
    d_1, d_2 = landing_slip(speed, a_1 * n_1 + a_2 * n_2, a_2 * n_1 - a_1 * n_2, f)
    z_1, z_2 = slid_1 - (d_1 * n_1 - d_2 * n_2), slid_2 - (d_1 * n_2 + d_2 * n_1)
    u_x, u_y = elongation(problem, frame, gone, z_1, z_2)
    force = f * problem.system.mass
    return fill(problem, frame, u_x, u_y, speed, n_1, n_2, force, samples, k)
