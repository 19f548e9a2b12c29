"""How the frequencies of a signal change in time."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stiction.analysis.signals.windows import too_short, windows_of
from stiction.trajectory import Trajectory

if TYPE_CHECKING:
    import xarray as xr

Floats = NDArray[np.float64]

BLOCK = 2**17  # samples taken at once from what can be sliced, 1 MB


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
    best is taken off each window first, so that a slow trend does not hide what is fast.
    Windows that reach over an end of the signal are left out. It is what
    `scipy.signal.ShortTimeFFT` gives with ``stft_detrend(..., "linear")``, ten times as fast.

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
    ValueError
        If the signal is shorter than the window, or not finite.

    References
    ----------
    Nakano & Popov, arXiv:2008.01854, caption of Fig. 4.
    """
    signal = np.asarray(values, dtype=np.float64)
    windows = windows_of(sample_rate, width, step)
    if len(signal) < windows.length:
        raise ValueError(too_short(windows, len(signal)))
    return windows.labelled(windows.amplitudes(signal), 0, start)


def stream_spectrogram(
    blocks: Iterable[ArrayLike] | Any,
    sample_rate: float,
    *,
    width: float = 0.1,
    step: float = 0.01,
    start: float = 0.0,
) -> Iterator[xr.DataArray]:
    """Yield the spectrogram of a signal that does not fit into memory, piece by piece.

    The pieces one after the other are the `spectrogram` of the whole; only a block, what of the
    last window is still needed, and a few windows are held at a time.

    Parameters
    ----------
    blocks : iterable of array, or array
        The signal in blocks of any lengths, in order; or what can be sliced and has a shape (n,):
        `numpy.memmap`, a dataset of h5py or zarr.
    sample_rate, width, step, start : float
        As in `spectrogram`.

    Yields
    ------
    DataArray
        As of `spectrogram`, of the windows that end in a block; none for a block in which none
        does.

    Raises
    ------
    ValueError
        If the signal is shorter than the window, or not finite.

    Examples
    --------
    >>> import numpy as np, stiction as st
    >>> blocks = (np.sin(np.arange(i, i + 500) / 3.0) for i in range(0, 5000, 500))
    >>> [piece.sizes["time"] for piece in st.stream_spectrogram(blocks, 1e3)][:3]
    [41, 50, 50]
    """
    windows = windows_of(sample_rate, width, step)
    rest, seen, done = np.zeros(0), 0, 0
    for block in _blocks(blocks):
        seen += len(block)
        rest = np.concatenate([rest, block])
        count = max(0, (len(rest) - windows.length) // windows.hop + 1)
        if count:
            yield windows.labelled(windows.amplitudes(rest), done, start)
            done += count
            rest = rest[count * windows.hop :].copy()
    if not done:
        raise ValueError(too_short(windows, seen))


def _blocks(blocks: Any) -> Iterator[Floats]:
    if hasattr(blocks, "shape"):
        (length,) = blocks.shape
        for i in range(0, length, BLOCK):
            yield np.asarray(blocks[i : i + BLOCK], dtype=np.float64)
    else:
        for block in blocks:
            yield np.asarray(block, dtype=np.float64).ravel()


def rate_spectrogram(run: Trajectory, axis: str, *, width: float = 0.1) -> xr.DataArray:
    """Return the spectrogram of the elongation rate (m/s) along ``"x"`` or ``"y"`` of a run.

    See `spectrogram`; `width` is the width of the window, s.
    """
    times = run.data["time"].values
    rate = (len(times) - 1) / (times[-1] - times[0])
    found = spectrogram(
        run.data[f"v_{axis}"].values, rate, width=width, step=width / 10, start=times[0]
    )
    return found.assign_attrs(units="m/s", long_name=f"amplitude of v_{axis}")


def ridge(amplitude: xr.DataArray, above: float = 0.0) -> xr.DataArray:
    """Return the frequency (Hz) of the largest amplitude at each time, from `above` (Hz) on."""
    part = amplitude.sel(frequency=slice(above, None))
    return part["frequency"][part.argmax("frequency")].drop_vars("frequency")
