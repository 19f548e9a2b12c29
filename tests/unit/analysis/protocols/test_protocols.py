"""Analyses of friction tests by name, against closed forms on stiff rigs.

Quasi-static: m V^2 is 1e-12 of a W D_c, and springs are 1e5 times as stiff as the critical one, so
that rate and state gives its limits to some 1e-4.
"""

from math import log, log10

import numpy as np
import pytest
from tests.drawn import inside

import stiction as st
from stiction.presets.preset import on_a_line

A, B, D, V = 0.01, 0.015, 10e-6, 10e-6
STIFF = 1e5 * (B - A) / D
AGEING = st.laws.RateStateAgeing(A, B, D, 0.6, V)
SLIP = st.laws.RateStateSlip(A, B, D, 0.6, V)


def steadily_run(law, program, k=STIFF, rate=200.0):
    """Run a program on a rig of a stiffness that begins with steady sliding."""
    start = law.coefficient(abs(program.rate(0.0)[0]))
    slider = on_a_line(
        mass=1e-12 * A * D / V**2, k_x=k, friction=law, drive=program, driven="spring"
    )
    initial = st.Initial(u_x=start / k, v_x=0.0, v_y=0.0)
    return st.simulate(slider, initial=initial, sample_rate=rate, rtol=1e-9)


def test_friction_heals_by_b_per_e_fold():
    """The gain is b ln(1 + t V/D_c): the state grows by t while nothing slides."""
    holds = [10.0, 100.0, 1000.0]
    run = steadily_run(AGEING, st.protocols.slide_hold_slide(V, holds, slide=20.0))
    found = st.analysis.healing(run)
    assert found.hold == pytest.approx(holds)
    assert found.steady == pytest.approx(0.6, abs=1e-6)
    assert found.gain == pytest.approx([B * log(1.0 + t * V / D) for t in holds], abs=2e-4)
    line = np.polyfit(np.log10(holds), found.gain, 1)
    assert [found.per_decade, found.at_one_second] == pytest.approx(line)
    assert found.per_decade == pytest.approx(B * log(10.0), rel=0.03)
    # three holds leave one degree of freedom, for which Student's factor is 6.4
    assert 0.0 < found.per_decade_error < 6.4 * 0.01 * found.per_decade
    assert "per decade" in str(found)


@pytest.mark.parametrize(("law", "name"), [(AGEING, "ageing"), (SLIP, "slip")])
def test_velocity_steps_give_back_the_law(law, name):
    program = st.protocols.velocity_steps([V, 10 * V, V], distance="0.2 mm")
    found = st.analysis.velocity_steps(steadily_run(law, program), law=name)
    assert len(found.steps) == 2
    for each in found.steps:
        assert each.a_minus_b == pytest.approx(A - B, abs=1e-6)
        # by the first sample after the jump, at 10 V, it has slid 5 % of D_c, and lost b of that
        assert each.a == pytest.approx(A, rel=0.05 * B / A)
        assert each.b == pytest.approx(B, rel=1e-3)
        assert each.D_c == pytest.approx(D, rel=1e-3)
        assert each.D_c_error < 1e-3 * D
    assert found.stiffness == pytest.approx(STIFF * D / B, rel=1e-2)
    assert "weakens" in str(found)
    assert "not stiff" not in str(found)


def test_a_soft_rig_is_said_to_be_soft():
    program = st.protocols.velocity_steps([V, 2 * V], distance="0.2 mm")
    found = st.analysis.velocity_steps(steadily_run(AGEING, program, k=10 * (B - A) / D))
    assert found.steps[0].a_minus_b == pytest.approx(A - B, abs=1e-6)
    assert "The rig is not stiff, k D_c/(b W) = " in str(found)


def reversed_test():
    """Constant friction of 3 N on a spring of 1 N/mm, between turns 20 mm apart."""
    slider = on_a_line(
        mass=1e-3,
        k_x=1e3,
        c_x=0.5,
        friction=st.Coulomb(0.3),
        normal_load=10.0,
        drive=st.protocols.reversal_loops("1 mm/s", "20 mm", loops=2),
        driven="spring",
    )
    return st.simulate(slider, sample_rate=100.0)


