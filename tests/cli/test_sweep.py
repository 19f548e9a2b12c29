"""``stiction sweep``: the command line of studies."""

import json
import shutil
import signal
import subprocess
import sys
from functools import partial
from io import StringIO
from pathlib import Path

import pytest
import xarray as xr
from rich.console import Console
from tests.unit.study.test_execution import tallies
from tests.waiting import INTERRUPTIBLE, PATIENCE, until

import stiction as st
from stiction.analysis.motion.regime.kinds import UNDETERMINED
from stiction.cli import main, tally
from stiction.progress import display as progress
from stiction.study.variables.measures import MEASURES
from stiction.study.view.view import kinds

EVERY_MEASURE = ", ".join(sorted(MEASURES))  # and no former name

STUDY = """
[study]
measures = ["peak_force", "time_stuck"]

[axes.phi]
from = "1 deg"
to = "4 deg"
count = 4

[axes."drive.velocity"]
values = ["1 mm/s", "2 mm/s"]
"""


@pytest.fixture
def config(tmp_path):
    """The paper's system for 50 ms, over eight pairs of values."""
    path = tmp_path / "study.toml"
    assert inside("init", path) == 0
    text = path.read_text().replace('duration = "5 s"', 'duration = "50 ms"')
    path.write_text(text.replace('sample_rate = "10 kHz"', "") + STUDY)
    return path


def inside(*arguments: object) -> int:
    with pytest.raises(SystemExit) as end:
        main([str(argument) for argument in arguments])
    return int(end.value.code or 0)


def test_a_study_is_run_and_gone_on_with(config, tmp_path, capsys):
    assert inside("sweep", config, "--output", tmp_path / "a.zarr", "--threads", 2) == 0
    assert "a.zarr: 8 runs" in capsys.readouterr().out
    data = xr.open_zarr(tmp_path / "a.zarr")
    assert data["peak_force"].shape == (4, 2)
    assert inside("sweep", config, "--output", tmp_path / "a.zarr", "--quiet") == 0
    assert capsys.readouterr() == ("", "")
    assert inside("sweep", config, "--output", tmp_path / "a.zarr") == 0
    assert "a.zarr: 8 runs, of which 8 were already there\n" in capsys.readouterr().out


def test_progress_on_a_terminal(config, tmp_path, capsys, monkeypatch):
    monkeypatch.setenv("FORCE_COLOR", "1")  # what rich takes for a terminal
    monkeypatch.setenv("COLUMNS", "200")
    assert inside("sweep", config, "-o", tmp_path / "a.zarr", "--threads", 1) == 0
    shown = capsys.readouterr().err
    assert "8 of 8 runs" in shown
    assert "a second" in shown
    assert "left" in shown


class FakeTime:
    """A clock without delay: all happens when the work is over, at the seconds that it would."""

    def __init__(self, monkeypatch, ends):
        self.now, self.ends, self.events = 0.0, ends, []
        for module in (progress, tally):
            monkeypatch.setattr(module, "monotonic", lambda: self.now)
        monkeypatch.setattr(progress, "Event", lambda: self)
        monkeypatch.setattr(progress, "Thread", Late)

    def wait(self, pause):
        """Let a pause pass, and what happens in it; return whether the work is over."""
        until = self.now + pause
        while self.events and self.events[0][0] <= min(until, self.ends):
            self.now, event = self.events.pop(0)
            event()
        self.now = until
        return self.now > self.ends

    def set(self):
        """Leave the end of the work to the clock."""


class Late:
    """A thread that does its work when it is waited for."""

    def __init__(self, target, daemon):
        self.join = target

    def start(self):
        """Begin later."""


def said_through_a_pipe(found, ends, monkeypatch):
    """Return what is printed, and when, of tallies that come at their seconds."""
    clock = FakeTime(monkeypatch, ends)
    lines = []
    monkeypatch.setattr(tally, "print_line", lambda text: lines.append((clock.now, text)))
    with tally.show_tally(quiet=False, json_lines=False) as (report, _):
        clock.events += [(each.seconds, partial(report, each)) for each in found]
    return lines


