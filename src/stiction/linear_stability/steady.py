"""Steady sliding: slip velocity, steady internal states, and friction."""

from __future__ import annotations

from math import hypot
from typing import Any

import numpy as np

from stiction.arrays import Floats
from stiction.drive import drive_stretches, load_stretches
from stiction.errors import DescriptionError, Fault, StictionError
from stiction.friction import has_state
from stiction.linear_stability.derivatives import Response, set_valued, with_state
from stiction.system.slider import Slider

SETTLED = 1e-9  # largest relative error of friction from unsteady internal states
STEADY = "this needs a steady drive and load; remove the program"


def drive_velocity(slider: Slider) -> Floats:
    """Return the slip velocity of steady sliding (x, y; m/s)."""
    found = []
    drives, loads = drive_stretches(slider.motion), load_stretches(slider.normal_load, slider.load)
    X, Y = slider.motion.rate(0.0)
    if len(drives) > 1 or not drives[0][1].steady():
        found.append(Fault("drive", f"is not steady; {STEADY}, or drive=st.ConstantVelocity(...)"))
    elif X == Y == 0.0:
        found.append(Fault("drive.velocity", "is zero: nothing slides; give it a velocity"))
    if len(loads) > 1 or not loads[0][1].constant():
        found.append(Fault("load", f"is not constant; {STEADY}, or load=None"))
    if found:
        raise DescriptionError(found)
    c, s = slider.direction
    return np.array([X * c - Y * s, X * s + Y * c])


def steady_friction(slider: Slider, slip: Floats) -> tuple[Floats, Response]:
    """Return the steady internal states, none for a set-valued law, and the response."""
    law: Any = slider.law
    if not has_state(law):
        return np.zeros(0), set_valued(slider, slip)
    from scipy.optimize import root

    def change(state: Floats) -> Floats:
        where = (float(slip[0]), float(slip[1])), slider.normal_load, tuple(map(float, state))
        return np.array(law.change(*where), dtype=np.float64)

    start = law.settled(hypot(*slip))
    state: Floats = root(change, start, tol=1e-13).x  # type: ignore[no-untyped-call]
    response = with_state(slider, slip, state)
    # do not trust the root finder's verdict: how much would another Newton step change friction?
    F, (F_z, G_z) = response.value, (response.slopes[:2, 2:], response.slopes[2:, 2:])
    try:
        left = F_z @ np.linalg.solve(G_z, F[2:])
    except np.linalg.LinAlgError:
        left = np.full(2, np.inf)
    if not hypot(*left) <= SETTLED * hypot(*F[:2]):
        message = f"its states come to no steady sliding at {hypot(*slip):g} m/s"
        raise StictionError(f"friction: {message}; see what check_law says of it")
    return state, response
