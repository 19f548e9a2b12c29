"""Remedies of two parameters: where they are sought, that they hold, and what is said of them."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from tests.rigs import PIN_ON_PLATE

import stiction as st
from stiction.auditing import figures, pairs
from stiction.auditing.pairs import ANGLES, FACTORS, nearest_pairs
from stiction.auditing.report import sections
from stiction.auditing.simulated_test import LEAST_WORK, SLIDES, SimulatedTest
from stiction.linear_stability.linear import growth_at
from stiction.system.parameter import change_unchecked, read


@pytest.fixture(scope="module")
def pin():
    """A rig that no misalignment alone makes slide steadily."""
    return st.audit(PIN_ON_PLATE)


def test_a_rig_that_no_misalignment_helps_is_turned_and_changed_otherwise(pin):
    """Alone, 459 times the speed was advised; turned as well, it is six times."""
    speed, stiffness = pin.pairs
    assert [each.path for each in pin.pairs] == ["drive.velocity", "k_y"]
    assert speed.works
    assert stiffness.works
    alone = next(each for each in pin.advices if each.path == "drive.velocity")
    assert speed.changes[1].then < alone.then / 50.0
    assert speed.changes[1].then < 10.0 * speed.changes[1].now
    for each in pin.pairs:
        there = pin.slider
        for change in each.changes:
            there = change_unchecked(there, change.path, change.then)
        assert st.linear_stability.growth_rate(there) < 0.0
        assert each.tried.comes_to == SLIDES
        assert each.tried.run.slider.phi == pytest.approx(there.phi)


def test_pairs_are_told_and_drawn(pin):
    what = next(part for part in sections(pin) if part.title == "What to change")
    assert "misalignment φ of 21 deg with drive velocity V of 3 mm/s" in what.sentences[0]
    rows = {row[0]: row[1:] for row in what.table.rows}
    settled = "550 ms", "1.6 mm", "steady sliding"
    assert rows["φ, V"] == ("2 deg, 500 µm/s", "together", "21 deg, 3 mm/s", *settled)
    names = [row[0].rpartition(", ")[2] for row in what.table.rows]
    factors = [6.0, 10.5, 62.0 / (0.01 * 2.0 * (2.3e3 * 0.08) ** 0.5), 460.0]
    assert [each.factor for each in pin.remedies][:4] == pytest.approx(factors)
    assert names[:2] == ["k_y", "V"]  # each with a turn
    assert names[2:4] == ["damping c_x", "drive velocity V"]
    assert "drive velocity V of 230 mm/s (on 13 m of travel)" in what.sentences[0]
    assert "damping c_x of 62 N s/m, a damping ratio of 2.3 (on 1.1 mm" in what.sentences[0]
    titles = " ".join(ax.get_title(loc="left") + ax.get_title() for ax in figures.trials(pin).axes)
    assert "φ = 21 deg, V = 3 mm/s: steady" in titles.replace("\n", " ")


def test_where_a_misalignment_helps_no_pair_is_sought():
    found = st.audit(st.presets.nakano_popov_2020())
    assert next(each for each in found.advices if each.path == "phi").works
    assert found.pairs == ()


@pytest.mark.parametrize("path", ["drive.velocity", "k_y"])
def test_pairs_of_random_rigs_leave_a_margin_and_are_the_nearest(path):
    """Stable a tenth away, too; and no smaller factor of the grid has three stable neighbours."""
    rng, seen = np.random.default_rng(20261130), 0
    for _ in range(12):
        slider = random_rig(rng)
        found = next(nearest_pairs(slider, path), None)
        now = read(slider, path)
        grid = np.array(
            [
                [
                    growth_at(change_unchecked(slider, path, now * factor), "phi", side * angle) < 0
                    for angle in np.radians(ANGLES)
                    for side in [np.sign(slider.phi)]
                ]
                for factor in FACTORS
            ]
        )
        good = np.lib.stride_tricks.sliding_window_view(grid, (3, 3)).all(axis=(2, 3))
        assert (found is not None) == good.any()
        if found is None:
            continue
        seen += 1
        angle, other = found
        first = FACTORS[1 + np.flatnonzero(good.any(axis=1))[0]]
        assert other.then / now == pytest.approx(first, rel=0.06)  # two digits of it
        assert abs(angle.then) < np.radians(ANGLES[-1])
        assert np.sign(angle.then) == np.sign(slider.phi)
        for share in (0.9, 1.1):
            there = change_unchecked(slider, path, other.then * share)
            assert growth_at(there, "phi", angle.then * 0.9) < 0.0
            assert growth_at(there, "phi", angle.then * 1.1) < 0.0
    assert seen > 6


def random_rig(rng):
    """A rig of stiffnesses, speeds and friction over decades."""
    k_x, mu_0 = 10 ** rng.uniform(1, 6), rng.uniform(0.1, 0.8)
    law = st.ExponentialWeakening(mu_0, mu_0 * rng.uniform(0.4, 0.95), 10 ** rng.uniform(-4, -1))
    return st.Slider(
        mass=10 ** rng.uniform(-3, 2),
        k_x=k_x,
        k_y=k_x * 10 ** rng.uniform(0.1, 5),
        phi=f"{rng.uniform(0.2, 8) * rng.choice([-1, 1])} deg",
        normal_load=10 ** rng.uniform(-1, 3),
        friction=law,
        drive=st.ConstantVelocity(10 ** rng.uniform(-5, -2)),
    )


def test_work_that_is_used_up_is_said(pin):
    none = tuple(pairs.advise_pairs(pin.slider, LEAST_WORK - 1))
    assert [each.cut for each in none] == [True, True]
    what = sections(replace(pin, pairs=none))[-1]
    assert [row[-1] for row in what.table.rows[-2:]] == ["not tried", "not tried"]
    assert any(each.startswith("Values farther") for each in what.sentences)


def test_where_no_pair_slides_steadily_the_range_is_told(pin, monkeypatch):
    monkeypatch.setattr(pairs, "nearest_pairs", lambda *_: iter(()))
    none = tuple(pairs.advise_pairs(pin.slider, 10 * LEAST_WORK))
    row = sections(replace(pin, pairs=none))[-1].table.rows[-1]
    assert row[2:4] == ("nowhere", "to 45 deg and 1000 times")
    assert row[4:] == ("", "", "no values in that range")


def test_springs_in_series_have_no_transverse_stiffness_of_their_own():
    slider = st.presets.nakano_popov_2020()
    cell = st.Spring("load cell", k_x="2 kN/m", k_y="rigid")
    chain = slider.replace(springs=[cell, st.Spring("leaf", "2 kN/m", "10 MN/m")])
    assert [each.path for each in pairs.advise_pairs(chain, 0)] == ["drive.velocity"]


def test_from_a_large_misalignment_the_least_turn_is_sought():
    found = [
        next(nearest_pairs(st.presets.nakano_popov_2020().replace(phi=phi), "drive.velocity"))
        for phi in ("1 deg", "60 deg")
    ]
    assert found[1][0].then > 2.0 * found[0][0].then


def test_pairs_that_are_not_reached_from_rest_share_the_work(pin, monkeypatch):
    """Three of each partner, each at least half as far again as the last."""
    tried = []

    def fail(slider, left, _):
        tried.append((slider, left))
        return pin.observation

    monkeypatch.setattr(pairs, "try_change", fail)
    work = 100 * max(LEAST_WORK, pin.observation.work)
    found = tuple(pairs.advise_pairs(pin.slider, work))
    assert [each.works for each in found] == [False, False]
    assert len(tried) == 6
    assert tried[0][1] <= work // 2
    for path, three in (("drive.velocity", tried[:3]), ("k_y", tried[3:])):
        values = [read(slider, path) for slider, _ in three]
        assert all(1.4 < after / before < 2.2 for before, after in pairwise(values))


def test_a_pair_whose_simulation_was_cut_or_whose_slide_is_unstable_is_no_remedy(pin):
    """Such an audit is not whole, and the pair is not advised."""
    speed, stiffness = pin.pairs
    cut = SimulatedTest(st.simulate(pin.slider, "1 s", max_steps=100), growth=-1.0)
    seen = replace(pin, pairs=(speed._replace(tried=cut), stiffness))
    assert (pin.ok, seen.ok) == (True, False)
    what = sections(seen)[-1]
    row = next(row for row in what.table.rows if row[0] == "φ, V")
    assert row[-1].startswith("not known: the simulation was cut at")
    assert "with drive velocity" not in what.sentences[0]
    assert "with transverse stiffness" in what.sentences[0]
    assert not speed._replace(tried=replace(speed.tried, growth=1.0)).works
