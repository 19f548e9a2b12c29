"""The compiled solver against its readable reference, against SciPy, and piece by piece.

Where two solvers are compared, each runs twice, the second time with a looser tolerance. If the
error falls in proportion to the tolerance, the change is larger than the error of the tight run,
nine times or more for a factor of ten; so the two must agree within the sum of both changes.
"""

from math import hypot, inf, pi

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from tests.entry import plain

import stiction as st
from stiction.solver import reference
from stiction.solver.accuracy import tolerance
from stiction.solver.exact.pursuit import landing_slip, landing_time
from stiction.solver.reference import reference_run
from stiction.solver.segments import segments
from stiction.solver.stepping.radau import (
    DEFECT_WEIGHT,
    DERIVATIVE,
    INTEGRAL,
    INTERIOR,
    LATER,
    LATER_WEIGHT,
    VALUE,
    A,
    C,
    D,
    cubic,
    cubic_slope,
)
from stiction.solver.stick import stick_duration

EPS = np.finfo(float).eps
cubic, cubic_slope, stick_duration = map(plain, (cubic, cubic_slope, stick_duration))
landing_slip, landing_time = map(plain, (landing_slip, landing_time))
NAMES = ("u_x", "u_y", "slip_x", "slip_y")
PAPER = st.presets.nakano_popov_2020()


def largest(values):
    return np.max(np.abs(values), initial=0.0)


def sample_run(run):
    return np.array([run.data[name].values for name in NAMES])


# --- compiled and reference ---------------------------------------------------------------------

FASTER = PAPER.replace(drive=st.ConstantVelocity("10 mm/s"), phi="5 deg")  # short runs say enough
SOFTER = PAPER.replace(k_y="50 kN/m", drive=st.ConstantVelocity("5 mm/s"), phi="3 deg")
RELEASED = PAPER.replace(k_y="2 kN/m", phi="0 deg", drive=st.ConstantVelocity(0.0))
BLOCK = st.Slider(mass=1, k_x=1, k_y=1, phi="0 deg", normal_load=1, friction=st.Coulomb(mu_0=1.0))
STRENGTHENING = st.ExponentialWeakening(mu_0=0.2, mu_inf=0.3, v_f="10 mm/s")

STAGES = SOFTER.replace(mass_y="0.6 kg")
ASKEW = SOFTER.replace(
    mass_y="0.6 kg", mass_angle="35 deg", c_x=2.0, c_y=9.0, damping_angle="-50 deg", phi="12 deg"
)
GRAIN = st.laws.Anisotropic(SOFTER.law, 1.4, "25 deg")
SERIES = ASKEW.replace(
    springs=[st.Spring("cell", "4 kN/m", "rigid", "20 deg"), st.Spring("leaf", "1 kN/m", "50 kN/m")]
)

# slider, duration (s), initial state
CASES = {
    "the paper's": (PAPER, 0.0185, None),
    "rapid slips": (SOFTER, 0.6, None),
    "negative misalignment": (SOFTER.replace(phi="-5 deg"), 0.5, None),
    "oblique": (SOFTER.replace(phi="45 deg"), 0.3, None),
    "no misalignment": (SOFTER.replace(phi="0 deg"), 0.5, None),
    "constant friction": (FASTER.replace(friction=st.Coulomb(mu_0=0.2)), 0.005, None),
    "strengthening": (FASTER.replace(friction=STRENGTHENING), 0.005, None),
    "weak dampers": (FASTER.replace(c_x=5.0, c_y=5.0), 0.005, None),
    "strong dampers": (FASTER.replace(c_x=20.0, c_y=1e3), 0.005, None),
    "released": (RELEASED, 1.0, st.Initial(u_x=0.02, v_x=0.0, v_y=0.4)),
    "steep friction": (
        BLOCK.replace(
            friction=st.ExponentialWeakening(mu_0=0.6, mu_inf=0.8, v_f=0.01),
            drive=st.ConstantVelocity(0.1),
        ),
        15.0,
        st.Initial(u_x=-4.0, v_x=0.0, v_y=0.0),
    ),
    "stages": (STAGES, 0.4, None),
    "all askew": (ASKEW, 0.2, None),
    "a loaded start, askew": (ASKEW, 0.4, st.Initial(u_x=0.02, u_y=0.004, v_x=0.0, v_y=0.0)),
    "askew on a grain": (ASKEW.replace(friction=GRAIN), 0.2, None),
    "springs in series": (SERIES, 0.2, None),
    "back and forth": (BLOCK, 30.0, st.Initial(u_x=12.0, v_x=6.0, v_y=0.0)),
}


