"""``stiction check``: is a result, or a study's store, as it was written?"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from stiction.cli.options import Trust
from stiction.cli.terminal import say


def check(
    path: Path,
    /,
    *,
    repair: Annotated[bool, Parameter(negative=())] = False,
    trust: Trust = False,
) -> int:
    """Look whether a result, or the store of a study, is as it was written.

    For example:

        stiction check my.nc

        stiction check yaw.zarr --repair

    Exit status: 0 when all is whole, or was computed again; 1 when something is damaged; 2 when it
    is neither a result nor a store, or cannot be computed again.

    Parameters
    ----------
    path
        What `stiction run` or `stiction sweep` wrote.
    repair
        Compute again what is damaged: a result from the description in it, of a study the
        blocks of runs that are damaged.
    """
    from stiction import checking

    found = checking.check(path, repair=repair, trust=trust)
    say(str(found))
    return 0 if found.ok else 1
