"""The range of angles of a patch of the map, and whether it pays."""

import numpy as np
import pytest
from tests.entry import map_of, plain
from tests.systems import problem_of
from tests.unit.solver.exact.test_step import held_to
from tests.unit.solver.multiscale.test_construction import problem_of as soft
from tests.unit.solver.multiscale.test_construction import taking_off

from stiction.solver.accuracy import Accuracy
from stiction.solver.exact import loop as exact_loop
from stiction.solver.exact.record import record_of
from stiction.solver.multiscale import construction, loop, replay
from stiction.solver.multiscale.return_map import (
    CLOSING,
    NODES,
    PATCHES,
    WIDEST,
    Cycle,
    Stick,
)
from stiction.solver.multiscale.section import elongation_held
from stiction.solver.state import (
    COMPLETED,
    RUNNING,
    Counts,
    Memory,
    Motion,
    State,
    state_from_plain,
)
from stiction.solver.stepping.limit import NO_LIMIT

CYCLE, STICK = Cycle(0.01, 1.0, 0.4), Stick(0.5, 1.0, 0.3)


def test_nothing_is_known_at_first():
    known = map_of(1e-6)
    assert known.closing == CLOSING * 1e-6
    assert known.patches.shape == (PATCHES, 3)
    assert known.coefficients.shape == (PATCHES, NODES, 3)
    assert (known.width.tolist(), known.sizes.tolist()) == ([WIDEST], [0] * 5)
    assert np.isnan(known.last).all()
    assert np.isnan(known.patches).all()
    assert known.stick.shape == (1, 2)
    assert len(known.never) == len(known.nowhere) == 0


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_how_far_a_patch_is_tried(way):
    """Half way to an edge, a quarter after a try in vain, and up to another patch."""
    known, theta, turn = map_of(1e-6), 0.3, way * 0.01
    reach = plain(loop.reach)
    known.edges[:2] = theta + way * 0.5, theta - way * 0.1  # one of them behind
    assert reach(known, theta, turn) == way * WIDEST
    known.sizes[1] = 2
    assert reach(known, theta, turn) == pytest.approx(way * 0.25)
    known.width[0] = 0.2
    assert reach(known, theta, turn) == pytest.approx(way * 0.2)
    known.width[0] = 1.0
    known.patches[0, 0] = theta - turn  # the one to fill next
    assert reach(known, theta, turn) == pytest.approx(way * 0.125)
    known.patches[:3, 0] = theta + way * 0.2, theta + way * 0.05, theta - way * 0.1
    known.sizes[0] = 3
    assert reach(known, theta, turn) == pytest.approx(way * 0.2)  # 0.05 is near: beyond that
    known.patches[:2, 0] = theta + way * 0.076, theta
    assert reach(known, theta, turn) == pytest.approx(way * 0.076)
    known.patches[0, 0] = theta + way * 0.074
    assert reach(known, theta, turn) == pytest.approx(way * 0.25)
    known.edges[0] = theta  # at an edge itself there is nowhere to go
    assert reach(known, theta, turn) == 0.0


def test_a_patch_pays_if_it_is_good_for_eight_cycles():
    """Over its angles and in the time left; if not too many were in vain, nor cost too much."""
    known, pays = map_of(1e-6), plain(loop.pays)
    assert pays(known, STICK, CYCLE, 0.0801, 100.0)
    assert pays(known, STICK, CYCLE, -0.0801, 100.0)
    assert pays(known, STICK, CYCLE._replace(turn=-0.01), -0.0801, 100.0)
    assert not pays(known, STICK, CYCLE, 0.0799, 100.0)
    assert pays(known, STICK, CYCLE, 1.0, 9.01)
    assert not pays(known, STICK, CYCLE, 1.0, 8.99)
    for place in (0, 1):
        known.sizes[:] = 0
        known.sizes[place] = PATCHES
        assert not pays(known, STICK, CYCLE, 1.0, 100.0)
        known.sizes[place] = PATCHES - 1
        assert pays(known, STICK, CYCLE, 1.0, 100.0)
    known.sizes[:] = [0, 0, 0, loop.VAIN, 0]
    assert pays(known, STICK, CYCLE, 1.0, 100.0)
    known.sizes[3] += 1
    assert not pays(known, STICK, CYCLE, 1.0, 100.0)
    known.sizes[4] = loop.VAIN_EACH
    assert pays(known, STICK, CYCLE, 1.0, 100.0)
    known.sizes[3] += 1
    assert not pays(known, STICK, CYCLE, 1.0, 100.0)
    known.sizes[3] = 0
    assert pays(known, STICK, CYCLE, 1.0, 100.0)
    for overdrawn in (0.0, -1.0):
        known.balance[0] = overdrawn
        assert not pays(known, STICK, CYCLE, 1.0, 100.0)


