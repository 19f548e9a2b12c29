"""What further tests are expected to tell, against posteriors in closed form."""

from dataclasses import replace

import numpy as np
import pytest
from tests.uncertain import ASKED, CYCLES, TEXT, copy_blocks

import stiction as st
from stiction.inference.columns import features_from
from stiction.inference.features import USED
from stiction.inference.next_test import design as module
from stiction.inference.next_test import expected as expected_module
from stiction.inference.next_test import further
from stiction.inference.next_test.advice import Advice
from stiction.inference.next_test.expected import (
    GROUPS,
    Expected,
    bounds_with_learning,
    estimates,
    expectation,
    left_out_errors,
)
from stiction.inference.next_test.further import AGAIN, Wanted, further_tests
from stiction.inference.next_test.question import check_arguments, refuse_certain
from stiction.inference.observation import Conditions, Noise, Observation
from stiction.inference.priors import Normal, Uniform
from stiction.inference.simulated.library import refuse_too_few
from stiction.inference.simulated.plan import Plan
from stiction.recording.sensor import LowPass

RIGS = 200
NOISE = 0.5  # of a feature, over the prior's standard deviation
PLAN = Plan(None, {"phi": Normal(0.0, 1.0)}, ())


def draw(records, noise=NOISE, seed=0):
    """Return normal scores (n, 1), and records whose one feature is the score and noise."""
    random = np.random.default_rng(seed)
    truth = random.standard_normal((RIGS, 1))
    return truth, [truth + noise * random.standard_normal((RIGS, 1)) for _ in range(records)]


def width(records, noise=NOISE):
    """Return the standard deviation of the posterior of a normal mean, known in closed form."""
    return (1.0 + records / noise**2) ** -0.5


def errors_of(truth, one, two):
    """Return the errors of a test, and of both records together."""
    each = [estimates(record, truth) for record in (one, two)]
    return [left_out_errors(each[:1], truth), left_out_errors(each, truth)]


@pytest.mark.parametrize("seed", range(3))
def test_the_expected_width_is_that_of_the_posterior(seed):
    truth, (one, two) = draw(2, seed=seed)
    found = expectation(PLAN, "twice", truth, errors_of(truth, one, two))
    error = 4.0 * 0.97 / RIGS**0.5  # four standard errors of this quantile of |x|, x normal
    assert found.width[0] == pytest.approx(width(2), rel=error)
    assert found.error[0] == pytest.approx(width(2), rel=error)  # the prior has a deviation of 1
    assert found.ratio[0] == pytest.approx(width(2) / width(1), rel=error)
    assert found.low[0] < found.ratio[0] < found.high[0] < 1.0


def test_the_interval_of_a_ratio_holds_it():
    """At 95 %, of 200 sets of rigs at least 180: fewer have a probability of 0.2 %."""
    random, inside = np.random.default_rng(4), 0
    covariance = [[1.0, 0.6], [0.6, 0.5]]  # of left_out_errors before and after
    truth = random.standard_normal((RIGS, 1))
    for _ in range(200):
        before, after = random.multivariate_normal([0.0, 0.0], covariance, RIGS).T[..., None]
        found = expectation(PLAN, "", truth, [before, after])
        inside += found.low[0] < 0.5**0.5 < found.high[0]
    assert inside >= 180


def test_a_record_that_says_nothing_narrows_nothing():
    truth, (one,) = draw(1)
    nothing = np.random.default_rng(9).standard_normal((RIGS, 1))
    found = expectation(PLAN, "", truth, errors_of(truth, one, nothing))
    assert 1.0 - 4.0 * 0.97 / RIGS**0.5 < found.ratio[0] <= 1.0
    assert found.low[0] <= found.ratio[0] <= found.high[0]


def test_a_test_tells_no_less_than_a_part_of_it():
    """A regression from few rigs may learn less from more features, which is its own fault."""
    truth, (one, two) = draw(2)
    random = np.random.default_rng(3)
    worse = one + 3.0 * random.standard_normal((RIGS, 1))
    before, part, whole = (truth - estimates(each, truth) for each in (one, two, worse))
    found = expectation(PLAN, "", truth, [before, part, whole], added=2)
    alone = expectation(PLAN, "", truth, [before, part])
    assert (found.error, found.ratio) == (alone.error, min(alone.ratio, 1.0))
    assert found.added == 2


