"""Options that several commands share: output, trust, and changed parameters."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

from cyclopts import Parameter

from stiction.errors import DescriptionError, Faults, ResultError, StictionError, echo

if TYPE_CHECKING:
    from stiction.analysis.record import Record
    from stiction.inference.rig import Rig
    from stiction.presets import Preset
    from stiction.system.description import Description
    from stiction.system.slider import Slider
    from stiction.trajectory import Trajectory


class CommandError(StictionError):
    """Arguments that a command cannot take together, or lacks."""


Output = Annotated[Path, Parameter(name=("--output", "-o"))]
MaybeOutput = Annotated[Path | None, Parameter(name=("--output", "-o"))]
Trust = Annotated[
    bool,
    Parameter(
        negative=(),
        help=(
            "Trust the friction law that a user wrote, and run its text: that in a result or a "
            "store, or a file outside the folder of the description."
        ),
    ),
]
Changes = Annotated[
    list[str] | None,
    Parameter(
        name="--set",
        negative=(),
        help=(
            "Change a parameter of the description, NAME=VALUE: --set friction.mu_0=0.3, --set "
            'duration=10s, --set "V = 2 mm/s"; repeat it for more. Example: --set phi=3deg.'
        ),
    ),
]
Simulations = Annotated[
    int,
    Parameter(
        name=("--simulations", "-n"),
        help=(
            "Number of simulated records to learn from, at least 300: more give narrower "
            "intervals, and take longer. Example: -n 8000."
        ),
    ),
]
MaybeSimulations = Annotated[
    int | None,
    Parameter(
        name=("--simulations", "-n"),
        help=(
            "With --record, number of simulated records to learn from, by default 4000: more give "
            "narrower intervals, and take longer. Example: -n 8000."
        ),
    ),
]
MaybeSeed = Annotated[
    int | None,
    Parameter(
        help=(
            "With --record, number that selects the random draws of the simulations, by default "
            "0: the same seed gives the same result. Example: --seed 1."
        ),
    ),
]
Seed = Annotated[
    int,
    Parameter(
        help=(
            "Number that selects the random draws of the simulations: the same seed gives the "
            "same result. Example: --seed 1."
        ),
    ),
]
Library = Annotated[
    Path | None,
    Parameter(
        help=(
            "Folder for the simulated records, by default in the user's cache, if that can be "
            "written to. An interrupted command continues there, and another record under the same "
            "conditions needs no new simulations. Example: --library simulations."
        ),
    ),
]


@Parameter(name="*", group="How a record is read")
@dataclass(frozen=True, kw_only=True)
class RecordOptions:
    """The user's statements about the file of a measured record.

    Parameters
    ----------
    time
        How the file gives the time: the name or number of its column, its unit, or both joined by
        "=": --time ms, --time 1=ms for the first column. Example: --time "Zeit=ms".
    force
        How the file gives the force along the drive, in the same way. A factor scales it: "CH1=2.5
        N/V" turns volts into newtons, "Fx=-1 N" turns the sign. Example: --force Fx=mN.
    force_across
        How the file gives the force across the drive, as for --force. Example: --force-across
        Fy=mN.
    load
        How the file gives a normal load that varies over time, as for --force. Example: --load
        Fz=N. For a constant load, use --normal-load.
    position
        How the file gives the displacement of the mass, as for --force. Example: --position
        "laser=um".
    drive_position
        How the file gives the displacement of the drive, as for --force. Example:
        --drive-position "stage=mm".
    slip_speed
        How the file gives the slip speed, as for --force. Example: --slip-speed "v=mm/s".
    normal_load
        Constant normal load W that presses the mass onto the plate. Example: --normal-load "10 N".
    stiffness
        Stiffness k of the spring along the drive, which turns force into elongation. Example:
        --stiffness "168 N/m".
    stiffness_across
        Stiffness of the spring across the drive. Example: --stiffness-across "60 kN/m".
    drive_velocity
        Constant velocity V of the drive. Example: --drive-velocity "42 um/s".
    mass
        Sliding mass m. Example: --mass "250 g".
    zero
        Reading of the load cell without load, which is subtracted from the force, with its
        standard uncertainty if that is known. Example: --zero "3 +- 1 mN".
    turned
        Angle by which the rig was turned on purpose for this record; a fit adds it to the
        misalignment of the rig's description. Example: --turned "2 deg". Of one record alone.
    interval
        Time between two samples, for a file without a column of times. Example: --interval "1 ms".
    times
        What the column of times holds: the time of each sample (clock), or the time since the
        sample before (intervals). By default it is guessed. Example: --times intervals.
    decimal
        Decimal sign of a text file: 1.5 (point) or 1,5 (comma). By default it is guessed. Example:
        --decimal comma.
    separator
        Sign between the columns of a text file. By default it is guessed. Example: --separator
        semicolon.
    wrap
        Length after which a displacement starts again at its beginning, as that of a rotary
        encoder does; "none" leaves it as it is. By default it is guessed. Example: --wrap "10 mm".
    block
        Number of the block to read, from 1, where a file has several: a block begins where the
        times of the file begin again. Example: --block 2.
    stroke
        Number of the stroke to read, from 1, where the drive goes to and fro and the record has its
        displacement. On a way back, forces and displacements are turned round. With all, `stiction
        analyse` gives a row for each. Example: --stroke 2.
    begin
        Time at which the part to read begins, in the times of the file: after running in, say.
        Example: --begin "20 s".
    end
        Time at which it ends. Example: --end "3 min".
    sidecar
        TOML file that says all this, so that it need not be repeated. By default it is the file
        beside the record, data.toml for data.csv. Example: --sidecar rig/sensors.toml.
    """

    time: str | None = None
    force: str | None = None
    force_across: str | None = None
    load: str | None = None
    position: str | None = None
    drive_position: str | None = None
    slip_speed: str | None = None
    normal_load: str | None = None
    stiffness: str | None = None
    stiffness_across: str | None = None
    drive_velocity: str | None = None
    mass: str | None = None
    zero: str | None = None
    turned: str | None = None
    interval: str | None = None
    times: Literal["clock", "intervals"] | None = None
    decimal: Literal["point", "comma"] | None = None
    separator: Literal["tab", "comma", "semicolon", "space", "bar"] | None = None
    wrap: str | None = None
    block: int | None = None
    stroke: int | Literal["all"] | None = None
    begin: str | None = None
    end: str | None = None
    sidecar: Path | None = None

    def arguments(self) -> dict[str, Any]:
        """Return the given options by name."""
        return {name: value for name, value in vars(self).items() if value is not None}


def trust_in(slider: Slider) -> str:
    """Return the option that later commands need where the law of a slider is a user's, or ''."""
    from stiction.friction import law_table
    from stiction.friction.user.loading import is_own

    return " --trust" if is_own(law_table(slider.law)) else ""


