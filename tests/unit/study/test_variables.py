"""The stored variables of each run, against independent values."""

import numpy as np
import pytest
from benchmarks.explore import misalignment
from benchmarks.explore.rigs import first_slip
from tests.drawn import inside
from tests.rigs import NEARLY_ISOTROPIC

import stiction as st
from stiction.analysis.creep.first_slip import first_loading, first_slip_time
from stiction.analysis.motion.noiseless.extremes import bottom, summit
from stiction.analysis.motion.noiseless.features import features
from stiction.analysis.motion.noiseless.resolution import least_rate
from stiction.analysis.motion.noiseless.swings import SwingShapes
from stiction.analysis.motion.noiseless.zigzag import zigzag
from stiction.analysis.motion.regime.kinds import (
    BACKWARD,
    STICK_SLIP,
    TRANSVERSE,
    UNDETERMINED,
    shape,
)
from stiction.analysis.motion.regime.of_run import kind_of_cycles
from stiction.result.peak import largest_spring_force, turning_points
from stiction.result.table import sample_table
from stiction.simulation import sample_times, solve
from stiction.study.variables.kinds import KINDS
from stiction.study.variables.measures import MEASURES
from stiction.study.variables.observed_run import observe_run

PAPER = st.presets.nakano_popov_2020()
TURN = 2.0 * np.pi
SYSTEMS = 0, 1, 8, 25, 42, 115  # of benchmarks.explore.rigs.first_slip: k_y over k_x of 2 to 1/890


def run_in_study(slider, duration, **settings):
    """Return a run as a study sees it."""
    run = st.Settings(duration=duration, **settings)
    return observe_run(st.Description(slider, st.Initial(), run), None)


@pytest.fixture(scope="module")
def paper():
    return run_in_study(PAPER, "5 s")


def value(name, run):
    return MEASURES[name].value(run)


def test_the_paper_s_cycle(paper, paper_run):
    """Against 10 kHz samples of the same solver."""
    data = paper_run.data
    peak = largest_spring_force(paper_run.samples, 1e3).force
    assert value("peak_force", paper) == pytest.approx(peak, rel=2e-6)
    assert value("mu_static", paper) == pytest.approx(peak / PAPER.normal_load, rel=2e-6)
    assert value("peak_velocity", paper) == pytest.approx(float(data["V_X"].max()), rel=5e-3)
    cycles = st.analysis.find_cycles(st.analysis.record_of(paper_run))
    assert value("cycles", paper) == cycles.sizes["cycle"]
    period = float(cycles["period"].mean())
    assert value("period", paper) == pytest.approx(period, rel=1e-4)
    assert value("force_drop", paper) == pytest.approx(float(cycles["drop"].mean()), rel=1e-4)
    # a trough is sharper than the samples: it is placed to half their distance
    half = 0.5 * float(paper.time[1] - paper.time[0]) / period
    share = float(cycles["rise_share"].mean())
    assert value("rise_share", paper) == pytest.approx(share, abs=half)
    assert value("time_stuck", paper) == paper_run.statistics.time_stuck
    assert value("stick_count", paper) == paper_run.statistics.stick_count
    late = data["spring_x"].sel(time=slice(3.75, None))
    assert value("mean_force", paper) == pytest.approx(float(late.mean()), rel=1e-3)
    assert value("amplitude", paper) == pytest.approx(0.5 * float(np.ptp(late.values)), rel=1e-3)


def test_a_load_that_varies_gives_no_coefficient():
    loaded = PAPER.replace(load=st.protocols.load_ramp(["20 N"], ramp="0.1 s"))
    run = run_in_study(loaded, "0.2 s")
    assert value("peak_force", run) > 0.0
    assert np.isnan(value("mu_static", run))


def test_creep_before_the_first_slip(paper, paper_run):
    """It begins between two samples of a study, where the mass moves at the drive's speed."""
    data = paper_run.data
    first = int(np.argmax(data["V_X"].values > 1e-3)) - 1
    step = 1e-4  # s, of these samples; a study's are six times as far apart
    assert value("first_slip_time", paper) == pytest.approx(float(data["time"][first]), abs=step)
    assert first_slip_time(paper_run) == float(data["time"][first])
    crept = float(data["X"][first] - data["X"][0])
    assert value("creep_distance", paper) == pytest.approx(crept, abs=2 * 1e-3 * step)


