"""The command line, run for real on real files."""

import errno
import json
import re
import shlex
import signal
import subprocess
import sys
from contextlib import contextmanager
from io import StringIO
from pathlib import Path

import numpy as np
import pytest
from rich.console import Console
from tests.waiting import INTERRUPTIBLE, PATIENCE, until

import stiction as st
from stiction.__main__ import main as start
from stiction.cli import COMMANDS, app, main
from stiction.cli.commands.run import report_lines
from stiction.cli.tokens import join_negative_values
from stiction.progress import display as progress

# runs the command, and says so once the simulation is on its way
TOLD = """
from stiction import simulation
from stiction.cli import main

run = simulation.run

def told(description, progress):
    said = []

    def report(fraction):
        if not said:
            said.append(print("on its way", flush=True))
        progress(fraction)

    return run(description, progress=report)

simulation.run = told
main()
"""


def stiction(*arguments: object, cwd: Path) -> subprocess.CompletedProcess[str]:
    """Run the installed command in a process of its own."""
    command = [sys.executable, "-c", "from stiction.cli import main; main()", *map(str, arguments)]
    return subprocess.run(
        command, cwd=cwd, capture_output=True, text=True, timeout=PATIENCE, check=False
    )


def inside(*arguments: object) -> int:
    """Run the command in this process; return the exit status."""
    with pytest.raises(SystemExit) as end:
        main([str(argument) for argument in arguments])
    return int(end.value.code or 0)


@pytest.mark.parametrize(
    "words",
    [["--", "--zero", "-3"], ["--zero", "-o"], ["data.csv", "-3"], ["-3"], ["--Zero", "-3"]],
)
def test_words_below_zero_that_follow_no_option_stand_alone(words):
    assert join_negative_values(words) == words


@pytest.fixture
def config(tmp_path):
    """What `stiction init` writes, shortened to 50 ms."""
    path = tmp_path / "slider.toml"
    assert inside("init", path) == 0
    text = path.read_text()
    assert 'duration = "5 s"' in text
    path.write_text(text.replace('duration = "5 s"', 'duration = "50 ms"'))
    return path


def test_help_teaches(tmp_path):
    done = stiction("--help", cwd=tmp_path)
    assert done.returncode == 0
    for name in COMMANDS:
        assert name in done.stdout
    assert "stiction init my.toml" in done.stdout


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_explains_itself(name, capsys):
    assert inside(name, "--help") == 0
    text = capsys.readouterr().out
    assert f"stiction {name}" in text
    lacks = f"its docstring lacks an example, or what its arguments are:\n{text}"
    assert len(text.splitlines()) > 8, lacks


@pytest.mark.parametrize("name", COMMANDS)
def test_help_has_an_example_of_each_option_and_speaks_of_what_the_command_takes(name):
    known = app[name].assemble_argument_collection(parse_docstring=True)
    words = {each.name: each.parameter.help or "" for each in known}
    options = [x.name for x in known if x.name.startswith("-") and x.token_count()[0]]
    assert [option for option in options if "Example:" not in words[option]] == []
    assert "CONFIG" in words or not any("CONFIG" in text for text in words.values())


def test_the_explorer_takes_changes_and_a_preset(monkeypatch, tmp_path, capsys):
    opened = []
    monkeypatch.setattr(
        "stiction.explorer.door.explore", lambda source, **settings: opened.extend(source)
    )
    config = tmp_path / "my.toml"
    text = st.Description.of(st.presets.nakano_popov_2020(), "5 s").to_toml()
    config.write_text(text, "utf-8")
    assert inside("explore", config, "--set", "duration=100s", "--set", "phi=3deg") == 0
    assert inside("explore", "--preset", "leine-belt", "--set", "V=2mm/s") == 0
    file, preset = (each.description for each in opened)
    assert [each.name for each in opened] == ["my.toml, changed", "leine-belt (Leine et al. 1998)"]
    assert file.run.duration == 100.0
    assert file.slider.misalignment == pytest.approx(np.radians(3.0))
    assert preset.slider.drive.velocity == pytest.approx(2e-3)
    assert inside("explore", "--set", "phi=3deg") == 2
    assert inside("explore", config, "--preset", "leine-belt") == 2
    assert len(opened) == 2
    assert "name its file or a preset" in capsys.readouterr().err


