"""What a run gives back: labelled arrays, stick intervals, how it ended, what it took."""

from __future__ import annotations

import os
import tempfile
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from stiction.description import Description
from stiction.errors import DescriptionError, ResultError, Status
from stiction.initial import Initial
from stiction.slider import Slider

if TYPE_CHECKING:
    import xarray as xr

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
    "friction": ("N", "magnitude of the friction force"),
    "theta": ("deg", "angle of the friction force to the principal axis x"),
    "psi": ("deg", "angle of the friction force to the drive direction X"),
    "X": ("m", "position along the drive direction"),
    "Y": ("m", "position across the drive direction"),
    "V_X": ("m/s", "velocity along the drive direction"),
    "sticking": ("1", "whether the slip is zero"),
    "stick_start": ("s", "start of a stick interval"),
    "stick_end": ("s", "end of a stick interval"),
}


@dataclass(frozen=True)
class Statistics:
    """What a run took.

    Parameters
    ----------
    steps, rejected : int
        Slip steps taken, and tries that were not accurate enough.
    iterations : int
        Newton iterations.
    stick_count : int
        Stick intervals.
    time_stuck : float
        Their sum, s.
    """

    steps: int
    rejected: int
    iterations: int
    stick_count: int
    time_stuck: float


@dataclass(frozen=True)
class Trajectory:
    """The result of a run; data only.

    Parameters
    ----------
    description : Description
        What was run.
    data : xarray.Dataset
        Variables over ``time`` with units (see `VARIABLES`), and every stick interval,
        whatever the sample rate, over ``stick``.
    status : Status
        How the run ended.
    statistics : Statistics
        What it took.
    """

    description: Description
    data: xr.Dataset
    status: Status
    statistics: Statistics

    @property
    def slider(self) -> Slider:
        """The system that was run."""
        return self.description.slider

    @cached_property
    def sticks(self) -> np.ndarray:
        """Stick intervals, (n, 2): start and end of each, in s."""
        return np.column_stack([self.data["stick_start"].values, self.data["stick_end"].values])

    @property
    def final(self) -> xr.Dataset:
        """The last sample."""
        return self.data.isel(time=-1)

    def state(self, time: float) -> Initial:
        """Return the state at the sample nearest to `time` (s), to start another run from."""
        at = self.data.sel(time=time, method="nearest")
        names = ("u_x", "u_y", "v_x", "v_y", "time")
        return Initial(**{name: float(at[name]) for name in names})

    def save(self, path: str | Path) -> Path:
        """Write the result as NetCDF, whole or not at all; return the path.

        Raises
        ------
        ResultError
            If the file cannot be written there.
        """
        target = Path(path)
        if not target.parent.is_dir():
            raise ResultError(f"{target}: no folder {target.parent}; make it first")
        handle, name = tempfile.mkstemp(dir=target.parent, suffix=".part")
        os.close(handle)
        try:
            self.data.to_netcdf(name, engine="h5netcdf")
            os.chmod(name, 0o666 & ~_umask())
            os.replace(name, target)
        except OSError as error:
            raise ResultError(f"{target}: cannot be written: {error.strerror or error}") from None
        finally:
            Path(name).unlink(missing_ok=True)
        return target


def load(path: str | Path) -> Trajectory:
    """Read back a result file.

    Raises
    ------
    ResultError
        If there is no such file, or it is not a result of this package.
    """
    import xarray as xr

    if not Path(path).is_file():
        raise ResultError(f"{path}: no such file; write one with 'stiction run'")
    try:
        data = xr.load_dataset(path, engine="h5netcdf")
    except (OSError, ValueError, KeyError) as error:
        raise ResultError(f"{path}: not a NetCDF file that can be read: {error}") from None
    missing = [name for name in VARIABLES if name not in data]
    if missing or "description" not in data.attrs:
        what = ", ".join(missing) or "its description"
        raise ResultError(f"{path}: not a result of 'stiction run'; it lacks {what}")
    try:
        description = Description.from_json(data.attrs["description"])
        statistics = Statistics(
            **{name: data.attrs[name].item() for name in Statistics.__dataclass_fields__}
        )
        status = Status[data.attrs["status"]]
    except (DescriptionError, KeyError, ValueError, AttributeError) as error:
        raise ResultError(f"{path}: its attributes cannot be read: {error}") from None
    return Trajectory(description, data, status, statistics)


def dataset(
    description: Description,
    times: np.ndarray,
    samples: np.ndarray,
    sticks: np.ndarray,
    attributes: dict[str, Any],
) -> xr.Dataset:
    """Return the labelled arrays of a run from the solver's samples.

    Parameters
    ----------
    description : Description
        What was run.
    times : ndarray
        (n,), s.
    samples : ndarray
        (n, 7); the columns of `stiction.solver.sampling`.
    sticks : ndarray
        (m, 2), s.
    attributes : dict
        Attributes of the dataset beside the description.
    """
    import xarray as xr

    slider = description.slider
    c, s = slider.direction
    u_x, u_y, slip_x, slip_y, f_x, f_y, sticking = np.ascontiguousarray(samples.T)
    travel_X, travel_Y = _travel(slider, times)
    rate_X, rate_Y = _rate(slider, times)
    v_x = rate_X * c - rate_Y * s - slip_x
    v_y = rate_X * s + rate_Y * c - slip_y
    friction = np.hypot(f_x, f_y)
    theta = np.degrees(np.arctan2(f_y, f_x))
    theta[friction == 0.0] = np.nan  # no force, no direction
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
        "psi": theta - np.degrees(slider.phi),
        "X": travel_X - u_x * c - u_y * s,
        "Y": travel_Y + u_x * s - u_y * c,
        "V_X": slip_x * c + slip_y * s,
        "sticking": sticking.astype(np.int8),
        "stick_start": sticks[:, 0].copy(),
        "stick_end": sticks[:, 1].copy(),
    }
    variables = {
        name: (
            "stick" if name.startswith("stick_") else "time",
            value,
            {"units": VARIABLES[name][0], "long_name": VARIABLES[name][1]},
        )
        for name, value in values.items()
    }
    time = ("time", times, {"units": "s", "long_name": "time"})
    attributes = {"description": description.to_json(), **attributes}
    return xr.Dataset(variables, {"time": time}, attributes)


def _travel(slider: Slider, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the displacement of the drive from t = 0, laboratory axes, in m."""
    return _over(times, lambda t: slider.motion.travel(0.0, t))


def _rate(slider: Slider, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return _over(times, slider.motion.rate)


def _over(times: np.ndarray, vector: Any) -> tuple[np.ndarray, np.ndarray]:
    """Evaluate a drive's vector at all times at once, or one by one if it uses `math`."""
    try:
        X, Y = vector(times)
    except TypeError:
        X, Y = np.array([vector(t) for t in times]).T
    return np.broadcast_to(X, times.shape), np.broadcast_to(Y, times.shape)


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
