"""Mechanisms: rivals on one apparatus, a classifier that is calibrated, and what it may claim."""

import pickle
from dataclasses import replace
from itertools import islice

import numpy as np
import pytest
import xarray as xr
from tests.uncertain import record_of, shared_folder

import stiction as st
from stiction.analysis.motion.rest import HELD
from stiction.errors import DescriptionError, ResultError, in_terminal
from stiction.friction.laws import Anisotropic, Coulomb, LuGre, RateStateAgeing
from stiction.inference.columns import bend_features
from stiction.inference.cycles import Cycles, slip_cycles
from stiction.inference.features import (
    ABOVE,
    EDGES,
    REBOUND,
    SLIP,
    FeatureScale,
    Loadings,
    of_loading,
    of_slip,
)
from stiction.inference.fit import plan_for
from stiction.inference.mechanism import classifier, comparison, likeness
from stiction.inference.mechanism.classifier import (
    Simulations,
    common_columns,
    learn_or_read,
    simulate,
)
from stiction.inference.mechanism.comparison import confusion
from stiction.inference.mechanism.likeness import BENT, CURVES, Likeness
from stiction.inference.mechanism.odds import UNDECIDED, Odds
from stiction.inference.mechanism.rest import Rest, share_at_rest, shares_at_rest
from stiction.inference.mechanism.rivals import (
    LUGRE,
    MISALIGNED_STATIC,
    RATE_AND_STATE,
    ROTATION,
    STATIC,
    levels,
    mechanisms,
)
from stiction.inference.mechanism.static_check import StaticCheck
from stiction.inference.observation import Noise, observe, steadiness, trend
from stiction.inference.priors import Uniform
from stiction.inference.simulated.jitter import Jitter, SampledMotion, laws, move
from stiction.inference.simulated.synthetic import Synthetic, draw
from stiction.plotting import plot_mechanism
from stiction.recording.sensor import LowPass

SIMULATIONS = 128  # of each mechanism: enough to tell these records apart
STILL = Jitter(0.0, 0.0)


@pytest.fixture(scope="module")
def rotating(rig):
    return record_of(rig.slider.replace(phi="2.5 deg"), 7)


@pytest.fixture(scope="module")
def folder(rig, rotating, tmp_path_factory):
    """The simulations of all mechanisms, which one worker makes for all."""
    with shared_folder("mechanisms", tmp_path_factory) as folder:
        st.mechanism(rotating, rig, simulations=SIMULATIONS, library=folder)
    return folder


@pytest.fixture(scope="module")
def odds(rig, rotating, folder):
    return st.mechanism(rotating, rig, simulations=SIMULATIONS, library=folder)


def test_a_record_of_a_rotating_friction_vector_is_called_so(odds):
    assert odds.decision == ROTATION, odds
    assert odds.straight_excluded
    said = " ".join(odds.sentences())
    assert f"Claimed: {ROTATION}" in said
    assert "not as straight" in said
    assert "in all directions" not in said  # the force across is measured
    assert pickle.loads(pickle.dumps(odds)) == odds != replace(odds, counts=())


def test_drifting_friction_has_a_trend(rig, rotating):
    drifting = record_of(rig.slider.replace(phi="2.5 deg"), 9, drift=-0.02)
    found = [observe(each, rig.slider) for each in (rotating, drifting)]
    steady, falling = (steadiness(each.trend) for each in found)
    assert steady > 0.05
    assert falling < 0.01


def test_a_second_call_simulates_nothing_and_says_the_same(rig, rotating, odds, folder):
    before = {path: path.stat().st_mtime_ns for path in folder.rglob("*.npz")}
    again = st.mechanism(rotating, rig, simulations=SIMULATIONS, library=folder)
    assert {path: path.stat().st_mtime_ns for path in folder.rglob("*.npz")} == before
    xr.testing.assert_identical(again.data, odds.data)


def test_the_confusion_matrix_is_of_shares(odds):
    assert odds.confusion.shape == (len(odds.names), len(odds.names) + 1)
    assert odds.confusion.sum(axis=1) == pytest.approx(1.0)
    assert odds.data["confusion"].sel(mechanism=ROTATION, called=ROTATION) > 0.8


def test_the_figure_shows_odds_confusion_and_loading(odds):
    bars, matrix, loading = plot_mechanism(odds)
    shown = [
        0.0 if its.unlike else p for p, its in zip(odds.probabilities, odds.likeness, strict=True)
    ]
    assert [bar.get_width() for bar in bars.patches] == pytest.approx(shown)
    assert max(shown) == odds.probabilities.max()  # the record is like what it is called
    assert len(bars.texts) == sum(its.unlike for its in odds.likeness)
    assert len(matrix.texts) == odds.confusion.size
    assert loading.lines[len(odds.names)].get_ydata() == pytest.approx(
        100.0 * odds.bend[: len(EDGES) - 1]
    )


def test_the_simulations_of_rotation_are_those_of_a_fit(rig, rotating):
    conditions = [observe(rotating, rig.slider).conditions]
    rotation = mechanisms(rig, conditions)[0].plans
    assert [plan.key for plan in rotation] == [plan_for(rig, conditions).key]


def test_a_mechanism_in_one_dimension_stays_so_however_the_rig_was_turned(rig, rotating):
    seen = observe(rotating.model_copy(update={"turned": 0.1}), rig.slider).conditions
    for rival in mechanisms(rig, [seen]):
        for plan in rival.plans:
            turns = "phi" in plan.priors
            assert plan.conditions[0].yaw == (0.1 if turns else 0.0)
            assert plan.conditions[0].slider_of(plan.slider).phi == (plan.slider.phi + 0.1) * turns


def test_an_aligned_rig_is_refused_because_nothing_rotates(rig, rotating):
    aligned = rig._replace(
        slider=rig.slider.replace(phi="0 deg"),
        priors={path: prior for path, prior in rig.priors.items() if path != "phi"},
    )
    with pytest.raises(DescriptionError, match="nothing rotates"):
        st.mechanism(rotating, aligned)
    with pytest.raises(ResultError, match="no record is given"):
        st.mechanism([], rig)


# what is simulated


