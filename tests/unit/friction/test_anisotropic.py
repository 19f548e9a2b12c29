"""Friction limits that are ellipses in the plane, with the associated flow rule."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import minimize
from tests.drawn import inside
from tests.entry import plain

import stiction as st
from stiction.friction import name_of
from stiction.friction.laws.anisotropic import read_anisotropy
from stiction.solver import surface
from stiction.solver.problem import Elliptic, Problem
from stiction.solver.surface import Tensor

friction_direction, friction_along, takeoff = map(
    plain, (surface.friction_direction, surface.friction_along, surface.takeoff)
)

WEAKENING = st.ExponentialWeakening(0.2, 0.15, 0.01)


def test_a_law_by_its_name_and_its_table():
    grain = st.laws.Anisotropic(WEAKENING, 1.4, "30 deg")
    assert name_of(WEAKENING) == "exponential-weakening"
    assert name_of(grain) == "anisotropic exponential-weakening"
    assert read_anisotropy(WEAKENING, {"ratio": 1.4, "angle": "30 deg"}) == grain
    for wrong in (1.4, {"ratio": 1.4, "angle": "30 deg", "law": "coulomb"}):
        with pytest.raises(st.DescriptionError, match="must be a table with ratio and angle"):
            read_anisotropy(WEAKENING, wrong)


def soft(slider, **changes):
    """A system whose smoothed law SciPy can integrate in a second."""
    values = {"k_y": "100 kN/m", "phi": "5 deg", "c_x": 2.0, "c_y": 5.0}
    return slider.replace(**(values | {"drive": st.ConstantVelocity("10 mm/s")} | changes))


def tensor(slider):
    """N = M^2 in the axes (x, y), M = diag(1, ratio) along and across the surface's axis."""
    angle = slider.phi + slider.law.angle
    c, s = np.cos(angle), np.sin(angle)
    across = np.array([[c, s], [-s, c]])
    return across.T @ np.diag([1.0, slider.law.ratio**2]) @ across


def test_a_circle_is_isotropic_friction(slider):
    plain = soft(slider, friction=WEAKENING)
    circle = soft(slider, friction=st.laws.Anisotropic(WEAKENING, 1.0, "20 deg"))
    one, other = (st.simulate(s, 0.3, sample_rate=1e3, rtol=1e-9) for s in (plain, circle))
    assert len(one.stick_intervals) == len(other.stick_intervals) > 3
    assert other.stick_intervals == pytest.approx(one.stick_intervals, rel=1e-6)
    for name in ("u_x", "u_y", "friction", "theta"):
        assert other.data[name].values == pytest.approx(
            one.data[name].values, rel=1e-5, nan_ok=True
        )


def test_an_ellipse_has_two_names(slider):
    """Half axes mu and ratio mu, the first at an angle: or the other way round."""
    one = soft(slider, friction=st.laws.Anisotropic(st.Coulomb(0.2), 1.5, "30 deg"))
    other = soft(slider, friction=st.laws.Anisotropic(st.Coulomb(0.3), 1 / 1.5, "120 deg"))
    runs = [st.simulate(s, 0.3, sample_rate=1e3, rtol=1e-9).data for s in (one, other)]
    for name in ("u_x", "u_y", "friction"):
        assert runs[1][name].values == pytest.approx(runs[0][name].values, rel=1e-6, abs=1e-12)


@pytest.mark.parametrize(("ratio", "angle"), [(1.5, "30 deg"), (0.4, "-70 deg")])
def test_a_stick_ends_on_the_ellipse(slider, ratio, angle):
    """K v_d t lies on it: (K v_d t).N^-1 (K v_d t) = (mu W)^2; slip leaves along the normal."""
    s = soft(
        slider, c_x=0.0, c_y=0.0, friction=st.laws.Anisotropic(st.Coulomb(0.2, 0.25), ratio, angle)
    )
    V = 1e-2 * np.array(s.direction)
    run = st.simulate(s, 0.05, initial=st.Initial(v_x=V[0], v_y=V[1]), rtol=1e-10)
    pull = np.array([s.k_x, s.k_y]) * V
    end = 0.25 * 10.0 / np.sqrt(pull @ np.linalg.solve(tensor(s), pull))
    assert run.stick_intervals[0] == pytest.approx([0.0, end], rel=1e-12)


