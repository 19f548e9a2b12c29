"""Maps of studies, drawn from their stores."""

import numpy as np
import pytest
import xarray as xr

import stiction as st
from stiction import theory
from stiction.cli import main
from stiction.plotting.maps import Side
from stiction.plotting.page.canvas import figure_of
from stiction.study.presets import PRESETS, preset
from stiction.study.store.seal import seal
from stiction.study.variables.kinds import KINDS
from stiction.study.view import mapping
from stiction.study.view.boundaries import PHI_C, ZETA, plane
from stiction.study.view.mapping import gaps_in_words

PAPER = st.presets.nakano_popov_2020()
BASE = st.Description(PAPER, st.Initial(), st.Settings(duration="4 s"))
AXES = {
    "phi": st.Grid("4 deg", "12 deg", 9),
    "drive.velocity": st.Grid("1 mm/s", "4 mm/s", 3, "log"),
    "friction.mu_inf": st.Values([0.15, 0.18]),
}


@pytest.fixture(scope="module")
def store(tmp_path_factory):
    path = tmp_path_factory.mktemp("map") / "a.zarr"
    st.sweep(st.Study(base=BASE, axes=AXES), path)
    return path


@pytest.fixture(scope="module", autouse=True)
def one_plane_for_each_cut():
    """Theory over the plane of a cut takes longer than its map; six tests draw the same."""
    known = {}

    def remember(study, x, y, at):
        key = study.to_json(), x, y, *sorted(at.items())
        known[key] = known.get(key) or plane(study, x, y, at)
        return known[key]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(mapping, "plane", remember)
        yield


def draw(fig):
    return {text.get_text() for legend in fig.legends for text in legend.get_texts()}


def test_a_map_of_regimes_with_both_boundaries(store):
    fig = figure_of(st.map(store, at={"friction.mu_inf": 0.15}).plot)
    found = draw(fig)
    assert {PHI_C, ZETA, "stick-slip", "settling"} <= found
    (ax,) = fig.axes
    assert (ax.get_xlabel(), ax.get_ylabel()) == (r"$\varphi$ (deg)", "$V$ (mm/s)")
    assert (ax.get_xscale(), ax.get_yscale()) == ("linear", "log")
    (mesh,) = ax.collections[:1]
    data = xr.open_zarr(store).sel({"friction.mu_inf": 0.15})
    kinds = np.array(data["regime"].attrs["flag_meanings"].split())
    names = [*dict.fromkeys(kinds[data["regime"].values.ravel() + 1])]
    assert len(np.unique(np.asarray(mesh.get_array()))) == len(names)


def test_measures_and_slices(store):
    fig = figure_of(st.map(store, ["amplitude", "period"], {"friction.mu_inf": 0.149}).plot)
    assert [ax.get_ylabel() for ax in fig.axes[2:]] == ["amplitude (N)", "period (s)"]
    cut = {"friction.mu_inf": 0.15, "drive.velocity": "1.1 mm/s"}
    fig = figure_of(st.map(store, at=cut).plot)
    (ax,) = fig.axes
    assert ax.get_title("left") == r"at $V$ = 1 mm/s, $\mu_{\infty}$ = 0.15"  # the nearest ones
    data = xr.open_zarr(store)["peak_force"].isel({"drive.velocity": 0, "friction.mu_inf": 0})
    x, y = ax.lines[0].get_data()
    np.testing.assert_allclose(x, data["phi"])
    np.testing.assert_allclose(y, data)


def test_a_map_ends_where_its_study_does(store):
    """No cell stands for values that were not run: an axis of misalignments begins at the first."""
    (ax,) = figure_of(st.map(store, at={"friction.mu_inf": 0.15}).plot).axes
    np.testing.assert_allclose([*ax.get_xlim(), *ax.get_ylim()], [4.0, 12.0, 1.0, 4.0])


def test_kinds_over_one_parameter_are_named(store):
    cut = {"friction.mu_inf": 0.15, "drive.velocity": "1 mm/s"}
    (ax,) = figure_of(st.map(store, "regime", cut).plot).axes
    rows = [text.get_text() for text in ax.get_yticklabels()]
    data = xr.open_zarr(store)["regime"].sel({"friction.mu_inf": 0.15}).isel({"drive.velocity": 0})
    assert {*rows} == {KINDS[code] for code in data.values.tolist()}
    assert len(rows) > 1
    points = [line for line in ax.lines if line.get_linestyle() == "None"]
    assert sum(len(line.get_xdata()) for line in points) == 9
    assert len({line.get_marker() for line in points}) == len(rows)


