"""An audit as one HTML page with embedded figures."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from matplotlib.figure import Figure

from stiction.auditing import figures, tolerance
from stiction.auditing.words.verdict import AS_DESCRIBED, RECORD, VERDICT
from stiction.plotting.page.html import illustrations, page_path, write_page
from stiction.plotting.page.html import page as html_page

if TYPE_CHECKING:
    from stiction.auditing.report import Audit

# figures below each section, with captions
TEST = (figures.test, "The simulated test as its load cell records it.")
DRAWN: dict[str, tuple[tuple[Callable[[Audit], Figure | None], str], ...]] = {
    VERDICT: (TEST,),
    AS_DESCRIBED: (TEST,),
    "Is it stick?": (
        (figures.creep, "Creep before slip, averaged over the transverse motion."),
        (figures.damping, "How the friction force turns during creep, and where slow turns fast."),
    ),
    RECORD: ((figures.record, "Measured, and simulated with the fitted parameters."),),
    "Mechanism": (
        (
            figures.mechanism,
            "Odds of mechanisms; how often simulated records are called so; the loading's "
            "departure from a straight line, measured and simulated.",
        ),
    ),
    "Fit": (
        (figures.posterior, "Prior (grey) and posterior (blue), with its 95 % interval."),
        (
            figures.ranks,
            "Calibration: ranks of the truth of simulated records, each left out. Even ranks "
            "mean true intervals; grey is where 95 % of the counts lie then.",
        ),
        # the largest stands last, so that on paper the text goes on below it
        (figures.corner, "All pairs of what the record identifies: 50 % and 95 %."),
    ),
    tolerance.TITLE: ((figures.tolerance, "What tests read over the uncertain misalignment."),),
    "What to change": (
        (
            figures.trials,
            "Each advice tried: the force of the same test, now and then. A pale band is the "
            "range of swings too fast to be seen one by one, the line in it their mean.",
        ),
        (figures.stability, "Where steady sliding is stable, and where this apparatus is."),
    ),
}


def write(found: Audit, path: str | Path, name: str) -> Path:
    """Write the report of an audit as a self-contained page; return the path.

    Raises
    ------
    ResultError
        If it cannot be written there.
    """
    page_path(path)  # before it is drawn
    return write_page(page(found, name), path)


def page(found: Audit, name: str) -> str:
    """Return the page as text; `name` is the name of the apparatus."""
    figures = {
        title: illustrations((draw(found), caption) for draw, caption in drawn)
        for title, drawn in DRAWN.items()
    }
    return html_page(f"Audit of {name}", found.tables(), figures, found.to_toml())
