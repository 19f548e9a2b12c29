"""Records from files of any kind."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any, Literal, TypedDict, Unpack

from stiction.analysis.record import Record
from stiction.arrays import xr
from stiction.errors import DescriptionError, Fault, Faults, Instruction, ResultError
from stiction.formats.frames import DataFrame, is_frame, tables_of_frame
from stiction.formats.table import natural_key
from stiction.recording.measurement import Measurement, read_measurements
from stiction.recording.part import part_between
from stiction.recording.request import AskedPart, ReadingOptions
from stiction.recording.stored import read_stored, root_attributes
from stiction.recording.strokes import ALL, all_strokes, stroke_of
from stiction.result.file import FIT_KIND, RECORD_KIND, refuse_kinds
from stiction.storage.kinds import use_of
from stiction.text.suggestion import Suggestion, as_argument, as_argument_elsewhere, suggest
from stiction.text.units import Quantity, Radians
from stiction.trajectory import Trajectory, load

TOGETHER = Instruction(
    f"`stiction fit --stroke {ALL}` takes them together",
    f"st.read_records(path, stroke={ALL!r}) reads all, and st.fit takes them together",
)


class ReadArguments(TypedDict, total=False):
    """The user's statements about a file; see `read_record`."""

    time: str | int | None
    force: str | int | None
    force_across: str | int | None
    load: str | int | None
    position: str | int | None
    drive_position: str | int | None
    slip_speed: str | int | None
    interval: Quantity | None
    times: str | None
    decimal: str | None
    separator: str | None
    wrap: str | None
    block: int | None
    stroke: int | Literal["all"] | None
    begin: Quantity | None
    end: Quantity | None
    normal_load: Quantity | None
    stiffness: Quantity | None
    stiffness_across: Quantity | None
    drive_velocity: Quantity | None
    mass: Quantity | None
    zero: Quantity | None
    turned: Quantity | None


@suggest(as_argument)
def read_record(
    path: str | Path | xr.Dataset | DataFrame,
    *,
    sidecar: str | Path | None = None,
    **said: Unpack[ReadArguments],
) -> Record:
    """Read a measured record from a file, or from a data frame or a dataset.

    CSV and other text, LabVIEW (.lvm), TDMS, MATLAB, HDF5, NetCDF, NumPy and Parquet are recognised
    by their content. What is guessed stands in ``record.origin``: print it. What cannot be guessed
    safely is an error with the choices.

    Parameters
    ----------
    path : str, Path, Dataset or DataFrame
        The file; text may be compressed with gzip. Or a table of xarray or pandas, whose columns
        are understood like those of a file: a unit stands in a name, ``"Fx [mN]"``, or in
        ``attrs["units"]``.
    sidecar : str or Path, optional
        A TOML file with tables [columns], [reading], [record] and [sensors.force], which hold the
        arguments below and sensors; by default ``data.toml`` beside ``data.csv``, if it is there.
    time, force, force_across, load, position, drive_position, slip_speed : str or int, optional
        The column of a channel by name or number, its unit, or both: ``"Fx"``, 3, ``"mN"``,
        ``"Fx=mN"``, ``"3=mN"``. A number multiplies the unit: ``"-1 N"`` turns the sign,
        ``"CH1=2.5 N/V"`` scales volts.
    normal_load, stiffness, stiffness_across, drive_velocity, mass, zero : float or str, optional
    turned : float or str, optional
        Of the apparatus; see `stiction.Record`.
    interval : float or str, optional
        Between two samples, for a file without times.
    times : {"clock", "intervals"}, optional
        Whether the column of times holds the interval before each sample instead.
    decimal, separator : str, optional
        "point" or "comma"; "tab", "comma", "semicolon", "space" or "bar".
    wrap : str, optional
        The length after which a displacement starts again, or "none".
    block : int, optional
        Which of several blocks, from 1: a block begins where the times of the file begin again.
    stroke : int or "all", optional
        Which stroke of a drive that goes to and fro, from 1, between two turns of its displacement.
        Forces and displacements of a way back are turned round. With ``"all"``, `read_records`
        returns a record of each.
    begin, end : float or str, optional
        Of the part to read, in the times of the file: after running in, before a gap.

    Returns
    -------
    Record
        In SI, with sensors whose noise and quantisation are estimated where they are not given.

    Raises
    ------
    ResultError
        If the file cannot be read, with line and column, or what it holds is ambiguous.
    DescriptionError
        If an argument or the TOML file is wrong.

    Examples
    --------
    >>> import stiction as st
    >>> from pathlib import Path
    >>> text = "Zeit;Kraft\\ns;mN\\n0,0;1,5\\n0,5;2,5\\n1,0;0,5\\n"
    >>> _ = Path("record.csv").write_text(text)
    >>> record = st.read_record("record.csv", stiffness="200 N/m")
    >>> record.force.tolist(), record.sample_rate
    ([0.0015, 0.0025, 0.0005], 2.0)

    A part of a run's data, as a record of the force alone:

    >>> run = st.simulate(st.presets.nakano_popov_2020(), "50 ms", sample_rate="1 kHz")
    >>> len(st.read_record(run.data.sel(time=slice(0.02, 0.04)), force="spring_x"))
    21
    """
    return _only_record(path, sidecar, dict(said))


