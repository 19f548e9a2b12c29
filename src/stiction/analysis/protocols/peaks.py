"""Peaks of friction after holds: of a run exactly, of a record as well as its samples show them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import hypot, nan, sqrt
from typing import NamedTuple

import numpy as np

from stiction.analysis.protocols.friction_test import ConstantStretch, FrictionTest
from stiction.analysis.protocols.settling import ROUNDED, SETTLED
from stiction.analysis.quadrature import panels, states_at
from stiction.analysis.signals.straight_line import line
from stiction.arrays import Floats
from stiction.recording.noise import ORDER, white_noise
from stiction.trajectory import Trajectory

PER_PANEL = 4  # times in each panel of a run: a step of the solver, or an oscillation
FINER = 32  # times between the neighbours of the highest
RESOLVED = 4  # samples while friction falls half-way from its peak
# Of the fall by half, over that of as many samples: at first an exponential falls 2 ln 2 times as
# fast as on average
STEEPEST = 1.4
CHANCE = 2.0  # standard deviations of noise by which the largest of some samples is too large


class Peak(NamedTuple):
    """Friction at its peak, and its standard error; NaN where samples do not resolve it."""

    value: float
    error: float


def peaks_of_samples(test: FrictionTest, slides: Sequence[ConstantStretch]) -> list[Peak]:
    """Return the highest sample of each slide, and how far the peak may lie above it."""
    found = []
    for slide in slides:
        at = test.within(*slide[:2])
        found.append(_sampled_peak(slide.way * test.mu[at[0] - 1 : at[-1] + 1]))
    return found


def _sampled_peak(mu: Floats) -> Peak:
    """Return the peak of one slide, which begins after the first sample."""
    top = 1 + int(mu[1:].argmax())
    late = mu[-max(int(SETTLED * len(mu)), 1) :]
    peak, level = float(mu[top]), float(late.mean())
    noise = noise_of(mu, late)
    fall, unseen = peak - level, max(ROUNDED * abs(peak), 2.0 * CHANCE * noise)
    if peak - level <= unseen:
        missed = _missed_rise(mu, level - unseen)
    else:
        missed = _missed_fall(mu[top:], peak - 0.5 * fall, CHANCE * noise)
    return Peak(peak, hypot(missed / sqrt(3.0), CHANCE * noise))


def noise_of(mu: Floats, late: Floats) -> float:
    """Return the noise of friction, by differences of its samples or by its steady end."""
    return max(white_noise(mu) if len(mu) > ORDER else 0.0, _scatter(late))


def _scatter(late: Floats) -> float:
    """Return the scatter of friction about its trend: differences see no noise that is filtered."""
    if len(late) <= ORDER:
        return 0.0
    x = np.arange(float(len(late)))
    return float(line(x, late).deviations(x, late).std())


def _missed_rise(mu: Floats, level: float) -> float:
    """Return how high a peak may be that no sample shows: as friction rises from one to the next.

    It is unknown where friction rises within two samples: the spring may load far quicker.
    """
    last = int(np.flatnonzero(mu >= level)[0])
    return float(np.diff(mu[: last + 1]).max()) if last > 2 else nan


def _missed_fall(mu: Floats, half: float, noise: float) -> float:
    """Return how much friction may have fallen by the highest sample, the first.

    It is the fall within a sample; more, if it becomes less from each sample to the next. It is
    unknown where few samples show the fall.
    """
    fallen = np.flatnonzero(mu <= half)
    count = int(fallen[0]) if len(fallen) else len(mu)
    if count < RESOLVED:
        return nan
    first, second = float(mu[0] - mu[1]), float(mu[1] - mu[2])
    steeper = first * max(1.0, first / second) if second > 2.0 * noise else first
    return max(STEEPEST * float(mu[0] - half) / count, steeper)


def peaks_of_run(run: Trajectory, slides: Sequence[ConstantStretch]) -> list[Peak]:
    """Return the peak of each slide of a run, however it is sampled.

    The run is repeated, with samples within each of its own steps, then around the highest of them.
    """
    slider, cell = run.slider, run.slider.load_cell

    def friction(times: Floats) -> Floats:
        u_x, u_y = states_at(run, times)[:, :2].T
        return np.asarray(cell.ahead * cell.along(slider.k_x * u_x, slider.k_y * u_y))

    starts, lengths = panels(run, np.unique([t for slide in slides for t in slide[:2]]))
    ends = np.append(starts, starts[-1] + lengths[-1])
    fine = np.interp(np.arange(PER_PANEL * len(starts) + 1) / PER_PANEL, np.arange(len(ends)), ends)
    looked = [fine[(fine >= slide.start) & (fine <= slide.end)] for slide in slides]
    coarse = _highest(friction, looked, slides)
    near = [
        np.linspace(times[max(at - 1, 0)], times[min(at + 1, len(times) - 1)], FINER + 1)
        for (at, _), times in zip(coarse, looked, strict=True)
    ]
    found = _highest(friction, near, slides)
    tolerance = run.description.run.rtol
    return [
        # a parabola is off by a share of what finer samples add, (2/FINER)^2 of which is left
        Peak(max(peak, before), tolerance * peak + abs(peak - before) * (4.0 / FINER) ** 2)
        for (_, peak), (_, before) in zip(found, coarse, strict=True)
    ]


def _highest(
    friction: Callable[[Floats], Floats],
    looked: Sequence[Floats],
    slides: Sequence[ConstantStretch],
) -> list[tuple[int, float]]:
    """Return the index of the highest friction in each slide, and that friction."""
    times = np.unique(np.concatenate(looked))
    force = friction(times)
    found = []
    for slide, here in zip(slides, looked, strict=True):
        mu = slide.way * force[np.searchsorted(times, here)] / slide.load
        found.append((int(mu.argmax()), float(mu.max())))
    return found
