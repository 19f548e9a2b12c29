"""``stiction map``: draw the results of a study."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from stiction.cli.options import MaybeOutput, Trust, parse_assignments
from stiction.cli.terminal import say
from stiction.cli.writing import check_figure
from stiction.errors import Faults


def map(
    study: Path,
    /,
    *,
    of: Annotated[list[str] | None, Parameter(negative=())] = None,
    at: Annotated[list[str] | None, Parameter(negative=())] = None,
    output: MaybeOutput = None,
    trust: Trust = False,
) -> None:
    """Draw the results of the study in the store STUDY, finished or not.

    Two parameters give a map of the kind of motion: stick-slip, transitional oscillation,
    harmonic vibration, irregular vibration, settling, steady sliding, stuck; and transverse
    oscillation, which is faster than the mass can swing on the spring along x alone, so that the
    transverse spring oscillates too. Two theoretical lines mark where steady sliding loses
    stability, and where the damping ratio at slip is 1. One parameter gives a curve; samples over
    phi and V are points in the damping diagram.

    For example, after `stiction sweep --preset yaw-angle -o yaw.zarr`:

        stiction map yaw.zarr

        stiction map yaw.zarr --of amplitude --of creep_distance -o more.png

        stiction map yaw.zarr --of period --at "phi = 1 deg" -o slice.png

    Parameters
    ----------
    study
        The store that `stiction sweep` wrote.
    of
        A measure to draw, such as regime or peak_force; repeat it for more panels. Example: --of
        period.
    at
        A cut through a study of more dimensions, NAME=VALUE; the nearest value of the study is
        used, and one beyond its ends refused. Repeat it for several. Example: --at "phi = 1 deg".
    output
        The figure to write (.png, .pdf or .svg); by default STUDY.png beside the store. Example: -o
        map.png.
    """
    from stiction.analysis.motion.regime.kinds import UNDETERMINED
    from stiction.plotting.page.canvas import figure_of
    from stiction.plotting.page.save import write
    from stiction.progress.display import show_progress
    from stiction.study.view.mapping import map as look
    from stiction.study.view.view import REGIME, kinds

    faults = Faults()
    cut = parse_assignments(at, "--at", faults)
    check_figure(output, faults)
    with show_progress("drawing"):
        with faults.of_part():
            found = look(study, of or (), cut, trust=trust)
        faults.refuse()
        named = study if study.name.strip(".") else study.resolve()  # "." has no suffix
        written = write(figure_of(found.plot), output or named.with_suffix(".png"))
    say(f"wrote {written}")
    if REGIME in found.measures and (unclear := int((kinds(found.data) == UNDETERMINED).sum())):
        say(
            f"the kind of motion is undetermined in {unclear} of {found.data['status'].size} runs: "
            "as a rule these end before some whole cycles, which a longer duration shows"
        )
