"""A drive whose displacement was measured: its stretches, and tests that need no program."""

from math import isnan

import numpy as np
import pytest
from benchmarks.explore.draw import Draw
from benchmarks.state_laws import velocity_steps as drawn
from tests.drawn import SEED

import stiction as st
from stiction.analysis.drive.measured_drive import even_drive, measured_stretches
from stiction.analysis.protocols.friction_test import friction_test

p = st.protocols


def test_velocities_and_jumps_are_those_of_the_program():
    """Speeds that differ by 1.05 to 10, an encoder of 3 to 100 nm, noise of half of it."""
    for number in range(30):
        draw = Draw(SEED, number)
        V = draw.decades(1e-7, 1e-3)
        speeds, pieces = [V], [p.Constant(V, draw.between(20.0, 60.0) * 10e-6 / V)]
        for _ in range(draw.among((1, 2, 4))):
            speeds.append(speeds[-1] * draw.decades(1.05, 10.0) ** draw.among((-1, 1)))
            pieces.append(p.Constant(speeds[-1], draw.between(20.0, 60.0) * 10e-6 / speeds[-1]))
        program = p.DriveProgram(velocity=V, program=pieces)
        jumps = np.cumsum([each.duration for each in pieces])
        time = np.linspace(0.0, jumps[-1], int(draw.decades(2e3, 5e4)))
        X = np.array(program.travel(0.0, time)[0])
        step = draw.decades(3e-9, 1e-7)
        random = np.random.default_rng([SEED, number])
        X = np.round((X + 0.5 * step * random.standard_normal(len(X))) / step) * step
        found = measured_stretches(time, X)
        assert [each.velocity for _, each in found] == pytest.approx(speeds, rel=0.01)
        between = time[1] + 3.0 * step / np.abs(np.diff(speeds))
        assert (np.abs([end for end, _ in found[:-1]] - jumps[:-1]) < between).all()


def test_a_drive_that_takes_time_to_change_its_velocity_steps():
    """A stage accelerates for 0.2 s; that is a step, at the middle of it."""
    V = 1e-6
    program = p.DriveProgram(
        velocity=V,
        program=[p.Constant(V, 40.0), p.Ramp(10 * V, 0.2), p.Constant(10 * V, 10.0), p.Hold(5.0)],
    )
    time = np.arange(0.0, 55.2, 0.01)
    found = measured_stretches(time, program.travel(0.0, time)[0])
    assert [each.velocity for _, each in found] == pytest.approx([V, 10 * V, 0.0])
    assert [end for end, _ in found[:-1]] == pytest.approx([40.1, 50.2], abs=0.02)


def test_a_drive_that_is_measured_backwards_pulls_all_the_same():
    time = np.linspace(0.0, 10.0, 500)
    record = st.Record(
        time=time, force=np.full(500, 2.0), drive_position=-1e-3 * time, normal_load=4.0
    )
    test = friction_test(record)
    assert test.stretches[0].way * test.mu == pytest.approx(np.full(500, 0.5))


def stretches_of(times, ways, noise=0.0):
    """Return the stretches of a drive that comes to some `ways` (m) at some times (s)."""
    time = np.linspace(0.0, times[-1], 4000)
    X = np.interp(time, times, ways) + noise * np.random.default_rng(1).standard_normal(4000)
    return measured_stretches(time, X)


def test_what_bends_and_what_does_not():
    """A brief hold, an intermediate velocity, 0.2 % of the way; noise of 1 % of it does not."""
    hold = stretches_of([0, 50, 52, 102], [0, 50e-6, 50e-6, 100e-6])
    assert [each.velocity for _, each in hold] == pytest.approx([1e-6, 0.0, 1e-6])
    between = stretches_of([0, 50, 60, 110], [0, 50e-6, 75e-6, 275e-6])
    assert [each.velocity for _, each in between] == pytest.approx([1e-6, 2.5e-6, 4e-6])
    assert len(stretches_of([0, 20, 100], [0, 0.198, 1.0])) == 2
    assert len(stretches_of([0, 100], [0, 1e-4], noise=1e-6)) == 1


@pytest.mark.parametrize(("by", "same"), [(1.005, True), (1.02, False)])
def test_velocities_that_differ_by_less_than_a_hundredth_are_the_same(by, same):
    found = stretches_of([0, 50, 60, 110], [0, 50e-6, 50e-6, (50 + 50 * by) * 1e-6])
    assert (found[0][1].velocity == found[2][1].velocity) is same


@pytest.mark.parametrize("codes", [20, 100, 400, 2000])
def test_an_encoder_of_few_steps_is_no_staircase_of_holds(codes):
    """Of fewer than 500 steps all velocities were 0."""
    time = np.arange(0.0, 24.0, 0.002)
    step = 60e-3 / codes
    way = np.floor(np.interp(time, [0.0, 15.0, 24.0], [0.0, 15e-3, 60e-3]) / step) * step
    found = measured_stretches(time, way)
    assert [each.velocity for _, each in found] == pytest.approx([1e-3, 5e-3], rel=0.05)


