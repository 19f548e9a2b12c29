"""One step of slip, rebuilt in NumPy from ``docs/method.md`` alone (sections 4 to 13).

The numbers are those of the document's equations. Drive and load are steady.
"""

from math import hypot, inf, sqrt

import numpy as np
from numpy.polynomial import Polynomial

C = np.array([(4 - sqrt(6)) / 10, (4 + sqrt(6)) / 10, 1.0])
LAGRANGE = [Polynomial.fromroots(np.delete(C, j)) for j in range(3)]
LAGRANGE = [basis / basis(C[j]) for j, basis in enumerate(LAGRANGE)]
A = np.array([[basis.integ()(c) for basis in LAGRANGE] for c in C])  # (M24)
D = np.linalg.inv(A)
PI = Polynomial.fromroots(C)  # (M35)
TO_CUBIC = np.linalg.inv(np.vander([0.0, *C], 4))
TO_QUADRATIC = np.linalg.inv(np.vander(C, 3))


def gamma(c):
    """(M36)."""
    return abs(PI.integ()(C[0]) / PI(c))


def cubic(start, stages):
    """Return the coefficients of the cubic through a value at 0 and those at the stages."""
    return TO_CUBIC @ [start, *stages]


class NotConverged(Exception):
    """Newton's method failed; its argument is the step size."""


