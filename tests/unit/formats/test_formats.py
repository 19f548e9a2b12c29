"""Binary files: NumPy, MATLAB, HDF5, NetCDF, Parquet, LabVIEW, TDMS; each made here."""

import json
import os
import re

import h5py
import numpy as np
import pytest
import xarray as xr
from scipy import io

import stiction as st
from stiction.formats import tdms

TIME = 0.002 * np.arange(50)
FORCE = 1.0 + 0.01 * np.arange(50)


def same(record, factor=1e-3):
    assert np.allclose(record.time, factor * TIME, rtol=1e-14)
    assert np.allclose(record.force, factor * FORCE, rtol=1e-14)


# --- NumPy ----------------------------------------------------------------------------------------


def test_npz_with_names(tmp_path):
    np.savez(tmp_path / "a.npz", time=TIME, force=FORCE)
    same(st.read_record(tmp_path / "a.npz", time="ms", force="mN"))
    np.savez_compressed(tmp_path / "b.npz", time_ms=TIME, force_mN=FORCE)
    same(st.read_record(tmp_path / "b.npz"))


def test_npy_of_columns_and_of_fields(tmp_path):
    np.save(tmp_path / "a.npy", np.column_stack([TIME, FORCE]))
    same(st.read_record(tmp_path / "a.npy", time="1=ms", force="2=mN"))
    fields = np.zeros(50, dtype=[("time", "f8"), ("force", "f4")])
    fields["time"], fields["force"] = TIME, FORCE
    np.save(tmp_path / "b.npy", fields)
    record = st.read_record(tmp_path / "b.npy", time="ms", force="mN")
    assert np.allclose(record.force, 1e-3 * FORCE, rtol=1e-6)


def test_a_pickle_in_an_array_is_not_run(tmp_path):
    class Trap:
        def __reduce__(self):
            return os.mkdir, (str(tmp_path / "sprung"),)

    np.save(tmp_path / "a.npy", np.array([Trap()], dtype=object), allow_pickle=True)
    np.savez(tmp_path / "b.npz", force=np.array([Trap()], dtype=object))
    for name in ("a.npy", "b.npz"):
        with pytest.raises(st.ResultError, match=r"Python objects in dtype|Object arrays cannot"):
            st.read_record(tmp_path / name)
    assert not (tmp_path / "sprung").exists()


# --- MATLAB ---------------------------------------------------------------------------------------


def test_matlab_5_vectors_structs_and_units(tmp_path):
    io.savemat(tmp_path / "a.mat", {"time": TIME, "force": FORCE, "note": "of May"})
    same(st.read_record(tmp_path / "a.mat", time="ms", force="mN"))
    run = {"time": TIME[:, None], "force": FORCE[None, :]}
    units = {"run": {"time": "ms", "force": "mN"}}
    io.savemat(tmp_path / "b.mat", {"run": run, "units": units})
    record = st.read_record(tmp_path / "b.mat")
    same(record)
    assert record.origin.label == "run"


def test_matlab_5_as_our_export_writes_it(tmp_path, slider):
    run = st.simulate(slider, "20 ms", sample_rate="1 kHz")
    run.export(tmp_path / "run.mat")
    record = st.read_record(tmp_path / "run.mat")
    assert np.array_equal(record.force, run.data["spring_x"])
    assert np.array_equal(record.force_across, run.data["spring_y"])


def test_matlab_7_3(tmp_path):
    with h5py.File(tmp_path / "a.mat", "w", userblock_size=512) as file:
        for name, values in (("time", TIME), ("force", FORCE)):
            file[name] = values[None, :]  # a column of MATLAB is a row of HDF5
            file[name].attrs["MATLAB_class"] = np.bytes_("double")
    head = b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(512, b" ")
    with open(tmp_path / "a.mat", "r+b") as file:
        file.write(head)
    record = st.read_record(tmp_path / "a.mat", time="ms", force="mN")
    same(record)
    assert record.origin.format == "MATLAB 7.3"


