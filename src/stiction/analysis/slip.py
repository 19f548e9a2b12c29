"""Slip speed: averages over short times, and the outcome of a whole run."""

from __future__ import annotations

from math import nan
from typing import NamedTuple

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from stiction.analysis.creep.first_slip import first_slip_time
from stiction.arrays import Floats, Indices
from stiction.errors import Status
from stiction.result.peak import largest_between
from stiction.result.table import ROUNDED_WAY, fastest_slip, largest, unseen_ways
from stiction.simulation import sample_coarsely, step_times
from stiction.system.slider import Slider
from stiction.trajectory import Trajectory

FINE_BINS = 8  # bins in each time that is averaged over
SEEN = 4  # samples for each stick: with fewer, what lies between two sticks is not seen
OF_A_SLIP = 2  # nor with fewer in each slip
HUNDREDTHS = 100  # of the first loading
MOST_STEPS, PER_STEP = 20_000, 16  # of a run solved again, and samples in each: it takes 1 s
ROUNDS = 4  # of solving it, each with so many samples in an interval that needs them


class Slip(NamedTuple):
    """Slip speed (m/s) averaged over a short time, arrays of shape (n,).

    Parameters
    ----------
    time, force : ndarray
        Time (s) and the load cell's force (N).
    mean, high : ndarray
        Mean and largest slip speed; of a run that `is_undersampled`, the mean is that of its motion
        from place to place, without the oscillation.
    rest : ndarray
        Share of the samples at zero slip, 0 to 1.
    """

    time: Floats
    force: Floats
    mean: Floats
    high: Floats
    rest: Floats


def _mean_speeds(run: Trajectory, at: Indices) -> Floats:
    """Return the mean speeds (m/s) of the mass from one to the next of some samples, by places."""
    places = [run.samples[name][at] for name in ("X", "Y", "u_x", "u_y")]
    moved = np.hypot(*map(np.diff, places[:2]))
    moved[moved < ROUNDED_WAY * np.abs(places).max()] = 0.0
    speeds: Floats = moved / np.diff(run.samples["time"][at])
    return speeds


def cell_force(run: Trajectory) -> Floats:
    """Return the force that the load cell shows, N: k_x u_x, or that along its own axis."""
    force: Floats = run.slider.load_cell.along(run.samples["spring_x"], run.samples["spring_y"])
    return force


def largest_coefficient(run: Trajectory) -> float:
    """Return the largest ratio of the load cell's force to the normal load; NaN without a load.

    Under a constant load it may lie between two samples.
    """
    slider, samples = run.slider, run.samples
    force, load = cell_force(run), samples["normal_load"]
    if np.ptp(load) == 0.0 < load[0]:
        rates = slider.k_x * samples["v_x"], slider.k_y * samples["v_y"]
        rate = slider.load_cell.along(*rates)
        return largest_between(samples["time"], force, rate).force / float(load[0])
    return largest(np.divide(force, load, out=np.full_like(force, nan), where=load > 0.0))[1]


def cell_symbol(slider: Slider) -> str:
    """Return the name of the load cell's force in tables and figures."""
    return "k_x u_x" if slider.cell_angle is None else "cell force"


def averaged_slip(run: Trajectory, parts: int) -> Slip:
    """Average a run over windows of a `parts`-th of its time, with tapering weights.

    Samples that are farther apart stay as they are. Where there are too few samples for the slip
    speed (`is_undersampled`), its mean would depend on chance: then the mean velocity between two
    places is taken, which the positions give exactly.
    """
    size = len(run.samples["time"])
    starts = np.unique(np.linspace(0, size, FINE_BINS * parts, endpoint=False).astype(np.intp))
    counts = np.diff(starts, append=size)
    half = len(starts) // parts
    window = np.hanning(2 * half + 1) if half > 1 else np.ones(1)
    weight = np.convolve(counts, window, "same")[: len(starts)]

    def mean(values: Floats) -> Floats:
        total = np.convolve(np.add.reduceat(values, starts), window, "same")
        result: Floats = total[: len(starts)] / weight
        return result

    high = np.maximum.reduceat(run.samples["slip_speed"], starts)
    if half > 1:
        high = sliding_window_view(np.pad(high, half), 2 * half + 1).max(axis=1)
    time = run.samples["time"]
    if is_undersampled(run) and size > 1:
        speed = np.hypot(*(mean(np.gradient(run.samples[name], time)) for name in ("X", "Y")))
        high = np.maximum(high, speed)
    else:
        speed = mean(run.samples["slip_speed"])
    at, sticking = np.add.reduceat(time, starts) / counts, run.samples["sticking"]
    return Slip(at, mean(cell_force(run)), speed, high, mean(sticking.astype(np.float64)))


