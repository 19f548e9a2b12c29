"""Arguments of public functions: one of a wrong type is named when it makes the function fail.

A function asks no type of its arguments as long as it can work with them. When it fails, the
annotations in its signature tell whether an argument is to blame. This costs a call that succeeds
nothing, and an error of the function itself stays what it is. Two things come beforehand: a number
in place of a path is refused, and whole numbers are read, of whatever type they are.
"""

from __future__ import annotations

import ast
import builtins
import re
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence, Set, Sized
from contextlib import AbstractContextManager, nullcontext
from contextvars import ContextVar
from functools import partial, wraps
from inspect import Signature, isclass, signature, unwrap
from numbers import Integral, Real
from os import PathLike
from pkgutil import resolve_name
from typing import Any, TypeVar, cast, get_args

from stiction.errors import DescriptionError, Fault, Faults, StictionError, echo

F = TypeVar("F", bound=Callable[..., Any])
ANYTHING = {"Any", "object", "Unpack", "Literal"}  # values of a Literal have messages of their own
PLAIN: dict[str, Any] = {"float": Real, "int": Integral, "Path": PathLike, "None": type(None)}
NO_PATH = int, bytes  # yet the system takes a number for a file that is open, and closes it
FROM_ZERO = {"seed", "port"}  # other whole numbers count something: at least 1
IN_WORDS = {
    "float": "a number",
    "int": "a whole number",
    "str": "text",
    "bool": "True or False",
    "Path": "a path",
    "ArrayLike": "numbers",
    "Source": "a record, a run or a path",
    "Exportable": "a run, a record, an analysis",
    "Quantity": "a number or text with a unit",
    "Callable": "a function",
    "Ends": "two numbers or texts with units",
}


_doors: dict[Callable[..., Any], Callable[..., Any]] = {}  # one of a function with two names
_patient: set[Callable[..., Any]] = set()  # functions that call `end_reading`
_waiting: ContextVar[tuple[Fault, ...]] = ContextVar("_waiting", default=())


def read_together(function: F) -> F:
    """Decorate a public function that calls `end_reading` before it begins to work.

    So its whole numbers hide no fault of its other arguments.
    """
    _patient.add(function)
    return function


def refuse_last(wrong: Sequence[Fault], call: Callable[[], Any] | None) -> None:
    """Refuse whole numbers after what the call of a function that reads them together refuses."""
    found, token = Faults(), _waiting.set(tuple(wrong))
    try:
        with found.of_part():
            if call is not None:
                call()
    finally:
        _waiting.reset(token)
    with found.of_part():
        refuse(wrong)
    found.refuse()


def end_reading() -> None:
    """Raise the faults of whole numbers, as all other arguments are read now."""
    refuse(_waiting.get())


def doorway(function: Callable[..., Any], room: str, name: str) -> Callable[..., Any]:
    """Return a public function that names its wrong arguments if they make it fail.

    Parameters
    ----------
    function : callable
        The function.
    room, name : str
        Where users find it; there, pickle finds it again.

    Examples
    --------
    >>> import stiction as st
    >>> try:
    ...     st.check(5)
    ... except st.StictionError as error:
    ...     print(error)
    path: must be text or a path, is 5; see help(st.check)
    """
    if function in _doors:
        return _doors[function]
    hints = getattr(unwrap(function), "__annotations__", {})
    # what is not a description is refused by its reader, with a remedy of its own
    texts = {each: str(hint) for each, hint in hints.items() if "Description" not in str(hint)}
    paths = {each for each, hint in texts.items() if "Path" in hint}
    counts = [each for each, hint in texts.items() if is_whole(hint) and each != "return"]
    order = [*signature(function).parameters] if counts else []

    @wraps(function)
    def public(*args: Any, **values: Any) -> Any:
        wrong: list[Fault] = []
        if counts:
            read_args = (read(*each, wrong) for each in zip(order, args, strict=False))
            args = *read_args, *args[len(order) :]
            values = {name: read(name, value, wrong) for name, value in values.items()}
        if wrong:
            refuse_last(wrong, partial(public, *args, **values) if function in _patient else None)
        if paths and any(isinstance(each, NO_PATH) for each in (*args, *values.values())):
            refuse(each for each in faults(public, args, values, NO_PATH) if each.path in paths)
        try:
            with _underflow_to_zero():
                return function(*args, **values)
        except StictionError:
            raise
        except Exception:
            refuse(faults(public, args, values))
            raise

    def read(name: str, value: Any, wrong: list[Fault]) -> Any:
        try:
            return read_whole(name, value) if name in counts else value
        except ValueError as error:
            wrong.append(Fault(name, f"{error}{remedy(public)}"))
            return signature(function).parameters[name].default

    public.__module__, public.__qualname__ = room, name
    return _doors.setdefault(function, public)


