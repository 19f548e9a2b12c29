"""The figures of an analysis: its test, cycles, creep, rotation, oscillation, energy."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf, isfinite

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from stiction.analysis.creep.conditions import at_one_load, typical_load
from stiction.analysis.creep.curve import mean_creep
from stiction.analysis.creep.findings import drive_speed
from stiction.analysis.creep.misalignment import REST_SPEED, STRETCH, implied_velocity
from stiction.analysis.oscillation import stands_out
from stiction.analysis.parts.creep import end_of_creep
from stiction.analysis.parts.procedure import name_of
from stiction.analysis.report import Analysis
from stiction.arrays import Floats
from stiction.plotting.analysis.creep_curve import Line, creep_theory, plot_creep
from stiction.plotting.analysis.cycles import plot_motion
from stiction.plotting.analysis.energy import plot_energy
from stiction.plotting.analysis.oscillation import plot_oscillation
from stiction.plotting.analysis.rotation import is_along_drive, plot_rotation
from stiction.plotting.page.canvas import figure_of
from stiction.trajectory import Trajectory


def plot_analysis(
    found: Analysis, axes: Axes | Sequence[Axes] | None = None
) -> NDArray[np.object_]:
    """Draw the force with its cycles and its kind of motion; see `plot_cycles`.

    Examples
    --------
    >>> import stiction as st
    >>> run = st.simulate(st.presets.nakano_popov_2020(), "5 s", sample_rate="1 kHz")
    >>> axes = st.plotting.plot_analysis(st.analyse(run))
    """
    return plot_motion(found.record, found.cycles, found.regime.kind, axes)


def figures(found: Analysis) -> dict[str, Figure]:
    """Return the figures of the existing parts of an analysis by name."""
    drawn = {}
    if (test := found.parts["procedure"]) is not None:
        drawn[name_of(test)] = figure_of(test.plot)
    if len(found.record):
        drawn["cycles"] = figure_of(plot_motion, found.record, found.cycles, found.regime.kind)
    V = drive_speed(found.source, found.record)
    if found.curves is not None and found.creep is not None and V is not None and moves(found, V):
        lines = _creep_lines(found, V)
        drawn["creep"] = figure_of(plot_creep, found.curves, found.creep, V, lines)
        if (end := end_of_creep(found)) != "slip":
            drawn["creep"].axes[0].set_xlabel(f"time until {end} (s)")
    if (turns := found.parts["rotation"]) is not None and not is_along_drive(turns):
        drawn["rotation"] = figure_of(plot_rotation, found)
    its = found.oscillation
    if isinstance(found.source, Trajectory) and stands_out(its):
        drawn["oscillation"] = figure_of(plot_oscillation, found.source, its)
    if found.energy is not None:
        drawn["energy"] = figure_of(plot_energy, found.energy)
    return drawn


def moves(found: Analysis, V: float) -> bool:
    """Return whether the mass creeps at all: a figure of rest alone is empty."""
    mean = found.creep
    return mean is not None and bool((np.abs(mean["velocity"].values) > REST_SPEED * V).any())


def _creep_lines(found: Analysis, V: float) -> dict[str, Line]:
    """Return creep by Eq. (7) as it was fitted, and by Eq. (8), if the misalignment stands out.

    The former is that at the forces which were measured, so far from slip as it was fitted.
    """
    fit, stiffness, mean = found.misalignment, found.record.stiffness, found.creep
    if fit is None or not fit.stands_out or stiffness is None:
        return {}
    if found.curves is None or mean is None:
        return {}
    run = found.source if isinstance(found.source, Trajectory) else None
    across = found.record.stiffness_across if run is None else run.slider.k_y
    stiffness = fit.stiffness if isfinite(fit.stiffness) else stiffness
    ratio, loading_time = stiffness / (across or inf), fit.F_0 / stiffness / V
    load = typical_load(found.record, found.curves["slip_time"].values)
    force = mean["force"].values / load  # F_0 is that at one load
    if found.record.load is not None and found.record.position is not None:
        force = mean_creep(at_one_load(found.curves, found.record))["force"].values
    middle = 0.5 * (mean["begin"] + mean["end"]).values

    def fitted(to_slip: Floats) -> Floats:
        far = np.where(to_slip < STRETCH[0] * loading_time, np.nan, to_slip)
        return V * implied_velocity(fit, np.interp(far, middle, force), ratio)

    name = "Eq. (8), corrected"
    near = creep_theory(V, fit.phi, fit.F_0 * load / stiffness, _loading(found))[name]
    return {"Eq. (7), fitted": fitted, f"{name}, at fitted φ, F₀": near}


def _loading(found: Analysis) -> float | None:
    """Return the duration of a run's only loading, s; None if there are several, or none."""
    if found.curves is None or found.curves.sizes["phase"] != 1:
        return None
    if not isinstance(found.source, Trajectory):
        return None
    return float(found.curves["slip_time"][0] - found.record.time[0])
