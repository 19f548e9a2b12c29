"""Fits of records that are not clean: how often they are wrong, and whether they say so.

``python -m benchmarks.inference.disturbed --rigs "pin on plate" --sorts "cell rings"``: records of
a rig whose parameters are drawn from its priors, each disturbed: behind a load cell that rings, or
an amplifier that lets no constant force through; with friction that is irregular, drifts, or
alternates from slip to slip; with a drive velocity or a stiffness that is stated wrongly. They go
the way of measured records, and are fitted by simulations under the conditions of the middle one
of those whose simulations have the same prior of the jitter and a load cell that rings, or none.
Of each sort: how many are refused, or doubted; how often 95 % intervals hold the truth, of all that
are fitted and of those without a doubt. A rig may be a description, about whose values priors are
put. FOLDER holds the simulations, so that a second call only compares.
"""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

import stiction as st
from benchmarks.inference.fits import CYCLES, JITTER, NOISE, PER_CYCLE, RIGS, rig_of
from stiction.analysis.motion.cycles import swings
from stiction.analysis.motion.load_cell.free_swings import without_free_swings
from stiction.errors import ResultError
from stiction.inference.cycles import Cycles
from stiction.inference.features import features
from stiction.inference.fit import plan_for
from stiction.inference.learning.calibration import learn_or_read
from stiction.inference.observation import (
    VELOCITY,
    Conditions,
    Noise,
    Observation,
    grid_of,
    noise_of,
    observe,
    thin_out,
    without_lines,
)
from stiction.inference.posterior import Fit
from stiction.inference.priors import Normal, Prior, Uniform
from stiction.inference.rig import Rig
from stiction.inference.simulated.library import build
from stiction.inference.simulated.plan import Plan, plan
from stiction.inference.simulated.synthetic import draw
from stiction.study.execution.cores import Cores

Floats = NDArray[np.float64]
signal: Any = import_module("scipy.signal")  # without types

MORE = 3  # cycles beyond those that are fitted
FEW = 0.08  # of the records: a kind of fewer is left out, as it needs simulations of its own
FINER = 8  # times as many values, through which a cell swings as in continuous time
FINE = 8  # readings in place of one
SHOWN = ("phi", "friction.mu_0", "friction.mu_inf", "friction.mu_static", "friction.v_f", "k_x")
MIDDLE = 0.5 * CYCLES / (CYCLES + MORE)  # of a record that is used, where friction drifts
ZERO = 0.01  # of the friction force at rest: the zero is off by it
SURE = 0.01  # uncertainty of what is stated wrongly


class Sort(NamedTuple):
    """How records are disturbed, or what is stated of them over what is true.

    Parameters
    ----------
    cell : tuple of float or None
        Period of the load cell over the rig's own, and its quality.
    coupling : Uniform or None
        Time constant of an amplifier that lets no constant force through, in cycles.
    jitter, drift, alternation : Prior or None
        Of the friction coefficients' logarithm.
    velocity, stiffness : float
        As stated, over the true one.
    known : float
        Stated uncertainty of the velocity, relative; 0 if it is stated as certain.
    zero : float
        Stated uncertainty of the zero, over the friction force at rest.
    """

    cell: tuple[float, float] | None = None
    coupling: Uniform | None = None
    jitter: Prior = JITTER
    drift: Prior | None = None
    alternation: Prior | None = None
    velocity: float = 1.0
    stiffness: float = 1.0
    known: float = 0.0
    zero: float = ZERO


