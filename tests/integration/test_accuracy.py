"""The bounds of `rtol`, on systems of ``python -m benchmarks.explore``, the worst included.

Both bounds held on all but one of 30 000 of them, number 26943, and hold on that one now. These
are of the two laws that other tests compile as well.
"""

from math import hypot, pi, sqrt

import numpy as np
import pytest
from benchmarks.explore import accuracy
from benchmarks.explore.accuracy import BOUNDS, CHAOTIC, IN_STEPS, look, look_at
from benchmarks.explore.deviation import (
    FINEST,
    deviation,
    forces,
    response,
    without_instants,
)
from benchmarks.explore.draw import Draw
from benchmarks.explore.systems.general import general_system
from benchmarks.explore.systems.seismic import seismic_system
from benchmarks.explore.systems.set_valued import System

import stiction as st
from stiction.presets.preset import on_a_line
from stiction.solver.accuracy import tolerance

SEED = 1
ANY = (0, 1, 3, 4, 5, 7, 10, 12, 14, 16, 18, 21, 22, 27, 28, 29, 32, 36, 41, 42, 45, 47, 55, 58)
WORST = (
    3531,
    2337,
    3608,
    6405,
    694,
    1261,
    2575,
    3238,
    5937,
    5473,
    6346,
    462,
    1097,
    452,
    7340,
    8466,
    26943,  # steps longer than the oscillation across the slip: off by 31 once
)
WORST_MAPPED = (5661, 1492, 8596, 168, 8106, 1491, 2413, 1060)


@pytest.mark.parametrize("number", [*ANY, *WORST, *WORST_MAPPED])
def test_an_error_is_that_of_an_apparatus_a_little_other(number):
    seen = look(SEED, number)
    assert not seen.left_out
    in_steps, by_default, multiscale = seen.off
    assert in_steps < BOUNDS["in steps"]
    assert by_default < BOUNDS["by default"]
    if seen.mapped[2]:
        assert multiscale < BOUNDS["multiscale"]


@pytest.mark.parametrize("number", [187, 748])
def test_a_long_run_is_as_right_by_default(number):
    """Thirty times as long: most of its cycles come from a map."""
    seen = look(71, number, 30.0)
    assert not seen.left_out
    assert seen.mapped[1] > 100
    assert seen.off[1] < BOUNDS["by default"]


def test_what_is_seen_is_the_same_each_time():
    """To the last bit on one machine: no state is left from one run to the next."""
    assert look(SEED, 7) == look(SEED, 7)


@pytest.mark.parametrize(("known", "left_out"), [(0.1, ""), (0.0, CHAOTIC)])
def test_a_system_above_a_bound_counts_if_its_reference_is_known(known, left_out, monkeypatch):
    monkeypatch.setattr(accuracy, "KNOWN", known)
    monkeypatch.setitem(BOUNDS, "in steps", 0.0)
    assert look(SEED, 7).left_out == left_out


@pytest.mark.parametrize("number", [2711, 1501, 2208, 2408, 2300, 292, 2324, 1585])
def test_laws_with_state_keep_the_bound_too(number):
    """The worst of two laws among 3000: in the plane, and on a line where slip turns back."""
    seen = look(SEED, number, kind="state")
    assert not seen.left_out
    assert seen.off[0] < BOUNDS["in steps"]


BRISTLES = st.laws.LuGre(0.3, 0.4, "0.3 mm/s", 3.7e5, 50.0, 3.6)


def stick_slip(law, **changes):
    """Return stick-slip along a line, of a mass of 17 g under 0.13 N that a soft spring pulls."""
    drive = st.ConstantVelocity("95 um/s")
    common = {"mass": "17 g", "k_x": 6.13, "normal_load": 0.127, "drive": drive}
    return on_a_line(friction=law, driven="spring", **(common | changes))


def test_slip_that_turns_back_costs_no_order():
    """The error of a law with a kink at rest goes as rtol; a step across it has that of tol.

    LuGre's published bristles ring under a stiff spring: their slip turns back many times.
    """
    law = st.laws.LuGre(1.0, 1.5, "1 mm/s", 1e5, 316.0, 0.4)
    pulled = {"mass": 1.0, "k_x": 1e3, "normal_load": 1.0, "drive": st.ConstantVelocity("10 mm/s")}
    slider = stick_slip(law, **pulled)

    def force(rtol):
        return st.simulate(slider, 1.0, sample_rate=200.0, rtol=rtol).data["spring_x"].values

    exact = force(1e-13)
    coarse, fine = (abs(force(rtol) - exact).max() for rtol in (1e-6, 1e-9))
    assert fine < coarse / 100.0


