"""Studies: description, layout, run, interruption, continuation."""

from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import stiction as st
from stiction import machine
from stiction.study.execution.engines import Processes, Threads
from stiction.study.plan.coordinates import unit, values, vary
from stiction.study.plan.layout import Layout, layout_of, places
from stiction.study.store.creation import create
from stiction.study.store.seal import seal
from stiction.study.store.store import ENDS
from stiction.text.paths import with_changes

PAPER = st.presets.nakano_popov_2020()
BASE = st.Description(PAPER, st.Initial(), st.Settings(duration="30 ms"))
AXES = {
    "phi": st.Grid("1 deg", "5 deg", 5),
    "drive.velocity": st.Grid("1 mm/s", "100 mm/s", 3, spacing="log"),
}
AXIS = "[axes.phi]\nvalues = ['2 deg']\n"
MEASURES = ("peak_force", "stick_count", "time_stuck")


@pytest.fixture
def study() -> st.Study:
    return st.Study(base=BASE, axes=AXES, measures=MEASURES)


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """A study with runs that fail among others, done undisturbed."""
    path = tmp_path_factory.mktemp("study") / "a.zarr"
    return path, st.sweep(st.Study(base=BASE, axes=AXES, measures=MEASURES), path)


def test_a_run_is_described_by_its_values_as_by_its_indices(finished, study):
    data = st.open_study(finished[0])
    for index in np.ndindex(study.layout.shape):
        cell = data.isel(dict(zip(study.layout.dims, index, strict=True)))
        at = {dim: cell[dim] for dim in study.layout.dims}  # with units, as a store has them
        assert study.description(at) == study.description(index)
    assert study.description({"V": 1.2e-3, "phi": "2.9 deg"}) == study.description((2, 0))


@pytest.mark.parametrize(
    ("at", "said"),
    [
        ({"phi": 2.0, "v": 1}, ["at.phi: degree or radian", "at.v: unknown", "velocity: missing"]),
        (
            {"phi": "9 deg", "V": "1 m"},
            ["9 deg is beyond the study", "at.drive.velocity: '1 m' is"],
        ),
        ({}, ["at.phi: missing", "at.drive.velocity: missing"]),
        ((1,), ["at: (1,) is not a run of the study, of phi (5), drive.velocity (3)"]),
        ((5, 0), ["at: (5, 0) is not a run of the study"]),
        ((1.5, 0), ["at: (1.5, 0) is not a run of the study"]),
        (3, ["at: 3 is not a run of the study"]),
    ],
)
def test_what_is_not_a_run_is_told(study, at, said):
    with pytest.raises(st.DescriptionError) as error:
        study.description(at)
    assert [words for words in said if words not in str(error.value)] == []
    assert len(error.value.faults) == len(said)


def test_runs_whose_parameters_vary_together_go_by_their_number():
    axes = {"phi": st.Sobol("1 deg", "3 deg", 4), "mass": st.Sobol(0.1, 0.2, 4)}
    study = st.Study(base=BASE, axes=axes)
    assert study.description((2,)).slider.mass == study.coordinates["mass"].values[2]
    with pytest.raises(st.DescriptionError, match=r"at\.sample: counts the runs"):
        study.description({"sample": 2})


def test_each_value_is_that_of_the_run_by_itself(finished):
    """The solver is deterministic: no tolerance."""
    data = xr.open_zarr(finished[0])
    assert dict(data.sizes) == {"phi": 5, "drive.velocity": 3}
    assert (data["status"] == 0).all()
    for index in ((0, 0), (4, 2), (2, 1)):
        at = data.isel(dict(zip(data["status"].dims, index, strict=True)))
        slider = PAPER.replace(
            phi=f"{float(at['phi'])} deg", drive=st.ConstantVelocity(float(at["drive.velocity"]))
        )
        run = st.simulate(slider, "30 ms")
        assert int(at["stick_count"]) == run.statistics.stick_count
        assert float(at["time_stuck"]) == pytest.approx(run.statistics.time_stuck, rel=1e-9)


