"""Analyses of friction tests by any program: they take no ramp for a step, no loading for friction.

The records are computed here, of a rig without inertia, so that what is right is known: the sum of
force times travel, the law's parameters, the friction coefficient.
"""

import numpy as np
import pytest
from benchmarks.explore.draw import Draw
from tests.drawn import SEED

import stiction as st
from stiction.drive import drive_stretches
from stiction.presets.preset import on_a_line

p = st.protocols
A, B, D, V = 0.01, 0.015, 10e-6, 10e-6
MU = 0.3


def turning_drive(draw: Draw, kind: str) -> tuple[p.DriveProgram, list[tuple[float, float]]]:
    """Return a drive whose legs end by jumps, by rests, or by ramps through zero, or have a wave.

    And when it comes to each turn and leaves it, and when its last leg ends.
    """
    pieces, turns, t, way = [], [], 0.0, 1.0
    for _ in range(4):
        speed, back, lasts = (draw.decades(1e-3, 3e-3) for _ in range(3))
        lasts, slow = 1e3 * lasts, draw.between(0.5, 1.0)
        pieces.append(p.Constant(way * speed, lasts))
        t += lasts
        if kind == "ramp":
            pieces.append(p.Ramp(-way * back, slow))
            turns.append((t + slow * speed / (speed + back),) * 2)
        elif kind == "rest":
            pieces.append(p.Hold(slow))
            turns.append((t, t + slow))
        else:
            turns.append((t, t))
        t += slow if kind in ("ramp", "rest") else 0.0
        way = -way
    pieces.append(p.Constant(way * 1e-3, 1.0))
    wave = p.Modulation(draw.between(1e-4, 9e-4), 0.7) if kind == "wave" else None
    return p.DriveProgram(program=pieces, along=wave), [*turns, (t + 1.0, t + 1.0)]


@pytest.mark.parametrize("kind", ["jump", "rest", "ramp", "wave"])
def test_the_area_of_a_loop_is_force_over_the_travel_of_the_drive(kind):
    """Of forces of any kind, under a load of any kind, to rounding; with constant legs it was.

    A turn in a ramp lies between two samples, 1 ms apart, of which either may be the loop's end:
    there the drive has moved by half its acceleration of 12 mm/s^2 at most over 1 ms squared.
    """
    for number in range(6):
        draw = Draw(SEED, number)
        drive, turns = turning_drive(draw, kind)
        time = np.arange(0.0, turns[-1][1], 1e-3)
        load = 10.0 * (1.0 + 0.3 * np.sin(draw.between(0.5, 2.0) * time))
        force = 3.0 * np.sin(time * draw.between(0.3, 1.0)) + np.cumsum(
            draw.random(len(time)) - 0.5
        )
        found = st.analysis.hysteresis(st.Record(time=time, force=force, load=load), drive)
        X = drive.travel(0.0, time)[0]
        assert len(found.loops) == 2
        for loop, (_, start), (end, _) in zip(found.loops, turns[::2], turns[2::2], strict=False):
            at = (time >= start - 1e-9) & (time <= end + 1e-9)
            error = 2.0 * 6e-9 * float(np.abs(force).max()) if kind == "ramp" else 1e-12
            assert loop.area == pytest.approx(abs(np.trapezoid(force[at], X[at])), abs=error)
            assert set(loop.force) <= set(force)
            assert np.isnan(loop.friction)