# --- HDF5 and NetCDF ------------------------------------------------------------------------------


def test_hdf5_with_units_and_steps_in_their_natural_order(tmp_path):
    with h5py.File(tmp_path / "a.h5", "w") as file:
        for step in (10, 13, 4, 7):
            group = file.create_group(f"step{step}")
            group.attrs["started"] = f"12:00:{step:02d}"
            group["time"], group["force"] = TIME, step + FORCE
            group["time"].attrs["units"], group["force"].attrs["units"] = "ms", "mN"
    records = st.read_records(tmp_path / "a.h5")
    assert [each.origin.label for each in records] == ["step4", "step7", "step10", "step13"]
    assert [each.origin.start for each in records] == [f"12:00:{k:02d}" for k in (4, 7, 10, 13)]
    assert np.allclose([each.force[0] for each in records], [5e-3, 8e-3, 11e-3, 14e-3], rtol=1e-14)
    with pytest.raises(st.ResultError, match="holds 4 blocks: 1 step4 at 12:00:04, 50 samples;"):
        st.read_record(tmp_path / "a.h5")


def test_hdf5_with_an_interval_in_place_of_times(tmp_path):
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["force"] = FORCE
        file["force"].attrs["units"] = "mN"
        file.attrs["sample_rate"] = "500 kHz"
    same(st.read_record(tmp_path / "a.h5"))


def test_a_link_to_another_file_is_refused(tmp_path):
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["time"] = TIME
        file["force"] = h5py.ExternalLink("b.h5", "force")
    with pytest.raises(st.ResultError, match="force is a link"):
        st.read_record(tmp_path / "a.h5")


@pytest.mark.parametrize("engine", ["h5netcdf", "scipy"])
def test_netcdf_of_both_formats(tmp_path, engine):
    data = xr.Dataset(
        {"force": ("time", FORCE, {"units": "mN"})}, {"time": ("time", TIME, {"units": "ms"})}
    )
    data.to_netcdf(tmp_path / "a.nc", engine=engine)
    record = st.read_record(tmp_path / "a.nc")
    same(record)
    assert record.origin.format == "NetCDF"


DATES = np.datetime64("2026-03-01T12:00:00", "ns") + np.arange(0, 50, 1) * np.timedelta64(1, "s")


@pytest.mark.parametrize("unit", ["seconds", "milliseconds", "nanoseconds", "hours", "days"])
@pytest.mark.parametrize("since", ["1970-01-01", "2026-03-01 11:59:00"])
def test_netcdf_with_dates(tmp_path, unit, since):
    path, kind = tmp_path / "a.nc", "float64" if unit in ("hours", "days") else "int64"
    data = xr.Dataset({"force": ("time", np.arange(50.0), {"units": "N"})}, {"time": DATES})
    encoding = {"time": {"units": f"{unit} since {since}", "dtype": kind}}
    data.to_netcdf(path, engine="h5netcdf", encoding=encoding)
    record = st.read_record(path)
    assert record.time == pytest.approx(np.arange(50.0), abs=1e-5 if unit == "days" else 1e-6)
    assert f"{unit} since {since[:10]}" in record.origin.start


@pytest.mark.parametrize("resolution", ["s", "ms", "us", "ns"])
def test_npz_with_dates(tmp_path, resolution):
    dates = DATES.astype(f"M8[{resolution}]")
    dates[7] = np.datetime64("NaT", "s")
    np.savez(tmp_path / "a.npz", date=dates, force_N=np.arange(50.0))
    record = st.read_record(tmp_path / "a.npz", force="N")
    assert record.time.tolist() == [float(x) for x in range(50) if x != 7]
    assert record.origin.start.startswith("2026-03-01T12:00:00")


