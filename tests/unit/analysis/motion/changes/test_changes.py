"""Changes within a record: a drive that turns or changes its speed, cycles of another kind."""

import numpy as np
import pytest

import stiction as st
from stiction.analysis.motion.changes.cycles import parts_of
from stiction.analysis.motion.changes.strokes import strokes

RIG = {"normal_load": 10.0, "stiffness": 1e3, "drive_velocity": 1e-3}


def pull_of(travel, static=2.0, kinetic=1.5):
    """Return the force of a mass that slips at once to beyond its kinetic friction, N."""
    force, pulls = np.zeros(len(travel)), 0.0
    for i, step in enumerate(np.diff(travel, prepend=0.0)):
        pulls += 1e3 * step
        if abs(pulls) >= static:
            pulls = np.sign(pulls) * (2.0 * kinetic - static)
        force[i] = pulls
    return force


@pytest.mark.parametrize("mass", [None, 0.25])
@pytest.mark.parametrize("slips", [0, 1, 2, 6])
def test_strokes_have_no_friction_in_one_number(slips, mass):
    """It said: kinetic friction -0.136 N, or a zero that is off, or a wrong mass."""
    length = 1.0 if slips == 0 else 4.0 + slips - 0.5  # mm
    time = np.arange(0.0, 6.5 * length, 4e-3)
    travel = 1e-3 * np.abs((time + 0.5 * length) % (2.0 * length) - length)
    travel = 0.5e-3 * length - travel
    noise = 1e-2 * np.random.default_rng(slips).standard_normal(len(time))
    record = st.Record(time=time, force=pull_of(travel) + noise, mass=mass, **RIG)
    found = st.analyse(record)
    assert found.regime.kind == "undetermined"
    assert found.friction[:3] == (None, None, None)
    assert found.warnings == ()
    assert np.isnan(found.summary["mean"].sel(quantity="slip_distance"))
    moved = record.model_copy(update={"drive_position": travel, "stiffness": None})
    assert "back and forth" in str(st.analyse(moved))


def saw(periods, drop=1.0, rate=200.0, seed=1):
    """Return times and a force of cycles that fall by `drop` in 0.02 s, with noise."""
    lasts = np.repeat(np.asarray(periods, dtype=float), 2)
    lasts[::2] -= 0.02
    lasts[1::2] = 0.02
    ends = np.append(0.0, np.cumsum(lasts))
    falls = np.broadcast_to(drop, len(periods))
    corners = np.append(np.stack([2.0 - np.roll(falls, 1), np.full(len(periods), 2.0)], 1), 1.0)
    time = np.arange(0.0, ends[-1], 1.0 / rate)
    noise = 2e-3 * np.random.default_rng(seed).standard_normal(len(time))
    return time, np.interp(time, ends, corners) + noise


@pytest.mark.parametrize("ratios", [(1, 2, 4), (1, 3, 1, 0.4), (2, 1, 2, 1, 2)])
def test_each_step_of_the_velocity_is_a_part(ratios):
    time, force = saw(np.concatenate([np.full(8, 1.0 / each) for each in ratios]))
    rig = {"normal_load": 10.0, "stiffness": 1e3, "drive_velocity": 1.02e-3 * min(ratios[:2])}
    found = st.analyse(st.Record(time=time, force=force, **rig))
    said = str(found)
    assert "check stiffness" not in said
    table, rates = found.parts["changes"], 1.0 / (1.0 / np.array(ratios) - 0.02)
    assert table["period"].values == pytest.approx(1.0 / np.array(ratios), rel=0.02)
    assert table["velocity"].values == pytest.approx(1e-3 * rates, rel=0.01)
    assert "analyse the parts by themselves" in said
    known = found.cycles["stiffness"].values
    assert np.nanmean(known) == pytest.approx(1e3, rel=0.06)
    assert np.isnan(known).any()