@pytest.mark.parametrize("name", ["analyse", "audit", "design", "explore", "fit", "import"])
def test_help_has_the_options_of_a_record_s_file_behind_those_of_the_command(name, capsys):
    """Twenty of them stood in one list with the four of `stiction analyse`."""
    inside(name, "--help")
    own, of_record = capsys.readouterr().out.split("How a record is read")
    assert "--separator" in of_record
    assert "--separator" not in own
    for option in ("--output", "--port", "--trust", "--set"):
        assert f"{option} " not in of_record


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ("paper -o", "-o needs a value; write for example: -o paper-output"),
        ("run my.toml", "--output is missing; write for example: -o my.nc"),
        ("stability a --between 1", '--between needs 2 values; write for example: --between "1 '),
        ("plot", "RESULT is missing; write for example: stiction plot"),
        ("plot a.nc -o b.png c", "'c' is one argument too many; put a value that holds blanks"),
    ],
)
def test_an_incomplete_command_is_answered_with_an_example(arguments, message, capsys):
    assert inside(*arguments.split()) == 2
    assert message in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ("stability", "give either the file of a description or --preset NAME"),
        ("audit", "give either the file of a description or --preset NAME"),
        ("audit --preset leine-belt --time ms", "there is no record to which this could apply"),
        ("stability --preset leine-belt --over phi --over V --over W", "give --over once or twice"),
        ("sweep -o a.zarr", "give either a study's file or --preset NAME"),
        ("sweep a.toml -o a.zarr --quiet --json-lines", "exclude each other; give one"),
        (
            "bogus",
            "unknown command 'bogus'; known: analyse, animate, audit, check, compare, design",
        ),
        ("analize data.csv", "unknown command 'analize'; did you mean 'analyse'?"),
        ("stabilty", "unknown command 'stabilty'; did you mean 'stability'?"),
    ],
)
def test_a_fault_of_the_command_is_called_that(arguments, message, capsys):
    """It was an "error file"; of unknown commands eight of twenty were listed."""
    assert inside(*arguments.split()) == 2
    said = " ".join(capsys.readouterr().err.split())
    assert message in said
    assert said.startswith("error command line:") or "a.toml" in said


def test_paper_says_that_a_file_is_not_a_folder(tmp_path, capsys):
    (tmp_path / "file").write_text("")
    assert inside("paper", "-o", tmp_path / "file") == 2
    assert "file: exists and is not a folder; choose another name" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("map .", ".: is not the store of a study; make one with 'stiction sweep'"),
        ("analyse .", ".: is a folder, not the file of one run"),
        ("analyse /", "/: is a folder, not the file of one run"),
        ("run my.toml -o .", ".: is a folder; name a file in it"),
    ],
)
def test_a_folder_without_a_name_is_refused_in_words(words, message, config, monkeypatch, capsys):
    monkeypatch.chdir(config.parent)
    config.rename("my.toml")
    assert inside(*words.split()) == 2
    assert message in capsys.readouterr().err


def test_a_choice_that_is_none_is_one_fault(config, tmp_path, capsys):
    said = ("--set", "multiscale=yes", "--set", "smoothing=x")
    assert inside("run", config, "-o", tmp_path / "a.nc", *said) == 2
    assert capsys.readouterr().err.splitlines()[1:] == [
        "  run.smoothing: must be 'root' or 'arctan', is 'x'",
        "  run.multiscale: must be 'auto', True or False, is 'yes'",
    ]


def test_a_preset_is_listed_explained_run_and_written(tmp_path, capsys):
    assert inside("presets") == 0
    assert "veraszto-stepan" in capsys.readouterr().out
    assert inside("presets", "modelica-spring") == 0
    assert "hard stops" in capsys.readouterr().out
    assert inside("run", "--preset", "modelica-spring", "-o", tmp_path / "a.nc") == 0
    text = capsys.readouterr().out
    assert "3 of 3 agree" in text
    changed = ("--set", "duration=1s", "-o", tmp_path / "b.nc")
    assert inside("run", "--preset", "modelica-spring", *changed) == 0
    assert "agree" not in capsys.readouterr().out
    assert st.load(tmp_path / "b.nc").description.run.duration == 1.0
    assert inside("init", tmp_path / "c.toml", "--preset", "modelica-spring") == 0
    assert inside("run", tmp_path / "c.toml", "-o", tmp_path / "c.nc") == 0
    assert st.load(tmp_path / "c.nc").data.equals(st.load(tmp_path / "a.nc").data)
    capsys.readouterr()
    assert inside("run", "-o", tmp_path / "d.nc") == 2
    assert "either the file of a description or --preset NAME" in capsys.readouterr().err
    assert inside("presets", "nonsense") == 2


