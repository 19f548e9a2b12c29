"""Each kind of motion is distinguished from the others, with and without data of the rig."""

from __future__ import annotations

import re
from collections.abc import Callable
from math import pi
from typing import Any, get_args

import numpy as np
import pytest
from benchmarks.explore.records import (
    Labelled,
    between,
    brief_vibration,
    filter_noise,
    hum_over_loading,
    in_noise,
    irregular_few_samples,
    irregular_in_noise,
    judge,
    long,
    mains,
    random_times,
    sawtooth,
    settling,
    short,
    wandering,
)
from scipy.signal import lfilter
from tests.drawn import inside
from tests.measured import bare, read_measured

import stiction as st
from stiction.analysis.motion.course import dies_out, final_fall
from stiction.analysis.motion.regime.band import highest_hump
from stiction.analysis.motion.regime.evidence import WORDS, Evidence, Regime
from stiction.analysis.motion.rest import rest_share
from stiction.analysis.motion.vibration import is_irregular
from stiction.analysis.protocols.hysteresis import Hysteresis
from stiction.plotting.analysis.overview import figures
from stiction.study.variables.observed_run import observe_run

TRANSITIONAL = "transitional oscillation"


@pytest.mark.parametrize(
    ("name", "kind", "least"),
    [
        ("k168_v42", "stick-slip", 0.9),
        ("k168_v1100", TRANSITIONAL, 0.4),
        ("k1002_v4300", "harmonic vibration", 0.9),
        ("k2254_v42", "steady sliding", 0.8),
    ],
)
def test_measured_records_are_told_apart(name: str, kind: str, least: float) -> None:
    record = read_measured(name)
    for known in (record, bare(record)):
        regime = st.analysis.classify(known)
        assert regime.kind == kind
        assert regime.confidence > least
    for part in np.array_split(np.arange(len(record)), 6):
        assert (
            st.analysis.classify(st.Record(time=record.time[part], force=record.force[part])).kind
            == kind
        )


def test_between_says_what_else_it_could_be() -> None:
    regime = st.analysis.classify(read_measured("k168_v1100"))
    assert regime.runner_up == "stick-slip"
    assert regime.confidence < 0.7
    assert "the force rises for 7" in str(regime)
    assert 1.2 < regime.evidence["natural_period"] < 1.7  # 2 pi sqrt(m/k) = 85 ms of 125 ms


@pytest.mark.parametrize(
    ("phi", "kind"),
    [  # critical: 8.66 deg
        ("1 deg", "stick-slip"),
        ("8 deg", "stick-slip"),
        ("8.8 deg", "settling"),
        ("10 deg", "settling"),
    ],
)
def test_the_critical_misalignment_parts_stick_slip_from_damped(
    slider: st.Slider, phi: str, kind: str
) -> None:
    run = st.simulate(slider.replace(phi=phi), 10.0, sample_rate=10e3)
    record = st.analysis.record_of(run)
    assert st.analysis.classify(record).kind == kind
    assert st.analysis.classify(bare(record)).kind == kind
    assert (st.analysis.find_cycles(record).sizes["cycle"] > 0) == (kind == "stick-slip")


def test_constant_friction_is_a_transient(slider: st.Slider) -> None:
    law = st.ExponentialWeakening(mu_0=0.2, mu_inf=0.2, v_f="10 mm/s")
    run = st.simulate(slider.replace(friction=law), 10.0, sample_rate=10e3)
    regime = st.analysis.classify(st.analysis.record_of(run))
    assert regime.kind == "settling"
    assert "each smaller than the last" in str(regime)


def test_a_run_before_its_first_slip_is_stuck(paper_run: st.Trajectory) -> None:
    record = st.analysis.record_of(paper_run)
    early = record.time < 1.5
    part = st.Record(time=record.time[early], force=record.force[early])
    assert st.analysis.classify(part).kind == "stuck"
    known = part.model_copy(update={"stiffness": 1e3, "drive_velocity": 1e-3})
    assert st.analysis.classify(known).kind == "stuck"
    # the same slow rise on a spring that would load a hundred times faster: it slides
    stiff = part.model_copy(update={"stiffness": 1e5, "drive_velocity": 1e-3})
    assert st.analysis.classify(stiff).kind == "steady sliding"


@pytest.mark.parametrize(
    ("per_cycle", "noise"),  # twelve samples a cycle do not show it under more noise
    [(12, 0.0), (12, 0.1), (100, 0.0), (100, 0.1), (100, 0.5), (1000, 0.0), (1000, 0.5)],
)
def test_a_vibration_is_no_stick_slip(noise: float, per_cycle: int) -> None:
    time = np.arange(20 * per_cycle) / (3.0 * per_cycle)
    wave = np.sin(2 * pi * 3.0 * time) + noise * np.random.default_rng(1).normal(size=len(time))
    regime = st.analysis.classify(st.Record(time=time, force=wave))
    assert regime.kind == "harmonic vibration"
    assert regime.evidence["period_spread"] < 0.25


@pytest.mark.parametrize("samples", [6.0, 20.0, 60.0])  # a period
@pytest.mark.parametrize("bandwidth", [0.03, 0.08, 0.2])
def test_noise_through_a_narrow_filter_is_an_irregular_vibration(
    samples: float, bandwidth: float
) -> None:
    """Swings of every size beside slow motion, on a mass that could swing at that frequency."""
    random, rate = np.random.default_rng(8), 48.0 * samples
    size = int(5.0 * rate)
    pole = np.exp((2j - bandwidth) * pi / samples)
    rung = lfilter([1.0], [1.0, -2.0 * pole.real, abs(pole) ** 2], random.normal(size=2 * size))
    time = np.arange(size) / rate
    noise = random.normal(size=size) / 20.0
    force = 20.0 + rung[size:] / rung.std() + 4.0 * np.sin(0.5 * time) + noise
    record = st.Record(time=time, force=force, mass=1.0, stiffness=(2.0 * pi * 48.0) ** 2)
    for known in (record, bare(record)):
        assert st.analysis.classify(known).kind == "irregular vibration"


