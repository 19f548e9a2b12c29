"""The result of a fit: a posterior beside its prior."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtr

from stiction.arrays import Floats, xr
from stiction.errors import ResultError, echo
from stiction.inference.disagreement import TWO_WAYS, Disagreement, disagreement, stated_rate
from stiction.inference.learning.calibration import Learned
from stiction.inference.learning.conflict import NEAREST, Conflict
from stiction.inference.learning.regression_abc import Sample, quantiles
from stiction.inference.learning.summary import FeatureSummary
from stiction.inference.measured.drive_of_records import DriveOfRecords
from stiction.inference.observation import (
    TREND,
    VELOCITY,
    Observation,
    Trend,
    sign_seen,
    trend_of,
)
from stiction.inference.rig import Rig, stored_text
from stiction.inference.simulated.library import Library
from stiction.inference.simulated.plan import Plan
from stiction.inference.simulated.synthetic import NOT_OF_THE_SLIDER
from stiction.inference.suitability import explain_unlike
from stiction.names import draw
from stiction.result.fit_file import write_fit
from stiction.system.parameter import unit
from stiction.text.paths import last_part, short_names
from stiction.text.quantity.wording import in_words, interval, percent, span, to_error, with_error
from stiction.text.sections import Report, Section, Table
from stiction.text.suggestion import Suggestion

DRAWS = 4000  # equally weighted, of the posterior and of the prior
INTERVAL = 0.95
CONTRADICTS = 0.01  # p-value below which records of one rig contradict each other, or the rig
RARE = 0.05  # share of simulations below which a record is not like them
NEAR_AN_END = 2.0  # normal score beyond which 5 % of a prior lie
TAIL = 3.0  # normal score beyond which 0.27 % of a prior lie
PRIOR = 3  # digits of the ends of its interval
NARROWER = 0.75  # of the prior's standard deviation, as normal scores: what counts as identified
STATE_DRIFT = (
    "A zero of the load cell that drifts can be stated, as a record without contact shows it, in "
    'the file beside the record, under [sensors.force]: zero_drift = "0 +- 5 mN/min".'
)
WITHHELD = (
    "The values, which mean nothing, are not listed; the file of the fit, and fit.estimates in "
    "Python, have them."
)
ALONG_X = (
    "The force is taken as that of the spring along x, k_x u_x. A load cell along the drive reads "
    'k_y u_y sin φ as well: if yours does, state cell_angle = "0 deg" in [slider].'
)
EXACT = 1e-9  # p-values that differ by less are the same, but for rounding
BY_RATE = (
    "k_x follows from the rate of loading, k_x V: it is as far off as the drive velocity, which is "
    'taken as certain; else state velocity = "0.5 +- 0.02 mm/s".'
)
OWN_UNITS = {"jitter": "", "gain": "", "zero": "N", "zero_drift": "N/s"}
MEANINGS = {
    "jitter": "relative spread of friction from cycle to cycle",
    "gain": "gain of the load cell",
    "zero": "zero of the load cell",
    "zero_drift": "drift of the zero of the load cell",
}


class Estimate(NamedTuple):
    """The estimate of one parameter: medians and 95 % intervals, posterior and prior.

    In SI, angles in rad; in the datasets of a fit they are in degrees.

    `narrower` is the posterior's standard deviation over the prior's, both as normal scores;
    `identified` whether that is below 0.75. `coverage` is how often such intervals hold the truth
    of simulated records that were left out; it should be 0.95.
    """

    name: str
    unit: str
    median: float
    low: float
    high: float
    prior_median: float
    prior_low: float
    prior_high: float
    narrower: float
    coverage: float

    @property
    def identified(self) -> bool:
        """Whether the records narrow the prior clearly."""
        return self.narrower < NARROWER


@dataclass(frozen=True, repr=False)
class Fit(Report):
    """The parameters of a rig as estimated from records.

    Parameters
    ----------
    plan : Plan
        Rig, priors, and conditions of the records.
    data : Dataset
        Equally weighted draws of the posterior over ``draw``, a variable for each parameter.
    prior : Dataset
        Draws of the prior.
    estimates : tuple of Estimate
        Of each parameter.
    simulations : int
        Simulated records with cycles that were compared.
    ranks : ndarray
        (m, p), of the truth in the posteriors of simulated records that were left out; uniform
        where posteriors are calibrated.
    scores : ndarray
        (n, p), the draws of `data` as normal scores.
    farther : float
        Share of the simulated records that are less like the others than the measured one is.
    trend : Trend
        p-values of a trend of peaks and of drops from cycle to cycle, in all records together.
    disagreement : Disagreement or None
        The parameter of which several records say most clearly something else, if there are any.
    loading : Conflict
        Of the logarithm of the rate of loading with what is stated: stiffness times drive velocity,
        times the gain of a load cell.
    explanation : str
        What may explain that records are not like the simulated ones, as sentences; may be empty.
    disputed : str
        In which records an analysis counts other cycles, as sentences; may be empty.
    drive : DriveOfRecords or None
        The velocity that records show of the drive, in place of what is stated.
    """

    plan: Plan
    data: xr.Dataset
    prior: xr.Dataset
    estimates: tuple[Estimate, ...]
    simulations: int
    ranks: Floats = field(compare=False)
    scores: Floats = field(compare=False)
    farther: float = field(compare=False)
    trend: Trend = field(compare=False)
    disagreement: Disagreement | None = field(compare=False)
    loading: Conflict = field(compare=False)
    explanation: str = field(default="", compare=False)
    disputed: str = field(default="", compare=False)
    drive: DriveOfRecords | None = field(default=None, compare=False)

    @classmethod
    def of(
        cls,
        library: Library,
        sample: Sample,
        seen: Sequence[Observation],
        learned: Learned,
        alone: Sequence[FeatureSummary] = (),
    ) -> Self:
        """Return the fit of a weighted sample of normal scores, with the results from a library.

        `alone` is what the features of each record say by themselves, where there are several.
        """
        observed = np.concatenate([each.features for each in seen])
        trend = trend_of(seen)
        plan = library.plan
        sample = possible(plan, sample)
        scores, coverage = resample(sample), learned.coverage(INTERVAL)
        before = draw_prior(plan)
        estimates = tuple(
            estimate(plan, name, (sample.scores[:, i], before[:, i]), sample.weights, its)
            for i, (name, its) in enumerate(zip(plan.priors, coverage.tolist(), strict=True))
        )
        after, prior = dataset(plan, scores), dataset(plan, before)
        short = short_names(plan.priors)
        for its in estimates:
            after[short[its.name]].attrs["coverage_of_95_percent_intervals"] = its.coverage
        farther = learned.farther(observed)
        count, ranks = len(library.scores), learned.ranks
        blocks = [each.features for each in seen]
        apart = disagreement([*plan.priors], library.scores, alone, blocks) if alone else None
        loading = stated_rate(library, seen)
        why = explain_unlike([each.changes for each in seen])
        other = " ".join(each.disputed for each in seen if each.disputed)
        return cls(
            plan, after, prior, estimates, count, ranks, scores, farther, trend, apart, loading,
            why, other,
        )  # fmt: skip

    def __repr__(self) -> str:
        """Return a one-line summary."""
        if self.meaningless:
            return "<Fit: in doubt, see print(fit)>"
        said = ", ".join(f"{x.name} {words(x)}" for x in self.known) or "nothing is identified"
        return f"<Fit: {said}{'; in doubt, see print(fit)' if self.doubts else ''}>"

    def __getitem__(self, name: str) -> Estimate:
        """Return the estimate of a parameter by its name: ``fit["phi"]``."""
        found = [x for x in self.estimates if name in (x.name, last_part(x.name))]
        if not found:
            known = ", ".join(x.name for x in self.estimates)
            raise ResultError(f"no parameter {echo(name)} was fitted; known: {known}")
        if len(found) > 1:
            several = ", ".join(x.name for x in found)
            raise ResultError(f"{echo(name)} is the name of several parameters: {several}")
        return found[0]

    def __iter__(self) -> Iterator[str]:
        """Go through the names of the parameters."""
        return (x.name for x in self.estimates)

    def __contains__(self, name: object) -> bool:
        """Return whether a parameter of that name was fitted."""
        return any(name in (x.name, last_part(x.name)) for x in self.estimates)

    def tables(self) -> list[Section]:
        """Return the report: the estimates, and the parameters that remain undetermined."""
        return [self.without_values()] if self.meaningless else self._with_values()

    def without_values(self) -> Section:
        """Return the report of a fit whose values mean nothing: the reasons against them."""
        compared = f"Compared with {self.simulations} simulated records."
        return Section("Fit", [*self.doubts, WITHHELD, compared, *self.disturbances])

    def _in_short(self) -> Section:
        """Return the doubts, if any, then the identified parameters, then the others."""
        lines = self.doubts
        short = short_names(x.name for x in self.estimates)
        if self.known:
            known = (
                f"{short[x.name]} {middle(x)} ({interval(x.low, x.high, x.median, x.unit)})"
                for x in self.known
            )
            lines.append(f"With 95 % intervals: {', '.join(known)}.")
        if self.unidentified:
            lines.append(
                f"Not identifiable from these records: {', '.join(self.unidentified)}. The "
                f"posterior is more than {percent(NARROWER)} as wide as the prior."
            )
        return Section("In short", lines)

    def _with_values(self) -> list[Section]:
        """Return the result in short, the table of all parameters, and notes on it."""
        remarks = dict.fromkeys(self.unidentified, "not identifiable")
        remarks |= dict.fromkeys(self.beyond, "beyond its prior")
        short = short_names(x.name for x in self.estimates)  # the sentences have the whole name
        rows = [row(x, short[x.name], remarks.get(x.name, "")) for x in self.estimates]
        headings = ("parameter", "posterior", "its 95 %", "95 % of prior", "width", "coverage")
        table = Section("Fit", [], Table(headings, rows))
        return [self._in_short(), table, Section("Notes on the fit", self._notes())]

    def _notes(self) -> list[str]:
        """Return the assumptions of the estimates, and the meaning of their table's columns."""
        sentences = []
        if "phi" in self.plan.priors and not sign_seen(self.plan.conditions):
            sentences.append("These channels do not show the sign of phi: it is that of the prior.")
        if "phi" in self.plan.priors and self.plan.slider.cell_angle is None:
            sentences.append(ALONG_X)
        if VELOCITY not in self.plan.priors and "k_x" in [x.name for x in self.known]:
            sentences.append(BY_RATE)
        if self.drive is not None and self.drive.said:
            sentences.append(self.drive.said)
        sentences.append(f"Compared with {self.simulations} simulated records.")
        sentences += self.disturbances
        sentences.append(
            "Experimental. Width: that of the posterior over that of the prior. Coverage: the "
            f"share of such 95 % intervals that hold the truth, of {len(self.ranks)} simulated "
            "records that were left out. It says nothing of what no simulation contains."
        )
        own = [x.name for x in self.estimates if x.name in MEANINGS]
        sentences += [f"{name} is the {MEANINGS[name]}." for name in own]
        return sentences

    @property
    def rig(self) -> Rig:
        """The rig as it is described, with the priors of its own parameters."""
        own = {name: its for name, its in self.plan.priors.items() if name not in NOT_OF_THE_SLIDER}
        return Rig(self.plan.slider, own)

    @property
    def known(self) -> list[Estimate]:
        """The parameters that the records narrow clearly, with a posterior within the prior."""
        return [x for x in self.estimates if x.identified and x.name not in self.beyond]

    @property
    def beyond(self) -> list[str]:
        """The parameters whose posterior lies far in a tail of the prior."""
        return self._out_by(TAIL)

    @property
    def at_an_end(self) -> list[str]:
        """The parameters whose median lies near an end of the prior."""
        return self._out_by(NEAR_AN_END)

    @property
    def narrow_priors(self) -> str:
        """A warning of posteriors at an end of their prior, for records unlike simulations; or ''.

        By itself it tells nothing: of true values, 2 % lie as near to each end.
        """
        if not self.at_an_end:
            return ""
        return (
            f"The fit comes to an end of the prior of {' and '.join(self.at_an_end)}: that prior, "
            "or a value stated as certain, may be wrong. "
        )

    def _out_by(self, score: float) -> list[str]:
        """Return the parameters whose median is farther from the prior's than a normal score."""
        middles = np.median(self.scores, axis=0)
        pairs = zip(self.estimates, middles, strict=True)
        return [each.name for each, middle in pairs if abs(middle) > score]

    @property
    def unidentified(self) -> list[str]:
        """The parameters that the records neither narrow clearly nor move beyond the prior."""
        return [x.name for x in self.estimates if not x.identified and x.name not in self.beyond]

    @property
    def doubts(self) -> list[str]:
        """The reasons to doubt the estimates, as sentences; none if nothing speaks against them."""
        found = [self.disputed] * bool(self.disputed)
        if self.farther < RARE:
            found.append(unlike(self.farther, f"{self.narrow_priors}{self.explanation}"))
        if self.contradictory and self.disagreement is not None:
            least = TWO_WAYS / (self.simulations + 1.0)
            found.append(
                "The records contradict each other, most clearly about "
                f"{self.disagreement.name}: {at_most(self.disagreement.p_value, least)} of the "
                f"simulated rigs have records that differ as far, {percent(CONTRADICTS)} are "
                "needed. The values mean nothing until that is explained: are they of one rig, "
                "under the conditions stated? Fit each by itself."
            )
        if self.drive is not None and self.drive.doubt:
            found.append(self.drive.doubt)
        if self.loading.p_value < CONTRADICTS:
            found.append(other_rate(self.loading))
        if self.beyond:
            names = ", ".join(self.beyond)
            found.append(
                f"At an end of its prior, beyond which the records point: {names}; "
                "correct the rig's description, or widen its prior."
            )
        if self.trend.drops < TREND:
            found.append(friction_drifts(self.trend.drops))
        elif self.drifts:
            found.append(
                "The peaks have a trend from cycle to cycle, the drops show none, as where a zero "
                f"drifts: friction coefficients are then uncertain by more. {STATE_DRIFT}"
            )
        return found

    @property
    def contradictory(self) -> bool:
        """Whether several records contradict each other about a parameter."""
        return self.disagreement is not None and self.disagreement.p_value < CONTRADICTS

    @property
    def meaningless(self) -> bool:
        """Whether disputed cycles, unlike or contradictory records make the values mean nothing."""
        return bool(self.disputed) or self.farther < RARE or self.contradictory

    @property
    def drifts(self) -> bool:
        """Whether only the peaks have a trend, as with a drifting zero, and no drift is stated."""
        stated = any(each.noise["force"].drift for each in self.plan.conditions)
        return not stated and self.trend.peaks < TREND <= self.trend.drops

    @property
    def disturbances(self) -> list[str]:
        """Parts left out of records, and noise added to simulations, as sentences."""
        noises = [noise for each in self.plan.conditions for noise in each.noise.values()]
        bands = sorted({band for noise in noises for band in noise.stop_bands})
        times = sorted({noise.lasts for noise in noises if noise.lasting})
        found = []
        if bands:
            named = ", ".join(f"{band.low:g} to {band.high:g} Hz" for band in bands)
            found.append(
                f"Left out of records and simulations alike, for lines such as mains hum: {named}."
            )
        if times:
            named = ", ".join(in_words(time, "s") for time in times)
            found.append(f"Noise that is not white but lasts is simulated as seen: for {named}.")
        for cell in sorted({noise.cell for noise in noises if noise.cell is not None}):
            found.append(
                f"The load cell rings at {in_words(cell.frequency, 'Hz')} after each slip: what is "
                "compared is the force to which it answers, in record and simulations alike up to "
                f"about {in_words(cell.highest, 'Hz', 2)}."
            )
        return found

    def plot(self, axes: Any = None) -> NDArray[np.object_]:
        """Draw prior against posterior; see `stiction.plotting.plot_posterior`."""
        drawn: NDArray[np.object_] = draw("plot_posterior", self, axes)
        return drawn

    def save(self, path: str | Path, **groups: xr.Dataset) -> Path:
        """Write the posterior as NetCDF, the prior in its group ``prior``; return the path.

        Attributes hold the description of the rig with its priors and the text of a user's law,
        what speaks against the estimates, and the version of this package.

        Further datasets become groups of their name: ``fit.save("fit.nc", mechanism=odds.data)``.
        """
        about = {
            "rig": stored_text(self.rig),
            "doubts": "\n".join(self.doubts),
            "simulations": self.simulations,
        }
        return write_fit(path, self.data, {"prior": self.prior, **groups}, about)


