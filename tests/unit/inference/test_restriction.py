"""Priors that overlap where the description refuses a combination of their values."""

import numpy as np
import pytest

import stiction as st
from stiction.auditing.tolerance import DRAWS, draw_values
from stiction.errors import DescriptionError, ResultError
from stiction.inference.fit import plan_for
from stiction.inference.learning.regression_abc import Sample
from stiction.inference.mechanism.rivals import levels
from stiction.inference.observation import Conditions, Noise
from stiction.inference.posterior import dataset, draw_prior, estimate, possible
from stiction.inference.simulated.synthetic import draw

TEXT = """
[slider]
mass = "0.3 kg"
k_x = "3 kN/m"
k_y = "2 MN/m"
phi = "0 +- 1 deg"
normal_load = "6 N"

[friction]
law = "coulomb"
mu_0 = {}
mu_static = {}

[drive]
velocity = "2 mm/s"
"""
OVERLAP = [
    ("{low = 0.2, high = 0.5}", "{low = 0.25, high = 0.55}"),
    ('"0.3 +- 0.05"', '"0.34 +- 0.05"'),
]
APART = ("{low = 0.2, high = 0.3}", "{low = 0.3, high = 0.5}")


def plan_of(mu_0, mu_static):
    rig = st.Rig.from_toml(TEXT.format(mu_0, mu_static))
    conditions = Conditions(2e-3, 6.0, 0.0, 1e-3, 20, 0.2, {"force": Noise(0.01)})
    return plan_for(rig, [conditions])


@pytest.mark.parametrize("priors", OVERLAP)
def test_overlapping_priors_are_drawn_where_the_description_takes_them(priors):
    """Uniform ones were refused; of normal ones 17 of 60 draws had mu_static below mu_0."""
    plan = plan_of(*priors)
    assert plan.restricted
    scores = np.array([draw(plan, number, 0)[0] for number in range(60)])
    values = [plan.parameters(each) for each in scores]
    assert all(its["friction.mu_static"] >= its["friction.mu_0"] for its in values)
    # each draw depends on its number alone, and the first that is allowed is taken
    assert np.array_equal(draw(plan, 7, 0)[0], scores[7])
    random = np.random.default_rng([0, 7])
    tries = (random.standard_normal(len(plan.priors)) for _ in range(100))
    assert np.array_equal(next(each for each in tries if plan.takes(each)), scores[7])


def test_priors_apart_are_drawn_as_ever():
    plan = plan_of(*APART)
    assert not plan.restricted
    drawn = np.random.default_rng([0, 3]).standard_normal(len(plan.priors))
    assert np.array_equal(draw(plan, 3, 0)[0], drawn)
    assert plan._replace(restricted=True).key != plan.key
    assert np.array_equal(
        draw_prior(plan)[0], np.random.default_rng(0).standard_normal(len(plan.priors))
    )


def test_prior_and_posterior_have_possible_values_only():
    plan = plan_of(*OVERLAP[1])
    before = draw_prior(plan)
    prior = dataset(plan, before)
    assert bool((prior["mu_static"] >= prior["mu_0"]).all())
    its = estimate(plan, "friction.mu_0", (before[:, 1], before[:, 1]), np.full(4000, 1 / 4e3), 1.0)
    assert its.prior_median == pytest.approx(float(prior["mu_0"].median()), abs=1e-3)
    assert its.prior_median < 0.295  # that of mu_0 alone is 0.3
    assert its.narrower == pytest.approx(1.0)
    sample = Sample(np.array([[0.0, 2.0, -2.0, 0.0], [0.0, -1.0, 1.0, 0.0]]), np.array([0.5, 0.5]))
    assert possible(plan, sample).weights.tolist() == [0.0, 1.0]
    assert possible(plan, Sample(sample.scores[:1], sample.weights[:1])).weights.tolist() == [0.5]


def test_ends_that_no_value_of_the_others_allows_are_refused():
    with pytest.raises(DescriptionError, match=r"mu_static: must not be below the coefficient"):
        plan_of("{low = 0.3, high = 0.5}", "{low = 0.25, high = 0.9}")
    with pytest.raises(DescriptionError, match=r"mu_0: must not be below 0"):
        plan_of("{low = -0.1, high = 0.5}", "{low = 0.25, high = 0.9}")


def test_other_laws_have_coefficients_of_possible_draws():
    rig = st.Rig.from_toml(TEXT.format("{low = 0.2, high = 0.5}", "{low = 0.25, high = 0.55}"))
    found = levels(rig)
    assert found.kinetic[1] < found.static[1]
    possible_at_rest = st.Rig.from_toml(TEXT.format("0.2", "{low = 0.25, high = 0.55}"))
    assert found.static[1] == pytest.approx(levels(possible_at_rest).static[1], rel=0.02)


def test_an_audit_draws_what_the_description_takes():
    """It ended with the fault of a value that nobody had written."""
    found = draw_values(st.Rig.from_toml(TEXT.format(*OVERLAP[1])))
    assert len(found["phi"]) == DRAWS
    assert (found["friction.mu_static"] >= found["friction.mu_0"]).all()


def test_priors_of_which_hardly_any_draw_is_possible_end(monkeypatch):
    plan = plan_of(*OVERLAP[0])
    monkeypatch.setattr("stiction.inference.simulated.plan.is_allowed", lambda *_: False)
    monkeypatch.setattr("stiction.inference.simulated.plan.MOST_DRAWS", 10)
    with pytest.raises(ResultError, match="the description refuses each: narrow the priors"):
        plan.draw(np.random.default_rng(0))
