"""The objects that a user's function reads outside itself, by name and value.

These are the variables of its module or notebook, the functions that it calls, and all that these
read. A constant has its value as text, and an object of an installed package its name. Any other
object, such as an open file, is refused, as nobody could say whether it has changed.
"""

from __future__ import annotations

import dis
import hashlib
import re
import sys
import sysconfig
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import fields, is_dataclass
from enum import Enum
from functools import lru_cache, partial
from pathlib import Path
from types import CodeType, FunctionType, MethodType, ModuleType
from typing import Any, NamedTuple

import numpy as np

SCALARS = type(None), type(...), bool, int, float, complex, str, bytes, range, Enum, np.dtype
SHOWN = {"datetime", "decimal", "fractions", "pathlib", "uuid"}  # modules of values, whole in repr
LISTS = (tuple, list, set, frozenset)
LONGEST = 60  # characters of a value that is written out; of a longer one stands a hash
BEGINS_CHAIN = {
    *("LOAD_GLOBAL", "LOAD_NAME", "LOAD_DEREF", "LOAD_CLASSDEREF"),
    *("LOAD_FROM_DICT_OR_GLOBALS", "LOAD_FROM_DICT_OR_DEREF"),
}
CONTINUES_CHAIN = {"LOAD_ATTR", "LOAD_METHOD"}
VECTORISED = {"DUFunc", "GUFunc"}  # of numba, which keep the values with which they are compiled
OF_TUPLES = {"_fields", "_field_defaults"}  # which an instance has, too
OF_ENUMS = re.compile("_[a-z0-9]\\w*_")  # names that Python keeps for itself in enumerations

OF = " of "  # between a name and the function that reads it

Own = type | FunctionType


class Dependency(NamedTuple):
    """An object that a function reads.

    Parameters
    ----------
    path : str
        Its name for the user, such as ``c``, ``helpers.c`` or ``c of scale``.
    token : str or FunctionType
        Its value as text; of a function, the Python function.
    value : Any
        The object; a function as it was found, compiled or not.
    room : mapping or None
        The variables of the module or notebook among which it was found by its name.
    """

    path: str
    token: str | FunctionType
    value: Any
    room: Mapping[str, Any] | None = None


class Dependencies:
    """Everything that a class or function reads, in a fixed order, and its own functions first."""

    def __init__(self, owner: Own) -> None:
        """Begin with the owner."""
        self._owner = owner
        self._functions: list[tuple[FunctionType, str]] = []  # and where they are, for messages
        self._visited: set[Any] = set()

    def __iter__(self) -> Iterator[Dependency]:
        """Yield one after the other.

        Raises
        ------
        ValueError
            At an object that is neither a constant, a function nor of a package.
        """
        if isinstance(self._owner, type):
            yield from self._of_class(self._owner, "")
        else:
            own = plain_function(self._owner)
            yield Dependency(own.__name__, own, self._owner)
            self._functions.append((own, ""))
        while self._functions:
            function, inside = self._functions.pop(0)
            if function in self._visited:
                continue
            self._visited.add(function)
            for name, value, room in variables(function):
                first, *rest = self._of(f"{name}{OF}{inside}" if inside else name, value)
                yield first._replace(room=room)
                yield from rest

    def _of(self, path: str, value: Any) -> Iterator[Dependency]:
        """Yield an object and its parts; the functions among them come later."""
        given, value = value, plain_function(value)
        if (said := package_name(value) or constant_text(value)) is not None:
            yield Dependency(path, said, given)
        elif isinstance(value, FunctionType):
            if type(given).__name__ in VECTORISED and _reads_values(value):
                raise ValueError(f"{path}, a function of numba.vectorize that reads variables")
            yield Dependency(path, value, given)
            self._functions.append((value, value.__qualname__))
        elif isinstance(value, type):
            yield Dependency(path, f"class {value.__qualname__}", value)
            yield from self._of_class(value, path)
        elif (parts := _parts(path, value)) is not None:
            yield Dependency(path, type(value).__qualname__, value)
            if id(value) not in self._visited:
                self._visited.add(id(value))
                for inner, each in parts:
                    yield from self._of(inner, each)
        else:
            kind = f"{type(value).__module__}.{type(value).__qualname__}"
            raise ValueError(f"{path}, a {kind.removeprefix('builtins.').removeprefix('_io.')}")

    def _of_class(self, kind: type, path: str) -> Iterator[Dependency]:
        """Yield the functions and constants of a class, also inherited ones."""
        if kind in self._visited:
            return
        self._visited.add(kind)
        start = f"{kind.__qualname__}." if path else ""
        for base in reversed(kind.__mro__):
            for name, raw in () if is_of_package(base.__module__) else vars(base).items():
                given = getattr(raw, "fget", getattr(raw, "__func__", raw))
                value = plain_function(given)
                if isinstance(value, FunctionType):
                    if value.__module__ == base.__module__:  # not made by NamedTuple
                        yield Dependency(start + name, value, given)
                        self._functions.append((value, path and value.__qualname__))
                elif _is_constant(name, raw):
                    yield from self._of(start + name, value)


