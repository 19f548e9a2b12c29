"""The style of figures: column widths, colours for any colour vision, one style sheet."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

# Okabe & Ito, "Color Universal Design" (2008): distinct with any colour vision
BLACK = "#000000"
BLUE = "#0072B2"
RED = "#D55E00"
GREEN = "#009E73"
ORANGE = "#E69F00"
SKY = "#56B4E9"
PURPLE = "#CC79A7"
GREY = "#6E6E6E"
PALE = "#E9E9E9"
FLOOR = "#F5F4F0"
UNSTABLE = "#F9E3C5"  # where steady sliding is

LINES: tuple[tuple[str, Any], ...] = (  # colour and dashes: distinct without colour, too
    (BLUE, "-"),
    (RED, (0, (4, 1.5))),
    (GREEN, (0, (1, 1.5))),
    (ORANGE, (0, (6, 1.5, 1, 1.5))),
)

COLUMN = 3.375  # width of one column of Phys. Rev. E, in
PAGE = 7.0  # width of both, in

SHEET: dict[str, Any] = {
    "font.family": "sans-serif",
    "font.size": 8.0,
    "mathtext.fontset": "dejavusans",
    "axes.labelsize": 8.0,
    "axes.titlesize": 8.0,
    "axes.titlelocation": "left",
    "axes.linewidth": 0.6,
    "axes.formatter.use_mathtext": True,
    "xtick.labelsize": 7.0,
    "ytick.labelsize": 7.0,
    "xtick.direction": "in",
    "ytick.direction": "in",
    "xtick.top": True,
    "ytick.right": True,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "xtick.minor.width": 0.4,
    "ytick.minor.width": 0.4,
    "xtick.major.size": 3.0,
    "ytick.major.size": 3.0,
    "legend.fontsize": 7.0,
    "legend.frameon": False,
    "legend.handlelength": 1.8,
    "lines.linewidth": 0.9,
    "patch.linewidth": 0.8,
    "hatch.linewidth": 0.5,
    "figure.constrained_layout.h_pad": 0.03,
    "figure.constrained_layout.w_pad": 0.03,
    "figure.constrained_layout.hspace": 0.02,
    "figure.constrained_layout.wspace": 0.02,
    "savefig.dpi": 300.0,
    "pdf.fonttype": 42,
    "svg.fonttype": "none",
}


@contextmanager
def style() -> Iterator[None]:
    """Use the style sheet inside the ``with`` block only.

    A notebook turns interactive when pyplot is first imported, which may be inside; it stays so.
    """
    interactive = mpl.is_interactive()
    try:
        with mpl.rc_context():
            mpl.rcdefaults()  # a user's settings would spoil the proportions
            for name, value in SHEET.items():
                mpl.rcParams[name] = value  # type: ignore[index]
            yield
            interactive = mpl.is_interactive()
    finally:
        mpl.interactive(interactive)


def new_figure(width: float, height: float) -> Figure:
    """Return an empty figure of the given size (in), unknown to pyplot."""
    fig = Figure(figsize=(width, height), layout="constrained")
    FigureCanvasAgg(fig)  # one renderer, which remembers sizes of texts, for layout and file
    return fig


def lay_out(fig: Figure) -> None:
    """Give the axes of a figure their final places, without drawing it.

    A panel that a legend below it makes lower may have other ticks, whose labels are wider: then a
    second time makes room for these.
    """
    if (engine := fig.get_layout_engine()) is not None:
        before = _ticks(fig)
        engine.execute(fig)
        if _ticks(fig) != before:
            engine.execute(fig)


def _ticks(fig: Figure) -> list[list[float]]:
    """Return the places of all ticks, which follow from the sizes of the axes."""
    sides = (axis for ax in fig.axes for axis in (ax.xaxis, ax.yaxis))
    return [axis.get_ticklocs().tolist() for axis in sides]


def panel_letter(ax: Axes, letter: str) -> None:
    """Write ``(letter)`` above the labels at the upper left corner of the axes."""
    ax.annotate(
        f"({letter})",
        (0, 1),
        (-6, 4),
        xycoords="axes fraction",
        textcoords="offset points",
        ha="right",
        va="bottom",
        fontweight="bold",
        fontsize=8,
    )
