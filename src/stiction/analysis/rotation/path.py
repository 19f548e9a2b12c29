"""The path of the force in the plane: an arc about zero, or a straight line."""

from __future__ import annotations

from math import hypot
from typing import NamedTuple

import numpy as np

from stiction.analysis.rotation.loading import MeanLoading
from stiction.analysis.signals.straight_line import line
from stiction.arrays import Floats

# Of the mean peak: radii of arcs on which the force may slip there, weakened before or not
RADII = 0.95, 1.2
WEAKENING = 0.1  # of F_0: how far laws change the magnitude on the way to slip, an expected size
GRID = 400  # centres on each side
SIDEWAYS = 0.02  # of the force: least part across by which creep is divided
CHORD = 24.0  # the mean over an arc of angle a lies at 1 - a^2/24 of its radius


class ArcShape(NamedTuple):
    """How the magnitude changes: as 1/sin^power of the angle, and in which bins that holds.

    With a power of 0 it changes as the logarithm, as rate and state has it.
    """

    power: float
    bins: slice


USUAL = ArcShape(2.0, slice(None))
# What differs from it by the model alone: how the law depends on speed, the end of ringing after a
# slip, and inertia before the next
OTHERS = (
    *(ArcShape(power, slice(None)) for power in (1.0, 0.0)),
    *(ArcShape(2.0, bins) for bins in (slice(2, None), slice(None, -2))),
)


class Arc(NamedTuple):
    """An arc about (0, zero), N, on which the magnitude changes by `change`, relative to F_0.

    `misfit` is the sum of squares, in standard errors; `to_rest` by how much F_0, at rest, is more
    than the magnitude in the slowest creep that was seen, N.
    """

    misfit: float
    zero: float
    F_0: float
    change: float
    zero_error: float
    F_0_error: float
    change_error: float
    to_rest: float


def line_misfit(its: MeanLoading) -> float:
    """Return the sum of squares, in standard errors, about the best straight line."""
    found = line(its.x, its.y)
    variance = its.y_error**2 + (found.slope * its.x_error) ** 2
    return float((found.deviations(its.x, its.y) ** 2).sum() / variance)


def best_arc(its: MeanLoading, known: float = 0.0) -> Arc:
    """Return the best arc, with all errors; without a zero, one whose radius the slip allows.

    Creep becomes faster as the force turns, and friction weakens: |F| = F_0 - d/sin^2 of the angle,
    which describes random rigs better than the speed 1/sin of a mass on a spring that is rigid
    across. The centre is tried on a grid; for each, F_0 and d are linear. With a `known` error of
    the zero, N, the centre lies about 0.
    """
    found = usual_arc(its, known)
    others = [usual_arc(its, known, shape) for shape in OTHERS]
    errors = {}
    for name in ("zero", "F_0", "change"):
        apart = max(abs(getattr(each, name) - getattr(found, name)) for each in others)
        errors[f"{name}_error"] = hypot(getattr(found, f"{name}_error"), apart)
    errors["F_0_error"] = hypot(errors["F_0_error"], found.to_rest)
    return found._replace(**errors)


def arc_path(
    its: MeanLoading, arc: Arc, known: float = 0.0, *, even: bool = False, count: int = 200
) -> Floats:
    """Return points (count, 2), N, of the path that an arc describes, over the range of the data.

    Its distance from (0, zero) is |F| = F_0 - d/sin^2 of the angle, as it was fitted; or F_0 alone,
    if the path is `even`.
    """
    _, (F_0, *_), (d, *_) = _fits(its, np.array([arc.zero]), known, USUAL)
    far = np.arctan2(its.y - arc.zero, its.x)
    angle = np.linspace(float(far.min()), float(far.max()), count)
    fall = 0.0 if even else d * np.maximum(np.abs(np.sin(angle)), SIDEWAYS) ** -USUAL.power
    return np.column_stack([(F_0 - fall) * np.cos(angle), arc.zero + (F_0 - fall) * np.sin(angle)])


def usual_arc(its: MeanLoading, known: float = 0.0, shape: ArcShape = USUAL) -> Arc:
    """Return the best arc with the errors of noise alone."""
    far = np.geomspace(1e-3, 1.0, GRID) * (RADII[1] * its.peak + np.ptp(its.y))
    zeros = np.concatenate([its.y.min() - far, its.y.max() + far])
    if known:
        zeros = np.linspace(-4.0, 4.0, 2 * GRID + 1) * known
    misfits, _, _ = _fits(its, zeros, known, shape)
    return _with_errors(its, float(zeros[np.argmin(misfits)]), known, shape)


