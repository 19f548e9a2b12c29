"""Steps along the patches of the return map."""

import numpy as np
import pytest
from tests.entry import plain
from tests.unit.solver.multiscale.test_construction import problem_of
from tests.unit.solver.multiscale.test_interpolant import cycle, known_of

from stiction.solver.multiscale import section, walk
from stiction.solver.multiscale.return_map import NODES, Stick

PROBLEM = problem_of("soft")


def follow(*arguments, times=(), samples=None):
    """Follow the patches, with samples at some times."""
    times = np.array(times, dtype=float)
    samples = np.full((len(times), 7), np.nan) if samples is None else samples
    return plain(walk.follow_patches)(PROBLEM, *arguments, times, samples, 0)


@pytest.mark.parametrize("until", [1e9, 7.0])
@pytest.mark.parametrize("room", [100, 5])
def test_the_map_is_followed_from_stick_to_stick(until, room):
    """Each cycle begins where the last one has ended; to a time, a patch's end, or the room."""
    known, sticks = known_of(0.3, 0.8)[0], np.zeros((room, 2))
    stick, last = Stick(1.0, 1.5, 0.31), cycle(-1.0)
    found = follow(known, stick, last, sticks, 2, until)
    rows, (start, end, theta) = [], stick
    while 0.3 <= theta <= 1.3 and 2 + len(rows) < room:
        following = cycle((theta - (0.3 if theta <= 0.8 else 0.8)) * 4.0 - 1.0)
        if end + following.time >= until:
            break
        rows.append((start, end))
        last = following
        start, end = end + last.time - last.held, end + last.time
        theta += last.turn
    assert len(rows) > 1
    assert found[0] == pytest.approx((start, end, theta), rel=1e-12)
    assert found[1] == pytest.approx(last, rel=1e-12)
    assert found[2] == 2 + len(rows)
    assert found[3] == pytest.approx(np.diff(rows).sum(), rel=1e-12)
    assert sticks[2 : 2 + len(rows)] == pytest.approx(np.array(rows), rel=1e-12)
    assert not sticks[:2].any()
    assert not sticks[2 + len(rows) :].any()


def test_where_the_polynomials_have_no_stick_the_map_ends():
    """The time held must be more than nothing, and less than that of the cycle."""
    known, _ = known_of(0.3)
    stick, last, sticks = Stick(1.0, 1.5, 0.31), cycle(-1.0), np.zeros((9, 2))
    for square in (-1.0, 100.0):
        known.coefficients[0, :, 2] = [square, *[0.0] * (NODES - 1)]
        found = follow(known, stick, last, sticks, 0, 1e9)
        assert found == (stick, last, 0, 0.0, 0)


def test_samples_of_sticks_are_written_and_others_end_the_walk():
    """Until there is one in a slip whose motion is not known."""
    known, sticks = known_of(0.3, 0.8)[0], np.zeros((50, 2))
    known = known._replace(inside=known.inside._replace(shapes=np.zeros((2, 4), dtype=np.int64)))
    stick, last = Stick(1.0, 1.5, 0.31), cycle(-1.0)
    first = cycle((0.31 - 0.3) * 4.0 - 1.0)
    landing = 1.5 + first.time - first.held
    times = np.array([1.2, 1.4, 1.5 + 0.5 * (first.time - first.held)])
    samples = np.full((3, 7), np.nan)
    found = follow(known, stick, last, sticks, 0, 1e9, times=times, samples=samples)
    assert (found[0], found[2], found[4]) == (stick, 0, 2)  # nothing is known inside
    assert samples[:2, 6].tolist() == [1.0, 1.0]
    assert np.isnan(samples[2]).all()
    times = [landing + 0.1 * first.held, landing + 0.9 * first.held]
    found = follow(known, stick, last, sticks, 0, 1e9, times=times)
    assert found[4] == 2  # they are in the next stick
    assert found[2] > 1


def test_the_elongation_in_a_stick():
    stick = Stick(1.0, 1.01, 0.7)
    end, v = np.array(plain(section.elongation_held)(PROBLEM, 0.7)), PROBLEM.drive.velocity
    e = np.array([PROBLEM.system.cos_phi, PROBLEM.system.sin_phi])
    assert plain(walk.elongation_at_landing)(PROBLEM, stick) == pytest.approx(end - 0.01 * v * e)
    times, samples = np.array([0.5, 1.0, 1.004, 1.01, 1.02]), np.full((5, 7), np.nan)
    assert plain(walk.sample_known_stick)(PROBLEM, stick, times, samples, 1) == 4
    assert samples[2, :2] == pytest.approx(end - 0.006 * v * e)
    assert samples[1:4, 6].tolist() == [1.0] * 3
    assert np.isnan(samples[[0, 4]]).all()
    for k in (4, 5):  # behind the stick, and behind all samples
        assert plain(walk.sample_known_stick)(PROBLEM, stick, times, samples, k) == k
