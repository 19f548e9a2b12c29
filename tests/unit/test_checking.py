"""Damage is never silent: it is refused, or the damaged part is computed again, bit by bit."""

import json
import pickle
import shutil
from dataclasses import replace
from pathlib import Path

import h5py
import numpy as np
import pytest
import xarray as xr
from benchmarks.explore.draw import Draw

import stiction as st
from stiction import cli
from stiction.result import file as result_file
from stiction.result.file import DamageError
from stiction.result.table import as_table
from stiction.study.execution import repair

SEED, DAMAGES = 1, 32  # of a result, and as many of a store
BASE = st.Description(st.presets.nakano_popov_2020(), st.Initial(), st.Settings(duration="10 ms"))
STUDY = st.Study(
    base=BASE,
    axes={"phi": st.Values(["1 deg", "95 deg", "3 deg"]), "drive.velocity": st.Values([1e-3])},
    measures=["peak_force", "regime"],
    traces=["force"],
    trace_samples=3,
)


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    path = tmp_path_factory.mktemp("result") / "a.nc"
    return st.simulate(BASE.slider, "20 ms", sample_rate="1 kHz").save(path)


@pytest.fixture(scope="module")
def store(tmp_path_factory):
    path = tmp_path_factory.mktemp("store") / "a.zarr"
    st.sweep(STUDY, path)
    return path


def damage(file: Path, number: int) -> str:
    """Flip a bit, cut the file, fill a part with zeros, or take it away; return which."""
    draw, content = Draw(SEED, number), bytearray(file.read_bytes())
    at = int(draw.between(0, len(content)))
    kind = ("flip", "flip", "flip", "cut", "zeros", "gone")[int(draw.between(0, 6))]
    if kind == "flip":
        content[at] ^= 1 << int(draw.between(0, 8))
    elif kind == "cut":
        del content[at:]
    elif kind == "zeros":
        content[at : at + 64] = bytes(len(content[at : at + 64]))
    file.unlink() if kind == "gone" else file.write_bytes(content)
    return kind


def same(one: st.Trajectory, other: st.Trajectory) -> bool:
    """Return whether two runs are identical, attributes and all."""
    return (
        one.data.identical(other.data)
        and one.sticks.identical(other.sticks)
        and one.description.to_json() == other.description.to_json()
    )


def test_no_damage_of_a_result_is_silent(result, tmp_path):
    right, seen, path = st.load(result), {"refused": 0, "repaired": 0, "same": 0}, tmp_path / "a.nc"
    for number in range(DAMAGES):
        shutil.copy(result, path)
        if damage(path, number) == "gone":
            continue
        try:
            found = st.load(path)
        except st.ResultError:
            if number % 5:  # to compute all again takes long
                seen["refused"] += 1
                continue
            try:
                st.check(path, repair=True)
            except st.ResultError:
                seen["refused"] += 1
                continue
            found = st.load(path)
            seen["repaired"] += 1
        else:
            seen["same"] += 1  # where nothing is that is read
        assert same(found, right), number
    assert seen["refused"] > 0
    assert seen["repaired"] > 0


def test_what_is_damaged_is_told_by_another_process_too():
    error = DamageError("a.nc", ["u_x", "u_y"])
    again = pickle.loads(pickle.dumps(error))
    assert (str(again), again.lost) == (str(error), "u_x, u_y")


def test_no_damage_of_a_store_is_silent(store, tmp_path):
    right, path = xr.open_zarr(store).load(), tmp_path / "a.zarr"
    files = sorted(each.relative_to(store) for each in store.rglob("*") if each.is_file())
    seen = {"refused": 0, "repaired": 0, "pending": 0}
    for number in range(DAMAGES):
        shutil.rmtree(path, ignore_errors=True)
        shutil.copytree(store, path)
        file = files[int(Draw(SEED, 1000 + number).between(0, len(files)))]
        damage(path / file, number)
        try:
            found = st.open_study(path).load()
        except st.ResultError:
            try:
                checked = st.check(path, repair=number % 5 == 0)  # to compute again takes long
            except st.ResultError:
                seen["refused"] += 1
                continue
            assert checked.damaged
            if not checked.repaired:
                continue
            seen["repaired"] += 1
        else:
            if not found.identical(right):  # a mark that is gone: the block is done again
                assert (found["status"] == -1).any()
                st.sweep(STUDY, path)
                seen["pending"] += 1
        assert xr.open_zarr(path).load().identical(right), (number, file)
    assert all(seen.values()), seen


