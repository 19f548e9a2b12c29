"""The tolerances of each step, and the jump of the slip velocity with the drive."""

from math import hypot, inf, pi, sqrt

import numpy as np
import pytest
from tests.systems import ELLIPSE, PROGRAM, STEADY

import stiction as st
from stiction.drive import jump
from stiction.errors import DescriptionError
from stiction.solver import integrate, state
from stiction.solver.integrate import (
    accuracy,
    scales_of,
    slip_jump,
    steepest_weakening,
    tolerance,
)
from stiction.solver.segments import stretches
from stiction.solver.state import (
    COMPLETED,
    NOTHING,
    RUNNING,
    STEP_UNDERFLOW,
    STICK,
    TOO_MANY_STEPS,
    Motion,
    Output,
    State,
)
from stiction.system.description import Description, Settings

AT_REST = st.Initial(v_x=STEADY.direction[0] * 2e-3, v_y=STEADY.direction[1] * 2e-3)


def accuracy_of(slider, initial=AT_REST, start=0.0, rtol=1e-6):
    stretch = next(stretches(slider, start, start + 1.0))
    return accuracy(slider, scales_of(slider, initial), stretch, start, rtol)


def weakening(slider):
    """Return -dF/dv of exponential weakening at rest, where it is steepest."""
    law = slider.law
    return (law.mu_0 - law.mu_inf) / law.v_f * slider.normal_load


def test_what_a_step_is_held_to():
    """(M39) to (M42)."""
    found, s = accuracy_of(STEADY), STEADY
    along, across = 2e-3 * np.array(s.direction)
    tol = 0.8 * 1e-6**0.8
    free = [0.2 * 10.0 / sqrt(s.mass * k) for k in (s.k_x, s.k_y)]
    sigma = min(across, *free) / (1 + weakening(s) ** 2 / (s.k_y * s.mass))
    least = 1e-13 * (along + across + sum(free)) / tol
    newton = min(0.2, 100 * sqrt(tol)) * tol
    wanted = tol, newton, sigma, *free, inf, along, s.mass / s.k_x, s.mass / s.k_y
    assert found == pytest.approx((*wanted, tol * sigma, 0.0, least), rel=1e-9)


def test_of_a_law_with_states_no_weakening_is_known():
    """The speed of (M40) is then that of the transverse slip itself."""
    lugre = STEADY.replace(friction=st.laws.LuGre(0.15, 0.2, "10 mm/s", 1e5, 300.0, 2.0))
    assert accuracy_of(lugre).speed == pytest.approx(2e-3 * abs(STEADY.direction[1]), rel=1e-12)


@pytest.mark.parametrize("phi", ["0 deg", "90 deg"])
def test_along_a_principal_axis_the_speed_is_the_drive_s_along_it(phi):
    s = STEADY.replace(phi=phi)
    found = accuracy_of(s, st.Initial())
    k = s.k_y if phi == "90 deg" else s.k_x
    wanted = 2e-3 / (1 + weakening(s) ** 2 / (k * s.mass))
    assert found.speed == pytest.approx(wanted, rel=1e-6)
    assert found.drive == pytest.approx(2e-3)


def test_without_a_drive_or_friction():
    """A millionth of what friction can do; else next to nothing of the speeds at the start."""
    still = STEADY.replace(drive=st.ConstantVelocity(0.0))
    found = accuracy_of(still)
    sigma = 1e-6 * min(found.free_x, found.free_y)
    damped = sigma / (1 + weakening(still) ** 2 / (still.k_x * still.mass))
    assert found.speed == pytest.approx(damped, rel=1e-4)
    assert found.drive == inf
    bare = still.replace(friction=st.Coulomb(0.0))
    begun = st.Initial(u_x=1e-3, u_y=2e-5, v_x=3e-3, v_y=-1e-3)
    elastic = hypot(3e-3, 1e-3, 1e-3 * sqrt(1e3 / 0.25), 2e-5 * sqrt(4e4 / 0.25))
    assert accuracy_of(bare, begun).speed == pytest.approx(1e-15 * elastic)
    assert accuracy_of(bare, st.Initial()).speed == np.finfo(float).tiny
    fast = STEADY.replace(drive=st.ConstantVelocity(1e3), friction=st.Coulomb(0.2))
    assert accuracy_of(fast).speed == pytest.approx(
        min(accuracy_of(fast).free_x, accuracy_of(fast).free_y)
    )


