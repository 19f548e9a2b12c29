"""What a record says of its apparatus, on records whose answer is known."""

from dataclasses import replace

import numpy as np
import pytest
from benchmarks.explore.draw import Draw
from benchmarks.explore.numbers import slips
from benchmarks.explore.records import between
from benchmarks.explore.records import sawtooth as sawtooth_of
from scipy.signal import lfilter
from tests.drawn import SEED, inside
from tests.measured import read_measured
from tests.parts import assess

import stiction as st
from stiction.analysis.motion.cycle_columns import table_of
from stiction.analysis.motion.cycles import swings
from stiction.analysis.motion.metadata.comparison import compare_metadata
from stiction.analysis.motion.metadata.drive_velocity import drive_velocity
from stiction.analysis.motion.metadata.loading_rate import BY_RISE, LOADING_RATE, _loading_rate
from stiction.analysis.motion.metadata.quantity import StatedQuantity, median_error
from stiction.analysis.motion.metadata.stiffness_over_mass import BY_SLIPS, SWING
from stiction.analysis.motion.regime.kinds import HARMONIC
from stiction.analysis.parts import metadata as parts_of_metadata
from stiction.analysis.parts.metadata import _is_shown_as_bound
from stiction.presets.preset import on_a_line

RATE = 2000.0
TIME = np.arange(0.0, 20.0, 1.0 / RATE)
STIFFNESS, VELOCITY, MASS = 200.0, 1e-3, 0.05  # k/m = 4000 1/s^2


def sawtooth(scale=1.0):
    """Stick-slip that loads with k V, and slips in half a period of the mass on its spring."""
    slip = np.pi * (MASS / STIFFNESS) ** 0.5
    rise = 0.5
    phase = TIME % (rise + slip)
    drop = STIFFNESS * VELOCITY * rise
    falling = 0.5 * drop * (1.0 + np.cos(np.pi * (phase - rise) / slip))
    force = 1.0 + np.where(phase < rise, STIFFNESS * VELOCITY * phase, falling)
    noise = 1e-4 * np.random.default_rng(1).standard_normal(len(TIME))
    return scale * force + noise


def compare(force, time=TIME, **known):
    """The comparisons of a record by name."""
    found = st.analyse(st.Record(time=time, force=force, **known))
    return {each.quantity: each for each in found.parts["metadata"]}, str(found)


def test_a_true_description_is_not_contradicted():
    its, said = compare(
        sawtooth(), stiffness=STIFFNESS, drive_velocity=VELOCITY, mass=MASS, normal_load=5.0
    )
    loading, swing = its["stiffness times drive velocity"], its["stiffness over mass"]
    assert loading.found == pytest.approx(STIFFNESS * VELOCITY, rel=0.01)
    assert loading.agrees
    # peaks and troughs of a cosine are flat: a slip of 0.05 s is found to some percent
    assert swing.found == pytest.approx(STIFFNESS / MASS, rel=0.2)
    assert swing.agrees
    assert "contradicts" not in said


def test_a_value_that_differs_is_possible_and_does_not_agree():
    true = {"stiffness": STIFFNESS, "drive_velocity": VELOCITY}
    its, said = compare(sawtooth(), mass=MASS / 1.4, **true)
    swing = its["stiffness over mass"]
    assert abs(swing.found - swing.stated) > 5.0 * swing.error
    row = next(line for line in said.splitlines() if line.startswith("  stiffness over mass"))
    assert "possible" in row
    assert "agrees" not in row
    assert "not contradict stiffness over mass and stiffness times drive velocity as stated" in said


@pytest.mark.parametrize(
    ("found", "error", "verdict"),
    [(0.96, 0.02, "agrees"), (0.8, 0.2, "possible"), (0.6, 0.3, "")],
)
def test_a_bound_agrees_only_where_it_is_near_what_is_stated(found, error, verdict):
    """A bound of 300 1/s² agreed with a stated 750 1/s², and so did one below zero."""
    its = StatedQuantity(SWING, "1/s²", found, error, 1.0, 0.4, 1.4, BY_SLIPS, is_bound=True)
    assert its.agrees
    assert parts_of_metadata.verdict(its) == verdict


