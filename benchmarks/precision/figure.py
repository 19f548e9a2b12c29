"""The work-precision diagram."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import cycle

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from benchmarks.harness.row import OURS, Row

# Okabe & Ito's colours, told apart by the colour-blind, and a wine red of Tol's: one a library.
# Markers tell the methods apart, also in black and white.
COLOURS = (
    *("#E69F00", "#56B4E9", "#0072B2", "#009E73", "#D55E00"),
    *("#CC79A7", "#999999", "#882255"),
)
MARKERS = ("s", "^", "v", "D", "P", "X", "<", ">", "p", "h", "*", "d", "8")
PANELS = ("$k_x u_x$", "$k_y u_y$")


def figure(rows: Sequence[Row]) -> Figure:
    """Draw time against the largest error of each force, ours on top."""
    drawing = Figure(figsize=(10.0, 5.4), layout="constrained")
    panels = drawing.subplots(1, 2, sharey=True)
    solvers = dict.fromkeys(row.solver for row in rows if row.errors is not None)
    peers = [solver for solver in solvers if not solver.startswith(OURS)]
    colours = dict(zip(dict.fromkeys(map(library, peers)), cycle(COLOURS), strict=False))
    markers = dict(zip(peers, cycle(MARKERS), strict=False))
    looks = {solver: (colours[library(solver)], markers[solver]) for solver in peers}
    for panel, (axes, force) in enumerate(zip(panels, PANELS, strict=True)):
        for solver in solvers:
            points = [
                (row.errors[panel], 1e3 * row.seconds)
                for row in rows
                if row.solver == solver and row.errors is not None
            ]
            draw(axes, solver, front(points), looks.get(solver))
        finish(axes, force)
    panels[0].set_ylabel("time for 5 s of motion (ms)")
    drawing.legend(
        *panels[0].get_legend_handles_labels(), loc="outside right upper", frameon=False, fontsize=9
    )
    return drawing


def library(solver: str) -> str:
    """Return what a solver belongs to: in brackets after its name, or before the comma in it."""
    return solver.partition("(")[2].strip(")") or solver.partition(",")[0]


def front(points: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
    """Return the points (error, time) that no other beats in both, by rising time."""
    kept: list[tuple[float, float]] = []
    for error, time in sorted(points, key=lambda point: point[::-1]):
        if not kept or error < kept[-1][0]:
            kept.append((error, time))
    return kept


def draw(axes: Axes, solver: str, points, look: tuple[str, str] | None) -> None:
    """Draw one solver's points; ours in black, open where it is not the plain solver."""
    colour, marker = look or ("black", "o")
    hollow = look is None and solver != OURS
    axes.plot(
        *zip(*points, strict=True),
        marker=marker,
        color=colour,
        label=solver,
        linewidth=1.2 if look else 2.4,
        markersize=6.5 if look else 7.0,
        markerfacecolor="white" if hollow else colour,
        markeredgecolor=colour if hollow else "white",
        markeredgewidth=1.6 if hollow else 0.6,
        zorder=2 if look else 3,
    )


def finish(axes: Axes, force: str) -> None:
    """Name the axes; more accurate is to the right."""
    axes.set(xscale="log", yscale="log")
    axes.set_xlabel(f"largest error of {force} (N); better to the right")
    axes.invert_xaxis()
    axes.grid(True, which="major", color="0.88", linewidth=0.8)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