def test_npz_with_a_first_date_that_is_missing(tmp_path):
    dates = DATES.astype("M8[s]")
    dates[0] = np.datetime64("NaT", "s")
    np.savez(tmp_path / "a.npz", date=dates, force_N=np.arange(50.0))
    record = st.read_record(tmp_path / "a.npz", force="N")
    assert record.time.tolist() == [float(x) for x in range(49)]
    assert record.force[0] == 1.0
    assert record.origin.start == "2026-03-01T12:00:01"


@pytest.mark.parametrize("resolution", ["M", "Y"])
def test_npz_with_dates_in_months_is_refused(tmp_path, resolution):
    """They have not one length."""
    dates = np.arange(0, 50).astype(f"M8[{resolution}]")
    np.savez(tmp_path / "a.npz", date=dates, force_N=np.arange(50.0))
    with pytest.raises(st.ResultError, match="no column is the time"):
        st.read_record(tmp_path / "a.npz", force="N")


# --- Parquet --------------------------------------------------------------------------------------


@pytest.mark.parametrize("resolution", ["s", "ms", "us", "ns"])
@pytest.mark.parametrize("zone", [None, "UTC", "Europe/Berlin"])
def test_parquet_with_dates(tmp_path, resolution, zone):
    """They were left out without a word: "no column is the time"."""
    pyarrow, parquet = pytest.importorskip("pyarrow"), pytest.importorskip("pyarrow.parquet")
    dates = pyarrow.array([*DATES, None], pyarrow.timestamp("ns"))
    dates = dates.cast(pyarrow.timestamp(resolution, tz=zone))
    table = pyarrow.table({"index": dates, "force [N]": np.arange(51.0)})
    parquet.write_table(table, tmp_path / "a.parquet")
    record = st.read_record(tmp_path / "a.parquet")
    assert record.time.tolist() == np.arange(50.0).tolist()
    assert record.origin.start.startswith("2026-03-01T12:00:00")


def test_parquet_with_durations_and_times_of_day(tmp_path):
    pyarrow, parquet = pytest.importorskip("pyarrow"), pytest.importorskip("pyarrow.parquet")
    for kind in (pyarrow.duration("ms"), pyarrow.time32("ms"), pyarrow.time64("us")):
        size = 1000 if kind == pyarrow.time64("us") else 1
        values = pyarrow.array(3000 * size * np.arange(9, dtype=np.int64))
        values = values.cast("int32") if kind == pyarrow.time32("ms") else values
        table = pyarrow.table({"time": values.cast(kind), "force [N]": np.arange(9.0)})
        parquet.write_table(table, tmp_path / "a.parquet")
        found = st.read_record(tmp_path / "a.parquet").time
        assert found == pytest.approx(3.0 * np.arange(9.0), rel=1e-15)


def test_parquet(tmp_path, slider):
    pytest.importorskip("pyarrow")
    run = st.simulate(slider, "20 ms", sample_rate="1 kHz")
    run.export(tmp_path / "run.parquet")
    record = st.read_record(tmp_path / "run.parquet")
    assert np.array_equal(record.force, run.data["spring_x"])
    assert np.array_equal(record.load, run.data["normal_load"])


# --- LabVIEW --------------------------------------------------------------------------------------

HEAD = [
    ("LabVIEW Measurement",),
    ("Writer_Version", "2"),
    ("Separator", "Tab"),
    ("Decimal_Separator", ","),
    ("Multi_Headings", "Yes"),
    ("X_Columns", "{x}"),
    ("Time_Pref", "Relative"),
    ("Date", "2024/05/03"),
    ("Time", "12:00:00,5"),
    ("***End_of_Header***",),
    (),
]