def test_a_result_at_times_of_its_own_is_repaired_as_it_was(tmp_path):
    run = st.simulate(st.presets.nakano_popov_2020(), "20 ms", times=[1e-3, 3e-3, 1.7e-2])
    path = run.save(tmp_path / "a.nc")
    with h5py.File(path, "r+") as file:
        file["u_x"][1] += 1e-9
    assert st.check(path, repair=True).repaired
    assert st.load(path) == run
    with h5py.File(path, "r+") as file:
        file["time"][1] += 1e-9
    with pytest.raises(st.ResultError, match="and so are its times"):
        st.check(path, repair=True)
    with pytest.raises(st.ResultError, match="is damaged"):
        st.load(path)


def test_a_result_that_was_given_up_is_not_replaced_by_another_run(tmp_path):
    """Its description does not hold max_steps: the repair was the whole run, and did not say so."""
    slider = st.presets.nakano_popov_2020()
    run = st.simulate(slider, "20 ms", max_steps=20)
    assert not run.status.ok
    path = run.save(tmp_path / "a.nc")
    with h5py.File(path, "r+") as file:
        file["u_x"][1] += 1e-9
    content = path.read_bytes()
    with pytest.raises(st.ResultError, match=r"the run used up its max_steps; .*; run it again$"):
        st.check(path, repair=True)
    assert path.read_bytes() == content
    assert not st.check(path).ok


@pytest.mark.parametrize("times", [None, [1e-3, 3e-3, 0.15, 0.3]])
def test_a_run_that_ended_by_itself_is_repaired_as_it_was(tmp_path, times):
    """Its times are as they were, too: where they were its own, they were those of a whole run."""
    program = [st.protocols.Ramp("-20 N", "0.4 s")]
    slider = st.presets.nakano_popov_2020()
    slider = slider.replace(load=st.protocols.LoadProgram(program=program))
    run = st.simulate(slider, "0.3 s", times=times)
    assert run.status is st.Status.CONTACT_LOST
    path = run.save(tmp_path / "a.nc")
    with h5py.File(path, "r+") as file:
        file["u_x"][1] += 1e-9
    assert st.check(path, repair=True).repaired
    assert st.load(path) == run


@pytest.mark.parametrize(
    ("name", "value", "says"),
    [
        ("stiction_version", "0.4.9", "stiction 0.4.9 wrote it, this is .*; use that one"),
        ("status", "CONTACT_LOST", "another run: status was 'CONTACT_LOST', is 'COMPLETED'"),
        ("steps", 5, "another run: steps was 5, is "),
        ("stick_count", 3, "another run: stick_count was 3, is "),
    ],
)
def test_a_repair_is_the_run_that_was_damaged(tmp_path, name, value, says):
    """As a file of another version, or of an unknown change, would have it."""
    run = st.simulate(st.presets.nakano_popov_2020(), "20 ms")
    data = run.data.assign_attrs({name: value})
    path = replace(run, arrays=lambda: as_table(data)).save(tmp_path / "a.nc")
    with h5py.File(path, "r+") as file:
        file["u_x"][1] += 1e-9
    content = path.read_bytes()
    with pytest.raises(st.ResultError, match=says):
        st.check(path, repair=True)
    assert path.read_bytes() == content


@pytest.mark.parametrize(
    "gone", ["phi", "phi/c/0", "peak_force", "peak_force/zarr.json", "status/zarr.json"]
)
def test_what_is_taken_away_is_made_again(store, tmp_path, gone):
    path = shutil.copytree(store, tmp_path / "a.zarr")
    shutil.rmtree(path / gone) if (path / gone).is_dir() else (path / gone).unlink()
    for door in (st.open_study, st.map, lambda path: st.sweep(STUDY, path)):
        with pytest.raises(st.ResultError, match=r"is damaged: .*st\.check\(.*, repair=True\)"):
            door(path)
    found = st.check(path)
    assert not found.ok
    assert any(name.startswith(gone) for name in found.damaged)
    assert st.check(path, repair=True).repaired
    assert st.check(path).ok
    assert st.open_study(path).load().identical(xr.open_zarr(store).load())


