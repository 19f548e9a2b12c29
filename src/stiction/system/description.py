"""Description of a whole run: slider, initial state, settings; to TOML and JSON and back."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from functools import partial
from numbers import Real
from pathlib import Path
from typing import Annotated, Any, Literal, NamedTuple, Self

from pydantic import BeforeValidator, Field, ValidationInfo, field_validator

from stiction.drive import read_drive, read_load
from stiction.drive.procedures import end
from stiction.drive.program import refuse_idle_base
from stiction.drive.recorded.reading import Locate, locate_nothing, locator, with_rows
from stiction.errors import DescriptionError, Fault, Faults, echo
from stiction.friction import law_table, read_law
from stiction.friction.user.loading import Find, finder_for_descriptions, finder_for_results, is_own
from stiction.machine import shortage
from stiction.names import picture
from stiction.system.initial import Initial
from stiction.system.slider import OPTIONAL_TABLES, SLIDER_TABLES, Slider
from stiction.system.writing import describe, parameter_table, slider_tables
from stiction.text.paths import canonical
from stiction.text.sections import Section, as_html
from stiction.text.toml import Reader, folder_of, gather, read_changed, read_json, toml_text
from stiction.text.units import Duration, Number, Quantity, SampleRate, Velocity
from stiction.text.validation import Described, read_arguments, validate

STAND_IN = 1.0  # s, for a duration that is not known beside other faults
SAMPLE = 300.0  # bytes of memory per sample, for all columns and intermediate arrays
Smoothing = Annotated[Velocity, Field(ge=1e-11)]  # below, steps resolve a thin layer


def _is_choice(choice: object) -> object:
    if isinstance(choice, Real) and not isinstance(choice, bool):  # 1 equals True
        raise ValueError(f"must be 'auto', True or False, is {echo(choice)}")
    return choice


Multiscale = Annotated[Literal["auto", True, False], BeforeValidator(_is_choice)]


class Settings(Described):
    """Duration, sample rate, tolerance and method of a run.

    Parameters
    ----------
    duration : float or str
        How long the run lasts, s; in a description's [run] by default until the programs of drive
        and load end.
    sample_rate : float or str, optional
        Output samples per second, Hz; 0 for the first and last state only. By default a rate
        that suits the system, see `stiction.simulate`.
    rtol : float, optional
        Relative tolerance; see `stiction.simulate`.
    regularisation : float or str, optional
        delta of the regularised law ``s/sqrt(|s|^2 + delta^2)``, m/s, at least 1e-11; by default
        the law is set-valued.
    smoothing : {"root", "arctan"}, optional
        The shape of the regularised law: ``F s/sqrt(|s|^2 + delta^2)``, or, for comparison with
        other programs, ``F (2/pi) atan(|s|/delta)``.
    multiscale : {"auto", True, False}, optional
        Whether to interpolate between cycles of stick and slip; see `stiction.simulate`.

    Examples
    --------
    >>> import stiction as st
    >>> st.Settings(duration="5 s", sample_rate="10 kHz").sample_rate
    10000.0
    """

    duration: Duration
    sample_rate: SampleRate | None = None
    rtol: Number = Field(default=1e-6, ge=1e-13, le=1e-2)
    regularisation: Smoothing | None = None
    smoothing: Literal["root", "arctan"] = "root"
    multiscale: Multiscale = "auto"

    # validators of fields, not of the model: those wait until every field is valid
    @field_validator("smoothing")
    @classmethod
    def _has_a_width(cls, smoothing: str, info: ValidationInfo) -> str:
        if smoothing != "root" and info.data.get("regularisation", 0.0) is None:
            raise ValueError(f"{echo(smoothing)} needs a width; give regularisation too")
        return smoothing

    @field_validator("sample_rate")
    @classmethod
    def _can_be_kept(cls, rate: float | None, info: ValidationInfo) -> float | None:
        samples = info.data.get("duration", 0.0) * (rate or 0.0)
        if short := shortage(SAMPLE * samples):
            raise ValueError(
                f"duration times sample_rate is {samples:.3g} samples, which {short}; lower the "
                "rate, or start again within a coarse run, initial=run.state(time), and sample "
                "only a window finely"
            )
        return rate


@validate
class Description(NamedTuple):
    """Slider, initial state and settings of one run.

    Examples
    --------
    >>> import stiction as st
    >>> slider = st.presets.nakano_popov_2020()
    >>> description = st.Description(slider, st.Initial(u_x="1 mm"), st.Settings(duration="20 ms"))
    >>> st.run(description).status.ok
    True
    """

    slider: Slider
    initial: Initial
    run: Settings

    @classmethod
    def of(
        cls,
        slider: Slider,
        duration: Quantity | None = None,
        *,
        initial: Initial | None = None,
        **settings: Any,
    ) -> Self:
        """Return the description of a run, as `stiction.simulate` takes it.

        Parameters
        ----------
        slider : Slider
            The system.
        duration : float or str, optional
            How long the run lasts, s; until the programs of drive and load end, if they do.
        initial : Initial, optional
            The state to start from; by default the paper's.
        **settings
            Further ones of `Settings`: sample_rate, rtol, multiscale, regularisation, smoothing.

        Raises
        ------
        DescriptionError
            With every fault at once.

        Examples
        --------
        >>> import stiction as st
        >>> st.Description.of(st.presets.nakano_popov_2020(), "20 ms", rtol=1e-4).run.rtol
        0.0001
        """
        faults = Faults()
        with faults.of_part():
            refuse_strangers(slider, initial)
        start = initial or Initial()
        with faults.of_part():
            if duration is None and not faults.found:
                duration = time_to_end(slider, start)
        if faults.found and duration is None:
            duration = STAND_IN
        with faults.of_part():
            read = read_arguments(Settings, duration=duration, **settings)
        faults.refuse()
        return cls(slider, start, read)

    def replace(self, **changes: Any) -> Self:
        """Return the same with another slider, initial state or settings, by their names."""
        return type(self)(**{**self._asdict(), **changes})

    def _repr_html_(self) -> str:
        table = as_html([Section("Description", [], parameter_table(self._tables()))])
        return table + picture("plot_slider", self.slider)

    @classmethod
    def from_toml(
        cls,
        path: str | Path,
        changes: Mapping[str, Any] | None = None,
        *,
        trust: bool = False,
    ) -> Self:
        """Read a description file, or a text of several lines as `to_toml` writes it.

        The file of a user's friction law is run only if everything else is valid.

        Parameters
        ----------
        path : str or Path
            The file.
        changes : mapping, optional
            Other values of some parameters, by their paths: ``{"drive.velocity": "2 mm/s"}``;
            see `stiction.text.paths`.
        trust : bool, optional
            Whether the files of a law and of recorded tables may lie outside the description's
            folder (for a text: the working folder).

        Raises
        ------
        DescriptionError
            With every fault and its path, or the reason why the file cannot be read.
        """
        folder = folder_of(path)
        find, locate = finder_for_descriptions(folder, trust), locator(folder, trust)
        raw, strange = read_changed(path, changes)
        read = cls.from_dict(raw, find=find, locate=locate, known=strange)
        refuse_idle_base(read.slider.drive, map(canonical, changes or {}))
        return read

    @classmethod
    def from_dict(
        cls,
        raw: Mapping[str, Any],
        *,
        find: Find | None = None,
        locate: Locate | None = None,
        known: Sequence[Fault] = (),
    ) -> Self:
        """Read a description from nested tables, as in the TOML file.

        `find` locates the file of a user's law, see `stiction.friction.user.loading`, and `locate`
        that of a recorded table, see `stiction.drive.recorded.reading`; by default in the working
        folder. The law's file is not run if there are other faults, including the `known` ones,
        which are reported with the rest.
        """
        tables: dict[str, Reader] = {**TABLES, "friction": partial(read_law, find=find)}
        last = ("friction",) if is_own(raw.get("friction")) else ()
        absent = OPTIONAL_TABLES
        raw, lost = with_rows(raw, locate or locator(Path()))
        raw, known = with_duration(raw), [*known, *lost]
        parts = gather(raw, tables, optional=("initial",), absent=absent, last=last, known=known)
        return cls(Slider.from_parts(parts), parts["initial"], parts["run"])

    @classmethod
    def from_json(cls, text: str, *, trust: bool = False) -> Self:
        """Read a description that `to_json` wrote.

        A user's law must have been loaded by this process from the same text; otherwise `trust`
        permits running the text in the JSON.
        """
        return cls.from_dict(read_json(text), find=finder_for_results(trust), locate=locate_nothing)

    def to_toml(self) -> str:
        """Return the description as TOML with units, which `from_toml` reads back."""
        return toml_text(self._tables())

    def _tables(self) -> dict[str, dict[str, Any]]:
        """Return the tables of a description in which something is not the default."""
        tables = {
            **slider_tables(self.slider),
            "initial": describe(self.initial, type(self.initial).model_fields),
            "run": describe(self.run, type(self.run).model_fields),
        }
        return {name: table for name, table in tables.items() if table}

    def to_dict(self) -> dict[str, dict[str, Any]]:
        """Return nested tables of SI numbers, which `from_dict` reads."""
        return {
            "slider": mechanical_table(self.slider),
            "friction": law_table(self.slider.law),
            "drive": table(self.slider.drive),
            **({} if self.slider.load is None else {"load": table(self.slider.load)}),
            "initial": self.initial.model_dump(exclude_unset=True),
            "run": self.run.model_dump(exclude_none=True),
        }

    def to_json(self) -> str:
        """Return the description as one JSON string."""
        return json.dumps(self.to_dict())


def refuse_strangers(slider: object, initial: object) -> None:
    """Refuse an argument that is not a slider, and one that is not an initial state."""
    found = []
    if not isinstance(slider, Slider):
        remedy = "make one with st.Slider(...) or read one with st.Slider.from_toml(path)"
        if isinstance(slider, Description):
            remedy = "st.run(description) simulates a whole description, duration and all"
        found.append(Fault("slider", f"{echo(slider)} is not a Slider; {remedy}"))
    if not isinstance(initial, Initial | None):
        remedy = "write for example st.Initial(u_x='1 mm')"
        found.append(Fault("initial", f"{echo(initial)} is not an Initial; {remedy}"))
    if found:
        raise DescriptionError(found)


def time_to_end(slider: Slider, initial: Initial) -> float:
    """Return how long the programs of drive and load go on from the start of a run, s."""
    until = end(slider.motion, slider.load)
    if until is None:
        message = (
            "missing; write for example '5 s'; only a program of drive or load whose last piece "
            "ends has one by itself"
        )
        raise DescriptionError.of("duration", message)
    if not until > initial.time:
        message = f"missing; the programs end at {until:g} s, where the run starts"
        raise DescriptionError.of("duration", message)
    return until - initial.time


def mechanical_table(slider: Slider) -> dict[str, Any]:
    """Return the table [slider] of a description, with SI numbers."""
    names = {*slider.own_fields()} - {
        "friction",
        "drive",
        "load",
        *(() if slider.springs else ("springs",)),
    }
    table: dict[str, Any] = slider.model_dump(mode="json", include=names)
    return table


def with_duration(raw: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return the tables of a description with a duration in [run], if its programs have an end."""
    settings, drive, load = (raw.get(name, {}) for name in ("run", "drive", "load"))
    tables = (settings, drive, load)
    if not all(isinstance(each, Mapping) for each in tables) or "duration" in settings:
        return raw
    try:
        programs = [read(dict(table)) for read, table in ((read_drive, drive), (read_load, load))]
        start = Initial(**raw.get("initial", {})).time
    except (DescriptionError, TypeError):  # which is told when the rest is read
        # then how long a program lasts is unknown, not missing
        unknown = {"duration": 1.0} if "program" in {*drive, *load} else {}
        return {**raw, "run": {**settings, **unknown}}
    until = end(*programs)
    if until is None or not until > start:
        return raw
    return {**raw, "run": {**settings, "duration": until - start}}


