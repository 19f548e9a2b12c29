"""A figure inside the HTML by which an object shows itself in a notebook."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Callable
from typing import Any

from stiction.errors import StictionError
from stiction.plotting.page.canvas import figure_of
from stiction.plotting.page.save import png

WIDEST = 700  # pixels of a page


def picture(draw: Callable[..., Any], *what: Any) -> str:
    """Return what a function draws as an image in HTML; '' if there is nothing to draw."""
    try:
        figure = figure_of(draw, *what)
    except StictionError:
        return ""
    content = b64encode(png(figure)).decode("ascii")
    width = min(int(100 * figure.get_figwidth()), WIDEST)
    return f'<img alt="" style="width: {width}px" src="data:image/png;base64,{content}">'
