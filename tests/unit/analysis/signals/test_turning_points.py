"""Reversals, the gap among their heights, turning points: each against a slow, plain count."""

import numpy as np
import pytest
from scipy.stats import binom
from tests.drawn import inside

import stiction as st
from stiction.analysis.signals import peak_refinement, reversals, turning_points
from stiction.analysis.signals.peak_refinement import fit_pieces
from stiction.analysis.signals.robust import uniform_mean

WALKS = [np.rint(np.cumsum(each) * 40).astype(np.int64) for each in inside(4, *[(-1.0, 1.0)] * 60)]


def turns_of(values):
    """Return where a signal turns, one sample after the other, and both ends."""
    found, way = [0], 0
    for i in range(1, len(values)):
        step = np.sign(values[i] - values[i - 1])
        if step and way and step != way:
            first = i - 1
            while values[first - 1] == values[first]:  # of equal neighbours, the first
                first -= 1
            found.append(first)
        way = step or way
    return [*found, len(values) - 1]


def by_one(values, below=np.inf):
    """Take out reversals, always the smallest of all; return points and heights."""
    points, heights = turns_of(values), []
    while len(points) > 3:
        legs = np.abs(np.diff(values[points]))
        inner = [i for i in range(1, len(legs) - 1) if legs[i] <= min(legs[i - 1], legs[i + 1])]
        inner = [i for i in inner if legs[i] < below]
        if not inner:
            break
        smallest = min(inner, key=lambda i: legs[i])
        heights.append(int(legs[smallest]))
        del points[smallest : smallest + 2]
    return points, sorted(heights)


@pytest.mark.parametrize("walk", WALKS)
@pytest.mark.parametrize("below", [np.inf, 30, 60])
def test_reversals(walk, below):
    assert reversals.extrema(walk).tolist() == turns_of(walk)
    points, heights = reversals.remove_reversals(walk, below)
    wanted_points, wanted = by_one(walk, below)
    assert sorted(heights.tolist()) == wanted
    assert walk[points].tolist() == walk[wanted_points].tolist()


def test_reversals_of_a_long_signal_many_at_once_and_then_one_by_one():
    noise = np.array(inside(1, *[(-1e3, 1e3)] * 400)[0])
    slowly = 500.0 * np.sin(np.arange(400.0)) * (2.0 + np.sin(np.arange(400.0) / 30.0))
    for values in (noise, slowly, noise + slowly):
        test_reversals(np.rint(values).astype(np.int64), np.inf)


def test_the_ends_of_a_signal():
    assert reversals.extrema(np.array([], dtype=np.int64)).tolist() == []
    assert reversals.extrema(np.array([5])).tolist() == [0]
    assert reversals.extrema(np.array([5, 5])).tolist() == [0, 1]
    assert reversals.extrema(np.array([0, 3, 3, 3, 1, 1, 2, 2])).tolist() == [0, 1, 4, 7]
    assert reversals.extrema(np.array([2, 2, 3])).tolist() == [0, 2]


@pytest.mark.parametrize("walk", WALKS)
def test_all_heights_are_those_taken_out_and_half_of_the_rest(walk):
    points, heights = by_one(walk)
    rest = sorted(np.abs(np.diff(walk[points]))[1:-1])[::2]
    assert sorted(reversals.all_heights(walk).tolist()) == sorted([*heights, *rest])


@pytest.mark.parametrize(
    ("values", "wanted"),
    [
        ([0, 9, 0, 9, 0], [1, 2, 3]),  # the outer ends of the cut legs are not known
        ([0, 9, 0, 9, 6], [1, 2, 3]),  # the last leg is cut, and enough
        ([0, 9, 0, 9, 8], [1, 2]),  # and here not: nor is known where the leg before it ends
        ([0, 9, 0, 9, 0, 9, 6, 8], [1, 2, 3, 4, 5]),
        ([5, 9, 0, 9, 0, 2], [1, 2, 3]),
        ([0, 1, 0, 1, 0], []),
        ([7, 9, 0, 9, 8, 9, 0], [2, 3]),
    ],
)
def test_what_stands_out(values, wanted):
    """Legs of 5 at least, of those that may be cut 3."""
    assert reversals.standing_out(np.array(values), 5, 3).tolist() == wanted


