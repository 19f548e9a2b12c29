"""Whether the friction force turns while the spring is loaded, or grows.

In apparent stick by rotation the force runs along an arc about zero: as the force along the drive
rises, that across falls. Where a mass rests, or its contact yields without turning, the force runs
along a straight line. If the zero of the force across is unknown, so is the centre of the arc; it
is fitted, and the force at slip bounds the radius.
"""

from __future__ import annotations

from math import hypot, nan, sqrt
from typing import NamedTuple

import numpy as np

from stiction.analysis.record import Record
from stiction.analysis.rotation.loading import BINS, SEVERAL, LoadingSeries, MeanLoading, loadings
from stiction.analysis.rotation.path import best_arc, line_misfit, usual_arc
from stiction.analysis.signals.correlated_noise import ERRORS_95
from stiction.arrays import Floats, xr
from stiction.recording.sensor import Sensor

TURNING, GROWING, BOTH, UNDETERMINED = "turning", "growing", "both", "not determined"
SOME_GROWTH, MOST_GROWTH = 0.2, 0.8  # of the rise of the force along: limits of turning and growing
BETTER = 4.0  # times: so much better must an arc or a line fit than the other
FREE = BINS - 2.0  # degrees of freedom of a line
HALF = BINS // 2  # the part in the middle of a loading
SCATTERING = ("change", "F_0", "zero")
FITTED = {*SCATTERING, *(f"{name}_error" for name in SCATTERING)}


class Rotation(NamedTuple):
    """How the force on the mass changes while the spring is loaded.

    Parameters
    ----------
    kind : str
        "turning", "growing", "both" or "not determined".
    along, across : array
        (2,), N, mean force in the first and last part of the loadings; across, from `zero` where
        `change` is known.
    change, change_error : float
        Of the magnitude from the one to the other, relative; NaN if the zero is unknown.
    F_0, F_0_error : float
        Magnitude of friction in slow creep, N, if the force turns; else NaN.
    zero, zero_error : float
        Of the force across, N, as fitted to a force that turns; 0 with its error if `stated`. The
        error includes a drift, stated or seen from loading to loading, until the mean loading.
    across_error, along_error : float
        Of means in one part by noise and scatter, N.
    stated : bool
        Whether the record states the uncertainty of the zero.
    loadings : int
        How many the numbers are means of.
    """

    kind: str
    along: Floats
    across: Floats
    along_error: float
    across_error: float
    change: float = nan
    change_error: float = nan
    F_0: float = nan
    F_0_error: float = nan
    zero: float = nan
    zero_error: float = nan
    stated: bool = False
    loadings: int = 1

    @property
    def angle(self) -> Floats:
        """Angle of the force from the axis of the load cell, (2,), rad; the larger is positive."""
        angle: Floats = np.arctan2(self.side * self.across, self.along)
        return angle

    @property
    def side(self) -> float:
        """Sign of the larger force across."""
        return float(np.sign(self.across[np.argmax(np.abs(self.across))])) or 1.0

    @property
    def angle_error(self) -> Floats:
        """Its standard error, (2,), rad."""
        x, y = self.along, self.across
        of_y = hypot(self.across_error, self.zero_error)
        error: Floats = np.hypot(x * of_y, y * self.along_error) / (x**2 + y**2)
        return error


def rotation_of(record: Record, cycles: xr.Dataset) -> Rotation:
    """Return how the force on the mass changes in the loadings of cycles."""
    forces = np.stack([record.force, np.asarray(record.force_across)])
    its = loadings(record.time, forces, cycles)
    found = _rotation(its.mean(), (record.sensors or {}).get("force_across"))
    if len(its) < SEVERAL:
        return found._replace(loadings=len(its))
    return _with_scatter(found, its)


def _rotation(its: MeanLoading, sensor: Sensor | None) -> Rotation:
    """Return the finding of a mean loading, by the zero of the force across if it is stated."""
    if sensor is None or not sensor.zero_uncertainty:
        return _by_path(its)
    its = its._replace(drift=hypot(its.drift, sensor.zero_drift_uncertainty))
    zero_error = hypot(sensor.zero_uncertainty, its.drift * its.elapsed)
    return _by_zero(its, zero_error, sensor.gain_uncertainty)


