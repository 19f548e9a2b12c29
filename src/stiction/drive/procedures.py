"""Friction tests that have a name, each as the program that runs it.

>>> import stiction as st
>>> program = st.protocols.slide_hold_slide("10 um/s", ["1 s", "10 s"], slide="20 s")
>>> [type(piece).__name__ for piece in program.program]
['Constant', 'Hold', 'Constant', 'Hold', 'Constant']
>>> st.protocols.end(program)
71.0
"""

from __future__ import annotations

from typing import Any, NamedTuple

from stiction.arguments import is_list
from stiction.drive.pieces import Constant, Hold, Ramp, Reversal, Step
from stiction.drive.program import DriveProgram, LoadProgram
from stiction.drive.steady import ConstantVelocity
from stiction.errors import DescriptionError, Faults, echo
from stiction.text.units import FORCE, LENGTH, TIME, VELOCITY, Kind, Quantities, Quantity
from stiction.text.validation import read_number


def velocity_steps(
    velocities: Quantities,
    *,
    duration: Quantity | None = None,
    distance: Quantity | None = None,
) -> DriveProgram:
    """Return the program of a velocity-step test: one speed after the other, by jumps.

    Parameters
    ----------
    velocities : sequence of float or str
        The speeds of the drive, m/s.
    duration : float or str, optional
        How long each lasts, s.
    distance : float or str, optional
        How far the drive moves at each, m, in place of `duration`: friction evolves with slip.

    Examples
    --------
    >>> import stiction as st
    >>> program = st.protocols.velocity_steps(["1 um/s", "10 um/s", "1 um/s"], distance="0.1 mm")
    >>> [round(piece.duration, 9) for piece in program.program]
    [100.0, 10.0, 100.0]
    """
    if (duration is None) == (distance is None):
        raise _fault("duration", "give either the duration or the distance of each speed")
    several = Argument("velocities", velocities, VELOCITY, is_list=True)
    if duration is not None:
        speeds, [time] = _read(several, Argument("duration", duration, TIME, positive=True))
        times = [time] * len(speeds)
    else:
        speeds, [far] = _read(several, Argument("distance", distance, LENGTH, positive=True))
        if 0.0 in speeds:
            raise _fault("velocities", "a drive at rest covers no distance; give a duration")
        times = [far / abs(speed) for speed in speeds]
    first, *later = zip(speeds, times, strict=True)
    steps = [Step(to=speed, duration=time) for speed, time in later]
    return DriveProgram(velocity=first[0], program=[Constant(duration=first[1]), *steps])


def slide_hold_slide(velocity: Quantity, holds: Quantities, *, slide: Quantity) -> DriveProgram:
    """Return the program of slide-hold-slide: sliding, a hold, sliding, a longer hold, ...

    Parameters
    ----------
    velocity : float or str
        Of the drive while it slides, m/s.
    holds : sequence of float or str
        How long each hold lasts, s.
    slide : float or str
        How long it slides before each hold and after the last, s: long enough for friction to
        become steady.

    Examples
    --------
    >>> import stiction as st
    >>> test = st.protocols.slide_hold_slide("10 um/s", ["10 s", "100 s"], slide="5 s")
    >>> st.protocols.end(test)
    125.0
    """
    [V], [between], times = _read(
        Argument("velocity", velocity, VELOCITY),
        Argument("slide", slide, TIME, positive=True),
        Argument("holds", holds, TIME, positive=True, is_list=True),
    )
    pieces: list[Constant | Hold] = [Constant(duration=between)]
    for time in times:
        pieces += [Hold(time), Constant(duration=between)]
    return DriveProgram(velocity=V, program=pieces)


