"""``python -m benchmarks.explore.numbers``: whether two standard errors hold the truth.

Irregular stick-slip, whose drops differ by up to 50 % each way, under a drive of known velocity:
each number of its analysis that has an error is compared with the true one, and its warnings are
counted. Deterministic in its seed.
"""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Callable, Iterator
from functools import partial
from math import isnan, nan, pi
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from rich.console import Console
from rich.table import Table
from scipy.signal import bilinear, lfilter, lfilter_zi  # type: ignore[attr-defined]
from scipy.special import ndtr

import stiction as st
from stiction.analysis.motion.doubts.creep_distance import hidden_way

Floats = NDArray[np.float64]
LOAD = 10.0  # N
BEGINNING = 17  # characters of a warning, by which it is counted


class Known(NamedTuple):
    """A record, and the truth: of each cycle (n,), and of the apparatus."""

    record: st.Record
    peak: Floats
    trough: Floats
    peak_time: Floats
    crept: Floats
    drift: float


class Compared(NamedTuple):
    """A quantity as found, with its standard error and perhaps a lower bound, and as it is."""

    quantity: str
    found: float
    error: float
    true: float
    at_least: float = nan


def alike(random: np.random.Generator, count: int, correlation: float) -> Floats:
    """Return values between -1 and 1 of which neighbours are correlated."""
    noise = random.normal(size=count + 100)
    walk = lfilter([(1.0 - correlation**2) ** 0.5], [1.0, -correlation], noise)
    return np.asarray(2.0 * ndtr(walk[100:]) - 1.0)


def slips(
    random: np.random.Generator, *, cycles: tuple[int, int] = (12, 80), creep: float = 0.0,
    correlation: float = 0.0, drift: float = 0.0, step: float = 0.0,
    noise: tuple[float, float] = (-2.0, -0.52), samples: tuple[float, float] = (1.3, 3.0),
) -> Known:  # fmt: skip
    """Return irregular stick-slip of 20 to 1000 samples a cycle in noise of 1 to 30 % of a drop.

    At its peak a force creeps at a share `creep` of the drive's velocity. Drift over the record,
    and steps of a converter, are shares of the mean drop, `noise` powers of ten of it, and those
    of a cycle's `samples` powers of ten.
    """
    count, differ, at_peak = int(random.integers(*cycles)), *random.uniform((0.1, 0), (0.5, 0.7))
    stiffness, velocity = 10 ** random.uniform((2, -5), (4, -2.5))
    rate, drop = stiffness * velocity, 10 ** random.uniform(-1, 0.3)
    each = differ * drop * np.array([alike(random, count + 1, correlation) for _ in range(2)])
    peak, trough = 4.0 + at_peak * each[0], 4.0 - drop + (1.0 - at_peak) * each[1]
    rise, bend = peak[1:] - trough[:-1], random.uniform(0.05, 0.3) * drop
    # from dF/dt = k V (1 - creep exp((F - peak)/bend))
    loads = bend / rate * np.log((np.exp(rise / bend) - creep) / (1.0 - creep))
    fall = drop / rate * random.uniform(0.02, 0.1)
    ends = np.cumsum(loads + fall)
    mean = ends[-1] / count
    begin = 0.25 * loads[0]
    time = np.arange(begin, ends[-1] - fall - begin, mean / 10 ** random.uniform(*samples))
    at = np.searchsorted(ends, time)
    since = time - (ends - loads - fall)[at]
    rest = creep + (np.exp(rise / bend) - creep)[at] * np.exp(-rate * since / bend)
    falls = 0.5 + 0.5 * np.cos(pi * np.clip((since - loads[at]) / fall, 0.0, 1.0))
    low, high = trough[1:][at], peak[1:][at]
    loading = high - bend * np.log(np.maximum(rest, 1.0))
    force = np.where(since < loads[at], loading, low + (high - low) * falls)
    force += drop * 10 ** random.uniform(*noise) * random.normal(size=len(time))
    drifts = drift * drop * random.choice([-1.0, 1.0]) / time[-1]
    force += drifts * (time - begin)
    if step:
        force = step * drop * np.rint(force / step / drop)
    known = {"stiffness": stiffness, "drive_velocity": velocity, "normal_load": LOAD}
    record = st.Record(time=time, force=force, mass=stiffness * (fall / pi) ** 2, **known)
    crept = velocity * loads - rise / stiffness
    return Known(record, peak[1:], trough[1:], ends - fall, crept, drifts)


