"""The strongest line of a measured record, followed through time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from stiction.analysis.record import Record
from stiction.analysis.signals.ridge import follow_ridge
from stiction.analysis.signals.spectrum import spectrogram
from stiction.errors import ResultError

if TYPE_CHECKING:
    import xarray as xr

PERIODS = 100.0  # of the lowest frequency, in a window
AS_SAWTOOTH = 1.5  # times the amplitude of a sawtooth's harmonic
APART = 0.35  # of the cycles' frequency: wider lines of harmonics leave nothing between them
LOBE = 2.5  # lines to each side over which a Hamming window spreads a sine
SPREAD = 2.0  # standard deviations of the periods
MEAN_OF_HAMMING = 0.54  # of its peak: of a fall in its middle a window makes as much more
STEPS = 5  # windows that overlap at any time


def strongest_line(
    record: Record, low: float, *, width: float | None = None, cycles: xr.Dataset | None = None
) -> xr.Dataset:
    """Follow the strongest line of a measured force through time, if there is one.

    Parameters
    ----------
    record : Record
        With samples that are equally spaced.
    low : float
        Hz, above the frequencies of the stick-slip itself, a sawtooth with many harmonics; ten
        times its frequency is a good start.
    width : float, optional
        Width of the windows, s; by default a hundred periods of `low`, but at most a tenth of
        the record.
    cycles : Dataset, optional
        From `stiction.analysis.find_cycles`: their harmonics do not count as lines, see below.

    Returns
    -------
    Dataset
        As from `stiction.analysis.follow_ridge`, with amplitudes in N. The frequency is NaN where
        no line stands out of the noise, perhaps everywhere. A sawtooth of drop D has the amplitude
        D/(pi n) at n times its frequency: a line there that is hardly larger belongs to the shape
        of `cycles`.

    Raises
    ------
    ResultError
        If samples are not equally spaced, `low` is not below half the sample rate, or windows
        have too few samples.
    """
    steps, rate = np.diff(record.time), record.sample_rate
    if len(steps) == 0 or np.ptp(steps) > 0.5 * steps.mean():
        raise ResultError(
            "a spectrum needs samples that are equally spaced; interpolate the record first"
        )
    if not low > 0.0:
        raise ResultError(f"low must be above 0 Hz, is {low:g} Hz")
    if low >= 0.5 * rate:
        raise ResultError(
            f"a line above {low:.3g} Hz is seen at {2.0 * low:.3g} samples a second or more, of "
            f"which there are {rate:.3g}"
        )
    chosen = min(PERIODS / low, 0.1 * record.duration) if width is None else width
    if not 0.0 < chosen <= record.duration:
        raise ResultError(
            f"width must lie between 0 s and the record's {record.duration:g} s, is {chosen:g} s"
        )
    try:
        lines = spectrogram(
            record.force, rate, width=chosen, step=chosen / STEPS, start=float(record.time[0])
        )
        if cycles is not None and cycles.sizes["cycle"]:
            lines = _without_harmonics(lines, cycles, low)
        return follow_ridge(lines.assign_attrs(units="N"), low, 0.5 * rate)
    except ValueError as error:  # too few samples in a window, or lines above `low`
        raise ResultError(str(error)) from None


def _without_harmonics(lines: xr.DataArray, cycles: xr.Dataset, low: float) -> xr.DataArray:
    """Return a spectrogram with the harmonics of a sawtooth lowered to their surroundings."""
    frequency = lines["frequency"].values
    fundamental = 1.0 / float(cycles["period"].median())
    number, bin_width = frequency / fundamental, frequency[1] - frequency[0]
    # a line is as wide as the window makes it, and as the periods differ
    spread = float(cycles["period"].std()) * fundamental
    width = LOBE * bin_width / fundamental + SPREAD * spread * number
    near = np.abs(number - np.round(number)) < np.where(width < APART, width, 1.0)
    shortest = float(cycles["period"].quantile(0.1))
    lasts = min(shortest, MEAN_OF_HAMMING / bin_width)
    height = AS_SAWTOOTH * float(cycles["drop"].median()) / np.pi
    bound = height / np.maximum(frequency * lasts, 1.0)
    harmonic = near[:, None] & (lines.values < bound[:, None])
    band = lines.sel(frequency=slice(low, None))
    return lines.where(~harmonic, band.median("frequency"))
