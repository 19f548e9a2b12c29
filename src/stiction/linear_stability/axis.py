"""Axis of a parameter: its range, read with units, and its linear or logarithmic scale."""

from __future__ import annotations

from collections.abc import Sequence
from math import exp, inf, log, nan, pi
from typing import NamedTuple

from stiction.arguments import is_list
from stiction.errors import DescriptionError, Faults, echo
from stiction.system.parameter import change_parameter, change_unchecked, read, unit
from stiction.system.slider import Slider
from stiction.text.paths import canonical_path
from stiction.text.quantity.exact import angle_text
from stiction.text.units import Quantity

DECADES = 3.0  # in both directions from a parameter's own value, the default range
WIDE = 10.0  # the scale is logarithmic above this ratio of the ends


class Axis(NamedTuple):
    """A parameter's path, its SI unit, and the range (SI) that is mapped to 0 to 1."""

    path: str
    unit: str
    low: float
    high: float

    @property
    def logarithmic(self) -> bool:
        """Whether the scale is logarithmic."""
        ratio = self.high / self.low if self.low else 0.0
        return ratio > WIDE or 0.0 < ratio < 1.0 / WIDE  # both ends may be negative

    def value(self, fraction: float) -> float:
        """Return the value (SI) at a fraction of the range; exact at the ends."""
        if fraction in (0.0, 1.0):
            return self.high if fraction else self.low
        if self.logarithmic:
            return self.low * exp(fraction * log(self.high / self.low))
        return self.low + fraction * (self.high - self.low)

    def fraction(self, value: float) -> float:
        """Return the position of a value (SI) in the range; 0 to 1 inside."""
        if self.logarithmic:
            ratio = value / self.low
            return -inf if ratio <= 0.0 else log(ratio) / log(self.high / self.low)
        return (value - self.low) / (self.high - self.low)

    def on(self, slider: Slider, fraction: float) -> Slider:
        """Return the slider with the parameter at a fraction of the range."""
        return change_unchecked(slider, self.path, self.value(fraction))


def steadily_driven(slider: Slider, *paths: str) -> Slider:
    """Return the slider with a steady drive, if its drive's program has one velocity only.

    Then ``drive.velocity`` is that velocity. A program of which a parameter is varied stays.
    """
    if any(isinstance(path, str) and path.startswith("drive.program") for path in paths):
        return slider
    return slider.replace(drive=slider.motion) if slider.motion is not slider.drive else slider


def axis(slider: Slider, path: str, between: Sequence[Quantity] | None = None) -> Axis:
    """Return the axis of a parameter.

    Parameters
    ----------
    slider : Slider
        The system.
    path : str
        The parameter, see `stiction.system.parameter`.
    between : tuple of float or str, optional
        Its range, by default that of `critical`.

    Raises
    ------
    DescriptionError
        If the range is invalid, or contains forbidden values.
    """
    if not isinstance(path, str):
        raise DescriptionError.of("path", f"{echo(path)} is not a parameter; write 'phi'")
    path = canonical_path(path)
    ends = default(slider, path) if between is None else between
    if not is_list(ends) or len(ends) != 2:
        raise DescriptionError.of(path, f"{echo(ends)} is not a range; give its two ends")
    faults, values = Faults(), []
    for end in ends:
        with faults.of_part():
            values.append(read(change_parameter(slider, path, end), path))
    try:
        faults.refuse()
    except DescriptionError as error:
        if between is not None:
            raise
        message = f"the usual range, {ends[0]} to {ends[1]}, is not allowed; give another: {error}"
        raise DescriptionError.of(path, message) from None
    low, high = values
    if not low < high:
        raise DescriptionError.of(path, f"{echo(ends)} is not a range; give its low end first")
    return Axis(path, unit(slider, path), low, high)


def default(slider: Slider, path: str) -> tuple[float | str, float | str]:
    """Return the default range of a parameter; for phi, all misalignments of its sign."""
    if path == "phi" and slider.turn:
        ends = (-0.5 * pi, slider.turn) if slider.misalignment < 0.0 else (slider.turn, 0.5 * pi)
        return angle_text(ends[0]), angle_text(ends[1])
    if unit(slider, path) == "rad":
        return ("-90 deg", "0 deg") if present_value(slider, path) < 0.0 else ("0 deg", "90 deg")
    value = read(slider, path)
    if value == 0.0:
        message = "is zero, which gives no range; say which, for example between=(0, 1)"
        raise DescriptionError.of(path, message)
    low, high = sorted((value * 10.0**-DECADES, value * 10.0**DECADES))
    return low, high


def present_value(slider: Slider, path: str) -> float:
    """Return the value of a parameter in SI; NaN if joined parameters differ."""
    try:
        return read(slider, path)
    except DescriptionError:
        return nan
