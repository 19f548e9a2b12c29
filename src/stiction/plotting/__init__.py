"""Figures: each is a function that draws on given axes, and returns them.

Without axes it makes a figure of its own, which a notebook or ``matplotlib.pyplot.show()`` shows.
Nothing is shown or saved here. A figure of several panels takes and returns several axes.

>>> import stiction as st
>>> from stiction.plotting import plot_law
>>> plot_law(st.presets.nakano_popov_2020()).get_ylabel()
'$\\\\mu$ (1)'
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from stiction.plotting.figures import *  # noqa: F403
    from stiction.study.view.mapping import plot_map as plot_map

ABOVE = {"plot_map": "stiction.study.view.mapping"}  # draws what lies above the figures


def __getattr__(name: str) -> Any:
    if name.startswith("plot_"):  # imported when first used, as matplotlib is heavy
        module = import_module(ABOVE.get(name, "stiction.plotting.figures"))
        if hasattr(module, name):
            return getattr(module, name)
    raise AttributeError(f"module 'stiction.plotting' has no attribute {name!r}")


def __dir__() -> list[str]:
    figures = vars(import_module("stiction.plotting.figures"))
    own = (name for name in globals() if name.startswith("__"))
    return sorted([*(name for name in figures if name.startswith("plot_")), *ABOVE, *own])
