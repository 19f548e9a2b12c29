"""Cases with a solution in closed form, or that others have published, to the digits given.

They live in `benchmarks.cases`, which says for each at which `rtol` its digits hold.
"""

import pytest
from benchmarks.cases import CASES, Case
from benchmarks.cases.closed_forms import closed_forms

import stiction as st


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_agrees_with_what_is_known(case: Case):
    numbers = case.numbers(case.rtol)
    assert numbers
    assert [number for number in numbers if not number.agrees] == []


def test_the_theory_agrees_with_what_is_known():
    assert [number for number in closed_forms() if not number.agrees] == []


@pytest.mark.parametrize("d", [2.0, 10.0])
def test_rtol_controls_a_drop_that_does_not_begin_at_rest(d):
    """Stribeck's slope is zero at rest, its drop far below the drive's speed."""
    slider = st.presets.nakano_popov_2020().replace(
        k_y="100 kN/m",
        phi="0 deg",
        c_x=2.0,
        drive=st.ConstantVelocity(5e-3),
        friction=st.laws.Stribeck(mu_s=0.2, mu_c=0.15, v_s=1e-6, d=d),
    )
    exact = st.simulate(slider, 1.0, rtol=1e-12).final["u_x"].item()
    for rtol in (1e-6, 1e-8):
        # many sticks and slips: ten times the tolerance
        found = st.simulate(slider, 1.0, rtol=rtol).final["u_x"].item()
        assert found == pytest.approx(exact, rel=10 * rtol)
