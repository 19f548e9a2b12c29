"""A friction test: the force over time, and stretches of constant velocity and load."""

from __future__ import annotations

from math import inf, isclose, nan
from typing import NamedTuple

import numpy as np

from stiction.analysis.drive.measured_drive import measured_stretches
from stiction.analysis.measurement.run_record import as_record, record_of
from stiction.analysis.protocols.settling import SETTLED, STILL_LOADED, has_settled
from stiction.analysis.record import Record
from stiction.analysis.signals.digitised import resolution
from stiction.analysis.signals.straight_line import line
from stiction.arrays import Floats, Indices
from stiction.drive import (
    ConstantLoad,
    ConstantVelocity,
    DriveProgram,
    Stretches,
    ahead,
    drive_stretches,
    load_stretches,
)
from stiction.drive.program import nominal_velocity
from stiction.errors import ResultError
from stiction.friction import Law
from stiction.recording.noise import rounding_error
from stiction.system.tensors import damping_tensor
from stiction.trajectory import Trajectory

ALIKE_LEVELS = 1e-9  # of a velocity or a load: sums of a program are rounded
BESIDE = 1e-3  # of the mean interval between samples: one so near to an end is at the end
# By which the times of a program may be off in a record, as a share of a stretch: a stage starts
# late, and its clock is not that of the record
OFF_BY = 0.05
BESIDE_JUMP = 4  # samples on each side of a jump, over which two lines meet there
KNOWN_TIME = 0.01  # of the interval between samples: a clock is no better than that
FEWEST_SAMPLES = 3  # samples that show a change, and scatter


class ConstantStretch(NamedTuple):
    """An interval of constant drive velocity and constant load.

    Attributes
    ----------
    start, end : float
        s.
    velocity : float
        Of the drive along X, m/s; across it there is none.
    load : float
        N.
    """

    start: float
    end: float
    velocity: float
    load: float

    @property
    def way(self) -> float:
        """Direction of the drive: 1 along X, -1 against it, 0 at rest."""
        return float(np.sign(self.velocity))

    def like(self, other: ConstantStretch) -> bool:
        """Return whether velocity and load agree with another stretch's, but for rounding."""
        return alike(self.velocity, other.velocity) and alike(self.load, other.load)


def alike(one: float, two: float) -> bool:
    """Return whether two velocities or loads are equal, but for rounding."""
    return isclose(one, two, rel_tol=ALIKE_LEVELS)


