"""A sensor's errors from its samples: white noise, and the steps of digitised readings."""

from __future__ import annotations

from math import comb, exp, inf, pi, sqrt
from typing import NamedTuple

import numpy as np

from stiction.arrays import NORMAL_MEDIAN, Floats, compute_once, median

ORDER = 4  # of the differences: a sine at a tenth of the sample rate keeps 0.15 of its amplitude
FEWEST_SAMPLES = 64  # so many tell white noise to a fifth
CODES = 12  # at least so many different values, by which a lattice is recognised
REPEATED = 4  # samples for each of them, on average
SOME = 3  # in the first third of the values there may be more different ones than in a lattice
LARGEST_STEP = 100_000  # steps of a difference: larger ones count as that
OFF_LATTICE = 0.15  # of a step: how far a value may lie off
ON_LATTICE = 0.99  # of the values
ROUNDING_SPREAD = 12.0**-0.5  # of a step: standard deviation of the rounding to it
TWO_CODES = 1.5  # steps: values within it are of two codes at most
HIDDEN = 0.05  # of a step of rounding: less noise than that cannot be told from it
FEW_STEPS = 2.0  # of noise, by which the rounding of a ramp is white, and more
ENOUGH = 100_000  # samples, which tell the noise to half a percent
SLIPPING = 1.5  # times the noise that differences of fourth order show: slips are not noise
WINDOW = 16  # differences, in which a force rises steadily
SLIPS = 3.0  # times the usual span of these differences: a slip is among them
HARMONICS = 6  # of a rounded ramp: the next adds less than 0.01 of a step to its noise

SEEMING = 20.0  # standard deviations: what moves by less may be at rest


class NoiseLevel(NamedTuple):
    """Standard deviation of white noise, and the step between readings; 0 where none is seen."""

    noise: float
    quantisation: float


def noise_level(values: Floats) -> NoiseLevel:
    """Estimate noise and quantisation of equally spaced samples.

    See `white_noise` and `resolved_noise`. Noise that a filter has taken away near half the sample
    rate is not seen.

    Examples
    --------
    >>> import numpy as np
    >>> random = np.random.default_rng(1)
    >>> smooth = np.sin(np.linspace(0.0, 20.0, 20000))
    >>> round(noise_level(smooth + 0.01 * random.standard_normal(20000)).noise, 3)
    0.01
    """
    if len(values) < FEWEST_SAMPLES:
        return NoiseLevel(0.0, 0.0)
    step = lattice(values)
    return NoiseLevel(resolved_noise(values, step), step)


@compute_once
def resolved_noise(values: Floats, step: float) -> float:
    """Return the standard deviation of white noise on multiples of a step; 0 if it is hidden.

    A quantisation of step q adds q^2/12 to the variance (B. Widrow & I. Kollar, Quantization Noise,
    Cambridge 2008, chapter 4), if the noise is larger. Noise below a twentieth of a step is hidden.
    """
    found = white_noise(values, step)
    large = sqrt(max(found**2 - (ROUNDING_SPREAD * step) ** 2, 0.0))
    if found >= FEW_STEPS * step or len(values) <= WINDOW:  # or nothing is rounded
        return large
    within = step * noise_within_steps(values[:ENOUGH] / step)
    if within > SLIPPING * max(found, 0.5 * step):
        return large  # slips are in every window
    return within if within > HIDDEN * step else 0.0