def test_init_writes_the_paper_s_system(tmp_path, slider):
    assert inside("init", tmp_path / "a.toml") == 0
    assert st.Slider.from_toml(tmp_path / "a.toml") == slider
    assert inside("init", tmp_path / "a.toml") == 2  # does not write over it
    assert inside("init", tmp_path / "a.toml", "--force") == 0
    assert inside("init", tmp_path / "no" / "a.toml") == 2


def test_run_and_plot(config, tmp_path):
    done = stiction("run", config, "--output", "a.nc", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "501 samples" in done.stdout
    assert "stiction plot a.nc" in done.stdout
    assert st.load(tmp_path / "a.nc").status.ok
    done = stiction("plot", "a.nc", "--output", "a.png", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")
    assert {path.name for path in tmp_path.iterdir()} == {"slider.toml", "a.nc", "a.png"}


def test_the_largest_force_is_told_beside_the_load_at_that_time(config, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    ramp = '[{piece = "ramp", to = "30 N", duration = "0.05 s"}]'
    config.write_text(f"{config.read_text()}\n[load]\nprogram = {ramp}\n")
    result = st.run(config)
    lines = " ".join(report_lines(result, tmp_path / "a.nc"))
    at = int(np.abs(result.samples["spring_x"]).argmax())
    share = abs(result.samples["spring_x"][at]) / result.samples["normal_load"][at]
    assert result.samples["normal_load"][at] > 1.1 * result.slider.normal_load
    assert f"{share:.4g} of the normal load at that time" in lines


def test_a_bad_description_leaves_nothing_behind(config, tmp_path):
    config.write_text(
        config.read_text().replace('mass = "0.25 kg"', "mass = 0").replace("phi", "ph")
    )
    done = stiction("run", config, "--output", "a.nc", cwd=tmp_path)
    assert done.returncode == 2
    assert "slider.mass: must be greater than 0" in done.stderr
    assert "slider.phi: missing" in done.stderr
    assert "did you mean 'phi'" in done.stderr
    assert "Traceback" not in done.stderr
    assert not (tmp_path / "a.nc").exists()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("run", "none.toml", "--output", "a.nc"), "No such file"),
        (("plot", "none.nc", "--output", "a.png"), "no such file"),
        (("run", "slider.toml", "--output", "no/a.nc"), "make it first"),
        (("plot", "slider.toml", "--output", "a.png"), "not a NetCDF file"),
    ],
)
def test_a_wrong_path_is_one_message(config, tmp_path, monkeypatch, capsys, arguments, words):
    monkeypatch.chdir(tmp_path)
    assert inside(*arguments) == 2
    assert words in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["slider.toml"]


SYSTEM = "stiction run --preset leine-belt -o leine-belt.nc"
READY = "stiction sweep --preset damping-diagram -o damping-diagram.zarr"


@pytest.mark.parametrize(
    ("words", "remedy"),
    [
        ("run leine-belt -o a.nc", SYSTEM),
        ("run leine_belt -o a.nc", SYSTEM),
        ("audit Leine-Belt", SYSTEM),
        ("stability leine-belt.toml", SYSTEM),
        ("compare leine-belt --law coulomb -o a.png", SYSTEM),
        ("fit a.csv --rig leine-belt -o a.nc", SYSTEM),
        ("design leine-belt", SYSTEM),
        ("explore leine-belt --no-browser", SYSTEM),
        ("sweep leine-belt -o a.zarr", SYSTEM),
        ("sweep --preset leine-belt -o a.zarr", SYSTEM),
        ("plot leine-belt -o a.png", SYSTEM),
        ("analyse leine-belt", SYSTEM),
        ("export leine-belt -o a.csv", SYSTEM),
        ("map leine-belt", SYSTEM),
        ("sweep damping-diagram -o a.zarr", READY),
        ("run damping-diagram -o a.nc", READY),
        ("run --preset damping-diagram -o a.nc", READY),
        ("map damping_diagram", READY),
        ("run lean-belt -o a.nc", "stiction init"),
    ],
)
def test_the_name_of_a_preset_in_place_of_a_file_is_known(
    words, remedy, tmp_path, monkeypatch, capsys
):
    monkeypatch.chdir(tmp_path)
    assert inside(*words.split()) == 2
    said = " ".join(capsys.readouterr().err.split())
    assert remedy in said
    assert ("st.presets.leine_belt()" in said) is (remedy == SYSTEM)
    assert not [*tmp_path.iterdir()]


