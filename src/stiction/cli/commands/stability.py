"""``stiction stability``: stability of steady sliding, and critical parameters."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

from cyclopts import Parameter

from stiction.cli.options import (
    Changes,
    CommandError,
    FromPreset,
    MaybeOutput,
    Trust,
    changes,
    slider_from,
)
from stiction.cli.writing import check_figure, write_figure
from stiction.errors import Faults


def stability(
    config: Path | None = None,
    /,
    *,
    over: Annotated[list[str] | None, Parameter(negative=())] = None,
    between: Annotated[
        list[tuple[str, str]] | None, Parameter(negative=(), allow_leading_hyphen=True)
    ] = None,
    output: MaybeOutput = None,
    preset: FromPreset = None,
    trust: Trust = False,
    set: Changes = None,
) -> None:
    """Examine whether the apparatus of CONFIG slides steadily, and where this changes.

    Steady sliding is linearised: each mode of a small disturbance grows or decays. Where one
    begins to grow, an oscillation sets in, which is heard or seen as stick-slip. Weakening friction
    drives it; damping, and the turning of the friction vector with misalignment, suppress it.

    For example, with what `stiction init my.toml` writes: every critical misalignment and
    velocity, and a map of both; then the modes over the misalignment alone, at another speed:

        stiction stability my.toml -o map.png

        stiction stability my.toml --over phi --between "1 deg" "30 deg" --set V=2mm/s -o modes.png

    The drive of CONFIG must be steady, and the load constant.

    Parameters
    ----------
    config
        A description in TOML; `stiction init` writes one to start from. Its [run] is not used.
    over
        A parameter to vary: phi, V, c_x, mass, friction.mu_inf, ..., or several with one value
        ("k_x, k_y"). Repeat it for a second one; phi and V by default. Example: --over phi.
    between
        Its range, two values with their units; repeat it for a second one, in the same order. By
        default 0 to 90 degrees for an angle, -90 to 0 where it is below 0, else three decades below
        and above the value. Example: --between "1 deg" "30 deg".
    output
        The figure to write (.png, .pdf or .svg): the modes over one parameter, or the boundary of
        stability in the plane of two. Example: -o map.png.
    """
    from stiction.cli.tables import print_sections
    from stiction.linear_stability.examination import OVER
    from stiction.linear_stability.examination import stability as examine

    faults = Faults()
    given = changes(set, faults)
    with faults.of_part():
        slider = slider_from(config, preset, given, trust)
    paths, ranges = over or OVER, [tuple(map(number, each)) for each in between or []]
    if len(paths) > 2 or len(ranges) not in (0, len(paths)):
        counts = f"{len(paths)} and {len(ranges)}"
        with faults.of_part():
            raise CommandError(
                "give --over once or twice, and --between as often or not at all, not "
                f"{counts} times"
            )
    check_figure(output, faults)
    faults.refuse()
    found = examine(slider, paths, ranges or None)
    print_sections(str(config or preset), found.tables())
    if output is not None:
        write_figure(output, found.plot)


def number(text: str) -> Any:
    """Return a bare number (SI) as a number, other text as it is."""
    try:
        return float(text)
    except ValueError:
        return text
