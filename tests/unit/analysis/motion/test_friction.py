"""Friction coefficients are force over load at the same instant."""

from itertools import pairwise

import numpy as np
import pytest
from tests.parts import assess

import stiction as st
from stiction.analysis.motion.friction import _peak_excess
from stiction.analysis.protocols.friction_test import friction_test

TIME = np.arange(0.0, 20.0, 1e-3)
SWINGING = 10.0 + 3.0 * np.sin(0.7 * TIME)
STATIC, KINETIC = 0.2, 0.15


def stick_slip(load):
    """Return a force that rises by 1 N/s to STATIC of the load, then falls about KINETIC of it."""
    force, slips = np.zeros(len(load)), False
    for i in range(1, len(load)):
        slips = force[i - 1] > (2.0 * KINETIC - STATIC if slips else STATIC) * load[i]
        force[i] = force[i - 1] + (-0.05 if slips else 1e-3)
    return force


@pytest.mark.parametrize("noise", [0.0, 0.1])
def test_a_load_that_varies_is_followed(noise):
    load = SWINGING + noise * np.random.default_rng(1).standard_normal(len(TIME))
    found = st.analyse(st.Record(time=TIME, force=stick_slip(SWINGING), load=load))
    friction, cycles = found.friction, found.cycles
    error = 0.006 + 0.1 * noise  # relative
    assert cycles["mu_static"].values == pytest.approx(STATIC, rel=error)
    assert cycles["mu_kinetic"].values == pytest.approx(KINETIC, rel=0.04 + error)
    assert friction.break_away.coefficient == pytest.approx(STATIC, rel=error)
    assert friction.static.coefficient == pytest.approx(STATIC, rel=error)
    assert friction.static.coefficient_spread < 0.006 * STATIC
    assert friction.static.spread > 0.1 * friction.static.force  # that of the load


def test_a_mass_that_slides_under_a_load_that_varies():
    load = np.where(TIME < 15.0, 10.0, 20.0)  # on average 12.5 N
    found = st.analyse(st.Record(time=TIME, force=STATIC * load, load=load))
    assert found.friction.kinetic.coefficient == pytest.approx(STATIC, rel=1e-3)


def test_a_friction_test_under_a_load_that_varies():
    record = st.Record(time=TIME, force=STATIC * SWINGING, load=SWINGING)
    program = st.protocols.velocity_steps(["1 mm/s", "2 mm/s"], distance="20 mm")
    assert friction_test(record, program).mu == pytest.approx(STATIC, rel=1e-12)


def test_a_constant_load_is_the_stated_one_to_the_last_bit():
    load = np.full(len(TIME), 10.1)
    known = {"time": TIME, "force": stick_slip(load), "normal_load": 10.1}
    stated, measured = (st.analyse(st.Record(**known, load=each)) for each in (None, load))
    assert stated.friction == measured.friction
    assert stated.cycles.identical(measured.cycles)


def test_a_run_is_under_the_load_of_its_program(slider):
    swings = st.protocols.LoadProgram(modulation=st.protocols.Modulation("3 N", "0.11 Hz"))
    run = st.simulate(slider.replace(load=swings), "6 s", sample_rate="1 kHz")
    cycles = st.analysis.find_cycles(run)
    load = np.interp(cycles["peak_time"], run.data["time"], run.data["normal_load"])
    assert np.ptp(load) > 3.0
    assert cycles["mu_static"].values == pytest.approx(cycles["peak"].values / load, rel=1e-6)


@pytest.mark.parametrize("cycles", [50, 1000])
def test_a_short_first_loading_is_seen_in_a_long_record(cycles):
    """It took less than one of the 400 means, and the record seemed to begin loaded."""
    time = np.arange(0.0, 1.0 + 0.05 * cycles, 2e-3)
    saw = 1.7 + 0.3 * ((time - 0.17) % 0.05) / 0.05
    force = np.where(time < 0.201, 10.0 * time, saw)
    noise = 1e-3 * np.random.default_rng(1).standard_normal(len(time))
    friction = assess(st.Record(time=time, force=force + noise, normal_load=10.0)).friction
    assert friction.break_away.force == pytest.approx(2.0, abs=0.02)
    assert friction.break_away.coefficient == pytest.approx(0.2, abs=0.002)


def test_a_load_that_grows_is_no_drift():
    load = 10.0 + 0.4 * TIME
    found = st.analyse(st.Record(time=TIME, force=stick_slip(load), load=load))
    assert "drifts" not in " ".join(found.warnings)


