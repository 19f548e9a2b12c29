"""Records that do not suit a fit are refused before anything is simulated; others are explained."""

import re
from dataclasses import replace
from math import ceil
from types import SimpleNamespace

import numpy as np
import pytest
from benchmarks.explore.records import irregular_in_noise
from scipy import signal

import stiction as st
from stiction.errors import ResultError
from stiction.inference import fit as fits
from stiction.inference.mechanism.likeness import CURVES, Likeness
from stiction.inference.mechanism.odds import Odds
from stiction.inference.observation import observe
from stiction.inference.priors import Normal, Uniform
from stiction.inference.simulated.library import BLOCK, FIRST_SIMULATIONS, Ensemble
from stiction.inference.simulated.plan import plan
from stiction.inference.suitability import dispute, explain_unlike, refuse_few_cycles
from stiction.progress.report import silent

RIG = st.Rig.from_toml(
    """
[slider]
mass = "80 g"
k_x = "2.3 +- 0.1 kN/m"
k_y = "0.9 MN/m"
phi = "2 deg"
normal_load = "4 N"

[friction]
law = "exponential-weakening"
mu_0 = 0.6
mu_inf = 0.35
v_f = "10 mm/s"

[drive]
velocity = "0.5 mm/s"
"""
)
STEP = 0.01
CYCLE = np.r_[np.linspace(1.4, 2.4, 97), 2.1, 1.7, 1.5]  # N: a second of loading, and a slip


def record(*forces):
    force = np.concatenate(forces)
    noise = 1e-3 * np.random.default_rng(1).standard_normal(len(force))
    return st.Record(
        time=STEP * np.arange(len(force)), force=force + noise, drive_velocity=0.5e-3,
        normal_load=4.0,
    )  # fmt: skip


@pytest.fixture
def no_simulation(monkeypatch):
    def simulate(*_, **__):
        raise AssertionError("something is simulated")

    monkeypatch.setattr(Ensemble, "simulate", simulate)


@pytest.mark.parametrize("name", ["fit", "mechanism"])
def test_a_force_that_reverses_is_refused_before_simulating(no_simulation, name):
    """It was "not like those of the rig", after a minute, and nobody said that it reverses."""
    stroke = np.tile(CYCLE, 4)
    loops = record(*(sign * stroke for sign in (1.0, -1.0, 1.0, -1.0, 1.0)))
    with pytest.raises(ResultError) as error:
        getattr(st, name)(loops, replace_phi(RIG))
    assert "the force goes back and forth between both signs" in str(error.value)
    assert "stroke=1 of st.read_record reads the first" in str(error.value)


def replace_phi(rig):
    """A rig whose misalignment is uncertain, so that mechanisms can be compared."""
    return st.Rig(rig.slider, rig.priors | {"phi": Normal(0.03, 0.01)})


def test_a_run_of_a_drive_that_reverses_is_refused(no_simulation):
    piece = st.protocols.Constant
    program = [piece(speed, "1.6 s") for speed in ("5 mm/s", "-5 mm/s") * 3]
    slider = RIG.slider.replace(drive=st.protocols.DriveProgram(program=program))
    with pytest.raises(ResultError, match="goes back and forth between both signs"):
        st.fit(st.simulate(slider, "9.6 s", sample_rate=200), RIG)


def test_a_rig_whose_drive_or_load_changes_is_told_what_to_write():
    """It said "must be steady, and the load constant", at the drive, whichever of them was not."""
    piece = st.protocols.Constant
    program = st.protocols.DriveProgram(program=[piece("5 mm/s", "1 s"), piece("1 mm/s", "1 s")])
    load = st.protocols.LoadProgram(program=[piece("2 N", "1 s"), piece("1 N", "1 s")])
    for change, words in (
        ({"drive": program}, "drive: changes, .* write velocity = .*begin, end of st.read_record"),
        ({"load": load}, "load: changes, .* take out this table, .*begin, end of st.read_record"),
    ):
        with pytest.raises(st.DescriptionError, match=words):
            st.fit("no record", RIG._replace(slider=RIG.slider.replace(**change)))


