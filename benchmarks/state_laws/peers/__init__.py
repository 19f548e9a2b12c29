"""Ways to integrate the cases, ours and other people's: one library a file.

As in `benchmarks.precision.peers`; the settings of a row begin with the name of its case.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

from benchmarks.harness.contestant import Contestant, text
from benchmarks.state_laws.cases import CASES, Case, Floats

PEERS = (
    ("ours", "stiction"),
    ("numbalsoda", "numbalsoda"),
    ("sundae", "CVODE (scikit-sundae)"),
    ("scipy", "SciPy"),
    ("odeint", "odeint, as rsfmodel"),
)
MARK = ": "  # after the name of the case


def rows(
    solver: str,
    solve: Callable[..., Floats],
    settings: Callable[[Case], Sequence[Mapping[str, Any]]],
) -> list[Contestant]:
    """Return the rows of a solver in all cases for which it has settings."""
    return [
        Contestant(solver, f"{case.name}{MARK}{text(own)}", partial(solve, case, **own))
        for case in CASES
        for own in settings(case)
    ]
