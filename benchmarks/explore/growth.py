"""``python -m benchmarks.explore.growth``: do runs leave steady sliding that is unstable?

Each starts next to it, off by a share of the fastest growing mode, and lasts until linear theory
has made that a million million times as large. Whoever is still there has damped what grows. Exit
status 1 if one is.
"""

from __future__ import annotations

import argparse
import sys
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from math import hypot, log
from typing import NamedTuple

import numpy as np

import stiction as st
from benchmarks.explore.accuracy import DRAWN
from benchmarks.explore.systems.set_valued import System
from stiction.errors import StictionError
from stiction.linear_stability import Linearisation, steady_sliding
from stiction.solver.accuracy import tolerance

SIZES = (1e-4, 1e-7, 1e-10)  # of the drive's speed, or of a state
RTOLS = (1e-3, 1e-6, 1e-9)
GROWN = 1e12
LONGER = 1.5  # times as long as that takes
LONGEST_RUN = 3e5  # radians of the mode, so that a run takes a second at most
LEFT = 0.01  # of the drive's speed: slip that is so far off has left


class Found(NamedTuple):
    """The runs of one system: growth (1/s), and tolerance and size of those that did not leave."""

    number: int
    law: str
    growth: float
    runs: int
    rests: tuple[tuple[float, float], ...]


def unstable(of: System) -> Linearisation | None:
    """Return steady sliding, if it is and if it is unstable."""
    try:
        found = steady_sliding(of.slider)
    except StictionError:
        return None
    return found if found.verdict == "unstable" and of.delta is None else None


def leaves(of: System, sliding: Linearisation, rtol: float, size: float) -> bool:
    """Return whether a run leaves steady sliding."""
    duration = LONGER * log(GROWN) / sliding.growth_rate
    start = sliding.disturbed_start(size)
    run = st.simulate(
        of.slider, duration, sample_rate=400.0 / duration, rtol=rtol, initial=start,
        multiscale=False, max_steps=10_000_000,
    )  # fmt: skip
    (X, Y), (c, s) = of.slider.motion.rate(0.0), of.slider.direction
    x = run.data["slip_x"].values - (X * c - Y * s)
    y = run.data["slip_y"].values - (X * s + Y * c)
    return bool(np.hypot(x, y)[len(x) // 2 :].max() > LEFT * hypot(X, Y))


def look(seed: int, kind: str, number: int) -> Found | None:
    """Run one system from all sizes at all tolerances, if steady sliding is unstable there."""
    drawn = DRAWN[kind](seed, number)
    sliding = unstable(drawn)
    if sliding is None:
        return None
    growth, rate = sliding.growth_rate, abs(sliding.eigenvalues[0])
    # what grows by less in a radian than a step may err by is not for this tolerance
    rtols = [rtol for rtol in RTOLS if growth > tolerance(rtol) * rate]
    if not rtols or rate > growth * LONGEST_RUN / (LONGER * log(GROWN)):
        return None
    runs = [(rtol, size) for rtol in rtols for size in SIZES]
    rests = tuple(each for each in runs if not leaves(drawn, sliding, *each))
    return Found(number, type(drawn.slider.law).__name__, growth, len(runs), rests)


def main() -> int:
    """Look at the systems asked for; return the exit status."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.explore.growth")
    parser.add_argument("--systems", type=int, default=400, help="how many are drawn")
    parser.add_argument("--seed", type=int, default=1, help="of all that is random")
    parser.add_argument("--kind", choices=DRAWN, default="state", help="of system to draw")
    parser.add_argument("--processes", type=int, default=2)
    options = parser.parse_args()
    of = partial(look, options.seed, options.kind)
    with ProcessPoolExecutor(options.processes) as pool:
        seen = [each for each in pool.map(of, range(options.systems), chunksize=4) if each]
    for each in seen:
        for rtol, size in each.rests:
            print(f"{each.number} {each.law}: rests at rtol {rtol:g} from {size:g}")
    runs, rests = sum(each.runs for each in seen), sum(len(each.rests) for each in seen)
    print(f"{len(seen)} unstable systems, {runs} runs: {rests} rest in steady sliding")
    return 1 if rests else 0


if __name__ == "__main__":
    sys.exit(main())
