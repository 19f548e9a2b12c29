"""Steps along the patches of the return map, one cycle each."""

from __future__ import annotations

from math import inf

import numpy as np

from stiction.solver.compilation.jit import inlined, piece, switch
from stiction.solver.exact.sampling import sample_stick
from stiction.solver.multiscale.inside import write_cycle
from stiction.solver.multiscale.interpolant import cycle_from, locate
from stiction.solver.multiscale.return_map import (
    NODE_COUNT,
    PATCH_SCALE,
    PATCH_START,
    Cycle,
    Returns,
    Stick,
)
from stiction.solver.multiscale.section import elongation_held, wrap_angle
from stiction.solver.problem import Problem, drive_rate

HELD = switch(True)


@piece
def follow_patches(
    problem: Problem,
    known: Returns,
    stick: Stick,
    cycle: Cycle,
    sticks: np.ndarray,
    count: int,
    until: float,
    times: np.ndarray,
    samples: np.ndarray,
    k: int,
) -> tuple[Stick, Cycle, int, float, int]:
    """Follow the patches from a stick until they, the time `until` (s) or the room ends.

    They end as well where samples are wanted of a cycle whose motion is not known. This is a
    separate function so that the loop has all registers: long runs spend most time here.

    Returns
    -------
    stick, cycle
        The last stick, and the cycle before it.
    count : int
        Number of sticks so far; those passed are written to `sticks`.
    stuck : float
        Their total duration, s.
    k : int
        The next sample.
    """
    (start, end, theta), stuck = stick, 0.0
    row, x = locate(known, theta)
    wanted = times[k] if k < len(times) else inf
    while row >= 0 and count < len(sticks):
        following = cycle_from(known, row, x)
        turn, time, held = following
        if not (0.0 < held < time and end + time < until):
            break
        landing = end + (time - held)
        if wanted <= landing:
            k = sample_known_stick(problem, Stick(start, end, theta), times, samples, k)
            wanted = times[k] if k < len(times) else inf
        if wanted <= landing:
            if known.inside.shapes[row, NODE_COUNT] == 0:
                break
            k = write_cycle(known, row, x, end, landing, times, samples, k)
            wanted = times[k] if k < len(times) else inf
        sticks[count, 0] = start
        sticks[count, 1] = end
        stuck += end - start
        count += 1
        start, end, theta = landing, end + time, wrap_angle(theta + turn)
        cycle = following
        x = (theta - known.patches[row, PATCH_START]) * known.patches[row, PATCH_SCALE] - 1.0
        if not -1.0 <= x <= 1.0:
            row, x = locate(known, theta)
    return Stick(start, end, theta), cycle, count, stuck, k


@inlined
def sample_known_stick(
    problem: Problem, stick: Stick, times: np.ndarray, samples: np.ndarray, k: int
) -> int:
    """Fill the samples of a stick; return the next row."""
    if not (k < len(times) and times[k] <= stick.end):
        return k
    u_x, u_y = elongation_at_landing(problem, stick)
    return sample_stick(problem, stick.start, u_x, u_y, stick.end, HELD, times, samples, k)


@inlined
def elongation_at_landing(problem: Problem, stick: Stick) -> tuple[float, float]:
    """Return the elongation (x, y) at the start of a stick."""
    u_x, u_y = elongation_held(problem, stick.theta)
    v_x, v_y = drive_rate(problem, 0.0)
    back = stick.end - stick.start
    return u_x - v_x * back, u_y - v_y * back