def test_the_width_of_a_test_is_no_larger_than_that_of_its_part():
    """Judged in SI, the part may be worse: "turned by 2 deg" had 30 %, the present test 28 %."""
    truth = np.array([[2.0]] * 50 + [[-2.0]] * 50)
    before, own = np.full((2, 100, 1), 0.2)
    before[:50] = 0.3  # where the angle is large, and the other where it is small
    own[50:] = 0.5
    plan = PLAN._replace(priors={"phi": Uniform(0.1, 10.0, "log")})
    found = expectation(plan, "", truth, [before, own])
    now = expectation(plan, "", truth, [before, before])
    assert found.error < now.error
    assert found.width == now.width


def test_a_test_that_tells_as_much_as_its_part_may_tell_more():
    """A ratio of 1.00 had an interval from 1.00 to 1.00, beside 0.73 to 0.95 of other rigs."""
    random = np.random.default_rng(7)
    truth = random.standard_normal((RIGS, 1))
    one, two = random.standard_normal((2, RIGS, 1))
    found = expectation(PLAN, "", truth, [one, np.where(abs(two) > 0.5, 1.05 * two, two)])
    assert found.low[0] < 0.95
    assert found.low[0] <= found.ratio[0] <= found.high[0] <= 1.0


def test_an_interval_holds_what_other_rigs_teach():
    """Of draws that differ by 0.09 in the logarithm by the rigs judged, and 0.15 by those learned
    from: it held the middle in 70 % of the cases, where groups say nothing of the latter."""
    random, cases = np.random.default_rng(5), 4000
    judged, learned = 0.09, 0.15
    ratio = 0.4 * np.exp(np.hypot(judged, learned) * random.standard_normal(cases))
    bounds = ratio * np.exp(judged * np.array([[-1.96], [1.96]]))
    by_group = 0.5 * np.exp(2.0 * learned * random.standard_normal((GROUPS, cases)))
    low, high = bounds_with_learning(ratio, bounds, by_group)
    assert ((bounds[0] < 0.4) & (bounds[1] > 0.4)).mean() < 0.75
    assert ((low < 0.4) & (high > 0.4)).mean() > 0.95
    again = np.roll(np.array([low, high]), 1, axis=1)
    assert ((low < again[1]) & (again[0] < high)).mean() > 0.98


def test_few_rigs_that_nobody_knows_are_not_typical():
    """Of errors of 1 % in most rigs, and of 100 % in one of fifty."""
    random = np.random.default_rng(2)
    truth = random.standard_normal((1000, 1))
    errors = np.where(np.arange(1000)[:, None] % 50, 0.01, 1.0) * random.standard_normal((1000, 1))
    found = expectation(PLAN, "", truth, [truth, errors])
    assert found.error[0] == pytest.approx(0.01, rel=0.15)  # 0.14 is the root mean square


def test_what_tests_leave_open_is_read_again(tmp_path):
    truth, (one, two) = draw(2)
    found = [
        expectation(PLAN, name, truth, errors_of(truth, one, each), added=added)
        for name, each, added in (("now", one, 0), ("twice", two, 1))
    ]
    path = tmp_path / "folder" / "expected.npz"
    expected_module.write(path, found)
    again = expected_module.read(path, ["now", "twice"])
    pairs = [*zip(found, again, strict=True)]
    assert all(np.array_equal(*both) for each in pairs for both in zip(*each, strict=True))
    assert expected_module.read(path, ["now", "thrice"]) is None
    path.write_bytes(path.read_bytes()[:100])
    assert expected_module.read(path, ["now", "twice"]) is None
    assert expected_module.read(None, []) is None


