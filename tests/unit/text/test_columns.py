"""Columns of numbers have one unit and one number of decimals."""

from __future__ import annotations

import pytest

from stiction.errors import ResultError
from stiction.storage.files import make_folder
from stiction.text.columns import Quantity, grid


@pytest.mark.parametrize(
    ("values", "unit", "heading", "cells"),
    [
        ([3.87246, 12.5, float("nan")], "N", "a (N)", ["3.87", "12.50", "none"]),
        ([9.9996e-7, 1e-12], "m", "a (µm)", ["1.000", "0.000"]),
        ([-936e-3, 2e-6], "N", "a (mN)", ["-936.0", "0.0"]),
        ([0.0, -1e-30], "J", "a (qJ)", ["0.000", "-1.000"]),
        ([0.0, 0.0], "J", "a (J)", ["0.000", "0.000"]),
        ([255444.4, -0.0], "1/s", "a (1/s)", ["255444", "0"]),
        ([0.53492], "1", "a", ["0.5349"]),
    ],
)
def test_a_column(values: list[float], unit: str, heading: str, cells: list[str]) -> None:
    table = grid({"a": Quantity(values, unit)}, 5)
    assert table.headings == (heading,)
    assert [row[0] for row in table.rows] == cells
    assert table.sides() == ["right"]


def test_columns_of_one_kind_are_written_alike() -> None:
    work, part = Quantity([5e-3, 4e-3], "J"), Quantity([5e-5, -2e-9], "J")
    table = grid({"from": Quantity([0.1, 0.2], "s"), "work": work, "part": part}, 5, alike="J")
    assert table.headings == ("from (ms)", "work (mJ)", "part (mJ)")
    assert table.rows[0] == ("100.0", "5.000", "0.050")
    assert table.rows[1] == ("200.0", "4.000", "0.000")


def test_no_more_rows_than_wanted() -> None:
    assert len(grid({"a": Quantity(range(9), "s"), "b": Quantity(range(9), "1")}, 4).rows) == 4


def test_a_folder_that_cannot_be_made_says_so(tmp_path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(ResultError, match="cannot be made"):
        make_folder(tmp_path / "file" / "folder")
    assert make_folder(tmp_path / "new").is_dir()
    assert make_folder(tmp_path / "new").is_dir()


def test_lengths_that_no_instrument_can_measure_are_none() -> None:
    table = grid({"creep": Quantity([5.5e-14, -1e-21, float("nan")], "m")}, 3)
    assert table == (("creep (pm)",), [("0",), ("0",), ("none",)])
