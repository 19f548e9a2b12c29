"""Mechanisms told apart: on records that no part has seen, and of laws that no library holds.

``python -m benchmarks.inference.mechanisms --library FOLDER``: for three rigs and four sets of
channels, the classifier's balanced accuracy, how often a claim is wrong, how often rotation is
called so, and what becomes of records by laws that are not claimed: a Stribeck curve with a static
peak, with and without misalignment; constant friction and the rig's own law with one, misaligned; a
friction limit that is an ellipse; coefficients that drift. Where rotation is claimed, whether its
mass is told to be held, and whether it is, by the simulated truth. From force alone, how many of
these a classifier finds that has learned this law too. Records are those of
`benchmarks.inference.fits`. FOLDER holds the simulations, so that a second call only compares.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from pathlib import Path
from time import perf_counter
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtr

from benchmarks.inference.fits import RIGS, rig_of
from stiction.analysis.motion.rest import HELD
from stiction.friction.laws import Anisotropic, Stribeck
from stiction.inference.columns import bend_features, features_from
from stiction.inference.features import USED
from stiction.inference.learning.summary import Standard
from stiction.inference.mechanism import likeness
from stiction.inference.mechanism.classifier import (
    Classifier,
    Discriminant,
    Simulations,
    learn_or_read,
    simulate,
)
from stiction.inference.mechanism.likeness import Reference
from stiction.inference.mechanism.odds import CLAIM, surely
from stiction.inference.mechanism.rest import ALIKE_SIMULATIONS, Rest, shares_at_rest
from stiction.inference.mechanism.rivals import CLAIMED, Levels, Mechanism, levels, mechanisms
from stiction.inference.mechanism.static_check import StaticCheck
from stiction.inference.observation import TREND, Conditions, steadiness, trend
from stiction.inference.posterior import RARE
from stiction.inference.priors import Prior, Uniform
from stiction.inference.rig import Rig
from stiction.inference.simulated.library import Ensemble
from stiction.inference.simulated.plan import Plan, plan
from stiction.inference.simulated.synthetic import draw
from stiction.storage.arrays import read_arrays, write_arrays
from stiction.system.parameter import change_unchecked

Floats = NDArray[np.float64]

PHI = 0.5, 4.0  # deg
ELLIPSES = {"ellipse 0.6 to 0.8": (0.6, 0.8), "ellipse 1.25 to 1.6": (1.25, 1.6)}
DRIFTING = "drift of 10 to 30 %"
DRIFT = Uniform(0.1, 0.3)  # of the coefficients' logarithm, over a record
PEAK = 1.1, 1.4  # static coefficient over that of the Stribeck curve at rest


def foreign(rig: Rig, conditions: Conditions) -> Iterator[Mechanism]:
    """Yield laws that are in no library."""
    slider, priors = rig.slider, rig.priors
    for name, ratios in ELLIPSES.items():
        law = Anisotropic(slider.friction, ratio=sum(ratios) / 2)
        own = {**priors, "friction.ratio": Uniform(*ratios)}
        yield Mechanism(name, (with_law(rig, law, own, conditions),))
    drifting = plan(slider, {**priors, "drift": DRIFT}, [conditions])
    yield Mechanism(DRIFTING, (drifting,))
    level = levels(rig)
    own, law = stribeck(rig, level)
    kept = {path: each for path, each in priors.items() if not path.startswith("friction.")}
    yield Mechanism("Stribeck with a static peak, misaligned",
                    (with_law(rig, law, {**kept, **own}, conditions),))  # fmt: skip
    straight = rig._replace(slider=change_unchecked(slider, "phi", 0.0))
    kept.pop("phi")
    yield Mechanism("Stribeck with a static peak, aligned",
                    (with_law(straight, law, {**kept, **own}, conditions),))  # fmt: skip


def peaks(rivals: Sequence[Mechanism]) -> Iterator[Mechanism]:
    """Yield each law of static friction on the misaligned rig by itself."""
    for its in rivals[-1].plans:
        law = type(its.slider.friction).__name__
        yield Mechanism(f"{law} with a static peak, misaligned", (its,))


def stribeck(rig: Rig, level: Levels) -> tuple[dict[str, Prior], Stribeck]:
    """Return a Stribeck curve that falls by half as much as the rig's law, below a static peak."""
    low, high = level.kinetic[0], level.static[1]
    middle = 0.5 * (low + high)
    peak = Uniform(PEAK[0] * middle, PEAK[1] * middle)
    speed = abs(rig.slider.motion.rate(0.0)[0])
    priors: dict[str, Prior] = {
        "friction.mu_c": Uniform(low, 0.5 * (low + middle)),
        "friction.mu_s": Uniform(0.5 * (low + middle), middle),
        "friction.v_s": Uniform(3.0 * speed, 60.0 * speed, "log"),
        "friction.mu_static": peak,
    }
    law = Stribeck(mu_s=middle, mu_c=low, v_s=10.0 * speed, mu_static=peak.high)
    return priors, law