def possible(plan: Plan, sample: Sample) -> Sample:
    """Return the draws of a sample that the description allows, where priors are restricted.

    A local regression moves some draws over the border.
    """
    if not plan.restricted:
        return sample
    weights = sample.weights * [plan.takes(scores) for scores in sample.scores]
    total = weights.sum()
    return Sample(sample.scores, weights / total) if total > 0.0 else sample


def draw_prior(plan: Plan) -> Floats:
    """Return normal scores (n, p) of draws of the prior."""
    random, count = np.random.default_rng(0), len(plan.priors)
    if not plan.restricted:
        return random.standard_normal((DRAWS, count))
    return np.stack([plan.draw(random) for _ in range(DRAWS)])


def estimate(
    plan: Plan, name: str, scores: tuple[Floats, Floats], weights: Floats, coverage: float
) -> Estimate:
    """Return the estimate of a parameter from normal scores: weighted ones of its posterior, and
    of draws of the prior, which count where this is restricted."""
    prior, (after, before) = plan.priors[name], scores
    tails = np.array([0.5, 0.5 - 0.5 * INTERVAL, 0.5 + 0.5 * INTERVAL])
    middle, low, high = prior.quantile(ndtr(quantiles(after, weights, tails))).tolist()
    shares = ndtr(np.quantile(before, tails)) if plan.restricted else tails
    mid, bottom, top = prior.quantile(shares).tolist()
    mean = weights @ after
    deviation = float(np.sqrt(weights @ (after - mean) ** 2))
    wide = float(before.std()) if plan.restricted else 1.0
    narrower = deviation / wide
    return Estimate(
        name, unit_of(plan, name), middle, low, high, mid, bottom, top, narrower, coverage
    )


