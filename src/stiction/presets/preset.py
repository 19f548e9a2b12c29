"""A published system: its results, its publication, and the numbers to reproduce.

A preset is a function that returns a `Description`, decorated with `preset`, and a line in
``presets/__init__.py``. Its docstring is its story, for ``stiction presets NAME``.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

from stiction.arguments import name_arguments
from stiction.errors import DescriptionError, echo
from stiction.names import refuse_second
from stiction.storage.kinds import use_of_name
from stiction.system.description import Description
from stiction.system.slider import Slider
from stiction.text.validation import unknown_name

if TYPE_CHECKING:
    from stiction.trajectory import Trajectory

Grade = Literal["solid", "half", "scenario"]
GRADES = {
    "solid": "published parameters and a published number",
    "half": "published parameters; the number is derived from them",
    "scenario": "a published qualitative result; parameters are assumed",
}


@dataclass(frozen=True)
class Number:
    """One number: its place in a publication, its meaning, both values, and the tolerance.

    A `finding` is wrong in the publication, as far as is known: it is shown, and must not agree.

    Examples
    --------
    >>> import stiction as st
    >>> number = st.presets.find("leine-belt").numbers(st.run(st.presets.leine_belt()))[0]
    >>> number.agrees
    True
    """

    where: str
    what: str
    stated: float
    computed: float
    tolerance: float
    unit: str = "1"
    finding: bool = False

    @property
    def deviation(self) -> float:
        """Computed minus stated value, in `unit`."""
        return self.computed - self.stated

    @property
    def agrees(self) -> bool:
        """Whether the deviation is within the tolerance; NaN does not agree."""
        return abs(self.deviation) <= self.tolerance * (1 + 1e-9)

    @property
    def verdict(self) -> str:
        """``agrees``, ``finding`` or ``WRONG``."""
        if self.finding:
            return "finding" if abs(self.deviation) > self.tolerance else "WRONG"
        return "agrees" if self.agrees else "WRONG"


class Published(NamedTuple):
    """A number that a run of a preset must give.

    Attributes
    ----------
    what : str
        Its meaning.
    value, tolerance : float
        In `unit`; the tolerance is that of the published digits, or of the method.
    unit : str
        Its unit; "1" for a pure number, and for a statement, which is 1 if it holds.
    where : str
        Its source, where that is not the preset's reference: "closed form", "computed", ...
    """

    what: str
    value: float
    tolerance: float
    unit: str = "1"
    where: str = "published"


def holds(what: str, where: str = "published") -> Published:
    """Return a qualitative result: a statement, measured as 1 if it holds."""
    return Published(what, 1.0, 0.0, "1", where)


Measure = Callable[["Trajectory"], Sequence[float]]


class Preset(NamedTuple):
    """A published system.

    Attributes
    ----------
    name : str
        As in ``stiction run --preset NAME``.
    shows : str
        What one looks at it for.
    reference, doi : str
        Where it is published.
    grade : str
        A key of `GRADES`.
    make : callable
        Returns the description.
    published : tuple of Published
        The numbers to be reproduced.
    measure : callable
        Returns these numbers from a run of the description, in the same order.
    assumed : tuple of str
        What the publication leaves open, and what was chosen.

    Examples
    --------
    >>> import stiction as st
    >>> st.presets.find("leine-belt").grade
    'solid'
    """

    name: str
    shows: str
    reference: str
    doi: str
    grade: Grade
    make: Callable[[], Description]
    published: tuple[Published, ...]
    measure: Measure
    assumed: tuple[str, ...] = ()

    @property
    def year(self) -> str:
        """The year of its publication, '' for a program's."""
        found = re.search(r"\((\d{4})\)", self.reference)
        return found[1] if found else ""

    @property
    def publication(self) -> str:
        """Its authors and year, or its program, in short."""
        return f"{self.reference.split(',')[0]} {self.year}".rstrip()

    @property
    def title(self) -> str:
        """Its name and its publication."""
        return f"{self.name} ({self.publication})"

    @property
    def story(self) -> str:
        """The whole description of the preset, the docstring of its function."""
        from inspect import cleandoc

        return cleandoc(str(self.make.__doc__))

    def numbers(self, run: Trajectory) -> list[Number]:
        """Return each published number beside the number of a run of the description."""
        return [
            Number(each.where, each.what, each.value, float(found), each.tolerance, each.unit)
            for each, found in zip(self.published, self.measure(run), strict=True)
        ]


PRESETS: dict[str, Preset] = {}
Make = Callable[[], Description]


def preset(measure: Measure, **fields: Any) -> Callable[[Make], Make]:
    """Decorate the function that makes a preset's description: it becomes known by its name."""

    def register(make: Make) -> Make:
        name = make.__name__.replace("_", "-")
        made = Preset(name=name, make=make, measure=measure, **fields)
        refuse_second("preset", name, PRESETS.get(name, made).make, make)
        PRESETS[name] = made
        return make

    return register


@name_arguments
def find(name: str) -> Preset:
    """Return a preset by its name, with dashes or underscores.

    Raises
    ------
    DescriptionError
        If there is no preset of this name.

    Examples
    --------
    >>> import stiction as st
    >>> st.presets.find("leine-belt").make().slider.mass
    1.0
    """
    known = name.replace("_", "-")
    if known not in PRESETS:
        use = use_of_name(name)  # of a ready study
        message = f"{echo(name)}: {use}" if use else unknown_name("preset", name, PRESETS)
        raise DescriptionError.of("preset", message)
    return PRESETS[known]


def on_a_line(**changes: Any) -> Slider:
    """Return a slider that moves along x only, m = k = W = 1, with some parameters changed."""
    values: dict[str, Any] = {"mass": 1.0, "k_x": 1.0, "phi": "0 deg", "normal_load": 1.0} | changes
    return Slider(**({"k_y": values["k_x"], "c_y": values.get("c_x", 0.0)} | values))
