"""Swings of the force that jumps of the drive's velocity make, and those that they do not."""

import numpy as np
import pytest
from benchmarks.explore.draw import Draw
from tests.drawn import SEED

import stiction as st
from stiction.analysis.motion.changes.velocity import VelocityJump, made_by_jumps, velocity_jumps
from stiction.analysis.motion.cycle_columns import CycleTable
from stiction.analysis.motion.cycles import swings

STEPS = ([1, 10, 1, 10, 1], [1, 10, 1, 10, 1, 10, 1], [30, 1, 100, 3], [100, 10, 3, 30], [3, 1, 10])


def drive_of(speeds, distance, per_stretch):
    """Return times (s), travel (m) and velocity of a drive that goes `distance` at each speed."""
    parts, begin = [], 0.0
    for number, speed in enumerate(speeds):
        lasts = distance / speed
        inside = np.arange(per_stretch) / per_stretch * lasts
        parts.append(
            (begin + inside, number * distance + inside * speed, np.full_like(inside, speed))
        )
        begin += lasts
    return tuple(np.concatenate(each) for each in zip(*parts, strict=True))


def velocity_steps(number):
    """Return a record of velocity steps on a stiff rig, in closed form, and its speeds (m/s).

    By the slip law, ln(V theta/D_c) decays with the slip as exp(-x/D_c).
    """
    draw = Draw(SEED, number)
    speeds = [1e-6 * each for each in draw.among(STEPS)]
    a, D_c, per_stretch = draw.decades(3e-3, 2e-2), 1e-5, int(draw.decades(300, 3000))
    b, distance = a * draw.between(0.3, 1.6), D_c * draw.between(20.0, 100.0)
    time, way, speed = drive_of(speeds, distance, per_stretch)
    before = np.repeat([speeds[0], *speeds[:-1]], per_stretch)
    mu = 0.6 + (a - b) * np.log(speed / 1e-6)
    mu += b * np.log(speed / before) * np.exp(-(way % distance) / D_c)
    noise = draw.decades(1e-5, 0.05 * a) * np.random.default_rng([SEED, number]).normal(
        size=len(mu)
    )
    record = st.Record(
        time=time, force=10.0 * (mu + noise), drive_position=way, normal_load=10.0, stiffness=1e8
    )
    return record, speeds


def test_velocity_steps_are_not_stick_slip():
    """The report of 27 of 60 such records said that the mass sticks and slips, up to 0.999 sure."""
    driven = 0
    for number in range(40):
        seen = st.analysis.classify(velocity_steps(number)[0])
        assert seen.kind in ("settling", "steady sliding", "undetermined"), number
        driven += "driven" in seen.evidence
    assert driven >= 15


def test_a_report_of_velocity_steps_begins_with_them():
    record, speeds = velocity_steps(1)
    found = st.analyse(record)
    assert len(found.parts["procedure"].steps) == len(speeds) - 1
    assert not found.cycles.sizes["cycle"]
    assert "The force rises and falls after jumps of the drive's velocity" in str(found)


# Columns that need the velocity of the drive: an even displacement shows it
BY_VELOCITY = "stiffness", "creep_distance", "slip_distance", "peak_slip_speed"


def drive(kind, time, draw, noise):
    """Return the displacement (m) of a drive over a unit time, by some 1 mm."""
    errs = draw.between(2.0, 40.0)
    return (
        1e-3
        * {
            "exact": time,
            "noisy": time + draw.decades(1e-5, 1e-2) * noise,
            "of few steps": np.floor(time / 3e-3) * 3e-3,
            "with a screw that errs": time + 3e-3 * np.sin(2.0 * np.pi * errs * time),
            "accelerated": time + 0.1 * time**2,
            "stepped": np.interp(time, [0.0, 0.5, 1.0], [0.0, 0.3, 1.0]),
        }[kind]
    )


