"""The tolerance budget of a rig with an uncertain misalignment."""

from dataclasses import replace
from math import degrees, isnan, nan, radians

import numpy as np
import pytest
from matplotlib.figure import Figure

import stiction as st
from stiction.auditing import report
from stiction.auditing import tolerance as module
from stiction.auditing.page import page
from stiction.auditing.tolerance import (
    ALLOWED,
    Alignment,
    Budget,
    Reading,
    budget,
    crossing,
    limit,
    read,
    round_down,
    turn_to,
)
from stiction.plotting import plot_tolerance

TEXT = """
[slider]
mass = "80 g"
k_x = "2.3 kN/m"
k_y = "0.9 MN/m"
phi = "2 +- 1 deg"
normal_load = "4 N"

[friction]
law = "exponential-weakening"
mu_0 = "0.6 +- 0.02"
mu_inf = 0.45
v_f = "10 mm/s"

[drive]
velocity = "0.5 mm/s"
"""


@pytest.fixture(scope="module")
def found():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(module, "DRAWS", 8)
        yield st.audit(TEXT)


def test_the_error_passes_2_percent_at_the_limit(found):
    slider, aligned = st.Rig.from_toml(TEXT).slider, found.budget.aligned.static

    def error(angle):
        return abs(read(turn_to(slider, angle)).static / aligned - 1.0)

    def mean(around):
        return np.mean([error(angle) for angle in around * np.linspace(0.95, 1.05, 8)])

    # The phase of the transverse oscillation at a slip, which the last bits of a processor decide,
    # changes the error by 5 %, one standard deviation; it grows like the angle to the power 0.7. A
    # mean of 8 tests is off by 2.5 % in the angle, a crossing among 24 by as much: four of both.
    angle = found.budget.alignment.angle
    assert mean(0.86 * angle) < ALLOWED < mean(1.14 * angle)
    assert found.budget.alignment.least < ALLOWED
    said = f"{round_down(degrees(angle)):g} deg to keep the error of mu_static below 2 %"
    assert f"Align to better than {said}" in str(found)


def test_readings_at_the_ends_are_those_of_audits_there(found):
    """At 97.5 % of the prior, from a test of its own."""
    end = float(found.budget.ends[2])
    assert end == pytest.approx(radians(2.0 + 1.96 * 1.0), rel=0.01)  # but for the bound at zero
    other = read(st.Rig.from_toml(TEXT).slider.replace(phi=f"{end!r} rad"))
    assert found.budget.at_ends[2] == pytest.approx(np.array(other), rel=1e-9)


def test_a_certain_misalignment_leaves_the_other_parameters_uncertain(monkeypatch):
    """They were ignored without a word unless phi was uncertain, too."""
    monkeypatch.setattr(module, "DRAWS", 4)
    monkeypatch.setattr(module, "alignment", lambda *_: Alignment(nan, 0.1, 0.0))
    rig = st.Rig.from_toml(TEXT.replace("2 +- 1 deg", "2 deg"))
    other = budget(rig, lambda _: None)
    low, high = other.intervals[:, 0]
    assert 0.55 < low < other.at_ends[0, 0] < high < 0.65
    assert other.certain
    assert np.degrees(other.angles) == pytest.approx(2.0)
    said = module.section(other)
    text = " ".join(said.sentences)
    assert "The misalignment is 2 deg throughout, as stated without an uncertainty." in text
    assert "Uncertain, there only: friction.mu_0." in text
    assert said.table.headings == ("quantity", "aligned", "at 2 deg", "95 %")
    monkeypatch.setattr(module, "budget", lambda rig, progress: other)
    assert report.audit(rig).tables()[-1].sentences == said.sentences


def test_what_else_is_uncertain_widens_the_interval(found):
    low, high = found.budget.intervals[:, 0]
    ends = found.budget.at_ends[:, 0]
    assert found.budget.others == ("friction.mu_0",)
    assert high - low > 1.5 * np.ptp(ends)  # 8 draws of 0.6 +- 0.02
    assert "Also uncertain, there only: friction.mu_0" in str(found)


def test_without_uncertainty_there_is_no_budget():
    plain = TEXT.replace("2 +- 1 deg", "2 deg").replace("0.6 +- 0.02", "0.6")
    assert st.audit(plain).budget is None


@pytest.fixture(scope="module")
def text_of_page(found):
    return page(found, "pin")


