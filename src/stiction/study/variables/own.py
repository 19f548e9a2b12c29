"""The user's measures: functions from a run to a number, stored by name and by text."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from math import nan
from pathlib import Path
from traceback import extract_tb
from types import FunctionType
from typing import TYPE_CHECKING, Any, cast, get_type_hints

from stiction.errors import DescriptionError, StictionError, echo, one_line
from stiction.own_code.identity import differences, refuse_unknown, values_outside
from stiction.own_code.loading import (
    Role,
    module_in_folder,
    module_of_text,
    split,
)
from stiction.own_code.source import member, missing_names, text_of
from stiction.text.quantity.unit import UnitError, factor
from stiction.text.suggestion import TRUST
from stiction.text.units import ONE
from stiction.text.validation import unknown_name

if TYPE_CHECKING:
    from stiction.study.variables.observed_run import ObservedRun
    from stiction.trajectory import Trajectory

MEASURE = Role("study.measures", "measure", "function", "mymeasures.py:mean_angle")
INSIDE = "inside the function"
WRITE = "def mean_angle(run) -> Annotated[float, 'deg']: ..."

# from a measure's reference, and its text if stored, to the measure
FindMeasure = Callable[[str, str | None], "OwnMeasure"]


_GIVEN: dict[tuple[str, str], Callable[..., Any]] = {}  # to studies of this process


class MeasureError(StictionError):
    """An error that a user's measure raised in a run, and its place."""


@dataclass(frozen=True)
class OwnMeasure:
    """A number that a user's function returns for a run.

    Parameters
    ----------
    reference : str
        File and name of the function, ``mymeasures.py:mean_angle``.
    source : str or None
        The text that defines it; None as long as its file has not been read.
    function : callable, optional
        From a `Trajectory` to a number; None if its text came from a store and may not be run.
    stored : mapping, optional
        The values outside its text that it read when a store was made.
    """

    reference: str
    source: str | None
    function: Callable[[Trajectory], Any] | None = field(default=None, compare=False, repr=False)
    stored: Mapping[str, str] | None = field(default=None, compare=False, repr=False)

    def __post_init__(self) -> None:
        """Note that the function may be run in this process."""
        if self.function is not None and self.source is not None:
            _GIVEN[self.reference, self.source] = self.function

    def __str__(self) -> str:
        """Return the name."""
        return self.name

    @property
    def name(self) -> str:
        """Name of the function, and of the variable in the store."""
        return self.reference.rpartition(":")[2]

    @property
    def unit(self) -> str:
        """The unit of the number: the text in its annotation, ``-> Annotated[float, "deg"]``."""
        return unit_of(self.function) if self.function else ""

    @property
    def long_name(self) -> str:
        """The first line of the function's docstring; else its name."""
        said = inspect.getdoc(self.function) or self.name.replace("_", " ")
        return said.partition("\n")[0].rstrip(".")

    def table(self) -> dict[str, Any]:
        """Return the measure as a table, from which a finder restores it."""
        own = cast(FunctionType | None, self.function)
        reads = self.stored if own is None else values_outside(own)
        return {"function": self.reference, "source": self.source, "reads": reads}

    def refuse_others(self) -> None:
        """Refuse to compute numbers for a store if the function now reads other values.

        Raises
        ------
        DescriptionError
            Which names the values; or if the function may not be run.
        """
        if self.function is None:
            raise refusal(self.reference)
        said = "" if self.stored is None else differences(self.stored, self.table()["reads"])
        if said:
            raise MEASURE.fault(f"{self.name} reads what has changed since it was stored: {said}")

    def value(self, run: ObservedRun) -> float:
        """Return the number; NaN if the samples are too few for it.

        Raises
        ------
        MeasureError
            Whatever the function raises, and where; or if it returns no number.
        """
        assert self.function is not None  # a sweep has refused it
        if not run.resolved:
            return nan
        try:
            found = self.function(run.trajectory)
        except (KeyboardInterrupt, MemoryError):
            raise
        except BaseException as error:
            raise MeasureError(f"{self.name}: {raised_in(self.function, error)}") from None
        return number(found, self.name)


def number(value: Any, name: str) -> float:
    """Return a measure's value as a number.

    Raises
    ------
    MeasureError
        If it is none, as a text or an array of several.
    """
    try:
        if isinstance(value, str | bytes):
            raise TypeError
        return float(value)
    except Exception:
        raise MeasureError(f"{name} returned {echo(value)}; it must be one number") from None


def raised_in(function: Any, error: BaseException) -> str:
    """Return the error that a user's function raised, with the last line of its file."""
    file = inspect.unwrap(function).__code__.co_filename
    lines = [each.lineno for each in extract_tb(error.__traceback__) if each.filename == file]
    place = f"{Path(file.strip('<>')).name}, line {lines[-1]}: " if lines else ""
    return f"{place}{one_line(error)}"


