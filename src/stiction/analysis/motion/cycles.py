"""Stick-slip cycles of a record: a table with a row for each."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from stiction.analysis.measurement.run_record import as_record
from stiction.analysis.motion.changes.cycles import built_up
from stiction.analysis.motion.changes.few_slips import FEW_SLIPS, few_slips
from stiction.analysis.motion.changes.levels import Level, levels
from stiction.analysis.motion.changes.mean_load import FollowedLoad, under_mean_load
from stiction.analysis.motion.changes.quick_falls import EVEN_CHANCE, quick_falls
from stiction.analysis.motion.changes.ringing import Ringing, beside, ringing_of, without_ringing
from stiction.analysis.motion.changes.sizes import find_corners
from stiction.analysis.motion.changes.velocity import made_by_jumps, velocity_jumps
from stiction.analysis.motion.course import dies_out
from stiction.analysis.motion.cycle_columns import CycleTable, tabulate
from stiction.analysis.motion.disturbance import (
    have_period,
    is_beside,
    is_carried,
    is_larger,
    is_residue,
    is_rounding,
    is_stick_slip,
    is_subharmonic,
    lasts_through_loading,
    may_be_carried,
    slow_wave,
)
from stiction.analysis.motion.load_cell.free_swings import (
    FreeSwing,
    RingingCell,
    free_swing,
    ringing_cell,
    without_free_swings,
)
from stiction.analysis.motion.noiseless.swings import SwingShapes, corners
from stiction.analysis.motion.rest import STICKING, rest_share
from stiction.analysis.record import ExactForce, Record
from stiction.analysis.signals.digitised import fall_by_rounding, rounding_line
from stiction.analysis.signals.even_grid import EvenGrid, even_grid
from stiction.analysis.signals.hum import (
    PERIODS,
    Line,
    line_near,
    narrow_lines,
    of_mains,
    peak_frequencies,
)
from stiction.analysis.signals.peak_refinement import Vertices
from stiction.analysis.signals.robust import uniform_mean, without_outliers
from stiction.analysis.signals.turning_points import turning_points
from stiction.arrays import Floats, median, xr
from stiction.trajectory import Trajectory

if TYPE_CHECKING:  # else numba would be loaded for a measured record, too
    from stiction.analysis.motion.noiseless.features import Features

# A slip before a trough falls by such a part of the usual drop, and lasts for so many samples
PART, FEWEST_LOW = 0.5, 3
FEWEST_CYCLES = 3  # cycles beside a ringing, or of a load cell that rings
BESIDE = 0.1  # of a frequency: so far noise takes that of a line
FEWEST_SWINGS, FAR_FEWER = 8, 0.75  # swings beside a load cell's own, and cycles over these
DIP = 0.05  # of a usual drop: a hesitation of a run is as deep, as one that noise lets see
LINES = 4  # subtracted at most
SAME = 0.01  # of a line's frequency: two lines are at least so far apart
# Times the largest drops, all but one in 50, from crest to trough: the means of irregular cycles
# over their period come to 0.72 in 2000 records, and a wave that hides cycles to 1.08 and more
HIGH, LARGEST_DROPS = 0.9, 98.0
OWN_HARMONICS = 10.0  # of the cycles: lower ones can be lines as well; they make no cycles more


def find_cycles(source: Trajectory | Record) -> xr.Dataset:
    """Find the macroscopic cycles of a record, from trough over peak to trough.

    There is nothing to tune. Cycles stand apart from all smaller reversals of the force
    (`stiction.analysis.signals.turning_points`): noise, ripple, single wild samples and slow drift
    are not cycles, nor are the steps of a converter through which a force drifts. A
    dip that is small beside the fall of its cycle counts as a hesitation
    (`stiction.analysis.motion.hesitations`), and swings that die out are a transient. Where larger
    cycles leave a long stretch free, as after a change of the load, smaller ones are sought there
    by themselves (`stiction.analysis.motion.changes.sizes`). Left out are
    cycles cut by the beginning or end of the record, cycles with a gap of a quarter of their period
    between samples, the first loading from an unloaded spring, before which there is no slip, and
    swings that jumps of the drive's velocity make, in a run or where it was measured
    (`stiction.analysis.motion.changes.velocity`).

    The force of a run has no noise, and its rate is known: peaks and troughs lie between its
    samples, and each reversal by more than a thousandth of the swing counts. A study
    (`stiction.Study`) counts the same cycles by the same rules, and so does an analysis of other
    samples of the run: ``python -m benchmarks.explore.rigs.sampling`` compares them.

    Parameters
    ----------
    source : Trajectory or Record
        A run, or what was measured.

    Returns
    -------
    Dataset
        Over ``cycle``, 1, 2, ...; empty if there is none. All variables have ``units``:

        ``start, peak_time, trough_time, period`` (s)
            Trough before loading, peak, trough after slip; from trough to trough.
        ``start_force, peak, trough, drop`` (N)
            The force there; from peak to trough.
        ``rise_share``
            Of the period: 1 for a perfect sawtooth, 0.5 for a sine.
        ``mu_static, mu_kinetic``
            Peak, and mean of peak and trough, each over the normal load at that instant: a mass
            that slips against constant friction swings as far below it as it was above. These are
            apparent coefficients, not necessarily those of the interface.
        ``stick_slope`` (N/s), ``stiffness`` (N/m)
            Of the straight line through the loading from a tenth to half of its time, or less
            where the mass slides or creeps for most of it; creep in that time lowers them by its
            share of the drive velocity.
        ``creep_distance, slip_distance`` (m)
            Moved by the mass from start to peak, and from peak to trough; from its position, or
            from V t minus the change of force over stiffness.
        ``peak_slip_speed`` (m/s)
            Of the slip speed, or of V minus the rate of force over stiffness, smoothed over a
            quarter of the fall to each side.
        ``hesitations``, ``hesitation_depth`` (N)
            Number of times that the force dips on its way up, or rises on its way down, within a
            cycle, and the largest of these reversals. Those below
            ``hesitation_depth.attrs["least"]`` (N), about 5 % of a drop or 10 % under noise, are
            not counted: they do not stand apart from noise and ripple.

        Columns that need a quantity which the record lacks are NaN.

    Examples
    --------
    >>> import numpy as np, stiction as st
    >>> time = np.arange(0.0, 10.0, 1e-3)
    >>> cycles = st.analysis.find_cycles(st.Record(time=time, force=0.1 * (time % 2.0)))
    >>> cycles.sizes["cycle"], cycles["period"].values.round(3).tolist()
    (3, [2.0, 2.0, 2.0])
    """
    return swings(under_mean_load(as_record(source))).cycles


class Swings(NamedTuple):
    """Swings of the force, whether they go on or die out.

    Parameters
    ----------
    table : CycleTable
        A row for each swing, with the columns of `find_cycles`.
    dying : bool
        Whether they die out: then they are a transient, not cycles.
    turns : int
        Number of peaks and troughs, including those of cut cycles.
    noise, clearness : float
        Reach of the noise (N), and how clearly the swings stand apart from it; see
        `stiction.analysis.signals.turning_points`.
    lines : tuple of Line
        Lines, such as mains hum, subtracted from the force beforehand.
    force : ndarray
        (n,), N, without these lines and without wild samples.
    wave : float
        From crest to trough of a slower wave that carries the cycles, N; 0 if there is none.
    ringing : Ringing or None
        What dies out within the record beside the cycles, as after a knock; `force` is without it.
    over : bool
        Whether the record is that of a run, which has no noise, and no swing follows for long.
    few : CycleTable or None
        A row for each slip of a record that has few, known by their shape, with the columns of
        `find_cycles`; the first is loaded from where its loading is even.
    driven : int
        Number of swings that were left out because jumps of the drive's velocity make them.
    cell : RingingCell or None
        The load cell whose swings would count as cycles; `force` is without them.
    load : FollowedLoad or None
        The load that the force follows: swings and `force` are those under its mean.
    levels : tuple of Level
        Where there is no swing, the levels at which the force stays one after the other.
    features : Features or None
        Those of a run, whose force has no noise: its turning points between samples.
    """

    table: CycleTable
    dying: bool
    turns: int
    noise: float
    clearness: float
    force: Floats
    lines: tuple[Line, ...] = ()
    wave: float = 0.0
    ringing: Ringing | None = None
    over: bool = False
    few: CycleTable | None = None
    driven: int = 0
    cell: RingingCell | None = None
    load: FollowedLoad | None = None
    levels: tuple[Level, ...] = ()
    features: Features | None = None

    @property
    def lasting(self) -> CycleTable:
        """The swings that are cycles: none if they die out, and none that only build up."""
        return self.table.part(slice(0) if self.dying else built_up(self.table["drop"]))

    def without_cell(self, record: Record) -> Record:
        """Return a record with the force to which its load cell answered, if that rings."""
        return record if self.cell is None else record.with_force(self.force_at_load)

    @property
    def force_at_load(self) -> Floats:
        """The force (n,), N, under the load as it was measured, over which it is friction."""
        return self.force if self.load is None else self.force + self.load.share

    @property
    def cycles(self) -> xr.Dataset:
        """The same for xarray, as `find_cycles` returns them."""
        return self.lasting.as_dataset()


def swings(record: Record) -> Swings:
    """Return all swings of the force that stand apart from smaller reversals.

    Those that jumps of the drive's velocity make are left out, and counted.
    """
    known = record.exact
    found = _swings_of_any_drive(record) if known is None else _swings_of_run(record, known)
    its = found.table if len(found.table) or found.few is None else found.few
    if not len(its) and record.slip_speed is None:
        return found._replace(levels=levels(record.with_force(found.force)))
    if not len(its) or not made_by_jumps(its, velocity_jumps(record)):
        return found
    none = found.table.part(slice(0))
    return found._replace(table=none, dying=False, few=None, driven=len(its))


def _swings_of_any_drive(record: Record) -> Swings:
    """Return all swings of the force, whatever the drive does meanwhile.

    A narrow line is subtracted first, if the rest shows slower swings that are larger, or that
    stick: then these are the motion, and the line is a disturbance. So is a line that the record
    shows while the spring is first loaded, unless the slip speed is known. So is a slower wave on
    which there is more stick-slip than is seen beside it.
    """
    read, force = record.force, without_outliers(record.force)
    if force is not record.force:
        record = record.with_force(force)
    found, grid = own_swings(record), even_grid(record.time)
    lasting = _cycles_beside_a_ringing(record, found)
    if grid is None or lasting is not None:
        return found if lasting is None else lasting
    if (answered := _cycles_of_ringing_cell(record, grid, found)) is not None:
        return answered
    for _ in range(LINES):
        carried = _cycles_on_a_wave(record, grid, found, read)
        if carried is not None:
            return carried
        without = _without_line(record, grid, found, read)
        if without is None:
            break
        record, found = without
    return _without_hum_of_few_slips(record, grid, found) or found


def _without_hum_of_few_slips(record: Record, grid: EvenGrid, found: Swings) -> Swings | None:
    """Return a few slips beside a line that is not alone, if there are any.

    Their own spectrum may be as high as a ninth of the line, within half an octave of it, or hide
    it: then it is known by its swings. But means over its periods show the slips.
    """
    seen = found.few is not None and len(found.table) <= FEW_SLIPS
    if record.slip_speed is not None or seen or is_stick_slip(found.lasting):
        return None
    its = [1.0 / found.table.median("period")] if len(found.table) > PERIODS else []
    for frequency in its + peak_frequencies(grid, record.force):
        length = round(1.0 / (frequency * grid.step))
        if few_slips(record.time, uniform_mean(record.force, length)) is None:
            continue
        line = line_near(grid, record.force, frequency)
        if line is not None:
            _, without = swings_without(line, record)
            if without.few is not None and is_larger(line, without.few):
                return without._replace(lines=(*found.lines, line))
    return None


def _cycles_beside_a_ringing(record: Record, found: Swings) -> Swings | None:
    """Return stick-slip that goes on before or after swings that die out, as after a knock."""
    if record.slip_speed is not None:
        return None
    ringing = ringing_of(record.time, found.table["peak_time"], found.table["drop"])
    if ringing is None:
        return None
    smooth = without_ringing(record.time, record.force, ringing)
    left = own_swings(record.with_force(smooth))
    left = left._replace(table=beside(left.table, ringing), ringing=ringing)
    enough = len(left.table) >= FEWEST_CYCLES and not left.dying
    sticks = enough and rest_share(left.table.median("rise_share")) >= STICKING
    return left if sticks else None


def _cycles_of_ringing_cell(record: Record, grid: EvenGrid, found: Swings) -> Swings | None:
    """Return the cycles of the force to which a load cell answered that rings, if it does.

    They are stick-slip. If its swings seem to be cycles that do not stick, they are far more.
    """
    its = found.table
    if record.slip_speed is not None or not grid.serves or len(its) < FEWEST_SWINGS:
        return None
    fall = float(np.median(its["trough_time"] - its["peak_time"]))
    periods = [*np.quantile(its["period"], (0.2, 0.5)), fall, 2.0 * fall, 4.0 * fall]
    swing = free_swing(grid, record.force, periods)
    if swing is None or _is_hum(swing, narrow_lines(grid, record.force)):
        return None
    cell = ringing_cell(record.force, swing, its.median("drop"))
    force = without_free_swings(grid, record.force, cell)
    left = own_swings(record.with_force(force))
    most = len(its) if is_stick_slip(its) else FAR_FEWER * len(its)
    enough = FEWEST_CYCLES <= len(left.table) <= most and not left.dying
    return left._replace(cell=cell) if enough and is_stick_slip(left.table) else None


def _is_hum(cell: FreeSwing, lines: Sequence[Line]) -> bool:
    """Return whether a line of the mains is about where a cell would swing: noise lets it fade."""
    of_grid = [line.frequency for line in lines if of_mains(line.frequency)]
    return any(abs(each / cell.frequency - 1.0) < BESIDE for each in of_grid)


def _cycles_on_a_wave(record: Record, grid: EvenGrid, found: Swings, read: Floats) -> Swings | None:
    """Return stick-slip that a slower wave carries, if it does.

    So does the wave of a disc that turns, or of a load that varies. Where it falls as fast as the
    spring is loaded, the force does not rise while the mass sticks, and cycles would be missed.
    `read` is the force as it was recorded (N): its converter has steps. A wave that is hardly
    higher than the cycles hides none of them: it is the mean of cycles that differ.
    """
    if record.slip_speed is not None:
        return None
    regular = peak_frequencies(grid, record.force)
    for frequency in [*regular, *_frequency_of_falls(record, found)]:
        wave = slow_wave(grid, record.force, frequency)
        if not may_be_carried(frequency, record.duration, record.force - wave, found.table):
            continue
        carried = own_swings(record, wave)
        its = carried.table
        carries = is_carried(frequency, record.duration, found.table, its)
        if carries and frequency in regular:
            carries = have_period(its, 1.0 / frequency)
        if carries and not is_rounding(its, read):
            among = (record.time >= its["start"][0]) & (record.time <= its["trough_time"][-1])
            low, high = np.percentile(wave[among], (1.0, 99.0))  # the first loading makes no wave
            seen = high - low > HIGH * np.percentile(its["drop"], LARGEST_DROPS)
            return carried._replace(wave=float(high - low) if seen else 0.0, lines=found.lines)
    return None


def _frequency_of_falls(record: Record, found: Swings) -> list[float]:
    """Return the mean frequency (Hz) of quick falls beside swings that do not stick, if any."""
    if not len(found.table) or is_stick_slip(found.table):
        return []
    falls = quick_falls(record.time, record.force)
    return [falls.number / record.duration] if falls.clearness > EVEN_CHANCE else []


def _without_line(
    record: Record, grid: EvenGrid, found: Swings, read: Floats
) -> tuple[Record, Swings] | None:
    """Return record and swings without a line beside the motion, if there is one.

    Lines of the mains come first: others may be the stick-slip that a slow wave carries. A ramp
    through the steps of the force as it was `read` (N) has lines, too.
    """
    steps = 2.0 * rounding_line(read)  # from crest to trough
    lines = [line for line in narrow_lines(grid, record.force) if line.height > steps]
    for line in sorted(lines, key=lambda line: not of_mains(line.frequency)):
        if any(abs(line.frequency / each.frequency - 1.0) < SAME for each in found.lines):
            continue  # what is left of a line
        rest, without = swings_without(line, record)
        if is_rounding(without.table, read):
            continue
        without = without._replace(lines=(*found.lines, line))
        if without.few is not None and is_larger(line, without.few):
            return rest, without
        if is_beside(line, without.table, record):
            number = line.frequency * without.table.median("period")
            count, left = len(found.table), len(without.table)
            own = left < 2 * count <= 2 * left + 2 or is_subharmonic(line, without.table)
            if number >= OWN_HARMONICS or not own:
                return rest, without
        if record.slip_speed is None and lasts_through_loading(line, record.time, record.force):
            return rest, without
    return None


def swings_without(line: Line, record: Record) -> tuple[Record, Swings]:
    """Return a record without a line, and its swings; the line's residue does not count."""
    rest = record.with_force(record.force - line.values)
    found = own_swings(rest)._replace(lines=(line,))
    if is_residue(line, found.table):
        found = found._replace(table=found.table.part(slice(0)), dying=False, turns=0)
    return rest, found


