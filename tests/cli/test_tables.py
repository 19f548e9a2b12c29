"""Tables in terminals of any width."""

import io

import numpy as np
import pytest
from rich.console import Console

from stiction.cli.tables import in_lines, print_sections, table
from stiction.text.sections import Section, Table, table_html

HEADINGS = (
    "law",
    "sticks",
    "largest k_x u_x/W",
    "fastest slip (m/s)",
    "slowest slip while loading",
)


def text_of(found, width):
    """Return what a terminal of this width shows of a table."""
    console = Console(file=io.StringIO(), width=width, highlight=False)
    console.print(table(found, width))
    return console.file.getvalue()


@pytest.mark.parametrize("width", [30, 40, 50, 60, 80, 120])
def test_no_number_is_broken_and_no_line_longer_than_the_terminal(width):
    random = np.random.default_rng(width)
    for columns in range(2, len(HEADINGS) + 1):
        sizes = 10.0 ** random.uniform(-9.0, 3.0, (6, columns - 1))
        rows = [("coulomb", *(f"{each:.3g}" for each in row)) for row in sizes]
        said = text_of(Table(HEADINGS[:columns], rows), width)
        assert max(map(len, said.splitlines())) <= width
        for row in rows:
            assert all(cell in said.split() for cell in row)


@pytest.mark.parametrize("width", range(40, 90))
def test_a_line_ends_between_a_number_and_its_unit_nowhere(width, capsys, monkeypatch):
    """An audit had "above 35.28 N" and "s/m" below it, and "in 6.564" before "ms."."""
    quantities = ("35.28 N s/m", "320 mN/m", "320 kN/m", "139.7 mN", "6.564 ms")
    damping, low, high, drop, time = quantities
    row = ("damping c_x", f"above {damping}", f"{low} to {high}", f"no remedy: force drop {drop}")
    headings = ("change", "stable", "tried", "simulated from rest")
    sentence = f"Steady sliding is unstable: small disturbances grow by a factor of e in {time}."
    monkeypatch.setenv("COLUMNS", str(width))
    print_sections("an audit", [Section("Verdict", [sentence], Table(headings, [row]))])
    said = capsys.readouterr().out
    assert [each for each in quantities if each not in said] == []
    assert max(map(len, said.splitlines())) <= width


def test_a_table_is_turned_only_where_words_would_be_broken():
    rows = [(law, "152", "0.0993", "0.000392", "2.11e-05") for law in ("coulomb", "lugre")]
    wide = Table(HEADINGS, rows)
    upright, turned, narrow = (text_of(wide, width) for width in (80, 45, 30))
    assert upright.count("sticks") == turned.count("sticks") == 1
    assert turned.splitlines()[1].split() == ["law", "coulomb", "lugre"]
    assert turned.splitlines()[3].split() == ["sticks", "152", "152"]
    assert narrow.count("sticks") == 2  # with each row
    assert "0.000392" in narrow.split("fastest slip")[1].split("slowest")[0]


def test_a_line_does_not_end_within_a_word_that_has_a_hyphen():
    assert in_lines("It is stick-slip.", 12).plain == "It is\nstick-slip."


def test_a_table_without_rows_has_its_headings():
    empty = Table(("law", "sticks"), [])
    assert text_of(empty, 40).split()[:2] == ["law", "sticks"]
    assert table_html(empty).count("<th ") == 2
