"""Exports of a page: the description, the lines of Python, the data, the figure."""

from __future__ import annotations

from collections.abc import Callable
from io import BytesIO
from keyword import iskeyword
from pathlib import Path, PurePath
from tempfile import TemporaryDirectory
from typing import Any
from zipfile import ZIP_DEFLATED, ZipFile

from stiction.explorer.motion import Check
from stiction.friction import Anisotropic, registered_name
from stiction.friction.user.loading import own_table
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
    """Return the content of a file, or the archive of several."""
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
    """Return the lines of Python that make this run and, as a script too, show it.

    Examples
    --------
    >>> import stiction as st
    >>> slider, settings = st.presets.nakano_popov_2020(), st.Settings(duration=5)
    >>> print(python_lines(st.Description(slider, st.Initial(), settings)))  # doctest: +ELLIPSIS
    import stiction as st
    from matplotlib import pyplot
    <BLANKLINE>
    slider = st.Slider(mass=0.25, ...)
    initial = st.Initial()
    settings = st.Settings(duration=5.0)
    run = st.run(st.Description(slider, initial, settings))
    run.plot()
    pyplot.show()
    <BLANKLINE>
    """
    slider, initial, settings = description
    with with_all_values():
        calls = f"slider = {slider!r}\ninitial = {initial!r}\nsettings = {settings!r}\n"
    return (
        f"{own_law(slider.law)}import stiction as st\nfrom matplotlib import pyplot\n\n{calls}"
        "run = st.run(st.Description(slider, initial, settings))\nrun.plot()\npyplot.show()\n"
    )


def own_law(law: Any) -> str:
    """Return the lines that make a user's law known: an import, or the law itself from a session.

    Examples
    --------
    >>> from stiction import Coulomb
    >>> own_law(Coulomb(0.2))
    ''
    """
    if isinstance(law, Anisotropic):
        return own_law(law.law)
    if registered_name(law) is not None:
        return ""
    table = own_table(law)
    file, _, kind = table["law"].rpartition(":")
    if type(law).__module__ == "__main__":  # an import would run the script anew
        text = table.get("source", f"# define the law {kind} here")
        return f"{text}\n\n"
    path = PurePath(file)
    module = ".".join(part for part in path.with_suffix("").parts if part != "..")
    beside = f"  # of {path.name}, beside this file" if path.suffix else ""
    if all(part.isidentifier() and not iskeyword(part) for part in module.split(".")):
        return f"from {module} import {kind}{beside}\n\n"
    return (
        "from importlib import import_module\n\n"
        f"{kind} = import_module({module!r}).{kind}{beside}\n\n"
    )
