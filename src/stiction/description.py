"""A whole run in one place: slider, start, duration, tolerance; from TOML, to JSON and back."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NamedTuple, Self

from pydantic import Field

from stiction.drive import ConstantVelocity
from stiction.errors import DescriptionError, Fault
from stiction.friction import LAWS
from stiction.initial import Initial
from stiction.slider import Apparatus, Slider
from stiction.units import Duration, Number, PositiveSpeed, Rate
from stiction.validation import Described, fields, unknown


class Settings(Described):
    """How long, how densely sampled and how exactly a run is computed.

    Parameters
    ----------
    duration : float or str
        s.
    sample_rate : float or str, optional
        Output samples per second; only the first and last state when left out.
    rtol : float, optional
        Relative tolerance; see `stiction.simulate`.
    regularisation : float or str, optional
        delta of the regularised law s/sqrt(|s|^2 + delta^2), m/s; exact when left out.
    """

    duration: Duration
    sample_rate: Rate | None = None
    rtol: Number = Field(default=1e-6, ge=1e-13, le=1e-2)
    regularisation: PositiveSpeed | None = None


class Description(NamedTuple):
    """Slider, initial state and settings of one run."""

    slider: Slider
    initial: Initial
    run: Settings

    @classmethod
    def from_toml(cls, path: str | Path) -> Self:
        """Read a description file.

        Raises
        ------
        DescriptionError
            Naming every fault with its path, or why the file cannot be read.
        """
        try:
            raw = tomllib.loads(Path(path).read_text(encoding="utf-8"))
        except OSError as error:
            raise DescriptionError([Fault(str(path), error.strerror or "cannot be read")]) from None
        except UnicodeDecodeError:
            message = "is not text in UTF-8; write a description with 'stiction init'"
            raise DescriptionError([Fault(str(path), message)]) from None
        except tomllib.TOMLDecodeError as error:
            message = f"is not TOML: {error}; a value with a unit goes in quotes"
            raise DescriptionError([Fault(str(path), message)]) from None
        return cls.from_dict(raw)

    @classmethod
    def from_dict(cls, raw: Mapping[str, Any]) -> Self:
        """Read a description from nested tables, as in the TOML file."""
        found: list[Fault] = [
            Fault(name, unknown("table", name, READERS)) for name in raw if name not in READERS
        ]
        parts: dict[str, Any] = {}
        for name, read in READERS.items():
            table = raw.get(name, {} if name == "initial" else None)
            if table is None:
                found.append(Fault(name, f"missing; write a table [{name}]"))
            elif not isinstance(table, Mapping):
                found.append(Fault(name, f"must be a table [{name}], is {table!r}"))
            else:
                try:
                    parts[name] = read(dict(table))
                except DescriptionError as error:
                    found += [
                        Fault(".".join([name, *fault.path.split(".")[1:]]), fault.message)
                        for fault in error.faults
                    ]
        if found:
            raise DescriptionError(found)
        apparatus: Apparatus = parts["slider"]
        slider = Slider(
            **apparatus.model_dump(mode="json"), friction=parts["friction"], drive=parts["drive"]
        )
        return cls(slider, parts["initial"], parts["run"])

    @classmethod
    def from_json(cls, text: str) -> Self:
        """Read back what `to_json` wrote."""
        return cls.from_dict(json.loads(text))

    def to_dict(self) -> dict[str, dict[str, Any]]:
        """Return nested tables of SI numbers, as `from_dict` reads them."""
        law = self.slider.law
        kind = type(law)
        own = f"{kind.__module__}:{kind.__qualname__}"  # a user's law, by its name
        name = next((name for name, known in LAWS.items() if known is kind), own)
        return {
            "slider": self.slider.model_dump(mode="json", exclude={"friction", "drive"}),
            "friction": {"law": name, **law._asdict()},
            "drive": self.slider.motion._asdict(),
            "initial": self.initial.model_dump(exclude_unset=True),
            "run": self.run.model_dump(exclude_none=True),
        }

    def to_json(self) -> str:
        """Return the description as one JSON string."""
        return json.dumps(self.to_dict())


def _friction(table: dict[str, Any]) -> Any:
    name = table.pop("law", None)
    if not isinstance(name, str) or name not in LAWS:
        message = (
            f"missing; known: {', '.join(LAWS)}"
            if name is None
            else unknown("law", str(name), LAWS)
        )
        raise DescriptionError([Fault("friction.law", message)])
    return _made(LAWS[name], table)


def _made(kind: type[Any], table: dict[str, Any]) -> Any:
    checked = fields(kind)(**table)
    return kind(**checked.model_dump())


READERS: dict[str, Callable[[dict[str, Any]], Any]] = {
    "slider": lambda table: Apparatus(**table),
    "friction": _friction,
    "drive": lambda table: _made(ConstantVelocity, table),
    "initial": lambda table: Initial(**table),
    "run": lambda table: Settings(**table),
}
