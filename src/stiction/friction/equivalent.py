"""Traits that comparable laws share: friction at rest, in fast slip, and in between."""

from __future__ import annotations

from math import exp
from typing import Any, NamedTuple

import numpy as np

from stiction.errors import DescriptionError
from stiction.friction.law import Law, has_state, static_coefficient

CHANGED = 1.0 - exp(-1.0)
EQUAL = 1e-9  # relative difference of coefficients that are the same
ABRUPT = 1e-3  # of the fastest slip: the speed of a change that is abrupt


class Traits(NamedTuple):
    """Friction coefficients at rest and in fast slip, and the speed that lies between.

    Parameters
    ----------
    static, kinetic : float
        Coefficient at rest; the smallest within reach of slip, or for a law that never falls below
        the one at rest the largest.
    speed : float
        Slip speed at which the coefficient has made 1 - 1/e of the change, m/s.
    """

    static: float
    kinetic: float
    speed: float


def traits(law: Law, drive: float, fastest: float) -> Traits:
    """Return the traits that another law must share with `law` to be comparable.

    Only slip speeds that the apparatus can reach count. For a law that weakens and then
    strengthens, the minimum counts. A law with internal state may have no coefficient at rest;
    steady sliding at a thousandth of the drive's speed replaces it.

    Parameters
    ----------
    law : Law
        Any friction law.
    drive : float
        Speed of the drive, m/s.
    fastest : float
        Largest slip speed that counts, m/s.

    Raises
    ------
    DescriptionError
        If the coefficient is not finite within these speeds.
    """
    slowest = ABRUPT * (drive or fastest) if has_state(law) else 1e-9 * fastest
    speeds = np.geomspace(slowest, fastest, 2001)
    mu = np.array([law.coefficient(float(speed)) for speed in speeds])
    static = float(mu[0]) if has_state(law) else static_coefficient(law)
    if not np.isfinite([*mu, static]).all():
        rule = f"its coefficient is not finite between {slowest:.3g} and {fastest:.3g} m/s"
        raise DescriptionError.of("law", f"{rule}; correct {type(law).__name__}")
    weakens = float(mu.min()) < static * (1.0 - EQUAL)
    end = int(mu.argmin() if weakens else mu.argmax())
    kinetic = float(mu[end])
    if abs(kinetic - static) <= EQUAL * static:
        return Traits(static, static, drive or fastest)
    done = (mu[: end + 1] - static) / (kinetic - static)
    first = int((done >= CHANGED).argmax())
    if first == 0:
        return Traits(static, kinetic, ABRUPT * fastest)
    around = slice(first - 1, first + 1)
    return Traits(static, kinetic, float(np.interp(CHANGED, done[around], speeds[around])))


def like(kind: Any, shared: Traits) -> Law:
    """Return the law of a `kind` with the given traits.

    Raises
    ------
    DescriptionError
        If there is none, with the remedy.
    """
    required = [name for name in kind._fields if name not in kind._field_defaults]
    remedy = f"write a table with its parameters: {', '.join(required)}"
    if not hasattr(kind, "like"):
        message = f"takes no parameters from another law; {remedy}"
        raise DescriptionError.of("law", message)
    try:
        made: Law = kind.like(*(float(f"{value:.4g}") for value in shared))  # as written
    except (ArithmeticError, ValueError) as error:
        wanted = f"{shared.static:.4g} at rest, {shared.kinetic:.4g} in fast slip"
        message = f"cannot be given friction coefficients {wanted} ({error}); {remedy}"
        raise DescriptionError.of("law", message) from None
    return made
