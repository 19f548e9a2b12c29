"""The strongest line of a measured record, followed through time."""

from __future__ import annotations

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from stiction.analysis.record import Record
from stiction.analysis.signals.digitised import rounding_line
from stiction.analysis.signals.even_grid import EvenGrid, even_grid, why_not
from stiction.analysis.signals.ridge import follow_ridge
from stiction.analysis.signals.spectrum import spectrogram
from stiction.arrays import xr
from stiction.errors import ResultError

PERIODS = 100.0  # of the lowest frequency, in a window
# Times the amplitude of a sawtooth's harmonic, or of the rounding's; a force of two levels has 2
AS_SAWTOOTH = 2.5
APART = 0.35  # of the cycles' frequency: wider lines of harmonics leave nothing between them
LOBE = 2.5  # lines to each side over which a Hamming window spreads a sine
SPREAD = 2.0  # standard deviations of the periods
MEAN_OF_HAMMING = 0.54  # of its peak: of a fall in its middle a window makes as much more
STEPS = 5  # windows that overlap at any time
LOST = 0.25  # of a window's samples: with more of them missing it shows no line
# Standard error of a steady line's frequency, in lines of the spectrum: that of the parabola
# through the logarithms, and of noise times the prominence, measured on random lines.
BIAS, NOISE = 0.03, 0.8


def strongest_line(
    record: Record, low: float, *, width: float | None = None, cycles: xr.Dataset | None = None
) -> xr.Dataset:
    """Follow the strongest line of a measured force through time, if there is one.

    Parameters
    ----------
    record : Record
        Samples that are not equally spaced are interpolated on an even grid by straight lines;
        windows with gaps of more than a quarter show no line.
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
        If more than a tenth of the samples are missing, `low` is not below half the sample rate,
        or windows have too few samples.

    Examples
    --------
    >>> import numpy as np, stiction as st
    >>> time = np.arange(0.0, 20.0, 1e-3)
    >>> force = 1.0 + 0.1 * np.sin(2 * np.pi * 120.0 * time)
    >>> found = st.analysis.strongest_line(st.Record(time=time, force=force), low=60.0)
    >>> round(float(found["frequency"].mean()))
    120
    """
    grid = even_grid(record.time)
    if grid is None or not grid.serves:
        raise ResultError(why_not(grid))
    rate = 1.0 / grid.step
    if not low > 0.0:
        raise ResultError(f"low must be above 0 Hz, is {low:g} Hz")
    if low >= 0.5 * rate:
        raise ResultError(
            f"a line above {low:.3g} Hz needs more than {2.0 * low:.3g} samples a second, and the "
            f"record has {rate:.3g}"
        )
    chosen = min(PERIODS / low, 0.1 * record.duration) if width is None else width
    if not 0.0 < chosen <= record.duration:
        raise ResultError(
            f"width must lie between 0 s and the record's {record.duration:g} s, is {chosen:g} s"
        )
    try:
        lines = spectrogram(
            grid.on(record.force), rate, width=chosen, step=chosen / STEPS, start=grid.start
        )
        if cycles is not None and cycles.sizes["cycle"]:
            lines = _without_harmonics(lines, cycles, low)
        found = follow_ridge(lines.assign_attrs(units="N"), low, 0.5 * rate)
    except ValueError as error:  # too few samples in a window, or lines above `low`
        raise ResultError(str(error)) from None
    seen = _missing_share(grid, found, chosen) <= LOST
    seen &= found["amplitude"].values > AS_SAWTOOTH * rounding_line(record.force)
    found["frequency"] = found["frequency"].where(seen)
    found["frequency"] = found["frequency"].where(_lasting(found["frequency"].notnull().values))
    return found.assign(frequency_error=_frequency_error(found, lines))


def _lasting(seen: np.ndarray) -> np.ndarray:
    """Return where two windows without a common sample show a line, and not one event.

    The bend at the end of a loading, or a jump, has lines of every frequency, in the windows that
    contain it.
    """
    at = np.flatnonzero(seen)
    groups = np.split(at, np.flatnonzero(np.diff(at) > STEPS) + 1)
    lasting = [each for each in groups if len(each) and np.ptp(each) >= min(STEPS, len(seen) - 1)]
    return np.isin(np.arange(len(seen)), np.concatenate([at[:0], *lasting]))


def _missing_share(grid: EvenGrid, found: xr.Dataset, width: float) -> np.ndarray:
    """Return the share of samples that are missing in each window."""
    lost = np.concatenate([[0], np.cumsum(grid.missing)])
    middle = (found["time"].values - grid.start) / grid.step
    half = 0.5 * width / grid.step
    ends = np.clip(np.rint([middle - half, middle + half]).astype(np.intp), 0, grid.size)
    return np.asarray((lost[ends[1]] - lost[ends[0]]) / np.maximum(ends[1] - ends[0], 1))


def _frequency_error(found: xr.Dataset, lines: xr.DataArray) -> xr.DataArray:
    """Return the standard error of the frequency in each window (Hz)."""
    bin_width = float(lines["frequency"][1] - lines["frequency"][0])
    error = bin_width * (BIAS**2 + (NOISE / found["prominence"]) ** 2) ** 0.5
    named = {"units": "Hz", "long_name": "standard error of the frequency"}
    return error.where(found["frequency"].notnull()).assign_attrs(named)


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
    harmonic = near[:, None] & ~_with_lobe(lines.values >= bound[:, None])
    band = lines.sel(frequency=slice(low, None))
    return lines.where(~harmonic, band.median("frequency"))


def _with_lobe(stands: np.ndarray) -> np.ndarray:
    """Return a mask of a line and its neighbours: its lobe determines its place between samples."""
    half = int(LOBE)
    beside = sliding_window_view(np.pad(stands, ((half, half), (0, 0))), 2 * half + 1, axis=0)
    return np.asarray(beside.any(axis=-1))