SLOW, QUICK = Uniform(3.0, 30.0, "log"), Uniform(0.3, 3.0, "log")  # an amplifier, in cycles
SORTS = {
    "clean": Sort(),
    "cell rings slowly": Sort(cell=(3.0, 10.0)),
    "cell rings as slowly as the rig": Sort(cell=(1.4, 5.0)),
    "cell rings": Sort(cell=(0.7, 10.0)),
    "cell rings quickly": Sort(cell=(0.35, 10.0)),
    "cell rings for long": Sort(cell=(0.7, 30.0)),
    "cell hardly rings": Sort(cell=(0.7, 3.0)),
    "no constant force": Sort(coupling=SLOW),
    "no constant force for long": Sort(coupling=QUICK),
    "no constant force, zero unknown": Sort(coupling=SLOW, zero=1.0),
    "no constant force for long, zero unknown": Sort(coupling=QUICK, zero=1.0),
    "irregular by 3 to 10 %": Sort(jitter=Uniform(0.03, 0.1, "log")),
    "drifts by 3 to 10 %": Sort(drift=Uniform(0.03, 0.1)),
    "drifts by 10 to 30 %": Sort(drift=Uniform(0.1, 0.3)),
    "alternates by 5 to 20 %": Sort(alternation=Uniform(0.05, 0.2)),
    "velocity 5 % too large": Sort(velocity=1.05),
    "velocity 5 % too small": Sort(velocity=0.95),
    "velocity 5 % too large, known to 5 %": Sort(velocity=1.05, known=0.05),
    "velocity 5 % too small, known to 5 %": Sort(velocity=0.95, known=0.05),
    "stiffness 5 % too large": Sort(stiffness=1.05),
    "stiffness 5 % too small": Sort(stiffness=0.95),
}


class Case(NamedTuple):
    """What makes the records of a sort, and what is stated of them.

    `truth` is the plan of the motions, `stated` the rig, `usual` the conditions of a record.
    """

    truth: Plan
    stated: Rig
    usual: Conditions
    sort: Sort


class Fitted(NamedTuple):
    """A fit beside the true values of its parameters, by name."""

    fit: Fit
    truth: dict[str, float]

    def holds(self, name: str) -> bool:
        """Return whether the interval of a parameter holds the truth."""
        return self.fit[name].low <= self.truth[name] <= self.fit[name].high


def about(slider: st.Slider) -> Rig:
    """Return a rig with priors about the values of a slider."""
    priors: dict[str, Prior] = {
        "k_x": Normal(slider.k_x, 0.05 * slider.k_x, low=0.0),
        "k_y": Normal(slider.k_y, 0.2 * slider.k_y, low=0.0),
        "phi": Uniform(0.4 * slider.phi, 2.5 * slider.phi, "log"),
    }
    for name, value in slider.law._asdict().items():
        if name.startswith("mu_") and value:
            priors[f"friction.{name}"] = Uniform(0.85 * value, 1.1 * value)
        elif name.startswith("v_"):
            priors[f"friction.{name}"] = Uniform(value / 3.0, 3.0 * value, "log")
    return Rig(slider, priors)


def case_of(name: str, sort: Sort) -> Case:
    """Return the case of a rig by its name in the other benchmarks, or of a description."""
    rig = rig_of(name)[0] if name in RIGS else about(st.Slider.from_toml(name))
    slider, priors = rig.slider, {**rig.priors}
    priors.pop("jitter", None)  # each record decides on its prior
    if sort.velocity != 1.0 or sort.stiffness != 1.0:
        priors["k_x"] = Normal(slider.k_x, SURE * slider.k_x, low=0.0)
    wrongly = Normal(sort.stiffness * slider.k_x, SURE * slider.k_x, low=0.0)
    stated = rig_with(slider, priors | ({"k_x": wrongly} if sort.stiffness != 1.0 else {}))
    velocity, cycle = slider.drive_speed, cycle_of(rig)
    if sort.known:
        spread = Normal(velocity, sort.known * velocity, low=0.0)
        stated = Rig(stated.slider, {**stated.priors, VELOCITY: spread})
    level = float(f"{NOISE * slider.F_0:.2g}")
    noise = {"force": Noise(level, 0.01, sort.zero * slider.F_0)}
    usual = Conditions(
        velocity, slider.normal_load, 0.0, float(f"{cycle / PER_CYCLE:.3g}"), CYCLES, cycle, noise
    )
    fine = usual._replace(
        step=usual.step / FINE, noise={"force": Noise(0.0, 0.01)}, cycles=CYCLES + MORE
    )
    given = {"jitter": sort.jitter, "drift": sort.drift, "alternation": sort.alternation}
    own = {name: its for name, its in given.items() if its is not None}
    return Case(plan(slider, {**priors, **own}, [fine]), stated, usual, sort)


def rig_with(slider: st.Slider, priors: dict[str, Prior]) -> Rig:
    """Return a rig with its stiffness in the middle of its prior."""
    return Rig(slider.replace(k_x=priors["k_x"].mean), priors)


