"""The numbers of an audit, for JSON."""

from __future__ import annotations

from math import nan
from typing import TYPE_CHECKING, Any

from stiction.auditing.advice import Remedy
from stiction.auditing.oscillation import TransverseSwings
from stiction.auditing.pairs import Pair
from stiction.auditing.simulated_test import LOADS, SimulatedTest
from stiction.auditing.words.numbers import peak
from stiction.storage.table_files import number

if TYPE_CHECKING:
    from stiction.auditing.report import Audit

THEORY = {
    "F_0": "N", "F_static": "N", "f_x": "Hz", "f_y": "Hz", "A": "", "zeta": "", "theta_c": "rad",
    "phi_c": "rad", "first_stick": "s", "load_up": "s", "creep_at_start": "m/s",
    "creep_at_slip": "m/s", "creep_distance": "m", "mu_static": "", "mu_kinetic": "", "drop": "N",
    "period": "s", "amplitude": "m", "sample_rate": "Hz",
}  # fmt: skip
MEANS = {"drop": "N", "period": "s"}  # over the cycles of a test


def data(found: Audit) -> dict[str, Any]:
    """Return the numbers of an audit with their units; null if unknown."""
    sliding, phi = found.sliding, found.misalignment
    return {
        "motion": found.observation.motion,
        "started_sliding": found.sliding_on.motion,
        "bistable": found.bistable,
        "steady_sliding": sliding.verdict,
        "growth_rate": with_unit(sliding.growth_rate, "1/s"),
        "stable_misalignments": [
            {"from": low, "to": high, "unit": phi.unit} for low, high, ok in phi.stretches if ok
        ],
        "theory": {
            name: with_unit(getattr(found.prediction, name), its) for name, its in THEORY.items()
        },
        "simulated": of_test(found.observation),
        "transverse_oscillation": _swings(found.oscillation),
        "changes": [_change(each) for each in found.remedies],
    }


def with_unit(value: float, unit: str) -> dict[str, Any]:
    """Return a number with its unit; None if it is unknown."""
    return {"value": number(value), "unit": unit}


def of_test(seen: SimulatedTest) -> dict[str, Any]:
    """Return the numbers of a simulated test."""
    means = {name: with_unit(seen.mean(name), unit) for name, unit in MEANS.items()}
    shares = {name: with_unit(share, "") for name, share in seen.shares._asdict().items()}
    reached = {"time": with_unit(seen.settled, "s"), "travel": with_unit(seen.travel, "m")}
    friction = with_unit(nan if seen.comes_to == LOADS else peak(seen), "")
    found = {"decided": seen.decided, "mu_static": friction, **means}
    return {**found, "shares": shares, "reached": reached}


def _swings(shown: TransverseSwings) -> dict[str, Any]:
    """Return the swings across the drive at both ends of each simulated creep."""
    parts = ("first", [shown.first]), ("after_slip", shown.later), ("last", shown.last)
    units = {"frequency": "Hz", "amplitude": "m", "at_rest": ""}
    rows = {
        name: [
            {of: with_unit(getattr(each, of), its) for of, its in units.items()}
            for each in filter(None, swings)
        ]
        for name, swings in parts
    }
    return rows | {"dies_out": with_unit(shown.dead, "s")}


def _change(each: Remedy | Pair) -> dict[str, Any]:
    seen = each.tried
    parts = each.changes if isinstance(each, Pair) else (each,)
    return {
        "parameters": [
            {"name": of.path, "unit": of.unit, "now": of.now, "tried": number(of.then)}
            for of in parts
        ],
        "factor": number(each.factor),
        "works": each.works,
        "motion": seen.motion if seen else None,
        "time": with_unit(seen.settled if seen else nan, "s"),
        "travel": with_unit(seen.travel if seen else nan, "m"),
    }