def _with_scatter(found: Rotation, its: LoadingSeries) -> Rotation:
    """Return a finding with errors that are at least the loadings' scatter (jackknife)."""
    means = [its.without(at).mean() for at in range(len(its))]
    if found.stated:
        less = [(each.change,) for each in (_by_zero(mean, found.zero_error) for mean in means)]
    elif found.kind == TURNING:
        less = [tuple(getattr(arc, name) for name in SCATTERING) for arc in map(usual_arc, means)]
    else:
        less = []
    errors: dict[str, float] = {}
    for name, values in zip(SCATTERING, zip(*less, strict=True), strict=False):
        scatter = float(np.std(values)) * sqrt(len(its) - 1.0)
        errors[f"{name}_error"] = float(np.fmax(getattr(found, f"{name}_error"), scatter))
    return found._replace(**errors, loadings=len(its))  # type: ignore[arg-type]


def _ends(kind: str, its: MeanLoading) -> Rotation:
    """Return a finding with the forces at the ends of the loading."""
    return Rotation(kind, its.x[[0, -1]], its.y[[0, -1]], its.x_error, its.y_error)


def _by_path(its: MeanLoading) -> Rotation:
    """Return the finding from the path of the force, without a zero of the force across."""
    arc, line = best_arc(its), line_misfit(its)
    kind = UNDETERMINED
    most = (arc.change + ERRORS_95 * arc.change_error) * arc.F_0
    if line > BETTER * max(arc.misfit, FREE) and most < SOME_GROWTH * (its.x[-1] - its.x[0]):
        kind = TURNING
    elif arc.misfit > BETTER * max(line, FREE):
        kind = GROWING
    found = _ends(kind, its)
    if kind != TURNING:
        return found
    fitted = {name: value for name, value in arc._asdict().items() if name in FITTED}
    fitted["zero_error"] = hypot(arc.zero_error, its.drift * its.elapsed)
    return found._replace(across=found.across - arc.zero, **fitted)


def _by_zero(its: MeanLoading, zero_error: float, gain_error: float = 0.0) -> Rotation:
    """Return the finding from the magnitudes, with a known zero of the force across.

    A force that first grows and then turns, or the other way round, does both, though its ends
    alone may show it grow.
    """
    whole = _growth(its, 0, -1, zero_error, gain_error)
    halves = (_growth(its, *ends, zero_error, gain_error) for ends in ((0, HALF), (HALF, -1)))
    kind = BOTH if {each.kind for each in halves} == {TURNING, GROWING} else whole.kind
    found = _ends(kind, its)._replace(
        change=whole.change, change_error=whole.error, zero=0.0, zero_error=zero_error, stated=True
    )
    if kind != TURNING:
        return found
    arc = best_arc(its, zero_error)
    of_gain = gain_error * float((its.y**2).mean()) / its.peak
    return found._replace(F_0=arc.F_0, F_0_error=hypot(arc.F_0_error, of_gain))


class _Growth(NamedTuple):
    """Relative change of the magnitude between two parts of a loading, and the kind that it is."""

    change: float
    error: float
    kind: str


def _growth(
    its: MeanLoading, first: int, last: int, zero_error: float, gain_error: float
) -> _Growth:
    (x_0, x), (y_0, y) = its.x[[first, last]], its.y[[first, last]]
    r_0, r = hypot(x_0, y_0), hypot(x, y)
    share = (last % BINS - first) / (BINS - 1.0)  # of the time of a loading
    error = r / r_0 * hypot(
        its.x_error * hypot(x / r**2, x_0 / r_0**2),
        its.y_error * hypot(y / r**2, y_0 / r_0**2),
        zero_error * (y / r**2 - y_0 / r_0**2),
        its.drift * share * its.lasts * y / r**2,
        gain_error * ((y / r) ** 2 - (y_0 / r_0) ** 2),
    )  # fmt: skip
    change = r / r_0 - 1.0
    low, high = ((change + sign * ERRORS_95 * error) * r_0 / (x - x_0) for sign in (-1.0, 1.0))
    kind = UNDETERMINED
    if high < SOME_GROWTH:
        kind = TURNING
    elif low > MOST_GROWTH:
        kind = GROWING
    elif low > SOME_GROWTH and high < MOST_GROWTH:
        kind = BOTH
    return _Growth(change, error, kind)