def test_the_friction_of_a_loop_is_no_extreme_of_noise():
    """Half of the span was too high by three standard deviations of the noise."""
    off = []
    for number, (decades, noise) in enumerate(inside(40, (0.4, 1.7), (0.001, 0.05))):
        elastic = 1e-3  # m, of the spring in sliding
        length = 2.0 * elastic * 10.0**decades
        program = st.protocols.reversal_loops(1e-3, length, loops=2)
        time = np.linspace(0.0, st.protocols.end(program), 6000)
        X, slid, force = program.travel(0.0, time)[0], 0.0, []
        for x in X:
            slid = min(max(slid, x - elastic), x + elastic)
            force.append(2.0 * (x - slid) / elastic)
        force += 2.0 * noise * np.random.default_rng(number).standard_normal(len(time))
        record = st.Record(time=time, force=force, normal_load=10.0)
        loop = st.analysis.hysteresis(record, program).loops[-1]
        off.append((loop.friction / 0.2 - 1.0) / noise)
    assert abs(np.median(off)) < 0.05
    assert np.abs(off).max() < 0.5


def test_a_loop_of_constant_friction():
    """Area 2 mu W (L - 2 mu W/k), width L - 2 mu W/k; corners are cut by a sample of 10 um.

    The mass swings on its spring as it starts to slide, by some 1e-4 of the friction.
    """
    found = st.analysis.hysteresis(reversed_test())
    assert len(found.loops) == 2
    for each in found.loops:
        assert each.friction == pytest.approx(0.3, rel=2e-4)
        assert each.width == pytest.approx(14e-3, abs=1e-5)
        assert each.area == pytest.approx(6.0 * 14e-3, abs=6.0 * 1e-5)
    assert "84 mJ" in str(found)
    page = found._repr_html_()
    assert ">84\N{NO-BREAK SPACE}mJ</td>" in page
    assert page.endswith('">')  # of the figure
    assert "<img " in page


LEVELS = st.protocols.load_ramp([20.0, 40.0, 30.0], ramp="0.2 s", hold="1 s")


def loaded_test(load=LEVELS):
    """Constant friction of 0.3 of the load on a damped spring."""
    slider = on_a_line(
        mass=1e-3, k_x=1e3, c_x=5.0, friction=st.Coulomb(0.3), normal_load=10.0, load=load,
        drive=st.ConstantVelocity("50 mm/s"), driven="spring",
    )  # fmt: skip
    return st.simulate(slider, duration=3.6, sample_rate=1e3)


def test_constant_friction_is_proportional_to_the_load():
    run = loaded_test()
    found = st.analysis.load_dependence(run)
    assert found.load == pytest.approx([20.0, 40.0, 30.0], rel=1e-12)
    # 10 time constants of the damper, c/k, in each level
    assert found.force == pytest.approx(0.3 * found.load, rel=1e-6)
    assert (found.coefficient, found.adhesion) == pytest.approx((0.3, 0.0), abs=1e-6)
    assert "Friction rises by 0.3" in str(found)
    force = run.samples["spring_x"] + 2.0  # adhesion
    record = st.Record(time=run.samples["time"], force=force, normal_load=10.0)
    sticky = st.analysis.load_dependence(record, LEVELS)
    assert (sticky.coefficient, sticky.adhesion) == pytest.approx((0.3, 2.0), abs=1e-5)


def test_load_dependence_needs_levels():
    for load in (None, st.protocols.load_ramp([20.0], ramp="1 s")):
        with pytest.raises(st.ResultError, match="fewer than two levels"):
            st.analysis.load_dependence(loaded_test(load))
    with pytest.raises(st.ResultError, match="give the record its normal_load"):
        st.analysis.load_dependence(st.Record(time=[0.0, 1.0], force=[0.0, 1.0]), LEVELS)


