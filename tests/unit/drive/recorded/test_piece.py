"""Faults of recorded rows, and of the files that hold them, by row and line."""

import gzip

import numpy as np
import pytest

import stiction as st
from stiction.drive.recorded.columns import LARGEST_TEXT
from stiction.errors import DescriptionError

T = np.linspace(0.0, 1.0, 101)
V = 1e-3 * (1.0 + 0.3 * np.sin(12.0 * T))


def faults(time, velocity):
    with pytest.raises(DescriptionError) as error:
        st.protocols.Recorded(time=time, velocity=velocity)
    return {fault.path.split(".")[-1]: fault.message for fault in error.value.faults}


def put(values, **places):
    """Values with others at some rows, counted from 1."""
    changed = values.copy()
    for row, value in places.items():
        changed[int(row[1:]) - 1] = value
    return changed


def test_every_kind_of_fault_at_once():
    with pytest.raises(DescriptionError) as error:
        st.protocols.Recorded(
            time=put(T, r5=T[3], r9=0.0, r20=np.nan), velocity=put(V, r7=np.inf, r8=np.nan)
        )
    told = [(fault.path, fault.message) for fault in error.value.faults]
    assert [path for path, _ in told] == [
        "Recorded.time",
        "Recorded.velocity",
        "Recorded.time",
        "Recorded.time",
    ]
    wanted = ("row 20: nan", "row 7, 8: inf", "row 9: 0 s comes after 0.07 s", "row 5: at 0.03 s")
    assert all(message.startswith(each) for (_, message), each in zip(told, wanted, strict=True))


@pytest.mark.parametrize(
    ("time", "velocity", "column", "words"),
    [
        (T[:3], V[:3], "time", "has 3 rows; a smooth curve needs at least 4"),
        (T[:50], V, "velocity", "has 101 rows and time has 50"),
        (T[::-1], V, "time", "row 2, 3, 4, 5 and 96 more"),
        (np.delete(T, range(40, 60)), np.delete(V, range(40, 60)), "time", "row 41: a gap of"),
        (T, put(V, r30=1e70), "velocity", "row 30: 1e+70"),
        (T, np.where(T < 0.5, V, 2 * V), "velocity", "jumps between two rows, at row 5"),
        (T, "v", "velocity", "names a column"),
        (T, V.reshape(1, -1), "velocity", "one dimension"),
        (T, ["a"] * 101, "velocity", "must be numbers"),
        (np.arange(101).astype("m8[M]"), V, "time", "spans of time, and not in months"),
    ],
)
def test_what_is_wrong_is_told(time, velocity, column, words):
    assert words in faults(time, velocity)[column]


def test_noise_is_told_with_a_remedy():
    noisy = V + 2e-5 * np.random.default_rng(0).normal(size=len(T))
    message = faults(T, noisy)["velocity"]
    assert "noise of" in message
    assert "scipy.signal.sosfiltfilt(scipy.signal.butter(4, " in message
    uneven = T + 0.003 * np.sin(40.0 * T)
    assert "make_smoothing_spline(time, velocity)" in faults(uneven, noisy)["velocity"]


def test_sparse_rows_beside_dense_ones_are_no_gap():
    """Rows may lie close where much happens."""
    time = np.concatenate([np.linspace(0, 1, 6), 1 + np.linspace(0, 0.1, 21)[1:]])
    assert st.protocols.Recorded(time=time, velocity=1e-3 + 1e-4 * time).duration == 1.1


def test_velocity_or_position():
    for given in ({}, {"velocity": V, "position": V}):
        with pytest.raises(DescriptionError, match="give either velocity or position"):
            st.protocols.Recorded(time=T, **given)


def test_arrays_carry_their_units():
    import xarray as xr

    time = xr.DataArray(1e3 * T, attrs={"units": "ms"})
    speed = xr.DataArray(1e3 * V, attrs={"units": "mm/s"})
    made = st.protocols.Recorded(time=time, velocity=speed)
    assert made.duration == pytest.approx(1.0)
    assert made.velocity.values == pytest.approx(V)
    assert "1 mm" in faults(xr.DataArray(T, attrs={"units": "mm"}), V)["time"]


