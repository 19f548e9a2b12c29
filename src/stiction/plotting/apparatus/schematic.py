"""The system seen from above: block, spring, drive, and the angles between them."""

from __future__ import annotations

from math import copysign, cos, degrees, pi, sin
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes

from stiction.arrays import Floats
from stiction.plotting.apparatus import shapes
from stiction.plotting.apparatus.shapes import (
    Placement,
    drawn_misalignment,
    drawn_slip_angle,
    misalignment_note,
    placement,
    polar,
)
from stiction.plotting.page.canvas import panel
from stiction.plotting.page.style import BLACK, BLUE, FLOOR, GREEN, GREY, PURPLE, RED, style
from stiction.system.description import Description
from stiction.system.slider import Slider, slider_of
from stiction.system.springs import compliance
from stiction.system.tensors import dampers_askew

# half side of the block; position of the bracket along x and y; its overhang
BLOCK, WALL_X, WALL_Y, OVERHANG = 0.6, 3.0, 2.7, 0.75
SEEN = 1e-3  # of the compliance along an axis: a spring with less is drawn as rigid
LINE = 0.55  # height of a line of the legend
SLIP = 1.5  # length of the arrow of the slip velocity
DAMPER = 2.2  # from the block's centre to the end of a damper with an axis of its own
BACK = 3.0  # extent of F and the axes behind the block


def plot_slider(slider: Slider | Description | str | Path, ax: Axes | None = None) -> Axes:
    """Draw the system seen from above; see `draw_schematic`.

    Parameters
    ----------
    slider : Slider, Description, str or Path
        The system, or the file of its description.
    ax : Axes, optional
        Drawn on; by default a new figure as wide as a column.

    Examples
    --------
    >>> import stiction as st
    >>> ax = st.plotting.plot_slider(st.presets.nakano_popov_2020())
    """
    with style():
        return draw_schematic(panel(ax, 2.4), slider_of(slider))


def draw_schematic(ax: Axes, slider: Slider) -> Axes:
    """Draw the slider from above (Nakano & Popov, Fig. 2(b)).

    Blue is the drive direction X, red are the principal axes x and y of the spring; the far end of
    the spring is a bracket that moves with the drive. The friction F on the block is opposite to
    its slip velocity; psi and theta are the angles of the slip to X and x, and so those of F to -X
    and -x, where they are drawn. Springs in series are numbered from the block to the bracket, a
    bar where one does not yield. Two masses have their axes in the block, dampers that do not lie
    along the springs an end of their own. Lengths are not to scale; the misalignment is, where it
    is large enough to be seen.
    """
    drawn = drawn_misalignment(slider.misalignment)
    side = copysign(1.0, drawn)
    phi, theta = abs(drawn), abs(drawn_slip_angle(drawn))
    velocity = slider.motion.rate(0.0)[0]
    lab = placement(drawn)
    ends = [
        *_draw_axes(ax, lab, phi, side),
        *_draw_spring(ax, lab, slider),
        *_draw_dampers(ax, lab, slider, side),
        *_draw_drive(ax, lab, phi, velocity),
        *_draw_slip(ax, lab, phi, theta, bool(dampers_askew(slider)), backward=velocity < 0),
    ]
    _draw_masses(ax, lab, slider, side)
    legend = _legend(slider)
    room = LINE * len(legend.splitlines())
    _frame(ax, np.vstack(ends), misalignment_note(slider.misalignment), room)
    ax.text(0.02, 0.98, legend, transform=ax.transAxes, ha="left", va="top", fontsize=7)
    return ax


def _reach(phi: float) -> float:
    """Distance along X from the block's centre to the bracket."""
    return min(WALL_X / max(cos(phi), 1e-9), WALL_Y / max(sin(phi), 1e-9))


def _draw_axes(ax: Axes, lab: Placement, phi: float, side: float) -> list[Floats]:
    """Draw the principal axes and, between x and X, the misalignment."""
    x = lab([(-BACK, 0), (WALL_X + 1.9, 0)])
    y = lab([(0, -1.5), (0, WALL_Y + 1.1)] if side > 0 else [(0, WALL_Y + 0.7), (0, -1.9)])
    for axis, text in ((x, "x"), (y, "y")):
        if _coincide(text, phi):  # X is drawn over it, with both names
            axis[1] -= 2.0 * _unit(axis)
            shapes.line(ax, axis, RED, 0.7, "-.", zorder=1)
        else:
            _draw_axis(ax, axis, f"${text}$", RED)
    if phi > 0:
        radius = 0.55 + max(_reach(phi), 3.9 if phi > 0.7 else 0.0)
        shapes.line(ax, lab(shapes.arc_path((0, 0), radius, 0, phi)))
        shapes.name(ax, lab(polar(radius + 0.35, phi / 2)), r"$\varphi$")
    return [x, y]


