"""Stick-slip cycles of a record: a table with a row for each."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from stiction.analysis.motion.course import built_up, dies_out
from stiction.analysis.motion.disturbance import (
    is_beside,
    is_residue,
    is_subharmonic,
    lasts_through_loading,
)
from stiction.analysis.motion.hesitations import level, take_out
from stiction.analysis.record import Record, as_record
from stiction.analysis.signals.hum import Line, narrow_lines
from stiction.analysis.signals.outliers import without_outliers
from stiction.analysis.signals.peak_refinement import Vertices, vertices
from stiction.analysis.signals.piecewise_fit import fit_pieces
from stiction.analysis.signals.turning_points import TurningPoints, turning_points, without_spikes
from stiction.trajectory import Trajectory

if TYPE_CHECKING:
    import xarray as xr

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

# name: (unit, long name), as CF attributes
COLUMNS = {
    "start": ("s", "time of the trough before loading"),
    "peak_time": ("s", "time of the largest force"),
    "trough_time": ("s", "time of the trough after slip"),
    "start_force": ("N", "force at the trough before loading"),
    "peak": ("N", "largest force"),
    "trough": ("N", "force at the trough after slip"),
    "drop": ("N", "force drop, from peak to trough"),
    "period": ("s", "time from trough to trough"),
    "rise_share": ("1", "share of the period in which the force rises"),
    "mu_static": ("1", "apparent static friction coefficient"),
    "mu_kinetic": ("1", "apparent kinetic friction coefficient"),
    "stick_slope": ("N/s", "rate of loading before it bends"),
    "stiffness": ("N/m", "apparent stiffness, rate of loading over drive velocity"),
    "creep_distance": ("m", "distance crept while loading, from trough to peak"),
    "slip_distance": ("m", "distance slipped, from peak to trough"),
    "peak_slip_speed": ("m/s", "largest slip speed"),
    "hesitations": ("1", "number of hesitations, dips too small for a cycle of their own"),
    "hesitation_depth": ("N", "depth of the deepest hesitation"),
}
UNSEEN = 0.25  # of a period without a sample: the cycle is not known
JUMP = 1.5  # sampling steps: a shorter pause is not a gap
LOADING = (0.1, 0.5)  # part of the rise that is straight: after the swing, before the creep
LINES = 4  # taken off at most
SAME = 0.01  # of a line's frequency: so far apart are two lines at least
OWN = 10.0  # harmonics of the cycles below this can be lines as well; they make no cycles more
QUARTER = 4  # of a fall, to each side: cubics through so much of half a sine are 0.2 % too flat


def find_cycles(source: Trajectory | Record) -> xr.Dataset:
    """Find the macroscopic cycles of a record, from trough over peak to trough.

    There is nothing to tune. Cycles stand apart from all smaller reversals of the force
    (`stiction.analysis.signals.turning_points`): noise, ripple, single wild samples and slow drift
    are not cycles. A dip that is small beside the fall of its cycle counts as a hesitation
    (`stiction.analysis.motion.hesitations`), and swings that die out are a transient. Left out are
    cycles cut by the beginning or end of the record, cycles with a gap of a quarter of their period
    between samples, and the first loading from an unloaded spring, before which there is no slip.

    A study (`stiction.Study`) counts the same cycles in the same run.

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
            Peak, and mean of peak and trough, over the normal load: a mass that slips against
            constant friction swings as far below it as it was above. These are apparent
            coefficients, not necessarily those of the interface.
        ``stick_slope`` (N/s), ``stiffness`` (N/m)
            Of the straight line through the loading from a tenth to half of its time; creep in
            that time lowers them by its share of the drive velocity.
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
    return swings(as_record(source)).cycles


class Swings(NamedTuple):
    """Swings of the force, whether they go on or die out.

    Parameters
    ----------
    table : Dataset
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
    """

    table: xr.Dataset
    dying: bool
    turns: int
    noise: float
    clearness: float
    force: Floats
    lines: tuple[Line, ...] = ()

    @property
    def cycles(self) -> xr.Dataset:
        """The swings that are cycles: none if they die out, and none that only build up."""
        left = slice(0) if self.dying else built_up(self.table["drop"].values)
        table = self.table.isel(cycle=left)
        return table.assign_coords(cycle=self.table["cycle"][: table.sizes["cycle"]].values)


