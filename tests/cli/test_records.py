"""``stiction import`` and ``stiction analyse`` on measured records."""

import gzip
import json
import re
from html import unescape

import numpy as np
import pandas as pd
import pytest
from tests.measured import FOLDER

import stiction as st
from stiction.cli import main


def inside(*arguments):
    with pytest.raises(SystemExit) as end:
        main([str(argument) for argument in arguments])
    return int(end.value.code or 0)


@pytest.fixture
def data(tmp_path):
    """A sawtooth in ms and mN, without units in its header."""
    time = np.arange(0.0, 20.0, 0.01)
    noise = 0.002 * np.random.default_rng(1).standard_normal(len(time))
    force = 1.0 + 0.2 * (time % 2.0) / 2.0 + noise
    rows = "".join(f"{1e3 * t:.1f},{1e3 * f:.2f}\n" for t, f in zip(time, force, strict=True))
    path = tmp_path / "data.csv"
    path.write_text(f"time,force\n{rows}")
    return path


def test_analyse_takes_a_record_with_its_units(data, capsys):
    assert inside("analyse", data, "--time", "ms", "--force", "mN", "--normal-load", "5 N") == 0
    said = capsys.readouterr().out
    assert "Read as" in said
    assert "force along the drive" in said
    assert "sticks and slips" in said
    numbers = json.loads((data.parent / "data-analysis" / "analysis.json").read_text())
    assert numbers["friction"]["static"]["coefficient"] == pytest.approx(0.24, abs=0.001)


@pytest.mark.parametrize(
    ("name", "folder"),
    [
        ("steel.dry.csv", "steel.dry-analysis"),
        ("0.5N.csv", "0.5N-analysis"),
        ("data.csv.gz", "data-analysis"),
        ("a.html.csv", "a.html-analysis"),
    ],
)
def test_a_file_may_have_dots_in_its_name(data, name, folder):
    """A dot made the folder beside it one of an unknown format, and nothing was analysed."""
    path, content = data.with_name(name), data.read_bytes()
    path.write_bytes(gzip.compress(content) if name.endswith(".gz") else content)
    data.unlink()
    assert inside("analyse", path, *UNITS) == 0
    assert (path.parent / folder / "report.txt").exists()


UNITS = ("--time", "ms", "--force", "mN")


def test_a_page_of_an_analysis_holds_its_report_and_figures_in_one_file(data, capsys):
    """`-o rep.html` made a folder of that name, without a word."""
    page = data.with_name("rep.html")
    rig = ("--stiffness", "1 N/m", "--drive-velocity", "0.1 m/s", "--normal-load", "5 N")
    assert inside("analyse", data, *UNITS, *rig, "-o", page) == 0
    said = capsys.readouterr().out
    assert f"wrote {page}" in said.replace("\n", "")
    assert sorted(data.parent.iterdir()) == [data, page]
    text = page.read_text("utf-8")
    assert "<title>Analysis of data.csv</title>" in text
    titles = [unescape(each) for each in re.findall(r"<h2>(.*?)</h2>", text)]
    at = [re.search(rf"^{title}$", said, re.M).start() for title in titles]
    assert at == sorted(at)
    assert {"In short", "Cycle by cycle", "Read as"} <= {*titles}
    assert text.count("data:image/png;base64,") == text.count("<figure") > 0
    assert not re.findall(r'(?:src|href)="(?!data:)(?!https://arxiv)', text)
    found = st.analyse(st.read_record(data, time="ms", force="mN"))
    again = found.write_html(data.with_name("python.html"), "data.csv").read_text("utf-8")
    assert "<title>Analysis of data.csv</title>" in again