def test_a_loop_under_a_load_that_changes():
    """The force is that of the run: mean load times friction gave 23 mJ, of 3.3 N at most.

    On a spring of 1 N/mm a leg back over 10 mm takes up 4 mm at 2 N and 2 mm at 1 N; each time the
    mass starts to slide with the delay of the damper, c/k = 20 ms, or 40 um.
    """
    legs = [p.Constant(duration=5.0), p.Reversal(5.0), p.Reversal(5.0)]
    load = p.LoadProgram(program=[p.Constant(duration="10 s"), p.Constant("5 N", "5 s")])
    slider = on_a_line(
        mass=0.25, k_x=1e3, c_x=20.0, friction=st.Coulomb(0.2), normal_load=10.0, load=load,
        drive=p.DriveProgram(velocity="2 mm/s", program=legs), driven="spring",
    )  # fmt: skip
    run = st.simulate(slider, sample_rate=500.0)
    found = st.analysis.hysteresis(run)
    (loop,) = found.loops
    assert loop.force == pytest.approx(run.samples["spring_x"][run.samples["time"] >= 5.0 - 1e-9])
    assert loop.area == pytest.approx(2.0 * 6e-3 + 1.0 * 8e-3, abs=(2.0 + 2.0) * 40e-6)
    assert np.isnan(loop.friction)
    assert "none" in str(found)


def test_a_harmonic_drive_has_loops_if_it_is_sampled():
    shake = p.DriveProgram(along=p.Modulation("3 mm/s", "1 Hz"))
    for rate, count in ((200.0, 4), (3.0, 0)):
        time = np.arange(0.0, 5.0, 1.0 / rate)
        record = st.Record(time=time, force=np.sin(2 * np.pi * time), normal_load=10.0)
        if count:
            found = st.analysis.hysteresis(record, shake)
            assert len(found.loops) == count
            # an ellipse of 1 N and 3 mm/s over 2 pi Hz
            area = np.pi * 1.0 * 3e-3 / (2 * np.pi)
            assert [each.area for each in found.loops] == pytest.approx([area] * count, rel=1e-2)
        else:
            with pytest.raises(st.ResultError, match="raise the sample rate"):
                st.analysis.hysteresis(record, shake)


def test_a_record_before_the_test_has_no_loop():
    record = st.Record(time=[-3.0, -2.0, -1.0], force=[0.0, 1.0, 0.0], normal_load=10.0)
    with pytest.raises(st.ResultError, match="does not turn twice"):
        st.analysis.hysteresis(record, p.reversal_loops("1 mm/s", "5 mm"))


def test_a_loop_that_ends_elsewhere_is_said_to():
    time = np.arange(0.0, 12.0, 1e-2)
    record = st.Record(time=time, force=np.sin(time), normal_load=10.0)
    found = st.analysis.hysteresis(record, p.reversal_loops("1 mm/s", "5 mm", loops=1))
    assert not found.loops[0].closed
    assert "Not closed, since the drive ends elsewhere than it began: loop 1." in str(found)


def friction_of(program: p.DriveProgram, time: np.ndarray) -> np.ndarray:
    """Return friction of the ageing law on a rigid rig; 0.5 in holds."""
    samples, ends = time, [end for end, _ in drive_stretches(program) if end < time[-1]]
    time = np.union1d(time, ends)
    v = np.abs(np.asarray(program.rate(0.5 * (time[1:] + time[:-1]))[0])) * np.ones(len(time) - 1)
    way = np.sign(np.asarray(program.rate(0.5 * (time[1:] + time[:-1]))[0]))
    state, mu = D / v[0], np.empty(len(time))
    mu[0] = 0.6 + (A - B) * np.log(v[0] / V)
    for n, (speed, dt) in enumerate(zip(v, np.diff(time), strict=True), 1):
        if speed == 0.0:
            state += dt
            mu[n] = 0.5
            continue
        rest = np.exp(-speed * dt / D)
        state = D / speed + (state - D / speed) * rest
        mu[n] = 0.6 + A * np.log(speed / V) + B * np.log(V * state / D)
    mu[1:] *= np.where(way == 0.0, 1.0, way)
    return mu[np.searchsorted(time, samples)]


