"""The benchmark's harness and report, with contestants made up for it; no peer is needed."""

import json
from math import inf

import numpy as np
import pytest
from benchmarks.harness import library as libraries
from benchmarks.harness.contest import contest
from benchmarks.harness.contestant import Failed
from benchmarks.harness.library import Library
from benchmarks.harness.rounds import round_robin
from benchmarks.harness.row import Errors, Row, fastest, matches, verdict
from benchmarks.precision import levels
from benchmarks.precision.figure import figure, front
from benchmarks.section import Section, Table
from rich.progress import Progress
from tests.waiting import PATIENCE

from benchmarks import report

HANGS = 3
FAKE = """
import os, time
import numpy as np
from benchmarks.harness.contestant import Contestant, Failed

def solve(times):
    print("libraries print")
    return np.stack([times, 2 * times], axis=1)

def refuse(times):
    raise Failed("would not")

def crash(times):
    os.abort()

def hang(times):
    if times[-1] > 1e-3:
        time.sleep(3600)

def contestants():
    fakes = (solve, refuse, crash, hang, solve)
    return [Contestant("fake", f"{i} {fake.__name__}", fake) for i, fake in enumerate(fakes)]
"""


class Patient(Library):
    """A library whose contestants have all the time, but for the one that hangs."""

    def _request(self, limit, row, *arguments):
        return super()._request(1.0 if row == HANGS else PATIENCE, row, *arguments)


@pytest.fixture
def fake(tmp_path, monkeypatch):
    """A library of contestants that work, refuse, crash and hang."""
    (tmp_path / "fake_library.py").write_text(FAKE)
    (tmp_path / "absent_library.py").write_text("import no_such_module")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    monkeypatch.setattr(libraries, "START", PATIENCE)
    library = Patient("fake_library", "fake")
    yield library
    library.end()


def test_a_library_solves_in_its_own_process(fake):
    assert len(fake.rows()) == 5
    seconds, found = fake.solve(0, 5.0, 11)
    assert seconds > 0.0
    assert found == pytest.approx(np.linspace(0.0, 5.0, 11)[:, None] * [1, 2])


def test_a_contest_survives_what_refuses_crashes_hangs_or_is_not_there(fake):
    absent = Library("absent_library", "absent")
    elsewhere = Library("fake_library", "elsewhere", "/no/such/python")
    rows = contest(
        [fake, absent, elsewhere],
        lambda found: Errors(float(found[-1, 0]), float(found[-1, 1])),
        Progress(disable=True),
        times=np.linspace(0.0, 5.0, 11),
        repeats=3,
        budget=PATIENCE,
        seconds=PATIENCE,
    )
    absent.end()
    assert [row.errors for row in rows] == [(5.0, 10.0), None, None, None, (5.0, 10.0), None, None]
    assert [len(row.times) for row in rows] == [3, 0, 0, 0, 3, 0, 0]
    said = ["", "would not", "SIGABRT", "within 1 s", "", "no_such_module", "/no/such/python"]
    assert all(words in row.note for words, row in zip(said, rows, strict=True))


def test_a_contest_leaves_out_what_it_has_no_time_for(fake):
    rows = contest(
        [fake],
        lambda found: Errors(0.0, 0.0),
        Progress(disable=True),
        times=np.linspace(0.0, 5.0, 11),
        repeats=3,
        budget=1.0,
        seconds=0.0,
    )
    assert all(row.errors is None and row.note.startswith("left out") for row in rows)


def test_rounds_are_taken_in_turn_and_the_slow_sit_out():
    order = []

    def taking(name, seconds):
        return lambda: order.append(name) or seconds

    times = round_robin([taking("a", 1.0), taking("b", 3.0)], repeats=3, budget=2.5)
    assert order == ["a", "b", "a", "a"]
    assert times == [[1.0, 1.0, 1.0], [3.0]]


OURS = (
    Row("stiction", "loose", [0.010, 0.012], Errors(1e-4, 1e-1)),
    Row("stiction", "tight", [0.050], Errors(1e-9, 1e-9)),
)
PEERS = (
    Row("peer", "as loose", [0.040], Errors(1e-4, 2e-1)),
    Row("peer", "x alone", [0.040], Errors(1e-3, 1e-3)),
    Row("peer", "lost", note="failed: gave up"),
)


def test_rows_are_matched_in_both_forces():
    found = matches([*OURS, *PEERS])
    assert [(match.ours.settings, match.ratio) for match in found] == [
        ("loose", pytest.approx(4.0)),
        ("tight", pytest.approx(0.8)),
    ]
    assert fastest(OURS, Errors(inf, 1e-10)) is None


def test_the_verdict_says_where_ours_is_slower():
    said = verdict([*OURS, *PEERS])
    assert "in 1 of the 2" in said[0]
    assert "x alone" in said[1]
    assert "faster than every peer" in verdict([*OURS, PEERS[0]])[0]
    assert "nowhere" not in verdict(PEERS)[1]
    assert "no row of stiction is as accurate" in verdict(PEERS)[1]


def test_levels_are_reached_or_not():
    level = levels.LEVELS[0]
    for seconds, reached in ((0.11, "yes"), (0.09, "no")):
        lsoda = Row(levels.LSODA, level.settings, [seconds], Errors(1e-4, 1.0))
        table = levels.table([*OURS, lsoda])
        assert table.rows[0][-1] == reached
    failed = levels.table([*OURS, Row(levels.LSODA, level.settings, note="failed: lost")])
    assert failed.rows[0][-1] == ""


def test_the_front_of_a_diagram_leaves_out_what_another_beats():
    assert front([(1.0, 1.0), (2.0, 2.0), (0.5, 3.0)]) == [(1.0, 1.0), (0.5, 3.0)]


def test_a_report_is_written_with_numbers_as_numbers(tmp_path):
    table = Table("Times", ("what", "s"), [("run", 0.25), ("none", None), ("no end", inf)])
    rows = [*OURS, *PEERS]
    section = Section("Part", [table], ["a note"], {"diagram": figure(rows)})
    report.save(tmp_path / "new", {"part": section}, 1.0)
    found = json.loads((tmp_path / "new" / "results.json").read_text())
    assert found["sections"]["part"]["tables"][0]["rows"][0] == ["run", 0.25]
    assert found["sections"]["part"]["tables"][0]["rows"][2] == ["no end", None]
    assert found["machine"]["numba"][0].isdigit()
    text = (tmp_path / "new" / "results.md").read_text()
    assert "| run | 0.25 |" in text
    assert "a note" in text
    assert (tmp_path / "new" / "diagram.png").stat().st_size > 10_000


def test_our_own_contestants_solve():
    from benchmarks.precision.peers import ours

    row = ours.contestants()[3]
    found = row.solve(np.linspace(0.0, 0.02, 21))
    assert found.shape == (21, 2)
    assert found[-1, 0] == pytest.approx(2e-5, rel=1e-2)  # dragged along by the drive at first
    with pytest.raises(Failed):
        ours.solve(np.linspace(0.0, 0.02, 21), rtol=1e-6, max_steps=5)