def _underflow_to_zero() -> AbstractContextManager[None]:
    """Take tails of distributions for zero, also in a session whose NumPy raises an error then."""
    numpy = sys.modules.get("numpy")  # a session without it has set nothing
    return nullcontext() if numpy is None else numpy.errstate(under="ignore")


def name_arguments(function: F) -> F:
    """Decorate a public function of a module that is a room itself, as `stiction.theory` is."""
    return cast(F, doorway(function, function.__module__, function.__name__))


def is_whole(hint: str) -> bool:
    """Return whether an annotation allows whole numbers only, perhaps beside other types."""
    if "int" not in hint:  # most, and quickly
        return False
    names = {name_of(each) for each in members(ast.parse(hint, mode="eval").body)}
    return "int" in names and "float" not in names


def read_whole(name: str, value: Any) -> Any:
    """Return an argument that is a number as an integer; what is none, the function judges.

    Raises
    ------
    ValueError
        If the number is not whole, or too small.
    """
    if not isinstance(plain(value), Real):
        return value
    number, least = whole(value), 0 if name in FROM_ZERO else 1
    if number < least:
        raise ValueError(f"must be at least {least}, is {echo(number)}")
    return number


def plain(value: Any) -> Any:
    """Return a number of NumPy as one of Python, and all else as it is."""
    return value.item() if hasattr(value, "item") and getattr(value, "shape", None) == () else value


def whole(value: object) -> int:
    """Return a whole number as an integer, also one of NumPy, or a float.

    >>> import numpy as np
    >>> whole(np.int64(3)), whole(1e5)
    (3, 100000)

    Raises
    ------
    ValueError
        If it is none; True is none.
    """
    value = plain(value)
    if isinstance(value, float) and value.is_integer():
        return int(value)
    if isinstance(value, bool) or not isinstance(value, int):
        raise ValueError(f"must be a whole number, is {echo(value)}")
    return value


def address(public: Callable[..., Any]) -> str | None:
    """Return where a session finds a public function.

    >>> import stiction as st
    >>> address(st.protocols.end), address(st.presets.find), address(print)
    ('st.protocols.end', 'st.presets.find', None)
    """
    _, *rooms = public.__module__.split(".")
    name = public.__qualname__
    for path in [f"{room}.{name}" for room in (*rooms[::-1], ".".join(rooms)) if room] or [name]:
        try:
            if resolve_name(f"stiction:{path}") is public:
                return f"st.{path}"
        except AttributeError:
            continue
    return None


def remedy(public: Callable[..., Any]) -> str:
    """Return where a message says that more is to be read."""
    found = address(public)
    return "" if found is None else f"; see help({found})"


def refuse(faults: Iterable[Fault]) -> None:
    """Raise the faults, if there are any."""
    if found := [*faults]:
        raise DescriptionError(found) from None


def faults(
    public: Callable[..., Any],
    args: tuple[Any, ...],
    values: Mapping[str, Any],
    suspects: type | tuple[type, ...] = object,
) -> list[Fault]:
    """Return the arguments that are not of the type that the signature states.

    Only those of the classes `suspects` are examined.
    """
    shape, scope = signature(public), vars(builtins) | unwrap(public).__globals__
    try:
        given = shape.bind(*args, **values).arguments
    except TypeError:  # too many, or too few: Python's message says so
        return []
    return [
        Fault(name, f"must be {types_in_words(hint)}, is {value_in_words(value)}{remedy(public)}")
        for name, hint, value in pairs(shape, given)
        if isinstance(value, suspects) and not accepts(hint, value, scope)
    ]


