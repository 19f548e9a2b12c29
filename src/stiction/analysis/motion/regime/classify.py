"""Classify the motion in a record."""

from __future__ import annotations

from functools import partial
from math import hypot
from typing import TYPE_CHECKING

import numpy as np

from stiction.analysis.measurement.run_record import as_record
from stiction.analysis.motion.changes.mean_load import followed_load
from stiction.analysis.motion.changes.sliding import NO_LOAD, sliding
from stiction.analysis.motion.changes.strokes import strokes
from stiction.analysis.motion.course import BEGINS_UNLOADED, COURSE_PARTS
from stiction.analysis.motion.cycle_columns import CycleTable
from stiction.analysis.motion.cycles import Swings, shapes_of, swings, swings_without
from stiction.analysis.motion.disturbance import RESIDUE
from stiction.analysis.motion.noiseless.resolution import (
    AT_ONCE,
    least_drop,
    least_rate,
    residual_changes,
    shows_cycles,
    shows_motion,
)
from stiction.analysis.motion.regime.band import WIDE
from stiction.analysis.motion.regime.cycle_shape import ENOUGH, by_parts
from stiction.analysis.motion.regime.evidence import Evidence, Regime
from stiction.analysis.motion.regime.force_course import by_course
from stiction.analysis.motion.regime.kinds import (
    HARMONIC,
    IRREGULAR,
    SETTLING,
    STEADY,
    STICK_SLIP,
    STUCK,
    TRANSITIONAL,
    UNDETERMINED,
)
from stiction.analysis.motion.regime.of_run import (
    Circumstances,
    many_sticks,
    regime_without_cycles,
    settle,
)
from stiction.analysis.motion.rest import (
    comes_to_rest,
    rests_throughout,
)
from stiction.analysis.motion.vibration import (
    COUPLED,
    FAST_PERIODS,
    OWN_PERIODS,
    FastOscillation,
)
from stiction.analysis.record import ExactForce, Record
from stiction.analysis.signals.digitised import resolution
from stiction.analysis.signals.even_grid import even_grid
from stiction.analysis.signals.hum import narrow_lines, of_mains, samples_per_period
from stiction.analysis.signals.turning_points import without_spikes
from stiction.arrays import Floats
from stiction.recording.noise import white_noise
from stiction.trajectory import Trajectory

if TYPE_CHECKING:  # else numba would be loaded for a measured record, too
    from stiction.analysis.motion.noiseless.features import Features

FEWEST_PER_CYCLE = 3.5  # samples a cycle: below it is not known, nor what it is
MAY_BE_HUM = (TRANSITIONAL, HARMONIC, IRREGULAR, UNDETERMINED)
WITHOUT_CYCLES = (SETTLING, STEADY, STUCK)
SAME = 0.01  # of a period: by so much that of a line and that of the cycles differ
MANY_SAMPLES = 64.0  # a cycle: no quicker line has been folded back to it


def classify(source: Trajectory | Record) -> Regime:
    """Classify the motion in a record.

    The shape of the cycles decides (`stiction.analysis.motion.rest`). If there are none, or they
    die out, the course of the force decides: it rises to the end, settles, or stays about constant.
    Where jumps of the drive's velocity make the swings, nothing is determined. A run is classified
    by its cycles between samples, without noise (`stiction.analysis.motion.regime.of_run`), as a
    study does it; nothing is determined where its samples are too few to show its motion.

    Parameters
    ----------
    source : Trajectory or Record
        A run or a measurement. With stiffness, drive velocity and mass, the rate of loading and
        the natural period count too; otherwise only the shape.

    Examples
    --------
    >>> import numpy as np, stiction as st
    >>> time = np.arange(0.0, 20.0, 1e-3)
    >>> st.analysis.classify(st.Record(time=time, force=0.1 * (time % 2.0))).kind
    'stick-slip'
    """
    run = source if isinstance(source, Trajectory) else None
    return classify_record(as_record(source), run)[2]


def classify_record(record: Record, run: Trajectory | None = None) -> tuple[Record, Swings, Regime]:
    """Return a record, or that of a run, with its swings and its kind of motion.

    Where the force follows a load that varies, the record is that under the mean load.
    """
    load = followed_load(record)
    steady = record if load is None else load.taken_from(record)
    found = swings(steady)._replace(load=load)
    return steady, found, regime_of(steady, found, run)


def regime_of(record: Record, found: Swings, run: Trajectory | None = None) -> Regime:
    """Classify the motion in a record, or the record of a run, with known swings: see `classify`.

    A motion without cycles is one to which nothing else happens. A run that ended early shows that
    for a share of its duration, and the confidence is less by this share.
    """
    known = record.exact
    if known is None or found.features is None:
        seen = _by_cycles_or_course(record, found)
    else:
        seen = _regime_of_run(record, found, known, found.features)
    if run is None or run.status.ok or seen.kind not in WITHOUT_CYCLES:
        return seen
    end, whole = float(run.final.time), run.description.run.duration
    evidence = seen.evidence | {"ended_early": end}
    return seen._replace(confidence=seen.confidence * min(end / whole, 1.0), evidence=evidence)


