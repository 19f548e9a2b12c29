"""Layout of a study: the grid of runs along its dimensions, cut into blocks."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from math import ceil, prod
from typing import NamedTuple

Index = tuple[int, ...]
Region = tuple[slice, ...]

# Seconds that a block should take. It is one task, and is written at once: its overhead is then a
# hundredth of its runs, and a kill loses only a second.
SECOND = 1.0
AHEAD = 2  # tasks handed out per worker: one running, one waiting
FEW_TASKS, MANY_TASKS = 32, 4096  # of a study: desired minimum, for many workers, and maximum


class Layout(NamedTuple):
    """The grid of runs, cut into blocks.

    Parameters
    ----------
    dims : tuple of str
        Names of the dimensions.
    shape, block : tuple of int
        Number of runs along each dimension, in all and in a block; the last may be smaller.
    """

    dims: tuple[str, ...]
    shape: Index
    block: Index

    @property
    def runs(layout) -> int:
        """Number of runs."""
        return prod(layout.shape)

    @property
    def tasks(layout) -> int:
        """Number of blocks."""
        return prod(layout.blocks)

    @property
    def blocks(layout) -> Index:
        """Number of blocks along each dimension."""
        return tuple(ceil(n / b) for n, b in zip(layout.shape, layout.block, strict=True))

    def region(layout, task: int) -> Region:
        """Return the part of the grid in block number `task`."""
        places = []
        for count in reversed(layout.blocks):
            task, place = divmod(task, count)
            places.append(place)
        ends = zip(reversed(places), layout.block, layout.shape, strict=True)
        return tuple(slice(at * b, min((at + 1) * b, n)) for at, b, n in ends)


def laid_out(sizes: dict[str, int], seconds: float) -> Layout:
    """Return the layout of a grid, given the number of runs along each dimension.

    `seconds` is the approximate duration of a run.
    """
    shape = tuple(sizes.values())
    runs = prod(shape)
    wanted = max(min(SECOND / seconds, runs / FEW_TASKS), runs / MANY_TASKS, 1.0)
    return Layout(tuple(sizes), shape, block_of(shape, wanted))


def block_of(shape: Index, wanted: float) -> Index:
    """Return the shape of blocks of about `wanted` runs, as cubic as possible."""
    block = [1] * len(shape)
    by_size = sorted(range(len(shape)), key=lambda i: shape[i])
    for done, i in enumerate(by_size):  # longer dimensions take what a short one cannot
        side = wanted ** (1.0 / (len(shape) - done))
        block[i] = ceil(shape[i] / ceil(shape[i] / side))
        wanted = max(wanted / block[i], 1.0)
    return tuple(block)


def places(region: Region) -> Iterator[Index]:
    """Yield the index of each run of a region, last dimension first."""
    yield from product(*(range(part.start, part.stop) for part in region))


def size_of(region: Region) -> Index:
    """Return the number of runs in a region along each dimension."""
    return tuple(part.stop - part.start for part in region)


def runs_of(region: Region) -> int:
    """Return the number of runs in a region."""
    return prod(size_of(region))