def test_a_screw_that_errs_has_no_stretches():
    time = np.linspace(0.0, 20.0, 40_000)
    way = 1e-3 * time + 20e-6 * np.sin(2.0 * np.pi * time)
    with pytest.raises(st.ResultError, match="has no stretches of constant velocity"):
        measured_stretches(time, way)


@pytest.mark.parametrize("change", ["soft start", "twice as fast", "pause"])
def test_stick_slip_shows_no_steady_friction_whatever_its_drive_does(change):
    """It was said to heal, or to strengthen with speed, by the swings of the force."""
    time = np.arange(0.0, 30.0, 0.002)
    points = {
        "soft start": ([0.0, 2.0, 30.0], [0.0, 1e-3, 29e-3]),
        "twice as fast": ([0.0, 15.0, 30.0], [0.0, 15e-3, 45e-3]),
        "pause": ([0.0, 14.0, 16.0, 30.0], [0.0, 14e-3, 14e-3, 28e-3]),
    }
    way = np.interp(time, *points[change])
    saw = 1.0 + 0.4 * (way / 1e-3 % 1.0)
    saw *= np.minimum(way / 1e-3, 1.0)
    force = saw + 2e-3 * np.random.default_rng(SEED).standard_normal(len(time))
    record = st.Record(time=time, force=force, drive_position=way, normal_load=4.0, stiffness=400.0)
    assert st.analyse(record).parts["procedure"] is None


@pytest.mark.parametrize("count", [3, 4, 5, 9, 40])
def test_a_record_of_few_samples_with_its_drive_is_analysed(count):
    """It ended with an IndexError, or of a stretch of three samples with a ValueError."""
    time = np.arange(float(count))
    way = np.interp(time, [0.0, count - 3.0, count - 1.0], [0.0, count - 3.0, count + 20.0])
    record = st.Record(time=time, force=1.0 + 0.1 * np.sin(time), drive_position=way, normal_load=2)
    assert "Motion" in str(st.analyse(record))


def test_a_brief_stretch_of_a_program_is_left_out():
    time = np.arange(0.0, 400.3, 0.1)
    program = p.DriveProgram(
        velocity=1e-6,
        program=[p.Constant(1e-6, 200.0), p.Constant(1e-5, 0.3), p.Constant(1e-6, 200.0)],
    )
    record = st.Record(time=time, force=np.sin(time), normal_load=1.0)
    with pytest.raises(st.ResultError, match="too few samples"):
        st.analysis.velocity_steps(record, program)


def test_a_program_counts_and_not_the_displacement():
    time = np.arange(0.0, 20.0, 0.01)
    record = st.Record(time=time, force=np.ones(2000), normal_load=2.0, drive_position=1e-6 * time)
    pieces = [p.Constant(1e-6, 10.0), p.Constant(1e-5, 10.0)]
    program = p.DriveProgram(velocity=1e-6, program=pieces)
    assert len(friction_test(record, program).stretches) == 2


def test_a_clock_is_off_by_a_sample_at_least():
    time = np.arange(20.0)
    record = st.Record(time=time, force=1.0 + 0.01 * np.sin(time), normal_load=2.0)
    pieces = [p.Constant(1e-6, 10.0), p.Constant(1e-5, 10.0)]
    test = friction_test(record, p.DriveProgram(velocity=1e-6, program=pieces))
    assert test.clock_at_jump(*test.stretches) == 1.0


@pytest.mark.parametrize("periods", [0.3, 1.0, 7.0, 30.0])
def test_a_drive_without_a_constant_velocity_is_refused(periods):
    time = np.linspace(0.0, 1.0, 20_000)
    swings = 1e-3 * np.sin(2.0 * np.pi * periods * time)
    noise = 1e-7 * np.random.default_rng(SEED).standard_normal(len(time))
    with pytest.raises(st.ResultError, match="has no stretches of constant velocity"):
        measured_stretches(time, swings + noise)


def test_velocity_steps_of_a_record_with_its_drive_need_no_program():
    """Clocks begin anywhere; the errors hold as with the program."""
    off = []
    for number in range(4):
        record = drawn.record_of(SEED, number, late=0.0, off=0.05)
        X = record.program.travel(0.0, record.record.time)[0]
        random = np.random.default_rng([SEED, number])
        measured = record.record.model_copy(
            update={
                "drive_position": X + 2e-8 * random.standard_normal(len(X)),
                "time": record.record.time + 100.0 * number - 200.0,
            }
        )
        found = st.analysis.velocity_steps(measured, law=record.law)
        off += drawn.deviations(record, found)
        assert not any(isnan(each.D_c) for each in found.steps)
    assert len(off) == 12
    assert np.abs(off).max() < 4.0


