"""Friction tests by name: what the drive and the load do."""

import numpy as np
import pytest

import stiction as st

p = st.protocols


def test_velocity_steps_of_equal_distance():
    program = p.velocity_steps(["1 um/s", "10 um/s", "2 um/s"], distance="20 um")
    assert p.end(program) == pytest.approx(32.0)
    assert program.rate(np.array([1.0, 21.0, 31.0]))[0] == pytest.approx([1e-6, 1e-5, 2e-6])
    assert program.travel(0.0, 32.0)[0] == pytest.approx(60e-6)


def test_holds_between_slides():
    program = p.slide_hold_slide("10 um/s", [1, "100 s"], slide=20)
    assert p.end(program) == 161.0
    at = program.rate(np.array([10.0, 20.5, 30.0, 100.0, 150.0]))[0]
    assert at == pytest.approx([1e-5, 0.0, 1e-5, 0.0, 1e-5])


def test_reversals_come_back():
    program = p.reversal_loops("1 mm/s", "4 mm", loops=2)
    assert p.end(program) == pytest.approx(18.0)
    turns = [float(program.travel(0.0, t)[0]) for t in (2.0, 6.0, 10.0, 14.0, 18.0)]
    assert turns == pytest.approx([2e-3, -2e-3, 2e-3, -2e-3, 2e-3])


def test_a_load_ramp_holds_each_level():
    slider = st.presets.nakano_popov_2020().replace(
        load=p.load_ramp(["20 N", "5 N"], ramp="1 s", hold="2 s")
    )
    assert p.end(slider.motion, slider.load) == 6.0
    assert slider.weight(np.array([0.5, 2.0, 3.5, 5.0])) == pytest.approx([15.0, 20.0, 12.5, 5.0])


def test_a_yaw_sweep_is_a_study_over_phi():
    study = p.yaw_sweep(st.presets.yaw_angle_brake(), ["1 deg", "5 deg"])
    assert study.layout.dims == ("phi",)
    assert {"mean_force", "peak_force", "amplitude"} <= {*study.measures}


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: p.velocity_steps(5, distance="1 mm"), "5 must be a list of at least one value"),
        (lambda: p.velocity_steps(["1 um/s"]), "either the duration or the distance"),
        (lambda: p.velocity_steps(["1 um/s", 0.0], distance="1 mm"), "covers no distance"),
        (lambda: p.velocity_steps("1 um/s", duration=1), "must be a list"),
        (lambda: p.slide_hold_slide("1 um/s", ["1 m"], slide=1), "not a unit of a time"),
        (lambda: p.slide_hold_slide("1 um/s", [1], slide=0), "must be greater than 0"),
        (lambda: p.reversal_loops("1 mm/s", "1 mm", loops=0), "at least 1, is 0"),
        (lambda: p.Step(), "give either by or to"),
        (lambda: p.Step(1.0, to=2.0), "give either by or to"),
    ],
)
def test_a_fault_names_the_remedy(call, words):
    with pytest.raises(st.DescriptionError, match=words):
        call()


def test_all_faults_of_a_procedure_come_at_once():
    """The first one hid the others."""
    with pytest.raises(st.DescriptionError) as refused:
        p.slide_hold_slide("-1 kg", ["1 s", "-1 s", "3 m"], slide=0)
    assert [each.path for each in refused.value.faults] == [
        "velocity",
        "slide",
        "holds.2",
        "holds.3",
    ]
    with pytest.raises(st.DescriptionError) as refused:
        p.load_ramp("20 N", ramp="-1 s", hold="1 m")
    assert [each.path for each in refused.value.faults] == ["levels", "ramp", "hold"]


def test_a_step_to_a_value_is_one_by_the_difference():
    by = p.DriveProgram(velocity=1e-3, program=[p.Constant(duration=1), p.Step("2 mm/s")])
    to = p.DriveProgram(velocity=1e-3, program=[p.Constant(duration=1), p.Step(to="3 mm/s")])
    assert to.rate(2.0) == by.rate(2.0)


# --- a duration that the programs know ----------------------------------------------------------

TOML = """
[slider]
mass = 1.0
k_x = 1e3
k_y = 1e3
phi = "0 deg"
normal_load = 10.0
[friction]
law = "coulomb"
mu_0 = 0.2
[drive]
velocity = "1 mm/s"
program = [{ piece = "constant", duration = "1 s" }, { piece = "step", to = "2 mm/s"LAST }]
"""


def test_a_run_lasts_as_long_as_its_program():
    slider = st.presets.nakano_popov_2020()
    program = p.velocity_steps(["1 mm/s", "2 mm/s"], duration="10 ms")
    run = st.simulate(slider.replace(drive=program), sample_rate=1e4)
    assert float(run.final["time"]) == pytest.approx(0.02)
    with pytest.raises(st.DescriptionError, match=r"duration: missing; write for example '5 s'"):
        st.simulate(slider)
    late = st.Initial(time=0.03)
    with pytest.raises(st.DescriptionError, match=r"the programs end at 0\.02 s"):
        st.simulate(slider.replace(drive=program), initial=late)


def test_a_description_s_duration_is_that_of_its_program():
    whole = st.Description.from_toml(TOML.replace("LAST", ', duration = "2 s"'))
    assert whole.run.duration == 3.0
    assert st.Description.from_toml(whole.to_toml()) == whole
    with pytest.raises(st.DescriptionError, match="run"):
        st.Description.from_toml(TOML.replace("LAST", ""))


def test_pieces_of_one_velocity_are_that_velocity():
    """`stability` refused the two as not steady."""
    V = 1e-3
    program = p.DriveProgram(velocity=V, program=[p.Constant(duration="5 s"), p.Constant(V)])
    slider = st.presets.nakano_popov_2020().replace(drive=program)
    assert slider.motion == st.ConstantVelocity(V)
    assert str(st.stability(slider)) == str(st.stability(slider.replace(drive=slider.motion)))
