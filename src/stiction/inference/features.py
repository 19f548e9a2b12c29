"""Features of a record with cycles: some dimensionless numbers in place of thousands of samples."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from stiction.arrays import Floats
from stiction.study.variables.features import zigzag

Indices = NDArray[np.int64]

# shares of a loading, narrow where creep accelerates towards the slip
EDGES = np.array([0.0, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.86, 0.91, 0.95, 0.98, 1.0])
# free periods of the mass after a peak and after a trough: the slip, and how the force rises again
SLIP = np.array([1 / 12, 1 / 6, 1 / 3, 1 / 2])
REBOUND = np.array([1 / 6, 1 / 3, 1 / 2, 1.0])
DROP = 0.3  # of the span of the force once it is loaded: a smaller fall is not a slip
TAILS = (2.0, 98.0)  # percentiles that bound the span, so that a spike does not
OF_NOISE = 8.0  # standard deviations of noise: white noise in a cycle does not reach so far
USED = ("force", "force_across", "position")  # channels, in the order of their features
BEND = "bend"  # name of the features that say how far loading is from straight
LEAST_CYCLES = 6
CREEP = (0.1, 0.95)  # shares of a loading in which the misalignment is sought
ABOVE = 1.003  # the friction force at rest over the largest force along the spring
SMALL = 1e-9  # of the scale: replaces zero in a logarithm


class FeatureScale(NamedTuple):
    """What features are relative to, from the middle of the priors.

    Parameters
    ----------
    force : float
        Friction force at rest, N.
    loading : float
        Rate of the force while the mass is at rest, N/s.
    period : float
        Of the mass on the spring along the drive, s.
    velocity : float
        Of the drive, m/s.
    drift : float
        Of the load cell's zero, N/s, as it is stated; without it trends are no features.
    """

    force: float
    loading: float
    period: float
    velocity: float
    drift: float = 0.0


class Cycles(NamedTuple):
    """Cycles of a sampled force: indices of the trough before, the peak, and the trough after."""

    before: Indices
    peak: Indices
    after: Indices


def find_cycles(force: Floats, noise: float = 0.0) -> Cycles:
    """Return the whole cycles of a force, from trough over peak to trough.

    The first begins at the end of a slip: a least force after no slip is where the record begins,
    as at an unloaded spring, whose loading is longer than that of any cycle. How high a fall must
    be to be a slip does not depend on this loading either.

    Parameters
    ----------
    force : ndarray
        (n,), of equally spaced samples.
    noise : float, optional
        Standard deviation of its noise.

    Examples
    --------
    >>> saw = np.tile(np.r_[0.0:1.0:10j, 0.6, 0.3], 4)
    >>> find_cycles(saw).peak, find_cycles(np.r_[0.1, saw]).peak
    (array([21, 33]), array([22, 34]))
    >>> find_cycles(np.r_[-9.0:0.0:100j, saw]).peak
    array([121, 133])
    """
    low, high = np.percentile(force[end_of_loading(force) :], TAILS)
    height = max(DROP * float(high - low), OF_NOISE * noise)
    turns = zigzag(force, height)
    if len(turns) and np.ptp(force[: turns[0] + 1]) <= height:
        turns = turns[1:]
    if len(turns) > 1 and force[turns[0]] > force[turns[1]]:
        turns = turns[1:]
    count = max((len(turns) - 1) // 2, 0)
    whole = turns[: 2 * count + 1]
    return Cycles(whole[:-1:2], whole[1::2], whole[2::2])


def end_of_loading(force: Floats) -> int:
    """Return the first sample that is as large as half of those after it; or as small.

    A force that goes to and fro from the beginning reaches it within the first cycle.

    >>> saw = np.tile(np.r_[0.0:1.0:5j, 0.5], 4)
    >>> end_of_loading(saw), end_of_loading(np.r_[-9.0:0.0:10j, saw])
    (2, 12)
    """
    force = force if force[0] <= np.median(force) else -force
    start = 0
    while onwards := int(np.argmax(force[start:] >= np.median(force[start:]))):
        start += onwards
    return start


def features(
    step: float, channels: dict[str, Floats], scale: FeatureScale, cycles: Cycles
) -> Floats:
    """Return the features of equally spaced samples.

    Parameters
    ----------
    step : float
        Time between samples, s.
    channels : dict of str to ndarray
        (n,) each: ``force``, and where measured ``force_across`` and ``position``.
    scale : FeatureScale
        What they are relative to.
    cycles : Cycles
        Of the force.
    """
    return np.concatenate([part.values for part in parts(step, channels, scale, cycles)])


class FeatureGroup(NamedTuple):
    """Features of one kind: what they describe, the channels they need, and their values."""

    name: str
    needs: frozenset[str]
    values: list[float]


def parts(
    step: float, channels: dict[str, Floats], scale: FeatureScale, cycles: Cycles
) -> Iterator[FeatureGroup]:
    """Yield the features kind by kind."""
    loadings = Loadings(cycles)
    force, across, position = (frozenset({name} & set(channels)) for name in USED)
    yield FeatureGroup("cycles", force, of_cycles(step, channels["force"], scale, cycles))
    yield FeatureGroup("loading", force, of_loading(step, channels["force"], scale, loadings))
    yield FeatureGroup(BEND, force, of_bend(channels["force"], loadings))
    yield FeatureGroup("slip", force, of_slip(step, channels["force"], scale, cycles))
    if scale.drift:
        yield FeatureGroup("trend", force, of_trend(step, channels["force"], scale, cycles))
    if across:
        yield FeatureGroup("force across", across, of_force_across(step, channels, scale, loadings))
    if position:
        yield FeatureGroup("position", position, of_position(step, channels, scale, loadings))
    if across and position:
        yield FeatureGroup("both", across | position, of_both(step, channels, scale, loadings))


class Loadings:
    """The samples of all loadings, from trough to peak, end to end."""

    def __init__(self, cycles: Cycles) -> None:
        """Find the samples of each loading and their shares of its time."""
        count = cycles.peak - cycles.before
        self.count = count + 1
        self.first = np.concatenate([[0], np.cumsum(self.count)[:-1]])
        self.cycle = np.repeat(np.arange(len(count)), self.count)
        self.number = np.arange(int(self.count.sum())) - self.first[self.cycle]
        self.index = cycles.before[self.cycle] + self.number
        self.share = self.number / count[self.cycle]
        part = np.searchsorted(EDGES, self.share, side="right") - 1
        self.part = np.minimum(part, len(EDGES) - 2)
        self.filling = np.bincount(self.part, minlength=len(EDGES) - 1)

    def averages(self, values: Floats) -> Floats:
        """Return the average over all loadings in each part."""
        total = np.bincount(self.part, values, minlength=len(EDGES) - 1)
        held = self.filling > 0
        middle = 0.5 * (EDGES[1:] + EDGES[:-1])
        return np.asarray(np.interp(middle, middle[held], total[held] / self.filling[held]))

    def integral(self, values: Floats, step: float) -> Floats:
        """Return the integral of values from the beginning of each loading."""
        total = np.cumsum(values) - 0.5 * values
        return np.asarray(step * (total - total[self.first][self.cycle]))

    def regression(self, values: Floats, *columns: Floats) -> Floats:
        """Return the slopes of values over columns, with a constant of its own for each loading."""
        within = (self.share > CREEP[0]) & (self.share < CREEP[1])
        cycle = self.cycle[within]
        filling = np.maximum(np.bincount(cycle, minlength=len(self.count)), 1)

        def centred(each: Floats) -> Floats:
            inside = each[within]
            means = np.bincount(cycle, inside, minlength=len(self.count)) / filling
            return np.asarray(inside - means[cycle])

        matrix = np.stack([centred(each) for each in columns], axis=1)
        slopes = np.linalg.lstsq(matrix, centred(values), rcond=None)[0]
        return np.asarray(slopes, dtype=np.float64)


def of_cycles(step: float, force: Floats, scale: FeatureScale, cycles: Cycles) -> list[float]:
    """Return size, length and scatter of the cycles, and how these hang together."""
    peak, trough = force[cycles.peak], force[cycles.after]
    rise, fall = cycles.peak - cycles.before, cycles.after - cycles.peak
    drop = peak - trough
    loading = rise * step * scale.loading / scale.force
    return [
        peak.mean() / scale.force,
        logarithm(drop.mean() / scale.force),
        logarithm(loading.mean()),
        logarithm(fall.mean() * step / scale.period),
        logarithm(peak.std() / scale.force),
        logarithm(trough.std() / scale.force),
        logarithm(drop.std() / scale.force),
        logarithm(loading.std()),
        correlation(peak, trough),
        correlation(peak[1:] - trough[:-1], rise[1:].astype(np.float64)),
        correlation(trough[:-1], peak[1:]),
    ]


def of_loading(step: float, force: Floats, scale: FeatureScale, loadings: Loadings) -> list[float]:
    """Return the loading rate, by how much creep lowers it, and which kind of creep.

    Where the force leans by theta, creep goes as cot theta (Eq. (7) of Nakano & Popov). Bristles
    under a steadily growing force yield as 1/(1 - f), f being the force over that at which they
    slip (dz/dt = v (1 - f): C. Canudas de Wit et al., IEEE Trans. Autom. Control 40, 419 (1995)).
    """
    f = force[loadings.index]
    time = step * loadings.number
    peak = f[loadings.first + loadings.count - 1][loadings.cycle]
    lean = np.clip(f / (ABOVE * peak), 0.0, 1.0 / ABOVE)
    way = loadings.integral(lean / np.sqrt(1.0 - lean * lean), step)
    yielding = loadings.integral(1.0 / (1.0 - lean), step)
    rate, slowed = loadings.regression(f, time, way)
    beside, *kinds = loadings.regression(f, time, way, yielding) / scale.loading
    return [
        logarithm(rate / scale.loading), -slowed / scale.loading, beside, *np.cbrt(kinds)
    ]  # fmt: skip


def of_bend(force: Floats, loadings: Loadings) -> list[float]:
    """Return how far the loading is from a straight line, over its rise, in each of its parts."""
    f = force[loadings.index]
    first, last = f[loadings.first], f[loadings.first + loadings.count - 1]
    height = (f - first[loadings.cycle]) / (last - first)[loadings.cycle]
    return [*loadings.averages(height - loadings.share)]


def of_slip(step: float, force: Floats, scale: FeatureScale, cycles: Cycles) -> list[float]:
    """Return the share of the fall that is done after a peak, and of the rise after a trough.

    Friction that falls with speed sets how fast the force falls, bristles how it rises again.
    """
    period, number = scale.period / step, np.arange(len(force))

    def change(begin: Indices, end: Indices, periods: Floats) -> Floats:
        start = force[begin][:, None]
        later = np.interp(begin[:, None] + period * periods, number, force)
        return np.asarray(((later - start) / (force[end][:, None] - start)).mean(axis=0))

    return [
        *change(cycles.peak, cycles.after, SLIP),
        *change(cycles.before, cycles.peak, REBOUND),
    ]  # fmt: skip


def of_trend(step: float, force: Floats, scale: FeatureScale, cycles: Cycles) -> list[float]:
    """Return the trend of peaks, and that of drops, which a zero that drifts leaves as they are."""
    peak = force[cycles.peak]
    trends = np.stack([peak, peak - force[cycles.after]], axis=1)
    return [*np.polyfit(step * cycles.peak, trends, 1)[0] / scale.drift]


def of_force_across(
    step: float, channels: dict[str, Floats], scale: FeatureScale, loadings: Loadings
) -> list[float]:
    """Return the course of the force across in a loading, and the misalignment from both forces.

    In creep the force's rate along the spring is k_x V (cos phi - sin phi cot theta) while the
    force leans by theta, the stiff spring hardly moving (Eq. (7) of Nakano & Popov): two slopes,
    of which the quotient is tan phi.
    """
    along, across = (channels[name][loadings.index] for name in ("force", "force_across"))
    least = 0.02 * scale.force
    aside = np.where(np.abs(across) < least, np.copysign(least, across), across)
    way = loadings.integral(along / aside, step)
    rate, slowed = loadings.regression(along, step * loadings.number, way)
    tangent = -slowed / rate if rate else 0.0  # too few samples in each loading
    course = loadings.averages(across / scale.force)
    ends = across[loadings.first + loadings.count - 1] / scale.force
    return [
        logarithm(abs(tangent)), np.sign(tangent), logarithm(ends.std()), *course,
    ]  # fmt: skip


def of_position(
    step: float, channels: dict[str, Floats], scale: FeatureScale, loadings: Loadings
) -> list[float]:
    """Return the creep in a loading, the stiffness, and the misalignment from both.

    With the friction force at rest a little above the largest force along the spring, the mass
    creeps by V tan(phi) cot(theta), theta being the force's lean.
    """
    force, position = (channels[name][loadings.index] for name in ("force", "position"))
    first = position[loadings.first][loadings.cycle]
    moved = (position - first) / (scale.velocity * step * (loadings.count - 1)[loadings.cycle])
    time = step * loadings.number
    stiffness = loadings.regression(force, scale.velocity * time - position)[0]
    peak = force[loadings.first + loadings.count - 1][loadings.cycle]
    lean = np.clip(force / (ABOVE * peak), 0.0, 1.0 / ABOVE)
    way = loadings.integral(lean / np.sqrt(1.0 - lean * lean), step)
    creep = loadings.regression(position, way)[0] / scale.velocity
    return [
        logarithm(stiffness * scale.velocity / scale.loading),
        logarithm(abs(creep)),
        *(np.sign(each) * abs(each) ** 0.5 for each in loadings.averages(moved)),
    ]


def of_both(
    step: float, channels: dict[str, Floats], scale: FeatureScale, loadings: Loadings
) -> list[float]:
    """Return the misalignment from the creep and the measured lean of the force.

    X' = V sin(phi) cos(theta - phi)/sin(theta) = V (sin(phi) cos(phi) cot(theta) + sin(phi)^2), by
    Eq. (7) of Nakano & Popov; theta from both forces, whatever stiffness and friction are.
    """
    along, across, position = (channels[name][loadings.index] for name in USED)
    least = 0.02 * scale.force
    aside = np.where(np.abs(across) < least, np.copysign(least, across), across)
    way = loadings.integral(along / aside, step)
    alone = loadings.regression(position, way)[0] / scale.velocity
    with_time = loadings.regression(position, way, step * loadings.number)[0] / scale.velocity
    return [logarithm(abs(alone)), logarithm(abs(with_time))]


def logarithm(value: float) -> float:
    """Return a logarithm that is finite for zero and below."""
    return float(np.log(max(value, SMALL)))


def correlation(a: Floats, b: Floats) -> float:
    """Return the correlation coefficient; 0 where one of both is constant."""
    a, b = a - a.mean(), b - b.mean()
    size = float(np.sqrt((a @ a) * (b @ b)))
    return float(a @ b) / size if size > 0.0 else 0.0