def cycle_of(rig: Rig) -> float:
    """Return how long a cycle of a rig usually lasts, s."""
    slider = rig.slider
    run = st.simulate(slider, 12.0 * slider.loading_time, sample_rate=2e4 / slider.loading_time)
    found = float(np.median(st.analysis.find_cycles(run)["period"]))
    return float(f"{found:.2g}")


def read(
    of: Case, seed: int, number: int, _: Callable[[], bool]
) -> tuple[dict[str, float], st.Record] | None:
    """Return the true values of a record, and the record."""
    scores, made = draw(of.truth, number, seed)
    found = next(made)
    if found is None:
        return None
    random, sort, fine = np.random.default_rng([seed, number, 1]), of.sort, of.truth.conditions[0]
    truth, force = of.truth.parameters(scores), found.channels["force"]
    changed = np.exp(MIDDLE * truth.get("drift", 0.0))
    truth |= {path: changed * its for path, its in truth.items() if ".mu_" in path}
    force = force + ZERO * of.truth.slider.F_0 * random.standard_normal()
    rate = 1.0 / fine.step
    if sort.cell is not None:
        period, quality = sort.cell
        own = of.truth.slider.natural_frequencies[0] / (2.0 * np.pi)
        force = behind_cell(force, own / period, quality, rate)
    if sort.coupling is not None:
        shares = float(sort.coupling.quantile(np.array(random.uniform())))
        force = force[found.cycles.before[0] :]
        force = behind_amplifier(force, shares * of.usual.cycle, rate)
    its = of.usual.noise["force"]
    force = force + FINE**0.5 * its.level * random.standard_normal(len(force))
    sensor = st.Sensor(gain_uncertainty=its.gain, zero_uncertainty=its.zero)
    velocity = sort.velocity * of.usual.velocity
    time = fine.step * np.arange(len(force))
    record = st.Record(time=time, force=force, drive_velocity=velocity, sensors={"force": sensor})
    return truth, record


def behind_cell(force: Floats, frequency: float, quality: float, rate: float) -> Floats:
    """Return what a load cell shows that swings at a frequency (Hz) with a quality."""
    at = np.arange((len(force) - 1) * FINER + 1) / FINER
    fine = np.interp(at, np.arange(len(force)), force)
    turns = 2.0 * np.pi * frequency
    its = signal.bilinear([turns**2], [1.0, turns / quality, turns**2], FINER * rate)
    shown = signal.lfilter(*its, fine, zi=signal.lfilter_zi(*its) * fine[0])[0]
    return np.asarray(shown[::FINER])


def behind_amplifier(force: Floats, time: float, rate: float) -> Floats:
    """Return what an amplifier shows, a long time after its start, of a force.

    It forgets a constant force within a time, s.
    """
    its = signal.bilinear([time, 0.0], [time, 1.0], rate)
    return np.asarray(signal.lfilter(*its, force, zi=signal.lfilter_zi(*its) * force.mean())[0])


class Seen(NamedTuple):
    """A record as a fit sees it, with the true values of its parameters by name.

    `noise` is that of means of as many readings as are simulated.
    """

    truth: dict[str, float]
    record: st.Record
    observed: Observation
    noise: Noise

    @property
    def kind(self) -> tuple[Prior, bool]:
        """What decides which simulations it is compared with."""
        return self.observed.conditions.jitter, self.noise.cell is not None

    def under(self, conditions: Conditions, slider: st.Slider) -> Observation | None:
        """Return what is observed under the conditions of others; None with too few cycles.

        Behind a load cell that rings the force is restored up to the same frequency.
        """
        record, noise = self.record, conditions.noise["force"]
        grid = grid_of(record, "it")
        lineless = without_lines(record, grid, swings(record))
        if self.noise.cell is not None and noise.cell is not None:
            cell = self.noise.cell._replace(highest=noise.cell.highest)
            force = without_free_swings(grid, record.force, cell)
            lineless["force"] = lineless["force"]._replace(values=force)
        fine = {"force": noise._replace(level=FINE**0.5 * noise.level)}
        channels, _, found = thin_out(lineless, fine, conditions.step / FINE, FINE)
        if len(found.peak) < conditions.cycles:
            return None
        found = Cycles(*(each[: conditions.cycles] for each in found))
        its = features(conditions.step, channels, conditions.scale(slider), found)
        return self.observed._replace(
            conditions=conditions, features=its, force=channels["force"], cycles=found
        )