def is_undersampled(run: Trajectory) -> bool:
    """Return whether a run has too few samples to show each motion between two sticks.

    Samples then show a slower beat of the oscillation with themselves.
    """
    time, sticks = run.samples["time"], run.stick_intervals
    if len(sticks) * SEEN > len(time):
        return True
    lasts = float(time[-1] - time[0])
    slips = (lasts - float(np.diff(sticks).sum())) * len(time)  # its samples, times the duration
    return len(sticks) > 1 and slips < OF_A_SLIP * (len(sticks) - 1) * lasts


class Outcome(NamedTuple):
    """The outcome of a run."""

    status: Status  # how it ended
    sticks: int  # number of stick intervals
    time_stuck: float  # their total duration, s
    # largest ratio of the load cell's force, in either direction, to the normal load at the same
    # instant; NaN without a load. Under a load that falls it comes later than the largest force
    peak: float
    # largest slip speed, m/s. Where samples do not show it, the run is solved again, sampled by the
    # steps of the solver; where these are too many, it is a lower bound
    fastest: float
    hidden: bool  # whether it is a lower bound: the mass is faster, between two samples
    # smallest mean speed over a hundredth of the first loading, m/s, so that the speed at the
    # release does not count; zero if the mass rests during the loading, however shortly
    slowest: float
    # median over hundredths of the first loading of the distance between their ends over their
    # time, m/s: zero only if the mass rests for half of it. Places are exact however few samples
    # there are; means of the slip speed would show the phase of the oscillation at the samples
    creep: float
    steps: int  # slip steps of the solver


def outcome(run: Trajectory) -> Outcome:
    """Return the outcome of a run; more samples make the speeds more accurate."""
    speed, times = run.samples["slip_speed"], run.samples["time"]
    end = first_slip_time(run)
    loading = speed[: np.searchsorted(times, end) + 1]
    ends = np.unique(np.linspace(0, len(loading) - 1, HUNDREDTHS + 1).astype(np.intp))
    means = _mean_speeds(run, ends) if len(ends) > 1 else loading[:1]
    fastest, shown = _fastest_slip(run)
    rests = bool((run.stick_intervals[:, 0] < end).any())
    statistics = run.statistics
    return Outcome(
        run.status,
        statistics.stick_count,
        statistics.time_stuck,
        largest_coefficient(run),
        fastest,
        not shown,
        0.0 if rests else float(means.min()),
        float(np.median(means)),
        statistics.steps,
    )


def _fastest_slip(run: Trajectory) -> tuple[float, bool]:
    """Return the largest slip speed (m/s) of a run, and whether it is more than a lower bound."""
    fastest, shown = fastest_slip(run.samples)
    times = step_times(run.description, MOST_STEPS) if run.status.ok and not shown else None
    if times is None:
        return fastest, shown
    chosen = np.full(len(times) - 1, True)
    for _ in range(ROUNDS):  # cycles that are taken at once are one step
        times = _divide(times, chosen)
        closer = sample_coarsely(run.description, times)
        by_steps, shown = fastest_slip(closer)
        fastest = max(fastest, by_steps)
        chosen = unseen_ways(closer, fastest)
        if shown or PER_STEP * chosen.sum() > MOST_STEPS:
            break
    return fastest, shown


def _divide(times: Floats, chosen: NDArray[np.bool_]) -> Floats:
    """Return times with some of the intervals between them divided into equal parts."""
    start, step = times[:-1][chosen, None], np.diff(times)[chosen, None]
    return np.union1d(times, start + step * (np.arange(1, PER_STEP) / PER_STEP))
