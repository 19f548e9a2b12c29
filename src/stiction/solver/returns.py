"""The return map: from the end of a stick to the end of the next.

While drive and load are steady, the state at the end of a stick is one angle (see `takeoff`),
so that all that follows, until the end of the next stick, is a function of it. Where that
function is smooth, polynomials through a few cycles, each solved in full, stand for all the
others between. Where it is not, or a cycle is too long to be solved so often, as a macroscopic
slip is, a cycle that begins where an earlier one did ends as that one did.

Nodes are Leja points and polynomials Newton's: each further node is at the same time a fresh
cycle, which tests the polynomial so far, about where it is worst; and none is in vain.

Such stroboscopic maps are what multirevolution and envelope-following methods step over
(Petzold 1981; Calvo, Jay, Montijano & Randez 2004). Theirs have fast components beside the
slow ones; here each stick wipes those out, and the map is exact.
"""

from __future__ import annotations

from math import inf, nan, sqrt
from typing import Any, NamedTuple

import numpy as np

from stiction.solver import loop
from stiction.solver.compiled import inlined, piece
from stiction.solver.problem import Problem, in_principal_axes, rate
from stiction.solver.state import (
    NOTHING,
    RUNNING,
    Accuracy,
    Counts,
    Memory,
    Motion,
    State,
    at_takeoff,
)
from stiction.solver.stick import stick_duration
from stiction.solver.takeoff import angle, elongation_held, lead, wrapped

WIDEST = 1.0  # rad, of a patch
NODES = 24  # of a patch at most
PATCHES = 256
PAST = 256  # cycles remembered
CLOSING = 0.03  # relative error of a patch's turn and time, over rtol: they add up
NEAR = 10.0  # over this: what a cycle that is remembered may differ by, and times of landing
FAR = 4.0  # a node whose cycle takes so many times what those before took is beyond an edge
NODE_STEPS = 10_000
FINER = 0.1  # tolerance of a node's steps over that of others: their noise is below what closes

_loop: Any = loop.advance
# as a part of what calls it, so that a user's own law is kept with that alone
advance = piece(_loop.py_func)


def leja(count: int) -> np.ndarray:
    """Return points on [-1, 1], each where the product of distances to those before is largest."""
    grid = np.cos(np.linspace(np.pi, 0.0, 2001))
    points = [-1.0, 1.0]
    while len(points) < count:
        distances = np.prod([np.abs(grid - point) for point in points], axis=0)
        points.append(float(grid[distances.argmax()]))
    return np.array(points)


POINTS = leja(NODES)


class Cycle(NamedTuple):
    """From the end of a stick to that of the next: turn of the angle, time, time to landing (s)."""

    turn: float
    time: float
    landing: float


class Returns(NamedTuple):
    """What is known of the map.

    patches : angle where each starts, 2 over what it reaches over, and the number of its nodes;
    coefficients : of their polynomials for turn, time and landing; edges : angles beyond which
    there is no return; past : angle, turn, time and landing of cycles; width : of patches to
    try; sizes : of patches, edges and past, nodes in vain, cycles solved; last : angle and time (s)
    of the last take-off; closing : relative error.
    """

    patches: np.ndarray
    coefficients: np.ndarray
    edges: np.ndarray
    past: np.ndarray
    width: np.ndarray
    sizes: np.ndarray
    last: np.ndarray
    closing: float


def unknown(rtol: float) -> Returns:
    """Return that nothing is known yet."""
    return Returns(
        np.empty((PATCHES, 3)),
        np.empty((PATCHES, NODES, 3)),
        np.empty(PATCHES),
        np.empty((PAST, 4)),
        np.array([WIDEST]),
        np.zeros(5, dtype=np.int64),
        np.array([nan, nan]),
        CLOSING * rtol,
    )


@inlined
def added(a: Counts, b: Counts) -> Counts:
    """Return the counts with another's steps, but not its stick intervals."""
    return Counts(
        a.steps + b.steps,
        a.rejected + b.rejected,
        a.iterations + b.iterations,
        a.sticks,
        a.stuck,
        a.mapped,
    )


@inlined
def interpolated(coefficients: np.ndarray, n: int, x: float) -> Cycle:
    """Return the polynomials through the first `n` nodes."""
    turn = time = landing = 0.0
    for i in range(n - 1, -1, -1):
        d = x - POINTS[i]
        turn = turn * d + coefficients[i, 0]
        time = time * d + coefficients[i, 1]
        landing = landing * d + coefficients[i, 2]
    return Cycle(turn, time, landing)


@inlined
def place(known: Returns, theta: float, last: int) -> tuple[int, float]:
    """Return the row of a patch with an angle, -1 if there is none, and where in it, -1 to 1.

    That of the cycle before is looked at first.
    """
    for i in range(-1 if last >= 0 else 0, known.sizes[0]):
        row = last if i < 0 else i
        x = (theta - known.patches[row, 0]) * known.patches[row, 1] - 1.0
        if -1.0 <= x <= 1.0:
            return row, x
    return -1, 0.0


@inlined
def remember(known: Returns, theta: float, cycle: Cycle) -> None:
    """Keep a cycle that was solved, in the place of the oldest."""
    row = known.past[known.sizes[2] % PAST]
    row[0], row[1], row[2], row[3] = theta, cycle.turn, cycle.time, cycle.landing
    known.sizes[2] += 1


