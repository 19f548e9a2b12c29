"""One load cell: a run, its table, its report and its record say the same of one test."""

import numpy as np
import pytest

import stiction as st
from stiction.analysis.motion.metadata.drive_velocity import drive_velocity

P, A = st.protocols, st.analysis
SENSORS = {"force": st.Sensor(), "drive_position": st.Sensor(unit="m")}
BRAKE = st.presets.nakano_popov_2020().replace(
    k_y="100 kN/m", c_x="2 N s/m", c_y="5 N s/m", friction=st.Coulomb(mu_0=0.2)
)
ROCK = st.Slider(
    mass="1 g", k_x="1 MN/m", k_y="100 MN/m", phi="0 deg", normal_load="10 N",
    friction=st.laws.RateStateAgeing(mu_star=0.6, a=0.010, b=0.015, D_c="10 um", V_star="1 um/s"),
)  # fmt: skip
# misalignment and axis of the cell, deg, and way of the drive
ALIGNED = [(0.0, None, -1.0), (0.0, 30.0, -1.0), (0.0, 180.0, 1.0), (0.0, -120.0, -1.0)]
RIGS = [*ALIGNED, (20.0, None, 1.0), (-35.0, 100.0, -1.0), (50.0, -130.0, 1.0), (-50.0, 0.0, -1.0)]


def turn(slider, phi, cell, **changes):
    """Return a slider at these angles, deg, and the share of a force along X that it reads."""
    angle = None if cell is None else f"{cell} deg"
    turned = slider.replace(phi=f"{phi} deg", cell_angle=angle, **changes)
    return turned, abs(np.cos(np.radians(-phi if cell is None else cell)))


def record_in_agreement(run):
    """Return the record of a run, which agrees with its table, and with what it states."""
    plain, record = A.record_of(run), st.measure(run, SENSORS)
    apparent = plain.force / run.samples["normal_load"]
    np.testing.assert_allclose(np.abs(apparent), np.abs(run.samples["mu"]), rtol=0, atol=1e-12)
    found = drive_velocity(record)
    if found is not None and record.drive_velocity is not None:
        # by straight lines through positions that are rounded
        assert found.ratio == pytest.approx(1.0, rel=1e-9)
    return record


@pytest.mark.parametrize(("phi", "cell", "way"), RIGS)
def test_a_drive_goes_along_the_cell_as_its_record_states(phi, cell, way):
    """By its displacement the drive went at 1.2 times what the record of one run stated."""
    speed = way * 1e-3
    slider, share = turn(BRAKE, phi, cell, drive=st.ConstantVelocity(speed))
    record = record_in_agreement(st.simulate(slider, "2 s", sample_rate="50 Hz"))
    assert record.drive_velocity == pytest.approx(share * 1e-3)
    assert record.drive_position[-1] == pytest.approx(share * 2e-3)
    across = P.DriveProgram(velocity=speed, across=P.Modulation("0.5 mm/s", "2 Hz"))
    run = st.simulate(slider.replace(drive=across), "2.1 s", sample_rate="50 Hz")
    way_along = st.measure(run, SENSORS).drive_position
    np.testing.assert_array_equal(way_along, A.record_of(run).drive_travel)
    X, Y = (1e-3 * way * run.samples["time"], across.travel(0.0, run.samples["time"])[1])
    angle = np.radians(-phi if cell is None else cell)
    expected = np.cos(angle) * X + np.sin(angle) * Y
    np.testing.assert_allclose(way_along, np.sign(expected[-1]) * expected, rtol=0, atol=1e-15)


@pytest.mark.parametrize(("phi", "cell", "way"), RIGS)
def test_loops_of_a_run_are_those_of_its_record(phi, cell, way):
    program = P.reversal_loops("1 mm/s", "10 mm", loops=1)
    slider, share = turn(BRAKE, phi, cell, drive=program)
    run = st.simulate(slider, sample_rate="100 Hz")
    record = record_in_agreement(run)
    (its,) = A.hysteresis(run).loops
    (said,) = st.analyse(run).parts["procedure"].loops
    (by_program,) = A.hysteresis(record, program).loops
    (by_drive,) = A.hysteresis(record).loops
    assert said.friction == its.friction <= np.abs(run.samples["mu"]).max() * (1.0 + 1e-12)
    assert its.friction == pytest.approx(by_program.friction, rel=1e-4)
    assert its.area == pytest.approx(by_program.area, rel=1e-4)
    # the turns of a measured drive are known to a sample, of a loop of 2000
    assert its.friction == pytest.approx(by_drive.friction, rel=1e-3)
    assert share * its.area == pytest.approx(by_drive.area, rel=1e-3)
    if phi == 0.0:
        assert its.friction == pytest.approx(0.2 * share, rel=1e-3)


@pytest.mark.parametrize(("phi", "cell", "way"), ALIGNED)
def test_friction_over_the_load_is_that_on_the_cell(phi, cell, way):
    """One report said "kinetic 0.1732", and that friction rises by 0.2000 of the load."""
    load = P.load_ramp(["20 N", "30 N"], ramp="1 s", hold="3 s")
    drive = st.ConstantVelocity(way * 5e-3)
    slider, share = turn(BRAKE, phi, cell, drive=drive, load=load)
    run = st.simulate(slider, sample_rate="400 Hz")  # at 50 Hz its vibration would not be shown
    found = st.analyse(run)
    record = st.measure(run, SENSORS).model_copy(update={"normal_load": slider.normal_load})
    assert found.parts["procedure"].coefficient == pytest.approx(0.2 * share, rel=1e-5)
    assert A.load_dependence(record, load).coefficient == pytest.approx(0.2 * share, rel=1e-5)
    kinetic = found.friction.kinetic
    off = kinetic.coefficient - 0.2 * share
    assert abs(off) < 3.0 * kinetic.coefficient_error + 1e-4


@pytest.mark.parametrize(("phi", "cell", "way"), ALIGNED)
def test_a_law_is_read_on_the_cell_whichever_way_the_drive_goes(phi, cell, way):
    """Its record had a and b of the other sign where the drive goes against X."""
    V = way * 1e-6
    program = P.velocity_steps([V, 10.0 * V], distance="0.2 mm")
    slider, share = turn(ROCK, phi, cell, drive=program)
    run = st.simulate(slider, sample_rate="20 Hz")
    record = record_in_agreement(run)
    for source, given, scale in ((run, None, 1.0), (record, program, 1.0), (record, None, share)):
        (step,) = A.velocity_steps(source, given, law="ageing").steps
        # of a record, what evolves in a third of a sample: docs/how-to/protocols.md
        least = 1e-4 if source is run else 10.0 * abs(V) / 10e-6 / 20.0 / 3.0
        for value, error, true in (
            (step.a, step.a_error, 0.010 * share),
            (step.b, step.b_error, 0.015 * share),
            (step.D_c, step.D_c_error, scale * 10e-6),
        ):
            assert abs(value - true) < 3.0 * error + least * true
    holds = P.slide_hold_slide(10.0 * V, ["3 s", "30 s"], slide="20 s")
    held = st.simulate(slider.replace(drive=holds), sample_rate="20 Hz")
    along = st.simulate(slider.replace(drive=holds, cell_angle="0 deg"), sample_rate="20 Hz")
    for name in ("steady", "relaxed", "peak"):
        expected = share * getattr(A.healing(along), name)
        np.testing.assert_allclose(getattr(A.healing(held), name), expected, rtol=1e-6)
    by_program = A.healing(record_in_agreement(held), holds)
    np.testing.assert_allclose(by_program.relaxed, A.healing(held).relaxed, rtol=1e-9)