def test_progress_through_a_pipe_goes_on_while_no_run_comes(monkeypatch):
    """`damping-diagram` said "about 5 s left", and then nothing for 177 s."""
    costs = [0.5] * 14 + [177.0] + [0.5] * 17
    lines = said_through_a_pipe(tallies(costs), sum(costs), monkeypatch)
    assert lines == [
        (5.0, "10 of 32 runs after 5 s, 2 a second, about 11 s left"),
        (15.0, "14 of 32 runs after 15 s, the latest 8 s ago"),
        (35.0, "14 of 32 runs after 35 s, the latest 28 s ago"),
        (75.0, "14 of 32 runs after 1 min, the latest 1 min ago"),
        (135.0, "14 of 32 runs after 2 min, the latest 2 min ago"),
    ]


def test_progress_through_a_pipe_tells_of_compilation_and_failures(monkeypatch):
    found = [each._replace(failed=3) for each in tallies([12.0] + [1.0] * 59)]
    lines = said_through_a_pipe(found, 70.0, monkeypatch)
    assert lines == [
        (5.0, "making ready: begun 5 s ago"),
        (15.0, "4 of 60 runs after 15 s, the latest 0 s ago, 3 failed"),
        (35.0, "24 of 60 runs after 35 s, 1 a second, about 36 s left, 3 failed"),
    ]


def test_progress_on_a_terminal_moves_while_no_run_comes(monkeypatch):
    clock = FakeTime(monkeypatch, 0.0)
    screen = StringIO()
    terminal = Console(file=screen, force_terminal=True, width=200, get_time=lambda: clock.now)
    monkeypatch.setattr(tally, "Console", lambda **_: terminal)
    costs = [0.5] * 14
    with tally.show_tally(quiet=False, json_lines=False) as (report, _):
        for each in tallies(costs, 32):
            clock.now = each.seconds
            report(each)
        clock.now = 7.5
        until(lambda: "14 of 32 runs" in screen.getvalue(), "the count")
        until(lambda: "2 a second, about 8 s left" in screen.getvalue(), "the time left")
        clock.now = 60.0
        until(lambda: "the latest 53 s ago" in screen.getvalue(), "the pause")


def test_progress_as_json_lines(config, tmp_path, capsys):
    assert inside("sweep", config, "-o", tmp_path / "a.zarr", "--json-lines") == 0
    *lines, last = map(json.loads, capsys.readouterr().out.splitlines())
    assert lines
    assert all(line["runs"] == 8 and line["runs_per_second"] > 0.0 for line in lines)
    folder = str(tmp_path / "a.zarr")
    assert last == {"store": folder, "runs": 8, "done": 8, "before": 0, "failed": {}}


def test_failing_runs_are_counted_and_the_first_is_named(config, tmp_path, capsys):
    config.write_text(
        config.read_text()
        + '[load.modulation]\namplitude = "1 N"\nfrequency = "50 Hz"\n'
        + '[axes."load.modulation.amplitude"]\nvalues = [1, 12]\n'
    )
    assert inside("sweep", config, "-o", tmp_path / "a.zarr") == 1
    out = capsys.readouterr().out
    assert "16 runs" in out
    assert "8 failed (8 contact lost); the first at phi = 1 deg, drive.velocity = 0.001 m/s" in out
    assert inside("sweep", config, "-o", tmp_path / "a.zarr", "--quiet") == 1
    assert "8 failed" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (('to = "4 deg"', "to = 4"), "axes.phi.to: degree or radian?"),
        (('"peak_force"', '"peak_forse"'), "study.measures: unknown measure 'peak_forse'; did you"),
        (('"peak_force"', '"?"'), f"study.measures: unknown measure '?'; known: {EVERY_MEASURE}"),
        (("[axes.phi]", "[axes.phy]"), "axes.phy: unknown parameter 'phy'; did you mean 'phi'?"),
        (("[axes", "[axis"), "axes: missing"),
        (("[study]", "[stuyd]"), "stuyd: unknown table"),
        (('mass = "0.25 kg"', "mass = 0"), "slider.mass: must be greater than 0"),
    ],
)
def test_a_bad_study_leaves_nothing_behind(config, tmp_path, capsys, change, says):
    config.write_text(config.read_text().replace(*change))
    assert inside("sweep", config, "-o", tmp_path / "a.zarr") == 2
    assert says in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["study.toml"]


