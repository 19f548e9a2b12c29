"""Features of a record with cycles: some dimensionless numbers in place of thousands of samples."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from stiction.arrays import Floats, Indices
from stiction.inference.cycles import Cycles

# shares of a loading, narrow where creep accelerates towards the slip
EDGES = np.array([0.0, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.86, 0.91, 0.95, 0.98, 1.0])
# free periods of the mass after a peak and after a trough: the slip, and how the force rises again
SLIP = np.array([1 / 12, 1 / 6, 1 / 3, 1 / 2])
REBOUND = np.array([1 / 6, 1 / 3, 1 / 2, 1.0])
USED = ("force", "force_across", "position")  # channels, in the order of their features
BEND = "bend"  # name of the features that say how far loading is from straight
SHAPE = (BEND, "slip")  # names of those that the rate of loading does not enter
DROP, LOADING = 1, 2  # places of the logarithms of mean drop and mean loading time, of all features
MIDDLES: Floats = 0.5 * (EDGES[1:] + EDGES[:-1])  # of these parts
CREEP = (0.1, 0.95)  # shares of a loading in which the misalignment is sought
ABOVE = 1.003  # the friction force at rest over the largest force along the spring
LEAST_ACROSS = 0.02  # of the friction force at rest: a smaller force across tells no direction
SMALL = 1e-9  # of the scale: replaces zero in a logarithm


class FeatureScale(NamedTuple):
    """The scales of the features, from the middle of the priors."""

    force: float  # friction force at rest, N
    loading: float  # rate of the force while the mass is at rest, N/s
    period: float  # of the mass on the spring along the drive, s
    velocity: float  # of the drive, m/s
    # of the load cell's zero, N/s, as it is stated; without it trends are not features
    drift: float = 0.0


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
    """Features of one kind: its name, the channels they need, and their values."""

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
        return np.asarray(np.interp(MIDDLES, MIDDLES[held], total[held] / self.filling[held]))

    def integral(self, values: Floats, step: float) -> Floats:
        """Return the integral of values from the beginning of each loading."""
        total = np.cumsum(values) - 0.5 * values
        return np.asarray(step * (total - total[self.first][self.cycle]))

    def lean(self, along: Floats) -> Floats:
        """Return cos(theta) if friction is a little above the largest force of each loading.

        `along` are the forces along the spring (N) at these samples.
        """
        peak = along[self.first + self.count - 1][self.cycle]
        return np.asarray(np.clip(along / (ABOVE * peak), 0.0, 1.0 / ABOVE))

    def way(self, along: Floats, step: float) -> Floats:
        """Return the integral of cot(theta), theta from the force along the spring alone, s."""
        lean = self.lean(along)
        return self.integral(lean / np.sqrt(1.0 - lean * lean), step)

    def measured_way(self, along: Floats, across: Floats, friction: float, step: float) -> Floats:
        """Return the integral of cot(theta), theta from both forces, s."""
        least = LEAST_ACROSS * friction
        aside = np.where(np.abs(across) < least, np.copysign(least, across), across)
        return self.integral(along / aside, step)

    def regression(self, values: Floats, *columns: Floats) -> Floats:
        """Return the slopes of values over columns, with a separate constant for each loading."""
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
    """Return the size, length and scatter of the cycles, and the correlations between them."""
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
    """Return the loading rate, its reduction by creep, and the kind of creep.

    Where the force leans by theta, creep goes as cot theta (Eq. (7) of Nakano & Popov). Bristles
    under a steadily growing force yield as 1/(1 - f), f being the force over that at which they
    slip (dz/dt = v (1 - f): C. Canudas de Wit et al., IEEE Trans. Autom. Control 40, 419 (1995)).
    """
    f = force[loadings.index]
    time = step * loadings.number
    way = loadings.way(f, step)
    yielding = loadings.integral(1.0 / (1.0 - loadings.lean(f)), step)
    rate, slowed = loadings.regression(f, time, way)
    beside, *kinds = loadings.regression(f, time, way, yielding) / scale.loading
    return [
        logarithm(rate / scale.loading), -slowed / scale.loading, beside, *np.cbrt(kinds)
    ]  # fmt: skip


def of_bend(force: Floats, loadings: Loadings) -> list[float]:
    """Return the loading's departure from a straight line, over its rise, in each of its parts."""
    f = force[loadings.index]
    first, last = f[loadings.first], f[loadings.first + loadings.count - 1]
    height = (f - first[loadings.cycle]) / (last - first)[loadings.cycle]
    return [*loadings.averages(height - loadings.share)]


def of_slip(step: float, force: Floats, scale: FeatureScale, cycles: Cycles) -> list[float]:
    """Return the completed share of the fall after a peak, and of the rise after a trough.

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
    """Return the trend of the peaks and that of the drops; a drift of the zero changes no drop."""
    peak = force[cycles.peak]
    trends = np.stack([peak, peak - force[cycles.after]], axis=1)
    return [*np.polyfit(step * cycles.peak, trends, 1)[0] / scale.drift]


def of_force_across(
    step: float, channels: dict[str, Floats], scale: FeatureScale, loadings: Loadings
) -> list[float]:
    """Return the force across during a loading, and the misalignment from both forces.

    In creep the force's rate along the spring is k_x V (cos phi - sin phi cot theta) while the
    force leans by theta, the stiff spring hardly moving (Eq. (7) of Nakano & Popov): two slopes,
    of which the quotient is tan phi.
    """
    along, across = (channels[name][loadings.index] for name in ("force", "force_across"))
    way = loadings.measured_way(along, across, scale.force, step)
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
    creep = loadings.regression(position, loadings.way(force, step))[0] / scale.velocity
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
    way = loadings.measured_way(along, across, scale.force, step)
    alone = loadings.regression(position, way)[0] / scale.velocity
    with_time = loadings.regression(position, way, step * loadings.number)[0] / scale.velocity
    return [logarithm(abs(alone)), logarithm(abs(with_time))]


def logarithm(value: float) -> float:
    """Return a logarithm that is finite for zero and below."""
    return float(np.log(max(value, SMALL)))


def correlation(a: Floats, b: Floats) -> float:
    """Return the correlation coefficient; 0 if one of the two is constant."""
    a, b = a - a.mean(), b - b.mean()
    size = float(np.sqrt((a @ a) * (b @ b)))
    return float(a @ b) / size if size > 0.0 else 0.0
