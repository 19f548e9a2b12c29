"""Calibration of fits: how often intervals hold the truth, on records that no part has seen.

``python -m benchmarks.inference.fits --seeds 1 2 --library FOLDER``: for three rigs, four sets of
channels and each seed of held-out records, coverage of 95 % intervals, the p-value of ranks against
uniform ones (simulation-based calibration: S. Talts et al., arXiv:1804.06788), and widths of the
posterior. Records have 20 cycles, friction that differs by 0.1 % to 3 % from cycle to cycle, noise
of 0.2 % of the friction force at rest and, on the displacement, of 0.2 % of the slip length. The
third rig's slips take a fifth of the force: its spring loads for as long as five cycles first. One
rig is measured again with load cells that smear its slips, or whose zero drifts by 5 % or 10 % of
the friction force over a record (standard deviation); and with friction that differs by 1 % to
30 % from cycle to cycle. FOLDER holds the simulations, so that a second call only compares.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from time import perf_counter
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtr
from scipy.stats import kstest

from stiction.inference.columns import features_from
from stiction.inference.features import USED
from stiction.inference.learning.calibration import Learned, learn_or_read
from stiction.inference.learning.regression_abc import Sample, quantiles, rank
from stiction.inference.observation import Conditions, Noise
from stiction.inference.posterior import RARE
from stiction.inference.priors import IRREGULAR, Uniform
from stiction.inference.rig import Rig
from stiction.inference.simulated.library import Library, build
from stiction.inference.simulated.plan import plan
from stiction.recording.sensor import LowPass

Floats = NDArray[np.float64]

TEXT = """
[slider]
mass = "{mass}"
k_x = {{value = "{k_x}", uncertainty = "5 %"}}
k_y = {{value = "{k_y}", uncertainty = "20 %"}}
phi = {{low = "0.5 deg", high = "5 deg", scale = "log"}}
normal_load = "{load}"
c_x = {{low = 0.0, high = "{damping} N*s/m"}}

[friction]
law = "exponential-weakening"
mu_0 = {{low = {mu_0[0]}, high = {mu_0[1]}}}
mu_inf = {{low = {mu_inf[0]}, high = {mu_inf[1]}}}
v_f = {{low = "3 mm/s", high = "30 mm/s", scale = "log"}}

