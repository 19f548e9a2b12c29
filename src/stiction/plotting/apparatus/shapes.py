"""Springs, dashpots, arrows and arcs, and the misalignment at which all of them are drawn.

A point is (horizontal, vertical) in data coordinates; the axes should have equal aspect. A
misalignment too small to be seen is exaggerated, with a note.
"""

from __future__ import annotations

from collections.abc import Callable
from math import copysign, cos, degrees, pi, radians, sin

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import FancyArrowPatch, Polygon
from matplotlib.text import Text
from numpy.typing import ArrayLike

from stiction.arrays import Floats
from stiction.plotting.page.style import BLACK

SIDEWAYS = 0.3  # of a unit vector: a smaller component does not shift a text beside a point
Placement = Callable[[ArrayLike], Floats]

LEAST_ANGLE, EXAGGERATED = radians(20), radians(24)  # a smaller misalignment is drawn like this
STEEP = radians(60)  # one within LEAST_ANGLE of a right angle, like this


def line(
    ax: Axes,
    points: ArrayLike,
    color: str = BLACK,
    width: float = 0.8,
    dashes: str = "-",
    zorder: float = 2.0,
) -> Line2D:
    """Draw a line through points, shape (n, 2); `width` in pt."""
    xy = np.asarray(points, dtype=np.float64)
    (drawn,) = ax.plot(
        xy[:, 0],
        xy[:, 1],
        color=color,
        linewidth=width,
        linestyle=dashes,
        zorder=zorder,
        solid_capstyle="round",
        solid_joinstyle="round",
    )
    return drawn


def polygon(ax: Axes, points: ArrayLike, face: str, zorder: float = 3.0) -> Polygon:
    """Draw a filled polygon with the given corners, shape (n, 2)."""
    drawn = Polygon(np.asarray(points), facecolor=face, edgecolor=BLACK, linewidth=0.8)
    drawn.set_zorder(zorder)
    ax.add_patch(drawn)
    return drawn


def arrow(ax: Axes, ends: ArrayLike, color: str = BLACK, width: float = 1.4) -> FancyArrowPatch:
    """Draw a straight arrow from the first to the second of `ends`, shape (2, 2); `width` in pt."""
    (x_0, y_0), (x_1, y_1) = np.asarray(ends, dtype=np.float64)
    drawn = FancyArrowPatch(
        (x_0, y_0),
        (x_1, y_1),
        arrowstyle="-|>",
        mutation_scale=4.0 + 3.5 * width,
        linewidth=width,
        color=color,
        shrinkA=0,
        shrinkB=0,
        zorder=5,
    )
    ax.add_patch(drawn)
    return drawn


def name(ax: Axes, point: ArrayLike, text: str, color: str = BLACK, size: float = 8.0) -> Text:
    """Write `text` centred at `point`; `size` in pt."""
    x, y = np.asarray(point)
    return ax.text(x, y, text, color=color, fontsize=size, ha="center", va="center", zorder=6)


def beside(ax: Axes, point: ArrayLike, way: ArrayLike, text: str) -> Text:
    """Write `text` beside `point`, in the direction `way`."""
    (x, y), (right, up) = np.asarray(point), np.asarray(way) / np.hypot(*np.asarray(way))
    drawn = name(ax, (x, y), text)
    sides = {"ha": ("right", "center", "left"), "va": ("top", "center", "bottom")}
    for (key, side), part in zip(sides.items(), (right, up), strict=True):
        drawn.set(**{key: side[1 + int(np.sign(part)) * (abs(part) > SIDEWAYS)]})
    return drawn


def spring_path(start: ArrayLike, end: ArrayLike, width: float = 0.22, turns: int = 5) -> Floats:
    """Return a zigzag from `start` to `end` that reaches `width` to either side, shape (n, 2)."""
    along = np.r_[0.0, 0.15, 0.15 + 0.7 * (np.arange(2 * turns) + 0.5) / (2 * turns), 0.85, 1.0]
    across = np.r_[0.0, 0.0, width * (-1.0) ** np.arange(2 * turns), 0.0, 0.0]
    return _between(start, end, along, across)


