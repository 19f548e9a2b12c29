"""Corners: no drive, no misalignment, right angle, no friction, nonsense."""

import subprocess
import sys

import numpy as np
import pytest
from tests.waiting import PATIENCE

import stiction as st


def slider(**changes) -> st.Slider:
    return st.presets.nakano_popov_2020().replace(**changes)


def test_no_drive_stays_at_rest():
    run = st.simulate(slider(drive=st.ConstantVelocity(0.0)), 1.0, sample_rate=10)
    assert run.status.ok
    assert (run.data["sticking"] == 1).all()
    assert run.stick_intervals.tolist() == [[0.0, 1.0]]
    assert np.isnan(run.data["theta"]).all()  # no force, no direction


def test_no_misalignment_is_one_dimensional():
    run = st.simulate(slider(phi="0 deg"), 5.0, sample_rate=1e3)
    assert run.status.ok
    assert (run.data["u_y"] == 0).all()
    # a classical stick-slip oscillator: real stick until k_x u_x = mu_0 W
    assert run.stick_intervals[0, 1] == pytest.approx(2.0, rel=1e-9)


def test_right_angle():
    """phi = 90 deg is phi = 0 with the stiffnesses exchanged."""
    swapped = slider(phi="90 deg", k_x=1e7, k_y=1e3)
    one = st.simulate(slider(phi="0 deg"), 5.0, sample_rate=1e3)
    other = st.simulate(swapped, 5.0, sample_rate=1e3)
    assert np.array_equal(one.data["u_x"].values, other.data["u_y"].values)
    assert (other.data["u_x"] == 0).all()


def test_isotropic_spring_knows_no_misalignment():
    straight = st.simulate(slider(k_y=1e3, phi="0 deg"), 5.0, sample_rate=1e3, rtol=1e-9)
    turned = st.simulate(slider(k_y=1e3, phi="30 deg"), 5.0, sample_rate=1e3, rtol=1e-9)
    np.testing.assert_allclose(turned.data["X"], straight.data["X"], atol=1e-9)
    np.testing.assert_allclose(turned.data["Y"], 0, atol=1e-15)


def instants(time):
    """Floats around a time."""
    return (time + n * np.spacing(time) for n in range(-1, 4))


def test_a_run_may_end_at_the_instant_at_which_a_stick_does():
    """Floats show no slip yet: steps that were to find one never ended."""
    system = slider()
    whole = st.simulate(system, 0.02, sample_rate=0)
    for times in whole.stick_intervals[1:].T:
        for end in (float(each) for time in times for each in instants(time)):
            run = st.simulate(system, end, sample_rate=0, max_steps=10_000)
            assert (run.status, float(run.samples["time"][-1])) == (st.Status.COMPLETED, end)
            begun = whole.stick_intervals[:, 0] < end
            assert run.stick_intervals[:-1] == pytest.approx(whole.stick_intervals[begun][:-1])


def test_a_run_may_end_at_the_instant_at_which_slip_touches_zero():
    """With constant friction, along a spring: the mass stops once in each period, for no time."""
    system = slider(friction=st.Coulomb(0.2), phi="0 deg")
    period = 2.0 * np.pi * np.sqrt(system.mass / system.k_x)
    for touch in (2.0 + n * period for n in (1, 5, 12)):
        for end in instants(touch):
            run = st.simulate(system, float(end), sample_rate=0, max_steps=10_000)
            assert (run.status, len(run.stick_intervals)) == (st.Status.COMPLETED, 1)


def test_backwards_is_forwards_mirrored():
    forth = st.simulate(slider(), 0.1, sample_rate=1e4)
    back = st.simulate(slider(drive=st.ConstantVelocity("-1 mm/s")), 0.1, sample_rate=1e4)
    np.testing.assert_allclose(back.data["u_y"], -forth.data["u_y"], rtol=1e-12)


def test_without_friction_the_mass_swings_for_ever():
    frictionless = slider(
        friction=st.Coulomb(mu_0=0.0), drive=st.ConstantVelocity(0.0), phi="0 deg"
    )
    omega = np.sqrt(1e3 / 0.25)
    start = st.Initial(u_x=1e-3, v_x=0.0, v_y=0.0)
    run = st.simulate(
        frictionless, 20 * 2 * np.pi / omega, sample_rate=1e3, rtol=1e-10, initial=start
    )
    want = 1e-3 * np.cos(omega * run.data["time"].values)
    # twenty periods, local tolerance 1e-8: phase errors add up
    np.testing.assert_allclose(run.data["u_x"], want, atol=1e-3 * 1e-6)


def test_strengthening_slides_steadily():
    run = st.simulate(
        slider(friction=st.ExponentialWeakening(mu_0=0.15, mu_inf=0.2, v_f="10 mm/s")), 5.0
    )
    assert run.status.ok
    F = run.slider.normal_load * run.slider.friction.coefficient(1e-3)
    c, s = run.slider.direction
    # Eq. (1) at rest in the moving frame: K u = F along the drive
    assert float(run.final["spring_x"]) == pytest.approx(F * c, rel=1e-8)
    assert float(run.final["spring_y"]) == pytest.approx(F * s, rel=1e-6)


