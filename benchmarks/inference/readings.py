"""Fits of records as they are measured: thousands of readings a cycle, digitised.

``python -m benchmarks.inference.readings --block 4 --digit 0.01 --noise 0.3``: the force of
simulated records with that many readings in place of one, each with noise (in steps of the digit)
and rounded (to this share of the friction force at rest), goes the way of a measured one: noise and
rounding are estimated, readings averaged. It is held against a library of simulations under the
noise found so, that of the middle one of eleven: coverage, ranks, and how many are called unlike
the rig's, 5 % as stated.
``--hum 0.01`` adds a line of 50 Hz, which wanders, and its third harmonic; ``--spikes 5`` that many
wild readings; ``--lasting 0.005 --lasts 5`` noise that lasts for five readings.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import stiction as st
from benchmarks.inference.fits import RIGS, compare, report, rig_of
from stiction.analysis.motion.cycles import swings
from stiction.analysis.signals.hum import without_bands
from stiction.analysis.signals.robust import block_means
from stiction.inference.cycles import Cycles, slip_cycles
from stiction.inference.features import features
from stiction.inference.learning.calibration import learn_or_read
from stiction.inference.observation import (
    Conditions,
    Noise,
    grid_of,
    noise_of,
    readings_to_simulate,
    thin_out,
    without_lines,
)
from stiction.inference.rig import Rig
from stiction.inference.simulated.library import Library, build
from stiction.inference.simulated.plan import Plan, plan
from stiction.inference.simulated.synthetic import draw
from stiction.recording.coloured_noise import draw_lasting
from stiction.recording.sensor import digitise
from stiction.study.execution.cores import Cores

Floats = NDArray[np.float64]

SEEN = 11  # records of which one tells the noise of all

# Hz; the phase of the mains wanders by so many turns within this time (s), 0.02 Hz at most, and
# they have a third harmonic of this share
MAINS, WANDER, PERIOD, THIRD = 50.0, 0.1, 30.0, 0.3


class Disturbance(NamedTuple):
    """What is added to readings: hum (amplitude), so many spikes, and noise that lasts (readings).

    Hum, spikes and the noise's standard deviation in N.
    """

    hum: float
    spikes: int
    spike: float
    lasting: float
    lasts: float

    def of(self, step: float, size: int, random: np.random.Generator) -> Floats:
        """Return its readings, a step (s) apart."""
        time = step * np.arange(size)
        turns = MAINS * time + WANDER * np.sin(2.0 * np.pi * time / PERIOD + random.uniform(0, 6))
        first, third = random.uniform(0.0, 2.0 * np.pi, 2)
        found: Floats = np.sin(2.0 * np.pi * turns + first)
        found += THIRD * np.sin(6.0 * np.pi * turns + third)
        found *= self.hum
        found += draw_lasting(size, self.lasting, self.lasts, random)
        found[random.choice(size, self.spikes, replace=False)] += self.spike
        return found


def read(
    of: Plan, digit: float, added: Disturbance, seed: int, number: int, _: Callable[[], bool]
) -> tuple[Floats, Floats] | None:
    """Return the scores of a simulated record, and its readings."""
    scores, made = draw(of, number, seed)
    record = next(made)
    if record is None:
        return None
    force = record.channels["force"]
    more = added.of(of.conditions[0].step, len(force), np.random.default_rng([seed, number, 1]))
    return scores, digitise(force + more, digit)


def noise_seen(record: st.Record, block: int) -> Noise:
    """Return the noise of means of blocks of a record, as a fit sees it."""
    grid = grid_of(record, "it")
    channels = without_lines(record, grid, swings(record))
    noise = {name: noise_of(record, name, *its) for name, its in channels.items()}
    return thin_out(channels, noise, grid.step, block).noise["force"]


def features_of(record: st.Record, rig: Rig, conditions: Conditions, block: int) -> Floats | None:
    """Return the features of readings as a fit takes them; None with too few cycles."""
    force = without_lines(record, grid_of(record, "it"), swings(record))["force"].values
    bands = conditions.noise["force"].stop_bands
    means = without_bands(block_means(force, block), conditions.step, bands)
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
    parser.add_argument("--hum", type=float, default=0.0, help="over the friction force")
    parser.add_argument("--spikes", type=int, default=0, help="in a record, of half of it")
    parser.add_argument("--lasting", type=float, default=0.0, help="over the friction force")
    parser.add_argument("--lasts", type=float, default=5.0, help="readings")
    parser.add_argument("--records", type=int, default=330)
    parser.add_argument("--simulations", type=int, default=1500)
    parser.add_argument("--seed", type=int, default=77)
    options = parser.parse_args()
    rig, usual = rig_of(options.rig)
    friction = rig.slider.F_0
    digit, noise = options.digit * friction, options.noise * (options.digit or 0.01) * friction
    filters = usual.noise["force"].filters
    its = {"force": Noise(noise, filters=filters)}
    added = Disturbance(
        options.hum * friction,
        options.spikes,
        0.5 * friction,
        options.lasting * friction,
        options.lasts,
    )
    fine = usual._replace(noise=its, step=usual.step / options.block)
    of = plan(rig.slider, rig.priors, [fine])
    work = partial(read, of, digit, added, options.seed)
    made = [each for each in Cores().results(work, range(options.records)) if each is not None]
    made.sort(key=lambda each: each[0].tolist())  # they come in any order
    velocity = rig.slider.drive_speed
    filtered = {"filter": filters[0].cut, "filter_order": filters[0].order} if filters else {}
    cell = {"force": st.Sensor(**filtered)}

    def record(force: Floats) -> st.Record:
        time = fine.step * np.arange(len(force))
        return st.Record(time=time, force=force, drive_velocity=velocity, sensors=cell)

    seen = [noise_seen(record(force), options.block) for _, force in made[:SEEN]]
    seen.sort(key=lambda its: (len(its.stop_bands), its.lasting, its.lasts, its.level))
    typical = {"force": seen[len(seen) // 2]}
    block = readings_to_simulate(options.block, typical)
    conditions = usual._replace(noise=typical, block=block)
    print(f"{options.rig}: {typical}")
    known = build(plan(rig.slider, rig.priors, [conditions]), options.simulations, None)
    rows = [
        (scores, its)
        for scores, force in made
        if (its := features_of(record(force), rig, conditions, options.block)) is not None
    ]
    scores, found = (np.array(each) for each in zip(*rows, strict=True))
    unseen = Library(known.plan, scores, found, len(rows))
    learned = learn_or_read(known.features, known.scores)
    print(f"   {len(rows)} records")
    report(compare(known, learned, unseen, unseen.features))


if __name__ == "__main__":
    main()
