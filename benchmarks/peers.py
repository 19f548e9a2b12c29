"""Other people's ways to integrate the case, each at full compiled speed."""

from __future__ import annotations

from . import lsoda, runge_kutta
from .contestant import Contestant


def contestants() -> list[Contestant]:
    """Return the peers, those that are not installed marked as such."""
    return [*lsoda.of_numbalsoda(), *lsoda.of_scipy(), *runge_kutta.fixed_step()]
