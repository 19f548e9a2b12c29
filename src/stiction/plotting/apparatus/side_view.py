"""The system seen from the side: load, mass, spring, drive."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from stiction.plotting.apparatus import shapes
from stiction.plotting.page.style import BLUE, GREY
from stiction.system.slider import Slider


def draw_side_view(ax: Axes, slider: Slider) -> Axes:
    """Draw the slider from the side (Nakano & Popov, Fig. 2(a)).

    Parameters
    ----------
    ax : Axes
        Drawn on without frame, with equal aspect.
    slider : Slider
        The system, with or without dampers, pulled either way or not at all.
    """
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
