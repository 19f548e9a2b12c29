"""Doubts about a force that drifts, in words."""

from __future__ import annotations

from collections.abc import Iterator

from stiction.analysis.motion.cycle_columns import CycleTable
from stiction.analysis.motion.doubts.unsteady import VARIES
from stiction.analysis.motion.drift import WORTH, Drift, is_shown
from stiction.analysis.motion.regime.kinds import SETTLING, STEADY
from stiction.analysis.record import Record
from stiction.analysis.signals.correlated_noise import ERRORS_95, standard_error
from stiction.analysis.signals.robust import largest_magnitude
from stiction.text.quantity.wording import in_words, span
from stiction.text.suggestion import Suggestion

SPEED = 2  # digits of a mean speed over a part of a record


def doubt_drift(record: Record, drift: Drift, kind: str, cycles: CycleTable) -> Iterator[str]:
    """Doubt the load cell where the force drifts, unless it follows a load that varies."""
    if record.load_variation() > VARIES:
        return
    if drift.stands_out and is_shown(drift, kind):
        late = drift.start > float(record.time[0])
        rate, begin = in_words(drift.rate, "N/s"), in_words(drift.start, "s")
        speeds = record.uneven_speeds()
        where = f"from {begin} to {in_words(drift.end, 's')}" if late else "in all"
        remedy = (
            f"analyse the parts before and after {begin} by themselves "
            f"({Suggestion('end', of='')}, {Suggestion('begin')})"
            if late
            else f'state zero_drift = "{rate}" under [sensors.force] in the file beside the record'
        )
        drifts = f"The force drifts by {rate}, {in_words(drift.change, 'N')} {where}, and friction"
        if speeds is None:
            yield (
                f"{drifts} coefficients with it. If it is the load cell, {remedy}; in Python, "
                "analyse st.analysis.detrend(record)."
            )
        else:
            yield (
                f"{drifts} may change with the speed of the drive, which goes at "
                f"{span(*speeds, 'm/s', SPEED)} by its displacement. A record without contact "
                "would show whether the load cell drifts."
            )
    elif not len(cycles):
        yield from _settling(record, drift, kind)
    elif not drift.stands_out:
        yield from _shared_change(drift, cycles, float(record.time[-1] - record.time[0]))


def _settling(record: Record, drift: Drift, kind: str) -> Iterator[str]:
    """Warn that a zero may settle while a mass slides, which the force alone cannot show."""
    if kind in (STEADY, SETTLING) and drift.shared > WORTH * largest_magnitude(record.force):
        yield (
            f"While the mass slides, the force settles by {in_words(drift.shared, 'N', 2)}. The "
            "errors of friction allow for a zero of the load cell that does so. A record without "
            "contact would show it."
        )


def _shared_change(drift: Drift, cycles: CycleTable, lasts: float) -> Iterator[str]:
    """Say that peaks and troughs, of cycles that last so long (s), may change with the zero."""
    worth = WORTH * abs(float(cycles["peak"].mean()))
    if abs(drift.likely) * lasts > worth:
        yield (
            f"Peaks and troughs change alike, by {in_words(drift.likely, 'N/s', 2)}: "
            f"{len(cycles)} cycles cannot tell whether by chance. The errors of friction allow for "
            "a zero of the load cell that drifts so; a record without contact would show it."
        )
    elif drift.shared > max(0.5 * worth, ERRORS_95 * standard_error(cycles["peak"])):
        yield (
            "Peaks and troughs change alike, but not steadily. The errors of friction allow for a "
            "zero of the load cell that does so, as where it settles. Then forces are off by about "
            f"{in_words(drift.shared, 'N', 2)} on average. A record without contact would show it."
        )
