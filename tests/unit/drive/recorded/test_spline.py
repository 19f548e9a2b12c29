"""The spline through recorded rows: its values, its travel, its bounds, and its compiled twin."""

import pickle

import numba
import numpy as np
import pytest
from scipy.interpolate import CubicSpline

import stiction as st
from stiction.drive.bounds import drive_bounds, load_bounds, vanishes
from stiction.drive.program import modulate
from stiction.drive.recorded import spline as s
from stiction.drive.signal import Signal
from stiction.drive.steady import VaryingLoad, VaryingVelocity
from stiction.solver import problem
from stiction.text.samples import FrozenColumn

KINDS = ("even", "uneven", "clustered")


def rows_of(kind, rng, count=60):
    """Return times of rows, which begin somewhere."""
    steps = {
        "even": np.full(count, 0.01),
        "uneven": rng.uniform(0.002, 0.01, count),
        "clustered": 10.0 ** rng.uniform(-6, -1, count),
    }[kind]
    return rng.uniform(-5, 5) + np.concatenate([[0.0], np.cumsum(steps)])


def table(kind, seed=0, integrated=False, start=3.0):
    """Return a recording of random values, its times in the run and its values."""
    rng = np.random.default_rng(seed)
    time = rows_of(kind, rng)
    values = rng.normal(size=len(time))
    made = s.recording(s.spline(FrozenColumn(time), FrozenColumn(values), integrated), start)
    return made, start + time - time[0], values


def everything(drive, t, dt):
    """What the solver asks."""
    moved = problem.travel(drive, t, dt)
    return (
        moved,
        problem.rate(drive, t),
        problem.rate_change(drive, t),
        problem.rate_curve(drive, t),
    )


@pytest.mark.parametrize("kind", KINDS)
def test_values_and_travel_are_those_of_scipys_spline(kind):
    """(M78): the value, its derivatives and its integral."""
    made, time, values = table(kind)
    curve = CubicSpline(time, values)
    at = np.sort(np.random.default_rng(1).uniform(time[0], time[-1], 500))
    size = np.abs(curve(at)).max()
    assert made.value_at(at) == pytest.approx(curve(at), abs=1e-7 * size)
    assert made.value_at(time) == pytest.approx(values, abs=1e-9 * size)
    slopes, curves = curve(at, 1), curve(at, 2)
    assert made.change_at(at) == pytest.approx(slopes, abs=1e-6 * np.abs(slopes).max())
    assert made.curve_at(at) == pytest.approx(curves, abs=1e-6 * np.abs(curves).max())
    for a, b in ((at[0], at[-1]), (at[3], at[4]), (at[100], at[400])):
        found = made.sum_over(a, b - a)
        assert found == pytest.approx(curve.integrate(a, b), abs=1e-7 * size * (b - a) + 1e-15)


def test_the_travel_of_positions_is_their_difference():
    made, time, x = table("uneven", integrated=True)
    sums = made.sum_over(time[0], time - time[0])
    assert sums == pytest.approx(x - x[0], abs=1e-12)


def test_a_short_travel_has_no_cancellation():
    made, time, _ = table("even")
    t, dt = time[30] + 0.004, 1e-11
    dt = (t + dt) - t
    assert made.sum_over(t, dt) == pytest.approx(made.value_at(t) * dt, rel=1e-6)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(5))
def test_compiled_code_finds_the_same_piece(kind, seed):
    """At rows, beside them and between; `piece_at_one` is compiled in place of `piece_at`."""
    made, time, _ = table(kind, seed)
    beside = np.concatenate([np.nextafter(time, -9), time, np.nextafter(time, 9)])
    at = [*beside, *np.random.default_rng(seed).uniform(time[0], time[-1], 300), time[-1] + 1e-9]
    assert [s.piece_at_one(made, t) for t in at] == s.piece_at(made, np.array(at)).tolist()


def test_compiled_code_returns_the_same_values():
    compiled = numba.njit(everything)
    made, time, _ = table("uneven")
    wave = st.protocols.Modulation(0.3, 7.0)
    rng = np.random.default_rng(5)
    for each in (made, modulate(made, wave), s.silent(Signal(0.0, 2.0, 0.1, 0.5, 3.0))):
        stretch = VaryingVelocity(each, Signal(0.0, 0.0, 0.0, 0.4, 11.0))
        for t in rng.uniform(time[0], time[-1], 20):
            dt = rng.uniform(0, time[-1] - t)
            found = np.array(compiled(stretch, t, dt))
            assert found == pytest.approx(
                np.array(everything(stretch, t, dt)), rel=1e-12, abs=1e-12
            )


