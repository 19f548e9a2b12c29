import numpy as np
import pytest

import stiction as st
from stiction.analysis.creep.first_slip import slips
from stiction.analysis.limit_cycle import KICK
from stiction.analysis.motion.rest import stuck_share
from stiction.auditing import simulated_test
from stiction.auditing.prediction import predict
from stiction.auditing.simulated_test import (
    LOADS,
    OSCILLATES,
    SLIDES,
    UNSETTLED,
    SimulatedTest,
    coarse_rate,
    final_state,
    from_sliding,
    simulate_test,
)
from stiction.auditing.tolerance import read
from stiction.auditing.words.verdict import short_motion
from stiction.linear_stability import steady_sliding
from stiction.presets import nakano_popov_2020

PAPER = nakano_popov_2020().replace(k_x=1e4, k_y=1e3, phi="80 deg", c_x=2.0, c_y=0.5)
# where x is the stiffer axis, each slips or settles after the spring along x alone would be loaded
STIFF_X = {
    "weakening at 80 deg": PAPER,
    "a cell at an angle": PAPER.replace(k_x=1e5, phi="85 deg", cell_angle="-30 deg"),
    "weakening at 89 deg": PAPER.replace(k_x=1e5, phi="89 deg"),
    "a grain": st.Slider(
        mass=1.68, k_x=752e3, k_y=8530.0, phi="57 deg", normal_load=1943.0,
        friction=st.laws.Anisotropic(
            st.ExponentialWeakening(0.697, 0.432, 1.5), 0.746, "-24.4 deg"
        ),
        drive=st.ConstantVelocity(0.337),
    ),
    "two states": st.Slider(
        mass=0.644, k_x=170.0, k_y=3.3, phi="86.4 deg", normal_load=34.4, c_y=0.086,
        friction=st.laws.RateStateAgeing2(0.0094, 0.0025, 8.8e-6, 0.0025, 8.8e-5, 0.362, 0.126),
        drive=st.ConstantVelocity(0.126),
    ),
    "to the other side": st.Slider(
        mass=3.05, k_x=23.1e3, k_y=1450.0, phi="-87.2 deg", normal_load=1965.0, c_y=0.176,
        friction=st.laws.HyperbolicWeakening(0.207, 2.76), drive=st.ConstantVelocity(0.199),
    ),
}  # fmt: skip


def from_rest(slider: st.Slider) -> SimulatedTest:
    """Simulate the test of an audit from rest."""
    prediction, growth = predict(slider), steady_sliding(slider).growth_rate
    return simulate_test(slider, prediction, growth, sample_rate=coarse_rate(prediction))


def ten_times_as_long(seen: SimulatedTest, start: st.Initial | None = None) -> SimulatedTest:
    """Simulate a test for ten times its duration."""
    run, lasts = seen.run, 10.0 * seen.duration
    rate = len(run.samples["time"]) / seen.duration
    return SimulatedTest(
        st.simulate(run.slider, lasts, initial=start, sample_rate=rate), seen.growth
    )


@pytest.mark.parametrize("name", STIFF_X)
def test_a_test_across_the_stiff_side_lasts_until_its_motion_is_decided(name):
    """It ended before the first stick that the audit predicts: "it sticks for 100 %"."""
    slider = STIFF_X[name]
    linear = steady_sliding(slider)
    rest, sliding = from_rest(slider), from_sliding(linear, predict(slider))
    longer = ten_times_as_long(rest)
    assert rest.decided
    assert rest.comes_to == longer.comes_to
    assert sliding.comes_to == ten_times_as_long(sliding, linear.disturbed_start(KICK)).comes_to
    assert rest.comes_to == sliding.comes_to  # neither is bistable
    assert slips(rest.run) == slips(longer.run)
    if rest.comes_to == OSCILLATES and len(rest.table):
        end = longer.duration
        later = stuck_share(0.5 * end, end, longer.run.stick_intervals)
        assert rest.shares.rest == pytest.approx(later, abs=0.1)


@pytest.fixture
def ends_early(monkeypatch):
    """Let tests end before the first stick of 1 s does."""
    monkeypatch.setattr(simulated_test, "duration_of", lambda *_: 0.2)


def test_a_test_that_ends_before_the_first_slip_claims_nothing(ends_early):
    found = st.audit(PAPER)
    assert found.observation.comes_to == LOADS
    assert not found.bistable
    text = str(found)
    assert "Whether the mass sticks or slips is not determined within 200 ms." in text
    assert "From rest the motion is not determined within 200 ms, as the springs are" in text
    assert "the load cell shows a loading that outlasts the test." in text
    assert "the mass rests for 100 % of the time." in text
    assert "no force of it shows the friction of the surfaces" in text
    for wrong in ("truly sticks", "without a slip", "never faster", "confidence 1.00", "bistable"):
        assert wrong not in text, wrong
    rows = {row[0]: row[2] for row in found.tables()[1].table.rows}
    assert rows["first stick (true rest)"] == "> 199.5 ms"  # the last sample
    assert rows["time until the first slip"] == "> 199.5 ms"
    assert rows["apparent static friction, largest force"].startswith("> 0.")
    shown = found.to_dict()["simulated"]
    assert not shown["decided"]
    assert shown["mu_static"]["value"] is None
    assert short_motion(found.observation) == "a loading that outlasts the test"


def test_a_test_that_ends_before_the_first_slip_reads_nothing(ends_early):
    reading = read(PAPER)
    assert np.isnan(reading[:3]).all()


def test_creep_that_lags_behind_the_drive_is_no_final_state():
    """It swings across while friction turns, alike in the last two quarters."""
    slider = STIFF_X["a grain"]
    for share, state in (0.3, LOADS), (1.0, SLIDES):
        whole = from_rest(slider)
        run = st.simulate(slider, share * whole.duration, sample_rate=2e4)
        assert final_state(run, whole.growth) == state


def test_a_mass_that_rests_since_it_slipped_is_not_decided():
    """Whether it slips again alike cannot be seen."""
    aligned = nakano_popov_2020().replace(phi="0 deg", friction=st.Coulomb(0.1, mu_static=0.2))
    told = predict(aligned)
    early = st.simulate(aligned, 0.999 * told.load_up, sample_rate=0)
    run = st.simulate(
        aligned, 0.8 * told.period, initial=early.state(0.998 * told.load_up), sample_rate="2 kHz"
    )
    assert slips(run)
    assert final_state(run) == UNSETTLED
