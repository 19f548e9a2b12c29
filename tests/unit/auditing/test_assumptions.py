from dataclasses import replace
from math import asin, cos, hypot, pi, radians, sin, sqrt

import pytest
from scipy.optimize import brentq
from tests.rigs import VERY_SLOW

import stiction as st
from stiction.auditing.assumptions import creep_suppositions, suppositions, weakening_angle
from stiction.auditing.prediction import creep_distance, predict
from stiction.auditing.simulated_test import coarse_rate, creep_before_slip, simulate_test
from stiction.auditing.words.numbers import numbers
from stiction.linear_stability import growth_rate

PAPER = st.presets.nakano_popov_2020()
GRID = radians(90.0) / 2000.0  # between two angles that are tried


def creep_of(slider: st.Slider) -> tuple[float, float]:
    """Return the creep before the first slip of a test, and by Eq. (7) until the same time, m."""
    p = predict(slider)
    seen = simulate_test(slider, p, growth_rate(slider), sample_rate=coarse_rate(p))
    V = hypot(*slider.motion.rate(0.0))
    by_eq_7 = creep_distance(V, slider.phi, slider.F_0 / slider.k_x, seen.slip_time)
    return creep_before_slip(seen), by_eq_7


def test_friction_that_weakens_steeply_ends_creep_before_zeta_is_1():
    """Eq. (7) holds as long as it creeps: what fails is Eq. (10), which has friction at F_0."""
    p = predict(VERY_SLOW)
    seen, by_eq_7 = creep_of(VERY_SLOW)
    assert seen == pytest.approx(by_eq_7, rel=0.03)  # the last swing of the mass: 0.3 V/omega_x
    assert seen < 0.75 * p.creep_distance
    (said,) = suppositions(VERY_SLOW, p)
    assert "at θ = 1.013 deg" in said
    assert "from 9.02" in said


def test_creep_ends_where_a_swing_along_the_force_is_overdamped_the_wrong_way():
    """There the slope of the law, 0.05 W/v_f, is 2 (m k)^1/2 of the springs along the force."""
    fall, m = 0.05 * 10.0 / 1e-3, 0.25
    k = (0.5 * fall) ** 2 / m
    theta = asin(sqrt((k - 1e3) / (1e7 - 1e3)))
    # the slope at the creep's own speed is 0.2 % less than at rest
    assert weakening_angle(VERY_SLOW, predict(VERY_SLOW)) == pytest.approx(theta, abs=2 * GRID)


def test_creep_ends_where_weakening_outweighs_the_turning_of_friction():
    """F_0 sin^3(theta)/(V sin(phi)) + F' cos^2(theta) = 0: near phi much of the creep is left."""
    slider = PAPER.replace(phi="7 deg")
    p = predict(slider)
    theta = weakening_angle(slider, p)
    law, v = PAPER.friction, 1e-3 * sin(slider.phi)

    def damping(at: float) -> float:
        turning = 2.0 * sin(at) ** 3 / v
        return turning + float(law.slope(v / sin(at))) * 10.0 * cos(at) ** 2

    assert theta == pytest.approx(brentq(damping, p.theta_c, pi / 2), abs=2 * GRID)
    assert p.theta_c < theta - 10 * GRID
    (said,) = suppositions(slider, p)
    assert "friction is F_0 until ζ = 1, at θ = 7.148" in said
    assert creep_of(slider)[0] < 0.8 * p.creep_distance


@pytest.mark.parametrize("changes", [{}, {"phi": "3 deg"}, {"drive": st.ConstantVelocity(5e-5)}])
def test_the_paper_s_creep_needs_no_mark(changes):
    slider = PAPER.replace(**changes)
    p = predict(slider)
    assert suppositions(slider, p) == []
    assert creep_suppositions(slider, p) == []
    assert creep_of(slider)[0] == pytest.approx(p.creep_distance, rel=0.15)  # 0.3 SET_IN


@pytest.mark.parametrize(
    "changes", [{"phi": "0.2 deg"}, {"drive": st.ConstantVelocity("4 mm/s")}], ids=str
)
def test_a_slip_that_sets_in_slowly_adds_to_the_creep(changes):
    """A third of what the drive covers in a radian of the swing, which marks the creep alone."""
    slider = PAPER.replace(**changes)
    p = predict(slider)
    assert suppositions(slider, p) == []
    (said,) = creep_suppositions(slider, p)
    assert "the slip begins at once where ζ = 1" in said
    V = hypot(*slider.motion.rate(0.0))
    more = (creep_of(slider)[0] - p.creep_distance) / (V / (2.0 * pi * p.f_x))
    assert 0.25 < more < 0.4


def test_only_the_creep_is_marked_where_only_it_is_off():
    slider = PAPER.replace(phi="0.2 deg")
    found = st.audit(slider)
    marked = [row[0] for row in numbers(found).rows if row[1].startswith("~")]
    assert marked == ["creep before the first slip"]


def test_every_number_of_eqs_7_and_10_is_marked_where_creep_ends_early():
    p = predict(VERY_SLOW)
    seen = simulate_test(VERY_SLOW, p, growth_rate(VERY_SLOW), sample_rate=coarse_rate(p))
    found = replace(st.audit(PAPER), slider=VERY_SLOW, prediction=p, observation=seen)
    rows = {row[0]: row[1] for row in numbers(found).rows}
    assert rows["creep before the first slip"].startswith("~ 39.8")
    assert rows["time until the first slip"].startswith("~ ")
    assert not rows["first stick (true rest)"].startswith("~ ")


def test_what_theory_does_not_give_has_no_mark():
    """A period that Eqs. (7) and (10) do not give was "~ none"."""
    steep = PAPER.replace(friction=st.ExponentialWeakening(0.2, 0.15, "10 um/s"), phi="30 deg")
    rows = {row[0]: row[1] for row in numbers(st.audit(steep)).rows}
    assert "none" in rows.values()
    assert "~ none" not in rows.values()
    assert any(shown.startswith("~ ") for shown in rows.values())
