"""Vectors in the plane: friction in the circle of its limit, and velocities that add up."""

from __future__ import annotations

from math import pi

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from stiction.arrays import Floats, xr
from stiction.plotting.apparatus import shapes
from stiction.plotting.apparatus.shapes import (
    Placement,
    drawn_misalignment,
    drawn_slip_angle,
    placement,
    polar,
)
from stiction.plotting.page.style import BLUE, GREEN, GREY, PALE, PURPLE, RED
from stiction.system.slider import Slider
from stiction.trajectory import Trajectory


def friction_vector(data: xr.Dataset) -> Floats:
    """Return the friction force (X, Y) on the mass, opposite to slip, shape (n, 2), in N."""
    psi = np.radians(data["psi"].values) + np.pi
    direction: Floats = np.column_stack([np.cos(psi), np.sin(psi)])
    return direction * np.asarray(data["friction"].values, dtype=np.float64)[:, None]


def draw_friction_circle(ax: Axes, run: Trajectory, window: tuple[float, float]) -> Line2D:
    """Draw the circle mu_0 W, the friction vector on the mass, and the path of its tip.

    Its window is in s; the path is returned.
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


def draw_velocity_triangle(ax: Axes, slider: Slider) -> Axes:
    """Draw drive velocity = elongation rates + slip velocity (Nakano & Popov, Fig. 2(c)).

    With the angles phi from x to X, theta from x to the slip velocity, psi = theta - phi from X to
    the slip velocity, at the misalignment at which `draw_schematic` draws it.
    """
    drawn = drawn_misalignment(slider.misalignment)
    phi, theta, lab = abs(drawn), abs(drawn_slip_angle(drawn)), placement(drawn)
    drive, slip = polar(1.0, phi), polar(0.32, theta)
    foot, knee = np.array([drive[0] - slip[0], 0.0]), drive - slip
    straight = theta == phi  # everything on one line: draw V beside it
    beside = polar(0.1, phi + pi / 2) if straight else np.zeros(2)
    for tail, head, text, color, above in (
        (beside, drive + beside, "$V$", BLUE, 1),
        (np.zeros(2), foot, r"$v_x = \dot{u}_x$", RED, -1),
        (foot, knee, r"$v_y = \dot{u}_y$", RED, -1),
        (knee, drive, r"$v_\mathrm{slip}$", GREEN, -1 if straight else 0),
    ):
        way = head - tail
        if np.hypot(*way) < 1e-9:
            continue
        shapes.arrow(ax, lab([tail, head]), color, 1.6)
        normal = above * np.array([-way[1], way[0]]) / np.hypot(*way)
        gap = 0.08 + 0.12 * abs(lab(normal)[0]) * (text != "$V$")  # a text is wider than high
        place = tail + way / 2 + gap * normal if above else head + polar(0.1, theta - 0.2)
        shapes.name(ax, lab(place), text, color)
    ends = [beside * 1.9, foot, drive + beside * 1.9, knee]
    if not straight:
        ends += _draw_angles(ax, lab, phi, theta, knee)
    shapes.fit_view(ax, lab(np.vstack(ends)), (0.15, 0.38))
    return ax


def _draw_angles(ax: Axes, lab: Placement, phi: float, theta: float, knee: Floats) -> list[Floats]:
    """Draw phi where V starts; theta and psi where the slip velocity does."""
    for angle, color in ((0.0, RED), (phi, BLUE)):
        shapes.line(ax, lab([knee, knee + polar(0.42, angle)]), color, 0.7, "-.", zorder=1)
    wide = 0.38 if phi < 0.8 else 0.26
    for centre, radius, start, end, where, text in (
        (np.zeros(2), wide - 0.08, 0.0, phi, wide, r"$\varphi$"),
        (knee, 0.14, 0.0, theta, 0.2, r"$\theta$"),
        (knee, 0.24, phi, theta, 0.31, r"$\psi$"),
    ):
        shapes.line(ax, lab(shapes.arc_path(centre, radius, start, end)))
        middle = phi / 2 if start == 0 else (start + end) / 2
        shapes.name(ax, lab(centre + polar(where, middle)), text)
    return [knee + polar(0.42, 0.0), knee + polar(0.42, phi)]
