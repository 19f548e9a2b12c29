"""Drives and loads in time: reading, and their signals in the solver.

Runs of one dimension have phi = 0 and nothing moving along y.
"""

from math import atan, cos, inf, pi, sin, sqrt

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq
from tests.drawn import inside

import stiction as st
from stiction.drive.signal import Signal
from stiction.solver.accuracy import tolerance

RTOL = 1e-10
EVERY_PIECE = [
    st.protocols.Constant(duration=0.5),
    st.protocols.Hold(0.2),
    st.protocols.Ramp(2e-3, 0.3),
    st.protocols.Reversal(0.5),
    st.protocols.Step(1e-3, 0.1),
    st.protocols.Harmonic(1e-3, 20.0, "90 deg", 0.5),
    st.protocols.Free(),
]


def block(**changes):
    """m = k = mu = W = 1, at rest."""
    values = {"mass": 1.0, "k_x": 1.0, "k_y": 1.0, "phi": "0 deg", "normal_load": 1.0}
    return st.Slider(**(values | {"friction": st.Coulomb(1.0)} | changes))


def first_release(slider, end, **initial):
    start = st.Initial(v_x=slider.motion.rate(0.0)[0], v_y=0.0, **initial)
    run = st.simulate(slider, end, initial=start, rtol=RTOL)
    assert run.status.ok
    assert run.stick_intervals[0, 0] == 0.0
    return run.stick_intervals[0, 1]


# --- when a stick ends: |K u + C v_d + m dv_d/dt| = mu W(t), to rounding ------------------------


@pytest.mark.parametrize(("driven", "inertia"), [("plate", 1.0), ("spring", 0.0)])
def test_an_accelerated_drive_uses_friction_up_by_its_inertia(driven, inertia):
    a, c = 0.3, 0.5
    ramp = st.protocols.DriveProgram(program=[st.protocols.Ramp(10 * a, 10.0)])
    # k a t^2/2 + c a t + m a = mu W
    wanted = -c + sqrt(c * c + 2 * (1.0 / a - inertia))
    found = first_release(block(drive=ramp, c_x=c, driven=driven), 9.0)
    assert found == pytest.approx(wanted, rel=1e-13)


def test_a_drive_that_accelerates_more_than_friction_holds_slips_at_once():
    ramp = st.protocols.DriveProgram(program=[st.protocols.Ramp(20.0, 10.0)])  # m a = 2 mu W
    run = st.simulate(block(drive=ramp), 0.1, initial=st.Initial(v_x=0.0, v_y=0.0))
    assert len(run.stick_intervals) == 0


def test_a_rising_load_prolongs_a_stick_and_a_falling_one_ends_it():
    V, W = 0.5, 0.2
    for rate in (W, -W):
        load = st.protocols.LoadProgram(program=[st.protocols.Ramp(1.0 + 4 * rate, 4.0)])
        slider = block(drive=st.ConstantVelocity(V), load=load)
        assert first_release(slider, 5.0) == pytest.approx(1.0 / (V - rate), rel=1e-13)


@pytest.mark.parametrize("driven", ["plate", "spring"])
def test_a_harmonic_drive_releases_at_the_root(driven):
    A, omega, c = 0.2, 3.0, 0.1
    drive = st.protocols.DriveProgram(
        velocity=0.4,
        along=st.protocols.Modulation(A, omega / (2 * pi)),
        program=[st.protocols.Constant()],
    )
    inertia = 1.0 if driven == "plate" else 0.0

    def pull(t):
        u = 0.4 * t + A / omega * (1 - cos(omega * t))
        v, dv = 0.4 + A * sin(omega * t), A * omega * cos(omega * t)
        return u + c * v + inertia * dv - 1.0

    wanted = brentq(pull, 0.5, 2.5, xtol=1e-14)
    grid = np.linspace(0.0, wanted - 1e-6, 1000)
    assert max(pull(t) for t in grid) < 0.0  # the first root
    slider = block(drive=drive, c_x=c, driven=driven)
    assert first_release(slider, 3.0) == pytest.approx(wanted, rel=1e-12)