def test_rigs_without_cycles_keep_what_the_present_test_says():
    truth, (one, two) = draw(2)
    two[: RIGS // 4] = np.nan
    before, after = errors_of(truth, one, two)
    found = expectation(PLAN, "", truth, [before, after])
    assert found.usable == 0.75
    missed = np.abs(np.r_[before[: RIGS // 4], after[RIGS // 4 :]])
    assert found.width[0] == np.sort(missed[:, 0])[int(np.ceil(0.6827 * RIGS)) - 1]
    two[:] = np.nan  # nor any of them
    assert (expectation(PLAN, "", truth, errors_of(truth, one, two)).ratio == 1.0).all()


def test_what_may_be_added():
    present = Conditions(-1e-3, 4.0, 0.0, 0.01, 20, 1.0, {})
    changes = Wanted(angles=("0.1 rad",), velocities=(2e-3,), loads=(8.0,))
    tests = list(further_tests(present, ("force",), changes))
    assert [test.name for test in tests] == [
        "the force across", "the displacement", "the force across and the displacement",
        "the same test again", "turned by 5.73 deg", "at 2 mm/s", "under 8 N",
    ]  # fmt: skip
    *channels, again, turned, faster, loaded = tests
    assert all(test.record is None for test in channels)
    assert again.record == present
    assert turned.record.yaw == 0.1
    assert faster.record.velocity == -2e-3  # in the same direction
    assert loaded.record.normal_load == 8.0
    names = [test.name for test in further_tests(present, ("force", "position"), changes)]
    assert names[:2] == ["the force across", "the same test again"]
    tried = present._replace(velocity=2e-3, normal_load=9.81)  # values that somebody would set
    names = [test.name for test in further_tests(tried, USED, Wanted(angles=()))]
    assert names[1:] == ["at 670 µm/s", "at 6 mm/s", "under 4.9 N", "under 20 N"]


def test_a_design_of_a_rig(designed, monkeypatch, tmp_path):
    for each in (module, expected_module):  # few and short: to see that all of it works
        monkeypatch.setattr(each, "FEWEST_RIGS", 20)
    monkeypatch.setattr(further, "CYCLES", CYCLES)
    copy_blocks(designed, tmp_path)
    found = st.design(TEXT, library=tmp_path, **ASKED)
    assert found.tests[0].test == "the present test"
    assert found.skipped == ("at 1 m/s",)  # too fast for stick-slip
    assert {test.test for test in found.ranked} == {
        "the force across", "the displacement", "the force across and the displacement",
        "the same test again", "turned by 3 deg", "under 1 kN",
    }  # fmt: skip
    order = [test.ratio[found.index] for test in found.ranked]
    assert order == sorted(order)
    data = found.data
    assert data.sizes["test"] == 7
    assert (data["low"] <= data["ratio"] + 1e-12).all()
    said = "\n".join(map(str, found.tables()))
    assert "What to measure next" in said
    assert "Left out, as the rig does not stick and slip" in said
    assert (found.best or found.ranked[0]).test in repr(found)
    axes = found.plot()
    assert [each.get_text() for each in axes.get_yticklabels()] == [t.test for t in found.ranked]
    (kept,) = tmp_path.rglob("tests-*.npz")
    assert kept.name == "tests-200-force.npz"
    again = st.design(TEXT, library=tmp_path, **ASKED)  # from the folder
    assert again.data.identical(data)
    assert again == found != replace(found, doubt="It is of another rig.")


def test_a_test_that_is_surely_better_is_named_though_another_may_be_better_still():
    """The smallest ratio may be a matter of few rigs, with an interval beyond 1."""

    def expected(test, *numbers):
        return Expected(test, *(np.array([x]) for x in (0.1, 0.1, *numbers)), 1.0)

    tests = [
        expected("the present test", 1.0, 1.0, 1.0),
        expected("under 8 N", 0.53, 0.43, 1.19),
        expected("the force across", 0.56, 0.40, 0.92),
        expected(AGAIN, 0.88, 0.71, 2.06),
    ]
    plan = PLAN._replace(priors={"jitter": Normal(0.0, 1.0)})
    advice = Advice(plan, "jitter", tuple(tests), (), (), 2000)
    sure, perhaps = advice.sentences()[:2]
    assert sure.startswith("Most is learned about jitter from: the force across.")
    assert perhaps.startswith(
        "Perhaps this test tells more, but that is not certain: under 8 N, to 0.53"
    )
    assert "the force across" in repr(advice)
    text = " ".join(advice.sentences())
    assert f"It is not certain that it tells more than {AGAIN}" not in text
    assert f"Not certainly better than {AGAIN}" not in text
    assert text.endswith("fall by more or by less: the intervals are those of the mean.")
    unsure = replace(advice, tests=(tests[0], tests[1], tests[3]))
    assert unsure.sentences()[0].startswith("None of these tests clearly tells more of jitter")


def test_of_tests_that_may_tell_the_same_the_simpler_is_named():
    """A second channel was advised for 0.27 of the error, where one gave 0.27."""

    def expected(test, *numbers, added):
        return Expected(test, *(np.array([x]) for x in (0.1, 0.1, *numbers)), 1.0, added)

    tests = (
        expected("the present test", 1.0, 1.0, 1.0, added=0),
        expected("both channels", 0.20, 0.17, 0.23, added=2),
        expected("the displacement", 0.22, 0.19, 0.25, added=1),
        expected("under 8 N", 0.80, 0.73, 0.94, added=1),
        expected(AGAIN, 0.86, 0.80, 0.90, added=1),
    )
    plan = PLAN._replace(priors={"jitter": Normal(0.0, 1.0)})
    advice = Advice(plan, "jitter", tests, (), (), 200)
    assert advice.best.test == "the displacement"
    better = expected("both channels", 0.10, 0.08, 0.12, added=2)
    assert replace(advice, tests=(tests[0], better, *tests[2:])).best is better


def test_a_test_that_may_be_no_better_than_the_same_again_is_not_recommended_and_dismissed():
    """The force across told most, and was two sentences later "no better than" a repetition."""

    def expected(test, *numbers):
        return Expected(test, *(np.array([x]) for x in (0.1, 0.1, *numbers)), 1.0)

    tests = (
        expected("the present test", 1.0, 1.0, 1.0),
        expected("the force across", 0.53, 0.47, 0.65),
        expected("under 8 N", 0.86, 0.73, 1.04),
        expected(AGAIN, 0.66, 0.44, 0.90),
    )
    plan = PLAN._replace(priors={"jitter": Normal(0.0, 1.0)})
    said = Advice(plan, "jitter", tests, (), (), 200).sentences()
    assert said[1] == f"It is not certain that it tells more than {AGAIN}: simulate more."
    assert said[2] == f"Not certainly better than {AGAIN}: under 8 N."


def test_too_few_cycles_say_how_many_simulations_would_do():
    with pytest.raises(st.ResultError, match=r"check the priors, or simulate 200 "):
        refuse_too_few("rigs", 65, 100, 100)
    with pytest.raises(st.ResultError, match=r"check the priors$"):
        refuse_too_few("rigs", 0, 100, 100)
    with pytest.raises(st.ResultError, match=r"^60 of 60 rigs have .* are needed: simulate 200 \("):
        refuse_too_few("rigs", 60, 60, 100)  # the priors are right
    with pytest.raises(
        st.ResultError, match=r"^only 20 of 60 rigs .* check the priors, or simulate"
    ):
        refuse_too_few("rigs", 20, 60, 100)


def test_a_record_of_the_present_test_is_repeated_as_it_is():
    present = Conditions(1.0, 4.0, 0.0, 0.01, 20, 1.0, {})  # too fast for stick-slip in the middle
    tests = further_tests(
        present, ("force",), Wanted(angles=(), velocities=("0.5 mm/s",), loads=())
    )
    possible, skipped = module.split(tests, st.Rig.from_toml(TEXT).slider)
    assert skipped == []
    again, slower = possible[-2:]
    assert again.record == present
    assert 0.1 < slower.record.cycle < 10.0
    noise = {"force": Noise(0.01), "force_across": Noise(0.01), "position": Noise(1e-6)}
    said = module.assumptions(("force", "position"), present._replace(noise=noise), Wanted())
    assert said == ["Assumed: a noise of 10 mN in the force across, as in the other."]
    assert len(module.assumptions((), present._replace(noise=noise), Wanted())) == 3


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"of": "mass"}, "is not uncertain"),
        ({"of": "nonsense"}, "is not uncertain"),
        ({"channels": ["force_across"]}, "must be force"),
        ({"channels": ["force", "sound"]}, "must be force"),
        ({"simulations": 5}, "must not be below 200"),
        ({"angles": ["2 mm"]}, "angles.1: .* not a unit of an angle"),
        ({"loads": ["-2 N"]}, "loads.1: must be greater than 0"),
        ({"noise": "2 mm"}, "force"),
        ({"angles": ["89 deg"]}, "angles: 89 deg turns the rig to 90 deg or more"),
    ],
)
def test_what_cannot_be_designed_is_refused(arguments, words):
    with pytest.raises(st.StictionError, match=words):
        st.design(TEXT, **arguments)