def test_the_store_explains_itself(finished, study):
    data = st.open_study(finished[0])
    np.testing.assert_array_equal(data["phi"], [1.0, 2.0, 3.0, 4.0, 5.0])
    np.testing.assert_allclose(data["drive.velocity"], [1e-3, 1e-2, 1e-1], rtol=1e-15)
    assert data["phi"].attrs == {"units": "deg", "long_name": "phi"}
    assert data["drive.velocity"].attrs["units"] == "m/s"
    for name in MEASURES:
        assert {"units", "long_name"} <= data[name].attrs.keys()
    meanings = data["status"].attrs["flag_meanings"].split()
    assert len(meanings) == len(data["status"].attrs["flag_values"])
    assert st.Study.from_json(data.attrs["description"]).to_json() == study.to_json()


def test_a_study_tells_runs_of_too_many_sticks_in_a_place_of_their_own(tmp_path, monkeypatch):
    """Stores of earlier versions have "refused" and "error" where they were."""
    monkeypatch.setattr(machine, "largest_object", lambda: 1e6)
    study = st.Study(
        base=st.Description.of(PAPER, "60 s"), axes={"phi": st.Values(["1 deg", "30 deg"])},
        measures=["stick_count"],
    )  # fmt: skip
    result = st.sweep(study, tmp_path / "a.zarr")
    assert result.failed == {"too_many_sticks": 1}
    assert "no more of them fit into the memory" in result.first.message
    assert ENDS.index("refused") == 5
    assert ENDS.index("error") == 6


def test_a_run_that_fails_is_data(tmp_path):
    """Contact is lost where the load's modulation exceeds it; mu_static below mu_0 is refused."""
    shaken = PAPER.replace(
        load=st.protocols.LoadProgram(modulation=st.protocols.Modulation("1 N", "50 Hz"))
    )
    axes = {
        "load.modulation.amplitude": st.Values([1.0, 11.0]),
        "friction.mu_static": st.Values([0.22, 0.18]),
        "friction.mu_0": st.Values([0.2, 0.17]),
    }
    base = BASE._replace(slider=shaken)
    result = st.sweep(st.Study(base=base, axes=axes, measures=["peak_force"]), tmp_path / "a.zarr")
    data = xr.open_zarr(tmp_path / "a.zarr").load()
    meanings = dict(enumerate(data["status"].attrs["flag_meanings"].split(), -1))
    found = [meanings[int(code)] for code in data["status"].values.ravel()]
    lost = ["contact_lost", "contact_lost", "refused", "contact_lost"]
    assert found == ["completed", "completed", "refused", "completed", *lost]
    np.testing.assert_array_equal(np.isfinite(data["peak_force"]), data["status"] == 0)
    np.testing.assert_array_equal(data["message"] == "", data["status"] == 0)
    assert result.failed == {"contact_lost": 3, "refused": 2}
    assert result.first.end == "refused"
    assert "mu_static" in result.first.message
    assert "friction.mu_static = 0.18, friction.mu_0 = 0.2:" in str(result.first)


def test_what_was_stopped_goes_on_and_comes_out_the_same(tmp_path, study, finished):
    def stop(tally):
        if tally.now >= 4:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        st.sweep(study, tmp_path / "a.zarr", engine=Threads(2), progress=stop)
    part = xr.open_zarr(tmp_path / "a.zarr").load()
    left = int((part["status"] == -1).sum())
    assert 0 < left < 15
    tallies = []
    result = st.sweep(study, tmp_path / "a.zarr", progress=tallies.append)
    assert (result.pending, result.failed) == (0, {})
    assert tallies[-1].now == left
    assert tallies[-1].before == 15 - left
    whole = xr.open_zarr(tmp_path / "a.zarr").load()
    xr.testing.assert_identical(whole, xr.open_zarr(finished[0]).load())
    assert st.sweep(study, tmp_path / "a.zarr") == result  # nothing left to do


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"rtol": 1e-5}, r"run\.rtol is 1e-06 there and 1e-05 here"),
        ({"friction.mu_0": 0.3}, r"friction\.mu_0 is 0\.2 there and 0\.3 here"),
        ({"axes.phi.values": ["1 deg", "4 deg"]}, r"axes\.phi\.values\.2 is '2 deg' there and '4"),
    ],
)
def test_a_store_of_another_study_says_what_differs(change, words, tmp_path):
    axes = {"phi": st.Values(["1 deg", "2 deg"])}
    study = st.Study(base=BASE, axes=axes, measures=["peak_force"])
    create(study, tmp_path / "a.zarr")
    other = st.Study.from_dict(with_changes(study.to_dict(), change)[0])
    with pytest.raises(st.ResultError, match=words):
        st.sweep(other, tmp_path / "a.zarr")