def lvm(x, segments):
    """A LabVIEW measurement file of some segments."""
    text = "\n".join("\t".join(row) for row in HEAD).format(x=x) + "\n"
    for second, names, rows, promised in segments:
        segment = [
            ("Channels", "2"),
            ("Samples", *[str(promised)] * 2),
            ("Date", *["2024/05/03"] * 2),
            ("Time", *[f"12:00:{second:02d},5"] * 2),
            ("Y_Unit_Label", "mN", "mm"),
            ("X_Dimension", "Time", "Time"),
            ("X0", "0,0000000000000000E+0", "1,0E-3"),
            ("Delta_X", "2,0E-3", "2,0E-3"),
            ("***End_of_Header***",),
            names,
        ]
        text += "\n".join("\t".join(row) for row in segment) + "\n"
        text += "".join("\t".join(row).replace(".", ",") + "\n" for row in rows)
    return text


def test_labview_with_a_decimal_comma_and_several_headers(tmp_path):
    names = ("X_Value", "Kraft", "drive position", "Comment")
    rows = [(f"{t}", f"{f:.4f}", f"{2 * t}") for t, f in zip(TIME, FORCE, strict=True)]
    (tmp_path / "a.lvm").write_text(lvm("One", [(1, names, rows, 50), (7, names, rows[:30], 50)]))
    first, second = st.read_records(tmp_path / "a.lvm")
    assert np.allclose(first.time, TIME, rtol=1e-12)
    assert np.allclose(first.force, 1e-3 * FORCE, rtol=1e-12)
    assert np.allclose(first.drive_position, 2e-3 * TIME, rtol=1e-12)
    assert (first.origin.start, second.origin.start) == (
        "2024/05/03 12:00:01,5",
        "2024/05/03 12:00:07,5",
    )
    assert "promises 50 samples and has 30" in " ".join(second.origin.notes)


def test_labview_without_times_and_with_a_clock_for_each_channel(tmp_path):
    names = ("X_Value", "Kraft", "drive position", "Comment")
    rows = [("", f"{f:.4f}", f"{2 * (t + 1e-3):.6f}") for t, f in zip(TIME, FORCE, strict=True)]
    (tmp_path / "a.lvm").write_text(lvm("No", [(1, names, rows, 50)]))
    record = st.read_record(tmp_path / "a.lvm")
    assert np.allclose(record.time, TIME, rtol=1e-12)
    assert np.allclose(record.drive_position[1:], 2e-3 * TIME[1:], rtol=1e-9)  # starts at 1 ms


def test_labview_with_times_for_each_channel(tmp_path):
    names = ("X_Value", "Kraft", "X_Value", "drive position", "Comment")
    rows = [
        (f"{t}", f"{f:.4f}", f"{t + 1e-3:.4f}", f"{2 * (t + 1e-3):.6f}")
        for t, f in zip(TIME, FORCE, strict=True)
    ]
    (tmp_path / "a.lvm").write_text(lvm("Multi", [(1, names, rows, 50)]))
    record = st.read_record(tmp_path / "a.lvm")
    assert np.allclose(record.force, 1e-3 * FORCE, rtol=1e-12)
    assert np.allclose(record.drive_position[1:], 2e-3 * TIME[1:], rtol=1e-9)


def test_labview_with_the_minus_of_a_typesetter(tmp_path):
    names = ("X_Value", "Kraft", "drive position", "Comment")
    rows = [(f"{t}", f"{-f:.4f}", f"{-2 * t}") for t, f in zip(TIME, FORCE, strict=True)]
    text = lvm("One", [(1, names, rows, 50)]).replace("1,0E-3", "-1,0E-3")
    for name, each in (("a.lvm", text), ("b.lvm", re.sub(r"(?<!E)-", "−", text))):
        (tmp_path / name).write_text(each, "utf-8")
    plain, typeset = (st.read_record(tmp_path / name) for name in ("a.lvm", "b.lvm"))
    assert (plain.force < 0.0).any()
    for name in ("time", "force", "drive_position"):
        assert np.array_equal(getattr(typeset, name), getattr(plain, name))


