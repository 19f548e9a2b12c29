"""Spectra, and spectrograms: the frequencies of a signal over time."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import ArrayLike

from stiction.arrays import Floats, xr
from stiction.errors import ResultError
from stiction.trajectory import Trajectory

BLOCK = 2**17  # samples taken at once from what can be sliced, 1 MB
AT_ONCE = 2**18  # samples in the windows that are transformed at once, 2 MB
# Of a step between two samples: more than rounded times differ by. A run is sampled evenly, or at
# other times on purpose; the clock of a record jitters and leaves samples out, see `even_grid`
UNEVEN = 0.1


def spectrum(force: Floats) -> tuple[Floats, float]:
    """Return the power of a force under a Hann window, and the width of its samples in cycles."""
    from scipy.fft import next_fast_len, rfft

    n = len(force)
    ramp = np.linspace(0.0, 1.0, n)
    level = force - force[0] - (force[-1] - force[0]) * ramp
    size = next_fast_len(n, real=True)  # type: ignore[no-untyped-call]
    return np.abs(rfft((level - level.mean()) * np.hanning(n), size)) ** 2, 1.0 / size


class Windows(NamedTuple):
    """Windows of `length` samples, one every `hop` samples, at `rate` (Hz)."""

    length: int
    hop: int
    rate: float

    def amplitudes(self, samples: Floats) -> Floats:
        """Return the amplitudes (frequency, window) of all windows that lie in the samples."""
        from scipy.fft import rfft

        if not np.isfinite(samples).all():
            raise ResultError("the signal has values that are not finite; leave them out")
        shape = np.hamming(self.length + 1)[:-1]  # periodic; scipy.signal takes 0.4 s to import
        shape *= 2.0 / shape.sum()
        ramp = np.arange(self.length) - 0.5 * (self.length - 1)
        views = sliding_window_view(samples, self.length)[:: self.hop]
        found = np.empty((self.length // 2 + 1, len(views)))
        step = max(1, AT_ONCE // self.length)
        for i in range(0, len(views), step):
            part = views[i : i + step] - views[i : i + step].mean(axis=1, keepdims=True)
            part -= np.outer(part @ ramp / (ramp @ ramp), ramp)
            part *= shape
            found[:, i : i + step] = np.abs(rfft(part, axis=1, overwrite_x=True)).T
        found[0] /= 2.0  # the mean has no twin at a negative frequency
        return found

    def label(self, amplitude: Floats, first: int, start: float) -> xr.DataArray:
        """Return amplitudes with their frequencies and times; `first` is the first window's."""
        frequency = np.arange(self.length // 2 + 1) * (self.rate / self.length)
        place = (first + np.arange(amplitude.shape[1])) * self.hop + self.length // 2
        return xr.DataArray(
            amplitude,
            {
                "frequency": ("frequency", frequency, {"units": "Hz"}),
                "time": ("time", start + place / self.rate, {"units": "s"}),
            },
            name="amplitude",
        )


def windows_of(sample_rate: float, width: float, step: float) -> Windows:
    """Return windows of a width, one every `step` (both s), at least two samples wide."""
    windows = Windows(round(width * sample_rate), max(1, round(step * sample_rate)), sample_rate)
    if windows.length < 2:
        raise ResultError(too_short(windows, 0))
    return windows


def too_short(windows: Windows, length: int) -> str:
    """Return the message for a signal of too few samples."""
    return (
        f"a window of {windows.length / windows.rate:g} s holds {windows.length} samples at "
        f"{windows.rate:g} Hz; there are {length} and at least 2 are needed"
    )


def spectrogram(
    values: ArrayLike,
    sample_rate: float,
    *,
    width: float = 0.1,
    step: float = 0.01,
    start: float = 0.0,
) -> xr.DataArray:
    """Return the short-time Fourier transform of a signal, as amplitudes.

    A sine of amplitude a appears with a at its frequency. The straight line that fits
    best is subtracted from each window first, so that a slow trend does not hide fast components.
    Windows that extend beyond the signal are left out. The result is that of
    `scipy.signal.ShortTimeFFT` with ``stft_detrend(..., "linear")``, ten times as fast.

    Parameters
    ----------
    values : array
        (n,), equally spaced samples, in any unit; they span at least one window.
    sample_rate : float
        Hz.
    width : float, optional
        Width of the Hamming window, s; the paper's Fig. 4 has 0.1 s.
    step : float, optional
        Time from one window to the next, s.
    start : float, optional
        Time of the first sample, s.

    Returns
    -------
    DataArray
        Over ``frequency`` (Hz) and ``time`` (s, middle of the window), unit of `values`.

    Raises
    ------
    ResultError
        If the signal is shorter than the window, or not finite.

    References
    ----------
    Nakano & Popov, arXiv:2008.01854, caption of Fig. 4.

    Examples
    --------
    >>> import numpy as np, stiction as st
    >>> time = np.arange(0.0, 2.0, 1e-3)
    >>> found = st.analysis.spectrogram(np.sin(2 * np.pi * 100.0 * time), 1e3)
    >>> float(found.mean("time").idxmax("frequency"))
    100.0
    """
    signal = np.asarray(values, dtype=np.float64)
    windows = windows_of(sample_rate, width, step)
    if len(signal) < windows.length:
        raise ResultError(too_short(windows, len(signal)))
    return windows.label(windows.amplitudes(signal), 0, start)


def stream_spectrogram(
    blocks: Iterable[ArrayLike] | Any,
    sample_rate: float,
    *,
    width: float = 0.1,
    step: float = 0.01,
    start: float = 0.0,
) -> Iterator[xr.DataArray]:
    """Yield the spectrogram of a signal that does not fit into memory, piece by piece.

    The pieces together are the `spectrogram` of the whole signal. Only one block, the rest of the
    last window, and a few windows are in memory at a time.

    Parameters
    ----------
    blocks : iterable of array, or array
        The signal in blocks of any lengths, in order; or a sliceable object of shape (n,):
        `numpy.memmap`, a dataset of h5py or zarr.
    sample_rate, width, step, start : float
        As in `spectrogram`.

    Yields
    ------
    DataArray
        As from `spectrogram`, for the windows that end in a block; nothing for a block without.

    Raises
    ------
    ResultError
        If the signal is shorter than the window, or not finite.

    Examples
    --------
    >>> import numpy as np, stiction as st
    >>> blocks = (np.sin(np.arange(i, i + 500) / 3.0) for i in range(0, 5000, 500))
    >>> [piece.sizes["time"] for piece in st.analysis.stream_spectrogram(blocks, 1e3)][:3]
    [41, 50, 50]
    """
    windows = windows_of(sample_rate, width, step)
    rest, seen, done = np.zeros(0), 0, 0
    for block in _blocks(blocks):
        seen += len(block)
        rest = np.concatenate([rest, block])
        count = max(0, (len(rest) - windows.length) // windows.hop + 1)
        if count:
            yield windows.label(windows.amplitudes(rest), done, start)
            done += count
            rest = rest[count * windows.hop :].copy()
    if not done:
        raise ResultError(too_short(windows, seen))


def _blocks(blocks: Any) -> Iterator[Floats]:
    if hasattr(blocks, "shape"):
        (length,) = blocks.shape
        for i in range(0, length, BLOCK):
            yield np.asarray(blocks[i : i + BLOCK], dtype=np.float64)
    else:
        for block in blocks:
            yield np.asarray(block, dtype=np.float64).ravel()


def rate_spectrogram(
    run: Trajectory, axis: str, *, width: float = 0.1, steps: int = 10
) -> xr.DataArray:
    """Return the spectrogram of the elongation rate (m/s) along ``"x"`` or ``"y"`` of a run.

    See `spectrogram`; `width` is the width of the window, s, and `steps` windows overlap at any
    time.
    """
    start = float(run.samples["time"][0])
    found = spectrogram(
        run.samples[f"v_{axis}"], even_rate(run), width=width, step=width / steps, start=start
    )
    return found.assign_attrs(units="m/s", long_name=f"amplitude of v_{axis}")


def even_rate(run: Trajectory) -> float:
    """Return the sample rate of a run, Hz.

    A run that was given up has its last sample where it ended, too soon after the one before.
    """
    steps = np.diff(run.samples["time"])
    usual = steps[:-1] if len(steps) > 1 else steps
    if not len(steps) or max(np.ptp(usual), steps[-1] - usual[0]) > UNEVEN * usual[0]:
        raise ResultError("the run is sampled once or at uneven times; simulate it at a rate")
    return float(1.0 / steps.mean())
