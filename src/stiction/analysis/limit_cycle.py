"""The oscillation to which a run settles: its amplitude, or its decay."""

from __future__ import annotations

from math import hypot, pi, sqrt
from typing import NamedTuple

import numpy as np

from stiction.arrays import xr
from stiction.linear_stability import steady_sliding
from stiction.simulation import simulate
from stiction.system.initial import Initial
from stiction.system.slider import Slider

KICK = 1e-2  # of the drive's speed: the disturbance of steady sliding
DECAYED, GROWN = 0.3, 3.0  # times the kick: below it rests, above it can be an oscillation
PERIODS = 10.0  # of the leading mode, in a block of time
SAMPLES = 64  # per period: the largest error of a peak is 0.1 %
EVEN_BLOCKS = 0.01  # largest relative difference between settled blocks
TOLD = 3.0  # times EVEN_BLOCKS by which a small disturbance would change meanwhile
FEWEST_BLOCKS = 6  # blocks, of which the later half must be even
REST, OSCILLATING, UNDECIDED = range(3)


class Found(NamedTuple):
    """The result of one run: amplitude (m), outcome, and final state."""

    amplitude: float
    outcome: int
    state: Initial


def settle(slider: Slider, start: Initial, most_blocks: int, rtol: float) -> Found:
    """Run a slider in blocks of time until it rests, or oscillates evenly."""
    period, block, small = scales(slider)
    growth = steady_sliding(slider).growth_rate
    state, amplitudes = start, []
    for count in range(1, most_blocks + 1):
        run = simulate(slider, block, initial=state, sample_rate=SAMPLES / period, rtol=rtol)
        end = run.state(float(run.samples["time"][-1]))
        state = end.model_copy(update={"time": 0.0})  # drive and load are steady
        amplitudes.append(swing(slider, run.data))
        if amplitudes[-1] < DECAYED * small:
            return Found(amplitudes[-1], REST, state)
        late = amplitudes[count // 2 :]
        # else slow change looks settled
        changes = abs(growth) * block * len(late) > TOLD * EVEN_BLOCKS
        if (
            changes
            and count >= FEWEST_BLOCKS
            and min(late) > GROWN * small
            and max(late) < (1 + EVEN_BLOCKS) * min(late)
        ):
            return Found(float(np.mean(late)), OSCILLATING, state)
    return Found(amplitudes[-1], UNDECIDED, state)


def scales(slider: Slider) -> tuple[float, float, float]:
    """Return the period of the leading mode (s), a block of time (s), the kick's amplitude (m)."""
    linear = steady_sliding(slider)
    c, s = slider.direction
    speed = slider.drive_speed
    compliance = c * c / slider.k_x + s * s / slider.k_y
    natural = sqrt(max(slider.masses) * compliance)
    frequency = float(linear.frequencies[0])
    period = 1.0 / frequency if frequency > 0.0 else 2.0 * pi * natural
    friction = hypot(slider.k_x * linear.state[0], slider.k_y * linear.state[1])
    small = KICK * speed * period / (2.0 * pi)
    return period, PERIODS * period + friction * compliance / speed, small


def swing(slider: Slider, data: xr.Dataset) -> float:
    """Return half of the range of the elongation along the drive, m."""
    return float(np.ptp(slider.along_drive(data["u_x"].values, data["u_y"].values))) / 2.0