def with_law(rig: Rig, law: object, priors: dict[str, Prior], conditions: Conditions) -> Plan:
    """Return the plan of a rig with another law."""
    slider = rig.slider.model_copy(update={"friction": law})
    return plan(slider, priors, [conditions])._replace(basis=rig.slider)


class Part(NamedTuple):
    """Records with the features of some channels (n, f), their bends and labels."""

    names: tuple[str, ...]
    features: Floats
    bends: Floats
    labels: NDArray[np.int64]
    parameters: tuple[Floats, ...]

    @classmethod
    def of(cls, records: Simulations, which: NDArray[np.bool_], bend: NDArray[np.bool_]) -> Self:
        """Return those of simulations with all channels."""
        rows = records.features
        return cls(records.names, rows[:, which], rows[:, bend], records.labels, records.parameters)

    @property
    def simulations(self) -> Simulations:
        """The same without bends."""
        return Simulations(self.names, self.features, self.labels, parameters=self.parameters)


class Called(NamedTuple):
    """The most probable mechanism of records, whether that is sure, and whether it is claimed.

    `usual` is whether it would be claimed but for static friction on the misaligned rig; `held`
    whether rotation is said to be that.
    """

    likeliest: NDArray[np.int64]
    sure: NDArray[np.bool_]
    usual: NDArray[np.bool_]
    claimed: NDArray[np.bool_]
    held: NDArray[np.bool_]


def angles(rotation: Plan, count: int, folder: Path | None, seed: int) -> Floats:
    """Return the misalignment (deg) of each test record of rotation that has cycles."""
    made = Ensemble.within(folder, rotation, seed).simulate(count).library(count)
    shares = ndtr(made.scores[:, [*rotation.priors].index("phi")])
    return np.degrees(rotation.priors["phi"].quantile(shares))


def call(
    classifier: Classifier, references: Sequence[Reference], records: Part, check: StaticCheck,
    names: Sequence[str], rest: Floats,
) -> Called:  # fmt: skip
    """Return what each of some records is called, and whether it may be claimed.

    `rest` is how far the mass rests in each simulation of rotation.
    """
    probabilities = classifier.probabilities(records.features)
    likeliest = probabilities.argmax(axis=1)
    scores = classifier.standard.scores(records.features)
    found = [
        references[label].likeness(*each)
        for label, each in zip(likeliest, zip(scores, records.bends, strict=True), strict=True)
    ]
    sure = surely(probabilities, classifier.probabilities_by_halves(records.features))
    usual = sure & ~np.array([its.unlike for its in found])
    claimed = usual.copy()
    for place, name in enumerate(names):
        its = np.nonzero(claimed & (likeliest == place))[0]
        claimed[its] = check.probability(name, records.features[its]) >= CLAIM
    alike = [references[0].typicality.alike(each, ALIKE_SIMULATIONS) for each in scores]
    held = np.array([Rest.among(rest[some]).held for some in alike]) & (likeliest == 0)
    return Called(likeliest, sure, usual, claimed, held)


