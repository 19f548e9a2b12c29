"""``stiction animate``: the motion as a film."""

from __future__ import annotations

from pathlib import Path

from stiction.cli.options import Output, Trust, Window
from stiction.cli.terminal import say
from stiction.errors import Faults


def animate(
    result: Path,
    /,
    *,
    output: Output,
    window: Window = None,
    length: float | str = 10.0,
    at: str | None = None,
    height: int | None = None,
    trust: Trust = False,
) -> None:
    """Film a run: the apparatus from above, its time series, and the fast oscillation beside them.

    All but a .gif needs `stiction[film]`. For example, after `stiction run my.toml -o my.nc`; then
    one slip, slowly:

        stiction animate my.nc -o lecture.mp4

        stiction animate my.nc -o slip.mp4 --window 1.5s 2.2s --length 15s

    Parameters
    ----------
    result
        A file written by `stiction run`.
    output
        The film to write: .mp4, .webm or .gif. Example: -o lecture.mp4.
    window
        Start and end in the run; all of it by default. Example: --window 1.5s 2.2s.
    length
        Of the film, s: it decides how slowly the window passes. Example: --length 15s.
    at
        The time whose surroundings are shown under the microscope: a few periods of the fast
        oscillation; by default a third into the window. Example: --at 2.05s.
    height
        Of the film, in pixels: 360, 540, 720, 1080, 1440 or 2160; by default 720, of a GIF 360. Its
        width is 16/9 of it. Example: --height 1080.
    """
    from stiction.media.film import excerpt, filmable, make_film
    from stiction.progress.display import show_progress

    faults = Faults()
    with faults.of_part():
        target = filmable(output)
    with faults.of_part():
        shown = excerpt(result, window, length, at, height, trust=trust)
    faults.refuse()
    with show_progress("filming") as report:
        made = make_film(shown, target.suffix[1:].lower(), report)
    say(f"wrote {made.save(target)}")
