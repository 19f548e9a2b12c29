"""The solver for smooth friction, as `stiction.solver.integrate` runs it."""

from __future__ import annotations

from math import isfinite
from typing import Any

import numpy as np

from stiction.arrays import Floats
from stiction.friction import states
from stiction.solver.accuracy import SLOW, Accuracy
from stiction.solver.exact.sampling import COLUMNS
from stiction.solver.problem import Isotropic, Problem, at, call_for, force, is_aligned
from stiction.solver.regularised import SMOOTHED
from stiction.solver.rig import as_general
from stiction.solver.segments import begin, friction_of, surface_of, system_of
from stiction.solver.smooth import loop
from stiction.solver.smooth.dispatch import point_to_smooth_law
from stiction.solver.smooth.state import (
    SmoothMemory,
    SmoothMotion,
    SmoothState,
    copy_of,
    with_numbers,
)
from stiction.solver.smooth.workspace import workspace
from stiction.solver.state import NOTHING, Output, first_step
from stiction.solver.stepping.limit import NO_LIMIT
from stiction.system.description import Description
from stiction.system.slider import Slider

# of the slip speed below which that of set-valued friction is not resolved: rate and state is three
# times as accurate for a tenth more steps
SPEED_SHARE = 0.03


class Smooth:
    """A law with internal state, or a set-valued one made smooth over `delta` (m/s)."""

    def __init__(self, slider: Slider, delta: float | None, smoothing: str = "root") -> None:
        """Store the slider, and compile its law."""
        law, surface = friction_of(slider)[0], surface_of(slider)  # asked in the axes x and y
        self.first_step = first_step(system_of(slider))
        self.states = len(states(law))
        self.law: Any = law if delta is None else SMOOTHED[smoothing](law, surface, delta)
        self.pointed = point_to_smooth_law(self.law)
        self.columns = COLUMNS + self.states
        self.rooms = workspace(self.states), workspace(self.states)

    def begin(self, description: Description) -> SmoothState:
        """Return the initial state of a run."""
        slider, initial, _ = description
        u, slip = begin(slider, initial)
        motion = SmoothMotion(initial.time, *u, *slip)
        internal = np.array(initial.internal(slider), dtype=np.float64)
        h = self.first_step
        memory = SmoothMemory(h, h, 1.0, False, np.zeros((4, 2 + self.states)), NO_LIMIT)
        return SmoothState(motion, internal, memory, NOTHING)

    def enter_segment(self, state: SmoothState, x: float, y: float) -> SmoothState:
        """Return the state at the start of a segment, where the slip velocity jumps by (x, y)."""
        (t, u_x, u_y, s_x, s_y), internal, (h, h_last, ease, _, past, _), counts = state
        motion = SmoothMotion(t, u_x, u_y, s_x + x, s_y + y)
        # in a hold a step may become as long as the rest of the run
        memory = SmoothMemory(min(h, self.first_step), h_last, ease, False, past, NO_LIMIT)
        return SmoothState(motion, internal, memory, counts)

    def advance(
        self,
        problem: Problem,
        state: SmoothState,
        end: float,
        accuracy: Accuracy,
        budget: int,
        out: Output,
    ) -> tuple[int, SmoothState]:
        """Advance until `end` (s) or until the budget is used up."""
        smooth = self.point_law(problem)
        resolved = self.step_accuracy(accuracy)
        times, samples = out.times, out.samples
        own = copy_of(state)
        arguments = smooth, own, end, resolved, budget, times, samples, out.filled, *self.rooms
        code, now, out.filled, turns = call_for(smooth, loop.advance, *arguments)
        out.used += turns
        return code, with_numbers(own, now)

    def last_row(self, problem: Problem, state: SmoothState) -> list[float]:
        """Return the sample of a state between two steps."""
        t, u_x, u_y, s_x, s_y = state.motion
        z = tuple(float(value) for value in state.internal)
        slip = problem.rig.outward((s_x, s_y))
        f = problem.rig.inward(force(self.law, slip, at(problem.load, t), z))
        return [u_x, u_y, s_x, s_y, *f, 0.0, *z]

    def rates(self, problem: Problem, state: SmoothState) -> Floats:
        """Return the matrix of a small disturbance, which the loop wrote before it paused."""
        return self.rooms[0].rates

    def point_law(self, problem: Problem) -> Problem:
        """Return a problem for compiled code, with its law behind pointers.

        The law knows its surface. Every rig is a general one there, so that the loop is compiled
        for half as many types: an aligned one has products by one and by zero, which are exact.
        """
        rig = problem.rig
        if is_aligned(rig):
            rig = as_general(problem.system.cos_phi, problem.system.sin_phi)
        return problem._replace(law=self.pointed, surface=Isotropic(), rig=rig)

    def step_accuracy(self, accuracy: Accuracy) -> Accuracy:
        """Return the tolerances of each step.

        Under vibration creep is far slower than the drive: then the slip speed that friction by
        itself could cause sets the scale, as without a drive.
        """
        speed = SPEED_SHARE * accuracy.speed if self.states else accuracy.speed
        if isfinite(accuracy.longest):
            speed = min(speed, SLOW * min(accuracy.free_x, accuracy.free_y))
        return accuracy._replace(speed=speed)
