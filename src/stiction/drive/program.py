"""Drive velocity and normal load in time, composed of pieces."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from math import inf, pi
from operator import itemgetter
from typing import Annotated, Any, TypeGuard, TypeVar

import numpy as np
from pydantic import Field, model_validator

from stiction.drive.pieces import DRIVE_PIECES, LOAD_PIECES
from stiction.drive.reading import as_modulation, as_pieces
from stiction.drive.recorded.piece import RECORDS, Recorded
from stiction.drive.recorded.reading import checksum
from stiction.drive.recorded.spline import Recording
from stiction.drive.signal import Signal
from stiction.drive.steady import ConstantLoad, ConstantVelocity, VaryingLoad, VaryingVelocity
from stiction.errors import DescriptionError
from stiction.machine import shortage
from stiction.text.samples import FrozenColumn
from stiction.text.units import FORCE, VELOCITY, Read, Velocity, Whole
from stiction.text.validation import Described

Times = Any  # a float or an array
Repeat = Annotated[Whole, Field(ge=1, le=100_000)]
AT_REST = 0.1  # of the largest speed between two rows
TO_AND_FRO = 0.5  # of the way travelled
ROW = 40.0  # bytes of memory for a recorded row, each time it is gone through


PIECES = "sequence of pieces"
Program = TypeVar("Program", bound="DriveProgram | LoadProgram")


def refuse_repetition(of: Program) -> Program:
    """Return a program, unless it has no end to be repeated at, or more rows than fit into memory.

    Raises
    ------
    ValueError
        With the remedy.
    """
    if of.repeat > 1 and of.program and of.program[-1].duration is None:
        name = type(of.program[-1]).__name__.lower()
        raise ValueError(
            f"the last piece, {name}, has no end and cannot be repeated; "
            "give it a duration, or leave repeat out"
        )
    rows = sum(len(piece.time) for piece in of.program if isinstance(piece, RECORDS))
    if short := shortage(ROW * of.repeat * rows):
        raise ValueError(f"{of.repeat} times {rows} recorded rows {short}; thin the rows")
    return of


class DriveProgram(Described):
    """A drive whose velocity is composed of pieces in time, with harmonics on top.

    Parameters
    ----------
    velocity : float or str, optional
        The base velocity along X, m/s: the value of a `Constant` without one, and the start of
        the first piece; without pieces, the velocity at all times.
    program : sequence, optional
        The pieces one after the other from t = 0 on: `Constant`, `Step`, `Ramp`, `Hold`,
        `Reversal`, `Harmonic`, `Free`, `Recorded`. After the last piece, its final velocity stays.
    repeat : int, optional
        How often the program is gone through.
    along, across : Modulation, optional
        Harmonic velocity added along X and across it, from t = 0 on.

    Examples
    --------
    >>> import stiction as st
    >>> p = st.protocols
    >>> pieces = [p.Constant(duration="1 s"), p.Hold("0.5 s")]
    >>> test = p.DriveProgram(velocity="1 mm/s", program=pieces)
    >>> st.protocols.end(test)
    1.5
    """

    velocity: Velocity = 0.0
    program: Annotated[Read[tuple[Any, ...]], as_pieces(DRIVE_PIECES, VELOCITY), PIECES] = ()
    repeat: Repeat = 1
    along: Annotated[Any, as_modulation(VELOCITY), "Modulation | None"] = None
    across: Annotated[Any, as_modulation(VELOCITY), "Modulation | None"] = None

    _can_be_repeated = model_validator(mode="after")(refuse_repetition)

    @cached_property
    def stretches(self) -> tuple[tuple[float, Any], ...]:
        """The smooth stretches, each with its end (s) and its velocity."""
        sideways = modulate(Signal(0.0, 0.0), self.across)
        return tuple(
            (end, _velocity(modulate(signal, self.along), sideways))
            for end, signal in signals(self.program, self.repeat, self.velocity, still=0.0)
        )

    def simplest(self) -> ConstantVelocity | DriveProgram:
        """Return a steady drive if this program keeps to one velocity, else the program itself."""
        first = self.stretches[0][1]
        constant = isinstance(first, ConstantVelocity)
        return first if constant and all(each == first for _, each in self.stretches) else self

    def rate(self, t: Times) -> tuple[Any, Any]:
        """Return the velocity (X, Y) at `t`, in m/s; at a jump, the value before."""
        X, Y = pick(self.stretches, t, lambda stretch, at, _: stretch.rate(at))
        return X, Y

    def travel(self, t: float, dt: Times) -> tuple[Any, Any]:
        """Return the displacement (X, Y) from time `t` to `t + dt`, in m."""
        there, here = self._distance(t + np.asarray(dt)), self._distance(t)
        return there[0] - here[0], there[1] - here[1]

    def _distance(self, t: Times) -> tuple[Any, Any]:
        """Return the displacement (X, Y) since t = 0, in m."""
        starts, X, Y = self._milestones
        times = np.asarray(t, dtype=np.float64)
        which = np.searchsorted(starts[1:], times, side="left")
        part = pick(
            self.stretches, times, lambda stretch, at, start: stretch.travel(start, at - start)
        )
        return X[which] + part[0], Y[which] + part[1]

    @cached_property
    def _milestones(self) -> tuple[Any, Any, Any]:
        """The start of each stretch (s), and the drive's displacement until then (X, Y; m)."""
        rows = [(0.0, 0.0, 0.0)]
        for end, stretch in self.stretches[:-1]:
            start, X, Y = rows[-1]
            part = stretch.travel(start, end - start)
            rows.append((end, X + float(part[0]), Y + float(part[1])))
        starts, X, Y = np.array(rows).T
        return starts, X, Y

    def to_table(self) -> dict[str, Any]:
        """Return the table [drive] of a description."""
        return table_of(self, DRIVE_PIECES)