def test_the_error_of_cycles_on_a_slow_wave_is_not_that_of_independent_ones():
    """Over one and a half turns the mean is off by a fifth of its height; it was 0.24 +- 0.002."""
    random = np.random.default_rng(1)
    for noise in (0.0, 2e-3):
        wave = 0.02 * np.cos(3.0 * np.pi * TIME / TIME[-1])
        force = 1.75 + 0.25 * (TIME / 0.25 % 1.0) + wave + noise * random.standard_normal(len(TIME))
        found = assess(st.Record(time=TIME, force=force, normal_load=10.0)).friction
        for each in found.static, found.kinetic:
            assert each.error > 2.5 * each.spread / 80.0**0.5
            assert each.coefficient_error == pytest.approx(0.1 * each.error)


def test_peaks_that_a_converter_rounds_alike_are_not_known_without_error():
    step = 0.04
    force = step * np.round((1.713 + 0.25 * (TIME / 0.5 % 1.0)) / step)
    found = assess(st.Record(time=TIME, force=force, normal_load=10.0)).friction
    assert found.static.error == pytest.approx(step / 12.0**0.5, rel=0.05)


@pytest.mark.parametrize("noise", [0.0, 0.02])
def test_the_first_break_away_is_before_the_first_cycle(noise):
    """Cycles are as short as two means of the record, and the first peaks are lower than others."""
    first, size, loading, slip = 8.0, 100, 1000, 10
    peaks = np.minimum(first + 0.4 * np.arange(200), 10.0)
    force = [np.linspace(0.0, first, loading, endpoint=False)]
    for peak, following in pairwise(peaks):
        force += [
            np.linspace(peak, 0.8 * peak, slip, endpoint=False),
            np.linspace(0.8 * peak, following, size - slip, endpoint=False),
        ]
    force = np.concatenate(force)
    force += noise * np.random.default_rng(1).standard_normal(len(force))
    found = st.analyse(st.Record(time=1e-3 * np.arange(len(force)), force=force))
    broke, start = found.friction.break_away, found.cycles["start"].values[0]
    assert abs(broke.force - first) < 3.0 * broke.error
    assert broke.error < 0.02 * first
    assert start == pytest.approx(1e-3 * (loading + slip), abs=2e-3)


def assessment_of_cycles(per_cycle, fall, sensor=None):
    """Return the analysis of 200 cycles of 1 to 2 N that fall within a part of their period."""
    fine = np.arange(0.0, 200.0, 1e-3)
    part = fine % 1.0
    slipped = np.clip((part - 1.0 + fall) / fall, 0.0, 1.0)
    force = np.where(
        part < 1.0 - fall, 1.0 + part / (1.0 - fall), 1.5 + 0.5 * np.cos(np.pi * slipped)
    )
    if sensor is not None:
        force = sensor.response(force, 1e3)
    time = np.arange(0.0, 199.0, 1.0 / per_cycle)
    noise = 1e-3 * np.random.default_rng(1).standard_normal(len(time))
    known = {"normal_load": 10.0, "sensors": sensor and {"force": sensor}}
    return assess(st.Record(time=time, force=np.interp(time, fine, force) + noise, **known))


def test_peaks_between_samples_are_known_with_an_error():
    """Of many cycles of few samples the mean was 13 errors too low, or, at corners, too high."""
    for per_cycle, fall in ((17.3, 0.02), (25.1, 0.02), (40.7, 0.02), (100.3, 0.025)):
        friction = assessment_of_cycles(per_cycle, fall).friction
        assert abs(friction.static.force - 2.0) < 2.0 * friction.static.error
    assert assessment_of_cycles(407.3, 0.1).friction.static.error < 2e-3


@pytest.mark.parametrize("cut", ["2 Hz", "8 Hz"])
def test_a_stated_filter_is_an_error_of_friction(cut):
    """It smears peaks and troughs; static and kinetic friction had the error of their mean."""
    found = assessment_of_cycles(100.3, 0.05, st.Sensor(filter=cut))
    assert "peaks, troughs" in " ".join(found.warnings)
    for each, true in ((found.friction.static, 2.0), (found.friction.kinetic, 1.5)):
        assert abs(each.force - true) < 2.0 * each.error < 0.6
    assert assessment_of_cycles(100.3, 0.3, st.Sensor(filter="40 Hz")).friction.kinetic.error < 0.01


@pytest.mark.parametrize("samples", [18, 40, 80])  # of a cycle
@pytest.mark.parametrize("count", [12, 25])
def test_a_first_break_away_before_a_slow_fall(samples, count):
    """It was read on the flank behind its peak: 0.8999 +- 0.0001 for 0.9084 N."""
    time = np.arange(samples * (count + 6)) / samples
    since = time - 6.0
    swing = 0.013 * (1.0 - 0.4 * np.exp(-np.maximum(since, 0.0) / 2.0))
    force = np.where(since < 0.0, 0.15 * time, 0.9 + swing * np.sin(2.0 * np.pi * since))
    force += 1e-4 * np.random.default_rng(0).standard_normal(len(time))
    true = force[(since > 0.0) & (since < 0.5)].max()
    found = assess(st.Record(time=time, force=force)).friction.break_away
    assert found.force == pytest.approx(true, abs=3.0 * found.error)
    assert found.error < 1e-3


