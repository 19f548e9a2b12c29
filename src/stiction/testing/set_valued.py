"""Checks of a set-valued law: its coefficient and slope."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Any
from warnings import catch_warnings, simplefilter

from stiction.friction.law import static_coefficient
from stiction.friction.user.derivative import derivative
from stiction.testing.common import LIBRARY_ROUNDING, attempt, fault_of, first, run_compiled


def finite(law: Any, speeds: Sequence[float]) -> Iterator[str]:
    """Check that coefficient and slope are finite."""
    for name in ("coefficient", "slope"):
        values = ((v, fault_of(*attempt(getattr(law, name), v))) for v in speeds)
        yield from first(f"{name}({v:g}) {fault}" for v, fault in values if fault)


def dissipative(law: Any, speeds: Sequence[float]) -> Iterator[str]:
    """Check that friction dissipates: the coefficient is not negative, and not zero at rest."""
    values = ((v, attempt(law.coefficient, v)[0]) for v in speeds)
    yield from first(
        f"coefficient({v:g}) must not be negative, is {mu:g}: friction would push the mass on"
        for v, mu in values
        if mu < 0.0
    )


def slope(law: Any, speeds: Sequence[float]) -> Iterator[str]:
    """Check that the slope is the derivative of the coefficient."""
    found = []
    for v in speeds:
        given, fault = attempt(law.slope, v)
        wanted, error = derivative(lambda at: attempt(law.coefficient, at)[0], v)
        if not fault and abs(given - wanted) > error + 1e-9 * abs(given):
            found.append(
                f"slope({v:g}) is {given:.10g} s/m, but the coefficient changes by {wanted:.10g} "
                f"s/m, within {error:.1g}; let it return d(coefficient)/dv"
            )
    yield from first(found)


def continuous(law: Any, speeds: Sequence[float]) -> Iterator[str]:
    """Check that the coefficient has no jump: it changes by the integral of its slope."""
    from scipy.integrate import quad

    found = []
    for low, high in pairwise(sorted(speeds)):
        change = attempt(law.coefficient, high)[0] - attempt(law.coefficient, low)[0]
        with catch_warnings():
            simplefilter("ignore")  # that it is hard to integrate shows in the error
            total, error = quad(lambda v: attempt(law.slope, v)[0], low, high, limit=200)
        if abs(change - total) > 10.0 * error + 1e-6 * abs(attempt(law.coefficient, high)[0]):
            found.append(
                f"coefficient changes by {change:.6g} from {low:g} to {high:g} m/s, but the "
                f"integral of slope there is {total:.6g}: it jumps; smooth the jump over a speed"
            )
    yield from first(found)


def check_compiled(law: Any, speeds: Sequence[float]) -> Iterator[str]:
    """Check that compiled results equal Python's."""
    from stiction.solver import problem

    for function in (problem.coefficient, problem.slope):
        name = function.__name__
        python = [attempt(getattr(law, name), v)[0] for v in speeds]
        machine, reasons = run_compiled(law, function, ((v,) for v in speeds))
        yield from reasons
        scale = max(map(abs, python))
        yield from first(
            f"{name}({v:g}) is {one!r} in Python and {other!r} compiled"
            for v, one, other in zip(speeds, python, machine, strict=bool(machine))
            if abs(one - other) > LIBRARY_ROUNDING * scale
        )


def comparable(law: Any, speeds: Sequence[float]) -> Iterator[str]:
    """Check that `like`, if any, returns the requested static coefficient."""
    if not hasattr(law, "like"):
        return
    made = type(law).like(0.2, 0.15, 0.01)
    static = static_coefficient(made)
    if abs(static - 0.2) > 1e-12:
        yield f"like(0.2, 0.15, 0.01) has the static coefficient {static:g}, not 0.2"


SET_VALUED = {
    "finite": finite,
    "dissipative": dissipative,
    "slope": slope,
    "continuous": continuous,
    "compiled": check_compiled,
    "comparable": comparable,
}
