"""Joint inversion of a step of the drive: a, b and D_c of a rate-and-state law, and their errors.

The curve of a slider on the rig's own spring is fitted by least squares to all samples (L. A.
Reinen & J. D. Weeks, J. Geophys. Res. 98, 15937 (1993)). Noise of a force is not white, and no law
is quite that of a rock: how far neighbouring residuals deviate together is seen in the first terms
of their cosine transform, and the errors are those of such a fit.
"""

from __future__ import annotations

from math import exp, hypot, inf, log, nan, sqrt
from typing import Any, NamedTuple

import numpy as np

from stiction.analysis.protocols.spring_slider import Law, SpringSlider, friction_after_a_step
from stiction.arrays import TINY, Floats

PARAMETERS = 4  # level before the step, a, D_c, a - b
FEWEST = 8  # samples of a fit
BINS_PER_E_FOLD = 200  # of the time since the step, in which samples are averaged
MODES = 16  # terms of the cosine transform of residuals: the slow ones
KNOWN = 1 / 5  # of a value: its standard error, up to which the fit is as good as linear
E_FOLDS = 3.0  # of what evolves, from one sample to the next, of which something is still seen
BEYOND = 10.0  # times of the least and the largest D_c that are seen: where it is sought
BY_CHANCE = 3.0  # ratio of variances: once in a thousand, by F with 12 and 100 degrees of freedom
MISSED = 0.01  # of all change of friction: a curve that is farther off is not that of the law
NOISIER = 10.0  # by which the variance of noise may grow with the step
# Errors of parameters of a curve that misses the points, over those by the residuals; found, not
# derived. One of the laws ageing, slip and Perrin's fitted to another missed on 116 random rigs:
# D_c was off by 12 times its error in the median, by 5 to 19 in eight of ten, by 45 at most
AMISS = 15.0
FIRST = tuple((by_a, by_D) for by_D in (0.01, 0.03, 0.1, 0.3, 1.0, 3.0) for by_a in (1.0, 1.6, 3.0))
STARTS = 2  # of these from which a fit begins at most: until one goes through the points
CHANGE = 1e-4  # of a parameter, for a derivative


class StepData(NamedTuple):
    """A step of the drive as it is fitted.

    Attributes
    ----------
    time : float
        s.
    rig : SpringSlider
        What is known of it.
    slip : ndarray
        (n,), travel of the drive since the step, m.
    mu : ndarray
        (n,), spring force over load.
    before : ndarray
        (l,), the same in steady sliding before the step.
    after : float
        Where it is steady after the step, or its mean in the end of the data.
    noise : float
        What all samples may be off by together: rounding, or the tolerance of a run.
    travel_before : float
        Mean travel of the drive, since the step, of the samples before it, m: negative.
    trend_error : float
        Standard error of the trend over the travel that `mu` and `before` are freed of, 1/m.
    """

    time: float
    rig: SpringSlider
    slip: Floats
    mu: Floats
    before: Floats
    after: float
    noise: float
    travel_before: float = 0.0
    trend_error: float = 0.0

    @property
    def level(self) -> float:
        """Mean before the step."""
        return float(self.before.mean())


class Inversion(NamedTuple):
    """A fitted law.

    Attributes
    ----------
    a, b, D_c : float
        m for D_c; NaN where they are not known.
    a_error, b_error, D_c_error : float
        Standard errors.
    square, variance : float
        Sum of squared residuals, and their variance; NaN without a fit.
    misses : bool
        Whether the curve misses the samples by more than they scatter; of parameters that are NaN,
        whether they are so for that.
    fit : ndarray
        (n,), the curve at the samples; NaN without it.
    """

    a: float
    a_error: float
    b: float
    b_error: float
    D_c: float
    D_c_error: float
    square: float
    variance: float
    misses: bool
    fit: Floats