def drive_of_steps(draw: Draw) -> tuple[p.DriveProgram, list[float]]:
    """Return a drive of jumps, ramps and harmonics, and the times of jumps between constants."""
    now, pieces, jumps, t, flat = V, [p.Constant(V, 15.0)], [], 15.0, True
    for _ in range(5):
        kind = draw.among(["constant", "constant", "ramp", "harmonic"])
        to = now * draw.among([0.3, 0.5, 2.0, 3.0])
        lasts = 15.0 * D / min(now, to)
        if kind == "constant":
            pieces.append(p.Constant(to, lasts))
            jumps += [t] if flat else []
        elif kind == "ramp":
            pieces.append(p.Ramp(to, lasts))
        else:
            pieces.append(p.Harmonic(0.5 * now, 0.31, "0 deg", lasts))
        now = now if kind == "harmonic" else to
        flat = kind == "constant"
        t += lasts
        if not flat:
            pieces.append(p.Constant(now, 15.0 * D / now))
            t += 15.0 * D / now
            flat = True
    return p.DriveProgram(velocity=V, program=pieces), jumps


def test_only_jumps_between_constant_speeds_are_steps():
    """A ramp gave a = 0.0035 and -0.0012 for 0.010, a border under a harmonic 0.31.

    The first sample comes up to a hundredth of D_c after the jump, of which b takes 1.5 %.
    """
    for number in range(6):
        program, jumps = drive_of_steps(Draw(SEED, number))
        end = p.end(program)
        fastest = max(float(program.rate(t)[0]) for t in np.linspace(0.0, end, 999))
        time = np.arange(0.0, end, max(0.01 * D / fastest, end / 4e4))
        record = st.Record(
            time=time, force=friction_of(program, time), normal_load=1.0, stiffness=1e9
        )
        if not jumps:
            with pytest.raises(st.ResultError, match="does not step"):
                st.analysis.velocity_steps(record, program)
            continue
        found = st.analysis.velocity_steps(record, program)
        assert [each.time for each in found.steps] == pytest.approx(jumps)
        for each in found.steps:
            assert each.a_minus_b == pytest.approx(A - B, rel=0.03)
            assert each.b == pytest.approx(B, rel=0.05)
            assert each.D_c == pytest.approx(D, rel=0.05)
        assert (len(found.left_out) > 0) == (len(found.steps) < len(program.program) - 1)


def drive_of_holds(draw: Draw) -> tuple[p.DriveProgram, list[float], int]:
    """Return slides and holds, how long the holds between equal slides last, and their number."""
    now, pieces, good, count = V, [p.Constant(V, 15.0)], [], 4
    for _ in range(count):
        hold = draw.decades(3.0, 300.0)
        to = now * draw.among([1.0, 1.0, -1.0, 3.0, 0.5])
        pieces += [p.Hold(hold), p.Constant(to, 15.0 * D / abs(to))]
        good += [hold] if to == now else []
        now = to
    return p.DriveProgram(velocity=V, program=pieces), good, count


def test_only_holds_between_equal_slides_show_healing():
    """After a turn of the drive the gain was -0.05; after a step it had the direct effect in it.

    By the first sample, up to 0.05 D_c after the hold, friction has lost 5 % of b at most for each
    e-fold of it, of which there are log(300 s V/D_c) or fewer.
    """
    for number in range(8):
        program, good, count = drive_of_holds(Draw(SEED, number))
        time = np.arange(0.0, p.end(program), 0.015)
        record = st.Record(time=time, force=friction_of(program, time), normal_load=1.0)
        if not good:
            with pytest.raises(st.ResultError, match="no hold between two slides"):
                st.analysis.healing(record, program)
            continue
        found = st.analysis.healing(record, program)
        assert found.hold == pytest.approx(good)
        speed = V * np.exp((found.steady - 0.6) / (A - B))
        gain = B * np.log1p(found.hold * speed / D)
        assert found.gain == pytest.approx(gain, abs=0.05 * B * np.log(300.0))
        assert (len(found.left_out) > 0) == (len(good) < count)