def test_every_law_drawn_from_a_mechanism_is_a_valid_one(rig, rotating):
    """Corners of the priors and 200 points between, through the law's own validation.

    Where priors overlap so that a static peak may lie below the coefficient at rest, as they draw.
    """
    random = np.random.default_rng(3)
    conditions = [observe(rotating, rig.slider).conditions]
    for rival in mechanisms(rig, conditions):
        for plan in rival.plans:
            law = plan.slider.friction
            own = {path: prior for path, prior in plan.priors.items() if "friction." in path}
            if plan.restricted:
                draws = [plan.parameters(plan.draw(random)) for _ in range(60)]
            else:
                corners = random.integers(0, 2, (60, len(own)))
                between = random.random((200, len(own)))
                draws = [
                    {path: prior.quantile(share) for (path, prior), share in
                     zip(own.items(), shares, strict=True)} for shares in (*corners, *between)
                ]  # fmt: skip
            for each in draws:
                values = {path.removeprefix("friction."): float(each[path]) for path in own}
                drawn = type(law)(**{**law._asdict(), **values})
                assert {path: getattr(drawn, path) for path in values} == pytest.approx(values)


def test_the_coefficients_of_rivals_have_the_range_of_the_rig_s_law(rig):
    static, kinetic = levels(rig)
    assert static[0] < 0.52 < 0.75 < static[1]  # mu_0 of the description is 0.5 to 0.75
    assert kinetic[0] < 0.25 < 0.48 < kinetic[1]  # mu_inf is 0.25 to 0.5
    assert kinetic[1] <= static[0]


def test_a_mechanism_that_never_slips_is_left_out_and_named(rig, rotating):
    conditions = observe(rotating, rig.slider).conditions._replace(cycle=0.01)  # all are longer
    rivals = mechanisms(rig, [conditions])[1:2]
    with pytest.raises(ResultError, match="by no mechanism"):
        simulate(rivals, 64, None)


@pytest.mark.parametrize("left", [(ROTATION,), (MISALIGNED_STATIC,), (ROTATION, STATIC)])
def test_what_cannot_be_compared_is_refused_after_the_first_simulations(
    rig, rotating, monkeypatch, left
):
    """`only by X` was said after all simulations, and after those of a fit."""
    rivals = mechanisms(rig, [observe(rotating, rig.slider).conditions])
    mine = {plan.key for each in rivals if each.name in left for plan in each.plans}
    asked = []

    def simulate_one(plan, number, _):
        asked.append(number)
        return np.zeros(len(plan.priors)), np.full(3, 1.0 if plan.key in mine else np.nan)

    monkeypatch.setattr("stiction.inference.simulated.library.simulate", simulate_one)
    if len(left) > 1:
        assert simulate(rivals, 1000, None).names == left
        return
    with pytest.raises(ResultError, match=f"^only by {left[0]} do simulated records have cycles"):
        simulate(rivals, 1000, None)
    assert len(asked) < 0.25 * 1000 * len(rivals)


@pytest.mark.parametrize("law", [
    RateStateAgeing(a=0.01, b=0.06, D_c=5e-6, mu_star=0.5, V_star=1e-3),
    LuGre(mu_c=0.4, mu_s=0.6, v_s=1e-3, sigma_0=2e5, sigma_1=100.0),
])  # fmt: skip
def test_a_motion_with_internal_states_goes_on_where_it_was_cut(rig, law):
    """Cycle by cycle, without jitter: the same as one run."""
    slider = rig.slider.replace(friction=law, phi="1 deg")
    times = np.arange(0.0, 6.0, 0.01)
    found = move(slider, times, STILL, np.random.default_rng(1), cycle=1.0)
    assert len(found.troughs) >= 2
    start = st.Initial(epsilon=0.0)
    exact = st.simulate(slider, 6.0, initial=start, sample_rate=100.0).data
    last = found.troughs[-1]
    span = np.ptp(exact["u_x"].values)
    apart = np.abs(found.rows[: last + 1, 0] - exact["u_x"].values[: last + 1])
    assert np.median(apart) < 1e-3 * span  # within a slip, samples are off by its delay


def test_jitter_spares_the_shape_of_an_anisotropic_limit():
    law = Anisotropic(Coulomb(0.3, mu_static=0.4), ratio=1.3)
    some = [*islice(laws(law, Jitter(0.05, 0.5), np.random.default_rng(1)), 50)]
    assert {its.ratio for its in some} == {1.3}
    assert np.std([its.law.mu_0 / 0.3 for its in some]) == pytest.approx(0.05, rel=0.3)


def test_coefficients_drift_from_cycle_to_cycle():
    some = [*islice(laws(Coulomb(0.3), Jitter(0.0, 0.0, -0.02), np.random.default_rng(1)), 11)]
    assert some[10].mu_0 == pytest.approx(0.3 * np.exp(-0.2))


def test_a_motion_that_slides_ends_before_all_its_time(rig):
    slider = rig.slider.replace(phi="0 deg", friction=Coulomb(0.4), c_x="20 N s/m")
    times = np.arange(0.0, 100.0, 0.05)
    found = move(slider, times, STILL, np.random.default_rng(1), cycle=1.0, cycles=8)
    assert len(found.troughs) == 0
    assert len(found.time) < len(times) // 2


def test_the_bend_features_of_a_sawtooth_are_zero(rig, rotating):
    saw = np.tile(np.r_[0.0:1.0:41j, 0.6, 0.3], 12)
    record = st.Record(time=0.01 * np.arange(len(saw)), force=saw, normal_load=4.0)
    seen = observe(record, rig.slider)
    bend = bend_features(seen.conditions, rig.slider)
    assert bend.sum() == len(EDGES) - 1
    assert seen.features[bend] == pytest.approx(0.0, abs=1e-9)


def test_the_slip_features_follow_the_fall_and_the_rise_in_free_periods():
    """A fall by half a cosine in half a free period, and a rise in a straight line in two."""
    period, step = 1.0, 0.005
    time = step * np.arange(501)
    shape = np.where(time < 0.5, 0.5 + 0.5 * np.cos(2.0 * np.pi * time), (time - 0.5) / 2.0)
    saw = np.r_[np.linspace(0.0, 1.0, 400), np.tile(shape[1:], 9)]
    scale = FeatureScale(force=1.0, loading=1.0, period=period, velocity=1.0)
    found = of_slip(step, saw, scale, slip_cycles(saw))
    fall, rise = np.sin(np.pi * SLIP) ** 2, REBOUND / 2.0
    # between samples a cosine is off by (2 pi step)^2 / 16, and its extremes lie on samples
    assert found == pytest.approx([*fall, *rise], abs=(2.0 * np.pi * step) ** 2 / 16.0)


