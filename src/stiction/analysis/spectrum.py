"""How the frequencies of a signal change in time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from stiction.trajectory import Trajectory

if TYPE_CHECKING:
    import xarray as xr


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
    Windows that reach over an end of the signal are left out.

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
    Nakano & Popov, arXiv:2008.01854, caption of Fig. 4; `scipy.signal.ShortTimeFFT`.
    """
    import xarray as xr
    from scipy.signal import ShortTimeFFT  # type: ignore[attr-defined]
    from scipy.signal.windows import hamming

    signal = np.asarray(values, dtype=np.float64)
    count = round(width * sample_rate)
    if not 2 <= count <= len(signal):
        raise ValueError(
            f"a window of {width:g} s holds {count} samples at {sample_rate:g} Hz; "
            f"there are {len(signal)} and at least 2 are needed"
        )
    if not np.isfinite(signal).all():
        raise ValueError("the signal has values that are not finite; leave them out")
    hop = max(1, round(step * sample_rate))
    transform = ShortTimeFFT(
        hamming(count, sym=False), hop, sample_rate, fft_mode="onesided", scale_to="magnitude"
    )
    first = transform.lower_border_end[1]
    last = transform.upper_border_begin(len(signal))[1]
    lines = transform.stft_detrend(signal, "linear", p0=first, p1=max(last, first + 1))
    amplitude = 2.0 * np.abs(lines)
    amplitude[0] /= 2.0  # the mean has no twin at a negative frequency
    middle = transform.t(len(signal), first, max(last, first + 1))
    return xr.DataArray(
        amplitude,
        {
            "frequency": ("frequency", transform.f, {"units": "Hz"}),
            "time": ("time", start + middle, {"units": "s"}),
        },
        name="amplitude",
    )


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
