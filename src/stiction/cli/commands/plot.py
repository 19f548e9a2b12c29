"""``stiction plot``: draw a result."""

from __future__ import annotations

from pathlib import Path

from stiction.cli.options import Output, Trust, Window
from stiction.cli.writing import check_figure, write_figure
from stiction.errors import Faults


def plot(result: Path, /, *, output: Output, window: Window = None, trust: Trust = False) -> None:
    """Draw the overview of a result: the system, forces, direction, position, slip speed.

    For example, after `stiction run my.toml -o my.nc`; then one slip:

        stiction plot my.nc -o my.png

        stiction plot my.nc -o slip.png --window 1.5s 2.2s

    Parameters
    ----------
    result
        A file written by `stiction run`.
    output
        The figure to write: .png, .pdf or .svg. Example: -o my.png.
    window
        Start and end in the run; all of it by default. Example: --window 1.5s 2.2s.
    """
    from stiction.plotting.door import plot as draw
    from stiction.trajectory import load

    faults = Faults()
    check_figure(output, faults)
    with faults.of_part():
        run = load(result, trust=trust)
    faults.refuse()
    write_figure(output, draw, run, window=window)
