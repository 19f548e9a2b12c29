"""Uncertain values of a description."""

import copy
import pickle

import numpy as np
import pytest
from tests.drawn import inside

import stiction as st
from stiction.errors import DescriptionError
from stiction.inference.priors import Normal, Uniform
from stiction.system.parameter import change_parameter

PLAIN = st.presets.nakano_popov_2020().to_toml()


def rig(phi='"1 deg"', k_x='"1 kN/m"', mu_0="0.2"):
    text = PLAIN.replace('"1 deg"', phi).replace('"1 kN/m"', k_x)
    return st.Rig.from_toml(text.replace("mu_0 = 0.2", f"mu_0 = {mu_0}"))


@pytest.mark.parametrize(
    "text",
    ['"2 +- 1 deg"', '"2 ± 1 deg"', '"(2 ± 1) deg"', '{value = "2 deg", uncertainty = "1 deg"}'],
)
def test_a_normal_prior_is_written_in_four_ways(text):
    found = rig(phi=text)
    assert found.priors["phi"] == Normal(np.radians(2.0), np.radians(1.0))
    assert np.degrees(found.slider.phi) == pytest.approx(2.0)


def test_a_share_is_relative_to_the_value_and_ends_at_zero():
    assert rig(k_x='{value = "1 kN/m", uncertainty = "5 %"}').priors["k_x"] == Normal(
        1000.0, 50.0, low=0.0
    )


def test_a_misalignment_that_is_hardly_known_stays_below_90_deg():
    """An audit drew 101 deg of 60 +- 40 deg, and refused it as if the user had written it."""
    values = rig(phi='"60 +- 40 deg"').priors["phi"].quantile(np.array([0.0, 0.5, 1.0]))
    assert np.degrees(values) == pytest.approx([-89.9, 49.0, 89.9], abs=1.0)


def test_a_uniform_prior_may_be_of_the_logarithm():
    found = rig(mu_0='{low = 0.16, high = 0.25, scale = "log"}')
    assert found.priors["friction.mu_0"] == Uniform(0.16, 0.25, "log")
    assert found.slider.friction.mu_0 == pytest.approx(0.2)


def test_shares_and_quantiles_are_inverse():
    shares = np.linspace(0.01, 0.99, 9)
    for prior in (Normal(1.0, 2.0, low=0.0), Uniform(1.0, 5.0), Uniform(1.0, 5.0, "log")):
        assert prior.share(prior.quantile(shares)) == pytest.approx(shares)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"phi": '"2 +- 0 deg"'}, "phi: uncertainty must be greater than 0"),
        ({"phi": '{low = "5 deg", high = "1 deg"}'}, "phi: low must be below high"),
        ({"phi": '{low = "5 deg", high = "100 deg"}'}, "must lie between -90 deg and 90 deg"),
        ({"phi": '"2 +- 1"'}, "has no unit"),
        ({"phi": "{low = 1, high = 2}"}, "degree or radian?"),
        ({"mu_0": '{low = 0.0, high = 0.3, scale = "log"}'}, "low must be above 0"),
        ({"mu_0": '{low = 0.1, high = 0.3, scale = "cubic"}'}, "write one of linear, log"),
        (
            {"k_x": '{value = "1 kN/m", uncertainty = "5 s"}'},
            "'5 s' is in s, not a unit of k_x; write for",
        ),
        ({"phi": '{value = "2 deg", uncertainty = "1 mm"}'}, "write for example '1 deg'"),
    ],
)
def test_a_fault_names_its_parameter(given, said):
    with pytest.raises(DescriptionError) as error:
        rig(**given)
    assert said in str(error.value)


