"""The transverse oscillation as sound."""

from __future__ import annotations

import wave
from base64 import b64encode
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from io import BytesIO
from math import floor, log10
from pathlib import Path
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from stiction.arrays import Floats, same_fields
from stiction.errors import Faults, ResultError, echo
from stiction.progress.audience import with_progress
from stiction.result.window import window_of
from stiction.simulation import sample_coarsely
from stiction.storage.files import placeable, whole
from stiction.system.description import Description
from stiction.text.quantity.wording import in_words
from stiction.text.units import Quantity
from stiction.trajectory import Trajectory, run_of

WAV = (".wav",)
RATE = 48_000  # samples of sound a second
LOUD = 0.8  # of full scale
SHORTEST_SOUND, LONGEST_SOUND = 0.01, 600.0  # s of sound
EVEN_RATE = 1e-5  # of a mean rate: ten times what epsilon, which starts a run, alters
HEARD = (50.0, 8_000.0)  # Hz: a pitch that small loudspeakers give
LARGEST_SAMPLE = 2**15 - 1  # of 16 bits


@dataclass(frozen=True, eq=False, repr=False)
class Sound:
    """A sound, which a notebook plays.

    Attributes
    ----------
    samples : ndarray
        (n,), -1 to 1, at 48 kHz.
    speed : float
        Time in the run over time in the sound: below 1 it is slower, and deeper.
    """

    samples: NDArray[np.float32]
    speed: float

    def __eq__(self, other: object) -> bool:
        """Compare samples and speed."""
        return same_fields(self, other)

    def __repr__(self) -> str:
        """Return a one-line summary."""
        return f"<Sound of {in_words(self.duration, 's')}, speed {self.speed:g}>"

    @property
    def duration(self) -> float:
        """Length, s."""
        return len(self.samples) / RATE

    def save(self, path: str | Path) -> Path:
        """Write the sound as a .wav file of 16 bits, whole or not at all; return the path."""
        target = placeable(path, WAV)
        with whole(target) as part:
            part.write_bytes(self._content())
        return target

    def _content(self) -> bytes:
        packed = BytesIO()
        with wave.open(packed, "wb") as file:
            file.setnchannels(1)
            file.setsampwidth(2)
            file.setframerate(RATE)
            file.writeframes(np.round(self.samples * LARGEST_SAMPLE).astype("<i2").tobytes())
        return packed.getvalue()

    def _repr_html_(self) -> str:
        content = b64encode(self._content()).decode("ascii")
        return f'<audio controls src="data:audio/wav;base64,{content}"></audio>'


class Passage(NamedTuple):
    """A part of a run to hear: its start and end, s; the speed of the sound, and its axis."""

    description: Description
    start: float
    end: float
    speed: float
    axis: str


@with_progress("listening")
def listen(
    run: Trajectory | str | Path,
    *,
    speed: float | None = None,
    window: Sequence[Quantity] | None = None,
    axis: Literal["x", "y"] = "y",
    trust: bool = False,
    progress: Callable[[float], None] | None = None,
) -> Sound:
    """Return the elongation rate of the transverse spring as sound.

    The run is solved again, with a sample for each of the sound: nothing is interpolated.

    Parameters
    ----------
    run : Trajectory, str or Path
        A run, or its file.
    speed : float, optional
        1 for the true pitch; 0.1 is ten times slower and deeper. By default 1 where the natural
        frequency can be heard, else the power of ten by which it can.
    window : tuple of float or str, optional
        Start and end in the run, s; all of it by default.
    axis : {"x", "y"}, optional
        Of the spring: y is the transverse one.
    trust : bool, optional
        For a file; see `stiction.load`.
    progress : callable, optional
        Called with the fraction done; without it, a terminal or a notebook shows a bar or lines.

    Returns
    -------
    Sound
        A notebook plays it; ``save("oscillation.wav")`` writes it.

    Raises
    ------
    ResultError
        If it would be longer than ten minutes or shorter than ten milliseconds, or there is nothing
        to hear.

    Examples
    --------
    >>> import stiction as st
    >>> run = st.simulate(st.presets.nakano_popov_2020(), "0.1 s")
    >>> st.listen(run)
    <Sound of 100 ms, speed 1>
    """
    heard = passage(run, speed, window, axis, trust=trust)
    return make_sound(heard, progress)


