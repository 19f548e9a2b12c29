"""A regular wave under the cycles, such as a disc's that turns askew."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from stiction.analysis.motion.cycle_columns import CycleTable
from stiction.analysis.signals.straight_line import line
from stiction.arrays import TINY, Complex, Floats

# Cycles, turns of the wave, and cycles in each, at least
FEWEST_CYCLES, TURNS, PER_TURN = 16, 4.0, 3.0
FINE_FREQUENCIES = 8  # frequencies tried in each that a record resolves
# Share of the variance of the cycles' middles about a line that is the wave's, how alike it is in
# both halves of a record, and its height over the median drop. Of 4000 random walks, white middles
# and friction that wanders and comes back none has such a wave.
EXPLAINS, ALIKE_HALVES, WORTH = 0.6, 0.8, 0.1


class SlowWave(NamedTuple):
    """A wave: from crest to trough (N), and its period (s)."""

    height: float
    period: float


def regular_wave(table: CycleTable) -> SlowWave | None:
    """Return the regular wave on which the middles of the cycles lie, if there is one."""
    if len(table) < FEWEST_CYCLES:
        return None
    at = 0.5 * (table["peak_time"] + table["trough_time"])
    middle = 0.5 * (table["peak"] + table["trough"])
    left = _without_line(at, middle)
    frequency = _strongest_frequency(at, left)
    if frequency is None:
        return None
    turned, half = np.exp(-2j * np.pi * frequency * (at - at[0])), len(table) // 2
    whole, explained = _fit_sine(turned, left)
    first, last = (
        _fit_sine(turned[part], _without_line(at[part], middle[part]))[0]
        for part in (slice(half), slice(half, None))
    )
    alike = 2.0 * (first * last.conjugate()).real / (abs(first) ** 2 + abs(last) ** 2 + TINY)
    height = 2.0 * abs(whole)
    if explained < EXPLAINS or alike < ALIKE_HALVES or height < WORTH * table.median("drop"):
        return None
    return SlowWave(height, 1.0 / frequency)


def _strongest_frequency(at: Floats, values: Floats) -> float | None:
    """Return the frequency (Hz) of the strongest line in values at some times, s."""
    from scipy.fft import rfft

    count = 2 * len(at)
    even = np.interp(np.linspace(at[0], at[-1], count), at, values)
    power = np.abs(rfft(even * np.hanning(count), FINE_FREQUENCIES * count))
    low, high = int(FINE_FREQUENCIES * TURNS), int(FINE_FREQUENCIES * len(at) / PER_TURN)
    if high <= low or not power[low:high].any():
        return None
    best = low + int(np.argmax(power[low:high]))
    return best * (count - 1) / (FINE_FREQUENCIES * count) / float(at[-1] - at[0])


def _without_line(at: Floats, values: Floats) -> Floats:
    """Return values less the straight line through them."""
    return line(at, values).deviations(at, values)


def _fit_sine(turned: Complex, values: Floats) -> tuple[complex, float]:
    """Return amplitude and phase of a sine, and the share of the variance that it explains."""
    columns = np.column_stack([turned.real, turned.imag, np.ones(len(values))])
    fit, *_ = np.linalg.lstsq(columns, values, rcond=None)
    left = values - columns @ fit
    total = float(values.var())
    return complex(fit[0], fit[1]), 1.0 - float(left.var()) / total if total > 0.0 else 0.0