@pytest.mark.parametrize("excess", [-1e-9, 1e-9])
def test_a_load_that_all_but_releases_a_stick(excess):
    """The limit touches the force that is held for an instant: nothing is stepped over."""
    load = st.protocols.LoadProgram(modulation=st.protocols.Modulation(0.25, 7.0))
    slider = block(load=load, driven="spring")
    held = 0.75 + excess  # the smallest limit is 0.75
    run = st.simulate(slider, 1.0, initial=st.Initial(u_x=held, v_x=0.0, v_y=0.0), rtol=RTOL)
    if excess < 0:
        assert run.stick_intervals.tolist() == [[0.0, 1.0]]
    else:
        at = brentq(lambda t: 1 + 0.25 * sin(14 * pi * t) - held, 0.5 / 7, 0.75 / 7, xtol=1e-15)
        assert run.stick_intervals[0, 1] == pytest.approx(at, abs=1e-9)  # flat: sqrt of rounding
        assert len(run.stick_intervals) > 1


def test_a_long_hold_under_vibration_is_one_stick():
    """Far more looks at the margin than the solver takes at once."""
    drive = st.protocols.DriveProgram(across=st.protocols.Modulation(0.5, 100.0))
    slider = block(drive=drive, driven="spring", k_y=500.0)  # 0.8 of what friction holds
    run = st.simulate(slider, 100.0, initial=st.Initial(v_x=0.0, v_y=0.0))
    assert run.stick_intervals.tolist() == [[0.0, 100.0]]
    assert run.statistics.stick_count == 1


def test_static_friction_above_kinetic_is_the_classical_stick_slip():
    """u'' + u = F_k in slip from u = F_s: s = V (1 - cos t) + (F_s - F_k) sin t, until zero."""
    V, F_s, F_k = 0.1, 1.0, 0.6
    law = st.Coulomb(mu_0=F_k, mu_static=F_s)
    slider = block(friction=law, drive=st.ConstantVelocity(V))
    slip = 2 * (pi - atan((F_s - F_k) / V))
    stick = 2 * (F_s - F_k) / V
    run = st.simulate(slider, F_s / V + 3 * (slip + stick), rtol=RTOL)
    starts, ends = run.stick_intervals.T
    assert ends[0] == pytest.approx(F_s / V, rel=1e-13)
    assert starts[1:] - ends[:-1] == pytest.approx(slip, rel=1e-8)
    assert (ends - starts)[1:3] == pytest.approx(stick, rel=1e-8)


def test_a_slip_that_just_reaches_zero_sticks():
    """At the end of a long step the slip passes zero by less than the step's error, and comes back.

    With a separate static coefficient it must stick there instead.
    """
    slider = st.Slider(
        mass=8.94792999996374,
        k_x=452.68104590594845,
        k_y=3743.147980642082,
        phi="0.7748910787320815 rad",
        normal_load=12.983110609547198,
        c_y=5.0,
        driven="spring",
        friction=st.Coulomb(0.39522531523021254, 0.4149865809917232),
        drive=st.protocols.DriveProgram(
            velocity=0.0063489482656108555,
            program=[
                st.protocols.Ramp(-0.0022111294105426373, 1.4723077426369873),
                st.protocols.Step(0.0063489482656108555, 0.9804034052159277),
            ],
        ),
        load=st.protocols.LoadProgram(
            program=[
                st.protocols.Ramp(23.19395605788644, 2.179074711819254),
                st.protocols.Step(-0.09835262495723726, 0.3215822848899921),
            ],
            modulation=st.protocols.Modulation(1.4278724090988686, 0.868316320619524),
        ),
    )
    exact = st.simulate(slider, 5.0, rtol=1e-10)
    for rtol in (1e-5, 1e-6, 1e-7):
        run = st.simulate(slider, 5.0, rtol=rtol)
        assert len(run.stick_intervals) == len(exact.stick_intervals) == 8
        # a slip grows for 0.6 s, 2 radians, from the error of the step in which it starts
        assert run.stick_intervals == pytest.approx(exact.stick_intervals, abs=25 * tolerance(rtol))


