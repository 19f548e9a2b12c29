"""Figures: a function each, which draws on the axes that it is given and returns them.

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
    from stiction.plotting.analysis import plot_analysis
    from stiction.plotting.comparison import plot_comparison
    from stiction.plotting.creep_curve import plot_creep
    from stiction.plotting.cycles import plot_cycles
    from stiction.plotting.damping import plot_damping
    from stiction.plotting.energy import plot_energy
    from stiction.plotting.law import plot_law
    from stiction.plotting.modes import plot_modes
    from stiction.plotting.onset import plot_onset
    from stiction.plotting.oscillation import plot_oscillation
    from stiction.plotting.overview import plot_run
    from stiction.plotting.schematic import plot_slider
    from stiction.plotting.spectrogram import plot_spectrogram
    from stiction.plotting.stability import plot_boundary, plot_stability
    from stiction.plotting.trials import plot_trials

# where each public name lives; imported when first used
_HOME = {
    "plot_analysis": "analysis",
    "plot_boundary": "stability",
    "plot_comparison": "comparison",
    "plot_creep": "creep_curve",
    "plot_cycles": "cycles",
    "plot_damping": "damping",
    "plot_energy": "energy",
    "plot_law": "law",
    "plot_modes": "modes",
    "plot_onset": "onset",
    "plot_oscillation": "oscillation",
    "plot_run": "overview",
    "plot_slider": "schematic",
    "plot_spectrogram": "spectrogram",
    "plot_stability": "stability",
    "plot_trials": "trials",
}

__all__ = [
    "plot_analysis",
    "plot_boundary",
    "plot_comparison",
    "plot_creep",
    "plot_cycles",
    "plot_damping",
    "plot_energy",
    "plot_law",
    "plot_modes",
    "plot_onset",
    "plot_oscillation",
    "plot_run",
    "plot_slider",
    "plot_spectrogram",
    "plot_stability",
    "plot_trials",
]


def __getattr__(name: str) -> Any:
    if name in _HOME:
        return getattr(import_module(f"stiction.plotting.{_HOME[name]}"), name)
    raise AttributeError(f"module 'stiction.plotting' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted([*__all__, *(name for name in globals() if name.startswith("__"))])
