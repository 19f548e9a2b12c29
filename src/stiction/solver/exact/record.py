"""Steps stored as rows of numbers, from which the motion inside them follows later.

A row holds what the step's own dense output needs (section 14 of the method): its start, its
size, the oscillation under it, and its stages. A record without rows keeps nothing.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from stiction.solver.compilation.jit import inlined
from stiction.solver.exact.collocation import SlipStep, products
from stiction.solver.exact.oscillation import Oscillator, after, oscillator, swings
from stiction.solver.exact.slip_frame import Frame, Outset
from stiction.solver.state import Motion
from stiction.solver.stepping.block_algebra import Triple, less
from stiction.solver.stepping.radau import cubic, integral

WIDTH = 24
SIZE, KIND, OSCILLATOR, REST, TURN, PRODUCTS = 6, 7, 8, 15, 18, 21  # columns, after the motion's
CUBIC, SWUNG, LANDING = 0.0, 1.0, 2.0  # kinds of rows


class StepRecord(NamedTuple):
    """Room for steps: `rows`, and how many are in use, or would be if they fitted."""

    rows: np.ndarray
    used: np.ndarray


class Sink(NamedTuple):
    """The arrays that a run fills.

    times, samples : ascending output times (n,), and rows (n, 7), see `sampling`; sticks : start
    and end of stick intervals (m, 2), s; record : what keeps the steps for later, if it has room.
    """

    times: np.ndarray
    samples: np.ndarray
    sticks: np.ndarray
    record: StepRecord


def record_of(steps: int) -> StepRecord:
    """Return an empty record with room for a number of steps."""
    return StepRecord(np.empty((steps, WIDTH)), np.zeros(1, dtype=np.int64))


@inlined
def keep_step(record: StepRecord, frame: Frame, start: Outset, step: SlipStep) -> None:
    """Write a step of slip to the next row, if there is one."""
    if record.used[0] < len(record.rows):
        write_step(record.rows[record.used[0]], frame, start, step)
    record.used[0] += 1


@inlined
def keep_landing(
    record: StepRecord, frame: Frame, T: float, a_1: float, a_2: float, f: float
) -> None:
    """Write a slip that ends in closed form after `T` (s) to the next row, if there is one."""
    if record.used[0] < len(record.rows):
        row = record.rows[record.used[0]]
        write_start(row, frame, T, LANDING)
        row[OSCILLATOR], row[OSCILLATOR + 1], row[OSCILLATOR + 2] = a_1, a_2, f
    record.used[0] += 1


@inlined
def write_start(row: np.ndarray, frame: Frame, h: float, kind: float) -> None:
    """Write where a step starts, its size and its kind."""
    row[0], row[1], row[2], row[3] = frame.t, frame.u_x, frame.u_y, frame.r
    row[4], row[5], row[SIZE], row[KIND] = frame.e_x, frame.e_y, h, kind


@inlined
def write_step(row: np.ndarray, frame: Frame, start: Outset, step: SlipStep) -> None:
    """Write a step."""
    swing, h, p, w = step
    o = oscillator(frame, start)
    write_start(row, frame, h, SWUNG if swings(o, h) else CUBIC)
    rest, across = less(p, swing.p), products(p, w)
    for i in range(7):
        row[OSCILLATOR + i] = o[i]
    for i in range(3):
        row[REST + i], row[TURN + i], row[PRODUCTS + i] = rest[i], w[i], across[i]


@inlined
def start_of(row: np.ndarray) -> Motion:
    """Return the motion at the start of a row's step."""
    return Motion(row[0], row[1], row[2], row[3], row[4], row[5])


@inlined
def slip_within(row: np.ndarray, dt: float) -> tuple[float, float, float, float]:
    """Return the distance slipped after `dt` along and across a step, and p and w then.

    It is the collocation polynomial, laid over the oscillation.
    """
    rest = row[REST], row[REST + 1], row[REST + 2]
    across = row[PRODUCTS], row[PRODUCTS + 1], row[PRODUCTS + 2]
    turn = row[TURN], row[TURN + 1], row[TURN + 2]
    o = Oscillator(row[8], row[9], row[10], row[11], row[12], row[13], row[14])
    return on_polynomial(row[3], row[SIZE], row[KIND] == SWUNG, o, rest, turn, across, dt)


@inlined
def on_polynomial(
    r: float,
    h: float,
    swung: bool,
    o: Oscillator,
    rest: Triple,
    turn: Triple,
    across: Triple,
    dt: float,
) -> tuple[float, float, float, float]:
    """Evaluate the dense output of a step of size `h` from the slip `r`, given its stages.

    `rest` is p at the stages less the oscillation that it is laid over, if it is; `turn` is w, and
    `across` p w.
    """
    x, p, slid = dt / h, cubic((r, rest[0], rest[1], rest[2]), dt / h), 0.0
    if swung:
        under, _, slid = after(o, dt)
        p = under + cubic((0.0, rest[0], rest[1], rest[2]), x)
    way = cubic((0.0, turn[0], turn[1], turn[2]), x)
    return slid + h * integral(rest, x), h * integral(across, x), max(p, 0.0), way
