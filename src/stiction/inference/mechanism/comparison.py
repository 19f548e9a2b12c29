"""st.mechanism(records, rig): which mechanism made the records, friction or apparatus."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from hashlib import sha256
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from stiction.arguments import end_reading, read_together
from stiction.arrays import Floats
from stiction.errors import DescriptionError, Fault, Instruction, ResultError
from stiction.inference.columns import bend_features
from stiction.inference.fit import check, plan_for
from stiction.inference.measured.observed_rig import ObservedRig, observe_rig
from stiction.inference.mechanism import classifier, likeness
from stiction.inference.mechanism.classifier import Classifier, Simulations, begin, simulate
from stiction.inference.mechanism.likeness import Reference
from stiction.inference.mechanism.odds import SHARE, SIMULATIONS, Odds, surely
from stiction.inference.mechanism.rest import ALIKE_SIMULATIONS, Rest, shares_at_rest
from stiction.inference.mechanism.rivals import CLAIMED, ROTATION, Mechanism, mechanisms
from stiction.inference.mechanism.static_check import ELASTIC, StaticCheck
from stiction.inference.observation import (
    Observation,
    Source,
    steadiness,
    trend_of,
)
from stiction.inference.rig import Rig, refuse_swapped, rig_of
from stiction.inference.simulated.library import library_folder
from stiction.inference.suitability import explain_unlike
from stiction.progress.audience import with_progress
from stiction.progress.report import Progress, part, silent


@read_together
@with_progress("simulating and telling mechanisms apart")
def mechanism(
    records: Source | Sequence[Source],
    rig: Rig | str | Path,
    *,
    simulations: int = SIMULATIONS,
    library: str | Path | None = None,
    seed: int = 0,
    progress: Callable[[float], None] | None = None,
) -> Odds:
    """Find which mechanism made one or several measured records of a rig.

    Compared are rotation of the friction vector, static friction in one dimension, rate and state,
    and LuGre, each on the apparatus that the rig's description states, its priors included. Records
    are simulated by each, as for `stiction.fit`; a classifier learns to tell them apart. It says
    "undecided" when no mechanism is probable enough, when the record or its loading curve is unlike
    simulations of the most probable one, or when friction drifts; and for rate and state or LuGre,
    when static friction on the misaligned rig may look the same. That is claimed in place of
    rotation where the mass rests in simulations with the record's parameters.

    Experimental: how often simulated records are called rightly is reported beside the odds, but a
    law that was not simulated may pass for one that was.

    Parameters
    ----------
    records : Record, Trajectory, str, Path or sequence of Record, Trajectory, str or Path
        As for `stiction.fit`.
    rig : Rig, str or Path
        The description with its priors, one of them of the misalignment ``phi``.
    simulations : int, optional
        Of each mechanism, at least 100; with fewer than 1000 more records of laws that were not
        simulated pass for one that was.
    library : str or Path, optional
        A folder in which simulations are kept; those of rotation are shared with `stiction.fit`.
    seed : int, optional
        Of the simulations.
    progress : callable, optional
        Called with the fraction done; without it, a terminal or a notebook shows a bar or lines.

    Returns
    -------
    Odds
        Probabilities, the confusion matrix of the classifier, and a decision.

    Raises
    ------
    ResultError
        If a record cannot be used, or the priors lead to too few records with cycles, or do so by
        all mechanisms but one.
    DescriptionError
        If the rig is not of a kind that can be fitted, or is exactly aligned.
    """
    refuse_swapped(rig, records, "the rig comes second: st.mechanism(records, rig)")
    known = rig_of(rig)
    check_comparable(known, simulations)
    place = library_folder(library)
    its = observe_rig(records, known)
    end_reading()
    return odds_of_observed(its, simulations, place, seed, progress or silent)


def odds_of_observed(
    its: ObservedRig, simulations: int, place: Path | None, seed: int, progress: Progress
) -> Odds:
    """Do as `mechanism` for records that are observed, with libraries in the folder `place`."""
    rivals = mechanisms(its.rig, its.conditions)
    simulating, comparing = part(progress, 0, 10, of=8), part(progress, 8, 10, of=2)
    simulated = simulate(rivals, simulations, place, seed=seed, progress=simulating)
    kept = None if place is None else place / f"{key(rivals)}-{simulations}-{seed}"
    found = odds_of(simulated, its.rig, its.seen, kept, comparing, simulations)
    progress(1.0)
    return found


def odds_or_reason(
    its: ObservedRig, simulations: int, place: Path | None, seed: int, progress: Progress
) -> Odds | str:
    """Return the odds beside a fit of so many simulations; the reason where there are none."""
    of_each = simulations // SHARE
    try:
        check_comparable(its.rig, of_each)
        return odds_of_observed(its, of_each, place, seed, progress)
    except (ResultError, DescriptionError) as error:
        return str(error)


def check_comparable(rig: Rig, simulations: int = SIMULATIONS) -> None:
    """Refuse a rig on which nothing rotates, or that cannot be fitted, and few simulations."""
    check(rig)
    faults = []
    if rig.slider.phi == 0.0 and "phi" not in rig.priors:
        message = 'is 0 for certain, so that nothing rotates; write for example phi = "0 +- 2 deg"'
        faults.append(Fault("phi", message))
    if simulations < likeness.CURVES:
        least = Instruction(
            f"each mechanism gets a quarter of them, which must be at least {likeness.CURVES}, is "
            f"{simulations}; write -n {SHARE * likeness.CURVES} or more",
            f"must be at least {likeness.CURVES} of each mechanism, is {simulations}",
        )
        message = f"{least}: with fewer no loading curve is found unlike the simulated ones"
        faults.append(Fault("simulations", message))
    if faults:
        raise DescriptionError(faults)


def refuse_incomparable(
    its: ObservedRig, simulations: int, place: Path | None, seed: int, progress: Progress
) -> None:
    """Refuse records and a rig for which `odds_of_observed` has no answer, before a fit of them.

    As far as the first simulations of each mechanism tell; a library keeps them.
    """
    begin(mechanisms(its.rig, its.conditions), simulations, place, seed, progress)


def key(rivals: Sequence[Mechanism]) -> str:
    """Return a hash of everything that determines the simulations of some mechanisms."""
    keys = [plan.key for rival in rivals for plan in rival.plans]
    return sha256("".join(keys).encode()).hexdigest()[:16]


def odds_of(
    simulated: Simulations,
    rig: Rig,
    seen: Sequence[Observation],
    path: Path | None = None,
    progress: Progress = silent,
    simulations: int = SIMULATIONS,
) -> Odds:
    """Return the odds of mechanisms, given the observations; results are stored beside a path.

    `simulations` is the number of those of each mechanism, with cycles or without.
    """
    claimed = simulated.among(CLAIMED)
    observed = np.concatenate([each.features for each in seen])
    bend = np.concatenate([bend_features(each.conditions, rig.slider) for each in seen])
    learned, references = _learn(claimed, bend, path, part(progress, 0, 3, of=2))
    record = learned.standard.scores(observed)
    probabilities = learned.probabilities(observed)[0]
    name = claimed.names[int(np.argmax(probabilities))]
    beside_static, absent = 1.0, claimed.absent
    if name in ELASTIC:
        absent = simulated.absent  # static friction on the misaligned rig among them
        static = StaticCheck.of(simulated, beside(path, "check"), part(progress, 2, 3))
        beside_static = float(static.probability(name, observed[None])[0])
    rest = None
    if name == ROTATION:
        place = claimed.names.index(name)
        rows = references[place].typicality.alike(record, ALIKE_SIMULATIONS)
        rest = _rest_of(rig, seen, claimed.parameters[place][rows])
    return Odds(
        names=claimed.names,
        probabilities=probabilities,
        by_halves=learned.probabilities_by_halves(observed)[:, 0],
        confusion=confusion(learned.whole.left_out, learned.left_out_by_halves, claimed.labels),
        likeness=tuple(each.likeness(record, observed[bend]) for each in references),
        bend=observed[bend],
        steady=steadiness(trend_of(seen)),
        counts=tuple(np.bincount(claimed.labels).tolist()),
        simulations=simulations,
        absent=absent,
        channels=tuple({name: None for each in seen for name in each.conditions.noise}),
        explanation=explain_unlike([each.changes for each in seen]),
        disputed=" ".join(each.disputed for each in seen if each.disputed),
        beside_static=beside_static,
        rest=rest,
    )


def _learn(
    claimed: Simulations, bend: NDArray[np.bool_], path: Path | None, progress: Progress
) -> tuple[Classifier, tuple[Reference, ...]]:
    """Return the classifier of mechanisms, and the reference of each for the record's likeness."""
    learned = classifier.learn_or_read(claimed, beside(path, "classifier"), part(progress, 0, 2))
    references = likeness.learn_or_read(
        claimed,
        learned.whole.scores,
        claimed.features[:, bend],
        beside(path, "likeness"),
        part(progress, 1, 2),
    )
    return learned, references


def _rest_of(rig: Rig, seen: Sequence[Observation], parameters: Floats) -> Rest:
    """Return the rest of the mass in simulations with these parameters, under the conditions."""
    plan = plan_for(rig, [each.conditions for each in seen])
    return Rest.among(shares_at_rest(plan, parameters))


def beside(path: Path | None, name: str) -> Path | None:
    """Return the file of this name beside a path; None without a path."""
    return None if path is None else path.with_name(f"{path.name}-{name}.npz")


def confusion(probabilities: Floats, by_halves: Floats, labels: NDArray[np.int64]) -> Floats:
    """Return, for each label (row), the shares of its records by claimed label; last: no claim.

    >>> whole = np.array([[0.95, 0.05], [0.6, 0.4], [0.02, 0.98]])
    >>> confusion(whole, whole[None], np.array([0, 0, 1]))
    array([[0.5, 0. , 0.5],
           [0. , 1. , 0. ]])
    """
    count = probabilities.shape[1]
    claimed = surely(probabilities, by_halves)
    called = np.where(claimed, probabilities.argmax(axis=1), count)
    found = np.zeros((count, count + 1))
    np.add.at(found, (labels, called), 1.0)
    return np.asarray(found / found.sum(axis=1, keepdims=True))