def test_a_change_of_a_parameter_that_varies_is_refused(tmp_path):
    """The values of the axis replaced it without a word."""
    file = tmp_path / "study.toml"
    axes = '[axes.phi]\nfrom = "1 deg"\nto = "2 deg"\ncount = 2\n[axes.V]\nvalues = ["1 mm/s"]\n'
    file.write_text(BASE.to_toml() + axes)
    for name in ("phi", "slider.phi"):
        with pytest.raises(st.DescriptionError, match=r"change 'axes\.phi\.from' and 'axes\."):
            st.Study.from_toml(file, {name: "3 deg"})
    with pytest.raises(st.DescriptionError, match=r"change 'axes\.V\.values' instead"):
        st.Study.from_toml(file, {"drive.velocity": "3 mm/s"})
    changed = st.Study.from_toml(file, {"axes.phi.to": "9 deg", "mass": "1 kg"})
    assert changed.axes["phi"].stop == "9 deg"


def test_a_dataset_in_place_of_its_store_is_told_its_path(finished, study):
    data = st.open_study(finished[0])
    for verb in (st.map, st.open_study, st.load, lambda path: st.sweep(study, path)):
        with pytest.raises(
            st.DescriptionError, match=r"is a Dataset from '.*zarr': give that path"
        ):
            verb(data)
    with pytest.raises(st.DescriptionError, match="store: must be text or a path, is None"):
        st.map(None)  # it was "damaged: TypeError"


def test_another_study_s_store_is_refused(finished, tmp_path):
    other = st.Study(base=BASE, axes={"phi": AXES["phi"]}, measures=MEASURES)
    with pytest.raises(
        st.ResultError, match=r"another study: axes\.drive\.velocity is .* nothing h"
    ):
        st.sweep(other, finished[0])
    (tmp_path / "empty").mkdir()
    with pytest.raises(st.ResultError, match="not the store of a study"):
        st.sweep(other, tmp_path / "empty")
    with pytest.raises(st.ResultError, match="make it first"):
        st.sweep(other, tmp_path / "no" / "a.zarr")
    with pytest.raises(st.ResultError, match="no such store"):
        st.open_study(tmp_path / "a.zarr")


def test_every_fault_of_a_study_is_told_at_once():
    axes = {
        "phi": st.Grid("1 deg", 5, 3),
        "drive.velocty": st.Grid(1e-3, 1e-2, 3),
        "mass": st.Grid("0 kg", "1 kg", 3, spacing="log"),
        "k_x": st.Values(["1 N"]),
        "run.multiscale": st.Values([1]),
    }
    with pytest.raises(st.DescriptionError) as error:
        st.Study(base=BASE, axes=axes)
    text = str(error.value)
    assert "Study.axes.phi.to: degree or radian? write '5 deg' or '5 rad'" in text
    assert "Study.axes.drive.velocty: unknown parameter 'drive.velocty'; did you mean" in text
    assert "Study.axes.mass: logarithms need values of one sign" in text
    assert "Study.axes.k_x.1: '1 N' is in N, not a unit of" in text
    assert "Study.axes.run.multiscale: is not one number" in text


