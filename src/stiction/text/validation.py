"""Turn pydantic's errors into faults: path, rule, offending value and remedy."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from difflib import get_close_matches
from functools import cache, partial
from inspect import Parameter, Signature, signature
from math import isinf
from numbers import Real
from typing import (
    TYPE_CHECKING,
    Annotated,
    Any,
    ClassVar,
    Self,
    TypeVar,
    cast,
    dataclass_transform,
    get_args,
    get_type_hints,
)

import numpy as np
from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    ValidationError,
    create_model,
)
from pydantic.fields import FieldInfo
from pydantic_core import ErrorDetails, PydanticCustomError

from stiction.arguments import with_article
from stiction.errors import DescriptionError, Fault, echo
from stiction.names import public_names, session_name
from stiction.text.quantity.exact import RIGID, angle_text
from stiction.text.units import (
    QUANTITY,
    SMALLEST_NUMBER,
    Kind,
    Radians,
    as_float,
    bare,
    fault,
    hints_of,
    kind_of,
    to_si,
    unit_of,
    unit_on,
)

if TYPE_CHECKING:
    from pydantic._internal._model_construction import ModelMetaclass
else:
    ModelMetaclass = type(BaseModel)

T = TypeVar("T")
FEWEST_LETTERS, MOST_NAMES = 3, 6  # letters that begin a name; names that are listed
MISSPELT = 0.8  # likeness of two names, from which on one is the other with an error in it
MISSING = "missing; it has no default"
READS = "reads_parameters"  # marks constructors made by `validate`


@dataclass_transform(kw_only_default=True, field_specifiers=(Field,))
class _Presented(ModelMetaclass):
    """Hides inherited library members of a class from `dir` and `help`."""

    def __dir__(self) -> list[str]:
        return _own_names(self, super().__dir__())


class Described(BaseModel, metaclass=_Presented):
    """A frozen part of a description; invalid values raise one `DescriptionError`."""

    model_config: ClassVar[ConfigDict] = ConfigDict(
        frozen=True, extra="forbid", arbitrary_types_allowed=True
    )
    # whether a field can be judged without the others: then a faulty one hides no fault of theirs
    _independent: ClassVar[bool] = False

    @classmethod
    def __pydantic_init_subclass__(cls, **_: Any) -> None:
        """Show names, units and defaults in the signature, not the validators."""
        hints, plain = hints_of(cls), get_type_hints(cls)
        parameters = [
            Parameter(
                name,
                Parameter.KEYWORD_ONLY,
                default=Parameter.empty if field.is_required() else field.default,
                annotation=_show_annotation(hints.get(name), plain.get(name)),
            )
            for name, field in cls.model_fields.items()
        ]
        required = sorted(parameters, key=lambda p: p.default is not Parameter.empty)
        setattr(cls, "__signature__", Signature(required))  # noqa: B010

    def __init__(self, *unnamed: Any, **values: Any) -> None:
        """Validate, or raise every fault at once."""
        name, known = type(self).__name__, type(self).model_fields
        if unnamed:
            remedy = f"write {name}({next(iter(known))}=...)"
            told = f"its values have names, {echo(unnamed[0])} has none; {remedy}"
            raise DescriptionError.of(name, told)
        collect(name, super().__init__, known, values, independent=self._independent)

    def __setattr__(self, name: str, value: Any) -> None:
        """Refuse to change a field, since values derived from it would remain."""
        if name in type(self).model_fields:
            remedy = f"write {type(self).__name__.lower()}.replace({name}={echo(value)})"
            raise DescriptionError.of(f"{type(self).__name__}.{name}", f"is frozen; {remedy}")
        super().__setattr__(name, value)

    def __eq__(self, other: object) -> bool:
        """Compare the fields; the library would compare derived values, too."""
        names = type(self).model_fields
        return type(self) is type(other) and all(
            equal(getattr(self, name), getattr(other, name)) for name in names
        )

    def replace(self, **changes: Any) -> Self:
        """Return the same with some fields changed: ``settings.replace(rtol=1e-4)``.

        Raises
        ------
        DescriptionError
            As if it was made anew.
        """
        stated = [name for name in self.own_fields() if name in self.model_fields_set]
        return type(self)(**(fields_to_read(self, stated) | changes))

    def model_copy(self, *, update: Mapping[str, Any] | None = None, deep: bool = False) -> Self:
        """Return a copy with other fields, without values derived from the old ones."""
        made = super().model_copy(update=update, deep=deep)
        for name in vars(made).keys() - type(made).model_fields.keys():
            del vars(made)[name]
        return made

    def __dir__(self) -> list[str]:
        """List the fields and the members of this package."""
        return _own_names(type(self), super().__dir__())

    def __repr__(self) -> str:
        """Return the call that makes an equal object."""
        hints = hints_of(type(self))
        fields = type(self).model_fields
        return _call(self, {name: hints.get(name) for name in self.own_fields()}, _defaults(fields))

    def own_fields(self) -> tuple[str, ...]:
        """Return the names of the fields that a description states; others follow from them."""
        return tuple(type(self).model_fields)

    def __str__(self) -> str:
        """Return the same as `repr`; the library would give angles without units."""
        return repr(self)


def fields_to_read(part: Any, names: Iterable[str]) -> dict[str, Any]:
    """Return fields of a part, ready to be read anew: angles with their unit.

    Of a part that was changed without a check, angles are plain numbers.
    """
    values = {name: getattr(part, name) for name in names}
    angles = (name for name in _angles_of(type(part)) if values.get(name) is not None)
    return values | {name: Radians(values[name]) for name in angles}


def _angles(kind: Any) -> tuple[str, ...]:
    """Return the names of the fields of a class that are angles."""
    return tuple(name for name, hint in hints_of(kind).items() if unit_of(hint) == "rad")


_angles_of: Callable[[Any], tuple[str, ...]] = cache(_angles)  # a study makes a slider for each run


def equal(one: object, other: object) -> bool:
    """Return whether two fields are equal; arrays are if all of their values are."""
    if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
        return np.array_equal(one, other, equal_nan=True)  # type: ignore[arg-type]
    return bool(distinct(one) == distinct(other))


def distinct(value: object) -> object:
    """Return a key that distinguishes values whose named tuples are of different classes.

    Named tuples of two classes are equal if their fields are, also inside another tuple.

    Examples
    --------
    >>> import stiction as st
    >>> distinct(st.protocols.Hold(1.0)) == distinct(st.protocols.Reversal(1.0))
    False
    """
    if not isinstance(value, tuple):
        return value
    if any(issubclass(kind, tuple) for kind in {*map(type, value)}):
        return type(value), *map(distinct, value)
    return type(value), tuple(value)  # quick, of a table with many points


def _own_names(cls: Any, names: Iterable[str]) -> list[str]:
    """Return the names except pydantic's."""
    own = {name for kind in cls.__mro__ if kind is not BaseModel for name in vars(kind)}
    inherited = {name for name in dir(BaseModel) if name.startswith("_") or name not in own}
    plain = {*dir(object), *(name for name in names if not name.startswith(("__", "model_")))}
    return sorted(plain - inherited | plain & {*dir(object)})