def test_what_a_piece_shows_of_itself():
    made = st.protocols.Recorded(time=T, velocity=V, scale=2.0)
    words = "st.protocols.Recorded(time=<101 values>, velocity=<101 values>, scale=2.0)"
    assert repr(made) == words
    assert made == st.protocols.Recorded(time=T, velocity=V, scale=2.0)
    assert made != st.protocols.Recorded(time=T, velocity=2 * V, scale=2.0)


def file_of(folder, text):
    path = folder / "stage.csv"
    path.write_text(text, encoding="utf-8")
    return path


def rows(separator, decimal="."):
    lines = (f"{1e3 * t:.6f}{separator}{1e3 * v:.9f}" for t, v in zip(T, V, strict=True))
    return "\n".join(lines).replace(".", decimal)


@pytest.mark.parametrize(
    ("text", "columns"),
    [
        ("time [ms],velocity [mm/s]\n" + rows(","), {}),
        ("# a stage\n# t (ms); velocity (mm/s)\n" + rows(";"), {}),
        ("t [ms] velocity [mm/s]\n" + rows("  "), {}),
        ("\ufefft\tspeed\n\n" + rows("\t"), {"time": "t [ms]", "velocity": "speed [mm/s]"}),
        (rows(","), {"time": "1 [ms]", "velocity": "2 [mm/s]"}),
        ('"Time [ms]","V"\n' + rows(","), {"velocity": "v [mm/s]"}),
        ("Zeit [ms];velocity [mm/s]\n" + rows(";", ","), {}),
        ("Operator: A\n\nZeit|velocity\n[ms]|[mm/s]\n" + rows("|"), {}),
        ("# one comment\n" + rows(","), {"time": "1 [ms]", "velocity": "2 [mm/s]"}),
    ],
    ids=[
        "commas",
        "comments",
        "blanks",
        "tabs",
        "numbers",
        "quotes",
        "decimal-commas",
        "bars",
        "one-cell",
    ],
)
def test_files_of_many_kinds(tmp_path, text, columns):
    made = st.protocols.read_recorded(file_of(tmp_path, text), **columns)
    assert made.time.values == pytest.approx(T, abs=1e-9)
    assert made.velocity.values == pytest.approx(V, abs=1e-12)
    assert made.file == "stage.csv"


def test_a_typeset_minus_is_one(tmp_path):
    text = "\n".join(f"{t:.6f},−{v:.9f}" for t, v in zip(T, V, strict=True))
    made = st.protocols.read_recorded(file_of(tmp_path, text), time="1 [s]", velocity="2 [m/s]")
    assert made.velocity.values == pytest.approx(-np.abs(V), abs=1e-9)


def test_a_file_of_a_load(tmp_path):
    path = file_of(tmp_path, "time [s],load [kN]\n" + rows(","))
    made = st.protocols.read_recorded(path, scale=2.0)
    assert isinstance(made, st.protocols.RecordedLoad)
    assert made.load.values == pytest.approx(1e6 * V, rel=1e-6)


HEAD = "time [ms],velocity [mm/s]\n"