def dashpot(ax: Axes, start: ArrayLike, end: ArrayLike, width: float = 0.22) -> list[Line2D]:
    """Draw a damper from `start` to `end`."""
    return [line(ax, path) for path in dashpot_paths(start, end, width)]


def dashpot_paths(start: ArrayLike, end: ArrayLike, width: float) -> list[Floats]:
    """Return the lines of a damper from `start` to `end`: a cup, and a rod with a piston in it."""
    cup = ([0.0, 0.38, 0.38, 0.68, 0.38, 0.38, 0.68], [0, 0, 1, 1, 1, -1, -1])
    rod, piston = ([0.56, 1.0], [0, 0]), ([0.56, 0.56], [0.7, -0.7])
    return [
        _between(start, end, np.asarray(along), width * np.asarray(across))
        for along, across in (cup, rod, piston)
    ]


def arc_path(centre: ArrayLike, radius: float, start: float, end: float) -> Floats:
    """Return a circular arc from angle `start` to `end` (rad), shape (n, 2)."""
    angles = np.linspace(start, end, 60)
    return np.asarray(centre) + radius * np.column_stack([np.cos(angles), np.sin(angles)])


def polar(radius: float, angle: float) -> Floats:
    """Return the point at `radius` and `angle` (rad)."""
    return radius * np.array([np.cos(angle), np.sin(angle)])


def fit_view(ax: Axes, points: ArrayLike, margins: tuple[float, float]) -> None:
    """Fit a drawing without frame, and some more points, into axes of equal aspect."""
    ax.update_datalim(np.asarray(points))
    ax.margins(*margins)
    ax.autoscale_view()
    ax.set_aspect("equal", adjustable="datalim")
    ax.set_axis_off()


def _between(start: ArrayLike, end: ArrayLike, along: Floats, across: Floats) -> Floats:
    """Points from fractions `along` the way from start to end and lengths `across` it."""
    tail, way = np.asarray(start, float), np.asarray(end, float) - np.asarray(start, float)
    normal = np.array([-way[1], way[0]]) / np.hypot(*way)
    return tail + np.outer(along, way) + np.outer(across, normal)


def drawn_misalignment(phi: float) -> float:
    """Return the angle at which a misalignment `phi` is drawn (both rad).

    Angles too close to 0 or to a right angle to be seen are exaggerated; 0 and 90 degrees
    themselves are drawn as they are.
    """
    size = abs(phi)
    if min(size, abs(pi / 2 - size)) < 1e-9:
        return phi
    if size < LEAST_ANGLE:
        return copysign(EXAGGERATED, phi)
    return copysign(STEEP, phi) if size > pi / 2 - LEAST_ANGLE else phi


def drawn_slip_angle(drawn: float) -> float:
    """Return the angle theta (rad) of slip and friction to x in the drawing.

    It lies between the misalignment and a right angle. Without misalignment the slip has no
    reason to leave X: theta = phi.
    """
    return drawn if drawn == 0 else (drawn + copysign(pi / 2, drawn)) / 2


def misalignment_note(phi: float) -> str:
    """Return the misalignment in words, with a note if it is not to scale."""
    drawn, size = drawn_misalignment(phi), f"{degrees(phi):.4g}°".replace("-", "−")
    if abs(drawn - phi) < 1e-9:
        return rf"$\varphi$ = {size}"
    return rf"$\varphi$ = {size}, " + f"drawn at {degrees(drawn):.0f}°".replace("-", "−")


def placement(drawn: float) -> Placement:
    """Return the map from points in the axes of the spring to the drawing.

    For a negative misalignment the drawing is that of the positive one, mirrored about X.
    """
    phi, side = abs(drawn), copysign(1.0, drawn)
    turn = np.array([[cos(phi), -sin(phi)], [sin(phi), cos(phi)]])

    def lab(points: ArrayLike) -> Floats:
        placed: Floats = (np.asarray(points, dtype=np.float64) @ turn) * (1.0, side)
        return placed

    return lab
