"""``python -m benchmarks.explore.cycles``: cycles and kinds of motion on hundreds of records.

Random rigs that stick and slip are held against a plain count of the falls of half the swing, by
`st.find_cycles` and by what a study sees. Labelled records (hum, few samples, wild samples,
vibrations) tell how often count and kind are right, and what confidence was given. Deterministic
in its seed.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator
from math import pi, sqrt

import numpy as np
from numpy.typing import NDArray
from rich.console import Console
from rich.table import Table

import stiction as st
from stiction.analysis.cycles import swings
from stiction.analysis.regime import HARMONIC, IRREGULAR, STEADY, STICK_SLIP, regime_of
from stiction.study.features import zigzag
from stiction.study.observed import observe

Floats = NDArray[np.float64]
Labelled = tuple[st.Record, int | None, tuple[str, ...]]  # with its count, if known, and its kinds


def rig(random: np.random.Generator) -> tuple[st.Slider, float]:
    """Return an apparatus that probably sticks and slips, and how long to look at it."""
    mass, k_x = 10 ** random.uniform(-2, 0), 10 ** random.uniform(2.5, 4.3)
    k_y, load = k_x * 10 ** random.uniform(1.5, 4), 10 ** random.uniform(-0.3, 1.7)
    mu_0 = random.uniform(0.2, 0.8)
    mu_inf = mu_0 * random.uniform(0.6, 0.95)
    v_f, phi = 10 ** random.uniform(-3, -1.5), random.uniform(0.0, 6.0)
    period = 2 * pi * sqrt(mass / k_x) * 10 ** random.uniform(0.3, 1.7)
    velocity = 2 * (mu_0 - mu_inf) * load / k_x / period
    slider = st.Slider(
        mass=mass, k_x=k_x, k_y=k_y, phi=f"{phi} deg", normal_load=load,
        friction=st.ExponentialWeakening(mu_0=mu_0, mu_inf=mu_inf, v_f=v_f),
        drive=st.ConstantVelocity(velocity),
    )  # fmt: skip
    return slider, mu_0 * load / k_x / velocity + 14 * period


def rigs(count: int, seed: int) -> Iterator[tuple[int, int, int, tuple[float, float, float]]]:
    """Yield the cycles of each rig in stick-slip: half falls, analysis, study; and the periods."""
    random, done = np.random.default_rng(seed), 0
    while done < count:
        slider, duration = rig(random)
        if sqrt(slider.k_y / slider.mass) * duration > 1.5e7:
            continue
        rate = min(400 * sqrt(slider.k_x / slider.mass) / (2 * pi), 1e6 / duration)
        run = st.simulate(slider, duration, sample_rate=rate)
        record = st.record_of(run)
        if st.classify(record).kind != STICK_SLIP:
            continue
        done += 1
        time, force = record.time, record.force
        turns = zigzag(force, 0.5 * float(np.ptp(force[len(force) // 3 :])))
        turns = turns[0 if force[turns[0]] < force[turns[1]] else 1 :]
        half = (len(turns) - 1) // 2
        period = float(time[turns[2 * half]] - time[turns[0]]) / half
        found = st.find_cycles(record)
        seen = observe(
            st.Description(slider, st.Initial(), st.Settings(duration=duration)), None
        ).swings
        yield (
            half,
            found.sizes["cycle"],
            len(seen.drop),
            (period, float(found["period"].mean()), float(seen.period.mean())),
        )


def sawtooth(random: np.random.Generator, count: int, period: float) -> tuple[Floats, Floats]:
    """Return corners of a sawtooth whose periods and drops differ by 5 % each way."""
    lengths = period * random.uniform(0.95, 1.05, count)
    ends = np.cumsum(lengths)
    time = np.stack([ends - 0.06 * lengths, ends], axis=1).ravel()
    force = np.stack([np.ones(count), 1.0 - random.uniform(0.95, 1.05, count)], axis=1).ravel()
    return time, force


def between(corners: tuple[Floats, Floats], rate: float) -> tuple[Floats, Floats, int]:
    """Return samples from behind the second corner but one to before the last, and the count."""
    time, force = corners
    quarter = 0.25 * (time[3] - time[1])
    at = np.arange(time[1] + quarter, time[-1] - quarter, 1.0 / rate)
    return at, np.interp(at, time, force), len(time) // 2 - 3


def hum(random: np.random.Generator) -> Labelled:
    """Return stick-slip with mains hum of 0.1 to 2 times the drop, crest to trough."""
    period, rate = 10 ** random.uniform(-1, 0.3), 10 ** random.uniform(np.log10(500), 4)
    time, force, count = between(sawtooth(random, int(random.integers(12, 40)), period), rate)
    mains, wander = random.choice([50.0, 60.0]) + random.uniform(-0.1, 0.1), random.uniform(0, 0.05)
    turns = mains * time + wander * time[-1] / 8.0 * np.sin(8.0 * time / time[-1])
    line = np.sin(2 * pi * turns + random.uniform(0, 6))
    for harmonic in (2, 3):
        line += random.uniform(0, 0.4) * np.sin(2 * pi * harmonic * turns + random.uniform(0, 6))
    noise = 10 ** random.uniform(-3, -1) * random.normal(size=len(time))
    force = 2.0 + force + 10 ** random.uniform(-1.3, 0) * line + noise
    return st.Record(time=time, force=force), count, (STICK_SLIP,)


def few_samples(random: np.random.Generator) -> Labelled:
    """Return sixty cycles of four to seven samples each."""
    samples, fall = random.uniform(4, 7), random.uniform(0.02, 0.15)
    time = np.arange(int(61.5 * samples)) * 1e-2
    phase = (time / (1e-2 * samples) + random.uniform()) % 1.0
    force = np.where(phase < 1 - fall, phase / (1 - fall), (1 - phase) / fall)
    noise = 10 ** random.uniform(-4, -2) * random.normal(size=len(time))
    return st.Record(time=time, force=1.0 + force + noise), 60, (STICK_SLIP,)


def wild(random: np.random.Generator, size: int, least: float) -> Floats:
    """Return what a hundredth of wild samples adds, a third of them in pairs."""
    found = np.zeros(size)
    at = random.choice(size - 10, max(size // 100, 1), replace=False) + 5
    found[at] = random.choice([-1.0, 1.0], len(at)) * random.uniform(least, 3.0, len(at))
    found[at[::3] + 1] = found[at[::3]]
    return found


def wild_slips(random: np.random.Generator) -> Labelled:
    """Return stick-slip with wild samples."""
    period, rate = 10 ** random.uniform(-0.5, 0.3), 10 ** random.uniform(2.3, 4)
    time, force, count = between(sawtooth(random, int(random.integers(8, 25)), period), rate)
    noise = 10 ** random.uniform(-3, -1.7) * random.normal(size=len(time))
    force = 2.0 + force + noise + wild(random, len(time), 0.3)
    return st.Record(time=time, force=force), count, (STICK_SLIP,)


def wild_sliding(random: np.random.Generator) -> Labelled:
    """Return steady sliding with wild samples."""
    time = np.arange(int(10 ** random.uniform(2.7, 4.7))) * 1e-3
    force = 2.0 + 0.01 * random.normal(size=len(time)) + wild(random, len(time), 0.1)
    return st.Record(time=time, force=force), 0, (STEADY,)


def irregular(random: np.random.Generator) -> Labelled:
    """Return a vibration of changing height and period on a force that moves slowly."""
    pitch, count, spread = random.uniform(30, 80), int(random.integers(100, 400)), 0.45
    lengths = np.maximum(random.gamma(spread**-2, spread**2, count), 0.1) / pitch
    ends = np.concatenate([[0.0], np.cumsum(lengths)])
    time = np.arange(0.0, ends[-1], 1.0 / (random.uniform(20, 100) * pitch))
    phase = np.interp(time, ends, np.arange(count + 1))
    height = np.interp(phase - 0.5, np.arange(count), random.gamma(4.0, 0.25, count))
    slow = random.uniform(0, 6) * np.sin(2 * pi * time / time[-1] * random.uniform(0.5, 3))
    noise = 10 ** random.uniform(-3, -1.5) * random.normal(size=len(time))
    force = 20.0 + height * np.sin(2 * pi * phase) + slow + noise
    return st.Record(time=time, force=force), None, (IRREGULAR,)


def harmonic(random: np.random.Generator) -> Labelled:
    """Return a harmonic vibration, growing or not."""
    pitch, rate = 10 ** random.uniform(0, 2), 10 ** random.uniform(1.1, 2.5)
    turns = random.uniform(6, 200)
    phase = np.arange(int(turns * rate)) / rate
    force = np.sin(2 * pi * phase) * (1 + random.uniform(0, 0.5) * phase / turns)
    force += random.uniform(0, 0.1) * random.normal(size=len(phase))
    return st.Record(time=phase / pitch, force=3.0 + force), None, (HARMONIC,)


LABELLED: tuple[Callable[[np.random.Generator], Labelled], ...] = (
    hum, few_samples, wild_slips, wild_sliding, irregular, harmonic,
)  # fmt: skip


def main() -> None:
    """Print how often counts, periods and kinds are right."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.explore.cycles")
    parser.add_argument("--rigs", type=int, default=200)
    parser.add_argument("--records", type=int, default=200, help="of each sort")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    console = Console()
    found = list(rigs(options.rigs, options.seed))
    counts = sum(abs(n - half) <= 1 and abs(m - half) <= 1 for half, n, m, _ in found)
    near = sum(max(abs(p / a - 1) for p in (b, c)) < 0.01 for *_, (a, b, c) in found)
    same = sum(abs(c / b - 1) < 0.01 for *_, (_, b, c) in found)
    console.print(
        f"{len(found)} rigs in stick-slip: {counts} with the count of falls of half the swing "
        f"(but for one that an end cuts), {near} with its period to 1 %; analysis and study "
        f"agree to 1 % in {same}."
    )
    table = Table("records", "count right", "kind right", "mean confidence", "sure and wrong")
    for make in LABELLED:
        counted, right, sure, wrong = 0, 0, 0.0, 0
        for number in range(options.records):
            record, count, kinds = make(np.random.default_rng([options.seed, number]))
            seen = swings(record)
            motion = regime_of(record, seen)
            counted += count is None or abs(seen.cycles.sizes["cycle"] - count) <= 1
            right += motion.kind in kinds
            sure += motion.confidence / options.records
            wrong += motion.kind not in kinds and motion.confidence > 0.9
        row = (f"{counted}", f"{right} of {options.records}", f"{sure:.2f}", f"{wrong}")
        table.add_row(make.__name__.replace("_", " "), *row)
    console.print(table)


if __name__ == "__main__":
    main()
