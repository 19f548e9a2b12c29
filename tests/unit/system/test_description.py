"""Descriptions: reading, refusals, and their messages."""

import copy
import pickle
from math import pi

import pytest

import stiction as st
from stiction.system.parameter import change_unchecked
from stiction.system.writing import parameter_table

TOML = """
[slider]
mass = "0.25 kg"
k_x = "1 kN/m"
k_y = "10 MN/m"
phi = "1 deg"
normal_load = "10 N"

[friction]
law = "exponential-weakening"
mu_0 = 0.20
mu_inf = 0.15
v_f = "10 mm/s"

[drive]
velocity = "1 mm/s"

[initial]
epsilon = 1e-6

[run]
duration = "5 s"
sample_rate = "10 kHz"
rtol = 1e-6
"""


def write_file(path, text=TOML, **changes):
    for old, new in changes.values():
        assert old in text
        text = text.replace(old, new)
    path.write_text(text)
    return path


def faults(path) -> dict[str, str]:
    with pytest.raises(st.DescriptionError) as error:
        st.Description.from_toml(path)
    return {fault.path: fault.message for fault in error.value.faults}


def test_the_contract_s_example_is_the_paper_s_preset(tmp_path, slider):
    description = st.Description.from_toml(write_file(tmp_path / "a.toml"))
    assert description.slider == slider == st.Slider.from_toml(tmp_path / "a.toml")
    assert description.run.duration == 5.0
    assert description.run.sample_rate == 1e4
    assert description.initial.epsilon == 1e-6


def test_units_become_si(slider):
    assert (slider.mass, slider.k_x, slider.k_y, slider.normal_load) == (0.25, 1e3, 1e7, 10.0)
    assert slider.phi == pytest.approx(pi / 180, rel=1e-15)
    assert slider.friction.v_f == pytest.approx(0.01, rel=1e-15)
    assert slider.drive.velocity == pytest.approx(1e-3, rel=1e-15)
    assert slider.replace(phi="0.1 rad").phi == 0.1
    assert slider.F_0 == 2.0


AGEING = st.laws.RateStateAgeing(0.01, 0.015, "1 um", mu_star=0.6, V_star="1 um/s")
SLIDE = st.protocols.Constant("1 mm/s", "1 s")
PROGRAMS = {
    "soft start": [st.protocols.Ramp("1 mm/s", "1 s")],
    "start from rest": [st.protocols.Hold("1 s"), SLIDE],
    "to and fro": [SLIDE, st.protocols.Reversal()],
}


@pytest.mark.parametrize("program", PROGRAMS.values(), ids=list(PROGRAMS))
def test_friction_with_state_is_that_at_the_drive_s_speed(slider, program):
    state = slider.replace(friction=AGEING)
    driven = state.replace(drive=st.protocols.DriveProgram(program=program))
    assert driven.F_0 == state.F_0 == state.law.coefficient(1e-3) * state.normal_load


def test_every_fault_at_once_by_path(tmp_path):
    found = faults(
        write_file(
            tmp_path / "bad.toml",
            mass=('mass = "0.25 kg"', "mass = -1"),
            k_x=('"1 kN/m"', '"1 kN"'),
            k_y=('k_y = "10 MN/m"', 'k_yy = "10 MN/m"'),
            phi=('"1 deg"', "1"),
            law=("v_f = ", "vf = "),
            drive=('velocity = "1 mm/s"', "velocity = true"),
            run=("rtol = 1e-6", "rtol = 2"),
            table=("[initial]", "[inital]"),
        )
    )
    assert "greater than 0" in found["slider.mass"]
    assert "-1" in found["slider.mass"]
    assert "'1 kN/m'" in found["slider.k_x"]  # what to write instead
    assert "missing" in found["slider.k_y"]
    assert "did you mean 'k_y'" in found["slider.k_yy"]
    assert "degree or radian" in found["slider.phi"]
    assert "did you mean 'v_f'" in found["friction.vf"]
    assert "velocity" in found["drive.velocity"]
    assert "0.01" in found["run.rtol"]
    assert "did you mean 'initial'" in found["inital"]


