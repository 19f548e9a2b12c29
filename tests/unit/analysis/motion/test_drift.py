"""Friction beside a zero that drifts: the further error is by how much each is off."""

import numpy as np
import pytest

import stiction as st
from stiction.analysis.motion.changes.shared import LASTS, _shapes, _shifts, shared_change
from stiction.analysis.motion.cycle_columns import COLUMNS, CycleTable
from stiction.analysis.motion.cycles import swings
from stiction.analysis.motion.doubts.drift import doubt_drift
from stiction.analysis.motion.drift import Drift, find_drift, is_shown, with_drift
from stiction.analysis.motion.friction import Friction, Measured
from stiction.analysis.motion.regime.kinds import (
    HARMONIC,
    SETTLING,
    STEADY,
    STICK_SLIP,
    TRANSITIONAL,
)
from stiction.analysis.signals.correlated_noise import standard_error

RATE, BEGIN = -0.01, 100.0  # N/s, s
END = BEGIN + 50.0
KNOWN = Drift(RATE, 1e-4, 0.0, BEGIN, stands_out=False, sure=True, end=END)
PEAKS, TROUGHS = np.array([20.0, 27.0, 34.0, 41.0]), np.array([24.0, 31.0, 38.0, 45.0])


def exact(force: float) -> Measured:
    return Measured(force, 0.0, 0.0)


def further(record: st.Record, peaks: int, drift: Drift = KNOWN) -> tuple[float, float, float]:
    """Return the errors that a drift adds to break-away (at 5 N), static and kinetic friction."""
    columns = dict.fromkeys(COLUMNS, PEAKS) | {"peak_time": PEAKS, "trough_time": TROUGHS}
    cycles = CycleTable({name: BEGIN + each[:peaks] for name, each in columns.items()}, 0.0)
    found = with_drift(Friction(exact(5.0), exact(6.0), exact(4.0), {}), record, cycles, drift)
    return tuple(each.error for each in (found.break_away, found.static, found.kinetic))


TIME = BEGIN + np.arange(0.0, 51.0)
LOADED = st.Record(time=TIME, force=np.minimum(TIME - BEGIN, 5.5))  # at 5 N after 5 s


def test_each_is_off_by_what_the_zero_drifts_until_its_time():
    assert further(LOADED, 4) == pytest.approx((0.05, 0.305, 0.325))
    unsure = KNOWN._replace(sure=False, stands_out=True)
    assert further(LOADED, 4, unsure) == (0.0, 0.0, 0.0)
    likely = unsure._replace(likely=2.0 * RATE)
    assert further(LOADED, 4, likely) == pytest.approx((0.1, 0.61, 0.65))
    assert likely.possible == 0.02


def table(peaks, troughs):
    """Return cycles with these peaks and troughs."""
    count = len(peaks)
    columns = dict.fromkeys(COLUMNS, np.zeros(count)) | {
        "peak_time": PEAKS[:count], "trough_time": TROUGHS[:count],
        "peak": np.array(peaks), "trough": np.array(troughs),
    }  # fmt: skip
    return CycleTable(columns, 0.0)


def test_peaks_and_troughs_that_change_alike():
    seen = find_drift(LOADED, table([6.0, 5.931, 5.86, 5.789], [4.0, 3.5, 4.2, 3.7]))
    assert not seen.sure
    assert seen.likely == pytest.approx(-0.01, rel=2e-2)  # by the peaks, -0.07 N in each 7 s
    # two alone, of which the mean slope has one degree of freedom: t at 97.5 % is 12.7
    assert find_drift(LOADED, table([6.0, 6.07], [4.0, 4.071])).likely == pytest.approx(
        0.01, rel=1e-2
    )
    assert find_drift(LOADED, table([6.0, 6.07], [4.0, 4.06])).likely == 0.0


def test_peaks_that_change_otherwise_than_troughs_show_no_drift():
    falling = [4.0, 3.931, 3.86, 3.789]
    assert find_drift(LOADED, table([6.0, 6.071, 6.14, 6.211], falling)).likely == 0.0


