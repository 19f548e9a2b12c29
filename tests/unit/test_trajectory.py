"""Results: the contract's variables, units, stick intervals, files."""

import pickle
import re

import h5netcdf
import numpy as np
import pytest
import xarray as xr

import stiction as st
from stiction.cli.commands.run import report_lines
from stiction.explorer import motion
from stiction.result.peak import UNSEEN, largest_spring_force
from stiction.result.rest import rest_in_words
from stiction.result.table import VARIABLES
from stiction.simulation import automatic_times
from stiction.text.quantity.wording import in_words
from stiction.text.sections import join_units

PAPER = st.presets.nakano_popov_2020()
STIFF = st.laws.LuGre(0.15, 0.2, "10 mm/s", sigma_0="1 EN/m", sigma_1="1 N s/m")
TO_AND_FRO = st.protocols.DriveProgram(along=st.protocols.Modulation("1 um/s", "1 kHz"))


@pytest.fixture(scope="module")
def run(slider):
    return st.simulate(slider, "50 ms", sample_rate="10 kHz")


def test_variables_and_units(run):
    assert set(run.data.variables) == {*VARIABLES, "time"}
    for name, (unit, _) in VARIABLES.items():
        assert run.data[name].attrs["units"] == unit
        assert run.data[name].attrs["long_name"]
    assert run.data["time"].attrs["units"] == "s"
    assert dict(run.data.sizes) == {"time": 501}
    assert run.data["u_x"].dims == ("time",)


@pytest.mark.parametrize("pick", [slice(7, None), slice(None, None, 13), [100], [0, -1]], ids=str)
def test_samples_at_times_of_ones_own_are_those_of_a_rate(slider, run, pick):
    times = run.samples["time"][pick]
    own = st.simulate(slider, "50 ms", times=times)
    assert all(np.array_equal(own.samples[name], run.samples[name][pick]) for name in VARIABLES)
    assert np.array_equal(own.stick_intervals, run.stick_intervals)
    assert st.run(run.description, times=times).samples == own.samples


@pytest.mark.parametrize("multiscale", ["auto", True, False])
def test_uneven_times_need_no_others(multiscale, tmp_path):
    times = np.sort(np.random.default_rng(0).uniform(0.0, 2.0, 40))
    its = st.simulate(PAPER, 2.0, times=times, multiscale=multiscale)
    alone = [
        st.simulate(PAPER, 2.0, times=[time], multiscale=multiscale).samples["spring_x"][0]
        for time in times
    ]
    # samples inside the cycles of a patch are held to 0.3 rtol of the friction force, 2 N
    assert np.allclose(its.samples["spring_x"], alone, rtol=0.0, atol=6e-7)
    assert st.load(its.save(tmp_path / "own.nc")) == its


def test_times_carry_a_unit_and_tell_the_duration():
    start = st.Initial(time="1 ms")
    own = st.simulate(
        PAPER, times=xr.DataArray([1.5, 3.0, 4.0], attrs={"units": "ms"}), initial=start
    )
    assert np.allclose(own.samples["time"], [1.5e-3, 3e-3, 4e-3], rtol=1e-15)
    assert own.description.run.duration == pytest.approx(3e-3, rel=1e-15)


@pytest.mark.parametrize("start", [81.06, 881.58, 1e12 / 3.0])
def test_times_at_the_ends_may_differ_from_them_by_rounding(start):
    times = [np.nextafter(start, 0.0), start + 0.5, np.nextafter(start + 1.0, np.inf)]
    own = st.simulate(PAPER, 1.0, times=times, initial=st.Initial(time=start))
    assert own.samples["time"].tolist() == [start, start + 0.5, start + 1.0]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"times": []}, "at least one, ascending"),
        ({"times": [1.0, 1.0]}, "ascending"),
        ({"times": [0.0, np.inf]}, "finite"),
        ({"times": [[1.0]]}, "one dimension"),
        ({"times": "1 s"}, "numbers"),
        ({"times": xr.DataArray([1.0], attrs={"units": "m"})}, "not a unit of a time"),
        ({"times": [-1.0, 0.1]}, "from -1 s to 100 ms, the run from 0 s to 100 ms"),
        ({"times": [0.1, 1.0], "duration": "0.5 s"}, "to 1 s, the run from 0 s to 500 ms"),
        ({"times": [0.1], "sample_rate": 10.0}, "one of the two"),
        ({"times": [0.0]}, "end at 0 s, the run starts at 0 s; give a duration"),
        ({"times": [0.5], "initial": st.Initial(time=2.0)}, "end at 500 ms, the run starts at 2 s"),
        ({"times": [0.0, 1e-150, 1.0]}, "ascending"),  # such a file could not be read back
        ({"times": [1.0, np.nextafter(1.0, 2.0)], "duration": 1.0}, "ascending"),
    ],
    ids=str,
)
def test_times_that_no_run_has_are_refused(arguments, said):
    with pytest.raises(st.DescriptionError, match=said) as found:
        st.simulate(PAPER, **arguments)
    assert [fault.path for fault in found.value.faults] == ["times"]


