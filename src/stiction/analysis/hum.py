"""A narrow line in a force, such as mains hum, estimated so that it can be taken off.

A line is coherent over the whole record: in its spectrum it is as narrow as the record is long,
far above what lies beside it, and alone. Harmonics of regular stick-slip are narrow as well, but
never alone. A vibration can be both: whether a line is the motion or beside it, cycles tell that
are left without it (`stiction.analysis.cycles`).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

EVEN = 0.1  # of a sample's distance: how far it may lie off an even grid
PERIODS = 16  # of a line that a record has at least
ABOVE = 300.0  # times the median power beside it: noise goes beyond in one of e^200 samples
HARMONIC = 30.0  # times that: so much is asked of a line's harmonics
BESIDE = 64  # samples of the spectrum to each side, over which the median is taken
LOBE = 4  # samples to each side that a line takes: the window's lobe, and wander of the mains
ALONE = 9.0  # times the largest power within half an octave
HARMONICS = 8
LEAST = 1e-12  # of the largest power: what is less is nothing
MUCH = 0.3  # of the power; the first harmonic of a sawtooth has 0.6
TRIED = 20  # of the strongest
BLOCK = 5  # periods in each mean of amplitude and phase
LONGEST = 250  # periods over which amplitude and phase are taken for constant


class Line(NamedTuple):
    """A narrow line and its harmonics.

    Parameters
    ----------
    frequency : float
        Hz.
    height : float
        From crest to trough, N.
    values : ndarray
        (n,) what of the force it makes, N.
    """

    frequency: float
    height: float
    values: Floats


def narrow_lines(time: Floats, force: Floats) -> list[Line]:
    """Return lines that are narrow and alone, at most two: those first that are most so.

    Parameters
    ----------
    time, force : ndarray
        (n,), s, evenly spaced, and N.
    """
    n = len(time)
    if n < 4 * PERIODS or np.ptp(force) == 0.0:
        return []
    step = (time[-1] - time[0]) / (n - 1)
    if np.abs(time - time[0] - step * np.arange(n)).max() > EVEN * step:
        return []
    power, bin_width = spectrum(force)
    floor = beside(power)
    return [_measured(force, step, power, floor, bin_width, at) for at in _alone(power, floor)]


def _measured(
    force: Floats, step: float, power: Floats, floor: Floats, width: float, at: int
) -> Line:
    """Return the line at a sample of the spectrum, with its harmonics."""
    from scipy.ndimage import uniform_filter1d  # type: ignore[attr-defined]

    cycles = _refined(power, at) * width  # per sample
    quick = force - uniform_filter1d(force, round(1.0 / cycles), mode="nearest")
    values = np.zeros(len(force))
    for k in range(1, HARMONICS + 1):
        at = round(k * cycles / width)
        if at >= len(power) - LOBE:
            break
        near = power[at - LOBE : at + LOBE + 1]
        if k == 1 or near.max() > HARMONIC * floor[at]:
            values += _line(quick - values, k * cycles, cycles)
    height = float(np.subtract(*np.percentile(values, (99.0, 1.0))))
    return Line(cycles / step, height, values)


def samples_per_period(force: Floats) -> float:
    """Return how many samples the strongest line has a period; infinity if none makes the force.

    A line makes the force if it is narrow and bears much of what varies.
    """
    if len(force) < 4 * PERIODS or np.ptp(force) == 0.0:
        return np.inf
    power, width = spectrum(force)
    at = int(np.argmax(power))
    line = float(power[max(at - LOBE, 0) : at + LOBE + 1].sum())
    makes = power[at] > ABOVE * beside(power)[at] and line > MUCH * float(power.sum())
    return 1.0 / (at * width) if makes and at > 0 else np.inf


def spectrum(force: Floats) -> tuple[Floats, float]:
    """Return the power of a force under a Hann window, and the width of its samples in cycles."""
    from scipy.fft import next_fast_len, rfft

    n = len(force)
    ramp = np.linspace(0.0, 1.0, n)
    level = force - force[0] - (force[-1] - force[0]) * ramp
    size = next_fast_len(n, real=True)  # type: ignore[no-untyped-call]
    window = 0.5 - 0.5 * np.cos(2.0 * np.pi * ramp)
    return np.abs(rfft((level - level.mean()) * window, size)) ** 2, 1.0 / size


def beside(power: Floats) -> Floats:
    """Return the median power around each sample of a spectrum, by blocks."""
    count = max(len(power) // BESIDE, 1)
    blocks = np.array_split(power, count)
    medians = np.array([np.median(block) for block in blocks])
    around = np.maximum.reduce([medians, np.roll(medians, 1), np.roll(medians, -1)])
    return np.repeat(around, [len(block) for block in blocks])


def _alone(power: Floats, floor: Floats) -> list[int]:
    """Return samples that stand out of those beside them, and are alone, the most so first."""
    candidate = power > ABOVE * np.maximum(floor, LEAST * power.max())
    candidate[:PERIODS] = candidate[-LOBE - 1 :] = False
    candidate[1:-1] &= (power[1:-1] >= power[2:]) & (power[1:-1] >= power[:-2])
    found = np.flatnonzero(candidate)
    alone = {}
    for at in found[np.argsort(-power[found])[:TRIED]].tolist():
        low, high = int(at / 1.5), int(at * 1.5) + 1
        others = max(power[low : at - LOBE].max(), power[at + LOBE + 1 : high].max(initial=0.0))
        if power[at] > ALONE * others:
            alone[at] = power[at] / max(others, 1e-300)
    return sorted(alone, key=lambda at: -alone[at])[:2]


def _refined(power: Floats, at: int) -> float:
    """Return the place of a line between samples, from the three highest under a Hann window."""
    before, here, after = np.sqrt(power[at - 1 : at + 2])
    return float(at + (after - before) / (before + here + after))


def _line(force: Floats, cycles: float, lowest: float) -> Floats:
    """Return the part of a force at a frequency (per sample), amplitude and phase as they are.

    They are averaged over blocks of a few periods, and these under a window.
    """
    n = len(force)
    turn = np.exp(-2j * np.pi * cycles * np.arange(n))
    edges = np.linspace(0, n, max(int(n * lowest / BLOCK), 2) + 1).astype(np.intp)
    size = np.diff(edges)
    means = np.add.reduceat(force * turn, edges[:-1])
    half = min(LONGEST // (2 * BLOCK), (len(size) - 1) // 2)
    window = np.hanning(2 * half + 3)[1:-1]
    near = np.convolve(means, window, "same") / np.convolve(size, window, "same")
    middle = 0.5 * (edges[1:] + edges[:-1] - 1)
    at = np.arange(n)
    envelope = np.interp(at, middle, near.real) + 1j * np.interp(at, middle, near.imag)
    return np.asarray(2.0 * (envelope * turn.conj()).real)