def _magnitudes(its: MeanLoading, zeros: Floats, shape: ArcShape) -> tuple[Floats, Floats, Floats]:
    """Return magnitude, its change by the shape, and weight of each bin, for each centre."""
    y = its.y - zeros[:, None]
    r = np.hypot(its.x, y)
    within = np.gradient(np.arctan2(y, its.x), axis=1)  # by how much the force turns in a bin
    weight = np.zeros_like(r)
    errors = (its.x * its.x_error) ** 2 + (y * its.y_error) ** 2
    weight[:, shape.bins] = (r**2 / errors)[:, shape.bins]
    sines = np.maximum(np.abs(y) / r, SIDEWAYS)
    q = sines**-shape.power if shape.power else -np.log(sines)
    return r / (1.0 - within**2 / CHORD), q, weight


def _fits(
    its: MeanLoading, zeros: Floats, known: float, shape: ArcShape
) -> tuple[Floats, Floats, Floats]:
    """Return misfit, F_0 and d of the best arc about each centre."""
    r, q, weight = _magnitudes(its, zeros, shape)
    total = weight.sum(axis=1)
    r_mean, q_mean = ((weight * each).sum(axis=1) / total for each in (r, q))
    dr, dq = r - r_mean[:, None], q - q_mean[:, None]
    prior = _prior(its, q)
    d = -(weight * dr * dq).sum(axis=1) / ((weight * dq**2).sum(axis=1) + prior)
    F_0 = r_mean + d * q_mean
    if not known:  # at a bound of F_0, d is best for that
        F_0 = np.clip(F_0, RADII[0] * its.peak, RADII[1] * its.peak)
        apart = r - F_0[:, None]
        d = -(weight * apart * q).sum(axis=1) / ((weight * q**2).sum(axis=1) + prior)
    misfits = (weight * (r - F_0[:, None] + d[:, None] * q) ** 2).sum(axis=1) + prior * d**2
    if known:
        misfits = misfits + (zeros / known) ** 2
    return misfits, F_0, d


def _prior(its: MeanLoading, q: Floats) -> Floats:
    """Return the weight of the prior on d, 1/N^2: laws weaken on the way to slip, but not much."""
    rise = np.maximum(np.abs(q[:, -1] - q[:, 0]), 1.0)
    weight: Floats = (rise / (WEAKENING * its.peak)) ** 2
    return weight


def _with_errors(its: MeanLoading, zero: float, known: float, shape: ArcShape) -> Arc:
    """Return an arc with the standard errors of its quantities, by its derivatives."""
    step = 1e-4 * its.peak
    zeros = np.array([zero, zero - step, zero + step])
    (misfit, *_), (F_0, *_), (d, *_) = _fits(its, zeros, known, shape)
    r, q, weight = _magnitudes(its, zeros, shape)
    apart = r + d * q
    by_zero = (apart[2] - apart[1]) / (2.0 * step)
    jacobian = np.column_stack([by_zero, -np.ones(len(its.x)), q[0]])
    normal = (jacobian * weight[0][:, None]).T @ jacobian
    normal[2, 2] += _prior(its, q)[0]
    normal[0, 0] += known**-2 if known else 0.0
    excess = max(1.0, misfit / (np.count_nonzero(weight[0]) - 2.0))
    errors = np.sqrt(_variances(normal) * excess)
    rise = q[0, -1] - q[0, 0]
    first = F_0 - d * q[0, 0]
    zero_error, F_error, d_error = map(float, errors)
    return Arc(
        float(misfit), zero, float(F_0), float(-d * rise / first), zero_error, F_error,
        float(abs(rise) * d_error / first), float(abs(d) * q[0, 0]),
    )  # fmt: skip


def _variances(normal: Floats) -> Floats:
    """Return the variances of the unknowns of a fit with a normal matrix.

    They are large of what nothing shows, as of the zero of a force across that is nowhere else than
    at zero: the matrix is singular then.
    """
    values, vectors = np.linalg.eigh(normal)
    least = np.finfo(float).eps * values[-1]
    return np.asarray(vectors**2 @ (1.0 / np.maximum(values, least)))
