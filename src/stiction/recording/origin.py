"""The origin of a record: how columns were read, and which parts were skipped."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from typing import Any

from stiction.formats.channels import CHANNELS
from stiction.text.quantity.wording import in_words
from stiction.text.sections import Report, Section, Table
from stiction.text.suggestion import Suggestion


@dataclass(frozen=True)
class Use:
    """One column: its place and heading in the file, its channel ('' for none), its unit."""

    column: int
    heading: str
    channel: str
    unit: str
    least: float
    largest: float


@dataclass(frozen=True)
class OriginOfStroke:
    """Direction of a stroke in its file, and the zero that the file's strokes show.

    Parameters
    ----------
    way : float
        -1 for a way back, whose forces and displacements were turned round.
    after_turn : bool
        Whether the drive turns where it begins: the spring is loaded backwards there.
    middle, middle_error : float or None
        N, middle of the forces forth and back in the file, and its standard error: the zero, if
        friction is as large both ways. None where the strokes do not tell.
    """

    way: float = 1.0
    after_turn: bool = False
    middle: float | None = None
    middle_error: float | None = None


@dataclass(frozen=True, repr=False)
class Origin(Report):
    """Where a record comes from.

    Parameters
    ----------
    file, format : str
        The file's name and kind.
    uses : tuple of Use
        What each column was taken for.
    samples : int
        Number of samples.
    rate : float
        Samples a second, on average.
    block, blocks : int
        Which of the file's blocks, from 1, and how many there are.
    label, start : str
        Name of the block, and wall-clock time of its beginning, as the file has them.
    notes : tuple of str
        What was skipped, turned round, or looks odd.
    stroke : OriginOfStroke or None
        Of a stroke of a drive that goes to and fro.
    """

    file: str
    format: str
    uses: tuple[Use, ...]
    samples: int
    rate: float
    block: int = 1
    blocks: int = 1
    label: str = ""
    start: str = ""
    notes: tuple[str, ...] = ()
    stroke: OriginOfStroke | None = None

    def __repr__(self) -> str:
        """Return one line."""
        part = f", block {self.block} of {self.blocks}" if self.blocks > 1 else ""
        return f"<Origin {self.file}{part}, {self.samples} samples>"

    def tables(self) -> list[Section]:
        """Return the guess as a section: sentences, and a row for each column."""
        part = f", block {self.block} of {self.blocks}" if self.blocks > 1 else ""
        named = f" ({self.label})" if self.label else ""
        begins = f" It began at {self.start}." if self.start else ""
        said = [
            f"{self.format}{part}{named}: {self.samples} samples at {in_words(self.rate, 'Hz')}."
            f"{begins}"
        ]
        said += [sentence(note) for note in self.notes]
        rows = [_row(use) for use in self.uses]
        return [Section("Read as", said, Table(("column", "is", "in", "from", "to"), rows))]

    def to_json(self) -> str:
        """Return the guess as JSON."""
        raw = asdict(self)
        if self.stroke is None:  # as a version without strokes wrote it, and reads it
            del raw["stroke"]
        return json.dumps(raw, ensure_ascii=False)

    @classmethod
    def from_json(cls, text: str) -> Origin:
        """Return an origin that `to_json` wrote; raise TypeError or ValueError for other text."""
        raw: dict[str, Any] = json.loads(text)
        uses = tuple(Use(**each) for each in raw.pop("uses"))
        stroke = raw.pop("stroke", None)
        return cls(
            **{
                **raw,
                "uses": uses,
                "notes": tuple(map(str, raw.pop("notes"))),
                "stroke": None if stroke is None else OriginOfStroke(**stroke),
            }
        )


def sentence(note: str) -> str:
    """Return a note with a capital letter and an end."""
    end = "" if note.endswith("?") else "."
    return f"{note[:1].upper()}{note[1:]}{end}"


def _row(use: Use) -> tuple[str, ...]:
    name = f"{use.column} {use.heading}" if use.column else use.heading
    if not use.channel:
        return name, "not used", "", "", ""
    channel = CHANNELS[use.channel]
    ends = (in_words(use.least, channel.unit), in_words(use.largest, channel.unit))
    return name, channel.meaning, use.unit, *ends


def use_of(origin: Origin | None, channel: str) -> Use | None:
    """Return the column of a channel; None where the record is not from a file."""
    uses = () if origin is None else origin.uses
    return next((use for use in uses if use.channel == channel), None)


def in_unit(use: Use, unit: str) -> Suggestion:
    """Return how the same column is read in another unit.

    >>> print(in_unit(Use(1, "t", "time", "s", 0.0, 1.0), "ms"))
    time='1=ms' of st.read_record
    """
    return Suggestion(use.channel, f"{use.column}={unit}" if use.column else unit)
