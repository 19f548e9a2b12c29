"""The simulated test of an apparatus, as its load cell would record it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import exp, isfinite, nan
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from stiction.analysis.creep.first_slip import first_slip_time, slips, slips_at_once
from stiction.analysis.limit_cycle import KICK
from stiction.analysis.measurement.run_record import across_force, record_of
from stiction.analysis.motion.cycle_columns import CycleTable
from stiction.analysis.motion.cycles import Swings, own_swings
from stiction.analysis.motion.regime.classify import regime_of
from stiction.analysis.motion.regime.evidence import SLOWER, Evidence, Regime
from stiction.analysis.motion.regime.kinds import SETTLING, STEADY
from stiction.analysis.motion.rest import stuck_share
from stiction.analysis.record import Record
from stiction.analysis.signals.reversals import extrema
from stiction.arrays import Floats, xr
from stiction.auditing.prediction import SEEN, Prediction
from stiction.linear_stability import Linearisation, growth_rate
from stiction.progress.report import Progress, silent
from stiction.result.table import mean_speeds
from stiction.simulation import simulate
from stiction.system.initial import Initial
from stiction.system.slider import Slider
from stiction.trajectory import Trajectory

CYCLES = 6  # of expected stick-slip to simulate
LOAD_UPS = 4.0  # to wait for a force that approaches the friction limit only slowly
DECAYS = 8.0  # e-folds of a disturbance to wait for, down to a thousandth
LONGEST_WAIT = 2000.0  # longest wait for that, in swings on the soft spring
COARSE = 40.0  # samples in each swing on the soft spring
ALMOST = 0.99  # of the largest force: the mass is loaded
MOST_SAMPLES = 200_000
MOST_WORK = 7_000_000  # steps and samples of all simulations of an audit: 2 s without states
LEAST_WORK = 20_000  # steps: a trial with fewer would be cut
SHARE = 0.35  # of that for each of the tests from rest and from sliding
FINE_SAMPLES = 1000.0  # samples from the one before the first slip to the one after it
MANY = 50_000  # transverse periods above which fewer cycles are simulated

SMALL = "an oscillation too small for the load cell to tell"
LOADING = "a loading that outlasts the test"
# final states of a run, and the states of one that ends too early
SLIDES, OSCILLATES = "slides", "oscillates"
UNSETTLED, LOADS = "unsettled", "loads"
CALM = 0.02  # of the drive's speed: a smaller deviation is steady sliding
DECAYED, KEPT = 0.5, 0.8  # of a deviation, a quarter of the run later: dies out, lasts
AS_FAST = 0.5  # of the rate at which small disturbances decay: it does so, too
SLIPPED = 0.5  # of the drive's speed: a mass that stays slower does not slip
FOLLOWS = 0.9  # of the drive's travel: a mass that covers less lags ever more, and springs load
MOSTLY = 0.5  # of the drive's speed: how far a larger deviation goes, samples may not show


class Shares(NamedTuple):
    """Shares of time at rest, creeping more slowly than the drive, and slipping."""

    rest: float
    creep: float
    slip: float


@dataclass(frozen=True)
class SimulatedTest:
    """A simulated test: the run, its record, and the record's analysis on request.

    Most trials of a change need the final state alone, and the analysis of a record takes as long
    as its simulation.
    """

    run: Trajectory
    growth: float = nan  # 1/s, of a small disturbance of steady sliding

    @cached_property
    def record(self) -> Record:
        """The record of its load cell."""
        return record_of(self.run)

    @cached_property
    def swings(self) -> Swings:
        """The swings of the force; drive and load are steady, so that nothing disturbs them."""
        return own_swings(self.record)

    @cached_property
    def table(self) -> CycleTable:
        """The cycles; none if the motion dies out."""
        lasting = self.swings.lasting
        return lasting.part(slice(0)) if self.comes_to == SLIDES else lasting

    @cached_property
    def cycles(self) -> xr.Dataset:
        """The cycles for xarray, as `stiction.analysis.find_cycles` returns them."""
        return self.table.as_dataset()

    @cached_property
    def regime(self) -> Regime:
        """The kind of motion, with the share of time at rest or in creep from `shares`."""
        seen = regime_of(self.record, self.swings)
        if not seen.loads:
            return seen
        slower: dict[Evidence, float] = {SLOWER: self.shares.rest + self.shares.creep}
        return seen._replace(evidence=slower | seen.evidence)

    @cached_property
    def shares(self) -> Shares:
        """Shares of time at rest, in creep and in slip."""
        return shares(self.run, self.record.force, self.table)

    @cached_property
    def comes_to(self) -> str:
        """The final state of the mass.

        It slides or oscillates; or the test ends too early, while springs are loaded ("loads") or
        the motion still changes ("unsettled").
        """
        return final_state(self.run, self.growth)

    @property
    def decided(self) -> bool:
        """Whether the test reached a final state."""
        return self.comes_to in (SLIDES, OSCILLATES)

    @property
    def duration(self) -> float:
        """The duration of the test, s."""
        times = self.run.samples["time"]
        return float(times[-1] - times[0])

    @cached_property
    def settled(self) -> float:
        """The time of steady sliding, s, after which the speed stays within 2 % of the drive's.

        NaN where that takes longer than the test.
        """
        times = self.run.samples["time"]
        differs = np.flatnonzero(np.abs(relative_speed(self.run) - 1.0) >= CALM)
        after = int(differs[-1]) + 1 if len(differs) else 0
        return float(times[after] - times[0]) if after < len(times) else nan

    @property
    def travel(self) -> float:
        """The drive's travel until steady sliding, m; NaN if it is not reached."""
        return self.run.slider.drive_speed * self.settled

    @cached_property
    def slip_time(self) -> float:
        """The start of the first slip, s; NaN if there is none."""
        slip = first_slip_time(self.run)
        return slip if slip < self.record.time[-1] else nan

    @property
    def motion(self) -> str:
        """The name of the final motion, as the load cell shows it."""
        calm = self.regime.kind in (SETTLING, STEADY)
        if self.comes_to == SLIDES:
            return self.regime.kind if calm else SETTLING
        if self.comes_to == OSCILLATES:
            return SMALL if calm else self.regime.kind
        return LOADING if self.comes_to == LOADS else self.regime.kind

    @property
    def blind(self) -> bool:
        """Whether the load cell stands across the springs' force, by `across_force`."""
        return across_force(self.run, self.record)

    @property
    def work(self) -> int:
        """The work of the simulation in solver steps, accepted or rejected, and samples."""
        steps = self.run.statistics
        return steps.steps + steps.rejected + len(self.run.samples["time"])

    @property
    def coarse(self) -> bool:
        """Whether the sampling is too coarse for the transverse oscillation."""
        least = 0.9 * SEEN * self.run.slider.natural_frequency_y
        return bool(self.record.sample_rate < least)

    def mean(self, name: str) -> float:
        """Return the mean of a quantity over the cycles; NaN if there are none."""
        return self.table.mean(name)


