"""Linearised steady sliding: against closed forms, analytic derivatives, and simulation."""

import math
import pickle

import numpy as np
import pytest
from benchmarks.explore.systems.general import general_system
from benchmarks.explore.systems.with_state import state_system
from tests.drawn import inside

import stiction as st
from stiction import theory
from stiction.friction import has_state
from stiction.linear_stability import boundary, critical, growth_rate, modes_over, steady_sliding
from stiction.linear_stability.derivatives import (
    derivative,
    response_of,
    with_state,
)
from stiction.linear_stability.eigenvalues import leading_growth
from stiction.linear_stability.linear import disturbance, drive_velocity
from stiction.presets.preset import on_a_line
from stiction.system.parameter import change_unchecked
from stiction.system.tensors import damping_tensor, mass_tensor, stiffness_tensor, surface_tensor

PAPER = st.presets.nakano_popov_2020()
V, W = 1e-3, 10.0
LUGRE = st.laws.LuGre(mu_c=0.15, mu_s=0.2, v_s=2e-2, sigma_0=1e5, sigma_1=300.0, sigma_2=0.4)
AGEING = st.laws.RateStateAgeing(a=0.01, b=0.015, D_c=1e-5, mu_star=0.6, V_star=1e-6)
GRAIN = st.laws.Anisotropic(PAPER.law, 1.3, "20 deg")
# one apparatus in which every law rings or grows at some 10 Hz
SOFT = PAPER.replace(k_y="20 kN/m", phi="10 deg", drive=st.ConstantVelocity("20 mm/s"))
LAWS = {
    "exponential": PAPER.law,
    "anisotropic": GRAIN,
    "LuGre": LUGRE,
    "ageing": AGEING,
    "slip": st.laws.RateStateSlip(*AGEING),
    "two states": st.laws.RateStateAgeing2(0.01, 0.01, 1e-5, 0.004, 1e-4, 0.6, 1e-6),
}
PER_AREA = st.Slider(  # case 5 of Rice & Ruina: quantities per area
    mass=1e3,
    k_x=1e9,
    k_y=1e9,
    phi="0 deg",
    normal_load=5e6,
    friction=AGEING,
    drive=st.ConstantVelocity(1e-2),
)


def closed_form(speeds):
    mu = [PAPER.law.coefficient(v) for v in speeds]
    return theory.critical_misalignment(speeds, mu, [PAPER.law.slope(v) for v in speeds])


# --- the critical misalignment ------------------------------------------------------------------


def test_critical_misalignment_of_the_paper():
    rigid = float(closed_form([V])[0])
    found = critical(PAPER, "phi", ("1 deg", "30 deg"))
    assert math.degrees(rigid) == pytest.approx(8.655360, abs=5e-7)
    assert np.degrees(found.values) == pytest.approx([8.656033], abs=5e-7)
    assert found.stable == (False, True)
    assert growth_rate(PAPER.replace(phi="8 deg")) > 0 > growth_rate(PAPER.replace(phi="8.8 deg"))


def test_the_finite_transverse_stiffness_explains_the_difference():
    """Eliminating y to the next orders in 1/k_y, friction tensor d: the mass is less by d_xy^2/k_y,
    and the damping by d_xy^2 d_yy omega_x^2/k_y^2. What is left out is smaller by d_yy omega_x/k_y.
    """
    phi = float(closed_form([V])[0])
    along, across = W * PAPER.law.slope(V), W * PAPER.law.coefficient(V) / V
    s, c = math.sin(phi), math.cos(phi)
    d_xy, d_yy = (along - across) * s * c, along * s * s + across * c * c
    square = PAPER.k_x / (PAPER.mass - d_xy**2 / PAPER.k_y)
    shift = d_xy**2 * d_yy * square / PAPER.k_y**2 / (2 * s * c * (across - along))
    found = critical(PAPER, "phi", ("8 deg", "9 deg")).values[0] - phi
    assert found == pytest.approx(shift, rel=d_yy * math.sqrt(square) / PAPER.k_y)