def passage(
    run: Trajectory | str | Path,
    speed: float | None,
    window: Sequence[Quantity] | None,
    axis: str,
    *,
    trust: bool = False,
) -> Passage:
    """Return the audible part of a run, by the arguments of `listen`.

    Raises
    ------
    StictionError
        With all that is wrong of them.
    """
    faults, chosen = Faults(), None
    if axis not in ("x", "y"):
        faults.add(f"axis must be 'x' or 'y', is {echo(axis)}; y is the transverse one")
    if speed is not None:
        with faults.of_part():
            chosen = read_speed(speed)
    with faults.of_part():
        description = run_of(run, trust).description
        with faults.of_part():
            start, end = window_of(description, window)
    faults.refuse()
    chosen = audible_speed(description, axis) if chosen is None else chosen
    length = (end - start) / chosen
    if length > LONGEST_SOUND:
        raise ResultError(
            f"at speed {chosen:g} the sound lasts {in_words(length, 's')}; it may last up to "
            f"{LONGEST_SOUND:g} s: choose a window or a larger speed"
        )
    if length < SHORTEST_SOUND:
        raise ResultError(
            f"at speed {chosen:g} the sound lasts {in_words(length, 's')}; it must last at least "
            f"{in_words(SHORTEST_SOUND, 's')}: choose a smaller speed, or another window"
        )
    return Passage(description, start, end, chosen, axis)


def read_speed(speed: float) -> float:
    """Return the speed of a sound, or refuse it."""
    try:
        chosen = float(speed)
    except (TypeError, ValueError, OverflowError):
        raise ResultError(f"speed must be a number such as 0.1, is {echo(speed)}") from None
    if not chosen > 0.0:
        raise ResultError(f"speed must be above 0, is {chosen:g}; 0.1 is ten times slower")
    return chosen


def make_sound(heard: Passage, progress: Callable[[float], None] | None = None) -> Sound:
    """Return the sound of a passage, or refuse one in which nothing oscillates."""
    description, start, end, chosen, axis = heard
    count = floor((end - start) / chosen * RATE)
    times = start + np.arange(count, dtype=np.float64) * (chosen / RATE)
    values = rate_at(description, times, axis, progress)
    loudest = float(np.max(np.abs(values), initial=0.0))
    if loudest == 0.0:
        other = "x" if axis == "y" else "y"
        window = f"from {start:g} s to {end:g} s; choose"
        if rate_at(description, times, other).any():
            raise ResultError(
                f"nothing oscillates along {axis} {window} the axis {other}, or another window"
            )
        raise ResultError(f"nothing oscillates {window} another window, or run it longer")
    return Sound((values * (LOUD / loudest)).astype(np.float32), chosen)


def rate_at(
    description: Description,
    times: Floats,
    axis: str = "y",
    progress: Callable[[float], None] | None = None,
) -> Floats:
    """Return the elongation rate (m/s) of a run at `times` (s), without its mean.

    It is zero where a spring is loaded evenly, whatever rounding and the start leave.
    """
    values = sample_coarsely(description, times, progress)[f"v_{axis}"][: len(times)]
    mean = float(np.mean(values[np.isfinite(values)]))
    found: Floats = np.nan_to_num(values - mean)
    if np.max(np.abs(found), initial=0.0) < EVEN_RATE * abs(mean):
        return np.zeros_like(found)
    return found


def audible_speed(description: Description, axis: str = "y") -> float:
    """Return 1, or the power of ten that makes the natural frequency of an axis audible."""
    slow, fast = description.slider.natural_frequencies
    pitch = fast if axis == "xy"[description.slider.stiffer_axis] else slow
    low, high = HEARD
    if pitch > high:
        return float(10.0 ** floor(log10(high / pitch)))
    return float(10.0 ** -floor(log10(pitch / low))) if pitch < low else 1.0
