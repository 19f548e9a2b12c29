"""The multiscale solver, as `stiction.solver.integrate` runs it."""

from __future__ import annotations

from collections.abc import Callable
from math import inf, nan
from typing import Any

import numpy as np

from stiction.solver.accuracy import Accuracy
from stiction.solver.compilation.ahead import compile_beside, is_compiled
from stiction.solver.compilation.jit import INTERPRETED
from stiction.solver.compilation.pointer import typeof
from stiction.solver.exact.loop import advance
from stiction.solver.exact.method import Exact, advance_compiled
from stiction.solver.multiscale.loop import stride
from stiction.solver.multiscale.return_map import STEP_SHARE, Returns, empty_map
from stiction.solver.multiscale.steps import address_of_steps, kinds_of_steps
from stiction.solver.problem import Problem, kinds_of, varies
from stiction.solver.state import Output, State
from stiction.system.description import Description
from stiction.system.slider import Slider

_met: set[tuple[Any, ...]] = set()
_compiled_beside: dict[tuple[Any, ...], Callable[[], object]] = {}


class Multiscale(Exact):
    """Like `Exact`, but with many cycles at once where the return map is smooth."""

    def __init__(self, slider: Slider, rtol: float) -> None:
        """Store the slider and the tolerance."""
        super().__init__(slider)
        self.rtol = rtol
        self.span = -inf, inf  # s; start and end of the run
        self.problem: Problem | None = None
        self.known: Returns | None = None

    def begin(self, description: Description) -> State:
        """Return the initial state of a run."""
        start = description.initial.time
        self.span = start, start + description.run.duration
        return super().begin(description)

    def enter_segment(self, state: State, x: float, y: float) -> State:
        """Return the state at the start of a segment, where the slip velocity jumps by (x, y)."""
        if self.known is not None:
            self.known.last[:] = nan
        return super().enter_segment(state, x, y)

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
        if varies(problem):  # else one map holds for all cycles
            return super().advance(problem, state, end, accuracy, budget, out)
        self.compile_map(problem)
        known = self.map_of(problem, out)
        wait = _compiled_beside.pop(kinds_of(problem), None)
        if wait is not None:
            wait()
        fine = accuracy._replace(
            tolerance=STEP_SHARE * accuracy.tolerance,
            newton=STEP_SHARE * accuracy.newton,
            least=accuracy.least / STEP_SHARE,
            touch=0.0,  # cycles are counted from one stick to the next, however short
        )
        return advance_compiled(
            stride, self.point_law(problem), state, end, fine, budget, out, known
        )

    def compile_map(self, problem: Problem) -> None:
        """Begin to compile the map beside the steps, if neither has been compiled yet."""
        kinds = kinds_of(problem)
        if INTERPRETED or kinds in _met:
            return
        _met.add(kinds)
        pointed = self.point_law(problem)
        steps_kinds = kinds_of_steps(pointed)
        map_kinds = *steps_kinds[:-1], typeof(empty_map(self.rtol, 0))
        if not is_compiled(advance, steps_kinds) and not is_compiled(stride, map_kinds):
            _compiled_beside[kinds] = compile_beside(stride, map_kinds)

    def map_of(self, problem: Problem, out: Output) -> Returns:
        """Return the known part of a problem's map."""
        if self.known is None or problem != self.problem:
            first = int(np.searchsorted(out.times, self.span[0], "right"))
            inside = first < len(out.times) and out.times[first] < self.span[1]
            steps = address_of_steps(self.point_law(problem))
            self.problem, self.known = problem, empty_map(self.rtol, steps, bool(inside))
        return self.known
