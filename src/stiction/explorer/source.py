"""The sources of the explorer: a description, a result, a study, a measured record."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from stiction.analysis.measurement.reading import read_source
from stiction.analysis.record import Record
from stiction.arguments import with_article
from stiction.drive.recorded.reading import locate_nothing
from stiction.errors import DescriptionError, ResultError, echo
from stiction.explorer.motion import CURVES
from stiction.friction import Anisotropic, Law
from stiction.friction.user.loading import Find, is_own
from stiction.presets import PRESETS, nakano_popov_2020
from stiction.system.description import Description, Settings
from stiction.system.initial import Initial
from stiction.system.slider import Slider
from stiction.text.quantity.wording import in_words
from stiction.text.toml import tame
from stiction.trajectory import Trajectory

if TYPE_CHECKING:
    from stiction.study.view.view import View

PAPER = "Nakano & Popov 2020, Fig. 3"


@dataclass(frozen=True)
class Opened:
    """The initial content of a page.

    Attributes
    ----------
    name : str
        The title of the page.
    description : Description
        The system at first.
    measured : mapping of str to ndarray, optional
        Curves to lay under the simulated ones: ``time`` (s), and any of the page's curves.
    origin : str
        What these are: "measured", "stored".
    study : View, optional
        A study, whose runs can be opened.
    preset : str, optional
        The name of the preset that the system was at first; it may be changed.
    """

    name: str
    description: Description
    measured: Mapping[str, np.ndarray] | None = None
    origin: str = ""
    study: View | None = None
    preset: str = ""

    def measured_during(self, run: tuple[float, float]) -> tuple[np.ndarray, str]:
        """Return the times of the measured curves (s), and the name of the curves.

        Curves whose clock ends before the run or starts after it would not be seen: their times
        are counted from the run's start.

        Parameters
        ----------
        run : tuple of float
            Start and end of the run that is shown, s.
        """
        times = np.zeros(0) if self.measured is None else self.measured["time"]
        start, end = run
        if not len(times) or (times[0] < end and times[-1] > start) or times[0] == start:
            return times, self.origin
        first = float(times[0])
        return times - first + start, f"{self.origin}, from {in_words(first, 's')} on"

    def title(self, description: Description, origin: Any) -> tuple[str, bool]:
        """Return the name of the system that a page shows, and whether it was changed.

        Parameters
        ----------
        description : Description
            That is shown.
        origin : object
            From a page: the name of the chosen preset, or the place of the chosen run of a study.
        """
        name, own = self.name, self.description
        if isinstance(origin, Mapping) and self.study is not None:
            own = self.run_at(origin)
        elif isinstance(origin, str) and origin in PRESETS:
            name, own = PRESETS[origin].title, PRESETS[origin].make()
        return name, not is_same_system(description, own)

    def run_at(self, place: Mapping[str, Any]) -> Description:
        """Return the description of the run of the study at an index along each dimension.

        Raises
        ------
        ResultError
            If no study was opened.
        """
        if self.study is None:
            raise ResultError("no study was opened; stiction explore STUDY.zarr opens one")
        study = self.study.study
        whole = {str(dim): int(index) for dim, index in place.items()} | dict(self.study.at)
        sizes = zip(study.layout.dims, study.layout.shape, strict=True)
        return study.description(tuple(min(max(whole.get(dim, 0), 0), n - 1) for dim, n in sizes))

    def read(self, tables: Mapping[str, Any]) -> Description:
        """Return the description of a page's tables.

        The page names no file: a user's law is that which was opened, by its name, and a recorded
        drive has its rows.

        Raises
        ------
        DescriptionError
            With every fault.
        """
        raw = tame({str(key): value for key, value in tables.items()}, "description")
        return Description.from_dict(raw, find=self.find, locate=locate_nothing)

    @property
    def own(self) -> dict[str, Law]:
        """The user's law that was opened, by its name; nothing if it is none."""
        law, table = self.description.slider.law, self.description.to_dict()["friction"]
        law = law.law if isinstance(law, Anisotropic) else law
        return {table["law"]: law} if is_own(table) else {}

    @property
    def find(self) -> Find:
        """The finder of a user's law: it loads nothing."""
        own = self.own

        def find(name: str, text: str | None) -> type[Any]:
            if name in own and text is None:
                return type(own[name])
            message = (
                f"{echo(name)} is a law from a file, and the page loads none; name it on the "
                "command "
                "line: stiction explore my.toml"
            )
            raise DescriptionError.of("friction.law", message)

        return find


def open_sources(sources: Iterable[Any], *, trust: bool = False) -> Opened:
    """Return the combined content of sources: one system, and perhaps a record.

    Raises
    ------
    StictionError
        If a file cannot be read, or two describe a system.
    """
    name, described = "", ""
    found: dict[str, Any] = {"description": the_papers()}
    for source in sources:
        part = open_source(source, trust)
        own = part.pop("name", name_of(source))
        if "description" in part:
            if described:
                message = f"{described} and {own} both describe a system; give one of them"
                raise ResultError(message)
            described = own
        name = described or own
        found |= part
    return Opened(name or PAPER, **found)


def name_of(source: Any) -> str:
    """Return a source's name in the title of the page."""
    if isinstance(source, Record) and source.origin is not None:
        source = source.origin.file
    if isinstance(source, str | Path):
        return Path(source).name
    return with_article(type(source).__name__)


def open_source(source: Any, trust: bool) -> dict[str, Any]:
    """Return the fields of `Opened` that one source gives: a file, or an object of a session."""
    if isinstance(source, Opened):
        return {name: value for name, value in vars(source).items() if value}
    if isinstance(source, str | Path):
        path = Path(source)
        if path.suffix.lower() == ".toml":
            return {"description": Description.from_toml(path, trust=trust)}
        if path.is_dir():
            from stiction.study.view.view import view_study

            view = view_study(path, {}, trust)
            first = view.study.description((0,) * len(view.study.layout.dims))
            return {"description": first, "study": view}
        source = read_source(path, trust=trust)
    if isinstance(source, Description):
        return fields_of(source)
    if isinstance(source, Slider):
        return fields_of(the_papers()._replace(slider=source))
    if isinstance(source, Trajectory):
        stored = {name: source.samples[name] for name in ("time", *CURVES)}
        return {"description": source.description, "measured": stored, "origin": "stored"}
    if isinstance(source, Record):
        channels = {"spring_x": source.force, "X": source.position, "slip_speed": source.slip_speed}
        known = {name: values for name, values in channels.items() if values is not None}
        return {"measured": {"time": source.time, **known}, "origin": "measured"}
    given = with_article(type(source).__name__)
    message = f"{given} cannot be explored; give a file, a description or a run"
    raise ResultError(message)


def fields_of(description: Description) -> dict[str, Any]:
    """Return a description as a field of `Opened`; with its name, if it is a published system."""
    if is_same_system(description, the_papers()):
        return {"description": description, "name": PAPER}
    for name, each in PRESETS.items():
        if is_same_system(description, each.make()):
            return {"description": description, "name": each.title, "preset": name}
    return {"description": description}


def is_same_system(one: Description, other: Description) -> bool:
    """Return whether two descriptions differ in nothing but the duration and samples of a run."""
    settings = one.run
    return one.to_dict() == other._replace(run=settings).to_dict()


def the_papers() -> Description:
    """Return the paper's case over 5 s."""
    return Description(nakano_popov_2020(), Initial(), Settings(duration=5.0))
