"""Doubts about a test whose drive or load varies, or that ended early."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from stiction.analysis.measurement.run_record import across_force
from stiction.analysis.motion.changes.mean_load import FollowedLoad
from stiction.analysis.motion.cycle_columns import CycleTable
from stiction.analysis.motion.doubts.sampling import doubt_few_samples, doubt_slips_between_samples
from stiction.analysis.motion.regime.kinds import STICK_SLIP
from stiction.analysis.record import Record
from stiction.system.load_cell import ACROSS
from stiction.text.quantity.wording import in_words, percent
from stiction.trajectory import Trajectory

VARIES = 0.05  # of the mean of a measured load: less is not worth a sentence
IMPOSED = {"drive": ("drive_X", "drive_Y"), "load": ("normal_load",)}  # columns of a run
STIRS = 0.01  # of the drive's largest speed: more backwards is a motion to and fro


def doubt_load(record: Record, load: FollowedLoad | None) -> Iterator[str]:
    """Say that a measured load varies, and which analysis suits it."""
    varies = record.load_variation()
    if load is not None:
        yield (
            f"The normal load varies by {percent(varies)} of its mean, and the force follows it, "
            f"by {load.slope:.3g} of it: kind of motion, cycles and their forces are those under "
            "the mean load. Coefficients of friction are force over load at the same instant."
        )
    elif varies > VARIES:
        yield (
            f"The normal load varies by {percent(varies)} of its mean. Coefficients of "
            "friction are force over load at the same instant; kind of motion, cycles and forces "
            "are those of a steady test, which this is not; st.analysis.load_dependence suits such "
            "a test."
        )


def warnings_of_run(
    run: Trajectory, record: Record, kind: str, cycles: CycleTable
) -> tuple[str, ...]:
    """Return warnings about the samples of a run; its parameters are exact."""
    return (
        *_ended_early(run),
        *([f"The load cell {ACROSS}."] if across_force(run, record) else []),
        *say_unsteady(run, kind),
        *doubt_few_samples(record, cycles),
        *doubt_slips_between_samples(record, cycles),
    )


def _ended_early(run: Trajectory) -> tuple[str, ...]:
    """Return a sentence if a run did not reach its duration, and why."""
    if run.status.ok:
        return ()
    end, whole = float(run.final.time), run.description.run.duration
    return (
        f"The run ended early, at {in_words(end, 's')} of {in_words(whole, 's')}: "
        f"{run.status.value}.",
    )


def say_unsteady(run: Trajectory, kind: str) -> tuple[str, ...]:
    """Return a sentence if the drive or the load of a run varies, and which analysis suits it.

    It is needless where that analysis found its test.
    """
    varies = variations(run)
    if not varies:
        return ()
    remedy = "st.analysis.velocity_steps, healing or hysteresis suit such a test"
    if varies == ["load"]:
        remedy = "st.analysis.load_dependence suits such a test"
    if turns_round(run):
        remedy = "st.analysis.hysteresis gives the loops of force over travel"
    elif kind == STICK_SLIP and "drive" in varies:  # whose parts show no steady friction, either
        remedy = "the table of cycles has each by itself"
    return (
        f"The {' and the '.join(varies)} {'varies' if len(varies) == 1 else 'vary'}: kind of "
        f"motion, cycles and friction are those of a steady test, which this is not; {remedy}.",
    )


def variations(run: Trajectory) -> list[str]:
    """Return the varying quantities of a run, drive or load or both, in words."""
    return [name for name, of in IMPOSED.items() if any(np.ptp(run.samples[x]) > 0.0 for x in of)]


def turns_round(run: Trajectory) -> bool:
    """Return whether the drive of a run goes both ways; a stage at rest may stir a little."""
    along = run.samples["drive_X"]
    least = STIRS * float(np.abs(along).max(initial=0.0))
    return bool(along.min() < -least and along.max() > least)
