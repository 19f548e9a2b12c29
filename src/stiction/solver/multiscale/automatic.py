"""The default method of `stiction.solver.integrate`: steps, and the return map where it pays.

Runs by `multiscale` cost more where little can be mapped: they take shorter steps, and solve cycles
for patches in vain. So a map is tried only where many cycles are left, and only until it has cost
a small share of the steps to be expected more than it has saved.

All of this is decided after numbers of steps and at rests, never where a caller pauses the run, nor
where there are samples: neither changes the motion.
"""

from __future__ import annotations

from math import floor, nan
from typing import NamedTuple

from stiction.solver.accuracy import Accuracy
from stiction.solver.exact.method import Exact
from stiction.solver.multiscale.method import Multiscale
from stiction.solver.multiscale.return_map import MAY_COST
from stiction.solver.problem import Problem, varies
from stiction.solver.state import RUNNING, Output, State
from stiction.system.slider import Slider

LOOK = 256  # turns of the first leg, (M58a); each next one is twice as long
CYCLES = 8  # sticks in a leg that make cycles, (M58a)
WORTH = 5_000.0  # steps to be expected still, (M58a): a patch costs some hundred
# Of all expected steps, which maps that do not pay may cost; one trial costs no more than the leg
# before it, (M58a)
LOSS = 0.03


class Leg(NamedTuple):
    """A part of a run in steps, after which the method decides on a map.

    turns : of the loop, its length; left : of these; start : the state at its start.
    """

    turns: int
    left: int
    start: State


class MapTrial(NamedTuple):
    """A map on trial.

    stake : steps that it may cost more than it saves; cycle : steps of a cycle without it; leg :
    turns of the leg before.
    """

    stake: int
    cycle: int
    leg: int


class Automatic(Multiscale):
    """Like `Exact`, but like `Multiscale` while many cycles remain and it saves steps."""

    def __init__(self, slider: Slider, rtol: float) -> None:
        """Store the slider and the tolerance."""
        super().__init__(slider, rtol)
        self.at: Leg | MapTrial | None = None  # what the run is at
        self.lost = 0  # steps, by maps that did not pay

    def enter_segment(self, state: State, x: float, y: float) -> State:
        """Return the state at the start of a segment, where the slip velocity jumps by (x, y)."""
        state = super().enter_segment(state, x, y)
        self.at = Leg(LOOK, LOOK, state)
        return state

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
        if self.at is None or varies(problem):
            return Exact.advance(self, problem, state, end, accuracy, budget, out)
        if isinstance(self.at, MapTrial):
            code, now = super().advance(problem, state, end, accuracy, budget, out)
            self.at = self.after_map(
                self.at, floor(self.map_of(problem, out).balance[MAY_COST]), now
            )
            return code, now
        self.compile_map(problem)
        used, turns = out.used, min(budget, self.at.left)
        code, now = Exact.advance(self, problem, state, end, accuracy, turns, out)
        self.at = self.at._replace(left=self.at.left - (out.used - used))
        if code == RUNNING and self.at.left <= 0:
            self.at = trial(self.at, now, end, self.lost) or next_leg(self.at.turns, now)
            if isinstance(self.at, MapTrial):
                known = self.map_of(problem, out)
                known.balance[:] = self.at.stake, self.at.cycle
                known.last[:] = nan  # the last take-off is not that of the cycle at hand
        return code, now

    def after_map(self, tried: MapTrial, left: int, now: State) -> Leg | MapTrial:
        """Choose the next leg, or keep the map until it has cost too much."""
        if left >= 0:
            return tried
        self.lost += tried.stake - left
        return next_leg(tried.leg, now)


def next_leg(turns: int, now: State) -> Leg:
    """Return the leg after a leg of so many turns."""
    return Leg(2 * turns, 2 * turns, now)


def trial(leg: Leg, now: State, end: float, lost: int) -> MapTrial | None:
    """Return the map to try after a leg (M58a), or None; `lost` steps are lost so far."""
    lasted, cycles = now.motion.t - leg.start.motion.t, now.counts.sticks - leg.start.counts.sticks
    if cycles < CYCLES:
        return None
    expected = leg.turns * (end - now.motion.t) / lasted
    stake = round(min(LOSS * expected - lost, leg.turns))
    if expected < WORTH or stake <= 0:
        return None
    return MapTrial(stake, round(leg.turns / cycles), leg.turns)
