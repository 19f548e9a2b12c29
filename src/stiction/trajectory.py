"""The result of a run: labelled arrays, stick intervals, status and statistics."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol, runtime_checkable

import numpy as np

from stiction.arrays import data_frame, xr
from stiction.errors import DescriptionError, Faults, ResultError, Status
from stiction.formats.table import number_of
from stiction.friction import states
from stiction.names import draw, picture
from stiction.result.file import ENDS, age, read_tables, write_result
from stiction.result.peak import LARGER_FORCE, LARGEST_FORCE, largest_spring_force
from stiction.result.table import (
    FASTER,
    FASTEST,
    VARIABLES,
    Column,
    ColumnTable,
    apparent_friction,
    as_dataset,
    as_table,
    cf_attributes,
    fastest_slip,
    stick_table,
)
from stiction.storage.files import NETCDF, placeable, whole
from stiction.storage.table_files import exportable, write_tables
from stiction.system.description import Description
from stiction.system.initial import Initial
from stiction.system.slider import Slider
from stiction.system.writing import parameter_table, slider_tables
from stiction.text.quantity.wording import in_words
from stiction.text.sections import Section, Table, as_html
from stiction.text.units import Quantity
from stiction.text.validation import read_arguments

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes


@dataclass(frozen=True)
class Statistics:
    """The cost of a run.

    Parameters
    ----------
    steps, rejected : int
        Slip steps accepted, and steps rejected as not accurate enough.
    iterations : int
        Newton iterations.
    stick_count : int
        Number of stick intervals.
    time_stuck : float
        Their total duration, s.
    mapped : int
        How many of them `multiscale` interpolated.
    """

    steps: int
    rejected: int
    iterations: int
    stick_count: int
    time_stuck: float
    mapped: int = 0


@dataclass(frozen=True, eq=False, repr=False)
class Trajectory:
    """The result of a run; data only.

    Parameters
    ----------
    description : Description
        The description of the run.
    arrays : callable
        Returns `samples`, at first use.
    stick_intervals : ndarray
        Start and end of each stick, (n, 2), in s; `sticks` as a plain array.
    status : Status
        How the run ended.
    statistics : Statistics
        The cost of the run.

    Examples
    --------
    >>> import stiction as st
    >>> run = st.simulate(st.presets.nakano_popov_2020(), "20 ms", sample_rate="1 kHz")
    >>> run.samples["u_x"].shape, run.sticks.sizes["stick"]
    ((21,), 9)
    """

    description: Description
    arrays: Callable[[], ColumnTable]
    stick_intervals: np.ndarray
    status: Status
    statistics: Statistics

    def __repr__(self) -> str:
        """Return a one-line summary."""
        end = float(self.samples["time"][-1])
        if self.status.ok:  # a run may end between two samples
            end = max(end, self.description.initial.time + self.description.run.duration)
        samples = number_of(len(self.samples["time"]), "sample")
        sticks = number_of(self.statistics.stick_count, "stick")
        return f"<Trajectory to {end:g} s, {samples}, {sticks}, {self.status.name}>"

    def __eq__(self, other: object) -> bool:
        """Compare description, status, statistics, sticks and samples."""
        return isinstance(other, Trajectory) and (
            (self.description, self.status, self.statistics)
            == (other.description, other.status, other.statistics)
            and np.array_equal(self.stick_intervals, other.stick_intervals)
            and self.samples == other.samples
        )

    def __hash__(self) -> int:
        """Agree with equality."""
        return hash((self.status, self.statistics))

    def _repr_html_(self) -> str:
        seen = f"{len(self.samples['time'])} samples to {in_words(self.samples['time'][-1], 's')}"
        head = Section("Run", [f"{seen}: {self.status.value}."], self._facts())
        slider = Section("Slider", [], parameter_table(slider_tables(self.slider)))
        return as_html([head]) + picture("plot_glance", self) + as_html([slider])

    def _facts(self) -> Table:
        """Return the numbers that one looks for first."""
        peak = largest_spring_force(self.samples, self.slider.k_x)
        fastest, shown = fastest_slip(self.samples)
        rows = [
            (LARGEST_FORCE if peak.shown else LARGER_FORCE, in_words(peak.force, "N")),
            ("at", in_words(peak.time, "s")),
            (FASTEST if shown else FASTER, in_words(fastest, "m/s")),
            ("stick intervals", str(self.statistics.stick_count)),
            ("time at rest", in_words(self.statistics.time_stuck, "s")),
        ]
        return Table(("number", "value"), rows)

    @cached_property
    def samples(self) -> ColumnTable:
        """The samples as plain arrays, ``run.samples["u_x"]`` for example; they are read-only."""
        found = self.arrays()
        for column in found.columns.values():  # all that analyse the run see them
            column.values.flags.writeable = False
        return found

    @cached_property
    def data(self) -> xr.Dataset:
        """The samples, variables over ``time`` with units (see `stiction.result.table`)."""
        return as_dataset(self.samples)

    @cached_property
    def sticks(self) -> xr.Dataset:
        """Every stick interval, whatever the sample rate, as a dataset over ``stick``.

        `stick_start`, `stick_end` and `stick_duration`, in s.
        """
        return as_dataset(stick_table(self.stick_intervals))

    def to_dataframe(self) -> pd.DataFrame:
        """Return the samples as a pandas data frame, indexed by time; units are in its ``attrs``.

        Stick intervals have a data frame of their own: ``run.sticks.to_dataframe()``.

        Examples
        --------
        >>> import stiction as st
        >>> run = st.simulate(st.presets.nakano_popov_2020(), "20 ms", sample_rate="1 kHz")
        >>> len(run.to_dataframe()), len(run.sticks.to_dataframe())
        (21, 9)
        """
        return data_frame(self.data)

    @property
    def slider(self) -> Slider:
        """The system that was run."""
        return self.description.slider

    @property
    def final(self) -> xr.Dataset:
        """The last sample."""
        return self.data.isel(time=-1)

    def export(self, path: str | Path) -> list[Path]:
        """Write samples and sticks as CSV, Parquet or MATLAB; see `stiction.export`."""
        return export(self, path)

    def plot(
        self, axes: Any = None, *, window: Sequence[Quantity] | None = None
    ) -> dict[str, Axes]:
        """Draw the run; see `stiction.plotting.plot_run`.

        Returns
        -------
        dict of str to Axes
            The axes by their names, on one figure of pyplot.

        Examples
        --------
        >>> import stiction as st
        >>> run = st.simulate(st.presets.nakano_popov_2020(), "50 ms", sample_rate="10 kHz")
        >>> axes = run.plot()
        >>> axes["force"].get_figure(root=True).savefig("run.png")
        """
        drawn: dict[str, Axes] = draw("plot_run", self, axes, window=window)
        return drawn

    def state(self, time: Quantity) -> Initial:
        """Return the state at the sample nearest to `time` (s), as the start of another run.

        Raises
        ------
        ResultError
            If `time` lies outside the run.
        """
        wanted = read_arguments(Initial, time=time).time
        times = self.samples["time"]
        first, last = float(times[0]), float(times[-1])
        if not first <= wanted <= last:
            sampled = f"the run is sampled from {first:g} s to {last:g} s"
            raise ResultError(f"{sampled}, not at {wanted:g} s")
        at = len(times) - 1 - int(np.argmin(np.abs(times[::-1] - wanted)))  # of two, the later one
        names = ("u_x", "u_y", "v_x", "v_y", "time")
        values: dict[str, Any] = {name: float(self.samples[name][at]) for name in names}
        own = [each.name for each in states(self.slider.law)]
        internal = {name: float(self.samples[name][at]) for name in own}
        return Initial(**values, states=internal) if internal else Initial(**values)

    def save(self, path: str | Path) -> Path:
        """Write the result as NetCDF, whole or not at all; return the path.

        Raises
        ------
        ResultError
            If the file cannot be written there.
        """
        target = placeable(path, NETCDF)
        shown = "data" in vars(self)  # who has seen the dataset may have added to it
        samples = as_table(self.data) if shown else self.samples
        with whole(target) as part:
            write_result(samples, stick_table(self.stick_intervals), part)
        return target


@runtime_checkable
class Exportable(Protocol):
    """A result that writes itself for other programs: a run, a record or an analysis."""

    def export(self, path: str | Path) -> list[Path]:
        """Write it as CSV, Parquet or MATLAB; return the paths."""


def export(result: Exportable | str | Path, path: str | Path, *, trust: bool = False) -> list[Path]:
    """Write a run for another program: CSV, Parquet or MATLAB; return the paths.

    Parameters
    ----------
    result : Trajectory, Record, Analysis, str or Path
        A run, or its file; a record and an analysis write their own tables.
    path : str or Path
        With .csv or .parquet, the samples go there and the stick intervals beside it
        (``run-sticks.csv``). With .mat, one file holds the structs ``samples``, ``sticks`` and
        ``units``. CSV has units in its column heads, Parquet in its metadata.
    trust : bool, optional
        For a file; see `load`.

    Raises
    ------
    ResultError
        If the format is unknown, needs a missing package (Parquet needs pyarrow: install
        ``stiction[parquet]``), or the file cannot be written.

    Examples
    --------
    >>> import stiction as st, tempfile
    >>> run = st.simulate(st.presets.nakano_popov_2020(), "20 ms", sample_rate="1 kHz")
    >>> [path.name for path in st.export(run, tempfile.mkdtemp() + "/run.csv")]
    ['run.csv', 'run-sticks.csv']
    """
    if not isinstance(result, Trajectory | str | Path):
        return result.export(path)
    faults = Faults()
    with faults.of_part():
        exportable(path)
    with faults.of_part():
        run = run_of(result, trust)
    faults.refuse()
    about = {
        "description": run.description.to_toml(),
        "stiction_version": str(run.data.attrs["stiction_version"]),
        "status": run.status.name,
    }
    return write_tables({"samples": run.data, "sticks": run.sticks}, path, about)


def run_of(source: Trajectory | str | Path, trust: bool) -> Trajectory:
    """Return a run: the given one, or a file's; see `load`."""
    return source if isinstance(source, Trajectory) else load(source, trust=trust)


