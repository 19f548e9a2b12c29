"""Memory that a study needs, checked before it is allocated."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import prod

from stiction.errors import Fault
from stiction.machine import CORES, shortage
from stiction.study.plan.axes import Axis, Sobol
from stiction.study.plan.layout import AHEAD, Layout

NUMBER = 8  # bytes
COPIES = 6  # of an axis's values while they are computed
A_RUN = 4  # bytes per run, to count how the runs ended


def axis_faults(axes: Mapping[str, Axis]) -> Iterator[Fault]:
    """Yield each axis whose values do not fit into memory."""
    for place, (path, axis) in enumerate(axes.items()):
        # a Sobol sequence is computed with all coordinates up to this one
        columns = COPIES + (2 * (place + 1) if isinstance(axis, Sobol) else 0)
        if short := shortage(float(NUMBER * columns) * axis.count):
            yield Fault(f"axes.{path}.count", f"{axis.count} values: {short}; take fewer")


def run_faults(layout: Layout, numbers: int, traces: int, samples: int) -> Iterator[Fault]:
    """Yield what exceeds the memory: the status of all runs, or the blocks being written."""
    if short := shortage(float(A_RUN) * layout.runs):
        shape = " x ".join(map(str, layout.shape))
        yield Fault("axes", f"{shape} runs: to count them {short}; take fewer values of an axis")
        return
    blocks = 2.0 * AHEAD * CORES * prod(layout.block)  # running, or on their way to the disk
    if short := shortage(NUMBER * blocks * (numbers + traces * samples)):
        kept = f"{numbers} measures, {traces} traces of {samples} samples"
        remedy = "keep fewer traces or samples, or take fewer values of an axis"
        yield Fault("trace_samples" if traces else "axes", f"{kept} of each run: {short}; {remedy}")
