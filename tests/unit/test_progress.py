"""Who is told the progress of long work, by functions that take `progress`."""

import builtins
import logging
from contextlib import contextmanager
from inspect import isfunction, signature, unwrap
from threading import Thread

import pytest
from tests.waiting import until

import stiction as st
from stiction.progress import audience, display
from stiction.progress.audience import somebody_waits, with_progress
from stiction.progress.report import part, silent


@with_progress("working")
def work(parts=2, progress=None):
    report = progress or silent
    for done in range(parts):
        if parts > 1:
            work(1, part(report, done, parts))  # a part, which is told how far it is
            work(1)  # one that is not
        report((done + 1) / parts)
    return progress is not None


@pytest.fixture(autouse=True)
def no_level(monkeypatch):
    """The command line sets one, as a user may."""
    monkeypatch.setattr(logging.getLogger("stiction"), "level", logging.NOTSET)


@pytest.fixture
def shown(monkeypatch):
    """A user waits; the title of what is shown, and each fraction."""
    told = []

    @contextmanager
    def note(title):
        told.append(title)
        yield told.append

    monkeypatch.setattr(display, "show_progress", note)
    monkeypatch.setattr(audience, "somebody_waits", lambda: True)
    monkeypatch.setattr(audience, "SHORT", -1.0)
    return told


def test_a_user_who_waits_is_shown_the_whole_and_no_part_of_it(shown):
    assert work()
    assert shown == ["working", 0.5, 0.5, 1.0, 1.0]
    assert display.told == []


def test_one_who_takes_the_progress_is_shown_nothing(shown):
    own = []
    assert work(2, own.append)
    assert work(progress=own.append)
    assert own == 2 * [0.5, 0.5, 1.0, 1.0]
    assert shown == []


def test_what_fails_is_not_taken_for_work_that_goes_on(shown):
    @with_progress("failing")
    def fail(progress=None):
        raise st.StictionError

    with pytest.raises(st.StictionError):
        fail()
    with pytest.raises(TypeError, match="unexpected keyword argument"):
        fail(other=1)
    work(1)
    assert shown == ["working", 1.0]


def test_what_reports_nothing_shows_nothing(shown):
    assert work(0)
    assert shown == []


def test_a_script_that_runs_by_itself_is_silent(monkeypatch):
    assert not somebody_waits()  # no terminal here
    assert not work()
    monkeypatch.setattr(builtins, "__IPYTHON__", True, raising=False)
    assert somebody_waits()
    seen = []
    thread = Thread(target=lambda: seen.append(somebody_waits()))
    thread.start()
    thread.join()
    assert seen == [False]
    monkeypatch.setattr(logging.getLogger("stiction"), "level", logging.WARNING)
    assert not somebody_waits()


def test_a_notebook_is_told_of_work_that_lasts(monkeypatch):
    lines = []
    monkeypatch.setattr(builtins, "__IPYTHON__", True, raising=False)
    monkeypatch.setattr(display, "print_line", lines.append)
    monkeypatch.setattr(display, "FIRST_LINE", 0.01)

    @with_progress("working")
    def last(short, progress=None):
        monkeypatch.setattr("stiction.progress.audience.SHORT", short)
        progress(0.25)
        until(lambda: lines or short > 0.0, "a line")

    last(1000.0)
    assert lines == []
    last(-1.0)
    assert lines[0].startswith("working: ")


def test_a_study_tells_the_share_of_its_runs(shown, tmp_path):
    base = st.Description.of(st.presets.nakano_popov_2020(), "2 ms")
    axes = {"phi": st.Grid("1 deg", "3 deg", 3)}
    study = st.Study(base=base, axes=axes, measures=["stick_count"])
    st.sweep(study, tmp_path / "a.zarr")
    assert shown[0] == "simulating"
    assert shown[-1] == 1.0


def with_own_progress():
    """Return the names of public functions that take `progress`."""
    public = ((name, getattr(st, name)) for name in st.__all__)
    return [
        name for name, its in public if isfunction(its) and "progress" in signature(its).parameters
    ]


@pytest.mark.parametrize("name", with_own_progress())
def test_every_public_function_that_takes_progress_shows_it(name):
    function, files = getattr(st, name), []
    unwrap(function, stop=lambda each: files.append(each.__code__.co_filename))
    assert audience.__file__ in files
