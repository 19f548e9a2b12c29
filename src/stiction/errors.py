"""What can go wrong, and how a run ended."""

from __future__ import annotations

from collections.abc import Sequence
from enum import Enum
from typing import NamedTuple

LONGEST = 2000  # characters of a message; more would hide what it says


def one_line(error: BaseException) -> str:
    """Return another's error in one line."""
    return " ".join(f"{type(error).__name__}: {error}".split())[:LONGEST]


def visible(text: str) -> str:
    """Return a text with each character that a terminal would act on written out: ``\\x1b``.

    Names and values in a file are its writer's choice.
    """
    return "".join(x if x.isprintable() or x == "\n" else ascii(x)[1:-1] for x in text)


class StictionError(Exception):
    """Any error that this package raises on purpose; its text is meant for the user."""

    def __str__(self) -> str:
        """Return the text, of which nothing acts on a terminal."""
        return visible(super().__str__())


class Fault(NamedTuple):
    """One thing wrong with a description: where it is, and what to write instead."""

    path: str
    message: str

    def __str__(self) -> str:
        """Return ``path: message``, not longer than can be read."""
        text = f"{self.path}: {self.message}" if self.path else self.message
        return (
            text if len(text) <= LONGEST else f"{text[: LONGEST // 2]} ... {text[-LONGEST // 2 :]}"
        )


class DescriptionError(StictionError, ValueError):
    """A description that cannot be simulated, with every fault in it at once.

    Attributes
    ----------
    faults : tuple of Fault
        Each fault with its path, in the order in which the description is read.
    """

    def __init__(self, faults: Sequence[Fault]) -> None:
        """Join the faults to one message, a line each."""
        self.faults = tuple(faults)
        super().__init__("\n".join(str(fault) for fault in self.faults))

    def __reduce__(self) -> tuple[type[DescriptionError], tuple[tuple[Fault, ...]]]:
        """Pickle by the faults, not by the text."""
        return type(self), (self.faults,)


class ResultError(StictionError, ValueError):
    """A file that is not a result of this package, or does not hold what is asked of it."""


class Status(Enum):
    """How a run ended; each value is the message that explains it.

    The order is the contract with the compiled loop, which returns the position in `STATUSES`.
    """

    COMPLETED = "the run reached its duration"
    STEP_UNDERFLOW = (
        "no step, however short, met the tolerance: the friction law has a jump or is not a "
        "number here, or the parameters cannot belong together; check them, or loosen rtol"
    )
    NON_FINITE = (
        "the state became infinite or not a number; check the parameters "
        "for magnitudes that cannot belong together"
    )
    TOO_MANY_STEPS = "the run used up its max_steps; raise max_steps or shorten the duration"
    CONTACT_LOST = "the normal load fell to zero and the contact was lost; keep it above zero"

    @property
    def ok(self) -> bool:
        """Whether the run came to its intended end."""
        return self is Status.COMPLETED


STATUSES = tuple(Status)
