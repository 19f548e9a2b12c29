"""Misalignments by creep under a load that varies, and a drive that pauses."""

from math import degrees

import numpy as np
import pytest

import stiction as st
from stiction.analysis.creep.conditions import driven_steadily, load_change, typical_load
from stiction.analysis.record import record_of

PAPER = st.presets.nakano_popov_2020()
p = st.protocols


@pytest.fixture(scope="module")
def ramp():
    """Return a run of the paper's rig under a load that doubles."""
    load = p.LoadProgram(program=[p.Ramp("20 N", "6 s")])
    return st.simulate(PAPER.replace(load=load), "6 s", sample_rate="2 kHz")


def test_friction_follows_the_load(ramp):
    """By a constant load it was 1.45 ± 0.02 deg, 22 errors off, and F_0 = 3.49 ± 0.04 N."""
    found = st.analyse(ramp)
    its = found.misalignment
    assert abs(its.phi - PAPER.phi) < 2.0 * its.phi_error < 0.1 * PAPER.phi
    assert abs(its.F_0 - 2.0) < 2.0 * its.F_0_error < 0.1
    assert "at a normal load of 10 N" in str(found)
    assert "That is too small" not in str(found)


def test_so_it_does_in_records(ramp):
    """Their F_0 belongs to the mean of the load, 15 N."""
    quiet = {"force": st.Sensor(noise="2 mN"), "load": st.Sensor(noise="10 mN")}
    with_position = quiet | {"position": st.Sensor(noise="20 nm", unit="m")}
    its = st.analyse(st.measure(ramp, with_position)).misalignment
    assert abs(its.phi - PAPER.phi) < 2.0 * its.phi_error
    assert abs(its.F_0 - 3.0) < 2.0 * its.F_0_error


def test_so_it_does_in_records_of_force_and_load():
    """F_0 was that at the loads of the peaks, 2.31 ± 0.04 N."""
    load = p.LoadProgram(program=[p.Ramp("12 N", "6 s")])
    run = st.simulate(PAPER.replace(load=load), "6 s", sample_rate="1 kHz")
    quiet = {"force": st.Sensor(noise="1 mN"), "load": st.Sensor(noise="1 mN")}
    its = st.analyse(st.measure(run, quiet)).misalignment
    assert abs(its.phi - PAPER.phi) < 2.0 * its.phi_error
    assert abs(its.F_0 - 2.2) < 2.0 * its.F_0_error < 0.2
    assert abs(its.F_0 - 2.2) < 0.05


def test_a_load_that_goes_up_and_down_determines_no_angle():
    """Friction is not F_0 for long where its load swings by a third each second."""
    load = p.LoadProgram(modulation=p.Modulation("3 N", "1 Hz"))
    run = st.simulate(PAPER.replace(load=load), "5 s", sample_rate="1 kHz")
    found = st.analyse(run)
    assert found.misalignment is None
    assert "the normal load changes by" in found.missing["misalignment"]
    assert "the normal load changes by" in found.missing["divergence"]


def test_the_change_of_a_load_is_that_beyond_its_noise(ramp):
    """Within 2 s a ramp from 10 N to 20 N in 6 s rises by a third of 11.7 N; the ends are means."""
    begin, end = np.array([0.0]), np.array([2.0])
    change = load_change(record_of(ramp), begin, end)
    assert change == pytest.approx(10.0 / 3.0 / (35.0 / 3.0) * 15.0 / 16.0, rel=1e-3)
    sensors = {"force": st.Sensor(noise="2 mN"), "load": st.Sensor(noise="0.1 N")}
    quiet = st.measure(st.simulate(PAPER, "2 s", sample_rate="2 kHz"), sensors)
    assert load_change(quiet, begin, end) < 0.02


def test_wild_and_noisy_readings_of_a_load_are_no_change_of_it():
    """One reading without load made "no change" of a load that swings; noise of 1 N one of 41 %."""
    begin, end = np.array([0.1]), np.array([1.9])
    swings = PAPER.replace(load=p.LoadProgram(modulation=p.Modulation("3 N", "1 Hz")))
    sensors = {"force": st.Sensor(noise="2 mN"), "load": st.Sensor(noise="0.1 N")}
    record = st.measure(st.simulate(swings, "2 s", sample_rate="500 Hz"), sensors)
    change = load_change(record, begin, end)
    assert change > 0.8
    load = record.load.copy()
    load[40] = -1.0
    record = record.model_copy(update={"load": load})
    assert load_change(record, begin, end) == pytest.approx(change, rel=0.1)
    sensors["load"] = st.Sensor(noise="1 N")
    noisy = st.measure(st.simulate(PAPER, "2 s", sample_rate="500 Hz"), sensors)
    assert load_change(noisy, begin, end) == 0.0


