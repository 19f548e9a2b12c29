"""``stiction analyse``: analyse a run."""

from __future__ import annotations

from pathlib import Path

from stiction.cli.options import MaybeOutput, Trust
from stiction.cli.terminal import say


def analyse(result: Path, /, *, output: MaybeOutput = None, trust: Trust = False) -> None:
    """Analyse a result: kind of motion, cycles, creep before slip, oscillation, energy.

    Prints a report and writes the tables: cycles.csv (a row for each cycle), summary.csv,
    creep.csv, oscillation.csv, energy.csv, analysis.json, and a figure of each. There is nothing to
    tune. Creep and oscillation need several samples per transverse period.

    For example, after `stiction run my.toml -o my.nc`:

        stiction analyse my.nc

        stiction analyse my.nc -o report

    Parameters
    ----------
    result
        A file written by `stiction run`.
    output
        The folder to write to, by default RESULT-analysis; made if it does not exist.
    """
    from stiction.analysis.export import write as write_tables
    from stiction.analysis.parts.cycles import each_cycle
    from stiction.analysis.report import analyse as understand
    from stiction.cli.progress import progress
    from stiction.cli.tables import print_sections
    from stiction.plotting.analysis.overview import figures
    from stiction.plotting.page.save import drawable, write
    from stiction.storage.files import make_folder, usable_folder
    from stiction.text.sections import Section
    from stiction.trajectory import load

    folder = result.with_name(f"{result.stem}-analysis") if output is None else output
    run = load(result, trust=trust)
    usable_folder(folder)
    with progress("analysing"):
        found = understand(run)
        parts = found.tables()
        make_folder(folder)
        paths = write_tables(found, folder)
        for name, figure in figures(found).items():
            paths.append(write(figure, drawable(folder / f"{name}.png")))
    if found.cycles.sizes["cycle"]:
        at = [part.title for part in parts].index("Cycles") + 1
        parts.insert(at, Section("Cycle by cycle", [], each_cycle(found.cycles)))
    print_sections(str(result), parts)
    say(f"\nwrote {', '.join(path.name for path in paths)} to {folder}")
