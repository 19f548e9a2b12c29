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
