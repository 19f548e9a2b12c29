"""Tensors of a rig, and the axes in which it is simple: (M71), (M72)."""

import numpy as np
import pytest
from tests.drawn import inside

import stiction as st
from stiction.system.parameter import change_parameter, units
from stiction.system.tensors import (
    damping_tensor,
    mass_tensor,
    solver_axes,
    stiffness_tensor,
)

# masses (ln), angles (deg), stiffnesses (ln), phi
RANGES = ((-6, 6), (-6, 6), (-90, 90), (0, 20), (0, 20), (0, 9), (0, 9), (-90, 90), (-80, 80))
ROUNDING = 1e-13


def rig(row):
    m_x, m_y, a, k_x, k_y, c_x, c_y, b, phi = (float(each) for each in row)
    return st.presets.nakano_popov_2020().replace(
        mass=np.exp(m_x),
        mass_y=np.exp(m_y),
        mass_angle=f"{a} deg",
        k_x=np.exp(k_x),
        k_y=np.exp(k_y),
        c_x=np.exp(c_x),
        c_y=np.exp(c_y),
        damping_angle=f"{b} deg",
        phi=f"{phi} deg",
    )


@pytest.mark.parametrize("row", inside(200, *RANGES))
def test_in_the_solvers_axes_the_mass_is_one_and_springs_lie_along_them(row):
    slider = rig(row)
    M, K, C = mass_tensor(slider), stiffness_tensor(slider), damping_tensor(slider)
    axes = solver_axes(slider)
    T, scale = axes.turn, np.abs(axes.turn).max()
    m = T.T @ M @ T
    assert np.abs(m - axes.mass * np.eye(2)).max() <= ROUNDING * scale**2 * M.max()
    k = T.T @ K @ T
    assert np.abs(k - np.diag(axes.stiffness)).max() <= ROUNDING * scale**2 * K.max()
    np.testing.assert_allclose(axes.damping, T.T @ C @ T, atol=0)
    # the softer one is right to its own digits
    assert axes.stiffness.prod() == pytest.approx(slider.k_x * slider.k_y, rel=1e-14)
    # a right-handed turn, x nearest to x
    assert np.linalg.det(T) == pytest.approx(1.0, rel=1e-9)
    vectors = np.array([[1.0, 2.0], [-3.0, 0.5]])
    there = axes.inward(vectors)
    np.testing.assert_allclose(axes.outward(there), vectors, rtol=0, atol=1e-9 * scale**2)
    # power is the same
    force = np.array([[0.3, -2.0], [1.0, 1.0]])
    power = (axes.force_outward(force) * vectors).sum(axis=1)
    np.testing.assert_allclose(power, (force * there).sum(axis=1), rtol=1e-9, atol=1e-9 * scale**2)


def test_natural_frequencies_are_those_of_the_tensors():
    slider = rig([-1.0, 1.0, 30.0, 7.0, 9.0, 1.0, 2.0, 10.0, 5.0])
    squares = np.linalg.eigvals(np.linalg.solve(mass_tensor(slider), stiffness_tensor(slider)))
    expected = np.sort(np.sqrt(squares)) / (2.0 * np.pi)
    np.testing.assert_allclose(slider.natural_frequencies, expected, rtol=1e-12)


def test_stacked_stages_have_two_masses():
    slider = st.presets.nakano_popov_2020().replace(mass="0.2 kg", mass_y="0.7 kg")
    assert slider.masses == pytest.approx((0.2, 0.7), rel=1e-14)


@pytest.mark.parametrize(
    ("changes", "aligned"),
    [
        ({}, True),
        ({"mass_y": 0.25, "mass_angle": "20 deg"}, True),
        ({"mass_y": 0.3}, False),
        ({"damping_angle": "20 deg"}, True),
        ({"damping_angle": "20 deg", "c_x": 1.0}, False),
        ({"damping_angle": "20 deg", "c_x": 1.0, "c_y": 1.0}, True),
    ],
)
def test_what_makes_a_rig_general(changes, aligned):
    assert st.presets.nakano_popov_2020().replace(**changes).aligned is aligned


def test_a_general_rig_is_written_and_read_back():
    slider = rig([-1.0, 1.0, 30.0, 7.0, 9.0, 1.0, 2.0, 10.0, 5.0]).replace(cell_angle="12 deg")
    again = st.Slider.from_toml(slider.to_toml())
    for name in type(slider).model_fields:
        value = getattr(slider, name)
        close = pytest.approx(value, rel=1e-12) if isinstance(value, float) else value
        assert getattr(again, name) == close
    assert slider.replace(mass_angle="40 deg").mass_angle == pytest.approx(np.radians(40.0))


def test_each_number_of_a_general_rig_can_be_varied():
    slider = rig([-1.0, 1.0, 30.0, 7.0, 9.0, 1.0, 2.0, 10.0, 5.0])
    assert units(slider)["mass_angle"] == "rad"
    assert units(slider)["mass_y"] == "kg"
    assert change_parameter(slider, "mass_y", "3 kg").mass_y == 3.0


@pytest.mark.parametrize("share", [0.05, 0.1, 0.3])
def test_what_a_mass_between_two_springs_changes(share):
    """(M77), by the dynamic stiffness of the two springs with the mass between them."""
    k_1, k_2, m = 3e4, 8e4, 0.2
    omega = share * np.sqrt(k_2 / m)
    without = 1.0 / k_1 + 1.0 / k_2
    # displacement of the slider's end over a force there, the drive's end held
    K = np.array([[k_1, -k_1], [-k_1, k_1 + k_2 - m * omega**2]])
    compliance = np.linalg.solve(K, [1.0, 0.0])[0]
    square = share**2
    printed = k_1 / (k_1 + k_2) * square / (1.0 - square)
    assert compliance / without - 1.0 == pytest.approx(printed, rel=1e-9)
    assert printed <= square / (1.0 - square)
