"""``stiction plot``: look at a result."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter


def plot(
    result: Path, /, *, output: Annotated[Path, Parameter(alias="-o")], trust: bool = False
) -> None:
    """Draw the overview of a result: the system, forces, direction, position, slip speed.

    Parameters
    ----------
    result
        A file written by `stiction run`.
    output
        The figure to write: .png, .pdf or .svg.
    trust
        Run the friction law of one's own that the result holds, where its file is not found.
    """
    from stiction.plotting.overview import overview
    from stiction.plotting.save import drawable, write
    from stiction.trajectory import load

    drawable(output)
    print(f"wrote {write(overview(load(result, trust=trust)), output)}")
