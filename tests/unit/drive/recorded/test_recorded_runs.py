"""Runs whose drive and load follow a table, against analytic pieces, SciPy and closed forms."""

from itertools import pairwise
from math import sqrt

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq
from tests.entry import plain
from tests.systems import STEADY

import stiction as st
from stiction.analysis.motion.cycle_columns import table_of
from stiction.analysis.motion.metadata.comparison import compare_metadata
from stiction.analysis.motion.metadata.loading_rate import LOADING_RATE
from stiction.drive.program import nominal_velocity
from stiction.solver.problem import Bend, Bends
from stiction.solver.segments import segments
from stiction.solver.stick import margin

p = st.protocols
V, SWING, F = 1e-3, 0.4e-3, 7.0
OMEGA = 2 * np.pi * F
DRIVEN = pytest.mark.parametrize("driven", ["plate", "spring"])
KINDS = pytest.mark.parametrize("kind", ["velocity", "position"])


def harmonic(count, kind):
    """A table of V + SWING sin(OMEGA t), or of its integral, over 1 s."""
    t = np.linspace(0.0, 1.0, count + 1)
    if kind == "velocity":
        return p.Recorded(time=t, velocity=V + SWING * np.sin(OMEGA * t))
    return p.Recorded(time=t, position=V * t + SWING / OMEGA * (1 - np.cos(OMEGA * t)))


def off(run, other, *names):
    """The largest difference of two runs, relative to the largest value."""
    pairs = [(run.data[name].values, other.data[name].values) for name in names]
    return max(np.abs(a - b).max() / np.abs(b).max() for a, b in pairs)


@DRIVEN
@KINDS
def test_a_sampled_harmonic_converges_to_the_harmonic(driven, kind):
    """The elongation at the order of the spline's travel: 4, with sticks and slips in between."""
    slider = st.presets.nakano_popov_2020().replace(driven=driven)
    exact = p.DriveProgram(velocity=V, along=p.Modulation(SWING, F))
    settings = {"duration": 0.5, "sample_rate": 200, "rtol": 1e-9}
    wanted = st.simulate(slider.replace(drive=exact), **settings)
    errors = []
    for count in (100, 800):
        drive = p.DriveProgram(program=[harmonic(count, kind)])
        run = st.simulate(slider.replace(drive=drive), **settings)
        assert run.status.ok
        assert abs(len(run.stick_intervals) - len(wanted.stick_intervals)) <= 1
        errors.append(off(run, wanted, "u_x"))
    assert errors[1] < 1e-8
    assert errors[1] < errors[0] / 8**3.5


@DRIVEN
def test_tables_of_lines_are_ramps_and_steps(driven):
    """A cubic spline of a line is the line: the run is that of the pieces, up to the tolerance."""
    t = np.linspace(0.0, 0.2, 9)
    ramp = p.Recorded(time=t + 7.0, velocity=1e-3 + 0.01 * t)
    level = p.Recorded(time=t, position=5.0 + 1e-3 * t)
    pieces = [
        p.Constant(1e-3, 1e-12),
        p.Ramp(3e-3, 0.2),
        p.Step(to=1e-3, duration=0.2),
        p.Hold(0.1),
    ]
    slider = STEADY.replace(driven=driven)
    settings = {"duration": 0.5, "sample_rate": 1e3, "rtol": 1e-9}
    found, wanted = (
        st.simulate(slider.replace(drive=p.DriveProgram(program=each)), **settings)
        for each in ([ramp, level, p.Hold(0.1)], pieces)
    )
    assert off(found, wanted, "u_x", "slip_x") < 1e-6
    loads = [p.RecordedLoad(time=t, load=10.0 + 20.0 * t), p.RecordedLoad(time=t, load=6.0 + 0 * t)]
    pieces = [p.Ramp(14.0, 0.2), p.Step(to=6.0, duration=0.2)]
    found, wanted = (
        st.simulate(slider.replace(load=p.LoadProgram(program=each)), **settings)
        for each in (loads, pieces)
    )
    assert off(found, wanted, "u_x", "slip_x") < 1e-6


T = np.linspace(0.0, 0.3, 41)
SPEED = 2e-3 * (1 + 0.6 * np.sin(2 * np.pi * 11 * T) + 0.3 * np.sin(2 * np.pi * 17 * T + 1))
LOAD = 10 + 2 * np.sin(2 * np.pi * 13 * T + 0.4)
DELTA = 1e-3


