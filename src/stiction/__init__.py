"""Sliding systems in which the friction vector rotates.

>>> import stiction as st
>>> run = st.simulate(st.presets.nakano_popov_2020(), duration="20 ms", sample_rate="10 kHz")
>>> run.status.ok
True
"""

from __future__ import annotations

from stiction.names import public

__version__ = "0.5.0"

_MOVED = {  # to which room; the old places of these names work for one more version
    "analysis": "Regime classify creep_curves energy_budget find_cycles find_onset"
    " fit_divergence fit_misalignment follow_ridge mean_creep misalignment_from_force"
    " oscillation_by_phase record_of spectrogram stream_spectrogram strongest_line summary"
    " transverse_oscillation",
    "laws": "Anisotropic HyperbolicWeakening LuGre RateStateAgeing RateStateAgeing2"
    " RateStateSlip RateStateSlip2 Stribeck Table",
    "protocols": "Constant DriveProgram Free Harmonic Hold LoadProgram Modulation Ramp Reversal"
    " Step",
    "results": "Analysis Audit Check Comparison Map Stability",
    "testing": "check_law",
}
_RENAMED = {
    name: f"stiction.{room}.{name}" for room, names in _MOVED.items() for name in names.split()
} | {
    "detrended": "stiction.analysis.detrend",
    "hear_song": "stiction.analysis.transverse_oscillation",
    "song_by_phase": "stiction.analysis.oscillation_by_phase",
}

__getattr__, __dir__ = public(__name__, _RENAMED)