def test_a_run_s_page_has_a_figure_of_each_part_and_its_apparatus(tmp_path):
    slider = st.presets.nakano_popov_2020()
    st.simulate(slider, "5 s", sample_rate="10 kHz").save(tmp_path / "a.nc")
    assert inside("analyse", tmp_path / "a.nc", "-o", tmp_path / "a.html") == 0
    text = (tmp_path / "a.html").read_text("utf-8")
    for title in ("In short", "Creep", "Oscillation", "Energy"):
        assert "<figure" in text.partition(f"<h2>{title}</h2>")[2].partition("</section>")[0], title
    assert (
        st.Slider.from_toml(unescape(text.partition("<pre>")[2].partition("</pre>")[0])) == slider
    )


def test_a_test_s_figure_stands_in_its_own_section(tmp_path):
    time = np.arange(0.0, 62.0, 0.02)
    travel = np.interp(time, [0.0, 60.0, 62.0], [0.0, 0.6e-3, 0.8e-3])
    slip = np.maximum(travel - 0.6e-3, 0.0)
    mu = 0.6 + (time > 60.0) * (0.014 * np.log1p(9.0 * np.exp(-slip / 20e-6)) - 0.01)
    known = {"normal_load": "1 kN", "stiffness": "1 GN/m"}
    found = st.analyse(st.Record(time=time, force=1e3 * mu, drive_position=travel, **known))
    title = found.parts["procedure"].section.title
    text = found.write_html(tmp_path / "a.html").read_text("utf-8")
    assert "<figure" in text.partition(f"<h2>{title}</h2>")[2].partition("</section>")[0]


def test_a_folder_of_an_analysis_holds_what_was_printed(data, capsys):
    assert inside("analyse", data, *UNITS, "-o", data.with_name("rep")) == 0
    printed, text = capsys.readouterr().out, data.with_name("rep") / "report.txt"
    assert "wrote report.txt, analysis.json" in printed
    lines = text.read_text("utf-8").splitlines()
    assert lines[0] == str(data)
    assert max(map(len, lines[1:])) <= 100
    assert {"In short", "Cycles", "Cycle by cycle", "Read as"} <= {*lines}
    words = [re.findall(r"[\w.]+", each) for each in (" ".join(lines[1:]), printed)]
    assert not {*words[0]} - {*words[1]}
    assert len(words[0]) > 200


@pytest.mark.parametrize(
    ("name", "remedy"),
    [
        ("rep.pdf", "name a folder, such as rep, or write rep.html"),
        ("rep.csv", "name a folder, such as rep, or write rep.html"),
        ("none/rep.html", "does not exist; make it first"),
        ("data.csv/rep", "does not exist"),
    ],
)
def test_an_analysis_goes_to_a_folder_or_a_page(data, name, remedy, capsys):
    assert inside("analyse", data, *UNITS, "-o", data.parent / name) == 2
    assert remedy in " ".join(capsys.readouterr().err.split())
    assert sorted(data.parent.iterdir()) == [data]


@pytest.mark.parametrize("name", ["rig.2", "v1.5", "old.results"])
def test_a_folder_may_have_a_point_in_its_name(data, name):
    if name == "old.results":  # such a one has to be there
        data.with_name(name).mkdir()
    assert inside("analyse", data, *UNITS, "-o", data.with_name(name)) == 0
    assert (data.with_name(name) / "report.txt").is_file()


@pytest.fixture
def three(data):
    """Records of one period, of half of it, and a run, in a folder each or together."""
    time = np.arange(0.0, 20.0, 0.01)
    fast = st.Record(time=time, force=1.0 + 0.2 * (time % 1.0), normal_load="4 N")
    run = st.simulate(st.presets.nakano_popov_2020(), "8 s", sample_rate="500 Hz")
    return [data, fast.save(data.with_name("fast.nc")), run.save(data.with_name("run.nc"))]


