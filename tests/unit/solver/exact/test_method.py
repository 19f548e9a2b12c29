"""What stands between a run and the exact solver: its state, jumps of the drive, samples."""

from math import cosh, tanh
from typing import NamedTuple

import numpy as np
import pytest
from tests.entry import plain
from tests.systems import ELLIPSE, SLIDERS, STEADY, Printed, motion_of, problem_of
from tests.unit.solver.exact.test_predictor import COLD

import stiction as st
from stiction.solver.exact import method
from stiction.solver.exact.loop import advance
from stiction.solver.exact.sampling import COLUMNS
from stiction.solver.integrate import integrate
from stiction.solver.problem import kinds_of
from stiction.solver.segments import segments
from stiction.solver.state import NOTHING, PLANNED, Motion, State, first_step
from stiction.system.description import Description, Settings

START = st.Initial(u_x=1e-3, u_y=2e-6, v_x=1e-3, v_y=-5e-4, time=0.3)
MOVING = Motion(0.35, 1e-3, 2e-6, 5e-3, 0.6, 0.8)


@pytest.fixture(scope="module")
def exact():
    return method.Exact(STEADY)


def test_the_state_from_which_a_run_starts(exact):
    state = exact.begin(Description(STEADY, START, Settings(duration=1.0)))
    s = START.slip(STEADY)
    assert exact.columns == COLUMNS
    assert state.motion[:3] == (0.3, 1e-3, 2e-6)
    assert state.motion[3:] == pytest.approx((np.hypot(*s), *(s / np.hypot(*s))))
    assert state.memory.h == state.memory.plan[0] == first_step(STEADY)
    assert state.counts == NOTHING


def test_a_jump_of_the_drive(exact):
    """The slip velocity jumps, and no step before predicts the next."""
    memory = COLD._replace(h=3.0, plan=(2.0, *[0.5] * 7), warm=True)
    state = State(MOVING, memory, NOTHING)
    cooled = memory._replace(h=2.0, warm=False, place=PLANNED)
    assert exact.enter_segment(state, 0.0, 0.0) == State(MOVING, cooled, NOTHING)
    short = State(MOVING, memory._replace(h=1.0), NOTHING)
    assert exact.enter_segment(short, 0.0, 0.0).memory.h == 1.0
    for jump in ((1e-3, 0.0), (0.0, -2e-3), (3e-3, 4e-3)):
        found = exact.enter_segment(state, *jump)
        wanted = np.array([3e-3, 4e-3]) + jump
        assert found.memory == cooled
        assert found.motion[:3] == MOVING[:3]
        assert found.motion.r == pytest.approx(np.hypot(*wanted))
        assert found.motion.r * np.array(found.motion[4:]) == pytest.approx(wanted)
    stopped = exact.enter_segment(state, -3e-3, -4e-3).motion
    assert stopped == MOVING._replace(r=0.0)


@pytest.mark.parametrize("name", SLIDERS)
@pytest.mark.parametrize("r", [0.0, 5e-3])
def test_the_friction_force_between_two_steps(name, r):
    """(M2) while it sticks; (M1) in slip, along N s for an elliptic surface."""
    problem, motion = problem_of(name), MOVING._replace(r=r)
    printed = Printed(problem, motion_of(1e-3, 2e-6, 3e-3, 4e-3, 0.35))
    found = plain(method.force_between)(problem, motion)
    if r == 0.0:
        wanted = printed.m * printed.holding(0.35, printed.u)
    else:
        n, e = problem.surface, np.array([0.6, 0.8])
        N = np.array([[n.xx, n.xy], [n.xy, n.yy]])
        wanted = printed.m * printed.friction(0.35, r)[0] * N @ e / np.sqrt(e @ N @ e)
    assert found == pytest.approx(wanted, rel=1e-12)


@pytest.mark.parametrize("r", [0.0, 5e-3])
def test_the_sample_of_a_state(exact, r):
    problem, motion = problem_of("steady"), MOVING._replace(r=r)
    row = exact.last_row(problem, State(motion, COLD, NOTHING))
    force = plain(method.force_between)(problem, motion)
    wanted = [1e-3, 2e-6, 0.6 * r, 0.8 * r, *force, 1.0 if r == 0.0 else 0.0]
    assert row == pytest.approx(wanted, rel=1e-12)


def test_the_loop_is_compiled_for_two_kinds_of_planes():
    """All alike; or with a grain, or masses or dampers of their own, or both."""
    turned = {"mass_y": 0.3, "mass_angle": "20 deg"}
    kinds = []
    for slider in (STEADY, ELLIPSE, STEADY.replace(**turned), ELLIPSE.replace(**turned)):
        problem = next(segments(slider, 0.0, 1.0)).problem
        kinds.append(kinds_of(method.Exact(slider).point_law(problem)))
    assert kinds[0] != kinds[1] == kinds[2] == kinds[3]


def test_times_that_may_not_be_written_to_are_taken_without_compiling_anew():
    description = Description(STEADY, START, Settings(duration=1e-3))
    times = START.time + np.linspace(0.0, 1e-3, 5)
    wanted = integrate(description, times, 10**6, None).samples
    known = len(advance.overloads)
    times.flags.writeable = False
    found = integrate(description, times, 10**6, None).samples
    assert found.tolist() == wanted.tolist()
    assert len(advance.overloads) == known


class Overflows(NamedTuple):
    """A law of which the slope is zero to compiled code, and an error to Python."""

    mu: float = 0.5
    falls: float = 0.1
    v_c: float = 1e-6

    def coefficient(law, v):
        return law.mu - law.falls * tanh(v / law.v_c)

    def slope(law, v):
        return -law.falls / law.v_c / cosh(v / law.v_c) ** 2


@pytest.mark.parametrize("velocity", [1e-3, 1e-2])
def test_a_slope_that_python_cannot_tell_does_not_end_a_run(velocity):
    """The run comes to steady sliding, where its modes are asked for; they are then unknown."""
    law = Overflows()
    with pytest.raises(OverflowError):
        law.slope(velocity)
    slider = st.Slider(
        mass=1.0, k_x=1e4, k_y=1e6, phi="0.2 deg", normal_load=10.0, friction=law,
        drive=st.ConstantVelocity(velocity), c_x=100.0, c_y=100.0,
    )  # fmt: skip
    run = st.simulate(slider, 20.0, sample_rate=0)
    assert run.status.ok
    assert run.data["slip_x"].values[-1] == pytest.approx(velocity, rel=1e-4)