def test_a_first_run_that_is_refused_does_not_refuse_the_study(tmp_path, capsys):
    """Static friction below the kinetic one, in one of four runs."""
    config, output = tmp_path / "study.toml", tmp_path / "a.zarr"
    text = st.presets.nakano_popov_2020().to_toml() + "\n[run]\nduration = 1e-3\n"
    text += '[axes."friction.mu_0"]\nvalues = [30.0, 10.0]\n'
    config.write_text(text + '[axes."friction.mu_static"]\nvalues = [20.0, 40.0]\n')
    assert inside("sweep", config, "-o", output, "--threads", 1) == 1
    said = " ".join(capsys.readouterr().err.split())
    assert "at rest is 40, where few are above 5" in said
    assert xr.open_zarr(output)["status"].values.ravel().tolist().count(0) == 3


def test_a_folder_is_not_named_as_a_file(config, tmp_path, capsys):
    assert inside("sweep", config, "-o", tmp_path / "a.nc") == 2
    assert "a study is kept in a folder, not in a NetCDF file; name it a.zarr" in " ".join(
        capsys.readouterr().err.split()
    )
    assert not (tmp_path / "a.nc").exists()


def test_engines_exclude_each_other(config, tmp_path, capsys):
    assert inside("sweep", config, "-o", tmp_path / "a.zarr", "--threads", 0) == 2
    assert "must be at least 1" in capsys.readouterr().err
    assert inside("sweep", config, "-o", tmp_path / "a.zarr", "--threads", 1, "--workers", 1) == 2
    assert "exclude each other" in capsys.readouterr().err


