"""Stability of sliders whose rates differ by up to 40 orders, against Hurwitz's criterion.

The characteristic polynomial is that of (m p^2 + c p + k) u + p Z(p) u = 0, Z the friction of a
disturbance of slip, along and across: on paper for each law, then in whole numbers.
"""

from fractions import Fraction
from math import asinh, cos, exp, hypot, log, sin, sqrt

import numpy as np
import pytest
from benchmarks.explore.draw import Draw
from numpy.polynomial import Polynomial

import stiction as st
from stiction.linear_stability import critical, growth_rate, steady_sliding
from stiction.linear_stability.characteristic import characteristic, roots_of
from stiction.linear_stability.eigenvalues import eigenvalues
from stiction.linear_stability.linear import BOUNDARY

COUNT = 200  # of sliders
CONTACT = {"mu_star": 0.6, "V_star": 1e-6}
KINDS = (
    st.laws.RateStateAgeing,
    st.laws.RateStateSlip,
    st.laws.RateStateAgeing2,
    st.laws.RateStateSlip2,
    st.laws.LuGre,
)


def law_of(draw, kind, W, mass):
    """A law, and the stiffness at which stick-slip would end in one dimension."""
    if kind is st.laws.LuGre:
        sigma_0 = W / draw.decades(1e-7, 1e-4)
        sigma_1 = draw.decades(1e-2, 2.0) * sqrt(sigma_0 * mass)
        v_s = draw.decades(1e-6, 1e-2)
        return kind(mu_c=0.15, mu_s=0.2, v_s=v_s, sigma_0=sigma_0, sigma_1=sigma_1), 1e4 * W
    a, D = draw.decades(0.003, 0.03), draw.decades(1e-7, 1e-3)
    b = a * (draw.between(0.3, 0.97) if draw.chance(0.5) else draw.between(1.03, 2.0))
    if "D_c" in kind._fields:
        return kind(a=a, b=b, D_c=D, **CONTACT), W * abs(b - a) / D
    share, longer = draw.between(0.1, 0.9), draw.decades(0.01, 100.0)
    two = {"b_1": share * b, "D_1": D, "b_2": (1.0 - share) * b, "D_2": longer * D}
    return kind(a=a, **two, **CONTACT), W * abs(b - a) / D


def slider_of(number):
    """A grain of dust, or a mountain; at the speed of plates, or of machines."""
    draw = Draw(16, number)
    mass, W, V = draw.decades(1e-8, 1e3), draw.decades(1e-3, 1e8), draw.decades(1e-11, 1e-1)
    law, stiffness = law_of(draw, KINDS[number % len(KINDS)], W, mass)
    k = stiffness * draw.decades(1e-3, 1e3)
    c = draw.among((0.0, draw.decades(1e-3, 1.0) * sqrt(k * mass)))
    phi = draw.between(-1.5, 1.5) if draw.chance(0.7) else draw.decades(1e-4, 0.1)
    return st.Slider(
        mass=mass,
        k_x=k,
        k_y=k * draw.decades(0.03, 30.0),
        c_x=c,
        c_y=c,
        phi=f"{phi!r} rad",
        normal_load=W,
        friction=law,
        drive=st.ConstantVelocity(V),
    )


def whole(*values):
    """A polynomial of exact numbers."""
    return Polynomial([Fraction(value) for value in values])


def friction_of(law, W, V):
    """Q, Q Z_n and Q Z_t, polynomials: Z = dF/ds + dF/dz (p - dG/dz)^-1 dG/ds."""
    if isinstance(law, st.laws.LuGre):
        fall = (law.mu_s - law.mu_c) * exp(-((V / law.v_s) ** 2))
        steep = -2.0 * (V / law.v_s) ** 2 * fall / (law.mu_c + fall)  # d ln g/d ln v
        give = law.sigma_0 * V / (W * (law.mu_c + fall))
        Q, one = whole(give, 1), whole(law.sigma_2) * whole(give, 1)
        bristle = whole(law.sigma_0, law.sigma_1)  # sigma_1 (p + give) + sigma_0 - sigma_1 give
        return Q, one + Fraction(steep) * bristle, one + bristle
    two = "D_1" in law._fields
    states = [(law.b_1, law.D_1), (law.b_2, law.D_2)] if two else [(law.b, law.D_c)]
    at = law.mu_star + sum(b for b, _ in states) * log(law.V_star / V)
    x = V / (2.0 * law.V_star) * exp(at / law.a)
    direct, across = law.a * W * x / hypot(1.0, x) / V, law.a * asinh(x) * W / V
    Q, fading = whole(1), whole(0)
    for b, D in states:
        age = whole(V / D, 1)
        fading, Q = fading * age + Q * Fraction(b * direct / law.a * V / D), Q * age
    return Q, Fraction(direct) * Q - fading, Fraction(across) * Q


