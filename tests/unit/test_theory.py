"""The closed forms against known values, independent integrations and their own identities.

Tolerances: half a unit of the last digit where a value is given to so many digits; the integrator's
own tolerance where one is the judge; elsewhere the rounding of the operands (EPS) times the
condition of what is computed, which is written out at each place.
"""

import math

import numpy as np
import pint
import pytest
import xarray as xr
from scipy.integrate import quad, solve_ivp
from tests.drawn import all_over

from stiction import theory
from stiction.errors import DescriptionError

EPS = np.finfo(float).eps
F_0, V, PHI, M, K_X, K_Y = 2.0, 1e-3, math.radians(1.0), 0.25, 1e3, 1e7  # the paper's Fig. 3
L_X = 2e-3

TIMES = (0.0, 3.0)  # s = V t/l_x: the properties are tested at V = l_x = 1
MISALIGNMENTS = (math.radians(0.01), math.radians(89.0))
PLACES = all_over(100, TIMES, MISALIGNMENTS)


def turning_rate(theta, phi):
    """|d theta/ds| of Eq. (7): how strongly theta answers to a relative change of the time."""
    return np.sin(theta - phi) / np.sin(theta) ** 2


# --- known values -------------------------------------------------------------------------------


def test_a_wide_misalignment_keeps_the_system_overdamped():
    ten = math.radians(10.0)
    A = theory.damping_number(F_0, V, ten, M, K_X)
    assert np.all(theory.damping_ratio(A, np.linspace(ten, np.pi / 2)) > 1)
    assert theory.damping_ratio(A, np.pi / 2) == A


def test_friction_and_slip_length():
    assert theory.friction_force(0.20, 10.0) == F_0
    assert theory.slip_length(F_0, K_X) == L_X


def test_old_names_of_arguments_work_with_a_warning():
    """Mass, load and stiffness have the symbols of the other formulas: m, W and k."""
    with pytest.warns(DeprecationWarning, match="argument normal_load of friction_force .* W;"):
        assert theory.friction_force(0.20, normal_load=10.0) == F_0
    with pytest.warns(DeprecationWarning, match="called [km];") as seen:
        found = theory.natural_frequency(stiffness="10 MN/m", mass="250 g")
    assert found == theory.natural_frequency(k=K_Y, m=M)
    assert [each.filename for each in seen] == [__file__] * 2
    with pytest.raises(TypeError, match="mass"):
        theory.natural_frequency(K_Y, m=M, mass=M)


def test_first_stick():
    duration = theory.first_stick_duration(F_0, V, PHI, K_X, K_Y)
    assert duration == pytest.approx(11.4595e-3, abs=5e-8)
    elongation = V * duration * np.array([np.cos(PHI), np.sin(PHI)])
    spring_force = np.linalg.norm(np.array([K_X, K_Y]) * elongation)
    assert spring_force == pytest.approx(F_0, rel=8 * EPS)  # some eight roundings
    assert theory.first_stick_duration(F_0, V, 0.0, K_X, K_Y) == pytest.approx(L_X / V, rel=4 * EPS)
    assert theory.first_stick_duration(F_0, 0.0, PHI, K_X, K_Y) == np.inf


def test_critical_angle_is_where_the_damping_ratio_is_one():
    A = np.geomspace(1.0, 1e9, 50)
    ratio = theory.damping_ratio(A, theory.critical_angle(A))
    assert ratio == pytest.approx(np.ones(50), rel=8 * EPS)  # cube of a sine of a rounded angle
    assert np.isnan(theory.critical_angle(0.99))
    assert theory.critical_angle(theory.damping_number(F_0, V, 0.0, M, K_X)) == 0.0


# --- Eq. (7) and its closed form ----------------------------------------------------------------


