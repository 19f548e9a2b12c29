"""The numbers along the axes of a study, in the units of its store."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from math import log, radians
from typing import Any, NamedTuple

import numpy as np
from pydantic_core import PydanticCustomError

from stiction.arrays import TINY, Floats, Indices
from stiction.errors import DescriptionError, Fault, echo
from stiction.study.plan.axes import Axis, Grid, Range
from stiction.study.variables.measures import FORMERLY, MEASURES, TRACES, trace_name
from stiction.system import parameter
from stiction.system.description import Description
from stiction.text.paths import canonical_path
from stiction.text.quantity.wording import in_words, span
from stiction.text.units import Kind, bare, to_si
from stiction.text.validation import unknown_name

# reserved names in a store; an old name is read as its new one
TAKEN = {"status", "message", "time", *MEASURES, *FORMERLY, *map(trace_name, TRACES)}
GRID_ROUNDING = 8.0 * np.finfo(float).eps  # relative: what a value on a grid may be off by
DIGITS = 12  # of a value on a grid that somebody would write
NAME = re.compile(r"\w[\w ,.-]*")


class Coordinate(NamedTuple):
    """The values of a parameter: their dimension, numbers in SI or degrees, and unit."""

    dim: str
    values: Floats
    unit: str


def unit(base: Description, path: str) -> str:
    """Return the unit in which an axis gives a parameter: SI, and degrees.

    Raises
    ------
    DescriptionError
        As of `stiction.system.parameter.unit`.
    """
    return _with_degrees(parameter.unit(base, path))


def stated_unit(tables: Mapping[str, Any], path: str) -> str | None:
    """Return the unit as `unit` does, of tables that may be invalid; None if it is unknown.

    >>> stated_unit({"slider": {"mass": "a pound"}}, "k_x, k_y"), stated_unit({}, "colour")
    ('N/m', None)
    """
    found = {parameter.stated_unit(tables, name) for name in path.split(",")}
    its = found.pop() if len(found) == 1 else None
    return None if its is None else _with_degrees(its)


def _with_degrees(its: str) -> str:
    return "deg" if its == "rad" else its


def number(value: Any, unit: str) -> float:
    """Return a number or a string with its unit as a number in `unit`.

    Raises
    ------
    PydanticCustomError
        With the rule, the offending value and the remedy.
    """
    value = bare(value)
    if unit == "deg" and not isinstance(value, str):
        return to_si(value, Kind("an angle", "rad", "1 deg"))  # says what to write instead
    kind = "an angle" if unit == "deg" else "such a quantity"
    return to_si(value, Kind(kind, unit, f"1 {unit}".rstrip()))


def ascending(known: Mapping[str, Coordinate], dim: str) -> Indices:
    """Return the order in which the values along a dimension ascend."""
    return np.argsort(known[path_along(known, dim)].values, kind="stable")


def path_along(known: Mapping[str, Coordinate], dim: str) -> str:
    """Return the parameter that gives a dimension its name, or else the first along it."""
    return dim if dim in known else next(path for path in known if known[path].dim == dim)


def values_at(
    known: Mapping[str, Coordinate], at: Mapping[str, int]
) -> dict[str, tuple[float, str]]:
    """Return the values of parameters, with their units, at an index along some dimensions."""
    return {
        path: (float(values[at[dim]]), its)
        for path, (dim, values, its) in known.items()
        if dim in at
    }


def nearest(
    known: Mapping[str, Coordinate], dims: Sequence[str], wanted: Mapping[str, Any]
) -> tuple[dict[str, int], list[Fault]]:
    """Return the indices along some dimensions nearest to wanted values, and the faults."""
    at, found = dict[str, int](), list[Fault]()
    for name, value in wanted.items():
        dim = canonical_path(name)
        if dim not in known or dim not in dims:
            found.append(Fault(dim, _without_values(dim, dims, known)))
            continue
        try:
            sought = number(value, known[dim].unit)
            found += [Fault(dim, message) for message in beyond(known[dim], sought)]
            at[dim] = int(np.argmin(np.abs(known[dim].values - sought)))
        except PydanticCustomError as error:
            found.append(Fault(dim, error.message()))
    return at, found


def _without_values(dim: str, dims: Sequence[str], known: Mapping[str, Coordinate]) -> str:
    if dim in dims:
        return "counts the runs, whose parameters vary together: it has no values to look for"
    return unknown_name("dimension", dim, [each for each in dims if each in known] or ["none"])


def beyond(known: Coordinate, wanted: float) -> Iterator[str]:
    """Yield a message if a value lies more than half a step outside a study's values."""
    values = np.unique(known.values)
    gaps = np.diff(values)
    if len(gaps) and not -gaps[0] <= 2.0 * (wanted - values[0]) <= 2.0 * np.ptp(values) + gaps[-1]:
        ends = span(values[0], values[-1], known.unit)
        yield f"{in_words(wanted, known.unit)} is beyond the study, which has {ends}"