def swings(record: Record) -> Swings:
    """Return all swings of the force that stand apart from smaller reversals.

    A narrow line is subtracted first, if the rest shows slower swings that are larger, or that
    stick: then these are the motion, and the line is a disturbance. So is a line that the record
    shows while the spring is first loaded, unless the slip speed is known.
    """
    force = without_outliers(record.force)
    if force is not record.force:
        record = record.model_copy(update={"force": force})
    found = _swings(record)
    for _ in range(LINES):
        without = _without_line(record, found)
        if without is None:
            break
        record, found = without
    return found


def _without_line(record: Record, found: Swings) -> tuple[Record, Swings] | None:
    """Return record and swings without a line beside the motion, if there is one."""
    for line in narrow_lines(record.time, record.force):
        if any(abs(line.frequency / each.frequency - 1.0) < SAME for each in found.lines):
            continue  # what is left of a line
        rest, without = swings_without(line, record)
        without = without._replace(lines=(*found.lines, line))
        if is_beside(line, without.table):
            number = line.frequency * float(without.table["period"].median())
            count, left = (each.table.sizes["cycle"] for each in (found, without))
            own = 0 < count <= left + 1 or is_subharmonic(line, without.table)
            if number >= OWN or not own:
                return rest, without
        if record.slip_speed is None and lasts_through_loading(line, record.time, record.force):
            return rest, without
    return None


def swings_without(line: Line, record: Record) -> tuple[Record, Swings]:
    """Return a record less a line, and its swings, of which the residue of the line is none."""
    rest = record.model_copy(update={"force": record.force - line.values})
    found = _swings(rest)._replace(lines=(line,))
    if is_residue(line, found.table):
        found = found._replace(table=found.table.isel(cycle=slice(0)), dying=False, turns=0)
    return rest, found


def _swings(record: Record) -> Swings:
    import xarray as xr

    columns = dict.fromkeys(COLUMNS, np.zeros(0))
    points = turning_points(record.force)
    corners, dips = _corners(record, points)
    if len(corners.time) >= 3:
        with np.errstate(divide="ignore", invalid="ignore"):  # of corners that fall together
            columns = _measure_cycles(record, without_spikes(record.force), corners)
        columns |= _count_hesitations(corners, dips)
        longest = _longest_step(record.time, corners)
        gap = longest > UNSEEN * columns["period"]
        seen = ~gap | (longest < JUMP * np.median(np.diff(record.time)))
        seen &= (columns["rise_share"] > 0.0) & (columns["rise_share"] < 1.0)
        columns = {name: values[seen] for name, values in columns.items()}
    table = xr.Dataset(
        {
            name: ("cycle", columns[name], {"units": unit, "long_name": meaning})
            for name, (unit, meaning) in COLUMNS.items()
        },
        {"cycle": ("cycle", np.arange(1, len(columns["start"]) + 1), {"long_name": "cycle"})},
    )
    table["hesitation_depth"].attrs["least"] = points.least
    rest = record.time[-1] - columns["trough_time"][-1] if len(columns["trough_time"]) else 0.0
    dying = dies_out(columns["drop"], columns["period"], rest)
    return Swings(table, dying, len(points.index), points.noise, points.clearness, record.force)