@pytest.mark.parametrize(
    "kind", ["exact", "noisy", "of few steps", "with a screw that errs", "accelerated", "stepped"]
)
def test_stick_slip_is_the_same_whatever_the_measured_drive_does(kind):
    for number in range(8):
        draw = Draw(SEED, number)
        time = np.linspace(0.0, 1.0, int(draw.decades(1e3, 2e4)))
        noise, drives = np.random.default_rng([SEED, number]).normal(size=(2, len(time)))
        phase = time * draw.between(4.0, 40.0) % 1.0
        force = 1.0 + 0.3 * np.minimum(phase / 0.95, (1.0 - phase) / 0.05) + 3e-3 * noise
        record = st.Record(time=time, force=force, drive_position=drive(kind, time, draw, drives))
        alone = record.model_copy(update={"drive_position": None})
        both = (st.analysis.find_cycles(each).drop_vars(BY_VELOCITY) for each in (record, alone))
        assert next(both).equals(next(both)), number


def test_a_jump_has_a_time_an_end_and_a_sign():
    """The drive goes backwards, to and by its own sign; a change by 3 % is not a jump."""
    time, way, _ = drive_of([1e-6, 1e-5, 0.97e-5, 1e-6, 1.1e-6], 1e-3, 2000)
    record = st.Record(time=time, force=np.sin(time), drive_position=-way)
    up, down, last = velocity_jumps(record)
    assert up.rises
    assert not down.rises
    assert up[:2] == pytest.approx((1000.0, 1100.0), rel=1e-3)
    assert down[:2] == pytest.approx((1203.1, 2203.1), rel=1e-3)
    assert last[:2] == pytest.approx((2203.1, time[-1]), rel=1e-3)
    run = st.simulate(st.presets.nakano_popov_2020(), "1 s", sample_rate="1 kHz")
    assert not velocity_jumps(st.analysis.record_of(run))


ROCK = st.laws.RateStateAgeing(mu_star=0.6, a=0.010, b=0.014, D_c="10 um", V_star="1 um/s")
HOLDS = st.protocols.slide_hold_slide("10 um/s", ["10 s", "100 s", "1000 s"], slide="100 s")


def run_of(test, **rig):
    slider = st.Slider(**{
        "mass": 1.0, "k_x": 1e7, "k_y": 1e9, "phi": "0 deg", "normal_load": 5e3,
        "friction": ROCK, "drive": test,
    } | rig)  # fmt: skip
    return st.simulate(slider, sample_rate="20 Hz")


@pytest.fixture(scope="module")
def holds():
    return run_of(HOLDS)


def test_the_jumps_of_a_run_are_those_that_its_measured_drive_shows(holds):
    """The report of a slide-hold-slide run had three cycles, that of its record none."""
    record = st.analysis.record_of(holds)
    way = record.drive_travel
    measured = st.Record(time=record.time, force=record.force, drive_position=way)
    jumps, seen = velocity_jumps(record), velocity_jumps(measured)
    assert [each.rises for each in jumps] == [each.rises for each in seen] == [False, True] * 3
    assert np.allclose([x[:2] for x in jumps], [x[:2] for x in seen], atol=0.05)
    for source in (holds, measured):
        assert st.analysis.classify(source).has("driven")
        assert not st.analysis.find_cycles(source).sizes["cycle"]


def test_jumps_beside_a_ramp_and_after_the_end_of_a_run_are_none():
    p = st.protocols
    one, two, three = (p.Constant(speed, duration="1 s") for speed in (1e-4, 2e-3, 3e-3))
    program = [one, p.Ramp("1 mm/s", duration="1 s"), two, three]
    slider = st.presets.nakano_popov_2020().replace(drive=p.DriveProgram(program=program))
    for end, jumps in (("2.5 s", []), ("3.5 s", [3.0]), ("4 s", [3.0])):
        record = st.analysis.record_of(st.simulate(slider, end, sample_rate="200 Hz"))
        assert [each.time for each in velocity_jumps(record)] == jumps


def test_a_run_of_a_test_tells_its_answer_and_no_friction_of_mixed_speeds(holds):
    found = st.analyse(holds)
    brief = " ".join(found.tables()[0].sentences)
    assert f"A test of healing. {found.parts['procedure'].answer} The force rises" in brief
    assert "ndetermined" not in brief
    assert "riction coefficient" not in brief
    assert found.warnings == ()  # "healing or hysteresis suit such a test"
    assert found.friction.kinetic is None
    test = st.protocols.velocity_steps(["10 um/s", "30 um/s", "10 um/s"], distance="0.3 mm")
    found = st.analyse(run_of(test))
    steps = found.parts["procedure"]
    assert steps.answer in found.tables()[0].sentences[0]
    assert "; D_c = 10.0" in steps.answer
    assert steps.answer.endswith(" µm (ageing law).")
    assert found.warnings == ()
    assert found.friction.kinetic is None


