"""The motion inside the cycles of a patch, by interpolation in the angle and in the phase.

The phase is the time since the take-off over the slip's duration. It is divided into pieces, in
each of which every column of a sample is a polynomial through Chebyshev points; their values are
interpolated in the angle through the patch's own nodes (M59a), as its turn and time are (see
`interpolant`). The steps of each node are kept while it is solved, and evaluated at these points.
"""

from __future__ import annotations

from math import ceil, inf, pi, sqrt
from typing import NamedTuple

import numpy as np

from stiction.solver.accuracy import Accuracy
from stiction.solver.compilation.jit import inlined, piece
from stiction.solver.exact.pursuit import landing_slip, write_landing
from stiction.solver.exact.record import (
    LANDING,
    OSCILLATOR,
    SIZE,
    StepRecord,
    slip_within,
    start_of,
)
from stiction.solver.exact.sampling import write_slip
from stiction.solver.multiscale.interpolant import POINTS, interpolate
from stiction.solver.multiscale.return_map import (
    AT_EDGE,
    FIRST_PIECE,
    NEAR,
    NODE_COUNT,
    NODES,
    PAST,
    PATCH_NODES,
    PATCHES_MADE,
    PHASES,
    PIECE_COUNT,
    PIECES,
    RESOLVED,
    SLIP_COLUMNS,
    Inside,
    Returns,
)
from stiction.solver.problem import Problem, at, static
from stiction.solver.surface import metric_into

BLOCK = PHASES * SLIP_COLUMNS
STEEP = 2.0  # ratio of the times held at the ends of a patch that is near an edge
NEWTON, NUDGE = 5, 1e-4  # iterations to find an edge, and difference of places for a slope
FOLD = 6  # nodes summed side by side, for speed
ROUGH = 4.0  # what interpolation may miss, over what steps of a node may: these are noise
FINEST = 4  # times the pieces that a swing needs
SPRINGS = 0.3  # error of the springs' forces over that of velocities and of friction


class Window(NamedTuple):
    """The slip of a cycle in a record: the time of its take-off (s), and its duration (s)."""

    start: float
    duration: float


# Chebyshev points of the first kind on [-1, 1], ascending
PHASE: np.ndarray = -np.cos(pi * (np.arange(PHASES) + 0.5) / PHASES)
MONOMIALS = np.linalg.inv(np.vander(PHASE, increasing=True))  # from values to coefficients
ENDS = np.vander([-1.0, 1.0], PHASES, increasing=True) @ MONOMIALS  # from values to both ends


@inlined
def write_kept(
    problem: Problem, rows: np.ndarray, i: int, dt: float, samples: np.ndarray, k: int
) -> int:
    """Write the sample `dt` after the start of the stored step `i`; return the next row."""
    row, motion = rows[i], start_of(rows[i])
    dt = min(max(dt, 0.0), row[SIZE])
    if row[7] == LANDING:
        a_1, a_2, f = row[OSCILLATOR], row[OSCILLATOR + 1], row[OSCILLATOR + 2]
        closed = (row[SIZE], *landing_slip(motion.r, a_1, a_2, f))
        return write_landing(problem, motion, a_1, a_2, f, closed, row[SIZE] - dt, dt, samples, k)
    metric = metric_into(problem, motion.e_x, motion.e_y)
    return write_slip(problem, motion, metric, motion.t + dt, dt, slip_within(row, dt), samples, k)


@inlined
def following_step(rows: np.ndarray, i: int, last: int, t: float) -> int:
    """Return the stored step that contains a time: step `i` or a later one."""
    while i < last and t > rows[i, 0] + rows[i, SIZE]:
        i += 1
    return i


@inlined
def resolution(problem: Problem, duration: float, closing: float) -> int:
    """Return how many pieces resolve a swing of the faster oscillation to the tolerance.

    The remainder of cos(a x) on [-1, 1] behind n Chebyshev polynomials is 2 (a/2)^n/n!.
    """
    s = problem.system
    angle = sqrt(max(s.k_x, s.k_y) * s.per_mass) * duration
    half = 2.0 * (0.5 * FACTORIAL * NEAR * closing) ** (1.0 / PHASES)
    pieces: int = ceil(0.5 * angle / half)
    return pieces


FACTORIAL = float(np.prod(np.arange(1, PHASES + 1)))


