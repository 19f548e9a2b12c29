"""Each command is a function of its name, which returns what the command prints and draws."""

import inspect
import re
from pathlib import Path
from types import SimpleNamespace

import matplotlib as mpl
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import stiction as st
from stiction import plotting
from stiction.cli import COMMANDS, main
from stiction.cli.options import changes
from stiction.errors import Faults
from stiction.plotting.page.canvas import as_list, figure_of
from stiction.text.paths import with_changes

mpl.use("Agg")
PAPER = st.presets.nakano_popov_2020()


def inside(*arguments):
    with pytest.raises(SystemExit) as end:
        main([str(argument) for argument in arguments])
    return int(end.value.code or 0)


@pytest.fixture
def config(tmp_path):
    """A short run of the paper's system, as text."""
    path = st.init(tmp_path / "my.toml")
    path.write_text(path.read_text().replace('"5 s"', '"20 ms"'))
    return path


@pytest.fixture(scope="module")
def run():
    return st.simulate(PAPER, "20 ms", sample_rate="10 kHz")


@pytest.mark.parametrize(
    "name",
    [*(x for x in COMMANDS if x not in ("presets", "import")), "analyze", "refine"],
)
def test_each_command_is_a_function_with_a_docstring(name):
    function = getattr(st, name)
    assert inspect.isfunction(function)
    assert name in dir(st)
    taken = inspect.signature(function).parameters.values()
    lacks = f"the docstring of st.{name} lacks its section Parameters"
    assert "Parameters\n" in inspect.getdoc(function) or not taken, lacks
    assert not any(each.kind in (each.VAR_POSITIONAL, each.VAR_KEYWORD) for each in taken)


def test_a_run_from_its_file_is_that_of_its_description(config):
    run = st.run(config)
    assert run.data.equals(st.run(st.Description.from_toml(config)).data)


def test_what_is_unambiguous_is_taken_and_else_the_remedy_is_named(tmp_path):
    description = st.Description(PAPER, st.Initial(), st.Settings(duration="20 ms"))
    assert st.stability(description, "phi").stable == st.stability(PAPER, "phi").stable
    shaken = PAPER.replace(
        drive=st.protocols.DriveProgram(velocity=1e-3, along=st.protocols.Modulation(1e-3, 5.0))
    )
    with pytest.raises(st.DescriptionError, match="drive"):  # it is read, and then refused
        st.audit(description._replace(slider=shaken))
    for verb in (st.run, lambda slider: st.compare(slider, ["coulomb"])):
        with pytest.raises(
            st.DescriptionError, match=r"no duration; .*st\.Description\.of\(slider"
        ):
            verb(PAPER)
    with pytest.raises(st.DescriptionError, match=r"duration: is missing; .*st\.run takes"):
        st.simulate(description)
    (tmp_path / "study.zarr").mkdir()
    with pytest.raises(st.ResultError, match=r"is a folder.*st\.map\(path\) draws a map"):
        st.plot(tmp_path / "study.zarr")


def test_rooms_keep_their_old_names_with_a_warning():
    with pytest.warns(DeprecationWarning, match=r"stiction\.linear_stability\.growth_rate"):
        rate = st.stability.growth_rate(PAPER)
    assert rate == st.linear_stability.growth_rate(PAPER)
    assert {"examine", "Audit"} <= set(dir(st.audit))
    base = st.Description(PAPER, st.Initial(), st.Settings(duration=0.02))
    study = st.Study(base=base, axes={"V": st.Values(["1 mm/s"])}, measures=["peak_force"])
    for call in (study.run, lambda path: study.refine(path, "nothing", 1.0)):
        with (
            pytest.warns(DeprecationWarning, match=r"stiction\.(sweep|refine)\(study, store\)"),
            pytest.raises(st.StictionError),
        ):
            call("/no such folder/a.zarr")


def test_progress_is_given_by_name():
    """An audit and the paper took it by position, and no other did."""
    verbs = [getattr(st, name) for name in st.__all__]
    found = [inspect.signature(each).parameters for each in verbs if inspect.isfunction(each)]
    kinds = [each["progress"].kind for each in found if "progress" in each]
    assert len(kinds) >= 12
    assert {*kinds} == {inspect.Parameter.KEYWORD_ONLY}