def test_what_differs_within_a_record_explains_that_it_is_unlike():
    pause = np.full(1000, 1.4)
    assert observe(record(*[CYCLE] * 20), RIG.slider).changes == ()
    (long,) = observe(record(*[CYCLE] * 10, pause, *[CYCLE] * 10), RIG.slider).changes
    assert long.startswith("The cycle from ")
    assert "if the drive paused" in long
    (faster,) = observe(record(*[CYCLE] * 10, *[CYCLE[::2]] * 10), RIG.slider).changes
    assert "the cycles take" in faster
    said = explain_unlike([(), (long,)])
    assert "Record 2: The cycle from" in said
    assert "(begin, end of st.read_record)" in said


@pytest.mark.parametrize(("spread", "most"), [(0.0, 0.05), (0.01, 0.05), (0.08, 0.3), (0.3, 0.3)])
@pytest.mark.parametrize("trend", [0.0, 0.02])
def test_friction_differs_in_simulations_as_in_the_record(spread, most, trend):
    heights = 1.0 + spread * np.tile([-1.0, 1.0, 0.3, -0.3], 6) + trend * np.arange(24)
    seen = observe(record(*(CYCLE * height for height in heights)), RIG.slider)
    assert seen.conditions.jitter.high == most
    jitter = plan(RIG.slider, {}, [seen.conditions]).priors["jitter"]
    assert jitter == seen.conditions.jitter


def test_friction_differs_in_simulations_as_in_each_of_several_records():
    alike, unlike = (
        observe(record(*(CYCLE * height for height in heights)), RIG.slider).conditions
        for heights in (np.ones(20), 1.0 + 0.1 * np.tile([-1.0, 1.0], 10))
    )
    jitter = plan(RIG.slider, {}, [alike, unlike]).priors["jitter"]
    assert jitter == Uniform(alike.jitter.low, unlike.jitter.high, "log")


def test_what_comes_after_the_cycles_that_are_used_explains_nothing():
    late = record(*[CYCLE] * 45, np.full(1000, 1.4), *[CYCLE] * 5)
    assert observe(late, RIG.slider).changes == ()


def test_where_an_analysis_counts_other_cycles_that_is_said_first():
    """Of a record of paper on paper, a verdict stood on 20 cycles where an analysis saw 71."""
    assert observe(record(*[CYCLE] * 20), RIG.slider).disputed == ""
    two_sizes = [1.4 + height * (CYCLE - 1.4) for height in [1.0, 0.28] * 10]
    seen = observe(record(*two_sizes), RIG.slider, "record 2")
    counts = re.match(
        r"In 1\d s of record 2 an analysis counts (\d+) cycles, and the fit (\d+): ", seen.disputed
    )
    assert sorted(map(int, counts.groups())) == [8, 17]
    assert "nothing is concluded" in seen.disputed


def test_the_odds_say_why_a_record_is_unlike():
    likeness = tuple(Likeness(0.01, np.zeros((CURVES, 3)), 0.5) for _ in range(2))
    odds = Odds(
        names=("a", "b"), probabilities=np.array([0.95, 0.05]),
        by_halves=np.array([[0.95, 0.05]] * 2), confusion=np.zeros((2, 3)), likeness=likeness,
        bend=np.zeros(3), steady=0.5, counts=(9, 9), absent=(), channels=("force",),
        explanation="A pause.",
    )  # fmt: skip
    assert odds.objections()[-1] == "A pause."
    like = tuple(each._replace(farther=0.5) for each in likeness)
    assert replace(odds, likeness=like).objections() == []


@pytest.mark.parametrize("seed", range(8))
def test_behind_an_amplifier_without_constant_force_nothing_is_fitted(no_simulation, seed):
    """It bends loadings as creep does: of 21 intervals of phi, none in doubt, 8 held the truth."""
    random = np.random.default_rng(seed)
    force = record(*(size * CYCLE for size in random.uniform(0.95, 1.05, 40))).force
    time = float(np.exp(random.uniform(*np.log([30.0, 3000.0]))))  # of the amplifier, in samples
    shown = signal.lfilter([1.0, -1.0], [1.0, 1.0 / time - 1.0], force - force.mean())
    with pytest.raises(ResultError, match="Behind an amplifier that lets no constant force"):
        st.fit(record(shown), RIG)
    for zero in random.uniform(0.3, 1.5, 4):  # N, which may be off
        assert observe(record(force - force.mean() + zero), RIG.slider).conditions.cycles == 34