@pytest.mark.parametrize("name", CASES)
def test_compiled_and_reference_agree(name):
    slider, duration, initial = CASES[name]
    runs = [
        st.simulate(slider, duration, sample_rate=50 / duration, initial=initial, rtol=rtol)
        for rtol in (1e-10, 1e-9)
    ]
    times = runs[0].data["time"].values
    references = [
        reference_run(slider, duration, times, initial=initial, rtol=rtol) for rtol in (1e-11, 1e-9)
    ]

    ours, loose = map(sample_run, runs)
    theirs, rough = (np.array([getattr(run, name) for name in NAMES]) for run in references)
    # beside the changes: rounding, of sines and cosines above all
    rounding = 100 * EPS * np.repeat([largest(ours[:2]), largest(ours[2:])], 2)
    for k in range(len(NAMES)):
        changes = largest(ours[k] - loose[k]) + largest(theirs[k] - rough[k])
        assert changes <= 1e-5 * largest(ours[k]) + rounding[k], "neither has converged"
        assert largest(ours[k] - theirs[k]) <= changes + rounding[k]

    sticks = [run.stick_intervals for run in runs]
    counts = {len(each) for each in (*sticks, *(run.sticks for run in references))}
    assert len(counts) == 1
    assert counts.pop() >= 1
    # the first landing, after 1e-10 s, is in closed form at either rtol; it may miss zero slip by
    # the local tolerance, at most that times V, which friction brakes away at F_0/m
    braking = tolerance(1e-10) * slider.drive.velocity * slider.mass / slider.F_0
    changes = largest(sticks[0] - sticks[1]) + largest(references[0].sticks - references[1].sticks)
    assert changes <= 1e-6 * duration
    assert largest(sticks[0] - references[0].sticks) <= changes + braking


def test_the_cases_stick_and_slip_as_they_should():
    """Micro stick-slip, rapid slips between creep, and friction that stops the mass only once."""
    counts = {}
    for name, (slider, duration, initial) in CASES.items():
        counts[name] = len(st.simulate(slider, duration, initial=initial).stick_intervals)
    assert counts["the paper's"] == 8
    assert counts["rapid slips"] == 12
    assert counts["constant friction"] == counts["released"] == counts["back and forth"] == 1


def test_the_twin_starts_and_ends_where_it_is_told():
    c, s = PAPER.direction
    at_rest = st.Initial(u_x=1e-6, v_x=1e-3 * c, v_y=1e-3 * s, time=0.5)
    run = reference_run(PAPER, 1e-3, initial=at_rest)
    assert run.t.tolist() == [0.5, 0.501]
    assert run.sticks == pytest.approx(np.array([[0.5, 0.501]]), rel=EPS)
    assert run.u_x == pytest.approx([1e-6, 1e-6 + 1e-6 * c], rel=1e-12)


FORCES = [(1.0, 0.0), (0.6, 0.8), (-0.8, 0.3), (0.0, -1.0), (0.7, -0.7)]
ALONG = pytest.mark.parametrize("force", FORCES)
RIGS = {"alike all around": SOFTER, "a grain": SOFTER.replace(friction=GRAIN), "stages": STAGES}
RIGS["all askew"] = ASKEW.replace(friction=GRAIN)


@ALONG
@pytest.mark.parametrize("beyond", [1.0, 1.0001, 1.2, 3.0])
@pytest.mark.parametrize("rig", RIGS)
def test_where_the_twin_s_slip_begins(rig, force, beyond):
    """Along n(s) = g/F_0 at the friction limit; beyond it the mass accelerates along its slip."""
    equations = reference.equations_of(RIGS[rig])
    F_0 = RIGS[rig].F_0
    g = np.array(force) * beyond * F_0 / np.sqrt(equations.use(np.array(force), np.array(force)))
    e = reference.first_direction(equations, g)
    assert e @ e == pytest.approx(1.0, rel=1e-14)
    if beyond == 1.0:
        assert equations.toward(e) * F_0 == pytest.approx(g, rel=1e-12, abs=1e-12 * F_0)
        return
    a = equations.acceleration(g, e, F_0)
    assert a @ e > 0.0
    # its angle is a root to 1e-15, of a function that changes by F_0/m per radian
    assert e[0] * a[1] - e[1] * a[0] == pytest.approx(0.0, abs=1e-13 * beyond * F_0 / 0.1)
    if rig == "alike all around":
        assert e == pytest.approx(g / np.hypot(*g), rel=1e-12, abs=1e-12)


