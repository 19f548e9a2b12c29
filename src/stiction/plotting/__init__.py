"""Figures: each is a function that draws on given axes, and returns them.

Without axes it makes a figure of its own, which a notebook or ``matplotlib.pyplot.show()`` shows.
Nothing is shown or saved here. A figure of several panels takes and returns several axes.

>>> import stiction as st
>>> from stiction.plotting import plot_law
>>> plot_law(st.presets.nakano_popov_2020()).get_ylabel()
'$\\\\mu$ (1)'
"""

from __future__ import annotations

import ast
from functools import cache
from importlib import import_module
from importlib.resources import files
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from stiction.plotting.figures import *  # noqa: F403
    from stiction.study.view.mapping import plot_map as plot_map

ABOVE = {"plot_map": "stiction.study.view.mapping"}  # draws what lies above the figures


@cache
def _homes() -> dict[str, str]:
    """Return the module of each figure, from the lines of ``figures.py``.

    They are read and not run: to import every figure takes half as long again as to import one.
    """
    lines = ast.parse(files("stiction.plotting").joinpath("figures.py").read_text("utf-8")).body
    named = [line for line in lines if isinstance(line, ast.ImportFrom) and line.level == 0]
    homes = {each.name: str(line.module) for line in named for each in line.names}
    return {name: home for name, home in homes.items() if name.startswith("plot_")} | ABOVE


def __getattr__(name: str) -> Any:
    if name.startswith("plot_") and name in _homes():
        return getattr(import_module(_homes()[name]), name)
    raise AttributeError(f"module 'stiction.plotting' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted([*_homes(), *(name for name in globals() if name.startswith("__"))])
