"""Refining a study where the kind of motion changes."""

import shutil

import numpy as np
import pytest
import xarray as xr

import stiction as st
from stiction.analysis.motion.noiseless.resolution import REVERSAL
from stiction.study.execution import refine
from stiction.study.execution.refine import Intervals, narrow, side
from stiction.study.variables.kinds import KINDS
from stiction.study.view.view import kinds

PAPER = st.presets.nakano_popov_2020()
BASE = st.Description(PAPER, st.Initial(), st.Settings(duration="6 s"))
CALM = ("settling", "steady sliding", "transverse oscillation")
V = st.Values(["0.5 mm/s", "1 mm/s"])


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    axes = {"phi": st.Grid("4 deg", "12 deg", 9), "drive.velocity": V}
    study = st.Study(base=BASE, axes=axes, measures=["regime"])
    path = tmp_path_factory.mktemp("refined") / "a.zarr"
    return study, path, st.refine(study, path, "phi", "0.01 deg", apart=CALM)


def test_the_same_boundary_as_that_of_a_filled_grid(found, tmp_path):
    """To a hundredth of a degree, with less than a tenth of the runs."""
    _, _, changes = found
    assert (2 * changes["half_width"] <= 0.01).all()
    around = {"phi": st.Grid("6 deg", "6.4 deg", 41), "drive.velocity": st.Values(["0.5 mm/s"])}
    st.sweep(st.Study(base=BASE, axes=around, measures=["regime"]), tmp_path / "a.zarr")
    filled = xr.open_zarr(tmp_path / "a.zarr").load().isel({"drive.velocity": 0})
    calm = np.isin(np.array(KINDS)[filled["regime"].values], CALM)
    edge = np.flatnonzero(np.diff(calm))
    at = 0.5 * (filled["phi"].values[edge] + filled["phi"].values[edge + 1])
    assert np.abs(at - float(changes["phi"][0])).min() <= 0.01
    assert changes.attrs["runs"] < 0.1 * 801 * 2


def test_changes_lie_at_the_loss_of_stability(found):
    """Growth is slow there: it is not seen if it takes longer than a run to span what is."""
    study, _, changes = found
    np.testing.assert_array_equal(changes["drive.velocity"], [0.5e-3, 1e-3])
    meanings = changes["below"].attrs["flag_meanings"].split()
    assert {meanings[code + 1] for code in changes["above"].values} == {"settling"}
    for point in range(2):
        at = changes.isel(point=point)
        drive = st.ConstantVelocity(float(at["drive.velocity"]))
        slider = study.base.slider.replace(phi=f"{float(at['phi'])} deg", drive=drive)
        loading = slider.F_0 / slider.k_x / drive.velocity
        slowest = -np.log(REVERSAL) / (study.base.run.duration - loading)
        assert abs(st.linear_stability.growth_rate(slider)) < slowest


@pytest.mark.parametrize("apart", [None, CALM])
@pytest.mark.parametrize("pair", [("settling", "stick-slip"), ("stick-slip", "settling")])
def test_a_failed_run_half_way_leaves_the_interval_as_it_is(pair, apart):
    """It tells nothing. The lower half had been taken for measured, wherever the change was."""
    low, high, middle = ({"phi": np.array([value])} for value in (1.0, 3.0, 2.0))
    below, above = (np.array([kind]) for kind in pair)
    found = narrow(Intervals(low, high, below, above), middle, np.array([""]), apart)
    assert (found.low["phi"], found.high["phi"]) == (1.0, 3.0)
    assert (found.below, found.above) == (below, above)


@pytest.mark.parametrize(
    ("hole", "wide"), [((6.1, 6.4), 1), ((6.3, 6.6), 1), ((6.45, 6.55), 0), ((6.1, 6.26), 1)]
)
def test_runs_that_fail_near_a_change_do_not_move_it(found, tmp_path, monkeypatch, hole, wide):
    """The change stays in its interval, however many runs in it fail."""
    edge = float(found[2]["phi"][0])

    def some_failed(data):
        fails = (hole[0] < data["phi"].values) & (data["phi"].values < hole[1])
        return np.where(fails.reshape(data["regime"].shape), "", kinds(data))

    monkeypatch.setattr(refine, "kinds", some_failed)
    axes = {"phi": st.Grid("4 deg", "8 deg", 5), "drive.velocity": st.Values(["0.5 mm/s"])}
    study = st.Study(base=BASE, axes=axes, measures=["regime"])
    shown = st.refine(study, tmp_path / "a.zarr", "phi", "0.01 deg", apart=CALM)
    (at,), (half,) = shown["phi"].values, shown["half_width"].values
    assert abs(at - edge) < half + 0.01
    assert shown.attrs["wide"] == wide == (half > 0.005)
    if wide:
        assert half <= hole[1] - hole[0]  # three points of a wider interval cannot all fail
        assert at - half <= hole[0] < hole[1] <= at + half
    tallies = []
    again = st.refine(
        study, tmp_path / "a.zarr", "phi", "0.01 deg", apart=CALM, progress=tallies.append
    )
    assert again.identical(shown)
    assert not tallies


def test_a_map_shows_how_wide_an_interval_is(found, tmp_path, monkeypatch):
    study, path, _ = found
    path = shutil.copytree(path, tmp_path / "a.zarr")
    monkeypatch.setattr(refine, "INSIDE", ())  # as where all runs fail
    changes = st.refine(study, path, "phi", "0.01 deg", apart=CALM)
    assert changes.attrs["wide"] == changes.sizes["point"] == 2
    drawn = [line.get_xdata() for line in st.map(path).plot()[0].lines]
    at, half = changes["phi"].values, changes["half_width"].values
    for ends in zip(at - half, at + half, strict=True):
        assert any(np.array_equal(each, ends) for each in drawn)