@pytest.mark.parametrize(
    ("old", "new", "path", "words"),
    [
        ('"exponential-weakening"', '"exponential-weakning"', "friction.law", "did you mean"),
        ('"exponential-weakening"', '"exponential"', "friction.law", "'exponential-weakening'?"),
        ('"exponential-weakening"', '"lugre-"', "friction.law", "mean 'lugre-hyperbolic'?"),
        ('[drive]\nvelocity = "1 mm/s"', "", "drive", "write a table [drive]"),
        ("[friction]", "[slider.friction]", "slider.friction", "of its own; write [friction]"),
        ("[drive]", "[friction.drive]", "friction.drive", "of its own; write [drive]"),
        ('phi = "1 deg"', 'phi = "100 deg"', "slider.phi", "between -90 deg and 90 deg"),
        ('phi = "1 deg"', 'phi = "1"', "slider.phi", "no unit"),
        ('mass = "0.25 kg"', 'mass = "nan kg"', "slider.mass", "not finite"),
        ('mass = "0.25 kg"', 'mass = "a {lot}"', "slider.mass", "not one number"),
        ('mass = "0.25 kg"', "mass = [1]", "slider.mass", "not a mass"),
        ('mass = "0.25 kg"', 'mass = "0,25 kg"', "slider.mass", "decimal sign is a point"),
        ('phi = "1 deg"', 'phi = "0,5 deg"', "slider.phi", "decimal sign is a point"),
        ('phi = "1 deg"', 'phi = "1 deg 30 arcmin"', "slider.phi", "not one number"),
        ('k_x = "1 kN/m"', 'k_x = "2*3 N/m"', "slider.k_x", "not one number"),
        ('k_x = "1 kN/m"', 'k_x = "1 Kn/m"', "slider.k_x", "capitals matter"),
        ('velocity = "1 mm/s"', 'velocity = "1 mm"', "drive.velocity", "'1 mm/s'"),
        ("epsilon = 1e-6", "v_x = 1", "initial", "v_x and v_y go together"),
        ('duration = "5 s"', 'duration = "0 s"', "run.duration", "greater than 0"),
        ("rtol = 1e-6", "multiscale = 1", "run.multiscale", "must be 'auto', True or False, is 1"),
    ],
)
def test_a_fault_says_what_to_write(tmp_path, old, new, path, words):
    found = faults(write_file(tmp_path / "bad.toml", change=(old, new)))
    assert list(found) == [path]
    assert words in found[path]


def test_a_wrong_value_beside_an_unknown_key_is_told_once(tmp_path):
    """It is read a second time, without the key."""
    law = {"law": ("v_f =", "colour = 3\nv_f = -1.0 #")}
    with pytest.raises(st.DescriptionError) as error:
        st.Slider.from_toml(write_file(tmp_path / "rig.toml", **law))
    assert sorted(fault.path for fault in error.value.faults) == ["friction.colour", "friction.v_f"]


def test_values_are_compared_beside_an_unknown_key(tmp_path):
    """They were not: a fault between two of them came only after the key was gone."""
    law = {"law": ("v_f =", "colour = 3\nmu_static = 0.1\nv_f =")}
    springs = 'springs = [{name = "cell", k_x = "2 kN/m", k_y = "9 MN/m"}]'
    rig = {"rig": ("mass =", f"colour = 3\n{springs}\nmass =")}
    with pytest.raises(st.DescriptionError) as error:
        st.Slider.from_toml(write_file(tmp_path / "rig.toml", **law, **rig))
    paths = [fault.path for fault in error.value.faults]
    assert sorted(paths) == [  # each once
        "friction.colour", "friction.mu_static", "slider.colour", "slider.k_x", "slider.k_y",
    ]  # fmt: skip


def test_unreadable_files(tmp_path):
    assert "No such file" in str(*faults(tmp_path / "none.toml").values())
    assert "not TOML" in str(*faults(write_file(tmp_path / "x.toml", "mass = 0.25 kg")).values())
    for wrong, remedy in (
        ("0,25", "the decimal sign is a point"),
        ("-0,25", "the decimal sign is a point"),
        (".25", "a digit stands before the point"),
        ("1.e3", "a digit stands after the point"),
        ("25.", "a digit stands after the point"),
        ("0.25 kg", "goes in quotes"),
    ):
        text = f"[slider]\nmass = {wrong}\nk_x = 1.0\n"
        assert remedy in str(*faults(write_file(tmp_path / "x.toml", text)).values())
    (tmp_path / "y.toml").write_bytes(b"\xff\xfe\x00")
    assert "UTF-8" in str(*faults(tmp_path / "y.toml").values())


def test_a_byte_order_mark_is_no_fault(tmp_path):
    path = write_file(tmp_path / "bom.toml")
    path.write_text("\ufeff" + path.read_text(), encoding="utf-8")
    assert st.Slider.from_toml(path).mass == 0.25


def test_python_reports_every_fault_too():
    with pytest.raises(st.DescriptionError) as error:
        st.Slider(mass="0.25 m", k_x=1, k_y=1, phi=1, normal_load=0, friction=3)
    assert [fault.path for fault in error.value.faults] == [
        "Slider.mass",
        "Slider.phi",
        "Slider.normal_load",
        "Slider.friction",
    ]
    with pytest.raises(st.DescriptionError, match=r"Coulomb\.mu_0: must not be below 0"):
        st.Coulomb(mu_0=-0.1)
    with pytest.raises(st.DescriptionError, match="is not a Slider"):
        st.simulate(3.0, 1.0)
    with pytest.raises(st.DescriptionError, match=r"^my\.toml: No such file"):
        st.simulate("my.toml", 1.0)
    with pytest.raises(st.DescriptionError, match=r"^sample_rate: "):
        st.simulate(st.presets.nakano_popov_2020(), 1.0, sample_rate="10 m")


