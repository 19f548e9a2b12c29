"""One process at a time compiles the same code."""

import subprocess
import sys
import time

import pytest

from stiction.solver.compilation import turn

TAKE = """
import sys, time
from pathlib import Path
from stiction.solver.compilation.turn import end_turns, take_turn
take_turn(Path(sys.argv[1]))
print("taken", flush=True)
sys.stdin.readline()
"""
NAME = f"some.function-{'0' * 57}1234567.code"


@pytest.fixture
def code(tmp_path, monkeypatch):
    monkeypatch.setattr(turn, "_taken", {})
    monkeypatch.setattr(turn, "_locks", {})
    return tmp_path / NAME


@pytest.fixture
def other(code):
    """Another process that has the turn."""
    with subprocess.Popen(
        [sys.executable, "-c", TAKE, str(code)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    ) as found:
        assert found.stdout.readline() == "taken\n"
        yield found
        found.kill()


def test_another_process_waits_no_longer_than_it_must(code, other, monkeypatch):
    monkeypatch.setattr(turn, "LONGEST_WAIT", 0.2)
    start = time.monotonic()
    turn.take_turn(code)
    assert time.monotonic() - start >= 0.2
    assert not turn._taken
    turn.take_turn(code.with_name(NAME.replace("1234567", "1234568")))  # other code is free
    assert len(turn._taken) == 1


@pytest.mark.parametrize("how", ["it writes the file", "it ends", "it is killed"])
def test_the_turn_comes(code, other, how):
    if how == "it writes the file":
        code.touch()
    elif how == "it ends":
        other.communicate("")
    else:
        other.kill()
        other.wait()
    turn.take_turn(code)  # not after LONGEST_WAIT
    assert (code in turn._taken) == (how != "it writes the file")


def test_a_turn_is_given_back(code, monkeypatch):
    turn.take_turn(code)
    turn.take_turn(code)
    assert list(turn._taken) == [code]
    turn.end_turns()
    assert not turn._taken
    again = subprocess.run([sys.executable, "-c", TAKE, str(code)], input="", capture_output=True)
    assert again.stdout == b"taken\n"


def test_where_nothing_can_be_locked_nobody_waits(code, monkeypatch):
    turn.take_turn(code.parent / "none" / NAME)
    monkeypatch.setattr(turn, "fcntl", None)
    turn.take_turn(code)
    assert not turn._taken
    turn.end_turns()
