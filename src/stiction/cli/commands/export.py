"""``stiction export``: write a result for another program."""

from __future__ import annotations

from pathlib import Path

from stiction.cli.options import Output, Trust
from stiction.cli.terminal import say


def export(result: Path, /, *, output: Output, trust: Trust = False) -> None:
    """Write a result as CSV, Parquet or MATLAB.

    For example, after `stiction run my.toml -o my.nc`:

        stiction export my.nc -o my.csv

    Parameters
    ----------
    result
        A file written by `stiction run`.
    output
        The file to write: .csv or .parquet for the samples, with the stick intervals in a second
        file beside it (my-sticks.csv); .mat for both in one file. Example: -o my.csv.
    """
    from stiction import trajectory

    for path in trajectory.export(result, output, trust=trust):
        say(f"wrote {path}")