def test_a_law_s_file_is_not_run_beside_a_fault_of_a_prior_which_is_told_once(tmp_path):
    text = PLAIN.replace('"1 deg"', '{low = "5 deg", high = "1 deg"}')
    begin, end = text.index("[friction]"), text.index("[drive]")
    own = '[friction]\nlaw = "mine.py:Mine"\n\n'
    (tmp_path / "rig.toml").write_text(text[:begin] + own + text[end:])
    (tmp_path / "mine.py").write_text("raise RuntimeError('it was run')\n")
    with pytest.raises(DescriptionError) as error:
        st.Rig.from_toml(tmp_path / "rig.toml")
    (fault,) = error.value.faults
    assert str(fault).startswith("phi: low must be below high")
    assert "it lies between" not in str(fault)


SURFACE = """
[friction.anisotropy]
ratio = {low = 0.6, high = 1.6}
angle = "10 deg"
"""
SPRINGS = """
[[slider.springs]]
name = "Load cell"
k_x = "3.0 +- 0.1 kN/m"
k_y = "2 MN/m"

[[slider.springs]]
name = "arm"
k_x = {low = "20 kN/m", high = "30 kN/m"}
k_y = "2 MN/m"
"""


def test_an_uncertain_anisotropy_is_a_parameter_by_either_path():
    """Its error advised 'friction.ratio', and --set of that one "unknown key 'ratio'"."""
    text = PLAIN + SURFACE
    assert st.Rig.from_toml(text).priors["friction.ratio"] == Uniform(0.6, 1.6)
    for path in ("friction.ratio", "friction.anisotropy.ratio"):
        found = st.Rig.from_toml(text, {path: 1.5})
        assert (found.priors, found.slider.friction.ratio) == ({}, 1.5)
        assert change_parameter(found.slider, path, 0.7).friction.ratio == 0.7


def test_without_anisotropy_its_ratio_is_unknown():
    with pytest.raises(DescriptionError, match="unknown key 'ratio'"):
        st.Rig.from_toml(PLAIN, {"friction.ratio": 1.5})


def test_springs_in_series_may_be_uncertain():
    """In a fit they were "uncertain, which 'stiction fit', 'design' and 'audit' read"."""
    text = PLAIN.replace('k_x = "1 kN/m"\n', "").replace('k_y = "10 MN/m"\n', "")
    found = st.Rig.from_toml(text.replace("\n[friction]", f"{SPRINGS}\n[friction]"))
    assert found.priors == {
        "springs.load-cell.k_x": Normal(3000.0, 100.0, low=0.0),
        "springs.arm.k_x": Uniform(2e4, 3e4),
    }
    assert found.slider.k_x == pytest.approx(1.0 / (1 / 3e3 + 1 / 25e3))


def test_a_rig_writes_what_was_stated_and_reads_it_back():
    """An audit's page showed the middles with all their digits: 1.224744871391589 deg."""
    stated = {
        "phi": '{ low = "1 deg", high = "1.5 deg", scale = "log" }',
        "k_x": '{ value = "0.9 kN/m", uncertainty = "7 %" }',
        "mu_0": "{ low = 0.16, high = 0.25 }",
    }
    found = rig(**stated)
    written = found.to_toml()
    assert f"phi = {stated['phi']}" in written
    assert 'k_x = { value = "900 N/m", uncertainty = "63 N/m" }' in written
    assert f"mu_0 = {stated['mu_0']}" in written
    assert st.Rig.from_toml(written) == found
    assert "900\N{NO-BREAK SPACE}N/m" in found._repr_html_()


def test_a_share_has_the_digits_of_the_value():
    assert rig(mu_0='{value = 0.3, uncertainty = "7 %"}').priors["friction.mu_0"].deviation == 0.021
    with pytest.raises(DescriptionError, match="mu_0: 'few' is not one number"):
        rig(mu_0='{value = 0.3, uncertainty = "few %"}')


def test_a_share_of_next_to_nothing_ends_at_once():
    """That of 1e-99999999 deg was computed with all of its digits, for minutes."""
    with pytest.raises(DescriptionError, match="phi: uncertainty must be greater than 0"):
        rig(phi='{value = "1e-99999999 deg", uncertainty = "10 %"}')


