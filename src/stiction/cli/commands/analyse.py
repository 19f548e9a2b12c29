"""``stiction analyse`` and ``stiction import``: analyse runs and measured records."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from stiction.cli.options import MaybeOutput, RecordOptions, Trust, source_in
from stiction.cli.terminal import say


def analyse(
    result: Path,
    /,
    *,
    output: MaybeOutput = None,
    trust: Trust = False,
    measured: RecordOptions | None = None,
) -> None:
    """Analyse a result or a measured record: kind of motion, cycles, creep, oscillation, energy.

    Prints a report, which begins with the answer in short, and writes tables: cycles.csv (a row for
    each cycle), summary.csv, friction.csv, creep.csv, creep-phases.csv, oscillation.csv,
    oscillation-phases.csv and energy.csv; of a test, velocity-steps.csv, healing.csv,
    hysteresis.csv or load-dependence.csv; numbers in analysis.json; figures of the test, cycles,
    creep, oscillation and energy. A quantity that is not determined has no file. Creep and
    oscillation need several samples per transverse period.

    For example, after `stiction run my.toml -o my.nc`:

        stiction analyse my.nc -o report

    A record of a load cell, as `stiction import` reads it:

        stiction analyse data.csv --time ms --force mN --stiffness 168N/m --drive-velocity 42um/s

    Parameters
    ----------
    result
        A file written by `stiction run`, or a measured record: CSV and other text, .lvm, .tdms,
        .mat, HDF5, NetCDF, .npy, .npz, Parquet.
    output
        The folder to write to, by default RESULT-analysis; made if it does not exist. Example: -o
        report.
    """
    from stiction.analysis.export import write as write_tables
    from stiction.analysis.parts.cycles import each_cycle
    from stiction.analysis.record import Record
    from stiction.analysis.report import analyse as understand
    from stiction.cli.progress import progress
    from stiction.cli.tables import print_sections
    from stiction.plotting.analysis.overview import figures
    from stiction.plotting.page.save import drawable, write
    from stiction.storage.files import make_folder, usable_folder
    from stiction.text.columns import rows_left_out
    from stiction.text.sections import Section

    source = source_in(result, measured, trust)
    folder = result.with_name(f"{result.stem}-analysis") if output is None else output
    usable_folder(folder)
    with progress("analysing"):
        found = understand(source)
        parts = found.tables()
        make_folder(folder)
        paths = write_tables(found, folder)
        for name, figure in figures(found).items():
            paths.append(write(figure, drawable(folder / f"{name}.png")))
    if count := found.cycles.sizes["cycle"]:
        at = [part.title for part in parts].index("Cycles") + 1
        more = rows_left_out(count, "cycles", "cycles.csv")
        parts.insert(at, Section("Cycle by cycle", more, each_cycle(found.cycles)))
    if isinstance(source, Record) and source.origin is not None:
        parts += source.origin.tables()
    print_sections(str(result), parts)
    say(f"\nwrote {', '.join(path.name for path in paths)} to {folder}")


def import_(
    file: Path,
    /,
    *files: Path,
    output: MaybeOutput = None,
    json: Annotated[Path | None, Parameter(name="--json")] = None,
    measured: RecordOptions | None = None,
) -> None:
    """Read measured records, show what was guessed, and store them as NetCDF.

    CSV and other text, LabVIEW (.lvm), TDMS, MATLAB, HDF5, NetCDF, NumPy and Parquet are recognised
    by their content. Columns, units, rate and all that was skipped are shown; what cannot be
    guessed safely is an error with the choices, to be settled by an option, or by a file data.toml
    beside data.csv:

        [columns]
        time = "ms"
        force = "CH1=2.5 N/V"       # column, unit, or both
        [record]
        normal_load = "10 N"
        turned = "2 deg"            # on purpose, which a fit adds to the misalignment
        [sensors.force]
        noise = "2 mN"
        zero = "3 +- 1 mN"          # at the first sample
        zero_drift = "0 +- 5 mN/min"

    For example:

        stiction import data.csv --time ms --force mN

        stiction import data.csv -o record.nc

    Several blocks or files become record-1.nc, record-2.nc, and so on. In Python it is
    `st.read_record("data.csv")`.

    Parameters
    ----------
    file
        A measured record, or a folder with a file for each stroke.
    files
        More of them.
    output
        The file to write, .nc, which `stiction analyse` and xarray read; by default none. Example:
        -o record.nc.
    json
        Write the guess as JSON, too. Example: --json guess.json.
    """
    from stiction.analysis.measurement.reading import read_records
    from stiction.cli.progress import progress
    from stiction.cli.tables import print_sections
    from stiction.storage.files import NETCDF, placeable, write_text

    if output is not None:
        placeable(output, NETCDF)
    if json is not None:
        placeable(json)
    said = (measured or RecordOptions()).arguments()
    with progress("reading"):
        records = read_records([file, *files], **said)
    targets: list[Path] = []
    if output is not None:
        several = len(records) > 1
        targets = [
            output.with_name(f"{output.stem}-{at}{output.suffix}") if several else output
            for at in range(1, len(records) + 1)
        ]
    for record in records:
        assert record.origin is not None
        print_sections(record.origin.file, record.origin.tables())
        say("")
    for record, target in zip(records, targets, strict=False):
        say(f"wrote {record.save(target)}")
    if json is not None:
        guesses = ",\n".join(x.origin.to_json() for x in records if x.origin is not None)
        text = f"[{guesses}]\n"
        say(f"wrote {write_text(text, json)}")
    if output is None:
        say("nothing is stored: -o record.nc stores it; an option corrects the guess, see --help")