def load(path: str | Path, *, trust: bool = False) -> Trajectory:
    """Read back a result file.

    Parameters
    ----------
    path : str or Path
        Written by ``run.save`` or ``stiction run``.
    trust : bool, optional
        Whether the text of a friction law in the file may be run. Needed only for a user's law
        that this process has not loaded already from the same text: without it, a file never
        runs code.

    Raises
    ------
    ResultError
        If the file does not exist, or is not a result of this package.

    Examples
    --------
    >>> import stiction as st
    >>> st.simulate(st.presets.nakano_popov_2020(), "20 ms").save("run.nc").name
    'run.nc'
    >>> st.load("run.nc").status.ok
    True
    """
    data, sticks = read_tables(path)
    try:
        description = Description.from_json(data.attributes["description"], trust=trust)
        statistics = Statistics(
            **{
                name: data.attributes[name].item()
                for name in Statistics.__dataclass_fields__
                if name != "mapped" or name in data.attributes  # not in results of version 0.2
            }
        )
        status = Status[data.attributes["status"]]
        for state in states(description.slider.law):
            data[state.name]
    except (DescriptionError, KeyError, ValueError, AttributeError) as error:
        told = f"its attributes cannot be read: {error}"
        raise ResultError(f"{path}: {told}{age(data.attributes)}") from None
    intervals = np.column_stack([sticks[name] for name in ENDS])
    arrays = partial(_with_mu, data, description.slider)
    return Trajectory(description, arrays, intervals, status, statistics)


def _with_mu(samples: ColumnTable, slider: Slider) -> ColumnTable:
    """Add the apparent friction coefficient to samples of version 0.4."""
    if "mu" in samples.columns:
        return samples
    mu = Column(("time",), apparent_friction(slider, samples), cf_attributes(*VARIABLES["mu"]))
    return ColumnTable({**samples.columns, "mu": mu}, samples.attributes)