@pytest.mark.parametrize(
    "mass", ['{value = 0.25, uncertainty = "9 g"}', '{low = 0.1, high = "1 kg"}']
)
def test_an_uncertain_value_beside_a_fault_is_read_in_any_of_its_units(mass):
    """'9 g' must be a number without a unit, it said, which is not so."""
    text = PLAIN.replace('"250 g"', mass)
    assert st.Rig.from_toml(text).priors
    with pytest.raises(DescriptionError) as error:
        st.Rig.from_toml(text, {"colour": 1})
    assert [fault.path for fault in error.value.faults] == ["colour"]


def test_a_share_of_a_negative_value_is_that_of_its_size():
    prior = rig(phi='{value = "−2 deg", uncertainty = "10 %"}').priors["phi"]
    assert prior == Normal(-np.radians(2.0), np.radians(0.2))


def test_a_value_in_another_unit_is_told_once():
    with pytest.raises(DescriptionError) as error:
        rig(phi='{value = "2 kg", uncertainty = "0 kg"}')
    assert [fault.path for fault in error.value.faults] == ["slider.phi"]


STATED = {"phi": "2 +- 1 deg", "friction.mu_0": {"low": 0.1, "high": 0.3}, "mass": "0.3 ± 0.1 kg"}


def test_a_rig_of_a_slider_is_that_of_a_description() -> None:
    found = st.Rig(st.presets.nakano_popov_2020(), STATED)
    assert found == st.Rig.from_toml(PLAIN, STATED)
    assert found == st.Rig.from_toml(found.to_toml())
    assert [*found.priors] == [*STATED]
    assert found == pickle.loads(pickle.dumps(found)) == copy.deepcopy(found)


def test_a_prior_that_is_given_as_one_says_nothing_of_the_slider() -> None:
    slider, prior = st.presets.nakano_popov_2020(), Normal(0.5, 0.1)
    assert st.Rig(slider, {"phi": prior}).slider is slider
    both = st.Rig(slider, {"phi": prior, "mass": "0.3 +- 0.1 kg"})
    assert both.slider.phi == slider.phi
    assert both.slider.mass == pytest.approx(0.3, rel=1e-2)
    assert both.priors["phi"].mean == 0.5
    assert st.Rig(slider) == (slider, {})


def test_what_a_rig_in_python_cannot_be_is_told_at_once() -> None:
    with pytest.raises(DescriptionError) as error:
        st.Rig(
            st.presets.nakano_popov_2020(),
            {"phi": "2 deg", "friction.mu_1": "1 +- 2", "mass": "1 +- 0.1 m"},
        )
    assert [each.path for each in error.value.faults] == ["phi", "friction.mu_1", "mass"]
    assert "phi: '2 deg' is not uncertain; write as in" in str(error.value)
    with pytest.raises(DescriptionError, match=r"priors: \['phi'\] is not a dict; write"):
        st.Rig(st.presets.nakano_popov_2020(), ["phi"])
    with pytest.raises(DescriptionError, match=r"5: No such file or directory; st\.init"):
        st.Rig("5")
    with pytest.raises(DescriptionError, match="int is not a description"):
        st.Rig(5, {"phi": Normal(0.1, 0.01)})


@pytest.mark.parametrize(("mean", "error"), inside(20, (0.5, 3.0), (0.1, 1.0)))
def test_a_rig_prints_the_call_that_makes_it(mean, error):
    """It printed `Normal(mean=...)`, which a session lacks, and radians."""
    priors = {"phi": f"{mean:.3g} +- {error:.2g} deg", "mass": {"low": "0.2 kg", "high": "0.3 kg"}}
    rig = st.Rig(st.presets.nakano_popov_2020(), priors)
    assert eval(repr(rig), {"st": st}) == rig
