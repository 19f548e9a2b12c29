"""The colours of a map of a study, for its figure and for the page of the explorer."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from matplotlib import colormaps
from matplotlib.colors import Colormap, ListedColormap, LogNorm, Normalize
from numpy.typing import NDArray

from stiction.arrays import Floats

DECADES = 30.0  # a measure that spans a larger factor is drawn in decades
DEEPEST = 1e6  # range below the largest value; smaller ones count as zero
# Of the others: so many of the smallest do not stretch a scale of so large a factor, as amplitudes
# of swings that have nearly died out would
FEW_VALUES, WIDE = 0.02, 1e3
NO_RESULT, NO_VALUE = "no result", "no value"

# light for calm, dark and warm for violent motion; in print without colour no two are alike
COLORS = {
    "stick-slip": "#C44E00",
    "transitional oscillation": "#E8903F",
    "harmonic vibration": "#F6CC86",
    "settling": "#D8E9F5",
    "steady sliding": "#8FC1E3",
    "transverse oscillation": "#8A3B78",
    "irregular vibration": "#4C3380",
    "stuck": "#8A8A8A",
    "undetermined": "#FFFFFF",
}
# for points, of which the colours alone would be alike to some eyes and in print
MARKERS = {
    "stick-slip": "o",
    "transitional oscillation": "s",
    "harmonic vibration": "D",
    "settling": "v",
    "steady sliding": "^",
    "transverse oscillation": "P",
    "irregular vibration": "X",
    "stuck": "p",
    "undetermined": "*",
}
LEGENDS = {"stuck": "stuck or creeping"}  # a run may end before the creeping mass slips


class Shades(NamedTuple):
    """The way from values to colours: a colour map, and the scale of the values."""

    colormap: Colormap
    norm: Normalize

    @property
    def limits(self) -> tuple[float, float]:
        """The values at the ends of the colour bar."""
        low, high = self.norm.vmin, self.norm.vmax
        assert low is not None
        assert high is not None
        return float(low), float(high)

    @property
    def log(self) -> bool:
        """Whether the colour bar is logarithmic."""
        return isinstance(self.norm, LogNorm)

    @property
    def bar(self) -> NDArray[np.uint8]:
        """The colours of the colour bar, from its lower end up."""
        return np.asarray(self.colormap(np.arange(self.colormap.N), bytes=True), np.uint8)

    def rgba(self, values: Floats) -> NDArray[np.uint8]:
        """Return the colour of each value, 0 to 255; all zero where there is none.

        Examples
        --------
        >>> measure_shades(np.array([1.0, 2.0])).rgba(np.array([1.0, np.nan])).tolist()
        [[0, 34, 77, 255], [0, 0, 0, 0]]
        """
        scaled = self.norm(np.ma.masked_invalid(values))
        return np.asarray(self.colormap(scaled, bytes=True), np.uint8)


def measure_shades(values: Floats) -> Shades:
    """Return the colours of a measure, logarithmic where its values span a large factor."""
    found = values[np.isfinite(values)]
    low, high = (float(found.min()), float(found.max())) if len(found) else (0.0, 1.0)
    if 0.0 < low < high / DECADES:
        if low < high / WIDE:
            counted = found[found > high / DEEPEST]
            low = min(float(np.quantile(counted, FEW_VALUES, method="lower")), high / DECADES)
        return Shades(colormaps["cividis"], LogNorm(low, high))
    margin = 0.0 if high > low else 0.1 * abs(high) or 0.1  # a colour bar must have a length
    return Shades(colormaps["cividis"], Normalize(low - margin, high + margin))


def kind_shades() -> Shades:
    """Return the colours of the codes of kinds of motion."""
    return Shades(ListedColormap(list(COLORS.values())), Normalize(-0.5, len(COLORS) - 0.5))


def kind_codes(kinds: NDArray[np.object_]) -> Floats:
    """Return the place of each kind of motion in `COLORS`; NaN for others."""
    codes = np.full(kinds.shape, np.nan)
    for code, name in enumerate(COLORS):
        codes[kinds == name] = code
    return codes


def legend_of(kind: str) -> str:
    """Return the words for a kind of motion in a legend.

    Examples
    --------
    >>> legend_of("stuck"), legend_of("settling")
    ('stuck or creeping', 'settling')
    """
    return LEGENDS.get(kind, kind)


def present_kinds(kinds: NDArray[np.object_]) -> list[str]:
    """Return the kinds of motion that occur, in the order of `COLORS`."""
    return [name for name in COLORS if (kinds == name).any()]
