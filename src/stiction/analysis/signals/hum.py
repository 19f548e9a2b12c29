"""Narrow lines in a force, such as mains hum, estimated to be subtracted.

A line is coherent over the whole record: in the spectrum it is as narrow as the record's length
allows, far above its surroundings, and alone. Harmonics of regular stick-slip are narrow too, but
never alone. A vibration can be both narrow and alone: the cycles that remain without the line
decide whether it is the motion or a disturbance (`stiction.analysis.motion.cycles`).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from stiction.analysis.signals.even_grid import EvenGrid, even_grid
from stiction.analysis.signals.robust import inner_product, uniform_mean
from stiction.analysis.signals.spectrum import spectrum
from stiction.arrays import TINY, Complex, Floats, compute_once, median

PERIODS = 16  # of a line, or a vibration, that a record has at least
ABOVE = 30.0  # times the median power beside it: noise goes beyond in one of a million samples
BESIDE = 64  # at least so many samples of the spectrum, over which the median is taken
LOBE = 4  # samples of the spectrum to each side that a line takes: the window's lobe
WANDERS = 2e-3  # of its frequency, to each side: the mains keep theirs to 0.1 Hz
HANN = 2  # samples of the spectrum to each side that the window makes of a constant line
WHOLE = 0.95  # of the power: with so much two lines are the whole vibration
FAINT = 0.1  # of a line's highest power: what is less may be something else
ALONE = 9.0  # times the largest power within half an octave
HARMONICS = 8
LEAST_POWER = 1e-12  # of the largest power: what is less is nothing
MUCH = 0.3  # of the power; the first harmonic of a sawtooth has 0.6
TRIED = 20  # of the strongest
MOST_LINES = 4  # that are returned: cycles are sought again without each of them
BLOCK = 5  # periods in each mean of amplitude and phase
LONGEST_PART = 250  # periods over which amplitude and phase are taken for constant
# Half the width of the band in which a line takes what is not its own, times these periods: the
# window over them passes two of their frequency.
PASSED = 2.5

MAINS, MAINS_VARIES = (50.0, 60.0, 100.0, 120.0), 0.004  # Hz; a grid keeps its frequency to 0.4 %


class Band(NamedTuple):
    """A band of frequencies, Hz."""

    low: float
    high: float


class Line(NamedTuple):
    """A narrow line and its harmonics.

    Parameters
    ----------
    frequency : float
        Hz.
    height : float
        From crest to trough, N.
    values : ndarray
        (n,) its contribution to the force, N.
    bands : tuple of Band
        In which it and its harmonics lie, with what they take of the motion.
    clearness : float
        How far it stands out, in units of what noise does not reach.
    """

    frequency: float
    height: float
    values: Floats
    bands: tuple[Band, ...] = ()
    clearness: float = 1.0


def narrow_lines(grid: EvenGrid | None, force: Floats, least: float = 1.0) -> list[Line]:
    """Return up to four narrow lines of a least clearness, the most isolated first."""
    seen = _spectrum_on_grid(force, grid)
    if grid is None or seen is None:
        return []
    power, floor, _ = seen
    return [
        _measure_line(force, grid, seen, at)._replace(
            clearness=min(float(power[at] / max(ABOVE * floor[at], TINY)), alone / ALONE)
        )
        for at, alone in _peaks(power, floor, least * ABOVE, least * ALONE).items()
    ]


def line_near(grid: EvenGrid, force: Floats, frequency: float) -> Line | None:
    """Return the line at one of the `peak_frequencies` (Hz), alone or not; None without any."""
    seen = _spectrum_on_grid(force, grid)
    if seen is None:
        return None
    at = min(max(round(frequency * grid.step / seen.width), 1), len(seen.power) - 1)
    return _measure_line(force, grid, seen, at)


def lines_like(lines: Sequence[Line], grid: EvenGrid, values: Floats, least: float) -> list[Line]:
    """Return the narrow lines of another channel that belong to the mains or to given lines.

    Lines of the mains count from a frequency `least` (Hz) on: slower ones may be the cycles' own.
    """
    return [
        line
        for line in narrow_lines(grid, values)
        if (line.frequency >= least and of_mains(line.frequency))
        or any(abs(line.frequency / each.frequency - 1.0) < MAINS_VARIES for each in lines)
    ]


def without_bands(values: Floats, step: float, bands: Sequence[Band]) -> Floats:
    """Return equally spaced values, a step (s) apart, without some bands of frequencies.

    Whatever is subtracted within them makes no difference.

    >>> time = np.arange(0.0, 10.0, 0.01)
    >>> saw = time % 1.0
    >>> hum = saw + 0.3 * np.sin(2.0 * np.pi * 20.0 * time)
    >>> left, right = (without_bands(each, 0.01, [Band(19.5, 20.5)]) for each in (saw, hum))
    >>> float(np.abs(right - left).max()) < 0.01
    True
    """
    if not bands:
        return values
    ramp = np.linspace(values[0], values[-1], len(values))
    powers = np.fft.rfft(values - ramp)
    frequencies = np.fft.rfftfreq(len(values), step)
    for low, high in bands:
        powers[(frequencies >= low) & (frequencies <= high)] = 0.0
    return np.asarray(np.fft.irfft(powers, len(values)) + ramp)


def peak_frequencies(grid: EvenGrid | None, force: Floats) -> list[float]:
    """Return up to four frequencies (Hz) at which the spectrum is highest within half an octave.

    The clearest first, as in `narrow_lines`; but these may be broad, and not alone.
    """
    seen = _spectrum_on_grid(force, grid)
    if grid is None or seen is None:
        return []
    found = _peaks(seen.power, seen.floor, ABOVE, 1.0)
    return [_middle(seen.power, at) * seen.width / grid.step for at in found]


class _Spectrum(NamedTuple):
    """Power of a force, the floor beside each sample, and the samples' width in cycles."""

    power: Floats
    floor: Floats
    width: float


