"""Tables of columns with units, samples and stick intervals: a run's data without xarray.

xarray, and pandas below it, take as long to import as a run takes to simulate and write. A command
that only computes and writes does without them.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from stiction.arrays import xr
from stiction.friction import states
from stiction.system.description import Description
from stiction.system.slider import Slider
from stiction.text.validation import equal, unknown_name

# name: (unit, long name), as CF attributes
VARIABLES = {
    "u_x": ("m", "spring elongation along x"),
    "u_y": ("m", "spring elongation along y"),
    "v_x": ("m/s", "elongation rate along x"),
    "v_y": ("m/s", "elongation rate along y"),
    "slip_x": ("m/s", "slip velocity along x"),
    "slip_y": ("m/s", "slip velocity along y"),
    "slip_speed": ("m/s", "slip speed"),
    "spring_x": ("N", "spring force along x, k_x u_x"),
    "spring_y": ("N", "spring force along y, k_y u_y"),
    "friction": ("N", "magnitude of the friction force F"),
    "theta": ("deg", "friction angle to the principal axis x: on the mass F points at theta + 180"),
    "psi": ("deg", "friction angle to the drive direction X: on the mass F points at psi + 180"),
    "X": ("m", "position along the drive direction"),
    "Y": ("m", "position across the drive direction"),
    "V_X": ("m/s", "velocity along the drive direction"),
    "drive_X": ("m/s", "drive velocity along X"),
    "drive_Y": ("m/s", "drive velocity across X"),
    "normal_load": ("N", "normal load"),
    "mu": (
        "1",
        "apparent friction coefficient: spring force along the load cell, over the load",
    ),
    "sticking": ("1", "whether the slip is zero"),
}
# of the largest slip speed: samples show a motion whose mean velocities they explain but for less.
# Half a sine of 6.5 samples has as much; its largest is up to 0.03 below its peak
UNSEEN_WAY = 0.02
ROUNDED_WAY = 1e-14  # of the largest place: places are known to some roundings
FASTEST = "largest slip speed"
FASTER = f"{FASTEST}, at least"  # where it lies between samples
STICKS = {
    "stick_start": ("s", "start of a stick interval"),
    "stick_end": ("s", "end of a stick interval"),
    "stick_duration": ("s", "duration of a stick interval"),
}


class Column(NamedTuple):
    """An array with the names of its dimensions, its unit and its meaning."""

    dims: tuple[str, ...]
    values: np.ndarray
    attributes: Mapping[str, Any]


@dataclass(frozen=True, eq=False, repr=False)
class ColumnTable(Mapping[str, np.ndarray]):
    """Columns by name, and attributes of the whole.

    Examples
    --------
    >>> import stiction as st
    >>> run = st.simulate(st.presets.nakano_popov_2020(), "20 ms", sample_rate="1 kHz")
    >>> run.samples["time"][-1], run.samples.columns["u_x"].attributes["units"]
    (np.float64(0.02), 'm')
    >>> "u_x" in run.samples, list(run.samples)[:2]
    (True, ['time', 'u_x'])
    """

    columns: Mapping[str, Column]
    attributes: Mapping[str, Any]

    def __repr__(self) -> str:
        """Return the names of the columns."""
        sizes = {len(each.values) for each in self.columns.values() if each.values.ndim}
        return f"<{' and '.join(map(str, sorted(sizes)))} rows of {', '.join(self.columns)}>"

    def __getitem__(self, name: str) -> np.ndarray:
        """Return the values of a column."""
        if name not in self.columns:
            raise KeyError(unknown_name("column", str(name), self.columns))
        return self.columns[name].values

    def at(self, times: np.ndarray) -> ColumnTable:
        """Return the rows at some of the times of a run, and at its end where it ended early.

        Examples
        --------
        >>> import stiction as st
        >>> run = st.simulate(st.presets.nakano_popov_2020(), "2 ms", sample_rate="1 kHz")
        >>> run.samples.at([1e-3])["time"]
        array([0.001])
        """
        chosen = np.isin(self["time"], times)
        chosen[-1] |= self["time"][-1] < np.max(times)
        rows = {
            name: each._replace(values=each.values[chosen]) for name, each in self.columns.items()
        }
        return ColumnTable(rows, self.attributes)

    def __iter__(self) -> Iterator[str]:
        """Go through the names of the columns."""
        return iter(self.columns)

    def __len__(self) -> int:
        """Return the number of columns."""
        return len(self.columns)

    def __eq__(self, other: object) -> bool:
        """Compare names and values; NaN equals NaN."""
        return (
            isinstance(other, ColumnTable)
            and self.columns.keys() == other.columns.keys()
            and all(equal(self[name], other[name]) for name in self)
        )

    __hash__ = None  # type: ignore[assignment]


def as_dataset(table: ColumnTable) -> xr.Dataset:
    """Return a table for xarray; a column that is named as its dimension is a coordinate."""
    return xr.Dataset(dict(table.columns), attrs=dict(table.attributes))


def as_table(data: xr.Dataset) -> ColumnTable:
    """Return the content of a dataset as a table; the arrays are shared."""
    columns = {
        str(name): Column(tuple(map(str, each.dims)), each.values, each.attrs)
        for name, each in data.variables.items()
    }
    return ColumnTable(columns, data.attrs)


def largest(force: np.ndarray) -> tuple[int, float]:
    """Return where a force is largest in either direction, and its magnitude there.

    >>> largest(np.array([float("nan"), 1.0, -2.0]))
    (2, 2.0)
    """
    at = int(np.nanargmax(np.abs(force))) if np.isfinite(force).any() else 0
    return at, float(abs(force[at]))


def sample_table(
    description: Description,
    times: np.ndarray,
    samples: np.ndarray,
    attributes: dict[str, Any],
) -> ColumnTable:
    """Return the samples of a run as a table over ``time``.

    Parameters
    ----------
    description : Description
        The description of the run.
    times : ndarray
        (n,), s.
    samples : ndarray
        (n, 7 + internal states); the columns of `stiction.solver.exact.sampling`, then the states.
    attributes : dict
        Further attributes of the table.
    """
    slider = description.slider
    c, s = slider.direction
    rows = np.ascontiguousarray(samples.T)
    (u_x, u_y, slip_x, slip_y, f_x, f_y, sticking), internal = rows[:7], rows[7:]
    travel_X, travel_Y = slider.motion.travel(0.0, times)
    rate_X, rate_Y = slider.motion.rate(times)
    drive_x, drive_y = slider.along_axes(rate_X, rate_Y)
    v_x, v_y = drive_x - slip_x, drive_y - slip_y
    friction = np.hypot(f_x, f_y)
    theta = np.degrees(np.arctan2(f_y, f_x))
    theta[friction <= 1e-14 * np.max(friction, initial=0.0)] = np.nan  # no force, no direction
    values = {
        "u_x": u_x,
        "u_y": u_y,
        "v_x": v_x,
        "v_y": v_y,
        "slip_x": slip_x,
        "slip_y": slip_y,
        "slip_speed": np.hypot(slip_x, slip_y),
        "spring_x": slider.k_x * u_x,
        "spring_y": slider.k_y * u_y,
        "friction": friction,
        "theta": theta,
        "psi": theta - np.degrees(slider.misalignment),
        "X": travel_X - u_x * c - u_y * s,
        "Y": travel_Y + u_x * s - u_y * c,
        "V_X": slider.along_drive(slip_x, slip_y),
        "drive_X": np.broadcast_to(rate_X, times.shape).copy(),
        "drive_Y": np.broadcast_to(rate_Y, times.shape).copy(),
        "normal_load": np.broadcast_to(slider.weight(times), times.shape).copy(),
        "sticking": sticking.astype(np.int8),
    }
    values["mu"] = apparent_friction(slider, values)
    along = ("time",)
    columns = {"time": Column(along, times, cf_attributes("s", "time"))}
    for name, about in VARIABLES.items():
        columns[name] = Column(along, values[name], cf_attributes(*about))
    for state, value in zip(states(slider.law), internal, strict=True):
        columns[state.name] = Column(along, value, cf_attributes(state.unit, state.meaning))
    return ColumnTable(columns, {"description": description.to_json(), **attributes})


def apparent_friction(slider: Slider, values: Mapping[Any, Any] | ColumnTable) -> Any:
    """Return the spring force along the load cell, by default k_x u_x, over the normal load.

    A friction test reports this ratio. In steady sliding it is the law's coefficient, times the
    cosine of the angle from the drive to the cell.
    """
    with np.errstate(divide="ignore", invalid="ignore"):  # the load may vanish at the end of a run
        along = slider.load_cell.along(values["spring_x"], values["spring_y"])
        return along / values["normal_load"]


def mean_speeds(time: np.ndarray, *position: np.ndarray) -> np.ndarray:
    """Return the mean speed from each sample to the next, (n - 1,), m/s; 0 at one instant."""
    way, passed = np.linalg.norm(np.diff(position), axis=0), np.diff(time)
    return np.asarray(np.divide(way, passed, out=np.zeros_like(way), where=passed > 0.0))


def fastest_slip(samples: Mapping[Any, Any] | ColumnTable) -> tuple[float, bool]:
    """Return the largest slip speed by the samples, m/s, and whether they show the largest.

    The mean velocity between two samples is no larger than the largest one there: it is a lower
    bound, too. Samples show the largest where the way between any two follows from their velocities
    (`unseen_ways`).
    """
    speed, time = np.asarray(samples["slip_speed"]), np.asarray(samples["time"])
    shown = float(np.fmax.reduce(speed, initial=0.0))
    if len(time) < 2:
        return shown, True
    means = mean_speeds(time, samples["X"], samples["Y"])
    fastest = max(shown, float(np.fmax.reduce(means, initial=0.0)))
    return fastest, not unseen_ways(samples, fastest).any()


def unseen_ways(samples: Mapping[Any, Any] | ColumnTable, fastest: float) -> np.ndarray:
    """Return whether there is a way between samples that their velocities leave open, (n - 1,).

    A slip of the `fastest` speed (m/s) may lie there. Where the drive jumps, the velocity of the
    mass jumps, or else that of the springs.
    """
    time = np.asarray(samples["time"])
    mass = _missed_speeds(time, samples["X"], samples["V_X"])
    springs = [_missed_speeds(time, samples[f"u_{axis}"], samples[f"v_{axis}"]) for axis in "xy"]
    return np.asarray(np.minimum(mass, np.hypot(*springs)) > UNSEEN_WAY * fastest)


def _missed_speeds(time: np.ndarray, place: Any, velocity: Any) -> np.ndarray:
    """Return the mean velocity from each sample to the next, less the mean of both, (n - 1,)."""
    explained = 0.5 * (np.asarray(velocity)[1:] + np.asarray(velocity)[:-1])
    step = np.diff(time)
    way = np.abs(np.diff(place) - step * explained)
    moved = way > ROUNDED_WAY * float(np.fmax.reduce(np.abs(place)))
    return np.asarray(np.divide(way, step, out=np.zeros_like(step), where=moved & (step > 0.0)))


def stick_table(intervals: np.ndarray) -> ColumnTable:
    """Return stick intervals, (n, 2) in s, as a table over ``stick``."""
    start, end = intervals.T
    values = zip(STICKS.items(), (start.copy(), end.copy(), end - start), strict=True)
    return ColumnTable(
        {name: Column(("stick",), value, cf_attributes(*about)) for (name, about), value in values},
        {},
    )


def cf_attributes(unit: str, meaning: str) -> dict[str, str]:
    """Return the CF attributes of a variable."""
    return {"units": unit, "long_name": meaning}