def own_swings(record: Record, wave: Floats | None = None) -> Swings:
    """Return the swings of the force as it is: no line in it is taken for a disturbance.

    So in a run; in measured records `swings` looks for some. Of a force that a `wave` (N) carries
    the swings are those less the wave, but tabulated with it.
    """
    if wave is None and (known := record.exact) is not None:
        return _swings_of_run(record, known)
    force = record.force if wave is None else record.force - wave
    points, few = turning_points(force), None
    if len(points.index) <= 2 * FEW_SLIPS + 1 and wave is None and record.slip_speed is None:
        few = few_slips(record.time, force)
    if few is not None and not len(points.index):
        points = few.points
    corners, dips, turns = find_corners(record.time, force, points)
    least = points.least
    if wave is not None:
        there = np.interp(corners.time, record.time, wave)
        corners = corners._replace(value=np.asarray(corners.value + there))
        least = max(least, fall_by_rounding(record.force))  # a staircase less a wave turns back
        dips = Vertices(*(each[dips.value > least] for each in dips))
    table = _without_first_loading(record, tabulate(record, corners, dips, least))
    rest = float(record.time[-1] - table["trough_time"][-1]) if len(table) else 0.0
    dying = len(table) > 0 and dies_out(table["drop"], table["period"], rest)
    found = Swings(table, dying, turns, points.noise, points.clearness, record.force)
    if few is not None:
        none = Vertices(np.zeros(0), np.zeros(0))
        found = found._replace(few=tabulate(record, few.corners(record.time), none, points.least))
    return found