ERROR = 1e-3  # N/s


def forces_about_a_line(level, rate):
    """Return four forces, 7 s apart, about a line whose rate has the standard error `ERROR`."""
    away = PEAKS - PEAKS.mean()
    few = 0.5 * 4.302653  # t at 97.5 % of two degrees of freedom, over 2
    deviation = ERROR / few * ((away @ away) / (4.0 / 2.0)) ** 0.5
    return level + rate * away + deviation * np.array([1.0, -1.0, -1.0, 1.0])


@pytest.mark.parametrize(
    ("peaks", "troughs", "likely"),
    [
        (-2.9, [4.0, 3.5, 4.2, 3.7], 0.0),  # of troughs that scatter nothing is known
        (-3.1, [4.0, 3.5, 4.2, 3.7], -3.1),
        (5.0, 1.2, 5.0),  # 3.8 errors apart: each has one
        (5.0, 0.6, 0.0),  # 4.4 apart: they change otherwise
        (-4.5, -3.2, -4.5),  # the largest of several
    ],
)
def test_a_drift_is_likely_from_three_standard_errors_on(peaks, troughs, likely):
    ends = troughs if isinstance(troughs, list) else forces_about_a_line(4.0, troughs * ERROR)
    seen = find_drift(LOADED, table(forces_about_a_line(6.0, peaks * ERROR), ends))
    assert not seen.sure
    assert seen.likely == pytest.approx(likely * ERROR)


def test_a_sure_drift_is_not_likely_as_well():
    seen = find_drift(LOADED, table([6.0, 5.93, 5.86, 5.79], [4.0, 3.93, 3.86, 3.79001]))
    assert seen.sure
    assert (seen.likely, seen.possible) == (0.0, pytest.approx(0.01, rel=1e-3))


def test_a_mean_without_cycles_is_off_by_the_drift_until_its_middle():
    late = KNOWN._replace(start=BEGIN + 30.0)
    assert further(LOADED, 0, late) == pytest.approx((0.05, 0.4, 0.4))
    record = LOADED.model_copy(update={"force": np.full(len(TIME), 4.0)})
    slid = with_drift(Friction(None, None, exact(4.0), {}), record, swings(record).lasting, late)
    assert slid.kinetic.error == pytest.approx(0.4)
    assert further(LOADED, 0, late._replace(end=BEGIN + 40.0))[2] == pytest.approx(0.35)
    assert slid.break_away is None


@pytest.mark.parametrize("kind", [STICK_SLIP, TRANSITIONAL, HARMONIC, STEADY])
def test_a_steady_motion_shows_whether_its_force_drifts(kind):
    assert is_shown(KNOWN, kind)
    assert not is_shown(KNOWN._replace(error=np.nan), kind)
    assert not is_shown(KNOWN, SETTLING)


@pytest.mark.parametrize(("kind", "told"), [(STEADY, True), (SETTLING, False)])
def test_a_drift_is_told_of_a_motion_that_shows_it(kind, told):
    for start, where in ((BEGIN, "in all"), (BEGIN + 20.0, "from 120 s to 150 s")):
        drift = KNOWN._replace(stands_out=True, change=-0.5, start=start)
        said = [*doubt_drift(LOADED, drift, kind, table([], []))]
        first = ["The force drifts by -10 mN/s", f" -500 mN {where}"]
        assert [each.split(",")[:2] for each in said] == [first] * told


@pytest.mark.parametrize(("share", "told"), [(0.95, False), (1.05, True)])
def test_a_drift_that_may_be_by_chance_is_told_from_2_percent_of_the_peaks_on(share, told):
    lasts = TIME[-1] - TIME[0]
    drift = KNOWN._replace(sure=False, likely=-share * 0.02 * 6.0 / lasts)
    cycles = table([5.9, 6.1], [4.0, 4.0])
    assert bool([*doubt_drift(LOADED, drift, STICK_SLIP, cycles)]) == told
    assert not [*doubt_drift(LOADED, drift, STICK_SLIP, table([], []))]


