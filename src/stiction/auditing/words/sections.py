"""The report of an audit, section by section."""

from __future__ import annotations

from typing import TYPE_CHECKING

from stiction.auditing.words.changes import changes
from stiction.auditing.words.numbers import numbers, violated_assumptions
from stiction.auditing.words.stick import stick
from stiction.auditing.words.transverse import transverse
from stiction.auditing.words.verdict import verdict
from stiction.text.sections import Section

if TYPE_CHECKING:
    from stiction.auditing.report import Audit


def sections(found: Audit) -> list[Section]:
    """Return the sections of the report."""
    return [
        Section("Verdict", verdict(found)),
        Section("Predicted and simulated", violated_assumptions(found), numbers(found)),
        Section("Is it stick?", stick(found)),
        Section("Transverse oscillation", transverse(found)),
        Section("What to change", *changes(found)),
    ]
