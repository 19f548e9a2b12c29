"""``stiction run``: simulate a described apparatus."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from stiction.cli.options import Changes, Output, Trust, changes
from stiction.cli.terminal import say

if TYPE_CHECKING:
    from stiction.trajectory import Trajectory


def run(config: Path, /, *, output: Output, trust: Trust = False, set: Changes = None) -> int:
    """Simulate the apparatus that CONFIG describes and write the result as NetCDF.

    For example, with what `stiction init my.toml` writes, and then with another misalignment
    and speed:

        stiction run my.toml -o my.nc

        stiction run my.toml --set phi=3deg --set V=2mm/s -o other.nc

    Exit status: 0 when the run reached its duration, 1 when it ended earlier (what was
    computed is written all the same), 2 when the description cannot be simulated.

    Parameters
    ----------
    config
        A description in TOML; `stiction init` writes one to start from.
    output
        The NetCDF file to write: samples over time, and every stick interval.
    """
    from stiction import simulation
    from stiction.cli.progress import progress
    from stiction.description import Description
    from stiction.trajectory import writable

    description = Description.from_toml(config, changes(set), trust=trust)
    writable(output)
    with progress("simulating") as report:
        result = simulation.run(description, progress=report)
        result.save(output)
    for line in said(result, output):
        say(line)
    return 0 if result.status.ok else 1


def said(result: Trajectory, output: Path) -> list[str]:
    """Return what is said of a run that is written."""
    statistics = result.statistics
    lines = []
    if not result.status.ok:
        reached = float(result.data.time[-1])
        lines.append(f"ended early at t = {reached:.6g} s: {result.status.value}")
    peak = float(abs(result.data["spring_x"]).max())
    mapped = f", {statistics.mapped} intervals without any" if statistics.mapped else ""
    few = result.data.sizes["time"] <= 2
    sampled = " at start and end (sample_rate = 0)" if few else ""
    lines += [
        f"{output}: {result.data.sizes['time']} samples, stick intervals: "
        f"{statistics.stick_count}, {statistics.time_stuck:.6g} s in all; "
        f"{statistics.steps} steps{mapped}",
        f"largest k_x u_x{sampled}: {peak:.4g} N, {peak / result.slider.normal_load:.4g} of the "
        "normal load",
        f"next: stiction plot {output} --output {output.with_suffix('.png')}, "
        f"stiction analyse {output}",
    ]
    if statistics.steps == 0:
        still = not result.data["drive_X"].any() and not result.data["drive_Y"].any()
        remedy = "the drive is at rest; give it a velocity" if still else "run it longer"
        lines.append(f"it never slipped: friction could hold all the time; {remedy}")
    return lines
