"""The misalignment implied by a creep curve."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import lru_cache
from math import cos, exp, inf, pi, sin
from typing import NamedTuple

import numpy as np

from stiction.analysis.creep.curve import Bins
from stiction.analysis.creep.least_squares import FEWEST_USED, THEORY, best_fit, used_bins
from stiction.analysis.creep.presliding import fit_presliding
from stiction.analysis.signals.correlated_noise import ERRORS_95
from stiction.arrays import TINY, Floats, xr
from stiction.errors import ResultError
from stiction.text.quantity.wording import with_error
from stiction.text.units import Radians

# Starts of fits: phi, rad, and excess over the peak
STARTS: tuple[tuple[float, float], ...] = (0.02, 0.02), (0.05, 0.005), (0.01, 0.1)
SIZES = 0.02, 0.01, 1e-4  # by which these, and the common error of the theory, are varied
# Weakenings that are tried, and how likely each is before. Where creep ends in a slip, friction may
# have fallen by any share of it by then, and not even the order of its fall is known; where
# the mass comes to slide, steep friction would have made it slip: 0 with an error of 0.1 is assumed
WEAKENINGS = dict.fromkeys((-0.1, 0.0, 0.02, 0.05, 0.1, 0.2, 0.4, 0.8, 1.6, 3.2, 6.4, 12.8), 1.0)
SLIDING = {w: exp(-0.5 * (w / 0.1) ** 2) for w in (-0.2, -0.1, 0.0, 0.1, 0.2)}
OFF = 0.1  # of the velocity: largest common error of the theory that is tried
# Angles theta (rad) at which creep is tabled: near zero, where only a trial of a fit comes, and far
ANGLES = np.concatenate([np.geomspace(1e-3, 0.5, 300), np.linspace(0.5, pi - 0.01, 300)[1:]])
SINE, COSINE = np.sin(ANGLES), np.cos(ANGLES)
STRETCH = 0.05, 1.0  # of the loading time: time to slip of the bins that are fitted
REST_SPEED = 1e-6  # of the drive velocity: slower is rest


class Misalignment(NamedTuple):
    """The misalignment implied by creep (rad), F_0 (N), and their standard errors.

    Under a measured load that varies F_0 is that at the record's `normal_load`.
    `stiffness` (N/m) is the fitted one, if any; `misfit` is the typical relative deviation of the
    creep from Eq. (7) beyond two standard errors, `scatter` the root mean square of all deviations
    in standard errors. `weakening` is -V F'(0)/F_0, the median of those under which the creep is as
    likely as it was seen, as phi and F_0 are; the errors of these are over all of them. `contact`
    is how many times as stiff as the spring a contact would be that creeps so by presliding alone,
    and `worse` by how much the sum of squares, in standard errors, is larger then.
    """

    phi: float
    phi_error: float
    F_0: float
    F_0_error: float
    stiffness: float = np.nan
    misfit: float = np.nan
    scatter: float = np.nan
    weakening: float = np.nan
    contact: float = np.nan
    worse: float = np.nan

    def __repr__(self) -> str:
        """Return angle and force with their errors."""
        phi = with_error(self.phi, self.phi_error, "rad")
        return f"<Misalignment: {phi}, F_0 = {with_error(self.F_0, self.F_0_error, 'N')}>"

    @property
    def interval(self) -> tuple[float, float]:
        """The 95 % interval of phi (rad), two standard errors to each side."""
        return self.phi - ERRORS_95 * self.phi_error, self.phi + ERRORS_95 * self.phi_error

    @property
    def stands_out(self) -> bool:
        """Whether phi differs from zero by more than two standard errors."""
        return abs(self.phi) > ERRORS_95 * self.phi_error


def fit_misalignment(
    curve: xr.Dataset,
    drive_velocity: float,
    stiffness: float,
    stretch: tuple[float, float] = STRETCH,
    stiffness_across: float = inf,
    mass: float = 0.0,
    weakenings: Mapping[float, float] = WEAKENINGS,
) -> Misalignment:
    """Fit the misalignment of Eq. (7) to a creep curve.

    By Eq. (7) the velocity depends on the spring force alone, independent of the start of loading:
    X' = V sin(phi) cos(theta - phi)/sin(theta), F = F_0 cos(theta). Least squares determine phi and
    F_0. Friction weakens with the slip speed |s| = V sin(phi)/sin(theta) of the creep, as
    F_0/(1 + weakening |s|/V), by as much as is not known: the result is the median over weakenings,
    each weighed by how well creep under it fits, and the error holds how far they are apart.
    Friction taken as constant makes F_0 too small, by up to 20 %.

    Eq. (7) supposes a spring across that is far stiffer, k_x/k_y << tan^2(phi). With
    `stiffness_across` the creep is that of both springs, and bins before its begin, where the mass
    still rests, are left out. It leaves out inertia, too: with `mass` friction carries the force
    less what accelerates the mass.

    Parameters
    ----------
    curve : Dataset
        Over ``bin``, from `mean_creep`, or one phase of `creep_curves`.
    drive_velocity, stiffness : float
        V, m/s, and k_x, N/m.
    stretch : tuple of float
        Range of the time to slip of the bins used, as shares of the loading time l_x/V; nearer
        to slip the inertia matters, which Eq. (7) neglects.
    stiffness_across : float, optional
        k_y, N/m.
    mass : float, optional
        m, kg.
    weakenings : mapping of float to float, optional
        How likely each weakening is before creep is seen: {0.0: 1.0} where friction is known to be
        constant. By default none and all of some decades are alike, as where a slip ends the creep.

    Returns
    -------
    Misalignment
        Its standard errors combine the curve's with a hundredth of the velocity for the theory:
        in each bin by itself, and in all of them together, which more bins do not average out.

    Raises
    ------
    ResultError
        If fewer than five bins lie in the stretch.

    References
    ----------
    Nakano & Popov, arXiv:2008.01854, Eqs. (6) and (7).

    Examples
    --------
    >>> import numpy as np, stiction as st
    >>> run = st.simulate(st.presets.nakano_popov_2020(), "20 s", sample_rate="2 kHz")
    >>> mean = st.analysis.mean_creep(st.analysis.creep_curves(run, st.analysis.find_cycles(run)))
    >>> found = st.analysis.fit_misalignment(mean, drive_velocity=1e-3, stiffness=1e3)
    >>> round(float(np.degrees(found.phi)), 1)
    1.0
    """
    peak = float(np.fmax.reduce(curve["force"].values, initial=0.0))
    loading_time = peak / stiffness / drive_velocity
    used = used_bins(curve, stretch[0] * loading_time, stretch[1] * loading_time)
    ratio = stiffness / stiffness_across
    if ratio > 0.0:
        used = _after_rest(used, drive_velocity)
    used = used._replace(force=used.force - mass * _acceleration(used))
    share = used._replace(
        velocity=used.velocity / drive_velocity,
        error=used.error / drive_velocity,
        force=used.force / peak,
    )
    trials, starts = list[_Trial](), STARTS
    for weakening in weakenings:
        trials.append(_fit(share, starts, weakening, ratio))
        starts = ((trials[-1].best[0], trials[-1].best[1]), STARTS[0])
    found, least = _over_weakenings(share, trials, weakenings, peak)
    alone = fit_presliding(share)
    worse = (alone.chi_square - least.chi_square) / least.excess
    return found._replace(contact=exp(alone.values[0]), worse=worse)


def implied_velocity(found: Misalignment, force: Floats, ratio: float = 0.0) -> Floats:
    """Return the creep over the drive's velocity that a misalignment implies at some forces.

    Forces are along the drive, N, at the load to which its F_0 belongs; beyond the largest, at
    which the mass slips, the result is NaN. The `ratio` is k_x/k_y.
    """
    its = turning_creep(found.phi, float(np.nan_to_num(found.weakening)), ratio)
    return np.asarray(np.interp(force / found.F_0, its.force, its.velocity, right=np.nan))


class _Trial(NamedTuple):
    """The best fit under one weakening: phi and F_0 over the peak, their variances, and creep.

    `best` are the fitted parameters, `chi_square` the sum of squares, `excess` that of a degree of
    freedom, if above one; `velocity` is that in the bins, over that of the drive.
    """

    known: Floats
    variance: Floats
    best: tuple[float, ...]
    chi_square: float
    excess: float
    velocity: Floats


def _fit(
    used: Bins, starts: Iterable[tuple[float, float]], weakening: float, ratio: float
) -> _Trial:
    """Return the best fit under a weakening, with springs of a ratio k_x/k_y.

    The force is that over the peak, the velocity that over the drive's. Fitted are phi, by how much
    the largest force of creep exceeds that of the bins, and the common error of the theory.
    """
    largest = float(used.force.max())

    def F_0(phi: float, excess: float) -> float:
        return float((largest + excess) / turning_creep(phi, weakening, ratio).force[-1])

    def velocity(phi: float, excess: float, off: float) -> Floats:
        force, speed = turning_creep(phi, weakening, ratio)
        share = used.force * (force[-1] / (largest + excess))
        return np.asarray((1.0 + off) * np.interp(share, force, speed))

    # below zero Eq. (7) creeps against the drive; with two springs it has its mirror image above
    low, high = (-1.5 if ratio == 0.0 else 0.0, 1e-6, -OFF), (1.5, 10.0, OFF)
    best = best_fit(
        lambda *known: np.append(velocity(*known), known[-1]),
        np.append(used.velocity, 0.0),
        np.append(used.error, THEORY),
        (tuple(np.clip((*start, 0.0), low, high).tolist()) for start in starts),
        (low, high),
        SIZES,
    )
    phi, excess, off = best.values
    known = np.array([phi, F_0(phi, excess)])
    moved = [[phi + SIZES[2], F_0(phi + SIZES[2], excess)], [phi, F_0(phi, excess + SIZES[2])]]
    slopes = np.subtract(moved, known) / SIZES[2]
    return _Trial(
        known,
        np.einsum("ik,ij,jk->k", slopes, best.covariance[:2, :2], slopes),
        best.values,
        best.chi_square,
        best.excess,
        velocity(phi, excess, off),
    )


def _over_weakenings(
    used: Bins, trials: list[_Trial], weakenings: Mapping[float, float], peak: float
) -> tuple[Misalignment, _Trial]:
    """Return the median over weakenings, and the best.

    Each is as likely as it was before, times the likelihood of the creep under it.
    """
    best = min(trials, key=lambda trial: trial.chi_square)
    worse = np.array([trial.chi_square - best.chi_square for trial in trials])
    likely = np.exp(-0.5 * worse / best.excess) * list(weakenings.values())
    likely /= likely.sum()
    known = np.array([trial.known for trial in trials])
    phi, F_0 = middle = np.array([_median(each, likely) for each in known.T])
    variance = [trial.variance for trial in trials] + (known - middle) ** 2
    phi_error, F_0_error = np.sqrt(likely @ variance)
    off = np.abs(used.velocity - best.velocity)
    size = np.maximum(np.maximum(np.abs(used.velocity), np.abs(best.velocity)), TINY)
    middle_of_all = Misalignment(
        Radians(phi),
        float(phi_error),
        float(F_0) * peak,
        float(F_0_error) * peak,
        misfit=float(np.median(np.maximum(off - ERRORS_95 * used.error, 0.0) / size)),
        scatter=float(np.sqrt(np.mean((off / used.error) ** 2))),
        weakening=_median(np.array(list(weakenings)), likely),
    )
    return middle_of_all, best


def _median(values: Floats, weights: Floats) -> float:
    """Return the value below which half of the weight lies, between the nearest two."""
    order = np.argsort(values)
    below = np.cumsum(weights[order]) - 0.5 * weights[order]
    return float(np.interp(0.5, below, values[order]))


def _acceleration(used: Bins) -> Floats:
    """Return the acceleration in each bin (m/s^2)."""
    return np.asarray(np.gradient(used.velocity, -0.5 * (used.begin + used.end)))


def _after_rest(used: Bins, drive_velocity: float) -> Bins:
    """Return the bins after the last rest, far from slip to near: creep begins in one of them."""
    begin = used.begin
    rests = begin[np.abs(used.velocity) < REST_SPEED * drive_velocity]
    if not len(rests):
        return used
    later = begin < rests.min()
    later &= begin < begin[later].max(initial=0.0)
    if later.sum() < FEWEST_USED:
        raise ResultError(
            f"not determined: the mass creeps in only {later.sum()} bins of the curve, and rests "
            "before"
        )
    return used.some(later)


class TurningCreep(NamedTuple):
    """Creep while friction turns: the rising force over F_0, and the velocity over the drive's."""

    force: Floats
    velocity: Floats


