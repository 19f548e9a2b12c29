"""The package as plain Python: as lenient as compiled code, and open to changes in place."""

from __future__ import annotations

import importlib
import math
import sys
from collections.abc import Iterator
from pathlib import Path
from types import CodeType, FunctionType, ModuleType
from typing import Any

import numpy as np

FORGIVEN = ("acos", "asin", "cosh", "exp", "expm1", "log", "log1p", "log10", "sinh", "sqrt")


def forgiving() -> None:
    """Have functions of `math` return infinity or NaN where Python raises, as compiled code does.

    What has imported them already keeps the others. Nor do floats of NumPy warn, of which pytest
    would make errors.
    """
    np.seterr(all="ignore")
    for name in FORGIVEN:
        setattr(math, name, _forgiving(getattr(math, name)))


def _forgiving(strict: Any) -> Any:
    def forgiven(*numbers: float) -> float:
        try:
            return float(strict(*numbers))
        except OverflowError:
            return math.inf
        except ValueError:
            return math.nan

    return forgiven


def module_of(path: Path) -> str:
    """Return the name of the module that a source file below `src` makes."""
    parts = path.resolve().with_suffix("").parts
    parts = parts[len(parts) - parts[::-1].index("src") :]
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def change(path: Path, text: str) -> None:
    """Give a module's functions and constants, wherever they were imported, those of a text.

    Functions keep their identity and are given other code, named tuples other defaults. A constant
    is replaced in each module that holds it; what other modules have computed from it as they were
    imported stays.
    """
    module = importlib.import_module(module_of(path))
    fresh = dict(vars(module))
    exec(compile(text, str(path), "exec"), fresh)
    before = dict(vars(module))
    for name, old in before.items():
        if name.startswith("__"):
            continue
        new = fresh[name]
        if isinstance(old, type) and _own(old, module) and hasattr(old, "_field_defaults"):
            _take_defaults(old, new)
        pairs = list(_codes(old, new, module))
        for function, other in pairs:
            function.__code__ = other.__code__
            function.__defaults__ = other.__defaults__
        if not pairs and not isinstance(old, type | ModuleType) and repr(old) != repr(new):
            _replace(old, new)


def _codes(old: Any, new: Any, module: ModuleType) -> Iterator[tuple[FunctionType, FunctionType]]:
    """Yield the functions of a module in a value, beside those to take their code from."""
    old, new = _bare(old), _bare(new)
    if not _own(old, module):
        return
    if isinstance(old, FunctionType):
        if isinstance(old.__code__, CodeType):
            yield old, new
    elif isinstance(old, type):
        for name, each in vars(old).items():
            if name in vars(new):
                yield from _codes(each, vars(new)[name], module)


def _take_defaults(old: Any, new: Any) -> None:
    """Give a named tuple, and what validates its parameters, the defaults of another."""
    from stiction.text.validation import fields  # not before `forgiving`

    old._field_defaults, old.__new__.__defaults__ = new._field_defaults, new.__new__.__defaults__
    fields.cache_clear()


def _own(value: Any, module: ModuleType) -> bool:
    """Return whether a class or function is defined in a module."""
    return getattr(value, "__module__", None) == module.__name__


def _bare(value: Any) -> Any:
    """Return the function in a method or in what remembers results."""
    for name in ("__func__", "fget", "__wrapped__"):
        value = getattr(value, name, value)
    return value


def _replace(old: Any, new: Any) -> None:
    """Put a value in the place of another in all modules."""
    for module in list(sys.modules.values()):
        for name, value in list(vars(module).items()) if isinstance(module, ModuleType) else ():
            if value is old:
                setattr(module, name, new)