@pytest.mark.parametrize("degrees", [1.0, 5.0, 30.0, 80.0])
def test_creep_against_integration_of_equation_7(degrees):
    phi, tolerance = math.radians(degrees), 1e-11

    def equation_7(s, x):
        return np.cos(phi) - np.sin(phi) * x / np.sqrt(1 - x**2)

    solution = solve_ivp(equation_7, (0, 2), [0.0], "Radau", rtol=tolerance, atol=tolerance)
    assert solution.success
    # d(rate)/dx < 0: errors made on the way only shrink, so at most the sum of all steps' errors,
    # each below atol + rtol |x|.
    bound = solution.t.size * 2 * tolerance
    t = solution.t * L_X / V
    assert theory.creep_elongation(t, V, phi, L_X) / L_X == pytest.approx(solution.y[0], abs=bound)


@pytest.mark.parametrize("degrees", [0.01, 1.0, 30.0, 80.0])
@pytest.mark.parametrize("fraction", [1e-3, 0.1, 0.5, 0.9, 0.99])
def test_creep_time_against_quadrature(degrees, fraction):
    phi = math.radians(degrees)
    theta = np.pi / 2 - fraction * (np.pi / 2 - phi)
    s, error = quad(lambda angle: 1 / turning_rate(angle, phi), theta, np.pi / 2, epsrel=1e-12)
    bound = error + 4 * EPS / turning_rate(theta, phi)  # quad's own, and the rounding of theta
    assert theory.creep_time(theta, 1.0, phi, 1.0) == pytest.approx(s, abs=bound)


@pytest.mark.parametrize("degrees", [1.0, 10.0, 45.0])
def test_creep_time_is_the_closed_form_as_written(degrees):
    phi = math.radians(degrees)
    theta = np.linspace(phi + 0.1, np.pi / 2, 30)

    def G(angle):
        return -np.cos(angle + phi) + np.sin(phi) ** 2 * np.log(np.tan((angle - phi) / 2))

    # Four terms of order 1 and less than eight roundings each; angle - phi >= 0.1 costs a factor
    # of 2 sin^2(phi)/0.1 at the most.
    expected = (G(np.pi / 2) - G(theta)) * L_X / V
    bound = 32 * EPS * (1 + 20 * np.sin(phi) ** 2) * L_X / V
    assert theory.creep_time(theta, V, phi, L_X) == pytest.approx(expected, abs=bound)


# elsewhere no float tells theta from phi, and the time is lost
TOLD_APART = [
    (s, phi) for s, phi in PLACES if theory.creep_force_angle(s, 1.0, phi, 1.0) > (1 + 1e-9) * phi
]


@pytest.mark.parametrize(("s", "phi"), TOLD_APART)
def test_angle_to_time_and_back(s, phi):
    theta = theory.creep_force_angle(s, 1.0, phi, 1.0)
    bound = np.spacing(theta) / turning_rate(theta, phi) + 8 * EPS * s
    assert theory.creep_time(theta, 1.0, phi, 1.0) == pytest.approx(s, abs=bound)


@pytest.mark.parametrize(("s", "phi"), PLACES)
def test_force_angle_turns_from_the_right_angle_to_the_misalignment(s, phi):
    theta = theory.creep_force_angle(s, 1.0, phi, 1.0)
    assert phi <= theta <= np.pi / 2
    assert theory.creep_elongation(s, 1.0, phi, 1.0) == pytest.approx(np.cos(theta), abs=2 * EPS)


@pytest.mark.parametrize(("one", "other", "phi"), all_over(100, TIMES, TIMES, MISALIGNMENTS))
def test_force_angle_never_turns_back(one, other, phi):
    s = sorted((one, other))
    earlier, later = theory.creep_force_angle(s, 1.0, phi, 1.0)
    rounding = 8 * EPS * s[1] * turning_rate(later, phi) + np.spacing(later)
    assert later <= earlier + rounding


