"""A step of the drive, and the deviations of curves of a rate-and-state law from its samples.

The clock of a record is not that of the drive, and its stiffness was measured: the time of the step
and the stiffness are parameters of the curve, too. Those of a run are known.
"""

from __future__ import annotations

from math import exp, inf, log, nan, sqrt
from typing import NamedTuple

import numpy as np

from stiction.analysis.protocols.inversion.spring_slider import (
    FrictionCourse,
    Law,
    SpringSlider,
    course_after_a_step,
)
from stiction.analysis.signals.correlated_noise import ERRORS_997
from stiction.arrays import Floats

# parameters of a curve; that of a run has the first four
LEVEL, LOG_A, LOG_D, CHANGE, DELAY, LOG_K = range(6)
STIFFER = log(1.5)  # by which the stiffness of a rig may be off, either way
ONSET = 0.2  # of the first change of friction: from there on it is surely seen
ABOVE_NOISE = 4.0  # deviations of noise: what is more is a change
FIRST_SEEN = 0.01  # of that change: what is less may be left of an evolution before
RESOLVED = 1.0  # samples in which the spring takes up the jump: with fewer it is not seen
INSIDE = 0.9  # of the interval in which a parameter is sought: a fit begins within
FLAT = 12.0**-0.5  # standard deviation of what may be anywhere within 1
BINS_PER_E_FOLD = 200  # of the time since the step, in which samples are averaged
MODES = 16  # terms of the cosine transform of residuals: the slow ones
BEYOND = 10.0  # times of the least and the largest D_c that are seen: where it is sought
NEAR = 1e-4  # of a parameter, for a derivative


class StepData(NamedTuple):
    """A step of the drive as it is fitted."""

    time: float  # s
    rig: SpringSlider  # what is known of it
    # (n,), travel of the drive since the step, m; negative before it, at the speed after it
    slip: Floats
    mu: Floats  # (n,), spring force over load
    before: Floats  # (l,), the same in steady sliding before the step
    after: float  # where it is steady after the step, or its mean in the end of the data
    noise: float  # what all samples may be off by together: rounding, or the tolerance of a run
    # mean travel of the drive, since the step, of the samples before it, m: negative
    travel_before: float = 0.0
    # standard error of the trend over the travel that `mu` and `before` are freed of, 1/m
    trend_error: float = 0.0
    speed: float = nan  # of the drive after the step, m/s
    # travel by which the step may come earlier or later than `slip` has it, m. 0 for a run: then
    # its stiffness is right, too
    clock: float = 0.0
    # error of the step in `slip` where a displacement shows it, as travel, m
    jump_error: float = inf

    @property
    def shortest(self) -> float:
        """Travel from one sample to the next, m."""
        return float(np.median(np.diff(self.slip)))

    @property
    def shows_jump(self) -> bool:
        """Whether a displacement shows the step better than the samples between which it lies."""
        return self.jump_error < min(FLAT * self.shortest, self.clock)

    @property
    def interval(self) -> float:
        """Time from one sample to the next, s."""
        return self.shortest / self.speed

    @property
    def level(self) -> float:
        """Mean before the step."""
        return float(self.before.mean())

    @property
    def up(self) -> float:
        """Direction of the first change: 1 to a higher speed, -1 to a lower one."""
        return 1.0 if self.rig.ratio > 1.0 else -1.0


class Delay(NamedTuple):
    """Where the delay of a step is sought: least, likely and largest, and the error of that, m."""

    least: float
    likely: float
    largest: float
    error: float


