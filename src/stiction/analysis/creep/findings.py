"""Findings on the creep before slip: its curves, divergence and implied misalignment."""

from __future__ import annotations

from collections.abc import Callable
from math import degrees, inf, tan
from typing import NamedTuple, TypeVar

import numpy as np

from stiction.analysis.creep.conditions import (
    CHANGED,
    FOLLOWED,
    TURNED,
    after_rest,
    at_one_load,
    driven_steadily,
    load_change,
    refuse_change,
)
from stiction.analysis.creep.curve import curves_of, mean_creep, stick_phases
from stiction.analysis.creep.divergence import Divergence, fit_divergence
from stiction.analysis.creep.first_slip import slips
from stiction.analysis.creep.force_curve import misalignment_from_force
from stiction.analysis.creep.mean_curve import (
    calibrate,
    mean_curve,
    with_base,
    with_rounding,
    with_slip_time,
)
from stiction.analysis.creep.misalignment import (
    REST_SPEED,
    SLIDING,
    WEAKENINGS,
    Misalignment,
    fit_misalignment,
)
from stiction.analysis.record import Record
from stiction.analysis.signals.correlated_noise import ERRORS_95
from stiction.arrays import Floats, Indices, xr
from stiction.errors import ResultError, StictionError
from stiction.text.quantity.wording import percent, times
from stiction.trajectory import Trajectory

T = TypeVar("T")

KNOWN = 0.25  # largest useful standard error, of the exponent, or of the angle relative to it
MISSED = 0.1  # of the creep: Eq. (7) does not describe curves with a larger misfit
# Sum of squares by which presliding alone fits better: on random rigs it did so for 2 of 112 angles
# without presliding, and for 21 of 68 under LuGre
BETTER = 4.0
SCATTER = 2.0  # standard errors, root mean square: nor those that deviate by more
# Of the creep: rest between jerks; of F_0: what friction in them is less by. With more of both the
# angle comes out up to 10 % low; a jerk that is slow beside what friction weakens by does no harm
JERKS, LOST = 0.2, 0.02
PAUSES = (
    "not determined: in every stick phase the drive pauses, or goes at another velocity than "
    "stated, and creep goes with it; let it go on steadily, as is stated, through some cycles"
)
AT_ONCE = 0.1  # of a stick phase: a longer rest is none between jerks


class CreepFound(NamedTuple):
    """Creep curves, their mean, and fits to it; for each None, `missing` gives the reason.

    The fields are those of `stiction.results.Analysis`.
    """

    curves: xr.Dataset | None
    mean: xr.Dataset | None
    divergence: Divergence | None
    misalignment: Misalignment | None
    missing: dict[str, str]


def attempt(missing: dict[str, str], name: str, find: Callable[[], T]) -> T | None:
    """Return a finding; or None, with the reason under its name in `missing`."""
    try:
        return find()
    except StictionError as error:
        missing[name] = str(error)
        return None


def find_creep(
    source: Trajectory | Record, record: Record, cycles: xr.Dataset, width: float | None
) -> CreepFound:
    """Analyse the creep in the stick phases of some cycles.

    Without a position, the misalignment follows from the force alone, and the creep from the
    stiffness that is fitted with it; if this fit fails, from the even loading in the first half of
    each rise.
    """
    missing: dict[str, str] = {}
    run = source if isinstance(source, Trajectory) else None
    phases, sticks = stick_phases(source, cycles), run.stick_intervals if run else None
    steady = driven_steadily(record, *phases.T)
    if len(steady) and not steady.any():
        return CreepFound(None, None, None, None, dict.fromkeys(("creep", "misalignment"), PAUSES))
    driven = cycles.isel(cycle=steady[len(steady) - cycles.sizes["cycle"] :])
    by_force = None
    if record.position is None:
        by_force = attempt(missing, "misalignment", lambda: misalignment_from_force(record, driven))
    known = calibrate(record, driven, by_force)
    curves = attempt(missing, "creep", lambda: curves_of(known, phases, width, sticks))
    mean = None
    if curves is not None:
        curves = curves.where(xr.DataArray(steady, dims="phase"))
        curves.attrs["left_out"] = int((~steady).sum())
        mean = attempt(missing, "creep", lambda: mean_curve(curves, known, record))
    if mean is not None:
        mean = with_base(mean, known, record) if by_force is None else mean
        mean = with_rounding(mean, known, driven)
        mean = with_slip_time(mean, known) if run is None else mean
    found = CreepFound(curves, mean, None, by_force, missing)
    V, stiffness = drive_speed(source, known), known.stiffness
    if mean is None or V is None or stiffness is None:
        return found
    if record.position is None:
        return _with_divergence(found, stiffness * V)
    if run is not None and run.slider.misalignment == 0.0:
        return found
    return _with_fits(found, run, record, stiffness, V)


