"""What pulls and what presses: motion of the drive, and normal load, in time.

A drive moves in the laboratory plane (X along the nominal drive direction, Y across it).
A program is composed of pieces; the solver takes it as smooth stretches, one after the
other. What an accelerated drive does depends on which body it drives, see `Slider`.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from math import inf
from typing import Any

from stiction.drive.pieces import (
    Constant,
    Free,
    Harmonic,
    Hold,
    Modulation,
    Ramp,
    Reversal,
    Step,
)
from stiction.drive.program import DriveProgram, LoadProgram, pick
from stiction.drive.signal import Course, Loading
from stiction.drive.steady import ConstantLoad, ConstantVelocity

Drive = ConstantVelocity | DriveProgram
Stretches = tuple[tuple[float, Any], ...]


def drive_stretches(drive: Drive) -> Stretches:
    """Return the smooth stretches of a drive: when each ends (s), and what the solver takes."""
    return ((inf, drive),) if isinstance(drive, ConstantVelocity) else drive.stretches


def jump(drive: Drive, t: float) -> tuple[float, float]:
    """Return by how much a drive's velocity (X, Y) jumps at time `t`, in m/s."""
    stretches = drive_stretches(drive)
    before = bisect_left(stretches, t, key=_end)
    if stretches[before][0] != t:
        return 0.0, 0.0
    (X, Y), (X_before, Y_before) = (stretches[i][1].rate(t) for i in (before + 1, before))
    return X - X_before, Y - Y_before


def ahead(stretches: Stretches, t: float) -> tuple[float, Any]:
    """Return the stretch that goes on after time `t`."""
    return stretches[bisect_right(stretches, t, key=_end)]


def _end(stretch: tuple[float, Any]) -> float:
    return stretch[0]


def load_stretches(normal_load: float, program: LoadProgram | None) -> Stretches:
    """Return the smooth stretches of a normal load, as `drive_stretches`."""
    if program is None:
        return ((inf, ConstantLoad._make((normal_load,))),)  # a slider's, which has been read
    return program.stretches(normal_load)


def load_at(normal_load: float, program: LoadProgram | None, t: Any) -> Any:
    """Return the normal load at `t` (float or array, s), in N; before the jump where it jumps."""
    return pick(load_stretches(normal_load, program), t, lambda load, at, _: (load.at(at),))[0]


def read_drive(table: dict[str, Any]) -> Drive:
    """Read a description's table [drive]; with ``velocity`` alone it is constant."""
    if table.keys() <= {"velocity"} and table:
        return ConstantVelocity(**table)
    return DriveProgram(**table)


def read_load(table: dict[str, Any]) -> LoadProgram:
    """Read a description's table [load]."""
    return LoadProgram(**table)


__all__ = [
    "Constant",
    "ConstantLoad",
    "ConstantVelocity",
    "Course",
    "Drive",
    "DriveProgram",
    "Free",
    "Harmonic",
    "Hold",
    "LoadProgram",
    "Loading",
    "Modulation",
    "Ramp",
    "Reversal",
    "Step",
    "ahead",
    "drive_stretches",
    "jump",
    "load_at",
    "load_stretches",
    "read_drive",
    "read_load",
]