def test_it_goes_on_where_it_was_and_is_kept(found):
    study, path, changes = found
    tallies = []
    again = st.refine(study, path, "phi", "0.01 deg", apart=CALM, progress=tallies.append)
    assert not tallies  # nothing was left to do
    xr.testing.assert_identical(again, changes)
    finer = st.refine(study, path, "phi", "0.001 deg", apart=CALM)
    assert (np.abs(finer["phi"] - changes["phi"]) <= changes["half_width"]).all()
    kept = xr.open_zarr(path, group="refined/phi/changes", consolidated=False).load()
    np.testing.assert_array_equal(kept["phi"], finer["phi"])


def test_one_store_is_refined_for_several_kinds(found, tmp_path):
    """Each set of runs stays, under the names of earlier versions where one is alone."""
    study, path, changes = found
    path = shutil.copytree(path, tmp_path / "a.zarr")
    levels = {each.name for each in path.glob("refined/phi/*.zarr")}
    assert levels == {f"{level}.zarr" for level in range(1, len(levels) + 1)}
    runs = []
    for apart in (None, None, [*CALM]):
        tallies = []
        first = st.refine(study, path, "phi", "0.4 deg", apart=apart, progress=tallies.append)
        runs.append(bool(tallies))
        assert first.attrs.get("apart") == apart
        below, above = (side(np.array(KINDS)[first[name]], apart) for name in ("below", "above"))
        assert (below != above).all()
    assert runs == [True, False, False]  # the last two were there
    assert (np.abs(first["phi"] - changes["phi"]) <= first["half_width"]).all()
    assert len([*path.glob("refined/phi/*.zarr")]) > len(levels)
    assert st.check(path).ok


def test_refinements_of_one_store_at_the_same_time(found, tmp_path, monkeypatch):
    """Another one makes a store of its own runs just before this one makes one there."""
    study, path, changes = found
    path, make, made = shutil.copytree(path, tmp_path / "a.zarr"), refine.create, []
    shutil.rmtree(path / "refined")

    def late(part, store):
        if not made:
            made.append(store)
            st.refine(study, path, "phi", "0.4 deg")
        return make(part, store)

    monkeypatch.setattr(refine, "create", late)
    again = st.refine(study, path, "phi", "0.4 deg", apart=CALM)
    assert (np.abs(again["phi"] - changes["phi"]) <= again["half_width"]).all()
    assert made == [path / "refined" / "phi" / "1.zarr"]
    assert made[0].with_name("1-2.zarr").exists()  # of this one, whose intervals are others
    assert st.check(path).ok


def test_along_another_axis_with_one_zipped_to_it(tmp_path):
    axes = {
        "phi": st.Values(["3 deg"]),
        "drive.velocity": st.Grid("1 mm/s", "20 mm/s", 4, "log"),
        "run.duration": st.Values([6.0, 5.0, 4.0, 3.0], "drive.velocity"),
    }
    study = st.Study(base=BASE, axes=axes, measures=["regime"])
    changes = st.refine(study, tmp_path / "a.zarr", "drive.velocity", "0.1 mm/s")
    assert KINDS[int(changes["below"][0])] == "stick-slip"
    assert KINDS[int(changes["above"][-1])] == "harmonic vibration"
    assert (np.diff(changes["run.duration"]) < 0).all()


@pytest.mark.parametrize(
    ("along", "to", "says"),
    [
        ("ph", "0.1 deg", "did you mean 'phi'"),
        ("phi", 0.1, "degree or radian"),
        ("phi", "0 deg", "must be greater than 0"),
    ],
)
def test_what_cannot_be_refined(found, along, to, says):
    study, path, _ = found
    with pytest.raises(st.DescriptionError) as error:
        st.refine(study, path, along, to)
    assert says in str(error.value)


def test_a_kind_s_former_name_goes_on_and_a_strange_one_does_not(found, tmp_path):
    study, path, changes = found
    with pytest.warns(DeprecationWarning, match="now called 'settling'"):
        again = st.refine(study, path, "phi", "0.01 deg", apart=["damped approach", *CALM[1:]])
    np.testing.assert_array_equal(again["above"], changes["above"])
    with pytest.raises(st.DescriptionError, match="did you mean 'settling'"):
        st.refine(study, path, "phi", "0.01 deg", apart=["setling"])


@pytest.mark.parametrize("damaged", ["changes/half_width/c/0", "changes/zarr.json", "1.zarr/phi"])
def test_damage_of_a_refinement_is_seen_and_mended(found, tmp_path, damaged):
    study, path, changes = found
    path = shutil.copytree(path, tmp_path / "a.zarr")
    part = path / "refined" / "phi" / damaged
    shutil.rmtree(part) if part.is_dir() else part.write_bytes(part.read_bytes()[:-9] + b" " * 9)
    assert not st.check(path).ok
    if damaged.startswith("changes"):
        for door in (st.map, lambda path: st.check(path, repair=True)):
            with pytest.raises(st.ResultError, match=r"is damaged.*refine the study again"):
                door(path)
        st.refine(study, path, "phi", "0.01 deg", apart=CALM)
    else:
        assert st.check(path, repair=True).repaired
    assert st.check(path).ok
    again = st.refine(study, path, "phi", "0.01 deg", apart=CALM)
    assert again.identical(changes)
