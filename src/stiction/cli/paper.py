"""``stiction paper``: everything in the paper, computed again."""

from __future__ import annotations

from pathlib import Path
from typing import Literal


def paper(*, out: Path = Path("paper-output"), figure: Literal[3, 4, 5] | None = None) -> int:
    """Reproduce Nakano & Popov (2020): every figure, and every number beside the computed one.

    Writes each figure as PNG and PDF, and the table of numbers as text, Markdown and JSON.
    Exit status: 0 when every number agrees, 1 when one does not.

    Parameters
    ----------
    out
        The folder to write to; made if it is not there.
    figure
        Only this figure, without the table of numbers.
    """
    from stiction.cli.progress import progress
    from stiction.reproduction.reproduce import reproduce

    with progress("simulating and drawing") as report:
        written, table = reproduce(out, figure, report)
    for path in written:
        print(f"wrote {path}")
    if table is None:
        return 0
    print()
    print(table.text)
    return 0 if table.agrees else 1
