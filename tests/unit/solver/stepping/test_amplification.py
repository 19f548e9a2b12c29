"""What becomes of small disturbances, against eigenvalues, and linear theory by other code."""

from math import inf

import numpy as np
import pytest
from benchmarks.explore.accuracy import DRAWN
from benchmarks.explore.growth import look
from tests.entry import plain

import stiction as st
from stiction.solver import integrate
from stiction.solver.stepping import amplification
from stiction.solver.stepping.amplification import LONGER, RESOLVED, SHARE, longest_step, slow_modes


def random_rates(rng):
    """Return rates of two oscillators and two stiff states, coupled, over many decades."""
    n, stiff = 6, 10.0 ** rng.uniform(0.0, 12.0, 2)
    rates = rng.normal(size=(n, n)) * 10.0 ** rng.uniform(-3.0, 0.0)
    rates[4:] *= stiff[:, None]
    rates[4, 4], rates[5, 5] = -10.0 * stiff
    scale = 10.0 ** rng.uniform(-4.0, 4.0, n)
    return rates * scale[:, None] / scale


@pytest.mark.parametrize("seed", range(40))
def test_what_grows_is_what_has_a_growing_mode(seed):
    """The trapezoidal rule's verdict, where the growth is clear either way."""
    rng = np.random.default_rng(seed)
    rates, room = random_rates(rng), np.zeros((3, 6, 6))
    modes = slow_modes(rates, 1e-2)
    fastest = float(modes.real.max())
    for left in (0.1 / abs(fastest), 3.0 / abs(fastest)):
        found = plain(amplification.grows)(rates, room, left * 1e-4, left)
        if fastest < 0.0:
            assert not found
        elif fastest * left > 1.0:
            assert found
        else:
            assert fastest * left * LONGER < 10.0
            assert not found


@pytest.mark.parametrize("seed", range(10))
def test_the_inverse_is_one(seed):
    rates = np.random.default_rng(seed).normal(size=(6, 6))
    room, found = np.zeros((6, 6)), np.zeros((6, 6))
    assert plain(amplification.write_inverse)(rates, 0.3, room, found)
    assert found == pytest.approx(np.linalg.inv(np.eye(6) - 0.3 * rates), rel=1e-9, abs=1e-12)
    halves = np.kron(np.diag([1.0, 0.0, 0.0]), np.full((2, 2), 0.5))
    for none in (np.eye(6), np.full((6, 6), inf), halves):
        assert not plain(amplification.write_inverse)(none, 1.0, room, found)


def test_modes_are_those_of_the_matrix():
    """An oscillation that grows slowly, beside rates that are 1e18 times as fast."""
    rates = np.array([[1e-3, 1.0, 0.0], [-1.0, 1e-3, 1e3], [0.0, 1e3, -1e18]])
    modes = slow_modes(rates, 0.5)
    assert sorted(modes, key=np.imag) == pytest.approx([1e-3 - 1j, 1e-3 + 1j], rel=1e-11)


@pytest.mark.parametrize("growth", [1e-6, 1e-4, 1e-2, 0.3])
def test_the_longest_step_shows_the_growth(growth):
    """(M43a): Radau IIA multiplies a mode by R(z), which has most of the growth of exp(z)."""
    rates = np.array([[growth, 1.0], [-1.0, growth]])
    h = longest_step(rates, 1.0, 1e9)
    assert 0.1 < h <= RESOLVED / abs(complex(growth, 1.0))
    mode = complex(growth, 1.0)
    longest = min(1.0, (0.1 * 7200 * growth / abs(mode)) ** 0.2) / abs(mode)
    assert h == pytest.approx(longest, rel=1e-9)  # modes are known to 1e-11
    z = h * mode
    R = (1 + 2 * z / 5 + z * z / 20) / (1 - 3 * z / 5 + 3 * z * z / 20 - z**3 / 60)
    assert np.log(abs(R)) == pytest.approx(z.real, rel=2 * SHARE)


