"""Drive velocity and normal load in time, composed of pieces."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from math import inf, pi
from typing import Annotated, Any

import numpy as np
from pydantic import Field

from stiction.drive.pieces import DRIVE_PIECES, LOAD_PIECES
from stiction.drive.reading import Reading, as_modulation, as_pieces
from stiction.drive.signal import Course, Loading, Signal, signal_at
from stiction.drive.steady import ConstantLoad, ConstantVelocity
from stiction.units import FORCE, VELOCITY, Velocity
from stiction.validation import Described

Times = Any  # a float or an array
Repeat = Annotated[int, Field(ge=1, le=100_000)]


class DriveProgram(Described):
    """A drive whose velocity is composed of pieces in time, with harmonics on top.

    Parameters
    ----------
    velocity : float or str, optional
        The base velocity along X, m/s: what a `Constant` without a value has, and what the
        first piece starts from; without pieces, the velocity for good.
    program : sequence, optional
        The pieces one after the other from t = 0 on: `Constant`, `Step`, `Ramp`, `Hold`,
        `Reversal`, `Harmonic`, `Free`. After the last one its final velocity stays.
    repeat : int, optional
        How often the program is gone through.
    along, across : Modulation, optional
        Harmonic velocity added along X and across it, from t = 0 on.
    """

    velocity: Velocity = 0.0
    program: Annotated[tuple[Any, ...], as_pieces(Reading(DRIVE_PIECES, VELOCITY))] = ()
    repeat: Repeat = 1
    along: Annotated[Any, as_modulation(VELOCITY)] = None
    across: Annotated[Any, as_modulation(VELOCITY)] = None

    @cached_property
    def stretches(self) -> tuple[tuple[float, Any], ...]:
        """The smooth stretches: when each ends (s), and what the solver takes for it."""
        sideways = waved(Signal(0.0, 0.0), self.across)
        return tuple(
            (end, _course(waved(signal, self.along), sideways))
            for end, signal in signals(self.program, self.repeat, self.velocity, still=0.0)
        )

    def rate(self, t: Times) -> tuple[Any, Any]:
        """Return the velocity (X, Y) at `t`, in m/s; before the jump where it jumps."""
        X, Y = pick(self.stretches, t, lambda course, at: course.rate(at))
        return X, Y

    def travel(self, t: float, dt: Times) -> tuple[Any, Any]:
        """Return the displacement (X, Y) from time `t` on for `dt`, in m."""
        there, here = self._distance(t + np.asarray(dt)), self._distance(t)
        return there[0] - here[0], there[1] - here[1]

    def _distance(self, t: Times) -> tuple[Any, Any]:
        X = Y = start = 0.0
        t = np.asarray(t, dtype=np.float64)
        for end, course in self.stretches:
            part = course.travel(start, np.clip(t, start, end) - start)
            X, Y, start = X + part[0], Y + part[1], end
        return X, Y

    def to_table(self) -> dict[str, Any]:
        """Return the table [drive] of a description."""
        return table_of(self, DRIVE_PIECES)


class LoadProgram(Described):
    """A normal load that changes in time, composed of pieces, with a harmonic on top.

    Parameters
    ----------
    program : sequence, optional
        The pieces one after the other from t = 0 on: `Constant`, `Step`, `Ramp`, `Hold`,
        `Harmonic`; they start from the slider's ``normal_load``, and end in what stays.
    repeat : int, optional
        How often the program is gone through.
    modulation : Modulation, optional
        A harmonic force added from t = 0 on.
    """

    program: Annotated[tuple[Any, ...], as_pieces(Reading(LOAD_PIECES, FORCE))] = ()
    repeat: Repeat = 1
    modulation: Annotated[Any, as_modulation(FORCE)] = None

    def stretches(self, base: float) -> tuple[tuple[float, Any], ...]:
        """Return the smooth stretches for a base load (N): end (s) and what the solver takes."""
        return tuple(
            (end, _loading(waved(signal, self.modulation)))
            for end, signal in signals(self.program, self.repeat, base, still=None)
        )

    def to_table(self) -> dict[str, Any]:
        """Return the table [load] of a description."""
        return table_of(self, LOAD_PIECES)


def signals(
    program: Sequence[Any], repeat: int, base: float, still: float | None
) -> Iterator[tuple[float, Signal]]:
    """Yield the stretches of a program: when each ends (s), and the signal until then.

    A hold has the value `still`, or the present one if that is None.
    """
    start, present = 0.0, base
    for piece in tuple(program) * repeat:
        end = inf if piece.duration is None else start + piece.duration
        value, slope, amplitude, omega, phase = piece.shape(
            base, present, present if still is None else still
        )
        signal = Signal(start, value, slope, amplitude, omega, phase - omega * start)
        yield end, signal
        if end == inf:
            return
        start, present = end, signal_at(signal, end)
    yield inf, Signal(start, present)


def waved(signal: Signal, modulation: Any) -> Signal:
    """Return a signal with a modulation on top."""
    if modulation is None:
        return signal
    omega = 2 * pi * modulation.frequency
    return signal._replace(
        amplitude_2=modulation.amplitude, omega_2=omega, phase_2=modulation.phase
    )


def _course(along: Signal, across: Signal) -> Any:
    """Return the plainest type that describes a stretch: it is the fastest to compute."""
    if _flat(along) and _flat(across) and across.value == 0.0:
        return ConstantVelocity(along.value)
    return Course(along, across)


def _loading(force: Signal) -> Any:
    return ConstantLoad(force.value) if _flat(force) and force.value > 0.0 else Loading(force)


def _flat(signal: Signal) -> bool:
    return signal.slope == signal.amplitude == signal.amplitude_2 == 0.0


def pick(stretches: Sequence[tuple[float, Any]], t: Times, value: Any) -> tuple[Any, ...]:
    """Return values in time from the stretch that holds each time, its end included."""
    times = np.asarray(t, dtype=np.float64)
    which = np.searchsorted([end for end, _ in stretches], times, side="left")
    columns: list[Any] = []
    for i in np.unique(which):
        inside = which == i
        for n, column in enumerate(value(stretches[i][1], times[inside])):
            if n == len(columns):
                columns.append(np.empty(times.shape))
            columns[n][inside] = column
    return tuple(column[()] for column in columns)


def table_of(program: Described, known: Mapping[str, type[Any]]) -> dict[str, Any]:
    """Return a program as a table that can be read back: what differs from its default."""
    names = {kind: name for name, kind in known.items()}
    table: dict[str, Any] = {}
    for name in program.model_fields_set:
        value = getattr(program, name)
        if name == "program":
            value = [{"piece": names[type(piece)], **written(piece)} for piece in value]
        elif hasattr(value, "_asdict"):
            value = written(value)
        if value is not None:
            table[name] = value
    return table


def written(piece: Any) -> dict[str, Any]:
    """Return a piece's parameters as they are read: an angle with its unit, nothing for None."""
    values = {name: value for name, value in piece._asdict().items() if value is not None}
    if "phase" in values:
        values["phase"] = f"{values['phase']!r} rad"
    return values
