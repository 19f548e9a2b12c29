"""Windows that slide over a signal, and what swings in each."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

if TYPE_CHECKING:
    import xarray as xr

Floats = NDArray[np.float64]

AT_ONCE = 2**18  # samples in the windows that are transformed at once, 2 MB


class Windows(NamedTuple):
    """Windows of `length` samples, one every `hop` samples, at `rate` (Hz)."""

    length: int
    hop: int
    rate: float

    def amplitudes(self, samples: Floats) -> Floats:
        """Return the amplitudes (frequency, window) of all windows that lie in the samples."""
        from scipy.fft import rfft
        from scipy.signal.windows import hamming

        if not np.isfinite(samples).all():
            raise ValueError("the signal has values that are not finite; leave them out")
        shape = hamming(self.length, sym=False)
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

    def labelled(self, amplitude: Floats, first: int, start: float) -> xr.DataArray:
        """Return amplitudes with their frequencies and times; `first` is the first window's."""
        import xarray as xr

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
    """Return windows of a width, one every `step` (both s); two samples wide at least."""
    windows = Windows(round(width * sample_rate), max(1, round(step * sample_rate)), sample_rate)
    if windows.length < 2:
        raise ValueError(too_short(windows, 0))
    return windows


def too_short(windows: Windows, length: int) -> str:
    """Return what is wrong with a signal of so many samples."""
    return (
        f"a window of {windows.length / windows.rate:g} s holds {windows.length} samples at "
        f"{windows.rate:g} Hz; there are {length} and at least 2 are needed"
    )
