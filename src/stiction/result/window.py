"""Times within a run: a part of it, or a moment."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated

from stiction.errors import DescriptionError, Fault, ResultError, echo
from stiction.system.description import Description
from stiction.text.units import Quantity, Read, reader
from stiction.text.validation import Described, read_arguments

ROUNDED = 1e-12  # of the end of a window, as of the times of samples


class Moment(Described):
    """A time, s; that of a record may be negative, before a trigger."""

    time: Annotated[Read[float], reader("a time", "s", "2 s")]


def window_of(description: Description, window: Sequence[Quantity] | None) -> tuple[float, float]:
    """Return start and end of a part of a run, s.

    Raises
    ------
    ResultError
        If it is not a start and an end, or not a part of it.
    """
    first = description.initial.time
    last = first + description.run.duration
    return (first, last) if window is None else window_between(first, last, window, "run")


def window_between(
    first: float, last: float, window: Sequence[Quantity], whole: str
) -> tuple[float, float]:
    """Return start and end of a window, s, in a `whole` from `first` to `last`.

    Raises
    ------
    ResultError
        If it is not a start and an end, or not between these.
    """
    try:
        begins, ends = window
    except (TypeError, ValueError):
        raise ResultError(
            f"window must be a start and an end, is {echo(window)}; write for example (1, 2)"
        ) from None
    start, end = seconds(begins, "window"), seconds(ends, "window")
    if start >= end:
        raise ResultError(f"window must end after it starts, is {start:g} s to {end:g} s")
    if start < first or end > last + ROUNDED * abs(last):
        raise ResultError(
            f"{start:g} s to {end:g} s is not a part of the {whole}, {first:g} s to {last:g} s"
        )
    return start, min(end, last)


def time_in(description: Description, time: Quantity) -> float:
    """Return a time in a run, s.

    Raises
    ------
    ResultError
        If it is not in it.
    """
    (first, last), found = window_of(description, None), seconds(time, "at")
    if not first <= found <= last:
        raise ResultError(f"{found:g} s is not in the run, {first:g} s to {last:g} s")
    return found


def seconds(time: Quantity, argument: str) -> float:
    """Return a time, given as a number of seconds or with its unit, s.

    Parameters
    ----------
    time : float or str
        The time.
    argument : str
        The name of the argument that gives it, for the error.

    Raises
    ------
    ResultError
        If it has no unit of time.
    """
    try:
        return read_arguments(Moment, time=time).time
    except DescriptionError as error:
        faults = [Fault(argument, fault.message) for fault in error.faults]
        raise ResultError(str(DescriptionError(faults))) from None
