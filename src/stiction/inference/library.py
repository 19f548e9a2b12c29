"""A library: records simulated with parameters drawn from the priors, jitter and sensor inside."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import partial
from hashlib import sha256
from math import ceil
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from stiction.analysis.record import cell_axis
from stiction.arrays import Floats
from stiction.errors import ResultError
from stiction.inference.cycles import Cycles, slip_cycles
from stiction.inference.features import BEND, FeatureGroup, features, parts
from stiction.inference.jitter import SPARE, Jitter, SampledMotion, first_loading, move
from stiction.inference.observation import Conditions
from stiction.inference.priors import Normal, Prior, Uniform
from stiction.recording.sensor import FASTEST, low_pass
from stiction.storage.arrays import read_arrays, write_arrays
from stiction.study.execution.cores import Cores
from stiction.system.parameter import change_unchecked
from stiction.system.slider import Slider

Progress = Callable[[float], None] | None

SIMULATIONS = 4000  # of a library, by default
BLOCK = 32  # simulations that are stored together
LONGEST_CYCLE = 4.0  # of the measured cycles: simulations with longer ones end without
JITTER = Uniform(1e-3, 0.05, "log")  # of friction from cycle to cycle, unless the rig says
NOT_OF_THE_SLIDER = {"jitter", "drift", "gain", "zero", "zero_drift"}  # names of priors
SAFE = 1.2  # times as many simulations as give enough on average: over four deviations of 300
FORMAT = 7  # of stored simulations and of what is learned from them


class Plan(NamedTuple):
    """What a library simulates.

    Parameters
    ----------
    slider : Slider
        The rig in the middle of its priors.
    priors : dict of str to Normal or Uniform
        Of its parameters, by path; and of ``jitter``, ``gain`` and ``zero`` (N) of the force, the
        drift of this zero in the first record, ``zero_drift`` (N/s), and ``drift``, the change of
        the coefficients' logarithm over a record.
    conditions : tuple of Conditions
        Of each record.
    basis : Slider, optional
        What features are relative to, where it is not `slider`: plans with the same basis can be
        compared.
    """

    slider: Slider
    priors: dict[str, Prior]
    conditions: tuple[Conditions, ...]
    basis: Slider | None = None

    @property
    def key(self) -> str:
        """A hash of all that decides what is simulated."""
        parts = self.slider, self.priors, self.conditions, self.basis
        text = json.dumps([FORMAT, *map(repr, parts)])
        return sha256(text.encode()).hexdigest()[:16]

    def parameters(self, scores: Floats) -> dict[str, float]:
        """Return the parameters with these normal scores, (p,)."""
        from scipy.special import ndtr  # slow to import

        shares = ndtr(scores)
        pairs = zip(self.priors.items(), shares, strict=True)
        return {name: float(prior.quantile(share)) for (name, prior), share in pairs}


class Library(NamedTuple):
    """Simulated records: normal scores (n, p) of their parameters, and their features (n, f).

    `wanted` is the number of simulations; those without enough cycles are left out.
    """

    plan: Plan
    scores: Floats
    features: Floats
    wanted: int


def plan(slider: Slider, priors: Mapping[str, Prior], conditions: Sequence[Conditions]) -> Plan:
    """Return the plan for records under these conditions."""
    force = conditions[0].noise["force"]
    own: dict[str, Prior] = {"jitter": JITTER}
    if force.gain:
        own["gain"] = Normal(1.0, force.gain, low=0.0)
    if force.zero:
        own["zero"] = Normal(0.0, force.zero)
    if force.drift:
        own["zero_drift"] = Normal(0.0, force.drift)
    return Plan(
        slider, {**priors, **{k: v for k, v in own.items() if k not in priors}}, tuple(conditions)
    )


def build(
    plan: Plan, count: int, folder: Path | None, *, seed: int = 0, progress: Progress = None
) -> Library:
    """Simulate a library of `count` records, or continue one that is stored in a folder."""
    scores, found = simulate_all(plan, count, folder, seed=seed, progress=progress)
    kept = have_cycles(found)
    return Library(plan, scores[kept], found[kept], count)


def have_cycles(rows: Floats) -> NDArray[np.bool_]:
    """Return which rows of features (n, f) are those of records with cycles."""
    return np.asarray(np.isfinite(rows).all(axis=1))


def simulate_all(
    plan: Plan, count: int, folder: Path | None, *, seed: int = 0, progress: Progress = None
) -> tuple[Floats, Floats]:
    """Return normal scores (n, p) and features (n, f) of `count` simulations.

    Features of a record with too few cycles are NaN. What a folder holds already is not simulated
    again: simulation number i is the same whatever the number of others.
    """
    blocks = range((count + BLOCK - 1) // BLOCK)
    done = (
        {}
        if folder is None
        else {each: rows for each in blocks if (rows := read_block(folder, each)) is not None}
    )
    missing = [each for each in blocks if each not in done]

    work = partial(simulate_block, plan, folder, seed)
    for ready, (block, rows) in enumerate(Cores().results(work, missing), 1):
        done[block] = rows
        if progress is not None:
            progress(ready / len(missing))
    scores, found = (np.concatenate([done[each][i] for each in blocks])[:count] for i in (0, 1))
    return scores, found


def simulate_block(
    plan: Plan, folder: Path | None, seed: int, block: int, _: Callable[[], bool]
) -> tuple[int, tuple[Floats, Floats]]:
    """Simulate a block, keep it in the folder, and return its number, scores and features."""
    rows = [simulate(plan, i, seed) for i in range(block * BLOCK, (block + 1) * BLOCK)]
    found = np.array([row[0] for row in rows]), np.array([row[1] for row in rows])
    if folder is not None:
        write_block(folder, block, *found)
    return block, found


class Synthetic(NamedTuple):
    """A synthetic record: channels of samples a step apart, and the cycles that are used."""

    channels: dict[str, Floats]
    cycles: Cycles


def simulate(plan: Plan, number: int, seed: int) -> tuple[Floats, Floats]:
    """Return the normal scores and features of one simulation; NaN where it has too few cycles."""
    drawn, records = draw(plan, number, seed)
    found = []
    for conditions, made in zip(plan.conditions, records, strict=True):
        scale = conditions.scale(plan.basis or plan.slider)
        blank = dummy(conditions)
        channels, cycles = made or (blank, slip_cycles(blank["force"]))
        its = features(conditions.step, channels, scale, cycles)
        found.append(its if made else np.full_like(its, np.nan))
    return drawn, np.concatenate(found)


def draw(plan: Plan, number: int, seed: int) -> tuple[Floats, Iterator[Synthetic | None]]:
    """Return normal scores drawn for one simulation, and its records."""
    random = np.random.default_rng([seed, number])
    drawn = random.standard_normal(len(plan.priors))
    return drawn, synthesise(plan, drawn, random)


def synthesise(
    plan: Plan, scores: Floats, random: np.random.Generator
) -> Iterator[Synthetic | None]:
    """Yield a synthetic record under each of the conditions; None where it has too few cycles."""
    values = plan.parameters(scores)
    slider = plan.slider
    for path, value in values.items():
        if path not in NOT_OF_THE_SLIDER:
            slider = change_unchecked(slider, path, value)
    spread, common = values["jitter"], float(random.uniform())
    for conditions in plan.conditions:
        jitter = Jitter(spread, common, values.get("drift", 0.0) / conditions.cycles)
        rig = conditions.slider_of(slider)
        wanted, noise = conditions.cycles, conditions.noise["force"].level
        most = LONGEST_CYCLE * (wanted + SPARE) * conditions.cycle + first_loading(rig)
        times: Floats = conditions.step * np.arange(int(most / conditions.step) + 1.0)
        motion = move(
            rig, times, jitter, random, cycle=conditions.cycle, cycles=wanted, noise=noise
        )
        channels = measure(conditions, rig, motion, values, random)
        values.pop("zero_drift", None)  # a zero drifts differently in each record
        found = slip_cycles(channels["force"], noise)
        enough = min(len(found.peak), len(motion.troughs)) >= wanted  # not of noise
        last = Cycles(*(each[-wanted:] for each in found))
        yield Synthetic(channels, last) if enough else None


def measure(
    conditions: Conditions, rig: Slider, motion: SampledMotion, values: Mapping[str, float],
    random: np.random.Generator,
) -> dict[str, Floats]:  # fmt: skip
    """Return the channels of a motion as their sensors show them, along the load cell's axis."""
    u_x, u_y = motion.rows[:, 0], motion.rows[:, 1]
    x, y = cell_axis(rig)[:2]
    c, s = rig.direction
    way = -1.0 if conditions.velocity < 0.0 else 1.0
    along, across = rig.k_x * u_x, rig.k_y * u_y
    exact = {
        "force": way * (x * along + y * across),
        "force_across": way * (x * across - y * along),
        "position": way * (conditions.velocity * motion.time - c * u_x - s * u_y),
    }
    found = {}
    for name, noise in conditions.noise.items():
        gain, zero = random.standard_normal(2) * (noise.gain, noise.zero) + (1.0, 0.0)
        if name == "force":
            gain, zero = values.get("gain", 1.0), values.get("zero", 0.0)
        if noise.drift:
            drift = noise.drift * random.standard_normal()
            drift = values.get("zero_drift", drift) if name == "force" else drift
            zero = zero + drift * (motion.time - start_time(motion, exact["force"], conditions))
        shown = [each for each in noise.filters if each.cut * conditions.step <= FASTEST]
        values_of = gain * low_pass(exact[name], shown, 1.0 / conditions.step) + zero
        found[name] = values_of + noise.level * random.standard_normal(len(values_of))
    return found