@pytest.mark.parametrize(
    ("slider", "duration"),
    [
        (PAPER.replace(k_y=2e3, phi="6 deg"), "3 s"),
        (PAPER.replace(drive=st.ConstantVelocity("20 mm/s")), "0.2 s"),
        (PAPER.replace(drive=st.ConstantVelocity("-20 mm/s")), "0.2 s"),
        (NEARLY_ISOTROPIC, "0.4 s"),
    ],
)
def test_creep_is_the_same_with_more_samples(slider, duration):
    """At the next sample it was 10 to 25 % off: the mass moves as fast as the drive there."""
    few, many = (run_in_study(slider, duration, sample_rate=rate) for rate in (None, "50 kHz"))
    crept = value("creep_distance", many)
    assert crept > 0.0  # with a drive along -X too
    assert value("creep_distance", few) == pytest.approx(crept, rel=2e-3)
    at = first_loading(slider, few.time, few.elongation, few.elongation_rate, few.drive).slip
    assert abs(few.positions[at] - few.positions[0] - crept) > 0.1 * crept


def nearly_slips():
    """Rigs whose mass gains on the drive, before it slips, by nearly as much as in a slip."""
    static = st.Coulomb(mu_0=0.2, mu_static=0.25)
    weakens = st.ExponentialWeakening(mu_0=0.2, mu_inf=0.15, v_f=0.0011034)
    for phi, k_y, V, law, c_x, c_y in (
        (6, 3.8565e5, 2.865e-4, weakens, 5.0, 0.0),
        (6, 2.25e5, 2.67e-4, static, 5.0, 2.0),
        (20, 5.9e4, 1.06e-3, static, 1.0, 2.0),
        (6, 1.04e6, 2.95e-4, static, 1.0, 0.0),
        (12, 7.6e5, 1.92e-4, static, 1.0, 0.0),
    ):
        yield PAPER.replace(
            phi=f"{phi} deg", k_y=k_y, friction=law, c_x=c_x, c_y=c_y, drive=st.ConstantVelocity(V)
        )
    for phi, decades, speed, c in inside(8, (0.3, 50.0), (4.0, 6.0), (-3.5, -2.0), (0.0, 5.0)):
        drive = st.ConstantVelocity(-(10.0**speed))
        yield PAPER.replace(
            phi=f"{phi} deg", k_y=10.0**decades, friction=static, c_x=c, c_y=2.0, drive=drive
        )


@pytest.mark.parametrize("slider", [*nearly_slips()])
def test_the_first_slip_does_not_depend_on_where_samples_fall(slider):
    """Its time was off by 2 to 6 %, by a gain that lies between samples; `first_slip` states it."""
    duration = 2.0 * (slider.loading_time + 3.0 / slider.natural_frequency_x)
    rate = 60.0 * slider.natural_frequencies[1]
    few, many = (run_in_study(slider, duration, sample_rate=each) for each in (None, rate))
    assert few.first_slip == pytest.approx(many.first_slip, rel=1e-3, nan_ok=True)


@pytest.mark.parametrize("seed", [1, 15])
def test_creep_over_less_than_a_sample_is_that_of_closer_ones(seed):
    """It was up to 400 times too large, or against the drive, where slip is fast within a sample.

    Held against the travel of mass and drive in samples that are 200 times as close.
    """
    random = np.random.default_rng(seed)
    slider = misalignment.rig(random, misalignment.SOFT if seed % 2 else (2.0, 4.0))
    V = slider.motion.velocity
    duration = 1.2 * slider.F_0 / slider.k_x / V
    few = run_in_study(slider, duration)
    step = float(few.time[1] - few.time[0])
    begin, crept = few.first_slip
    run = st.Description(slider, st.Initial(), st.Settings(duration=begin + 2.0 * step))
    time = sample_times(0.0, run.run.duration, 200.0 / step)
    time = np.append(0.0, time[time > begin - 2.0 * step])  # the others are millions
    X = sample_table(run, time, solve(run, time).samples, {})["X"]
    slips = int(np.argmax(V * time - X))
    assert begin == pytest.approx(float(time[slips]), abs=step / 200.0)
    assert crept == pytest.approx(float(X[slips] - X[0]), rel=1e-3, abs=V * step / 200.0)
    assert crept > 0.0


def test_a_turning_point_lies_between_two_samples():
    """Of a cubic exactly, of a sine within (omega dt)^4/384, and else at the sample."""
    t = np.linspace(0.0, 1.0, 33)
    for sign in (1.0, -1.0):
        for top in (0.0, 0.011, 0.5, 0.99, 1.0):
            near = int(np.rint(top * 32))
            values = sign * (5.0 - (t - top) ** 2 * (3.0 + t))
            rates = -sign * (2.0 * (t - top) * (3.0 + t) + (t - top) ** 2)
            found = summit(t, values, rates, near, sign)
            assert found == pytest.approx((top, 5.0 * sign), rel=1e-12, abs=1e-14)
        sine = sign * np.sin(2.0 * np.pi * t + 0.5)
        rate = 2.0 * np.pi * sign * np.cos(2.0 * np.pi * t + 0.5)
        when, most = summit(t, sine, rate, int(np.argmax(sign * sine)), sign)
        assert abs(most) == pytest.approx(1.0, abs=(2.0 * np.pi / 32.0) ** 4 / 384.0)
        assert when == pytest.approx(0.25 - 0.25 / np.pi, abs=1e-4)
    assert summit(t, t, np.ones(33), 32, 1.0) == summit(t, t, -np.ones(33), 32, 1.0) == (1.0, 1.0)
    assert summit(t, -t, -np.ones(33), 0, 1.0) == (0.0, 0.0)


