"""``stiction stability``: is steady sliding stable, and where does that change?"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import degrees
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from stiction.linear_stability import Critical, Linearisation
    from stiction.slider import Slider

OVER = ("phi", "drive.velocity")
DEFAULT = (None, None)
Ends = Sequence[float | str]


def stability(
    config: Path,
    /,
    *,
    over: Annotated[list[str] | None, Parameter(negative=())] = None,
    between: Annotated[
        list[tuple[str, str]] | None, Parameter(negative=(), allow_leading_hyphen=True)
    ] = None,
    output: Annotated[Path | None, Parameter(alias="-o")] = None,
) -> None:
    """Say whether the apparatus of CONFIG slides steadily, and at which parameters that changes.

    Steady sliding is linearised: each mode of a small disturbance grows or decays. Where one
    begins to grow, an oscillation sets in; in simulations it is what one hears or sees as
    stick-slip. Weakening friction drives it; damping, and the turning of the friction vector
    with misalignment, hold it back.

    For example, with what `stiction init my.toml` writes: every critical misalignment and
    velocity, and a map of both; then the modes over the misalignment alone:

        stiction stability my.toml -o map.png

        stiction stability my.toml --over phi --between "1 deg" "30 deg" -o modes.png

    The drive of CONFIG must be steady, and the load constant.

    Parameters
    ----------
    config
        A description in TOML; `stiction init` writes one to start from. Its [run] is not used.
    over
        A parameter to vary: phi, drive.velocity, c_x, mass, friction.mu_inf, ..., or several
        with one value ("k_x, k_y"). Repeat it for a second one; phi and drive.velocity when left
        out.
    between
        Its range, two values with their units; repeat it for a second one, in the same order.
        When left out 0 to 90 degrees for an angle, three decades either way for all else.
    output
        The figure to write (.png, .pdf or .svg): the modes over one parameter, or the boundary
        of stability in the plane of two.
    """
    from rich.console import Console

    from stiction.errors import StictionError
    from stiction.linear_stability import critical, steady_sliding
    from stiction.plotting.save import drawable, write
    from stiction.slider import Slider

    slider = Slider.from_toml(config)
    paths = list(over or OVER)
    ranges = [tuple(map(number, each)) for each in between or []]
    if len(paths) > 2 or len(ranges) not in (0, len(paths)):
        counts = f"{len(paths)} and {len(ranges)}"
        raise StictionError(
            f"give --over once or twice, and --between as often or not at all, not {counts} times"
        )
    if output is not None:
        drawable(output)
    found = [critical(slider, *each) for each in zip(paths, ranges or DEFAULT, strict=False)]
    console = Console(soft_wrap=True, highlight=False)
    criticals = [line for each in found for line in said(each)]
    for line in (*modes(steady_sliding(slider)), "", *criticals):
        console.print(line, markup=False)
    if output is not None:
        console.print(f"wrote {write(figure(slider, paths, ranges, found), output)}", markup=False)


def figure(
    slider: Slider, paths: Sequence[str], ranges: Sequence[Ends], found: Sequence[Critical]
) -> Figure:
    """Return the modes over one parameter, or the map of two."""
    from stiction.linear_stability import boundary, modes_over
    from stiction.plotting.modes import modes_figure
    from stiction.plotting.stability import stability_map

    if len(paths) == 1:
        between = ranges[0] if ranges else None
        return modes_figure(modes_over(slider, paths[0], between), found[0])
    x_between, y_between = ranges or DEFAULT
    x, y = paths
    return stability_map(boundary(slider, x, y, x_between=x_between, y_between=y_between))


def modes(linear: Linearisation) -> Iterator[str]:
    """Yield the verdict, and a line for each mode; of a conjugate pair one."""
    verdict = "stable: every" if linear.stable else "not stable: not every"
    yield f"steady sliding is {verdict} small disturbance decays"
    yield ""
    yield "growth rate (1/s)  frequency (Hz)  damping ratio"
    yield "-----------------  --------------  -------------"
    for value, f, zeta in zip(
        linear.eigenvalues, linear.frequencies, linear.damping_ratios, strict=True
    ):
        if value.imag >= 0.0:
            yield f"{value.real:<17.6g}  {f:<14.6g}  {zeta:.4g}"


def said(found: Critical) -> Iterator[str]:
    """Yield where stability changes along a parameter."""
    low, high = (written(end, found.unit) for end in found.between)
    names = ["stable" if each else "not stable" for each in found.stable]
    if not len(found.values):
        yield f"{found.path}: {names[0]} from {low} to {high}"
        return
    yield f"{found.path}, from {low} to {high}: {names[0]}"
    for value, frequency, name in zip(found.values, found.frequencies, names[1:], strict=True):
        yield f"  {name} above {written(value, found.unit)} (oscillating at {frequency:.4g} Hz)"


def number(text: str) -> float | str:
    """Return a bare number as such: it is in SI, as in a description."""
    try:
        return float(text)
    except ValueError:
        return text


def written(value: float, unit: str) -> str:
    """Return a value in SI with its unit; an angle in degrees."""
    if unit == "rad":
        return f"{degrees(value):.6g} deg"
    return f"{value:.6g} {unit}".strip()
