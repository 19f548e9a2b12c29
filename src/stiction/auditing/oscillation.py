"""The transverse oscillation of a simulated test, at both ends of each creep."""

from __future__ import annotations

from collections.abc import Iterator
from math import isfinite, nan, pi, sin
from typing import Any, NamedTuple

import numpy as np

from stiction import theory
from stiction.analysis.creep.first_slip import along_force, creep_end, force_direction
from stiction.analysis.motion.rest import stuck_share
from stiction.analysis.signals.reversals import extrema
from stiction.arrays import Floats
from stiction.auditing.simulated_test import SimulatedTest
from stiction.simulation import simulate
from stiction.system.slider import Slider
from stiction.system.tensors import damping_tensor

SWINGS = 10  # of which medians are taken, at either end
FEWEST_SWINGS = 3  # fewer have no rhythm
WINDOW = 100.0  # transverse periods that hold so many, as the frequency falls to a tenth
SLOWEST = 20.0  # such windows hold them even before a slip; the rest of a long creep is left out
FINE_SAMPLES = 50.0  # samples per transverse period in a window, which is simulated again
LOADINGS = 4  # that are looked at after the first
SILENT = 1e-3  # of V sin(phi)/omega_y: smaller swings may be noise of the solver
DEAD = 0.1  # of the first swings: if ten are smaller, the oscillation has died out


class CreepSwings(NamedTuple):
    """Medians of successive swings across the drive.

    Parameters
    ----------
    frequency : float
        Of the swings, Hz.
    amplitude : float
        Half the height of u_y, m.
    at_rest : float
        The share of their time at rest.
    """

    frequency: float
    amplitude: float
    at_rest: float


class TransverseSwings(NamedTuple):
    """The transverse oscillation during creep in a simulated test.

    Parameters
    ----------
    first : CreepSwings or None
        The first of the first creep; None where the test shows none.
    later : list of CreepSwings
        The first after each slip.
    last : list of CreepSwings
        The last before each slip, or before steady sliding.
    largest : CreepSwings or None
        The largest of the first creep, and those beside them.
    dead : float
        When the swings of the first creep have died out, s after it begins; NaN if they last.
    """

    first: CreepSwings | None
    later: list[CreepSwings]
    last: list[CreepSwings]
    largest: CreepSwings | None
    dead: float

    @property
    def swings(self) -> list[CreepSwings]:
        """All of its swings."""
        return [*filter(None, [self.first, self.largest]), *self.later, *self.last]

    @property
    def fastest(self) -> float:
        """The largest frequency, Hz; NaN without swings."""
        return max((each.frequency for each in self.swings), default=nan)


def oscillation_of(seen: SimulatedTest) -> TransverseSwings:
    """Measure the transverse oscillation of a simulated test.

    In each loading the mass creeps from the end of its longest rest on, until it is as fast as the
    drive. Both ends of that are simulated again, finely, from states of the test.
    """
    first: CreepSwings | None = None
    largest: CreepSwings | None = None
    later, last, dead = list[CreepSwings](), list[CreepSwings](), nan
    for number, (begin, near, end) in enumerate(_creeps(seen)):
        if not begin < end:
            continue
        until = min(begin + WINDOW / seen.run.slider.natural_frequency_y, end)
        early = _swings(seen, *_again(seen, begin, until), slice(SWINGS))
        if number == 0:
            first, (largest, dead) = early, _of_whole(seen, begin, end)
        elif early:
            later.append(early)
        late = _swings(seen, *_again(seen, near, end), slice(-SWINGS, None))
        if late and (number or not isfinite(dead)):
            last.append(late)
    return TransverseSwings(first, later, last, largest, dead)


def theoretical_oscillation(slider: Slider) -> tuple[float, float]:
    """Return frequency (Hz) and rate of decay (1/s) of the transverse oscillation early in creep.

    It goes along the force at the end of the first stick, on the springs, the mass and the dampers
    in that direction, by (E6) of docs/explanation/estimates.md. If the rate is negative, it lasts.
    This is linear theory, of a mass that never rests.
    """
    (k, m), e = along_force(slider), np.array(force_direction(slider))
    speed = slider.drive_speed * abs(sin(slider.misalignment) / e[1])
    law: Any = slider.law
    slope = float(law.slope(speed)) * slider.normal_load
    decay = 0.5 * (float(e @ damping_tensor(slider) @ e) + slope) / m
    return float(theory.natural_frequency(k, m)) / (2.0 * pi), decay


