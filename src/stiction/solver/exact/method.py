"""The solver for set-valued friction, as `stiction.solver.integrate` runs it."""

from __future__ import annotations

from math import nan, sqrt
from typing import Any

import numpy as np

from stiction.arrays import Floats
from stiction.solver.accuracy import Accuracy
from stiction.solver.compilation.jit import compiled
from stiction.solver.exact.loop import advance
from stiction.solver.exact.record import record_of
from stiction.solver.exact.sampling import COLUMNS
from stiction.solver.exact.slip_frame import friction
from stiction.solver.law import point_to
from stiction.solver.problem import Problem, at, call_for, is_aligned, isotropic
from stiction.solver.regularised import Smoothed, gradient_in_axes
from stiction.solver.rig import as_general
from stiction.solver.segments import begin, friction_of, surface_of, system_of
from stiction.solver.state import (
    COMPLETED,
    TOO_MANY_STICKS,
    Motion,
    Output,
    State,
    drop_memory,
    start,
    state_from_plain,
)
from stiction.solver.stepping.amplification import write_rates
from stiction.solver.stick import holding
from stiction.solver.surface import friction_along, metric_into, speed_ratio
from stiction.system.description import Description
from stiction.system.slider import Slider


class Exact:
    """Exact sticks, with slip between them integrated in turning axes."""

    columns = COLUMNS

    def __init__(self, slider: Slider) -> None:
        """Store the slider, and compile its law."""
        law, surface = friction_of(slider)[0], surface_of(slider)
        self.law, self.sliding = point_to(law), Smoothed(law, surface, 0.0)
        self.record = record_of(0)

    def begin(self, description: Description) -> State:
        """Return the initial state of a run."""
        slider, initial, _ = description
        return start(system_of(slider), initial.time, *begin(slider, initial))

    def enter_segment(self, state: State, x: float, y: float) -> State:
        """Return the state at the start of a segment, where the slip velocity jumps by (x, y).

        It drops the memory of earlier steps, which is useless after a bend.
        """
        memory = drop_memory(state.memory, min(state.memory.h, state.memory.plan[0]))
        m = state.motion
        if x == y == 0.0:
            return State(m, memory, state.counts)
        slip_x, slip_y = m.r * m.e_x + x, m.r * m.e_y + y
        r = sqrt(slip_x * slip_x + slip_y * slip_y)
        e = (slip_x / r, slip_y / r) if r > 0.0 else (m.e_x, m.e_y)
        return State(Motion(m.t, m.u_x, m.u_y, r, *e), memory, state.counts)

    def advance(
        self,
        problem: Problem,
        state: State,
        end: float,
        accuracy: Accuracy,
        budget: int,
        out: Output,
    ) -> tuple[int, State]:
        """Advance until `end` (s) or until the budget is used up."""
        pointed = self.point_law(problem)
        return advance_compiled(advance, pointed, state, end, accuracy, budget, out, self.record)

    def last_row(self, problem: Problem, state: State) -> list[float]:
        """Return the sample of a state between two steps."""
        motion = state.motion
        slip = [motion.r * motion.e_x, motion.r * motion.e_y]
        force = call_for(problem, force_between, self.point_law(problem), motion)
        return [motion.u_x, motion.u_y, *slip, *force, float(motion.r == 0.0)]

    def rates(self, problem: Problem, state: State) -> Floats:
        """Return the matrix of a small disturbance; see `amplification`.

        It is not a number where Python raises what compiled code does not: a user's law may divide
        by zero, or by what overflows.
        """
        m, rates = state.motion, np.zeros((4, 4))
        slip = m.r * m.e_x, m.r * m.e_y
        try:
            with np.errstate(all="ignore"):
                slopes = gradient_in_axes(self.sliding, problem, slip, at(problem.load, m.t))
        except (ArithmeticError, ValueError):
            slopes = np.full((2, 2), nan)
        write_rates(problem, slopes, rates)
        return rates

    def point_law(self, problem: Problem) -> Problem:
        """Return a problem for compiled code, with its law behind pointers.

        An elliptic surface is on a general rig there: the loop is compiled for two kinds of both
        instead of three.
        """
        pointed = problem._replace(law=self.law)
        if isotropic(problem.surface) or not is_aligned(problem.rig):
            return pointed
        return pointed._replace(rig=as_general(problem.system.cos_phi, problem.system.sin_phi))


@compiled
def force_between(problem: Problem, motion: Motion) -> tuple[float, float]:
    """Return the friction force (x, y; N) between two steps, during slip or stick."""
    m = problem.system.mass
    if motion.r == 0.0:
        a_x, a_y = holding(problem, motion.t, motion.u_x, motion.u_y)
        return m * a_x, m * a_y
    along = metric_into(problem, motion.e_x, motion.e_y)
    speed = motion.r * speed_ratio(problem, along, 0.0)
    f = m * friction(problem, motion.t, speed)[0]
    f_x, f_y = friction_along(problem, motion.e_x, motion.e_y)
    return f * f_x, f * f_y


def advance_compiled(
    function: Any,
    problem: Problem,
    state: State,
    end: float,
    accuracy: Accuracy,
    budget: int,
    out: Output,
    *more: Any,
) -> tuple[int, State]:
    """Call a compiled loop, and make room for more sticks."""
    times, samples, sticks = out.times, out.samples, out.sticks
    arguments = problem, state, end, accuracy, budget, times, samples, out.filled, sticks, *more
    code, now, out.filled, turns = call_for(problem, function, *arguments)
    state = state_from_plain(now)
    out.used += turns
    if code < COMPLETED and not out.make_room(state.counts.sticks):
        code = TOO_MANY_STICKS
    return code, state
