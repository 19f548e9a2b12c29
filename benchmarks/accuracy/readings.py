"""Fits of records as they are measured: thousands of readings a cycle, digitised.

``python -m benchmarks.accuracy.readings --block 4 --digit 0.01 --noise 0.3``: the force of
simulated records with that many readings in place of one, each with noise (in steps of the digit)
and rounded (to this share of the friction force at rest), goes the way of a measured one: noise and
rounding are estimated, readings averaged. It is held against a library of simulations under the
conditions found so: coverage, ranks, and how many are called unlike the rig's, 5 % as stated.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from functools import partial

import numpy as np
from numpy.typing import NDArray

import stiction as st
from benchmarks.accuracy.fits import RIGS, compare, report, rig_of
from stiction.inference.cycles import Cycles, slip_cycles
from stiction.inference.features import features
from stiction.inference.learning.calibration import learn_or_read
from stiction.inference.observation import (
    Conditions,
    Noise,
    block_means,
    observe,
    readings_to_simulate,
)
from stiction.inference.rig import Rig
from stiction.inference.simulated.library import Library, build
from stiction.inference.simulated.plan import Plan, plan
from stiction.inference.simulated.synthetic import draw
from stiction.recording.sensor import digitise
from stiction.study.execution.cores import Cores

Floats = NDArray[np.float64]


def read(
    of: Plan, digit: float, seed: int, number: int, _: Callable[[], bool]
) -> tuple[Floats, Floats] | None:
    """Return the scores of a simulated record, and its readings."""
    scores, made = draw(of, number, seed)
    record = next(made)
    return None if record is None else (scores, digitise(record.channels["force"], digit))


def features_of(force: Floats, rig: Rig, conditions: Conditions, block: int) -> Floats | None:
    """Return the features of readings as a fit takes them; None with too few cycles."""
    means = block_means(force, block)
    found = slip_cycles(means, conditions.noise["force"].error)
    if len(found.peak) < conditions.cycles:
        return None
    last = Cycles(*(each[-conditions.cycles :] for each in found))
    return features(conditions.step, {"force": means}, conditions.scale(rig.slider), last)


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rig", choices=RIGS, default="pin on plate", metavar="NAME")
    parser.add_argument("--block", type=int, default=4, help="readings in place of one of 200")
    parser.add_argument("--digit", type=float, default=0.01, help="over the friction force")
    parser.add_argument("--noise", type=float, default=0.3, help="digits; of a hundredth if none")
    parser.add_argument("--records", type=int, default=330)
    parser.add_argument("--simulations", type=int, default=1500)
    parser.add_argument("--seed", type=int, default=77)
    options = parser.parse_args()
    rig, usual = rig_of(options.rig)
    friction = rig.slider.F_0
    digit, noise = options.digit * friction, options.noise * (options.digit or 0.01) * friction
    filters = usual.noise["force"].filters
    its = {"force": Noise(noise, filters=filters)}
    fine = usual._replace(noise=its, step=usual.step / options.block)
    of = plan(rig.slider, rig.priors, [fine])
    work = partial(read, of, digit, options.seed)
    made = [each for each in Cores().results(work, range(options.records)) if each is not None]
    first = made[0][1]
    time = fine.step * np.arange(len(first))
    velocity = abs(rig.slider.motion.rate(0.0)[0])
    filtered = {"filter": filters[0].cut, "filter_order": filters[0].order} if filters else {}
    cell = {"force": st.Sensor(**filtered)}
    record = st.Record(time=time, force=first, drive_velocity=velocity, sensors=cell)
    seen = observe(record, rig.slider).conditions
    block = readings_to_simulate(options.block, seen.noise)
    conditions = usual._replace(noise=seen.noise, block=block)
    print(f"{options.rig}: {seen.noise}")
    known = build(plan(rig.slider, rig.priors, [conditions]), options.simulations, None)
    rows = [
        (scores, its)
        for scores, force in made
        if (its := features_of(force, rig, conditions, options.block)) is not None
    ]
    scores, found = (np.array(each) for each in zip(*rows, strict=True))
    unseen = Library(known.plan, scores, found, len(rows))
    learned = learn_or_read(known.features, known.scores)
    print(f"   {len(rows)} records")
    report(compare(known, learned, unseen, unseen.features))


if __name__ == "__main__":
    main()