def start_time(motion: SampledMotion, force: Floats, conditions: Conditions) -> float:
    """Return when a record with the cycles that are used would have begun, s."""
    used = slip_cycles(force).before[-conditions.cycles :]
    return (float(motion.time[used[0]]) if len(used) else 0.0) - conditions.lead


def features_from(
    channels: Iterable[str], conditions: Conditions, slider: Slider
) -> NDArray[np.bool_]:
    """Return which features of a record under these conditions come from these channels alone."""
    some = set(channels)
    return which(conditions, slider, lambda part: part.needs <= some)


def bend_features(conditions: Conditions, slider: Slider) -> NDArray[np.bool_]:
    """Return which features of a record under these conditions are those of a bent loading."""
    return which(conditions, slider, lambda part: part.name == BEND)


def which(
    conditions: Conditions, slider: Slider, wanted: Callable[[FeatureGroup], bool]
) -> NDArray[np.bool_]:
    """Return which features of a record under these conditions belong to the wanted parts."""
    blank = dummy(conditions)
    found = parts(conditions.step, blank, conditions.scale(slider), slip_cycles(blank["force"]))
    return np.concatenate([np.full(len(part.values), wanted(part)) for part in found])


def dummy(conditions: Conditions) -> dict[str, Floats]:
    """Return channels of a sawtooth, which has as many features as any record."""
    saw = np.tile(np.concatenate([np.linspace(0.0, 1.0, 40), np.linspace(1.0, 0.0, 5)]), 8)
    return dict.fromkeys(conditions.noise, saw + 0.01)


