"""Motion of the drive and normal load in time.

A drive moves in the laboratory plane (X along the nominal drive direction, Y across it).
A program consists of pieces; the solver takes it as a sequence of smooth stretches. The effect
of an accelerated drive depends on which body it moves, see `Slider`.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from math import inf
from typing import Any

from stiction.drive.program import DriveProgram as DriveProgram
from stiction.drive.program import LoadProgram as LoadProgram
from stiction.drive.program import pick
from stiction.drive.steady import ConstantLoad as ConstantLoad
from stiction.drive.steady import ConstantVelocity as ConstantVelocity
from stiction.drive.steady import VaryingLoad as VaryingLoad
from stiction.drive.steady import VaryingVelocity as VaryingVelocity

Drive = ConstantVelocity | DriveProgram
Stretches = tuple[tuple[float, Any], ...]


def drive_stretches(drive: Drive) -> Stretches:
    """Return the smooth stretches of a drive: the end of each (s), and its velocity."""
    return ((inf, drive),) if isinstance(drive, ConstantVelocity) else drive.stretches


def jump(drive: Drive, t: float) -> tuple[float, float]:
    """Return the jump of a drive's velocity (X, Y) at time `t`, in m/s."""
    stretches = drive_stretches(drive)
    before = bisect_left(stretches, t, key=_end)
    if stretches[before][0] != t:
        return 0.0, 0.0
    (X, Y), (X_before, Y_before) = (stretches[i][1].rate(t) for i in (before + 1, before))
    return X - X_before, Y - Y_before


def ahead(stretches: Stretches, t: float) -> tuple[float, Any]:
    """Return the stretch that holds just after time `t`."""
    return stretches[bisect_right(stretches, t, key=_end)]


def _end(stretch: tuple[float, Any]) -> float:
    return stretch[0]


def load_stretches(normal_load: float, program: LoadProgram | None) -> Stretches:
    """Return the smooth stretches of a normal load, like `drive_stretches`."""
    if program is None:
        return ((inf, ConstantLoad._make((normal_load,))),)  # not validated: it comes from a slider
    return program.stretches_from(normal_load)


def load_at(normal_load: float, program: LoadProgram | None, t: Any) -> Any:
    """Return the normal load at `t` (float or array, s), in N; at a jump, the value before."""
    return pick(load_stretches(normal_load, program), t, lambda load, at, _: (load.at(at),))[0]


def read_drive(table: dict[str, Any]) -> Drive:
    """Read the table [drive] of a description; ``velocity`` alone means a constant drive."""
    if table.keys() <= {"velocity"} and table:
        return ConstantVelocity(**table)
    return DriveProgram(**table)


def read_load(table: dict[str, Any]) -> LoadProgram:
    """Read a description's table [load]."""
    return LoadProgram(**table)