def test_a_load_that_hardly_varies_loses_no_angle():
    """Measured loads vary by some per cent."""
    load = p.LoadProgram(modulation=p.Modulation("0.05 N", "0.7 Hz"))
    its = st.analyse(st.simulate(PAPER.replace(load=load), "3 s", sample_rate="2 kHz")).misalignment
    assert degrees(its.phi) == pytest.approx(1.0, abs=2.0 * degrees(its.phi_error))
    assert its.phi_error < 0.02 * its.phi


def test_a_load_that_reads_nothing_counts_as_beside_it():
    """The median was not a number, and no line of Eq. (8) was drawn."""
    time = np.linspace(0.0, 10.0, 1001)
    load = np.where(np.abs(time - 5.0) < 0.2, 0.0, 10.0 + time)
    record = st.Record(time=time, force=np.sin(time), load=load)
    found = typical_load(record, np.array([4.9, 5.0, 5.1]))
    assert found == pytest.approx(15.0 / record.normal_load, rel=0.02)


@pytest.fixture(scope="module")
def holds():
    """Return a run of a stiffer rig whose drive pauses within every third cycle or so."""
    steps = [st.protocols.Constant("1 mm/s", "3.0 s")]
    for slide, rest in ((2.2, 0.3), (2.6, 0.8), (2.3, 1.0), (2.5, 0.4)):
        steps += [p.Constant("1 mm/s", f"{slide} s"), p.Hold(f"{rest} s")]
    drive = p.DriveProgram(program=[*steps, p.Constant("1 mm/s", "2 s")])
    return st.simulate(PAPER.replace(drive=drive), "17 s", sample_rate="2 kHz")


def test_creep_leaves_out_stick_phases_in_which_the_drive_pauses(holds):
    """Eq. (7) supposes a steady drive: of 9 random rigs with holds the angle was 2 errors off."""
    found = st.analyse(holds)
    its = found.misalignment
    assert abs(its.phi - PAPER.phi) < 2.0 * its.phi_error < 0.2 * PAPER.phi
    assert found.curves.attrs["left_out"] == 4
    assert "Left out: 4 stick phases, in which the drive pauses" in str(found)


@pytest.mark.parametrize("channels", [("force",), ("force", "position"), ("force", "drive")])
def test_so_do_records_of_which_only_the_force_shows_the_pauses(holds, channels):
    """Creep was 4 ± 2 µm/s by the force, and 11 ± 1 µm/s by the displacement."""
    sensors = {
        "force": st.Sensor(noise="1 mN"),
        "position": st.Sensor(noise="50 nm", unit="m"),
        "drive": st.Sensor(noise="50 nm", unit="m"),
    }
    named = {name.replace("drive", "drive_position"): sensors[name] for name in channels}
    record = st.measure(holds, named)
    found = st.analyse(record)
    assert found.curves.attrs["left_out"] >= 3
    its = found.misalignment
    assert abs(its.phi - PAPER.phi) < 2.0 * its.phi_error


def test_a_drive_that_pauses_in_every_stick_phase_determines_no_creep():
    steps = [p.Constant("1 mm/s", "0.45 s"), p.Hold("0.4 s")] * 14
    slider = PAPER.replace(drive=p.DriveProgram(program=steps))
    found = st.analyse(st.simulate(slider, "11.9 s", sample_rate="1 kHz"))
    assert found.misalignment is None
    assert "the drive pauses" in str(found)


def test_no_pause_is_seen_where_the_drive_goes_on():
    run = st.simulate(PAPER, "12 s", sample_rate="1 kHz")
    for source in (run, st.measure(run, st.Sensor(noise="5 mN"))):
        assert st.analyse(source).curves.attrs["left_out"] == 0


@pytest.mark.parametrize("second", ["4 N", "25 N"])
def test_under_another_load_no_drive_pauses(second):
    """A rise takes longer under more load, and its levels are others."""
    pieces = [p.Constant("10 N", "14 s"), p.Ramp(second, "0.5 s"), p.Constant(second, "16 s")]
    slider = PAPER.replace(load=p.LoadProgram(program=pieces))
    run = st.simulate(slider, "30 s", sample_rate="1 kHz")
    record = st.measure(run, st.Sensor(noise="2 mN"))
    cycles = st.analysis.find_cycles(record)
    begin, end = cycles["start"].values, cycles["peak_time"].values
    assert len(begin) > 8
    changes = np.searchsorted(end, 14.0), np.searchsorted(begin, 14.5)  # in between the load moves
    driven = driven_steadily(record, record, begin, end)
    assert driven[: changes[0]].all()
    assert driven[changes[1] :].all()
