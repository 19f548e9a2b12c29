"""The state of the loop from step to step."""

from math import sqrt

import pytest
from tests.entry import plain
from tests.systems import STEADY

from stiction.solver import state
from stiction.solver.stepping.limit import NEVER_ASKED

MEMORY = state.Memory(
    1e-3,
    (1e-3, 2e-3, 3e-3, 4e-3, 5e-3, 6e-3, 7e-3, 8e-3),
    3,
    2e-3,
    1.2,
    True,
    (1.0,) * 4,
    (2.0,) * 4,
    (3.0, 4.0),
)


@pytest.mark.parametrize("place", range(state.PLANNED))
def test_a_plan_changes_in_one_place(place):
    wanted = list(MEMORY.plan)
    wanted[place] = 0.5
    assert plain(state.write_plan)(MEMORY.plan, place, 0.5) == tuple(wanted)


def test_the_size_to_try_is_the_plan_s_within_bounds():
    """Section 12 of the method: within 0.4 to 1.5 times what the last step says."""
    size = plain(state.size_to_try)
    assert size(MEMORY._replace(h=4.1e-3)) == MEMORY.plan[3]
    assert size(MEMORY._replace(h=1e-3)) == pytest.approx(1.5e-3)
    assert size(MEMORY._replace(h=1.0)) == pytest.approx(0.4)
    for unplanned in (0, state.PLANNED, state.PLANNED + 1):
        assert size(MEMORY._replace(place=unplanned)) == MEMORY.h
    assert size(MEMORY._replace(place=1)) == pytest.approx(1.5e-3)
    assert size(MEMORY._replace(place=7, h=8e-3)) == 8e-3
    assert size(MEMORY._replace(plan=(0.0,) * 8)) == MEMORY.h


def test_a_take_off_begins_the_plan_and_a_kink_ends_it():
    begun = plain(state.at_takeoff)(MEMORY)
    assert begun == MEMORY._replace(h=MEMORY.plan[0], place=0, warm=False, limit=state.NO_LIMIT)
    never = MEMORY._replace(limit=NEVER_ASKED)
    assert plain(state.at_takeoff)(never).limit == NEVER_ASKED
    cold = state.drop_memory(MEMORY, 5e-4)
    assert cold == MEMORY._replace(h=5e-4, place=state.PLANNED, warm=False, limit=state.NO_LIMIT)


def test_counts_of_one_more_step():
    counts = state.Counts(5, 2, 20, 3, 0.7, 1)
    assert plain(state.count_step)(counts, 4, 9) == state.Counts(6, 6, 29, 3, 0.7, 1)


def test_a_run_starts_along_its_slip():
    begun = state.start(STEADY, 0.5, (1.0, 2.0), (3e-3, -4e-3))
    assert begun.motion == pytest.approx((0.5, 1.0, 2.0, 5e-3, 0.6, -0.8))
    assert begun.memory.h == begun.memory.plan[0] == begun.memory.h_last
    assert begun.memory.h == pytest.approx(0.05 / sqrt(STEADY.k_y / STEADY.mass))
    assert begun.memory.plan[1:] == (0.0,) * 7
    assert (begun.memory.place, begun.memory.warm) == (0, False)
    assert begun.counts == state.NOTHING == (0, 0, 0, 0, 0.0, 0)
    at_rest = state.start(STEADY, 0.5, (1.0, 2.0), (0.0, 0.0)).motion
    assert at_rest == (0.5, 1.0, 2.0, 0.0, 1.0, 0.0)
    assert state.state_from_plain(plain(state.plain)(begun)) == begun
    stiff = STEADY.replace(k_x=9e4)
    assert state.first_step(stiff) == pytest.approx(0.05 / sqrt(9e4 / STEADY.mass))