# --- jumps ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("driven", ["plate", "spring"])
def test_what_jumps_with_a_drive(driven):
    """The mass keeps its velocity: over a driven plate the slip jumps, else the elongation rate."""
    slider = block(
        friction=st.Coulomb(0.1),
        driven=driven,
        drive=st.protocols.DriveProgram(
            velocity=0.5, program=[st.protocols.Constant(duration=1.0), st.protocols.Step(0.25)]
        ),
    )
    sliding = st.Initial(u_x=0.1, v_x=0.1, v_y=0.0)
    before = st.simulate(slider, 1.0, initial=sliding, rtol=RTOL)
    after = st.simulate(slider, 1.0 + 1e-9, initial=sliding, rtol=RTOL).final
    kept, jumped = ("v_x", "slip_x") if driven == "plate" else ("slip_x", "v_x")
    assert float(after[kept]) == pytest.approx(float(before.final[kept]), abs=1e-8)
    assert float(after[jumped] - before.final[jumped]) == pytest.approx(0.25, abs=1e-8)
    restarted = st.simulate(slider, 1e-9, initial=before.state(1.0), rtol=RTOL).final
    for name in ("u_x", "v_x", "slip_x", "X"):
        assert float(restarted[name]) == pytest.approx(float(after[name]), abs=1e-12)


def test_a_program_is_its_pieces_one_after_the_other(slider):
    """Run in one go, or restarted at each break with a constant drive: the same to the tolerance.

    And the sticks that go on over a break are one.
    """
    V = 1e-3
    hold = st.protocols.DriveProgram(
        velocity=V,
        program=[
            st.protocols.Constant(duration=0.03),
            st.protocols.Hold(0.02),
            st.protocols.Constant(),
        ],
    )
    whole = st.simulate(slider.replace(drive=hold, driven="spring"), 0.08, rtol=1e-9)
    state, sticks, last = st.Initial(), [], None
    for velocity, duration in ((V, 0.03), (0.0, 0.02), (V, 0.03)):
        part = slider.replace(drive=st.ConstantVelocity(velocity), driven="spring")
        if last is not None:
            # over the spring's end the slip goes on: the elongation rate jumps
            c, s = slider.direction
            slip = (float(last["slip_x"]), float(last["slip_y"]))
            changes = {"v_x": velocity * c - slip[0], "v_y": velocity * s - slip[1]}
            state = st.Initial(**(state.model_dump(exclude_unset=True) | changes))
        run = st.simulate(part, duration, initial=state, rtol=1e-9)
        last, state = run.final, run.state(run.final["time"].item())
        sticks += run.stick_intervals.tolist()
    for name in ("u_x", "u_y"):
        assert float(whole.final[name]) == pytest.approx(float(last[name]), rel=1e-7)
    assert np.all(np.diff(whole.stick_intervals.ravel()) > 0)
    total = sum(end - start for start, end in sticks)
    assert np.diff(whole.stick_intervals).sum() == pytest.approx(total, rel=1e-6)
    assert whole.statistics.stick_count == len(whole.stick_intervals) < len(sticks)
    assert whole.statistics.time_stuck == pytest.approx(total, rel=1e-6)


def test_free_springs_relax_to_rest(slider):
    """Drive stopped: the spring keeps what friction can hold, and nothing moves any more."""
    drive = st.protocols.DriveProgram(
        velocity=1e-3, program=[st.protocols.Constant(duration=1.0), st.protocols.Free()]
    )
    run = st.simulate(slider.replace(drive=drive), 1.5, sample_rate=1e3)
    assert run.stick_intervals[-1, 1] == 1.5
    after = run.data.sel(time=slice(run.stick_intervals[-1, 0] + 1e-3, None))
    assert len(after["time"]) > 400
    assert np.ptp(after["X"].values) == 0.0
    assert float(run.final["friction"]) <= slider.F_0 * (1 + 1e-12)


# --- loss of contact ----------------------------------------------------------------------------


def test_a_run_ends_where_the_contact_is_lost(slider):
    load = st.protocols.LoadProgram(program=[st.protocols.Hold(0.1), st.protocols.Ramp(-10.0, 0.4)])
    run = st.simulate(slider.replace(load=load), 1.0, sample_rate=1e3)
    assert run.status is st.Status.CONTACT_LOST
    assert "load" in run.status.value
    assert float(run.data["time"][-1]) == pytest.approx(0.3, rel=1e-12)
    assert np.all(np.diff(run.data["time"].values) > 0)
    assert np.isfinite(run.data["u_x"].values).all()
    # a load that only touches zero does not lose contact before it does
    swing = st.protocols.LoadProgram(modulation=st.protocols.Modulation(9.999999, 10.0))
    assert st.simulate(slider.replace(load=swing), 0.2).status.ok
    swing = st.protocols.LoadProgram(modulation=st.protocols.Modulation(10.000001, 10.0))
    assert st.simulate(slider.replace(load=swing), 0.2).status is st.Status.CONTACT_LOST