class _Problem(NamedTuple):
    """Averages over bins, and the weights of these: the first is that before the step.

    `shortest` is the slip from one sample to the next, m: what evolves within it is not seen.
    `found` are the deviations at all parameters for which they were computed.
    """

    data: StepData
    law: Law
    slip: Floats
    mu: Floats
    weight: Floats
    shortest: float
    found: dict[bytes, Floats]

    @property
    def longest(self) -> float:
        """Slip since the step, m."""
        return float(self.data.slip[-1])

    def curve(self, at: Floats, x: Floats) -> Floats:
        """Return friction at slips `x`; NaN where the slip runs away, or D_c is out of sight."""
        level, log_a, log_D, change = at.tolist()
        rig, D_c, found = self.data.rig, exp(min(log_D, 100.0)), None
        if self.shortest / BEYOND < D_c < self.longest * BEYOND and log_a < 0.0:
            a = exp(log_a)
            found = friction_after_a_step(rig, self.law, a, a - change, D_c, x)
        if found is None:
            return np.full(len(x), nan)
        return np.asarray(level + change * log(rig.ratio) + found)

    @property
    def tilt(self) -> Floats:
        """Weighted deviations by the standard error of the trend."""
        travel = np.concatenate([[self.data.travel_before], self.slip])
        return np.asarray(self.data.trend_error * np.sqrt(self.weight) * travel)

    def residuals(self, at: Floats) -> Floats:
        """Return the weighted deviations of a curve with these parameters.

        A step of the fit, its derivatives and its verdict all ask for those at the same place, of
        which each is a solution of a differential equation.
        """
        place = at.tobytes()
        if place not in self.found:
            model = np.concatenate([at[:1], self.curve(at, self.slip)])
            self.found[place] = np.asarray(np.sqrt(self.weight) * (model - self.mu))
        return self.found[place].copy()

    def largest(self, off: Floats) -> float:
        """Return the largest of weighted deviations, as a share of all change of friction."""
        return float(np.abs(off / np.sqrt(self.weight[1:])).max() / np.ptp(self.mu))

    def slopes(self, at: Floats) -> Floats:
        """Return the derivatives of the residuals by the parameters, (n, 4)."""
        here, columns = self.residuals(at), [np.sqrt(self.weight)]
        for which in range(1, PARAMETERS):
            scale = max(abs(at[which]), 1e-3) if which == PARAMETERS - 1 else 1.0
            for by in (CHANGE * scale, -CHANGE * scale):
                near = self.residuals(at + by * np.eye(PARAMETERS)[which])
                if np.isfinite(near).all():
                    break
            columns.append((near - here) / by)
        return np.stack(columns, axis=1)


def unknown(samples: int) -> Inversion:
    """Return the fit of a step of which nothing is known but its samples."""
    return Inversion(nan, nan, nan, nan, nan, nan, nan, nan, False, np.full(samples, nan))


def invert(data: StepData, law: Law) -> Inversion:
    """Fit a law to a step; what the data do not determine is NaN."""
    from scipy.optimize import least_squares

    if len(data.mu) < FEWEST or not np.isfinite(data.rig.stiffness):
        return unknown(len(data.mu))
    problem, best, least = _problem_of(data, law), None, inf
    minimised: Any = least_squares
    for start in _starts(problem):
        found = minimised(
            problem.residuals, start, lambda at: np.nan_to_num(problem.slopes(at)),
            x_scale="jac", max_nfev=20, xtol=1e-8, ftol=1e-8,
        )  # fmt: skip
        if found.cost < least:
            best, least = found.x, float(found.cost)
        if best is not None and problem.largest(_slow_part(problem.residuals(best)[1:])) < MISSED:
            break
    return unknown(len(data.mu)) if best is None else _verdict(problem, best)


def _problem_of(data: StepData, law: Law) -> _Problem:
    """Return means of samples over times that are short beside the time since the step."""
    slip = np.maximum(data.slip, 0.0)
    width = np.maximum(float(np.median(np.diff(slip))), slip / BINS_PER_E_FOLD)
    place = np.concatenate([[0.0], np.cumsum(np.diff(slip) / width[1:])])
    # a sample that is alone in its bin stays as it is
    firsts = np.flatnonzero(np.diff(np.floor(place + 1e-9), prepend=-1.0))
    count = np.diff(firsts, append=len(slip))
    means = [np.add.reduceat(each, firsts) / count for each in (slip, data.mu)]
    weight = np.concatenate([[float(len(data.before))], count])
    mu, shortest = np.concatenate([[data.level], means[1]]), float(np.median(np.diff(data.slip)))
    return _Problem(data, law, means[0], mu, weight, shortest, {})


