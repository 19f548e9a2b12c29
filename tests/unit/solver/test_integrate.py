"""The jump of the slip velocity with the drive, and a run from segment to segment."""

import numpy as np
import pytest
from tests.systems import STEADY

import stiction as st
from stiction.drive import jump
from stiction.solver import integrate, state
from stiction.solver.integrate import slip_jump
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


def test_each_segment_of_a_program_follows_the_one_before(monkeypatch):
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
    assert out.make_room(3)
    assert out.sticks.tolist() == before.tolist()
    assert asked == []
    assert out.make_room(4)
    assert out.sticks.shape == (8, 2)
    assert out.sticks[:4].tolist() == before.tolist()
    assert asked == [STICK * 8]
    assert (out.filled, out.used) == (0, 0)


def test_sticks_that_do_not_fit_are_refused(monkeypatch):
    monkeypatch.setattr(state, "shortage", lambda _: "takes 9 GB, of which 1 GB is free")
    assert output_for(4).make_room(3)
    assert not output_for(4).make_room(4)
