"""Remedies of two parameters at once: turned further, and driven faster or held more stiffly."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from itertools import islice
from math import copysign, inf, radians
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from stiction.auditing.advice import change_factor, few_digits, holds, try_change
from stiction.auditing.simulated_test import LEAST_WORK, SimulatedTest
from stiction.linear_stability.linear import growth_at
from stiction.progress.report import Progress, part, silent
from stiction.system.parameter import change_parameter, change_unchecked, quantity, read, unit
from stiction.system.slider import Slider

PARTNERS = ("drive.velocity", "k_y")  # of the misalignment
# Steady sliding must be stable for all neighbours, too: a quarter away in angle and in the partner,
# so that two digits suffice
ANGLES = np.geomspace(1.0, 45.0, 16)  # degrees; beyond, more of the drive goes across the spring
FACTORS = np.geomspace(1.0, 1e3, 28)
MOST_TRIED = 3  # where it is stable, but not reached from rest
FARTHER = 1.5  # times the factor of the last try


class Change(NamedTuple):
    """A parameter, its SI unit, its present value and another one."""

    path: str
    unit: str
    now: float
    then: float


class Pair(NamedTuple):
    """Two parameters changed at once for steady sliding, and the simulation with both.

    Parameters
    ----------
    path : str
        The parameter beside the misalignment.
    changes : tuple of Change
        Of the misalignment and of that parameter; empty where no pair in the range slides steadily.
    tried : SimulatedTest or None
        The simulation.
    work : int
        Steps and samples of all simulations of these two.
    cut : bool
        Whether the limit of work was reached before all pairs were tried.
    """

    path: str
    changes: tuple[Change, ...] = ()
    tried: SimulatedTest | None = None
    work: int = 0
    cut: bool = False

    @property
    def works(self) -> bool:
        """Whether the simulation from rest reaches steady sliding and remains there."""
        return holds(self.tried)

    @property
    def factor(self) -> float:
        """The larger factor of both changes, see `change_factor`; infinite without a simulation."""
        if self.tried is None:
            return inf
        slider = self.tried.run.slider
        return max(change_factor(slider, of.path, of.now, of.then) for of in self.changes)


def advise_pairs(slider: Slider, work: int, progress: Progress = silent) -> Iterator[Pair]:
    """Yield, for each partner of the misalignment, the nearest pair with steady sliding, tried.

    Nearest is the pair whose partner changes least, and of these that with the least turn. `work`
    limits all simulations together, and `progress` receives the fraction done.
    """
    partners = [path for path in PARTNERS if path != "k_y" or not slider.springs]
    for number, path in enumerate(partners):
        report = part(progress, number, len(partners))
        advice = _advise(slider, path, work // (len(partners) - number), report)
        work -= advice.work
        yield advice


def _advise(slider: Slider, path: str, work: int, progress: Progress) -> Pair:
    """Return the nearest pair, tried from rest."""
    advice = Pair(path)
    for attempt, changes in enumerate(islice(nearest_pairs(slider, path), MOST_TRIED)):
        left = work - advice.work
        if left < LEAST_WORK:
            return advice._replace(cut=True)
        changed = slider
        for each in changes:
            changed = change_parameter(changed, each.path, quantity(slider, each.path, each.then))
        tried = try_change(changed, left, part(progress, attempt, MOST_TRIED))
        advice = Pair(path, changes, tried, advice.work + tried.work)
        if advice.works:
            break
    return advice


def nearest_pairs(slider: Slider, path: str) -> Iterator[tuple[Change, Change]]:
    """Yield pairs of misalignment and partner at which all neighbours slide steadily, too.

    Each has the least turn for its partner, which changes ever more.
    """
    side, now = copysign(1.0, slider.misalignment), read(slider, path)
    turns = slider.turn + side * np.radians(ANGLES)
    rows: deque[NDArray[np.bool_]] = deque(maxlen=3)
    last = 0.0
    for number, factor in enumerate(FACTORS):
        changed = change_unchecked(slider, path, now * float(factor))
        rows.append(np.array([growth_at(changed, "phi", float(each)) < 0.0 for each in turns]))
        if len(rows) < 3 or FACTORS[number - 1] < FARTHER * last:
            continue
        inner = np.logical_and.reduce(rows)
        fit = np.flatnonzero(inner[:-2] & inner[1:-1] & inner[2:]) + 1
        if not len(fit):
            continue
        last = FACTORS[number - 1]
        turned = np.abs(ANGLES[fit] - abs(np.degrees(slider.misalignment)))
        angle = few_digits(side * radians(ANGLES[fit[np.argmin(turned)]]), inf, "rad")
        its = unit(slider, path)
        yield (
            Change("phi", "rad", slider.phi, slider.turn + angle),
            Change(path, its, now, few_digits(now * last, inf, its)),
        )
