"""A pin on a cantilever spring and a moving plate, and the same system seen from the side."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from stiction.arrays import Floats
from stiction.plotting.apparatus import shapes
from stiction.plotting.apparatus.shapes import drawn_misalignment, misalignment_note
from stiction.plotting.page.style import BLUE, FLOOR, GREY, RED
from stiction.system.slider import Slider

VIEW = np.array([[1.0, 0.0], [0.35, 0.62], [0.0, 0.8]])  # oblique projection of X, Y and Z


def draw_apparatus(ax: Axes, slider: Slider) -> Axes:
    """Draw a pin on a cantilever above a moving plate (Nakano & Popov, Fig. 1).

    The leaf spring bends easily along x and hardly yields along y; mounted a little askew, its
    principal axes (red) lie at the misalignment phi to the drive direction (blue).
    """
    phi = drawn_misalignment(slider.misalignment)
    turn = np.array([[np.cos(phi), -np.sin(phi), 0], [np.sin(phi), np.cos(phi), 0], [0, 0, 1]])
    _draw_plate(ax)
    _draw_cantilever(ax, turn)
    for axis, color, text in (
        ([(0, 0, 0), (2.7, 0, 0)], BLUE, "$X$"),
        (np.array([(0, 0, 0), (2.7, 0, 0)]) @ turn, RED, "$x$"),
        (np.array([(0, -1.6, 0), (0, 3.9, 0)]) @ turn, RED, "$y$"),
    ):
        tail, head = _project(axis)
        way = (head - tail) / np.hypot(*(head - tail))
        shapes.line(ax, [tail, head], color, 0.8, "-.", zorder=2.5)
        shapes.arrow(ax, [head - 0.1 * way, head], color, 0.8)
        shapes.name(ax, head + 0.2 * way, text, color)
    if phi:
        arc = np.c_[shapes.arc_path((0, 0), 2.2, -phi, 0), np.zeros(60)]
        shapes.line(ax, _project(arc))
        middle = np.array([np.cos(phi / 2), -np.sin(phi / 2), 0])
        shapes.name(ax, _project(2.45 * middle), r"$\varphi$")
    note = misalignment_note(slider.misalignment)
    ax.text(0.98, 0.0, note, transform=ax.transAxes, ha="right", va="bottom", fontsize=7)
    shapes.fit_view(ax, [(0.0, -2.0)], (0.03, 0.03))
    return ax


def _draw_plate(ax: Axes) -> None:
    """Draw the plate and the velocity at which it moves towards the pin's holder."""
    left, right, front, back, bottom = -2.6, 3.2, -1.9, 1.7, -0.25
    top = _project([(left, front, 0), (right, front, 0), (right, back, 0), (left, back, 0)])
    edge = _project([(left, front, bottom), (right, front, bottom), (right, back, bottom)])
    shapes.polygon(ax, [top[0], top[1], edge[1], edge[0]], face="#C9C9C9", zorder=1.0)
    shapes.polygon(ax, [top[1], top[2], edge[2], edge[1]], face="#B5B5B5", zorder=1.0)
    shapes.polygon(ax, top, face=FLOOR, zorder=1.0)
    shapes.name(ax, _project((-1.6, -1.55, 0)), "plate", size=7)
    shapes.arrow(ax, _project([(-0.9, -0.65, 0), (-2.1, -0.65, 0)]), BLUE, 2.0)
    shapes.name(ax, _project((-1.4, -0.3, 0)), "$V$", BLUE)


def _draw_cantilever(ax: Axes, turn: Floats) -> None:
    """Draw the pin, the leaf spring that holds it, and the clamp at the leaf's other end."""

    def put(points: ArrayLike) -> Floats:
        return _project(np.asarray(points) @ turn)

    low, high, length = 0.75, 1.35, 2.6
    pin = [(-0.09, 0.0), (0.09, 0.0), (0.09, low), (-0.09, low)]
    leaf = [(0, -0.2, low), (0, length, low), (0, length, high), (0, -0.2, high)]
    shapes.polygon(ax, pin, face="#8A8A8A", zorder=3.2)
    shapes.polygon(ax, put(leaf), face="#DDE8F0", zorder=3.4)
    near, wide, bottom, top = length, 0.3, low - 0.2, high + 0.2
    far = near + 0.5
    toward = 1 if turn[0] @ (0.35, -1.0, 0.775) > 0 else -1  # the visible side
    front = [(x, near, z) for x, z in ((-wide, bottom), (wide, bottom), (wide, top), (-wide, top))]
    side = [
        (toward * wide, y, z) for y, z in ((near, bottom), (far, bottom), (far, top), (near, top))
    ]
    lid = [(x, y, top) for x, y in ((-wide, near), (wide, near), (wide, far), (-wide, far))]
    for part, face in ((front, "#A5A5A5"), (side, "#8A8A8A"), (lid, "#C9C9C9")):
        shapes.polygon(ax, put(part), face=face, zorder=3.6)
    leans = np.sign(put((0, 1, 0))[0]) or 1
    beside = put((0, 0.5 * length, high)) + np.array([-0.75 * leans, 0.2])
    shapes.name(ax, beside, "leaf spring", size=7)
    shapes.name(ax, (-0.4 * leans, 0.3), "pin", size=7)


def _project(points: ArrayLike) -> Floats:
    seen: Floats = np.asarray(points, dtype=np.float64) @ VIEW
    return seen


def draw_side_view(ax: Axes, slider: Slider) -> Axes:
    """Draw the slider from the side (Nakano & Popov, Fig. 2(a))."""
    damped = slider.c_x > 0 or slider.c_y > 0
    velocity = slider.motion.rate(0.0)[0]
    _draw_floor(ax)
    shapes.polygon(ax, [(0, 0), (1.2, 0), (1.2, 0.9), (0, 0.9)], face="#D5D5D5")
    shapes.name(ax, (0.6, 0.45), "$m$")
    shapes.arrow(ax, [(0.6, 1.75), (0.6, 0.93)], width=1.6)
    shapes.name(ax, (0.92, 1.5), "$W$")
    offset = 0.23 if damped else 0.0
    shapes.line(ax, shapes.spring_path((1.2, 0.45 + offset), (3.4, 0.45 + offset), 0.17))
    if damped:
        shapes.dashpot(ax, (1.2, 0.45 - offset), (3.4, 0.45 - offset), 0.15)
    shapes.line(ax, [(3.4, 0.05), (3.4, 0.85)], GREY, 3.0)
    shapes.name(ax, (2.3, 0.95 + offset / 2), "spring and damper" if damped else "spring", size=7)
    if velocity:
        ends = np.array([(3.5, 0.45), (4.6, 0.45)])
        shapes.arrow(ax, ends if velocity > 0 else ends[::-1], BLUE, 2.0)
    shapes.name(ax, (4.05, 0.8), "$V$" if velocity else "$V = 0$", BLUE)
    shapes.arrow(ax, [(3.9, -0.45), (4.9, -0.45)], BLUE, 0.7)
    shapes.name(ax, (5.1, -0.45), "$X$", BLUE)
    shapes.fit_view(ax, [(-0.6, -0.6), (5.3, 1.85)], (0.03, 0.03))
    return ax


def _draw_floor(ax: Axes) -> None:
    """Draw the ground line with the hatching of a fixed support."""
    shapes.line(ax, [(-0.5, 0), (5.2, 0)], width=1.0)
    for x in np.arange(-0.4, 3.6, 0.2):
        shapes.line(ax, [(x, 0), (x - 0.12, -0.16)], width=0.5)
    shapes.name(ax, (0.6, -0.42), "floor", size=7)
