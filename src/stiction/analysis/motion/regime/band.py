"""A band of frequencies in which a force vibrates with swings of every size.

Such swings cannot be counted, because no gap separates the smallest of them from noise. But the
vibration is a hump in the spectrum, which falls off to both sides; noise falls off to one or none.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from stiction.analysis.signals.digitised import resolution
from stiction.analysis.signals.even_grid import even_grid
from stiction.analysis.signals.hum import PERIODS
from stiction.analysis.signals.robust import uniform_mean
from stiction.analysis.signals.spectrum import spectrum
from stiction.arrays import TINY, Floats
from stiction.recording.noise import rounding_error

SUSPECTED = 5  # periods from which on a vibration is suspected, but not known
SAMPLES = 4  # at least, of a period
WIDE = 1.4  # times its frequency, and as far below, reaches a hump
FAR = 4.0  # below the frequency by this factor: what is still slower is drift
PER_OCTAVE = 8  # frequencies tried
HANN = 0.375  # mean square of the window under which the spectrum is taken
# Power of a hump over that below it down to `FAR`, and over all above it. Of noise of any colour,
# through filters of any order, 1 of 200 records comes beyond both, and 1 of 6000 beyond 1.6 times
# both; of vibrations beside a random walk that goes as far in a period 1 of 40 stays below.
OVER_SLOWER, OVER_FASTER = 5.0, 1.25
STEEP = 7.0  # power of the height with which the odds grow that it is more than noise
# A vibration fades if its root mean square falls from each eighth of the record to the next, in
# so many of all pairs of them, to a third or less. What is below a fifth counts as nothing. Of
# vibrations of irregular size 3 in 1000 do so.
EIGHTHS, FALLING, FADED, NOTHING = 8, 0.95, 1 / 3, 1 / 5


class Hump(NamedTuple):
    """The highest hump of a spectrum.

    Parameters
    ----------
    frequency : float
        Hz.
    height : float
        Its power over that at both sides, in units of the threshold: above 1 the force vibrates.
    rms : float
        Root mean square of the vibration, N.
    """

    frequency: float
    height: float
    rms: float

    @property
    def likelihood(self) -> float:
        """Return the likelihood, 0 to 1, of a signal above noise; one half at a height of 1."""
        return likelihood(self.height)


def likelihood(height: float) -> float:
    """Return the likelihood, 0 to 1, of a signal above noise; one half at a height of 1."""
    odds: float = min(height, 1e9) ** STEEP
    return odds / (1.0 + odds)


NO_HUMP = Hump(np.nan, 0.0, 0.0)


def highest_hump(time: Floats, force: Floats, periods: int = PERIODS) -> Hump:
    """Return the highest hump of a force's spectrum, of height zero if there is none.

    Nor is there one where it is no larger than the rounding of the force, which is a vibration with
    the frequency at which an even change passes through the steps of a converter. The record has at
    least so many `periods` of the vibration.
    """
    grid = even_grid(time)
    if grid is None or not grid.serves or np.ptp(force) == 0.0:
        return NO_HUMP
    step, rounding = grid.step, rounding_error(force, resolution(force))
    force = grid.on(force)
    power, width = spectrum(force)
    last = 2 * len(power) // SAMPLES
    if last <= periods:
        return NO_HUMP
    below = np.concatenate([[0.0], np.cumsum(power)])
    tried = np.geomspace(periods, last, 1 + int(PER_OCTAVE * np.log2(last / periods)))
    slow, begin, end = (np.rint(tried * by).astype(np.intp) for by in (1 / FAR, 1 / WIDE, WIDE))
    slower, hump, faster = (
        np.maximum(below[b] - below[a], TINY) for a, b in ((slow, begin), (begin, end), (end, -1))
    )
    height = np.minimum(hump / slower / OVER_SLOWER, hump / faster / OVER_FASTER)
    square = 2.0 * hump * width / (HANN * len(force))
    height[square <= rounding**2] = 0.0
    best = int(np.argmax(height))
    at = np.arange(begin[best], end[best])
    middle = float(np.average(at, weights=power[at])) * width / step
    return Hump(middle, float(height[best]), float(square[best]) ** 0.5)


def remaining(time: Floats, force: Floats, frequency: float) -> float:
    """Return the share of a vibration that remains at the end, 1 unless it fades steadily.

    What is slower than its `frequency`, Hz, is left out.
    """
    grid = even_grid(time)
    if grid is None or not grid.serves or len(force) < EIGHTHS:
        return 1.0
    force = grid.on(force)
    quick = force - uniform_mean(force, round(1.0 / (frequency * grid.step)))
    size = np.array([np.sqrt(np.mean(part**2)) for part in np.array_split(quick, EIGHTHS)])
    size = np.maximum(size, NOTHING * size[0])
    earlier, later = np.triu_indices(EIGHTHS, 1)
    left = float(size[-1] / size[0]) if size[0] > 0.0 else 1.0
    falls = bool(np.mean(size[later] <= size[earlier]) >= FALLING)
    return left if falls and left < FADED else 1.0