@pytest.mark.parametrize("slowed", [(2e-3, 0.0), (0.0, 2e-3)])
def test_creep_of_a_leaning_force_and_of_bristles_are_told_from_one_another(slowed):
    """A force that grows at a rate of 1 but for one kind of creep, up to the slip."""
    step, fine, f, loading = 0.005, 100, 0.3, []
    while f < 1.0 / ABOVE:
        loading.append(f)
        for _ in range(fine):
            lean = min(f, 1.0 / ABOVE)
            kinds = lean / (1.0 - lean * lean) ** 0.5, 1.0 / (1.0 - lean)
            f += step / fine * (1.0 - float(np.dot(slowed, kinds)))
    saw = np.tile(np.r_[loading, 0.6], 9)
    scale = FeatureScale(force=1.0, loading=1.0, period=0.1, velocity=1.0)
    *_, rate, leaning, yielding = of_loading(step, saw, scale, Loadings(slip_cycles(saw)))
    # the last sample is up to a step (0.005) below the slip, where the fit ends at 1 - f = 0.035:
    # there creep is off by a seventh, and by less in the mean
    found = [-(each**3) for each in (leaning, yielding)]
    assert found == pytest.approx([*slowed], abs=0.1 * max(slowed))
    assert rate == pytest.approx(1.0, abs=0.1 * max(slowed))


# what is learned


@pytest.fixture(scope="module")
def learned(clouds):
    return learn_or_read(clouds)


@pytest.fixture(scope="module")
def clouds():
    """Two mechanisms in three features, 1.5 standard deviations apart in the first."""
    random = np.random.default_rng(5)
    labels = np.repeat([0, 1], [300, 500])
    features = random.standard_normal((800, 3))
    features[:, 0] += 1.5 * labels
    return Simulations(("a", "b"), features, labels)


def test_probabilities_are_those_of_even_odds_before(learned):
    """Two normal clouds: the log odds are 1.5 x - 1.125, whatever the number of each."""
    x = np.linspace(-1.0, 2.5, 8)
    new = np.column_stack([x, np.zeros(8), np.zeros(8)])
    found = learned.probabilities(new)[:, 1]
    # 500 records place the slope and the middle to some 10 % and 0.1
    assert found == pytest.approx(1.0 / (1.0 + np.exp(1.125 - 1.5 * x)), abs=0.08)


def test_left_out_probabilities_are_calibrated(learned, clouds):
    sure = learned.whole.left_out.max(axis=1)
    right = learned.whole.left_out.argmax(axis=1) == clouds.labels
    weights = 1.0 / np.bincount(clouds.labels)[clouds.labels]
    for low, high in ((0.5, 0.7), (0.7, 0.9), (0.9, 1.0)):
        some = (sure >= low) & (sure < high)
        share, said = (np.average(each[some], weights=weights[some]) for each in (right, sure))
        assert share == pytest.approx(said, abs=3.0 * (0.25 / some.sum()) ** 0.5)


def test_each_half_of_the_simulations_learns_by_itself(learned, clouds):
    """Of the other half it has seen nothing; of its own records each is left out."""
    even = Simulations(clouds.names, clouds.features[::2], clouds.labels[::2])
    alone = learn_or_read(even)
    new = np.random.default_rng(1).standard_normal((5, 3))
    first, second = learned.probabilities_by_halves(new)
    # standardised by other middles and spreads
    assert first == pytest.approx(alone.probabilities(new), abs=0.05)
    assert np.abs(first - second).max() > 1e-3
    by_halves = learned.left_out_by_halves
    assert by_halves.shape == (2, 800, 2)
    assert np.array_equal(by_halves[1, 1::2], learned.halves[1].left_out)
    seen = learned.probabilities_by_halves(clouds.features)
    assert by_halves[0, 1::2] == pytest.approx(seen[0, 1::2], rel=1e-9)
    assert np.abs(by_halves[0, ::2] - seen[0, ::2]).max() > 1e-3
    called = confusion(learned.whole.left_out, by_halves, clouds.labels)
    alone = confusion(learned.whole.left_out, learned.whole.left_out[None], clouds.labels)
    assert (called[:, -1] >= alone[:, -1]).all()


def test_a_metric_of_its_own_ignores_what_says_nothing(learned):
    """The first feature tells the mechanisms apart, the other two are noise."""
    metric = np.abs(learned.whole.membership.metric[0])
    assert np.diag(metric)[1:].max() < 0.3 * metric[0, 0]


def test_what_was_learned_is_stored_and_found_again(clouds, tmp_path, monkeypatch):
    path = tmp_path / "learned.npz"
    first = learn_or_read(clouds, path)
    new = np.random.default_rng(1).standard_normal((5, 3))
    with monkeypatch.context() as patch:
        patch.setattr(classifier, "logistic", None)
        second = learn_or_read(clouds, path)  # read
    assert (first.probabilities(new) == second.probabilities(new)).all()
    halves = (each.probabilities_by_halves(new) for each in (first, second))
    assert np.array_equal(*halves)
    fewer = clouds._replace(features=clouds.features[1:], labels=clouds.labels[1:])
    assert len(learn_or_read(fewer, path).whole.left_out) == 799  # not those of other simulations
    path.write_bytes(b"damaged")
    assert (learn_or_read(clouds, path).probabilities(new) == first.probabilities(new)).all()


def features_of(parameters, random):
    """Features that parameters (n, 2) show twice, on a bent surface, and noise."""
    x, y = parameters.T
    columns = [x, y, x + 0.3 * y * y, y - 0.3 * x, x * y, x - y]
    return np.column_stack(columns) + 0.05 * random.standard_normal((len(parameters), 6))


@pytest.fixture(scope="module")
def two_mechanisms():
    """Simulations of two mechanisms of which the parameters and features are known."""
    random = np.random.default_rng(2)
    parameters = tuple(random.standard_normal((count, 2)) for count in (600, 400))
    features = np.concatenate([features_of(each, random) for each in parameters])
    return Simulations(("one", "other"), features, np.repeat([0, 1], [600, 400]), (), parameters)


