"""Tests of a rig over the ranges of its uncertain parameters, and the alignment it needs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from decimal import ROUND_DOWN, Context, Decimal
from functools import partial
from math import degrees, isnan, nan, radians
from typing import NamedTuple

import numpy as np

from stiction.analysis.signals.correlated_noise import BOUNDS_95, interval_95
from stiction.arrays import Floats
from stiction.auditing.prediction import Prediction, predict
from stiction.auditing.simulated_test import (
    LOADS,
    SimulatedTest,
    creep_before_slip,
    simulate_coarsely,
)
from stiction.auditing.words.numbers import kinetic, peak
from stiction.errors import StictionError
from stiction.inference.rig import Rig
from stiction.inference.simulated.restriction import is_allowed
from stiction.progress.report import Progress, silent
from stiction.study.execution.cores import Cores
from stiction.system.parameter import change_parameters, quantity
from stiction.system.slider import Slider
from stiction.text.quantity.wording import in_words, percent
from stiction.text.sections import Section, Table

ALLOWED = 0.02  # error of the static coefficient
DRAWS = 64  # of the priors, a power of 2 for Sobol's sequence
ENOUGH = 39  # values, whose smallest and largest hold (n - 1)/(n + 1) = 95 % of others in the mean
MOST_ROUNDS = 100  # of them, until so many are taken by the description
MOST_STEPS = 400_000  # of each test
SCAN = 14  # misalignments at which the error is looked at, in a geometric series
# Misalignments, evenly in the logarithm, about the first of these that is too large
FINE_ANGLES = 24
FARTHEST = 30.0  # degrees up to which the error is looked at; farther, the soft spring is another
NEAREST = 0.02  # degrees: the first of the scan, unless the error is too large there
NEARER = np.geomspace(0.002, NEAREST, 8, endpoint=False)  # degrees that are then looked at
TITLE = "How well to align"
ROWS = (  # label and unit of each reading
    ("apparent static friction, largest force", ""),
    ("apparent kinetic friction, mean", ""),
    ("creep before the first slip", "m"),
    ("transverse oscillation, up to V sin φ/ω_y", "m"),
)


class Reading(NamedTuple):
    """The readings of a test from rest: coefficients, and creep and transverse oscillation in m.

    The oscillation is its bound V sin(phi)/omega_y, which the paper derives; the others come from
    the simulated record. NaN where the test shows none.
    """

    static: float
    kinetic: float
    creep: float
    oscillation: float


class Alignment(NamedTuple):
    """The needed alignment: beyond `angle` (rad), the error of mu_static exceeds `allowed`.

    NaN if that is not reached up to `until` (rad), or is exceeded at the smallest angle that was
    tried, where the error is `least`. Single tests scatter about their mean, with the phase of the
    transverse oscillation at the slip: one exceeds the allowed error at `first` (rad) already, NaN
    if none does. `nearer` tests were made at smaller angles than `angle`.
    """

    angle: float
    until: float
    least: float
    first: float = nan
    nearer: int = 0
    allowed: float = ALLOWED


@dataclass(frozen=True)
class Budget:
    """The effect of a rig's uncertain parameters on a test, above all of its misalignment.

    Parameters
    ----------
    angles : ndarray
        (n,), misalignments drawn from the prior, rad; equal where it is certain.
    drawn : ndarray
        (n, 4), the readings with them and with the draws of all other uncertain parameters.
    ends : ndarray
        (3,), misalignments with 2.5, 50 and 97.5 % of the prior below them, rad; (1,), that of the
        rig, where it is certain.
    at_ends : ndarray
        (3, 4) or (1, 4), readings there, all other parameters in the middle of their priors.
    aligned : Reading
        Without misalignment.
    alignment : Alignment
        How well to align.
    others : tuple of str
        The other uncertain parameters.
    logarithmic : bool
        Whether the prior of the misalignment is uniform in its logarithm, as a figure then is.
    """

    angles: Floats
    drawn: Floats
    ends: Floats
    at_ends: Floats
    aligned: Reading
    alignment: Alignment
    others: tuple[str, ...]
    logarithmic: bool = False

    @property
    def certain(self) -> bool:
        """Whether the misalignment is certain, while other parameters are not."""
        return len(self.ends) == 1

    @property
    def counts(self) -> list[int]:
        """The number of tests with each reading, (4,)."""
        return [int(each) for each in np.isfinite(self.drawn).sum(axis=0)]

    @property
    def intervals(self) -> Floats:
        """95 % intervals of the readings of the tests that have one, (2, 4).

        Of fewer than 39 they are from the smallest to the largest, which hold less; NaN of none.
        """
        found = np.full((2, len(Reading._fields)), nan)
        for i, column in enumerate(self.drawn.T):
            values = column[np.isfinite(column)]
            if len(values) >= ENOUGH:
                found[:, i] = interval_95(values)
            elif len(values):
                found[:, i] = values.min(), values.max()
        return found


def read(slider: Slider) -> Reading:
    """Return the readings of a test from rest; NaN where it is cut, or ends before a slip."""
    prediction = predict(slider)
    return reading(prediction, partial(simulate_coarsely, slider, prediction, MOST_STEPS))


def reading(prediction: Prediction, simulate: Callable[[], SimulatedTest]) -> Reading:
    """Return the readings of a test, from its prediction and its simulation."""
    unknown = Reading(nan, nan, nan, prediction.amplitude)
    try:
        seen = simulate()
    except StictionError:
        return unknown
    if not seen.run.status.ok or seen.comes_to == LOADS:
        return unknown
    return Reading(peak(seen), kinetic(seen), creep_before_slip(seen), prediction.amplitude)


def budget(rig: Rig, progress: Progress) -> Budget:
    """Return the tolerance budget of a rig with uncertain parameters."""
    names, values = [*rig.priors], draw_values(rig)
    count = len(values[names[0]])
    ends, angles = np.array([rig.slider.phi]), np.full(count, rig.slider.phi)
    if "phi" in values:
        angles = values["phi"]
        ends = rig.priors["phi"].quantile(np.array([BOUNDS_95[0], 0.5, BOUNDS_95[1]]))
    rigs = [
        *(change(rig.slider, {name: values[name][i] for name in names}) for i in range(count)),
        *(change(rig.slider, {"phi": end}) for end in ends),
        turn_to(rig.slider, 0.0),
    ]
    found = read_all(rigs, lambda fraction: progress(0.7 * fraction))
    limit = alignment(rig.slider, found[-1][0], max(abs(ends - rig.slider.turn)))
    progress(1.0)
    others, turn = tuple(name for name in names if name != "phi"), rig.slider.turn
    at_ends, aligned = found[count : count + len(ends)], Reading(*found[-1])
    angles, ends = angles - turn, ends - turn
    even = getattr(rig.priors.get("phi"), "scale", "") == "log" and bool((ends > 0.0).all())
    return Budget(angles, found[:count], ends, at_ends, aligned, limit, others, even)


def draw_values(rig: Rig) -> dict[str, Floats]:
    """Return values (n,) of each uncertain parameter that the description allows together.

    They are the first of Sobol's sequence.
    """
    from scipy.stats.qmc import Sobol

    sequence, rows = Sobol(len(rig.priors), seed=0), np.empty((0, len(rig.priors)))
    for _ in range(MOST_ROUNDS):
        shares = sequence.random(DRAWS).T
        pairs = zip(rig.priors.values(), shares, strict=True)
        new = np.stack([prior.quantile(its) for prior, its in pairs], axis=1)
        taken = [is_allowed(rig.slider, dict(zip(rig.priors, row, strict=True))) for row in new]
        rows = np.concatenate([rows, new[taken]])[:DRAWS]
        if len(rows) == DRAWS:
            break
    return dict(zip(rig.priors, rows.T, strict=True))


def change(slider: Slider, values: dict[str, float]) -> Slider:
    """Return a slider with other parameters, in SI."""
    given = {name: quantity(slider, name, float(value)) for name, value in values.items()}
    return change_parameters(slider, given)


def turn_to(slider: Slider, misalignment: float) -> Slider:
    """Return a slider with this misalignment, rad."""
    return change(slider, {"phi": slider.turn + misalignment})


def read_all(rigs: list[Slider], progress: Progress) -> Floats:
    """Return the readings of several rigs, (n, 4)."""
    found = np.empty((len(rigs), len(Reading._fields)))

    work = partial(read_one, rigs)
    for done, (number, reading) in enumerate(Cores().results(work, range(len(rigs))), 1):
        found[number] = reading
        progress(done / len(rigs))
    return found


def read_one(rigs: list[Slider], number: int, _: Callable[[], bool]) -> tuple[int, Reading]:
    """Return the number of a rig, and its reading."""
    return number, read(rigs[number])


def alignment(slider: Slider, aligned: float, farthest: float) -> Alignment:
    """Return the misalignment at which the static coefficient has the allowed error.

    The error is relative to `aligned`, the coefficient that the rig reads without misalignment.
    Tests over a wide range show where it is exceeded on average, and further ones there, how it
    grows. A test that is off by more at a smaller angle, by chance, counts in that average.
    """

    def errors(angles: Floats) -> Floats:
        sides = np.copysign(angles, slider.misalignment).tolist()
        found = read_all([turn_to(slider, side) for side in sides], silent)
        return np.asarray(abs(found[:, 0] / aligned - 1.0))

    last = min(max(farthest, radians(0.5 * FARTHEST)), radians(FARTHEST))
    scan = np.geomspace(radians(NEAREST), last, SCAN)
    found = errors(scan)
    if found[0] > ALLOWED:
        nearer = np.radians(NEARER)
        scan, found = np.append(nearer, scan), np.append(errors(nearer), found)
    known = int(np.argmax(np.append(np.isnan(found), True)))  # up to what cannot be simulated
    scan, found, least = scan[:known], found[:known], float(found[0])
    over = np.flatnonzero(growing_mean(scan, found) > ALLOWED)
    if not len(over):
        first = min(scan[found > ALLOWED], default=nan)
        return Alignment(nan, float(scan[-1]) if known else 0.0, least, float(first))
    if over[0] == 0:
        return Alignment(nan, float(scan[0]), least)
    below, above = over[0] - 1, min(over[0] + 1, known - 1)
    fine = np.geomspace(scan[below], scan[above], FINE_ANGLES)[1:-1]
    angles, off = np.append(scan, fine), np.append(found, errors(fine))
    order = [at for at in np.argsort(angles) if np.isfinite(off[at])]
    angles, off = angles[order], off[order]
    angle, first = crossing(angles, off), min(angles[off > ALLOWED])
    count = int((angles < angle).sum())
    return Alignment(angle, float(scan[over[0]]), least, float(first), count)


def crossing(angles: Floats, errors: Floats) -> float:
    """Return the angle at which the mean of scattered errors passes the allowed error.

    Between two angles it is interpolated.
    """
    mean = growing_mean(angles, errors)
    over = np.flatnonzero(mean > ALLOWED)
    if not len(over) or over[0] == 0:
        return float(angles[0 if len(over) else -1])
    ends = slice(over[0] - 1, over[0] + 1)
    return float(np.interp(ALLOWED, mean[ends], angles[ends]))


def growing_mean(angles: Floats, errors: Floats) -> Floats:
    """Return the isotonic mean of scattered errors, which never decreases with the angle.

    It is their isotonic regression (Barlow et al., Statistical Inference under Order Restrictions,
    1972), over the logarithm of the angle: of tests that lie closer, each weighs less.
    """
    from scipy.optimize import isotonic_regression

    if len(angles) < 2:
        return errors
    mean: Floats = isotonic_regression(errors, weights=np.gradient(np.log(angles))).x
    return mean


def section(found: Budget) -> Section:
    """Return the budget as a section of a report."""
    static = in_words(found.aligned.static, "")
    lines = [
        limit(found.alignment),
        f"The error is relative to what this rig reads without misalignment, {static}, at the same "
        "drive, load and friction.",
        f"{_misalignment(found)} The last column holds 95 % of tests with parameters drawn from "
        f"their priors, as estimated from {len(found.drawn)}.",
    ]
    if found.others:
        start = "Uncertain" if found.certain else "Also uncertain"
        lines.append(
            f"{start}, there only: {', '.join(found.others)}. In the other columns they "
            "are in the middle of their priors."
        )
    if min(found.counts) < len(found.drawn):
        lines.append(
            "Some tests do not show every quantity, as where nothing slips: the last column is of "
            "those that do, with their number in brackets."
        )
    if any(0 < count < ENOUGH for count in found.counts):
        lines.append(
            f"Of fewer than {ENOUGH} it has the smallest and the largest, which hold less than "
            "95 % of others."
        )
    unread = int(sum(isnan(each) for each in found.drawn[:, Reading._fields.index("static")]))
    if unread:
        lines.append(f"{unread} of the tests could not be simulated to their end.")
    return Section(TITLE, lines, table(found))


def _misalignment(found: Budget) -> str:
    """Return the misalignment and its uncertainty, as a sentence."""
    ends = [in_words(end, "rad") for end in found.ends]
    if found.certain:
        return f"The misalignment is {ends[0]} throughout, as stated without an uncertainty."
    low, middle, high = ends
    return f"The misalignment is {middle}, with 95 % probability {low} to {high}."


def limit(found: Alignment) -> str:
    """Return the needed alignment, as a sentence."""
    share = percent(found.allowed)
    if not isnan(found.angle):
        angle, first = round_down(degrees(found.angle)), round_down(degrees(found.first))
        said = f"Align to better than {angle:g} deg to keep the error of mu_static below {share}."
        single = f" That is a mean: of the tests tried, some are off by more from {first:g} deg on."
        rare = (
            f" None of {found.nearer} tests at smaller angles is off by more, which does not "
            "exclude a narrow range in which it is."
        )
        return said + (single if first < angle else rare * (found.nearer > 0))
    if found.least > found.allowed:
        return (
            f"Alignment to {in_words(found.until, 'rad')} is not enough to keep the error of "
            f"mu_static below {share}: it is {percent(found.least, 3)} there."
        )
    if isnan(found.least):
        return f"Where the error of mu_static is {share} is not known: no test reaches its end."
    said = f"An error of mu_static of {share} is not reached up to {in_words(found.until, 'rad')}"
    if isnan(found.first):
        return f"{said}."
    first = round_down(degrees(found.first))
    return f"{said} on average; of the tests tried, some are off by more from {first:g} deg on."


def _interval(found: Budget, at: int, unit: str) -> str:
    """Return the interval of a reading in words, with the number of tests if some lack it."""
    count, total = found.counts[at], len(found.drawn)
    low, high = (in_words(end, unit) for end in found.intervals[:, at])
    said = low if count < 2 else f"{low} to {high}"
    return said if count in (0, total) else f"{said} ({count} of {total})"


def round_down(value: float) -> float:
    """Return a positive value, truncated to two digits.

    The largest force scatters with the phase of the transverse oscillation when the slip begins:
    more digits would differ with the smallest change of the rig.

    >>> round_down(2.397), round_down(0.0429)
    (2.3, 0.042)
    """
    return float(Decimal(value).normalize(Context(prec=2, rounding=ROUND_DOWN)))


def table(found: Budget) -> Table:
    """Return the readings without misalignment, over its range, and of all draws."""
    ends = tuple(f"at {in_words(end, 'rad')}" for end in found.ends)
    rows = []
    for i, (label, unit) in enumerate(ROWS):
        values = (in_words(each, unit) for each in (found.aligned[i], *found.at_ends[:, i]))
        rows.append((label, *values, _interval(found, i, unit)))
    return Table(("quantity", "aligned", *ends, "95 %"), rows)
