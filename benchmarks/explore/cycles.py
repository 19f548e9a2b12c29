"""``python -m benchmarks.explore.cycles``: the cycles of random rigs that stick and slip.

They are held against a plain count of the falls of half the swing, by `st.analysis.find_cycles`, by
what a study sees and by the test of an audit. Rigs are of three classes: regular, whose falls are
of one size; irregular, whose falls differ, but whose count is the same, to one that an end cuts, at
40, 50 and 60 % of the swing; and those whose count depends on that share, which are chaotic: no
count is the right one there, and it is only asked whether all three come to the same.
Deterministic in its seed.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from math import pi, sqrt
from typing import NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from rich.console import Console
from rich.table import Table

import stiction as st
from stiction.analysis.motion.noiseless.zigzag import zigzag
from stiction.analysis.motion.regime.kinds import STICK_SLIP
from stiction.auditing.prediction import predict
from stiction.auditing.simulated_test import coarse_rate, simulate_test
from stiction.linear_stability import growth_rate
from stiction.study.variables.observed_run import observe_run

Floats = NDArray[np.float64]

CLASSES = ("regular", "irregular falls", "count depends on the share")
REGULAR = 0.1  # standard deviation of the falls over their mean
NEAR = 0.01  # of a period


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


class Counted(NamedTuple):
    """Cycles of a rig: of falls of two fifths, half, three fifths of the swing, and as found.

    `period` and `study_period` are the mean periods of the analysis and of the study over that of
    the half falls, in the time that all three have cycles in; `spread` is the standard deviation of
    the falls found, over their mean; `one_kind` is whether the study sees stick-slip as well.
    """

    falls: tuple[int, int, int]
    analysis: int
    study: int
    period: float
    study_period: float
    audit_period: float
    spread: float
    one_kind: bool

    @property
    def sort(self) -> str:
        """One of `CLASSES`."""
        if np.ptp(self.falls) > 1:
            return CLASSES[2]
        return CLASSES[0] if self.spread < REGULAR else CLASSES[1]

    @property
    def counted(self) -> bool:
        """Whether both counts are that of half the swing, but for one that an end cuts."""
        return max(abs(n - self.falls[1]) for n in (self.analysis, self.study)) <= 1

    @property
    def timed(self) -> bool:
        """Whether both mean periods are that of half the swing."""
        return max(abs(p - 1) for p in (self.period, self.study_period)) < NEAR


def troughs(time: Floats, force: Floats, height: float) -> Floats:
    """Return the times of troughs between falls higher than that."""
    turns = zigzag(force, height)
    if len(turns) < 2:  # no fall at all
        return np.empty(0)
    turns = turns[0 if force[turns[0]] < force[turns[1]] else 1 :]
    return np.asarray(time[turns[: (len(turns) - 1) // 2 * 2 + 1 : 2]])


def periods(edges: list[Floats]) -> list[float]:
    """Return mean periods between troughs, of several counts, in the time that they share."""
    if any(len(each) < 2 for each in edges):
        return [np.nan] * len(edges)
    near = 0.05 * float(np.median(np.diff(edges[0])))
    low, high = max(each[0] for each in edges) - near, min(each[-1] for each in edges) + near
    shared = [each[(each >= low) & (each <= high)] for each in edges]
    return [float(np.ptp(each)) / max(len(each) - 1, 1) for each in shared]


def edges(cycles: xr.Dataset) -> Floats:
    """Return the troughs between cycles, the first and the last among them."""
    return np.append(cycles["start"].values, cycles["trough_time"].values[-1:])


def cycles_of_test(slider: st.Slider) -> xr.Dataset:
    """Return the cycles that an audit finds in its test from rest."""
    expected = predict(slider)
    rate = max(expected.sample_rate, coarse_rate(expected))
    return simulate_test(slider, expected, growth_rate(slider), sample_rate=rate).cycles


def rigs(count: int, seed: int) -> Iterator[Counted]:
    """Yield how the cycles of each rig in stick-slip are counted."""
    random, done = np.random.default_rng(seed), 0
    while done < count:
        slider, duration = rig(random)
        if sqrt(slider.k_y / slider.mass) * duration > 1.5e7:
            continue
        rate = min(400 * sqrt(slider.k_x / slider.mass) / (2 * pi), 1e6 / duration)
        record = st.analysis.record_of(st.simulate(slider, duration, sample_rate=rate))
        found = st.analysis.find_cycles(record)
        if st.analysis.classify(record).kind != STICK_SLIP:
            continue
        done += 1
        swing = float(np.ptp(record.force[-len(record) // 3 :]))
        falls = [troughs(record.time, record.force, share * swing) for share in (0.4, 0.5, 0.6)]
        settings = st.Settings(duration=duration)
        observed = observe_run(st.Description(slider, st.Initial(), settings), None)
        seen = observed.swings
        analysed = edges(found)
        studied = seen.end - np.append(np.cumsum(seen.period[::-1])[::-1], 0.0)
        half, *others = periods([falls[1], analysed, studied])
        own, audited = periods([analysed, edges(cycles_of_test(slider))])
        yield Counted(
            (len(falls[0]) - 1, len(falls[1]) - 1, len(falls[2]) - 1),
            found.sizes["cycle"],
            len(seen.drop),
            others[0] / half,
            others[1] / half,
            audited / own,
            float(found["drop"].std() / found["drop"].mean()),
            observed.regime == STICK_SLIP,
        )


def main() -> None:
    """Print how often counts, periods and kinds are right."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.explore.cycles")
    parser.add_argument("--rigs", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    console = Console()
    found = list(rigs(options.rigs, options.seed))
    table = Table("falls", "rigs", "count", "period", "study", "audit", "kind")
    for kind in CLASSES:
        rows = [each for each in found if each.sort == kind]
        same = sum(abs(r.study_period / r.period - 1) < NEAR for r in rows)
        seen = [r.audit_period for r in rows if np.isfinite(r.audit_period)]
        audited = f"{sum(abs(each - 1) < NEAR for each in seen)} of {len(seen)}"
        kinds = f"{sum(r.one_kind for r in rows)}"
        right = [f"{sum(r.counted for r in rows)}", f"{sum(r.timed for r in rows)}"]
        defined = kind != CLASSES[2]
        judged = right if defined else "--"
        table.add_row(kind, f"{len(rows)}", *judged, f"{same}", audited, kinds)
    console.print(table)
    for each in found:
        if each.sort != CLASSES[2] and not (each.counted and each.timed):
            console.print(f"{each.sort}: {each}")
    console.print(
        "count: that of half the swing, but for one that an end cuts; period: to 1 %; study, "
        "audit: their mean period is the analysis's to 1 % in the time that both see; kind: the "
        "study sees stick-slip as well."
    )


if __name__ == "__main__":
    main()