def sawtooth(samples, count, begin=2.0):
    """Return a loading to a first peak, and falls by 1 N from 2 N in a tenth of each cycle."""
    time = np.arange(int(samples * count)) / samples
    share = time % 1.0
    fall = 0.5 + 0.5 * np.cos(np.pi * (share - 0.9) / 0.1)
    force = 1.0 + np.where(share < 0.9, share / 0.9, fall)
    early = time < 1.0
    return np.append(time[early], time + 1.0), np.append((begin * time)[early], force)


def test_a_first_peak_below_the_end_of_the_range_is_known():
    """Later peaks are cut off, it is not; within its error it might have been, it said."""
    time, force = sawtooth(30, 40.3, begin=1.7)
    found = assess(st.Record(time=time, force=np.minimum(force, 1.8))).friction
    assert found.break_away.force == pytest.approx(1.7 * 29 / 30, abs=1e-6)
    assert found.static is None
    assert "the peaks are cut off: it is 1.8 N or more" in found.missing["static"]


def test_errors_of_peaks_between_samples():
    """Half of the rise within a sample over what a fall of three has more than one; a quarter."""
    time, force = sawtooth(30, 40.3)
    found = assess(st.Record(time=time[30:], force=force[30:])).friction
    rise = 1.0 / 0.9 / 30
    assert found.static.error == pytest.approx(0.0210, abs=0.001)
    assert rise / 4.0 < found.static.error < rise
    assert found.kinetic.error == pytest.approx(0.0059, abs=0.001)


def loading(samples, lasts, count, *, first=1.0, gain=0.0, jerk=(0.0, 0.0), noise=0.0, seed=0):
    """Return a record of a loading to 1 N, and of cycles by 0.3 N, the first by a part of it.

    The peaks grow by a gain from cycle to cycle, up to 1.5 N. Before the first, at a part of the
    loading, the force may fall by so much in a jerk, and recovers.
    """
    time = np.arange(int(samples * (lasts + count))) / samples
    since = time - lasts
    number, share = np.floor(since), since % 1.0
    peak, following = (np.clip(1.0 + gain * (number + k), 1.0, 1.5) for k in (0, 1))
    least = peak - 0.3 * np.where(number < 1, first, 1.0)
    slip = peak - (peak - least) * np.sin(0.5 * np.pi * np.clip(share / 0.1, 0.0, 1.0)) ** 2
    force = np.where(share < 0.1, slip, least + (following - least) * (share - 0.1) / 0.9)
    at, fall = jerk
    after = time - at * lasts
    falls = np.where((after >= 0.0), fall * np.exp(-after / (0.05 * lasts)), 0.0)
    force = np.where(since < 0.0, time / lasts - falls, force)
    force += noise * np.random.default_rng(seed).standard_normal(len(time))
    return st.Record(time=time, force=force)


def assert_first_peak(record, step):
    """Check that the break-away is the peak of 1 N, within its error and the rise in a sample."""
    found = assess(record).friction.break_away
    assert found.force == pytest.approx(1.0, abs=3.0 * found.error + step)
    assert found.error < 0.15


@pytest.mark.parametrize("noise", [0.0, 1e-3, 0.01])
@pytest.mark.parametrize("jerk", [(0.3, 0.2), (0.45, 0.15)])
def test_a_jerk_in_the_lower_half_of_a_loading_is_no_break_away(jerk, noise):
    assert_first_peak(loading(100, 10.0, 30, jerk=jerk, noise=noise), 1e-3)


def test_a_jerk_that_is_small_beside_the_slips_is_no_break_away():
    assert_first_peak(loading(100, 3.0, 30, jerk=(0.7, 0.08)), 4e-3)


@pytest.mark.parametrize("first", [0.4, 1.0])
@pytest.mark.parametrize("gain", [0.02, 0.05])
def test_a_first_peak_before_higher_ones_in_the_same_mean_of_the_record(first, gain):
    """There are two cycles in each of its 400 means."""
    assert_first_peak(loading(40, 10.0, 400, first=first, gain=gain), 3e-3)


@pytest.mark.parametrize(("samples", "lasts", "noise"), [(30, 40.0, 0.03), (100, 10.0, 0.06)])
def test_noise_on_a_long_loading_is_no_break_away(samples, lasts, noise):
    """Of 400 means some differ by six standard deviations: it was 0.56 ± 0.05 N for 1 N."""
    for seed in range(8):
        record = loading(samples, lasts, 30, noise=noise, seed=seed)
        assert_first_peak(record, 1.0 / lasts / samples)