class FrictionTest(NamedTuple):
    """The force over time, with the course of drive and load.

    Attributes
    ----------
    time : ndarray
        (n,), s.
    force, load : ndarray
        (n,), force along the load cell, positive where it pulls along X, and normal load at the
        same time, N.
    lag : ndarray
        (n,), elongation of the spring along the drive, m; zero where the stiffness is unknown.
    stiffness : float
        Of the spring along the drive, N/m, by the force on the load cell; NaN if unknown.
    damping : float
        Of a damper beside it, N s/m, likewise; zero if unknown.
    off : float
        Force by which all samples may be off together, N: rounding, or the tolerance of a run.
    law : object or None
        Friction law of a run; None if unknown: of a record, whose stiffness is as one states it and
        whose clock is not that of the drive.
    drive : ConstantVelocity or DriveProgram
        Motion of the drive.
    stretches : list of ConstantStretch
        In order of time. Between them velocity or load vary, as in ramps and under harmonics.
    position : ndarray or None
        (n,), displacement of the drive, m, where the stretches are those that it shows: it is on
        the clock of the force.
    """

    time: Floats
    force: Floats
    load: Floats
    lag: Floats
    stiffness: float
    damping: float
    off: float
    law: Law | None
    drive: ConstantVelocity | DriveProgram
    stretches: list[ConstantStretch]
    position: Floats | None = None

    @property
    def mu(self) -> Floats:
        """Force along the load cell over normal load, (n,)."""
        return self.force / self.load

    def within(self, start: float, end: float) -> Indices:
        """Return the indices of the samples from `start` to `end` (s)."""
        rounding = BESIDE * float(self.time[-1] - self.time[0]) / len(self.time)
        first, after = np.searchsorted(self.time, [start - rounding, end + rounding])
        return np.arange(first, after)

    def clock(self, stretch: ConstantStretch) -> float:
        """Return by how much the ends of a stretch may be off, s."""
        return OFF_BY * (stretch.end - stretch.start) if self.law is None else 0.0

    def clock_at_jump(self, one: ConstantStretch, two: ConstantStretch) -> float:
        """Return by how much the jump from one stretch to the next may be off, s.

        It is a sample at least, and 0 for a run.
        """
        interval = float(np.median(np.diff(self.time[self.within(*two[:2])])))
        off = max(min(self.clock(one), self.clock(two)), interval)
        return off if self.law is None else 0.0

    def error_of_jump(self, one: ConstantStretch, two: ConstantStretch) -> float:
        """Return how well a measured displacement shows when the velocity jumps, s; inf without it.

        Beside the jump its samples deviate from the two lines that meet there: by noise, by the
        time that the drive takes, and by an error of the jump's time.
        """
        at = int(np.searchsorted(self.time, two.start))
        near = slice(max(at - BESIDE_JUMP, 0), at + BESIDE_JUMP)
        if self.position is None or len(self.time[near]) < 2 * BESIDE_JUMP:
            return inf
        since = self.time[near] - two.start
        lines = np.where(since < 0.0, one.velocity, two.velocity) * since
        off = float(np.ptp(self.position[near] - lines)) / abs(two.velocity - one.velocity)
        interval = float(np.median(np.diff(self.time[near])))
        return max(off, KNOWN_TIME * interval)

    def until_end(self, stretch: ConstantStretch, early: float = 0.0) -> Indices:
        """Return the indices of a stretch's samples, without those that may belong to the next.

        They begin by a time `early` (s) before the stretch does.
        """
        return self.within(stretch.start - early, stretch.end - self.clock(stretch))

    def late(self, stretch: ConstantStretch) -> Indices:
        """Return the indices of the samples in the end of a stretch."""
        return self.within(stretch.end - SETTLED * (stretch.end - stretch.start), stretch.end)

    def surely_late(self, stretch: ConstantStretch) -> Indices:
        """Return the indices of the samples in the end of a stretch, surely within it."""
        return np.intersect1d(self.late(stretch), self.until_end(stretch))

    def steady(self, stretch: ConstantStretch) -> float:
        """Return the mean friction in the end of a stretch, NaN without samples."""
        near = self.late(stretch)
        return float(self.mu[near].mean()) if len(near) else nan

    def is_sampled(self, stretch: ConstantStretch) -> bool:
        """Return whether a stretch, and its end, have enough samples to see a change there."""
        return (
            len(self.within(*stretch[:2])) >= FEWEST_SAMPLES and len(self.surely_late(stretch)) > 0
        )

    def slides(self, stretch: ConstantStretch) -> bool:
        """Return whether the mass slides in the end of a stretch: the spring is loaded no more.

        Where the stiffness is unknown it is taken to slide.
        """
        if not stretch.velocity:
            return False
        late = self._latest(stretch)
        loading = stretch.way * line(self.time[late], self.lag[late]).slope
        return loading < STILL_LOADED * abs(stretch.velocity)

    def has_settled(self, stretch: ConstantStretch, slope: float = 0.0) -> bool:
        """Return whether friction has settled in a stretch's end.

        From it a known change with the drive's travel, its `slope` (1/m), is subtracted.
        """
        at, late = self.within(*stretch[:2]), self._latest(stretch)
        rate = stretch.velocity * slope if slope else 0.0  # the velocity may be unknown
        return has_settled(self.time[at], self.mu[at] - rate * self.time[at], len(late))

    def _latest(self, stretch: ConstantStretch) -> Indices:
        """Return the samples in the end of a stretch, but at least as many as show a change."""
        count = max(len(self.late(stretch)), FEWEST_SAMPLES)
        return self.within(*stretch[:2])[-count:]

    def successions(self) -> list[tuple[ConstantStretch, ConstantStretch]]:
        """Return the pairs of stretches that follow each other without a gap."""
        pairs = zip(self.stretches, self.stretches[1:], strict=False)
        return [(one, two) for one, two in pairs if two.start == one.end]

    def gaps(self) -> list[tuple[float, float]]:
        """Return the intervals in which velocity or load vary, s."""
        ends = [float(self.time[0]), *(t for each in self.stretches for t in each[:2])]
        ends.append(float(self.time[-1]))
        borders = zip(ends[::2], ends[1::2], strict=True)
        return [(start, end) for start, end in borders if end > max(start, 0.0)]


