"""An audit with a measured record: verdict, grounds, page. Records of known rigs."""

from dataclasses import replace

import numpy as np
import pytest
from tests.uncertain import SIMULATIONS, TEXT, record_of

import stiction as st
from stiction.auditing import tolerance
from stiction.auditing.measured import (
    BOTH_HOLD,
    CHANGES,
    GROUNDS,
    WITHDRAWN,
    alternatives,
    changes,
    contradictions,
    explain_record,
    sections,
    verdict,
    with_description,
    withdraw,
)
from stiction.auditing.page import page
from stiction.errors import DescriptionError
from stiction.inference.cycles import slip_cycles
from stiction.inference.mechanism.odds import UNDECIDED
from stiction.inference.mechanism.rest import Rest
from stiction.inference.mechanism.rivals import MISALIGNED_STATIC, ROTATION, STATIC
from stiction.inference.predictive import SHARES, Curve, Predictive, loading_curve
from stiction.plotting import plot_predictive, plot_ranks


@pytest.fixture(scope="module")
def found(rig, record, libraries):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(tolerance, "DRAWS", 8)  # of what test_tolerance examines
        return st.audit(rig, record=record, simulations=SIMULATIONS, library=libraries)


def test_a_record_of_the_rig_is_explained_and_its_misalignment_found(found):
    phi = found.measured.fit["phi"]
    assert phi.low < np.radians(2.5) < phi.high
    assert found.measured.stated.mass == 0.08
    first = found.tables()[0]
    assert first.title == "What the record says"
    said, described = first.sentences
    assert said.startswith("The rig explains this record by itself: with a misalignment of 2.")
    assert said.endswith(f"; {alternatives(found.measured.odds)}.")
    assert "as it is described" in described


def test_an_audit_concludes_nothing_from_cycles_that_an_analysis_does_not_count(found):
    said = "In 9 s of the record an analysis counts 3 cycles, and the fit 9."
    fit = replace(found.measured.fit, disputed=said)
    disputed = replace(found.measured, fit=fit, odds=replace(found.measured.odds, disputed=said))
    first, *others = sections(disputed)
    assert first.sentences[0] == f"No verdict. {said}"
    assert said not in " ".join(str(part) for part in others)  # once is enough
    assert disputed.odds.decision == UNDECIDED
    (its,) = (part for part in others if part.title == "Fit")
    assert its.table is None


def test_the_report_says_what_it_rests_on_and_what_would_change_it(found):
    parts = {part.title: " ".join(part.sentences) for part in found.tables()}
    assert "simulated records" in parts["What that rests on"]
    assert "force across the drive and displacement of the mass" in parts["What would change it"]
    assert "turned by a known angle" in parts["What would change it"]
    assert {"Fit", "Mechanism", "The rig as it is described", "How well to align"} <= set(parts)


def test_the_page_has_the_figures_of_the_record(found):
    text = page(found, "pin")
    captions = (
        "Measured, and simulated", "Odds of mechanisms", "Prior (grey)", "All pairs",
        "Calibration: ranks",
    )  # fmt: skip
    assert [each for each in captions if each not in text] == []


def test_the_band_holds_the_measured_curve(found):
    made = found.measured.predictive
    (low, high), (lowest, highest) = made.bands
    assert ((made.measured.force > low) & (made.measured.force < high)).mean() > 0.9
    assert lowest[0] == highest[0] == pytest.approx(0.0)
    record, loading, bend = plot_predictive(found.measured)
    assert len(record.lines) == len(loading.lines) == len(bend.lines) == 2
    assert len(plot_ranks(found.measured.fit)) == len(found.measured.fit.estimates)


def test_a_record_with_static_friction_and_no_rotation_is_not_explained_by_the_rig(rig, tmp_path):
    """Coulomb friction with a static coefficient, square on: no creep, steeper slips."""
    slider = rig.slider.replace(phi="0 deg", friction=st.Coulomb(mu_0=0.45, mu_static=0.6))
    record = record_of(slider, 8, 12.0, channels=("force",))
    seen = explain_record(record, rig, simulations=SIMULATIONS, library=tmp_path)
    assert not seen.like
    assert seen.odds.decision == STATIC, seen.odds
    assert not seen.odds.straight_excluded
    assert verdict(seen).startswith("Friction, not misalignment: this record is like simulations")
    undecided = replace(seen.odds, probabilities=np.full(len(seen.odds.names), 0.25))
    said = verdict(replace(seen, odds=undecided))
    assert said.startswith("No verdict: this record is not like those of the rig")
    assert "the uncertain values are within their priors" in said
    (change,) = (part for part in sections(seen) if part.title == CHANGES)
    assert not any(word in str(change) for word in ("hum", "must turn with it", "Not identifiable"))


