"""Solved cycles, and the prediction of a cycle that begins near them.

A macroscopic slip always ends at the same angle; only the time until then depends on its start.
Therefore two such slips represent all.
"""

from __future__ import annotations

from math import inf

from stiction.solver.compilation.jit import inlined
from stiction.solver.exact.record import WIDTH
from stiction.solver.multiscale.return_map import CYCLES_PAST, FAR, NEAR, PAST, Cycle, Returns


@inlined
def remember(known: Returns, theta: float, cycle: Cycle) -> None:
    """Store a solved cycle in the place of the oldest one."""
    place = known.sizes[CYCLES_PAST] % PAST
    row = known.past[place]
    row[0], row[1], row[2], row[3] = theta, cycle.turn, cycle.time, cycle.held
    known.sizes[CYCLES_PAST] += 1
    keep_steps(known, place)


@inlined
def keep_steps(known: Returns, place: int) -> None:
    """Store the steps of the last cycle at its place; without room, discard all others first."""
    rows, kept, spans = known.record.rows, known.inside.kept, known.inside.spans
    count = known.record.used[0]
    spans[place, 1] = 0
    if count > len(kept):
        return
    if spans[PAST, 0] + count > len(kept):
        spans[:PAST] = 0
        spans[PAST, 0] = 0  # but the pieces of patches stay where they are
    first = spans[PAST, 0]
    for i in range(count):
        for j in range(WIDTH):
            kept[first + i, j] = rows[i, j]
    spans[place, 0], spans[place, 1], spans[PAST, 0] = first, count, first + count


@inlined
def nearest(known: Returns, theta: float, longer: bool, than: float) -> tuple[int, int]:
    """Return the rows of the two cycles that began nearest to an angle; -1 for none.

    They are sought among the cycles that took longer than a time (s), or among the others.
    """
    i = j = -1
    near = next_near = inf
    for row in range(min(known.sizes[CYCLES_PAST], PAST)):
        if (known.past[row, 2] > than) != longer:
            continue
        distance = abs(known.past[row, 0] - theta)
        if distance < near:
            i, j, near, next_near = row, i, distance, near
        elif distance < next_near:
            j, next_near = row, distance
    return i, j


@inlined
def change(known: Returns, i: int, j: int, off: float) -> Cycle:
    """Return the change of a cycle that begins `off` from row i, on a line through row j."""
    a, b = known.past[i], known.past[j]
    per = off / (b[0] - a[0])
    return Cycle((b[1] - a[1]) * per, (b[2] - a[2]) * per, (b[3] - a[3]) * per)


@inlined
def under_way(known: Returns, row: int, theta: float, last: Cycle) -> bool:
    """Return whether the cycle in a row began at an angle, or slightly before it.

    Slightly later is allowed too, if the stick before it would be shorter than the tolerance of
    landing times: its length grows with the square root of the distance to the edge, and was
    `last.held` one cycle ago. So it is by as much as the angles may differ at which such cycles
    end, and what follows from these.
    """
    off, bound = float(theta - known.past[row, 0]), NEAR * known.closing
    shortest = bound * last.time / last.held
    earlier = -min(shortest * shortest, 1.0)
    return abs(off) <= bound * abs(known.past[row, 1]) or earlier <= off / last.turn <= FAR


@inlined
def same_end(known: Returns, theta: float, last: Cycle) -> tuple[int, Cycle]:
    """Return the cycle from an angle, if it ends where the two nearest long ones do (M59).

    Its row is that of the nearest one; it is -1 if the cycle ends elsewhere.

    One of the two must have begun earlier: then the edge, up to which cycles are short, has been
    passed. The nearest cycle is used, minus the turn since its start; a line through both would
    extrapolate noise.
    """
    i, j = nearest(known, theta, True, FAR * last.time)
    if j < 0 or not (under_way(known, i, theta, last) or under_way(known, j, theta, last)):
        return -1, last
    a = known.past[i]
    off = theta - a[0]
    later = off * last.time / last.turn
    by, bound = change(known, i, j, off), NEAR * known.closing
    ends = abs(by.turn + off) <= bound * abs(a[1]) and abs(by.time + later) <= bound * a[2]
    return i if ends else -1, Cycle(a[1] - off, a[2] - later, a[3])


@inlined
def recall(known: Returns, theta: float, last: Cycle) -> tuple[int, Cycle]:
    """Return the cycle from an angle, predicted from the two nearest solved ones.

    It comes with the row of the nearest, below zero if it cannot be predicted. A long cycle follows
    from their common end. Any other lies on a line through both, and is accepted if it hardly
    differs from the nearest, or ends where it does: in a limit cycle all are long.
    """
    row, cycle = same_end(known, theta, last)
    if row >= 0:
        return row, cycle
    i, j = nearest(known, theta, False, FAR * last.time)
    if j < 0:
        return -1, last
    a, off = known.past[i], theta - known.past[i, 0]
    by, bound = change(known, i, j, off), NEAR * known.closing
    apart = known.past[j, 0] - a[0]
    close = (
        (abs(by.turn) <= bound * abs(a[1]) or abs(by.turn + off) <= bound * abs(apart))
        and abs(by.time) <= bound * a[2]
        and abs(by.held) <= bound * a[2]
    )
    return i if close else -1, Cycle(a[1] + by.turn, a[2] + by.time, a[3] + by.held)
