"""Stiffness over mass by the duration of slips, or the period of swings."""

from __future__ import annotations

from math import nan, pi

import numpy as np

from stiction.analysis.motion.cycle_columns import CycleTable
from stiction.analysis.motion.metadata.quantity import FEWEST_SAMPLES, StatedQuantity, median_error
from stiction.analysis.motion.regime.kinds import HARMONIC, STICK_SLIP, TRANSITIONAL
from stiction.analysis.record import Record
from stiction.analysis.signals.correlated_noise import ERRORS_95
from stiction.analysis.signals.digitised import resolution
from stiction.analysis.signals.peak_refinement import Pieces
from stiction.arrays import TINY, Floats
from stiction.recording.noise import white_noise

SWING, BY_SLIPS = "stiffness over mass", "duration of its slips"
LIGHTER, HEAVIER = 1.4, 0.7  # k/m by the swing over that stated; a slip is slower than a swing
# of k/m as stated: friction that weakens slowly makes a slip last so long in 2 of 100 random rigs,
# and a low-pass filter, of up to 1.2 times the frequency of a swing, in most
SLOW_SLIP = 0.4
# Relative error of the period of a swing: friction that varies in it, and the spring across, make
# k/m 0.77 to 1.32 times the true one in 9 of 10 random rigs that vibrate so
SWINGS = 0.08
FEWEST_SWINGS = 3  # of a vibration
# Quartiles of the durations of slips that noise hides nothing of: their ratio where mass and
# stiffness do not shape them
UNLIKE = 1.5
DRAWN_OUT = 0.4  # of a fall: two thirds of what half a cosine takes from 90 % to 10 %
MOST_HIDDEN = 0.25  # of a fall's height at each end, within noise
REACH = 3.0  # standard deviations of noise: a force that is nearer to a peak may be on it
RESTED = 1.1  # times two falls: rest makes a period longer; less may be another asymmetry


def stiffness_over_mass(record: Record, kind: str, cycles: CycleTable) -> StatedQuantity | None:
    """Compare k/m by the period of a swing, or the duration of a slip, with that stated.

    A mass on its spring swings with the period T = 2 pi (m/k)^1/2. One that rests in each cycle has
    a longer period, but its force falls for T/2 (`stiction.analysis.motion.rest.rest_share`). A
    slip under constant friction takes T/2 too, and one under friction that weakens takes longer. A
    slip whose fall begins or ends far more slowly, as under rate-and-state friction or in a
    dashpot, does not last as mass and stiffness have it. Nor does a fall in which the force
    hesitates, and under much noise nothing shows when a slip begins and ends. Slips against
    constant friction last equally long, however far they go: where they do not, friction or the
    drive shapes them. One swing has no shape that tells a vibration from friction that changes.
    """
    if not len(cycles) or kind not in (HARMONIC, STICK_SLIP, TRANSITIONAL):
        return None
    plain = cycles["hesitations"] == 0.0
    if not np.median(plain):
        return None
    cycles = cycles.part(plain)
    falls = cycles["trough_time"] - cycles["peak_time"]
    if float(np.median(falls)) * record.sample_rate < FEWEST_SAMPLES:
        return None
    if kind == HARMONIC:
        return _by_swings(record, cycles, falls) if len(cycles) >= FEWEST_SWINGS else None
    reach = REACH * white_noise(record.force) + resolution(record.force)
    hidden = reach > MOST_HIDDEN * cycles.median("drop")
    if _main_part(record, cycles) < DRAWN_OUT or hidden:
        return None
    longer, shorter = _unseen_ends(reach, cycles)
    few, many = np.quantile(falls, (0.25, 0.75))
    if many > UNLIKE * longer * few:
        return None
    swings = 2.0 * falls
    unseen = max(longer - 1.0, 1.0 - shorter)
    sample = 2.0 / (record.sample_rate * float(np.median(swings)))
    off = 0.5 * float(np.hypot(unseen, sample))
    low, high = SLOW_SLIP * shorter**2, LIGHTER * longer**2
    return _over_mass(record, swings, off, (low, high), BY_SLIPS)._replace(is_bound=True)


def _by_swings(record: Record, cycles: CycleTable, falls: Floats) -> StatedQuantity:
    """Compare k/m by the period of a vibration, which may rest in each swing."""
    periods = cycles["period"]
    rests = float(np.median(periods)) > RESTED * 2.0 * float(np.median(falls))
    how = f"period of its swings{' less the rest' if rests else ''}"
    swings = 2.0 * falls if rests else periods
    return _over_mass(record, swings, SWINGS, (HEAVIER, LIGHTER), how)


def _over_mass(
    record: Record, swings: Floats, off: float, bounds: tuple[float, float], how: str
) -> StatedQuantity:
    """Compare k/m by some periods (s), that may all be `off` by a share of them.

    `bounds` are those of the ratio to that stated, which the scatter of the periods widens.
    """
    swing = float(np.median(swings))
    found = (2.0 * pi / swing) ** 2
    stated = (record.stiffness or nan) / (record.mass or nan)
    scatter = median_error(swings) / swing if len(swings) > 1 else 0.0
    error = 2.0 * found * float(np.hypot(scatter, off))
    within = ERRORS_95 * 2.0 * found * scatter / stated
    low, high = bounds[0] - within, bounds[1] + within
    return StatedQuantity(SWING, "1/s²", found, error, stated, low, high, how)


def _main_part(record: Record, cycles: CycleTable) -> float:
    """Return for which share of its time a fall is from 90 % of its height to 10 %.

    Half a cosine is so for 59 %.
    """
    first, last = np.searchsorted(record.time, [cycles["peak_time"], cycles["trough_time"]])
    last = np.minimum(last, len(record) - 1)
    first, last = first[last > first], last[last > first]
    if not len(first):
        return nan
    its = Pieces.between(first, last)
    force = record.force[its.at]
    top, bottom = (each.reduceat(force, its.begins) for each in (np.maximum, np.minimum))
    edge = 0.1 * (top - bottom)
    leaves = its.last(force >= (top - edge)[its.piece])
    comes = its.first(force <= (bottom + edge)[its.piece])
    return float(np.median((comes - leaves) / (last - first)))


def _unseen_ends(reach: float, cycles: CycleTable) -> tuple[float, float]:
    """Return the factors by which slips may last longer, or shorter, than the falls seen.

    A force within `reach` (N) of a peak or a trough, by noise or a step of its converter, may have
    left it. Half a cosine begins and ends so, and the spring is loaded as slowly before and after
    it.
    """
    share, falls = reach / cycles.median("drop"), cycles["trough_time"] - cycles["peak_time"]
    hidden = 2.0 * float(np.arccos(1.0 - 2.0 * share)) / pi  # of a slip, at both ends
    rate = max(float(np.median(cycles["stick_slope"])), TINY)
    return 1.0 / (1.0 - hidden), max(1.0 - reach / rate / float(np.median(falls)), 0.0)