def test_a_posterior_in_the_tail_of_its_prior_is_named(found):
    seen = found.measured
    fit = seen.fit
    tail = replace(seen, fit=replace(fit, scores=fit.scores - 4.0))
    assert not tail.like
    assert tail.fit.beyond == [each.name for each in fit.estimates]
    assert "At an end of its prior" in str(tail.fit.tables()[0])
    wide = tuple(each._replace(narrower=1.47) for each in fit.estimates)  # as normal scores
    said = str(replace(tail.fit, estimates=wide).tables()[0])
    assert "At an end of its prior" in said
    assert "ot identifiable" not in said  # the record points beyond the prior: it says something


def test_the_verdict_says_what_other_mechanisms_leave_open(found):
    """Claimed, undecided, and not compared: three different sentences about one fit."""
    seen = found.measured
    sure = np.eye(len(seen.odds.names))[seen.odds.names.index(ROTATION)]
    claimed = replace(seen, odds=replace(seen.odds, probabilities=sure, steady=1.0))
    assert "is the apparatus, whose friction vector rotates" in verdict(claimed)
    limits = claimed.odds.sentences()[1:]
    assert len(limits) > 2
    assert {str(sections(claimed)).count(each) for each in limits} == {1}
    held = replace(claimed, odds=replace(claimed.odds, rest=Rest(0.9, 0.96, 1.0)))
    assert held.odds.decision == MISALIGNED_STATIC
    assert "holds the mass between slips" in verdict(held)
    assert "rotates" not in verdict(held)
    assert "must turn with it" in str(sections(held))
    open_still = replace(seen, odds=replace(seen.odds, probabilities=np.full(len(sure), 0.2)))
    assert "another mechanism is not excluded" in verdict(open_still)
    alone = replace(seen, odds=None, incomparable="nothing rotates")
    assert "none is excluded" in verdict(alone)
    (change,) = (part for part in sections(alone) if part.title == CHANGES)
    assert "Other mechanisms were not compared: nothing rotates." in str(change)


def test_a_record_without_a_verdict_claims_nothing(found):
    """Below "No verdict" stood "Claimed: rotation of the friction vector (probability 0.90)"."""
    seen = found.measured
    sure = np.eye(len(seen.odds.names))[seen.odds.names.index(ROTATION)]
    odds = replace(seen.odds, probabilities=sure, by_halves=np.array([sure, sure]), steady=1.0)
    claimed = replace(seen, odds=odds)
    assert withdraw(claimed) is claimed
    far = withdraw(replace(claimed, fit=replace(seen.fit, farther=0.01)))
    said = "\n".join(map(str, sections(far)))
    assert said.count("No verdict") == 1
    assert "Claimed" not in said
    assert WITHDRAWN in said
    assert far.odds.decision == UNDECIDED
    held = replace(claimed, odds=replace(odds, rest=Rest(0.9, 0.96, 1.0)))
    assert held.odds.decision == MISALIGNED_STATIC
    assert withdraw(replace(held, fit=far.fit)).odds.decision == UNDECIDED


def test_a_fit_that_ends_at_its_prior_says_so_where_records_are_unlike(found):
    """A known stiffness that is 9 % wrong: phi at 4.84 deg and mu_0 at 0.7495, of up to 5 and 0.75.

    At 2.1 normal scores a value may be as true as any, so that nothing is said of other records.
    """
    seen = found.measured
    scores = seen.fit.scores - np.median(seen.fit.scores, axis=0)
    scores[:, 0] += 2.1
    fit = replace(seen.fit, scores=scores)
    assert not fit.beyond
    assert "comes to an end" not in str(fit.tables()[0])
    said = f"The fit comes to an end of the prior of {fit.estimates[0].name}: "
    far = replace(fit, farther=0.01)
    assert said in str(far.tables()[0].sentences)
    (change,) = (x for x in sections(replace(seen, fit=far)) if x.title == CHANGES)
    assert said in str(change.sentences)


def test_an_explanation_beside_an_unusual_loading_curve_says_how_both_hold(found):
    seen = found.measured
    odds = replace(seen.odds, probabilities=np.eye(len(seen.odds.names))[0])
    assert seen.like
    assert odds.names[0] == ROTATION
    for larger, said in ((0.01, True), (0.5, False)):
        its = odds.likeness[0]._replace(larger=larger)
        unusual = replace(seen, odds=replace(odds, likeness=(its, *odds.likeness[1:])))
        parts = sections(unusual)
        (rests,) = (part for part in parts if part.title == GROUNDS)
        assert (BOTH_HOLD in rests.sentences) == said
        every = " ".join(x for part in parts for x in part.sentences)
        assert every.count("The loading curve is not like") == said  # once, in Mechanism
        assert every.count("Claimed: ") == (not said)


