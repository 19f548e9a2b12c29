"""Radau IIA: its quadrature, and its polynomials inside a step."""

import numpy as np
import pytest
from numpy.polynomial import Polynomial
from tests.entry import plain

from stiction.solver.stepping import radau
from stiction.solver.stepping.radau import A, C, D

NODES = np.array([0.0, *C])
CUBIC = Polynomial([0.3, -1.2, 2.5, 0.7])
QUADRATIC = Polynomial([0.4, -1.1, 0.9])


def test_the_tableau():
    """(M24): A integrates quadratics to each node, its last row polynomials of degree 4."""
    for degree in range(3):
        power = Polynomial.basis(degree)
        wanted = power.integ()(np.array(C))
        assert np.array(A) @ power(np.array(C)) == pytest.approx(wanted, abs=1e-15)
    for degree in range(5):
        power = Polynomial.basis(degree)
        assert np.dot(A[2], power(np.array(C))) == pytest.approx(power.integ()(1.0), abs=1e-15)
    assert np.array(D) @ A == pytest.approx(np.eye(3), abs=1e-13)


@pytest.mark.parametrize("c", [0.1, 0.4, 0.85, 1.3])
def test_inside_a_step(c):
    """Through the start and the stages a cubic, whose integral is of the stages' quadratic."""
    values = tuple(CUBIC(NODES))
    assert plain(radau.cubic)(values, c) == pytest.approx(CUBIC(c), abs=1e-13)
    assert plain(radau.cubic_slope)(values, c) == pytest.approx(CUBIC.deriv()(c), abs=1e-13)
    stages = tuple(QUADRATIC(NODES[1:]))
    assert plain(radau.integral)(stages, c) == pytest.approx(QUADRATIC.integ()(c), abs=1e-13)


def test_the_weights_of_the_interior_point():
    values, stages = CUBIC(NODES), QUADRATIC(NODES[1:])
    assert np.dot(radau.VALUE, values) == pytest.approx(CUBIC(radau.INTERIOR), abs=1e-13)
    slope = CUBIC.deriv()(radau.INTERIOR)
    assert np.dot(radau.DERIVATIVE, values) == pytest.approx(slope, abs=1e-13)
    integral = QUADRATIC.integ()(radau.INTERIOR)
    assert np.dot(radau.INTEGRAL, stages) == pytest.approx(integral, abs=1e-13)