def test_no_sentence_agrees_with_what_is_not_determined(monkeypatch):
    """The row said "not determined ... agrees", and the text that the record agrees."""
    known = {"stiffness": STIFFNESS, "drive_velocity": VELOCITY, "mass": MASS}
    found = st.analyse(st.Record(time=TIME, force=sawtooth(), **known))
    its = [
        each._replace(error=each.found) if each.quantity == "stiffness over mass" else each
        for each in found.parts["metadata"]
    ]
    shown = parts_of_metadata.section(replace(found, parts={**found.parts, "metadata": tuple(its)}))
    assert shown.sentences[0] == (
        "The record agrees with stiffness times drive velocity as stated."
    )
    assert "duration of slips" not in " ".join(shown.sentences)


@pytest.mark.parametrize("rests", [True, False])
def test_a_force_that_rises_from_the_first_sample_on_shows_no_zero(rests):
    """It showed "zero 14 ± 8 mN", half of what the spring is loaded by in the first readings."""
    noise = 1e-4 * np.random.default_rng(2).standard_normal(len(TIME))
    force = 0.2 * np.maximum(TIME - 1.0 * rests, 0.0) % 1.0 + noise
    its, _ = compare(force, stiffness=STIFFNESS, mass=MASS)
    assert ("zero" in its) is rests


def test_the_error_of_the_mass_holds_what_samples_and_noise_hide_of_a_slip():
    """Of 60 records, with the scatter alone 36 were off by more than two errors."""
    off = []
    ranges = ((-3.0, -1.5), (6.0, 40.0), (6.0, 40.0), (3.0, 30.0))
    for seed, (noise, samples, stick, cycles) in enumerate(inside(60, *ranges)):
        time = np.arange(0.0, (1.0 + stick) * cycles, 1.0 / samples)  # in durations of a slip
        phase = (time + 0.3 * stick) % (1.0 + stick)
        fall = 0.5 * (1.0 + np.cos(np.pi * (phase - stick)))
        force = 2.0 + np.where(phase < stick, phase / stick, fall)
        force += 10.0**noise * np.random.default_rng(seed).standard_normal(len(time))
        known = {"stiffness": 1.0, "drive_velocity": 1.0 / stick, "mass": 1.0}
        stated = assess(st.Record(time=time, force=force, **known)).stated
        for swing in (each for each in stated if each.quantity == SWING):
            off.append(abs(swing.found - np.pi**2) / swing.error)
    assert len(off) >= 40
    assert np.mean(np.array(off) > 2.0) < 0.1


def test_slips_that_noise_hides_tell_no_mass():
    noise = np.random.default_rng(2).standard_normal(len(TIME))
    its, _ = compare(sawtooth() + 0.012 * noise, stiffness=STIFFNESS, mass=MASS)  # drops: 0.1 N
    assert its["stiffness times drive velocity"].found == pytest.approx(0.2, rel=0.05)
    assert SWING not in its


def test_slips_in_which_the_force_hesitates_tell_no_mass():
    """Such a fall lasts for the rise in it as well: k/m seemed to be 0.05 times as large."""
    corners = np.cumsum([0.0, *np.tile([0.7, 0.03, 0.08, 0.03], 24)])
    force = np.interp(TIME, corners, [0.0, *np.tile([1.0, 0.5, 0.8, 0.0], 24)])
    found = swings(st.Record(time=TIME, force=force)).lasting
    assert (found["hesitations"] == 1.0).all()
    its, said = compare(1.0 + force, mass=1.0, stiffness=(np.pi / 0.03) ** 2)
    assert SWING not in its
    assert "By the duration of its slips" not in said


def test_a_bound_is_called_so_where_nothing_is_stated_to_compare_it_with():
    its, said = compare(sawtooth(), stiffness=STIFFNESS, drive_velocity=VELOCITY)
    swing = its["stiffness over mass"]
    assert swing.agrees is None
    assert swing.at_least == pytest.approx(swing.found - 2.0 * swing.error, rel=0.02)
    assert f"≥ {swing.at_least:.0f}"[:4] in said
    assert "The duration of slips gives a lower bound of stiffness over mass" in said