@pytest.mark.parametrize(
    ("text", "columns", "words"),
    [
        ("", {}, "stage.csv: is empty"),
        (HEAD, {}, "no line has samples; the first is 'time [ms],velocity [mm/s]'"),
        (HEAD + rows(",") + "\n1001\n", {}, "line 103: nan is not a number; leave the row out"),
        (HEAD + rows(",") + "\n1002,x\n", {}, "line 103: '1002,x' is not a row; mend the line"),
        (HEAD + "0,1.0.0\n" + rows(","), {}, "line 2: '0,1.0.0' is not a row; mend the line"),
        (HEAD + rows(",").replace("10.0", "1x", 1), {}, "line 3, column 1: '1x00000' is not a"),
        (HEAD + "# a\n# b\n1,1\n2,2\nstop\n3,2\n# end\n4,3", {}, "line 6: 'stop' is not a row"),
        (HEAD + "1,1\n2,2\nx [s],F [N]\n3,2\n4,3", {}, "holds 2 tables, the second from line 5"),
        (HEAD + rows(",") + "\n1001,nan\n", {}, "line 103: nan is not a number"),
        (
            "0;1,200\n1;2,300\n2;3,400",
            {},
            "stage.csv: in '1,200' the comma is a decimal sign, or "
            "groups thousands; write points as decimal signs, no sign between thousands, and tabs",
        ),
        (HEAD + "0,5,1,2\n1,5,2,3\n2,5,3,4", {}, "or are decimal signs; write points"),
        (HEAD + rows(",") + "\n999,1\n1000,1\n", {}, "line 103: 0.999 s comes after 1 s"),
        ("run time [s],step time [s],load [N]\n1,2,3\n", {}, "may be any of run time [s], step"),
        (HEAD + rows(","), {"velocity": "speed"}, "no column 'speed'"),
        (HEAD + rows(","), {"time": "time [s]"}, "is to be in s, and the file says ms"),
        ("time,velocity\n" + rows(","), {}, 'has no unit; write time = "time [s]"'),
        (rows(","), {"time": "1 [s]"}, "missing; name the column"),
        (rows(","), {"time": "7 [s]", "velocity": "2 [m/s]"}, "it has column 1, column 2"),
        ("time [ms],velocity [N]\n" + rows(","), {}, "not a unit of a velocity"),
        ("time [ms],velocity [wink]\n" + rows(","), {}, "'wink' is not a known unit"),
        ("time [s],a,a\n0,1,2\n", {"velocity": "a [m/s]"}, "2 columns are named 'a'"),
        ("time [s],velocity [m/s],load [N]\n0,1,2\n", {}, "give either velocity or load"),
    ],
)
def test_what_is_wrong_with_a_file_is_told(tmp_path, text, columns, words):
    with pytest.raises(DescriptionError) as error:
        st.protocols.read_recorded(file_of(tmp_path, text), **columns)
    assert words in str(error.value)


def test_files_that_are_none(tmp_path):
    with pytest.raises(DescriptionError, match="no such file"):
        st.protocols.read_recorded(tmp_path / "none.csv")
    with pytest.raises(DescriptionError, match="is a folder"):
        st.protocols.read_recorded(tmp_path)
    path = tmp_path / "binary.csv"
    for content, words in ((b"\x00\xff\x01" * 100, "not text"), (b"PK\x03\x04", "file of NumPy")):
        path.write_bytes(content)
        with pytest.raises(DescriptionError, match=words):
            st.protocols.read_recorded(path)
    with path.open("wb") as file:
        file.truncate(LARGEST_TEXT + 1)
    with pytest.raises(DescriptionError, match="thin its rows"):
        st.protocols.read_recorded(path)


def test_a_file_may_be_packed_and_unpacks_to_no_more_than_others(tmp_path):
    path = tmp_path / "stage.csv.gz"
    path.write_bytes(gzip.compress((HEAD + rows(",")).encode()))
    assert st.protocols.read_recorded(path).duration == pytest.approx(1.0)
    path.write_bytes(gzip.compress(bytes(LARGEST_TEXT + 1), 1))
    with pytest.raises(DescriptionError, match="more than 67,108,864 bytes; thin its rows"):
        st.protocols.read_recorded(path)


@pytest.mark.parametrize("seed", range(8))
def test_a_damaged_file_is_read_or_refused(tmp_path, seed):
    """Bytes are changed, cut out and doubled at random: no other error than ours."""
    rng = np.random.default_rng(seed)
    whole = (HEAD + rows(",")).encode()
    path = tmp_path / "stage.csv"
    for _ in range(60):
        bad = bytearray(whole)
        for _ in range(rng.integers(1, 6)):
            at, size = rng.integers(0, len(bad)), rng.integers(1, 40)
            change = rng.integers(0, 3)
            if change == 0:
                bad[at : at + size] = rng.integers(0, 256, size).astype(np.uint8).tobytes()
            elif change == 1:
                del bad[at : at + size]
            else:
                bad[at:at] = bad[at : at + size]
        path.write_bytes(bytes(bad))
        try:
            made = st.protocols.read_recorded(path)
        except DescriptionError:
            continue
        assert np.isfinite(made.velocity.values).all()
        assert (np.diff(made.time.values) > 0).all()