def test_sticks_are_a_table_of_their_own(run):
    assert dict(run.sticks.sizes) == {"stick": run.statistics.stick_count}
    assert set(run.sticks.variables) == {"stick_start", "stick_end", "stick_duration"}
    for variable in run.sticks.values():
        assert variable.attrs["units"] == "s"
        assert variable.attrs["long_name"]
    start, end = run.stick_intervals.T
    assert np.array_equal(run.sticks["stick_start"], start)
    assert np.array_equal(run.sticks["stick_end"], end)
    assert np.array_equal(run.sticks["stick_duration"], end - start)


def test_tables_of_pandas_have_one_row_a_sample_and_one_a_stick(run):
    samples, sticks = run.to_dataframe(), run.sticks.to_dataframe()
    assert len(samples) == run.data.sizes["time"] == 501
    assert samples.index.name == "time"
    assert set(samples.columns) == set(VARIABLES)
    assert len(sticks) == run.statistics.stick_count


def test_samples_are_read_only(slider, tmp_path):
    """A value that was written there changed the dataset, and each later analysis."""
    run = st.simulate(slider, "50 ms", sample_rate="1 kHz")
    for each in (run, st.load(run.save(tmp_path / "a.nc"))):
        for values in (each.samples["spring_x"], each.data["spring_x"].values):
            with pytest.raises(ValueError, match="read-only"):
                values[:] = 0.0
        frame, free = each.to_dataframe(), each.data.copy(deep=True)
        frame["u_x"] += 1.0
        free["u_x"] += 1.0
        assert frame["u_x"].iloc[-1] == free["u_x"][-1] == each.samples["u_x"][-1] + 1.0


def test_sticks_do_not_need_the_samples(slider):
    lazy = st.simulate(slider, "20 ms", sample_rate="1 kHz")
    assert lazy.sticks.sizes["stick"] == 9
    assert "data" not in vars(lazy)


@pytest.mark.parametrize("cell", [None, 0.0, 50.0])
def test_mu_is_the_share_of_the_law_s_coefficient_along_the_cell_in_steady_sliding(cell):
    law = st.ExponentialWeakening(mu_0=0.2, mu_inf=0.3, v_f=0.01)
    slider = st.presets.nakano_popov_2020().replace(
        friction=law, phi="30 deg", c_x=5.0, c_y=5.0,
        cell_angle=None if cell is None else f"{cell} deg",
    )  # fmt: skip
    run = st.simulate(slider, "40 s", sample_rate="10 Hz")
    angle = -slider.phi if cell is None else np.radians(cell)  # from the drive; by default x
    steady = law.coefficient(1e-3) * np.cos(angle)
    assert float(run.final["mu"]) == pytest.approx(steady, rel=1e-4)
    d = run.data
    along = np.hypot(d["spring_x"], d["spring_y"]) * np.cos(
        np.arctan2(d["spring_y"], d["spring_x"]) - slider.phi - angle
    )
    np.testing.assert_allclose(d["mu"], along / d["normal_load"], rtol=1e-12, atol=1e-15)


def test_variables_belong_together(run):
    d, s = run.data, run.slider
    c, n = s.direction
    V = 1e-3
    np.testing.assert_allclose(d["spring_x"], s.k_x * d["u_x"])
    np.testing.assert_allclose(d["slip_speed"], np.hypot(d["slip_x"], d["slip_y"]), rtol=1e-15)
    np.testing.assert_allclose(d["v_x"] + d["slip_x"], V * c, rtol=1e-12)
    np.testing.assert_allclose(d["v_y"] + d["slip_y"], V * n, rtol=1e-12)
    np.testing.assert_allclose(d["psi"], d["theta"] - 1.0, atol=1e-12)
    np.testing.assert_allclose(  # Eq. (6)
        d["X"], V * d["time"] - d["u_x"] * c - d["u_y"] * n, atol=1e-18
    )
    np.testing.assert_allclose(d["Y"], d["u_x"] * n - d["u_y"] * c, atol=1e-18)
    # the force points along the slip, Eq. (2)
    moving = d["slip_speed"].values > 0
    angle = np.degrees(np.arctan2(d["slip_y"], d["slip_x"]))
    np.testing.assert_allclose(d["theta"].values[moving], angle.values[moving], atol=1e-9)