def value(coefficients, x):
    """Return the value of a polynomial, the highest power first."""
    total = 0.0
    for each in coefficients:
        total = total * x + each
    return total


@DRIVEN
@KINDS
def test_smooth_friction_agrees_with_scipy(driven, kind):
    """Both tables by SciPy's spline, the equations (1) to (5) by DOP853 from row to row."""
    values, rate, load = SPEED, CubicSpline(T, SPEED), CubicSpline(T, LOAD)
    if kind == "position":
        values = rate.antiderivative()(T)
        rate = CubicSpline(T, values).derivative()
    slider = STEADY.replace(
        k_y=1e5,
        driven=driven,
        drive=p.DriveProgram(program=[p.Recorded(time=T - 0.2, **{kind: values})]),
        load=p.LoadProgram(program=[p.RecordedLoad(time=T, load=LOAD)]),
    )
    run = st.simulate(slider, sample_rate=100, rtol=1e-9, regularisation=DELTA)
    assert run.description.run.duration == pytest.approx(0.3)
    law, (e_x, e_y) = slider.friction, slider.direction

    def change(t, y, start, rate, acceleration, load):
        (u_x, u_y, s_x, s_y), since = y.tolist(), t - start
        X, change = value(rate, since), value(acceleration, since) if driven == "plate" else 0.0
        v_x, v_y = e_x * X - s_x, e_y * X - s_y
        size = s_x * s_x + s_y * s_y
        friction = law.coefficient(sqrt(size)) * value(load, since) / sqrt(size + DELTA**2)
        a_x = (1e3 * u_x + 3.0 * v_x - friction * s_x) / slider.mass + e_x * change
        a_y = (1e5 * u_y + 20.0 * v_y - friction * s_y) / slider.mass + e_y * change
        return [v_x, v_y, a_x, a_y]

    names = ("u_x", "u_y", "slip_x", "slip_y")
    found = np.array([run.data[name].values for name in names]).T
    y, times = found[0], run.data["time"].values
    cubics = [each.c.T.tolist() for each in (rate, rate.derivative(), load)]
    for (start, end), *row in zip(pairwise(T), *cubics, strict=True):
        inside = np.flatnonzero((times > start + 1e-9) & (times < end - 1e-9))
        solution = solve_ivp(
            change, (start, end), y, method="DOP853", rtol=1e-11, atol=1e-16, dense_output=True,
            args=(start, *row),
        )  # fmt: skip
        for i in inside:
            error = np.abs(found[i] - solution.sol(times[i])).max(axis=0)
            assert error < 1e-7 * np.abs(found).max(axis=0).max()
        y = solution.y[:, -1]


def first_release(slider, travel, load, end):
    """When |a| reaches mu W/m at zero slip: a scan and Brent, on SciPy's splines."""
    m, e = slider.mass, np.array(slider.direction)
    k, c = np.array([slider.k_x, slider.k_y]), np.array([slider.c_x, slider.c_y])
    rate, mu = travel.derivative(), slider.law.coefficient(0.0)
    inertia = rate.derivative() if slider.driven == "plate" else np.zeros_like

    def margin(t):
        along = k * (travel(t) - travel(0.0))[..., None] + c * rate(t)[..., None]
        a = e * (along / m + inertia(t)[..., None])
        return np.hypot(*a.T) - mu * load(t) / m

    times = np.linspace(1e-9, end, 20001)
    i = int(np.argmax(margin(times) > 0.0))
    return brentq(margin, times[i - 1], times[i], xtol=1e-15)


