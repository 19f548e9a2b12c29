"""Healing: how peak friction grows with the logarithm of the hold."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from math import isnan, nan

import numpy as np
from numpy.typing import NDArray

from stiction.analysis.protocols.friction_test import (
    FEWEST_SAMPLES,
    ConstantStretch,
    FrictionTest,
    alike,
    friction_test,
)
from stiction.analysis.protocols.peaks import Peak, noise_of, peaks_of_run, peaks_of_samples
from stiction.analysis.protocols.settling import ROUNDED
from stiction.analysis.record import Record
from stiction.analysis.signals.correlated_noise import ERRORS_95, ERRORS_997
from stiction.analysis.signals.straight_line import StraightLine, line_of_few
from stiction.arrays import Floats, ShortRepr, median
from stiction.drive import DriveProgram
from stiction.errors import ResultError
from stiction.text.lists import coefficient_texts, in_list, say_left_out
from stiction.text.quantity.wording import in_words, with_error
from stiction.text.sections import Section, SectionReport, Table
from stiction.trajectory import Trajectory

# Of a hold or a slide, by which friction may begin to change late, and of its fall at rest, by
# which it may rise again: an apparatus has drift, and friction changes slowly at first
PART = 0.3
SURE = 10.0  # standard deviations of noise that the range of its samples hardly exceeds
STRAY = 0.25  # of the range of gains: one that is nearer to the line does not matter to it


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
    misfit : str, optional
        Where friction does not follow the holds and slides of its program, in a sentence; "" if it
        does.
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
    misfit: str = ""

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
        misfit = [self.misfit] if self.misfit else []
        said = [*misfit, *self._sentences(), *self._strays(), *self.left_out]
        return Section("Healing", said, Table(headings, rows))

    def _strays(self) -> list[str]:
        """Return which gains lie off the line by more than their errors, in a sentence."""
        known, errors = self.resolved, self.peak_error
        if errors is None or isnan(self.per_decade) or known.sum() < 3:
            return []
        line = self.at_one_second + self.per_decade * np.log10(self.hold)
        away = np.abs(self.gain - line)
        least = np.maximum(ERRORS_997 * errors, STRAY * np.ptp(self.gain[known]))
        stray = known & (away > least)
        if not stray.any():
            return []
        holds = in_list([in_words(t, "s") for t in self.hold[stray]])
        return [f"Gains after holds of {holds} lie off the line by more than their errors."]

    def _sentences(self) -> list[str]:
        """Return how friction heals, in sentences."""
        poor = self.hold[~self.resolved]
        fewer = f"after holds of {in_list([in_words(t, 's') for t in poor])}"
        few = f"Too few samples lie around the peak {fewer}"
        remedy = "" if self.misfit else " Raise the sample rate."
        said = [f"{few}: it is not resolved.{remedy}"] if len(poor) else []
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
    drive = "the program" if test.position is None else "the displacement of the drive"
    misfit = _say_misfit(list(_misfits(test)), drive)
    if not rows:
        missing = "there is no hold between two slides at the same velocity and load"
        remedy = f"{missing}; see st.protocols.slide_hold_slide."
        raise ResultError(" ".join([*([misfit] if misfit else []), remedy, *said]))
    hold_times, steady, relaxed = np.array(rows).T
    peaks, errors = np.array(_peaks(source, test, slides)).T
    found = _line(hold_times, peaks - steady, errors)
    return Healing(
        hold_times, steady, peaks, relaxed, found.slope, found.slope_error, found.offset,
        said, errors, found.offset_error, misfit,
    )  # fmt: skip


def _misfits(test: FrictionTest) -> Iterator[str]:
    """Yield where friction of a record does not follow holds and slides as they are stated.

    At rest it falls and does not rise; in a slide it rises, and falls to its level again. Only
    what is beyond noise and beyond the error of a clock counts, see `FrictionTest.clock`.
    """
    if test.law is not None or not any(map(test.is_sampled, test.stretches)):
        return
    found = test.stretches
    parts = [(test.mu[test.within(*each[:2])], test.mu[test.late(each)]) for each in found]
    unseen = SURE * median(np.array([noise_of(*part) for part in parts if len(part[1])]))
    for before, hold, after in zip(found, found[1:], found[2:], strict=False):
        joined = before.end == hold.start and hold.end == after.start
        if hold.velocity or not joined or before.way != after.way or not before.way:
            continue
        if all(test.is_sampled(each) for each in (before, hold, after)):
            yield from _misfits_of(test, before, hold, after, unseen)


def _misfits_of(
    test: FrictionTest,
    before: ConstantStretch,
    hold: ConstantStretch,
    after: ConstantStretch,
    unseen: float,
) -> Iterator[str]:
    """Yield where friction of a record does not follow one hold and the slide after it.

    Changes below `unseen` may be noise.
    """
    mu, level = before.way * test.mu, before.way * test.steady(before)
    clock = max(test.clock_at_jump(before, hold), test.clock_at_jump(hold, after))
    rest = test.within(hold.start + clock, hold.end - clock)
    slide = test.within(after.start + clock, after.end - clock)
    if min(len(rest), len(slide)) < FEWEST_SAMPLES:
        return
    at, at_slide = in_words(hold.start, "s"), in_words(after.start, "s")
    fall = max(level, float(mu[rest].max())) - float(mu[rest].min())
    rise = float((mu[rest] - np.minimum.accumulate(mu[rest])).max())
    if rise > max(unseen, PART * fall):
        yield f"friction rises in the hold at {at}"
    begins = mu[rest] < level - max(0.1 * fall, 0.5 * unseen)
    late = test.time[rest[begins.argmax()]] - hold.start
    if fall > 2.0 * unseen and late > clock + PART * (hold.end - hold.start):
        yield f"friction begins to fall {in_words(late, 's', 2)} into the hold at {at}"
    low, top = float(mu[rest[-1]]), float(mu[slide].max())
    begins = mu[slide] > low + max(0.1 * (top - low), 0.5 * unseen)
    late = test.time[slide[begins.argmax()]] - after.start
    if top - low > 2.0 * unseen and late > clock + PART * (after.end - after.start):
        yield f"friction begins to rise {in_words(late, 's', 2)} into the slide at {at_slide}"
    slid = slide[begins.argmax() :]
    if _rests(test.time[slid], mu[slid], level - 0.5 * unseen, level - max(unseen, 0.5 * fall)):
        yield f"friction falls in the slide at {at_slide} as it does at rest"


def _rests(time: Floats, mu: Floats, level: float, low: float) -> bool:
    """Return whether friction falls from its level as at rest: for twice as long as it rises again.

    In a slide that runs away it falls faster than the spring is loaded.
    """
    slid = np.flatnonzero(mu > level)
    if not len(slid):
        return False
    lowest = slid[0] + int(mu[slid[0] :].argmin())
    before, after = slid[slid <= lowest][-1], slid[slid > lowest]
    again = after[0] if len(after) else len(mu) - 1
    return bool(
        mu[lowest] < low and time[lowest] - time[before] > 2.0 * (time[again] - time[lowest])
    )


def _say_misfit(found: Sequence[str], drive: str) -> str:
    """Return that a record does not follow its program, in a sentence; '' if it does."""
    if not found:
        return ""
    rest = "" if len(found) == 1 else f", and {len(found) - 1} more such"
    return (
        f"{drive[0].upper()}{drive[1:]} does not fit the record: {found[0]}{rest}. Compare the "
        "lengths of holds and slides, and when t = 0 is."
    )


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