def library_or_cache(library: Path | None) -> Path:
    """Return the folder of libraries: the named one, or else the one in the user's cache.

    Where nothing can be written to the latter, say once that nothing is stored.
    """
    from stiction.cli.terminal import note
    from stiction.storage.arrays import cache_folder
    from stiction.storage.files import prepare_folder

    if library is not None:
        return library
    folder = cache_folder()
    try:
        prepare_folder(folder)
    except ResultError as error:
        note(f"Simulations are not stored: {error}. --library FOLDER stores them elsewhere.")
    return folder


def record_in(
    path: Path, measured: RecordOptions | None, trust: bool, rig_load: float | None = None
) -> Record:
    """Read a measured record, or a run as if it was measured; see `read_source` for `rig_load`."""
    from stiction.analysis.measurement.run_record import as_record

    return as_record(source_in(path, measured, trust, rig_load))


def records_in(
    path: Path, measured: RecordOptions | None, trust: bool, rig_load: float | None = None
) -> dict[str, Record]:
    """Do as `record_in`, for each stroke of a record if all are asked for; by their names."""
    from stiction.analysis.measurement.reading import read_parts
    from stiction.analysis.measurement.run_record import as_record
    from stiction.progress.display import show_progress

    said = (measured or RecordOptions()).arguments()
    with show_progress("reading"):
        found = read_parts(path, trust=trust, rig_load=rig_load, **said)
    return {name: as_record(each) for name, each in found.items()}