def test_what_does_not_grow_in_time_has_no_limit():
    rates = np.array([[1e-3, 1.0], [-1.0, 1e-3]])
    assert longest_step(rates, 1.0, 900.0) == inf
    assert longest_step(rates, 1.0, 1100.0) < inf
    assert longest_step(-np.eye(2), 1.0, 1e9) == inf
    assert longest_step(np.diag([inf, -1.0]), 1.0, 1e9) == inf
    assert longest_step(np.diag([2.0, -1.0]), 0.5, 1e9) == RESOLVED / 2.0  # 1 - h J is singular


UNSTABLE = [
    *(("state", number) for number in (306, 336, 355, 369)),
    *(("set-valued", number) for number in (18, 189, 343)),
    *(("general", number) for number in (97, 160)),
]


@pytest.mark.parametrize(("kind", "number"), UNSTABLE)
def test_modes_are_those_of_linear_theory(monkeypatch, kind, number):
    """`stiction.linear_stability` has derivatives and eigenvalues of its own."""
    asked = []
    monkeypatch.setattr(integrate, "longest_step", lambda *them: asked.append(them) or inf)
    slider = DRAWN[kind](15, number).slider
    theory = st.linear_stability.steady_sliding(slider)
    fastest = theory.eigenvalues[0]
    start = theory.disturbed_start(1e-12)
    st.simulate(slider, 40.0 / fastest.real, initial=start, sample_rate=0, multiscale=False)
    rates, h, _ = asked[0]
    found = slow_modes(rates.copy(), h)
    assert np.abs(found - fastest).min() < 1e-6 * abs(fastest) + theory.uncertainty[0]


@pytest.mark.parametrize(("kind", "number"), UNSTABLE)
def test_a_run_leaves_steady_sliding_that_is_unstable(kind, number):
    """All of these rested there, in some dozen steps, for as long as one liked."""
    found = look(15, kind, number)
    assert found.runs >= 6
    assert found.rests == ()


def test_a_run_that_rests_in_a_ramp_leaves_where_the_ramp_ends():
    """A load that rises makes steady sliding unstable; its lag hides that from long steps."""
    law, weak, velocity = st.ExponentialWeakening(0.5, 0.45, 1e-3), 10.0, 1e-3
    slider = st.Slider(
        mass=1.0, k_x=1e4, k_y=1e6, phi="0.5 deg", normal_load=weak, friction=law,
        drive=st.ConstantVelocity(velocity), c_x=-2.0 * weak * law.slope(velocity),
    )  # fmt: skip
    strong = slider.replace(normal_load=4.0 * weak)
    verdicts = [st.linear_stability.steady_sliding(each).verdict for each in (slider, strong)]
    assert verdicts == ["stable", "unstable"]
    start = st.linear_stability.steady_sliding(slider).disturbed_start(1e-9)
    program = [st.protocols.Ramp(4.0 * weak, 20.0), st.protocols.Constant(4.0 * weak, 1.0)]
    slider = slider.replace(load=st.protocols.LoadProgram(program=program))
    run = st.simulate(slider, 21.0, sample_rate=1000.0, rtol=1e-3, initial=start)
    off = np.abs(run.data["slip_x"].values / velocity - 1.0)
    assert off[20_001:].max() > 0.5


def test_what_stays_hidden_costs_no_steps():
    """A mode that grows by e^2 from 1e-13 of the slip is never seen; from 1e-6 it is."""
    law, velocity = st.ExponentialWeakening(0.5, 0.45, 1e-3), 1e-3
    slope = -10.0 * law.slope(velocity)
    slider = st.Slider(
        mass=1.0, k_x=1e4, k_y=1e6, phi="0 deg", normal_load=10.0, friction=law,
        drive=st.ConstantVelocity(velocity), c_x=slope - 0.02,
    )  # fmt: skip
    steady = st.linear_stability.steady_sliding(slider)
    assert steady.growth_rate == pytest.approx(0.01, rel=1e-3)
    steps = [
        st.simulate(
            slider, 200.0, sample_rate=0, initial=steady.disturbed_start(size)
        ).statistics.steps
        for size in (1e-13, 1e-6)
    ]
    assert steps[0] < 500
    assert steps[1] > 5000
