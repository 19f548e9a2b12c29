"""Rigs whose masses and dampers have axes of their own, against independent computations.

The reference is the equation of motion in the axes x and y, (M2) with full tensors, in SciPy's
integrator: it knows nothing of the axes in which the solver sees the rig, (M71) to (M74).
"""

from functools import cache

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import expm
from tests.entry import plain

import stiction as st
from stiction.analysis.slip import cell_force
from stiction.solver.problem import damping
from stiction.solver.rig import Aligned, General, as_general
from stiction.solver.segments import begin, segments
from stiction.system.tensors import damping_tensor, mass_tensor, stiffness_tensor

WEAKENING = st.ExponentialWeakening(0.3, 0.2, "20 mm/s")
BASE = st.Slider(
    mass="0.3 kg",
    mass_y="0.8 kg",
    mass_angle="35 deg",
    k_x="1.1 kN/m",
    k_y="9 kN/m",
    c_x="3 N s/m",
    c_y="12 N s/m",
    damping_angle="-50 deg",
    phi="25 deg",
    normal_load="10 N",
    friction=WEAKENING,
    drive=st.ConstantVelocity("20 mm/s"),
)
SHAKEN = st.protocols.DriveProgram(
    velocity="20 mm/s",
    along=st.protocols.Modulation("8 mm/s", "11 Hz"),
    across=st.protocols.Modulation("5 mm/s", "17 Hz", "40 deg"),
)
RIGS = {
    "weakening": BASE,
    "other signs": BASE.replace(mass_angle="-70 deg", damping_angle="80 deg", phi="-40 deg"),
    "stages": BASE.replace(mass_angle="0 deg", damping_angle="0 deg", friction=st.Coulomb(0.25)),
    "dampers askew": BASE.replace(mass_y="0.3 kg"),
    "ellipse": BASE.replace(friction=st.laws.Anisotropic(WEAKENING, 1.4, "25 deg")),
    "plate shaken": BASE.replace(drive=SHAKEN),
    "spring shaken": BASE.replace(drive=SHAKEN, driven="spring"),
}
NAMES = ("u_x", "u_y", "slip_x", "slip_y")
DELTA = 1e-4


@cache
def run_of(name, rtol=1e-8, delta=None, duration=0.25):
    """Return a run of a rig, sampled at 200 Hz."""
    settings = st.Settings(duration=duration, sample_rate=200.0, rtol=rtol, regularisation=delta)
    return st.run(st.Description(RIGS[name], st.Initial(), settings))


def right_hand_side(slider, force):
    """Return the equations of motion (M2) with the tensors as they are, for u and s."""
    M, K, C = (f(slider) for f in (mass_tensor, stiffness_tensor, damping_tensor))
    c, s = slider.direction
    turn, moves = np.array([[c, -s], [s, c]]), slider.driven == "plate"
    drive, step = slider.motion, 1e-6

    def rates(t, y):
        u, slip = y[:2], y[2:4]
        v = turn @ np.array(drive.rate(t), dtype=float)
        acting = K @ u + C @ (v - slip) - force(slip, y[4:])
        if moves and drive is SHAKEN:
            ahead, behind = (turn @ np.array(drive.rate(t + d)) for d in (step, -step))
            acting = acting + M @ (ahead - behind) / (2.0 * step)
        return np.concatenate([v - slip, np.linalg.solve(M, acting)])

    return rates


def smooth_force(slider, delta):
    """Return friction made smooth over delta (M60)."""
    law, N = slider.law, np.eye(2)
    if isinstance(law, st.laws.Anisotropic):
        a = slider.phi + law.angle
        R = np.array([[np.cos(a), -np.sin(a)], [np.sin(a), np.cos(a)]])
        law, N = law.law, R @ np.diag([1.0, law.ratio**2]) @ R.T
    W = slider.normal_load

    def force(slip, _):
        n = N @ slip
        return law.coefficient(np.hypot(*slip)) * W * n / np.sqrt(slip @ n + delta**2)

    return force


