"""Pieces of a program of drive velocity or normal load.

The method ``shape(base, present, still)`` returns the value over the piece's ``duration`` (s; None
for ever). It is given, in SI, the program's base value, the final value of the preceding piece, and
the value of a hold; jumps between pieces are instantaneous. A new piece is a class here and a line
in `DRIVE_PIECES` or `LOAD_PIECES`. Those that follow a table have ``recording(start)`` in place of
a shape.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import pi
from typing import Annotated, Any, NamedTuple

from pydantic import AfterValidator

from stiction.drive.recorded.piece import Recorded, RecordedLoad
from stiction.text.units import Duration, Rate, Read, reader, unread
from stiction.text.validation import validate

# a velocity or a force, depending on the program that contains the piece
Level = Annotated[Any, AfterValidator(unread), "float (m/s or N) | str"]
Phase = Annotated[Read[float], reader("an angle", "rad", "90 deg")]


class Shape(NamedTuple):
    """value + slope t + amplitude sin(omega t + phase), t from the piece's start."""

    value: float
    slope: float = 0.0
    amplitude: float = 0.0
    omega: float = 0.0
    phase: float = 0.0


@validate
class Constant(NamedTuple):
    """A constant value, reached by a jump.

    Parameters
    ----------
    value : float or str, optional
        Velocity or force; by default the program's base value.
    duration : float or str, optional
        s; by default the last piece lasts to the end.

    Examples
    --------
    >>> import stiction as st
    >>> st.protocols.Constant("1 mm/s", "2 s").duration
    2.0
    """

    value: Level | None = None
    duration: Duration | None = None

    def shape(self, base: float, present: float, still: float) -> Shape:
        """Return the constant."""
        return Shape(base if self.value is None else self.value)


@validate
class Step(NamedTuple):
    """A jump of the present value, then constant.

    Parameters
    ----------
    by : float or str, optional
        Change of velocity or of force.
    duration : float or str, optional
        s; by default the last piece lasts to the end.
    to : float or str, optional
        Velocity or force after the jump, in place of `by`.

    Examples
    --------
    >>> import stiction as st
    >>> p = st.protocols
    >>> pieces = [p.Constant(duration="1 s"), p.Step(to="2 mm/s")]
    >>> test = p.DriveProgram(velocity="1 mm/s", program=pieces)
    >>> float(test.rate(2.0)[0])
    0.002
    """

    by: Level | None = None
    duration: Duration | None = None
    to: Level | None = None

    def faults(self) -> Iterator[tuple[str, str]]:
        """Check that the jump is given once."""
        if (self.by is None) == (self.to is None):
            yield "by", "give either by or to: the change, or the value after it"

    def shape(self, base: float, present: float, still: float) -> Shape:
        """Return the value after the jump."""
        to: Any = self.to if self.by is None else present + self.by
        return Shape(to)


@validate
class Ramp(NamedTuple):
    """A straight line in time from the present value to another.

    Parameters
    ----------
    to : float or str
        Velocity or force at the end.
    duration : float or str
        s.

    Examples
    --------
    >>> import stiction as st
    >>> p = st.protocols
    >>> test = p.DriveProgram(velocity="0 m/s", program=[p.Ramp(to="2 mm/s", duration="2 s")])
    >>> float(test.rate(1.0)[0])
    0.001
    """

    to: Level
    duration: Duration

    def shape(self, base: float, present: float, still: float) -> Shape:
        """Return the line."""
        return Shape(present, (self.to - present) / self.duration)


@validate
class Hold(NamedTuple):
    """The drive stops at once (slide-hold-slide); a load stays as it is.

    Parameters
    ----------
    duration : float or str, optional
        s; by default the last piece lasts to the end.

    Examples
    --------
    >>> import stiction as st
    >>> p = st.protocols
    >>> pieces = [p.Constant(duration="1 s"), p.Hold("9 s")]
    >>> test = p.DriveProgram(velocity="1 mm/s", program=pieces)
    >>> [float(test.rate(t)[0]) for t in (0.5, 5.0)]
    [0.001, 0.0]
    """

    duration: Duration | None = None

    def shape(self, base: float, present: float, still: float) -> Shape:
        """Return the value of a hold."""
        return Shape(still)


@validate
class Free(NamedTuple):
    """The drive stops for good: the springs relax until the end of the run.

    Examples
    --------
    >>> import stiction as st
    >>> p = st.protocols
    >>> pieces = [p.Constant(duration="1 s"), p.Free()]
    >>> test = p.DriveProgram(velocity="1 mm/s", program=pieces)
    >>> float(test.rate(1.5)[0])
    0.0
    """

    duration: None = None

    def shape(self, base: float, present: float, still: float) -> Shape:
        """Return zero."""
        return Shape(0.0)


@validate
class Reversal(NamedTuple):
    """An instantaneous reversal of the present velocity.

    Parameters
    ----------
    duration : float or str, optional
        s; by default the last piece lasts to the end.

    Examples
    --------
    >>> import stiction as st
    >>> p = st.protocols
    >>> pieces = [p.Constant(duration="1 s"), p.Reversal("1 s")]
    >>> test = p.DriveProgram(velocity="1 mm/s", program=pieces)
    >>> float(test.rate(1.5)[0])
    -0.001
    """

    duration: Duration | None = None

    def shape(self, base: float, present: float, still: float) -> Shape:
        """Return minus the present value."""
        return Shape(-present)


@validate
class Harmonic(NamedTuple):
    """A harmonic about the present value: amplitude sin(2 pi frequency t + phase).

    Parameters
    ----------
    amplitude : float or str
        Of the velocity or of the force.
    frequency : float or str
        Hz.
    phase : str, optional
        Angle at the start of the piece, with its unit; zero by default.
    duration : float or str, optional
        s; by default the last piece lasts to the end.

    Examples
    --------
    >>> import stiction as st
    >>> p = st.protocols
    >>> pieces = [p.Harmonic("0.5 mm/s", "1 Hz", duration="2 s")]
    >>> test = p.DriveProgram(velocity="1 mm/s", program=pieces)
    >>> float(test.rate(0.25)[0])
    0.0015
    """

    amplitude: Level
    frequency: Rate
    phase: Phase = 0.0
    duration: Duration | None = None

    def shape(self, base: float, present: float, still: float) -> Shape:
        """Return the harmonic."""
        return Shape(present, 0.0, self.amplitude, 2 * pi * self.frequency, self.phase)


@validate
class Modulation(NamedTuple):
    """A harmonic on top of a whole program: amplitude sin(2 pi frequency t + phase).

    Parameters
    ----------
    amplitude : float or str
        Of the velocity or of the force.
    frequency : float or str
        Hz.
    phase : str, optional
        Angle at t = 0, with its unit; zero by default.

    Examples
    --------
    >>> import stiction as st
    >>> p = st.protocols
    >>> test = p.DriveProgram(velocity="1 mm/s", across=p.Modulation("0.1 mm/s", "50 Hz"))
    >>> test.across.frequency
    50.0
    """

    amplitude: Level
    frequency: Rate
    phase: Phase = 0.0


DRIVE_PIECES: dict[str, type[Any]] = {
    "constant": Constant,
    "step": Step,
    "ramp": Ramp,
    "hold": Hold,
    "reversal": Reversal,
    "harmonic": Harmonic,
    "free": Free,
    "recorded": Recorded,
}
LOAD_PIECES: dict[str, type[Any]] = {
    **{name: DRIVE_PIECES[name] for name in ("constant", "step", "ramp", "hold", "harmonic")},
    "recorded": RecordedLoad,
}
LEVELS = ("value", "by", "to", "amplitude")
