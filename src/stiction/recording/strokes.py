"""Strokes of a drive that goes to and fro: parts of a record between two turns."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from stiction.arrays import Floats
from stiction.errors import ResultError, echo
from stiction.formats.table import number_of
from stiction.recording.guess.choice import may_be_displacement
from stiction.recording.measurement import Measurement
from stiction.recording.origin import Origin, OriginOfStroke, use_of
from stiction.recording.part import part_of
from stiction.text.suggestion import Suggestion

ALL = "all"  # of the strokes are asked for
EACH = Suggestion("stroke", ALL, of="st.read_records")
ENDS = 0.25  # of the reach, about its middle: beyond it the drive is at one end or at the other
AT_AN_END = 0.02  # of the reach: so near its end a drive turns, or dwells
HIGH_AND_LOW = (0.05, 0.95)  # quantiles of a force, between peaks and troughs of slips
WHOLE = 0.5  # of the reach: a part at the beginning or the end of a record that is less is left out


class Stroke(NamedTuple):
    """A part of a record between two turns of the drive: its samples, and which way it goes."""

    samples: slice
    way: float


def strokes(position: Floats) -> list[Stroke]:
    """Return the strokes of a displacement, one if it does not turn.

    A turn is the middle of the samples near an end, so that a dwell there is divided.

    Examples
    --------
    >>> strokes(np.array([0.0, 1.0, 2.0, 1.0, 0.0]))
    [Stroke(samples=slice(0, 3, None), way=1.0), Stroke(samples=slice(2, 5, None), way=-1.0)]
    """
    low, high = float(position.min()), float(position.max())
    reach, middle = high - low, 0.5 * (low + high)
    edges = [0, *_turns(position - middle, reach), len(position) - 1]
    found = []
    for begin, end in pairwise(edges):
        travel = float(position[end] - position[begin])
        if end > begin and abs(travel) >= WHOLE * reach:
            found.append(Stroke(slice(begin, end + 1), -1.0 if travel < 0.0 else 1.0))
    return found


def _turns(position: Floats, reach: float) -> list[int]:
    """Return the samples at which a displacement about its middle turns.

    Where a record begins or ends near an end of the way, its drive did not turn there: it starts,
    or stops.
    """
    out = np.flatnonzero(np.abs(position) > ENDS * reach)
    if not len(out):
        return []
    side = np.sign(position[out])
    parts = np.split(out, np.flatnonzero(np.diff(side)) + 1)
    found = []
    for part in parts:  # at one end, and then at the other
        far = np.abs(position[part])
        near = part[far >= far.max() - AT_AN_END * reach]
        if near[0] > 0 and near[-1] < len(position) - 1:
            found.append(int(near[0] + near[-1]) // 2)
    return found


def stroke_of(path: object, found: Measurement, number: int) -> Measurement:
    """Return one stroke of a record, counted from 1, in the direction of its drive.

    Raises
    ------
    ResultError
        If the record has no displacement, or not so many strokes.
    """
    parts = all_strokes(path, found)
    if not 1 <= number <= len(parts):
        one = "" if len(parts) > 1 else ": the drive does not turn"
        raise ResultError(
            f"{path}: has {number_of(len(parts), 'stroke')}{one}; there is no stroke {echo(number)}"
        )
    return parts[number - 1]


def all_strokes(path: object, found: Measurement) -> list[Measurement]:
    """Return the strokes of a record, each in the direction of its drive.

    On the way back, forces and displacements along the drive have the other sign: they are turned
    round, as a test of one direction has them.

    Raises
    ------
    ResultError
        If the record has no displacement.
    """
    name = next((x for x in ("drive_position", "position") if x in found.channels), None)
    if name is None:
        raise ResultError(
            f"{path}: which samples are a stroke follows from the displacement of the drive; say "
            f"its column and unit, such as {Suggestion('drive_position', 'stage=mm')}"
        )
    parts = strokes(found.channels[name])
    middle = _middle(found.channels["force"], parts)
    each = []
    for number, (samples, way) in enumerate(parts, 1):
        part = part_of(found, samples, f"stroke {number} of {len(parts)}", way)
        place = OriginOfStroke(way, samples.start > 0, *middle)
        each.append(part._replace(origin=replace(part.origin, stroke=place)))
    return each


def _middle(force: Floats, parts: list[Stroke]) -> tuple[float, float] | tuple[None, None]:
    """Return the middle of the forces forth and back, N, and its standard error; None if unknown.

    Of each stroke its last half counts, in two parts, by the middle between its high and its low
    forces: slips that are cut at an end shift a mean. A force that has one sign both ways has been
    turned round already, or is none of friction.
    """
    levels: dict[float, list[float]] = {1.0: [], -1.0: []}
    for samples, way in parts:
        last = np.array_split(force[samples], 4)[2:]
        levels[way] += [float(np.quantile(x, HIGH_AND_LOW).mean()) for x in last if len(x)]
    if min(map(len, levels.values())) < 2:
        return None, None
    forth, back = (np.array(each) for each in levels.values())
    if forth.mean() * back.mean() >= 0.0:
        return None, None
    variance = sum(float(each.var(ddof=1)) / len(each) for each in (forth, back))
    return 0.5 * float(forth.mean() + back.mean()), 0.5 * variance**0.5


def by_strokes(origin: Origin | None = None) -> str:
    """Return how a record of a drive that goes to and fro is divided, for a message.

    Of a file with a column that may be the displacement of the drive, and is not used, that column
    is named.
    """
    unused = (use for use in (origin.uses if origin else ()) if not use.channel and use.column)
    use = next((use for use in unused if may_be_displacement(use.heading.split(" [")[0])), None)
    if use is not None and origin is not None and use_of(origin, "drive_position") is None:
        return (
            f"the strokes by themselves: if column {use.column} '{use.heading}' is the "
            f"displacement of the drive, say {Suggestion('drive_position', use.column, of='')} and "
            f"{EACH}"
        )
    return (
        "the strokes by themselves: where a file has the drive's displacement, "
        f"{Suggestion('stroke', 1)} reads the first, and {EACH} each of them"
    )