[drive]
velocity = "{velocity}"
"""
RIGS = {  # that differ in stiffness, friction and drive
    "pin on plate": {
        "mass": "80 g", "k_x": "2.3 kN/m", "k_y": "0.9 MN/m", "load": "4 N", "damping": 1.4,
        "mu_0": (0.5, 0.7), "mu_inf": (0.3, 0.48), "velocity": "0.5 mm/s",
    },
    "Nakano & Popov": {
        "mass": "250 g", "k_x": "1 kN/m", "k_y": "10 MN/m", "load": "10 N", "damping": 1.6,
        "mu_0": (0.17, 0.24), "mu_inf": (0.1, 0.16), "velocity": "1 mm/s",
    },
    "granite": {
        "mass": "80 kg", "k_x": "20 MN/m", "k_y": "2 GN/m", "load": "50 kN", "damping": 4000,
        "mu_0": (0.62, 0.72), "mu_inf": (0.52, 0.61), "velocity": "0.1 mm/s",
    },
}  # fmt: skip
RIGS["pin on plate, filter at 20 Hz"] = RIGS["pin on plate"]
FILTERS = {"pin on plate, filter at 20 Hz": (LowPass(20.0, 4),)}  # of the load cell
DRIFTS = {"pin on plate, zero drifts by 5 %": 0.05, "pin on plate, zero drifts by 10 %": 0.1}
RIGS |= dict.fromkeys(DRIFTS, RIGS["pin on plate"])
JITTER = Uniform(1e-3, 0.03, "log")  # of the rigs that are not listed here
OTHER_JITTER = {"pin on plate, irregular": IRREGULAR}
RIGS |= dict.fromkeys(OTHER_JITTER, RIGS["pin on plate"])
SLIPS = {"granite": 0.2}  # drop of a cycle over the friction force at rest; 0.6 of the other rigs
CYCLES, PER_CYCLE = 20, 200
NOISE = 0.002
SHOWN = ("phi", "friction.mu_0", "friction.mu_inf", "friction.v_f", "k_x", "k_y", "jitter")
WIDTHS = ("phi", "friction.mu_0", "friction.mu_inf", "friction.v_f")


class Trial(NamedTuple):
    """Comparison of the held-out records with a library: (records, parameters) each."""

    names: list[str]
    inside: NDArray[np.bool_]
    ranks: Floats
    widths: Floats  # standard deviation of the logarithm of each parameter
    unlike: float  # share of the records that a fit would call unlike the rig's
    seconds: float  # for all records


def rig_of(name: str) -> tuple[Rig, Conditions]:
    """Return a rig, and the conditions of a record with all channels."""
    rig = Rig.from_toml(TEXT.format(**RIGS[name]))
    slider = rig.slider
    velocity = slider.motion.rate(0.0)[0]
    cycle = SLIPS.get(name, 0.6) * slider.F_0 / (slider.k_x * velocity)
    level = float(f"{NOISE * slider.F_0:.2g}")
    filters, drift = FILTERS.get(name, ()), DRIFTS.get(name, 0.0) * slider.F_0 / (CYCLES * cycle)
    noise = {
        "force": Noise(level, 0.01, 5 * level, filters, drift),
        "force_across": Noise(level, 0.01, 0.0, filters, drift),
        "position": Noise(level / slider.k_x),
    }
    step, lead = cycle / PER_CYCLE, cycle if drift else 0.0
    conditions = Conditions(velocity, slider.normal_load, 0.0, step, CYCLES, cycle, noise, lead)
    jitter = OTHER_JITTER.get(name, JITTER)
    return Rig(slider, {**rig.priors, "jitter": jitter}), conditions


def library_of(name: str, count: int, seed: int, folder: Path | None) -> Library:
    """Simulate records of a rig, with all channels."""
    rig, conditions = rig_of(name)
    of = plan(rig.slider, rig.priors, [conditions])
    place = None if folder is None else folder / f"{of.key}-{seed}"
    return build(of, count, place, seed=seed)


def compare(known: Library, learned: Learned, unseen: Library, features: Floats) -> Trial:
    """Compare held-out records with a library by some of their features."""
    start = perf_counter()
    samples = [*learned.posteriors(features)]
    seconds = perf_counter() - start
    names = [*known.plan.priors]
    tails = np.array([0.025, 0.975])
    inside, ranks, widths = [], [], []
    for sample, truth in zip(samples, unseen.scores, strict=True):
        ends = [quantiles(each, sample.weights, tails) for each in sample.scores.T]
        inside.append([low <= its <= high for (low, high), its in zip(ends, truth, strict=True)])
        pairs = zip(sample.scores.T, truth, strict=True)
        ranks.append([rank(each, sample.weights, its) for each, its in pairs])
        widths.append([spread(known, each, sample, i) for i, each in enumerate(names)])
    scores = learned.summary.standard.scores(features)
    unlike = float((learned.typicality.farther(scores) < RARE).mean())
    return Trial(names, np.array(inside), np.array(ranks), np.array(widths), unlike, seconds)


def spread(known: Library, name: str, sample: Sample, index: int) -> float:
    """Return the standard deviation of a parameter's logarithm; NaN where it has none."""
    if name not in WIDTHS:
        return float("nan")
    values = np.log(known.plan.priors[name].quantile(ndtr(sample.scores[:, index])))
    mean = sample.weights @ values
    return float(np.sqrt(sample.weights @ (values - mean) ** 2))


def report(trial: Trial) -> None:
    """Print a line for each parameter, and how many records are called unlike the rig's."""
    print(f"    called unlike    {100 * trial.unlike:5.1f} %")
    for i, name in enumerate(trial.names):
        if name in SHOWN or name in ("gain", "zero", "zero_drift"):
            p = kstest(trial.ranks[:, i], "uniform").pvalue
            width = trial.widths[:, i]
            sd = f"{width.mean():.3f} (median {np.median(width):.3f})" if name in WIDTHS else ""
            missed = "" if name not in WIDTHS or (0.92 <= trial.inside[:, i].mean() <= 0.98
                                                  and p > 0.01) else "  MISSED"  # fmt: skip
            inside = 100 * trial.inside[:, i].mean()
            print(f"    {name:16s} {inside:5.1f} %  p = {p:.3f}  {sd}{missed}")


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--simulations", type=int, default=4000)
    parser.add_argument("--records", type=int, default=500)
    parser.add_argument("--seeds", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--library", type=Path)
    parser.add_argument("--rigs", nargs="+", choices=RIGS, default=[*RIGS], metavar="NAME")
    options = parser.parse_args()
    for name in options.rigs:
        start = perf_counter()
        known = library_of(name, options.simulations, 0, options.library)
        took = perf_counter() - start
        print(
            f"{name}: {len(known.scores)} of {known.wanted} simulations with cycles, {took:.0f} s"
        )
        some = {each: library_of(name, options.records, each, options.library)
                for each in options.seeds}  # fmt: skip
        for channels in (USED[:1], USED[:2], ("force", "position"), USED):
            which = features_from(channels, known.plan.conditions[0], known.plan.slider)
            start = perf_counter()
            learned = learn_or_read(known.features[:, which], known.scores)
            print(
                f"  {' + '.join(channels)}: learned in {perf_counter() - start:.0f} s", flush=True
            )
            for seed, unseen in some.items():
                trial = compare(known, learned, unseen, unseen.features[:, which])
                each = trial.seconds / len(unseen.scores)
                print(f"   seed {seed}: {len(unseen.scores)} records, {1e3 * each:.0f} ms each")
                report(trial)


if __name__ == "__main__":
    main()