@pytest.mark.parametrize("mass", [1e-4, 1e3])
@pytest.mark.parametrize("V", [1e-7, 1.0])
@pytest.mark.parametrize("phi", ["0.01 deg", "89 deg"])
@pytest.mark.parametrize("k_y", [1e3, 1e9])
def test_corners_end_with_an_answer(mass, V, phi, k_y):
    system = slider(mass=mass, drive=st.ConstantVelocity(V), phi=phi, k_y=k_y)
    run = st.simulate(system, min(5.0, 5e-3 / V), max_steps=1_000_000)
    assert run.status in (st.Status.COMPLETED, st.Status.TOO_MANY_STEPS)
    assert np.isfinite(run.data["u_y"].values).all()
    if run.status is st.Status.TOO_MANY_STEPS:
        # a cycle takes some twenty steps: tens of thousands of them have been followed
        lasted = float(run.final["time"]) - run.stick_intervals[0, 1]
        cycles = lasted * np.sqrt(k_y / mass) / (2 * np.pi)
        assert cycles > 2e4


class Wild(st.Coulomb):
    """A user's law that breaks down at 1 mm/s of slip."""

    def coefficient(law, v):
        return law.mu_0 if v < 1e-3 else (v - v) / (v - v)

    def slope(law, v):
        return 0.0


def test_a_law_that_breaks_down_ends_the_run_with_a_reason():
    run = st.simulate(slider(friction=Wild(0.2)), 5.0, sample_rate=1e3)
    assert run.status in (st.Status.STEP_UNDERFLOW, st.Status.NON_FINITE)
    assert 2.0 < float(run.final["time"]) < 2.1  # the first rapid slip
    assert np.isfinite(run.data["u_x"].values).all()


def test_regularised_approaches_the_exact_solution():
    """The error of k_x u_x falls with delta as in the project's reference, found with LSODA."""
    exact = st.simulate(slider(), 5.0, sample_rate=1e3, rtol=1e-9)
    reference = {1e-6: 3e-3, 1e-7: 7e-4, 1e-8: 9e-5, 1e-9: 2e-5, 1e-10: 5e-6}
    for delta, want in reference.items():
        run = st.simulate(slider(), 5.0, sample_rate=1e3, rtol=1e-8, regularisation=delta)
        assert run.status.ok
        assert len(run.stick_intervals) == 0
        error = np.abs(run.data["spring_x"].values - exact.data["spring_x"].values).max()
        digit = 10.0 ** np.floor(np.log10(want))
        assert error == pytest.approx(want, abs=0.5 * digit)


PESTERED = """
import itertools, os, signal, threading, time
import stiction as st

slider, simulate = st.presets.nakano_popov_2020(), st.simulate  # what is imported late is there
bristles = slider.replace(friction=st.laws.LuGre(0.15, 0.2, 1e-2, 1e5, 300.0, 0.4))
runs = [(slider, {}), (slider, {"multiscale": True}), (bristles, {})]
wanted, heard = threading.Semaphore(0), []

def pester():
    for gap in itertools.cycle([3e-3, 5e-3, 7e-3, 11e-3, 13e-3]):
        wanted.acquire()
        time.sleep(gap)
        os.kill(os.getpid(), signal.SIGINT)

def hear(*_):
    heard.append(1)
    raise KeyboardInterrupt

signal.signal(signal.SIGINT, hear)
threading.Thread(target=pester, daemon=True).start()
for count in range(300):
    try:
        wanted.release()  # one each time, and it is waited for here: none arrives elsewhere
        for system, how in itertools.cycle(runs):
            simulate(system, 0.02, **how)
            if len(heard) > count:
                break  # lost on the way, as in a finaliser
    except KeyboardInterrupt:
        pass
assert all(simulate(system, 0.02, **how).status.ok for system, how in runs)
"""


def test_interrupts_do_no_harm():
    """From the first run on, which is compiled or loaded: they arrive, and nothing crashes."""
    done = subprocess.run(
        [sys.executable, "-c", PESTERED],
        capture_output=True,
        text=True,
        timeout=PATIENCE,
    )
    assert done.returncode == 0, done.stderr


HELD_BACK = """
import signal
from stiction.solver.compilation.interrupt import delay_interrupt

def interrupted():
    try:
        with delay_interrupt():
            signal.raise_signal(signal.SIGINT)
            print("goes on", end=", ")
        print("and on")
    except KeyboardInterrupt:
        print("ends")

interrupted()
signal.signal(signal.SIGINT, signal.SIG_IGN)
interrupted()
signal.signal(signal.SIGINT, lambda *_: print("told", end=", "))
interrupted()
"""


def test_an_interrupt_that_is_held_back_does_what_it_is_to_do():
    """In a new process: a test may run in a thread that is never interrupted."""
    reset = "import signal; signal.signal(signal.SIGINT, signal.default_int_handler)"
    done = subprocess.run(
        [sys.executable, "-c", reset + HELD_BACK], capture_output=True, text=True, timeout=PATIENCE
    )
    assert done.stdout == "goes on, ends\ngoes on, and on\ngoes on, told, and on\n", done.stderr