def test_a_force_at_several_levels_shows_no_drift():
    time = np.arange(0.0, 30.0, 0.01)
    noise = 5e-3 * np.random.default_rng(1).normal(size=len(time))
    for force, known in ((np.repeat([1.0, 1.4, 1.8], 1000), False), (1.0 + 0.01 * time, True)):
        record = st.Record(time=time, force=force + noise)
        drift = find_drift(record, swings(record).lasting)
        assert np.isfinite(drift.error) == drift.sure == known


def seen_of(force):
    """Return the drift of a force without cycles, over a minute, in little noise."""
    time = np.linspace(0.0, 60.0, 3000)
    noise = 5e-3 * np.random.default_rng(2).normal(size=len(time))
    record = st.Record(time=time, force=force(time) + noise)
    return find_drift(record, swings(record).lasting)


@pytest.mark.parametrize("ends", ["unloads", "turns"])
def test_a_drift_of_sliding_is_seen_before_the_drive_turns_or_unloads(ends):
    """What ended the sliding hid each drift: the error was hundreds of times as large."""
    last = {"unloads": 0.0, "turns": -2.0}[ends]
    drift = seen_of(lambda t: np.interp(t, [48.0, 50.0], [2.0, last]) + 2e-3 * t)
    assert drift.sure
    assert drift.error < 2e-4
    assert (drift.start, drift.end) == pytest.approx((24.0, 48.0), abs=1.0)
    assert drift.change == pytest.approx(24.0 * drift.rate, rel=0.04)
    assert abs(drift.rate - 2e-3) < 2.0 * drift.error


def test_a_force_that_begins_to_be_unloaded_shows_no_drift():
    """`detrend` took half a newton off it."""
    drift = seen_of(lambda t: np.interp(t, [54.0, 75.0], [2.0, 0.0]))
    assert np.isnan(drift.error)
    assert drift.possible == 0.0
    time = np.linspace(0.0, 60.0, 3000)
    record = st.Record(time=time, force=np.interp(time, [54.0, 75.0], [2.0, 0.0]))
    assert np.isnan(find_drift(record, swings(record).lasting).error)
    assert np.array_equal(st.analysis.detrend(record).force, record.force)


@pytest.mark.parametrize(
    ("errors", "sure", "likely"), [(2.9, False, False), (3.1, False, True), (4.1, True, False)]
)
def test_a_drift_of_sliding_is_likely_before_it_is_sure(errors, sure, likely):
    chance = seen_of(lambda t: 2.0 + 0.0 * t)
    rate = errors * chance.error
    drift = seen_of(lambda t: 2.0 + (rate - chance.rate) * t)
    assert drift.sure == sure
    assert drift.likely == pytest.approx(likely * rate, rel=1e-6)
    assert drift.possible == pytest.approx((sure or likely) * rate, rel=1e-6)


SHAPES = {
    "settles": lambda way: 1.0 - np.exp(-way / 0.2),
    "jumps": lambda way: 1.0 * (way > 0.3),
    "comes back": lambda way: np.sin(np.pi * way),
}
SCATTER = 0.05  # N


def slips(number, shape, count=30, size=0.3):
    """Return peaks about 6 N, troughs about 5 N, and what a zero of that shape adds to each (N)."""
    random = np.random.default_rng([7, number])
    at = np.arange(1.0, count + 1.0)
    zero = size * shape(at / count)
    peak, trough = ([6.0], [5.0]) + SCATTER * random.normal(size=(2, count))
    return at, peak + zero, trough + zero, zero


@pytest.mark.parametrize("shape", SHAPES.values(), ids=SHAPES.keys())
def test_errors_hold_a_zero_that_does_not_change_steadily(shape):
    held = []
    for number in range(50):
        at, peak, trough, _ = slips(number, shape)
        error = np.hypot(shared_change(0.0, at, peak, trough), standard_error(peak))
        held.append(abs((peak - 6.0).mean()) < 2.0 * error)
    assert np.mean(held) > 0.9  # of the records, whose mean is off by 0.1 to 0.25 N