def test_labview_with_a_wrong_cell(tmp_path):
    names = ("X_Value", "Kraft", "drive position", "Comment")
    rows = [("0", "1.5", "0"), ("1", "x1", "0"), ("2", "2", "0")]
    (tmp_path / "a.lvm").write_text(lvm("One", [(1, names, rows, 3)]))
    with pytest.raises(st.ResultError, match="line 23, column 2: 'x1' is not a number with a dec"):
        st.read_record(tmp_path / "a.lvm")
    (tmp_path / "b.lvm").write_text("LabVIEW Measurement\t\nSeparator\tTab\n")
    with pytest.raises(st.ResultError, match="line 1 begins a header that has no end"):
        st.read_record(tmp_path / "b.lvm")


# --- TDMS -----------------------------------------------------------------------------------------


def write_tdms(path, stride=0.0):
    """Two channels, the second of which starts later by `stride` seconds."""
    nptdms = pytest.importorskip("nptdms")
    start = np.datetime64("2024-05-03T12:00:00.000000")
    later = start + np.timedelta64(round(stride * 1e6), "us")
    channels = [
        nptdms.ChannelObject(
            "test",
            name,
            values,
            properties={
                "wf_increment": 2e-3,
                "wf_start_offset": 0.0,
                "wf_start_time": begins,
                "unit_string": unit,
            },
        )
        for name, values, begins, unit in (
            ("Force", FORCE, start, "mN"),
            ("Drive position", 2.0 * (TIME + stride), later, "mm"),
        )
    ]
    with nptdms.TdmsWriter(path) as file:
        for channel in channels:
            file.write_segment([channel])


def test_tdms_with_a_start_for_each_channel(tmp_path):
    write_tdms(tmp_path / "a.tdms", stride=0.001)
    record = st.read_record(tmp_path / "a.tdms")
    assert np.allclose(record.time, TIME, atol=1e-12)
    assert np.allclose(record.force, 1e-3 * FORCE, rtol=1e-14)
    assert np.allclose(record.drive_position[1:], 2e-3 * TIME[1:], rtol=1e-9)
    assert record.origin.start == "2024-05-03T12:00:00.000"
    assert record.origin.label == "test"


def test_a_truncated_tdms_file_is_read_as_far_as_it_goes(tmp_path):
    write_tdms(tmp_path / "a.tdms")
    whole = (tmp_path / "a.tdms").read_bytes()
    (tmp_path / "b.tdms").write_bytes(whole[:-100])
    record = st.read_record(tmp_path / "b.tdms")
    assert 0 < len(record) < 50
    assert np.allclose(record.force, 1e-3 * FORCE[: len(record)], rtol=1e-14)
    assert "truncated" in " ".join(record.origin.notes)


def test_tdms_without_its_library_says_what_to_install(tmp_path, monkeypatch):
    (tmp_path / "a.tdms").write_bytes(b"TDSm" + bytes(100))

    def missing(name):
        raise ImportError(name)

    monkeypatch.setattr(tdms, "import_module", missing)
    with pytest.raises(st.ResultError, match=r"pip install 'stiction\[tdms\]'"):
        st.read_record(tmp_path / "a.tdms")


# --- stored records -------------------------------------------------------------------------------


def test_a_record_is_stored_and_loaded_to_the_last_bit(tmp_path):
    text = "time [s],force [N],load [N]\n" + "".join(
        f"{t},{f},{10 + f}\n" for t, f in zip(TIME, FORCE, strict=True)
    )
    (tmp_path / "a.csv").write_text(text)
    record = st.read_record(tmp_path / "a.csv", stiffness="168 N/m", mass="30.7 g", zero="1 mN")
    record.save(tmp_path / "a.nc")
    again = st.read_record(tmp_path / "a.nc")
    assert again.time.tolist() == record.time.tolist()
    for name, values in record.channels().items():
        assert again.channels()[name].tolist() == values.tolist()
    for name in ("stiffness", "mass", "zero", "normal_load", "sensors", "origin"):
        assert getattr(again, name) == getattr(record, name)
    with xr.open_dataset(tmp_path / "a.nc") as data:
        assert data["force"].attrs["units"] == "N"
        assert json.loads(data.attrs["origin"])["file"] == "a.csv"
    assert st.read_record(tmp_path / "a.nc", mass="50 g").mass == 0.05
    with pytest.raises(st.ResultError, match="in SI already: leave out force"):
        st.read_record(tmp_path / "a.nc", force="mN")