def test_an_unknown_key_is_told_beside_the_keys_of_its_table():
    text = "[study]\nmeasurs = []\ncolour = 1\n[axes.phi]\nvalues = ['2 deg']\n"
    with pytest.raises(st.DescriptionError) as error:
        st.Study.from_toml(BASE.to_toml() + text)
    assert [str(fault) for fault in error.value.faults] == [
        "study.measurs: unknown key 'measurs'; did you mean 'measures'?",
        "study.colour: unknown key 'colour'; known: measures, seed, trace_samples, traces",
    ]


@pytest.mark.parametrize(
    ("before", "after", "faults"),
    [
        ("study = 3\n", AXIS, ["study: must be a table [study], is 3"]),
        ("", "", ["axes: missing; write for example a table [axes.phi]"]),
        (
            "",
            "[study]\naxes = 1\nbase = 2\n",
            [
                "study.axes: is not a key of this table; write [axes.phi]",
                "study.base: is not a key of this table; write [slider], [friction], [drive] and "
                "[run]",
            ],
        ),
        (
            "",
            '[study]\nmeasures = ["peak_forse"]\nbase = 2\n',
            [
                "study.base: is not a key of this table; write [slider], [friction], [drive] and "
                "[run]",
                "axes: missing; write for example a table [axes.phi]",
                "study.measures: unknown measure 'peak_forse'; did you mean 'peak_force'?",
            ],
        ),
        (
            "",
            f"[study]\nmeasurs = []\nseed = -1\n{AXIS}",
            [
                "study.measurs: unknown key 'measurs'; did you mean 'measures'?",
                "study.seed: must not be below 0, is -1",
            ],
        ),
    ],
)
def test_a_study_s_own_table_has_the_faults_of_its_own(before, after, faults):
    with pytest.raises(st.DescriptionError) as error:
        st.Study.from_toml(before + BASE.to_toml() + after)
    assert [str(fault) for fault in error.value.faults] == faults


def test_an_invalid_value_is_a_fault_of_its_own_axis_alone():
    axes = {"phi": st.Grid("1 deg", "95 deg", 3), "mass": st.Values(["-1 kg", "-2 kg"])}
    with pytest.raises(st.DescriptionError) as error:
        st.Study(base=BASE, axes=axes)
    assert [fault.path for fault in error.value.faults] == ["Study.axes.phi", "Study.axes.mass"]
    phi, mass = (fault.message for fault in error.value.faults)
    assert phi.startswith("must lie between")
    assert mass == "must be greater than 0, is -1.0"


@pytest.mark.parametrize(
    ("axes", "says"),
    [
        ({}, "at least one axis"),
        ({"phi": st.Grid("1 deg", "95 deg", 3)}, "must lie between -90 deg and 90 deg, is 95 deg"),
        ({"phi": {"from": "1 deg", "count": 3}}, "axes.phi.to: missing"),
        ({"phi": {"from": "1 deg", "to": "2 deg", "count": 0}}, "axes.phi.count: must not be"),
        (
            {"phi": {"low": "1 deg", "to": "2 deg", "count": 3}},
            "axes.phi.low: unknown key 'low'; known: along, count, from, sampling, spacing, to",
        ),
        ({"phi": {"low": "1 deg", "to": "2 deg", "count": 3}}, "axes.phi.from: missing"),
        ({"phi": {"values": ["1 deg"], "form": 3}}, "axes.phi.form: unknown key 'form'"),
        ({"phi": {"values": []}}, "is not a list of values"),
        ({"phi": {"sampling": "sobl"}}, "did you mean 'sobol'"),
        ({"phi": 3}, "3 is not an axis; write for example st.Grid("),
        ({"mass": [0.1, 0.2]}, "[0.1, 0.2] is not an axis; write for example st.Values(["),
        ({"phi": st.Values(["1 deg"], "regime")}, "axes.phi.along: cannot be 'regime'"),
        ({"phi": st.Values(["1 deg"], "../a")}, "axes.phi.along: cannot be '../a'"),
        ({"k_x, mass": st.Values([1.0])}, "cannot share one value"),
        ({"k_x": st.Values([1.0]), "k_x, k_y": st.Values([1.0])}, "has an axis already"),
        (
            {"k_x": st.Values([1.0], "a"), "k_y": st.Values([1.0, 2.0], "a")},
            "has 2 values and k_x has 1 along 'a'",
        ),
    ],
)
def test_an_axis_that_cannot_be(axes, says):
    with pytest.raises(st.DescriptionError) as error:
        st.Study(base=BASE, axes=axes)
    assert says in str(error.value)