def _only_record(
    path: str | Path | xr.Dataset | DataFrame,
    sidecar: str | Path | None,
    said: dict[str, Any],
    rig_load: float | None = None,
) -> Record:
    """Return the only record of a file, or the requested one of several."""
    strokes = _strokes(path, sidecar, said, rig_load)
    if len(strokes) > 1:
        raise ResultError(
            f"{_title(path)}: has {len(strokes)} strokes, which are as many records: say "
            f"{Suggestion('stroke', 1)} for one of them; {TOGETHER}"
        )
    return strokes[0]


def _strokes(
    path: str | Path | xr.Dataset | DataFrame,
    sidecar: str | Path | None,
    said: dict[str, Any],
    rig_load: float | None,
) -> list[Record]:
    """Return the record of a file that holds one block, or those of its strokes if all are asked.

    `rig_load` is as of `read_source`.
    """
    found = _measurements(path, sidecar, said, rig_load)
    if len(found) > 1:
        listed = "; ".join(_name(each) for each in found[:6]) + ("; ..." if len(found) > 6 else "")
        raise ResultError(
            f"{_title(path)}: holds {len(found)} blocks: {listed}. Say {Suggestion('block', 1)} "
            "for one of them; st.read_records(path) reads all"
        )
    return _records(_title(path), found[0])


@suggest(as_argument_elsewhere)
def read_parts(
    path: str | Path,
    *,
    trust: bool = False,
    rig_load: float | None = None,
    sidecar: str | Path | None = None,
    **said: Unpack[ReadArguments],
) -> dict[str, Trajectory | Record]:
    """Return the run or the record of a file, or all its strokes if they are asked for, by names.

    Raises
    ------
    ResultError
        As of `read_source`.
    """
    name = str(path)
    if is_run(Path(path)):
        return {name: read_source(path, trust=trust, sidecar=sidecar, **said)}
    strokes = _strokes(path, sidecar, dict(said), rig_load)
    if len(strokes) == 1:
        return {name: strokes[0]}
    return {f"{name}, stroke {number}": each for number, each in enumerate(strokes, 1)}


@suggest(as_argument)
def read_records(
    paths: str | Path | Iterable[str | Path],
    *,
    sidecar: str | Path | None = None,
    **said: Unpack[ReadArguments],
) -> tuple[Record, ...]:
    """Read all records of one or several files: blocks, a file each.

    Parameters
    ----------
    paths : str, Path or sequence of str or Path
        Files; of a folder all files in it, step 4 before step 10. Blocks stay in the order of
        their file.
    sidecar : str or Path, optional
        As of `read_record`, whose other arguments this takes too.

    Raises
    ------
    ResultError, DescriptionError
        As of `read_record`, the faults of all files at once; also if no file is given, or a folder
        holds none.

    Examples
    --------
    >>> import stiction as st
    >>> from pathlib import Path
    >>> _ = Path("strokes.csv").write_text("t [s],F [N]\\n0,1\\n1,2\\n2,3\\n0,4\\n1,5\\n2,6\\n")
    >>> [record.force.tolist() for record in st.read_records("strokes.csv")]
    [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]
    """
    found: list[Record] = []
    faults = Faults()
    for path in _all_files([paths] if isinstance(paths, str | Path) else paths):
        with faults.of_part():
            for each in _measurements(path, sidecar, dict(said)):
                found += _records(path, each)
    faults.refuse()
    return tuple(found)


def _all_files(paths: Iterable[str | Path]) -> list[Path]:
    """Return files, of a folder all files in it."""
    files = [Path(each) for each in paths]
    if not files:
        raise ResultError("no file is given; name one or several")
    return [each for file in files for each in (_files_of(file) if file.is_dir() else [file])]


@suggest(as_argument_elsewhere)
def read_sources(
    paths: Iterable[str | Path],
    *,
    trust: bool = False,
    sidecar: str | Path | None = None,
    **said: Unpack[ReadArguments],
) -> dict[str, Trajectory | Record]:
    """Return the runs and records of several files by their names; of blocks, each a record.

    Where two files of different folders have one name, the folders are named, too.

    Raises
    ------
    ResultError, DescriptionError
        As of `read_source` and `read_records`, the faults of all files at once.
    """
    found: dict[str, Trajectory | Record] = {}
    faults = Faults()
    listed = list(dict.fromkeys(_all_files(paths)))
    alone = len({path.name for path in listed}) == len(listed)
    for path in listed:
        name = path.name if alone else str(path)
        with faults.of_part():
            if is_run(path):
                found[name] = read_source(path, trust=trust, **said)
                continue
            blocks = read_records(path, sidecar=sidecar, **said)
            for number, record in enumerate(blocks, 1):
                part = "stroke" if said.get("stroke") == ALL else "block"
                found[f"{name}, {part} {number}" if len(blocks) > 1 else name] = record
    faults.refuse()
    return found