def _starts(problem: _Problem) -> list[Floats]:
    """Return parameters near those that are sought, the best first; none if none is near."""
    data, mu = problem.data, problem.mu[1:]
    by, up = log(data.rig.ratio), 1.0 if data.rig.ratio > 1.0 else -1.0
    peak = int((up * mu).argmax())
    change = (data.after - data.level) / by
    passed = np.abs(mu[peak:] - mu[peak]) > (1.0 - exp(-1.0)) * abs(mu[peak] - data.after)
    far = problem.slip[peak + int(passed.argmax())] if passed.any() else problem.slip[-1]
    guess = float(far - problem.slip[peak]) or float(problem.slip[-1]) / len(mu)
    least = max((mu[peak] - data.level) / by, 0.1 * abs(change))
    if not (np.ptp(mu) > 0.0 and least > 0.0):
        return []
    slowest = max(-change, 0.0) / data.rig.stiffness  # D_c below which sliding is unstable
    found: list[tuple[float, int, Floats]] = []
    for by_a, by_D in FIRST:
        at = np.array([data.level, log(by_a * least), log(by_D * guess + 1.05 * slowest), change])
        off = problem.residuals(at)
        if np.isfinite(off).all():
            found.append((float(off @ off), len(found), at))
    return [at for _, _, at in sorted(found)[:STARTS]]


def _verdict(problem: _Problem, at: Floats) -> Inversion:
    """Return the parameters with their errors, as far as they are known."""
    data, off, slopes = problem.data, problem.residuals(at), problem.slopes(at)
    samples = len(data.mu)
    square, weight = float(off @ off), float(problem.weight.sum())
    if not np.isfinite(slopes).all() or len(off) <= PARAMETERS:
        return unknown(samples)
    slow, quick = _variances(off[1:], PARAMETERS)
    rests = _variances(data.before - data.level, 1)
    before = max(rests)
    misses = slow > BY_CHANCE * max(quick, before) or quick > NOISIER * before
    together = data.noise**2
    if rests[0] > BY_CHANCE * max(slow, quick):  # it swings before the step, and goes on after it
        together += rests[0] * min(MODES, len(data.before)) / len(data.before)
    variance = max(slow, quick) + together
    # what all samples are off by together is as any smooth curve of few parameters
    alone = variance + together * weight / PARAMETERS
    whole = alone + (AMISS**2 * variance if misses else 0.0)
    a, D, b, errors = _with_errors(at, slopes, sqrt(whole), problem.tilt)
    seen = problem.shortest / E_FOLDS < D < problem.longest
    by = max(errors[0] / a, errors[1] / abs(b) if b else inf, errors[2] / D) / KNOWN
    far = misses and problem.largest(_slow_part(off[1:])) > MISSED
    if far or not (seen and by < 1.0):
        misses = far or (misses and seen and by * sqrt(alone / whole) < 1.0)
        return unknown(samples)._replace(square=square, variance=variance, misses=misses)
    fit = problem.curve(at, np.maximum(data.slip, 0.0))
    return Inversion(a, errors[0], b, errors[1], D, errors[2], square, variance, misses, fit)


def _with_errors(
    at: Floats, slopes: Floats, deviation: float, tilt: Floats
) -> tuple[float, float, float, tuple[float, ...]]:
    """Return a, D_c, b, and the standard errors of a, b, D_c: by scatter, and by a tilt."""
    a, D = exp(at[1]), exp(at[2])
    scale = np.linalg.norm(slopes, axis=0).clip(TINY)
    left, sizes, rows = np.linalg.svd(slopes / scale, full_matrices=False)
    part = rows.T / np.maximum(sizes, 1e-150) / scale[:, None]
    tilted = left.T @ tilt
    parts = a * part[1], a * part[1] - part[3], D * part[2]
    errors = tuple(hypot(deviation * float(np.linalg.norm(x)), float(x @ tilted)) for x in parts)
    return a, D, a - float(at[3]), errors


def _variances(off: Floats, fitted: int) -> tuple[float, float]:
    """Return the variances of slow and of quick deviations, each per degree of freedom."""
    from scipy.fft import dct

    terms = dct(off, norm="ortho") ** 2
    slow = min(MODES, len(off))
    low = float(terms[:slow].sum()) / max(slow - fitted, 1)
    return low, float(terms[slow:].mean()) if len(off) > 2 * MODES else low


def _slow_part(off: Floats) -> Floats:
    """Return deviations without those that change quickly: noise."""
    from scipy.fft import dct, idct

    terms = dct(off, norm="ortho")
    terms[MODES:] = 0.0
    return np.asarray(idct(terms, norm="ortho"))