def found_when_known(known: Part, other: Part) -> float:
    """Return the share of a law's records that a classifier finds which has learned this law too.

    It takes 5 % of the library's records for it. Each record is left out of what calls it.
    """
    labels = np.repeat([0, 1], [len(known.labels), len(other.labels)])
    both = np.concatenate([known.features, other.features])
    share = Discriminant.of(Standard.of(both).scores(both), labels).left_out[:, 1]
    return float((share[labels == 1] > np.quantile(share[labels == 0], 1.0 - RARE)).mean())


def trends(of: Plan, count: int, seed: int) -> Floats:
    """Return the probability of such a trend by chance, of each record that has cycles."""
    made = (next(draw(of, number, seed)[1]) for number in range(count))
    pairs = (trend(its.channels["force"], its.cycles) for its in made if its)
    return np.array([steadiness(pair) for pair in pairs])


class AtRest(NamedTuple):
    """How far the mass rests in a loading: in the library's records of rotation, and in tests."""

    known: Floats
    unseen: Floats
    others: tuple[Floats, ...]


def stored_shares(of: Plan, scores: Floats, folder: Path | None, seed: int) -> Floats:
    """Return how far the mass rests in simulations with these scores, simulated once."""
    place = Ensemble.within(folder, of, seed).folder
    path = None if place is None else place / f"rest-{len(scores)}.npz"
    found = (read_arrays(path) or {}).get("shares")
    if found is None:
        found = shares_at_rest(of, scores)
        write_arrays(path, shares=found)
    return found


def report(
    known: Part, checked: Simulations, unseen: Part, others: Sequence[tuple[str, Part]],
    phi: Floats, steady: Floats, drifts: Floats, rest: AtRest,
) -> None:  # fmt: skip
    """Print what becomes of records that no part has seen, with some channels."""
    start = perf_counter()
    classifier = learn_or_read(known.simulations)
    references = likeness.learn_or_read(known.simulations, classifier.whole.scores, known.bends)
    check = StaticCheck.of(checked)
    took = perf_counter() - start
    named = known.names, rest.known
    its, labels = call(classifier, references, unseen, check, *named), unseen.labels
    right = its.likeliest == labels
    recall = [float(right[labels == label].mean()) for label in range(len(known.names))]
    print(
        f"    balanced accuracy {np.mean(recall):.3f}; claims above {CLAIM} wrong: "
        f"{1.0 - right[its.sure].mean():.2%}, of records that are usual "
        f"{1.0 - right[its.claimed].mean():.2%}; learned in {took:.0f} s"
    )
    turning = labels == 0
    some = (phi >= PHI[0]) & (phi <= PHI[1])
    shares = [(each & right)[turning][some].mean() for each in (right, its.sure)]
    claimed = (its.claimed & right)[turning] & (steady >= TREND)
    print(
        f"    rotation at {PHI[0]} to {PHI[1]} deg: most probable {shares[0]:.1%}, with "
        f"{CLAIM} and above {shares[1]:.1%}, claimed {claimed[some].mean():.1%}; "
        f"{held_in_words(its.held[turning][some & claimed], rest.unseen[some & claimed])}"
    )
    for label, name in enumerate(known.names):
        own = its.likeliest[labels == label] == label
        before, after = ((each[labels == label] & own).mean() for each in (its.usual, its.claimed))
        print(f"    {name}: called so {after:.1%}, refused by condition 5 {before - after:.1%}")
    for (name, records), at_rest in zip(others, rest.others, strict=True):
        found = call(classifier, references, records, check, *named)
        claimed = found.claimed & (drifts >= TREND) if name == DRIFTING else found.claimed
        refused = names_in_words(known.names, found.likeliest, found.usual & ~found.claimed)
        said = found.likeliest[claimed] == 0
        print(
            f"    {name}: undecided {1.0 - claimed.mean():.1%}; called "
            f"{names_in_words(known.names, found.likeliest, claimed)}; refused by condition 5 "
            f"{refused}; {held_in_words(found.held[claimed][said], at_rest[claimed][said])}"
        )