@lru_cache(maxsize=2)  # derivatives by other parameters ask again for the same angle
def turning_creep(phi: float, weakening: float, ratio: float) -> TurningCreep:
    """Return the slow creep up to the largest force, at which the mass slips.

    The force on both springs is friction times (cos(theta), sin(theta)), and slip is along it:

        F_0/k_x theta' = -V sin(theta - phi)/(sin^2(theta) + r cos^2(theta)), r = k_x/k_y,
        |s| = V [cos(theta - phi) - (1 - r) sin(theta - phi) sin(theta) cos(theta)
                 /(sin^2(theta) + r cos^2(theta))], X' = |s| cos(theta - phi).

    With r = 0 this is Eq. (7), |s| = V sin(phi)/sin(theta). Friction is F_0/(1 + weakening |s|/V),
    as in `crept_force`.
    """
    along = COSINE * cos(phi) + SINE * sin(phi)  # cos(theta - phi)
    across = SINE * cos(phi) - COSINE * sin(phi)
    slip = along - across * _turn_by_springs(ratio)  # below zero against the force
    force = COSINE / np.maximum(1.0 + weakening * np.abs(slip), TINY)
    slips = int(np.argmax(force))
    rising, velocity = force[slips:][::-1], (along * slip)[slips:][::-1]
    found = TurningCreep(np.maximum.accumulate(rising), velocity)
    for each in found:
        each.setflags(write=False)  # the next call with the same angle returns them again
    return found


@lru_cache(maxsize=1)
def _turn_by_springs(ratio: float) -> Floats:
    """Return by how much the spring across turns the slip, for springs of a ratio k_x/k_y."""
    return np.asarray((1.0 - ratio) * SINE * COSINE / (SINE**2 + ratio * COSINE**2))