class LoadProgram(Described):
    """A normal load that changes in time, composed of pieces, with a harmonic on top.

    Parameters
    ----------
    program : sequence, optional
        The pieces one after the other from t = 0 on: `Constant`, `Step`, `Ramp`, `Hold`,
        `Harmonic`, `RecordedLoad`; they start from the slider's ``normal_load``. The final value
        stays.
    repeat : int, optional
        How often the program is gone through.
    modulation : Modulation, optional
        A harmonic force added from t = 0 on.

    Examples
    --------
    >>> import stiction as st
    >>> p = st.protocols
    >>> load = p.LoadProgram(program=[p.Constant(duration="1 s"), p.Ramp("20 N", "1 s")])
    >>> slider = st.presets.nakano_popov_2020().replace(load=load)
    >>> run = st.simulate(slider, "0.1 s")
    >>> run.status.ok
    True
    """

    program: Annotated[Read[tuple[Any, ...]], as_pieces(LOAD_PIECES, FORCE), PIECES] = ()
    repeat: Repeat = 1
    modulation: Annotated[Any, as_modulation(FORCE), "Modulation | None"] = None

    _can_be_repeated = model_validator(mode="after")(refuse_repetition)

    def stretches_from(self, base: float) -> tuple[tuple[float, Any], ...]:
        """Return the smooth stretches for a base load (N): the end of each (s), and its load."""
        return tuple(
            (end, _load(modulate(signal, self.modulation)))
            for end, signal in signals(self.program, self.repeat, base, still=None)
        )

    def to_table(self) -> dict[str, Any]:
        """Return the table [load] of a description."""
        return table_of(self, LOAD_PIECES)


