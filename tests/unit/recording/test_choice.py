"""An error of the columns of a file names what is to be said of this file."""

from dataclasses import fields

import numpy as np
import pytest

import stiction as st
from stiction.analysis.measurement.reading import ReadArguments
from stiction.cli.options import RecordOptions
from stiction.recording.request import KNOWN, ReadingOptions

NUMBERS = np.arange(50.0)


def table(tmp_path, heads, *columns):
    path = tmp_path / "data.csv"
    np.savetxt(path, np.column_stack(columns), delimiter=";", header=heads, comments="")
    return path


def test_python_and_the_command_line_take_the_same_statements():
    names = {*ReadingOptions.model_fields, *KNOWN}
    assert {*ReadArguments.__annotations__} == names
    assert {each.name for each in fields(RecordOptions)} == names | {"sidecar"}


def test_a_force_over_an_even_displacement_is_told_how_to_get_times(tmp_path):
    path = table(tmp_path, "disp [um];tau [kN]", 0.25 * NUMBERS, NUMBERS % 7)
    said = r"column 1 'disp \[um\]' rises in steps of 0.25 um: .*interval='\? s'"
    with pytest.raises(st.ResultError, match=said) as refused:
        st.read_record(path)
    assert "time='1=ms'" not in str(refused.value)  # it is no time
    record = st.read_record(path, interval="0.25 s", drive_position="1")
    assert "at most <" not in str(record.origin)  # rounding of the displacement is no noise
    assert record.drive_velocity is None
    assert np.ptp(record.drive_position) / np.ptp(record.time) == pytest.approx(1e-6)


def test_an_uneven_displacement_has_no_interval(tmp_path):
    path = table(tmp_path, "disp [um];tau [kN]", NUMBERS**1.5, NUMBERS % 7)
    with pytest.raises(st.ResultError, match=r"or give interval='\? ms'"):
        st.read_record(path)


def test_a_unit_that_the_heading_states_is_not_asked_for_again(tmp_path):
    path = table(tmp_path, "time [s];Load [lbf]", NUMBERS, NUMBERS % 7)
    with pytest.raises(st.ResultError, match=r"say for example force='2'$"):
        st.read_record(path, force="lbf")
    assert st.read_record(path, force="2").force.max() == pytest.approx(6 * 4.4482216)


def test_a_coefficient_that_is_asked_for_as_a_force_is_told_what_it_needs(tmp_path):
    path = table(tmp_path, "time [s];F/mg [-]", NUMBERS, NUMBERS % 7)
    with pytest.raises(st.ResultError, match=r"leave out force, and say normal_load='\? N'"):
        st.read_record(path, force="mN")
    assert st.read_record(path, normal_load="10 N").force.max() == pytest.approx(60.0)


@pytest.mark.parametrize(
    "head", ["load point [in]", "LPD (mm)", "lp_disp [um]", "Load-point displacement (mm)"]
)
def test_the_load_point_of_rock_mechanics_is_the_drive(tmp_path, head):
    path = table(tmp_path, f"time [s];shear force [kN];{head}", NUMBERS, NUMBERS % 7, NUMBERS)
    assert st.read_record(path).drive_position is not None


@pytest.mark.parametrize("head", ["LVDT (thou)", "shear disp (microns)", "slip (mm)"])
def test_a_displacement_that_may_be_either_is_asked_about(tmp_path, head):
    path = table(tmp_path, f"time [s];shear force [kN];{head}", NUMBERS, NUMBERS % 7, NUMBERS)
    record = st.read_record(path)
    assert record.position is record.drive_position is None
    assert "is it the displacement of the mass (position=3" in str(record.origin)


@pytest.mark.parametrize(
    "heads",
    [
        "temps (s);Force tangentielle (N);Force normale (N)",
        "Temps [s];Effort tangentiel [N];Effort normal [N]",
        "tiempo (s);fuerza de fricción (N);carga (N)",
        "tempo (s);forza tangenziale (N);forza normale (N)",
        "time.s;force.N;load.N",
        "t_s;F_t [N];F_N [N]",
    ],
)
def test_heads_of_other_languages_and_marks_are_understood(tmp_path, heads):
    """ "Force normale" was offered as the force along the drive."""
    path = tmp_path / "data.csv"
    rows = [f"{t:g};{t % 7:g};{10 + t % 3:g}" for t in NUMBERS]
    path.write_text("\n".join([heads, *rows]), "utf-8")
    record = st.read_record(path)
    assert record.force.max() == 6.0
    assert record.load.max() == 12.0
    assert record.duration == NUMBERS[-1]


def test_a_head_that_may_be_a_displacement_in_french_is_asked_about(tmp_path):
    path = table(tmp_path, "temps [s];force [N];deplacement [mm]", NUMBERS, NUMBERS % 7, NUMBERS)
    assert "is it the displacement of the mass (position=3" in str(st.read_record(path).origin)