@inlined
def remembered(known: Returns, theta: float, last: Cycle) -> tuple[bool, Cycle]:
    """Return the cycle from an angle by the two nearest that were solved.

    On a line through both. It counts if that differs so little from the nearest that the line
    does not matter, or from what the nearest would be if it began earlier or later on the way
    there, which `last` has shown: it would end where it does, and the time add up.
    """
    i = j = -1
    near = next_near = inf
    for row in range(min(known.sizes[2], PAST)):
        distance = abs(known.past[row, 0] - theta)
        if distance < near:
            i, j, near, next_near = row, i, distance, near
        elif distance < next_near:
            j, next_near = row, distance
    if j < 0 or known.past[i, 0] == known.past[j, 0]:
        return False, last
    a, b = known.past[i], known.past[j]
    off = theta - a[0]
    per = off / (b[0] - a[0])
    cycle = Cycle((b[1] - a[1]) * per, (b[2] - a[2]) * per, (b[3] - a[3]) * per)
    later = off * last.time / last.turn
    bound = NEAR * known.closing
    close = (
        min(abs(cycle.turn), abs(cycle.turn + off)) <= bound * abs(a[1])
        and min(abs(cycle.time), abs(cycle.time + later)) <= bound * a[2]
        and min(abs(cycle.landing), abs(cycle.landing + later)) <= bound * a[2]
    )
    return close, Cycle(a[1] + cycle.turn, a[2] + cycle.time, a[3] + cycle.landing)


@inlined
def finer(accuracy: Accuracy) -> Accuracy:
    """Return what the steps of a node's cycle are held to."""
    tolerance, newton = FINER * accuracy.tolerance, FINER * accuracy.newton
    _, _, speed, free_x, free_y, longest, drive = accuracy
    return Accuracy(tolerance, newton, speed, free_x, free_y, longest, drive)


@inlined
def solved(
    problem: Problem, accuracy: Accuracy, memory: Memory, theta: float, longest: float
) -> tuple[bool, Cycle, float, Counts]:
    """Solve the cycle from an angle.

    Returns whether it ends within `longest` (s), the cycle, by what angle the stick at its end
    turns, and what it took.
    """
    fine, early = finer(accuracy), lead(problem, theta)
    u_x, u_y = elongation_held(problem, theta)
    v_x, v_y = in_principal_axes(problem, rate(problem.drive, 0.0))
    motion = Motion(0.0, u_x - v_x * early, u_y - v_y * early, 0.0, 1.0, 0.0)
    state = State(motion, at_takeoff(memory), NOTHING)
    stick, never, nowhere = np.empty((1, 2)), np.empty(0), np.empty((0, 0))
    code, state, _, _ = advance(
        problem, state, early + longest, fine, NODE_STEPS, never, nowhere, 0, stick
    )
    end = state.motion
    duration, _ = stick_duration(problem, end.t, end.u_x, end.u_y, inf)
    there = angle(problem, end.u_x + v_x * duration, end.u_y + v_y * duration)
    swing = wrapped(there - angle(problem, end.u_x, end.u_y))
    landing = end.t - stick[0, 1]
    returns = code == RUNNING and state.counts.sticks == 1 and 0.0 < duration < inf
    cycle = Cycle(wrapped(there - theta), landing + duration, landing)
    return returns, cycle, swing, state.counts


@inlined
def chart(
    problem: Problem,
    accuracy: Accuracy,
    state: State,
    known: Returns,
    theta: float,
    reach: float,
    longest: float,
) -> State:
    """Add a patch over the angles from `theta` on, or an edge if some of them do not return.

    The state is given back with what that took. Turns are relative to themselves and to the
    stick's: they may be nothing where cycles repeat.
    """
    motion, memory, counts = state
    row, missed = known.sizes[0], inf
    c = known.coefficients[row]
    for n in range(NODES):
        x = POINTS[n]
        there = theta + 0.5 * (x + 1.0) * reach
        returns, cycle, swing, took = solved(problem, accuracy, memory, there, longest)
        counts = added(counts, took)
        known.sizes[3] += 1
        if not returns:
            known.edges[known.sizes[1]] = there
            known.sizes[1] += 1
            return State(motion, memory, counts)
        so_far = interpolated(c, n, x)
        product = 1.0
        for i in range(n):
            product *= x - POINTS[i]
        c[n, 0] = cycle.turn - so_far.turn
        c[n, 1] = cycle.time - so_far.time
        c[n, 2] = cycle.landing - so_far.landing
        miss = abs(c[n, 0]) / max(abs(cycle.turn), abs(swing))
        miss = max(miss, abs(c[n, 1]) / cycle.time, abs(c[n, 2]) / (NEAR * cycle.time))
        for i in range(3):
            c[n, i] /= product
        if miss < known.closing and missed < 10.0 * known.closing:
            patch = known.patches[row]
            patch[0], patch[1], patch[2] = theta, 2.0 / reach, n + 1
            known.sizes[0] += 1
            known.sizes[3] -= n + 1
            return State(motion, memory, counts)
        if n >= NODES // 2 and miss > sqrt(known.closing):  # the error falls geometrically
            break
        missed = miss
    known.width[0] *= 0.5
    return State(motion, memory, counts)