def test_several_records_are_a_row_each(three, capsys):
    """`analyse a.csv b.csv` was one argument too many."""
    csv = three[0]
    csv.with_suffix(".toml").write_text('[columns]\ntime = "ms"\nforce = "mN"\n')
    assert inside("analyse", *three) == 0
    said = capsys.readouterr().out
    assert "3 records: stick-slip (3)." in said
    folder = csv.with_name("records-analysis")
    assert sorted(each.name for each in folder.iterdir()) == ["records.csv", "report.txt"]
    table = pd.read_csv(folder / "records.csv", index_col="record")
    assert list(table.index) == ["data.csv", "fast.nc", "run.nc"]
    for path, known in zip(three, ({"time": "ms", "force": "mN"}, {}, None), strict=True):
        one = st.analyse(path if known is None else st.read_record(path, **known))
        row, mean = table.loc[path.name], one.summary["mean"]
        assert row["period [s]"] == pytest.approx(float(mean.sel(quantity="period")))
        assert row["drop [N]"] == pytest.approx(float(mean.sel(quantity="drop")))
        assert row["cycles"] == one.cycles.sizes["cycle"]
        assert row["static_force [N]"] == pytest.approx(one.friction.static.force)
        mu = one.friction.static.coefficient
        assert row["mu_static"] == pytest.approx(mu, nan_ok=True)
        phi = one.misalignment.phi if one.misalignment else np.nan
        assert row["misalignment [rad]"] == pytest.approx(phi, nan_ok=True)
        assert str(one.regime.kind) == row["motion"]
    text = (folder / "report.txt").read_text("utf-8")
    assert all(f"\n{path.name}\n" in text for path in three)


@pytest.mark.parametrize("target", ["all.csv", "all.html"])
def test_several_records_go_into_a_table_or_a_page_alone(three, target, capsys):
    names = three[1:]
    assert inside("analyse", *names, "-o", three[0].with_name(target)) == 0
    written = three[0].with_name(target).read_text("utf-8")
    assert all(path.name in written for path in names)
    before = {*three, three[0].with_name(target)}
    assert {*three[0].parent.iterdir()} == before
    if target == "all.html":
        assert written.count("<figure") >= 2
        assert "<h2>fast.nc: Cycles</h2>" in written


def test_the_faults_of_several_records_are_told_at_once_and_nothing_is_written(three, capsys):
    csv, fast, _ = three
    missing = csv.with_name("gone.csv")
    before = sorted(csv.parent.iterdir())
    assert inside("analyse", csv, fast, missing) == 2
    said = capsys.readouterr().err
    assert "gone.csv: no such file" in said
    assert "states no unit of the force" in said
    assert inside("analyse", fast, fast, "-o", csv.with_name("a.pdf")) == 2
    assert "name a folder, such as a, or write a.html" in " ".join(capsys.readouterr().err.split())
    assert sorted(csv.parent.iterdir()) == before


def test_files_of_one_name_are_told_by_their_folders_and_blocks_by_numbers(tmp_path, capsys):
    time = np.arange(0.0, 20.0, 0.01)
    rows = "".join(f"{t:.2f},{1.0 + 0.2 * (t % 2.0):.4f}\n" for t in time)
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "test.csv").write_text(
            f"t [s],F [N]\n{rows}{rows if name == 'b' else ''}"
        )
    target = tmp_path / "all.csv"
    assert inside("analyse", tmp_path / "a", tmp_path / "b" / "test.csv", "-o", target) == 0
    b = tmp_path / "b" / "test.csv"
    named = [str(tmp_path / "a" / "test.csv"), f"{b}, block 1", f"{b}, block 2"]
    assert list(pd.read_csv(target)["record"]) == named


def test_a_doubt_of_a_unit_names_the_option(data, capsys):
    rig = ("--stiffness", "1 N/m", "--drive-velocity", "0.1 m/s")
    assert inside("analyse", data, "--time", "1=s", "--force", "mN", *rig) == 0
    said = " ".join(capsys.readouterr().out.split())
    assert "is the time in ms, not in s? Give --time '1=ms'; is the force in N, not in mN?" in said
    assert "Give --force '2=N'; or stiffness or drive velocity" in said


