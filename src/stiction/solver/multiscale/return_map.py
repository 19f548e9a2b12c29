"""The return map: from the end of one stick to the end of the next.

While drive and load are steady, one angle determines the state at the end of a stick (see
`section`), and thus all that follows until the end of the next stick (M53). Where this function is
smooth, polynomials through a few cycles, each solved in full, represent all others between them
(`interpolant`, `construction`). Where it is not, or where cycles such as macroscopic slips are too
long to be solved so often, a cycle that begins like an earlier one ends like it (`history`).

Multirevolution and envelope-following methods step over such stroboscopic maps (Petzold 1981;
Calvo, Jay, Montijano & Randez 2004). Their maps have fast components beside the slow ones; here
each stick removes those, and the map is exact.
"""

from __future__ import annotations

from math import inf, nan
from typing import Any, NamedTuple

import numpy as np

from stiction.solver.exact.record import WIDTH, StepRecord, record_of

WIDEST = 1.0  # rad, of a patch
NODES = 24  # of a patch at most
PATCHES = 256
PAST = 256  # cycles remembered
CLOSING = 0.03  # (M58): relative error of a patch's turn and time, over rtol; errors accumulate
NEAR = 10.0  # over this: tolerance for remembered cycles, and for times of landing
STEP_SHARE = 0.3  # tolerance of steps beside the map, over that of others
FAR = 2.0  # a cycle so many times longer than those before is beyond an edge
PHASES = 8  # Chebyshev points of a piece of a slip
PIECES = 16  # of a slip at most
ROOMS = 256  # for pieces of all patches
SLIP_COLUMNS = 6  # of a sample in slip: all but whether it sticks
STEPS = 4096  # kept of one cycle, and of all that are remembered
# places in the arrays of `Returns` and `Inside`
PATCHES_MADE, EDGES_MET, CYCLES_PAST, NODES_VAIN, CYCLES_SOLVED = range(5)  # sizes
PATCH_START, PATCH_SCALE, PATCH_NODES = range(3)  # patches
MAY_COST, OF_A_CYCLE = range(2)  # balance
LAST_ANGLE, LAST_TIME = range(2)  # last
PIECE_COUNT, NODE_COUNT, FIRST_PIECE, AT_EDGE = range(4)  # shapes
RESOLVED = FIRST_PIECE  # while a patch is made


class Cycle(NamedTuple):
    """From the end of one stick to the next: turn of the angle, time, time held (s)."""

    turn: float
    time: float
    held: float


class Stick(NamedTuple):
    """A stick not yet recorded in the run: start, end (s) and angle at its end."""

    start: float
    end: float
    theta: float


class Inside(NamedTuple):
    """The motion inside the cycles of patches (see `inside`) and inside remembered cycles.

    values : of pieces of patches, by node, and by phase and column of a sample; shapes : of each
    patch the number of pieces, that of nodes, its first piece, or while it is made whether it is
    resolved so far, and whether it is interpolated in the root of the distance to an edge; ends :
    of each, the place of that edge and its side, at first the times held at both ends; kept : steps
    of the cycles of `past`; spans : first and number of the steps of each, and behind all the next
    free row, and the next free piece; finer : how many times as many pieces as a swing needs;
    points, bound, basis, block, missed : room for the work.
    """

    values: np.ndarray
    shapes: np.ndarray
    ends: np.ndarray
    kept: np.ndarray
    spans: np.ndarray
    finer: np.ndarray
    points: np.ndarray
    bound: np.ndarray
    basis: np.ndarray
    block: np.ndarray
    missed: np.ndarray


class Returns(NamedTuple):
    """The known part of the map.

    patches : angle where each starts, 2 over what it reaches over, and the number of its nodes;
    coefficients : of their polynomials for turn, time and the square of the time held; edges :
    angles beyond which there is no return; past : angle, turn, time and time held of cycles;
    width : of patches to try; sizes : of patches, edges and past, nodes in vain, cycles solved;
    balance : steps that the map may still cost more than it saves, and those of a cycle without it,
    whole numbers and quarters, so that sums are exact;
    last : angle and time (s) of the last take-off; stick, never, nowhere : room for the one stick
    of a cycle that is solved, and for no samples of it; closing : relative error; record : the
    steps of the last cycle that was solved; inside : the motion inside cycles; steps : address of
    the loop in steps.
    """

    patches: np.ndarray
    coefficients: np.ndarray
    edges: np.ndarray
    past: np.ndarray
    width: np.ndarray
    sizes: np.ndarray
    balance: np.ndarray
    last: np.ndarray
    stick: np.ndarray
    never: np.ndarray
    nowhere: np.ndarray
    closing: float
    record: StepRecord
    inside: Inside
    steps: Any


def empty_map(rtol: float, steps: Any, samples: bool = False) -> Returns:
    """Return an empty map, with room for the motion inside cycles if there are samples.

    `steps` is the address of the loop in steps, of which cycles are made.
    """
    rooms, kept = (ROOMS, STEPS) if samples else (0, 0)
    return Returns(
        np.full((PATCHES, 3), nan),
        np.empty((PATCHES, NODES, 3)),
        np.empty(PATCHES),
        np.empty((PAST, 4)),
        np.array([WIDEST]),
        np.zeros(5, dtype=np.int64),
        np.array([inf, 0.0]),
        np.array([nan, nan]),
        np.empty((1, 2)),
        np.empty(0),
        np.empty((0, 0)),
        CLOSING * rtol,
        record_of(kept),
        Inside(
            np.empty((rooms, NODES, PHASES * SLIP_COLUMNS)),
            np.zeros((PATCHES, 4), dtype=np.int64),
            np.empty((PATCHES, 2)),
            np.empty((kept, WIDTH)),
            np.zeros((PAST + 1, 2), dtype=np.int64),
            np.ones(1, dtype=np.int64),
            np.empty((PIECES * PHASES + PIECES + 1, SLIP_COLUMNS + 1)),
            np.empty(SLIP_COLUMNS),
            np.empty(NODES),
            np.empty(PHASES * SLIP_COLUMNS),
            np.empty(1),
        ),
        steps,
    )
