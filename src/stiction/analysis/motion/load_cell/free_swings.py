"""Free swings after each slip, such as a load cell's, and the force without them.

Between two kicks a free swing goes on by itself: from one period to the next its complex amplitude
is multiplied by the same number, whatever the kick was. Swings of a mass that friction drives,
small slips and noise have no such number. It tells frequency and quality of the cell, and these
tell the force to which it answered.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from math import hypot, inf, log, pi
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from stiction.analysis.signals.even_grid import EvenGrid
from stiction.analysis.signals.robust import block_means
from stiction.arrays import TINY, Complex, Floats, median
from stiction.recording.noise import white_noise

PER_PERIOD = 12  # means of a period: the amplitude needs no more
AWAY, HIGHEST = 3.0, 0.25  # how many times off a guess may be, and most turns from mean to mean
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
POINTS = 4097  # of a spectrum, over which noise is summed


class FreeSwing(NamedTuple):
    """A free swing, such as a load cell's."""

    # Hz, and pi times the periods in which it falls to 1/e
    frequency: float
    quality: float
    share: float  # of the time in which it is seen

    @property
    def rings(self) -> bool:
        """Whether it is a load cell's ringing after each slip."""
        return self.share > OFTEN and LEAST_QUALITY < self.quality < MOST_QUALITY


class RingingCell(NamedTuple):
    """A ringing load cell, and the highest frequency at which its readings give the force.

    Parameters
    ----------
    frequency, quality : float
        Undamped, Hz; and Q of the resonance.
    highest : float
        Frequency (Hz) above which readings are amplified no more: noise hides the force there.
    """

    frequency: float
    quality: float
    highest: float

    def restoration(self, frequency: Floats) -> Complex:
        """Return the factors by which readings are multiplied to give the force."""
        at = frequency / self.frequency
        found = (1.0 - at**2 + 1j * at / self.quality) * self.smoothing(frequency)
        return np.asarray(found)

    def smoothing(self, frequency: Floats) -> Floats:
        """Return the remaining share of the force."""
        return np.asarray(1.0 / (1.0 + (frequency / self.highest) ** 2))

    def amplification(self, step: float, block: int) -> float:
        """Return the noise of means of restored readings, over that of means of white noise."""
        frequency = np.linspace(0.0, 0.5 / step, POINTS)
        means = np.sinc(frequency * step * block) / np.sinc(frequency * step)
        power = np.abs(self.restoration(frequency) * means) ** 2
        return float((block * power.mean()) ** 0.5)


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
    guess = step / period  # turns from mean to mean
    if not guess < AWAY * HIGHEST:
        return None  # nothing near it can be found; at whole turns a swing looks like a constant
    turns, factor, share, lag = guess, 1.0 + 0.0j, 0.0, 1
    for _ in range(PASSES):
        lag = max(round(1.0 / turns), 1)
        amplitude = _amplitude(means, turns) if 4.0 / turns < len(means) else np.zeros(0)
        if len(amplitude) <= 4 * lag:
            return None
        before, after = amplitude[:-lag], amplitude[lag:]
        size = np.abs(before)
        large = size >= median(size)
        factors: Complex = np.asarray(after[large] / np.where(before, before, TINY)[large])
        factor = _usual(factors)
        share = float(np.mean(np.abs(factors - factor) < SAME))
        now = (float(np.angle(factor)) / (2.0 * pi) + round(lag * turns)) / lag
        if not guess / AWAY < now < min(AWAY * guess, HIGHEST):
            return None
        turns = now
    fading = -log(max(abs(factor), TINY))
    return FreeSwing(turns / step, pi * turns * lag / fading if fading > 0.0 else inf, share)


def _amplitude(values: Floats, turns: float) -> Complex:
    """Return the complex amplitude around each value; it is zero for a straight line.

    It is also zero for a swing that turns the other way: half of each real swing.
    """
    half = max(round(0.5 * WINDOW / turns), 2)
    away = np.arange(-half, half + 1)
    window, turned = np.hanning(len(away) + 2)[1:-1], np.exp(-2j * pi * turns * away)
    others = np.stack([np.ones(len(away)), away, turned])
    weighted = window * others.conj()
    kernel = window * turned
    kernel -= np.linalg.solve(others @ weighted.T, others @ kernel) @ weighted
    return np.asarray(np.convolve(values, kernel[::-1], "valid"))


def _usual(factors: Complex) -> complex:
    """Return the centre of a crowd of complex numbers: the median of the numbers near it."""
    middle = complex(median(factors.real), median(factors.imag))
    for _ in range(PASSES):
        near = factors[np.abs(factors - middle) < NEAR]
        if not len(near):
            break
        last, middle = middle, complex(median(near.real), median(near.imag))
        if middle == last:
            break  # the same are near again
    return middle


def ringing_cell(force: Floats, its: FreeSwing, drop: float) -> RingingCell:
    """Return the cell that swings so, of a force (N) whose slips are about `drop` (N).

    Damping slows its swing down. Far above the cell's frequency it shows little of the force, and
    noise hides that.
    """
    quality = hypot(its.quality, 0.5)
    frequency = its.frequency * quality / its.quality
    loud = (LOUD * drop / max(white_noise(force), TINY)) ** 0.5
    highest = float(np.clip(loud, *RESTORED))
    return RingingCell(frequency, quality, highest * frequency)


def without_free_swings(grid: EvenGrid, force: Floats, cell: RingingCell) -> Floats:
    """Return the force (N) to which a cell answered."""
    return grid.between(through(grid.on(force), grid.step, cell.restoration))


def through(values: Floats, step: float, gain: Callable[[Floats], NDArray[Any]]) -> Floats:
    """Return values, a step (s) apart, whose spectrum is multiplied by a gain of frequency (Hz)."""
    from scipy.fft import irfft, rfft, rfftfreq

    ramp = np.linspace(values[0], values[-1], len(values))
    swings = np.append(values - ramp, (ramp - values)[::-1])  # odd about both ends, which are 0
    found = irfft(gain(rfftfreq(len(swings), step)) * rfft(swings), len(swings))
    return np.asarray(found[: len(values)] + ramp)
