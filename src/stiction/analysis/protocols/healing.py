"""Healing: how peak friction grows with the logarithm of the hold."""

from __future__ import annotations

from dataclasses import dataclass
from math import isnan

import numpy as np

from stiction.analysis.protocols.friction_test import (
    ConstantStretch,
    FrictionTest,
    alike,
    friction_test,
    say_left_out,
)
from stiction.analysis.protocols.settling import line
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
    left_out : tuple of str
        Which holds are left out, and why, in sentences.
    """

    hold: Floats
    steady: Floats
    peak: Floats
    relaxed: Floats
    per_decade: float
    per_decade_error: float
    at_one_second: float
    left_out: tuple[str, ...] = ()

    @property
    def gain(self) -> Floats:
        """Peak less steady friction, (n,)."""
        return self.peak - self.steady

    @property
    def section(self) -> Section:
        """The healing in words and as a table."""
        error = f", +- {self.per_decade_error:.1g}" if self.per_decade_error > 0.0 else ""
        said = f"Friction heals by {self.per_decade:.3g} per decade of hold time{error}."
        if isnan(self.per_decade):
            said = "How friction heals per decade is not known: all holds are equally long."
        rows = [
            (in_words(t, "s"), f"{before:.4f}", f"{low:.4f}", f"{peak:.4f}", f"{peak - before:.4f}")
            for t, before, low, peak in zip(
                self.hold, self.steady, self.relaxed, self.peak, strict=True
            )
        ]
        headings = ("hold", "steady before", "at its end", "peak after", "gain")
        return Section("Healing", [said, *self.left_out], Table(headings, rows))

    def __str__(self) -> str:
        """Return the section as text."""
        return str(self.section)


def healing(source: Trajectory | Record, program: DriveProgram | None = None) -> Healing:
    """Return how friction heals in a slide-hold-slide test.

    On a stiff rig friction of the ageing law heals by b per e-fold of the hold, b ln 10 per decade,
    once the hold is far longer than D_c/V (Dieterich 1979, doi:10.1029/JB084iB05p02161). A soft rig
    shows less: the mass slides before the peak.

    Only holds at rest between two slides at the same velocity, in the same direction and under the
    same load count. The others are left out.

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
    ending = {each.end: each for each in test.stretches}
    starting = {each.start: each for each in test.stretches}
    rows, faults = [], []
    for hold in test.stretches:
        if hold.velocity or hold.start <= test.time[0] or hold.end >= test.time[-1]:
            continue
        before, after = ending.get(hold.start), starting.get(hold.end)
        if before is None or after is None:
            why = "Velocity or load vary just before or after the hold"
        else:
            why = _fault(test, before, hold, after)
            if not why:
                rows.append(_row(test, before, hold, after))
        faults.append((in_words(hold.start, "s"), why))
    said = say_left_out(each for each in faults if each[1])
    if not rows:
        missing = "there is no hold between two slides at the same velocity and load"
        raise ResultError(" ".join([f"{missing}; see st.protocols.slide_hold_slide.", *said]))
    hold_times, steady, peak_values, relaxed = np.array(rows).T
    slope, error, offset = line(np.log10(hold_times), peak_values - steady)
    return Healing(hold_times, steady, peak_values, relaxed, slope, error, offset, said)


def _fault(
    test: FrictionTest, before: ConstantStretch, hold: ConstantStretch, after: ConstantStretch
) -> str:
    """Return why the peak after a hold shows no healing; empty if it does."""
    if not alike(before.load, hold.load) or not alike(hold.load, after.load):
        return "The load changes at an end of the hold"
    if before.way != after.way:
        return "The drive turns round in the hold"
    if not alike(before.velocity, after.velocity):
        return "The drive has another speed after the hold"
    again = test.within(after.start, after.end)
    if not all(test.is_sampled(each) for each in (before, hold, after)):
        return "The hold, or a slide beside it, has too few samples"
    if not test.slides(before):
        return "The mass does not slide before the hold"
    if not test.has_settled(before):
        return "Friction has not settled before the hold"
    highest = again[int((after.way * test.force[again]).argmax())]
    if highest in test.late(after) and not test.slides(after):
        return "The mass does not slide after the hold, or not yet"
    return ""


def _row(
    test: FrictionTest, before: ConstantStretch, hold: ConstantStretch, after: ConstantStretch
) -> tuple[float, float, float, float]:
    """Return the duration of a hold, steady friction before it, the peak after it, its end."""
    again, held = test.within(after.start, after.end), test.within(hold.start, hold.end)
    peak = float((after.way * test.mu[again]).max())
    low = float(before.way * test.mu[held[-1]])
    return hold.end - hold.start, float(before.way * test.steady(before)), peak, low