def test_a_rig_that_only_slides_is_refused():
    with pytest.raises(st.ResultError, match="does not stick and slip"):
        st.design(TEXT.replace('"0.5 mm/s"', '"5 m/s"'))


def test_a_rig_that_is_turned_forgets_the_angles_it_had():
    """They are computed once for each slider; a copy under other conditions has others."""
    slider = st.Rig.from_toml(TEXT).slider
    assert slider.misalignment == slider.phi
    assert slider.direction == (np.cos(slider.phi), np.sin(slider.phi))
    turned = Conditions(5e-4, 4.0, 0.1, 0.01, 20, 1.0, {}).slider_of(slider)
    assert turned.misalignment == slider.phi + 0.1
    assert turned.direction == (np.cos(slider.phi + 0.1), np.sin(slider.phi + 0.1))


def test_what_is_known_of_a_sensor_stays_with_another_noise():
    slider = st.presets.nakano_popov_2020()
    its = Noise(1e-3, gain=0.01, filters=(LowPass(20.0, 4),))
    present = further.usual_conditions(slider)._replace(noise={"force": its})
    found = further.with_noise(present, slider, Wanted(noise="3 mN")).noise
    assert found["force"] == its._replace(level=3e-3)
    assert found["force_across"] == Noise(3e-3)
    assert further.with_noise(present, slider, Wanted()).noise["force"] == its


