"""Simulated records of each mechanism."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from stiction.arrays import Floats
from stiction.errors import ResultError
from stiction.inference.library import simulate_all
from stiction.inference.mechanism.rivals import Mechanism

Progress = Callable[[float], None] | None

FEWEST = 40  # simulations with cycles, below which a mechanism is left out


class Simulations(NamedTuple):
    """Simulated records: features (n, f), and the place of each one's mechanism among `names` (n,).

    `absent` are the mechanisms by which hardly any simulated record has cycles of stick and slip.
    """

    names: tuple[str, ...]
    features: Floats
    labels: NDArray[np.int64]
    absent: tuple[str, ...] = ()


def simulate(
    rivals: Sequence[Mechanism],
    count: int,
    folder: Path | None,
    *,
    seed: int = 0,
    progress: Progress = None,
) -> Simulations:
    """Simulate `count` records of each mechanism, the same number by each of its plans.

    Raises
    ------
    ResultError
        If by no mechanism enough of them have cycles of stick and slip.
    """
    total = sum(len(rival.plans) for rival in rivals)
    done, found, absent = 0, {}, []
    for rival in rivals:
        parts = []
        for plan in rival.plans:
            place = None if folder is None else folder / f"{plan.key}-{seed}"
            wanted = -(-count // len(rival.plans))
            report = partial(tell, progress, done, total)
            _, rows = simulate_all(plan, wanted, place, seed=seed, progress=report)
            parts.append(rows[np.isfinite(rows).all(axis=1)])
            done += 1
        features = np.concatenate(parts)
        if len(features) < FEWEST:
            absent.append(rival.name)
        else:
            found[rival.name] = features
    if not found:
        raise ResultError(
            f"by no mechanism {FEWEST} of {count} simulated records have cycles of stick and slip: "
            "check the priors, or simulate more"
        )
    labels = np.repeat(np.arange(len(found)), [len(each) for each in found.values()])
    return Simulations((*found,), np.concatenate([*found.values()]), labels, (*absent,))


def tell(progress: Progress, done: int, total: int, fraction: float) -> None:
    """Report the fraction done of all, when one of several is done to a fraction."""
    if progress is not None:
        progress((done + fraction) / total)
