"""A friction law."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from stiction.plotting.style import PURPLE
from stiction.plotting.time_series import prefixed
from stiction.slider import Slider


def draw_law(ax: Axes, slider: Slider, fastest: float) -> Line2D:
    """Draw the friction coefficient over slip speed.

    At zero slip friction takes any value up to the coefficient: the vertical line.

    Parameters
    ----------
    ax : Axes
        Drawn on.
    slider : Slider
        The system.
    fastest : float
        Largest slip speed, m/s; 1 m/s if it is zero or not finite.
    """
    top = fastest if 0 < fastest < np.inf else 1.0
    speeds = np.linspace(0.0, top, 201)
    mu = [0.0, *(slider.law.coefficient(float(speed)) for speed in speeds)]
    factor, prefix = prefixed(speeds)
    (line,) = ax.plot(np.r_[0.0, speeds] * factor, mu, color=PURPLE, linewidth=1.2)
    ax.set_xlim(-0.03 * top * factor, top * factor)
    ax.set_ylim(0.0, 1.2 * max(mu) or 1.0)
    ax.set_xlabel(rf"$v_\mathrm{{slip}}$ ({prefix}m/s)")
    ax.set_ylabel(r"$\mu$ (1)")
    return line