def description_of(
    source: Slider | Description | str | Path, duration: Quantity | None = None
) -> Description:
    """Return a description: the given one, that of a file, or that of a slider with a duration.

    A `duration` takes the place of that of a description.

    Raises
    ------
    DescriptionError
        If it is none of these, or a slider without a duration.
    """
    if isinstance(source, Slider):
        if duration is None:
            remedy = "st.simulate and st.compare take duration='5 s'; or make it a description:"
            message = f"a Slider has no duration; {remedy} st.Description.of(slider, '5 s')"
            raise DescriptionError.of("description", message)
        return Description.of(source, duration)
    found = source if isinstance(source, Description) else Description.from_toml(source)
    if duration is None:
        return found
    read = read_arguments(Settings, duration=duration)
    return found._replace(run=found.run.model_copy(update={"duration": read.duration}))


def system_and_start(source: Any, initial: Initial | None) -> tuple[Any, Initial | None]:
    """Return a slider and its initial state, also from a description or its file.

    Anything else is returned as it is: who reads it refuses it. An `initial` that is given counts.
    """
    if isinstance(source, str | Path):
        source = Description.from_toml(source)
    if not isinstance(source, Description):
        return source, initial
    return source.slider, source.initial if initial is None else initial


def table(value: Any) -> dict[str, Any]:
    """Return a drive or a load as a table of a description."""
    made: dict[str, Any] = value.to_table() if hasattr(value, "to_table") else value._asdict()
    return made


TABLES: dict[str, Reader] = {
    **SLIDER_TABLES,
    "initial": lambda table: Initial(**table),
    "run": lambda table: Settings(**table),
}