@pytest.mark.parametrize(
    ("name", "value"), [("MEMORY", 30.0), ("FINE_SAMPLES", 120.0), ("ALONE", 1e3), ("ALONE", 40.0)]
)
def test_what_makes_the_error_of_a_filter_quick_to_find_does_not_change_it(
    monkeypatch, name, value
):
    """A filter forgets; another one, of 50 times its cut-off, does nothing beside it."""
    sensor = st.Sensor(filter="2 Hz", bandwidth="100 Hz")
    quick = assessment_of_cycles(100.3, 0.05, sensor).friction
    monkeypatch.setattr(f"stiction.analysis.motion.doubts.sampling.{name}", value)
    whole = assessment_of_cycles(100.3, 0.05, sensor).friction
    assert quick.static.error == pytest.approx(whole.static.error, rel=0.025)
    assert quick.kinetic.error == pytest.approx(whole.kinetic.error, rel=0.025)


def test_a_bandwidth_near_the_cut_off_of_the_filter_counts():
    near, far = (
        assessment_of_cycles(100.3, 0.05, st.Sensor(filter="8 Hz", bandwidth=each)).friction
        for each in ("10 Hz", "300 Hz")
    )
    assert near.static.error > 1.1 * far.static.error


def test_a_first_peak_that_is_cut_off_in_noise_is_not_known():
    """Its mean over some samples is below the end of the range by some of its errors."""
    for seed in range(6):
        record = loading(300, 10.0, 30, noise=0.02, seed=seed)
        cut = record.model_copy(update={"force": np.minimum(record.force, 0.99)})
        found = assess(cut).friction
        assert found.break_away is None
        assert "the peak is cut off" in found.missing["break_away"]


@pytest.mark.parametrize(("count", "known"), [(1, True), (4, False)])
def test_friction_is_that_of_the_peaks_if_very_few_are_cut_off(count, known):
    """Of forty, one that is a tenth too low changes the mean by less than 3 in 1000."""
    time, force = sawtooth(100, 41.3)
    higher = force + np.where((time % 10.0 > 4.5) & (time < 10.0 * count), 0.2, 0.0) * (
        (time % 1.0) * (time % 10.0 < 5.5)
    )
    cut = np.minimum(higher, 2.05)
    found = assess(st.Record(time=time, force=cut)).friction
    assert (found.static is not None) == known
    if known:
        assert found.static.force == pytest.approx(2.0, abs=0.01)
    else:
        assert "peaks are cut off" in found.missing["static"]


def test_a_constant_load_in_noise_is_as_uncertain_in_the_break_away_as_told():
    """Its mean over a 400th of the record was off by up to 13 errors that were told."""
    off = []
    for seed in range(12):
        random = np.random.default_rng(seed)
        force = stick_slip(10.0 + 0.0 * TIME[:4000]) + 1e-3 * random.standard_normal(4000)
        load = 10.0 + 0.5 * random.standard_normal(4000)
        broke = assess(st.Record(time=TIME[:4000], force=force, load=load)).friction.break_away
        assert broke is not None
        off.append((broke.coefficient - STATIC) / broke.coefficient_error)
    assert np.abs(off).max() < 3.0


@pytest.mark.parametrize("offset", [0.1, 0.35, 0.6, 0.85])
def test_a_rounded_top_in_steps_is_known_to_a_part_of_a_step(offset):
    """Its error was a thousandth of a step."""
    step, share = 0.02, np.clip(TIME % 4.0, 0.0, 3.9) / 3.9
    force = 2.0 * np.sin(0.5 * np.pi * share) + step * offset
    read = step * np.round(force / step) - step * offset
    broke = assess(st.Record(time=TIME, force=read)).friction.break_away
    assert broke is not None
    assert broke.error > 0.25 * step
    assert broke.force == pytest.approx(2.0, abs=2.0 * broke.error)


def test_a_top_that_is_level_on_both_sides_has_no_excess():
    assert _peak_excess(np.array([0.9, 1.0, 1.0, 1.0, 0.9]), 2, 1) == 0.0


def test_the_load_of_the_first_break_away_is_that_of_the_channel_as_for_static_friction():
    """A load stated as half of a constant, noisy channel made its coefficient twice the other."""
    random, time = np.random.default_rng(5), np.arange(4000) / 400.0
    force = np.where(time < 1.0, time, 0.5 + 0.5 * (time % 1.0)) + 2e-3 * random.normal(size=4000)
    load = 2.0 * (1.0 + 0.02 * random.normal(size=4000))
    found = assess(st.Record(time=time, force=force, load=load, normal_load=1.0)).friction
    for its in (found.break_away, found.static):
        assert abs(its.coefficient - 0.5) < 3.0 * its.coefficient_error + 2e-3