def test_a_slice_shows_kinds_critical_values_and_no_rounding_noise(tmp_path, monkeypatch):
    """The critical stiffness is (b - a) W / D_c, 3 MN/m; what slides steadily has no amplitude."""
    law = st.laws.RateStateAgeing(a=0.008, b=0.014, D_c="10 um", mu_star=0.6, V_star="1 um/s")
    rock = st.Slider(
        mass="1 kg", k_x="2.4 MN/m", k_y="200 MN/m", phi="0 deg", normal_load="5 kN",
        friction=law, drive=st.ConstantVelocity("10 um/s"),
    )  # fmt: skip
    base = st.Description.of(rock, "600 s")
    axes = {"k_x": st.Values(["2.4 MN/m", "3.8 MN/m"])}
    study = st.Study(base=base, axes=axes, measures=["regime", "amplitude", "period"])
    assert "not determined" not in str(st.sweep(study, tmp_path / "rock.zarr"))
    (ax,) = st.map(tmp_path / "rock.zarr", "amplitude").plot()
    words = [each.get_text() for each in ax.figure.legends[0].get_texts()]
    assert [*words] == ["stick-slip", "settling", "steady sliding changes its stability: 3 MN/m"]
    assert float(ax.lines[0].get_ydata()[1]) == 0.0 < float(ax.lines[0].get_ydata()[0])
    monkeypatch.setattr("stiction.study.variables.sampling.MOST_SAMPLES", 997)
    found = st.sweep(study, tmp_path / "few.zarr")
    assert "2 of 2 runs not determined: its motion is too fast" in str(found)
    (ax,) = st.map(tmp_path / "few.zarr", "period").plot()
    assert "2 of 2 runs not determined" in ax.get_title(loc="left").replace("\n", " ")


def test_every_run_of_no_kind_is_counted_above_its_map(tmp_path):
    """One of two white cells was counted, and none where no run had a message."""
    base = st.Description.of(st.presets.nakano_popov_2020(), "5 ms")
    axes = {"phi": st.Values(["1 deg", "2 deg"]), "mass": st.Values(["0.2 kg", "0.3 kg"])}
    st.sweep(st.Study(base=base, axes=axes, measures=["regime", "peak_force"]), tmp_path / "a.zarr")
    found = st.map(tmp_path / "a.zarr")
    found.data["regime"].values[:] = [[0, 0], [2, 0]]
    assert found.data["message"].values.tolist() == [["", ""], ["", ""]]
    reason = "the force slips, but shows no whole cycle; lengthen the run"
    assert gaps_in_words(found) == f"3 of 4 runs not determined: {reason}"
    found.data["message"].values[0, 0] = "shorten it"
    said = f"3 of 4 runs not determined: {reason} (2); shorten it (1)"
    assert gaps_in_words(found) == said
    (ax,) = found.plot()
    assert ax.get_title(loc="left").replace("\n", " ") == said
    assert gaps_in_words(found._replace(measures=("peak_force",))).startswith("1 of 4 runs")


def test_what_has_no_value_is_explained(store):
    fig = figure_of(st.map(store, "period", {"friction.mu_inf": 0.15}).plot)
    assert "no value" in draw(fig)


def test_theory_over_the_plane(store):
    """Where the fields vanish, against the closed forms."""
    study = st.Study(base=BASE, axes=AXES)
    found = mapping.plane(study, "phi", "drive.velocity", {"friction.mu_inf": 0})
    row = found.y.tolist().index(min(found.y, key=lambda V: abs(V - 1e-3)))
    growth, damping = (field[:, row] for field in found.fields.values())
    phi = [np.interp(0.0, -growth, found.x), np.interp(0.0, damping, found.x)]
    weakening = 0.05 / 0.01 * np.exp(-0.1)
    closed = np.degrees(np.arctan(np.sqrt(1e-3 * weakening / (0.15 + 0.05 * np.exp(-0.1)))))
    # the curves bend within a step of 8/64 deg; k_y is finite: 0.002 deg
    assert phi[0] == pytest.approx(closed, abs=0.005)
    A = theory.damping_number(2.0, 1e-3, np.radians(phi[1]), 0.25, 1e3)
    assert theory.damping_ratio(A, np.radians(phi[1])) == pytest.approx(1.0, abs=0.005)


