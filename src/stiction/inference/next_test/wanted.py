"""What a design is asked for: the present test, and what may be tried beside it."""

from __future__ import annotations

from typing import Annotated

from pydantic import AfterValidator, Field

from stiction.inference.features import USED
from stiction.text.units import Angle, Force, PositiveLength, PositiveSpeed
from stiction.text.validation import Described

ANGLES = ("2 deg", "5 deg")
SIMULATIONS = 2000  # rigs
LEAST = 100  # of them


def _with_force(channels: tuple[str, ...]) -> tuple[str, ...]:
    """Refuse channels that no test has, or a test without force."""
    if "force" not in channels or not set(channels) <= set(USED):
        raise ValueError(
            f"must be force, and any of {', '.join(USED[1:])}; is {', '.join(channels) or 'none'}"
        )
    return channels


class Wanted(Described):
    """The arguments of `stiction.design`, in SI."""

    channels: Annotated[tuple[str, ...], AfterValidator(_with_force)] = ("force",)
    angles: tuple[Angle, ...] = Field(ANGLES, validate_default=True)
    velocities: tuple[PositiveSpeed, ...] | None = None
    loads: tuple[Force, ...] | None = None
    noise: Force | None = None
    position_noise: PositiveLength | None = None
    simulations: Annotated[int, Field(ge=LEAST)] = SIMULATIONS
