"""The loop of smooth steps: where a step starts and ends, and whole segments against SciPy."""

from math import hypot, inf

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from tests.entry import plain
from tests.unit.solver.smooth.systems import (
    EXACT,
    LAWS,
    MOTION,
    STATEFUL,
    TIME,
    A,
    Equations,
    Fed,
    begun,
    behind,
    derivative,
    smooth_problem,
)

import stiction as st
from stiction.solver.exact.sampling import COLUMNS
from stiction.solver.segments import segments
from stiction.solver.smooth import loop, right_hand_side
from stiction.solver.smooth.coordinate import coordinate
from stiction.solver.smooth.loop import COARSEST
from stiction.solver.smooth.method import Smooth
from stiction.solver.smooth.state import (
    SmoothMemory,
    SmoothMotion,
    SmoothState,
    copy_of,
    with_numbers,
)
from stiction.solver.smooth.workspace import START, workspace
from stiction.solver.state import COMPLETED, NON_FINITE, NOTHING, RUNNING, STEP_UNDERFLOW, Output
from stiction.solver.stepping.control import GROWTH, step_factor
from stiction.solver.stepping.limit import NO_LIMIT

HELD = EXACT._replace(tolerance=1e-7, newton=1e-9)
NO_TIMES = np.zeros(0)


def state_of(name, motion=MOTION, h=1e-5):
    z = np.array(LAWS[name][1])
    memory = SmoothMemory(h, h, 1.0, False, np.zeros((4, 2 + len(z))), NO_LIMIT)
    return SmoothState(SmoothMotion(TIME, *motion), z, memory, NOTHING)


def advance(
    name, end, accuracy=HELD, state=None, budget=1000, drive="program", times=NO_TIMES, law=None
):
    """Advance, and return the code, the state, the samples and the steps of this call."""
    samples = np.full((len(times), COLUMNS + len(LAWS[name][1])), np.nan)
    problem, own = smooth_problem(name, drive), copy_of(state or state_of(name))
    if law is not None:
        problem = problem._replace(law=behind(law))
    advance = plain(loop.advance)
    rooms = workspace_of(name), workspace_of(name)
    code, now, k, turns = advance(problem, own, end, accuracy, budget, times, samples, 0, *rooms)
    return code, with_numbers(own, now), samples[:k], turns


@pytest.mark.parametrize("name", LAWS)
def test_where_a_step_starts(name):
    """The grain of the law or the speed to resolve, and the slip coordinate there (M64)."""
    problem, start, w, q = begun(name)
    law, z = LAWS[name]
    grain = law.grain(z) if hasattr(law, "grain") else inf
    logarithmic = name in ("ageing", "slip")
    assert start[:3] == (TIME, *MOTION[:2])
    assert start.eps == (grain if logarithmic else inf)
    linear = 0.0 if z else min(grain, EXACT.speed)  # rates of states have a kink at rest
    assert start.unit == (min(1.0, EXACT.speed / grain) if logarithmic else linear)
    assert q == plain(coordinate)(start.eps, *MOTION[2:])
    assert w.values[START].tolist() == [*MOTION[2:], *z]
    assert w.size[:2].tolist() == [min(grain, EXACT.speed)] * 2
    pull = plain(right_hand_side.pull)(problem, start, 0.0)
    at = plain(right_hand_side.evaluate)(problem, start.eps, pull.load, *q, w, START, True)
    moving, _ = plain(right_hand_side.moving)(problem, TIME, pull, at, EXACT)
    share = moving / (EXACT.speed + hypot(*MOTION[2:]))
    assert share > 1.0
    assert start.share == 1.0
    still = workspace_of(name)
    slow = EXACT._replace(speed=5.0 * moving)
    motion = SmoothMotion(TIME, *MOTION)
    start, *_ = plain(loop.begin)(problem, motion, np.array(z), still, slow)
    assert start.share == pytest.approx(moving / (slow.speed + hypot(*MOTION[2:])))
    if logarithmic:  # far above the grain the slip velocity is its own coordinate
        for part, wanted in ((0.99, grain), (1.01, inf)):
            rough = EXACT._replace(speed=grain / COARSEST / part)
            start, *_ = plain(loop.begin)(
                problem, SmoothMotion(TIME, *MOTION), np.array(z), still, rough
            )
            assert start.eps == (grain if part < 1.0 else inf) == wanted


def workspace_of(name):
    return workspace(len(LAWS[name][1]))