def test_a_record_of_the_mechanism_is_as_usual_as_any_and_one_beside_it_is_not(two_mechanisms):
    features = two_mechanisms.features
    reference, _ = likeness.learn_or_read(two_mechanisms, features, features[:, :2])
    random = np.random.default_rng(3)
    new = features_of(random.standard_normal((300, 2)), random)
    found = [reference.likeness(each, each[:2]) for each in new]
    farther = np.array([its.farther for its in found])
    # uniform: the mean of 300 is 0.5 within three standard errors, and few are rare
    assert farther.mean() == pytest.approx(0.5, abs=3.0 * (1.0 / 12.0 / 300.0) ** 0.5)
    assert (farther < 0.05).mean() == pytest.approx(0.05, abs=3.0 * (0.05 * 0.95 / 300.0) ** 0.5)
    assert reference.likeness(8.0 * features[0], np.zeros(2)).farther == 0.0
    bent = reference.likeness(features[0], np.array([8.0, 8.0]))
    assert bent.farther > 0.0
    assert bent.larger == pytest.approx(1.0 / (CURVES + 1))


def test_a_record_that_contradicts_what_its_parameters_let_expect_is_unlike(two_mechanisms):
    """Its distance from the nearest simulations does not show it in half of the cases."""
    features = two_mechanisms.features
    reference, _ = likeness.learn_or_read(two_mechanisms, features, features[:, :2])
    random = np.random.default_rng(5)
    wrong = features_of(0.5 * random.standard_normal((100, 2)), random)
    wrong[:, 4] += 0.3  # six times the noise, where x y reaches 3
    near = (reference.typicality.near.nearer(wrong, wrong) > 0.975).mean()
    unlike = (reference.typicality.farther(wrong) < 0.025).mean()
    assert near < 0.6
    assert unlike > 0.8


def test_a_parameter_that_features_do_not_show_lets_expect_nothing(two_mechanisms):
    random = np.random.default_rng(9)
    parameters = np.column_stack([two_mechanisms.parameters[0], random.standard_normal(600)])
    typical = likeness.learn(two_mechanisms.features[:600], parameters)
    assert typical.expectation.shown.tolist() == [1.0, 1.0, 0.0]


def test_the_loading_is_compared_with_those_of_the_same_parameters(two_mechanisms):
    features, (parameters, _) = two_mechanisms.features, two_mechanisms.parameters
    reference, _ = likeness.learn_or_read(two_mechanisms, features, features[:, :2])
    random = np.random.default_rng(8)
    truth = random.standard_normal((40, 2))
    records = features_of(truth, random)
    for record, its in zip(records, truth, strict=True):
        alike = parameters[reference.typicality.alike(record, 20)]
        others = np.abs(parameters - its).mean(axis=0)
        assert (np.abs(alike - its).mean(axis=0) < 0.5 * others).all()
    larger = [reference.likeness(each, each[:2]).larger for each in records]
    assert np.mean(np.array(larger) < 0.025) < 0.1  # two are expected of 40, as the bends go along


def test_what_is_expected_is_stored_and_found_again(two_mechanisms, tmp_path, monkeypatch):
    path, features = tmp_path / "likeness.npz", two_mechanisms.features
    new = features_of(np.array([[0.5, -0.5]]), np.random.default_rng(1))[0]

    def likenesses(simulated, path=path):
        learned = likeness.learn_or_read(
            simulated, simulated.features, simulated.features[:, :2], path
        )
        return [each.likeness(new, new[:2])[0] for each in learned]

    first = likenesses(two_mechanisms, None)
    assert min(first) > 0.0
    assert likenesses(two_mechanisms) == first
    with monkeypatch.context() as patch:
        patch.setattr(likeness, "learn", None)
        assert likenesses(two_mechanisms) == first  # read
        others = two_mechanisms._replace(features=features + 1e-3)  # of another library
        with pytest.raises(TypeError):
            likenesses(others)
    path.write_bytes(b"damaged")
    assert likenesses(two_mechanisms) == first


def test_parameters_of_several_laws_have_common_columns(rig, rotating):
    rivals = mechanisms(rig, [observe(rotating, rig.slider).conditions])
    (static,) = (each for each in rivals if each.name == STATIC)
    scores = [np.full((2, len(plan.priors)), i + 1.0) for i, plan in enumerate(static.plans)]
    found = common_columns(static.plans, scores)
    paths = [*dict.fromkeys(path for plan in static.plans for path in plan.priors)]
    assert found.shape == (4, len(paths) + 2)
    own = paths.index("friction.mu_static")  # of the second law alone
    assert found[:, own].tolist() == [0.0, 0.0, 2.0, 2.0]
    assert found[:, paths.index("k_x")].tolist() == [1.0, 1.0, 2.0, 2.0]
    assert found[:, -2:].tolist() == [[1.0, 0.0]] * 2 + [[0.0, 1.0]] * 2
    alone = common_columns(static.plans[:1], [np.eye(2, len(static.plans[0].priors))])
    assert alone.tolist() == [[1.0, 0.0], [0.0, 1.0]]


def test_a_law_that_never_slips_is_no_parameter_of_the_others(rig, rotating):
    """Its column, and those of its parameters, are the same for all: they were divided by 0."""
    rivals = mechanisms(rig, [observe(rotating, rig.slider).conditions])
    (static,) = (each for each in rivals if each.name == STATIC)
    random = np.random.default_rng(7)
    some, none = (np.empty((count, len(plan.priors)))
                  for count, plan in zip((100, 0), static.plans, strict=True))  # fmt: skip
    some[:] = random.standard_normal(some.shape)
    parameters = common_columns(static.plans, [some, none])
    assert parameters.shape == some.shape
    unknown = random.standard_normal((100, 5))  # says nothing of any parameter
    typical = likeness.learn(unknown, parameters)
    assert typical.expectation.shown.sum() >= 1.0
    assert 0.0 <= typical.farther(unknown[:1])[0] <= 1.0


def test_trends_are_found_where_there_are_some_and_only_there():
    random = np.random.default_rng(4)
    rise = np.r_[0.0:1.0:9j, 0.5]
    found = []
    for slope in (0.0, 0.02):
        ps = []
        for _ in range(200):
            sizes = 1.0 + slope * np.arange(15) + 0.03 * random.standard_normal(15)
            saw = np.concatenate([rise * size for size in sizes])
            ps.append(steadiness(trend(saw, slip_cycles(saw))))
        found.append(np.mean(np.array(ps) < 0.01))
    assert found[0] <= 0.01 + 3.0 * (0.01 / 200) ** 0.5
    assert found[1] > 0.9