def see(of: Case, seed: int, number: int, check: Callable[[], bool]) -> Seen | str | None:
    """Return a record as a fit sees it, or why it is refused; None for one without cycles."""
    made = read(of, seed, number, check)
    if made is None:
        return None
    truth, record = made
    try:
        observed = observe(record, of.stated.slider)
    except ResultError as error:
        return str(error)
    lineless = without_lines(record, grid_of(record, "it"), swings(record))
    noise = {"force": noise_of(record, "force", *lineless["force"])}
    thinned = thin_out(lineless, noise, of.usual.step / FINE, FINE)
    return Seen(truth, record, observed, thinned.noise["force"])


def conditions_of(of: Case, some: Sequence[Seen]) -> Conditions:
    """Return the conditions of records of a kind, with the noise of the middle one of them."""
    ordered = sorted(some, key=lambda each: each.noise.level)
    its = ordered[len(ordered) // 2]
    jitter, velocity = its.observed.conditions.jitter, its.observed.conditions.velocity
    noise = {"force": its.noise}
    return of.usual._replace(noise=noise, jitter=jitter, velocity=velocity, block=FINE)


def fits_of(of: Case, some: Sequence[Seen], count: int, folder: Path | None) -> Iterator[Fitted]:
    """Yield the fits of records of one kind."""
    conditions = conditions_of(of, some)
    its = plan_for(of.stated, [conditions])
    place = None if folder is None else folder / its.key
    known = build(its, count, place)
    learned = learn_or_read(
        known.features, known.scores, None if place is None else place / f"learned-{count}.npz"
    )
    for each in some:
        own = each.under(conditions, of.stated.slider)
        if own is None:
            continue
        (sample,) = learned.posteriors(own.features[None])
        yield Fitted(Fit.of(known, sample, [own], learned), each.truth)


def report(name: str, of: Case, options: argparse.Namespace) -> None:
    """Print what becomes of the records of a sort."""
    work = partial(see, of, options.seed)
    made = [each for each in Cores().results(work, range(options.records)) if each is not None]
    refused = Counter(each[:70] for each in made if isinstance(each, str))
    seen = [each for each in made if isinstance(each, Seen)]
    kinds = Counter(each.kind for each in seen)
    kinds = {kind: number for kind, number in kinds.items() if number >= FEW * len(seen)}
    found: list[Fitted] = []
    for kind in kinds:
        some = [each for each in seen if each.kind == kind]
        found += fits_of(of, some, options.simulations, options.library)
    doubted = [each for each in found if each.fit.doubts]
    sure = [each for each in found if not each.fit.doubts]
    print(
        f"  {name}: {len(made)} records, refused {sum(refused.values())}, fitted {len(found)}, "
        f"of which doubted {len(doubted)}; restored {sum(n for k, n in kinds.items() if k[1])}, "
        f"irregular {sum(n for k, n in kinds.items() if k[0].high > 0.1)}"
    )
    for why, number in refused.items():
        print(f"      refused {number}: {why}")
    heads = Counter(doubt[:60] for each in doubted for doubt in each.fit.doubts)
    for head, number in heads.items():
        print(f"      doubt {number}: {head}")
    for parameter in SHOWN:
        if found and parameter in found[0].fit and parameter in found[0].truth:
            shares = [
                f"{sum(its.holds(parameter) for its in some):3d} of {len(some):3d}"
                for some in (found, sure)
            ]
            print(f"      {parameter:20s} holds {shares[0]}, without doubt {shares[1]}", flush=True)


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rigs", nargs="+", default=[*RIGS][:1], metavar="NAME")
    parser.add_argument("--sorts", nargs="+", choices=SORTS, default=[*SORTS], metavar="SORT")
    parser.add_argument("--records", type=int, default=60)
    parser.add_argument("--simulations", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=5)
    parser.add_argument("--library", type=Path)
    options = parser.parse_args()
    for rig in options.rigs:
        print(rig)
        for name in options.sorts:
            report(name, case_of(rig, SORTS[name]), options)


if __name__ == "__main__":
    main()
