"""Sensors and synthetic measurements."""

import numpy as np
import pint
import pytest
from tests.drawn import inside

import stiction as st

RATE = 1e4


@pytest.fixture(scope="module")
def run():
    return st.simulate(st.presets.nakano_popov_2020(), "0.2 s", sample_rate=RATE)


def test_a_perfect_sensor_records_what_its_load_cell_does(run):
    record, plain = st.measure(run, st.Sensor()), st.analysis.record_of(run)
    assert np.array_equal(record.force, plain.force)
    assert np.allclose(record.time, plain.time, rtol=1e-13)
    for name in ("stiffness", "mass", "normal_load", "drive_velocity"):
        assert getattr(record, name) == getattr(plain, name)
    assert record.position is None  # it has no sensor


def test_the_same_seed_gives_the_same_record(run):
    sensor = st.Sensor(noise="2 mN")
    first, again, other = (st.measure(run, sensor, seed=seed).force for seed in (1, 1, 2))
    assert np.array_equal(first, again)
    assert not np.array_equal(first, other)
    off = first - st.analysis.record_of(run).force
    assert off.std() == pytest.approx(2e-3, rel=4.0 / (2 * len(off)) ** 0.5)


def test_gain_zero_and_quantisation(run):
    sensor = st.Sensor(gain=1.1, zero="-20 mN", quantisation="5 mN")
    record, plain = st.measure(run, sensor), st.analysis.record_of(run)
    readings = 1.1 * plain.force - 0.02
    assert np.abs(record.force - readings).max() <= 2.5e-3 * (1.0 + 1e-12)
    assert np.allclose(record.force / 5e-3, np.rint(record.force / 5e-3), atol=1e-9)
    assert np.abs(sensor.value(record.force) - plain.force).max() <= 2.5e-3 / 1.1 * (1.0 + 1e-12)
    known = record.sensors["force"]
    assert (known.gain, known.zero) == (1.0, 0.0)  # the analyst does not know them