def test_the_closed_form_is_the_limit_of_a_stiff_spring_with_damping():
    stiff = PAPER.replace(k_y=1e10, c_x=0.5)
    expected = theory.critical_misalignment(
        V, PAPER.law.coefficient(V), PAPER.law.slope(V), c_x=0.5, W=W
    )
    found = critical(stiff, "phi", ("1 deg", "30 deg")).values
    assert found == pytest.approx([float(expected)], abs=1e-3 * (1e7 / 1e10) ** 2 + 1e-9)


@pytest.mark.parametrize(("degrees", "rests"), [(8.8, True), (8.0, False)])
def test_simulations_on_either_side(degrees, rests):
    slider = PAPER.replace(phi=f"{degrees} deg")
    start = steady_sliding(slider).disturbed_start(1e-2)
    run = st.simulate(slider, 20.0, sample_rate=200.0, initial=start)
    late = np.abs(run.data["v_x"].values[-40:]).max()
    assert (late < 1e-9 * V) if rests else (late > 0.5 * V)


def test_a_mode_of_slow_ageing_is_a_small_disturbance_of_the_state_too():
    """It hardly moves the mass: by its rate alone, the state would change by e^-376."""
    law = st.laws.RateStateAgeing2(
        a=0.016, b_1=0.01, D_1=6e-5, b_2=0.01, D_2=6e-4, mu_star=0.5, V_star=1e-6
    )
    slider = PAPER.replace(friction=law, phi="0.1 deg", drive=st.ConstantVelocity(1e-6))
    linear = steady_sliding(slider)
    start = linear.disturbed_start(1e-2)
    before = dict(zip(linear.names, linear.state, strict=True))
    aged = [start.states[name] - before[name] for name in linear.names[4:]]
    assert max(map(abs, aged)) == pytest.approx(1e-2)
    assert abs(start.v_x) < 1e-2 * 1e-6


@pytest.mark.parametrize("kind", [st.laws.RateStateAgeing, st.laws.RateStateSlip])
def test_critical_stiffness_of_rate_and_state(kind):
    slider = PER_AREA.replace(friction=kind(*AGEING))
    expected = theory.critical_stiffness(0.01, 0.015, 1e-5, 5e6, 1e-2, 1e3)
    assert expected == pytest.approx(3e9, rel=1e-15)
    found = critical(slider, "k_x, k_y", (1e8, 1e11))
    assert found.stable == (False, True)
    assert found.values == pytest.approx([float(expected)], rel=1e-9)  # of the differences


def test_critical_velocities_are_all_found():
    tilted = PAPER.replace(phi="8 deg")
    found = critical(tilted, "drive.velocity", ("0.2 mm/s", "100 mm/s"))
    assert found.stable == (True, False, True)
    assert closed_form(found.values) == pytest.approx(np.radians([8.0, 8.0]), abs=2e-5)
    slow = critical(tilted, "drive.velocity", ("1 um/s", "100 mm/s"))  # only with a finite k_y
    assert slow.stable == (False, True, False, True)
    assert slow.values[1:] == pytest.approx(found.values, rel=1e-9)


def test_without_weakening_nothing_is_critical():
    found = critical(PAPER.replace(friction=st.Coulomb(mu_0=0.2)), "phi", ("1 deg", "89 deg"))
    assert found.values.size == 0
    assert found.stable == (True,)
    neutral = PAPER.replace(friction=st.Coulomb(mu_0=0.2), phi="0 deg")
    assert critical(neutral, "drive.velocity").values.size == 0  # rounding is not a sign
    assert not steady_sliding(neutral).stable


# --- the uncertainty ----------------------------------------------------------------------------