@ALONG
@pytest.mark.parametrize("rig", RIGS)
def test_how_long_the_twin_sticks(rig, force):
    """Until g.N^-1 g is F_0^2 again, from any force below; no time at all from one beyond."""
    slider, equations = RIGS[rig], reference.equations_of(RIGS[rig])
    limit = np.array(force) * slider.F_0 / np.sqrt(equations.use(np.array(force), np.array(force)))
    rest = limit - equations.drive @ equations.damping
    u = np.linalg.solve(equations.stiffness, 0.9 * limit - equations.drive @ equations.damping)
    held = reference.time_held(equations, u)
    assert held > 0.0
    g = equations.pull(u + equations.drive * held, np.zeros(2))
    assert equations.use(g, g) == pytest.approx(slider.F_0**2, rel=1e-10)
    change = equations.drive @ equations.stiffness
    assert equations.use(g, change) > 0.0  # it would grow beyond
    beyond = np.linalg.solve(equations.stiffness, rest + 1e-3 * limit)
    assert reference.time_held(equations, beyond) == 0.0


@pytest.mark.parametrize("share", [0.3, 0.9, 1.5])
def test_how_long_the_twin_takes_to_land(share):
    """As s' = a - f s/|s| says: (f^2 - |a|^2) T = r (f + a.e), or (f + |a|) T = r against it."""
    equations = reference.equations_of(SOFTER)
    f, r = SOFTER.F_0 / SOFTER.mass, 1e-3
    e = np.array([0.6, -0.8])
    for turned in (pi,) if share > 1.0 else (0.0, 2.0, pi):
        c, s = np.cos(turned), np.sin(turned)
        a = share * f * np.array([c * e[0] - s * e[1], s * e[0] + c * e[1]])
        slip = r * e
        damper = (equations.drive - slip) @ equations.damping
        u = np.linalg.solve(equations.stiffness, a * SOFTER.mass - damper)
        T = r * (f + a @ e) / (f * f - a @ a) if share < 1.0 else r / (f * (1.0 + share))
        phase = reference.landing(equations, 0.0, 1.0, u, slip)
        assert phase.end == pytest.approx(T, rel=1e-12)
        there, left = phase.state(phase.end)
        assert not left.any()
        assert phase.state(0.5 * phase.end)[1] == pytest.approx(0.5 * slip)
        gone = equations.drive * T - 0.5 * slip * T
        assert there == pytest.approx(u + gone, rel=0.0, abs=4 * EPS * largest(u))
    assert reference.landing(equations, 0.0, 0.5 * T, u, slip).end == 0.5 * T


@pytest.mark.parametrize("rig", ["a grain", "stages", "all askew"])
def test_the_twin_lands_as_its_slip_decelerates(rig):
    """Of a rig that is not alike all around: r falls at the rate -ds/dt . e, until it is zero."""
    equations, slip = reference.equations_of(RIGS[rig]), 1e-3 * np.array([0.6, -0.8])
    u = np.array([1e-4, -2e-5])
    a = equations.acceleration(equations.pull(u, slip), slip, equations.friction(0.0))
    phase = reference.landing(equations, 0.2, 1.0, u, slip)
    assert (slip + (phase.end - 0.2) * a) @ slip == pytest.approx(0.0, abs=1e-9 * slip @ slip)


@ALONG
@pytest.mark.parametrize("rig", RIGS)
def test_the_twin_s_take_off_obeys_its_equation(rig, force):
    """M ds/dt = g - F n and du/dt = v_d - s, by differences, of a force beyond the limit."""
    slider, equations = RIGS[rig], reference.equations_of(RIGS[rig])
    g = 1.1 * np.array(force) * slider.F_0 / np.sqrt(equations.use(*np.array([force, force])))
    u = np.linalg.solve(equations.stiffness, g - equations.drive @ equations.damping)
    phase = reference.take_off(equations, 0.3, 1.0, u)
    assert 0.3 < phase.end <= 0.3 + reference.TAKE_OFF / equations.rate
    start, slip = phase.state(0.3)
    assert start == pytest.approx(u, rel=1e-12)
    assert slip == pytest.approx([0.0, 0.0], abs=1e-12 * slider.F_0 / slider.mass)
    for part in (0.2, 0.5, 0.8):
        t, step = 0.3 + part * (phase.end - 0.3), 1e-3 * (phase.end - 0.3)
        (u_0, s_0), (u_1, s_1), (u_2, s_2) = (phase.state(t + k * step) for k in (-1, 0, 1))
        assert u_2 - u_0 == pytest.approx(
            2 * step * (equations.drive - s_1), abs=1e-5 * step * np.hypot(*s_1)
        )
        a = equations.acceleration(
            equations.pull(u_1, s_1), s_1, equations.friction(np.hypot(*s_1))
        )
        assert (s_2 - s_0) / (2 * step) == pytest.approx(a, abs=1e-5 * np.hypot(*a))


