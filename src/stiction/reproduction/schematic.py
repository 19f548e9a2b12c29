"""Figs. 1 and 2: the apparatus, and its model from the side, from above and in velocities."""

from __future__ import annotations

from matplotlib.figure import Figure

from stiction.plotting.apparatus.pin_on_plate import draw_apparatus, draw_side_view
from stiction.plotting.apparatus.schematic import draw_schematic
from stiction.plotting.apparatus.velocity_triangle import draw_velocity_triangle
from stiction.plotting.page.style import PAGE, new_figure, style
from stiction.system.slider import Slider


def schematic(slider: Slider) -> Figure:
    """Draw Figs. 1 and 2 of Nakano & Popov, for any slider.

    Parameters
    ----------
    slider : Slider
        The system; its misalignment is to scale where it is large enough to be seen.

    Returns
    -------
    Figure
        As wide as a page.
    """
    with style():
        fig = new_figure(PAGE, 4.1)
        axes = fig.subplot_mosaic(
            [["apparatus", "top"], ["side", "triangle"]],
            width_ratios=[1.0, 1.2],
            height_ratios=[1.9, 1.0],
        )
        draw_apparatus(axes["apparatus"], slider)
        draw_side_view(axes["side"], slider)
        draw_schematic(axes["top"], slider)
        draw_velocity_triangle(axes["triangle"], slider)
        for name, title in (
            ("apparatus", "Apparatus (Fig. 1)"),
            ("side", "(a) Side view (Fig. 2)"),
            ("top", "(b) Top view"),
            ("triangle", "(c) Velocities and angles"),
        ):
            axes[name].set_title(title)
    return fig
