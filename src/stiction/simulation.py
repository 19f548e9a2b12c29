"""simulate(slider, duration, ...): run a system, get a Trajectory."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from math import ceil
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from stiction.arguments import end_reading, read_together
from stiction.arrays import Floats
from stiction.errors import STATUSES, DescriptionError, Fault, Faults, Status
from stiction.friction import has_state, states
from stiction.progress.audience import with_progress
from stiction.result.file import SHORTEST
from stiction.result.table import VARIABLES, ColumnTable, sample_table
from stiction.solver.accuracy import tolerance
from stiction.solver.compilation.refusal import REFUSED, reasons
from stiction.solver.integrate import BUDGET, Room, Solution, integrate
from stiction.storage.version import own_version
from stiction.system.description import STAND_IN, Description, description_of, system_and_start
from stiction.system.initial import Initial
from stiction.system.slider import Slider
from stiction.text.quantity.wording import in_words
from stiction.text.samples import as_numbers, samples_to_si
from stiction.text.units import TIME, Quantity, unit_on
from stiction.trajectory import Statistics, Trajectory

PAPERS = Initial()
MOST_STEPS = 100_000_000
TIME_ROUNDING = 1e-12  # of a duration: a time that is nearer to the end is the end


@read_together
@with_progress("simulating")
def simulate(
    slider: Slider | Description | str | Path,
    duration: Quantity | None = None,
    *,
    sample_rate: Quantity | None = None,
    times: ArrayLike | None = None,
    rtol: float = 1e-6,
    initial: Initial | None = None,
    regularisation: Quantity | None = None,
    multiscale: bool | Literal["auto"] = "auto",
    max_steps: int = MOST_STEPS,
    progress: Callable[[float], None] | None = None,
) -> Trajectory:
    """Simulate a slider, with set-valued friction at zero slip, exactly up to `rtol`.

    Laws with internal state have a friction force at zero slip as well and need no such rule;
    they never stick in the strict sense.

    Parameters
    ----------
    slider : Slider, Description, str or Path
        The system. Of a description, or its file, this is its slider, which starts from its initial
        state; its settings count in `run`, and here the arguments do.
    duration : float or str, optional
        How long to simulate, s; until the programs of drive and load end, if they do.
    sample_rate : float or str, optional
        Output samples per second, at start, start + 1/rate, ... as far as the end, which is
        one if it falls on it; 0 for the first and last state only. By default 20 in each period of
        the faster natural oscillation, while these are no more than 200 000; then so many, but at
        least 32 in each period of the slower natural oscillation, and 20 in each period by
        which drive or load vary, up to a million in all; and 1000 in the shortest run. With
        ``multiscale=True`` the first and last state only. Samples never influence the steps, and
        stick intervals are all recorded anyway.
    times : array_like, optional
        Times to sample at in place of a rate, (n,), s, ascending, from the start to the end: those
        of a measurement, or at which another solver stops. Without a duration the last of them is
        the end. A description does not hold them.
    rtol : float, optional
        Relative tolerance, 1e-13 to 1e-2. The measure of the error is how much the forces change if
        the mass, or the normal load, is greater by 0.8 rtol^0.8 (1.3e-5 at the default): they are
        off by no more than 30 times that, but for a few random systems. See "How right it is" in
        the documentation (docs/explanation/how-right.md).
    initial : Initial, optional
        The state to start from; by default that of a description, or the paper's.
    regularisation : float or str, optional
        delta (m/s, at least 1e-11): replace the set-valued law by
        ``F s/sqrt(|s|^2 + delta^2)``.
        For comparison; choose it far below the creep velocity V sin^2 phi. Not for laws with
        internal state, which are smooth by themselves.
    multiscale : {"auto", True, False}, optional
        Whether to take many cycles of stick and slip at once. With set-valued friction and a steady
        drive and load, all that follows the end of a stick depends on one angle; few cycles are
        solved, others interpolated, which is checked by fresh cycles to 0.03 rtol, and what does
        not agree is solved in steps, as is everything else. Every stick is recorded. Samples
        inside such cycles are interpolated too, to 0.3 rtol or to what the steps of the cycles
        solved are held to. By default this is tried where many cycles are left, and only as long
        as it saves steps; the promise for the error is that of `rtol`. With True it is tried
        everywhere, from the first stick on; steps are then held to 0.3 of the tolerance, and the
        promise is 9 times in place of 30 for a run with cycles that were interpolated.
    max_steps : int, optional
        Give up after so many steps; cycles that are interpolated take none.
    progress : callable, optional
        Called with the fraction done, about 20 times a second; without it, a terminal or a
        notebook shows a bar or lines where a run takes long.

    Returns
    -------
    Trajectory
        Whatever happens; ``run.status`` says how the run ended.

    Raises
    ------
    DescriptionError
        For arguments that cannot be simulated.

    Examples
    --------
    >>> import stiction as st
    >>> run = st.simulate(st.presets.nakano_popov_2020(), duration=0.02, sample_rate=1e3)
    >>> f"{float(run.sticks['stick_end'][0]) * 1e3:.4f} ms"
    '11.4595 ms'
    >>> run = st.simulate(st.presets.nakano_popov_2020(), times=[0.0, 0.003, 0.02])
    >>> run.samples["time"]
    array([0.   , 0.003, 0.02 ])
    """
    faults = Faults()
    described = not isinstance(slider, Slider)
    slider, initial = system_and_start(slider, initial)
    with faults.of_part():
        if described and isinstance(slider, Slider) and duration is None and times is None:
            remedy = "say how long, as in '5 s'; st.run takes that of a description"
            raise DescriptionError.of("duration", f"is missing; {remedy}")
    with faults.of_part():
        if times is not None and sample_rate is not None:
            raise DescriptionError.of("times", "take the place of sample_rate; give one of the two")
    with faults.of_part():
        if duration is None and times is not None:
            duration = STAND_IN  # beside a fault of the times
            duration = time_to_last(times, initial if isinstance(initial, Initial) else PAPERS)
    given: dict[str, Any] = {
        "sample_rate": sample_rate,
        "rtol": rtol,
        "regularisation": regularisation,
        "multiscale": multiscale,
    }
    stated = {name: value for name, value in given.items() if value is not None}
    with faults.of_part():
        description = Description.of(slider, duration, initial=initial, **stated)  # type: ignore[arg-type]
    faults.refuse()
    return run(description, times=times, max_steps=max_steps, progress=progress)


@read_together
@with_progress("simulating")
def run(
    description: Description | str | Path,
    *,
    times: ArrayLike | None = None,
    max_steps: int = MOST_STEPS,
    progress: Callable[[float], None] | None = None,
) -> Trajectory:
    """Simulate a whole description: slider, start and settings; see `simulate`.

    Parameters
    ----------
    description : Description, str or Path
        What is run, or its file.
    times, max_steps, progress
        As of `simulate`; times take the place of the description's sample rate.

    Returns
    -------
    Trajectory
        Whatever happens; ``run.status`` says how the run ended.

    Raises
    ------
    DescriptionError
        If the description cannot be read or simulated.

    Examples
    --------
    >>> import stiction as st
    >>> st.run(st.presets.leine_belt()).status.ok
    True
    """
    description = description_of(description)
    end_reading()
    at = times_of(description) if times is None else own_times(description, times)
    return trajectory_of(
        description, solve(description, at, max_steps=max_steps, progress=progress)
    )


def trajectory_of(description: Description, solution: Solution) -> Trajectory:
    """Return a solution with its labels."""
    status, statistics = STATUSES[solution.code], Statistics(*solution.counts)
    arrays = partial(label, description, solution, status, statistics)
    return Trajectory(description, arrays, solution.sticks, status, statistics)


def label(
    description: Description, solution: Solution, status: Status, statistics: Statistics
) -> ColumnTable:
    """Return the results of a run as named arrays, with its statistics."""
    attributes = {
        "stiction_version": own_version(),
        "solver": f"{kind(description)}{', multiscale' if statistics.mapped else ''}, Radau IIA 5",
        "status": status.name,
        "status_message": status.value,
        **vars(statistics),
    }
    return sample_table(description, solution.times, solution.samples, attributes)


def solve(
    description: Description,
    times: np.ndarray,
    *,
    max_steps: int = MOST_STEPS,
    progress: Callable[[float], None] | None = None,
    inside: float = 0.0,
    pause: int = BUDGET,
    room: Room = np.empty,
) -> Solution:
    """Integrate a description sampled at `times` (ascending, s): `run` without the labels.

    `inside` is the relative error of the slip that samples inside steps may have; `progress` is
    told of the time after so many steps, `pause`; `room` makes the array of samples.

    Raises
    ------
    DescriptionError
        If it cannot be simulated.
    """
    _, initial, settings = description
    if settings.regularisation is not None and has_state(description.slider.law):
        message = "the law is smooth at zero slip by itself; leave regularisation out"
        raise DescriptionError.of("run.regularisation", message)
    initial.internal(description.slider)  # or say what is wrong with it
    clashing = [state.name for state in states(description.slider.law) if state.name in VARIABLES]
    if clashing:
        message = f"has internal states {', '.join(clashing)}, which are taken in results; rename"
        raise DescriptionError.of("friction.law", message)
    if initial.time + settings.duration == initial.time:
        message = f"is below the resolution of time at t = {initial.time:g} s; start earlier"
        raise DescriptionError.of("run.duration", message)
    try:
        return integrate(description, times, max_steps, progress, None, inside, pause, room)
    except REFUSED:
        found = [Fault("friction", reason) for reason in reasons(description.slider.law)]
        if not found:
            raise
        raise DescriptionError(found) from None


def solve_coarsely(
    description: Description,
    times: np.ndarray,
    *,
    max_steps: int = MOST_STEPS,
    progress: Callable[[float], None] | None = None,
    room: Room = np.empty,
) -> Solution:
    """Solve with samples as accurate as the steps' tolerance: enough for measures and pictures.

    Samples inside steps take a sixth of the time of those of `solve`; the motion is the same.
    """
    inside = tolerance(description.run.rtol)
    return solve(
        description, times, max_steps=max_steps, progress=progress, inside=inside, room=room
    )


def step_times(
    description: Description, most: float, progress: Callable[[float], None] | None = None
) -> Floats | None:
    """Return the times (n,), s, at which steps of the solver and sticks end; None for too many.

    They are None, too, of a run that does not reach its end. Steps are at most so many, and sticks
    are left out where these are more: many cycles that are taken at once are one step. Each step
    takes 20 us of Python.
    """
    start, duration = description.initial.time, description.run.duration
    shares: list[float] = []

    def note(share: float) -> None:
        shares.append(share)
        if progress is not None:
            progress(share)

    ends, inside = np.array([start, start + duration]), tolerance(description.run.rtol)
    solution = solve(description, ends, max_steps=int(most), progress=note, inside=inside, pause=1)
    if not STATUSES[solution.code].ok:
        return None
    times, sticks = start + duration * np.array(shares), solution.sticks.ravel()
    return np.union1d(times, sticks) if len(sticks) + len(times) <= most else np.unique(times)


def sample_coarsely(
    description: Description, times: np.ndarray, progress: Callable[[float], None] | None = None
) -> ColumnTable:
    """Return a run sampled at `times` (s), as accurately as a picture needs it."""
    solution = solve_coarsely(description, times, progress=progress)
    return sample_table(description, solution.times, solution.samples, {})


def kind(description: Description) -> str:
    """Return the kind of the solved problem, in words."""
    if has_state(description.slider.law):
        return "friction with internal state"
    if description.run.regularisation is not None:
        return "regularised"
    return "set-valued friction"


def times_of(description: Description) -> Floats:
    """Return the output times of a description; see `simulate`."""
    initial, settings = description.initial, description.run
    whole = settings.multiscale is True and settings.sample_rate is None
    rate = 0.0 if whole else settings.sample_rate
    if rate is None:
        return automatic_times(description)
    return sample_times(initial.time, settings.duration, rate)


def own_times(description: Description, times: ArrayLike) -> Floats:
    """Return the times at which a user wants samples, or say why a run has none there."""
    found = read_times(times)
    start = description.initial.time
    end = start + description.run.duration
    rounding = max(TIME_ROUNDING * description.run.duration, 4.0 * np.spacing(end))
    if found[0] < start - rounding or found[-1] > end + rounding:
        raise DescriptionError.of(
            "times",
            f"reach from {in_words(found[0], 's')} to {in_words(found[-1], 's')}, the run from "
            f"{in_words(start, 's')} to {in_words(end, 's')}",
        )
    return ascending(np.clip(found, start, end))


def time_to_last(times: ArrayLike, initial: Initial) -> float:
    """Return the time from the start of a run to the last of the times of its samples, s."""
    last = float(read_times(times)[-1])
    if not last > initial.time:
        ends = f"end at {in_words(last, 's')}, the run starts at {in_words(initial.time, 's')}"
        raise DescriptionError.of("times", f"{ends}; give a duration")
    return last - initial.time


def read_times(times: Any) -> Floats:
    """Return times in s, which may carry a unit, or say why they are none to sample at."""
    try:
        found = as_numbers(samples_to_si(times, unit_on(times) or TIME.unit, TIME))
    except ValueError as error:
        raise DescriptionError.of("times", str(error)) from None
    return ascending(found)


def ascending(times: Floats) -> Floats:
    """Return times of samples, or say that the file of a run cannot hold them."""
    if not len(times) or not np.isfinite(times).all() or (np.diff(times) <= SHORTEST).any():
        raise DescriptionError.of("times", "must be finite numbers, at least one, ascending")
    return times


def sample_times(start: float, duration: float, rate: float) -> np.ndarray:
    """Return the output times; the end belongs to them if it is on the grid, within rounding.

    At a rate of zero they are start and end.
    """
    end = start + duration
    if rate == 0.0:
        return np.array([start, end])
    times: np.ndarray = start + np.arange(int(duration * rate * (1.0 + TIME_ROUNDING)) + 1) / rate
    clipped: np.ndarray = np.minimum(times, end)
    return clipped


PER_FAST_PERIOD, PER_SLOW_PERIOD = 20, 32  # samples
FEWEST_SAMPLES, MANY_SAMPLES, MOST_SAMPLES = 1_000, 200_000, 1_000_000  # samples of one run


def automatic_times(description: Description) -> np.ndarray:
    """Return output times that show the motion of a system, from start to end; see `simulate`."""
    slider, duration = description.slider, description.run.duration
    slow, fast = slider.natural_frequencies
    imposed = max(slider.modulation_frequencies, default=0.0)
    fine = min(PER_FAST_PERIOD * duration * fast, MANY_SAMPLES)
    least = duration * max(PER_SLOW_PERIOD * slow, PER_FAST_PERIOD * imposed)
    wanted = max(fine, least, FEWEST_SAMPLES)
    start = description.initial.time
    times: np.ndarray = np.linspace(start, start + duration, ceil(min(wanted, MOST_SAMPLES)) + 1)
    times.sort(kind="stable")  # they are in order but for rounding: NumPy's `unique` sorts anew
    distinct: np.ndarray = times[np.append(True, times[1:] > times[:-1])]  # rounding makes some one
    return distinct