@pytest.mark.parametrize("rtol", [1e-2, 3e-3, 1e-3])
def test_no_step_creeps_through_a_slip(rtol):
    """Friction holds mu_s W and what bristles resist beside it, at any tolerance."""
    run = st.simulate(stick_slip(BRISTLES), 355.0, sample_rate=1.0, rtol=rtol)
    assert 0.9 * 0.4 * 0.127 < run.data["spring_x"].values.max() < 1.1 * 0.4 * 0.127


@pytest.mark.parametrize("rtol", np.geomspace(3e-4, 3e-5, 11))
def test_a_layer_at_the_start_is_resolved(rtol):
    """Contacts that are far from sliding stop the paper's start, a millionth of the drive, at once.

    The layer lasts 1e-20 s; steps that fell by a fifth at a time did not get there.
    """
    slider = st.Slider(
        mass=0.106,
        k_x=5.78e3,
        k_y=9.35e4,
        phi="1 deg",
        normal_load=10.3,
        friction=st.laws.RateStateAgeing(0.0048, 0.0109, "7.74 um", 0.358, "4.34 um/s"),
        drive=st.ConstantVelocity("0.279 um/s"),
    )
    assert st.simulate(slider, 1.0, sample_rate=0, rtol=rtol).status.ok


@pytest.mark.parametrize("number", [16, 150, 186])
def test_programs_of_the_drive_keep_the_bound(number):
    """Of 2000 with programs of drive or load; number 186 stuck where its drive had turned, once."""
    seen = look(SEED, number, kind="unsteady")
    assert not seen.left_out
    assert max(seen.off) < BOUNDS["in steps"]


@pytest.mark.parametrize("rtol", [1e-4, 1e-6, 1e-8, 1e-9])
def test_creep_of_smooth_friction_is_as_exact_as_asked_for(rtol):
    """Slip that follows the springs was off by 7 to 50 times the response, the more the finer."""
    creeping = st.Slider(
        mass=3.0,
        k_x=0.5,
        k_y=1e4,
        phi="1 deg",
        normal_load=45.0,
        friction=st.Coulomb(0.7),
        drive=st.ConstantVelocity("0.1 m/s"),
    )
    drawn = System(creeping, 14.0, rtol, delta=4e-3)
    sharp, _ = forces(drawn, FINEST)
    off = deviation(forces(drawn, rtol)[0], sharp)
    assert off < response(drawn, tolerance(rtol), FINEST, sharp)


@pytest.mark.parametrize("number", [477, 1594, 2000])
def test_all_that_a_description_can_hold_keeps_the_bound(number):
    """Of 5000 rigs with axes, springs, laws and starts of all kinds; two of them with creep.

    The grain of 1594 plays no part in its error, and code for a smooth one under a recorded drive,
    which no other test runs, is half a minute's compilation.
    """
    drawn = general_system(2, number)
    if number == 1594:
        drawn = drawn._replace(slider=drawn.slider.replace(friction=drawn.slider.friction.law))
    seen = look_at(drawn)
    assert not seen.left_out
    assert max(seen.off) < BOUNDS["in steps"]


@pytest.mark.parametrize("number", [4, 76, 335])
def test_a_slow_drive_keeps_the_bound(number):
    """Of 600 whose drive is slower than friction can move the mass, down to a hundred-millionth."""
    seen = look(1, number, kind="slow")
    assert not seen.left_out
    assert max(seen.off) < BOUNDS["in steps"]


