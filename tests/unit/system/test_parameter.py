"""One parameter by its path: read, changed with units, and quickly."""

import math

import pytest
from tests.drawn import all_over

import stiction as st
from stiction.system.parameter import (
    change_parameter,
    change_parameters,
    change_unchecked,
    read,
    unit,
    units,
)

PAPER = st.presets.nakano_popov_2020()
GRAIN = PAPER.replace(friction=st.laws.Anisotropic(PAPER.law, 1.2, "30 deg"))
PROGRAM = PAPER.replace(
    drive=st.protocols.DriveProgram(velocity=2e-3, program=[st.protocols.Constant()])
)


@pytest.mark.parametrize("slider", [PAPER, GRAIN, PROGRAM], ids=["plain", "anisotropic", "program"])
def test_every_parameter_can_be_read_and_changed(slider):
    for path, its_unit in units(slider).items():
        value = read(slider, path)
        other = 0.8 * value or 0.5  # nothing is zero that may not be 0.5
        new = change_parameter(slider, path, f"{other!r} rad" if its_unit == "rad" else other)
        assert read(new, path) == pytest.approx(other, rel=1e-15)
        assert new == change_unchecked(slider, path, read(new, path))
        rest = [each for each in units(slider) if each != path]
        assert [read(new, each) for each in rest] == [read(slider, each) for each in rest]


def test_values_are_read_with_units_and_checked():
    assert change_parameter(PAPER, "phi", "3 deg").phi == pytest.approx(
        math.radians(3.0), rel=1e-15
    )
    assert change_parameter(PAPER, "drive.velocity", "5 mm/s").drive.velocity == 5e-3
    assert unit(PAPER, "phi") == "rad"
    assert unit(PAPER, "friction.mu_inf") == ""
    with pytest.raises(st.DescriptionError, match="degree or radian"):
        change_parameter(PAPER, "phi", 0.1)
    with pytest.raises(st.DescriptionError, match="greater than 0, is -1"):
        change_parameter(PAPER, "mass", -1.0)
    with pytest.raises(st.DescriptionError, match="between -90 deg and 90 deg"):
        change_parameter(PAPER, "phi", "91 deg")


def test_faults_name_the_changed_parameters_and_come_together():
    start = st.Description(st.presets.nakano_popov_2020(), st.Initial(), st.Settings(duration=1.0))
    wrong = {
        "friction.mu_0": -1.0,
        "V": "3 N",
        "phi": "100 deg",
        "run.rtol": 5.0,
        "initial.u_x": "3 N",
    }
    with pytest.raises(st.DescriptionError) as error:
        change_parameters(start, wrong)
    paths = [fault.path for fault in error.value.faults]
    assert paths == ["friction.mu_0", "drive.velocity", "phi", "run.rtol", "initial.u_x"]


def test_an_unknown_parameter_is_answered_with_the_nearest():
    with pytest.raises(st.DescriptionError, match=r"did you mean 'drive\.velocity'"):
        read(PAPER, "drive.velocty")
    with pytest.raises(st.DescriptionError, match=r"did you mean 'friction\.v_f'"):
        change_parameter(PAPER, "friction.vf", 1.0)
    with pytest.raises(st.DescriptionError, match=r"did you mean 'friction\.mu_0'"):
        read(PAPER, "mu_0")


def test_several_parameters_with_one_value():
    stiff = change_parameter(PAPER, "k_x, k_y", "2 kN/m")
    assert (stiff.k_x, stiff.k_y, read(stiff, "k_x, k_y")) == (2e3, 2e3, 2e3)
    with pytest.raises(st.DescriptionError, match="k_x is 1000, k_y is 1e"):
        read(PAPER, "k_x, k_y")
    with pytest.raises(st.DescriptionError, match="cannot share one value"):
        change_parameter(PAPER, "mass, k_y", 1.0)


def test_the_held_law_of_an_anisotropic_one():
    new = change_parameter(GRAIN, "friction.mu_inf", 0.12)
    assert new.law.law.mu_inf == 0.12
    assert new.law.ratio == 1.2
    assert (
        read(change_parameter(GRAIN, "friction.angle", "45 deg"), "friction.angle") == math.pi / 4
    )


@pytest.mark.parametrize("value", [value for (value,) in all_over(20, (1e-6, 1e6))])
def test_what_is_put_in_comes_out(value):
    for path in ("mass", "k_x, k_y", "drive.velocity", "friction.v_f"):
        assert read(change_unchecked(PAPER, path, value), path) == value
