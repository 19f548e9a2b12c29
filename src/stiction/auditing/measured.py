"""A measured record beside simulations of its rig: verdict, grounds, and tests to change it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np

from stiction.analysis.measurement.run_record import apparatus
from stiction.analysis.record import Record
from stiction.analysis.report import analyse
from stiction.analysis.signals.correlated_noise import BOUNDS_95, interval_95
from stiction.arrays import Floats
from stiction.auditing.words.verdict import RECORD
from stiction.errors import ResultError
from stiction.inference.features import USED
from stiction.inference.fit import check, fit_observed
from stiction.inference.measured.observed_rig import observe_with_one
from stiction.inference.mechanism.comparison import odds_or_reason
from stiction.inference.mechanism.likeness import BENT
from stiction.inference.mechanism.odds import TURNING, UNDECIDED, Odds, near_one
from stiction.inference.mechanism.rivals import MISALIGNED_STATIC, ROTATION
from stiction.inference.observation import Conditions, Observation
from stiction.inference.posterior import RARE, Estimate, Fit, at_most, middle
from stiction.inference.predictive import Predictive, predict
from stiction.inference.rig import Rig
from stiction.inference.simulated import SIMULATIONS
from stiction.inference.simulated.library import library_folder
from stiction.inference.simulated.synthetic import NOT_OF_THE_SLIDER
from stiction.progress.report import part, silent
from stiction.system.load_cell import stiffness_of_cell
from stiction.system.parameter import change_unchecked
from stiction.system.slider import Slider
from stiction.text.quantity.wording import in_words, interval, percent
from stiction.text.sections import Section

DESCRIBED = (
    "The sections after the fit are of the apparatus as it is described, with uncertain values in "
    "the middle of their priors"
)
REPEAT = ": write the fitted values into the description, and audit again"
BOTH_HOLD = (
    "That the rig explains the record, and that rotation is not claimed, both hold, as the loading "
    "curve is compared with two sets of simulations: those with the "
    "fitted values have one like it, which is enough for an explanation; of those with "
    "the parameters that its features suggest few have, and a claim of rotation needs both."
)
WITHDRAWN = (
    "The fit assumes that the friction force turns, and is not like this record: so neither "
    f"{ROTATION} nor {MISALIGNED_STATIC} is claimed."
)
ROTATES = ": what looks like static friction is the apparatus, whose friction vector rotates"
HELD = (
    ": the friction at rest of its law holds the mass between slips, while the force on it turns "
    "as it grows"
)
# relative: a value that priors change by more is not sure; by more of the stiffness along a cell's
# axis, the spring across loads it
SURE_OF, BY_ACROSS = 0.02, 0.1
APART = 0.03  # relative: so far from the median simulation, and beyond all, a value is worth a word
WARNINGS, GROUNDS = "Warnings about the record", "What that rests on"
CHANGES = "What would change it"
NAMES = {"force_across": "force across the drive", "position": "displacement of the mass"}


@dataclass(frozen=True)
class RecordComparison:
    """A record beside simulations of its rig.

    Parameters
    ----------
    record : Record
        As measured.
    seen : Observation or None
        What a fit takes from it; None where it cannot be fitted.
    fit : Fit or None
        Posterior beside prior.
    predictive : Predictive or None
        Simulations with parameters of the posterior; None if hardly any has cycles.
    reason : str
        Why there is no fit.
    odds : Odds or None
        Of mechanisms.
    incomparable : str
        Why there are no odds.
    stated : Record or None
        The record with what the description states of its apparatus.
    """

    record: Record
    seen: Observation | None = None
    fit: Fit | None = None
    predictive: Predictive | None = None
    reason: str = ""
    odds: Odds | None = None
    incomparable: str = ""
    stated: Record | None = None

    @property
    def like(self) -> bool:
        """Whether the record looks like the simulations by features, loading curve and priors."""
        if self.fit is None or self.predictive is None:
            return False
        usual = self.fit.farther >= RARE and self.predictive.larger >= RARE
        return usual and not self.fit.beyond and not self.fit.disputed

    @cached_property
    def warnings(self) -> tuple[str, ...]:
        """The analysis's warnings on the record beside its description; a fit ignores them."""
        return analyse(self.stated or self.record).warnings

    @property
    def absent(self) -> list[str]:
        """The channels that a fit would use and the record lacks."""
        return [name for name in USED if getattr(self.record, name) is None]