def test_a_turning_point_is_that_of_the_cubic_that_any_run_s_peak_has():
    """One formula for one interval, compiled, and one for arrays of them."""
    by_chance = inside(3, (0.1, 3.0), (-3.0, -0.1), (-1.0, 1.0))
    rates = [*by_chance, (1e-9, -1.0, 1.0), (1.0, -1.0, 0.0)]  # where digits could cancel
    first, step = 0.3, 0.5
    for before, after, rise in rates:
        t, values = np.array([2.0, 2.0 + step]), np.array([first, first + rise])
        when, most = summit(t, values, np.array([before, after]), 0, 1.0)
        ends = (values[:1], values[1:], np.array([before]), np.array([after]))
        share, height = turning_points(np.array([step]), *ends)
        assert when == pytest.approx(2.0 + step * share[0], rel=1e-12)
        assert most == pytest.approx(height[0], rel=1e-12, abs=1e-12)


@pytest.mark.parametrize("sticks", [0.4, 0.7, 1.0])
@pytest.mark.parametrize("place", [1, 2])
def test_a_fall_ends_where_its_rate_is_zero_if_it_decelerates_evenly_and_may_stick(sticks, place):
    """The rate is -3 N/s, and 2 N/s from a share of the step on: it is zero at 3/5 of that."""
    t = np.arange(4.0)
    rate = np.array([-6.0, -3.0, 2.0, 2.0])
    rise = 2.0 - 0.5 * 5.0 * sticks
    values = np.cumsum([9.0, -4.5, rise, 2.0])
    when, least = bottom(t, values, rate, place)  # whichever of both samples is the lower
    assert when == pytest.approx(1.0 + 0.6 * sticks, rel=1e-14)
    assert least == pytest.approx(values[1] - 0.5 * 3.0 * 0.6 * sticks, rel=1e-14)


@pytest.mark.parametrize(
    ("rate", "last", "when", "least"),
    [
        ((-1.0, -1.0), 3.0, 1.0, 3.0),  # it falls on
        ((1.0, 1.0), 5.0, 0.0, 4.0),  # it has risen before
        ((-1.0, 1.0), 9.0, 0.0, 4.0),  # it rises by more than at any of both rates
        ((-1.0, 1.0), 1.0, 1.0, 3.5),  # it has fallen by more
    ],
)
def test_a_fall_ends_at_a_sample_where_its_rates_do_not_tell(rate, last, when, least):
    t, values, rates = np.arange(3.0), np.array([4.0, last, last]), np.array([*rate, rate[1]])
    assert bottom(t, values, rates, int(np.argmin(values))) == (when, least)


def test_a_trough_behind_the_last_sample_but_one_ends_a_cycle_if_the_force_rises_enough():
    """By 1e-3 of the span, here 1e-3 (1 - cos(2 pi t)) = 2e-3 at 0.01007 s after a trough."""
    for step in (
        0.015,
        0.03,
    ):  # the last sample is nearer to the trough than the one before, or not
        for after, count in ((0.0099, 4), (0.0102, 5), (0.02, 5)):
            t = 2.5 + after - step * np.arange(160)[::-1]
            turns = features(
                t, np.cos(TURN * t), -TURN * np.sin(TURN * t), t, least=0.0, driven=len(t),
                parts=4, even=True,
            ).turn_time  # fmt: skip
            late = turns[turns > 0.2]
            assert len(late) == count
            np.testing.assert_allclose(late, 0.5 * np.arange(1, count + 1), atol=1e-3)


@pytest.mark.parametrize("law", [PAPER.friction, st.Coulomb(mu_0=0.2)])
@pytest.mark.parametrize("phi", [20.0, 40.0, 45.0, 60.0, 80.0, 89.0])
def test_a_transverse_swing_is_no_slip_at_any_angle(phi, law):
    """At 40 deg and more the mass swings faster than the drive, and stays where it was."""
    slider = PAPER.replace(phi=f"{phi} deg", friction=law)
    for sample_rate in (None, "10 kHz"):
        run = run_in_study(slider, "1 s", sample_rate=sample_rate)
        assert np.isnan(value("first_slip_time", run))
        assert np.isnan(value("creep_distance", run))
    run = st.simulate(slider, "1 s", sample_rate="10 kHz")
    assert first_slip_time(run) == 1.0


