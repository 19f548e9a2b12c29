"""The motion that a page draws: curves of the whole run or a window, and samples to animate."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import isfinite, isnan, nan
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from stiction import theory
from stiction.arrays import Floats
from stiction.drive.program import nominal_velocity
from stiction.errors import STATUSES, StictionError
from stiction.explorer.decimation import columns_of, extremes, share_stuck
from stiction.friction import ellipse
from stiction.friction.law import limit_coefficient
from stiction.linear_stability.linear import growth_rate
from stiction.result.peak import LARGER_FORCE, LARGEST_FORCE, largest_spring_force
from stiction.result.rest import rest_in_words
from stiction.result.table import (
    FASTER,
    FASTEST,
    ColumnTable,
    fastest_slip,
    sample_table,
)
from stiction.simulation import automatic_times, solve
from stiction.solver.integrate import Solution
from stiction.system.description import Description
from stiction.system.slider import Slider
from stiction.system.tensors import dampers_askew
from stiction.text.quantity.wording import in_words

CURVES = ("spring_x", "spring_y", "friction", "psi", "X", "V_X", "slip_speed", "v_y", "normal_load")
TRACK = ("u_x", "u_y", "slip_x", "slip_y", "friction", "theta", "X", "V_X", "normal_load")
PER_COLUMN = 16  # samples in a column of pixels while a slider moves
FEWEST_SAMPLES, MOST_SAMPLES = 4_000, 24_000  # samples of the whole run then
CLOSE = 4  # columns between two rests that look like one
IN_SLIP = 48  # samples in a slip between two rests
QUICK, EXACT = np.float32, np.float64  # numbers while a slider moves, and then
FINE_SAMPLES = 4_001  # samples under the microscope
DIGITS = 6  # of a number on the page
PEAK_DIGITS = 4  # of a force between two samples, as on the command line
Window = tuple[float, float]
Check = Callable[[], None]  # raises if nobody waits for the answer any more
Arrays = dict[str, np.ndarray]
Reply = tuple[dict[str, Any], Arrays]


class Drawn(NamedTuple):
    """A run that was sampled for a picture."""

    solution: Solution
    table: ColumnTable
    animated: np.ndarray | None  # times at which the apparatus is animated, s; None: as before
    quick: bool  # whether a better picture follows


def simulate(
    description: Description, times: np.ndarray, check: Check
) -> tuple[Solution, ColumnTable]:
    """Return a run sampled at `times` (s); `check` may end it."""
    solution = solve(description, times, progress=lambda _: check())
    return solution, sample_table(description, solution.times, solution.samples, {})


def span(description: Description) -> Window:
    """Return start and end of a run, s."""
    start = description.initial.time
    return start, start + description.run.duration


def window_of(description: Description, wanted: Any) -> Window:
    """Return the part of a run that a page shows, s: all of it, unless it asks for less."""
    start, end = span(description)
    if not wanted:
        return start, end
    low, high = (min(max(float(each), start), end) for each in wanted)
    return (low, high) if high - low > 1e-12 * (end - start) else (start, end)


def pictures(whole: np.ndarray, window: Window, columns: int) -> list[np.ndarray]:
    """Return the times of two pictures of a window, s: a quick one, then one that misses no peak.

    The second has the samples that `stiction.simulate` chooses by itself, `whole`; if the first has
    more, it has these too, and is the only one.
    """
    low, high = window
    there = whole[(whole >= low) & (whole <= high)]
    quick = min(max(PER_COLUMN * columns, FEWEST_SAMPLES), MOST_SAMPLES)
    if len(there) > quick:
        return [np.linspace(low, high, quick), there]
    return [np.union1d(there, np.linspace(low, high, quick))]


def draw(
    description: Description, window: Window, columns: int, check: Check
) -> Iterator[tuple[Drawn, Arrays]]:
    """Yield a run for a picture of a window, and its curves: quick, then with every peak."""
    first, *more = pictures(automatic_times(description), window, columns)
    solution, table = simulate(description, first, check)
    within = slip_times(during(solution.sticks, window), first)
    moving = np.union1d(first, within)  # times at which the apparatus is animated
    later = [np.union1d(each, moving) for each in more]
    if len(within) and not later:
        later = [moving]
    for number, times in enumerate([first, *later]):
        if number > 0:
            solution, table = simulate(description, times, check)
        animated = moving if number == 0 or len(within) else None
        drawn = Drawn(solution, table, animated, number < len(later))
        yield drawn, curves(table, solution.sticks, window, columns)


def run(description: Description, columns: int, check: Check) -> Iterator[Reply]:
    """Yield the whole run twice: at once as far as the page needs it, then with every peak."""
    window, whole = span(description), automatic_times(description)
    for (solution, table, animated, quick), drawn in draw(description, window, columns, check):
        head = {
            **about(description, solution, table),
            "facts": facts(description, solution, table, None if quick else whole),
            "window": window,
            "quick": quick,
        }
        if animated is not None:
            chosen = np.isin(table["time"], animated)
            drawn |= track(table, chosen, QUICK if quick else EXACT)
        yield head, drawn


def zoom(description: Description, window: Window, columns: int, check: Check) -> Iterator[Reply]:
    """Yield the curves of a window."""
    for part, drawn in draw(description, window, columns, check):
        yield {"window": window, "quick": part.quick}, drawn


def during(sticks: np.ndarray, window: Window) -> np.ndarray:
    """Return the stick intervals (n, 2) between which the slips of a window lie, s.

    Examples
    --------
    >>> during(np.array([[0.0, 1.0], [2.0, 3.0], [4.0, 5.0], [6.0, 7.0]]), (3.5, 4.5))
    array([[2., 3.],
           [4., 5.]])
    """
    low, high = window
    first = int(np.searchsorted(sticks[:, 0], low, side="right")) - 1
    last = int(np.searchsorted(sticks[:, 1], high, side="left"))
    return sticks[max(first, 0) : last + 1]


def slip_times(sticks: np.ndarray, times: np.ndarray) -> np.ndarray:
    """Return times (s) within slips between two rests that hold few of `times`.

    Examples
    --------
    >>> slip_times(np.array([[0.0, 1.0], [1.5, 2.0]]), np.array([0.0, 2.0]))[[0, -1]].tolist()
    [1.0, 1.5]
    """
    starts, ends = sticks[:-1, 1], sticks[1:, 0]
    held = np.searchsorted(times, ends) - np.searchsorted(times, starts)
    short = (held < IN_SLIP) & (ends > starts)
    starts, ends = starts[short], ends[short]
    longest = np.argsort(starts - ends, kind="stable")
    full = MOST_SAMPLES // IN_SLIP
    if len(longest) > full:  # half of the samples for rapid slips, among thousands in creep
        full //= 2
    rest = longest[full:]
    few = min(MOST_SAMPLES // (2 * max(len(rest), 1)), IN_SLIP)
    parts = ((longest[:full], IN_SLIP), (rest, few))
    return np.unique(np.concatenate([within(starts[p], ends[p], count) for p, count in parts]))


def within(starts: np.ndarray, ends: np.ndarray, count: int) -> np.ndarray:
    """Return `count` times in each slip, s; none if these are too few to show it.

    They are closer at both ends: a slip that begins with a step of the drive is fastest there.
    """
    if count < 3:
        return np.zeros(0)
    share = 0.5 - 0.5 * np.cos(np.linspace(0.0, np.pi, count))[:, None]
    times: Floats = starts + share * (ends - starts)
    return times.ravel()


def fine(description: Description, time: float, width: float, check: Check) -> Iterator[Reply]:
    """Yield the samples under the microscope: a window about a time, and the sample at the time."""
    start, end = span(description)
    time, width = min(max(time, start), end), min(width, end - start)
    low = min(max(time - 0.5 * width, start), end - width)
    grid = np.linspace(low, low + width, FINE_SAMPLES)
    _, table = simulate(description, np.unique(np.append(grid, time)), check)
    at = int(np.searchsorted(table["time"], time).clip(0, len(table["time"]) - 1))
    names = ("time", *TRACK, "sticking", "v_x", "v_y", "psi", "spring_x", "spring_y")
    values = {name: float(table[name][at]) for name in names}
    yield {"at": values, "window": (low, low + width)}, as_track(table)


def curves(table: ColumnTable, sticks: np.ndarray, window: Window, columns: int) -> Arrays:
    """Return each curve as first, lowest, highest and last value of each column of pixels."""
    places, starts = columns_of(table["time"], window, columns)
    found: Arrays = {name: extremes(table[name], starts) for name in CURVES}
    stuck = share_stuck(sticks, window, columns)
    # rest may fall between two samples; those that happen to be near it would show beats
    found["slip_speed"][dense(stuck > 0.0)[places], 1] = 0.0
    return {"column": places.astype(np.float32), **found, "stuck": stuck}


def dense(rests: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return which columns hold rest, or lie between two that do so closely that they look so.

    Rests as frequent as columns would beat with them.

    Examples
    --------
    >>> dense(np.array([True, False, True, False, False, False, False, True])).tolist()
    [True, True, True, False, False, False, False, True]
    """
    at = np.flatnonzero(rests)
    places = np.arange(len(rests))
    if len(at) < 2:
        return rests
    after = np.searchsorted(at, places).clip(1, len(at) - 1)
    between = (places > at[after - 1]) & (places < at[after])
    close = at[after] - at[after - 1] <= CLOSE
    return np.asarray(rests | (between & close), np.bool_)


