from math import cos, hypot, radians

import numpy as np
import pytest
from tests.rigs import MICROSCOPE, TURNED_A_LOT

import stiction as st
from stiction.analysis.measurement.run_record import record_of
from stiction.auditing.prediction import predict
from stiction.auditing.simulated_test import SimulatedTest, coarse_rate, simulate_test
from stiction.auditing.words.load_cell import _largest, _readings, _sliding, largest_force
from stiction.auditing.words.numbers import apparent_stiffness, loading, peak
from stiction.auditing.words.verdict import describe_motion
from stiction.linear_stability import growth_rate

PAPER = st.presets.nakano_popov_2020()


def friction_test(slider: st.Slider) -> SimulatedTest:
    p = predict(slider)
    return simulate_test(slider, p, growth_rate(slider), sample_rate=coarse_rate(p))


def test_a_mass_that_rests_under_an_oblique_force_has_a_larger_friction_than_the_cell_reads():
    """When a rest ends both springs carry mu_0 W: what the cell reads is the part of one."""
    test = friction_test(MICROSCOPE)
    friction, _, at = largest_force(test)
    samples = test.run.samples
    springs = hypot(samples["spring_x"][at], samples["spring_y"][at]) / MICROSCOPE.normal_load
    assert friction.coefficient == 0.5
    assert springs == pytest.approx(0.5, rel=1e-3)  # SAME, by which the sample lies before the slip
    assert friction.read == pytest.approx(peak(test), rel=2e-3)
    assert friction.across == pytest.approx(abs(samples["spring_y"][at]), rel=2e-3)
    off, why = _largest(test)
    assert "reads 0.3228 of the normal load, where the true coefficient is 0.5" in off
    assert off.endswith(f"multiply by {0.5 / peak(test):.4g}.")
    assert "49.7" in why
    assert "measures only the part along it, 0.645" in why
    assert "the spring across carries the rest, 7.6" in why
    assert _sliding(test) == []


@pytest.mark.parametrize("velocity", [1e-3, -1e-3])
def test_steady_sliding_far_off_the_soft_axis_is_read_as_the_cosine_of_the_angle(velocity):
    test = friction_test(TURNED_A_LOT.replace(drive=st.ConstantVelocity(velocity)))
    mu = TURNED_A_LOT.friction.coefficient(1e-3)
    assert peak(test) == pytest.approx(mu * cos(radians(40.0)), rel=1e-3)
    off, why = _sliding(test)
    assert f"where the true coefficient is {mu:.4g}: multiply by 1.30" in off
    assert "0.1842 at most" in off
    assert "0.766 of friction" in why
    assert _largest(test) == []  # it is that of sliding, and said once


def test_a_load_cell_along_the_drive_reads_steady_sliding_as_it_is():
    test = friction_test(TURNED_A_LOT.replace(cell_angle="0 deg"))
    assert _sliding(test) == []
    (said,) = _largest(test)  # the start: a mass that overshoots the friction of its first rest
    assert "friction in the swing before is 0.25 at most" in said
    assert "inertia of the mass" in said


def test_a_load_cell_across_the_drive_reads_nothing_of_sliding():
    """Its axis at a right angle to within rounding: no stiffness along it, and no factor."""
    slider = TURNED_A_LOT.replace(cell_angle="90 deg")
    off, why = _sliding(friction_test(slider))
    assert "multiply" not in off
    assert "of friction" not in why
    assert "the springs carry the rest across it, 1.44" in why
    assert record_of(st.simulate(slider, "1 ms", sample_rate="20 kHz")).stiffness is None


def test_a_cell_that_is_unloaded_while_the_springs_are_loaded_has_no_stiffness():
    """It lies between the drive and the stiff spring, on its other side."""
    record = record_of(
        st.simulate(TURNED_A_LOT.replace(cell_angle="-60 deg"), "1 ms", sample_rate="20 kHz")
    )
    assert record.stiffness is None
    assert record.force.min() < 0.0


def test_a_reading_that_is_right_is_said_to_be():
    (said,) = _largest(friction_test(PAPER))
    assert said.startswith("The largest force shows the friction of the surfaces to within 2 %")


