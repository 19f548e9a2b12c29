"""``stiction compare``: one apparatus under several friction laws."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

if TYPE_CHECKING:
    from stiction.description import Description
    from stiction.trajectory import Trajectory

SAMPLES = 20_000  # where the description asks for none
HEADER = (
    ("sticks", "stuck", "largest", "fastest", "in first load-up", "", "steps", "run", "law"),
    ("", "(s)", "k_x u_x/W", "slip (m/s)", "slowest (m/s)", "median", "", "", ""),
)


def compare(
    config: Path,
    /,
    *,
    law: Annotated[list[str], Parameter(negative=())],
    output: Annotated[Path, Parameter(alias="-o")],
    data: Path | None = None,
) -> int:
    """Run the apparatus of CONFIG under its own friction law and others, and draw them together.

    Spring force, position, slip speed over decades and phase portrait: the picture shows which
    part of "stick" each law predicts. True zero slip, which no logarithmic axis holds, has a
    row for each law below the slip speed.

    For example, with what `stiction init my.toml` writes:

        stiction compare my.toml --law coulomb --law '{law = "coulomb", mu_0 = 0.15}' -o laws.png

    A law given by its name alone takes comparable parameters from the law in CONFIG: its
    friction coefficient at rest, in fast slip, and the slip speed in between.

    Exit status: 0 when every run reached its duration, 1 when one ended earlier (it is drawn
    all the same), 2 when a law or the description cannot be simulated.

    Parameters
    ----------
    config
        A description in TOML; `stiction init` writes one to start from.
    law
        A law to compare with; repeat it for more. A name (coulomb), an inline table with its
        parameters ('{law = "coulomb", mu_0 = 0.15}'), another description (other.toml), of
        which the table [friction] is taken, or a law of your own (file.py:Class).
    output
        The figure to write: .png, .pdf or .svg.
    data
        A folder for the results as well, a NetCDF file each; made if it is not there.
    """
    from rich.console import Console

    from stiction import comparison
    from stiction.cli.progress import progress
    from stiction.description import Description
    from stiction.files import usable_folder
    from stiction.plotting.comparison import comparison as draw
    from stiction.plotting.save import drawable, write

    description = sampled(Description.from_toml(config))
    drawable(output)
    if data is not None:
        usable_folder(data)
    with progress("simulating and drawing") as report:
        runs = comparison.compare(description, law, progress=report)
        figure = draw(runs)
    write(figure, output)
    written = [output, *([] if data is None else save(runs, data))]
    console = Console(soft_wrap=True, highlight=False)
    for line in (*table(runs), "", *(f"wrote {path}" for path in written)):
        console.print(line, markup=False)
    for label, run in runs.items():
        if not run.status.ok:
            console.print(f"{label} [red]ended early[/red]: {run.status.value}")
    return 0 if all(run.status.ok for run in runs.values()) else 1


def sampled(description: Description) -> Description:
    """Return the description with a sample rate, which a figure over time needs."""
    if description.run.sample_rate is not None:
        return description
    settings = description.run.model_dump(exclude_none=True)
    rate = SAMPLES / description.run.duration
    return description._replace(run=type(description.run)(**(settings | {"sample_rate": rate})))


def save(runs: Mapping[str, Trajectory], folder: Path) -> list[Path]:
    """Write each run to a file named after its law; return the paths."""
    from stiction.files import make_folder

    make_folder(folder)
    names = (re.sub(r"[^\w.-]+", "-", label).strip("-") for label in runs)
    paths = (folder / f"{count}-{name}.nc" for count, name in enumerate(names, 1))
    return [run.save(path) for run, path in zip(runs.values(), paths, strict=True)]


def table(runs: Mapping[str, Trajectory]) -> list[str]:
    """Return the lines of a table with a row for each law."""
    from stiction.analysis.slip import outcome

    rows: list[tuple[str, ...]] = [*HEADER]
    for label, run in runs.items():
        o = outcome(run)
        speeds = (f"{value:.3g}" for value in (o.fastest, o.slowest, o.creep))
        stuck = (str(o.sticks), f"{o.time_stuck:.4g}")
        ended = "completed" if o.status.ok else o.status.name.lower().replace("_", " ")
        rows.append((*stuck, f"{o.peak:.4f}", *speeds, str(o.steps), ended, label))
    widths = [max(len(row[at]) for row in rows) for at in range(len(rows[0]))]
    lines = ["  ".join(c.ljust(w) for c, w in zip(row, widths, strict=True)) for row in rows]
    lines.insert(len(HEADER), "  ".join("-" * width for width in widths))
    return [line.rstrip() for line in lines]