@pytest.mark.parametrize("name", RIGS)
def test_smooth_friction_against_the_equations_in_x_and_y(name):
    run, slider = run_of(name, delta=DELTA), RIGS[name]
    t = run.data["time"].values
    start = [0.0, 0.0, *st.Initial().slip(slider)]
    found = solve_ivp(
        right_hand_side(slider, smooth_force(slider, DELTA)),
        (0.0, t[-1]),
        start,
        method="LSODA",
        rtol=1e-10,
        atol=1e-14,
        t_eval=t,
    )
    for variable, expected in zip(NAMES, found.y, strict=True):
        off = np.abs(run.data[variable].values - expected).max()
        assert off < 2e-5 * np.abs(expected).max()  # both tolerances, and how errors grow


@pytest.mark.parametrize("name", RIGS)
def test_set_valued_friction_is_the_limit_of_smooth_friction(name):
    exact = run_of(name).data["u_x"].values
    off = [
        np.abs(run_of(name, delta=delta).data["u_x"].values - exact).max() for delta in (1e-5, 1e-7)
    ]
    # of order delta times its logarithm
    assert off[1] < 0.05 * off[0]
    assert off[1] < 1e-3 * np.abs(exact).max()


@pytest.mark.parametrize("name", RIGS)
def test_turned_by_a_right_angle_nothing_changes(name):
    slider = RIGS[name]
    back = -0.5 * np.pi
    turned = slider.replace(
        k_x=slider.k_y,
        k_y=slider.k_x,
        phi=f"{slider.phi + (back if slider.phi > 0 else -back)!r} rad",
        mass_angle=f"{slider.mass_angle + back!r} rad",
        damping_angle=f"{slider.damping_angle + back!r} rad",
        cell_angle=f"{-slider.misalignment!r} rad",  # where the axis x was
    )
    a = run_of(name).data
    b = st.simulate(turned, duration=0.25, sample_rate=200.0, rtol=1e-8).data
    for variable in ("X", "Y", "V_X", "friction", "mu"):
        off = np.abs(a[variable].values - b[variable].values).max()
        assert off < 1e-6 * np.abs(a[variable].values).max()


@pytest.mark.parametrize("angle", [10.0, 30.0, -65.0])
def test_equal_springs_have_no_axes(angle):
    round_ = BASE.replace(k_x="2 kN/m", k_y="2 kN/m", phi="5 deg")
    turned = round_.replace(
        phi=f"{5.0 - angle!r} deg",
        mass_angle=f"{35.0 - angle!r} deg",
        damping_angle=f"{-50.0 - angle!r} deg",
        cell_angle="-5 deg",  # where the axis x was
    )
    a, b = (
        st.simulate(each, duration=0.2, sample_rate=200.0, rtol=1e-8).data
        for each in (round_, turned)
    )
    for variable in ("X", "Y", "V_X", "friction", "mu"):
        off = np.abs(a[variable].values - b[variable].values).max()
        assert off < 1e-6 * np.abs(a[variable].values).max()


@pytest.mark.parametrize("name", ["weakening", "other signs", "dampers askew"])
def test_without_friction_the_motion_is_a_matrix_exponential(name):
    slider = RIGS[name].replace(friction=st.Coulomb(0.0))
    M, K, C = (f(slider) for f in (mass_tensor, stiffness_tensor, damping_tensor))
    A = np.block([[np.zeros((2, 2)), np.eye(2)], [-np.linalg.solve(M, K), -np.linalg.solve(M, C)]])
    initial = st.Initial(u_x=2e-3, u_y=-1e-3, v_x=0.01, v_y=0.03)
    run = st.simulate(slider, duration=0.3, sample_rate=100.0, rtol=1e-10, initial=initial)
    y = np.array([2e-3, -1e-3, 0.01, 0.03])
    expected = np.array([expm(A * t) @ y for t in run.data["time"].values]).T
    for variable, values in zip(("u_x", "u_y", "v_x", "v_y"), expected, strict=True):
        off = np.abs(run.data[variable].values - values).max()
        assert off < 1e-8 * np.abs(values).max()