# static friction on the misaligned rig

CROWD = (ROTATION, RATE_AND_STATE, LUGRE, MISALIGNED_STATIC)


@pytest.fixture(scope="module")
def crowd():
    """Four clouds, each 3 standard deviations from the next in the first of three features."""
    labels = np.repeat(np.arange(len(CROWD)), 200)
    features = np.random.default_rng(8).standard_normal((len(labels), 3))
    features[:, 0] += 3.0 * labels
    return Simulations(CROWD, features, labels)


def test_contacts_with_memory_are_told_from_a_static_peak_on_the_misaligned_rig(crowd, tmp_path):
    check = StaticCheck.of(crowd, tmp_path / "check.npz")
    new = np.outer([6.0, 7.5, 9.0], [1.0, 0.0, 0.0])  # LuGre, between, static friction
    sure, even, none = check.probability(LUGRE, new)
    assert sure > 0.9
    assert even == pytest.approx(0.5, abs=0.2)
    assert none < 0.1
    assert np.array_equal(check.probability(ROTATION, new), np.ones(3))
    stored = StaticCheck.of(crowd, tmp_path / "check.npz")
    assert np.array_equal(stored.probability(LUGRE, new), check.probability(LUGRE, new))


def test_without_simulations_of_a_static_peak_nothing_is_told_from_it(crowd):
    for names in (CROWD[:3], (ROTATION, MISALIGNED_STATIC)):
        check = StaticCheck.of(crowd.among(names))
        assert np.array_equal(check.probability(LUGRE, np.zeros((2, 3))), np.ones(2))


def test_static_friction_on_the_misaligned_rig_is_simulated_but_not_claimed(rig, rotating, odds):
    conditions = [observe(rotating, rig.slider).conditions]
    *_, last = mechanisms(rig, conditions)
    assert last.name == MISALIGNED_STATIC
    assert all("phi" in plan.priors for plan in last.plans)
    assert MISALIGNED_STATIC not in odds.names


def test_the_static_peak_stands_above_constant_friction_and_above_the_law_of_the_rig(rig, rotating):
    conditions = [observe(rotating, rig.slider).conditions]
    *_, last = mechanisms(rig, conditions)
    constant, weakening = last.plans
    assert type(constant.slider.friction) is st.Coulomb
    assert type(weakening.slider.friction) is type(rig.slider.friction)
    assert weakening.basis == constant.basis == rig.slider
    random = np.random.default_rng(6)
    for values in (weakening.parameters(weakening.draw(random)) for _ in range(50)):
        assert values["friction.mu_static"] >= values["friction.mu_0"]
        assert values["friction.mu_0"] > values["friction.mu_inf"]


@pytest.mark.parametrize(
    "law",
    [
        st.Coulomb(mu_0=0.2),  # the first law already
        st.ExponentialWeakening(mu_0=0.2, mu_inf=0.15, v_f="10 mm/s", mu_static=0.22),  # its own
        st.laws.Anisotropic(st.Coulomb(mu_0=0.2), ratio=0.8),  # constant, too
    ],
)
def test_a_law_without_room_for_a_static_peak_is_simulated_with_none(rig, rotating, law):
    conditions = [observe(rotating, rig.slider).conditions]
    priors = {path: its for path, its in rig.priors.items() if not path.startswith("friction.")}
    other = rig._replace(slider=rig.slider.model_copy(update={"friction": law}), priors=priors)
    *_, last = mechanisms(other, conditions)
    assert [type(plan.slider.friction) for plan in last.plans] == [st.Coulomb]


def test_a_law_within_an_anisotropic_one_has_a_static_peak_too(rig, rotating):
    """None was simulated, and a claim of LuGre was said to be checked against one."""
    conditions = [observe(rotating, rig.slider).conditions]
    law = st.laws.Anisotropic(rig.slider.friction, ratio=0.8)
    priors = {path: its for path, its in rig.priors.items() if not path.startswith("friction.")}
    other = rig._replace(slider=rig.slider.model_copy(update={"friction": law}), priors=priors)
    *_, last = mechanisms(other, conditions)
    _, weakening = last.plans
    at_rest = weakening.slider.friction.law.mu_static
    assert at_rest == weakening.priors["friction.mu_static"].high
    assert weakening.slider.friction.ratio == 0.8
    weakening.draw(np.random.default_rng(0))


# whether the mass rests where rotation is claimed


def plan_with(rig, rotating, k_y, **changes):
    """Return a plan of rotation with a known stiffness across, and other conditions."""
    seen = observe(rotating, rig.slider).conditions._replace(**changes)
    priors = {path: prior for path, prior in rig.priors.items() if path != "k_y"}
    priors["phi"] = Uniform(np.radians(1.5), np.radians(3.0))
    return plan_for(rig._replace(slider=rig.slider.replace(k_y=k_y), priors=priors), [seen])


@pytest.mark.parametrize(
    ("k_y", "low", "high"),
    [
        ("20 kN/m", 0.98, 1.0),  # fills the circle in many loadings only
        ("90 MN/m", 0.0, 0.02),  # at once
        ("0.5 MN/m", 0.01, 0.25),  # and the mass rests and hops again and again
    ],
)
def test_the_mass_rests_until_the_force_across_has_filled_the_circle(rig, rotating, k_y, low, high):
    """It follows the drive across on average from then on, whether it creeps or hops."""
    own = plan_with(rig, rotating, k_y)
    shares = shares_at_rest(own, np.random.default_rng(5).standard_normal((12, len(own.priors))))
    assert np.isfinite(shares).sum() > 6
    assert low <= Rest.among(shares).middle <= high


@pytest.mark.parametrize("k_y", ["20 kN/m", "0.9 MN/m"])
def test_the_share_at_rest_is_that_of_the_mass_whatever_the_sensor_shows(rig, rotating, k_y):
    """Peaks come late through a filter: read there, a mass that is held followed the drive.

    The stretch across is that after the slip. Held masses were called rotation for it.
    """
    seen = observe(rotating, rig.slider).conditions
    own, found = plan_with(rig, rotating, k_y), []
    scores = np.random.default_rng(5).standard_normal((6, len(own.priors)))
    for filters in ((), (LowPass(10.0 / seen.cycle, 4),)):
        noise = {each: its._replace(filters=filters) for each, its in seen.noise.items()}
        found.append(shares_at_rest(plan_with(rig, rotating, k_y, noise=noise), scores))
    both = np.isfinite(found).all(axis=0)
    assert both.sum() > 2
    plain, filtered = (each[both] for each in found)
    assert filtered.tolist() == plain.tolist()
    assert (plain > HELD).all() == (k_y == "20 kN/m")


