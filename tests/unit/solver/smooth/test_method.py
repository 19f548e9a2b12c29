"""The smooth solver's interface to a run: its state, its jumps, its tolerances."""

from math import inf

import numpy as np
import pytest
from tests.systems import ELLIPSE, STEADY, problem_of
from tests.unit.solver.smooth.systems import EXACT

import stiction as st
from stiction.solver.exact.sampling import COLUMNS
from stiction.solver.problem import kinds_of
from stiction.solver.regularised import Smoothed
from stiction.solver.segments import segments
from stiction.solver.smooth.method import SPEED_SHARE, Smooth
from stiction.solver.state import NOTHING
from stiction.system.description import Description, Settings

AGEING = STEADY.replace(friction=st.laws.RateStateAgeing(0.01, 0.015, "10 um", 0.2, "1 mm/s"))
START = st.Initial(u_x=1e-3, u_y=2e-6, v_x=1e-3, v_y=-5e-4, time=0.3)


def begun(slider, delta=None):
    """Return the solver of a slider, and the state from which a run starts."""
    method = Smooth(slider, delta)
    return method, method.begin(Description(slider, START, Settings(duration=1.0)))


def test_the_state_from_which_a_run_starts():
    method, state = begun(AGEING)
    assert method.columns == COLUMNS + 1
    assert state.motion == (0.3, 1e-3, 2e-6, *START.slip(AGEING))
    assert state.internal.tolist() == list(START.internal(AGEING))
    assert state.memory[:4] == (method.first_step, method.first_step, 1.0, False)
    assert state.memory.past.tolist() == np.zeros((4, 3)).tolist()
    assert state.counts == NOTHING
    assert method.first_step == pytest.approx(0.05 * np.sqrt(0.25 / 4e4))


def test_a_law_is_made_smooth_where_a_width_is_given():
    method, state = begun(ELLIPSE, 1e-3)
    assert isinstance(method.law, Smoothed)
    assert (method.states, method.columns, method.law.delta) == (0, COLUMNS, 1e-3)
    assert method.law.law == ELLIPSE.friction.law
    assert method.law.surface == problem_of("ellipse").surface
    assert state.internal.shape == (0,)


def test_the_loop_is_compiled_once_for_all_rigs_and_surfaces():
    """Without one mass or dampers along the springs it has the same types as with both."""
    general = AGEING.replace(mass_y="0.6 kg", mass_angle="35 deg")
    kinds = []
    for slider, delta in ((AGEING, None), (general, None), (STEADY, 1e-3), (ELLIPSE, 1e-3)):
        problem = next(segments(slider, 0.0, 1.0)).problem
        kinds.append(kinds_of(Smooth(slider, delta).point_law(problem)))
    assert len({*kinds}) == 1


def test_a_jump_of_the_drive():
    """The slip velocity jumps, and steps begin anew, no longer than the first."""
    method, state = begun(AGEING)
    warm = state._replace(memory=state.memory._replace(warm=True, h=7.0))
    entered = method.enter_segment(warm, 3e-3, -4e-3)
    s_x, s_y = state.motion[3:]
    assert entered.motion == (*state.motion[:3], s_x + 3e-3, s_y - 4e-3)
    assert (entered.memory.h, entered.memory.warm) == (method.first_step, False)
    short = warm._replace(memory=warm.memory._replace(h=0.1 * method.first_step))
    assert method.enter_segment(short, 0.0, 0.0).memory.h == 0.1 * method.first_step
    assert entered.internal is state.internal


@pytest.mark.parametrize("delta", [None, 1e-3])
def test_the_sample_of_a_state(delta):
    """Friction there is the law's, of the normal load then, and the internal states follow."""
    slider = AGEING if delta is None else ELLIPSE
    method, state = begun(slider, delta)
    z = tuple(state.internal)
    row = method.last_row(problem_of("program"), state)
    load = problem_of("program").load.at(0.3)
    slip = START.slip(slider)
    force = method.law.force(slip, load, z)
    assert row == pytest.approx([1e-3, 2e-6, *slip, *force, 0.0, *z])


def test_what_each_step_is_held_to():
    """States remember slower slip; so does what vibrates."""
    held = EXACT._replace(speed=1e-4, free_x=3.0, free_y=2.0)
    assert begun(ELLIPSE, 1e-3)[0].step_accuracy(held) == held
    finer = begun(AGEING)[0]
    assert finer.step_accuracy(held) == held._replace(speed=SPEED_SHARE * 1e-4)
    shaken = held._replace(longest=1e-2)
    assert finer.step_accuracy(shaken) == shaken._replace(speed=2e-6)
    assert finer.step_accuracy(shaken._replace(speed=1e-9)).speed == SPEED_SHARE * 1e-9
    assert held.longest == inf


def test_a_mass_that_a_smoothed_law_holds_takes_long_steps():
    """After the rapid slip of Fig. 3; guesses out of reach made 168 000 steps of this millisecond.

    Friction's rate is F/(m delta) = 8e9 per second, but the motion takes 2 ms for a change.
    """
    start = st.Initial(
        u_x=1.1737194423e-3,
        u_y=9.120939145e-8,
        v_x=9.998468508882e-4,
        v_y=1.745174698190713e-05,
        time=2.095705986,
    )
    slider = st.presets.nakano_popov_2020()
    run = st.simulate(
        slider, 1e-3, initial=start, sample_rate=0, rtol=1e-3, regularisation=1e-9, max_steps=1000
    )
    assert run.status.ok
