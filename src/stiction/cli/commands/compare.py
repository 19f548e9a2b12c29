"""``stiction compare``: one apparatus under several friction laws."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from stiction.cli.options import (
    Changes,
    FromPreset,
    Output,
    Trust,
    Window,
    changes,
    description_from,
)
from stiction.cli.terminal import say
from stiction.cli.writing import check_figure, check_output
from stiction.errors import Faults

if TYPE_CHECKING:
    from stiction.trajectory import Trajectory


def compare(
    config: Path | None = None,
    /,
    *,
    law: Annotated[list[str], Parameter(negative=())],
    output: Output,
    window: Window = None,
    data: Path | None = None,
    preset: FromPreset = None,
    trust: Trust = False,
    set: Changes = None,
) -> int:
    """Run the apparatus of CONFIG under its own friction law and others, and draw them together.

    The figure has spring force, position, slip speed on a logarithmic axis, and a phase portrait:
    it shows which part of "stick" each law predicts. True zero slip, which a logarithmic axis
    cannot show, has a row for each law below the slip speed.

    For example, with what `stiction init my.toml` writes:

        stiction compare my.toml --law coulomb --law '{law = "coulomb", mu_0 = 0.15}' -o laws.png

    A law given by name alone gets parameters comparable with the law in CONFIG: the same
    friction coefficients at rest and in fast slip, and the same slip speed in between. Laws that
    have no plateau to fall to, such as power-law-weakening, have the same slope at rest. Rate and
    state has the friction in fast slip at this speed, V*, and that at rest at V*/10000. Your own
    law has its defaults, or such parameters if its class has a method `like`.

    Exit status: 0 if every run reached its duration, 1 if one ended earlier (it is still drawn),
    2 if a law or the description cannot be simulated.

    Parameters
    ----------
    config
        A description in TOML; `stiction init` writes one to start from.
    law
        A law to compare with; repeat it for more. A name (coulomb), an inline table with its
        parameters ('{law = "coulomb", mu_0 = 0.15}'), another description (other.toml), whose table
        [friction] is used, or your own law (file.py:Class). Example: --law coulomb.
    output
        The figure to write: .png, .pdf or .svg. Example: -o laws.png.
    window
        Start and end of what is drawn of each run; all of it by default. Example: --window 1.5s
        2.2s.
    data
        A folder for the results too, a NetCDF file each; made if it does not exist. Example: --data
        results.
    """
    from stiction import comparison
    from stiction.cli.tables import print_sections
    from stiction.plotting.page.canvas import figure_of
    from stiction.plotting.page.save import write
    from stiction.progress.display import show_progress
    from stiction.result.window import window_of
    from stiction.storage.files import usable_folder

    faults = Faults()
    given = changes(set, faults)
    with faults.of_part():
        description = description_from(config, preset, given, trust)
        with faults.of_part():
            window_of(description, window)
    check_figure(output, faults)
    check_output(data, faults, usable_folder)
    faults.refuse()
    with show_progress("simulating and drawing") as report:
        found = comparison.compare(description, law, progress=report)
        figure = figure_of(found.plot, window=window)
    write(figure, output)
    print_sections(str(config or preset), found.tables())
    for path in (output, *([] if data is None else save(found, data))):
        say(f"wrote {path}")
    return 0 if found.ok else 1


def save(runs: Mapping[str, Trajectory], folder: Path) -> list[Path]:
    """Write each run to a file named after its law; return the paths."""
    from stiction.storage.files import make_folder

    make_folder(folder)
    names = (re.sub(r"[^\w.-]+", "-", label).strip("-") for label in runs)
    paths = (folder / f"{count}-{name}.nc" for count, name in enumerate(names, 1))
    return [run.save(path) for run, path in zip(runs.values(), paths, strict=True)]