@pytest.mark.parametrize(("s", "step", "phi"), all_over(100, TIMES, (1e-6, 0.1), MISALIGNMENTS))
def test_elongation_grows_at_the_rate_of_equation_7(s, step, phi):
    """The rate falls, so the mean rate of any interval lies between the rates at its two ends."""
    s = np.array([s, s + step])
    u_x = theory.creep_elongation(s, 1.0, phi, 1.0)
    first, last = theory.elongation_rate(u_x, 1.0, phi, 1.0)
    steepness = np.sin(phi) / np.sin(theory.creep_force_angle(s[1], 1.0, phi, 1.0)) ** 3
    rounding = EPS * (8 * max(1.0, s[1]) / (s[1] - s[0]) + 4 * (1 + steepness))
    assert last - rounding <= (u_x[1] - u_x[0]) / (s[1] - s[0]) <= first + rounding


@pytest.mark.parametrize(("s", "phi"), PLACES)
def test_creep_velocity_is_that_of_equation_6(s, phi):
    u_x = theory.creep_elongation(s, 1.0, phi, 1.0)
    expected = 1.0 - np.cos(phi) * theory.elongation_rate(u_x, 1.0, phi, 1.0)
    steepness = np.sin(phi) / np.sin(theory.creep_force_angle(s, 1.0, phi, 1.0)) ** 3
    bound = EPS * (8 + 4 * steepness)  # of a sum of terms of order 1, and of u_x in the rate
    assert theory.creep_velocity(s, 1.0, phi, 1.0) == pytest.approx(expected, abs=bound)


# --- limits -------------------------------------------------------------------------------------


def test_the_start_of_creep():
    assert theory.creep_force_angle(0.0, V, PHI, L_X) == np.pi / 2
    assert theory.creep_elongation(0.0, V, PHI, L_X) == 0.0
    expected = V * np.sin(PHI) ** 2
    assert theory.creep_velocity(0.0, V, PHI, L_X) == pytest.approx(expected, rel=4 * EPS)
    t = 1e-12 * L_X / V  # the elongation keeps its digits; the next term is relatively 1e-12 phi/2
    expected = V * t * np.cos(PHI) ** 2
    assert theory.creep_elongation(t, V, PHI, L_X) == pytest.approx(expected, rel=1e-13)


@pytest.mark.parametrize("degrees", [0.01, 1.0, 89.0])
@pytest.mark.parametrize("s", [1e3, 1e9, np.inf])
def test_the_end_of_creep_is_steady_sliding(degrees, s):
    phi = math.radians(degrees)
    assert theory.creep_force_angle(s, 1.0, phi, 1.0) == phi
    assert theory.creep_velocity(s, 1.0, phi, 1.0) == pytest.approx(1.0, rel=4 * EPS)
    assert theory.creep_time(phi, 1.0, phi, 1.0) == np.inf
    assert theory.creep_time(0.5 * np.pi, 1.0, [phi, 0.5 * np.pi], 1.0).tolist() == [0.0, 0.0]


def test_no_misalignment_is_ideal_stick_and_then_slip():
    s = np.array([0.0, 0.3, 0.6, 0.999])
    theta = theory.creep_force_angle(s, 1.0, 0.0, 1.0)
    assert theta == pytest.approx(np.arccos(s), rel=16 * EPS / (1 - 0.999))  # 1 - s is rounded
    assert theory.creep_elongation(s, 1.0, 0.0, 1.0) == pytest.approx(s, rel=4 * EPS)
    assert theory.creep_time(theta, 1.0, 0.0, 1.0) == pytest.approx(s, abs=4 * EPS)
    assert np.all(theory.creep_velocity(s, 1.0, 0.0, 1.0) == 0.0)
    assert np.all(theory.creep_force_angle([1.0, 1.5, np.inf], 1.0, 0.0, 1.0) == 0.0)
    assert list(theory.creep_velocity([1.0, 1.5, np.inf], 1.0, 0.0, 1.0)) == [0.0, 1.0, 1.0]


@pytest.mark.parametrize("phi", [1e-300, 1e-160, 1e-12])
def test_the_limit_of_no_misalignment_is_continuous(phi):
    s = np.array([0.0, 0.5, 0.9, 1.1])
    limit = theory.creep_force_angle(s, 1.0, 0.0, 1.0)
    bound = 2 * phi + 4 * EPS  # of first order in phi: phi (1 - c)/s, c = sqrt(1 - s^2), then phi
    assert theory.creep_force_angle(s, 1.0, phi, 1.0) == pytest.approx(limit, abs=bound)
    assert theory.creep_velocity(s[-1], 1.0, phi, 1.0) == 1.0


