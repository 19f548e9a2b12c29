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
    from stiction.study.view.mapping import plot_map

# where each public name lives; imported when first used
_HOME = {
    "plot_analysis": "plotting.analysis",
    "plot_boundary": "plotting.stability",
    "plot_comparison": "plotting.comparison",
    "plot_creep": "plotting.creep_curve",
    "plot_cycles": "plotting.cycles",
    "plot_damping": "plotting.damping",
    "plot_energy": "plotting.energy",
    "plot_law": "plotting.law",
    "plot_map": "study.view.mapping",  # what it draws lies above the figures
    "plot_modes": "plotting.modes",
    "plot_onset": "plotting.onset",
    "plot_oscillation": "plotting.oscillation",
    "plot_run": "plotting.overview",
    "plot_slider": "plotting.schematic",
    "plot_spectrogram": "plotting.spectrogram",
    "plot_stability": "plotting.stability",
    "plot_trials": "plotting.trials",
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
    "plot_map",
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
        return getattr(import_module(f"stiction.{_HOME[name]}"), name)
    raise AttributeError(f"module 'stiction.plotting' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted([*__all__, *(name for name in globals() if name.startswith("__"))])