@pytest.mark.parametrize("block", [1, 3])
def test_the_share_at_rest_is_what_the_stretch_across_says(rig, rotating, block):
    """k_y V sin(phi) t is the force of a mass at rest: by the measured force across."""
    quiet = dict.fromkeys(("force", "force_across"), Noise(0.0))
    own = plan_with(rig, rotating, "90 kN/m", noise=quiet, block=block)
    seen, found = own.conditions[0], []
    for number in range(12):
        scores, (made,) = draw(own, number, 6)
        if made is None:
            continue
        across, (before, peak, _) = made.channels["force_across"], made.cycles
        told = share_at_rest(made, seen)
        stretched = (across[peak] - across[before + 1]).sum() / own.slider.k_y
        way = seen.velocity * np.sin(own.parameters(scores)["phi"])
        lasts = seen.step * (peak - before - 1).sum()
        found.append((told, min(max(stretched / (way * lasts), 0.0), 1.0)))
    shares, measured = np.array(found).T
    assert np.ptp(shares) > 0.2
    apart = np.abs(shares - measured)
    assert np.median(apart) < 0.03
    assert apart.max() < 0.15  # a measured sample is a mean, that at the peak with some of the slip


def test_a_drive_along_the_spring_has_no_way_across(rig, rotating):
    (_, static, *_) = mechanisms(rig, [observe(rotating, rig.slider).conditions])
    made = next(draw(static.plans[0], 0, 5)[1])
    assert share_at_rest(made, static.plans[0].conditions[0]) == 1.0


@pytest.mark.parametrize(("share", "told"), [(0.5, 0.5), (1.3, 1.0), (-0.5, 0.0)])
def test_the_share_at_rest_is_of_the_loadings_that_are_used(rig, rotating, share, told):
    """From the sample after a trough to that before a peak: at these the mass may slip.

    A dip that noise would hide is not a slip; the cycles before the last ones are not used.
    """
    conditions = observe(rotating, rig.slider).conditions
    slider = conditions.slider_of(rig.slider.replace(phi="2 deg"))
    rise, step = 20, 1e-3
    noise = {"force": Noise(0.06 * slider.k_x)}  # 8 of it are half of the span
    conditions = conditions._replace(cycles=3, noise=noise)
    way = conditions.velocity * slider.direction[1] * step
    elongation = np.linspace(0.0, 1.0, rise)
    elongation[10:12] = elongation[9] - 0.4
    rows = []
    for number in range(7):
        its = share + 0.2 * (number - 4) if number > 2 else 0.9
        across = way * its * np.arange(float(rise))
        across[[0, -1]] = 40.0 * way, -30.0 * way  # the slip swings on, and has begun
        rows.append(np.stack([elongation, across, 0.0 * across, 0.0 * across], axis=1))
    motion = SampledMotion(step * np.arange(7.0 * rise), np.concatenate(rows), np.arange(7))
    blank = Cycles(*np.zeros((3, 1), int))
    made = Synthetic({}, blank, motion, slider)
    assert share_at_rest(made, conditions) == pytest.approx(told)


def test_each_simulation_with_a_record_s_parameters_has_chance_of_its_own(rig, rotating):
    own = plan_with(rig, rotating, "0.2 MN/m")
    shares = shares_at_rest(own, np.zeros((3, len(own.priors))))
    assert len(set(shares.tolist())) == 3


