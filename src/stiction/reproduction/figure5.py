"""Fig. 5: the damping diagram."""

from __future__ import annotations

from math import degrees, radians, sin

import numpy as np
from matplotlib.figure import Figure

from stiction import theory
from stiction.plotting.page.style import BLUE, COLUMN, GREEN, RED, new_figure, style
from stiction.plotting.stability.damping import (
    CLEAR,
    draw_damping_map,
    draw_force_path,
    name_crossing,
    place_clear,
)
from stiction.system.slider import Slider

# places of a word, shares of width and height, the best first
ACROSS = sorted(np.linspace(0.18, 0.84, 34), key=lambda x: abs(x - 0.45))
WORD = (0.12, 0.05)  # half of a word
HIGH, LOW = (0.92, 0.86, 0.8, 0.72, 0.64), (0.15, 0.1, 0.2, 0.28)


def figure5(slider: Slider, other_phi: float | None = radians(10)) -> Figure:
    """Draw Fig. 5 of Nakano & Popov: the damping ratio along the path of the friction force.

    Parameters
    ----------
    slider : Slider
        The system, misaligned and driven; its path is red.
    other_phi : float or None
        Misalignment of a second path, in blue, rad; everything else is the slider's.

    Returns
    -------
    Figure
        As wide as a column.

    Raises
    ------
    ValueError
        Without misalignment or drive, because the damping number A is undefined.
    """
    with style():
        fig = new_figure(COLUMN, 2.9)
        ax = fig.subplots()
        angles = [slider.misalignment] if other_phi is None else [slider.misalignment, other_phi]
        paths = [(damping_number(slider, phi), phi) for phi in angles]
        low = min(1e-1, *(A / 10 for A, _ in paths))
        high = max(1e5, *(A * 10 for A, _ in paths))
        lowest = min(0.5, degrees(abs(slider.misalignment)) / 2)
        draw_damping_map(ax, (low, high), (lowest, 90.0))
        for (A, phi), color in zip(paths, (RED, BLUE), strict=False):
            draw_force_path(ax, A, phi, color, _label(A, phi))
        fig.legend(loc="outside upper center", ncols=2)
        fig.draw_without_rendering()  # the axes have their final size: words are placed in it
        for A, phi in paths:
            name_crossing(ax, A, phi)
        at = np.geomspace(low, high, 40)[2:-2]
        edge = np.degrees(theory.critical_angle(np.maximum(at, 1.0)))
        name = ax.text(0.0, 0.0, r"$\zeta$ = 1", color=GREEN, ha="right", va="top", bbox=CLEAR)
        place_clear(
            name, [{"position": each} for each in zip(at[::-1], 0.88 * edge[::-1], strict=True)]
        )
        for text, heights, inner in (
            ("overdamped:\nslow creep", HIGH, -1.0),
            ("underdamped:\nrapid slip", LOW, 1.0),
        ):
            word = ax.text(0.0, 0.0, text, transform=ax.transAxes, ha="center", bbox=CLEAR)
            word.set(verticalalignment="center", fontsize=7)
            # the corner nearest to the boundary is on the word's own side of it
            own = [
                {"position": (x, y)}
                for y in heights
                for x in ACROSS
                if inner
                * np.log(
                    theory.damping_ratio(
                        low * (high / low) ** (x + inner * WORD[0]),
                        np.radians(lowest * (90.0 / lowest) ** (y + inner * WORD[1])),
                    )
                )
                < 0.0
            ]
            place_clear(word, own)
    return fig


def damping_number(slider: Slider, phi: float) -> float:
    """Return A of Eq. (10) for the slider at a misalignment `phi` (rad), dimensionless."""
    V = abs(slider.motion.rate(0.0)[0])
    if V == 0 or sin(phi) == 0:
        raise ValueError(f"A needs a drive and a misalignment; V is {V:g} m/s, phi {phi:g} rad")
    return theory.damping_number_of(slider, V, phi)


def _label(A: float, phi: float) -> str:
    digits, power = f"{A:.1e}".split("e")
    misalignment = f"{degrees(phi):.4g}".replace("-", "−")
    number = rf"{digits}$\times$10$^{{{int(power)}}}$" if abs(int(power)) > 1 else f"{A:.2g}"
    return rf"$\varphi$ = {misalignment}°, $A$ = {number}"
