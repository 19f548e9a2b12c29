"""Uneven samples get their spectrum: gaps, jitter, equal times, a first interval of its own."""

import numpy as np
import pytest
from tests.drawn import inside

import stiction as st
from stiction.analysis.measured_line import strongest_line
from stiction.analysis.signals.even_grid import even_grid, why_not
from stiction.analysis.signals.hum import narrow_lines
from stiction.analysis.signals.straight_line import line

N, STEP = 10_000, 1e-4


def even_times(random):
    return STEP * np.arange(N)


def gaps(random):
    kept = np.ones(N, bool)
    for at in random.integers(5, N - 10, N // 80):  # 5 % of all
        kept[at : at + random.integers(1, 8)] = False
    return even_times(random)[kept]


def jitter(random):
    return np.sort(even_times(random) + 0.3 * STEP * random.normal(size=N))


def late(random):
    return np.append(-37.3 * STEP, even_times(random)[1:])


def repeat(random):
    return np.repeat(even_times(random), 1 + (random.random(N) < 1e-3))


SAMPLED = pytest.mark.parametrize("sampled", [gaps, jitter, late, repeat])


def record(sampled, seed):
    """Return a record with a line, and the line's frequency and amplitude."""
    random = np.random.default_rng([7, seed])
    time = sampled(random)
    frequency, amplitude = random.uniform(300, 2500), 10 ** random.uniform(-1.5, -0.5)
    line = amplitude * np.sin(2 * np.pi * frequency * time)
    slow = 2.0 + 0.5 * np.sin(7.0 * time)
    force = slow + line + 0.05 * random.normal(size=len(time))
    return st.Record(time=time, force=force), frequency, line


@SAMPLED
@pytest.mark.parametrize("seed", range(6))
def test_the_frequency_of_a_line_lies_within_its_error(sampled, seed):
    uneven, frequency, _ = record(sampled, seed)
    found = strongest_line(uneven, 100.0)
    seen = np.isfinite(found["frequency"].values)
    off = (found["frequency"].values - frequency)[seen] / found["frequency_error"].values[seen]
    assert seen.mean() > 0.9
    assert np.abs(off).max() < 4.0
    assert np.mean(np.abs(off) > 2.0) <= 0.1


@SAMPLED
def test_a_line_is_taken_off_at_the_times_of_the_record(sampled):
    uneven, frequency, line = record(sampled, 1)
    (found, *_) = narrow_lines(even_grid(uneven.time), uneven.force)
    assert found.frequency == pytest.approx(frequency, rel=1e-4)
    left = np.std(found.values - line) / np.std(line)
    # straight lines make it smaller by sinc^2, where all samples are interpolated
    assert left < 0.05 + 1.0 - np.sinc(frequency * STEP) ** 2


@pytest.mark.parametrize(
    ("sampled", "said"),
    [
        (gaps, "samples are missing, in"),
        (jitter, "lie more than a tenth of an interval off even times"),
        (late, "37 of 10037 samples are missing, in a gap of 3.83 ms"),
        (repeat, "samples have the same time as the one before"),
        (even_times, None),
    ],
)
def test_words_say_how_uneven_samples_are(sampled, said):
    told = " ".join(st.analyse(record(sampled, 2)[0]).warnings)
    assert (said is None) == ("straight lines" not in told and "same time" not in told)
    assert said is None or said in told


@pytest.mark.parametrize("ratio", [2.3, 5.0, 7.0])
def test_a_rate_that_changes_is_not_told_to_be_chance(ratio):
    """Slow at first and quick later, as loggers do: "the samples stand at random times"."""
    time = np.r_[np.arange(0.0, 20.0, 0.01 * ratio), np.arange(20.0, 30.0, 0.01)]
    random = np.random.default_rng(3)
    force = 0.1 * (time % 2.0) + 1e-3 * random.normal(size=len(time))
    told = " ".join(st.analyse(st.Record(time=time, force=force)).warnings)
    assert f"changes within the record, between {100.0 / ratio:.4g} Hz and 100 Hz: for" in told
    scattered = np.sort(random.uniform(0.0, 30.0, len(time)))
    told = " ".join(st.analyse(st.Record(time=scattered, force=force)).warnings)
    assert "The samples stand at random times: for" in told


def test_samples_in_bursts_get_none_and_are_told_why():
    time = np.concatenate([STEP * (np.arange(N // 10) + 3 * burst * N // 10) for burst in range(5)])
    grid = even_grid(time)
    assert grid is not None
    assert "of the time lies in gaps between samples" in why_not(grid)
    assert narrow_lines(even_grid(time), np.sin(300.0 * time)) == []


@pytest.mark.parametrize("seed", range(4))
def test_a_line_is_taken_off_from_samples_at_random_times(seed):
    """Straight lines between samples weaken it; it is fitted to the samples themselves."""
    random = np.random.default_rng([9, seed])
    time = np.sort(random.uniform(0.0, 4.0, N))
    grid = even_grid(time)
    assert grid is not None
    assert grid.coarse
    assert not grid.exact
    frequency = random.uniform(50.0, 120.0)  # of 3.5 to 8 times on the grid a period
    line = 0.3 * np.sin(2 * np.pi * frequency * time + 1.0)
    force = np.minimum(time, 1.0) + line + 0.01 * random.normal(size=N)
    (found, *_) = narrow_lines(even_grid(time), force)
    assert found.frequency == pytest.approx(frequency, rel=1e-4)
    assert np.std(found.values - line) < 0.1 * np.std(line)


def test_a_window_within_a_gap_shows_no_line():
    time = even_times(None)
    kept = (time < 0.5) | (time > 0.56)
    force = np.sin(2 * np.pi * 1000.0 * time)[kept]
    found = strongest_line(st.Record(time=time[kept], force=force), 500.0, width=0.02)
    inside = (found["time"].values > 0.515) & (found["time"].values < 0.545)
    assert np.isnan(found["frequency"].values[inside]).all()
    assert np.isfinite(found["frequency"].values[~inside]).mean() > 0.8


@pytest.mark.parametrize("seed", range(100))
def test_times_that_are_rounded_belong_to_an_even_clock(seed):
    """300 Hz in milliseconds: intervals of 3, 3 and 4 ms, whose median is no step."""
    random = np.random.default_rng(seed)
    rate = 10.0 ** random.uniform(0.0, 4.0)
    resolution = random.uniform(0.01, 0.75) / rate
    number = np.arange(random.integers(100, 3000))
    time = resolution * np.round((number / rate + random.uniform(-5.0, 5.0)) / resolution)
    grid = even_grid(time)
    assert grid.size == len(time)
    # a line through errors of half the resolution at most
    assert abs(grid.step * rate - 1.0) < 2.0 * resolution * rate / len(time)


@pytest.mark.parametrize("seed", range(100))
def test_a_missing_sample_is_seen_wherever_it_is(seed):
    random = np.random.default_rng(seed)
    size = int(random.integers(100, 3000))
    left_out = int(random.integers(1, size - 1))
    grid = even_grid(np.delete(np.arange(size) / 300.0, left_out))
    assert grid.size == size
    assert np.flatnonzero(grid.missing).tolist() == [left_out]


@pytest.mark.parametrize(("step", "jitter"), inside(12, (1e-4, 1.0), (0.0, 3.0)))
def test_the_grid_is_the_line_of_least_squares_through_the_times(step, jitter):
    number = np.arange(40_000.0)
    time = np.sort(step * (number + jitter * np.sin(number**2))) + 7.0
    slope, start = np.polyfit(number, time, 1)
    found = line(number, time)
    assert (found.slope, found.offset) == pytest.approx((slope, start), rel=1e-12)


def test_gaps_last_for_one_step_where_parts_are_joined():
    time = 5.0 + 0.1 * np.delete(np.arange(100.0), [*range(20, 45), *range(60, 61)])
    grid = even_grid(time)
    assert grid.has_gaps
    assert np.diff(grid.close_gaps(time)) == pytest.approx(
        np.where(np.diff(time) > 0.15, 0.1, np.diff(time))
    )
    assert grid.close_gaps(time)[0] == time[0]