@pytest.mark.parametrize("name", STATEFUL)
def test_what_states_are_held_against_is_made_anew(name):
    """From the states and derivatives at the start, not from the last step's sizes."""
    _, _, w, _ = begun(name)
    sizes, (law, z) = w.size.copy(), LAWS[name]
    load = Equations(name).load(0.0)
    by_state = derivative(lambda x: np.array(law.force(MOTION[2:], load, tuple(x))), z, 1e-9)
    least = 0.01 * load / np.hypot(*by_state)
    wanted = np.abs(z) + (np.minimum(1.0, least) if name in ("ageing", "slip") else least)
    assert sizes[2:] == pytest.approx(wanted, rel=1e-3)
    again = workspace_of(name)
    again.size[:] = 77.0
    motion = SmoothMotion(TIME, *MOTION)
    plain(loop.begin)(smooth_problem(name), motion, np.array(z), again, EXACT)
    assert again.size == pytest.approx(sizes, rel=1e-6)


@pytest.mark.parametrize("name", LAWS)
@pytest.mark.parametrize("drive", ["program", "spring"])
def test_a_segment_against_scipy(name, drive):
    """Radau of SciPy at 1e-10, on the printed equations; with samples along the way."""
    printed, n = Equations(name, drive), len(LAWS[name][1])

    def rates(t, y):
        s, z, slid = y[:2], y[2 : 2 + n], y[2 + n :]
        return np.concatenate([*printed.rates(t, slid, s, z), s])

    span, after = 3e-3, np.array([0.0, 1e-3, 2.1e-3, 3e-3])
    times = TIME + after
    begin = np.array([*printed.s, *printed.z, 0.0, 0.0])
    scale = np.array([*np.abs(printed.s), *np.abs(printed.z), 1e-6, 1e-6])
    sharp = solve_ivp(rates, (0.0, span), begin, "Radau", after, rtol=1e-9, atol=1e-10 * scale).y.T
    code, state, samples, turns = advance(name, TIME + span, drive=drive, times=times)
    assert (code, state.motion.t, len(samples)) == (COMPLETED, TIME + span, 4)
    assert state.counts.steps == turns > 3
    assert state.counts.iterations >= turns
    for time, row, wanted in zip(times, samples, sharp, strict=True):
        s, z, slid = wanted[:2], wanted[2 : 2 + n], wanted[2 + n :]
        u = printed.u + printed.printed.drive("travel", TIME, time - TIME) - slid
        assert row[:2] == pytest.approx(u, abs=1e-6 * np.abs(slid).max() + 1e-12)
        assert row[2:4] == pytest.approx(s, abs=3e-5 * hypot(*MOTION[2:]))
        assert row[COLUMNS:] == pytest.approx(z, rel=3e-5)
    assert [*state.motion[1:], *state.internal] == pytest.approx(
        [*samples[-1, :4], *samples[-1, COLUMNS:]], rel=1e-9
    )


@pytest.mark.parametrize("name", ["smoothed", "lugre", "ageing"])
def test_a_segment_in_parts_is_the_whole(name):
    """A budget of steps pauses it: to the last bit the same."""
    end = TIME + 2e-3
    code, whole, _, turns = advance(name, end)
    assert (code, whole.counts.steps) == (COMPLETED, turns)
    code, state, _, part = advance(name, end, budget=3)
    assert (code, part) == (RUNNING, 3)
    assert state.memory.warm
    given = state.internal.copy()
    code, state, _, more = advance(name, end, state=state)
    assert (code, part + more) == (COMPLETED, turns)
    assert state.motion == whole.motion
    assert state.counts == whole.counts
    assert state.internal.tolist() == whole.internal.tolist()
    assert state.memory.past.tolist() == whole.memory.past.tolist()
    assert not whole.memory.warm  # at the end of a segment nothing predicts the next
    if len(given):
        assert state_of(name).internal.tolist() == list(LAWS[name][1])
    assert advance(name, TIME)[0] == COMPLETED
    assert advance(name, end, budget=0)[0] == RUNNING
    assert advance(name, end, budget=turns)[0] == COMPLETED


def test_what_it_starts_from_is_not_changed():
    slider = st.presets.nakano_popov_2020().replace(friction=LAWS["lugre"][0])
    description = st.simulate(slider, 1e-3, sample_rate=0).description
    segment, method = next(segments(slider, 0.0, 1.0)), Smooth(slider, None)
    held = EXACT._replace(newton=1e-9)
    state = method.begin(description)
    before, out = copy_of(state), Output(NO_TIMES, np.zeros((0, COLUMNS + 2)), NO_TIMES)
    code, after = method.advance(segment.problem, state, 1e-3, held, 1000, out)
    assert (code, out.used) == (COMPLETED, after.counts.steps)
    assert after.internal.tolist() != before.internal.tolist()
    assert state.internal.tolist() == before.internal.tolist()
    assert state.memory.past.tolist() == before.memory.past.tolist()


