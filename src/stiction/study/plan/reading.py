"""Reading of a study's parts: each valid value, or a message with the remedy."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

from pydantic import ValidationInfo

from stiction.errors import DescriptionError, Fault, Faults, echo
from stiction.names import by_new_names
from stiction.study.plan.axes import Axis, read_axis
from stiction.study.plan.coordinates import TAKEN, coordinate_faults, unit
from stiction.study.variables.measures import FORMERLY, MEASURES, TRACES
from stiction.study.variables.own import FindMeasure, OwnMeasure, own_measure
from stiction.system.description import Description
from stiction.text.paths import canonical_path, keys_of, parameter_names
from stiction.text.validation import faulty, unknown_name

REQUIRED = ("function", "source")  # keys of a stored measure


def is_description(value: Any) -> Any:
    """Return a description; refuse anything else."""
    if not isinstance(value, Description):
        raise ValueError(
            f"{echo(value)} is not a description; write for example "
            "st.Description.of(slider, '5 s')"
        )
    return value


def axes_of(value: Any, info: ValidationInfo) -> dict[str, Axis]:
    """Return axes by their paths; report all faults at once, also those with the base."""
    if not isinstance(value, Mapping) or not value:
        raise ValueError("give at least one axis: the path of a parameter, and its values")
    axes, found = read_axes(value)
    if "base" in info.data:  # a faulty one is not there
        found += coordinate_faults(partial(unit, info.data["base"]), axes, seed=0)
    if found:
        raise faulty(found)
    return axes


def read_axes(value: Any) -> tuple[dict[str, Axis], list[Fault]]:
    """Return the valid axes by their paths, and the faults of the others."""
    axes, found = dict[str, Axis](), list[Fault]()
    for path, each in value.items() if isinstance(value, Mapping) else ():
        try:
            axes[canonical_path(str(path))] = read_axis(each, str(path))
        except DescriptionError as error:
            found += error.at().faults
    return axes, found


def unknown_axes(tables: Mapping[str, Any], value: Any) -> Iterator[Fault]:
    """Yield a fault for each axis whose parameter these tables cannot have."""
    for path in value if isinstance(value, Mapping) else ():
        for name in map(str.strip, str(path).split(",")):
            if not _is_known(tables, name):
                said = unknown_name("parameter", name, parameter_names(tables))
                yield Fault(f"axes.{path}", said)


def items_of(value: Any, what: str, known: Collection[str]) -> list[Any]:
    """Return the items of a list; refuse anything else."""
    if isinstance(value, str | Mapping) or not hasattr(value, "__iter__"):
        raise ValueError(f"{echo(value)} is not a list of {what}s; known: {', '.join(known)}")
    return [*value]


def measures_of(value: Any) -> tuple[str | OwnMeasure, ...]:
    """Return distinct measures: names, with old ones replaced, and the user's functions."""
    found, faults = list[str | OwnMeasure](), list[str]()
    for each in items_of(value, "measure", MEASURES):
        try:
            found.append(_measure(each))
        except ValueError as error:
            faults.append(str(error))
    faults += _clashes(each for each in dict.fromkeys(found) if isinstance(each, OwnMeasure))
    if faults:
        raise ValueError("; ".join(faults))
    return tuple(dict.fromkeys(found))


def _measure(each: Any) -> str | OwnMeasure:
    if isinstance(each, OwnMeasure):
        return each
    if not isinstance(each, str):
        return own_measure(each)
    if each not in MEASURES and each not in FORMERLY:
        raise ValueError(unknown_name("measure", each, MEASURES))
    return by_new_names([each], FORMERLY, "measure")[0]


def _clashes(own: Iterable[OwnMeasure]) -> Iterator[str]:
    """Yield a fault for each user's measure whose name is taken."""
    for name, count in Counter(each.name for each in own).items():
        if count > 1:
            yield f"{count} measures are called {name}; rename all but one"
        elif name in TAKEN:
            yield f"{name} has a meaning in every store; give your function another name"


def references_of(value: Any) -> Any:
    """Return the measures of a file's list, the user's own without their functions."""
    if not isinstance(value, Sequence) or isinstance(value, str):
        return value
    return [_reference(each) for each in value]


def _reference(each: Any) -> Any:
    if isinstance(each, str) and ":" in each:
        return OwnMeasure(each, None)
    if isinstance(each, Mapping) and {*each} in ({*REQUIRED}, {*REQUIRED, "reads"}):
        function, source, reads = each["function"], each["source"], each.get("reads")
        known = isinstance(reads, Mapping | None)
        if known and isinstance(function, str) and isinstance(source, str):
            return OwnMeasure(function, source, stored=reads)
    return each


def with_functions(measures: Any, find: FindMeasure) -> Any:
    """Return the measures of a file's list, with the functions that may be run."""
    faults, found = Faults(), []
    for each in measures:
        with faults.of_part():
            own = isinstance(each, OwnMeasure) and each.function is None
            known = find(each.reference, each.source) if own else each
            found.append(replace(known, stored=each.stored) if own else each)
    faults.refuse()
    return found


def traces_of(value: Any) -> tuple[str, ...]:
    """Return names of traces."""
    wanted = tuple(dict.fromkeys(map(str, items_of(value, "trace", TRACES))))
    if strange := [name for name in wanted if name not in TRACES]:
        raise ValueError("; ".join(unknown_name("trace", name, TRACES) for name in strange))
    return wanted


def varied_faults(tables: Mapping[str, Any], changes: Iterable[str]) -> Iterator[Fault]:
    """Yield a fault for each change of a parameter that an axis varies, and would replace."""
    axes = tables.get("axes")
    axes = axes if isinstance(axes, Mapping) else {}
    varied = {
        tuple(keys_of(tables, name)): (str(path), axis)
        for path, axis in axes.items()
        for name in str(path).split(",")
        if _is_known(tables, name)
    }
    for name in changes:
        keys = keys_of(tables, name) if _is_known(tables, name) else ()
        path, axis = varied.get(tuple(keys), ("", None))
        if path:
            ends = ("values",) if isinstance(axis, Mapping) and "values" in axis else ("from", "to")
            remedy = " and ".join(f"{echo(f'axes.{path}.{end}')}" for end in ends)
            yield Fault(name, f"varies along an axis of the study; change {remedy} instead")


def _is_known(tables: Mapping[str, Any], name: str) -> bool:
    try:
        return bool(keys_of(tables, name))
    except KeyError:
        return False