@compute_once
def _spectrum_on_grid(force: Floats, grid: EvenGrid | None) -> _Spectrum | None:
    """Return the `spectrum` of a force on the grid of its times; None if it can show no line."""
    if grid is None or not grid.serves or grid.size < 4 * PERIODS or np.ptp(force) == 0.0:
        return None
    power, width = spectrum(grid.on(force))
    floor = beside(power)
    for each in (power, floor):
        each.setflags(write=False)  # all that ask for it have the same
    return _Spectrum(power, floor, width)


def _measure_line(force: Floats, grid: EvenGrid, seen: _Spectrum, at: int) -> Line:
    """Return the line at a sample of the spectrum, with its harmonics, at the record's times."""
    power, floor, width = seen
    cycles = _middle(power, at) * width  # per sample
    length = round(1.0 / cycles)
    even = grid.on(force)
    slow = uniform_mean(even, length)
    quick, left = even - slow, force - grid.between(slow)
    turn = np.exp(2j * np.pi * cycles * np.arange(len(even)))
    for _ in range(2):  # as it wanders
        phase = _envelope(quick * turn.conj(), cycles)
        turn *= phase / np.maximum(np.abs(phase), TINY)
    values = np.zeros(len(grid.places))
    turned = np.unwrap(np.angle(turn))
    half, bands = PASSED * cycles / min(LONGEST_PART, cycles * grid.size), []
    for k in range(1, HARMONICS + 1):
        at = round(k * cycles / width)
        if at >= len(power) - LOBE:
            break
        if k == 1 or power[_lobe(at)].max() > ABOVE * floor[at]:
            own, turns = turn**k, np.pi * k * cycles
            passed = 1.0 - np.sin(length * turns) / (length * np.sin(turns))
            envelope = _envelope(quick * own.conj(), cycles)
            if not grid.exact:
                envelope = grid.between(envelope)
                own = np.exp(1j * k * grid.between(turned))
            harmonic = 2.0 / passed * (envelope * own).real
            if not grid.exact:  # on the grid it is smaller
                harmonic *= _gain(left - values, harmonic)
            values += harmonic
            bands.append(Band((k * cycles - half) / grid.step, (k * cycles + half) / grid.step))
    height = float(np.subtract(*np.percentile(values, (99.0, 1.0))))
    return Line(cycles / grid.step, height, values, tuple(bands))


def _gain(force: Floats, line: Floats) -> float:
    """Return the factor by which a line fits a force best."""
    size = inner_product(line, line)
    return inner_product(force, line) / size if size > 0.0 else 1.0


def beat_frequency(time: Floats, force: Floats) -> float | None:
    """Return the frequency (Hz) at which two lines beat if they are the whole vibration; else None.

    Noise in a band of frequencies has as many lines as the band is wide.
    """
    grid = even_grid(time)
    seen = _spectrum_on_grid(force, grid)
    if grid is None or seen is None:
        return None
    power, width = seen.power.copy(), seen.width
    power[:PERIODS] = 0.0
    total, lines = float(power.sum()), []
    for _ in range(2):
        at = int(np.argmax(power))
        lobe = slice(max(at - HANN, 0), at + HANN + 1)
        lines.append((at, float(power[lobe].sum())))
        power[lobe] = 0.0
    (first, high), (second, low) = lines
    apart, both = abs(first - second), high + low > WHOLE * total and low > FAINT * high
    return apart * width / grid.step if both and apart > 2 * HANN else None