def reversal_loops(velocity: Quantity, travel: Quantity, *, loops: int = 3) -> DriveProgram:
    """Return the program of a reversal test: to and fro about the start, by jumps of the velocity.

    Parameters
    ----------
    velocity : float or str
        Speed of the drive, m/s.
    travel : float or str
        From one turn to the other, m.
    loops : int, optional
        How often it goes back and forth, after half a way to the first turn.

    Examples
    --------
    >>> import stiction as st
    >>> program = st.protocols.reversal_loops("1 mm/s", "10 mm", loops=1)
    >>> [piece.duration for piece in program.program]
    [5.0, 10.0, 10.0]
    """
    [V], [way] = _read(
        Argument("velocity", velocity, VELOCITY, positive=True),
        Argument("travel", travel, LENGTH, positive=True),
    )
    leg = way / V
    turns = [Reversal(duration=leg)] * (2 * loops)
    return DriveProgram(velocity=V, program=[Constant(duration=0.5 * leg), *turns])


def load_ramp(levels: Quantities, *, ramp: Quantity, hold: Quantity | None = None) -> LoadProgram:
    """Return the program of a load ramp: from the slider's load to each level in turn.

    Parameters
    ----------
    levels : sequence of float or str
        Normal loads, N.
    ramp : float or str
        How long each change takes, s.
    hold : float or str, optional
        How long each level is held, s; by default not at all.

    Examples
    --------
    >>> import stiction as st
    >>> load = st.protocols.load_ramp(["10 N", "20 N"], ramp="1 s", hold="2 s")
    >>> st.protocols.end(load)
    6.0
    """
    held = [] if hold is None else [hold]
    loads, [change], *rests = _read(
        Argument("levels", levels, FORCE, is_list=True),
        Argument("ramp", ramp, TIME, positive=True),
        *(Argument("hold", each, TIME, positive=True) for each in held),
    )
    pieces = [
        piece for load in loads for piece in (Ramp(load, change), *(Hold(time) for [time] in rests))
    ]
    return LoadProgram(program=pieces)


def end(*programs: ConstantVelocity | DriveProgram | LoadProgram | None) -> float | None:
    """Return the end of the last of some programs, s; None if they have no end.

    Examples
    --------
    >>> import stiction as st
    >>> st.protocols.end(st.protocols.slide_hold_slide("1 mm/s", ["10 s"], slide="5 s"))
    20.0
    """
    for each in programs:
        if not isinstance(each, ConstantVelocity | DriveProgram | LoadProgram | None):
            remedy = "give the drive or the load of a slider"
            raise _fault("programs", f"{echo(each)} is not a program; {remedy}")
    ends = [_end(each) for each in programs if isinstance(each, DriveProgram | LoadProgram)]
    known = [each for each in ends if each is not None]
    return max(known) if known else None


def _end(program: DriveProgram | LoadProgram) -> float | None:
    times = [piece.duration for piece in program.program]
    return None if not times or None in times else program.repeat * float(sum(times))


class Argument(NamedTuple):
    """A number, or a list of numbers, as it was given, and the condition on it."""

    path: str
    given: Any
    kind: Kind
    positive: bool = False
    is_list: bool = False


def _read(*asked: Argument) -> list[list[float]]:
    """Return the numbers of each argument in SI.

    Raises
    ------
    DescriptionError
        With every fault at once.
    """
    faults = Faults()
    found: list[list[float]] = [[] for _ in asked]
    for numbers, each in zip(found, asked, strict=True):
        with faults.of_part():
            for path, value in _each(each):
                with faults.of_part():
                    numbers.append(_number(path, value, each.kind, each.positive))
    faults.refuse()
    return found


def _each(asked: Argument) -> list[tuple[str, Any]]:
    """Return each number as it was given, and its path."""
    values = asked.given
    if not asked.is_list:
        return [(asked.path, values)]
    if not is_list(values) or not len(values):
        raise _fault(asked.path, f"{echo(values)} must be a list of at least one value")
    return [(f"{asked.path}.{i}", value) for i, value in enumerate(values, 1)]


def _number(path: str, value: Any, kind: Kind, positive: bool) -> float:
    number = read_number(path, value, kind)
    if positive and not number > 0.0:
        raise _fault(path, f"must be greater than 0, is {echo(value)}")
    return number


def _fault(path: str, message: str) -> DescriptionError:
    return DescriptionError.of(path, message)
