"""Forced vibration with Coulomb friction in one dimension, at other frequencies and frictions."""

from __future__ import annotations

from functools import partial

import stiction as st
from benchmarks.cases.case import Case
from stiction.presets import Number
from stiction.presets.vibration import amplitudes, exact_amplitude, forced_oscillator


def den_hartog(r: float, S: float, wanted: float, rtol: float) -> list[Number]:
    """Forced vibration without stops: x_0 k/P_0 = sqrt(U^2 - (S W)^2); the preset is one pair."""
    description = forced_oscillator(r, S)
    settings = description.run.model_dump(exclude_none=True) | {"rtol": rtol}
    run = st.run(description._replace(run=st.Settings(**settings)))
    one, other, stops = amplitudes(run)
    where, exact = "Den Hartog 1930", exact_amplitude(r, S)
    return [
        Number(where, "amplitude x_0 k/P_0 as printed", wanted, one, 6e-8),
        Number(where, "  in closed form", exact, one, 1e-8),
        Number(where, "  on the other side", exact, other, 1e-8),
        Number(where, "stops in a period", 0, stops, 0),
    ]


DEN_HARTOG = ((1.5, 0.3, 0.7211103), (2.0, 0.4, 0.2666667))
CASES = tuple(
    Case(f"forced vibration, r = {r:g}, S = {S:g}", partial(den_hartog, r, S, wanted))
    for r, S, wanted in DEN_HARTOG
)
