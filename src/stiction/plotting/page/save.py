"""Writing of figures to files, and into pages."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from io import BytesIO
from pathlib import Path
from typing import Any
from zlib import Z_RLE

from matplotlib.figure import Figure

from stiction.errors import StictionError
from stiction.plotting.page.canvas import figure_of
from stiction.plotting.page.style import SHEET, lay_out, style
from stiction.storage.files import placeable, whole

FORMATS = (".png", ".pdf", ".svg")
SCREEN = 200.0  # dots in an inch of a picture in a page: sharp there, and half the size of a file's
HOW: dict[str, dict[str, Any]] = {
    # the run lengths of areas of one colour: two thirds of the time, and 3 % more bytes
    ".png": {"pil_kwargs": {"compress_type": Z_RLE}},
    # no dates: the same figure gives the same file
    ".pdf": {"metadata": {"CreationDate": None}},
    ".svg": {"metadata": {"Date": None}},
}
WIDEST = 700  # pixels of a page


def save(fig: Figure, path: str | Path) -> list[Path]:
    """Write a figure as ``path.png``, to look at, and ``path.pdf``, to print; see `write`.

    Both have the same layout, which is found once.
    """
    bare = Path(path)
    with style(), fixed_layout(fig, SHEET["savefig.dpi"]):
        return [write(fig, bare.with_name(bare.name + suffix)) for suffix in (".png", ".pdf")]


def write(fig: Figure, path: str | Path) -> Path:
    """Write a figure to a file, whole or not at all; return the path.

    Parameters
    ----------
    fig : Figure
        The figure.
    path : str or Path
        With one of the suffixes in `FORMATS`; an existing file is replaced.

    Raises
    ------
    ResultError
        If the format is unknown, or the file cannot be written.
    """
    target = drawable(path)
    suffix = target.suffix.lower()
    with whole(target) as part, style(), fixed_layout(fig, SHEET["savefig.dpi"]):
        fig.savefig(part, format=suffix[1:], **HOW[suffix])
    return target


@contextmanager
def fixed_layout(fig: Figure, dpi: float) -> Iterator[None]:
    """Find the layout of a figure for a resolution, which stays inside the ``with`` block.

    Writing a file, matplotlib would draw the whole figure to find it, and draw it once more.
    """
    engine, own = fig.get_layout_engine(), fig.dpi
    manager, fig.canvas.manager = fig.canvas.manager, None  # it would resize the figure's window
    try:
        fig.dpi = dpi
        lay_out(fig)
        fig.set_layout_engine(None)
        yield
    finally:
        fig.dpi = own
        fig.set_layout_engine(engine)
        fig.canvas.manager = manager


def drawable(path: str | Path) -> Path:
    """Return a path, if a figure can be written there."""
    return placeable(path, FORMATS)


def png(fig: Figure) -> bytes:
    """Return a figure as a PNG image for a page."""
    image = BytesIO()
    with style(), fixed_layout(fig, SCREEN):
        fig.savefig(image, format="png", dpi=SCREEN, **HOW[".png"])
    return image.getvalue()


def picture(draw: Callable[..., Any], *what: Any) -> str:
    """Return the figure of a function as an image in HTML; '' if there is nothing to draw."""
    try:
        figure = figure_of(draw, *what)
    except StictionError:
        return ""
    content = b64encode(png(figure)).decode("ascii")
    width = min(int(100 * figure.get_figwidth()), WIDEST)
    return f'<img alt="" style="width: {width}px" src="data:image/png;base64,{content}">'
