"""Reading of a study's parts: each valid value, or a message with the remedy."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from contextlib import suppress
from typing import Any

from stiction.errors import DescriptionError, Fault, echo
from stiction.names import by_new_names
from stiction.study.plan.axes import Axis, read_axis
from stiction.study.variables.measures import FORMERLY, MEASURES, TRACES
from stiction.system.description import Description
from stiction.text.paths import canonical_path, keys_of, parameter_names
from stiction.text.validation import faulty, unknown_name


def is_description(value: Any) -> Any:
    """Return a description; refuse anything else."""
    if not isinstance(value, Description):
        raise ValueError(
            f"{echo(value)} is not a description; write for example "
            "st.Description(slider, st.Initial(), st.Settings(duration='5 s'))"
        )
    return value


def axes_of(value: Any) -> dict[str, Axis]:
    """Return axes by their paths; report all of their faults at once."""
    if not isinstance(value, Mapping) or not value:
        raise ValueError("give at least one axis: the path of a parameter, and its values")
    axes, found = {}, []
    for path, each in value.items():
        try:
            axes[canonical_path(str(path))] = read_axis(each, str(path))
        except DescriptionError as error:
            found += [*error.at().faults]
    if found:
        raise faulty(found)
    return axes


def readable_axes(value: Any) -> dict[str, Axis]:
    """Return the axes without a fault of their own, by their paths."""
    axes = {}
    for path, each in value.items() if isinstance(value, Mapping) else ():
        with suppress(DescriptionError):
            axes[canonical_path(str(path))] = read_axis(each, str(path))
    return axes


def unknown_axes(tables: Mapping[str, Any], value: Any) -> Iterator[Fault]:
    """Yield a fault for each axis of a parameter that these tables cannot have."""
    for path in value if isinstance(value, Mapping) else ():
        for name in map(str.strip, str(path).split(",")):
            if not _is_known(tables, name):
                said = unknown_name("parameter", name, parameter_names(tables))
                yield Fault(f"axes.{path}", said)


def named_ones(
    value: Any, what: str, known: Collection[str], former: Collection[str] = ()
) -> tuple[str, ...]:
    """Return distinct names, known or former ones; refuse others, with the known ones."""
    if isinstance(value, str) or not hasattr(value, "__iter__"):
        raise ValueError(f"{echo(value)} is not a list of {what}s; known: {', '.join(known)}")
    wanted = tuple(dict.fromkeys(str(each) for each in value))
    strange = [name for name in wanted if name not in known and name not in former]
    if strange:
        raise ValueError("; ".join(unknown_name(what, name, known) for name in strange))
    return wanted


def measures_of(value: Any) -> tuple[str, ...]:
    """Return names of measures, with old names replaced."""
    known = named_ones(value, "measure", MEASURES, FORMERLY)
    return tuple(dict.fromkeys(by_new_names(known, FORMERLY, "measure")))


def traces_of(value: Any) -> tuple[str, ...]:
    """Return names of traces."""
    return named_ones(value, "trace", TRACES)


def varied_faults(tables: Mapping[str, Any], changes: Iterable[str]) -> Iterator[Fault]:
    """Yield a fault for each change of a parameter along an axis, whose values would replace it."""
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
