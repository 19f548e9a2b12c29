"""Fig. 5: the damping diagram."""

from __future__ import annotations

from collections.abc import Sequence
from math import degrees, log, radians, sin

from matplotlib.figure import Figure

from stiction import theory
from stiction.plotting.page.style import BLUE, COLUMN, GREEN, RED, new_figure, style
from stiction.plotting.stability.damping import CLEAR, draw_damping_map, draw_force_path
from stiction.system.slider import Slider

PLACES = (0.41, 0.6, 0.75, 0.25)  # of a label in the diagram, the best first
HALF = 0.17  # of its width, with a margin


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
        middle = clear_of([A for A, _ in paths], low, high)
        for place, text in (
            ((middle, 0.93), "overdamped:\nslow creep"),
            ((0.29, 0.15), "underdamped:\nrapid slip"),
        ):
            ax.text(*place, text, transform=ax.transAxes, ha="center", va="center", bbox=CLEAR)
        at = min(high / 2.5, 1.0 / sin(radians(2.0 * lowest)) ** 3)  # above the lower edge
        boundary = float(degrees(theory.critical_angle(at)))
        ax.text(at, 0.88 * boundary, r"$\zeta$ = 1", color=GREEN, ha="right", va="top", bbox=CLEAR)
        fig.legend(loc="outside upper center", ncols=2)
    return fig


def clear_of(numbers: Sequence[float], low: float, high: float) -> float:
    """Return the first place for the upper label, as a share of the axis of A, clear of paths."""
    taken = [log(A / low) / log(high / low) for A in numbers]
    return max(PLACES, key=lambda place: min(HALF, *(abs(place - at) for at in taken)))


def damping_number(slider: Slider, phi: float) -> float:
    """Return A of Eq. (10) for the slider at a misalignment `phi` (rad), dimensionless."""
    V = abs(slider.motion.rate(0.0)[0])
    if V == 0 or sin(phi) == 0:
        raise ValueError(f"A needs a drive and a misalignment; V is {V:g} m/s, phi {phi:g} rad")
    return float(theory.damping_number(slider.F_0, V, abs(phi), slider.mass, slider.k_x))


def _label(A: float, phi: float) -> str:
    digits, power = f"{A:.1e}".split("e")
    misalignment = f"{degrees(phi):.4g}".replace("-", "−")
    number = rf"{digits}$\times$10$^{{{int(power)}}}$" if abs(int(power)) > 1 else f"{A:.2g}"
    return rf"$\varphi$ = {misalignment}°, $A$ = {number}"
