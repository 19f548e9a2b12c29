"""Newton's method for one step of slip."""

from __future__ import annotations

from stiction.solver.compilation.jit import inlined
from stiction.solver.exact.collocation import factors, stage
from stiction.solver.exact.oscillation import Oscillator, Swing, swing
from stiction.solver.exact.slip_frame import Frame
from stiction.solver.problem import Problem
from stiction.solver.state import Accuracy
from stiction.solver.stepping.block_algebra import Triple, solve_blocks
from stiction.solver.stepping.control import CONTRACTS, diverging, settled
from stiction.solver.stepping.radau import FIRST, SECOND, THIRD

ITERATIONS = 10


@inlined
def solve(
    problem: Problem,
    frame: Frame,
    o: Oscillator,
    s: Swing,
    h: float,
    landing: bool,
    p: Triple,
    w: Triple,
    accuracy: Accuracy,
    motion: float,
) -> tuple[bool, Swing, Triple, Triple, float, int]:
    """Solve the collocation equations of one step.

    Parameters
    ----------
    problem, frame, o, s, h
        The system, the step's axes, the oscillation along the slip, and the step's size (s).
    landing : bool
        Whether the step ends at zero slip; its size is then an unknown, with `h` as first guess.
    p, w : triple of float
        First guess of the stages (m/s, 1).
    accuracy : Accuracy
        Corrections are relative to the slip speed plus ``accuracy.speed``, and for w to 1.
    motion : float
        Motion about steady sliding, m/s; the scale of corrections if it is smaller.

    Returns
    -------
    converged, p, w, h, iterations

    Notes
    -----
    The first Jacobian is exact, except for a changing load in a landing, and kept while the
    iteration contracts. One exact iteration squares the relative error; hence the test on the
    square of the first correction: (M32) and (M33).
    """
    s0 = stage(problem, frame, s, h, FIRST, p, w, products(p, w))
    s1 = stage(problem, frame, s, h, SECOND, p, w, products(p, w))
    s2 = stage(problem, frame, s, h, THIRD, p, w, products(p, w))
    m = factors(frame, s, h, landing, p, w, s0, s1, s2)
    speed = accuracy.speed
    enough = accuracy.newton * min(1.0, motion / (speed + frame.r))
    last = 1.0
    for iteration in range(1, ITERATIONS + 1):
        dp, dw = solve_blocks(
            m,
            (s0.residual_p, s1.residual_p, s2.residual_p),
            (s0.residual_w, s1.residual_w, s2.residual_w),
        )
        w = (w[0] - dw[0], w[1] - dw[1], w[2] - dw[2])
        if landing:
            h -= dp[2]
            s = swing(o, h, landing)
            p = (p[0] - dp[0], p[1] - dp[1], 0.0)
            size = abs(dp[2]) / (abs(h) + 1e-300)
        else:
            p = (p[0] - dp[0], p[1] - dp[1], p[2] - dp[2])
            size = abs(dp[2]) / (speed + abs(p[2]))
        size = max(size, abs(dp[0]) / (speed + abs(p[0])), abs(dp[1]) / (speed + abs(p[1])))
        size = max(size, abs(dw[0]), abs(dw[1]), abs(dw[2]))
        if not size < 1e10 or h <= 0.0:
            return False, s, p, w, h, iteration
        rate = size if iteration == 1 else size / last
        if settled(size, rate, enough):
            return True, s, p, w, h, iteration
        if diverging(iteration, rate):
            return False, s, p, w, h, iteration
        s0 = stage(problem, frame, s, h, FIRST, p, w, products(p, w))
        s1 = stage(problem, frame, s, h, SECOND, p, w, products(p, w))
        s2 = stage(problem, frame, s, h, THIRD, p, w, products(p, w))
        if rate > CONTRACTS:
            m = factors(frame, s, h, landing, p, w, s0, s1, s2)
        last = size
    return False, s, p, w, h, ITERATIONS


@inlined
def products(p: Triple, w: Triple) -> Triple:
    """Return p w: the slip velocity across the step's axis."""
    return p[0] * w[0], p[1] * w[1], p[2] * w[2]
