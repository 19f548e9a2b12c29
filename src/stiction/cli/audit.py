"""``stiction audit``: what to know of an apparatus before its measurements are believed."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter


def audit(config: Path, /, *, output: Annotated[Path | None, Parameter(alias="-o")] = None) -> int:
    """Audit the apparatus that CONFIG describes: is what it will show friction, or itself?

    Prints what theory predicts from the description alone beside what a simulated test shows:
    damping number, critical misalignment and the margin to it, true rest and creep in what looks
    like stick, apparent friction coefficients, period, the frequency that the rig sings at and
    the sampling rate that it takes to see it; and, if it does not slide steadily, what to change,
    each advice tried in a simulation.

    The drive and the load must be steady; [run] is not used. Exit status: 0 when every
    simulation reached its end, 1 when one ended earlier, 2 when the description cannot be audited.

    Parameters
    ----------
    config
        A description in TOML; `stiction init` writes one to start from.
    output
        An HTML page to write the same report to, with figures, in one file.
    """
    from stiction.auditing.report import examine
    from stiction.auditing.words import sections
    from stiction.cli.progress import progress
    from stiction.cli.tables import printed
    from stiction.slider import Slider

    slider = Slider.from_toml(config)
    if output is not None:
        from stiction.auditing.page import writable, write

        writable(output)
    with progress("auditing") as report:
        found = examine(slider, report)
    printed(str(config), sections(found))
    if output is not None:
        print(f"wrote {write(found, output, str(config))}")
    runs = [found.observation, *(each.tried for each in found.advices if each.tried)]
    return 0 if all(each.run.status.ok for each in runs) else 1