def test_the_share_at_rest_is_not_known_of_loadings_between_two_samples(rig, rotating):
    own = plan_with(rig, rotating, "20 kN/m")
    made = next(filter(None, (next(draw(own, number, 6)[1]) for number in range(9))))
    motion, every = made.motion, 10
    few = SampledMotion(motion.time[::every], motion.rows[::every], motion.troughs // every)
    assert share_at_rest(made._replace(motion=few), own.conditions[0]) > HELD
    saw = motion.rows[:40].copy()
    saw[:, 0] = np.tile([0.0, 0.1], 20)
    motion = SampledMotion(motion.time[:40], saw, motion.troughs)
    assert np.isnan(share_at_rest(made._replace(motion=motion), own.conditions[0]))


def test_quantiles_of_rest_leave_out_what_has_no_cycles():
    shares = np.append(np.linspace(0.5, 1.0, 101), [np.nan] * 9)
    assert Rest.among(shares) == pytest.approx((0.55, 0.75, 0.95))
    assert Rest.among(shares).known
    assert not Rest.among(np.full(3, np.nan)).held
    assert Rest(0.8, 0.9, 1.0).held
    assert not Rest(0.79, 0.99, 1.0).held


def test_of_few_simulations_with_cycles_the_rest_is_not_known():
    """A tenth of nine is not one. Of none it was "for nan % of the drive's way across"."""
    shares = np.append(np.ones(10), np.full(9, np.nan))
    assert Rest.among(shares).held
    few = Rest.among(shares[1:])
    assert not few.known
    assert not few.held
    unknown = odds_with(rest=few)
    assert unknown.decision == UNDECIDED
    said = " ".join(map(str, unknown.tables()))
    assert "Whether the mass creeps or is held is not known: of 32 simulations" in said
    assert "nan" not in said
    assert "share_at_rest" not in unknown.data.attrs


def test_rotation_is_said_to_creep_where_its_simulations_do(odds):
    low, middle, high = odds.rest
    assert 0.0 <= low < middle < high < 0.2
    assert "and follows the rest of it" in " ".join(odds.sentences())
    assert odds.data.attrs["share_at_rest"] == middle


def test_rest_is_that_of_simulations_with_the_parameters_of_the_record(rig, rotating, folder):
    """In so few simulations those alike are a third of all, but those nearest to 2.5 deg."""
    seen = observe(rotating, rig.slider)
    rivals = mechanisms(rig, [seen.conditions])
    simulated = simulate(rivals, SIMULATIONS, folder)

    def apart(plan, scores):  # of the misalignment, whose score at 2.5 deg is 0.52
        return np.abs(scores[:, [*plan.priors].index("phi")] - 0.52)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(comparison, "shares_at_rest", apart)
        found = comparison.odds_of(simulated, rig, [seen]).rest
    every = Rest.among(apart(rivals[0].plans[0], simulated.parameters[0]))
    assert found.middle < 0.85 * every.middle, (found, every)


# what is claimed

USUAL = Likeness(0.5, np.zeros((CURVES, len(EDGES) - 1)), 0.5)
FEW = {"likeness": (USUAL._replace(bends=USUAL.bends[:60]), USUAL, USUAL), "counts": (60, 99, 99)}


def odds_with(**changes):
    """Odds that allow a claim, with changes."""
    sure = Odds(
        names=(ROTATION, STATIC, RATE_AND_STATE), probabilities=np.array([0.95, 0.03, 0.02]),
        by_halves=np.array([[0.9, 0.05, 0.05], [0.7, 0.2, 0.1]]), confusion=np.eye(3, 4),
        likeness=(USUAL, USUAL, USUAL), bend=np.zeros(len(EDGES) - 1),
        steady=0.5, counts=(100, 100, 100), absent=(), channels=("force",),
    )  # fmt: skip
    return replace(sure, **changes)


def test_a_claim_needs_every_part_to_agree():
    assert odds_with().decision == ROTATION
    assert odds_with(probabilities=np.array([0.92, 0.05, 0.03])).decision == ROTATION
    far, bent = USUAL._replace(farther=0.01), USUAL._replace(larger=0.005)
    for change, reason in (
        ({"probabilities": np.array([0.85, 0.1, 0.05])}, "0.85; a claim needs 0.9"),
        ({"by_halves": np.array([[0.999, 1e-3, 0.0], [0.3, 0.6, 0.1]])}, "of > 0.99 and 0.30"),
        ({"likeness": (far, USUAL, USUAL)}, "are less like the others"),
        ({"likeness": (bent, USUAL, USUAL)}, "loading curve is not like"),
        ({"steady": 1e-3}, "Friction drifts"),
        ({"beside_static": 0.7}, f"Beside {MISALIGNED_STATIC}, which may look the same"),
        (FEW, "Only 60 of 1000 simulated records of rotation of the friction vector have cycles"),
    ):
        found = odds_with(**change)
        assert found.decision == UNDECIDED
        (objection,) = found.objections()
        assert reason in objection
        assert "No mechanism is claimed" in str(found.tables()[0])
    assert odds_with(likeness=(USUAL, far, bent)).decision == ROTATION  # of the others


def test_a_curve_that_too_few_simulations_test_says_how_many_do():
    """Of fewer than 100, none of which departs as far, more than 1 % may: any curve passed."""
    least = len(FEW["likeness"][0].bends) + 1
    assert 1.0 / least > BENT > 1.0 / (CURVES + 1)
    said = " ".join(odds_with(**FEW).sentences())
    assert "a claim needs 100: simulate 2000 of each (simulations=2000 of st.mechanism)." in said
    with in_terminal():
        assert "simulate 2000 of each: -n 8000." in " ".join(odds_with(**FEW).sentences())


def test_a_claim_from_few_simulations_says_so():
    """`stiction fit --mechanism -n 2000` took 500 of each, and the claim did not say it."""
    said = odds_with(simulations=500).sentences()
    assert said[0].startswith(f"Claimed: {ROTATION}")
    assert said[1].startswith("Learned from 500 simulations of each mechanism in place of 1000")
    with in_terminal():
        assert odds_with(simulations=500).sentences()[1].endswith("Simulate 1000 of each: -n 4000.")
    assert "Learned from" not in " ".join(odds_with().sentences())


def test_too_few_simulations_to_claim_anything_are_refused(rig, rotating):
    with pytest.raises(DescriptionError, match="must be at least 100 of each mechanism, is 75"):
        st.mechanism(rotating, rig, simulations=75)


def test_the_probability_of_a_mechanism_that_the_record_is_unlike_is_not_shown():
    """Above "rate and state | > 0.99 | 0 %" stood "The record is not like those"."""
    far = USUAL._replace(farther=0.0)
    sure = {"probabilities": np.array([0.995, 0.003, 0.002]), "likeness": (far, USUAL, USUAL)}
    found = odds_with(**sure)
    assert "> 0.99" not in f"{found}{found!r}"
    rows = found.tables()[0].table.rows
    assert [row[1] for row in rows] == ["unlike", "< 0.01", "< 0.01"]
    assert f"{ROTATION} unlike" in repr(found)
    assert found.data["unlike"].values.tolist() == [True, False, False]
    improbable = odds_with(likeness=(far, USUAL, USUAL), probabilities=np.array([0.6, 0.3, 0.1]))
    (objection,) = improbable.objections()
    assert "are less like the others" in objection
    bars, *_ = plot_mechanism(found)
    assert bars.patches[0].get_width() == 0.0


def test_nothing_is_claimed_where_an_analysis_counts_other_cycles():
    found = odds_with(disputed="An analysis counts others.")
    assert found.decision == UNDECIDED
    assert found.sentences()[:2] == ["No mechanism is claimed.", "An analysis counts others."]


FIRM, CREEPING = Rest(0.9, 0.96, 1.0), Rest(0.7, 0.96, 1.0)


def test_where_rotation_is_claimed_and_its_mass_rests_it_is_static_friction_on_that_rig():
    """A mass that rests from slip to slip was called rotation, on granite in 46 % of records."""
    held = odds_with(rest=FIRM)
    assert held.decision == MISALIGNED_STATIC
    said = " ".join(held.sentences())
    assert f"Claimed: {MISALIGNED_STATIC}." in said
    assert f"{ROTATION} has a probability of 0.95." in said
    assert (
        "for 96 % of the drive's way across (in 80 % of the simulations 90 % to 100 %): it is held"
        in said
    )
    assert "constant friction below a static coefficient may look the same" in said
    assert "follows" not in said
    assert held.data.attrs["share_at_rest"] == 0.96
    assert "ellipse" in said  # without the force across
    always = " ".join(odds_with(rest=Rest(1.0, 1.0, 1.0)).sentences())
    assert "for 100 % of the drive's way across: it is held" in always
    bars, *_ = plot_mechanism(held)
    colors = [bar.get_facecolor() for bar in bars.patches]
    assert colors[0] != colors[1] == colors[2]


def test_a_wide_band_does_not_flatten_the_lines_of_loadings(odds):
    """A few simulations with bends of tens of per cent hid how the mechanisms differ."""
    its = odds.likeness[odds.likeliest]
    wide = its._replace(bends=its.bends + np.linspace(-0.5, 0.5, len(its.bends))[:, None])
    likeness = [wide if i == odds.likeliest else each for i, each in enumerate(odds.likeness)]
    *_, ax = plot_mechanism(replace(odds, likeness=tuple(likeness)))
    lines = np.concatenate([line.get_ydata() for line in ax.lines])
    bottom, top = ax.get_ylim()
    assert bottom < lines.min() < lines.max() < top
    assert top - bottom < 3.0 * np.ptp(lines)
    assert "95 % of its simulations" in [text.get_text() for text in ax.get_legend().texts]


def test_where_simulations_may_creep_the_claim_is_rotation_and_says_how_long_they_rest():
    creeping = odds_with(rest=CREEPING)
    assert creeping.decision == ROTATION
    said = " ".join(creeping.sentences())
    assert "(in 80 % of the simulations 70 % to 100 %) and follows the rest of it" in said
    assert MISALIGNED_STATIC not in said


def test_rest_is_no_ground_for_a_claim():
    unsure = odds_with(rest=FIRM, probabilities=np.array([0.85, 0.1, 0.05]))
    assert unsure.decision == UNDECIDED
    sure = np.array([0.02, 0.95, 0.03])
    static = odds_with(rest=FIRM, probabilities=sure, by_halves=np.array([sure, sure]))
    assert static.decision == STATIC


def test_both_comparisons_together_refuse_a_twentieth_of_a_mechanism_s_own_records():
    random = np.random.default_rng(6)
    shares = random.random((4000, 2))  # uniform, as those of a mechanism's own records are
    likely = [USUAL._replace(farther=far, larger=bent) for far, bent in shares]
    refused = np.mean([odds_with(likeness=(its, USUAL, USUAL)).decision != ROTATION
                       for its in likely])  # fmt: skip
    error = (0.05 * 0.95 / 4000) ** 0.5
    assert refused == pytest.approx(0.05, abs=3.0 * error)  # 1 - 0.96 * 0.99 = 0.0496


def test_an_elliptic_limit_loads_as_another_misalignment_does(rig):
    """Creep on an ellipse with ratio r is that at tan(phi') = r tan(phi), up to phi^2."""
    slider = rig.slider.replace(k_y="90 MN/m", phi="2 deg")
    law = slider.friction
    for ratio in (0.7, 1.4):
        like = np.degrees(np.arctan(ratio * np.tan(np.radians(2.0))))
        ellipse, circle, other = (
            st.simulate(each, 1.6, sample_rate=100.0).samples["u_x"]
            for each in (
                slider.replace(friction=Anisotropic(law, ratio=ratio)),
                slider.replace(phi=f"{like} deg"),
                slider,
            )
        )
        before = int(np.argmax(np.diff(ellipse) < 0.0)) or len(ellipse)  # the first slip
        apart, beside = (np.abs(ellipse - its)[:before].max() for its in (circle, other))
        assert apart < np.radians(2.0) ** 2 * ellipse[:before].max()
        assert beside > 5.0 * apart


def test_an_ellipse_is_said_to_look_like_misalignment_without_the_force_across():
    assert "ellipse" in " ".join(odds_with().sentences())
    assert "ellipse" not in " ".join(odds_with(channels=("force", "force_across")).sentences())


def test_a_claim_of_contacts_with_memory_names_the_law_that_may_pass_for_it():
    sure = np.array([0.02, 0.03, 0.95])
    aged = odds_with(probabilities=sure, by_halves=np.array([sure, sure]))
    assert f"may pass for {RATE_AND_STATE}" in " ".join(aged.sentences())
    assert "may pass" not in " ".join(odds_with().sentences())


def test_a_static_peak_that_was_not_compared_is_not_called_less_probable():
    """It was, where no simulation of static friction on the misaligned rig had cycles."""
    sure = np.array([0.02, 0.03, 0.95])
    aged = odds_with(
        probabilities=sure, by_halves=np.array([sure, sure]), absent=(MISALIGNED_STATIC,)
    )
    said = " ".join(aged.sentences())
    assert "was compared" not in said
    assert "Not excluded: friction that weakens with speed below a static peak" in said
    assert f"Not compared: {MISALIGNED_STATIC}." in said


@pytest.mark.parametrize(("offset", "absent"), [(5.0, (MISALIGNED_STATIC,)), (-5.0, ())])
def test_the_odds_name_what_contacts_with_memory_were_not_compared_with(
    rig, rotating, offset, absent
):
    """Where rotation is claimed, static friction on the misaligned rig is no rival of it."""
    random, seen = np.random.default_rng(1), observe(rotating, rig.slider)
    width = len(plan_for(rig, [seen.conditions]).priors)
    places = seen.features + np.repeat([[max(offset, 0.0)], [max(-offset, 0.0)]], 60, axis=0)
    simulated = Simulations(
        (ROTATION, RATE_AND_STATE), places + 0.5 * random.standard_normal(places.shape),
        np.repeat([0, 1], 60), (MISALIGNED_STATIC,), (random.standard_normal((60, width)),) * 2,
    )  # fmt: skip
    assert comparison.odds_of(simulated, rig, [seen]).absent == absent


def test_a_claim_of_static_friction_names_the_rate_and_state_that_is_like_it():
    """Below the smallest direct effect that is simulated, it was claimed without a word."""
    sure = np.array([0.02, 0.95, 0.03])
    static = odds_with(probabilities=sure, by_halves=np.array([sure, sure]))
    assert "rate and state with a direct effect a below the" in " ".join(static.sentences())
    assert "direct effect" not in " ".join(odds_with().sentences())


def test_a_claim_of_rotation_does_not_exclude_a_static_peak_beside_it():
    sure = np.array([0.02, 0.95, 0.03])
    static = odds_with(probabilities=sure, by_halves=np.array([sure, sure]))
    assert "a static coefficient of its own beside the rotation" in str(odds_with())
    assert "of its own" not in str(static)


def test_mechanisms_that_were_not_compared_are_named():
    assert "LuGre" in " ".join(odds_with(absent=("LuGre",)).sentences())
    only = odds_with(names=(ROTATION, "LuGre", RATE_AND_STATE))
    assert only.straight_excluded is None
