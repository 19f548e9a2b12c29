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

from stiction.analysis.protocols.inversion.spring_slider import Law
from stiction.analysis.protocols.inversion.step import (
    CHANGE,
    DELAY,
    LOG_A,
    LOG_D,
    MODES,
    StepData,
    StepProblem,
    slow_part,
    step_problem,
    variances,
)
from stiction.arrays import TINY, Floats

FEWEST = 8  # samples of a fit
KNOWN = 1 / 5  # of a value: its standard error, up to which the fit is as good as linear
E_FOLDS = 3.0  # of what evolves, from one sample to the next, of which something is still seen
BY_CHANCE = 3.0  # ratio of variances: once in a thousand, by F with 12 and 100 degrees of freedom
MISSED = 0.01  # of all change of friction: a curve that is farther off is not that of the law
NOISIER = 10.0  # by which the variance of noise may grow with the step
# Errors of parameters of a curve that misses the points, over those by the residuals; found, not
# derived. One of the laws ageing, slip and Perrin's fitted to another missed on 116 random rigs:
# D_c was off by 12 times its error in the median, by 5 to 19 in eight of ten, by 45 at most
AMISS = 15.0
FIRST_GUESSES = tuple(
    (by_a, by_D) for by_D in (0.01, 0.03, 0.1, 0.3, 1.0, 3.0) for by_a in (1.0, 1.6, 3.0)
)
STARTS = 2  # of these from which a fit begins at most: until one goes through the points


class Inversion(NamedTuple):
    """A fitted law."""

    # m for D_c; NaN where they are not known
    a: float
    # standard errors
    a_error: float
    b: float
    b_error: float
    D_c: float
    D_c_error: float
    # sum of squared residuals, and their variance; NaN without a fit
    square: float
    variance: float
    # whether the curve misses the samples by more than they scatter; of parameters that are NaN,
    # whether they are so for that
    misses: bool
    fit: Floats  # (n,), the curve at the samples; NaN without it
    # travel by which the step comes later than stated, m, and its standard error; 0 for a run
    delay: float = 0.0
    delay_error: float = 0.0
    # logarithm of the rig's stiffness over that stated; 0 for a run
    stiffer: float = 0.0
    stiffer_error: float = 0.0


def unknown(samples: int) -> Inversion:
    """Return the fit of a step without any known value."""
    return Inversion(nan, nan, nan, nan, nan, nan, nan, nan, False, np.full(samples, nan))


def invert(data: StepData, law: Law) -> Inversion:
    """Fit a law to a step; parameters that the data do not determine are NaN."""
    from scipy.optimize import least_squares

    if len(data.mu) < FEWEST or not np.isfinite(data.rig.stiffness):
        return unknown(len(data.mu))
    problem, best, least = step_problem(data, law), None, inf
    slow, quick = variances(problem.changes, 1)
    if slow < BY_CHANCE * quick:  # nothing changes beyond noise
        return unknown(len(data.mu))
    minimised: Any = least_squares
    known = problem.known_slopes(problem.noise)
    for start in _starts(problem):
        found = minimised(
            lambda at: np.append(problem.residuals(at), problem.known_residuals(at)), start,
            lambda at: np.append(np.nan_to_num(problem.slopes(at)), known, axis=0),
            bounds=problem.bounds, x_scale="jac", max_nfev=20, xtol=1e-8, ftol=1e-8,
        )  # fmt: skip
        if found.cost < least:
            best, least = found.x, float(found.cost)
        if best is not None and problem.largest(slow_part(problem.residuals(best)[1:])) < MISSED:
            break
    return unknown(len(data.mu)) if best is None else _verdict(problem, best)


