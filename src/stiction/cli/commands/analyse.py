"""``stiction analyse`` and ``stiction import``: analyse runs and measured records."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from stiction.cli.options import MaybeOutput, RecordOptions, Trust, source_in
from stiction.cli.terminal import say

if TYPE_CHECKING:
    from stiction.analysis.report import Analysis


def analyse(
    result: Path,
    /,
    *results: Path,
    output: MaybeOutput = None,
    trust: Trust = False,
    measured: RecordOptions | None = None,
) -> None:
    """Analyse results or measured records: kind of motion, cycles, creep, oscillation, energy.

    Prints a report, which begins with the answer in short, and writes a folder or a page. The
    folder holds the report as text, report.txt; tables: cycles.csv (a row for each cycle),
    summary.csv, friction.csv, creep.csv, creep-phases.csv, oscillation.csv, oscillation-phases.csv
    and energy.csv; of a test, velocity-steps.csv, healing.csv, hysteresis.csv or
    load-dependence.csv; numbers in analysis.json; figures of the test, cycles, creep, oscillation
    and energy. The page, .html, has the report with the figures in one file. A quantity that is not
    determined has no file. Creep and oscillation need several samples per transverse period.

    For example, after `stiction run my.toml -o my.nc`:

        stiction analyse my.nc -o report

        stiction analyse my.nc -o report.html

    A record of a load cell, as `stiction import` reads it:

        stiction analyse data.csv --time ms --force mN --stiffness 168N/m --drive-velocity 42um/s

    Of several, a table is printed, with a row for each: motion, friction, means over cycles,
    misalignment and warnings. It is written as records.csv, or into a page with a figure of each.
    Options hold for all; a file data.toml beside data.csv says what holds for that one alone:

        stiction analyse slow.csv fast.csv --time ms --force mN -o records.csv

    So are the strokes of a drive that goes to and fro, with their mean:

        stiction analyse data.csv --time ms --force mN --drive-position um --stroke all

    Parameters
    ----------
    result
        A file written by `stiction run`, or a measured record: CSV and other text, .lvm, .tdms,
        .mat, HDF5, NetCDF, .npy, .npz, Parquet.
    results
        More of them, or folders of them.
    output
        The folder or the page (.html) to write, by default the folder RESULT-analysis; of several
        results also the table alone (.csv), by default the folder records-analysis beside the
        first. A folder is made if it does not exist. Example: -o report.
    """
    from stiction.analysis.export import full_report
    from stiction.analysis.report import analyse as understand
    from stiction.cli.tables import as_file, print_sections
    from stiction.plotting.page.html import SUFFIXES
    from stiction.progress.display import show_progress
    from stiction.storage.files import folder_or_file, usable_folder, without_compression

    if results or (measured is not None and measured.stroke == "all"):
        _analyse_several([result, *results], output, trust, measured)
        return
    source = source_in(result, measured, trust)
    if output is None:  # any name of a folder will do: that of the file may have more dots
        target = result.with_name(f"{without_compression(result).stem}-analysis")
        usable_folder(target)
    else:
        target = folder_or_file(output, SUFFIXES)
    with show_progress("analysing"):
        found = understand(source)
        parts = full_report(found)
        if target.suffix.lower() in SUFFIXES:
            written = str(found.write_html(target, result.name))
        else:
            paths = _write_folder(found, target, as_file(str(result), parts))
            written = f"{', '.join(path.name for path in paths)} to {target}"
    print_sections(str(result), parts)
    say(f"\nwrote {written}")


def _write_folder(found: Analysis, folder: Path, text: str) -> list[Path]:
    """Write tables, text and figures of an analysis into a folder; return their paths."""
    from stiction.analysis.export import write as write_tables
    from stiction.plotting.analysis.overview import figures
    from stiction.plotting.page.save import drawable, write
    from stiction.storage.files import make_folder, write_text

    make_folder(folder)
    paths = [write_text(text, folder / "report.txt"), *write_tables(found, folder)]
    for name, figure in figures(found).items():
        paths.append(write(figure, drawable(folder / f"{name}.png")))
    return paths


def _analyse_several(
    results: list[Path], output: Path | None, trust: bool, measured: RecordOptions | None
) -> None:
    """Analyse several results or records: a row each."""
    from stiction.analysis.export import full_report
    from stiction.analysis.measurement.reading import read_sources
    from stiction.analysis.report import analyse as understand
    from stiction.analysis.several import mean_over, section, side_by_side
    from stiction.cli.tables import as_file, print_sections
    from stiction.plotting.analysis.page import write_several
    from stiction.plotting.page.html import SUFFIXES
    from stiction.progress.display import show_progress
    from stiction.storage.files import folder_or_file, make_folder, write_text
    from stiction.storage.table_files import write_tables

    said = (measured or RecordOptions()).arguments()
    with show_progress("reading"):
        sources = read_sources(results, trust=trust, **said)
    target = folder_or_file(output or results[0].with_name("records-analysis"), (*SUFFIXES, ".csv"))
    with show_progress("analysing") as report:
        found = {}
        for number, (name, source) in enumerate(sources.items()):
            found[name] = understand(source)
            report((number + 1) / len(sources))
    tables = [section(found)]
    if said.get("stroke") == "all":
        tables.append(mean_over(found))
    print_sections(f"{len(found)} records", tables)
    if target.suffix.lower() in SUFFIXES:
        with show_progress("drawing"):
            paths = [write_several(found, target)]
    elif target.suffix.lower() == ".csv":
        paths = write_tables({"records": side_by_side(found)}, target, {})
    else:
        make_folder(target)
        text = as_file(f"{len(found)} records", tables)
        text += "".join("\n\n" + as_file(x, full_report(each)) for x, each in found.items())
        paths = write_tables({"records": side_by_side(found)}, target / "records.csv", {})
        paths.append(write_text(text, target / "report.txt"))
    say(f"wrote {', '.join(map(str, paths))}")


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
    from stiction.cli.tables import print_sections
    from stiction.progress.display import show_progress
    from stiction.storage.files import NETCDF, placeable, write_text

    if output is not None:
        placeable(output, NETCDF)
    if json is not None:
        placeable(json)
    said = (measured or RecordOptions()).arguments()
    with show_progress("reading"):
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