def test_stick_slip_of_a_run_has_its_cycles_and_no_a_minus_b():
    """Of 92 cycles at two speeds a report said first that a - b is 0.0 ± 0.1."""
    test = st.protocols.velocity_steps(["0.3 mm/s", "1 mm/s"], distance="1.5 mm")
    law = st.ExponentialWeakening(mu_0=0.35, mu_inf=0.25, v_f="1 mm/s")
    found = st.analyse(run_of(test, mass=0.5, k_x=2e4, k_y=1e6, normal_load=20.0, friction=law))
    assert found.regime.kind == "stick-slip"
    assert found.parts["procedure"] is None
    assert found.friction.kinetic is not None
    (said,) = [each for each in found.warnings if "drive varies" in each]
    assert said.endswith("; the table of cycles has each by itself.")


@pytest.mark.parametrize("steps", [3.7, 10.3, 30.7])
@pytest.mark.parametrize("moves", [0.1, 0.4])
def test_stick_slip_by_a_drive_that_moves_in_short_steps_is_seen(steps, moves):
    """The spring is loaded while it moves: each peak comes soon after one of many jumps."""
    time = np.arange(0.0, 5.0 * steps, 0.02)
    way = np.floor(time) + np.minimum(time % 1.0 / moves, 1.0)
    noise = 3e-3 * np.random.default_rng(1).standard_normal(len(time))
    record = st.Record(time=time, force=1.0 + 0.3 * (way / steps % 1.0) + noise, drive_position=way)
    assert len(velocity_jumps(record)) > 30
    alone = record.model_copy(update={"drive_position": None})
    assert len(st.analysis.find_cycles(alone)["period"]) >= 3
    assert st.analysis.find_cycles(record).equals(st.analysis.find_cycles(alone))


@pytest.mark.parametrize(
    ("peaks", "troughs", "made"),
    [
        ([120.0, 320.0, 520.0], [190.0, 390.0, 590.0], True),
        ([130.0, 330.0, 530.0], [190.0, 390.0, 590.0], False),  # a quarter of each stretch is soon
        ([180.0, 380.0, 580.0], [220.0, 420.0, 620.0], True),
        ([220.0, 420.0, 620.0], [310.0, 510.0, 690.0], False),  # jumps of the other sign
        ([20.0, 40.0, 60.0], [30.0, 50.0, 70.0], False),  # before all jumps
        ([120.0, 320.0, 520.0, 660.0], [190.0, 390.0, 590.0, 690.0], True),
        ([120.0, 320.0, 560.0, 660.0], [190.0, 390.0, 590.0, 690.0], False),  # half of them
        ([320.0, 720.0], [480.0, 880.0], True),  # a second jump up in each makes little
    ],
)
def test_most_swings_begin_soon_after_jumps_that_make_them(peaks, troughs, made):
    jumps = [
        VelocityJump(100.0 * number, 100.0 * number + 100.0, number % 2 == 1)
        for number in range(1, 9)
    ]
    peak, trough = np.array(peaks), np.array(troughs)
    start = np.append(peak[0] - 20.0, trough[:-1])
    columns = {"start": start, "peak_time": peak, "trough_time": trough, "period": trough - start}
    assert made_by_jumps(CycleTable(columns, 0.0), jumps) is made
    assert not made_by_jumps(CycleTable(columns, 0.0), [])


def test_swings_that_jumps_make_and_that_die_out_are_no_settling_either():
    time, way, speed = drive_of([1e-6, 1e-5] * 5, 1e-3, 500)
    stretch = np.minimum((way / 1e-3).astype(int), 9)
    away = np.where(speed > 2e-6, 1.0, -1.0) * 0.5**stretch * np.exp(-(way / 1e-4 % 10.0))
    record = st.Record(time=time, force=10.0 + away, drive_position=way)
    alone = record.model_copy(update={"drive_position": None})
    assert swings(alone).dying
    assert st.analysis.classify(record).evidence["driven"] == len(swings(alone).table)
