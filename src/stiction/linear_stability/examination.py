"""Examination of steady sliding: its modes over a parameter, and critical parameter values."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import isfinite, log
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from stiction.arrays import Complex, xr
from stiction.errors import StictionError, echo
from stiction.linear_stability.axis import axis, present_value, steadily_driven
from stiction.linear_stability.curve import boundary
from stiction.linear_stability.linear import (
    BOUNDARY,
    STABLE,
    UNSTABLE,
    Linearisation,
    steady_sliding,
)
from stiction.linear_stability.roots import Critical, critical
from stiction.names import draw, old_attributes
from stiction.system.description import Description
from stiction.system.slider import Slider, slider_of
from stiction.text.quantity.wording import in_words
from stiction.text.sections import Report, Section, Table
from stiction.text.units import Quantity

if TYPE_CHECKING:
    from matplotlib.axes import Axes

OVER = ("phi", "drive.velocity")
DIGITS = 6  # shown of a critical value
Ends = Sequence[Quantity]


@dataclass(frozen=True, repr=False)
class Stability(Report):
    """Steady sliding, its modes, and the parameter values at which they begin to grow.

    Parameters
    ----------
    sliding : Linearisation
        Steady sliding of the given slider, and its modes.
    criticals : tuple of Critical
        For each varied parameter, the values at which stability changes.

    Examples
    --------
    >>> import numpy as np, stiction as st
    >>> found = st.stability(st.presets.nakano_popov_2020(), over="phi")
    >>> found.stable, round(float(np.degrees(found.criticals[0].values[0])), 3)
    (False, 8.656)
    """

    sliding: Linearisation
    criticals: tuple[Critical, ...]

    def __repr__(self) -> str:
        """Return a one-line summary."""
        return f"<Stability: {self.sliding.verdict}; over {', '.join(self.over)}>"

    @property
    def slider(self) -> Slider:
        """The system."""
        return self.sliding.slider

    @property
    def over(self) -> tuple[str, ...]:
        """The varied parameters."""
        return tuple(each.path for each in self.criticals)

    @property
    def stable(self) -> bool:
        """Whether every small disturbance of steady sliding decays."""
        return self.sliding.stable

    @cached_property
    def modes(self) -> xr.Dataset:
        """Growth rates and frequencies over the first parameter, see `modes_over`."""
        first = self.criticals[0]
        return modes_over(self.slider, first.path, ends(first))

    @cached_property
    def boundary(self) -> xr.Dataset:
        """The boundary of stability in the plane of the two parameters, see `boundary`."""
        if len(self.criticals) != 2:
            raise StictionError("a boundary needs two parameters: over=('phi', 'drive.velocity')")
        x, y = self.criticals
        return boundary(self.slider, x.path, y.path, x_between=ends(x), y_between=ends(y))

    def tables(self) -> list[Section]:
        """Return the modes and the critical values as sentences and tables."""
        return [*self._sections]

    @cached_property
    def _sections(self) -> tuple[Section, ...]:
        """All sections; a critical stiffness takes as long to find as a critical value."""
        of_spring = critical_stiffness_of(self.slider)
        its = self.criticals
        if self.over == OVER and of_spring is not None:
            its = (*its, of_spring)
        return modes_section(self.sliding, of_spring), critical_section(self.slider, its)

    def plot(self, axes: Any = None) -> Axes | NDArray[np.object_]:
        """Draw the modes over one parameter, or the boundary in the plane of two.

        See `stiction.plotting.plot_modes` and `stiction.plotting.plot_boundary`.
        """
        drawn: Axes | NDArray[np.object_] = draw("plot_stability", self, axes)
        return drawn


def stability(
    slider: Slider | Description | str | Path,
    over: str | Sequence[str] = OVER,
    between: Ends | Sequence[Ends | None] | None = None,
) -> Stability:
    """Examine whether a slider slides steadily, and at which parameter values this changes.

    Steady sliding is linearised: each mode of a small disturbance grows or decays.

    Parameters
    ----------
    slider : Slider, Description, str or Path
        The system, or the file of its description; with a steady drive and a constant load.
    over : str or tuple of str, optional
        The parameters to vary, for example ``"c_x"``; see `stiction.linear_stability.critical`.
    between : tuple of float or str, or tuple of tuple, optional
        The ranges, in SI or with units, by default those of `stiction.linear_stability.critical`.

    Returns
    -------
    Stability
        With ``sliding`` (modes), ``criticals``, ``boundary``, ``tables()`` and ``plot()``.

    Raises
    ------
    DescriptionError
        If there is no such parameter, no such range, or no steady sliding.

    Examples
    --------
    >>> import numpy as np, stiction as st
    >>> found = st.stability(st.presets.nakano_popov_2020(), over="phi")
    >>> found.stable, np.degrees(found.criticals[0].values).round(2)
    (False, array([ 8.66, 76.26]))
    """
    system = slider_of(slider)
    if not isinstance(over, str | Sequence):
        raise StictionError(f"over: {echo(over)} is not a parameter; name one, such as 'c_x'")
    paths = [over] if isinstance(over, str) else list(over)
    ranges: list[Any] = [None] * len(paths) if between is None else list(between)
    if isinstance(over, str) and between is not None:
        ranges = [between]
    if not 1 <= len(paths) <= 2 or len(ranges) != len(paths):
        counts = f"{len(paths)} and {0 if between is None else len(ranges)}"
        raise StictionError(
            f"give one or two parameters, and as many ranges or none; given: {counts}"
        )
    system = steadily_driven(system, *paths)
    found = (critical(system, *each) for each in zip(paths, ranges, strict=True))
    return Stability(steady_sliding(system), tuple(found))


def ends(found: Critical) -> tuple[float | str, float | str]:
    """Return the searched range, with the unit of an angle."""
    low, high = found.between
    return (f"{low!r} rad", f"{high!r} rad") if found.unit == "rad" else (low, high)


def modes_section(linear: Linearisation, of_spring: Critical | None = None) -> Section:
    """Return the verdict, and a row for each mode, one for a conjugate pair."""
    decays = "every small disturbance decays" if linear.stable else "not every disturbance decays"
    modes = zip(linear.eigenvalues, linear.frequencies, linear.damping_ratios, strict=True)
    rows = [
        (in_words(value.real, "1"), in_words(f, "1"), f"{zeta:.4g}")
        for value, f, zeta in modes
        if value.imag >= 0.0
    ]
    sentences = [f"Steady sliding is {linear.verdict}: {decays}."]
    law = linear.slider.law
    if linear.stable and getattr(law, "mu_static", 0.0) > law.coefficient(0.0):
        sentences.append(
            "The static coefficient plays no part in that: a mass that is at rest, or is stopped, "
            "may go on to stick and slip. stiction audit tries both starts."
        )
    sentences += beside_critical_stiffness(linear.slider, of_spring)
    headings = ("growth rate (1/s)", "frequency (Hz)", "damping ratio")
    return Section("Steady sliding", sentences, Table(headings, rows))


def critical_stiffness_of(slider: Slider) -> Critical | None:
    """Return the critical stiffness along x of rate and state; None for other friction."""
    if slider.springs or not hasattr(slider.law, "grain"):
        return None
    return critical(slider, "k_x")


def beside_critical_stiffness(slider: Slider, found: Critical | None = None) -> list[str]:
    """Return the stiffness along x relative to the critical one of rate and state.

    All else is as it is, the misalignment too: `stiction.theory.critical_stiffness` has none.
    """
    found = found or critical_stiffness_of(slider)
    if found is None:
        return []
    if not len(found.values):
        kind = BOUNDARY if found.neutral else STABLE if found.stable[0] else UNSTABLE
        low, high = (in_words(end, "N/m") for end in found.between)
        return [f"Steady sliding is {kind} on any spring k_x from {low} to {high}."]
    k_c = min(map(float, found.values), key=lambda each: abs(log(each / slider.k_x)))
    return [
        f"The spring has k_x = {slider.k_x / k_c:.3g} k_c: with all else as it is, the critical "
        f"stiffness k_c is {in_words(k_c, 'N/m')}."
    ]


def critical_section(slider: Slider, found: Sequence[Critical]) -> Section:
    """Return, for each parameter, the ranges in which steady sliding is stable or not."""
    own = {each.path: present_value(slider, each.path) for each in found}
    now = ", ".join(
        f"{each.path} = {in_words(own[each.path], each.unit, DIGITS)}"
        for each in found
        if isfinite(own[each.path])
    )
    rows = [row for each in found for row in stretch_rows(each, own[each.path])]
    headings = ("parameter", "from", "to", "steady sliding", "oscillation at the upper end")
    return Section("Where that changes", [f"Now: {now}."] if now else [], Table(headings, rows))


def stretch_rows(found: Critical, now: float) -> Iterator[tuple[str, ...]]:
    """Yield a row for each stretch of a parameter: ends, stability, oscillation at its end.

    The stretch that contains the value `now` is marked.
    """
    sets_in = [in_words(f, "Hz") if f > 0.0 else "none" for f in map(float, found.frequencies)]
    here = int(np.searchsorted(found.values, now, side="right"))
    here = here if found.between[0] <= now <= found.between[1] else -1
    for at, (*borders, stable) in enumerate(found.stretches):
        kind = BOUNDARY if found.neutral else STABLE if stable else UNSTABLE
        ends = (in_words(end, found.unit, DIGITS) for end in borders)
        mode = sets_in[at] if at < len(sets_in) else ""
        yield found.path if at == 0 else "", *ends, kind + " (now)" * (at == here), mode


FORMER = (
    "Critical",
    "Linearisation",
    "boundary",
    "critical",
    "growth_rate",
    "modes_over",
    "steady_sliding",
)
old_attributes(stability, {name: f"stiction.linear_stability.{name}" for name in FORMER})


def modes_over(
    slider: Slider | Description | str | Path,
    path: str,
    between: Sequence[Quantity] | None = None,
    *,
    points: int = 201,
) -> xr.Dataset:
    """Return growth rates and frequencies of all modes over a parameter.

    Parameters
    ----------
    slider : Slider, Description, str or Path
        The system, or the file of its description.
    path : str
        The parameter, see `critical`.
    between : tuple of float or str, optional
        Its range, see `critical`.
    points : int, optional
        Number of values.

    Returns
    -------
    Dataset
        Over ``value`` (the parameter, SI) and ``mode``: ``growth_rate`` (1/s) and ``frequency``
        (Hz). Modes are matched from value to value by linear extrapolation.

    Examples
    --------
    >>> import stiction as st
    >>> modes = st.linear_stability.modes_over(st.presets.nakano_popov_2020(), "phi", points=11)
    >>> dict(modes.sizes)
    {'value': 11, 'mode': 4}
    """
    slider = steadily_driven(slider_of(slider), path)
    along = axis(slider, path, between)
    fractions = np.linspace(0.0, 1.0, points)
    rows: list[Complex] = []
    for fraction in fractions:
        now = steady_sliding(along.on(slider, float(fraction))).eigenvalues
        rows.append(match_eigenvalues(rows, now))
    values = np.array([along.value(float(fraction)) for fraction in fractions])
    eigenvalues = np.array(rows)
    dims = ("value", "mode")
    return xr.Dataset(
        {
            "growth_rate": (dims, eigenvalues.real, {"units": "1/s", "long_name": "growth rate"}),
            "frequency": (
                dims,
                np.abs(eigenvalues.imag) / (2.0 * np.pi),
                {"units": "Hz", "long_name": "frequency"},
            ),
        },
        {"value": ("value", values, {"units": along.unit or "1", "long_name": along.path})},
        {"scale": "log" if along.logarithmic else "linear"},
    )


def match_eigenvalues(before: Sequence[Complex], now: Complex) -> Complex:
    """Order eigenvalues by the linear extrapolation of the preceding ones."""
    from scipy.optimize import linear_sum_assignment

    if not before:
        return now
    expected = before[-1] if len(before) < 2 else 2.0 * before[-1] - before[-2]
    cost = np.abs(expected[:, None] - now[None, :])
    order: Complex = now[linear_sum_assignment(cost)[1]]
    return order
