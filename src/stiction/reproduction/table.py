"""The table of numbers: printed, and saved as text, Markdown and JSON."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from stiction.presets import Number
from stiction.storage.files import whole
from stiction.text.sections import Section, Table

HEADER = ("where", "what", "stated", "computed", "deviation", "tolerance", "unit", "verdict")


@dataclass(frozen=True)
class NumberTable:
    """Numbers beside the stated ones.

    Parameters
    ----------
    numbers : sequence of Number
        The numbers in order.
    """

    numbers: Sequence[Number]

    @property
    def agrees(self) -> bool:
        """Whether no number is wrong."""
        return all(number.verdict != "WRONG" for number in self.numbers)

    @property
    def rows(self) -> list[tuple[str, ...]]:
        """The cells as text, one tuple a number."""
        return [
            (
                n.where,
                n.what,
                f"{n.stated:.11g}",
                f"{n.computed:.9g}",
                f"{n.deviation:+.1e}",
                f"{n.tolerance:.1e}",
                "" if n.unit == "1" else n.unit,
                n.verdict,
            )
            for n in self.numbers
        ]

    @property
    def section(self) -> Section:
        """The table as a part of a report, with the line that counts the verdicts."""
        return Section("The paper's numbers", [self.summary], Table(HEADER, self.rows))

    @property
    def text(self) -> str:
        """The table in plain text, with a line that counts the verdicts."""
        rows = [HEADER, *self.rows]
        widths = [max(len(row[i]) for row in rows) for i in range(len(HEADER))]
        lines = ["  ".join(c.ljust(w) for c, w in zip(row, widths, strict=True)) for row in rows]
        lines.insert(1, "  ".join("-" * width for width in widths))
        return "\n".join(line.rstrip() for line in [*lines, "", self.summary])

    @property
    def summary(self) -> str:
        """One line, how many of the numbers agree and which do not."""
        kinds = {
            "of the paper's numbers": [n for n in self.numbers if n.where != "reference"],
            "reference values of this project": [n for n in self.numbers if n.where == "reference"],
        }
        parts = [
            f"{sum(n.verdict == 'agrees' for n in part)} of {len(part)} {whose} agree"
            for whose, part in kinds.items()
            if part
        ]
        findings = [n for n in self.numbers if n.verdict == "finding"]
        if findings:
            named = ", ".join(f"{n.where} {n.what.strip()}" for n in findings)
            count = "1 is a finding" if len(findings) == 1 else f"{len(findings)} are findings"
            parts.append(f"{count}: {named}")
        wrong = [n.what.strip() for n in self.numbers if n.verdict == "WRONG"]
        if wrong:
            parts.append(f"wrong: {', '.join(wrong)}")
        return "; ".join(parts)

    @property
    def markdown(self) -> str:
        """The table in Markdown."""
        lines = [f"| {' | '.join(row)} |" for row in [HEADER, *self.rows]]
        lines.insert(1, f"|{' --- |' * len(HEADER)}")
        return "\n".join([*lines, "", self.summary])

    def save(self, folder: Path) -> list[Path]:
        """Write ``numbers.txt``, ``.md`` and ``.json`` to `folder`; return their paths."""
        entries = [
            asdict(n)
            | {"computed": float(n.computed), "deviation": float(n.deviation)}
            | {"verdict": n.verdict}
            for n in self.numbers
        ]
        texts = {".txt": self.text, ".md": self.markdown, ".json": json.dumps(entries, indent=2)}
        for suffix, text in texts.items():
            with whole(folder / f"numbers{suffix}") as part:
                part.write_text(text + "\n", encoding="utf-8")
        return [folder / f"numbers{suffix}" for suffix in texts]
