"""Warnings about a record whose numbers contradict each other."""

from __future__ import annotations

from collections.abc import Iterator

from stiction.analysis.motion.doubts.clipping import doubt_clipping
from stiction.analysis.motion.doubts.cycles import (
    doubt_cycles_apart,
    doubt_drops_in_noise,
    doubt_loading,
    doubt_mean_period,
    doubt_quiet,
)
from stiction.analysis.motion.doubts.drift import doubt_drift
from stiction.analysis.motion.doubts.findings import Findings
from stiction.analysis.motion.doubts.hum import doubt_mains, doubt_ringing
from stiction.analysis.motion.doubts.numbers import doubt_coefficient, doubt_mass, doubt_rate
from stiction.analysis.motion.doubts.sampling import (
    doubt_few_samples,
    doubt_filter,
    doubt_repeats,
    doubt_times,
)
from stiction.analysis.motion.doubts.unsteady import doubt_load
from stiction.analysis.motion.doubts.zero import doubt_zero
from stiction.analysis.motion.drift import shift_of_drift
from stiction.analysis.motion.zero import shift_of_zero


def warnings(its: Findings) -> tuple[str, ...]:
    """Return warnings as sentences, the most important first: another doubt is a line here.

    These are of numbers that cannot be true, then those that shift friction, then those of cycles
    and samples. A doubt yields its sentences, or none.
    """
    record, kind, cycles = its.record, its.regime.kind, its.alike
    return (
        *doubt_load(record, its.load),
        *doubt_coefficient(its),
        *doubt_clipping(its.ends),
        *doubt_mean_period(cycles),
        *(doubt_loading(cycles) if its.slips else ()),
        *doubt_rate(its),
        *doubt_mass(its),
        *doubt_mains(kind, cycles),
        *_doubt_shifts(its),
        *doubt_cycles_apart(cycles, followed=record.drive_position is not None),
        *doubt_quiet(record, its.friction, cycles),
        *doubt_few_samples(record, cycles),
        *doubt_filter(record, cycles),
        *doubt_drops_in_noise(record, kind, cycles),
        *doubt_times(record),
        *doubt_repeats(record),
    )


def _doubt_shifts(its: Findings) -> Iterator[str]:
    """Doubt a force that is shifted; the doubt about the largest shift comes first."""
    record, cycles, drift = its.record, its.alike, its.drift
    shifts = (
        (shift_of_zero(record, its.friction, cycles, its.zero), doubt_zero(its)),
        (
            shift_of_drift(drift, record.duration),
            doubt_drift(record, drift, its.regime.kind, cycles),
        ),
        (0.0 if its.rings is None else its.rings.shift, doubt_ringing(its.rings)),
    )
    for _, said in sorted(shifts, key=lambda shift: -shift[0]):
        yield from said