def test_what_is_ambiguous_ends_with_status_2(data, capsys):
    assert inside("analyse", data) == 2
    said = capsys.readouterr().err
    assert (
        "states no unit of the force along the drive; say its unit: --force '2=N' makes it" in said
    )
    assert "Traceback" not in said
    assert inside("import", data, "--time", "ms", "--force", "bar") == 2
    assert inside("import", data.with_name("none.csv")) == 2
    assert sorted(data.parent.iterdir()) == [data]


def test_cycles_that_are_not_shown_are_counted(tmp_path, capsys):
    time = np.arange(0.0, 24.0, 0.01)
    record = st.Record(time=time, force=1.0 + 0.1 * (time % 2.0))
    count = st.analyse(record).cycles.sizes["cycle"]
    assert inside("analyse", record.save(tmp_path / "a.nc")) == 0
    said = " ".join(capsys.readouterr().out.split())
    assert count > 8
    export = "export(...) writes all, stiction analyse to cycles.csv."
    assert f"These are the first 8 of {count} cycles; {export}" in said
    rows = (tmp_path / "a-analysis" / "cycles.csv").read_text().splitlines()
    assert len([x for x in rows if not x.startswith("#")]) == 1 + count


@pytest.mark.parametrize("value", ["-1kg", "-1 kg", "-.5 kg"])
def test_a_quantity_below_zero_is_a_value_and_no_option(data, capsys, value):
    """The library takes a word with a hyphen for an option: "--mass needs a value"."""
    units = ("--time", "ms", "--force", "mN", "--zero", "-3 mN", "--begin", "-1s")
    assert inside("import", data, *units) == 0
    assert "zero" in capsys.readouterr().out
    assert inside("import", data, *units, "--mass", value) == 2
    assert f"mass: must be greater than 0, is '{value}'" in capsys.readouterr().err
    assert inside("import", data, "--mass", "--zero", "3 mN") == 2
    assert "--mass needs a value" in capsys.readouterr().err
    assert inside("import", data, "--mass", "1 kg", value) == 2
    assert "join a value below zero to its option: --zero=" in capsys.readouterr().err


def test_where_nothing_can_be_written_nothing_is_read_or_written(data, capsys):
    units = ("--time", "ms", "--force", "mN")
    assert inside("import", data, *units, "-o", data.with_name("record.csv")) == 2
    assert "name it record.nc" in capsys.readouterr().err
    target = data.with_name("record.nc")
    assert inside("import", data, *units, "-o", target, "--json", data.parent) == 2
    assert "is not a file" in capsys.readouterr().err
    assert sorted(data.parent.iterdir()) == [data]


def test_a_record_stored_in_a_session_shows_its_channels(data, capsys):
    target = data.with_name("made.nc")
    st.Record(time=[0.0, 1.0, 2.0], force=[0.1, 0.2, 0.4]).save(target)
    assert inside("import", target) == 0
    said = capsys.readouterr().out
    assert said.replace("\n", "").startswith(str(target))  # a long path is wrapped
    assert re.search(r"force +force along the drive +N +100 mN +400 mN", said)


def test_a_name_of_5000_characters_does_not_fill_the_screen(capsys):
    for command in ("import", "plot", "audit"):
        output = ("-o", "a.png") if command == "plot" else ()
        assert inside(command, 5000 * "a", *output) == 2
        assert len(capsys.readouterr().err) < 2500


