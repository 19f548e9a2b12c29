"""The stated uncertainty of eigenvalues against 50 digits, on random apparatus.

``uv run --group benchmarks python -m benchmarks.accuracy.linearisation 1000`` linearises as many
about steady sliding, all laws in turn, and does the same with the laws' formulas in 50 digits.
"""

from __future__ import annotations

import sys
from typing import Any

import mpmath as mp
import numpy as np

import stiction as st
from benchmarks.accuracy.apparatus import PLAIN, WITH_STATE, slider
from stiction.linear_stability import Linearisation, steady_sliding

DIGITS = 50


def exact(found: st.Slider) -> list[Any]:
    """Return the eigenvalues of steady sliding in `DIGITS` digits, fastest growth first."""
    with mp.workdps(DIGITS):
        phi, V, W = mp.mpf(found.phi), mp.mpf(found.motion.velocity), mp.mpf(found.normal_load)
        slip = [V * mp.cos(phi), V * mp.sin(phi)]
        state, response = model(found, V, W, slip)
        at = [*slip, *state]
        n = len(at)
        slopes = mp.matrix(n)
        for j in range(n):
            step = mp.mpf(10) ** (-DIGITS // 3) * (abs(at[j]) if at[j] != 0 else V if j < 2 else 1)
            ahead, behind = ([*at] for _ in range(2))
            ahead[j] += step
            behind[j] -= step
            for i, (a, b) in enumerate(zip(response(ahead), response(behind), strict=True)):
                slopes[i, j] = (a - b) / (2 * step)
        matrix, m = mp.matrix(2 + n), mp.mpf(found.mass)
        k, c = [mp.mpf(found.k_x), mp.mpf(found.k_y)], [mp.mpf(found.c_x), mp.mpf(found.c_y)]
        for i in range(2):
            matrix[i, 2 + i] = 1
            matrix[2 + i, i] = -k[i] / m
            for j in range(n):
                pull = slopes[i, j] if j > 1 else -slopes[i, j]
                matrix[2 + i, 2 + j] = (pull - (c[i] if i == j else 0)) / m
        for i in range(2, n):
            for j in range(n):
                matrix[2 + i, 2 + j] = slopes[i, j] if j > 1 else -slopes[i, j]
        values = mp.eig(matrix, left=False, right=False)
        return sorted(values, key=lambda each: (-each.real, -each.imag))


def model(found: st.Slider, V: Any, W: Any, slip: list[Any]) -> tuple[list[Any], Any]:
    """Return the states of steady sliding, and friction and their rates as a function."""
    law: Any = found.law
    p = (
        {name: mp.mpf(value) for name, value in law._asdict().items() if not callable(value)}
        if not isinstance(law, st.laws.Anisotropic)
        else {}
    )
    if isinstance(law, st.laws.LuGre):

        def g(v: Any) -> Any:
            return W * (p["mu_c"] + (p["mu_s"] - p["mu_c"]) * mp.exp(-((v / p["v_s"]) ** 2)))

        def bristles(at: list[Any]) -> list[Any]:
            s, z = at[:2], at[2:]
            give = p["sigma_0"] * mp.hypot(*s) / g(mp.hypot(*s))
            rate = [s[i] - give * z[i] for i in range(2)]
            force = [
                p["sigma_0"] * z[i] + p["sigma_1"] * rate[i] + p["sigma_2"] * s[i] for i in range(2)
            ]
            return force + rate

        return [g(V) / p["sigma_0"] * each / V for each in slip], bristles
    if isinstance(
        law,
        st.laws.RateStateAgeing
        | st.laws.RateStateSlip
        | st.laws.RateStateAgeing2
        | st.laws.RateStateSlip2,
    ):
        two = "D_1" in p
        b, D = ([p["b_1"], p["b_2"]], [p["D_1"], p["D_2"]]) if two else ([p["b"]], [p["D_c"]])
        ages = isinstance(law, st.laws.RateStateAgeing | st.laws.RateStateAgeing2)

        def contacts(at: list[Any]) -> list[Any]:
            s, z = at[:2], at[2:]
            v = mp.hypot(*s)
            psi = p["mu_star"] + mp.fsum(x * y for x, y in zip(b, z, strict=True))
            mu = p["a"] * mp.asinh(v / (2 * p["V_star"]) * mp.exp(psi / p["a"]))
            change = [
                (p["V_star"] * mp.exp(-w) - v) / d
                if ages
                else -v / d * (mp.log(v / p["V_star"]) + w)
                for w, d in zip(z, D, strict=True)
            ]
            return [mu * W * s[0] / v, mu * W * s[1] / v, *change]

        return [mp.log(p["V_star"] / V)] * len(b), contacts
    inner = law.law if isinstance(law, st.laws.Anisotropic) else law
    q = {name: mp.mpf(value) for name, value in inner._asdict().items()}

    def coefficient(v: Any) -> Any:
        if isinstance(inner, st.Coulomb):
            return q["mu_0"]
        if isinstance(inner, st.ExponentialWeakening):
            return q["mu_inf"] + (q["mu_0"] - q["mu_inf"]) * mp.exp(-v / q["v_f"])
        if isinstance(inner, st.laws.HyperbolicWeakening):
            return q["mu_0"] / (1 + v / q["v_h"])
        fallen = mp.exp(-((v / q["v_s"]) ** q["d"]))
        return q["mu_c"] + (q["mu_s"] - q["mu_c"]) * fallen + q["c"] * v

    def friction(s: list[Any]) -> list[Any]:
        mu = coefficient(mp.hypot(*s)) * W
        if not isinstance(law, st.laws.Anisotropic):
            return [mu * each / mp.hypot(*s) for each in s]
        turned, ratio = mp.mpf(found.phi) + mp.mpf(law.angle), mp.mpf(law.ratio)
        c, o = mp.cos(turned), mp.sin(turned)
        a, b = c * s[0] + o * s[1], ratio * (-o * s[0] + c * s[1])
        size = mp.hypot(a, b)
        return [mu * (c * a - ratio * o * b) / size, mu * (o * a + ratio * c * b) / size]

    return [], friction


def deviation(linear: Linearisation, truth: list[Any]) -> tuple[float, float]:
    """Return the error of the fastest growth rate (1/s), and that which is stated."""
    error = abs(mp.mpf(linear.growth_rate) - max(each.real for each in truth))
    return float(error), linear.growth_uncertainty


def main() -> None:
    """Print, for each law, how error and stated uncertainty compare."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 200
    seed = int(sys.argv[2]) if len(sys.argv) > 2 else 1
    print(
        "law           systems  above stated  largest error/stated  stated/error: median, 99 %"
        "  stated/|growth|: 99 %"
    )
    for kind in PLAIN + WITH_STATE:
        random = np.random.default_rng(seed)
        pairs, shares = [], []
        for number in range(count):
            found = slider(random, (kind,))
            linear = steady_sliding(found)
            error, stated = deviation(linear, exact(found))
            pairs.append((error, stated))
            shares.append(
                stated / max(abs(linear.growth_rate), 1e-9 * abs(linear.eigenvalues).max())
            )
            if error > stated or (error > 0 and stated > 1e4 * error):
                print(
                    f"  {kind} {number}: growth {linear.growth_rate:.6g}, error {error:.3g}, "
                    f"stated {stated:.3g}, fastest {abs(linear.eigenvalues).max():.3g}"
                )
        error, stated = np.array(pairs).T
        known = error > 0
        ratio = stated[known] / error[known]
        print(
            f"{kind:13} {count:7} {(error > stated).sum():13} {(error / stated).max():21.3g}"
            f"  {np.median(ratio):21.3g} {np.quantile(ratio, 0.99):8.3g}"
            f"  {np.quantile(shares, 0.99):.2g}"
        )


if __name__ == "__main__":
    main()
