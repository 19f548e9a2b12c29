"""Assessment of cycles and friction: those that count in an analysis, and why others do not."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from stiction.analysis.motion.changes.cycles import cycles_apart
from stiction.analysis.motion.cycle_columns import CycleTable
from stiction.analysis.motion.cycles import Swings
from stiction.analysis.motion.doubts.clipping import cut_off, noisy_end, without_cut_off
from stiction.analysis.motion.doubts.creep_distance import unseen_creep
from stiction.analysis.motion.doubts.findings import Findings
from stiction.analysis.motion.doubts.hum import with_ringing
from stiction.analysis.motion.doubts.sampling import with_smear, with_supposed_filter
from stiction.analysis.motion.doubts.unsteady import VARIES, turns_round, warnings_of_run
from stiction.analysis.motion.doubts.warnings import warnings
from stiction.analysis.motion.drift import NO_DRIFT, Drift, find_drift, with_drift
from stiction.analysis.motion.friction import Friction, friction_of, without_loading
from stiction.analysis.motion.load_cell.swings import swings_of_cell
from stiction.analysis.motion.metadata.comparison import compare_metadata
from stiction.analysis.motion.metadata.loading_rate import LOADING_RATE, other_velocity
from stiction.analysis.motion.metadata.quantity import StatedQuantity
from stiction.analysis.motion.regime.evidence import Regime
from stiction.analysis.motion.regime.kinds import STICK_SLIP, UNDETERMINED
from stiction.analysis.motion.zero import ZeroShown, why_no_friction, with_zero, zero_shown
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
    zero: ZeroShown | None = None  # the zero that a record shows


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
    its = _findings(record, found, regime)
    friction, unreal = _with_all_errors(its)
    cycles, apart = its.cycles, cycles_apart(its.cycles)
    other = other_velocity(its.stated, cycles)
    if other.any() and its.record.position is None:
        cycles = cycles.blank(("stiffness", *BY_STIFFNESS), other)
    sticking, why = _sticking(its.record, cycles, regime, other, apart)
    missing = _unknown(its, cycles) | unreal
    given = cycles.blank(missing)
    if why:
        missing |= dict.fromkeys(("creep", "misalignment"), f"not determined: {why}")
    return Assessment(
        given, given.part(~apart), sticking, friction, its.stated, warnings(its), missing, its.zero
    )


def _findings(record: Record, found: Swings, regime: Regime) -> Findings:
    """Find all by which the numbers of a record are doubted."""
    turns, cycles = imposed_reversal(None, regime), found.lasting
    clean = found.without_cell(record)
    ends = flat_ends(record.force) or noisy_end(clean, cycles)
    friction = _friction(record, found, cycles.part(~cycles_apart(cycles)), regime, turns)
    drift = find_drift(clean, cycles)
    its = Findings(clean, regime, turns, cycles, friction, drift, ends, found.load)
    kind, slips = regime.kind, cycles
    if regime.has("slips_at") and found.few is not None:
        kind, slips = STICK_SLIP, found.few
    rings = None
    if its.slips and not (turns or ends):
        lineless = clean.with_force(found.force_at_load) if found.lines else clean
        rings = swings_of_cell(lineless, its.usual)
    return its._replace(
        stated=compare_metadata(clean, kind, slips, its.shown_drift, ends),
        rings=rings,
        zero=zero_shown(clean, friction, its.alike),
    )


def _with_all_errors(its: Findings) -> tuple[Friction, dict[str, str]]:
    """Return the friction with the error of each doubt, without values that are unreal or hidden.

    The reasons are those for which columns of cycles are not friction.
    """
    record, cycles, usual = its.record, its.cycles, its.usual
    drift = its.drift if record.load_variation() <= VARIES else NO_DRIFT
    friction = with_drift(its.friction, record, cycles, drift)
    friction = with_supposed_filter(friction, record, usual, its.stated)
    friction = with_ringing(friction, its.rings)
    friction = with_zero(friction, record, its.zero)
    unreal = why_no_friction(record, friction, cycles)
    if unreal:
        friction = friction.without_static(unreal).without_kinetic(unreal)
    seen = without_cut_off(friction, record, usual, its.ends)
    why = {"mu_static": unreal, "mu_kinetic": its.turns or unreal} if len(cycles) else {}
    for name in ("static", "kinetic"):
        if getattr(friction, name) is not None and getattr(seen, name) is None:
            why[f"mu_{name}"] = cut_off(record, usual, its.ends)
    return seen, {name: reason for name, reason in why.items() if reason}


def _unknown(its: Findings, cycles: CycleTable) -> dict[str, str]:
    """Return the columns of the cycles that a record does not show, and why."""
    missing = _meaningless(its.record, cycles, its.regime, its.stated, its.shown_drift)
    cut = cut_off(its.record, its.usual, its.ends)
    if cut and its.record.position is None:
        missing |= {name: cut for name in BY_DROP if name not in missing}
    return missing


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
