"""Simulated records whose friction differs from cycle to cycle.

Friction between real surfaces differs from slip to slip, by tenths of a per cent to some per cent.
That is more than the noise of a load cell, and it is what limits an estimate: a likelihood without
it takes the scatter of the cycles for information. Here each cycle has a friction law of its own,
whose coefficients are drawn about those of the rig; it holds from the trough after one rapid slip
to the next, so that no motion is disturbed by the change.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import count, pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from stiction.analysis.motion.noiseless.zigzag import zigzag
from stiction.arrays import Floats
from stiction.friction import Anisotropic, states
from stiction.inference.cycles import slip_cycles
from stiction.simulation import solve_coarsely
from stiction.system.description import Description, Settings
from stiction.system.initial import Initial
from stiction.system.slider import Slider

RTOL = 1e-4  # of each cycle: a hundredth of a per cent, below any jitter that is seen
LARGE = 0.15  # of the span in a cycle's window: a fall by so much, and a rise, make a trough
SMALLEST = 1e-3  # of the elongation: a smaller fall is not a slip
REACH = 1.3  # mean lengths of a cycle that are simulated at once in search of the next trough
MORE = 0.4  # of them, if it is not among these
LONGEST_WAIT = 4.0  # of them without a trough: the friction of a further cycle is drawn
IDLE = 10.0  # of them without a trough: the motion has no more cycles
SPARE = 2  # troughs beyond the cycles that are wanted: the first begins at the end of a slip
AT_REST = 0.9  # of the friction force at vanishing slip: below it no law lets a mass slip rapidly
FEWEST_SAMPLES = 8  # samples that are simulated at once
MOST_STEPS = 2_000_000


class Jitter(NamedTuple):
    """The variation of friction from cycle to cycle.

    Parameters
    ----------
    spread : float
        Standard deviation of the logarithm of each coefficient.
    common : float
        Correlation between the coefficients, 0 to 1.
    drift : float, optional
        Change of the logarithm of all coefficients from each cycle to the next.
    alternation : float, optional
        Difference of the logarithm of all coefficients between odd and even cycles.
    """

    spread: float
    common: float
    drift: float = 0.0
    alternation: float = 0.0


class SampledMotion(NamedTuple):
    """A motion at `time` (n,), s: its samples (n, 4 + internal states), and its troughs' indices.

    A sample is elongation x and y (m), slip velocity x and y (m/s), and the internal states.
    """

    time: Floats
    rows: Floats
    troughs: NDArray[np.int64]


def laws(law: Any, jitter: Jitter, random: np.random.Generator) -> Iterator[Any]:
    """Yield the friction law of each cycle, with coefficients drawn around those of `law`."""
    if isinstance(law, Anisotropic):
        yield from (law._replace(law=inner) for inner in laws(law.law, jitter, random))
        return
    names = coefficients(law)
    for number in count():
        common, *own = random.standard_normal(1 + len(names))
        share, rest = jitter.common**0.5, (1.0 - jitter.common) ** 0.5
        trend = number * jitter.drift + (0.5 - number % 2) * jitter.alternation
        factors = np.exp(jitter.spread * (share * common + rest * np.array(own)) + trend)
        pairs = zip(names, factors.tolist(), strict=True)  # NumPy's numbers take Python longer
        yield law._replace(**{name: getattr(law, name) * factor for name, factor in pairs})


def coefficients(law: Any) -> list[str]:
    """Return the names of a law's friction coefficients, which differ from cycle to cycle.

    >>> from stiction.friction.laws import Coulomb, LuGre
    >>> coefficients(Coulomb(0.2)), coefficients(LuGre(0.2, 0.3, 0.01, 1e5, 300.0))
    (['mu_0', 'mu_static'], ['mu_c', 'mu_s'])
    """
    return [name for name in law._fields if name.startswith("mu_")]


def move(
    slider: Slider,
    times: Floats,
    jitter: Jitter,
    random: np.random.Generator,
    *,
    cycle: float,
    cycles: int | None = None,
    noise: float = 0.0,
) -> SampledMotion:
    """Simulate a slider at equally spaced times, with its own friction in each cycle.

    Parameters
    ----------
    slider : Slider
        With a steady drive and load.
    times : ndarray
        (n,), s, from 0 on.
    jitter : Jitter
        The spread of the coefficients.
    random : Generator
        Where they are drawn from.
    cycle : float
        First guess of a cycle's length, s.
    cycles : int, optional
        End after so many cycles, as `slip_cycles` counts them, or when no more come.
    noise : float, optional
        Standard deviation of the noise that a force will have, N, for this count.
    """
    step = times[1] - times[0]
    internal = len(states(slider.law))
    kept = [*range(4), *range(-internal, 0)]  # friction and load are between
    rows = np.empty((len(times), len(kept)))
    troughs: list[int] = []
    origin, begin, initial = 0, 0, Initial(epsilon=0.0)  # where the cycle and its part begin
    whole = max(int(REACH * cycle / step), FEWEST_SAMPLES)
    window = loaded = max(whole, int(first_loading(slider) / step))
    own = laws(slider.friction, jitter, random)
    law, last, wanted = next(own), len(times) - 1, (cycles or 0) + SPARE
    while begin < last:
        end = min(begin + window, last)
        rig = slider.model_copy(update={"friction": law})
        samples = simulate_part(rig, initial, *stretch(times, begin, end))
        if samples is None:
            return SampledMotion(times[: begin + 1], rows[: begin + 1], np.array(troughs, np.int64))
        rows[begin : end + 1] = samples[:, kept]
        trough = first_trough(rows[origin : end + 1, 0])
        if trough >= 0:
            begin = origin + trough
            if troughs:
                mean = (begin - troughs[0]) / len(troughs)
                whole = max(int(REACH * mean), FEWEST_SAMPLES)
            troughs.append(begin)
            if cycles is not None and len(troughs) >= wanted:
                seen = len(slip_cycles(slider.k_x * rows[: begin + 1, 0], noise).peak)
                if seen >= cycles:
                    break
                wanted = len(troughs) + cycles - seen
            origin, window, law = begin, whole, next(own)
        elif end - origin > LONGEST_WAIT * whole:  # no slip: sliding, or loading
            begin = origin = end
            if cycles is not None and end - (troughs or [loaded])[-1] > IDLE * whole:
                break
            window, law = whole, next(own)
        else:  # a longer cycle
            begin, window = end, max(int(MORE * whole), FEWEST_SAMPLES)
        initial = start(slider, rows[begin], float(times[begin]))
    until = begin + 1
    return SampledMotion(times[:until], rows[:until], np.array(troughs, np.int64))


def simulate_part(
    slider: Slider, initial: Initial, duration: float, times: Floats
) -> Floats | None:
    """Return the samples at these times; None if the run ends early."""
    settings = Settings.model_construct(
        duration=duration, sample_rate=None, rtol=RTOL,
        regularisation=None, smoothing="root", multiscale="auto",
    )  # fmt: skip
    found = solve_coarsely(Description(slider, initial, settings), times, max_steps=MOST_STEPS)
    return found.samples if found.code == 0 else None


def first_loading(slider: Slider) -> float:
    """Return the time for which a mass at rest cannot slip while the spring is loaded first, s.

    It is as long as many cycles where a slip takes little of the force.
    """
    return AT_REST * slider.loading_time


def stretch(times: Floats, begin: int, end: int) -> tuple[float, Floats]:
    """Return the duration from one time to another, and the times in it.

    The start plus the duration may be less than the last time by rounding; a run would not reach
    that time, so that it is moved to where the run ends.
    """
    duration = float(times[end] - times[begin])
    return duration, np.minimum(times[begin : end + 1], times[begin] + duration)


def first_trough(values: Floats) -> int:
    """Return the index of the first trough after a fall; -1 if there is none.

    A fall by less than a thousandth of the largest value is none: steady sliding has some by
    rounding.

    >>> first_trough(np.array([0.0, 1.0, 2.0, 0.5, 1.0])), first_trough(np.array([0.0, 1.0]))
    (3, -1)
    >>> first_trough(np.array([2.0, 1.9999, 2.0]))
    -1
    """
    least = SMALLEST * float(np.abs(values).max())
    turns = zigzag(values, max(LARGE * float(np.ptp(values)), least))
    for before, at in pairwise((0, *turns)):
        if values[at] < values[before]:
            return int(at)
    return -1


def start(slider: Slider, row: Floats, time: float) -> Initial:
    """Return the state of a sample as the start of a run."""
    d_x, d_y = slider.along_axes(*slider.motion.rate(time))
    v_x, v_y = d_x - row[2], d_y - row[3]
    names = [state.name for state in states(slider.law)]
    internal = dict(zip(names, row[4:].tolist(), strict=True)) or None
    return Initial.model_construct(
        {"u_x", "u_y", "v_x", "v_y", "time", "states"},
        epsilon=1e-6, u_x=float(row[0]), u_y=float(row[1]), v_x=float(v_x), v_y=float(v_y),
        states=internal, time=time,
    )  # fmt: skip