@pytest.mark.parametrize("seed", range(3))
def test_noise_of_any_colour_is_no_vibration(seed: int) -> None:
    random = np.random.default_rng(seed)
    white, time = random.normal(size=6000), np.arange(4000) * 1e-3
    smooth = lfilter([1.0], [1.0, -1.8, 0.81], white)[2000:]  # falls off beyond 17 Hz
    for noise in (white[2000:], smooth, np.cumsum(white[2000:]), np.diff(white)[1999:]):
        assert highest_hump(time, noise).height < 1.0
    assert highest_hump(time, white[2000:] + 3.0 * np.sin(2 * pi * 30.0 * time)).height > 1.0


@pytest.mark.parametrize(
    ("make", "number"),
    [  # of seed 20270101: beside a random walk, and on a force that comes to rest
        (wandering, 27),
        (wandering, 140),
        (wandering, 158),
        (wandering, 187),
        (long, 95),
    ],
)
def test_small_vibration_beside_a_force_that_wanders_is_seen(
    make: Callable[[np.random.Generator], Labelled], number: int
) -> None:
    assert judge(make, 20270101, number).right


def test_vibration_on_a_force_that_rises_is_no_stick() -> None:
    random = np.random.default_rng(19)
    vibration = filter_noise(random, 200.0, 12.0)
    time = np.arange(len(vibration)) / 600.0
    noise = 0.1 * random.normal(size=len(time))
    rising = st.Record(time=time, force=20.0 * time / time[-1] + vibration + noise)
    assert st.analysis.classify(rising).kind == "irregular vibration"
    assert (
        st.analysis.classify(rising.model_copy(update={"force": rising.force - vibration})).kind
        == "stuck"
    )


def test_vibrations_of_few_periods_are_told_with_the_confidence_that_they_deserve() -> None:
    """Of thirty periods some look harmonic: then nothing is sure."""
    found = [judge(short, 20270101, number) for number in (*range(40), 57, 98, 187, 192)]
    wrong = [each for each in found if not each.right]
    assert 4 <= len(wrong) <= 8  # the last four, and one of ten others at most
    assert all(each.confidence < 0.7 for each in wrong)
    sure = [each for each in found if each.confidence >= 0.7]
    assert all(each.right for each in sure)
    assert len(sure) >= 30


@pytest.mark.parametrize("number", [2, 29, 54, 66, 101, 116])
def test_a_vibration_that_decays_settles_however_few_its_swings(number: int) -> None:
    found = judge(settling, 1, number)
    assert found.right, found


def test_a_vibration_that_decays_into_noise_is_said_to_fade() -> None:
    regime = st.analysis.classify(settling(np.random.default_rng([1, 2]))[0])
    assert "it vibrates at about 15.3" in str(regime)
    assert "less and less; at the end" in str(regime)


@pytest.mark.parametrize("number", [90, 97])
def test_too_few_periods_for_a_vibration_are_no_steady_sliding(number: int) -> None:
    record, _, _ = brief_vibration(np.random.default_rng([2, number]))
    regime = st.analysis.classify(record)
    assert regime.kind == "undetermined"
    assert "too short" in str(regime)


def test_a_vibration_whose_size_changes_once_is_harmonic() -> None:
    time = np.arange(8000) * 1e-3
    for size in (1.0 + 2.0 * time / 8.0, 1.0 + 1.5 * np.exp(-3.0 * time)):
        regime = st.analysis.classify(
            st.Record(time=time, force=size * np.sin(2 * pi * 12.0 * time))
        )
        assert regime.kind == "harmonic vibration"
        assert regime.confidence > 0.9


def test_records_of_no_motion_in_particular() -> None:
    time = np.arange(4000) * 1e-3
    random = np.random.default_rng(7)
    white = random.normal(size=4000)
    spike = np.where(time == time[777], 5.0, 1.0)
    kinds = {
        kind: [st.analysis.classify(st.Record(time=time, force=force)).kind for force in forces]
        for kind, forces in {
            "steady sliding": [
                white,
                2.0 + 0.01 * white,
                spike,
                spike + 0.01 * white,
            ],
            "stuck": [time, time + 0.05 * white, time + spike],
            "undetermined": [np.ones(4000), np.zeros(4000)],  # a dead channel
            "settling": [1.0 - np.exp(-5.0 * time), np.exp(-2 * time) * np.sin(40 * time)],
        }.items()
    }
    for kind, found in kinds.items():
        assert set(found) == {kind}


@pytest.mark.parametrize("size", [0, 1, 3, 20])
def test_too_few_samples_determine_nothing(size: int) -> None:
    regime = st.analysis.classify(st.Record(time=np.arange(size), force=np.ones(size)))
    assert (regime.kind, regime.confidence) == ("undetermined", 0.0)
    assert f"number of samples: {size}, too few" in str(regime)


def test_one_cut_slip_is_no_cycle(paper_run: st.Trajectory) -> None:
    record = st.analysis.record_of(paper_run)
    early = record.time < 2.9
    regime = st.analysis.classify(st.Record(time=record.time[early], force=record.force[early]))
    assert regime.kind == "undetermined"
    assert regime.runner_up == "stick-slip"
    assert regime.evidence["slips_at"] == pytest.approx(2.032, abs=1e-3)


def test_cycles_that_are_alike_are_sure_however_few() -> None:
    time = np.arange(40_000) * 1e-3
    for samples in (6500, 12_500, 40_000):
        regime = st.analysis.classify(st.Record(time=time[:samples], force=time[:samples] % 2.0))
        assert regime.confidence > 0.98
    assert (
        st.analysis.classify(st.Record(time=time[:4500], force=time[:4500] % 2.0)).confidence == 0.5
    )


def test_few_cycles_that_differ_say_less_than_many() -> None:
    def confidence(count: int) -> float:
        rises = 0.85 + 0.06 * np.resize([1.0, -1.0], count + 2)  # either side of 0.777 is near
        start = np.arange(count + 2.0)
        corners = np.stack([start, start + rises], axis=1).ravel()
        time = np.arange(0.05, count + 1.95, 1e-3)
        force = np.interp(time, corners, np.resize([0.0, 1.0], len(corners)))
        return st.analysis.classify(st.Record(time=time, force=force)).confidence

    assert 0.5 < confidence(2) < confidence(4) < confidence(16) < 0.98


