"""A part of a record: some of its samples, with all that is known of them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from stiction.errors import ResultError
from stiction.formats.table import number_of
from stiction.recording.guess.channel_times import FEWEST_SAMPLES
from stiction.recording.guess.clock import rate_of
from stiction.recording.measurement import Measurement
from stiction.recording.request import KnownApparatus
from stiction.text.quantity.wording import in_words
from stiction.text.suggestion import Suggestion

DIRECTED = ("force", "force_across", "position", "drive_position")  # channels with a sign


def part_of(found: Measurement, samples: slice, name: str, way: float = 1.0) -> Measurement:
    """Return some samples of a measurement; `way` -1 reverses the sign of directed channels."""
    channels = {
        key: (way if key in DIRECTED else 1.0) * values[samples]
        for key, values in found.channels.items()
    }
    time = channels["time"]
    elapsed = float(time[0] - found.channels["time"][0])
    sensors = {key: sensor.later(elapsed) for key, sensor in found.sensors.items()}
    back = "; on this way back, forces and displacements were turned round" if way < 0.0 else ""
    note = f"{name}, from {in_words(float(time[0]), 's')} to {in_words(float(time[-1]), 's')}{back}"
    used = [
        replace(use, least=float(channels[x].min()), largest=float(channels[x].max()))
        if (x := use.channel) in channels
        else use
        for use in found.origin.uses
    ]
    known = dict(found.known)
    if way < 0.0 and known.get("zero") is not None:  # it is stated as the file has its forces
        known["zero"] = -float(KnownApparatus(zero=known["zero"]).zero or 0.0)
    origin = replace(
        found.origin,
        uses=tuple(used),
        samples=len(time),
        rate=rate_of(time),
        notes=(note, *found.origin.notes),
    )
    return found._replace(channels=channels, known=known, sensors=sensors, origin=origin)


def part_between(
    path: object, found: Measurement, begin: float | None, end: float | None
) -> Measurement:
    """Return the samples from one time to another, s, as the file has its times.

    Raises
    ------
    ResultError
        If there are hardly any.
    """
    time = found.channels["time"]
    first = 0 if begin is None else int(np.searchsorted(time, begin))
    last = len(time) if end is None else int(np.searchsorted(time, end, side="right"))
    if last - first < FEWEST_SAMPLES:
        count = number_of(max(last - first, 0), "sample")
        raise ResultError(
            f"{path}: has {count} between {Suggestion('begin')} and {Suggestion('end')}; its times "
            f"go from {in_words(float(time[0]), 's')} to {in_words(float(time[-1]), 's')}"
        )
    return part_of(found, slice(first, last), "a part")


def begin_and_end() -> str:
    """Return the arguments that select a part of a file."""
    return f"{Suggestion('begin', of='')}, {Suggestion('end')}"