def _by_cycles_or_course(record: Record, found: Swings) -> Regime:
    """Return the kind of motion by the cycles of a record, or by the course of its force."""
    if len(record) < COURSE_PARTS:
        return Regime(UNDETERMINED, 0.0, {"samples": len(record)})
    if record.slip_speed is None:
        if np.ptp(record.force) == 0.0 and found.load is None:
            return Regime(UNDETERMINED, 0.0, {"unchanging": float(record.force[0])})
        if (pulls := strokes(record)) is not None:
            return Regime(UNDETERMINED, 0.0, {"forth": pulls[0], "back": pulls[1]})
    if found.lines or found.cell:
        record = record.with_force(found.force)
    per_cycle = 2.0 * len(record) / max(found.turns, 1)
    if not len(found.table) or per_cycle < MANY_SAMPLES:
        per_cycle = min(per_cycle, samples_per_period(record.force))
    if per_cycle < FEWEST_PER_CYCLE:
        needed = ENOUGH / per_cycle * record.sample_rate
        return Regime(UNDETERMINED, 0.0, {"samples_per_cycle": per_cycle, "rate_needed": needed})
    if found.dying or _has_stopped(record, found):
        drop = found.table["drop"]
        sure = (len(drop) + 1) / (len(drop) + 3)
        evidence: dict[Evidence, float] = {
            "swings": len(drop),
            "last_over_first": drop[-1] / drop[0],
        }
        return Regime(SETTLING, sure, evidence)
    if len(found.table):
        period = found.lasting.mean("period")
        seen = _unless_against(record, found.lasting, by_parts(record, found))
        return _or_hum(record, period, SAME, seen)
    if found.driven:
        return Regime(UNDETERMINED, 0.0, {"driven": found.driven})
    if found.few is not None:
        return Regime(UNDETERMINED, 0.0, _single_slip(record, found, found.few), STICK_SLIP)
    seen = _beside_gaps(record, _while_it_slides(record, found))
    if len(found.levels) > 1:
        return seen._replace(evidence=seen.evidence | {"levels": len(found.levels)})
    frequency = seen.evidence.get("hump")
    return _or_hum(record, 1.0 / frequency, WIDE - 1.0, seen) if frequency else seen


def _single_slip(record: Record, found: Swings, slips: CycleTable) -> dict[Evidence, float]:
    """Return the evidence of a slip that is the only one, so that there is no cycle.

    Its fall has the error of two samples, or of the loading from one to the next; of what its ends,
    where the sides meet, lie beyond the samples: they may be round; and of the rest of a line that
    was subtracted.
    """
    begin, end, drop = (float(slips[name][0]) for name in ("peak_time", "trough_time", "drop"))
    between = float(slips["stick_slope"][0]) / record.sample_rate
    read = -float(np.diff(np.interp([begin, end], record.time, found.force))[0])
    error = 2.0**0.5 * max(white_noise(record.force), resolution(record.force), between)
    left = 0.5 * RESIDUE * sum(line.height for line in found.lines)
    error = hypot(error, drop - read, left)
    return {
        "slips_at": begin, "slips_by": drop, "slips_by_error": error, "slips_within": end - begin,
    }  # fmt: skip


def _while_it_slides(record: Record, found: Swings) -> Regime:
    """Return the kind of motion without cycles until the drive turns, or the spring is unloaded."""
    _, last, falls = sliding(record)
    if last == len(record) or last < COURSE_PARTS or record.slip_speed is not None:
        return by_course(record, found)
    until = record.before(float(record.time[last]))
    seen = by_course(until, found._replace(force=found.force[:last]))
    end = min(falls, len(record) - 1)
    before, later = (abs(float(np.median(part))) for part in np.split(record.force, [end]))
    name: Evidence = "unloaded" if later < NO_LOAD * before else "turned"
    return seen._replace(evidence=seen.evidence | {name: float(record.time[end])})


def _unless_against(record: Record, cycles: CycleTable, seen: Regime) -> Regime:
    """Return the kind of some cycles; undetermined where a wrong sign may give them its shape.

    Where a record begins unloaded and its peaks are all negative, or the zero is known, it is not
    the zero that is off. Then the force falls slowly where it seems to rise, as it does in a hold.
    """
    if seen.kind not in (STICK_SLIP, TRANSITIONAL) or record.slider is not None:
        return seen
    least = -float(cycles["peak"].max())
    begins = abs(float(without_spikes(record.force)[0]))
    if least <= 0.0 or (record.zero is None and begins > BEGINS_UNLOADED * least):
        return seen
    return Regime(UNDETERMINED, 0.0, {"cycles": len(cycles), "against": least})


