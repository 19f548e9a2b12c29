"""The cases: velocity steps, slide-hold-slide and stick-slip, of laws with state; constants in SI.

Nothing but NumPy is imported here: a peer may live in an interpreter that has no more.

A quasi-static case has two unknowns, ``(ln V/V*, ln V* theta/D_c)``; with inertia the spring force
comes first, ``(k u, ln V/V*, ln V* theta/D_c)``; LuGre has ``(k u, s/v_s, sigma_0 z)``. All are of
order one, so that one absolute tolerance suits them all.
"""

from __future__ import annotations

from collections.abc import Callable
from math import log
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from benchmarks.precision import case as fig_3

Floats = NDArray[np.float64]
Piece = tuple[float, float]  # duration (s) and drive velocity (m/s)

UM = 1e-6
SLOW = 10 * UM  # m/s; V*
AGEING, SLIP, LUGRE, SMOOTHED = "ageing", "slip law", "LuGre", "smoothed"
STEPS, HOLDS, UNSTABLE, FIG_3 = "velocity steps", "slide-hold-slide", "stick-slip", "Fig. 3"
INERTIA = " with inertia"


class RateState(NamedTuple):
    """Rate-and-state friction (see `stiction.laws.RateStateAgeing`) under 1 N."""

    a: float = 0.010
    b: float = 0.015
    D_c: float = 10 * UM
    mu_star: float = 0.6
    V_star: float = SLOW


class Bristles(NamedTuple):
    """LuGre friction (Canudas de Wit et al. 1995, Table I) under 1 N."""

    mu_c: float = 1.0
    mu_s: float = 1.5
    v_s: float = 1e-3
    sigma_0: float = 1e5
    sigma_1: float = 1e5**0.5
    sigma_2: float = 0.4


class Smoothing(NamedTuple):
    """Set-valued friction of Fig. 3, smoothed over delta, m/s."""

    delta: float


class Case(NamedTuple):
    """A system and what is done to it.

    Attributes
    ----------
    test, kind : str
        What is done, and the law.
    law : RateState, Bristles or Smoothing
        Its parameters.
    k, mass : float
        N/m, kg; a mass of 0 stands for quasi-static motion.
    pieces : tuple of Piece
        The drive, from jump to jump.
    rate : float
        Samples a second, for errors.
    """

    test: str
    kind: str
    law: RateState | Bristles | Smoothing
    k: float
    mass: float
    pieces: tuple[Piece, ...]
    rate: float

    @property
    def name(self) -> str:
        """How rows and tables call it."""
        end = f" {self.law.delta:g}" if isinstance(self.law, Smoothing) else ""
        return f"{self.test}, {self.kind}{end}"

    @property
    def model(self) -> str:
        """Which equations it has."""
        inertia = isinstance(self.law, RateState) and self.mass > 0.0
        return self.kind + (INERTIA if inertia else "")

    @property
    def duration(self) -> float:
        """How long it lasts, s."""
        return sum(duration for duration, _ in self.pieces)

    @property
    def times(self) -> Floats:
        """Where solutions are compared, s."""
        return np.linspace(0.0, self.duration, round(self.duration * self.rate) + 1)

    def parameters(self, velocity: float) -> Floats:
        """Return the parameters of the equations at a drive velocity (m/s)."""
        if isinstance(self.law, Smoothing):
            return np.array([*fig_3.drive(), self.law.delta])
        return np.array([*self.law, self.k, self.mass, velocity])

    def start(self) -> Floats:
        """Return the unknowns at the start: steady sliding, or LuGre's rest with a slack spring."""
        if isinstance(self.law, Bristles):
            return np.zeros(3)
        if isinstance(self.law, Smoothing):
            return fig_3.initial_state()
        x = log(self.pieces[0][1] / self.law.V_star)
        mu = self.law.mu_star + (self.law.a - self.law.b) * x
        return np.array([x, -x] if self.mass == 0.0 else [mu, x, -x])

    def observables(self, y: Floats) -> Floats:
        """Return spring force (N) and state (1; N for bristles), (n, 2); of Fig. 3 both forces."""
        if isinstance(self.law, RateState) and self.mass == 0.0:
            mu = self.law.mu_star + self.law.a * y[:, 0] + self.law.b * y[:, 1]
            return np.stack([mu, y[:, 1]], axis=1)
        if isinstance(self.law, Smoothing):
            return fig_3.spring_force(y[:, :2])
        return y[:, [0, 2]]


