"""A whole run in one place: slider, start, duration, tolerance; from TOML, to JSON and back."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Annotated, Any, NamedTuple, Self

from pydantic import Field, StrictBool, model_validator

from stiction.errors import DescriptionError, Fault
from stiction.friction import law_table, read_law
from stiction.friction.user.loading import Find, held, is_own, named
from stiction.machine import shortage
from stiction.system.initial import Initial
from stiction.system.slider import OPTIONAL_TABLES, SLIDER_TABLES, Slider
from stiction.system.writing import described, slider_tables
from stiction.text.toml import Reader, folder_of, gather, read_json, read_toml, toml_text
from stiction.text.units import Duration, Number, SampleRate, Velocity
from stiction.text.validation import Described, faulty

SAMPLE = 300.0  # bytes of memory that a sample takes, in all its columns and on the way there
Smoothing = Annotated[Velocity, Field(ge=1e-11)]  # below, each step is a boundary layer


class Settings(Described):
    """How long, how densely sampled and how exactly a run is computed.

    Parameters
    ----------
    duration : float or str
        s.
    sample_rate : float or str, optional
        Output samples per second, Hz; 0 for the first and last state only. When left out, a
        rate that suits the system, see `stiction.simulate`.
    rtol : float, optional
        Relative tolerance; see `stiction.simulate`.
    regularisation : float or str, optional
        delta of the regularised law s/sqrt(|s|^2 + delta^2), m/s, 1e-11 at least; exact when
        left out.
    multiscale : bool, optional
        Whether to take many cycles of stick and slip at once; see `stiction.simulate`.
    """

    duration: Duration
    sample_rate: SampleRate | None = None
    rtol: Number = Field(default=1e-6, ge=1e-13, le=1e-2)
    regularisation: Smoothing | None = None
    multiscale: StrictBool = False

    @model_validator(mode="after")
    def _can_be_kept(self) -> Self:
        samples = self.duration * (self.sample_rate or 0.0)
        if short := shortage(SAMPLE * samples):
            message = (
                f"duration times sample_rate is {samples:.3g} samples, which {short}; lower the "
                "rate, or restart from a sample of a coarse run and sample only a window finely"
            )
            raise faulty([Fault("sample_rate", message)])
        return self


class Description(NamedTuple):
    """Slider, initial state and settings of one run."""

    slider: Slider
    initial: Initial
    run: Settings

    @classmethod
    def from_toml(
        cls,
        path: str | Path,
        changes: Mapping[str, Any] | None = None,
        *,
        trust: bool = False,
    ) -> Self:
        """Read a description file, or a text of several lines as `to_toml` writes it.

        A friction law of the user's own is run from its file, after all else was found right.

        Parameters
        ----------
        path : str or Path
            The file.
        changes : mapping, optional
            Other values of some parameters, by their paths: ``{"drive.velocity": "2 mm/s"}``;
            see `stiction.text.paths`.
        trust : bool, optional
            Whether the file of a law may lie outside the description's folder (of a text: the
            working one).

        Raises
        ------
        DescriptionError
            Naming every fault with its path, or why the file cannot be read.
        """
        return cls.from_dict(read_toml(path, changes), find=named(folder_of(path), trust))

    @classmethod
    def from_dict(
        cls, raw: Mapping[str, Any], *, find: Find | None = None, known: Sequence[Fault] = ()
    ) -> Self:
        """Read a description from nested tables, as in the TOML file.

        `find` says where the file of a law of the user's own is looked for, see
        `stiction.friction.user.loading`; in the working folder when left out. It is not run where
        there are other faults, the `known` ones among them, which are told with those found.
        """
        tables: dict[str, Reader] = {**TABLES, "friction": partial(read_law, find=find)}
        last = ("friction",) if is_own(raw.get("friction")) else ()
        absent = OPTIONAL_TABLES
        parts = gather(raw, tables, optional=("initial",), absent=absent, last=last, known=known)
        return cls(Slider.from_parts(parts), parts["initial"], parts["run"])

    @classmethod
    def from_json(cls, text: str, *, trust: bool = False) -> Self:
        """Read back what `to_json` wrote.

        A law of the user's own is one that this process has loaded already, from the same text;
        with `trust`, the text that the JSON holds is run otherwise.
        """
        return cls.from_dict(read_json(text), find=held(trust))

    def to_toml(self) -> str:
        """Return the description as TOML, with units; `from_toml` reads the same again."""
        tables = {
            **slider_tables(self.slider),
            "initial": described(self.initial, type(self.initial).model_fields),
            "run": described(self.run, type(self.run).model_fields),
        }
        return toml_text({name: table for name, table in tables.items() if table})

    def to_dict(self) -> dict[str, dict[str, Any]]:
        """Return nested tables of SI numbers, as `from_dict` reads them."""
        return {
            "slider": self.slider.model_dump(mode="json", exclude={"friction", "drive", "load"}),
            "friction": law_table(self.slider.law),
            "drive": table(self.slider.motion),
            **({} if self.slider.load is None else {"load": table(self.slider.load)}),
            "initial": self.initial.model_dump(exclude_unset=True),
            "run": self.run.model_dump(exclude_none=True),
        }

    def to_json(self) -> str:
        """Return the description as one JSON string."""
        return json.dumps(self.to_dict())


def description_of(source: Description | str | Path) -> Description:
    """Return a description, or that in a file.

    Raises
    ------
    DescriptionError
        If it is neither.
    """
    if isinstance(source, Slider):
        remedy = "make it one: st.Description(slider, st.Initial(), st.Settings(duration='5 s'))"
        raise DescriptionError([Fault("description", f"a Slider has no duration; {remedy}")])
    return source if isinstance(source, Description) else Description.from_toml(source)


def table(value: Any) -> dict[str, Any]:
    """Return a drive or a load as a table that can be read back."""
    made: dict[str, Any] = value.to_table() if hasattr(value, "to_table") else value._asdict()
    return made


TABLES: dict[str, Reader] = {
    **SLIDER_TABLES,
    "initial": lambda table: Initial(**table),
    "run": lambda table: Settings(**table),
}
