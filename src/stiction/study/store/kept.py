"""Variables that a study keeps, measures and traces alike: how to compute and store them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from math import nan
from typing import Any, NamedTuple

import numpy as np

from stiction.arrays import Floats
from stiction.study.plan.study import Study
from stiction.study.variables.measures import MEASURES, TRACES, trace_name
from stiction.study.variables.observed_run import ObservedRun
from stiction.study.variables.own import OwnMeasure

UNKNOWN = "unknown"  # the meaning of -1 in the code of a kind
TIME = "time"  # dimension of traces


class Kept(NamedTuple):
    """A variable of a study's store.

    Parameters
    ----------
    name : str
        Name of the variable.
    of : callable
        From an observed run to its value.
    shape : tuple of int
        Shape of the value: () for a number.
    dtype : type
        Stored type.
    unknown : float
        Fill value for unknown values.
    labels : dict
        CF attributes.
    """

    name: str
    of: Callable[[ObservedRun], Any]
    shape: tuple[int, ...]
    dtype: type[np.generic]
    unknown: float
    labels: dict[str, Any]


def stored_variables(study: Study) -> list[Kept]:
    """Return the variables that a study keeps of each run."""
    return [
        *(
            _own_measure(each) if isinstance(each, OwnMeasure) else _measure(each)
            for each in study.measures
        ),
        *(_trace(name, study.trace_samples) for name in study.traces),
    ]


def names_kept(study: Mapping[str, Any]) -> list[str]:
    """Return the names of the kept variables, from the table [study] of a description."""
    return [*map(_measure_name, study["measures"]), *map(trace_name, study["traces"])]


def _measure_name(measure: str | Mapping[str, str]) -> str:
    return measure if isinstance(measure, str) else measure["function"].rpartition(":")[2]


def _measure(name: str) -> Kept:
    known = MEASURES[name]
    if known.flags:
        labels = {"long_name": known.long_name, **flag_attributes(UNKNOWN, known.flags)}
        return Kept(name, known.value, (), np.int8, -1, labels)
    labels = {"units": known.unit, "long_name": known.long_name}
    return Kept(name, known.value, (), np.float64, nan, labels)


def _own_measure(measure: OwnMeasure) -> Kept:
    unit = {"units": measure.unit} if measure.unit else {}
    labels = {**unit, "long_name": measure.long_name}
    return Kept(measure.name, measure.value, (), np.float64, nan, labels)


def _trace(name: str, count: int) -> Kept:
    known = TRACES[name]

    def decimate(run: ObservedRun) -> Floats:
        at = np.linspace(run.start, run.end, count)
        return np.interp(at, run.time, known.of(run))

    labels = {"units": known.unit, "long_name": known.long_name}
    return Kept(trace_name(name), decimate, (count,), np.float64, nan, labels)


def trace_times(study: Study) -> tuple[Floats, dict[str, str]]:
    """Return the times of the samples of traces, and their CF attributes.

    They are fractions of the duration if it differs between runs.
    """
    share = np.linspace(0.0, 1.0, study.trace_samples)
    if {"run.duration", "initial.time"} & study.coordinates.keys():
        return share, {"units": "1", "long_name": "share of the run's duration"}
    start, duration = study.base.initial.time, study.base.run.duration
    return start + duration * share, {"units": "s", "long_name": "time"}


def flag_attributes(before: str, meanings: Sequence[str]) -> dict[str, Any]:
    """Return the CF attributes of a variable whose values -1, 0, 1, ... have meanings."""
    words = [meaning.replace(" ", "_") for meaning in (before, *meanings)]
    return {"flag_values": [*range(-1, len(meanings))], "flag_meanings": " ".join(words)}
