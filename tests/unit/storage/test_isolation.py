"""A file that crashes or hangs its reader does so in a process of its own."""

import os
import signal

import pytest

import stiction as st
from stiction import cli
from stiction.result.file import MARK, as_written
from stiction.storage import isolation

KILLS = pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="Windows has no such signal")


def crash(path):
    os.kill(os.getpid(), signal.SIGKILL)


def leave(path):
    os._exit(3)


def loop(path):
    while True:
        pass


def stumble(path):
    return 1 // 0


def refuse(path):
    print("said on the way")
    raise st.ResultError(f"{path}: refused")


def count(path):
    print("said on the way")
    return len(path)


@pytest.fixture
def result(slider, tmp_path):
    return st.simulate(slider, "20 ms", sample_rate="1 kHz").save(tmp_path / "a.nc")


@pytest.mark.parametrize(
    ("work", "words"),
    [
        pytest.param(crash, "is damaged: reading it ends in SIGKILL", marks=KILLS),
        (leave, "is damaged: reading it ends in exit status 3"),
        (stumble, "cannot be read: ZeroDivisionError"),
        (refuse, "a.nc: refused"),
    ],
)
def test_how_the_other_process_ended_is_said(work, words, result):
    with pytest.raises(st.ResultError, match=words):
        isolation.apart(work, result)


def test_what_the_other_process_returns_is_returned(result):
    assert isolation.apart(count, result) == len(str(result))


def test_what_does_not_end_is_ended(result, monkeypatch):
    monkeypatch.setattr(isolation, "PATIENCE", 0.0)
    with pytest.raises(st.ResultError, match="is damaged: reading it does not end"):
        isolation.apart(loop, result)


def remove_checksum(path):
    """Take away the checksum of the whole file, as whoever writes into it does."""
    content = path.read_bytes()
    path.write_bytes(content[: content.rindex(MARK)])
    return path


def test_a_file_that_hdf5_reads_without_end_is_refused(result, monkeypatch, capsys):
    content = bytearray(remove_checksum(result).read_bytes())
    first = content.index(b"GCOL") + 16  # texts: HDF5 goes on by the size of each, here by zero
    content[first : first + 16] = bytes(16)
    result.write_bytes(content)
    monkeypatch.setattr(isolation, "PATIENCE", 0.0)
    for command in (["analyse", str(result)], ["check", str(result), "--repair"]):
        with pytest.raises(SystemExit) as end:
            cli.main(command)
        assert end.value.code == 2
        assert "is damaged" in " ".join(capsys.readouterr().err.split())


def test_a_file_with_a_byte_changed_is_not_shown_to_hdf5(result, monkeypatch):
    assert as_written(result)
    content = bytearray(result.read_bytes())
    content[content.index(b"GCOL") + 16] ^= 1
    result.write_bytes(content)
    assert as_written(result) is False
    monkeypatch.delattr("h5py.File")
    with pytest.raises(st.ResultError, match="its bytes have changed"):
        st.load(result)


def test_a_file_without_its_checksum_is_read_as_any_other(result):
    run = st.load(result)
    assert as_written(remove_checksum(result)) is None
    assert st.load(result).data.identical(run.data)
    assert st.load(result).sticks.identical(run.sticks)


def test_nothing_of_the_working_folder_is_imported(result, tmp_path, monkeypatch):
    (tmp_path / "numpy.py").write_text("raise SystemExit('a file of the working folder was run')")
    monkeypatch.chdir(tmp_path)
    assert st.load(remove_checksum(result)).status.ok
