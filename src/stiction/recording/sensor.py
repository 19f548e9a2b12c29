"""A sensor: from a quantity to its samples."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import lru_cache
from importlib import import_module
from math import ceil, hypot, inf, log2
from typing import Annotated, Any, ClassVar, NamedTuple, Self

import numpy as np
from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from stiction.arrays import Floats
from stiction.errors import Fault, ResultError, echo
from stiction.text.units import (
    FORCE,
    LENGTH,
    VELOCITY,
    Kind,
    Number,
    Rate,
    Whole,
    bare,
    split_uncertain,
    to_si,
)
from stiction.text.validation import Described, faulty

LEVELS = ("zero", "zero_uncertainty", "quantisation", "noise")  # in the unit of the channel
RATES = ("zero_drift", "zero_drift_uncertainty")  # in this unit over time
OF = "_uncertainty"  # ending of the name of a standard uncertainty
UNCERTAIN = ("gain", "zero", "zero_drift")  # may be written with their uncertainty: "0 +- 3 mN"
KINDS = {
    "N": FORCE._replace(example="3 mN"),
    "m": LENGTH._replace(example="1 um"),
    "m/s": VELOCITY,
}
KINDS_OF_RATES = {
    "N": Kind("a force over time", "N/s", "5 mN/min"),
    "m": Kind("a length over time", "m/s", "1 um/min"),
    "m/s": Kind("a velocity over time", "m/s^2", "1 um/s^2"),
}
FASTEST = 0.4  # of the sample rate: a faster filter cannot be distinguished from none
AtLeastZero = Annotated[Number, Field(ge=0)]
Order = Annotated[Whole, Field(ge=1), Field(le=12)]


class LowPass(NamedTuple):
    """A Butterworth filter: its cut-off (Hz), where it leaves half of the power, and its order."""

    cut: float
    order: int


class Sensor(Described):
    """A sensor: filter, noise, rounding and zero between a quantity and its samples.

    ``reading = gain * value + zero + zero_drift * time``, time being that since the first sample of
    the record; delayed by the cell's bandwidth and by the anti-alias filter, with white noise,
    rounded to steps of the quantisation.

    Parameters
    ----------
    gain, gain_uncertainty : float, optional
        Reading over value, and its standard uncertainty.
    zero, zero_uncertainty : float or str, optional
        Reading at zero, and its standard uncertainty, in `unit` or with a unit: ``"3 mN"``. Gain,
        zero and drift may have theirs in one text: ``"3 +- 1 mN"``.
    zero_drift, zero_drift_uncertainty : float or str, optional
        Change of the zero over time, `unit` over s, and its standard uncertainty: of a load cell of
        which no more is known, ``"0 +- 5 mN/min"``. `zero` is then that of the first sample.
    bandwidth : float or str, optional
        Of cell and amplifier, Hz: where a first-order response has fallen by 3 dB.
    filter, filter_order : float or str, int, optional
        Cut-off of the anti-alias filter, Hz, a Butterworth filter of this order.
    quantisation : float or str, optional
        Step between two readings.
    noise : float or str, optional
        Standard deviation of white noise.
    unit : str, optional
        SI unit of the channel: "N", "m" or "m/s".

    Examples
    --------
    >>> import stiction as st
    >>> st.Sensor(noise="2 mN", quantisation="0.5 mN", bandwidth="1 kHz")
    st.Sensor(bandwidth=1000.0, quantisation=0.0005, noise=0.002)
    >>> st.Sensor(zero="3 mN", zero_drift="0 +- 6 mN/min")
    st.Sensor(zero=0.003, zero_drift_uncertainty=0.0001)
    """

    _independent: ClassVar[bool] = True

    gain: Number = 1.0
    gain_uncertainty: AtLeastZero = 0.0
    zero: Number = 0.0
    zero_uncertainty: AtLeastZero = 0.0
    zero_drift: Number = 0.0
    zero_drift_uncertainty: AtLeastZero = 0.0
    bandwidth: Rate | None = None
    filter: Rate | None = None
    filter_order: Order = 4
    quantisation: AtLeastZero = 0.0
    noise: AtLeastZero = 0.0
    unit: str = "N"

    @model_validator(mode="before")
    @classmethod
    def _to_si(cls, given: Any) -> Any:
        """Return the arguments with levels and rates that carry a unit in SI."""
        unit = str(given.get("unit", "N"))
        if unit not in KINDS:
            raise faulty(
                [Fault("unit", f"is {echo(given['unit'])}; write one of {', '.join(KINDS)}")]
            )
        read, wrong = _split(given)
        kinds = dict.fromkeys(LEVELS, KINDS[unit]) | dict.fromkeys(RATES, KINDS_OF_RATES[unit])
        for name, kind in kinds.items():
            read |= {name: bare(read[name])} if name in read else {}
            if not isinstance(read.get(name), str):
                continue
            try:
                read[name] = to_si(read[name], kind)
            except PydanticCustomError as error:
                wrong.append(
                    Fault(name if name in given else name.removesuffix(OF), error.message())
                )
        if wrong:
            raise faulty(wrong)
        return read

    @model_validator(mode="after")
    def _with_gain(self) -> Self:
        if self.gain == 0.0:
            raise ValueError("gain is 0: such a sensor shows nothing; give reading over value")
        return self

    def value(self, readings: Floats, time: Floats | None = None) -> Floats:
        """Return the values behind readings, by gain and zero, at `time` (n,), s."""
        return (readings - self.zeros(time)) / self.gain

    def zeros(self, time: Floats | None) -> Floats | float:
        """Return the zero at times (n,), s, the first of which is the start of the record.

        Raises
        ------
        ResultError
            If the zero drifts and no times are given.

        Examples
        --------
        >>> import numpy as np, stiction as st
        >>> st.Sensor(zero="3 mN", zero_drift="60 mN/min").zeros(np.array([5.0, 7.0]))
        array([0.003, 0.005])
        """
        if self.zero_drift == 0.0:
            return self.zero
        if time is None:
            raise ResultError(
                f"zero_drift is {self.zero_drift:g} {self.unit}/s, so that the zero depends on the "
                "time; give the times of the samples too: time=record.time"
            )
        return self.zero + self.zero_drift * (time - time[:1])

    def response(self, values: Floats, rate: float) -> Floats:
        """Return values as bandwidth and anti-alias filter leave them, before sampling.

        The sensor is at rest at the first value. Sections are bilinear transforms with their
        cut-off frequencies kept (A. V. Oppenheim & R. W. Schafer, Discrete-Time Signal Processing,
        section 7.1).

        Parameters
        ----------
        values : ndarray
            (n,), equally spaced.
        rate : float
            Of these values, Hz.

        Raises
        ------
        ResultError
            If the values are too coarse for the filter.
        """
        return low_pass(values, self.filters, rate)

    @property
    def filters(self) -> tuple[LowPass, ...]:
        """The effect of bandwidth and anti-alias filter on a signal."""
        its = LowPass(self.bandwidth or 0.0, 1), LowPass(self.filter or 0.0, self.filter_order)
        return tuple(each for each in its if each.cut)

    @property
    def cut_off(self) -> float:
        """The lowest frequency at which less than half of the power passes, Hz."""
        return min((each.cut for each in self.filters), default=inf)

    def readings(
        self, values: Floats, seed: int | np.random.SeedSequence, time: Floats | None = None
    ) -> Floats:
        """Return sampled values with gain, zero, noise and quantisation; the same for one seed.

        `time` (n,), s, is that of each value, for a zero that drifts.
        """
        found = self.gain * values + self.zeros(time)
        if self.noise:
            found = found + self.noise * np.random.default_rng(seed).standard_normal(len(found))
        return digitise(np.asarray(found, dtype=np.float64), self.quantisation)

    def behind(self) -> Sensor:
        """Return the sensor of a channel whose readings have been turned into values."""
        its = {name: getattr(self, name) for name in type(self).model_fields}
        scale = abs(self.gain)
        levels = ("zero_uncertainty", "zero_drift_uncertainty", "quantisation", "noise")
        in_values = {name: its[name] / scale for name in levels}
        rest = {"gain": 1.0, "zero": 0.0, "gain_uncertainty": self.gain_uncertainty / scale}
        return Sensor(**(its | in_values | rest | {"zero_drift": 0.0}))

    def later(self, elapsed: float) -> Sensor:
        """Return the sensor of the part of a record that begins `elapsed` seconds after its start.

        Examples
        --------
        >>> import stiction as st
        >>> st.Sensor(zero_uncertainty=0.3, zero_drift_uncertainty=0.1).later(4.0).zero_uncertainty
        0.5
        """
        zero = self.zero + self.zero_drift * elapsed
        error = hypot(self.zero_uncertainty, self.zero_drift_uncertainty * elapsed)
        return self.model_copy(update={"zero": zero, "zero_uncertainty": error})


def _split(given: Mapping[str, Any]) -> tuple[dict[str, Any], list[Fault]]:
    """Return the arguments of a sensor with each uncertainty apart, and double statements."""
    read, wrong = dict(given), []
    for name in UNCERTAIN:
        both = split_uncertain(read.get(name))
        if both is None:
            continue
        del read[name]
        if name + OF in read:
            wrong.append(
                Fault(name, f"has an uncertainty, and {name + OF} is another; leave out one")
            )
        elif both[1].startswith(("-", "−")):
            wrong.append(Fault(name, f"its uncertainty must not be below 0, is {echo(both[1])}"))
        else:
            read[name], read[name + OF] = both
    return read, wrong


def digitise(values: Floats, step: float) -> Floats:
    """Return values rounded to multiples of a step; as they are where it is 0."""
    return step * np.rint(values / step) if step else values


def low_pass(values: Floats, filters: Iterable[LowPass], rate: float) -> Floats:
    """Return equally spaced values, `rate` a second, as low-pass filters leave them.

    See `Sensor.response`.
    """
    for each in filters:
        if each.cut > FASTEST * rate:
            factor = 2 ** ceil(log2(each.cut / (FASTEST * rate)))
            raise ResultError(
                f"a filter at {each.cut:g} Hz needs samples at {each.cut / FASTEST:g} Hz or more, "
                f"the run has {rate:g} Hz; simulate it with {factor} times the sample rate"
            )
        if len(values):
            signal: Any = import_module("scipy.signal")  # slow to import
            sections, rest = _sections(each, rate)
            values = np.asarray(signal.sosfilt(sections, values, zi=rest * values[0])[0])
    return values


@lru_cache(maxsize=16)
def _sections(low_pass: LowPass, rate: float) -> tuple[Floats, Floats]:
    """Return a filter's sections, and their state after a long time at 1.

    They take three times as long as to filter a record of a fit's library.
    """
    signal: Any = import_module("scipy.signal")  # slow to import
    sections = signal.butter(low_pass.order, low_pass.cut, fs=rate, output="sos")
    return sections, signal.sosfilt_zi(sections)
