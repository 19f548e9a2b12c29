"""The drive velocity of a rig whose records measured it, as their simulations take it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from stiction.analysis.drive.measured_drive import EvenDrive
from stiction.analysis.motion.metadata.quantity import ALIKE_VALUES
from stiction.analysis.record import Record
from stiction.drive import ConstantVelocity
from stiction.drive.program import nominal_velocity
from stiction.inference.observation import VELOCITY, drive_velocity
from stiction.inference.priors import Normal, Prior
from stiction.inference.rig import Rig
from stiction.text.quantity.wording import SLIGHT, in_words, with_error

SPREAD = 0.1587, 0.8413  # shares between which one standard deviation lies on either side


class DriveOfRecords(NamedTuple):
    """A rig with the drive velocity that its records show.

    Parameters
    ----------
    rig : Rig
        With that velocity, and with its error for the prior of it.
    said : str
        What is taken in place of what is stated, as a sentence; may be empty.
    doubt : str
        The contradiction, as a sentence, where what is stated is far off; may be empty.
    """

    rig: Rig
    said: str = ""
    doubt: str = ""


def with_measured_drive(rig: Rig, records: Sequence[Record]) -> DriveOfRecords:
    """Return a rig with the velocity that the displacement of the drive shows, in all records.

    The factor by which the velocity is off is that of all records; so that of the measured ones
    stands for it if each record has one, and if that is known better than what is stated.
    """
    shown = [each.even_drive() for each in records]
    its = [each for each in shown if each is not None]
    if not its:
        return DriveOfRecords(rig)
    stated = _speeds(rig, records)
    pairs = [*zip(its, (old for old, each in zip(stated, shown, strict=True) if each), strict=True)]
    if len(its) == len(records):
        rig = _with_velocity(rig, records[0], max(each.error / each.speed for each in its))
    other = [(new, old) for new, old in pairs if not new.agrees(old)]
    far = [(new, old) for new, old in other if abs(new.speed / old - 1.0) > ALIKE_VALUES]
    said = " and ".join(f"{_in_words(new)} (stated: {in_words(old, 'm/s')})" for new, old in other)
    return DriveOfRecords(
        rig,
        f"The drive velocity is that which its displacement shows: {said}." if said else "",
        "The displacement of the drive contradicts the velocity as stated: "
        f"{', '.join(_in_words(new) for new, _ in far)}. The fit takes what it shows: is its unit "
        "right, and its gain?"
        if far
        else "",
    )


def _speeds(rig: Rig, records: Sequence[Record]) -> list[float]:
    """Return the speeds that the records, or else the rig, state."""
    own = abs(nominal_velocity(rig.slider.motion))
    return [each.stated_velocity or own for each in records]


def _in_words(its: EvenDrive) -> str:
    return with_error(its.speed, its.error, "m/s") if its.error else in_words(its.speed, "m/s")


def _with_velocity(rig: Rig, record: Record, error: float) -> Rig:
    """Return the rig with the velocity of a record, known to a relative error, if that is better.

    A certain velocity that agrees remains certain.
    """
    old, prior = nominal_velocity(rig.slider.motion), rig.priors.get(VELOCITY)
    if prior is not None and _relative_spread(prior) < error:
        return rig
    velocity = drive_velocity(record, rig.slider, certain=prior is None)
    priors: dict[str, Prior] = {**rig.priors}
    if prior is not None or (velocity != old and error > SLIGHT):
        priors[VELOCITY] = Normal(velocity, max(error, SLIGHT) * abs(velocity))
    drive = ConstantVelocity._make([velocity])
    return rig._replace(slider=rig.slider.model_copy(update={"drive": drive}), priors=priors)


def _relative_spread(prior: Prior) -> float:
    """Return half the width of the central 68 % of a prior over its middle."""
    low, middle, high = prior.quantile(np.array([SPREAD[0], 0.5, SPREAD[1]])).tolist()
    return float(0.5 * abs((high - low) / middle))