def _defaults(fields: Mapping[str, FieldInfo]) -> dict[str, Any]:
    return {name: field.default for name, field in fields.items() if not field.is_required()}


def _call(value: Any, hints: Mapping[str, Any], defaults: Mapping[str, Any]) -> str:
    """Return the call that makes a value: its fields that differ from their defaults."""
    written = []
    for name, hint in hints.items():
        its = getattr(value, name)
        default = defaults.get(name)
        same = type(its) is type(default) and its == default  # a default is never an array
        if name not in defaults or not same:
            written.append(f"{name}={quote(its, hint)}")
    return f"{session_name(type(value))}({', '.join(written)})"


def quote(value: Any, hint: Any) -> str:
    """Return a field's value as Python code; angles have units, arrays show their size."""
    if isinstance(value, float) and unit_of(hint) == "rad":
        return repr(angle_text(value))
    if isinstance(value, float) and isinf(value) and unit_of(hint) == "N/m":
        return repr(RIGID)
    if getattr(value, "shape", None) == ():  # a number of NumPy
        value = value.tolist()
    if not hasattr(value, "size"):
        return repr(value)
    from stiction.text.samples import FrozenColumn

    return repr(value if isinstance(value, FrozenColumn) else FrozenColumn(value))


class _Annotation(str):
    """Text in place of a type in a signature, shown without quotes."""

    __slots__ = ()

    def __repr__(self) -> str:
        return str(self)