def track(table: ColumnTable, chosen: NDArray[np.bool_], kind: type[np.floating[Any]]) -> Arrays:
    """Return the chosen samples, with which the apparatus is animated, as numbers of a kind."""
    samples = as_track(table)
    time = samples.pop("time")[chosen]
    drawn = {f"track_{name}": values[chosen].astype(kind) for name, values in samples.items()}
    return {"track_time": time, **drawn}


def as_track(table: ColumnTable) -> Arrays:
    """Return time, motion and forces sample by sample."""
    samples = {name: table[name] for name in ("time", *TRACK, "v_x", "v_y")}
    return {**samples, "sticking": table["sticking"]}


def about(description: Description, solution: Solution, table: ColumnTable) -> dict[str, Any]:
    """Return the text beside the curves, and the data for drawing."""
    slider = description.slider
    status = STATUSES[solution.code]
    velocity = nominal_velocity(slider.motion)
    return {
        "ok": status.ok,
        "status": status.value,
        "rested": rest_in_words(slider, table, solution.counts.steps) if status.ok else "",
        "scene": {
            "phi": slider.misalignment,
            "limit": limit_coefficient(slider.law, table["friction"], table["normal_load"]),
            "ellipse": ellipse(slider.law),
            "k": (slider.k_x, slider.k_y),
            "velocity": velocity,
            "damping": theory.damping_number_of(slider, velocity),
            "frequencies": slider.natural_frequencies,
            "dampers": [*dampers_askew(slider).items()],
            "driven": slider.driven,
        },
    }


