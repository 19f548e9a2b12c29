"""The duration of rest: in each cycle of a force, from its shape; in a run, from its sticks."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from stiction.arrays import TINY, Floats, Indices
from stiction.drive import Drive
from stiction.text.quantity.wording import MEASURABLE

STICKING = 0.75  # of a cycle at rest, or in creep: stick-slip; a vibration rests for less
ANGLES = np.geomspace(1e-4, np.pi / 2, 2000)[::-1]  # beta; linear between them, to 1e-5 in share
# Of a cycle: a mass that sticks for more, sticks and slips. An error of the slip speed of a
# millionth of its amplitude, the default tolerance, may end a slip early where the speed only
# touches zero, by the root of that
TOUCHES = 1e-3
STILL = 0.1  # of the drive velocity: a mass that slips more slowly rests, or creeps
HELD = 0.8  # of the drive's way across: a mass that does not follow it so far is held
LAST, COME_TO_REST = 20, 1e-6  # part of a record, and of its largest slip speed
_GAINED = 2.0 / np.tan(ANGLES)
_CYCLE = np.pi + 2.0 * ANGLES + _GAINED  # omega times the period
RISE_SHARES, REST_SHARES = np.append(1.0 - np.pi / _CYCLE, 1.0), np.append(_GAINED / _CYCLE, 1.0)


def rest_share(rise_share: ArrayLike) -> Floats:
    """Return the share of rest in a cycle from the share in which the force rises.

    During rest the spring is loaded at the drive velocity V. During slip against constant friction
    the mass swings on its spring, u' = A omega cos(omega t), from u' = V through the minimum back
    to u' = V. With sin(beta) = V/(A omega), the slip takes (pi + 2 beta)/omega, and the force falls
    for pi/omega of it. The rest compensates that fall, 2 A cos(beta), in 2 cot(beta)/omega. Thus
    beta determines both shares. The rise share is 1/2 for a sine, in which the mass just does not
    stop, 0.613 for a cycle with half rest, and 0.777 for three quarters. Creep counts as rest.

    Parameters
    ----------
    rise_share : array
        0 to 1; below 1/2 the force falls more slowly than it rises, and there is no rest.

    References
    ----------
    The cycle: J. P. Den Hartog, Mechanical Vibrations, 4th ed. (1956), section 7.3.
    """
    found: Floats = np.interp(np.asarray(rise_share, float), RISE_SHARES, REST_SHARES)
    return np.maximum(found, 0.0)


def rise_share(rest_share: ArrayLike) -> Floats:
    """Return the share of a cycle in which the force rises from the share of rest."""
    return np.asarray(np.interp(np.asarray(rest_share, float), REST_SHARES, RISE_SHARES))


def still_shares(
    time: Floats, speed: Floats, start: Floats, peak_time: Floats, period: Floats
) -> Floats:
    """Return the share of each cycle for which the mass rests or creeps, in one piece.

    That of the loading counts, from trough to peak: a mass also rests while its drive does. The
    speed (n,) is that of slip over that of the drive; start, peak and period are of each cycle, s.
    """
    still = np.concatenate([[False], speed < STILL, [False]])
    ends = np.flatnonzero(np.diff(still.astype(np.int8)))
    first, last = ends[::2], ends[1::2] - 1
    begin, end = (_crossing(time, speed, *each) for each in ((first, first - 1), (last, last + 1)))
    longest, piece = np.zeros(len(start)), np.searchsorted(end, start)
    beyond = np.searchsorted(begin, peak_time)
    cycle = np.flatnonzero(piece < beyond)
    while len(cycle):  # the next piece in each cycle that has another
        k = piece[cycle]
        lasts = np.minimum(end[k], peak_time[cycle]) - np.maximum(begin[k], start[cycle])
        longest[cycle] = np.maximum(longest[cycle], lasts)
        piece[cycle] += 1
        cycle = cycle[piece[cycle] < beyond[cycle]]
    return longest / period


def stick_shares(sticks: Floats, start: Floats, peak_time: Floats, period: Floats) -> Floats:
    """Return the share of each cycle for which the mass sticks while the spring is loaded.

    All intervals of sticking, `sticks`, (n, 2), s, are in order.
    """
    return (stuck_until(peak_time, sticks) - stuck_until(start, sticks)) / period


def _crossing(time: Floats, speed: Floats, inside: Indices, outside: Indices) -> Floats:
    """Return when a speed passes `STILL` between samples below it and their neighbours above."""
    beyond = np.clip(outside, 0, len(time) - 1)
    rise = np.maximum(speed[beyond] - speed[inside], TINY)
    share = np.clip((STILL - speed[inside]) / rise, 0.0, 1.0)
    return np.asarray(time[inside] + share * (time[beyond] - time[inside]))


def comes_to_rest(speed: Floats | None) -> bool:
    """Return whether a mass is known to rest in the last part of a record, from its slip speed."""
    if speed is None or not len(speed):
        return False
    return bool(speed[-max(len(speed) // LAST, 1) :].max() <= COME_TO_REST * speed.max())


def stops_with_drive(drive: Drive, end: float, speed: Floats | None) -> bool:
    """Return whether a mass is known to rest at the end (s) of a run whose drive has stopped."""
    return not any(drive.rate(end)) and comes_to_rest(speed)


def rests_throughout(time: Floats, speed: Floats | None, sticks: Floats | None) -> bool:
    """Return whether a mass is known to rest from beginning to end, also between samples.

    With internal states friction never sticks: there a mass rests that moves by no measurable
    distance. The slip speed (n,) is in m/s; `sticks` are all intervals of sticking, (k, 2), s, in
    order.
    """
    if speed is None or sticks is None or not len(time):
        return False
    if speed.max() * (time[-1] - time[0]) >= MEASURABLE:
        return False
    if not len(sticks):
        return True
    within = sticks[0, 0] <= time[0] and time[-1] <= sticks[-1, 1]
    return bool(within and (sticks[1:, 0] <= sticks[:-1, 1]).all())


def share_held(stretched: float, way: float) -> float:
    """Return the share of the drive's way across (m) that the mass does not follow; 1 of no way.

    By so much the spring across is stretched.
    """
    return min(max(stretched / way, 0.0), 1.0) if way else 1.0


def stuck_until(time: ArrayLike, sticks: ArrayLike) -> Floats:
    """Return the time (s) spent stuck up to each `time`, for stick intervals of shape (n, 2)."""
    ends = np.asarray(sticks, dtype=np.float64).reshape(-1, 2)
    if len(ends) == 0:
        return np.zeros_like(np.asarray(time, dtype=np.float64))
    total = np.cumsum(ends[:, 1] - ends[:, 0])
    known = np.column_stack([total - (ends[:, 1] - ends[:, 0]), total]).ravel()
    stuck: Floats = np.interp(np.asarray(time, dtype=np.float64), ends.ravel(), known)
    return stuck


def stuck_share(start: float, end: float, sticks: ArrayLike) -> float:
    """Return the share of the time between two times (s) that is spent stuck, see `stuck_until`."""
    within = np.clip(np.asarray(sticks, dtype=np.float64).reshape(-1, 2), start, end)
    return float((within[:, 1] - within[:, 0]).sum()) / (end - start)


def sticks_until(time: ArrayLike, sticks: ArrayLike) -> Indices:
    """Return how many stick intervals, of shape (n, 2), have begun before each `time`."""
    begins = np.asarray(sticks, dtype=np.float64).reshape(-1, 2)[:, 0]
    return np.searchsorted(begins, np.asarray(time, dtype=np.float64))
