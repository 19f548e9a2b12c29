"""Reversals are classified as hesitations within a cycle, or as cycles."""

import numpy as np
import pytest
from tests.drawn import inside

from stiction.analysis.motion import hesitations
from stiction.analysis.motion.hesitations import ALIKE_FALLS, AROUND, FEW_FALLS, LEAST_FALL, OFTEN

SIZES = [np.array(each) for each in inside(3, *[(0.1, 1.0)] * 40)]


def weighted_median(values):
    """Return the value of those that, with all larger ones, make half of the sum."""
    total = 0.0
    for value in sorted(values):
        total += value
        if total >= 0.5 * sum(values):
            return value
    raise AssertionError


@pytest.mark.parametrize("sizes", SIZES)
def test_what_is_typical_around(sizes):
    """The median weighted by size, of twelve to each side; at the ends, of 25 in all."""
    found = hesitations.typical(sizes)
    for i in range(len(sizes)):
        middle = min(max(i, AROUND), len(sizes) - 1 - AROUND)
        near = sizes[middle - AROUND : middle + AROUND + 1]
        assert found[i] == weighted_median(near)
    few = hesitations.typical(sizes[:25])
    assert few.tolist() == [weighted_median(sizes[:25])] * 25
    assert hesitations.typical(sizes[:26]).tolist() == [
        *[weighted_median(sizes[:25])] * 13,
        *[weighted_median(sizes[1:26])] * 13,
    ]


def test_rises_are_compared_with_rises():
    """And falls with falls; the first leg and the last may be cut."""
    legs = np.array([7.0, 1.0, 5.0, 1.2, 5.0, 1.0, 5.0, 9.0])
    assert hesitations.swing(legs).tolist() == [0.0, 1.0, 5.0, 1.0, 5.0, 1.0, 5.0, 0.0]
    assert hesitations.swing(legs[:2]).tolist() == [0.0, 0.0]
    assert hesitations.swing(legs[:3]).tolist() == [0.0, 1.0, 0.0]


def cycles(*drops, dip=()):
    """Return peaks and troughs of falls from 10, with one dip of so much before each peak."""
    values = [5.0]
    for i, drop in enumerate(drops):
        if i < len(dip) and dip[i]:
            values += [8.0, 8.0 - dip[i]]
        values += [10.0, 10.0 - drop]
    return np.array([*values, 7.0])


def test_a_dip_of_less_than_half_of_alike_falls_is_a_hesitation():
    """Its first point and its height are told, and the falls are kept."""
    for depth, number in ((0.3, 1), (2.4, 1), (2.6, 0)):
        values = cycles(*[5.0] * 8, dip=(0, 0, 0, depth))
        found = hesitations.remove_hesitations(values)
        assert len(found.at) == number
        assert len(found.kept) == 16 + 2 * (1 - number)
        if number:
            assert found.at.tolist() == [7]
            assert found.depth == pytest.approx([depth])
            assert values[found.kept].tolist() == [10.0, 5.0] * 8


def test_several_hesitations_in_order():
    values = cycles(*[5.0] * 8, dip=(0, 0.2, 0, 0.1, 0, 0, 0.4))
    found = hesitations.remove_hesitations(values)
    assert values[found.at].tolist() == [8.0] * 3
    assert found.at.tolist() == sorted(found.at)
    assert found.depth == pytest.approx([0.2, 0.1, 0.4])


def test_where_falls_have_every_size_only_a_tenth_is_a_hesitation():
    """Then a fall of a third of the largest is a cycle, unless such come with each of them."""
    drops = (5.0, 1.8, 5.0, 4.0, 2.3, 5.0, 3.0, 5.0)
    found = hesitations.remove_hesitations(cycles(*drops))
    assert (len(found.at), len(found.kept)) == (0, 16)
    many = (5.0, 1.2, 1.3) * 8  # two lesser ones with each: they belong to it
    found = hesitations.remove_hesitations(cycles(*many))
    assert len(found.at) == 16
    assert len(found.kept) == 16
    assert OFTEN < 2


@pytest.mark.parametrize(("count", "taken"), [(22, 22), (21, 0)])
def test_reversals_that_come_with_the_falls_are_a_tenth_more_than_these(count, taken):
    """Of 20 falls that are not alike, of which none divides the swing."""
    falls = [5.0, 2.6, 5.0, 5.0, 2.6] * 4
    lesser = [[1.2] * (1 + (i < count - 20)) for i in range(20)]
    drops = [drop for fall, few in zip(falls, lesser, strict=True) for drop in (fall, *few)]
    assert len(hesitations.remove_hesitations(cycles(*drops)).at) == taken