def simulate_test(
    slider: Slider,
    prediction: Prediction,
    growth: float,
    *,
    sample_rate: float,
    start: Initial | None = None,
    multiscale: bool | Literal["auto"] | None = None,
    most_steps: int = int(SHARE * MOST_WORK),
    progress: Progress = silent,
) -> SimulatedTest:
    """Simulate a friction test.

    It lasts for `duration_of`. The sample rate is reduced if there would be too many samples. It
    starts at rest with unloaded springs by default, and is `multiscale` by
    default where it has very many transverse periods; the solver takes `most_steps` at most.
    """
    duration = duration_of(slider, prediction, growth)
    if multiscale is None:
        multiscale = duration * prediction.f_y > MANY
    run = simulate(
        slider,
        duration,
        initial=start,
        sample_rate=min(sample_rate, MOST_SAMPLES / duration),
        multiscale=multiscale,
        max_steps=most_steps,
        progress=progress,
    )
    return SimulatedTest(run, growth)


def duration_of(slider: Slider, prediction: Prediction, growth: float) -> float:
    """Return the duration of a test by all time scales that theory knows, s.

    It covers the loading of both springs, cycles of the predicted stick-slip, and the decay or the
    growth of a disturbance of steady sliding at the rate `growth` (1/s).
    """
    load_up, soft = time_of_loading(slider, prediction), min(prediction.f_x, prediction.f_y)
    cycles = CYCLES * prediction.period if prediction.slips else 0.0
    if not prediction.slips and growth > 0.0:  # what grows swings, and may rest between swings
        cycles = CYCLES * 2.0 / soft
    wait = DECAYS / abs(growth) if growth != 0.0 else 0.0
    longest = LOAD_UPS * load_up + LONGEST_WAIT / soft
    duration = min(max(LOAD_UPS * load_up, 1.2 * load_up + max(cycles, wait)), longest)
    return duration or CYCLES / soft  # without friction nothing is loaded