def _reads_values(function: FunctionType) -> bool:
    """Return whether a function reads anything but functions."""
    return any(isinstance(each.token, str) for each in Dependencies(function))


def _is_constant(name: str, value: Any) -> bool:
    """Return whether a member of a class is a value of its own, which nothing computes."""
    hidden = name.startswith(("__", "_abc_")) or name in OF_TUPLES or OF_ENUMS.fullmatch(name)
    return not (hidden or hasattr(value, "__get__"))


def _parts(path: str, value: Any) -> list[tuple[str, Any]] | None:
    """Return the parts of an object that is nothing but these; None if it is more."""
    kind, (name, of, function) = type(value), path.partition(OF)
    inner: dict[str, Any]
    if isinstance(value, MethodType):
        inner = {"": value.__func__, ".__self__": value.__self__}
    elif isinstance(value, partial):
        inner = {"": value.func, "()": value.args, "(**)": value.keywords}
    elif kind in LISTS:
        inner = {f"[{i}]": each for i, each in enumerate(value)}
    elif kind is dict:
        inner = {f"[{key!r}]": each for key, each in value.items()}
    elif (names := _field_names(value)) is not None:
        inner = {"": kind, **{f".{each}": getattr(value, each) for each in names}}
    else:
        return None
    return [(f"{name}{key}{of}{function}", each) for key, each in inner.items()]


def _field_names(value: Any) -> Iterable[str] | None:
    """Return the names of the fields of a record: a named tuple, a dataclass, or a model."""
    if is_dataclass(value):
        return [each.name for each in fields(value)]
    found: Iterable[str] | None = getattr(
        type(value), "_fields", getattr(type(value), "model_fields", None)
    )
    return found


def constant_text(value: Any) -> str | None:
    """Return the value of a constant as text, short or as a hash; None if it is none.

    >>> constant_text((0.5, "rough")), constant_text(open)
    ("(0.5, 'rough')", None)
    """
    text = _constant_text(value)
    if text is None or len(text) <= LONGEST:
        return text
    return f"{type(value).__name__} {short_hash(text)}"


def _constant_text(value: Any) -> str | None:
    kind = type(value)
    if isinstance(value, SCALARS) or kind.__module__.partition(".")[0] in SHOWN:
        return repr(value) if kind.__module__ == "builtins" else f"{kind.__qualname__} {value!r}"
    if isinstance(value, np.generic) and not value.dtype.hasobject:
        return f"{value.dtype} {value.item()!r}"
    if isinstance(value, np.ndarray) and not value.dtype.hasobject:
        return f"{value.dtype} {value.shape} {short_hash(value.tobytes())}"
    if isinstance(value, re.Pattern):
        return f"pattern {value.pattern!r} {value.flags}"
    if kind is dict:
        inner = [_constant_text(each) for pair in value.items() for each in pair]
    elif kind in LISTS or (isinstance(value, tuple) and is_of_package(kind.__module__)):
        inner = [_constant_text(each) for each in value]
    else:
        return None
    known = [each for each in inner if each is not None]
    known = sorted(known) if kind in (set, frozenset) else known
    name = "" if kind is tuple else kind.__qualname__
    return f"{name}({', '.join(known)})" if len(known) == len(inner) else None