def _draw_spring(ax: Axes, lab: Placement, slider: Slider) -> list[Floats]:
    """Draw the block, the bracket, and between them the springs and dampers."""
    corners = BLOCK * np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
    bracket = lab([(WALL_X, -OVERHANG), (WALL_X, WALL_Y), (-OVERHANG, WALL_Y)])
    shapes.polygon(ax, lab(corners), face="#D5D5D5")
    shapes.line(ax, bracket, GREY, 3.0)
    ex, ey = np.eye(2)
    c_x, c_y = (0.0, 0.0) if dampers_askew(slider) else (slider.c_x, slider.c_y)
    for place, (axis, along, across, length, c) in enumerate(
        (("x", ex, ey, WALL_X, c_x), ("y", ey, ex, WALL_Y, c_y))
    ):
        ends, offset = np.outer([BLOCK, length], along), (0.3 if c > 0 else 0.0) * across
        if slider.springs:
            side = (1.0 if c > 0 else -1.0) * across
            _draw_series(ax, lab, ends + offset, side, _yields(slider, place))
        else:
            shapes.line(ax, lab(shapes.spring_path(*(ends + offset))))
        text, edge = "" if slider.springs else f"$k_{axis}$", 0.3
        if c > 0:
            shapes.dashpot(ax, *lab(ends - offset))
            text, edge = f"{text}, $c_{axis}$".removeprefix(", "), 0.6
        shapes.beside(ax, lab(ends.mean(axis=0) - edge * across), -lab(across), text)
    return [bracket]


def _draw_dampers(ax: Axes, lab: Placement, slider: Slider, side: float) -> list[Floats]:
    """Draw dampers with axes of their own, each towards where the drawing has most room."""
    ends = []
    drawn = drawn_misalignment(slider.misalignment)
    phi, theta = abs(drawn), abs(drawn_slip_angle(drawn))
    slip = np.array([BLOCK, BLOCK]) + polar(0.5 * SLIP, theta)  # the middle of its arrow
    taken = np.array([0.0, pi / 2, np.arctan2(*slip[::-1]), phi + pi, theta + pi])
    for name, angle in dampers_askew(slider).items():
        ways = (side * angle, side * angle + pi)
        at = min(ways, key=lambda way: float(np.cos(taken - way).max()))
        start, end = BLOCK / max(abs(cos(at)), abs(sin(at))), DAMPER
        shapes.dashpot(ax, *lab([polar(start, at), polar(end, at)]))
        bar = [polar(end, at) + polar(0.3, at + turn) for turn in (pi / 2, -pi / 2)]
        shapes.line(ax, lab(bar), GREY, 3.0)
        shapes.name(ax, lab(polar(end + 0.4, at)), f"${name}$")
        ends.append(lab([polar(end + 0.4, at)]))
    return ends


def _yields(slider: Slider, place: int) -> list[bool]:
    """Return which springs in series yield along x, or along y."""
    angle = slider.turn + 0.5 * pi * place
    e = polar(1.0, angle)
    own = [float(e @ compliance(each) @ e) for each in slider.springs]
    return [each > SEEN * sum(own) for each in own]


def _draw_series(ax: Axes, lab: Placement, ends: Floats, side: Floats, yields: list[bool]) -> None:
    """Draw springs in series with their numbers, and bars for rigid parts."""
    sizes = np.where(yields, 1.0, 0.4)
    joints = ends[0] + np.outer(np.r_[0.0, np.cumsum(sizes) / sizes.sum()], ends[1] - ends[0])
    turns = max(2, 6 - len(yields))
    for number, (start, end, soft) in enumerate(zip(joints, joints[1:], yields, strict=False), 1):
        if soft:
            shapes.line(ax, lab(shapes.spring_path(start, end, 0.18, turns)))
        else:
            shapes.line(ax, lab([start, end]), width=2.4)
        middle = lab((start + end) / 2 + 0.42 * side)
        shapes.name(ax, middle, str(number), size=6)
    x, y = lab(joints[1:-1]).T
    ax.plot(x, y, "o", color=BLACK, markersize=2.2, zorder=4)


def _draw_masses(ax: Axes, lab: Placement, slider: Slider, side: float) -> None:
    """Write the mass into the block; if two differ, draw their axes, the longer for m_x."""
    if slider.mass_y is None or slider.mass_y == slider.mass:
        shapes.name(ax, (0, 0), "$m$")
        return
    angle = side * (slider.mass_angle - slider.turn)
    for at, length, dashes in ((angle, 0.5, "-"), (angle + pi / 2, 0.3, ":")):
        shapes.line(ax, lab([polar(-length, at), polar(length, at)]), GREY, 1.0, dashes, zorder=4)


