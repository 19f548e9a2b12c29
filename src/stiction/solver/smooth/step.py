"""One accepted step: prediction, collocation, error control."""

from __future__ import annotations

from math import inf, sqrt

import numpy as np

from stiction.solver.accuracy import Accuracy
from stiction.solver.compilation.jit import inlined
from stiction.solver.problem import Problem
from stiction.solver.smooth.coordinate import coordinate
from stiction.solver.smooth.error_estimate import local_error
from stiction.solver.smooth.newton import solve
from stiction.solver.smooth.right_hand_side import SmoothOutset
from stiction.solver.smooth.workspace import LAST, START, Workspace
from stiction.solver.stepping.block_algebra import Triple
from stiction.solver.stepping.control import ATTEMPTS, FAILED, RESOLUTION, step_factor
from stiction.solver.stepping.radau import C, cubic

HELD = 2.0  # of delta: slower slip follows the force
LANDINGS = 3  # tries to end a step where slip turns back
NEAR_REST = 0.1  # of the speed at either end: slip that turns back passes rest as closely as that
HALVINGS = 40  # until that place in the step is known
STUBBORN, SHORTENED = 0.5, 0.2  # an error not less than so much of the last one; size over size


@inlined
def predict(w: Workspace, q_x: float, q_y: float, x: float, warm: bool) -> tuple[Triple, Triple]:
    """Return a first guess of q at the stages, and write one of the states.

    The guess is the value at the start or, if the last step can predict, its cubic continued by `x`
    of its size. Where the slip would turn back, friction nearly stops it: there the guess is zero.
    """
    for k in range(2, w.size.shape[0]):
        for i in range(3):
            w.values[i + 1, k] = w.values[START, k]
            if warm:
                w.values[i + 1, k] = cubic(last(w, k), 1.0 + C[i] * x)
    if not warm:
        return (q_x, q_x, q_x), (q_y, q_y, q_y)
    a, b = continue_cubic(last(w, 0), x), continue_cubic(last(w, 1), x)
    k1, k2, k3 = (
        1.0 if a[0] * q_x + b[0] * q_y > 0.0 else 0.0,
        1.0 if a[1] * q_x + b[1] * q_y > 0.0 else 0.0,
        1.0 if a[2] * q_x + b[2] * q_y > 0.0 else 0.0,
    )
    return (k1 * a[0], k2 * a[1], k3 * a[2]), (k1 * b[0], k2 * b[1], k3 * b[2])


@inlined
def last(w: Workspace, k: int) -> tuple[float, float, float, float]:
    """Return a column at the start and the stages of the last step."""
    return w.past[0, k], w.past[1, k], w.past[2, k], w.past[3, k]


@inlined
def continue_cubic(values: tuple[float, float, float, float], x: float) -> Triple:
    """Return a cubic at the stages of the next step, `x` times as long."""
    a, b, c = 1.0 + C[0] * x, 1.0 + C[1] * x, 1.0 + C[2] * x
    return cubic(values, a), cubic(values, b), cubic(values, c)


@inlined
def remember(w: Workspace, past: np.ndarray, eps: float) -> None:
    """Write the slip coordinate and the states of the last step from its slip velocities."""
    for i in range(4):
        w.past[i, 0], w.past[i, 1] = coordinate(eps, past[i, 0], past[i, 1])
        for k in range(2, w.size.shape[0]):
            w.past[i, k] = past[i, k]


@inlined
def resting(w: Workspace, q_x: float, q_y: float) -> bool:
    """Return whether the slip at a step's start is so slow that a smoothed law holds the mass.

    There the slip follows the force. The remaining error of Newton's method is small beside the
    drive's speed, but not beside delta; extrapolated over a longer step it is a useless guess.
    """
    slowest = HELD * w.size[0]
    return bool(w.size.shape[0] == 2 and q_x * q_x + q_y * q_y < slowest * slowest)


@inlined
def turn_back(w: Workspace, accuracy: Accuracy) -> float:
    """Return the place in the step where slip turns back through rest; 1, its end, if nowhere.

    The rate of a state has a kink there, in |s|, and a step across it the error of a lower order.
    """
    v = w.values
    x0, x1, x2, x3 = v[START, 0], v[1, 0], v[2, 0], v[LAST, 0]
    y0, y1, y2, y3 = v[START, 1], v[1, 1], v[2, 1], v[LAST, 1]
    before, after = sqrt(x0 * x0 + y0 * y0), sqrt(x3 * x3 + y3 * y3)
    rest = accuracy.tolerance * (before + after + accuracy.speed)
    if w.size.shape[0] == 2 or before < rest or not x0 * x3 + y0 * y3 < -rest * before:
        return 1.0
    along = (
        x0 * x0 + y0 * y0,
        x0 * x1 + y0 * y1,
        x0 * x2 + y0 * y2,
        x0 * x3 + y0 * y3,
    )
    low, high = 0.0, 1.0
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        if cubic(along, middle) > 0.0:
            low = middle
        else:
            high = middle
    x, y = cubic((x0, x1, x2, x3), high), cubic((y0, y1, y2, y3), high)
    return high if sqrt(x * x + y * y) < NEAR_REST * max(before, after) else 1.0


@inlined
def step(
    problem: Problem,
    start: SmoothOutset,
    q_x: float,
    q_y: float,
    t_stop: float,
    h: float,
    h_last: float,
    warm: bool,
    w: Workspace,
    accuracy: Accuracy,
) -> tuple[bool, float, float, int, int]:
    """Take one step; return (done, h, error over tolerance, rejected, iterations)."""
    rejected = iterations = landings = 0
    before = inf
    for _ in range(ATTEMPTS):
        if h >= t_stop - start.t:
            h = t_stop - start.t
        elif not h > RESOLUTION * abs(start.t):
            break
        x, y = predict(w, q_x, q_y, h / h_last, warm)
        converged, count = solve(problem, start, h, x, y, w, accuracy)
        iterations += count
        factor = FAILED
        if converged:
            error = local_error(problem, start, h, w, accuracy) / accuracy.tolerance
            if error <= 1.0:
                factor = turn_back(w, accuracy) if landings < LANDINGS else 1.0
                if factor == 1.0:
                    return True, h, error, rejected, iterations
                landings += 1
            else:
                stubborn = error > STUBBORN * before
                factor = SHORTENED if stubborn else step_factor(error, 1.0)
                before = error
        elif warm and resting(w, q_x, q_y):
            warm, factor = False, 1.0
        rejected += 1
        h *= factor
    return False, h, 0.0, rejected, iterations
