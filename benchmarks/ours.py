"""Our own solver, through the interface that everyone uses."""

from __future__ import annotations

from functools import partial

import numpy as np
from numpy.typing import NDArray

from .contestant import Contestant, Failed
from .problem import DURATION

TOLERANCES = (1e-4, 1e-5, 3e-6, 1e-6, 1e-7, 1e-8, 1e-10)
REFERENCE_RTOL = 1e-11
SOLVER = "stiction"
SAMPLES_EACH_GRID_STEP = 10  # 10 kHz beside the grid's 1 kHz


def contestants() -> list[Contestant]:
    """Return our rows, compiled: unsampled at several tolerances, and one sampled at 10 kHz."""
    _run(duration=1e-3, sample_rate=None, rtol=1e-4)
    rows = [
        Contestant(
            SOLVER,
            f"rtol={rtol:.0e}",
            solve=partial(spring_force, rtol),
            measure=partial(_run, sample_rate=None, rtol=rtol),
        )
        for rtol in TOLERANCES
    ]
    sampled = Contestant(
        SOLVER,
        "rtol=1e-06, sampled at 10 kHz",
        solve=partial(spring_force, 1e-6, SAMPLES_EACH_GRID_STEP),
        measure=partial(_run, sample_rate=1e4, rtol=1e-6),
    )
    return [*rows, sampled]


def reference() -> NDArray[np.float64]:
    """Return the spring force on the grid (N, shape (n, 2)) at our tightest tolerance."""
    return spring_force(REFERENCE_RTOL)


def spring_force(rtol: float, every: int = 1) -> NDArray[np.float64]:
    """Return ``(k_x u_x, k_y u_y)`` on the grid, in N, from a run sampled `every` times finer."""
    run = _run(sample_rate=1e3 * every, rtol=rtol)
    if not run.status.ok:
        raise Failed(str(run.status.value))
    columns = [np.asarray(run.data[name])[::every] for name in ("spring_x", "spring_y")]
    return np.stack(columns, axis=1)


def _run(*, duration: float = DURATION, sample_rate: float | None, rtol: float):
    import stiction as st

    slider = st.presets.nakano_popov_2020()
    return st.simulate(slider, duration=duration, sample_rate=sample_rate, rtol=rtol)