def test_round_trip_and_pickle(tmp_path):
    description = st.Description.from_toml(write_file(tmp_path / "a.toml"))
    assert st.Description.from_json(description.to_json()) == description
    assert pickle.loads(pickle.dumps(description)) == description


def test_of_another_thing_in_place_of_a_part_it_is_told_what_to_make():
    """It was "Input should be a valid dictionary or instance of Slider"."""
    with pytest.raises(st.DescriptionError) as error:
        st.Description(3, 4, None)
    assert str(error.value).splitlines() == [
        "Description.slider: 3 is not a Slider; make one with st.Slider(...)",
        "Description.initial: 4 is not an Initial; make one with st.Initial(...)",
        "Description.run: None is not a Settings; make one with st.Settings(...)",
    ]
    with pytest.raises(st.DescriptionError, match=r"Record\.sensors: must be a dict, is 3"):
        st.Record(time=[0.0], force=[0.0], sensors=3)


def test_a_slider_is_frozen(slider):
    with pytest.raises(st.DescriptionError, match=r"frozen; write slider.replace\(mass=1.0\)"):
        slider.mass = 1.0


@pytest.mark.parametrize(
    "value", [st.laws.Anisotropic(st.Coulomb(0.2), 2.0, "10 deg"), st.ConstantVelocity("1 mm/s")]
)
def test_what_was_read_with_units_is_copied_as_it_is(value):
    assert pickle.loads(pickle.dumps(value)) == copy.deepcopy(value) == value


def test_a_notebook_shows_each_piece_of_a_long_program_and_how_many_numbers_a_long_list_has():
    pieces = [{"piece": "hold", "duration": f"{k} s"} for k in range(1, 102)]
    table = parameter_table({"drive": {"program": pieces, "time": [0.5] * 101, "v": [0.5] * 100}})
    program, time, v = (value for _, value in table.rows)
    assert program.count("hold") == 101
    assert (time, v.count("0.5")) == ("101 values", 100)


PIECES = '[{ piece = "constant", value = "1 mm/s", duration = "5 s" }, { piece = "hold"%s }]'


@pytest.mark.parametrize(
    ("drive", "load", "paths"),
    [
        (PIECES % ', duration = "x"', None, ["drive.program.2.duration"]),
        (PIECES % ', value = "x"', None, ["drive.program.2.value"]),
        (PIECES % "", '[{ piece = "step", to = "x" }]', ["load.program.1.to"]),
        (PIECES % "", None, ["run.duration"]),
    ],
)
def test_a_duration_is_missing_only_where_no_program_tells_it(drive, load, paths):
    text = TOML.replace('duration = "5 s"', "").replace('velocity = "1 mm/s"', f"program = {drive}")
    more = f"\n[load]\nprogram = {load}\n" if load else ""
    with pytest.raises(st.DescriptionError) as found:
        st.Description.from_toml(text + more)
    assert [fault.path for fault in found.value.faults] == paths


def test_a_slider_becomes_the_description_that_simulate_runs():
    slider = st.presets.nakano_popov_2020()
    start = st.Initial(u_x="1 mm")
    made = st.Description.of(slider, "20 ms", initial=start, rtol=1e-4, sample_rate="1 kHz")
    settings = st.Settings(duration=0.02, rtol=1e-4, sample_rate=1e3)
    assert made == st.Description(slider, start, settings)
    run = st.simulate(slider, "20 ms", initial=start, rtol=1e-4, sample_rate="1 kHz")
    assert run.description == made
    assert st.run(made) == run


def test_without_a_duration_it_ends_with_its_program():
    p = st.protocols
    pieces = [p.Constant(duration="1 s"), p.Hold("2 s")]
    drive = p.DriveProgram(velocity="1 mm/s", program=pieces)
    slider = st.presets.nakano_popov_2020().replace(drive=drive)
    assert st.Description.of(slider, initial=st.Initial(time="0.5 s")).run.duration == 2.5
    with pytest.raises(st.DescriptionError, match=r"^duration: missing; write for example '5 s'"):
        st.Description.of(st.presets.nakano_popov_2020())


def test_all_faults_of_its_arguments_are_told_at_once():
    with pytest.raises(st.DescriptionError) as caught:
        st.Description.of("slider.toml", initial=5, rtol=2.0, sampl_rate="1 kHz")
    told = [fault.path for fault in caught.value.faults]
    assert told == ["slider", "initial", "rtol", "sampl_rate"]


def test_a_slider_that_was_changed_without_a_check_is_replaced_like_others():
    """As where parameters are drawn: its angles are plain numbers."""
    slider = change_unchecked(st.presets.nakano_popov_2020(), "phi", 0.1)
    assert slider.replace(mass="1 kg") == slider.replace(mass="1 kg", phi="0.1 rad")
