"""How long a mass rests in each cycle of a force, from the shape of the cycle."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]

STICKING = 0.75  # of a cycle at rest, or in creep: stick-slip; a vibration rests for less
ANGLES = np.geomspace(1e-4, np.pi / 2, 2000)[::-1]  # beta; linear between them, to 1e-5 in share
_GAINED = 2.0 / np.tan(ANGLES)
_CYCLE = np.pi + 2.0 * ANGLES + _GAINED  # omega times the period
RISES, RESTS = np.append(1.0 - np.pi / _CYCLE, 1.0), np.append(_GAINED / _CYCLE, 1.0)


def rest_share(rise_share: ArrayLike) -> Floats:
    """Return for which share of a cycle the mass rests, where the force rises for `rise_share`.

    While the mass rests the spring is loaded at the drive velocity V. When it slips, against
    friction that is constant, it swings on its spring: u' = A omega cos(omega t) from u' = V over
    its least to u' = V again. With sin(beta) = V/(A omega) the slip takes (pi + 2 beta)/omega, of
    which the force falls for pi/omega; the rest makes up for that fall, 2 A cos(beta), in
    2 cot(beta)/omega. So both shares follow from beta: a sine, in which the mass just does not
    stop, rises for 1/2 of its period; a cycle that is half rest, for 0.613; one that is three
    quarters rest, for 0.777. Creep counts as rest.

    Parameters
    ----------
    rise_share : array
        0 to 1; what is below 1/2 falls more slowly than it rises, and has no rest.

    References
    ----------
    The cycle: J. P. Den Hartog, Mechanical Vibrations, 4th ed. (1956), section 7.3.
    """
    found: Floats = np.interp(np.asarray(rise_share, float), RISES, RESTS)
    return np.maximum(found, 0.0)


def rise_share(rest_share: ArrayLike) -> Floats:
    """Return for which share of a cycle the force rises, where the mass rests for `rest_share`."""
    return np.asarray(np.interp(np.asarray(rest_share, float), RESTS, RISES))
