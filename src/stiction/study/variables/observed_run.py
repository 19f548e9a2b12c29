"""An observed run, the input of the measures: its samples as plain arrays."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from math import nan
from typing import NamedTuple

import numpy as np

from stiction.analysis.creep.first_slip import first_loading
from stiction.analysis.motion.course import COURSE_PARTS
from stiction.analysis.motion.noiseless.extremes import summit
from stiction.analysis.motion.noiseless.features import Features, features
from stiction.analysis.motion.noiseless.resolution import (
    UNEXPLAINED,
    least_drop,
    residual_changes,
    shows_motion,
)
from stiction.analysis.motion.noiseless.swings import SwingShapes, swings
from stiction.analysis.motion.regime.kinds import STUCK, UNDETERMINED
from stiction.analysis.motion.regime.of_run import (
    Circumstances,
    kind_of_cycles,
    regime_without_cycles,
    rest_of,
    settle,
    sticks_of,
)
from stiction.analysis.motion.rest import rests_throughout
from stiction.analysis.motion.vibration import FastOscillation
from stiction.analysis.signals.hum import beat_frequency
from stiction.arrays import TINY, Floats
from stiction.drive import ConstantVelocity
from stiction.drive.program import nominal_velocity
from stiction.errors import STATUSES
from stiction.simulation import solve, solve_coarsely, trajectory_of
from stiction.solver.integrate import Room, Solution
from stiction.study.variables.columns import even_columns
from stiction.study.variables.sampling import SampleTimes, even_times, refine, sampling_of
from stiction.system.description import Description
from stiction.trajectory import Trajectory

UNEXPLAINED_VELOCITY = 0.05  # of the fastest: a harmonic of 8 samples, whose peaks are 0.07 off
# Times the way of the drive between two samples: creep by more is known to 1e-3 from these; and the
# number of closer ones about the slip, where it is less
CLEARLY, CLOSE = 40.0, 4097
ROUNDED = 1e-12  # relative: elongations of a mass at rest in a hold that differ by less are equal
# Samples for each period of the faster swing, and the most of them, where a gain of the mass on the
# drive is nearly that of a slip
PER_FAST_PERIOD, MOST_CLOSE = 32.0, 2.0**18
# Samples that follow the solver are refined so often, until each change is explained to this share;
# what is not explained falls with the third power of their distance
ROUNDS, REFINED, MOST_PARTS = 5, 0.1, 32.0
JUMPS = 0.01  # of the samples: with so few a drive may jump between


class Loading(NamedTuple):
    """How the spring is loaded along X, over time (s).

    That is its elongation (m), its rate and the velocity of the drive (m/s), (n,) each; the last is
    one value if constant.
    """

    time: Floats
    elongation: Floats
    rate: Floats
    drive: Floats


@dataclass(frozen=True)
class ObservedRun:
    """A run as the solver returns it: samples, denser near its end.

    Parameters
    ----------
    description : Description
        The description of the run.
    solution : Solution
        Samples, stick intervals and counts.
    sampling : SampleTimes
        The times of the samples.
    """

    description: Description
    solution: Solution
    sampling: SampleTimes

    @property
    def start(self) -> float:
        """Start of the run, s."""
        return float(self.solution.times[0])

    @property
    def end(self) -> float:
        """End of the run, s."""
        return float(self.solution.times[-1])

    @cached_property
    def time(self) -> Floats:
        """(n,), s, without the denser samples."""
        return self._thin_out(self.solution.times)

    def _thin_out(self, values: Floats) -> Floats:
        fine = self.sampling.fine
        return np.concatenate([values[:fine], values[fine :: self.sampling.parts]])

    @cached_property
    def trajectory(self) -> Trajectory:
        """The run at even samples, as `stiction.run` returns it, in memory of its own."""
        if self.sampling.even:
            samples = self._thin_out(self.solution.samples)
            even = self.solution._replace(times=self.time, samples=samples)
        else:
            even = solve_coarsely(self.description, even_times(self.description))
        return trajectory_of(self.description, even)

    @cached_property
    def _columns(self) -> Floats:
        """(5, n), force and its rate, velocity, slip speed and elongation at `time`."""
        slider = self.description.slider
        found: Floats = even_columns(
            self.solution.samples, self.sampling.fine, self.sampling.parts, self.drive, self.way,
            slider.k_x, *slider.direction,
        )  # fmt: skip
        return found

    @cached_property
    def resolved(self) -> bool:
        """Whether the samples resolve the motion: each sample follows from the one before.

        Samples farther apart than a period show a slower motion, which is not there; the force then
        changes by other amounts than its rates tell.
        """
        if self.sampling.enough:
            return True
        drops, span, rtol = self.cycles.drop, float(np.ptp(self.force)), self.description.run.rtol
        return shows_motion(self.missed, drops, span, self.features, rtol)

    @property
    def least_drop(self) -> float:
        """The smallest drop of a cycle, N; without cycles the span of the force."""
        return least_drop(self.cycles.drop, float(np.ptp(self.force)))

    @property
    def missed(self) -> Floats:
        """(n - 1,), change of the force between two samples that their rates do not explain, N."""
        return np.abs(residual_changes(self.time, self.force, self.rate))

    @cached_property
    def resolved_velocities(self) -> bool:
        """Whether the samples show the velocities of mass and drive, too."""
        if self.sampling.enough or not self.resolved:
            return self.resolved
        travel = self.description.slider.motion.travel(0.0, self.time)[0]
        drive = np.broadcast_to(self.drive, self.time.shape)
        for place, velocity in ((self.positions, self.velocity), (travel, drive)):
            missed = np.abs(residual_changes(self.time, place, velocity)) / np.diff(self.time)
            usual = np.quantile(missed, 1.0 - JUMPS)
            if usual > UNEXPLAINED_VELOCITY * np.abs(velocity).max():
                return False
        return True

    @cached_property
    def nominal(self) -> float:
        """Velocity of the drive, m/s: the base of a program, or that of its recorded pieces."""
        return nominal_velocity(self.description.slider.motion)

    @cached_property
    def way(self) -> float:
        """1 if the spring is pulled towards positive x, else -1."""
        slider = self.description.slider
        return -1.0 if self.nominal * slider.direction[0] < 0.0 else 1.0

    @cached_property
    def force(self) -> Floats:
        """Spring force k_x u_x, positive along the drive (N)."""
        return np.asarray(self._columns[0])

    @cached_property
    def drive(self) -> Floats:
        """Velocity of the drive along X (m/s): one value if constant, else one per sample."""
        motion = self.description.slider.motion
        constant = isinstance(motion, ConstantVelocity)
        return np.array([motion.velocity]) if constant else np.asarray(motion.rate(self.time)[0])

    @cached_property
    def rate(self) -> Floats:
        """Rate of the spring force (N/s)."""
        return np.asarray(self._columns[1])

    @cached_property
    def velocity(self) -> Floats:
        """Velocity X' of the mass, positive in the direction of the drive (m/s)."""
        return np.asarray(self._columns[2])

    @cached_property
    def slip_speed(self) -> Floats:
        """Slip speed, m/s."""
        return np.asarray(self._columns[3])

    @property
    def positions(self) -> Floats:
        """Position X of the mass along the drive (m): Eq. (6) of Nakano & Popov."""
        travel = self.description.slider.motion.travel(0.0, self.time)[0]
        return np.asarray(self.way * (travel - self.elongation))

    @cached_property
    def elongation(self) -> Floats:
        """Elongation of the spring along the drive direction X, m."""
        return np.asarray(self._columns[4])

    @property
    def elongation_rate(self) -> Floats:
        """Rate of that elongation, m/s."""
        return np.asarray(self.drive - self.way * self.velocity)

    @cached_property
    def features(self) -> Features:
        """Features of the samples at `time`."""
        least, driven = self.description.run.rtol, len(self.time)
        if len(self.drive) > 1 and self.drive.any():
            driven = int(np.flatnonzero(self.drive)[-1]) + 1
        return features(
            self.time, self.force, self.rate, self.velocity, least=least, driven=driven,
            parts=COURSE_PARTS, even=self.sampling.even,
        )  # fmt: skip

    @property
    def peak(self) -> float:
        """The largest force, N; between samples where these resolve the motion."""
        return self.features.peak if self.resolved else float(self.force.max())

    @property
    def late_span(self) -> float:
        """Span of the force in the last quarter (N), whose ends lie between samples likewise."""
        if self.resolved:
            return self.features.late_span
        late = self.time >= self.start + 0.75 * (self.end - self.start)
        return float(np.ptp(self.force[late]))

    @cached_property
    def first_slip(self) -> tuple[float, float]:
        """Start of the first slip (s), and the distance of the mass until then (m).

        Wherever samples fall, each is known to 1e-3 of itself. The mass moves as fast as the drive
        there, so that the next sample is up to half as far again: where it crept hardly farther
        than the drive between two samples, it is solved again with closer ones. A distance below
        that between these is not known.
        """
        seen, at = self._surely_loaded()
        if at < 0:
            return nan, nan
        found = self._slip_near(seen, at)
        time, fastest = seen.time, np.abs(seen.drive).max()
        if found[1] > CLEARLY * fastest * (time[at] - time[at - 1]):
            return found
        times = np.linspace(time[max(at - 1, 0)], time[min(at + 1, len(time) - 1)], CLOSE)
        close = self._solve_again(times)
        long = self.way * close.elongation
        longest = long >= long.max() - ROUNDED * np.abs(long).max()
        begin, crept = self._slip_near(close, int(np.flatnonzero(longest)[-1]))  # a rest's end
        return begin, crept if crept > np.abs(close.drive).max() * (times[1] - times[0]) else nan

    def _surely_loaded(self) -> tuple[Loading, int]:
        """Return samples of the first loading, and that at which its slip begins, -1 without one.

        A mass that gains on its drive by nearly as much as in a slip has slipped, or not, by what
        happens between samples: there it is solved again with closer ones.
        """
        slider = self.description.slider
        seen = Loading(self.time, self.elongation, self.elongation_rate, self.drive)
        at = first_loading(slider, *seen).slip
        missed = residual_changes(*seen[:3])[: at if at > 0 else None]
        hidden = float(np.abs(missed).max())
        early, late = (first_loading(slider, *seen, more=off).slip for off in (-hidden, hidden))
        if early == late:
            return seen, at
        begin, swing = float(seen.time[max(early - 1, 0)]), 1.0 / slider.natural_frequencies[0]
        until = self.end if late < 0 else min(float(seen.time[late]) + swing, self.end)
        count = PER_FAST_PERIOD * slider.natural_frequencies[1] * (until - begin)
        close = self._solve_again(np.linspace(begin, until, int(min(count, MOST_CLOSE)) + 2))
        fastest = float(np.abs(seen.drive).max())
        found = first_loading(slider, *close, fastest=fastest).slip
        return (seen, late) if found < 0 <= late else (close, found)

    def _slip_near(self, seen: Loading, at: int) -> tuple[float, float]:
        """Return the time (s) of the longest spring near a sample, and the travel by then (m)."""
        begin, longest = summit(*seen[:3], at, self.way)
        travel = self.description.slider.motion.travel(0.0, np.array([begin]))[0][0]
        return float(begin), float(self.way * (travel - longest) - self.positions[0])

    def _solve_again(self, times: Floats) -> Loading:
        """Return the loading of the run at other times (s), until the last of them."""
        slider, initial, settings = self.description
        until = settings.model_copy(update={"duration": float(times[-1]) - initial.time})
        solution = solve(self.description._replace(run=until), times)
        drive = np.atleast_1d(np.asarray(slider.motion.rate(times)[0]))
        _, _, velocity, _, elongation = even_columns(
            solution.samples, 0, 1, drive, self.way, slider.k_x, *slider.direction
        )
        return Loading(times, elongation, np.asarray(drive - self.way * velocity), drive)

    @cached_property
    def swings(self) -> SwingShapes:
        """Complete swings of the force."""
        return swings(self.features)

    @cached_property
    def circumstances(self) -> Circumstances:
        """Conditions on which the kind of motion depends."""
        slider = self.description.slider
        loading = slider.k_x * abs(self.nominal * slider.direction[0])
        return Circumstances.of(
            slider, self.time, self.swings, loading, self.slip_speed, self.solution.sticks
        )

    @cached_property
    def cycles(self) -> SwingShapes:
        """The swings that are cycles."""
        return self.swings.cycles(self.circumstances.until)

    @cached_property
    def transverse_oscillation(self) -> float:
        """Rate amplitude of the final fast oscillation over the drive's velocity along it.

        This is half the span of the elongation rate along the stiffer axis, at most 1 unless the
        slip reverses (Nakano & Popov, below Eq. (9)).
        """
        return self.fast_oscillation.amplitude

    @cached_property
    def fast_oscillation(self) -> FastOscillation:
        """The final fast oscillation."""
        slider = self.description.slider
        rate = self.solution.samples[self.sampling.fine :, 2 + slider.stiffer_axis]
        return FastOscillation.at_end(slider, rate)

    @cached_property
    def regime(self) -> str:
        """The kind of motion, one of `stiction.study.variables.kinds.KINDS`."""
        if not self.resolved:
            return UNDETERMINED
        if rests_throughout(self.time, self.slip_speed, self.solution.sticks):
            return STUCK
        given, found, own = self.circumstances, self.features, self._own_period
        if not len(self.cycles.drop) or settle(self.swings, given):
            its = regime_without_cycles(found, self.swings, given, lambda: self.fast_oscillation)
            return its.kind
        return kind_of_cycles(self.cycles, own, self.rests, self.sticks, self._beat)

    @property
    def _own_period(self) -> float:
        """Period of the mass on the spring along x alone, s."""
        return 1.0 / self.description.slider.natural_frequency_x

    def _beat(self) -> float | None:
        """Return the frequency (Hz) at which two vibrations beat, if they do."""
        return beat_frequency(self.time, self.force)

    def rests(self, cycles: SwingShapes) -> Floats:
        """Return the share of each cycle in which the mass rests or creeps, in one piece."""
        V = abs(self.nominal)
        return rest_of(cycles, self.time, self.slip_speed / V if V else self.slip_speed)

    def sticks(self, cycles: SwingShapes) -> Floats:
        """Return the share of each cycle in which the mass sticks."""
        return sticks_of(cycles, self.solution.sticks)


def observe_run(
    description: Description, report: Callable[[float], None] | None, room: Room = np.empty
) -> ObservedRun:
    """Run a description, sampled as densely as measures need, at least as it states."""
    sampling: SampleTimes | None = sampling_of(description, report)
    for _ in range(ROUNDS):
        assert sampling is not None
        solution = solve_coarsely(description, sampling.times, progress=report, room=room)
        run = ObservedRun(description, solution, sampling)
        if sampling.even or not STATUSES[solution.code].ok or run.resolved:
            break
        most = max(REFINED * UNEXPLAINED * run.least_drop, TINY)
        parts = np.clip(np.ceil(np.cbrt(run.missed / most)), 1.0, MOST_PARTS)
        sampling = refine(sampling, parts, description.slider)
        if sampling is None:
            break
    return run


def seconds_of(description: Description) -> float:
    """Estimate the computing time of a run (s) from the paper's run, per fast period."""
    return 1e-4 + 0.5e-6 * description.slider.natural_frequencies[1] * description.run.duration