def test_half_the_swing_divides_falls_that_differ():
    """If none lies between 40 and 60 %, their number is that of falls of half the swing."""
    drops = [5.0, 1.7, 5.0, 4.0, 1.5, 5.0, 3.1, 5.0, 3.2, 5.0]
    found = hesitations.remove_hesitations(cycles(*drops))
    assert (len(found.at), len(found.kept)) == (2, 16)
    drops[1] = 2.3
    assert len(hesitations.remove_hesitations(cycles(*drops)).at) == 0


def test_falls_of_one_size():
    """Their standard deviation is less than 0.23 of their mean, with twice its own error added."""
    for spread, alike in ((0.9, True), (1.1, False)):
        falls = 1.0 + spread * ALIKE_FALLS / (1 + (2 / 40) ** 0.5) * np.array([1.0, -1.0] * 20)
        # over what is typical of them, the larger ones
        assert hesitations._alike(falls) == alike
    assert hesitations._alike(np.ones(FEW_FALLS))
    assert not hesitations._alike(np.ones(FEW_FALLS - 1))


def test_too_few_points_hold_no_hesitation():
    for n in range(5):
        values = np.array([0.0, 5.0, 4.9, 9.0, 1.0][:n] or [0.0])
        assert len(hesitations.remove_hesitations(values).at) == 0


@pytest.mark.parametrize("way", [1, -1])
def test_what_the_record_cuts_of_a_hesitation_is_left_out(way):
    """Small legs before the first large one, and after the last."""
    values = np.array([5.0, 5.2, 5.1, 10.0, *[5.0, 10.0] * 7, 4.0])[::way]
    found = hesitations.remove_hesitations(values)
    inside = values[found.kept]
    assert set(inside.tolist()) == {5.0, 10.0}
    assert len(inside) == 15


@pytest.mark.parametrize("way", [1, -1])
def test_what_the_record_cuts_of_a_hesitation_is_left_out_even_if_its_first_leg_is_less(way):
    """It may be larger than the piece before it, of which the beginning is not known."""
    values = np.array([5.15, 5.2, 5.1, 10.0, *[5.0, 10.0] * 7, 4.0])[::way]
    assert set(values[hesitations.remove_hesitations(values).kept].tolist()) == {5.0, 5.1, 10.0}
    # unless a leg before is more than a tenth of the swing, of the largest falls the same
    values = np.array([10.0, 10.05, 9.95, 10.5, 4.5, *[9.5, 4.5] * 7, 8.0])[::way]
    assert 10.05 in values[hesitations._below(values, LEAST_FALL).kept]


@pytest.mark.parametrize("steep", [-0.8, -0.5, 0.5, 0.8])
def test_a_slow_motion_takes_no_cycles_out(steep):
    """Of so many swings a cycle: rises are much smaller than falls, or much larger."""
    size = np.tile([1.0, -1.0], 20)
    time = np.cumsum(np.tile([0.9, 0.1], 20))
    values = np.concatenate([[1.0], np.cumsum(size) + steep * time, [1.0]])
    values[-1] += values[-2]
    peaks, troughs = hesitations.level(values, time)[1:-1].reshape(-1, 2).T
    assert (np.ptp(peaks), np.ptp(troughs)) == pytest.approx((0.0, 0.0), abs=1e-12)
    assert len(hesitations.remove_hesitations(hesitations.level(values, time)).at) == 0


def test_cycles_beside_no_slow_motion_stay_as_they_are():
    for values in (cycles(*[5.0] * 8, dip=(0, 2.0, 0, 4.0)), cycles(*np.linspace(0.5, 5.0, 12))):
        time = np.arange(len(values) - 2.0)
        assert hesitations.level(values, time).tolist() == values.tolist()


def test_a_slow_motion_is_not_known_of_less_than_four_cycles():
    """So many go into the motion before a point and after it."""
    values = np.array([0.5, 1.0, 0.3, 1.2, 0.5, 1.0, 0.4, 2.4, 1.5])
    assert hesitations.level(values, np.arange(7.0)).tolist() == values.tolist()


@pytest.mark.parametrize("before", [[], [9.0]])
def test_corners_of_cycles_begin_and_end_with_a_trough(before):
    """Of a record that begins on a rise or with a fall, a hesitation in its second cycle."""
    value = np.array([*before, 5.0, 10.0, 5.0, 8.0, 7.75, 10.0, 5.0, 10.0])
    n = len(before)
    found = hesitations.cycle_corners(value, np.arange(len(value)), (7.0, 6.0), not before)
    assert value[found.kept].tolist() == [5.0, 10.0, 5.0, 10.0, 5.0]
    assert found.at.tolist() == [n + 3]
    assert found.depth.tolist() == [0.25]