def test_the_page_and_the_figure_show_it(found, text_of_page):
    assert "How well to align" in text_of_page
    axes = plot_tolerance(found.budget)
    assert [len(ax.lines[0].get_xdata()) for ax in axes] == [8] * 4
    (line,) = [line for line in axes[0].lines if len(set(line.get_xdata())) == 1 and
               line.get_linestyle() != "None"]  # fmt: skip
    assert line.get_xdata()[0] == pytest.approx(degrees(found.budget.alignment.angle))
    assert isinstance(axes[0].figure, Figure)
    axes[0].figure.draw_without_rendering()
    legend = axes[0].get_legend()
    assert legend.get_window_extent().y0 > axes[0].bbox.y1 - 1.0  # above: it covers no draws


def test_a_limit_that_is_not_reached_is_said():
    assert limit(Alignment(nan, radians(30.0), 0.0001)) == (
        "An error of mu_static of 2 % is not reached up to 30 deg."
    )
    assert limit(Alignment(nan, radians(0.02), 0.0215)) == (
        "Alignment to 0.02 deg is not enough to keep the error of mu_static below 2 %: "
        "it is 2.15 % there."
    )


def test_single_tests_that_scatter_are_said():
    text = limit(Alignment(radians(2.24), radians(2.9), 0.001, radians(1.61)))
    assert text == (
        "Align to better than 2.2 deg to keep the error of mu_static below 2 %. "
        "That is a mean: of the tests tried, some are off by more from 1.6 deg on."
    )
    plain = limit(Alignment(0.04, 0.05, 0.001, 0.0401))
    assert plain == "Align to better than 2.2 deg to keep the error of mu_static below 2 %."
    assert limit(Alignment(nan, radians(30.0), 0.001, radians(3.0))) == (
        "An error of mu_static of 2 % is not reached up to 30 deg on average; of the tests tried, "
        "some are off by more from 3 deg on."
    )


def test_what_no_test_shows_is_not_excluded():
    """Of one rig 1 of 40 tests nearer was off by 23 %: it slipped on without a stick."""
    text = limit(Alignment(radians(2.24), radians(2.9), 0.001, radians(2.24), 19))
    assert text.endswith(
        "None of 19 tests at smaller angles is off by more, which does not exclude a narrow range "
        "in which it is."
    )


def test_a_single_test_that_is_off_does_not_set_the_limit(monkeypatch):
    """Errors of 1.3 % that scatter to 2.2 % at small angles: the limit was 0.07 deg, of 0.7."""
    slider = st.Rig.from_toml(TEXT).slider

    def read_all(rigs, _):
        phi = np.degrees([abs(rig.misalignment) for rig in rigs])
        error = 0.013 * (1.0 + 0.7 * np.sin(40.0 * np.log(phi))) + 0.007 * (phi / 0.7) ** 2
        return np.outer(1.0 - error, np.ones(4))

    monkeypatch.setattr(module, "read_all", read_all)
    found = module.alignment(slider, 1.0, radians(5.0))
    assert degrees(found.angle) == pytest.approx(0.7, rel=0.3)
    assert degrees(found.first) < 0.2


def aligned_with(error, patch, farthest=5.0):
    """Return the alignment of a rig whose tests have an error, by degrees, and what was asked."""
    asked = []

    def read_all(rigs, _):
        asked.append(np.degrees([rig.misalignment for rig in rigs]))
        return np.outer([1.0 + error(phi) for phi in asked[-1]], np.ones(4))

    patch.setattr(module, "read_all", read_all)
    return module.alignment(st.Rig.from_toml(TEXT).slider, 1.0, radians(farthest)), asked


@pytest.mark.parametrize("at", [0.007, 0.05, 1.3, 9.0, 14.5])
def test_an_error_in_proportion_to_the_angle_is_allowed_up_to_where_it_passes(at, monkeypatch):
    """Nearer than the scan begins, in it, beyond the prior, and at the last angle of the scan."""
    found, asked = aligned_with(lambda phi: 0.02 * phi / at, monkeypatch)
    assert degrees(found.angle) == pytest.approx(at, rel=1e-9)
    scan = np.sort(np.concatenate(asked[:-1]))
    beyond = int(np.searchsorted(scan, at))  # tests go on to one beyond the first that is too large
    assert degrees(found.until) == pytest.approx(scan[beyond])
    assert asked[-1].min() > scan[beyond - 1]
    assert asked[-1].max() > scan[min(beyond, len(scan) - 2)]
    every = np.concatenate(asked)
    assert found.nearer == (every < at).sum()
    assert degrees(found.first) == pytest.approx(every[every > at].min())