def test_an_ellipse_and_a_program():
    """v_fx takes the root of N_xx, and a step is a quarter of the fastest oscillation at most."""
    plain, found = accuracy_of(STEADY), accuracy_of(ELLIPSE)
    n = next(stretches(ELLIPSE, 0.0, 1.0)).problem.surface
    assert found.free_x == pytest.approx(plain.free_x * sqrt(n.xx))
    assert found.free_y == pytest.approx(plain.free_y * sqrt(n.yy))
    assert accuracy_of(PROGRAM).longest == pytest.approx(0.5 * pi / (2 * pi * 70.0))
    assert accuracy_of(PROGRAM).free_x == pytest.approx(plain.free_x * 1.05)  # of the largest load


@pytest.mark.parametrize("rtol", [1e-2, 1e-4, 1e-6, 1e-12])
def test_the_tolerance_of_a_step(rtol):
    """(M39)."""
    assert tolerance(rtol) == pytest.approx(0.8 * rtol**0.8, rel=1e-14)


class Late(st.Coulomb):
    """A law that weakens nowhere but about one speed."""

    __slots__ = ()

    def slope(law, v):
        return -5.0 * np.exp(-((np.log(v / 3.3e-5) / 0.3) ** 2)) if v > 0.0 else 1.0


def test_the_steepest_weakening():
    """Up to ten times the speed, to a thousandth; none of a law that strengthens."""
    law = st.laws.Stribeck(0.2, 0.1, 0.01, 2.0)
    speeds = np.geomspace(1e-6, 1.0, 20_001)
    wanted = max(-law.slope(v) for v in speeds)
    assert steepest_weakening(law, 1.0) == pytest.approx(wanted, rel=2e-3)
    within = max(-law.slope(v) for v in speeds[speeds <= 1e-3])
    assert steepest_weakening(law, 1e-4) == pytest.approx(within, rel=1e-6)
    assert steepest_weakening(st.ExponentialWeakening(0.1, 0.2, 0.01), 1.0) == 0.0
    assert steepest_weakening(st.Coulomb(0.2), 1.0) == 0.0
    assert steepest_weakening(Late(0.2), 1.0) == pytest.approx(5.0, rel=2e-2)
    assert steepest_weakening(Late(0.2), 1e4) == pytest.approx(5.0, rel=2e-2)
    assert steepest_weakening(st.ExponentialWeakening(0.2, 0.1, 1e-30), 1.0) == pytest.approx(1e29)


def test_a_driven_plate_takes_the_slip_along_in_a_jump():
    drive = st.protocols.DriveProgram(
        velocity="2 mm/s",
        program=[st.protocols.Constant("1 mm/s", 0.3), st.protocols.Constant("5 mm/s")],
    )
    s = STEADY.replace(drive=drive)
    c, sine = s.direction
    assert slip_jump(s, 0.3) == pytest.approx((4e-3 * c, 4e-3 * sine))
    assert slip_jump(s, 0.2) == (0.0, 0.0)
    sideways = st.protocols.DriveProgram(
        velocity="2 mm/s", across=st.protocols.Modulation("3 mm/s", 40.0, "90 deg")
    )
    begun = slip_jump(STEADY.replace(drive=sideways), 0.0)
    X, Y = jump(STEADY.replace(drive=sideways).motion, 0.0)
    assert begun == pytest.approx((X * c - Y * sine, X * sine + Y * c))
    assert slip_jump(s.replace(driven="spring"), 0.3) == (0.0, 0.0)


class Scripted:
    """A solver that says what it is told to, after some steps each time."""

    columns = 7

    def __init__(self, *answers, filled=0):
        """Take code, time (s) and steps of each call."""
        self.answers, self.budgets, self.ends, self.filled = iter(answers), [], [], filled

    def begin(self, description):
        return at_time(description.initial.time)

    def enter_segment(self, state, x, y):
        return state

    def advance(self, problem, state, end, held, budget, out):
        code, t, steps = next(self.answers)
        self.budgets.append(budget)
        self.ends.append(end)
        out.used += steps
        out.samples[: self.filled] = 5.0
        out.filled = self.filled
        return code, at_time(t)

    def last_row(self, problem, state):
        return [state.motion.t] * 7