@pytest.mark.parametrize("cut_off", [0.7, 1.5, 4.0])
@pytest.mark.parametrize("weaker", [0.3, 0.7])
def test_what_slips_and_rises_show_is_a_bound_behind_filters_and_beside_creep(cut_off, weaker):
    """Two errors of the scatter hold k/m in 39 of 100 filtered runs, and k V in 29 of 100."""
    law = st.ExponentialWeakening(mu_0=0.6, mu_inf=0.6 * weaker, v_f="10 mm/s")
    rig = {"mass": "80 g", "k_x": "2.3 kN/m", "k_y": "0.9 MN/m", "normal_load": "4 N"}
    slider = st.Slider(**rig, phi="2 deg", friction=law, drive=st.ConstantVelocity("2 mm/s"))
    run = st.simulate(slider, "10 s", sample_rate="2 kHz")
    swing = slider.natural_frequency_x
    filtered = st.measure(run, st.Sensor(noise="1 mN", bandwidth=cut_off * swing), seed=1)
    known = {"stiffness": 2300.0, "mass": 0.08, "drive_velocity": 0.002, "normal_load": 4.0}
    its, said = compare(filtered.force, filtered.time, **known)
    shown = [its[name] for name in (SWING, LOADING_RATE) if name in its]
    assert shown
    for each in shown:
        assert 0.0 < each.at_least < each.stated
        assert _is_shown_as_bound(each)
    assert "contradicts" not in said


def test_slips_that_are_far_too_long_make_a_mass_doubtful():
    """Of a lower bound a larger value is no contradiction."""
    true = {"stiffness": STIFFNESS, "drive_velocity": VELOCITY}
    _, said = compare(sawtooth(), mass=MASS / 4.0, **true)
    assert "The record casts doubt on stiffness over mass as stated" in said
    row = next(line for line in said.splitlines() if line.startswith("  stiffness over mass"))
    assert "≥" in row
    assert "doubtful" in row


@pytest.mark.parametrize(
    ("wrong", "quantity", "ratio"),
    [
        ({"mass": 3.0 * MASS}, "stiffness over mass", 3.0),
        ({"drive_velocity": 0.5 * VELOCITY}, "stiffness times drive velocity", 2.0),
    ],
)
def test_a_wrong_description_is_contradicted(wrong, quantity, ratio):
    true = {"stiffness": STIFFNESS, "drive_velocity": VELOCITY, "mass": MASS}
    its, said = compare(sawtooth(), **(true | wrong))
    assert its[quantity].agrees is False
    assert its[quantity].ratio == pytest.approx(ratio, rel=0.2)
    assert "contradicts" in said


def test_the_error_of_a_median_is_its_own():
    """Of normal values that of their trimmed mean holds 90 % only."""
    values = np.random.default_rng(6).standard_normal((1000, 40))
    off = [abs(np.median(each)) / median_error(each) for each in values]
    assert np.mean(np.array(off) < 2.0) == pytest.approx(0.954, abs=0.015)


@pytest.mark.parametrize(("faster", "agrees"), [(1.13, True), (2.0, False)])
def test_a_rate_of_loading_contradicts_by_more_than_its_errors(faster, agrees):
    """Where loadings differ, few of them tell the rate to some percent only."""
    random = np.random.default_rng(4)
    time, force, _ = between(sawtooth_of(random, 14, 1.0, 0.4), 300.0)
    force += 0.02 * random.standard_normal(len(time))
    found = swings(st.Record(time=time, force=force)).lasting["stick_slope"]
    stated = float(np.median(found)) / faster
    its, _ = compare(force, time, stiffness=100.0, drive_velocity=stated / 100.0)
    rate = its["stiffness times drive velocity"]
    assert rate.ratio == pytest.approx(faster)
    assert rate.error > 0.03 * rate.found
    assert rate.agrees is agrees


@pytest.mark.parametrize(("found", "bound"), [(0.8, True), (1.11, False)])
def test_creep_is_no_reason_why_a_force_rises_faster(found, bound):
    rate = StatedQuantity(LOADING_RATE, "N/s", found, 0.01, 1.0, 0.48, 1.12, BY_RISE, is_bound=True)
    assert rate.agrees
    assert not rate.is_same
    assert _is_shown_as_bound(rate) is bound