def test_a_record_without_cycles_gets_no_verdict_and_says_why(rig):
    flat = st.Record(time=np.arange(100.0), force=np.ones(100))
    seen = explain_record(flat, rig)
    assert seen.fit is None
    (part,) = sections(seen)
    assert "No verdict: the record has 0 whole cycles of stick and slip" in part.sentences[0]


def test_a_rig_without_priors_cannot_be_held_against_a_record():
    record = st.Record(time=np.arange(100.0), force=np.ones(100))
    with pytest.raises(DescriptionError, match="nothing is uncertain"):
        st.audit(st.presets.nakano_popov_2020(), record=record)


def test_what_looks_unlike_the_library_is_no_ground_for_a_verdict(found):
    """The same fit of a record that stands farther apart than 99 % of the library."""
    seen = found.measured
    far = replace(seen, fit=replace(seen.fit, farther=0.01))
    assert seen.like
    assert not far.like
    assert not replace(seen, predictive=None).like


def test_where_cycles_differ_neither_stiffness_nor_mass_is_said_to_be_wrong(found):
    """Holds made a stiffness of 0.55 times, and a mass of 130 times, that were as stated."""
    seen = found.measured
    slow = seen.predictive._replace(slip=10.0 * seen.predictive.slip)
    far = replace(seen, fit=replace(seen.fit, farther=0.01), predictive=slow)
    assert "The slips last " in " ".join(changes(far, far.fit))
    paused = replace(far.fit, explanation="Cycles differ within the record.")
    assert "The slips last" not in " ".join(changes(far, paused))


def test_a_force_that_rises_or_falls_as_no_simulation_does_names_stiffness_and_mass():
    """A stiffness or mass stated as certain and wrong by less than 2 was "No verdict" only."""
    scatter = np.linspace(0.99, 1.01, 60)
    made = Curve(SHARES * np.ones((60, 1)), scatter[:, None] * SHARES)

    def said(rate, slip):
        own = Curve(SHARES, rate * SHARES)
        return [*contradictions(Predictive(own, made, 0.02, None, slip, 0.02 * scatter))]

    assert said(1.005, 0.0199) == []
    assert said(1.02, 0.0196) == []  # beyond all, but not worth a word
    (stiffness,) = said(0.75, 0.02)
    assert stiffness.startswith("No simulation with the fitted values rises as slowly as the")
    assert "may be 0.75 times as stated, or farther off" in stiffness
    assert "rises as fast as" in said(1.3, 0.02)[0]
    (mass,) = said(1.0, 0.016)
    assert mass.startswith("The slips last 0.8 times as long as the simulated ones: mass over stif")
    assert "may be 0.64 times as stated" in mass
    assert "filter" not in mass
    assert "filter" in said(1.0, 0.024)[0]
    assert "That stiffness changes it too." in said(0.75, 0.024)[1]
    assert [*contradictions(None)] == []
    wide = Curve(made.time, (1.0 + 20.0 * (scatter[:, None] - 1.0)) * SHARES)  # 0.8 to 1.2
    own = Curve(SHARES, 1.15 * SHARES)
    assert [*contradictions(Predictive(own, wide, 0.02, None, 0.02, 0.02 * scatter))] == []


def test_a_wrong_stiffness_stands_below_no_verdict(found):
    seen = found.measured
    own = seen.predictive.measured
    slow = seen.predictive._replace(measured=own._replace(force=0.75 * own.force), larger=0.01)
    (change,) = (x for x in sections(replace(seen, predictive=slow)) if x.title == CHANGES)
    assert "rises as slowly as the record" in str(change)
    assert "rises as" not in str(sections(seen))


def test_the_loading_curve_of_a_sawtooth_is_straight():
    saw = np.tile(np.r_[0.0:1.0:11j, 0.6, 0.3], 5)
    curve = loading_curve(0.1, saw, slip_cycles(saw))
    assert curve.force == pytest.approx(SHARES)
    assert curve.time == pytest.approx(SHARES)
    assert curve.bend == pytest.approx(0.0 * SHARES, abs=1e-12)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({}, ""),
        ({"k_x": "2.3 N/m"}, "mN/s: stiffness or drive velocity is stated 1000 times too small"),
        ({"k_x": "1.3 kN/m"}, "times stiffness times drive velocity as stated"),
        ({"drive.velocity": "0.2 mm/s"}, "times stiffness times drive velocity as stated"),
        ({"mass": "80 kg"}, "stiffness over mass is"),
        ({"normal_load": "4 mN"}, "A friction coefficient of"),
        ({"k_x": "1.3 +- 0.5 kN/m"}, ""),
    ],
)
def test_a_record_that_contradicts_its_description_is_told_even_without_a_fit(rig, changes, said):
    """A record of few cycles is not fitted, but its force rises, slips and has a size."""
    run = st.simulate(rig.slider, 4.5, sample_rate=2e3)
    plain = st.analysis.record_of(run)
    record = st.Record(time=plain.time, force=plain.force)
    text = rig.slider.replace(phi="2 deg").to_toml().replace('"2 deg"', '"2 +- 1 deg"')
    _, *doubts = sections(explain_record(record, st.Rig.from_toml(text, changes)))
    assert said in " ".join(sentence for part in doubts for sentence in part.sentences)
    assert bool(said) == bool(doubts)


