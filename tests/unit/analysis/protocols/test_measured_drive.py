"""A drive whose displacement was measured: its stretches, and tests that need no program."""

from math import isnan

import numpy as np
import pytest
from benchmarks.explore.draw import Draw
from benchmarks.state_laws import velocity_steps as drawn
from tests.drawn import SEED

import stiction as st
from stiction.analysis.protocols.measured_drive import measured_stretches

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
        found = measured_stretches(time, X, np.ones(len(X)))
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
    found = measured_stretches(time, program.travel(0.0, time)[0], np.ones(len(time)))
    assert [each.velocity for _, each in found] == pytest.approx([V, 10 * V, 0.0])
    assert [end for end, _ in found[:-1]] == pytest.approx([40.1, 50.2], abs=0.02)


def test_a_drive_that_is_measured_backwards_pulls_all_the_same():
    time = np.linspace(0.0, 10.0, 500)
    found = measured_stretches(time, -1e-3 * time, np.full(500, 2.0))
    assert found[0][1].velocity == pytest.approx(1e-3)


@pytest.mark.parametrize("periods", [0.3, 1.0, 7.0, 30.0])
def test_a_drive_without_a_constant_velocity_is_refused(periods):
    time = np.linspace(0.0, 1.0, 20_000)
    swings = 1e-3 * np.sin(2.0 * np.pi * periods * time)
    noise = 1e-7 * np.random.default_rng(SEED).standard_normal(len(time))
    with pytest.raises(st.ResultError, match="has no stretches of constant velocity"):
        measured_stretches(time, swings + noise, swings)


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
    assert found.tables()[0].title == "Healing"
    healing = found.parts["procedure"]
    assert healing.hold == pytest.approx([10.0, 100.0], rel=1e-3)
    assert "Friction heals by" in str(found)
    assert st.analyse(record.model_copy(update={"drive_position": None})).parts["procedure"] is None
