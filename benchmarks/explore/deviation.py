"""The error of a run, and the response of the apparatus to a small change of a parameter."""

from __future__ import annotations

from typing import Literal

import numpy as np

import stiction as st
from benchmarks.explore.systems.set_valued import System

SAMPLES = 1000
FINER = 1e-3  # tolerance of the reference over that of the run on trial
FINEST = 1e-12


def forces(
    system: System, rtol: float, multiscale: bool | Literal["auto"] = False
) -> tuple[np.ndarray, st.Trajectory]:
    """Return the force of the springs (N; 2 rows) at equal intervals of time, and the run."""
    run = st.simulate(
        system.slider,
        system.duration,
        sample_rate=(SAMPLES - 1) / system.duration,
        rtol=rtol,
        initial=system.start,
        regularisation=system.delta,
        multiscale=multiscale,
    )
    found = np.stack([run.data["spring_x"].values, run.data["spring_y"].values])
    return found[:, : SAMPLES - 1], run


def deviation(found: np.ndarray, reference: np.ndarray) -> float:
    """Return the largest difference of two forces over the largest force."""
    n = min(found.shape[1], reference.shape[1])
    largest = float(np.hypot(*reference).max()) or 1.0  # of a run that ended where it began
    return float(np.hypot(*(found[:, :n] - reference[:, :n])).max()) / largest


def without_instants(found: np.ndarray, reference: np.ndarray, allowed: float) -> np.ndarray:
    """Return a force in which single samples at a rapid slip are those of the reference.

    Such a sample lies between two that differ by no more than `allowed` of the largest force, and
    beside it the reference jumps by half of what it is off at least. It tells that the instant of
    the slip is off, by however little; by how much, the samples of the loading after it tell.
    """
    n = min(found.shape[1], reference.shape[1])
    off = np.hypot(*(found[:, :n] - reference[:, :n]))
    above = np.pad(off > allowed * np.hypot(*reference).max(), 1)
    jump = np.pad(np.hypot(*np.diff(reference[:, :n])), 1)
    single = above[1:-1] & ~above[:-2] & ~above[2:] & (2.0 * np.maximum(jump[:-1], jump[1:]) >= off)
    return np.where(single, reference[:, :n], found[:, :n])


def response(system: System, share: float, rtol: float, reference: np.ndarray) -> float:
    """Return by how much the forces change if the mass, or the load, changes by a share.

    The mass is the clock of the oscillation, the load the size of friction.
    """
    slider, times = system.slider, 1.0 + share
    inert = {"mass": slider.mass * times}
    if slider.mass_y is not None:
        inert["mass_y"] = slider.mass_y * times
    changed = (slider.replace(**inert), heavier(slider, times))
    runs = (forces(system._replace(slider=each), rtol)[0] for each in changed)
    return max(deviation(run, reference) for run in runs)


def heavier(slider: st.Slider, times: float) -> st.Slider:
    """Return a slider under so many times its load, all along the program of the load."""
    load = slider.load
    if load is not None:
        steps = tuple(
            piece._replace(**{name: getattr(piece, name) * times})
            for piece in load.program
            for name in ("value", "to", "scale")
            if hasattr(piece, name)
        )
        shaken = load.modulation and load.modulation._replace(
            amplitude=load.modulation.amplitude * times
        )
        load = st.protocols.LoadProgram(program=steps, modulation=shaken)
    return slider.replace(normal_load=slider.normal_load * times, load=load)
