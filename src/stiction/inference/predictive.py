"""Posterior-predictive check: do simulations with the fitted parameters look like the record?

The loading curve is the mean force at equal shares of the time from trough to peak. If that of the
record departs from those of simulations with parameters drawn from the posterior, what is simulated
is not what was measured (A. Gelman, X.-L. Meng & H. Stern, Stat. Sinica 6, 733 (1996)).
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import numpy as np

from stiction.analysis.signals.correlated_noise import interval_95
from stiction.arrays import Floats
from stiction.inference.cycles import Cycles
from stiction.inference.observation import Observation
from stiction.inference.posterior import Fit
from stiction.inference.simulated.plan import Plan
from stiction.inference.simulated.synthetic import Synthetic, synthesise
from stiction.study.execution.cores import Cores

DRAWS = 60  # simulations with parameters of the posterior
SHARES = np.linspace(0.0, 1.0, 41)


class Curve(NamedTuple):
    """A loading curve: mean time (s) and force (N) at equal shares of the loadings, (s,)."""

    time: Floats
    force: Floats

    @property
    def rate(self) -> Floats:
        """The mean rate of the force from first to last, N/s."""
        return np.asarray((self.force[..., -1] - self.force[..., 0]) / self.time[..., -1])

    @property
    def bend(self) -> Floats:
        """The departure of the force from a straight line between its ends, over its rise."""
        first, last = self.force[..., :1], self.force[..., -1:]
        return (self.force - first) / (last - first) - SHARES


class Predictive(NamedTuple):
    """A record beside simulations with the fitted parameters.

    Parameters
    ----------
    measured : Curve
        Of the record.
    simulated : Curve
        Of each simulation, (n, s).
    larger : float
        Posterior predictive p-value: share of simulations whose curve departs from their mean more
        than that of the record does, in its force, its bend or its rate.
    example : Synthetic
        The simulation with the curve nearest to the mean one.
    slip : float
        Mean time from peak to trough in the record, s.
    slips : ndarray
        (n,), of each simulation.
    """

    measured: Curve
    simulated: Curve
    larger: float
    example: Synthetic
    slip: float
    slips: Floats

    @property
    def bands(self) -> tuple[Floats, Floats]:
        """The predictive intervals, 95 %, of force and bend, (2, s) each."""
        force, bend = (interval_95(each) for each in (self.simulated.force, self.simulated.bend))
        return force, bend


def loading_curve(step: float, force: Floats, cycles: Cycles) -> Curve:
    """Return the mean loading curve of samples `step` apart."""
    pairs = [*zip(cycles.before.tolist(), cycles.peak.tolist(), strict=True)]
    index = np.arange(len(force), dtype=np.float64)
    each = [np.interp(low + SHARES * (high - low), index, force) for low, high in pairs]
    length = step * float(np.mean([high - low for low, high in pairs]))
    return Curve(length * SHARES, np.mean(each, axis=0))


def slip_time(step: float, cycles: Cycles) -> float:
    """Return the mean time from peak to trough of samples `step` apart, s."""
    return step * float(np.mean(cycles.after - cycles.peak))


def predict(
    fit: Fit, seen: Observation, progress: Callable[[float], None] | None = None
) -> Predictive | None:
    """Simulate a record with parameters of its posterior; return None if hardly any has cycles."""
    step = seen.conditions.step
    made: list[Synthetic] = []
    chosen = np.linspace(0, len(fit.scores) - 1, DRAWS).astype(int)
    work = partial(simulate_one, fit.plan, fit.scores[chosen])
    for done, found in enumerate(Cores().results(work, range(DRAWS)), 1):
        made += [found] if found else []
        if progress is not None:
            progress(done / DRAWS)
    if 2 * len(made) < DRAWS:
        return None
    curves = [loading_curve(step, each.channels["force"], each.cycles) for each in made]
    measured = loading_curve(step, seen.force, seen.cycles)
    simulated = Curve(*(np.stack(each) for each in zip(*curves, strict=True)))
    own, others = departures(
        np.concatenate([measured.force, measured.bend, measured.rate[None]]),
        np.concatenate([simulated.force, simulated.bend, simulated.rate[:, None]], axis=1),
    )
    larger = (1.0 + float((others >= own).sum())) / (1.0 + len(others))
    slips = np.array([slip_time(step, each.cycles) for each in made])
    example = made[int(np.argmin(others))]
    return Predictive(measured, simulated, larger, example, slip_time(step, seen.cycles), slips)


def simulate_one(
    plan: Plan, scores: Floats, number: int, _: Callable[[], bool]
) -> Synthetic | None:
    """Return a synthetic record under the first conditions."""
    return next(synthesise(plan, scores[number], np.random.default_rng([1, number])))


def departures(measured: Floats, simulated: Floats) -> tuple[float, Floats]:
    """Return the departures of curves from the mean simulated one, in standard deviations.

    The largest at any share: of the measured (s,) and of each simulated one (n, s), from the mean
    of the others.

    >>> departures(np.array([3.0]), np.array([[1.0], [0.0], [-1.0]]))
    (3.0, array([1.5, 0. , 1.5]))
    """
    count = len(simulated)
    spread = np.maximum(simulated.std(axis=0, ddof=1), 1e-12)
    apart = (simulated - simulated.mean(axis=0)) * count / (count - 1)
    own = float((np.abs(measured - simulated.mean(axis=0)) / spread).max())
    return own, (np.abs(apart) / spread).max(axis=1)
