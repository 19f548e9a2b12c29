"""The friction laws that descriptions know by name, and their compiled functions."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

from stiction.names import refuse_second

Kind = TypeVar("Kind", bound=type[Any])
Function = TypeVar("Function", bound=Callable[..., Any])

LAWS: dict[str, type[Any]] = {}  # by name
FUNCTIONS: list[Any] = []  # plain functions that laws call
METHODS: list[Any] = []  # functions that call a law's method of their name


def register(name: str) -> Callable[[Kind], Kind]:
    """Class decorator: descriptions know the law by this name, which no other law has."""

    def register(kind: Kind) -> Kind:
        refuse_second("law", name, LAWS.get(name, kind), kind)
        LAWS[name] = kind
        return kind

    return register


def called_by_laws(function: Function) -> Function:
    """Mark a plain function that laws call: it is compiled with them."""
    FUNCTIONS.append(function)
    return function


def called_by_type(function: Function) -> Function:
    """Mark a function that calls a law's method of its name: compiled, it is that method."""
    METHODS.append(function)
    return function
