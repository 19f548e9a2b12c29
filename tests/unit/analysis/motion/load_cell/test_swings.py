"""What the swings of a load cell after each slip do to troughs, peaks and rates."""

import numpy as np
import pytest
from benchmarks.explore.numbers import by_ringing_cell
from tests.parts import assess

import stiction as st
from stiction.analysis.motion.cycle_columns import CycleTable
from stiction.analysis.motion.cycles import swings
from stiction.analysis.motion.load_cell.swings import swings_of_cell
from stiction.analysis.motion.loading import loading_rate


def swings_after(slips):
    """Return what rises from 0 N, (n, samples) each over 10 s, show of the swings of a cell."""
    count, samples = slips.shape
    time = np.arange(count * samples) * 10.0 / samples
    start = time[::samples]
    peak_time = time[samples - 1 :: samples]
    columns = {"start": start, "start_force": slips[:, 0], "peak_time": peak_time}
    record = st.Record(time=time, force=slips.ravel())
    return swings_of_cell(record, CycleTable(columns, 0.0))


@pytest.mark.parametrize("quality", [3.0, 8.0])
@pytest.mark.parametrize("noise", [0.0, 0.02])
def test_a_trough_is_too_low_by_the_first_swing_of_a_load_cell(quality, noise):
    """The rise begins 0.3 N too low; of a peak nothing is seen but what a radian of it hides."""
    time = np.arange(0.0, 10.0, 5e-3)
    phase = 4.0 * np.pi * time
    rise = 0.1 * time - 0.3 * np.exp(-0.5 * phase / quality) * np.cos(phase)
    rises = rise + noise * np.random.default_rng(1).normal(size=(6, len(time)))
    found = swings_after(rises)
    assert found.trough == pytest.approx(0.3, abs=0.02 + 2.0 * noise)
    assert found.peak == pytest.approx(0.1 / (4.0 * np.pi), abs=1e-3 + 3.0 * noise)
    assert found.rate < 0.01


def test_a_load_cell_rings_if_most_rises_do():
    """And what it does is that of those: of a rise that does not, the trough is right."""
    time = np.arange(0.0, 10.0, 5e-3)
    swing = np.exp(-time) * np.cos(4.0 * np.pi * time)
    sizes = np.linspace(0.2, 0.4, 7)
    for silent, rings in ((9, False), (5, True)):
        rises = 0.1 * time - np.append(sizes, np.zeros(silent))[:, None] * swing
        found = swings_after(rises)
        assert (found is not None) is rings
    assert found.trough == pytest.approx(0.3, abs=0.01)


def test_what_is_left_of_a_swing_at_the_peak_is_its_error_there():
    time = np.arange(0.0, 10.0, 5e-3)
    rise = 0.1 * time - 0.3 * np.exp(-time) * np.cos(4.0 * np.pi * time)
    rise[-20:] += 0.05
    assert swings_after(np.tile(rise, (6, 1))).peak == pytest.approx(0.05, abs=5e-3)


def test_a_swing_that_fades_late_is_off_in_the_rate():
    """The line through the whole rise has it; that through its second half hardly."""
    time = np.arange(0.0, 10.0, 5e-3)
    rises = np.tile(0.1 * time - 0.3 * np.exp(-time / 1.5) * np.cos(1.3 * np.pi * time), (6, 1))
    found = swings_after(rises)
    ends = 10.0 * np.arange(6)
    whole = loading_rate(5e-3 * np.arange(rises.size), rises.ravel(), ends, ends + 9.995)
    assert found.rate == pytest.approx(abs(whole[0] - 0.1), rel=0.1)
    assert found.rate > 5e-3


def test_steps_of_a_coarse_converter_do_not_ring():
    """A fall by one step is 0.3 N but for rounding, and was more than that of the converter."""
    time, random = np.arange(0.0, 10.0, 0.02), np.random.default_rng(0)
    creeps = 1.0 - np.exp(-0.5 * time) + random.uniform(size=(9, 1))
    creeps += 0.01 * random.normal(size=creeps.shape)
    assert swings_after(0.3 * np.round(creeps / 0.3)) is None


