"""The accuracy of a run's steps: tolerances, and the scales that they are relative to."""

from __future__ import annotations

from math import hypot, inf, pi, sqrt
from typing import Any, NamedTuple

import numpy as np

from stiction.drive.bounds import load_bounds
from stiction.friction import has_state
from stiction.friction.user.validation import once_for_each_law
from stiction.solver.segments import Segment, begin, fastest_swing, speeds, system_of
from stiction.system.initial import Initial
from stiction.system.slider import Slider

# Of the force, as the error of its rounding: slip that grows out of it is known no better
ROUNDING_OF_FORCE = 1e-15
LEAST_SPEED = 1e-15  # of the initial speeds: slower slip counts as zero
LEAST_MOTION = 1e-13  # of velocities: error that any step may have, well above a float's rounding
LEAST_FLOAT = float(np.finfo(np.float64).tiny)
SLOW = 1e-6  # of the speed that friction can cause: the scale of slip without a drive
# negligible Newton corrections over the tolerance: times its root, and at most
NEWTON_SHARE, NEWTON_MOST = 100.0, 0.2
FACTOR = 0.8  # of (M39): measured by python -m benchmarks --only calibration


class Accuracy(NamedTuple):
    """The tolerances of a step.

    tolerance : relative error of the slip velocity and of the friction's direction in a step;
    newton : relative size of negligible Newton corrections;
    speed : slip speed below which these are absolute, m/s; free_x, free_y : elongation rates that
    friction alone can cause, mu_0 W/sqrt(m k), m/s: limits of the scale of a fast slip, so that the
    springs' own motion is resolved; longest : step size that still resolves drive and load, s;
    drive : its speed along x, or along y if it has none there, m/s, upper limit of a slip's scale,
    but no smaller than rounding lets the fastest slip be solved;
    square_x, square_y : m/k, the square of the time in which each spring swings by a radian, s^2;
    touch : least spare friction of a true stick, m/s; inside : relative error that samples inside
    a step may have: below the tolerance they are solved for; least : smallest motion about steady
    sliding above rounding, m/s.
    """

    tolerance: float
    newton: float
    speed: float
    free_x: float
    free_y: float
    longest: float
    drive: float
    square_x: float
    square_y: float
    touch: float
    inside: float
    least: float


def tolerance(rtol: float) -> float:
    """Return the local tolerance for a desired relative error of the result (M39).

    The estimate of the local error falls with h^4 (the cubic inside a step), the error of
    the result with h^5 (the order of the method), hence the power 4/5: the result's error is
    then proportional to rtol. The factor is measured on 18 systems, by ``python -m benchmarks
    --only calibration``: the error, as a change of mass or load, is rtol in their middle.
    """
    return FACTOR * float(rtol**0.8)


class Scales(NamedTuple):
    """A run's friction coefficient, and the speed of mass and springs at its start (m/s)."""

    mu: float
    elastic: float


def scales_of(slider: Slider, initial: Initial) -> Scales:
    """Return the numbers of a run from which its tolerances follow."""
    system, ((u_x, u_y), slip) = system_of(slider), begin(slider, initial)
    swing = u_x / sqrt(system.mass / system.k_x), u_y / sqrt(system.mass / system.k_y)
    return Scales(slider.F_0 / slider.normal_load, hypot(*slip, *swing))


def accuracy(
    slider: Slider,
    scales: Scales,
    segment: Segment,
    start: float,
    rtol: float,
    inside: float = 0.0,
) -> Accuracy:
    """Return the tolerances of the steps in a segment.

    Its speed (M40) is V sin(phi), at which the transverse motion slips; without misalignment V;
    without a drive a millionth of the speed that friction can give the mass on its spring, which is
    also the upper limit; without either a tiny share of the initial speeds. Friction that weakens
    at the rate g per second, the steepest -F'(v)/m up to 10 times that speed, lets slip grow from
    k V/(m g^2), which must then be resolved; k is the acting stiffness. Slip that the
    rounding of forces makes in 1/g, or in a radian of the spring, is not an error; where a law has
    states, each step tells how much that is (M70c).
    """
    along, across = speeds(slider, segment.problem.drive, start, segment.end)
    law: Any = slider.law
    load = load_bounds(segment.problem.load, start, segment.end)[0]
    mu, elastic = scales
    surface = segment.problem.surface
    system = segment.problem.system
    free_x = mu * load * sqrt(surface.xx / (system.mass * system.k_x))
    free_y = mu * load * sqrt(surface.yy / (system.mass * system.k_y))
    free = min(free_x, free_y)
    square_x, square_y = system.mass / system.k_x, system.mass / system.k_y
    speed, k = (across, system.k_y) if across > 0.0 else (along or SLOW * free, system.k_x)
    if free > 0.0:
        speed = min(speed, free)
    local, weakening, rounding = tolerance(rtol), 0.0, 0.0
    if not has_state(law):
        weakening = steepest_weakening(law, speed) * load
        rounding = ROUNDING_OF_FORCE * free / (1.0 + weakening / sqrt(k * system.mass)) / local
    speed = speed / (1.0 + weakening**2 / (k * system.mass))
    speed = max(speed, rounding, LEAST_SPEED * elastic, LEAST_FLOAT)
    # (M34): Newton's error must not show at a step's end, which is more accurate than its interior
    newton = min(NEWTON_MOST, NEWTON_SHARE * sqrt(local)) * local
    rate = fastest_swing(segment.problem)
    longest = 0.5 * pi / rate if rate > 0.0 else inf
    least = LEAST_MOTION * (along + across + free_x + free_y) / local
    drive = max(along or across or inf, least)
    touch = local * speed
    return Accuracy(
        local, newton, speed, free_x, free_y, longest, drive, square_x, square_y, touch, inside,
        least,
    )  # fmt: skip


@once_for_each_law
def steepest_weakening(law: Any, speed: float) -> float:
    """Return the largest -slope of a set-valued law between rest and ten times `speed`, in s/m.

    It is sought at ten speeds per decade, and again around the steepest.
    """

    def weakening(v: float) -> float:
        try:
            return -float(law.slope(v))
        except ArithmeticError:  # compiled code tells inf there, or zero over it
            return 0.0

    tenths = range(-90, 11)
    slopes = [weakening(speed * 10.0 ** (i / 10)) for i in tenths]
    steepest = tenths[slopes.index(max(slopes))]
    beside = (speed * 10.0 ** (min(steepest + i / 4, 10.0) / 10) for i in range(-3, 4))
    return max(0.0, weakening(0.0), *slopes, *map(weakening, beside))