def test_a_damaged_stored_record_is_refused(tmp_path):
    record = st.Record(time=TIME, force=FORCE)
    content = bytearray(record.save(tmp_path / "a.nc").read_bytes())
    content[len(content) // 2] ^= 1
    (tmp_path / "a.nc").write_bytes(content)
    with pytest.raises(st.ResultError, match="damaged"):
        st.read_record(tmp_path / "a.nc")
    with pytest.raises(st.ResultError, match="name it"):
        record.save(tmp_path / "a.csv")


def test_analyse_takes_the_file_of_a_record_and_of_a_run(tmp_path, slider):
    run = st.simulate(slider, "0.1 s", sample_rate="1 kHz")
    run.save(tmp_path / "run.nc")
    assert isinstance(st.analyse(tmp_path / "run.nc").source, st.Trajectory)
    st.analysis.record_of(run).save(tmp_path / "record.nc")
    found = st.analyse(tmp_path / "record.nc")
    assert isinstance(found.source, st.Record)
    assert np.array_equal(found.record.force, run.data["spring_x"])


@pytest.mark.parametrize("name", ["a.nc", "a.mat", "a.h5", "a.csv"])
def test_a_damaged_file_is_not_told_to_be_text(name, tmp_path):
    """Its first bytes say neither what it is, nor that it is text: text saved anew is no help."""
    (tmp_path / name).write_bytes(b"\x00\x03\xff\xfe\x81" * 40)
    with pytest.raises(
        st.StictionError, match=r"not text, nor .* it is damaged: copy it again; save text as"
    ):
        st.read_record(tmp_path / name)
    (tmp_path / name).write_bytes("t;µ\n1;2\n3;4\n".encode("cp1252") + b"\x81")
    with pytest.raises(st.StictionError, match="line 4 is not text in cp1252; save it as UTF-8"):
        st.read_record(tmp_path / name)


def test_a_file_beside_a_record_that_is_not_there(tmp_path):
    (tmp_path / "a.csv").write_text("time (s),force (N)\n0,1\n1,2\n2,3\n")
    with pytest.raises(
        st.DescriptionError, match=r"no such file; .* \[columns\], \[reading\]"
    ) as e:
        st.read_record(tmp_path / "a.csv", sidecar=tmp_path / "b.toml")
    assert "stiction init" not in str(e.value)
    with pytest.raises(st.DescriptionError, match="is a folder; write a file"):
        st.read_record(tmp_path / "a.csv", sidecar=tmp_path)


def test_what_a_record_is_may_come_through_a_pipe(tmp_path):
    """As ``--sidecar <(...)`` of a shell gives it."""
    (tmp_path / "a.csv").write_text("0;1\n1;2\n2;3\n")
    reading, writing = os.pipe()
    os.write(writing, b'[columns]\ntime = "1 = ms"\nforce = "2 = mN"\n')
    os.close(writing)
    found = st.read_record(tmp_path / "a.csv", sidecar=f"/dev/fd/{reading}")
    os.close(reading)
    assert found.force.tolist() == pytest.approx([1e-3, 2e-3, 3e-3])


def test_an_empty_record_is_read_as_it_was_stored(tmp_path):
    st.Record(time=np.zeros(0), force=np.zeros(0)).save(tmp_path / "a.nc")
    assert len(st.read_record(tmp_path / "a.nc").time) == 0
