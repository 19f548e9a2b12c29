"""From a slider to the segments of time that are integrated one by one."""

from math import inf, pi

import numpy as np
import pytest
from tests.systems import ELLIPSE, PROGRAM, SPRING, STEADY, problem_of

import stiction as st
from stiction.drive import VaryingLoad, VaryingVelocity
from stiction.drive.recorded.spline import Recording, recording, spline
from stiction.drive.signal import Signal
from stiction.solver import segments
from stiction.solver.problem import System
from stiction.text.samples import FrozenColumn


def test_a_steady_slider_is_one_segment():
    (only,) = segments.segments(STEADY, 0.2, 1.7)
    assert (only.end, only.lost) == (1.7, False)
    s, (c, _) = only.problem.system, STEADY.direction
    assert s == System(0.25, 1e3, 4e4, 3.0, 20.0, c, STEADY.direction[1], 4.0, 1.0)
    assert only.problem.bend.value == 0.0
    assert (only.problem.drive, only.problem.load.force) == (STEADY.drive, 10.0)
    assert segments.system_of(STEADY.replace(driven="spring")).inertia == 0.0


def test_segments_end_where_drive_or_load_bend():
    drive = st.protocols.DriveProgram(
        velocity="2 mm/s",
        program=[st.protocols.Constant("1 mm/s", 0.3), st.protocols.Ramp(0.0, 0.5)],
    )
    load = st.protocols.LoadProgram(
        program=[
            st.protocols.Constant(10.0, 0.4),
            st.protocols.Ramp(5.0, 0.1),
            st.protocols.Ramp(-5.0, 0.2),
        ]
    )
    slider = STEADY.replace(drive=drive, load=load)
    found = list(segments.segments(slider, 0.1, 2.0))
    assert [each.end for each in found] == pytest.approx([0.3, 0.4, 0.5, 0.6])
    assert [each.lost for each in found] == [False, False, False, True]
    for each in found:  # compiled for two kinds, not for four
        kinds = each.problem.drive.steady(), each.problem.load.constant()
        assert kinds[0] == kinds[1]
    assert found[0].problem.drive.rate(0.2) == (1e-3, 0.0)
    assert found[1].problem.load.at(0.35) == 10.0
    assert found[1].problem.load.drift(0.35) == 0.0
    assert found[2].problem.bend.value > 0.0


def test_a_steady_drive_beside_a_load_that_varies_is_of_the_varying_type():
    load = VaryingLoad(Signal(0.0, 10.0, 1.0))
    drive, same = segments.alike(st.ConstantVelocity(2e-3), load)
    assert same == load
    assert drive.rate(0.7) == (2e-3, 0.0)
    assert drive.rate_change(0.7) == drive.rate_curve(0.7) == (0.0, 0.0)
    assert drive.travel(0.1, 0.5) == pytest.approx((1e-3, 0.0))
    both = st.ConstantVelocity(2e-3), st.drive.ConstantLoad(10.0)
    assert segments.alike(*both) == both


@pytest.mark.parametrize("first", [True, False])
def test_a_recording_makes_recordings_of_the_others(first):
    """Drive and load are of one type, with the same values."""
    times = np.linspace(0.0, 1.0, 9)
    rows = FrozenColumn(times), FrozenColumn(2e-3 + 1e-3 * times**2)
    recorded = recording(spline(*rows, False), 0.0)
    plain = Signal(0.0, 5.0, 1.0)
    drive = VaryingVelocity(recorded if first else plain, Signal(0.0, 0.0))
    load = VaryingLoad(plain if first else recorded)
    along, force = segments.alike(drive, load)
    assert isinstance(along.along, Recording)
    assert isinstance(force.force, Recording)
    for t in (0.1, 0.55):
        assert along.rate(t) == pytest.approx(drive.rate(t))
        assert force.at(t) == pytest.approx(load.at(t))


def test_an_anisotropic_law_is_a_law_and_a_tensor():
    """N = R diag(1, ratio^2) R^T, R by the angle from x: the surface's from X, and phi."""
    law, surface = segments.friction_of(ELLIPSE)
    assert law == ELLIPSE.friction.law
    angle = ELLIPSE.phi + ELLIPSE.friction.angle
    R = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    N = R @ np.diag([1.0, 1.4**2]) @ R.T
    assert surface == pytest.approx(N[np.triu_indices(2)], abs=1e-14)


def test_the_fastest_swing():
    assert segments.fastest_swing(problem_of("steady")) == 0.0
    assert segments.fastest_swing(problem_of("program")) == pytest.approx(2 * pi * 70.0)
    still = VaryingVelocity(Signal(0.0, 1.0, 0.0, 0.0, 50.0, 0.0, 2.0, -30.0), Signal(0.0, 0.0))
    problem = problem_of("program")._replace(drive=still, load=VaryingLoad(Signal(0.0, 1.0)))
    assert segments.fastest_swing(problem) == 30.0


