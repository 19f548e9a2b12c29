"""Laws that the smooth solver works on, and its equations as printed, for tests of its pieces."""

from functools import cache
from math import inf
from typing import NamedTuple

import numpy as np
from tests.entry import plain
from tests.systems import Printed, motion_of, problem_of

import stiction as st
from stiction.friction.law import Internal, states
from stiction.solver.accuracy import Accuracy
from stiction.solver.problem import Elliptic, Isotropic
from stiction.solver.regularised import Smoothed
from stiction.solver.smooth import dispatch, loop
from stiction.solver.smooth.dispatch import PointedSmoothLaw
from stiction.solver.smooth.state import SmoothMotion
from stiction.solver.smooth.workspace import workspace
from stiction.solver.stepping.radau import A, C, D

A, C, D = np.array(A), np.array(C), np.array(D)


class Fed(NamedTuple):
    """Friction that grows with a state, which slip feeds; it gives no derivatives."""

    mu: float

    @staticmethod
    def states():
        return (Internal("x", "m", "memory"),)

    def force(law, slip, load, state):
        x, y = slip
        return law.mu * load * (x + 3.0 * state[0]), law.mu * load * (y + x * x - state[0])

    def change(law, slip, load, state):
        return (slip[0] - 2.0 * slip[1] * slip[1] - 30.0 * state[0],)


WEAKENING = st.laws.ExponentialWeakening(0.2, 0.1, "40 mm/s")
TENSOR = Elliptic(1.7, 0.3, 0.8)
# the law, and internal states that slip at some mm/s has
LAWS = {
    "smoothed": (Smoothed(WEAKENING, Isotropic(), 2e-3), ()),
    "ellipse": (Smoothed(WEAKENING, TENSOR, 2e-3), ()),
    "fed": (Fed(20.0), (2e-5,)),
    "lugre": (st.laws.LuGre(0.15, 0.2, "10 mm/s", 1e5, 300.0, 2.0), (9e-6, -8e-6)),
    "ageing": (st.laws.RateStateAgeing(0.01, 0.015, "10 um", 0.2, "1 mm/s"), (-1.2,)),
    "slip": (st.laws.RateStateSlip(0.012, 0.015, "10 um", 0.2, "1 mm/s"), (-1.2,)),
}
STATELESS = [name for name, (_, z) in LAWS.items() if not z]
STATEFUL = [name for name, (_, z) in LAWS.items() if z]
# u_x (m), u_y (m), slip along x and y (m/s)
MOTION = 2e-3, -3e-5, 3e-3, -2e-3
TIME = 0.35
EXACT = Accuracy(1e-6, 1e-12, 1e-4, 0.1, 0.02, inf, 2e-3, 2.5e-4, 6e-6, 0.0, 0.0, 1e-12)


def behind(law):
    """Return a law as the solver takes it, but as plain Python."""
    unitless = [True, True, *(each.unit == "1" for each in states(law))]
    code = plain(dispatch.friction_and_changes_at if states(law) else dispatch.friction_at)
    return PointedSmoothLaw(code, plain(dispatch.grain_at), law, np.array(unitless))


@cache
def smooth_problem(law, drive="program"):
    """Return what the smooth solver works on, by the names of a law and of a slider."""
    return problem_of(drive, 0.3)._replace(law=behind(LAWS[law][0]), surface=Isotropic())


def begun(law, drive="program", accuracy=EXACT, motion=MOTION):
    """Return a problem with a step's start, its workspace and the slip coordinate."""
    problem, z = smooth_problem(law, drive), np.array(LAWS[law][1])
    w = workspace(len(z))
    start, q_x, q_y, *_ = plain(loop.begin)(problem, SmoothMotion(TIME, *motion), z, w, accuracy)
    return problem, start, w, (q_x, q_y)


class Equations:
    """The equations of motion as printed in the method, without anything of the solver's."""

    def __init__(self, law, drive="program", motion=MOTION):
        """Take the names of a law and of a slider, and the motion at the start."""
        self.law, self.z = LAWS[law][0], np.array(LAWS[law][1])
        self.s, self.u = np.array(motion[2:]), np.array(motion[:2])
        self.problem = problem_of(drive, 0.3)
        self.printed = Printed(self.problem, motion_of(*motion, TIME))
        self.K, self.C, self.m = self.printed.K, self.printed.C, self.printed.m

    def b(self, dt):
        """Return spring and drive over mass if nothing has slipped (M17), in x and y."""
        return self.printed.holding(TIME + dt, self.u + self.printed.drive("travel", TIME, dt))

    def load(self, dt):
        """Return the normal load (N)."""
        return self.problem.load.at(TIME + dt)

    def friction(self, dt, s, z):
        """Return friction over mass."""
        return np.array(self.law.force(tuple(s), self.load(dt), tuple(z))) / self.m

    def change(self, dt, s, z):
        """Return the rates of change of the internal states."""
        if not len(self.z):
            return np.zeros(0)
        return np.array(self.law.change(tuple(s), self.load(dt), tuple(z)))

    def residuals(self, h, s, z):
        """Return (M66) and (M67) of slip velocities (3, 2) and states (3, n) at the stages."""
        slid, motion, states = h * A @ s, [], []
        for i, c in enumerate(C):
            a = self.b(c * h) - (self.K @ slid[i] + self.C @ s[i]) / self.m
            motion.append(a - self.friction(c * h, s[i], z[i]))
            states.append(self.change(c * h, s[i], z[i]))
        return D @ (s - self.s) - h * np.array(motion), D @ (z - self.z) - h * np.array(states)

    def rates(self, dt, slid, s, z):
        """Return the rates of change of slip velocity and states, when so much has slipped."""
        a = self.b(dt) - (self.K @ slid + self.C @ s) / self.m - self.friction(dt, s, z)
        return a, self.change(dt, s, z)


def at_stages(w):
    """Return slip velocities and states at the stages."""
    return w.values[1:4, :2].copy(), w.values[1:4, 2:].copy()


def derivative(function, x, size=1e-6):
    """Return the central differences of a function of a vector, with columns by its entries."""
    x = np.array(x, dtype=float)
    steps = np.diag(size * np.maximum(np.abs(x), 1.0) if np.isscalar(size) else size)
    return np.transpose([(function(x + d) - function(x - d)) / (2 * d.sum()) for d in steps])
