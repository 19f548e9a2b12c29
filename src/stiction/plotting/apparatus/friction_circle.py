"""The friction vector inside the circle of possible friction forces."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from stiction.arrays import Floats, xr
from stiction.plotting.apparatus import shapes
from stiction.plotting.page.style import BLUE, GREEN, GREY, PALE, PURPLE
from stiction.trajectory import Trajectory


def friction_vector(data: xr.Dataset) -> Floats:
    """Return the friction force (X, Y) on the mass, opposite to slip, shape (n, 2), in N."""
    psi = np.radians(data["psi"].values) + np.pi
    direction: Floats = np.column_stack([np.cos(psi), np.sin(psi)])
    return direction * np.asarray(data["friction"].values, dtype=np.float64)[:, None]


def draw_friction_circle(ax: Axes, run: Trajectory, window: tuple[float, float]) -> Line2D:
    """Draw the circle mu_0 W, the friction vector on the mass, and the path of its tip.

    Parameters
    ----------
    ax : Axes
        Drawn on with equal aspect.
    run : Trajectory
        The run.
    window : tuple of float
        Start and end of the path, s.

    Returns
    -------
    Line2D
        The path.
    """
    vector = friction_vector(run.data.sel(time=slice(*window)))
    F_0 = run.slider.F_0
    circle = shapes.arc_path((0, 0), F_0, 0, 2 * np.pi)
    ax.fill(*circle.T, facecolor=PALE, edgecolor=GREY, linewidth=0.8)
    ax.axhline(0, color=BLUE, linewidth=0.6, linestyle="-.")
    tip = vector[np.isfinite(vector).all(axis=1)][-1]
    shapes.arrow(ax, [np.zeros(2), tip], PURPLE, 1.2)
    shapes.name(ax, 0.5 * tip + 0.14 * F_0 * np.array([-tip[1], tip[0]]) / F_0, "$F$", PURPLE)
    path = shapes.line(ax, vector, GREEN, 2.0, zorder=6)
    ax.annotate(
        r"$\mu_0 W$", (0, -F_0), (0, 4), textcoords="offset points", ha="center", fontsize=7
    )
    _name_axes(ax)
    return path


def draw_friction_arc(
    ax: Axes, run: Trajectory, window: tuple[float, float]
) -> tuple[Line2D, Line2D]:
    """Draw the path of the friction vector's tip close up: on the arc in slip, inside in stick.

    Parameters are those of `draw_friction_circle`. Returns the paths in slip and in stick.
    """
    part = run.data.sel(time=slice(*window))
    vector, stuck = friction_vector(part), part["sticking"].values == 1
    near = stuck.copy()  # join each stick to the slip at its ends
    near[1:] |= stuck[:-1]
    near[:-1] |= stuck[1:]
    psi = np.radians(part["psi"].values) + np.pi
    low, high = np.nanmin(psi), np.nanmax(psi)
    reach = 0.25 * (high - low)
    slip = shapes.line(ax, np.where(stuck[:, None], np.nan, vector), GREEN, 1.0)
    stick = shapes.line(ax, np.where(near[:, None], vector, np.nan), PURPLE, 1.0)
    ax.margins(0.15)
    ax.autoscale_view()
    limits = ax.get_xlim(), ax.get_ylim()
    arc = shapes.arc_path((0, 0), run.slider.F_0, low - reach, high + reach)
    ax.plot(*arc.T, color=GREY, linewidth=0.8, zorder=1)
    ax.set(xlim=limits[0], ylim=limits[1])
    _name_axes(ax)
    ax.locator_params(nbins=4)
    return slip, stick


def _name_axes(ax: Axes) -> None:
    ax.set_aspect("equal", adjustable="box")
    ax.set_xlabel("$F_X$ (N)")
    ax.set_ylabel("$F_Y$ (N)")