@DRIVEN
@KINDS
@pytest.mark.parametrize("seed", range(4))
def test_a_stick_ends_where_the_margin_vanishes(driven, kind, seed):
    """In a stick over many rows of two tables, at which derivatives of the margin jump (M9)."""
    rng = np.random.default_rng(seed)
    t, w = np.linspace(0.0, 2.0, 161), np.linspace(0.0, 3.0, 97)
    phases, tones = rng.uniform(0, 7, 3), rng.uniform(1.0, 5.0, 3)
    waves = sum(0.2 * np.sin(2 * np.pi * f * t + a) for f, a in zip(tones, phases, strict=True))
    speed = 1e-3 * (1 + waves)
    load, travel = 10 + 3 * np.sin(5 * w + seed), CubicSpline(t, speed).antiderivative()
    if kind == "position":
        travel = CubicSpline(t, travel(t))
    values = speed if kind == "velocity" else travel(t)
    slider = STEADY.replace(
        driven=driven,
        k_y=1e4,
        phi="20 deg",
        drive=p.DriveProgram(program=[p.Recorded(time=t, **{kind: values})]),
        load=p.LoadProgram(program=[p.RecordedLoad(time=w, load=load)]),
    )
    start = st.Initial(
        v_x=slider.direction[0] * slider.motion.rate(0.0)[0],
        v_y=slider.direction[1] * slider.motion.rate(0.0)[0],
    )
    run = st.simulate(slider, 2.0, initial=start, sample_rate=0, rtol=1e-9)
    begin, end = run.stick_intervals[0]
    assert begin == 0.0
    assert end == pytest.approx(first_release(slider, travel, CubicSpline(w, load), 2.0), abs=1e-11)
    assert end > t[20]


@DRIVEN
def test_bounds_of_the_margin_hold_between_rows(driven):
    """(M8) in each piece, by differences of the margin along a stick."""

    slider = STEADY.replace(
        driven=driven,
        drive=p.DriveProgram(program=[p.Recorded(time=T, velocity=SPEED)]),
        load=p.LoadProgram(program=[p.RecordedLoad(time=T[::2], load=LOAD[::2])]),
    )
    problem = next(segments(slider, 0.0, 0.3)).problem
    assert isinstance(problem.bend, Bends)
    assert len(problem.bend.values) == 40
    e, step = np.array(slider.direction), 1e-6
    for i, bound in enumerate(problem.bend.values):
        start, end = problem.bend.rows[i : i + 2]
        for t in np.linspace(start + 2 * step, end - 2 * step, 7):

            def rate(at):
                u = e * problem.drive.travel(0.0, at)[0]
                return 2.0 * plain(margin)(problem, at, *u)[1]

            excess = plain(margin)(problem, t, *(e * problem.drive.travel(0.0, t)[0]))[0]
            if excess <= 0.0:  # while it sticks, |a| <= f
                assert (rate(t + step) - rate(t - step)) / (2 * step) <= bound * (1 + 1e-6)


def test_a_drive_without_a_table_keeps_one_bound():
    assert isinstance(next(segments(STEADY, 0.0, 1.0)).problem.bend, Bend)


def test_steps_end_at_rows():
    """So that no derivative jumps inside a step; without a table they end at the run's end."""
    rows = Bends(np.array([0.0, 0.1, 0.3]), np.array([5.0, 7.0]))
    assert [rows.smooth_until(t, 0.25) for t in (0.0, 0.05, 0.1, 0.2)] == [0.1, 0.1, 0.25, 0.25]
    assert [rows.bend_after(t) for t in (-1e-9, 0.0, 0.05, 0.1, 0.3)] == [5.0, 5.0, 5.0, 7.0, 7.0]
    assert Bend(3.0).smooth_until(0.1, 0.7) == 0.7
    assert Bend(3.0).bend_after(0.1) == 3.0


@pytest.mark.parametrize("method", ["multiscale", "state", "vanishing"])
def test_all_methods_follow_a_table(method):
    """A table, and then a steady drive, at which the multiscale solver interpolates again."""
    load = LOAD if method != "vanishing" else LOAD - 120 * np.maximum(T - 0.2, 0.0) ** 1
    slider = STEADY.replace(
        drive=p.DriveProgram(program=[p.Recorded(time=T, velocity=SPEED), p.Constant("2 mm/s")]),
        load=p.LoadProgram(program=[p.RecordedLoad(time=T, load=load)]),
    )
    if method == "state":
        slider = slider.replace(
            friction=st.laws.LuGre(mu_c=0.15, mu_s=0.2, v_s="40 mm/s", sigma_0=1e6, sigma_1=1e3)
        )
    settings = {"sample_rate": 500, "rtol": 1e-7}
    run = st.simulate(slider, 0.6, multiscale=method == "multiscale", **settings)
    if method == "vanishing":
        assert run.status is st.Status.CONTACT_LOST
        last = run.data["time"].values[-1]
        zero = next(t for t in CubicSpline(T, load).roots() if 0 < t < 0.3)
        assert last == pytest.approx(zero, abs=1e-9)
        return
    assert run.status.ok
    fine = st.simulate(slider, 0.6, sample_rate=500, rtol=1e-9)
    assert off(run, fine, "u_x") < 1e-5