def test_force_and_slip_obey_the_flow_rule(slider):
    s = soft(slider, friction=st.laws.Anisotropic(WEAKENING, 1.7, "40 deg"))
    d = st.simulate(s, 0.5, sample_rate=1e3).data
    N = tensor(s)
    theta = np.radians(d["theta"].values)
    force = d["friction"].values * np.array([np.cos(theta), np.sin(theta)])
    slip = np.array([d["slip_x"].values, d["slip_y"].values])
    moving = d["slip_speed"].values > 1e-7
    assert 100 < moving.sum() < len(moving)
    size = np.sqrt(np.einsum("it,ij,jt->t", slip, N, slip))[moving]
    mu = np.array([s.law.coefficient(v) for v in d["slip_speed"].values[moving]])
    wanted = mu * 10.0 * (N @ slip[:, moving]) / size
    assert force[:, moving] == pytest.approx(wanted, abs=1e-5 * 2.0)  # dense output: 2e-5 of F_0
    inside = np.sqrt(np.einsum("it,ij,jt->t", force, np.linalg.inv(N), force))
    assert inside[~moving].max() <= 0.2 * 10.0 * (1 + 1e-5)


@pytest.mark.parametrize(
    ("law", "ratio", "angle"),
    [
        (st.Coulomb(0.2), 1.5, "30 deg"),
        (st.Coulomb(0.2), 0.6, "-50 deg"),
        (WEAKENING, 0.6, "-50 deg"),
    ],
)
def test_the_smoothed_ellipse_tends_to_it(slider, law, ratio, angle):
    """SciPy on F = mu W N s/sqrt(s.N s + delta^2); the error falls with about delta^(4/5)."""
    s = soft(slider, friction=st.laws.Anisotropic(law, ratio, angle))
    exact = st.simulate(s, 0.4, sample_rate=1e3, rtol=1e-10).data
    N, V = tensor(s), 1e-2 * np.array(s.direction)
    k, c = np.array([s.k_x, s.k_y]), np.array([s.c_x, s.c_y])
    start = [0.0, 0.0, float(exact["slip_x"][0]), float(exact["slip_y"][0])]

    def error(delta):
        def change(_, y):
            u, slip = y[:2], y[2:]
            size = np.sqrt(slip @ N @ slip + delta**2)
            force = law.coefficient(np.hypot(*slip)) * s.normal_load * N @ slip / size
            return np.r_[V - slip, (k * u + c * (V - slip) - force) / s.mass]

        times = exact["time"].values
        span, small = (times[0], times[-1]), [1e-14, 1e-14, 1e-12, 1e-12]
        y = solve_ivp(change, span, start, "LSODA", times, rtol=1e-10, atol=small).y
        return abs(y[1] * s.k_y - exact["spring_y"].values).max()

    errors = [error(delta) for delta in (1e-6, 1e-7, 1e-8)]
    assert errors[1] < 10**-0.7 * errors[0]
    assert errors[2] < 10**-0.7 * errors[1]


# --- the pieces ----------------------------------------------------------------------------------


def problem_with(N):
    nothing = (0.0,) * 9
    return Problem(nothing, st.Coulomb(1.0), Elliptic(N[0, 0], N[0, 1], N[1, 1]), None, None, 0.0)