def test_an_error_that_no_alignment_allows_is_that_of_the_smallest_angle(monkeypatch):
    found, asked = aligned_with(lambda phi: 0.05, monkeypatch)
    assert isnan(found.angle)
    assert (degrees(found.until), found.least) == pytest.approx((0.002, 0.05))
    assert len(asked) == 2


@pytest.mark.parametrize(("farthest", "until"), [(5.0, 15.0), (20.0, 20.0), (50.0, 30.0)])
def test_an_error_that_is_not_reached_is_looked_for_far_enough(farthest, until, monkeypatch):
    found, _ = aligned_with(lambda phi: 0.001, monkeypatch, farthest)
    assert isnan(found.angle)
    assert isnan(found.first)
    assert (degrees(found.until), found.least) == pytest.approx((until, 0.001))


def test_a_single_test_that_is_off_is_named_where_the_mean_is_not(monkeypatch):
    found, asked = aligned_with(lambda phi: 0.021 * (0.3 < phi < 0.6), monkeypatch)
    assert isnan(found.angle)
    assert degrees(found.first) == pytest.approx(asked[0][asked[0] > 0.3].min())


@pytest.mark.parametrize("known", [0.021, 3.0])
def test_errors_are_known_up_to_the_first_test_that_ends_early(known, monkeypatch):
    found, asked = aligned_with(lambda phi: 0.001 if phi < known else nan, monkeypatch)
    assert isnan(found.angle)
    assert degrees(found.until) == pytest.approx(asked[0][asked[0] < known].max())


def test_tests_that_end_early_beside_the_limit_are_left_out(monkeypatch):
    scan = np.degrees(np.geomspace(radians(module.NEAREST), radians(15.0), module.SCAN))

    def error(phi):
        early = 0.9 < phi < 1.1 and min(abs(phi - scan)) > 1e-9
        return nan if early else 0.02 * phi

    found, asked = aligned_with(error, monkeypatch)
    assert np.isnan([error(phi) for phi in asked[-1]]).any()
    assert degrees(found.angle) == pytest.approx(1.0, rel=1e-9)


def test_where_no_test_reaches_its_end_nothing_is_said_of_the_limit(monkeypatch):
    """It was "not reached up to 0 deg"."""
    found, _ = aligned_with(lambda phi: nan, monkeypatch)
    assert limit(found) == (
        "Where the error of mu_static is 2 % is not known: no test reaches its end."
    )


def test_a_mean_weighs_each_test_by_the_angles_about_it():
    """In the logarithm: here log(2) and log(100)/2 of the first two, which fall."""
    angles, errors = np.array([1.0, 2.0, 100.0]), np.array([3.0, 1.0, 5.0])
    first, second = np.log(2.0), 0.5 * np.log(100.0)
    mean = (3.0 * first + second) / (first + second)
    assert module.growing_mean(angles, errors) == pytest.approx([mean, mean, 5.0])


def test_a_test_that_ends_early_reads_nothing(monkeypatch):
    monkeypatch.setattr(module, "MOST_STEPS", 100)
    reading = read(st.Rig.from_toml(TEXT).slider)
    assert np.isnan(reading[:3]).all()
    assert reading.oscillation > 0.0


def test_a_crossing_is_found_in_errors_that_jump_grow_or_scatter():
    angles = np.geomspace(1.0, 3.0, 24)
    step = angles[1] / angles[0] - 1.0
    assert crossing(angles, 0.01 * angles) == pytest.approx(2.0, rel=1e-9)
    assert crossing(angles, np.where(angles < 1.7, 0.0, 1.0)) == pytest.approx(1.7, rel=step)
    assert [crossing(angles, np.full(24, error)) for error in (0.03, 0.01)] == [1.0, 3.0]
    found = []
    for seed in range(100):
        noise = 0.001 * np.random.default_rng(seed).standard_normal(24)
        found.append(crossing(angles, 0.02 * (angles / 2.0) ** 0.7 + noise))
    # 5 % of the allowed error is 7 % in the angle; about a third of the 24 tests lie near it
    assert np.mean(found) == pytest.approx(2.0, rel=0.03)
    assert np.std(found) < 0.07 * 2.0


