"""Remedies for an apparatus: changes of its parameters, each tried in a simulation."""

from __future__ import annotations

from collections.abc import Iterator
from math import copysign, degrees, inf, isfinite, nan, radians, sqrt
from typing import NamedTuple

import numpy as np

from stiction.auditing.chain import softest_path
from stiction.auditing.prediction import predict
from stiction.auditing.simulated_test import LEAST_WORK, SLIDES, SimulatedTest, simulate_coarsely
from stiction.linear_stability import Critical, critical
from stiction.progress.report import Progress, part, silent
from stiction.system.parameter import change_parameter, quantity, read, unit
from stiction.system.slider import Slider
from stiction.system.springs import COMPLIANCES

# Steps beyond a critical value, relative to it: larger ones for an oscillation that persists
# although steady sliding is stable
BEYOND = (0.15, 0.5, 1.0, 2.0)
# Steps where steady sliding is stable but not reached from rest, so that there is no critical
# value: degrees more, shares of critical damping more, factors
MORE = {
    "phi": (2.0, 5.0, 10.0, 20.0, 40.0),
    "drive.velocity": (2.0, 4.0, 8.0, 16.0, 32.0),
    "c_x": (0.02, 0.05, 0.1, 0.25, 0.6, 1.5),
    "k_x": (2.0, 4.0, 8.0, 16.0, 32.0),
}
LEVERS = ("phi", "drive.velocity", "c_x", "k_x")  # of springs in series, the softest one's
MOST_TURNED = 80.0  # degrees: near a right angle the soft spring no longer acts along the drive
STRONGEST = 10.0  # times critical damping: the strongest damper tried
DIGITS = 2  # of advised values, if the margin is that wide: who turns a rig needs no more
OF_MARGIN = 0.2  # rounding takes at most this share of the distance to an unstable value
# A smaller value counts as this one in a factor of change, since a rig is aligned no better, and
# has that damping anyway: degrees, share of critical damping
ALIGNED, LIGHT = 1.0, 0.01


class Remedy(NamedTuple):
    """One parameter, its value for steady sliding, and the simulation with that value.

    Parameters
    ----------
    path, unit : str
        The parameter, and its SI unit.
    now : float
        Its value.
    critical : Critical or None
        The searched range, and where in it steady sliding is stable; None where it is stable now.
    then : float
        The advised value; NaN if there is none in the range.
    tried : SimulatedTest or None
        The simulation with the advised value.
    work : int
        Steps and samples of all simulations of this parameter.
    cut : bool
        Whether the limit of work was reached before all values were tried.
    """

    path: str
    unit: str
    now: float
    critical: Critical | None
    then: float = nan
    tried: SimulatedTest | None = None
    work: int = 0
    cut: bool = False

    @property
    def works(self) -> bool:
        """Whether the simulation from rest reaches steady sliding and remains there."""
        return holds(self.tried)

    @property
    def growth(self) -> float:
        """Growth rate of a small disturbance of steady sliding at the advised value, 1/s."""
        return self.tried.growth if self.tried else nan

    @property
    def factor(self) -> float:
        """The factor of change, see `change_factor`; infinite where nothing was tried."""
        if self.tried is None:
            return inf
        return change_factor(self.tried.run.slider, self.path, self.now, self.then)


def holds(tried: SimulatedTest | None) -> bool:
    """Return whether a simulation from rest reaches steady sliding and remains there."""
    if tried is None or not tried.run.status.ok:
        return False
    return tried.comes_to == SLIDES and tried.growth < 0.0


