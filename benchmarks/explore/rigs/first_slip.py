"""``python -m benchmarks.explore.rigs.first_slip``: the start of the first slip of random systems.

The transverse spring is softer or stiffer than the one along the drive. What `first_slip_time`
finds is held against the last moment at which the mass was as slow as the drive, before it first
moves at three times the drive's speed: no swing across the drive is so fast. Where a system slips
at once, the end of the first stick in closed form is held against it, too. With ``--holds`` each
drive holds once, before or in the first slip. Exit status 1 if more than one of a hundred is off by
more than 5 %, with holds more than two.
"""

from __future__ import annotations

import argparse
import sys
from math import isfinite, nan, radians, sqrt
from typing import NamedTuple

import numpy as np

import stiction as st
from benchmarks.explore.draw import Draw
from stiction.analysis.creep.first_slip import first_slip_time, slips_at_once
from stiction.auditing.prediction import predict

FAST = 3.0  # times the drive's speed
OFF = 0.05  # relative
WRONG = 0.01  # of the systems, at most: where slips are small, a swing is as fast
SAMPLES = 2e5  # of a run, at most


class Seen(NamedTuple):
    """The first slip as the speed shows it, as it is found, and in theory, s; NaN for none."""

    shown: float
    found: float
    theory: float


def system(seed: int, number: int) -> st.Slider:
    """Return a random system that is driven slowly, with friction that weakens fast enough."""
    draw = Draw(seed, number)
    mass, k_x, load = draw.decades(0.01, 3.0), draw.decades(300.0, 1e5), draw.decades(1.0, 100.0)
    soft = draw.chance(0.5)
    k_y = k_x / draw.decades(1.5, 1e3) if soft else k_x * draw.decades(1.2, 6.0)
    mu_0 = draw.between(0.2, 0.6)
    V = mu_0 * load / sqrt(k_x * mass) / draw.between(30.0, 300.0)
    return st.Slider(
        mass=mass,
        k_x=k_x,
        k_y=k_y,
        phi=f"{radians(draw.between(0.3, 45.0 if soft else 10.0))!r} rad",
        normal_load=load,
        friction=st.ExponentialWeakening(
            mu_0, mu_0 * draw.between(0.6, 0.9), V * draw.between(2, 10)
        ),
        drive=st.ConstantVelocity(V),
    )


class Hold(NamedTuple):
    """Begin and length of a hold of the drive, in times of the first loading, F_0/(k_x V)."""

    begin: float
    length: float


def hold(seed: int, number: int) -> Hold:
    """Return a random hold, before or in the first slip."""
    draw = Draw(seed, number)
    return Hold(draw.between(0.6, 1.15), draw.decades(0.01, 1.0))


def look(slider: st.Slider, interrupted: Hold | None = None) -> Seen:
    """Return the first slip of a system, whose drive may hold once."""
    p, V = predict(slider), float(np.hypot(*slider.motion.rate(0.0)))
    loading = p.F_0 / (slider.k_x * V)
    duration = 3.0 * loading
    at_once = slips_at_once(slider)
    if interrupted is not None:
        begin, length = (loading * each for each in interrupted)
        program = st.protocols
        pieces = [
            program.Constant(duration=begin),
            program.Hold(length),
            program.Constant(duration=duration),
        ]
        slider = slider.replace(drive=program.DriveProgram(velocity=V, program=pieces))
        duration, at_once = duration + length, False
    rate = min(20.0 * max(slider.natural_frequencies), SAMPLES / duration)
    run = st.simulate(slider, duration, sample_rate=rate)
    time, speed = run.samples["time"], run.samples["V_X"]
    fast = np.flatnonzero(speed > FAST * V)
    slow = np.flatnonzero(speed[: fast[0]] <= V) if len(fast) else fast
    found = first_slip_time(run)
    return Seen(
        float(time[slow[-1]]) if len(slow) else nan,
        found if found < time[-1] else nan,
        p.load_up if at_once else nan,
    )


def is_off(value: float, shown: float) -> bool:
    """Return whether a time differs from the one that the speed shows, where both are known."""
    return isfinite(value) and isfinite(shown) and abs(value / shown - 1.0) > OFF


def main() -> int:
    """Look at the systems asked for; return the exit status."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--systems", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--holds", action="store_true", help="each drive holds once")
    options = parser.parse_args()
    wrong, slips = 0, 0
    for number in range(options.systems):
        interrupted = hold(options.seed, number) if options.holds else None
        seen = look(system(options.seed, number), interrupted)
        slips += isfinite(seen.shown)
        missed = isfinite(seen.shown) and not isfinite(seen.found)
        if missed or is_off(seen.found, seen.shown) or is_off(seen.theory, seen.shown):
            wrong += 1
            print(f"system {number}: {seen}")
    print(f"{slips} of {options.systems} systems slip; {wrong} are off by more than {OFF:.0%}")
    return int(wrong > (2.0 if options.holds else 1.0) * WRONG * options.systems)


if __name__ == "__main__":
    sys.exit(main())
