"""The motion as a film: the apparatus, its time series, and a few periods under the microscope."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from math import ceil, log10
from pathlib import Path
from typing import Any, Literal, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from stiction.arrays import Floats
from stiction.errors import Faults, ResultError, echo
from stiction.media.encoder import KINDS, encode
from stiction.media.scene import Scene, slowest_slip
from stiction.plotting.page.style import BLACK, BLUE, GREEN, ORANGE, RED, style
from stiction.plotting.run.lines import BAND, draw_line, envelope
from stiction.plotting.run.time_series import STILL, say_only
from stiction.progress.audience import with_progress
from stiction.result.table import ColumnTable
from stiction.result.window import time_in, window_of
from stiction.simulation import automatic_times, sample_coarsely
from stiction.storage.files import placeable, whole
from stiction.system.description import Description
from stiction.text.quantity.prefix import metric_prefix
from stiction.text.quantity.wording import in_words
from stiction.text.units import Duration, Quantity
from stiction.text.validation import Described, read_arguments
from stiction.trajectory import Trajectory, run_of

SIZE = 12.8, 7.2  # in
Height = Literal[360, 540, 720, 1080, 1440, 2160]  # pixels: with an even width, as codecs need
DEFAULT_HEIGHT: dict[str, Height] = {"mp4": 720, "webm": 720, "gif": 360}  # a GIF is large
FRAME_RATE = 25  # frames a second
LENGTH, LONGEST_FILM = 10.0, 300.0  # s of film
PERIODS = 4  # of the fast oscillation under the microscope
FINE_SAMPLES = 2_000  # samples of these
IN_WINDOW = 20_000  # samples of the time series, at least
WIDTH = 0.8  # pt, of lines over time
TICKS = 5  # of a time axis, at most: more run into one another
NAMES = ("u_x", "u_y", "slip_x", "slip_y", "slip_speed", "friction", "psi", "X", "normal_load",
         "spring_x", "sticking")  # fmt: skip


@dataclass(frozen=True)
class Film:
    """A film, which a notebook shows.

    Attributes
    ----------
    content : bytes
        The file.
    kind : str
        "mp4", "webm" or "gif".
    """

    content: bytes = field(repr=False)
    kind: str

    def save(self, path: str | Path) -> Path:
        """Write the film, whole or not at all; return the path."""
        target = filmable(path)
        if (wanted := target.suffix[1:].lower()) != self.kind:
            raise ResultError(
                f"{target}: this film is {self.kind}; name it so, or make another: "
                f'st.animate(run, kind="{wanted}")'
            )
        with whole(target) as part:
            part.write_bytes(self.content)
        return target

    def _repr_html_(self) -> str:
        content = b64encode(self.content).decode("ascii")
        fitted = 'style="max-width: 100%"'
        if self.kind == "gif":
            return f'<img {fitted} src="data:image/gif;base64,{content}">'
        source = f'src="data:video/{self.kind};base64,{content}"'
        return f"<video controls loop {fitted} {source}></video>"


def filmable(path: str | Path) -> Path:
    """Return a path, if a film can be written there."""
    return placeable(path, [f".{kind}" for kind in KINDS])


class Excerpt(NamedTuple):
    """A part of a run to film: the times of its frames, that under the microscope, its length, s.

    The time under the microscope is None for that where the mass slips; the height of the frames,
    in pixels, is None for that of the film's kind.
    """

    description: Description
    times: Floats
    middle: float | None
    length: float
    height: Height | None = None


class Screening(Described):
    """How long a film lasts, s, and how high it is, pixels."""

    length: Duration
    height: Height | None


@with_progress("filming")
def animate(
    run: Trajectory | str | Path,
    *,
    window: Sequence[Quantity] | None = None,
    length: Quantity = LENGTH,
    at: Quantity | None = None,
    kind: str = "mp4",
    height: int | None = None,
    trust: bool = False,
    progress: Callable[[float], None] | None = None,
) -> Film:
    """Film a run: the apparatus from above, its time series, and the fast oscillation beside them.

    Parameters
    ----------
    run : Trajectory, str or Path
        A run, or its file; it is solved again, with a sample for each frame.
    window : tuple of float or str, optional
        Start and end in the run, s; all of it by default.
    length : float or str, optional
        Of the film, s: how slowly the window passes.
    at : float or str, optional
        The time, s, whose surroundings are shown under the microscope: a few periods of the fast
        oscillation, as slowly as the film lasts; by default where the mass slips, about a third
        into the window.
    kind : {"mp4", "webm", "gif"}, optional
        The format.
    height : {360, 540, 720, 1080, 1440, 2160}, optional
        Of the film, in pixels; its width is 16/9 of it. By default 720, of a GIF 360.
    trust : bool, optional
        For a file; see `stiction.load`.
    progress : callable, optional
        Called with the fraction done; without it, a terminal or a notebook shows a bar or lines.

    Returns
    -------
    Film
        A notebook shows it; ``save("lecture.mp4")`` writes it.

    Raises
    ------
    ResultError
        If there is no such window or format, or the package av is missing, which mp4 and webm
        need (install ``stiction[film]``).

    Examples
    --------
    >>> import stiction as st
    >>> run = st.simulate(st.presets.nakano_popov_2020(), "20 ms", sample_rate="10 kHz")
    >>> st.animate(run, length=0.2).save("film.mp4").name
    'film.mp4'
    """
    faults = Faults()
    if kind not in KINDS:
        faults.add(f"kind must be one of {', '.join(KINDS)}, is {echo(kind)}")
    with faults.of_part():
        shown = excerpt(run, window, length, at, height, trust=trust)
    faults.refuse()
    return make_film(shown, kind, progress)


def excerpt(
    run: Trajectory | str | Path,
    window: Sequence[Quantity] | None,
    length: Quantity,
    at: Quantity | None,
    height: int | None = None,
    *,
    trust: bool = False,
) -> Excerpt:
    """Return the content of a film of a run, by the arguments of `animate`.

    Raises
    ------
    StictionError
        With all that is wrong of them.
    """
    faults, middle = Faults(), None
    with faults.of_part():
        screening = read_arguments(Screening, length=length, height=height)
        lasts = screening.length
        if not 1.0 / FRAME_RATE <= lasts <= LONGEST_FILM:
            faults.add(
                f"length must lie between {1 / FRAME_RATE:g} s and {LONGEST_FILM:g} s, is "
                f"{lasts:g} s"
            )
    with faults.of_part():
        description = run_of(run, trust).description
        with faults.of_part():
            start, end = window_of(description, window)
        with faults.of_part():
            middle = None if at is None else time_in(description, at)
    faults.refuse()
    times = np.linspace(start, end, ceil(lasts * FRAME_RATE))
    return Excerpt(description, times, middle, lasts, screening.height)


def make_film(shown: Excerpt, kind: str, progress: Callable[[float], None] | None = None) -> Film:
    """Return the film of an excerpt."""
    height = shown.height or DEFAULT_HEIGHT[kind]
    frames = _count(draw(shown, height), len(shown.times), progress)
    return Film(encode(frames, FRAME_RATE, kind), kind)


def _count(
    frames: Iterator[NDArray[np.uint8]], total: int, progress: Callable[[float], None] | None
) -> Iterator[NDArray[np.uint8]]:
    for number, frame in enumerate(frames, 1):
        yield frame
        if progress is not None:
            progress(number / total)


def draw(excerpt: Excerpt, height: int) -> Iterator[NDArray[np.uint8]]:
    """Yield the frames of an excerpt, (height, width, 3)."""
    description, times, middle, length, _ = excerpt
    every, window = automatic_times(description), window_times(description, times)
    run = sample_coarsely(description, np.unique(np.concatenate([every, times, window])))
    whole_run, shown, seen = run.at(every), run.at(times), run.at(window)
    near = moving_at(seen) if middle is None else middle
    fine = sample_coarsely(description, fine_times(description, near))
    slow = length / (times[-1] - times[0])
    with style():
        figure = Figure(figsize=SIZE, dpi=height / SIZE[1])
        canvas: Any = FigureCanvasAgg(figure)
        scene = Scene(figure.add_axes((0.02, 0.4, 0.62, 0.58)), description.slider, whole_run)
        cursor, mark = series(figure, seen, times), microscope(figure, fine, length)
        places, _ = micro_times(fine)
        moving: list[Any] = [*scene.artists, *cursor, mark]
        for artist in moving:
            artist.set_animated(True)
        canvas.draw()
        still = canvas.copy_from_bbox(figure.bbox)
        for number, time in enumerate(shown["time"]):
            canvas.restore_region(still)
            state = {name: float(shown[name][number]) for name in NAMES}
            scene.show(state, f"t = {time_in_digits(time, times[-1] - times[0])}, {slowness(slow)}")
            for line in cursor:
                line.set_xdata([time, time])
            here = int(number / max(len(times) - 1, 1) * (len(places) - 1))
            mark.set_xdata([places[here]] * 2)
            for artist in moving:
                artist.axes.draw_artist(artist)
            yield np.asarray(canvas.buffer_rgba())[..., :3]


def window_times(description: Description, times: Floats) -> Floats:
    """Return times from the first to the last of `times` that show the motion between them, s."""
    every = automatic_times(description)
    inside = every[(every >= times[0]) & (every <= times[-1])]
    few = len(inside) < IN_WINDOW
    return np.linspace(times[0], times[-1], IN_WINDOW) if few else inside


def moving_at(seen: ColumnTable) -> float:
    """Return the time nearest to a third of the way at which the mass slips, s."""
    times = seen["time"]
    third = float(times[0] + (times[-1] - times[0]) / 3.0)
    slips = times[seen["slip_speed"] > slowest_slip(seen)]
    return float(slips[np.argmin(np.abs(slips - third))]) if len(slips) else third


def fine_times(description: Description, middle: float) -> Floats:
    """Return the times under the microscope, s."""
    start, end = window_of(description, None)
    width = min(PERIODS / description.slider.natural_frequencies[1], end - start)
    low = min(max(middle - 0.5 * width, start), end - width)
    return np.linspace(low, low + width, FINE_SAMPLES)


def slowness(slow: float) -> str:
    """Return how much slower than life something is shown."""
    if 0.95 < slow < 1.05:
        return "in real time"
    word, times = ("slower", slow) if slow > 1.0 else ("faster", 1.0 / slow)
    return f"{float(f'{times:.3g}'):,.15g} times {word}"


def series(figure: Figure, run: ColumnTable, times: Floats) -> list[Line2D]:
    """Draw spring forces, direction and slip speed over time; return the cursors."""
    force, prefix = metric_prefix(np.concatenate([run["spring_x"], run["spring_y"]]))
    rows: tuple[tuple[str, float, tuple[tuple[str, str, str], ...]], ...] = (
        (
            f"spring force ({prefix}N)",
            force,
            (("spring_y", "$k_y u_y$", ORANGE), ("spring_x", "$k_x u_x$", RED)),
        ),
        ("ψ (deg)", 1.0, (("psi", "", BLUE),)),
        ("slip speed (m/s)", 1.0, (("slip_speed", "", GREEN),)),
    )
    cursors, slow = [], slowest_slip(run)
    for number, (label, factor, curves) in enumerate(rows):
        ax = figure.add_axes((0.06 + 0.32 * number, 0.08, 0.265, 0.27))
        for name, words, color in curves:
            if name == "slip_speed":
                draw_speed(ax, run["time"], run[name])
            else:
                draw_line(ax, run["time"], factor * run[name], color, WIDTH).set_label(words)
        if len(curves) > 1:
            ax.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=2, fontsize=9)
        if name == "slip_speed" and not (run[name] > slow).any():
            say_only(ax, "no slip")
        elif name == "slip_speed":
            ax.set_yscale("log", nonpositive="clip")
            ax.set_ylim(slow, max(3.0 * float(np.nanmax(run[name])), 10.0 * slow))
        low, high = ax.get_ylim()
        if name == "psi" and high - low < STILL:
            ax.set_ylim(low - STILL, high + STILL)
        ax.set_xlim(times[0], times[-1])
        ax.xaxis.set_major_locator(MaxNLocator(TICKS))
        label_axes(ax, "time $t$ (s)", label)
        cursors.append(ax.axvline(times[0], color=BLACK, linewidth=1.0))
    return cursors


def draw_speed(ax: Axes, time: Floats, speed: Floats) -> None:
    """Draw the slip speed over time: where it swings too fast, a line above a pale range."""
    times, values = envelope(time, speed)
    whole = len(values) == len(speed)
    ax.plot(times, values, color=GREEN, lw=WIDTH, alpha=1.0 if whole else BAND)
    if not whole:
        ax.plot(times[1::2], values[1::2], color=GREEN, lw=WIDTH)


def microscope(figure: Figure, fine: ColumnTable, length: float) -> Line2D:
    """Draw the slip speed over a few fast periods; return the cursor."""
    ax = figure.add_axes((0.72, 0.47, 0.26, 0.44))
    rests = bool((fine["slip_speed"] < slowest_slip(fine)).all())
    factor, prefix = (1.0, "") if rests else metric_prefix(fine["slip_speed"])
    places, small = micro_times(fine)
    ax.plot(places, fine["slip_speed"] * factor, color=GREEN, linewidth=1.2)
    rest = (fine["sticking"] > 0) | (fine["slip_speed"] < slowest_slip(fine))
    ax.fill_between(places, 0, 1, where=rest, transform=ax.get_xaxis_transform(), color="#D9D9D9")
    ax.set_xlim(places[0], places[-1])
    ax.set_ylim(0.0, 1.0 if rests else 1.1 * factor * float(np.max(fine["slip_speed"])))
    if rests:
        ax.set_yticks([0.0])
    span = fine["time"][-1] - fine["time"][0]
    middle = 0.5 * (fine["time"][-1] + fine["time"][0])
    label_axes(
        ax,
        f"time from {time_in_digits(middle, span)} ({small}s)",
        f"slip speed ({prefix}m/s), grey: at rest",
    )
    words = f"Microscope: {in_words(span, 's', 3)}, {slowness(length / span)}"
    ax.set_title(words, fontsize=10)
    return ax.axvline(places[0], color=BLACK, linewidth=1.0)


def micro_times(fine: ColumnTable) -> tuple[Floats, str]:
    """Return the times under the microscope from its middle, and the prefix of their unit."""
    times = fine["time"] - 0.5 * (fine["time"][0] + fine["time"][-1])
    factor, prefix = metric_prefix(times)
    return factor * times, prefix


def time_in_digits(time: float, window: float) -> str:
    """Return a time (s) with the digits that a window of it shows.

    Examples
    --------
    >>> time_in_digits(1.25, 5.0), time_in_digits(0.0674213, 12e-6)
    ('1.25 s', '0.0674213 s')
    >>> time_in_digits(79730.4, 172800.0)
    '79730 s'
    """
    return f"{time:.{max(0, ceil(-log10(window)) + 2)}f} s"


def label_axes(ax: Axes, along: str, up: str) -> None:
    """Name the axes, legibly on a screen."""
    ax.set_xlabel(along, fontsize=10)
    ax.set_ylabel(up, fontsize=10)
    ax.tick_params(labelsize=9)
