"""st.design(rig): find the further test that narrows a parameter of a rig most."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from stiction.arguments import end_reading, read_together
from stiction.arrays import Floats
from stiction.errors import Faults, Instruction, ResultError
from stiction.inference.columns import features_from
from stiction.inference.fit import FEWEST_SIMULATIONS, plan_for, refuse_few_simulations
from stiction.inference.learning import calibration
from stiction.inference.measured.drive_of_records import with_measured_drive
from stiction.inference.next_test.advice import Advice
from stiction.inference.next_test.expected import (
    FEWEST_RIGS,
    GROUPS,
    Expected,
    estimates,
    expectation,
    left_out_errors,
    ratio_of,
    read,
    write,
)
from stiction.inference.next_test.further import (
    AGAIN,
    ANGLES,
    CYCLES,
    NOISE,
    SIMULATIONS,
    Further,
    Wanted,
    further_tests,
    usual_conditions,
    with_cycle,
    with_noise,
)
from stiction.inference.next_test.question import Question, ask, refuse_certain
from stiction.inference.observation import (
    PER_CYCLE,
    Conditions,
    Observation,
    Source,
    observe,
    record_from,
)
from stiction.inference.posterior import RARE, unlike
from stiction.inference.rig import Rig, refuse_swapped
from stiction.inference.simulated.library import (
    FIRST_SIMULATIONS,
    Ensemble,
    have_cycles,
    library_folder,
    will_be_too_few,
)
from stiction.inference.simulated.plan import Plan
from stiction.inference.suitability import explain_unlike
from stiction.progress.audience import with_progress
from stiction.progress.report import Progress, part, silent
from stiction.system.slider import Slider
from stiction.text.quantity.wording import in_words, percent
from stiction.text.units import Quantity

DRAWN = "rigs drawn from the priors"
NOT_COMPARED = "Whether the record is like those of the rig as described is not known: "
OTHER_NOISE = "the simulated tests have another noise, as given; leave it out to compare them."


@read_together
@with_progress("simulating and learning")
def design(
    rig: Rig | str | Path,
    record: Source | None = None,
    *,
    of: str = "phi",
    channels: Sequence[str] = ("force",),
    angles: Sequence[Quantity] = ANGLES,
    velocities: Sequence[Quantity] | None = None,
    loads: Sequence[Quantity] | None = None,
    noise: Quantity | None = None,
    position_noise: Quantity | None = None,
    simulations: int = SIMULATIONS,
    library: str | Path | None = None,
    seed: int = 0,
    progress: Callable[[float], None] | None = None,
) -> Advice:
    """Find which further test is expected to tell most about a parameter of a rig.

    Rigs are drawn from the priors, and each is tested in every way: as it is tested now, and with
    what may be added, a channel or a further record under other conditions. From each test a
    regression learns what `stiction.fit` could. How far it is off for rigs that it has not seen is
    what the test leaves open.

    Parameters
    ----------
    rig : Rig, str or Path
        The description with its priors; see `stiction.inference.priors`.
    record : Record, Trajectory, str or Path, optional
        Of the present test: its channels, cycles, velocity, load and noise are taken.
    of : str, optional
        The parameter of interest, by its path: ``"phi"``, ``"friction.mu_0"``. Or ``"jitter"``,
        the relative spread of friction from cycle to cycle, which every fit estimates.
    channels : sequence of str, optional
        What is measured at present, without a record: ``"force"``, and perhaps ``"force_across"``
        and ``"position"``.
    angles : sequence of str, optional
        Angles by which the rig may be turned on purpose, known exactly.
    velocities : sequence of float or str, optional
        Drive velocities to try, m/s; by default a third and three times the present one.
    loads : sequence of float or str, optional
        Normal loads to try, N; by default half and twice the present one.
    noise, position_noise : float or str, optional
        Standard deviation of a sample of the forces (N) and of the displacement (m). By default
        that of the record, else 0.2 % of the friction force at rest, and this over ``k_x``.
    simulations : int, optional
        Rigs that are drawn; more teach more, and sharpen the intervals.
    library : str or Path, optional
        A folder in which simulations are kept, so that an interrupted design continues.
    seed : int, optional
        Of the simulations.
    progress : callable, optional
        Called with the fraction done; without it, a terminal or a notebook shows a bar or lines.

    Returns
    -------
    Advice
        What each test leaves open of each parameter.

    Raises
    ------
    DescriptionError
        If nothing is uncertain, or the rig is not of a kind that can be fitted.
    ResultError
        If the record cannot be used, or too few of the simulated rigs stick and slip.
    """
    refuse_swapped(rig, record, "the rig comes first: st.design(rig, record)")
    faults, place = Faults(), None
    with faults.of_part():
        place = library_folder(library)
    read_record = None if record is None else partial(record_from, record)
    question = ask(
        rig, read_record, of, faults, channels=channels, angles=angles, velocities=velocities,
        loads=loads, noise=noise, position_noise=position_noise, simulations=simulations,
    )  # fmt: skip
    end_reading()
    return answer(question, place, seed, progress)


def answer(
    question: Question, place: Path | None, seed: int, progress: Callable[[float], None] | None
) -> Advice:
    """Simulate the tests, in the library `place` if there is one, and learn from each."""
    known, name, wanted, given = question
    if given is not None:
        known = with_measured_drive(known, [given]).rig
    slider, seen = known.slider, None if given is None else observe(given, known.slider)
    now = usual_conditions(slider) if seen is None else seen.conditions
    measured = wanted.channels if seen is None else tuple(now.noise)
    averaged = 1 if seen is None else seen.averaged
    present = with_noise(now, slider, wanted, averaged)
    if seen is None:
        present = must_slip(with_cycle(present, slider))
    tests, skipped = split(further_tests(present, measured, wanted), slider)
    records = [test.record for test in tests if test.record is not None]
    signed = "force_across" in measured or present.yaw != 0.0
    trial = plan_for(known, [present, *records], signed)
    refuse_certain(name, trial)
    whole = progress or silent
    simulating, learning = part(whole, 0, 10, of=6), part(whole, 6, 10, of=4)
    count = wanted.simulations
    begun = Ensemble.within(place, trial, seed)
    begun = begun.simulate(FIRST_SIMULATIONS, part(simulating, 0, 20))
    _, features = begun.rows(FIRST_SIMULATIONS)
    cycles, recorded = int(show_cycles(trial, measured, features).sum()), seen is not None
    if will_be_too_few(cycles, FIRST_SIMULATIONS, count, FEWEST_RIGS):
        refuse_few_simulations(DRAWN, cycles, FIRST_SIMULATIONS, FEWEST_RIGS, recorded)
    begun = begun.simulate(count, part(simulating, 1, 20, of=19))
    scores, features = begun.rows(count)
    cycles = int(show_cycles(trial, measured, features).sum())
    refuse_few_simulations(DRAWN, cycles, count, FEWEST_RIGS, recorded)
    file = f"tests-{count}-{'-'.join(measured)}.npz"
    path = None if begun.folder is None else begun.folder / file
    every = [Further("the present test", measured), *tests]
    found = learn_or_read(trial, every, scores, features, path, learning)
    doubt = ""
    if seen is not None:
        doubt = seen.disputed or doubts(trial, seen, scores, features, wanted, path)
    whole(1.0)
    assumed = assumptions(() if seen is None else measured, present, wanted, averaged)
    usable = int(have_cycles(features[:, : features.shape[1] // len(trial.conditions)]).sum())
    rare = tuple(each.test for each in found if round(each.usable * usable) < FEWEST_RIGS)
    common = tuple(each for each in found if each.test not in rare)
    return Advice(trial, name, common, (*skipped,), (*assumed,), usable, rare, doubt)


def show_cycles(trial: Plan, channels: Sequence[str], features: Floats) -> NDArray[np.bool_]:
    """Return which rigs with these features (n, f) show cycles in the present test."""
    return have_cycles(features_of(trial, channels, features))


def features_of(trial: Plan, channels: Sequence[str], features: Floats, number: int = 0) -> Floats:
    """Return those of some channels in one of the records, at first that of the present test."""
    width = features.shape[1] // len(trial.conditions)
    columns = features_from(tuple(channels), trial.conditions[0], trial.slider)
    return features[:, number * width : (number + 1) * width][:, columns]


def must_slip(present: Conditions | None) -> Conditions:
    """Refuse a rig without stick-slip."""
    if present is None:
        raise ResultError(
            "in the middle of its priors this rig does not stick and slip; a design needs cycles. "
            f"Drive it more slowly, or see `{Instruction('stiction audit', 'st.audit')}`"
        )
    return present


def split(tests: Iterator[Further], slider: Slider) -> tuple[list[Further], list[str]]:
    """Return the tests, their cycles' length known, and the names of those without stick-slip."""
    possible, skipped = [], []
    for test in tests:
        if test.record is None or test.name == AGAIN:  # whose cycles are known
            possible.append(test)
        elif (its := with_cycle(test.record, slider)) is None:
            skipped.append(test.name)
        else:
            possible.append(test._replace(record=its))
    return possible, skipped


