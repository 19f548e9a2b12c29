"""A drive's velocity is one number wherever it is asked for, however its program is written."""

import numpy as np
import pytest
from benchmarks.explore.draw import Draw
from tests.drawn import SEED

import stiction as st
from stiction.drive.program import nominal_velocity
from stiction.study.variables.measures import MEASURES
from stiction.study.variables.observed_run import observe_run
from stiction.system.parameter import change_parameter

p = st.protocols


def ways(V):
    """Drives that all go at V from the beginning to the end."""
    return [
        p.DriveProgram(velocity=V),
        p.DriveProgram(program=[p.Constant(V)]),
        p.DriveProgram(velocity=0.3 * V, program=[p.Constant(V)]),
        p.DriveProgram(velocity=-V, program=[p.Reversal()]),
    ]


@pytest.mark.parametrize("number", range(3))
def test_a_program_of_one_velocity_is_that_velocity(number):
    """It was the base of the program: measures were three times as large, regimes were others."""
    draw = Draw(SEED, number)
    V = draw.decades(1e-3, 5e-3)
    rig = st.presets.nakano_popov_2020().replace(
        phi=f"{draw.between(1.0, 80.0)} deg",
        k_y=draw.decades(1e5, 1e7),
        drive=st.ConstantVelocity(V),
    )

    def measures(slider):
        found = observe_run(st.Description(slider, st.Initial(), st.Settings(duration="2 s")), None)
        return {name: each.of(found) for name, each in MEASURES.items()}

    wanted, stable = measures(rig), str(st.stability(rig))
    for drive in ways(V):
        slider = rig.replace(drive=drive)
        assert slider.motion == rig.motion
        np.testing.assert_equal(measures(slider), wanted)
        assert str(st.stability(slider)) == stable


@pytest.mark.parametrize(
    ("drive", "V"),
    [
        (p.DriveProgram(program=[p.Ramp("3 mm/s", "1 s")]), 3e-3),
        (p.DriveProgram(velocity="1 mm/s", program=[p.Ramp("3 mm/s", "1 s")]), 3e-3),
        (p.DriveProgram(program=[p.Hold("1 s"), p.Constant("3 mm/s")]), 3e-3),
        (p.DriveProgram(program=[p.Constant("-3 mm/s", "1 s"), p.Constant("-5 mm/s")]), -5e-3),
        (p.DriveProgram(program=[p.Constant("3 mm/s", "1 s"), p.Constant("-3 mm/s")]), 0.0),
        (p.velocity_steps(["1 mm/s", "3 mm/s"], duration="2 s"), 1e-3),
        (p.reversal_loops("1 mm/s", "2 mm"), 1e-3),
        (p.slide_hold_slide("1 mm/s", ["1 s"], slide="2 s"), 1e-3),
        (p.DriveProgram(velocity="3 mm/s", along=p.Modulation("1 mm/s", "10 Hz")), 3e-3),
    ],
)
def test_the_velocity_that_others_vary_from(drive, V):
    assert nominal_velocity(drive) == V


def test_a_base_velocity_that_nothing_takes_is_not_changed(tmp_path, capsys):
    slider = st.presets.nakano_popov_2020().replace(
        drive=p.DriveProgram(velocity="1 mm/s", program=[p.Constant("3 mm/s")])
    )
    with pytest.raises(st.DescriptionError, match=r"drive\.velocity: changes nothing"):
        change_parameter(slider, "V", "2 mm/s")
    taken = slider.replace(drive=p.DriveProgram(velocity="1 mm/s", program=[p.Hold("1 s")]))
    with pytest.raises(st.DescriptionError, match=r"drive\.velocity: changes nothing"):
        change_parameter(taken, "drive.velocity", "2 mm/s")
    taken = slider.replace(drive=p.velocity_steps(["1 mm/s", "3 mm/s"], duration="2 s"))
    assert change_parameter(taken, "V", "2 mm/s").drive.velocity == 2e-3
    file = tmp_path / "a.toml"
    file.write_text(st.Description(slider, st.Initial(), st.Settings(duration="2 s")).to_toml())
    assert st.Description.from_toml(file).slider == slider
    with pytest.raises(st.DescriptionError, match="changes nothing"):
        st.Description.from_toml(file, {"V": "2 mm/s"})
