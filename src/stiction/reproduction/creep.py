"""Figures beside the paper's: creep against theory, and a close view of zero slip."""

from __future__ import annotations

from math import sin

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure

from stiction import theory
from stiction.analysis.creep.first_slip import first_slip_time, mean_creep_velocity
from stiction.plotting.apparatus.vectors import draw_friction_arc, draw_friction_circle
from stiction.plotting.page.style import (
    BLACK,
    BLUE,
    COLUMN,
    GREEN,
    GREY,
    PAGE,
    PALE,
    PURPLE,
    RED,
    new_figure,
    style,
)
from stiction.text.quantity.prefix import metric_prefix
from stiction.trajectory import Trajectory

THEORIES = (
    (theory.creep_velocity, "Eq. (7), closed form", BLUE, "-"),
    (theory.creep_velocity_approximation, "Eq. (8), corrected", GREEN, (0, (5, 2))),
    (theory.creep_velocity_as_printed, "Eq. (8), as printed", RED, (0, (1, 1.5))),
)


def creep(run: Trajectory) -> Figure:
    """Draw the creep velocity before the first slip, simulated and from theory.

    (a) X' of the run, averaged over the transverse oscillation, the solution of Eq. (7), and
    Eq. (8) with the numerator V t/l_x that its derivation gives and with the printed
    (V t/l_x)^2. (b) Their deviations from Eq. (7).

    Parameters
    ----------
    run : Trajectory
        From rest at u = 0, misaligned and driven with a constant velocity.

    Returns
    -------
    Figure
        As wide as a column.

    Raises
    ------
    ValueError
        Without misalignment or drive, because there is no creep.
    """
    slider = run.slider
    V, phi = slider.drive_speed, abs(slider.misalignment)
    if V == 0 or sin(phi) == 0:
        raise ValueError(f"creep needs a drive and a misalignment; V is {V:g} m/s, phi {phi:g} rad")
    l_x = float(theory.slip_length(slider.F_0, slider.k_x))
    mean = mean_creep_velocity(run)
    seen, speed = mean["time"].values, np.abs(mean.values)
    time = np.linspace(0, first_slip_time(run), 1002)[1:-1]
    with style():
        fig = new_figure(COLUMN, 4.0)
        value, deviation = fig.subplots(2, 1, sharex=True, height_ratios=[1.5, 1])
        value.plot(seen, speed, ".", color=BLACK, markersize=2.5, label="simulated, mean")
        ratio = speed / theory.creep_velocity(seen, V, phi, l_x)
        deviation.plot(seen, 100 * (ratio - 1), ".", color=BLACK, markersize=2.5)
        exact = theory.creep_velocity(time, V, phi, l_x)
        for formula, label, color, dashes in THEORIES:
            velocity = formula(time, V, phi, l_x)
            value.plot(time, velocity, color=color, linestyle=dashes, linewidth=1.3, label=label)
            drawn = 100 * (velocity / exact - 1)
            deviation.plot(time, drawn, color=color, linestyle=dashes, linewidth=1.3)
        _label(value, deviation)
        value.set_xlim(0, time[-1])
    return fig


def _label(value: Axes, deviation: Axes) -> None:
    value.set_yscale("log")
    value.set_ylabel(r"$\dot{X}$ (m/s)")
    value.legend(loc="upper left")
    deviation.set_yscale("symlog", linthresh=1.0, linscale=0.6)
    deviation.set_ylim(-100, 100)
    deviation.set_yticks([-100, -10, -1, 0, 1, 10, 100])
    deviation.set_yticklabels(["−100", "−10", "−1", "0", "1", "10", "100"])
    deviation.set_ylabel("deviation (%)")
    deviation.set_xlabel("time $t$ (s)")
    value.set_title("(a) Creep velocity")
    deviation.set_title("(b) Deviation from Eq. (7)")


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
        arc.legend([slip, stick], ["slip", "stick"], loc="upper left")
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
