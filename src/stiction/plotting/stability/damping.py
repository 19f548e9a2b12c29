"""The damping diagram: the damping ratio over force angle and damping number."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap, Normalize
from matplotlib.contour import QuadContourSet
from matplotlib.lines import Line2D
from matplotlib.markers import CARETDOWN
from matplotlib.text import Text
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from stiction import theory
from stiction.arguments import is_list
from stiction.errors import DescriptionError, echo
from stiction.plotting.page.canvas import panel
from stiction.plotting.page.style import BLACK, GREEN, style

SHADES = LinearSegmentedColormap.from_list("damping", ["#E9BE8B", "#FFFFFF", "#9DBDD3"])
CLEAR = {"facecolor": "white", "alpha": 0.75, "edgecolor": "none", "pad": 1.0}
DECADES = np.arange(-7, 7)
BOLD = 1.0  # pt: words keep clear of such contours
MARGIN = 4.0  # pixels around a word


def draw_damping_map(
    ax: Axes, A: tuple[float, float] = (1e-1, 1e5), theta: tuple[float, float] = (0.5, 90.0)
) -> QuadContourSet:
    """Map zeta = A sin^3(theta), Eq. (10), over A and theta, with a contour at every decade.

    The boundary zeta = 1 is green: above it the slow motion is overdamped (creep), below it
    underdamped (rapid slip).

    The range of `theta` is in deg. The contour zeta = 1 is returned.
    """
    across, up = np.geomspace(*A, 200), np.geomspace(*theta, 200)
    zeta = theory.damping_ratio(across[None, :], np.radians(up[:, None]))
    edge = float(np.abs(DECADES).max())
    ax.set(xscale="log", yscale="log", xlim=A, ylim=theta)
    ax.contourf(
        across, up, np.log10(zeta), DECADES, cmap=SHADES, norm=Normalize(-edge, edge), extend="both"
    )
    decades = ax.contour(
        across, up, zeta, 10.0 ** DECADES[DECADES != 0], colors=BLACK, linewidths=0.4
    )
    boundary = ax.contour(across, up, zeta, [1.0], colors=GREEN, linewidths=2.0)
    _name_decades(ax, decades, A, theta)
    ax.yaxis.set_major_locator(FixedLocator([0.5, 1, 2, 5, 10, 20, 45, 90]))
    ax.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    ax.yaxis.set_minor_locator(NullLocator())
    ax.set_xlabel(r"damping number $A$ (1)")
    ax.set_ylabel(r"force angle $\theta$ (deg)")
    return boundary


def plot_damping(
    A: tuple[float, float] = (1e-1, 1e5),
    theta: tuple[float, float] = (0.5, 90.0),
    ax: Axes | None = None,
) -> Axes:
    """Draw the damping diagram: the damping ratio over damping number and force angle.

    Parameters
    ----------
    A, theta
        Ranges, as of `draw_damping_map`.
    ax : Axes, optional
        Drawn on; by default a new figure as wide as a column.

    Examples
    --------
    >>> import stiction as st
    >>> ax = st.plotting.plot_damping()
    """
    for name, ends in (("A", A), ("theta", theta)):
        if not is_list(ends) or len(ends) != 2:
            raise DescriptionError.of(name, f"{echo(ends)} is not a range; give its two ends")
    with style():
        ax = panel(ax, 2.7)
        draw_damping_map(ax, A, theta)
    return ax


def draw_force_path(ax: Axes, A: float, phi: float, color: str, label: str) -> Line2D:
    """Draw the path of the friction force during creep: at constant A from 90 deg down to phi.

    Where the path meets zeta = 1 a cross marks the change from slow to fast slip.
    """
    end = float(np.degrees(abs(phi)))
    (path,) = ax.plot([A, A], [90.0, end], color=color, linewidth=1.8, label=label, zorder=4)
    ax.plot([A], [end], color=color, marker=CARETDOWN, markersize=7, zorder=4)
    crossing = float(np.degrees(theory.critical_angle(A)))
    if crossing > end:
        ax.plot([A], [crossing], color=BLACK, marker="x", markersize=7, mew=1.8, zorder=5)
    return path


def name_crossing(ax: Axes, A: float, phi: float) -> None:
    """Write the force angle beside the cross of a path, clear of all that is drawn before."""
    crossing = float(np.degrees(theory.critical_angle(A)))
    if crossing > np.degrees(abs(phi)):
        text = ax.annotate(
            rf"$\theta$ = {crossing:.1f}°",
            (A, crossing),
            (0.0, 0.0),
            textcoords="offset points",
            fontsize=7,
            bbox=CLEAR,
            zorder=6,
        )
        place_clear(
            text,
            [
                {"position": (x * gap, y * gap), "ha": ha, "va": va}
                for gap in (4, 7, 12, 20, 30)
                for (x, ha), (y, va) in product(
                    ((1, "left"), (-1, "right")), ((1, "bottom"), (-1, "top"), (0, "center"))
                )
            ],
        )


def place_clear(text: Text, places: Sequence[dict[str, Any]]) -> None:
    """Put a text at the first of the places, in its properties, that hides least.

    Other words weigh most, then lines and markers; a text beyond the axes is the worst. The lines
    of the contours do not count.
    """
    ax = text.axes
    assert ax is not None
    words = [each.get_window_extent() for each in ax.texts if each is not text]
    lines = [
        each.get_transform().transform_path(each.get_path()).interpolated(50).vertices
        for each in ax.lines
    ]
    lines += [
        each.get_transform().transform_path(path).vertices
        for each in ax.collections
        if np.max(each.get_linewidth()) > BOLD
        for path in each.get_paths()
    ]
    drawn = np.concatenate([np.zeros((0, 2)), *lines])
    inner = ax.get_window_extent()

    def hidden(place: dict[str, Any]) -> float:
        text.set(**place)
        box = text.get_window_extent().padded(MARGIN)
        outside = not (
            inner.x0 < box.x0 and box.x1 < inner.x1 and inner.y0 < box.y0 and box.y1 < inner.y1
        )
        covered = float(np.all((drawn > box.min) & (drawn < box.max), axis=1).mean())
        return 100.0 * outside + 10.0 * sum(map(box.overlaps, words)) + covered

    text.set(**min(places, key=hidden))


def _name_decades(
    ax: Axes, decades: QuadContourSet, A: tuple[float, float], theta: tuple[float, float]
) -> None:
    """Write the damping ratio on each contour: at the right where zeta > 1, else at the left."""
    places = []
    for power in DECADES[DECADES != 0]:
        at = A[1] / 2.2 if power > 0 else A[0] * 2.5
        angle = np.degrees(theory.critical_angle(at / 10.0**power))
        if 1.15 * theta[0] < angle < 0.9 * theta[1]:
            places.append((at, float(angle)))
    ax.clabel(
        decades,
        fmt=lambda zeta: rf"$10^{{{np.log10(zeta):.0f}}}$",
        fontsize=7,
        inline_spacing=2,
        manual=places,
    )
