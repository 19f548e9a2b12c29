import numpy as np
import pytest

import stiction as st
from stiction.analysis.measurement.run_record import record_of
from stiction.analysis.record import Record
from stiction.cli import main
from stiction.errors import ResultError


def test_every_fault_of_a_record_is_named_with_its_remedy():
    with pytest.raises(st.DescriptionError) as error:
        Record(time=[0.0, 1.0], force=[1.0, np.nan], mass="30 mm")
    message = str(error.value)
    assert "1 of 2 samples are not finite, the first is number 2; leave them out" in message
    assert "Record.mass: '30 mm' is in mm, not a unit of a mass" in message


def test_arrays_belong_together_and_time_increases():
    with pytest.raises(st.DescriptionError, match="force has 3 samples and time 2"):
        Record(time=[0.0, 1.0], force=[1.0, 2.0, 3.0])
    with pytest.raises(st.DescriptionError, match=r"sample 3, at 0\.5 s, follows one at 1 s"):
        Record(time=[0.0, 1.0, 0.5], force=[1.0, 2.0, 3.0])
    with pytest.raises(st.DescriptionError, match="all 3 samples are at 1 s"):
        Record(time=[1.0, 1.0, 1.0], force=[1.0, 2.0, 3.0])
    with pytest.raises(st.DescriptionError, match="has 2; give one number per sample"):
        Record(time=[[0.0], [1.0]], force=[1.0, 2.0])


def test_samples_of_one_time_are_spread_up_to_the_next():
    record = Record(time=[0.0, 0.0, 0.0, 3.0, 3.0, 6.0], force=np.arange(6.0))
    assert record.time.tolist() == [0.0, 1.0, 2.0, 3.0, 4.5, 6.0]
    assert record.same_time == 3
    assert Record(time=[0.0, 1.0, 1.0], force=np.arange(3.0)).time.tolist() == [0.0, 1.0, 2.0]


def test_a_record_may_begin_within_a_tick_of_its_clock():
    """Its samples were spread over the whole tick, and the force rose too slowly there."""
    clock = [0.0, 0.0, *[3.0] * 3, *[6.0] * 3, *[9.0] * 3, 12.0]
    assert Record(time=clock, force=np.arange(12.0)).time.tolist() == [*np.arange(1.0, 13.0)]


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


def test_a_part_of_a_run_s_record_has_all_columns_of_the_part():
    motion = st.protocols.DriveProgram(
        velocity="1 mm/s", along=st.protocols.Modulation("0.1 mm/s", "50 Hz")
    )
    run = st.simulate(st.presets.nakano_popov_2020().replace(drive=motion), 0.05, sample_rate=1e3)
    record = record_of(run)
    part = record.before(0.02)
    assert len(part) == 20
    for name in ("drive_travel", "rate_across"):
        assert np.array_equal(getattr(part, name), getattr(record, name)[:20])
    assert part.slider is run.slider
    assert part.own_period == record.own_period == 1.0 / run.slider.natural_frequency_x


def test_a_drive_the_other_way_is_turned_round():
    slider = st.presets.nakano_popov_2020()
    there = record_of(st.simulate(slider, duration=0.05, sample_rate=1e3))
    back = slider.replace(drive=st.ConstantVelocity(-1e-3))
    mirrored = record_of(st.simulate(back, duration=0.05, sample_rate=1e3))
    assert np.array_equal(mirrored.force, there.force)
    assert np.array_equal(mirrored.position, there.position)
    assert mirrored.drive_velocity == there.drive_velocity


@pytest.mark.parametrize(
    ("force", "said"),
    [
        (np.ones(3) + 0j, "not of type complex128"),
        (np.arange(3).astype("datetime64[ms]"), "is in s, not a unit of a force"),
        (["1", "2", "3"], "not of type <U1"),
        (np.ma.masked_greater([1.0, 2.0, 9.0], 5.0), "1 of 3 samples are not finite"),
        ([1.0, 1e200, 2.0], "below 1e+100, is 1e+200"),
    ],
)
def test_what_is_no_number_is_not_taken_for_one(force: object, said: str) -> None:
    with pytest.raises(st.DescriptionError, match=r"Record\.force") as error:
        Record(time=[0.0, 1.0, 2.0], force=force)
    assert said in str(error.value)


def test_a_run_is_read_like_its_record(paper_run: st.Trajectory) -> None:
    assert st.analysis.classify(paper_run) == st.analysis.classify(st.analysis.record_of(paper_run))
    assert st.analysis.find_cycles(paper_run).identical(
        st.analysis.find_cycles(st.analysis.record_of(paper_run))
    )
    with pytest.raises(st.ResultError, match="a str is neither a run nor a record"):
        st.analysis.classify("run.nc")
    with pytest.raises(st.ResultError, match=r"a Slider is neither .*with st\.simulate"):
        st.analyse(paper_run.slider)
    with pytest.raises(st.ResultError, match=r"an Initial is neither .*with st\.Record"):
        st.analyse(st.Initial())


