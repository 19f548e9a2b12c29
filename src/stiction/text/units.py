"""Units at the boundary: ``"10 mm/s"`` becomes SI; inside the package are only floats.

Each name below is a type for a field of a description. A number is taken as SI,
a string must carry its unit, and an angle must be a string, because a bare number
does not say whether it is in degrees or radians.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from functools import cache, lru_cache, partial
from math import inf, isfinite, radians
from types import UnionType
from typing import (
    TYPE_CHECKING,
    Annotated,
    Any,
    NamedTuple,
    Protocol,
    TypeAlias,
    TypeVar,
    Union,
    get_args,
    get_origin,
    get_type_hints,
    runtime_checkable,
)

from pydantic import AfterValidator, BeforeValidator, Field, PlainSerializer
from pydantic_core import PydanticCustomError

from stiction.arguments import plain, whole
from stiction.errors import echo
from stiction.text.quantity.calendar import of_clock, span_in_seconds
from stiction.text.quantity.exact import RIGID, angle_text
from stiction.text.quantity.unit import UnitError, factor, short


class Kind(NamedTuple):
    """A physical quantity: its name, its SI unit, and an example to write."""

    name: str
    unit: str
    example: str


@runtime_checkable
class PintQuantity(Protocol):
    """A number with a unit, as pint has it."""

    @property
    def magnitude(self) -> Any:
        """The number."""

    @property
    def units(self) -> Any:
        """Its unit."""


# what a public function takes: a number in SI, or with its unit
Quantity = float | str | PintQuantity
if TYPE_CHECKING:
    from numpy.typing import NDArray

    Quantities: TypeAlias = Sequence[Quantity] | NDArray[Any]
else:  # NumPy takes its time
    Quantities = Sequence[Quantity]

# A field that is read from something else, such as a float from text. A type checker knows one type
# for what a constructor takes and for the field: with Any beside it, text is taken, a float read.
T = TypeVar("T")
if TYPE_CHECKING:
    Read: TypeAlias = T | Any
else:

    class Read:
        """``Read[T]`` is T."""

        def __class_getitem__(cls, kind: Any) -> Any:
            """Return the type."""
            return kind


ONE, DIMENSIONLESS = {"", "1"}, "dimensionless"  # units of numbers: of xarray's, of pint's
FACTOR = 12  # digits of a factor that is exact, such as 0.45359237 of a pound
LONGEST_QUANTITY = 200  # characters of a number and its unit
# In SI; smaller ones are zero. Products of five stay finite
LARGEST_NUMBER, SMALLEST_NUMBER = 1e60, 1e-60
VELOCITY = Kind("a velocity", "m/s", "1 mm/s")
FORCE = Kind("a force", "N", "10 N")
TIME, LENGTH = Kind("a time", "s", "5 s"), Kind("a length", "m", "0.1 mm")

# one number, then its unit: no arithmetic, no decimal comma
QUANTITY = re.compile(
    r"\s*([+−-]?(?:\d+\.?\d*|\.\d+|nan|inf)(?:[eE][+−-]?\d+)?)(?![\d,])(.*)", re.S
)


UNCERTAIN = re.compile(r"\+-|\+/-|±")
BOTH = re.compile(rf"\s*\(?\s*(.+?)\s*(?:{UNCERTAIN.pattern})\s*([^)\s]+)\s*\)?\s*(.*)")
NORMAL, UNIFORM = {"value", "uncertainty"}, {"low", "high"}  # keys of an uncertain value


def _hints(kind: Any) -> dict[str, Any]:
    """Return the annotations of a class by field, with their quantities.

    Of a class in a function, they may be names that only this function knows: then none is read,
    and its values are plain numbers.
    """
    try:
        return get_type_hints(kind, include_extras=True)
    except NameError:
        if "<locals>" in kind.__qualname__:
            return {}
        raise


hints_of: Callable[[Any], dict[str, Any]] = cache(_hints)


def to_si(value: object, kind: Kind) -> float:
    """Return `value` as a float in the SI unit of `kind`; below 1e-60 it is zero.

    Parameters
    ----------
    value : float, int or str
        A bare number in SI, or a string of a number and a unit; also a number of NumPy or a
        quantity of pint.
    kind : Kind
        The expected quantity.

    Raises
    ------
    PydanticCustomError
        With the rule, the offending value and the remedy.
    """
    value = bare(value)
    angle = kind.unit == "rad"
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        if isinstance(value, Mapping) and (NORMAL | UNIFORM) & value.keys():
            raise _uncertain(value, kind)
        raise fault(f"{echo(value)} is not {kind.name}; write for example {kind.example!r}")
    if isinstance(value, str):
        number = _parse(value, kind)
    elif angle and isfinite(as_float(value)):
        raise fault(f"degree or radian? write '{echo(value)} deg' or '{echo(value)} rad'")
    else:
        number = as_float(value)
    if not isfinite(number):
        value = value if isinstance(value, str) else number  # an integer may have a million digits
        raise fault(f"{echo(value)} is not finite; write for example {kind.example!r}")
    if abs(number) > LARGEST_NUMBER:
        unit = f" {kind.unit}".rstrip()
        raise fault(
            f"{echo(value)} is beyond {LARGEST_NUMBER:g}{unit}; write for example {kind.example!r}"
        )
    return number if abs(number) >= SMALLEST_NUMBER else 0.0


def unread(value: object) -> object:
    """Return a number, or text with a unit, that is read when its unit is known."""
    value = bare(value)
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        raise ValueError(f"{echo(value)} is not a number or a string with its unit")
    return value


def _uncertain(value: object, kind: Kind) -> Exception:
    """Return the fault of an uncertain value where one value is needed, or of one without its keys.

    >>> _uncertain({"low": 0.1, "hihg": 0.2}, FORCE).message()
    "is {'hihg': 0.2, 'low': 0.1}; an uncertain value has value and uncertainty, or low and high"
    """
    if isinstance(value, Mapping) and not (value.keys() >= NORMAL or value.keys() >= UNIFORM):
        ways = "an uncertain value has value and uncertainty, or low and high"
        return fault(f"is {echo(value)}; {ways}")
    return fault(
        f"{echo(value)} is uncertain, which 'stiction fit', 'design' and 'audit' read, and st.Rig; "
        f"write one value here, for example {kind.example!r}"
    )


def split_uncertain(value: object) -> tuple[str, str] | None:
    """Return value and uncertainty of a text with both, each with the unit; None for all else.

    >>> split_uncertain("2 +- 1 deg"), split_uncertain("2 deg")
    (('2 deg', '1 deg'), None)
    """
    found = BOTH.fullmatch(value) if isinstance(value, str) else None
    if found is None:
        return None
    middle, width, its = found.groups()
    return f"{middle} {its}".strip(), f"{width} {its}".strip()


def as_float(value: Any) -> float:
    """Return a number as a float; infinity for an integer too large for a float."""
    try:
        return float(value)
    except OverflowError:
        return inf


def unit_on(values: Any) -> str | None:
    """Return the unit that a pint quantity or an xarray array carries, or a span of time."""
    if hasattr(values, "magnitude") and hasattr(values, "units"):
        return str(values.units)
    stated = getattr(values, "attrs", {}).get("units")
    if stated is None:
        return "s" if of_clock(values) else None
    return str(stated)


def bare(value: object) -> object:
    """Turn a NumPy number into a Python number, and one that carries a unit into text."""
    if type(value) in (float, int, str):
        return value  # the usual case in large studies
    if of_clock(value):
        lasts = span_in_seconds(value)
        return value if lasts is None else f"{lasts!r} s"
    unit, number = unit_on(value), plain(getattr(value, "magnitude", value))
    if unit is None or number is value or isinstance(number, str):
        return number
    return f"{number!r} {unit if unit not in ONE else DIMENSIONLESS}"


def _parse(text: str, kind: Kind) -> float:
    if len(text) > LONGEST_QUANTITY:
        raise fault(f"has {len(text)} characters; a quantity has at most {LONGEST_QUANTITY}")
    found = QUANTITY.fullmatch(text)
    if not found:
        comma = " (the decimal sign is a point)" if "," in text else ""
        if text.strip().lower() == RIGID and kind.unit == "N/m":
            raise fault(
                f"{echo(text)} is said of a spring in series with others, st.Spring(k_y='rigid'); "
                "a single spring yields: write a stiffness far above the others, for example "
                "'1 GN/m'"
            )
        raise fault(
            f"{echo(text)} is not one number and its unit{comma}; write for example "
            f"{kind.example!r}"
        )
    number, unit = float(found[1].replace("−", "-")), found[2].strip()
    if unit == kind.unit:
        return number  # the usual case in large studies
    if unit == "deg" and kind.unit == "rad":
        return number * radians(1.0)
    if UNCERTAIN.search(unit):
        raise _uncertain(text, kind)
    if not unit:
        raise fault(f"{echo(text)} has no unit; write for example {kind.example!r}")
    if not kind.unit and unit == DIMENSIONLESS:
        return number
    if not kind.unit:
        raise fault(
            f"{echo(text)} must be a number without a unit; write for example {kind.example}"
        )
    try:
        size = factor(unit, kind.unit)
    except UnitError as error:
        raise fault(
            f"{echo(text)} is not one number and its unit: {error}; write for example "
            f"{kind.example!r}"
        ) from error
    if size is None and kind.unit == "N" and (mass := factor(unit, "kg")) is not None:
        weight = f"{number * mass:.6g} kgf"
        raise fault(f"{echo(text)} is a mass, not {kind.name}; write its weight: {echo(weight)}")
    if size is None:
        raise fault(
            f"{echo(text)} is in {short(unit) or 'no unit'}, not a unit of {kind.name}; "
            f"write for example {kind.example!r}"
        )
    return _times(found[1].replace("−", "-"), size)


def _times(text: str, size: float) -> float:
    """Return a number times a factor; exactly rounded where this, or its inverse, is a decimal."""
    number = float(text)
    if number == 0.0 or not isfinite(number * size):
        return number * size
    if (exact := _decimal(size)) is not None:
        return float(Fraction(text) * exact)
    if (inverse := _decimal(1.0 / size)) is not None:
        return float(Fraction(text) / inverse)
    return number * size


@lru_cache(maxsize=1024)
def _decimal(size: float) -> Fraction | None:
    """Return a factor as a decimal of a few digits, which it is but for rounding; else None."""
    digits = Fraction(f"{size:.{FACTOR}g}")
    return digits if abs(digits - Fraction(size)) < 1e-14 * digits else None


def fault(message: str) -> PydanticCustomError:
    """Return the error for a value that cannot be read."""
    # pydantic would read braces in the message itself as fields of a template
    return PydanticCustomError("unit", "{message}", {"message": message})


def kind_of(hint: Any) -> Kind | None:
    """Return the quantity of a field with one of the types below, None for others.

    An optional field, ``Velocity | None``, counts too.
    """
    inner = [each for each in get_args(hint) if each is not type(None)]
    if get_origin(hint) in (Union, UnionType) and len(inner) == 1:
        return kind_of(inner[0])
    for item in getattr(hint, "__metadata__", ()):
        kind = getattr(getattr(item, "func", None), "keywords", {}).get("kind")
        if isinstance(kind, Kind):
            return kind
    return None


def unit_of(hint: Any) -> str:
    """Return the SI unit of a field with one of the types below, '' for others."""
    kind = kind_of(hint)
    return "" if kind is None else kind.unit


def reader(name: str, unit: str, example: str) -> BeforeValidator:
    """Return the validator that reads a quantity with the given SI unit."""
    return BeforeValidator(partial(to_si, kind=Kind(name, unit, example)))


def _as_list(value: Any) -> object:
    """Return an array as a list; refuse a single value."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    elif getattr(value, "ndim", 0) == 1:  # of xarray: each value carries the unit
        value = [*value]
    if not isinstance(value, list | tuple):
        raise fault(f"{echo(value)} is not a list of values; write them in brackets: [..., ...]")
    return value


