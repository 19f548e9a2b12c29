"""The error of the paper's run over the tolerance and over the number of steps."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray
from rich.progress import Progress

import stiction as st
from benchmarks.section import Table
from stiction import theory
from stiction.plotting.page.style import BLUE, PAGE, RED, new_figure, panel_letter, style

DURATION = 5.0
TOLERANCES = tuple(10.0**-n for n in range(3, 11))
REFERENCE = 1e-12
FORCES = ("spring_x", "spring_y")


class Point(NamedTuple):
    """Errors of a run (N, of k_x u_x and of k_y u_y) and the steps it took a transverse cycle."""

    rtol: float
    steps: float
    errors: tuple[float, float]


def points(progress: Progress, tolerances: Sequence[float]) -> list[Point]:
    """Run the paper's case at each tolerance, beside the tightest one."""
    task = progress.add_task("convergence", total=1 + len(tolerances))
    slider = st.presets.nakano_popov_2020()
    cycles = DURATION * float(theory.natural_frequency(slider.k_y, slider.mass)) / (2.0 * np.pi)

    def forces(rtol: float) -> tuple[NDArray[np.float64], int]:
        run = st.simulate(slider, DURATION, sample_rate=1e3, rtol=rtol, multiscale=False)
        progress.advance(task)
        return np.array([run.data[name].values for name in FORCES]), run.statistics.steps

    exact, _ = forces(REFERENCE)
    found = []
    for rtol in tolerances:
        values, steps = forces(rtol)
        x, y = np.abs(values - exact).max(axis=1)
        found.append(Point(rtol, steps / cycles, (float(x), float(y))))
    return found


def order(x: Sequence[float], y: Sequence[float]) -> tuple[float, float]:
    """Return p of y ~ x^p by least squares of the logarithms, and its standard error.

    Raises
    ------
    ValueError
        If there are fewer than three points, which say nothing of the error.
    """
    if len(x) < 3:
        raise ValueError(f"an order needs three points at least, not {len(x)}")
    (p, _), covariance = np.polyfit(np.log(x), np.log(y), 1, cov=True)
    return float(p), float(np.sqrt(covariance[0, 0]))


def table(found: Sequence[Point]) -> Table:
    """Return the errors by tolerance, and below them the orders fitted."""
    rows = [(f"{p.rtol:.0e}", round(p.steps, 1), *p.errors) for p in found]
    for name, sign, x in (
        ("order in rtol", 1.0, [p.rtol for p in found]),
        ("order in the step size", -1.0, [p.steps for p in found]),
    ):
        fits = [order(x, [p.errors[i] for p in found]) for i in (0, 1)]
        rows.append((name, "", *(f"{sign * p:.2f} ± {error:.2f}" for p, error in fits)))
    headings = ("rtol", "steps/transverse cycle", "error of k_x u_x (N)", "error of k_y u_y (N)")
    return Table("Convergence, Fig. 3 over 5 s", headings, rows)


def figure(found: Sequence[Point]) -> Figure:
    """Draw the errors over the tolerance and over the steps, with the orders fitted."""
    with style():
        fig = new_figure(PAGE, 2.9)
        left, right = fig.subplots(1, 2, sharey=True)
        _draw(left, [p.rtol for p in found], found, 1.0)
        _draw(right, [p.steps for p in found], found, -1.0)
        left.set_xlabel("relative tolerance, rtol")
        left.set_ylabel("largest error over 5 s (N)")
        left.invert_xaxis()
        right.set_xlabel("steps in a transverse cycle")
        right.set_xticks([3, 5, 10, 20, 50], ["3", "5", "10", "20", "50"])
        right.set_xticks([], minor=True)
        for ax, letter in zip((left, right), "ab", strict=True):
            ax.legend(loc="lower left")
            panel_letter(ax, letter)
    return fig


def _draw(ax, x: Sequence[float], found: Sequence[Point], sign: float) -> None:
    forces = (("$k_x u_x$", BLUE, "o"), ("$k_y u_y$", RED, "s"))
    for i, (name, colour, marker) in enumerate(forces):
        y = [p.errors[i] for p in found]
        p, _ = order(x, y)
        fitted = np.exp(np.polyval(np.polyfit(np.log(x), np.log(y), 1), np.log(x)))
        ax.loglog(x, fitted, "--", color=colour, linewidth=0.7)
        ax.loglog(x, y, marker, color=colour, markersize=4, label=f"{name}, order {sign * p:.2f}")