def test_units_of_arrays_are_honoured() -> None:
    import pint
    import xarray as xr

    time, force = np.array([0.0, 1.0, 2.0]), np.array([1.0, 2.0, 3.0])
    unit = pint.UnitRegistry()
    for record in (
        Record(time=time * unit.ms, force=force * unit.mN),
        Record(time=time, force=force, time_unit="ms", force_unit="mN"),
        Record(time=time.tolist(), force=force.tolist(), time_unit="ms", force_unit="mN"),
        Record(
            time=xr.DataArray(time, dims="i", attrs={"units": "ms"}),
            force=xr.DataArray(force, dims="i", attrs={"units": "mN"}),
        ),
    ):
        assert record.time == pytest.approx([0.0, 1e-3, 2e-3], rel=1e-15)
        assert record.force == pytest.approx([1e-3, 2e-3, 3e-3], rel=1e-15)


def test_a_unit_of_another_quantity_is_a_fault_by_name() -> None:
    import pint

    unit = pint.UnitRegistry()
    with pytest.raises(st.DescriptionError) as error:
        Record(time=np.arange(3.0) * unit.mm, force=np.ones(3), force_unit="ms")
    assert "Record.time: '1 millimeter' is in mm, not a unit of a time" in str(error.value)
    assert "Record.force_unit: '1 ms' is in ms, not a unit of a force" in str(error.value)
    with pytest.raises(st.DescriptionError, match="carries 'millisecond'; give one"):
        Record(time=np.arange(3.0) * unit.ms, force=np.ones(3), time_unit="s")


def test_the_zero_of_a_load_cell_is_taken_off() -> None:
    record = Record(time=[0.0, 1.0], force=[1.0, 2.0], zero="-250 mN")
    assert record.force.tolist() == [1.25, 2.25]
    assert not record.force.flags.writeable


def test_a_zero_may_have_its_uncertainty(tmp_path):
    """`analyse` refused it, and named three other commands."""
    time = np.arange(0.0, 20.0, 0.01)
    force = 1.0 + 0.1 * (time % 1.0)
    made = st.Record(time=time, force=force, zero="200 +- 50 mN", normal_load=5.0)
    path = tmp_path / "data.csv"
    np.savetxt(path, np.column_stack([time, force]), delimiter=",", header="t [s],F [N]")
    read = st.read_record(path, zero="200 +- 50 mN", normal_load="5 N")
    for record in (made, read):
        assert record.force[0] == pytest.approx(0.8)
        assert record.sensors["force"].zero_uncertainty == pytest.approx(0.05)
        assert st.analyse(record).friction.static.error == pytest.approx(0.05, rel=0.1)
    for wrong in ("0.2 +- 0.1 kg", "0.2 kg +- 0.1 N", "0.2 +- -0.1 N"):
        for read_or_make in (
            lambda zero: st.Record(time=time, force=force, zero=zero),
            lambda zero: st.read_record(path, zero=zero),
        ):
            with pytest.raises(st.DescriptionError, match="zero: ") as refused:
                read_or_make(wrong)
            assert "None" not in str(refused.value)


def test_a_record_made_again_of_its_own_fields_is_the_same() -> None:
    record = Record(
        time=[0.0, 1.0], force=[500.0, 800.0], time_unit="ms", force_unit="mN", zero="100 mN"
    )
    again = Record(**{name: getattr(record, name) for name in Record.model_fields})
    assert again.force.tolist() == record.force.tolist() == [0.4, 0.7000000000000001]
    assert again.time.tolist() == record.time.tolist() == [0.0, 1e-3]
    assert again.zero == 0.0  # known, and taken off


def test_records_are_equal_if_all_their_values_are():
    time = np.arange(20.0)
    one = st.Record(time=time, force=time)
    assert one == st.Record(time=time.copy(), force=time.copy())
    assert one != st.Record(time=time, force=time + 1.0)
    assert one != st.Record(time=time, force=time, position=time)
    assert one != st.Record(time=time, force=time, stiffness=1.0)


