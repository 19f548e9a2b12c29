"""The numbers of a run: samples, sticks, small vibrations, and any units."""

from math import pi

import numpy as np
import pytest
from scipy.linalg import expm

import stiction as st


def ends(slider: st.Slider, times: list[float], **settings) -> list[st.Trajectory]:
    """Runs that end at these times."""
    return [st.simulate(slider, t, **settings) for t in times]


@pytest.mark.parametrize("rtol", [1e-6, 1e-9, 1e-11])
def test_a_sample_inside_a_step_is_the_end_of_a_run_to_there(slider, rtol):
    run = st.simulate(slider, 0.02, sample_rate=1e4, rtol=rtol)
    slipping = np.flatnonzero(run.data["slip_speed"].values > 0.0)[2::5]
    scale = 1e-3 * slider.direction[1]  # V sin(phi), the speed of the transverse motion
    omega = np.sqrt(slider.k_y / slider.mass)
    for k in slipping:
        end = st.simulate(slider, float(run.data["time"][k]), rtol=rtol).final
        for name, unit in (("slip_x", scale), ("slip_y", scale), ("u_y", scale / omega)):
            off = float(run.data[name][k]) - float(end[name])
            assert abs(off) < 0.1 * rtol * unit, (name, k)


def test_samples_of_a_smooth_law_are_as_exact(slider):
    bristles = slider.replace(friction=st.laws.LuGre(0.15, 0.2, 1e-2, 1e5, 30.0))
    run = st.simulate(bristles, 0.05, sample_rate=300.0, rtol=1e-9)
    for k in (4, 9, 14):
        end = st.simulate(bristles, float(run.data["time"][k]), rtol=1e-9).final
        for name in ("slip_x", "slip_y", "u_x", "u_y", "z_x", "z_y"):
            size = np.abs(run.data[name]).max().item()
            assert float(run.data[name][k]) == pytest.approx(float(end[name]), abs=1e-8 * size)


@pytest.mark.parametrize("rtol", [1e-3, 1e-6, 1e-9])
@pytest.mark.parametrize(("phi", "k_x", "k_y"), [(0, 1e3, 1e7), (90, 1e3, 1e7), (37, 1e3, 1e3)])
def test_a_slip_that_touches_zero_does_not_stick(phi, k_x, k_y, rtol):
    """Along an axis, constant friction: V (1 - cos) after the first stick, without an end."""
    V, mass = 1e-3, 0.25
    slider = st.Slider(
        mass=mass,
        k_x=k_x,
        k_y=k_y,
        phi=f"{phi} deg",
        normal_load=10.0,
        friction=st.Coulomb(0.2),
        drive=st.ConstantVelocity(V),
    )
    k = k_y if phi == 90 else k_x
    taut, period = 2.0 / (k * V), 2.0 * pi * np.sqrt(mass / k)
    run = st.simulate(slider, taut + 60.4 * period, sample_rate=20.0 / period, rtol=rtol)
    assert len(run.stick_intervals) == 1
    assert run.stick_intervals[0, 1] == pytest.approx(taut, rel=1e-9)
    assert run.statistics.time_stuck == pytest.approx(taut, rel=1e-6)
    later = run.data["time"].values > taut * (1 + 1e-9)
    assert not run.data["sticking"].values[later].any()


@pytest.mark.parametrize("V", [1e-3, 1.0])
@pytest.mark.parametrize("amplitude", [1e-9, 1e-6])
def test_a_small_vibration_about_steady_sliding_is_followed(V, amplitude):
    """Steady sliding plus what linear theory has of a spring let go; the drive is far faster."""
    slider = st.Slider(
        mass=0.25,
        k_x=1e3,
        k_y=1e5,
        phi="20 deg",
        normal_load=10.0,
        friction=st.Coulomb(0.2),
        drive=st.ConstantVelocity(V),
    )
    c, s = slider.direction
    K, friction = np.diag([slider.k_x, slider.k_y]), 0.2 * 10.0
    # friction turns with the slip: a damper F/V across the drive
    damping = friction / V * np.outer([-s, c], [-s, c])
    generator = np.block(
        [[np.zeros((2, 2)), np.eye(2)], [-K / slider.mass, -damping / slider.mass]]
    )
    steady = np.linalg.solve(K, friction * np.array([c, s]))
    start = st.Initial(u_x=steady[0] + amplitude, u_y=steady[1], v_x=0.0, v_y=0.0)
    duration = 0.15
    final = st.simulate(slider, duration, initial=start).final
    off = start.u_x - steady[0]
    want = expm(duration * generator) @ [off, 0.0, 0.0, 0.0]
    # what is quadratic in the amplitude, and the rounding of the elongation
    bend = 3.0 * amplitude * np.sqrt(slider.k_x / slider.mass) / V
    bound = (1e-4 + bend) * amplitude + 4e-16 * steady[0]
    assert float(final["u_x"]) - steady[0] == pytest.approx(want[0], abs=bound)
    assert float(final["u_y"]) - steady[1] == pytest.approx(want[1], abs=bound)


@pytest.mark.parametrize(
    ("mass", "length", "time"), [(0, 0, -60), (0, -60, 0), (60, 0, 0), (33, 60, 60), (-60, 11, 47)]
)
def test_units_that_differ_by_powers_of_two_change_no_bit(slider, mass, length, time):
    m, x, t = 2.0**mass, 2.0**length, 2.0**time
    scaled = slider.replace(
        mass=slider.mass * m,
        k_x=slider.k_x * m / t**2,
        k_y=slider.k_y * m / t**2,
        c_y=5.0 * m / t,
        normal_load=slider.normal_load * m * x / t**2,
        friction=st.ExponentialWeakening(0.2, 0.15, 0.01 * x / t),
        drive=st.ConstantVelocity(1e-3 * x / t),
    )
    one = st.simulate(slider.replace(c_y=5.0), 0.03)
    other = st.simulate(scaled, 0.03 * t)
    assert np.array_equal(one.stick_intervals * t, other.stick_intervals)
    assert one.statistics.steps == other.statistics.steps
    for name, unit in (("u_x", x), ("u_y", x), ("slip_speed", x / t), ("friction", m * x / t**2)):
        assert float(one.final[name]) * unit == float(other.final[name])