def explain_record(
    record: Record,
    rig: Rig,
    *,
    simulations: int = SIMULATIONS,
    library: str | Path | None = None,
    seed: int = 0,
    progress: Callable[[float], None] | None = None,
) -> RecordComparison:
    """Fit a rig to a record, and simulate the record again with the fitted parameters.

    Raises
    ------
    DescriptionError
        If nothing of the rig is uncertain, or it is not of a kind that can be fitted.
    """
    check(rig, simulations)
    place = library_folder(library)  # refused at once, and not as a reason for no verdict
    report, stated = progress or silent, with_description(record, rig)
    try:
        its = observe_with_one(record, rig)
        found = fit_observed(its, simulations, place, seed, part(report, 0, 20, of=10))
    except ResultError as error:
        return RecordComparison(record, reason=str(error), stated=stated)
    (seen,) = its.seen
    made = predict(found, seen, part(report, 10, 20))
    beside = RecordComparison(record, seen, found, made, stated=stated)
    odds = odds_or_reason(its, simulations, place, seed, part(report, 11, 20, of=9))
    if isinstance(odds, str):
        return replace(beside, incomparable=odds)
    return withdraw(replace(beside, odds=odds))


def with_description(record: Record, rig: Rig) -> Record:
    """Return a record completed by the certain values of its description.

    Its force may contradict that: a stiffness, a mass, a load or a unit that is wrong. Of a cell at
    an angle the stiffness is not stated where the spring across loads it as well: that does so
    until the mass follows the drive across, and no longer.
    """
    slider = turn(rig.slider, record)
    known, alone = apparatus(slider), stiffness_of_cell(slider, 0.0)
    sure = {"stiffness": _is_same(known["stiffness"], alone, BY_ACROSS)}
    for one in _at_ends(rig):
        for name, value in apparatus(turn(one, record)).items():
            sure[name] = sure.get(name, True) and _is_same(value, known[name], SURE_OF)
    stated = {
        name: value
        for name, value in known.items()
        if getattr(record, name) is None and sure.get(name, True)
    }
    return record.model_copy(update=stated)


def turn(slider: Slider, record: Record) -> Slider:
    """Return the slider at the misalignment of a record, whose rig may have been turned."""
    return slider.model_copy(update={"phi": slider.phi + (record.turned or 0.0)})


def _at_ends(rig: Rig) -> Iterator[Slider]:
    """Yield the slider with each uncertain value at either end of its prior."""
    for path, prior in rig.priors.items():
        if path not in NOT_OF_THE_SLIDER:
            for value in prior.quantile(np.array(BOUNDS_95)).tolist():
                yield change_unchecked(rig.slider, path, value)


def _is_same(value: float | None, other: float | None, apart: float) -> bool:
    """Return whether two values are known, and differ by at most the share `apart`."""
    if value is None or other is None:
        return False
    return abs(value - other) <= apart * abs(other)


def withdraw(found: RecordComparison) -> RecordComparison:
    """Withdraw a claim of rotation if the rig as described does not explain the record.

    Claim and explanation compare the record with simulations of rotating friction, by measures and
    limits of their own.
    """
    if found.like or found.odds is None or found.odds.decision not in TURNING:
        return found
    return replace(found, odds=replace(found.odds, doubt=WITHDRAWN))


def sections(found: RecordComparison) -> list[Section]:
    """Return the sections of a report."""
    doubts = [Section(WARNINGS, [*found.warnings])] if found.warnings else []
    if found.fit is None:
        return [Section(RECORD, [f"No verdict: {found.reason}."]), *doubts]
    parts = [
        Section(RECORD, [verdict(found), f"{DESCRIBED}{REPEAT * rotates(found)}."]),
        *doubts,
        Section(GROUNDS, grounds(found, found.fit)),
        Section(CHANGES, changes(found, found.fit)),
    ]
    fitted = found.fit.tables() if rotates(found) else [found.fit.without_values()]
    if fitted[0].title == "In short":
        fitted[0] = fitted[0]._replace(title="Fit in short")  # an audit has its own verdict
    parts += [*(found.odds.tables() if found.odds else ()), *fitted]
    shared = found.fit.explanation, found.fit.narrow_priors, found.fit.disputed
    return say_once(parts, [words.strip() for words in shared if words])


def say_once(parts: Sequence[Section], shared: Sequence[str]) -> list[Section]:
    """Return sections in which a shared sentence remains only at its first place.

    >>> parts = [Section("A", ["No. A pause."]), Section("B", ["Why? A pause."])]
    >>> [part.sentences for part in say_once(parts, ["A pause."])]
    [['No. A pause.'], ['Why?']]
    """
    told, found = set[str](), []
    for section in parts:
        sentences = []
        for sentence in section.sentences:
            again = [words for words in shared if words in sentence and words in told]
            told |= {words for words in shared if words in sentence}
            for words in again:
                sentence = " ".join(sentence.replace(words, "").split())
            sentences += [sentence] * bool(sentence)
        found.append(section._replace(sentences=sentences))
    return found


