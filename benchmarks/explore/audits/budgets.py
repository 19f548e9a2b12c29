"""``python -m benchmarks.explore.audits.budgets``: tolerance budgets against brute force.

The 95 % column of a budget is held against further tests, drawn from the same priors and solved
step by step with ten times as many samples; the sentence on alignment against tests on either side
of its angle. Deterministic in its seed; exit status 1 if the columns hold too few or too many, or
an angle is wrong.
"""

from __future__ import annotations

import argparse
import sys
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from math import isnan, nan, sqrt
from typing import NamedTuple

import numpy as np

import stiction as st
from benchmarks.explore.audits.drawing import rig
from benchmarks.explore.draw import Draw
from stiction.auditing.prediction import predict
from stiction.auditing.simulated_test import coarse_rate, simulate_test
from stiction.auditing.tolerance import (
    ALLOWED,
    ENOUGH,
    Budget,
    Reading,
    budget,
    change,
    reading,
    turn_to,
)
from stiction.inference.priors import Normal, Prior, Uniform
from stiction.inference.simulated.restriction import is_allowed
from stiction.linear_stability import growth_rate
from stiction.progress.report import silent

FINER = 10.0  # times the samples of a budget's own tests
MOST_STEPS = 3_000_000  # of a test
STATED = 0.95
PRINTED = 1e-3  # of a reading, which has four digits: a narrower interval is of coarse samples
FARTHEST = 1.5  # rad, of a misalignment
SIDE = 2.0  # ratio of angles about the limit of alignment that are tried on either side
TRIED = 24  # of them on each
NEAR = 1.3  # factor by which the mean error on a side may pass the allowed one


class Seen(NamedTuple):
    """The share of further tests in each interval, and mean errors about the stated alignment.

    NaN where a budget has no interval of 95 %, or one too narrow, or states no alignment.
    """

    number: int
    what: str
    inside: tuple[float, ...]
    below: float
    above: float


def priors_of(slider: st.Slider, draw: Draw) -> dict[str, Prior]:
    """Return what is uncertain: the misalignment nearly always, and some other parameters."""
    priors: dict[str, Prior] = {}
    if draw.chance(0.9):
        phi = slider.phi
        if draw.chance(0.4):
            near, far = phi / draw.between(1.2, 4.0), phi * draw.between(1.2, 4.0)
            low, high = sorted((near, float(np.clip(far, -FARTHEST, FARTHEST))))
            priors["phi"] = Uniform(low, high, "log" if low > 0.0 else "linear")
        else:
            priors["phi"] = Normal(phi, draw.between(0.05, 0.8) * abs(phi))
    for name in ("k_x", "k_y", "mass", "normal_load"):
        if draw.chance(0.3) or (name == "normal_load" and not priors):
            value = getattr(slider, name)
            priors[name] = Normal(value, draw.between(0.01, 0.15) * value)
    return priors


def read_finely(slider: st.Slider) -> Reading:
    """Return what a test reads that is solved step by step."""
    prediction = predict(slider)
    test = partial(
        simulate_test,
        slider,
        prediction,
        growth_rate(slider),
        sample_rate=FINER * coarse_rate(prediction),
        multiscale=False,
        most_steps=MOST_STEPS,
    )
    return reading(prediction, test)


def further(of: st.Rig, seed: int, number: int, count: int) -> np.ndarray:
    """Return readings of further tests, (count, 4)."""
    random, found = np.random.default_rng((seed, number)), list[Reading]()
    while len(found) < count:
        values = {
            name: float(prior.quantile(np.array([random.random()]))[0])
            for name, prior in of.priors.items()
        }
        if is_allowed(of.slider, values):
            found.append(read_finely(change(of.slider, values)))
    return np.array(found)


def inside(found: Budget, others: np.ndarray) -> tuple[float, ...]:
    """Return the share of further tests in each interval that is wider than it is printed."""
    shares = []
    for (low, high), count, its in zip(found.intervals.T, found.counts, others.T, strict=True):
        values = its[np.isfinite(its)]
        told = count >= ENOUGH and high - low > PRINTED * abs(high)
        held = np.mean((values >= low) & (values <= high)) if len(values) >= ENOUGH else nan
        shares.append(float(held) if told else nan)
    return tuple(shares)


def about(slider: st.Slider, found: Budget) -> tuple[float, float]:
    """Return the mean errors of the static coefficient below and above the stated alignment."""
    angle = found.alignment.angle
    if isnan(angle):
        return nan, nan
    aligned = read_finely(turn_to(slider, 0.0)).static
    means = []
    for ends in ((angle / SIDE, angle), (angle, angle * SIDE)):
        angles = np.copysign(np.geomspace(*ends, TRIED), slider.misalignment).tolist()
        static = np.array([read_finely(turn_to(slider, each)).static for each in angles])
        means.append(float(np.nanmean(abs(static / aligned - 1.0))))
    return means[0], means[1]


def look(seed: int, count: int, number: int) -> Seen:
    """Hold one budget against brute force."""
    slider, draw = rig(seed, number), Draw(seed + 1, number)
    if slider.phi == 0.0:
        slider = slider.replace(phi="1 deg")
    of = st.Rig.from_toml(st.Rig(slider, priors_of(slider, draw)).to_toml())  # within their ranges
    what = f"{type(slider.law).__name__}, {', '.join(of.priors)}"
    found = budget(of, silent)
    if np.isfinite(found.drawn[:, 0]).sum() < ENOUGH:
        return Seen(number, f"{what}: too long", (nan,) * 4, nan, nan)
    return Seen(
        number, what, inside(found, further(of, seed, number, count)), *about(of.slider, found)
    )


def main() -> int:
    """Hold budgets of random rigs against brute force."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--rigs", type=int, default=20)
    parser.add_argument("--tests", type=int, default=120, help="further tests of each")
    parser.add_argument("--processes", type=int, default=2)
    given = parser.parse_args()
    seen = list[Seen]()
    with ProcessPoolExecutor(given.processes) as pool:
        for each in pool.map(partial(look, given.seed, given.tests), range(given.rigs)):
            seen.append(each)
            shares = " ".join(f"{share:5.2f}" for share in each.inside)
            print(
                f"{each.number:4} {shares}  {each.below:7.4f} {each.above:7.4f}  {each.what}",
                flush=True,
            )
    return summary(seen, given.tests)


def summary(seen: list[Seen], tests: int) -> int:
    """Print the shares in the mean over rigs; return 1 if one, or an angle, is off.

    A share by three errors; an angle where the mean error beside it is, by `NEAR`.
    """
    status, shares = 0, np.array([each.inside for each in seen])
    for name, column in zip(Reading._fields, shares.T, strict=True):
        known = column[np.isfinite(column)]
        if not len(known):
            continue
        # of the interval, known from 64 tests, and of the share, known from some more
        error = sqrt(STATED * (1.0 - STATED) * (1.0 / 64 + 1.0 / tests) / len(known))
        off = abs(known.mean() - STATED) > 3.0 * error
        status |= int(off)
        print(f"{name}: {known.mean():.3f} of tests in the 95 % column, {len(known)} rigs")
    below = np.array([each.below for each in seen])
    above = np.array([each.above for each in seen])
    told = np.isfinite(below)
    good = (below[told] < NEAR * ALLOWED) & (above[told] > ALLOWED / NEAR)
    print(f"alignment: {good.sum()} of {told.sum()} hold within a factor {NEAR}")
    return status | int(not good.all())


if __name__ == "__main__":
    sys.exit(main())