def test_too_few_corners_are_no_cycle():
    for n in range(3):
        found = hesitations.cycle_corners(np.ones(n), np.arange(n), (0.0, 0.0), trough=True)
        assert len(found.kept) < 2


GIANTS = inside(40, (25.0, 700.0), (0.5, 2.5), (0.0, 1.0), (0.2, 5.0), (0.2, 0.8), (0.0, 0.3))


@pytest.mark.parametrize(("cycles", "decades", "few", "recovers", "at", "scatter"), GIANTS)
def test_a_few_giant_falls_take_no_cycles_out(cycles, decades, few, recovers, at, scatter):
    """Of which the force recovers within so many cycles: those beside them alone may be lost."""
    count = int(cycles)
    number = max(int(few * count / 40), 1)  # of giant falls
    places = ((np.arange(number) + at) * count // number).astype(int)
    size = 1.0 + scatter * np.sin(7.0 * np.arange(2 * count) ** 2)
    values = np.where(np.arange(2 * count) % 2, 0.5, -0.5) * size
    time = np.arange(2.0 * count)
    for place in 2 * places + 2:
        left = np.exp(-np.maximum(time - place, 0.0) / (2.0 * recovers))
        values -= np.where(time < place, 0.0, 10**decades * left)
    found = hesitations.cycle_corners(values, time, (0.0, 0.0), trough=True)
    lost = number * recovers * np.log(2.0 * 10**decades / recovers)
    assert len(found.kept) > 2 * (count - 2.0 * lost - 4.0)


@pytest.mark.parametrize(
    ("slips", "each", "depth", "creeps"), inside(20, (2, 9), (21, 60), (0.05, 0.3), (0.0, 1.0))
)
def test_falls_to_which_a_loading_leads_are_the_slips_however_rare(slips, each, depth, creeps):
    """They count as they are, although the others are far more."""
    slips, each = int(slips), int(each)
    load = np.arange(each) / each
    load += 0.3 * creeps * np.sin(np.pi * load)  # faster first
    dips = np.stack([load, load - depth], axis=1).ravel()[1:]
    values = np.concatenate([[0.0], np.tile(np.append(dips, 1.0), slips), [-1.0]])
    assert hesitations.largest_leg(values) == np.inf


@pytest.mark.parametrize("seed", range(20))
def test_what_is_typical_beside_joined_legs_is_what_it_is_of_all_anew(seed, monkeypatch):
    """In 78 000 reversals of noise one went after the other, and all were compared each time."""
    rng, passes = np.random.default_rng(seed), []
    legs = rng.lognormal(0.0, rng.uniform(0.3, 0.8), int(rng.integers(500, 4000)))
    value = np.cumsum(np.where(np.arange(len(legs)) % 2, legs, -legs))
    beside = hesitations._swing_beside

    def compare(size, legs, joined, most):
        found, anew = beside(size, legs, joined, most), hesitations.swing(legs, most)
        passes.append(np.array_equal(found[1:-1], anew[1:-1]))
        return found

    monkeypatch.setattr(hesitations, "_swing_beside", compare)
    found = hesitations._below(value, 0.5, float(np.quantile(legs, 0.95)))
    assert all(passes)
    assert len(passes) > 2
    assert len(found.at) > 10


@pytest.mark.parametrize("seed", range(20))
def test_no_more_is_looked_at_than_what_is_beside_joined_legs(seed):
    """The others keep what they have, here nothing."""
    rng = np.random.default_rng(seed)
    legs, joined = rng.lognormal(0.0, 0.5, 1500), np.sort(rng.integers(0, 1500, 3))
    beside = hesitations._swing_beside(np.zeros(1500), legs, joined, np.inf)
    far = np.abs(np.arange(1500)[:, None] - joined).min(axis=1) > 4 * hesitations.AROUND
    far[: 2 * hesitations.AROUND + 2] = far[-2 * hesitations.AROUND - 2 :] = False
    assert far.sum() > 500
    assert not beside[far].any()


@pytest.mark.parametrize(("high", "far"), [(2.9, False), (3.1, True), (-2.1, True), (-1.9, False)])
def test_a_leg_far_above_is_three_times_as_large_as_the_others(high, far):
    """It goes up and down again, or down and up."""
    values = np.tile([0.0, 1.0], 40)
    values[41 if high > 0.0 else 40] = high
    assert hesitations.largest_leg(values) == (1.0 if far else np.inf)