def _starts(problem: StepProblem) -> list[Floats]:
    """Return parameters near the wanted ones, the best first; none if none is near."""
    data, mu = problem.data, problem.mu[1:]
    by, peak = log(data.rig.ratio), int((data.up * mu).argmax())
    change = (data.after - data.level) / by
    passed = np.abs(mu[peak:] - mu[peak]) > (1.0 - exp(-1.0)) * abs(mu[peak] - data.after)
    far = problem.slip[peak + int(passed.argmax())] if passed.any() else problem.slip[-1]
    guess = float(far - problem.slip[peak]) or float(problem.slip[-1]) / len(mu)
    least = max((mu[peak] - data.level) / by, 0.1 * abs(change))
    if not (np.ptp(mu) > 0.0 and least > 0.0):
        return []
    slowest = max(-change, 0.0) / data.rig.stiffness  # D_c below which sliding is unstable
    clock_and_stiffness = [problem.delay.likely, 0.0] if data.clock else []
    found: list[tuple[float, int, Floats]] = []
    for by_a, by_D in FIRST_GUESSES:
        log_D = log(by_D * guess + 1.05 * slowest)
        at = np.array([data.level, log(by_a * least), log_D, change, *clock_and_stiffness])
        off = problem.residuals(at)
        if np.isfinite(off).all():
            found.append((float(off @ off), len(found), at))
    return [at for _, _, at in sorted(found)[:STARTS]]


def _verdict(problem: StepProblem, at: Floats) -> Inversion:
    """Return the parameters with their errors, as far as they are known."""
    data, off, slopes = problem.data, problem.residuals(at), problem.slopes(at)
    samples = len(data.mu)
    square, weight = float(off @ off), float(problem.weight.sum())
    if not np.isfinite(slopes).all() or len(off) <= len(at):
        return unknown(samples)
    slow, quick = variances(off[1:], len(at))
    rests = variances(data.before - data.level, 1)
    before = max(rests)
    misses = slow > BY_CHANCE * max(quick, before) or quick > NOISIER * before
    together = data.noise**2
    if rests[0] > BY_CHANCE * max(slow, quick):  # it swings before the step, and goes on after it
        together += rests[0] * min(MODES, len(data.before)) / len(data.before)
    variance = max(slow, quick) + together
    # what all samples are off by together is as any smooth curve of few parameters
    alone = variance + together * weight / len(at)
    whole = alone + (AMISS**2 * variance if misses else 0.0)
    slopes = np.concatenate([slopes, problem.known_slopes(sqrt(whole))])
    tilt = np.concatenate([problem.tilt, np.zeros(len(at[DELAY:]))])
    a, D, b, errors = _with_errors(at, slopes, sqrt(whole), tilt)
    seen = problem.shortest / E_FOLDS < D < problem.longest
    by = max(errors[0] / a, errors[1] / abs(b) if b else inf, errors[2] / D) / KNOWN
    far = misses and problem.largest(slow_part(off[1:])) > MISSED
    if far or not (seen and by < 1.0):
        misses = far or (misses and seen and by * sqrt(alone / whole) < 1.0)
        return unknown(samples)._replace(square=square, variance=variance, misses=misses)
    fit = problem.curve(at, data.slip).friction
    found = Inversion(a, errors[0], b, errors[1], D, errors[2], square, variance, misses, fit)
    if data.clock:
        (delay, stiffer), (by_clock, by_rig) = at[DELAY:].tolist(), errors[3:]
        found = found._replace(
            delay=delay, delay_error=by_clock, stiffer=stiffer, stiffer_error=by_rig
        )
    return found


def _with_errors(
    at: Floats, slopes: Floats, deviation: float, tilt: Floats
) -> tuple[float, float, float, tuple[float, ...]]:
    """Return a, D_c, b, and standard errors by scatter, and by a tilt: of a, b, D_c, the rest."""
    a, D = exp(at[LOG_A]), exp(at[LOG_D])
    scale = np.linalg.norm(slopes, axis=0).clip(TINY)
    left, sizes, rows = np.linalg.svd(slopes / scale, full_matrices=False)
    part = rows.T / np.maximum(sizes, 1e-150) / scale[:, None]
    tilted = left.T @ tilt
    parts = a * part[LOG_A], a * part[LOG_A] - part[CHANGE], D * part[LOG_D], *part[DELAY:]
    errors = tuple(hypot(deviation * float(np.linalg.norm(x)), float(x @ tilted)) for x in parts)
    return a, D, a - float(at[CHANGE]), errors