def test_sticking(run):
    d = run.data
    time, stuck = d["time"].values, d["sticking"].values.astype(bool)
    inside = np.zeros_like(stuck)
    for start, end in run.stick_intervals:
        inside |= (time > start) & (time < end)
    assert np.array_equal(stuck, inside)
    assert (d["slip_speed"].values[stuck] == 0).all()
    # while stuck, friction is the force that holds: it balances the spring, up to mu_0 W
    np.testing.assert_allclose(
        d["friction"].values[stuck],
        np.hypot(d["spring_x"], d["spring_y"]).values[stuck],
        rtol=1e-12,
    )
    assert (d["friction"].values <= run.slider.F_0 * (1 + 1e-12)).all()
    assert (run.stick_intervals[:, 1] > run.stick_intervals[:, 0]).all()
    assert run.statistics.stick_count == len(run.stick_intervals)
    assert run.statistics.time_stuck == pytest.approx(np.diff(run.stick_intervals).sum(), rel=1e-12)


def test_the_paper_s_own_start_sticks_at_once(run):
    # slip of 1e-9 m/s is stopped by f = 8 m/s^2 in 1.25e-10 s
    assert float(run.data["slip_speed"][0]) == pytest.approx(1e-9, rel=1e-12)
    assert run.stick_intervals[0, 0] == pytest.approx(1.25e-10, rel=1e-6)


def test_save_and_load(run, tmp_path):
    path = run.save(tmp_path / "run.nc")
    again = st.load(path)
    assert again.data.identical(run.data)
    assert again.sticks.identical(run.sticks)
    assert np.array_equal(again.stick_intervals, run.stick_intervals)
    assert again.description == run.description
    assert again.statistics == run.statistics
    assert again.status is run.status
    with h5netcdf.File(path) as file:  # the contract, as another program sees it
        assert set(file.dimensions) == {"time"}
        assert set(file.groups) == {"sticks"}
        assert set(file["sticks"].variables) == {"stick_start", "stick_end", "stick_duration"}
        assert file.attrs["status"] == "COMPLETED"
        assert file.attrs["stiction_version"]
        assert file.attrs["solver"]


@pytest.mark.parametrize("duration", ["50 ms", "1e-11 s"])  # with sticks and without
def test_files_of_version_0_4_load(slider, tmp_path, duration):
    run = st.simulate(slider, duration, sample_rate="10 kHz")
    sticks = {name: ("stick", run.sticks[name].values) for name in ("stick_start", "stick_end")}
    beside = run.data.drop_vars("mu").assign(sticks)  # mu came later
    beside.to_netcdf(tmp_path / "old.nc", engine="h5netcdf")
    again = st.load(tmp_path / "old.nc")
    assert again.data.equals(run.data)
    assert again.data["mu"].attrs == run.data["mu"].attrs
    assert again.sticks.identical(run.sticks)


def test_save_and_load_refuse(run, tmp_path):
    with pytest.raises(st.ResultError, match="make it first"):
        run.save(tmp_path / "no" / "run.nc")
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(st.ResultError, match="no such file"):
        st.load(tmp_path / "none.nc")
    (tmp_path / "text.nc").write_text("not netcdf")
    with pytest.raises(st.ResultError, match=r"not a NetCDF file; .*st\.read_record"):
        st.load(tmp_path / "text.nc")
    run.data.drop_vars("psi").to_netcdf(tmp_path / "half.nc", engine="h5netcdf")
    with pytest.raises(st.ResultError, match="lacks psi"):
        st.load(tmp_path / "half.nc")
    run.data.to_netcdf(tmp_path / "no-sticks.nc", engine="h5netcdf")
    with pytest.raises(st.ResultError, match=r"lacks stick_start, stick_end, .* run\.save\("):
        st.load(tmp_path / "no-sticks.nc")


def test_without_sampling(slider):
    run = st.simulate(slider, 0.05, sample_rate=0)
    assert run.data["time"].values.tolist() == [0.0, 0.05]
    assert len(run.stick_intervals) > 10


def test_too_many_steps_keeps_what_was_computed(slider):
    run = st.simulate(slider, 5.0, sample_rate=1e4, max_steps=1000, multiscale=False)
    assert run.status is st.Status.TOO_MANY_STEPS
    assert "max_steps" in run.status.value
    assert 0.05 < float(run.data["time"][-1]) < 1.0
    full = st.simulate(slider, 0.05, sample_rate=1e4)
    n = full.data.sizes["time"]
    assert np.array_equal(run.data["u_y"].values[: n - 5], full.data["u_y"].values[: n - 5])


