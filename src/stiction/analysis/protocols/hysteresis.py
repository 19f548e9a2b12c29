"""Hysteresis: the loops of force over travel in a reversal test."""

from __future__ import annotations

from dataclasses import dataclass
from math import nan

import numpy as np

from stiction.analysis.protocols.friction_test import (
    ConstantStretch,
    FrictionTest,
    friction_test,
)
from stiction.analysis.record import Record
from stiction.arrays import Floats
from stiction.drive import DriveProgram
from stiction.errors import ResultError
from stiction.text.sections import Section, Table
from stiction.text.units import in_words
from stiction.trajectory import Trajectory


@dataclass(frozen=True)
class Loop:
    """One loop, from a turn of the drive to the second turn after it.

    Attributes
    ----------
    travel, force : ndarray
        (n,), of the drive, m, and along it, N.
    area : float
        Work per loop, J.
    width : float
        Distance between both branches at the middle force, m.
    friction : float
        Half of the span of the force over the normal load.
    """

    travel: Floats
    force: Floats
    area: float
    width: float
    friction: float


@dataclass(frozen=True)
class Hysteresis:
    """The loops of a reversal test.

    Attributes
    ----------
    loops : tuple of Loop
        In order of time.
    """

    loops: tuple[Loop, ...]

    @property
    def section(self) -> Section:
        """The loops in words and as a table."""
        last = self.loops[-1]
        said = f"The last of {len(self.loops)} loops takes {in_words(last.area, 'J')}."
        rows = [
            (str(n), in_words(each.area, "J"), in_words(each.width, "m"), f"{each.friction:.4f}")
            for n, each in enumerate(self.loops, 1)
        ]
        headings = ("loop", "area", "width", "half span over load")
        return Section("Hysteresis", [said], Table(headings, rows))

    def __str__(self) -> str:
        """Return the section as text."""
        return str(self.section)


def hysteresis(source: Trajectory | Record, program: DriveProgram | None = None) -> Hysteresis:
    """Return the loops of force over travel in a reversal test.

    With constant friction mu W on a spring of stiffness k, a loop between turns L apart has the
    area 2 mu W (L - 2 mu W/k), and the width L - 2 mu W/k.

    Parameters
    ----------
    source : Trajectory or Record
        A run, or a record with its normal load.
    program : DriveProgram, optional
        The program of a record, see `st.protocols.reversal_loops`; that of a run is known.

    Raises
    ------
    ResultError
        If the drive does not turn twice.

    Examples
    --------
    >>> import stiction as st
    >>> test = st.protocols.reversal_loops("1 mm/s", "10 mm")
    >>> slider = st.presets.nakano_popov_2020().replace(friction=st.Coulomb(mu_0=0.2), drive=test)
    >>> found = st.analysis.hysteresis(st.simulate(slider, sample_rate="100 Hz"))
    >>> round(1e3 * found.loops[-1].area, 1)
    24.4
    """
    test = friction_test(source, program)
    legs = test.stretches
    turns = [i for i in range(1, len(legs)) if legs[i].velocity * legs[i - 1].velocity < 0.0]
    found = [
        _loop(test, legs[i], legs[i + 1])
        for i in turns[::2]
        if i + 1 in turns and len(test.within(legs[i].start, legs[i + 1].end)) > 2
    ]
    if not found:
        raise ResultError("the drive does not turn twice; see st.protocols.reversal_loops")
    return Hysteresis(tuple(found))


def _loop(test: FrictionTest, back: ConstantStretch, forth: ConstantStretch) -> Loop:
    at = test.within(back.start, forth.end)
    time, force = test.time[at], test.load * test.mu[at]
    turned = time > back.end
    travel = back.velocity * (np.minimum(time, back.end) - back.start)
    travel = travel + forth.velocity * np.maximum(time - forth.start, 0.0)
    middle = 0.5 * (force.max() + force.min())
    sides = [_crossing(travel[part], force[part], middle) for part in (~turned, turned)]
    area = abs(float(np.sum(0.5 * (force[1:] + force[:-1]) * np.diff(travel))))
    span = float(force.max() - force.min())
    return Loop(travel, force, area, abs(sides[1] - sides[0]), 0.5 * span / test.load)


def _crossing(travel: Floats, force: Floats, level: float) -> float:
    """Return where a branch first crosses a level, between samples by a straight line."""
    passed = np.flatnonzero((force[:-1] - level) * (force[1:] - level) <= 0.0)
    if not len(passed):
        return nan
    i = int(passed[0])
    share = (level - force[i]) / (force[i + 1] - force[i]) if force[i + 1] != force[i] else 0.0
    return float(travel[i] + share * (travel[i + 1] - travel[i]))
