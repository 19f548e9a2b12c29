"""A run at a glance: forces, direction of friction and slip speed, side by side."""

from __future__ import annotations

from collections.abc import Mapping

from matplotlib.axes import Axes

from stiction.plotting.page.canvas import canvas, fix_ticks
from stiction.plotting.page.style import PAGE, style
from stiction.plotting.run.overview import plot_run
from stiction.trajectory import Trajectory

SHOWN = ("force", "direction", "speed")
HEIGHT = 1.9  # in


def plot_glance(run: Trajectory, axes: Mapping[str, Axes] | None = None) -> dict[str, Axes]:
    """Draw a run small: spring forces, direction of friction, slip speed.

    Parameters
    ----------
    run : Trajectory
        Any run.
    axes : mapping of str to Axes, optional
        As of `stiction.plotting.plot_run`; a new figure as wide as a page when left out.

    Returns
    -------
    dict of str to Axes
        The axes by their names.

    Examples
    --------
    >>> import stiction as st
    >>> run = st.simulate(st.presets.nakano_popov_2020(), "0.1 s", sample_rate="10 kHz")
    >>> axes = st.plotting.plot_glance(run)
    """
    with style():
        panels = axes
        if panels is None:
            made = canvas(PAGE, HEIGHT).subplots(1, len(SHOWN))
            panels = dict(zip(SHOWN, fix_ticks(list(made)), strict=True))
    return plot_run(run, panels)