def test_a_load_that_is_gone_at_once(slider):
    load = st.protocols.LoadProgram(
        program=[st.protocols.Constant(duration=0.1), st.protocols.Step(-20.0)]
    )
    run = st.simulate(slider.replace(load=load), 1.0, sample_rate=1e3)
    assert run.status is st.Status.CONTACT_LOST
    assert float(run.data["time"][-1]) == pytest.approx(0.1, rel=1e-12)


# --- against the smoothed law, which knows neither stick nor stretches --------------------------


@pytest.mark.parametrize("driven", ["plate", "spring"])
def test_every_piece_against_the_smoothed_law(slider, driven):
    """The smoothed law's error falls with about delta^(4/5): towards this solution."""
    every = slider.replace(
        k_y="100 kN/m",
        phi="5 deg",
        c_x=2.0,
        c_y=5.0,
        driven=driven,
        friction=st.Coulomb(0.2),
        drive=st.protocols.DriveProgram(
            velocity="1 mm/s",
            program=EVERY_PIECE,
            across=st.protocols.Modulation("0.5 mm/s", "35 Hz"),
        ),
        load=st.protocols.LoadProgram(
            program=[
                st.protocols.Ramp("5 N", "0.7 s"),
                st.protocols.Step("6 N", "0.5 s"),
                st.protocols.Hold("0.1 s"),
            ],
            modulation=st.protocols.Modulation("1 N", "50 Hz"),
        ),
    )
    exact = st.simulate(every, 2.5, sample_rate=1e3, rtol=1e-9)
    assert exact.status.ok
    errors = []
    for delta in (1e-7, 1e-8, 1e-9):
        smooth = st.simulate(every, 2.5, sample_rate=1e3, rtol=1e-12, regularisation=delta)
        errors.append(float(abs(smooth.data["spring_y"] - exact.data["spring_y"]).max()))
    assert errors[1] < 10**-0.7 * errors[0]
    assert errors[2] < 10**-0.7 * errors[1]


# --- signals -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("value", "slope", "a", "omega", "phase", "b", "nu"),
    inside(50, (-2, 2), (-2, 2), (0, 2), (0.1, 30), (-pi, pi), (0, 2), (0.1, 30)),
)
def test_a_signal_its_integral_derivative_and_bounds(value, slope, a, omega, phase, b, nu):
    signal = Signal(0.3, value, slope, a, omega, phase, b, nu, 0.7)
    t, dt = 0.4, 0.6
    total, _ = quad(lambda x: signal.value_at(x), t, t + dt, epsabs=1e-12, limit=200)
    assert signal.sum_over(t, dt) == pytest.approx(total, abs=1e-10)
    step = 1e-5
    centred = (signal.value_at(t + step) - signal.value_at(t - step)) / (2 * step)
    assert signal.change_at(t) == pytest.approx(centred, abs=1e-4)
    times = np.linspace(t, t + dt, 200)
    bounds = signal.bounds_between(t, t + dt)
    assert np.abs(signal.value_at(times)).max() <= bounds[0] + 1e-12
    assert np.abs(signal.change_at(times)).max() <= bounds[1] + 1e-12
    tiny = 1e-12  # no cancellation
    assert signal.sum_over(t, tiny) == pytest.approx(signal.value_at(t) * tiny, abs=1e-22)


def test_a_drive_s_travel_is_the_integral_of_its_rate():
    drive = st.protocols.DriveProgram(
        velocity=1e-3, program=EVERY_PIECE, repeat=1, across=st.protocols.Modulation(5e-4, 35.0)
    )
    for i in (0, 1):
        total, _ = quad(lambda t, i=i: drive.rate(t)[i], 0.0, 2.3, limit=2000, points=[0.5, 0.7])
        assert drive.travel(0.0, 2.3)[i] == pytest.approx(total, abs=1e-9)
    times = np.linspace(0.0, 2.3, 7)
    X, Y = drive.rate(times)
    assert X.tolist() == [float(drive.rate(t)[0]) for t in times]
    assert Y.tolist() == [float(drive.rate(t)[1]) for t in times]