def nominal_velocity(drive: ConstantVelocity | DriveProgram) -> float:
    """Return the one velocity of a drive that others vary from, m/s; zero if there is none.

    That is the base velocity of a program, if a stretch has it or recorded pieces come with it.
    Without it, that of recorded pieces is their mean from the first motion to the last, if they
    come at least half as far as they travel. Else, of stretches that all go one way, it is that of
    the last; and the base velocity, if a harmonic varies it.

    Examples
    --------
    >>> import stiction as st
    >>> p = st.protocols
    >>> time = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]
    >>> stage = p.Recorded(time, position=[0.0, 0.0, 1e-3, 3e-3, 4e-3, 4e-3])
    >>> round(nominal_velocity(p.DriveProgram(program=[stage])), 9)
    0.001333333
    >>> nominal_velocity(p.DriveProgram(program=[p.Ramp("2 mm/s", "1 s")]))
    0.002
    """
    if isinstance(drive, ConstantVelocity):
        return drive.velocity
    courses = [course for _, course in drive.stretches]
    steady = [each.velocity for each in courses if isinstance(each, ConstantVelocity)]
    recorded = [
        moving_rows(piece.recording(0.0)) for piece in drive.program if isinstance(piece, Recorded)
    ]
    if drive.velocity and (recorded or drive.velocity in steady):
        return drive.velocity
    if recorded:
        times, ways = (np.concatenate(each) for each in zip(*recorded, strict=True))
        come, travelled = float(np.sum(ways)), float(np.sum(np.abs(ways)))
        return come / float(np.sum(times)) if abs(come) > TO_AND_FRO * travelled else 0.0
    moving = [each for each in steady if each]
    if moving and isinstance(courses[-1], ConstantVelocity):
        return moving[-1] if min(moving) * max(moving) > 0.0 else 0.0
    return drive.velocity


def refuse_idle_base(drive: ConstantVelocity | DriveProgram, changed: Iterable[str]) -> None:
    """Refuse to change a program's base velocity if no piece uses it.

    Raises
    ------
    DescriptionError
        If ``drive.velocity`` is among the changed paths, and changes nothing.
    """
    if "drive.velocity" not in changed or isinstance(drive, ConstantVelocity):
        return
    if not drive.program or any(isinstance(piece, Recorded) for piece in drive.program):
        return
    other = drive.model_copy(update={"velocity": drive.velocity + 1.0})
    if other.stretches == drive.stretches:
        raise DescriptionError.of(
            "drive.velocity",
            "changes nothing, since each piece of the program states its velocity; change that of "
            "a piece, such as drive.program.1.value",
        )


def moving_rows(recording: Recording) -> tuple[Any, Any]:
    """Return durations (s) and travels (m) between rows, without rest before and after them."""
    times, ways = np.diff(recording.rows), np.diff(recording.sums)
    speeds = np.abs(ways / times)
    moves = np.flatnonzero(speeds > AT_REST * speeds.max(initial=0.0))
    inside = slice(moves[0], moves[-1] + 1) if len(moves) else slice(0, 0)
    return times[inside], ways[inside]


def signals(
    program: Sequence[Any], repeat: int, base: float, still: float | None
) -> Iterator[tuple[float, Signal | Recording]]:
    """Yield the stretches of a program: the end of each (s), and its signal.

    A hold has the value `still`, or the present one if that is None.
    """
    start, present = 0.0, base
    for piece in tuple(program) * repeat:
        if isinstance(piece, RECORDS):
            recording = piece.recording(start)
            start = float(recording.rows[-1])
            yield start, recording
            present = float(recording.value_at(start))
            continue
        end = inf if piece.duration is None else start + piece.duration
        value, slope, amplitude, omega, phase = piece.shape(
            base, present, present if still is None else still
        )
        signal = Signal(start, value, slope, amplitude, omega, phase - omega * start)
        yield end, signal
        if end == inf:
            return
        start, present = end, signal.value_at(end)
    yield inf, Signal(start, present)


def fastest_turn(program: DriveProgram | LoadProgram) -> float:
    """Return the frequency (Hz) of the quickest alternation of pieces; 0 if there is none.

    Three pieces in a row make one, as do two that are repeated: a short step and its way back come
    once.
    """
    lasts = [inf if piece.duration is None else piece.duration for piece in program.program]
    if program.repeat > 1:
        lasts += lasts[:2] if len(lasts) > 1 else lasts * 2
    turns = zip(lasts, lasts[1:], lasts[2:], strict=False)
    return max((1.0 / (b + max(a, c)) for a, b, c in turns), default=0.0)


