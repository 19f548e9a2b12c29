"""Copies of a user's law class for the compiler, one for each identity.

numba compiles a variable as the constant that it is at that time, once for each type of argument,
and never notices that it has changed. A copy has the values of its time, in its own functions and
in the compiled ones that they call, and is a type of its own.
"""

from __future__ import annotations

import builtins
import sys
from threading import Lock
from types import CellType, FunctionType, ModuleType
from typing import Any

from stiction.own_code.dependencies import Dependencies, Own, chains, is_of_package, plain_function
from stiction.own_code.identity import identity, state_of

MODULE = "stiction_own_"  # and the identity: by this name numba finds a type in another process
_copies: dict[Any, type] = {}  # by class and state, and by identity
_lock = Lock()


def class_to_compile(kind: type) -> type:
    """Return the copy of a class with the values of now.

    Raises
    ------
    ValueError
        If it reads an object whose identity is unknown.
    """
    key = kind, state_of(kind)
    with _lock:
        if _renewed.get(kind) != key[1]:
            _renewed[kind] = key[1]
            _renew(kind)
        if key not in _copies:
            name = identity(kind)
            if name not in _copies:
                _copies[name] = Copying(MODULE + name).class_(kind)
            _copies[key] = _copies[name]
        return _copies[key]


_renewed: dict[Any, tuple[Any, ...]] = {}  # by law and compiled function: what it read then


def renew(owner: Own) -> None:
    """Let compiled functions that a law calls, and Python too, have the values of now.

    Raises
    ------
    ValueError
        If it reads an object whose identity is unknown.
    """
    with _lock:
        _renew(owner)


def _renew(owner: Own) -> None:
    found = [each for each in Dependencies(owner) if hasattr(each.value, "py_func")]
    for each in reversed(found):  # first those that others call
        state = state_of(each.value.py_func)
        if _renewed.get(each.value) != state:
            _renewed[each.value] = state
            if any(isinstance(token, str) for _, token in state):
                each.value.recompile()


class Copying:
    """The copying of a class: each function and module that it reads is copied once.

    All copies are of a new module. Another process, which may know the original by another module's
    name, or not at all, reads the stored machine code by that of the copies.
    """

    def __init__(self, name: str) -> None:
        """Begin without copies, for a module of this name."""
        self._name = name
        self._made: dict[int, Any] = {}

    def class_(self, kind: type) -> type:
        """Return a copy of a class."""
        bases = [each for each in reversed(kind.__mro__) if not is_of_package(each.__module__)]
        members = {key: value for base in bases for key, value in vars(base).items()}
        for key, value in members.items():
            if _is_user_s(value):
                members[key] = self._function(value)
        members |= {"__module__": self._name, "__qualname__": kind.__name__}
        for key in ("__dict__", "__weakref__"):
            members.pop(key, None)
        copy = type(kind)(kind.__name__, kind.__bases__, members)
        module = sys.modules[self._name] = ModuleType(self._name)
        setattr(module, kind.__name__, copy)
        return copy

    def _function(self, function: Any) -> Any:
        """Return a copy of a function, compiled by numba if it is."""
        if id(function) in self._made:
            return self._made[id(function)]
        plain: FunctionType = plain_function(function)
        room = {"__builtins__": builtins, "__name__": self._name}
        cells = tuple(map(self._cell, plain.__closure__ or ()))
        copy = FunctionType(plain.__code__, room, plain.__name__, plain.__defaults__, cells or None)
        copy.__kwdefaults__, copy.__qualname__ = plain.__kwdefaults__, plain.__qualname__
        copy.__module__ = self._name
        made = self._made[id(function)] = copy if function is plain else _compiled(function, copy)
        for name, *rest in chains(plain.__code__):
            if name in plain.__globals__:
                room[name] = self._variable(plain.__globals__[name], rest)
        return made

    def _variable(self, value: Any, rest: list[str]) -> Any:
        """Return a variable for a copied function, which takes the attributes `rest` of it."""
        if isinstance(value, ModuleType) and not is_of_package(value.__name__):
            copy = self._made.setdefault(id(value), ModuleType(value.__name__))
            if rest and hasattr(value, rest[0]):
                setattr(copy, rest[0], self._variable(getattr(value, rest[0]), rest[1:]))
            return copy
        # numba knows plain functions by the object, as those of `register_jitable`
        return self._function(value) if hasattr(value, "py_func") and _is_user_s(value) else value

    def _cell(self, cell: CellType) -> CellType:
        try:
            return CellType(self._variable(cell.cell_contents, []))
        except ValueError:  # it is empty
            return CellType()


def _is_user_s(value: Any) -> bool:
    """Return whether a value is a user's function, compiled or not."""
    plain = getattr(value, "py_func", value)
    return isinstance(plain, FunctionType) and not is_of_package(plain.__module__)


def _compiled(dispatcher: Any, function: FunctionType) -> Any:
    """Return a function compiled with the options, and for the types, of another one."""
    copy = type(dispatcher)(
        function,
        targetoptions=dispatcher.targetoptions,
        pipeline_class=dispatcher._compiler.pipeline_class,
    )
    if not dispatcher._can_compile:  # for stated types only
        for each in dispatcher.nopython_signatures:
            copy.compile(each)
        copy.disable_compile()
    return copy
