"""The identity of a user's function: its text, and everything that it reads.

A law is compiled anew for each identity (`frozen`). A stored study or result holds the values that
the text leaves open; a change of one makes another study.
"""

from __future__ import annotations

import ast
import hashlib
import sys
from collections.abc import Iterator, Mapping
from functools import lru_cache
from types import CodeType, FunctionType, ModuleType
from typing import Any

from stiction.own_code.dependencies import (
    OF,
    Dependencies,
    Dependency,
    Own,
    constant_text,
    is_of_package,
    short_hash,
)
from stiction.own_code.source import bindings, definition, text_of

AS_TEXT = "as in the text"
REMEDY = (
    "and a change of it would go unnoticed; make it {place}, or a number, a text, a NumPy array, "
    "or a tuple, list or dict of these"
)


def state_of(owner: Own) -> tuple[tuple[str, Any], ...]:
    """Return a key for the present values of everything that a class or function reads."""
    if is_of_package(owner.__module__):
        return ()
    return tuple((each.path, each.token) for each in Dependencies(owner))


def values_outside(owner: Own) -> dict[str, str]:
    """Return the values that a class or function reads, and that its text leaves open.

    Raises
    ------
    ValueError
        If it reads an object whose identity is unknown.

    Examples
    --------
    >>> from math import sqrt
    >>> def measure(c):
    ...     def power(run): return sqrt(c)
    ...     return power
    >>> values_outside(measure(3))["c"]
    '3'
    """
    text, found = text_of(owner), dict[str, str]()
    for each in Dependencies(owner):
        if isinstance(each.token, str):
            if text is None or not _is_fixed(each, owner, text.text):
                found[each.path] = each.token
        else:
            lines = _lines(each.token)
            if text is None or lines is None or lines not in text.text:
                told = _text_of_code(each.token.__code__) if lines is None else lines
                found[each.path] = f"function {short_hash(told)}"
    return found


def identity(owner: Own) -> str:
    """Return a hash of the text of a class or function, and of everything that it reads."""
    text = text_of(owner)
    said = (owner.__qualname__, text.text if text else "", sorted(values_outside(owner).items()))
    return hashlib.sha256(repr(said).encode()).hexdigest()


def refuse_unknown(owner: Own, place: str) -> None:
    """Refuse a class or function that reads an object whose identity is unknown.

    Raises
    ------
    ValueError
        Which names the object, and proposes the `place` where it may be instead.
    """
    try:
        state_of(owner)
    except ValueError as error:
        raise ValueError(
            f"{owner.__qualname__} reads {error}, {REMEDY.format(place=place)}"
        ) from None


def differences(then: Mapping[str, str], now: Mapping[str, str]) -> str:
    """Return the differences between values read then and now, in words; '' for none.

    >>> differences({"c": "0.1"}, {"c": "0.2", "d": "1"})
    'c was 0.1 and is 0.2, d was as in the text and is 1'
    """
    names = (name for name in dict.fromkeys((*then, *now)) if then.get(name) != now.get(name))
    return ", ".join(
        f"{name} was {then.get(name, AS_TEXT)} and is {now.get(name, AS_TEXT)}" for name in names
    )


def _is_fixed(found: Dependency, owner: Own, text: str) -> bool:
    """Return whether the text of a class or function determines the value of a variable."""
    inside = any(each.__globals__ is found.room for each in _own_functions(owner))
    name = found.path.partition(OF)[0]
    statements = bindings(text).get(name, []) if inside else []
    if len(statements) != 1:
        return False
    match statements[0]:
        case ast.Assign(targets=[ast.Name()], value=node) | ast.AnnAssign(value=ast.expr() as node):
            try:
                return constant_text(ast.literal_eval(node)) == found.token
            except (ValueError, TypeError, RecursionError):
                return False
        case ast.ImportFrom(module=str(module), names=aliases, level=0):
            named = next(each.name for each in aliases if name in (each.asname, each.name))
            there = getattr(sys.modules.get(module), named, None)
            return is_of_package(module) and there is found.value
        case ast.Import():
            return isinstance(found.value, ModuleType)
        case ast.ClassDef():
            return isinstance(found.value, type)
    return False


def _own_functions(owner: Own) -> Iterator[FunctionType]:
    """Yield a function, or the functions of a class."""
    if isinstance(owner, FunctionType):
        yield owner
        return
    for base in owner.__mro__:
        yield from (each for each in vars(base).values() if isinstance(each, FunctionType))


@lru_cache(maxsize=1024)
def _lines(function: FunctionType) -> str | None:
    """Return the lines that define a function, or its class; None if they are unknown."""
    text = text_of(function)
    return definition(text.text, function.__qualname__.partition(".")[0]) if text else None


def _text_of_code(code: CodeType) -> str:
    """Return compiled code as text, without its place in a file."""
    consts = (
        _text_of_code(each) if isinstance(each, CodeType) else str(constant_text(each))
        for each in code.co_consts
    )
    names = (code.co_names, code.co_varnames, code.co_freevars, code.co_flags)
    return repr((code.co_code, *consts, *names))