def test_axes_along_one_dimension_go_together(tmp_path):
    axes = {
        "k_x": st.Grid("1 kN/m", "3 kN/m", 3, along="spring"),
        "k_y": st.Values([1e6, 2e6, 4e6], along="spring"),
        "friction.mu_0, friction.mu_inf": st.Values([0.1, 0.2]),
    }
    study = st.Study(base=BASE, axes=axes, measures=["peak_force"])
    slider = study.description((1, 0)).slider
    assert (slider.k_x, slider.k_y) == (2e3, 2e6)
    assert (slider.law.mu_0, slider.law.mu_inf) == (0.1, 0.1)
    st.sweep(study, tmp_path / "a.zarr")
    data = xr.open_zarr(tmp_path / "a.zarr")
    assert data["peak_force"].dims == ("spring", "friction.mu_0, friction.mu_inf")
    assert data["k_y"].dims == ("spring",)
    assert "k_y" in data.coords


@pytest.mark.parametrize("kind", [st.Random, st.Sobol])
def test_samples_depend_on_the_seed_and_their_place_alone(kind):
    def made(count, seed):
        axes = {"phi": kind("1 deg", "9 deg", count), "k_x": kind(1e2, 1e4, count, "log")}
        found = st.Study(base=BASE, axes=axes, seed=seed).coordinates
        assert {each.dim for each in found.values()} == {"sample"}
        return np.array([found["phi"].values, found["k_x"].values])

    few, many, other = made(32, 1), made(64, 1), made(64, 2)
    np.testing.assert_array_equal(few, many[:, :32])
    assert not np.isin(many, other).any()
    assert many[0].min() >= 1.0
    assert many[0].max() <= 9.0
    assert not np.array_equal((many[0] - 1.0) / 8.0, np.log(many[1] / 1e2) / np.log(1e2))
    # half of the values lie below the middle: to within 4 standard deviations, exactly for Sobol
    below = [(many[0] < 5.0).sum(), (many[1] < 1e3).sum()]
    assert below == [32, 32] if kind is st.Sobol else np.abs(np.array(below) - 32).max() <= 16


def test_any_parameter_can_vary():
    grain = PAPER.replace(
        friction=st.laws.Anisotropic(PAPER.law, 1.2, "30 deg"),
        drive=st.protocols.DriveProgram(
            velocity="1 mm/s",
            program=[st.protocols.Constant(duration=1.0), st.protocols.Ramp("2 mm/s", "1 s")],
            across=st.protocols.Modulation("0.1 mm/s", "50 Hz", "90 deg"),
        ),
        load=st.protocols.LoadProgram(program=[st.protocols.Ramp("20 N", "1 s")]),
    )
    base = st.Description(grain, st.Initial(u_x="1 um"), st.Settings(duration=1.0))
    for path, its, value, read in (
        ("c_x", "N*s/m", 0.5, lambda d: d.slider.c_x),
        ("friction.mu_inf", "", 0.1, lambda d: d.slider.law.law.mu_inf),
        ("friction.ratio", "", 1.5, lambda d: d.slider.law.ratio),
        ("friction.angle", "deg", 45.0, lambda d: np.degrees(d.slider.law.angle)),
        ("drive.program.2.to", "m/s", 3e-3, lambda d: d.slider.drive.program[1].to),
        ("drive.across.amplitude", "m/s", 2e-4, lambda d: d.slider.drive.across.amplitude),
        ("drive.across.frequency", "Hz", 60.0, lambda d: d.slider.drive.across.frequency),
        ("load.program.1.to", "N", 15.0, lambda d: d.slider.load.program[0].to),
        ("initial.u_x", "m", 2e-6, lambda d: d.initial.u_x),
        ("run.rtol", "", 1e-8, lambda d: d.run.rtol),
        ("run.regularisation", "m/s", 1e-9, lambda d: d.run.regularisation),
    ):
        assert unit(base, path) == its, path
        new = vary(base, {path: (value, its)})
        assert read(new) == pytest.approx(value, rel=1e-15), path
        if read(base) is not None:
            assert vary(new, {path: (read(base), its)}).slider == base.slider, path


