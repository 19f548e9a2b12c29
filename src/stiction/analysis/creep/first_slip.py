"""The slow motion before the first slip of a run."""

from __future__ import annotations

from math import pi, sqrt
from typing import Any, NamedTuple

import numpy as np

from stiction import theory
from stiction.arrays import Floats, xr
from stiction.friction import has_state
from stiction.friction.law import static_coefficient
from stiction.system.slider import Slider
from stiction.system.tensors import stiffness_and_mass_along, unit_vector
from stiction.trajectory import Trajectory

# Least gain of a slip on the drive, in units of the drive's speed over the slower and over the
# faster angular frequency. Half a swing on the soft spring at 1.5 times the drive's speed gains 1
# of the first unit; a transverse swing between rest and twice the drive's speed gains 2 of the
# second, and at most 2.1 has been seen at any angle.
GAINED, SWUNG = 1.0, 3.0
# Angle between force and drive when the first stick ends, rad: below the first, a swing along the
# force is a slip; below the second, one that runs away because friction weakens faster than this
# share of critical damping. Found on systems of `python -m benchmarks.explore.rigs.first_slip`.
STRAIGHT, OBLIQUE, STEEP = pi / 9.0, pi / 4.0, 0.5
ROUNDED = 1e-9  # relative: static friction that exceeds the kinetic by less is the same


class FirstLoading(NamedTuple):
    """The first loading of a spring.

    Parameters
    ----------
    slip : int
        The sample at which the first slip begins, -1 if there is none.
    end : int
        The sample at which creep ends: that of the slip, or where the elongation is within the
        least gain of a slip of its largest value.
    """

    slip: int
    end: int


def first_loading(
    slider: Slider,
    time: Floats,
    elongation: Floats,
    rate: Floats,
    drive: Floats,
    *,
    fastest: float | None = None,
    more: float = 0.0,
) -> FirstLoading:
    """Find the start of the first slip.

    In a slip the mass gains on the drive, and the spring's elongation along the drive falls: by
    more than in a transverse swing, which can be faster than the drive too, and by more than in a
    small overshoot before steady sliding. The slip begins at the largest elongation.

    Where the force of both springs points along the drive already, the mass slips at the end of the
    first stick, on their stiffness along the force; else it creeps while friction turns, and slips
    on the softer spring.

    A slip goes on while the drive holds, and may begin there. It gains then on a drive that keeps
    its largest speed, as every slip does: a mass that relaxes in a hold is slower.

    The elongation (n,), m, is that along X, u_x cos(phi) + u_y sin(phi), with its rate (n,), m/s,
    and the velocity of the drive (n,), m/s, too; (1,) if it is constant. Its `fastest` speed (m/s)
    is by default that of these samples. In a slip the mass gains by so much `more` (m) than usual.
    """
    from stiction.analysis.creep.slip_finder import find_slip

    speed = float(np.abs(drive).max()) if fastest is None else fastest
    least = speed * _least_gain(slider) + more
    lag = np.empty(len(time))
    return FirstLoading(*find_slip(time, elongation, rate, drive, speed, least, lag))


def slips_at_once(slider: Slider) -> bool:
    """Return whether the first stick ends with a slip along the drive, without creep before it."""
    phi = abs(slider.misalignment)  # between drive and force of both springs, while it first rests
    angle = abs(float(theory.first_force_angle(phi, slider.k_x, slider.k_y)) - phi)
    return angle < STRAIGHT or (angle < OBLIQUE and _runs_away(slider))


def _runs_away(slider: Slider) -> bool:
    """Return whether friction falls so steeply that the swing after the first stick is a slip."""
    law: Any = slider.law
    if has_state(law):
        return False
    stiffness, mass = along_force(slider)
    fall = -float(law.slope(0.0)) * slider.normal_load
    falls_at_once = static_coefficient(law) > float(law.coefficient(0.0)) * (1.0 + ROUNDED)
    return falls_at_once or fall > STEEP * 2.0 * sqrt(stiffness * mass)


def along_force(slider: Slider) -> tuple[float, float]:
    """Return stiffness and mass of the swing along the force at the end of the first stick."""
    return stiffness_and_mass_along(slider, force_direction(slider))


def force_direction(slider: Slider) -> tuple[float, float]:
    """Return the unit vector of the springs' force, in x and y, while the mass first rests."""
    return unit_vector(float(theory.first_force_angle(slider.misalignment, slider.k_x, slider.k_y)))


def _least_gain(slider: Slider) -> float:
    """Return the least gain of a slip on the drive over the drive's speed, s."""
    slow, fast = (2.0 * pi * each for each in slider.natural_frequencies)
    if slips_at_once(slider):
        slow = float(theory.natural_frequency(*along_force(slider)))
    return max(GAINED / slow, SWUNG / fast)


def _first_loading(run: Trajectory) -> FirstLoading:
    samples, slider = run.samples, run.slider
    elongation = slider.along_drive(samples["u_x"], samples["u_y"])
    rate = slider.along_drive(samples["v_x"], samples["v_y"])
    return first_loading(slider, samples["time"], elongation, rate, samples["drive_X"])


def first_slip_time(run: Trajectory) -> float:
    """Return the start of the first slip (s), see `first_loading`; the run's last time if none."""
    return float(run.samples["time"][_first_loading(run).slip])


def slips(run: Trajectory) -> bool:
    """Return whether a run has a first slip: see `first_loading`."""
    return _first_loading(run).slip >= 0


def creep_end(run: Trajectory) -> float:
    """Return the end of the initial creep (s), with or without a slip: see `FirstLoading`."""
    return float(run.samples["time"][_first_loading(run).end])


def mean_creep_velocity(run: Trajectory, width: float = 0.02) -> xr.DataArray:
    """Return the velocity X' (m/s) averaged over the transverse oscillation, before the first slip.

    The oscillation makes the creep advance in steps, about one per transverse period, with rests in
    between. Distance over time from one rest to another averages over whole steps. Where there are
    no rests, intervals of equal length are used.

    The `width` is the shortest averaging time, s: many transverse periods. A DataArray over
    ``time`` (s), the middle of each interval, is returned: empty if slip comes before two of them.
    """
    times, X = run.samples["time"], run.samples["X"]
    end = first_slip_time(run)
    rests = run.stick_intervals[run.stick_intervals[:, 1] < end, 1]
    edges = list(rests[:1]) or [times[0]]
    for rest in rests:
        if rest - edges[-1] >= width:
            edges.append(rest)
    edges += list(np.arange(edges[-1] + width, end, width))
    borders = np.array(edges)
    velocity = np.diff(np.interp(borders, times, X)) / np.diff(borders)
    middle = 0.5 * (borders[1:] + borders[:-1])
    return xr.DataArray(
        velocity,
        {"time": ("time", middle, {"units": "s"})},
        name="V_X",
        attrs={"units": "m/s", "long_name": "mean velocity along the drive direction"},
    )
