"""Zero slip: the rests within each transverse oscillation."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure

from stiction.plotting.apparatus.vectors import draw_friction_arc, draw_friction_circle
from stiction.plotting.page.style import (
    GREEN,
    GREY,
    PAGE,
    PALE,
    PURPLE,
    new_figure,
    style,
)
from stiction.text.quantity_text import metric_prefix
from stiction.trajectory import Trajectory


def zero_slip(run: Trajectory, window: tuple[float, float]) -> Figure:
    """Draw a few transverse oscillations: slip speed, friction, and the friction vector's tip.

    The paper says that the object never stops. With friction that is set-valued at zero slip it
    rests once in each oscillation (shaded). During rest, friction is below mu_0 W, and the tip of
    the friction vector lies inside the circle.

    Parameters
    ----------
    run : Trajectory
        Sampled at 100 times the transverse frequency or more.
    window : tuple of float
        Start and end of the window, s.

    Returns
    -------
    Figure
        As wide as a page.
    """
    part = run.data.sel(time=slice(*window))
    time = (part["time"].values - window[0]) * 1e3
    with style():
        fig = new_figure(PAGE, 2.7)
        panels = fig.subplot_mosaic(
            [["speed", "circle", "arc"], ["force", "circle", "arc"]], width_ratios=[1.25, 1, 1]
        )
        speed, force, circle, arc = (panels[name] for name in ("speed", "force", "circle", "arc"))
        factor, prefix = metric_prefix(part["slip_speed"].values)
        speed.plot(time, part["slip_speed"].values * factor, color=GREEN)
        speed.set_ylabel(rf"$v_\mathrm{{slip}}$ ({prefix}m/s)")
        force.plot(time, part["friction"].values, color=PURPLE)
        F_0 = run.slider.F_0
        force.axhline(F_0, color=GREY, linewidth=0.7, zorder=1)
        force.set_ylabel("$F$ (N)")
        force.set_xlabel(f"time since {window[0]:g} s (ms)")
        at = force.get_yaxis_transform()
        force.text(0.99, F_0, r"$\mu_0 W$", transform=at, va="bottom", ha="right")
        force.margins(y=0.2)
        for ax in (speed, force):
            ax.set_xlim(0, (window[1] - window[0]) * 1e3)
            shade_sticks(ax, (run.stick_intervals - window[0]) * 1e3)
        draw_friction_circle(circle, run, window)
        slip, stick = draw_friction_arc(arc, run, window)
        arc.legend([slip, stick], ["slip", "stick"], loc="lower left")
        for ax, title in (
            (speed, "(a) Slip speed"),
            (force, "(b) Friction"),
            (circle, "(c) Friction on the mass"),
            (arc, "(d) Its tip, magnified"),
        ):
            ax.set_title(title)
        speed.tick_params(labelbottom=False)
        fig.align_ylabels([speed, force])
    return fig


def shade_sticks(ax: Axes, sticks: np.ndarray) -> PolyCollection:
    """Shade stick intervals, shape (n, 2), given in the unit of the time axis."""
    left, right = ax.get_xlim()
    seen = sticks[(sticks[:, 1] > left) & (sticks[:, 0] < right)]
    return ax.broken_barh(
        [(start, end - start) for start, end in seen],
        (0, 1),
        transform=ax.get_xaxis_transform(),
        facecolor=PALE,
        zorder=0,
    )
