"""A parameter along an axis: its symbol, and its values in a suitable unit."""

from __future__ import annotations

from math import ceil, degrees, floor, log10
from typing import Any, Literal, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullFormatter, NullLocator
from numpy.typing import ArrayLike

from stiction.arrays import Floats
from stiction.plotting.page.words import symbol
from stiction.text.quantity.prefix import metric_prefix

SYMBOLS = {"phi": r"$\varphi$", "drive.velocity": "$V$", "normal_load": "$W$", "mass": "$m$"}
PLAIN = FuncFormatter(lambda value, _: f"{value:g}")  # 0.1, 1, 10: the units suit the values

SMALL = 1e-3  # below it with a power of ten
FEWEST_TICKS = 3  # by two labels, a logarithmic scale is hardly read
SHORT = 5.0  # ratio of the ends of a logarithmic axis, below which its ticks are even
FEW_DECADES = 30.0  # the ratio of the ends of an axis


def sparse(least: float) -> FuncFormatter:
    """Return labels of close ticks within a decade, from `least` on: one, two and five only.

    All are written alike, with powers of ten if the least value is small.
    """

    def label(value: float, _: object) -> str:
        digit, power = f"{value:.0e}".split("e")
        if digit not in "125":
            return ""
        if least >= SMALL:
            return f"{value:g}"
        return (
            rf"$10^{{{int(power)}}}$" if digit == "1" else rf"${digit}\times 10^{{{int(power)}}}$"
        )

    return FuncFormatter(label)


def label_decades(axis: Axis, low: float, high: float) -> None:
    """Label the decades of a logarithmic axis; if it has few, close ticks within them too.

    A single label would tell no scale.
    """
    powers = floor(log10(high)) - ceil(log10(low)) + 1
    few = high < FEW_DECADES * low or powers < 2
    axis.set_minor_formatter(sparse(low) if few else NullFormatter())
    if few:
        axis.set_major_formatter(sparse(low))


def parameter_symbol(path: str) -> str:
    """Return the printed symbol of a parameter; equals signs join several.

    Outside of slider and friction, whose symbols are known, it names the owner, too: each piece of
    a program, and the run, has a duration.

    >>> parameter_symbol("friction.mu_0"), parameter_symbol("drive.program.1.duration")
    ('$\\\\mu_{0}$', 'drive program 1 duration')
    """
    names = (name.strip().removeprefix("slider.") for name in path.split(","))
    return " = ".join(SYMBOLS.get(name) or _behind_owners(name) for name in names)


def _behind_owners(name: str) -> str:
    """Return the symbol of a parameter behind the names of its owners."""
    *owners, last = name.removeprefix("friction.").removeprefix("springs.").split(".")
    return " ".join([*(owner.replace("-", " ") for owner in owners), symbol(last)])


def in_unit(values: ArrayLike, unit: str) -> tuple[float, str]:
    """Return a suitable unit of the values, deg for rad, and the factor from SI."""
    if unit == "rad":
        return degrees(1.0), "deg"
    if unit in ("kg", "1", ""):
        return 1.0, unit or "1"
    factor, prefix = metric_prefix(values)
    return factor, prefix + unit.replace("*", " ")


class FewOnLog(LogLocator):
    """Ticks of a logarithmic axis; even ones on a short axis, which else has hardly any."""

    def tick_values(self, vmin: float, vmax: float) -> Any:
        """Return the places of ticks between two values."""
        if vmax < SHORT * vmin:
            return MaxNLocator(4, steps=[1, 2, 2.5, 5, 10]).tick_values(vmin, vmax)
        found = np.asarray(super().tick_values(vmin, vmax))
        if np.count_nonzero((vmin <= found) & (found <= vmax)) >= FEWEST_TICKS:
            return found
        return LogLocator(subs=(1.0, 2.0, 3.0, 5.0, 7.0)).tick_values(vmin, vmax)


def use_scale(ax: Axes, way: Literal["x", "y"], log: bool) -> None:
    """Give an axis a logarithmic scale with plain numbers, if it has one."""
    if not log:
        return
    ax.set(**{f"{way}scale": "log"})
    axis = ax.xaxis if way == "x" else ax.yaxis
    axis.set_major_locator(FewOnLog(subs=(1.0, 2.0, 5.0)))
    axis.set_minor_locator(NullLocator())
    axis.set_major_formatter(FuncFormatter(lambda x, _: f"{x:.3g}"))


class Scale(NamedTuple):
    """One parameter along an axis: its symbol, the factor from SI to the unit drawn, the unit."""

    symbol: str
    factor: float
    unit: str

    @property
    def label(self) -> str:
        """Symbol and unit."""
        return f"{self.symbol} ({self.unit})"

    def in_unit(self, values: ArrayLike) -> Floats:
        """Return values (SI) in the unit of the drawing."""
        found: Floats = np.asarray(values, dtype=np.float64) * self.factor
        return found

    def quantity(self, value: float) -> str:
        """Return one value (SI) with symbol and unit."""
        unit = "°" if self.unit == "deg" else f" {self.unit}" if self.unit != "1" else ""
        return f"{self.symbol} = {value * self.factor:.4g}{unit}"


def scale_of(path: str, unit: str, ends: ArrayLike, *, logarithmic: bool = False) -> Scale:
    """Return the scale of a parameter over a range (SI); a logarithmic one by its middle.

    A logarithmic one of negative values is that of their sizes.
    """
    size = np.sqrt(np.prod(np.asarray(ends, dtype=np.float64))) if logarithmic else ends
    scale = Scale(parameter_symbol(path), *in_unit(size, unit))
    if logarithmic and np.max(ends) < 0.0:
        return scale._replace(symbol=f"−{scale.symbol}", factor=-scale.factor)
    return scale
