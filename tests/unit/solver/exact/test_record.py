"""Steps kept as rows, and the motion inside them."""

import numpy as np
import pytest
from tests.entry import plain
from tests.systems import SLIDERS, motion_of, problem_of
from tests.unit.solver.exact.test_loop import MEMORY, NEVER, NOWHERE
from tests.unit.solver.exact.test_newton import SLIDES, held_to
from tests.unit.solver.exact.test_sampling import EXACT, step_of

from stiction.solver.exact import error_estimate, loop, pursuit, record, sampling, slip_frame
from stiction.solver.multiscale import inside
from stiction.solver.state import NOTHING, Motion, State


@pytest.mark.parametrize(("name", "drawn"), [(n, d) for n in SLIDERS for d in SLIDES])
@pytest.mark.parametrize("size", [0.02, 0.5])
def test_the_motion_inside_a_kept_step(name, drawn, size):
    """At its end exactly, inside it up to what the cubic misses, which falls with the size."""
    problem, frame, _, _, step = step_of(name, drawn, size)
    _, h, p, _ = step
    row, start = np.full(record.WIDTH, np.nan), plain(slip_frame.outset)(problem, frame)
    plain(record.write_step)(row, frame, start, step)
    assert not np.isnan(row).any()
    motion = Motion(frame.t, frame.u_x, frame.u_y, frame.r, frame.e_x, frame.e_y)
    assert plain(record.start_of)(row) == motion
    moving, _ = plain(error_estimate.moving)(problem, frame, start, EXACT)
    scale = np.array([h * max(p), h * max(p), max(p), 1.0])
    for part, rel in ((0.0, 1e-14), (0.3, 1e-2 * size**2), (0.8, 1e-2 * size**2), (1.0, 1e-12)):
        exact = plain(sampling.within)(problem, frame, start, step, part * h, EXACT, moving)
        found = np.array(plain(record.slip_within)(row, part * h))
        assert found / scale == pytest.approx(np.array(exact) / scale, abs=rel)


def test_the_motion_inside_a_kept_landing():
    """It is that of the closed form, of a force that is not along the slip."""
    problem, motion = problem_of("steady"), motion_of(5e-4, 1e-5, 9e-7, 4e-7)
    frame, kept = plain(slip_frame.frame_of)(problem, motion), record.record_of(1)
    kept.rows[:] = np.nan
    r, a_1, a_2, f = motion.r, -3.0, -4.0, 8.0
    T = plain(pursuit.landing_time)(r, a_1, a_1**2 + a_2**2, f)
    plain(record.keep_landing)(kept, frame, T, a_1, a_2, f)
    closed, samples = (T, *plain(pursuit.landing_slip)(r, a_1, a_2, f)), np.zeros((2, 7))
    plain(inside.write_kept)(problem, kept.rows, 0, 0.4 * T, samples, 0)
    arguments = problem, motion, a_1, a_2, f, closed, 0.6 * T, 0.4 * T, samples, 1
    plain(pursuit.write_landing)(*arguments)
    assert samples[0] == pytest.approx(samples[1], rel=1e-12)


def test_the_loop_keeps_each_step():
    """One behind the other; a run that keeps none is the same."""
    problem, kept = problem_of("steady"), record.record_of(200)
    begun = State(Motion(0.35, 1.9e-3, 1e-5, 0.0, 0.6, 0.8), MEMORY, NOTHING)
    ends = []
    for keeps in (kept, record.record_of(0)):
        sticks = np.zeros((50, 2))
        sink, take_steps = record.Sink(NEVER, NOWHERE, sticks, keeps), plain(loop.take_steps)
        ends.append(take_steps(problem, begun, 0.45, held_to(1e-4), 1000, sink, 0))
    assert ends[0] == ends[1]
    assert keeps.used[0] == kept.used[0]
    rows = kept.rows[: kept.used[0]]
    assert 200 > len(rows) >= ends[0][1].counts.steps > 5
    gaps = rows[1:, 0] - (rows[:-1, 0] + rows[:-1, record.SIZE])
    assert np.count_nonzero(gaps > 1e-12) <= ends[0][1].counts.sticks
    assert gaps.min() > -1e-12


def test_steps_beyond_the_room_are_counted_only():
    room = record.record_of(0)
    plain(record.keep_step)(room, None, None, None)
    plain(record.keep_landing)(room, None, 0.1, 1.0, 2.0, 3.0)
    assert room.used[0] == 2