def test_a_load_cell_does_not_ring_where_the_mass_creeps_or_slips_a_little():
    """Nor does noise look like it, nor the friction that grows while a mass slides."""
    time, random = np.arange(0.0, 10.0, 0.02), np.random.default_rng(1)
    small = np.interp(time, [0.0, 6.0, 6.1, 10.0], [0.0, 0.6, 0.4, 0.79])
    early = np.interp(time, [0.0, 3.0, 3.1, 10.0], [0.0, 0.3, 0.1, 0.79])
    creeps = 1.0 - np.exp(-0.5 * time)
    slides = np.interp(time, [0.0, 1.0, 5.0, 5.5, 10.0], [0.0, 1.0, 1.0, 1.5, 1.5])
    for shape in (0.1 * time, small, early, creeps, slides):
        for noise in (0.0, 0.01, 0.1):
            assert swings_after(shape + noise * random.normal(size=(9, len(time)))) is None


def test_friction_and_rate_of_loading_by_a_load_cell_that_rings():
    """Of eight slips from 2 to 1 N kinetic friction was 1.38 ± 0.005 N, a load cell too low."""
    time = np.arange(0.0, 80.0, 0.02)
    since = time % 10.0
    fall = 0.5 + 0.5 * np.cos(np.pi * np.clip((since - 9.7) / 0.3, 0.0, 1.0))
    swing = np.exp(-since / 1.3) * np.sin(2.0 * np.pi * since / 1.1) * (since < 9.7)
    force = np.where(since < 9.7, 1.0 + since / 9.7, 1.0 + fall) - 0.35 * swing
    force += 5e-3 * np.random.default_rng(1).normal(size=len(time))
    record = st.Record(time=time, force=force, stiffness=1e3, drive_velocity=1e-3 / 9.7)
    found = assess(record)
    for its, true in ((found.friction.static, 2.0), (found.friction.kinetic, 1.5)):
        assert abs(its.force - true) < 2.0 * its.error < 0.3
    assert [each.agrees for each in found.stated[:1]] == [True]
    assert found.stated[0].error > 8e-3  # N/s, nearly all by the swings
    assert "After each slip the force swings" in " ".join(found.warnings)


def test_a_ripple_on_a_wave_with_a_gap_is_not_a_load_cell_that_rings():
    """Troughs were "1.2 N too low" beside falls of 0.3 N, in a record without slips."""
    for number in range(24):
        random = np.random.default_rng([21, number])
        time = np.arange(0.0, 50.0, 5e-3)
        wave = 0.04 * np.sin(2.0 * np.pi * time / 7.0 + random.uniform(0.0, 6.0))
        ripple = random.uniform(0.0, 0.06) * np.sin(4.0 * np.pi * time + random.uniform(0.0, 6.0))
        force = 1.5 + wave + ripple + 5e-4 * random.normal(size=len(time))
        gap = random.uniform(10.0, 40.0)
        seen = (time < gap) | (time > gap + random.choice([0.0, 1.0, 1.5]))
        record = st.Record(time=time[seen], force=force[seen], normal_load=5.0)
        assert "load cell rings" not in " ".join(assess(record).warnings)


def test_swings_of_a_cell_are_less_than_the_drops_and_not_sought_across_a_gap():
    """A line over a gap bends like the flank of a swing."""
    seen = 0
    for number in range(16):
        record = by_ringing_cell(np.random.default_rng([22, number])).record
        cycles, hidden = swings(record).lasting, np.zeros(len(record), bool)
        found = swings_of_cell(record, cycles)
        if found is None:
            continue
        seen += 1
        assert 0.0 < found.trough < cycles.median("drop")
        for begin, end in zip(cycles["start"], cycles["peak_time"], strict=True):
            away = (record.time - begin) / (end - begin)
            hidden |= (away > 0.5) & (away < 0.7)
        assert swings_of_cell(record.part(np.flatnonzero(~hidden)), cycles) is None
    assert seen > 4