# growth rates (1/s) in 50 digits, of the laws' formulas (benchmarks.accuracy.linearisation)
TRUE = {
    "exponential": 9.0940664189319366777,
    "anisotropic": 8.5907393253430216601,
    "LuGre": 37.070121895727305328,
    "ageing": -3.4051003727675733858,
    "slip": -3.4051003727675733858,
    "two states": -4.9819619097105307195,
}
ROCK = st.Slider(
    mass=1.0,
    k_x=2e5,
    k_y=2e7,
    phi="1 deg",
    normal_load=5e3,
    friction=st.laws.RateStateAgeing(a=0.008, b=0.014, D_c=1e-5, mu_star=0.6, V_star=1e-6),
    drive=st.ConstantVelocity(1e-5),
)


@pytest.mark.parametrize("name", LAWS)
def test_the_stated_uncertainty_is_that_of_the_growth_rate(name):
    linear = steady_sliding(SOFT.replace(friction=LAWS[name]))
    error = abs(linear.growth_rate - TRUE[name])
    assert error <= linear.growth_uncertainty <= 1e3 * max(error, 1e-15 * abs(TRUE[name]))


@pytest.mark.parametrize(
    ("b", "true", "verdict"),
    [(0.014, 0.61515153665064403429, "unstable"), (0.006, -0.063597719852883951632, "stable")],
)
def test_a_slow_mode_beside_fast_ones_keeps_its_digits(b, true, verdict):
    """Other modes decay at 3e8 per second, of which rounding alone is 1e-7."""
    linear = steady_sliding(ROCK.replace(friction=ROCK.friction._replace(b=b)))
    assert abs(linear.growth_rate - true) <= linear.growth_uncertainty <= 1e-8 * abs(true)
    assert linear.verdict == verdict
    assert f"sliding, {verdict}:" in repr(linear)


def test_what_neither_grows_nor_decays_is_on_the_boundary():
    neutral = steady_sliding(PAPER.replace(friction=st.Coulomb(mu_0=0.2), phi="0 deg"))
    assert abs(neutral.growth_rate) <= neutral.growth_uncertainty < 1e-12
    assert neutral.verdict.startswith("on the boundary")
    assert "on the boundary" in repr(neutral)
    assert critical(neutral.slider, "drive.velocity").neutral


# --- the matrix ---------------------------------------------------------------------------------


def test_derivatives_of_lugre_are_those_on_paper():
    s, z = np.array([1.2e-3, -0.7e-3]), np.array([0.9e-5, 0.4e-5])
    r = math.hypot(*s)
    fall = (LUGRE.mu_s - LUGRE.mu_c) * math.exp(-((r / LUGRE.v_s) ** 2))
    g, dg = W * (LUGRE.mu_c + fall), W * fall * (-2 * r / LUGRE.v_s**2)
    give, dgive = LUGRE.sigma_0 * r / g, LUGRE.sigma_0 / g - LUGRE.sigma_0 * r * dg / g**2
    G_s, G_z = np.eye(2) - dgive * np.outer(z, s) / r, -give * np.eye(2)
    F_s = LUGRE.sigma_1 * G_s + LUGRE.sigma_2 * np.eye(2)
    F_z = LUGRE.sigma_0 * np.eye(2) + LUGRE.sigma_1 * G_z
    found = with_state(PAPER.replace(friction=LUGRE), s, z)
    expected = np.block([[F_s, F_z], [G_s, G_z]])
    assert (np.abs(found.slopes - expected) <= found.error + 1e-13 * np.abs(expected)).all()
    assert (found.error <= 1e-8 * np.abs(expected).max(axis=1, keepdims=True)).all()


def test_derivatives_of_rate_and_state_are_those_on_paper():
    slider = PER_AREA.replace(phi="30 deg")
    s, V_0 = drive_velocity(slider), 1e-2
    n = s / V_0
    log_theta = math.log(AGEING.V_star / V_0)
    mu = AGEING.coefficient(V_0)  # a asinh(x) = a ln 2x to rounding, x = exp(mu/a)/2
    F_s = 5e6 * (AGEING.a / V_0 * np.outer(n, n) + mu / V_0 * (np.eye(2) - np.outer(n, n)))
    expected = np.block(
        [
            [F_s, 5e6 * AGEING.b * n[:, None]],
            [-n[None] / AGEING.D_c, np.array([[-V_0 / AGEING.D_c]])],
        ]
    )
    found = with_state(slider, s, np.array([log_theta]))
    assert found.slopes == pytest.approx(expected, rel=1e-11)
    assert (np.abs(found.slopes - expected) <= found.error + 1e-13 * np.abs(expected)).all()


