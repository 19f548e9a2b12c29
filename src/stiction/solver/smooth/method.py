"""The solver for smooth friction, as `stiction.solver.integrate` runs it."""

from __future__ import annotations

from math import isfinite
from typing import Any

import numpy as np

from stiction.friction import states
from stiction.solver.compilation.interrupt import uninterrupted
from stiction.solver.exact.sampling import COLUMNS
from stiction.solver.output import Output
from stiction.solver.problem import Isotropic, Problem, at, force
from stiction.solver.segments import friction_of
from stiction.solver.smooth import loop
from stiction.solver.smooth.dispatch import SMOOTHED, pointed
from stiction.solver.smooth.state import Memory, Motion, State
from stiction.solver.state import NOTHING, Accuracy, first_step
from stiction.system.description import Description
from stiction.system.slider import Slider

# of the slip speed below which that of set-valued friction is not resolved: states remember slower
# slip. LuGre's published case comes out 600 times better for 14 % more steps.
FINER = 0.03


class Smooth:
    """A law with internal state, or a set-valued one made smooth over `delta` (m/s)."""

    def __init__(self, slider: Slider, delta: float | None, smoothing: str = "root") -> None:
        """Take the slider, and have its law compiled."""
        law, surface = friction_of(slider)
        self.first_step = 0.0
        self.states = len(states(law))
        self.law: Any = law if delta is None else SMOOTHED[smoothing](law, surface, delta)
        self.flow = pointed(self.law)
        self.columns = COLUMNS + self.states

    def begin(self, description: Description) -> State:
        """Return the state from which a run starts."""
        slider, initial, _ = description
        motion = Motion(initial.time, initial.u_x, initial.u_y, *initial.slip(slider))
        internal = np.array(initial.internal(slider), dtype=np.float64)
        h = self.first_step = first_step(slider)
        memory = Memory(h, h, False, np.zeros((4, 2 + self.states)))
        return State(motion, internal, memory, NOTHING)

    def entered(self, state: State, x: float, y: float) -> State:
        """Return the state at the start of a stretch, where the slip velocity jumps by (x, y)."""
        m = state.motion
        motion = m._replace(s_x=m.s_x + x, s_y=m.s_y + y)
        # in a hold steps become as long as the whole of what follows
        memory = state.memory._replace(warm=False, h=min(state.memory.h, self.first_step))
        return state._replace(motion=motion, memory=memory)

    def advance(
        self, problem: Problem, state: State, end: float, held: Accuracy, budget: int, out: Output
    ) -> tuple[int, State]:
        """Advance until `end` (s) or until the budget is used up."""
        smooth = problem._replace(law=self.flow, surface=Isotropic())  # the law knows its surface
        resolved = self.resolved(held)
        times, samples = out.times, out.samples
        with uninterrupted():  # the state comes back as named tuples and arrays
            code, state, out.filled, turns = loop.advance(
                smooth, state, end, resolved, budget, times, samples, out.filled
            )
        out.used += turns
        return code, state

    def last_row(self, problem: Problem, state: State) -> list[float]:
        """Return the sample of a state between two steps."""
        t, u_x, u_y, s_x, s_y = state.motion
        z = tuple(float(value) for value in state.internal)
        f = force(self.law, (s_x, s_y), at(problem.load, t), z)
        return [u_x, u_y, s_x, s_y, *f, 0.0, *z]

    def resolved(self, held: Accuracy) -> Accuracy:
        """Return what each step is held to.

        Under vibration what creeps is far slower than what the drive does: then the slip speed
        that friction by itself could give counts, as without a drive.
        """
        speed = FINER * held.speed if self.states else held.speed
        if isfinite(held.longest):
            speed = min(speed, 1e-6 * min(held.free_x, held.free_y))
        return held._replace(speed=speed)
