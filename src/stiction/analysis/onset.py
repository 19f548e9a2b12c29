"""The oscillation that replaces unstable steady sliding: its amplitude and its onset.

Beyond the boundary of stability (`stiction.linear_stability`) there is a limit cycle. It can grow
from zero (soft onset: a supercritical Hopf bifurcation), or appear at full size (hard onset: a
subcritical one) and then persist, on the way back, where steady sliding is stable again
(hysteresis). This module uses simulations only: it sweeps a parameter up and down, and starts each
run where the last one ended.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise, takewhile
from math import isnan, nan
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np

from stiction.analysis.limit_cycle import KICK, OSCILLATING, REST, UNDECIDED, Found, settle
from stiction.arrays import Floats, xr
from stiction.errors import DescriptionError
from stiction.linear_stability import steady_sliding
from stiction.names import draw
from stiction.system.description import Description
from stiction.system.parameter import change_parameter, change_unchecked, read, unit
from stiction.system.slider import Slider, slider_of
from stiction.text.quantity.wording import with_error
from stiction.text.units import Quantities

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Kind = Literal["soft", "hard", "not determined", "none"]

MOST_ADDED = 14  # values near the onset, beside those given
SHARP = 0.01  # of the least distance of two given values: so uncertain the onset may be
APART = 1.4  # ratio of squared amplitudes, which have errors of 2 %
FAR = 8.0  # times the nearest squared amplitude: beyond, the next says nothing of it
ALIKE_SLOPES = 3.0  # ratio of two slopes of the squared amplitude: beyond, it is far from linear
OPEN = 0.3  # of an end of hysteresis: so wide a gap between undecided points is tried
ROUGH = 0.05  # of the distance to the nearest oscillation: an error of 1 % in two amplitudes


class Onset(NamedTuple):
    """The onset of an oscillation along a parameter.

    Parameters
    ----------
    kind : {"soft", "hard", "not determined", "none"}
        Soft if runs that start at rest and runs that start oscillating change at the same value,
        where the amplitude goes to zero; hard if at some value one rests and the other
        oscillates; not determined if neither is seen; none if nothing changes.
    threshold : float
        Value of the parameter at the onset, SI. For a soft onset, the zero of the extrapolated
        squared amplitude, which is linear near a Hopf bifurcation; if not determined, the middle
        of the interval that contains the onset; otherwise NaN.
    hysteresis : tuple of float
        Ends of the range of values (SI) in which one sweep rests and the other oscillates: the
        middles between a value inside and one outside; NaN if there is none.
    data : Dataset
        Over ``sweep`` ("up", "down") and ``value`` (the parameter, SI; those given and those
        added near the onset): ``amplitude`` (m), half of the range of the spring's elongation
        along the drive; ``outcome`` (0 rest, 1 oscillation, 2 undecided when the time was over).
        Over ``value``: ``growth_rate`` (1/s).
    uncertainty : float
        Uncertainty of `threshold`, SI.
    hysteresis_uncertainty : tuple of float
        Half the distance of the two values at each end, SI; NaN where the given values have none
        outside.
    """

    kind: Kind
    threshold: float
    hysteresis: tuple[float, float]
    data: xr.Dataset
    uncertainty: float = nan
    hysteresis_uncertainty: tuple[float, float] = (nan, nan)

    def __repr__(self) -> str:
        """Return a one-line summary."""
        along = self.data["value"].attrs
        unit, said = along["units"], ""
        if self.kind == "hard":
            # where the sweep ends before, the end of hysteresis is not known
            beyond = (" or less", " or more")
            ends = zip(self.hysteresis, self.hysteresis_uncertainty, beyond, strict=True)
            said = ", hysteresis from {} to {}".format(
                *(
                    with_error(value, error, unit) + more * isnan(error)
                    for value, error, more in ends
                )
            )
        elif not isnan(self.threshold):
            said = f" at {with_error(self.threshold, self.uncertainty, unit)}"
        return f"<Onset along {along['long_name']}: {self.kind}{said}>"

    def plot(self, ax: Any = None) -> Axes:
        """Draw both sweeps; see `stiction.plotting.plot_onset`."""
        drawn: Axes = draw("plot_onset", self, None, ax)
        return drawn


class SweepPoint(NamedTuple):
    """The results at one value of the parameter, swept up and swept down."""

    value: float
    up: Found
    down: Found

    @property
    def rests(self) -> bool:
        """Whether both rest."""
        return self.up.outcome == REST and self.down.outcome == REST

    @property
    def moves(self) -> bool:
        """Whether both oscillate."""
        return self.up.outcome == OSCILLATING and self.down.outcome == OSCILLATING

    @property
    def oscillations(self) -> list[Found]:
        """Those that oscillate."""
        return [each for each in (self.up, self.down) if each.outcome == OSCILLATING]

    @property
    def differs(self) -> bool:
        """Whether one rests and the other oscillates."""
        return {self.up.outcome, self.down.outcome} == {REST, OSCILLATING}


class OnsetEstimate(NamedTuple):
    """A threshold, its uncertainty, and whether the amplitude goes to zero there."""

    threshold: float
    uncertainty: float
    soft: bool


def find_onset(
    slider: Slider | Description | str | Path,
    path: str,
    values: Quantities,
    *,
    most_blocks: int = 40,
    rtol: float = 1e-6,
) -> Onset:
    """Sweep a parameter up and down to find the onset and amplitude of an oscillation.

    Parameters
    ----------
    slider : Slider, Description, str or Path
        With a steady drive and load, and any friction law; or the file of a description.
    path : str
        The parameter, see `stiction.linear_stability.critical`.
    values : sequence of float or str
        Its values, ascending, with their units if it is an angle; from well inside the stable
        side to well inside the other. More values are added near the onset.
    most_blocks : int, optional
        Longest duration of each run, in blocks. A block is ten periods of the leading mode plus
        the time in which the drive loads the spring to the friction force.
    rtol : float, optional
        See `stiction.simulate`.

    Returns
    -------
    Onset
        The kind of onset, its threshold and hysteresis, and the amplitudes.

    Raises
    ------
    DescriptionError
        If the parameter cannot have these values, or they do not ascend.

    Notes
    -----
    A resting run is disturbed by a hundredth of the drive's speed for the next value. A run counts
    as resting when its amplitude has fallen to a third of that. It counts as oscillating when its
    amplitude is above three times that, and has changed by at most 1 % over the later half of the
    time, in which a small disturbance would have changed by three times as much. Otherwise it is
    undecided, as happens close to the boundary, where changes are slow.

    Examples
    --------
    >>> import stiction as st
    >>> slider = st.presets.veraszto_stepan().slider
    >>> found = st.analysis.find_onset(slider, "drive.velocity", [0.16, 0.2, 0.24])
    >>> found.kind
    'hard'
    """
    slider = slider_of(slider)
    sliders = [change_parameter(slider, path, value) for value in values]
    numbers = np.array([read(each, path) for each in sliders])
    if len(numbers) < 3 or not (np.diff(numbers) > 0).all():
        message = f"{len(numbers)} values to sweep through; give three or more that ascend"
        raise DescriptionError.of(path, message)
    up = sweep_sliders(sliders, most_blocks, rtol)
    down = sweep_sliders(sliders[::-1], most_blocks, rtol)[::-1]
    points = [SweepPoint(*each) for each in zip(map(float, numbers), up, down, strict=True)]
    fine = SHARP * float(np.diff(numbers).min())
    for _ in range(MOST_ADDED):
        value = next_value(points, fine)
        if value is None:
            break
        at = change_unchecked(slider, path, value)
        points.append(try_value(at, value, points, most_blocks, rtol))
        points.sort(key=lambda each: each.value)
    growth = [
        steady_sliding(change_unchecked(slider, path, each.value)).growth_rate for each in points
    ]
    return judge_points(points, table(path, unit(slider, path), points, np.array(growth)))


def sweep_sliders(sliders: Sequence[Slider], most_blocks: int, rtol: float) -> list[Found]:
    """Return the result of each slider, each run starting where the last one ended."""
    found: list[Found] = []
    for slider in sliders:
        moving = found and found[-1].outcome != REST
        start = found[-1].state if moving else steady_sliding(slider).disturbed_start(KICK)
        found.append(settle(slider, start, most_blocks, rtol))
    return found


def try_value(
    slider: Slider, value: float, points: Sequence[SweepPoint], most_blocks: int, rtol: float
) -> SweepPoint:
    """Return the results from rest, and from the oscillation at the nearest value."""

    def distance(each: SweepPoint) -> float:
        return abs(each.value - value)

    rest = steady_sliding(slider).disturbed_start(KICK)
    last = min((each for each in points if each.oscillations), key=distance).oscillations[0].state
    found = [settle(slider, start, most_blocks, rtol) for start in (rest, last)]
    moving = min((each for each in points if each.moves), key=distance)
    upward = moving.value < value  # an upward sweep comes from lower values
    return SweepPoint(value, *(found[::-1] if upward else found))


def change(points: Sequence[SweepPoint]) -> tuple[SweepPoint, list[SweepPoint]] | None:
    """Return the rest beside the first change, and the oscillations beyond it, nearest first."""
    known = [each for each in points if each.rests or each.moves]
    for one, other in pairwise(known):
        if one.rests and other.moves:
            return one, list(takewhile(lambda each: each.moves, known[known.index(other) :]))
        if one.moves and other.rests:
            before = known[: known.index(other)][::-1]
            return other, list(takewhile(lambda each: each.moves, before))
    return None


def next_value(points: Sequence[SweepPoint], fine: float) -> float | None:
    """Return the most informative value for another point, or None.

    Between rest and oscillation, where points are decided, it is in the middle, or, once the onset
    is known, to either side of it. Where they are undecided, it lies among the next oscillations.
    Where there is hysteresis, it is in the middle of the wider of its two ends.
    """
    if any(each.differs for each in points):
        return within(hysteresis_ends(points), points, fine)
    found = change(points)
    if found is None:
        return None
    rest, moving = found
    first, estimate = moving[0].value, extrapolate_onset(rest, moving)
    low, high = sorted((rest.value, first))
    unsure = [each.value for each in points if low < each.value < high]
    limit = min(unsure, key=lambda value: abs(value - first)) if unsure else rest.value
    if estimate.soft and estimate.uncertainty < fine:
        return None
    if estimate.soft and not unsure:
        at = estimate.threshold
        far = first if abs(first - at) >= abs(rest.value - at) else rest.value
        return at + (far - at) / 3.0
    if not unsure:
        return 0.5 * (first + limit) if high - low > 0.1 * fine else None
    if estimate.soft:
        return 0.5 * (first + limit) if abs(limit - first) > 0.3 * (high - low) else None
    known = {each.value for each in points}
    middles = (0.5 * (one.value + other.value) for one, other in pairwise(apart(moving)))
    return next((each for each in middles if each not in known), None)


def hysteresis_ends(points: Sequence[SweepPoint]) -> list[tuple[float, float]]:
    """Return the values outside and inside both ends of hysteresis; NaN outside if there is none.

    Between them are at most undecided points.
    """
    inside = [each.value for each in points if each.differs]
    outside = [each.value for each in points if each.rests or each.moves]
    below = (value for value in reversed(outside) if value < inside[0])
    above = (value for value in outside if value > inside[-1])
    return [(next(below, nan), inside[0]), (next(above, nan), inside[-1])]


def within(
    ends: Sequence[tuple[float, float]], points: Sequence[SweepPoint], fine: float
) -> float | None:
    """Return a value inside the widest end that is not known well, in its widest gap.

    Undecided points leave gaps; where they fill an end, it cannot be known better.
    """
    found: list[tuple[float, float]] = []
    for end in ends:
        low, high = sorted(end)
        if not high - low > fine:
            continue
        values = [low, *(each.value for each in points if low < each.value < high), high]
        gap, middle = max((two - one, 0.5 * (one + two)) for one, two in pairwise(values))
        if gap > OPEN * (high - low):
            found.append((high - low, middle))
    return max(found)[1] if found else None


def apart(moving: Sequence[SweepPoint]) -> list[SweepPoint]:
    """Return up to three distinct oscillations, the nearest first."""
    found = [moving[0]]
    for each in moving:
        if len(found) < 3 and size(each) ** 2 > APART * size(found[-1]) ** 2:
            found.append(each)
    return found


def size(point: SweepPoint) -> float:
    """Return the amplitude of an oscillation, the mean of both sweeps (m)."""
    return 0.5 * (point.up.amplitude + point.down.amplitude)


def extrapolate_onset(rest: SweepPoint, moving: Sequence[SweepPoint]) -> OnsetEstimate:
    """Extrapolate the squared amplitude to zero by a parabola through three values.

    Its uncertainty is the difference from a straight line through two of them, plus the effect of
    an error of 1 % in an amplitude. The extrapolation is rejected if it does not lie between rest
    and oscillation, or if the slopes on both sides of the middle value differ too much.
    """
    first = moving[0].value
    middle, half = 0.5 * (rest.value + first), 0.5 * abs(first - rest.value)
    unknown = OnsetEstimate(middle, half, soft=False)
    three = apart(moving)
    if len(three) < 3:
        return unknown
    x = np.array([each.value - first for each in three])
    squares = np.array([size(each) ** 2 for each in three])
    if squares[1] > FAR * squares[0]:
        return unknown
    slope = (squares[1] - squares[0]) / x[1]
    beyond = (squares[2] - squares[1]) / (x[2] - x[1])
    bend = (beyond - slope) / x[2]
    if slope * x[1] <= 0.0 or not 1.0 / ALIKE_SLOPES < beyond / slope < ALIKE_SLOPES:
        return unknown
    straight = -squares[0] / slope
    # the parabola through all three: squares[0] + b x + bend x^2
    b = slope - bend * x[1]
    root = b * b - 4.0 * bend * squares[0]
    if root < 0.0 or b * slope <= 0.0:
        return unknown
    curved = -2.0 * squares[0] / (b + np.copysign(np.sqrt(root), b))
    uncertainty = float(abs(curved - straight) + ROUGH * abs(curved))
    reach = rest.value - first
    if not 0.0 <= curved / reach <= 1.0 or uncertainty > half:
        return unknown
    return OnsetEstimate(float(first + curved), uncertainty, soft=True)


def judge_points(points: Sequence[SweepPoint], data: xr.Dataset) -> Onset:
    """Return the onset seen in the points."""
    if any(each.differs for each in points):
        low, high = hysteresis_ends(points)
        middles = [inner if isnan(outer) else 0.5 * (outer + inner) for outer, inner in (low, high)]
        halves = [0.5 * abs(outer - inner) for outer, inner in (low, high)]
        return Onset("hard", nan, (middles[0], middles[1]), data, nan, (halves[0], halves[1]))
    found = change(points)
    if found is None:
        alike = all(each.rests for each in points) or all(each.moves for each in points)
        return Onset("none" if alike else "not determined", nan, (nan, nan), data)
    estimate = extrapolate_onset(*found)
    kind: Kind = "soft" if estimate.soft else "not determined"
    return Onset(kind, estimate.threshold, (nan, nan), data, estimate.uncertainty)


def table(path: str, unit: str, points: Sequence[SweepPoint], growth: Floats) -> xr.Dataset:
    """Return the sweeps as labelled arrays."""
    values = np.array([each.value for each in points])
    sweeps = [[each.up for each in points], [each.down for each in points]]
    amplitude = np.array([[found.amplitude for found in sweep] for sweep in sweeps])
    outcome = np.array([[found.outcome for found in sweep] for sweep in sweeps])

    along = {"units": "m", "long_name": "amplitude of the elongation along the drive"}
    meanings = {"flag_values": [REST, OSCILLATING, UNDECIDED]}
    rate = {"units": "1/s", "long_name": "growth rate of a small disturbance"}
    return xr.Dataset(
        {
            "amplitude": (("sweep", "value"), amplitude, along),
            "outcome": (
                ("sweep", "value"),
                outcome.astype(np.int8),
                {**meanings, "flag_meanings": "rest oscillating undecided"},
            ),
            "growth_rate": ("value", growth, rate),
        },
        {
            "sweep": ["up", "down"],
            "value": ("value", values, {"units": unit or "1", "long_name": path}),
        },
    )
