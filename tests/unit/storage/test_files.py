"""Files are written whole or not at all, and stay when the power fails."""

import os
import re
import subprocess
import sys

import pytest
from tests.power import Disk

import stiction as st
from stiction.storage.files import WORKSHOP, placeable, usable_folder, whole, workshop

OLD, NEW = b"the old content", b"what is new"


@pytest.fixture
def disk(tmp_path, monkeypatch):
    (tmp_path / "folder").mkdir()
    (tmp_path / "folder" / "a.txt").write_bytes(OLD)
    made = Disk(tmp_path / "folder", monkeypatch)
    yield made
    made.close()


def test_a_power_cut_leaves_the_old_file_or_the_new_one(disk):
    with whole(disk.root / "a.txt") as part:
        part.write_bytes(NEW)
    found = {state["a.txt"] for state in disk.states}
    assert found == {OLD, NEW}
    disk.states.clear()
    disk.look()
    assert {state["a.txt"] for state in disk.states} == {NEW}  # it stays from now on


def test_the_disk_of_these_tests_loses_what_is_not_synced(disk):
    """As a file was written before: to a part that takes its name."""
    (disk.root / "part").write_bytes(NEW)
    os.replace(disk.root / "part", disk.root / "a.txt")
    found = {state["a.txt"] for state in disk.states}
    assert found == {OLD, b"", bytes(len(NEW)), NEW}


def test_what_cannot_be_written_leaves_what_was_there(tmp_path):
    target = tmp_path / "a.toml"
    target.write_bytes(OLD)
    with pytest.raises(st.ResultError, match="cannot be written: No space left"), whole(target):
        raise OSError(28, "No space left on device")
    assert [each.name for each in tmp_path.iterdir()] == ["a.toml"]
    assert target.read_bytes() == OLD


LIMITED = """
import resource, sys
import stiction as st
resource.setrlimit(resource.RLIMIT_FSIZE, (100, 100))
st.init(sys.argv[1], force=True)
"""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs limits of the system")
def test_init_on_a_full_disk_keeps_the_user_s_file(tmp_path):
    """The system lets files grow to 100 bytes."""
    target = tmp_path / "my.toml"
    target.write_bytes(OLD)
    command = [sys.executable, "-c", LIMITED, str(target)]
    ended = subprocess.run(command, capture_output=True, text=True)
    assert "cannot be written: File too large" in ended.stderr
    assert target.read_bytes() == OLD
    assert [each.name for each in tmp_path.iterdir()] == ["my.toml"]


KILLED = """
import sys, time
from pathlib import Path
from stiction.storage.files import whole
with whole(Path(sys.argv[1])) as part:
    part.write_text("half")
    print("there", flush=True)
    time.sleep(3600)
"""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="Windows cannot tell who is alive")
def test_what_a_killed_process_leaves_is_taken_away(tmp_path):
    command = [sys.executable, "-c", KILLED, str(tmp_path / "a.txt")]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout.readline() == "there\n"
        with whole(tmp_path / "b.txt") as part:
            part.write_bytes(NEW)
        assert len([*tmp_path.glob(f"{WORKSHOP}*/*.txt")]) == 1  # it is alive: left alone
        process.kill()
    with workshop(tmp_path):
        pass
    assert [each.name for each in tmp_path.iterdir()] == ["b.txt"]


@pytest.mark.parametrize(
    ("name", "suffixes", "remedy"),
    [
        ("run.toml", (".nc",), "unknown format '.toml'; name it run.nc"),
        ("/", (".nc",), "is a folder; name a file in it"),  # was a traceback
        ("run", (".png", ".pdf"), "unknown format ''; use .png, .pdf, such as run.png"),
    ],
)
def test_a_name_of_another_format_is_refused(name, suffixes, remedy):
    with pytest.raises(st.ResultError, match=re.escape(remedy)):
        placeable(name, suffixes)


def test_capitals_make_no_other_format(tmp_path):
    assert placeable(tmp_path / "A.NC", (".nc",)) == tmp_path / "A.NC"


FULL = """
import resource, sys
import stiction as st
run = st.simulate(st.presets.nakano_popov_2020(), "20 ms", sample_rate="10 kHz")
resource.setrlimit(resource.RLIMIT_FSIZE, (4000, 4000))
run.save(sys.argv[1])
"""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs limits of the system")
def test_a_result_on_a_full_disk_is_one_error(tmp_path):
    """HDF5 printed hundreds of lines, and crashed at exit."""
    command = [sys.executable, "-c", FULL, str(tmp_path / "run.nc")]
    ended = subprocess.run(command, capture_output=True, text=True)
    assert ended.returncode == 1
    assert "run.nc: cannot be written: File too large" in ended.stderr.splitlines()[-1]
    assert "h5py" not in ended.stderr
    assert not [*tmp_path.iterdir()]


def test_a_folder_that_is_read_only_is_refused_before_the_work(tmp_path, monkeypatch):
    monkeypatch.setattr(os, "access", lambda path, mode: path != tmp_path)  # root may write to any
    for refuse in (placeable, usable_folder):
        with pytest.raises(st.ResultError, match=r"may not be written to; choose another folder"):
            refuse(tmp_path / "new.nc")
