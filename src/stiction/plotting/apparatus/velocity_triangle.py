"""The velocities of the slider, and how they add up."""

from __future__ import annotations

from math import pi

import numpy as np
from matplotlib.axes import Axes

from stiction.arrays import Floats
from stiction.plotting.apparatus import shapes
from stiction.plotting.apparatus.misalignment import (
    Placement,
    drawn_misalignment,
    drawn_slip_angle,
    placement,
)
from stiction.plotting.apparatus.shapes import polar
from stiction.plotting.page.style import BLUE, GREEN, RED
from stiction.system.slider import Slider


def draw_velocity_triangle(ax: Axes, slider: Slider) -> Axes:
    """Draw drive velocity = elongation rates + slip velocity (Nakano & Popov, Fig. 2(c)).

    With the angles phi from x to X, theta from x to the slip velocity, psi = theta - phi
    from X to the slip velocity, at the misalignment at which `draw_schematic` draws it.

    Parameters
    ----------
    ax : Axes
        Drawn on without frame, with equal aspect.
    slider : Slider
        The system; only its misalignment matters.
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