def elastic_force(force: float, mu_W: float, steps: int, rise: float) -> np.ndarray:
    """Return the force of a spring that is loaded up to friction, or falls to it at once."""
    return np.minimum(min(force, mu_W) + rise * np.arange(1, steps + 1), mu_W)


def levels_and_force(draw: Draw) -> tuple[list[float], float, p.LoadProgram, np.ndarray]:
    """Return levels, at which the force reaches friction or not, every 10 ms at 1 N/s."""
    levels = [draw.between(10.0, 60.0) for _ in range(5)]
    hold = round(draw.decades(1.0, 40.0), 2)
    force, parts = 0.0, [np.zeros(1)]
    for level in levels:
        for lasts in (0.01, hold):
            parts.append(elastic_force(force, MU * level, round(lasts / 0.01), 0.01))
            force = float(parts[-1][-1])
    return levels, hold, p.load_ramp(levels, ramp=0.01, hold=hold), np.concatenate(parts)


@pytest.mark.parametrize("known", [{}, {"stiffness": 1e3, "drive_velocity": 1e-3}])
def test_a_spring_that_is_still_loaded_shows_no_friction(known):
    """Two levels of 20 N and 60 N, each for 5 s, gave 0.117 for 0.2.

    A mass that breaks away in the end of a level lowers its mean by 2 % at most: 1 % of the loading
    in all of it where the force is all that is known, 0.4 % where the stiffness is.
    """
    counted, refused = 0, []
    for number in range(20):
        levels, hold, load, force = levels_and_force(Draw(SEED, number))
        time = 0.01 * np.arange(len(force))
        record = st.Record(time=time, force=force, normal_load=10.0, **known)
        try:
            found = st.analysis.load_dependence(record, load)
        except st.ResultError as error:
            refused.append(str(error))
            continue
        counted += len(found.load)
        assert found.force == pytest.approx(MU * found.load, abs=0.01 * hold)
        assert (len(found.left_out) > 0) == (len(found.load) < len(levels))
    assert counted > 20
    assert refused
    for said in refused:
        assert "fewer than two levels of the load are held while the mass slides" in said
        assert "left out at" in said


def test_the_force_of_a_level_is_that_of_one_speed():
    load = p.load_ramp([20.0, 40.0, 30.0], ramp="0.2 s", hold="1 s")
    pieces = [p.Constant("50 mm/s", 2.4), p.Constant("5 mm/s", 0.6), p.Hold()]
    slider = on_a_line(
        mass=1e-3, k_x=1e4, c_x=5.0, friction=st.Coulomb(0.3), normal_load=10.0, load=load,
        drive=p.DriveProgram(velocity="50 mm/s", program=pieces), driven="spring",
    )  # fmt: skip
    found = st.analysis.load_dependence(st.simulate(slider, duration=3.6, sample_rate=1e3))
    assert found.load == pytest.approx([20.0, 40.0])
    assert found.coefficient == pytest.approx(0.3, rel=1e-6)
    assert "The drive has another speed: left out at 30 N." in str(found)
    assert "The drive rests: left out at 30 N." in str(found)


def test_apparent_friction_needs_one_velocity_and_one_load():
    from stiction.arrays import xr

    data = xr.Dataset(
        {name: ("phi", np.ones(2)) for name in ("mean_force", "peak_force", "amplitude")},
        {"phi": ("phi", [0.0, 1.0], {"units": "deg"})},
    )
    slider = st.presets.nakano_popov_2020()
    assert st.analysis.apparent_friction(data, slider).mean == pytest.approx(0.1)
    for change in (
        {"load": p.load_ramp([20.0], ramp="1 s")},
        {"drive": p.velocity_steps(["1 mm/s", "2 mm/s"], duration="1 s")},
        {"drive": p.DriveProgram(velocity=1e-3, along=p.Modulation(1e-3, 1.0))},
    ):
        with pytest.raises(st.ResultError, match="give a constant velocity"):
            st.analysis.apparent_friction(data, slider.replace(**change))
