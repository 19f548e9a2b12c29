"""All cores: processes that start beside the threads do the same, and are missed by nobody."""

import os
from functools import partial
from io import BytesIO
from itertools import count
from types import SimpleNamespace

import pytest
from tests.tasks import forces, stop_elsewhere, who
from tests.waiting import until

import stiction as st
from stiction.study.execution import cores
from stiction.study.execution.cores import Cores

LAW = """
from typing import NamedTuple

class Worn(NamedTuple):
    mu_0: float

    def coefficient(law, v):
        return law.mu_0 / (1.0 + 20.0 * v)

    def slope(law, v):
        return -20.0 * law.mu_0 / (1.0 + 20.0 * v) ** 2
"""


@pytest.fixture(autouse=True)
def at_once(monkeypatch):
    """Processes start at once, and there is one."""
    monkeypatch.setattr(cores, "LONG", 0.0)


def until_another(found):
    """Return what comes until another process has done something."""
    done = []

    def comes():
        done.append(next(found))
        return done[-1][1] != os.getpid()

    until(comes, "the start of a process")
    return done


def is_alive(process):
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    return True


def test_a_process_does_tasks_and_ends_with_them():
    found = Cores(2).results(who, count())
    done = until_another(found)
    found.close()
    tasks = [task for task, _ in done]
    assert len(set(tasks)) == len(tasks)
    assert not is_alive(done[-1][1])


def test_what_another_process_cannot_be_told_is_done_here():
    done = Cores(2).results(lambda task, _: (task, os.getpid()), range(100))
    assert sorted(done) == [(task, os.getpid()) for task in range(100)]


@pytest.mark.parametrize("how", ["dies", "fails", "answers nonsense"])
def test_what_a_process_leaves_is_done_here(how, tmp_path):
    """Tasks go on until a process has taken one, and all come back."""
    seen, given = tmp_path / "seen", []

    def tasks():
        while not seen.exists():
            given.append(len(given))
            yield given[-1]

    found = Cores(2).results(partial(stop_elsewhere, how, os.getpid(), seen), tasks())
    assert sorted(found) == given


def test_nobody_waits_for_a_process_when_the_work_is_broken_off(tmp_path):
    seen = tmp_path / "seen"
    found = Cores(2).results(partial(stop_elsewhere, "never ends", os.getpid(), seen), count())
    until(lambda: next(found) >= 0 and seen.exists() and seen.read_text(), "a process")
    found.close()
    assert not is_alive(int(seen.read_text()))


def test_a_process_that_ends_while_it_starts_raises_nothing(monkeypatch):
    """Its pipes are closed while a thread waits for its first word."""
    closed = open(os.devnull, "rb")  # noqa: SIM115
    closed.close()
    for stdin, stdout in ((BytesIO(), closed), (closed, BytesIO())):
        helper = SimpleNamespace(stdin=stdin, stdout=stdout)
        monkeypatch.setattr(cores, "python", lambda *_, made=helper, **__: made)
        helpers = cores.Helpers(forces, 0)
        helpers._start(b"tasks")
        assert helpers._idle.empty()


def test_a_law_from_a_file_gives_the_same_in_another_process(tmp_path):
    (tmp_path / "worn.py").write_text(LAW)
    text = st.presets.nakano_popov_2020().to_toml()
    before, after = text[: text.index("[friction]")], text[text.index("[drive]") :]
    law = '[friction]\nlaw = "worn.py:Worn"\nmu_0 = 0.2\n\n'
    (tmp_path / "a.toml").write_text(before + law + after)
    slider = st.Slider.from_toml(tmp_path / "a.toml")
    found = Cores(2).results(partial(forces, slider), count())
    assert len({force for force, _ in until_another(found)}) == 1
    found.close()
