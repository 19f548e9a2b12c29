"""Which kind of motion a run shows, from its clean samples in a few microseconds.

The kinds and their bounds are those of `stiction.analysis.regime`, which finds them in any
record, noisy or not, and takes a thousand times as long; a test holds the two together.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from stiction.analysis import regime
from stiction.analysis.decay import dies_out
from stiction.analysis.level import PARTS, QUARTER
from stiction.study.turning import Turns

Floats = NDArray[np.float64]

SONG = "song"
KINDS = (
    regime.UNDETERMINED,
    regime.STUCK,
    regime.STICK_SLIP,
    regime.BETWEEN,
    regime.HARMONIC,
    regime.DAMPED,
    regime.STEADY,
    SONG,
)
FEWEST = 2  # swings that tell a kind: one may be the end of a transient
SINGS = 0.1  # of the largest that the fast oscillation can be before the slip reverses


class Swings(NamedTuple):
    """Complete swings of the force, from trough over peak to trough, (n,) each.

    Parameters
    ----------
    drop : ndarray
        From peak to trough, N.
    period : ndarray
        From trough to trough, s.
    rise_share : ndarray
        Of the period in which the force rises.
    end : float
        Time of the last trough, s.
    """

    drop: Floats
    period: Floats
    rise_share: Floats
    end: float


def swings(found: Turns) -> Swings:
    """Return the complete swings between turning points."""
    first = 0 if found.trough else 1
    time, value = found.time[first:], found.value[first:]
    count = max((len(time) - 1) // 2, 0)
    start, peak, trough = (time[i : i + 2 * count : 2] for i in range(3))
    period = trough - start
    drop = value[1 : 1 + 2 * count : 2] - value[2 : 2 + 2 * count : 2]
    return Swings(drop, period, (peak - start) / period, float(trough[-1]) if count else 0.0)


def kind_of(time: Floats, force: Floats, found: Turns, drive: float, song: float) -> str:
    """Return the kind of motion.

    Parameters
    ----------
    time, force : ndarray
        (n,), s and N; the force positive where the spring pulls along the drive.
    found : Turns
        Where the force turns.
    drive : float
        Rate of the force while the mass sticks: stiffness times drive velocity, N/s.
    song : float
        How strong the fast oscillation is at the end, in units of the drive's velocity along it.
    """
    if len(time) < PARTS:
        return regime.UNDETERMINED
    cycles = swings(found)
    count = len(cycles.drop)
    dying = dies_out(cycles.drop, cycles.period, float(time[-1]) - cycles.end)
    if count >= FEWEST and not dying:
        return shape(float(np.median(cycles.rise_share)))
    kind = regime.DAMPED if dying else course(time, force, len(found.time), drive)
    return SONG if kind in (regime.DAMPED, regime.STEADY) and song > SINGS else kind


def shape(rise_share: float) -> str:
    """Return the kind of cycles whose force rises for so much of the time."""
    return next(kind for bound, kind in regime.SHAPES if rise_share >= bound)


def course(time: Floats, force: Floats, turning: int, drive: float) -> str:
    """Return the kind of a force without cycles, by the rules of `stiction.analysis.regime`."""
    edges = np.linspace(0, len(time), PARTS + 1).astype(np.intp)[:-1]
    sizes = np.diff(edges, append=len(time))
    f, t = np.add.reduceat(force, edges) / sizes, np.add.reduceat(time, edges) / sizes
    steps, change, span = np.abs(np.diff(f)).sum(), float(f[-1] - f[0]), float(np.ptp(f))
    early = float((f[QUARTER] - f[0]) / (t[QUARTER] - t[0]))
    late = float((f[-1] - f[-1 - QUARTER]) / (t[-1] - t[-1 - QUARTER]))
    if span > 0.0 and np.ptp(f[-QUARTER:]) <= regime.SETTLED * span:
        return regime.DAMPED
    if turning:
        return regime.UNDETERMINED
    rising = change > 0.0 and change >= regime.ONE_WAY * steps
    if not rising or 0.0 < max(abs(early), abs(late)) < regime.SLOW * drive:
        return regime.STEADY
    loading = late / drive if drive else late / early
    return regime.STUCK if loading >= regime.LOADING else regime.UNDETERMINED
