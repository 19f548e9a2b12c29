"""Options that several commands share: output, trust, and changed parameters."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

from cyclopts import Parameter

from stiction.errors import StictionError

if TYPE_CHECKING:
    from stiction.inference.priors import Rig
    from stiction.presets import Preset
    from stiction.system.description import Description
    from stiction.system.slider import Slider

Output = Annotated[Path, Parameter(name=("--output", "-o"))]
MaybeOutput = Annotated[Path | None, Parameter(name=("--output", "-o"))]
Trust = Annotated[
    bool,
    Parameter(
        negative=(),
        help=(
            "Trust and run a user's friction law: the text in a result or a store, or a file "
            "outside the folder of CONFIG."
        ),
    ),
]
Changes = Annotated[
    list[str] | None,
    Parameter(
        name="--set",
        negative=(),
        help=(
            "Change a parameter of CONFIG, NAME=VALUE: --set phi=3deg "
            '--set "V = 2 mm/s" --set friction.mu_0=0.3 --set duration=10s; repeat it for more.'
        ),
    ),
]
Simulations = Annotated[
    int,
    Parameter(
        name=("--simulations", "-n"),
        help="Simulated records in the library; more sharpen the posterior, and take longer.",
    ),
]
Library = Annotated[
    Path | None,
    Parameter(
        help=(
            "A folder for libraries; by default in the user's cache. What was interrupted "
            "continues there, and another record under the same conditions needs no new "
            "simulations."
        ),
    ),
]


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class Measured:
    """What the user says about the file of a measured record.

    Parameters
    ----------
    time
        Its column, its unit, or both: ms, "Zeit=ms", 1=ms.
    force
        Of the force along the drive, likewise: mN, Fx=mN, "CH1=2.5 N/V", "-1 N" to turn its sign.
    force_across
        Of the force across the drive.
    load
        Of the normal load over time.
    position
        Of the displacement of the mass.
    drive_position
        Of the displacement of the drive.
    slip_speed
        Of the slip speed.
    normal_load
        W, as a number and a unit: "10 N".
    stiffness
        Of the spring along the drive.
    stiffness_across
        Of the spring across it.
    drive_velocity
        V.
    mass
        m.
    zero
        Reading of the load cell without load; it is subtracted.
    interval
        Between two samples, for a file without times.
    times
        Whether the column of times holds the interval before each sample.
    decimal
        Decimal sign of a text file.
    separator
        Between the columns of a text file.
    wrap
        Length after which a displacement starts again, or none.
    block
        Which of several blocks or strokes, from 1.
    sidecar
        TOML file with all this, in place of data.toml beside data.csv.
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
    interval: str | None = None
    times: Literal["clock", "intervals"] | None = None
    decimal: Literal["point", "comma"] | None = None
    separator: Literal["tab", "comma", "semicolon", "space", "bar"] | None = None
    wrap: str | None = None
    block: int | None = None
    sidecar: Path | None = None

    def arguments(self) -> dict[str, Any]:
        """Return what is given, by name."""
        return {name: value for name, value in vars(self).items() if value is not None}


FromPreset = Annotated[
    str | None,
    Parameter(
        name="--preset",
        help="A published system in place of CONFIG; `stiction presets` lists them.",
    ),
]


def description_from(
    config: Path | None, preset: str | None, given: dict[str, Any], trust: bool
) -> Description:
    """Return the description in a file, or that of a preset, with changed parameters."""
    from stiction.system.description import Description
    from stiction.text.paths import with_changes

    found = choose(config, preset)
    if found is None:
        return Description.from_toml(Path(str(config)), given, trust=trust)
    made = found.make()
    return Description.from_dict(with_changes(made.to_dict(), given)) if given else made


def slider_from(
    config: Path | None, preset: str | None, given: dict[str, Any], trust: bool
) -> Slider:
    """Do as `description_from` for a slider alone: a file's [run] is not read."""
    from stiction.system.slider import Slider

    if choose(config, preset) is None:
        return Slider.from_toml(Path(str(config)), given, trust=trust)
    return description_from(config, preset, given, trust).slider


def rig_from(config: Path | None, preset: str | None, given: dict[str, Any], trust: bool) -> Rig:
    """Do as `slider_from` for a rig: values may be uncertain."""
    from stiction.inference.priors import Rig, rig_of

    found = choose(config, preset)
    if found is None:
        return Rig.from_toml(Path(str(config)), given, trust=trust)
    slider = found.make().slider
    return Rig.from_toml(slider.to_toml(), given) if given else rig_of(slider)


def choose(config: Path | None, preset: str | None) -> Preset | None:
    """Return the requested preset, None for a file; one of both must be given."""
    from stiction.presets import find

    if (config is None) == (preset is None):
        raise StictionError(
            "give either the file of a description or --preset NAME; "
            "`stiction init my.toml` writes one, `stiction presets` lists the others"
        )
    return None if preset is None else find(preset)


def parse_assignment(text: str, option: str) -> tuple[str, str]:
    """Return name and value of an option's ``NAME=VALUE``."""
    name, equals, value = text.partition("=")
    if not equals or not name.strip():
        raise StictionError(f"{option} {text!r} is not NAME=VALUE; write for example 'phi = 1 deg'")
    return name.strip(), value.strip()


def changes(given: list[str] | None) -> dict[str, Any]:
    """Return the values of ``--set``: numbers, truth values and lists as in TOML."""
    pairs = (parse_assignment(text, "--set") for text in given or ())
    return {name: value(text) for name, text in pairs}


def value(text: str) -> Any:
    """Return a TOML value, or the text itself, such as a number with its unit."""
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except (ValueError, RecursionError):
        return text
