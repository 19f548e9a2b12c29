"""Kinds of motion as stores keep them: by their index."""

from __future__ import annotations

from stiction.analysis.motion.regime import kinds

KINDS = (
    kinds.UNDETERMINED,
    kinds.STUCK,
    kinds.STICK_SLIP,
    kinds.TRANSITIONAL,
    kinds.HARMONIC,
    kinds.SETTLING,
    kinds.STEADY,
    kinds.TRANSVERSE,
    kinds.IRREGULAR,
)  # stores keep their indices: append new ones
FORMERLY = {
    "between stick-slip and harmonic vibration": kinds.TRANSITIONAL,
    "damped approach": kinds.SETTLING,
    "song": kinds.TRANSVERSE,
}