def test_import_echoes_its_guess_and_stores_the_record(data, capsys):
    target, guess = data.with_name("record.nc"), data.with_name("guess.json")
    units = ("--time", "ms", "--force=-1 mN", "--mass", "30 g")
    assert inside("import", data, *units) == 0
    said = capsys.readouterr().out
    assert "2000 samples at 100 Hz" in said
    assert "nothing is stored" in said
    assert inside("import", data, *units, "-o", target, "--json", guess) == 0
    record = st.read_record(target)
    assert record.mass == 0.03
    assert record.force.max() < 0.0  # the sign was turned
    told = json.loads(guess.read_text())
    assert [use["channel"] for use in told[0]["uses"]] == ["time", "force"]
    assert told[0]["samples"] == 2000
    assert inside("analyse", target) == 0
    assert inside("analyse", target, "--force", "mN") == 2
    assert "in SI already: leave out --force" in capsys.readouterr().err


def test_blocks_become_a_file_each(tmp_path, capsys):
    path = tmp_path / "strokes.csv"
    path.write_text("t [s],F [N]\n0,1\n1,2\n2,3\n0,4\n1,5\n2,6\n")
    assert inside("import", path, "-o", tmp_path / "a.nc") == 0
    assert [each.name for each in sorted(tmp_path.glob("*.nc"))] == ["a-1.nc", "a-2.nc"]
    assert inside("import", path, "--block", "2", "-o", tmp_path / "b.nc") == 0
    assert st.read_record(tmp_path / "b.nc").force.tolist() == [4.0, 5.0, 6.0]
    assert inside("analyse", path) == 2
    assert "holds 2 blocks" in capsys.readouterr().err


@pytest.mark.parametrize("command", ["analyse", "import", "explore"])
def test_what_a_record_lacks_is_named_as_an_option_of_the_command(tmp_path, capsys, command):
    """The explorer named the argument of a function in Python."""
    path = tmp_path / "ratio.csv"
    path.write_text("t [s],F/mg [-]\n" + "".join(f"{0.1 * k:.1f},{0.01 * k}\n" for k in range(30)))
    assert inside(command, path) == 2
    assert "say --normal-load '? N'" in capsys.readouterr().err


def test_the_result_of_a_run_knows_its_units(tmp_path, slider, capsys):
    path = st.simulate(slider, "20 ms", sample_rate="1 kHz").save(tmp_path / "run.nc")
    assert inside("analyse", path, "--force", "mN") == 2
    assert "is the result of a run, in SI already: leave out --force" in capsys.readouterr().err


def test_a_measured_record_of_paper(tmp_path, capsys):
    path = FOLDER / "k1002_v4300.csv.gz"
    if not path.is_file():
        pytest.skip(f"no {path.name} beside the repository")
    known = ("--normal-load", "301.167 mN", "--mass", "30.7 g", "--stiffness", "1002 N/m")
    assert inside("analyse", path, *known, "--drive-velocity", "4300 um/s", "-o", tmp_path) == 0
    said = " ".join(capsys.readouterr().out.split())
    assert "is a friction coefficient: the force is that times the normal load" in said
    assert "stiffness over mass is 1.5 times" in said


def test_digits_are_those_that_the_scatter_leaves(tmp_path, capsys):
    """A mean has the digits of its standard error; without a load there is no column of µ."""
    lasts = 2.0 + 0.3 * np.random.default_rng(3).standard_normal(25)
    at = np.concatenate([[0.0], np.cumsum(lasts)])
    time = np.arange(0.0, at[-1], 0.01)
    begun = at[np.searchsorted(at, time, side="right") - 1]
    record = st.Record(time=time, force=1.0 + 0.1 * (time - begun))
    found = st.analyse(record)
    assert inside("analyse", record.save(tmp_path / "a.nc")) == 0
    said = capsys.readouterr().out
    row = found.summary.sel(quantity="period")
    error = float(row["standard_deviation"]) / float(row["number"]) ** 0.5
    assert 0.03 < error < 0.095  # so that the second decimal is the last
    assert f"time from trough to trough {float(row['mean']):.3g} s" in " ".join(said.split())
    assert f"every {float(row['mean']):.3g} s;" in " ".join(said.split())
    assert "friction force spread" in " ".join(said.split())
