"""``stiction audit``: what to know of an apparatus before its measurements are believed."""

from __future__ import annotations

from pathlib import Path

from stiction.cli.options import Changes, MaybeOutput, Trust, changes
from stiction.cli.terminal import say


def audit(
    config: Path, /, *, output: MaybeOutput = None, trust: Trust = False, set: Changes = None
) -> int:
    """Audit the apparatus that CONFIG describes: is what it will show friction, or itself?

    Prints what theory predicts from the description alone beside what a simulated test shows:
    damping number, critical misalignment and the margin to it, true rest and creep in what looks
    like stick, apparent friction coefficients, period, the frequency of the transverse
    oscillation and the sampling rate that it takes to see it; and, if it does not slide steadily,
    what to change, each advice tried in a simulation.

    For example, with what `stiction init my.toml` writes:

        stiction audit my.toml -o my.html

        stiction audit my.toml --set phi=3deg --set W=20N

    The drive and the load must be steady; [run] is not used. Exit status: 0 when every
    simulation reached its end, 1 when one ended earlier, 2 when the description cannot be audited.

    Parameters
    ----------
    config
        A description in TOML; `stiction init` writes one to start from.
    output
        An HTML page to write the same report to, with figures, in one file.
    """
    from stiction.auditing.report import audit as examine
    from stiction.cli.progress import progress
    from stiction.cli.tables import printed
    from stiction.system.slider import Slider

    slider = Slider.from_toml(config, changes(set), trust=trust)
    if output is not None:
        from stiction.auditing.page import writable

        writable(output)
    with progress("auditing") as report:
        found = examine(slider, report)
    printed(str(config), found.tables())
    if output is not None:
        say(f"wrote {found.write_html(output, str(config))}")
    return 0 if found.ok else 1