def test_a_mass_that_vibrates_overshoots_friction():
    (said,) = _largest(friction_test(PAPER.replace(drive=st.ConstantVelocity("30 mm/s"))))
    assert "it is 0.22" in said
    assert "inertia of the mass, which overshoots" in said


def test_static_friction_above_kinetic_is_not_what_the_cell_reads():
    """Each rest ends with friction across: the force along the drive never holds mu_static W."""
    law = st.Coulomb(mu_0=0.45, mu_static=0.6)
    rig = {"mass": "150 g", "k_x": "1.2 kN/m", "k_y": "3 MN/m", "normal_load": "8 N"}
    slider = st.Slider(**rig, phi="1 deg", friction=law, drive=st.ConstantVelocity("1 mm/s"))
    off, _ = _largest(friction_test(slider))
    assert "where the true coefficient is 0.6: multiply by 1.3" in off


def test_largest_force_and_means_are_told_apart():
    test = friction_test(MICROSCOPE)
    said = _readings(test)
    assert "largest force of the whole test" in said
    assert f"means over {test.cycles.sizes['cycle']} cycles" in said
    assert peak(test) > 1.005 * float(np.mean(test.cycles["mu_static"]))
    calm = _readings(friction_test(PAPER.replace(phi="10 deg")))
    assert "cycles" not in calm


def test_a_test_that_ended_before_the_spring_was_loaded_reads_nothing():
    test = friction_test(PAPER)
    none = test.record.model_copy(update={"force": np.zeros(len(test.record))})
    vars(test)["record"] = none  # in place of that of the run
    assert _largest(test) == []


@pytest.mark.parametrize(
    "change",
    [
        {"phi": "90 deg"},
        {"phi": "-90 deg", "friction": st.laws.Anisotropic(PAPER.friction, 1.5, "90 deg")},
        {"phi": "0 deg", "cell_angle": "90 deg"},
    ],
)
@pytest.mark.parametrize("multiscale", [False, True])
def test_a_load_cell_across_the_springs_force_reads_nothing_and_is_said_to(change, multiscale):
    """In place of cycles of the rounding of cos 90 deg, 52 zN, that looked like stick-slip."""
    slider = PAPER.replace(**change)
    run = st.simulate(slider, "0.2 s", sample_rate="5 kHz", multiscale=multiscale)
    test = SimulatedTest(run)
    said = "stands across the force of the springs and measures nothing of it; cell_angle = '0 deg'"
    assert not test.record.force.any()
    assert describe_motion(test).startswith(f"nothing: it {said}")
    warning = st.analyse(run).warnings[0]
    assert said in warning
    along = slider.replace(cell_angle="0 deg")
    assert record_of(st.simulate(along, "3 s", sample_rate="100 Hz")).force.max() > 1.5


@pytest.mark.parametrize(
    ("phi", "ratio", "cell"),
    [
        (88.0, 1.05, None),
        (54.6, 1.64, None),
        (69.3, 0.94, 51.0),
        (5.2, 1.33, None),
        (80.0, 100.0, 0),
    ],
)
def test_theory_of_the_largest_force_is_that_on_the_load_cell(phi, ratio, cell):
    """Not along the drive: at 89 deg that is 0.35, where the cell along x reads 0.0034."""
    slider = PAPER.replace(
        phi=f"{phi} deg", k_y=ratio * 1e3, cell_angle=None if cell is None else f"{cell} deg"
    )
    test = friction_test(slider)
    assert predict(slider).mu_static == pytest.approx(peak(test), rel=0.05)


@pytest.mark.parametrize(("phi", "cell"), [(10.0, 20.0), (30.0, 0.0), (60.0, -15.0)])
def test_both_springs_load_a_cell_askew_where_the_first_stick_ends_in_a_slip(phi, cell):
    """At 60 deg the soft spring alone has 366 N/m of the 1190 N/m that the test shows."""
    slider = PAPER.replace(phi=f"{phi} deg", k_y="1.3 kN/m", cell_angle=f"{cell} deg")
    assert loading(friction_test(slider)) == pytest.approx(apparent_stiffness(slider), rel=1e-6)
