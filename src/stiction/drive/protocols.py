"""Programs of the drive and of the normal load, and the pieces that they are composed of.

>>> import stiction as st
>>> st.protocols.Hold("3 s")
st.protocols.Hold(duration=3.0)
"""

from __future__ import annotations

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
from stiction.drive.program import DriveProgram, LoadProgram
from stiction.drive.steady import ConstantVelocity

__all__ = [
    "Constant",
    "ConstantVelocity",
    "DriveProgram",
    "Free",
    "Harmonic",
    "Hold",
    "LoadProgram",
    "Modulation",
    "Ramp",
    "Reversal",
    "Step",
]


def __dir__() -> list[str]:
    return sorted(__all__)
