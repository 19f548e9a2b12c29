"""``python -m benchmarks.explore.records``: cycles and kinds of motion on hundreds of records.

Labelled records (hum, few samples, wild samples, vibrations, noise) tell how often count and kind
are right, and whether the confidence keeps what it promises: of the claims of each confidence so
many are right. Deterministic in its seed.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from itertools import pairwise
from math import pi
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from rich.console import Console
from rich.table import Table
from scipy.signal import lfilter  # type: ignore[attr-defined]

import stiction as st
from stiction.analysis.motion.regime.classify import classify_record
from stiction.analysis.motion.regime.kinds import (
    HARMONIC,
    IRREGULAR,
    SETTLING,
    STEADY,
    STICK_SLIP,
    STUCK,
    TRANSITIONAL,
    UNDETERMINED,
)

Floats = NDArray[np.float64]
Labelled = tuple[st.Record, int | None, tuple[str, ...]]  # with its count, if known, and its kinds
BINS = (0.0, 0.5, 0.7, 0.9, 0.97, 1.01)  # of confidence
CHANGES = 0.6  # of a filter's width times the number of periods: heights change in the record


def sawtooth(
    random: np.random.Generator, count: int, period: float, differ: float = 0.05
) -> tuple[Floats, Floats]:
    """Return corners of a sawtooth whose periods and drops differ by a share each way."""
    lengths = period * random.uniform(1.0 - differ, 1.0 + differ, count)
    ends = np.cumsum(lengths)
    time = np.stack([ends - 0.06 * lengths, ends], axis=1).ravel()
    trough = 1.0 - random.uniform(1.0 - differ, 1.0 + differ, count)
    return time, np.stack([np.ones(count), trough], axis=1).ravel()


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


def mains(random: np.random.Generator, time: Floats) -> Floats:
    """Return hum of the mains with two harmonics, of amplitude 1."""
    turns = random.choice([50.0, 60.0]) + random.uniform(-0.1, 0.1)
    phase = 2 * pi * turns * time
    line = np.sin(phase + random.uniform(0, 6))
    for harmonic in (2, 3):
        line += random.uniform(0, 0.4) * np.sin(harmonic * phase + random.uniform(0, 6))
    return np.asarray(line)


def hum_over_loading(random: np.random.Generator) -> Labelled:
    """Return a first loading, straight or bent, and steady sliding after it, under mains hum."""
    duration, rate = 10 ** random.uniform(0.3, 1.3), 10 ** random.uniform(np.log10(400), 4)
    time = np.arange(0.0, duration, 1.0 / rate)
    loaded = random.uniform(0.15, 0.5) * duration
    bent = 1.0 - np.exp(-3.0 * time / loaded)
    force = bent if random.random() < 0.5 else np.minimum(time / loaded, 1.0)
    if random.random() < 0.5:  # static friction is larger
        since = np.maximum(time - loaded, 0.0) / (0.02 * duration)
        force = force - random.uniform(0, 0.2) * (1.0 - np.exp(-since))
    height = 10 ** random.uniform(-2.3, -0.7)
    noise = 0.5 * 10 ** random.uniform(-2, 0) * random.normal(size=len(time))
    force += height * (mains(random, time) + noise)
    return st.Record(time=time, force=10 ** random.uniform(-2, 2) * force), 0, (STEADY, SETTLING)


def random_times(random: np.random.Generator) -> Labelled:
    """Return stick-slip with mains hum, sampled at random times."""
    period, rate = 10 ** random.uniform(-0.5, 0.3), 10 ** random.uniform(2.7, 4)
    corners = sawtooth(random, int(random.integers(12, 40)), period)
    time, _, count = between(corners, rate)
    if random.random() < 0.5:
        time = np.sort(random.uniform(time[0], time[-1], len(time)))
    else:
        steps = np.cumsum(random.gamma(random.uniform(0.7, 3.0), 1.0, len(time)))
        time = time[0] + (time[-1] - time[0]) * (steps - steps[0]) / (steps[-1] - steps[0])
    noise = 10 ** random.uniform(-3, -1.3) * random.normal(size=len(time))
    hum = 0.5 * 10 ** random.uniform(-1.3, 0) * mains(random, time)
    force = 2.0 + np.interp(time, *corners) + hum + noise
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


def filter_noise(random: np.random.Generator, periods: float, samples: float) -> Floats:
    """Return noise through a filter of 2 to 20 % of its frequency, of standard deviation 1.

    The filter is wide enough for the height to change in the record: it is else one of a size.
    """
    width = 10 ** random.uniform(max(-1.7, np.log10(CHANGES / periods)), -0.7)
    size = int(periods * samples)
    lead = int(2.0 * samples / width)  # until the filter has forgotten how it began
    pole = np.exp((2j - width) * pi / samples)
    rung = lfilter([1.0], [1.0, -2.0 * pole.real, abs(pole) ** 2], random.normal(size=size + lead))
    return np.asarray(rung[lead:] / rung.std())


def narrow(random: np.random.Generator, periods: float) -> Labelled:
    """Return noise through a narrow filter, on a force that moves slowly, under white noise."""
    pitch, samples = 10 ** random.uniform(0.5, 2.5), 10 ** random.uniform(0.7, 2.6)
    force = filter_noise(random, periods, samples)
    time = np.arange(len(force)) / (pitch * samples)
    turn = random.uniform(1, 2 * pi) * time / time[-1] + random.uniform(0, 6)
    slow = random.uniform(0, 5) * np.sin(turn)
    noise = 10 ** random.uniform(-1.8, -1) * random.normal(size=len(time))
    return st.Record(time=time, force=20.0 + force + slow + noise), None, (IRREGULAR,)


def short(random: np.random.Generator) -> Labelled:
    """Return thirty periods of irregular vibration."""
    return narrow(random, 30.0)


def long(random: np.random.Generator) -> Labelled:
    """Return a hundred periods of irregular vibration, and more."""
    return narrow(random, random.uniform(100.0, 400.0))


def wandering(random: np.random.Generator) -> Labelled:
    """Return irregular vibration beside a random walk that goes as far in a period, or less."""
    samples = 10 ** random.uniform(0.9, 2)
    force = filter_noise(random, random.uniform(30.0, 400.0), samples)
    time = np.arange(len(force)) / (48.0 * samples)
    walk = np.cumsum(random.normal(size=len(time))) / np.sqrt(samples)
    noise = 10 ** random.uniform(-1.8, -1) * random.normal(size=len(time))
    force += 10 ** random.uniform(-1, 0) * walk + noise
    return st.Record(time=time, force=20.0 + force), None, (IRREGULAR,)


def sliding(random: np.random.Generator) -> Labelled:
    """Return steady sliding under noise: white, filtered, or a walk that stays near its mean."""
    size = int(10 ** random.uniform(2.7, 4.3))
    noise = random.normal(size=2 * size)
    for _ in range(int(random.integers(0, 3))):  # each pole falls off by 6 dB an octave
        noise = lfilter([1.0], [1.0, -np.exp(-(10 ** random.uniform(-2.5, 0)))], noise)
        noise /= noise.std()
    force = 2.0 + 0.1 * noise[size:] + 10 ** random.uniform(-3, -1) * random.normal(size=size)
    return st.Record(time=1e-3 * np.arange(size), force=force), 0, (STEADY,)


def brief_vibration(random: np.random.Generator) -> Labelled:
    """Return ten to thirty periods of irregular vibration."""
    return narrow(random, random.uniform(10.0, 30.0))


def brief_harmonic(random: np.random.Generator) -> Labelled:
    """Return four to thirty periods of a harmonic vibration, growing or not, that drifts or not."""
    turns, rate = random.uniform(4, 30), 10 ** random.uniform(1.1, 2.5)
    phase = np.arange(int(turns * rate)) / rate
    force = np.sin(2 * pi * phase + random.uniform(0, 6))
    force *= 1 + random.uniform(0, 0.5) * phase / turns
    force += random.uniform(0, 0.1) * random.normal(size=len(phase)) + random.choice(
        [0.0, random.uniform(-1, 1)]
    ) * (phase / turns)
    return st.Record(time=phase / 10 ** random.uniform(0, 2), force=3.0 + force), None, (HARMONIC,)


def brief_slips(random: np.random.Generator) -> Labelled:
    """Return three to thirty cycles of stick-slip under noise."""
    rate = 10 ** random.uniform(1.7, 3)
    time, force, count = between(sawtooth(random, int(random.integers(6, 33)), 1.0), rate)
    noise = 10 ** random.uniform(-3, -1.3) * random.normal(size=len(time))
    return st.Record(time=time, force=2.0 + force + noise), count, (STICK_SLIP,)


def settling(random: np.random.Generator) -> Labelled:
    """Return a vibration that decays to less than a tenth, in thirty periods or fewer."""
    turns, rate = random.uniform(5, 30), 10 ** random.uniform(1.1, 2.5)
    phase = np.arange(int(turns * rate)) / rate
    decay = random.uniform(2.5, 6.0) / turns
    force = np.exp(-decay * phase) * np.sin(2 * pi * phase + random.uniform(0, 6))
    force += 10 ** random.uniform(-3, -1.3) * random.normal(size=len(phase))
    return st.Record(time=phase / 10 ** random.uniform(0, 2), force=3.0 + force), 0, (SETTLING,)


def loading(random: np.random.Generator) -> Labelled:
    """Return a spring that is loaded, without a slip."""
    time = np.linspace(0.0, 1.0, int(10 ** random.uniform(1.8, 4)))
    force = 2.0 * time - random.uniform(0, 0.3) * time**2
    force += 10 ** random.uniform(-3, -1.7) * random.normal(size=len(time))
    return st.Record(time=time, force=force), 0, (STUCK,)


def on_a_wave(random: np.random.Generator, differ: float = 0.05) -> Labelled:
    """Return stick-slip on a slower wave, up to 30 times as high as its drops; half with hum."""
    drop, period = 10 ** random.uniform(-1.5, 0), 10 ** random.uniform(-1, 0.3)
    rate = max(10 ** random.uniform(1.6, 2.7) / period, 300.0)
    corners = sawtooth(random, int(random.integers(30, 200)), period, differ)
    time, force, count = between(corners, rate)
    turns = time / (period * random.uniform(3, 30)) + random.uniform()
    wave = np.sin(2 * pi * turns) + random.uniform(0, 0.5) * np.sin(4 * pi * turns + 1.0)
    force = drop * force + 0.5 * wave + 2.0
    force += drop * 10 ** random.uniform(-3, -1.3) * random.normal(size=len(time))
    if random.integers(2):
        force += 10 ** random.uniform(-2, -0.5) * drop * mains(random, time)
    return st.Record(time=time, force=force), count, (STICK_SLIP,)


def irregular_on_a_wave(random: np.random.Generator) -> Labelled:
    """Return stick-slip on a wave, of drops and periods that differ by up to 50 % each way."""
    record, _, kinds = on_a_wave(random, random.uniform(0.1, 0.5))
    return record, None, kinds


def in_noise(random: np.random.Generator, least: float = -0.5, differ: float = 0.05) -> Labelled:
    """Return stick-slip under noise whose standard deviation is 0.3 to 1 times its drops.

    `least` is the logarithm of the lower of these two.
    """
    period = 10 ** random.uniform(-1, 0.3)
    count, per_cycle = int(random.integers(20, 60)), 10 ** random.uniform(1.7, 3)
    time, force, _ = between(sawtooth(random, count, period, differ), per_cycle / period)
    force += 2.0 + 10 ** random.uniform(least, 0) * random.normal(size=len(time))
    return st.Record(time=time, force=force), None, (STICK_SLIP, TRANSITIONAL, HARMONIC)


def irregular_in_noise(random: np.random.Generator) -> Labelled:
    """Return stick-slip of drops and periods that differ by up to 50 % each way, under noise.

    Its standard deviation is 0.1 to 1 times the drops.
    """
    return in_noise(random, -1.0, random.uniform(0.1, 0.5))


def irregular_few_samples(random: np.random.Generator) -> Labelled:
    """Return irregular stick-slip of 5 to 40 samples a cycle, in noise up to 0.3 of its drops."""
    count, per_cycle = int(random.integers(12, 80)), 10 ** random.uniform(0.7, 1.6)
    time, force, _ = between(sawtooth(random, count, 1.0, random.uniform(0.1, 0.5)), per_cycle)
    force += 2.0 + 10 ** random.uniform(-2.5, -0.5) * random.normal(size=len(time))
    return st.Record(time=time, force=force), None, (STICK_SLIP, TRANSITIONAL)


def irregular_in_steps(random: np.random.Generator) -> Labelled:
    """Return irregular stick-slip whose drops are 3 to 20 steps of a converter."""
    corners = sawtooth(random, int(random.integers(12, 80)), 1.0, random.uniform(0.1, 0.5))
    time, force, count = between(corners, 10 ** random.uniform(1.5, 2.7))
    force += 10 ** random.uniform(-3, -1.5) * random.normal(size=len(time))
    step = 10 ** random.uniform(-1.3, -0.5)
    return st.Record(time=time, force=step * np.rint((2.0 + force) / step)), count, (STICK_SLIP,)


def brief_sliding(random: np.random.Generator) -> Labelled:
    """Return 64 to 500 samples of steady sliding under white or filtered noise."""
    size = int(10 ** random.uniform(1.8, 2.7))
    noise = random.normal(size=2 * size)
    for _ in range(int(random.integers(0, 2))):
        noise = lfilter([1.0], [1.0, -np.exp(-(10 ** random.uniform(-1, 0)))], noise)
    force = 2.0 + 0.1 * noise[size:] / noise.std()
    return st.Record(time=1e-3 * np.arange(size), force=force), 0, (STEADY,)


def varying_load(random: np.random.Generator, time: Floats) -> Floats:
    """Return a load over its mean that varies by 3 to 40 %: smoothly, at random, or by jumps."""
    period, phase = time[-1] * random.uniform(0.03, 0.35), random.uniform(0, 6)
    turns = 2 * pi * time / period + phase
    kind = random.integers(4)
    if kind == 0:
        wave = np.sin(turns) + random.uniform(0, 0.6) * np.sin(1.73 * turns)
    elif kind == 1:
        pole = np.exp(-4.0 * time[1] / period)
        wave = lfilter([1.0], [1.0, -pole], random.normal(size=len(time)))
        wave -= wave.mean()
    else:
        wave = turns / pi % 2 - 1 if kind == 2 else np.sign(np.sin(turns))
    return 1.0 + 0.5 * random.uniform(0.03, 0.4) * wave / np.abs(wave).max()


def sliding_under_load(random: np.random.Generator) -> Labelled:
    """Return sliding under a measured load that varies, after a loading or not."""
    time = np.linspace(0.0, 60.0, int(10 ** random.uniform(3, 4.3)))
    load, noise = varying_load(random, time), 10 ** random.uniform(-3.5, -2.3, 2)
    force = load.copy()
    if random.integers(2):
        force = np.minimum(force, time / random.uniform(1, 8))
    if random.integers(2):
        force += random.uniform(-0.15, 0.15)  # a zero that is not known, or adhesion
    force += noise[0] * random.normal(size=len(time))
    load += noise[1] * random.normal(size=len(time))
    coefficient = random.uniform(0.1, 0.8)
    record = st.Record(time=time, force=coefficient * force, load=load)
    return record, 0, (STEADY, SETTLING)


LABELLED: tuple[Callable[[np.random.Generator], Labelled], ...] = (
    hum, few_samples, wild_slips, wild_sliding, irregular, harmonic, short, long, wandering,
    sliding, brief_vibration, brief_harmonic, brief_slips, settling, loading, brief_sliding,
    hum_over_loading, random_times, on_a_wave, irregular_on_a_wave, in_noise,
    irregular_in_noise, irregular_few_samples, irregular_in_steps, sliding_under_load,
)  # fmt: skip


class Judged(NamedTuple):
    """One record: whether count and kind are right, what kind was seen, how sure."""

    counted: bool
    right: bool
    kind: str
    confidence: float

    @property
    def wrong(self) -> bool:
        """Whether a claim is wrong; what is undetermined claims nothing."""
        return not self.right and self.kind != UNDETERMINED


def judge(make: Callable[[np.random.Generator], Labelled], seed: int, number: int) -> Judged:
    """Draw a record and judge what is seen of it."""
    record, count, kinds = make(np.random.default_rng([seed, number]))
    _, seen, motion = classify_record(record)
    counted = count is None or abs(seen.cycles.sizes["cycle"] - count) <= 1
    return Judged(counted, motion.kind in kinds, motion.kind, motion.confidence)


def calibration(found: list[Judged]) -> Table:
    """Return how many claims of each confidence are right."""
    table = Table("confidence", "claims", "right", "mean confidence")
    claims = [each for each in found if each.kind != UNDETERMINED]
    for low, high in pairwise(BINS):
        inside = [each for each in claims if low <= each.confidence < high]
        if inside:
            right = np.mean([each.right for each in inside])
            sure = np.mean([each.confidence for each in inside])
            row = f"{low:g} to {min(high, 1.0):g}", f"{len(inside)}", f"{right:.1%}", f"{sure:.2f}"
            table.add_row(*row)
    return table


def main() -> None:
    """Print how often counts and kinds are right, and how sure."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.explore.records")
    names = [make.__name__ for make in LABELLED]
    parser.add_argument("--records", type=int, default=200, help="of each sort")
    parser.add_argument("--only", nargs="+", default=names, choices=names, metavar="SORT")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    console, everything = Console(), []
    table = Table("records", "count right", "kind right", "mean confidence", "wrong claims")
    for make in LABELLED:
        if make.__name__ not in options.only:
            continue
        found = [judge(make, options.seed, number) for number in range(options.records)]
        everything += found
        wrong = [f"{n} ({each.confidence:.2f})" for n, each in enumerate(found) if each.wrong]
        table.add_row(
            make.__name__.replace("_", " "),
            f"{sum(each.counted for each in found)}",
            f"{sum(each.right for each in found)} of {len(found)}",
            f"{np.mean([each.confidence for each in found]):.2f}",
            ", ".join(wrong),
        )
    console.print(table)
    console.print(calibration(everything))


if __name__ == "__main__":
    main()