def test_what_the_theory_does_not_give_is_nan():
    assert np.isnan(theory.creep_force_angle([-1.0, np.nan], V, PHI, L_X)).all()
    assert np.isnan(theory.creep_elongation(1.0, V, [-PHI, 2.0], L_X)).all()
    assert np.isnan(theory.creep_time([0.5 * PHI, 1.6], V, PHI, L_X)).all()
    assert np.isnan(theory.elongation_rate(1.1 * L_X, V, PHI, L_X))
    s = np.array([-0.1, 1.0, 2.0])
    assert np.isnan(theory.creep_velocity_approximation(s * L_X / V, V, PHI, L_X)).all()
    assert np.isnan(theory.creep_velocity_as_printed(s * L_X / V, V, PHI, L_X)).all()


def test_arguments_broadcast():
    t, phi = np.array([0.5, 1.0, 1.5]), np.radians([[0.0], [1.0]])
    for creep in (theory.creep_force_angle, theory.creep_elongation, theory.creep_velocity):
        together = creep(t, V, phi, L_X)
        alone = [[creep(one, V, angle, L_X) for one in t] for angle in phi.ravel()]
        assert together.shape == (2, 3)
        assert np.shape(alone[0][0]) == ()
        assert together == pytest.approx(np.array(alone), rel=8 * EPS)  # last step of Newton's


# --- Eq. (8) ------------------------------------------------------------------------------------


def second_order_term(s, V, phi):
    """The second term in phi^2 of the expansion of Eq. (7), which Eq. (8) leaves out."""
    c = np.sqrt(1 - s**2)
    return -V * phi**2 * (1 - c) / c**3


@pytest.mark.parametrize("s", [0.1, 0.5, 0.9])
@pytest.mark.parametrize(
    ("expansion", "expected_order"),
    [
        (theory.creep_velocity_as_printed, 1),
        (theory.creep_velocity_approximation, 2),
        (lambda *a: theory.creep_velocity_approximation(*a) + second_order_term(*a[:3]), 3),
    ],
    ids=["as printed", "corrected", "complete"],
)
def test_order_of_equation_8(s, expansion, expected_order):
    """X' itself is of order phi: an error of order 1 is no approximation at all.

    The observed order differs from a whole number by the ratio of consecutive terms, about
    phi/c^3, here at most 0.012.
    """
    phi = np.array([1e-3, 5e-4])
    error = np.abs(expansion(s, 1.0, phi, 1.0) - theory.creep_velocity(s, 1.0, phi, 1.0))
    assert np.log2(error[0] / error[1]) == pytest.approx(expected_order, abs=0.05)


@pytest.mark.parametrize("s", [0.1, 0.5, 0.9])
def test_printed_equation_8_misses_by_a_factor_of_s(s):
    phi = 1e-9
    exact = theory.creep_velocity(s, 1.0, phi, 1.0)
    corrected = theory.creep_velocity_approximation(s, 1.0, phi, 1.0) / exact
    printed = theory.creep_velocity_as_printed(s, 1.0, phi, 1.0) / exact
    bound = 100 * phi  # the next order is phi/c^3 and phi c/s, below 20 phi
    assert corrected == pytest.approx(1.0, abs=bound)
    assert printed == pytest.approx(s, abs=bound)


def test_the_mass_swings_along_the_friction_force():
    omega_y = theory.natural_frequency(1e7, 0.25)
    assert theory.oscillation_frequency(np.pi / 2, 1e3, 1e7, 0.25) == pytest.approx(omega_y)
    assert theory.oscillation_frequency(0.0, 1e3, 1e7, 0.25) == pytest.approx(
        theory.natural_frequency(1e3, 0.25)
    )
    assert theory.oscillation_frequency(np.pi / 6, 1e3, 1e7, 0.25) == pytest.approx(
        0.5 * omega_y,
        rel=2e-4,  # 3 k_x/(2 k_y)
    )


