"""Integration of a description to samples and stick intervals, by the appropriate solver."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple, Protocol

import numpy as np

from stiction.arrays import Floats
from stiction.drive import jump
from stiction.friction import has_state
from stiction.solver.accuracy import Accuracy, accuracy, scales_of
from stiction.solver.exact.method import Exact
from stiction.solver.multiscale.automatic import Automatic
from stiction.solver.multiscale.method import Multiscale
from stiction.solver.problem import Problem, varies
from stiction.solver.segments import (
    Segment,
    rig_of,
    segments,
)
from stiction.solver.smooth.method import Smooth
from stiction.solver.state import (
    ASKS,
    COMPLETED,
    CONTACT_LOST,
    RUNNING,
    TOO_MANY_STEPS,
    Counts,
    Output,
)
from stiction.solver.stepping.amplification import longest_step
from stiction.solver.stepping.limit import Time, known_up_to
from stiction.system.description import Description
from stiction.system.slider import Slider
from stiction.system.tensors import solver_axes

BUDGET = 100_000  # turns of the loop between two progress reports: some 30 ms
BLOCK = 5_000  # turns between two blocks of samples that are not kept: some MB at 60 a turn


class Solution(NamedTuple):
    """The end of an integration (an index into `Status`), its results and its cost.

    `times` (n,) are those reached, `samples` (n, 7 or more) as in `stiction.solver.exact.sampling`
    with the internal states after them, `sticks` (m, 2) in s.
    """

    code: int
    times: np.ndarray
    samples: np.ndarray
    sticks: np.ndarray
    counts: Counts


Report = Callable[[float], None]
Room = Callable[[tuple[int, int]], np.ndarray]  # makes an array of a shape, of any content


class Method(Protocol):
    """The interface of solvers; `columns` is the length of a sample's row.

    Each solver has its own type of state, which must have ``motion.t``, ``counts``, and in its
    ``memory`` the size of the next step ``h``, and the ``limit`` of steps about steady sliding.
    """

    columns: int

    def begin(self, description: Description) -> Any:
        """Return the initial state of a run."""

    def enter_segment(self, state: Any, x: float, y: float) -> Any:
        """Return the state at the start of a segment, where the slip velocity jumps by (x, y)."""

    def advance(
        self, problem: Problem, state: Any, end: float, accuracy: Accuracy, budget: int, out: Output
    ) -> tuple[int, Any]:
        """Advance until `end` (s) or until the budget is used up; return a code and the state."""

    def last_row(self, problem: Problem, state: Any) -> list[float]:
        """Return the sample of a state between two steps."""

    def rates(self, problem: Problem, state: Any) -> Floats:
        """Return the matrix of a small disturbance; see `stepping.amplification`.

        It is asked for of the state at which `advance` has just returned `ASKS`.
        """


def is_smooth(description: Description) -> bool:
    """Return whether friction is smooth: its law has states, or is regularised."""
    return description.run.regularisation is not None or has_state(description.slider.law)


def method_of(description: Description) -> Method:
    """Return the solver for a description."""
    slider, run = description.slider, description.run
    if is_smooth(description):
        return Smooth(slider, run.regularisation, run.smoothing)
    if run.multiscale == "auto":
        return Automatic(slider, run.rtol)
    return Multiscale(slider, run.rtol) if run.multiscale else Exact(slider)


def integrate(
    description: Description,
    times: np.ndarray,
    max_steps: int,
    progress: Report | None,
    take: Callable[[np.ndarray], None] | None = None,
    inside: float = 0.0,
    pause: int = BUDGET,
    room: Room = np.empty,
) -> Solution:
    """Integrate a description, filling in the samples at `times` (ascending, s).

    If `take` is given, it gets the samples block by block, to be used before it returns: they are
    not kept, and the memory that they take does not grow with their number in steps. All cycles
    that a return map finds at once are in one block. `inside` is the relative error of the slip
    that samples inside steps may have; if that is no less than the steps' `tolerance`, they take a
    sixth of the time. `progress` is told the share of the time that is done, after at most `pause`
    turns of the loop. `room` makes the array in which the samples are returned.
    """
    slider, initial, settings = description
    t, end = initial.time, initial.time + settings.duration
    method = method_of(description)
    state = method.begin(description)
    times = np.asarray(times, dtype=np.float64)
    times = times if times.flags.carray else times.copy()  # compiled code takes no other array
    out = Output(times, room((len(times), method.columns)), np.empty((4096, 2)))
    code, segment, scales = COMPLETED, None, scales_of(slider, initial)

    def report(t: float) -> None:
        if progress is not None:
            progress((t - initial.time) / settings.duration)

    for segment in segments(slider, t, end):
        state = method.enter_segment(state, *slip_jump(slider, t))
        tolerances = accuracy(slider, scales, segment, t, settings.rtol, inside)
        code = RUNNING
        while code == RUNNING:
            budget = min(pause if take is None else BLOCK, max_steps - out.used)
            if budget <= 0:
                code = TOO_MANY_STEPS
                break
            code, state = method.advance(
                segment.problem, state, segment.end, tolerances, budget, out
            )
            if code == ASKS:
                code, state = RUNNING, knowing_growth(method, segment, state)
            if take is not None:
                take(outward(slider, out.samples[: out.filled]))
                out.times, out.filled = out.times[out.filled :], 0
            report(state.motion.t)
        t = segment.end
        if code == COMPLETED and segment.lost:
            code = CONTACT_LOST
        if code != COMPLETED:
            break
    assert segment is not None
    k, counts = out.filled, Counts(*state.counts)
    times, samples = times[:k], out.samples[:k]
    if code != COMPLETED:  # always keep the state where it stopped
        earlier = times < state.motion.t
        times = np.append(times[earlier], state.motion.t)
        samples = np.vstack([samples[earlier], method.last_row(segment.problem, state)])
    samples = outward(slider, samples)
    return Solution(code, times, samples, out.sticks[: counts.sticks].copy(), counts)


def knowing_growth(method: Method, segment: Segment, state: Any) -> Any:
    """Return a state that knows the longest step that shows growth about steady sliding."""
    left, memory = segment.end - state.motion.t, state.memory
    rates, enough = method.rates(segment.problem, state), memory.limit[1]
    longest = longest_step(rates, memory.h, left / enough)
    known = known_up_to(memory.h, Time(state.motion.t, left, varies(segment.problem)))
    return state._replace(memory=memory._replace(limit=(longest, known)))


def outward(slider: Slider, samples: np.ndarray) -> np.ndarray:
    """Return samples in the axes x and y, from those of the solver."""
    if slider.aligned:
        return samples
    axes, turned = solver_axes(slider), samples.copy()
    turned[:, 0:2] = axes.outward(samples[:, 0:2])
    turned[:, 2:4] = axes.outward(samples[:, 2:4])
    turned[:, 4:6] = axes.force_outward(samples[:, 4:6])
    return turned


def slip_jump(slider: Slider, t: float) -> tuple[float, float]:
    """Return the jump of the slip velocity (x, y) with the drive's at time `t`, in m/s.

    The mass keeps its velocity: the slip velocity jumps with that of a driven plate, but not over a
    plate at rest.
    """
    if slider.driven != "plate":
        return 0.0, 0.0
    X, Y = jump(slider.motion, t)
    return rig_of(slider).into_axes(*slider.direction, (X, Y))
