"""Arguments that a message suggests, as whoever reads the message writes them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any, NamedTuple


class Suggestion(NamedTuple):
    """An argument that a message suggests: put it into an f-string.

    It appears as the outermost edge writes it (`suggest`): as an option on the
    command line, and otherwise as an argument of a function in Python.

    Parameters
    ----------
    name : str
        Of the argument in Python; the option has the same.
    value : optional
        An example, or the value that helps; True of an option without value, a mapping of an
        option NAME=VALUE.
    of : str
        The function that takes it; '' for the function that was called.

    Examples
    --------
    >>> message = f"say {Suggestion('force_across', '3=mN')}"
    >>> message, f"or {Suggestion('trust', True, of='')}"
    ("say force_across='3=mN' of st.read_record", 'or trust=True')
    """

    name: str
    value: Any = None
    of: str = "st.read_record"

    def __str__(self) -> str:
        """Return the text at this edge."""
        return (_edge.get() or as_argument_elsewhere)(self)


TRUST = Suggestion("trust", True, of="")
_edge: ContextVar[Callable[[Suggestion], str] | None] = ContextVar("edge", default=None)


@contextmanager
def suggest(form: Callable[[Suggestion], str]) -> Iterator[None]:
    """Write suggestions in this form, unless a caller has chosen one: the outermost edge decides.

    >>> with suggest(as_option), suggest(as_argument):
    ...     print(Suggestion("decimal", "comma"))
    --decimal comma
    """
    token = _edge.set(_edge.get() or form)
    try:
        yield
    finally:
        _edge.reset(token)


def as_argument(its: Suggestion) -> str:
    """Return an argument of the function that was called.

    >>> as_argument(Suggestion("block", 1)), as_argument(Suggestion("normal_load"))
    ('block=1', 'normal_load')
    """
    return its.name if its.value is None else f"{its.name}={its.value!r}"


def as_argument_elsewhere(its: Suggestion) -> str:
    """Return an argument and, unless it was the one that was called, its function."""
    return f"{as_argument(its)} of {its.of}" if its.of else as_argument(its)


def as_option(its: Suggestion) -> str:
    """Return an option of the command.

    >>> as_option(Suggestion("force_across", "3=mN")), as_option(Suggestion("trust", True))
    ("--force-across '3=mN'", '--trust')
    >>> as_option(Suggestion("block", 1)), as_option(Suggestion("at", {"NAME": "VALUE"}))
    ('--block 1', "--at 'NAME=VALUE'")
    >>> print(as_option(Suggestion("position", "Mohr's gauge=mm")))
    --position "Mohr's gauge=mm"
    """
    option = f"--{its.name.replace('_', '-')}"
    if its.value is None or its.value is True:
        return option
    value = "=".join(*its.value.items()) if isinstance(its.value, dict) else str(its.value)
    quote = "" if value.isalnum() else '"' if "'" in value else "'"
    return f"{option} {quote}{value}{quote}"
