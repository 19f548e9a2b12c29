"""The mean course of the force, along and across, while the spring is loaded."""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

import numpy as np

from stiction.analysis.signals.digitised import rounding_of_mean
from stiction.analysis.signals.straight_line import line
from stiction.arrays import Floats, xr
from stiction.errors import ResultError
from stiction.text.quantity.wording import percent

BINS = 10  # of each loading
RINGING, SLIPPING = 0.1, 0.04  # of a loading: left out where the slip rings, and where it begins
FEWEST = 5  # samples in a bin
SEVERAL = 3  # loadings, whose scatter yields an error
FORWARD = 0.1  # of the peak: least force along, as after a slip that overshoots it pulls back
LEAST_RISE = 0.1  # of the peak: least rise of the force along that says something of its course
LEAST_ERROR = 1e-6  # of the peak: no error is less


class MeanLoading(NamedTuple):
    """Mean force along (x) and across (y), N, in bins of the loadings, with standard errors.

    `peak` is the mean force along, N, at which the mass slips; `elapsed` the mean time of the
    loadings since the first sample, and `lasts` from their first bin to the last, s. `drift` is the
    rate at which the force across changes from loading to loading, N/s: 0 where they are few.
    """

    x: Floats
    y: Floats
    x_error: float
    y_error: float
    peak: float
    elapsed: float = 0.0
    lasts: float = 0.0
    drift: float = 0.0


class LoadingSeries(NamedTuple):
    """Mean (x, y) in each bin of each loading, (n, 2, BINS), N, and the variance by noise, (2,).

    `rounding` is the standard error, (2,), N, by rounding, which may be alike in all loadings;
    `spans` begin and end of each, (n, 2), s, since the first sample.
    """

    means: Floats
    noise: Floats
    peaks: Floats
    rounding: Floats
    spans: Floats

    def __len__(self) -> int:
        """Return their number."""
        return len(self.peaks)

    def without(self, at: int) -> LoadingSeries:
        """Return all loadings except one, for the scatter of their results."""
        each = (np.delete(values, at, 0) for values in (self.means, self.peaks, self.spans))
        means, peaks, spans = each
        return LoadingSeries(means, self.noise, peaks, self.rounding, spans)

    def mean(self) -> MeanLoading:
        """Return their mean; its errors are of noise, or of the scatter of shapes if more."""
        count, mean = len(self.peaks), self.means.mean(axis=0)
        variance = self.noise / count
        if count >= SEVERAL:
            apart = self.means - mean
            apart = apart - apart.mean(axis=2, keepdims=True)  # a shift bends nothing
            scatter = (apart**2).sum(axis=(0, 2)) / (count - 1) / (BINS - 1)
            variance = np.maximum(variance, scatter / count)
        peak = float(self.peaks.mean())
        variance = variance + self.rounding**2
        x_error, y_error = np.sqrt(np.maximum(variance, (LEAST_ERROR * peak) ** 2))
        at = self.spans.mean(axis=1)
        drift = line(at, self.means[:, 1].mean(axis=1)).slope if count >= SEVERAL else 0.0
        lasts = float(np.ptp(self.spans, axis=1).mean())
        errors = float(x_error), float(y_error)
        return MeanLoading(mean[0], mean[1], *errors, peak, float(at.mean()), lasts, drift)


def loadings(time: Floats, forces: Floats, cycles: xr.Dataset) -> LoadingSeries:
    """Return the loadings of cycles with forces along and across, (2, n), N.

    Raises
    ------
    ResultError
        If none has enough samples, or the force along hardly rises.
    """
    means, noise, peaks, spans, widths = [], [], [], [], []
    columns = (cycles[name].values for name in ("start", "peak_time", "start_force", "peak"))
    for start, end, low, peak in zip(*columns, strict=True):
        rise = end - start
        begin = max(RINGING, (FORWARD * peak - low) / (peak - low))
        edges = np.linspace(start + begin * rise, end - SLIPPING * rise, BINS + 1)
        at = np.searchsorted(time, edges)
        whole = forces[:, at[0] : at[-1]]
        if np.diff(at).min() < FEWEST or not np.isfinite(whole).all():
            continue
        parts = [forces[:, i:j] for i, j in pairwise(at)]
        means.append(np.array([part.mean(axis=1) for part in parts]).T)
        # Of differences, which leave the trend out
        noise += [np.var(np.diff(part), axis=1) / 2.0 / part.shape[1] for part in parts]
        peaks.append(peak)
        spans.append(edges[[0, -1]] - time[0])
        widths += [np.ptp(part, axis=1) for part in parts]
    if not means:
        raise ResultError(
            f"not determined: no loading of a cycle has {FEWEST} samples in each of {BINS} parts"
        )
    rounding = np.array([*map(rounding_of_mean, forces, np.mean(widths, axis=0))])
    found = LoadingSeries(
        np.array(means), np.mean(noise, axis=0), np.array(peaks), rounding, np.array(spans)
    )
    along = found.means[:, 0]
    if float(np.median(along[:, -1] - along[:, 0])) < LEAST_RISE * found.peaks.mean():
        raise ResultError(
            f"not determined: the force along rises by less than {percent(LEAST_RISE)} in a loading"
        )
    return found