def is_stable(slider):
    """Whether all roots have negative real parts, by the array of Routh and Hurwitz."""
    Q, along, across = friction_of(slider.law, slider.normal_load, slider.motion.velocity)
    c, s = map(Fraction, (cos(slider.phi), sin(slider.phi)))
    x, y = (
        whole(k, each, slider.mass) * Q
        for k, each in ((slider.k_x, slider.c_x), (slider.k_y, slider.c_y))
    )
    p = whole(0, 1)
    x, y = x + p * (along * c * c + across * s * s), y + p * (along * s * s + across * c * c)
    mixed = p * (along - across) * c * s
    upper, lower = (list((x * y - mixed * mixed).coef[i::2][::-1]) for i in (0, 1))
    first = [upper[0]]
    while lower:
        first.append(lower[0])
        ratio = upper[0] / lower[0]
        rest = [*lower[1:], Fraction(0)]
        upper, lower = lower, [a - ratio * b for a, b in zip(upper[1:], rest, strict=False)]
    return all(each > 0 for each in first)


def test_the_verdict_is_that_of_hurwitz():
    """It is left open where derivatives of LuGre's friction, far below its speed, are rounding."""
    sliders = [slider_of(number) for number in range(COUNT)]
    truth = [is_stable(slider) for slider in sliders]
    assert 0.2 < np.mean(truth) < 0.8
    for number, (slider, stable) in enumerate(zip(sliders, truth, strict=True)):
        linear = steady_sliding(slider)
        if linear.verdict == BOUNDARY:
            assert isinstance(slider.law, st.laws.LuGre), number
            continue
        assert linear.stable == stable, number
        assert (growth_rate(slider) < 0.0) == stable, number


FAULT = st.Slider(
    mass="1 kg",
    k_x="100 MN/m",
    k_y="3 GN/m",
    phi="2 deg",
    normal_load="100 kN",
    friction=st.laws.RateStateAgeing(a=0.010, b=0.008, D_c="10 um", **CONTACT),
    drive=st.ConstantVelocity("1e-10 m/s"),
)


@pytest.mark.parametrize("path", ["phi", "drive.velocity"])
def test_contacts_that_strengthen_have_no_critical_value(path):
    """Inertia ends fast slip 1e16 times as fast as contacts age."""
    found = critical(FAULT, path)
    assert found.stable == (True,)


def test_eigenvalues_forty_orders_apart_have_their_own_digits():
    """Those of dust below a load of 7 t, in 110 digits by benchmarks.accuracy.linearisation."""
    law = st.laws.RateStateAgeing(a=0.004, b=0.0016, D_c=4e-5, **CONTACT)
    springs = {"k_x": 2e4, "k_y": 2e3, "phi": "-67 deg"}
    dust = FAULT.replace(mass=1e-7, **springs, normal_load=7e4, friction=law)
    linear = steady_sliding(dust.replace(drive=st.ConstantVelocity(2e-11)))
    true = [
        -4.1605460269453510491e-12,
        -5.701037304172700921e-10,
        -2.9977347074703449265e-7,
        -1.4000000000000001772e20,
        -2.0091138624109537563e22,
    ]
    assert (np.abs(linear.eigenvalues - true) <= linear.uncertainty).all()
    assert (linear.uncertainty <= 1e-9 * np.abs(true)).all()  # of the derivatives of friction
    rates = linear.eigenvalues * linear.shapes[:2]
    assert linear.shapes[2:4] == pytest.approx(rates, rel=1e-9, abs=0.0)


# --- the characteristic polynomial --------------------------------------------------------------


def test_coefficients_are_exact():
    """Of 2^e x, by the determinant and the trace."""
    matrix = np.array([[0.5, 3.0], [2.0**-70, 7.0]])
    (c_0, c_1, c_2), e = characteristic(matrix)
    assert Fraction(c_0, 4**e) == Fraction(3.5) - 3 * Fraction(2.0**-70)
    assert (Fraction(c_1, 2**e), c_2) == (Fraction(-7.5), 1)


@pytest.mark.parametrize(
    ("matrix", "roots"),
    [
        (np.zeros((3, 3)), [0.0, 0.0, 0.0]),
        ([[0.0, 1.0, 0.0], [-4.0, 0.0, 0.0], [0.0, 0.0, 0.0]], [-2j, 0.0, 2j]),
        ([[1e200, 1.0, 5.0], [0.0, 2.0, 1.0], [0.0, 0.0, -3e-200]], [-3e-200, 2.0, 1e200]),
        ([[3.0, 1.0], [0.0, 3.0]], [3.0, 3.0]),
    ],
)
def test_roots_of_any_size_are_found(matrix, roots):
    found = roots_of(np.array(matrix))
    found = found[np.lexsort((found.imag, found.real.round(9)))]
    # a double root to the root of the rounding error
    assert found == pytest.approx(np.array(roots), rel=1e-6, abs=0.0)


def test_a_matrix_whose_modes_are_one_has_them_all():
    """Its characteristic polynomial has one root, three times; as uncertain as that."""
    found = eigenvalues(np.eye(3) + np.eye(3, k=1), np.zeros((3, 3)))
    assert np.abs(found.values - 1.0).max() <= found.uncertainty.min()