def _beside_gaps(record: Record, seen: Regime) -> Regime:
    """Return a kind of motion without cycles, unless the record without its gaps may have some.

    Only a spectrum shows cycles that noise hides, and across long gaps it cannot be computed. Where
    the parts between gaps are joined, cycles change their phase there, but a spectrum shows them.
    """
    grid = even_grid(record.time)
    unsure = seen.kind in WITHOUT_CYCLES and record.slip_speed is None
    if not unsure or grid is None or not grid.has_gaps:
        return seen
    joined = record.model_copy(update={"time": grid.close_gaps(record.time)})
    left = even_grid(joined.time)
    if left is None or left.has_gaps:
        return seen
    its = regime_of(joined, swings(joined))
    if its.kind in WITHOUT_CYCLES:
        return seen._replace(confidence=min(seen.confidence, its.confidence))
    other = its.runner_up if its.kind == UNDETERMINED else its.kind
    evidence = seen.evidence | {"gaps": float(grid.missing.mean())}
    return Regime(UNDETERMINED, 0.0, evidence, other)


def _regime_of_run(record: Record, found: Swings, known: ExactForce, its: Features) -> Regime:
    """Return the kind of motion of a run, whose force has no noise."""
    if len(record) < COURSE_PARTS:
        return Regime(UNDETERMINED, 0.0, {"samples": len(record)})
    if rests_throughout(known.time, known.slip_speed, known.sticks):
        return Regime(STUCK, 1.0, {"rests": record.duration})
    if found.driven:
        return Regime(UNDETERMINED, 0.0, {"driven": found.driven})
    if (unseen := _too_coarse(known, found.lasting["drop"], its)) is not None:
        return unseen
    shapes, loading = shapes_of(found.table), record.loading_rate
    given = Circumstances.of(
        known.slider, known.time, shapes, loading, known.slip_speed, known.sticks
    )
    if len(found.lasting) and not settle(shapes, given):
        return by_parts(record, found)
    return regime_without_cycles(its, shapes, given, partial(_fast_oscillation, known))


def _too_coarse(known: ExactForce, drop: Floats, its: Features) -> Regime | None:
    """Return that nothing is determined of a run whose samples are too few to show its motion.

    The drop (N) is that of each cycle that they seem to show.
    """
    needed = least_rate(known.slider)
    if float(np.diff(known.time).max()) * needed < 1.0 + SAME:
        return None
    missed = np.abs(residual_changes(known.time, known.force, known.rate))
    span = float(np.ptp(known.force))
    if shows_motion(missed, drop, span, its, known.rtol) or shows_cycles(
        known.time, missed, drop, span, known.sticks
    ):
        return None
    unseen = float(missed[AT_ONCE:].max(initial=0.0)) / least_drop(drop, span)
    begin, end = float(known.time[0]), float(known.time[-1])
    sticking = many_sticks(begin, end, known.sticks)
    if sticking is not None and sticking.evidence["rate_needed"] < needed:
        return sticking
    return Regime(UNDETERMINED, 0.0, {"unexplained": unseen, "rate_needed": needed})


def _fast_oscillation(known: ExactForce) -> FastOscillation:
    """Return the fast oscillation at the end of a run."""
    lasts = FAST_PERIODS / known.slider.natural_frequencies[1]
    first = int(np.searchsorted(known.time, known.time[-1] - lasts))
    return FastOscillation.at_end(known.slider, known.rate_across[first:])


def _has_stopped(record: Record, found: Swings) -> bool:
    """Return whether swings have ended for good: mass and drive are known to rest."""
    drop = found.table["drop"]
    still = record.drive_velocity is None and record.drive_travel is None
    ended = still and comes_to_rest(record.slip_speed)
    return ended and len(drop) > 0 and bool(drop[-1] <= drop[0])


def _or_hum(record: Record, period: float, differs: float, seen: Regime) -> Regime:
    """Return a kind of motion, as likely another one if its swings are a line of the mains.

    Nothing distinguishes hum over another motion from a vibration at that frequency, unless the
    slip speed is known, or the mass swings with that period on its spring.
    """
    own = seen.evidence.get("natural_period", 0.0)
    free = seen.kind in MAY_BE_HUM and not COUPLED <= own <= OWN_PERIODS
    if not free or record.slip_speed is not None:
        return seen
    for line in narrow_lines(even_grid(record.time), record.force):
        if of_mains(line.frequency) and abs(line.frequency * period - 1.0) < differs:
            without, left = swings_without(line, record)
            other = regime_of(without, left)
            kind = STEADY if other.runner_up == STEADY else other.kind
            evidence = seen.evidence | {"mains": line.frequency}
            evidence.pop("backward", None)
            return Regime(seen.kind, 0.5 * seen.confidence, evidence, kind)
    return seen