def test_peaks_and_troughs_that_scatter_by_themselves_share_hardly_a_change():
    without = [shared_change(0.0, *slips(number, np.zeros_like)[:3]) for number in range(50)]
    error = SCATTER / 30.0**0.5  # of the mean of the peaks
    assert np.median(without) < error
    assert np.mean(np.array(without) > 2.0 * error) < 0.1


def test_friction_that_changes_the_drop_alone_is_not_shared():
    # static friction settles, and the mass swings about a constant kinetic one
    shares = []
    for number in range(20):
        at, peak, trough, grown = slips(number, SHAPES["settles"])
        shares.append(shared_change(0.0, at, peak, trough - 2.0 * grown))
    assert np.median(shares) < 0.2 * grown.mean()
    assert shared_change(0.0, at[:3], peak[:3], trough[:3]) == 0.0


def test_shift_is_that_of_the_normal_distribution():
    """The twin: change and noise as one covariance each, and a level by least squares."""
    at, peak, *_ = slips(1, SHAPES["settles"], count=7)
    shapes, sizes = _shapes(at / at[-1]), np.array([0.0, 0.7, 5.0])
    square, likely = _shifts(peak, shapes, sizes)
    one, mean, twin = np.ones(7), np.full(7, 1.0 / 7.0), np.zeros((2, *square.shape))
    for index in np.ndindex(square.shape):
        noise = LASTS[index[0]] ** np.abs(np.subtract.outer(np.arange(7), np.arange(7)))
        change = sizes[index[2]] ** 2 * shapes[index[1]]
        inverse = np.linalg.inv(noise + change)
        total = one @ inverse @ one
        left = peak - one @ inverse @ peak / total
        gain = mean @ change @ inverse
        variance = mean @ change @ mean - gain @ change @ mean + (gain @ one) ** 2 / total
        chi = left @ inverse @ left
        twin[0][index] = (gain @ left) ** 2 + variance * chi / 6.0
        logs = np.linalg.slogdet(noise + change)[1] + np.log(total) + 6.0 * np.log(chi)
        twin[1][index] = -0.5 * logs
    assert square == pytest.approx(twin[0], rel=1e-6, abs=1e-12)
    assert likely == pytest.approx(twin[1], rel=1e-6)


def test_friction_has_the_error_of_a_zero_that_settles():
    shared = KNOWN._replace(sure=False, shared=0.2)
    assert further(LOADED, 4, shared) == pytest.approx((0.0, 0.2, 0.2))
    assert further(LOADED, 4, shared._replace(sure=True)) == pytest.approx((0.05, 0.305, 0.325))
    at, peak, trough, zero = slips(1, SHAPES["settles"])
    time = np.linspace(0.0, 30.7, 3071)
    corners = np.stack([at - 0.1, at], axis=1).ravel(), np.stack([peak, trough], axis=1).ravel()
    noise = 0.005 * np.random.default_rng(3).normal(size=len(time))
    found = st.analyse(st.Record(time=time, force=np.interp(time, *corners) + noise))
    off = found.friction.static.force - (peak - zero).mean()
    assert 0.15 < off < 2.0 * found.friction.static.error
    assert any(each.startswith("Peaks and troughs change alike") for each in found.warnings)


@pytest.mark.parametrize(("share", "told"), [(0.95, False), (1.05, True)])
def test_a_change_that_is_not_steady_is_told_from_1_percent_of_the_peaks_on(share, told):
    drift = KNOWN._replace(sure=False, shared=share * 0.01 * 6.0)
    [*said] = doubt_drift(LOADED, drift, STICK_SLIP, table([6.0, 6.01, 5.99, 6.0], [4.0] * 4))
    assert ["not steadily" in each for each in said] == [True] * told
    scattered = table([5.5, 6.5, 5.5, 6.5], [4.0] * 4)
    assert not [*doubt_drift(LOADED, drift, STICK_SLIP, scattered)]


