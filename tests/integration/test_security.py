"""The promises of SECURITY.md, a test for each line; laws of files are in `test_user`."""

import gc
import json
import os
import re
import socket
import subprocess
import sys
from contextlib import ExitStack, suppress
from pathlib import Path

import h5py
import psutil
import pytest
import zarr
from tests.waiting import PATIENCE

import stiction as st
from stiction.cli import main
from stiction.cli.commands.studies.sweep import engine
from stiction.cli.tables import print_sections
from stiction.errors import StictionError
from stiction.study.execution.engines import Processes
from stiction.study.store.creation import create
from stiction.study.store.seal import seal
from stiction.text.sections import Section, Table


def listening(*_):
    """Return where this process listens."""

    found = psutil.Process().net_connections("inet")
    return [tuple(each.laddr) for each in found if each.status == psutil.CONN_LISTEN]


def answer(address):
    """Return what comes back from a port to one who has no certificate."""
    with socket.create_connection(address) as line:
        line.sendall(b"GET /status HTTP/1.0\r\n\r\n")
        try:
            with line.makefile("rb") as file:
                return file.read()
        except ConnectionResetError:
            return b""


def test_workers_listen_to_this_machine_and_to_their_own_client_alone():
    ours = set(listening())
    at_work = Processes(1).results(lambda *_: listening(), [0])
    doors = {*next(at_work), *listening()} - ours
    assert len(doors) >= 3  # scheduler, nanny, worker
    assert {host for host, _ in doors} == {"127.0.0.1"}
    # an alert of TLS (RFC 8446, 6), nothing, or a server of pages that has none
    answers = [answer(door) for door in doors]
    told = [a for a in answers if a and a[0] != 21 and not re.match(rb"HTTP/1.\d 404", a)]
    assert told == []
    at_work.close()


def test_a_port_that_another_scheduler_has_is_not_asked_for():
    """dask, refused, leaves a socket open behind it."""
    with ExitStack() as held:
        with suppress(OSError):  # somebody has it
            held.enter_context(socket.create_server(("127.0.0.1", 8787)))
        assert [*Processes(1).results(lambda *_: 1, [0])] == [1]
        gc.collect()


def test_the_dashboard_is_shown_where_it_is_asked_for():
    assert engine(None, 2, None) == Processes(2, dashboard=False)
    assert engine(None, 2, None, True) == Processes(2, dashboard=True)
    with pytest.raises(StictionError, match="--dashboard needs --workers"):
        engine(2, None, None, True)


# --- links, and what lies in other files ---------------------------------------------------------


@pytest.fixture
def result(slider, tmp_path):
    """The file of a run."""
    return st.simulate(slider, "20 ms", sample_rate="1 kHz").save(tmp_path / "a.nc")


def soft(file):
    del file["u_x"]
    file["u_x"] = h5py.SoftLink("/u_y")


def loop(file):
    file["sticks/again"] = h5py.SoftLink("/sticks")


def external_link(file):
    del file["u_x"]
    file["u_x"] = h5py.ExternalLink("other.nc", "/u_x")


def external(file):
    numbers = file["u_x"][:]
    del file["u_x"]
    kept = [("secret", 0, h5py.h5f.UNLIMITED)]
    file.create_dataset("u_x", numbers.shape, numbers.dtype, external=kept)


def virtual(file):
    numbers = file["u_x"][:]
    del file["u_x"]
    layout = h5py.VirtualLayout(numbers.shape, numbers.dtype)
    layout[:] = h5py.VirtualSource("other.nc", "u_x", numbers.shape)
    file.create_virtual_dataset("u_x", layout)


@pytest.mark.parametrize("change", [soft, loop, external_link, external, virtual])
def test_a_result_has_no_other_file_read(result, change):
    with h5py.File(result, "r+") as file:
        change(file)
    said = {external: "in another file", virtual: "in another file"}.get(change, "is a link")
    with pytest.raises(st.ResultError, match=said):
        st.load(result)


@pytest.fixture
def store(slider, tmp_path):
    """A store in which nothing is done yet."""
    base = st.Description(slider, st.Initial(), st.Settings(duration="20 ms", sample_rate=0))
    study = st.Study(base=base, axes={"phi": st.Grid("1 deg", "2 deg", 2)})
    create(study, tmp_path / "a.zarr")
    return study, tmp_path / "a.zarr"