@pytest.mark.parametrize(("found", "among", "chance"), [(7, 10, 0.3), (3, 40, 0.01), (40, 50, 0.5)])
def test_a_chance_is_bounded(found, among, chance):
    """Chernoff: the bound has the right exponent; of what is no surprise it tells nothing."""
    worth = float(turning_points.surprise(found, among, chance))
    exact = -binom.logsf(found - 1, among, chance)
    assert worth <= exact <= worth + np.log(among + 1)
    assert turning_points.surprise(2, 10, 0.3) == 0.0
    assert turning_points.surprise(0, 0, 0.3) == 0.0


@pytest.mark.parametrize(("small", "large"), [(1.0, 20.0), (3.0, 10.0)])
def test_the_widest_gap_lies_between_two_kinds_of_heights(small, large):
    """It is found wherever it is, and so much clearer, the more heights there are above it."""
    clear = []
    for number in (5, 50):
        heights = [*np.linspace(0.5, 1.0, 200) * small, *np.linspace(1.0, 1.3, number) * large]
        found = turning_points.widest_gap(heights, 0.1, 60)
        assert 0.8 * small <= found.low <= 1.2 * small + 0.1  # edges are 2^(1/4) apart
        assert 0.8 * large <= found.high <= 1.2 * large
        assert found.middle == pytest.approx((found.low * found.high) ** 0.5)
        clear.append(found.clearness)
    assert clear[1] > 5 * clear[0] > 5 * 3
    assert (
        turning_points.widest_gap(heights, 0.1, 40).clearness < clear[1]
    )  # no more than so many are large
    # the counts of two steps and more alone, and none where all are as small
    assert turning_points.widest_gap(heights, large, 60) == turning_points.NO_GAP
    assert turning_points.widest_gap([], 0.1, 60) == turning_points.NO_GAP
    assert turning_points.widest_gap(heights, 0.0, 60) == turning_points.NO_GAP


def test_a_gap_reaches_up_to_the_lowest_of_the_large_heights():
    """To an edge below it, which are a quarter of an octave apart, down from the largest height."""
    heights = [*np.linspace(0.5, 1.0, 200), *np.linspace(0.9, 1.0, 30) * 20.0]
    found = turning_points.widest_gap(heights, 0.1, 60)
    assert 0.9 * 20.0 * 2**-0.25 < found.high <= 0.9 * 20.0


def test_a_gap_is_as_unlikely_as_a_random_walk_makes_it():
    """n (a/b)^2 of n heights above a are above b; each end lies 2 x 0.583 steps farther."""
    heights, step = [*[2.0] * 99, 16.0, 16.0, 16.0, 16.0], 0.5
    found = turning_points.widest_gap(heights, step, 50)
    beyond = 2 * 0.583 / 0.674 * step
    share = ((found.low + beyond) / (found.high + beyond)) ** 2
    assert found.clearness == pytest.approx(-4 * np.log(share))  # all four
    assert 2.0 + step < found.low < 1.2 * (2.0 + step)
    assert found.high == 16.0


def test_a_walk_has_no_clear_gap():
    """At most one of 400 would."""
    for walk in inside(6, *[(-1.0, 1.0)] * 400):
        points = turning_points.turning_points(np.cumsum(walk))
        assert len(points.index) == 0
        assert points.clearness < turning_points.CLEAR
    assert 0.5 / 400 < 20 * 20 * np.exp(-turning_points.CLEAR) < 1 / 400


@pytest.mark.parametrize("first", [0.0, 1.0])
def test_turns_at_every_sample_begin_with_what_the_first_two_tell(first):
    values = np.where(np.arange(24) % 2 == 0, first, 1.0 - first)
    points = turning_points.turning_points(values)
    assert points.index[0] == 1
    assert points.trough[0] == (first == 1.0)
    assert (points.trough[1:] != points.trough[:-1]).all()


def test_a_record_of_few_samples_is_not_clear_at_all():
    assert turning_points.turning_points(np.arange(5.0)).clearness == 0.0