def at_distance(*velocities: float, distance: float = 200 * UM) -> tuple[Piece, ...]:
    """Return a velocity-step test with the same distance at each speed."""
    return tuple((distance / v, v) for v in velocities)


def with_holds(velocity: float, slide: float, *holds: float) -> tuple[Piece, ...]:
    """Return slide-hold-slide."""
    pieces = [(slide, velocity)]
    for hold in holds:
        pieces += [(hold, 0.0), (slide, velocity)]
    return tuple(pieces)


ROCK_STEPS = at_distance(1 * UM, 10 * UM, 1 * UM, 100 * UM, 10 * UM)
ROCK_HOLDS = with_holds(SLOW, 20.0, 1.0, 10.0, 100.0, 1000.0)
STIFF, SOFT = 1e3, 300.0  # N/m; twice and 0.6 of the critical (b - a) W/D_c
STIFFEST = 1e4  # N/m; with the slip law a large step makes a less stiff spring unstable
SHAKEN = ((10.0, 0.5 * SLOW), (90.0, SLOW))  # steady sliding would stay so for ever
INERTIA_OVER_DIRECT_EFFECT = (
    1e-12  # m V^2/(a W D_c) of a quasi-static case, for a solver that needs mass
)
EARLY = 1e-12  # a sum of durations, by rounding

CASES = (
    Case(STEPS, AGEING, RateState(), STIFF, 0.0, ROCK_STEPS, 100.0),
    Case(STEPS, SLIP, RateState(), STIFFEST, 0.0, ROCK_STEPS, 100.0),
    Case(
        STEPS, LUGRE, Bristles(), 1e3, 1.0,
        at_distance(0.01, 0.1, 0.02, 0.2, distance=0.1), 200.0,
    ),
    Case(HOLDS, AGEING, RateState(), STIFF, 0.0, ROCK_HOLDS, 20.0),
    Case(HOLDS, SLIP, RateState(), STIFFEST, 0.0, ROCK_HOLDS, 20.0),
    Case(HOLDS, LUGRE, Bristles(), 1e3, 1.0, with_holds(0.01, 1.0, 1.0, 10.0, 100.0), 100.0),
    Case(UNSTABLE, AGEING, RateState(), SOFT, 1e-3, SHAKEN, 200.0),
    Case(UNSTABLE, SLIP, RateState(), SOFT, 1e-3, SHAKEN, 200.0),
    Case(UNSTABLE, LUGRE, Bristles(), 2.0, 1.0, ((25.0, 0.1),), 200.0),
    Case(FIG_3, SMOOTHED, Smoothing(1e-7), 1e3, 0.25, ((5.0, 1e-3),), 1000.0),
    Case(FIG_3, SMOOTHED, Smoothing(1e-9), 1e3, 0.25, ((5.0, 1e-3),), 1000.0),
)  # fmt: skip


def in_pieces(case: Case, times: Floats, advance: Callable[[Floats, Floats, Floats], Floats]):
    """Return force and state at the times, starting anew at each jump of the drive.

    `advance(y, t, parameters)` returns the unknowns at the times t of a piece, its start and end
    among them.
    """
    y, t = case.start(), 0.0
    found = [y[None]]
    for duration, velocity in case.pieces:
        end = min(t + duration, times[-1])
        if times[-1] - end < EARLY * times[-1]:
            end = times[-1]
        inside = times[(times > t) & (times < end)]
        rows = advance(y, np.array([t, *inside, end]), case.parameters(velocity))
        y, t = rows[-1], end
        found.append(rows[1:] if end in times else rows[1:-1])
        if end == times[-1]:
            break
    return case.observables(np.concatenate(found))