def _creeps(seen: SimulatedTest) -> Iterator[tuple[float, float, float]]:
    """Yield the start of each creep, the latest start of its last swings, and its end, s."""
    rests, loadings = seen.run.stick_intervals, seen.table
    window = WINDOW / seen.run.slider.natural_frequency_y
    starts, ends = (loadings[name][:LOADINGS].tolist() for name in ("start", "peak_time"))
    for start, end in zip([0.0, *starts], [creep_end(seen.run), *ends], strict=True):
        inside = rests[(rests[:, 0] >= start) & (rests[:, 1] < end)]
        early = inside[:SWINGS]  # after a slip it rests longer than in a swing
        begin = float(early[np.argmax(early[:, 1] - early[:, 0]), 1]) if len(early) else start
        rest = float(inside[-SWINGS:][0, 0]) if len(inside) else end  # swings get ever slower
        late = min(end - window, rest - (end - rest) / SWINGS)
        yield begin, max(late, begin, end - SLOWEST * window), end


def _again(seen: SimulatedTest, begin: float, end: float) -> tuple[Floats, Floats, Floats]:
    """Return time (s), u_y (m) and the sticks of a part of a test that is simulated again.

    It begins at a sample: the first in the part, or the last before it if there is none.
    """
    run, time = seen.run, seen.run.samples["time"]
    at = max(min(int(np.searchsorted(time, begin)), int(np.searchsorted(time, end)) - 1), 0)
    start, rate = run.state(float(time[at])), FINE_SAMPLES * run.slider.natural_frequency_y
    first = max(begin, start.time)
    times = first + np.arange(int(max((end - first) * rate, 2.0)) + 1) / rate
    again = simulate(run.slider, initial=start, times=times)
    return times, again.samples["u_y"], again.stick_intervals


def _swings(
    seen: SimulatedTest, time: Floats, u_y: Floats, sticks: Floats, part: slice
) -> CreepSwings | None:
    """Return some of the swings, each over two half-swings between turning points."""
    turns = extrema(u_y)[1:-1]
    at, legs = time[turns], np.abs(np.diff(u_y[turns]))
    heights = 0.5 * (legs[1:] + legs[:-1])
    loud = heights > 2.0 * SILENT * _bound(seen.run.slider)
    begin, end = at[:-2][loud][::2][part], at[2:][loud][::2][part]
    if len(begin) < FEWEST_SWINGS:
        return None
    rest = stuck_share(float(begin[0]), float(end[-1]), sticks)
    period = float(np.median(end - begin))
    return CreepSwings(1.0 / period, 0.5 * float(np.median(heights[loud][::2][part])), rest)


def _of_whole(seen: SimulatedTest, begin: float, end: float) -> tuple[CreepSwings | None, float]:
    """Return the largest swings of the first creep, and their time of decay, s after `begin`.

    None and NaN if the test is sampled too coarsely to tell, NaN if they last.
    """
    time, u_y = seen.run.samples["time"], seen.run.samples["u_y"]
    inside = (time >= begin) & (time <= end)
    time, u_y = time[inside], u_y[inside]
    turns = extrema(u_y)[1:-1]
    heights = np.abs(np.diff(u_y[turns]))
    if seen.coarse or len(heights) < 2 * FEWEST_SWINGS:
        return None, nan
    small = heights <= DEAD * np.median(heights[:SWINGS])
    for_long = np.flatnonzero(np.convolve(small, np.ones(SWINGS), "valid") > SWINGS - 0.5)
    until = int(for_long[0]) if len(for_long) else len(heights)
    dead = float(time[turns[until]]) - begin if len(for_long) else nan
    # what moves the mass across as it begins to slip is not a swing of an oscillation that is dead
    first = int(np.argmax(heights[: max(until, 1)])) - SWINGS
    first = int(np.clip(first, 0, max(until - 2 * SWINGS, 0)))
    near = slice(turns[first], turns[min(first + 2 * SWINGS, until)] + 2)
    largest = _swings(seen, time[near], u_y[near], seen.run.stick_intervals, slice(None))
    return largest, dead


def _bound(slider: Slider) -> float:
    """Return V sin(phi)/omega_y, m."""
    omega = 2.0 * pi * slider.natural_frequency_y
    phi = abs(slider.misalignment)
    return float(theory.transverse_amplitude_bound(slider.drive_speed, phi, omega))
