"""Panels of the quadrature of a run's powers."""

import numpy as np
import pytest

import stiction as st
from stiction.analysis import quadrature


def test_a_swing_that_is_damped_away_takes_no_panels_of_its_own():
    """A small mass under rate and state: it would swing at 42 Hz, and creeps for half an hour."""
    description = st.presets.period_doubling()
    run = st.simulate(description.slider, duration=2000.0, initial=description.initial)
    free = 2000.0 * run.slider.natural_frequencies[1]
    starts, lengths = quadrature.panels(run, np.array([0.0, 2000.0]))
    assert len(starts) == len(lengths) < 0.1 * free
    assert lengths.sum() == pytest.approx(2000.0)
    budget = st.analysis.energy_budget(run)
    assert (abs(budget["residual"]) < budget["bound"]).all()
    assert float(budget["bound"][0]) < 1e-3 * float(budget["work"][0])


def test_a_free_swing_has_a_panel_to_each_period():
    run = st.simulate(st.presets.nakano_popov_2020(), duration=0.05)
    starts, _ = quadrature.panels(run, np.array([0.0, 0.05]))
    slipping = 0.05 - np.diff(run.stick_intervals).sum()
    assert len(starts) >= slipping * run.slider.natural_frequencies[1]


def test_states_are_gone_through_once_and_never_held_together(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Some ten thousand transverse periods: all of their states took hundreds of megabytes."""
    slider = st.presets.nakano_popov_2020()
    run = st.simulate(slider, duration=10.0, sample_rate=1e3, multiscale=False)
    blocks: list[int] = []
    passes = 0
    whole = quadrature.integrate

    def integrate(description, times, most, progress, take):
        nonlocal passes
        passes += 1

        def watch(rows):
            blocks.append(len(rows))
            take(rows)

        return whole(description, times, most, progress, watch)

    monkeypatch.setattr(quadrature, "integrate", integrate)
    budget = st.analysis.energy_budget(run, np.linspace(0.0, 10.0, 11))
    assert (abs(budget["residual"]) < budget["bound"]).all()
    assert passes == 1
    assert sum(blocks) > 100_000
    assert max(blocks) < 0.2 * sum(blocks)


def test_blocks_change_no_bit_of_the_states(monkeypatch: pytest.MonkeyPatch) -> None:
    run = st.simulate(st.presets.nakano_popov_2020(), duration=0.1)
    times = np.linspace(0.0, 0.1, 3001)
    whole = quadrature.states_at(run, times)
    monkeypatch.setattr("stiction.solver.integrate.BLOCK", 50)
    np.testing.assert_array_equal(quadrature.states_at(run, times), whole)