def of_mains(frequency: float) -> bool:
    """Return whether a frequency (Hz) is the mains frequency or twice it."""
    return any(abs(frequency / line - 1.0) < MAINS_VARIES for line in MAINS)


def samples_per_period(force: Floats) -> float:
    """Return the samples per period of the dominant line; infinity if there is none.

    A line is dominant if it is narrow and carries much of the variance.
    """
    if len(force) < 4 * PERIODS or np.ptp(force) == 0.0:
        return np.inf
    power, width = spectrum(force)
    at = int(np.argmax(power))
    line = float(power[_lobe(at)].sum())
    makes = power[at] > ABOVE * beside(power)[at] and line > MUCH * float(power.sum())
    return 1.0 / (at * width) if makes and at > 0 else np.inf


def beside(power: Floats) -> Floats:
    """Return the median power around each sample of a spectrum, by blocks.

    The last block takes the remainder: a line would fill a short one.
    """
    edges = [0]
    while len(power) - edges[-1] >= (width := max(BESIDE, int(10.0 * WANDERS * edges[-1]))):
        edges.append(edges[-1] + width)
    edges = [*edges[: max(len(edges) - 1, 1)], len(power)]
    size = np.diff(edges)
    medians = np.array([median(block) for block in np.split(power, edges[1:-1])])
    around = np.maximum.reduce([medians, np.roll(medians, 1), np.roll(medians, -1)])
    return np.repeat(around, size)


def _peaks(power: Floats, floor: Floats, above: float, alone: float) -> dict[int, float]:
    """Return by how much some samples exceed all others within half an octave, the largest first.

    By the factor `alone` at least; and the floor by the factor `above`.
    """
    candidate = power > above * np.maximum(floor, LEAST_POWER * power.max())
    candidate[:PERIODS] = candidate[-LOBE - 1 :] = False
    candidate[1:-1] &= (power[1:-1] >= power[2:]) & (power[1:-1] >= power[:-2])
    found = np.flatnonzero(candidate)
    exceeds = {}
    for at in found[np.argsort(-power[found])[:TRIED]].tolist():
        low, high, own = int(at / 1.5), int(at * 1.5) + 1, _lobe(at)
        others = max(power[low : own.start].max(), power[own.stop : high].max(initial=0.0))
        if power[at] > alone * others:
            exceeds[at] = float(power[at] / max(others, TINY))
    return dict(sorted(exceeds.items(), key=lambda each: -each[1])[:MOST_LINES])


def _lobe(at: int) -> slice:
    """Return the samples of a spectrum in the lobe of a line with its maximum at `at`."""
    half = LOBE + round(WANDERS * at)
    return slice(max(at - half, 0), at + half + 1)


def _middle(power: Floats, at: int) -> float:
    """Return the position of a line between samples: the power-weighted mean over its lobe."""
    lobe = _lobe(at)
    weight = np.where(power[lobe] > FAINT * power[at], power[lobe], 0.0)
    return float(lobe.start + np.average(np.arange(len(weight)), weights=weight))


def _envelope(turned: Complex, cycles: float) -> Complex:
    """Return a line's amplitude and phase from a force demodulated at its frequency.

    They are averaged over blocks of a few periods. A windowed straight line is fitted around each
    block, so that the ends of the record are as accurate as its middle.
    """
    n = len(turned)
    edges = np.linspace(0, n, max(int(n * cycles / BLOCK), 3) + 1).astype(np.intp)
    size = np.diff(edges)
    means = np.add.reduceat(turned, edges[:-1])
    half = min(LONGEST_PART // (2 * BLOCK), (len(size) - 1) // 2)
    away = np.arange(-half, half + 1)
    weights = [np.hanning(2 * half + 3)[1:-1] * away**power for power in range(3)]
    s0, s1, s2 = (np.convolve(size, weight, "same") for weight in weights)
    t0, t1 = (np.convolve(means, weight, "same") for weight in weights[:2])
    near = (s2 * t0 - s1 * t1) / (s0 * s2 - s1**2)
    middle = 0.5 * (edges[1:] + edges[:-1] - 1)
    at = np.arange(n)
    return np.asarray(np.interp(at, middle, near.real) + 1j * np.interp(at, middle, near.imag))
