"""Drives, stiffnesses and loads that are stated wrongly, or as uncertain."""

import re

import numpy as np
import pytest
from tests.uncertain import TEXT

import stiction as st
from stiction.errors import DescriptionError
from stiction.inference.disagreement import stated_rate
from stiction.inference.features import features
from stiction.inference.fit import check, plan_for, posterior_of
from stiction.inference.observation import Conditions, Noise, Observation
from stiction.inference.posterior import CONTRADICTS
from stiction.inference.priors import Normal
from stiction.inference.simulated.library import build
from stiction.inference.simulated.loading_rate import logarithms_of_rate
from stiction.inference.simulated.synthetic import draw

SIMULATIONS, RECORDS = 320, 16
V, W, K_X = 0.5e-3, 4.0, 2300.0
SURE = TEXT.replace("2.3 +- 0.1 kN/m", "2.3 +- 0.023 kN/m")
CONDITIONS = Conditions(V, W, 0.0, 0.01, 8, 1.2, {"force": Noise(0.004)})


@pytest.fixture(scope="module")
def library():
    """Simulations of a rig whose stiffness is known to 1 %."""
    return build(plan_for(st.Rig.from_toml(SURE), [CONDITIONS]), SIMULATIONS, None)


def records(library, velocity):
    """Yield records of that rig, driven so many times as fast as stated."""
    truly = library.plan._replace(conditions=(CONDITIONS._replace(velocity=velocity * V),))
    for number in range(RECORDS):
        made = next(draw(truly, number, 3)[1])
        if made is not None:
            scale = CONDITIONS.scale(library.plan.slider)
            its = features(CONDITIONS.step, made.channels, scale, made.cycles)
            yield Observation(CONDITIONS, its, made.channels["force"], made.cycles)


@pytest.mark.parametrize("velocity", [0.93, 1.07])
def test_a_velocity_that_is_stated_wrongly_is_doubted(library, velocity):
    """Of 82 such records, by 5 %, 46 were not doubted, while the stiffness took its part."""
    found = [posterior_of(library, [each]) for each in records(library, velocity)]
    doubted = [each for each in found if each.loading.p_value < CONTRADICTS]
    assert len(doubted) >= 0.6 * len(found) > 6
    factors = [np.exp(each.loading.found) for each in doubted]
    assert np.median(factors) == pytest.approx(velocity, abs=0.02)
    words = " ".join(doubted[0].doubts)
    said = re.search(r"The force rises at (\S+) ± (\S+) times the rate that is stated", words)
    assert said is not None
    assert float(said[1]) == pytest.approx(factors[0], abs=float(said[2]))
    assert 'velocity = "0.5 +- 0.02 mm/s" under [drive]' in words


def test_a_velocity_that_is_stated_rightly_is_not(library):
    found = [posterior_of(library, [each]) for each in records(library, 1.0)]
    assert not [its for each in found for its in each.doubts if "times the rate" in its]


def test_three_records_are_doubted_as_one_is(library):
    """Of three none ever was: a p-value of each, by 200 simulations, was multiplied by three."""
    thrice = library._replace(features=np.tile(library.features, 3))
    found = [stated_rate(thrice, [each] * 3) for each in records(library, 1.07)]
    doubted = [each for each in found if each.p_value < CONTRADICTS]
    assert len(doubted) >= 0.6 * len(found) > 6


def test_three_records_that_are_stated_rightly_are_not(library):
    thrice = library._replace(features=np.tile(library.features, 3))
    found = [stated_rate(thrice, [each] * 3) for each in records(library, 1.0)]
    assert not [each for each in found if each.p_value < CONTRADICTS]


def test_the_rate_follows_from_stiffness_velocity_and_gain():
    text = SURE.replace('"0.5 mm/s"', '"0.5 +- 0.01 mm/s"')
    noise = {"force": Noise(0.004, gain=0.03)}
    its = plan_for(st.Rig.from_toml(text), [CONDITIONS._replace(noise=noise)])
    scores = np.random.default_rng(0).standard_normal((9, len(its.priors)))
    values = [its.parameters(each) for each in scores]
    rates = [x["k_x"] / K_X * x["drive.velocity"] / V * x["gain"] for x in values]
    # between scores a half apart, of logarithms that bend by 3 % squared
    assert logarithms_of_rate(its, scores) == pytest.approx(np.log(rates), abs=2e-4)


def test_an_uncertain_drive_and_load_are_simulated_so():
    """A prior of either was taken, and each simulation had what is stated."""
    text = TEXT.replace('"0.5 mm/s"', '"0.5 +- 0.05 mm/s"').replace('"4 N"', '"4 +- 0.4 N"')
    fast = CONDITIONS._replace(velocity=4.0 * V, normal_load=3.0 * W)
    its = plan_for(st.Rig.from_toml(text), [CONDITIONS, fast])
    channels = {"force": Noise(0.0), "position": Noise(0.0)}
    its = its._replace(conditions=tuple(x._replace(noise=channels) for x in its.conditions))
    scores, made = draw(its, 1, 0)
    slow, quick = (each for each in made if each)
    values = its.parameters(scores)
    assert slow.slider.drive_speed == values["drive.velocity"] != V
    assert slow.slider.normal_load == values["normal_load"] != W
    assert quick.slider.drive_speed == pytest.approx(4.0 * slow.slider.drive_speed)
    assert quick.slider.normal_load == pytest.approx(3.0 * slow.slider.normal_load)
    stretch = slow.motion.rows[-1, :2] @ np.array(slow.slider.direction)
    way = slow.channels["position"][-1] + stretch  # of the drive: the mass and its springs
    assert way == pytest.approx(values["drive.velocity"] * slow.motion.time[-1], rel=1e-6)


def test_a_drive_keeps_its_sense_and_moves():
    text = TEXT.replace('"0.5 mm/s"', '"0.5 +- 0.4 mm/s"')
    prior = plan_for(st.Rig.from_toml(text), [CONDITIONS]).priors["drive.velocity"]
    assert prior == Normal(V, 0.8 * V, low=0.0)
    with pytest.raises(DescriptionError, match=r"drive\.velocity: is 0"):
        check(st.Rig.from_toml(TEXT.replace('"0.5 mm/s"', '"0 mm/s"')))
