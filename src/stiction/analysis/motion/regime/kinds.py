"""The kinds of motion, by the shape of a cycle."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from stiction.analysis.motion.rest import STICKING, TOUCHES, rest_share, rise_share
from stiction.analysis.motion.vibration import COUPLED
from stiction.arrays import Floats

STICK_SLIP = "stick-slip"
TRANSITIONAL = "transitional oscillation"
HARMONIC = "harmonic vibration"
TRANSVERSE = "transverse oscillation"
IRREGULAR = "irregular vibration"
SETTLING = "settling"
STEADY = "steady sliding"
STUCK = "stuck"
UNDETERMINED = "undetermined"
# Bounds of the share of a cycle for which the mass rests, or creeps, by the cycle's shape
SHAPES = ((STICKING, STICK_SLIP), (0.5, TRANSITIONAL), (0.0, HARMONIC))
# Share of a cycle for which the mass rests or creeps, in one piece, where its slip speed is known:
# from there on it sticks and slips, whatever the shape says
RESTING_SHARE = 0.5
BACKWARD = 0.4  # share of the rise, below which the force falls slowly and rises fast


def shape(rise_share: float, still: float = 0.0, sticks: float = 0.0) -> str:
    """Return the kind of cycles from the shares of rise, and of rest and sticking where known."""
    return shape_each(np.array([rise_share]), [still], [sticks])[0]


def shape_each(rise_share: Floats, still: Iterable[float], sticks: Iterable[float]) -> list[str]:
    """Return the kind of each of some cycles: see `shape`."""
    shares = zip(rise_share, rest_share(rise_share), still, sticks, strict=True)
    return [_shape(*each) for each in shares]


def _shape(rise_share: float, rests: float, still: float, sticks: float) -> str:
    if still >= RESTING_SHARE or sticks > TOUCHES:
        return STICK_SLIP
    if rise_share < BACKWARD:
        return UNDETERMINED
    return next(kind for bound, kind in SHAPES if rests >= bound)


def bounds(kind: str) -> tuple[float, float]:
    """Return the bounds of the rise share for a kind of cycle."""
    if kind == UNDETERMINED:
        return -np.inf, BACKWARD
    ends = [np.inf, *(float(rise_share(rests)) for rests, _ in SHAPES[:-1]), BACKWARD]
    place = [name for _, name in SHAPES].index(kind)
    return ends[place + 1], ends[place]


def couples(kind: str, period: float, own: float) -> bool:
    """Return whether a vibration is too quick for the spring along x, whose period is `own`.

    Then the transverse spring swings as well: friction that turns couples them. Where the mass
    sticks, it does so once in each of these swings. The force along x may fall more slowly in them
    than it rises, as the mass does not swing along x alone.
    """
    return kind != STICK_SLIP and period < COUPLED * own