def test_a_law_with_internal_state():
    law = st.laws.LuGre(mu_c=0.2, mu_s=0.26, v_s="5 mm/s", sigma_0=4e4, sigma_1=60.0, sigma_2=0.5)
    slider = BASE.replace(friction=law)
    run = st.simulate(slider, duration=0.1, sample_rate=500.0, rtol=1e-8)
    t = run.data["time"].values
    base = right_hand_side(slider, lambda slip, z: np.array(law.force(tuple(slip), 10.0, tuple(z))))

    def rates(t, y):
        inner = law.change((y[2], y[3]), 10.0, tuple(y[4:]))
        return np.concatenate([base(t, y), inner])

    start = [0.0, 0.0, *st.Initial().slip(slider), *st.Initial().internal(slider)]
    found = solve_ivp(rates, (0.0, t[-1]), start, "LSODA", t, rtol=1e-11, atol=1e-15)
    for variable, expected in zip(NAMES, found.y, strict=False):
        off = np.abs(run.data[variable].values - expected).max()
        assert off < 1e-5 * np.abs(expected).max()


@pytest.mark.parametrize("name", RIGS)
def test_energy_is_conserved(name):
    budget = st.analysis.energy_budget(run_of(name, rtol=1e-6))
    assert (abs(budget["residual"]) < budget["bound"]).all()
    assert float(budget["bound"].sum()) < 1e-3 * float(abs(budget["work"]).sum())


@pytest.mark.parametrize("name", ["weakening", "stages", "ellipse"])
def test_the_linear_equations_are_those_of_the_full_ones(name):
    slider = RIGS[name]
    linear = st.linear_stability.steady_sliding(slider)
    rates = right_hand_side(slider, smooth_force(slider, 0.0))
    c, s = slider.direction
    at = np.array([*linear.state[:2], 0.02 * c, 0.02 * s])
    assert np.abs(rates(0.0, at)).max() < 1e-9
    sizes = np.array([1e-6, 1e-6, 1e-5, 1e-5])
    J = np.array(
        [(rates(0.0, at + d) - rates(0.0, at - d)) / (2.0 * d.sum()) for d in np.diag(sizes)]
    ).T
    expected = np.sort_complex(np.linalg.eigvals(J))
    found = np.sort_complex(linear.eigenvalues)
    np.testing.assert_allclose(found, expected, rtol=1e-6, atol=1e-5 * np.abs(expected).max())


def test_many_cycles_at_once():
    slider = BASE.replace(phi="3 deg", drive=st.ConstantVelocity("1 mm/s"), k_y="1 MN/m")
    plain, mapped = (
        st.simulate(slider, duration=0.6, sample_rate=50.0, multiscale=flag)
        for flag in (False, True)
    )
    assert mapped.statistics.mapped > 0
    off = np.abs(plain.data["u_x"].values - mapped.data["u_x"].values).max()
    assert off < 1e-6 * np.abs(plain.data["u_x"].values).max()


def test_one_mass_written_twice_changes_nothing():
    slider = st.presets.nakano_popov_2020()
    a, b = (
        st.simulate(each, duration="20 ms", sample_rate="1 kHz").data
        for each in (slider, slider.replace(mass_y=slider.mass, mass_angle="20 deg"))
    )
    for name in a.data_vars:
        np.testing.assert_array_equal(a[name].values, b[name].values)