def test_the_first_slip_of_a_mass_that_rests_begins_where_the_spring_can_hold_no_more():
    law = st.Coulomb(mu_0=0.2, mu_static=0.5)
    for V in ("1 mm/s", "-1 mm/s"):
        drive = st.ConstantVelocity(V)
        slider = PAPER.replace(phi="0 deg", friction=law, drive=drive)
        at = 0.5 * 10.0 / 1e3 / 1e-3  # s: until the spring carries what holds the mass
        run = run_in_study(slider, "6 s")
        assert value("first_slip_time", run) == pytest.approx(at, rel=1e-2)
        assert value("creep_distance", run) == pytest.approx(0.0, abs=1e-5)


@pytest.mark.parametrize("number", SYSTEMS)
def test_the_first_slip_is_found_whichever_spring_is_softer(number):
    """Within 5 % of what the speed shows, as `benchmarks.explore.rigs.first_slip` has it."""
    seen = first_slip.look(first_slip.system(1, number))
    assert seen.shown == pytest.approx(seen.found, rel=first_slip.OFF)
    assert seen.shown == pytest.approx(seen.theory, rel=first_slip.OFF)


@pytest.mark.parametrize(("begin", "slips"), [(1.0, 2.5321), (2.0, 2.5), (2.04, 2.0321)])
def test_the_first_slip_is_found_where_the_drive_holds(begin, slips):
    """At 2.04 s it is on its way; at 2.0 s the mass creeps, slower than the drive.

    It begins where V_X last is V before it is 3 V, in 20 kHz samples, where X is 31 to 40 um.
    """
    program = st.protocols
    pieces = [
        program.Constant(duration=begin),
        program.Hold("0.5 s"),
        program.Constant(duration="1 s"),
    ]
    slider = PAPER.replace(drive=program.DriveProgram(velocity="1 mm/s", program=pieces))
    run = run_in_study(slider, begin + 1.6)
    step = float(run.time[1] - run.time[0])
    assert value("first_slip_time", run) == pytest.approx(slips, abs=step)
    assert value("creep_distance", run) == pytest.approx(35e-6, abs=6e-6)


@pytest.mark.parametrize("number", [21, 36, 40])
def test_the_first_slip_is_found_where_any_drive_holds(number):
    seen = first_slip.look(first_slip.system(1, number), first_slip.hold(1, number))
    assert seen.shown == pytest.approx(seen.found, rel=first_slip.OFF)


@pytest.mark.parametrize("multiscale", [False, True])
def test_the_mode_of_the_solver_does_not_matter(paper, multiscale):
    """To 1e-6, the tolerance, of the largest value."""
    other = run_in_study(PAPER, "5 s", multiscale=multiscale)
    for name in ("regime", "peak_force", "period", "creep_distance"):
        assert value(name, other) == pytest.approx(value(name, paper), rel=1e-5)


@pytest.mark.parametrize("V", [3e-4, 1e-3, 3e-3, 1e-2, 3e-2])
@pytest.mark.parametrize("phi", [0.5, 3.0, 7.0, 8.2, 9.0, 20.0])
def test_regimes_are_those_of_records(phi, V):
    """Noise-free rules and those for any record agree where both see enough cycles."""
    slider = PAPER.replace(phi=f"{phi} deg", drive=st.ConstantVelocity(V))
    run = run_in_study(slider, 8e-3 / V + 4.0)
    rate = 1.0 / float(run.time[1] - run.time[0])
    found = st.analysis.classify(st.simulate(slider, 8e-3 / V + 4.0, sample_rate=rate))
    if run.regime != found.kind:  # then on the bound between two kinds of cycles
        beside = {shape(value("rise_share", run) + off) for off in (-0.01, 0.01)}
        assert {run.regime, found.kind} <= beside, f"{run.regime} against {found}"
    assert run.regime in KINDS


def test_a_transverse_oscillation_goes_on_when_the_slow_motion_has_settled():
    """Drawn nearly along the stiff axis, the fast oscillation is the one that weakening drives."""
    slider = PAPER.replace(phi="80 deg")
    run = run_in_study(slider, "5 s")
    assert run.regime == TRANSVERSE
    late = st.simulate(slider, "5 s", sample_rate="100 kHz").data.sel(time=slice(4.97, None))
    rate = 0.5 * float(np.ptp(late["v_y"].values)) / (1e-3 * np.sin(np.radians(80.0)))
    assert run.transverse_oscillation == pytest.approx(rate, rel=0.05)  # 16 samples a period
    slow = run_in_study(PAPER.replace(phi="30 deg"), "5 s")
    assert slow.transverse_oscillation == pytest.approx(0.0, abs=1e-3)