@pytest.mark.parametrize("shape", [(1,), (7,), (1000,), (100, 100), (3, 1000), (5, 7, 11), (10, 1)])
@pytest.mark.parametrize("seconds", [1e-4, 1e-2, 10.0])
def test_blocks_cover_each_run_once(shape, seconds):
    layout: Layout = layout_of({f"d{i}": n for i, n in enumerate(shape)}, seconds)
    counted = np.zeros(shape, int)
    for task in range(layout.tasks):
        for index in places(layout.region(task)):
            counted[index] += 1
    assert (counted == 1).all()
    assert layout.tasks <= 4096 * 2


def test_a_million_runs_are_few_tasks():
    layout = layout_of({"a": 1000, "b": 1000}, 1e-2)
    assert layout.tasks <= 4096 * 1.1


def test_traces_are_kept_decimated(tmp_path):
    axes = {"phi": st.Values(["1 deg", "95 deg", "3 deg"])}
    base = BASE._replace(run=st.Settings(duration="0.5 s", sample_rate="2 kHz"))
    study = st.Study(
        base=base, axes=axes, measures=[], traces=["force", "position"], trace_samples=26
    )
    st.sweep(study, tmp_path / "a.zarr")
    data = xr.open_zarr(tmp_path / "a.zarr").load()
    assert data["force_trace"].dims == ("phi", "time")
    assert data["time"].attrs["units"] == "s"
    assert np.isnan(data["position_trace"].isel(phi=1)).all()
    run = st.simulate(PAPER.replace(phi="3 deg"), "0.5 s", sample_rate="2 kHz").data
    whole = run.sel(time=data["time"].values, method="nearest")
    # both are samples of the same solution at the same times, but for rounding of the times
    np.testing.assert_allclose(data["force_trace"][2], whole["spring_x"], atol=1e-9)
    np.testing.assert_allclose(data["position_trace"][2], whole["X"], atol=1e-12)


def test_a_store_of_another_version_is_refused(study, tmp_path):
    import zarr

    create(study, tmp_path / "a.zarr")
    group = zarr.open_group(tmp_path / "a.zarr", mode="r+", use_consolidated=False)
    group.attrs["stiction_version"] = "0.0.1"
    seal(tmp_path / "a.zarr")
    with pytest.raises(st.ResultError, match=r"begun by stiction 0\.0\.1"):
        st.sweep(study, tmp_path / "a.zarr")
    group.attrs["format"] = 99
    with pytest.raises(st.ResultError, match="has format 99"):
        st.open_study(tmp_path / "a.zarr")


def test_processes_do_the_same(study, finished, tmp_path):
    """Dask's own scheduler and workers, in processes of this machine."""
    st.sweep(study, tmp_path / "a.zarr", engine=Processes(2))
    xr.testing.assert_identical(
        xr.open_zarr(tmp_path / "a.zarr").load(), xr.open_zarr(finished[0]).load()
    )


def test_the_example_s_file():
    study = st.Study.from_toml(Path(__file__).parents[3] / "examples" / "study.toml")
    assert study.layout.shape == (24, 16)
    assert study.description((0, 15)).run.duration == 5.0
    assert st.Study.from_dict(study.to_dict()).to_json() == study.to_json()