@pytest.mark.parametrize("array", ["status", "peak_force", "phi"])
@pytest.mark.parametrize(
    ("key", "value"),
    [("fill_value", 10**6), ("fill_value", 1e999), ("shape", [-1]), ("data_type", "int9")],
)
def test_metadata_that_no_array_can_have_are_told_and_made_again(
    store, tmp_path, array, key, value
):
    path = shutil.copytree(store, tmp_path / "a.zarr")
    about = json.loads((path / array / "zarr.json").read_text())
    (path / array / "zarr.json").write_text(json.dumps({**about, key: value}))
    for door in (st.open_study, st.map, lambda path: st.sweep(STUDY, path)):
        with pytest.raises(st.ResultError, match=r"is damaged: .*st\.check\(.*, repair=True\)"):
            door(path)
    assert st.check(path, repair=True).repaired
    assert st.open_study(path).load().identical(xr.open_zarr(store).load())


def test_without_its_consolidated_metadata_a_store_is_damaged(store, tmp_path):
    path = shutil.copytree(store, tmp_path / "a.zarr")
    root = json.loads((path / "zarr.json").read_text())
    del root["consolidated_metadata"]
    (path / "zarr.json").write_text(json.dumps(root))
    assert st.check(path).damaged == ["zarr.json"]
    assert st.check(path, repair=True).repaired
    assert st.open_study(path).load().identical(xr.open_zarr(store).load())


def test_repairs_of_one_store_at_the_same_time(store, tmp_path, monkeypatch):
    """Another one has begun with the damaged block."""
    path, damage_of = shutil.copytree(store, tmp_path / "a.zarr"), repair.damage_of
    flip(path / "peak_force" / "c" / "1" / "0")

    def late(each):
        found = damage_of(each)
        (path / "status" / "c" / "1" / "0").unlink()
        return found

    monkeypatch.setattr(repair, "damage_of", late)
    assert repair.restore(path) == ["peak_force/c/1/0"]
    assert st.open_study(path).load().identical(xr.open_zarr(store).load())