@inlined
def bounds(
    problem: Problem, accuracy: Accuracy, inside: Inside, count: int, closing: float
) -> None:
    """Set the error bounds of a sample's columns; for the springs' forces, the patch's bound.

    The bound of velocities and friction is that of remembered cycles, or that of the node's steps.
    """
    fastest = 0.0
    for m in range(count):
        fastest = max(fastest, inside.points[m, 2] ** 2 + inside.points[m, 3] ** 2)
    force = static(problem.law) * at(problem.load, 0.0)
    share = max(NEAR * closing, ROUGH * accuracy.tolerance)
    inside.bound[0] = SPRINGS * share * force / problem.system.k_x
    inside.bound[1] = SPRINGS * share * force / problem.system.k_y
    inside.bound[2] = inside.bound[3] = share * (sqrt(fastest) + accuracy.speed)
    inside.bound[4] = inside.bound[5] = share * force


@inlined
def phase_of(piece: int, pieces: int, y: float) -> float:
    """Return the phase at a place in a piece, -1 to 1."""
    return (piece + 0.5 * (y + 1.0)) / pieces


@inlined
def evaluate_record(
    problem: Problem, record: StepRecord, window: Window, inside: Inside, pieces: int
) -> None:
    """Evaluate a slip at the points of all pieces, then at their ends."""
    i, last = 0, record.used[0] - 1
    for p in range(pieces):
        for m in range(PHASES):
            t = window.start + window.duration * phase_of(p, pieces, PHASE[m])
            i = following_step(record.rows, i, last, t)
            write_kept(
                problem, record.rows, i, t - record.rows[i, 0], inside.points, p * PHASES + m
            )
    i = 0
    for p in range(pieces + 1):
        t = window.start + window.duration * p / pieces
        i = following_step(record.rows, i, last, t)
        write_kept(
            problem, record.rows, i, t - record.rows[i, 0], inside.points, pieces * PHASES + p
        )


@inlined
def error_of_phases(inside: Inside, pieces: int) -> float:
    """Return the error of the pieces at their ends, where it is largest, over its bound."""
    worst = 0.0
    for p in range(pieces + 1):
        own, end = (p - 1, 1) if p > 0 else (0, 0)
        for c in range(SLIP_COLUMNS):
            off = -inside.points[pieces * PHASES + p, c]
            for m in range(PHASES):
                off += ENDS[end, m] * inside.points[own * PHASES + m, c]
            worst = max(worst, abs(off) / inside.bound[c])
    return worst


@inlined
def add_motion(
    problem: Problem,
    accuracy: Accuracy,
    known: Returns,
    n: int,
    window: Window,
    held: float,
) -> None:
    """Add the motion of node `n`, after a stick of `held` (s), to the unfinished patch.

    Near an edge the time held goes with the root of the distance to it (M55), and so does the
    slip's duration, to which the phase is relative. In that root the motion is smooth. There it
    takes the place of the angle, and its own nodes are solved later.
    """
    inside, row = known.inside, known.sizes[PATCHES_MADE]
    shape = inside.shapes[row]
    if n == 0:
        shape[AT_EDGE] = 0
    if n < 2:
        inside.ends[row, n] = held
    if n == 1:
        a, b = inside.ends[row]
        shape[AT_EDGE] = 1 if max(a, b) > STEEP * min(a, b) else 0
    if shape[AT_EDGE] == 0:
        add_node(problem, accuracy, known, n, window)


@inlined
def begin_again(known: Returns) -> None:
    """Discard all nodes except the first of an unfinished patch, since the next is narrower."""
    inside = known.inside
    shape = inside.shapes[known.sizes[PATCHES_MADE]]
    shape[NODE_COUNT], shape[RESOLVED] = 0, 1 if shape[PIECE_COUNT] > 0 else 0
    inside.missed[0] = inf


@inlined
def begin_at_edge(known: Returns) -> None:
    """Set the place of the edge for a patch that ends near one, with nodes in the root (M59b).

    It is where the square of the time held would vanish, beyond the end where that is smaller: of
    the patch's polynomial, or where that has no such place near by, of a line through both ends.
    """
    row, inside = known.sizes[PATCHES_MADE], known.inside
    c, n = known.coefficients[row], int(known.patches[row, PATCH_NODES])
    side = 1.0 if inside.ends[row, 1] < inside.ends[row, 0] else -1.0
    place = side
    for _ in range(NEWTON):
        _, _, square = interpolate(c, n, place)
        _, _, before = interpolate(c, n, place - side * NUDGE)
        if not square < before:
            break
        place += side * NUDGE * square / (before - square)
    if not 1.0 < side * place < 2.0:
        a, b = inside.ends[row, 0] ** 2, inside.ends[row, 1] ** 2
        place = (a + b) / (a - b)
    inside.ends[row, 0], inside.ends[row, 1] = place, side
    inside.shapes[row, NODE_COUNT], inside.shapes[row, RESOLVED] = 0, 1


