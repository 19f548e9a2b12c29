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
    from stiction.plotting.analysis.creep_curve import plot_creep
    from stiction.plotting.analysis.cycles import plot_cycles
    from stiction.plotting.analysis.energy import plot_energy
    from stiction.plotting.analysis.oscillation import plot_oscillation
    from stiction.plotting.analysis.overview import plot_analysis
    from stiction.plotting.analysis.spectrogram import plot_spectrogram
    from stiction.plotting.analysis.trials import plot_trials
    from stiction.plotting.apparatus.schematic import plot_slider
    from stiction.plotting.run.comparison import plot_comparison
    from stiction.plotting.run.law import plot_law
    from stiction.plotting.run.overview import plot_run
    from stiction.plotting.stability.boundary import plot_boundary
    from stiction.plotting.stability.damping import plot_damping
    from stiction.plotting.stability.examination import plot_stability
    from stiction.plotting.stability.modes import plot_modes
    from stiction.plotting.stability.onset import plot_onset
    from stiction.study.view.mapping import plot_map

# module of each public name, imported at first use
_HOME = {
    "plot_analysis": "plotting.analysis.overview",
    "plot_boundary": "plotting.stability.boundary",
    "plot_comparison": "plotting.run.comparison",
    "plot_creep": "plotting.analysis.creep_curve",
    "plot_cycles": "plotting.analysis.cycles",
    "plot_damping": "plotting.stability.damping",
    "plot_energy": "plotting.analysis.energy",
    "plot_law": "plotting.run.law",
    "plot_map": "study.view.mapping",  # what it draws lies above the figures
    "plot_modes": "plotting.stability.modes",
    "plot_onset": "plotting.stability.onset",
    "plot_oscillation": "plotting.analysis.oscillation",
    "plot_run": "plotting.run.overview",
    "plot_slider": "plotting.apparatus.schematic",
    "plot_spectrogram": "plotting.analysis.spectrogram",
    "plot_stability": "plotting.stability.examination",
    "plot_trials": "plotting.analysis.trials",
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
