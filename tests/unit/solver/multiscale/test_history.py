"""Stored cycles, and the prediction of others from them."""

import numpy as np
import pytest
from tests.entry import map_of, plain

from stiction.solver.multiscale import history
from stiction.solver.multiscale.return_map import FAR, NEAR, PAST, STEPS, Cycle

LAST = Cycle(0.01, 1e-3, 4e-4)  # so that a long cycle takes more than 2 ms
BOUND = NEAR * map_of(1e-6).closing


def knowing(*cycles):
    """Return a map with cycles remembered: angle, turn, time, time held."""
    known = map_of(1e-6)
    for theta, *cycle in cycles:
        plain(history.remember)(known, theta, Cycle(*cycle))
    return known


def test_the_oldest_is_forgotten():
    known = knowing(*[(float(i), 0.1, 1.0, 0.5) for i in range(PAST + 3)])
    assert known.sizes[2] == PAST + 3
    assert sorted(known.past[:, 0]) == list(range(3, PAST + 3))
    assert known.past[2].tolist() == [PAST + 2, 0.1, 1.0, 0.5]


def test_steps_that_are_forgotten_leave_the_pieces_of_patches():
    """These lie elsewhere: another patch wrote over them once."""
    known = map_of(1e-6, samples=True)
    known.inside.spans[PAST, 1] = 35
    known.record.used[0] = STEPS // 3
    for i in range(4):
        plain(history.remember)(known, float(i), LAST)
    assert known.inside.spans[:4, 1].tolist() == [0, 0, 0, STEPS // 3]
    assert known.inside.spans[PAST].tolist() == [STEPS // 3, 35]


def test_the_two_nearest():
    """Of long ones, or of short ones; none where there are too few."""
    known = knowing((0.5, 0, 9, 0), (0.1, 0, 1, 0), (0.3, 0, 1, 0), (0.2, 0, 1, 0), (0.6, 0, 9, 0))
    nearest = plain(history.nearest)
    assert nearest(known, 0.11, False, 2.0) == (1, 3)
    assert nearest(known, 0.26, False, 2.0) == (2, 3)
    assert nearest(known, 0.9, False, 2.0) == (2, 3)
    assert nearest(known, 0.0, True, 2.0) == (0, 4)
    assert nearest(known, 0.7, True, 2.0) == (4, 0)
    assert nearest(known, 0.0, True, 10.0) == (-1, -1)
    assert nearest(knowing((0.1, 0, 1, 0)), 0.1, False, 1.0) == (0, -1)  # no longer than that


def test_a_line_through_two_cycles():
    known = knowing((0.1, 0.02, 1.0, 0.3), (0.4, 0.05, 1.6, 0.9))
    assert plain(history.change)(known, 0, 1, 0.2) == pytest.approx((0.02, 0.4, 0.4))
    assert plain(history.change)(known, 1, 0, -0.1) == pytest.approx((-0.01, -0.2, -0.2))


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_a_cycle_is_under_way_from_where_it_began(way):
    """Up to so many turns later, and as little before as landings may differ by."""
    last, known = Cycle(way * LAST.turn, *LAST[1:]), knowing((0.5, 0.0, 1.0, 0.0))
    before = (BOUND * LAST.time / LAST.held) ** 2
    under = plain(history.under_way)
    for turns, wanted in ((0.0, True), (0.99 * FAR, True), (1.01 * FAR, False), (-1e-3, False)):
        assert under(known, 0, 0.5 + turns * last.turn, last) == wanted
    short = last._replace(held=10 * BOUND * LAST.time)  # the stick before may be a tenth of it
    assert before < 1e-3
    for turns, wanted in ((-0.99e-2, True), (-1.01e-2, False)):
        assert under(known, 0, 0.5 + turns * last.turn, short) == wanted
    shorter = last._replace(held=0.1 * BOUND * LAST.time)  # but no more than a turn
    for turns, wanted in ((-0.99, True), (-1.01, False)):
        assert under(known, 0, 0.5 + turns * last.turn, shorter) == wanted
    known = knowing((0.5, -0.3, 1.0, 0.0))  # or by what the angles of ends may differ
    for share, wanted in ((-0.99, True), (-1.01, False)):
        assert under(known, 0, 0.5 + way * share * BOUND * 0.3, last) == wanted


def long_cycle(theta, off_turn=0.0, off_time=0.0):
    """Return one that ends at the angle 2 as if it had begun at 0.5 at the time 0."""
    return (
        theta,
        2.0 - theta + off_turn,
        1.0 - (theta - 0.5) * LAST.time / LAST.turn + off_time,
        0.2,
    )


def test_a_long_cycle_ends_where_others_did():
    """(M59)."""
    known, theta = knowing(long_cycle(0.495), long_cycle(0.49)), 0.5
    found, cycle = plain(history.same_end)(known, theta, LAST)
    assert found == 0
    assert cycle == pytest.approx(long_cycle(theta)[1:], rel=1e-12)
    assert plain(history.recall)(known, theta, LAST) == (found, cycle)
    # not if one alone is known, nor before both, nor where they end apart
    assert plain(history.same_end)(knowing(long_cycle(0.495)), theta, LAST)[0] < 0
    assert plain(history.same_end)(known, 0.4, LAST)[0] < 0
    assert plain(history.same_end)(known, 0.51, LAST)[0] == 0
    assert plain(history.same_end)(known, 0.52, LAST)[0] < 0
    for share, wanted in ((0.99, True), (1.01, False)):
        for part in ("off_turn", "off_time"):
            bound = share * BOUND * (1.505 if part == "off_turn" else long_cycle(0.495)[2])
            apart = knowing(long_cycle(0.495), long_cycle(0.49, **{part: bound}))
            assert plain(history.same_end)(apart, theta, LAST)[0] == (0 if wanted else -1)
            apart = knowing(long_cycle(0.495), long_cycle(0.49, **{part: -bound}))
            assert plain(history.same_end)(apart, theta, LAST)[0] == (0 if wanted else -1)


@pytest.mark.parametrize("column", [1, 2, 3])
def test_a_short_cycle_on_a_line_that_hardly_matters(column):
    """By less than landings may differ by, of the turn and of the time."""
    for way in (1.0, -1.0):
        for share, wanted in ((0.99, True), (1.01, False)):
            a = np.array([0.50, -0.02, 1e-3, 4e-4])
            b = np.array([0.51, *a[1:]])
            b[column] += way * share * BOUND * abs(a[column if column < 3 else 2])
            found, cycle = plain(history.recall)(knowing(a, b), 0.49, LAST)
            assert found == (0 if wanted else -1)
            assert cycle == pytest.approx(tuple(a[1:] - (b - a)[1:]), rel=1e-12)
    assert plain(history.recall)(knowing(a), 0.5, LAST) == (-1, LAST)


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_a_cycle_of_a_limit_cycle_ends_where_others_did(way):
    """It comes back to its angle wherever it began, and none is longer than those before it."""
    there = 0.5, 1e-9, 0.9, 0.2
    for share, wanted in ((0.99, 0), (1.01, -1)):  # of how far the two starts are apart
        other = (0.6, -0.1 + 1e-9 + way * share * BOUND * 0.1 / 0.499, 0.9, 0.2)
        found, cycle = plain(history.recall)(knowing(there, other), 0.5499, Cycle(*there[1:]))
        assert found == wanted
        if wanted == 0:
            assert 0.5499 + cycle.turn == pytest.approx(0.5, abs=BOUND * 0.1 + 1e-9)
            assert cycle[1:] == there[2:]