@pytest.mark.parametrize("law", [PAPER.law, GRAIN, st.laws.Table.like(0.2, 0.15, 1e-2)], ids=str)
def test_derivatives_of_set_valued_laws(law):
    slider = PAPER.replace(friction=law, phi="20 deg")
    slip = drive_velocity(slider)
    response = response_of(slider, slip)
    for i in range(2):
        column, error = derivative(lambda s: response_of(slider, s).value, slip, i, V / 2, V / 512)
        assert response.slopes[:, i] == pytest.approx(column, abs=10 * error.max())
        assert error.max() < 1e-8 * np.abs(response.slopes).max()


def test_the_matrix_of_a_disturbance_is_that_of_the_equations_of_any_rig():
    """M u'' + (C + dF/ds) u' + K u = 0, with differences of friction for dF/ds."""
    systems = [general_system(7, number).slider for number in range(400)]
    seen = 0
    for slider in systems:
        try:
            slip = drive_velocity(slider)
        except st.DescriptionError:  # not steady
            continue
        if has_state(slider.law):
            continue
        seen += 1

        def friction(s, slider=slider):
            push = surface_tensor(slider) @ s
            limit = slider.normal_load * slider.law.coefficient(math.hypot(*s))
            return limit / np.sqrt(s @ push) * push

        v = math.hypot(*slip)
        ends = v / 2, v / 512
        columns = [derivative(lambda s: friction(np.array(s)), slip, i, *ends) for i in (0, 1)]
        slopes, error = (np.column_stack(part) for part in zip(*columns, strict=True))
        M, K, C = mass_tensor(slider), stiffness_tensor(slider), damping_tensor(slider)
        found = disturbance(slider)[0]
        assert (found[:2] == np.eye(4)[2:]).all()
        assert M @ found[2:, :2] == pytest.approx(-K, rel=1e-12, abs=1e-12 * K.max())
        size = np.abs(slopes).max() + np.abs(C).max()
        left = M @ found[2:, 2:] + C + slopes
        assert np.abs(left).max() <= 10 * error.max() + 1e-12 * size
    assert seen > 80


def test_the_gradients_of_laws_are_their_numerical_derivatives():
    """The derivatives for growth rates, and those that find their own steps."""
    seen = 0
    for number in range(80):
        slider = state_system(11, number).slider
        try:
            linear = steady_sliding(slider)
        except st.StictionError:  # not steady
            continue
        seen += 1
        matrix, error = disturbance(slider)
        scale = np.abs(linear.matrix).max(axis=1, keepdims=True)
        assert (np.abs(matrix - linear.matrix) <= error + linear.error + 1e-12 * scale).all()
        growth, uncertainty = leading_growth(matrix, error)
        assert abs(growth - linear.growth_rate) <= uncertainty + linear.growth_uncertainty
        left = growth_rate(slider) - linear.growth_rate
        assert abs(left) <= 1e-9 * np.abs(linear.eigenvalues).max() + linear.growth_uncertainty
    assert seen > 40


def test_the_ellipse_of_an_anisotropic_surface_turns_friction():
    """At the surface's own axis friction is that of the law, and across it `ratio` times."""
    for angle, ratio in (("0 deg", 1.0), ("90 deg", 1.3)):
        slider = PAPER.replace(friction=st.laws.Anisotropic(PAPER.law, 1.3, angle))
        response = response_of(slider, drive_velocity(slider))
        assert math.hypot(*response.value) == pytest.approx(ratio * PAPER.law.coefficient(V) * W)


