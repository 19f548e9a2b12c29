"""``stiction listen``: the transverse oscillation as sound."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

from stiction.cli.options import Output, Trust, Window
from stiction.cli.terminal import say
from stiction.errors import Faults


def listen(
    result: Path,
    /,
    *,
    output: Output,
    speed: float | None = None,
    window: Window = None,
    axis: Literal["x", "y"] = "y",
    trust: Trust = False,
) -> None:
    """Write the transverse oscillation of a run as sound.

    For example, after `stiction run my.toml -o my.nc`; then a part of it, an octave lower:

        stiction listen my.nc -o oscillation.wav

        stiction listen my.nc -o slow.wav --speed 0.5 --window 1.2s 2.1s

    Parameters
    ----------
    result
        A file written by `stiction run`.
    output
        The file to write: .wav, 48 kHz. Example: -o oscillation.wav.
    speed
        1 for the true pitch, 0.1 for a tenth; by default 1 where the natural frequency can be
        heard, else the power of ten by which it can. Example: --speed 0.5.
    window
        Start and end in the run; all of it by default. Example: --window 1.8s 2.1s.
    axis
        Whose elongation rate is heard: that of the transverse spring, y, or of x. Example: --axis
        x.
    """
    from stiction.media.sound import WAV, make_sound, passage
    from stiction.progress.display import show_progress
    from stiction.storage.files import placeable

    faults = Faults()
    with faults.of_part():
        target = placeable(output, WAV)
    with faults.of_part():
        heard = passage(result, speed, window, axis, trust=trust)
    faults.refuse()
    with show_progress("listening") as report:
        made = make_sound(heard, report)
    pitch = "at its true pitch"
    if made.speed != 1.0:
        slower = made.speed < 1.0
        times = 1.0 / made.speed if slower else made.speed
        pitch = f"{times:.6g} times {'slower and deeper' if slower else 'faster and higher'}"
    say(f"wrote {made.save(target)}: {made.duration:.3g} s, {pitch}")
