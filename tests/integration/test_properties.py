"""Properties of any system: energy, symmetry, scaling, restart, and an end of each run."""

from math import pi

import numpy as np
import pytest
from benchmarks.explore.draw import Draw
from tests.drawn import SEED

import stiction as st
from stiction.solver.accuracy import tolerance


def slider_of(draw: Draw, damped: bool = True) -> st.Slider:
    """A slider around the paper's, a decade or so each way, whose runs stay short."""
    mu_0 = draw.between(0.05, 1.0)
    return st.Slider(
        mass=draw.decades(0.01, 10),
        k_x=draw.decades(1e2, 1e4),
        k_y=draw.decades(1e4, 1e8),
        phi=f"{draw.between(0.1, 80)} deg",
        normal_load=draw.decades(1, 100),
        c_x=draw.among([0.0, 0.5]) if damped else 0.0,
        c_y=draw.among([0.0, 5.0]) if damped else 0.0,
        friction=draw.among(
            [
                st.Coulomb(mu_0=mu_0),
                st.ExponentialWeakening(mu_0=mu_0, mu_inf=0.7 * mu_0, v_f=0.01),
                st.ExponentialWeakening(mu_0=mu_0, mu_inf=1.2 * mu_0, v_f=0.01),
            ]
        ),
        drive=st.ConstantVelocity(draw.decades(1e-4, 1e-1)),
    )


def on_draws(count: int) -> pytest.MarkDecorator:
    """Repeat a test with so many streams of random numbers, the same each time."""
    return pytest.mark.parametrize("number", range(count))


@pytest.fixture
def draw(number: int) -> Draw:
    return Draw(SEED, number)


def shortest_period(slider: st.Slider) -> float:
    return 2 * pi * np.sqrt(slider.mass / max(slider.k_x, slider.k_y))


def some_periods(slider: st.Slider, count: float = 15.0) -> float:
    """The first stick and then `count` transverse periods."""
    return first_stick(slider) + count * shortest_period(slider)


def first_stick(slider: st.Slider) -> float:
    """The closed form, without damping: from rest until |K u| = mu_0 W."""
    c, s = slider.direction
    V = slider.motion.rate(0.0)[0]
    return slider.F_0 / (V * np.hypot(slider.k_x * c, slider.k_y * s))


def energy_residual(run: st.Trajectory, every: int) -> tuple[float, float]:
    """Work of the drive less what became of it, and the scale of both, in J (trapezoids).

    Work on the driven end = stored in springs and mass + dissipated by friction and dampers.
    """
    d = run.data.isel(time=slice(None, None, every))
    s, t = run.slider, d["time"].values
    c, n = s.direction
    V = s.motion.rate(0.0)[0]
    v_x, v_y = d["v_x"].values, d["v_y"].values
    pull_x = d["spring_x"].values + s.c_x * v_x
    pull_y = d["spring_y"].values + s.c_y * v_y
    work = np.trapezoid((pull_x * c + pull_y * n) * V, t)
    friction = np.trapezoid(d["friction"].values * d["slip_speed"].values, t)
    damper = np.trapezoid(s.c_x * v_x**2 + s.c_y * v_y**2, t)
    stored = 0.5 * (
        s.k_x * d["u_x"].values ** 2
        + s.k_y * d["u_y"].values ** 2
        + s.mass * d["slip_speed"].values ** 2
    )
    residual = work - friction - damper - (stored[-1] - stored[0])
    return residual, abs(work) + friction + damper + np.ptp(stored)


@on_draws(40)
def test_energy_balance(draw):
    slider = slider_of(draw)
    # from the end of the first stick on, so that the samples resolve what happens
    stick, duration = first_stick(slider), 15 * shortest_period(slider)
    (c, s), V = slider.direction, slider.motion.rate(0.0)[0]
    taut = st.Initial(u_x=V * c * stick, u_y=V * s * stick, v_x=V * c, v_y=V * s)
    run = st.simulate(slider, duration, sample_rate=20_000 / duration, rtol=1e-8, initial=taut)
    assert run.status.ok
    fine, scale = energy_residual(run, 1)
    coarse, _ = energy_residual(run, 2)
    # trapezoids halve their step: the fine sum is off by a third of the difference where the
    # integrand is smooth, by no more than all of it at the kinks of landing; the solver may
    # err by its local tolerance, 5e-7 here, in some steps of a kind
    assert abs(fine) <= abs(coarse - fine) + 10 * 5e-7 * scale


