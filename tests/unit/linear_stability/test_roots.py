"""Sign changes of a function on 0 to 1: none is lost, and none is sought on a plateau."""

from itertools import count

import numpy as np
import pytest

from stiction.linear_stability.roots import POINTS, sign_changes


@pytest.mark.parametrize("middle", np.linspace(0.2, 0.8, 13))
@pytest.mark.parametrize("bend", [1.0, -1.0])
def test_two_changes_between_neighbouring_points_are_found(middle, bend):
    """A parabola below zero over a fifth of the distance between points."""
    half = 0.1 / (POINTS - 1)
    found, negative = sign_changes(lambda x: bend * ((x - middle) ** 2 - half**2), POINTS)
    assert found == pytest.approx([middle - half, middle + half], rel=1e-9)
    assert negative == (bend < 0.0, bend > 0.0, bend < 0.0)


def test_a_plateau_that_rounding_roughens_is_seen_from_the_points_alone():
    """The growth rate of rate and state on stiff springs is that of the state, -V/D_c."""
    calls, random = count(), np.random.default_rng(1)

    def growth(x):
        next(calls)
        return (x - 0.3 if x < 0.25 else -0.05) * (1.0 + 1e-12 * random.standard_normal())

    assert sign_changes(growth, POINTS) == ([], (True,))
    assert next(calls) == POINTS
