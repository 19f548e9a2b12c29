"""One row of a comparison: a solver with its settings."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Solve = Callable[[NDArray[np.float64]], NDArray[np.float64]]


class Failed(RuntimeError):
    """A solver gave up before the end."""


class Contestant(NamedTuple):
    """A solver with its settings.

    Attributes
    ----------
    solver : str
        What solves; rows of one solver share it.
    settings : str
        Tolerances and the like, as printed.
    solve : callable
        Takes evenly spaced times (s, the first is 0) and returns the elongations (m) there, shape
        (..., n, 2). Raises `Failed`. The first call with so many times may compile.
    """

    solver: str
    settings: str
    solve: Solve


def rows(
    solver: str, solve: Callable[..., NDArray[np.float64]], settings: Sequence[Mapping[str, Any]]
) -> list[Contestant]:
    """Return a contestant for each of the settings, which are passed on to `solve` by name."""
    return [Contestant(solver, text(own), partial(solve, **own)) for own in settings]


def text(settings: Mapping[str, Any]) -> str:
    """Return settings as printed."""
    return ", ".join(
        f"{name}={value:g}" if isinstance(value, float) else f"{name}={value}"
        for name, value in settings.items()
    )
