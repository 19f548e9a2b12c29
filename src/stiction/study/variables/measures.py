"""Measures and traces that a study can store of each run, one line each."""

from __future__ import annotations

from collections.abc import Callable
from math import nan
from operator import attrgetter
from typing import NamedTuple

import numpy as np

from stiction.arrays import Floats
from stiction.study.variables.kinds import KINDS
from stiction.study.variables.observed_run import ObservedRun


class Measure(NamedTuple):
    """A number that describes a run.

    Parameters
    ----------
    unit, long_name : str
        CF attributes.
    of : callable
        From the observed run to the number, or NaN for none.
    flags : tuple of str, optional
        Meanings of 0, 1, ..., if the number encodes a kind.
    known : callable, optional
        From the observed run to whether the samples show it; by default `ObservedRun.resolved`. A
        million samples show the range of any force, though not in which order it came.
    """

    unit: str
    long_name: str
    of: Callable[[ObservedRun], float]
    flags: tuple[str, ...] = ()
    known: Callable[[ObservedRun], bool] = attrgetter("resolved")

    def value(self, run: ObservedRun) -> float:
        """Return the number; NaN if the samples are too few for it."""
        return self.of(run) if self.known(run) else nan


def _mean(values: np.ndarray) -> float:
    return float(values.sum()) / len(values) if len(values) else nan


def _always(run: ObservedRun) -> bool:
    return True


def _over_load(force: float, run: ObservedRun) -> float:
    """Return a force over the normal load, NaN where that varies."""
    slider = run.description.slider
    return force / slider.normal_load if slider.load is None else nan


MEASURES: dict[str, Measure] = {
    "regime": Measure("1", "kind of motion", lambda run: KINDS.index(run.regime), KINDS, _always),
    "peak_force": Measure(
        "N",
        "largest spring force along x, k_x u_x for any cell_angle",
        lambda run: run.peak,
        known=_always,
    ),
    "mu_static": Measure(
        "1",
        "apparent static friction coefficient: largest k_x u_x over a constant load",
        lambda run: _over_load(run.peak, run),
        known=_always,
    ),
    "mean_force": Measure(
        "N",
        "mean spring force along x in the last quarter",
        lambda run: run.features.late_mean,
        known=_always,
    ),
    "amplitude": Measure(
        "N",
        "half the span of the spring force along x in the last quarter",
        lambda run: 0.5 * run.late_span,
        known=_always,
    ),
    "cycles": Measure(
        "1",
        "number of complete cycles",
        lambda run: float(len(run.cycles.drop)),
    ),
    "period": Measure("s", "mean time from trough to trough", lambda run: _mean(run.cycles.period)),
    "force_drop": Measure("N", "mean force drop of the cycles", lambda run: _mean(run.cycles.drop)),
    "rise_share": Measure(
        "1", "share of a cycle in which the force rises", lambda run: _mean(run.cycles.rise_share)
    ),
    "peak_velocity": Measure(
        "m/s",
        "largest velocity of the mass along X in its slow motion: fast swings lie between samples",
        lambda run: run.features.fastest,
        known=attrgetter("resolved_velocities"),
    ),
    "first_slip_time": Measure(
        "s",
        "time at which the first slip begins: the mass gains on the drive, by more than it swings",
        lambda run: run.first_slip[0],
        known=attrgetter("resolved_velocities"),
    ),
    "creep_distance": Measure(
        "m",
        "distance along X that the mass creeps before its first slip",
        lambda run: run.first_slip[1],
        known=attrgetter("resolved_velocities"),
    ),
    "transverse_oscillation": Measure(
        "1",
        "amplitude of the fast oscillation's rate over the drive's",
        lambda run: run.transverse_oscillation,
        known=_always,
    ),
    "time_stuck": Measure(
        "s",
        "sum of all stick intervals",
        lambda run: run.solution.counts.stuck,
        known=_always,
    ),
    "stick_count": Measure(
        "1",
        "number of stick intervals",
        lambda run: float(run.solution.counts.sticks),
        known=_always,
    ),
    "steps": Measure(
        "1",
        "slip steps of the solver",
        lambda run: float(run.solution.counts.steps),
        known=_always,
    ),
}
FORMERLY = {"song": "transverse_oscillation"}  # old names, which work until the next version
DEFAULT = ("regime", "peak_force", "amplitude", "period", "creep_distance", "time_stuck")


class Trace(NamedTuple):
    """A time series: its CF attributes, and a function that returns its even samples."""

    unit: str
    long_name: str
    of: Callable[[ObservedRun], Floats]


def trace_name(name: str) -> str:
    """Return the name of a trace's variable in a store."""
    return f"{name}_trace"


TRACES: dict[str, Trace] = {
    "force": Trace("N", "spring force along x, k_x u_x", lambda run: run.force),
    "velocity": Trace("m/s", "velocity of the mass along X", lambda run: run.velocity),
    "position": Trace("m", "position of the mass along X", lambda run: run.positions),
}
