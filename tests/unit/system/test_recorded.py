"""Descriptions with recorded tables: files and trust, stored rows, parameters."""

import json
import pickle

import numpy as np
import pytest

import stiction as st
from stiction.errors import DescriptionError
from stiction.system.parameter import change_parameter, change_unchecked, units

TEXT = """
[slider]
mass = "0.25 kg"
k_x = "1 kN/m"
k_y = "10 MN/m"
phi = "1 deg"
normal_load = "10 N"
[friction]
law = "coulomb"
mu_0 = 0.2
[drive]
program = [
    { piece = "recorded", file = "stage.csv", time = "t [ms]" },
    { piece = "hold", duration = "0.1 s" },
]
[load]
program = [{ piece = "recorded", file = "load.dat", scale = 2.0 }]
[run]
"""
SCALE = "drive.program.1.scale"


@pytest.fixture
def config(tmp_path):
    """A description, its tables beside it, and a table in another folder."""
    t = np.linspace(0.0, 1.0, 201)
    position = 1e3 * t + 30 * np.sin(2 * np.pi * 5 * t)
    lines = [f"{1e3 * a:.6f};{b:.6f}" for a, b in zip(t, position, strict=True)]
    home = tmp_path / "home"
    home.mkdir()
    for folder in (home, tmp_path):
        (folder / "stage.csv").write_text("t;position (um)\n" + "\n".join(lines), "utf-8")
    np.savetxt(home / "load.dat", np.c_[t, 5 + np.sin(9 * t)], header="time [s] load [N]")
    (home / "a.toml").write_text(TEXT, "utf-8")
    return home / "a.toml"


def faults(read, *arguments):
    with pytest.raises(DescriptionError) as error:
        read(*arguments)
    return {fault.path: fault.message for fault in error.value.faults}


def test_the_duration_is_that_of_the_programs(config):
    made = st.Description.from_toml(config)
    assert made.run.duration == pytest.approx(1.1)
    assert made.slider.weight(0.0) == pytest.approx(10.0)
    assert st.Slider.from_toml(config) == made.slider


def test_what_is_stored_holds_its_rows(config, tmp_path):
    made = st.Description.from_toml(config)
    run = st.run(made._replace(run=st.Settings(duration="0.05 s", sample_rate="1 kHz")))
    path = run.save(tmp_path / "run.nc") or tmp_path / "run.nc"
    (config.parent / "stage.csv").unlink()
    again = st.run(st.load(path).description)
    assert np.array_equal(again.data["u_x"], run.data["u_x"])
    for copy in (
        st.Description.from_toml(made.to_toml()),
        st.Description.from_json(made.to_json()),
        pickle.loads(pickle.dumps(made)),
    ):
        assert copy == made
    assert "201\N{NO-BREAK SPACE}values" in made.slider._repr_html_()


def test_changed_rows_are_refused(config):
    raw = st.Description.from_toml(config).to_dict()
    raw["drive"]["program"][0]["time"][3] += 1e-6
    found = faults(st.Description.from_dict, raw)
    assert "they have changed" in found["drive.program.1.checksum"]


def test_what_is_stored_reads_no_file(config, monkeypatch):
    monkeypatch.chdir(config.parent)
    raw = st.Description.from_toml(config).to_dict()
    for column in ("time", "position"):
        del raw["drive"]["program"][0][column]
    found = faults(st.Description.from_json, json.dumps(raw))
    assert "not stored here" in found["drive.program.1.file"]


def test_a_file_outside_the_folder_must_be_trusted(config):
    changes = {"drive.program.1.file": "../stage.csv"}
    found = faults(st.Description.from_toml, config, changes)
    assert [*found] == ["drive.program.1.file"]
    assert "lies outside" in found["drive.program.1.file"]
    made = st.Description.from_toml(config, changes, trust=True)
    here, there = (
        each.program[0] for each in (made.slider.drive, st.Slider.from_toml(config).drive)
    )
    assert here == there._replace(file="../stage.csv")


def test_a_link_out_of_the_folder_must_be_trusted(config):
    (config.parent / "link.csv").symlink_to(config.parents[1] / "stage.csv")
    found = faults(st.Description.from_toml, config, {"drive.program.1.file": "link.csv"})
    assert "lies outside" in found["drive.program.1.file"]


def test_all_faults_at_once(config):
    changes = {"drive.program.1.file": "no.csv", "load.program.1.load": "force", "run.rtol": 5}
    found = faults(st.Description.from_toml, config, changes)
    assert {*found} == {"drive.program.1.file", "load.program.1.load", "run.rtol"}


def test_the_scale_is_a_parameter(config):
    """Also where the slider's stretches are known already: none may be left over."""
    slider = st.Slider.from_toml(config)
    before = slider.motion.rate(0.5)[0]
    assert units(slider)[SCALE] == ""
    for change in (change_parameter, change_unchecked):
        assert change(slider, SCALE, 3.0).motion.rate(0.5)[0] == pytest.approx(3 * before)
    changed = st.Slider.from_toml(config, {SCALE: 3.0})
    assert changed.motion.rate(0.5)[0] == pytest.approx(3 * before)
