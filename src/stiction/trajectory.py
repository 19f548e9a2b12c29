"""What a run gives back: labelled arrays, stick intervals, how it ended, what it took."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from stiction.description import Description
from stiction.errors import DescriptionError, ResultError, Status
from stiction.files import placeable, whole
from stiction.friction import states
from stiction.initial import Initial
from stiction.labels import VARIABLES
from stiction.slider import Slider

if TYPE_CHECKING:
    import xarray as xr


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
    mapped : int
        How many of them `multiscale` found, without steps.
    """

    steps: int
    rejected: int
    iterations: int
    stick_count: int
    time_stuck: float
    mapped: int = 0


@dataclass(frozen=True, repr=False)
class Trajectory:
    """The result of a run; data only.

    Parameters
    ----------
    description : Description
        What was run.
    arrays : callable
        Returns `data`, which is made when it is first asked for.
    status : Status
        How the run ended.
    statistics : Statistics
        What it took.
    """

    description: Description
    arrays: Callable[[], xr.Dataset]
    status: Status
    statistics: Statistics

    def __repr__(self) -> str:
        """Say how far the run came and what is in it."""
        n, end = self.data.sizes["time"], float(self.data["time"][-1])
        sticks = self.statistics.stick_count
        return f"<Trajectory to {end:g} s, {n} samples, {sticks} sticks, {self.status.name}>"

    @cached_property
    def data(self) -> xr.Dataset:
        """Variables over ``time`` with units (see `stiction.labels`).

        Also every stick interval, whatever the sample rate, over ``stick``.
        """
        return self.arrays()

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

    def state(self, time: float | str) -> Initial:
        """Return the state at the sample nearest to `time` (s), to start another run from.

        Raises
        ------
        ResultError
            If the run was not there at that time.
        """
        wanted = Initial(time=time).time
        first, last = (float(self.data["time"][i]) for i in (0, -1))
        if not first <= wanted <= last:
            raise ResultError(f"the run goes from {first:g} s to {last:g} s, not to {wanted:g} s")
        at = self.data.sel(time=wanted, method="nearest")
        names = ("u_x", "u_y", "v_x", "v_y", "time")
        values: dict[str, Any] = {name: float(at[name]) for name in names}
        internal = {each.name: float(at[each.name]) for each in states(self.slider.law)}
        return Initial(**values, states=internal) if internal else Initial(**values)

    def save(self, path: str | Path) -> Path:
        """Write the result as NetCDF, whole or not at all; return the path.

        Raises
        ------
        ResultError
            If the file cannot be written there.
        """
        target = writable(path)
        with whole(target) as part:
            self.data.to_netcdf(part, engine="h5netcdf")
        return target


def writable(path: str | Path) -> Path:
    """Return the path of a result, if one can be written there.

    Raises
    ------
    ResultError
        If it has another suffix than .nc, no folder, or is something else than a file.
    """
    target = Path(path)
    if target.suffix != ".nc":
        raise ResultError(f"{target}: a result is NetCDF; name it {target.with_suffix('.nc')}")
    return placeable(target)


def load(path: str | Path, *, trust: bool = False) -> Trajectory:
    """Read back a result file.

    Parameters
    ----------
    path : str or Path
        Written by ``run.save`` or ``stiction run``.
    trust : bool, optional
        Whether the text of a friction law that stands in the file may be run. It is needed
        only for a law of one's own whose file is neither beside the result nor in the working
        folder, or has changed: a result by itself never has anything run.

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
        description = Description.from_json(
            data.attrs["description"], Path(path).parent, trust=trust
        )
        statistics = Statistics(
            **{
                name: data.attrs[name].item()
                for name in Statistics.__dataclass_fields__
                if name != "mapped" or name in data.attrs  # not in results of version 0.2
            }
        )
        status = Status[data.attrs["status"]]
    except (DescriptionError, KeyError, ValueError, AttributeError) as error:
        raise ResultError(f"{path}: its attributes cannot be read: {error}") from None
    return Trajectory(description, partial(_as_read, data), status, statistics)


def _as_read(data: xr.Dataset) -> xr.Dataset:
    return data