def _legend(slider: Slider) -> str:
    """Return the names of springs in series, and the axes of masses and dampers that differ."""
    lines = [f"{number}  {each.name}" for number, each in enumerate(slider.springs, 1)]
    if slider.mass_y is not None and slider.mass_y != slider.mass:
        lines.append(f"$m_x$ {_where(slider.mass_angle - slider.turn)}, $m_y$ across")
    told = [f"${name}$ {_where(at)}" for name, at in dampers_askew(slider).items()]
    lines += [", ".join(told)] if told else []
    return "\n".join(lines)


def _where(angle: float) -> str:
    """Return the direction of an axis at an angle (rad) to x in words."""
    turned = (degrees(angle) + 90.0) % 180.0 - 90.0  # an axis has no sense
    return f"{turned:.4g}° to $x$".replace("-", "−") if abs(turned) > 1e-9 else "along $x$"


def _draw_drive(ax: Axes, lab: Placement, phi: float, velocity: float) -> list[Floats]:
    """Draw the drive direction X and, where there is one, the velocity of the bracket."""
    start = _reach(phi) + 0.1
    X = lab([polar(start, phi), polar(start + 2.2, phi)])
    names = ["$X$"] + [f"${axis}$" for axis in "xy" if _coincide(axis, phi)]
    shapes.line(ax, lab([np.zeros(2), polar(-BACK, phi)]), BLUE, 0.7, "-.", zorder=1)
    _draw_axis(ax, X, ", ".join(names), BLUE)
    if velocity:
        ends = lab([polar(start, phi), polar(start + 1.4, phi)])
        shapes.arrow(ax, ends if velocity > 0 else ends[::-1], BLUE, 2.0)
    above = polar(start + (0.75 if velocity else 1.4), phi) + polar(0.5, phi + pi / 2)
    shapes.name(ax, lab(above), "$V$" if velocity else "$V = 0$", BLUE)
    return [X]


def _draw_slip(
    ax: Axes, lab: Placement, phi: float, theta: float, askew: bool, backward: bool
) -> list[Floats]:
    """Draw slip velocity and friction, opposite to each other, and their angles."""
    corner = np.array([BLOCK, BLOCK])
    ahead = lab([corner, corner + polar(SLIP, theta)])
    behind = lab([polar(-BLOCK / max(cos(theta), sin(theta)), theta), polar(-BACK, theta)])
    beside = (
        corner + polar(1.0, theta) + polar(0.7, theta + (pi / 2 if theta < pi / 4 else -pi / 2))
    )
    if askew:  # a damper may stand there
        beside = corner + polar(SLIP + 0.45, theta)
    names = [(GREEN, r"$v_\mathrm{slip}$"), (PURPLE, "$F$")]
    for ends, place, (color, text) in zip(
        (ahead, behind),
        (lab(beside), behind[1] + 0.35 * _unit(behind)),
        reversed(names) if backward else names,
        strict=True,
    ):
        shapes.arrow(ax, ends, color, 1.6)
        shapes.name(ax, place, text, color)
    between = pi + (phi + theta) / 2 if theta > phi else pi + theta / 2
    for radius, start, text in ((1.55, phi, r"$\psi$"), (2.25, 0.0, r"$\theta$")):
        if theta > start:
            shapes.line(ax, lab(shapes.arc_path((0, 0), radius, pi + start, pi + theta)))
            shapes.name(ax, lab(polar(radius + 0.3, between)), text)
    return [behind, ahead]


def _draw_axis(ax: Axes, ends: Floats, text: str, color: str) -> None:
    shapes.line(ax, ends, color, 0.7, "-.", zorder=1)
    shapes.arrow(ax, [ends[1] - 0.1 * _unit(ends), ends[1]], color, 0.7)
    shapes.name(ax, ends[1] + (0.6 if "," in text else 0.35) * _unit(ends), text, color)


def _coincide(axis: str, phi: float) -> bool:
    return abs(phi - (0 if axis == "x" else pi / 2)) < 1e-9


def _unit(ends: Floats) -> Floats:
    way: Floats = ends[1] - ends[0]
    way /= np.hypot(*way)
    return way


def _frame(ax: Axes, points: Floats, note: str, above: float) -> None:
    """Make the axes the floor, with room for labels at the ends, and for a legend above."""
    (left, bottom), (right, top) = points.min(axis=0) - 0.9, points.max(axis=0) + 0.9
    ax.margins(0)
    ax.update_datalim([(left, bottom - 0.6), (right, top + above)])
    ax.autoscale_view()
    ax.set(xticks=[], yticks=[], facecolor=FLOOR)
    ax.set_aspect("equal", adjustable="datalim")
    ax.spines[:].set_visible(False)
    for x, text, place in ((0.02, "floor ($XY$ plane)", "left"), (0.98, note, "right")):
        ax.text(x, 0.02, text, transform=ax.transAxes, ha=place, va="bottom", fontsize=7)
