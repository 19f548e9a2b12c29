"""The reference for errors, and its own uncertainty."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from benchmarks.harness.row import Errors
from benchmarks.precision.case import (
    DURATION,
    GRID,
    K_X,
    K_Y,
    PUBLISHED_U_X,
    PUBLISHED_U_Y,
    spring_force,
)

RTOL = 1e-13  # the tightest that stiction takes
FINE = 10  # samples for each step of the grid, for the twin
WINDOWS = (0.0, 1.0, 2.03, 4.9)  # s; one at the first rapid slip
WINDOW = 3e-3  # s


class Reference(NamedTuple):
    """The spring force on the grid (N, shape (n, 2)), and what others find instead of it.

    Attributes
    ----------
    force : ndarray
        From stiction at its tightest tolerance.
    looser : Errors
        Of stiction at ten times that tolerance.
    twin : Errors
        Of the readable twin, which shares no code with it, over short windows, each from the
        state that the reference has there: the whole 5 s would take it half an hour.
    published : tuple of float
        Signed relative deviations of u_x(5 s) and u_y(5 s) from the published values.
    """

    force: NDArray[np.float64]
    looser: Errors
    twin: Errors
    published: tuple[float, float]


def reference() -> Reference:
    """Compute the reference and what confirms it."""
    import stiction as st

    slider = st.presets.nakano_popov_2020()
    rate = FINE * (len(GRID) - 1) / DURATION
    run = st.simulate(slider, DURATION, sample_rate=rate, rtol=RTOL, multiscale=False)
    fine = run.data["u_x"].values, run.data["u_y"].values
    force = spring_force(np.stack([u[::FINE] for u in fine], axis=1))
    looser = st.simulate(
        slider, DURATION, sample_rate=rate / FINE, rtol=10 * RTOL, multiscale=False
    )
    other = np.stack([looser.data["spring_x"].values, looser.data["spring_y"].values], axis=1)
    ends = force[-1] / np.array([K_X * PUBLISHED_U_X, K_Y * PUBLISHED_U_Y]) - 1.0
    published = float(ends[0]), float(ends[1])
    return Reference(force, largest(other, force), against_twin(slider, run), published)


def against_twin(slider, run) -> Errors:
    """Return the largest errors of the twin over the windows."""
    import stiction as st
    from stiction.solver.reference import reference_run

    worst = Errors(0.0, 0.0)
    for start in WINDOWS:
        inside = run.data.sel(time=slice(start - 1e-9, start + WINDOW + 1e-9))
        state = inside.isel(time=0)
        names = ("u_x", "u_y", "v_x", "v_y", "time")
        initial = st.Initial(**{name: float(state[name]) for name in names})
        times = inside["time"].values
        found = reference_run(slider, times[-1] - times[0], times, initial=initial, rtol=1e-11)
        theirs = spring_force(np.stack([found.u_x, found.u_y], axis=1))
        ours = spring_force(np.stack([inside["u_x"].values, inside["u_y"].values], axis=1))
        errors = largest(theirs, ours[: len(theirs)])
        worst = Errors(max(worst.x, errors.x), max(worst.y, errors.y))
    return worst


def largest(force: NDArray[np.float64], reference: NDArray[np.float64]) -> Errors:
    """Compare spring forces (N, shape (..., n, 2)): the largest error of each component."""
    found = np.abs(force - reference).reshape(-1, 2).max(axis=0)
    return Errors(float(found[0]), float(found[1]))