def refusal(reference: str) -> DescriptionError:
    """Return the error for a stored measure that may not be run."""
    return MEASURE.fault(
        f"{echo(reference)} is a user's measure, and the code stored with it is not run without "
        f"permission: if you trust the source, allow it: {TRUST}; or sweep the study's own file"
    )


def measures_in_folder(folder: Path, trust: bool = False) -> FindMeasure:
    """Return a finder for measures of a study's file, which runs files in `folder` only.

    With `trust` the file may lie anywhere.
    """

    def find(reference: str, text: str | None) -> OwnMeasure:
        if text is not None:  # stored by a program, not written by hand
            return measures_of_results(trust)(reference, text)
        file, name = split(reference, MEASURE)
        module = module_in_folder(file, folder, trust, MEASURE)
        return _measure_in(member(module, name), reference, vars(module))

    return find


def measures_of_results(trust: bool = False) -> FindMeasure:
    """Return a finder for measures of a store, which runs code only with `trust`.

    Exceptions are functions that the user has given to a study in this process, since a store may
    name any function that is loaded. A measure that may not be run has no function; its stored
    values can still be read and drawn.
    """

    def find(reference: str, text: str | None) -> OwnMeasure:
        file, name = split(reference, MEASURE)
        if not isinstance(text, str):
            raise MEASURE.fault(f"{echo(reference)} was stored without its text")
        found = _GIVEN.get((reference, text))
        if found is None and trust:
            module = module_of_text(file, text, MEASURE)
            return _measure_in(member(module, name), reference, vars(module))
        return OwnMeasure(reference, text, found)

    return find


def _measure_in(found: Any, reference: str, names: dict[str, Any]) -> OwnMeasure:
    """Return the measure of a file, or raise an error if the file has none of this name."""
    if not isinstance(found, FunctionType):
        own = [key for key, value in names.items() if isinstance(value, FunctionType)]
        name = reference.rpartition(":")[2]
        raise MEASURE.fault(f"{echo(reference)}: {unknown_name('function', name, own or ['none'])}")
    try:
        made = own_measure(found)
    except ValueError as error:
        raise MEASURE.fault(str(error)) from None
    return OwnMeasure(reference, made.source, found)


def own_measure(function: Any) -> OwnMeasure:
    """Return the measure of a function.

    Raises
    ------
    ValueError
        If its name or its text cannot be kept, if it cannot be called with a run, or if it reads
        what may change unnoticed.
    """
    if not isinstance(function, FunctionType):
        raise ValueError(f"{echo(function)} is neither a measure's name nor a function")
    name = function.__qualname__
    if not name.isidentifier():
        raise ValueError(
            f"{name.rpartition('.')[2]} has no name that a store could keep; write at the top "
            f"level of a file or cell: {WRITE}"
        )
    try:
        inspect.signature(function).bind(None)
    except TypeError:
        raise ValueError(f"{name} must take one argument, the run; write: {WRITE}") from None
    text = text_of(function)
    if text is None:
        raise ValueError(
            f"the text of {name} is not known: it came from a prompt, or its file changed after it "
            "was imported; write it in a file, and import it anew"
        )
    if function.__module__ == "__main__" and (lost := missing_names(text.text)):
        raise ValueError(
            f"{name} uses {', '.join(lost)} of another cell; define them in the same cell, or in "
            "a file"
        )
    refuse_unknown(function, INSIDE)
    unit_of(function)
    return OwnMeasure(f"{text.name}:{name}", text.text, function)


def unit_of(function: Any) -> str:
    """Return the unit in the annotation of a function's result; '' without one.

    Raises
    ------
    ValueError
        If it is not the text of a unit.

    Examples
    --------
    >>> from typing import Annotated
    >>> def mean_angle(run) -> Annotated[float, "deg"]: ...
    >>> unit_of(mean_angle)
    'deg'
    """
    inner, name = inspect.unwrap(function), function.__name__  # without its decorators

    def only() -> Any: ...

    only.__annotations__ = {"return": inner.__annotations__.get("return")}
    try:
        hint = get_type_hints(only, inner.__globals__, include_extras=True)["return"]
    except Exception as error:  # the annotation may be any text
        told = f"what {name} returns is annotated wrongly: {one_line(error)}"
        raise ValueError(f"{told}; write: {WRITE}") from None
    said = [each for each in getattr(hint, "__metadata__", ()) if isinstance(each, str)]
    unit = said[0] if said else ""
    try:
        if unit not in ONE:
            factor(unit, unit)
    except UnitError as error:
        raise ValueError(f"the unit of {name}: {error}; write for example 'mN' or '1'") from None
    return unit
