"""Sliding systems in which the friction vector rotates.

>>> import stiction as st
>>> run = st.simulate(st.presets.nakano_popov_2020(), duration="20 ms", sample_rate="10 kHz")
>>> run.status.ok
True
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from stiction.deprecation import old_names

if TYPE_CHECKING:
    from stiction import linear_stability, plotting, presets, theory
    from stiction.analysis.creep.curve import creep_curves, mean_creep
    from stiction.analysis.creep.divergence import fit_divergence
    from stiction.analysis.creep.force_curve import misalignment_from_force
    from stiction.analysis.creep.misalignment import fit_misalignment
    from stiction.analysis.energy import energy_budget
    from stiction.analysis.measured_line import strongest_line
    from stiction.analysis.motion.cycle_summary import summary
    from stiction.analysis.motion.cycles import find_cycles
    from stiction.analysis.motion.drift import detrended
    from stiction.analysis.motion.regime import Regime, classify
    from stiction.analysis.onset import find_onset
    from stiction.analysis.record import Record, record_of
    from stiction.analysis.report import Analysis, analyse, analyze
    from stiction.analysis.signals.ridge import follow_ridge
    from stiction.analysis.signals.spectrum import spectrogram, stream_spectrogram
    from stiction.analysis.transverse_oscillation import (
        oscillation_by_phase,
        transverse_oscillation,
    )
    from stiction.auditing.report import Audit, audit
    from stiction.checking import Check, check
    from stiction.comparison import Comparison, compare
    from stiction.drive import (
        Constant,
        ConstantVelocity,
        DriveProgram,
        Free,
        Harmonic,
        Hold,
        LoadProgram,
        Modulation,
        Ramp,
        Reversal,
        Step,
    )
    from stiction.drive import protocols as protocols
    from stiction.errors import DescriptionError, ResultError, Status, StictionError
    from stiction.friction import Anisotropic
    from stiction.friction import laws as laws
    from stiction.friction.laws import (
        Coulomb,
        ExponentialWeakening,
        HyperbolicWeakening,
        LuGre,
        RateStateAgeing,
        RateStateAgeing2,
        RateStateSlip,
        RateStateSlip2,
        Stribeck,
        Table,
    )
    from stiction.linear_stability.examination import Stability, stability
    from stiction.plotting.door import plot
    from stiction.reproduction.reproduce import paper
    from stiction.simulation import run, simulate
    from stiction.study.execution.refine import refine
    from stiction.study.execution.sweep import sweep
    from stiction.study.plan.axes import Grid, Random, Sobol, Values
    from stiction.study.plan.study import Study
    from stiction.study.store.store import open_study
    from stiction.study.view.mapping import Map, map
    from stiction.system.description import Description, Settings
    from stiction.system.initial import Initial
    from stiction.system.slider import Slider
    from stiction.system.template import init
    from stiction.testing import check_law
    from stiction.trajectory import Trajectory, export, load

__version__ = "0.5.0"

# module of each public name, imported at first use, so that `import stiction` is fast
_HOME = {
    "Analysis": "analysis.report",
    "Anisotropic": "friction.laws",
    "Audit": "auditing.report",
    "Check": "checking",
    "Comparison": "comparison",
    "Constant": "drive",
    "ConstantVelocity": "drive",
    "Coulomb": "friction.laws",
    "Description": "system.description",
    "DescriptionError": "errors",
    "DriveProgram": "drive",
    "ExponentialWeakening": "friction.laws",
    "Free": "drive",
    "Grid": "study.plan.axes",
    "Harmonic": "drive",
    "Hold": "drive",
    "HyperbolicWeakening": "friction.laws",
    "Initial": "system.initial",
    "LoadProgram": "drive",
    "LuGre": "friction.laws",
    "Map": "study.view.mapping",
    "Modulation": "drive",
    "Ramp": "drive",
    "Random": "study.plan.axes",
    "RateStateAgeing": "friction.laws",
    "RateStateAgeing2": "friction.laws",
    "RateStateSlip": "friction.laws",
    "RateStateSlip2": "friction.laws",
    "Record": "analysis.record",
    "Regime": "analysis.motion.regime",
    "ResultError": "errors",
    "Reversal": "drive",
    "Settings": "system.description",
    "Slider": "system.slider",
    "Sobol": "study.plan.axes",
    "Stability": "linear_stability.examination",
    "Status": "errors",
    "Step": "drive",
    "StictionError": "errors",
    "Stribeck": "friction.laws",
    "Study": "study.plan.study",
    "Table": "friction.laws",
    "Trajectory": "trajectory",
    "Values": "study.plan.axes",
    "analyse": "analysis.report",
    "analyze": "analysis.report",
    "audit": "auditing.report",
    "check": "checking",
    "check_law": "testing",
    "classify": "analysis.motion.regime",
    "compare": "comparison",
    "creep_curves": "analysis.creep.curve",
    "detrended": "analysis.motion.drift",
    "energy_budget": "analysis.energy",
    "export": "trajectory",
    "find_cycles": "analysis.motion.cycles",
    "find_onset": "analysis.onset",
    "fit_divergence": "analysis.creep.divergence",
    "fit_misalignment": "analysis.creep.misalignment",
    "follow_ridge": "analysis.signals.ridge",
    "init": "system.template",
    "load": "trajectory",
    "map": "study.view.mapping",
    "mean_creep": "analysis.creep.curve",
    "misalignment_from_force": "analysis.creep.force_curve",
    "open_study": "study.store.store",
    "oscillation_by_phase": "analysis.transverse_oscillation",
    "paper": "reproduction.reproduce",
    "plot": "plotting.door",
    "record_of": "analysis.record",
    "refine": "study.execution.refine",
    "run": "simulation",
    "simulate": "simulation",
    "spectrogram": "analysis.signals.spectrum",
    "stability": "linear_stability.examination",
    "stream_spectrogram": "analysis.signals.spectrum",
    "strongest_line": "analysis.measured_line",
    "summary": "analysis.motion.cycle_summary",
    "sweep": "study.execution.sweep",
    "transverse_oscillation": "analysis.transverse_oscillation",
}
# old public names, which work for one more version
_RENAMED = {"hear_song": "transverse_oscillation", "song_by_phase": "oscillation_by_phase"}
_ROOMS = {
    "laws": "friction.laws",
    "linear_stability": "linear_stability",
    "plotting": "plotting",
    "presets": "presets",
    "protocols": "drive.protocols",
    "theory": "theory",
}

__all__ = [
    "Analysis",
    "Anisotropic",
    "Audit",
    "Check",
    "Comparison",
    "Constant",
    "ConstantVelocity",
    "Coulomb",
    "Description",
    "DescriptionError",
    "DriveProgram",
    "ExponentialWeakening",
    "Free",
    "Grid",
    "Harmonic",
    "Hold",
    "HyperbolicWeakening",
    "Initial",
    "LoadProgram",
    "LuGre",
    "Map",
    "Modulation",
    "Ramp",
    "Random",
    "RateStateAgeing",
    "RateStateAgeing2",
    "RateStateSlip",
    "RateStateSlip2",
    "Record",
    "Regime",
    "ResultError",
    "Reversal",
    "Settings",
    "Slider",
    "Sobol",
    "Stability",
    "Status",
    "Step",
    "StictionError",
    "Stribeck",
    "Study",
    "Table",
    "Trajectory",
    "Values",
    "analyse",
    "analyze",
    "audit",
    "check",
    "check_law",
    "classify",
    "compare",
    "creep_curves",
    "detrended",
    "energy_budget",
    "export",
    "find_cycles",
    "find_onset",
    "fit_divergence",
    "fit_misalignment",
    "follow_ridge",
    "init",
    "laws",
    "linear_stability",
    "load",
    "map",
    "mean_creep",
    "misalignment_from_force",
    "open_study",
    "oscillation_by_phase",
    "paper",
    "plot",
    "plotting",
    "presets",
    "protocols",
    "record_of",
    "refine",
    "run",
    "simulate",
    "spectrogram",
    "stability",
    "stream_spectrogram",
    "strongest_line",
    "summary",
    "sweep",
    "theory",
    "transverse_oscillation",
]


def _find(name: str) -> Any:
    if name in _ROOMS:
        return import_module(f"stiction.{_ROOMS[name]}")
    if name in _HOME:
        return getattr(import_module(f"stiction.{_HOME[name]}"), name)
    raise AttributeError(f"module 'stiction' has no attribute {name!r}")


__getattr__ = old_names(__name__, _RENAMED, _find)


def __dir__() -> list[str]:
    return sorted([*__all__, *(name for name in globals() if name.startswith("__"))])