def test_ten_thousand_pieces_cost_no_more_each():
    """Travel and rate at any time, without a walk through all that went before."""
    drive = st.protocols.DriveProgram(
        velocity=1e-3,
        program=[st.protocols.Constant(duration=1e-3), st.protocols.Reversal(1e-3)],
        repeat=10_000,
    )
    times = np.linspace(0.0, 20.0, 200_001)
    travelled, _ = drive.travel(0.0, times)
    wave = 1e-3 * (1e-3 - np.abs(times % 2e-3 - 1e-3))
    # the breaks are sums of so many durations: 20,000 roundings of 20 s, at 1 mm/s
    assert np.abs(travelled - wave).max() <= 2e4 * 2.2e-16 * 20.0 * 1e-3
    assert float(drive.rate(19.9995)[0]) == -1e-3
    with pytest.raises(st.DescriptionError, match="has no end"):
        st.protocols.DriveProgram(velocity=1.0, program=[st.protocols.Hold()], repeat=2)


def test_pieces_follow_on_from_each_other():
    base = 2.0
    drive = st.protocols.DriveProgram(
        velocity=base,
        program=[
            st.protocols.Ramp(5.0, 1.0),
            st.protocols.Reversal(1.0),
            st.protocols.Step(1.0, 1.0),
            st.protocols.Hold(1.0),
            st.protocols.Constant(duration=1.0),
        ],
        repeat=2,
    )
    middle = [float(drive.rate(n + 0.5)[0]) for n in range(11)]
    assert middle == [3.5, -5.0, -4.0, 0.0, 2.0] * 2 + [2.0]
    load = st.protocols.LoadProgram(
        program=[st.protocols.Ramp(20.0, 1.0), st.protocols.Hold(1.0), st.protocols.Step(-5.0)]
    )
    ends, signals = zip(*load.stretches_from(10.0), strict=True)
    assert ends == (1.0, 2.0, inf)
    assert [signal.at(end) for end, signal in zip((1.0, 2.0, 3.0), signals, strict=True)] == [
        20.0,
        20.0,
        15.0,
    ]


# --- descriptions --------------------------------------------------------------------------------

TOML = """
[slider]
mass = "0.25 kg"
k_x = "1 kN/m"
k_y = "10 MN/m"
phi = "1 deg"
normal_load = "10 N"
driven = "spring"
[friction]
law = "coulomb"
mu_0 = 0.2
mu_static = 0.25
[friction.anisotropy]
ratio = 1.5
angle = "30 deg"
[drive]
velocity = "1 mm/s"
repeat = 2
program = [
  { piece = "constant", duration = "2 s" },
  { piece = "hold", duration = "10 s" },
  { piece = "harmonic", amplitude = "1 mm/s", frequency = "5 Hz", phase = "90 deg", duration = 1 },
]
across = { amplitude = "2 mm/s", frequency = "1 kHz" }
[load]
modulation = { amplitude = "1 N", frequency = "50 Hz" }
[[load.program]]
piece = "ramp"
to = "20 N"
duration = "1 s"
[run]
duration = "30 s"
"""


def test_programs_in_toml_and_in_python_are_the_same(tmp_path):
    (tmp_path / "a.toml").write_text(TOML)
    read = st.Description.from_toml(tmp_path / "a.toml")
    assert read.slider == st.Slider(
        mass=0.25,
        k_x=1e3,
        k_y=1e7,
        phi="1 deg",
        normal_load=10.0,
        driven="spring",
        friction=st.laws.Anisotropic(st.Coulomb(0.2, 0.25), 1.5, "30 deg"),
        drive=st.protocols.DriveProgram(
            velocity="1 mm/s",
            repeat=2,
            program=[
                st.protocols.Constant(duration="2 s"),
                st.protocols.Hold("10 s"),
                st.protocols.Harmonic("1 mm/s", "5 Hz", "90 deg", 1.0),
            ],
            across=st.protocols.Modulation("2 mm/s", "1 kHz"),
        ),
        load=st.protocols.LoadProgram(
            modulation=st.protocols.Modulation("1 N", "50 Hz"),
            program=[st.protocols.Ramp("20 N", "1 s")],
        ),
    )
    assert st.Description.from_json(read.to_json()) == read
    assert st.Slider.from_toml(tmp_path / "a.toml") == read.slider


