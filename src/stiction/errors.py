"""Errors, and the status of a run."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from enum import Enum
from pathlib import Path
from reprlib import Repr
from shlex import quote
from typing import NamedTuple

LONGEST_MESSAGE = 2000  # characters of a message
LONGEST_PATH = 400  # characters of the path of a fault, or of a file
ECHOED = 80  # characters of a value in a message
ITEMS = 4  # of a list in a message
MOST_FAULTS = 100  # faults of a description in its message

_shortened = Repr()
_shortened.maxlevel = 3
_shortened.maxlist = _shortened.maxtuple = _shortened.maxset = _shortened.maxfrozenset = ITEMS
_shortened.maxdict = _shortened.maxdeque = _shortened.maxarray = ITEMS
_shortened.maxstring = _shortened.maxother = _shortened.maxlong = ECHOED + 2  # quotation marks


def one_line(error: BaseException) -> str:
    """Return the error of another library in one line."""
    return " ".join(f"{type(error).__name__}: {error}".split())[:LONGEST_MESSAGE]


def visible(text: str) -> str:
    """Escape the control characters of a text, which a terminal would act on: ``\\x1b``.

    Names and values in a file come from whoever wrote it.
    """
    return "".join(x if x.isprintable() or x == "\n" else ascii(x)[1:-1] for x in text)


def argument(path: str | Path) -> str:
    """Return a path as one argument of a command in a message: in quotes where it has blanks.

    Examples
    --------
    >>> argument("my.nc"), "my rigs" in argument("my rigs/my.nc")
    ('my.nc', True)
    """
    if os.name != "nt":
        return quote(str(path))
    from subprocess import list2cmdline

    return list2cmdline([str(path)])


def echo(value: object) -> str:
    """Return a value for a message: in one line, and shortened.

    Examples
    --------
    >>> echo("1 kg"), echo(range(3)), echo([0.5] * 100)
    ("'1 kg'", 'range(0, 3)', '[0.5, 0.5, 0.5, 0.5, ...]')
    >>> import numpy as np
    >>> echo(np.zeros(3)), echo(np.zeros(2000))
    ('array([0., 0., 0.])', '<2000 values>')
    """
    try:
        shape, size = getattr(value, "shape", None), getattr(value, "size", None)
        if shape and isinstance(size, int) and size > ITEMS:
            return f"<{size} values>"  # an array, which need not be printed to be shortened
        if shape == ():  # a number of NumPy
            value = value.item()  # type: ignore[attr-defined]
        text = " ".join(_shortened.repr(value).split())
    except Exception:  # the value is a stranger's, and so is its way to print itself
        text = f"a {type(value).__name__}"
    return without_middle(text, ECHOED + 2)  # with quotation marks


def without_middle(text: str, most: int) -> str:
    """Return a text of at most so many characters, without its middle."""
    half = (most - 3) // 2
    return text if len(text) <= most else f"{text[:half]}...{text[-half:]}"


_terminals: list[bool] = []  # of the process: an error of one of its threads is read there, too


@contextmanager
def in_terminal() -> Iterator[None]:
    """Write commands in messages, for who types commands; others read Python."""
    _terminals.append(True)
    try:
        yield
    finally:
        _terminals.pop()


class Instruction(NamedTuple):
    """An instruction in a message to its reader; put it into an f-string.

    Parameters
    ----------
    command : str
        In a terminal.
    call : str
        In Python.

    Examples
    --------
    >>> make = Instruction("write one with 'stiction run'", "run.save(path) writes one")
    >>> print(make)
    run.save(path) writes one
    >>> with in_terminal():
    ...     print(make)
    write one with 'stiction run'
    """

    command: str
    call: str

    def __str__(self) -> str:
        """Return the text for this reader to type."""
        return self.command if _terminals else self.call


class StictionError(Exception):
    """Base class of the package's errors; the text is meant for the user.

    Examples
    --------
    >>> import stiction as st
    >>> issubclass(st.DescriptionError, st.StictionError)
    True
    """

    def __str__(self) -> str:
        """Return the text with control characters escaped."""
        return visible(super().__str__())


class Fault(NamedTuple):
    """One fault of a description: its path, and the remedy."""

    path: str
    message: str

    def at(self, place: str = "") -> Fault:
        """Return the fault at another place than the class that found it.

        Examples
        --------
        >>> Fault("Slider.mass", "missing").at("slider").path, Fault("Wanted.noise", "").at().path
        ('slider.mass', 'noise')
        """
        inside = self.path.partition(".")[2]
        return Fault(".".join(part for part in (place, inside) if part), self.message)

    def __str__(self) -> str:
        """Return ``path: message``, shortened if very long."""
        path = without_middle(self.path, LONGEST_PATH)
        return without_middle(f"{path}: {self.message}" if path else self.message, LONGEST_MESSAGE)


class DescriptionError(StictionError, ValueError):
    """A description cannot be simulated; carries all of its faults.

    Attributes
    ----------
    faults : tuple of Fault
        Each fault with its path, in the order in which the description is read.

    Examples
    --------
    >>> import stiction as st
    >>> try:
    ...     st.presets.nakano_popov_2020().replace(mass="10 N", phi=1)
    ... except st.DescriptionError as error:
    ...     print([fault.path for fault in error.faults])
    ['Slider.mass', 'Slider.phi']
    """

    def __init__(self, faults: Sequence[Fault]) -> None:
        """Join the faults into one message, a line each."""
        self.faults: tuple[Fault, ...] = tuple(faults)
        lines = [str(fault) for fault in self.faults[:MOST_FAULTS]]
        if len(self.faults) > MOST_FAULTS:
            lines.append(f"and {len(self.faults) - MOST_FAULTS} more faults")
        super().__init__("\n".join(lines))

    @classmethod
    def of(cls, path: str, message: str) -> DescriptionError:
        """Return the error of a single fault.

        Examples
        --------
        >>> print(DescriptionError.of("phi", "missing"))
        phi: missing
        """
        return cls([Fault(path, message)])

    def at(self, place: str = "") -> DescriptionError:
        """Return the error with its faults at another place, see `Fault.at`."""
        return DescriptionError([fault.at(place) for fault in self.faults])

    def __reduce__(self) -> tuple[type[DescriptionError], tuple[tuple[Fault, ...]]]:
        """Pickle the faults, not the text."""
        return type(self), (self.faults,)


class ResultError(StictionError, ValueError):
    """A file is not a result of this package, or lacks the requested data.

    Examples
    --------
    >>> import stiction as st
    >>> try:
    ...     st.load("none.nc")
    ... except st.StictionError as error:
    ...     print(type(error).__name__)
    ResultError
    """


LISTED = 20  # faults of a file; the others are counted


class Faults:
    """Errors of parts that do not depend on each other, raised as one.

    Examples
    --------
    >>> faults = Faults()
    >>> for line in (3, 8):
    ...     with faults.of_part():
    ...         raise ResultError(f"line {line} is damaged")
    >>> faults.refuse()
    Traceback (most recent call last):
    stiction.errors.ResultError: line 3 is damaged
    line 8 is damaged
    """

    def __init__(self) -> None:
        """Begin without any."""
        self.found: list[StictionError] = []

    def add(self, message: str) -> None:
        """Note one fault."""
        self.found.append(ResultError(message))

    @contextmanager
    def of_part(self) -> Iterator[None]:
        """Keep the error of one part, and go on with the next."""
        try:
            yield
        except StictionError as error:
            self.found.append(error)

    def refuse(self) -> None:
        """Raise all errors as one, if there are any."""
        described = [error for error in self.found if isinstance(error, DescriptionError)]
        if described and len(described) == len(self.found):
            raise DescriptionError([*dict.fromkeys(x for error in described for x in error.faults)])
        lines = [*dict.fromkeys(line for each in self.found for line in str(each).splitlines())]
        if len(lines) > LISTED:
            lines = [*lines[:LISTED], f"and {len(lines) - LISTED} more faults"]
        if lines:
            kinds = {type(error) for error in self.found}
            of_file = any(issubclass(kind, ResultError | DescriptionError) for kind in kinds)
            raise (ResultError if of_file or len(kinds) > 1 else kinds.pop())("\n".join(lines))


class Status(Enum):
    """How a run ended; each value explains it.

    The order matters: the compiled loop returns a position in `STATUSES`.

    Examples
    --------
    >>> import stiction as st
    >>> st.simulate(st.presets.nakano_popov_2020(), "1 ms").status
    <Status.COMPLETED: 'the run reached its duration'>
    """

    COMPLETED = "the run reached its duration"
    STEP_UNDERFLOW = (
        "even the shortest step missed the tolerance: the friction law has a jump or is not a "
        "number here, or the parameters cannot belong together; check them, or loosen rtol"
    )
    NON_FINITE = (
        "the state became infinite or not a number; check the parameters "
        "for magnitudes that cannot belong together"
    )
    TOO_MANY_STEPS = "the run used up its max_steps; raise max_steps or shorten the duration"
    CONTACT_LOST = "the normal load fell to zero and the contact was lost; keep it above zero"
    TOO_MANY_STICKS = (
        "each stick interval is recorded, and no more of them fit into the memory of this machine; "
        "shorten the duration"
    )

    @property
    def ok(self) -> bool:
        """Whether the run reached its intended end."""
        return self is Status.COMPLETED


STATUSES = tuple(Status)