def test_a_record_is_analysed_by_its_program():
    run = reversed_test()
    record = st.Record(
        time=run.data["time"].values, force=run.data["spring_x"].values, normal_load=10.0
    )
    program = run.slider.motion
    alone = st.analysis.hysteresis(record, program)
    assert alone.loops[1].area == pytest.approx(st.analysis.hysteresis(run).loops[1].area)
    with pytest.raises(st.ResultError, match="give its program"):
        st.analysis.hysteresis(record)
    bare = st.Record(time=record.time, force=record.force)
    with pytest.raises(st.ResultError, match="needs the normal load"):
        st.analysis.hysteresis(bare, program)
    with pytest.raises(st.ResultError, match="no hold between two slides"):
        st.analysis.healing(run)
    with pytest.raises(st.ResultError, match="does not step"):
        st.analysis.velocity_steps(run)
    with pytest.raises(st.ResultError, match="does not turn twice"):
        st.analysis.hysteresis(st.simulate(run.slider.replace(drive=st.ConstantVelocity(1e-3)), 1))


def test_apparent_friction_over_the_yaw_angle(tmp_path):
    """In steady sliding a load cell reads mu(V) cos(phi); else less on average."""
    base = st.presets.yaw_angle_brake()
    study = st.protocols.yaw_sweep(base, ["2 deg", "25 deg", "40 deg"])
    st.sweep(study, tmp_path / "yaw.zarr")
    data = st.open_study(tmp_path / "yaw.zarr")
    found = st.analysis.apparent_friction(data, base.slider)
    assert np.degrees(found.phi) == pytest.approx([2.0, 25.0, 40.0])
    mu = base.slider.law.coefficient(0.02)
    assert found.steady == pytest.approx(mu * np.cos(found.phi))
    assert found.mean[1:] == pytest.approx(found.steady[1:], rel=1e-3)
    assert found.corrected[1:] == pytest.approx(mu, rel=1e-3)
    assert found.amplitude[0] > 0.1 * mu
    assert found.mean[0] < found.steady[0] < found.peak[0]
    assert "Sliding is steady at 25 deg first" in str(found)
    with pytest.raises(st.ResultError, match="not a study over phi alone"):
        st.analysis.apparent_friction(data.drop_vars("mean_force"), base.slider)


def test_the_line_of_two_holds_has_no_error():
    program = st.protocols.slide_hold_slide(V, [10.0, 100.0], slide=20.0)
    found = st.analysis.healing(steadily_run(AGEING, program, rate=50.0))
    assert found.per_decade == pytest.approx(np.diff(found.gain)[0] / log10(10.0))
    assert np.isnan(found.per_decade_error)


@pytest.mark.parametrize(
    "analyse",
    [
        st.analysis.velocity_steps, st.analysis.healing, st.analysis.hysteresis,
        st.analysis.load_dependence,
    ],
)  # fmt: skip
def test_a_test_of_what_is_neither_run_nor_record_is_refused(analyse):
    with pytest.raises(st.ResultError, match="an int is neither a run nor a record; make one with"):
        analyse(5)


@pytest.mark.parametrize(
    "own",
    [
        {},
        {"springs": [st.Spring("a", k_x="1 kN/m", k_y="10 MN/m", angle="20 deg")]},
        {"friction": st.laws.Anisotropic(law=st.Coulomb(0.2), ratio=0.6, angle="45 deg")},
        {"cell_angle": "0 deg"},
        {"drive": st.ConstantVelocity("-1 mm/s")},
    ],
)
def test_steady_sliding_of_a_yaw_sweep_is_that_of_its_springs(own, tmp_path):
    """With axes of springs, and a grain, "steady" was 0.0976 beside a measured 0.1483."""
    slider = st.presets.nakano_popov_2020().replace(c_x="50 N s/m", **own)
    base = st.Description(slider, st.Initial(), st.Settings(duration="20 s"))
    path = tmp_path / "a.zarr"
    st.sweep(st.protocols.yaw_sweep(base, ["25 deg", "32 deg"]), path)
    found = st.analysis.apparent_friction(st.open_study(path), slider)
    assert (found.amplitude < 1e-3).all()
    np.testing.assert_allclose(found.mean, found.steady, rtol=2e-3)
    np.testing.assert_allclose(found.corrected, found.along, rtol=2e-3)
