"""The ridge of a spectrogram: one line followed in time, where it stands out of the noise."""

from __future__ import annotations

from math import exp, lgamma

import numpy as np

from stiction.arrays import TINY, Floats, Indices, xr
from stiction.errors import ResultError

# Amplitudes of noise are Rayleigh-distributed: 1 in 500 windows of 1000 lines has one that is
# five times their median; see `chance_of_noise`.
STANDS_OUT = 5.0
BESIDE = 25  # lines to each side that a line is compared with
LOBE = 5  # of them: a sine takes so many through a Hamming window
FEWEST = 3  # lines that a band needs, and others that a line is compared with
CHANCE = 3e-4  # of noise in a window, where few lines make their median uncertain
# Independent lines for each line of a Hamming window: powers of neighbours correlate
INDEPENDENT_LINES = 0.55


def follow_ridge(
    amplitude: xr.DataArray, low: float, high: float, *, jump: int = 4, stiffness: float = 0.1
) -> xr.Dataset:
    """Follow the strongest line of a spectrogram through time.

    Dynamic programming (R. Bellman; the path of A. Viterbi, IEEE Trans. Inf. Theory 13, 260 (1967))
    finds the path through the lines between `low` and `high` with the largest sum of log(amplitude)
    - stiffness (lines jumped)^2 over all windows. It does not leap to a stronger line for a moment,
    nor lose a line that fades. A parabola through the logarithms of the largest line and its
    neighbours gives the frequency.

    Parameters
    ----------
    amplitude : DataArray
        Over ``frequency`` (Hz, equally spaced) and ``time`` (s), from `spectrogram`.
    low, high : float
        Range of frequencies (Hz).
    jump : int, optional
        Largest jump from one window to the next, in lines.
    stiffness : float, optional
        Cost of a jump by one line.

    Returns
    -------
    Dataset
        Over ``time``: ``frequency`` (Hz), NaN where nothing stands out; ``amplitude`` (unit of
        the spectrogram); ``prominence``, its ratio to the median of the 51 lines around it at
        that time, inclined as they are; in a band of up to 25 lines, less the five of a sine. A
        line stands out from 5 on; in a band of fewer than 51 lines, whose median is less certain,
        from more: 5.8 for 30 lines, 19 for 11.

    Examples
    --------
    >>> import numpy as np, stiction as st
    >>> time = np.arange(0.0, 2.0, 1e-3)
    >>> amplitude = st.analysis.spectrogram(np.sin(2 * np.pi * 100.0 * time), 1e3)
    >>> ridge = st.analysis.follow_ridge(amplitude, low=50.0, high=200.0)
    >>> round(float(ridge["frequency"].mean()))
    100
    """
    band = amplitude.sel(frequency=slice(low, high))
    if band.sizes["frequency"] < FEWEST:
        raise ResultError(
            f"{band.sizes['frequency']} lines lie between {low:g} Hz and {high:g} Hz and at "
            f"least {FEWEST} are needed; widen the windows of the spectrogram"
        )
    level = np.log(np.maximum(band.values, _rounding(band.values)))
    path = best_path(level, jump, stiffness)
    peak, offset = _summits(level, path)
    lines = band["frequency"].values
    frequency = lines[path] + offset * (lines[1] - lines[0])
    height = np.exp(peak)
    prominence = np.exp(peak - _surroundings(level, lines, path))
    frequency[prominence < least_prominence(len(level))] = np.nan
    unit = amplitude.attrs.get("units", "")
    return xr.Dataset(
        {
            "frequency": ("time", frequency, {"units": "Hz", "long_name": "frequency of the line"}),
            "amplitude": ("time", height, {"units": unit, "long_name": "amplitude of the line"}),
            "prominence": ("time", prominence, {"units": "1", "long_name": "amplitude/median"}),
        },
        {"time": amplitude["time"]},
    )


def _rounding(amplitudes: Floats) -> float:
    """Return the amplitude below which lines are rounding errors, and as good as equal.

    A parabola through the logarithms of one of these and of a zero would rise far above both.
    """
    known = np.finfo(float)
    return float(max(known.eps * amplitudes.max(), known.tiny))


def least_prominence(lines: int) -> float:
    """Return the ratio to the median from which a line of a band of so many lines stands out.

    Examples
    --------
    >>> [round(least_prominence(lines), 1) for lines in (11, 30, 51, 1000)]
    [18.8, 5.8, 5.0, 5.0]
    """
    others, power = INDEPENDENT_LINES * _own_and_others(lines)[1], STANDS_OUT**2
    while lines <= 2 * BESIDE and lines * chance_of_noise(power, others) > CHANCE:
        power += 1.0
    return float(power**0.5)


