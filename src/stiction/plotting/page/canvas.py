"""The canvas of a figure: given axes, or axes of a new figure."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from contextvars import ContextVar
from typing import Any, TypeVar

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import ScalarFormatter

from stiction.errors import DescriptionError, StictionError, echo
from stiction.plotting.page.style import COLUMN, SHEET, new_figure
from stiction.text.validation import unknown_name

Drawing = TypeVar("Drawing", bound=Callable[..., Any])

_alone: ContextVar[bool] = ContextVar("alone", default=False)


def canvas(width: float, height: float) -> Figure:
    """Return a new figure of a size (in), registered with pyplot so that notebooks show it.

    Inside `figure_of` it is not registered.
    """
    if _alone.get():
        return new_figure(width, height)
    from matplotlib import pyplot

    return pyplot.figure(figsize=(width, height), layout="constrained")


def panel(ax: Axes | None, height: float) -> Axes:
    """Return the given axes, or axes of a new figure of this height (in), as wide as a column."""
    return fix_ticks([canvas(COLUMN, height).subplots()])[0] if ax is None else ax


def stack(axes: Any, height: float, ratios: Sequence[float]) -> Sequence[Axes]:
    """Return the given axes, or axes of a new figure of this height (in), as wide as a column.

    They stand above each other on one x axis, their heights in these ratios.
    """
    panels = grid_of(axes, (COLUMN, height), len(ratios), 1, sharex=True, height_ratios=ratios)
    if axes is None:
        whole_figure(panels[0]).align_ylabels(panels)
    return panels


def grid_of(
    axes: Any, size: tuple[float, float], rows: int, columns: int, **how: Any
) -> Sequence[Axes]:
    """Return the given axes, or a grid of panels, row by row, on a new figure of a size (in)."""
    if axes is not None:
        return as_list(axes)
    return fix_ticks(list(canvas(*size).subplots(rows, columns, squeeze=False, **how).ravel()))


def as_list(axes: Any) -> list[Axes]:
    """Return a single axes, or an array or a mapping of axes, as a list."""
    if isinstance(axes, Axes):
        return [axes]
    return list(axes.values()) if isinstance(axes, Mapping) else list(np.ravel(axes))


def fix_ticks(axes: Sequence[Axes]) -> Sequence[Axes]:
    """Fix the tick style of axes, which are drawn later without the style sheet."""
    for ax in axes:
        for way in "xy":
            for which in ("major", "minor"):
                look = {
                    "direction": SHEET[f"{way}tick.direction"],
                    "width": SHEET[f"{way}tick.{which}.width"],
                }
                ax.tick_params(axis=way, which=which, **look)  # type: ignore[arg-type]
            size = {"length": SHEET[f"{way}tick.major.size"]}
            size["labelsize"] = SHEET[f"{way}tick.labelsize"]
            ax.tick_params(axis=way, which="major", **size)  # type: ignore[arg-type]
        ax.tick_params(which="both", top=True, right=True)
        for axis in (ax.xaxis, ax.yaxis):
            axis.set_major_formatter(PlainNumbers())
    return axes


class PlainNumbers(ScalarFormatter):
    """Labels of ticks in plain text; a power of ten beside an axis is a formula as before.

    To parse and lay out a formula takes fifty times as long, and few are remembered.
    """

    def __call__(self, x: float, pos: int | None = None) -> str:
        """Return the label of a tick."""
        return super().__call__(x, pos).removeprefix(r"$\mathdefault{").removesuffix("}$")


def panels_by_name(axes: Any) -> dict[str, Axes]:
    """Return the axes that a user gives for a figure of several panels, by the panels' names."""
    if not isinstance(axes, Mapping):
        remedy = "name those to draw, such as {'force': ax}"
        said = f"is {echo(axes)}, but the figure has several panels: {remedy}"
        raise DescriptionError.of("axes", said)
    return dict(axes)


def find_drawing(drawings: Mapping[str, Drawing], name: str) -> Drawing:
    """Return the function that draws a panel."""
    if name not in drawings:
        raise StictionError(unknown_name("panel", name, drawings))
    return drawings[name]


def figure_of(draw: Callable[..., Any], *arguments: Any, **values: Any) -> Figure:
    """Return the figure of a function of `stiction.plotting`, unknown to pyplot."""
    token = _alone.set(True)
    try:
        axes: Iterable[Axes] = as_list(draw(*arguments, **values))
    finally:
        _alone.reset(token)
    return whole_figure(next(iter(axes)))


def whole_figure(ax: Axes) -> Figure:
    """Return the whole figure that contains axes, not a subfigure."""
    figure: Any = ax.figure
    while not isinstance(figure, Figure):
        figure = figure.figure if figure.figure is not figure else figure._parent
    return figure
