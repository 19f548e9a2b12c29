"""Layout of a study: the grid of runs along its dimensions, cut into blocks, and its memory."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import product
from math import ceil, prod
from typing import NamedTuple

from stiction.errors import Fault
from stiction.machine import CORES, shortage
from stiction.study.plan.axes import Axis, Sobol

Index = tuple[int, ...]
Region = tuple[slice, ...]

# Seconds that a block should take. It is one task, and is written at once: its overhead is then a
# hundredth of its runs, and a kill loses only a second.
SECOND = 1.0
AHEAD = 2  # tasks handed out per worker: one running, one waiting
FEW_TASKS, MANY_TASKS = 32, 4096  # of a study: desired minimum, for many workers, and maximum
NUMBER = 8  # bytes
COPIES = 6  # of an axis's values while they are computed
A_RUN = 4  # bytes per run, to count how the runs ended


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
    def runs(self) -> int:
        """Number of runs."""
        return prod(self.shape)

    @property
    def tasks(self) -> int:
        """Number of blocks."""
        return prod(self.blocks)

    @property
    def blocks(self) -> Index:
        """Number of blocks along each dimension."""
        return tuple(ceil(n / b) for n, b in zip(self.shape, self.block, strict=True))

    def region(self, task: int) -> Region:
        """Return the part of the grid in block number `task`."""
        places = []
        for count in reversed(self.blocks):
            task, place = divmod(task, count)
            places.append(place)
        ends = zip(reversed(places), self.block, self.shape, strict=True)
        return tuple(slice(at * b, min((at + 1) * b, n)) for at, b, n in ends)


def layout_of(sizes: dict[str, int], seconds: float) -> Layout:
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
    """Return the number of a region's runs along each dimension."""
    return tuple(part.stop - part.start for part in region)


def runs_of(region: Region) -> int:
    """Return the number of runs in a region."""
    return prod(size_of(region))


def axis_faults(axes: Mapping[str, Axis]) -> Iterator[Fault]:
    """Yield a fault for each axis whose values do not fit into memory."""
    for place, (path, axis) in enumerate(axes.items()):
        # a Sobol sequence is computed with all coordinates up to this one
        columns = COPIES + (2 * (place + 1) if isinstance(axis, Sobol) else 0)
        if short := shortage(float(NUMBER * columns) * axis.count):
            yield Fault(f"axes.{path}.count", f"{axis.count} values: {short}; take fewer")


def run_faults(layout: Layout, numbers: int, traces: int, samples: int) -> Iterator[Fault]:
    """Yield a fault if the status of all runs, or the unwritten blocks, do not fit into memory."""
    if short := shortage(float(A_RUN) * layout.runs):
        shape = " x ".join(map(str, layout.shape))
        yield Fault("axes", f"{shape} runs: to count them {short}; take fewer values of an axis")
        return
    blocks = 2.0 * AHEAD * CORES * prod(layout.block)  # running, or on their way to the disk
    if short := shortage(NUMBER * blocks * (numbers + traces * samples)):
        kept = f"{numbers} measures, {traces} traces of {samples} samples"
        remedy = "keep fewer traces or samples, or take fewer values of an axis"
        yield Fault("trace_samples" if traces else "axes", f"{kept} of each run: {short}; {remedy}")
