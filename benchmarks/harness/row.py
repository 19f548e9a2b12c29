"""The result of a comparison for one solver with its settings."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

OURS = "stiction"  # how the names of our rows begin


class Errors(NamedTuple):
    """Largest errors of ``k_x u_x`` and of ``k_y u_y``, in N."""

    x: float
    y: float

    def within(self, other: Errors) -> bool:
        """Whether neither is larger than the other's."""
        return self.x <= other.x and self.y <= other.y


class Row(NamedTuple):
    """A solver with its settings, its wall times (s) and its errors, or a note on why not."""

    solver: str
    settings: str
    times: Sequence[float] = ()
    errors: Errors | None = None
    note: str = ""

    @property
    def seconds(self) -> float:
        """Shortest wall time, s: the one least disturbed by what else the machine does."""
        return min(self.times)

    @property
    def is_ours(self) -> bool:
        """Whether it is ours."""
        return self.solver.startswith(OURS)


def fastest(rows: Sequence[Row], bounds: Errors) -> Row | None:
    """Return the fastest row whose errors are within bounds, if there is one."""
    good = [row for row in rows if row.errors is not None and row.errors.within(bounds)]
    return min(good, key=lambda row: row.seconds, default=None)


class Match(NamedTuple):
    """A peer's row, our fastest that is at least as accurate in both forces, and how they compare.

    `ratio` is the peer's time over ours; None where ours is nowhere as accurate.
    """

    peer: Row
    ours: Row | None
    ratio: float | None


def matches(rows: Sequence[Row]) -> list[Match]:
    """Return a match for each row of a peer that has errors."""
    own = [row for row in rows if row.is_ours]
    found = []
    for peer in rows:
        if peer.errors is not None and not peer.is_ours:
            best = fastest(own, peer.errors)
            found.append(Match(peer, best, peer.seconds / best.seconds if best else None))
    return found


def verdict(rows: Sequence[Row]) -> list[str]:
    """Say whether ours is faster than every peer at its accuracy, and where it is not."""
    found = matches(rows)
    ratios = [match.ratio for match in found if match.ratio is not None]
    lost = [match for match in found if match.ratio is None or match.ratio <= 1.0]
    if not found:
        return ["No peer gave a result."]
    if not lost:
        least = min(ratios)
        return [
            f"stiction is faster than every peer at that peer's accuracy, in all {len(found)} rows"
            f" of peers: {least:.3g} to {max(ratios):.3g} times."
        ]
    sentence = (
        f"stiction is faster in {len(found) - len(lost)} of the {len(found)} rows of peers at that"
        " row's accuracy in both forces. It is not in:"
    )
    return [sentence, *(_excuse(match) for match in lost)]


def _excuse(match: Match) -> str:
    peer, ours, ratio = match
    assert peer.errors is not None
    what = f"{peer.solver} ({peer.settings}), {1e3 * peer.seconds:.3g} ms"
    if ours is None or ratio is None:
        return f"{what}: no row of stiction is as accurate in both"
    return f"{what}: stiction ({ours.settings}) takes {1 / ratio:.3g} times as long"


def failures(rows: Sequence[Row]) -> list[str]:
    """Say what has no result, and why."""
    return [f"{row.solver} ({row.settings or 'all'}): {row.note}" for row in rows if row.note]
