"""A band of frequencies in which a force vibrates, where its swings are of every size.

Between the smallest swings of such a vibration and noise there is no gap, so that they cannot be
counted. In its spectrum it stands out all the same, as a hump: noise falls off to one side or to
neither.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from stiction.analysis.signals.hum import even_step, spectrum

Floats = NDArray[np.float64]

PERIODS = 16  # of the vibration that a record has at least
SAMPLES = 4  # a period at least
WIDE = 1.4  # times its frequency, and as far below, reaches a hump
FAR = 4.0  # below the frequency by this factor: what is still slower is drift
PER_OCTAVE = 8  # frequencies tried
HANN = 0.375  # mean square of the window under which the spectrum is taken
# Power of a hump over that below it down to `FAR`, and over all above it. Of noise of any colour,
# through filters of any order, 1 of 200 records comes beyond both, and 1 of 6000 beyond 1.6 times
# both; of vibrations beside a random walk that goes as far in a period 1 of 40 stays below.
OVER_SLOWER, OVER_FASTER = 5.0, 1.25
STEEP = 7.0  # power of the height with which the odds of a vibration grow


class Hump(NamedTuple):
    """Where a spectrum stands out most, and by how much.

    Parameters
    ----------
    frequency : float
        Hz.
    height : float
        Its power over what lies to both sides, in units of what tells a vibration: above 1 the
        force vibrates.
    rms : float
        Root of the mean square of what vibrates, N.
    """

    frequency: float
    height: float
    rms: float

    @property
    def likelihood(self) -> float:
        """How likely a vibration makes it, and not noise, 0 to 1; one half at a height of 1."""
        odds: float = min(self.height, 1e9) ** STEEP
        return odds / (1.0 + odds)


NO_HUMP = Hump(np.nan, 0.0, 0.0)


def highest_hump(time: Floats, force: Floats) -> Hump:
    """Return the hump of a force's spectrum that stands out most; none has no height.

    Parameters
    ----------
    time, force : ndarray
        (n,), s, evenly spaced, and N.
    """
    step = even_step(time)
    if step is None or np.ptp(force) == 0.0:
        return NO_HUMP
    power, width = spectrum(force)
    last = 2 * len(power) // SAMPLES
    if last <= PERIODS:
        return NO_HUMP
    below = np.concatenate([[0.0], np.cumsum(power)])
    tried = np.geomspace(PERIODS, last, 1 + int(PER_OCTAVE * np.log2(last / PERIODS)))
    slow, begin, end = (np.rint(tried * by).astype(np.intp) for by in (1 / FAR, 1 / WIDE, WIDE))
    slower, hump, faster = (
        np.maximum(below[b] - below[a], 1e-300) for a, b in ((slow, begin), (begin, end), (end, -1))
    )
    height = np.minimum(hump / slower / OVER_SLOWER, hump / faster / OVER_FASTER)
    best = int(np.argmax(height))
    square = 2.0 * float(hump[best]) * width / (HANN * len(force))
    at = np.arange(begin[best], end[best])
    middle = float(np.average(at, weights=power[at])) * width / step
    return Hump(middle, float(height[best]), square**0.5)