def test_an_audit_takes_the_second_argument_of_its_old_name():
    with (
        pytest.warns(DeprecationWarning, match=r"called st\.audit\(slider, progress=progress\)"),
        pytest.raises(st.DescriptionError, match="drive"),
    ):
        st.audit(PAPER.replace(drive=st.ConstantVelocity(0.0)), lambda fraction: None)


def test_the_seed_of_an_audit_reaches_the_fit_and_the_odds(run, monkeypatch):
    """Without it an audit could not be repeated with other draws, as a fit can."""
    from stiction.auditing import measured
    from stiction.inference.mechanism import comparison

    record, asked, rig = st.measure(run, st.Sensor()), [], st.Rig(PAPER, {"phi": "1 +- 0.5 deg"})
    its = SimpleNamespace(seen=[None], rig=rig)
    monkeypatch.setattr(measured, "observe_with_one", lambda *_: its)
    monkeypatch.setattr(measured, "predict", lambda *_: None)
    for room, name in (measured, "fit_observed"), (comparison, "odds_of_observed"):
        monkeypatch.setattr(room, name, lambda _, count, place, seed, report: asked.append(seed))

    def withdraw(_):
        raise st.StictionError("enough")

    monkeypatch.setattr(measured, "withdraw", withdraw)
    for given in ({}, {"seed": 3}):
        with pytest.raises(st.StictionError, match="enough"):
            st.audit(rig, record, **given)
    assert asked == [0, 0, 3, 3]


def test_stability_says_what_its_command_prints(config, capsys):
    found = st.stability(config, over="V", between=("0.1 mm/s", "1 m/s"))
    assert inside("stability", config, "--over", "V", "--between", "0.1 mm/s", "1 m/s") == 0
    text = capsys.readouterr().out
    for part in found.tables():
        assert part.title in text
    assert found.over == ("drive.velocity",)
    assert not found.stable
    assert repr(found) == "<Stability: unstable; over drive.velocity>"
    assert "<table>" in found._repr_html_()
    assert str(found).startswith("Steady sliding\n")
    with pytest.raises(st.StictionError, match="as many ranges or none; given: 1 and 2"):
        st.stability(PAPER, over=["phi"], between=[None, None])


def test_a_comparison_is_a_mapping_with_a_table(config):
    found = st.compare(config, "coulomb")
    assert list(found) == ["exponential-weakening", "coulomb"]
    (part,) = found.tables()
    assert part.table.to_dataframe()["law"].tolist() == list(found)
    assert found.ok


def test_a_study_from_sweep_to_map(config, tmp_path):
    base = st.Description.from_toml(config, {"duration": "2 ms"})
    study = st.Study(base=base, axes={"V": st.Grid("1 mm/s", "2 mm/s", 2)}, measures=["peak_force"])
    done = st.sweep(study, tmp_path / "a.zarr")
    assert repr(done).endswith("a.zarr: 2 of 2, 0 failed>")
    for each in (done, st.map(tmp_path / "a.zarr")):  # in a notebook
        assert 'src="data:image/png;base64,iVBOR' in each._repr_html_()
    (ax,) = figure_of(done.plot).axes
    assert ax.get_xlabel() == "$V$ (mm/s)"
    found = st.map(tmp_path / "a.zarr", of="peak_force")
    assert found.dims == ("drive.velocity",)
    assert repr(found) == "<Map of peak_force over drive.velocity>"


# --- figures ---


@pytest.mark.parametrize("name", dir(plotting))
def test_each_public_figure_takes_axes_and_has_a_docstring(name):
    if name.startswith("__"):
        return
    function = getattr(plotting, name)
    taken = inspect.signature(function).parameters.values()
    last = [each.name for each in taken if each.kind is not each.KEYWORD_ONLY][-1]
    assert last in ("ax", "axes")
    assert inspect.signature(function).parameters[last].default is None
    assert inspect.getdoc(function)


SEVERAL = {"dict[str, Axes]", "NDArray[np.object_]", "Axes | NDArray[np.object_]"}


