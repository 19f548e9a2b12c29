"""The quantities measured of each cycle, the columns of the table, with mean and spread."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from math import isfinite

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stiction.analysis.motion.loading import loaded_until, loading_rate, samples_from
from stiction.analysis.record import Record
from stiction.analysis.signals.peak_refinement import Vertices
from stiction.analysis.signals.turning_points import without_spikes
from stiction.arrays import Floats, Indices, xr
from stiction.result.table import mean_speeds
from stiction.text.quantity.wording import in_digits, percent, to_error

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
UNSEEN_PEAK = 1.1  # times the largest sample: a larger mean between two is that of an unseen peak
UNSEEN = 0.25  # of a period without a sample: the cycle is not known
SOLVER_SPREAD = 1e-5  # of a value: a spread that is less is the solver's, not the motion's
JUMP = 1.5  # sampling steps: a shorter pause is not a gap
SLIPPED = 0.1  # of the way from trough to peak, by small slips: it is not creep
QUARTER = 4  # of a fall, to each side: cubics through so much of half a sine are 0.2 % too flat
_THREE = ((0, -1), (1, None), (2, None))  # of troughs and peaks in turn: start, peak, trough
TIMES = ("start", "peak_time", "trough_time")  # instants, whose mean is meaningless


@dataclass(frozen=True, eq=False)
class CycleTable:
    """A row for each cycle: columns as plain arrays, for all that only reads numbers.

    xarray, and the libraries that it looks for, take longer to import than most runs to simulate.
    """

    columns: Mapping[str, Floats]  # the columns by name, with `COLUMNS`, (n,) each
    least: float  # depth of a hesitation that is seen, N

    def __getitem__(self, name: str) -> Floats:
        """Return a column."""
        return self.columns[name]

    def __len__(self) -> int:
        """Return the number of cycles."""
        return len(self.columns["start"])

    def part(self, rows: slice | NDArray[np.bool_]) -> CycleTable:
        """Return some of the rows; the table itself, if these are all."""
        if len(np.arange(len(self))[rows]) == len(self):
            return self
        return CycleTable({name: each[rows] for name, each in self.columns.items()}, self.least)

    def blank(self, names: Iterable[str], rows: ArrayLike = True) -> CycleTable:
        """Return the table with NaN in some columns, of some rows or of all."""
        blanks = {name: np.where(rows, np.nan, self[name]) for name in names}
        return CycleTable({**self.columns, **blanks}, self.least)

    def mean(self, name: str) -> float:
        """Return the mean of a column; NaN without cycles."""
        return float(self[name].mean()) if len(self) else np.nan

    def median(self, name: str) -> float:
        """Return the median of a column; NaN without cycles."""
        return float(np.median(self[name])) if len(self) else np.nan

    def as_dataset(self) -> xr.Dataset:
        """Return the table for xarray, over ``cycle``, 1, 2, ..., with units."""
        table = xr.Dataset(
            {
                name: ("cycle", self[name], {"units": unit, "long_name": meaning})
                for name, (unit, meaning) in COLUMNS.items()
            },
            {"cycle": ("cycle", np.arange(1, len(self) + 1), {"long_name": "cycle"})},
        )
        table["hesitation_depth"].attrs["least"] = self.least
        return table


def table_of(cycles: xr.Dataset) -> CycleTable:
    """Return the table of a dataset as `find_cycles` returns it; the arrays are shared."""
    columns = {name: cycles[name].values for name in COLUMNS if name in cycles}
    return CycleTable(columns, cycles["hesitation_depth"].attrs.get("least", np.nan))


def tabulate(record: Record, corners: Vertices, dips: Vertices, least: float) -> CycleTable:
    """Return a row for each cycle, with `COLUMNS`; a cycle that a gap hides has none.

    Corners are troughs and peaks in turn, a trough first and last; dips are hesitations, the time
    of the first point (s) and the depth (N), of which `least` is seen.
    """
    columns = dict.fromkeys(COLUMNS, np.zeros(0))
    if len(corners.time) >= 3:
        with np.errstate(divide="ignore", invalid="ignore"):  # of corners that fall together
            columns = _measure_cycles(record, without_spikes(record.force), corners)
        columns |= _count_hesitations(corners, dips)
        stiffness = record.stiffness or columns["stiffness"]  # that of the spring, or an apparent
        creep = columns["creep_distance"]
        creep[_dips_of_rises(corners, dips) > SLIPPED * np.abs(stiffness * creep)] = np.nan
        longest = _longest_step(record.time, corners)
        gap = longest > UNSEEN * columns["period"]
        seen = ~gap | (longest < JUMP * np.median(np.diff(record.time)))
        seen &= (columns["rise_share"] > 0.0) & (columns["rise_share"] < 1.0)
        seen &= columns["drop"] > 0.0  # on a steep slow motion a force may not fall at all
        columns = {name: values[seen] for name, values in columns.items()}
    return CycleTable(columns, least)


def _count_hesitations(corners: Vertices, dips: Vertices) -> dict[str, Floats]:
    """Return number and depth of the hesitations of each cycle."""
    cycle, depth = _dips_until(corners.time[2::2], corners, dips)
    number = np.bincount(cycle, minlength=len(corners.time) // 2).astype(np.float64)
    deepest = np.zeros(len(number))
    np.maximum.at(deepest, cycle, depth)
    return {"hesitations": number, "hesitation_depth": np.where(number > 0, deepest, np.nan)}


def _dips_of_rises(corners: Vertices, dips: Vertices) -> Floats:
    """Return by how much the force dips in each rise, N: by small slips."""
    cycle, depth = _dips_until(corners.time[1::2], corners, dips)
    return np.bincount(cycle, depth, len(corners.time) // 2).astype(np.float64)


def _dips_until(ends: Floats, corners: Vertices, dips: Vertices) -> tuple[Indices, Floats]:
    """Return the cycle of each dip before a time in it (s), and its depth (N)."""
    cycle = np.searchsorted(corners.time[:-1:2], dips.time, side="right") - 1
    inside = (cycle >= 0) & (dips.time < ends[cycle])
    return cycle[inside], dips.value[inside]


def _measure_cycles(record: Record, force: Floats, corners: Vertices) -> dict[str, Floats]:
    """Return each column, from alternating troughs and peaks, a trough first and last."""
    start, peak_time, trough_time = (corners.time[i:j:2] for i, j in _THREE)
    start_force, peak, trough = (corners.value[i:j:2] for i, j in _THREE)
    unknown = np.full(len(start), np.nan)
    load = record.normal_load
    relative = record.relative_load()
    reduced_peak = peak / np.interp(peak_time, record.time, relative)
    reduced_trough = trough / np.interp(trough_time, record.time, relative)
    loaded = loaded_until(record.time, force, start, start_force, peak_time)
    slope = loading_rate(record.time, force, start, loaded)
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
        "mu_static": reduced_peak / load if load else unknown,
        "mu_kinetic": 0.5 * (reduced_peak + reduced_trough) / load if load else unknown,
        "stick_slope": slope,
        "stiffness": slope / _drive_velocity(record, start, loaded),
        "creep_distance": _distance_moved(record, start, peak_time, peak - start_force),
        "slip_distance": _distance_moved(record, peak_time, trough_time, trough - peak),
        "peak_slip_speed": _fastest(record, force, peak_time, trough_time),
    }


def _longest_step(time: Floats, corners: Vertices) -> Floats:
    """Return the longest time between two samples in each cycle."""
    begin, end = (samples_from(time, corners.time[i:j:2]) for i, j in (_THREE[0], _THREE[2]))
    ends = np.stack([begin, np.maximum(end, begin + 1)], axis=1).ravel()
    return np.asarray(np.maximum.reduceat(np.diff(time), np.minimum(ends, len(time) - 2))[::2])


def _drive_velocity(record: Record, start: Floats, until: Floats) -> Floats:
    """Return the velocity of the drive while the force is loaded; NaN where it is not known."""
    if (travel := record.drive_travel) is None:
        return np.full(len(start), record.drive_velocity or np.nan)
    velocity = loading_rate(record.time, travel, start, until)
    return np.where(velocity > 0.0, velocity, np.nan)


def _distance_moved(record: Record, begin: Floats, end: Floats, gained: Floats) -> Floats:
    """Return the distance that the mass moved from a time on, given the gain of force."""
    if record.position is not None:
        places = np.interp(np.stack([begin, end]), record.time, record.position)
        return np.asarray(places[1] - places[0])
    if record.stiffness is None or record.drive_velocity is None:
        return np.full(len(begin), np.nan)
    return np.asarray(record.drive_velocity * (end - begin) - gained / record.stiffness)


def _fastest(record: Record, force: Floats, peak_time: Floats, trough_time: Floats) -> Floats:
    """Return the largest slip speed of each fall; of a run, NaN where it lies between samples.

    There the mean velocity from one sample to the next is larger than that of each sample.
    """
    begin = samples_from(record.time, peak_time)
    end = np.maximum(samples_from(record.time, trough_time), begin + 1)
    if record.slip_speed is not None:
        speed = record.slip_speed
    elif record.stiffness is not None and record.drive_velocity is not None:
        rate = _smooth_rate(record.time, force, int(np.median(end - begin)))
        speed = record.drive_velocity - rate / record.stiffness
    else:
        return np.full(len(begin), np.nan)
    ends = np.stack([begin, end], axis=1).ravel()
    found = np.maximum.reduceat(speed, np.minimum(ends, len(speed) - 1))[::2]
    if record.sticks is None or record.position is None:
        return np.asarray(found)
    between = mean_speeds(record.time, record.position)
    means = np.maximum.reduceat(between, np.minimum(ends, len(between) - 1))[::2]
    return np.where(means <= UNSEEN_PEAK * found, found, np.nan)


def _smooth_rate(time: Floats, force: Floats, fall: int) -> Floats:
    """Return the rate of force (N/s) from cubics through a quarter of a fall each way.

    A. Savitzky & M. J. E. Golay, Anal. Chem. 36, 1627 (1964), Eq. (VI): of the sums over powers of
    the distance only those of even ones are not zero. A fall of 10 000 samples is convolved by
    transforms; `scipy.signal`, which has both, takes longer to import than a record to analyse.
    """
    from scipy.fft import irfft, next_fast_len, rfft

    half = min(max(2, fall // QUARTER), (len(time) - 1) // 2)
    away = np.arange(-half, half + 1) / half
    weights = (away**6).sum() * away - (away**4).sum() * away**3
    size = next_fast_len(len(time) + 2 * half, real=True)  # type: ignore[no-untyped-call]
    turned, whole = rfft(weights[::-1], size), slice(2 * half, 2 * half + len(time))
    gained, passed = (
        irfft(rfft(np.pad(each, half, "reflect", reflect_type="odd"), size) * turned, size)[whole]
        for each in (force - force[0], time - time[0])
    )
    return np.asarray(gained / passed)


def summary(cycles: xr.Dataset) -> xr.Dataset:
    """Return mean and spread of each quantity of a table of cycles.

    Parameters
    ----------
    cycles : Dataset
        From ``st.analysis.find_cycles``.

    Returns
    -------
    Dataset
        Over ``quantity`` (names, with ``unit`` beside them): ``mean``, ``standard_deviation`` of
        a single cycle (divide by the square root of `number` for that of the mean), and
        ``number`` of cycles in which the quantity is known. NaN if there are fewer than one, or
        two, of them.

    Examples
    --------
    >>> import numpy as np, stiction as st
    >>> time = np.arange(0.0, 10.0, 1e-3)
    >>> cycles = st.analysis.find_cycles(st.Record(time=time, force=0.1 * (time % 2.0)))
    >>> float(st.analysis.summary(cycles)["mean"].sel(quantity="period").round(6))
    2.0
    """
    names = [str(name) for name in cycles.data_vars if name not in TIMES]
    values = [cycles[name].values[np.isfinite(cycles[name].values)] for name in names]
    columns = {
        "mean": [v.mean() if len(v) else np.nan for v in values],
        "standard_deviation": [v.std(ddof=1) if len(v) > 1 else np.nan for v in values],
        "number": [len(v) for v in values],
    }
    meanings = {
        "mean": "mean over cycles",
        "standard_deviation": "standard deviation over cycles",
        "number": "cycles in which it is known",
    }
    return xr.Dataset(
        {
            key: ("quantity", column, {"long_name": meanings[key]})
            for key, column in columns.items()
        },
        {
            "quantity": names,
            "unit": ("quantity", [cycles[name].attrs["units"] for name in names]),
            "meaning": ("quantity", [cycles[name].attrs["long_name"] for name in names]),
        },
    )


def with_spread(spread: float, mean: float, unit: str) -> str:
    """Return a spread in words, or an upper limit if it is below the accuracy of a run."""
    if not isfinite(spread):
        return ""
    if spread <= SOLVER_SPREAD * abs(mean):
        return f"< {percent(SOLVER_SPREAD)}"
    return in_digits(spread, unit, 2)


def mean_in_words(summary: xr.Dataset, quantity: str) -> str:
    """Return the mean of a quantity over cycles, in the digits that it has by their spread."""
    row = summary.sel(quantity=quantity)
    error = float(row["standard_deviation"]) / max(float(row["number"]), 1.0) ** 0.5
    return to_error(float(row["mean"]), error, str(row["unit"].values))
