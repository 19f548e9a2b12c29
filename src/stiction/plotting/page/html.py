"""A report as one HTML page with embedded figures."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from jinja2 import Environment, PackageLoader
from matplotlib.figure import Figure

import stiction
from stiction.plotting.page.save import png
from stiction.plotting.page.style import PAGE
from stiction.storage.files import placeable, write_text
from stiction.text.sections import Section, html, table_html

SUFFIXES = (".html", ".htm")


class Illustration(NamedTuple):
    """A figure as text, with its caption; its width is a share of the page's."""

    image: str
    caption: str
    width: float


def page_path(path: str | Path) -> Path:
    """Return a path, if a page can be written there."""
    return placeable(path, SUFFIXES)


def write_page(text: str, path: str | Path) -> Path:
    """Write a page; return its path.

    Raises
    ------
    ResultError
        If it cannot be written there.
    """
    return write_text(text, path, SUFFIXES)


def page(
    heading: str,
    parts: Sequence[Section],
    figures: Mapping[str, Sequence[Illustration]],
    description: str = "",
) -> str:
    """Return a self-contained page as text.

    Parameters
    ----------
    heading : str
        Its heading.
    parts : sequence of Section
        The report.
    figures : mapping of str to sequence of Illustration
        Those below a section, by its title.
    description : str, optional
        The apparatus in TOML, which stands at the end.
    """
    environment = Environment(
        loader=PackageLoader("stiction.plotting.page", "."), autoescape=True, trim_blocks=True
    )
    environment.filters.update(html=html, table=table_html)
    return environment.get_template("page.html.jinja").render(
        heading=heading,
        version=stiction.__version__,
        parts=parts,
        figures=figures,
        description=description,
    )


def illustrations(drawn: Iterable[tuple[Figure | None, str]]) -> list[Illustration]:
    """Return figures with their captions for a page, except missing ones."""
    return [
        Illustration(b64encode(png(figure)).decode("ascii"), caption, figure.get_figwidth() / PAGE)
        for figure, caption in drawn
        if figure is not None
    ]
