"""Assessment of cycles and friction: those that count in an analysis, and why others do not."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from stiction.analysis.motion.changes.cycles import cycles_apart
from stiction.analysis.motion.changes.initial_rest import InitialRest
from stiction.analysis.motion.cycle_columns import CycleTable
from stiction.analysis.motion.cycles import Swings
from stiction.analysis.motion.doubts.clipping import cut_off, noisy_end, without_cut_off
from stiction.analysis.motion.doubts.creep_distance import unseen_creep
from stiction.analysis.motion.doubts.load_cell import with_ringing
from stiction.analysis.motion.doubts.sampling import with_smear, with_supposed_filter
from stiction.analysis.motion.doubts.warnings import VARIES, turns_round, warnings, warnings_of_run
from stiction.analysis.motion.doubts.zero import why_no_friction, with_zero, zero_shown
from stiction.analysis.motion.drift import NO_DRIFT, Drift, find_drift, is_shown, with_drift
from stiction.analysis.motion.friction import Friction, friction_of, without_loading
from stiction.analysis.motion.load_cell.swings import swings_of_cell
from stiction.analysis.motion.metadata.comparison import compare_metadata
from stiction.analysis.motion.metadata.loading_rate import LOADING_RATE, other_velocity
from stiction.analysis.motion.metadata.quantity import StatedQuantity
from stiction.analysis.motion.regime.evidence import Regime
from stiction.analysis.motion.regime.kinds import STICK_SLIP, TRANSITIONAL, UNDETERMINED
from stiction.analysis.record import Record
from stiction.analysis.signals.clipping import flat_ends
from stiction.analysis.signals.digitised import resolution
from stiction.recording.noise import rounding_error
from stiction.trajectory import Trajectory

OF_STICKING = ("mu_static", "stick_slope", "stiffness", "creep_distance")  # columns of cycles
OF_SLIDING = ("mu_kinetic", "slip_distance", "peak_slip_speed")  # and those of any known motion
# columns that a force alone gives by stiffness and drive velocity
BY_STIFFNESS = ("creep_distance", "slip_distance", "peak_slip_speed")
BY_DROP = ("creep_distance", "slip_distance")  # and by peaks and troughs
HALTING = (
    "the force hesitates in each cycle, and a small slip before the peak cannot be distinguished "
    "from creep"
)
CHANGING = "the rate of loading goes on changing"


class Assessment(NamedTuple):
    """The cycles and friction of an analysis that count."""

    cycles: CycleTable  # a row for each cycle; columns that mean nothing for its motion are blank
    # those of its cycles that belong together, and those that creep before they slip
    usual: CycleTable
    sticking: CycleTable
    friction: Friction  # friction at the break-away, static and kinetic
    # what a record states of its apparatus, beside what its force says
    stated: tuple[StatedQuantity, ...]
    warnings: tuple[str, ...]  # to be read first
    # the reason for each column that is blank, and for creep where no cycle shows it
    missing: dict[str, str]
    zero: InitialRest | None = None  # that which a record shows before its first loading


def assess_run(run: Trajectory, record: Record, found: Swings, regime: Regime) -> Assessment:
    """Return the assessment of a run, whose parameters are exact."""
    cycles, turns = found.lasting, imposed_reversal(run, regime)
    friction = _friction(record, found, cycles, regime, turns)
    missing = _meaningless(record, cycles, regime)
    if turns and len(cycles):
        missing |= {"mu_kinetic": turns}
    given = cycles.blank(missing)
    sticking = cycles if regime.loads else cycles.part(slice(0))
    doubts = warnings_of_run(run, record, regime.kind, cycles)
    return Assessment(given, given, sticking, friction, (), doubts, missing)


def assess_record(record: Record, found: Swings, regime: Regime) -> Assessment:
    """Return the assessment of a record, whose stated parameters may contradict its force."""
    cycles, turns = found.lasting, imposed_reversal(None, regime)
    apart = cycles_apart(cycles)
    usual = cycles.part(~apart)
    of_force = _friction(record, found, usual, regime, turns)
    clean = record if found.cell is None else record.with_force(found.force_at_load)
    drift = find_drift(clean, cycles)
    shown = drift if is_shown(drift, regime.kind) else None
    ends = flat_ends(record.force) or noisy_end(clean, cycles)
    kind, slips = regime.kind, cycles
    if regime.has("slips_at") and found.few is not None:
        kind, slips = STICK_SLIP, found.few
    stated = compare_metadata(clean, kind, slips, shown, ends)
    alike = cycles.part(slice(0)) if turns else cycles  # those of two strokes are none
    zero = zero_shown(clean, of_force, alike)
    slips_on = regime.kind in (STICK_SLIP, TRANSITIONAL) and not (turns or ends)
    seen = clean.with_force(found.force_at_load) if found.lines else clean
    rings = swings_of_cell(seen, usual) if slips_on else None
    doubts = warnings(
        clean, regime.kind, alike, of_force, stated, drift, ends, rings, zero, found.load
    )

    # the friction of the force, with one error after the other, then without what is unreal
    drifts = drift if clean.load_variation() <= VARIES else NO_DRIFT
    drifting = with_drift(of_force, clean, cycles, drifts)
    filtered = with_supposed_filter(drifting, clean, usual, stated)
    whole = with_zero(with_ringing(filtered, rings), clean, zero)
    unreal = why_no_friction(clean, whole, cycles)
    real = whole.without_static(unreal).without_kinetic(unreal) if unreal else whole
    friction = without_cut_off(real, clean, usual, ends)

    other = other_velocity(stated, cycles)
    suits = cycles
    if other.any() and clean.position is None:
        suits = cycles.blank(("stiffness", *BY_STIFFNESS), other)
    sticking, why = _sticking(clean, suits, regime, other, apart)
    missing = _meaningless(clean, suits, regime, stated, shown)
    cut = cut_off(clean, usual, ends)
    if cut and clean.position is None:
        missing |= {name: cut for name in BY_DROP if name not in missing}
    if len(cycles):
        reasons = {"mu_static": unreal, "mu_kinetic": turns or unreal}
        missing |= {name: reason for name, reason in reasons.items() if reason}
    for name in ("static", "kinetic"):
        if getattr(real, name) is not None and getattr(friction, name) is None:
            missing[f"mu_{name}"] = cut
    given = suits.blank(missing)
    if why:
        missing |= dict.fromkeys(("creep", "misalignment"), f"not determined: {why}")
    return Assessment(given, given.part(~apart), sticking, friction, stated, doubts, missing, zero)


def _sticking(
    record: Record,
    cycles: CycleTable,
    regime: Regime,
    other: NDArray[np.bool_],
    apart: NDArray[np.bool_],
) -> tuple[CycleTable, str]:
    """Return the cycles that creep before they slip, and the reason if none can; else ""."""
    if not regime.loads:
        return cycles.part(slice(0)), ""
    halting = (cycles["hesitations"] > 0.0) & (record.position is None)
    why = HALTING if halting.all() else CHANGING if other.all() else ""
    return cycles.part(~(other | apart | halting)), why


def _friction(
    record: Record, found: Swings, usual: CycleTable, regime: Regime, turns: str
) -> Friction:
    """Find the friction without hum and ringing.

    Where the drive or the force turns round, for the reason `turns`, there is no kinetic friction,
    or none at all.
    """
    changed = found.lines or found.ringing or found.cell
    clean = record.with_force(found.force_at_load) if changed else record
    if regime.has("levels"):
        first = clean.before(found.levels[0].end)
        several = "the force stays at several levels, each with its own: see the parts"
        return friction_of(first, regime, usual).without_kinetic(several)
    friction = with_smear(friction_of(clean, regime, usual), clean, usual)
    rounding = rounding_error(record.force, resolution(record.force))
    friction = friction.with_errors(break_away=rounding)
    if changed:  # what is left without a line has no steps, but their error
        friction = friction.with_errors(static=rounding, kinetic=rounding)
    if regime.has("forth", "straight"):
        return friction.without_any(turns)
    return friction.without_kinetic(turns) if turns else friction


def imposed_reversal(run: Trajectory | None, regime: Regime) -> str:
    """Return the imposed reversal that leaves no mean as kinetic friction; empty if none.

    It is that of a run, or of a record with this kind of motion.
    """
    if run is not None and turns_round(run):
        return "the drive goes back and forth"
    if regime.has("forth"):
        return "the force goes back and forth between both signs"
    if regime.has("plateaus"):
        return "the force goes back and forth between two levels"
    if regime.has("straight"):
        return "the force rises and falls evenly, as where the mass sticks"
    return ""


def _meaningless(
    record: Record,
    cycles: CycleTable,
    regime: Regime,
    stated: tuple[StatedQuantity, ...] = (),
    drift: Drift | None = None,
) -> dict[str, str]:
    """Return the columns that are meaningless for a motion, or as things are stated, and why."""
    if not len(cycles):
        return {}
    if not regime.loads:
        names: tuple[str, ...] = OF_STICKING
        if regime.kind == UNDETERMINED and record.position is None:
            names += OF_SLIDING
        why = f"they are defined for stick-slip, and {without_loading(regime)}"
        return dict.fromkeys(names, why)
    rates = [each for each in stated if each.quantity == LOADING_RATE]
    if any(each.agrees is False for each in rates) and record.position is None:
        return dict.fromkeys(BY_STIFFNESS, "stiffness or drive velocity contradict the force")
    known = cycles["creep_distance"][~np.isnan(cycles["creep_distance"])]
    if not len(known):
        moves = np.isfinite(cycles["slip_distance"]).any()
        return {"creep_distance": HALTING} if moves else {}
    if unseen := unseen_creep(record, cycles, drift):
        return {"creep_distance": unseen}
    if not np.median(known) < 0.0:
        return {}
    if any(each.agrees for each in rates):
        agreeing = "the force rises as fast as the stated stiffness and drive velocity allow"
        return {"creep_distance": f"{agreeing}, within their errors"}
    faster = "the force rises faster than the stated stiffness and drive velocity allow"
    return {"creep_distance": faster}