def test_the_twin_s_ellipse_has_the_axes_of_the_grain():
    """Along the drive's angle plus the grain's, friction is F, across it `ratio` times as much."""
    slider = SOFTER.replace(phi="10 deg", friction=GRAIN)
    equations, angle = reference.equations_of(slider), np.radians(10.0 + 25.0)
    along = np.array([np.cos(angle), np.sin(angle)])
    assert equations.toward(along) == pytest.approx(along)
    across = np.array([-along[1], along[0]])
    assert equations.toward(across) == pytest.approx(1.4 * across)


def test_the_twin_takes_off_for_half_as_long_where_friction_changes_fast():
    """Or a quarter, ...: here it loses half over a slip that a whole take-off exceeds by far."""
    equations = reference.equations_of(RIGS["alike all around"])
    F_0, whole = equations.friction(0.0), reference.TAKE_OFF / equations.rate
    fast = 0.1 * F_0 * equations.mobility[0, 0] * whole
    weak = equations._replace(friction=lambda v: F_0 * (0.5 + 0.5 * np.exp(-v / fast)))
    u = np.linalg.solve(equations.stiffness, [1.1 * F_0, 0.0])
    halves = np.log2(whole / (reference.take_off(weak, 0.3, 1.0, u).end - 0.3))
    assert halves == pytest.approx(round(halves))
    assert 1 <= round(halves) < 10


def test_the_twin_finds_no_take_off_where_friction_falls_at_once():
    """No polynomial in time follows a jump of friction, however short it is."""
    equations = reference.equations_of(RIGS["alike all around"])
    F_0 = equations.friction(0.0)
    jump = equations._replace(friction=lambda v: F_0 if v == 0.0 else 0.5 * F_0)
    u = np.linalg.solve(equations.stiffness, [1.1 * F_0, 0.0])
    with pytest.raises(ArithmeticError, match=r"take-off at t = 0.3 s is not found"):
        reference.take_off(jump, 0.3, 1.0, u, 1.5e-6)


def test_the_twin_refuses_a_drive_that_is_not_steady():
    with pytest.raises(ValueError, match="steady drive"):
        reference_run(
            PAPER.replace(
                drive=st.protocols.DriveProgram(along=st.protocols.Modulation(1e-3, 1.0))
            ),
            1.0,
        )


# --- the regularised law ------------------------------------------------------------------------


def solve_smoothed(slider, times, delta, rtol):
    """Eqs. (4) and (5) with s/|s| replaced by s/sqrt(|s|^2 + delta^2): u and slip at `times`."""
    drive = slider.drive.velocity * np.array(slider.direction)
    stiffness = np.array([slider.k_x, slider.k_y]) / slider.mass

    def change(t, y):
        u, s = y[:2], y[2:]
        r = hypot(*s)
        f = slider.law.coefficient(r) * slider.normal_load / slider.mass
        return [*(drive - s), *(stiffness * u - f * s / hypot(r, delta))]

    speed = abs(drive[1])  # of the transverse motion, whose distance is speed/omega_y
    atol = rtol * speed * np.array([1 / np.sqrt(stiffness[1])] * 2 + [1.0] * 2)
    y0 = [0.0, 0.0, *st.Initial().slip(slider)]
    span = (times[0], times[-1])
    solution = solve_ivp(change, span, y0, "LSODA", times, rtol=rtol, atol=atol)
    assert solution.success
    return solution.y


@pytest.mark.parametrize("delta", [1e-6, 1e-7, 1e-8])
def test_regularised_solver_agrees_with_lsoda(delta):
    runs = [
        st.simulate(PAPER, 0.03, sample_rate=1e4, rtol=rtol, regularisation=delta)
        for rtol in (1e-10, 1e-9)
    ]
    times = runs[0].data["time"].values
    ours, loose = map(sample_run, runs)
    theirs, rough = (solve_smoothed(PAPER, times, delta, rtol) for rtol in (1e-10, 1e-8))
    for k in range(len(NAMES)):
        changes = largest(ours[k] - loose[k]) + largest(theirs[k] - rough[k])
        assert changes <= 1e-4 * largest(ours[k]), "neither has converged"
        assert largest(ours[k] - theirs[k]) <= changes