def test_counts_of_what_the_map_has_found():
    counts = Counts(5, 2, 20, 3, 0.7, 1)
    found = plain(loop.with_sticks)(counts, 7, 0.2)
    assert found == pytest.approx((5, 2, 20, 7, 0.9, 5))
    other = Counts(50, 20, 200, 30, 7.0, 10)
    assert plain(construction.add_counts)(counts, other) == (55, 22, 220, 3, 0.7, 1)


def test_a_node_s_steps_are_finer():
    accuracy = Accuracy(*range(1, 13))
    found = plain(construction.finer)(accuracy)
    part = construction.NODE_SHARE
    wanted = accuracy._replace(tolerance=part * 1, newton=part * 2, least=12 / part)
    assert found == pytest.approx(wanted)


@pytest.mark.parametrize("name", ["steady", "ellipse"])
def test_from_a_landing_to_the_angle_of_its_stick_and_back(name):
    problem, theta = problem_of(name), 0.2
    u = plain(elongation_held)(problem, theta)
    v = problem.system.cos_phi * 2e-3, problem.system.sin_phi * 2e-3
    landing = Motion(0.7, u[0] - 0.01 * v[0], u[1] - 0.01 * v[1], 0.0, 0.6, 0.8)
    stick = plain(replay.stick_of)(problem, landing)
    assert stick == pytest.approx((0.7, 0.71, theta), rel=1e-9)
    memory = Memory(1.0, (0.3,) * 8, 5, 2.0, 1.1, True, (1.0,) * 4, (2.0,) * 4, NO_LIMIT)
    counts = Counts(1, 2, 3, 4, 5.0, 6)
    state = State(landing._replace(t=0.1, u_x=0.0, u_y=0.0), memory, counts)
    found = plain(replay.state_at_landing)(problem, state, stick)
    assert found.motion == pytest.approx(landing, rel=1e-9)
    assert found.memory == memory._replace(h=0.3, place=0, warm=False)
    assert found.counts == counts
    beyond = landing._replace(u_x=1.1 * u[0], u_y=1.1 * u[1])  # friction cannot hold
    assert np.isnan(plain(replay.stick_of)(problem, beyond).theta)
    standing = problem._replace(drive=problem.drive._replace(velocity=0.0))
    stick = plain(replay.stick_of)(standing, landing)
    assert np.isnan(stick.theta)
    assert stick.end == np.inf


@pytest.mark.parametrize(
    ("name", "until", "kept"),
    [("soft", 0.6, 0), ("damped", 0.6, 0), ("soft", 0.4, 0), ("damped", 0.4, 0), ("soft", 0.4, 1)],
)
def test_strides_lead_to_the_same_sticks_as_steps(name, until, kept):
    """With samples along the way, at a fraction of the steps; or by the motion that is kept."""
    problem, begun = soft(name), taking_off(soft(name), 1.0)
    times, known = np.array([0.05, 0.25, 0.251, 0.255, 0.262, 0.37]), map_of(1e-6, kept)
    (code, state, k, _), sticks, samples = run(loop.stride, problem, begun, until, times, known)
    (_, wanted, _, _), exact, rows = run(
        exact_loop.advance, problem, begun, until, times, record_of(0)
    )
    counts = Counts(*state[2])
    assert (code, k) == (COMPLETED, 6)
    assert counts.sticks == wanted[2][3] > 10
    assert known.sizes[0] >= 1
    assert counts.mapped > 0.3 * counts.sticks
    n = counts.sticks
    assert sticks[:n] == pytest.approx(exact[:n], abs=1e-6)
    assert counts.stuck == pytest.approx(np.diff(sticks[:n]).sum(), rel=1e-9)
    assert state[0][0] == until
    assert state[0][1:3] == pytest.approx(wanted[0][1:3], rel=1e-5)
    assert samples[:, :2] == pytest.approx(rows[:, :2], rel=1e-5, abs=1e-9)
    assert samples[:, 2:6] == pytest.approx(rows[:, 2:6], rel=2e-3, abs=2e-5)
    assert samples[:, 6].tolist() == rows[:, 6].tolist()
    assert known.sizes[4] == counts.sticks - counts.mapped
    # what is remembered are cycles from one stick's end to the next, the first from the start
    _, turn, time, held = known.past[0]
    ends = np.array([0.0, *sticks[:n, 1]])
    row = int(np.argmin(np.abs(np.diff(ends) - time)))
    wanted = np.diff(ends)[row], np.diff(sticks[row])[0]
    assert (time, held) == pytest.approx(wanted, rel=1e-6)
    assert turn < 0.0


