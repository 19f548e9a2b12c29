"""Free swings after each slip, as of a load cell that rings, and the force without them.

Between two kicks a free swing goes on by itself: from one period to the next its complex amplitude
is multiplied by the same number, whatever the kick was. Swings of a mass that friction drives,
small slips and noise have no such number. It tells frequency and quality of the cell, and these
tell the force to which it answered.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import inf, log, pi
from typing import NamedTuple

import numpy as np

from stiction.analysis.signals.even_grid import EvenGrid
from stiction.analysis.signals.robust import block_means
from stiction.arrays import TINY, Complex, Floats
from stiction.recording.noise import white_noise

PER_PERIOD = 12  # means of a period: the amplitude needs no more
WINDOW = 1.5  # periods over which an amplitude is measured
PASSES = 4  # in which frequency and factor are found ever more exactly
NEAR, SAME = 0.3, 0.1  # of the amplitude: factors that count, and that are one and the same
# Share of the time in which the factor is the same. Of load cells it is 0.26 to 0.9; vibrations and
# hum in noise come to 0.5 and more, too, so that what is left must also be stick-slip
OFTEN = 0.3
LEAST_QUALITY, MOST_QUALITY = 3.0, 60.0  # a swing that fades at once, and a line that does not
# Noise is amplified by the square of the highest frequency that is restored, over the cell's: up to
# a share of a drop, within a range of frequencies
LOUD, RESTORED = 0.1, (2.0, 6.0)


class FreeSwing(NamedTuple):
    """A free swing, as of a load cell."""

    # Hz, and pi times the periods in which it falls to 1/e
    frequency: float
    quality: float
    share: float  # of the time in which it is seen

    @property
    def rings(self) -> bool:
        """Whether it is that of a load cell which rings after each slip."""
        return self.share > OFTEN and LEAST_QUALITY < self.quality < MOST_QUALITY


def free_swing(grid: EvenGrid, force: Floats, periods: Iterable[float]) -> FreeSwing | None:
    """Return the clearest swing that rings, of a force (N), with about one of some periods (s)."""
    even = grid.on(force)
    found = (_free_swing(even, grid.step, each) for each in periods)
    rings = [each for each in found if each is not None and each.rings]
    return max(rings, key=lambda each: each.share, default=None)


def _free_swing(even: Floats, step: float, period: float) -> FreeSwing | None:
    """Return the free swing whose period is near a given one, from values a step (s) apart."""
    block = max(int(period / step / PER_PERIOD), 1)
    means, step = block_means(even, block), block * step
    turns, factor, share, lag = step / period, 1.0 + 0.0j, 0.0, 1  # turns: from mean to mean
    for _ in range(PASSES):
        lag = max(round(1.0 / turns), 1)
        amplitude = _amplitude(means, turns) if 4.0 / turns < len(means) else np.zeros(0)
        if len(amplitude) <= 4 * lag:
            return None
        before, after = amplitude[:-lag], amplitude[lag:]
        large = np.abs(before) >= np.median(np.abs(before))
        factors = after[large] / np.where(before, before, TINY)[large]
        factor = _usual(factors)
        share = float(np.mean(np.abs(factors - factor) < SAME))
        now = (float(np.angle(factor)) / (2.0 * pi) + round(lag * turns)) / lag
        if not step / (3.0 * period) < now < min(3.0 * step / period, 0.25):
            return None
        turns = now
    fading = -log(max(abs(factor), TINY))
    return FreeSwing(turns / step, pi * turns * lag / fading if fading > 0.0 else inf, share)


def _amplitude(values: Floats, turns: float) -> Complex:
    """Return the complex amplitude around each value, of which a straight line has none."""
    half = max(round(0.5 * WINDOW / turns), 2)
    away = np.arange(-half, half + 1)
    window = np.hanning(len(away) + 2)[1:-1]
    turned = window * np.exp(-2j * pi * turns * away)
    lines, along = np.stack([np.ones(len(away)), away]), np.stack([window, window * away])
    turned -= np.linalg.solve(lines @ along.T, lines @ turned) @ along
    return np.asarray(np.convolve(values, turned[::-1], "valid"))


def _usual(factors: Complex) -> complex:
    """Return where complex numbers crowd: the median of those near it."""
    middle = complex(np.median(factors.real), np.median(factors.imag))
    for _ in range(PASSES):
        near = factors[np.abs(factors - middle) < NEAR]
        if not len(near):
            break
        middle = complex(np.median(near.real), np.median(near.imag))
    return middle


def without_free_swings(grid: EvenGrid, force: Floats, its: FreeSwing, drop: float) -> Floats:
    """Return the force (N) to which a cell answered that swings so; slips are about `drop` (N).

    Far above the cell's frequency it shows little of it, and noise hides that: there the force is
    amplified no more.
    """
    from scipy.fft import irfft, rfft, rfftfreq

    even = grid.on(force)
    ramp = np.linspace(even[0], even[-1], len(even))
    swings = np.append(even - ramp, (ramp - even)[::-1])  # odd about both ends, which are 0
    at = rfftfreq(len(swings), grid.step) / its.frequency
    loud = (LOUD * drop / max(white_noise(force), TINY)) ** 0.5
    highest = float(np.clip(loud, *RESTORED))
    gain = (1.0 - at**2 + 1j * at / its.quality) / (1.0 + (at / highest) ** 2)
    answered = irfft(gain * rfft(swings), len(swings))[: len(even)] + ramp
    return grid.between(answered)