def cut_off(random: np.random.Generator) -> Known:
    """Return irregular stick-slip by a load cell whose range ends below most peaks."""
    known = slips(random, noise=(-3.0, -1.0))
    drop = float((known.peak - known.trough).mean())
    force = np.minimum(known.record.force, 4.0 - random.uniform(0.0, 0.5) * drop)
    return known._replace(record=known.record.model_copy(update={"force": force}))


def cut_off_in_noise(random: np.random.Generator) -> Known:
    """Return irregular stick-slip whose peaks an amplifier cuts off, before a converter's noise."""
    known = cut_off(random)
    force = known.record.force
    drop = float((known.peak - known.trough).mean())
    force = force + drop * 10 ** random.uniform(-4.0, -2.5) * random.normal(size=len(force))
    return known._replace(record=known.record.model_copy(update={"force": force}))


def settling(random: np.random.Generator) -> Known:
    """Return irregular stick-slip while the zero settles, by 0.1 to 2 drops in all."""
    known = slips(random)
    time, drop = known.record.time, float((known.peak - known.trough).mean())
    size = random.choice([-1.0, 1.0]) * drop * 10 ** random.uniform(-1.0, 0.3)
    lasts = random.uniform(0.1, 0.5) * (time[-1] - time[0])
    force = known.record.force + size * (1.0 - np.exp((time[0] - time) / lasts))
    return known._replace(record=known.record.model_copy(update={"force": force}), drift=nan)


def behind_filter(random: np.random.Generator) -> Known:
    """Return irregular stick-slip by a load cell with a low-pass filter that nobody stated."""
    known = slips(random, noise=(-3.0, -1.0))
    record = known.record
    assert record.stiffness is not None
    assert record.mass is not None
    swing = (record.stiffness / record.mass) ** 0.5 / (2.0 * pi)
    cut_off = swing * 10 ** random.uniform(-0.5, 1.0)
    cell = st.Sensor(bandwidth=min(cut_off, 0.3 * record.sample_rate))
    force = cell.response(record.force, record.sample_rate)
    return known._replace(record=record.model_copy(update={"force": force}))


def by_ringing_cell(
    random: np.random.Generator, quality: tuple[float, float] = (0.4, 0.9)
) -> Known:
    """Return irregular stick-slip by a load cell that rings, of a `quality` in powers of ten."""
    known = slips(random, noise=(-9.0, -8.0), samples=(2.3, 3.3))
    record, drop = known.record, float((known.peak - known.trough).mean())
    assert record.stiffness is not None
    assert record.mass is not None
    swing = (record.stiffness / record.mass) ** 0.5 * 10 ** random.uniform(0.0, 0.7)
    swing = min(swing, 0.8 * record.sample_rate)
    numbers = [swing**2], [1.0, swing / 10 ** random.uniform(*quality), swing**2]
    cell = bilinear(*numbers, record.sample_rate)
    force = lfilter(*cell, record.force, zi=lfilter_zi(*cell) * record.force[0])[0]
    force += drop * 10 ** random.uniform(-3.0, -1.3) * random.normal(size=len(force))
    return known._replace(record=record.model_copy(update={"force": force}))


def from_the_start(random: np.random.Generator, *, rests: bool = True, off: float = 0.1) -> Known:
    """Return irregular stick-slip that begins with the first loading, behind a zero that is off.

    If it `rests`, the drive starts after the recording, and the record begins at rest. In a third
    of all the spring was loaded, by as much as the zero is off elsewhere: by a share `off` of the
    peaks, at most.
    """
    known = slips(random, noise=(-9.0, -8.0))
    record, rate = known.record, known.record.loading_rate
    size = 4.0 * off * random.uniform(-1.0, 1.0)
    loaded = random.random() < 1.0 / 3.0
    begin = size if loaded else 0.0  # of the force of the spring, N
    lasts = (record.force[0] - begin) / rate
    before = (10 ** random.uniform(-1.0, 0.5) if rests else 0.0) * lasts
    early = np.arange(0.0, before + lasts, 1.0 / record.sample_rate)
    first = begin + rate * np.maximum(early - before, 0.0)
    shift = before + lasts - float(record.time[0])
    force = np.concatenate([first, record.force]) + (0.0 if loaded else size)
    drop = float((known.peak - known.trough).mean())
    force += drop * 10 ** random.uniform(-3.0, -1.0) * random.normal(size=len(force))
    time = np.concatenate([early, record.time + shift])
    moved = record.model_copy(update={"time": time, "force": force})
    return known._replace(record=moved, peak_time=known.peak_time + shift)


