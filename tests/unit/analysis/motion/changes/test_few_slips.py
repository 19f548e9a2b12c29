"""Few slips are known by their shape: even loading, a quick fall, and the same loading again."""

import numpy as np
import pytest

import stiction as st
from stiction.analysis.motion.changes.few_slips import few_slips

RAMP, LASTS, DROP = 1.0, 0.04, 0.6  # N/s, s and N
TIME = np.arange(0.0, 1.5, 5e-4)
STIFFNESS = (np.pi / LASTS) ** 2  # N/m of a mass of 1 kg whose slip lasts so long
LEVELS = np.select([TIME < 0.5, TIME < 1.0], [0.2, 1.0], 0.4)
VIBRATION = 1.0 + 0.3 * np.sin(2.0 * np.pi * 2.0 * TIME)
BREAK_AWAY = np.where(TIME < 1.0, TIME, 0.5 + 0.5 * np.exp(-(TIME - 1.0) / 0.02))


def sawtooth(slips, rest=0.5, time=None):
    """Return times (s) and a force (N) that slips so often, loaded for so long afterwards."""
    period = DROP / RAMP + LASTS
    end = 1.0 + (slips - 1) * period + LASTS + rest
    time = np.arange(0.0, end, 5e-4) if time is None else time
    force = RAMP * time
    for k in range(slips):
        since = np.clip(time - 1.0 - k * period, 0.0, LASTS)
        force -= 0.5 * DROP * (1.0 - np.cos(np.pi * since / LASTS)) + RAMP * since
    return time, force


def noisy(force, noise=0.005, seed=1):
    return force + noise * np.random.default_rng(seed).standard_normal(len(force))


def analyse(time, force):
    stated = {"mass": 1.0, "stiffness": STIFFNESS, "drive_velocity": RAMP / STIFFNESS}
    return st.analyse(st.Record(time=time, force=force, **stated))


@pytest.mark.parametrize("slips", [1, 2, 3])
def test_each_slip_is_found(slips):
    time, force = sawtooth(slips)
    found = few_slips(time, noisy(force))
    assert found is not None
    assert len(found.points.index) == 2 * slips
    assert found.begin.value == pytest.approx([0.4], abs=0.05)


def through(*corners, step=5e-4):
    """Return times (s) and a force (N) on straight lines, each so long and so high."""
    lasts, rises = np.transpose([(0.0, 1.0), *corners])
    at = np.cumsum(lasts)
    time = np.arange(0.0, at[-1] + 0.5 * step, step)
    return time, np.interp(time, at, np.cumsum(rises))


def slip(before=1.0, lasts=0.01, after=0.5, ratio=1.0, **more):
    """Return a slip between two rises so high (N), the second with a ratio of the first's rate."""
    return through((before, before), (lasts, -DROP), (after / ratio, after), **more)


def loading_with_a_bend(by):
    """Return a slip whose first loading swings by so much (N) about a line, twice."""
    time, force = slip()
    return time, force + by * np.sin(5.0 * np.pi * time) * np.clip(10.0 * (1.0 - time), 0.0, 1.0)


def loading_with_creep(share):
    """Return a slip before which the mass creeps, for the last share of the rise of its drop."""
    top = share * DROP
    return through((1.0 - top, 1.0 - top), (20.0 * top, top), (0.01, -DROP), (0.5, 0.5))


def levels_after_steps(rate):
    """Return a level after a step, at which the force rises slowly, and a step back."""
    rise = 0.5 * rate
    return through((0.5, 0.0), (1e-3, DROP - rise), (0.5, rise), (0.01, -DROP), (0.5, rise))


def loading_with_a_dip(height):
    """Return a slip whose loading turns back before it, slowly, by a share of the range."""
    by = 2.0 * height
    return through((0.5, 0.5), (by, -by), (1.5 + by, 1.5 + by), (0.01, -DROP), (0.5, 0.5))


def slip_of(samples):
    """Return a slip of so many samples in all."""
    time = np.linspace(0.0, 1.51, samples)
    return time, np.interp(time, [0.0, 1.0, 1.01, 1.51], [0.0, 1.0, 0.4, 0.9])


@pytest.mark.parametrize(
    ("make", "is_slip", "is_none"),
    [
        (lambda rise: slip(before=rise), 0.31 * DROP, 0.29 * DROP),  # it is loaded by a third
        (lambda rise: slip(after=rise), 0.16 * DROP, 0.14 * DROP),  # and again by half of that
        (lambda ratio: slip(ratio=ratio), 1.55, 1.65),
        (lambda ratio: slip(ratio=ratio), 1.0 / 1.55, 1.0 / 1.65),
        (lambda lasts: slip(lasts=lasts), 0.28 * DROP, 0.3 * DROP),  # three quarters of it at rest
        (lambda step: slip(before=3.0, step=0.48 / step), 9, 7),  # samples
        (loading_with_a_bend, 0.04, 0.06),
        (loading_with_creep, 0.19, 0.25),
        (loading_with_a_dip, 0.048, 0.055),
        (slip_of, 33, 31),
        (sawtooth, 8, 9),
    ],
)
def test_a_slip_is_known_by_its_shape_up_to_a_limit(make, is_slip, is_none):
    assert few_slips(*make(is_slip)) is not None
    assert few_slips(*make(is_none)) is None


def test_a_step_before_a_level_is_no_loading():
    assert [few_slips(*levels_after_steps(rate)) for rate in (0.3, 0.6)] == [None, None]