def _swings_of_run(record: Record, known: ExactForce) -> Swings:
    """Return the swings of a run's force, by turning points between its samples."""
    from stiction.analysis.motion.noiseless.features import features_of

    found = features_of(known)
    its = corners(found)
    kept = Vertices(found.turn_time[its.kept], found.turn_value[its.kept])
    drops = kept.value[1::2] - kept.value[2::2]
    least = max(found.height, DIP * median(drops)) if len(drops) else found.height
    deep = its.depth > least
    dips = Vertices(found.turn_time[its.at[deep]], its.depth[deep])
    table = tabulate(record, kept, dips, least)
    shapes, over, dying = shapes_of(table), False, False
    if len(table):
        until = record.steady_until(float(table["start"][-1]))
        over = shapes.are_over(until)
        dying = over or shapes.die_out(until)
    turns = len(found.turn_time)
    return Swings(table, dying, turns, 0.0, 0.0, record.force, over=over, features=found)


def shapes_of(table: CycleTable) -> SwingShapes:
    """Return swings in a table by their shapes."""
    return SwingShapes(*(table[name] for name in SwingShapes._fields))


def _without_first_loading(record: Record, table: CycleTable) -> CycleTable:
    """Return stick-slip without a first loading: a trough at the end of a rest is not after a slip.

    Where the zero drifts meanwhile, or noise is loud, that end looks like one. But the force was
    low before it, and did not fall, for as long as slips take, as it falls in them.
    """
    if record.slip_speed is not None or not is_stick_slip(table):
        return table
    start, level = float(table["start"][0]), float(table["start_force"][0])
    begin = start - float((table["trough_time"] - table["peak_time"]).max())
    first, last = np.searchsorted(record.time, [begin, start]).tolist()
    if not first or last - first < FEWEST_LOW:
        return table
    slipped = float(record.force[first:last].max()) - level > PART * table.median("drop")
    loaded = float(record.force[:last].max()) > 0.5 * (level + float(table["peak"][0]))
    return table if slipped or loaded else table.part(slice(1, None))