def test_the_rest_in_a_vibration_is_not_taken_for_a_heavier_mass():
    """A mass on a spring that rests for 40 % of each cycle: its period is 1.2 times its own."""
    law = st.laws.HyperbolicWeakening(mu_0=0.4, v_h="0.1 m/s", mu_inf=0.2)
    rig = {"mass": 1.0, "k_x": 1e4, "k_y": 1e8, "phi": "0 deg", "normal_load": 50.0}
    slider = st.Slider(**rig, friction=law, drive=st.ConstantVelocity("50 mm/s"))
    run = st.simulate(slider, "4 s", sample_rate="2 kHz")
    force = run.samples["spring_x"]
    known = {"stiffness": 1e4, "mass": 1.0, "drive_velocity": 0.05, "normal_load": 50.0}
    found = st.analyse(st.Record(time=run.samples["time"], force=force, **known))
    assert found.regime.kind == "harmonic vibration"
    swing = next(each for each in found.parts["metadata"] if each.quantity == "stiffness over mass")
    assert swing.ratio == pytest.approx(1.0, abs=0.05)
    assert swing.error > 0.1 * swing.found  # of the scatter alone it was 1e-5
    assert not any("check mass" in warning for warning in found.warnings)


def test_the_drive_and_the_load_are_compared_with_their_channels():
    noise = 1e-6 * np.random.default_rng(2).standard_normal(len(TIME))
    its, said = compare(
        sawtooth(),
        drive_velocity=2.0 * VELOCITY,
        drive_position=VELOCITY * TIME + noise,
        load=5.0 + 0.01 * np.sin(TIME),
        normal_load=5.0,
    )
    drive = its["drive velocity"]
    assert abs(drive.found - VELOCITY) < 4.0 * drive.error
    assert drive.agrees is False
    assert its["normal load"].agrees
    assert "Drive velocity: by the slope of the drive's displacement it is 0.5 times" in said


def test_times_may_count_from_1970():
    """The squares of such times leave no digits: the error of the velocity was zero."""
    noise = 1e-6 * np.random.default_rng(2).standard_normal(len(TIME))
    drive = VELOCITY * TIME + noise
    of_old, today = (
        compare(sawtooth(), TIME + since, drive_velocity=VELOCITY, drive_position=drive)[0]
        for since in (0.0, 1.7e9)
    )
    assert today["drive velocity"].error > 0.0
    for name, its in of_old.items():
        # such a time is rounded to 2e-7 s, and a slip takes 0.05 s
        assert today[name].found == pytest.approx(its.found, rel=1e-5, abs=0.01 * its.error)
        assert today[name].error == pytest.approx(its.error, rel=1e-2)


@pytest.mark.parametrize("strokes", [2, 3, 10])
def test_the_speed_of_a_drive_that_turns_is_that_between_its_turns(strokes):
    """On the whole it hardly moves; that contradicted the stated velocity."""
    noise = 1e-6 * np.random.default_rng(2).standard_normal(len(TIME))
    length = VELOCITY * np.ptp(TIME) / strokes
    travel = VELOCITY * (TIME - TIME[0])
    there = length * (1.0 - np.abs(1.0 - travel / length % 2.0)) + noise
    its, said = compare(sawtooth(), drive_velocity=VELOCITY, drive_position=there)
    drive = its["drive velocity"]
    assert drive.found == pytest.approx(VELOCITY, rel=0.01)
    assert drive.agrees
    assert "contradicts" not in said