def friction_test(source: Trajectory | Record, program: DriveProgram | None = None) -> FrictionTest:
    """Return a run, or a record of a test by a program, as a friction test.

    A record needs its normal load, and the `program` by which it was taken, with t = 0 as in its
    time; by default its measured `drive_position` tells, whenever the record begins. That of a run
    is known.
    """
    if isinstance(source, Trajectory):
        return of_run(source, source.slider.motion)
    source = as_record(source)
    if source.normal_load is None:
        raise ResultError("friction needs the normal load; give the record its normal_load")
    loads = load_stretches(source.normal_load, None)
    if program is not None:
        return of_record(source, program, loads)
    if source.drive_position is None:
        raise ResultError(
            "the drive of a record is unknown; give its program, such as "
            "st.protocols.velocity_steps(...), or its measured drive_position"
        )
    measured = measured_stretches(source.time, source.drive_position)
    return of_record(source, DriveProgram(), loads, measured)


def of_run(run: Trajectory, drive: ConstantVelocity | DriveProgram) -> FrictionTest:
    """Return the record of a run as a friction test with the stretches of `drive`.

    In steady sliding the load cell reads its share of friction, which acts along the drive, and of
    what springs and dampers carry of it.
    """
    slider, record = run.slider, record_of(run)
    found = of_record(record, drive, load_stretches(slider.normal_load, slider.load))
    share, along = abs(slider.load_cell.share), np.array(slider.direction)
    names = ("u_x", "u_y", "normal_load")
    u_x, u_y, load = (run.samples[name][: len(record)] for name in names)
    return found._replace(
        load=np.asarray(load, dtype=np.float64),
        lag=slider.along_drive(u_x, u_y),
        stiffness=share / float(along**2 @ [1.0 / slider.k_x, 1.0 / slider.k_y]) or nan,
        damping=share * float(along @ damping_tensor(slider) @ along),
        off=run.description.run.rtol * float(np.abs(record.force).max()),
        law=slider.law,
    )


def of_record(
    record: Record,
    drive: ConstantVelocity | DriveProgram,
    loads: Stretches,
    measured: Stretches | None = None,
) -> FrictionTest:
    """Return a record with a normal load as a friction test, by its program or as measured."""
    if measured is None:
        found = constant_stretches(drive_stretches(drive), loads, record.time)
        force = -record.force if nominal_velocity(drive) < 0.0 else record.force
    else:
        found = constant_stretches(measured, loads, record.time, -inf)
        force = _against_friction(record, found)
    load = (record.normal_load or nan) * record.relative_load()
    lag = force / record.stiffness if record.stiffness else np.zeros(len(force))
    return FrictionTest(
        record.time,
        force,
        load,
        lag,
        record.stiffness or nan,
        0.0,
        rounding_error(record.force, resolution(record.force)),
        None,
        drive,
        found,
        None if measured is None else record.drive_position,
    )


def _against_friction(record: Record, found: list[ConstantStretch]) -> Floats:
    """Return the force with the sign that makes the work of the measured drive positive."""
    edges = [np.searchsorted(record.time, each[:2]) for each in found]
    work = [
        each.way * float(record.force[first:last].sum())
        for each, (first, last) in zip(found, edges, strict=True)
    ]
    return np.asarray(-record.force if sum(work) < 0.0 else record.force)


def constant_stretches(
    drives: Stretches, loads: Stretches, time: Floats, start: float = 0.0
) -> list[ConstantStretch]:
    """Return the stretches of constant velocity and load while they are recorded, from `start` (s).

    Ramps, harmonics and recorded pieces are left out, and so is all that a harmonic lies on. A
    border between equal pieces is none.
    """
    first, last = (float(time[0]), float(time[-1])) if len(time) else (inf, -inf)
    found: list[ConstantStretch] = []
    for end in sorted({end for end, _ in (*drives, *loads)}):
        begin, until = max(start, first), min(end, last)
        course, load = ahead(drives, start)[1], ahead(loads, start)[1]
        start = end
        if until <= begin or not isinstance(course, ConstantVelocity):
            continue
        if not isinstance(load, ConstantLoad):
            continue
        now = ConstantStretch(begin, until, course.velocity, load.force)
        if found and found[-1].end == begin and found[-1].like(now):
            found[-1] = found[-1]._replace(end=until)
        else:
            found.append(now)
    return found


def without_harmonics(drive: ConstantVelocity | DriveProgram) -> ConstantVelocity | DriveProgram:
    """Return the program of a drive without the harmonics on top."""
    if isinstance(drive, ConstantVelocity):
        return drive
    return DriveProgram(velocity=drive.velocity, program=drive.program, repeat=drive.repeat)
