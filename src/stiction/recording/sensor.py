"""A sensor: from a quantity to its samples, and what is known of the errors in between."""

from __future__ import annotations

from importlib import import_module
from math import ceil, log2
from typing import Annotated, Any, Self

import numpy as np
from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from stiction.arrays import Floats
from stiction.errors import Fault, ResultError, echo
from stiction.text.units import Kind, Number, Rate, to_si
from stiction.text.validation import Described, faulty

LEVELS = ("zero", "zero_uncertainty", "quantisation", "noise")  # in the unit of the channel
KINDS = {
    "N": Kind("a force", "N", "3 mN"),
    "m": Kind("a length", "m", "1 um"),
    "m/s": Kind("a velocity", "m/s", "1 mm/s"),
}
FASTEST = 0.4  # of the sample rate: a faster filter cannot be distinguished from none
AtLeastZero = Annotated[Number, Field(ge=0)]
Order = Annotated[int, Field(ge=1), Field(le=12)]


class Sensor(Described):
    """The way from a quantity to the samples of a record.

    ``reading = gain * value + zero``, delayed by the cell's bandwidth and by the anti-alias filter,
    with white noise, rounded to steps of the quantisation.

    Parameters
    ----------
    gain, gain_uncertainty : float, optional
        Reading over value, and its standard uncertainty.
    zero, zero_uncertainty : float or str, optional
        Reading at zero, and its standard uncertainty, in `unit` or with a unit: ``"3 mN"``.
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
    """

    gain: Number = 1.0
    gain_uncertainty: AtLeastZero = 0.0
    zero: Number = 0.0
    zero_uncertainty: AtLeastZero = 0.0
    bandwidth: Rate | None = None
    filter: Rate | None = None
    filter_order: Order = 4
    quantisation: AtLeastZero = 0.0
    noise: AtLeastZero = 0.0
    unit: str = "N"

    @model_validator(mode="before")
    @classmethod
    def _to_si(cls, given: Any) -> Any:
        """Return the arguments with levels that carry a unit in SI."""
        read, wrong = dict(given), []
        kind = KINDS.get(str(read.get("unit", "N")))
        if kind is None:
            raise faulty(
                [Fault("unit", f"is {echo(read['unit'])}; write one of {', '.join(KINDS)}")]
            )
        for name in LEVELS:
            if not isinstance(read.get(name), str):
                continue
            try:
                read[name] = to_si(read[name], kind)
            except PydanticCustomError as error:
                wrong.append(Fault(name, error.message()))
        if wrong:
            raise faulty(wrong)
        return read

    @model_validator(mode="after")
    def _with_gain(self) -> Self:
        if self.gain == 0.0:
            raise ValueError("gain is 0: such a sensor shows nothing; give reading over value")
        return self

    def value(self, readings: Floats) -> Floats:
        """Return the values behind readings, by gain and zero."""
        return (readings - self.zero) / self.gain

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
        for cut, order in ((self.bandwidth, 1), (self.filter, self.filter_order)):
            if cut is not None:
                values = _low_pass(values, cut, order, rate)
        return values

    def readings(self, values: Floats, seed: int | np.random.SeedSequence) -> Floats:
        """Return sampled values with gain, zero, noise and quantisation; the same for one seed."""
        found = self.gain * values + self.zero
        if self.noise:
            found = found + self.noise * np.random.default_rng(seed).standard_normal(len(found))
        if self.quantisation:
            found = self.quantisation * np.rint(found / self.quantisation)
        return np.asarray(found, dtype=np.float64)

    def behind(self) -> Sensor:
        """Return the sensor of a channel whose readings have been turned into values."""
        its = {name: getattr(self, name) for name in type(self).model_fields}
        scale = abs(self.gain)
        levels = ("zero_uncertainty", "quantisation", "noise")
        in_values = {name: its[name] / scale for name in levels}
        rest = {"gain": 1.0, "zero": 0.0, "gain_uncertainty": self.gain_uncertainty / scale}
        return Sensor(**(its | in_values | rest))


def _low_pass(values: Floats, cut: float, order: int, rate: float) -> Floats:
    signal: Any = import_module("scipy.signal")  # slow to import
    if cut > FASTEST * rate:
        factor = 2 ** ceil(log2(cut / (FASTEST * rate)))
        raise ResultError(
            f"a filter at {cut:g} Hz needs samples at {cut / FASTEST:g} Hz or more, the run has "
            f"{rate:g} Hz; simulate it with {factor} times the sample rate"
        )
    sections = signal.butter(order, cut, fs=rate, output="sos")
    if not len(values):
        return values
    start = signal.sosfilt_zi(sections) * values[0]
    return np.asarray(signal.sosfilt(sections, values, zi=start)[0])