@pytest.mark.parametrize("stiffness", [7.5e3, 1e4, 1.5e4, 2.5e4])
@pytest.mark.parametrize("phi", [5, 10, 20])
@pytest.mark.parametrize("V", [0.2, 0.4])
def test_swings_that_die_out_on_two_springs_alike_are_no_transverse_oscillation(stiffness, phi, V):
    """They move the stiffer spring as well, by more than a tenth of V sin phi."""
    law = st.ExponentialWeakening(0.3, 0.2, "20 mm/s")
    slider = st.Slider(
        mass="0.5 kg", k_x="5 kN/m", k_y=stiffness, phi=f"{phi} deg", normal_load="15 N",
        friction=law, drive=st.ConstantVelocity(V),
    )  # fmt: skip
    found = st.analyse(st.simulate(slider, "10 s", sample_rate="2 kHz")).regime
    assert run_in_study(slider, "10 s").regime == found.kind
    if (stiffness, phi, V) in ((1e4, 5, 0.2), (1.5e4, 10, 0.2)):
        assert found.kind == "settling"


def test_turning_points_of_a_known_signal():
    """A sine's extrema are found, to within the ripple on it and rates that are differences."""
    t = np.arange(0.0, 1.0, 1.0 / 320.0)
    signal = np.sin(2.0 * np.pi * 10.0 * t + 0.3) + 1e-4 * np.sin(2.0 * np.pi * 100.0 * t)
    found = features(
        t, signal, np.gradient(signal, t), np.zeros(len(t)), least=0.0, driven=len(t), parts=32,
        even=True, reversal=0.01,
    )  # fmt: skip
    exact = (np.pi / 2 - 0.3 + np.pi * np.arange(20)) / (2.0 * np.pi * 10.0)
    np.testing.assert_allclose(found.turn_time, exact, atol=1e-4)
    np.testing.assert_allclose(np.abs(found.turn_value), 1.0, atol=3e-4)
    assert not found.trough
    assert found.peak == pytest.approx(1.0, abs=3e-4)


@pytest.mark.parametrize("values", [[], [1.0], [1.0, 1.0], [1.0, 2.0, 3.0], [3.0, 1.0]])
def test_what_does_not_turn_has_no_turning_points(values):
    assert len(zigzag(np.array(values), 0.1)) == 0


@pytest.mark.parametrize("name", MEASURES)
def test_every_measure_of_a_run_that_hardly_began(name):
    run = run_in_study(PAPER, "1 us")
    assert np.isscalar(value(name, run))
    assert run.regime in ("stuck", "undetermined")


def test_what_never_slips_is_stuck():
    assert run_in_study(PAPER.replace(drive=st.ConstantVelocity(0.0)), "5 s").regime == "stuck"


def test_swings_after_which_it_is_quiet_are_a_transient():
    """They are seen down to the tolerance; none follows in many periods."""
    slider = PAPER.replace(phi="14.5 deg", drive=st.ConstantVelocity("3.16 mm/s"))
    run = run_in_study(slider, "6.5 s")
    assert run.end - run.swings.end > 20 * run.swings.period.max()
    assert run.regime == "settling"
    assert len(run.swings.drop) > 0 == len(run.cycles.drop)
    assert st.linear_stability.growth_rate(slider) < 0.0


PIN = st.Slider(
    mass="80 g", k_x="2.3 kN/m", k_y="0.9 MN/m", phi="8 deg", normal_load="4 N",
    friction=st.ExponentialWeakening(mu_0=0.6, mu_inf=0.45, v_f="10 mm/s"),
    drive=st.ConstantVelocity("0.5 mm/s"),
)  # fmt: skip


@pytest.mark.parametrize(("phi", "V"), [(8.0, 5e-4), (18.0, 5e-4), (20.0, 2e-4)])
def test_a_small_vibration_on_both_springs(phi, V):
    """Of 2e-3 and less of the force; below 1e-3 of it a study saw none.

    It is quicker than the mass can swing on the spring along x alone: the other one swings as
    well. An analysis counts the same cycles, but for where those begin that build up: when they
    reach half of the median, on which the smallest that either sees have a part.
    """
    slider = PIN.replace(phi=f"{phi} deg", drive=st.ConstantVelocity(V))
    run = run_in_study(slider, "8 s")
    assert run.regime == TRANSVERSE
    found = st.analyse(st.simulate(slider, "8 s", sample_rate="10 kHz"))
    assert found.regime.kind == TRANSVERSE  # though it sticks in each of these cycles
    assert "oscillates across the drive" in str(found)
    assert found.cycles["period"].mean() < 0.9 / slider.natural_frequencies[0]
    assert found.cycles["drop"].mean() < 5e-3 * found.record.force.max()
    count = found.cycles.sizes["cycle"]
    assert value("cycles", run) == pytest.approx(count, rel=0.05)
    assert value("period", run) == pytest.approx(float(found.cycles["period"].mean()), rel=0.02)


