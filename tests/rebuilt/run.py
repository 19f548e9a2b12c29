"""The exact solver, rebuilt in NumPy from ``docs/method.md`` alone, for a steady drive and load.

That it takes the steps of the compiled solver shows that the document says everything that they
depend on.
"""

from math import cos, hypot, inf, sin, sqrt

import numpy as np
from tests.rebuilt.step import C, NotConverged, Step

import stiction as st


class Solver:
    """A run: its constants (sections 2 and 11), its state, its sticks (m, 2) in s."""

    def __init__(self, slider, rtol, u=(0.0, 0.0), slip=None, finer=1.0):
        s, law = slider, slider.friction
        angle, ratio = s.phi, 1.0
        if isinstance(law, st.laws.Anisotropic):
            angle, ratio, law = s.phi + law.angle, law.ratio, law.law
        R = np.array([[cos(angle), -sin(angle)], [sin(angle), cos(angle)]])
        self.N, self.isotropic = R @ np.diag([1.0, ratio**2]) @ R.T, ratio == 1.0
        self.law, self.mass, self.per_mass = law, s.mass, s.normal_load / s.mass
        self.K, self.C = np.array([s.k_x, s.k_y]) / s.mass, np.array([s.c_x, s.c_y]) / s.mass
        self.v_d = s.drive.velocity * np.array(s.direction)
        F_0 = law.coefficient(0.0) * s.normal_load
        self.f_s = max(getattr(law, "mu_static", 0.0) * self.per_mass, self.f(0.0))
        tol = 0.8 * rtol**0.8  # (M39)
        self.tol, self.eta_0 = finer * tol, finer * min(0.2, 100 * sqrt(tol)) * tol  # (M34)
        self.v_f = F_0 / s.mass * np.sqrt(np.diag(self.N) / self.K)
        along, across = np.abs(self.v_d)
        sigma_0, k = (across, self.K[1]) if across else (along, self.K[0])
        sigma_0 = min(sigma_0, *self.v_f)
        slopes = [law.slope(v) for v in (0.0, *(sigma_0 * np.logspace(-9, 1, 401)))]
        nu = max(0.0, -min(slopes)) * self.per_mass
        self.sigma = sigma_0 / (1 + nu**2 / k)  # (M40)
        self.v_D = along or across
        self.v_min = 1e-13 * (along + across + self.v_f.sum()) / self.tol
        slip = 1e-6 * self.v_d if slip is None else np.array(slip)
        self.t, self.u, self.r = 0.0, np.array(u), hypot(*slip)
        self.e = slip / self.r if self.r else np.array([1.0, 0.0])
        self.h = 0.05 / sqrt(self.K.max())  # section 12
        self.plan, self.place, self.last = [self.h] + [0.0] * 7, 8, None
        self.steps = self.rejected = self.iterations = 0
        self.kinds, self.sticks = set(), []

    def f(self, v):
        """Return friction over mass, continued linearly below zero (section 7)."""
        mu = self.law.coefficient(max(v, 0.0)) + self.law.slope(max(v, 0.0)) * min(v, 0.0)
        return mu * self.per_mass

    def df(self, v):
        """Return its derivative."""
        return self.law.slope(max(v, 0.0)) * self.per_mass

    def holding(self, u):
        """Return the friction over mass that holds, section 3."""
        return self.K * u + self.C * self.v_d

    def margin(self, u):
        """(M6)."""
        a = self.holding(u)
        return a @ np.linalg.solve(self.N, a) - self.f_s**2

    def run(self, end, sticks=inf):
        """Go on until a time (s), or until so many sticks are over."""
        while self.t < end:
            if self.at_rest():
                self.stick(end)
                if self.t >= end or len(self.sticks) >= sticks:
                    break
            step = Step(self)
            closed = step.pursuit() if self.r > 0 else None
            if closed and self.t + closed[0] < end:
                time, z = closed
                self.t, self.u, self.r = self.t + time, self.u + self.v_d * time - z, 0.0
                self.take_off()
            else:
                self.take(step, end)
        return self

    def at_rest(self):
        """Return whether the slip counts as zero, section 13."""
        small = self.tol * self.sigma
        if self.isotropic or self.r > 1e-3 * small or self.r < 1e-13 * small:
            return self.r < 1e-13 * small
        return self.margin(self.u) < 0

    def stick(self, end):
        """Section 3, and the direction of take-off (M18)."""
        a, j = self.holding(self.u), self.K * self.v_d
        M, (b, q) = self.margin(self.u), np.array([a, j]) @ np.linalg.solve(self.N, j)
        tau, rounding = 0.0, 1e-14 * self.f_s**2
        if M < 0 or (rounding >= M and b <= 0):
            root = sqrt(b * b - q * M)
            tau = -M / (b + root) if b > 0 else (root - b) / q  # (M7)
        tau = min(tau, end - self.t)
        at_end, (b, q) = self.margin(self.u + self.v_d * tau), (b + q * tau, q)
        whole = end - self.t - tau
        x, up = C[0] * whole, at_end + (2 * b + q * whole) * whole >= rounding
        up = b < 0 and (up or at_end > 1e5 * rounding)
        if not up and at_end + (b + q * x / 3) * x < rounding:  # (M9a)
            tau = end - self.t
        if -M / (4 * self.f_s) * tau >= self.tol * self.sigma:  # (M10)
            self.sticks.append((self.t, self.t + tau))
        self.t, self.u, self.r = self.t + tau, self.u + self.v_d * tau, 0.0
        a, F, t = self.holding(self.u), self.f(0.0) ** 2 * self.N, 0.0
        for _ in range(0 if self.isotropic else 50):
            y = np.linalg.solve(F + t * np.eye(2), a)
            t += (y @ F @ y - 1) / (2 * F @ y @ np.linalg.solve(F + t * np.eye(2), y))
        y = a if self.isotropic else np.linalg.solve(F + t * np.eye(2), a)
        self.e = y / hypot(*y)
        self.take_off()

    def take_off(self):
        """Section 12: begin the plan."""
        self.h, self.place, self.last = self.plan[0], 0, None

    def size(self):
        """Return the size to try (section 12)."""
        if 0 < self.place < 8 and self.plan[self.place] > 0:
            return min(max(self.plan[self.place], 0.4 * self.h), 1.5 * self.h)
        return self.h

    def take(self, step, end):
        """Try a step of slip until it is accepted (sections 10, 12 and 13)."""
        size, r, may_land, guess = self.size(), self.r, self.r > 0, None
        h, landing = step.first_size(size)
        for _ in range(100):
            if h >= end - self.t and guess is None:
                h, landing = end - self.t, False
            p, w = guess or step.guess(h)
            p = np.array([p[0], p[1], 0.0]) if landing else p
            tried, guess, factor = h, None, 0.3
            try:
                h, p, w = step.newton(h, p, w, landing)
                if landing and self.t + h > end * (1 + 1e-15):
                    h, landing, may_land = end - self.t, False, False
                    continue
                if not landing and p[2] < 0 and may_land:
                    h *= r / (r - p[2])
                    guess, landing = (np.array([0.5 * r, 0.2 * r, 0.0]), w), True
                    continue
                if p.min() >= 0:
                    error = step.error(h, p, w)
                    theta = (error / self.tol + 1e-10) ** -0.25  # section 12
                    least = 0.0 if landing else error * min(self.sigma + r, step.v_m)
                    if error > self.tol:
                        factor = min(1.0, max(0.2, 0.9 * theta))
                    elif not step.dips(h, p, least):
                        return self.accept(step, h, p, w, landing, theta, size, end)
            except NotConverged as failure:
                (h,) = failure.args
            self.rejected += 1
            may_land = may_land and not landing
            h, landing = (min(h, tried) if h > 0 else tried) * factor, False
        raise ArithmeticError("step underflow")

    def accept(self, step, h, p, w, landing, theta, size, end):
        """End a step, and set the size of the next one (M43) and the plan."""
        self.kinds |= step.kinds(h) | ({"landing"} if landing else set())
        self.u, self.r, self.e = step.end(h, p, w)
        self.t = end if self.t + h >= end else self.t + h
        if self.place < 8 and self.t < end:
            self.plan[self.place] = h * min(4.0, max(0.2, 0.9 * theta))
        factor = min(2.0, max(0.2, 0.9 * theta))
        if step.r > 0 and self.last and h > 0.9 * size:
            before, *_, theta_before = self.last
            factor = min(factor, max(0.2, 0.9 * h / before * theta**2 / theta_before))
        self.h = h * factor if h > 0.1 * self.h or self.t < end else self.h
        self.place = 1 if p[0] < step.r and p[1] < p[2] else self.place + 1
        self.last = None if landing else (h, step.r, p, w, min(theta, 3.0))
        self.r = 0.0 if landing else self.r
        self.steps += 1

    def friction_force(self):
        """Return the friction force (N): the one that holds, or (M4)."""
        if self.r == 0.0:
            return self.mass * self.holding(self.u)
        flow = self.N @ self.e
        return self.mass * self.f(self.r) * flow / sqrt(self.e @ flow)