def test_too_few_cycles_ask_for_more_of_them():
    """The remedy was to drive more slowly: fewer cycles in the same time."""
    with pytest.raises(ResultError, match=r"3 whole cycles .* record for longer, or drive faster$"):
        refuse_few_cycles("the record", 3)


def test_cycles_that_noise_hides_ask_for_less_noise():
    """The remedy was to record for longer."""
    hidden, _, _ = irregular_in_noise(np.random.default_rng([5, 5]))
    with pytest.raises(ResultError, match=r"noise hides the cycles .* measure with less noise"):
        observe(hidden, RIG.slider)


@pytest.mark.parametrize(("usable", "refused"), [(0, True), (20, True), (60, False), (96, False)])
def test_too_few_simulations_are_refused_after_the_first(monkeypatch, usable, refused):
    """Of 300 simulations 100 had cycles: that was said when all of them were done, and drawn.

    Of 400, three quarters are needed: 20 of 96 are too few for that but for one draw in a thousand,
    and 60 may just be enough.
    """
    asked = []

    def simulate(_, number, __):
        asked.append(number)
        return np.zeros(1), np.full(1, 0.0 if number < usable else np.nan)

    monkeypatch.setattr("stiction.inference.simulated.library.simulate", simulate)
    none = Ensemble(None, None, 0)
    if refused:
        with pytest.raises(ResultError, match=f"{usable} of 96 simulated records have cycles"):
            fits.refuse_early(none, 400)
    else:
        fits.refuse_early(none, 400)
    assert sorted(asked) == [*range(FIRST_SIMULATIONS)]
    fits.refuse_early(none, FIRST_SIMULATIONS)
    assert len(asked) == FIRST_SIMULATIONS


@pytest.mark.parametrize(("share", "enough"), [(0.997, True), (0.7, True), (0.3, False)])
def test_a_few_simulations_that_lack_are_simulated(monkeypatch, share, enough):
    """299 of the fewest that are accepted had cycles: the fit was refused when they were done."""

    asked = []

    def simulate(_, number, __):
        asked.append(number)
        usable = int(share * (number + 1)) > int(share * number)
        return np.zeros(1), np.full(1, 0.0 if usable else np.nan)

    monkeypatch.setattr("stiction.inference.simulated.library.simulate", simulate)
    begun = Ensemble(None, None, 0)
    if enough:
        begun = fits.refuse_early(begun, fits.FEWEST_SIMULATIONS)
    library = fits.build_enough(begun, fits.FEWEST_SIMULATIONS, silent)
    assert (len(library.scores) >= fits.FEWEST_SIMULATIONS) == enough
    assert library.wanted < 1.7 * fits.FEWEST_SIMULATIONS
    assert sorted(asked) == [*range(BLOCK * ceil(library.wanted / BLOCK))]  # each of them once


@pytest.mark.parametrize(("theirs", "ours"), [(7, 5), (5, 7), (8, 5), (20, 15)])
def test_counts_that_an_end_and_a_third_explain_are_not_disputed(theirs, ours):
    assert dispute(*counts_in_common(theirs, ours), "the record") == ""


@pytest.mark.parametrize(("theirs", "ours"), [(9, 5), (5, 9), (22, 15)])
def test_counts_that_differ_by_more_are_told_with_their_time(theirs, ours):
    said = dispute(*counts_in_common(theirs, ours), "the record")
    assert f"In 10 s of the record an analysis counts {theirs} cycles, and the fit {ours}" in said


def counts_in_common(theirs, ours):
    """Cycles of an analysis, and the ends of a fit's, in the same 10 s."""
    ends = np.linspace(0.0, 10.0, theirs + 1)
    lasting = {"start": ends[:-1], "trough_time": ends[1:]}
    return SimpleNamespace(lasting=lasting), np.linspace(0.0, 10.0, ours + 1)
