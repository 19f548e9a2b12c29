"""How the runs of a study lie along its dimensions, and in blocks of them."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from math import ceil, prod
from typing import NamedTuple

Index = tuple[int, ...]
Region = tuple[slice, ...]

# A block is one task, written at once. It takes about a second: then handing it out and writing
# it costs a hundredth of its runs, and a kill loses no more.
SECOND = 1.0
AHEAD = 2  # tasks handed out for each worker: one in hand, one waiting
FEW_TASKS, MANY_TASKS = 32, 4096  # wanted at least, for many workers, and kept to at most


class Layout(NamedTuple):
    """The grid of runs and the blocks that it is cut into.

    Parameters
    ----------
    dims : tuple of str
        Names of the dimensions.
    shape, block : tuple of int
        Runs along each in all, and in one block; the last block may be smaller.
    """

    dims: tuple[str, ...]
    shape: Index
    block: Index

    @property
    def runs(layout) -> int:
        """How many runs there are."""
        return prod(layout.shape)

    @property
    def tasks(layout) -> int:
        """How many blocks there are."""
        return prod(layout.blocks)

    @property
    def blocks(layout) -> Index:
        """How many blocks there are along each dimension."""
        return tuple(ceil(n / b) for n, b in zip(layout.shape, layout.block, strict=True))

    def region(layout, task: int) -> Region:
        """Return the part of the grid that is the block number `task`."""
        places = []
        for count in reversed(layout.blocks):
            task, place = divmod(task, count)
            places.append(place)
        ends = zip(reversed(places), layout.block, layout.shape, strict=True)
        return tuple(slice(at * b, min((at + 1) * b, n)) for at, b, n in ends)


def laid_out(sizes: dict[str, int], seconds: float) -> Layout:
    """Return the layout of a grid with so many runs along each dimension.

    `seconds` is about what a run takes.
    """
    shape = tuple(sizes.values())
    runs = prod(shape)
    wanted = max(min(SECOND / seconds, runs / FEW_TASKS), runs / MANY_TASKS, 1.0)
    return Layout(tuple(sizes), shape, block_of(shape, wanted))


def block_of(shape: Index, wanted: float) -> Index:
    """Return the shape of blocks of about as many runs as `wanted`, as cubic as they can be."""
    block = [1] * len(shape)
    by_size = sorted(range(len(shape)), key=lambda i: shape[i])
    for done, i in enumerate(by_size):  # what a short dimension does not take, longer ones do
        side = wanted ** (1.0 / (len(shape) - done))
        block[i] = ceil(shape[i] / ceil(shape[i] / side))
        wanted = max(wanted / block[i], 1.0)
    return tuple(block)


def places(region: Region) -> Iterator[Index]:
    """Yield the index of each run of a region, last dimension first."""
    yield from product(*(range(part.start, part.stop) for part in region))


def size_of(region: Region) -> Index:
    """Return how many runs a region has along each dimension."""
    return tuple(part.stop - part.start for part in region)


def runs_of(region: Region) -> int:
    """Return how many runs a region has."""
    return prod(size_of(region))
