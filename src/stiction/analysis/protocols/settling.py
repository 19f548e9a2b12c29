"""Whether a force has settled in the end of a stretch in which nothing is changed."""

from __future__ import annotations

from math import exp, expm1, sqrt
from typing import NamedTuple

import numpy as np

from stiction.analysis.signals.correlated_noise import CorrelatedNoise, correlation_time
from stiction.analysis.signals.robust import part_means
from stiction.analysis.signals.straight_line import line
from stiction.arrays import Floats

SETTLED = 0.2  # of a stretch: its end, in which friction counts as steady
# Of the drive's speed, at which the spring is still loaded: a mass that rests has 1, one that
# slides 0. One that breaks away in the end of the stretch, after a share f of it, has f^2 (3 - 2f):
# at 0.1 the mean force there is too small by 0.4 % of the loading in a whole stretch. A vibration
# of fewer than three cycles there may have as much, and its mean is as uncertain.
STILL_LOADED = 0.1
# Of the force's change within a stretch. Where it tends to its value exponentially, its mean in the
# end of the stretch is off by as much as it still changes there, within a factor of two.
CHANGES = 0.01
ROUNDED = 1e-5  # of the force: a change that an accurate solution may have
BLOCKS = 8  # means of the end of a stretch, that noise and vibrations are known by
CERTAIN = 5.96  # standard errors, Student's t with 6 degrees of freedom: by chance 1 in 1000
PARTS_OF_STRETCH = 50  # of a stretch: their means show how far friction evolves
LAST = round(SETTLED * PARTS_OF_STRETCH)  # of these lie in the end of a stretch
EVOLVED = 0.1  # of all change in a stretch: what is left where evolution is nearly over
STANDS_OUT = 4.0  # standard deviations: 1 of 300 series of 50 means has one beyond by chance
# Travels over which it evolves to that, after which it is over: tails are of D_c, which the travel
# is 1.5 times (ageing law, to a tenth of the speed) to 3.6 times (to ten times the speed)
OVER = 4.0
TAIL = 1.5  # e-folds of a tail within that travel, at least
BENT = 2.0  # standard errors of a bend: a part that has more is not a straight line


def has_settled(time: Floats, force: Floats, late: int) -> bool:
    """Return whether a force over a stretch has settled in its last samples, `late` in number.

    It has not if it still changes there, for sure and by more than a small share of all its change
    in the stretch. While a spring is loaded that is a fifth.
    """
    rise = line(*_blocks(time[-late:], force[-late:]))
    change = abs(rise.slope) * float(time[-1] - time[-late])
    least = max(CHANGES * float(np.ptp(force)), ROUNDED * float(np.abs(force).max()))
    return not (abs(rise.slope) > CERTAIN * rise.slope_error and change > least)


def _blocks(time: Floats, values: Floats) -> tuple[Floats, Floats]:
    """Return means of equally many neighbours, at most some few."""
    count = min(BLOCKS, len(time))
    parts = [np.array_split(each, count) for each in (time, values)]
    times, means = (np.array([float(part.mean()) for part in each]) for each in parts)
    return times, means


class SettledPart(NamedTuple):
    """Friction after it has evolved in a stretch, as a straight line over the drive's travel."""

    # mean travel since the stretch began, and travel within the part, m
    centre: float
    length: float
    # mean friction, and its change with the travel, 1/m
    level: float
    slope: float
    left: Floats  # (n,), what samples deviate by from the line
    tail: float  # what may be left of the evolution where the part begins


def settled_part(
    travel: Floats, mu: Floats, late: int, slope: float, noise: CorrelatedNoise
) -> SettledPart:
    """Return the settled part of a stretch, its last samples (`late` in number) at least.

    It begins some travels after the last that deviates from the line of the end, and later where
    it is bent. What deviates is seen less a slope, and beyond noise, that are known roughly.
    """
    count = len(mu)
    means = part_means(mu - slope * travel, PARTS_OF_STRETCH)
    off = np.abs(means - means[-LAST * len(means) // PARTS_OF_STRETCH :].mean())
    seen = max(EVOLVED * off.max(), STANDS_OUT * noise.error(-(-count // PARTS_OF_STRETCH)))
    gone = float(np.flatnonzero(off > seen)[-1] + 1) / len(means) if (off > seen).any() else 0.0
    latest = max(count - late, 0)
    first = min(int(OVER * gone * count), latest)
    while first < latest and _is_bent(mu[first:]):
        first = (first + latest + 1) // 2
    tail = 0.0
    if gone:
        left = exp(min(-TAIL * (first / count / gone - 1.0), 0.0))
        # it was seen above what is left in the end, which is part of it
        tail = (
            EVOLVED
            * float(off.max())
            * left
            / -expm1(-TAIL * max(1.0 / gone - 1.0, 1.0 / PARTS_OF_STRETCH))
        )
    x, y = travel[first:], mu[first:]
    found = line(x, y)
    off = found.deviations(x, y)
    return SettledPart(found.centre, float(x[-1] - x[0]), found.level, found.slope, off, tail)


def _is_bent(mu: Floats) -> bool:
    """Return whether friction of evenly sampled travel is not a straight line, beyond its noise."""
    means = part_means(mu, PARTS_OF_STRETCH)
    if len(means) < BLOCKS:
        return False
    x = np.linspace(-1.0, 1.0, len(means))
    columns = np.stack([np.ones(len(x)), x, x**2 - np.mean(x**2)], axis=1)
    found = np.linalg.lstsq(columns, means, rcond=None)[0]
    left = means - columns @ found
    variance = correlation_time(left) * float(left @ left) / (len(x) - 3)
    error = sqrt(variance / float(columns[:, 2] @ columns[:, 2]))
    return bool(abs(found[2]) > BENT * error)
