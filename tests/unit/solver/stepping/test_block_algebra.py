"""Linear algebra of triples and of 3 by 3 blocks, against NumPy's."""

import numpy as np
import pytest
from tests.drawn import inside
from tests.entry import plain

from stiction.solver.stepping import block_algebra as blocks

MATRICES = [np.reshape(each, (4, 3, 3)) for each in inside(3, *[(-1.0, 1.0)] * 36)]


def rows(matrix):
    return tuple(map(tuple, matrix.tolist()))


@pytest.mark.parametrize("m", MATRICES)
def test_products(m):
    a, b, x, y = m[0], m[1], m[2, 0], m[2, 1]
    assert plain(blocks.dot)(tuple(x), tuple(y)) == pytest.approx(x @ y, rel=1e-14)
    assert plain(blocks.times)(rows(a), tuple(x)) == pytest.approx(a @ x, abs=1e-14)
    assert np.array(plain(blocks.product)(rows(a), rows(b))) == pytest.approx(a @ b, abs=1e-14)
    assert plain(blocks.less)(tuple(x), tuple(y)) == pytest.approx(x - y, abs=1e-15)


@pytest.mark.parametrize("m", MATRICES)
def test_an_inverse_times_its_matrix_is_one(m):
    found = np.array(plain(blocks.inverse)(rows(m[0])))
    assert found @ m[0] == pytest.approx(np.eye(3), abs=1e-13 * np.linalg.cond(m[0]))


@pytest.mark.parametrize("m", MATRICES)
def test_six_equations_by_blocks(m):
    whole, right = np.block([[m[0], m[1]], [m[2], m[3]]]), np.arange(1.0, 7.0)
    factors = plain(blocks.eliminate)(*map(rows, m))
    p, w = plain(blocks.solve_blocks)(factors, tuple(right[:3]), tuple(right[3:]))
    rounding = 1e-13 * np.linalg.cond(whole) * np.linalg.cond(m[3])
    assert whole @ [*p, *w] == pytest.approx(right, abs=rounding)