class StepProblem(NamedTuple):
    """Averages over bins, and the weights of these: the first is that before the step.

    `shortest` is the slip from one sample to the next, m: what evolves within it is not seen.
    `noise` is the deviation of a sample before the step. `found` are the curves at the bins for all
    parameters for which they were computed.
    """

    data: StepData
    law: Law
    slip: Floats
    mu: Floats
    weight: Floats
    shortest: float
    delay: Delay
    noise: float
    found: dict[bytes, FrictionCourse]

    @property
    def longest(self) -> float:
        """Slip since the step, m."""
        return float(self.data.slip[-1])

    @property
    def parameters(self) -> int:
        """How many parameters a curve has: of a run, delay and stiffness are known."""
        return LOG_K + 1 if self.data.clock else DELAY

    @property
    def bounds(self) -> tuple[list[float], list[float]]:
        """The least and the largest values of the parameters."""
        low = [*[-inf] * DELAY, self.delay.least, -STIFFER]
        high = [*[inf] * DELAY, self.delay.largest, STIFFER]
        return low[: self.parameters], high[: self.parameters]

    def known_slopes(self, noise: float) -> Floats:
        """Return the derivatives of the delay and stiffness that are known without the curve."""
        errors = np.array([self.delay.error, 2.0 * FLAT * STIFFER])[: self.parameters - DELAY]
        return np.eye(self.parameters)[DELAY:] * (noise / errors[:, None])

    def known_residuals(self, at: Floats) -> Floats:
        """Return the deviations of delay and stiffness from values known without the curve."""
        expected = np.array([0.0, 0.0, 0.0, 0.0, self.delay.likely, 0.0])[: self.parameters]
        return np.asarray(self.known_slopes(self.noise) @ (at - expected))

    def curve(self, at: Floats, x: Floats) -> FrictionCourse:
        """Return friction at slips `x`; NaN where the slip runs away, or D_c is out of sight."""
        level, log_a, log_D, change = at[: CHANGE + 1].tolist()
        delay, log_k = clock_and_rig(at)
        rig, D_c, found = self.data.rig, exp(min(log_D, 100.0)), None
        rig = rig._replace(stiffness=rig.stiffness * exp(log_k))
        first = int(np.searchsorted(x, delay))  # before it slides as it did
        if self.shortest / BEYOND < D_c < self.longest * BEYOND and log_a < 0.0:
            a = exp(log_a)
            found = course_after_a_step(rig, self.law, a, a - change, D_c, x[first:] - delay)
        if found is None:
            return FrictionCourse(np.full(len(x), nan), np.full(len(x), nan))
        after = level + change * log(rig.ratio) + found.friction
        return FrictionCourse(
            np.concatenate([np.full(first, level), after]),
            np.concatenate([np.zeros(first), found.slope]),
        )

    def known_curve(self, at: Floats) -> FrictionCourse:
        """Return the curve at the bins.

        A step of the fit, its derivatives and its verdict all ask for those at the same place, of
        which each is a solution of a differential equation.
        """
        place = at.tobytes()
        if place not in self.found:
            self.found[place] = self.curve(at, self.slip)
        return self.found[place]

    @property
    def changes(self) -> Floats:
        """Weighted deviations of the bins from steady sliding before the step."""
        return np.asarray(np.sqrt(self.weight[1:]) * (self.mu[1:] - self.mu[0]))

    @property
    def tilt(self) -> Floats:
        """Weighted deviations by the standard error of the trend."""
        travel = np.concatenate([[self.data.travel_before], self.slip])
        return np.asarray(self.data.trend_error * np.sqrt(self.weight) * travel)

    def residuals(self, at: Floats) -> Floats:
        """Return the weighted deviations of a curve with these parameters."""
        model = np.concatenate([at[:1], self.known_curve(at).friction])
        return np.asarray(np.sqrt(self.weight) * (model - self.mu))

    def largest(self, off: Floats) -> float:
        """Return the largest of weighted deviations, as a share of all change of friction."""
        return float(np.abs(off / np.sqrt(self.weight[1:])).max() / np.ptp(self.mu))

    def slopes(self, at: Floats) -> Floats:
        """Return the derivatives of the residuals by the parameters, (n, 4) or (n, 6).

        With lengths in D_c a curve depends on k D_c and the slip since the step alone: one by D_c
        is that by k, and how friction changes with the slip.
        """
        slope = self.known_curve(at).slope
        by_delay = np.concatenate([[0.0], -slope])
        since = np.concatenate([[0.0], self.slip - clock_and_rig(at)[0]])
        by_k = self._difference(at, LOG_K, 1.0)
        columns = [
            np.ones(len(self.mu)),
            self._difference(at, LOG_A, 1.0),
            by_k + since * by_delay,
            self._difference(at, CHANGE, max(abs(at[CHANGE]), 1e-3)),
            by_delay,
            by_k,
        ]
        return np.asarray(np.sqrt(self.weight)[:, None] * np.stack(columns[: len(at)], axis=1))

    def _difference(self, at: Floats, which: int, scale: float) -> Floats:
        """Return the derivative of friction before the step and at the bins by a parameter."""
        here = self.known_curve(at).friction
        at = np.concatenate([at, np.zeros(LOG_K + 1 - len(at))])
        for by in (NEAR * scale, -NEAR * scale):
            near = self.curve(at + by * np.eye(len(at))[which], self.slip).friction
            if np.isfinite(near).all():
                break
        return np.concatenate([[0.0], (near - here) / by])


def clock_and_rig(at: Floats) -> tuple[float, float]:
    """Return the delay (m) and the logarithm of stiffness over that stated; 0 for a run."""
    delay, log_k = at[DELAY:].tolist() or (0.0, 0.0)
    return delay, log_k