def test_a_drive_that_is_accelerated_contradicts_nothing():
    time, force = saw(1.0 / np.linspace(1.0, 4.0, 30))
    rig = {"normal_load": 10.0, "stiffness": 1e3, "drive_velocity": 1e-3}
    found = st.analyse(st.Record(time=time, force=force, **rig))
    said = " ".join(found.warnings)
    assert "The rate of loading changes from" in said
    assert "check stiffness" not in said
    assert not np.isfinite(found.cycles["stiffness"]).any()
    assert found.creep is None


@pytest.mark.parametrize("number", [7, 14, 60])
def test_pauses_and_deep_falls_are_named_and_left_out_of_the_means(number):
    paused = np.ones(number)
    paused[[number // 3, -3][: number // 7]] = 7.0
    found = st.analyse(st.Record(time=saw(paused)[0], force=saw(paused)[1], normal_load=10.0))
    assert found.summary["mean"].sel(quantity="period") == pytest.approx(1.0, rel=0.01)
    assert "the drive paused" in " ".join(found.warnings)
    deep, lasts = np.ones(number), np.ones(number)
    deep[number // 2], lasts[number // 2 + 1] = 3.0, 3.0
    time, force = saw(lasts, deep)
    found = st.analyse(st.Record(time=time, force=force, normal_load=10.0))
    said = " ".join(found.warnings)
    assert "a knock, or a slip of another kind" in said
    assert "paused" not in said
    assert found.friction.kinetic.force == pytest.approx(1.5, abs=0.01)
    assert found.summary["mean"].sel(quantity="drop") == pytest.approx(1.0, rel=0.02)


@pytest.mark.parametrize("count", [40, 6000])
def test_parts_of_many_cycles(count):
    """Periods that grow evenly, without noise, took 145 s: each four of them seemed a part."""
    growing, equal = np.linspace(0.1, 1.0, count), np.full(count, 0.37)
    stepped = np.round(np.repeat([0.3, 0.5, 0.3, 0.61], count // 4), 2)
    for period, parts in ((growing, 1), (equal, 1), (stepped, 4)):
        found = parts_of(period)
        assert len(found) == parts
        assert [*range(count)] == [k for part in found for k in range(count)[part]]


@pytest.mark.parametrize("height", [-8.0, 5.0, 15.0])
@pytest.mark.parametrize("number", [8, 18])
def test_stick_slip_goes_on_beside_a_knock_that_rings(number, height):
    """It was a vibration that dies down, of a mass that slides steadily."""
    time, force = saw(np.ones(number), rate=400.0)
    since = time - 0.5 * number - 0.3
    rings = height * np.exp(-since / 0.15) * np.cos(2.0 * np.pi * 20.0 * since)
    knocked = force + np.where(since > 0.0, rings, 0.0)
    found = st.analyse(st.Record(time=time, force=knocked, normal_load=10.0))
    assert found.regime.kind == "stick-slip"
    assert found.summary["mean"].sel(quantity="drop") == pytest.approx(1.0, rel=0.05)
    assert found.friction.static.force == pytest.approx(2.0, abs=0.02)
    assert "as after a knock" in " ".join(found.warnings)
    dying = st.analyse(st.Record(time=time, force=1.5 + np.where(since > 0.0, rings, 0.0)))
    assert dying.regime.kind == "settling"


def test_a_sliding_mass_driven_in_steps_has_a_friction_at_each_level():
    """It was one kinetic friction, with an error, and a drift of the load cell."""
    time = np.arange(0.0, 80.0, 0.01)
    levels = np.array([0.2, 0.23, 0.2, 0.26])
    step = np.minimum(time // 20.0, 3.0).astype(int)
    mu = levels[step] + np.where(step > 0, levels[step - 1] - levels[step], -0.2) * np.exp(
        -(time % 20.0) / 1.5
    )
    noise = 5e-3 * np.random.default_rng(1).standard_normal(len(time))
    found = st.analyse(st.Record(time=time, force=10.0 * mu + noise, normal_load=10.0))
    table = found.parts["changes"]
    assert table["coefficient"].values == pytest.approx(levels, abs=1e-3)
    assert table["begin"].values == pytest.approx(20.0 * np.arange(4), abs=10.0)
    assert found.friction.kinetic is None
    assert found.warnings == ()
    assert "several levels" in str(found)


@pytest.mark.parametrize("rest", [8.0, 15.0, 30.0, 50.0])
@pytest.mark.parametrize("steps", [1, 2])
def test_what_is_recorded_before_a_test_is_no_level_of_sliding(rest, steps):
    """Most records begin with the zero of the force, some end with it; it was averaged, too."""
    time = np.arange(0.0, 80.0 + rest, 0.01)
    since = np.maximum(time - rest, 0.0)
    force = 2.0 * (1.0 - np.exp(-since / 0.3)) + 0.3 * since * np.exp(1.0 - since) / 2.0
    force += 0.4 * (steps - 1) * (since > 40.0)
    noise = 5e-3 * np.random.default_rng(1).standard_normal(len(time))
    found = st.analyse(st.Record(time=time, force=force + noise, normal_load=10.0))
    assert found.friction.break_away.force == pytest.approx(2.0 + 0.3 / 2.0, abs=0.05)
    if steps == 1:
        assert found.friction.kinetic.coefficient == pytest.approx(0.2, abs=1e-3)
        assert found.parts["changes"] is None
        assert "next to zero" not in str(found)
        lifted = np.where(time > time[-1] - 20.0, 0.0, force) + noise
        ended = st.analyse(st.Record(time=time, force=lifted, normal_load=10.0))
        assert ended.friction.kinetic.coefficient == pytest.approx(0.2, abs=1e-3)
        assert "next to zero later" in str(ended)
    else:
        assert found.parts["changes"]["force"].values == pytest.approx([2.0, 2.4], abs=1e-2)


@pytest.mark.parametrize("seed", range(6))
def test_friction_that_wanders_stays_at_no_level(seed):
    random = np.random.default_rng(seed)
    force = 100.0 + 0.3 * np.cumsum(random.standard_normal(4000)) * (seed % 2)
    force += 10.0 * random.standard_normal(4000) + 3.0 * np.exp(-np.arange(4000) / 200.0)
    record = st.Record(time=0.01 * np.arange(4000), force=force)
    assert "levels" not in st.analysis.classify(record).evidence


def sliding_parts(random, size, shape):
    """Return times, forces about 1 N while the mass slides, and the displacement of the drive."""
    share = np.linspace(0.0, 1.0, size)
    if shape == "sine":  # friction grows with the velocity near rest; the next stroke begins
        velocity, at = np.pi * np.sin(np.pi * share), -np.cos(np.pi * share)
        force = np.tanh(velocity / 0.1)
        force[-1] = -0.3
    elif shape == "triangle":  # the spring is bent the other way before, and friction weakens
        at, force = 2.0 * share - 1.0, 1.0 + 0.3 * np.exp(-share / 0.02)
        force = np.minimum(force, 30.0 * share - 1.0)
    else:
        at = None
        force = np.minimum(share / 0.1, 1.0) * np.clip((0.85 - share) / 0.15 + 1.0, 0.0, 1.0)
    noise = 10.0 ** random.uniform(-3.0, -1.5)
    return 3.0 * share, force + noise * random.standard_normal(size), at


@pytest.mark.parametrize(
    ("shape", "known"),
    [("sine", False), ("sine", True), ("triangle", False), ("triangle", True), ("unloaded", False)],
)
def test_what_ends_the_sliding_is_no_part_of_it(shape, known):
    """The last half after the largest sample of a plateau was averaged, the turn with it: 0.47."""
    random, deviations = np.random.default_rng(7), []
    for size in (61, 100, 130, 400, 900, 2000):
        time, force, at = sliding_parts(random, size, shape)
        record = st.Record(time=time, force=force, drive_position=at if known else None)
        found = st.analyse(record)
        kinetic = found.friction.kinetic
        assert kinetic.force == pytest.approx(1.0, abs=0.02)
        assert kinetic.error < 5.0 * kinetic.spread / size**0.5  # as of a good part of the samples
        assert "knock" not in str(found)
        assert "wanders" not in str(found)
        deviations.append((kinetic.force - 1.0) / kinetic.error)
    # of twenty means, or of ten: Student's t, whose largest of six is above 4 once in fifty times
    assert np.abs(deviations).max() < 4.0
    assert np.mean(np.square(deviations)) < 2.8  # chi squared over 6: above that once in a hundred


def test_a_dwell_of_the_drive_is_no_sliding():
    """The spring keeps the force, or loses a part of it by creep, while the drive rests."""
    time = np.arange(0.0, 10.0, 0.01)
    at = np.minimum(time, 6.0)
    force = np.minimum(time, 1.0) - 0.2 * (1.0 - np.exp(-np.maximum(time - 6.0, 0.0)))
    force += 1e-3 * np.random.default_rng(1).standard_normal(len(time))
    found = st.analyse(st.Record(time=time, force=force, drive_position=at))
    assert found.friction.kinetic.force == pytest.approx(1.0, abs=3e-4)


BACK_AND_FORTH = np.arange(0.0, 60.0, 1e-3)


def strokes_of(corners, **known):
    """Return the strokes of a force (N) through corners at some times (s), again and again."""
    at, force = np.transpose(corners)
    force = np.interp(BACK_AND_FORTH % at[-1], at, force)
    return strokes(st.Record(time=BACK_AND_FORTH, force=force, **known))


def triangle(ratio=1.0):
    """Return the corners of a force that rises for so many times as long as it falls, at 1 N/s."""
    rises = 4.0 * ratio / (1.0 + ratio)
    return (0.0, -1.0), (rises, 1.0), (4.0, -1.0)


def square(share=0.5, low=-1.0):
    """Return the corners of a force that is 1 N for a share of a second, and lower else."""
    return (0.0, 1.0), (share, 1.0), (share + 1e-3, low), (1.0 - 1e-3, low), (1.0, 1.0)


def trapezium(up, down):
    """Return the corners of a force of 1 N and -1 N that passes between half of them in these s."""
    return (0.0, -1.0), (2.0 * up, 1.0), (6.0, 1.0), (6.0 + 2.0 * down, -1.0), (12.0, -1.0)


SOFT = {"stiffness": 1.0, "mass": 1e-4}


@pytest.mark.parametrize(
    ("make", "turns", "does_not"),
    [
        (lambda ratio: strokes_of(triangle(ratio), **SOFT), 1.22, 1.28),  # up as slowly as down
        (lambda ratio: strokes_of(triangle(ratio), **SOFT), 1.0 / 1.22, 1.0 / 1.28),
        (lambda period: strokes_of(
            triangle(), stiffness=1.0, mass=(period / (2.0 * np.pi)) ** 2
        ), 0.49, 0.51),  # a mass on its spring passes in less
        (lambda rate: strokes_of(triangle(), stiffness=1.0, drive_velocity=rate), 0.88, 0.86),
        (lambda rate: strokes_of(triangle(), stiffness=1.0, drive_velocity=rate), 1.32, 1.35),
        (lambda share: strokes_of(square(share)), 0.11, 0.09),
        (lambda share: strokes_of(square(share)), 0.89, 0.91),
        (lambda low: strokes_of(square(low=low)), -0.31, -0.29),
        (lambda low: strokes_of(square(low=low)), -3.2, -3.5),
        (lambda lasts: strokes_of(trapezium(lasts, lasts)), 0.85, 0.95),  # of 6 s between both
        (lambda down: strokes_of(trapezium(0.9, down)), 0.31, 0.29),  # quicker, it is a slip
    ],
)  # fmt: skip
def test_a_force_is_of_a_drive_that_turns_up_to_a_limit(make, turns, does_not):
    assert make(turns) is not None
    assert make(does_not) is None