def test_set_valued_friction_is_the_limit_of_the_regularised_law():
    """By SciPy alone: extrapolated to delta = 0 the regularised law gives the exact solver's u.

    Where a stick ends, |a| = f + j t, the regularised slip leaves its creep at s ~ j t^2 with
    f delta^2/s^2 ~ j t, that is at t ~ delta^(2/5) and s ~ delta^(4/5); what it has gained by
    then stays. So the solution is a series in delta^(1/5) that starts with delta^(4/5): slower
    than in proportion.
    """
    exact = st.simulate(PAPER, 0.03, sample_rate=1e3, rtol=1e-12)
    u = sample_run(exact)[:2]
    deltas = np.geomspace(1e-9, 4e-12, 4)
    found = np.array(
        [solve_smoothed(PAPER, exact.data["time"].values, d, 1e-11)[:2] for d in deltas]
    )
    errors = np.abs(found - u).max(axis=2)  # by delta, then x and y
    orders = np.log(errors[:-1] / errors[1:]) / np.log(deltas[0] / deltas[1])
    assert np.all(np.diff(orders, axis=0) > 0)
    assert np.all((orders[-1] > 0.72) & (orders[-1] < 0.8))

    powers = np.array([0.0, 0.8, 1.0, 1.2])
    limits = []
    for n in (2, 3, 4):  # from the n smallest, so that n - 1 terms of the series cancel
        weights = np.linalg.inv(deltas[-n:, None] ** powers[:n])[0]
        limits.append(np.tensordot(weights, found[-n:], axes=1))
    left = np.abs(np.array(limits) - u).max(axis=2)
    # each term is smaller than the last by some delta^(1/5) = 0.01, until the tolerance shows
    assert np.all(left[0] < 0.2 * errors[-1])
    assert np.all(left[1] < 0.2 * left[0])
    assert np.all(left[2] < 0.01 * errors[-1])


# --- pieces -------------------------------------------------------------------------------------


@pytest.mark.parametrize("angle", [0.0, 0.7, pi / 2, 2.5, -3.0])
@pytest.mark.parametrize("ratio", [0.0, 1e-9, 0.3, 0.95])
def test_landing_in_closed_form(ratio, angle):
    """Against s' = a - f s/|s| by SciPy, down to a millionth of the slip speed."""
    r, f, small = 3e-2, 8.0, 1e-6
    a = ratio * f * np.array([np.cos(angle), np.sin(angle)])

    def change(t, y):
        return [y[2], y[3], *(a - f * y[2:] / hypot(*y[2:]))]

    def almost_landed(t, y):
        return hypot(*y[2:]) - small * r

    almost_landed.terminal = True
    solution = solve_ivp(
        change,
        (0.0, inf),
        [0.0, 0.0, r, 0.0],
        "DOP853",
        events=almost_landed,
        rtol=1e-10,
        atol=1e-10 * small * r * np.array([r / f, r / f, 1.0, 1.0]),
    )
    time, slid = solution.t[-1], solution.y[:2, -1]
    T = landing_time(r, a[0], a @ a, f)
    # a millionth of r lasts at most r/(f - |a|) at that speed; the integration's own error
    # is 1e-10 a step
    rest = small * r / (f - hypot(*a))
    assert pytest.approx(time, abs=rest + 1e-8 * T) == T
    assert landing_slip(r, *a, f) == pytest.approx(slid, abs=small * r * rest + 1e-8 * r * T)


def friction_excess(slider, u, tau):
    """|K (u + v_d tau) + C v_d| less mu_0 W."""
    drive = slider.drive.velocity * np.array(slider.direction)
    k, c = np.array([slider.k_x, slider.k_y]), np.array([slider.c_x, slider.c_y])
    return hypot(*(k * (u + drive * tau) + c * drive)) - slider.F_0


def held_for(slider, u_x, u_y):
    """What the compiled solver says about a stick from t = 0 on."""
    segment = next(segments(slider, 0.0, 1.0))
    return stick_duration(segment.problem, 0.0, u_x, u_y, segment.end)[0]