def step_problem(data: StepData, law: Law) -> StepProblem:
    """Return means of samples over times that are short beside the time since the step.

    Where the spring takes up the jump between two samples, these tell no more than that the step
    came between them, and what lies on the flank of the curve is left out: how it would deviate is
    far from linear in the delay.
    """
    slip, shortest = data.slip, data.shortest
    width = np.maximum(shortest, slip / BINS_PER_E_FOLD)
    place = np.concatenate([[0.0], np.cumsum(np.diff(slip) / width[1:])])
    # a sample that is alone in its bin stays as it is
    firsts = np.flatnonzero(np.diff(np.floor(place + 1e-9), prepend=-1.0))
    count = np.diff(firsts, append=len(slip))
    slips, mu = (np.add.reduceat(each, firsts) / count for each in (slip, data.mu))
    delay, flank = _delay(data, slips, mu, shortest)
    slips, mu, count = (np.delete(each, flank) for each in (slips, mu, count))
    weight = np.concatenate([[float(len(data.before))], count])
    mu = np.concatenate([[data.level], mu])
    noise = sqrt(max(variances(data.before - data.level, 1)))
    return StepProblem(data, law, slips, mu, weight, shortest, delay, noise, {})


def onset(data: StepData, mu: Floats) -> int:
    """Return the first sample, or bin, in which friction has changed beyond its noise."""
    off, least = np.abs(mu - data.level), _least_change(data, mu)
    surely = int((off > max(ONSET * _jump(data, mu), least)).argmax())
    return surely - int((off[:surely][::-1] <= least).argmax()) if surely else 0


def has_changed(data: StepData) -> bool:
    """Return whether friction has changed in the first sample."""
    return abs(float(data.mu[0]) - data.level) > _least_change(data, data.mu)


def jumps_at_once(data: StepData) -> bool:
    """Return whether the spring takes up the jump of friction within a sample."""
    return travel_of_spring(data, _jump(data, data.mu)) < RESOLVED * data.shortest


def _jump(data: StepData, mu: Floats) -> float:
    """Return the first change of friction."""
    return abs(float(mu[int((data.up * mu).argmax())]) - data.level)


def _least_change(data: StepData, mu: Floats) -> float:
    """Return the least change of friction that counts: above noise, and above slow evolution."""
    return max(ABOVE_NOISE * float(data.before.std()), FIRST_SEEN * _jump(data, mu))


def _delay(data: StepData, slip: Floats, mu: Floats, shortest: float) -> tuple[Delay, slice]:
    """Return where the delay is sought, and which bins lie on the flank of a jump.

    There is none where a displacement on the same clock shows the step, and friction changes right
    after it. Else the first change of friction tells: the spring takes up the first of a jump
    undisturbed.
    """
    clock, first = data.clock, onset(data, mu)
    last, rise = float(slip[first]), travel_of_spring(data, _jump(data, mu))
    width = shortest + travel_of_spring(data, ABOVE_NOISE * float(data.before.std()))
    off = data.jump_error
    if data.shows_jump and -ERRORS_997 * off < last < width + ERRORS_997 * off:
        return Delay(-clock, 0.0, clock, off), slice(0)
    likely = last - 0.5 * shortest - travel_of_spring(data, float(mu[first]) - data.level)
    if clock > 0.0 and rise < RESOLVED * shortest and last < clock:
        flank = slice(first, first + 1 + int(rise / shortest))
        return Delay(last - width, last - 0.5 * width, last, FLAT * width), flank
    likely = min(max(likely, -INSIDE * clock), INSIDE * clock)
    return Delay(-clock, likely, clock, 2.0 * FLAT * clock), slice(0)


def travel_of_spring(data: StepData, change: float) -> float:
    """Return the travel after a step in which the spring takes up a change of friction, m."""
    return abs(change) / (data.rig.stiffness * abs(1.0 - 1.0 / data.rig.ratio))


def variances(off: Floats, fitted: int) -> tuple[float, float]:
    """Return the variances of slow and of quick deviations, each per degree of freedom."""
    from scipy.fft import dct

    terms = dct(off, norm="ortho") ** 2
    slow = min(MODES, len(off))
    low = float(terms[:slow].sum()) / max(slow - fitted, 1)
    return low, float(terms[slow:].mean()) if len(off) > 2 * MODES else low


def slow_part(off: Floats) -> Floats:
    """Return the slow part of deviations, without noise."""
    from scipy.fft import dct, idct

    terms = dct(off, norm="ortho")
    terms[MODES:] = 0.0
    return np.asarray(idct(terms, norm="ortho"))