def refuse_too_few(
    what: str, usable: int, simulated: int, fewest: int, which: str = "", check: str = "the priors"
) -> None:
    """Refuse to learn from too few simulations with cycles; say how many would do.

    `which` tells what is asked of the cycles, `check` what decides about them. Where fewer than a
    tenth of the simulations that are needed are usable, more of them would not help.

    Raises
    ------
    ResultError
        If fewer than `fewest` have cycles.
    """
    if usable >= fewest:
        return
    enough = SAFE * fewest * simulated / max(usable, 1)
    number = ceil(enough / 100.0) * 100
    more = f", or simulate {number} (-n {number}, in Python simulations={number})"
    raise ResultError(
        f"only {usable} of {simulated} {what} have cycles of stick and slip{which}, {fewest} are "
        f"needed: check {check}{more if 10 * usable > fewest else ''}"
    )


def cache_folder() -> Path:
    """Return the folder of libraries in the user's cache."""
    from platformdirs import user_cache_path

    return user_cache_path("stiction") / "libraries"


def write_block(folder: Path, block: int, scores: Floats, found: Floats) -> None:
    """Write a block of simulations."""
    write_arrays(folder / f"{block:05d}.npz", scores=scores, features=found)


def read_block(folder: Path, block: int) -> tuple[Floats, Floats] | None:
    """Return a stored block; None where there is none, so that it is simulated again."""
    stored = read_arrays(folder / f"{block:05d}.npz")
    if stored is None or not stored.keys() >= {"scores", "features"}:
        return None
    return stored["scores"], stored["features"]
