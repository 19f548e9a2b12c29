"""Our own solver, through the interface that everyone uses."""

from __future__ import annotations

from functools import cache
from math import degrees

import numpy as np

from benchmarks.harness.contestant import Contestant, Failed, rows
from benchmarks.precision.case import ENDS, PHI

SOLVER, MULTISCALE = "stiction", "stiction, multiscale"
RTOL = (
    *(1e-2, 4e-3, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 3e-6, 1e-6, 3e-7, 1e-7, 3e-8, 1e-8),
    *(7e-9, 6e-9, 5e-9, 2e-9, 1e-9, 1e-10, 1e-11, 1e-12),
)


def contestants() -> list[Contestant]:
    """Return our rows: every cycle solved in steps, and most of them by the return map."""
    return [
        *rows(SOLVER, solve, [{"rtol": rtol} for rtol in RTOL]),
        *rows(MULTISCALE, solve, [{"rtol": rtol, "multiscale": True} for rtol in RTOL]),
    ]


def compile_rows() -> None:
    """Compile for the multiscale rows: what one process compiles is on disk for all."""
    solve(ENDS, rtol=1e-3, multiscale=True)


@cache
def slider(phi):
    """Return the system; as the peers' constants, it is described once."""
    import stiction as st

    return st.presets.nakano_popov_2020().replace(phi=f"{degrees(phi)!r} deg")


def solve(times, phi=PHI, *, multiscale=False, **settings):
    """Run at the settings, which are those of `stiction.simulate`; samples only if wanted.

    Every cycle is solved in steps, unless something else is said.

    Labelled arrays are made when they are asked for: a run that is only timed does not need them.
    """
    import stiction as st

    rate = round(1.0 / (times[1] - times[0])) if len(times) > 2 else 0
    run = st.simulate(
        slider(phi), float(times[-1]), sample_rate=rate, multiscale=multiscale, **settings
    )
    if not run.status.ok:
        raise Failed(str(run.status.value))
    if rate == 0:
        return np.empty((0, 2))
    return np.stack([run.data["u_x"].values, run.data["u_y"].values], axis=1)