def test_faults_in_programs_are_named(tmp_path):
    bad = (
        TOML.replace('piece = "hold", duration = "10 s"', 'piece = "hold"')
        .replace('piece = "constant", duration = "2 s"', 'piece = "constnt", duration = "2 s"')
        .replace('amplitude = "2 mm/s"', 'amplitude = "2 N"')
        .replace('to = "20 N"', 'to = "20 mm/s"')
        .replace("mu_static = 0.25", "mu_static = 0.15")
        .replace('driven = "spring"', 'driven = "sprung"')
    )
    (tmp_path / "bad.toml").write_text(bad)
    with pytest.raises(st.DescriptionError) as error:
        st.Description.from_toml(tmp_path / "bad.toml")
    found = {fault.path: fault.message for fault in error.value.faults}
    assert "did you mean 'constant'" in found["drive.program.1.piece"]
    assert "only the last piece" in found["drive.program.2.duration"]
    assert "not a unit of a velocity" in found["drive.across.amplitude"]
    assert "not a unit of a force" in found["load.program.1.to"]
    assert "0.2" in found["friction.mu_static"]
    assert "'plate' or 'spring'" in found["slider.driven"]
    assert len(found) == 6


@pytest.mark.parametrize(
    ("table", "path", "words"),
    [
        ({"ratio": -1}, "friction.anisotropy.ratio", "greater than 0"),
        ({"ratio": 2, "angle": 3}, "friction.anisotropy.angle", "degree or radian"),
        ({"ration": 2}, "friction.anisotropy.ration", "did you mean 'ratio'"),
        (3, "friction.anisotropy", "must be a table"),
    ],
)
def test_faults_in_an_anisotropy_are_named(slider, table, path, words):
    raw = st.Description(slider, st.Initial(), st.Settings(duration=1.0)).to_dict()
    raw["friction"]["anisotropy"] = table
    with pytest.raises(st.DescriptionError) as error:
        st.Description.from_dict(raw)
    assert words in {fault.path: fault.message for fault in error.value.faults}[path]


def test_results_with_programs_are_kept(tmp_path):
    (tmp_path / "a.toml").write_text(TOML.replace('duration = "30 s"', "duration = 0.05"))
    description = st.Description.from_toml(tmp_path / "a.toml")
    run = st.simulate(description.slider, 0.05, sample_rate=1e3)
    again = st.load(run.save(tmp_path / "a.nc"))
    assert again.slider == run.slider
    assert again.data.identical(run.data)


def test_the_frequencies_of_a_program_include_those_of_its_pieces():
    """Pieces of 1 ms that alternate do so at 500 Hz; two by themselves do not.

    A run of 10 s with one pair of 1 us was sampled a million times.
    """
    p = st.protocols
    there, back = p.Constant("2 mm/s", "1 ms"), p.Constant("-1 mm/s", "1 ms")
    rig = st.presets.nakano_popov_2020()

    def frequencies(*pieces, **more):
        return rig.replace(drive=p.DriveProgram(program=pieces, **more)).modulation_frequencies

    assert frequencies(there, back, there) == pytest.approx((500.0,))
    assert frequencies(there, back, repeat=2) == pytest.approx((500.0,))
    assert frequencies(p.Hold("1 s"), there, back, p.Hold("1 s")) == pytest.approx((1.0 / 1.001,))
    assert frequencies(there, back) == ()
    assert frequencies(there, repeat=9) == pytest.approx((500.0,))
    assert frequencies(there) == frequencies(there, p.Hold()) == ()
    time = np.concatenate([np.arange(50) * 0.1, 5.0 + np.arange(20) * 0.01, [5.3, 5.4]])
    table = p.Recorded(time, velocity=np.full(len(time), 1e-3))
    assert frequencies(table) == pytest.approx((12.5,))


def test_of_pieces_that_are_no_program_it_is_told_how_to_make_one(slider):
    hold = st.protocols.Hold("1 s")
    for value in (hold, [hold], (), 1e-3, "1 mm/s", None, lambda t: 1e-3):
        with pytest.raises(st.DescriptionError, match=r"Slider\.drive.*is not a drive") as error:
            slider.replace(drive=value)
        pieces = value in (hold, [hold], ())
        assert ("st.protocols.DriveProgram(program=[...])" in str(error.value)) == pieces
        assert ("st.ConstantVelocity('1 mm/s')" in str(error.value)) != pieces
    assert slider.replace(drive=st.protocols.DriveProgram(program=[hold])).drive.program == (hold,)
