"""A friction law."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from stiction.friction import has_state
from stiction.friction.law import static_coefficient
from stiction.friction.laws.rate_and_state.common import SLOWEST
from stiction.plotting.page.canvas import panel
from stiction.plotting.page.style import PURPLE, style
from stiction.system.description import Description
from stiction.system.slider import Slider, slider_of
from stiction.text.quantity.prefix import metric_prefix
from stiction.text.units import VELOCITY, Quantity
from stiction.text.validation import read_number


def plot_law(
    slider: Slider | Description | str | Path,
    fastest: Quantity | None = None,
    ax: Axes | None = None,
) -> Axes:
    """Draw the friction coefficient of a slider over slip speed.

    Parameters
    ----------
    slider : Slider, Description, str or Path
        The system, or the file of its description.
    fastest : float or str, optional
        Largest slip speed, m/s; by default ten times that of the drive.
    ax : Axes, optional
        Drawn on; by default a new figure as wide as a column.

    Examples
    --------
    >>> import stiction as st
    >>> ax = st.plotting.plot_law(st.presets.nakano_popov_2020(), "20 mm/s")
    """
    slider = slider_of(slider)
    speed = 10.0 * slider.drive_speed
    if fastest is not None:
        speed = read_number("fastest", fastest, VELOCITY)
    with style():
        ax = panel(ax, 2.2)
        draw_law(ax, slider, speed)
    return ax


def draw_law(ax: Axes, slider: Slider, fastest: float) -> Line2D:
    """Draw the friction coefficient over slip speed.

    At zero slip friction takes any value up to the static coefficient: the vertical line. For a law
    with internal state the coefficient is that of steady sliding, over the logarithm; not below
    1 pm/s, where it is constant under rate and state, which have no steady state at rest.

    The `fastest` slip speed is in m/s; 1 m/s if it is zero or not finite.
    """
    top = fastest if 0 < fastest < np.inf else 1.0
    law, rests = slider.law, not has_state(slider.law)
    least = min(max(1e-6 * top, SLOWEST), 0.1 * top)
    speeds = np.linspace(0.0, top, 201) if rests else np.geomspace(least, top, 201)
    mu = [law.coefficient(float(speed)) for speed in speeds]
    factor, prefix = metric_prefix(speeds)
    speeds *= factor
    if rests:
        largest = max(static_coefficient(law), mu[0])
        (line,) = ax.plot(np.r_[0.0, 0.0, speeds], [0.0, largest, *mu], color=PURPLE, linewidth=1.2)
        ax.set_xlim(-0.03 * top * factor, top * factor)
    else:
        (line,) = ax.semilogx(speeds, mu, color=PURPLE, linewidth=1.2)
        ax.set_xlim(speeds[0], speeds[-1])
        largest = max(mu)
    ax.set_ylim(0.0, 1.2 * max(largest, *mu) or 1.0)
    ax.set_xlabel(rf"$v_\mathrm{{slip}}$ ({prefix}m/s)")
    ax.set_ylabel(r"$\mu$ (1)" if rests else r"$\mu$, steady (1)")
    return line
