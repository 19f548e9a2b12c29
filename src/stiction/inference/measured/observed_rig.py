"""A rig and its records, read and observed once for all that is to be found from them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from stiction.analysis.record import Record
from stiction.inference.measured.drive_of_records import DriveOfRecords, with_measured_drive
from stiction.inference.observation import (
    Conditions,
    Observation,
    Source,
    observe,
    observe_all,
    read_all,
)
from stiction.inference.rig import Rig, load_of_records


class ObservedRig(NamedTuple):
    """A rig with the drive that its records show, and the observation of each of them."""

    drive: DriveOfRecords
    seen: Sequence[Observation]

    @property
    def rig(self) -> Rig:
        """The rig with the drive that its records show."""
        return self.drive.rig

    @property
    def conditions(self) -> list[Conditions]:
        """Those of each record."""
        return [each.conditions for each in self.seen]


def observe_rig(records: Source | Sequence[Source], rig: Rig) -> ObservedRig:
    """Read and observe one or several records of a rig."""
    given = read_all(records, load_of_records(rig))
    drive = with_measured_drive(rig, given)
    return ObservedRig(drive, observe_all(given, drive.rig.slider))


def observe_with_one(record: Record, rig: Rig) -> ObservedRig:
    """Observe the only record of a rig; messages call it `the record`."""
    drive = with_measured_drive(rig, [record])
    return ObservedRig(drive, [observe(record, drive.rig.slider)])