def rotates(found: RecordComparison) -> bool:
    """Return whether the values of the fit, which assumes a rotating friction vector, are valid."""
    return found.like and (found.odds is None or found.odds.decision in (*TURNING, UNDECIDED))


def verdict(found: RecordComparison) -> str:
    """Return the verdict in one sentence."""
    if found.fit is not None and found.fit.disputed:
        return f"No verdict. {found.fit.disputed}"
    claimed = "" if found.odds is None else found.odds.decision
    if found.odds is not None and claimed not in (*TURNING, UNDECIDED):
        probability = near_one(found.odds.probabilities.max())
        return (
            f"Friction, not misalignment: this record is like simulations of {claimed} "
            f"(probability {probability} among the mechanisms compared), not of a friction vector "
            "that rotates on the rig as described: a stated stiffness k_y, mass or load that is "
            "wrong speaks against rotation too. The fit, which assumes that it rotates, means "
            "nothing."
        )
    if not found.like:
        why = "" if found.fit is None else found.fit.explanation
        return (
            "No verdict: this record is not like those of the rig as described, whatever the "
            "uncertain values are within their priors; the fitted values mean nothing until "
            f"that is explained. {why}".rstrip()
        )
    return f"{explanation(found)}; {alternatives(found.odds)}."


def explanation(found: RecordComparison) -> str:
    """Return the rig's explanation of the record, as a clause."""
    phi = angle(found)
    if phi is None:
        return (
            "The rig as described explains this record without any coefficient of static friction "
            "beyond its law; its misalignment is not fitted"
        )
    if not phi.identified and found.fit is not None and "phi" in found.fit.at_an_end:
        return (
            "The rig as described explains this record, but the record points to the end of the "
            f"prior of its misalignment, {describe(phi)}: widen the prior"
        )
    if not phi.identified:
        return (
            "The rig as described explains this record, but the record does not say how far it is "
            "misaligned"
        )
    return (
        f"The rig explains this record by itself: with a misalignment of {describe(phi)}, and the "
        "friction law of its description, simulated records look like it"
    )


def alternatives(odds: Odds | None) -> str:
    """Return the result of the comparison with other mechanisms, as a clause."""
    if odds is not None and odds.decision in TURNING:
        others = (its for name, its in zip(odds.names, odds.likeness, strict=True)
                  if name != ROTATION)  # fmt: skip
        excluded = all(its.unlike for its in others)
        probability = near_one(odds.probabilities.max())
        return (
            "the other mechanisms compared do not explain it"
            if excluded
            else f"of the mechanisms compared this is the most probable ({probability})"
        ) + (HELD if odds.decision == MISALIGNED_STATIC else ROTATES)
    if odds is not None and odds.decision == UNDECIDED:
        return "that it is another mechanism is not excluded"
    return "no static friction beyond that law is needed, and none is excluded"


def angle(found: RecordComparison) -> Estimate | None:
    """Return the estimate of the misalignment; None if it was not fitted."""
    known = [] if found.fit is None else [x for x in found.fit.estimates if x.name == "phi"]
    return known[0] if known else None


def describe(x: Estimate) -> str:
    """Return an estimate with its interval."""
    return f"{middle(x)} (95 %: {interval(x.low, x.high, x.median, x.unit)})"


def grounds(found: RecordComparison, fit: Fit) -> list[str]:
    """Return the grounds of the verdict."""
    conditions = fit.plan.conditions[0]
    channels = " and ".join(NAMES.get(name, name) for name in conditions.noise)
    lines = [
        f"The first {conditions.cycles} cycles of {in_words(_length(found, conditions), 's')}, "
        f"with {channels}, beside {fit.simulations} simulated records. Their number is rounded "
        "down, so that the same simulations serve records of other lengths.",
        curve(found.predictive),
        f"{percent(fit.farther)} of the simulated records are less like the others than the "
        f"measured one, by their features; below {percent(RARE)} it is unlike them.",
    ]
    if found.odds is not None:
        lines.append("The odds of mechanisms, which have a section of their own.")
        if found.like and is_unusual_rotation(found.odds):
            lines.append(BOTH_HOLD)
    return lines