@on_draws(25)
def test_mirror_symmetry(draw):
    slider = slider_of(draw)
    """phi -> -phi mirrors the motion at the x axis, to the last bit."""
    duration = some_periods(slider)
    mirrored = slider.replace(phi=f"{-slider.phi!r} rad")
    one, other = (st.simulate(s, duration, sample_rate=500 / duration) for s in (slider, mirrored))
    for name, sign in (("u_x", 1), ("u_y", -1), ("slip_x", 1), ("slip_y", -1), ("friction", 1)):
        assert np.array_equal(one.data[name].values, sign * other.data[name].values)
    assert np.array_equal(one.stick_intervals, other.stick_intervals)


@on_draws(25)
def test_dimensional_scaling(draw):
    """Other units of mass, length and time leave the dimensionless solution unchanged."""
    slider = slider_of(draw, damped=False)
    mass, length, time = (draw.decades(1e-2, 1e2) for _ in range(3))
    law, V = slider.law, slider.motion.rate(0.0)[0]
    speed, force = length / time, mass * length / time**2
    scaled = slider.replace(
        mass=slider.mass * mass,
        k_x=slider.k_x * mass / time**2,
        k_y=slider.k_y * mass / time**2,
        normal_load=slider.normal_load * force,
        friction=type(law)(
            **(law._asdict() | ({"v_f": 0.01 * speed} if "v_f" in law._fields else {}))
        ),
        drive=st.ConstantVelocity(V * speed),
    )
    duration = some_periods(slider, 3.0)
    rate = 200 / duration
    one = st.simulate(slider, duration, sample_rate=rate, rtol=1e-9)
    other = st.simulate(scaled, duration * time, sample_rate=rate / time, rtol=1e-9)
    for name, unit in (("u_x", length), ("u_y", length), ("slip_speed", speed)):
        want = one.data[name].values * unit
        got = other.data[name].values[: len(want)]
        # rounding may flip the choice of a step, which moves the result by its tolerance;
        # a fast slip amplifies that
        assert got == pytest.approx(want[: len(got)], rel=1e-5, abs=1e-6 * np.abs(want).max())


@on_draws(25)
def test_restart_continues_the_trajectory(draw):
    slider, k = slider_of(draw), int(draw.between(5, 196))
    duration = some_periods(slider, 3.0)
    rate = 200 / duration
    whole = st.simulate(slider, duration, sample_rate=rate, rtol=1e-9)
    at = float(whole.data["time"][k])
    rest = st.simulate(slider, duration - at, sample_rate=rate, rtol=1e-9, initial=whole.state(at))
    for name in ("u_x", "u_y", "slip_speed", "X"):
        want = whole.data[name].values[k:]
        got = rest.data[name].values
        n = min(len(want), len(got))
        # a state from dense output is as accurate as the local tolerance, 5e-8 here; a slip
        # in progress amplifies that, and one that all but vanishes is known to V times that
        floor = tolerance(1e-9) * slider.motion.rate(0.0)[0] if name == "slip_speed" else 0.0
        scale = max(1e-4 * np.abs(want).max(), floor)
        assert got[:n] == pytest.approx(want[:n], rel=1e-4, abs=scale)


@on_draws(60)
def test_far_from_the_paper_a_run_ends_and_is_finite(draw):
    phi, ratio = draw.among([0.0, 0.01, 1.0, 30.0, 89.0, 90.0]), draw.decades(1.0, 1e6)
    V, mass, mu_inf = draw.decades(1e-7, 1.0), draw.decades(1e-4, 1e3), draw.between(0.0, 0.5)
    slider = st.Slider(
        mass=mass,
        k_x=1e3,
        k_y=1e3 * ratio,
        phi=f"{phi} deg",
        normal_load=10.0,
        friction=st.ExponentialWeakening(mu_0=0.2, mu_inf=mu_inf, v_f=0.01),
        drive=st.ConstantVelocity(V),
    )
    run = st.simulate(slider, some_periods(slider, 20.0), sample_rate=None, rtol=1e-6)
    tight = st.simulate(slider, some_periods(slider, 20.0), sample_rate=None, rtol=1e-9)
    assert run.status.ok, run.status.value
    assert tight.status.ok, tight.status.value
    for name in ("u_x", "u_y"):
        assert np.isfinite(run.data[name].values).all()
        # the local tolerance is 2e-5; some 25 of a period's steps err alike, twenty periods
        drift = 20 * 25 * 2e-5
        k = slider.k_x if name == "u_x" else slider.k_y
        scale = slider.F_0 / k + V * np.sqrt(mass / k)
        assert float(run.final[name]) == pytest.approx(float(tight.final[name]), abs=drift * scale)