def test_pausing_changes_nothing(slider, monkeypatch):
    from stiction.solver import integrate

    whole = st.simulate(slider, 0.1, sample_rate=1e4)
    monkeypatch.setattr(integrate, "BUDGET", 7)
    fractions: list[float] = []
    paused = st.simulate(slider, 0.1, sample_rate=1e4, progress=fractions.append)
    assert paused.data.identical(whole.data)
    assert fractions == sorted(fractions)
    assert fractions[-1] == 1.0


def largest_change(run):
    """Of u_y between samples, over its span: small where the transverse motion is resolved."""
    u_y = run.data["u_y"].values
    return np.abs(np.diff(u_y)).max() / np.ptp(u_y)


def test_without_a_rate_the_motion_is_resolved(slider):
    run = st.simulate(slider, 0.05)
    time = run.data["time"].values
    assert time[0] == 0.0
    assert time[-1] == 0.05
    wanted = 20 * slider.natural_frequencies[1] * 0.05
    assert wanted <= len(time) - 1 < wanted + 1
    assert largest_change(run) < 0.2
    # samples influence nothing
    same = st.simulate(slider, 0.05, sample_rate=20e3)
    assert np.array_equal(run.stick_intervals, same.stick_intervals)


@pytest.mark.parametrize(
    ("changes", "duration", "samples"),
    [
        ({}, 1e-6, 1_000),  # however short
        ({}, 100.0, 200_000),  # the transverse motion only in part
        ({"k_y": 1e3}, 10.0, 3_222),
        ({"k_x": 1e7}, 100.0, 1_000_000),  # the slow motion, but not for ever
        ({"k_x": 1e6}, 30.0, 305_578),  # the slow motion, at 32 a period
    ],
)
def test_automatic_samples_are_limited(slider, changes, duration, samples):
    settings = st.Settings(duration=duration)
    description = st.Description(slider.replace(**changes), st.Initial(), settings)
    assert len(automatic_times(description)) == samples + 1


def test_automatic_samples_show_what_is_shaken_and_not_the_multiscale_mode(slider):
    modulation = st.protocols.Modulation("0.1 mm/s", "50 kHz")
    shaken = slider.replace(drive=st.protocols.DriveProgram(velocity="1 mm/s", along=modulation))
    settings = st.Settings(duration=0.01)
    assert len(automatic_times(st.Description(shaken, st.Initial(), settings))) == 10_001
    assert st.simulate(slider, 0.2, multiscale=True).data.sizes["time"] == 2


def test_samples_far_from_zero_are_apart(slider):
    settings = st.Settings(duration=1e-9)
    late = st.Description(slider, st.Initial(time=1e6), settings)
    assert (np.diff(automatic_times(late)) > 0).all()


@pytest.mark.parametrize("velocity", ["1 mm/s", "-1 mm/s"])
def test_the_largest_force_is_that_of_either_direction(slider, velocity, tmp_path):
    """In a notebook, in the explorer and on the command line."""
    slider = slider.replace(drive=st.ConstantVelocity(velocity))
    fine = np.abs(st.simulate(slider, "3 s", sample_rate="20 kHz").samples["spring_x"]).max()
    for rate, extent in (("2 kHz", ""), ("20 Hz", ", at least")):
        run = st.simulate(slider, "3 s", sample_rate=rate)
        force = np.abs(run.samples["spring_x"])
        told = in_words(force.max() if extent else fine, "N")
        time = run.samples["time"][force.argmax()]
        when = in_words(time, "s")
        page = re.sub("<sub>(.+?)</sub>", r"_\1", run._repr_html_())
        page = re.sub("<.+?>", " ", page)
        assert f" {join_units(f'largest k_x u_x{extent}')}  {join_units(told)} " in page
        assert f" at  {join_units(when)} " in page
        assert f"k_x u_x{extent}: {told}, " in "\n".join(report_lines(run, tmp_path / "run.nc"))
        solution, table = motion.simulate(run.description, run.samples["time"], lambda: None)
        shown = motion.facts(run.description, solution, table, None)[0]
        assert shown["name"] == f"largest k_x u_x{extent}"
        assert in_words(shown["value"], "N") == told