def test_an_analysis_of_a_record_with_its_drive_begins_with_its_test():
    law = st.laws.RateStateAgeing(mu_star=0.6, a=0.01, b=0.014, D_c="5 um", V_star="1 um/s")
    slider = st.Slider(
        mass="1 kg", k_x="20 MN/m", k_y="2 GN/m", phi="0 deg", normal_load="1 kN", friction=law
    )
    holds = p.slide_hold_slide("10 um/s", ["10 s", "100 s"], slide="20 s")
    run = st.simulate(slider.replace(drive=holds), sample_rate="20 Hz")
    time = run.samples["time"]
    record = st.Record(
        time=time,
        force=run.samples["spring_x"],
        drive_position=holds.travel(0.0, time)[0],
        normal_load=1e3,
    )
    found = st.analyse(record)
    assert [part.title for part in found.tables()[:2]] == ["In short", "Healing"]
    said = found.tables()[0].sentences
    assert said[0] == f"A test of healing. {found.parts['procedure'].answer}"
    assert not any(each.startswith("Friction") for each in said)  # "the mass may not slide"
    healing = found.parts["procedure"]
    assert healing.hold == pytest.approx([10.0, 100.0], rel=1e-3)
    assert "Friction heals by" in str(found)
    assert st.analyse(record.model_copy(update={"drive_position": None})).parts["procedure"] is None


@pytest.mark.parametrize("noise", [0.0, 1e-6, 2e-5])
@pytest.mark.parametrize("way", [1.0, -1.0])
def test_a_drive_is_even_if_it_rests_at_most_before_and_after_it_moves(noise, way):
    time = np.arange(0.0, 20.0, 0.01)
    white = noise * np.random.default_rng(4).standard_normal(len(time))
    for begin, end in ((0.0, 20.0), (3.0, 20.0), (0.0, 15.0), (2.0, 18.0)):
        travel = 5e-4 * (np.clip(time, begin, end) - begin)
        assert even_drive(time, way * travel + white).speed == pytest.approx(5e-4, rel=2e-3)
    turns = 5e-4 * (10.0 - np.abs(10.0 - time))
    pauses = 5e-4 * (time - np.clip(time - 8.0, 0.0, 4.0))
    faster = 5e-4 * (time + 0.5 * np.maximum(time - 10.0, 0.0))
    swings = 1e-3 * np.sin(time)
    for position in (turns, pauses, faster, swings, np.zeros(len(time))):
        assert even_drive(time, way * position + white) is None


@pytest.mark.parametrize("known", [{}, {"stiffness": "2 kN/m"}])
def test_a_velocity_that_is_measured_counts_as_one_that_is_stated(known):
    """ "Not seen: give its drive velocity" stood beside "drive velocity 500 um/s"."""
    time = np.arange(0.0, 30.0, 2e-3)
    noise = np.random.default_rng(9).standard_normal((2, len(time)))
    cycle = time % 1.0
    force = 1.0 + np.where(cycle < 0.98, cycle - 0.2 * cycle**4, 40.0 * (1.0 - cycle) - 0.02)
    channels = {"time": time, "force": force + 1e-3 * noise[0], "normal_load": 4.0, **known}
    channels["drive_position"] = 5e-4 * time + 1e-7 * noise[1]
    measured, stated = (
        st.Record(**channels, **said) for said in ({}, {"drive_velocity": "0.5 mm/s"})
    )
    found, usual = st.analyse(measured), st.analyse(stated)
    assert found.record.drive_velocity == pytest.approx(5e-4, rel=1e-4)
    assert (found.record.stated_velocity, usual.record.stated_velocity) == (None, 5e-4)
    assert found.missing.keys() == usual.missing.keys()
    for name in ("stiffness", "creep_distance"):
        assert found.cycles[name].values == pytest.approx(
            usual.cycles[name].values, rel=1e-3, nan_ok=True
        )
    assert "No drive velocity is stated" in str(found)
    assert "No drive velocity is stated" not in str(usual)


def test_only_the_number_that_is_lacking_is_asked_for():
    """Without a velocity, "states no stiffness and drive_velocity; give both"."""
    time = np.arange(0.0, 30.0, 2e-3)
    force = 1.0 + 0.4 * (time % 1.0)
    numbers = {"stiffness": "2 kN/m", "drive_velocity": "0.5 mm/s"}
    for name, value in numbers.items():
        (lacking,) = (each.replace("_", " ") for each in numbers if each != name)
        why = st.analyse(st.Record(time=time, force=force, **{name: value})).missing
        assert why["misalignment"].endswith(f"give the record its {lacking}")
    why = st.analyse(st.Record(time=time, force=force)).missing["misalignment"]
    assert why.endswith("give the record its stiffness and drive velocity")


def test_a_measured_velocity_is_not_saved_as_a_stated_one(tmp_path):
    time = np.arange(0.0, 30.0, 0.01)
    record = st.Record(time=time, force=time % 1.0, drive_position=5e-4 * time)
    analysed = st.analyse(record).record
    assert analysed.drive_velocity == pytest.approx(5e-4)
    stored = st.read_record(analysed.save(tmp_path / "record.nc"))
    assert stored.drive_velocity is None
