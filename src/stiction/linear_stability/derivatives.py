"""Derivatives of friction and of a law's internal states by slip velocity and state."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from math import hypot, log, nan, sqrt
from typing import Any, NamedTuple

import numpy as np

from stiction.arrays import Floats
from stiction.system.slider import Slider
from stiction.system.tensors import surface_tensor

EPSILON = float(np.finfo(np.float64).eps)
SMALL = 4.0 * EPSILON  # relative rounding error after a few operations
NEIGHBOUR = 1e-9  # relative distance of neighbours; functions are linear but for rounding
FIRST_COLUMN, COLUMNS = 2, 6  # of Richardson's scheme: errors of order six to twelve in the step
RATIO = 2.0  # of successive steps
SHARE = 1.0 / 16.0  # error as a share of the last change; at sixth order, the next change is 1/64


class Response(NamedTuple):
    """Friction at a slip velocity, and its derivatives.

    Parameters
    ----------
    value : ndarray
        (2 + n,): friction (x, y; N), then the rates of change of the n internal states.
    slopes : ndarray
        (2 + n, 2 + n): their derivatives by the slip velocity (x, y; m/s) and the states.
    error : ndarray
        Estimated errors of `slopes`.
    """

    value: Floats
    slopes: Floats
    error: Floats


def set_valued(slider: Slider, slip: Floats) -> tuple[Floats, Floats]:
    """Return friction (N) and its slopes by slip (N s/m) from the ``slope`` of a set-valued law.

    With v = |s|, N = M^2 and q = |M s|, F = mu(v) W N s/q has

        dF/ds = W [mu' (N s) s^T/(q v) + mu (N/q - (N s)(N s)^T/q^3)],

    which for an isotropic surface is F'(V) n n^T + (F(V)/V) t t^T, n along the slip and t
    across it.
    """
    law: Any = slider.law
    (a, b), (_, d) = surface_tensor(slider).tolist()
    x, y = map(float, slip)
    v = hypot(x, y)
    push_x, push_y = a * x + b * y, b * x + d * y
    q = sqrt(x * push_x + y * push_y)
    friction = slider.normal_load * law.coefficient(v) / q
    along = slider.normal_load * law.slope(v) / (q * v)
    # (N s)(N s)^T/q^2 subtracted from N without cancellation: det(N)/q^2 t t^T
    across = friction * (a * d - b * b) / (q * q)
    mixed = across * x * y
    slopes = [
        [along * push_x * x + across * y * y, along * push_x * y - mixed],
        [along * push_y * x - mixed, along * push_y * y + across * x * x],
    ]
    return np.array([friction * push_x, friction * push_y]), np.array(slopes)


def response_of(slider: Slider, slip: Floats) -> Response:
    """Return the response of a set-valued law, with the errors of its slopes from rounding."""
    law: Any = slider.law
    value, slopes = set_valued(slider, slip)
    v, N = hypot(*slip), surface_tensor(slider)
    per = slider.normal_load * np.outer(N @ slip, slip) / (float(np.sqrt(slip @ N @ slip)) * v)
    along = law.slope(v) * per
    rounding = SMALL * (np.abs(along) + np.abs(slopes - along))
    return Response(value, slopes, rounding + noise(law.slope, v, v) * np.abs(per))


def with_state(slider: Slider, slip: Floats, state: Floats) -> Response:
    """Return the response of a law with internal state, by numerical differentiation."""
    response, at = answer_of(slider), np.concatenate([slip, state])
    columns = [derivative(response, at, i, *steps) for i, steps in enumerate(steps_of(at))]
    slopes, error = (np.column_stack(part) for part in zip(*columns, strict=True))
    return Response(np.array(response(at.tolist()), dtype=np.float64), slopes, error)


def by_gradient(slider: Slider, slip: Floats, state: Floats) -> Response:
    """Return the response from a law's own ``gradient``, with the errors of rounding."""
    law: Any = slider.law
    at = np.concatenate([slip, state])
    where = tuple(at[:2].tolist()), slider.normal_load, tuple(at[2:].tolist())
    value = np.array([*law.force(*where), *law.change(*where)], dtype=np.float64)
    slopes = np.array(law.gradient(*where), dtype=np.float64)
    # what rounds is as large as each unknown's share of a value, also where all add up to nothing
    sizes = np.where(np.abs(at) > SMALL, np.abs(at), 1.0)
    sizes[:2] = hypot(*slip)
    terms = np.abs(value) + np.abs(slopes) @ sizes
    return Response(value, slopes, SMALL * terms[:, None] / sizes)


def answer_of(slider: Slider) -> Callable[[list[float]], Sequence[float]]:
    """Return friction (N) and the rates of the states as a function of slip and states."""
    law: Any = slider.law
    load = slider.normal_load

    def response(at: list[float]) -> Sequence[float]:
        where = (at[0], at[1]), load, tuple(at[2:])
        return *law.force(*where), *law.change(*where)

    return response


def steps_of(at: Floats) -> Iterator[tuple[float, float]]:
    """Yield the widest and the narrowest step for the derivative by each slip velocity and state.

    A state's steps are from about one, or the state's own size if larger, down to far below it;
    the rounding error of a logarithm, ln 1, does not count as a size.
    """
    speed = hypot(*at[:2])
    yield from [(0.5 * speed, 2.0**-9 * speed)] * 2
    for size in np.abs(at[2:]).tolist():
        yield 0.5 * max(size, 1.0), 2.0**-13 * (size if size > SMALL else 1e-4)


def derivative(
    function: Callable[[list[float]], Sequence[float] | Floats],
    at: Floats,
    i: int,
    widest: float,
    narrowest: float,
) -> tuple[Floats, Floats]:
    """Return the derivative of a vector function by variable `i`, and its estimated error.

    Central differences over ever shorter steps, from `widest` to about `narrowest`, are
    extrapolated to a step of zero (Ridders, Adv. Eng. Software 4 (1982), 75). Each component takes
    the extrapolation with the smallest error, which is estimated as a share of the last change plus
    rounding. Steps at which the function is undefined are skipped.
    """
    others, here = at.tolist(), float(at[i])

    def along(x: float) -> Sequence[float] | Floats:
        return function([*others[:i], x, *others[i + 1 :]])

    steps = widest * RATIO ** -np.arange(np.ceil(log(widest / narrowest, RATIO)) + 1.0)
    values = [
        (value_or_nan(along, here + h, len(at)), value_or_nan(along, here - h, len(at)))
        for h in steps.tolist()
    ]
    ahead, behind = np.array(values, dtype=np.float64).transpose(1, 0, 2)
    h = 0.5 * ((at[i] + steps) - (at[i] - steps))[:, None]  # as rounded
    table = (ahead - behind) / (2.0 * h)
    doubt = SMALL * (np.abs(ahead) + np.abs(behind)) / h
    near = noise(along, here, narrowest)
    doubt += 2.0 * near / h
    found, errors = [], []
    for column in range(1, COLUMNS):
        coarse, fine, doubt = table[:-1], table[1:], doubt[1:]
        table = fine + (fine - coarse) / (RATIO ** (2 * column) - 1.0)
        if column < FIRST_COLUMN:
            continue
        found.append(table[1:])
        errors.append(np.abs(np.diff(table, axis=0)) * SHARE + doubt[1:])
    every, error = np.concatenate(found), np.concatenate(errors)
    error = np.where(np.isfinite(error), error, np.inf)
    best = np.argmin(error, axis=0)[None, :]
    return np.take_along_axis(every, best, 0)[0], np.take_along_axis(error, best, 0)[0]


def noise(function: Callable[[float], Any], at: float, scale: float) -> Any:
    """Return the rounding error of a smooth function near a point.

    Second differences over steps far below the function's scale contain nothing else.
    """
    values = [function(at + step * NEIGHBOUR * scale) for step in range(-4, 5)]
    return np.abs(np.diff(values, 2, axis=0)).max(axis=0)


def value_or_nan(
    function: Callable[[float], Sequence[float] | Floats], x: float, size: int
) -> Sequence[float] | Floats:
    """Return the value of a function; NaN where a user's law raises an error."""
    try:
        return function(x)
    except (ArithmeticError, ValueError):
        return [nan] * size
