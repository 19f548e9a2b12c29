"""Equations with internal states, against NumPy's solution of the whole."""

import numpy as np
import pytest
from tests.drawn import inside
from tests.entry import plain

from stiction.solver.smooth import elimination
from stiction.solver.smooth.right_hand_side import Point, Stages
from stiction.solver.smooth.workspace import INSIDE, START, workspace
from stiction.solver.stepping.block_algebra import eliminate, solve_blocks
from stiction.solver.stepping.radau import D

D = np.array(D)
H = 0.3


def draw_workspace(n, seed):
    """Return a workspace with random values and derivatives, and a stream of numbers."""
    numbers = iter(inside(seed + 1, *[(-1.0, 1.0)] * 600)[seed])
    w = plain(workspace)(n)
    for array in (w.values, w.changes, w.jacobian, w.cubic):
        array.flat[:] = [next(numbers) for _ in range(array.size)]
    for k in range(2, n + 2):  # states decay
        w.jacobian[:, k, k] = -abs(w.jacobian[:, k, k]) - 1.0
        w.size[k] = 0.5 + k
    return w, numbers


def triples(numbers, count):
    return [np.array([next(numbers) for _ in range(3)]) for _ in range(count)]


@pytest.mark.parametrize("n", [1, 2, 3])
@pytest.mark.parametrize("seed", [0, 1])
def test_a_step_of_slip_and_states(n, seed):
    """(M67) and (M68) as one matrix: what is eliminated solves it."""
    w, numbers = draw_workspace(n, seed)
    s_xx, s_xy, s_yy, *rest = triples(numbers, 3 + 8)
    nothing = (0.0, 0.0, 0.0)
    stages = Stages(*[nothing] * 4, *map(tuple, (s_xx, s_xy, s_yy)), *[nothing] * 4)
    blocks = [np.diag(d) + 4.0 * np.eye(3) * (i in (0, 3)) for i, d in enumerate(rest[:4])]
    size = n + 2
    whole = np.zeros((size, 3, size, 3))
    whole[:2, :, :2] = np.array(blocks).reshape(2, 2, 3, 3).transpose(0, 2, 1, 3)
    j = w.jacobian[1:4]
    for k in range(2, size):
        by_x = j[:, k, 0] * s_xx + j[:, k, 1] * s_xy
        by_y = j[:, k, 0] * s_xy + j[:, k, 1] * s_yy
        whole[k, :, 0], whole[k, :, 1] = -H * np.diag(by_x), -H * np.diag(by_y)
        for a in range(size):
            whole[a, :, k] += (H if a < 2 else -H) * np.diag(j[:, a, k])
        whole[k, :, k] += D
    x, y = rest[4:6]
    z = [
        D @ (w.values[1:4, k] - w.values[START, k]) - H * w.changes[1:4, k] for k in range(2, size)
    ]
    matrix = whole.reshape(3 * size, 3 * size)
    wanted = np.linalg.solve(matrix, np.concatenate([x, y, *z])).reshape(size, 3)
    as_tuples = [tuple(map(tuple, block.tolist())) for block in blocks]
    left = plain(elimination.without_states)(H, stages, tuple(as_tuples), w)
    right = plain(elimination.residuals_without)(H, tuple(x), tuple(y), w)
    d_x, d_y = plain(solve_blocks)(plain(eliminate)(*left), *right)
    rounding = 1e-12 * np.linalg.cond(matrix)
    assert np.array([d_x, d_y]) == pytest.approx(wanted[:2], abs=rounding)
    before = w.values.copy()
    moved = plain(elimination.correct_states)(d_x, d_y, w)
    assert before[1:4, 2:] - w.values[1:4, 2:] == pytest.approx(wanted[2:].T, abs=rounding)
    assert moved == pytest.approx((np.abs(wanted[2:]).max(axis=1) / w.size[2:]).max())
    w.values[:] = before
    assert np.isnan(plain(elimination.correct_states)((np.nan,) * 3, d_y, w))


@pytest.mark.parametrize("n", [1, 2, 3])
@pytest.mark.parametrize("seed", [0, 1])
def test_a_point_inside_a_step(n, seed):
    """(M70), y - P + gamma (P_c - h f) = 0, of the states; slip's own equations are given."""
    w, numbers = draw_workspace(n, seed)
    weight, size = 0.4, n + 2
    g = weight * H
    xx, xy, yy, *slip = (next(numbers) for _ in range(9))
    slip = [slip[0] + 4.0, slip[1], slip[2], slip[3] + 4.0, slip[4], slip[5]]
    at = Point(0.0, 0.0, 0.0, 0.0, xx, xy, yy, 0.0, 0.0, 0.0, 0.0)
    j, matrix = w.jacobian[INSIDE], np.zeros((size, size))
    matrix[:2, :2] = [slip[:2], slip[2:4]]
    slope = np.array([[xx, xy], [xy, yy]])
    matrix[2:, :2] = -g * j[2:, :2] @ slope
    matrix[:2, 2:] = g * j[:2, 2:]
    matrix[2:, 2:] = np.eye(n) - g * j[2:, 2:]
    off = w.values[INSIDE] - w.cubic[0] + weight * w.cubic[1] - g * w.changes[INSIDE]
    wanted = np.linalg.solve(matrix, [*slip[4:], *off[2:]])
    found = plain(elimination.slip_without_states)(g, weight, at, tuple(slip), w)
    d = np.linalg.solve(np.reshape(found[:4], (2, 2)), found[4:])
    rounding = 1e-12 * np.linalg.cond(matrix)
    assert d == pytest.approx(wanted[:2], abs=rounding)
    before = w.values.copy()
    moved = plain(elimination.correct_states_inside)(*d, w)
    assert before[INSIDE, 2:] - w.values[INSIDE, 2:] == pytest.approx(wanted[2:], abs=rounding)
    assert moved == pytest.approx((np.abs(wanted[2:]) / w.size[2:]).max())
    w.values[:] = before
    assert np.isnan(plain(elimination.correct_states_inside)(np.nan, 0.0, w))


def test_the_room_of_a_step():
    w = plain(workspace)(2)
    assert w.values.shape == w.changes.shape == (6, 4)
    assert w.jacobian.shape == (6, 4, 4)
    assert w.past.shape == (4, 4)
    assert w.blocks.shape == (4, 4, 9)
    assert (w.point.shape, w.right.shape, w.cubic.shape) == ((4, 4), (4, 3), (2, 4))
    assert w.size.tolist() == [1.0] * 4
    assert not any(array.any() for name, array in w._asdict().items() if name != "size")