def test_the_work_of_a_recorded_drive_is_accounted_for():
    for driven in ("plate", "spring"):
        slider = STEADY.replace(
            driven=driven,
            drive=p.DriveProgram(program=[p.Recorded(time=T, velocity=SPEED)]),
            load=p.LoadProgram(program=[p.RecordedLoad(time=T, load=LOAD)]),
        )
        budget = st.analysis.energy_budget(st.simulate(slider))
        assert float(budget["work"][0]) > 0.0
        assert abs(float(budget["residual"][0])) < float(budget["bound"][0])


def test_a_table_sampled_anyhow_gives_the_same_run():
    """Samples do not influence steps, and rows do not recompile."""
    slider = STEADY.replace(drive=p.DriveProgram(program=[p.Recorded(time=T, velocity=SPEED)]))
    coarse, fine = (st.simulate(slider, sample_rate=rate) for rate in (100, 10_000))
    assert coarse.data["u_x"].values == pytest.approx(fine.data["u_x"].values[::100], abs=0.0)
    assert coarse.statistics == fine.statistics


def starting(rest, count=801, end=4.0):
    """A stage that rests, starts smoothly in 0.2 s, and goes at V with a stutter: its table."""
    t = np.linspace(0.0, end, count)
    begun = 0.5 * (1 - np.cos(np.pi * np.clip((t - rest) / 0.2, 0.0, 1.0)))
    return p.Recorded(time=t, velocity=V * begun * (1 + 0.2 * np.sin(2 * np.pi * 3.0 * (t - rest))))


@pytest.mark.parametrize("rest", [0.1, 0.5])
def test_a_stage_that_rests_at_first_moves_the_mass_when_it_starts(rest):
    """However long it rests: the same motion, later."""
    slider = st.presets.nakano_popov_2020().replace(phi="0 deg")
    at_once, later = (
        st.simulate(slider.replace(drive=p.DriveProgram(program=[starting(each)])), 3.0, rtol=1e-9)
        for each in (0.0, rest)
    )
    first, then = (run.stick_intervals[0, 1] for run in (at_once, later))
    assert 1.9 < first < 2.6  # F_0/(k_x V), and the start
    assert then == pytest.approx(first + rest, abs=1e-6)  # the splines differ at their ends
    for run in (at_once, later):
        assert run.samples["friction"].max() <= (1 + 1e-9) * slider.F_0


def test_analyses_take_the_drive_velocity_from_the_table():
    slider = st.presets.nakano_popov_2020()
    run = st.simulate(slider.replace(drive=p.DriveProgram(program=[starting(0.5, end=8.0)])), 8.0)
    velocity = st.analysis.record_of(run).drive_velocity
    # the mean of what is left of a start of 0.2 s, without its slowest tenth
    assert velocity == pytest.approx(V, rel=0.02)
    found = st.analyse(run)
    assert found.regime.kind == "stick-slip"
    its = compare_metadata(found.record, found.regime.kind, table_of(found.cycles), None, ())
    (rate,) = (each for each in its if each.quantity == LOADING_RATE)
    assert rate.agrees
    assert rate.stated == pytest.approx(slider.k_x * velocity, rel=1e-12)
    assert not any("goes back" in each for each in found.warnings)


@pytest.mark.parametrize(
    ("program", "base", "nominal"),
    [
        ([harmonic(100, "velocity")], 0.0, V),
        ([harmonic(100, "position")], 0.0, V),
        ([harmonic(100, "velocity")], 2 * V, 2 * V),  # as it is given
        ([p.Recorded(T, velocity=np.sin(2 * np.pi * T / 0.3))], 0.0, 0.0),  # to and fro
        ([p.Recorded(T, velocity=0.0 * T)], 0.0, 0.0),
        ([p.Constant(V, 1.0)], 0.0, V),  # it goes on so
        (
            [p.Recorded(T, velocity=0.0 * T - V), p.Recorded(T, velocity=0.0 * T - 3 * V)],
            0.0,
            -2 * V,
        ),
    ],
)
def test_the_nominal_velocity_is_the_mean_of_recorded_pieces(program, base, nominal):
    drive = p.DriveProgram(velocity=base, program=program)
    # the cubic spline of a harmonic with 14 rows to a period has its mean to this
    assert nominal_velocity(drive) == pytest.approx(nominal, rel=1e-5, abs=1e-12)