def test_a_misalignment_of_the_other_sign_is_sought_on_its_side(found):
    """A mirrored rig has the same limit."""
    rig = st.Rig.from_toml(TEXT.replace("2 +- 1 deg", "-2 +- 1 deg"))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(module, "DRAWS", 2)
        mirrored = budget(rig, lambda fraction: None)
    # which does not depend on the draws
    assert mirrored.alignment.angle == pytest.approx(found.budget.alignment.angle, rel=1e-3)
    assert np.median(mirrored.angles) < 0.0


def test_the_interval_holds_95_percent_of_other_tests():
    """Quantiles between the smallest and the largest of 64 tests held 93.5 % of others."""
    shares = (np.arange(64) + 0.5) / 64  # of Sobol's sequence, one in each 64th
    drawn = np.repeat(shares[:, None], 4, axis=1)
    made = Budget(shares, drawn, shares[:3], drawn[:3], Reading(*drawn[0]), Alignment(1, 1, 1), ())
    assert np.diff(made.intervals, axis=0)[0] == pytest.approx(0.95, abs=0.01)


def test_the_page_states_what_is_uncertain_as_the_description_does(found, text_of_page):
    assert st.Rig.from_toml(found.to_toml()) == st.Rig.from_toml(TEXT)
    assert "uncertainty = &#34;1 deg&#34;" in text_of_page


def test_the_axis_of_angles_is_logarithmic_where_the_prior_is(found):
    """The posteriors' figures had such axes, this one had not."""
    for even, scale in ((False, "linear"), (True, "log")):
        panels = plot_tolerance(replace(found.budget, logarithmic=even)).ravel()
        assert {ax.get_xscale() for ax in panels} == {scale}
    prior = 'phi = {low = "1 deg", high = "3 deg", scale = "log"}'
    rig = st.Rig.from_toml(TEXT.replace('phi = "2 +- 1 deg"', prior))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(module, "DRAWS", 2)
        patch.setattr(module, "read_all", lambda rigs, _: np.full((len(rigs), 4), 0.5))
        assert budget(rig, lambda _: None).logarithmic
        springs = "".join(
            f'[[slider.springs]]\nname = "{name}"\nk_x = "4.6 kN/m"\nk_y = "1.8 MN/m"\n'
            'angle = "2 deg"\n'
            for name in ("cell", "arm")
        )
        text = TEXT.replace('phi = "2 +- 1 deg"', prior).replace(
            "[friction]", f"{springs}[friction]"
        )
        text = text.replace('k_x = "2.3 kN/m"\nk_y = "0.9 MN/m"\n', "")
        turned = budget(st.Rig.from_toml(text), lambda _: None)
        assert turned.ends[0] < 0.0 < turned.ends[2]  # the springs lie at 2 deg themselves
        assert not turned.logarithmic


def test_what_few_tests_show_has_their_number_and_no_95_percent():
    """Creep of 1 test in 64 was "84.61 µm to 84.61 µm", said to hold 95 %."""
    drawn = np.repeat((np.arange(64) + 0.5)[:, None], 4, axis=1)
    drawn[1:, 1], drawn[38:, 2], drawn[:, 3] = nan, nan, nan
    made = Budget(drawn[:, 0], drawn, drawn[:3, 0], drawn[:3], Reading(*drawn[0]),
                  Alignment(nan, 0.1, 0.0), ("k_x",))  # fmt: skip
    assert made.counts == [64, 1, 38, 0]
    assert made.intervals[:, 2].tolist() == [0.5, 37.5]
    said = module.section(made)
    assert [row[-1] for row in said.table.rows] == [
        "1.442 to 62.56",
        "0.5 (1 of 64)",
        "500 mm to 37.5 m (38 of 64)",
        "none",
    ]
    text = " ".join(said.sentences)
    assert "the last column is of those that do, with their number in brackets" in text
    assert "Of fewer than 39 it has the smallest and the largest, which hold less than 95 %" in text
    drawn[:39, 2] = np.arange(39) + 0.5
    assert made.intervals[0, 2] > 0.5  # of 39 they are those of 95 %
    drawn[:, :3] = drawn[:, :1]
    text = " ".join(module.section(made).sentences)
    assert "brackets" in text
    assert "Of fewer" not in text  # nothing is shown of what no test has
    drawn[:] = drawn[:, :1]
    assert "Of fewer" not in " ".join(module.section(made).sentences)
    assert "brackets" not in " ".join(module.section(made).sentences)
