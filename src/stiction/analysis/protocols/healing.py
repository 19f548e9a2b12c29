"""Healing: how peak friction grows with the logarithm of the hold."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from math import isnan, nan

import numpy as np
from numpy.typing import NDArray

from stiction.analysis.protocols.friction_test import (
    ConstantStretch,
    FrictionTest,
    alike,
    friction_test,
)
from stiction.analysis.protocols.peaks import Peak, peaks_of_run, peaks_of_samples
from stiction.analysis.protocols.settling import ROUNDED
from stiction.analysis.record import Record
from stiction.analysis.signals.correlated_noise import ERRORS_95
from stiction.analysis.signals.straight_line import StraightLine, line_of_few
from stiction.arrays import Floats, ShortRepr
from stiction.drive import DriveProgram
from stiction.errors import ResultError
from stiction.text.lists import coefficient_texts, in_list, say_left_out
from stiction.text.quantity.wording import in_words, with_error
from stiction.text.sections import Section, SectionReport, Table
from stiction.trajectory import Trajectory


@dataclass(frozen=True, repr=False)
class Healing(SectionReport, ShortRepr):
    """Peaks of friction after holds, and a straight line through them.

    Attributes
    ----------
    hold : ndarray
        (n,), how long each hold lasted, s.
    steady, peak, relaxed : ndarray
        (n,), friction before the hold, its peak after it, and its value at the hold's end.
    per_decade, per_decade_error : float
        Slope of peak less steady friction over the decadic logarithm of the hold, and its standard
        error by scatter and the errors of peaks; NaN with fewer than two, or three, resolved peaks.
    at_one_second, at_one_second_error : float
        The line at a hold of 1 s, and its standard error, as above.
    left_out : tuple of str
        Which holds are left out, and why, in sentences.
    peak_error : ndarray, optional
        (n,), standard error of each peak; NaN where the samples do not resolve it. Then `peak` is
        the highest sample, a lower bound, and is not a point of the line.
    """

    _figure = "plot_healing"

    hold: Floats
    steady: Floats
    peak: Floats
    relaxed: Floats
    per_decade: float
    per_decade_error: float
    at_one_second: float
    left_out: tuple[str, ...] = ()
    peak_error: Floats | None = None
    at_one_second_error: float = nan

    @property
    def resolved(self) -> NDArray[np.bool_]:
        """Whether each peak is resolved, (n,)."""
        errors = np.zeros(len(self.hold)) if self.peak_error is None else self.peak_error
        return np.asarray(np.isfinite(errors))

    @property
    def gain(self) -> Floats:
        """Peak less steady friction, (n,)."""
        return self.peak - self.steady

    @property
    def section(self) -> Section:
        """The healing in words and as a table."""
        errors = np.full(len(self.hold), nan) if self.peak_error is None else self.peak_error
        rows = [
            (
                in_words(t, "s"),
                f"{before:.4f}",
                f"{low:.4f}",
                f"{'' if sure else '> '}{coefficient_texts(peak, error)[0]}",
                f"{'' if sure else '> '}{coefficient_texts(peak - before, error)[0]}",
                coefficient_texts(peak, error)[1],
            )
            for t, before, low, peak, error, sure in zip(
                self.hold, self.steady, self.relaxed, self.peak, errors, self.resolved, strict=True
            )
        ]
        headings = ("hold", "steady before", "at its end", "peak after", "gain", "±")
        return Section("Healing", [*self._sentences(), *self.left_out], Table(headings, rows))

    def _sentences(self) -> list[str]:
        """Return how friction heals, in sentences."""
        poor = self.hold[~self.resolved]
        fewer = f"after holds of {in_list([in_words(t, 's') for t in poor])}"
        few = f"Too few samples lie around the peak {fewer}"
        said = [f"{few}: it is not resolved. Raise the sample rate."] if len(poor) else []
        if isnan(self.per_decade):
            why = "fewer than two peaks are resolved" if len(poor) else "all holds are equally long"
            return [f"How friction heals per decade is not known: {why}.", *said]
        error = self.per_decade_error
        rounded = ROUNDED * float(np.abs(self.peak).max())
        least = max(ERRORS_95 * error if error > 0.0 else 0.0, rounded)
        if abs(self.per_decade) < least:
            zero = f"Healing is zero within its error, {least:.1g} per decade of hold time."
            return [zero, *said]
        its = with_error(self.per_decade, error, "") if error > 0.0 else f"{self.per_decade:.3g}"
        return [f"Friction heals by {its} per decade of hold time.", *said]


def healing(source: Trajectory | Record, program: DriveProgram | None = None) -> Healing:
    """Return how friction heals in a slide-hold-slide test.

    On a stiff rig friction of the ageing law heals by b per e-fold of the hold, b ln 10 per decade,
    once the hold is far longer than D_c/V (Dieterich 1979, doi:10.1029/JB084iB05p02161). A soft rig
    shows less: the mass slides before the peak.

    Only holds at rest between two slides at the same velocity, in the same direction and under the
    same load count. The others are left out.

    The peak of a run is exact, however the run is sampled. That of a record lies between samples:
    its error is what friction loses from one to the next, and noise. Where there are fewer than
    four samples in the fall by half, or none shows a fall and the spring is loaded within two, the
    peak is not resolved, and no point of the line.

    Parameters
    ----------
    source : Trajectory or Record
        A run, or a record with its normal load.
    program : DriveProgram, optional
        The program of a record, see `st.protocols.slide_hold_slide`; by default the holds are those
        of its measured `drive_position`. That of a run is known.

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
    rows, slides, faults = [], [], []
    for hold in test.stretches:
        if hold.velocity or hold.start <= test.time[0] or hold.end >= test.time[-1]:
            continue
        before, after = ending.get(hold.start), starting.get(hold.end)
        if before is None or after is None:
            why = "Velocity or load vary just before or after the hold"
        else:
            why = _fault(test, before, hold, after)
            if not why:
                rows.append(_row(test, before, hold))
                slides.append(after)
        faults.append((in_words(hold.start, "s"), why))
    said = say_left_out(each for each in faults if each[1])
    if not rows:
        missing = "there is no hold between two slides at the same velocity and load"
        raise ResultError(" ".join([f"{missing}; see st.protocols.slide_hold_slide.", *said]))
    hold_times, steady, relaxed = np.array(rows).T
    peaks, errors = np.array(_peaks(source, test, slides)).T
    found = _line(hold_times, peaks - steady, errors)
    return Healing(
        hold_times, steady, peaks, relaxed, found.slope, found.slope_error, found.offset,
        said, errors, found.offset_error,
    )  # fmt: skip


def _peaks(
    source: Trajectory | Record, test: FrictionTest, slides: list[ConstantStretch]
) -> list[Peak]:
    """Return the peaks of slides; from the samples if the run cannot be repeated."""
    if isinstance(source, Trajectory):
        with suppress(ResultError):
            return peaks_of_run(source, slides)
    return peaks_of_samples(test, slides)


def _line(holds: Floats, gains: Floats, errors: Floats) -> StraightLine:
    """Return the line through resolved peaks over the decadic logarithm of the hold."""
    known = np.isfinite(errors)
    if not known.any():
        return StraightLine(nan, nan, nan)
    return line_of_few(np.log10(holds[known]), gains[known], errors[known])


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
    test: FrictionTest, before: ConstantStretch, hold: ConstantStretch
) -> tuple[float, float, float]:
    """Return the duration of a hold, steady friction before it, and friction at its end."""
    low = float(before.way * test.mu[test.within(hold.start, hold.end)[-1]])
    return hold.end - hold.start, float(before.way * test.steady(before)), low