def contradictions(found: Predictive | None) -> Iterator[str]:
    """Yield the contradictions in the rate of loading and in the duration of slips, if any.

    The simulations have the fitted values, which come as near to the record as the priors allow:
    of a stiffness or mass that is stated as certain and is wrong, they hide a part, at least so
    much of the factor shows.
    """
    if found is None:
        return
    farther = "times as stated, or farther off: the other fitted values hide a part of it"
    rate = _beyond(float(found.measured.rate), found.simulated.rate)
    if rate is not None:
        yield (
            f"No simulation with the fitted values rises as {'fast' if rate > 1.0 else 'slowly'} "
            "as the record: stiffness times drive velocity, or the gain of the load cell, may be "
            f"{rate:.2g} {farther}. So may it seem where friction creeps as no simulation does."
        )
    lasts = _beyond(found.slip, found.slips)
    if lasts is not None:
        other = " So may it seem behind a filter that no sensor states." if lasts > 1.0 else ""
        both = " That stiffness changes it too." if rate is not None else ""
        yield (
            f"The slips last {lasts:.2g} times as long as the simulated ones: mass over stiffness "
            f"may be {lasts * lasts:.2g} {farther}.{both}{other}"
        )


def _beyond(value: float, simulated: Floats) -> float | None:
    """Return a value over the median of simulated ones, if it lies well outside their range."""
    ratio = value / float(np.median(simulated))
    inside = simulated.min() <= value <= simulated.max()
    return None if inside or abs(ratio - 1.0) < APART else ratio


def _length(found: RecordComparison, conditions: Conditions) -> float:
    """Return the mean length of a record's cycles, s; the simulated length is rounded."""
    if found.seen is None:
        return conditions.cycle
    its = found.seen.cycles
    return float(np.mean(its.after - its.before)) * conditions.step


def is_unusual_rotation(odds: Odds) -> bool:
    """Return whether rotation is likeliest, but its loading curves rarely resemble the record's.

    An explanation and a claim compare that curve with different simulations (`BOTH_HOLD`).
    """
    its = odds.likeness[odds.likeliest]
    return odds.names[odds.likeliest] == ROTATION and its.larger < BENT


def curve(found: Predictive | None) -> str:
    """Return the agreement of the loading curve with simulations."""
    if found is None:
        return "With the fitted values hardly any simulated record has cycles of stick and slip."
    low, high = (in_words(x, "N/s") for x in interval_95(found.simulated.rate))
    force, bend = (
        ((values >= low) & (values <= high)).mean()
        for values, (low, high) in zip(
            (found.measured.force, found.measured.bend), found.bands, strict=True
        )
    )
    least = 1.0 / (1.0 + len(found.simulated.force))
    return (
        f"The measured loading curve lies within the 95 % band of simulated ones over "
        f"{percent(force)} of its length, and its departure from a straight line over "
        f"{percent(bend)}. It rises by {in_words(float(found.measured.rate), 'N/s')} on average, "
        f"95 % of the simulated ones by {low} to {high}. "
        f"{at_most(found.larger, least).capitalize()} of the simulations depart as far from their "
        f"mean, and below {percent(RARE)} it is unlike them."
    )


def changes(found: RecordComparison, fit: Fit) -> list[str]:
    """Return the further tests or statements that could change the verdict."""
    lines = []
    if not found.like:
        lines.append(
            "Look at filters and drifts of the zero that no sensor states; at the zero of the "
            "force, and the stated stiffness, mass, load and velocity (stiction analyse); at the "
            f"law of friction; and whether the priors are too narrow. {fit.narrow_priors}".rstrip()
        )
        if not fit.explanation:  # else the means of cycles that differ would be those of none
            lines += contradictions(found.predictive)
    if found.absent:
        listed = " and ".join(NAMES.get(name, name) for name in found.absent)
        lines.append(f"Measuring the {listed} too would tell more of the misalignment.")
    if fit.unidentified and rotates(found):
        lines.append(
            f"Not identifiable from this record: {', '.join(fit.unidentified)}. The verdict is "
            "wrong if one of their priors is."
        )
    if found.odds is None:
        lines.append(f"Other mechanisms were not compared: {found.incomparable}.")
    turned = "A record of the same rig, turned by a known angle, would test the verdict: "
    if rotates(found):
        lines.append(
            f"{turned}the fitted misalignment must turn with it. `stiction design` says which "
            "test narrows its interval most."
        )
    elif found.odds is not None and found.odds.decision != UNDECIDED:
        lines.append(f"{turned}where the friction vector rotates, its loading curve differs.")
    return lines