def run(function, problem, state, until, times, *more):
    """Advance; return the outcome, the stick intervals and the samples."""
    sticks, samples = np.zeros((200, 2)), np.full((len(times), 7), np.nan)
    held = held_to(1e-7)._replace(touch=0.0)
    arguments = problem, state, until, held, 10**6, times, samples, 0, sticks, *more
    return plain(function)(*arguments), sticks, samples


def test_a_stride_stops_with_its_budget_or_room_and_goes_on():
    problem, state, known = soft("soft"), taking_off(soft("soft"), 1.0), map_of(1e-6)
    (code, whole, _, steps), table, _ = run(loop.stride, problem, state, 0.5, np.empty(0), known)
    assert code == COMPLETED
    held, never = held_to(1e-7)._replace(touch=0.0), (np.empty(0), np.empty((0, 7)), 0)
    sticks, known, paused, used = np.zeros((200, 2)), map_of(1e-6), state, 0
    for _ in range(1000):
        code, plainly, _, turns = plain(loop.stride)(
            problem, paused, 0.5, held, 60, *never, sticks, known
        )
        paused, used = state_from_plain(plainly), used + turns
        if code != RUNNING:
            break
    assert (code, plainly, used) == (COMPLETED, whole, steps)
    assert sticks.tolist() == table.tolist()
    room = np.zeros((5, 2))
    code, plainly, _, _ = plain(loop.stride)(
        problem, state, 0.5, held, 10**6, *never, room, map_of(1e-6)
    )
    assert (code, plainly[2][3]) == (RUNNING, 5)
    assert room.tolist() == table[:5].tolist()


def test_a_cycle_s_steps_are_kept_in_however_many_strides_they_are_taken():
    """All since the take-off, and no earlier ones."""
    problem, state, known = soft("soft"), taking_off(soft("soft"), 1.0), map_of(1e-6, 1)
    never, sticks = (np.empty(0), np.empty((0, 7)), 0), np.zeros((9, 2))
    known.record.used[0] = 7
    for stride in range(3):
        _, plainly, _, _ = plain(loop.stride)(
            problem, state, 0.5, held_to(1e-7), 2, *never, sticks, known
        )
        state = state_from_plain(plainly)
        assert (state.motion.r > 0.0, state.counts.sticks) == (True, 0)
        assert known.record.used[0] == state.counts.steps > 2 * stride


def test_the_balance_of_a_map():
    """Each cycle that it finds saves what one costs without it, as whole numbers and quarters."""
    problem, begun = soft("soft"), taking_off(soft("soft"), 1.0)
    left, mapped = [], []
    for saved in (7.0, 9.0):
        known = map_of(1e-6)
        known.balance[:] = 10_000.0, saved
        (_, state, _, _), _, _ = run(loop.stride, problem, begun, 0.4, np.empty(0), known)
        left.append(known.balance[0])
        mapped.append(state[2][5])
    assert mapped[0] == mapped[1] > 5
    assert left[1] - left[0] == 2.0 * mapped[0]
    assert left[0] - 7.0 * mapped[0] < 10_000.0


def test_a_cycle_is_known_from_a_patch_or_from_the_past():
    known, cycle = map_of(1e-6), Cycle(0.01, 2.0, 0.5)
    found, _, _ = plain(loop.known_cycle)(known, 0.3, cycle)
    assert not found
    known.coefficients[0] = 0.0
    known.coefficients[0, 0] = cycle.turn, cycle.time, cycle.held**2
    known.patches[0] = 0.2, 2.0 / 0.4, 1
    known.sizes[0] = 1
    assert plain(loop.known_cycle)(known, 0.3, cycle) == (True, cycle, -1)
    assert not plain(loop.known_cycle)(known, 0.7, cycle)[0]
