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
from typing import Any, cast

from stiction.own_code.dependencies import Dependencies, Own, chains, is_of_package, plain_function
from stiction.own_code.identity import identity, state_of

MODULE = "stiction_own_"  # and the identity: by this name numba finds a type in another process
_copies: dict[Any, type] = {}  # by class and state, and by identity
_renewed: dict[Any, tuple[Any, ...]] = {}  # by law and compiled function: what it read then
# modules of copies whose machine code another process cannot link: a helper that is compiled for
# stated types by itself, or calls itself, is a symbol of its own in it
unstored: set[str] = set()
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
    stale = []
    for each in Dependencies(owner):
        if hasattr(each.value, "py_func"):
            state = state_of(each.value.py_func)
            if _renewed.get(each.value) != state:
                _renewed[each.value] = state
                if any(isinstance(token, str) for _, token in state):
                    stale.append(each.value)
    _recompile(stale)


def _recompile(dispatchers: list[Any]) -> None:
    """Compile functions anew that may call each other: all are forgotten before the first is.

    What `Dispatcher.recompile` of numba does for one of them.
    """
    signatures = [list(each.overloads) for each in dispatchers]
    for each in dispatchers:
        each._make_finalizer()()
        each._reset_overloads()
        each._cache.flush()
    for each, its in zip(dispatchers, signatures, strict=True):
        may_compile, each._can_compile = each._can_compile, True
        try:
            for signature in its:
                each.compile(signature)
        finally:
            each._can_compile = may_compile


class Copying:
    """The copying of a class: each function and module that it reads is copied once.

    All copies are of a new module. Another process, which may know the original by another module's
    name, or not at all, reads the stored machine code by that of the copies.
    """

    def __init__(self, name: str) -> None:
        """Begin without copies, for a module of this name."""
        self._name = name
        self._made: dict[int, Any] = {}
        self._open: set[int] = set()  # whose variables are being copied

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
            if id(function) in self._open:
                unstored.add(self._name)
            return self._made[id(function)]
        plain: FunctionType = plain_function(function)
        room = {"__builtins__": builtins, "__name__": self._name}
        cells = tuple(map(self._cell, plain.__closure__ or ()))
        copy = FunctionType(plain.__code__, room, plain.__name__, plain.__defaults__, cells or None)
        copy.__kwdefaults__, copy.__qualname__ = plain.__kwdefaults__, plain.__qualname__
        copy.__module__ = self._name
        made: Any = copy if function is plain else _dispatcher(function, copy)
        self._made[id(function)] = made
        self._open.add(id(function))
        for name, *rest in chains(plain.__code__):
            if name in plain.__globals__:
                room[name] = self._variable(plain.__globals__[name], rest)
        self._open.discard(id(function))
        if function is not plain and not function._can_compile:  # for stated types only
            unstored.add(self._name)
            for each in function.nopython_signatures:
                made.compile(each)
            made.disable_compile()
        return made

    def _variable(self, value: Any, rest: list[str]) -> Any:
        """Return a variable for a copied function, which takes the attributes `rest` of it."""
        if isinstance(value, ModuleType) and not is_of_package(value.__name__):
            copy = self._made.setdefault(id(value), ModuleType(value.__name__))
            if rest and hasattr(value, rest[0]):
                setattr(copy, rest[0], self._variable(getattr(value, rest[0]), rest[1:]))
            return copy
        if not _is_user_s(value):
            return value
        if hasattr(value, "py_func"):
            return self._function(value)
        return self._plain(value) if isinstance(value, FunctionType) else value

    def _plain(self, function: FunctionType) -> FunctionType:
        """Return a plain function that numba compiles, or a copy of it with the values of now.

        numba knows it by the object, as `register_jitable` has told it.
        """
        if all(not isinstance(token, str) for _, token in state_of(function)):
            return function
        from numba.extending import register_jitable

        if id(function) not in self._made:
            register_jitable(self._function(function))
        return cast(FunctionType, self._made[id(function)])

    def _cell(self, cell: CellType) -> CellType:
        try:
            return CellType(self._variable(cell.cell_contents, []))
        except ValueError:  # it is empty
            return CellType()


def _is_user_s(value: Any) -> bool:
    """Return whether a value is a user's function, compiled or not."""
    plain = getattr(value, "py_func", value)
    return isinstance(plain, FunctionType) and not is_of_package(plain.__module__)


def _dispatcher(of: Any, function: FunctionType) -> Any:
    """Return a function to be compiled with the options of another one."""
    return type(of)(
        function, targetoptions=of.targetoptions, pipeline_class=of._compiler.pipeline_class
    )