class Step:
    """One step of slip, sections 4 to 13."""

    def __init__(self, run):
        self.run, self.r, self.e = run, run.r, run.e
        self.n = np.array([-self.e[1], self.e[0]])
        self.axes = np.array([self.e, self.n])
        self.k, self.c, self.N = (
            self.axes @ each @ self.axes.T for each in (np.diag(run.K), np.diag(run.C), run.N)
        )
        self.db = self.axes @ (run.K * run.v_d)
        self.b = self.axes @ run.holding(run.u)  # (M17)
        f, df, (n_1, _), (tau, _) = self.friction(self.r, 0.0)
        self.f, self.df, self.turn = f * n_1, df * n_1, f * tau
        self.a = self.b - self.c @ [self.r, 0.0]
        self.dp = self.a[0] - self.f
        rate, curve = run.v_d - self.r * self.e, -np.array([self.dp, self.a[1] - self.turn])
        square = rate @ rate + np.sum((curve @ self.axes) ** 2 / run.K)
        self.v_m = max(sqrt(square), run.v_min)  # (M42)
        turn, across = 0.0, self.a[1] - self.turn
        if self.r > 0.0:
            turn = across / self.r
        self.beta = (self.c[0, 0] + self.df) / 2  # (M21)
        self.G = (self.f * turn**2 - self.k[0, 1] * self.r * turn) / self.k[0, 0]
        if self.r > 0.0:
            damping = 2 * self.beta * self.k[0, 0]
            damping += (self.c[1, 1] + self.f / self.r) * self.k[1, 1]
            if damping <= 0.0 or abs(self.dp - self.G) > 0.5 * abs(self.dp):
                self.G = 0.0
        self.P = (self.db[0] - 2 * self.beta * self.G) / self.k[0, 0]
        self.weak = abs(self.beta) < 0.2 * sqrt(self.k[0, 0])

    def friction(self, p, w):
        """Return f, its derivative, and n_1 and tau each with its own: (M12), (M16)."""
        (xx, xy), (_, yy) = self.N
        g, v = np.sqrt(xx + 2 * xy * w + yy * w * w), p * np.sqrt(1 + w * w)
        n_1, n_2 = (xx + xy * w) / g, (xy + yy * w) / g
        dn_1, dn_2 = (xy - n_1 * n_2) / g, (yy - n_2**2) / g
        f, df = (np.vectorize(each)(v) for each in (self.run.f, self.run.df))
        return f, df, (n_1, dn_1), (n_2 - w * n_1, dn_2 - n_1 - w * dn_1)

    # section 6

    def is_laid_over(self, h):
        """Return whether a step is laid over the oscillation."""
        return 1e-3 < self.k[0, 0] * h * h < 6.25 and self.weak

    def oscillation(self, t):
        """Return p, its first two derivatives and the distance (M22), (M23)."""
        k, beta, x_0, v_0 = self.k[0, 0], self.beta, self.r - self.P, self.dp - self.G
        omega = sqrt(k - beta**2)
        U = np.exp(-beta * t) * np.cos(omega * t)
        S = np.exp(-beta * t) * np.sin(omega * t) / omega
        x, v = x_0 * U + (v_0 + beta * x_0) * S, v_0 * U - (beta * v_0 + k * x_0) * S
        z = self.P * t + self.G * t * t / 2 + (v_0 - v + 2 * beta * (x_0 - x)) / k
        return self.P + self.G * t + x, self.G + v, -2 * beta * v - k * x, z

    def terms(self, h):
        """Return p and its derivative at the stages, R and Z (M25), and (M46)."""
        if not self.is_laid_over(h):
            return np.zeros((6, 3))
        p, v, a, z = self.oscillation(C * h)
        R, Z = h * v - D @ (p - self.r), z / h - A @ p
        by_h = v + h * C * a - D @ (C * v), C * p - A @ (p + h * C * v)
        return np.array([p, v, R, Z, *by_h])

    def cut(self, h):
        """Return the size, less if one step cannot cover so much of the oscillation."""
        k, run = self.k[0, 0], self.run
        most = 3.0 if self.G else 0.99 * 6.25
        if k * h * h < most or not self.weak:
            return h
        large = sqrt((self.r - self.P) ** 2 + (self.dp - self.G) ** 2 / k)
        small = run.tol * min(run.sigma + self.r, self.v_m)
        return h if large < small else sqrt(most / k)

    # sections 7 and 9

    def accelerations(self, h, p, w):
        """Return a_1 and a_2 at the stages (M26), (M27)."""
        z = h * np.array([A @ p + self.terms(h)[3], A @ (p * w)])
        return self.b[:, None] + np.outer(self.db, C * h) - self.k @ z - self.c @ [p, p * w]

    def equations(self, h, p, w, landing=False):
        """Return the six residuals and their Jacobian."""
        (k_11, k_12), (_, k_22) = self.k
        (c_11, c_12), (_, c_22) = self.c
        q, (_, _, R, _, dR, dZ) = p * w, self.terms(h)
        a_1, a_2 = self.accelerations(h, p, w)
        f, df, (n_1, dn_1), (tau, dtau) = self.friction(p, w)
        along = D @ (p - self.r) + R - h * (a_1 - f * n_1)  # (M28)
        across = p * (D @ w) - h * (a_2 - w * a_1 - f * tau)  # (M29)
        chi = np.sqrt(1 + w * w)
        k_1, k_2 = (k_12 - w * k_11)[:, None], (k_22 - w * k_12)[:, None]
        own_pp, own_pw = df * chi * n_1 + c_11 + c_12 * w, df * q / chi * n_1 + f * dn_1 + c_12 * p
        own_wp = c_12 + c_22 * w - w * (c_11 + c_12 * w) + df * chi * tau
        own_ww = a_1 + (c_22 - w * c_12) * p + df * q / chi * tau + f * dtau
        J = np.empty((6, 6))  # (M31)
        J[:3, :3] = D + h * h * A * (k_11 + k_12 * w) + h * np.diag(own_pp)
        J[:3, 3:] = h * h * A * k_12 * p + h * np.diag(own_pw)
        J[3:, :3] = h * h * A * (k_1 + k_2 * w) + np.diag(D @ w + h * own_wp)
        J[3:, 3:] = p[:, None] * D + h * h * A * k_2 * p + h * np.diag(own_ww)
        if landing:  # (M44), (M45)
            da_1 = C * self.db[0] - k_11 * (A @ p + dZ) - k_12 * (A @ q)
            da_2 = C * self.db[1] - k_12 * (A @ p + dZ) - k_22 * (A @ q)
            J[:3, 2] = f * n_1 - a_1 - h * da_1 + dR
            J[3:, 2] = w * a_1 - a_2 + f * tau - h * (da_2 - w * da_1)
        return np.concatenate([along, across]), J

    def newton(self, h, p, w, landing):
        """(M32) and (M33)."""
        run, before, J = self.run, None, None
        eta = run.eta_0 * min(1.0, self.v_m / (run.sigma + self.r))
        for count in range(1, 11):
            residuals, now = self.equations(h, p, w, landing)
            J = now if J is None else J
            d = np.linalg.solve(J, residuals)
            run.iterations += 1
            w = w - d[3:]
            if landing:
                h, p = h - d[2], np.array([p[0] - d[0], p[1] - d[1], 0.0])
                sizes = np.abs([*d[:2] / (run.sigma + np.abs(p[:2])), d[2] / h, *d[3:]])
            else:
                p = p - d[:3]
                sizes = np.abs([*d[:3] / (run.sigma + np.abs(p)), *d[3:]])
            delta = sizes.max()
            rho = delta if before is None else delta / before
            if not delta < 1e10 or h <= 0:
                break
            if delta < eta or delta * rho < eta:
                return h, p, w
            if count > 3 and rho > 1:
                break
            J, before = None if rho > 0.1 else J, delta
        raise NotConverged(h)

    # section 8

    def guess(self, h):
        """Return the first guess of the stages."""
        c, last = C * h, self.run.last
        if self.is_laid_over(h):
            p, v, _, Z, _, _ = self.terms(h)
            pull = self.a[1] - self.turn + self.db[1] * c - self.k[0, 1] * h * (A @ p + Z)
            rows = p[:, None] * D + h * h * self.k[1, 1] * A * p + h * np.diag(self.f + v)
            w = np.linalg.solve(rows, h * pull)
            push = 0.5 * self.f * w * w - h * self.k[0, 1] * (A @ (p * w))
            push -= 0.5 * self.k[0, 0] * self.G * c * c
            return p + h * (A @ push), w
        if last:
            size, r, p, w, _ = last
            x = 1 + c / size
            return np.polyval(cubic(r, p), x), np.polyval(cubic(0.0, w), x) - w[2]
        if self.r == 0.0:
            excess = max(self.dp, 0.0)
            return (excess + 0.5 * self.db[0] * c) * c, self.db[1] / (self.a[0] + excess) * c
        least = self.r * np.array([1 - C[0], 1 - C[1], 0.1])
        return np.maximum(self.r + self.dp * c, least), np.zeros(3)

    # section 10

    def inside(self, c, h, p):
        """Return p and its derivative by c: the oscillation, and the cubic of the rest."""
        laid = self.is_laid_over(h)
        rest = cubic(0.0 if laid else self.r, p - self.terms(h)[0])
        above, rate = self.oscillation(c * h)[:2] if laid else (0.0, 0.0)
        return np.polyval(rest, c) + above, np.polyval(np.polyder(rest), c) + h * rate

    def distances(self, c, h, p, w):
        """Return the distances slid."""
        rest = p - self.terms(h)[0]
        z = [h * np.polyval(np.polyint(TO_QUADRATIC @ each), c) for each in (rest, p * w)]
        return np.array(
            [z[0] + (self.oscillation(c * h)[3] if self.is_laid_over(h) else 0.0), z[1]]
        )

    def error(self, h, p, w):
        """(M38), at one point or at two."""
        points = (0.4, 0.85) if np.diag(self.k).max() * h * h > 6.25 else (0.4,)
        return max(self.error_at(c, h, p, w) for c in points)

    def error_at(self, c, h, p, w):
        """(M36), (M37), (M38) and (M41)."""
        run, weight, turn = self.run, gamma(c), cubic(0.0, w)
        (p, p_c), z = self.inside(c, h, p), self.distances(c, h, p, w)
        w, w_c = np.polyval(turn, c), np.polyval(np.polyder(turn), c)
        if p < 0:
            return inf
        a_1, a_2 = self.b + self.db * c * h - self.k @ z - self.c @ [p, p * w]
        f, _, (n_1, _), (tau, dtau) = self.friction(p, w)
        off_p = p_c - h * (a_1 - f * n_1)
        off_w = p * w_c - h * (a_2 - w * a_1 - f * tau)
        off_w /= p + weight * h * abs(a_1 + f * dtau)
        off = np.array([off_p, w * off_p + p * off_w]) @ self.axes
        speed, rate = p * sqrt(1 + w * w), np.abs(run.v_d - p * (self.e + w * self.n))
        H = min(speed, run.v_D)
        S = min(run.sigma + H, self.v_m)
        S_xy = np.minimum(run.sigma + np.minimum(H, rate + run.v_f), self.v_m)
        own = max(abs(off_p), abs(off_w) * (run.sigma + speed)) / S
        return weight * max(own, *np.abs(off) / S_xy)

    def dips(self, h, p, least):
        """Return whether the slip falls below a value inside and comes back."""
        if self.r == 0.0 or self.dp >= 0.0:
            return False
        x, _ = self.inside(np.linspace(0.0, 1.0, 401), h, p)
        return x.min() < min(least, x[-1])

    def end(self, h, p, w):
        """Return u, r and e at the end (M30)."""
        u = self.run.u + self.run.v_d * h - self.distances(1.0, h, p, w) @ self.axes
        chi = sqrt(1 + w[2] ** 2)
        return u, p[2] * chi, (self.e + w[2] * self.n) / chi

    def kinds(self, h):
        """Return words for the step."""
        long = {"long"} if self.k[0, 0] * h * h > 6.25 else set()
        return long | {
            "laid over" if self.is_laid_over(h) else "plain",
            "slip" if self.r else "take-off",
        }

    # section 13

    def improve(self, t):
        """Return the time to zero slip after a step of Newton's method on the oscillation."""
        if not self.is_laid_over(t):
            return t
        p, v, _, _ = self.oscillation(t)
        return max(t - p / v, 0.5 * t) if v < 0 else t

    def time_to_landing(self, h):
        """(M47)."""
        curve = self.db[0] - self.k[0, 0] * self.r
        square = self.dp**2 - 2 * self.r * curve
        if self.r == 0 or square <= 0 or (self.dp >= 0 and curve >= 0):
            return inf
        root = sqrt(square)
        t = 2 * self.r / (root - self.dp) if self.dp < 0 else (self.dp + root) / -curve
        return self.improve(t) if t < 2.5 * h else t

    def pursuit(self):
        """Return the time to the end and the distance until then (M49), if (M50) lets."""
        run, r, f, a = self.run, self.r, self.f, hypot(*self.a)
        if a >= f or not run.isotropic:
            return None
        T = r * (f + self.a[0]) / (f * f - a * a)
        change = T * (np.abs(self.db).sum() + np.trace(self.k) * r)
        change = T * (change + (abs(self.df) + np.trace(self.c)) * r)
        instant = 1e-13 * max(abs(run.t), 1 / sqrt(run.K.max()))
        if instant < T and change > 0.1 * run.tol * run.sigma:
            return None
        if a < 1e-8 * f:
            return T, r * r / (2 * f) * self.e
        s_a, b = r * self.a[0] / a, -r * self.a[1] / a
        z_a = (f * r * s_a + a / 2 * (s_a**2 + r * r)) / (2 * (f * f - a * a))
        z_b = b * (2 * f * r + a * s_a) / (4 * f * f - a * a)
        along = self.a @ self.axes / a
        return T, z_a * along + z_b * np.array([-along[1], along[0]])

    def first_size(self, size):
        """Return the size of the first try, and whether it is a landing."""
        h, run = self.cut(size), self.run
        T = self.time_to_landing(h)
        if h <= 0.55 * T:
            return h, False
        rest, passes = self.improve(T), False
        if self.is_laid_over(rest):
            z = self.oscillation(rest)[3]
            passes = run.margin(run.u + run.v_d * rest - z * self.e) > 0
        return (0.55 * T, False) if h < 1.1 * T or passes else (rest, True)