@inlined
def root_of_place(known: Returns, row: int, x: float) -> float:
    """Return the root of the distance to the edge, -1 to 1 over a patch, at a place in it."""
    place, side = known.inside.ends[row]
    far, near = sqrt(side * place + 1.0), sqrt(side * place - 1.0)
    root = sqrt(max(side * (place - x), 0.0))
    return float(side * (far + near - 2.0 * root) / (far - near))


@inlined
def place_of_root(known: Returns, row: int, z: float) -> float:
    """Return the place in a patch for a root of the distance to the edge."""
    place, side = known.inside.ends[row]
    far, near = sqrt(side * place + 1.0), sqrt(side * place - 1.0)
    root = 0.5 * (far + near - side * z * (far - near))
    return float(min(max(place - side * root * root, -1.0), 1.0))


@piece
def add_node(
    problem: Problem,
    accuracy: Accuracy,
    known: Returns,
    n: int,
    window: Window,
) -> None:
    """Add the motion of node `n`, in the angle or in the time held.

    The number of pieces is chosen at the first node, none if that is not resolved; if it does not
    resolve a later one, where friction turns faster towards the landing, it is twice as large from
    then on. The nodes of the motion are enough when a fresh one is predicted, and the one before it
    nearly so. Later ones are left out; a patch whose motion is not resolved has none.
    """
    inside, shape = known.inside, known.inside.shapes[known.sizes[PATCHES_MADE]]
    if n == 0:
        pieces = resolution(problem, window.duration, known.closing)
        shape[PIECE_COUNT] = min(inside.finer[0] * pieces, max(pieces, PIECES))
        shape[NODE_COUNT], shape[RESOLVED] = 0, 1
    if shape[RESOLVED] == 0 or shape[NODE_COUNT] > 0:
        return
    pieces = resolved_pieces(problem, accuracy, known, n, window)
    shape[RESOLVED] = 1 if pieces > 0 else 0
    if n == 0:
        shape[PIECE_COUNT] = pieces
    if pieces == 0:
        if n > 0:
            inside.finer[0] = min(2 * inside.finer[0], FINEST)
        return
    miss = added_motion(inside, n, pieces)
    if miss < 1.0 and inside.missed[0] < 10.0:
        shape[NODE_COUNT] = n + 1
    inside.missed[0] = miss


@inlined
def resolved_pieces(
    problem: Problem, accuracy: Accuracy, known: Returns, n: int, window: Window
) -> int:
    """Evaluate a slip in so many pieces that they resolve it, and return their number, or 0.

    Only at the first node it may be more than at the start.
    """
    inside, record = known.inside, known.record
    pieces = inside.shapes[known.sizes[PATCHES_MADE], PIECE_COUNT]
    if record.used[0] == 0 or record.used[0] > len(record.rows) or not window.duration > 0.0:
        return 0
    while pieces <= min(PIECES, len(inside.values) - inside.spans[PAST, 1]):
        evaluate_record(problem, record, window, inside, pieces)
        bounds(problem, accuracy, inside, pieces * PHASES, known.closing)
        if error_of_phases(inside, pieces) < 1.0:
            return int(pieces)
        if n > 0:
            return 0
        pieces = 2 * pieces
    return 0


@inlined
def added_motion(inside: Inside, n: int, pieces: int) -> float:
    """Add the points of node `n` to the polynomials in the angle; return their error before."""
    x, product, worst, first = POINTS[n], 1.0, 0.0, inside.spans[PAST, 1]
    for i in range(n):
        inside.basis[i] = product
        product *= x - POINTS[i]
    for p in range(pieces):
        values = inside.values[first + p]
        for m in range(PHASES):
            for c in range(SLIP_COLUMNS):
                off = inside.points[p * PHASES + m, c]
                for i in range(n):
                    off -= inside.basis[i] * values[i, m * SLIP_COLUMNS + c]
                worst = max(worst, abs(off) / inside.bound[c])
                values[n, m * SLIP_COLUMNS + c] = off / product
    return worst


@inlined
def in_progress(known: Returns) -> bool:
    """Return whether more nodes may still resolve the motion inside a patch."""
    shape = known.inside.shapes[known.sizes[PATCHES_MADE]]
    return bool(shape[NODE_COUNT] == 0 and shape[RESOLVED] == 1)


@inlined
def begin_finer(known: Returns) -> bool:
    """Begin the motion of a patch again if it had too few pieces; return whether it did."""
    shape = known.inside.shapes[known.sizes[PATCHES_MADE]]
    if shape[PIECE_COUNT] == 0 or shape[NODE_COUNT] > 0 or shape[RESOLVED] == 1:
        return False
    shape[RESOLVED], known.inside.missed[0] = 1, inf
    return True


