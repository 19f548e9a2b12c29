"""One or several analyses as one HTML page with figures."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from stiction.analysis.export import full_report
from stiction.analysis.report import Analysis
from stiction.analysis.several import section
from stiction.plotting.analysis.overview import figures
from stiction.plotting.page.html import Illustration, illustrations, page, page_path, write_page
from stiction.trajectory import Trajectory

# section and caption of each figure; that of a test stands in the test's own section
DRAWN = {
    "cycles": ("In short", "The force, with the peaks and troughs of its cycles."),
    "creep": ("Creep", "Creep before slip: of each stick phase, and averaged over all."),
    "rotation": (
        "Rotation of the force",
        "The force in the plane while the spring is loaded, each loading a line.",
    ),
    "oscillation": ("Oscillation", "The transverse oscillation over time."),
    "energy": ("Energy", "The energy budget of the cycles."),
}


def write(found: Analysis, path: str | Path, name: str) -> Path:
    """Write an analysis of the source `name` as a self-contained page; return the path.

    Raises
    ------
    ResultError
        If it cannot be written there.
    """
    page_path(path)  # before it is drawn
    run = found.source if isinstance(found.source, Trajectory) else None
    shown = page(
        f"Analysis of {name}",
        full_report(found),
        below_sections(found),
        run.slider.to_toml() if run else "",
    )
    return write_page(shown, path)


def below_sections(found: Analysis) -> dict[str, list[Illustration]]:
    """Return the figures of an analysis by the title of the section above them."""
    below: dict[str, list[Illustration]] = {}
    for name, figure in figures(found).items():
        title, caption = DRAWN.get(name, ("", f"The test: {name.replace('-', ' ')}."))
        title = title or found.parts["procedure"].section.title
        below.setdefault(title, []).extend(illustrations([(figure, caption)]))
    return below


def write_several(found: Mapping[str, Analysis], path: str | Path) -> Path:
    """Write analyses by their names as a page: a table, then each of them; return the path.

    Raises
    ------
    ResultError
        If it cannot be written there.
    """
    page_path(path)
    parts = [section(found)]
    below: dict[str, list[Illustration]] = {}
    for name, each in found.items():
        report, figures_of = full_report(each), below_sections(each)
        parts += [part._replace(title=f"{name}: {part.title}") for part in report]
        below |= {f"{name}: {title}": shown for title, shown in figures_of.items()}
    return write_page(page(f"Analysis of {len(found)} records", parts, below), path)
