"""One random rig by the solver and by the readable reference."""

from __future__ import annotations

from math import sin
from typing import NamedTuple

import numpy as np

import stiction as st
from benchmarks.explore.deviation import FINER, FINEST, deviation, forces, response
from benchmarks.explore.rigs.drawing import rig
from stiction.solver.accuracy import tolerance
from stiction.solver.reference import reference_run
from stiction.system.tensors import mass_tensor

CLOSE = 1e-11  # local tolerance of the reference
MOST = 1e5  # steps of the reference: it takes m/F for each metre per second of slip
LEAST = 1e-10  # response that its global error could hide


class Seen(NamedTuple):
    """What was seen of one rig; `off` is the difference from the reference over the response.

    `left_out` is why it does not count, empty if it does.
    """

    number: int
    law: str
    rtol: float
    response: float
    off: float
    sticks: int
    left_out: str


def look(seed: int, number: int) -> Seen:
    """Solve one rig by both, and as it would be if it were a little other."""
    drawn = rig(seed, number)
    slider, duration, rtol = drawn[:3]
    found, run = forces(drawn, rtol)
    finer = max(FINER * rtol, FINEST)
    sharp, _ = forces(drawn, finer)
    moved = max(response(drawn, tolerance(rtol), finer, sharp), LEAST)
    left_out, off = "" if run.status.ok else run.status.value, 0.0
    name, sticks = type(slider.law).__name__, len(run.stick_intervals)
    if steps_of_reference(slider, duration) > MOST:
        return Seen(
            number, name, rtol, moved, off, sticks, "the reference: creep takes too many steps"
        )
    try:
        other = reference_run(slider, duration, run.data["time"].values, rtol=CLOSE)
        theirs = np.stack([slider.k_x * other.u_x, slider.k_y * other.u_y])
        off = deviation(found, theirs[:, : found.shape[1]]) / moved
    except ArithmeticError as error:
        left_out = f"the reference: {str(error).split(' at ')[0]}"
    return Seen(number, name, rtol, moved, off, sticks, left_out)


def steps_of_reference(slider: st.Slider, duration: float) -> float:
    """Return about how many steps the reference takes if the mass creeps all the time."""
    creep = abs(slider.motion.velocity) * sin(slider.misalignment) ** 2
    quickest = slider.F_0 / min(np.linalg.eigvalsh(mass_tensor(slider)))
    return duration * quickest / (3.0 * max(creep, 1e-300))
