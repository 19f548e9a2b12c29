"""Which channel is in another unit than it was read in, by all numbers of a record together."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from math import isfinite, log10, nan
from typing import NamedTuple

from stiction.analysis.motion.metadata.loading_rate import LOADING_RATE
from stiction.analysis.motion.metadata.quantity import StatedQuantity
from stiction.analysis.motion.metadata.stiffness_over_mass import SWING
from stiction.analysis.record import KINDS, Record
from stiction.formats.units import in_thousands, with_prefix
from stiction.recording.origin import in_unit, use_of

LARGEST_MU = 3.0
LEAST_MU = 0.01  # of dry friction: superlubricity aside
TINY_MU = 1e-3  # no friction is so small, but of a film of fluid
POWERS = (-1, 1, -2, 2)  # of 1000
NEAR_RATE = 0.3  # decades: a rate of loading that differs by less is not one of another unit
NEAR_SWING = 1.5  # likewise for k/m, which filters and slow weakening make smaller
OF_COEFFICIENT = "normal load"  # the unit of a force that was read as a friction coefficient
# By which powers each number changes friction, rate of loading and k/m, as found over as stated
MOVES = {
    "time": (0, -1, -2),
    "force": (1, 1, 0),
    "load": (-1, 0, 0),
    "stiffness": (0, -1, -1),
    "velocity": (0, -1, 0),
    "mass": (0, 0, 1),
}
CHANNELS = ("time", "force")  # whose unit may be wrong
Change = Mapping[str, int]  # from the names of MOVES to a power of 1000


class Numbers(NamedTuple):
    """Numbers that reveal a wrong unit; NaN if unknown.

    The largest friction coefficient, and the rate of loading and k/m as found over as stated.
    """

    mu: float = nan
    rate: float = nan
    swing: float = nan


def numbers_of(mu: float, stated: Sequence[StatedQuantity]) -> Numbers:
    """Return the numbers of a record whose friction coefficient is `mu`."""
    first: dict[str, float] = {}
    for each in stated:
        if isfinite(each.ratio) and each.ratio > 0.0:
            first.setdefault(each.quantity, each.ratio)
    return Numbers(mu, first.get(LOADING_RATE, nan), first.get(SWING, nan))


def likely_changes(seen: Numbers) -> list[Change]:
    """Return the simplest changes by thousands that most of the numbers allow; none if all do.

    One wrong number explains more than two; units of both channels are the only pair.

    >>> likely_changes(Numbers(mu=300.0, rate=1e3))
    [{'force': -1}]
    >>> likely_changes(Numbers(rate=1e-3))[:2]
    [{'time': -1}, {'force': 1}]
    """
    single: list[Change] = [{name: power} for name in MOVES for power in POWERS]
    pairs: list[Change] = [{"time": i, "force": j} for i in POWERS for j in POWERS]
    most, best = _count_fitting(seen, {}), list[Change]()
    for group in (single, pairs):
        counts = [_count_fitting(seen, each) for each in group]
        if max(counts) > most:
            most = max(counts)
            best = [each for each, n in zip(group, counts, strict=True) if n == most]
    return best


def _count_fitting(seen: Numbers, change: Change) -> int:
    """Return how many of the numbers could be true after a change."""
    moved = [sum(MOVES[name][i] * power for name, power in change.items()) for i in range(3)]
    mu = seen.mu * 1000.0 ** moved[0]
    least = LEAST_MU if moved[0] else TINY_MU
    fits = [least <= mu <= LARGEST_MU]
    for ratio, power, near in zip(seen[1:], moved[1:], (NEAR_RATE, NEAR_SWING), strict=True):
        fits.append(isfinite(ratio) and abs(log10(ratio) + 3.0 * power) < near)
    return sum(fits)


def ask_units(
    record: Record, changes: Sequence[Change], asked: Callable[[Change], bool] = bool
) -> list[str]:
    """Return a question for each of the changes that is `asked`, with how the file is read then."""
    found = []
    for change in changes:
        if asked(change):
            each = [_ask(record, name, change[name]) for name in CHANNELS if name in change]
            found.append("; and ".join(text for text in each if text))
    return [text for text in dict.fromkeys(found) if text]


def _ask(record: Record, channel: str, power: int) -> str:
    """Ask whether a channel is in another unit, and say how it is read so.

    A force that was read as a coefficient has none, and times without a column follow from the
    interval of the samples.
    """
    use, times = use_of(record.origin, channel), f"{1000.0**power:.7g}"
    if record.origin is not None and use is None:
        return f"is the interval of the samples {times} times that which was read?"
    unit = record.unit_as_read(channel) if use is None else use.unit
    if unit == OF_COEFFICIENT:
        return ""
    if unit is None:
        return f"is the {channel} {times} times as large? Give {channel}={times} * {channel}"
    other = with_prefix(unit, KINDS[channel].unit, power)
    if use is None:
        remedy = f"{channel}_unit='{other}'" if other else f"{channel}={times} * {channel}"
    else:
        remedy = str(in_unit(use, other or in_thousands(unit, power)))
    shown = other or f"units of {in_thousands(unit, power)}"
    return f"is the {channel} in {shown}, not in {unit}? Give {remedy}"