@pytest.mark.parametrize("name", ["zarr.json", "status", "status/c"])
def test_a_store_leads_nowhere_else(store, tmp_path, name):
    study, path = store
    there, away = path / name, tmp_path / "away"
    if there.exists():
        there.rename(away)
    else:
        away.mkdir()
    there.symlink_to(away)
    before = sorted(tmp_path.rglob("*"))
    for act in (lambda: st.sweep(study, path), lambda: st.open_study(path), lambda: st.map(path)):
        with pytest.raises(st.ResultError, match=f"contains a link, {name}"):
            act()
    assert sorted(tmp_path.rglob("*")) == before


def test_a_store_of_endless_blocks_is_none(store):
    """Its blocks are looked at one by one."""
    _, path = store
    about = path / "status" / "zarr.json"
    text = json.loads(about.read_text()) | {"shape": [10**12]}
    about.write_text(json.dumps(text))
    seal(path)  # as who makes it on purpose would
    with pytest.raises(st.ResultError, match="cannot have 1,000,000,000,000 blocks of runs"):
        st.open_study(path)


def test_a_store_of_zarr_s_old_format_is_none(tmp_path):
    """In it a pickle may stand for any array."""
    zarr.create_group(tmp_path / "a.zarr", zarr_format=2, attributes={"format": 1})
    with pytest.raises(st.ResultError, match="is not the store of a study"):
        st.open_study(tmp_path / "a.zarr")


# --- the terminal ---------------------------------------------------------------------------------

ESCAPE = "\x1b]0;owned\x07\x1b[2J\u202e[red]"


def test_a_file_says_nothing_to_the_terminal(tmp_path, capsys):
    path = tmp_path / "a.toml"
    quoted = ESCAPE.encode("unicode_escape").decode().replace("\\x", "\\u00")
    path.write_text(f'["{quoted}"]\n[slider]\nmass = "{quoted}"\n"{quoted}" = 1\n')
    with pytest.raises(SystemExit) as end:
        main(["run", str(path), "-o", str(tmp_path / "a.nc")])
    assert end.value.code == 2
    said = capsys.readouterr().err
    assert said.count("\\x1b]0;owned\\x07\\x1b[2J\\u202e[red]") >= 3
    assert all(letter.isprintable() for letter in said.replace("\n", ""))


def test_tables_say_nothing_to_the_terminal(capsys):
    rows = Table((ESCAPE, "b"), [(ESCAPE, "1")])
    print_sections(ESCAPE, [Section(ESCAPE, [ESCAPE], rows)])
    said = capsys.readouterr().out
    assert said.count("\\x1b]0;owned") == 5
    assert all(letter.isprintable() for letter in said.replace("\n", ""))


def command(*arguments, **options):
    """Run the command line in a process of its own."""
    line = [sys.executable, "-m", "stiction", *map(str, arguments)]
    return subprocess.run(line, stderr=subprocess.PIPE, text=True, timeout=PATIENCE, **options)


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs a device that is full")
def test_a_full_standard_output_is_told():
    with open("/dev/full", "w") as full:
        done = command("--help", stdout=full)
    assert done.returncode == 2
    assert done.stderr.splitlines()[1].startswith("  standard output: No space left on device")
    with open("/dev/full", "w") as full:
        done = subprocess.run(
            [sys.executable, "-m", "stiction", "no"], stderr=full, timeout=PATIENCE
        )
    assert done.returncode == 2


@pytest.mark.parametrize("wanted", [["--help"], ["init", "a.toml"]])
def test_a_closed_pipe_ends_without_a_word(wanted, tmp_path):
    """As of `stiction --help | head -1`, when head has gone."""
    reading, writing = os.pipe()
    os.close(reading)
    with os.fdopen(writing, "w") as gone:
        done = command(*wanted, stdout=gone, cwd=tmp_path)
    assert (done.returncode, done.stderr) == (1, "")


def test_letters_that_a_terminal_lacks_are_spelled_out(tmp_path):
    st.init(tmp_path / "µ.toml")
    ascii_only = {**os.environ, "PYTHONIOENCODING": "ascii"}
    done = command("stability", tmp_path / "µ.toml", stdout=subprocess.PIPE, env=ascii_only)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.replace("\n", "").startswith(str(tmp_path / "u.toml"))


def test_each_line_of_security_md_names_tests_that_are_there():
    folder = Path(__file__).parents[1]
    lines = (folder.parent / "SECURITY.md").read_text().splitlines()
    rows = [line.split(" | ")[-1] for line in lines if line.startswith("|")][2:]
    assert rows
    for part in (part for row in rows for part in row.split(";")):
        file, *names = re.findall(r"`([\w/]+)`", part)
        homes = list(folder.rglob(f"{file}.py"))
        assert len(homes) == 1, f"{file}: name the folder too, as in `explorer/test_session`"
        text = homes[0].read_text()
        assert names
        assert [name for name in names if not re.search(rf"def test_\w*{name}", text)] == []