def test_a_file_with_the_name_of_a_preset_is_read(config, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    Path("leine-belt").write_bytes(config.read_bytes())
    assert inside("run", "leine-belt", "--set", "duration=1ms", "-o", "a.nc") == 0
    Path("leine-belt").write_text("mass = 1 kg")
    assert inside("run", "leine-belt", "-o", "a.nc") == 2
    assert "--preset" not in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "head"),
    [
        ("analyse none.csv", "file"),
        ("plot none.nc -o a.png", "file"),
        ("export a.csv -o b.csv", "file"),  # whose columns are unclear
        ("run none.toml -o a.nc", "description"),
    ],
)
def test_the_head_of_a_message_says_what_it_is_about(words, head, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    Path("a.csv").write_text("a,b,c\n" + "1,2,3\n2,3,4\n3,4,5\n" * 3)
    assert inside(*words.split()) == 2
    assert capsys.readouterr().err.startswith(f"error {head}:\n")


def test_what_is_no_result_is_told_how_it_becomes_a_table(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    st.Record(time=np.arange(3.0), force=np.arange(3.0)).save("a.nc")
    (tmp_path / "a.csv").write_text("time [s],force [N]\n0,0\n1,1\n2,2\n")
    (tmp_path / "a.zarr").mkdir()
    (tmp_path / "a.zarr/zarr.json").touch()
    for name, words in (
        ("a.nc", "st.read_record read it, whose export(...) writes a table"),
        ("a.csv", "st.read_record reads it, whose export(...) writes a table"),
        ("a.zarr", "st.open_study reads it, whose to_dataframe() is a table"),
    ):
        assert inside("export", name, "-o", "b.csv") == 2
        assert words in " ".join(capsys.readouterr().err.split())


KINDS = {
    "slider.toml": "stiction run slider.toml -o slider.nc",
    "study.toml": "stiction sweep study.toml -o study.zarr",
    "study.zarr": "stiction map study.zarr",
    "run.nc": "stiction analyse run.nc",
    "data.csv": "stiction analyse",
}
TAKES = {  # what each command takes
    "run": ("slider.toml",),
    "audit": ("slider.toml", "study.toml"),
    "sweep": ("study.toml",),
    "plot": ("run.nc",),
    "check": ("run.nc", "study.zarr"),
    "analyse": ("run.nc", "data.csv"),
    "import": ("run.nc", "data.csv"),
    "map": ("study.zarr",),
}


@pytest.fixture(scope="module")
def one_of_each(slider, tmp_path_factory):
    """A folder with a file of each kind."""
    folder = tmp_path_factory.mktemp("kinds")
    described = st.Description(slider, st.Initial(), st.Settings(duration="20 ms"))
    text = described.to_toml()
    (folder / "slider.toml").write_text(text)
    (folder / "study.toml").write_text(f"{text}\n[axes.phi]\nvalues = ['1 deg']\n")
    st.sweep(st.Study.from_toml(folder / "study.toml"), folder / "study.zarr")
    st.run(described).save(folder / "run.nc")
    (folder / "data.csv").write_text("time (s);force (N)\n" + "0,5;1e-3\n" * 20)
    return folder


@pytest.mark.parametrize(
    ("command", "given"), [(c, g) for c, taken in TAKES.items() for g in KINDS if g not in taken]
)
def test_who_gives_another_kind_of_file_learns_what_takes_it(
    one_of_each, tmp_path, monkeypatch, capsys, command, given
):
    monkeypatch.chdir(one_of_each)
    before = sorted(one_of_each.iterdir())
    suffix = {"plot": "png", "map": "png", "sweep": "zarr", "audit": "html"}.get(command, "nc")
    output = () if command in ("check", "analyse") else ("-o", tmp_path / f"a.{suffix}")
    assert inside(command, given, *output) == 2
    said = " ".join(capsys.readouterr().err.split())
    if (command, given) == ("run", "study.toml"):
        assert "axes: is a table of a study, which 'stiction sweep' runs" in said
    elif (command, given) == ("sweep", "slider.toml"):
        assert "write for example a table [axes.phi]" in said
    else:
        assert KINDS[given] in said
    assert sorted(one_of_each.iterdir()) == before
    assert not [*tmp_path.iterdir()]


def test_plot_refuses_an_unknown_format(config, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert inside("run", "slider.toml", "--output", "a.nc") == 0
    assert inside("plot", "a.nc", "--output", "a.bmp") == 2
    assert ".png" in capsys.readouterr().err


def test_run_does_not_write_over_what_is_no_result(config, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    before = config.read_text()
    assert inside("run", "slider.toml", "--output", "slider.toml") == 2
    assert "name it slider.nc" in capsys.readouterr().err
    assert config.read_text() == before
    (tmp_path / "folder.nc").mkdir()
    assert inside("run", "slider.toml", "--output", "folder.nc") == 2
    assert "not a file" in capsys.readouterr().err


@pytest.mark.skipif(sys.platform == "win32", reason="signals")
def test_ctrl_c_ends_a_long_run_cleanly(config, tmp_path):
    config.write_text(config.read_text().replace('"50 ms"', '"1e5 s"').replace("10 kHz", "1 Hz"))
    process = subprocess.Popen(
        [sys.executable, "-c", INTERRUPTIBLE + TOLD, "run", str(config), "--output", "long.nc"],
        cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    assert process.stdout.readline() == "on its way\n"
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=PATIENCE)
    assert process.returncode == 130
    assert "interrupted" in errors
    assert "Traceback" not in errors
    assert not (tmp_path / "long.nc").exists()


def test_a_run_that_ends_early_says_so(config, tmp_path, monkeypatch, capsys):
    from stiction import simulation

    whole = simulation.run
    monkeypatch.setattr(simulation, "run", lambda d, progress: whole(d, max_steps=100))
    monkeypatch.chdir(tmp_path)
    assert inside("run", "slider.toml", "--output", "a.nc") == 1
    assert "ended early" in capsys.readouterr().out
    assert st.load("a.nc").status is st.Status.TOO_MANY_STEPS  # what was computed is kept


def test_paper(tmp_path, capsys):
    assert inside("paper", "--out", tmp_path / "out") == 0
    text = capsys.readouterr().out
    assert "WRONG" not in text
    names = {path.name for path in (tmp_path / "out").iterdir()}
    figures = ["first-look", "figure-1-and-2", "beyond-zero-slip"]
    for figure in [*figures, *(f"figure-{number}" for number in (3, 4, 5))]:
        assert {f"{figure}.png", f"{figure}.pdf"} <= names
    entries = json.loads((tmp_path / "out" / "numbers.json").read_text())
    assert len(entries) > 20
    verdicts = [entry["verdict"] for entry in entries]
    assert set(verdicts) == {"agrees", "finding"}
    assert verdicts.count("finding") == 2


def test_paper_one_figure(tmp_path):
    assert inside("paper", "--out", tmp_path, "--figure", 5) == 0
    assert {path.name for path in tmp_path.iterdir()} == {"figure-5.png", "figure-5.pdf"}


def test_a_wrong_number_is_an_exit_status(tmp_path, monkeypatch, capsys):
    from stiction.presets import Number
    from stiction.reproduction import reproduce

    wrong = [Number("here", "one", 1.0, 2.0, 0.5), Number("here", "nothing", 0.0, float("nan"), 1)]
    monkeypatch.setattr(reproduce, "numbers", lambda *_: wrong)
    monkeypatch.setattr(reproduce, "DURATION", 0.6)
    monkeypatch.setattr(reproduce, "save", lambda *_: [])  # no figures
    assert inside("paper", "--out", tmp_path) == 1
    assert "0 of 2 of the paper's numbers agree; wrong: one, nothing" in capsys.readouterr().out


def test_work_that_lasts_says_so_through_a_pipe(capsys, monkeypatch):
    monkeypatch.setattr(progress, "FIRST_LINE", 0.01)
    lines = []
    monkeypatch.setattr(progress, "print_line", lines.append)
    with progress.show_progress("simulating") as report:
        report(0.5)
        until(lambda: bool(lines), "the first line")
    assert lines[0].startswith("simulating: ")
    assert progress.line("auditing", 0.1, 1200.0) == "auditing: 10 % after 20 min, about 3.0 h left"
    assert capsys.readouterr() == ("", "")


def test_a_terminal_shows_no_percentage_of_work_whose_share_is_not_told(monkeypatch):
    """An analysis of 4 million samples showed "0 %" for half a minute."""
    screen = StringIO()
    terminal = Console(file=screen, force_terminal=True, width=100)
    monkeypatch.setattr("rich.console.Console", lambda **_: terminal)
    monkeypatch.setattr(progress, "PATIENCE", 0.0)
    with progress.show_progress("analysing") as report:
        until(lambda: "analysing" in screen.getvalue(), "the bar")
        assert "%" not in screen.getvalue()
        report(0.25)
        until(lambda: " 25 %" in screen.getvalue(), "the share")


@pytest.mark.parametrize(
    ("verb", "titles"), [("import", ["reading"]), ("analyse", ["reading", "analysing"])]
)
def test_reading_is_not_silent(verb, titles, tmp_path, noted):
    record = tmp_path / "record.csv"
    record.write_text("t [s],F [N]\n" + "".join(f"{0.01 * i:.2f},1.0\n" for i in range(50)))
    assert inside(verb, record) == 0
    assert noted == titles


@pytest.fixture
def noted(monkeypatch):
    """Return the titles of all progress that is shown."""
    begun = []

    @contextmanager
    def note(title):
        begun.append(title)
        yield lambda fraction: None

    monkeypatch.setattr(progress, "show_progress", note)
    return begun


@pytest.mark.parametrize("verb", ["plot", "stability", "map"])
def test_drawing_is_not_silent(verb, tmp_path, noted):
    """A map of 18 runs said nothing for 12 s."""
    source = tmp_path / "source"
    slider = st.presets.nakano_popov_2020()
    if verb == "plot":
        source = st.simulate(slider, "20 ms", sample_rate="1 kHz").save(tmp_path / "run.nc")
    elif verb == "stability":
        source.write_text(slider.to_toml())
    else:
        base = st.Description(slider, st.Initial(), st.Settings(duration="2 ms"))
        axes = {"phi": st.Grid("1 deg", "3 deg", 2)}
        st.sweep(st.Study(base=base, axes=axes, measures=["stick_count"]), source)
    assert inside(verb, source, "-o", tmp_path / "drawn.png") == 0
    assert noted == ["drawing"]


def test_compilation_is_no_measure_of_the_time_left():
    """After 5 s of compilation at 2 %, a run of 10 s was said to take 4 minutes."""
    for fraction in (0.02, 0.0201):  # nor is a tenth of a second behind it
        shown = progress.line("simulating", fraction, 5.0, since=(0.02, 4.9))
        assert shown == "simulating: 2 % after 5 s"
    later = progress.line("simulating", 0.52, 10.0, since=(0.02, 5.0))
    assert later == "simulating: 52 % after 10 s, about 5 s left"


def test_the_first_steps_are_no_measure_of_the_time_left():
    """A run of 48 s was said to take 1.3 h, until a map took its cycles."""
    assert progress.line("simulating", 0.007, 35.0) == "simulating: 1 % after 35 s"
    assert progress.line("simulating", 0.02, 35.0).endswith("about 29 min left")


def test_a_suggested_command_quotes_a_path_with_blanks(config, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    folder = tmp_path / "my rigs"
    folder.mkdir()
    capsys.readouterr()
    assert inside("init", "my rigs/my rig.toml", "--schema") == 0
    assert inside("run", config, "--output", "my rigs/a b.nc") == 0
    assert inside("plot", config, "--output", "a.png") == 2
    assert inside("run", "my rigs/a b.nc", "--output", "c.nc") == 2
    said = "".join(capsys.readouterr())
    commands = re.findall(r"stiction (?:run|plot|analyse) .*?(?=, | takes|\n)", said)
    paths = [each for command in commands for each in shlex.split(command)[2:]]
    assert {each for each in paths if "a b" in each} == {"my rigs/a b.nc", "my rigs/a b.png"}
    assert {each for each in paths if "my rig." in each} == {
        *("my rigs/my rig.toml", "my rigs/my rig.nc")
    }


def test_ctrl_c_while_it_loads_is_no_traceback(monkeypatch, capsys):
    class Interrupt:
        def find_spec(self, name, path=None, target=None):
            if name == "stiction.cli":
                raise KeyboardInterrupt

    for each in ("gc.set_threshold", "atexit.register"):  # of this process
        monkeypatch.setattr(each, lambda *_: None)
    monkeypatch.delitem(sys.modules, "stiction.cli")
    monkeypatch.setattr(sys, "meta_path", [Interrupt(), *sys.meta_path])
    with pytest.raises(SystemExit) as end:
        start()
    assert end.value.code == 130
    assert capsys.readouterr().err == "interrupted\n"


@pytest.mark.parametrize("source", [[], ["my.toml"], ["MY.TOML"]])
def test_ctrl_c_is_the_end_of_the_explorer(monkeypatch, capsys, source):
    """A description in capitals was read as a record."""

    def interrupted(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr("stiction.explorer.door.explore", interrupted)
    assert inside("explore", *source) == 0
    assert "closed" in capsys.readouterr().err


def test_work_that_is_over_soon_says_nothing(capsys):
    with progress.show_progress("simulating") as report:
        report(1.0)
    assert capsys.readouterr() == ("", "")


@pytest.mark.parametrize("encoding", ["utf-16", "utf-16-le", "utf-16-be"])
def test_a_description_in_utf_16_is_named(encoding, tmp_path, capsys):
    path = tmp_path / "my.toml"
    path.write_text(st.presets.nakano_popov_2020().to_toml(), encoding=encoding)
    assert inside("audit", path) == 2
    assert "is not text in UTF-8; it is UTF-16, as Windows programs write it: save it" in words(
        capsys
    )


def test_a_description_in_another_encoding_says_how_to_save_it(tmp_path, capsys):
    path = tmp_path / "my.toml"
    path.write_text(st.presets.nakano_popov_2020().to_toml() + "# \u00b5\n", encoding="latin-1")
    assert inside("audit", path) == 2
    assert "save it in UTF-8" in words(capsys)


def words(capsys):
    return " ".join(capsys.readouterr().err.split())


def test_a_percentage_as_coefficient_is_named(tmp_path, capsys):
    """After a run, and before the runs of a study, whose axis may hold it."""
    slider, said = st.presets.nakano_popov_2020(), "if a percentage is meant, write 0.4."
    meant = slider.replace(friction=st.Coulomb(mu_0=40.0))
    run = st.simulate(meant, "1 ms", sample_rate="1 kHz")
    assert said in report_lines(run, Path("run.nc"))[-1]
    run = st.simulate(slider, "1 ms", sample_rate="1 kHz")
    assert "percentage" not in " ".join(report_lines(run, Path("run.nc")))
    study = tmp_path / "study.toml"
    axis = '[run]\nduration = 1e-3\n\n[axes."friction.mu_0"]\nvalues = [40.0, 30.0]\n'
    for text, named in ((axis, True), (axis.replace("40.0", "0.4"), False)):
        study.write_text(slider.to_toml() + text)
        arguments = ["sweep", str(study), "-o", str(tmp_path / f"{named}.zarr"), "--threads", "1"]
        with pytest.raises(SystemExit):
            main(arguments)
        assert (said in words(capsys)) == named


@pytest.mark.parametrize(
    ("error", "says"),
    [
        (OSError(errno.EADDRINUSE, "Address already in use"), "error system: Address already in"),
        (OSError("what no number names"), "error system: what no number names; the operating"),
        (OSError(errno.EIO, "Input/output error"), "error file: standard output: Input/output"),
        (OSError(errno.EIO, "Input/output error", "a.nc"), "error file: a.nc: Input/output error"),
    ],
)
def test_an_error_of_the_system_is_not_blamed_on_standard_output(monkeypatch, capfd, error, says):
    """Unless it is one of writing there."""

    def raise_it(*_, **__):
        raise error

    monkeypatch.setattr("stiction.cli.app", raise_it)
    monkeypatch.setattr("stiction.cli.give_up", lambda _: None)
    with pytest.raises(SystemExit) as end:
        main(["presets"])
    assert end.value.code == 2
    assert " ".join(capfd.readouterr().err.split()).startswith(says)