def _not_below_one(value: float) -> float:
    if not 1.0 <= value <= 10.0:
        raise ValueError(
            f"must lie between 1 and 10, is {value:g}; below 1 friction would change infinitely "
            "fast as slip vanishes"
        )
    return value


class Radians(float):
    """An angle, which carries its unit as a quantity of pint does: bare numbers are refused.

    Examples
    --------
    >>> import stiction as st
    >>> slider = st.presets.nakano_popov_2020()
    >>> slider.replace(mass="1 kg").replace(phi=slider.phi).phi == slider.phi
    True
    """

    units = "rad"

    @property
    def magnitude(self) -> float:
        """The number."""
        return float(self)


Angle = Annotated[
    Read[float],
    reader("an angle", "rad", "1 deg"),
    AfterValidator(Radians),
    PlainSerializer(angle_text),
]
Coefficient = Annotated[Read[float], reader("a number", "", "0.20"), Field(ge=0)]
Number = Annotated[Read[float], reader("a number", "", "1e-6")]
Exponent = Annotated[
    Read[float],
    reader("a number", "", "2"),
    AfterValidator(_not_below_one),
    Field(json_schema_extra={"minimum": 1, "maximum": 10}),
]
PositiveNumber = Annotated[Read[float], reader("a number", "", "0.01"), Field(gt=0)]
Mass = Annotated[Read[float], reader("a mass", "kg", "0.25 kg"), Field(gt=0)]
Stiffness = Annotated[Read[float], reader("a stiffness", "N/m", "1 kN/m"), Field(gt=0)]
Damping = Annotated[Read[float], reader("a damping constant", "N*s/m", "0.5 N*s/m"), Field(ge=0)]
Force = Annotated[Read[float], reader("a force", "N", "10 N"), Field(gt=0)]
Length = Annotated[Read[float], reader("a length", "m", "0.1 mm")]
PositiveLength = Annotated[Read[float], reader("a length", "m", "10 um"), Field(gt=0)]
Velocity = Annotated[Read[float], reader("a velocity", "m/s", "1 mm/s")]
Speed = Annotated[Read[float], reader("a velocity", "m/s", "1 mm/s"), Field(ge=0)]
PositiveSpeed = Annotated[Read[float], reader("a velocity", "m/s", "10 mm/s"), Field(gt=0)]
PerSpeed = Annotated[Read[float], reader("friction per slip speed", "s/m", "0.5 s/m"), Field(ge=0)]
Speeds = Annotated[
    Read[tuple[Speed, ...]], BeforeValidator(_as_list), "sequence of float (m/s) | str"
]
Coefficients = Annotated[
    Read[tuple[Coefficient, ...]], BeforeValidator(_as_list), "sequence of float"
]
Time = Annotated[Read[float], reader("a time", "s", "5 s")]
Duration = Annotated[Read[float], reader("a time", "s", "5 s"), Field(gt=0)]
Rate = Annotated[Read[float], reader("a frequency", "Hz", "10 kHz"), Field(gt=0)]
SampleRate = Annotated[Read[float], reader("a frequency", "Hz", "10 kHz"), Field(ge=0)]
# a count, or another whole number: 3, 3.0, one of NumPy, or text
Whole = Annotated[int, BeforeValidator(lambda value: value if type(value) is str else whole(value))]
