"""What a law says at one point in time, and how that changes with the unknowns."""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

from stiction.solver.compilation.jit import piece
from stiction.solver.problem import Problem, at, in_principal_axes, rate, rate_change, travel
from stiction.solver.smooth.coordinate import slip_at, slip_slope
from stiction.solver.smooth.law import flow
from stiction.solver.smooth.workspace import START, TRIAL, Workspace
from stiction.solver.state import Accuracy
from stiction.solver.stick import holding

INCREMENT = 1.5e-8  # of a difference: the root of the rounding error
NOTICED = 0.01  # change of the friction coefficient by which the size of a state is judged


class Outset(NamedTuple):
    """A step's start: time (s), elongation (m), the speed eps of the slip coordinate (m/s) and
    the unit in which q counts, where it is smaller; by what errors are held against less than the
    slip speed, where the motion about steady sliding is slower."""

    t: float
    u_x: float
    u_y: float
    eps: float
    unit: float
    share: float


@piece
def prepare(problem: Problem, start: Outset, dt: float, w: Workspace, i: int) -> None:
    """Write what acts in row `i`, `dt` after the step's start, without slip."""
    d_x, d_y = in_principal_axes(problem, travel(problem.drive, start.t, dt))
    a_x, a_y = holding(problem, start.t + dt, start.u_x + d_x, start.u_y + d_y)
    w.pull[i, 0] = a_x
    w.pull[i, 1] = a_y
    w.weight[i] = at(problem.load, start.t + dt)


@piece
def evaluate(problem: Problem, eps: float, w: Workspace, i: int) -> None:
    """Write values and flow in row `i` from the unknowns there."""
    y, values = w.y, w.values
    s = slip_at(eps, y[i, 0], y[i, 1])
    values[i, 0] = s[0]
    values[i, 1] = s[1]
    for k in range(2, y.shape[1]):
        values[i, k] = y[i, k]
    flow(problem.law, s, w.weight[i], problem.system.per_mass, values, i, w.flow)


@piece
def linearise(problem: Problem, start: Outset, w: Workspace, i: int) -> None:
    """Write the derivatives of the flow in row `i` by the unknowns, by differences."""
    y, n = w.y, w.y.shape[1]
    w.weight[TRIAL] = w.weight[i]
    for k in range(n):
        y[TRIAL, k] = y[i, k]
    for k in range(n):
        unit = start.unit if k < 2 else w.size[k]
        y[TRIAL, k] = y[i, k] + INCREMENT * (unit + abs(y[i, k]))
        per = 1.0 / (y[TRIAL, k] - y[i, k])
        evaluate(problem, start.eps, w, TRIAL)
        for j in range(n):
            w.jacobian[i, j, k] = (w.flow[TRIAL, j] - w.flow[i, j]) * per
        y[TRIAL, k] = y[i, k]


@piece
def weigh(problem: Problem, start: Outset, h: float, a: float, w: Workspace, i: int) -> None:
    """Write which share of what resists a change of |q| in row `i` is inertia.

    `a` is the factor of the slip velocity in the equation of this row.
    """
    y, system, m = w.y, problem.system, w.jacobian
    square = y[i, 0] * y[i, 0] + y[i, 1] * y[i, 1]
    w.share[i] = 1.0
    if square == 0.0:
        return
    n_x, n_y = y[i, 0] / sqrt(square), y[i, 1] / sqrt(square)
    xx, xy, yy = slip_slope(start.eps, y[i, 0], y[i, 1])
    inertia = a * (n_x * n_x * xx + 2.0 * n_x * n_y * xy + n_y * n_y * yy)
    inertia *= 1.0 + h * (system.c_x * n_x * n_x + system.c_y * n_y * n_y) * system.per_mass
    friction = n_x * (m[i, 0, 0] * n_x + m[i, 0, 1] * n_y)
    friction += n_y * (m[i, 1, 0] * n_x + m[i, 1, 1] * n_y)
    w.share[i] = inertia / (inertia + max(h * friction, 0.0) + 1e-300)


@piece
def moving(problem: Problem, t: float, w: Workspace, accuracy: Accuracy) -> float:
    """Return how fast the system moves about steady sliding at a step's start, m/s.

    As `stiction.solver.exact.error_estimate.moving`; row `START` must be known with its flow.
    """
    system, (s_x, s_y) = problem.system, (w.values[START, 0], w.values[START, 1])
    v_x, v_y = in_principal_axes(problem, rate(problem.drive, t))
    g_x, g_y = in_principal_axes(problem, rate_change(problem.drive, t))
    by_x = g_x - (w.pull[START, 0] - system.c_x * s_x * system.per_mass - w.flow[START, 0])
    by_y = g_y - (w.pull[START, 1] - system.c_y * s_y * system.per_mass - w.flow[START, 1])
    x, y = v_x - s_x, v_y - s_y
    square = by_x * by_x * accuracy.square_x + by_y * by_y * accuracy.square_y
    return max(sqrt(x * x + y * y + square), accuracy.least)


@piece
def measure(problem: Problem, start: Outset, w: Workspace) -> None:
    """Write what errors of the internal states are held against.

    Each is relative to the state itself; near zero, to what changes the friction coefficient
    by `NOTICED`, or to 1 if that is less and the state has no unit.
    """
    n = w.y.shape[1]
    for k in range(2, n):
        w.size[k] = 1.0
    evaluate(problem, start.eps, w, START)
    linearise(problem, start, w, START)
    enough = NOTICED * w.weight[START] * problem.system.per_mass
    for k in range(2, n):
        x, y = w.jacobian[START, 0, k], w.jacobian[START, 1, k]
        effect = sqrt(x * x + y * y)
        least = enough / effect if effect > 0.0 else 1.0
        if problem.law.unitless[k]:
            least = min(1.0, least)
        w.size[k] = least + abs(w.y[START, k])