def learn_or_read(
    trial: Plan, tests: Sequence[Further], scores: Floats, features: Floats, path: Path | None,
    progress: Progress,
) -> list[Expected]:  # fmt: skip
    """Learn the remaining error after each test, or read it from a file."""
    found = read(path, [test.name for test in tests])
    if found is None:
        found = [*expectations(trial, tests, scores, features, progress)]
        write(path, found)
    return found


def expectations(
    trial: Plan, tests: Sequence[Further], scores: Floats, features: Floats, progress: Progress
) -> Iterator[Expected]:
    """Yield the remaining error after each test, the present one first."""
    complete = show_cycles(trial, tests[0].channels, features)
    truth, rows = scores[complete], features[complete]
    groups = [
        [
            ratio_of(trial, truth[some], errors)
            for errors in errors_of(trial, tests, truth[some], rows[some], FEWEST_RIGS // GROUPS)
        ]
        for some in np.array_split(np.arange(len(truth)), GROUPS)
    ]
    each = errors_of(trial, tests, truth, rows, FEWEST_RIGS)
    for done, (test, errors) in enumerate(zip(tests, each, strict=True), 1):
        progress(done / len(tests))
        added = len(test.channels) - len(tests[0].channels) + (test.record is not None)
        by_group = np.array([its[done - 1] for its in groups])
        yield expectation(trial, test.name, truth, errors, added=added, by_group=by_group)


def errors_of(
    trial: Plan, tests: Sequence[Further], truth: Floats, rows: Floats, fewest: int
) -> Iterator[list[Floats]]:
    """Yield leave-one-out errors (n, p): of the present test, of parts of each test, of the test.

    The rigs have parameters `truth` (n, p) and features `rows` (n, f). An error is NaN if it would
    be learned from fewer rigs than `fewest`.
    """
    present = tests[0].channels
    known: dict[tuple[str, ...], Floats] = {}  # what the first record says, by its channels
    further = iter(range(1, len(trial.conditions)))
    for test in tests:
        if test.channels not in known:
            known[test.channels] = estimates(features_of(trial, test.channels, rows), truth, fewest)
        records = [known[test.channels]]
        if test.record is not None:
            own = features_of(trial, test.channels, rows, next(further))
            records.append(estimates(own, truth, fewest))
        less = [its for its in known if {*present} < {*its} < {*test.channels}]
        parts = [truth - known[each] for each in (present, *less)]
        yield [*parts, left_out_errors(records, truth, fewest)]


def doubts(
    trial: Plan,
    seen: Observation,
    scores: Floats,
    features: Floats,
    wanted: Wanted,
    path: Path | None,
) -> str:
    """Return the doubt that the record is unlike simulations of the present test, or ''.

    `scores` (n, p) and `features` (n, f) are those of all simulations; what is learned is kept
    beside `path`.
    """
    if any(wanted.noises[name] is not None for name in seen.conditions.noise):
        return NOT_COMPARED + OTHER_NOISE
    rows = features_of(trial, tuple(seen.conditions.noise), features)
    usable = have_cycles(rows)
    if (count := usable.sum()) < FEWEST_SIMULATIONS:
        few = f"{count} of the simulated rigs have cycles now, {FEWEST_SIMULATIONS} are needed"
        return f"{NOT_COMPARED}{few}; simulate more."
    beside = None if path is None else path.with_name(f"{path.stem}-record.npz")
    learned = calibration.learn_or_read(rows[usable], scores[usable], beside)
    farther = learned.farther(seen.features)
    return unlike(farther, explain_unlike([seen.changes])) if farther < RARE else ""


def assumptions(
    recorded: Sequence[str], present: Conditions, wanted: Wanted, averaged: int = 1
) -> list[str]:
    """Return, as sentences, the values that neither the record nor the user states.

    The noise is that of means of `averaged` samples.
    """
    noise = present.noise
    means = f" of means of {averaged} samples" if averaged > 1 else ""
    found = []
    if not recorded:
        found.append(f"Assumed: {CYCLES} cycles in each record, {PER_CYCLE} samples in each cycle.")
    if wanted.noise is None and not recorded:
        level = in_words(noise["force"].error, "N", 2)
        found.append(
            f"Assumed: a noise of {level} in each force, {percent(NOISE)} of that of friction."
        )
    if wanted.noise is None and recorded and "force_across" not in recorded:
        level = in_words(noise["force_across"].error, "N", 2)
        found.append(f"Assumed: a noise of {level}{means} in the force across, as in the other.")
    if wanted.position_noise is None and "position" not in recorded:
        level = in_words(noise["position"].error, "m", 2)
        found.append(f"Assumed: a noise of {level}{means} in the displacement.")
    for name in ("force", "position"):
        if wanted.noises[name] is not None and name in recorded and noise[name].lasting:
            level = in_words(noise[name].lasting, "N" if name == "force" else "m", 2)
            lasts = in_words(noise[name].lasts, "s", 2)
            found.append(
                f"Beside the given noise of the {name}, that of the record which lasts {lasts} is "
                f"kept, {level}."
            )
    return found
