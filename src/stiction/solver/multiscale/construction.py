"""Construction of a patch of the return map, node by node, each a cycle solved in full."""

from __future__ import annotations

from math import inf, nan, sqrt

import numpy as np

from stiction.solver.accuracy import Accuracy
from stiction.solver.compilation.jit import inlined, number
from stiction.solver.multiscale.inside import (
    Window,
    add_motion,
    add_node,
    begin_again,
    begin_at_edge,
    begin_finer,
    finish_motion,
    in_progress,
    place_of_root,
)
from stiction.solver.multiscale.interpolant import POINTS, interpolate
from stiction.solver.multiscale.return_map import (
    AT_EDGE,
    EDGES_MET,
    MAY_COST,
    NEAR,
    NODES,
    NODES_VAIN,
    PATCH_NODES,
    PATCH_SCALE,
    PATCH_START,
    PATCHES_MADE,
    Cycle,
    Returns,
)
from stiction.solver.multiscale.section import angle, elongation_held, lead, wrap_angle
from stiction.solver.multiscale.steps import take_steps
from stiction.solver.problem import Problem, drive_rate
from stiction.solver.state import (
    NOTHING,
    RUNNING,
    Counts,
    Memory,
    Motion,
    State,
    at_takeoff,
    with_limit,
)
from stiction.solver.stepping.limit import NEVER_ASKED, NO_LIMIT
from stiction.solver.stick import stick_duration

TRIES = 3  # with twice the pieces each
NODE_STEPS = number(10_000)
FIRST_ROW = number(0)  # row of samples
NODE_SHARE = 0.1  # tolerance of a node's steps over that of others; their noise is below `closing`


@inlined
def add_counts(a: Counts, b: Counts) -> Counts:
    """Return the counts plus the steps of other counts, without their stick intervals."""
    return Counts(
        a.steps + b.steps,
        a.rejected + b.rejected,
        a.iterations + b.iterations,
        a.sticks,
        a.stuck,
        a.mapped,
    )


@inlined
def finer(accuracy: Accuracy) -> Accuracy:
    """Return the tolerances for the steps of a node's cycle."""
    tolerance, newton = NODE_SHARE * accuracy.tolerance, NODE_SHARE * accuracy.newton
    return Accuracy(tolerance, newton, *accuracy[2:-1], accuracy.least / NODE_SHARE)


@inlined
def solve_cycle(
    problem: Problem,
    accuracy: Accuracy,
    memory: Memory,
    known: Returns,
    theta: float,
    longest: float,
    most: int,
) -> tuple[bool, Cycle, float, State, int]:
    """Solve the cycle from an angle, beginning at time zero inside a stick, in `most` turns.

    Returns whether it ends within `longest` (s), the cycle, the turn during the stick at its end,
    the final state, and the turns. The record keeps its steps.
    """
    fine, early = finer(accuracy), lead(problem, theta)
    u_x, u_y = elongation_held(problem, theta)
    v_x, v_y = drive_rate(problem, 0.0)
    motion = Motion(0.0, u_x - v_x * early, u_y - v_y * early, 0.0, 1.0, 0.0)
    state = State(motion, with_limit(at_takeoff(memory), NEVER_ASKED), NOTHING)
    times, samples, stick = known.never, known.nowhere, known.stick
    known.record.used[0] = 0
    code, state, _, turns = take_steps(
        problem, state, early + longest, fine, most, times, samples, FIRST_ROW, stick, known
    )
    end = state.motion
    state = State(end, with_limit(state.memory, NO_LIMIT), state.counts)
    held, _ = stick_duration(problem, end.t, end.u_x, end.u_y, inf)
    there = angle(problem, end.u_x + v_x * held, end.u_y + v_y * held)
    swing = wrap_angle(there - angle(problem, end.u_x, end.u_y))
    returns = code == RUNNING and state.counts.sticks == 1 and 0.0 < held < inf
    cycle = Cycle(wrap_angle(there - theta), end.t - stick[0, 1] + held, held)
    return returns, cycle, swing, state, turns