def test_a_given_noise_is_that_of_a_sample_not_of_the_means_that_are_compared():
    """It was taken as that of means of eight samples: beside a record, 2.8 times too large."""
    slider = st.presets.nakano_popov_2020()
    noise = {"force": Noise(1e-3), "position": Noise(1e-6)}
    present = further.usual_conditions(slider)._replace(noise=noise)
    wanted = Wanted(noise="4 mN", position_noise="2 um")
    found = further.with_noise(present, slider, wanted, averaged=4).noise
    assert {name: its.level for name, its in found.items()} == {
        "force": 2e-3, "force_across": 2e-3, "position": 1e-6,
    }  # fmt: skip
    bare = present._replace(noise={"force": Noise(1e-3)})
    found = further.with_noise(bare, slider, wanted, averaged=4).noise
    assert found["position"].level == 1e-6
    said = module.assumptions(("force",), bare._replace(noise=found), Wanted(), 4)
    assert "a noise of 2 mN of means of 4 samples in the force across" in said[0]


def test_noise_that_lasts_is_kept_beside_a_given_one_and_named():
    noise = {"force": Noise(1e-3, lasting=3e-3, lasts=0.02)}
    slider = st.presets.nakano_popov_2020()
    present = further.usual_conditions(slider)._replace(noise=noise)
    wanted = Wanted(noise="4 mN", position_noise="2 um")
    found = further.with_noise(present, slider, wanted)
    said = module.assumptions(("force",), found, wanted)
    assert said == [
        "Beside the given noise of the force, that of the record which lasts 20 ms is kept, 3 mN."
    ]


def test_every_fault_of_a_question_is_told_at_once(tmp_path):
    """The parameter of interest and the arguments came in a second round, the record in a third."""
    wrong = TEXT.replace('mass = "', 'mass = "-')
    asked = {"of": "phu", "angles": "3 mm", "noise": "1 mm", "channels": ["force", "position"]}
    with pytest.raises(st.StictionError) as caught:
        st.design(wrong, tmp_path / "none.csv", **asked)
    said = str(caught.value)
    for words in ("slider.mass", "none.csv: ", "channels: ", "phu: ", "angles.1: ", "noise: "):
        assert words in said
    assert "name one of k_x, k_y, phi, friction.mu_0, friction.mu_inf, jitter" in said


def test_the_spread_of_friction_may_be_asked_for_as_every_fit_estimates_it():
    given = {"channels": ("force",), "angles": (), "velocities": (), "loads": ()}
    assert check_arguments(("phi",), "jitter", 0.0, given)[0] == "jitter"
    with pytest.raises(st.DescriptionError, match="name one of phi, jitter"):
        check_arguments(("phi",), "mass", 0.0, given)
    with pytest.raises(st.DescriptionError, match="state its uncertainty in the file beside"):
        refuse_certain("gain", PLAN)