def _show_annotation(hint: Any, plain: Any) -> Any:
    """Return the annotation of a parameter that a reader sees: accepted types and unit.

    `plain` is the type without its validator; a text in the annotation takes precedence.
    """
    none = " | None" if type(None) in get_args(plain) else ""
    texts = [
        item
        for part in (hint, *get_args(hint))
        for item in getattr(part, "__metadata__", ())
        if isinstance(item, str)
    ]
    kind = kind_of(hint)
    if texts:
        return _Annotation(texts[0] + ("" if texts[0].endswith(none) else none))
    if kind is None or not kind.unit:
        return Parameter.empty if plain in (None, Any) else plain
    if kind.unit == "rad":
        return _Annotation(f"str (deg or rad){none}")
    return _Annotation(f"float ({kind.unit}) | str{none}")


def faulty(found: Sequence[Fault]) -> PydanticCustomError:
    """Return one error for the faults inside one field, with their paths below it."""
    return PydanticCustomError("faults", "several faults", {"found": list(found)})


def collect(
    path: str,
    build: Callable[..., T],
    known: Iterable[str],
    values: Mapping[str, Any],
    *,
    independent: bool = False,
) -> T:
    """Call ``build(**values)``, turning a `ValidationError` into a `DescriptionError`.

    If fields are `independent`, those that are right are compared beside those that are not.
    """
    try:
        return build(**values)
    except ValidationError as error:
        found = faults(error, path, known)
    again = partial(collect, path, build, known, independent=independent)
    wrong = {fault.path.removeprefix(f"{path}.").partition(".")[0] for fault in found}
    comparable = values.keys() - wrong if independent else known
    raise DescriptionError(with_faults_of_known(found, again, comparable, values))


def with_faults_of_known(
    found: Sequence[Fault],
    build: Callable[[dict[str, Any]], object],
    known: Iterable[str],
    values: Mapping[str, Any],
) -> list[Fault]:
    """Return the given faults, and the contradictions among the valid values.

    Faults of the other values had prevented their comparison.
    """
    names = set(known)
    rest = {name: value for name, value in values.items() if name in names}

    def told(fault: Fault) -> bool:
        lacks = fault.message == MISSING and fault.path.partition(".")[2] in values
        return lacks or fault in found

    if len(rest) < len(values):
        try:
            build(rest)
        except DescriptionError as error:
            return [*found, *(each for each in error.faults if not told(each))]
    return [*found]


def read_arguments(kind: Callable[..., T], **given: Any) -> T:
    """Return the arguments of a function as their model has them; faults name the arguments."""
    try:
        return kind(**given)
    except DescriptionError as error:
        raise error.at() from None


def read_number(path: str, value: Any, kind: Kind) -> float:
    """Return a quantity in SI; a fault names its path."""
    from pydantic_core import PydanticCustomError

    try:
        return to_si(value, kind)
    except PydanticCustomError as error:
        raise DescriptionError.of(path, error.message()) from None


def faults(error: ValidationError, path: str, known: Iterable[str]) -> list[Fault]:
    """Return each fault of a pydantic error below `path`; `known` are the keys allowed there."""
    found = []
    for detail in error.errors():
        # lists count from 1
        keys = (str(key + 1) if isinstance(key, int) else key for key in detail["loc"])
        at = ".".join([path, *keys])
        if detail["type"] == "faults":
            found += [
                Fault(f"{at}.{inner.path}".rstrip("."), inner.message)
                for inner in detail["ctx"]["found"]
            ]
        else:
            found.append(Fault(at, _message(detail, tuple(known))))
    return found


