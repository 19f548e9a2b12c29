"""Newton's method for one step of slip."""

from __future__ import annotations

from stiction.arrays import TINY
from stiction.solver.accuracy import Accuracy
from stiction.solver.compilation.jit import inlined
from stiction.solver.exact.collocation import SlipStep, factors, stage
from stiction.solver.exact.oscillation import Oscillator, swing
from stiction.solver.exact.slip_frame import Frame
from stiction.solver.problem import Problem
from stiction.solver.stepping.block_algebra import solve_blocks
from stiction.solver.stepping.control import CONTRACTS, diverging, settled
from stiction.solver.stepping.radau import FIRST, SECOND, THIRD

ITERATIONS = 10
RUNAWAY = 1e10  # size of a correction


@inlined
def solve(
    problem: Problem,
    frame: Frame,
    o: Oscillator,
    step: SlipStep,
    landing: bool,
    accuracy: Accuracy,
    motion: float,
) -> tuple[bool, SlipStep, int]:
    """Solve the collocation equations of one step.

    Parameters
    ----------
    problem, frame, o
        The system, the step's axes, and the oscillation along the slip.
    step : SlipStep
        With a first guess of the stages.
    landing : bool
        Whether the step ends at zero slip; its size is then an unknown, too.
    accuracy : Accuracy
        Corrections are relative to the slip speed plus ``accuracy.speed``, and for w to 1.
    motion : float
        Motion about steady sliding, m/s; the scale of corrections if it is smaller.

    Returns
    -------
    converged, step, iterations

    Notes
    -----
    The first Jacobian is exact, except for a changing load in a landing, and kept while the
    iteration contracts. One exact iteration squares the relative error; hence the test on the
    square of the first correction: (M32) and (M33).
    """
    s, h, p, w = step
    s0 = stage(problem, frame, step, FIRST)
    s1 = stage(problem, frame, step, SECOND)
    s2 = stage(problem, frame, step, THIRD)
    m = factors(frame, step, landing, s0, s1, s2)
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
            size = abs(dp[2]) / (abs(h) + TINY)
        else:
            p = (p[0] - dp[0], p[1] - dp[1], p[2] - dp[2])
            size = abs(dp[2]) / (speed + abs(p[2]))
        size = max(size, abs(dp[0]) / (speed + abs(p[0])), abs(dp[1]) / (speed + abs(p[1])))
        size = max(size, abs(dw[0]), abs(dw[1]), abs(dw[2]))
        step = SlipStep(s, h, p, w)
        if not size < RUNAWAY or h <= 0.0:
            return False, step, iteration
        rate = size if iteration == 1 else size / last
        if settled(size, rate, enough):
            return True, step, iteration
        if diverging(iteration, rate):
            return False, step, iteration
        s0 = stage(problem, frame, step, FIRST)
        s1 = stage(problem, frame, step, SECOND)
        s2 = stage(problem, frame, step, THIRD)
        if rate > CONTRACTS:
            m = factors(frame, step, landing, s0, s1, s2)
        last = size
    return False, step, ITERATIONS
