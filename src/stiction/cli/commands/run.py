"""``stiction run``: simulate a described apparatus."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from stiction.cli.options import (
    Changes,
    FromPreset,
    Output,
    Trust,
    changes,
    description_from,
    trust_in,
)
from stiction.cli.terminal import say
from stiction.cli.writing import check_output
from stiction.errors import Faults, argument
from stiction.text.quantity.wording import percent

if TYPE_CHECKING:
    from stiction.trajectory import Trajectory


def run(
    config: Path | None = None,
    /,
    *,
    output: Output,
    preset: FromPreset = None,
    trust: Trust = False,
    set: Changes = None,
) -> int:
    """Simulate the apparatus that CONFIG describes and write the result as NetCDF.

    For example, with what `stiction init my.toml` writes, and then with another misalignment
    and speed:

        stiction run my.toml -o my.nc

        stiction run my.toml --set phi=3deg --set V=2mm/s -o other.nc

    A published system is run by its name, and compared with what is published of it:

        stiction run --preset leine-belt -o belt.nc

    Exit status: 0 if the run reached its duration, 1 if it ended earlier (the part computed is
    still written), 2 if the description cannot be simulated.

    Parameters
    ----------
    config
        A description in TOML; `stiction init` writes one to start from.
    output
        The NetCDF file to write: samples over time, and every stick interval. Example: -o my.nc.
    """
    from stiction import simulation
    from stiction.progress.display import show_progress
    from stiction.storage.files import NETCDF, placeable

    faults = Faults()
    given = changes(set, faults)
    with faults.of_part():
        description = description_from(config, preset, given, trust)
    check_output(output, faults, placeable, NETCDF)
    faults.refuse()
    with show_progress("simulating") as report:
        result = simulation.run(description, progress=report)
        result.save(output)
    for line in report_lines(result, output):
        say(line)
    if preset is not None and not given:
        compare_with_published(preset, result)
    return 0 if result.status.ok else 1


def compare_with_published(preset: str, result: Trajectory) -> None:
    """Print the numbers of a preset's run beside the published ones."""
    from stiction.cli.tables import print_sections
    from stiction.presets import find
    from stiction.presets.report import comparison
    from stiction.progress.display import show_progress

    found = find(preset)
    with show_progress("comparing"):
        section = comparison(found.numbers(result))
    print_sections(f"\n{found.reference}", [section])


def report_lines(result: Trajectory, output: Path) -> list[str]:
    """Return the lines of text about a written run."""
    from stiction.friction.law import implausible
    from stiction.result.peak import largest_spring_force
    from stiction.result.rest import rest_in_words
    from stiction.text.quantity.wording import in_words

    statistics = result.statistics
    lines = []
    if not result.status.ok:
        reached = float(result.samples["time"][-1])
        lines.append(f"ended early at t = {reached:.6g} s: {result.status.value}")
    peak = largest_spring_force(result.samples, result.slider.k_x)
    load = float(result.samples["normal_load"][peak.sample])
    then = "" if result.slider.load is None else " at that time"
    mapped = f", {statistics.mapped} of them by a return map" if statistics.mapped else ""
    count = len(result.samples["time"])
    sampled = " at start and end (sample_rate = 0)" if count <= 2 else ""
    seen = "" if peak.shown else ", at least"
    name, trust = argument(output), trust_in(result.slider)
    lines += [
        f"{output}: {count} samples, stick intervals: "
        f"{statistics.stick_count}, {in_words(statistics.time_stuck, 's')} in all"
        f"{share(result)}{mapped}; {statistics.steps} steps",
        f"largest force of the spring along x, k_x u_x{sampled or seen}: "
        f"{in_words(peak.force, 'N')}"
        f"{f', {peak.force / load:.4g} of the normal load{then}' if load > 0.0 else ''}",
        f"next: stiction plot {name} --output {argument(output.with_suffix('.png'))}{trust}, "
        f"stiction analyse {name}{trust}",
    ]
    if result.status.ok or statistics.steps == 0:
        rested = rest_in_words(result.slider, result.samples, statistics.steps)
        lines += [rested] if rested else []
    return lines + implausible(result.slider.law)


def share(result: Trajectory) -> str:
    """Return the share of time stuck, in words."""
    times = result.samples["time"]
    lasted = float(times[-1] - times[0])
    return (
        f", {percent(result.statistics.time_stuck / lasted, 3)} of the time" if lasted > 0.0 else ""
    )
