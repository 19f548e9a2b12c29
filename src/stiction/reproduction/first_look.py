"""A first look at the system: the rig, the rotating friction force, and its effects."""

from __future__ import annotations

from math import pi, radians

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from stiction.analysis.creep.first_slip import first_slip_time
from stiction.plotting.apparatus.pin_on_plate import draw_apparatus
from stiction.plotting.apparatus.shapes import arc_path, arrow, line, name, polar, polygon
from stiction.plotting.page.canvas import fix_ticks
from stiction.plotting.page.style import BLUE, PAGE, PALE, PURPLE, new_figure, style
from stiction.plotting.run import time_series
from stiction.reproduction.figures import magnify_creep
from stiction.trajectory import Trajectory

MOMENTS = 5  # at which the friction force is drawn, until shortly before the first slip
LATEST = 0.985  # of the time until then


def first_look(run: Trajectory) -> Figure:
    """Draw the rig, the rotation of friction, and load cell, friction and mass over time.

    Parameters
    ----------
    run : Trajectory
        The paper's runs 5 s; any other that slips will do.

    Returns
    -------
    Figure
        As wide as a page.
    """
    with style():
        fig = new_figure(PAGE, 4.2)
        places = fig.subplot_mosaic(
            [["rig", "cell"], ["rig", "friction"], ["turn", "friction"], ["turn", "mass"]],
            width_ratios=[1.0, 1.5],
            height_ratios=[1.0, 0.5, 0.5, 1.2],
        )
        draw_apparatus(places["rig"], run.slider)
        places["rig"].set_title("The rig: stiff across, and slightly askew")
        _draw_turn(places["turn"], run)
        over_time = fix_ticks([places[each] for each in ("cell", "friction", "mass")])
        time_series.draw_spring_force(over_time[0], run, "x")
        time_series.draw_direction(over_time[1], run)
        time_series.draw_position(over_time[2], run)
        magnify_creep(over_time[2], run)
        titles = (
            "The load cell shows stick and slip",
            "Friction turns at constant magnitude; $\\psi$ is its angle to the drive",
            "The mass creeps, then slips",
        )
        for ax, title in zip(over_time, titles, strict=True):
            ax.margins(y=0.12)
            ax.set_title(title, loc="left")
        over_time[0].tick_params(labelbottom=False)
        over_time[1].tick_params(labelbottom=False)
        over_time[2].set_xlabel("time $t$ (s)")
        fig.align_ylabels(over_time)
    return fig


def _draw_turn(ax: Axes, run: Trajectory) -> None:
    """Draw the friction force at some moments before the first slip, and the arc of its tip."""
    end = LATEST * first_slip_time(run)
    time, psi, force = (run.samples[column] for column in ("time", "psi", "friction"))
    moments = np.searchsorted(time, np.linspace(end / MOMENTS**2, end, MOMENTS))
    radius = float(force[moments].max())
    line(ax, arc_path((0.0, 0.0), radius, pi, 1.5 * pi), PURPLE, dashes=":")
    for i in moments:
        back = polar(1.0, pi + radians(float(psi[i])))
        arrow(ax, [(0.0, 0.0), force[i] * back], PURPLE)
        name(ax, 1.2 * radius * back, f"{time[i]:.1f} s")
    half = 0.09 * radius
    polygon(ax, half * np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]), PALE, zorder=6.0)
    arrow(ax, [(half, 0.0), (0.5 * radius, 0.0)], BLUE)
    name(ax, (0.69 * radius, 0.0), "drive", BLUE)
    ax.set_xlim(-1.5 * radius, 0.9 * radius)
    ax.set_ylim(-1.35 * radius, 0.15 * radius)
    ax.set_aspect("equal")
    ax.axis("off")
    ax.set_title("Friction on the mass, from above")