def advise(
    slider: Slider, misalignment: Critical | None, work: int, progress: Progress = silent
) -> Iterator[Remedy]:
    """Yield, for each parameter, the nearest value with steady sliding, tried from rest.

    If steady sliding is already stable, only not reached from rest, ever larger values are tried;
    `misalignment` is None then, else what `critical` finds of phi. `work` limits all simulations
    together, see `SimulatedTest.work`; each parameter passes the rest of its share on to the next.
    `progress` receives the fraction of parameters done.
    """
    paths = [softest_path(slider) if path == "k_x" else path for path in LEVERS]
    for number, path in enumerate(paths):
        report = part(progress, number, len(LEVERS))
        found = misalignment
        if found is not None and path != "phi":
            found = critical(slider, path, limits(slider, path))
        advice = advise_one(slider, path, found, work // (len(LEVERS) - number), report)
        work -= advice.work
        report(1.0)
        yield advice


def advise_one(
    slider: Slider, path: str, found: Critical | None, work: int, progress: Progress
) -> Remedy:
    """Return the nearest value of one parameter with steady sliding, tried from rest.

    `found` is its critical values, None where steady sliding is stable.
    """
    now = read(slider, path)
    advice = Remedy(path, unit(slider, path), now, found)
    if found is None:
        ways = list(further(slider, path))
    else:
        ways = [inside(found, nearest(found, now, beyond)) for beyond in BEYOND]
        if ways[0] == now:  # on the boundary at zero, of which no share leads away
            ways = list(further(slider, path))
    for number, then in enumerate(ways):
        if not isfinite(then) or then == advice.then:  # nowhere, or the middle again
            break
        left = work - advice.work
        if left < LEAST_WORK:
            return advice._replace(cut=True)
        changed = change_parameter(slider, path, quantity(slider, path, then))
        tried = try_change(changed, left, part(progress, number, len(ways)))
        advice = advice._replace(then=then, tried=tried, work=advice.work + tried.work)
        if advice.works:
            break
    return advice


def further(slider: Slider, path: str) -> Iterator[float]:
    """Yield ever larger values of a parameter."""
    now = read(slider, path)
    for more in MORE[lever(path)]:
        if path == "phi":
            then = now + copysign(radians(more), slider.misalignment)
            if abs(then) > radians(MOST_TURNED):
                continue
        elif path == "c_x":
            then = now + more * critical_damping(slider)
        else:
            then = now / more if is_compliance(path) else now * more
        yield few_digits(then, OF_MARGIN * abs(then - now), unit(slider, path))


def few_digits(value: float, off: float, unit: str) -> float:
    """Return a value rounded to the fewest digits, at least two, with an error of at most `off`.

    >>> few_digits(229.338, 30.0, "m/s"), few_digits(229.338, 0.1, "m/s")
    (230.0, 229.3)
    """
    shown = degrees(value) if unit == "rad" else value
    for digits in range(DIGITS, 17):
        rounded = float(f"{shown:.{digits}g}")
        rounded = radians(rounded) if unit == "rad" else rounded
        if abs(rounded - value) <= off:
            return rounded
    return value


def change_factor(slider: Slider, path: str, now: float, then: float) -> float:
    """Return the factor by which a change raises or lowers a parameter, at least 1.

    Angles count from the axis of the springs. Of a value near zero, see `ALIGNED`.
    """
    least = {"phi": radians(ALIGNED), "c_x": LIGHT * critical_damping(slider)}.get(path, 0.0)
    origin = slider.turn if path == "phi" else 0.0
    low, high = sorted(max(abs(value - origin), least) for value in (now, then))
    return high / low


def critical_damping(slider: Slider) -> float:
    """Return the critical damping of the mass on the soft spring, N s/m."""
    return 2.0 * sqrt(slider.k_x * slider.masses[0])


def is_compliance(path: str) -> bool:
    """Return whether a path names a spring's compliance."""
    return path.rpartition(".")[2] in COMPLIANCES


def lever(path: str) -> str:
    """Return the lever to which a path belongs."""
    return "k_x" if path.startswith("springs.") else path


def try_change(slider: Slider, most_steps: int, progress: Progress) -> SimulatedTest:
    """Return the simulation of a changed slider."""
    return simulate_coarsely(slider, predict(slider), most_steps, progress, multiscale="auto")


def limits(slider: Slider, path: str) -> tuple[float | str, float | str] | None:
    """Return the range of a parameter; None for the default range of `critical`."""
    if path == "c_x":
        return 0.0, max(STRONGEST * critical_damping(slider), 2.0 * slider.c_x)
    return None


def inside(found: Critical, value: float) -> float:
    """Return a stable value in few digits that keeps most of its distance to unstable values."""
    distance = np.min(np.abs(found.values - value), initial=inf)
    return few_digits(value, OF_MARGIN * float(distance), found.unit)


def nearest(found: Critical, now: float, beyond: float) -> float:
    """Return the value nearest to the present one that lies `beyond` a critical value.

    It lies in the stable stretch, by the share `beyond` of the critical value, but not past the
    middle of the stretch. It is NaN if sliding is stable nowhere.
    """
    best, distance = nan, inf
    for low, high, stable in found.stretches:
        edge, way = (low, 1) if now <= low else (high, -1)
        if stable and abs(edge - now) < distance and low < high:
            middle = 0.5 * (low + high)
            then = edge + way * beyond * abs(edge)
            best = min(then, middle) if way > 0 else max(then, middle)
            distance = abs(edge - now)
    return best
