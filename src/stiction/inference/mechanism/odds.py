"""The odds of mechanisms, given records, and whether they allow a claim."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from math import ceil
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stiction.arrays import Floats, same_fields, xr
from stiction.errors import Instruction
from stiction.inference.features import MIDDLES
from stiction.inference.mechanism.likeness import BENT, CURVES, UNLIKE, Likeness
from stiction.inference.mechanism.rest import ALIKE_SIMULATIONS, Rest
from stiction.inference.mechanism.rivals import (
    LUGRE,
    MISALIGNED_STATIC,
    RATE_AND_STATE,
    ROTATION,
    STATIC,
)
from stiction.inference.observation import TREND
from stiction.inference.posterior import RARE, STATE_DRIFT, at_most, friction_drifts
from stiction.inference.simulated.library import SAFE
from stiction.inference.simulated.synthetic import LONGEST_CYCLE
from stiction.names import draw
from stiction.text.quantity.wording import percent
from stiction.text.sections import Report, Section, Table

SIMULATIONS = 1000  # of each mechanism, by default: about as many as its accuracies hold for
SHARE = 4  # simulations of a fit for each that a mechanism gets beside it
CLAIM = 0.9  # probability from which on a mechanism is claimed
BY_HALF = 0.6  # by each half of the simulations: a claim is not a matter of their draw
UNDECIDED = "undecided"
EXPLAINED = (
    "All mechanisms are taken to be equally probable beforehand, and one of them to be true; the "
    "share of one that the record is unlike means nothing. Farther: the share of the mechanism's "
    "simulated records whose features are less like those of the others than this "
    "record's are. More bent: of its simulated records with this record's parameters, the share "
    "whose loading departs more from their mean. Experimental: a law that was not simulated may "
    "pass for one that was."
)
TURNING = ROTATION, MISALIGNED_STATIC  # the friction force turns, the mass creeping or at rest
CHANNEL = "force_across"  # without which the shape of the friction limit is not seen


@dataclass(frozen=True, eq=False, repr=False)
class Odds(Report):
    """The odds of mechanisms, and the evidence for them.

    Parameters
    ----------
    names : tuple of str
        Of the k mechanisms.
    probabilities : ndarray
        (k,), given the records, all equally probable before.
    by_halves : ndarray
        (2, k), the same as learned from each half of the simulations.
    confusion : ndarray
        (k, k + 1), how often simulated records of each mechanism (rows) are called each, and, in
        the last column, undecided.
    likeness : tuple of Likeness
        To simulations of each mechanism.
    bend : ndarray
        (s,), departure of the records' loading from a straight line over its rise, in each part.
    steady : float
        p-value of a trend of the cycles, in all records together.
    counts : tuple of int
        Number of simulations of each mechanism that have cycles.
    absent : tuple of str
        Mechanisms that are not compared: hardly any record simulated by them has cycles of stick
        and slip, or none that are not far longer than the measured ones. Static friction on the
        misaligned rig is one of them if the likeliest one is compared with it.
    channels : tuple of str
        What was measured.
    explanation : str
        What may explain that the records are unlike simulations, as sentences; may be empty.
    disputed : str
        In which records an analysis counts other cycles, as sentences; may be empty.
    doubt : str
        What else speaks against a claim, found by other means, as a sentence; may be empty.
    beside_static : float
        Probability of the likeliest mechanism, if it is rate and state or LuGre, as told from
        static friction on the misaligned rig; else 1.
    rest : Rest or None
        How far the mass rests in simulations of rotation with the record's parameters, if that is
        the likeliest mechanism.
    simulations : int
        Number of simulations of each mechanism, with cycles or without.
    """

    names: tuple[str, ...]
    probabilities: Floats
    by_halves: Floats = field(compare=False)
    confusion: Floats = field(compare=False)
    likeness: tuple[Likeness, ...] = field(compare=False)
    bend: Floats = field(compare=False)
    steady: float
    counts: tuple[int, ...]
    absent: tuple[str, ...]
    channels: tuple[str, ...]
    explanation: str = field(default="", compare=False)
    disputed: str = field(default="", compare=False)
    doubt: str = field(default="", compare=False)
    beside_static: float = 1.0
    rest: Rest | None = field(default=None, compare=False)
    simulations: int = SIMULATIONS

    @property
    def needed(self) -> float:
        """The probability that a claim needs."""
        return CLAIM

    @property
    def shares(self) -> Floats:
        """The middle of each part of a loading, as a share of its time."""
        return MIDDLES

    @property
    def likeliest(self) -> int:
        """The place of the most probable mechanism."""
        return int(np.argmax(self.probabilities))

    @property
    def decision(self) -> str:
        """The mechanism that is claimed, or "undecided".

        Where rotation is claimed and its mass rests, it is static friction on the misaligned rig.
        """
        if self.objections():
            return UNDECIDED
        name = self.names[self.likeliest]
        held = name == ROTATION and self.rest is not None and self.rest.held
        return MISALIGNED_STATIC if held else name

    @property
    def straight_excluded(self) -> bool | None:
        """Whether the loading excludes static friction in one dimension; None if not compared."""
        if STATIC not in self.names:
            return None
        return self.likeness[self.names.index(STATIC)].larger < RARE

    def objections(self) -> list[str]:
        """Return the reasons why no mechanism is claimed, as sentences; none if one is."""
        name, its = self.names[self.likeliest], self.likeness[self.likeliest]
        found = [self.disputed] * bool(self.disputed)
        if not its.unlike:
            found += self._improbable()
        if its.farther < UNLIKE:
            found.append(
                f"The record is not like those of {name}: {percent(its.farther)} of the simulated "
                f"records are less like the others; a claim needs {percent(UNLIKE)}."
            )
        if its.larger < BENT:
            found.append(
                f"The loading curve is not like those of {name}: {share_as_bent(its)} "
                "of the simulated ones depart as far from their mean; a claim needs "
                f"{percent(BENT)}."
            )
        if not its.curve_is_tested:
            found.append(self._lack_of_curves(name))
        if self.explanation and its.unlike:
            found.append(self.explanation)
        if self.steady < TREND:
            found.append(f"{friction_drifts(self.steady)} {STATE_DRIFT}")
        if self.rest is not None and not self.rest.known:
            found.append(
                "Whether the mass creeps or is held is not known: of "
                f"{ALIKE_SIMULATIONS} simulations of {name} with the parameters that this record "
                "seems to have, hardly any have as many cycles of stick and slip."
            )
        return [*found, self.doubt] if self.doubt else found

    def _lack_of_curves(self, name: str) -> str:
        """Return that too few simulations of a mechanism test its loading curve, as a sentence."""
        count = self.counts[self.names.index(name)]
        number = 100 * ceil(SAFE * CURVES * self.simulations / count / 100.0)
        return (
            f"Only {count} of {self.simulations} simulated records of {name} have cycles, too few "
            f"to test the loading curve; a claim needs {CURVES}: {simulate(number)}."
        )

    def _improbable(self) -> Iterator[str]:
        """Yield the reasons why the probability of the likeliest mechanism allows no claim."""
        name, probability = self.names[self.likeliest], float(self.probabilities[self.likeliest])
        halves = self.by_halves[:, self.likeliest]
        if probability < CLAIM:
            yield (
                f"The most probable one, {name}, has a probability of {probability:.2f}; a claim "
                f"needs {CLAIM}."
            )
        elif halves.min() < BY_HALF:
            yield (
                f"Learned from either half of the simulations, {name} has a probability of "
                f"{' and '.join(map(near_one, halves))}; a claim needs {BY_HALF} by both: simulate "
                "more."
            )
        if self.beside_static < CLAIM:
            yield (
                f"Beside {MISALIGNED_STATIC}, which may look the same, {name} "
                f"has a probability of {near_one(self.beside_static)}; a claim needs {CLAIM}."
            )

    def tables(self) -> list[Section]:
        """Return the odds, their evidence, and the frequency with which such odds are right."""
        numbered = [f"{number} {name}" for number, name in enumerate(self.names, 1)]
        rows = [
            (name, odds_text(p, its), percent(its.farther), share_as_bent(its), str(count))
            for name, p, its, count in zip(
                numbered, self.probabilities, self.likeness, self.counts, strict=True
            )
        ]
        headings = ("mechanism", "probability", "farther", "more bent", "simulated")
        shares = [
            (name, *(percent(share) for share in row))
            for name, row in zip(numbered, self.confusion, strict=True)
        ]
        columns = ("simulated by", *map(str, range(1, len(numbered) + 1)), UNDECIDED)
        return [
            Section("Mechanism", [*self.sentences(), EXPLAINED], Table(headings, rows)),
            Section(
                "How often simulated records are called so",
                [
                    f"A record is called 1, 2, ... with a probability of at least {CLAIM}, and of "
                    f"{BY_HALF} by each half of the simulations; otherwise it is undecided. The "
                    "classifier that calls a record has not learned from it."
                ],
                Table(columns, shares),
            ),
        ]

    def sentences(self) -> list[str]:
        """Return the decision and its limits."""
        objections = self.objections()
        found = ["No mechanism is claimed.", *objections] if objections else [self._claim()]
        if self.simulations < SIMULATIONS:
            found.append(
                f"Learned from {self.simulations} simulations of each mechanism in place of "
                f"{SIMULATIONS}: more records of laws that were not simulated pass as one of "
                f"these, and more claims depend on the draw. {simulate(SIMULATIONS).capitalize()}."
            )
        if self.straight_excluded:
            found.append(
                "The loading is not as straight as static friction in one dimension makes it: that "
                "alone does not explain this record."
            )
        if self.rest is not None and self.rest.known:
            found.append(self._at_rest(self.rest))
        if self.decision in TURNING and CHANNEL not in self.channels:
            found.append(
                "Whether friction is the same in all directions cannot be told without the force "
                "across the drive: a friction limit that is an ellipse looks like another "
                "misalignment."
            )
        if self.decision == ROTATION:
            found.append(
                "Not excluded: a static coefficient of its own beside the rotation, or in place of "
                "friction that weakens with speed. Rotation was not compared with it; often it "
                "does not show."
            )
        if self.decision == MISALIGNED_STATIC:
            found.append(
                "The record does not show the law of friction in slip: constant friction below "
                "a static coefficient may look the same."
            )
        if self.decision in (LUGRE, RATE_AND_STATE):
            found.append(
                "Not excluded: friction that weakens with speed below a static peak on a "
                "misaligned rig."
            )
            if MISALIGNED_STATIC not in self.absent:
                found.append(
                    "A peak above constant friction, and above the law of the description where "
                    "that can have one, was compared and is less probable; above another law it "
                    f"may pass for {self.decision}."
                )
        if self.decision == STATIC and RATE_AND_STATE in self.names:
            found.append(
                "Not excluded: rate and state with a direct effect a below the simulated ones, "
                "which may pass for static friction."
            )
        if self.absent:
            found.append(
                f"Not compared: {', '.join(self.absent)}. Hardly any record simulated by it has "
                f"cycles no longer than {LONGEST_CYCLE:g} times the measured ones, which speaks "
                "against it."
            )
        return found

    def _claim(self) -> str:
        """Return the claimed mechanism with its probability, as a sentence."""
        probability = near_one(self.probabilities[self.likeliest])
        if self.decision == MISALIGNED_STATIC:  # of which no probability is known by itself
            return (
                f"Claimed: {self.decision}. That is {ROTATION} whose mass rests between slips; "
                f"{ROTATION} has a probability of {probability}."
            )
        return f"Claimed: {self.decision} (probability {probability})."

    def _at_rest(self, rest: Rest) -> str:
        """Return the share at rest in the simulations of rotation, as a sentence."""
        low, middle, high = map(percent, rest)
        scatter = f" (in 80 % of the simulations {low} to {high})" if low != high else ""
        said = (
            f"Where {ROTATION} is simulated with the parameters that this record seems to have, "
            f"the mass rests, while the spring is loaded, for {middle} of the drive's way across"
            f"{scatter}"
        )
        if rest.held:
            return f"{said}: it is held by static friction, while the force on it turns and grows."
        return f"{said} and follows the rest of it."

    @property
    def data(self) -> xr.Dataset:
        """Probabilities and confusion as a dataset over ``mechanism`` and ``called``."""
        columns: dict[str, Any] = {
            "probability": ("mechanism", self.probabilities),
            "unlike": ("mechanism", [its.unlike for its in self.likeness]),
            "confusion": (("mechanism", "called"), self.confusion),
            "farther": ("mechanism", [its.farther for its in self.likeness]),
            "more_bent": ("mechanism", [its.larger for its in self.likeness]),
        }
        places = {"mechanism": [*self.names], "called": [*self.names, UNDECIDED]}
        about = {"decision": self.decision, "probability_of_such_a_trend": self.steady}
        if self.rest is not None and self.rest.known:
            about["share_at_rest"] = self.rest.middle
        return xr.Dataset(columns, places, about)

    def __eq__(self, other: object) -> bool:
        """Compare the fields, of arrays the values."""
        return same_fields(self, other)

    def __repr__(self) -> str:
        """Return a one-line summary."""
        pairs = zip(self.names, self.probabilities, self.likeness, strict=True)
        said = ", ".join(f"{name} {odds_text(p, its)}" for name, p, its in pairs)
        return f"<Odds: {self.decision}; {said}>"

    def plot(self, axes: Any = None) -> NDArray[np.object_]:
        """Draw odds, confusion and loading; see `stiction.plotting.plot_mechanism`."""
        drawn: NDArray[np.object_] = draw("plot_mechanism", self, axes)
        return drawn


def surely(probabilities: Floats, by_halves: Floats) -> NDArray[np.bool_]:
    """Return a mask of the records (n,) whose most probable mechanism may be claimed.

    Given probabilities (n, k), and those by halves of the simulations (2, n, k).

    >>> surely(np.array([[0.95, 0.05]] * 2), np.array([[[0.9, 0.1], [0.9, 0.1]],
    ...                                                [[0.7, 0.3], [0.4, 0.6]]]))
    array([ True, False])
    """
    best = probabilities.argmax(axis=1)[None, :, None]
    least = np.take_along_axis(by_halves, best, axis=2).min(axis=(0, 2))
    return np.asarray((probabilities.max(axis=1) >= CLAIM) & (least >= BY_HALF))


def simulate(number: int) -> str:
    """Return how to simulate so many records of each mechanism, as an instruction."""
    call = f"simulate {number} of each (simulations={number} of st.mechanism)"
    return str(Instruction(f"simulate {number} of each: -n {SHARE * number}", call))


def odds_text(probability: float, likeness: Likeness) -> str:
    """Return the probability of a mechanism as text; "unlike" if the record is unlike it."""
    return "unlike" if likeness.unlike else near_one(probability)


def share_as_bent(likeness: Likeness) -> str:
    """Return the share of simulations whose loading departs more, as text."""
    return at_most(likeness.larger, likeness.least)


def near_one(probability: float) -> str:
    """Return a probability in words, never as a certainty.

    >>> near_one(0.934), near_one(0.9991), near_one(2e-4)
    ('0.93', '> 0.99', '< 0.01')
    """
    if probability > 0.99:
        return "> 0.99"
    return f"{probability:.2f}" if probability >= 0.01 else "< 0.01"
