"""Tables in terminals of any width."""

import io
import re

import numpy as np
import pytest
from rich.console import Console

from stiction.cli.tables import in_lines, print_sections, table
from stiction.text.sections import Section, Table, html, table_html

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


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("φ_c = 3 deg", "φ<sub>c</sub> = 3 deg"),
        ("force k_y u_y.", "force k<sub>y</sub> u<sub>y</sub>."),
        ("sin φ/ω_y (k_x/k_y)", "sin φ/ω<sub>y</sub> (k<sub>x</sub>/k<sub>y</sub>)"),
        ("less than F_0, D_c and V_star;", "F<sub>0</sub>, D<sub>c</sub> and V<sub>star</sub>;"),
    ],
)
def test_symbols_are_set_in_html(text, shown):
    assert shown in html(text).replace("\N{NO-BREAK SPACE}", " ")


@pytest.mark.parametrize(
    "text",
    [
        "`st.audit(k_x=2)`", "friction.D_c", "friction.mu_0", "k_x=2", "in a_1.nc, and b_2.csv",
        "column 'F_x'", "normal_load", "mu_star", "slider.k_x[0]", "V_x(t)", "runs/k168_v42.csv.gz",
        "a_b_c", "x_axis", "--k_x",
    ],
)  # fmt: skip
def test_names_are_no_symbols_in_html(text):
    assert "<sub>" not in html(text)


def test_what_a_cell_begins_with_is_a_name_in_html():
    table = Table(("parameter", "value of k_x"), [("k_x", "2 k_y"), ("F_x [N]", "F_x")])
    page = table_html(table).replace("\N{NO-BREAK SPACE}", " ")
    assert re.findall(r"<t[hd] [^>]*>(.*?)</t[hd]>", page) == [
        "parameter", "value of k<sub>x</sub>", "k_x", "2 k<sub>y</sub>", "F_x [N]", "F_x",
    ]  # fmt: skip


def test_a_table_without_rows_has_its_headings():
    empty = Table(("law", "sticks"), [])
    assert text_of(empty, 40).split()[:2] == ["law", "sticks"]
    assert table_html(empty).count("<th ") == 2