def vary(base: Description, changes: Mapping[str, tuple[float, str]]) -> Description:
    """Return a description with other values of some parameters, validated as a whole.

    Parameters
    ----------
    base : Description
        What is varied.
    changes : mapping of str to (float, str)
        For each path the value and its unit, as `unit` returns it.

    Raises
    ------
    DescriptionError
        With every parameter that cannot have its value.
    """
    given: dict[str, float | str] = {
        path: f"{radians(value)!r} rad" if its == "deg" else value
        for path, (value, its) in changes.items()
    }
    return parameter.change_parameters(base, given)


def coordinates(base: Description, axes: Mapping[str, Axis], seed: int) -> dict[str, Coordinate]:
    """Return the values of each axis; each random axis has its own stream."""
    made = {}
    for place, (path, axis) in enumerate(axes.items()):
        its = unit(base, path)
        made[path] = Coordinate(axis.along or path, values(axis, its, place, seed), its)
    return made


def values(axis: Axis, its: str, place: int, seed: int) -> Floats:
    """Return the values of an axis in a unit; `place` is its index among the axes."""
    if not isinstance(axis, Range):
        return np.array([number(value, its) for value in axis.values])
    start, stop = number(axis.start, its), number(axis.stop, its)
    share = axis.places(place, seed)
    if axis.spacing == "log":
        if not start * stop > 0.0:
            raise ValueError("logarithms need values of one sign, none zero; use spacing 'linear'")
        made: Floats = start * (stop / start) ** share
        off = GRID_ROUNDING * (1.0 + abs(log(stop / start))) * np.abs(made)
    else:
        made = start + (stop - start) * share
        off = np.full(len(made), GRID_ROUNDING * max(abs(start), abs(stop)))
    if isinstance(axis, Grid):
        made = decimals(made, off)
    made[share == 0.0], made[share == 1.0] = start, stop  # without rounding
    return made


def decimals(values: Floats, off: Floats) -> Floats:
    """Return values rounded to decimals of few digits, if they are as close as `off`.

    A user who asks a store for its value at 0.45 means that number, not the one below.

    >>> decimals(np.array([0.45 - 1e-16, 1.0 / 3.0]), np.array([4e-16, 4e-16]))
    array([0.45      , 0.33333333])
    """
    places = DIGITS - np.ceil(np.log10(np.maximum(np.abs(values), off / GRID_ROUNDING) + TINY))
    near = np.array([*map(round, values.tolist(), places.astype(int).tolist())])
    return np.where(np.abs(near - values) <= off, near, values) + 0.0  # no -0


def coordinate_faults(
    unit_at: Callable[[str], str | None], axes: Mapping[str, Axis], seed: int
) -> Iterator[Fault]:
    """Yield the faults of each axis, and the contradictions between axes of one dimension.

    `unit_at` is `unit` or `stated_unit` of the base; values in a unit that is not known are passed
    over.
    """
    taken: dict[str, str] = {}
    for place, (path, axis) in enumerate(axes.items()):
        for name in path.split(","):
            if taken.setdefault(name.strip(), path) != path:
                yield Fault(
                    path, f"{name.strip()} has an axis already: {echo(taken[name.strip()])}"
                )
        if axis.along is not None and (axis.along in TAKEN or not NAME.fullmatch(axis.along)):
            yield Fault(
                f"{path}.along", f"cannot be {echo(axis.along)}; write a name such as 'sample'"
            )
        other = axes.get(axis.along or "")
        if axis.along != path and other is not None and other.along not in (None, axis.along):
            yield Fault(
                f"{path}.along",
                f"is {echo(axis.along)}, which lies along {echo(other.along)} itself; write that",
            )
        try:
            its = unit_at(path)
        except DescriptionError as error:
            yield from (Fault(path, fault.message) for fault in error.faults)
            continue
        if its is None:
            continue
        wrong = [*_unreadable(path, axis, its)]
        yield from wrong
        if not wrong:
            short = {"count": 1} if isinstance(axis, Range) else {}
            try:
                values(axis.model_copy(update=short), its, place, seed)
            except ValueError as error:
                yield Fault(path, str(error))
    yield from zip_faults(axes)


def _unreadable(path: str, axis: Axis, its: str) -> Iterator[Fault]:
    written: Mapping[Any, Any]
    if isinstance(axis, Range):
        written = {"from": axis.start, "to": axis.stop}
    else:
        written = dict(enumerate(axis.values, 1))
    for name, value in written.items():
        try:
            number(value, its)
        except PydanticCustomError as error:
            yield Fault(f"{path}.{name}", error.message())


def zip_faults(axes: Mapping[str, Axis]) -> Iterator[Fault]:
    """Yield a fault for each axis that is not as long as the first along its dimension."""
    first: dict[str, tuple[str, int]] = {}
    for path, axis in axes.items():
        known, count = first.setdefault(axis.along or path, (path, axis.count))
        if axis.count != count:
            yield Fault(
                path,
                f"has {axis.count} values and {known} has {count} along {echo(axis.along)}; "
                "axes along one dimension go through their values together: give as many",
            )
