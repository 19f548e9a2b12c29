"""Presets: each is complete, is read back from its TOML, and is found by its name.

That their numbers come out is tested in `tests/integration/test_verification.py`.
"""

from math import exp, log

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stiction as st
from stiction.presets import PRESETS, find
from stiction.presets.earthquake import BETA_1, BETA_2, RHO, critical_stiffness, two_states
from stiction.presets.preset import GRADES, Published

EACH = pytest.mark.parametrize("preset", PRESETS.values(), ids=PRESETS)


@EACH
def test_a_preset_is_complete(preset):
    assert preset.grade in GRADES
    assert preset.reference
    assert preset.published
    assert preset.story.endswith(".")
    assert getattr(st.presets, preset.name.replace("-", "_")) is preset.make
    if preset.grade == "scenario":
        assert preset.assumed
        assert all(each.tolerance == 0.0 or each.where != "published" for each in preset.published)


@EACH
def test_a_preset_s_description_is_written_and_read_again(preset):
    description = preset.make()
    assert st.Description.from_toml(description.to_toml()) == description


def test_the_paper_s_slider_is_that_of_its_description():
    assert st.presets.nakano_popov_2020() == st.presets.nakano_popov_weakening().slider


def test_a_misspelt_name_is_answered_with_the_nearest():
    assert find("leine_belt") is find("leine-belt")
    with pytest.raises(st.DescriptionError, match="did you mean 'leine-belt'"):
        find("leine-bel")


def test_a_name_whose_stem_alone_is_known_is_not_taken_for_one_of_two():
    """It asked whether the paper's slider, `nakano_popov_2020`, is the one without stick-slip."""
    both = "did you mean 'nakano-popov-constant' or 'nakano-popov-weakening'"
    with pytest.raises(st.DescriptionError, match=both):
        find("nakano-popov-2020")
    with pytest.raises(st.DescriptionError, match="did you mean 'velocity-step-ageing'"):
        find("velocity-step-aging")


def test_a_number_that_does_not_come_out_is_wrong():
    preset = find("modelica-force")
    run = st.run(preset.make())
    other = preset._replace(published=(Published("first slip", 0.41, 1e-4, "s"),))
    assert [each.verdict for each in preset.numbers(run)] == ["agrees"]
    assert [each.verdict for each in other.numbers(run)] == ["WRONG"]


def quasi_static(law, k, pieces):
    """Friction at the end of each piece of (speed, duration), without inertia, by SciPy's LSODA."""
    mu, zeta, found = law.mu_star, log(law.V_star / pieces[0][0]), []
    for V, duration in pieces:

        def change(t, y, V=V):
            v = law.V_star * exp((y[0] - law.mu_star - law.b * y[1]) / law.a)
            return [k * (V - v), law.change((v, 0.0), 1.0, (y[1],))[0]]

        done = solve_ivp(change, (0.0, duration), [mu, zeta], "LSODA", rtol=1e-12, atol=1e-14)
        mu, zeta = done.y[:, -1]
        found.append((float(mu), float(done.y[0].max())))
    return found


def test_slide_hold_slide_is_that_of_a_solver_without_inertia():
    """The preset's numbers are computed: here they are computed once more."""
    preset = find("slide-hold-slide")
    slider = preset.make().slider
    pieces = ((10e-6, 20.0), (1e-300, 100.0), (10e-6, 30.0))
    (before, _), (held, _), (after, peak) = quasi_static(slider.law, slider.k_x, pieces)
    known = [each.value for each in preset.published]
    assert known == pytest.approx([before, held, peak, after], abs=1e-5)
    assert known[1] == pytest.approx(held, abs=1e-8)
    assert known[3] == pytest.approx(after, abs=1e-8)


def test_the_intervals_of_period_doubling_are_those_of_the_equations_without_inertia():
    """Becker's three equations, by SciPy, at the share at which two intervals alternate."""
    kappa = 0.86 * critical_stiffness()

    def change(t, state):
        x, y, z = state
        e = exp(x)
        dy, dz = kappa * (1.0 - e), -e * RHO * (BETA_2 * x + z)
        return [e * ((BETA_1 - 1.0) * x + y - z) + dy - dz, dy, dz]

    def passing(t, state):
        return state[0]

    passing.direction = 1.0
    options = {"events": passing, "rtol": 1e-9, "atol": 1e-11}
    done = solve_ivp(change, (0.0, 1.9e4), [0.1] * 3, "LSODA", **options)
    gaps = np.diff(done.t_events[0][-9:])
    known = [each.value for each in find("period-doubling").published[1:3]]
    assert sorted({float(f"{gap:.2f}") for gap in gaps}) == pytest.approx(known, abs=6e-3)


def test_a_smaller_mass_changes_nothing_in_period_doubling():
    """At m V^2 = 1e-8 a W D_c the first intervals are those at a hundredth of it."""
    found = []
    for inertia in (1e-8, 1e-10):
        run = st.run(two_states(0.95, inertia)._replace(run=st.Settings(duration=2e3, rtol=1e-9)))
        found.append(float(run.final["spring_x"]))
    assert found[0] == pytest.approx(found[1], rel=1e-6)
