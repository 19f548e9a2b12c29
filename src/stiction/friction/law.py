"""The interface of friction laws, with and without internal state.

Laws are NamedTuples with methods in plain Python, which the solver compiles: they may use
floats, tuples, `math` and the law's own fields. Their first argument is the law itself,
named ``law``; a user's function that they call must be compiled (`numba.njit`).

They must end for every argument, NaN included. Not even Ctrl-C ends a loop in compiled code: bound
each, as in ``for _ in range(50)``. Reading a law, and `stiction.testing.check_law`, find endless
loops only at the few speeds that they probe.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple, Protocol, Self, TypeGuard

import numpy as np

from stiction.arrays import Floats
from stiction.errors import DescriptionError

PLAUSIBLE = 5.0  # friction coefficient of solids: that of rubber reaches about 4

Vector = tuple[float, float]


class FrictionLaw(Protocol):
    """A set-valued law: at zero slip, friction balances the other forces up to a limit.

    The limit is ``coefficient(0)`` times the normal load, or ``mu_static`` times it if the law
    has such a field and it is larger.
    """

    @property
    def _fields(self) -> tuple[str, ...]: ...

    def _asdict(self) -> dict[str, Any]: ...

    def coefficient(law, v: float) -> float:
        """Return the friction coefficient at slip speed `v` >= 0 (m/s)."""

    def slope(law, v: float) -> float:
        """Return the derivative of the coefficient with respect to `v`, in s/m."""

    @classmethod
    def like(cls, static: float, kinetic: float, speed: float) -> Self:
        """Return a law of this kind that has the traits of another.

        `static` and `kinetic` are the friction coefficients at rest and in fast slip; `speed`
        (m/s) is the slip speed over which the one becomes the other. Optional: only comparisons
        need it.
        """


class Internal(NamedTuple):
    """An internal state of a law: its name in results, its unit, and its meaning."""

    name: str
    unit: str
    meaning: str


class StateLaw(Protocol):
    """A law with internal state: friction is a smooth function of slip, load and state.

    Vectors are (x, y) in the slider's principal axes; `state` is a tuple of floats, one for
    each of ``states()``.

    If friction varies over many decades of slip speed, a method ``grain(law, state)`` may return
    the slip speed (m/s) below which friction is proportional to it; above, the solver then works
    with the logarithm of the slip speed. By a method ``gradient(law, slip, load,
    state)`` it may give the derivatives of force x, y and of each state's change, a tuple for each
    of these, by slip x, y and each state; without it the solver takes differences, which is slower.
    """

    @property
    def _fields(self) -> tuple[str, ...]: ...

    def _asdict(self) -> dict[str, Any]: ...

    @staticmethod
    def states() -> tuple[Internal, ...]:
        """Return the names, units and meanings of the internal states."""

    def coefficient(law, v: float) -> float:
        """Return the friction coefficient of steady sliding at slip speed `v` (m/s)."""

    def settled(law, speed: float) -> tuple[float, ...]:
        """Return the default initial state, given the drive's speed."""

    def force(law, slip: Vector, load: float, state: tuple[float, ...]) -> Vector:
        """Return the friction force (N) at slip velocity `slip` (m/s) and normal load (N)."""

    @classmethod
    def like(cls, static: float, kinetic: float, speed: float) -> Self:
        """Return a comparable law of this kind; see `FrictionLaw.like`."""

    def change(law, slip: Vector, load: float, state: tuple[float, ...]) -> tuple[float, ...]:
        """Return the rate of change of each state, per second."""


Law = FrictionLaw | StateLaw


def has_state(law: Any) -> TypeGuard[StateLaw]:
    """Return whether a law has internal state."""
    own = getattr(law, "states", None)
    return own is not None and len(own()) > 0


def states(law: Any) -> tuple[Internal, ...]:
    """Return the internal states of a law, none for a set-valued law."""
    return tuple(Internal(*each) for each in getattr(law, "states", tuple)())


def static_coefficient(law: Any) -> float:
    """Return the largest friction coefficient at zero slip."""
    return max(float(getattr(law, "mu_static", 0.0)), float(law.coefficient(0.0)))


def implausible(law: Any) -> list[str]:
    """Return the implausible properties of a law, in sentences."""
    mu = static_coefficient(law)
    if mu <= PLAUSIBLE:
        return []
    return [
        f"The friction coefficient at rest is {mu:g}, where few are above {PLAUSIBLE:g}; if a "
        f"percentage is meant, write {mu / 100.0:g}."
    ]


def limit_coefficient(law: Any, friction: Floats, normal_load: Floats) -> float:
    """Return the friction limit at rest over the load; of a law with state, the largest in a run.

    `friction` and `normal_load` are samples of the run, in N. Zero if nothing rubs.
    """
    if not has_state(law):
        return static_coefficient(law)
    loaded = normal_load > 0.0
    return float(np.nanmax(friction[loaded] / normal_load[loaded], initial=0.0))


def static_fault(law: FrictionLaw) -> Iterator[tuple[str, str]]:
    """Check a law's separate static coefficient; yield field and message of a fault."""
    static, kinetic = float(getattr(law, "mu_static", 0.0)), law.coefficient(0.0)
    if 0.0 < static < kinetic:
        yield (
            "mu_static",
            f"must not be below the coefficient at vanishing slip speed, {kinetic:g}, "
            f"is {static:g}; leave it out to have no separate static coefficient",
        )


def refuse_strengthening(kind: str, static: float, kinetic: float) -> None:
    """Refuse to make a law that can only weaken comparable with one that does not.

    Raises
    ------
    DescriptionError
        If the kinetic coefficient is not below the static one.
    """
    if kinetic >= static:
        message = (
            f"cannot strengthen or stay, from {static:g} to {kinetic:g}; compare it at a "
            "kinetic coefficient below the static one"
        )
        raise DescriptionError.of(kind, message)
