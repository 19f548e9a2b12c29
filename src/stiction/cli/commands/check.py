"""``stiction check``: find damage in a result or a study's store."""

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
    """Check a result, a stored record, the file of a fit or the store of a study for damage.

    For example:

        stiction check my.nc

        stiction check yaw.zarr --repair

    Exit status: 0 if nothing is damaged, or all was repaired; 1 if something is damaged; 2 if PATH
    is none of these, or cannot be repaired, as a record, which is imported again, or a fit.

    Parameters
    ----------
    path
        A result of `stiction run`, a record of `stiction import`, the file of a `stiction fit` or
        a store of `stiction sweep`.
    repair
        Compute damaged parts again: a result from the description in it, a study block by block.
    """
    from stiction import checking

    found = checking.check(path, repair=repair, trust=trust)
    say(str(found))
    return 0 if found.ok else 1
