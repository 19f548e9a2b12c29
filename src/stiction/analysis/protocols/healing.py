"""Healing: how peak friction grows with the logarithm of the hold."""

from __future__ import annotations

from dataclasses import dataclass
from math import nan, sqrt

import numpy as np

from stiction.analysis.protocols.friction_test import friction_test
from stiction.analysis.record import Record
from stiction.arrays import Floats
from stiction.drive import DriveProgram
from stiction.errors import ResultError
from stiction.text.sections import Section, Table
from stiction.text.units import in_words
from stiction.trajectory import Trajectory


@dataclass(frozen=True)
class Healing:
    """Peaks of friction after holds, and a straight line through them.

    Attributes
    ----------
    hold : ndarray
        (n,), how long each hold lasted, s.
    steady, peak, relaxed : ndarray
        (n,), friction before the hold, its peak after it, and its value at the hold's end.
    per_decade, per_decade_error : float
        Slope of peak less steady friction over the decadic logarithm of the hold, and its standard
        error; NaN with fewer than two, or three, holds.
    at_one_second : float
        The line at a hold of 1 s.
    """

    hold: Floats
    steady: Floats
    peak: Floats
    relaxed: Floats
    per_decade: float
    per_decade_error: float
    at_one_second: float

    @property
    def gain(self) -> Floats:
        """Peak less steady friction, (n,)."""
        return self.peak - self.steady

    @property
    def section(self) -> Section:
        """The healing in words and as a table."""
        line = f"Friction heals by {self.per_decade:.3g} per decade of hold time"
        error = f", +- {self.per_decade_error:.1g}" if self.per_decade_error > 0.0 else ""
        rows = [
            (in_words(t, "s"), f"{before:.4f}", f"{low:.4f}", f"{peak:.4f}", f"{peak - before:.4f}")
            for t, before, low, peak in zip(
                self.hold, self.steady, self.relaxed, self.peak, strict=True
            )
        ]
        headings = ("hold", "steady before", "at its end", "peak after", "gain")
        return Section("Healing", [f"{line}{error}."], Table(headings, rows))

    def __str__(self) -> str:
        """Return the section as text."""
        return str(self.section)


def healing(source: Trajectory | Record, program: DriveProgram | None = None) -> Healing:
    """Return how friction heals in a slide-hold-slide test.

    On a stiff rig friction of the ageing law heals by b per e-fold of the hold, b ln 10 per decade,
    once the hold is far longer than D_c/V (Dieterich 1979, doi:10.1029/JB084iB05p02161). A soft rig
    shows less: the mass slides before the peak.

    Parameters
    ----------
    source : Trajectory or Record
        A run, or a record with its normal load.
    program : DriveProgram, optional
        The program of a record, see `st.protocols.slide_hold_slide`; that of a run is known.

    Raises
    ------
    ResultError
        If there is no hold between two slides.

    Examples
    --------
    >>> import stiction as st
    >>> found = st.analysis.healing(st.run(st.presets.slide_hold_slide()))
    >>> f"{found.gain[0]:.4f}"
    '0.0415'
    """
    test = friction_test(source, program)
    parts = test.stretches
    holds = [
        i
        for i in range(1, len(parts) - 1)
        if parts[i].velocity == 0.0 and parts[i - 1].velocity and parts[i + 1].velocity
    ]
    rows = []
    for i in holds:
        before, hold, after = parts[i - 1 : i + 2]
        again, held = test.within(after.start, after.end), test.within(hold.start, hold.end)
        if len(again) and len(held):
            way = np.sign(before.velocity)
            peak = float((way * test.mu[again]).max())
            low = float(way * test.mu[held[-1]])
            rows.append((hold.end - hold.start, float(way * test.steady(before)), peak, low))
    if not rows:
        raise ResultError("there is no hold between two slides; see st.protocols.slide_hold_slide")
    hold_times, steady, peak_values, relaxed = np.array(rows).T
    slope, error, offset = line(np.log10(hold_times), peak_values - steady)
    return Healing(hold_times, steady, peak_values, relaxed, slope, error, offset)


def line(x: Floats, y: Floats) -> tuple[float, float, float]:
    """Return slope, its standard error, and offset of the least-squares line; NaN where unknown."""
    spread = float(((x - x.mean()) ** 2).sum())
    if len(x) < 2 or spread == 0.0:
        return nan, nan, nan
    slope = float(((x - x.mean()) * (y - y.mean())).sum()) / spread
    offset = float(y.mean() - slope * x.mean())
    if len(x) < 3:
        return slope, nan, offset
    left = y - offset - slope * x
    return slope, sqrt(float((left**2).sum()) / (len(x) - 2) / spread), offset