def _own_and_others(lines: int) -> tuple[int, int]:
    """Return how many lines around a path are left out, and how many it is compared with.

    A sine's own lines make up much of a narrow band; in a wider one they hardly change a median.
    """
    own = min(LOBE, lines - FEWEST) if lines <= BESIDE else 0
    return own, min(2 * BESIDE + 1, lines) - own


def chance_of_noise(ratio: float, lines: float) -> float:
    """Return the probability that the power of noise in a line is `ratio` medians of other lines.

    Powers of noise are exponentially distributed. Their median over n lines is the sum of E_j/j
    for j from n/2 to n, with E_j exponential as well (A. Renyi, Acta Math. Acad. Sci. Hung. 4, 191
    (1953)), so that the mean of exp(-ratio median) is the product of j/(j + ratio).

    Examples
    --------
    >>> f"{chance_of_noise(25.0, 51):.1g}"  # 2^-25 is 3e-8: the median is uncertain
    '2e-06'
    """
    above, below = lines + 1.0, 0.5 * (lines + 1.0)
    return exp(lgamma(above) - lgamma(below) + lgamma(below + ratio) - lgamma(above + ratio))


def _surroundings(level: Floats, lines: Floats, path: Indices) -> Floats:
    """Return the logarithm of the median of the lines around a path, at each time.

    Noise that falls off with frequency lifts the lines at the lower end of a band above the median
    of those around them, all of which are higher: a power of the frequency leads through the
    medians of the lower and the upper half. Beyond these it is twice as uncertain: there it may
    lift the level, not lower it. Each line counts once, however few there are.
    """
    own, count = _own_and_others(len(level))
    first = np.clip(path - BESIDE, 0, len(level) - own - count)
    rows = first + np.arange(count)[:, None]
    rows += own * (rows >= np.clip(path - own // 2, 0, len(level) - own))
    around, octave = level[rows, np.arange(len(path))], np.log(lines[rows])
    halves = slice((count + 1) // 2), slice(count // 2, None)
    low, high = (np.median(around[half], axis=0) for half in halves)
    left, right = (np.median(octave[half], axis=0) for half in halves)
    share = (np.log(lines[path]) - left) / np.maximum(right - left, TINY)
    share = np.where(right > left, share, 0.5)
    nearer = np.where(share < 0.0, low, np.where(share > 1.0, high, -np.inf))
    return np.asarray(np.maximum(low + share * (high - low), nearer))


def best_path(level: Floats, jump: int, stiffness: float) -> Indices:
    """Return the line (m,) at each time that maximises the sum of levels minus jump costs.

    `level` is (n lines, m times).
    """
    lines, times = level.shape
    shifts = np.arange(-jump, jump + 1)
    cost = stiffness * shifts.astype(np.float64) ** 2
    padded = np.full(lines + 2 * jump, -np.inf)
    middle = padded[jump : jump + lines]
    before = np.lib.stride_tricks.sliding_window_view(padded, 2 * jump + 1)
    came = np.zeros((times, lines), np.intp)
    each = np.arange(lines)
    middle[:] = level[:, 0]
    for k in range(1, times):
        reached = before - cost
        came[k] = reached.argmax(axis=1)
        middle[:] = reached[each, came[k]] + level[:, k]
        middle -= middle.max()  # sums stay small
    path = np.empty(times, np.intp)
    path[-1] = middle.argmax()
    for k in range(times - 1, 0, -1):
        path[k - 1] = path[k] + shifts[came[k, path[k]]]
    return path


def _summits(level: Floats, path: Indices) -> tuple[Floats, Floats]:
    """Return height and offset (in lines) of the parabolas through three points near the path.

    Their middle is the highest of three lines: where a frequency lies half-way between two, the
    path may stay on the lower one.
    """
    times = np.arange(level.shape[1])
    inner = path.clip(1, level.shape[0] - 2)
    beside = np.stack([level[inner + k, times] for k in (-1, 0, 1)])
    inner = (inner + np.argmax(beside, axis=0) - 1).clip(1, level.shape[0] - 2)
    left, mid, right = (level[inner + k, times] for k in (-1, 0, 1))
    bend = left - 2.0 * mid + right
    summit = (np.abs(inner - path) <= 1) & (mid >= left) & (mid >= right) & (bend < 0.0)
    offset = np.where(summit, 0.5 * (left - right) / np.where(summit, bend, -1.0), 0.0)
    height = np.where(summit, mid - 0.25 * (left - right) * offset, level[path, times])
    return height, np.where(summit, inner - path + offset, 0.0)
