"""The return map: from the end of a stick to the end of the next.

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

from math import nan
from typing import NamedTuple

import numpy as np

WIDEST = 1.0  # rad, of a patch
NODES = 24  # of a patch at most
PATCHES = 256
PAST = 256  # cycles remembered
CLOSING = 0.03  # (M58): relative error of a patch's turn and time, over rtol; errors accumulate
NEAR = 10.0  # over this: tolerance for remembered cycles, and for times of landing
FAR = 2.0  # a cycle so many times longer than those before is beyond an edge


class Cycle(NamedTuple):
    """From the end of one stick to that of the next: turn of the angle, time, time held (s)."""

    turn: float
    time: float
    held: float


class Hold(NamedTuple):
    """A stick not yet recorded in the run: start, end (s) and angle at its end."""

    start: float
    end: float
    theta: float


class Returns(NamedTuple):
    """The known part of the map.

    patches : angle where each starts, 2 over what it reaches over, and the number of its nodes;
    coefficients : of their polynomials for turn, time and the square of the time held; edges :
    angles beyond which there is no return; past : angle, turn, time and time held of cycles;
    width : of patches to try; sizes : of patches, edges and past, nodes in vain, cycles solved;
    last : angle and time (s) of the last take-off; stick, never, nowhere : room for the one stick
    of a cycle that is solved, and for no samples of it; closing : relative error.
    """

    patches: np.ndarray
    coefficients: np.ndarray
    edges: np.ndarray
    past: np.ndarray
    width: np.ndarray
    sizes: np.ndarray
    last: np.ndarray
    stick: np.ndarray
    never: np.ndarray
    nowhere: np.ndarray
    closing: float


def empty_map(rtol: float) -> Returns:
    """Return an empty map."""
    return Returns(
        np.full((PATCHES, 3), nan),
        np.empty((PATCHES, NODES, 3)),
        np.empty(PATCHES),
        np.empty((PAST, 4)),
        np.array([WIDEST]),
        np.zeros(5, dtype=np.int64),
        np.array([nan, nan]),
        np.empty((1, 2)),
        np.empty(0),
        np.empty((0, 0)),
        CLOSING * rtol,
    )