FAMILIES: dict[str, Callable[[np.random.Generator], Known]] = {
    "straight": slips,
    "creeping": partial(slips, creep=0.8),
    "few": partial(slips, cycles=(6, 14)),
    "neighbours alike": partial(slips, correlation=0.7),
    "drifting": partial(slips, drift=1.0),
    "in steps": partial(slips, step=0.1),
    "in few steps": partial(slips, step=0.2, noise=(-3.0, -1.5)),
    "neighbours much alike": partial(slips, correlation=0.9),
    "few, drifting": partial(slips, cycles=(2, 6), drift=1.0),
    "cut off": cut_off,
    "cut off in noise": cut_off_in_noise,
    "zero that settles": settling,
    "behind a filter": behind_filter,
    "begins at rest": from_the_start,
    "cell that rings": by_ringing_cell,
    "cell that rings for long": partial(by_ringing_cell, quality=(0.9, 1.7)),
}


def compare(known: Known, found: st.analysis.Analysis) -> Iterator[Compared]:
    """Compare each number that has a standard error with the truth, over the cycles found."""
    ends, record = found.cycles, known.record
    if ends.sizes["cycle"] < 3 or not found.regime.loads:
        return
    first, last = float(ends["start"][0]), float(ends["trough_time"][-1])
    inside = (known.peak_time > first) & (known.peak_time < last)
    static, middle = known.peak[inside], 0.5 * (known.peak + known.trough)[inside]
    for name, true in (("static", static), ("kinetic", middle)):
        measured = getattr(found.friction, name)
        if measured is not None:
            mu, error = measured.coefficient, measured.coefficient_error
            yield Compared(f"µ {name}", mu, error, float(true.mean()) / LOAD)
    if "creep_distance" not in found.missing:
        hidden, crept = hidden_way(record), float(known.crept[inside].mean())
        yield Compared(
            "creep, by what is hidden", float(ends["creep_distance"].mean()), hidden, crept
        )
    true_ones = {
        "stiffness times drive velocity": record.loading_rate or nan,
        "stiffness over mass": (record.stiffness or nan) / (record.mass or nan),
        "drift of the force": known.drift,
    }
    for each in found.parts["metadata"]:
        if not isnan(true_ones.get(each.quantity, nan)):
            true = true_ones[each.quantity]
            yield Compared(each.quantity, each.found, each.error, true, each.at_least)


def main() -> None:
    """Print how often two errors hold the truth, and how often each warning is given."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.explore.numbers")
    parser.add_argument("--records", type=int, default=200, help="of each family")
    parser.add_argument("--only", nargs="+", default=[*FAMILIES], choices=[*FAMILIES])
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    table = Table("records", "quantity", "of", "within two errors", "within four", "above bound")
    warned = Table("records", "warning", "given in")
    for name in options.only:
        off: dict[str, list[tuple[float, float]]] = {}
        warnings: Counter[str] = Counter()
        for number in range(options.records):
            known = FAMILIES[name](np.random.default_rng([options.seed, number]))
            found = st.analyse(known.record)
            warnings.update({each[:BEGINNING] for each in found.warnings})
            for each in compare(known, found):
                apart = abs(each.found - each.true) / each.error
                off.setdefault(each.quantity, []).append((apart, each.true - each.at_least))
        for quantity, each in off.items():
            errors, above = np.array(each).T
            shares = [f"{np.mean(errors < most):.0%}" for most in (2.0, 4.0)]
            above = above[np.isfinite(above)]  # where there is a bound
            shares.append(f"{np.mean(above >= 0.0):.0%}" if len(above) else "")
            table.add_row(name, quantity, f"{len(errors)}", *shares)
        for warning, count in warnings.most_common():
            warned.add_row(name, warning, f"{count} of {options.records}")
    Console().print(table, warned)


if __name__ == "__main__":
    main()