@pytest.mark.parametrize("c_y", [0.0, 1e4])
@pytest.mark.parametrize("share", [-0.999, -0.5, 0.0, 0.5, 0.999])
@pytest.mark.parametrize("angle", [0.0, 1.0, -1.5])
def test_stick_duration_is_the_root(angle, share, c_y):
    slider = PAPER.replace(c_x=50.0, c_y=c_y)
    k = np.array([slider.k_x, slider.k_y])
    u = share * slider.F_0 / k * [np.cos(angle), np.sin(angle)]
    duration = held_for(slider, *u)
    if friction_excess(slider, u, 0.0) > 0.0:
        assert duration == 0.0
        return
    far = 4 * slider.F_0 / (slider.k_x * slider.drive.velocity)
    root = brentq(lambda tau: friction_excess(slider, u, tau), 0.0, far, xtol=1e-300, rtol=4 * EPS)
    # both find the root of a difference of forces that are rounded to a few EPS F_0
    slope = (
        abs(friction_excess(slider, u, root + 1e-6) - friction_excess(slider, u, root - 1e-6))
        / 2e-6
    )
    assert duration == pytest.approx(root, abs=10 * EPS * slider.F_0 / slope, rel=10 * EPS)


def test_stick_duration_at_the_edge():
    """Friction used up: held if the drive unloads the spring, released if it loads it."""
    limit = PAPER.F_0 / PAPER.k_x
    assert held_for(PAPER, limit, 0.0) == 0.0
    assert held_for(PAPER, 1.01 * limit, 0.0) == 0.0
    V_x, V_y = 1e-3 * np.array(PAPER.direction)
    back = 2 * limit * V_x * PAPER.k_x**2 / ((V_x * PAPER.k_x) ** 2 + (V_y * PAPER.k_y) ** 2)
    assert held_for(PAPER, -limit, 0.0) == pytest.approx(back, rel=1e-12)
    still = PAPER.replace(drive=st.ConstantVelocity(0.0))
    assert held_for(still, 0.5 * limit, 0.0) == inf
    assert held_for(still, 1.5 * limit, 0.0) == 0.0


def test_radau_coefficients():
    """Hairer & Wanner, section IV.5: B(5), C(3), D(2), stiffly accurate; D the inverse of A."""
    a, c = np.array(A), np.array(C)
    b = a[2]  # stiffly accurate: the step's end is the last stage
    assert c[2] == 1.0
    close = {"rel": 0, "abs": 10 * EPS}
    for k in range(1, 6):
        assert b @ c ** (k - 1) == pytest.approx(1 / k, **close)
    for k in range(1, 4):
        assert a @ c ** (k - 1) == pytest.approx(c**k / k, **close)
    for k in range(1, 3):
        assert (b * c ** (k - 1)) @ a == pytest.approx(b * (1 - c**k) / k, **close)
    assert np.array(D) @ a == pytest.approx(np.eye(3), rel=0, abs=10 * EPS * np.abs(D).max())


def test_collocation_cubic():
    """Through 0 and the stages any cubic is itself, as are its derivative and integral."""
    polynomial = np.polynomial.Polynomial([0.3, -1.1, 2.0, 0.7])
    values = tuple(polynomial(np.array([0.0, *C])))
    close = {"rel": 0, "abs": 100 * EPS}
    for x in (0.0, 0.1, 0.5, 1.0, 2.5):
        assert cubic(values, x) == pytest.approx(polynomial(x), rel=1e3 * EPS)
        assert cubic_slope(values, x) == pytest.approx(polynomial.deriv()(x), rel=1e3 * EPS)
    assert np.dot(VALUE, values) == pytest.approx(polynomial(INTERIOR), **close)
    assert np.dot(DERIVATIVE, values) == pytest.approx(polynomial.deriv()(INTERIOR), **close)
    square = np.polynomial.Polynomial([0.3, -1.1, 2.0])  # stages alone hold a quadratic
    wanted = square.integ()(INTERIOR)
    assert np.dot(INTEGRAL, square(np.array(C))) == pytest.approx(wanted, **close)


def test_defect_weight():
    """Largest error in a step over the defect at the interior point, to two digits."""
    nodes = np.polynomial.Polynomial.fromroots(C)
    error, defect = nodes.integ(), nodes(INTERIOR)
    worst = max(abs(error(x)) for x in np.linspace(0.0, 1.0, 1001))
    assert worst / abs(defect) == pytest.approx(DEFECT_WEIGHT, rel=0.05)
    assert worst / abs(nodes(LATER)) == pytest.approx(LATER_WEIGHT, rel=0.05)
