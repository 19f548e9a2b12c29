"""Reports of the progress of long work, and of its parts."""

from __future__ import annotations

from collections.abc import Callable

Progress = Callable[[float], None]  # is given the fraction done


def silent(fraction: float) -> None:
    """Report nothing."""


def part(whole: Progress, before: int, count: int, of: int = 1) -> Progress:
    """Return the progress of `of` parts, after `before` others, of a whole of `count` parts."""
    return lambda fraction: whole((before + of * fraction) / count)
