"""One row of the table: a solver with its settings."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .problem import ENDS, GRID, spring_force


class Failed(RuntimeError):
    """A solver gave up before the end."""


class Contestant(NamedTuple):
    """A solver with its settings, able to solve the case and to be timed on it.

    Attributes
    ----------
    solver : str
        What solves; rows of one solver share it.
    settings : str
        Tolerances and the like, as printed.
    solve : callable
        Returns ``(k_x u_x, k_y u_y)`` in N on the grid of the problem, shape (n, 2). Raises
        `Failed`.
    measure : callable
        Solves once without samples, or with those the settings name; this is what is timed. By
        then, `solve` has been called and everything is compiled.
    missing : str
        Why the row is empty, where its solver is not there; empty otherwise.
    """

    solver: str
    settings: str
    solve: Callable[[], NDArray[np.float64]]
    measure: Callable[[], object]
    missing: str = ""


def _absent() -> NDArray[np.float64]:
    raise Failed("not installed")


def absent(solver: str, settings: str) -> Contestant:
    """Return the row of a solver that is not installed."""
    return Contestant(solver, settings, _absent, _absent, missing="not installed")


def on_times(
    solver: str, settings: str, solve: Callable[[NDArray[np.float64]], NDArray[np.float64]]
) -> Contestant:
    """Return the row of a solver that takes times (s) and returns elongations (m) there."""
    return Contestant(
        solver,
        settings,
        solve=lambda: spring_force(solve(GRID)),
        measure=partial(solve, ENDS),
    )