def test_what_dies_out() -> None:
    decay = 0.7 ** np.arange(10)
    assert dies_out(decay, np.ones(10), 0.5)
    assert dies_out(decay[:5], np.ones(5), 0.5)  # by the same factor each time
    assert not dies_out(np.array([1.0, 0.9, 0.4, 0.35, 0.2]), np.ones(5), 0.5)  # it may go on
    assert dies_out(decay[:5], np.ones(5), 4.0)  # but it did not
    assert not dies_out(decay[::-1], np.ones(10), 0.5)
    assert not dies_out([], [], 0.0)


@pytest.mark.parametrize("velocity", ["2 mm/s", "20 mm/s", "60 mm/s", "150 mm/s"])
def test_the_shape_of_a_cycle_says_how_long_it_rests(velocity: str, slider: st.Slider) -> None:
    """Friction that is constant in slip, and larger at rest: the case of the closed form."""
    drive = st.ConstantVelocity(velocity)
    law = st.Coulomb(mu_0=0.2, mu_static=0.3)
    aligned = slider.replace(phi="0 deg", friction=law, drive=drive)
    period = 2.0 * 3.0 / (1e3 * drive.velocity) + 0.1  # s, at least: it loads from trough to peak
    run = st.simulate(aligned, 12.0 * period, sample_rate=4000.0 / period)
    cycles = st.analysis.find_cycles(run)
    begin, end = float(cycles["start"][1]), float(cycles["trough_time"][-1])
    rests = np.diff(np.clip(run.stick_intervals, begin, end), axis=1).sum() / (end - begin)
    # a peak is placed to a fraction of a sample, of which a period has a hundred or more; the
    # share of rest changes six times as much as that of the rise at most, where that is > 0.52
    assert rests == pytest.approx(float(rest_share(cycles["rise_share"].median())), abs=0.02)
    assert st.analysis.classify(run).evidence["rest_share"] == pytest.approx(rests, abs=0.02)


def test_a_force_with_the_wrong_sign_is_asked_about() -> None:
    time = np.arange(20_000) * 1e-3
    regime = st.analysis.classify(st.Record(time=time, force=1.0 - time % 2.0))
    assert regime.kind == "undetermined"
    assert "as stick-slip with the other sign" in str(regime)


def test_words_have_units_and_no_powers_of_ten() -> None:
    time = np.arange(20_000) * 1e-3
    rig = {"stiffness": 1e6, "mass": 1e-3}
    text = str(st.analysis.classify(st.Record(time=time, force=1e-9 * (time % 2.0), **rig)))
    assert "a period is 10100 times the mass's own" in text  # 2 s sqrt(k/m)/(2 pi)
    assert "spans 310 pN" in str(st.analysis.classify(st.Record(time=time, force=1.6e-11 * time)))


def test_a_ratio_that_is_only_rounding_is_nothing() -> None:
    time = np.arange(0.0, 8.0, 1e-3)
    force = np.minimum(time, 1.0) + 1e-15 * np.sin(time)
    record = st.Record(time=time, force=force, stiffness=1e3, drive_velocity=1e-3)
    assert "its rate is 0 % of stiffness" in str(st.analysis.classify(record))


@pytest.mark.parametrize("make", [hum_over_loading, random_times])
def test_hum_is_no_motion(make: Callable[[np.random.Generator], Labelled]) -> None:
    """Over a first loading that then slides; and over stick-slip, sampled at random times."""
    found = [judge(make, 3, number) for number in range(15)]
    assert all(each.right and each.counted for each in found)


def test_a_vibration_that_begins_with_sliding_is_no_hum() -> None:
    """Of the same amplitude and frequency as hum, but not while the spring is loaded."""
    random = np.random.default_rng(4)
    time = np.arange(0.0, 8.0, 5e-4)
    vibration = 0.1 * np.sin(2 * pi * 50.03 * time) * (time > 3.0)
    force = np.minimum(time, 3.0) + vibration + 0.002 * random.normal(size=len(time))
    found = st.analyse(st.Record(time=time, force=force))
    assert found.regime.kind == "harmonic vibration"
    assert "was subtracted" not in " ".join(found.warnings)


def test_a_line_of_the_mains_without_a_loading_may_be_hum() -> None:
    """Nothing tells it from a vibration, but the frequency of the mass on its spring."""
    random = np.random.default_rng(5)
    time = np.arange(0.0, 5.0, 5e-4)
    record = st.Record(time=time, force=2.0 + 0.2 * mains(random, time))
    found = st.analyse(record)
    assert found.regime.confidence <= 0.5
    assert found.regime.runner_up == "steady sliding"
    assert "or this is hum" in str(found)
    own = record.model_copy(update={"mass": 1.0, "stiffness": (2 * pi * 61.0) ** 2})
    assert st.analysis.classify(own).confidence > 0.9


def test_a_vibration_that_only_the_spectrum_shows_has_no_cycles_to_be_the_mains() -> None:
    random = np.random.default_rng(7)
    frequency, beat = random.uniform(5, 15), random.uniform(0.2, 0.6)
    time = np.arange(512) * random.uniform(0.005, 0.02)
    rise = random.uniform(0, 4) * time / time[-1]
    lines = sum(np.sin(2 * pi * each * time) for each in (frequency, frequency + beat))
    found = st.analyse(st.Record(time=time, force=rise + 0.2 * lines))
    assert (found.regime.kind, found.cycles.sizes["cycle"]) == ("harmonic vibration", 0)


BELTS = [  # sticks for 50 to 75 % of a cycle, as all but the last are published
    st.presets.leine_belt,
    st.presets.leine_arctan,
    st.presets.leine_lugre,
    st.presets.lugre_stick_slip,
    st.presets.rosin_power_law,
]


@pytest.mark.parametrize("preset", BELTS)
def test_a_block_that_rests_for_half_of_a_cycle_sticks_and_slips(
    preset: Callable[[], st.Description],
) -> None:
    found = st.analyse(st.run(preset()))
    assert found.regime.kind == "stick-slip"
    assert found.regime.confidence > 0.9
    assert "The mass sticks and slips" in str(found)
    assert " of the peaks may be inertia" in str(found)
    assert "the slip speed stays below a tenth of the drive velocity for" in str(found.regime)