def test_what_is_no_study_is_not_swept(tmp_path):
    with pytest.raises(st.DescriptionError, match="study: must be a Study or text or a path, is 5"):
        st.sweep(5, tmp_path / "a.zarr")
    with pytest.raises(st.DescriptionError, match="study: None is not a Study; make one"):
        st.refine(None, tmp_path / "a.zarr", along="phi", to="1 deg")
    assert not (tmp_path / "a.zarr").exists()


def test_a_measure_that_a_map_of_samples_does_not_draw_is_refused(tmp_path):
    base = st.Description(
        st.presets.nakano_popov_2020(), st.Initial(), st.Settings(duration="2 ms")
    )
    axes = {"phi": st.Random("1 deg", "3 deg", 2), "drive.velocity": st.Random(1e-3, 3e-3, 2)}
    study = st.Study(base=base, axes=axes, measures=["regime", "peak_force"])
    st.sweep(study, tmp_path / "samples.zarr")
    with pytest.raises(st.DescriptionError, match="drawn by their kind of motion alone"):
        st.map(tmp_path / "samples.zarr", of="peak_force")


def test_a_study_is_swept_and_refined_from_its_file(tmp_path):
    """`run`, `audit` and `compare` took a file, `sweep` a study alone."""
    file = tmp_path / "study.toml"
    file.write_text(
        BASE._replace(run=st.Settings(duration="0.1 s")).to_toml()
        + '[study]\nmeasures = ["regime"]\n[axes.phi]\nfrom = "1 deg"\nto = "2 deg"\ncount = 2\n'
    )
    assert st.sweep(file, tmp_path / "a.zarr", engine=st.Threads(1)).pending == 0
    assert "point" in st.refine(str(file), tmp_path / "a.zarr", "phi", "0.5 deg").dims


@pytest.mark.parametrize("engine", ["bogus", 4, st.Threads])
def test_what_is_no_engine_leaves_no_store(tmp_path, engine):
    study = st.Study(base=BASE, axes={"phi": st.Grid("1 deg", "2 deg", 2)})
    with pytest.raises(st.DescriptionError, match=r"engine: .* is not an engine; write .*Threads"):
        st.sweep(study, tmp_path / "a.zarr", engine=engine)
    assert not (tmp_path / "a.zarr").exists()


def test_a_grid_has_the_decimals_that_one_means():
    """A store is asked for its run at 0.45, not at 0.44999999999999996."""
    rng = np.random.default_rng(11)
    for _ in range(300):
        places, count = int(rng.integers(0, 5)), int(rng.integers(2, 300))
        first, step = int(rng.integers(-200, 200)), int(rng.integers(1, 10 ** (places + 1)))
        wanted = [float(f"{first + step * each}e-{places}") for each in range(count)]
        grid = st.Grid(f"{wanted[0]!r} N", f"{wanted[-1]!r} N", count)
        made = values(grid, "N", 0, 0)
        assert made.tolist() == wanted
        assert not np.signbit(made[made == 0.0]).any()  # a map would be labelled -0
    for ends in (("1 um/s", "1 m/s", 7), ("0.1 mm/s", "100 mm/s", 4)):
        decades = values(st.Grid(*ends, spacing="log"), "m/s", 0, 0).tolist()
        assert decades == [float(f"1e{int(np.rint(np.log10(each)))}") for each in decades]


def test_a_grid_of_other_numbers_is_as_even_as_floats_are():
    rng = np.random.default_rng(12)
    for _ in range(300):
        low, high = np.sort(rng.normal(0.0, 10.0 ** rng.uniform(-9, 9), 2)).tolist()
        count = int(rng.integers(2, 300))
        made = values(st.Grid(f"{low!r} m", f"{high!r} m", count), "m", 0, 0)
        off = 8.0 * np.finfo(float).eps * max(abs(low), abs(high))
        np.testing.assert_allclose(made, np.linspace(low, high, count), rtol=0.0, atol=2.0 * off)
        assert (made[0], made[-1]) == (low, high)