# --- levels -------------------------------------------------------------------------------------


def test_counts_are_the_same_in_any_unit():
    values = np.array([0.3, -1.7, 2.4, 0.1])
    counts = turning_points.as_counts(values)
    assert counts.dtype == np.int64
    assert (counts.min(), counts.max()) == (0, turning_points.COUNTS)
    # finer than a converter of 24 bits, and sums over 2^30 samples fit into 64
    assert 2**24 < turning_points.COUNTS <= 2**33
    back = values.min() + counts * np.ptp(values) / turning_points.COUNTS
    assert back == pytest.approx(values, abs=0.6 * np.ptp(values) / turning_points.COUNTS)
    assert turning_points.as_counts(-3e-7 * values + 5e-8).tolist() == [
        turning_points.COUNTS - each for each in counts
    ]
    assert turning_points.as_counts(np.full(3, 7.0)).tolist() == [0, 0, 0]
    assert turning_points.as_counts(np.zeros(0)).tolist() == []


def test_a_wild_sample_is_limited_to_where_its_neighbours_lead():
    """By their values and their straight lines; a peak, a corner and the ends stay."""
    smooth = np.cos(np.linspace(-2, 2, 21))
    assert turning_points.without_spikes(smooth) == pytest.approx(smooth, abs=1e-15)
    saw = np.concatenate([np.arange(10.0), np.arange(10.0)[::-1]])
    assert turning_points.without_spikes(saw).tolist() == saw.tolist()
    line = np.arange(9.0)
    for place in range(2, 7):
        for wild in (-50.0, 50.0):
            values = line.copy()
            values[place] = wild
            found = turning_points.without_spikes(values)[place]
            # the larger of its neighbours, or the smaller; their lines lead to its own place
            assert found == (place + 1 if wild > 0 else place - 1)
    bent = np.array([0.0, 1.0, 50.0, 8.0, 9.0])
    assert turning_points.without_spikes(bent)[2] == 8.0
    steep = np.array([0.0, 5.0, 50.0, 8.0, 9.0])
    assert turning_points.without_spikes(steep)[2] == 10.0  # 2 x 5 - 0
    steep = np.array([9.0, 8.0, 50.0, 5.0, 0.0])
    assert turning_points.without_spikes(steep)[2] == 10.0
    assert turning_points.without_spikes(line[:4]).tolist() == [0.0, 1.0, 2.0, 3.0]


def test_sums_of_two_four_eight_samples():
    counts = np.array([*np.arange(70), 1000, *np.arange(71, 129)])  # a wild one
    levels = list(turning_points.running_sums(counts))
    assert [len(each) for each in levels] == [129, 64, 32, 16]
    assert levels[0] is counts
    pairs = [2 * i + 0.5 for i in range(64)]
    assert levels[1] / 2 == pytest.approx(pairs, abs=2.1)  # a median of three is a neighbour's
    assert np.abs(levels[1] / 2 - pairs).max() < 2.1
    assert list(turning_points.running_sums(np.arange(15))) == []
    assert len(list(turning_points.running_sums(np.arange(16)))) == 1


def test_the_typical_step_and_the_reach_of_noise():
    assert turning_points.typical_step(np.array([0, 0, 3, 3, 8, 7, 7])) == 3.0
    assert turning_points.typical_step(np.array([4, 4, 4])) == 0.0
    noise = np.rint(np.array(inside(1, *[(-1.0, 1.0)] * 3000)[0]) * 1e6).astype(np.int64)
    _, heights = by_one(noise[:200], 5e5)
    reach = turning_points.noise_reach(noise[:200], 5e5)
    assert reach == pytest.approx(6 * sum(heights) / 200)
    assert turning_points.noise_reach(np.zeros(0, np.int64), 1.0) == 0.0