@pytest.mark.parametrize("seed", range(20))
def test_a_drive_may_be_as_slow_as_a_plate_of_the_crust(seed):
    """After sticks of up to 1e11 swings; 43 of 100 such runs ended early, or nearly never."""
    draw = Draw(3, seed)
    mass, k_x, mu, load = draw.decades(0.01, 10.0), draw.decades(1e2, 1e5), 0.4, 20.0
    fastest = mu * load / sqrt(mass * k_x)
    V = fastest * draw.decades(1e-11, 1e-7)
    law = st.ExponentialWeakening(mu, mu * draw.between(0.3, 0.9), V * draw.decades(1.0, 1e3))
    slider = on_a_line(
        mass=mass,
        k_x=k_x,
        friction=law,
        normal_load=load,
        drive=st.ConstantVelocity(V),
        driven="spring",
    )
    slider = slider.replace(k_y=30.0 * k_x, phi=f"{draw.decades(1e-3, 0.1)!r} rad")
    c, s = slider.direction
    first = slider.F_0 / (V * hypot(k_x * c, slider.k_y * s))
    duration = first + 10.0 * pi * sqrt(mass / k_x)
    rtol = draw.decades(1e-10, 1e-4)
    run = st.simulate(slider, duration, rtol=rtol, multiscale=False)
    assert run.status.ok
    assert run.sticks["stick_end"].values[0] == pytest.approx(first, rel=1e-6)
    assert run.statistics.steps < 100_000


@pytest.mark.parametrize(("seed", "number"), [(1, 59), (1, 103), (3, 157)])
def test_bristles_may_be_driven_as_slowly(seed, number):
    """Rounding of forces was an error: 6 million steps, over 1e8, and over 200 000."""
    drawn = seismic_system(seed, number)
    found, run = forces(drawn, drawn.rtol)
    assert run.status.ok
    assert run.statistics.steps < 10_000
    sharp, _ = forces(drawn, FINEST)
    assert deviation(found, sharp) < IN_STEPS * tolerance(drawn.rtol)


@pytest.mark.parametrize("number", [40, 138])
def test_faults_that_are_loaded_slowly_keep_the_bound(number):
    """Slips up to a billion times as fast as the drive; the two largest errors of 150."""
    seen = look(1, number, kind="seismic")
    assert not seen.left_out
    assert max(seen.off) < BOUNDS["in steps"]


def test_the_instant_of_a_rapid_slip_is_told_by_the_samples_after_it():
    """One sample is between two instants; what stays off after it counts."""
    reference = np.array([[0.0, 1.0, 2.0, 0.0, 1.0, 2.0], [0.0] * 6])
    late, worse = reference.copy(), reference.copy()
    late[0, 3] = 2.5
    worse[0, 3:] = 2.5
    assert deviation(without_instants(late, reference, 0.1), reference) == 0.0
    assert deviation(without_instants(worse, reference, 0.1), reference) == 1.25


@pytest.mark.parametrize("rtol", [1e-5, 1e-7, 1e-9])
def test_a_slip_turns_back_however_close_to_rest_it_passes(rtol):
    """Springs exceed friction where it turns, within 1e-29 s: 11 of 13 tolerances ended there."""
    drawn = general_system(9, 5893)
    law = st.ExponentialWeakening(drawn.slider.law.mu_0, 0.0, 0.01)
    turning = drawn._replace(slider=drawn.slider.replace(friction=law))
    found, run = forces(turning, rtol)
    assert run.status.ok
    assert deviation(found, forces(turning, 1e-2 * rtol)[0]) < IN_STEPS * tolerance(rtol)


def test_no_mass_sticks_over_its_limit():
    """A start over the limit with a drive that unloads the spring, or one that has just turned."""
    W, k, mu = 10.0, 300.0, 0.2
    unloading = st.protocols.DriveProgram(
        velocity="1 mm/s",
        program=[st.protocols.Step(to="-0.2 mm/s", duration=20.0), st.protocols.Reversal(5.0)],
    )
    for beyond in np.linspace(1.001, 1.2, 20):
        slider = on_a_line(
            mass=0.1,
            k_x=k,
            friction=st.Coulomb(mu),
            normal_load=W,
            drive=unloading,
            driven="spring",
        )
        start = st.Initial(u_x=beyond * mu * W / k)
        run = st.simulate(slider, 25.0, initial=start, sample_rate=40.0).data
        rest = run["slip_speed"].values[1:] == 0.0
        assert rest.any()
        assert abs(run["spring_x"].values[1:][rest]).max() < mu * W * (1.0 + 1e-9)
