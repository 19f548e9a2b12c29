"""What a page takes away: the description, the lines of Python, the data, the figure."""

from __future__ import annotations

from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory
from zipfile import ZIP_DEFLATED, ZipFile

from stiction.explorer.motion import Check
from stiction.simulation import run
from stiction.system.description import Description
from stiction.text.samples import with_all_values

NAMES = {
    "toml": "slider.toml",
    "python": "run.py",
    "csv": "run-csv.zip",
    "nc": "run.nc",
    "png": "run.png",
    "pdf": "run.pdf",
    "svg": "run.svg",
}
FIGURES = ("png", "pdf", "svg")


def export(description: Description, kind: str, check: Check) -> tuple[str, bytes]:
    """Return the name and content of a file of a `kind`, one of `NAMES`."""
    if kind == "toml":
        return NAMES[kind], description.to_toml().encode()
    if kind == "python":
        return NAMES[kind], python_lines(description).encode()
    made = run(description, progress=lambda _: check())
    if kind in FIGURES:
        from stiction.plotting.page.canvas import figure_of
        from stiction.plotting.page.save import write

        figure = figure_of(made.plot)
        return NAMES[kind], content(NAMES[kind], lambda path: [write(figure, path)])
    if kind == "csv":
        return NAMES[kind], content("run.csv", made.export)
    return NAMES[kind], content(NAMES[kind], lambda path: [made.save(path)])


def content(name: str, write: Callable[[Path], list[Path]]) -> bytes:
    """Return what is written to a file, or the archive of several."""
    with TemporaryDirectory() as folder:
        paths = write(Path(folder) / name)
        if len(paths) == 1:
            return paths[0].read_bytes()
        packed = BytesIO()
        with ZipFile(packed, "w", ZIP_DEFLATED) as archive:
            for path in paths:
                archive.write(path, path.name)
        return packed.getvalue()


def python_lines(description: Description) -> str:
    """Return the lines of Python that make this run.

    Examples
    --------
    >>> import stiction as st
    >>> slider, settings = st.presets.nakano_popov_2020(), st.Settings(duration=5)
    >>> print(python_lines(st.Description(slider, st.Initial(), settings)))  # doctest: +ELLIPSIS
    import stiction as st
    <BLANKLINE>
    slider = st.Slider(mass=0.25, ...)
    initial = st.Initial()
    settings = st.Settings(duration=5.0)
    run = st.run(st.Description(slider, initial, settings))
    run.plot()
    <BLANKLINE>
    """
    slider, initial, settings = description
    with with_all_values():
        calls = f"slider = {slider!r}\ninitial = {initial!r}\nsettings = {settings!r}\n"
    return (
        f"import stiction as st\n\n{calls}"
        "run = st.run(st.Description(slider, initial, settings))\nrun.plot()\n"
    )