@pytest.mark.parametrize("name", [each for each in dir(plotting) if each.startswith("plot_")])
def test_ax_is_one_panel_and_axes_are_several(name):
    found = inspect.signature(getattr(plotting, name))
    if "ax" in found.parameters:
        assert found.parameters["ax"].annotation == "Axes | None"
        assert found.return_annotation == "Axes"
    else:
        assert found.return_annotation in SEVERAL
        assert "Any" not in found.parameters["axes"].annotation


def test_a_run_is_drawn_on_the_axes_that_are_given(run):
    figure = Figure()
    ax, other = figure.subplots(2, 1)
    assert run.plot({"force": ax, "speed": other}) == {"force": ax, "speed": other}
    assert figure.axes == [ax, other]
    assert ax.get_ylabel().startswith("spring force")
    with pytest.raises(st.StictionError, match="did you mean"):
        run.plot({"forc": ax})


def test_a_figure_of_its_own_is_known_to_pyplot_only_at_the_public_door(run):
    from matplotlib import pyplot

    before = pyplot.get_fignums()
    figure_of(run.plot)
    assert pyplot.get_fignums() == before
    axes = run.plot()
    assert len(pyplot.get_fignums()) == len(before) + 1
    pyplot.close(as_list(axes)[0].figure.figure)
    assert pyplot.get_fignums() == before


def test_one_panel_figures_draw_on_given_axes(run):
    ax = Figure().subplots()
    stability = st.stability(PAPER)
    for draw in (
        lambda ax: plotting.plot_law(PAPER, ax=ax),
        lambda ax: plotting.plot_slider(PAPER, ax=ax),
        lambda ax: plotting.plot_damping(ax=ax),
        lambda ax: stability.plot(ax),
    ):
        ax = Figure().subplots()
        assert draw(ax) is ax
    whole = st.plot(st.analysis.record_of(run), Figure().subplots())
    assert all(isinstance(each, Axes) for each in whole)


@pytest.mark.parametrize("verb", [st.run, st.audit, st.stability, st.Study.from_toml])
def test_what_is_no_description_is_refused(verb):
    with pytest.raises(st.DescriptionError, match="int is not a description; give its file"):
        verb(3)


def test_a_figure_that_the_paper_has_not_is_refused(tmp_path):
    with pytest.raises(st.StictionError, match="figure must be 3, 4 or 5, is 7"):
        st.paper(tmp_path, figure=7)


def test_what_has_no_figure_says_so():
    with pytest.raises(
        st.StictionError, match="float has no figure; give a run, an analysis or a slider"
    ):
        st.plot(3.0)


# --- other values of parameters ---


TABLES = {
    "slider": {"phi": "1 deg"},
    "friction": {"law": "coulomb", "mu_0": 0.2},
    "drive": {"velocity": "1 mm/s", "program": [{"piece": "hold", "duration": "1 s"}]},
    "axes": {"drive.velocity": {"count": 3}},
}


@pytest.mark.parametrize(
    ("text", "way", "value"),
    [
        ("phi=3deg", ("slider", "phi"), "3deg"),
        ("slider.phi = 3 deg", ("slider", "phi"), "3 deg"),
        ("V=2mm/s", ("drive", "velocity"), "2mm/s"),
        ("W=20", ("slider", "normal_load"), 20),
        ("m=1e-3", ("slider", "mass"), 1e-3),
        ("k_x=1 kN/m", ("slider", "k_x"), "1 kN/m"),
        ("mu_0=0.3", ("friction", "mu_0"), 0.3),
        ("friction.mu_static=0.3", ("friction", "mu_static"), 0.3),
        ("duration=10s", ("run", "duration"), "10s"),
        ("run.multiscale=true", ("run", "multiscale"), True),
        ("drive.program.1.duration=2s", ("drive", "program", 0, "duration"), "2s"),
        ("axes.drive.velocity.count=9", ("axes", "drive.velocity", "count"), 9),
        ("load.program=[]", ("load", "program"), []),
    ],
)
def test_a_parameter_is_set_by_its_path_or_short_name(text, way, value):
    found, _ = with_changes(TABLES, changes([text], Faults()))
    for key in way:
        found = found[key]
    assert found == value
    assert TABLES["slider"]["phi"] == "1 deg"  # what is read is left as it is