def value_in_words(value: Any) -> str:
    """Return a wrong argument for a message; of data that were read from a file, that file."""
    encoding = getattr(value, "encoding", None)
    source = encoding.get("source") if isinstance(encoding, Mapping) else None
    if source is None:
        return echo(value)
    return f"{with_article(type(value).__name__)} from {echo(str(source))}: give that path"


def pairs(shape: Signature, given: Mapping[str, Any]) -> Iterator[tuple[str, ast.expr, Any]]:
    """Yield name, annotation and value of each argument that has an annotation."""
    for name, value in given.items():
        each = shape.parameters[name]
        if isinstance(each.annotation, str) and each.kind not in (
            each.VAR_POSITIONAL,
            each.VAR_KEYWORD,
        ):
            yield name, ast.parse(each.annotation, mode="eval").body, value


def members(hint: ast.expr) -> list[ast.expr]:
    """Return the members of a union."""
    if isinstance(hint, ast.BinOp):
        return [*members(hint.left), *members(hint.right)]
    return [hint]


def name_of(hint: ast.expr) -> str:
    """Return the name of a type: ``Dataset`` of ``xr.Dataset``, ``Sequence`` of a sequence."""
    inner = hint.value if isinstance(hint, ast.Subscript) else hint
    return re.split(r"[. ]", ast.unparse(inner))[-1]


def types_in_words(hint: ast.expr) -> str:
    """Return the types that an annotation allows, for a reader."""
    names = dict.fromkeys(name_of(each) for each in members(hint))
    texts = [IN_WORDS.get(name) or with_article(name) for name in names if name != "None"]
    return " or ".join(texts)


def with_article(name: str) -> str:
    """Return the name of a class with its article: ``an Analysis``."""
    name = name.lower() if name in ("Sequence", "Iterable", "Mapping") else name
    return f"an {name}" if name[0] in "AEIOaeio" else f"a {name}"


def accepts(hint: ast.expr, value: Any, scope: Mapping[str, Any]) -> bool:
    """Return whether a value may be of an annotated type; unknown types are left to the function.

    Classes count by their names: most annotations name classes that are not imported at run time.
    """
    return any(_is_of(name_of(each), each, value, scope) for each in members(hint))


def _is_of(name: str, hint: ast.expr, value: Any, scope: Mapping[str, Any]) -> bool:
    if name in ANYTHING or any(kind.__name__ == name for kind in type(value).__mro__):
        return True
    if name == "ArrayLike":
        return is_numeric(value)
    kind = PLAIN.get(name, scope.get(name))
    if name in ("Sequence", "Iterable") and isinstance(value, (str, bytes)):
        return isinstance(value, str) and "str" in ast.unparse(hint)
    alternatives = get_args(getattr(kind, "__value__", kind))
    if alternatives and not isclass(kind):  # an alias of a union
        return any(_is_instance(value, each) for each in alternatives if isclass(each))
    return isclass(kind) and _is_instance(value, kind)


def _is_instance(value: Any, kind: type) -> bool:
    """Return whether a value is of a class; the members of a protocol show when they are used."""
    try:
        return isinstance(value, kind)
    except TypeError:
        return True


def is_list(value: Any) -> bool:
    """Return whether a value is a list of values; text, bytes, mappings and sets are not.

    Examples
    --------
    >>> is_list(["1 mm/s"]), is_list((1.0, 2.0)), is_list("1 mm/s"), is_list(b"12"), is_list({1: 2})
    (True, True, False, False, False)
    """
    no_lists = str, bytes, bytearray, Mapping, Set
    return (
        isinstance(value, Sized) and isinstance(value, Iterable) and not isinstance(value, no_lists)
    )


def is_numeric(value: Any) -> bool:
    """Return whether a value is a number, or an array or a nested sequence of numbers."""
    import numpy as np

    try:
        return np.asarray(value).dtype.kind in "biuf"
    except (TypeError, ValueError):
        return False