def time_of_loading(slider: Slider, prediction: Prediction) -> float:
    """Return the time in which the drive loads both springs, s.

    The first stick is the shortest; where it ends without a slip, friction turns until it lies
    along the drive, and the softer spring goes on loading.
    """
    load_up = max(prediction.load_up, prediction.first_stick)
    if slips_at_once(slider):
        return max(load_up, slider.loading_time)
    if slider.stiffer_axis == 0:  # Eq. (7), which `prediction` takes, supposes a stiff y
        return max(load_up, slider.F_0 / (slider.k_y * slider.drive_speed))
    return load_up


def simulate_coarsely(
    slider: Slider,
    prediction: Prediction,
    most_steps: int,
    progress: Progress = silent,
    multiscale: Literal["auto"] | None = None,
) -> SimulatedTest:
    """Simulate a friction test from rest, sampled for its slow motion alone."""
    return simulate_test(
        slider,
        prediction,
        growth_rate(slider),
        sample_rate=coarse_rate(prediction),
        multiscale=multiscale,
        most_steps=most_steps,
        progress=progress,
    )


def from_sliding(
    linear: Linearisation, prediction: Prediction, progress: Progress = silent
) -> SimulatedTest:
    """Simulate the test from steady sliding, disturbed by a hundredth of the speed."""
    return simulate_test(
        linear.slider,
        prediction,
        linear.growth_rate,
        sample_rate=coarse_rate(prediction),
        start=linear.disturbed_start(KICK),
        progress=progress,
    )


def final_state(run: Trajectory, growth: float = nan) -> str:
    """Return the final state of a run, by its deviation from steady sliding at the end.

    The last quarters of the run count, and what samples show however short a slip is: the mean
    speed from one to the next, the slow part of a cycle, and the swing of the force. The fastest
    sample of a slip that lasts less than their distance is chance. As long as the mass lags ever
    more behind the drive, springs are loaded, which does not last. A deviation of speed counts up
    to that of a mass at rest, and where it is most of that in both quarters, their swings of the
    force are compared. What dies out as a small disturbance does, by its `growth` rate (1/s), lasts
    no longer than that, however slowly it does; nothing dies out where that grows in a quarter.
    """
    times, speed = run.samples["time"], relative_speed(run)
    spring = run.slider.along_drive(run.samples["u_x"], run.samples["u_y"])
    whole = float(times[-1] - times[0])
    last = times - times[0] >= 0.75 * whole
    third = (times - times[0] >= 0.5 * whole) & ~last
    if not third.any():  # it ended before
        return UNSETTLED
    if _lags(run, last) and not slips(run):
        return LOADS
    means = mean_speeds(times, run.samples["X"]) / run.slider.drive_speed
    fastest = np.maximum(speed, np.append(means, 0.0))
    if fastest[third | last].max() < SLIPPED:  # too long at rest: does it slip again alike?
        return UNSETTLED
    deviation = np.minimum(np.maximum(1.0 - speed, fastest - 1.0), 1.0)
    before, now = float(deviation[third].max()), float(deviation[last].max())
    grown = growth * 0.25 * whole
    if now < CALM:
        return UNSETTLED if grown > 1.0 else SLIDES
    if min(before, now) > MOSTLY:
        if grown > 1.0 or fastest[last].max() < SLIPPED:  # it rests again
            return OSCILLATES
        before, now = _largest_leg(spring[third]), _largest_leg(spring[last])
    if now >= KEPT * before:
        dies_out = growth < 0.0 and now <= before * exp(AS_FAST * grown)
        return UNSETTLED if dies_out else OSCILLATES
    return SLIDES if now <= DECAYED * before and not grown > 1.0 else UNSETTLED