def flip(file: Path) -> None:
    """Flip a bit in the middle of a file."""
    content = bytearray(file.read_bytes())
    content[len(content) // 2] ^= 1
    file.write_bytes(content)


def test_a_flipped_bit_among_values_is_told_when_they_are_read(store, tmp_path, capsys):
    chunks = [each for each in store.rglob("*") if each.is_file() and each.name != "zarr.json"]
    for chunk in chunks:
        name = chunk.relative_to(store).as_posix()
        path = shutil.copytree(store, tmp_path / name.replace("/", "-"))
        flip(path / name)
        again = rf"st\.check\({str(path)!r}, repair=True\)$"
        with pytest.raises(st.ResultError, match=rf": {name}; .*{again}") as told:
            pickle.loads(pickle.dumps(st.open_study(path))).load()  # as another process reads it
        assert len(str(told.value).splitlines()) == 1
        with pytest.raises(SystemExit) as end:
            cli.main(["map", str(path), "-o", str(tmp_path / "a.png")])
        assert end.value.code == 2
        assert "--repair" in capsys.readouterr().err
    assert len(chunks) > 6
    assert not (tmp_path / "a.png").exists()


def change(root: dict) -> bytes:
    """Change a store's own metadata, and the description in it."""
    changed = root["attributes"]["description"].replace("phi", "psi")
    return json.dumps(root | {"attributes": root["attributes"] | {"description": changed}}).encode()


@pytest.mark.parametrize(
    "damage", [change, lambda root: json.dumps(root)[:300].encode(), lambda root: b"\xff{}"]
)
def test_what_cannot_be_computed_again_is_said_to_be_lost(store, tmp_path, damage, capsys):
    path = shutil.copytree(store, tmp_path / "a.zarr")
    content = damage(json.loads((path / "zarr.json").read_text()))
    (path / "zarr.json").write_bytes(content)
    for door in (st.open_study, st.map, st.check, lambda path: st.sweep(STUDY, path)):
        with pytest.raises(
            st.ResultError, match=r"zarr\.json.*run the study anew in another store"
        ):
            door(path)
    for more in ([], ["--repair"]):
        with pytest.raises(SystemExit) as end:
            cli.main(["check", str(path), *more])
        assert end.value.code == 2
        assert "run the study anew" in " ".join(capsys.readouterr().err.split())
    assert (path / "zarr.json").read_bytes() == content


def test_a_removed_variable_of_a_result_is_missed(result, tmp_path):
    run = st.load(result)
    with xr.open_dataset(result, engine="h5netcdf", decode_times=False) as data:
        data.drop_vars("mu").to_netcdf(tmp_path / "a.nc", engine="h5netcdf")
    run.sticks.to_netcdf(tmp_path / "a.nc", mode="a", group="sticks", engine="h5netcdf")
    with pytest.raises(st.ResultError, match=r"is damaged, or was changed: samples\.mu,"):
        st.load(tmp_path / "a.nc")
    assert st.check(tmp_path / "a.nc", repair=True).repaired
    assert same(st.load(tmp_path / "a.nc"), run)


def test_results_without_checksums_load(result, tmp_path):
    run = st.load(result)
    run.data.to_netcdf(tmp_path / "a.nc", engine="h5netcdf")
    run.sticks.to_netcdf(tmp_path / "a.nc", mode="a", group="sticks", engine="h5netcdf")
    assert same(st.load(tmp_path / "a.nc"), run)
    found = st.check(tmp_path / "a.nc")
    assert found.ok
    assert "There are no checksums" in str(found)
    assert "no checksums" not in str(st.check(result))


def test_a_result_of_another_layout_is_refused_and_not_repaired(tmp_path, monkeypatch):
    """One of a later version with the same columns was read as if they meant what they do here."""
    run = st.simulate(BASE.slider, "1 ms")
    with monkeypatch.context() as later:
        later.setattr(result_file, "LAYOUT", 2)
        path = run.save(tmp_path / "later.nc")
        assert same(st.load(path), run)  # the layout is the file's, not the run's
    content = path.read_bytes()
    for read in (st.load, st.check, lambda path: st.check(path, repair=True)):
        with pytest.raises(st.ResultError, match="has layout 2, and layout 1 is read here; read"):
            read(path)
    assert path.read_bytes() == content


def test_the_command_says_what_is_damaged(result, store, tmp_path, capsys):
    path, whole = tmp_path / "a.nc", result.read_bytes()
    at = whole.index(b"largest") if b"largest" in whole else whole.index(b"elongation")
    path.write_bytes(whole[:at] + b"X" + whole[at + 1 :])

    def said(code, *arguments):
        with pytest.raises(SystemExit) as left:
            cli.main(["check", *map(str, arguments)])
        assert left.value.code == code
        return capsys.readouterr().out

    assert "Nothing is damaged" in said(0, result)
    assert "Nothing is damaged" in said(0, store)
    assert f"stiction check {path} --repair" in said(1, path)
    assert "computed again" in said(0, path, "--repair")
    assert "Nothing is damaged" in said(0, path)
    said(2, tmp_path / "nothing")


def test_a_study_that_is_not_done_is_no_damage(store, tmp_path):
    path = shutil.copytree(store, tmp_path / "a.zarr")
    (path / "status" / "c" / "0" / "0").unlink()
    found = st.check(path)
    assert (found.ok, found.pending) == (True, 1)


def write_format_1(path: Path) -> Path:
    """Make of a store one of format 1, as versions without checksums wrote it."""
    for file in [each for each in path.rglob("*") if each.is_file()]:
        if file.name != "zarr.json":
            file.write_bytes(file.read_bytes()[:-4])
            continue
        root = json.loads(file.read_text(), object_hook=without_codec)
        if "format" in root["attributes"]:
            del root["attributes"]["checksums"]
            root["attributes"]["format"] = 1
        file.write_text(json.dumps(root))
    return path


def without_codec(table: dict) -> dict:
    """Return metadata of an array without the codec that adds checksums."""
    if "codecs" in table:
        table["codecs"] = [each for each in table["codecs"] if each["name"] != "crc32c"]
    return table


def test_a_store_without_checksums_goes_on(store, tmp_path):
    path = write_format_1(shutil.copytree(store, tmp_path / "a.zarr"))
    right = xr.open_zarr(store).load().drop_attrs(deep=False)
    assert st.open_study(path).load().drop_attrs(deep=False).identical(right)
    (path / "status" / "c" / "0" / "0").write_bytes(b"")  # as a power cut left it
    (path / "regime" / "c" / "2" / "0").unlink()
    with pytest.raises(st.ResultError, match="is damaged: status/c/0/0, regime/c/2/0"):
        st.open_study(path)
    done = []
    st.sweep(STUDY, path, progress=done.append)
    assert len(done) == 2
    assert xr.open_zarr(path).load().drop_attrs(deep=False).identical(right)
    assert st.check(path).ok
    assert "There are no checksums" in str(st.check(path))
    assert "no checksums" not in str(st.check(store))


def test_what_is_no_result_by_its_name_is_not_called_a_broken_one(tmp_path):
    (tmp_path / "rig.toml").write_text("[slider]\n")
    with pytest.raises(st.ResultError, match=r"a \.toml file is not a result"):
        st.check(tmp_path / "rig.toml")


def test_what_cannot_be_checked_is_said_without_the_words_of_a_library(tmp_path):
    whole = st.simulate(st.presets.nakano_popov_2020(), 0.01).save(tmp_path / "a.nc")
    content = bytearray(whole.read_bytes())
    content[len(content) // 2 :] = b"\0" * (len(content) - len(content) // 2)
    (tmp_path / "bad.nc").write_bytes(content)
    (tmp_path / "text.nc").write_text("time,force")
    (tmp_path / "folder").mkdir()
    for name, what in (
        ("text.nc", r"not a NetCDF file; run.save\(path\) writes one"),
        ("folder", r"is not the store of a study; st.sweep\(study, path\) makes one$"),
    ):
        with pytest.raises(st.ResultError, match=what):
            st.check(tmp_path / name)
    with pytest.raises(st.ResultError, match="a file, not the store of a study"):
        st.map(whole)


def test_a_changed_result_is_said_once_to_be_damaged(tmp_path):
    path = st.simulate(st.presets.nakano_popov_2020(), 0.01).save(tmp_path / "a.nc")
    with h5py.File(path, "r+") as file:
        file["u_x"][0] = 1.0
    lines = str(st.check(path)).splitlines()
    assert lines[1].strip() == "Damaged: samples.u_x."


def test_a_stored_record_is_no_damaged_run(tmp_path, capsys):
    """A load cell's record is whole, whatever asks for a run; a changed one is told."""
    time = np.arange(0.0, 2.0, 0.01)
    path = st.Record(time=time, force=1.0 + time % 0.3).save(tmp_path / "record.nc")
    assert st.check(path).ok
    for command in (["plot", path, "-o", tmp_path / "a.png"], ["export", path, "-o", "a.csv"]):
        with pytest.raises(SystemExit) as ended:
            cli.main([str(each) for each in command])
        assert ended.value.code == 2
        said = " ".join(capsys.readouterr().err.split())
        assert "is a record, not the result of a run; stiction analyse" in said
        assert "damage" not in said
    data = bytearray(path.read_bytes())
    data[data.find(time[17:19].tobytes()) + 9] ^= 4
    path.write_bytes(data)
    with pytest.raises(st.ResultError, match=r"is damaged.*import the record again"):
        st.check(path)


def test_somebody_else_s_netcdf_is_no_damaged_run(tmp_path):
    path = tmp_path / "weather.nc"
    xr.Dataset({"t2m": ("time", np.zeros(4))}).to_netcdf(path, engine="h5netcdf")
    with pytest.raises(st.ResultError, match="not the result of a run"):
        st.check(path)


def test_a_cut_result_is_a_selection_and_not_repaired(tmp_path):
    """A repair would put the whole run in its place."""
    run = st.simulate(st.presets.nakano_popov_2020(), "20 ms", sample_rate="10 kHz")
    path, cut = tmp_path / "r.nc", tmp_path / "cut.nc"
    run.save(path)
    with xr.open_dataset(path) as data:
        data.sel(time=slice(0.005, 0.015)).to_netcdf(cut, engine="h5netcdf")
    content = cut.read_bytes()
    for read in (st.load, st.check, lambda each: st.check(each, repair=True)):
        with pytest.raises(st.ResultError, match="is a part of a result") as error:
            read(cut)
        assert "st.read_record" in str(error.value)
        assert "repair" not in str(error.value)
    assert cut.read_bytes() == content
    assert 95 <= len(st.read_record(cut).time) <= 105
    with xr.open_dataset(path) as data:
        data.load()["u_x"][3] += 1e-3
        data.to_netcdf(cut, engine="h5netcdf")
    with pytest.raises(st.ResultError, match="is damaged, or was changed"):
        st.load(cut)