def rings(slider):
    """Growth and frequency of a simulated disturbance (1/s), by a fit of the linear recurrence.

    The disturbance is along the mode, so that nothing else is in it.
    """
    linear = steady_sliding(slider)
    assert linear.eigenvalues[0].imag > 0
    rate, duration = 32 * linear.frequencies[0], 2 / linear.frequencies[0]
    start = linear.disturbed_start(1e-4 * min(1.0, math.exp(-linear.growth_rate * duration)))
    run = st.simulate(slider, duration, sample_rate=rate, initial=start, rtol=1e-12)
    v = run.data["v_x"].values
    (a, b), *_ = np.linalg.lstsq(np.column_stack([v[1:-1], v[:-2]]), v[2:], rcond=None)
    roots = np.log(np.roots([1.0, -a, -b]).astype(complex)) * rate
    return roots[np.argmax(roots.imag)]


@pytest.mark.parametrize("name", LAWS)
def test_the_leading_mode_is_how_a_small_disturbance_rings(name):
    """What is left out is of the disturbance's own size beside it: 1e-4 of V at the end."""
    slider = SOFT.replace(friction=LAWS[name])
    leading = steady_sliding(slider).eigenvalues[0]
    assert rings(slider) == pytest.approx(leading, abs=1e-4 * abs(leading))


def test_a_slow_drive_is_unstable_at_any_misalignment():
    """Friction F/V across the drive, without bound as V falls, lets the mass move along it alone.

    Then there is one stiffness, along the drive, and one damping, F'(V), which is negative. The
    closed form for k_y -> infinity has it stable; the simulation has not.
    """
    slider = PAPER.replace(phi="8 deg", drive=st.ConstantVelocity("1 nm/s"))
    c, s = slider.direction
    stiffness = slider.k_x * c * c + slider.k_y * s * s
    damping = W * PAPER.law.slope(1e-9) / (2 * PAPER.mass)
    expected = complex(-damping, math.sqrt(stiffness / PAPER.mass - damping**2))
    leading = steady_sliding(slider).eigenvalues[0]
    # how far it gives way sideways: omega times mass over F/V
    assert leading == pytest.approx(expected, rel=1e-3)
    slow = slider.replace(drive=st.ConstantVelocity("20 um/s"))
    leading = steady_sliding(slow).eigenvalues[0]
    assert leading.real > 0
    assert rings(slow) == pytest.approx(leading, abs=1e-4 * abs(leading))


def test_modes_are_followed_through_a_parameter():
    slider = PAPER.replace(phi="8 deg")
    found = modes_over(slider, "drive.velocity", ("0.1 mm/s", "10 mm/s"), points=301)
    growth, values = found["growth_rate"].values, found["value"].values
    assert found.attrs["scale"] == "log"
    middle = steady_sliding(change_unchecked(slider, "drive.velocity", values[150]))
    assert np.sort(growth[150]) == pytest.approx(np.sort(middle.growth_rates))
    # none jumps to another: a hundredth of a decade changes no rate as much as they differ
    assert np.abs(np.diff(growth, axis=0)).max() < 0.15 * np.ptp(growth, axis=1).max()


# --- symmetry and scaling -----------------------------------------------------------------------

ANGLES = (0.5, 89.5)  # deg


@pytest.mark.parametrize("name", ["exponential", "LuGre", "ageing"])
@pytest.mark.parametrize("phi", [phi for (phi,) in inside(20, ANGLES)])
def test_a_mirror_changes_nothing(phi, name):
    one, other = (
        steady_sliding(SOFT.replace(friction=LAWS[name], phi=f"{sign * phi} deg"))
        for sign in (1, -1)
    )
    bound = 10 * (one.uncertainty[0] + other.uncertainty[0])
    assert one.growth_rate == pytest.approx(other.growth_rate, abs=bound)