@pytest.mark.parametrize("slider", [PROGRAM, SPRING], ids=["plate", "spring"])
def test_bounds_hold(slider):
    """Of the drive's velocity in the principal axes, of the load, and of the margin (M8)."""
    start, end = 0.3, 0.9
    segment = next(segments.segments(slider, start, end))
    problem, times = segment.problem, np.linspace(start, end, 2001)
    c, s = slider.direction
    v = np.array([problem.drive.rate(t) for t in times])
    found = np.array([v[:, 0] * c - v[:, 1] * s, v[:, 0] * s + v[:, 1] * c])
    bounds = np.array(segments.speeds(slider, problem.drive, start, end))
    assert (np.abs(found).max(axis=1) <= bounds).all()
    # the amplitudes add up, at two frequencies; no more than they do
    sums = 2e-3 * (1 + end) + 3e-3, 1e-3
    assert bounds == pytest.approx([sums[0] * c + sums[1] * s, sums[0] * s + sums[1] * c], rel=1e-9)
    load = [problem.load.at(t) for t in times]
    omega = 2 * pi * 30.0
    assert segments.load_bounds(problem.load, start, end) == pytest.approx(
        (10.5, 0.5 * omega, 0.5 * omega**2)
    )
    assert max(load) <= 10.5
    k, d = np.array([1e3, 4e4]) / 0.25, np.array([3.0, 20.0]) / 0.25
    rates = np.array([[sums[0], 2e-3 + 3e-3 * (2 * pi * 40)], [1e-3, 1e-3 * 2 * pi * 70]])
    more = np.array([[3e-3 * (2 * pi * 40) ** n, 1e-3 * (2 * pi * 70) ** n] for n in (2, 3)])
    rates = np.hstack([rates, more.T])
    x, y = rates[0] * c + rates[1] * s, rates[0] * s + rates[1] * c
    iota = 1.0 if slider.driven == "plate" else 0.0
    J = [
        np.hypot(
            *(k * [x[n], y[n]] + d * [x[n + 1], y[n + 1]] + iota * np.array([x[n + 2], y[n + 2]]))
        )
        for n in (0, 1)
    ]
    F, F_2 = 0.2 / 0.25 * 10.5, 0.2 / 0.25 * 0.5 * omega**2
    assert problem.bend.value == pytest.approx(2 * (J[0] ** 2 + F * J[1] + F * F_2), rel=1e-9)
    weak = slider.replace(friction=st.laws.Anisotropic(st.Coulomb(0.2), 0.5, "0 deg"))
    weaker = next(segments.segments(weak, start, end)).problem.bend.value
    assert weaker == pytest.approx(2 * (4 * J[0] ** 2 + 2 * F * J[1] + F * F_2), rel=1e-9)


def test_a_constant_velocity_is_its_own_bound_and_does_not_change():
    bounds = segments.drive_bounds(st.ConstantVelocity(-2e-3), 0.3, 0.9)
    assert bounds == ((2e-3, 0.0), (0.0, 0.0), (0.0, 0.0), (0.0, 0.0))


def test_when_a_load_vanishes():
    """The first zero, by steps that cannot pass it."""
    swinging = VaryingLoad(Signal(0.0, 1.0, -0.1, 0.5, 20.0, 0.3))
    times = np.linspace(0.0, 20.0, 200_001)
    first = times[np.argmax(np.array([swinging.at(t) for t in times]) <= 0.0)]
    assert segments.vanishes(swinging, 0.0, 20.0) == pytest.approx(first, abs=1e-4)
    assert segments.vanishes(swinging, 0.0, first - 0.1) == inf
    line = VaryingLoad(Signal(1.0, 2.0, -0.5))
    assert segments.vanishes(line, 1.0, 9.0) == pytest.approx(5.0)
    assert segments.vanishes(VaryingLoad(Signal(1.0, 2.0, 0.5)), 1.0, 9.0) == inf
    assert segments.vanishes(VaryingLoad(Signal(1.0, -2.0, 0.5)), 1.0, 9.0) == 1.0
    assert segments.vanishes(st.drive.ConstantLoad(1.0), 1.0, 9.0) == inf


def test_laws_with_state_have_no_end_of_stick_to_bound():
    slider = st.presets.nakano_popov_2020()
    slider = slider.replace(friction=st.laws.LuGre(0.15, 0.2, 1e-2, 1e5, 300.0, 0.4))
    assert segments.bend(slider, ((1.0, 0.0),) * 4, (1.0, 0.0, 0.0)) == 0.0