@piece
def finish_motion(known: Returns) -> None:
    """Turn the values at the phases into coefficients, or leave the patch without motion."""
    inside, row = known.inside, known.sizes[PATCHES_MADE]
    shape = inside.shapes[row]
    pieces, nodes, first = shape[PIECE_COUNT], shape[NODE_COUNT], inside.spans[PAST, 1]
    shape[FIRST_PIECE] = first
    if nodes == 0:
        return
    inside.spans[PAST, 1] += pieces
    for p in range(pieces):
        for n in range(nodes, min(nodes + FOLD, NODES)):
            inside.values[first + p, n] = 0.0
        for n in range(nodes):
            values = inside.values[first + p, n]
            for j in range(BLOCK):
                inside.block[j] = values[j]
            for a in range(PHASES):
                for c in range(SLIP_COLUMNS):
                    total = 0.0
                    for m in range(PHASES):
                        total += MONOMIALS[a, m] * inside.block[m * SLIP_COLUMNS + c]
                    values[a * SLIP_COLUMNS + c] = total


@inlined
def at_angle(values: np.ndarray, nodes: int, x: float, block: np.ndarray) -> None:
    """Set the coefficients of a piece at a place in the patch, -1 to 1."""
    a = 1.0
    for n in range(0, nodes, FOLD):
        b = a * (x - POINTS[n])
        c = b * (x - POINTS[n + 1])
        v0, v1, v2 = values[n], values[n + 1], values[n + 2]
        if nodes - n <= FOLD // 2:  # the others are zero
            for j in range(BLOCK):
                before = block[j] if n > 0 else 0.0
                block[j] = before + a * v0[j] + b * v1[j] + c * v2[j]
            return
        d = c * (x - POINTS[n + 2])
        e = d * (x - POINTS[n + 3])
        f = e * (x - POINTS[n + 4])
        v3, v4, v5 = values[n + 3], values[n + 4], values[n + 5]
        for j in range(BLOCK):
            before = block[j] if n > 0 else 0.0
            before = before + a * v0[j] + b * v1[j] + c * v2[j]
            block[j] = before + d * v3[j] + e * v4[j] + f * v5[j]
        a = f * (x - POINTS[n + 5])


@inlined
def cubic_of(block: np.ndarray, j: int, y: float, square: float) -> float:
    """Return the partial polynomial from four coefficients of a column."""
    even = block[j] + block[j + 2 * SLIP_COLUMNS] * square
    odd = block[j + SLIP_COLUMNS] + block[j + 3 * SLIP_COLUMNS] * square
    return float(even + odd * y)


@inlined
def write_at_phase(block: np.ndarray, y: float, samples: np.ndarray, k: int) -> None:
    """Write the sample at a place in the piece whose coefficients are set."""
    square = y * y
    for c in range(SLIP_COLUMNS):
        low = cubic_of(block, c, y, square)
        high = cubic_of(block, c + 4 * SLIP_COLUMNS, y, square)
        samples[k, c] = low + high * (square * square)
    samples[k, SLIP_COLUMNS] = 0.0


@inlined
def write_cycle(
    known: Returns,
    row: int,
    x: float,
    start: float,
    landing: float,
    times: np.ndarray,
    samples: np.ndarray,
    k: int,
) -> int:
    """Fill the samples of a slip from a place in a patch; return the next row."""
    inside, shape = known.inside, known.inside.shapes[row]
    place = root_of_place(known, row, x) if shape[AT_EDGE] == 1 else x
    pieces = inside.values[shape[FIRST_PIECE] : shape[FIRST_PIECE] + shape[PIECE_COUNT]]
    return write_pieces(
        pieces, shape[NODE_COUNT], place, start, landing, times, samples, k, inside.block
    )


@piece
def write_pieces(
    pieces: np.ndarray,
    nodes: int,
    x: float,
    start: float,
    landing: float,
    times: np.ndarray,
    samples: np.ndarray,
    k: int,
    block: np.ndarray,
) -> int:
    """Fill the samples of a slip from the pieces of its patch; return the next row.

    To hand over the whole map, of some 200 numbers, takes as long as a sample.
    """
    per, current = len(pieces) / (landing - start), -1
    while k < len(times) and times[k] <= landing:
        phase = (times[k] - start) * per
        p = min(max(int(phase), 0), len(pieces) - 1)
        if p != current:
            at_angle(pieces[p], nodes, x, block)
            current = p
        write_at_phase(block, 2.0 * (phase - p) - 1.0, samples, k)
        k += 1
    return k