def test_an_interrupt_leaves_a_store_to_go_on_with(config, tmp_path):
    """Long runs, interrupted once the first are done: the others are left, and it says how."""
    text = config.read_text().replace('duration = "50 ms"', 'duration = "20 s"')
    config.write_text(text.replace("count = 4", "count = 400"))
    command = INTERRUPTIBLE + "from stiction.cli import main; main()"
    arguments = ["sweep", str(config), "-o", "a.zarr", "--json-lines"]
    sweep = subprocess.Popen(
        [sys.executable, "-c", command, *arguments],
        cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    assert json.loads(sweep.stdout.readline())["runs"] == 800
    sweep.send_signal(signal.SIGINT)
    _, err = sweep.communicate(timeout=PATIENCE)
    assert sweep.returncode == 130
    status = xr.open_zarr(tmp_path / "a.zarr")["status"].values
    done = int((status == 0).sum())
    assert 0 < done < status.size
    assert f"stopped after {done} of 800 runs; the same command continues" in err
    assert set(status.ravel().tolist()) == {-1, 0}


@pytest.mark.parametrize(("duration", "said"), [("2.5 s", True), ("6 s", False)])
def test_a_map_says_why_kinds_of_motion_are_not_known(tmp_path, capsys, duration, said):
    """A white field of "undetermined" was all that told of runs that end before a cycle."""
    base = st.Description(
        st.presets.nakano_popov_2020(), st.Initial(), st.Settings(duration=duration, rtol=1e-3)
    )
    axes = {"phi": st.Values(["1 deg", "2 deg"]), "drive.velocity": st.Values(["1 mm/s", "2 mm/s"])}
    store = tmp_path / "a.zarr"
    st.sweep(st.Study(base=base, axes=axes, measures=["regime"]), store)
    capsys.readouterr()
    assert inside("map", store) == 0
    told = capsys.readouterr().out
    assert ("runs: as a rule these end before some whole cycles" in told) is said
    unclear = int((kinds(st.open_study(store)) == UNDETERMINED).sum())
    assert (unclear > 1) is said
    assert not said or f"undetermined in {unclear} of 4 runs" in told


def test_the_next_command_has_the_trust_that_a_user_s_law_needs(config, tmp_path, capsys):
    """`stiction map`, `plot` and `analyse`, as they were named, were refused."""
    for name in ("mylaw.py", "own_law.toml"):
        shutil.copy(Path(__file__).parents[2] / "examples" / name, tmp_path)
    own = tmp_path / "own.toml"
    own.write_text((tmp_path / "own_law.toml").read_text() + STUDY)
    for path, trust in ((config, ""), (own, " --trust")):
        short = (path, "--set", "duration=50ms", "-o")
        capsys.readouterr()
        assert inside("sweep", *short, path.with_suffix(".zarr"), "--threads", 1) == 0
        assert f"next: stiction map {path.with_suffix('.zarr')}{trust}\n" in capsys.readouterr().out
        plain = tmp_path / "plain.toml"
        plain.write_text(path.read_text().replace(STUDY, ""))
        assert inside("run", plain, *short[1:], tmp_path / "a.nc") == 0
        said = capsys.readouterr().out
        assert f"a.png{trust}, stiction analyse {tmp_path / 'a.nc'}{trust}\n" in said
    command = [sys.executable, "-c", "from stiction.cli import main; main()"]
    plot = [*command, "plot", "a.nc", "-o", "a.png"]
    assert subprocess.run(plot, cwd=tmp_path, check=False, timeout=PATIENCE).returncode == 2
    assert subprocess.run([*plot, "--trust"], cwd=tmp_path, check=False).returncode == 0


def test_each_part_of_a_map_that_is_not_named_is_told_by_its_option(tmp_path, capsys):
    assert inside("map", tmp_path / "a.zarr", "--at", "phi", "--at", "1 mm/s") == 2
    said = capsys.readouterr().err
    assert "--at 'phi' is not NAME=VALUE" in said
    assert "--at '1 mm/s' is not NAME=VALUE" in said


def test_a_refinement_says_where_its_changes_are(config, tmp_path, capsys, monkeypatch):
    """They were drawn by `stiction map` alone."""
    text = config.read_text().replace('duration = "50 ms"', 'duration = "3 s"')
    text = text.replace('"peak_force"', '"regime"').replace('values = ["1 mm/s", "2 mm/s"]', "@")
    text = text.replace('from = "1 deg"\nto = "4 deg"\ncount = 4', 'values = ["8 deg", "12 deg"]')
    config.write_text(text.replace("@", 'values = ["1 mm/s"]'))
    store = tmp_path / "a.zarr"
    assert inside("sweep", config, "-o", store, "--refine", "phi = 1 deg", "--threads", 1) == 0
    said = " ".join(capsys.readouterr().out.split())
    table = store / "refined" / "phi" / "changes"
    assert f"wrote {table}, which xarray.open_zarr reads" in said
    assert "less accurate" not in said
    (width,) = xr.open_zarr(table, consolidated=False)["half_width"].values
    assert 0.0 < width <= 0.5
    monkeypatch.setattr("stiction.study.execution.refine.INSIDE", ())  # as where all runs fail
    assert inside("sweep", config, "-o", store, "--refine", "phi = 1 deg", "--threads", 1) == 0
    said = " ".join(capsys.readouterr().out.split())
    assert "failed runs leave 1 of them less accurate than asked for" in said