@pytest.mark.parametrize(("phi", "scale"), inside(30, ANGLES, (1e-3, 1e3)))
def test_mass_springs_and_load_together_change_nothing(phi, scale):
    slider = PAPER.replace(phi=f"{phi} deg")
    for path in ("mass", "k_x", "k_y", "normal_load"):
        slider = change_unchecked(slider, path, getattr(slider, path) * scale)
    one, other = steady_sliding(PAPER.replace(phi=f"{phi} deg")), steady_sliding(slider)
    assert one.growth_rate == pytest.approx(other.growth_rate, abs=100 * other.uncertainty[0])


@pytest.mark.parametrize("phi", [phi for (phi,) in inside(30, ANGLES)])
def test_a_right_angle_exchanges_the_axes(phi):
    """The same apparatus with x and y exchanged: phi becomes 90 deg - phi."""
    other = SOFT.replace(k_x=SOFT.k_y, k_y=SOFT.k_x, phi=f"{90 - phi} deg")
    one, other = steady_sliding(SOFT.replace(phi=f"{phi} deg")), steady_sliding(other)
    assert one.growth_rate == pytest.approx(other.growth_rate, abs=100 * other.uncertainty[0])


# --- the boundary in two parameters -------------------------------------------------------------


def test_both_ends_of_a_range_are_checked_together():
    with pytest.raises(st.DescriptionError) as error:
        st.stability(PAPER, over="phi", between=("1 kg", "100 deg"))
    assert [fault.path for fault in error.value.faults] == ["phi", "phi"]


PLANE = {"x_between": ("0 deg", "30 deg"), "y_between": ("0.1 mm/s", "100 mm/s")}


def test_the_boundary_follows_the_closed_form_over_its_maximum():
    found = boundary(PAPER.replace(k_y=1e10), "phi", "drive.velocity", **PLANE)
    phi, speed = found["phi"].values, found["drive.velocity"].values
    assert set(found["branch"].values) == {0}
    assert sorted(speed[[0, -1]]) == pytest.approx([1e-4, 0.1])  # from edge to edge
    # 1/k_y^2, and 1/V^3 of the slowest: a thousandth of 1e-6 rad at Fig. 3's stiffness and speed
    assert phi == pytest.approx(closed_form(speed), abs=1e-8)
    widest = np.argmax(phi)
    assert 0 < widest < len(phi) - 1
    step = np.hypot(np.diff(phi) / np.radians(30), np.diff(np.log10(speed)) / 3)
    assert step.max() <= 0.02 * (1 + 1e-9)  # no gap


def test_every_point_of_the_boundary_is_critical():
    found = boundary(PAPER, "phi", "drive.velocity", **PLANE)
    for point in range(0, found.sizes["point"], 20):
        phi, speed = (float(found[name][point]) for name in ("phi", "drive.velocity"))
        near = (f"{phi - 1e-3} rad", f"{phi + 1e-3} rad")
        again = critical(change_unchecked(PAPER, "drive.velocity", speed), "phi", near, points=5)
        assert again.values == pytest.approx([phi], abs=1e-9)
        assert again.frequencies[0] == pytest.approx(float(found["frequency"][point]), rel=1e-6)


def test_it_is_unstable_on_the_left_of_the_boundary():
    found = boundary(PAPER, "phi", "drive.velocity", **PLANE)
    phi, speed = found["phi"].values, np.log(found["drive.velocity"].values)
    for i in range(5, len(phi) - 5, 10):
        forward = (phi[i + 1] - phi[i - 1]) / np.radians(30), (speed[i + 1] - speed[i - 1]) / 6.9
        side = 0.01 * np.array([-forward[1], forward[0]]) / np.hypot(*forward)
        values = [
            growth_rate(
                change_unchecked(
                    change_unchecked(PAPER, "phi", phi[i] + way * side[0] * np.radians(30)),
                    "drive.velocity",
                    math.exp(speed[i] + way * side[1] * 6.9),
                )
            )
            for way in (1, -1)
        ]
        assert values[0] > 0 > values[1]


