"""What an unstable steady sliding becomes: the amplitude of the oscillation, and how it sets in.

Beyond the boundary of stability (`stiction.linear_stability`) a limit cycle is left. It can grow
from zero (a soft onset: a supercritical Hopf bifurcation), or be there at once at full size (hard:
a subcritical one), and then it lasts, going back, where steady sliding is stable again: hysteresis.
Here it is found by simulation alone: a parameter is swept up and down, each run beginning where
the last one ended.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import inf, nan
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from stiction.analysis.limit_cycle import KICK, OSCILLATING, REST, UNDECIDED, Found, settled
from stiction.errors import DescriptionError, Fault
from stiction.linear_stability import steady_sliding
from stiction.parameter import changed, read, unit
from stiction.slider import Slider

if TYPE_CHECKING:
    import xarray as xr

Floats = NDArray[np.float64]


class Onset(NamedTuple):
    """How an oscillation sets in along a parameter.

    Parameters
    ----------
    kind : {"soft", "hard", "none"}
        Soft if both sweeps change between rest and oscillation at the same value, and the
        amplitude extrapolates to zero there; hard if not; none if nothing changes.
    threshold : float
        Of a soft onset: where the squared amplitude, which is linear in the parameter near a
        Hopf bifurcation, extrapolates to zero, SI; NaN otherwise.
    hysteresis : tuple of float
        First and last of the values (SI) at which one sweep rests and the other oscillates; NaN
        if there is none.
    data : Dataset
        Over ``sweep`` ("up", "down") and ``value`` (the parameter, SI): ``amplitude`` (m), half
        of the range of the spring's elongation along the drive; ``outcome`` (0 rest, 1
        oscillation, 2 undecided when the time was over). Over ``value``: ``growth_rate`` (1/s).
    """

    kind: Literal["soft", "hard", "none"]
    threshold: float
    hysteresis: tuple[float, float]
    data: xr.Dataset


def find_onset(
    slider: Slider,
    path: str,
    values: Sequence[float | str],
    *,
    most_blocks: int = 40,
    rtol: float = 1e-6,
) -> Onset:
    """Sweep a parameter up and down, and see where an oscillation is, how large, and since when.

    Parameters
    ----------
    slider : Slider
        With a steady drive and load. Any friction law.
    path : str
        The parameter, see `stiction.linear_stability.critical`.
    values : sequence of float or str
        Its values, ascending, with their units if it is an angle; from well on the stable side
        to well on the other.
    most_blocks : int, optional
        How long each run may last until its amplitude has settled. A block is ten periods of
        the leading mode, and the time in which the drive loads the spring with the friction.
    rtol : float, optional
        See `stiction.simulate`.

    Returns
    -------
    Onset
        The kind of onset, its hysteresis, and the amplitudes.

    Raises
    ------
    DescriptionError
        If the parameter cannot have these values, or they do not ascend.

    Notes
    -----
    A run that rests is disturbed by a hundredth of the drive's speed for the next value. It counts
    as resting when the amplitude has fallen to a third of that, as oscillating when it is above
    three times that and has not changed by more than 1 % over the later half of the time so far;
    else as undecided. Close to the boundary the changes are so slow that it remains so.
    """
    sliders = [changed(slider, path, value) for value in values]
    numbers = np.array([read(each, path) for each in sliders])
    if len(numbers) < 3 or not (np.diff(numbers) > 0).all():
        message = f"{len(numbers)} values to sweep through; give three or more that ascend"
        raise DescriptionError([Fault(path, message)])
    up = swept(sliders, most_blocks, rtol)
    down = swept(sliders[::-1], most_blocks, rtol)[::-1]
    amplitude = np.array([[found.amplitude for found in sweep] for sweep in (up, down)])
    outcome = np.array([[found.outcome for found in sweep] for sweep in (up, down)])
    growth = [steady_sliding(each).growth_rate for each in sliders]
    data = table(path, unit(slider, path), numbers, amplitude, outcome, np.array(growth))
    return judged(data)


def swept(sliders: Sequence[Slider], most_blocks: int, rtol: float) -> list[Found]:
    """Return what each slider comes to, beginning where the one before ended."""
    found: list[Found] = []
    for slider in sliders:
        moving = found and found[-1].outcome != REST
        start = found[-1].state if moving else steady_sliding(slider).disturbed(KICK)
        found.append(settled(slider, start, most_blocks, rtol))
    return found


def judged(data: xr.Dataset) -> Onset:
    """Return the kind of onset that the sweeps show."""
    values, outcome = data["value"].values, data["outcome"].values
    rests, moves = outcome == REST, outcome == OSCILLATING
    both = (rests[0] & moves[1]) | (moves[0] & rests[1])
    if both.any():
        between = float(values[both].min()), float(values[both].max())
        return Onset("hard", nan, between, data)
    if not (rests.any() and moves.any()):
        return Onset("none", nan, (nan, nan), data)
    threshold = vanishing(values, data["amplitude"].values[0], rests[0], moves[0])
    kind: Literal["soft", "hard"] = "hard" if np.isnan(threshold) else "soft"
    return Onset(kind, threshold, (nan, nan), data)


def vanishing(values: Floats, amplitude: Floats, rests: Floats, moves: Floats) -> float:
    """Return where the squared amplitude, extrapolated from the two values next to rest, is zero.

    NaN if that is not between rest and oscillation, give or take the distance of two values.
    """
    way = 1 if np.flatnonzero(rests)[0] < np.flatnonzero(moves)[0] else -1
    last = np.flatnonzero(rests)[::way][-1]
    beyond = [i for i in np.flatnonzero(moves)[::way] if (i - last) * way > 0][:2]
    if len(beyond) < 2:
        return nan
    first, second = beyond
    squares = amplitude[first] ** 2, amplitude[second] ** 2
    rise = (squares[1] - squares[0]) / (values[second] - values[first])
    found = float(values[first] - squares[0] / rise) if rise != 0.0 else inf
    spacing = abs(values[second] - values[first])
    inside = -spacing <= way * (found - values[last]) and way * (found - values[first]) <= 0.0
    return found if inside else nan


def table(
    path: str, unit: str, values: Floats, amplitude: Floats, outcome: Floats, growth: Floats
) -> xr.Dataset:
    """Return the sweeps as labelled arrays."""
    import xarray as xr

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
