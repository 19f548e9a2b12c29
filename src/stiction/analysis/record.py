"""A record: a force over time, simulated or measured, the input of all analyses."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import hypot, pi, sqrt
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import BeforeValidator, InstanceOf, PrivateAttr, model_validator
from pydantic.functional_validators import ModelWrapValidatorHandler
from pydantic_core import PydanticCustomError

from stiction.analysis.drive.measured_drive import EvenDrive, even_drive, uneven_speeds
from stiction.analysis.signals.digitised import first_of_each
from stiction.analysis.signals.robust import inner_product, uniform_mean
from stiction.arrays import Floats, Indices, data_frame, xr
from stiction.errors import DescriptionError, Fault, echo
from stiction.formats.channels import CHANNELS as COLUMNS
from stiction.formats.table import number_of
from stiction.names import draw, own_picture
from stiction.recording.guess.clock import rate_of, spread_evenly
from stiction.recording.noise import ORDER, difference_gain, white_noise
from stiction.recording.origin import Origin
from stiction.recording.request import KNOWN, SignedForce
from stiction.recording.sensor import Sensor
from stiction.recording.stored import write_stored
from stiction.storage.table_files import write_tables
from stiction.system.slider import Slider
from stiction.text.quantity.wording import in_words
from stiction.text.samples import as_numbers, samples_to_si
from stiction.text.sections import Section, Table, as_html
from stiction.text.units import (
    FORCE,
    LENGTH,
    TIME,
    VELOCITY,
    Angle,
    Force,
    Mass,
    PositiveSpeed,
    Stiffness,
    split_uncertain,
    unit_on,
)
from stiction.text.validation import Described, faulty, unknown_name

if TYPE_CHECKING:
    import pandas as pd

LARGEST_SAMPLE = 1e100  # of any sample, in SI: its square must not overflow
SMALLEST = 1e-100  # smaller values are taken as zero, because their squares underflow
SHARP = 1e-3  # of the load: noise of it that is averaged away
# errors of the variance of noise, by which a load varies for sure; by fourth differences, which are
# correlated, that is known half as well as by the noise itself
CERTAIN = 10.0
LONGEST_MEAN = 1 / 400  # of the record: over so much of it the load is averaged at most
CHANNELS = tuple(name for name in COLUMNS if name != "time")  # (n,), beside the time
UNITS = {name: f"{name}_unit" for name in ("time", *CHANNELS)}


def _samples(values: Any) -> Floats:
    samples = as_numbers(values)
    lost = np.flatnonzero(~np.isfinite(samples))
    if len(lost):
        raise ValueError(
            f"{len(lost)} of {len(samples)} samples are not finite, the first is number "
            f"{lost[0] + 1}; leave them out of every array: samples need not be equally spaced"
        )
    if np.abs(samples).max(initial=0.0) > LARGEST_SAMPLE:
        raise ValueError(
            f"must be in SI and below {LARGEST_SAMPLE:g}, is {np.abs(samples).max():g}"
        )
    samples[np.abs(samples) < SMALLEST] = 0.0
    samples.setflags(write=False)
    return samples


A_FORCE, A_LENGTH = FORCE._replace(example="mN"), LENGTH._replace(example="um")
KINDS = {
    "time": TIME._replace(example="ms"),
    "force": A_FORCE,
    "force_across": A_FORCE,
    "load": A_FORCE,
    "position": A_LENGTH,
    "drive_position": A_LENGTH,
    "slip_speed": VELOCITY._replace(example="mm/s"),
}
Samples = Annotated[Any, BeforeValidator(_samples)]


class OfRun(NamedTuple):
    """The run of a record: slider and sticks, and (n,) each of all samples, for its parts, too.

    `time` is in s, `rate_across`, of the mass along the stiffer axis, in m/s, and `drive_travel`,
    along the force, in m; None where the drive is constant. `force_rate` is in N/s; None where the
    force is not the run's any more. `rtol` is the tolerance of the solver.
    """

    slider: Slider
    sticks: Floats
    time: Floats
    rate_across: Floats
    drive_travel: Floats | None
    force_rate: Floats | None
    rtol: float


class ExactForce(NamedTuple):
    """The force of a run, (n,), with its rate and all else that its kind of motion depends on."""

    slider: Slider
    # s, N, N/s, and m/s: of slip, and of the mass along the stiffer axis
    time: Floats
    force: Floats
    rate: Floats
    slip_speed: Floats
    rate_across: Floats
    sticks: Floats  # (k, 2), s
    rtol: float  # of the solver


class Record(Described):
    """A force over time, and the known parameters of the apparatus.

    Parameters
    ----------
    time : array
        (n,), s, increasing; it need not be equally spaced. Samples of the same time, as a clock
        coarser than the sampling gives them, are spread evenly up to the next time. This and every
        array may carry a unit, as a pint quantity or as ``attrs["units"]`` of a DataArray. Dates,
        of Python, NumPy or pandas, become seconds since the first; spans of time, seconds.
    force : array
        (n,), N: the spring force, positive where the spring pulls the mass along the drive.
    normal_load : float or str, optional
        W, N; needed for friction coefficients. By default the mean of `load`; where `load` varies,
        coefficients are force over load at the same instant.
    stiffness : float or str, optional
        Of the spring along the force, N/m. With `drive_velocity` it yields the mass's position.
    stiffness_across : float or str, optional
        Of the spring across it, N/m. With `mass` it yields the transverse frequency.
    drive_velocity : float or str, optional
        Along the force, m/s. Where none is stated, an analysis takes the slope of
        `drive_position`, if that is even.
    mass : float or str, optional
        kg.
    position, slip_speed : array, optional
        (n,), position along the drive, m, and slip speed, m/s, if they were measured.
    force_across, load : array, optional
        (n,), N: the force across the drive, and the normal load over time, if they were measured.
    drive_position : array, optional
        (n,), displacement of the drive along the force, m, if it was measured.
    zero : float or str, optional
        N, reading of the load cell without load; it is subtracted from the force, then set to 0.
        With its standard uncertainty, ``"0.8 +- 0.1 N"``, which the sensor of the force then has.
    turned : float or str, optional
        Angle, rad, by which the rig was turned on purpose for this record: a fit adds it to the
        misalignment of the rig's description.
    sensors : dict, optional
        From a channel to its `stiction.Sensor`: what is known of noise, gain and zero.
    origin : Origin, optional
        Of which file it was read, and how (`stiction.read_record`).
    time_unit, force_unit, ... : str, optional
        Units of arrays that do not carry their own, one for each: ``time_unit="ms"``. The record
        converts them to SI.

    Raises
    ------
    DescriptionError
        With every fault at once.

    Examples
    --------
    >>> import numpy as np, stiction as st
    >>> time = np.arange(0.0, 10.0, 1e-3)
    >>> record = st.Record(time=time, force=1.0 + 0.2 * (time % 2.0), stiffness="0.2 N/m")
    >>> f"{record.duration:.3f} s at {record.sample_rate:.0f} Hz"
    '9.999 s at 1000 Hz'
    """

    _independent: ClassVar[bool] = True

    time: Samples
    force: Samples
    normal_load: Force | None = None
    stiffness: Stiffness | None = None
    drive_velocity: PositiveSpeed | None = None
    mass: Mass | None = None
    turned: Angle | None = None
    position: Samples = None
    slip_speed: Samples = None
    zero: SignedForce | None = None
    stiffness_across: Stiffness | None = None
    force_across: Samples = None
    load: Samples = None
    drive_position: Samples = None
    sensors: dict[str, InstanceOf[Sensor]] | None = None
    origin: InstanceOf[Origin] | None = None
    time_unit: str = "s"
    force_unit: str = "N"
    position_unit: str = "m"
    slip_speed_unit: str = "m/s"
    force_across_unit: str = "N"
    load_unit: str = "N"
    drive_position_unit: str = "m"
    _same_time: int = PrivateAttr(0)
    _repeats: int = PrivateAttr(1)
    _measured_velocity: float | None = PrivateAttr(None)
    _of_run: OfRun | None = PrivateAttr(None)
    _units: dict[str, str] = PrivateAttr(default_factory=dict)

    @model_validator(mode="wrap")
    @classmethod
    def _with_units(cls, given: Any, make: ModelWrapValidatorHandler[Self]) -> Self:
        """Store the units in which arrays were given, which a doubt of them names."""
        made = make(given)
        if isinstance(given, Mapping):
            made._units = {
                name: str(given.get(key) or KINDS[name].unit)
                for name, key in UNITS.items()
                if unit_on(given.get(name)) is None
            }
        return made

    @model_validator(mode="before")
    @classmethod
    def _to_si(cls, given: Any) -> Any:
        """Return the arguments with every array in SI."""
        read, wrong = dict(given), []
        for name, key in UNITS.items():
            values = given.get(name)
            read.pop(key, None)  # a record is in SI: its fields make an equal one
            if values is None:
                read.pop(name, None)  # as if left out
                continue
            unit, kind = unit_on(values), KINDS[name]
            said = given.get(key)
            if unit is not None and said is not None and said != unit:
                wrong.append(
                    Fault(key, f"is {echo(said)}, but {name} carries {echo(unit)}; give one")
                )
                continue
            try:
                read[name] = samples_to_si(values, unit or str(said or kind.unit), kind)
            except PydanticCustomError as error:
                wrong.append(Fault(name if unit else key, error.message()))
            except ValueError as error:
                wrong.append(Fault(name, str(error)))
        if (split := split_uncertain(read.get("zero"))) is not None:
            read["zero"], uncertainty = split
            sensors = read.get("sensors") or {}
            own = sensors.get("force", Sensor())
            try:
                read["sensors"] = {**sensors, "force": own.replace(zero_uncertainty=uncertainty)}
            except DescriptionError as unread:
                wrong += [Fault("zero", each.message) for each in unread.faults]
        if wrong:
            raise faulty(wrong)
        return read

    @model_validator(mode="after")
    def _without_zero(self) -> Self:
        if self.zero:
            force = self.force - self.zero
            force.setflags(write=False)
            self.__dict__.update(force=force, zero=0.0)
        return self

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        found = [*self._wrong_lengths(), *self._wrong_load(), *self._wrong_sensors()]
        if found:
            raise faulty([Fault("", message) for message in found])
        if self.load is not None and len(self.load) and self.normal_load is None:
            self.__dict__.update(normal_load=float(self.load.mean()))
            self.__pydantic_fields_set__.discard("normal_load")
        return self

    def _wrong_lengths(self) -> Iterator[str]:
        for name in CHANNELS:
            values = getattr(self, name)
            if values is not None and len(values) != len(self.time):
                has = f"has {number_of(len(values), 'sample')} and time {len(self.time)}"
                yield f"{name} {has}; give one for each time"
        back = np.flatnonzero(np.diff(self.time) < 0.0)
        if len(back):
            yield (
                f"time must increase; sample {back[0] + 2}, at {self.time[back[0] + 1]:g} s, "
                f"follows one at {self.time[back[0]]:g} s"
            )

    def _wrong_load(self) -> Iterator[str]:
        mean = 1.0 if self.load is None or not len(self.load) else float(self.load.mean())
        if mean <= 0.0:
            yield f"load must press the bodies together, its mean is {mean:g} N"

    def _wrong_sensors(self) -> Iterator[str]:
        for name, sensor in (self.sensors or {}).items():
            if name not in CHANNELS:
                yield f"sensors: {unknown_name('channel', name, CHANNELS)}"
            elif sensor.unit != KINDS[name].unit:
                its = f"that of {name} is in {sensor.unit}"
                yield f"sensors: {its}; make it with unit={KINDS[name].unit!r}"

    @model_validator(mode="after")
    def _one_sample_a_time(self) -> Self:
        same = int(np.count_nonzero(np.diff(self.time) == 0.0))
        if same:
            if self.time[-1] == self.time[0]:
                raise ValueError(
                    f"time must increase; all {len(self.time)} samples are at {self.time[0]:g} s"
                )
            time = spread_evenly(self.time)
            time.setflags(write=False)
            self.__dict__.update(time=time)
            self._same_time += same
        return self

    def unit_as_read(self, channel: str) -> str | None:
        """Return the stated unit of an array; None if the array carried its own."""
        return self._units.get(channel)

    @property
    def same_time(self) -> int:
        """Number of samples that were given the same time as the one before."""
        return self._same_time

    @property
    def repeats(self) -> int:
        """Number of samples for which each value of the force lasted (`each_value_once`)."""
        return self._repeats

    def with_measured_velocity(self) -> Self:
        """Return the record with the velocity of an even `drive_position`, if none is stated."""
        its = None if self.drive_velocity is not None else self.even_drive()
        if its is None:
            return self
        found = self.model_copy(update={"drive_velocity": its.speed})
        found._measured_velocity = its.speed
        return found

    def even_drive(self) -> EvenDrive | None:
        """Return the speed that an even `drive_position` shows; None if it is not even.

        Its error holds that of the gain of its sensor.
        """
        if self.drive_position is None or not len(self):
            return None
        found = even_drive(self.time, self.drive_position)
        sensor = (self.sensors or {}).get("drive_position")
        if found is None or sensor is None:
            return found
        return found._replace(error=hypot(found.error, found.speed * sensor.gain_uncertainty))

    def uneven_speeds(self) -> tuple[float, float] | None:
        """Return the least and the largest speed (m/s) of an uneven `drive_position`, or None."""
        if self.drive_position is None or not len(self):
            return None
        return uneven_speeds(self.time, self.drive_position)

    def each_value_once(self) -> Self:
        """Return the record with each value of the force once, if a slow sensor repeats them all.

        Repeated values have noise that differences do not show, and hide when peaks are.
        """
        first = first_of_each(self.force)
        if first is None:
            return self
        found = self.part(first)
        found._repeats = int(np.median(np.diff(first)))
        return found

    @property
    def stated_load(self) -> float | None:
        """Normal load as it was stated, N; None where `normal_load` is the mean of `load`."""
        return self.normal_load if "normal_load" in self.model_fields_set else None

    @property
    def stated_velocity(self) -> float | None:
        """Drive velocity as it was stated, m/s; None where `drive_velocity` was measured."""
        measured = self.drive_velocity == self._measured_velocity
        return None if measured else self.drive_velocity

    def stated_numbers(self) -> dict[str, float | None]:
        """Return the numbers of the apparatus that were stated, by name; None of the others."""
        own = {"normal_load": self.stated_load, "drive_velocity": self.stated_velocity}
        return {name: getattr(self, name) for name in KNOWN} | own

    @property
    def sticks(self) -> Floats | None:
        """All stick intervals of a run's record, (n, 2), s; None for a measured one."""
        return self._of_run and self._of_run.sticks

    @property
    def own_period(self) -> float | None:
        """Period of the mass on the spring along x alone, s; None for a measured record."""
        return 1.0 / self.slider.natural_frequency_x if self.slider else None

    @property
    def stated_period(self) -> float | None:
        """Period 2 pi (m/k)^1/2 of the mass on the spring alone, s, where both are stated."""
        if self.mass is None or self.stiffness is None:
            return None
        return 2.0 * pi * sqrt(self.mass / self.stiffness)

    @property
    def loading_rate(self) -> float:
        """How fast a spring is loaded (N/s), stiffness times drive velocity; 0 if unknown."""
        return (self.stiffness or 0.0) * (self.drive_velocity or 0.0)

    @property
    def drive_travel(self) -> Floats | None:
        """How far the drive has moved along the force, (n,), m, of a run whose drive varies."""
        return self._of_run and self._at_own_times(self._of_run.drive_travel)

    @property
    def slider(self) -> Slider | None:
        """The system of a run's record; None for a measured one."""
        return self._of_run and self._of_run.slider

    @property
    def rate_across(self) -> Floats | None:
        """Velocity of the mass along the stiffer axis, (n,), m/s, of a run."""
        return self._of_run and self._at_own_times(self._of_run.rate_across)

    @property
    def exact(self) -> ExactForce | None:
        """The force of a run, as the solver found it; None of any other."""
        if self._of_run is None or self.slip_speed is None:
            return None
        slider, sticks, _, _, _, _, rtol = self._of_run
        rate, across = (
            self._at_own_times(each) for each in (self._of_run.force_rate, self._of_run.rate_across)
        )
        if rate is None or across is None:
            return None
        return ExactForce(
            slider, self.time, self.force, rate, self.slip_speed, across, sticks, rtol
        )

    def _at_own_times(self, values: Floats | None) -> Floats | None:
        """Return values at this record's times, from all samples of the run."""
        if self._of_run is None or values is None:
            return None
        if np.array_equal(self.time, self._of_run.time):
            return values
        return np.asarray(np.interp(self.time, self._of_run.time, values))

    def steady_until(self, time: float) -> float:
        """Return until when drive and load are known to go on as at a time, s: at most the end.

        Those of a measured record are supposed to.
        """
        end = float(self.time[-1])
        return min(end, self.slider.steady_until(time)) if self.slider else end

    def __len__(self) -> int:
        """Return the number of samples."""
        return len(self.time)

    @property
    def duration(self) -> float:
        """Time from the first sample to the last, s."""
        return float(self.time[-1] - self.time[0]) if len(self) else 0.0

    @property
    def sample_rate(self) -> float:
        """Samples per second, gaps left out; 0 for a single sample.

        It is the average if intervals differ at random.
        """
        return rate_of(self.time)

    def relative_load(self) -> Floats:
        """Return the load over `normal_load`, (n,): 1 unless `load` varies; NaN where it lifts off.

        It is averaged over neighbouring samples, as many as its noise requires. Fourth differences
        show the noise of a sample: those of a load that varies slowly are nothing beside it.
        """
        if self.load is None or not self.normal_load or not np.ptp(self.load) > 0.0:
            return np.ones(len(self))
        load = uniform_mean(self.load, self.averaged_over)
        return np.asarray(np.where(load > 0.0, load, np.nan) / self.normal_load)

    def load_noise(self) -> float:
        """Return the relative standard error of the load, or of its mean where it does not vary."""
        if self.load is None or not self.normal_load or not np.ptp(self.load) > 0.0:
            return 0.0
        count = self.averaged_over if self.load_variation() > 0.0 else len(self)
        return float(self._noise_of_load() / count**0.5 / abs(self.load.mean()))

    @property
    def averaged_over(self) -> int:
        """Number of samples over which the load is averaged, as its noise requires."""
        if self.load is None:
            return 1
        wanted = (self._noise_of_load() / (SHARP * float(self.load.mean()))) ** 2
        return int(max(1.0, min(wanted, LONGEST_MEAN * len(self))))

    def _noise_of_load(self) -> float:
        """Return the noise of a sample of `load`, N."""
        return 0.0 if self.load is None or len(self) <= ORDER else white_noise(self.load)

    def load_variation(self) -> float:
        """Return how far `load` varies beyond its noise, from least to largest, over its mean.

        It is that of a sine with the same standard deviation; 0 where there is no `load`, or where
        its noise may be all.
        """
        if self.load is None or not len(self):
            return 0.0
        # mean squares, as variances are subtracted: if a load flickers between two readings,
        # `white_noise`, by the median, is 0
        differences = np.diff(self.load, ORDER)
        square = inner_product(differences, differences) / difference_gain(ORDER)
        noise = square / max(len(differences), 1)
        rest = float(self.load.var()) - noise
        sure = rest > CERTAIN * (2.0 / len(self)) ** 0.5 * noise
        return float((8.0 * rest) ** 0.5 / self.load.mean()) if sure else 0.0

    def before(self, end: float) -> Self:
        """Return the part of the record before a time, s."""
        return self.part(slice(int(np.searchsorted(self.time, end))))

    def part(self, samples: slice | Indices) -> Self:
        """Return some of the samples, with all that is known of them."""
        cut = {name: values[samples] for name, values in self.channels().items()}
        return self.model_copy(update={"time": self.time[samples], **cut})

    def with_force(self, force: Floats) -> Self:
        """Return the record with another force (n,), N, that cannot be changed any more."""
        force.setflags(write=False)
        changed = self.model_copy(update={"force": force})
        if self._of_run is not None:
            changed._of_run = self._of_run._replace(force_rate=None)
        return changed

    def channels(self) -> dict[str, Floats]:
        """Return the measured channels by name, (n,) each, in SI; the force first."""
        found = {name: getattr(self, name) for name in CHANNELS}
        return {name: values for name, values in found.items() if values is not None}

    def save(self, path: str | Path) -> Path:
        """Write the record as NetCDF; `stiction.read_record` reads it back. Return the path.

        Raises
        ------
        ResultError
            If the file cannot be written there.
        """
        numbers = {
            name: value for name, value in self.stated_numbers().items() if value is not None
        }
        channels = {"time": self.time, **self.channels()}
        return write_stored(path, channels, numbers, self.sensors or {}, self.origin)

    @property
    def data(self) -> xr.Dataset:
        """The channels over time as a dataset, in SI, with units."""
        columns = {
            name: ("time", values, {"units": KINDS[name].unit})
            for name, values in self.channels().items()
        }
        return xr.Dataset(columns, {"time": ("time", self.time, {"units": "s"})})

    def to_dataframe(self) -> pd.DataFrame:
        """Return the channels as a pandas data frame, indexed by time, in SI.

        Examples
        --------
        >>> import stiction as st
        >>> record = st.Record(time=[0.0, 1.0], force=[0.0, 2.0], force_unit="mN")
        >>> float(record.to_dataframe()["force"].max())
        0.002
        """
        return data_frame(self.data)

    def export(self, path: str | Path) -> list[Path]:
        """Write the channels as CSV, Parquet or MATLAB, in SI; return the paths.

        `stiction.read_record` reads such a file. Tell it which column is a displacement, and what
        `save` stores beside the channels: the apparatus, and the sensors.

        Raises
        ------
        ResultError
            If the format is unknown, needs a missing package, or the file cannot be written.

        Examples
        --------
        >>> import numpy as np, stiction as st, tempfile
        >>> record = st.Record(time=np.arange(3.0), force=np.array([0.0, 1.0, 0.5]))
        >>> (path,) = record.export(tempfile.mkdtemp() + "/data.csv")
        >>> path.read_text().splitlines()[:2]
        ['time [s],force [N]', '0.0,0.0']
        """
        return write_tables({"record": self.data}, path, {})

    def _repr_html_(self) -> str:
        rows = [
            (name.replace("_", " "), in_words(value, KNOWN[name]))
            for name, value in self.stated_numbers().items()
            if value is not None
        ]
        sampled = f"{len(self)} samples over {in_words(self.duration, 's')}: "
        said = Section("Record", [f"{sampled}{', '.join(self.channels())}."])
        own = said._replace(table=Table(("stated", ""), rows)) if rows else said
        read = [] if self.origin is None else self.origin.tables()
        return as_html([own, *read]) + own_picture(self)

    def plot(self, axes: Any = None) -> NDArray[np.object_]:
        """Draw the force with its cycles; see `stiction.plotting.plot_cycles`."""
        drawn: NDArray[np.object_] = draw("plot_cycles", self, axes)
        return drawn


def lacking_for_loading(record: Record) -> str:
    """Return which numbers of the rate of loading a record does not know, for a message."""
    known = {"stiffness": record.stiffness, "drive velocity": record.drive_velocity}
    return " and ".join(name for name, value in known.items() if value is None)