def test_the_load_cell_has_an_axis():
    slider = BASE.replace(cell_angle="30 deg")
    a, b = (st.simulate(each, duration=0.1, sample_rate=100.0) for each in (BASE, slider))
    angle = slider.phi + np.radians(30.0)
    along = np.cos(angle) * a.data["spring_x"] + np.sin(angle) * a.data["spring_y"]
    np.testing.assert_allclose(b.data["mu"].values, along.values / 10.0, rtol=1e-12, atol=1e-15)
    np.testing.assert_array_equal(cell_force(a), a.samples["spring_x"])
    np.testing.assert_allclose(cell_force(b), along.values, rtol=1e-12, atol=1e-15)
    record = st.analysis.record_of(b)
    np.testing.assert_allclose(record.force, along.values, rtol=1e-12, atol=1e-15)
    loading = np.polyfit(record.time[1:4], record.force[1:4], 1)[0]
    # before it slips, the mass moves with nothing but its creep
    assert loading <= 1.02 * record.stiffness * record.drive_velocity


@pytest.mark.parametrize("seed", range(5))
def test_components_along_axes_and_drive_are_those_of_a_turn_by_the_misalignment(seed):
    random = np.random.default_rng([1, seed])
    slider = BASE.replace(phi=f"{random.uniform(-90.0, 90.0)} deg")
    X, Y = random.standard_normal((2, 7))
    c, s = np.cos(slider.phi), np.sin(slider.phi)
    x, y = slider.along_axes(X, Y)
    assert x == pytest.approx(c * X - s * Y)
    assert y == pytest.approx(s * X + c * Y)
    assert slider.along_drive(x, y) == pytest.approx(X)


@pytest.mark.parametrize("slider", [BASE, BASE.replace(mass_y="0.3 kg", damping_angle="0 deg")])
def test_the_start_in_the_solver_s_axes(slider):
    """(M71): elongation and slip are T times what the solver sees."""
    initial = st.Initial(u_x=1e-3, u_y=-2e-4, v_x=3e-3, v_y=1e-3)
    found, rig = begin(slider, initial), next(segments(slider, 0.0, 1.0)).problem.rig
    assert rig.outward(found[0]) == pytest.approx((1e-3, -2e-4))
    assert rig.outward(found[1]) == pytest.approx(initial.slip(slider))


@pytest.mark.parametrize("name", ["weakening", "other signs", "stages"])
def test_the_dampers_in_the_solver_s_axes(name):
    """(M72): T^T C T, with a term from each axis to the other."""
    problem = next(segments(RIGS[name], 0.0, 1.0)).problem
    for v in ((1.0, 0.0), (0.3, -2.0)):
        force = damping_tensor(RIGS[name]) @ problem.rig.outward(v)
        assert plain(damping)(problem, *v) == pytest.approx(problem.rig.inward(force))


@pytest.mark.parametrize("seed", range(5))
def test_axes_of_a_general_rig_are_a_matrix(seed):
    """(M71): outward by T, inward by its transpose, and the metric is the product of both."""
    random = np.random.default_rng(seed)
    T, e = random.standard_normal((2, 2)), random.standard_normal((2, 2))
    rig = General(*T.ravel(), 0.7, *e.T.ravel())
    v = random.standard_normal(2)
    assert rig.outward(v) == pytest.approx(T @ v)
    assert rig.inward(v) == pytest.approx(T.T @ v)
    xx, xy, yy = rig.metric()
    assert np.array([[xx, xy], [xy, yy]]) == pytest.approx(T.T @ T)
    assert rig.into_axes(0.0, 0.0, v) == pytest.approx(e @ v)
    assert rig.cross_damping() == 0.7


@pytest.mark.parametrize("phi", [0.0, 0.3, -2.0])
def test_an_aligned_rig_as_a_general_one(phi):
    angle = np.cos(phi), np.sin(phi)
    found, aligned = as_general(*angle), Aligned()
    for vector in ((1.0, 0.0), (0.0, 1.0), (-0.3, 2.0)):
        assert found.outward(vector) == found.inward(vector) == vector
        wanted = aligned.into_axes(*angle, vector)
        assert found.into_axes(*angle, vector) == pytest.approx(wanted, rel=1e-15, abs=1e-16)
    assert found.metric() == aligned.metric()
    assert found.cross_damping() == 0.0
    assert not found.is_aligned()
