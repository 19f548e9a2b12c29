"""Axes of a study: the values of one parameter."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from typing import Annotated, Any, Literal, cast

import numpy as np
from pydantic import AfterValidator, BeforeValidator, Field

from stiction.arguments import is_list
from stiction.arrays import Floats
from stiction.errors import DescriptionError, Fault, echo
from stiction.text.units import Read, Whole, unread
from stiction.text.validation import Described, unknown_name

MOST_VALUES = 1_000_000_000  # values of an axis


def _list(value: Any) -> Any:
    value = value.tolist() if hasattr(value, "tolist") else value
    if not is_list(value) or len(value) == 0:
        raise ValueError(
            f"{echo(value)} is not a list of values; write them in brackets: [..., ...]"
        )
    return tuple(value)


# the parameter of the axis determines the unit
Quantity = Annotated[Any, AfterValidator(unread)]
Quantities = Annotated[Read[tuple[Quantity, ...]], BeforeValidator(_list)]
Count = Annotated[Whole, Field(ge=1, le=MOST_VALUES)]
Spacing = Literal["linear", "log"]


class Positional(Described):
    """Base of axes, whose fields are given by position or by name."""

    def __init_subclass__(cls, *, kw_only: bool = True) -> None:
        """Inform type checkers that a class takes its fields by position."""

    def __init__(self, *given: Any, **values: Any) -> None:
        """Read the fields."""
        named = dict(zip(type(self).model_fields, given, strict=False))
        super().__init__(*given[len(named) :], **named, **values)


class Values(Positional, kw_only=False):
    """A list of values.

    Parameters
    ----------
    values : sequence
        Each a number or a string with its unit.
    along : str, optional
        The dimension of the axis; by default the parameter's own. Axes along one dimension take
        their values together.

    Examples
    --------
    >>> import stiction as st
    >>> st.Values(["1 mm/s", "2 mm/s"]).count
    2
    """

    values: Quantities
    along: str | None = None

    @property
    def count(self) -> int:
        """Number of values."""
        return len(self.values)


class Range(Positional, kw_only=False):
    """Base of `Grid`, `Random` and `Sobol`: values between two ends."""

    start: Quantity
    stop: Quantity
    count: Count
    spacing: Spacing = "linear"
    along: str | None = None

    def places(self, place: int, seed: int) -> Floats:
        """Return the position of each value between `start` and `stop`, 0 to 1.

        `place` is the index of the axis; with the `seed` it determines random values.
        """
        raise NotImplementedError


class Grid(Range):
    """Values at equal distances or equal ratios.

    Parameters
    ----------
    start, stop : float or str
        First and last value, in the parameter's unit; in a file ``from`` and ``to``.
    count : int
        Number of values.
    spacing : {"linear", "log"}, optional
        Equal distances or equal ratios.
    along : str, optional
        As of `Values`.

    Examples
    --------
    >>> import stiction as st
    >>> st.Grid("1 deg", "10 deg", 10).count
    10
    """

    def places(self, place: int, seed: int) -> Floats:
        """Return evenly spaced positions."""
        return np.linspace(0.0, 1.0, self.count)


class Random(Range, kw_only=False):
    """Random values, uniform between the ends or between their logarithms.

    Parameters
    ----------
    start, stop, count, spacing
        As of `Grid`.
    along : str, optional
        By default all random axes lie along ``sample``, so that each run draws all of them.

    Examples
    --------
    >>> import stiction as st
    >>> st.Random("1 mm/s", "10 mm/s", 100, spacing="log").count
    100
    """

    along: str | None = "sample"

    def places(self, place: int, seed: int) -> Floats:
        """Return random positions; a longer axis begins with the same ones."""
        return np.random.Generator(np.random.Philox([seed, place])).random(self.count)


class Sobol(Range, kw_only=False):
    """Values of a Sobol sequence with a random digital shift, which fill a space evenly.

    Parameters
    ----------
    start, stop, count, spacing
        As of `Grid`; a power of two fills best.
    along : str, optional
        By default all such axes lie along ``sample``, and fill their space together.

    References
    ----------
    Sobol, USSR Comput. Math. Math. Phys. 7, 86 (1967); Matousek, J. Complexity 14, 527 (1998).

    Examples
    --------
    >>> import stiction as st
    >>> st.Sobol("1 deg", "5 deg", 64).count
    64
    """

    along: str | None = "sample"

    def places(self, place: int, seed: int) -> Floats:
        """Return the coordinate number `place` of the sequence."""
        from scipy.stats.qmc import Sobol as Sequence  # slow to import

        # coordinates do not depend on their number; the seed shifts them
        sequence = Sequence(place + 1, scramble=False, bits=53)
        with warnings.catch_warnings():  # scipy warns of a count that is not a power of two
            warnings.simplefilter("ignore", UserWarning)
            points = sequence.random(self.count)[:, place]
        shift = np.random.Generator(np.random.Philox([seed, place])).integers(0, 2**53)
        return cast(Floats, ((points * 2.0**53).astype(np.int64) ^ shift) / 2.0**53)


Axis = Values | Range


SAMPLINGS: dict[str, type[Any]] = {"grid": Grid, "random": Random, "sobol": Sobol}
WRITTEN = {"start": "from", "stop": "to"}


def read_axis(value: Any, name: str) -> Axis:
    """Return an axis as it is, or read it from a table of a study's file.

    Raises
    ------
    DescriptionError
        With each fault, its path below ``axes.name``.
    """
    if isinstance(value, Axis):
        return value
    path = f"axes.{name}"
    if not isinstance(value, Mapping):
        right = "st.Values([...])" if is_list(value) else "st.Grid('1 deg', '10 deg', 10)"
        message = f"{echo(value)} is not an axis; write for example {right}"
        raise DescriptionError.of(path, message)
    fields = {written: name for name, written in WRITTEN.items()}
    table = {fields.get(str(key), str(key)): each for key, each in value.items()}
    sampling = table.pop("sampling", "grid")
    if not isinstance(sampling, str) or sampling not in SAMPLINGS:
        message = unknown_name("sampling", str(sampling), SAMPLINGS)
        raise DescriptionError.of(f"{path}.sampling", message)
    kind = Values if "values" in table else SAMPLINGS[sampling]
    known = {WRITTEN.get(field, field) for field in kind.model_fields} | {"sampling"}
    strange = [WRITTEN.get(key, key) for key in table if key not in kind.model_fields]
    found = [Fault(f"{path}.{key}", unknown_name("key", key, known)) for key in strange]
    try:
        given = {key: each for key, each in table.items() if key in kind.model_fields}
        made = cast(Axis, kind(**given))
    except DescriptionError as error:
        for fault in error.faults:
            _, _, field = fault.path.partition(".")
            first, dot, rest = field.partition(".")
            found.append(Fault(f"{path}.{WRITTEN.get(first, first)}{dot}{rest}", fault.message))
    if found:
        raise DescriptionError(found)
    return made


def axis_table(axis: Axis) -> dict[str, Any]:
    """Return an axis as a table, which `read_axis` reads."""
    sampling = next((name for name, kind in SAMPLINGS.items() if type(axis) is kind), "grid")
    given = axis.model_dump(mode="json", exclude_none=True)
    table = {WRITTEN.get(name, name): value for name, value in given.items()}
    return table if isinstance(axis, Values) else {**table, "sampling": sampling}
