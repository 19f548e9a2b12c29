"""Synthetic records of a plan: a motion with jitter, as its sensors show it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import ceil
from typing import NamedTuple

import numpy as np

from stiction.analysis.motion.load_cell.free_swings import RingingCell, through
from stiction.analysis.signals.hum import without_bands
from stiction.analysis.signals.robust import block_means
from stiction.arrays import Floats
from stiction.inference.cycles import Cycles, slip_cycles
from stiction.inference.observation import MOST_PLACES, Conditions
from stiction.inference.simulated.jitter import SPARE, Jitter, SampledMotion, first_loading, move
from stiction.inference.simulated.plan import Plan
from stiction.recording.coloured_noise import draw_lasting
from stiction.recording.sensor import FASTEST, digitise, low_pass
from stiction.system.parameter import change_unchecked
from stiction.system.slider import Slider

LONGEST_CYCLE = 4.0  # of the measured cycles: simulations with longer ones end without
# names of priors
NOT_OF_THE_SLIDER = {"jitter", "drift", "alternation", "gain", "zero", "zero_drift"}


class Synthetic(NamedTuple):
    """A synthetic record: channels of samples a step apart, and the used cycles.

    `motion` is what its sensors measure, and `slider` the rig that moves so.
    """

    channels: dict[str, Floats]
    cycles: Cycles
    motion: SampledMotion
    slider: Slider


def draw(plan: Plan, number: int, seed: int) -> tuple[Floats, Iterator[Synthetic | None]]:
    """Return normal scores drawn for one simulation, and its records."""
    random = np.random.default_rng([seed, number])
    drawn = plan.draw(random)
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
    for stated in plan.conditions:
        conditions = stated.truth_for(slider, plan.slider)
        drift, alternation = (values.get(each, 0.0) for each in ("drift", "alternation"))
        jitter = Jitter(spread, common, drift / conditions.cycles, alternation)
        rig = conditions.slider_of(slider)
        wanted, noise = conditions.cycles, conditions.noise["force"].error
        most = LONGEST_CYCLE * (wanted + SPARE) * conditions.cycle + first_loading(rig)
        step = conditions.step / min(conditions.block, MOST_PLACES)
        times: Floats = step * np.arange(int(most / step) + 1.0)
        motion = move(
            rig, times, jitter, random, cycle=conditions.cycle, cycles=wanted, noise=noise
        )
        channels = measure(conditions, rig, motion, values, random)
        values.pop("zero_drift", None)  # a zero drifts differently in each record
        found = slip_cycles(channels["force"], noise)
        enough = min(len(found.peak), len(motion.troughs)) >= wanted  # not of noise
        last = Cycles(*(each[-wanted:] for each in found))
        yield Synthetic(channels, last, motion, rig) if enough else None


def measure(
    conditions: Conditions, rig: Slider, motion: SampledMotion, values: Mapping[str, float],
    random: np.random.Generator,
) -> dict[str, Floats]:  # fmt: skip
    """Return the channels of a motion as their sensors show them, along the load cell's axis."""
    u_x, u_y = motion.rows[:, 0], motion.rows[:, 1]
    cell, (c, s) = rig.load_cell, rig.direction
    way = -1.0 if conditions.velocity < 0.0 else 1.0
    along, across = rig.k_x * u_x, rig.k_y * u_y
    exact = {
        "force": way * cell.along(along, across),
        "force_across": way * cell.across(along, across),
        "position": way * (conditions.velocity * motion.time - c * u_x - s * u_y),
    }
    places = min(conditions.block, MOST_PLACES)  # between two samples
    found, step = {}, conditions.step / places
    for name, noise in conditions.noise.items():
        gain, zero = random.standard_normal(2) * (noise.gain, noise.zero) + (1.0, 0.0)
        if name == "force":
            gain, zero = values.get("gain", 1.0), values.get("zero", 0.0)
        if noise.drift:
            drift = noise.drift * random.standard_normal()
            drift = values.get("zero_drift", drift) if name == "force" else drift
            zero = zero + drift * (motion.time - start_time(motion, exact["force"], conditions))
        shown = [each for each in noise.filters if each.cut * step <= FASTEST]
        values_of = gain * low_pass(exact[name], shown, 1.0 / step) + zero
        more = ceil(conditions.block / places) if noise.quantisation else 1
        readings, block = refine(values_of, more), places * more
        white = noise.level * block**0.5 * random.standard_normal(len(readings))
        readings = restore(readings, white, conditions.step / block, block, noise.cell)
        if noise.lasting:
            lasts = noise.lasts / conditions.step * block
            readings += draw_lasting(len(readings), noise.lasting, lasts, random)
        means = block_means(digitise(readings, noise.quantisation), block)
        found[name] = without_bands(means, conditions.step, noise.stop_bands)
    return found


def restore(
    values: Floats, white: Floats, step: float, block: int, cell: RingingCell | None
) -> Floats:
    """Return values, a step (s) apart, with noise; restored if the load cell rings.

    Means of blocks have as much noise as those of the white one.
    """
    if cell is None:
        return values + white
    noise = through(white, step, cell.restoration) / cell.amplification(step, block)
    return through(values, step, cell.smoothing) + noise


def refine(values: Floats, times: int) -> Floats:
    """Return `times` as many values, interpolated linearly.

    >>> refine(np.array([0.0, 2.0, 4.0]), 2)
    array([0., 1., 2., 3., 4., 4.])
    """
    if times == 1:
        return values
    rises = np.append(np.diff(values), 0.0)
    return np.asarray((values[:, None] + rises[:, None] * (np.arange(times) / times)).ravel())


def start_time(motion: SampledMotion, force: Floats, conditions: Conditions) -> float:
    """Return the start of a record with the used cycles, s."""
    used = slip_cycles(force).before[-conditions.cycles :]
    return (float(motion.time[used[0]]) if len(used) else 0.0) - conditions.lead
