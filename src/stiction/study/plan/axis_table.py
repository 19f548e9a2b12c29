"""An axis from a table of a study's file, and back."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, cast

from stiction.errors import DescriptionError, Fault
from stiction.study.plan.axes import Axis, Grid, Random, Sobol, Values
from stiction.text.validation import unknown

SAMPLINGS: dict[str, type[Any]] = {"grid": Grid, "random": Random, "sobol": Sobol}
WRITTEN = {"start": "from", "stop": "to"}


def read_axis(value: Any, name: str) -> Axis:
    """Return an axis from a table of a study's file, or as it is.

    Raises
    ------
    DescriptionError
        Naming each fault below ``axes.name``.
    """
    if isinstance(value, Axis):
        return value
    path = f"axes.{name}"
    if not isinstance(value, Mapping):
        message = f"{value!r} is not an axis; write for example st.Grid('1 deg', '10 deg', 10)"
        raise DescriptionError([Fault(path, message)])
    fields = {written: name for name, written in WRITTEN.items()}
    table = {fields.get(str(key), str(key)): each for key, each in value.items()}
    sampling = table.pop("sampling", "grid")
    if not isinstance(sampling, str) or sampling not in SAMPLINGS:
        message = unknown("sampling", str(sampling), SAMPLINGS)
        raise DescriptionError([Fault(f"{path}.sampling", message)])
    kind = Values if "values" in table else SAMPLINGS[sampling]
    try:
        return cast(Axis, kind(**table))
    except DescriptionError as error:
        found = []
        for fault in error.faults:
            _, _, field = fault.path.partition(".")
            first, dot, rest = field.partition(".")
            found.append(Fault(f"{path}.{WRITTEN.get(first, first)}{dot}{rest}", fault.message))
        raise DescriptionError(found) from None


def axis_table(axis: Axis) -> dict[str, Any]:
    """Return an axis as a table that can be read back."""
    sampling = next((name for name, kind in SAMPLINGS.items() if type(axis) is kind), "grid")
    given = axis.model_dump(mode="json", exclude_none=True)
    table = {WRITTEN.get(name, name): value for name, value in given.items()}
    return table if isinstance(axis, Values) else {**table, "sampling": sampling}