@pytest.mark.parametrize(("cut", "order"), [("bandwidth", 1), ("filter", 4)])
def test_a_filter_has_its_cut_off_where_it_is_stated(cut, order):
    """|H| is 2^-1/2 at the cut-off, and falls as f^-order: closed forms of Butterworth."""
    sensor = st.Sensor(**{cut: "100 Hz"})
    time = np.arange(0.0, 2.0, 1.0 / RATE)
    for frequency in (20.0, 100.0, 400.0):
        out = sensor.response(np.sin(2.0 * np.pi * frequency * time), RATE)[len(time) // 2 :]
        warped = np.tan(np.pi * frequency / RATE) / np.tan(np.pi * 100.0 / RATE)
        gain = (1.0 + warped ** (2 * order)) ** -0.5
        assert np.sqrt(2.0 * np.mean(out**2)) == pytest.approx(gain, rel=2e-3)


def test_a_run_too_coarse_for_a_filter_or_a_rate_is_refused(run):
    with pytest.raises(
        st.ResultError, match="a filter at 6000 Hz needs samples at 15000 Hz or mor"
    ):
        st.measure(run, st.Sensor(bandwidth="6 kHz"))
    with pytest.raises(st.ResultError, match="5 is not a run; make one with"):
        st.measure(5, st.Sensor())
    for sensor in (5, {"force": 5}):
        with pytest.raises(
            st.ResultError, match=r"is not a sensor, .* write for example st.Sensor"
        ):
            st.measure(run, sensor)
    with pytest.raises(st.ResultError, match="the record is to have 20000"):
        st.measure(run, st.Sensor(), sample_rate="20 kHz")
    with pytest.raises(st.ResultError, match="'forc' is not a channel"):
        st.measure(run, {"forc": st.Sensor()})


def test_every_channel_of_a_run_can_be_recorded(run):
    length, force = st.Sensor(unit="m"), st.Sensor()
    sensors = {
        "force": force,
        "force_across": force,
        "load": force,
        "position": length,
        "drive_position": length,
        "slip_speed": st.Sensor(unit="m/s"),
    }
    record = st.measure(run, sensors, sample_rate=2e3)
    every = run.data.isel(time=slice(0, None, 5))
    assert np.allclose(record.force_across, every["spring_y"], rtol=1e-9, atol=1e-12)
    assert np.allclose(record.position, every["X"], rtol=1e-9, atol=1e-15)
    travel = 1e-3 * np.cos(run.slider.misalignment) * every["time"]  # along the cell
    assert np.allclose(record.drive_position, travel, rtol=1e-9, atol=1e-15)
    assert record.load.tolist() == [10.0] * len(record)
    assert record.sample_rate == pytest.approx(2e3, rel=1e-9)


def test_a_sensor_reads_levels_in_the_unit_of_its_channel():
    assert st.Sensor(unit="m", noise="3 um").noise == 3e-6
    with pytest.raises(st.DescriptionError) as error:
        st.Sensor(noise="3 um", zero="2 mm", quantisation=-1.0)
    assert "Sensor.noise: '3 um' is in µm, not a unit of a force" in str(error.value)
    assert "Sensor.zero: '2 mm' is in mm" in str(error.value)
    with pytest.raises(st.DescriptionError, match="gain is 0"):
        st.Sensor(gain=0.0)
    with pytest.raises(
        st.DescriptionError, match="that of position is in N; make it with unit='m'"
    ):
        st.Record(time=[0, 1], force=[1, 2], sensors={"position": st.Sensor()})


def test_estimates_return_what_a_measurement_was_made_with(run, tmp_path):
    sensor = st.Sensor(noise="3 mN", quantisation="1 mN")
    made = st.measure(run, sensor, seed=3)
    rows = "".join(f"{t:.6f},{f:.4f}\n" for t, f in zip(made.time, made.force, strict=True))
    (tmp_path / "a.csv").write_text(f"time [s],force [N]\n{rows}")
    found = st.read_record(tmp_path / "a.csv").sensors["force"]
    assert found.quantisation == pytest.approx(1e-3, rel=1e-9)
    # standard error of the median of |x| over 2000 correlated differences: 4 %
    assert found.noise == pytest.approx(3e-3, rel=0.12)


# --- a zero that drifts ---------------------------------------------------------------------------


# gain, zero (N), drift (N/s), and the time of the first sample (s)
DRIFTS = inside(20, (0.5, 2.0), (-0.1, 0.1), (-0.01, 0.01), (-50.0, 50.0))


@pytest.mark.parametrize(("gain", "zero", "drift", "start"), DRIFTS)
def test_the_zero_of_the_first_sample_is_the_stated_one_and_drifts_from_there_on(
    gain, zero, drift, start
):
    sensor = st.Sensor(gain=gain, zero=zero, zero_drift=drift, noise="2 mN")
    time = start + np.arange(0.0, 20.0, 0.02)
    values = 2.0 + np.sin(time)
    shown = sensor.readings(values, 5, time)
    still = st.Sensor(gain=gain, zero=zero, noise="2 mN").readings(values, 5)
    # rounding of sums below 10 N
    assert np.abs(shown - still - drift * (time - start)).max() < 1e-14
    noise = still - gain * values - zero
    assert np.abs(sensor.value(shown, time) - values - noise / gain).max() < 1e-13
    rest = sensor.behind()
    assert (rest.zero, rest.zero_drift) == (0.0, 0.0)


def test_a_measurement_drifts_and_its_record_knows_only_by_how_much_it_may(run):
    still = st.Sensor(gain=-2.0, zero="-20 mN", noise="2 mN")
    drifting = still.model_copy(update={"zero_drift": 0.3, "zero_drift_uncertainty": 0.1})
    plain, found = (st.measure(run, each, sample_rate=2e3, seed=3) for each in (still, drifting))
    assert np.abs(found.force - plain.force - 0.3 * (found.time - found.time[0])).max() < 1e-14
    known = found.sensors["force"]
    assert (known.zero_drift, known.zero_drift_uncertainty) == (0.0, 0.05)
    assert plain.sensors["force"].zero_drift_uncertainty == 0.0


@pytest.mark.parametrize(
    ("unit", "written", "size"),
    [("N", "mN/min", 1e-3 / 60.0), ("N", "N/h", 1.0 / 3600.0), ("m", "um/min", 1e-6 / 60.0),
     ("m/s", "mm/s^2", 1e-3)],
)  # fmt: skip
def test_a_drift_is_stated_in_units_of_the_channel_over_time(unit, written, size):
    for drift, error in inside(10, (-9.0, 9.0), (0.0, 9.0)):
        both = st.Sensor(unit=unit, zero_drift=f"{drift!r} +- {error!r} {written}")
        apart = st.Sensor(
            unit=unit,
            zero_drift=f"{drift!r} {written}",
            zero_drift_uncertainty=f"{error!r} {written}",
        )
        assert both == apart
        assert both.zero_drift == pytest.approx(drift * size, rel=1e-14)
        assert both.zero_drift_uncertainty == pytest.approx(error * size, rel=1e-14)


def test_gain_and_zero_may_have_their_uncertainty_in_one_text():
    found = st.Sensor(gain="1.1 +- 0.01", zero="3 ± 1 mN")
    assert found == st.Sensor(gain=1.1, gain_uncertainty=0.01, zero="3 mN", zero_uncertainty="1 mN")


def test_a_drift_that_cannot_be_is_refused_with_the_remedy(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("time [s],force [N]\n0,1\n1,2\n2,3\n")
    stated = {
        "3 mN": "'3 mN' is in mN, not a unit of a force over time; write for example '5 mN/min'",
        "0 +- 5 mN": "'5 mN' is in mN",
        "0 +- -1 mN/s": "its uncertainty must not be below 0, is '-1 mN/s'",
    }
    for text, message in stated.items():
        path.with_suffix(".toml").write_text(f'[sensors.force]\nzero_drift = "{text}"\n')
        with pytest.raises(st.DescriptionError) as error:
            st.read_record(path)
        assert message in str(error.value)
        assert f"{path.with_suffix('.toml')}: sensors.force.zero_drift" in str(error.value)
    with pytest.raises(st.DescriptionError, match="zero_uncertainty is another; leave out one"):
        st.Sensor(zero="3 +- 1 mN", zero_uncertainty="1 mN")
    with pytest.raises(st.ResultError, match="the zero depends on the time; give the times"):
        st.Sensor(zero_drift=1e-3).value(np.zeros(3))


@pytest.mark.parametrize(("_", "zero", "drift", "start"), DRIFTS[:5])
def test_a_file_beside_a_record_states_the_drift_and_the_record_keeps_its_uncertainty(
    tmp_path, _, zero, drift, start
):
    time = start + np.arange(0.0, 20.0, 0.1)
    force = 1.0 + np.sin(time)
    shown = 2.0 * force + zero + drift * (time - start)
    rows = "".join(f"{t!r},{f!r}\n" for t, f in zip(time.tolist(), shown.tolist(), strict=True))
    (tmp_path / "a.csv").write_text(f"time [s],force [N]\n{rows}")
    (tmp_path / "a.toml").write_text(
        f'[sensors.force]\ngain = 2.0\nzero = {zero!r}\nzero_drift = "{1e3 * drift!r} +- 4 mN/s"\n'
    )
    record = st.read_record(tmp_path / "a.csv")
    assert np.abs(record.force - force).max() < 1e-13
    again = st.read_record(record.save(tmp_path / "a.nc"))
    for each in (record, again):
        assert each.sensors["force"].zero_drift_uncertainty == pytest.approx(2e-3, rel=1e-14)
        assert each.sensors["force"].zero_drift == 0.0


def test_what_is_known_of_a_zero_is_less_later_in_the_record():
    for zero, drift, zero_error, drift_error in inside(20, *[(-1.0, 1.0)] * 2, *[(0.0, 1.0)] * 2):
        sensor = st.Sensor(
            zero=zero, zero_drift=drift,
            zero_uncertainty=zero_error, zero_drift_uncertainty=drift_error,
        )  # fmt: skip
        once, twice = sensor.later(3.0), sensor.later(1.0)
        assert once.zero == pytest.approx(zero + 3.0 * drift, abs=1e-14)
        assert twice.zero_uncertainty <= once.zero_uncertainty <= zero_error + 3.0 * drift_error
        assert once.zero_drift_uncertainty == drift_error
        assert sensor.later(0.0) == sensor


def test_a_level_may_be_a_quantity():
    assert st.Sensor(noise=pint.Quantity(2, "mN")).noise == st.Sensor(noise="2 mN").noise


def test_a_record_of_a_varying_load_states_no_load():
    """It stated that at the start, 10 N, which its own channel contradicted."""
    load = st.protocols.LoadProgram(program=[st.protocols.Ramp("20 N", "0.1 s")])
    steady = st.presets.nakano_popov_2020()
    run, other = (
        st.simulate(slider, "0.1 s", sample_rate="1 kHz")
        for slider in (steady.replace(load=load), steady)
    )
    quiet = st.Sensor(noise="2 mN")
    assert st.measure(run, {"force": quiet, "load": quiet}).stated_load is None
    assert st.measure(other, {"force": quiet, "load": quiet}).stated_load == 10.0
    assert st.measure(run, quiet).stated_load == 10.0