def modulate(signal: Any, modulation: Any) -> Any:
    """Return a signal or a recording with a modulation on top."""
    if modulation is None:
        return signal
    if isinstance(signal, Recording):
        return signal._replace(wave=modulate(signal.wave, modulation))
    omega = 2 * pi * modulation.frequency
    return signal._replace(
        amplitude_2=modulation.amplitude, omega_2=omega, phase_2=modulation.phase
    )


def _velocity(along: Signal | Recording, across: Signal) -> Any:
    """Return the simplest type that describes a stretch, which computes fastest."""
    if _flat(along) and _flat(across) and across.value == 0.0:
        return ConstantVelocity._make([along.value])  # not validated again
    return VaryingVelocity(along, across)


def _load(force: Signal | Recording) -> Any:
    if _flat(force) and force.value > 0.0:
        return ConstantLoad._make([force.value])
    return VaryingLoad(force)


def _flat(signal: Signal | Recording) -> TypeGuard[Signal]:
    if not isinstance(signal, Signal):
        return False
    return signal.slope == signal.amplitude == signal.amplitude_2 == 0.0


def pick(stretches: Sequence[tuple[float, Any]], t: Times, value: Any) -> tuple[Any, ...]:
    """Return values in time, each from the stretch that contains the time or ends at it.

    ``value(stretch, times, start)`` computes them; `start` is the beginning of the stretch.
    """
    times = np.asarray(t, dtype=np.float64)
    if times.ndim == 0:  # which a run asks for some times in each stretch
        i = bisect_left(stretches, times, key=itemgetter(0))
        start = stretches[i - 1][0] if i > 0 else 0.0
        return tuple(np.float64(x) for x in value(stretches[i][1], times[()], start))
    if len(stretches) == 1:
        found = value(stretches[0][1], times, 0.0)
        return tuple(np.full(times.shape, column) for column in found)
    ends = np.array([end for end, _ in stretches])
    which = np.searchsorted(ends, times.ravel(), side="left")
    order = np.argsort(which, kind="stable")
    columns: list[Any] = []
    for i, inside in zip(*_group(which[order], order), strict=True):
        start = ends[i - 1] if i > 0 else 0.0
        for n, column in enumerate(value(stretches[i][1], times.ravel()[inside], start)):
            if n == len(columns):
                columns.append(np.empty(times.size))
            columns[n][inside] = column
    return tuple(column.reshape(times.shape)[()] for column in columns)


def _group(which: Any, order: Any) -> tuple[Any, list[Any]]:
    """Return the distinct values of a sorted array, and the part of `order` for each."""
    kinds, first = np.unique(which, return_index=True)
    return kinds, np.split(order, first[1:])


def table_of(program: Described, known: Mapping[str, type[Any]]) -> dict[str, Any]:
    """Return the fields of a program that differ from their defaults, as a table."""
    names = {kind: name for name, kind in known.items()}
    table: dict[str, Any] = {}
    for name in program.model_fields_set:
        value = getattr(program, name)
        if name == "program":
            value = [{"piece": names[type(piece)], **describe_piece(piece)} for piece in value]
        elif hasattr(value, "_asdict"):
            value = describe_piece(value)
        if value is not None:
            table[name] = value
    return table


def describe_piece(piece: Any) -> dict[str, Any]:
    """Return a piece's parameters, ready to be read: angles with a unit, None left out.

    Recorded rows are lists, with a checksum.
    """
    values = {name: value for name, value in piece._asdict().items() if value is not None}
    if isinstance(piece, RECORDS):
        values = {n: v.tolist() if isinstance(v, FrozenColumn) else v for n, v in values.items()}
        values["checksum"] = checksum(values)
    if "phase" in values:
        values["phase"] = f"{values['phase']!r} rad"
    return values