def test_rest_is_read_from_sticks_and_not_from_the_shape_alone() -> None:
    """Random blocks whose friction is larger at rest: the share of exact sticks decides."""
    stuck, kinds = [], []
    for mu, V in inside(12, (1.2, 2.5), (0.02, 0.2)):
        slider = st.Slider(
            mass=1.0, k_x=1.0, k_y=100.0, phi="0 deg", normal_load=1.0,
            friction=st.Coulomb(mu_0=1.0, mu_static=mu), drive=st.ConstantVelocity(V),
        )  # fmt: skip
        run = st.simulate(slider, 12.0 * (mu / V + 6.0), sample_rate=40.0)
        cycles = st.analysis.find_cycles(run)
        begin, end = float(cycles["start"][0]), float(cycles["trough_time"][-1])
        rests = np.diff(np.clip(run.stick_intervals, begin, end), axis=1).sum()
        stuck.append(rests / (end - begin))
        kinds.append(st.analysis.classify(run).kind)
    assert all(
        kind == "stick-slip" for kind, share in zip(kinds, stuck, strict=True) if share > 0.5
    )
    assert sum(0.5 < share < 0.75 for share in stuck) >= 3  # which the shape alone misjudges


def test_a_run_that_sticks_in_each_cycle_sticks_and_slips_however_shortly() -> None:
    """A block without damping under a peak of static friction, against its closed form.

    It sticks for 2 (mu_static - mu_0) W/(k V), and its slip is the part of a circle of the phase
    plane (Den Hartog); what begins as a vibration slower than the drive never sticks.
    """
    for number, (peak, decades) in enumerate(inside(100, (1.05, 2.5), (-2.0, 1.0))):
        law = st.Coulomb(mu_0=1.0, mu_static=peak)
        V = (peak - 1.0) * 10.0**decades
        vibrates = number % 4 == 0
        slider = st.Slider(
            mass=1.0, k_x=1.0, k_y=100.0, phi="0 deg", normal_load=1.0, friction=law,
            drive=st.ConstantVelocity(V),
        )  # fmt: skip
        u_x, v_x = (1.0 + 0.9 * V, 0.0) if vibrates else (1.0, V)
        start = st.Initial(u_x=u_x, v_x=v_x, v_y=0.0)
        stuck = 2.0 * (peak - 1.0) / V
        period = 2.0 * pi if vibrates else stuck + 2.0 * (pi - np.arctan((peak - 1.0) / V))
        run = st.simulate(slider, 8.5 * period, initial=start, sample_rate=400.0 / period)
        seen = st.analysis.classify(run)
        studied = observe_run(run.description, None).regime
        if vibrates:
            assert run.sticks.sizes["stick"] == 0
            assert (seen.kind, studied) == ("harmonic vibration", "harmonic vibration")
            continue
        assert stuck / period > 0.01  # far above an error of the slip speed
        assert (seen.kind, studied) == ("stick-slip", "stick-slip")
        assert seen.confidence > 0.9
        if "stick_share" in seen.evidence:  # solved to rtol 1e-6; the peaks lie between samples
            assert seen.evidence["stick_share"] == pytest.approx(stuck / period, rel=1e-3)


def test_what_a_short_stick_does_not_show_is_not_given() -> None:
    """Inertia adds to the peaks of a mass that sticks for 7 % of a cycle, nor does it creep."""
    found = st.analyse(st.run(st.presets.veraszto_stepan()))
    assert "The mass sticks and slips" in str(found)
    assert "and sticks for 7.4 % of that time" in str(found)
    assert found.friction.static is None
    assert np.isnan(found.cycles["creep_distance"]).all()


def in_two_parts(random: np.random.Generator) -> tuple[st.Record, float]:
    """Return stick-slip that turns into a vibration, and when."""
    change, pitch = random.uniform(8.0, 18.0), random.uniform(4.0, 12.0)
    time = np.arange(0.0, 26.0, 2e-3)
    corners = sawtooth(random, 40, random.uniform(0.8, 1.5))
    swing = 0.6 + 0.3 * np.sin(2 * pi * pitch * time)
    force = np.where(time < change, np.interp(time, *corners), swing)
    noise = 0.005 * random.normal(size=len(time))
    return st.Record(time=time, force=2.0 + force + noise), change


@pytest.mark.parametrize("number", range(10))
def test_two_kinds_of_motion_in_a_record_are_both_named(number: int) -> None:
    record, change = in_two_parts(np.random.default_rng([6, number]))
    found = st.analyse(record)
    assert {found.regime.kind, found.regime.runner_up} == {"stick-slip", "harmonic vibration"}
    assert found.regime.confidence < 0.8  # no more than the longer part has of the time
    assert found.regime.evidence["changed_at"] == pytest.approx(change, abs=1.6)  # a cycle
    assert "The motion changes at" in str(found)


