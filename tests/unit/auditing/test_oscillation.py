"""The transverse oscillation of an audit is that of its simulated test."""

import numpy as np
import pytest
from tests.rigs import PIN_ON_PLATE, STIFF_PRESS

import stiction as st
from stiction.analysis.creep.first_slip import creep_end
from stiction.analysis.signals.reversals import extrema
from stiction.auditing import oscillation, report
from stiction.auditing.oscillation import oscillation_of, theoretical_oscillation
from stiction.auditing.prediction import predict
from stiction.auditing.simulated_test import coarse_rate, simulate_test
from stiction.linear_stability import steady_sliding
from stiction.text.quantity.wording import in_words

PAPER = st.presets.nakano_popov_2020()


@pytest.mark.parametrize(("phi", "V"), [(2.0, 5e-4), (2.0, 2e-5), (0.5, 2e-3)])
def test_transverse_swings_are_those_of_the_simulated_test(phi, V):
    """Each rest of the mass ends one swing, so that their number is that of the rests.

    Linear theory, of a mass that never rests, is off by 10 % of the first swings and a factor of 5
    of the last. The count is known to one swing of eleven or twenty.
    """
    slider = PIN_ON_PLATE.replace(phi=f"{phi} deg", drive=st.ConstantVelocity(V))
    p = predict(slider)
    rate = max(p.sample_rate, coarse_rate(p))
    seen = simulate_test(slider, p, steady_sliding(slider).growth_rate, sample_rate=rate)
    shown, rests = oscillation_of(seen), seen.run.stick_intervals
    starts, end = rests[:, 0], seen.slip_time
    first, last = starts[1:21], starts[starts < end][-11:]
    assert shown.first.frequency == pytest.approx(19.0 / np.ptp(first), rel=0.1)
    assert shown.last[0].frequency == pytest.approx(10.0 / np.ptp(last), rel=0.2)
    assert shown.last[0].frequency < 0.5 * theoretical_oscillation(slider)[0]
    fine = st.simulate(slider, p.first_stick + 12.0 / shown.first.frequency, sample_rate=1e5)
    late = fine.samples["time"] > p.first_stick + 4.0 / shown.first.frequency
    time, u_y = fine.samples["time"][late], fine.samples["u_y"][late]
    swings = u_y - np.polynomial.Polynomial.fit(time, u_y, 3)(time)  # without the turn of friction
    assert 2.0 * shown.first.amplitude == pytest.approx(np.ptp(swings), rel=0.15)
    assert shown.first.amplitude > 1.2 * p.amplitude


def test_the_report_has_the_swings_of_the_test_and_marks_theory():
    found = st.audit(PIN_ON_PLATE)
    _, lines, table = next(each for each in found.tables() if each.title.startswith("Transverse"))
    rows = {name: cells for name, *cells in table.rows}
    assert rows["as creep begins"][0].startswith("49")  # Hz; theory: 532.4
    assert rows["linear theory, V sin φ/ω_y"][0] == "532.4 Hz"
    assert "it takes a mass that never rests" in lines[1]
    assert "Hz; below 98" in lines[2]  # of the test, of which a sample rate is no matter
    shown = found.to_dict()["transverse_oscillation"]
    assert in_words(shown["first"][0]["frequency"]["value"], "Hz", 3) == rows["as creep begins"][0]


def test_a_long_creep_is_not_simulated_again_as_a_whole(monkeypatch):
    """Of a slow press it took 66 million samples, and the report failed for their rate."""
    slow = STIFF_PRESS.replace(drive=st.ConstantVelocity("0.1 um/s"))
    p = predict(slow)
    growth = steady_sliding(slow).growth_rate
    seen, asked = simulate_test(slow, p, growth, sample_rate=coarse_rate(p)), []
    simulate = oscillation.simulate
    monkeypatch.setattr(
        oscillation,
        "simulate",
        lambda *a, times, **k: asked.append(times) or simulate(*a, times=times, **k),
    )
    shown = oscillation_of(seen)
    assert shown.first.frequency == pytest.approx(theoretical_oscillation(slow)[0], rel=0.01)
    assert max(map(len, asked)) <= 20.0 * 100.0 * 50.0 + 1.0  # 20 windows of 100 periods
    assert asked[-1][-1] == pytest.approx(creep_end(seen.run), abs=1.0 / p.f_y)


def test_an_audit_measures_its_oscillation_once(monkeypatch):
    """Text, page and numbers each simulated parts of the test again."""
    found, looked = st.audit(PAPER), []
    measured = report.oscillation_of
    monkeypatch.setattr(report, "oscillation_of", lambda x: looked.append(x) or measured(x))
    assert str(found) == str(found)
    assert found.to_dict()["transverse_oscillation"]["first"]
    assert looked == [found.observation]


def test_swings_have_died_out_when_it_is_said():
    slider = PAPER.replace(phi="2 deg", friction=st.Coulomb(mu_0=0.2))
    p = predict(slider)
    seen = simulate_test(slider, p, -1.0, sample_rate=p.sample_rate)
    shown = oscillation_of(seen)
    assert 0.0 < shown.dead < seen.run.samples["time"][-1]
    time, u_y = seen.run.samples["time"], seen.run.samples["u_y"]
    inside = (time > p.first_stick) & (time < p.first_stick + 2.0 * shown.dead)
    time, u_y = time[inside], u_y[inside]
    turns = extrema(u_y)[1:-1]
    legs, at = abs(np.diff(u_y[turns])), time[turns][:-1] - p.first_stick
    late, before = legs[at > shown.dead], legs[(at > 0.8 * shown.dead) & (at < shown.dead)]
    assert late.max() < 0.1 * 2.1 * shown.first.amplitude
    assert before.max() > 0.1 * 1.9 * shown.first.amplitude
