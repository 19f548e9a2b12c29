"""Wall times of several contestants, taken side by side."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from time import perf_counter

from .contestant import Contestant


def round_robin(
    contestants: Sequence[Contestant],
    *,
    repeats: int,
    budget: float,
    after_each: Callable[[], object] = lambda: None,
) -> list[list[float]]:
    """Time every contestant once a round, so that a noisy machine treats all alike.

    Parameters
    ----------
    contestants : sequence of Contestant
        Compiled already.
    repeats : int
        Number of rounds.
    budget : float
        A contestant whose runs have taken this many seconds in all sits out the later rounds.
    after_each : callable
        Called after each run and each run sat out, `repeats` times a contestant.

    Returns
    -------
    list of list of float
        Wall times in s for each contestant, in its order.
    """
    times: list[list[float]] = [[] for _ in contestants]
    for _ in range(repeats):
        for contestant, own in zip(contestants, times, strict=True):
            if sum(own) < budget:
                start = perf_counter()
                contestant.measure()
                own.append(perf_counter() - start)
            after_each()
    return times