SURE = {"normal_load", "stiffness", "drive_velocity", "mass"}
SPRINGS = """
[[slider.springs]]
name = "leaf"
k_x = {leaf}
k_y = "0.9 MN/m"
[[slider.springs]]
name = "load cell"
k_x = "46 kN/m"
k_y = {across}
"""


def facts(changes, springs="", **of_record):
    """Return what a record that states nothing takes from a description, by field."""
    text = TEXT.replace("+- 0.1 ", "").replace(
        '{value = "0.9 MN/m", uncertainty = "10 %"}', '"0.9 MN/m"'
    )
    if springs:
        kept = [line for line in text.splitlines() if not line.startswith("k_")]
        text = "\n".join(kept).replace("[friction]", f"{springs}[friction]")
    record = st.Record(time=np.arange(9.0), force=np.arange(9.0), **of_record)
    found = with_description(record, st.Rig.from_toml(text, changes))
    return {name: its for name in SURE if (its := getattr(found, name)) is not None}


@pytest.mark.parametrize(
    ("changes", "unsure"),
    [
        ({}, set()),
        ({"k_x": "2.3 +- 0.1 kN/m"}, {"stiffness"}),
        ({"k_x": "2.3 +- 0.01 kN/m"}, set()),  # as sure as it needs to be
        ({"k_y": "0.9 +- 0.4 MN/m"}, set()),  # the cell reads the spring x
        ({"mass": "80 +- 9 g"}, {"mass"}),
        ({"normal_load": "4 +- 1 N"}, {"normal_load"}),
        ({"drive.velocity": "0.5 +- 0.1 mm/s"}, {"drive_velocity"}),
        ({"phi": "5 +- 20 deg"}, {"drive_velocity"}),  # along the spring
        ({"cell_angle": "0 deg"}, {"stiffness"}),
        ({"cell_angle": "0 deg", "phi": "0.2 deg"}, set()),  # the spring across adds 0.5 %
        ({"cell_angle": "0 deg", "phi": "0.2 +- 2 deg"}, {"stiffness"}),
        ({"cell_angle": "0 +- 5 deg", "phi": "1 deg"}, {"stiffness"}),
        ({"cell_angle": "90 deg", "phi": "1 deg"}, {"stiffness", "drive_velocity"}),
    ],
)  # fmt: skip
def test_a_record_states_what_its_description_is_sure_of(changes, unsure):
    """Along a cell at an angle k_y counts; stated, it was 12 times what a creeping mass shows."""
    changes = {"phi": "1 deg", "friction.mu_0": "0.6 +- 0.1"} | changes
    assert facts(changes).keys() == SURE - unsure


@pytest.mark.parametrize(
    ("leaf", "across", "unsure"),
    [
        ('"2.3 kN/m"', '"1 MN/m"', set()),
        ('"2.3 +- 0.5 kN/m"', '"1 MN/m"', {"stiffness"}),
        ('"2.3 kN/m"', '"1 +- 0.5 MN/m"', set()),
    ],
)
def test_a_stiffness_is_as_unsure_as_the_springs_in_series_that_make_it(leaf, across, unsure):
    found = facts({"phi": "1 +- 0.1 deg"}, SPRINGS.format(leaf=leaf, across=across))
    assert found.keys() == SURE - unsure
    assert found.get("stiffness", 2190.4762) == pytest.approx(2190.4762)  # 1/(1/2300 + 1/46000)


def test_what_a_record_states_stays_and_it_is_that_of_the_rig_as_it_was_turned():
    changes = {"phi": "2 +- 0.1 deg"}
    found = facts(changes, stiffness=5.0, turned="58 deg")
    assert found["stiffness"] == 5.0
    assert found["mass"] == 0.08
    assert "drive_velocity" in facts(changes)
    assert found["drive_velocity"] == pytest.approx(0.25e-3)