def test_means_are_as_long_as_noise_asks_for():
    """Of 64 samples here: noise is an eighth of the least fall then, and reaches twice as far."""
    for seed in range(8):
        time, force = sawtooth(1)
        found = few_slips(time, noisy(force, 0.05, seed))
        assert found is not None
        assert found.points.width == pytest.approx(64, rel=0.2)
        assert found.points.noise == pytest.approx(2.0 * 0.05 / 8.0, rel=0.1)


@pytest.mark.parametrize("force", [LEVELS, VIBRATION, BREAK_AWAY, TIME, 0.0 * TIME])
def test_no_other_force_slips(force):
    assert few_slips(TIME, noisy(force)) is None


def test_a_slip_without_even_loading_after_it_is_none():
    time, force = sawtooth(1)
    flat = np.where(time < 1.0 + LASTS, force, 1.0 - DROP)
    assert few_slips(time, noisy(flat)) is None
    quick = np.where(time < 1.0 + LASTS, force, force + 2.0 * (time - 1.0 - LASTS))
    assert few_slips(time, noisy(quick)) is None


def test_a_fall_as_slow_as_its_loading_is_none():
    force = np.interp(TIME, [0.0, 0.6, 1.0, 1.5], [0.0, 0.6, 0.2, 0.7])
    assert few_slips(TIME, noisy(force)) is None


@pytest.mark.parametrize("hum", [0.0, 0.03, 0.2])
def test_a_single_slip_is_described(hum):
    time, force = sawtooth(1)
    found = analyse(time, noisy(force) + hum * np.sin(2.0 * np.pi * 73.0 * time))
    assert "The mass sticks, slips once, at 1" in str(found)
    assert "no stick phase ends" not in str(found)
    assert found.friction.kinetic is None
    its = found.regime.evidence
    assert its["slips_by"] == pytest.approx(DROP, abs=3.0 * its["slips_by_error"])
    swing = next(x for x in found.parts["metadata"] if x.quantity == "stiffness over mass")
    assert swing.found == pytest.approx(STIFFNESS, abs=2.0 * swing.error)
    assert swing.agrees


def test_hum_beside_two_slips_is_not_the_motion():
    time, force = sawtooth(2)
    found = analyse(time, noisy(force) + 0.05 * np.sin(2.0 * np.pi * 90.0 * time))
    assert found.regime.kind == "stick-slip"
    assert found.cycles["drop"].values == pytest.approx([DROP], abs=0.05)


def test_a_vibration_far_quicker_than_the_mass_is_not_called_its_own():
    time = np.arange(0.0, 2.0, 1e-3)
    force = 2.0 + 0.1 * np.sin(2.0 * np.pi * 60.3 * time)
    stated = {"mass": 1.0, "stiffness": 100.0, "drive_velocity": 1e-3}
    text = str(st.analyse(st.Record(time=time, force=noisy(force, 1e-4), **stated)))
    assert "The force swings" in text
    assert "takes 37.9 times as long: this is the transverse oscillation, hum" in text


def test_a_mass_that_creeps_is_loaded_more_slowly_than_the_error_says():
    """981.8 ± 0.6 mN/s beside a stated 1 N/s was all that was said."""
    time, force = sawtooth(5)
    said = str(analyse(time, 0.98 * noisy(force, 1e-4)))
    row = next(x for x in said.splitlines() if x.startswith("  stiffness times drive velocity"))
    assert "≥ 9" in row
    assert "while the mass creeps, the force rises more slowly" in said


def test_what_is_nothing_is_told_as_nothing():
    """A zero of -1.312 rN, and a rate of 317 nHz at which to sample, were told."""
    time, force = sawtooth(4)
    tiny = np.where(time < 0.1, -1.3e-27, force)
    assert "rN" not in str(st.analyse(st.Record(time=time, force=tiny)))
    coarse, year = slice(None, None, 80), 3e7
    text = str(st.analyse(st.Record(time=year * time[coarse], force=force[coarse])))
    assert "nHz or more" not in text
    assert "or more often" in text


def test_the_error_of_a_single_fall_holds_how_few_samples_it_has():
    """The ends of falls of a few samples were told up to ten errors beyond them."""
    off = []
    for number in range(60):
        draw = np.random.default_rng([3, number])
        time = np.linspace(0.0, 10.0, draw.choice([600, 1500, 4000]), endpoint=False)
        drop, lasts, noise = (
            draw.uniform(0.2, 0.9),
            draw.uniform(0.01, 0.05),
            draw.choice([0, 0.01]),
        )
        rate = (1.0 + 1.6 * drop) / (10.0 - lasts)
        since = np.clip(time - 1.0 / rate, 0.0, lasts)
        force = rate * (time - since) - 0.5 * drop * (1.0 - np.cos(np.pi * since / lasts))
        record = st.Record(time=time, force=noisy(force, noise * drop, number))
        its = st.analyse(record).regime.evidence
        off.append(abs(its["slips_by"] - drop) / its["slips_by_error"])
    assert np.mean(np.array(off) < 2.0) > 0.93
    assert max(off) < 5.0


@pytest.mark.parametrize("slides", [0.0, 5.0])
def test_the_first_slip_is_loaded_from_where_the_force_was_last_as_low_as_its_trough(slides):
    """It may slide before, at a lower force than that of its slip."""
    corners = [(0.0, 0.0), (1.0, 0.995), (1.0 + slides, 1.0), (3.0, 3.0), (3.05, 1.505), (4.5, 3.0)]
    at, force = np.array(corners).T
    at[3:] += slides
    time = np.arange(0.0, at[-1], 0.01)
    found = few_slips(time, np.interp(time, at, force))
    assert found is not None
    assert found.begin.value == pytest.approx([1.505], abs=0.01)
    assert found.begin.time == pytest.approx(slides + found.begin.value, abs=1e-3)