def test_set_reaches_every_command_that_reads_a_description(config, tmp_path, capsys):
    assert inside("run", config, "--set", "phi=3deg", "--set", "V = 2 mm/s", "-o",
                  tmp_path / "a.nc") == 0  # fmt: skip
    slider = st.load(tmp_path / "a.nc").slider
    assert slider == PAPER.replace(phi="3 deg", drive=st.ConstantVelocity("2 mm/s"))
    capsys.readouterr()
    for command in (("audit",), ("stability",), ("compare", "--law", "coulomb", "-o", "a.png")):
        name, *rest = command
        assert inside(name, config, *rest, "--set", "slider.ph=3deg", "--set", "W=2 m") == 2
        text = capsys.readouterr().err
        assert "slider.ph: unknown key 'ph'; did you mean 'phi'?" in text
        assert "slider.normal_load: " in text
    assert inside("sweep", "--preset", "yaw-angle", "-o", tmp_path / "a.zarr", "--set",
                  "friction.mu_9=3") == 2  # fmt: skip
    assert "friction.mu_9: unknown" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("ph=3deg", "ph: unknown parameter 'ph'; did you mean 'phi'?"),
        ("mu=3", "did you mean 'friction.mu_0'?"),
        ("load=3N", "did you mean 'normal_load'?"),
        ("drive.program.7.to=3", "'7' is not an element of a list of 1; elements count from 1"),
        ("phi.to=3", "phi.to: has no part 'to': it is '1 deg'"),
        ("phi", "--set 'phi' is not NAME=VALUE"),
        ("=3", "--set '=3' is not NAME=VALUE"),
    ],
)
def test_a_path_that_leads_nowhere_says_where_it_ends(text, words):
    faults = Faults()
    _, lost = with_changes(TABLES, changes([text], faults))
    with pytest.raises(st.StictionError) as error:
        raise st.DescriptionError(
            [*lost, *(fault for each in faults.found for fault in each.faults)]
        )
    assert words in str(error.value)


def test_each_assignment_without_a_value_is_told_beside_other_faults(capsys, tmp_path):
    """The first alone was told, and neither a further one nor another fault of the command."""
    wrong = ("--set", "phi 3deg", "--set", "mass=3m", "--set", "k_x")
    (tmp_path / "rig.toml").write_text(f'{PAPER.to_toml()}[run]\nduration = "5 s"\n')
    for command in (
        ("run", *wrong, "-o", tmp_path / "a.txt"),
        ("compare", *wrong, "--law", "coulomb", "-o", tmp_path / "a.txt"),
        ("audit", *wrong, "-o", tmp_path / "a.txt"),
        ("stability", *wrong, "-o", tmp_path / "a.txt"),
    ):
        assert inside(command[0], tmp_path / "rig.toml", *command[1:]) == 2
        told = capsys.readouterr().err
        assert "--set 'phi 3deg' is not NAME=VALUE" in told
        assert "--set 'k_x' is not NAME=VALUE" in told
        assert "mass: '3m' is in m" in told
        assert "unknown format '.txt'" in told
    assert inside("sweep", "--preset", "yaw-angle", "-o", tmp_path / "a.zarr", *wrong,
                  "--refine", "phi") == 2  # fmt: skip
    told = capsys.readouterr().err
    assert "--set 'k_x' is not NAME=VALUE" in told
    assert "--refine 'phi' is not NAME=VALUE" in told
    assert "mass: '3m' is in m" in told
    assert inside("map", tmp_path / "none.zarr", "--at", "phi", "--at", "k_x") == 2
    told = capsys.readouterr().err
    assert "--at 'phi' is not NAME=VALUE" in told
    assert "--at 'k_x' is not NAME=VALUE" in told
    assert "none.zarr" in told


RIG = PAPER.to_toml().replace('"1 deg"', '{low = "5 deg", high = "1 deg"}')
STUDY = f"""{PAPER.to_toml()}
[run]
duration = "5 s"

[study]
measures = ["beauty"]

[axes.phii]
values = ["1 deg", "2 deg"]

[axes.phi]
from = "1 deg"
to = "2 m"
count = 3
"""