@pytest.mark.parametrize("phi", [-30.0, -1.0, 91.0, 300.0])
@pytest.mark.parametrize("V", [1e-3, -1e-3])
def test_creep_outside_the_theory_is_nan(phi, V):
    """Finite wrong numbers came out: `elongation_rate` at -30 deg was twice that at 30 deg."""
    at, l_x = np.radians(phi), 2e-3
    t = np.copysign(1.0, V)
    found = [
        theory.elongation_rate(1e-3, V, at, l_x),
        theory.creep_time(0.5 * np.pi - 0.01, V, at, l_x),
        theory.creep_force_angle(t, V, at, l_x),
        theory.creep_velocity(t, V, at, l_x),
        theory.creep_velocity_approximation(t, V, at, l_x),
        theory.creep_force_angle(t, -abs(V), np.radians(1.0), l_x),
        theory.critical_angle(-8.0),
    ]
    assert np.isnan(found).all(), found


def test_sizes_have_no_sign_and_limits_no_warning():
    mirrored = [theory.transverse_amplitude_bound(V, p, 1e3) for V in (1, -1) for p in (0.1, -0.1)]
    assert mirrored == [mirrored[0]] * 4
    assert mirrored[0] > 0.0
    assert theory.first_stick_duration(2.0, -1e-3, 0.1, 1e3, 1e7) > 0.0
    assert theory.critical_misalignment(0.0, 0.2, -1.0) == 0.0
    assert theory.critical_misalignment(1e-3, 0.0, -1.0) == pytest.approx(0.5 * np.pi)
    assert np.isinf(theory.critical_stiffness(0.01, 0.015, 0.0, 1.0, 1e-6, 1.0))
    assert np.isinf(theory.slip_length(1.0, 0.0))
    assert np.isinf(theory.natural_frequency(1.0, 0.0))


@pytest.mark.parametrize(
    ("stiffness", "said"),
    [
        (pint.Quantity(1.0, "kN/m"), "not in kilonewton / meter"),
        (pint.Quantity(np.ones(2), "N/m"), r"write .to_base_units\(\).magnitude"),
        (xr.DataArray(1.0, attrs={"units": "kN/m"}), "not in kN/m"),
    ],
)
def test_numbers_with_units_are_refused(stiffness, said):
    """Their units were stripped: 1 kN/m was 1 N/m."""
    with pytest.raises(DescriptionError, match=said):
        theory.natural_frequency(stiffness, 0.25)
    assert theory.natural_frequency(xr.DataArray(1.0, attrs={"units": "N/m"}), 0.25) == 2.0


def test_the_closed_forms_are_listed_alone():
    assert {"creep_time", "damping_number_of"} < {*dir(theory)}
    assert not {"echo", "is_numeric", "np", "Slider", "Floats"} & {*dir(theory)}


@pytest.mark.parametrize("angles", [["45 deg", 0.5], [0.5, "45 deg"], ("0.5 rad", (0.5, "1 deg"))])
def test_a_bare_angle_among_texts_is_refused_wherever_it_stands(angles):
    """The first element decided: one list was read in radians, the other one refused as a list."""
    with pytest.raises(DescriptionError, match=r"theta.*degree or radian\? write '0\.5 deg'"):
        theory.creep_time(angles, "1 mm/s", 0.01, "2 mm")


def test_a_bare_number_in_si_among_texts_is_read():
    for masses in (["250 g", 1.0], [0.25, "1 kg"]):
        found = theory.natural_frequency("1 kN/m", masses)
        np.testing.assert_allclose(found, [1e3**0.5 / 0.5, 1e3**0.5])


def test_the_theory_lists_its_formulas_only():
    assert all(callable(getattr(theory, name)) for name in dir(theory))
    assert "F" not in dir(theory)
