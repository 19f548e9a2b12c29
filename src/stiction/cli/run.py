"""``stiction run``: simulate a described apparatus."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter


def run(config: Path, /, *, output: Annotated[Path, Parameter(alias="-o")]) -> int:
    """Simulate the apparatus that CONFIG describes and write the result as NetCDF.

    Exit status: 0 when the run reached its duration, 1 when it ended earlier (what was
    computed is written all the same), 2 when the description cannot be simulated.

    Parameters
    ----------
    config
        A description in TOML; `stiction init` writes one to start from.
    output
        The NetCDF file to write: samples over time, and every stick interval.
    """
    from rich.console import Console

    from stiction.cli.progress import progress
    from stiction.description import Description
    from stiction.simulation import run as simulate
    from stiction.trajectory import writable

    description = Description.from_toml(config)
    writable(output)
    with progress("simulating") as report:
        result = simulate(description, progress=report)
        result.save(output)
    console = Console(soft_wrap=True, highlight=False)
    statistics, stuck = result.statistics, result.statistics.time_stuck
    if not result.status.ok:
        reached = float(result.data.time[-1])
        console.print(f"[red]ended early[/red] at t = {reached:.6g} s: {result.status.value}")
    peak = float(abs(result.data["spring_x"]).max())
    mapped = f", {statistics.mapped} intervals without any" if statistics.mapped else ""
    few = result.data.sizes["time"] <= 2
    sampled = " at start and end (no sample_rate)" if few else ""
    for line in (
        f"{output}: {result.data.sizes['time']} samples, stick intervals: "
        f"{statistics.stick_count}, {stuck:.6g} s in all; {statistics.steps} steps{mapped}",
        f"largest k_x u_x{sampled}: {peak:.4g} N, {peak / result.slider.normal_load:.4g} of the "
        "normal load",
        f"next: stiction plot {output} --output {output.with_suffix('.png')}, "
        f"stiction analyse {output}",
    ):
        console.print(line, markup=False)
    if statistics.steps == 0:
        still = not result.data["drive_X"].any() and not result.data["drive_Y"].any()
        remedy = "the drive is at rest; give it a velocity" if still else "run it longer"
        console.print(f"it never slipped: friction could hold all the time; {remedy}")
    return 0 if result.status.ok else 1
