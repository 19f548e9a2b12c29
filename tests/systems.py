"""What the solver works on, for tests of its pieces: all kinds of surface, drive and load."""

from functools import cache
from math import hypot

import numpy as np
from tests.drawn import inside

import stiction as st
from stiction.solver.segments import segments
from stiction.solver.state import Motion

STEADY = st.Slider(
    mass=0.25,
    k_x=1e3,
    k_y=4e4,
    c_x=3.0,
    c_y=20.0,
    phi="7 deg",
    normal_load=10.0,
    friction=st.ExponentialWeakening(0.2, 0.15, "40 mm/s"),
    drive=st.ConstantVelocity("2 mm/s"),
)
ELLIPSE = STEADY.replace(
    friction=st.laws.Anisotropic(st.ExponentialWeakening(0.2, 0.1, "0.1 m/s"), 1.4, "30 deg")
)
PROGRAM = STEADY.replace(
    drive=st.protocols.DriveProgram(
        velocity="2 mm/s",
        along=st.protocols.Modulation("3 mm/s", 40.0, "20 deg"),
        across=st.protocols.Modulation("1 mm/s", 70.0, "50 deg"),
        program=[st.protocols.Ramp("4 mm/s", 1.0)],
    ),
    load=st.protocols.LoadProgram(modulation=st.protocols.Modulation("0.5 N", 30.0, "80 deg")),
)
SPRING = PROGRAM.replace(driven="spring", friction=ELLIPSE.friction)
SLIDERS = {"steady": STEADY, "ellipse": ELLIPSE, "program": PROGRAM, "spring": SPRING}

# u_x (m), u_y (m), slip along x and y (m/s)
MOTIONS = inside(5, (-3e-3, 3e-3), (-5e-5, 5e-5), (-5e-3, 5e-3), (-5e-3, 5e-3))


@cache
def problem_of(name, start=0.3):
    """Return what the solver works on in the segment that begins at a time (s)."""
    return next(segments(SLIDERS[name], start, start + 1.0)).problem


def motion_of(u_x, u_y, s_x, s_y, t=0.35):
    """Return a motion with a slip."""
    r = hypot(s_x, s_y)
    return Motion(t, u_x, u_y, r, s_x / r, s_y / r)


class Printed:
    """The tensors of a problem, in the principal axes and in those along the slip; (M2), (M17)."""

    def __init__(self, problem, motion):
        s, n = problem.system, problem.surface
        self.problem, self.m, self.t, self.r = problem, s.mass, motion.t, motion.r
        self.K, self.C = np.diag([s.k_x, s.k_y]), np.diag([s.c_x, s.c_y])
        self.u = np.array([motion.u_x, motion.u_y])
        self.axes = np.array([[motion.e_x, motion.e_y], [-motion.e_y, motion.e_x]])
        self.k, self.c = (self.axes @ T @ self.axes.T / self.m for T in (self.K, self.C))
        self.N = self.axes @ np.array([[n.xx, n.xy], [n.xy, n.yy]]) @ self.axes.T
        self.turn = np.array([[s.cos_phi, -s.sin_phi], [s.sin_phi, s.cos_phi]])  # from X, Y

    def drive(self, name, *times):
        """Return a vector of the drive in the principal axes."""
        return self.turn @ getattr(self.problem.drive, name)(*times)

    def holding(self, t, u):
        """Return what spring and drive do at zero slip (M2)."""
        force = self.K @ u + self.C @ self.drive("rate", t)
        return force / self.m + self.problem.system.inertia * self.drive("rate_change", t)

    def held_change(self, t):
        """Return its rate of change."""
        force = self.K @ self.drive("rate", t) + self.C @ self.drive("rate_change", t)
        return force / self.m + self.problem.system.inertia * self.drive("rate_curve", t)

    def b(self, dt):
        """(M17)."""
        return self.axes @ self.holding(self.t + dt, self.u + self.drive("travel", self.t, dt))

    def db(self, dt):
        """Return the rate of change of b."""
        return self.axes @ self.held_change(self.t + dt)

    def friction(self, t, speed):
        """Return friction over mass and its slope."""
        law, per = self.problem.law, self.problem.load.at(t) / self.m
        return law.coefficient(speed) * per, law.slope(speed) * per

    def friction_direction(self, w):
        """Return n_1 and tau (M12), of the ellipse in the step's axes."""
        n = self.N @ [1.0, w] / np.sqrt([1.0, w] @ self.N @ [1.0, w])
        return n[0], n[1] - w * n[0]