@pytest.mark.parametrize("name", ["smoothed", "lugre"])
def test_a_step_without_error_grows_by_more(name):
    """(M43) with a tenth of the growth that the error allows, *(iii)* of section 16."""
    end, h = TIME + 1.0, 1e-9
    problem, start, w, q = begun(name, accuracy=HELD)
    *_, error, rejected, _ = plain(loop.step)(problem, start, *q, end, h, h, False, w, HELD)
    _, state, _, _ = advance(name, end, state=state_of(name, h=h), budget=1)
    growth = 0.1 * (error + 1e-10) ** -0.25
    assert (rejected, growth > 5.0) == (0, True)
    assert state.memory.h == pytest.approx(growth * h)


@pytest.mark.parametrize("name", ["smoothed", "lugre"])
def test_the_size_of_the_next_step(name):
    """(M43): at most twice as long, not after a refusal, nor longer than drive and load allow."""
    end = TIME + 1.0
    problem, start, w, q = begun(name, accuracy=HELD)
    *_, error, rejected, _ = plain(loop.step)(problem, start, *q, end, 1e-5, 1e-5, False, w, HELD)
    assert rejected == 0
    _, state, _, _ = advance(name, end, budget=1)
    assert state.memory.h == 1e-5 * plain(step_factor)(error, GROWTH)
    assert (state.memory.h_last, state.memory.warm) == (1e-5, True)
    assert state.memory.past == pytest.approx(w.values[:4])
    longest = HELD._replace(longest=1.2e-5)
    assert advance(name, end, longest, budget=1)[1].memory.h == 1.2e-5
    _, state, _, _ = advance(name, end, longest, state_of(name, h=1.0), budget=1)
    assert state.memory.h_last == 1.2e-5
    # after a refusal it grows no more
    _, state, _, _ = advance(name, end, state=state_of(name, h=1e-2), budget=1)
    assert state.counts.rejected > 0
    assert state.memory.h <= state.memory.h_last
    # a step that the end of the segment cuts says nothing of the next
    _, state, _, _ = advance(name, TIME + 1e-7)
    assert state.memory.h == 1e-5
    _, state, _, _ = advance(name, TIME + 0.9e-5)
    assert state.memory.h > 1e-5


def test_the_end_of_a_step():
    """What the drive has travelled less what has slipped (M26)."""
    problem, start, w, _ = begun("lugre")
    w.values[1:4, :2] = [[1e-3, 2e-3], [3e-3, 5e-3], [7e-3, 1e-2]]
    h, printed = 2e-3, Equations("lugre")
    motion = plain(loop.motion_at_end)(problem, start, h, 17.0, w)
    u = printed.u + printed.printed.drive("travel", TIME, h) - h * A[2] @ w.values[1:4, :2]
    assert motion == pytest.approx((17.0, *u, 7e-3, 1e-2))


@pytest.mark.parametrize("wrong", [np.nan, np.inf])
def test_what_is_no_number_ends_it(wrong):
    for i in range(4):
        motion = [*MOTION]
        motion[i] = wrong
        code, state, _, turns = advance("lugre", TIME + 1.0, state=state_of("lugre", motion))
        assert (code, turns) == (NON_FINITE, 0)
        assert state.motion.t == TIME
    state = state_of("lugre")
    state.internal[1] = wrong
    assert advance("lugre", TIME + 1.0, state=state)[0] == NON_FINITE
    finite = plain(loop.finite)
    assert finite(state_of("lugre").motion, np.array([1.0, 2.0]))
    assert not finite(state_of("lugre").motion, np.array([1.0, wrong]))


def test_where_no_step_is_accepted_it_ends():
    """As with a law that gives no numbers."""
    code, state, _, turns = advance("fed", TIME + 1.0, law=Fed(np.nan))
    assert (code, turns) == (STEP_UNDERFLOW, 1)
    assert state.motion == state_of("fed").motion
    assert state.counts.rejected > 10


@pytest.mark.parametrize("rtol", [1e-4, 1e-6, 1e-8])
@pytest.mark.parametrize("V", [1e-12, 1e-11, 1e-10])
def test_bristles_slide_as_slowly_as_plates_in_few_steps(V, rtol):
    """In a long step rounding makes more slip than the drive: some took more than 1e6 steps."""
    law = st.laws.LuGre(0.15, 0.2, "1 mm/s", "100 kN/m", "300 N*s/m")
    rig = {"mass": 0.25, "k_x": 1e3, "k_y": 1e7, "phi": "0 deg", "normal_load": 10.0}
    slider = st.Slider(**rig, friction=law, drive=st.ConstantVelocity(V))
    run = st.simulate(slider, 6e-3 / V, sample_rate=0, rtol=rtol)
    assert run.statistics.steps < 1000
    assert run.samples["spring_x"][-1] == pytest.approx(0.2 * 10.0, rel=10.0 * rtol)
