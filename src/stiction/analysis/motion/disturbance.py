"""Whether a narrow line in a force is a disturbance, such as mains hum, or the motion itself."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from stiction.analysis.motion.course import UNLOADED
from stiction.analysis.motion.rest import STICKING, rest_share
from stiction.analysis.signals.hum import Line

if TYPE_CHECKING:
    import xarray as xr

Floats = NDArray[np.float64]

# A line beside the motion: swings without it have so many of its periods, and are as high or stick
SLOWER, HIGHER = 2.0, 0.75
# Median cosine of the line's phase from one swing to the next, where it returns to within 11 deg:
# slips twice as long as a line's period, but irregular by 5 %, come to 0.95
WHOLE = 0.98
PARTS = 400  # means of a record in which its first loading is sought
LOADED = 0.5  # of its rise: until then the mass goes at half the drive's speed or less
SLIDES = 0.5  # of the rate of loading: afterwards the force rises more slowly, if at all
PERIODS = 5.0  # of the line while the spring is loaded, and afterwards
RESIDUE = 0.05  # of a line's height: so much of it may be left where it was subtracted
AS_LARGE = 0.6  # the smaller amplitude over the larger one, while it is loaded and afterwards


def is_beside(line: Line, table: xr.Dataset) -> bool:
    """Return whether a line is a disturbance of the motion, by the swings without it.

    Then they are slower and larger; or they stick, at any size of the line, because a sticking mass
    does not vibrate.
    """
    period, drop, rise = (table[name].values for name in ("period", "drop", "rise_share"))
    motion = (drop > HIGHER * line.height) | (rest_share(rise) >= STICKING)
    aside = (period * line.frequency > SLOWER) & motion
    return len(aside) >= 2 and bool(np.median(aside) == 1.0)


def is_subharmonic(line: Line, table: xr.Dataset) -> bool:
    """Return whether swings are a subharmonic of the line.

    If every second slip is larger, the rest without the line has twice the line's period, or
    another whole multiple of it. Independent swings have no such period.
    """
    period, drop = table["period"].values, table["drop"].values
    whole = float(np.median(np.cos(2.0 * np.pi * line.frequency * period)))
    return whole > WHOLE and float(np.median(drop)) < line.height


def is_residue(line: Line, table: xr.Dataset) -> bool:
    """Return whether swings are no larger than what may be left of a line that was subtracted."""
    drop = table["drop"].values
    return len(drop) > 0 and float(np.median(drop)) < RESIDUE * line.height


def lasts_through_loading(line: Line, time: Floats, force: Floats) -> bool:
    """Return whether a line is as large while the spring is first loaded as it is afterwards.

    Then it is a disturbance: a mass that sticks does not vibrate.

    Parameters
    ----------
    line : Line
        The line.
    time, force : ndarray
        (n,), s, and N, the line included.
    """
    loaded = _end_of_loading(time, force - line.values, line.height)
    if loaded is None:
        return False
    length = line.frequency * (time[-1] - time[0])
    enough = PERIODS / length * len(time)
    if not enough <= loaded <= len(time) - enough:
        return False
    quick = _quick(force, max(round(len(time) / length), 1))
    before, after = (_amplitude(quick[part], line.values[part]) for part in _split(loaded))
    return min(before, after) >= AS_LARGE * max(before, after)


def _split(at: int) -> tuple[slice, slice]:
    return slice(0, at), slice(at, None)


def _quick(force: Floats, length: int) -> Floats:
    """Return a force less its means over `length` samples."""
    from scipy.ndimage import uniform_filter1d  # type: ignore[attr-defined]

    return np.asarray(force - uniform_filter1d(force, length, mode="nearest"))


def _amplitude(force: Floats, line: Floats) -> float:
    """Return the root mean square of a line as far as a force has it."""
    size = float(line @ line)
    return abs(float(force @ line)) / (size * len(line)) ** 0.5 if size > 0.0 else 0.0


def _end_of_loading(time: Floats, force: Floats, least: float) -> int | None:
    """Return up to which sample the spring of a record is loaded; None if there is no loading.

    The force begins near zero, rises by more than `least` (N), and then stays, or rises more slowly
    by half.
    """
    edges = np.linspace(0, len(force), min(PARTS, len(force)), endpoint=False).astype(np.intp)
    size = np.diff(edges, append=len(force))
    means, times = (np.add.reduceat(each, edges) / size for each in (force, time))
    means = means if means.max() >= -means.min() else -means
    rise = means - means[0]
    if means[0] > UNLOADED * means.max() or not rise.max() > least:
        return None
    at = int(np.argmax(rise > LOADED * rise.max()))
    if at == 0 or at == len(means) - 1 or rise[at:].min() < 0.5 * rise[at]:
        return None
    rate, later = rise[at] / (times[at] - times[0]), rise[-1] - rise[at]
    slides = later < SLIDES * rate * (times[-1] - times[at])
    return int(edges[at]) if slides else None
