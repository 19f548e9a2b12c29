"""Checks of a law with internal state: its force, its rates, and steady sliding."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from math import cos, hypot, isfinite, sin
from typing import Any, NamedTuple

from stiction.friction import states
from stiction.friction.law import Vector
from stiction.testing.common import (
    LIBRARY_ROUNDING,
    attempt,
    error_line,
    fault_of,
    first,
    run_compiled,
)

LOADS = (1.0, 100.0)  # N
DIRECTIONS = (0.0, 2.5)  # rad
STEADY = (1e-6, 1e-4, 1e-2, 1.0)  # m/s, where steady sliding is computed
SLOWEST = 1e-9  # m/s, of the state for checks at zero slip
FORGOTTEN = 1.0  # m of slip, after which any friction has settled
OFF = 1.37
APART = 1e-5  # of a slip speed or a state: central differences are off by its square
SLOPE = 1e-5  # relative: how well derivatives agree with them
SETTLED = 1e-4  # relative: how well friction after that slip is the steady one


class LawPoint(NamedTuple):
    """A point at which a law is checked: slip velocity (m/s) and normal load (N)."""

    slip: Vector
    load: float

    def __str__(self) -> str:
        """Return the point as part of a message."""
        return f"at slip ({self.slip[0]:g}, {self.slip[1]:g}) m/s and load {self.load:g} N"


def points(speeds: Sequence[float]) -> Iterator[LawPoint]:
    """Yield all combinations of speed, direction and load."""
    for v in speeds:
        for angle in DIRECTIONS:
            for load in LOADS:
                yield LawPoint((v * cos(angle), v * sin(angle)), load)


def finite(law: Any, speeds: Sequence[float]) -> Iterator[str]:
    """Check that force, change and coefficient are finite and have the right length."""
    n = len(states(law))
    values = ((v, fault_of(*attempt(law.coefficient, v))) for v in speeds if v > 0.0)
    yield from first(f"coefficient({v:g}) {fault}" for v, fault in values if fault)
    yield from first(_settled_faults(law, speeds))
    for name, length in (("force", 2), ("change", n)):
        found = []
        for point in points(speeds):
            fault = _vector_fault(law, getattr(law, name), point, length)
            found += [f"{name} {point} {fault}"] if fault else []
        yield from first(found)


def _settled_faults(law: Any, speeds: Sequence[float]) -> Iterator[str]:
    """Yield speeds without a valid initial state; a drive may be at rest."""
    n = len(states(law))
    for v in speeds:
        try:
            state = tuple(map(float, law.settled(v)))
        except Exception as error:
            yield f"settled({v:g}) raises {error_line(error)}; it must be a state to start from"
            continue
        if len(state) != n or not all(map(isfinite, state)):
            yield f"settled({v:g}) is {state}; it must be {n} finite numbers, as states() names"


def _vector_fault(law: Any, function: Callable[..., Any], point: LawPoint, length: int) -> str:
    try:
        value = tuple(map(float, function(*point, _steady_state(law, point))))
    except Exception as error:
        return f"raises {error_line(error)}"
    if len(value) != length:
        return f"has {len(value)} components, must have {length}"
    return "" if all(map(isfinite, value)) else f"is {value}; it must be finite"


def _steady_state(law: Any, point: LawPoint) -> tuple[float, ...]:
    state: tuple[float, ...] = law.settled(max(hypot(*point.slip), SLOWEST))
    return state


def dissipative(law: Any, speeds: Sequence[float]) -> Iterator[str]:
    """Check that steady sliding dissipates as much as the steady coefficient says."""
    found = []
    for point in points([v for v in STEADY if min(speeds) <= v <= max(speeds)]):
        v = hypot(*point.slip)
        try:
            f = law.force(*point, steady_state(law, point))
        except Exception as error:
            found.append(f"{point} it comes to no steady sliding, {error_line(error)}")
            continue
        along = (f[0] * point.slip[0] + f[1] * point.slip[1]) / (v * point.load)
        wanted = attempt(law.coefficient, v)[0]
        if along < 0.0:
            found.append(f"{point} friction drives: its component along the slip is {along:g} W")
        elif not abs(along - wanted) <= SETTLED * abs(wanted):
            found.append(f"{point} steady friction is {along:g} W, but coefficient says {wanted:g}")
    yield from first(found)


def steady_state(law: Any, point: LawPoint) -> tuple[float, ...]:
    """Return the state after a metre of steady slip."""
    from scipy.integrate import solve_ivp

    v = hypot(*point.slip)
    done = solve_ivp(
        lambda _, state: law.change(*point, tuple(map(float, state))),
        (0.0, FORGOTTEN / v),
        law.settled(v),
        method="Radau",
        rtol=1e-7,
        atol=1e-14,
    )
    if not done.success:
        raise ArithmeticError(done.message)
    return tuple(map(float, done.y[:, -1]))


def derivatives(law: Any, speeds: Sequence[float]) -> Iterator[str]:
    """Check that `gradient`, if any, contains the derivatives of force and change."""
    if not hasattr(law, "gradient"):
        return
    found = []
    for point in points([v for v in STEADY if min(speeds) <= v <= max(speeds)]):
        try:
            state = tuple(OFF * each for each in steady_state(law, point))
            rows = law.gradient(*point, state)
        except Exception as error:
            found.append(f"gradient {point} raises {error_line(error)}")
            continue
        wanted = _differences(law, point, state)
        if [len(row) for row in rows] != [len(row) for row in wanted]:
            found.append(f"gradient {point} must be {len(wanted)} rows of {len(wanted)} numbers")
            continue
        for one, other in zip(rows, wanted, strict=True):
            units = [hypot(*point.slip)] * 2 + [abs(each) for each in state]
            parts = [(a * u, b * u) for a, b, u in zip(one, other, units, strict=True)]
            scale = max(abs(b) for _, b in parts)
            if not all(abs(a - b) <= SLOPE * scale for a, b in parts):
                found.append(f"gradient {point} has the row {one}, differences give {other}")
    yield from first(found)


def _differences(law: Any, point: LawPoint, state: tuple[float, ...]) -> list[list[float]]:
    """Return the rows of `gradient` by central differences."""
    v = hypot(*point.slip)

    def flow(x: Sequence[float]) -> list[float]:
        where = (x[0], x[1]), point.load, tuple(x[2:])
        return [*law.force(*where), *law.change(*where)]

    columns = []
    for k, value in enumerate((*point.slip, *state)):
        step = APART * (v if k < 2 else max(abs(value), 1e-3))
        ahead, behind = ([*point.slip, *state] for _ in range(2))
        ahead[k], behind[k] = value + step, value - step
        columns.append(
            [(a - b) / (2.0 * step) for a, b in zip(flow(ahead), flow(behind), strict=True)]
        )
    return [list(row) for row in zip(*columns, strict=True)]


def check_compiled(law: Any, speeds: Sequence[float]) -> Iterator[str]:
    """Check that compiled results equal Python's."""
    from stiction.solver import problem

    at = [*points(speeds)]
    # apart from steady sliding, where a change of zero would be all rounding
    inputs = [(*point, tuple(OFF * each for each in _steady_state(law, point))) for point in at]
    for function in (problem.force, problem.change):
        name = function.__name__
        python = [getattr(law, name)(*each) for each in inputs]
        machine, reasons = run_compiled(law, function, inputs)
        yield from reasons
        yield from first(
            f"{name} {point} is {one} in Python and {other} compiled"
            for point, one, other in zip(at, python, machine, strict=bool(machine))
            if not all(
                abs(a - b) <= LIBRARY_ROUNDING * hypot(*one)
                for a, b in zip(one, other, strict=True)
            )
        )


WITH_STATE = {
    "finite": finite,
    "dissipative": dissipative,
    "derivatives": derivatives,
    "compiled": check_compiled,
}