@pytest.mark.parametrize(("noise", "width"), [(1e-4, 1), (0.0308, 9), (1.0, 50)])
def test_the_error_of_a_load_is_that_of_a_mean_over_as_many_samples_as_it_stays_for(noise, width):
    """Of all that do not vary; else of so many that it is 1e-3 of the load, or a 400th of all."""
    draw = np.random.default_rng(1).standard_normal(20_000)
    time = 1e-3 * np.arange(len(draw))
    steady = 10.0 + noise * draw
    known = {"time": time, "force": 0.3 * steady, "normal_load": 10.0}
    found = Record(**known, load=steady).load_noise()
    assert found == pytest.approx(noise / 10.0 / len(draw) ** 0.5, rel=0.05)
    ramp = steady + np.linspace(-3.0, 3.0, len(draw))
    found = Record(**known, load=ramp).load_noise()
    assert found == pytest.approx(noise / 10.0 / width**0.5, rel=0.05)
    assert (
        Record(**known).load_noise() == Record(**known, load=0.0 * ramp + 9.0).load_noise() == 0.0
    )


@pytest.mark.parametrize(
    ("read", "remedy"),
    [
        (st.read_record, "force='2={}'"),
        (st.read_records, "force='2={}'"),
        (st.analyse, "force='2={}' of st.read_record"),
        (lambda path: main(["analyse", str(path)]), "--force '2={}'"),
    ],
)
def test_a_remedy_is_what_whoever_called_can_write(tmp_path, capsys, read, remedy):
    path = tmp_path / "a--load.csv"
    path.write_text("t [s],force\n0,1\n1,2\n2,1\n")
    with pytest.raises((ResultError, SystemExit)) as error:
        read(path)
    told = capsys.readouterr().err or str(error.value)
    assert told.rstrip().endswith(
        f"{path}: column 2 'force' states no unit of the force along the drive; say its unit: "
        f"{remedy.format('N')} makes it 1 N to 2 N, {remedy.format('mN')} makes it 1 mN to 2 mN"
    )


def test_the_channels_of_an_exported_record_are_read_again(tmp_path):
    run = st.simulate(st.presets.nakano_popov_2020(), "0.1 s", sample_rate="10 kHz")
    sensors = {"force": st.Sensor(noise="2 mN"), "position": st.Sensor(unit="m")}
    record = st.measure(run, sensors, sample_rate="1 kHz")
    for name in ("data.csv", "data.mat"):
        (path,) = record.export(tmp_path / name)
        again = st.read_record(path, position="position")
        assert again.channels().keys() == record.channels().keys() == {"force", "position"}
        np.testing.assert_array_equal(again.time, record.time)
        for channel, values in record.channels().items():
            np.testing.assert_array_equal(again.channels()[channel], values)
    with pytest.raises(st.ResultError, match="\\.csv"):
        record.export(tmp_path / "data.xyz")


def test_a_record_and_an_analysis_are_exported_like_a_run(tmp_path, paper_run) -> None:
    record = st.measure(paper_run, {"force": st.Sensor(), "position": st.Sensor(unit="m")})
    (path,) = st.export(record, tmp_path / "record.csv")
    again = st.read_record(path, position="position")
    assert np.array_equal(again.force, record.force)
    assert st.export(st.analyse(record), tmp_path / "found.csv")
    for wrong in (None, record.data, 5):
        with pytest.raises(st.DescriptionError, match="result: must be a run, a record, an analys"):
            st.export(wrong, tmp_path / "x.csv")


def test_a_record_is_a_dataset_and_a_data_frame(paper_run) -> None:
    record = st.measure(paper_run, {"force": st.Sensor(), "position": st.Sensor(unit="m")})
    frame = record.to_dataframe()
    assert frame.index.name == "time"
    assert np.array_equal(frame.index, record.time)
    for name, values in record.channels().items():
        assert np.array_equal(frame[name], values)
        assert np.array_equal(record.data[name], values)
    assert record.data["position"].attrs["units"] == "m"
    again = Record(time=record.data["time"], **{x: record.data[x] for x in record.data.data_vars})
    assert np.array_equal(again.force, record.force)


def test_all_that_does_not_go_together_is_told_at_once() -> None:
    """Of a short channel, a clock that goes back and two sensors, one was told at a time."""
    sensors = {"forse": st.Sensor(), "position": st.Sensor()}
    with pytest.raises(st.DescriptionError) as error:
        Record(time=[1.0, 0.0], force=[1.0], load=[-1.0, -3.0], sensors=sensors)
    said = str(error.value).splitlines()
    assert [each.split(";")[0] for each in said] == [
        "Record: force has 1 sample and time 2",
        "Record: time must increase",
        "Record: load must press the bodies together, its mean is -2 N",
        "Record: sensors: unknown channel 'forse'",
        "Record: sensors: that of position is in N",
    ]


def test_a_load_of_nothing_does_not_press() -> None:
    with pytest.raises(st.DescriptionError, match=r"press the bodies together, its mean is 0 N"):
        Record(time=[0.0, 1.0], force=[0.0, 1.0], load=[0.0, 0.0])