def other_rate(its: Conflict) -> str:
    """Return the doubt that the loading rate differs from the stated one, with the remedy."""
    factor, share = float(np.exp(its.found)), at_most(its.p_value, 1.0 / (NEAREST + 1.0))
    return (
        f"The force rises at {with_error(factor, its.error * factor, '')} times the rate that is "
        f"stated, stiffness times drive velocity: {share} of the simulated records are as far off, "
        f"{percent(CONTRADICTS)} are needed. Stiffness, velocity or the gain of the load cell is "
        "off by more than stated, and what is estimated of friction and stiffness "
        "with it. Measure them, or state uncertainties that hold, such as velocity = "
        '"0.5 +- 0.02 mm/s" under [drive].'
    )


def at_most(p_value: float, least: float) -> str:
    """Return a share of simulations as text: a bound where none of them is as far off.

    `least` is the p-value of a record that is farther off than all simulations.

    >>> at_most(0.03, 0.01), at_most(0.01, 0.01)
    ('3 %', 'at most 1 %')
    """
    return f"{'at most ' if p_value <= least + EXACT else ''}{percent(p_value)}"


def friction_drifts(p_value: float) -> str:
    """Return the doubt that friction has a trend in a record, with its p-value."""
    return (
        f"Friction drifts: peaks or drops have a trend from cycle to cycle (p = {p_value:.1g}), "
        f"which is not simulated. Take cycles after running in ({Suggestion('begin')})."
    )