def test_the_critical_stiffness_of_rate_and_state_over_velocity():
    found = boundary(
        PER_AREA,
        "k_x, k_y",
        "drive.velocity",
        x_between=(1e9, 1e12),
        y_between=("0.1 mm/s", "1 m/s"),
    )
    speed = found["drive.velocity"].values
    expected = theory.critical_stiffness(0.01, 0.015, 1e-5, 5e6, speed, 1e3)
    assert found["k_x, k_y"].values == pytest.approx(expected, rel=1e-6)
    assert found.attrs["x_scale"] == "log"


def test_a_closed_boundary_closes():
    """Weak damping leaves an island of instability between small and large angles and speeds."""
    slider = PAPER.replace(c_x=1.0, c_y=60.0, k_y=1e10)
    found = boundary(
        slider,
        "phi",
        "drive.velocity",
        x_between=("-20 deg", "20 deg"),
        y_between=("0.1 mm/s", "1 m/s"),
    )
    for _, branch in found.groupby("branch"):
        ends = [(float(branch["phi"][i]), float(branch["drive.velocity"][i])) for i in (0, -1)]
        edges = [abs(phi) > 0.34906 or not 1.0001e-4 < v < 0.9999 for phi, v in ends]
        assert ends[0] == ends[1] or all(edges)


def test_springs_that_differ_have_no_point_in_a_plane_of_both_at_once():
    found = boundary(PAPER, "k_x, k_y", "drive.velocity", x_between=(1e3, 1e6))
    assert math.isnan(found.attrs["x_own"])
    assert found.attrs["y_own"] == V
    with pytest.raises(st.DescriptionError, match="name two parameters"):
        boundary(PAPER, "mass", "mass")


def test_where_nothing_changes_the_boundary_is_empty():
    found = boundary(
        PAPER.replace(friction=st.Coulomb(mu_0=0.2)), "phi", "mass", x_between=("1 deg", "89 deg")
    )
    assert found.sizes["point"] == 0
    assert found.attrs["growth_rate"] < 0


# --- what it refuses ----------------------------------------------------------------------------


def test_what_is_not_steady_is_refused_with_a_remedy():
    ramp = st.protocols.DriveProgram(velocity=V, program=[st.protocols.Ramp("2 mm/s", "1 s")])
    pressed = st.protocols.LoadProgram(program=[st.protocols.Ramp("20 N", "1 s")])
    with pytest.raises(st.DescriptionError) as error:
        growth_rate(PAPER.replace(drive=ramp, load=pressed))
    assert "drive: is not steady" in str(error.value)
    assert "load: is not constant" in str(error.value)
    assert str(error.value).count("remove program") == 2
    shaken = st.protocols.DriveProgram(velocity=V, along=st.protocols.Modulation(V, "3 Hz"))
    with pytest.raises(st.DescriptionError, match=r"remove along$"):  # it has no program
        growth_rate(PAPER.replace(drive=shaken))
    with pytest.raises(st.DescriptionError, match="nothing slides"):
        growth_rate(PAPER.replace(drive=st.ConstantVelocity(0.0)))
    program = PAPER.replace(drive=st.protocols.DriveProgram(velocity=V))
    assert growth_rate(program) == growth_rate(PAPER)


def test_a_negative_angle_is_varied_on_its_side():
    """The mirrored rig has mirrored critical angles; an audit said so, and `critical` did not."""
    here, there = critical(PAPER, "phi"), critical(PAPER.replace(phi="-1 deg"), "phi")
    np.testing.assert_allclose(there.values, -here.values[::-1], rtol=1e-9)
    assert there.between == (-here.between[1], 0.0)
    assert there.stable == here.stable[::-1]


def test_a_range_that_is_none_is_refused():
    with pytest.raises(st.DescriptionError, match="5 is not a parameter; write 'phi'"):
        critical(PAPER, 5)
    with pytest.raises(st.DescriptionError, match="5 is not a range; give its two ends"):
        critical(PAPER, "phi", 5)
    with pytest.raises(st.DescriptionError, match=r"is zero.*between=\(0, 1\)"):
        critical(PAPER, "c_x")
    with pytest.raises(st.DescriptionError, match="low end first"):
        critical(PAPER, "mass", (2.0, 1.0))
    with pytest.raises(st.DescriptionError, match="between -90 deg and 90 deg"):
        critical(PAPER, "phi", ("0 deg", "100 deg"))
    with pytest.raises(st.DescriptionError, match="degree or radian"):
        critical(PAPER, "phi", (0.0, 0.3))