def _corners(record: Record, points: TurningPoints) -> tuple[Vertices, Vertices]:
    """Return alternating troughs and peaks, a trough first and last; and hesitations.

    A hesitation has the time of its first point, and its depth as value.
    """
    if len(points.index) < 3:
        none = Vertices(np.zeros(0), np.zeros(0))
        return none, none
    found = vertices(record.time, points)
    values = np.concatenate([[points.before], found.value, [points.after]])
    dips = take_out(level(values, found.time))
    kept = dips.kept - 1  # of which the first was before
    kept = kept[0 if points.trough[kept[0]] else 1 :]
    kept = kept[: (len(kept) - 1) // 2 * 2 + 1]
    corners = Vertices(found.time[kept], found.value[kept])
    return corners, Vertices(found.time[dips.at - 1], dips.depth)


def _count_hesitations(corners: Vertices, dips: Vertices) -> dict[str, Floats]:
    """Return number and depth of the hesitations of each cycle."""
    start = corners.time[:-1:2]
    cycle = np.searchsorted(start, dips.time, side="right") - 1
    inside = (cycle >= 0) & (dips.time < corners.time[-1])
    number = np.bincount(cycle[inside], minlength=len(start)).astype(np.float64)
    deepest = np.zeros(len(start))
    np.maximum.at(deepest, cycle[inside], dips.value[inside])
    return {"hesitations": number, "hesitation_depth": np.where(number > 0, deepest, np.nan)}


def _measure_cycles(record: Record, force: Floats, corners: Vertices) -> dict[str, Floats]:
    """Return each column, from alternating troughs and peaks, a trough first and last."""
    start, peak_time, trough_time = (corners.time[i:j:2] for i, j in _THREE)
    start_force, peak, trough = (corners.value[i:j:2] for i, j in _THREE)
    unknown = np.full(len(start), np.nan)
    load, velocity = record.normal_load, record.drive_velocity
    slope = _loading_rate(record.time, force, start, peak_time)
    return {
        "start": start,
        "peak_time": peak_time,
        "trough_time": trough_time,
        "start_force": start_force,
        "peak": peak,
        "trough": trough,
        "drop": peak - trough,
        "period": trough_time - start,
        "rise_share": (peak_time - start) / (trough_time - start),
        "mu_static": peak / load if load else unknown,
        "mu_kinetic": 0.5 * (peak + trough) / load if load else unknown,
        "stick_slope": slope,
        "stiffness": slope / velocity if velocity else unknown,
        "creep_distance": _distance_moved(record, start, peak_time, peak - start_force),
        "slip_distance": _distance_moved(record, peak_time, trough_time, trough - peak),
        "peak_slip_speed": _fastest(record, force, peak_time, trough_time),
    }


def _longest_step(time: Floats, corners: Vertices) -> Floats:
    """Return the longest time between two samples in each cycle."""
    begin, end = (_from(time, corners.time[i:j:2]) for i, j in (_THREE[0], _THREE[2]))
    ends = np.stack([begin, np.maximum(end, begin + 1)], axis=1).ravel()
    return np.asarray(np.maximum.reduceat(np.diff(time), np.minimum(ends, len(time) - 2))[::2])


_THREE = ((0, -1), (1, None), (2, None))  # of troughs and peaks in turn: start, peak, trough


def _loading_rate(time: Floats, force: Floats, start: Floats, peak_time: Floats) -> Floats:
    rise = peak_time - start
    begin, end = (_from(time, start + part * rise) for part in LOADING)
    begin = np.minimum(begin, len(time) - 2)
    fit = fit_pieces(time, force, begin, np.maximum(end, begin + 1), 1)
    slope: Floats = fit.coefficients[:, 1] / fit.half
    return slope


def _from(time: Floats, begin: Floats) -> Indices:
    """Return the first sample at or after each time, within rounding."""
    place = np.interp(begin, time, np.arange(len(time)))
    return np.ceil(place - 1e-3).astype(np.intp)


def _distance_moved(record: Record, begin: Floats, end: Floats, gained: Floats) -> Floats:
    """Return the distance that the mass moved from a time on, given the gain of force."""
    if record.position is not None:
        places = np.interp(np.stack([begin, end]), record.time, record.position)
        return np.asarray(places[1] - places[0])
    if record.stiffness is None or record.drive_velocity is None:
        return np.full(len(begin), np.nan)
    return np.asarray(record.drive_velocity * (end - begin) - gained / record.stiffness)


def _fastest(record: Record, force: Floats, peak_time: Floats, trough_time: Floats) -> Floats:
    """Return the largest slip speed of each fall."""
    begin = _from(record.time, peak_time)
    end = np.maximum(_from(record.time, trough_time), begin + 1)
    if record.slip_speed is not None:
        speed = record.slip_speed
    elif record.stiffness is not None and record.drive_velocity is not None:
        rate = _smooth_rate(record.time, force, int(np.median(end - begin)))
        speed = record.drive_velocity - rate / record.stiffness
    else:
        return np.full(len(begin), np.nan)
    ends = np.stack([begin, end], axis=1).ravel()
    return np.asarray(np.maximum.reduceat(speed, np.minimum(ends, len(speed) - 1))[::2])


def _smooth_rate(time: Floats, force: Floats, fall: int) -> Floats:
    """Return the rate of force (N/s) from cubics through a quarter of a fall each way."""
    from scipy.signal import savgol_filter  # type: ignore[attr-defined]

    window = min(2 * max(2, fall // QUARTER) + 1, (len(time) - 1) // 2 * 2 + 1)
    gained, passed = (savgol_filter(each, window, 3, deriv=1) for each in (force, time))
    return np.asarray(gained / passed)
