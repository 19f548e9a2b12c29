"""``python -m benchmarks.state_laws.velocity_steps``: a, b and D_c of records of velocity steps.

Each record is that of a law drawn at random on a random rig, with noise up to 2 % of b, samples
from two to sixty within D_c, a clock that is off by some samples and a stiffness that is off by
some per cent. Of the intervals of two standard errors 95 % should hold the truth; 92 % are asked
for, and none off by more than six errors. A wrong law may be claimed of one record in a hundred.
"""

from __future__ import annotations

import argparse
import sys
from math import exp, isnan, log
from typing import NamedTuple

import numpy as np
from rich.console import Console

import stiction as st
from benchmarks.explore.draw import Draw
from stiction.analysis.protocols.inversion.spring_slider import (
    Law,
    SpringSlider,
    course_after_a_step,
)
from stiction.analysis.protocols.step_findings import VelocitySteps

V, LOAD, MU = 1e-6, 100.0, 0.6  # m/s, N, 1: of steady sliding before the first step
MOST_SAMPLES = 40_000
COVERED, FARTHEST, WRONG = 0.92, 6.0, 0.01


class DrawnSteps(NamedTuple):
    """A record, its program, and the law that it has; delay (s) and error of the stiffness."""

    record: st.Record
    program: st.protocols.DriveProgram
    law: Law
    truth: tuple[float, float, float]  # a, b, D_c
    delay: float
    stiffer: float  # logarithm of the rig's stiffness over that stated


def record_of(seed: int, number: int, late: float, off: float) -> DrawnSteps | None:
    """Return a record of three steps; None if the slip runs away.

    Parameters
    ----------
    late : float
        Samples by which the clock is off, at most.
    off : float
        By which the logarithm of the stiffness is off, at most.
    """
    draw = Draw(seed, number)
    law, a, D_c = draw.among(("ageing", "slip")), draw.decades(4e-3, 2e-2), draw.decades(1e-6, 3e-5)
    b = a * draw.between(0.3, 2.0)
    k = max(b - a, 0.05 * b) / D_c * draw.decades(1.5, 300.0)
    ratio, length = draw.decades(3.0, 30.0), D_c * draw.between(25.0, 60.0)
    speeds = (V, ratio * V, V, ratio * V)
    ends = np.cumsum([0.0, *(length / each for each in speeds)])
    interval = max(D_c / (draw.decades(2.0, 60.0) * ratio * V), ends[-1] / MOST_SAMPLES)
    noise, delay = b * draw.decades(1e-3, 2e-2), interval * late * draw.between(-1.0, 1.0)
    stiffer = off * draw.between(-1.0, 1.0)
    time = np.arange(0.0, ends[-1] - 1e-9, interval)
    mu = np.full(len(time), MU)
    for start, by, speed in zip(ends[1:], (ratio, 1.0 / ratio, ratio), speeds[1:], strict=False):
        at = time >= start + delay
        travel = (time[at] - start - delay) * speed
        course = course_after_a_step(SpringSlider(by, k, 0.0), law, a, b, D_c, travel)
        if course is None:
            return None
        mu[at] = MU + ((a - b) * log(ratio) if by > 1.0 else 0.0) + course.friction
    random = np.random.Generator(np.random.Philox([seed, number, 1]))
    mu += noise * random.standard_normal(len(mu))
    record = st.Record(
        time=time, force=LOAD * mu, normal_load=LOAD, stiffness=k * LOAD * exp(-stiffer)
    )
    program = st.protocols.velocity_steps(list(speeds), distance=length)
    return DrawnSteps(record, program, law, (a, b, D_c), delay, stiffer)


def deviations(drawn: DrawnSteps, found: VelocitySteps) -> list[list[float]]:
    """Return by how many standard errors a, b and D_c of each determined step are off."""
    return [
        [
            (value - true) / error
            for value, true, error in zip(
                (each.a, each.b, each.D_c),
                drawn.truth,
                (each.a_error, each.b_error, each.D_c_error),
                strict=True,
            )
        ]
        for each in (*found.steps, *found.other)
        if each.law == drawn.law and not isnan(each.D_c)
    ]


def main() -> int:
    """Look at as many records as are asked for; return 1 if a bound is broken."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.state_laws.velocity_steps")
    parser.add_argument("--records", type=int, default=200)
    parser.add_argument("--seed", type=int, default=7)
    parser.add_argument("--late", type=float, default=6.0, help="samples of the clock, at most")
    parser.add_argument("--off", type=float, default=0.2, help="of the stiffness, at most")
    options = parser.parse_args()
    steps, wrong, off = 0, 0, list[list[float]]()
    console = Console()
    for number in range(options.records):
        drawn = record_of(options.seed, number, options.late, options.off)
        if drawn is None:
            continue
        try:
            found = st.analysis.velocity_steps(drawn.record, drawn.program)
        except st.ResultError:
            continue
        known = [each for each in (*found.steps, *found.other) if not isnan(each.D_c)]
        steps += len(found.steps)
        wrong += bool(known) and not found.other and known[0].law != drawn.law
        now = deviations(drawn, found)
        off += now
        for each in now:
            if max(map(abs, each)) > FARTHEST:
                console.print(f"  record {number}: a, b, D_c off by {np.round(each, 1)} errors")
    if not off:
        console.print(f"{steps} steps, none determined")
        return 1
    z = np.abs(off)
    covered = (z < 2.0).mean(axis=0)
    console.print(
        f"{steps} steps, {len(z)} determined; two standard errors hold a, b, D_c in "
        f"{', '.join(f'{each:.1%}' for each in covered)}; farthest {z.max():.1f}; wrong law "
        f"claimed of {wrong} records"
    )
    broken = covered.min() < COVERED or z.max() > FARTHEST or wrong > WRONG * options.records
    return int(broken)


if __name__ == "__main__":
    sys.exit(main())
