"""What `Slider.replace` does not take is told the call that changes it."""

import re

import pytest

import stiction as st

PAPER = st.presets.nakano_popov_2020()
GRAINED = PAPER.replace(friction=st.laws.Anisotropic(PAPER.friction, 1.5, "30 deg"))
PROGRAM = st.protocols.DriveProgram(velocity="1 mm/s", program=[st.protocols.Hold("1 s")])
CALL = re.compile(r"write (slider\.replace\(.*\))$", re.MULTILINE)


@pytest.mark.parametrize("slider", [PAPER, GRAINED, PAPER.replace(drive=PROGRAM)])
@pytest.mark.parametrize(
    ("name", "value"),
    [("mu_0", 0.3), ("v_f", "3 mm/s"), ("V", "2 mm/s"), ("drive.velocity", 2), ("W", "3 N")],
)
def test_the_call_that_a_message_names_makes_the_change(slider, name, value):
    with pytest.raises(st.DescriptionError) as refused:
        slider.replace(**{name: value})
    (call,) = CALL.findall(str(refused.value))
    changed = eval(call, {"st": st, "slider": slider})
    assert changed != slider
    assert changed == st.Slider.from_toml(slider.to_toml(), {name: value})


def test_a_setting_is_one_of_a_run_and_all_faults_come_at_once():
    with pytest.raises(st.DescriptionError) as refused:
        PAPER.replace(duration="5 s", foo=1, mass=-1.0)
    said = str(refused.value)
    assert "is a setting of a run; write st.simulate(slider, ..., duration='5 s')" in said
    assert "unknown key 'foo'" in said
    assert "mass: must be greater than 0" in said


def test_a_law_of_many_values_is_not_written_out():
    values = [0.1 * each for each in range(99)]
    table = PAPER.replace(friction=st.laws.Table(v=values, mu=[0.2] * 99))
    with pytest.raises(st.DescriptionError, match=r"slider\.replace\(friction=\.\.\.\) with v=3"):
        table.replace(v=3)