@pytest.mark.parametrize("noise", [1e-9, 1e-6, 1e-5])
def test_the_speed_of_a_drive_that_rests_in_holds_is_that_of_its_motion(noise):
    """Half of its parts stood still: it was "0.00053 times what is stated", and "to and fro"."""
    lasts = np.ptp(TIME)
    for holds in ([(0.2, 0.8)], [(0.3, 0.4), (0.6, 0.7)], [(0.0, 0.3)]):
        rests = sum(np.clip((TIME - TIME[0]) / lasts, *hold) - hold[0] for hold in holds)
        there = VELOCITY * ((TIME - TIME[0]) - lasts * rests)
        there += noise * np.random.default_rng(2).standard_normal(len(TIME))
        its, said = compare(sawtooth(), drive_velocity=VELOCITY, drive_position=there)
        assert its["drive velocity"].found == pytest.approx(VELOCITY, rel=0.02)
        assert its["drive velocity"].how == "median speed of its displacement in motion"
        assert "contradicts drive velocity" not in said


@pytest.mark.parametrize("noise", [1e-9, 1e-6])
def test_a_drive_that_moves_in_steps_does_not_contradict_its_mean_velocity(noise):
    """It rests between its steps as in holds: it was said to be 2 to 50 times as fast as stated."""
    travel = VELOCITY * (TIME - TIME[0])
    white = noise * np.random.default_rng(2).standard_normal(len(TIME))
    for steps, share in ((13, 0.4), (40, 0.5), (6, 0.001)):
        length = travel[-1] / steps
        there = length * (travel // length + np.minimum(travel % length / length / share, 1.0))
        record = st.Record(time=TIME, force=sawtooth(), drive_position=there + white)
        mean = drive_velocity(record.model_copy(update={"drive_velocity": VELOCITY}))
        assert mean.found == pytest.approx(VELOCITY, rel=0.02 + 0.5 / steps)
        assert mean.agrees
        fast = drive_velocity(record.model_copy(update={"drive_velocity": 4.0 * VELOCITY / share}))
        assert fast.agrees is False


def drive_velocities(turns):
    """Of 60 drives at 1 m/s with correlated noise: off by how much, and by how many errors."""
    found = []
    for seed, (legs, begin, size) in enumerate(inside(60, turns, (0.0, 1.0), (300.0, 8000.0))):
        time = np.linspace(0.0, 10.0, int(size))
        leg = 10.0 / legs
        there = leg * np.abs((time / leg + begin + 1.0) % 2.0 - 1.0) if legs > 1.0 else time
        white = np.random.default_rng(seed).standard_normal(len(time))
        noise = 1e-3 * lfilter([(1.0 - 0.81) ** 0.5], [1.0, -0.9], white)
        record = st.Record(time=time, force=np.ones(len(time)), drive_position=there + noise)
        (drive,) = (x for x in assess(record).stated if x.quantity == "drive velocity")
        found.append((abs(drive.found - 1.0), abs(drive.found - 1.0) / drive.error))
    return np.array(found)


def test_a_drive_that_turns_once_anywhere_turns():
    """One line was fitted through both legs, and a third of the speed was sure."""
    assert drive_velocities((1.2, 6.0))[:, 0].max() < 0.05


def test_the_error_of_a_drives_velocity_is_that_of_the_noise_it_has():
    """Noise was taken for white, which of these drives puts 42 beyond two errors."""
    assert np.sum(drive_velocities((0.9, 1.0))[:, 1] > 2.0) < 12


def test_a_drive_that_stands_in_noise_does_not_turn():
    noise = 1e-6 * np.random.default_rng(2).standard_normal(len(TIME))
    its, _ = compare(sawtooth(), drive_velocity=VELOCITY, drive_position=noise)
    assert its["drive velocity"].found < 0.01 * VELOCITY


@pytest.mark.parametrize(("across", "shown"), [(1e4, True), (1e7, False)])
def test_a_transverse_oscillation_above_half_the_sample_rate_is_not_in_the_record(across, shown):
    its, said = compare(sawtooth(), mass=MASS, stiffness_across=across)
    each = its["transverse natural frequency"]
    assert each.stated == pytest.approx((across / MASS) ** 0.5 / (2.0 * np.pi), rel=1e-12)
    assert each.agrees == shown
    assert ("The transverse oscillation, at 2.251 kHz, is not in this record" in said) != shown
    assert ("not shown" in said) != shown
    assert "contradict the record" not in said  # it did, of a stiffness that was right
    assert ("up to 800 Hz" in said, "can be shown" in said) == (True, shown)
    assert "frequency as stated" not in said  # to be able to show it is not to agree with it


def test_the_cut_off_of_a_sensor_counts_too():
    record = st.Record(
        time=TIME,
        force=sawtooth(),
        mass=MASS,
        stiffness_across=1e5,  # 225 Hz
        sensors={"force": st.Sensor(bandwidth="100 Hz")},
    )
    its = compare_metadata(record, "none", swings(record).lasting, None, ())
    (each,) = (x for x in its if x.agrees is False)
    assert each.found == 100.0


def test_a_run_is_what_it_states(paper_run):
    found = st.analyse(paper_run)
    assert found.parts["metadata"] == ()
    assert "What the record says" not in str(found)


@pytest.mark.parametrize(
    ("name", "low", "high"), [("k1002_v4300", 1.4, 1.75), ("k168_v42", 0.8, 1.2)]
)
def test_the_measured_records(name, low, high):
    """At V = 4300 um/s k/m comes out 1.5 to 1.7 times as stated, at 42 um/s as stated."""
    its = {each.quantity: each for each in st.analyse(read_measured(name)).parts["metadata"]}
    assert low < its["stiffness over mass"].ratio < high


def test_a_channel_of_the_load_is_not_confirmed_by_its_own_mean(tmp_path):
    """Nothing is stated, not even by a record that was stored and read again."""
    time = np.arange(0.0, 10.0, 1e-2)
    arrays = {"time": time, "force": 1.0 + 0.2 * (time % 2.0), "load": 10.0 + 0.1 * (time % 3.0)}
    alone = st.Record(**arrays)
    again = st.read_record(alone.save(tmp_path / "alone.nc"))
    for record in (alone, again, st.Record(**arrays, normal_load=None)):
        assert record.normal_load == arrays["load"].mean()
        assert record.stated_load is None
        (load,) = (x for x in st.analyse(record).parts["metadata"] if x.quantity == "normal load")
        assert load.agrees is None
        assert "What the record says of its apparatus" not in str(st.analyse(record))
    stated = st.Record(**arrays, normal_load="20 N")
    for record in (stated, st.read_record(stated.save(tmp_path / "stated.nc"))):
        (load,) = (x for x in st.analyse(record).parts["metadata"] if x.quantity == "normal load")
        assert load.stated == 20.0
        assert load.agrees is False


def steps_of_velocity(ratio, share, noise):
    """Return time and force of stick-slip at 1 mm/s, then at so many times that, on 1 kN/m."""
    rates = np.where(np.arange(60) < 60 * share, 1.0, ratio)  # N/s
    lasts = np.stack([0.5 / rates, np.full(60, 0.04)], axis=1).ravel()
    corners = np.concatenate([[0.0], np.cumsum(lasts)])
    time = np.arange(0.0, corners[-1], 4e-3)
    force = np.interp(time, corners, np.append(np.tile([1.0, 1.5], 60), 1.0))
    return time, force + noise * np.random.default_rng(1).standard_normal(len(time))


STEPS = inside(8, (-1.0, 1.0), (0.25, 0.75), (0.0, 0.01))


@pytest.mark.parametrize("stated", ["first", "last", "neither"])
@pytest.mark.parametrize(("decade", "share", "noise"), STEPS)
def test_a_step_of_the_velocity_is_doubted_by_its_parts(decade, share, noise, stated):
    """What is stated of one part contradicts nothing, and is not used in the other."""
    ratio = 10**decade if abs(decade) > 0.35 else 3.0
    time, force = steps_of_velocity(ratio, share, noise)
    speed = {"first": 1e-3, "last": 1e-3 * ratio, "neither": 5e-3 * max(1.0, ratio)}[stated]
    found = st.analyse(st.Record(time=time, force=force, stiffness=1e3, drive_velocity=speed))
    rates = [each for each in found.parts["metadata"] if "velocity" in each.quantity]
    assert len(rates) == 2
    assert [each.found for each in rates] == pytest.approx([1.0, ratio], rel=0.02)
    contradicts = [each for each in found.warnings if "check stiffness and drive" in each]
    slips = found.cycles["slip_distance"].values
    if stated == "neither":
        assert len(contradicts) == 2
        assert np.isnan(slips).all()
        return
    assert contradicts == []
    assert "contradict the record" not in str(found)
    own = (found.cycles["start"].values < rates[0].end) == (stated == "first")
    assert np.isfinite(slips[own]).all()
    assert np.isnan(slips[~own]).all()
    assert any("of the former only" in each for each in found.warnings)


@pytest.mark.parametrize("number", range(6))
def test_slips_of_rate_and_state_do_not_contradict_the_mass(number):
    """They last as the state takes to change, some hundred times half a swing of the mass."""
    draw = Draw(SEED, number)
    a, D, W, V = draw.between(0.003, 0.012), draw.decades(1e-6, 1e-4), 1e3, draw.decades(1e-7, 1e-5)
    b = a + draw.between(0.002, 0.01)
    k = draw.between(0.1, 0.5) * (b - a) * W / D
    mass = k * (D / V * draw.decades(1e-5, 1e-2) / (2.0 * np.pi)) ** 2
    kind = draw.among([st.laws.RateStateAgeing, st.laws.RateStateSlip])
    law = kind(mu_star=0.6, a=a, b=b, D_c=D, V_star=1e-6)
    slider = on_a_line(mass=mass, k_x=k, friction=law, normal_load=W, drive=st.ConstantVelocity(V))
    lasts = 0.7 * W / k / V + 100.0 * (b - a) * W / k / V
    run = st.simulate(slider, lasts, sample_rate=1e4 / lasts)
    record = st.measure(run, st.Sensor(noise=1e-3 * (b - a) * W), seed=number)
    record = record.model_copy(update={"mass": mass, "stiffness": k})
    found = st.analyse(record)
    assert found.regime.kind == "stick-slip"
    its = compare_metadata(found.record, found.regime.kind, table_of(found.cycles), None, ())
    assert all(each.agrees is not False for each in its if each.quantity == SWING)


def falls_of(durations, noise=1e-3):
    """Return a record at 100 samples a second: slips of these durations, after 3 s of loading."""
    at = np.cumsum(np.stack([np.full(len(durations), 3.0), durations], axis=1).ravel())
    time = np.arange(0.0, at[-1] + 2.0, 0.01)
    which = np.minimum(np.searchsorted(at[1::2], time), len(durations) - 1)
    since = time - np.concatenate([[0.0], at[1:-1:2]])[which]
    fall = 0.5 + 0.5 * np.cos(np.pi * np.clip((since - 3.0) / np.asarray(durations)[which], 0, 1))
    force = np.where(time < at[-1], np.where(since < 3.0, since / 3.0, fall), (time - at[-1]) / 3.0)
    force += noise * np.random.default_rng(3).standard_normal(len(time))
    return 1.0 + force, time


def test_slips_that_last_unlike_times_tell_no_mass():
    """Against constant friction they last equally long: theirs was 0.11 or 1 of k/m."""
    alike, _ = compare(*falls_of([0.3, 0.31, 0.29, 0.3, 0.32, 0.3]), stiffness=1.0, mass=0.01)
    assert alike[SWING].found == pytest.approx((np.pi / 0.3) ** 2, rel=0.2)
    assert alike[SWING].agrees
    unlike, _ = compare(*falls_of([0.3, 0.9, 0.3, 0.8, 0.9, 0.3]), stiffness=1.0, mass=0.01)
    assert SWING not in unlike
    assert unlike[LOADING_RATE].found == pytest.approx(1.0 / 3.0, rel=0.05)


def test_the_mass_contradicts_by_more_than_the_scatter_of_slips():
    """Few slips that differ tell their duration to a third only."""
    force, time = falls_of([0.24, 0.24, 0.36, 0.36])
    for stated, agrees in ((3.0, True), (10.0, False)):
        its, _ = compare(force, time, stiffness=stated * (np.pi / 0.3) ** 2, mass=1.0)
        assert its[SWING].error > 0.2 * its[SWING].found
        assert its[SWING].agrees is agrees


@pytest.mark.parametrize(("swung", "told"), [(1, False), (2, False), (3, True)])
def test_three_swings_tell_a_mass(swung, told):
    """A force that friction lowers, raises and lowers is no vibration: k/m was 1e-6 of the true."""
    force = 1.0 + np.sin(2.0 * np.pi * TIME)
    record = st.Record(time=TIME, force=force, stiffness=STIFFNESS, mass=MASS)
    cycles = swings(record).lasting.part(slice(swung))
    its = {each.quantity for each in compare_metadata(record, HARMONIC, cycles, None, ())}
    assert (SWING in its) is told


@pytest.mark.parametrize(("stated", "agrees"), [(1.0, True), (0.4, False)])
def test_a_drift_that_few_cycles_cannot_tell_does_not_contradict(stated, agrees):
    """Slips loaded at 1 N/s while the zero drifts by 0.3 N/s: two cycles show no drift."""
    time = np.arange(0.0, 4.5, 1e-3)
    phase = (time + 0.3) % 1.5
    force = 2.0 + np.minimum(phase, 1.4 * (1.5 - phase) / 0.1) + 0.3 * time
    force += 2e-3 * np.random.default_rng(1).standard_normal(len(time))
    its, _ = compare(force, time, stiffness=1e3, drive_velocity=1e-3 * stated)
    rate = its[LOADING_RATE]
    assert rate.found == pytest.approx(1.3, rel=0.05)
    assert rate.error > 0.25
    assert rate.agrees is agrees


def test_the_error_of_a_rate_holds_what_few_steps_of_a_converter_make():
    """All rises begin at a step: with the scatter alone 11 of 27 rates were off by two errors."""
    off = []
    for number in range(40):
        known = slips(np.random.default_rng([5, number]), step=0.25, noise=(-3.0, -1.5))
        true = known.record.loading_rate
        its = [each for each in assess(known.record).stated if each.quantity == LOADING_RATE]
        off += [abs(each.found - true) / each.error for each in its]
    assert len(off) >= 25
    assert np.mean(np.array(off) > 2.0) < 0.1
    assert np.mean(np.square(off)) ** 0.5 > 0.7  # they are not much smaller than their errors


@pytest.mark.parametrize(("found", "agrees"), [(1.3, True), (1.9, True), (4.0, False)])
def test_a_single_rate_differs_by_what_drift_and_steps_make_of_it(found, agrees):
    """It has no scatter, so that its error is unknown."""
    rate = np.array([found])
    assert _loading_rate(rate, rate, 1.0, 0.4, 0.1).agrees is agrees


@pytest.mark.parametrize(("late", "agrees"), [(1.05, True), (0.85, False), (1.9, False)])
def test_rises_that_are_steeper_at_first_and_then_as_stated_contradict_nothing(late, agrees):
    """Of 60 records behind a filter that nobody stated 10 contradicted stiffness and velocity."""
    first = np.array([1.9, 2.0, 2.1])
    found = _loading_rate(first, np.full(3, late), 1.0, 0.0, 0.0)
    assert found.agrees is agrees
    assert (found.at_least < 1.0) is agrees
    alike = np.array([0.98, 0.99, 1.0])  # no steeper than as stated: the late rate adds no error
    errors = [_loading_rate(alike, each, 1.0, 0.0, 0.0).error for each in (alike, 0.95 * alike)]
    assert errors[0] == errors[1]


@pytest.mark.parametrize(
    ("error", "bound", "word"),
    [(0.1, 0.8, "possible"), (0.6, np.nan, ""), (0.5, np.nan, ""), (np.nan, np.nan, "agrees")],
)
def test_a_bound_that_is_not_positive_is_none(error, bound, word):
    """A stiffness over mass that noise hides was at least -5707 1/s² in metadata.csv."""
    its = StatedQuantity(
        LOADING_RATE, "N/s", 1.0, error, 1.2, 0.5, 1.5, BY_RISE, is_bound=True
    )  # fmt: skip
    assert its.at_least == pytest.approx(bound, nan_ok=True)
    assert parts_of_metadata.verdict(its) == word
    assert its.is_shown is bool(word)
    shown = parts_of_metadata._value_in_words(its)
    assert (shown == "not determined") is not its.is_shown
