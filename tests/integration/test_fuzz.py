"""Nonsense for every reader: it is refused in a message, with exit status 2, and in bounded time.

More of it: ``python -m benchmarks.explore.fuzz --inputs 5000``.
"""

import json
from contextlib import contextmanager
from shutil import rmtree

import h5py
import numpy as np
import pytest
import zarr
from benchmarks.explore import fuzz

import stiction as st
from stiction.cli import main
from stiction.simulation import run
from stiction.study.store.seal import seal
from stiction.text.toml import read_json

SEED = 20  # any will do
COUNTS = {
    "store": 12,
    "result": 25,
    "record": 60,
    "record_file": 120,
    "command": 25,
}  # of those that take longer


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Where the damaged files lie, and the whole ones that they are made of."""
    return tmp_path_factory.mktemp("fuzz")


@pytest.mark.parametrize("reader", fuzz.READERS)
def test_nonsense_is_refused_in_words(reader, folder):
    seen = [fuzz.look(reader, SEED, number, folder) for number in range(COUNTS.get(reader, 150))]
    wrong = [each for each in seen if each is not None and each.error]
    assert not wrong, f"{wrong[0].reader} {wrong[0].number}: {wrong[0].error}"


def test_the_corpus_is_the_same_each_time(folder):
    def drawn():
        draw = fuzz.Draw(SEED, 3)
        return repr([fuzz.damage_tree(draw, fuzz.STUDY.to_dict()) for _ in range(20)])

    assert drawn() == drawn()


def refusal(text, *options, capsys, tmp_path):
    """Return what the command line says of a description."""
    path = tmp_path / "a.toml"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(SystemExit) as end:
        main(["run", str(path), "-o", str(tmp_path / "a.nc"), *options])
    assert end.value.code == 2
    assert sorted(tmp_path.iterdir()) == [path]  # no half file
    return capsys.readouterr().err


GOOD = st.Description(fuzz.PAPERS, st.Initial(), fuzz.SETTINGS).to_toml()


@pytest.mark.parametrize(
    ("value", "path", "said"),
    [
        ("9" * 4300, "mass", "has at most 64 bits"),
        ("9" * 5000, "a.toml", "is not TOML: Exceeds the limit"),
        ("0x" + "f" * 5000, "mass", "has at most 64 bits"),
        ("1e400", "mass", "inf is not finite"),
        ("-1e61", "mass", "is beyond 1e+60 kg"),
        ("1e-320", "mass", "must be greater than 0 (in SI, below 1e-60 counts as 0)"),
        ("'1 N**9999999'", "mass", "'*' is in the place of a unit"),
        ("'1 N^2^9^9^9^9'", "mass", "'^9^9^9^9' is not a unit"),
        ("'1 kg" + " m" * 5000 + "'", "mass", "has 10004 characters"),
        ("'1 " + "(" * 60 + "'", "mass", "it is incomplete"),
        ("'0." + "0" * 150 + "1 kg'", "mass", "must be greater than 0"),
        ("[" * 5000, "a.toml", "is nested more deeply than 16 levels"),
        ("[" * 40 + "]" * 40, "a.toml", "is nested more deeply than 16 levels"),
        ("1979-05-27", "mass", "is not a mass"),
    ],
)
def test_a_value_that_broke_it_once(value, path, said, capsys, tmp_path):
    text = GOOD.replace('mass = "250 g"', f"mass = {value}")
    told = refusal(text, capsys=capsys, tmp_path=tmp_path)
    where = str(tmp_path / path) if path == "a.toml" else f"slider.{path}"
    assert f"  {where}: " in told
    assert said in told
    assert len(told) < 3000


@pytest.mark.parametrize("name", ["k_x", "k_y", "normal_load", "mu_0", "v_f", "V", "initial.u_x"])
@pytest.mark.parametrize("value", ["1e-320", "1e300", "1e-59", "1e59"])
def test_a_magnitude_is_refused_or_run(name, value):
    """Whatever may be written can be squared, and multiplied by all else."""
    with refusals() as refused:
        described = st.Description.from_toml(GOOD, {name: float(value)})
        coarse = described.run.model_copy(update={"sample_rate": 0.0})
        found = run(described._replace(run=coarse), max_steps=200)
        assert isinstance(found.status, st.Status)
    if refused:
        last = name.rpartition(".")[2].replace("V", "velocity")
        assert refused[0].faults[0].path.endswith(last)


@contextmanager
def refusals():
    """Yield a list that holds what was refused, if anything was, in the end."""
    seen = []
    try:
        yield seen
    except st.StictionError as error:
        seen.append(error)


@pytest.mark.parametrize("text", ["", "[]", "1", "{", '{"a": ' * 3000, "null", '"text"'])
def test_what_is_no_description_in_json(text):
    with pytest.raises(st.DescriptionError, match="description: "):
        read_json(text)
    with pytest.raises(st.DescriptionError, match="description: "):
        st.Description.from_json(text)


def test_every_fault_of_a_file_is_told_at_once(capsys, tmp_path):
    text = GOOD.replace('mass = "250 g"', "mass = 1e400").replace("v_f", "v_F") + "x = 1\n[y]\n"
    told = refusal(text, capsys=capsys, tmp_path=tmp_path)
    for path in ("slider.mass", "friction.v_f", "friction.v_F", "run.x", "y"):
        assert f"  {path}: " in told


def test_no_more_is_read_than_a_description_has():
    with pytest.raises(st.DescriptionError, match="has more than 16,777,216 bytes"):
        st.Description.from_toml("/dev/zero")


def test_a_file_of_another_version_says_so(tmp_path, slider):
    """What a later version has changed cannot be known; that it was another one can be."""
    path = st.simulate(slider, "20 ms", sample_rate="1 kHz").save(tmp_path / "a.nc")
    with h5py.File(path, "r+") as file:
        file.attrs["stiction_version"] = "9.0"
        tables = json.loads(file.attrs["description"])
        file.attrs["description"] = json.dumps({**tables, "later": {}})
    fuzz.reseal(path)
    with pytest.raises(st.ResultError, match=r"unknown table 'later'.*stiction 9.0 wrote it, this"):
        st.load(path)
    with h5py.File(path, "r+") as file:
        del file["u_x"]
    fuzz.reseal(path)
    with pytest.raises(st.ResultError, match=r"lacks u_x.*; stiction 9.0 wrote it, this is"):
        st.load(path)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda file: file["time"].__setitem__(slice(None), np.nan), "time must be finite"),
        (lambda file: file["time"].__setitem__(slice(None), 1.0), "time must be finite and ascend"),
        (lambda file: file["spring_x"].__setitem__(slice(None), np.nan), "no sample of the run"),
        (lambda file: file.attrs.update(status="LATER"), "its attributes cannot be read"),
        (lambda file: file.attrs.update(steps="many"), "its attributes cannot be read"),
        (lambda file: file.attrs.update(description=1.0), "description is not text"),
    ],
)
def test_a_foreign_result(change, said, slider, tmp_path):
    path = st.simulate(slider, "20 ms", sample_rate="1 kHz").save(tmp_path / "a.nc")
    with h5py.File(path, "r+") as file:
        change(file)
    fuzz.reseal(path)
    with pytest.raises(st.ResultError, match=said):
        st.analyse(path)


def test_a_calendar_is_none_of_a_run(slider, tmp_path):
    """Times are seconds, whatever an attribute makes of them."""
    path = st.simulate(slider, "20 ms", sample_rate="1 kHz").save(tmp_path / "a.nc")
    with h5py.File(path, "r+") as file:
        file["time"].attrs["units"] = "days since 1900-01-01"
    fuzz.reseal(path)
    assert float(st.load(path).data["time"][-1]) == 0.02


def test_a_store_of_another_format_says_so(tmp_path):
    attributes = {"format": 99, "stiction_version": "9.0"}
    zarr.create_group(tmp_path / "a.zarr", zarr_format=3, attributes=attributes)
    with pytest.raises(st.ResultError, match=r"has format 99; stiction 9.0 wrote it, this is"):
        st.open_study(tmp_path / "a.zarr")


@pytest.mark.parametrize("lost", ["status", "message", "peak_force"])
def test_a_store_without_one_of_its_arrays_is_damaged(lost, tmp_path):
    """A sweep of a store without messages, sealed anew, ended in a KeyError."""
    path = tmp_path / "a.zarr"
    st.sweep(fuzz.STUDY, path)
    rmtree(path / lost)
    seal(path)
    for use in (st.open_study, st.map, lambda path: st.sweep(fuzz.STUDY, path)):
        with pytest.raises(st.ResultError, match="is damaged"):
            use(path)