@pytest.mark.parametrize("later", [1e-4, 3e-4, 3e-3, 1e-2])
def test_a_run_that_ends_just_after_a_trough(later):
    """An analysis counted a cycle more than a study, until the force had risen by 1e-3 of its span.

    The share of a period after the trough at which the run ends, about that of the span.
    """
    its = run_in_study(PAPER, "5 s").cycles
    period = float(its.period.mean())
    duration = its.end + later * period
    found = st.analysis.find_cycles(st.simulate(PAPER, duration))
    count = len(run_in_study(PAPER, duration).cycles.drop)
    assert count == found.sizes["cycle"]
    assert found["trough_time"][-1] < duration - 1e-3 * period


WEAKENED = PAPER.replace(
    mass=0.1, k_x=3186.0, k_y=4e6, phi="8.142 deg", normal_load=9.387,
    friction=st.ExponentialWeakening(mu_0=0.25, mu_inf=0.15, v_f="10 mm/s"),
    drive=st.ConstantVelocity("0.7489 mm/s"),
)  # fmt: skip
ON_A_GRAIN = st.Slider(
    mass=0.1074, k_x=1e3, k_y=11.69e3, phi="58 deg", normal_load=5.0,
    friction=st.laws.Anisotropic(
        st.ExponentialWeakening(mu_0=0.5, mu_inf=0.115, v_f="36 mm/s"), 0.375, "-44.8 deg"
    ),
    drive=st.ConstantVelocity("39.3 mm/s"),
)  # fmt: skip


@pytest.mark.parametrize(
    ("slider", "duration", "sticks"), [(WEAKENED, 3.0, True), (ON_A_GRAIN, 1.4, False)]
)
def test_a_vibration_on_both_springs_may_fall_more_slowly_than_it_rises(slider, duration, sticks):
    """The force rises in less than 0.4 of each cycle, yet in a run its sign is known."""
    run = run_in_study(slider, duration)
    assert value("period", run) < 0.9 / slider.natural_frequency_x
    assert value("rise_share", run) < BACKWARD
    assert (value("stick_count", run) > len(run.cycles.drop)) == sticks
    assert run.regime == TRANSVERSE
    rate = 1.0 / float(run.time[1] - run.time[0])
    found = st.analysis.classify(st.simulate(slider, duration, sample_rate=rate))
    assert found.kind == TRANSVERSE
    assert found.runner_up == (STICK_SLIP if sticks else "")
    assert "sign" not in str(found)


def test_swings_that_grow_with_the_load_and_then_die_out_are_a_transient():
    """Steady sliding is stable: swings of a quick mode grow while it loads, and are gone then."""
    slider = PIN.replace(phi="20 deg", drive=st.ConstantVelocity("2 mm/s"))
    assert st.linear_stability.growth_rate(slider) < -5.0
    assert st.analysis.classify(st.simulate(slider, "8 s", sample_rate="10 kHz")).kind == "settling"
    assert run_in_study(slider, "8 s").regime == "settling"


def test_a_coarse_sample_rate_of_the_description_changes_no_measure():
    """It says what a run's file holds; samples too far apart would show other, slower cycles."""
    run, coarse = run_in_study(PIN, "4 s"), run_in_study(PIN, "4 s", sample_rate="70 Hz")
    assert coarse.regime == run.regime
    assert value("cycles", coarse) == value("cycles", run)
    assert value("period", coarse) == value("period", run)


def test_a_single_cycle_after_the_loading_is_no_transverse_oscillation():
    """Its drop is a tenth of the loading: the force seems to settle as the stiff spring moves."""
    drive = st.ConstantVelocity("0.5 mm/s")
    slider = NEARLY_ISOTROPIC.replace(phi="10 deg", drive=drive)
    run = run_in_study(slider, "2 s", sample_rate="5 kHz")
    assert len(run.cycles.drop) == 1
    found = st.analysis.classify(st.simulate(slider, "2 s", sample_rate="5 kHz"))
    assert run.regime == found.kind == "stick-slip"


