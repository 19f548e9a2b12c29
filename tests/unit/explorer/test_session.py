"""Of each kind of request the newest is answered; what nobody waits for ends."""

import asyncio
import json
import sys

import pytest
from tests.explored import an_opened, decode

from stiction.errors import ResultError
from stiction.explorer import answers, session
from stiction.explorer.answers import tables_of
from stiction.explorer.session import Session, Superseded
from stiction.explorer.source import open_source
from stiction.own_code.source import Text, module_of


class Page:
    """Collects what is sent to a page."""

    def __init__(self):
        self.heads = []

    async def send(self, message):
        self.heads.append(decode(message)[0])


def end_of(page, number):
    return [head for head in page.heads if head["id"] == number and head.get("end")]


async def until(happened):
    while not happened():
        await asyncio.sleep(0.001)


@pytest.fixture
def slow(monkeypatch):
    """A request that is computed until nobody waits for it."""
    seen = []

    def never(opened, request, check):
        seen.append(("begun", request["id"]))
        try:
            while request["id"] < 100:
                check()
        except Superseded:
            seen.append(("ended", request["id"]))
            raise
        yield {"answered": request["id"]}, {}

    monkeypatch.setitem(answers.ANSWERS, "never", never)
    return seen


def test_a_newer_request_interrupts_and_replaces_those_before(slow):
    async def play():
        page = Page()
        made = Session(an_opened(), page.send)
        made.receive(json.dumps({"do": "never", "id": 1}))
        await until(lambda: slow == [("begun", 1)])
        for number in (2, 3, 100):  # 2 and 3 wait, and are replaced
            made.receive(json.dumps({"do": "never", "id": number}))
        await until(lambda: end_of(page, 100))
        return page

    page = asyncio.run(play())
    assert slow == [("begun", 1), ("ended", 1), ("begun", 100)]
    assert {head["id"] for head in page.heads} == {100}


def test_other_kinds_and_lanes_go_on(slow):
    async def play():
        page = Page()
        made = Session(an_opened(), page.send)
        made.receive(json.dumps({"do": "never", "id": 1}))
        made.receive(json.dumps({"do": "never", "id": 100, "lane": 1}))
        made.receive(json.dumps({"do": "start", "id": 3}))
        await until(lambda: end_of(page, 100) and end_of(page, 3))
        await made.close()

    asyncio.run(play())
    assert ("ended", 1) in slow


def test_closing_the_page_ends_what_is_computed(slow):
    async def play():
        page = Page()
        made = Session(an_opened(), page.send)
        made.receive(json.dumps({"do": "never", "id": 1}))
        await until(lambda: slow == [("begun", 1)])
        await made.close()
        return page

    page = asyncio.run(play())
    assert slow == [("begun", 1), ("ended", 1)]
    assert page.heads == []


def test_a_long_run_is_interrupted():
    """The solver itself is left: a run of years ends as soon as nobody waits for it."""

    async def play():
        page = Page()
        tables = tables_of(an_opened(duration=1e5).description)  # some minutes
        made = Session(an_opened(), page.send)
        made.receive(json.dumps({"do": "zoom", "id": 1, "tables": tables, "window": [0, 1e-3]}))
        (lane,) = made._lanes.values()
        await until(lambda: lane._current == 1)
        await made.close()
        return page, lane

    page, lane = asyncio.run(play())
    assert lane._work.done()
    assert page.heads == []


def replies(**request):
    page = Page()

    async def play():
        made = Session(an_opened(), page.send)
        made.receive(json.dumps({"id": 1, **request}))
        await until(
            lambda: any(k in head for head in page.heads for k in ("end", "faults", "error"))
        )

    asyncio.run(play())
    return page.heads


def test_every_fault_is_told_by_its_path():
    tables = tables_of(an_opened().description)
    tables["slider"] |= {"mass": "-1 kg", "phi": "3"}
    tables["friction"]["mu_0"] = "much"
    (head,) = replies(do="run", tables=tables)
    assert [fault["path"] for fault in head["faults"]] == [
        "slider.mass",
        "slider.phi",
        "friction.mu_0",
    ]
    assert "greater than 0" in head["faults"][0]["message"]


def test_a_law_from_a_file_is_not_loaded(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    law = "from pathlib import Path\nPath('ran').touch()\n"
    (tmp_path / "mylaw.py").write_text(law)
    for extra in ({}, {"source": law}):
        tables = tables_of(an_opened().description)
        tables["friction"] = {"law": "mylaw.py:MyLaw", **extra}
        (head,) = replies(do="run", tables=tables)
        assert head["faults"][0]["path"] == "friction.law"
        assert "the page loads none" in head["faults"][0]["message"]
    assert not (tmp_path / "ran").exists()


def test_a_record_of_a_drive_is_not_read_from_a_file(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "way.csv").write_text("time [s],velocity [m/s]\n0,0\n1,1\n")
    tables = tables_of(an_opened().description)
    named = {"file": "way.csv", "time": "time [s]", "velocity": "velocity [m/s]"}
    tables["drive"]["program"] = [{"piece": "recorded", **named}]
    (head,) = replies(do="run", tables=tables)
    assert [fault["path"] for fault in head["faults"]] == ["drive.program.1.file"]


def test_nonsense_is_answered_in_words():
    deep: dict = {}
    for _ in range(40):
        deep = {"a": deep}
    for tables in ({}, None, [1], deep, {"slider": 3}):
        assert replies(do="run", tables=tables)[-1]["faults"]
    tables = tables_of(an_opened().description)
    assert "known:" in replies(do="law", name="x", tables=tables)[-1]["error"]
    assert replies(do="export", kind="exe")[-1]["error"].startswith("no export 'exe'")


def test_an_error_of_the_program_leaves_the_session(monkeypatch, capsys):
    def fail(opened, request, check):
        raise ZeroDivisionError("a mistake")
        yield

    monkeypatch.setitem(answers.ANSWERS, "broken", fail)
    (head,) = replies(do="broken")
    assert head["error"] == "ZeroDivisionError: a mistake"
    assert "a mistake" in capsys.readouterr().err


def test_what_a_law_raises_is_told_with_its_place(monkeypatch, capsys):
    """It was told without, and a traceback filled the terminal."""
    text = Text("mylaw.py", "def fail(*_):\n    raise ValueError('no')\n    yield\n")
    law = module_of(text, "there/mylaw.py")
    monkeypatch.setitem(answers.ANSWERS, "broken", law.fail)
    (head,) = replies(do="broken")
    del sys.modules[law.__name__]
    assert head["error"] == "there/mylaw.py, line 2: ValueError: no; correct it there"
    assert capsys.readouterr().err == ""


def test_there_are_two_lanes():
    assert session.LANES == 2
    assert len(replies(do="start", lane=1)) == 2


def test_what_cannot_be_explored_is_named_with_its_article():
    """It was "a int"."""
    with pytest.raises(ResultError, match=r"^an int cannot be explored"):
        open_source(3, False)