@pytest.mark.parametrize(
    ("ratio", "angle", "pull_angle", "excess"), inside(60, (0.3, 3), (-3, 3), (-3, 3), (0.1, 3))
)
def test_slip_starts_towards_what_friction_leaves(ratio, angle, pull_angle, excess):
    """The friction is the point of the ellipse nearest to the pull, slip along the difference."""
    c, s = np.cos(angle), np.sin(angle)
    turn = np.array([[c, s], [-s, c]])
    M = turn.T @ np.diag([1.0, ratio]) @ turn
    a = (1 + excess) * max(1.0, ratio) * np.array([np.cos(pull_angle), np.sin(pull_angle)])
    problem = problem_with(M @ M)
    y = np.array(takeoff(problem, tuple(a), 1.0))
    e = y / np.hypot(*y)
    friction = np.array(friction_along(problem, *e))
    rest = a - friction
    assert e[0] * rest[1] - e[1] * rest[0] == pytest.approx(0.0, abs=1e-12 * np.hypot(*a))
    assert rest @ e > 0.0

    def distance(x):
        return np.sum((a - M @ [np.cos(x[0]), np.sin(x[0])]) ** 2)

    nearest = min(minimize(distance, [x]).fun for x in np.linspace(-np.pi, np.pi, 9))
    assert rest @ rest == pytest.approx(nearest, rel=1e-6)


@pytest.mark.parametrize(("ratio", "angle", "w"), inside(60, (0.3, 3), (-3, 3), (-2, 2)))
def test_friction_direction_and_its_derivatives(ratio, angle, w):
    c, s = np.cos(angle), np.sin(angle)
    turn = np.array([[c, s], [-s, c]])
    N = turn.T @ np.diag([1.0, ratio**2]) @ turn
    problem, own = problem_with(N), Tensor(N[0, 0], N[0, 1], N[1, 1])
    direction = np.array([1.0, w])
    n = N @ direction / np.sqrt(direction @ N @ direction)
    got = friction_direction(problem, own, w)
    assert got.n_1 == pytest.approx(n[0], rel=1e-12, abs=1e-12)
    assert got.tau == pytest.approx(n[1] - w * n[0], rel=1e-12, abs=1e-12)
    step = 1e-5
    low, high = (friction_direction(problem, own, w + d) for d in (-step, step))
    assert got.dn_1 == pytest.approx((high.n_1 - low.n_1) / (2 * step), abs=1e-7)
    assert got.dtau == pytest.approx((high.tau - low.tau) / (2 * step), abs=1e-7)


def test_our_own_smoothed_ellipse_tends_to_it(slider):
    s = soft(slider, friction=st.laws.Anisotropic(WEAKENING, 1.5, "30 deg"))
    exact = st.simulate(s, 0.4, sample_rate=1e3, rtol=1e-9).data["spring_y"].values
    errors = []
    for delta in (1e-8, 1e-9, 1e-10):
        run = st.simulate(s, 0.4, sample_rate=1e3, rtol=1e-9, regularisation=delta)
        errors.append(np.abs(run.data["spring_y"].values - exact).max())
    assert errors[1] < 10**-0.7 * errors[0]
    assert errors[2] < 10**-0.7 * errors[1]


@pytest.mark.parametrize("rtol", [3.3628547464714086e-9, 3.3628547464714086e-8])
def test_a_slip_that_only_touches_zero_goes_on(rtol):
    """It vanishes where friction can just not hold, and its direction turns within no time.

    Found at random: a run at another tolerance ended there, as no step was short enough.
    """
    friction = st.laws.Anisotropic(
        st.ExponentialWeakening(0.15273754167460213, 0.082476923768033, 0.0024498540003626184),
        1.9596353916794962,
        "-0.1672957106202432 rad",
    )
    slider = st.Slider(
        mass=0.08012905278269689, k_x=5071678.389835973, k_y=5636792.877032631,
        phi="0.014165457812356485 rad", normal_load=3.0300270769672055, c_y=6.026436135099138,
        driven="plate", friction=friction, drive=st.ConstantVelocity(0.004675600402775326),
    )  # fmt: skip
    runs = [st.simulate(slider, 5e-3, rtol=rtol, multiscale=switch) for switch in (False, True)]
    assert [run.status.ok for run in runs] == [True, True]
    assert len(runs[0].stick_intervals) == len(runs[1].stick_intervals)