@suggest(as_argument_elsewhere)
def read_source(
    path: str | Path,
    *,
    trust: bool = False,
    sidecar: str | Path | None = None,
    rig_load: float | None = None,
    **said: Unpack[ReadArguments],
) -> Trajectory | Record:
    """Return the run or the record of a file, for a function that takes either.

    `rig_load` (N) is the normal load of the rig whose record it is, NaN if that is not certain; it
    turns coefficients of friction into forces if nothing else does.

    Raises
    ------
    ResultError
        As of `stiction.load` or `read_record`; also if something is said about the file of a run.
    """
    if not is_run(Path(path)):
        return _only_record(path, sidecar, dict(said), rig_load)
    given = [name for name, value in said.items() if value is not None]
    if given:
        raise ResultError(
            f"{path}: is the result of a run, in SI already: leave out {Suggestion(given[0])}"
        )
    return load(path, trust=trust)


def is_run(path: Path) -> bool:
    """Return whether a file is to be read as a run: it says so, or is called .nc and damaged."""
    if path.is_dir() or not path.is_file():
        return path.suffix in (".nc", ".zarr") or path.is_dir()
    names = root_attributes(path)
    if names is None:
        return path.suffix == ".nc"
    return "description" in names and bool({"stiction_version", "solver", "status"} & {*names})


def _files_of(folder: Path) -> Sequence[Path]:
    """Return the files of a folder in their natural order; TOML files describe the others."""
    if use := use_of(folder):
        raise ResultError(f"{folder}: holds no records; {use}")
    files = [x for x in folder.iterdir() if x.is_file() and not x.name.startswith(".")]
    some = [x for x in files if x.suffix != ".toml"]
    if not some:
        raise ResultError(f"{folder}: holds no files; name the file of a record")
    return sorted(some, key=lambda path: natural_key(path.name))


def _title(source: str | Path | xr.Dataset | DataFrame) -> str:
    """Return the name of a file or of a table in memory, for messages."""
    return type(source).__name__ if is_frame(source) else str(source)


def _measurements(
    path: str | Path | xr.Dataset | DataFrame,
    sidecar: str | Path | None,
    said: dict[str, Any],
    rig_load: float | None = None,
) -> list[Measurement]:
    """Return the measurements of one file; a stored record is one, whose numbers may be changed."""
    file, beside = Path(_title(path)), None if sidecar is None else Path(sidecar)
    if is_frame(path):
        return read_measurements(file, said, beside, rig_load, tables_of_frame(path))
    names = root_attributes(file) or ()
    refuse_kinds(file, names, [FIT_KIND])
    if RECORD_KIND not in names:
        return read_measurements(file, said, beside, rig_load)
    stored = read_stored(file)
    changed = {name: value for name, value in said.items() if value is not None}
    part = {x: changed.pop(x) for x in AskedPart._fields if x in changed}
    strange = [
        name for name in changed if name not in Record.model_fields or name in stored.channels
    ]
    strange += ["sidecar"] if sidecar is not None else []
    if strange:
        what = ", ".join(str(Suggestion(name)) for name in strange)
        raise ResultError(
            f"{path}: is a stored record, in SI already: leave out {what}, or read its source again"
        )
    return [stored._replace(known={**stored.known, **changed}, asked=ReadingOptions(**part).part)]


def _records(path: str | Path, found: Measurement) -> list[Record]:
    """Return the record of a measurement, or of a part of it; or of each of its strokes."""
    begin, end, stroke = found.asked
    if begin is not None or end is not None:
        found = part_between(path, found, begin, end)
    parts = [found]
    if stroke == ALL:
        parts = all_strokes(path, found)
    elif isinstance(stroke, int):
        parts = [stroke_of(path, found, stroke)]
    return [_record(path, each) for each in parts]


def _record(path: str | Path, found: Measurement) -> Record:
    """Return the record of a measurement, with faults that name the file."""
    known = {**found.known}
    if isinstance(turned := known.get("turned"), float):
        known["turned"] = Radians(turned)
    try:
        return Record(**found.channels, **known, sensors=found.sensors, origin=found.origin)
    except DescriptionError as error:
        faults = [
            Fault(f"{path}: {x.path.removeprefix('Record.')}", x.message) for x in error.faults
        ]
        raise DescriptionError(faults) from None


def _name(found: Measurement) -> str:
    """Return a block's number, label and size."""
    its = found.origin
    named = f" {its.label}" if its.label else ""
    begins = f" at {its.start}" if its.start else ""
    return f"{its.block}{named}{begins}, {its.samples} samples"
