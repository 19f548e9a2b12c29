"""Friction beside a zero that drifts: the further error is by how much each is off."""

import numpy as np
import pytest

import stiction as st
from stiction.analysis.motion.cycle_columns import COLUMNS, CycleTable
from stiction.analysis.motion.cycles import swings
from stiction.analysis.motion.doubts.warnings import _drift
from stiction.analysis.motion.drift import Drift, find_drift, is_shown, with_drift
from stiction.analysis.motion.friction import Friction, Measured
from stiction.analysis.motion.regime.kinds import (
    HARMONIC,
    SETTLING,
    STEADY,
    STICK_SLIP,
    TRANSITIONAL,
)

RATE, BEGIN = -0.01, 100.0  # N/s, s
KNOWN = Drift(RATE, 1e-4, 0.0, BEGIN, stands_out=False, sure=True)
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
    assert slid.break_away is None


@pytest.mark.parametrize("kind", [STICK_SLIP, TRANSITIONAL, HARMONIC, STEADY])
def test_a_steady_motion_shows_whether_its_force_drifts(kind):
    assert is_shown(KNOWN, kind)
    assert not is_shown(KNOWN._replace(error=np.nan), kind)
    assert not is_shown(KNOWN, SETTLING)


@pytest.mark.parametrize(("kind", "told"), [(STEADY, True), (SETTLING, False)])
def test_a_drift_is_told_of_a_motion_that_shows_it(kind, told):
    for start, where in ((BEGIN, "in all"), (BEGIN + 20.0, "from 120 s on")):
        drift = KNOWN._replace(stands_out=True, change=-0.5, start=start)
        said = [*_drift(LOADED, drift, kind, table([], []))]
        first = ["The force drifts by -10 mN/s", f" -500 mN {where}"]
        assert [each.split(",")[:2] for each in said] == [first] * told


@pytest.mark.parametrize(("share", "told"), [(0.95, False), (1.05, True)])
def test_a_drift_that_may_be_by_chance_is_told_from_2_percent_of_the_peaks_on(share, told):
    lasts = TIME[-1] - TIME[0]
    drift = KNOWN._replace(sure=False, likely=-share * 0.02 * 6.0 / lasts)
    cycles = table([5.9, 6.1], [4.0, 4.0])
    assert bool([*_drift(LOADED, drift, STICK_SLIP, cycles)]) == told
    assert not [*_drift(LOADED, drift, STICK_SLIP, table([], []))]


def test_a_force_at_several_levels_shows_no_drift():
    time = np.arange(0.0, 30.0, 0.01)
    noise = 5e-3 * np.random.default_rng(1).normal(size=len(time))
    for force, known in ((np.repeat([1.0, 1.4, 1.8], 1000), False), (1.0 + 0.01 * time, True)):
        record = st.Record(time=time, force=force + noise)
        drift = find_drift(record, swings(record).lasting)
        assert np.isfinite(drift.error) == drift.sure == known