def test_the_largest_force_between_samples_is_found_or_said_to_be_unseen():
    """A rig's largest was that of another cycle, a sample of which lay nearer to its peak."""
    rig = st.Slider(
        mass=0.5, k_x=5e3, k_y=15e3, phi="12 deg", normal_load=15.0,
        friction=st.ExponentialWeakening(mu_0=0.3, mu_inf=0.2, v_f=0.02),
        drive=st.ConstantVelocity(5e-3),
    )  # fmt: skip
    for start in (0.0, 0.3e-3):  # m: from rest, and from a stretched spring
        begin = st.Initial(u_x=start, u_y=start)
        fine = st.simulate(rig, 2.0, sample_rate=2e5, initial=begin).samples
        wanted = np.abs(fine["spring_x"]).max()
        for rate in (None, 2e3, 200.0, 60.0, 20.0, 5.0):
            run = st.simulate(rig, 2.0, sample_rate=rate, initial=begin)
            found = largest_spring_force(run.samples, rig.k_x)
            if found.shown:
                # UNSEEN of it at most may be missed, of which doubling the step showed no trace
                assert found.force == pytest.approx(wanted, rel=UNSEEN if rate else 1e-5)
            else:
                assert found.force == np.abs(run.samples["spring_x"]).max() <= wanted
            assert found.shown or rate in (60.0, 20.0, 5.0)


def test_a_run_equals_itself_again_loaded_and_copied(run, slider, tmp_path):
    again = st.simulate(slider, "50 ms", sample_rate="10 kHz")
    assert run == again
    assert hash(run) == hash(again)
    assert run == st.load(run.save(tmp_path / "a.nc"))
    assert run == pickle.loads(pickle.dumps(run))
    assert run != st.simulate(slider, "50 ms", sample_rate="20 kHz")
    assert run != st.simulate(slider.replace(mass="251 g"), "50 ms", sample_rate="10 kHz")


def test_samples_are_a_mapping(run):
    assert [*run.samples] == [*run.samples.columns]
    assert len(run.samples) == len(VARIABLES) + 1
    assert "u_x" in run.samples
    assert "ux" not in run.samples
    with pytest.raises(KeyError, match="unknown column 'ux'; did you mean 'u_x'"):
        run.samples["ux"]


def test_a_largest_force_that_samples_cannot_show_is_a_lower_bound():
    """The sample is that next to the peak; one whose cubic is off by 5e-3 hides more than that."""
    time = np.arange(7.0)
    samples = {"time": time, "u_x": 1.0 - 0.1 * (time - 3.3) ** 2, "v_x": -0.2 * (time - 3.3)}
    found = largest_spring_force(samples, 2.0)
    assert (found.time, found.force) == pytest.approx((3.3, 2.0))
    assert (found.sample, found.shown) == (3, True)
    samples["u_x"] = samples["u_x"] + np.where(time == 2.0, 5e-3, 0.0)
    assert not largest_spring_force(samples, 2.0).shown


@pytest.mark.parametrize(
    ("changes", "remedy"),
    [
        ({}, "about 2 s to load a spring to the 2 N that friction can hold; set a longer duration"),
        (
            {"friction": STIFF},
            "to the 1.995 N that friction can hold; set a longer duration",
        ),
        ({"drive": st.ConstantVelocity(0.0)}, "the drive is at rest; give it a velocity"),
        ({"drive": TO_AND_FRO}, "held all the time; run it longer"),
    ],
)
def test_a_remedy_suits_a_mass_that_never_slips(changes, remedy):
    run = st.simulate(PAPER.replace(**changes), "5 ms", sample_rate="1 kHz")
    assert rest_in_words(run.slider, run.samples, run.statistics.steps).endswith(remedy)


@pytest.mark.parametrize("rate", ["0.5 Hz", "0.09 Hz"])
def test_a_mass_that_slips_between_samples_slips(rate):
    """It moved by 8 mm, and it was said that it never slipped."""
    run = st.simulate(PAPER.replace(phi="0 deg"), "10 s", sample_rate=rate)
    assert rest_in_words(run.slider, run.samples, run.statistics.steps) == ""


def test_one_thing_is_not_several_things_of_it(slider):
    run = st.simulate(slider, "1 ms", times=[1e-3])
    assert repr(run) == "<Trajectory to 0.001 s, 1 sample, 1 stick, COMPLETED>"


def test_the_line_of_a_run_ends_where_the_run_did():
    """The last sample stood for the end: "to 1 s" of a run over 1.5 s."""
    slider = st.presets.nakano_popov_2020()
    assert "to 1.5 s, 2 samples" in repr(st.simulate(slider, "1.5 s", sample_rate="1 Hz"))
    later = st.Initial(time="2 s")
    assert "to 2.25 s" in repr(st.simulate(slider, "0.25 s", sample_rate="8 Hz", initial=later))
