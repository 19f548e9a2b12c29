"""``stiction paper``: reproduce the paper."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from cyclopts import Parameter

from stiction.cli.terminal import say


def paper(
    *,
    output: Annotated[Path, Parameter(name=("--output", "-o", "--out"))] = Path("paper-output"),
    figure: Literal[3, 4, 5] | None = None,
) -> int:
    """Reproduce Nakano & Popov (2020): every figure, and every number beside its computed value.

    Writes each figure as PNG and PDF, and the table of numbers as text, Markdown and JSON.
    For example:

        stiction paper -o paper-output

        stiction paper --figure 3 -o figures

    Exit status: 0 if every number agrees, 1 if one does not.

    Parameters
    ----------
    output
        The folder to write to; made if it does not exist. Example: -o paper-output.
    figure
        Only this figure, without the table of numbers. Example: --figure 3.
    """
    from stiction.progress.display import show_progress
    from stiction.reproduction.reproduce import paper as reproduce

    with show_progress("simulating and drawing") as report:
        found = reproduce(output, figure, progress=report)
    for path in found.files:
        say(f"wrote {path}")
    if found.table is not None:
        say("")
        say(found.table.text)
    return 0 if found.agrees else 1
