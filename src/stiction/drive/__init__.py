"""What pulls and what presses: motion of the drive, and normal load, in time.

A drive moves in the laboratory plane (X along the nominal drive direction, Y across it).
A program is composed of pieces; the solver takes it as smooth stretches, one after the
other. What an accelerated drive does depends on which body it drives, see `Slider`.
"""

from __future__ import annotations

from itertools import pairwise
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
    for (end, before), (_, after) in pairwise(stretches):
        if end == t:
            (X, Y), (X_before, Y_before) = after.rate(t), before.rate(t)
            return X - X_before, Y - Y_before
    return 0.0, 0.0


def load_stretches(normal_load: float, program: LoadProgram | None) -> Stretches:
    """Return the smooth stretches of a normal load, as `drive_stretches`."""
    if program is None:
        return ((inf, ConstantLoad(normal_load)),)
    return program.stretches(normal_load)


def load_at(normal_load: float, program: LoadProgram | None, t: Any) -> Any:
    """Return the normal load at `t` (float or array, s), in N; before the jump where it jumps."""
    return pick(load_stretches(normal_load, program), t, lambda load, at: (load.at(at),))[0]


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
    "drive_stretches",
    "jump",
    "load_at",
    "load_stretches",
    "read_drive",
    "read_load",
]