def _message(detail: ErrorDetails, known: tuple[str, ...]) -> str:
    value = detail["input"]
    limit = detail.get("ctx", {})
    match detail["type"]:
        case "missing":
            return MISSING
        case "extra_forbidden":
            return unknown_name("key", str(detail["loc"][-1]), known)
        case "unexpected_keyword_argument":
            return unknown_name("parameter", str(detail["loc"][-1]), known)
        case "greater_than":
            if limit["gt"] == 0.0 and _is_positive(value):
                rule = f"must be greater than 0 (in SI, below {SMALLEST_NUMBER:g} counts as 0)"
                return f"{rule}, is {echo(value)}"
            return f"must be greater than {limit['gt']:g}, is {echo(value)}"
        case "greater_than_equal":
            return f"must not be below {limit['ge']:g}, is {echo(value)}"
        case "less_than_equal":
            return f"must not be above {limit['le']:g}, is {echo(value)}"
        case "less_than":
            return f"must be below {limit['lt']:g}, is {echo(value)}"
        case "int_parsing":
            return f"must be a whole number, is {echo(value)}"
        case "model_type" | "model_attributes_type" | "is_instance_of":
            kind = str(limit.get("class_name") or limit.get("class"))
            remedy = f"; make one with st.{kind}(...)" if kind in public_names("stiction") else ""
            return f"{echo(value)} is not {with_article(kind)}{remedy}"
        case "bool_type":
            return f"must be True or False, is {echo(value)}"
        case "string_type":
            return f"must be text, is {echo(value)}"
        case "dict_type":
            return f"must be a dict, is {echo(value)}"
        case "literal_error":
            return f"must be {limit['expected']}, is {echo(value)}"
        case "unit" | "value_error":
            return detail["msg"].removeprefix("Value error, ")
        case _:
            return f"{detail['msg']}, is {echo(value)}"


def _is_positive(value: object) -> bool:
    """Return whether a value, perhaps with a unit, is a number above 0."""
    found = QUANTITY.fullmatch(value) if isinstance(value, str) else None
    number = float(found[1].replace("−", "-")) if found else bare(value)
    return isinstance(number, int | float) and number > 0.0


def unknown_name(what: str, name: str, known: Iterable[str]) -> str:
    """Return the message for a name that is not `known`, with the nearest known one."""
    known = sorted(known)
    longer = [
        each
        for each in known
        if (len(name) >= FEWEST_LETTERS and each.startswith(name))
        or each.endswith(f".{name}")  # its path is lacking
        or name in re.split("[._]", each)  # or an index, or a word before it: mu, load
    ]
    longer = [each for each in longer if "." not in each or each.split(".")[-1] not in longer]
    near = longer if 0 < len(longer) <= MOST_NAMES else _nearest(name, known)
    meant = " or ".join(filter(None, (", ".join(map(repr, near[:-1])), *map(repr, near[-1:]))))
    remedy = f"did you mean {meant}?" if near else f"known: {', '.join(known)}"
    return f"unknown {what} {echo(name)}; {remedy}"


def _nearest(name: str, known: list[str]) -> list[str]:
    """Return the nearest known name; all of one stem if only the last word differs much."""
    if same := [each for each in known if each.lower() == name.lower()]:
        return same
    misspelt = get_close_matches(name, known, 1, MISSPELT)
    *stem, _ = re.split("[-_]", name)
    of_stem = [each for each in known if re.split("[-_]", each)[:-1] == stem]
    if not misspelt and len(stem) > 1 and 0 < len(of_stem) <= MOST_NAMES:
        return of_stem
    return misspelt or get_close_matches(name, known, 1)


def _no_faults(made: object) -> Iterable[tuple[str, str]]:
    return ()


@cache
def fields(kind: Any, only: tuple[str, ...] | None = None) -> type[Described]:
    """Return the model that validates the parameters of a NamedTuple `kind`, or some of them."""
    hints = {name: Plain if hint is float else hint for name, hint in hints_of(kind).items()}
    defaults = kind._field_defaults
    model: type[Described] = create_model(  # type: ignore[call-overload]
        kind.__name__,
        __base__=Described,
        **{
            name: (hints.get(name, Plain), defaults.get(name, ...))
            for name in (kind._fields if only is None else only)
        },
    )
    return model