def source_in(
    path: Path, measured: RecordOptions | None, trust: bool, rig_load: float | None = None
) -> Trajectory | Record:
    """Read a run, or a measured record; a bar is shown while that takes long."""
    from stiction.analysis.measurement.reading import read_source
    from stiction.progress.display import show_progress

    said = (measured or RecordOptions()).arguments()
    with show_progress("reading"):
        return read_source(path, trust=trust, rig_load=rig_load, **said)


def record_or_none(
    path: Path | None,
    measured: RecordOptions | None,
    trust: bool,
    give: str = "give --record",
    rig: Rig | None = None,
    **others: Any,
) -> Record | None:
    """Do as `record_in`, if there is a record; refuse options of one where there is none.

    `give` is how the command takes a record; `others` are further options that need one, None where
    they are not given.
    """
    if path is not None:
        from stiction.inference.rig import load_of_records

        return record_in(path, measured, trust, None if rig is None else load_of_records(rig))
    further = {name: value for name, value in others.items() if value is not None}
    if said := (measured or RecordOptions()).arguments() | further:
        named = ", ".join(f"--{name.replace('_', '-')}" for name in said)
        raise CommandError(f"{named}: there is no record to which this could apply; {give}")
    return None


Window = Annotated[tuple[str, str] | None, Parameter(negative=())]
FromPreset = Annotated[
    str | None,
    Parameter(
        name="--preset",
        help=(
            "A published system in place of a file; `stiction presets` lists them. Example: "
            "--preset leine-belt."
        ),
    ),
]


def description_from(
    config: Path | None, preset: str | None, given: dict[str, Any], trust: bool
) -> Description:
    """Return the description of a file or a preset, with changed parameters."""
    from stiction.system.description import Description
    from stiction.text.paths import with_changes

    found = choose(config, preset)
    if found is None:
        return Description.from_toml(Path(str(config)), given, trust=trust)
    made = found.make()
    if not given:
        return made
    raw, strange = with_changes(made.to_dict(), given)
    return Description.from_dict(raw, known=strange)


def slider_from(
    config: Path | None, preset: str | None, given: dict[str, Any], trust: bool
) -> Slider:
    """Do as `description_from` for a slider alone: a file's [run] is not read."""
    from stiction.system.slider import Slider

    if choose(config, preset) is None:
        return Slider.from_toml(Path(str(config)), given, trust=trust)
    return rig_from(config, preset, given, trust).slider


def rig_from(config: Path | None, preset: str | None, given: dict[str, Any], trust: bool) -> Rig:
    """Do as `slider_from` for a rig: values may be uncertain."""
    from stiction.inference.rig import Rig, rig_of

    found = choose(config, preset)
    if found is None:
        return Rig.from_toml(Path(str(config)), given, trust=trust)
    slider = found.make().slider
    return Rig.from_toml(slider.to_toml(), given) if given else rig_of(slider)


def choose(config: Path | None, preset: str | None) -> Preset | None:
    """Return the requested preset, None for a file; one of both must be given."""
    if (config is None) == (preset is None):
        raise CommandError(
            "give either the file of a description or --preset NAME; "
            "`stiction init my.toml` writes one, `stiction presets` lists the others"
        )
    if preset is None:
        return None
    from stiction.presets import find

    return find(preset)


def parse_assignment(text: str, option: str) -> tuple[str, str]:
    """Return name and value of an option's ``NAME=VALUE``."""
    name, equals, value = text.partition("=")
    if not equals or not name.strip():
        message = f"{option} {echo(text)} is not NAME=VALUE; write for example 'phi = 1 deg'"
        raise DescriptionError.of("", message)
    return name.strip(), value.strip()


def parse_assignments(given: list[str] | None, option: str, faults: Faults) -> dict[str, str]:
    """Return names and values of an option that may be repeated; note the wrong ones."""
    found: dict[str, str] = {}
    for text in given or ():
        with faults.of_part():
            found.update([parse_assignment(text, option)])
    return found


def changes(given: list[str] | None, faults: Faults) -> dict[str, Any]:
    """Return the values of ``--set``: numbers, truth values and lists as in TOML."""
    pairs = parse_assignments(given, "--set", faults)
    return {name: value(text) for name, text in pairs.items()}


def value(text: str) -> Any:
    """Return a TOML value, or the text itself, such as a number with its unit."""
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except (ValueError, RecursionError):
        return text