@pytest.mark.parametrize("integrated", [False, True], ids=["values", "positions"])
@pytest.mark.parametrize("seed", range(20))
def test_bounds_hold_and_are_attained(seed, integrated):
    """(M79): in each piece, of the value and its first three derivatives."""
    made, _, _ = table(KINDS[seed % 3], seed, integrated, start=0.0)
    for i, length in enumerate(np.diff(made.rows)):
        x = np.linspace(0.0, length, 401)
        a, b, c, d = made.cubics[i]
        value, change = a + x * (b + x * (c + x * d)), b + x * (2 * c + 3 * d * x)
        curve, third = 2 * c + 6 * d * x, np.full_like(x, 6 * d)
        low, high, *others = made.bounds[i]
        size = max(abs(low), abs(high))
        assert low - 1e-12 * size <= value.min() <= low + 1e-4 * size
        assert high - 1e-4 * size <= value.max() <= high + 1e-12 * size
        for bound, found in zip(others, (change, curve, third), strict=True):
            assert bound * (1 - 1e-4) <= np.abs(found).max() <= bound * (1 + 1e-12)


def test_bounds_over_an_interval_are_those_of_its_pieces_and_of_the_wave():
    made, time, _ = table("uneven")
    wave = st.protocols.Modulation(0.3, 7.0)
    with_wave = modulate(made, wave)
    start, end = time[10] + 1e-4, time[20] - 1e-4
    at = np.linspace(start, end, 5001)
    stretch = VaryingVelocity(with_wave, Signal(0.0, 0.0))
    found = [stretch.rate(at), stretch.rate_change(at), stretch.rate_curve(at)]
    bounds = drive_bounds(stretch, start, end)
    for (X, Y), (values, _) in zip(bounds, found, strict=False):
        assert np.abs(values).max() <= X
        assert Y == 0.0
    plain, both = made.bounds_between(start, end), with_wave.bounds_between(start, end)
    omega = 2 * np.pi * 7.0
    assert both == pytest.approx([b + 0.3 * omega**n for n, b in enumerate(plain)])
    assert load_bounds(VaryingLoad(made), start, end) == plain[:3]


def test_the_frequency_of_a_recorded_harmonic_is_told():
    t = np.linspace(0.0, 1.0, 401)
    made = s.spline(FrozenColumn(t), FrozenColumn(5.0 + np.sin(2 * np.pi * 9.0 * t)), False)
    assert s.recording(made, 0.0).fastest() == pytest.approx(2 * np.pi * 9.0, rel=5e-3)


@pytest.mark.parametrize("seed", range(20))
def test_when_a_recorded_load_vanishes(seed):
    made, time, _ = table(KINDS[seed % 2], seed)
    lifted = made._replace(
        cubics=made.cubics + np.array([1.0, 0.0, 0.0, 0.0]),
        bounds=made.bounds + np.array([1.0, 1.0, 0.0, 0.0, 0.0]),
    )
    curve = CubicSpline(time, lifted.value_at(time))
    zeros = [t for t in curve.roots(extrapolate=False) if time[0] < t < time[-1]]
    first = time[0] if lifted.value_at(time[0]) <= 0.0 else min(zeros, default=np.inf)
    assert vanishes(VaryingLoad(lifted), time[0], time[-1]) == pytest.approx(first, abs=1e-7)


def test_a_silent_recording_is_its_wave():
    wave = Signal(0.0, 2.0, -0.3, 0.5, 3.0)
    one, other = VaryingLoad(s.silent(wave)), VaryingLoad(wave)
    assert vanishes(one, 0.0, 20.0) == vanishes(other, 0.0, 20.0)
    assert load_bounds(one, 1.0, 2.0) == load_bounds(other, 1.0, 2.0)


def test_a_column_is_one_value():
    a, b = FrozenColumn([1.0, 2.0]), FrozenColumn(np.array([1.0, 2.0]))
    assert a == b
    assert hash(a) == hash(b)
    assert a != FrozenColumn([1.0, 2.5])
    assert a != [1.0, 2.0]
    assert pickle.loads(pickle.dumps(a)) == a
    assert len(a) == a.size == 2
    copy = np.asarray(a)
    copy[0] = 5.0
    assert a.tolist() == [1.0, 2.0]
    with pytest.raises(ValueError, match="read-only"):
        a.values[0] = 3.0