@pytest.mark.parametrize(
    ("command", "text", "said"),
    [
        ("run my.toml -o a.txt --set colour=1 --set m=-1kg", PAPER.to_toml(),
         ["colour: unknown parameter", "slider.mass: ", "run: missing", "unknown format '.txt'"]),
        ("audit my.toml -o a.txt --set mu_0=-1 --force mN", RIG,
         ["friction.mu_0: ", "phi: low must be below high", "unknown format", "--force: there is"]),
        ("fit none.csv --rig my.toml -o a.txt --set laod.x=1 --set k_x=3s", RIG,
         ["none.csv", "laod.x: unknown", "slider.k_x: ", "phi: low must", "unknown format"]),
        ("design my.toml -o a.txt --angles 3 --noise 1m", RIG,
         ["phi: low must", "unknown format", "angles.1: ", "noise: "]),
        ("design my.toml -o a.txt --record none.csv --channels force position --library my.toml",
         PAPER.to_toml(),
         ["nothing is uncertain", "unknown format", "none.csv: ", "are those of the record",
          "my.toml: "]),
        ("sweep my.toml -o a.zarr --threads 0 --apart settling", STUDY,
         ["study.measures: unknown measure", "axes.phii: unknown parameter", "axes.phi.to: ",
          "--threads must be", "--apart needs"]),
        ("sweep my.toml -o a.zarr --set m=-1kg", STUDY,
         ["study.measures: unknown measure", "axes.phii: unknown parameter", "slider.mass: ",
          "axes.phi.to: "]),
        ("stability my.toml -o a.txt --over phi --over V --between 1deg 2deg --set W=1m", RIG,
         ["is uncertain", "slider.normal_load: ", "unknown format", "give --over once or twice"]),
        ("animate none.nc -o a.txt --length 1000s", "",
         ["none.nc", "unknown format", "length must"]),
        ("listen none.nc -o a.txt --speed -1", "", ["none.nc", "unknown format", "speed must be"]),
        ("plot none.nc -o a.txt", "", ["none.nc", "unknown format"]),
        ("export none.nc -o a.txt", "", ["none.nc", "unknown format"]),
    ],
)  # fmt: skip
def test_independent_faults_are_named_in_one_round(
    command, text, said, tmp_path, capsys, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    Path("my.toml").write_text(text)
    assert inside(*command.split()) == 2
    told = capsys.readouterr().err
    assert [words for words in said if words not in told] == []


@pytest.mark.parametrize(
    ("command", "said"),
    [
        ("audit my.toml -n 10 --library sims", "--simulations, --library: there is no record"),
        ("audit my.toml --seed 0", "--seed: there is no record"),
        ("audit my.toml --set duration=10s", "duration: has no effect: only a run reads it"),
        ("audit --preset leine-belt --set rtol=1e-5", "rtol: has no effect"),
        ("stability my.toml --set initial.u_x=1mm", "initial.u_x: has no effect"),
        ("sweep --preset yaw-angle -o a.zarr --quiet --json-lines", "exclude each other"),
    ],
)
def test_an_option_without_effect_is_refused(command, said, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("my.toml").write_text(PAPER.to_toml())
    assert inside(*command.split()) == 2
    assert said in capsys.readouterr().err


def test_no_simulations_of_an_audit_are_not_those_by_default(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("my.toml").write_text(PAPER.to_toml())
    asked = []

    def audit(*_, simulations, seed, **__):
        asked.append((simulations, seed))
        raise st.StictionError("enough")

    monkeypatch.setattr("stiction.auditing.report.audit", audit)
    monkeypatch.setattr("stiction.cli.commands.audit.record_or_none", lambda *_, **__: "record")
    for given in ((), ("-n", "0"), ("-n", "7"), ("--seed", "3")):
        assert inside("audit", "my.toml", "--record", "my.csv", *given) == 2
    assert asked == [(4000, 0), (0, 0), (7, 0), (4000, 3)]


def test_a_misspelt_table_is_no_table_of_a_run():
    """An audit, a fit and a study of stability left [laod] out, without a word."""
    with pytest.raises(
        st.DescriptionError, match="laod: unknown table 'laod'; did you mean 'load'"
    ):
        st.Slider.from_toml(f"{PAPER.to_toml()}\n[laod]\nprogram = []\n")


# --- the command line itself ---


@pytest.mark.parametrize(
    "arguments",
    [
        ("run", "my.toml", "--outputt", "a-rather-long-folder-name/a-rather-long-name.nc"),
        ("stability", "my.toml", "--between", "a"),
        ("paper", "--figure", "7"),
        ("paperr",),
        ("run", "a-rather-long-folder-name/a-rather-long-name-of-a-description.toml", "-o", "a.nc"),
    ],
)
def test_what_is_wrong_is_said_whole_on_a_narrow_terminal(arguments, capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "60")
    assert inside(*arguments) == 2
    text = capsys.readouterr().err
    assert text.startswith("error ")
    assert "│" not in text
    assert text.rstrip().endswith(("--help", "'stiction init'"))


def test_python_m_stiction_and_completion():
    from stiction.cli import app

    assert "complete" in app.generate_completion(shell="bash")
    import importlib.util

    assert importlib.util.find_spec("stiction.__main__") is not None
    assert inside("--version") == 0


@pytest.mark.parametrize("name", ["paper", "run", "plot", "analyse", "audit", "compare",
                                  "stability", "sweep", "map"])  # fmt: skip
def test_the_output_option_has_one_name_and_help_an_example(name, capsys):
    assert inside(name, "--help") == 0
    text = capsys.readouterr().out
    assert "--output" in text
    assert "-o " in text
    assert text.count(f"stiction {name}") > 1  # in the usage, and as an example


@pytest.mark.parametrize("name", COMMANDS)
def test_options_that_take_a_value_give_an_example(name):
    """Each is taught where it is listed: its example names it."""
    from stiction.cli import app

    for option in app[name].assemble_argument_collection(parse_docstring=True):
        if option.name.startswith("--") and option.hint is not bool:
            words = " ".join((option.parameter.help or "").split())
            assert re.search(f"({'|'.join(option.names)}) ", words), option.name
            assert not any(name.startswith("--empty-") for name in option.names)


def test_an_error_is_printed_to_the_letter(capsys, tmp_path, monkeypatch):
    """Not even a name between colons becomes an emoji."""
    monkeypatch.chdir(tmp_path)
    assert inside("init") == 0
    assert inside("compare", "slider.toml", "--law", "nofile.py:A", "-o", "laws.png") == 2
    assert "law nofile.py:A: no file 'nofile.py'" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("options", "reason"),
    [
        (("--refine", "phi"), "--refine 'phi' is not NAME=VALUE"),
        (("--refine", "psi = 1 deg"), "psi"),
        (("--refine", "phi = 1 deg", "--apart", "nope"), "unknown kind of motion 'nope'"),
        (("--apart", "settling"), "--apart needs --refine"),
    ],
)
def test_a_refinement_is_refused_before_the_first_run(options, reason, capsys, tmp_path):
    assert inside("sweep", "--preset", "yaw-angle", "-o", tmp_path / "yaw.zarr", *options) == 2
    assert reason in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_a_table_breaks_between_words_on_a_narrow_terminal(capsys, monkeypatch):
    from stiction.cli.tables import print_sections
    from stiction.text.sections import Section, Table

    headings = ("law", "sticks", "slowest slip while loading (m/s)", "median slip (m/s)")
    row = ("coulomb, mu_static = 0.2", "39", "3.58e-05", "1.25e-05")
    monkeypatch.setenv("COLUMNS", "40")
    print_sections("a title", [Section("a part", [], Table(headings, [row]))])
    text = capsys.readouterr().out
    assert {*row[1:], "coulomb,", "loading"} <= set(text.split())
    assert max(map(len, text.splitlines())) <= 40


def test_a_number_is_not_parted_from_its_unit_on_a_narrow_terminal(capsys, monkeypatch):
    from stiction.cli.tables import print_sections
    from stiction.text.sections import Section, Table

    rows = [("force at the trough before loading", "1.377 N", "10 N s/m")]
    monkeypatch.setenv("COLUMNS", "44")
    print_sections("a title", [Section("a part", [], Table(("quantity", "mean", "spread"), rows))])
    text = capsys.readouterr().out
    assert "1.377 N" in text
    assert "10 N s/m" in text