def _largest_leg(values: Floats) -> float:
    """Return the largest change from one turning point to the next: a drift has no part in it."""
    return float(np.abs(np.diff(values[extrema(values)])).max(initial=0.0))


def _lags(run: Trajectory, part: NDArray[np.bool_]) -> bool:
    """Return whether the mass covers less than the drive does in a part of a run."""
    time, X = run.samples["time"][part], run.samples["X"][part]
    drive = run.slider.motion.rate(0.0)[0] * (time[-1] - time[0])
    return bool((X[-1] - X[0]) / drive < FOLLOWS)


def coarse_rate(prediction: Prediction) -> float:
    """Return a sample rate (Hz) for the slow motion alone."""
    return COARSE * prediction.f_x


def relative_speed(run: Trajectory) -> Floats:
    """Return the ratio of the mass's speed along the drive to the drive's, (n,)."""
    return np.asarray(run.samples["V_X"] / run.slider.motion.rate(0.0)[0])


def shares(run: Trajectory, force: Floats, cycles: CycleTable) -> Shares:
    """Return the shares of time in whole cycles, or in the loading if there are none."""
    times, speed = run.samples["time"], relative_speed(run)
    begin, end = float(times[0]), float(times[end_of_loading(force)])
    if len(cycles):
        begin, end = float(cycles["start"][0]), float(cycles["trough_time"][-1])
    if not end > begin:  # started sliding
        return Shares(0.0, 0.0, 1.0)
    slip = float((speed[(times >= begin) & (times <= end)] > 1.0).mean())
    rest = stuck_share(begin, end, run.stick_intervals)
    return Shares(rest, max(0.0, 1.0 - slip - rest), slip)


def end_of_loading(force: Floats) -> int:
    """Return the sample at the end of loading, where the force nears its largest value."""
    return int(np.argmax(force >= ALMOST * force.max()))


def creep_before_slip(seen: SimulatedTest) -> float:
    """Return the displacement until the first slip, m; NaN if there is none.

    The mass is as fast as the drive when it slips, and may cover more between two samples than it
    has crept before: what lies between the samples about the slip is simulated again. By the cubic
    through them, which a study takes, 3 of 47 distances were 9 to 67 % off.
    """
    run, slip = seen.run, seen.slip_time
    if not isfinite(slip):
        return nan
    time, X = run.samples["time"], run.samples["X"]
    at = int(np.searchsorted(time, slip))
    begin, end = max(at - 1, 0), at + 1
    lasts = float(time[end] - time[begin])
    start = run.state(float(time[begin]))
    again = simulate(run.slider, lasts, initial=start, sample_rate=FINE_SAMPLES / lasts).samples
    drive = again["drive_X"]
    loaded = np.sign(drive) * run.slider.along_drive(again["u_x"], again["u_y"])
    largest = int(np.argmax(loaded))
    near = slice(max(largest - 1, 0), largest + 2)
    gain = np.abs(again["V_X"]) - np.abs(drive)
    moved = np.abs(X[begin] - X[0] + again["X"] - again["X"][0])
    return float(np.interp(0.0, gain[near], moved[near]))