def facts(
    description: Description, solution: Solution, table: ColumnTable, times: np.ndarray | None
) -> list[dict[str, Any]]:
    """Return the numbers of a run: name, value in SI and as text.

    The largest force is that at `times`, as `simulate` has it; the fastest slip is that of all
    samples, which hold slips between two of these.
    """
    reached, slider = table["time"], description.slider
    counted = np.full(len(reached), True) if times is None else np.isin(reached, times)
    counted[-1] = True  # where it ended
    counts = solution.counts
    seen = {name: table[name][counted] for name in ("time", "u_x", "v_x")}
    peak, (fastest, shown) = largest_spring_force(seen, slider.k_x), fastest_slip(table)
    slow, fast = slider.natural_frequencies
    A = theory.damping_number_of(slider, nominal_velocity(slider.motion))
    duration = float(solution.times[-1] - solution.times[0]) or 1.0
    listed: list[tuple[str, float, str]] = [
        (LARGEST_FORCE if peak.shown else LARGER_FORCE, peak.force, "N"),
        ("  at", peak.time, "s"),
        (FASTEST if shown else FASTER, fastest, "m/s"),
        ("u_x at the end", float(table["u_x"][-1]), "m"),
        ("u_y at the end", float(table["u_y"][-1]), "m"),
        ("stick intervals", float(counts.sticks), "1"),
        ("time at rest", float(counts.stuck), "s"),
        ("share at rest", 100.0 * float(counts.stuck) / duration, "%"),
        ("damping number A", A, "1"),
        ("slow, natural", slow, "Hz"),
        ("fast, natural", fast, "Hz"),
        ("solver's steps", float(counts.steps), "1"),
    ]
    return [
        {"name": name, "value": value, "unit": unit, "text": text_of(value, unit)}
        for name, value, unit in listed
    ] + [steady_sliding(slider)]


def steady_sliding(slider: Slider) -> dict[str, Any]:
    """Return whether steady sliding is stable, by the growth rate of a small disturbance."""
    try:
        growth = growth_rate(slider)
    except StictionError:
        growth = nan
    words = "there is none" if isnan(growth) else "unstable" if growth > 0.0 else "stable"
    return {"name": "steady sliding", "value": growth, "unit": "1/s", "text": words}


def text_of(value: float, unit: str) -> str:
    """Return a number as text; a count in full."""
    if unit == "1" and value == int(value if isfinite(value) else 0) and isfinite(value):
        return f"{int(value)}"
    if unit == "%":
        return f"{value:.4g} %"
    return in_words(value, unit, PEAK_DIGITS if unit == "N" else DIGITS)