def test_cycles_before_a_hold_are_no_transient():
    """They were: the motion was over "by itself", as no swing followed for long."""
    program = st.protocols
    steps = [program.Constant(duration="1 s"), program.Step("-1 mm/s", "4 s"), program.Hold("3 s")]
    slider = PAPER.replace(drive=program.DriveProgram(velocity="0 mm/s", program=steps))
    run = run_in_study(slider, "8 s")
    seen = st.simulate(slider, "8 s", sample_rate="1 kHz")
    cycles = st.analysis.find_cycles(seen)
    assert run.regime == st.analysis.classify(seen).kind == "stick-slip"
    assert value("cycles", run) == cycles.sizes["cycle"] == 2
    assert value("period", run) == pytest.approx(float(cycles["period"].mean()), rel=1e-3)


def test_a_ripple_before_a_hold_is_no_cycle():
    """In the hold the force spans nothing, and each swing across the drive was a cycle."""
    program = st.protocols
    steps = [program.Constant(duration="1 s"), program.Hold("3 s")]
    slider = PAPER.replace(drive=program.DriveProgram(velocity="1 mm/s", program=steps))
    run = run_in_study(slider, "4 s")
    assert run.regime == "settling"
    assert value("cycles", run) == 0


@pytest.mark.parametrize("number", range(24))
def test_a_study_and_an_analysis_call_a_run_the_same(number):
    """Where the drive holds, or the transverse motion goes on, they had two names."""
    random = np.random.default_rng([17, number])
    stiffer, phi = 10.0 ** random.uniform(0.0, 2.0), random.uniform(0.0, 60.0)
    V, program = 10.0 ** random.uniform(-2.5, 0.0), st.protocols
    moves = [program.Constant(duration=0.6), program.Hold(0.8)]
    held = program.DriveProgram(velocity=V, program=moves)
    slider = PAPER.replace(
        k_y=1e3 * stiffer, phi=f"{phi} deg", drive=held if number % 2 else st.ConstantVelocity(V)
    )
    run = run_in_study(slider, "1.4 s")
    assert run.regime == st.analysis.classify(st.simulate(slider, "1.4 s")).kind


def test_an_even_number_of_cycles_has_the_shape_of_the_middle_two():
    """As in an analysis: neither of the two alone says what is typical."""
    shares = np.array([0.70, 0.82])
    cycles = SwingShapes(np.arange(2.0), np.ones(2), np.ones(2), shares)
    none = lambda _: np.zeros(2)  # noqa: E731
    kind = kind_of_cycles(cycles, 0.1, none, none, lambda: None)
    assert kind == shape(float(np.median(shares))) != shape(shares[1])


def test_two_swings_die_out_by_the_rule_of_an_analysis():
    """A second swing of 0.6 of the first, and quiet for long: it has less than two thirds."""
    swings = SwingShapes(np.arange(2.0), np.ones(2), np.array([1.0, 0.6]), np.full(2, 0.5))
    assert swings.die_out(2.0 + 3.1)
    assert not swings.die_out(2.0 + 2.9)


def test_a_vibrated_rig_has_the_period_of_its_vibration():
    """Friction turns twice a period of 320 Hz; 32 samples a natural period showed 18 ms."""
    p = st.protocols
    shaken = p.DriveProgram(velocity="1 mm/s", across=p.Modulation("1.25 mm/s", "320 Hz"))
    run = run_in_study(PAPER.replace(phi="-2 deg", drive=shaken), "4 s")
    assert value("period", run) == pytest.approx(0.5 / 320.0, rel=1e-3)


def test_too_few_samples_for_a_vibration_determine_nothing(monkeypatch):
    """At one sample a period the vibration seems slow; its range and its sticks are known still."""
    monkeypatch.setattr("stiction.study.variables.sampling.MOST_SAMPLES", 317)
    p = st.protocols
    shaken = p.DriveProgram(velocity="1 mm/s", along=p.Modulation("3 mm/s", "320 Hz"))
    run = run_in_study(PAPER.replace(drive=shaken), "1 s")
    assert not run.resolved
    assert np.isnan([value(name, run) for name in ("period", "force_drop", "creep_distance")]).all()
    assert KINDS[value("regime", run)] == UNDETERMINED
    assert value("stick_count", run) > 100.0
    monkeypatch.undo()
    fine = run_in_study(PAPER.replace(drive=shaken), "1 s")
    for name in ("peak_force", "mean_force", "amplitude"):
        assert value(name, run) == pytest.approx(value(name, fine), rel=0.02)


ROCK = st.Slider(
    mass="1 kg", k_x="2.4 MN/m", k_y="200 MN/m", phi="0 deg", normal_load="5 kN",
    friction=st.laws.RateStateAgeing(a=0.008, b=0.014, D_c="10 um", mu_star=0.6, V_star="1 um/s"),
    drive=st.ConstantVelocity("10 um/s"),
)  # fmt: skip
HELD = ROCK.replace(friction=st.Coulomb(mu_0=0.55, mu_static=0.65))
TURNED = ROCK.replace(
    mass="1 g", k_y="24 MN/m", phi="6 deg",
    friction=st.ExponentialWeakening(mu_0=0.6, mu_inf=0.5, v_f="10 um/s"),
)  # fmt: skip