def _with_divergence(found: CreepFound, rate: float) -> CreepFound:
    """Return findings by the force alone with the divergence of creep, at a rate of loading, N/s.

    The misalignment was fitted to the force, and the creep follows from it.
    """
    mean, missing, its = found.mean, {**found.missing}, found.misalignment
    assert mean is not None
    if its is None:
        missing["divergence"] = "not determined: by a force alone, it follows from the misalignment"
        return found._replace(missing=missing)
    divergence = attempt(missing, "divergence", lambda: _divergence(mean, its.F_0 / rate))
    return found._replace(divergence=divergence, missing=missing)


def _with_fits(
    found: CreepFound, run: Trajectory | None, record: Record, stiffness: float, V: float
) -> CreepFound:
    """Return findings with the fits of theory to creep: its divergence, and the misalignment."""
    curves, mean, missing = found.curves, found.mean, {**found.missing}
    assert curves is not None
    assert mean is not None
    loading = float(np.nanmax(mean["force"].values)) / stiffness / V
    ends = curves["slip_time"].values
    change = load_change(record, ends - np.fmax.reduce(curves["begin"].values, axis=1), ends)
    ends_in_slip = run is None or slips(run)

    def diverging() -> Divergence:
        if not ends_in_slip:
            raise ResultError("not determined: no slip ends the creep")
        refuse_change(change, CHANGED, "and Eq. (8) supposes a constant one")
        return _divergence(mean, loading)

    def implied() -> Misalignment:
        _refuse_rest(mean, V)
        even = _while_it_creeps(mean, curves, run, record)
        across = record.stiffness_across if run is None else run.slider.k_y
        if run is not None:
            _refuse_jerks(run, curves)
        its = _misalignment(even, V, stiffness, across, record.mass, ends_in_slip)
        turned = stiffness / (across or inf) / tan(its.phi) ** 2
        refuse_change(change, FOLLOWED, "and Eq. (7) supposes a constant one")
        most = TURNED / turned if turned else inf
        refuse_change(change, most, "and the spring across turns the slip with it")
        return its

    divergence = attempt(missing, "divergence", diverging)
    by_creep = attempt(missing, "misalignment", implied)
    return found._replace(divergence=divergence, misalignment=by_creep, missing=missing)


def _while_it_creeps(
    mean: xr.Dataset, curves: xr.Dataset, run: Trajectory | None, record: Record
) -> xr.Dataset:
    """Return the mean creep at one load, without bins in which the mass rests before it creeps."""
    creeping = after_rest(curves, run or record)
    if creeping is curves and record.load is None:
        return mean
    even = mean_creep(creeping if record.load is None else at_one_load(creeping, record))
    return with_slip_time(even, record) if run is None else even


def drive_speed(source: Trajectory | Record, record: Record) -> float | None:
    """Return V of Eq. (7), m/s; None if it is not known.

    A run yields the drive's full velocity; its record has only the part along the soft spring.
    """
    if isinstance(source, Trajectory):
        return source.slider.drive_speed or None
    return record.drive_velocity