def names_in_words(
    names: Sequence[str], likeliest: NDArray[np.int64], some: NDArray[np.bool_]
) -> str:
    """Return of which mechanisms some of all records are, with their shares of all."""
    shares = np.bincount(likeliest[some], minlength=len(names)) / len(some)
    found = (f"{name} {share:.1%}" for name, share in zip(names, shares, strict=True) if share)
    return ", ".join(found) or "none"


def held_in_words(held: NDArray[np.bool_], rest: Floats) -> str:
    """Return how many of some claims of rotation say that the mass is held, and how many rightly.

    `rest` is the true share of the drive's way across for which it rests.
    """
    if not len(held):
        return "never rotation"
    right = f", rightly {(rest[held] >= HELD).mean():.1%}" if held.any() else ""
    return (
        f"of rotation {held.mean():.1%} said to be held{right}; in truth the mass rests for "
        f"{HELD:.0%} of the way and more in {(rest >= HELD).mean():.1%}, in the middle for "
        f"{np.median(rest):.0%}"
    )


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--simulations", type=int, default=1280)
    parser.add_argument("--records", type=int, default=384)
    parser.add_argument("--rigs", nargs="+", default=[*RIGS])
    parser.add_argument("--library", type=Path)
    parser.add_argument("--seed", type=int, default=0, help="the first of three")
    options = parser.parse_args()
    for name in options.rigs:
        start = perf_counter()
        rig, conditions = rig_of(name)
        rivals = mechanisms(rig, [conditions])
        strange = [*foreign(rig, conditions), *peaks(rivals)]
        folder = options.library
        first, second, third = range(options.seed, options.seed + 3)
        checked = simulate(rivals, options.simulations, folder, seed=first)
        known = checked.among(CLAIMED)
        unseen = simulate(rivals[:-1], options.records, folder, seed=second).among(CLAIMED)
        if unseen.names != known.names:
            parser.error(f"by one of {', '.join(known.names)} hardly any of the records has cycles")
        others = [simulate([each], options.records, folder, seed=third) for each in strange]
        plans = [each.plans[0] for each in strange]
        seeds = [first, second, *[third] * len(plans)]
        some = zip(
            [*[rivals[0].plans[0]] * 2, *plans], [known, unseen, *others], seeds, strict=True
        )
        at_rest = [stored_shares(of, its.parameters[0], folder, seed) for of, its, seed in some]
        rest = AtRest(at_rest[0], at_rest[1], (*at_rest[2:],))
        print(
            f"{name}: {len(known.labels)} records to learn from, {len(unseen.labels)} to test on; "
            f"{perf_counter() - start:.0f} s"
        )
        phi = angles(rivals[0].plans[0], options.records, folder, second)
        (drifting,) = [each.plans[0] for each in strange if each.name == DRIFTING]
        drifts = trends(drifting, options.records, third)
        steady = trends(rivals[0].plans[0], options.records, second)
        print(
            f"  a trend is seen in {(drifts < TREND).mean():.1%} of the records that drift, and in "
            f"{(steady < TREND).mean():.1%} of the others"
        )
        bend = bend_features(conditions, rig.slider)
        for channels in (USED[:1], USED[:2], ("force", "position"), USED):
            print(f"  {' + '.join(channels)}", flush=True)
            which = features_from(channels, conditions, rig.slider)
            parts = [Part.of(each, which, bend) for each in (known, unseen, *others)]
            named = [*zip((each.name for each in strange), parts[2:], strict=True)]
            every = checked._replace(features=checked.features[:, which])
            report(parts[0], every, parts[1], named, phi, steady, drifts, rest)
            if channels == USED[:1]:
                for law, part in named:
                    print(f"    {law}: {found_when_known(parts[0], part):.1%} found when known")


if __name__ == "__main__":
    main()