@pytest.mark.parametrize(
    ("slider", "duration"),
    [(ROCK, 300.0), (ROCK.replace(k_x="3.4 MN/m"), 300.0), (HELD, 300.0), (TURNED, 300.0)],
)
def test_a_slow_motion_of_a_light_mass_is_seen_by_the_steps_of_the_solver(slider, duration):
    """It has 70 000 to 1e7 periods of the mass on its spring, and a dozen cycles or none."""
    run = run_in_study(slider, duration)
    assert run.resolved
    assert not run.sampling.even
    assert len(run.time) < 0.1 * duration * least_rate(slider)
    fine = st.simulate(slider, duration)
    found = st.analyse(fine)
    assert run.regime == found.regime.kind
    assert value("cycles", run) == (found.cycles.sizes["cycle"] if run.regime == STICK_SLIP else 0)
    assert value("peak_force", run) == pytest.approx(fine.samples["spring_x"].max(), rel=1e-4)
    if run.regime == STICK_SLIP:
        period = float(found.cycles["period"].mean())
        assert value("period", run) == pytest.approx(period, rel=1e-4)


def test_samples_by_the_solver_s_steps_show_the_same_as_even_ones(monkeypatch):
    """Of the paper's system, in which both do."""
    slider = PAPER.replace(k_y="3 kN/m")
    even = run_in_study(slider, "5 s")
    monkeypatch.setattr("stiction.study.variables.sampling.MANY_SAMPLES", 1000)
    run = run_in_study(slider, "5 s")
    assert even.sampling.even
    assert not run.sampling.even
    for name in MEASURES:
        loose = 0.05 if name == "transverse_oscillation" else 2e-3
        assert value(name, run) == pytest.approx(value(name, even), rel=loose, nan_ok=True), name


def test_few_samples_suffice_where_the_motion_is_slow(monkeypatch):
    """Loading to the first slip needs no samples of each natural period."""
    slow = run_in_study(PAPER, "1 s")
    monkeypatch.setattr("stiction.study.variables.sampling.MOST_SAMPLES", 200)
    coarse = run_in_study(PAPER, "1 s")
    assert coarse.resolved
    assert not coarse.sampling.enough
    assert value("peak_force", coarse) == pytest.approx(value("peak_force", slow), rel=5e-3)


@pytest.mark.parametrize("duration", np.linspace(0.9, 1.3, 9))
def test_the_amplitude_is_that_of_a_run_with_many_samples(duration):
    """Between 32 samples a period the largest of few peaks may hide by half a percent."""
    slider = PAPER.replace(drive=st.ConstantVelocity("40 mm/s"))
    observed = run_in_study(slider, duration)
    fine = st.simulate(slider, duration, sample_rate=100e3).samples
    late = fine["spring_x"][fine["time"] >= observed.time[3 * len(observed.time) // 4]]
    assert value("amplitude", observed) == pytest.approx(0.5 * np.ptp(late), rel=3e-4)


@pytest.mark.parametrize(("k_y", "V"), [("200 N/m", 0.02), ("500 N/m", 0.1), ("30 kN/m", 0.02)])
def test_the_largest_velocity_is_that_between_samples(k_y, V):
    """Of any peak of it: the largest sample, up to 1.6 % too small, may lie in another one."""
    slider = PAPER.replace(k_y=k_y, phi="25 deg", drive=st.ConstantVelocity(V))
    largest = st.simulate(slider, 1.0, sample_rate=50e3).samples["V_X"].max()
    assert value("peak_velocity", run_in_study(slider, 1.0)) == pytest.approx(largest, rel=1e-3)


def test_sticking_in_a_force_that_falls_slowly_counts_in_a_study_as_in_an_analysis():
    """On two springs nearly alike, where the mass swings no quicker than on that along x."""
    slider = st.Slider(
        mass=0.24, k_x=1e3, k_y=4700.0, phi="73 deg", normal_load=5.0,
        friction=st.ExponentialWeakening(mu_0=0.5, mu_inf=0.09, v_f="30 mm/s"),
        drive=st.ConstantVelocity("0.14 m/s"),
    )  # fmt: skip
    observed = run_in_study(slider, 3.0)
    assert value("period", observed) > 0.9 / slider.natural_frequency_x
    rise = np.median(observed.cycles.rise_share)
    assert shape(rise) == UNDETERMINED
    kind = st.analyse(st.simulate(slider, 3.0)).regime.kind
    assert observed.regime == kind == STICK_SLIP