def unlike(farther: float, why: str) -> str:
    """Return the doubt that records are unlike simulated ones, with a share and a reason."""
    return (
        "The records are not like those of the rig as described, whatever the uncertain values are "
        f"within their priors: {percent(farther)} of the simulated records are less like the "
        f"others, {percent(RARE)} are needed. The values mean nothing until that is "
        "explained: is it this rig's record, are drive and load as stated, does the load cell lie "
        f"along the axis that the rig states? {why}"
    ).rstrip()


def unit_of(plan: Plan, name: str) -> str:
    """Return the SI unit of a parameter of a fit."""
    return OWN_UNITS[name] if name in OWN_UNITS else unit(plan.slider, name)


def resample(sample: Sample) -> Floats:
    """Return equally weighted scores, by systematic resampling in a fixed random order."""
    at = (np.arange(DRAWS) + 0.5) / DRAWS
    chosen = np.searchsorted(np.cumsum(sample.weights), at).clip(max=len(sample.weights) - 1)
    found: Floats = sample.scores[np.random.default_rng(0).permutation(chosen)]
    return found


def dataset(plan: Plan, scores: Floats) -> xr.Dataset:
    """Return draws as a dataset: angles in degrees, as everywhere in data."""
    columns: dict[str, Any] = {}
    short = short_names(plan.priors)
    for i, (name, prior) in enumerate(plan.priors.items()):
        values, its = prior.quantile(ndtr(scores[:, i])), unit_of(plan, name)
        if its == "rad":
            values, its = np.degrees(values), "deg"
        labels = {"units": its or "1", "long_name": MEANINGS.get(name, name)}
        columns[short[name]] = ("draw", values, labels)
    return xr.Dataset(columns)


def words(x: Estimate) -> str:
    """Return the median of an estimate and its interval in words."""
    return f"{middle(x)} ({interval(x.low, x.high, x.median, x.unit)})"


def middle(x: Estimate) -> str:
    """Return the median of an estimate, to two digits of its distance from an end."""
    return to_error(x.median, 0.1 * min(x.median - x.low, x.high - x.median), x.unit)


def row(x: Estimate, short: str, remark: str) -> tuple[str, ...]:
    """Return a row of the report; a remark stands in place of the value, if there is one."""
    after, between = remark or middle(x), interval(x.low, x.high, x.median, x.unit)
    before = span(x.prior_low, x.prior_high, x.unit, PRIOR)
    width = percent(x.narrower) if x.narrower < 1.0 else "as wide as the prior"
    return short, after, between, before, width, percent(x.coverage)
