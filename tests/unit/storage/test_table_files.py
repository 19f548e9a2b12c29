"""Results for other programs: the content of the files, with units."""

import builtins

import numpy as np
import pandas as pd
import pytest
from scipy.io import loadmat

import stiction as st
from stiction.cli import main


@pytest.fixture(scope="module")
def run(slider):
    return st.simulate(slider, "50 ms", sample_rate="10 kHz")


def read(path):
    """Return a table as it was written; the reader's default may be off by the last digit."""
    return pd.read_csv(path, dtype=str).apply(in_numbers)


def in_numbers(column):
    """Return a column as Python reads its numbers, if it has any."""
    try:
        return column.map(float)
    except ValueError:
        return column


def test_csv_has_a_row_a_sample_and_a_file_for_the_sticks(run, tmp_path):
    assert run.export(tmp_path / "run.csv") == [tmp_path / "run.csv", tmp_path / "run-sticks.csv"]
    samples, sticks = read(tmp_path / "run.csv"), read(tmp_path / "run-sticks.csv")
    assert len(samples) == run.data.sizes["time"]
    assert {"time [s]", "u_x [m]", "psi [deg]", "mu", "sticking"} < {*samples.columns}
    assert np.array_equal(samples["spring_x [N]"], run.data["spring_x"])  # to the last digit
    assert np.array_equal(sticks["stick_end [s]"], run.stick_intervals[:, 1])


def test_matlab_has_a_struct_for_each_table(run, tmp_path):
    assert run.export(tmp_path / "run.mat") == [tmp_path / "run.mat"]
    found = loadmat(tmp_path / "run.mat", simplify_cells=True)
    assert np.array_equal(found["samples"]["u_y"], run.data["u_y"])
    assert np.array_equal(found["samples"]["time"], run.data["time"])
    assert np.array_equal(found["sticks"]["stick_start"], run.stick_intervals[:, 0])
    assert found["units"]["samples"]["theta"] == "deg"
    assert found["units"]["sticks"]["stick_start"] == "s"
    assert st.Slider.from_toml(str(found["description"])) == run.slider


def test_parquet_has_units_among_its_metadata(run, tmp_path):
    parquet = pytest.importorskip("pyarrow.parquet")
    run.export(tmp_path / "run.parquet")
    samples = parquet.read_table(tmp_path / "run.parquet")
    assert np.array_equal(samples["u_y"], run.data["u_y"])
    assert samples.schema.field("u_y").metadata == {b"units": b"m"}
    assert st.Slider.from_toml(samples.schema.metadata[b"description"].decode()) == run.slider
    assert len(pd.read_parquet(tmp_path / "run-sticks.parquet")) == len(run.stick_intervals)


def test_parquet_without_its_library_says_what_to_install(run, tmp_path, monkeypatch):
    known = builtins.__import__

    def without(name, *rest):
        if name.startswith("pyarrow"):
            raise ImportError(name)
        return known(name, *rest)

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(st.ResultError, match=r"pip install 'stiction\[parquet\]'"):
        run.export(tmp_path / "run.parquet")
    assert list(tmp_path.iterdir()) == []


def test_what_cannot_be_written_is_said_before_anything_is_read(run, tmp_path):
    with pytest.raises(st.ResultError, match=r"unknown format '.xlsx'; use .csv"):
        st.export(tmp_path / "none.nc", tmp_path / "run.xlsx")
    with pytest.raises(st.ResultError, match="make it first"):
        run.export(tmp_path / "no" / "run.csv")
    with pytest.raises(st.ResultError, match="no such file"):
        st.export(tmp_path / "none.nc", tmp_path / "run.csv")
    assert list(tmp_path.iterdir()) == []


def test_the_command(run, tmp_path, capsys):
    run.save(tmp_path / "run.nc")
    with pytest.raises(SystemExit) as end:
        main(["export", str(tmp_path / "run.nc"), "-o", str(tmp_path / "run.csv")])
    assert end.value.code == 0
    assert "run-sticks.csv" in capsys.readouterr().out
    assert (tmp_path / "run.csv").exists()


def test_an_analysis_is_exported_table_by_table(tmp_path):
    time = np.arange(0.0, 12.0, 1e-2)
    found = st.analyse(st.Record(time=time, force=1.0 + 0.3 * (time % 1.1), normal_load="10 N"))
    paths = found.export(tmp_path / "test.csv")
    assert [path.name for path in paths[:2]] == ["test.csv", "test-friction.csv"]
    assert np.array_equal(read(paths[0])["peak [N]"], found.cycles["peak"])
    found.export(tmp_path / "test.mat")
    contents = loadmat(tmp_path / "test.mat", simplify_cells=True)
    assert np.array_equal(contents["cycles"]["peak"], found.cycles["peak"])
    assert contents["kind_of_motion"] == found.regime.kind
    assert contents["units"]["friction"]["force"] == "N"
