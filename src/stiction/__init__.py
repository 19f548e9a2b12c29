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
    from stiction import auditing as audit
    from stiction import linear_stability as stability
    from stiction import presets, theory
    from stiction.analysis.creep_curve import creep_curves, mean_creep
    from stiction.analysis.cycles import find_cycles
    from stiction.analysis.divergence import fit_divergence
    from stiction.analysis.energy import energy_budget
    from stiction.analysis.measured_line import strongest_line
    from stiction.analysis.misalignment import fit_misalignment
    from stiction.analysis.onset import find_onset
    from stiction.analysis.oscillation import oscillation_by_phase, transverse_oscillation
    from stiction.analysis.record import Record, record_of
    from stiction.analysis.regime import Regime, classify
    from stiction.analysis.report import Analysis, analyse
    from stiction.analysis.ridge import follow_ridge
    from stiction.analysis.spectrum import spectrogram, stream_spectrogram
    from stiction.analysis.spread import summary
    from stiction.comparison import compare
    from stiction.description import Description, Settings
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
    from stiction.errors import DescriptionError, ResultError, Status, StictionError
    from stiction.friction import (
        Anisotropic,
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
    from stiction.initial import Initial
    from stiction.simulation import simulate
    from stiction.slider import Slider
    from stiction.study.axes import Grid, Random, Sobol, Values
    from stiction.study.plan import Study
    from stiction.study.store import open_study
    from stiction.testing import check_law
    from stiction.trajectory import Trajectory, load

__version__ = "0.4.0"

# where each public name lives; imported when first used, so that `import stiction` is light
_HOME = {
    "Analysis": "analysis.report",
    "Anisotropic": "friction",
    "Constant": "drive",
    "ConstantVelocity": "drive",
    "Coulomb": "friction",
    "Description": "description",
    "DescriptionError": "errors",
    "DriveProgram": "drive",
    "ExponentialWeakening": "friction",
    "Free": "drive",
    "Grid": "study.axes",
    "Harmonic": "drive",
    "Hold": "drive",
    "HyperbolicWeakening": "friction",
    "Initial": "initial",
    "LoadProgram": "drive",
    "LuGre": "friction",
    "Modulation": "drive",
    "Ramp": "drive",
    "Random": "study.axes",
    "RateStateAgeing": "friction",
    "RateStateAgeing2": "friction",
    "RateStateSlip": "friction",
    "RateStateSlip2": "friction",
    "Record": "analysis.record",
    "Regime": "analysis.regime",
    "ResultError": "errors",
    "Reversal": "drive",
    "Settings": "description",
    "Slider": "slider",
    "Sobol": "study.axes",
    "Status": "errors",
    "Step": "drive",
    "StictionError": "errors",
    "Stribeck": "friction",
    "Study": "study.plan",
    "Table": "friction",
    "Trajectory": "trajectory",
    "Values": "study.axes",
    "analyse": "analysis.report",
    "check_law": "testing",
    "classify": "analysis.regime",
    "compare": "comparison",
    "creep_curves": "analysis.creep_curve",
    "energy_budget": "analysis.energy",
    "find_cycles": "analysis.cycles",
    "find_onset": "analysis.onset",
    "fit_divergence": "analysis.divergence",
    "fit_misalignment": "analysis.misalignment",
    "follow_ridge": "analysis.ridge",
    "load": "trajectory",
    "mean_creep": "analysis.creep_curve",
    "open_study": "study.store",
    "oscillation_by_phase": "analysis.oscillation",
    "record_of": "analysis.record",
    "simulate": "simulation",
    "spectrogram": "analysis.spectrum",
    "stream_spectrogram": "analysis.spectrum",
    "strongest_line": "analysis.measured_line",
    "summary": "analysis.spread",
    "transverse_oscillation": "analysis.oscillation",
}
# old public names, which go on working for one version
_RENAMED = {"hear_song": "transverse_oscillation", "song_by_phase": "oscillation_by_phase"}
_ROOMS = {
    "audit": "auditing",
    "linear_stability": "linear_stability",
    "presets": "presets",
    "stability": "linear_stability",
    "theory": "theory",
}

__all__ = [
    "Analysis",
    "Anisotropic",
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
    "Status",
    "Step",
    "StictionError",
    "Stribeck",
    "Study",
    "Table",
    "Trajectory",
    "Values",
    "analyse",
    "audit",
    "check_law",
    "classify",
    "compare",
    "creep_curves",
    "energy_budget",
    "find_cycles",
    "find_onset",
    "fit_divergence",
    "fit_misalignment",
    "follow_ridge",
    "load",
    "mean_creep",
    "open_study",
    "oscillation_by_phase",
    "presets",
    "record_of",
    "simulate",
    "spectrogram",
    "stability",
    "stream_spectrogram",
    "strongest_line",
    "summary",
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
