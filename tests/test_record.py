import numpy as np
import pytest

import stiction as st
from stiction.analysis.record import Record, record_of


def test_every_fault_of_a_record_is_named_with_its_remedy():
    with pytest.raises(st.DescriptionError) as error:
        Record(time=[0.0, 1.0], force=[1.0, np.nan], mass="30 mm")
    message = str(error.value)
    assert "1 of 2 samples are not finite, the first is number 2; leave them out" in message
    assert "Record.mass: '30 mm' is in mm, not a unit of a mass" in message


def test_arrays_belong_together_and_time_increases():
    with pytest.raises(st.DescriptionError, match="force has 3 samples and time 2"):
        Record(time=[0.0, 1.0], force=[1.0, 2.0, 3.0])
    with pytest.raises(st.DescriptionError, match="sample 3, at 1 s, follows one at 1 s"):
        Record(time=[0.0, 1.0, 1.0], force=[1.0, 2.0, 3.0])
    with pytest.raises(st.DescriptionError, match="has 2; give one number a sample"):
        Record(time=[[0.0], [1.0]], force=[1.0, 2.0])


def test_an_empty_record_has_no_duration():
    record = Record(time=[], force=[])
    assert (len(record), record.duration, record.sample_rate) == (0, 0.0, 0.0)


def test_a_run_as_its_load_cell_records_it():
    slider = st.presets.nakano_popov_2020()
    run = st.simulate(slider, duration=0.05, sample_rate=1e3)
    record = record_of(run)
    assert np.array_equal(record.force, run.data["spring_x"].values)
    assert record.drive_velocity == pytest.approx(1e-3 * np.cos(slider.phi), rel=1e-15)
    assert record.sample_rate == pytest.approx(1e3)


def test_a_drive_the_other_way_is_turned_round():
    slider = st.presets.nakano_popov_2020()
    there = record_of(st.simulate(slider, duration=0.05, sample_rate=1e3))
    back = slider.replace(drive=st.ConstantVelocity(-1e-3))
    mirrored = record_of(st.simulate(back, duration=0.05, sample_rate=1e3))
    assert np.array_equal(mirrored.force, there.force)
    assert np.array_equal(mirrored.position, there.position)
    assert mirrored.drive_velocity == there.drive_velocity