def noise_within_steps(values: Floats) -> float:
    """Return the standard deviation of white noise of a few steps, before rounding to integers.

    The rounding of a ramp is not white. A ramp that rises by s a sample, at any height, with noise
    of variance v and rounded has differences of variance

    2 v + 1/6 - sum_k cos(2 pi k s) exp(-4 pi^2 k^2 v) / (pi k)^2,

    since a rounded difference d is floor(d) or floor(d) + 1 at random. Variance and s are those of
    short windows, in each of which s is a line; windows with a slip are left out.
    """
    rises = np.diff(values)
    windows = rises[: len(rises) // WINDOW * WINDOW].reshape(-1, WINDOW)
    line = np.polynomial.legendre.legvander(np.linspace(-1.0, 1.0, WINDOW), 1)
    slopes = windows @ np.linalg.pinv(line).T @ line.T
    left = windows - slopes
    spans = np.ptp(left, axis=1)
    quiet = spans <= SLIPS * max(float(np.median(spans)), 1.0)
    harmonics = np.arange(1, HARMONICS + 1)
    waves = np.cos(2.0 * pi * harmonics * slopes[quiet][..., None]).mean(axis=(0, 1))
    levels = np.linspace(0.0, 2.0 * FEW_STEPS, 401)
    fading = np.exp(-4.0 * pi**2 * np.outer(levels**2, harmonics**2)) / (pi * harmonics) ** 2
    variances = 2.0 * levels**2 + 1.0 / 6.0 - fading @ waves
    return float(np.interp(np.mean(left[quiet] ** 2), variances, levels))


@compute_once
def white_noise(values: Floats, step: float = 0.0, *, order: int = ORDER) -> float:
    """Return the standard deviation of white noise on something smooth, in multiples of a `step`.

    It follows from differences, which cancel what is smooth over `order` + 1 samples (T. Gasser,
    L. Sroka & C. Jennen-Steinmetz, Biometrika 73, 625 (1986)), by the median of their size, which a
    few slips do not move. Samples that are too few for it show no noise.
    """
    if len(values) <= order:
        return 0.0
    gain = sqrt(difference_gain(order))
    return _median(np.abs(np.diff(values, order)), step) / (NORMAL_MEDIAN * gain)


def difference_gain(order: int) -> int:
    """Return the variance of white noise's differences over that of the noise.

    It is the sum of the squares of their weights, which are binomial coefficients.
    """
    return comb(2 * order, order)


def rounding_error(values: Floats, step: float) -> float:
    """Return the standard deviation of the rounding to a step that noise does not average away."""
    return ROUNDING_SPREAD * step * dither_remainder(values, step) if step else 0.0


def dither_remainder(values: Floats, step: float) -> float:
    """Return the share of the first harmonic of the rounding to a step that noise leaves.

    It is the characteristic function of Gaussian noise at a frequency of one over the step (B.
    Widrow & I. Kollar, Quantization Noise, Cambridge 2008).
    Between two codes nothing tells the noise: it seems to be half a step.
    """
    if float(np.ptp(values)) < TWO_CODES * step:
        return 1.0
    return exp(-2.0 * pi**2 * (resolved_noise(values, step) / step) ** 2)


def _median(values: Floats, step: float) -> float:
    """Return the median of sizes; of multiples of a step, spread evenly over half a step around."""
    if step == 0.0:
        return median(values)
    number = np.rint(values / step).astype(np.int64)
    counts = np.bincount(np.minimum(number, LARGEST_STEP))
    below = np.cumsum(counts) - counts
    at = int(np.searchsorted(np.cumsum(counts), 0.5 * len(values)))
    low, wide = max(at - 0.5, 0.0), 1.0 if at else 0.5
    return step * (low + wide * (0.5 * len(values) - float(below[at])) / float(counts[at]))


def lattice(values: Floats) -> float:
    """Return the common step of all values, up to a constant; 0 if there is none.

    It is that of a converter for sure: there are at least a dozen codes, and four samples of each.
    `stiction.analysis.signals.digitised.resolution` bounds the rounding of any other signal.

    Examples
    --------
    >>> import numpy as np
    >>> smooth = np.sin(np.arange(2000.0))
    >>> round(lattice(0.25 * np.rint(40.0 * smooth)), 9), lattice(smooth)
    (0.25, 0.0)
    """
    if REPEATED * len(np.unique(values[: len(values) // SOME])) > len(values):
        return 0.0
    codes = np.unique(values)
    if len(codes) < CODES or REPEATED * len(codes) > len(values):
        return 0.0
    codes = _merge(codes)
    gaps = np.diff(codes)
    step = float(np.median(gaps[gaps < 1.5 * gaps.min()]))
    # the number of steps is known near the first code, and is followed outwards
    number = np.concatenate([[0.0], np.cumsum(np.rint(gaps / step))])
    slope, at = np.polyfit(number, codes, 1)
    off = np.abs(codes - (at + slope * number))
    return float(slope) if np.mean(off < OFF_LATTICE * slope) >= ON_LATTICE else 0.0


def _merge(codes: Floats) -> Floats:
    """Return sorted values; of those that differ by rounding alone, only the first."""
    apart = np.diff(codes, prepend=-np.inf) > 1e-9 * float(np.ptp(codes))
    return codes[apart]


def seeming_motion(position: Floats) -> float:
    """Return how far a displacement may seem to move at rest, m; infinite for a few samples."""
    return SEEMING * white_noise(position) if len(position) > ORDER else inf
