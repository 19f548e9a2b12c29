"""One patch of the return map, rebuilt in NumPy from ``docs/method.md`` alone (section 15)."""

from math import atan2, cos, pi, sin

import numpy as np
from tests.rebuilt.run import Solver

NODES = 24
GRID = np.cos(np.linspace(0.0, pi, 2001))


def leja(count):
    """Return points of [-1, 1], the ends first, each where the product of distances is largest."""
    points = [-1.0, 1.0]
    while len(points) < count:
        distances = np.prod([np.abs(GRID - point) for point in points], axis=0)
        points.append(float(GRID[distances.argmax()]))
    return np.array(points)


def angle(a):
    """Return the angle of a vector."""
    return atan2(a[1], a[0])


def cycle(slider, rtol, theta):
    """Return turn, time and time held of a cycle (M53), and the turn in its stick; isotropic."""
    run = Solver(slider, rtol, finer=0.03)
    a, j = run.f_s * np.array([cos(theta), sin(theta)]), run.K * run.v_d  # (M52)
    tau = a @ j / (j @ j)  # (M54)
    run.u, run.r = (a - run.C * run.v_d) / run.K - run.v_d * tau, 0.0
    (_, left), (landed, ended) = run.run(1.0, sticks=2).sticks
    held = ended - landed
    before, after = (angle(run.holding(u)) for u in (run.u - run.v_d * held, run.u))
    return after - theta, ended - left, held, after - before


class Patch:
    """Newton's polynomials for turn, time and the square of the time held."""

    def __init__(self, slider, rtol, theta, reach):
        self.theta, self.reach, self.points = theta, reach, leja(NODES)
        self.coefficients = np.zeros((0, 3))
        closing, before = 0.03 * rtol, np.inf
        for n, x in enumerate(self.points):
            turn, time, held, stuck = cycle(slider, rtol, theta + (x + 1) / 2 * reach)
            off = np.array([turn, time, held**2]) - self(x)
            factor = np.prod(x - self.points[:n])
            self.coefficients = np.vstack([self.coefficients, off / factor])
            sizes = max(abs(turn), abs(stuck)), time, 20 * time * held
            miss = np.max(np.abs(off) / sizes)  # (M57)
            if miss < closing and before < 10 * closing:  # (M58)
                return
            before = miss
        raise ArithmeticError("the patch does not close")

    def __call__(self, x):
        """Return turn, time and the square of the time held at a place from -1 to 1."""
        total = np.zeros(3)
        for n in range(len(self.coefficients) - 1, -1, -1):
            total = self.coefficients[n] + (x - self.points[n]) * total
        return total

    def sticks(self, end):
        """Follow the map from the end of a stick (s) on; yield the start and end of each stick."""
        theta = self.theta
        while True:
            x = 2 * (theta - self.theta) / self.reach - 1
            if not -1 <= x <= 1:
                return
            turn, time, square = self(x)
            theta, end = theta + turn, end + time
            yield end - np.sqrt(square), end