def package_name(value: Any) -> str | None:
    """Return the name of a module, or of a function or class of a package; None for others."""
    if type(value).__module__ == "logging":  # which changes no result
        return "logger"
    if isinstance(value, ModuleType):
        return f"module {value.__name__}"
    name, module = getattr(value, "__name__", None), getattr(value, "__module__", None)
    if isinstance(value, np.ufunc):
        module = "numpy"
    elif not callable(value):
        return None
    if not isinstance(name, str) or not isinstance(module, str) or not is_of_package(module):
        return None
    whole = getattr(value, "__qualname__", name)
    return f"{module}.{whole}" if _is_found(value, module, whole) else None


def _is_found(value: Any, module: str, name: str) -> bool:
    """Return whether a package has an object by this name, or it is a function without a state.

    What a package makes of a user's function, such as ``np.vectorize(f)``, has its name alone.
    """
    if isinstance(value, type) or (isinstance(value, FunctionType) and not value.__closure__):
        return True
    homes = (module, "scipy.special") if isinstance(value, np.ufunc) else (module,)
    for home in homes:
        there: Any = sys.modules.get(home)
        for part in name.split("."):
            there = getattr(there, part, None)
        if there is value:
            return True
    return False


@lru_cache(maxsize=1024)
def is_of_package(module: str) -> bool:
    """Return whether a module belongs to Python, to this package, or to an installed one."""
    top = module.partition(".")[0]
    if top == "__main__":
        return False
    if top == "stiction" or top in sys.stdlib_module_names:
        return True
    file = getattr(sys.modules.get(module) or sys.modules.get(top), "__file__", None)
    if not isinstance(file, str):
        return False
    homes = {sysconfig.get_path(name) for name in ("purelib", "platlib", "stdlib")}
    return any(Path(home) in Path(file).parents for home in homes)


def plain_function(value: Any) -> Any:
    """Return the Python function of one that numba has compiled, or a package has wrapped."""
    inner = getattr(value, "py_func", None)
    if inner is None and not isinstance(value, type) and is_of_package(_home(value)):
        inner = getattr(value, "__wrapped__", None)
    return plain_function(inner) if callable(inner) else value


def _home(value: Any) -> str:
    """Return the module that a function's code, or an object's class, is of."""
    room = getattr(value, "__globals__", None)
    return str(type(value).__module__ if room is None else room.get("__name__", ""))


def variables(function: FunctionType) -> Iterator[tuple[str, Any, Mapping[str, Any] | None]]:
    """Yield name, value and room of the variables that a function reads, and its defaults."""
    cells = dict(zip(function.__code__.co_freevars, function.__closure__ or (), strict=True))
    room = function.__globals__
    for chain in chains(function.__code__):
        name, *rest = chain
        if name in cells:
            try:
                value, place = cells[name].cell_contents, None
            except ValueError:  # not set yet
                continue
        elif name in room:
            value, place = room[name], room
        else:
            continue  # a built-in function, or missing, which Python tells
        while rest and isinstance(value, ModuleType) and not is_of_package(value.__name__):
            name = f"{name}.{rest[0]}"
            value, place = getattr(value, rest.pop(0), None), None
        yield name, value, place
    defaults = [*(function.__defaults__ or ()), *(function.__kwdefaults__ or {}).values()]
    if defaults:
        yield f"defaults of {function.__name__}", tuple(defaults), None


@lru_cache(maxsize=1024)
def chains(code: CodeType) -> tuple[tuple[str, ...], ...]:
    """Return the variables that code reads, each with the attributes that it takes of it.

    >>> chains(compile("a.b.c + f(d)", "", "eval"))
    (('a', 'b', 'c'), ('f',), ('d',))
    """
    found: list[list[str]] = []
    going = False
    for each in dis.get_instructions(code):
        if each.opname in BEGINS_CHAIN and each.argval not in code.co_cellvars:
            found.append([str(each.argval)])
        elif going and each.opname in CONTINUES_CHAIN:
            found[-1].append(str(each.argval))
        else:
            going = False
            continue
        going = True
    inner = (each for each in code.co_consts if isinstance(each, CodeType))
    nested = (chain for each in inner for chain in chains(each) if chain[0] not in code.co_cellvars)
    return tuple(dict.fromkeys((*map(tuple, found), *nested)))


def short_hash(text: str | bytes) -> str:
    """Return the first digits of a hash."""
    return hashlib.sha256(text.encode() if isinstance(text, str) else text).hexdigest()[:16]