def test_a_design_says_that_its_record_is_of_another_rig():
    """It ranked tests by a record that no rig within the priors can show, and said nothing."""
    slider, random = st.Rig.from_toml(TEXT).slider, np.random.default_rng(1)
    noise = {"force": Noise(0.01), "force_across": Noise(0.01), "position": Noise(1e-6)}
    every = Conditions(5e-4, 4.0, 0.0, 0.01, 10, 1.0, noise)
    alone = every._replace(noise={"force": Noise(0.01)})
    trial = Plan(slider, {"phi": Normal(0.0, 1.0)}, (every, every))
    columns = features_from(("force",), every, slider)
    scores = random.standard_normal((320, 1))
    features = random.standard_normal((320, 2 * len(columns)))
    features[:, : len(columns)] += 10.0 * scores

    def said(values, count=320, **given):
        seen = Observation(alone, np.full(columns.sum(), values), np.zeros(0), None, ("A pause.",))
        some = scores[:count], features[:count]
        return module.doubts(trial, seen, *some, Wanted(**given), None)

    assert said(5.0) == ""
    assert said(99.0).startswith("The records are not like those of the rig as described")
    assert "Cycles differ within the record, which may explain it. A pause." in said(99.0)
    assert said(99.0, noise="20 mN").endswith(
        "another noise, as given; leave it out to compare them."
    )
    assert said(99.0, position_noise="1 um") == said(99.0)  # no displacement is measured
    assert said(99.0, count=200).endswith("have cycles now, 300 are needed; simulate more.")


def test_errors_of_a_number_have_no_unit():
    """A coefficient of friction was known to "2.3 ma fraction"."""
    now = Expected("now", *(np.array([x]) for x in (0.1, 2.3e-3, 1.0, 1.0, 1.0)), 1.0)
    plan = PLAN._replace(priors={"jitter": Normal(0.0, 1.0)})
    (first, _) = Advice(plan, "jitter", (now, now._replace(test=AGAIN)), (), (), 2000).tables()
    assert [row[1] for row in first.table.rows] == ["0.0023", "0.0023"]


def test_a_vibration_beside_steady_sliding_is_not_stick_slip():
    """Turned to 7 deg a pin vibrates by 0.4 % of its friction: a "cycle" thirty times too short."""
    slider = st.Rig.from_toml(TEXT).slider
    usual = further.usual_conditions(slider)
    cycles = []
    for phi in (2.0, 4.0, 5.0, 6.0, 7.0, 8.0, 10.0):
        found = further.with_cycle(usual, slider.replace(phi=f"{phi} deg"))
        cycles.append(None if found is None else found.cycle)
    last = cycles.index(None)
    assert 3 < last < len(cycles)
    assert cycles[last:] == [None] * (len(cycles) - last)
    assert max(cycles[:last]) < 1.2 * min(cycles[:last])


def test_a_rig_whose_first_slips_are_small_sticks_and_slips():
    """Soft across, it first slips by a part of its swing: five of forty such rigs were refused."""
    random, paper = np.random.default_rng(0), st.presets.nakano_popov_2020()
    law = st.ExponentialWeakening(mu_0=0.3, mu_inf=0.18, v_f=5e-3)
    for number in range(40):
        slider = paper.replace(
            normal_load=10.0 ** random.uniform(0.0, 1.5),
            phi=f"{random.uniform(0.5, 5.0)} deg",
            mass=10.0 ** random.uniform(-1.3, 0.0),
            k_y=10.0 ** random.uniform(4.3, 7.0),
            friction=law,
            drive=st.ConstantVelocity(10.0 ** random.uniform(-3.5, -2.7)),
        )
        if number in (11, 17, 28, 36, 38):
            found = further.with_cycle(further.usual_conditions(slider), slider)
            assert found is not None
            run = st.simulate(slider, 12.0 * found.cycle, sample_rate=100.0 / found.cycle)
            period = float(st.analyse(run).cycles["period"].median())
            assert 0.5 < found.cycle / period < 2.0  # two of them slip irregularly
