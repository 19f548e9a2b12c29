"""Cycles that were solved before, and what they tell of one that begins near them.

A macroscopic slip ends at one angle whatever it began from: nothing but the time until then
depends on how far it had come. So two of them stand for all.
"""

from __future__ import annotations

from math import inf

from stiction.solver.compilation.jit import inlined
from stiction.solver.multiscale.return_map import FAR, NEAR, PAST, Cycle, Returns


@inlined
def remember(known: Returns, theta: float, cycle: Cycle) -> None:
    """Keep a cycle that was solved, in the place of the oldest."""
    row = known.past[known.sizes[2] % PAST]
    row[0], row[1], row[2], row[3] = theta, cycle.turn, cycle.time, cycle.held
    known.sizes[2] += 1


@inlined
def nearest(known: Returns, theta: float, longer: bool, than: float) -> tuple[int, int]:
    """Return the two cycles that began nearest to an angle, of those that took longer than a
    time (s) or of the others; below zero where there is none."""
    i = j = -1
    near = next_near = inf
    for row in range(min(known.sizes[2], PAST)):
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
    """Return by what a cycle differs from row i if it begins `off` from there: a line to row j."""
    a, b = known.past[i], known.past[j]
    per = off / (b[0] - a[0])
    return Cycle((b[1] - a[1]) * per, (b[2] - a[2]) * per, (b[3] - a[3]) * per)


@inlined
def under_way(known: Returns, row: int, theta: float, last: Cycle) -> bool:
    """Return whether the cycle in a row began at an angle or a little earlier on the way to it.

    Or so little later that a stick before it would be shorter than times of landing may differ
    by: it grows with the square root of the distance to the edge, and was `last.held` a turn ago.
    """
    behind = float(theta - known.past[row, 0]) / last.turn
    shortest = NEAR * known.closing * last.time / last.held
    return -min(shortest * shortest, 1.0) <= behind <= FAR


@inlined
def same_end(known: Returns, theta: float, last: Cycle) -> tuple[bool, Cycle]:
    """Return the cycle from an angle if it ends as the two nearest long ones did (M59).

    One of the two must have begun earlier: then the edge, up to which cycles are short, is behind.
    The nearest is taken, less what is behind, and not the line: that would extrapolate its noise.
    """
    i, j = nearest(known, theta, True, FAR * last.time)
    if j < 0 or not (under_way(known, i, theta, last) or under_way(known, j, theta, last)):
        return False, last
    a = known.past[i]
    off = theta - a[0]
    later = off * last.time / last.turn
    by, bound = change(known, i, j, off), NEAR * known.closing
    ends = abs(by.turn + off) <= bound * abs(a[1]) and abs(by.time + later) <= bound * a[2]
    return ends, Cycle(a[1] - off, a[2] - later, a[3])


@inlined
def remembered(known: Returns, theta: float, last: Cycle) -> tuple[bool, Cycle]:
    """Return the cycle from an angle by the two nearest that were solved.

    A long one by where they end. Any other on a line through both: it counts if that differs so
    little from the nearest that the line does not matter.
    """
    found, cycle = same_end(known, theta, last)
    if found:
        return found, cycle
    i, j = nearest(known, theta, False, FAR * last.time)
    if j < 0:
        return False, last
    a = known.past[i]
    by, bound = change(known, i, j, theta - a[0]), NEAR * known.closing
    close = (
        abs(by.turn) <= bound * abs(a[1])
        and abs(by.time) <= bound * a[2]
        and abs(by.held) <= bound * a[2]
    )
    return close, Cycle(a[1] + by.turn, a[2] + by.time, a[3] + by.held)