def _divergence(mean: xr.Dataset, loading: float) -> Divergence:
    """Return the divergence of creep, if it exceeds its uncertainty."""
    found = fit_divergence(mean, loading)
    n, error = found.exponent, found.exponent_error
    if not error < KNOWN or not found.amplitude > ERRORS_95 * found.amplitude_error or n <= 0.0:
        raise ResultError("not determined: no divergence exceeds its uncertainty")
    return found


def _refuse_rest(mean: xr.Dataset, V: float) -> None:
    """Refuse creep that is rest in most bins."""
    if np.nanmedian(np.abs(mean["velocity"].values)) < REST_SPEED * V:
        raise ResultError("not determined: the mass mostly rests where Eq. (7) predicts creep")


def _refuse_jerks(run: Trajectory, curves: xr.Dataset) -> None:
    """Refuse creep by jerks, between which the mass rests, if friction is less in them.

    They are faster than the creep, and Eq. (7) supposes that friction is F_0 all the time. One long
    rest, in which soft springs are loaded, is not meant: creep begins after it.
    """
    ends, length = curves["slip_time"].values, np.fmax.reduce(curves["begin"].values, axis=1)

    def phase(time: Floats) -> Indices:
        return np.searchsorted(ends, time).clip(max=len(ends) - 1)

    start, stop = run.stick_intervals.T
    its = phase(stop)
    jerks = (stop - start < AT_ONCE * length[its]) & (stop <= ends[its])
    jerks &= start >= (ends - length)[its]
    share = float((stop - start)[jerks].sum() / np.nansum(length))
    if share < JERKS:
        return
    samples = run.samples
    time, its = samples["time"], phase(samples["time"])
    creeps = (time <= ends[its]) & (time >= (ends - length)[its]) & (samples["slip_speed"] > 0.0)
    if not creeps.any():
        return
    lost = 1.0 - float(samples["friction"][creeps].mean()) / run.slider.F_0
    if lost > LOST:
        raise ResultError(
            f"not determined: the mass creeps by jerks, in which friction is {percent(lost)} less, "
            f"and rests between them for {percent(share)} of the time; Eq. (7) supposes that it "
            "slips, and that friction keeps its magnitude"
        )


def _misalignment(
    mean: xr.Dataset,
    V: float,
    stiffness: float,
    across: float | None,
    mass: float | None,
    ends_in_slip: bool,
) -> Misalignment:
    """Return the implied misalignment, if it exceeds its uncertainty."""
    found = fit_misalignment(
        mean,
        V,
        stiffness,
        stiffness_across=across or inf,
        mass=mass or 0.0,
        weakenings=WEAKENINGS if ends_in_slip else SLIDING,
    )
    if found.misfit > MISSED or found.scatter > SCATTER:
        by = percent(found.misfit) if found.misfit > MISSED else "more than its uncertainty"
        raise ResultError(
            "not determined: Eq. (7), which supposes slow loading and a spring that is far "
            f"stiffer across, misses this creep by {by}"
        )
    if found.worse < -BETTER:
        raise ResultError(
            "not determined: a contact that gives way before it slips (presliding), "
            f"{times(found.contact)} as stiff as the spring, describes this creep better than "
            "friction that turns"
        )
    if not found.phi_error < KNOWN * abs(found.phi):
        most = abs(found.phi) + ERRORS_95 * found.phi_error
        most = degrees(max(most, _held_angle(mean, V, across)))
        limit = f"; it is below {most:.2g} deg" if most < 45.0 else ""
        raise ResultError(f"not determined: it does not stand out of its uncertainty{limit}")
    return found


def _held_angle(mean: xr.Dataset, V: float, across: float | None) -> float:
    """Return the misalignment (rad) below which a mass may be held instead of creeping.

    While it is held the spring across is loaded at k_y V sin(phi): at smaller angles by less than
    the largest force of the loading, as long as that lasts.
    """
    lasts = float(np.fmax.reduce(mean["begin"].values, initial=0.0))
    loaded = (across or inf) * V * lasts
    largest = float(np.fmax.reduce(np.abs(mean["force"].values), initial=0.0))
    return float(np.arcsin(min(largest / loaded, 1.0))) if loaded > 0.0 else 0.0