def test_few_samples_a_cycle():
    """Turning points are those of cycles if nearly all legs and all periods are alike."""
    time = np.arange(120)
    alike = np.rint(1e6 * np.sin(2 * np.pi * time / 5.3 + 0.2)).astype(np.int64)
    found = turning_points.coarse_points(alike)
    assert found.tolist() == turns_of(alike)[1:-1]
    noise = np.rint(np.array(inside(1, *[(-1.0, 1.0)] * 120)[0]) * 1e6).astype(np.int64)
    assert len(turning_points.coarse_points(noise)) == 0
    growing = np.rint(alike * np.linspace(0.1, 1.0, 120)).astype(np.int64)
    assert len(turning_points.coarse_points(growing)) == 0
    chirp = np.rint(1e6 * np.sin(2 * np.pi * time**2 / 700)).astype(np.int64)
    assert len(turning_points.coarse_points(chirp)) == 0


@pytest.mark.parametrize("count", [12, 11])
def test_as_many_turning_points_as_are_needed(count):
    values = np.array([0, 10] * ((count + 2) // 2) + [0] * (count % 2))
    assert len(turns_of(values)) - 2 == count
    assert len(turning_points.coarse_points(values)) == (count if count >= 12 else 0)


@pytest.mark.parametrize("unit", [1.0, -1e-6])
@pytest.mark.parametrize("noise", [0.0, 0.02])
def test_a_sawtooth_turns_where_it_does(unit, noise):
    """Every trough and peak but those at the ends; values and noise in the signal's unit."""
    time = np.arange(4000)
    random = np.random.Generator(np.random.Philox(5)).normal(size=4000)
    signal = np.where(time % 400 < 350, time % 400 / 350, (400 - time % 400) / 50)
    points = turning_points.turning_points(unit * (signal + noise * random))
    at = np.array(sorted([*range(350, 4000, 400), *range(400, 4000, 400)]))
    assert (points.index + 0.5) * points.width - 0.5 == pytest.approx(
        at[: len(points.index)], abs=25 if noise else 2
    )
    assert len(points.index) in (18, 19)
    assert points.trough.tolist() == [(k % 2 == 1) == (unit > 0) for k in range(len(points.index))]
    assert points.clearness > turning_points.CLEAR
    assert points.noise == pytest.approx(2 * noise * abs(unit) / points.width**0.5, rel=0.6)
    assert points.noise / abs(unit) < points.least / abs(unit) < 1.0
    scaled = points.values / unit
    assert (scaled.min(), scaled.max()) == pytest.approx((0.0, 1.0), abs=6 * noise + 0.02)
    assert abs(points.before / unit) == pytest.approx(0.0, abs=0.15)


def test_means_show_what_noise_hides_from_sample_to_sample():
    """The level with the clearest gap decides, here one of means over some samples."""
    time = np.arange(16_000)
    random = np.random.Generator(np.random.Philox(5)).normal(size=16_000)
    signal = np.abs(time % 1600 - 800) / 800
    points = turning_points.turning_points(signal + 0.2 * random)
    assert points.clearness > turning_points.CLEAR
    assert points.width > 4
    means = signal[: len(points.values) * points.width].reshape(-1, points.width).mean(axis=1)
    assert np.abs(points.values - means).mean() < 0.2 / points.width**0.5
    assert (points.index + 0.5) * points.width == pytest.approx(800 * np.arange(1, 20), abs=200)


def test_before_and_after():
    """The farthest that the signal is from the first point, and from the last one."""
    values = np.array([3.0, 1.0, 5.0, 0.0, 4.0, 2.0, 6.0, 5.0])
    of = turning_points.TurningPoints
    points = of(np.array([2, 3, 4]), np.array([False, True, False]), values, 1, 0.0, 99.0)
    assert (points.before, points.after) == (1.0, 2.0)
    points = of(np.array([3, 4, 5]), np.array([True, False, True]), values, 1, 0.0, 99.0)
    assert (points.before, points.after) == (5.0, 6.0)


# --- their places -------------------------------------------------------------------------------


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("width", [1, 4])
def test_a_smooth_top_is_placed_between_samples(sign, width):
    """By a parabola, which a parabola's top is exactly; in means over some samples too."""
    time = 0.7 + 0.01 * np.arange(400)
    top = 0.5 * (time[0] + time[-1]) + 0.0037
    signal = sign * (2.0 - (time - top) ** 2)
    means = signal.reshape(-1, width).mean(axis=1)
    low = int(np.argmin(sign * means[: len(means) // 2]))
    index = np.array([low + 1, int(np.argmax(sign * means)), len(means) - 2])
    trough = np.array([True, False, True]) if sign > 0 else np.array([False, True, False])
    points = turning_points.TurningPoints(index, trough, means, width, 1e-3, 99.0)
    found = peak_refinement.vertices(time, points)
    assert found.time[1] == pytest.approx(top, abs=1e-9)
    off = np.mean((np.arange(width) - (width - 1) / 2) ** 2) * 0.01**2  # what means take off
    assert found.value[1] == pytest.approx(sign * (2.0 - off), abs=1e-9)


@pytest.mark.parametrize("noise", [0.0, 0.6, 2.2, 50.0])
@pytest.mark.parametrize("index", [[4, 9, 15, 18], [1, 9, 18], [5, 8], [2, 4, 15, 17, 18]])
@pytest.mark.parametrize("first_trough", [True, False])
def test_the_samples_of_a_top_are_those_within_the_noise(noise, index, first_trough):
    """A slow search of each leg; of less than three the top and its neighbours."""
    index = np.array(index)
    trough = np.arange(len(index)) % 2 == (0 if first_trough else 1)
    turns = np.interp(np.arange(20), [-3, *index, 23], [0.0, *np.where(trough, -3.0, 3.0), 0.0])
    values = turns + 0.8 * np.sin(7.0 * np.arange(20))
    upward = np.where(trough, -1.0, 1.0)
    points = turning_points.TurningPoints(index, trough, values, 1, noise, 99.0)
    ends = [2 * index[0] - index[1], *index, 2 * index[-1] - index[-2]]
    ends = [max(0, ends[0]), *index, min(19, ends[-1])]
    first, last = peak_refinement._within_noise(points, upward)
    for i, top in enumerate(index):
        level = upward[i] * values[top] - noise
        on_top = [j for j in range(20) if upward[i] * values[j] >= level]
        rise = [j for j in on_top if ends[i] <= j < top]
        fall = [j for j in on_top if top <= j < ends[i + 2]]
        begin, end = min([*rise, top]), max([*fall, top])
        if end - begin < 2:
            begin, end = min(begin, max(top - 1, 0), 17), max(end, top + 1, 2)
        assert (first[i], last[i]) == (begin, min(end, 19))


@pytest.mark.parametrize("noise", [0.0, 0.002, 0.01, 0.03])
@pytest.mark.parametrize("seed", range(5))
def test_no_top_beside_a_sudden_fall_lies_beyond_the_samples(noise, seed):
    """The sample beyond the fall bent the parabola: tops lay up to 15 % of the fall outside."""
    random = np.random.default_rng(seed)
    time = 0.01 * np.arange(3000)
    cycles = (time + random.uniform(0.0, 1.7)) % 1.7 / 1.7
    force = 1.0 + cycles + noise * random.standard_normal(3000)
    cycles = st.analyse(st.Record(time=time, force=force)).cycles
    off = max(cycles["peak"].max() - force.max(), force.min() - cycles["trough"].min())
    assert off < 0.5 * noise + 1e-12
    # a top lies within a sample of its fall, and a mean of the noise within its error
    assert abs(cycles["peak"] - 2.0).max() < 0.01 + 4.0 * noise


def test_a_corner_stays_where_it_is_sampled():
    """It bends more than twice as much as next to it; a parabola would lie beside."""
    values = np.array([0.0, 1.0, 2.0, 3.0, 4.0, 1.0, 0.5, 0.2, 1.0, 2.0, 3.0])
    points = turning_points.TurningPoints(
        np.array([4, 7]), np.array([False, True]), values, 1, 0.0, 99.0
    )
    found = peak_refinement.vertices(np.arange(11.0) * 0.1, points)
    assert (found.time[0], found.value[0]) == pytest.approx((0.4, 4.0))
    # of second differences 1 and 1.2 beside one of 2.5: more than twice; of 1 and 1.3, not
    for beside, corner in ((1.2, True), (1.3, False)):
        bends = np.array([0.5, 0.7, 1.0, 2.5, beside, 0.6, 0.5])
        for mirrored in (bends, bends[::-1]):
            top = -np.cumsum(np.cumsum([0.0, 0.0, *mirrored]))
            slope = np.diff(top)[np.argmax(mirrored) : np.argmax(mirrored) + 2].mean()
            top = top - (slope + 0.3) * np.arange(9)
            at = int(np.argmax(top))
            assert at == np.argmax(mirrored) + 1
            ends = turning_points.TurningPoints(
                np.array([1, at, 7]), np.array([True, False, True]), top, 1, 0.0, 99.0
            )
            place = peak_refinement.vertices(np.arange(9.0), ends).time[1]
            assert (place == at) == corner


@pytest.mark.parametrize("steps", [12.3, 30.4, 60.7])
@pytest.mark.parametrize("noise", [0.0, 0.1])
def test_a_top_within_a_step_of_a_converter_lies_where_the_fall_begins(steps, noise):
    """A sawtooth is level there for 5 to 25 samples, and falls within 8."""
    time = np.arange(6000) * 1e-3
    rise, fall = time % 1.003 / 0.995, (1.003 - time % 1.003) / 0.008
    white = noise * np.random.default_rng(1).standard_normal(len(time))
    values = np.rint(steps * np.minimum(rise, fall) + white)
    found = peak_refinement.vertices(time, turning_points.turning_points(values))
    peaks, troughs = found.time[::2], found.time[1::2]
    assert peaks == pytest.approx(0.995 + 1.003 * np.arange(len(peaks)), abs=1.1e-3)
    assert troughs == pytest.approx(1.003 * np.arange(1, len(troughs) + 1), abs=1.1e-3)


def test_a_smooth_top_lies_in_the_middle_of_a_step():
    time = np.arange(6000) * 1e-3
    values = np.rint(15.3 * np.sin(2.0 * np.pi * time))
    found = peak_refinement.vertices(time, turning_points.turning_points(values))
    assert found.time == pytest.approx(0.25 + 0.5 * np.arange(len(found.time)), abs=1.5e-3)


def test_a_top_within_a_step_is_divided_as_the_next_step_beneath():
    """Random sawtooths, straight or rounded, whose falls last a tenth or a fifth of a period."""
    random = np.random.default_rng(1)
    off = {"straight": [], "rounded": []}
    for number in range(120):
        samples, fall = int(random.integers(100, 800)), (0.1, 0.2)[number % 2]
        time = np.arange(20 * samples) / samples + random.uniform()
        share = time % 1.0
        rise = np.clip(share / (1.0 - fall), 0.0, 1.0)
        shape = ("straight", "rounded")[number // 2 % 2]
        rise = rise if shape == "straight" else np.sin(0.5 * np.pi * rise)
        slip = 0.5 + 0.5 * np.cos(np.pi * (share - 1.0 + fall) / fall)
        values = np.where(share < 1.0 - fall, rise, slip) * random.uniform(6.0, 60.0)
        points = turning_points.turning_points(np.rint(values + random.uniform()))
        peaks = peak_refinement.vertices(time, points).time[~points.trough]
        off[shape].append(np.mean(((peaks + fall + 0.5) % 1.0 - 0.5) ** 2))
    # of the period, root mean square: in the middle of the level it is off by ten times as much
    assert np.mean(off["straight"]) ** 0.5 < 0.007
    assert np.mean(off["rounded"]) ** 0.5 < 0.007


def test_the_top_of_a_parabola_within_its_piece():
    slope, bend = (
        np.array([1.0, 1.0, -1.0, 3.0, 0.0, -2.0, -1e-10, 1e-8]),
        np.array([-1.0, 1.0, 1.0, -1.0, 1.0, 0.0, 1.0, 1.0]),
    )
    wanted = [0.5, 1.0, -1.0, 1.0, 0.0, -1.0, 0.0, 1.0]  # a slope of rounding is none
    assert peak_refinement._top(slope, bend).tolist() == wanted


def test_second_derivatives_of_uneven_samples():
    time = np.array([0.0, 0.1, 0.3, 0.4, 0.8])
    values = 3.0 * time**2 - time
    assert peak_refinement._bend(time, values, np.array([1, 2, 3])) == pytest.approx([6.0] * 3)
    cubic = time**3  # its second divided difference is twice the sum of the three times
    wanted = 2.0 * (time[:-2] + time[1:-1] + time[2:])
    assert peak_refinement._bend(time, cubic, np.array([1, 2, 3])) == pytest.approx(wanted)


@pytest.mark.parametrize("degree", [0, 1, 2])
def test_fits_of_pieces(degree):
    """Least squares, piece by piece, as NumPy's."""
    time, values = np.linspace(2.0, 3.0, 40), np.array(inside(1, *[(-1.0, 1.0)] * 40)[0])
    first, last = np.array([0, 5, 20]), np.array([9, 12, 39])
    fits = fit_pieces(time, values, first, last, degree)
    for i, (a, b) in enumerate(zip(first, last, strict=True)):
        x = (time[a : b + 1] - 0.5 * (time[a] + time[b])) / (0.5 * (time[b] - time[a]))
        wanted = np.polynomial.polynomial.polyfit(x, values[a : b + 1], degree)
        assert fits.coefficients[i] == pytest.approx(wanted, rel=1e-9, abs=1e-12)
        assert fits.at(np.full(3, 0.3))[i] == pytest.approx(np.polyval(wanted[::-1], 0.3))
        assert (fits.middle[i], fits.half[i]) == pytest.approx(
            (0.5 * (time[a] + time[b]), 0.5 * (time[b] - time[a]))
        )


@pytest.mark.parametrize("last", range(-2, 3))
def test_a_signal_turns_wherever_it_ends(last):
    """Its first value counts, whatever the last one is."""
    values = np.array([0, 5, last])
    assert reversals.extrema(values).tolist() == turns_of(values) == [0, 1, 2]
    assert reversals.extrema(-values).tolist() == [0, 1, 2]


@pytest.mark.parametrize(("heights", "step"), [([], 1.0), ([1.0, 2.0], 1.0), ([5.0], 0.0)])
def test_without_heights_above_two_steps_there_is_no_gap(heights, step):
    assert turning_points.widest_gap(heights, step, 3.0) == (0.0, 0.0, 0.0)


def test_turning_points_stay_in_the_order_of_time():
    """Two in succession, a sample apart, changed places: a cycle had the period zero."""
    seen = 0
    for seed in range(60):
        rng = np.random.default_rng(seed)
        size, period = 2000, rng.uniform(4.0, 12.0)
        wave = rng.uniform(0.5, 1.5) * np.sin(2.0 * np.pi * np.arange(size) / period)
        values = np.rint(wave + rng.uniform(0.0, 0.3) * rng.standard_normal(size))
        values -= uniform_mean(values, int(rng.integers(3, 30)))
        points = turning_points.turning_points(values)
        if len(points.index):
            found = peak_refinement.vertices(np.arange(float(size)), points)
            assert np.diff(found.time).min() > 0.0
            seen += 1
    assert seen > 30


def test_a_top_that_is_put_back_may_change_places_with_the_next_one():
    """The first two are put where they are sampled, and then the third one, too."""
    rows = np.array([2, 4, 6]), np.array([True, False, True]), np.arange(9.0)
    points = turning_points.TurningPoints(*rows, width=1, noise=0.0, clearness=1.0)
    found = peak_refinement.Vertices(np.array([3.45, 3.4, 3.5]), np.full(3, 7.0))
    ordered = peak_refinement._in_order(np.arange(9.0), points, found)
    np.testing.assert_array_equal(ordered.time, [2.0, 4.0, 6.0])
    np.testing.assert_array_equal(ordered.value, [2.0, 4.0, 6.0])


def test_all_that_look_at_a_force_share_it_without_spikes():
    force = np.sin(np.arange(50.0))
    force[20] += 9.0
    force.setflags(write=False)
    found = turning_points.without_spikes(force)
    assert found is turning_points.without_spikes(force)
    assert not found.flags.writeable
    assert found.tolist() == turning_points.limit_spikes(force).tolist() != force.tolist()