def test_states_of_rounding_have_derivatives():
    """At V = V* both states are ln 1, and what rounding leaves of it is no scale of theirs."""
    law = st.laws.RateStateAgeing2(0.008, 0.003, 1e-5, 0.003, 1e-4, 0.6, 1e-5)
    rock = {"mass": 1, "k_x": 2e5, "k_y": 2e7, "phi": "1 deg", "normal_load": 5e3}
    block = st.Slider(**rock, friction=law, drive=st.ConstantVelocity(1e-5))
    assert critical(block, "phi").stable == (True,)  # it strengthens: b_1 + b_2 < a


def test_what_names_no_parameter_is_refused():
    for over in (5, 0.1):
        with pytest.raises(st.StictionError, match="is not a parameter; name one, such as 'c_x'"):
            st.stability(st.presets.nakano_popov_2020(), over=over)


@pytest.mark.parametrize(("k", "said"), [(5e7, "k_x = 0.2 k_c"), (5e8, "k_x = 2 k_c")])
def test_the_report_names_the_critical_stiffness_of_rate_and_state(k, said):
    law = st.laws.RateStateAgeing(mu_star=0.6, a=0.01, b=0.015, D_c="1 mm", V_star="1 um/s")
    slider = on_a_line(
        mass=2e6, k_x=k, normal_load=5e7, friction=law, drive=st.ConstantVelocity("35 mm/yr")
    )
    report = str(st.stability(slider, over="phi"))
    assert said in report
    assert "k_c is 250 MN/m" in report
    strengthens = slider.replace(friction=law._replace(b=0.005))
    assert "stable on any spring k_x" in str(st.stability(strengthens, over="phi"))
    assert "k_c" not in str(st.stability(st.presets.nakano_popov_2020(), over="phi"))


def test_the_disturbed_mode_is_a_whole_number_of_one_that_there_is(slider):
    linear = steady_sliding(slider)
    second = linear.disturbed_start(mode=1)
    assert linear.disturbed_start(mode=1.0) == second == linear.disturbed_start(mode=np.int32(1))
    for mode, says in ((1.5, "a whole number, is 1.5"), (True, "is True"), (4, "below 4, the")):
        with pytest.raises(st.DescriptionError, match=says):
            linear.disturbed_start(mode=mode)


def test_examinations_and_their_copies_are_equal(slider):
    """Of critical values the comparison was a ValueError: the truth of an array."""
    found = st.stability(slider, over="phi")
    again = pickle.loads(pickle.dumps(found))
    assert again.criticals[0] == found.criticals[0]
    assert again.sliding == found.sliding
    assert again == found
    assert found.criticals[0] != found.criticals[0]._replace(values=np.zeros(1))
    assert found != st.stability(slider.replace(mass=1.0), over="phi")


def test_where_stability_changes_has_the_stiffness_of_rate_and_state():
    law = st.laws.RateStateAgeing(a=0.008, b=0.012, D_c="10 um", mu_star=0.6, V_star="1 um/s")
    rig = {"mass": 1.0, "k_x": 2e5, "k_y": 2e7, "phi": "1 deg", "normal_load": 1e3}
    rock = st.Slider(**rig, friction=law, drive=st.ConstantVelocity("10 um/s"))
    rows = st.stability(rock).tables()[1].table.rows
    assert [row[0] for row in rows if row[0]] == ["phi", "drive.velocity", "k_x"]
    rows = st.stability(rock, over="phi").tables()[1].table.rows
    assert [row[0] for row in rows if row[0]] == ["phi"]
    rows = st.stability(st.presets.nakano_popov_2020()).tables()[1].table.rows
    assert "k_x" not in {row[0] for row in rows}