def at_time(t):
    return State(Motion(t, 0.0, 0.0, 0.0, 1.0, 0.0), None, NOTHING._replace(sticks=2))


def run(monkeypatch, method, slider=STEADY, steps=100):
    """Integrate from 0.3 s over 2 s; return the solution and the progress."""
    monkeypatch.setattr(integrate, "method_of", lambda _: method)
    settings = Settings(duration=2.0, sample_rate=0.0)
    description = Description(slider, st.Initial(time=0.3), settings)
    seen = []
    times = np.array([0.3, 1.0, 1.5])
    return integrate.integrate(description, times, steps, seen.append), seen


def test_a_run_goes_on_until_its_end(monkeypatch):
    """Its progress is the share of the duration; a pause is none of its ends."""
    method = Scripted((RUNNING, 0.8, 30), (COMPLETED, 2.3, 20), filled=3)
    found, seen = run(monkeypatch, method)
    assert seen == pytest.approx([0.25, 1.0])
    assert method.budgets == [100, 70]
    assert method.ends == [2.3, 2.3]
    assert found.code == COMPLETED
    assert found.times.tolist() == [0.3, 1.0, 1.5]
    assert found.samples.tolist() == [[5.0] * 7] * 3
    assert found.sticks.shape == (2, 2)


def test_a_run_that_stops_keeps_the_state_where_it_did(monkeypatch):
    """After the samples before that; with all steps used up, or by the solver's own code."""
    method = Scripted((RUNNING, 0.8, 60), (RUNNING, 1.2, 40), filled=2)
    found, _ = run(monkeypatch, method)
    assert (found.code, method.budgets) == (TOO_MANY_STEPS, [100, 40])
    assert found.times.tolist() == [0.3, 1.0, 1.2]
    assert found.samples.tolist() == [*[[5.0] * 7] * 2, [1.2] * 7]
    found, _ = run(monkeypatch, Scripted((STEP_UNDERFLOW, 1.0, 9), filled=2))
    assert (found.code, found.times.tolist()) == (STEP_UNDERFLOW, [0.3, 1.0])
    assert found.samples.tolist() == [[5.0] * 7, [1.0] * 7]


def test_each_stretch_of_a_program_follows_the_one_before(monkeypatch):
    """With tolerances and jumps of its own; none after one that fails."""
    program = [st.protocols.Constant("1 mm/s", 1.0), st.protocols.Constant("2 mm/s")]
    slider = STEADY.replace(drive=st.protocols.DriveProgram(velocity="1 mm/s", program=program))
    method = Scripted((COMPLETED, 1.0, 5), (RUNNING, 1.5, 5), (COMPLETED, 2.3, 5), filled=3)
    found, seen = run(monkeypatch, method, slider)
    assert (method.ends, found.code) == ([1.0, 2.3, 2.3], COMPLETED)
    assert seen == pytest.approx([0.35, 0.6, 1.0])
    method = Scripted((STEP_UNDERFLOW, 0.9, 5), filled=1)
    found, _ = run(monkeypatch, method, slider)
    assert (method.ends, found.code) == ([1.0], STEP_UNDERFLOW)
    assert found.times.tolist() == [0.3, 0.9]


def output_for(sticks):
    return Output(np.empty(0), np.empty((0, 7)), np.arange(2.0 * sticks).reshape(sticks, 2))


def test_room_is_doubled_when_it_is_filled(monkeypatch):
    """After a look at the memory that so much room takes, for all tables."""
    asked = []
    monkeypatch.setattr(state, "shortage", asked.append)
    out = output_for(4)
    before = out.sticks.copy()
    out.make_room(3)
    assert out.sticks.tolist() == before.tolist()
    assert asked == []
    out.make_room(4)
    assert out.sticks.shape == (8, 2)
    assert out.sticks[:4].tolist() == before.tolist()
    assert asked == [STICK * 8]
    assert (out.filled, out.used) == (0, 0)


def test_sticks_that_do_not_fit_are_refused(monkeypatch):
    monkeypatch.setattr(state, "shortage", lambda _: "takes 9 GB, of which 1 GB is free")
    with pytest.raises(DescriptionError, match=r"more than 4 sticks.*takes 9 GB.*shorten it"):
        output_for(4).make_room(4)