def sliding(zero: np.ndarray, seed: int) -> st.Record:
    """Return sliding at 2 N after a loading, behind a zero that changes (N, 1000 samples)."""
    time = np.linspace(0.0, 10.0, len(zero))
    noise = 5e-3 * np.random.default_rng([21, seed]).normal(size=len(time))
    force = np.minimum(4.0 * time, 2.0) + zero + noise
    return st.Record(time=time, force=force, normal_load=10.0)


@pytest.mark.parametrize("lasts", [3.0, 5.0])
@pytest.mark.parametrize("size", [-0.3, -0.1])
def test_kinetic_friction_allows_for_a_zero_that_settles_while_the_mass_slides(size, lasts):
    """It was off by up to 90 times its error. A zero that settles before leaves no trace."""
    time = np.linspace(0.0, 10.0, 1000)
    found = st.analyse(sliding(-size * np.expm1(-time / lasts), round(lasts)))
    kinetic = found.friction.kinetic
    assert abs(kinetic.force - 2.0) < 2.0 * kinetic.error
    assert any("errors of friction allow for a zero" in each for each in found.warnings)


def test_a_zero_that_does_not_settle_adds_no_error():
    """Of a steady force, and of one that falls soon after its break-away."""
    for seed in range(10):
        time = np.linspace(0.0, 10.0, 1000)
        for friction in (0.0, 0.4 * np.exp(-((np.maximum(time - 0.5, 0.0) / 0.3) ** 2))):
            known = {"zero": 0.0}  # its first reading, 0.4 N, might be the zero otherwise
            record = sliding(np.broadcast_to(friction, time.shape), seed).model_copy(update=known)
            found = st.analyse(record)
            kinetic = found.friction.kinetic
            assert kinetic is not None
            assert kinetic.error < 2e-3  # N; that of the noise is 2e-4 N
            record = sliding(np.broadcast_to(friction, time.shape), seed)
            assert find_drift(record, swings(record).lasting).shared == 0.0


@pytest.mark.parametrize("kind", [STEADY, SETTLING])
@pytest.mark.parametrize(("share", "told"), [(0.95, False), (1.05, True)])
def test_a_force_that_settles_is_told_from_2_percent_of_its_largest_on(kind, share, told):
    drift = KNOWN._replace(sure=False, shared=share * 0.02 * np.abs(LOADED.force).max())
    said = [*doubt_drift(LOADED, drift, kind, table([], []))]
    assert ["settles by" in each for each in said] == [True] * told
    if kind == STEADY:  # a steady drift is told instead
        (said,) = doubt_drift(LOADED, drift._replace(stands_out=True), kind, table([], []))
        assert "drifts by" in said


@pytest.mark.parametrize("number", range(8))
def test_friction_that_falls_as_a_drive_speeds_up_is_no_zero_that_drifts(number):
    """A ramp to 5 mm/s was told to state zero_drift, and asked whether its drive paused."""
    random = np.random.default_rng([51, number])
    time = np.arange(0.0, 20.0, 1e-3)
    slow, fast = 1e-4 * random.uniform(0.5, 2.0), 1e-3 * random.uniform(2.0, 6.0)
    stage = slow * time + 0.5 * (fast - slow) * time**2 / time[-1]
    peak = 6.0 - random.uniform(0.2, 0.5) * time / time[-1]
    rise = 3.0 * ((2e4 * stage / 3.0) % 1.0)
    force = peak - 3.0 + rise + 0.02 * random.normal(size=len(time))
    given = {"normal_load": 20.0, "stiffness": 2e4}
    followed = st.Record(time=time, force=force, drive_position=stage, **given)
    said = " ".join(st.analyse(followed).warnings)
    assert "may change with the speed of the drive, which goes at" in said
    assert "zero_drift" not in said
    assert "if the drive paused" not in said
    assert "zero_drift" in " ".join(st.analyse(st.Record(time=time, force=force, **given)).warnings)
