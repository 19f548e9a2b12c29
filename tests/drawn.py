"""Examples drawn at random once for all: no test depends on chance."""

from itertools import product

from benchmarks.explore.draw import Draw

SEED = 20  # any will do


def inside(count: int, *ranges: tuple[float, float]) -> list[tuple[float, ...]]:
    """Return points of a box."""
    draws = [Draw(SEED, number) for number in range(count)]
    return [tuple(draw.between(*ends) for ends in ranges) for draw in draws]


def all_over(count: int, *ranges: tuple[float, float]) -> list[tuple[float, ...]]:
    """Return the corners of a box, and points of it."""
    return [*product(*ranges), *inside(count, *ranges)]