@pytest.mark.parametrize(
    ("measures", "cut", "says"),
    [
        ([], {}, "3 dimensions are left; cut it at a value"),
        (["amplitud"], {"friction.mu_inf": 0.15}, "did you mean 'amplitude'"),
        ([], {"friction.mu_in": 0.15}, "did you mean 'friction.mu_inf'"),
        ([], {"phi": 3}, "degree or radian"),
        ([], {"phi": "3 mm"}, "'3 mm' is in mm, not a unit of an angle"),
        (["mean_force"], {"friction.mu_inf": 0.15}, "mean_force: the study did not store it, but "),
        ([], {"V": "3 m/s"}, "3 m/s is beyond the study, which has 1 to 4 mm/s"),
        ([], {"friction.mu_inf": 15}, "15 is beyond the study, which has 0.15 to 0.18"),
    ],
)
def test_what_cannot_be_drawn(store, measures, cut, says):
    with pytest.raises(st.DescriptionError) as error:
        st.map(store, measures, cut).plot()
    assert says in str(error.value)


def test_failed_and_missing_runs_are_hatched(tmp_path):
    shaken = PAPER.replace(
        load=st.protocols.LoadProgram(modulation=st.protocols.Modulation("1 N", "50 Hz"))
    )
    axes = {
        "phi": st.Values(["2 deg", "20 deg"]),
        "load.modulation.amplitude": st.Values([1.0, 12.0]),
    }
    base = st.Description(shaken, st.Initial(), st.Settings(duration="0.5 s"))
    st.sweep(st.Study(base=base, axes=axes), tmp_path / "a.zarr")
    fig = figure_of(st.map(tmp_path / "a.zarr").plot)
    assert "no result" in draw(fig)


def test_the_command(store, tmp_path, capsys):
    target = tmp_path / "map.png"
    with pytest.raises(SystemExit) as end:
        main(["map", str(store), "--at", "friction.mu_inf = 0.15", "-o", str(target)])
    assert end.value.code == 0
    assert target.read_bytes().startswith(b"\x89PNG")
    with pytest.raises(SystemExit) as end:
        main(["map", str(store), "--at", "friction.mu_inf", "-o", str(target)])
    assert end.value.code == 2
    assert "write for example 'phi = 1 deg'" in capsys.readouterr().err
    with pytest.raises(SystemExit) as end:
        main(["map", str(tmp_path / "no.zarr"), "-o", str(target)])
    assert end.value.code == 2


@pytest.mark.parametrize("name", PRESETS)
def test_presets_can_be_run(name):
    study = preset(name)
    assert study.layout.runs >= 500
    last = study.description(tuple(n - 1 for n in study.layout.shape))
    assert last.run.duration > 4.0
    assert st.Study.from_json(study.to_json()).to_json() == study.to_json()


def test_the_damping_diagram_s_samples_lie_on_a_grid_of_A():
    study = preset("damping-diagram")
    index = (30,)
    slider = study.description(index).slider
    A = theory.damping_number(slider.F_0, slider.drive.velocity, slider.phi, 0.25, 1e3)
    wanted = np.geomspace(1, 1e4, 25)
    assert np.abs(np.log(wanted / float(A))).min() < 1e-9


def test_a_preset_by_a_wrong_name(tmp_path, capsys):
    with pytest.raises(SystemExit) as end:
        main(["sweep", "--preset", "yaw-angel", "-o", str(tmp_path / "a.zarr")])
    assert end.value.code == 2
    assert "did you mean 'yaw-angle'" in capsys.readouterr().err


def test_edges_of_cells_lie_between_the_values():
    side = Side(None, np.array([1.0, 10.0, 100.0]), True)
    np.testing.assert_allclose(side.edges, 10.0 ** np.array([0.0, 0.5, 1.5, 2.0]))
    assert len(Side(None, np.array([3.0]), False).edges) == 2


def test_a_measure_by_its_old_name_is_that_by_its_new_one(tmp_path):
    base = st.Description(
        st.presets.nakano_popov_2020(), st.Initial(), st.Settings(duration="5 ms")
    )
    renamed = "the measure 'song' is now called 'transverse_oscillation'"
    with pytest.warns(DeprecationWarning, match=renamed):
        study = st.Study(base=base, axes={"phi": st.Values(["1 deg", "2 deg"])}, measures=["song"])
    assert study.measures == ("transverse_oscillation",)
    store = tmp_path / "a.zarr"
    st.sweep(study, store)
    assert (st.open_study(store)["transverse_oscillation"] > 0.0).all()
    with pytest.warns(DeprecationWarning, match=renamed):
        found = st.map(store, "song")
    assert found.measures == ("transverse_oscillation",)
    (store / "transverse_oscillation").rename(store / "song")  # as an older version wrote it
    (store / "zarr.json").write_text(
        (store / "zarr.json").read_text().replace("transverse_oscillation", "song")
    )
    seal(store)
    assert "transverse_oscillation" in st.open_study(store)