@pytest.mark.parametrize("ends", ["before", "after"])
def test_a_long_part_without_cycles_is_named(ends: str) -> None:
    random = np.random.default_rng(3)
    time, force, _ = between(sawtooth(random, 15, 1.0), 500.0)
    cut = time > time[len(time) // 2]
    force = 2.0 + np.where(cut if ends == "after" else ~cut, 0.7, force)
    force += 0.005 * random.normal(size=len(time))
    told = " ".join(st.analyse(st.Record(time=time, force=force)).warnings)
    assert f"{ends.capitalize()} " in told
    assert "the force has no cycles like those that this report describes" in told


@pytest.mark.parametrize("share", [0.02, 0.05, 0.1])
def test_strokes_to_and_fro_are_no_vibration(share: float) -> None:
    """Friction of both signs, of a drive that turns round; a spring is loaded between them."""
    random = np.random.default_rng(8)
    time = np.arange(0.0, 40.0, 1e-3)
    place = np.interp(
        time % 4.0, [0.0, 2.0 * share, 2.0, 2.0 + 2.0 * share, 4.0], [-1, 1, 1, -1, -1]
    )
    record = st.Record(time=time, force=1.5 * place + 0.01 * random.normal(size=len(time)))
    found = st.analyse(record)
    assert found.regime.kind == "undetermined"
    assert "back and forth between both signs" in str(found)
    assert found.friction[:3] == (None, None, None)
    assert "against the drive" not in str(found)


@pytest.mark.parametrize(
    ("preset", "dies"),
    [(st.presets.free_vibration, True), (st.presets.modelica_spring, True)],
)
def test_a_mass_that_comes_to_rest_does_not_slide(
    preset: Callable[[], st.Description], dies: bool
) -> None:
    found = st.analyse(st.run(preset()))
    assert (found.regime.kind == "settling") == dies
    assert "the mass comes to rest" in str(found)
    assert found.friction.kinetic is None


def test_two_swings_and_then_quiet_have_died_out() -> None:
    assert dies_out([1.0, 0.5], [1.0, 1.0], 4.0)
    assert not dies_out([1.0, 0.5], [1.0, 1.0], 2.0)  # it may go on
    assert not dies_out([1.0, 0.95], [1.0, 1.0], 4.0)  # the drive may have stopped


def test_a_drive_that_varies_is_named() -> None:
    steps = st.analyse(st.run(st.presets.velocity_step_ageing()))
    assert steps.regime.kind == "settling"
    assert "The drive varies" not in " ".join(steps.warnings)  # the report begins with its test
    shaken = st.protocols.DriveProgram(
        velocity="1 mm/s", along=st.protocols.Modulation("0.3 mm/s", "3 Hz")
    )
    rig = st.presets.nakano_popov_2020().replace(drive=shaken)
    swings = st.analyse(st.simulate(rig, "3 s", sample_rate="2 kHz"))
    assert "The drive varies: kind of motion, cycles and friction" in swings.warnings[0]
    conveyor = st.analyse(st.run(st.presets.conveyor()))
    assert "The drive varies" not in " ".join(conveyor.warnings)
    assert isinstance(conveyor.parts["procedure"], Hysteresis)
    assert conveyor.friction.kinetic is None


def test_a_force_that_rises_from_a_load_may_be_drift() -> None:
    time = np.arange(4000) * 1e-3
    record = st.Record(time=time, force=3.0 + 0.3 * time)
    found = st.analysis.classify(record)
    assert (found.kind, found.runner_up) == ("stuck", "steady sliding")
    assert found.confidence <= 0.5
    known = record.model_copy(update={"stiffness": 300.0, "drive_velocity": 1e-3})
    assert st.analysis.classify(known).confidence > 0.9


@pytest.mark.parametrize("steps", [25.7, 40.2, 60.6])
def test_an_even_change_through_steps_of_a_converter_does_not_vibrate(steps: float) -> None:
    time = np.linspace(0.0, 4.0, 3000)
    rising, falling = (
        st.analysis.classify(st.Record(time=time, force=np.rint(0.25 * steps * force)))
        for force in (8.0 + time, 8.0 - time)
    )
    assert (rising.kind, falling.kind) == ("stuck", "steady sliding")


@pytest.mark.parametrize(("speed", "rest"), [(0.17, (0.0, 0.1)), (0.002, (0.8, 1.0))])
def test_stick_slip_says_how_long_the_mass_rests(speed: float, rest: tuple[float, float]) -> None:
    """A soft tester at 170 mm/s sticks in each cycle, yet slides for nearly all of it."""
    slider = st.Slider(
        mass=0.2,
        k_x=150.0,
        k_y=60e3,
        phi="0.5 deg",
        normal_load=2.0,
        friction=st.ExponentialWeakening(mu_0=0.35, mu_inf=0.22, v_f="5 mm/s"),
        drive=st.ConstantVelocity(speed),
    )
    run = st.simulate(slider, duration=5.0 if speed > 0.1 else 15.0, sample_rate=2e3)
    seen = st.analysis.classify(run)
    assert seen.kind == "stick-slip"
    share = float(re.findall(r"for ([\d.]+) % of a cycle", seen.rests)[0]) / 100.0
    assert rest[0] < share < rest[1]
    assert seen.rests.startswith("at rest or in creep" if seen.loads else "stuck")
    assert str(seen).startswith(f"stick-slip (confidence {seen.confidence:.2f}), {seen.rests}: ")
    if not seen.loads:
        cycles = st.analysis.find_cycles(run)
        ends = cycles["start"].values[0], cycles["trough_time"].values[-1]
        stuck = np.clip(run.stick_intervals, *ends)
        assert share == pytest.approx(np.ptp(stuck, axis=1).sum() / (ends[1] - ends[0]), rel=0.1)


STROKES = np.arange(0.0, 20.0, 1e-3)


@pytest.mark.parametrize("strokes", [2, 3, 4])
def test_stick_slip_in_strokes_of_either_sign_is_of_a_drive_that_turns_round(strokes: int) -> None:
    sign = np.where(STROKES // (20.0 / strokes) % 2 < 1, 1.0, -1.0)
    for pull in (np.ones(len(STROKES)), 0.8 + 0.2 * (STROKES / 0.5 % 1.0)):
        found = st.analyse(st.Record(time=STROKES, force=sign * pull))
        assert "back and forth between both signs" in str(found)
        assert found.friction[:3] == (None, None, None)
        assert "against the drive" not in str(found)


@pytest.mark.parametrize(
    "force",
    [
        np.sin(2 * pi * 1.3 * STROKES),  # a vibration about zero
        0.2 * (STROKES / 0.5 % 1.0) - 0.1,  # stick-slip about an untared zero
        np.where(STROKES < 6.0, np.minimum(STROKES - 4.0, 1.0), 1.0).clip(-1.0),  # a first loading
    ],
)
def test_a_force_that_passes_zero_is_of_no_strokes(force: np.ndarray) -> None:
    noise = 2e-3 * np.random.default_rng(1).normal(size=len(STROKES))
    found = st.analysis.classify(st.Record(time=STROKES, force=force + noise))
    assert "forth" not in found.evidence


def test_a_force_that_rises_and_falls_evenly_is_no_vibration() -> None:
    noise = 1e-3 * np.random.default_rng(1).normal(size=len(STROKES))
    for rises in (1.8, 2.0, 2.2):
        place = np.interp(STROKES % 4.0, [0.0, rises, 4.0], [0.0, 1.0, 0.0])
        found = st.analyse(st.Record(time=STROKES, force=1.0 + place + noise))
        assert (found.regime.kind, found.regime.confidence) == ("undetermined", 0.0)
        assert "No vibration has such a shape" in str(found)


def test_a_vibration_whose_pitch_rises_is_harmonic() -> None:
    turns = 0.5 * STROKES + 0.2 * STROKES**2
    found = st.analysis.classify(st.Record(time=STROKES, force=3.0 + np.sin(2 * pi * turns)))
    assert found.kind == "harmonic vibration"
    assert found.confidence > 0.9


def test_swings_that_differ_by_rounding_are_regular() -> None:
    force = np.clip(3.0 + 1.3 * np.sin(2 * pi * 2.0 * STROKES), 2.0, 4.0)
    found = st.analysis.classify(st.Record(time=STROKES, force=force))
    assert (found.kind, found.runner_up) == ("harmonic vibration", "")
    assert found.confidence > 0.99


@pytest.mark.parametrize(
    "force",
    [
        5.0 + np.sin(2 * pi * 3.0 * STROKES) + 0.8 * np.sin(2 * pi * 1.5 * STROKES),  # doubled
        1.0  # a load cell that rings after each slip
        - 0.3 * np.exp(-8.0 * (STROKES % 1.0)) * np.cos(2 * pi * 7.0 * (STROKES % 1.0))
        + 0.1 * (STROKES % 1.0),
    ],
)
def test_cycles_that_turn_back_are_not_of_the_other_sign(force: np.ndarray) -> None:
    found = st.analyse(st.Record(time=STROKES, force=force))
    assert (found.regime.kind, found.regime.confidence) == ("undetermined", 0.0)
    assert "sign" not in str(found)


@pytest.mark.parametrize(("size", "period"), [(20_000, 15.0), (40, 0.025)])
def test_one_cycle_and_a_bit_is_no_steady_sliding_for_sure(size: int, period: float) -> None:
    time = STROKES[:size]
    noise = 1e-3 * np.random.default_rng(1).normal(size=size)
    found = st.analyse(st.Record(time=time, force=0.8 + 0.2 * (time / period % 1.0) + noise))
    assert found.regime.confidence < 0.5
    assert "The mass sticks, slips once" in str(found)


def test_a_single_slip_in_steady_sliding_is_named() -> None:
    slip = 0.3 * np.sin(10 * pi * (STROKES - 9.0)) * (abs(STROKES - 9.05) < 0.05)
    noise = 3e-3 * np.random.default_rng(1).normal(size=len(STROKES))
    found = st.analyse(st.Record(time=STROKES, force=1.0 - slip + noise))
    assert found.regime.kind == "steady sliding"
    assert found.regime.evidence["falls_at"] == pytest.approx(9.0, abs=0.03)
    assert found.regime.evidence["falls_by"] == pytest.approx(0.3, abs=0.03)
    assert "a single slip, or a knock" in str(found)


@pytest.mark.parametrize("samples", [2.103, 2.112, 2.4, 3.0, 3.3])
def test_fewer_than_four_samples_a_cycle_are_no_steady_sliding(samples: float) -> None:
    """Near two of them a short spectrum has nothing beside the line but the line."""
    time = np.arange(int(61.5 * samples)) * 1e-2
    for fall in (0.047, 0.179):
        phase = (time / (1e-2 * samples) + 0.3) % 1.0
        force = np.where(phase < 1 - fall, phase / (1 - fall), (1 - phase) / fall)
        found = st.analysis.classify(st.Record(time=time, force=5.0 + force))
        assert found.kind == "undetermined"
        assert "too few to show it" in str(found)


def test_of_many_large_falls_none_is_single() -> None:
    noise = 0.01 * np.random.default_rng(1).standard_t(2, size=len(STROKES))
    found = st.analysis.classify(st.Record(time=STROKES, force=2.0 + noise))
    assert found.kind == "steady sliding"
    assert "falls_by" not in found.evidence


def test_a_vibration_along_a_stiff_spring_is_not_across_the_drive() -> None:
    """The softer spring is the transverse one: its slow period says nothing of this motion."""
    slider = st.Slider(
        mass=0.3, k_x=40e3, k_y=3e3, phi="6 deg", normal_load=12.0,
        friction=st.ExponentialWeakening(mu_0=0.4, mu_inf=0.3, v_f="50 mm/s"),
        drive=st.ConstantVelocity("3 mm/s"),
    )  # fmt: skip
    run = st.simulate(slider, duration=1.0, sample_rate=4e3)
    found = st.analyse(run)
    assert found.cycles["period"].mean() < 0.5 / slider.natural_frequencies[0]
    assert found.regime.kind != "transverse oscillation"
    assert "across the drive" not in str(found)
    assert observe_run(run.description, None).regime == found.regime.kind
    assert "oscillation" not in figures(found)  # of which nothing stands out


@pytest.mark.parametrize("number", range(5))
def test_stick_slip_under_noise_as_high_as_its_drops_is_no_steady_sliding(number: int) -> None:
    record, _, _ = in_noise(np.random.default_rng([1, number]))
    found = st.analysis.classify(record)
    assert found.kind == "undetermined"
    assert "in noise that hides their shape" in str(found)


@pytest.mark.parametrize("number", [249, 269, 294, 304, 478])
def test_a_line_that_hardly_stands_out_of_noise_leaves_no_sliding_for_sure(number: int) -> None:
    record, _, _ = in_noise(np.random.default_rng([5, number]))
    assert st.analysis.classify(record).kind == "undetermined"


@pytest.mark.parametrize("make", [irregular_in_noise, irregular_few_samples])
def test_irregular_stick_slip_in_noise_is_not_claimed_to_be_another_motion(
    make: Callable[[np.random.Generator], Labelled],
) -> None:
    found = [judge(make, 5, number) for number in range(40)]
    assert not [each for each in found if each.wrong and each.confidence > 0.6]


def test_quick_falls_that_noise_hides_are_named() -> None:
    slips, _, _ = irregular_in_noise(np.random.default_rng([5, 5]))
    regime = st.analysis.classify(slips)
    assert regime.surely == "undetermined, perhaps stick-slip"
    assert "hardly ever rises so quickly, as where a mass slips; the median of these" in str(regime)
    assert "by about 1 N" in st.analyse(slips).parts["motion"]


def test_small_slips_of_a_mass_that_slides_are_named() -> None:
    regime = st.analysis.classify(read_measured("k2254_v42"))
    assert regime.kind == "steady sliding"
    assert regime.evidence["quick_falls"] > 100


def test_falls_that_are_not_most_of_the_motion_leave_its_kind_as_sure_however_clear() -> None:
    def classify(number: int) -> Regime:
        rng, time = np.random.default_rng([3, 0]), np.arange(6000) / 200.0
        wanders = 2.0 + 0.004 * np.cumsum(rng.normal(size=6000)) + 0.01 * rng.normal(size=6000)
        at = np.sort(rng.choice(6000, number, replace=False))
        fallen = 0.12 * (np.searchsorted(at, np.arange(6000)) - number * time / 30.0)
        return st.analysis.classify(st.Record(time=time, force=wanders - fallen))

    unclear, clear = classify(6), classify(9)
    assert unclear.kind == clear.kind == "steady sliding"
    assert "quick_falls" not in unclear.evidence
    assert clear.evidence["quick_falls"] == 9
    assert unclear.confidence > 0.9 * clear.confidence


def test_faint_swings_in_steady_sliding_are_named() -> None:
    time = np.arange(0.0, 60.0, 1e-3)
    noise = 0.1 * np.random.default_rng(2).normal(size=len(time))
    force = 2.0 + noise + 0.015 * np.sin(2 * pi * 1.3 * time)
    found = st.analysis.classify(st.Record(time=time, force=force))
    assert found.kind == "steady sliding"
    assert 0.6 < found.confidence < 0.8
    assert found.evidence["hidden"] == pytest.approx(1.3, rel=1e-3)


@pytest.mark.parametrize(("period", "drop"), [(9.0, 1.0), (1.0, 9.0), (1.0, 1.0)])
def test_a_few_swings_apart_from_all_others_do_not_make_a_vibration_irregular(
    period: float, drop: float
) -> None:
    """A pause, or a knock: either alone would raise the spread beyond that of one size."""
    sizes = 1.0 + 0.01 * np.random.default_rng(1).standard_normal((2, 14))
    sizes[:, [4, 9]] *= [[period], [drop]]
    assert not is_irregular(*sizes)
    sizes[:, ::3] *= 9.0  # every third is one of them
    assert is_irregular(*sizes)


@pytest.mark.parametrize(("second", "height"), [(1.03, 1.0), (0.95, 0.6), (1.2, 0.9)])
def test_two_vibrations_that_beat_are_not_irregular(second: float, height: float) -> None:
    time = np.arange(0.0, 300.0, 0.04)
    force = 5.0 + np.sin(2 * pi * time) + height * np.sin(2 * pi * second * time)
    found = st.analysis.classify(st.Record(time=time, force=force))
    assert found.kind == "harmonic vibration"
    assert found.evidence["beat"] == pytest.approx(abs(second - 1.0), rel=0.02)


@pytest.mark.parametrize("load", ["0 mm", "1 mm"])
@pytest.mark.parametrize(
    "law",
    [
        st.Coulomb(mu_0=0.2),
        st.laws.RateStateAgeing(mu_star=0.6, a=0.008, b=0.014, D_c="10 um", V_star="1 um/s"),
    ],
)
def test_a_mass_that_never_moves_is_stuck(slider: st.Slider, load: str, law: Any) -> None:
    """It was "sliding steadily (confidence 1.00)": its force does not rise."""
    still = slider.replace(drive=st.ConstantVelocity(0.0), friction=law)
    initial = st.Initial(u_x=load)
    found = st.analyse(st.simulate(still, "1 s", initial=initial, sample_rate="200 Hz"))
    assert found.regime.kind == "stuck"
    assert "The mass rests from beginning to end" in str(found)
    assert found.friction.missing["kinetic"] == "the mass does not slide"
    observed = observe_run(st.Description(still, initial, st.Settings(duration="1 s")), None)
    assert observed.regime == "stuck"


@pytest.mark.parametrize("end", [2.04, 2.05, 2.07, 2.09])
@pytest.mark.parametrize("noise", [0.0, 1e-3])
def test_a_slip_that_ends_the_record_is_not_denied(
    paper_run: st.Trajectory, end: float, noise: float
) -> None:
    """The force has fallen by 8 to 820 mN; its means over a 32nd of the time only rise."""
    whole = st.analysis.record_of(paper_run)
    part = whole.time < end
    hidden = noise * np.random.default_rng(1).standard_normal(len(whole))[part]
    record = st.Record(time=whole.time[part], force=whole.force[part] + hidden)
    found = st.analyse(record)
    assert found.regime.kind == "undetermined"
    assert "the mass begins to slip" in str(found)
    assert (found.friction.break_away is None) == (end < 2.05)


@pytest.mark.parametrize("number", range(20))
def test_noise_on_a_loading_is_no_fall(number: int) -> None:
    """White, or digitised; by chance one record in a thousand ends so."""
    random = np.random.default_rng([3, number])
    time = np.arange(4000) * 1e-3
    force = time + 10.0 ** random.uniform(-4, -1) * random.standard_normal(4000)
    step = 10.0 ** random.uniform(-4, -2)
    for values in (force, step * np.rint(force / step), step * np.rint(time / step)):
        assert final_fall(time, values) is None


@pytest.mark.parametrize("rate", [10.0, 20.0, 60.0])
def test_a_run_that_sticks_between_its_samples_does_not_slide_steadily(rate: float) -> None:
    """It was "settling (confidence 1.00)": the mass rested for 95 % of the time to the end."""
    law = st.ExponentialWeakening(mu_0=0.1347, mu_inf=0.10616, v_f=0.112, mu_static=0.1413)
    slider = st.Slider(
        mass=0.0447, k_x=137.0, k_y=72800.0, phi="7.39 deg", normal_load=111.8,
        friction=st.laws.Anisotropic(law, ratio=1.4126, angle="-70.5 deg"),
        drive=st.ConstantVelocity("3.66 mm/s"),
    )  # fmt: skip
    found = st.analyse(st.simulate(slider, 60.0, sample_rate=rate))
    if rate > 59.0:  # as the others ask for
        assert found.regime.kind == "stick-slip"
        return
    assert found.regime.kind == "undetermined"
    assert found.regime.evidence["rate_needed"] < 60.0
    assert "sticks and slips, too often for so few samples" in str(found)
    assert "steadily" not in str(found)


def test_no_hum_is_suspected_in_a_run() -> None:
    """A run on a rig that swings at 120 Hz was told that it "is probably hum"."""
    slider = st.Slider(
        mass=0.01824, k_x=1e4, k_y=1.489e5, phi="2.93 deg", normal_load=1504.5,
        friction=st.Coulomb(0.206), drive=st.ConstantVelocity("55.5 mm/s"),
    )  # fmt: skip
    told = str(st.analyse(st.simulate(slider, 3.35, sample_rate=1791.0)))
    assert "Oscillation\n  Seen in" in told
    assert "hum" not in told


@pytest.mark.parametrize("course", ["one slip", "half a cycle"])
def test_a_record_of_less_than_a_cycle_does_not_show_whether_the_mass_slides(course) -> None:
    """It was steady sliding, with a kinetic friction, and the rate of loading was its drift."""
    share = np.linspace(0.0, 1.0, 4000)
    force = share - 0.4 * (share > 0.6) if course == "one slip" else np.sin(2.5 * share)
    force = force + 1e-3 * np.random.default_rng(1).normal(size=len(share))
    found = st.analyse(st.Record(time=10.0 * share, force=force))
    assert found.regime.kind == "undetermined"
    assert {"one slip": "slips once, at 5.99", "half a cycle": "does not settle"}[course] in str(
        found
    )
    assert found.friction.kinetic is None
    assert "drift" not in " ".join(found.warnings)
    slides = np.minimum(force[:2400], 0.3)
    assert st.analyse(st.Record(time=share[:2400], force=slides)).friction.kinetic is not None


def with_gaps(record: st.Record, number: int) -> st.Record:
    """Return a record without a third of its samples, in as many gaps."""
    at = np.arange(len(record)) * number / len(record)
    kept = at % 1.0 < 2 / 3
    return st.Record(time=record.time[kept], force=record.force[kept])


def test_slips_that_noise_hides_are_no_steady_sliding_because_of_gaps() -> None:
    """A spectrum shows them, but not across gaps: 36 of 40 were taken for sliding."""
    found = []
    for number in range(40):
        record, _, _ = in_noise(np.random.default_rng([5, number]))
        found.append(st.analysis.classify(with_gaps(record, 2)))
    wrong = [each for each in found if each.kind in ("steady sliding", "settling", "stuck")]
    assert len(wrong) <= 2
    assert any("of the time lies in gaps" in str(each) for each in found)


def test_steady_sliding_with_gaps_is_known() -> None:
    for number in range(10):
        noise = np.random.default_rng([6, number]).normal(size=6000)
        steady = st.Record(time=1e-3 * np.arange(6000), force=2.0 + 0.05 * noise)
        seen = st.analysis.classify(with_gaps(steady, 4))
        assert seen.kind == "steady sliding"
        assert seen.confidence > 0.7


def slide_hold_slide(sign: float, begin: float = 0.0) -> st.Record:
    """Return sliding at 6 N after a loading, with four holds that relax by 10 %."""
    corners = [(0.0, 0.0), (1.0, 6.0)]
    for hold in 10.0 + 20.0 * np.arange(4):
        corners += [(hold, 6.0), (hold + 1.0, 5.6), (hold + 5.0, 5.4), (hold + 5.2, 6.4)]
        corners += [(hold + 5.6, 6.0)]
    time = np.arange(begin, 85.0, 0.01)
    force = np.interp(time, *np.array(corners).T)
    force += 0.01 * np.random.default_rng(7).normal(size=len(time))
    return st.Record(time=time, force=sign * force, normal_load=10.0)


def test_holds_recorded_with_the_other_sign_are_no_stick_slip() -> None:
    """Upside down, the force rises slowly in a hold, then falls: it was stick-slip for sure."""
    found = st.analyse(slide_hold_slide(-1.0))
    assert found.regime.kind == "undetermined"
    assert "against" in found.regime.evidence
    assert "recorded with the other sign" in str(found)
    zeroed = slide_hold_slide(-1.0, begin=5.0).model_copy(update={"zero": 0.0})
    assert "against" in st.analysis.classify(zeroed).evidence


def test_stick_slip_keeps_its_kind_behind_a_zero_that_is_off() -> None:
    """Its peaks are negative, too, but it does not begin with an unloaded spring."""
    time, force, _ = between(sawtooth(np.random.default_rng(1), 20, 1.0), 500.0)
    found = st.analysis.classify(st.Record(time=time, force=force - 8.0))
    assert found.kind == "stick-slip"
    upright = st.Record(time=time, force=force).model_copy(update={"zero": 0.0})
    assert st.analysis.classify(upright).kind == "stick-slip"


@pytest.mark.parametrize(("friction", "kind"), [(0.2, "steady sliding"), (0.0, "stuck")])
def test_a_force_that_rises_with_its_load_is_no_loading_of_the_spring(
    friction: float, kind: str
) -> None:
    """On a tilted plate friction may rise by chance as fast as the spring is loaded."""
    for random, (rise,) in enumerate(inside(10, (0.1, 0.4))):
        noise = np.random.default_rng([8, random]).normal(size=(2, 2000))
        time = np.linspace(0.0, 1.0, 2000)
        load = 10.0 * (1.0 + rise * time)
        force = (friction * load if friction else 2.0 * rise * time) + 5e-3 * noise[0]
        record = st.Record(
            time=time,
            force=force,
            load=load + 0.05 * noise[1],
            stiffness=1e3,
            drive_velocity=2e-3 * rise,
        )
        assert st.analysis.classify(record).kind == kind


def test_a_force_that_rises_faster_than_its_spring_is_loaded_may_drift() -> None:
    """It begins loaded, too; by stiffness and drive velocity it was stuck for sure."""
    time = np.linspace(0.0, 1.0, 2000)
    known = {"stiffness": 1e3, "drive_velocity": 1e-3}
    begun = 5.0 + 3e-3 * np.random.default_rng(1).normal(size=len(time))
    seen = st.analysis.classify(st.Record(time=time, force=begun + 1.2 * time, **known))
    assert seen.confidence <= 0.5
    sure = st.analysis.classify(st.Record(time=time, force=begun + 1.05 * time, **known))
    assert sure.kind == "stuck"
    assert sure.confidence > 0.8


def test_each_name_of_evidence_has_words():
    assert get_args(Evidence) == (*WORDS,)