@inlined
def added_node(coefficients: np.ndarray, n: int, cycle: Cycle, swing: float) -> float:
    """Add node `n` to the polynomials; return their previous error at this node (M57).

    The error of the turn is relative to it and to the stick's turn: it may be zero if cycles
    repeat.
    """
    c, x, product = coefficients, POINTS[n], 1.0
    turn, time, square = interpolate(c, n, x)
    for i in range(n):
        product *= x - POINTS[i]
    off_turn, off_time = cycle.turn - turn, cycle.time - time
    off_square = cycle.held * cycle.held - square
    c[n, 0], c[n, 1], c[n, 2] = off_turn / product, off_time / product, off_square / product
    miss = abs(off_turn) / max(abs(cycle.turn), abs(swing))
    return max(
        miss,
        abs(off_time) / cycle.time,
        abs(off_square) / (2.0 * NEAR * cycle.time * cycle.held),
    )


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
    """Add a patch over the angles from `theta` on, or an edge if a cycle does not return.

    The returned state includes the cost. A failed attempt leaves its first node to the next attempt
    from the same angle.
    """
    motion, memory, counts = state
    row, missed = known.sizes[PATCHES_MADE], inf
    patch, c = known.patches[row], known.coefficients[row]
    first = 1 if patch[PATCH_START] == theta else 0
    if first > 0 and len(known.record.rows) > 0:
        begin_again(known)
    c[first:] = 0.0
    patch[PATCH_START] = theta
    for n in range(first, NODES):
        there = theta + 0.5 * (POINTS[n] + 1.0) * reach
        most = int(min(NODE_STEPS, 1.0 + known.balance[MAY_COST]))
        returns, cycle, swing, end, turns = solve_cycle(
            problem, accuracy, memory, known, there, longest, most
        )
        memory, counts = end.memory, add_counts(counts, end.counts)
        known.sizes[NODES_VAIN] += 1
        known.balance[MAY_COST] -= turns
        if known.balance[MAY_COST] < 0.0:  # it costs too much, wherever it would end
            break
        if not returns:
            known.edges[known.sizes[EDGES_MET]] = there
            known.sizes[EDGES_MET] += 1
            patch[PATCH_START] = theta if n > 0 else nan
            return State(motion, memory, counts)
        miss = added_node(c, n, cycle, swing)
        if len(known.record.rows) > 0:
            add_motion(problem, finer(accuracy), known, n, window_of(known, cycle), cycle.held)
        if miss < known.closing and missed < 10.0 * known.closing:
            patch[PATCH_SCALE], patch[PATCH_NODES] = 2.0 / reach, n + 1
            if len(known.record.rows) > 0:
                counts = resolve_motion(
                    problem, accuracy, State(motion, memory, counts), known, n + 1, reach, longest
                )
            known.sizes[PATCHES_MADE] += 1
            known.sizes[NODES_VAIN] -= n + 1
            return State(motion, memory, counts)
        if n >= NODES // 2 and miss > sqrt(known.closing):  # the error should fall geometrically
            break
        missed = miss
    known.width[0] *= 0.5
    return State(motion, memory, counts)


@inlined
def window_of(known: Returns, cycle: Cycle) -> Window:
    """Return the slip of a cycle that has just been solved."""
    return Window(float(known.stick[0, 1]), cycle.time - cycle.held)


@inlined
def resolve_motion(
    problem: Problem,
    accuracy: Accuracy,
    state: State,
    known: Returns,
    n: int,
    reach: float,
    longest: float,
) -> Counts:
    """Solve more nodes until a patch's motion inside the cycles is known too, or give up.

    Nothing but the samples depends on these nodes. Near an edge they are others than those of the
    patch (see `add_motion`).
    """
    _, memory, counts = state
    row = known.sizes[PATCHES_MADE]
    theta, at_edge = known.patches[row, PATCH_START], known.inside.shapes[row, AT_EDGE] == 1
    if at_edge:
        begin_at_edge(known)
        n = 0
    for _ in range(TRIES):
        while n < NODES and in_progress(known):
            x = place_of_root(known, row, POINTS[n]) if at_edge else POINTS[n]
            there = theta + 0.5 * (x + 1.0) * reach
            returns, cycle, _, end, _ = solve_cycle(
                problem, accuracy, memory, known, there, longest, NODE_STEPS
            )
            memory, counts = end.memory, add_counts(counts, end.counts)
            if not returns:
                break
            add_node(problem, finer(accuracy), known, n, window_of(known, cycle))
            n += 1
        if not begin_finer(known):
            break
        n = 0
    finish_motion(known)
    return counts
