"""How fast the system moves about steady sliding, to which the tolerance is relative.

A vibration of a micrometre while the drive slides at a metre per second is small beside that, and
all that there is to see. While it slides steadily the springs keep their length: what they do
beside that is the motion.
"""

from __future__ import annotations

from math import sqrt

from stiction.solver.compiled import inlined
from stiction.solver.frame import Frame, Outset
from stiction.solver.problem import Problem, in_principal_axes, rate, rate_change
from stiction.solver.state import Accuracy


@inlined
def moving(problem: Problem, frame: Frame, start: Outset, accuracy: Accuracy) -> float:
    """Return the speed of the springs' ends against each other at a step's start (M42), m/s.

    Of an oscillation, its amplitude: the elongation rate u', and u'' times what each spring takes
    for a radian. No less than what rounding leaves of it.
    """
    r, e_x, e_y = frame.r, frame.e_x, frame.e_y
    v_x, v_y = in_principal_axes(problem, rate(problem.drive, frame.t))
    g_x, g_y = in_principal_axes(problem, rate_change(problem.drive, frame.t))
    s_1, s_2 = start.a_1 - start.f, start.a_2 - start.turn
    x, y = v_x - r * e_x, v_y - r * e_y
    by_x, by_y = g_x - s_1 * e_x + s_2 * e_y, g_y - s_1 * e_y - s_2 * e_x
    square = by_x * by_x * accuracy.square_x + by_y * by_y * accuracy.square_y
    return max(sqrt(x * x + y * y + square), accuracy.least)