def make(kind: type[T], values: Mapping[str, Any]) -> T:
    """Make a NamedTuple from a table of parameters, and check it.

    A plain float field takes a number in SI; one with a type of `stiction.text.units` reads
    units. The tuple need not be `validate`.
    """
    if hasattr(kind.__new__, READS):
        return kind(**values)
    model = fields(cast(Any, kind))(**values)
    return _check(kind(**{name: getattr(model, name) for name in type(model).model_fields}))


def in_si(value: T) -> T:
    """Read the fields of a NamedTuple that are text or carry a unit; numbers are in SI.

    A class with `validate` has read them already; another one takes them as they are given.
    """
    if hasattr(type(value).__new__, READS):
        return value
    given: dict[str, Any] = cast(Any, value)._asdict()
    texts = {name: each for name, each in given.items() if isinstance(each, str) or unit_on(each)}
    if not texts:
        return value
    model = fields(cast(Any, type(value)), tuple(texts))(**texts)
    return type(value)(**given | {name: getattr(model, name) for name in texts})


def _check(value: T) -> T:
    check: Callable[[T], Iterable[tuple[str, str]]] = getattr(type(value), "faults", _no_faults)
    name = type(value).__name__
    found = [Fault(f"{name}.{field}", message) for field, message in check(value)]
    if found:
        raise DescriptionError(found)
    return value


def _number(value: object) -> object:
    if isinstance(value, bool) or not isinstance(value, Real):
        raise fault(
            f"{echo(value)} is not a number; it is a plain float: write a number in SI, or "
            "annotate it with a type of stiction.text.units, e.g. PositiveSpeed"
        )
    return as_float(value)


Plain = Annotated[float, BeforeValidator(_number)]


def validate(kind: type[T]) -> type[T]:
    """Decorate a NamedTuple so that its constructor reads parameters with units.

    The compiled solver takes the tuple as it is: floats in SI. The tuple's annotated fields
    declare the parameters; a method ``faults`` may check them against each other, and yields a
    field and a message for each fault. Derived classes behave likewise.
    """
    plain: Any = kind.__new__
    names = tuple(signature(plain).parameters)[1:]

    def new(cls: type[T], *args: Any, **values: Any) -> T:
        given = dict(zip(names, args, strict=False)) | values
        if len(args) > len(names):
            raise TypeError(f"{cls.__name__} takes {', '.join(names)}")
        try:
            model = fields(cast(Any, cls))(**given)
        except DescriptionError as error:
            found = with_faults_of_known(error.faults, lambda rest: new(cls, **rest), names, given)
            raise DescriptionError(found) from None
        value: T = plain(cls, **{name: getattr(model, name) for name in names})
        return _check(value)

    new.__doc__ = plain.__doc__
    setattr(new, READS, True)
    setattr(new, "__signature__", _signature(plain, kind))  # noqa: B010
    setattr(kind, "__repr__", write_call)  # noqa: B010
    setattr(kind, "__eq__", _same)  # noqa: B010
    setattr(kind, "__ne__", _differs)  # noqa: B010
    setattr(kind, "__hash__", _hash)  # noqa: B010
    kind.__new__ = staticmethod(new)  # type: ignore[method-assign,assignment]
    setattr(kind, "__reduce__", _reduce)  # noqa: B010
    return kind


def _signature(constructor: Any, kind: Any) -> Signature:
    """Return the signature of a NamedTuple with accepted types and units."""
    hints, plain = hints_of(kind), get_type_hints(kind)
    return Signature(
        [
            each.replace(annotation=_show_annotation(hints[name], plain[name]))
            if name in hints
            else each
            for name, each in signature(constructor).parameters.items()
        ]
    )


def write_call(value: Any) -> str:
    """Return the call that makes an equal NamedTuple."""
    hints = hints_of(type(value))
    return _call(value, {name: hints.get(name) for name in value._fields}, value._field_defaults)


def _same(one: Any, other: object) -> bool:
    """Compare class and fields; tuples of two classes would be equal."""
    return bool(distinct(one) == distinct(other))


def _differs(one: Any, other: object) -> bool:
    return not _same(one, other)


def _hash(value: Any) -> int:
    return hash(distinct(value))


def _reduce(value: Any) -> tuple[Any, ...]:
    """Unpickle or copy values as they are, without reading them again."""
    return type(value)._make, (tuple(value),)
