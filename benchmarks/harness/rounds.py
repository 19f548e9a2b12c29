"""Wall times of several contestants, taken side by side."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import inf
from time import perf_counter


def round_robin(
    measures: Sequence[Callable[[], float]],
    *,
    repeats: int,
    budget: float,
    until: float = inf,
    after_each: Callable[[], object] = lambda: None,
) -> list[list[float]]:
    """Time every contestant once a round, so that a noisy machine treats all alike.

    Parameters
    ----------
    measures : sequence of callable
        Each runs a contestant, compiled already, and returns the seconds that took.
    repeats : int
        Number of rounds.
    budget : float
        A contestant whose runs have taken this many seconds in all sits out the later rounds.
    until : float
        When to stop, on the clock of `perf_counter`.
    after_each : callable
        Called after each run and each run sat out, `repeats` times a contestant.

    Returns
    -------
    list of list of float
        Wall times in s for each contestant, in its order.
    """
    times: list[list[float]] = [[] for _ in measures]
    for _ in range(repeats):
        for measure, own in zip(measures, times, strict=True):
            if sum(own) < budget and perf_counter() < until:
                own.append(measure())
            after_each()
    return times
